/* Torque and drag along a wall without friction, and measurements that tell nothing of friction, or that a string which
 * locks up bounds. */
#include <string.h>

#include "drill_string.h"

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
    for (int kind = 0; kind < DMB_OPERATION_COUNT; kind++) {
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wall_without_friction),
        cmocka_unit_test(measurement_without_friction),
        cmocka_unit_test(torque_before_it_locks_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
