/* A bit gets stuck while the string is pulled: the pull grows with the stretch until it comes free, and an event tells
 * when. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>
#include <string.h>

#include "command_line.h"

typedef struct parts {
    dmb_id string, stuck, jam;
} parts;

static int32_t describe(dmb_model *model, parts *p)
{
    dmb_environment_def down = dmb_environment_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    dmb_input_def jam = dmb_input_def_default();
    dmb_event_def freed = dmb_event_def_default();
    dmb_drive_def winch = dmb_drive_def_default();
    dmb_segment speed = dmb_segment_default();
    down.gravity[0] = -down.gravity[2]; /* the string hangs along x */
    down.gravity[2] = 0.0;
    down.axial_damping = 20.0;
    string.follows_hole = 0;
    string.start_free = DMB_FREE_X;
    rod.length = 3.0;
    rod.damping_time = 1e-4;
    speed.h0 = -0.02; /* upwards */
    int32_t status = dmb_model_set_environment(model, &down);
    if (status >= 0) status = dmb_model_add_string(model, &string, &p->string);
    if (status >= 0) status = dmb_model_add_pipes(model, &rod, 100, NULL);
    if (status >= 0) status = dmb_model_add_time_function(model, &speed, 1, &winch.time_function);
    winch.part = p->string;
    winch.component = DMB_X;
    if (status >= 0) status = dmb_model_add_drive(model, &winch, NULL);
    stuck.place = dmb_station(p->string, 99, 1.0);
    stuck.stuck = 0; /* not yet */
    stuck.overpull = 60e3;
    if (status >= 0) status = dmb_model_add_stuck(model, &stuck, &p->stuck);
    (void)strcpy(jam.name, "jam");
    jam.target = DMB_TARGET_STUCK;
    jam.part = p->stuck;
    if (status >= 0) status = dmb_model_add_input(model, &jam, &p->jam);
    (void)strcpy(freed.name, "freed");
    freed.direction = DMB_EVENT_FALLING;
    freed.level = 0.5;
    freed.output.quantity = DMB_OUTPUT_STUCK;
    freed.output.place.part = p->stuck;
    if (status >= 0) status = dmb_model_add_event(model, &freed, NULL);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

static int32_t run(dmb_sim *sim, const parts *p)
{
    dmb_stuck_state state = dmb_stuck_state_default();
    int32_t status = dmb_analysis_static(sim, NULL, NULL);
    if (status >= 0) status = dmb_sim_advance(sim, 1.0, NULL);
    if (status >= 0) status = dmb_sim_set_input(sim, p->jam, 1.0);
    while (status >= 0 && status != DMB_NOTE_EVENT) {
        if (dmb_query_stuck(sim, p->stuck, &state) >= 0)
            printf("%5.1f s: stuck %d, %6.1f kN, %3.0f %% of the overpull\n", dmb_sim_time(sim), (int)state.stuck,
                   1e-3 * state.force[0], 100.0 * state.share);
        status = dmb_sim_advance_to_event(sim, dmb_sim_time(sim) + 1.5, NULL, NULL);
    }
    if (status < 0) return status;
    printf("%5.2f s: %s\n", dmb_sim_time(sim), dmb_sim_message(sim));
    return DMB_OK;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "A bit gets stuck while the string is pulled: the pull grows with the stretch until it "
                            "comes free, and an event tells when.",
                            NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    parts p;
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, &p);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = run(sim, &p);
    if (status < 0) fprintf(stderr, "%s\n%s\n", dmb_model_message(model), sim != NULL ? dmb_sim_message(sim) : "");
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
