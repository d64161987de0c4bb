/* Steps in independent coordinates against steps with multipliers: the same motion and the same forces.
 * Checks eq:joints.reduced-system and eq:joints.multipliers. */
#include <string.h>

#include "mechanism.h"

enum { PARTS_MAX = 4, JOINTS_MAX = 5 };

typedef struct system {
    rig s;
    dmb_place places[PARTS_MAX];
    dmb_id joints[JOINTS_MAX];
    uint32_t place_count, joint_count;
} system_under_test;

typedef void (*build_fn)(system_under_test *m);

static void note_body(system_under_test *m, dmb_id body)
{
    m->places[m->place_count++] = dmb_station(body, 0, 0.0);
}

static dmb_id note_joint(system_under_test *m, const dmb_joint_def *def)
{
    m->joints[m->joint_count] = add_joint(&m->s, def);
    return m->joints[m->joint_count++];
}

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

/* A rod's middle between two points, its axes those of the world. */
static dmb_id add_link(system_under_test *m, const double a[3], const double b[3], double mass)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = mass;
    for (int i = 0; i < 3; i++) {
        body.position[i] = 0.5 * (a[i] + b[i]);
        body.inertia[i] = (1e-3 + 1e-4 * i) * mass;
    }
    const dmb_id id = add_body(&m->s, &body);
    note_body(m, id);
    return id;
}

/* A joint at a point of the world, frame a with the world's axes but for x along `axis`, frame b where it is. */
static dmb_joint_def joint_in_world(int32_t kind, dmb_id a, const double middle_a[3], dmb_id b, const double at[3],
                                    const double axis[3])
{
    dmb_joint_def def = dmb_joint_def_default();
    def.kind = kind;
    def.place_a = dmb_station(a, 0, 0.0);
    def.place_b = dmb_station(b, 0, 0.0);
    def.match = 1;
    for (int i = 0; i < 3; i++) {
        def.origin_a[i] = at[i] - middle_a[i];
        def.axis_a[i] = axis[i];
    }
    return def;
}

/* Haug 1989, 12.4: crank of .08 about x at (0, .1, .12), rod of .3, slider on the x axis. */
static void spatial_slider_crank(system_under_test *m)
{
    const double zero[3] = {0.0, 0.0, 0.0}, x[3] = {1.0, 0.0, 0.0}, foot[3] = {0.0, 0.1, 0.12};
    const double tip[3] = {0.0, 0.1 + 0.08 * cos(0.4), 0.12 + 0.08 * sin(0.4)};
    const double slide[3] = {sqrt(0.09 - tip[1] * tip[1] - tip[2] * tip[2]), 0.0, 0.0};
    double middle[2][3];
    for (int i = 0; i < 3; i++) {
        middle[0][i] = 0.5 * (foot[i] + tip[i]);
        middle[1][i] = 0.5 * (tip[i] + slide[i]);
    }
    const dmb_id crank = add_link(m, foot, tip, 0.12), rod = add_link(m, tip, slide, 0.5);
    const dmb_id slider = add_link(m, slide, slide, 2.0);
    dmb_joint_def pivot = joint_in_world(DMB_JOINT_REVOLUTE, ground_id, zero, crank, foot, x);
    pivot.initial_mask = DMB_FREE_RX;
    pivot.initial_speed[DMB_RX] = 6.0;
    (void)note_joint(m, &pivot);
    const dmb_joint_def ball = joint_in_world(DMB_JOINT_SPHERICAL, crank, middle[0], rod, tip, x);
    (void)note_joint(m, &ball);
    const dmb_joint_def cross = joint_in_world(DMB_JOINT_UNIVERSAL, rod, middle[1], slider, slide, x);
    (void)note_joint(m, &cross);
    const dmb_joint_def support = joint_in_world(DMB_JOINT_PRISMATIC, ground_id, zero, slider, slide, x);
    (void)note_joint(m, &support);
}

static dmb_id add_soft_pipe(system_under_test *m, const double position[3], double length)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(length, 6, 1e5, 4e4, 50.0, 60.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    memcpy(def.position, position, sizeof def.position);
    pipe.string = add_string(&m->s, &def);
    (void)add_pipes(&m->s, &pipe, 1);
    m->places[m->place_count++] = dmb_station(pipe.string, 0, 0.5);
    m->places[m->place_count++] = dmb_station(pipe.string, 0, 1.0);
    return pipe.string;
}

/* Released from the horizontal, on a hinge along y. */
static void swinging_pipe(system_under_test *m)
{
    const double zero[3] = {0.0, 0.0, 0.0}, y[3] = {0.0, 1.0, 0.0};
    const dmb_id pipe = add_soft_pipe(m, zero, 1.2);
    const dmb_joint_def hinge = joint_in_world(DMB_JOINT_REVOLUTE, ground_id, zero, pipe, zero, y);
    (void)note_joint(m, &hinge);
}

/* Four-bar with a flexible coupler along x between two upright bars, its hinges askew so that it bends and twists. */
static void flexible_loop(system_under_test *m)
{
    const double foot[2][3] = {{0.0, 0.0, 0.0}, {1.3, 0.0, 0.0}}, tip[2][3] = {{0.0, 0.0, 0.5}, {1.0, 0.0, 0.6}};
    const double zero[3] = {0.0, 0.0, 0.0}, y[3] = {0.0, 1.0, 0.0}, askew[3] = {0.05, 1.0, 0.02};
    const double start[3] = {0.0, 0.0, 0.5}, end[3] = {1.0, 0.0, 0.5};
    double middle[2][3];
    dmb_id side[2];
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 3; i++) middle[k][i] = 0.5 * (foot[k][i] + tip[k][i]);
        side[k] = add_link(m, foot[k], tip[k], 1.0);
    }
    const dmb_id coupler = add_soft_pipe(m, start, 1.0);
    dmb_joint_def a = joint_in_world(DMB_JOINT_REVOLUTE, ground_id, zero, side[0], foot[0], y);
    const dmb_joint_def d = joint_in_world(DMB_JOINT_REVOLUTE, ground_id, zero, side[1], foot[1], askew);
    const dmb_joint_def b = joint_in_world(DMB_JOINT_REVOLUTE, side[0], middle[0], coupler, tip[0], y);
    dmb_joint_def c = joint_in_world(DMB_JOINT_SPHERICAL, side[1], middle[1], coupler, end, y);
    c.place_b = dmb_station(coupler, 0, 1.0);
    a.initial_mask = DMB_FREE_RX;
    a.initial_speed[DMB_RX] = 1.0;
    (void)note_joint(m, &a);
    (void)note_joint(m, &d);
    (void)note_joint(m, &b);
    (void)note_joint(m, &c);
}

/* ---- Comparison -------------------------------------------------------------------------------------------------- */

static void open_system(system_under_test *m, build_fn build, int32_t method)
{
    dmb_sim_options options = sharp_options(0.8, 1e-13);
    options.constraint_method = method;
    memset(m, 0, sizeof *m);
    rig_open(&m->s, 0.0, 0.0, -9.81);
    build(m);
    (void)mechanism_start(&m->s, &options);
}

static void differences(const system_under_test *a, const system_under_test *b, double *motion, double *force)
{
    for (uint32_t i = 0; i < a->place_count; i++) {
        const dmb_pose pa = pose_at(&a->s, a->places[i]), pb = pose_at(&b->s, b->places[i]);
        const dmb_motion va = motion_at(&a->s, a->places[i], DMB_FRAME_WORLD);
        const dmb_motion vb = motion_at(&b->s, b->places[i], DMB_FRAME_WORLD);
        *motion = fmax(*motion, largest_difference(3, pa.position, pb.position));
        *motion = fmax(*motion, largest_difference(9, pa.rotation, pb.rotation));
        *motion = fmax(*motion, largest_difference(6, va.velocity, vb.velocity));
    }
    for (uint32_t i = 0; i < a->joint_count; i++) {
        const dmb_joint_state ja = joint_at(&a->s, a->joints[i]), jb = joint_at(&b->s, b->joints[i]);
        *force = fmax(*force, largest_difference(6, ja.reaction, jb.reaction) / (1.0 + largest(6, ja.reaction)));
    }
}

static void compare_methods(const char *what, build_fn build, double h, uint32_t steps)
{
    system_under_test a, b;
    double motion = 0.0, force = 0.0;
    open_system(&a, build, DMB_METHOD_INDEPENDENT);
    open_system(&b, build, DMB_METHOD_MULTIPLIERS);
    const dmb_pose start = pose_at(&a.s, a.places[0]);
    for (uint32_t k = 0; k < steps; k += 10) {
        take_steps(&a.s, h, 10);
        take_steps(&b.s, h, 10);
        differences(&a, &b, &motion, &force);
    }
    const dmb_pose end = pose_at(&a.s, a.places[0]);
    print_message("    %s, %g s\n", what, h * steps);
    tell("    the first part has moved by [m]", largest_difference(3, start.position, end.position));
    check_below("    poses and speeds of the two methods", motion, 1e-9);
    check_below("    their reactions, relative", force, 1e-9);
    check_below("    violation, independent", statistics_of(&a.s).violation, 1e-14);
    check_below("    violation, multipliers", statistics_of(&b.s).violation, 1e-14);
    tell("    iterations a step, independent", (double)statistics_of(&a.s).iterations / steps);
    tell("    iterations a step, multipliers", (double)statistics_of(&b.s).iterations / steps);
    rig_close(&a.s);
    rig_close(&b.s);
}

static void methods_agree_on_a_spatial_slider_crank(void **state)
{
    (void)state;
    compare_methods("spatial slider-crank", spatial_slider_crank, 1e-3, 2000);
}

static void methods_agree_on_a_swinging_pipe(void **state)
{
    (void)state;
    compare_methods("flexible pipe on a hinge", swinging_pipe, 1e-3, 1000);
}

static void methods_agree_on_a_flexible_loop(void **state)
{
    (void)state;
    compare_methods("closed loop with a flexible coupler", flexible_loop, 1e-3, 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(methods_agree_on_a_spatial_slider_crank),
        cmocka_unit_test(methods_agree_on_a_swinging_pipe),
        cmocka_unit_test(methods_agree_on_a_flexible_loop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
