/* Springs and dampers between two points, and loads at any place, against closed forms, independent integration, their
 * own energy, and the same scene described in another way. */
#include <string.h>

#include "drillmbd/scene.h"
#include "mechanism.h"
#include "modal.h"
#include "ode.h"

static const double g = 9.81;

static dmb_place nowhere(void)
{
    return dmb_station(ground_id, 0, 0.0);
}

static dmb_id add_spring(rig *s, const dmb_spring_def *def)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_spring(s->model, def, &id));
    return id;
}

static dmb_spring_state spring_at(const rig *s, dmb_id spring)
{
    dmb_spring_state state = dmb_spring_state_default();
    must(s, dmb_query_spring(s->sim, spring, &state));
    return state;
}

/* A ball of mass 1 and inertia 1 at (x, 0, z). */
static dmb_id add_ball(rig *s, double x, double z)
{
    dmb_body_def body = dmb_body_def_default();
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
    body.position[0] = x;
    body.position[2] = z;
    return add_body(s, &body);
}

static dmb_spring_def spring_between(dmb_place a, dmb_place b, double k, double c)
{
    dmb_spring_def def = dmb_spring_def_default();
    def.place_a = a;
    def.place_b = b;
    def.stiffness = k;
    def.damping = c;
    return def;
}

/* ---- A ball on a spring ------------------------------------------------------------------------------------------ */

typedef struct swing {
    double k, c, length;
    int rope; /* pulls only */
} swing;

/* x, z and their rates under gravity, a spring and a damper along it. */
static void hanging(void *context, double t, const double *y, double *rate)
{
    const swing *o = context;
    const double length = hypot(y[0], y[1]), speed = (y[0] * y[2] + y[1] * y[3]) / length;
    double pull = o->k * (length - o->length) + o->c * speed;
    (void)t;
    if (o->rope && (length < o->length || pull < 0.0)) pull = 0.0;
    rate[0] = y[2];
    rate[1] = y[3];
    rate[2] = -pull * y[0] / length;
    rate[3] = -pull * y[1] / length - g;
}

/* Distance after 1 s from the independent solution, from (1, 0) at rest with the spring at its free length. */
static double swing_error(const swing *o, double step, double *balance)
{
    const dmb_sim_options options = sharp_options(1.0, 1e-11);
    double y[4] = {1.0, 0.0, 0.0, 0.0};
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    const dmb_id ball = add_ball(&s, 1.0, 0.0);
    dmb_spring_def def = spring_between(nowhere(), dmb_station(ball, 0, 0.0), o->k, o->c);
    def.free_length = o->length;
    def.acts = o->rope ? DMB_SPRING_TENSION : DMB_SPRING_BOTH;
    (void)add_spring(&s, &def);
    (void)mechanism_start(&s, &options);
    take_steps(&s, step, (uint32_t)lround(1.0 / step));
    ode_solve(hanging, (void *)(uintptr_t)o, 0.0, 1.0, 2000, 4, y);
    const dmb_pose pose = pose_at(&s, dmb_station(ball, 0, 0.0));
    *balance = energy_of(&s).balance;
    rig_close(&s);
    return hypot(pose.position[0] - y[0], pose.position[2] - y[1]);
}

static void a_ball_swings_on_a_spring(void **state)
{
    const swing spring = {200.0, 0.0, 1.0, 0}, damped = {200.0, 5.0, 0.8, 0};
    double balance, fine_balance;
    (void)state;
    const double coarse = swing_error(&spring, 2e-3, &balance), fine = swing_error(&spring, 1e-3, &fine_balance);
    check_below("ball on a spring against another integration [m]", fine, 2e-4);
    check_order("ball on a spring", coarse, fine, 2.0, 0.02);
    check_order("its energy balance [J]", fabs(balance), fabs(fine_balance), 2.0, 0.3);
    const double rough = swing_error(&damped, 2e-3, &balance), smooth = swing_error(&damped, 1e-3, &fine_balance);
    check_below("ball on a spring and damper [m]", smooth, 2e-4);
    check_order("ball on a spring and damper", rough, smooth, 2.0, 0.05);
    check_order("its energy balance [J]", fabs(balance), fabs(fine_balance), 2.0, 0.3);
}

/* Falls freely 1 m below the point until the rope is taut. */
static void a_rope_pulls_only(void **state)
{
    const swing rope = {2000.0, 20.0, 1.2, 1};
    double balance;
    (void)state;
    check_below("ball on a rope against another integration [m]", swing_error(&rope, 1e-4, &balance), 2e-5);
    check_below("its energy balance [J]", balance, 1e-5);
}

/* ---- Closed forms ------------------------------------------------------------------------------------------------ */

/* Two balls and a damper spring: s^2 + 2 c s/m + 2 k/m = 0 along the line. */
static void two_balls_swing_against_each_other(void **state)
{
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id a = add_ball(&s, 0.0, 0.0), b = add_ball(&s, 1.0, 0.5);
    dmb_spring_def def = spring_between(dmb_station(a, 0, 0.0), dmb_station(b, 0, 0.0), 300.0, 4.0);
    (void)add_spring(&s, &def);
    (void)mechanism_start(&s, NULL);
    dmb_modes *modes = all_modes(&s, DMB_MODES_DAMPED);
    const dmb_modes_info info = info_of(modes);
    const dmb_mode last = mode_at(modes, info.count - 1);
    check_relative("damped root of two balls, real", last.eigenvalue[0], -4.0, 1e-10);
    check_relative("damped root of two balls, imaginary", last.eigenvalue[1], sqrt(600.0 - 16.0), 1e-10);
    assert_int_equal(info.rigid, 11);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* A ball held off its centre by three long springs hangs with its centre below; the force in the slanted ones follows
 * from geometry. Tension of two symmetric springs of stiffness k from (+-1, 0) to a ball of weight m g: 2 T sin a. */
static void slanted_springs_carry_a_weight(void **state)
{
    rig s;
    dmb_id spring[2];
    (void)state;
    rig_open(&s, 0.0, 0.0, -g);
    const dmb_id ball = add_ball(&s, 0.0, -0.4);
    for (int i = 0; i < 2; i++) {
        dmb_spring_def def = spring_between(nowhere(), dmb_station(ball, 0, 0.0), 50.0, 0.0);
        def.offset_a[0] = i == 0 ? -1.0 : 1.0;
        def.offset_b[2] = 0.2;
        def.free_length = 0.9;
        def.acts = DMB_SPRING_TENSION;
        spring[i] = add_spring(&s, &def);
    }
    dmb_joint_def upright = joint_between(DMB_JOINT_FREE, nowhere(), dmb_station(ball, 0, 0.0));
    upright.stiffness[DMB_RX] = upright.stiffness[DMB_RY] = upright.stiffness[DMB_RZ] = 1.0;
    upright.stiffness[DMB_Y] = 1.0;
    (void)add_joint(&s, &upright);
    (void)mechanism_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    const dmb_spring_state found = spring_at(&s, spring[0]);
    check_relative("force of a spring by its elongation", found.force, 50.0 * (found.length - 0.9), 1e-12);
    check_relative("weight on two slanted springs", 2.0 * found.force * -found.direction[2], g, 1e-9);
    check_relative("energy of a spring", found.energy, 25.0 * found.elongation * found.elongation, 1e-12);
    check_relative("energy of the scene", energy_of(&s).strain, 2.0 * found.energy, 1e-9);
    rig_close(&s);
}

/* A rigid bar of length 2 on a hinge at its foot, pushed down at its head by P and held at 3/4 of its height by a
 * spring across: P 2 = k 1.5^2. */
static void a_spring_holds_a_column(void **state)
{
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling *found = NULL;
    dmb_load_def push = dmb_load_def_default();
    const dmb_segment off = dmb_segment_default();
    double factor;
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    const bar upright = {{0.0, 0.0}, {0.0, 2.0}, 1.0};
    const dmb_id column = add_bar(&s, &upright);
    (void)add_hinge(&s, "foot", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(column, -1.0));
    dmb_spring_def def = spring_between(nowhere(), dmb_station(column, 0, 0.0), 40.0, 0.0);
    def.offset_a[0] = 3.0;
    def.offset_a[2] = 1.5;
    def.offset_b[0] = 0.5;
    (void)add_spring(&s, &def);
    push.place = dmb_station(column, 0, 0.0);
    push.offset[0] = 1.0;
    push.force[2] = -1.0;
    push.time_function = add_time_function(&s, &off, 1);
    options.part = add_load(&s, &push);
    options.scale = DMB_SCALE_PART;
    options.follow = 0;
    options.factor_max = 1e6;
    (void)mechanism_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    must(&s, dmb_analysis_buckling(s.sim, &options, &found));
    must(&s, dmb_buckling_factor(found, 0, &factor));
    check_relative("critical load of a bar that a spring holds", factor, 40.0 * 1.5 * 1.5 / 2.0, 1e-9);
    dmb_buckling_destroy(&found);
    rig_close(&s);
}

/* ---- The same in another way ------------------------------------------------------------------------------------- */

/* Two sliders on one axis with a joint spring between them, or with one between points. */
static rig sliders(int between_points)
{
    const dmb_sim_options options = sharp_options(0.9, 1e-11);
    rig s;
    dmb_id body[2];
    rig_open(&s, 3.0, 0.0, 0.0);
    for (int i = 0; i < 2; i++) {
        body[i] = add_ball(&s, 2.0 * i, 0.0);
        (void)add_joint_between(&s, DMB_JOINT_PRISMATIC, i == 0 ? nowhere() : dmb_station(body[0], 0, 0.0),
                                dmb_station(body[i], 0, 0.0));
    }
    if (between_points) {
        dmb_spring_def def = spring_between(dmb_station(body[0], 0, 0.0), dmb_station(body[1], 0, 0.0), 30.0, 0.7);
        def.free_length = 1.5;
        (void)add_spring(&s, &def);
    } else {
        dmb_joint_def law = joint_between(DMB_JOINT_FREE, dmb_station(body[0], 0, 0.0), dmb_station(body[1], 0, 0.0));
        law.stiffness[DMB_X] = 30.0;
        law.damping[DMB_X] = 0.7;
        law.rest[DMB_X] = 1.5;
        (void)add_joint(&s, &law);
    }
    (void)mechanism_start(&s, &options);
    return s;
}

static void a_spring_is_a_joint_spring(void **state)
{
    rig a = sliders(0), b = sliders(1);
    double worst = 0.0;
    (void)state;
    for (int i = 0; i < 200; i++) {
        dmb_energy ea, eb;
        take_steps(&a, 5e-3, 1);
        take_steps(&b, 5e-3, 1);
        ea = energy_of(&a), eb = energy_of(&b);
        worst = fmax(worst, fmax(fabs(ea.kinetic - eb.kinetic), fabs(ea.strain - eb.strain)));
        worst = fmax(worst, fabs(ea.damping - eb.damping));
    }
    check_below("spring between points against the spring of a joint [J]", worst, 1e-10);
    rig_close(&a);
    rig_close(&b);
}

/* Tip of a cantilever of one or several elements under a small load 0.37 along it. */
static double tip_of(uint32_t parts, double fraction, int32_t frame, double offset_y)
{
    rig s;
    dmb_load_def load = dmb_load_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_pipe_def pipe = beam_pipe(1.0, parts, 1e7, 3e6, 1e4, 2e4);
    const dmb_id beam = add_beam(&s, &pipe, DMB_FREE_NONE);
    load.place = dmb_station(beam, 0, fraction);
    load.frame = frame;
    load.force[2] = -0.5;
    load.moment[1] = 0.3;
    load.offset[1] = offset_y;
    (void)add_load(&s, &load);
    (void)mechanism_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    const dmb_pose pose = pose_at(&s, dmb_station(beam, 0, 1.0));
    const double tip = pose.displacement[2] + 0.1 * rotation_at(&s, dmb_station(beam, 0, 1.0));
    rig_close(&s);
    return tip;
}

/* The shapes inside an element are those of a beam under end loads, so that a small load inside moves the nodes
 * exactly as a node there would. */
static void a_load_inside_an_element_is_one_on_a_node(void **state)
{
    (void)state;
    for (int32_t frame = DMB_FRAME_WORLD; frame <= DMB_FRAME_BODY; frame++) {
        check_relative("tip under a load inside an element, not on a node", tip_of(1, 0.4, frame, 0.0),
                       tip_of(5, 0.4, frame, 0.0), 2e-9);
        check_relative("the same, beside the axis", tip_of(1, 0.4, frame, 0.05), tip_of(5, 0.4, frame, 0.05), 1e-6);
    }
}

/* ---- Tables ------------------------------------------------------------------------------------------------------ */

static const double lengths[5] = {-0.2, 0.0, 0.1, 0.3, 0.5}, forces[5] = {-30.0, 0.0, 5.0, 40.0, 45.0};

/* A ball on rails along x against a table, pulled by gravity. */
static dmb_spring_state pulled(int32_t kind, int32_t acts, double pull, double *strain)
{
    rig s;
    rig_open(&s, pull, 0.0, 0.0);
    const dmb_id ball = add_ball(&s, 1.0, 0.0);
    (void)add_joint_between(&s, DMB_JOINT_PRISMATIC, nowhere(), dmb_station(ball, 0, 0.0));
    dmb_spring_def def = spring_between(nowhere(), dmb_station(ball, 0, 0.0), 0.0, 0.0);
    def.acts = acts;
    def.offset_a[0] = -0.1;
    def.free_length = 1.0;
    def.table_elongation = lengths;
    def.table_force = forces;
    def.table_count = 5;
    def.table_kind = kind;
    const dmb_id spring = add_spring(&s, &def);
    (void)mechanism_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    const dmb_spring_state found = spring_at(&s, spring);
    *strain = energy_of(&s).strain;
    rig_close(&s);
    return found;
}

/* Work of slow pulls up to each: the integral by Simpson's rule of what statics find at three pulls is their energy. */
static void a_table_is_met_and_stores_its_integral(void **state)
{
    double strain;
    (void)state;
    dmb_spring_state line = pulled(DMB_TABLE_LINES, DMB_SPRING_BOTH, 22.5, &strain);
    check_close("elongation on a straight line of the table [m]", line.elongation, 0.2, 1e-9);
    check_close("its energy [J]", line.energy, 0.25 + 0.5 * (5.0 + 22.5) * 0.1, 1e-9);
    check_close("energy of the scene [J]", strain, line.energy, 1e-9);
    line = pulled(DMB_TABLE_LINES, DMB_SPRING_TENSION, 50.0, &strain);
    check_close("elongation beyond the table [m]", line.elongation, 0.7, 1e-9);
    const dmb_spring_state at = pulled(DMB_TABLE_CUBIC, DMB_SPRING_BOTH, 40.0, &strain);
    check_close("a cubic passes through its points [m]", at.elongation, 0.3, 1e-9);
    double sum = 0.0, last = 0.0;
    for (int i = 1; i <= 80; i++) { /* by pieces of f: E = f x - integral of x over f */
        const dmb_spring_state b = pulled(DMB_TABLE_CUBIC, DMB_SPRING_BOTH, 0.5 * i, &strain);
        assert_true(b.elongation > last);
        sum += 0.5 * (b.elongation - last) * (2.0 * b.force - 0.5);
        last = b.elongation;
    }
    check_close("energy of a cubic by its force [J]", at.energy, sum, 2e-3);
}

/* ---- Poses off a place ------------------------------------------------------------------------------------------- */

static void poses_off_a_place_move_with_it(void **state)
{
    const double offset[3] = {0.1, -0.2, 0.3};
    dmb_body_def body = dmb_body_def_default();
    dmb_pose pose = dmb_pose_default(), later = dmb_pose_default();
    dmb_motion motion = dmb_motion_default(), end = dmb_motion_default();
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, -g);
    for (int i = 0; i < 6; i++) body.velocity[i] = 0.3 + 0.2 * i;
    body.rotation[1] = 0.7;
    const dmb_place place = dmb_station(add_body(&s, &body), 0, 0.0);
    (void)mechanism_start(&s, NULL);
    take_steps(&s, 1e-5, 20);
    must(&s, dmb_query_pose_at(s.sim, place, offset, &pose));
    must(&s, dmb_query_motion_at(s.sim, place, offset, &motion));
    take_steps(&s, 1e-5, 1);
    must(&s, dmb_query_pose_at(s.sim, place, offset, &later));
    must(&s, dmb_query_motion_at(s.sim, place, offset, &end));
    for (int i = 0; i < 3; i++) {
        const double mean = 0.5 * (motion.velocity[i] + end.velocity[i]);
        check_close("speed of a point off a body [m/s]", (later.position[i] - pose.position[i]) / 1e-5, mean, 1e-8);
        check_close("its displacement [m/s]", (later.displacement[i] - pose.displacement[i]) / 1e-5, mean, 1e-8);
        check_close("its acceleration [m/s2]", (end.velocity[i] - motion.velocity[i]) / 1e-5,
                    0.5 * (motion.acceleration[i] + end.acceleration[i]), 1e-6);
    }
    rig_close(&s);
}

/* A ball on a stiff damped spring far from resolved comes to rest, where its forces are rounding, and stays there. */
static void decayed_oscillations_stay_at_rest(void **state)
{
    static const double cases[][5] = {{1e4, 0.01, 0.0, 1e-2, 1.0}, /* w, damping ratio, spectral radius, step, length */
                                      {1e4, 0.1, 0.5, 1e-2, 1000.0},
                                      {1e5, 0.01, 0.5, 1e-2, 1.0},
                                      {1e5, 0.1, 0.5, 1e-3, 1.0},
                                      {1e6, 0.01, 0.8, 1e-3, 1.0}};
    (void)state;
    for (int i = 0; i < 5; i++) {
        const double *of = cases[i];
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_place ball = dmb_station(add_ball(&s, 1e-4, 0.0), 0, 0.0);
        dmb_spring_def def = spring_between(nowhere(), ball, of[0] * of[0], 2.0 * of[1] * of[0]);
        def.offset_a[0] = -of[4];
        def.free_length = of[4];
        (void)add_spring(&s, &def);
        dmb_sim_options options = dmb_sim_options_default();
        options.spectral_radius = of[2];
        (void)rig_start(&s, &options);
        for (int n = 0; n < 400; n++) must(&s, dmb_sim_step(s.sim, of[3], NULL));
        check_below("place at the end [m]", fabs(pose_at(&s, ball).position[0]), 1e-12 * of[4]);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_swings_on_a_spring),
        cmocka_unit_test(a_rope_pulls_only),
        cmocka_unit_test(two_balls_swing_against_each_other),
        cmocka_unit_test(slanted_springs_carry_a_weight),
        cmocka_unit_test(a_spring_holds_a_column),
        cmocka_unit_test(a_spring_is_a_joint_spring),
        cmocka_unit_test(a_load_inside_an_element_is_one_on_a_node),
        cmocka_unit_test(a_table_is_met_and_stores_its_integral),
        cmocka_unit_test(poses_off_a_place_move_with_it),
        cmocka_unit_test(decayed_oscillations_stay_at_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
