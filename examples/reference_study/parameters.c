#include <math.h>
#include <stdio.h>

#include "study.h"

static const struct {
    const char *title, *name; /* of the report, of the table */
    int count;
    double value[STUDY_VALUES];
} sets_asked[STUDY_SETS] = {
    [STUDY_LENGTHS] = {"drilled length, pipes of 1 m [m]",
                       "drilled length [m]",
                       10,
                       {10, 20, 30, 40, 50, 60, 70, 80, 90, 100}},
    [STUDY_PIPE_LENGTHS] = {"length of each pipe, 100 m drilled [m]", "pipe length [m]", 6, {0.5, 1, 2, 2.5, 4, 5}},
    [STUDY_ELEMENTS] = {"elements in each pipe [-]", "elements in a pipe", 3, {1, 2, 4}},
    [STUDY_FRICTIONS] = {"friction on the wall [-]", "friction", 6, {0.05, 0.1, 0.2, 0.3, 0.4, 0.5}},
    [STUDY_HOLES] = {"clearance around the pipe [mm]", "clearance [mm]", 6, {2, 5, 8, 10.5, 15, 25}},
    [STUDY_MODULI] = {"Young's modulus [GPa]", "Young's modulus [GPa]", 4, {70, 140, 210, 280}},
    [STUDY_WALLS] = {"stiffness of the wall [MN/m per metre]", "wall stiffness [MN/m2]", 4, {1, 10, 100, 700}},
};

static study_scene scene_of(int set, double value)
{
    study_scene scene = study_base();
    switch (set) {
    case STUDY_LENGTHS: scene.pipes = (uint32_t)value; break;
    case STUDY_PIPE_LENGTHS:
        scene.pipes = (uint32_t)lround(100.0 / value);
        scene.length = value;
        break;
    case STUDY_ELEMENTS: scene.elements = (uint32_t)value; break;
    case STUDY_FRICTIONS: scene.friction = value; break;
    case STUDY_HOLES: scene.hole = STUDY_DIAMETER + 2e-3 * value; break;
    case STUDY_MODULI: scene.modulus = 1e9 * value; break;
    default: scene.wall = 1e6 * value; break;
    }
    return scene;
}

void study_sets_describe(study_set sets[STUDY_SETS])
{
    for (int i = 0; i < STUDY_SETS; ++i) {
        sets[i].count = sets_asked[i].count;
        for (int k = 0; k < sets[i].count; ++k) {
            sets[i].point[k].value = sets_asked[i].value[k];
            sets[i].point[k].scene = scene_of(i, sets_asked[i].value[k]);
        }
    }
}

/* ---- One point --------------------------------------------------------------------------------------------------- */

/* Swinging without and on the wall, and the crossover. */
static int32_t look_at_bending(study_point *p, study_string *s)
{
    study_response response = {0};
    double crossover[2] = {(double)NAN, (double)NAN};
    int32_t status = study_make(&p->scene, s);
    if (status >= 0) status = study_lowest(s, DMB_CONTACT_AS_IS, STUDY_MODES, p->on_wall);
    if (status >= 0) status = study_respond(s, &p->scene, 0.5, 50.0, 250, 0, &response);
    if (status >= 0) study_crossover(&response, 1.0, 1.0, crossover);
    p->crossover = crossover[0];
    study_response_free(&response);
    return status;
}

static int32_t look_at_open_bending(study_point *p, study_string *s)
{
    study_scene scene = p->scene;
    scene.alone = 1;
    const int32_t status = study_make(&scene, s);
    return status < 0 ? status : study_lowest(s, DMB_CONTACT_AS_IS, STUDY_MODES, p->bending);
}

/* The same string with two coordinates a node has no other modes than those along and around. */
static int32_t look_at_stretch(study_point *p, study_string *s)
{
    study_scene scene = p->scene;
    double lowest[2];
    scene.alone = 1;
    scene.kind = DMB_PIPE_AXIAL_TORSIONAL;
    int32_t status = study_make(&scene, s);
    if (status >= 0) status = study_lowest(s, DMB_CONTACT_AS_IS, 2, lowest);
    if (status < 0) return status;
    p->torsional = lowest[0];
    p->axial = lowest[1];
    return DMB_OK;
}

/* What the head has to do while the string slides into the hole and turns. */
static int32_t look_at_head(study_point *p, study_string *s)
{
    dmb_static_options options = dmb_static_options_default();
    dmb_drive_state feed = dmb_drive_state_default(), rotation = dmb_drive_state_default();
    options.slip_axial = STUDY_FEED;
    options.slip_rotation = STUDY_ROTATION;
    int32_t status = study_make(&p->scene, s);
    if (status >= 0) status = dmb_analysis_static(s->sim, &options, NULL);
    if (status >= 0) status = dmb_query_drive(s->sim, s->drive[0], &feed);
    if (status >= 0) status = dmb_query_drive(s->sim, s->drive[1], &rotation);
    p->thrust = feed.force;
    p->torque = rotation.force;
    return status;
}

void study_point_work(void *context)
{
    static int32_t (*const looks[])(study_point *, study_string *) = {look_at_bending, look_at_open_bending,
                                                                      look_at_stretch, look_at_head};
    study_point *p = context;
    for (size_t i = 0; i < sizeof looks / sizeof looks[0] && p->status >= 0; ++i) {
        study_string s = {0};
        p->status = looks[i](p, &s);
        if (p->status < 0) (void)snprintf(p->message, sizeof p->message, "%s", study_message(&s));
        study_free(&s);
    }
}

/* ---- Report ------------------------------------------------------------------------------------------------------ */

static void print_point(const study_point *p)
{
    printf("  %9g  %11.5e %11.5e  %8.4f  %8.4f  %8.4f %8.4f  %8.3f %8.3f", p->value, p->bending[0],
           p->bending[STUDY_MODES - 1], p->torsional, p->axial, p->on_wall[0], p->on_wall[STUDY_MODES - 1], p->torque,
           1e-3 * p->thrust);
    if (isnan(p->crossover))
        printf("      none\n");
    else
        printf("  %8.3f\n", p->crossover);
}

void study_sets_print(const study_set sets[STUDY_SETS])
{
    printf("Parameter studies\n"
           "             bending without a wall    around     along   on the wall, Hz     torque   thrust  crossover\n"
           "             first, Hz   fifth, Hz         Hz        Hz     1st     10th         Nm       kN         Hz\n");
    for (int i = 0; i < STUDY_SETS; ++i) {
        printf("  %s\n", sets_asked[i].title);
        for (int k = 0; k < sets[i].count; ++k) print_point(sets[i].point + k);
    }
    printf("\n");
}

int study_sets_write(const char *folder, const study_set sets[STUDY_SETS])
{
    FILE *file = study_table(folder, "parameters.csv",
                             "parameter,value,bending 1 [Hz],bending 2 [Hz],bending 3 [Hz],bending 4 [Hz],"
                             "bending 5 [Hz],torsional [Hz],axial [Hz],on the wall [Hz],torque [N m],thrust [N],"
                             "crossover [Hz]");
    if (file == NULL) return 1;
    for (int i = 0; i < STUDY_SETS; ++i)
        for (int k = 0; k < sets[i].count; ++k) {
            const study_point *p = sets[i].point + k;
            fprintf(file, "%s,%g", sets_asked[i].name, p->value);
            for (int order = 0; order < STUDY_MODES; order += 2) fprintf(file, ",%.9g", p->bending[order]);
            fprintf(file, ",%.9g,%.9g,%.9g,%.9g,%.9g,%.6g\n", p->torsional, p->axial, p->on_wall[0], p->torque,
                    p->thrust, p->crossover);
        }
    return fclose(file) != 0;
}
