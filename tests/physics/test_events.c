/* Events against closed forms: a body that falls onto the wall, an oscillator through zero, the torque of a controller,
 * a rotor that stands still for a time; the first of several, those at once, starts on and beyond a level, the end. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drillmbd/drillmbd.h"
#include "hash.h"

#define must(call) assert_int_equal((call), DMB_OK)
#define PI 3.14159265358979323846

typedef struct scene {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id body;
} scene;

/* A body of 2 kg and 0.5 kg m2 that moves in one component, with the time function as a drive on it. */
static dmb_id body_with(scene *s, int32_t component, const dmb_drive_def *drive, const dmb_segment *term)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_id id = {0, 0};
    if (s->model == NULL) must(dmb_model_create(NULL, &s->model));
    body.free_mask = DMB_FREE_X << component;
    body.mass = 2.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.5;
    must(dmb_model_add_body(s->model, &body, &s->body));
    if (drive == NULL) return id;
    dmb_drive_def def = *drive;
    def.part = s->body;
    def.component = component;
    must(dmb_model_add_time_function(s->model, term, 1, &def.time_function));
    must(dmb_model_add_drive(s->model, &def, &id));
    return id;
}

static void event(scene *s, const char *name, int32_t quantity, dmb_id part, int32_t direction, double level,
                  double hold)
{
    dmb_event_def def = dmb_event_def_default();
    snprintf(def.name, sizeof def.name, "%s", name);
    def.direction = direction;
    def.output.quantity = quantity;
    def.output.place = dmb_station(part, 0, 0.0);
    def.level = level;
    def.hold = hold;
    must(dmb_model_add_event(s->model, &def, NULL));
}

static void start(scene *s, double tolerance)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.tolerance_translation = options.tolerance_rotation = tolerance;
    must(dmb_model_compile(s->model, NULL));
    const int32_t status = dmb_sim_create(s->model, &options, &s->sim);
    if (status < 0) fail_msg("%s", dmb_model_message(s->model));
}

static void end(scene *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

/* The next event before `time`; 0 if there is none. */
static uint64_t next(scene *s, double time)
{
    dmb_event_report report = dmb_event_report_default();
    const int32_t status = dmb_sim_advance_to_event(s->sim, time, &report, NULL);
    if (status < 0) fail_msg("%d %s", (int)status, dmb_sim_message(s->sim));
    assert_int_equal(status == DMB_NOTE_EVENT, report.events != 0);
    assert_true(report.time == dmb_sim_time(s->sim));
    if (report.events == 0) assert_true(report.time == time);
    return report.events;
}

static double now(const scene *s)
{
    return dmb_sim_time(s->sim);
}

static void close_to(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance)) fail_msg("%.15g, wanted %.15g within %g", value, wanted, tolerance);
}

/* Free fall through the clearance c: sqrt(2 c/g), by the gap of the ring and by its force, which is 0 up to there. */
static void falls_onto_wall(void **state)
{
    (void)state;
    scene s = {0};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_model *model = NULL;
    must(dmb_model_create(NULL, &model));
    s.model = model;
    must(dmb_model_add_wall(model, &wall, NULL));
    body.contact_diameter = 0.074;
    body.position[0] = 1.0;
    body.free_mask = DMB_FREE_ALL;
    must(dmb_model_add_body(model, &body, &s.body));
    event(&s, "touches", DMB_OUTPUT_CONTACT_GAP, (dmb_id){0, 0}, DMB_EVENT_FALLING, 0.0, 0.0);
    event(&s, "is pressed", DMB_OUTPUT_NORMAL_FORCE, s.body, DMB_EVENT_RISING, 0.0, 0.0);
    event(&s, "leaves", DMB_OUTPUT_CONTACT_GAP, (dmb_id){0, 0}, DMB_EVENT_RISING, 0.0, 0.0);
    start(&s, 1e-8);
    const double time = sqrt(2.0 * 0.01 / 9.81);
    assert_int_equal(next(&s, 1.0), 3);
    close_to(now(&s), time, 2e-9);
    assert_non_null(strstr(dmb_sim_message(s.sim), "touches, is pressed"));
    assert_int_equal(next(&s, 1.0), 4); /* and bounces */
    assert_true(now(&s) > time + 1e-4 && now(&s) < time + 0.1);
    end(&s);
}

/* x = cos(w t), seen from both sides, each time. */
static void oscillator_through_zero(void **state)
{
    (void)state;
    scene s = {0};
    dmb_joint_def spring = dmb_joint_def_default();
    (void)body_with(&s, DMB_X, NULL, NULL);
    dmb_body_def body = dmb_body_def_default();
    body.mass = 2.0;
    must(dmb_model_add_body(s.model, &body, &s.body));
    spring.kind = DMB_JOINT_PRISMATIC;
    spring.place_b = dmb_station(s.body, 0, 0.0);
    spring.stiffness[0] = 2.0 * 49.0; /* w = 7 rad/s */
    spring.initial_mask = DMB_FREE_X;
    spring.initial_position[0] = 1.0;
    dmb_id joint;
    must(dmb_model_add_joint(s.model, &spring, &joint));
    dmb_environment_def still = dmb_environment_def_default();
    still.gravity[2] = 0.0;
    must(dmb_model_set_environment(s.model, &still));
    event(&s, "zero", DMB_OUTPUT_JOINT_POSITION, joint, DMB_EVENT_EITHER, 0.0, 0.0);
    event(&s, "turns", DMB_OUTPUT_JOINT_SPEED, joint, DMB_EVENT_RISING, 0.0, 0.0);
    start(&s, 1e-9);
    for (int k = 0; k < 6; k++) {
        dmb_joint_state at = dmb_joint_state_default();
        assert_int_equal(next(&s, 10.0), k % 3 == 1 ? 2 : 1);
        close_to(now(&s),
                 (k < 3 ? (const double[]){0.5, 1.0, 1.5}[k] : (const double[]){2.5, 3.0, 3.5}[k - 3]) * PI / 7.0,
                 3e-5);
        must(dmb_query_joint(s.sim, joint, &at));
        close_to(k % 3 == 1 ? at.speed[0] / 49.0 : at.position[0] / 7.0, 0.0, 1.1e-9); /* on the event */
    }
    end(&s);
}

/* J v' = kp (r t - v): the torque is J r (1 - exp(-kp t/J)) and reaches L at -J/kp ln(1 - L/(J r)). */
static void torque_of_controller(void **state)
{
    (void)state;
    scene s = {0};
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment ramp = dmb_segment_default();
    const double time[] = {0.0, 100.0}, value[] = {0.0, 400.0};
    drive.kind = DMB_DRIVE_CONTROL;
    drive.gain = 1.5;
    ramp.kind = DMB_SEGMENT_TABLE;
    ramp.table_time = time;
    ramp.table_value = value;
    ramp.table_count = 2;
    const dmb_id id = body_with(&s, DMB_RX, &drive, &ramp);
    event(&s, "limit", DMB_OUTPUT_DRIVE_FORCE, id, DMB_EVENT_RISING, 1.2, 0.0);
    start(&s, 1e-9);
    assert_int_equal(next(&s, 10.0), 1);
    close_to(now(&s), -0.5 / 1.5 * log(1.0 - 1.2 / (0.5 * 4.0)), 1e-6);
    assert_int_equal(next(&s, 3.0), 0); /* it stays above */
    end(&s);
}

/* v = 3 - 2 t until 1.3 s, up again until 1.7 s, down again: below 0.5 rad/s at 1.25 s for too short a time, then from
 * the second crossing on for 0.6 s. */
static void stands_still(void **state)
{
    (void)state;
    scene s = {0};
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment torque = dmb_segment_default();
    const double time[] = {0.0, 1.3, 1.3 + 1e-9, 1.7, 1.7 + 1e-9, 5.0}, value[] = {-1.0, -1.0, 1.0, 1.0, -1.0, -1.0};
    drive.kind = DMB_DRIVE_LOAD;
    torque.kind = DMB_SEGMENT_TABLE;
    torque.table_time = time;
    torque.table_value = value;
    torque.table_count = 6;
    must(dmb_model_create(NULL, &s.model));
    (void)body_with(&s, DMB_RX, &drive, &torque);
    event(&s, "stuck", DMB_OUTPUT_SPIN, s.body, DMB_EVENT_FALLING, -2.5, 0.6);
    event(&s, "slow", DMB_OUTPUT_SPIN, s.body, DMB_EVENT_FALLING, -2.5, 0.0);
    start(&s, 1e-9);
    /* from rest: v = -2 t; below -2.5 at 1.25; at 1.3 -2.6, up to -2.5 at 1.35 and -1.8 at 1.7; -2.5 again at 2.05 */
    assert_int_equal(next(&s, 5.0), 2);
    close_to(now(&s), 1.25, 1e-7);
    assert_int_equal(next(&s, 5.0), 2);
    close_to(now(&s), 2.05, 1e-7);
    const double held = now(&s);
    size_t size;
    must(dmb_sim_snapshot_size(s.sim, &size));
    void *block = malloc(size);
    must(dmb_sim_snapshot(s.sim, block, size));
    assert_int_equal(next(&s, 5.0), 1);
    close_to(now(&s), held + 0.6, 1e-12);
    const uint64_t hash = hash_of(s.sim);
    assert_int_equal(next(&s, 4.0), 0);        /* told once */
    must(dmb_sim_restore(s.sim, block, size)); /* in the middle of the hold */
    assert_int_equal(next(&s, 2.3), 0);
    must(dmb_sim_restore(s.sim, block, size));
    assert_int_equal(next(&s, 5.0), 1);
    assert_int_equal(hash_of(s.sim), hash);
    free(block);
    end(&s);
}

/* x = 0.5 t: levels that are crossed in one step, in their order; those at once together; a start on a level, beyond
 * one, an end on one. */
static void in_order(void **state)
{
    (void)state;
    scene s = {0};
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment speed = dmb_segment_default();
    speed.h0 = 0.5;
    (void)body_with(&s, DMB_X, &drive, &speed);
    event(&s, "far", DMB_OUTPUT_DISPLACEMENT_X, s.body, DMB_EVENT_RISING, 0.02, 0.0);
    event(&s, "near", DMB_OUTPUT_DISPLACEMENT_X, s.body, DMB_EVENT_RISING, 0.01, 0.0);
    event(&s, "also near", DMB_OUTPUT_DISPLACEMENT_X, s.body, DMB_EVENT_EITHER, 0.01, 0.0);
    event(&s, "start", DMB_OUTPUT_DISPLACEMENT_X, s.body, DMB_EVENT_EITHER, 0.0, 0.0);
    event(&s, "behind", DMB_OUTPUT_DISPLACEMENT_X, s.body, DMB_EVENT_RISING, -1.0, 0.0);
    event(&s, "end", DMB_OUTPUT_DISPLACEMENT_X, s.body, DMB_EVENT_RISING, 0.25, 0.0);
    start(&s, 1e-3);
    assert_int_equal(next(&s, 0.5), 6);
    close_to(now(&s), 0.02, 1e-9);
    assert_int_equal(next(&s, 0.5), 1);
    close_to(now(&s), 0.04, 1e-9);
    uint64_t told = next(&s, 0.5), more = next(&s, 1.0); /* at the end by rounding, or just behind */
    assert_int_equal(told | more, 32);
    if (told == 0) close_to(now(&s), 0.5, 1e-9);
    if (told != 0) assert_int_equal(more, 0);
    assert_int_equal(next(&s, 2.0), 0);
    end(&s);
}

/* Steps of dmb_sim_step pay for no events and remember none. Calls that fail change nothing. */
static void refused(void **state)
{
    (void)state;
    scene s = {0}, t = {0};
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment speed = dmb_segment_default();
    speed.h0 = 0.5;
    (void)body_with(&s, DMB_X, &drive, &speed);
    dmb_event_def def = dmb_event_def_default();
    const double bad[] = {(double)NAN, (double)INFINITY, -1.0, 1e300};
    snprintf(def.name, sizeof def.name, "x");
    def.output.place.part = s.body;
    for (int k = 0; k < 4; k++) {
        dmb_event_def one = def;
        one.hold = bad[k];
        assert_true(dmb_model_add_event(s.model, &one, NULL) < 0);
        one = def, one.tolerance = bad[k];
        assert_true(dmb_model_add_event(s.model, &one, NULL) < 0);
        one = def, one.level = bad[k];
        if (k != 2) assert_true(dmb_model_add_event(s.model, &one, NULL) < 0);
    }
    def.direction = 3;
    assert_int_equal(dmb_model_add_event(s.model, &def, NULL), DMB_ERR_VALUE);
    def.direction = DMB_EVENT_EITHER, def.hold = 1.0;
    assert_int_equal(dmb_model_add_event(s.model, &def, NULL), DMB_ERR_VALUE);
    def.hold = 0.0, def.name[0] = '\0';
    assert_int_equal(dmb_model_add_event(s.model, &def, NULL), DMB_ERR_VALUE);
    must(dmb_model_clear_refused(s.model));
    for (int k = 0; k < 64; k++) {
        snprintf(def.name, sizeof def.name, "event %d", k);
        def.level = 0.1 + k;
        must(dmb_model_add_event(s.model, &def, NULL));
        assert_int_equal(dmb_model_add_event(s.model, &def, NULL), DMB_ERR_VALUE);
        must(dmb_model_clear_refused(s.model));
    }
    snprintf(def.name, sizeof def.name, "one too many");
    assert_int_equal(dmb_model_add_event(s.model, &def, NULL), DMB_ERR_TOO_LARGE);
    must(dmb_model_clear_refused(s.model));
    dmb_id found;
    dmb_event_def info = dmb_event_def_default();
    must(dmb_model_find_event(s.model, "event 7", &found));
    must(dmb_model_get_event(s.model, 7, &info));
    assert_true((found.index & 0xffffff) == 7 && info.level == 7.1 && strcmp(info.name, "event 7") == 0);
    assert_int_equal(dmb_model_get_event(s.model, 64, &info), DMB_ERR_ID);
    assert_int_equal(dmb_model_event_count(s.model), 64);
    start(&s, 1e-6);
    const uint64_t before = hash_of(s.sim);
    for (int k = 0; k < 3; k++) assert_true(dmb_sim_advance_to_event(s.sim, bad[k], NULL, NULL) < 0);
    assert_int_equal(hash_of(s.sim), before);
    must(dmb_sim_step(s.sim, 0.5, NULL)); /* over the first level */
    assert_int_equal(next(&s, 1.0), 0);
    end(&s);

    (void)body_with(&t, DMB_X, &drive, &speed);
    must(dmb_model_compile(t.model, NULL));
    assert_true(dmb_sim_create(t.model, NULL, &t.sim) >= 0);
    assert_int_equal(dmb_sim_advance_to_event(t.sim, 1.0, NULL, NULL), DMB_ERR_VALUE);
    end(&t);
    (void)body_with(&t, DMB_X, &drive, &speed);
    event(&t, "none", DMB_OUTPUT_BIT_WEIGHT, t.body, DMB_EVENT_RISING, 0.0, 0.0);
    must(dmb_model_compile(t.model, NULL));
    assert_int_equal(dmb_sim_create(t.model, NULL, &t.sim), DMB_ERR_ID);
    assert_non_null(strstr(dmb_model_message(t.model), "none"));
    assert_null(t.sim);
    end(&t);
}

/* A force that its caller refuses to tell for times before the latest one, as on a step that is taken back. */
typedef struct recorded_force {
    double latest; /* [s] */
    double end;    /* [s] of the record; 0: none */
    int32_t replays;
} recorded_force;

static int32_t force_of_record(void *context, double time, double out[3])
{
    recorded_force *record = context;
    if (time < record->latest && !record->replays) return -1;
    if (record->end > 0.0 && time > record->end) return -1;
    record->latest = fmax(record->latest, time);
    out[0] = 4.0, out[1] = 0.0, out[2] = 4.0 * time;
    return 0;
}

/* Where the crossing is looked for and the time function fails, the state is that before the step, from which another
 * call finds the event: v = F t/m reaches 1 m/s at m/F. */
static void a_location_that_fails(void **state)
{
    (void)state;
    scene s = {0};
    recorded_force record = {0};
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment force = dmb_segment_default();
    dmb_event_report report = dmb_event_report_default();
    dmb_step_report work = dmb_step_report_default();
    drive.kind = DMB_DRIVE_LOAD;
    force.kind = DMB_SEGMENT_CALLBACK;
    force.callback = force_of_record;
    force.callback_context = &record;
    force.provides = DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL;
    (void)body_with(&s, DMB_X, &drive, &force);
    event(&s, "speed", DMB_OUTPUT_VELOCITY_X, s.body, DMB_EVENT_RISING, 1.0, 0.0);
    start(&s, 1e-9);
    record.end = 0.2;
    record.replays = 1;
    assert_int_equal(dmb_sim_advance_to_event(s.sim, 3.0, &report, &work), DMB_ERR_CALLBACK);
    assert_true(now(&s) <= 0.2);
    record = (recorded_force){0};
    assert_int_equal(dmb_sim_advance_to_event(s.sim, 3.0, &report, &work), DMB_ERR_CALLBACK);
    const double before = now(&s);
    assert_true(before < 0.5 && work.rejected >= 1);
    dmb_motion motion = dmb_motion_default();
    must(dmb_query_motion(s.sim, dmb_station(s.body, 0, 0.0), &motion));
    close_to(motion.velocity[0], 2.0 * before, 1e-12);
    record.replays = 1;
    assert_int_equal(next(&s, 3.0), 1);
    close_to(now(&s), 0.5, 1e-9);
    end(&s);
}

/* A call whose first step fails changes nothing, where outputs begin beyond their levels and on either side of them. */
static void a_first_step_that_fails(void **state)
{
    (void)state;
    scene s = {0};
    recorded_force record = {.replays = 1, .end = 10.0};
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment force = dmb_segment_default();
    drive.kind = DMB_DRIVE_LOAD;
    force.kind = DMB_SEGMENT_CALLBACK;
    force.callback = force_of_record;
    force.callback_context = &record;
    force.provides = DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL;
    (void)body_with(&s, DMB_X, &drive, &force);
    event(&s, "beyond", DMB_OUTPUT_VELOCITY_X, s.body, DMB_EVENT_RISING, -1.0, 0.0);
    event(&s, "held", DMB_OUTPUT_VELOCITY_X, s.body, DMB_EVENT_FALLING, 1.0, 5.0);
    event(&s, "either", DMB_OUTPUT_VELOCITY_X, s.body, DMB_EVENT_EITHER, 0.5, 0.0);
    start(&s, 1e-9);
    for (int moved = 0; moved < 2; moved++) { /* before any call, and after one that has noted the sides */
        const uint64_t before = hash_of(s.sim);
        const double time = now(&s);
        record.end = fmax(time, 1e-12);
        assert_int_equal(dmb_sim_advance_to_event(s.sim, time + 3.0, NULL, NULL), DMB_ERR_CALLBACK);
        assert_true(now(&s) == time);
        assert_int_equal(hash_of(s.sim), before);
        assert_int_equal(dmb_sim_steps_to_event(s.sim, 0.1, 3, NULL, NULL, NULL), DMB_ERR_CALLBACK);
        assert_int_equal(hash_of(s.sim), before);
        record.end = 10.0;
        assert_int_equal(next(&s, time + 0.1), 0);
        must(dmb_sim_step(s.sim, 0.3, NULL)); /* to other sides, which the next call notes */
    }
    end(&s);
}

/* A count of contacts that comes down to its level has not crossed it; and structs that are none. */
static void down_to_the_level(void **state)
{
    (void)state;
    scene s = {0};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_event_report event_report = dmb_event_report_default();
    dmb_step_report report = dmb_step_report_default();
    must(dmb_model_create(NULL, &s.model));
    must(dmb_model_add_wall(s.model, &wall, NULL));
    body.contact_diameter = 0.074;
    body.position[0] = 1.0;
    body.position[2] = -0.00999;
    body.velocity[2] = -0.5;
    must(dmb_model_add_body(s.model, &body, &s.body));
    event(&s, "touches", DMB_OUTPUT_CONTACTS_CLOSED, (dmb_id){0, 0}, DMB_EVENT_EITHER, 0.0, 0.0);
    event(&s, "gap", DMB_OUTPUT_CONTACT_GAP, (dmb_id){0, 0}, DMB_EVENT_RISING, 1e-3, 0.0);
    start(&s, 1e-8);
    event_report.struct_size = report.struct_size = 3;
    const uint64_t before = hash_of(s.sim);
    assert_int_equal(dmb_sim_advance_to_event(s.sim, 1.0, &event_report, NULL), DMB_ERR_STRUCT_SIZE);
    assert_int_equal(dmb_sim_advance_to_event(s.sim, 1.0, NULL, &report), DMB_ERR_STRUCT_SIZE);
    assert_int_equal(hash_of(s.sim), before);
    dmb_contact_total contacts = dmb_contact_total_default();
    for (uint64_t told = 0; !(told & 2);) {
        told = next(&s, 1.0);
        if (told == 0) fail_msg("the body does not come back");
        must(dmb_query_contact_total(s.sim, &contacts));
        assert_int_equal(contacts.closed, told & 1); /* told where it closes, not where it opens */
    }
    end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(falls_onto_wall),
        cmocka_unit_test(oscillator_through_zero),
        cmocka_unit_test(torque_of_controller),
        cmocka_unit_test(stands_still),
        cmocka_unit_test(in_order),
        cmocka_unit_test(refused),
        cmocka_unit_test(a_location_that_fails),
        cmocka_unit_test(a_first_step_that_fails),
        cmocka_unit_test(down_to_the_level),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
