/* Events in runs of equal steps (dmb_sim_steps_to_event; chapter Events of lib/theory/integration.md) against closed
 * forms: order and bound of the time of a crossing, from both sides; holds that end within a step; crossings that are
 * missed; and against dmb_sim_steps and dmb_sim_advance_to_event on the same scene. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mechanism.h"

#define OMEGA 7.0

/* A body of 2 kg that moves along x under a force of 2 N sin(OMEGA t + phase), or a constant one. */
static dmb_id force, mass; /* the drive and the body of the last scene */

static rig driven_body(double phase, double constant)
{
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_body_def body = dmb_body_def_default();
    dmb_segment term = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    body.free_mask = DMB_FREE_X;
    body.mass = 2.0;
    drive.part = mass = add_body(&s, &body);
    drive.kind = DMB_DRIVE_LOAD;
    term.kind = DMB_SEGMENT_HARMONIC;
    term.h0 = constant;
    term.h1 = constant != 0.0 ? 0.0 : 2.0;
    term.omega = OMEGA;
    term.phase = phase;
    must_model(&s, dmb_model_add_time_function(s.model, &term, 1, &drive.time_function));
    must_model(&s, dmb_model_add_drive(s.model, &drive, &force));
    return s;
}

static void add_event(rig *s, int32_t quantity, dmb_id part, int32_t direction, double level, double hold)
{
    static uint32_t number;
    dmb_event_def def = dmb_event_def_default();
    snprintf(def.name, sizeof def.name, "event %u", (unsigned)number++);
    def.direction = direction;
    def.output = (dmb_output){.quantity = quantity, .place = dmb_station(part, 0, 0.0)};
    def.level = level;
    def.hold = hold;
    must_model(s, dmb_model_add_event(s->model, &def, NULL));
}

static dmb_event_report next(const rig *s, double h, uint32_t count)
{
    dmb_event_report report = dmb_event_report_default();
    const int32_t status = dmb_sim_steps_to_event(s->sim, h, count, NULL, &report, NULL);
    if (status < 0) fail_msg("%s", dmb_sim_message(s->sim));
    assert_int_equal(status, report.events != 0 ? DMB_NOTE_EVENT : DMB_OK);
    assert_true(report.time == dmb_sim_time(s->sim));
    assert_int_equal(isnan(report.crossing), report.events == 0);
    if (report.events != 0) assert_true(report.crossing <= report.time);
    return report;
}

/* 2 sin(OMEGA t + phase) through 1.2, where its rate is 0.8 of the largest: the error of the time is at most 0.0642 h^3
 * over the rate times the largest third derivative, and of order 3. */
static void third_order_from_both_sides(void **state)
{
    static const int32_t direction[3] = {DMB_EVENT_RISING, DMB_EVENT_FALLING, DMB_EVENT_EITHER};
    (void)state;
    for (int d = 0; d < 3; d++) {
        const int rises = direction[d] != DMB_EVENT_FALLING;
        const double angle = asin(0.6), want = (rises ? 2.0 * PI + angle : PI - angle) / OMEGA;
        double sum[3] = {0.0, 0.0, 0.0};
        for (int n = 0; n < 3; n++)
            for (int k = 0; k < 16; k++) { /* at all places within a step */
                const double h = 0.04 / (1 << n), phase = k * OMEGA * h / 16.0 + (rises ? 1.0 : 0.0);
                rig s = driven_body(phase, 0.0);
                add_event(&s, DMB_OUTPUT_DRIVE_TARGET, force, direction[d], 1.2, 0.0);
                (void)rig_start(&s, NULL);
                dmb_event_report report = next(&s, h, 1000);
                if (direction[d] == DMB_EVENT_EITHER) report = next(&s, h, 1000); /* the first is the way down */
                const double error = fabs(report.crossing - (want - phase / OMEGA));
                assert_true(error <= 0.0642 * h * h * h * OMEGA * OMEGA / 0.8 * (1.0 + OMEGA * h));
                assert_true(report.time - report.crossing <= report.located && report.located < 1.001 * h);
                sum[n] += error;
                rig_close(&s);
            }
        check_order("time of a crossing in equal steps", sum[1], sum[2], 3.0, 0.2);
    }
}

/* x = t^2/4 meets 0.3 at sqrt(1.2): the steps and the parabola are exact. In the first step of a run a chord is taken,
 * exact for a speed that grows in proportion to time. */
static void a_parabola_is_met(void **state)
{
    (void)state;
    rig s = driven_body(0.0, 1.0);
    add_event(&s, DMB_OUTPUT_DISPLACEMENT_X, mass, DMB_EVENT_RISING, 0.3, 0.0);
    add_event(&s, DMB_OUTPUT_VELOCITY_X, mass, DMB_EVENT_RISING, 0.0125, 0.0);
    add_event(&s, DMB_OUTPUT_DISPLACEMENT_X, mass, DMB_EVENT_RISING, 0.3001, 0.05);
    (void)rig_start(&s, NULL);
    dmb_event_report report = next(&s, 0.1, 100);
    assert_int_equal(report.events, 2);
    check_close("chord of the first step", report.crossing, 0.025, 1e-13);
    assert_true(report.time == 0.1);
    report = next(&s, 0.1, 100);
    assert_int_equal(report.events, 1);
    check_close("parabola", report.crossing, sqrt(1.2), 1e-12);
    report = next(&s, 0.1, 100); /* held 0.05 s within the next step */
    assert_int_equal(report.events, 4);
    check_close("crossing before a hold", report.crossing, sqrt(4.0 * 0.3001), 1e-12);
    rig_close(&s);
}

/* A hold that ends before the output returns, both within a step, is met; one that ends after it is not. */
static void holds_end_within_a_step(void **state)
{
    (void)state;
    for (int longer = 0; longer < 2; longer++) {
        rig s = driven_body(0.0, 0.0);
        const double beyond = (PI - 2.0 * asin(0.9)) / OMEGA; /* above 1.8 */
        add_event(&s, DMB_OUTPUT_DRIVE_TARGET, force, DMB_EVENT_RISING, 1.8, beyond * (longer ? 1.1 : 0.9));
        (void)rig_start(&s, NULL);
        const dmb_event_report report = next(&s, 0.019, 40); /* 0.209 s .. 0.228 s; it returns at 0.289 s */
        assert_int_equal(report.events, longer ? 0 : 1);
        if (!longer) check_close("crossing of a hold", report.crossing, asin(0.9) / OMEGA, 1e-4);
        rig_close(&s);
    }
}

static rig start_to_and_fro(void)
{
    rig s = driven_body(0.3, 0.0);
    add_event(&s, DMB_OUTPUT_VELOCITY_X, mass, DMB_EVENT_EITHER, 0.1, 0.0);
    (void)rig_start(&s, NULL);
    return s;
}

/* The steps are those of dmb_sim_steps, bit for bit, and a restored sim finds the same time; of steps with error
 * control the crossing is the end of a step, up to the error of either. */
static void agrees_with_the_other_calls(void **state)
{
    double x[2];
    (void)state;
    rig s = start_to_and_fro();
    const dmb_id part = mass;
    rig plain = start_to_and_fro();
    uint32_t done = 0;
    dmb_event_report first = dmb_event_report_default(), again = first, other = first;
    assert_int_equal(dmb_sim_steps_to_event(s.sim, 5e-3, 7, &done, &first, NULL), DMB_OK);
    assert_int_equal(done, 7);
    size_t size = 0;
    must(&s, dmb_sim_snapshot_size(s.sim, &size));
    void *saved = malloc(size);
    must(&s, dmb_sim_snapshot(s.sim, saved, size));
    assert_int_equal(dmb_sim_steps_to_event(s.sim, 5e-3, 1000, &done, &first, NULL), DMB_NOTE_EVENT);
    assert_non_null(strstr(dmb_sim_message(s.sim), "by event"));
    must(&plain, dmb_sim_steps(plain.sim, 5e-3, 7 + done, NULL, NULL));
    x[0] = dmb_sim_value(s.sim, DMB_OUTPUT_DISPLACEMENT_X, dmb_station(part, 0, 0.0));
    x[1] = dmb_sim_value(plain.sim, DMB_OUTPUT_DISPLACEMENT_X, dmb_station(mass, 0, 0.0));
    assert_memory_equal(x, x + 1, sizeof *x);
    must(&s, dmb_sim_restore(s.sim, saved, size));
    assert_int_equal(dmb_sim_steps_to_event(s.sim, 5e-3, 1000, NULL, &again, NULL), DMB_NOTE_EVENT);
    assert_memory_equal(&first, &again, sizeof first);
    must(&s, dmb_sim_restore(s.sim, saved, size));
    assert_int_equal(dmb_sim_advance_to_event(s.sim, 10.0, &other, NULL), DMB_NOTE_EVENT);
    assert_true(other.crossing == other.time && other.events == first.events);
    check_close("crossing of both calls", first.crossing, other.crossing, 2.0 * 5e-3 * 5e-3);
    free(saved);
    rig_close(&s);
    rig_close(&plain);
}

/* The speed (cos 0.3 - cos(OMEGA t + 0.3))/OMEGA passes 0.1 with the error of the steps, h^2. */
static void the_motion_is_of_second_order(void **state)
{
    double error[2];
    (void)state;
    for (int n = 0; n < 2; n++) {
        rig s = start_to_and_fro();
        error[n] = fabs(next(&s, n ? 1e-3 : 2e-3, 1000).crossing - (acos(cos(0.3) - 0.1 * OMEGA) - 0.3) / OMEGA);
        rig_close(&s);
    }
    check_order("time of a crossing of the motion", error[0], error[1], 2.0, 0.2);
}

/* Crossing and return within one step; structs and lengths that are none; no events. */
static void what_is_missed_and_refused(void **state)
{
    (void)state;
    rig s = driven_body(0.0, 0.0);
    dmb_event_report report = dmb_event_report_default();
    add_event(&s, DMB_OUTPUT_DRIVE_TARGET, force, DMB_EVENT_RISING, 1.8, 0.0); /* 0.160 s .. 0.289 s */
    (void)rig_start(&s, NULL);
    assert_int_equal(next(&s, 0.15, 2).events, 0);
    assert_true(dmb_sim_steps_to_event(s.sim, -1.0, 1, NULL, &report, NULL) < 0);
    assert_int_equal(dmb_sim_steps_to_event(NULL, 1.0, 1, NULL, &report, NULL), DMB_ERR_NULL);
    report.struct_size = 3;
    assert_int_equal(dmb_sim_steps_to_event(s.sim, 0.1, 1, NULL, &report, NULL), DMB_ERR_STRUCT_SIZE);
    rig_close(&s);
    s = driven_body(0.0, 0.0);
    (void)rig_start(&s, NULL);
    assert_int_equal(dmb_sim_steps_to_event(s.sim, 0.1, 1, NULL, NULL, NULL), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "steps to event"));
    rig_close(&s);
}

static int32_t fails(void *context, double time, uint32_t place_count, const double (*poses)[12],
                     const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                     const dmb_law_memory *memory)
{
    (void)time, (void)place_count, (void)poses, (void)velocities, (void)forces, (void)tangent, (void)potential;
    (void)memory;
    return *(const int *)context;
}

/* Neither wrong arguments nor a first step that fails change the sim, of which no call has looked at the events yet. */
static void failing_calls_change_nothing(void **state)
{
    int fail = 0;
    dmb_event_report report = dmb_event_report_default();
    dmb_step_report short_report = dmb_step_report_default();
    (void)state;
    rig s = driven_body(0.3, 0.0);
    dmb_force_def def = dmb_force_def_default();
    def.place_count = 1;
    def.place[0] = dmb_station(mass, 0, 0.0);
    def.callback = fails;
    def.callback_context = &fail;
    must_model(&s, dmb_model_add_force(s.model, &def, NULL));
    add_event(&s, DMB_OUTPUT_VELOCITY_X, mass, DMB_EVENT_EITHER, 0.1, 0.0);
    add_event(&s, DMB_OUTPUT_VELOCITY_X, mass, DMB_EVENT_FALLING, 0.1, 0.1);
    (void)rig_start(&s, NULL);
    const uint64_t before = rig_hash(&s);
    short_report.struct_size = 3;
    assert_int_equal(dmb_sim_steps_to_event(s.sim, -1.0, 1, NULL, &report, NULL), DMB_ERR_VALUE);
    assert_int_equal(dmb_sim_steps_to_event(s.sim, 1e19, 1, NULL, &report, NULL), DMB_ERR_VALUE);
    assert_int_equal(dmb_sim_steps_to_event(s.sim, (double)NAN, 1, NULL, &report, NULL), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_sim_steps_to_event(s.sim, 1e-3, 1, NULL, &report, &short_report), DMB_ERR_STRUCT_SIZE);
    fail = 1;
    assert_int_equal(dmb_sim_steps_to_event(s.sim, 1e-3, 1, NULL, &report, NULL), DMB_ERR_CALLBACK);
    assert_true(rig_hash(&s) == before && report.count == 0 && isnan(report.crossing));
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(third_order_from_both_sides),   cmocka_unit_test(a_parabola_is_met),
        cmocka_unit_test(holds_end_within_a_step),       cmocka_unit_test(agrees_with_the_other_calls),
        cmocka_unit_test(the_motion_is_of_second_order), cmocka_unit_test(what_is_missed_and_refused),
        cmocka_unit_test(failing_calls_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
