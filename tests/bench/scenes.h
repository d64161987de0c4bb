/* The scenes.
 *   C   a steel tube, OD 73, ID 59 mm, turned at one end from 0 to 60 rpm in the first second by a cubic STEP
 *   B   the same under gravity in a hole of 94 mm, with contact and friction
 *   B*  B driven with pi (1 - cos(pi t)) instead, up to 60 rpm: figures at 2 s are given for it from elsewhere
 *   T   the same under gravity without a hole: 20 m of it bend far down, turning
 *   R   the rig of examples/gas_drainage_rig with everything on, from rest on the wall: its own source, so that it is
 *       the same rig */
#ifndef BENCH_SCENES_H
#define BENCH_SCENES_H

#include <drillmbd/drillmbd.h>

#include <math.h>
#include <string.h>

#include "../../examples/gas_drainage_rig/cycle.c"
#include "../../examples/gas_drainage_rig/scene.c"

#define BENCH_PI 3.14159265358979323846
#define BENCH_YOUNG 206e9
#define BENCH_POISSON 0.3
#define BENCH_DENSITY 7850.0

enum { SCENE_C = 0, SCENE_B = 1, SCENE_B_COSINE = 2, SCENE_R = 3, SCENE_T = 4, SCENE_COUNT = 5 };
static const char *const scene_names[SCENE_COUNT] = {"C", "B", "B*", "R", "T"};

/* Questions to a scene: two quantities each. */
static const char *const quantity_names[SCENE_COUNT][2] = {{"tip_speed", ""},
                                                           {"tip_rotation", "tip_z_mm"},
                                                           {"tip_rotation", "wall_force"},
                                                           {"torque", "bit_z_mm"},
                                                           {"tip_rotation", "tip_z_mm"}};

typedef struct scene {
    int kind;
    uint32_t pipes, per_pipe; /* [-] elements in a pipe */
    double length;            /* [m] of a pipe */
    int32_t pipe_kind;        /* of C, B, T */
    double offset;            /* [m] of C, B, T: sideways from the hole's axis, as a whole */
    double friction;          /* [-] of B: more than 0.3 */
    double damping;           /* [N s/m2] of B's wall: more than 1000 */
    int32_t normal_law;       /* of B's wall, DMB_NORMAL_...; 0: Kelvin-Voigt */
    dmb_model *model;
    dmb_id string, turn;
    double bytes;        /* [byte] of model and sim with default options, an element */
    rig_options options; /* of R; its time functions read them */
} scene;

/* ---- C and B ----------------------------------------------------------------------------------------------------- */

static int32_t cosine_speed(void *context, double time, double out[3])
{
    const double pi = BENCH_PI, t = time < 1.0 ? time : 1.0;
    (void)context;
    out[0] = pi * (1.0 - cos(pi * t));
    out[1] = pi * pi * sin(pi * t);
    out[2] = pi * t - sin(pi * t) + 2.0 * pi * (time - t);
    if (time >= 1.0) out[1] = 0.0;
    return 0;
}

static int32_t bench_add_turning(scene *s)
{
    dmb_segment term = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    term.kind = DMB_SEGMENT_STEP;
    term.h1 = 2.0 * BENCH_PI;
    if (s->kind == SCENE_B_COSINE) {
        term.kind = DMB_SEGMENT_CALLBACK;
        term.callback = cosine_speed;
        term.provides = DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL;
    }
    int32_t status = dmb_model_add_time_function(s->model, &term, 1, &drive.time_function);
    drive.part = s->string;
    drive.component = DMB_RX;
    return status < 0 ? status : dmb_model_add_drive(s->model, &drive, &s->turn);
}

static int32_t bench_add_tube(scene *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.start_free = DMB_FREE_RX;
    string.offset[0] = s->offset;
    int32_t status = dmb_model_add_string(s->model, &string, &s->string);
    pipe.string = s->string;
    pipe.elements = s->per_pipe;
    pipe.length = s->length;
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.059;
    pipe.young_modulus = BENCH_YOUNG;
    pipe.poisson_ratio = BENCH_POISSON;
    pipe.density = BENCH_DENSITY;
    return status < 0 ? status : dmb_model_add_pipes(s->model, &pipe, s->pipes, NULL);
}

static int32_t bench_add_hole(scene *s)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.diameter = 0.094;
    wall.normal_law = s->normal_law;
    wall.stiffness = 1e6;
    wall.damping = 1e3 + s->damping;
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.mu_static = wall.mu_dynamic = 0.3 + s->friction;
    wall.smoothing_speed = 0.01;
    return dmb_model_add_wall(s->model, &wall, NULL);
}

static int has_hole(const scene *s)
{
    return s->kind == SCENE_B || s->kind == SCENE_B_COSINE;
}

static int32_t bench_make_tube(scene *s)
{
    dmb_compile_options compile = dmb_compile_options_default();
    compile.features = s->kind == SCENE_C ? 0 : DMB_FEATURE_GRAVITY | DMB_FEATURE_CONTACT | DMB_FEATURE_FRICTION;
    compile.pipe_kind = s->pipe_kind;
    int32_t status = dmb_model_create(NULL, &s->model);
    if (status >= 0 && has_hole(s)) status = bench_add_hole(s);
    if (status >= 0) status = bench_add_tube(s);
    if (status >= 0) status = bench_add_turning(s);
    return status < 0 ? status : dmb_model_compile(s->model, &compile);
}

/* ---- R ----------------------------------------------------------------------------------------------------------- */

static int32_t bench_make_rig(scene *s)
{
    const rig_variant variant = {DMB_PIPE_FLEXIBLE, RIG_VIBRATION};
    rig_scene rig;
    memset(&s->options, 0, sizeof s->options);
    s->options.variant = variant;
    s->options.pipes = s->pipes;
    s->options.elements = s->per_pipe;
    s->options.length = s->length;
    s->options.seed = 1;
    s->options.cycle = rig_cycle_full();
    const int32_t status = rig_scene_make(&s->options, &variant, &rig);
    s->model = rig.model;
    s->string = rig.string;
    s->turn = rig.rotation;
    return status;
}

/* ---- All --------------------------------------------------------------------------------------------------------- */

static int32_t scene_open(scene *s)
{
    dmb_model_info info = dmb_model_info_default();
    s->model = NULL;
    int32_t status = s->kind == SCENE_R ? bench_make_rig(s) : bench_make_tube(s);
    if (status >= 0) status = dmb_model_get_info(s->model, &info);
    s->bytes = ((double)info.model_bytes + (double)info.sim_bytes) / (s->pipes * s->per_pipe);
    return status;
}

#endif
