/* The model check: counts of parts and joints, Gruebler count, degrees of freedom by rank, redundant equations by name,
 * the solver chosen, warnings. Counts by hand; those of the reference system from its report: 2 rigid and 100 flexible
 * parts, 101 fixed joints, one cylindrical pair, 2 drives. */
#include <stdlib.h>
#include <string.h>

#include "rig.h"

enum { PIPES = 100, TEXT = 8192 };

static dmb_check_report check_of(const rig *s)
{
    dmb_check_report report = dmb_check_report_default();
    must(s, dmb_analysis_check(s->sim, &report));
    return report;
}

static char sheet[TEXT];

static const char *text_of(const rig *s)
{
    size_t needed = 0;
    assert_int_equal(dmb_analysis_check_text(s->sim, sheet, sizeof sheet, &needed), DMB_OK);
    assert_int_equal(needed, strlen(sheet) + 1);
    print_message("%s", sheet);
    return sheet;
}

static void expect_line(const char *text, const char *part)
{
    if (strstr(text, part) == NULL) fail_msg("not in the sheet: %s", part);
}

static void expect_no_line(const char *text, const char *part)
{
    if (strstr(text, part) != NULL) fail_msg("in the sheet: %s", part);
}

static dmb_place at(dmb_id part)
{
    return dmb_station(part, 0, 0.0);
}

static dmb_id connect(rig *s, int32_t kind, dmb_place a, dmb_place b, const char *name)
{
    dmb_joint_def joint = joint_between(kind, a, b);
    joint.match = 1;
    strncpy(joint.name, name, sizeof joint.name - 1);
    return add_joint(s, &joint);
}

static const dmb_place ground = {{0, 0}, 0, 0, 0.0};

/* ---- Mechanisms -------------------------------------------------------------------------------------------------- */

static dmb_id bar(rig *s, double x, double z)
{
    dmb_body_def body = dmb_body_def_default();
    body.position[0] = x;
    body.position[2] = z;
    return add_body(s, &body);
}

/* A hinge about the world's y axis at (x, 0, z); body frames are parallel to the world's. */
static dmb_id hinge(rig *s, dmb_id a, dmb_id b, const double from_a[3], const char *name)
{
    dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, at(a), at(b));
    joint.match = 1;
    joint.axis_a[0] = 0.0;
    joint.axis_a[1] = 1.0;
    memcpy(joint.origin_a, from_a, sizeof joint.origin_a);
    strncpy(joint.name, name, sizeof joint.name - 1);
    return add_joint(s, &joint);
}

/* Hinges at (0, 0), (0.5, 1), (2.5, 1.3), (2.4, 0) of the x-z plane. */
static void open_four_bar(rig *s)
{
    const dmb_id none = {0, 0};
    const double o[4][3] = {{0.0, 0.0, 0.0}, {0.5, 0.0, 1.0}, {2.0, 0.0, 0.3}, {2.4, 0.0, 0.0}};
    rig_open(s, 0.0, 0.0, -9.81);
    const dmb_id crank = bar(s, 0.0, 0.0), coupler = bar(s, 0.5, 1.0), rocker = bar(s, 2.4, 0.0);
    hinge(s, none, crank, o[0], "A");
    hinge(s, crank, coupler, o[1], "B");
    hinge(s, coupler, rocker, o[2], "C");
    hinge(s, none, rocker, o[3], "D");
}

/* Number of lines of the redundant section, each of which must hold a motion out of the plane. */
static int redundant_lines(const char *text)
{
    const char *line = strstr(text, "  redundant equations:\n");
    int count = 0;
    assert_non_null(line);
    for (line = strchr(line, '\n') + 1; strncmp(line, "    joint ", 10) == 0; line = strchr(line, '\n') + 1) {
        char copy[128];
        strncpy(copy, line, sizeof copy - 1);
        copy[sizeof copy - 1] = '\0';
        *strchr(copy, '\n') = '\0';
        const int off_plane =
            strstr(copy, "position x") || strstr(copy, "rotation about y") || strstr(copy, "rotation about z");
        if (!off_plane) fail_msg("%s", copy);
        assert_non_null(strchr(copy, '('));
        count++;
    }
    return count;
}

static void four_bar(void **state)
{
    rig s;
    (void)state;
    open_four_bar(&s);
    (void)rig_start(&s, NULL);
    const dmb_check_report r = check_of(&s);
    assert_int_equal(r.rigid_parts, 3);
    assert_int_equal(r.flexible_parts, 0);
    assert_int_equal(r.joints[DMB_JOINT_REVOLUTE], 4);
    assert_int_equal(r.coordinates, 18);
    assert_int_equal(r.constraint_rows, 20);
    assert_int_equal(r.gruebler, -2);
    assert_int_equal(r.rank, 17);
    assert_int_equal(r.degrees_of_freedom, 1);
    assert_int_equal(r.redundant, 3);
    assert_int_equal(r.clusters, 1);
    assert_int_equal(r.largest_cluster, 18);
    assert_int_equal(r.sparse_nodes, 3);
    assert_int_equal(r.tridiagonal_nodes, 0);
    assert_int_equal(r.warnings, 1);
    check_below("violation", r.largest_violation, 1e-12);
    assert_true(r.condition > 1e-3 && r.condition <= 1.0);
    assert_int_equal(redundant_lines(text_of(&s)), 3);
    rig_close(&s);
}

/* The same as the queries of the joints say, and after steps. */
static void redundant_rows_are_those_that_are_dropped(void **state)
{
    rig s;
    (void)state;
    open_four_bar(&s);
    (void)rig_start(&s, NULL);
    for (int k = 0; k < 20; k++) must(&s, dmb_sim_step(s.sim, 0.02, NULL));
    assert_true(energy_of(&s).kinetic > 1.0);
    const dmb_statistics statistics = statistics_of(&s);
    const dmb_check_report r = check_of(&s);
    assert_int_equal(statistics.redundant, 3);
    assert_int_equal(r.redundant, 3);
    assert_int_equal(r.rank, statistics.dependent);
    assert_int_equal(r.degrees_of_freedom, 1);
    check_below("violation", r.largest_violation, 1e-12);
    assert_int_equal(redundant_lines(text_of(&s)), 3);
    rig_close(&s);
}

/* A body fixed in two places at once. */
static void inconsistent_equations_are_refused(void **state)
{
    const dmb_id none = {0, 0};
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id body = bar(&s, 0.0, 0.0);
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = DMB_JOINT_FIXED;
    joint.place_a = at(none);
    joint.place_b = at(body);
    (void)add_joint(&s, &joint);
    joint.origin_a[1] = 0.01;
    strncpy(joint.name, "elsewhere", sizeof joint.name - 1);
    (void)add_joint(&s, &joint);
    must_model(&s, dmb_model_compile(s.model, NULL));
    assert_int_equal(dmb_sim_create(s.model, NULL, &s.sim), DMB_ERR_GEOMETRY);
    assert_null(s.sim);
    rig_close(&s);
}

static void locked_open_and_coupled(void **state)
{
    const dmb_id none = {0, 0};
    const double o[2][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id a = bar(&s, 0.0, 0.0), b = bar(&s, 0.0, 1.0);
    const dmb_id first = hinge(&s, none, a, o[0], "first"), second = hinge(&s, a, b, o[1], "second");
    dmb_coupling_def coupling = dmb_coupling_def_default();
    coupling.joint[0] = first;
    coupling.joint[1] = second;
    must_model(&s, dmb_model_add_coupling(s.model, &coupling, NULL));
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, first, DMB_RX, add_constant(&s, 0.0));
    (void)rig_start(&s, NULL);
    dmb_check_report r = check_of(&s);
    assert_int_equal(r.constraint_rows, 12);
    assert_int_equal(r.degrees_of_freedom, 0);
    assert_int_equal(r.couplings, 1);
    assert_int_equal(r.warnings, 0);
    must(&s, dmb_sim_set_joint(s.sim, second, DMB_JOINT_LOCKED));
    r = check_of(&s);
    assert_int_equal(r.locked_joints, 1);
    assert_int_equal(r.joints[DMB_JOINT_REVOLUTE], 2);
    assert_int_equal(r.constraint_rows, 13);
    assert_int_equal(r.redundant, 1);
    assert_int_equal(r.degrees_of_freedom, 0);
    (void)text_of(&s);
    must(&s, dmb_sim_set_joint(s.sim, second, DMB_JOINT_ACTIVE));
    must(&s, dmb_sim_set_joint(s.sim, first, DMB_JOINT_OPEN));
    r = check_of(&s);
    assert_int_equal(r.open_joints, 1);
    assert_int_equal(r.joints[DMB_JOINT_REVOLUTE], 1);
    assert_int_equal(r.constraint_rows, 5);
    assert_int_equal(r.degrees_of_freedom, 7);
    expect_line(text_of(&s), "drive 0: joint 0 (first) is open");
    rig_close(&s);
}

/* ---- The reference system ---------------------------------------------------------------------------------------- */

static dmb_id free_pipe(rig *s, double x)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    def.follows_hole = 0;
    def.position[0] = x;
    def.start_free = DMB_FREE_ALL;
    const dmb_id string = add_string(s, &def);
    pipe.string = string;
    (void)add_pipes(s, &pipe, 1);
    return string;
}

static dmb_id free_body(rig *s, double x)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 50.0;
    body.position[0] = x;
    for (int i = 0; i < 3; i++) body.inertia[i] = 1.0;
    return add_body(s, &body);
}

static void open_explicit(rig *s)
{
    dmb_id last;
    dmb_place end;
    const dmb_wall_def wall = s1_hole();
    rig_open(s, 0.0, 0.0, -9.81);
    (void)add_wall(s, &wall);
    const dmb_id head = free_body(s, 0.0), bit = free_body(s, 1.5 * PIPES);
    const dmb_id support = connect(s, DMB_JOINT_CYLINDRICAL, ground, at(head), "support");
    end = at(head);
    for (uint32_t i = 0; i < PIPES; i++) {
        last = free_pipe(s, 1.5 * i);
        (void)connect(s, DMB_JOINT_FIXED, end, dmb_station(last, 0, 0.0), "");
        end = dmb_station(last, 0, 1.0);
    }
    (void)connect(s, DMB_JOINT_FIXED, end, at(bit), "bit");
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, support, DMB_X, add_constant(s, 0.02));
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, support, DMB_RX, add_constant(s, 1.0));
    (void)rig_start(s, NULL);
}

static void open_structural(rig *s)
{
    const dmb_wall_def wall = s1_hole();
    const dmb_pipe_def pipe = s1_pipe();
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    (void)add_wall(s, &wall);
    const dmb_id string = add_pipes(s, &pipe, PIPES);
    body.mass = 50.0;
    body.attach = DMB_ATTACH_START;
    (void)add_body(s, &body);
    body.attach = DMB_ATTACH_END;
    (void)add_body(s, &body);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, string, DMB_X, add_constant(s, 0.02));
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, string, DMB_RX, add_constant(s, 1.0));
    (void)rig_start(s, NULL);
}

static void expect_reference_parts(const dmb_check_report *r)
{
    assert_int_equal(r->rigid_parts, 2);
    assert_int_equal(r->flexible_parts, PIPES);
    assert_int_equal(r->elements, PIPES);
    assert_int_equal(r->motion_drives, 2);
    assert_int_equal(r->other_drives, 0);
    assert_int_equal(r->degrees_of_freedom, 600);
    assert_int_equal(r->gruebler, 600);
    assert_int_equal(r->redundant, 0);
}

static void reference_with_joints(void **state)
{
    rig s;
    (void)state;
    open_explicit(&s);
    const dmb_check_report r = check_of(&s);
    expect_reference_parts(&r);
    assert_int_equal(r.structural_joints, 0);
    assert_int_equal(r.joints[DMB_JOINT_FIXED], 101);
    assert_int_equal(r.joints[DMB_JOINT_CYLINDRICAL], 1);
    assert_int_equal(r.coordinates, 1212);
    assert_int_equal(r.held + r.prescribed, 0);
    assert_int_equal(r.constraint_rows, 101 * 6 + 4 + 2);
    assert_int_equal(r.rank, r.constraint_rows);
    assert_int_equal(r.clusters, 101);
    assert_int_equal(r.sparse_nodes, 202);
    assert_int_equal(r.tridiagonal_nodes, 0);
    assert_int_equal(r.warnings, 0);
    expect_line(text_of(&s), "fixed 101, cylindrical 1");
    expect_line(sheet, "sparse 202 nodes in 101 blocks");
    rig_close(&s);
}

static void reference_structural(void **state)
{
    rig s;
    (void)state;
    open_structural(&s);
    const dmb_check_report r = check_of(&s);
    expect_reference_parts(&r);
    assert_int_equal(r.structural_joints, 101);
    assert_int_equal(r.coordinates, 606);
    assert_int_equal(r.held, 4);
    assert_int_equal(r.prescribed, 2);
    assert_int_equal(r.constraint_rows + r.rank + r.clusters + r.blocks + r.sparse_nodes, 0);
    assert_int_equal(r.tridiagonal_nodes, 101);
    assert_int_equal(r.warnings, 0);
    check_close("condition", r.condition, 1.0, 0.0);
    expect_line(text_of(&s), "solver: block-tridiagonal, 101 nodes");
    rig_close(&s);
}

/* Rigid pipes and tool joints are parts too: 3 rigid pipes, 2 flexible ones with tool joints, a bit. */
static void parts_of_a_mixed_string(void **state)
{
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = dmb_bit_def_default();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    pipe.kind = DMB_PIPE_RIGID;
    (void)add_pipes(&s, &pipe, 3);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    pipe.elements = 4;
    pipe.joint_length = 0.2;
    (void)add_pipes(&s, &pipe, 2);
    must_model(&s, dmb_model_add_bit(s.model, &bit, NULL));
    (void)rig_start(&s, NULL);
    const dmb_check_report r = check_of(&s);
    assert_int_equal(r.rigid_parts, 3 + 2 + 1);
    assert_int_equal(r.flexible_parts, 2);
    assert_int_equal(r.elements, 8);
    assert_int_equal(r.structural_joints, 4 + 2 + 1);
    assert_int_equal(r.degrees_of_freedom, 9 * 6 - 4);
    rig_close(&s);
}

/* ---- Branches ---------------------------------------------------------------------------------------------------- */

static void branch(void **state)
{
    rig s;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    (void)state;
    rig_open(&s, 0.0, 0.0, -9.81);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_NONE;
    const dmb_id trunk = add_string(&s, &def);
    pipe.string = trunk;
    (void)add_pipes(&s, &pipe, 6);
    def.start_free = DMB_FREE_ALL;
    def.position[0] = 4.5;
    def.rotation[1] = 0.5;
    const dmb_id arm = add_string(&s, &def);
    pipe.string = arm;
    (void)add_pipes(&s, &pipe, 3);
    def.start_free = DMB_FREE_NONE;
    def.position[2] = 5.0;
    const dmb_id alone = add_string(&s, &def);
    pipe.string = alone;
    (void)add_pipes(&s, &pipe, 2);
    (void)connect(&s, DMB_JOINT_UNIVERSAL, dmb_station(trunk, 2, 1.0), dmb_station(arm, 0, 0.0), "branch");
    (void)rig_start(&s, NULL);
    const dmb_check_report r = check_of(&s);
    assert_int_equal(r.flexible_parts, 11);
    assert_int_equal(r.joints[DMB_JOINT_UNIVERSAL], 1);
    assert_int_equal(r.sparse_nodes, 7 + 4);
    assert_int_equal(r.tridiagonal_nodes, 3);
    assert_int_equal(r.blocks, 1 + 6 + 3);
    assert_int_equal(r.degrees_of_freedom, (6 + 4 + 2) * 6 - 4);
    assert_int_equal(r.fill, 0);
    assert_int_equal(r.warnings, 0);
    expect_line(text_of(&s), "block-tridiagonal 3 nodes, sparse 11 nodes in 10 blocks");
    rig_close(&s);
}

/* ---- Warnings ---------------------------------------------------------------------------------------------------- */

static void what_will_fall(void **state)
{
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, -9.81);
    dmb_body_def held = dmb_body_def_default();
    held.free_mask = DMB_FREE_NONE;
    (void)add_body(&s, &held);
    const dmb_id a = free_body(&s, 1.0), b = free_body(&s, 2.0);
    (void)connect(&s, DMB_JOINT_SPHERICAL, at(a), at(b), "");
    (void)free_body(&s, 3.0);
    (void)rig_start(&s, NULL);
    assert_int_equal(check_of(&s).warnings, 1);
    expect_line(text_of(&s), "body 1 (and 1 more): no support");
    rig_close(&s);
    rig_open(&s, 0.0, 0.0, 0.0); /* without gravity nothing falls */
    (void)free_body(&s, 1.0);
    (void)rig_start(&s, NULL);
    assert_int_equal(check_of(&s).warnings, 0);
    rig_close(&s);
}

/* A load on a bit that no drive and no support along the string bears. */
static void what_is_pushed_out(void **state)
{
    rig s;
    (void)state;
    for (int held = 0; held < 5; held++) { /* by nothing, a drive, the rig end, the far end, another part */
        rig_open(&s, 0.0, 0.0, -9.81);
        const dmb_wall_def wall = s1_hole();
        dmb_string_def def = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        dmb_bit_def bit = dmb_bit_def_default();
        dmb_drive_def drive = dmb_drive_def_default();
        dmb_segment push = dmb_segment_default();
        (void)add_wall(&s, &wall);
        if (held == 2) def.start_free = DMB_FREE_RX;
        if (held == 3) def.end_free = DMB_FREE_RX;
        bit.string = drive.part = pipe.string = add_string(&s, &def);
        (void)add_pipes(&s, &pipe, 3);
        push.h0 = 1e4;
        must_model(&s, dmb_model_add_time_function(s.model, &push, 1, &bit.load));
        bit.diameter = 0.0;
        must_model(&s, dmb_model_add_bit(s.model, &bit, NULL));
        drive.component = held == 1 ? DMB_X : DMB_RX; /* the rotation does not hold it */
        must_model(&s, dmb_model_add_drive(s.model, &drive, NULL));
        dmb_spring_def spring = dmb_spring_def_default();
        spring.place_a = dmb_station(pipe.string, 0, 0.0);
        spring.offset_b[0] = -1.0;
        spring.stiffness = 1e6;
        if (held == 4) must_model(&s, dmb_model_add_spring(s.model, &spring, NULL));
        (void)rig_start(&s, NULL);
        const int told = strstr(text_of(&s), "no drive along it bears the load on its bit") != NULL;
        if (told != (held == 0)) fail_msg("held %d: %s", held, text_of(&s));
        rig_close(&s);
    }
}

/* A free joint holds by its spring. */
static void springs_hold(void **state)
{
    rig s;
    (void)state;
    for (int32_t with = 0; with < 2; with++) {
        rig_open(&s, 0.0, 0.0, -9.81);
        const dmb_id body = free_body(&s, 0.0);
        dmb_joint_def joint = dmb_joint_def_default();
        joint.kind = DMB_JOINT_FREE;
        joint.place_b = at(body);
        joint.stiffness[DMB_Z] = with ? 1e4 : 0.0;
        (void)add_joint(&s, &joint);
        (void)rig_start(&s, NULL);
        assert_int_equal(check_of(&s).warnings, 1 - with);
        rig_close(&s);
    }
}

static void small_mass(void **state)
{
    rig s;
    dmb_body_def body = dmb_body_def_default();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    (void)add_body(&s, &body);
    body.mass = 1e-10;
    for (int i = 0; i < 3; i++) body.inertia[i] = 1e-13;
    (void)add_body(&s, &body);
    (void)rig_start(&s, NULL);
    assert_int_equal(check_of(&s).warnings, 2);
    expect_line(text_of(&s), "body 1: mass of 1e-10 kg");
    expect_line(sheet, "body 1: moment of inertia of 1e-13 kg m2");
    rig_close(&s);
}

static void open_in_hole(rig *s, const dmb_wall_def *wall, double offset, double start_depth)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(s, 0.0, 0.0, -9.81);
    (void)add_wall(s, wall);
    def.offset[1] = offset;
    def.start_depth = start_depth;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 4);
    (void)rig_start(s, NULL);
}

/* 94 mm of hole and 73 mm of pipe leave 10.5 mm. */
static void pipe_outside_the_hole(void **state)
{
    rig s;
    const dmb_wall_def wall = s1_hole();
    (void)state;
    open_in_hole(&s, &wall, 0.0105 - 1e-9, 0.0);
    assert_int_equal(check_of(&s).warnings, 0);
    rig_close(&s);
    open_in_hole(&s, &wall, 0.0105 + 6e-7, 0.0); /* 0.0006 mm: the rounding of diameters */
    assert_int_equal(check_of(&s).warnings, 0);
    rig_close(&s);
    open_in_hole(&s, &wall, 0.0105 + 1e-5, 0.0);
    assert_int_equal(check_of(&s).warnings, 1);
    rig_close(&s);
    open_in_hole(&s, &wall, 0.0125, 0.0);
    assert_int_equal(check_of(&s).warnings, 1);
    expect_line(text_of(&s), "string 0, pipe ");
    expect_line(sheet, "outside the hole, 0.002 m deep in its wall");
    rig_close(&s);
}

/* A string that lies on the wall after a static start is not outside. */
static void lying_on_the_wall_is_fine(void **state)
{
    rig s;
    const dmb_wall_def wall = s1_hole();
    (void)state;
    open_in_hole(&s, &wall, 0.0, 0.0);
    (void)find_equilibrium(&s, NULL);
    assert_true(contacts_of(&s).closed > 0);
    expect_no_line(text_of(&s), "outside");
    rig_close(&s);
}

static void past_the_ends_of_the_hole(void **state)
{
    static const double survey[9] = {0.0, 0.5 * PI, 0.0, 3.0, 0.5 * PI - 0.1, 0.0, 5.0, 0.5 * PI - 0.2, 0.0};
    rig s;
    dmb_wall_def wall = s1_hole();
    (void)state;
    open_in_hole(&s, &wall, 0.0, -2.0);
    assert_int_equal(check_of(&s).warnings, 1);
    expect_line(text_of(&s), "string 0: described 2 m before the start");
    rig_close(&s);
    wall.survey = survey;
    wall.survey_count = 3;
    open_in_hole(&s, &wall, 0.0, 0.0);
    expect_line(text_of(&s), "string 0: described 1 m beyond the end of the survey");
    rig_close(&s);
}

static void hole_without_a_wall(void **state)
{
    rig s;
    dmb_wall_def wall = s1_hole();
    (void)state;
    wall.normal_law = DMB_NORMAL_NONE;
    open_in_hole(&s, &wall, 0.0, 0.0);
    assert_int_equal(check_of(&s).warnings, 1);
    expect_line(text_of(&s), "string 0: a hole is described, but its wall is not met");
    rig_close(&s);
}

/* Two rods from the ground to one body, nearly parallel; and a driven joint at RZ = 89 deg. */
static void nearly_dependent_and_nearly_singular(void **state)
{
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id body = bar(&s, 0.0, 0.0);
    for (int k = 0; k < 2; k++) {
        dmb_joint_def rod = dmb_joint_def_default();
        rod.kind = DMB_JOINT_DISTANCE;
        rod.place_b = at(body);
        rod.origin_a[0] = 1.0;
        rod.origin_a[1] = 1e-5 * k;
        rod.length = sqrt(1.0 + rod.origin_a[1] * rod.origin_a[1]);
        (void)add_joint(&s, &rod);
    }
    const dmb_id turned = bar(&s, 5.0, 0.0);
    dmb_joint_def ball = dmb_joint_def_default();
    ball.kind = DMB_JOINT_SPHERICAL;
    ball.place_b = at(turned);
    ball.origin_a[0] = 5.0;
    const double angle = 89.0 * PI / 180.0;
    ball.axis_b[0] = cos(angle);
    ball.axis_b[1] = sin(angle);
    ball.normal_b[0] = -sin(angle);
    ball.normal_b[1] = cos(angle);
    ball.friction[DMB_RX] = 1.0;
    (void)add_joint(&s, &ball);
    (void)rig_start(&s, NULL);
    const dmb_check_report r = check_of(&s);
    assert_int_equal(r.warnings, 2);
    assert_int_equal(r.rank, 5);
    check_below("condition", r.condition, 1e-4);
    expect_line(text_of(&s),
                "conditioning: equations around joint 0 are nearly redundant, smallest singular value 5e-06");
    expect_line(sheet, "joint 2: nearly singular");
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(four_bar),
        cmocka_unit_test(redundant_rows_are_those_that_are_dropped),
        cmocka_unit_test(inconsistent_equations_are_refused),
        cmocka_unit_test(locked_open_and_coupled),
        cmocka_unit_test(reference_with_joints),
        cmocka_unit_test(reference_structural),
        cmocka_unit_test(parts_of_a_mixed_string),
        cmocka_unit_test(branch),
        cmocka_unit_test(what_will_fall),
        cmocka_unit_test(springs_hold),
        cmocka_unit_test(what_is_pushed_out),
        cmocka_unit_test(small_mass),
        cmocka_unit_test(pipe_outside_the_hole),
        cmocka_unit_test(lying_on_the_wall_is_fine),
        cmocka_unit_test(past_the_ends_of_the_hole),
        cmocka_unit_test(hole_without_a_wall),
        cmocka_unit_test(nearly_dependent_and_nearly_singular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
