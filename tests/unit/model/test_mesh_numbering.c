/* Nodes, elements and degrees of freedom of scenes against counts by hand (lib/theory/kinematics.md). */
#include "model_test.h"

/* 2 rigid bodies, 100 flexible pipes, 101 fixed joints, one cylindrical pair, 2 drives (the reference study). */
static void reference_scene(void **state)
{
    dmb_model *model = new_model();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_body_def head = dmb_body_def_default();
    const dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_model_info info = dmb_model_info_default();
    const dmb_scene *scene;
    (void)state;
    add_wall(model);
    add_pipes(model, &pipe, 100);
    head.attach = DMB_ATTACH_START;
    head.mass = 200.0;
    assert_ok(dmb_model_add_body(model, &head, NULL));
    assert_ok(dmb_model_add_bit(model, &bit, NULL));
    drive.time_function = add_constant(model, 0.01);
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    drive.component = DMB_RX;
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    scene = compiled(model);
    assert_ok(dmb_model_get_info(model, &info));
    assert_int_equal(info.strings, 1);
    assert_int_equal(info.pipes, 100);
    assert_int_equal(info.rigid_bodies, 2);
    assert_int_equal(info.nodes, 101);
    assert_int_equal(info.elements, 100);
    assert_int_equal(info.structural_joints, 101);
    assert_int_equal(info.degrees_of_freedom, 600); /* 606 less a support of 4 and two drives */
    assert_int_equal(info.prescribed, 2);
    assert_int_equal(info.contact_points, 101); /* pipe ends but the guided one, and the bit */
    assert_int_equal(info.model_bytes, scene->bytes);
    assert_true(info.sim_bytes > 0);
    assert_near(info.length, 100.0, 1e-15);
    assert_int_equal(scene->type_count, 1);
    assert_int_equal(scene->batch_count, 1);
    assert_int_equal(scene->chain_count, 1);
    assert_int_equal(scene->row_count, 606);
    assert_int_equal(scene->constrained_count, 6);
    assert_near(scene->length_scale, 1.0, 1e-15);
    dmb_model_destroy(&model);
}

static void every_node_leads_to_the_next(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_string_def string = dmb_string_def_default();
    const dmb_scene *scene;
    (void)state;
    pipe.elements = 3;
    add_pipes(model, &pipe, 2);
    assert_ok(dmb_model_add_string(model, &string, &pipe.string));
    add_pipes(model, &pipe, 1);
    const dmb_body_def body = dmb_body_def_default();
    assert_ok(dmb_model_add_body(model, &body, NULL));
    scene = compiled(model);
    assert_int_equal(scene->node_count, 7 + 4 + 1);
    assert_int_equal(scene->element_count, 9);
    assert_int_equal(scene->chain_count, 3);
    assert_int_equal(scene->batch_count, 2); /* a batch stays in its chain */
    assert_int_equal(scene->chains[0].count, 7);
    assert_int_equal(scene->chains[1].first, 7);
    assert_int_equal(scene->chains[1].count, 4);
    assert_int_equal(scene->chains[2].first, 11);
    assert_int_equal(scene->chains[2].count, 1);
    for (uint32_t e = 0; e < 9; ++e) {
        assert_int_equal(scene->element_node[e], e < 6 ? e : e + 1);
        assert_int_equal(scene->node_element[scene->element_node[e]], e);
        assert_int_equal(scene->element_type[e], 0);
    }
    assert_int_equal(scene->node_element[6], DMB_NONE);
    assert_int_equal(scene->node_element[10], DMB_NONE);
    assert_int_equal(scene->node_element[11], DMB_NONE);
    assert_int_equal(scene->strings[1].first_pipe, 2);
    assert_int_equal(scene->strings[1].first_node, 7);
    assert_int_equal(scene->pipes[1].element, 3);
    assert_int_equal(scene->pipes[1].elements, 3);
    assert_int_equal(scene->pipes[1].node, 3);
    assert_int_equal(scene->pipes[2].element, 6);
    assert_int_equal(scene->pipes[2].node, 7);
    assert_int_equal(scene->bodies[0].node, 11);
    dmb_model_destroy(&model);
}

static void rigid_string_is_one_node(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_bit_def bit = dmb_bit_def_default();
    const dmb_scene *scene;
    (void)state;
    pipe.length = 1.5;
    add_pipes(model, &pipe, 30);
    assert_ok(dmb_model_add_bit(model, &bit, NULL));
    scene = compiled_with(model, DMB_FEATURE_ALL, DMB_PIPE_RIGID);
    assert_int_equal(scene->node_count, 1);
    assert_int_equal(scene->element_count, 0);
    assert_int_equal(scene->type_count, 0);
    assert_int_equal(scene->batch_count, 0);
    assert_int_equal(scene->rigid_count, 1);
    assert_int_equal(scene->structural_joint_count, 30);
    assert_int_equal(scene->free_count, 2); /* the support of the rig end holds it all */
    assert_near(scene->length_scale, 1.0, 0.0);
    assert_near(scene->strings[0].start_arm, 0.0, 0.0);
    assert_near(scene->strings[0].end_arm, 45.0, 1e-15);
    assert_near(scene->pipes[29].start, 43.5, 1e-15);
    assert_int_equal(scene->pipes[29].kind, DMB_PIPE_RIGID);
    assert_int_equal(scene->pipes[29].elements, 0);
    assert_near(scene->bits[0].arm, 45.0, 1e-15);
    assert_near(scene->bodies[0].arm, 45.0, 1e-15);
    dmb_model_destroy(&model);
}

/* rigid 2 x 1.5 | flexible 2 x 1 | rigid 1.5 | axial-torsional 3 x 1 | rigid 1.5 */
static dmb_model *mixed_model(int32_t start_free, int32_t end_free)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def rigid = dmb_pipe_def_default(), flexible = dmb_pipe_def_default(), path = dmb_pipe_def_default();
    string.start_free = start_free;
    string.end_free = end_free;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    rigid.kind = DMB_PIPE_RIGID;
    rigid.length = 1.5;
    path.kind = DMB_PIPE_AXIAL_TORSIONAL;
    add_pipes(model, &rigid, 2);
    add_pipes(model, &flexible, 2);
    add_pipes(model, &rigid, 1);
    add_pipes(model, &path, 3);
    add_pipes(model, &rigid, 1);
    return model;
}

static void mixed_string(void **state)
{
    dmb_model *model = mixed_model(DMB_FREE_CYLINDRICAL, DMB_FREE_ALL);
    const dmb_scene *scene = compiled(model);
    static const uint8_t size[] = {6, 6, 6, 2, 2, 6};
    static const int32_t kernel[] = {DMB_KERNEL_BEAM, DMB_KERNEL_MIXED, DMB_KERNEL_AXIAL_TORSIONAL, DMB_KERNEL_MIXED};
    static const uint32_t batch[] = {2, 1, 1, 1};
    (void)state;
    assert_int_equal(scene->node_count, 6);
    assert_int_equal(scene->element_count, 5);
    for (uint32_t i = 0; i < 6; ++i) assert_int_equal(scene->layout.size[i], size[i]);
    assert_int_equal(scene->row_count, 28);
    assert_int_equal(scene->layout.row[6], 28);
    assert_int_equal(scene->layout.row[4], 20);
    assert_int_equal(scene->batch_count, 4);
    for (uint32_t i = 0; i < 4; ++i) {
        assert_int_equal(scene->batches[i].kernel, kernel[i]);
        assert_int_equal(scene->batches[i].count, batch[i]);
    }
    assert_int_equal(scene->rigid_count, 3);
    assert_int_equal(scene->structural_joint_count, 8);
    /* the first body has its node at its far end, the middle one too, the last one at its near end */
    assert_near(scene->strings[0].start_arm, -3.0, 0.0);
    assert_near(scene->pipes[0].start, -3.0, 0.0);
    assert_near(scene->pipes[1].start, -1.5, 0.0);
    assert_near(scene->types[scene->element_type[0]].arm[1], 0.0, 0.0);
    assert_near(scene->types[scene->element_type[1]].arm[1], 1.5, 0.0);
    assert_near(scene->pipes[4].start, -1.5, 0.0);
    assert_int_equal(scene->pipes[4].node, 2);
    assert_near(scene->types[scene->element_type[2]].arm[0], 0.0, 0.0);
    assert_near(scene->pipes[8].start, 0.0, 0.0);
    assert_near(scene->strings[0].end_arm, 1.5, 0.0);
    assert_near(scene->strings[0].length, 11.0, 1e-15);
    assert_int_equal(scene->type_count, 2); /* pipes of both elastic kinds are equal beams */
    dmb_model_destroy(&model);
}

/* A support that acts at a point needs the node there. */
static void pinned_ends_have_their_node(void **state)
{
    dmb_model *model = mixed_model(DMB_FREE_SPHERICAL, DMB_FREE_RZ);
    const dmb_scene *scene = compiled(model);
    (void)state;
    assert_near(scene->strings[0].start_arm, 0.0, 0.0);
    assert_near(scene->pipes[1].start, 1.5, 0.0);
    assert_near(scene->types[scene->element_type[0]].arm[0], 3.0, 0.0);
    assert_near(scene->strings[0].end_arm, 0.0, 0.0);
    assert_near(scene->pipes[8].start, -1.5, 0.0);
    assert_near(scene->types[scene->element_type[4]].arm[1], 1.5, 0.0);
    for (uint32_t i = 0; i < 6; ++i) {
        assert_int_equal(scene->free_row[i], i >= 3);
        assert_int_equal(scene->free_row[22 + i], i == 5);
    }
    dmb_model_destroy(&model);
}

static void pinned_end_of_a_rigid_string(void **state)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_scene *scene;
    (void)state;
    string.start_free = DMB_FREE_ALL;
    string.end_free = DMB_FREE_SPHERICAL;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 2);
    scene = compiled(model);
    assert_near(scene->strings[0].start_arm, -2.0, 0.0);
    assert_near(scene->strings[0].end_arm, 0.0, 0.0);
    assert_int_equal(scene->free_count, 3);
    dmb_model_destroy(&model);
}

/* A drive sideways acts at the rig end, so the node is there. */
static void driven_sideways_has_its_node(void **state)
{
    dmb_model *model = new_model();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    const dmb_scene *scene;
    (void)state;
    string.start_free = DMB_FREE_ALL;
    assert_ok(dmb_model_add_string(model, &string, NULL));
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 2);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    add_pipes(model, &pipe, 2);
    drive.component = DMB_Z;
    drive.time_function = add_constant(model, 0.1);
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    scene = compiled(model);
    assert_near(scene->strings[0].start_arm, 0.0, 0.0);
    assert_int_equal(scene->drives[0].row, 2);
    assert_int_equal(scene->solved_row[2], 0);
    assert_int_equal(scene->free_row[2], 1);
    dmb_model_destroy(&model);
}

static void tool_joints_are_arms(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_scene *scene;
    (void)state;
    pipe.joint_length = 0.25;
    pipe.elements = 3;
    add_pipes(model, &pipe, 4);
    scene = compiled(model);
    assert_int_equal(scene->type_count, 2);
    assert_int_equal(scene->rigid_count, 4);
    assert_int_equal(scene->structural_joint_count, 7);
    for (uint32_t e = 0; e < 12; ++e) {
        const dmb_element_type *type = &scene->types[scene->element_type[e]];
        assert_near(type->length, 0.25, 1e-15);
        assert_near(type->arm[0], 0.0, 0.0);
        assert_near(type->arm[1], e % 3 == 2 ? 0.25 : 0.0, 0.0);
        assert_near(scene->element_span[3 * e], e % 3 == 2 ? 0.5 : 0.25, 1e-15);
    }
    assert_near(scene->pipes[2].joint, 0.25, 0.0);
    dmb_model_destroy(&model);
}

/* Equal pipes added one by one share their type. */
static void types_are_shared_between_runs(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_scene *scene;
    (void)state;
    for (int i = 0; i < 5; ++i) add_pipes(model, &pipe, 1);
    pipe.outer_diameter = 0.08;
    add_pipes(model, &pipe, 2);
    scene = compiled(model);
    assert_int_equal(scene->type_count, 2);
    assert_int_equal(scene->element_type[4], 0);
    assert_int_equal(scene->element_type[5], 1);
    assert_int_equal(scene->element_type[6], 1);
    dmb_model_destroy(&model);
}

static void path_string_and_its_drives(void **state)
{
    dmb_model *model = new_model();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    const dmb_scene *scene;
    (void)state;
    add_pipes(model, &pipe, 4);
    drive.time_function = add_constant(model, 0.1);
    drive.component = DMB_RX;
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    drive.component = DMB_X;
    drive.kind = DMB_DRIVE_LOAD;
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    scene = compiled_with(model, DMB_FEATURE_ALL, DMB_PIPE_AXIAL_TORSIONAL);
    assert_int_equal(scene->row_count, 10);
    assert_int_equal(scene->free_count, 9);
    assert_int_equal(scene->prescribed_count, 1);
    assert_int_equal(scene->drives[0].row, 1);
    assert_int_equal(scene->drives[1].row, 0);
    assert_int_equal(scene->solved_row[0], 1);
    assert_int_equal(scene->solved_row[1], 0);
    assert_int_equal(scene->constrained_count, 1);
    assert_int_equal(scene->constrained_node[0], 0);
    assert_int_equal(scene->constrained_component[0], 1);
    assert_int_equal(scene->batches[0].kernel, DMB_KERNEL_AXIAL_TORSIONAL);
    dmb_model_destroy(&model);
}

/* One axial-torsional element between two rigid bodies has no freedom sideways left to leave out: it is a beam. */
static void path_between_full_nodes_is_a_beam(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_scene *scene;
    (void)state;
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 1);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    add_pipes(model, &pipe, 1);
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 1);
    scene = compiled(model);
    assert_int_equal(scene->batch_count, 1);
    assert_int_equal(scene->batches[0].kernel, DMB_KERNEL_BEAM);
    dmb_model_destroy(&model);
}

/* Runs of two strings in turns. */
static void strings_described_in_turns(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_string_def string = dmb_string_def_default();
    dmb_id a = {0, 0}, b = {0, 0};
    const dmb_scene *scene;
    (void)state;
    assert_ok(dmb_model_add_string(model, &string, &a));
    assert_ok(dmb_model_add_string(model, &string, &b));
    for (int i = 0; i < 6; ++i) {
        pipe.string = i % 2 ? b : a;
        pipe.length = 1.0 + i;
        add_pipes(model, &pipe, 1);
    }
    scene = compiled(model);
    for (uint32_t i = 0; i < 3; ++i) {
        assert_near(scene->pipes[i].length, 1.0 + 2.0 * i, 0.0);
        assert_near(scene->pipes[3 + i].length, 2.0 + 2.0 * i, 0.0);
    }
    assert_near(scene->strings[0].length, 9.0, 0.0);
    assert_near(scene->strings[1].length, 12.0, 0.0);
    assert_near(scene->length, 21.0, 0.0);
    dmb_model_destroy(&model);
}

static void loads_find_pipe_ends(void **state)
{
    dmb_model *model = mixed_model(DMB_FREE_CYLINDRICAL, DMB_FREE_ALL);
    const dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_id body_id, bit_id, string = {0, 0};
    static const struct {
        uint32_t pipe;
        double fraction;
        uint32_t node;
        double arm;
    } ends[] = {{0, 0.0, 0, -3.0}, {0, 1.0, 0, -1.5}, {1, 1.0, 0, 0.0}, {2, 0.0, 0, 0.0}, {2, 1.0, 1, 0.0},
                {3, 1.0, 2, -1.5}, {4, 0.0, 2, -1.5}, {4, 1.0, 2, 0.0}, {7, 1.0, 5, 0.0}, {8, 1.0, 5, 1.5}};
    const dmb_scene *scene;
    (void)state;
    string = dmb_model_id(model, DMB_PART_STRING, 0);
    assert_ok(dmb_model_add_bit(model, &bit, &bit_id));
    assert_ok(dmb_model_add_body(model, &body, NULL));
    body.attach = DMB_ATTACH_START;
    assert_ok(dmb_model_add_body(model, &body, &body_id));
    for (size_t i = 0; i < 10; ++i) {
        load.place = dmb_station(string, ends[i].pipe, ends[i].fraction);
        load.force[0] = (double)i;
        assert_ok(dmb_model_add_load(model, &load, NULL));
    }
    load.time_function = add_constant(model, 2.0);
    load.place = dmb_station(bit_id, 0, 0.0);
    assert_ok(dmb_model_add_load(model, &load, NULL));
    load.place = dmb_station(body_id, 0, 0.0);
    assert_ok(dmb_model_add_load(model, &load, NULL));
    scene = compiled(model);
    for (size_t i = 0; i < 10; ++i) {
        assert_int_equal(scene->loads[i].node, ends[i].node);
        assert_close(scene->loads[i].arm, ends[i].arm, 0.0);
        assert_near(scene->loads[i].force[0], (double)i, 0.0);
        assert_int_equal(scene->loads[i].time_function, DMB_NONE);
    }
    assert_int_equal(scene->loads[10].node, 5);
    assert_near(scene->loads[10].arm, 1.5, 0.0);
    assert_int_equal(scene->loads[10].time_function, 0);
    assert_int_equal(scene->loads[11].node, 0);
    assert_near(scene->loads[11].arm, -3.0, 0.0);
    dmb_model_destroy(&model);
}

/* With joints the pipe ends where the joint does, before the rigid pipes that follow. */
static void load_at_a_joint_before_rigid_pipes(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    const dmb_scene *scene;
    (void)state;
    pipe.joint_length = 0.25;
    add_pipes(model, &pipe, 1);
    pipe.kind = DMB_PIPE_RIGID;
    add_pipes(model, &pipe, 2);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    add_pipes(model, &pipe, 1);
    load.place = dmb_station(dmb_model_id(model, DMB_PART_STRING, 0), 0, 1.0);
    assert_ok(dmb_model_add_load(model, &load, NULL));
    scene = compiled(model);
    assert_int_equal(scene->loads[0].node, 1);
    assert_near(scene->loads[0].arm, -2.0, 0.0);
    assert_near(scene->types[scene->element_type[0]].arm[1], 2.25, 0.0);
    dmb_model_destroy(&model);
}

/* With the node at the rig end, the first flexible pipe begins away from it. */
static void load_at_the_near_end_behind_an_arm(void **state)
{
    dmb_model *model = mixed_model(DMB_FREE_SPHERICAL, DMB_FREE_ALL);
    dmb_load_def load = dmb_load_def_default();
    const dmb_scene *scene;
    (void)state;
    load.place = dmb_station(dmb_model_id(model, DMB_PART_STRING, 0), 2, 0.0);
    assert_ok(dmb_model_add_load(model, &load, NULL));
    scene = compiled(model);
    assert_int_equal(scene->loads[0].node, 0);
    assert_near(scene->loads[0].arm, 3.0, 0.0);
    dmb_model_destroy(&model);
}

static void free_body_masks_and_drives(void **state)
{
    dmb_model *model = new_model();
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    const dmb_scene *scene;
    (void)state;
    body.free_mask = DMB_FREE_X | DMB_FREE_Z | DMB_FREE_RY;
    body.velocity[4] = 2.5;
    assert_ok(dmb_model_add_body(model, &body, NULL));
    assert_ok(dmb_model_add_body(model, &body, &drive.part));
    drive.component = DMB_RY;
    drive.time_function = add_constant(model, 1.0);
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    scene = compiled(model);
    assert_int_equal(scene->node_count, 2);
    assert_int_equal(scene->free_count, 5);
    assert_int_equal(scene->prescribed_count, 1);
    assert_int_equal(scene->constrained_count, 7);
    assert_int_equal(scene->drives[0].row, 10);
    assert_int_equal(scene->drives[0].node, 1);
    assert_near(scene->initial_velocity[4], 2.5, 0.0);
    assert_int_equal(scene->rigid_count, 2);
    assert_int_equal(scene->structural_joint_count, 0);
    dmb_model_destroy(&model);
}

static void bit_laws_and_history(void **state)
{
    dmb_model *model = new_model();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_string_def string = dmb_string_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    const dmb_scene *scene;
    (void)state;
    for (int i = 0; i < 3; ++i) {
        assert_ok(dmb_model_add_string(model, &string, &pipe.string));
        add_pipes(model, &pipe, 1);
        bit.string = pipe.string;
        bit.rock_law = i == 1 ? DMB_ROCK_RATE : DMB_ROCK_REGENERATIVE;
        bit.history = 100u * (uint32_t)(i + 1);
        bit.load = i == 0 ? add_constant(model, 2960.0) : (dmb_id){0, 0};
        assert_ok(dmb_model_add_bit(model, &bit, NULL));
    }
    scene = compiled(model);
    assert_int_equal(scene->history_count, 400);
    assert_int_equal(scene->bits[0].history_first, 0);
    assert_int_equal(scene->bits[0].history_capacity, 100);
    assert_int_equal(scene->bits[0].load, 0);
    assert_int_equal(scene->bits[1].history_capacity, 0);
    assert_int_equal(scene->bits[1].law.kind, DMB_ROCK_RATE);
    assert_int_equal(scene->bits[1].load, DMB_NONE);
    assert_int_equal(scene->bits[2].history_first, 100);
    assert_int_equal(scene->bits[2].history_capacity, 300);
    assert_int_equal(scene->bits[2].node, 5);
    assert_int_equal(scene->features & DMB_FEATURE_ROCK, DMB_FEATURE_ROCK);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(reference_scene),
        TEST(every_node_leads_to_the_next),
        TEST(rigid_string_is_one_node),
        TEST(mixed_string),
        TEST(pinned_ends_have_their_node),
        TEST(pinned_end_of_a_rigid_string),
        TEST(driven_sideways_has_its_node),
        TEST(tool_joints_are_arms),
        TEST(types_are_shared_between_runs),
        TEST(path_string_and_its_drives),
        TEST(path_between_full_nodes_is_a_beam),
        TEST(strings_described_in_turns),
        TEST(loads_find_pipe_ends),
        TEST(load_at_a_joint_before_rigid_pipes),
        TEST(load_at_the_near_end_behind_an_arm),
        TEST(free_body_masks_and_drives),
        TEST(bit_laws_and_history),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
