/* How many degrees of freedom has my model, and what holds what? The rig of the reference study as one would draw it:
 * head, 100 flexible pipes, bit, 101 fixed joints between them, a cylindrical support at the head and two drives in it.
 * The same string described in one piece has the same degrees_of_freedom and none of these equations. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

#define PIPES 100

static int32_t add_body(dmb_model *model, double x, double mass, dmb_id *id)
{
    dmb_body_def body = dmb_body_def_default();
    body.position[0] = x;
    body.mass = mass;
    for (int i = 0; i < 3; ++i) body.inertia[i] = 0.01 * mass;
    return dmb_model_add_body(model, &body, id);
}

/* One pipe, a string of its own that nothing supports, from x on. */
static int32_t add_pipe(dmb_model *model, double x, dmb_id *id)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.start_free = DMB_FREE_ALL;
    string.position[0] = x;
    const int32_t status = dmb_model_add_string(model, &string, id);
    pipe.string = *id;
    return status < 0 ? status : dmb_model_add_pipes(model, &pipe, 1, NULL);
}

static int32_t join(dmb_model *model, int32_t kind, dmb_place a, dmb_place b, dmb_id *id)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = kind;
    joint.place_a = a;
    joint.place_b = b;
    return dmb_model_add_joint(model, &joint, id);
}

static int32_t add_drive(dmb_model *model, dmb_id support, int32_t component, double speed)
{
    dmb_segment term = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    term.kind = DMB_SEGMENT_STEP;
    term.h1 = speed;
    drive.part = support;
    drive.component = component;
    const int32_t status = dmb_model_add_time_function(model, &term, 1, &drive.time_function);
    return status < 0 ? status : dmb_model_add_drive(model, &drive, NULL);
}

static int32_t describe(dmb_model *model)
{
    const dmb_place ground = dmb_station((dmb_id){0, 0}, 0, 0.0);
    dmb_id part, support;
    int32_t status = add_body(model, 0.0, 100.0, &part);
    dmb_place last = dmb_station(part, 0, 0.0);
    if (status >= 0) status = join(model, DMB_JOINT_CYLINDRICAL, ground, last, &support);
    for (int i = 0; i < PIPES && status >= 0; ++i) {
        status = add_pipe(model, i, &part);
        if (status >= 0) status = join(model, DMB_JOINT_FIXED, last, dmb_station(part, 0, 0.0), NULL);
        last = dmb_station(part, 0, 1.0);
    }
    if (status >= 0) status = add_body(model, PIPES, 5.0, &part);
    if (status >= 0) status = join(model, DMB_JOINT_FIXED, last, dmb_station(part, 0, 0.0), NULL);
    if (status >= 0) status = add_drive(model, support, DMB_X, 0.01);
    return status < 0 ? status : add_drive(model, support, DMB_RX, 20.944);
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words, "How many degrees of freedom has my model, and what holds what?", NULL, 0);
    static char text[8192];
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    size_t needed;
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model);
    if (status >= 0) status = dmb_model_compile(model, NULL);
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    if (status >= 0) status = dmb_analysis_check_text(sim, text, sizeof text, &needed);
    if (status < 0) fprintf(stderr, "%s%s\n", dmb_model_message(model), dmb_sim_message(sim));
    printf("%s", text);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
