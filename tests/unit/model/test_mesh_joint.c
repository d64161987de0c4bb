/* Joints from their description to frames, constraints, clusters and blocks. */
#include "model_test.h"

#include "math/so3.h"

static dmb_id add_body(dmb_model *model, double x, double y, double z, const double rotation[3])
{
    dmb_body_def body = dmb_body_def_default();
    dmb_id id = {0, 0};
    const double position[3] = {x, y, z};
    memcpy(body.position, position, sizeof position);
    if (rotation != NULL) memcpy(body.rotation, rotation, sizeof body.rotation);
    assert_ok(dmb_model_add_body(model, &body, &id));
    return id;
}

static dmb_joint_def joint_between(int32_t kind, dmb_place a, dmb_place b)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = kind;
    joint.place_a = a;
    joint.place_b = b;
    return joint;
}

static dmb_place on(dmb_id part)
{
    return dmb_station(part, 0, 0.0);
}

static dmb_id add_joint(dmb_model *model, const dmb_joint_def *joint)
{
    dmb_id id = {0, 0};
    const int32_t status = dmb_model_add_joint(model, joint, &id);
    if (status != DMB_OK) print_error("%s\n", dmb_model_message(model));
    assert_int_equal(status, DMB_OK);
    return id;
}

static dmb_id join(dmb_model *model, int32_t kind, dmb_place a, dmb_place b)
{
    const dmb_joint_def joint = joint_between(kind, a, b);
    return add_joint(model, &joint);
}

static void expect_matrix(const double A[9], const double B[9], double tolerance)
{
    for (int i = 0; i < 9; ++i) assert_close(A[i], B[i], tolerance);
}

/* A straight string of its own, along x from (x, y, z). */
static dmb_id add_string(dmb_model *model, double x, double y, double z, uint32_t pipes, uint32_t elements,
                         double joint_length)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_id id = {0, 0};
    string.start_free = DMB_FREE_ALL;
    string.follows_hole = 0;
    string.position[0] = x;
    string.position[1] = y;
    string.position[2] = z;
    assert_ok(dmb_model_add_string(model, &string, &id));
    pipe.string = id;
    pipe.elements = elements;
    pipe.joint_length = joint_length;
    add_pipes(model, &pipe, pipes);
    return id;
}

/* ---- Frames ------------------------------------------------------------------------------------------------------ */

static void axes(void **state)
{
    dmb_model *model = new_model();
    const dmb_id a = add_body(model, 0.0, 0.0, 0.0, NULL), b = add_body(model, 1.0, 2.0, 3.0, NULL);
    dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, on(a), on(b));
    const double along_y[] = {0.0, 2.0, 0.0}, slanted[] = {3.0, 0.0, 3.0}, normal[] = {0.0, 0.0, 1e-200};
    const double r = sqrt(0.5), Ma[9] = {0, 0, 1, 1, 0, 0, 0, 1, 0}, Mb[9] = {r, -r, 0, 0, 0, -1, r, r, 0};
    (void)state;
    memcpy(joint.axis_a, along_y, sizeof along_y); /* default normal: z, as y is along the axis */
    memcpy(joint.axis_b, slanted, sizeof slanted);
    memcpy(joint.normal_b, normal, sizeof normal);
    joint.origin_a[2] = 0.5;
    joint.origin_b[0] = -0.25;
    add_joint(model, &joint);
    const dmb_scene_joint *made = compiled(model)->joints;
    expect_matrix(made->a.M, Ma, 1e-15);
    expect_matrix(made->b.M, Mb, 1e-15);
    assert_near(made->a.x[2], 0.5, 0.0);
    assert_near(made->b.x[0], -0.25, 0.0);
    assert_int_equal(made->a.node, 0);
    assert_int_equal(made->b.node, 1);
    for (int k = 0; k < 3; ++k) assert_near(made->span[k], k + 1.0, 0.0);
    assert_int_equal(made->law, DMB_NONE);
    assert_int_equal(made->law_mask, 0);
    assert_int_equal(model->scene->law_count, 0);
    dmb_model_destroy(&model);
}

/* Frame b lies on frame a in the world at time 0. */
static void expect_matched(const dmb_scene *scene, const dmb_scene_joint *joint, double tolerance)
{
    double Ra[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, Rb[9], Ma[9], Mb[9], xa[3], xb[3];
    if (joint->a.node != DMB_NONE) dmb_quat_to_matrix(scene->reference_quaternion + 4 * joint->a.node, Ra);
    dmb_quat_to_matrix(scene->reference_quaternion + 4 * joint->b.node, Rb);
    dmb_mat3_mul(Ra, joint->a.M, Ma);
    dmb_mat3_mul(Rb, joint->b.M, Mb);
    expect_matrix(Ma, Mb, 1e-14);
    dmb_mat3_vec(Ra, joint->a.x, xa);
    dmb_mat3_vec(Rb, joint->b.x, xb);
    for (int k = 0; k < 3; ++k) assert_close(xa[k], xb[k] + joint->span[k], tolerance);
}

static void match(void **state)
{
    const double turned[] = {0.3, -0.4, 0.5}, other[] = {-1.0, 0.2, 0.7}, axis[] = {1.0, 2.0, -2.0};
    dmb_model *model = new_model();
    const dmb_id a = add_body(model, 0.1, 0.2, 0.3, turned), b = add_body(model, 1.0, -2.0, 3.0, other);
    dmb_joint_def joint = joint_between(DMB_JOINT_UNIVERSAL, on(a), on(b));
    (void)state;
    joint.match = 1;
    joint.origin_a[1] = 0.7;
    joint.origin_b[0] = (double)NAN; /* counts for nothing */
    memcpy(joint.axis_a, axis, sizeof axis);
    add_joint(model, &joint);
    memset(&joint.place_a, 0, sizeof joint.place_a);
    add_joint(model, &joint);
    const dmb_scene *scene = compiled(model);
    expect_matched(scene, &scene->joints[0], 1e-14);
    expect_matched(scene, &scene->joints[1], 1e-14);
    assert_int_equal(scene->joints[1].a.node, DMB_NONE);
    assert_near(scene->joints[1].span[1], -2.0, 0.0);
    dmb_model_destroy(&model);
}

static void laws(void **state)
{
    dmb_model *model = new_model();
    const dmb_id a = add_body(model, 0.0, 0.0, 0.0, NULL), b = add_body(model, 1.0, 0.0, 0.0, NULL);
    dmb_joint_def joint = joint_between(DMB_JOINT_FREE, on(a), on(b));
    (void)state;
    join(model, DMB_JOINT_SPHERICAL, on(a), on(b));
    joint.stiffness[DMB_RX] = 5.0;
    joint.rest[DMB_RX] = 0.1;
    joint.stop_high[DMB_Z] = 0.2;
    joint.friction[DMB_RZ] = 3.0;
    joint.initial_mask = DMB_FREE_X;
    joint.initial_position[DMB_X] = 1.5;
    joint.initial_speed[DMB_X] = -2.5;
    memcpy(joint.name, "spring", 7);
    add_joint(model, &joint);
    const dmb_scene *scene = compiled(model);
    const dmb_scene_joint *made = &scene->joints[1];
    assert_int_equal(scene->law_count, 6);
    assert_int_equal(made->law, 0);
    assert_int_equal(made->law_mask, 1 << DMB_RX | 1 << DMB_Z | 1 << DMB_RZ);
    assert_near(scene->laws[DMB_RX].stiffness, 5.0, 0.0);
    assert_near(scene->laws[DMB_RX].rest, 0.1, 0.0);
    assert_near(scene->laws[DMB_Z].stop_high, 0.2, 0.0);
    assert_near(scene->laws[DMB_RZ].friction, 3.0, 0.0);
    assert_near(scene->laws[DMB_RZ].friction_speed, 1e-3, 0.0);
    assert_int_equal(made->initial_mask, 1);
    assert_near(made->initial_position[0], 1.5, 0.0);
    assert_near(made->initial_speed[0], -2.5, 0.0);
    assert_string_equal(made->name, "spring");
    dmb_model_destroy(&model);
}

/* ---- Places ------------------------------------------------------------------------------------------------------ */

/* Two pipes of two elements with tool joints of 0.1 m in 1.5 m, the second string of rigid pipes: ends, element ends,
 * tool joints, any place of a rigid pipe. */
static void places(void **state)
{
    dmb_model *model = new_model();
    const dmb_id string = add_string(model, 0.0, 0.0, 0.0, 2, 2, 0.1), body = add_body(model, 0.0, 1.0, 0.0, NULL);
    const double L = 1.5, fraction[] = {0.0, 0.5 * 1.4 / L, 1.4 / L, 1.45 / L, 1.0, 0.5 * 1.4 / L + 1e-11};
    const uint32_t node[] = {2, 3, 4, 4, 4, 3};
    const double arm[] = {0.0, 0.0, -0.1, -0.05, 0.0, 0.0};
    dmb_pipe_def rigid = s1_pipe();
    dmb_string_def apart = dmb_string_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_id second = {0, 0}, tool = {0, 0};
    (void)state;
    apart.position[2] = 1.0;
    apart.start_free = DMB_FREE_ALL;
    assert_ok(dmb_model_add_string(model, &apart, &second));
    rigid.string = second;
    rigid.kind = DMB_PIPE_RIGID;
    add_pipes(model, &rigid, 2);
    bit.string = string;
    assert_ok(dmb_model_add_bit(model, &bit, &tool));
    for (size_t i = 0; i < 6; ++i) join(model, DMB_JOINT_SPHERICAL, on(body), dmb_station(string, 1, fraction[i]));
    join(model, DMB_JOINT_SPHERICAL, dmb_station(second, 1, 0.3), on(tool));
    const dmb_scene *scene = compiled(model);
    for (uint32_t i = 0; i < 6; ++i) {
        assert_int_equal(scene->joints[i].b.node, node[i]);
        assert_close(scene->joints[i].b.x[0], arm[i], 1e-14);
    }
    const dmb_scene_joint *last = &scene->joints[6];
    assert_int_equal(last->a.node, 5);
    assert_near(last->a.x[0] + scene->reference_position[15], 1.3 * L, 1e-15);
    assert_int_equal(last->b.node, 4);
    assert_near(last->b.x[0], 0.0, 0.0);
    dmb_model_destroy(&model);
}

/* A distance along a string far away from the origin keeps the digits of the pipes' length. */
static void spans_far_away(void **state)
{
    dmb_model *model = new_model();
    const dmb_id string = add_string(model, 1e8, 1.0, 0.0, 3, 2, 0.0);
    (void)state;
    join(model, DMB_JOINT_SPHERICAL, dmb_station(string, 0, 0.5), dmb_station(string, 2, 0.0));
    join(model, DMB_JOINT_SPHERICAL, dmb_station(string, 2, 1.0), dmb_station(string, 0, 0.0));
    const dmb_scene *scene = compiled(model);
    assert_near(scene->joints[0].span[0], 2.25, 0.0);
    assert_near(scene->joints[1].span[0], -4.5, 0.0);
    assert_near(scene->joints[1].span[1], 0.0, 0.0);
    dmb_model_destroy(&model);
}

static void point_on_hole(void **state)
{
    dmb_model *model = new_model();
    const dmb_id body = add_body(model, 3.0, 0.0, 0.0, NULL);
    dmb_joint_def joint = joint_between(DMB_JOINT_POINT_ON_HOLE, dmb_station((dmb_id){0, 0}, 0, 0.0), on(body));
    const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    (void)state;
    joint.origin_a[0] = 7.0; /* the hole's frame counts instead */
    joint.origin_b[1] = 0.1;
    add_wall(model);
    add_joint(model, &joint);
    const dmb_scene_joint *made = compiled(model)->joints;
    assert_near(made->a.x[0], 0.0, 0.0);
    expect_matrix(made->a.M, identity, 0.0);
    assert_near(made->span[0], 3.0, 0.0);
    assert_near(made->b.x[1], 0.1, 0.0);
    assert_int_equal(made->a.node, DMB_NONE);
    dmb_model_destroy(&model);
}

/* ---- Constraints and clusters ------------------------------------------------------------------------------------ */

static void two_bodies(void **state)
{
    dmb_model *model = new_model();
    const dmb_id a = add_body(model, 0.0, 0.0, 0.0, NULL), alone = add_body(model, 5.0, 0.0, 0.0, NULL);
    const dmb_id b = add_body(model, 1.0, 0.0, 0.0, NULL);
    (void)state;
    (void)alone;
    join(model, DMB_JOINT_REVOLUTE, on(b), on(a));
    const dmb_scene *scene = compiled(model);
    const dmb_constraint *constraint = scene->constraints;
    const dmb_cluster *cluster = scene->clusters;
    const uint32_t columns[12] = {0, 1, 2, 3, 4, 5, 12, 13, 14, 15, 16, 17};
    assert_int_equal(scene->constraint_count, 1);
    assert_int_equal(constraint->kind, DMB_OF_JOINT);
    assert_int_equal(constraint->rows, 6);
    assert_int_equal(constraint->columns, 12);
    assert_int_equal(constraint->node_count, 2);
    assert_int_equal(constraint->node[0], 2); /* a's node first */
    assert_int_equal(constraint->node[1], 0);
    assert_int_equal(constraint->column[1], 6);
    assert_int_equal(scene->joints[0].constraint, 0);
    assert_int_equal(scene->cluster_count, 1);
    assert_int_equal(cluster->columns, 12);
    assert_int_equal(cluster->rows, 6);
    assert_int_equal(scene->cluster_nodes[0], 0); /* ascending */
    assert_int_equal(scene->cluster_nodes[1], 2);
    assert_memory_equal(scene->cluster_columns, columns, sizeof columns);
    assert_int_equal(scene->node_place[2], 6);
    assert_int_equal(scene->node_block[1], DMB_NONE);
    assert_int_equal(scene->node_cluster[1], DMB_NONE);
    assert_int_equal(scene->reduced_count, 2);
    assert_int_equal(scene->block_count, 1);
    assert_int_equal(scene->pattern.n, 1);
    assert_int_equal(scene->pattern.rows, 18);
    assert_true(scene->chains[0].jointed && !scene->chains[1].jointed && scene->chains[2].jointed);
    assert_int_equal(scene->dense_count, 72);
    assert_int_equal(scene->square_count, 36);
    assert_int_equal(scene->six_dof_count, 144);
    assert_int_equal(scene->jacobian_count, 72);
    assert_int_equal(scene->tangent_count, 144);
    dmb_model_destroy(&model);
}

/* Offsets are those of running sums, rows go on within and from cluster to cluster. */
static void expect_consistent(const dmb_scene *scene)
{
    uint32_t row = 0, constraint = 0, node = 0, column = 0;
    size_t dense = 0, square = 0, full = 0;
    for (uint32_t c = 0; c < scene->cluster_count; ++c) {
        const dmb_cluster *cluster = &scene->clusters[c];
        uint32_t rows = 0;
        assert_int_equal(cluster->constraint, constraint);
        assert_int_equal(cluster->row, row);
        assert_int_equal(cluster->node, node);
        assert_int_equal(cluster->column, column);
        assert_int_equal(cluster->block, c);
        assert_int_equal(cluster->dense, dense);
        assert_int_equal(cluster->square, square);
        assert_int_equal(cluster->full, full);
        for (uint32_t i = 0; i < cluster->constraint_count; ++i) {
            const dmb_constraint *of = &scene->constraints[constraint + i];
            assert_int_equal(of->cluster, c);
            assert_int_equal(of->row, row + rows);
            for (uint32_t k = 0; k < of->node_count; ++k) assert_int_equal(scene->node_cluster[of->node[k]], c);
            if (i > 0) assert_true(of[-1].kind <= of->kind);
            rows += of->rows;
        }
        assert_int_equal(cluster->rows, rows);
        row += rows;
        constraint += cluster->constraint_count;
        node += cluster->node_count;
        column += cluster->columns;
        dense += (size_t)cluster->rows * cluster->columns;
        square += (size_t)cluster->rows * cluster->rows;
        full += (size_t)cluster->columns * cluster->columns;
    }
    assert_int_equal(row, scene->constraint_row_count);
    assert_int_equal(constraint, scene->constraint_count);
    assert_int_equal(node, scene->constraint_node_count);
    assert_int_equal(column, scene->cluster_column_count);
    assert_int_equal(dense, scene->dense_count);
    assert_int_equal(square, scene->square_count);
    assert_int_equal(full, scene->six_dof_count);
}

static void expect_links(const dmb_scene *scene)
{
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        const size_t *link = scene->off_diagonal_offset + 2 * i;
        const int leads = scene->node_element[i] != DMB_NONE && scene->node_block[i] != DMB_NONE &&
                          scene->node_block[i] != scene->node_block[i + 1];
        if (!leads) {
            assert_true(link[0] == SIZE_MAX && link[1] == SIZE_MAX);
            continue;
        }
        const uint32_t a = scene->node_block[i], b = scene->node_block[i + 1];
        assert_true(link[0] != SIZE_MAX && link[1] != SIZE_MAX && link[0] != link[1]);
        assert_true(link[0] == dmb_block_pattern_offset(&scene->pattern, a, b));
        assert_true(link[1] == dmb_block_pattern_offset(&scene->pattern, b, a));
    }
}

/* One drill string made of a hundred pieces: each joint is a cluster of two nodes, and the blocks make a chain. */
static void hundred_strings(void **state)
{
    enum { COUNT = 100 };
    dmb_model *model = new_model();
    dmb_id string[COUNT];
    (void)state;
    for (uint32_t i = 0; i < COUNT; ++i) string[i] = add_string(model, 1.5 * i, 0.0, 0.0, 1, 1, 0.0);
    for (uint32_t i = COUNT - 1; i > 0; --i) {
        join(model, DMB_JOINT_FIXED, dmb_station(string[i - 1], 0, 1.0), dmb_station(string[i], 0, 0.0));
    }
    const dmb_scene *scene = compiled(model);
    assert_int_equal(scene->node_count, 2 * COUNT);
    assert_int_equal(scene->cluster_count, COUNT - 1);
    assert_int_equal(scene->reduced_count, 2 * COUNT);
    assert_int_equal(scene->block_count, COUNT + 1);
    assert_int_equal(scene->pattern.entries, COUNT);
    assert_int_equal(scene->pattern.fill, 0);
    for (uint32_t c = 0; c + 1 < COUNT; ++c) {
        assert_int_equal(scene->clusters[c].columns, 12);
        assert_int_equal(scene->cluster_nodes[2 * c], 2 * c + 1);
        assert_int_equal(scene->cluster_nodes[2 * c + 1], 2 * c + 2);
        /* joints were described backwards */
        assert_int_equal(scene->constraints[c].index, COUNT - 2 - c);
        assert_int_equal(scene->joints[COUNT - 2 - c].constraint, c);
    }
    assert_int_equal(scene->node_block[0], COUNT - 1);
    assert_int_equal(scene->node_block[2 * COUNT - 1], COUNT);
    expect_consistent(scene);
    expect_links(scene);
    assert_non_null(strstr(dmb_model_message(model), "99 joints, 99 constraints in 99 clusters"));
    dmb_model_destroy(&model);
}

/* Four strings in a ring: a closed chain of clusters, whose elimination fills one pair. */
static void ring(void **state)
{
    dmb_model *model = new_model();
    dmb_id string[4];
    (void)state;
    for (uint32_t i = 0; i < 4; ++i) string[i] = add_string(model, 0.0, i, 0.0, 1, 1, 0.0);
    for (uint32_t i = 0; i < 4; ++i) {
        join(model, DMB_JOINT_REVOLUTE, dmb_station(string[i], 0, 1.0), dmb_station(string[(i + 1) % 4], 0, 0.0));
    }
    const dmb_scene *scene = compiled(model);
    assert_int_equal(scene->cluster_count, 4);
    assert_int_equal(scene->block_count, 4);
    assert_int_equal(scene->pattern.entries, 5);
    assert_int_equal(scene->pattern.fill, 1);
    assert_int_equal(scene->clusters[0].columns, 12);
    assert_int_equal(scene->cluster_nodes[1], 7); /* the first string's start, the last one's end */
    expect_consistent(scene);
    expect_links(scene);
    dmb_model_destroy(&model);
}

/* A joint within a string: both ends of an element in one block, and a chain that goes on behind. */
static void within_a_string(void **state)
{
    dmb_model *model = new_model();
    const dmb_id string = add_string(model, 0.0, 0.0, 0.0, 4, 1, 0.0);
    (void)state;
    add_string(model, 0.0, 1.0, 0.0, 4, 1, 0.0);
    join(model, DMB_JOINT_DISTANCE, dmb_station(string, 1, 0.0), dmb_station(string, 1, 1.0));
    const dmb_scene *scene = compiled(model);
    assert_int_equal(scene->reduced_count, 5);
    assert_int_equal(scene->block_count, 4);
    assert_true(scene->off_diagonal_offset[2] == SIZE_MAX);
    assert_true(scene->off_diagonal_offset[0] != SIZE_MAX && scene->off_diagonal_offset[4] != SIZE_MAX);
    assert_int_equal(scene->chains[1].jointed, 0);
    expect_consistent(scene);
    expect_links(scene);
    dmb_model_destroy(&model);
}

static int32_t nothing(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                       double *jacobian)
{
    (void)context, (void)time, (void)count, (void)poses, (void)jacobian;
    value[0] = 0.0;
    return 0;
}

/* Two pairs of bodies; a coupling between them makes them one cluster. Drives and callbacks come after. */
static void all_kinds(void **state)
{
    dmb_model *model = new_model();
    dmb_id body[5], joint[2];
    dmb_coupling_def coupling = dmb_coupling_def_default();
    dmb_constraint_def constraint = dmb_constraint_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    (void)state;
    for (int i = 0; i < 5; ++i) body[i] = add_body(model, i, 0.0, 0.0, NULL);
    joint[0] = join(model, DMB_JOINT_REVOLUTE, on(body[3]), on(body[4]));
    joint[1] = join(model, DMB_JOINT_CYLINDRICAL, on(body[0]), on(body[1]));
    coupling.joint[0] = joint[0];
    coupling.joint[1] = joint[1];
    coupling.component[1] = DMB_X;
    coupling.ratio = -2.0;
    assert_ok(dmb_model_add_coupling(model, &coupling, NULL));
    drive.time_function = add_constant(model, 1.0);
    drive.part = joint[0];
    drive.component = DMB_RX;
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    drive.kind = DMB_DRIVE_LOAD;
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    constraint.place_count = 2;
    constraint.place[0] = constraint.place[1] = on(body[2]);
    constraint.row_count = 3;
    constraint.callback = nothing;
    assert_ok(dmb_model_add_constraint(model, &constraint, NULL));
    const dmb_scene *scene = compiled(model);
    assert_int_equal(scene->cluster_count, 2);
    assert_int_equal(scene->clusters[0].columns, 24);
    assert_int_equal(scene->clusters[0].rows, 6 + 6 + 1 + 1);
    assert_int_equal(scene->clusters[1].columns, 6);
    assert_int_equal(scene->clusters[1].rows, 3);
    assert_int_equal(scene->couplings[0].constraint, 2);
    assert_int_equal(scene->constraints[2].columns, 24);
    assert_int_equal(scene->constraints[2].node[0], 3);
    assert_int_equal(scene->drives[0].constraint, 3);
    assert_int_equal(scene->drives[0].joint, 0);
    assert_int_equal(scene->drives[0].node, DMB_NONE);
    assert_int_equal(scene->drives[0].row, DMB_NONE);
    assert_int_equal(scene->drives[1].constraint, DMB_NONE);
    assert_int_equal(scene->drives[1].joint, 0);
    assert_int_equal(scene->callbacks[0].constraint, 4);
    assert_int_equal(scene->constraints[4].node_count, 1); /* two places on one node */
    assert_int_equal(scene->prescribed_count, 0);
    expect_consistent(scene);
    dmb_model_destroy(&model);
}

/* Nothing of it is there without joints: the same scene as with arrays of no length. */
static void plain_string(void **state)
{
    dmb_model *model = new_model();
    dmb_drive_def drive = dmb_drive_def_default();
    (void)state;
    add_string(model, 0.0, 0.0, 0.0, 10, 2, 0.0);
    drive.time_function = add_constant(model, 1.0);
    assert_ok(dmb_model_add_drive(model, &drive, NULL));
    const dmb_scene *scene = compiled(model);
    assert_int_equal(scene->cluster_count + scene->constraint_count + scene->joint_count + scene->reduced_count, 0);
    assert_int_equal(scene->block_count + scene->constraint_row_count + scene->cluster_column_count, 0);
    assert_null(scene->joints);
    assert_null(scene->node_block);
    assert_null(scene->off_diagonal_offset);
    assert_null(scene->pattern.block);
    assert_int_equal(scene->chains[0].jointed, 0);
    assert_int_equal(scene->drives[0].joint, DMB_NONE);
    assert_int_equal(scene->drives[0].constraint, DMB_NONE);
    assert_int_equal(scene->drives[0].row, 0);
    assert_null(strstr(dmb_model_message(model), "joint"));
    dmb_model_destroy(&model);
}

static void counts_told(void **state)
{
    dmb_model *model = new_model();
    const dmb_id a = add_body(model, 0.0, 0.0, 0.0, NULL), b = add_body(model, 1.0, 0.0, 0.0, NULL);
    dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, on(a), on(b));
    dmb_model_info info = dmb_model_info_default();
    (void)state;
    add_joint(model, &joint);
    joint.state = DMB_JOINT_LOCKED;
    add_joint(model, &joint);
    joint.state = DMB_JOINT_OPEN;
    add_joint(model, &joint);
    (void)compiled(model);
    assert_ok(dmb_model_get_info(model, &info));
    assert_int_equal(info.joints, 3);
    assert_int_equal(info.constraint_rows, 11);
    assert_int_equal(info.clusters, 1);
    assert_int_equal(info.reduced_nodes, 2);
    assert_true(info.model_bytes > model->scene->bytes);
    info.struct_size = 72; /* a caller of the first release */
    info.clusters = 77;
    assert_ok(dmb_model_get_info(model, &info));
    assert_int_equal(info.clusters, 77);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(axes),          TEST(match),        TEST(laws),        TEST(places),          TEST(spans_far_away),
        TEST(point_on_hole), TEST(two_bodies),   TEST(ring),        TEST(hundred_strings), TEST(within_a_string),
        TEST(all_kinds),     TEST(plain_string), TEST(counts_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
