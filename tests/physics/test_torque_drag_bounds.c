/* Torque and drag along a wall without friction, and measurements that tell nothing of friction, are out of reach, or
 * that a string which locks up bounds; beside another string. */
#include <string.h>

#include "drill_string.h"
#include "drillmbd/scene.h"

/* Straight, `slope` [rad] off the vertical. */
static scene describe(uint32_t pipes, double slope)
{
    scene s = string_of(pipes);
    s.wall.direction[0] = sin(slope);
    s.wall.direction[2] = -cos(slope);
    s.wall.friction_law = DMB_FRICTION_COULOMB;
    s.wall.smoothing_speed = 1e-9;
    s.wall.mu_dynamic = 0.3;
    return s;
}

static dmb_operation usual(int32_t kind)
{
    dmb_operation operation = dmb_operation_default();
    must(dmb_operation_usual(kind, &operation), dmb_operation_name(kind));
    return operation;
}

static dmb_torque_drag_row row_with(const scene *s, double friction, const dmb_operation *operation)
{
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    options.friction = friction;
    must(dmb_analysis_torque_drag(s->sim, &options, operation, 1, &row), dmb_sim_message(s->sim));
    return row;
}

static void wall_without_friction(void **state)
{
    const double slope = 1.1, L = 200.0;
    scene s = describe(200, slope);
    (void)state;
    s.wall.friction_law = DMB_FRICTION_NONE;
    add_string(&s, 1);
    finish_scene(&s);
    for (int kind = 0; kind < (DMB_OPERATION_BACK_REAM + 1); kind++) {
        const dmb_operation operation = usual(kind);
        const dmb_torque_drag_row row = row_with(&s, -1.0, &operation);
        check_relative("hook load", row.hook_load, weight(&s) * L * cos(slope), 1e-12);
        check_relative("wall", row.wall_force, weight(&s) * L * sin(slope), 1e-12);
        assert_true(row.torque == 0.0);
    }
    const dmb_operation up = usual(DMB_OPERATION_PICK_UP);
    check_relative("with friction told", row_with(&s, 0.2, &up).hook_load,
                   weight(&s) * L * (cos(slope) + 0.2 * sin(slope)), 1e-12);
    destroy(&s);
}

/* In a vertical hole any coefficient gives the hook load that is measured. */
static void measurement_without_friction(void **state)
{
    scene s = describe(100, 0.0);
    const dmb_operation up = usual(DMB_OPERATION_PICK_UP);
    double found = 7.0;
    (void)state;
    add_string(&s, 1);
    finish_scene(&s);
    const double load = row_with(&s, 0.3, &up).hook_load;
    assert_int_equal(dmb_analysis_friction_factor(s.sim, NULL, &up, DMB_MEASURED_HOOK_LOAD, load, &found),
                     DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "friction factor: measured value"));
    assert_true(found == 7.0);
    destroy(&s);
}

/* Fed fast while it turns, pushed in a level hole: with much friction it locks up, and its torque has no bound. */
static void torque_before_it_locks_up(void **state)
{
    scene s = describe(1000, 0.5 * PI);
    dmb_operation feed = usual(DMB_OPERATION_DRILL);
    double found = 7.0;
    (void)state;
    add_string(&s, 1);
    finish_scene(&s);
    feed.axial_speed = 1.0;
    feed.weight_on_bit = 50000.0;
    assert_int_equal(row_with(&s, 10.0, &feed).locked, 1);
    const dmb_torque_drag_row row = row_with(&s, 0.05, &feed);
    assert_int_equal(row.locked, 0);
    must(dmb_analysis_friction_factor(s.sim, NULL, &feed, DMB_MEASURED_TORQUE, row.torque, &found),
         dmb_sim_message(s.sim));
    check_close("by the torque", found, 0.05, 1e-9);
    destroy(&s);
}

/* Lower hook loads than without friction while it is picked up, and higher ones than by the most; slack-off the other
 * way round; one between is found. */
static void measurements_out_of_reach(void **state)
{
    static const int32_t kinds[2] = {DMB_OPERATION_PICK_UP, DMB_OPERATION_SLACK_OFF};
    scene s = describe(100, 0.9);
    (void)state;
    add_string(&s, 1);
    finish_scene(&s);
    for (int k = 0; k < 2; k++) {
        const dmb_operation operation = usual(kinds[k]);
        const double free = row_with(&s, 0.0, &operation).hook_load, most = row_with(&s, 10.0, &operation).hook_load;
        const double beyond[2] = {free + 0.1 * (free - most), most - 0.1 * (free - most)};
        double found = 7.0;
        for (int i = 0; i < 2; i++) {
            assert_int_equal(
                dmb_analysis_friction_factor(s.sim, NULL, &operation, DMB_MEASURED_HOOK_LOAD, beyond[i], &found),
                DMB_ERR_VALUE);
            assert_non_null(strstr(dmb_sim_message(s.sim), "friction factor: measured value"));
            assert_true(found == 7.0);
        }
        const double load = row_with(&s, 0.25, &operation).hook_load;
        must(dmb_analysis_friction_factor(s.sim, NULL, &operation, DMB_MEASURED_HOOK_LOAD, load, &found),
             dmb_sim_message(s.sim));
        check_close("by the hook load", found, 0.25, 1e-9);
    }
    destroy(&s);
}

/* A ring with a reamer and a place that is stuck, on another string: this one has none of them. */
static void add_other(const scene *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    dmb_bit_def reamer = dmb_bit_def_default();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    string.start_depth = 500.0;
    must(dmb_model_add_string(s->model, &string, &pipe.string), dmb_model_message(s->model));
    must(dmb_model_add_pipes(s->model, &pipe, 2, NULL), dmb_model_message(s->model));
    ring.string = pipe.string;
    ring.outer_diameter = 0.09;
    must(dmb_model_add_stabiliser(s->model, &ring, &reamer.stabiliser), dmb_model_message(s->model));
    reamer.inner_radius = 0.03;
    reamer.radius = 0.045;
    must(dmb_model_add_bit(s->model, &reamer, NULL), dmb_model_message(s->model));
    stuck.place = dmb_station(pipe.string, 1, 1.0);
    must(dmb_model_add_stuck(s->model, &stuck, NULL), dmb_model_message(s->model));
}

static void another_string_does_not_count(void **state)
{
    const dmb_operation up = usual(DMB_OPERATION_PICK_UP);
    double load[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        scene s = describe(50, 0.9);
        add_string(&s, 1);
        if (i > 0) add_other(&s);
        finish_scene(&s);
        load[i] = row_with(&s, 0.3, &up).hook_load;
        destroy(&s);
    }
    assert_true(load[0] > 0.0);
    check_close("hook load beside another string [N]", load[1], load[0], 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wall_without_friction),         cmocka_unit_test(measurement_without_friction),
        cmocka_unit_test(torque_before_it_locks_up),     cmocka_unit_test(measurements_out_of_reach),
        cmocka_unit_test(another_string_does_not_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
