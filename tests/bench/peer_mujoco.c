/* MuJoCo on scenes C and B. usage: peer_mujoco CSV [C] [B]   (default: both)
 * It has no elastic beams: the tube becomes 96 equal rigid bodies in a chain (its XML reader nests no deeper), each
 * joint three hinges with springs GJ/L, EI/L, EI/L (the first to the drive, over half a body, twice that), or one ball
 * joint with EI/L in all directions. No stretch, no shear. Its springs act explicitly whatever the integrator. Wall of
 * B: the library's own law at the ends of the bodies, put on as a force from outside; or MuJoCo's contact solver with
 * capsules in a prism of planes, since a hole is not convex. */
#define _POSIX_C_SOURCE 200809L

#include <mujoco/mujoco.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "peer_library.h"

#define OUTER 0.073
#define INNER 0.059
#define HOLE 0.094
#define SHEAR_MODULUS (BENCH_YOUNG / (2.0 * (1.0 + BENCH_POISSON)))

#define TUBE 100.0
#define BODY_LENGTH (TUBE / BODIES)

enum { BODIES = 96, PLANES = 24, ELEMENTS = 100 };
enum { WALL_NONE = 0, WALL_LAW = 1, WALL_PLANES = 2 };

static yardstick unit;
static result_table rows;
static int failures;

typedef struct chain_method {
    double step; /* [s] */
    const char *integrator;
    int ball; /* 1: ball joints, 0: three hinges each */
    int wall;
} chain_method;

typedef struct section {
    double line_mass, area_moment, bending, torsion; /* [kg/m], [m4], [N m2], [N m2] */
} section;

static section tube(void)
{
    const double inertia = BENCH_PI / 64.0 * (pow(OUTER, 4.0) - pow(INNER, 4.0));
    const double area = BENCH_PI / 4.0 * (OUTER * OUTER - INNER * INNER);
    const section s = {BENCH_DENSITY * area, inertia, BENCH_YOUNG * inertia, SHEAR_MODULUS * 2.0 * inertia};
    return s;
}

/* ---- The model, in MuJoCo's XML ---------------------------------------------------------------------------------- */

static void write_joint(FILE *xml, const chain_method *how, int first)
{
    const section s = tube();
    const double bend = (first ? 2.0 : 1.0) * s.bending / BODY_LENGTH;
    const double twist = (first ? 2.0 : 1.0) * s.torsion / BODY_LENGTH;
    if (how->ball && !first) {
        fprintf(xml, "<joint type='ball' stiffness='%.17g'/>", bend);
        return;
    }
    fprintf(xml, "<joint type='hinge' axis='1 0 0' stiffness='%.17g'/>", twist);
    fprintf(xml, "<joint type='hinge' axis='0 1 0' stiffness='%.17g'/>", bend);
    fprintf(xml, "<joint type='hinge' axis='0 0 1' stiffness='%.17g'/>", bend);
}

static void write_planes(FILE *xml)
{
    for (int i = 0; i < PLANES; i++) {
        const double angle = 2.0 * BENCH_PI * i / PLANES, y = cos(angle), z = sin(angle);
        fprintf(xml, "<geom type='plane' size='0 0 1' pos='0 %.17g %.17g' zaxis='0 %.17g %.17g'/>\n", 0.5 * HOLE * y,
                0.5 * HOLE * z, -y, -z);
    }
}

/* Contacts as stiff and damped for a metre of pipe as the library's wall: MuJoCo wants both over the mass. */
static void write_model(FILE *xml, const chain_method *how)
{
    const section s = tube();
    const double mass = s.line_mass * BODY_LENGTH, about = 2.0 * BENCH_DENSITY * s.area_moment * BODY_LENGTH;
    const double across = mass * BODY_LENGTH * BODY_LENGTH / 12.0 + 0.5 * about;
    fprintf(xml, "<mujoco><compiler angle='radian'/><size njmax='4000' nconmax='1000'/>\n");
    fprintf(xml, "<option timestep='%.17g' integrator='%s' gravity='0 0 %g'>", how->step, how->integrator,
            how->wall == WALL_NONE ? 0.0 : -9.81);
    fprintf(xml, "<flag contact='%s'/></option>\n", how->wall == WALL_PLANES ? "enable" : "disable");
    fprintf(xml,
            "<default><geom friction='0.3 0 0' condim='3' contype='2' conaffinity='1' solref='%.17g %.17g'/></default>",
            -1e6 / s.line_mass, -1e3 / s.line_mass);
    fprintf(xml, "<worldbody>\n");
    if (how->wall == WALL_PLANES) write_planes(xml);
    for (int i = 0; i < BODIES; i++) {
        fprintf(xml, "<body pos='%.17g 0 0'>", i > 0 ? BODY_LENGTH : 0.0);
        fprintf(xml, "<inertial pos='%.17g 0 0' mass='%.17g' diaginertia='%.17g %.17g %.17g'/>", 0.5 * BODY_LENGTH,
                mass, about, across, across);
        write_joint(xml, how, i == 0);
        if (how->wall == WALL_PLANES)
            fprintf(xml, "<geom type='capsule' size='%.17g' fromto='0 0 0 %.17g 0 0' contype='1' conaffinity='2'/>",
                    0.5 * OUTER, BODY_LENGTH);
        fputc('\n', xml);
    }
    for (int i = 0; i < BODIES; i++) fprintf(xml, "</body>");
    fprintf(xml, "</worldbody></mujoco>\n");
}

/* MuJoCo reads files: one in the present folder, gone at once. */
static mjModel *make_model(const chain_method *how)
{
    char name[] = "peer_mujoco_XXXXXX", error[500] = "no file";
    const int file = mkstemp(name);
    FILE *const xml = file < 0 ? NULL : fdopen(file, "w");
    mjModel *model = NULL;
    if (xml) {
        write_model(xml, how);
        if (fclose(xml) == 0) model = mj_loadXML(name, NULL, error, sizeof error);
        remove(name);
    }
    if (!model) fprintf(stderr, "peer_mujoco: %s\n", error);
    return model;
}

/* ---- Forces from outside ----------------------------------------------------------------------------------------- */

/* [rad] of the drive: C and B a cubic step of the speed, B* a cosine. */
static double driven_angle(int kind, double time)
{
    const double t = fmin(time, 1.0), rest = 2.0 * BENCH_PI * (time - t);
    if (kind == SCENE_B_COSINE) return BENCH_PI * t - sin(BENCH_PI * t) + rest;
    return 2.0 * BENCH_PI * (t * t * t - 0.5 * t * t * t * t) + rest;
}

/* The first spring hangs on the drive: where it rests moves. */
static void drive(mjModel *model, int kind, double time)
{
    model->qpos_spring[0] = driven_angle(kind, time);
}

/* Wall's force on the end of a body, and its normal part: Kelvin-Voigt without pull, Coulomb friction smoothed as the
 * library's: mu v/sqrt(v^2 + v_eps^2), at the point of contact. */
static double wall_force(const double x[3], const double velocity[6], double length, double force[3], double moment[3])
{
    const double e = hypot(x[1], x[2]), depth = e - 0.5 * (HOLE - OUTER), radius = 0.5 * OUTER;
    memset(force, 0, 3 * sizeof *force);
    memset(moment, 0, 3 * sizeof *moment);
    if (!(depth > 0.0)) return 0.0;
    const double n[3] = {0.0, x[1] / e, x[2] / e}, r[3] = {0.0, radius * n[1], radius * n[2]};
    const double *w = velocity, *v = velocity + 3;
    double slip[3] = {v[0] + w[1] * r[2] - w[2] * r[1], v[1] - w[0] * r[2], v[2] + w[0] * r[1]};
    const double rate = n[1] * v[1] + n[2] * v[2];
    const double normal = fmax(0.0, length * (1e6 * depth + 1e3 * rate));
    const double through = slip[1] * n[1] + slip[2] * n[2];
    for (int i = 1; i < 3; i++) slip[i] -= through * n[i];
    const double speed = sqrt(slip[0] * slip[0] + slip[1] * slip[1] + slip[2] * slip[2] + 1e-4);
    for (int i = 0; i < 3; i++) force[i] = -normal * n[i] - 0.3 * normal * slip[i] / speed;
    mju_cross(moment, r, force);
    return normal;
}

/* At the ends of all bodies; half a length at the last. Returns the sum of normal forces. */
static double press(const mjModel *model, mjData *data)
{
    double sum = 0.0;
    for (int i = 1; i <= BODIES; i++) {
        double end[3], arm[3], velocity[6], force[3], moment[3];
        const double tip[3] = {0.5 * BODY_LENGTH, 0.0, 0.0}; /* from the centre of mass */
        mju_rotVecMat(arm, tip, data->xmat + 9 * i);
        mju_add3(end, data->xipos + 3 * i, arm);
        mj_objectVelocity(model, data, mjOBJ_BODY, i, velocity, 0); /* of the centre of mass, world axes */
        double swing[3];
        mju_cross(swing, velocity, arm);
        mju_addTo3(velocity + 3, swing);
        sum += wall_force(end, velocity, (i == BODIES ? 0.5 : 1.0) * BODY_LENGTH, force, moment);
        mju_cross(swing, arm, force);
        mju_addTo3(moment, swing);
        mju_copy3(data->xfrc_applied + 6 * i, force);
        mju_copy3(data->xfrc_applied + 6 * i + 3, moment);
    }
    return sum;
}

/* ---- A run ------------------------------------------------------------------------------------------------------- */

static double contact_total(const mjModel *model, const mjData *data)
{
    double sum = 0.0, force[6];
    for (int i = 0; i < data->ncon; i++) {
        mj_contactForce(model, data, i, force);
        sum += force[0];
    }
    return sum;
}

/* The same questions as those of scene_ask to the library. */
static void ask_chain(const mjModel *model, mjData *data, const chain_method *how, int kind, double values[2])
{
    double velocity[6], rotation = 0.0;
    mj_forward(model, data);
    if (kind == SCENE_C) {
        mj_objectVelocity(model, data, mjOBJ_BODY, BODIES, velocity, 1);
        values[0] = velocity[0];
        values[1] = (double)NAN;
        return;
    }
    for (int i = 0; i < BODIES; i++) rotation += data->qpos[3 * i]; /* joints bend little: turns add up */
    values[0] = rotation;
    values[1] = 1e3 * (data->xipos[3 * BODIES + 2] + 0.5 * BODY_LENGTH * data->xmat[9 * BODIES + 6]);
    if (kind == SCENE_B_COSINE) values[1] = how->wall == WALL_LAW ? press(model, data) : contact_total(model, data);
}

/* MuJoCo would write a file MUJOCO_LOG.TXT; what it warns of is counted in its data. */
static void ignore_warning(const char *text)
{
    (void)text;
}

/* 0 if the chain blew up: MuJoCo then starts anew by itself. */
static int run_chain(mjModel *model, mjData *data, const chain_method *how, int kind, double end)
{
    const long steps = lround(end / how->step);
    for (long k = 0; k < steps; k++) {
        if (strcmp(how->integrator, "RK4") == 0) { /* held over the step: its middle keeps second order */
            drive(model, kind, data->time + 0.5 * how->step);
            mj_step(model, data);
        } else {
            drive(model, kind, data->time);
            mj_step1(model, data);
            if (how->wall == WALL_LAW) press(model, data);
            mj_step2(model, data);
        }
        if (data->warning[mjWARN_BADQACC].number || data->warning[mjWARN_BADQPOS].number ||
            data->warning[mjWARN_BADQVEL].number)
            return 0;
    }
    return 1;
}

static void report_chain(int kind, const chain_method *how, double end, const double reference[2], const char *name)
{
    static const char *const walls[] = {"none", "law", "planes"};
    char setting[96], kinds[2][64];
    double values[2] = {0.0, 0.0};
    peer_row found;
    memset(&found, 0, sizeof found);
    snprintf(setting, sizeof setting, "dt=%g;integrator=%s;joints=%s;wall=%s", how->step, how->integrator,
             how->ball ? "ball" : "hinges", walls[how->wall]);
    mjModel *const model = make_model(how);
    mjData *const data = model ? mj_makeData(model) : NULL;
    const double begin = processor_time();
    const int good = data && run_chain(model, data, how, kind, end);
    found.seconds = processor_time() - begin;
    if (good) ask_chain(model, data, how, kind, values);
    if (data) mj_deleteData(data);
    if (model) mj_deleteModel(model);
    if (!data) ++failures;
    if (!good) {
        printf("scene=%s code=MuJoCo %s unstable\n", scene_names[kind], setting);
        return;
    }
    yardstick_measure(&unit);
    found.code = "MuJoCo";
    found.version = mj_versionString();
    found.scene = scene_names[kind];
    found.setting = setting;
    found.elements = BODIES;
    found.end = end;
    found.steps = end / how->step;
    found.residuals = found.tangents = (double)NAN;
    found.yardstick = yardstick_value(&unit);
    for (int i = 0; i < 2; i++) {
        const char *const quantity = quantity_names[kind][i];
        const double difference = fabs(values[i] - reference[i]);
        found.error[i] = strstr(quantity, "_mm") ? difference : difference / fabs(reference[i]);
        snprintf(kinds[i], sizeof kinds[i], "%s_vs_%s", quantity, name);
        found.error_kind[i] = *quantity ? kinds[i] : NULL;
    }
    peer_row_report(&rows, &found);
}

/* ---- The plan ---------------------------------------------------------------------------------------------------- */

static void run_c(void)
{
    static const double steps[] = {5e-4, 2.5e-4, 1e-4};
    const double reference[2] = {exact_tip_speed(TUBE, 2.0), 1.0};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        const chain_method how = {steps[i], "Euler", 0, WALL_NONE};
        report_chain(SCENE_C, &how, 2.0, reference, "exact");
    }
    const chain_method others[] = {{2.5e-4, "RK4", 0, WALL_NONE}, {2.5e-4, "Euler", 1, WALL_NONE}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        report_chain(SCENE_C, &others[i], 2.0, reference, "exact");
}

/* The library's own answer, by small steps. */
static int library_at(double end, double values[2])
{
    method how = method_fixed(1.5625e-5, end);
    peer_row unused;
    scene s;
    memset(&s, 0, sizeof s);
    s.kind = SCENE_B;
    s.pipes = ELEMENTS;
    s.per_pipe = 1;
    s.length = TUBE / ELEMENTS;
    how.ledger = 0;
    const int good = scene_open(&s) >= 0 && library_measure(&s, &how, &unit, &unused, values);
    dmb_model_destroy(&s.model);
    return good;
}

static void run_b(void)
{
    const double given[2] = {9.3755, 10.115e3};
    const chain_method methods[] = {{5e-4, "Euler", 0, WALL_LAW},      {2.5e-4, "Euler", 0, WALL_LAW},
                                    {1e-4, "Euler", 0, WALL_LAW},      {5e-5, "Euler", 0, WALL_LAW},
                                    {2.5e-4, "implicit", 0, WALL_LAW}, {1e-4, "implicit", 0, WALL_LAW},
                                    {2.5e-4, "Euler", 0, WALL_PLANES}, {1e-4, "Euler", 0, WALL_PLANES}};
    double reference[2];
    if (!library_at(0.1, reference)) {
        ++failures;
        return;
    }
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
        report_chain(SCENE_B, &methods[i], 0.1, reference, "15.625us");
    report_chain(SCENE_B_COSINE, &methods[1], 2.0, given, "given");
}

static int is_wanted(const char *name, int count, char **words)
{
    for (int i = 2; i < count; ++i)
        if (strcmp(words[i], name) == 0) return 1;
    return count <= 2;
}

int main(int count, char **words)
{
    if (count < 2) return fputs("usage: peer_mujoco CSV [C] [B]\n", stderr), 2;
    mju_user_warning = ignore_warning;
    if (table_open(&rows, &unit, words[1]) != 0) return 2;
    if (is_wanted("C", count, words)) run_c();
    if (is_wanted("B", count, words)) run_b();
    return table_close(&rows, words[1]) != 0 ? 2 : failures > 0;
}
