/* Hard case 7: an impact on a step boundary, two at one instant, grazing at 1e-12 m/s, an accumulation of bounces, and
 * no tunnelling through the clearance. Balls in a wide hole, clearance 2 m. */
#include "contact_scene.h"

static dmb_wall_def wall_of(double stiffness)
{
    return scene_wide_wall(DMB_NORMAL_EXACT, stiffness, 1.0, 0.5);
}

static double kinetic_of(double v)
{
    return 0.5 * v * v;
}

/* ---- On a step boundary ------------------------------------------------------------------------------------------ */

/* Speed after an impact at 1 m/s in steps of h, the wall touched after `steps` steps and a part of one. */
static double bounce(double h, double steps)
{
    const dmb_wall_def wall = wall_of(1e6); /* the contact lasts 3 ms */
    dmb_body_def ball = scene_ball(1.0, steps * h, DMB_FREE_Z);
    rig scene;
    ball.velocity[2] = -1.0;
    scene_open(&scene, 0.0);
    add_wall(&scene, &wall);
    const dmb_id id = add_body(&scene, &ball);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < (int)(steps + 6e-3 / h); i++) scene_step(&scene, h);
    assert_int_equal(scene_contact(&scene, 0).closed, 0);
    const double v = scene_speed(&scene, id, DMB_Z);
    rig_close(&scene);
    return v;
}

/* Touching at the very end of a step is no worse than anywhere else in it, and all of it is of second order. */
static void on_step_boundary(void **state)
{
    static const double parts[] = {20.0, 20.0 + 1e-12, 20.0 - 1e-12, 20.25, 20.5, 20.75};
    double worst[2] = {0.0, 0.0};
    (void)state;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 6; i++) {
            const double e = bounce(k == 0 ? 2e-5 : 1e-5, parts[i]);
            worst[k] = fmax(worst[k], fabs(e - 0.5));
        }
    print_message("worst error of the restitution: %.2e at 2e-5 s, %.2e at 1e-5 s\n", worst[0], worst[1]);
    CHECK_BELOW(worst[0], 2e-4); /* 150 steps in the contact */
    CHECK_BELOW(worst[1], worst[0] / 3.0);
}

/* ---- Two at one instant ------------------------------------------------------------------------------------------ */

static dmb_id add_ball_at(rig *scene, double x, double gap, double speed)
{
    dmb_body_def ball = scene_ball(1.0, gap, DMB_FREE_Z);
    ball.position[0] = x;
    ball.velocity[2] = -speed;
    return add_body(scene, &ball);
}

/* Two balls that meet the wall together fly as each one alone, bit for bit; with step control too. */
static void two_at_one_instant(void **state)
{
    (void)state;
    for (int controlled = 0; controlled < 2; controlled++) {
        double z[3];
        for (int k = 0; k < 2; k++) {
            const dmb_wall_def wall = wall_of(1e6);
            rig scene;
            scene_open(&scene, 9.81);
            add_wall(&scene, &wall);
            const dmb_id a = add_ball_at(&scene, 0.0, 0.01, 1.0);
            const dmb_id b = k == 1 ? add_ball_at(&scene, 1.0, 0.01, 1.0) : a;
            rig_start_with(&scene, NULL, NULL);
            if (controlled)
                scene_advance(&scene, 0.5);
            else
                for (int i = 0; i < 500; i++) scene_step(&scene, 1e-3);
            z[k] = scene_position(&scene, a, 2);
            z[2] = scene_position(&scene, b, 2);
            rig_close(&scene);
        }
        print_message("two at one instant: %.3g and %.3g m from one alone\n", z[1] - z[0], z[2] - z[0]);
        CHECK_CLOSE(z[1], z[0], 0.0);
        CHECK_CLOSE(z[2], z[0], 0.0);
    }
}

/* A pipe of two rings that lands flat: both ends touch in one step, and it does not begin to tilt. */
static void flat_landing(void **state)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    rig scene;
    double tilt = 0.0;
    (void)state;
    wall.friction_law = DMB_FRICTION_NONE;
    pipe.kind = DMB_PIPE_RIGID;
    string.start_free = string.end_free = DMB_FREE_ALL;
    string.velocity[2] = -0.5;
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    add_string(&scene, &string);
    const dmb_id id = add_pipes(&scene, &pipe, 1);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 1000; i++) {
        dmb_pose near = dmb_pose_default(), far = dmb_pose_default();
        scene_step(&scene, 1e-4);
        assert_int_equal(dmb_query_pose(scene.sim, dmb_station(id, 0, 0.0), &near), DMB_OK);
        assert_int_equal(dmb_query_pose(scene.sim, dmb_station(id, 0, 1.0), &far), DMB_OK);
        tilt = fmax(tilt, fabs(near.position[2] - far.position[2]));
        CHECK_CLOSE(near.position[2], far.position[2], 1e-14);
        CHECK_CLOSE(scene_contact(&scene, 0).normal_force, scene_contact(&scene, 1).normal_force, 1e-6);
    }
    print_message("flat landing: ends apart by %.2e m\n", tilt);
    rig_close(&scene);
}

/* ---- Grazing ----------------------------------------------------------------------------------------------------- */

/* At 1e-12 m/s the wall would be met to a depth of v sqrt(m/K) = 3e-16 m, less than the rounding of a place 2 m from
 * the axis, u = 4.4e-16 m. The speed that is left is that of rounding: some sqrt(K/m) u = 1.4e-12 m/s, however long the
 * step is. */
static const double grazing_speed = 1e-10;

static void grazing(void **state)
{
    static const double steps[] = {1e-6, 1e-3, 1.0};
    (void)state;
    for (int k = 0; k < 3; k++) {
        const dmb_wall_def wall = wall_of(1e7);
        dmb_body_def ball = scene_ball(1.0, 1e-12, DMB_FREE_Z);
        rig scene;
        ball.velocity[2] = -1e-12;
        scene_open(&scene, 0.0);
        add_wall(&scene, &wall);
        const dmb_id id = add_body(&scene, &ball);
        rig_start_with(&scene, NULL, NULL);
        for (int i = 0; i < 100; i++) {
            const dmb_step_report report = scene_step(&scene, steps[k]);
            CHECK_BELOW(report.most_iterations, 12);
        }
        const double v = scene_speed(&scene, id, DMB_Z);
        assert_true(isfinite(v));
        print_message("grazing at 1e-12 m/s, step %g: leaves at %.2e m/s\n", steps[k], v);
        CHECK_BELOW(fabs(v), grazing_speed);
        CHECK_BELOW(fabs(scene_contact(&scene, 0).gap), 1e-8);
        rig_close(&scene);
    }
}

/* A ball that flies along the wall and touches it tangentially keeps its speed. */
static void grazing_flight(void **state)
{
    const dmb_wall_def wall = wall_of(1e7);
    dmb_body_def ball = scene_ball(1.0, 1e-13, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z);
    rig scene;
    (void)state;
    ball.velocity[0] = 3.0;
    ball.velocity[2] = -1e-12;
    scene_open(&scene, 0.0);
    add_wall(&scene, &wall);
    const dmb_id id = add_body(&scene, &ball);
    rig_start_with(&scene, NULL, NULL);
    scene_advance(&scene, 1.0);
    CHECK_RELATIVE(scene_speed(&scene, id, DMB_X), 3.0, 1e-14);
    CHECK_BELOW(fabs(scene_speed(&scene, id, DMB_Z)), grazing_speed);
    rig_close(&scene);
}

/* ---- Accumulation ------------------------------------------------------------------------------------------------ */

/* Bounces that shrink below every step: fixed steps and step control come to rest at m g/K with bounded work, and never
 * above the height before. */
static void accumulation(void **state)
{
    static const double steps[] = {1e-2, 1e-3, 1e-4, 0.0};
    (void)state;
    for (int k = 0; k < 4; k++) {
        const dmb_wall_def wall = wall_of(1e7);
        const dmb_body_def ball = scene_ball(1.0, 0.01, DMB_FREE_Z);
        rig scene;
        dmb_step_report report = dmb_step_report_default();
        uint32_t rejected = 0;
        scene_open(&scene, 9.81);
        add_wall(&scene, &wall);
        add_body(&scene, &ball);
        rig_start_with(&scene, NULL, NULL);
        const double start = scene_total_energy(&scene);
        double most = start;
        for (int i = 0; steps[k] > 0.0 && i < (int)(2.0 / steps[k]); i++) {
            report = scene_step(&scene, steps[k]);
            rejected += report.rejected;
            most = fmax(most, scene_total_energy(&scene));
        }
        if (!(steps[k] > 0.0)) report = scene_advance(&scene, 2.0);
        print_message("step %g: %u rejected, %u steps in the last call, energy above start %.2e\n", steps[k], rejected,
                      report.steps, (most - start) / (9.81 * 0.01));
        CHECK_RELATIVE(scene_contact(&scene, 0).gap, -9.81 / 1e7, 1e-2);
        CHECK_BELOW((most - start) / (9.81 * 0.01), 1e-12);
        CHECK_BELOW(report.steps, 2000);
        rig_close(&scene);
    }
}

/* ---- No tunnelling ----------------------------------------------------------------------------------------------- */

/* 10 m/s at steps of 1e-2 s, a tenth of a metre each, in any phase and at any stiffness: the wall does not throw the
 * ball back faster than it came, and lets it in by a part of the step's way at most. That part does not go to 0 with
 * the stiffness: the law does not pull, so within one step the ball cannot leave faster than v0/mu = .7 v0. */
static void no_tunnelling(void **state)
{
    static const double stiffness[] = {1e5, 1e7, 1e9, 1e12};
    double deepest = 0.0, fastest = 0.0;
    (void)state;
    for (int k = 0; k < 4; k++)
        for (int phase = 0; phase < 20; phase++) {
            const dmb_wall_def wall = wall_of(stiffness[k]);
            dmb_body_def ball = scene_ball(1.0, 0.1 + 0.005 * phase + 1e-4, DMB_FREE_Z);
            rig scene;
            ball.velocity[2] = -10.0;
            scene_open(&scene, 0.0);
            add_wall(&scene, &wall);
            const dmb_id id = add_body(&scene, &ball);
            rig_start_with(&scene, NULL, NULL);
            for (int i = 0; i < 30; i++) {
                const int32_t status = dmb_sim_step(scene.sim, 1e-2, NULL);
                if (status < 0) break; /* refusing is an answer too */
                const double v = scene_speed(&scene, id, DMB_Z);
                if (k > 0) deepest = fmax(deepest, -scene_contact(&scene, 0).gap); /* k 0 gives way by 3 cm itself */
                fastest = fmax(fastest, fabs(v));
                CHECK_BELOW(kinetic_of(v), kinetic_of(10.0) * 1.0001);
            }
            rig_close(&scene);
        }
    print_message("deepest %.3e m, fastest %.6f m/s\n", deepest, fastest);
    CHECK_BELOW(deepest, 0.02);
}

/* The clearance of the rig, 10.5 mm, at 10 m/s and 1e-2 s: one step would cross the hole five times over, and begins on
 * the other side of the axis at times. */
static void narrow_hole(void **state)
{
    double deepest = 0.0;
    (void)state;
    for (int phase = 0; phase < 20; phase++) {
        dmb_wall_def wall = wall_of(1e8);
        dmb_body_def ball = dmb_body_def_default();
        rig scene;
        wall.diameter = 0.094;
        ball.contact_diameter = 0.073;
        ball.position[2] = 0.0005 * phase - 0.005;
        ball.velocity[2] = -10.0;
        ball.free_mask = DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z;
        scene_open(&scene, 9.81);
        add_wall(&scene, &wall);
        add_body(&scene, &ball);
        rig_start_with(&scene, NULL, NULL);
        for (int i = 0; i < 50; i++) {
            const int32_t status = dmb_sim_step(scene.sim, 1e-2, NULL);
            if (status < 0) break;
            deepest = fmax(deepest, -scene_contact(&scene, 0).gap);
            CHECK_BELOW(-scene_contact(&scene, 0).gap, 0.02);                /* of the step's 100 mm */
            CHECK_BELOW(energy_of(&scene).kinetic, 1.01 * kinetic_of(10.0)); /* and 1 % for the height */
        }
        rig_close(&scene);
    }
    print_message("narrow hole: deepest %.3e m\n", deepest);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(on_step_boundary), cmocka_unit_test(two_at_one_instant), cmocka_unit_test(flat_landing),
        cmocka_unit_test(grazing),          cmocka_unit_test(grazing_flight),     cmocka_unit_test(accumulation),
        cmocka_unit_test(no_tunnelling),    cmocka_unit_test(narrow_hole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
