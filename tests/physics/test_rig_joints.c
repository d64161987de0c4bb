/* The reference rig taken apart: rig head, 100 flexible pipes as strings of one pipe each, and bit, put together with
 * explicit joints, against the same rig as one string, whose joints are structural and cost no unknowns. Equations:
 * eq:static.multipliers, eq:static.blocks, eq:static.reduced, eq:static.newton. */
#include "rig.h"

enum { PIPES = 100 };

typedef struct rig_pair {
    rig whole, parts;
    dmb_id string, head, bit;              /* of the whole */
    dmb_id pipe[PIPES], own_head, own_bit; /* of the parts */
    dmb_id fixed[PIPES + 1], support;
    dmb_id drive[2], own_drive[2]; /* feed and rotation */
} rig_pair;

typedef struct choice {
    int32_t features; /* DMB_FEATURE_... */
    int32_t method;   /* DMB_METHOD_... of the parts */
} choice;

/* ---- What both are made of --------------------------------------------------------------------------------------- */

static dmb_body_def head_body(void)
{
    dmb_body_def head = dmb_body_def_default();
    head.mass = 200.0;
    head.inertia[0] = 4.0;
    head.inertia[1] = head.inertia[2] = 10.0;
    head.centre[0] = -0.3;
    head.centre[2] = 0.05;
    return head;
}

static dmb_body_def bit_body(void)
{
    dmb_body_def bit = dmb_body_def_default();
    bit.mass = 5.0;
    bit.inertia[0] = 0.0053;
    bit.inertia[1] = bit.inertia[2] = 0.0068;
    bit.centre[0] = 0.05;
    bit.contact_diameter = 0.092;
    bit.contact_length = 0.1;
    return bit;
}

static dmb_id add_start_up(rig *s, double speed)
{
    dmb_segment rise = dmb_segment_default();
    rise.kind = DMB_SEGMENT_STEP;
    rise.h1 = speed;
    return add_time_function(s, &rise, 1);
}

static void add_drives(rig *s, dmb_id part, dmb_id drive[2])
{
    drive[0] = add_simple_drive(s, DMB_DRIVE_MOTION, part, DMB_X, add_start_up(s, 0.02));
    drive[1] = add_simple_drive(s, DMB_DRIVE_MOTION, part, DMB_RX, add_start_up(s, 20.0));
}

/* ---- The whole and its parts ------------------------------------------------------------------------------------- */

static void open_hole(rig *s)
{
    const dmb_wall_def wall = dmb_wall_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    (void)add_wall(s, &wall);
}

static void describe_whole(rig_pair *p)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_body_def head = head_body(), bit = bit_body();
    open_hole(&p->whole);
    p->string = add_pipes(&p->whole, &pipe, PIPES);
    head.attach = DMB_ATTACH_START;
    bit.attach = DMB_ATTACH_END;
    p->head = add_body(&p->whole, &head);
    p->bit = add_body(&p->whole, &bit);
    add_drives(&p->whole, p->string, p->drive);
}

static dmb_id add_one_pipe(rig *s, uint32_t number)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.start_depth = number;
    string.start_free = DMB_FREE_ALL;
    pipe.string = add_string(s, &string);
    return add_pipes(s, &pipe, 1);
}

/* From the rig to the bit: what a joint has at its rig side is frame a. */
static void describe_parts(rig_pair *p)
{
    rig *const s = &p->parts;
    const dmb_id ground = {0, 0};
    dmb_body_def head = head_body(), bit = bit_body();
    open_hole(s);
    p->own_head = add_body(s, &head);
    for (uint32_t i = 0; i < PIPES; i++) p->pipe[i] = add_one_pipe(s, i);
    bit.position[0] = PIPES;
    p->own_bit = add_body(s, &bit);
    dmb_place last = dmb_station(p->own_head, 0, 0.0);
    p->support = add_joint_between(s, DMB_JOINT_CYLINDRICAL, dmb_station(ground, 0, 0.0), last);
    for (uint32_t i = 0; i < PIPES; i++) {
        p->fixed[i] = add_joint_between(s, DMB_JOINT_FIXED, last, dmb_station(p->pipe[i], 0, 0.0));
        last = dmb_station(p->pipe[i], 0, 1.0);
    }
    p->fixed[PIPES] = add_joint_between(s, DMB_JOINT_FIXED, last, dmb_station(p->own_bit, 0, 0.0));
    add_drives(s, p->support, p->own_drive);
}

static void open_pair(rig_pair *p, const choice *c)
{
    dmb_compile_options compile = dmb_compile_options_default();
    dmb_sim_options options = dmb_sim_options_default();
    compile.features = c->features;
    options.newton_tolerance = 1e-12;
    options.max_iterations = 30;
    describe_whole(p);
    describe_parts(p);
    (void)rig_start_with(&p->whole, &compile, &options);
    options.constraint_method = c->method;
    assert_int_equal(rig_start_with(&p->parts, &compile, &options), DMB_OK);
}

static void close_pair(rig_pair *p)
{
    rig_close(&p->whole);
    rig_close(&p->parts);
}

/* ---- Counts ------------------------------------------------------------------------------------------------------ */

static dmb_model_info info_of(const rig *s)
{
    dmb_model_info info = dmb_model_info_default();
    must_model(s, dmb_model_get_info(s->model, &info));
    return info;
}

/* 101 fixed joints hold 606 equations, the support 4 and the two drives on its coordinates 2. The support and its
 * drives share a cluster with the joint of the head. 200 pipe ends and 2 bodies have 1212 coordinates, 612 of them
 * dependent: what is left is what the string has. */
static void counts(void **state)
{
    (void)state;
    const choice c = {DMB_FEATURE_ALL, DMB_METHOD_INDEPENDENT};
    rig_pair p;
    open_pair(&p, &c);
    const dmb_model_info whole = info_of(&p.whole), parts = info_of(&p.parts);
    const dmb_statistics statistics = statistics_of(&p.parts);
    assert_int_equal(whole.joints, 0);
    assert_int_equal(whole.degrees_of_freedom, 600);
    assert_int_equal(whole.prescribed, 2);
    assert_int_equal(parts.joints, 102);
    assert_int_equal(parts.constraint_rows, 606 + 4 + 2);
    assert_int_equal(parts.clusters, 101);
    assert_int_equal(parts.nodes, 202);
    assert_int_equal(parts.reduced_nodes, 202);
    assert_int_equal(parts.degrees_of_freedom, 1212);
    assert_int_equal(parts.prescribed, 0);
    assert_int_equal(statistics.dependent, 612);
    assert_int_equal(statistics.redundant, 0);
    assert_int_equal(whole.contact_points, 101); /* the rig end of the string is guided; the rig end of pipe 0 is not */
    assert_int_equal(parts.contact_points, 201);
    check_relative("mass", parts.mass, whole.mass, 1e-14);
    tell("bytes of the sim", (double)parts.sim_bytes);
    tell("bytes of the sim of the whole", (double)whole.sim_bytes);
    check_below("violation of the described pose [m]", statistics.assembly[0], 1e-12);
    close_pair(&p);
}

/* ---- Motion ------------------------------------------------------------------------------------------------------ */

typedef struct difference {
    double position, rotation, velocity, spin, force, torque, wall;
} difference;

static void compare_place(const rig_pair *p, dmb_place whole, dmb_place part, difference *d)
{
    const dmb_pose a = pose_at(&p->whole, whole), b = pose_at(&p->parts, part);
    const dmb_motion v = motion_at(&p->whole, whole, DMB_FRAME_WORLD), w = motion_at(&p->parts, part, DMB_FRAME_WORLD);
    d->position = fmax(d->position, largest_difference(3, a.position, b.position));
    d->rotation = fmax(d->rotation, largest_difference(9, a.rotation, b.rotation));
    d->velocity = fmax(d->velocity, largest_difference(3, v.velocity, w.velocity));
    d->spin = fmax(d->spin, largest_difference(3, v.velocity + 3, w.velocity + 3));
}

static double drive_force(const rig *s, dmb_id drive)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(s, dmb_query_drive(s->sim, drive, &state));
    return state.force;
}

/* Poses and speeds at both ends of all pipes, of head and bit, and what drives and wall do. */
static void compare(const rig_pair *p, difference *d)
{
    for (uint32_t i = 0; i < PIPES; i++) {
        compare_place(p, dmb_station(p->string, i, 0.0), dmb_station(p->pipe[i], 0, 0.0), d);
        compare_place(p, dmb_station(p->string, i, 1.0), dmb_station(p->pipe[i], 0, 1.0), d);
    }
    compare_place(p, dmb_station(p->head, 0, 0.0), dmb_station(p->own_head, 0, 0.0), d);
    compare_place(p, dmb_station(p->bit, 0, 0.0), dmb_station(p->own_bit, 0, 0.0), d);
    d->force = fmax(d->force, fabs(drive_force(&p->whole, p->drive[0]) - drive_force(&p->parts, p->own_drive[0])));
    d->torque = fmax(d->torque, fabs(drive_force(&p->whole, p->drive[1]) - drive_force(&p->parts, p->own_drive[1])));
    d->wall = fmax(d->wall, fabs(contacts_of(&p->whole).normal_force - contacts_of(&p->parts).normal_force));
}

/* Position and rotation in m and rad; speeds of 20 rad/s, forces of 1e4 N and torques of 1e2 N m to 1e-9 of them. */
static void check_difference(const difference *d)
{
    check_below("    position [m]", d->position, 1e-9);
    check_below("    rotation [-]", d->rotation, 1e-9);
    check_below("    velocity [m/s]", d->velocity, 1e-9);
    check_below("    spin [rad/s]", d->spin, 2e-8);
    check_below("    force of the feed [N]", d->force, 1e-5);
    check_below("    torque of the rotation [N m]", d->torque, 1e-7);
}

/* Both in steps of 1 ms, compared every 10 ms. */
static void start_up(const rig_pair *p, uint32_t steps)
{
    difference most = {0};
    for (uint32_t k = 1; k <= steps; k++) {
        must(&p->whole, dmb_sim_step(p->whole.sim, 1e-3, NULL));
        must(&p->parts, dmb_sim_step(p->parts.sim, 1e-3, NULL));
        if (k % 10 == 0) compare(p, &most);
    }
    const dmb_statistics whole = statistics_of(&p->whole), parts = statistics_of(&p->parts);
    check_difference(&most);
    check_below("    wall [N]", most.wall, 1e-3); /* places at the edge of contact: a gap of 1e-12 m is 1e-5 N */
    check_below("    violation of the joints [m]", parts.violation, 1e-14);
    print_message("    iterations: whole %.0f, parts %.0f; torque %.2f N m, wall %.1f N\n", (double)whole.iterations,
                  (double)parts.iterations, drive_force(&p->whole, p->drive[1]), contacts_of(&p->whole).normal_force);
    assert_int_equal(parts.switches, 0);
}

static void run(int32_t features, int32_t method, uint32_t steps)
{
    const choice c = {features, method};
    rig_pair p;
    open_pair(&p, &c);
    start_up(&p, steps);
    close_pair(&p);
}

enum { NO_WALL = DMB_FEATURE_ALL & ~(DMB_FEATURE_CONTACT | DMB_FEATURE_FRICTION) };

static void turning_freely(void **state)
{
    (void)state;
    run(NO_WALL & ~DMB_FEATURE_GRAVITY, DMB_METHOD_INDEPENDENT, 1000);
}

static void hanging_from_the_head(void **state)
{
    (void)state;
    run(NO_WALL, DMB_METHOD_INDEPENDENT, 500);
}

static void falling_on_the_wall(void **state)
{
    (void)state;
    run(DMB_FEATURE_ALL, DMB_METHOD_INDEPENDENT, 100);
}

static void falling_with_multipliers(void **state)
{
    (void)state;
    run(DMB_FEATURE_ALL, DMB_METHOD_MULTIPLIERS, 100);
}

/* ---- From rest on the wall -----------------------------------------------------------------------------------------
 */

static dmb_contact contact_at(const rig *s, uint32_t site)
{
    dmb_contact contact = dmb_contact_default();
    must(s, dmb_query_contact(s->sim, site, &contact));
    return contact;
}

/* The far end of pipe i and the rig end of pipe i + 1 stand for half a pipe each, together for what the string's one
 * place there stands for. */
static void check_sites(const rig_pair *p)
{
    double length = 0.0, normal = 0.0, friction = 0.0, gap = 0.0;
    for (uint32_t i = 0; i + 1 < PIPES; i++) {
        const dmb_contact whole = contact_at(&p->whole, i);
        const dmb_contact far = contact_at(&p->parts, 2 * i + 1), near = contact_at(&p->parts, 2 * i + 2);
        assert_int_equal(whole.pipe, i);
        assert_int_equal(far.pipe, 0);
        assert_int_equal(near.pipe, DMB_NONE);
        length = fmax(length, fabs(far.length + near.length - whole.length));
        normal = fmax(normal, fabs(far.normal_force + near.normal_force - whole.normal_force));
        gap = fmax(gap, fmax(fabs(far.gap - whole.gap), fabs(near.gap - whole.gap)));
        for (int k = 0; k < 2; k++)
            friction = fmax(friction, fabs(far.friction[k] + near.friction[k] - whole.friction[k]));
    }
    check_below("    length of the two halves [m]", length, 0.0);
    check_below("    gap [m]", gap, 1e-11);
    check_below("    normal force of the two halves [N]", normal, 1e-4);
    check_below("    friction of the two halves [N]", friction, 1e-4);
}

static void start_up_from_rest(void **state)
{
    (void)state;
    const choice c = {DMB_FEATURE_ALL, DMB_METHOD_INDEPENDENT};
    rig_pair p;
    difference d = {0};
    open_pair(&p, &c);
    const dmb_static_report whole = find_equilibrium(&p.whole, NULL), parts = find_equilibrium(&p.parts, NULL);
    compare(&p, &d);
    print_message("    statics: whole %u iterations, parts %u\n", whole.iterations, parts.iterations);
    check_difference(&d);
    check_below("    wall [N]", d.wall, 1e-8);
    assert_int_equal(parts.method, DMB_STATIC_NEWTON);
    check_below("    iterations of the parts beyond those of the whole", (double)parts.iterations - whole.iterations,
                2.0);
    check_sites(&p);
    print_message("    1 s of start-up\n");
    start_up(&p, 1000);
    check_sites(&p);
    close_pair(&p);
}

/* Statics with friction of an assumed slip: feed and torque that the drives of the support hold against it. */
static void statics_with_slip(void **state)
{
    (void)state;
    const choice c = {DMB_FEATURE_ALL, DMB_METHOD_INDEPENDENT};
    dmb_static_options options = dmb_static_options_default();
    rig_pair p;
    difference d = {0};
    options.slip_axial = 10.0;
    options.slip_rotation = 100.0;
    options.tolerance = 1e-12;
    open_pair(&p, &c);
    const dmb_static_report whole = find_equilibrium(&p.whole, &options), parts = find_equilibrium(&p.parts, &options);
    compare(&p, &d);
    print_message("    whole %u iterations, parts %u; feed %.3f N, torque %.3f N m\n", whole.iterations,
                  parts.iterations, drive_force(&p.whole, p.drive[0]), drive_force(&p.whole, p.drive[1]));
    check_difference(&d);
    close_pair(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts),
        cmocka_unit_test(turning_freely),
        cmocka_unit_test(hanging_from_the_head),
        cmocka_unit_test(falling_on_the_wall),
        cmocka_unit_test(falling_with_multipliers),
        cmocka_unit_test(start_up_from_rest),
        cmocka_unit_test(statics_with_slip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
