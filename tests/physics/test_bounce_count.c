/* Bounces that fewer than ten steps resolve are counted alike at the wall, at a stop and on a one-sided spring; lasting
 * contacts are not. A ball of 1 kg falls on one of them, of the same stiffness. */
#include "contact_scene.h"

enum { ON_THE_WALL, ON_A_STOP, ON_A_SPRING, KINDS };
static const char *const names[KINDS] = {"wall", "stop", "one-sided spring"};
static const double g = 9.81, stiffness = 1e6;

static void add_stop(rig *s, dmb_id ball, double gap)
{
    dmb_joint_def play = joint_between(DMB_JOINT_FREE, dmb_station((dmb_id){0, 0}, 0, 0.0), dmb_station(ball, 0, 0.0));
    play.origin_a[2] = gap - 2.0;
    play.stop_low[DMB_Z] = -gap;
    play.stop_high[DMB_Z] = 100.0;
    play.stop_stiffness = stiffness;
    (void)add_joint(s, &play);
}

static void add_spring(rig *s, dmb_id ball)
{
    dmb_spring_def spring = dmb_spring_def_default();
    dmb_id id = {0, 0};
    spring.place_a = dmb_station((dmb_id){0, 0}, 0, 0.0);
    spring.place_b = dmb_station(ball, 0, 0.0);
    spring.offset_a[2] = -3.0;
    spring.free_length = 1.0;
    spring.acts = DMB_SPRING_COMPRESSION;
    spring.stiffness = stiffness;
    must_model(s, dmb_model_add_spring(s->model, &spring, &id));
}

/* From 1 s on a force of twice its weight. */
static void throw_up(rig *s, dmb_id ball)
{
    const dmb_segment up = scene_step_segment(1.0, 0.0, 1.001, 2.0 * g);
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(ball, 0, 0.0);
    load.force[2] = 1.0;
    load.time_function = add_time_function(s, &up, 1);
    (void)add_load(s, &load);
}

static dmb_id open_scene(rig *s, int kind, double gap, int thrown)
{
    const dmb_wall_def wall = scene_wide_wall(DMB_NORMAL_EXACT, stiffness, 1.0, 1.0);
    const dmb_body_def def = scene_ball(1.0, gap, DMB_FREE_Z);
    scene_open(s, g);
    if (kind == ON_THE_WALL) add_wall(s, &wall);
    const dmb_id ball = add_body(s, &def);
    if (kind == ON_A_STOP) add_stop(s, ball, gap);
    if (kind == ON_A_SPRING) add_spring(s, ball);
    if (thrown) throw_up(s, ball);
    rig_start_with(s, NULL, NULL);
    return ball;
}

/* Steps of h w over a time; bounces counted. */
static uint64_t counted(rig *s, double hw, double time)
{
    const double h = hw / sqrt(stiffness);
    for (int i = 0; i < (int)(time / h); i++) must(s, dmb_sim_step(s->sim, h, NULL));
    return statistics_of(s).bounces;
}

/* From 5 cm the ball meets the ground at 0.1010, 0.3029, 0.5048, 0.7067 and 0.9086 s. A bounce takes pi/0.05 or pi/3
 * steps. */
static void all_kinds_count_alike(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int i = 0; i < 2; i++) {
            rig s;
            (void)open_scene(&s, kind, 0.05, 0);
            const uint64_t n = counted(&s, i == 0 ? 0.05 : 3.0, 1.0);
            print_message("    %s, h w = %s: %u\n", names[kind], i == 0 ? "0.05" : "3", (unsigned)n);
            assert_int_equal(n, i == 0 ? 0 : 5);
            rig_close(&s);
        }
}

/* A ball that lies at rest is thrown up after 1 s: its contact has lasted. */
static void lasting_contacts_are_not_counted(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        rig s;
        const dmb_id ball = open_scene(&s, kind, -g / stiffness, 1);
        assert_int_equal(counted(&s, 3.0, 1.2), 0);
        assert_true(scene_speed(&s, ball, DMB_Z) > 0.5 * g * 0.19); /* it has left */
        rig_close(&s);
    }
}

/* A ball with a restitution of 0.7 dropped from 1 m comes to rest at sqrt(2 h/g) (1 + e)/(1 - e) = 2.5586 s. */
static const double rest_time = 2.5586, restitution = 0.7;

static dmb_id drop(rig *s, double wall_stiffness, const dmb_sim_options *options)
{
    dmb_wall_def wall = scene_wide_wall(DMB_NORMAL_EXACT, wall_stiffness, 1.0, restitution);
    const dmb_body_def def = scene_ball(1.0, 1.0, DMB_FREE_Z);
    wall.approach_speed = 1e-5;
    scene_open(s, g);
    add_wall(s, &wall);
    const dmb_id ball = add_body(s, &def);
    rig_start_with(s, NULL, options);
    return ball;
}

/* In steps that resolve its bounces it does so. */
static void a_ball_comes_to_rest_in_resolved_steps(void **state)
{
    dmb_sim_options options = dmb_sim_options_default();
    double stop = 0.0;
    rig s;
    (void)state;
    options.tolerance_translation = 1e-11;
    options.step_min = 1e-12;
    options.newton_tolerance = 1e-8;
    const dmb_id ball = drop(&s, 1e10, &options);
    for (double t = 2.4; t < 2.7; t += 1e-4) {
        scene_advance(&s, t);
        if (fabs(scene_speed(&s, ball, DMB_Z)) > 2e-3) stop = t;
    }
    check_relative("rest [s]", stop, rest_time, 1e-3);
    rig_close(&s);
}

/* In steps of 1 ms at 1e8 N/m (h w = 10) the time of rest is another one, and the run says so: bounces are counted
 * until rest, none in the 2 s of rest after it. */
static void unresolved_bounces_are_told_until_rest(void **state)
{
    rig s;
    (void)state;
    const dmb_id ball = drop(&s, 1e8, NULL);
    for (int i = 0; i < 6000; i++) scene_step(&s, 1e-3);
    const uint64_t before = statistics_of(&s).bounces;
    check_below("speed at rest [m/s]", scene_speed(&s, ball, DMB_Z), 1e-3);
    for (int i = 0; i < 2000; i++) scene_step(&s, 1e-3);
    print_message("    %u bounces\n", (unsigned)before);
    assert_true(before >= 3);
    assert_int_equal(statistics_of(&s).bounces, before);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_kinds_count_alike),
        cmocka_unit_test(lasting_contacts_are_not_counted),
        cmocka_unit_test(a_ball_comes_to_rest_in_resolved_steps),
        cmocka_unit_test(unresolved_bounces_are_told_until_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
