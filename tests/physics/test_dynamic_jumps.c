/* Forces and prescribed accelerations that jump between steps: second order is kept. */
#include <stdio.h>

#include "rig.h"

static rig pipes_on_a_drive(int32_t kind, dmb_id time_function_of(rig *), dmb_id *drive, dmb_id *string)
{
    rig s;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def def = dmb_drive_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    pipe.young_modulus = 2.1e8; /* soft: a smooth motion */
    *string = add_pipes(&s, &pipe, 4);
    def.kind = kind;
    def.part = *string;
    def.component = DMB_X;
    def.time_function = time_function_of(&s);
    def.gain = 2e3;
    def.integral_gain = 1e4;
    *drive = add_drive(&s, &def);
    rig_start(&s, NULL);
    return s;
}

static dmb_id nothing(rig *s)
{
    return add_constant(s, 0.0);
}

/* Speed 0, then rising from 0.05 s on: its slope has a kink there. */
static dmb_id kink(rig *s)
{
    static const double time[3] = {0.0, 0.05, 1.05}, value[3] = {0.0, 0.0, 1.0};
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = time;
    term.table_value = value;
    term.table_count = 3;
    return add_time_function(s, &term, 1);
}

/* Place of the far end at 0.1 s, the drive set to `value` at 0.05 s where that is a number. */
static double far_end(int32_t kind, dmb_id time_function_of(rig *), double value, double h)
{
    dmb_id drive, string;
    rig s = pipes_on_a_drive(kind, time_function_of, &drive, &string);
    const uint32_t n = (uint32_t)lround(0.05 / h);
    take_steps(&s, h, n);
    if (!isnan(value)) must(&s, dmb_sim_set_drive(s.sim, drive, value));
    take_steps(&s, h, n);
    const double x = pose_at(&s, dmb_station(string, 3, 1.0)).displacement[0];
    rig_close(&s);
    return x;
}

/* By halving from `steps` steps up to the jump; the jump of the target excites faster motion and needs more of them. */
static void keeps_second_order(const char *what, int32_t kind, dmb_id time_function_of(rig *), double value,
                               double steps)
{
    const double h = 0.05 / steps;
    const double coarse = far_end(kind, time_function_of, value, h),
                 middle = far_end(kind, time_function_of, value, h / 2.0);
    const double fine = far_end(kind, time_function_of, value, h / 4.0);
    check_order(what, coarse - middle, middle - fine, 2.0, 0.15);
}

static void force_set_by_hand(void **state)
{
    (void)state;
    keeps_second_order("order after a jump of the force", DMB_DRIVE_LOAD, nothing, 100.0, 128.0);
}

static void target_set_by_hand(void **state)
{
    (void)state;
    keeps_second_order("order after a jump of the target", DMB_DRIVE_CONTROL, nothing, 1.0, 1024.0);
}

static void kink_of_a_motion_time_function(void **state)
{
    (void)state;
    keeps_second_order("order after a kink of the speed", DMB_DRIVE_MOTION, kink, (double)NAN, 512.0);
}

/* A bit laid on the rock by its weight stays at rest. */
static void string_at_rest_on_the_rock(void **state)
{
    (void)state;
    for (int32_t law = DMB_ROCK_NONE; law <= DMB_ROCK_REGENERATIVE; law++) {
        rig s;
        dmb_string_def down = dmb_string_def_default();
        dmb_pipe_def pipe = dmb_pipe_def_default();
        dmb_bit_def bit = dmb_bit_def_default();
        rig_open(&s, 0.0, 0.0, -9.81);
        down.rotation[1] = PI / 2.0; /* x downwards */
        down.start_free = DMB_FREE_NONE;
        const dmb_id string = add_string(&s, &down);
        add_pipes(&s, &pipe, 100);
        bit.rock_law = law;
        must_model(&s, dmb_model_add_bit(s.model, &bit, NULL));
        rig_start(&s, NULL);
        (void)find_equilibrium(&s, NULL);
        check_below("acceleration of the bit at rest",
                    motion_at(&s, dmb_station(string, 99, 1.0), DMB_FRAME_WORLD).acceleration[2], 1e-6);
        take_steps(&s, 1e-3, 20);
        check_below("speed after 20 ms", motion_at(&s, dmb_station(string, 99, 1.0), DMB_FRAME_WORLD).velocity[2],
                    1e-6);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(force_set_by_hand),
        cmocka_unit_test(target_set_by_hand),
        cmocka_unit_test(kink_of_a_motion_time_function),
        cmocka_unit_test(string_at_rest_on_the_rock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
