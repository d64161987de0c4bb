/* The caller's function of accepted steps: once for each, with the state that stays, in every call that steps; it may
 * ask and save the sim, not change it, and end the call. The bits of a run are those without it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"

typedef struct seen {
    uint32_t count, end_at; /* calls; number of the one that ends the call, 0: none */
    double last;            /* [s] */
    uint64_t hash;          /* of the state in the last call */
    dmb_sim *sim;
    int32_t change; /* status of a step that it tries */
} seen;

static int32_t see(void *context, const dmb_sim *sim)
{
    seen *s = context;
    assert_true(dmb_sim_time(sim) > s->last || s->count == 0);
    s->last = dmb_sim_time(sim);
    s->count++;
    assert_int_equal(dmb_sim_hash(sim, &s->hash), DMB_OK);
    if (s->sim != NULL) s->change = dmb_sim_step(s->sim, 1e-3, NULL);
    return s->count == s->end_at;
}

/* A ball that falls on the floor of a hole; an event when it touches, and another one 2 ms later. */
static rig open_ball(void)
{
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    const dmb_wall_def wall = s1_hole();
    (void)add_wall(&s, &wall);
    dmb_body_def ball = dmb_body_def_default();
    ball.contact_diameter = 0.05;
    ball.free_mask = DMB_FREE_Z;
    const dmb_id part = add_body(&s, &ball);
    dmb_event_def event = dmb_event_def_default();
    memcpy(event.name, "low", 4);
    event.output = (dmb_output){.place = dmb_station(part, 0, 0.0), .quantity = DMB_OUTPUT_POSITION_Z};
    event.level = -0.01;
    event.direction = DMB_EVENT_FALLING;
    must_model(&s, dmb_model_add_event(s.model, &event, NULL));
    memcpy(event.name, "held", 5);
    event.hold = 2e-3;
    must_model(&s, dmb_model_add_event(s.model, &event, NULL));
    (void)rig_start(&s, NULL);
    return s;
}

static void expect_seen(const rig *s, const seen *found, uint32_t count)
{
    assert_int_equal(found->count, count);
    assert_true(found->last == dmb_sim_time(s->sim));
    assert_true(found->hash == rig_hash(s));
}

static void each_step_once(void **state)
{
    (void)state;
    rig s = open_ball(), plain = open_ball();
    dmb_step_report report = dmb_step_report_default();
    seen found = {.count = 0};
    uint32_t done = 0;
    must(&s, dmb_sim_set_on_step(s.sim, see, &found));
    must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    must(&plain, dmb_sim_step(plain.sim, 1e-3, NULL));
    expect_seen(&s, &found, 1);
    must(&s, dmb_sim_steps(s.sim, 1e-3, 3, &done, NULL));
    must(&plain, dmb_sim_steps(plain.sim, 1e-3, 3, NULL, NULL));
    expect_seen(&s, &found, 4);
    found.count = 0;
    must(&s, dmb_sim_advance(s.sim, 0.02, &report));
    must(&plain, dmb_sim_advance(plain.sim, 0.02, NULL));
    expect_seen(&s, &found, report.steps);
    assert_int_equal(rig_hash(&s), rig_hash(&plain));
    rig_close(&s);
    rig_close(&plain);
}

/* Steps to find an event are taken back; those that stay are seen in order of time. */
static void each_step_to_an_event(void **state)
{
    (void)state;
    rig s = open_ball();
    seen found = {.count = 0};
    dmb_step_report report = dmb_step_report_default();
    dmb_event_report event = dmb_event_report_default();
    must(&s, dmb_sim_set_on_step(s.sim, see, &found));
    assert_int_equal(dmb_sim_advance_to_event(s.sim, 1.0, &event, &report), DMB_NOTE_EVENT);
    assert_true(report.rejected > 0);
    expect_seen(&s, &found, report.steps);
    check_close("height at the event", dmb_sim_time(s.sim), sqrt(2.0 * 0.01 / 9.81), 1e-4);
    found.count = 0;
    assert_int_equal(dmb_sim_advance_to_event(s.sim, 1.0, &event, &report), DMB_NOTE_EVENT);
    assert_int_equal(event.events, 2);
    expect_seen(&s, &found, report.steps);
    rig_close(&s);
}

static void it_ends_a_call(void **state)
{
    (void)state;
    rig s = open_ball();
    seen found = {.end_at = 2};
    uint32_t done = 0;
    dmb_step_report report = dmb_step_report_default();
    must(&s, dmb_sim_set_on_step(s.sim, see, &found));
    assert_int_equal(dmb_sim_steps(s.sim, 1e-3, 5, &done, &report), DMB_NOTE_STOPPED);
    assert_int_equal(done, 2);
    assert_int_equal(report.steps, 2);
    assert_non_null(strstr(dmb_sim_message(s.sim), "function of accepted steps"));
    expect_seen(&s, &found, 2);
    found.count = 0;
    assert_int_equal(dmb_sim_steps(s.sim, 1e-3, 2, &done, NULL), DMB_OK); /* at its end anyway */
    assert_int_equal(done, 2);
    found.count = 1;
    assert_int_equal(dmb_sim_step(s.sim, 1e-3, NULL), DMB_OK);
    found.count = 0;
    assert_int_equal(dmb_sim_advance(s.sim, 1.0, &report), DMB_NOTE_STOPPED);
    assert_int_equal(report.steps, 2);
    expect_seen(&s, &found, 2);
    found.count = 0;
    assert_int_equal(dmb_sim_advance_to_event(s.sim, 1.0, NULL, &report), DMB_NOTE_STOPPED);
    assert_non_null(strstr(dmb_sim_message(s.sim), "function of accepted steps"));
    expect_seen(&s, &found, 2);
    must(&s, dmb_sim_set_on_step(s.sim, NULL, NULL));
    must(&s, dmb_sim_steps(s.sim, 1e-3, 2, NULL, NULL));
    assert_int_equal(found.count, 2);
    rig_close(&s);
}

static void it_changes_nothing(void **state)
{
    (void)state;
    rig s = open_ball();
    seen found = {.sim = s.sim};
    must(&s, dmb_sim_set_on_step(s.sim, see, &found));
    must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    assert_int_equal(found.change, DMB_ERR_ORDER);
    expect_seen(&s, &found, 1);
    assert_int_equal(dmb_sim_set_on_step(NULL, see, &found), DMB_ERR_NULL);
    found.count = 0;
    assert_true(dmb_sim_step(s.sim, -1.0, NULL) < 0); /* no step, no call */
    assert_int_equal(found.count, 0);
    rig_close(&s);
}

/* A given place is that of the row and column. */
static void places_of_a_tangent(void **state)
{
    (void)state;
    assert_int_equal(dmb_tangent_index(1, 0, 0, 0, 0, 0), 0);
    assert_int_equal(dmb_tangent_index(1, 0, 0, 2, 0, 3), 15);
    assert_int_equal(dmb_tangent_index(1, 1, 0, 0, 0, 0), 36);
    assert_int_equal(dmb_tangent_index(2, 0, 1, 2, 1, 5), 12 * 8 + 11);
    assert_int_equal(dmb_tangent_index(2, 1, 1, 5, 1, 5), 287);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_step_once),     cmocka_unit_test(each_step_to_an_event), cmocka_unit_test(it_ends_a_call),
        cmocka_unit_test(it_changes_nothing), cmocka_unit_test(places_of_a_tangent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
