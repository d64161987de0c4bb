/* Calls that stand for several: drives of a constant value, ramps, one number of a sim, equality of ids. Each is
 * compared with the calls that it stands for. */
#include <math.h>
#include <string.h>

#include "rig.h"

/* A string in its hole that is fed and turned by constants, each as a value or as a time function. */
static void open_driven(rig *s, int32_t kind, int by_value, double feed, double turn, dmb_id drives[2])
{
    static const int32_t components[2] = {DMB_X, DMB_RX};
    const double values[2] = {feed, turn};
    const dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(s, 0.0, 0.0, -9.81);
    (void)add_wall(s, &wall);
    (void)add_pipes(s, &pipe, 6);
    for (int i = 0; i < 2; i++) {
        dmb_drive_def drive = dmb_drive_def_default();
        drive.kind = kind;
        drive.component = components[i];
        drive.gain = kind == DMB_DRIVE_CONTROL ? 1e3 : 0.0;
        if (by_value) drive.value = values[i];
        if (!by_value) drive.time_function = add_constant(s, values[i]);
        drives[i] = add_drive(s, &drive);
    }
}

/* The state has the same bits, and so do forces. */
static void a_value_is_a_constant_time_function(void **state)
{
    (void)state;
    for (int32_t kind = DMB_DRIVE_MOTION; kind <= DMB_DRIVE_CONTROL; kind++) {
        rig a, b;
        dmb_id of_a[2], of_b[2];
        open_driven(&a, kind, 1, 0.02, 3.0, of_a);
        open_driven(&b, kind, 0, 0.02, 3.0, of_b);
        rig_start(&a, NULL);
        rig_start(&b, NULL);
        take_divided_steps(&a, 1e-3, 50);
        take_divided_steps(&b, 1e-3, 50);
        assert_true(rig_hash(&a) == rig_hash(&b));
        for (int i = 0; i < 2; i++) {
            const double got = dmb_sim_value(a.sim, DMB_OUTPUT_DRIVE_FORCE, dmb_station(of_a[i], 0, 0.0));
            const double want = dmb_sim_value(b.sim, DMB_OUTPUT_DRIVE_FORCE, dmb_station(of_b[i], 0, 0.0));
            assert_true(isfinite(got) && memcmp(&got, &want, sizeof got) == 0);
        }
        rig_close(&a);
        rig_close(&b);
    }
}

/* Without a time function and a value the component stays where it is, although the string is pushed. */
static void a_drive_holds(void **state)
{
    rig s;
    dmb_drive_def hold = dmb_drive_def_default();
    dmb_load_def push = dmb_load_def_default();
    dmb_pipe_def pipe = s1_pipe();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    push.place = dmb_station(add_pipes(&s, &pipe, 4), 3, 1.0);
    push.force[0] = -2e4;
    add_load(&s, &push);
    const dmb_id drive = add_drive(&s, &hold);
    rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    assert_true(fabs(pose_at(&s, dmb_station(push.place.part, 0, 0.0)).displacement[0]) <= 1e-12);
    check_relative("force of the drive that holds",
                   dmb_sim_value(s.sim, DMB_OUTPUT_DRIVE_FORCE, dmb_station(drive, 0, 0)), 2e4, 1e-9);
    rig_close(&s);
}

static void values_are_checked(void **state)
{
    rig s;
    dmb_drive_def drive = dmb_drive_def_default();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_pipe_def pipe = s1_pipe();
    (void)add_pipes(&s, &pipe, 1);
    drive.time_function = add_constant(&s, 1.0);
    drive.value = 2.0;
    assert_int_equal(dmb_model_add_drive(s.model, &drive, NULL), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_model_message(s.model), "value = 2, must be 0 with a time_function"));
    drive.time_function = (dmb_id){0, 0};
    drive.value = (double)NAN;
    assert_int_equal(dmb_model_add_drive(s.model, &drive, NULL), DMB_ERR_NOT_FINITE);
    drive.value = 2e30;
    assert_int_equal(dmb_model_add_drive(s.model, &drive, NULL), DMB_ERR_VALUE);
    rig_close(&s);
}

/* A compile that fails after it has added the constants of drives removes them: numbers of time functions go on as
 * described, and the next compile works. */
static void a_failed_compile_leaves_no_constants(void **state)
{
    rig s;
    dmb_id drives[2], ramp = {0, 0};
    dmb_spring_def spring = dmb_spring_def_default();
    dmb_pipe_def pipe = s1_pipe();
    (void)state;
    open_driven(&s, DMB_DRIVE_MOTION, 1, 0.0, 1.0, drives);
    must_model(&s, dmb_model_add_ramp(s.model, 0.0, 1.0, 0.0, 1.0, &ramp));
    spring.place_a =
        dmb_station((dmb_id){(uint32_t)DMB_PART_STRING << 24, ramp.generation}, 6, 0.5); /* not there yet */
    spring.stiffness = 1e3;
    must_model(&s, dmb_model_add_spring(s.model, &spring, NULL));
    for (int i = 0; i < 3; i++) assert_int_equal(dmb_model_compile(s.model, NULL), DMB_ERR_VALUE);
    dmb_id next = ramp;
    must_model(&s, dmb_model_add_ramp(s.model, 0.0, 1.0, 0.0, 1.0, &next));
    assert_int_equal(next.index, ramp.index + 1);
    (void)add_pipes(&s, &pipe, 1);
    rig_start(&s, NULL);
    take_divided_steps(&s, 1e-3, 20);
    check_relative("speed", dmb_sim_value(s.sim, DMB_OUTPUT_DRIVE_SPEED, dmb_station(drives[1], 0, 0.0)), 1.0, 1e-12);
    rig_close(&s);
}

static size_t record_of(const dmb_model *model, unsigned char *bytes, size_t room)
{
    size_t size = 0;
    assert_int_equal(dmb_model_write(model, bytes, room, &size), DMB_OK);
    return size;
}

/* Constants of drives are no part of the description: a compiled model has the same record, and its time functions the
 * same numbers. */
static void constants_are_not_described(void **state)
{
    static unsigned char before[16384], after[16384];
    dmb_id drives[2], ramp = {0, 0}, beyond;
    char name[DMB_NAME_SIZE];
    rig s;
    (void)state;
    open_driven(&s, DMB_DRIVE_MOTION, 1, 0.02, 3.0, drives);
    must_model(&s, dmb_model_add_ramp(s.model, 0.0, 1.0, 0.0, 1.0, &ramp));
    const size_t size = record_of(s.model, before, sizeof before);
    rig_start(&s, NULL);
    assert_int_equal(record_of(s.model, after, sizeof after), size);
    assert_memory_equal(before, after, size);
    beyond = ramp;
    beyond.index++;
    assert_int_equal(dmb_model_get_name(s.model, ramp, name, sizeof name), DMB_OK);
    assert_int_equal(dmb_model_get_name(s.model, beyond, name, sizeof name), DMB_ERR_ID);
    take_divided_steps(&s, 1e-3, 20);
    rig_close(&s);
}

/* h0 before, h1 after, D^3 (10 - 15 D + 6 D^2) between. */
static void a_ramp_is_one_segment(void **state)
{
    rig s;
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_pipe_def pipe = s1_pipe();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    (void)add_pipes(&s, &pipe, 1);
    assert_int_equal(dmb_model_add_ramp(s.model, 0.0, 1.0, 2.0, 2.0, &drive.time_function), DMB_ERR_VALUE);
    assert_int_equal(dmb_model_add_ramp(NULL, 0.0, 1.0, 0.0, 1.0, &drive.time_function), DMB_ERR_NULL);
    must_model(&s, dmb_model_clear_refused(s.model));
    must_model(&s, dmb_model_add_ramp(s.model, 1.0, 5.0, 0.01, 0.05, &drive.time_function));
    drive.component = DMB_RX;
    const dmb_place at = dmb_station(add_drive(&s, &drive), 0, 0.0);
    rig_start(&s, NULL);
    double worst = 0.0;
    for (int k = 0; k <= 60; k++) {
        const double D = fmin(fmax((dmb_sim_time(s.sim) - 0.01) / 0.04, 0.0), 1.0);
        const double want = 1.0 + 4.0 * D * D * D * (10.0 - 15.0 * D + 6.0 * D * D);
        worst = fmax(worst, fabs(dmb_sim_value(s.sim, DMB_OUTPUT_DRIVE_SPEED, at) - want));
        take_steps(&s, 1e-3, 1);
    }
    check_below("speed off the ramp [rad/s]", worst, 1e-11);
    rig_close(&s);
}

static void one_number(void **state)
{
    rig s;
    dmb_id drives[2];
    double want;
    (void)state;
    open_driven(&s, DMB_DRIVE_MOTION, 1, 0.01, 2.0, drives);
    rig_start(&s, NULL);
    take_divided_steps(&s, 1e-3, 20);
    const dmb_output output = {dmb_station(drives[1], 0, 0.0), DMB_OUTPUT_DRIVE_FORCE, 0};
    must(&s, dmb_query_output(s.sim, &output, &want));
    const double got = dmb_sim_value(s.sim, output.quantity, output.place);
    assert_true(fabs(got) > 0.0 && memcmp(&got, &want, sizeof got) == 0);
    assert_true(isnan(dmb_sim_value(s.sim, 123456, output.place)));
    assert_non_null(strstr(dmb_sim_message(s.sim), "output"));
    dmb_error error = dmb_error_default();
    assert_int_equal(dmb_last_error(&error), DMB_OK);
    assert_int_equal(error.status, DMB_ERR_VALUE);
    assert_true(isnan(dmb_sim_value(NULL, output.quantity, output.place)));
    rig_close(&s);
}

static void ids_are_equal(void **state)
{
    (void)state;
    assert_true(dmb_id_equal((dmb_id){1, 2}, (dmb_id){1, 2}));
    assert_false(dmb_id_equal((dmb_id){1, 2}, (dmb_id){1, 3}));
    assert_false(dmb_id_equal((dmb_id){1, 2}, (dmb_id){2, 2}));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_value_is_a_constant_time_function),
        cmocka_unit_test(a_drive_holds),
        cmocka_unit_test(values_are_checked),
        cmocka_unit_test(a_failed_compile_leaves_no_constants),
        cmocka_unit_test(constants_are_not_described),
        cmocka_unit_test(a_ramp_is_one_segment),
        cmocka_unit_test(one_number),
        cmocka_unit_test(ids_are_equal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
