/* How does a rig's own controller run against the model, cycle by cycle of 1 ms?
 *
 * The control unit reads torque (by oil pressure), speed, hook load and carriage with noise and delay, and commands set
 * points and limits. The bit gets stuck; the controller sees it, winds the string down, pulls it free and drills on.
 * Each step has bounded work; with --real-time the cycles keep to the clock. */
#include <stdio.h>

#include "../command_line.h"
#include "controller.h"
#include "pace.h"

typedef struct settings {
    double seconds, jam;
    uint32_t pipes;
    int real_time;
} settings;

static void show(const rig *r, const controller *c)
{
    printf("%7.3f s: %-12s %6.1f bar %7.0f N m %6.2f rad/s %7.2f kN %8.4f m\n", dmb_sim_time(r->sim),
           phase_name(c->phase), 1e-5 * c->smooth.pressure, c->smooth.torque, c->smooth.speed, 1e-3 * c->smooth.hook,
           c->smooth.feed);
}

static int32_t cycle(rig *r, controller *c, pace *p)
{
    readings seen = {0};
    commands wanted = {0};
    pace_begin(p);
    int32_t status = rig_measure(r, &seen);
    const int changed = controller_decide(c, &seen, &wanted);
    if (status >= 0) status = rig_command(r, &wanted);
    if (status >= 0) status = dmb_sim_step(r->sim, CYCLE, NULL);
    pace_end(p);
    if (changed) show(r, c);
    return status;
}

static int32_t run(rig *r, const settings *s)
{
    controller c = {0};
    pace p = {.waits = s->real_time};
    dmb_statistics statistics = dmb_statistics_default();
    const uint32_t cycles = (uint32_t)(s->seconds / CYCLE + 0.5), jam = (uint32_t)(s->jam / CYCLE + 0.5);
    int32_t status = DMB_OK;
    show(r, &c);
    for (uint32_t i = 0; i < cycles && status >= 0; i++) {
        if (i == jam) status = rig_jam(r);
        if (status >= 0) status = cycle(r, &c, &p);
    }
    show(r, &c);
    if (status >= 0) status = dmb_query_statistics(r->sim, &statistics);
    if (status >= 0) printf("at most %u iterations a step\n", statistics.most_iterations);
    pace_print(&p);
    return status;
}

int main(int count, char **words)
{
    settings s = {20.0, 6.0, 50, 0};
    const command_option options[] = {
        {.name = "seconds", .value = "S", .help = "of the run (20)", .low = 0.1, .high = 3600.0, .number = &s.seconds},
        {.name = "jam",
         .value = "S",
         .help = "time at which the bit gets stuck (6)",
         .low = 0.0,
         .high = 3600.0,
         .number = &s.jam},
        {.name = "pipes", .value = "N", .help = "of 1.5 m (50)", .low = 2.0, .high = 400.0, .whole = &s.pipes},
        {.name = "real-time", .help = "keep to the clock: a cycle every millisecond", .given = &s.real_time}};
    const int told =
        command_line(count, words, "How does a rig's own controller run against the model at 1 kHz?", options, 4);
    if (told >= 0) return told;
    rig r = {0};
    int32_t status = rig_create(&r, s.pipes);
    if (status >= 0) status = run(&r, &s);
    if (status < 0)
        (void)fprintf(stderr, "%s: %s%s\n", dmb_status_text(status), r.model != NULL ? dmb_model_message(r.model) : "",
                      r.sim != NULL ? dmb_sim_message(r.sim) : "");
    rig_destroy(&r);
    return status < 0;
}
