/* A stabiliser and a measuring sub in the middle of a hanging string: the load that each joint carries at rest, beside
 * the weight of what hangs on it. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

enum { SUBS = 2, SECTION = 2 };
static const double gravity = 9.81, masses[SUBS] = {120.0, 45.0}, lengths[SUBS] = {1.5, 0.8}; /* [m/s2, kg, m] */
static const char *const names[SUBS] = {"stabiliser", "measuring sub"};

/* Pipes, and after them each sub with its pipes. */
static int32_t describe(dmb_model *model, dmb_sub subs[SUBS])
{
    dmb_environment_def down = dmb_environment_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    down.gravity[0] = gravity;
    down.gravity[2] = 0.0;
    string.start_free = DMB_FREE_NONE;
    pipe.length = 3.0;
    int32_t status = dmb_model_set_environment(model, &down);
    if (status >= 0) status = dmb_model_add_string(model, &string, &pipe.string);
    if (status >= 0) status = dmb_model_add_pipes(model, &pipe, 10, NULL);
    for (int i = 0; i < SUBS && status >= 0; i++) {
        dmb_body_def body = dmb_body_def_default();
        dmb_sub_def sub = dmb_sub_def_default();
        body.mass = masses[i];
        body.centre[0] = 0.5 * lengths[i];
        (void)snprintf(body.name, sizeof body.name, "%s", names[i]);
        sub.string = pipe.string;
        sub.length = lengths[i];
        sub.body = &body;
        subs[i] = dmb_sub_default();
        status = dmb_model_add_sub(model, &sub, &subs[i]);
        pipe.string = subs[i].section; /* the next pipes go on there */
        if (status >= 0) status = dmb_model_add_pipes(model, &pipe, SECTION, NULL);
    }
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

/* [N] of the pipes of one section. */
static double weight_of_section(void)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const double outer = pipe.outer_diameter, inner = pipe.inner_diameter;
    return gravity * pipe.density * 0.785398163397448 * (outer * outer - inner * inner) * 3.0 * SECTION;
}

static int32_t tell(dmb_sim *sim, const dmb_sub subs[SUBS])
{
    int32_t status = dmb_analysis_static(sim, NULL, NULL);
    double below = 0.0;
    for (int i = SUBS - 1; i >= 0 && status >= 0; i--) {
        dmb_joint_state before = dmb_joint_state_default();
        status = dmb_query_joint(sim, subs[i].before, &before);
        below += gravity * masses[i] + weight_of_section();
        printf("%-13s hangs on %7.2f N; weight of it and all below %7.2f N\n", names[i], -before.reaction[0], below);
    }
    return status;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words, "The load that each joint of a string with two subs carries.", NULL, 0);
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_sub subs[SUBS];
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model, subs);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = tell(sim, subs);
    if (status < 0) fprintf(stderr, "%s\n%s\n", dmb_model_message(model), sim != NULL ? dmb_sim_message(sim) : "");
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
