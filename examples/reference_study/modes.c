#include <math.h>
#include <stdio.h>

#include "study.h"

#define SMALL_DRAG 0.1  /* [N s/m2] so little that overdamped roots stand before the first frequency */
#define SWINGS 0.999999 /* [-] damping ratio below which a root is a pair that swings */

const double study_tube_length[STUDY_TUBES] = {7.0, 8.5, 10.0};               /* [m] */
const double study_tube_reference[STUDY_TUBES] = {0.94547, 0.64124, 0.46330}; /* [Hz] */

static study_scene string_alone(void)
{
    study_scene scene = study_base();
    scene.alone = 1;
    return scene;
}

/* ---- The modal table --------------------------------------------------------------------------------------------- */

static int32_t take_first(study_modal *m, dmb_modes *modes)
{
    int32_t status = DMB_OK;
    int swung = 0;
    for (uint32_t i = 0; i < STUDY_MODES && status >= 0; ++i) {
        m->first[i] = dmb_mode_default();
        status = dmb_modes_get(modes, i, m->first + i);
        swung |= !m->first[i].rigid && m->first[i].damping < SWINGS;
        if (swung) continue;
        m->rigid += m->first[i].rigid;
        m->overdamped += !m->first[i].rigid;
    }
    return status;
}

static int32_t find_first(study_modal *m, study_string *s)
{
    study_scene scene = string_alone();
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    scene.unheld = 1;
    scene.drag = SMALL_DRAG;
    options.kind = DMB_MODES_DAMPED;
    options.count = STUDY_MODES;
    int32_t status = study_make(&scene, s);
    if (status >= 0) status = dmb_analysis_modes(s->sim, &options, &modes);
    if (status >= 0) status = take_first(m, modes);
    dmb_modes_destroy(&modes);
    return status;
}

/* ---- The range --------------------------------------------------------------------------------------------------- */

static int32_t every_mode(study_string *s, dmb_modes **modes, dmb_modes_info *info)
{
    dmb_modes_options options = dmb_modes_options_default();
    options.select = DMB_MODES_ALL;
    const int32_t status = dmb_analysis_modes(s->sim, &options, modes);
    return status < 0 ? status : dmb_modes_get_info(*modes, info);
}

static int32_t find_all(study_modal *m, study_string *s)
{
    study_scene scene = string_alone();
    dmb_modes_info info = dmb_modes_info_default();
    dmb_modes *modes = NULL;
    scene.unheld = 1;
    int32_t status = study_make(&scene, s);
    if (status >= 0) status = every_mode(s, &modes, &info);
    m->all_rigid = info.rigid;
    for (uint32_t i = 0; i < info.count && i < STUDY_ALL && status >= 0; ++i) {
        dmb_mode mode = dmb_mode_default();
        status = dmb_modes_get(modes, i, &mode);
        m->all[m->all_count++] = mode.frequency;
    }
    dmb_modes_destroy(&modes);
    return status;
}

/* The highest modes shake single elements against their neighbours, so that ten pipes tell nearly what a hundred do. */
static int32_t find_highest(study_modal *m, study_string *s, uint32_t elements)
{
    study_scene scene = string_alone();
    dmb_modes_info info = dmb_modes_info_default();
    dmb_mode mode = dmb_mode_default();
    dmb_modes *modes = NULL;
    scene.pipes = 10;
    scene.pipe.elements = elements;
    int32_t status = study_make(&scene, s);
    if (status >= 0) status = every_mode(s, &modes, &info);
    if (status >= 0) status = dmb_modes_get(modes, info.count - 1, &mode);
    m->highest[elements - 1] = mode.frequency;
    dmb_modes_destroy(&modes);
    return status;
}

static int32_t find_without_bit(study_modal *m, study_string *s)
{
    study_scene scene = string_alone();
    scene.bit.mass = 0.0;
    const int32_t status = study_make(&scene, s);
    return status < 0 ? status : study_lowest(s, DMB_CONTACT_AS_IS, 1, &m->without_bit);
}

/* ---- Shapes ------------------------------------------------------------------------------------------------------ */

/* Each order swings in any plane through the axis: what is taken is the motion in the plane of the far end. */
static int32_t take_shape(study_modal *m, const study_string *s, const dmb_modes *modes, int number)
{
    double y[STUDY_PLACES], z[STUDY_PLACES];
    for (int i = 0; i < STUDY_PLACES; ++i) {
        const uint32_t pipe = i > 0 ? (uint32_t)i - 1 : 0;
        dmb_mode_shape shape = dmb_mode_shape_default();
        const int32_t status =
            dmb_modes_shape(modes, 2 * (uint32_t)number + 1, dmb_station(s->string, pipe, i > 0 ? 1.0 : 0.0), &shape);
        if (status < 0) return status;
        y[i] = shape.re[DMB_Y];
        z[i] = shape.re[DMB_Z];
    }
    const double *end_y = y + STUDY_PLACES - 1, *end_z = z + STUDY_PLACES - 1;
    const double end = *end_y * *end_y + *end_z * *end_z;
    for (int i = 0; i < STUDY_PLACES; ++i) {
        double *shape = m->shape[number];
        shape[i] = (y[i] * *end_y + z[i] * *end_z) / end;
        m->shape_nodes[number] += i > 1 && shape[i] * shape[i - 1] < 0.0;
    }
    return DMB_OK;
}

/* Modes 2 number and 2 number + 1 (from 0) bend in two planes: angle between the motions of the far end. */
static int32_t take_pair(study_modal *m, const study_string *s, const dmb_modes *modes, int number)
{
    dmb_mode_shape pair[2];
    for (uint32_t i = 0; i < 2; ++i) {
        pair[i] = dmb_mode_shape_default();
        const int32_t status =
            dmb_modes_shape(modes, 2 * (uint32_t)number + i, dmb_station(s->string, STUDY_PLACES - 2, 1.0), pair + i);
        if (status < 0) return status;
    }
    const double *a = pair[0].re, *b = pair[1].re;
    const double cross = fabs(a[DMB_Y] * b[DMB_Z] - a[DMB_Z] * b[DMB_Y]);
    m->pair_angle[number] = atan2(cross, fabs(a[DMB_Y] * b[DMB_Y] + a[DMB_Z] * b[DMB_Z]));
    return DMB_OK;
}

static int32_t find_shapes(study_modal *m, study_string *s)
{
    const study_scene scene = string_alone();
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    int32_t status = study_make(&scene, s);
    if (status >= 0) status = dmb_analysis_modes(s->sim, &options, &modes);
    for (int i = 0; i < STUDY_SHAPES && status >= 0; ++i) {
        dmb_mode mode = dmb_mode_default();
        status = dmb_modes_get(modes, 2 * (uint32_t)i + 1, &mode);
        m->shape_frequency[i] = mode.frequency;
        if (status >= 0) status = take_shape(m, s, modes, i);
        if (status >= 0) status = take_pair(m, s, modes, i);
    }
    dmb_modes_destroy(&modes);
    return status;
}

/* ---- Steel tube -------------------------------------------------------------------------------------------------- */

static int32_t set_no_weight(dmb_model *model)
{
    dmb_environment_def def = dmb_environment_def_default();
    def.gravity[2] = 0.0;
    return dmb_model_set_environment(model, &def);
}

static int32_t find_tube(study_modal *m, study_string *s, int number)
{
    const study_string empty = {0};
    dmb_string_def held = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    *s = empty;
    held.start_free = DMB_FREE_NONE;
    pipe.outer_diameter = 0.050;
    pipe.inner_diameter = 0.040;
    pipe.length = study_tube_length[number];
    pipe.elements = 20;
    int32_t status = dmb_model_create(NULL, &s->model);
    if (status >= 0) status = set_no_weight(s->model);
    if (status >= 0) status = dmb_model_add_string(s->model, &held, &pipe.string);
    if (status >= 0) status = dmb_model_add_pipes(s->model, &pipe, 1, NULL);
    if (status >= 0) status = dmb_model_compile(s->model, NULL);
    if (status >= 0) status = dmb_sim_create(s->model, NULL, &s->sim);
    return status < 0 ? status : study_lowest(s, DMB_CONTACT_AS_IS, 1, m->tube + number);
}

/* ---- All of it --------------------------------------------------------------------------------------------------- */

/* Keeps the first failure and what was said of it. */
static void end_part(study_modal *m, study_string *s, int32_t status)
{
    if (status < 0 && m->status >= 0) {
        m->status = status;
        (void)snprintf(m->message, sizeof m->message, "%s", study_message(s));
    }
    study_free(s);
}

void study_modal_work(void *context)
{
    study_modal *m = context;
    study_string s = {0};
    end_part(m, &s, find_first(m, &s));
    end_part(m, &s, find_all(m, &s));
    end_part(m, &s, find_without_bit(m, &s));
    end_part(m, &s, find_shapes(m, &s));
    for (uint32_t elements = 1; elements <= STUDY_MESHES; ++elements) end_part(m, &s, find_highest(m, &s, elements));
    end_part(m, &s, study_find_by_modes(m, &s));
    for (int i = 0; i < STUDY_TUBES; ++i) end_part(m, &s, find_tube(m, &s, i));
}

/* ---- Report ------------------------------------------------------------------------------------------------------ */

static const char *kind_of(const dmb_mode *mode)
{
    static const char *const kinds[3] = {"along", "around", "sideways"};
    int most = 0;
    for (int k = 1; k < 3; ++k)
        if (mode->share[k] > mode->share[most]) most = k;
    return kinds[most];
}

static const char *way_of(const dmb_mode *mode)
{
    if (mode->rigid) return "rigid, nothing holds it";
    return mode->damping < SWINGS ? "swings" : "overdamped, does not swing";
}

void study_modal_print(const study_modal *m)
{
    printf("Modes of the string without a wall, the drives let go, drag of %g N s/m2\n", SMALL_DRAG);
    for (int i = 0; i < STUDY_MODES; ++i) {
        const dmb_mode *mode = m->first + i;
        printf("  %2d  %12.5e Hz   damping %11.4e   %-9s %s\n", i + 1, mode->frequency, mode->damping, kind_of(mode),
               way_of(mode));
    }
    printf("  without drag %u modes, %u of them rigid, the others from %.4e to %.4e Hz\n", m->all_count, m->all_rigid,
           m->all[m->all_rigid], m->all[m->all_count - 1]);
    printf("  lowest of the string held by its drives %.5e Hz, without a bit %.5e Hz\n", m->shape_frequency[0],
           m->without_bit);
    printf("  highest by elements in a pipe of 1 m:");
    for (int i = 0; i < STUDY_MESHES; ++i) printf("%s  %d: %.3e", i == 4 ? "\n   " : "", i + 1, m->highest[i]);
    printf(" Hz\n  highest with pipes described by 12 shapes of their ends and normal modes: ");
    for (int i = 0; i < STUDY_NORMALS; ++i) printf(" %d: %.3e", study_normal_modes[i], m->by_modes[i]);
    printf(" Hz\n\nShapes of the string held by its drives: none of its modes is rigid, so that its modes 1 to 10 are\n"
           "modes 5 to 14 of the list above\n");
    for (int i = 0; i < STUDY_SHAPES; ++i)
        printf("  mode %2d  %12.5e Hz  stands still at %d places between its ends\n", 2 * i + 2, m->shape_frequency[i],
               m->shape_nodes[i]);
    printf("\nSteel tube, 50/40 mm, clamped at one end\n");
    for (int i = 0; i < STUDY_TUBES; ++i)
        printf("  %4.1f m  %.5f Hz, reference %.5f Hz\n", study_tube_length[i], m->tube[i], study_tube_reference[i]);
    printf("\n");
}

static int write_shapes(const char *folder, const study_modal *m)
{
    FILE *file = study_table(folder, "shapes.csv", "x [m],mode 2,mode 4,mode 6,mode 8,mode 10");
    if (file == NULL) return 1;
    for (int i = 0; i < STUDY_PLACES; ++i) {
        fprintf(file, "%d", i);
        for (int k = 0; k < STUDY_SHAPES; ++k) fprintf(file, ",%.17g", m->shape[k][i]);
        fprintf(file, "\n");
    }
    return fclose(file) != 0;
}

int study_modal_write(const char *folder, const study_modal *m)
{
    FILE *file = study_table(folder, "modes.csv", "mode,frequency [Hz]");
    if (file == NULL) return 1;
    for (uint32_t i = 0; i < m->all_count; ++i) fprintf(file, "%u,%.17g\n", i + 1, m->all[i]);
    if (fclose(file) != 0) return 1;
    file = study_table(folder, "highest.csv", "coordinates of a pipe,by elements [Hz],by modes [Hz]");
    if (file == NULL) return 1;
    for (int i = 0; i < STUDY_MESHES; ++i) fprintf(file, "%d,%.17g,nan\n", 6 * (i + 1), m->highest[i]);
    for (int i = 0; i < STUDY_NORMALS; ++i) fprintf(file, "%d,nan,%.17g\n", 6 + study_normal_modes[i], m->by_modes[i]);
    return fclose(file) != 0 || write_shapes(folder, m);
}
