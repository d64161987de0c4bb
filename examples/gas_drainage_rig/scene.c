#include "scene.h"

/* ---- What it is made of -------------------------------------------------------------------------------------------
 */

dmb_wall_def rig_wall(void)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.diameter = 0.094;
    wall.stiffness = 1e7; /* per metre of pipe; Hertz gives 7e8, but the coal crumbles */
    wall.restitution = 0.4;
    wall.mu_static = 0.35;
    wall.mu_dynamic = 0.30;
    wall.stribeck_speed = 1e-2;
    return wall;
}

dmb_pipe_def rig_pipe(void)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.length = 1.0;
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.061;
    pipe.young_modulus = 2.1e11;
    pipe.poisson_ratio = 0.3;
    pipe.density = 7850.0;
    pipe.damping_time = 1e-4; /* [s] damps a mode of 10 Hz by 0.3 % of critical, as steel and its threads do */
    pipe.eccentricity = 1e-3;
    pipe.angle_spread = 3.14159265358979323846; /* any direction */
    return pipe;
}

dmb_bit_def rig_bit(void)
{
    dmb_bit_def bit = dmb_bit_def_default();
    bit.mass = 5.0;
    bit.diameter = 0.0; /* soft coal breaks out around the bit, the last pipe lies on the wall */
    return bit;
}

/* ---- The scene --------------------------------------------------------------------------------------------------- */

static int32_t add_wall(dmb_model *model)
{
    const dmb_wall_def wall = rig_wall();
    return dmb_model_add_wall(model, &wall, NULL);
}

/* The head holds the first pipe in line with the hole and moves it along and around. A string of one rigid piece could
 * not move at all if it were held like that, so there the head lets it swing and tilt. */
static int32_t add_string(dmb_model *model, const rig_variant *variant, dmb_id *string)
{
    dmb_string_def def = dmb_string_def_default();
    const int floats = variant->pipe_kind == DMB_PIPE_RIGID && variant->couple != RIG_NO_COUPLING;
    def.start_free = floats ? DMB_FREE_ALL : DMB_FREE_CYLINDRICAL;
    return dmb_model_add_string(model, &def, string);
}

static int32_t add_pipes(dmb_model *model, const rig_options *options, dmb_id string)
{
    dmb_pipe_def pipe = rig_pipe();
    pipe.string = string;
    pipe.length = options->length;
    pipe.elements = options->elements;
    pipe.seed = options->seed;
    return dmb_model_add_pipes(model, &pipe, options->pipes, NULL);
}

static int32_t add_bit(dmb_model *model, rig_options *options, const rig_variant *variant, rig_scene *scene)
{
    dmb_bit_def bit = rig_bit();
    int32_t status = DMB_OK;
    bit.string = scene->string;
    bit.diameter = options->bit;
    if (variant->couple != RIG_NO_COUPLING) status = rig_add_bottom_load(model, &options->cycle, &bit.load);
    return status < 0 ? status : dmb_model_add_bit(model, &bit, &scene->bit);
}

static int32_t add_drives(dmb_model *model, rig_options *options, rig_scene *scene)
{
    dmb_drive_def drive = dmb_drive_def_default();
    int32_t status = rig_add_feed(model, &options->cycle, &drive.time_function);
    drive.part = scene->string;
    drive.component = DMB_X;
    if (status >= 0) status = dmb_model_add_drive(model, &drive, &scene->feed);
    drive.component = DMB_RX;
    if (status >= 0) status = rig_add_rotation(model, &options->cycle, &drive.time_function);
    if (status >= 0) status = rig_add_shake(model, drive.time_function, &drive.excitation);
    return status < 0 ? status : dmb_model_add_drive(model, &drive, &scene->rotation);
}

/* One description serves every variant: the compile step leaves out what a variant does without. */
static dmb_compile_options choose(const rig_variant *variant)
{
    dmb_compile_options compile = dmb_compile_options_default();
    compile.pipe_kind = variant->pipe_kind;
    compile.features = DMB_FEATURE_DAMPING;
    if (variant->couple >= RIG_CONTACT) compile.features |= DMB_FEATURE_GRAVITY | DMB_FEATURE_CONTACT;
    if (variant->couple >= RIG_FRICTION) compile.features |= DMB_FEATURE_FRICTION;
    if (variant->couple >= RIG_VIBRATION) compile.features |= DMB_FEATURE_VIBRATION;
    return compile;
}

int32_t rig_scene_make(rig_options *options, const rig_variant *variant, rig_scene *scene)
{
    const dmb_compile_options compile = choose(variant);
    const rig_scene empty = {NULL, {0, 0}, {0, 0}, {0, 0}, {0, 0}};
    *scene = empty;
    int32_t status = dmb_model_create(NULL, &scene->model);
    if (status >= 0) status = add_wall(scene->model);
    if (status >= 0) status = add_string(scene->model, variant, &scene->string);
    if (status >= 0) status = add_pipes(scene->model, options, scene->string);
    if (status >= 0) status = add_bit(scene->model, options, variant, scene);
    if (status >= 0) status = add_drives(scene->model, options, scene);
    return status < 0 ? status : dmb_model_compile(scene->model, &compile);
}
