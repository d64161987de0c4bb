#include "scene.h"

#include <stddef.h>

/* Head: it feeds and turns, and holds still while the string is looked at. */
static int32_t add_head(dmb_model *model)
{
    const dmb_segment still = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    int32_t status = dmb_model_add_time_function(model, &still, 1, &drive.time_function);
    for (int32_t c = DMB_X; c <= DMB_RX && status >= 0; c += DMB_RX - DMB_X) {
        drive.component = c;
        status = dmb_model_add_drive(model, &drive, NULL);
    }
    return status;
}

static int32_t describe(uint32_t pipes, double eccentricity, speeds_scene *s)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_bit_def bit = dmb_bit_def_default();
    int32_t status = dmb_model_create(NULL, &s->model);
    pipe.eccentricity = eccentricity;
    pipe.angle_spread = 0.5 * TURN;
    if (status >= 0) status = dmb_model_add_wall(s->model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(s->model, &pipe, pipes, &s->string);
    if (status >= 0) status = dmb_model_add_bit(s->model, &bit, &s->bit);
    if (status >= 0) status = add_head(s->model);
    if (status >= 0) status = dmb_model_compile(s->model, NULL);
    return status < 0 ? status : dmb_sim_create(s->model, NULL, &s->sim);
}

int32_t speeds_scene_make(uint32_t pipes, double eccentricity, double speed, speeds_scene *scene)
{
    dmb_static_options options = dmb_static_options_default();
    options.slip_rotation = speed;
    const int32_t status = describe(pipes, eccentricity, scene);
    return status < 0 ? status : dmb_analysis_static(scene->sim, &options, NULL);
}

const char *speeds_scene_message(const speeds_scene *scene)
{
    return scene->sim ? dmb_sim_message(scene->sim) : dmb_model_message(scene->model);
}

void speeds_scene_free(speeds_scene *scene)
{
    dmb_sim_destroy(&scene->sim);
    dmb_model_destroy(&scene->model);
}
