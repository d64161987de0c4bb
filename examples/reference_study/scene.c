#include <math.h>
#include <stdio.h>

#include "study.h"

study_scene study_base(void)
{
    study_scene base = {.wall = rig_wall(), .pipe = rig_pipe(), .bit = rig_bit()};
    base.pipes = rig_options_default().pipes;
    base.kind = DMB_PIPE_FLEXIBLE;
    return base;
}

double study_clearance(const study_scene *scene)
{
    return 0.5 * (scene->wall.diameter - scene->pipe.outer_diameter);
}

/* Drag acts around the pipe on its skin. */
static int32_t set_surroundings(dmb_model *model, const study_scene *scene)
{
    dmb_environment_def def = dmb_environment_def_default();
    if (scene->alone) def.gravity[2] = 0.0;
    def.axial_damping = scene->drag;
    def.torsional_damping = 0.25 * scene->drag * pow(scene->pipe.outer_diameter, 2.0);
    return dmb_model_set_environment(model, &def);
}

static int32_t add_wall(dmb_model *model, const study_scene *scene)
{
    return scene->alone ? DMB_OK : dmb_model_add_wall(model, &scene->wall, NULL);
}

static int32_t add_pipes(study_string *s, const study_scene *scene)
{
    dmb_pipe_def pipe = scene->pipe;
    if (scene->alone) pipe.eccentricity = 0.0;
    return dmb_model_add_pipes(s->model, &pipe, scene->pipes, &s->string);
}

static int32_t add_bit(dmb_model *model, const study_scene *scene)
{
    dmb_bit_def bit = scene->bit;
    dmb_segment load = dmb_segment_default();
    int32_t status = DMB_OK;
    load.h0 = RIG_BOTTOM_LOAD;
    if (!scene->alone) status = dmb_model_add_time_function(model, &load, 1, &bit.load);
    return status < 0 ? status : dmb_model_add_bit(model, &bit, NULL);
}

/* The load that buckling grows: 1 N back along the hole, of which none acts before. */
static int32_t add_push(study_string *s, const study_scene *scene)
{
    const dmb_segment none = dmb_segment_default(); /* of height 0 */
    dmb_load_def push = dmb_load_def_default();
    push.force[0] = -1.0;
    push.place = dmb_station(s->string, scene->pipes - 1, 1.0);
    const int32_t status = dmb_model_add_time_function(s->model, &none, 1, &push.time_function);
    return status < 0 ? status : dmb_model_add_load(s->model, &push, &s->push);
}

/* The head holds the string in line with the hole. Its drives feed and turn; while the string is looked at they hold it
 * still, so that shaking is what is added. */
static int32_t add_drives(study_string *s)
{
    const dmb_segment still = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    int32_t status = dmb_model_add_time_function(s->model, &still, 1, &drive.time_function);
    drive.part = s->string;
    if (status >= 0) status = dmb_model_add_drive(s->model, &drive, s->drive);
    drive.component = DMB_RX;
    return status < 0 ? status : dmb_model_add_drive(s->model, &drive, s->drive + 1);
}

int32_t study_make(const study_scene *scene, study_string *s)
{
    dmb_compile_options compile = dmb_compile_options_default();
    const study_string empty = {0};
    *s = empty;
    compile.pipe_kind = scene->kind;
    int32_t status = dmb_model_create(NULL, &s->model);
    if (status >= 0) status = set_surroundings(s->model, scene);
    if (status >= 0) status = add_wall(s->model, scene);
    if (status >= 0) status = add_pipes(s, scene);
    if (status >= 0 && scene->bit.mass > 0.0) status = add_bit(s->model, scene);
    if (status >= 0 && !scene->alone) status = add_push(s, scene);
    if (status >= 0 && !scene->unheld) status = add_drives(s);
    if (status >= 0) status = dmb_model_compile(s->model, &compile);
    if (status >= 0) status = dmb_sim_create(s->model, NULL, &s->sim);
    return status < 0 || scene->alone ? status : dmb_analysis_static(s->sim, NULL, NULL);
}

void study_free(study_string *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

const char *study_message(const study_string *s)
{
    return s->sim != NULL ? dmb_sim_message(s->sim) : dmb_model_message(s->model);
}

int32_t study_lowest(study_string *s, int32_t contact, uint32_t count, double *frequencies)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    options.count = count;
    options.contact = contact;
    options.friction = 0; /* a string that turns slides already, and sliding has next to no slope */
    int32_t status = dmb_analysis_modes(s->sim, &options, &modes);
    for (uint32_t i = 0; i < count && status >= 0; ++i) {
        dmb_mode mode = dmb_mode_default();
        status = dmb_modes_get(modes, i, &mode);
        frequencies[i] = mode.frequency;
    }
    dmb_modes_destroy(&modes);
    return status;
}

FILE *study_table(const char *folder, const char *name, const char *head)
{
    char path[4096];
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (file == NULL)
        perror(path);
    else if (head != NULL)
        fprintf(file, "%s\n", head);
    return file;
}
