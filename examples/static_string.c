/* How much force and torque does it take to push a string along its hole, or to turn it?
 *
 * An axial-torsional string of length L and weight w per metre lies in a horizontal hole. Sliding along, it needs
 *     F = mu w L + bit load,   and is shorter by   (mu w L^2/2 + load L)/(E A).
 * Turning on the point, it needs
 *     M = mu w L r + bit torque,   and is twisted by   (mu w r L^2/2 + torque L)/(G J).
 * The static analysis takes friction as if the string slid at a given speed, so that its direction is known. */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>

#include "command_line.h"

#define PIPES 100
#define LENGTH 1.5   /* [m] of a pipe */
#define OUTER 0.073  /* [m] */
#define INNER 0.055  /* [m] */
#define YOUNG 2.1e11 /* [Pa] */
#define FRICTION 0.3
#define BIT_LOAD 2960.0  /* [N] */
#define BIT_TORQUE 100.0 /* [N m] */

static int32_t add_drive(dmb_model *model, int32_t component, dmb_id *drive)
{
    const dmb_segment rest = dmb_segment_default(); /* a constant 0: the head holds still */
    dmb_drive_def def = dmb_drive_def_default();
    const int32_t status = dmb_model_add_time_function(model, &rest, 1, &def.time_function);
    def.component = component;
    return status < 0 ? status : dmb_model_add_drive(model, &def, drive);
}

typedef struct string_model {
    dmb_model *model;
    dmb_id string, feed, rotation;
} string_model;

static int32_t describe(double bit_load, double bit_torque, string_model *s)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    int32_t status = dmb_model_create(NULL, &s->model);
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.mu_static = wall.mu_dynamic = FRICTION;
    wall.smoothing_speed = 1e-9;
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.length = LENGTH;
    pipe.outer_diameter = OUTER;
    pipe.inner_diameter = INNER;
    pipe.young_modulus = YOUNG;
    if (status >= 0) status = dmb_model_add_wall(s->model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(s->model, &pipe, PIPES, &s->string);
    if (status >= 0) status = add_drive(s->model, DMB_X, &s->feed);
    if (status >= 0) status = add_drive(s->model, DMB_RX, &s->rotation);
    load.place = dmb_station(s->string, PIPES - 1, 1.0);
    load.force[0] = -bit_load;
    load.moment[0] = -bit_torque;
    if (status >= 0) status = dmb_model_add_load(s->model, &load, NULL);
    return status < 0 ? status : dmb_model_compile(s->model, NULL);
}

/* Force or torque of the head and motion of the far end, sliding along (slip > 0 in slip_axial) or turning. */
static int32_t solve(const string_model *s, int turning, double *effort, double *give, double *wall_force)
{
    dmb_static_options options = dmb_static_options_default();
    dmb_drive_state drive = dmb_drive_state_default();
    dmb_contact_total sum = dmb_contact_total_default();
    dmb_pose pose = dmb_pose_default();
    const dmb_place end = dmb_station(s->string, PIPES - 1, 1.0);
    dmb_sim *sim = NULL;
    int32_t status = dmb_sim_create(s->model, NULL, &sim);
    *(turning ? &options.slip_rotation : &options.slip_axial) = 1.0;
    if (status >= 0) status = dmb_analysis_static(sim, &options, NULL);
    if (status >= 0) status = dmb_query_drive(sim, turning ? s->rotation : s->feed, &drive);
    if (status >= 0) status = dmb_query_contact_total(sim, &sum);
    if (status >= 0) status = dmb_query_pose(sim, end, &pose);
    *give = -pose.displacement[0];
    if (status >= 0 && turning) {
        status = dmb_query_rotation(sim, end, give);
        *give = -*give;
    }
    *effort = drive.force;
    *wall_force = sum.normal_force;
    if (status < 0) fprintf(stderr, "%s: %s\n", dmb_status_text(status), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    return status;
}

static void report(const char *what, const char *unit, double found, double exact)
{
    printf("%-24s %14.7f %14.7f %s\n", what, found, exact, unit);
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "How much force and torque does it take to push a string along its hole, or to turn it?",
                            NULL, 0);
    const double pi = 3.14159265358979323846, L = PIPES * LENGTH, r = 0.5 * OUTER;
    const double A = 0.25 * pi * (OUTER * OUTER - INNER * INNER);
    const double J = pi / 32.0 * (pow(OUTER, 4.0) - pow(INNER, 4.0)), G = YOUNG / 2.6, w = 7850.0 * A * 9.81;
    string_model push = {0}, turn = {0};
    double force = 0.0, shortening = 0.0, torque = 0.0, twist = 0.0, wall_force = 0.0;
    int32_t status = describe(BIT_LOAD, 0.0, &push);
    if (status >= 0) status = describe(0.0, BIT_TORQUE, &turn);
    if (status >= 0) status = solve(&push, 0, &force, &shortening, &wall_force);
    if (status >= 0) status = solve(&turn, 1, &torque, &twist, &wall_force);
    if (status >= 0) {
        printf("%-24s %14s %14s\n", "", "found", "closed form");
        report("force on the wall", "N", wall_force, w * L);
        report("force to push", "N", force, FRICTION * w * L + BIT_LOAD);
        report("shortening", "mm", 1e3 * shortening, 1e3 * (0.5 * FRICTION * w * L + BIT_LOAD) * L / (YOUNG * A));
        report("torque to turn", "N m", torque, FRICTION * w * L * r + BIT_TORQUE);
        report("twist", "rad", twist, (0.5 * FRICTION * w * L * r + BIT_TORQUE) * L / (G * J));
    } else {
        fprintf(stderr, "%s%s\n", dmb_model_message(push.model), dmb_model_message(turn.model));
    }
    dmb_model_destroy(&push.model);
    dmb_model_destroy(&turn.model);
    return status < 0;
}
