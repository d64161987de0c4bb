#include <stdio.h>

#include "study.h"

#define BOTTOM_LOAD 2960.0 /* [N] on the bit while it drills */
#define DAMPING_TIME 1e-4  /* [s] of the steel, as in gas_drainage_rig */

study_scene study_base(void)
{
    study_scene base = {0};
    base.pipes = 100;
    base.elements = 1;
    base.length = 1.0;
    base.friction = 0.30;
    base.hole = 0.094;
    base.modulus = 2.1e11;
    base.wall = 1e7;
    base.bit = 5.0;
    base.kind = DMB_PIPE_FLEXIBLE;
    return base;
}

/* Drag acts around the pipe on its skin. */
static int32_t set_surroundings(dmb_model *model, const study_scene *scene)
{
    dmb_environment_def def = dmb_environment_def_default();
    if (scene->alone) def.gravity[2] = 0.0;
    def.axial_damping = scene->drag;
    def.torsional_damping = scene->drag * 0.25 * STUDY_DIAMETER * STUDY_DIAMETER;
    return dmb_model_set_environment(model, &def);
}

static int32_t add_wall(dmb_model *model, const study_scene *scene)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.diameter = scene->hole;
    wall.stiffness = scene->wall;
    wall.mu_dynamic = scene->friction;
    wall.mu_static = scene->friction + 0.05;
    return scene->alone ? DMB_OK : dmb_model_add_wall(model, &wall, NULL);
}

static int32_t add_pipes(study_string *s, const study_scene *scene)
{
    dmb_pipe_def pipe = dmb_pipe_def_default(); /* steel, wall of 6 mm */
    pipe.outer_diameter = STUDY_DIAMETER;
    pipe.elements = scene->elements;
    pipe.length = scene->length;
    pipe.young_modulus = scene->modulus;
    pipe.damping_time = DAMPING_TIME;
    pipe.eccentricity = scene->alone ? 0.0 : STUDY_ECCENTRICITY;
    pipe.angle_spread = 0.5 * STUDY_TURN;
    return dmb_model_add_pipes(s->model, &pipe, scene->pipes, &s->string);
}

static int32_t add_bit(dmb_model *model, const study_scene *scene)
{
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_term load = dmb_term_default();
    int32_t status = DMB_OK;
    bit.mass = scene->bit;
    bit.diameter = 0.0; /* soft coal breaks out around it */
    load.h0 = BOTTOM_LOAD;
    if (!scene->alone) status = dmb_model_add_programme(model, &load, 1, &bit.load);
    return status < 0 ? status : dmb_model_add_bit(model, &bit, NULL);
}

/* The head holds the string in line with the hole. Its drives feed and turn; while the string is looked at they hold it
 * still, so that shaking is what is added. */
static int32_t add_drives(study_string *s)
{
    const dmb_term still = dmb_term_default();
    dmb_drive_def drive = dmb_drive_def_default();
    int32_t status = dmb_model_add_programme(s->model, &still, 1, &drive.programme);
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
    if (status >= 0 && scene->bit > 0.0) status = add_bit(s->model, scene);
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
    else
        fprintf(file, "%s\n", head);
    return file;
}
