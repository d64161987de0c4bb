#include <math.h>
#include <stdio.h>

#include "study.h"

enum { QUANTITIES = 9 };

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
        scene.pipe.length = value;
        scene.pipe.elements = (uint32_t)ceil(value); /* the wall touches nodes: no less often than with pipes of 1 m */
        break;
    case STUDY_ELEMENTS: scene.pipe.elements = (uint32_t)value; break;
    case STUDY_FRICTIONS:
        scene.wall.mu_static += value - scene.wall.mu_dynamic;
        scene.wall.mu_dynamic = value;
        break;
    case STUDY_HOLES: scene.wall.diameter = scene.pipe.outer_diameter + 2e-3 * value; break;
    case STUDY_MODULI: scene.pipe.young_modulus = 1e9 * value; break;
    default: scene.wall.stiffness = 1e6 * value; break;
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

/* Its position every half metre: the deepest place, and the first that is at the wall. */
static int32_t look_at_rest(study_point *p, const study_string *s)
{
    const double clearance = study_clearance(&p->scene), length = p->scene.pipe.length;
    const int places = (int)lround(2.0 * p->scene.pipes * length);
    p->touch = (double)NAN;
    for (int i = 1; i <= places; ++i) {
        const uint32_t pipe = (uint32_t)(ceil(0.5 * i / length) - 1.0); /* the end of one rather than the next */
        dmb_pose pose = dmb_pose_default();
        const int32_t status = dmb_query_pose(s->sim, dmb_station(s->string, pipe, 0.5 * i / length - pipe), &pose);
        if (status < 0) return status;
        p->sag = fmax(p->sag, -pose.position[2]);
        if (isnan(p->touch) && pose.position[2] <= -clearance) p->touch = 0.5 * i;
    }
    return DMB_OK;
}

static int32_t look_at_buckling(study_point *p, study_string *s)
{
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling *found = NULL;
    options.scale = DMB_SCALE_PART;
    options.part = s->push;
    options.follow = 0; /* eccentric masses keep the string from a sharp end of its equilibria */
    int32_t status = dmb_analysis_buckling(s->sim, &options, &found);
    if (status >= 0) status = dmb_buckling_factor(found, 0, &p->buckling);
    dmb_buckling_destroy(&found);
    return status;
}

static int32_t look_at_response(study_point *p, study_string *s)
{
    study_response response = {0};
    double crossover[2] = {(double)NAN, (double)NAN};
    const int32_t status = study_respond(s, &p->scene, 0.5, 50.0, 250, 4, &response);
    if (status >= 0) {
        const uint32_t most = study_peak(&response, STUDY_TOGETHER);
        study_crossover(&response, 1.0, 1.0, crossover);
        p->crossover = crossover[0];
        p->peak = response.frequency[most];
        p->amplitude = response.amplitude[(size_t)most * STUDY_CAUSES + STUDY_TOGETHER];
    }
    study_response_free(&response);
    return status;
}

/* The string at rest on the wall. */
static int32_t look_at_lying(study_point *p, study_string *s)
{
    int32_t status = study_make(&p->scene, s);
    if (status >= 0) status = look_at_rest(p, s);
    if (status >= 0) status = look_at_buckling(p, s);
    if (status >= 0) status = study_lowest(s, DMB_CONTACT_AS_IS, STUDY_MODES, p->on_wall);
    return status < 0 ? status : look_at_response(p, s);
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

/* Force and torque of the head while the string slides into the hole and turns. */
static int32_t look_at_head(study_point *p, study_string *s)
{
    dmb_static_options options = dmb_static_options_default();
    dmb_drive_state feed = dmb_drive_state_default(), rotation = dmb_drive_state_default();
    options.slip_axial = RIG_FEED;
    options.slip_rotation = STUDY_ROTATION;
    int32_t status = study_make(&p->scene, s);
    if (status >= 0) status = dmb_analysis_static(s->sim, &options, NULL);
    if (status >= 0) status = dmb_query_drive(s->sim, s->drive[0], &feed);
    if (status >= 0) status = dmb_query_drive(s->sim, s->drive[1], &rotation);
    p->thrust = feed.force;
    p->torque = rotation.force;
    options.slip_rotation = 0.0;
    if (status >= 0) status = dmb_analysis_static(s->sim, &options, NULL);
    if (status >= 0) status = dmb_query_drive(s->sim, s->drive[0], &feed);
    p->push = feed.force;
    return status;
}

void study_point_work(void *context)
{
    static int32_t (*const looks[])(study_point *, study_string *) = {look_at_lying, look_at_open_bending,
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

/* A number, or that there is none. */
static void print_number(int width, int digits, double value)
{
    if (isnan(value))
        printf(" %*s", width, "none");
    else
        printf(" %*.*f", width, digits, value);
}

static void print_point(const study_point *p)
{
    printf("  %5g  %9.3e %7.3f %7.3f %6.3f %6.3f", p->value, p->bending[0], p->torsional, p->axial, p->on_wall[0],
           p->on_wall[STUDY_MODES - 1]);
    printf(" %7.3f", 1e3 * p->sag);
    print_number(5, 2, p->touch);
    printf(" %7.2f %6.3f %6.3f %8.2f %6.3f %8.2f", p->torque, 1e-3 * p->thrust, 1e-3 * p->push, 1e-3 * p->buckling,
           p->peak, 1e3 * p->amplitude);
    print_number(6, 3, p->crossover);
    printf("\n");
}

static void take_quantities(const study_point *p, double values[QUANTITIES])
{
    const double taken[QUANTITIES] = {p->bending[0], p->torsional, p->axial,    p->on_wall[0], p->torque,
                                      p->thrust,     p->push,      p->buckling, p->amplitude};
    for (int n = 0; n < QUANTITIES; ++n) values[n] = taken[n];
}

/* Effect of each parameter: the largest over the smallest of each quantity in a study. */
static void print_ranges(const study_set sets[STUDY_SETS])
{
    printf(
        "  largest over smallest of each, in each study\n"
        "                               bending  around   along  1st on  torque  thrust    push buckling  largest\n");
    for (int i = 0; i < STUDY_SETS; ++i) {
        double low[QUANTITIES], high[QUANTITIES], values[QUANTITIES];
        take_quantities(sets[i].point, low);
        take_quantities(sets[i].point, high);
        for (int k = 1; k < sets[i].count; ++k) {
            take_quantities(sets[i].point + k, values);
            for (int n = 0; n < QUANTITIES; ++n) {
                low[n] = fmin(low[n], values[n]);
                high[n] = fmax(high[n], values[n]);
            }
        }
        printf("  %-27s", sets_asked[i].name);
        for (int n = 0; n < QUANTITIES; ++n) printf(" %*.3f", n < 7 ? 7 : 8, high[n] / low[n]);
        printf("\n");
    }
}

void study_sets_print(const study_set sets[STUDY_SETS])
{
    printf(
        "Parameter studies: one thing changed at a time of %u pipes of the rig\n"
        "  without a wall: first frequencies of bending, around, along; on the wall: first and tenth frequency\n"
        "  at rest: the deepest place below the hole's axis, and from where on it lies on the wall\n"
        "  head: torque and thrust when it slides in and turns, thrust when it slides in only, the bit's load "
        "included\n"
        "  buckling: the load on the bit, on top of that, under which the string at rest buckles (a free end that lies "
        "on\n"
        "    the wall does so under sqrt(EI w/r), w weight per metre, r clearance; the bit's weight holds it)\n"
        "  response: largest amplitude of the last pipe to all causes together, and the first crossover\n"
        "           bending  around   along  1st on   10th     sag touch  torque thrust   push buckling   peak     peak"
        "  cross\n"
        "                Hz      Hz      Hz     Hz     Hz      mm     m     N m     kN     kN       kN     Hz       mm"
        "     Hz\n",
        study_base().pipes);
    for (int i = 0; i < STUDY_SETS; ++i) {
        printf("  %s\n", sets_asked[i].title);
        for (int k = 0; k < sets[i].count; ++k) print_point(sets[i].point + k);
    }
    print_ranges(sets);
    printf("\n");
}

int study_sets_write(const char *folder, const study_set sets[STUDY_SETS])
{
    FILE *file = study_table(folder, "parameters.csv",
                             "parameter,value,bending 1 [Hz],bending 2 [Hz],bending 3 [Hz],bending 4 [Hz],"
                             "bending 5 [Hz],torsional [Hz],axial [Hz],first on the wall [Hz],tenth on the wall [Hz],"
                             "sag [m],touch [m],torque [N m],thrust [N],push [N],buckling [N],peak [Hz],"
                             "peak amplitude [m],crossover [Hz]");
    if (file == NULL) return 1;
    for (int i = 0; i < STUDY_SETS; ++i)
        for (int k = 0; k < sets[i].count; ++k) {
            const study_point *p = sets[i].point + k;
            const double values[] = {p->torsional, p->axial,    p->on_wall[0], p->on_wall[STUDY_MODES - 1],
                                     p->sag,       p->touch,    p->torque,     p->thrust,
                                     p->push,      p->buckling, p->peak,       p->amplitude,
                                     p->crossover};
            fprintf(file, "%s,%g", sets_asked[i].name, p->value);
            for (int order = 0; order < STUDY_MODES; order += 2) fprintf(file, ",%.17g", p->bending[order]);
            for (size_t n = 0; n < sizeof values / sizeof values[0]; ++n) fprintf(file, ",%.17g", values[n]);
            fprintf(file, "\n");
        }
    return fclose(file) != 0;
}
