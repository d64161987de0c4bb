/* The parts of the rig as the study counts them: head and bit as bodies, every pipe a part of its own, fixed joints
 * between them, a cylindrical pair at the head and two drives in it. */
#include <stdio.h>

#include "study.h"

static int32_t add_body(dmb_model *model, double x, double mass, dmb_id *id)
{
    dmb_body_def body = dmb_body_def_default();
    body.position[0] = x;
    body.mass = mass;
    for (int i = 0; i < 3; ++i) body.inertia[i] = 0.01 * mass;
    return dmb_model_add_body(model, &body, id);
}

static int32_t add_pipe(dmb_model *model, dmb_pipe_def pipe, double x, dmb_id *id)
{
    dmb_string_def string = dmb_string_def_default();
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

static int32_t add_drive(dmb_model *model, dmb_id pair, int32_t component)
{
    const dmb_segment still = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = pair;
    drive.component = component;
    const int32_t status = dmb_model_add_time_function(model, &still, 1, &drive.time_function);
    return status < 0 ? status : dmb_model_add_drive(model, &drive, NULL);
}

static int32_t describe(dmb_model *model, const study_scene *scene)
{
    const dmb_place ground = dmb_station((dmb_id){0, 0}, 0, 0.0);
    dmb_id part, pair;
    int32_t status = add_body(model, 0.0, 100.0, &part);
    dmb_place last = dmb_station(part, 0, 0.0);
    if (status >= 0) status = join(model, DMB_JOINT_CYLINDRICAL, ground, last, &pair);
    for (uint32_t i = 0; i < scene->pipes && status >= 0; ++i) {
        status = add_pipe(model, scene->pipe, scene->pipe.length * i, &part);
        if (status >= 0) status = join(model, DMB_JOINT_FIXED, last, dmb_station(part, 0, 0.0), NULL);
        last = dmb_station(part, 0, 1.0);
    }
    if (status >= 0) status = add_body(model, scene->pipe.length * scene->pipes, scene->bit.mass, &part);
    if (status >= 0) status = join(model, DMB_JOINT_FIXED, last, dmb_station(part, 0, 0.0), NULL);
    if (status >= 0) status = add_drive(model, pair, DMB_X);
    return status < 0 ? status : add_drive(model, pair, DMB_RX);
}

void study_counts_work(void *context)
{
    study_counts *c = context;
    const study_scene scene = study_base();
    study_string s = {0};
    c->report = dmb_check_report_default();
    int32_t status = dmb_model_create(NULL, &s.model);
    if (status >= 0) status = describe(s.model, &scene);
    if (status >= 0) status = dmb_model_compile(s.model, NULL);
    if (status >= 0) status = dmb_sim_create(s.model, NULL, &s.sim);
    if (status >= 0) status = dmb_analysis_check(s.sim, &c->report);
    if (status < 0) (void)snprintf(c->message, sizeof c->message, "%s", study_message(&s));
    c->status = status;
    study_free(&s);
}
