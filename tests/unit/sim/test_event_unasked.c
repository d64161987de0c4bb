/* An output of an event that cannot be asked any more: the call fails, and the step after which that shows is accepted
 * and seen by the caller's function of accepted steps. Its quantity is broken here within a step. */
#include <string.h>

#include "rig.h"

#include "model/scene.h"
#include "sim/sim.h"

typedef struct seen {
    dmb_sim *sim;
    double from, last; /* [s] start of the step in which the output breaks; time of the last call */
} seen;

static int32_t see(void *context, const dmb_sim *sim)
{
    ((seen *)context)->last = dmb_sim_time(sim);
    return 0;
}

static int32_t break_output(void *context, double fraction)
{
    const seen *s = context;
    (void)fraction;
    if (dmb_sim_time(s->sim) >= s->from) s->sim->model->scene->events[0].output.quantity = -1;
    return 0;
}

static void an_accepted_step_is_seen(void **state)
{
    (void)state;
    for (int equal = 0; equal < 2; equal++) {
        rig s;
        rig_open(&s, 0.0, 0.0, -9.81);
        dmb_body_def body = dmb_body_def_default();
        dmb_event_def event = dmb_event_def_default();
        event.output =
            (dmb_output){.place = dmb_station(add_body(&s, &body), 0, 0.0), .quantity = DMB_OUTPUT_POSITION_Z};
        event.level = 1.0;
        memcpy(event.name, "up", 3);
        must_model(&s, dmb_model_add_event(s.model, &event, NULL));
        (void)rig_start(&s, NULL);
        seen found = {.sim = s.sim, .from = 0.01, .last = -1.0};
        must(&s, dmb_sim_set_on_step(s.sim, see, &found));
        must(&s, dmb_sim_set_progress(s.sim, break_output, &found));
        const int32_t status = equal ? dmb_sim_steps_to_event(s.sim, 1e-3, 1000, NULL, NULL, NULL)
                                     : dmb_sim_advance_to_event(s.sim, 1.0, NULL, NULL);
        assert_int_equal(status, DMB_ERR_VALUE);
        assert_non_null(strstr(dmb_sim_message(s.sim), "event 0 (up)"));
        assert_true(dmb_sim_time(s.sim) > 0.01 && found.last == dmb_sim_time(s.sim));
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(an_accepted_step_is_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
