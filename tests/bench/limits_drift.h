/* The drift of a million steps, or of as many as asked for: energy, rotations off orthonormal, joints and supports off
 * their place. */
#ifndef BENCH_LIMITS_DRIFT_H
#define BENCH_LIMITS_DRIFT_H

#include <stdio.h>
#include <stdlib.h>

#include "limits_scenes.h"

enum { DRIFT_SAMPLES = 1000 };

typedef struct drift_choice {
    const char *only; /* name of the one to run, or NULL for all */
    double tolerance; /* [-] of Newton; 0: it follows the error of the step */
    int steps;        /* between samples */
} drift_choice;

typedef struct drifter {
    const char *name;
    void (*describe)(limit_scene *);
    double step, radius;
    int statics; /* 1: begins with its static start */
} drifter;

/* ---- Scenes --------------------------------------------------------------------------------------------------------
 */

static dmb_id drift_string; /* of the scene described last; none in mechanisms */
static uint32_t drift_pipes;

static void drift_keep(dmb_id string, uint32_t pipes)
{
    drift_string = string;
    drift_pipes = pipes;
}

/* Bar of three elements held at one end, ringing in all its modes: that of physics_dynamic_axial. */
static void drift_bar(limit_scene *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = limit_pipe();
    limit_open(s, 0.0, 0.0);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.elements = 3;
    string.start_free = DMB_FREE_NONE;
    string.velocity[0] = 1.0;
    string.velocity[3] = 2.0;
    drift_keep(limit_string(s, &string, &pipe, 1), 1);
}

/* Four pipes in free flight, turning about their axis and across it. */
static void drift_free(limit_scene *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = limit_pipe();
    limit_open(s, 0.0, 0.0);
    string.start_free = DMB_FREE_ALL;
    string.velocity[3] = 20.0;
    string.velocity[5] = 3.0;
    drift_keep(limit_string(s, &string, &pipe, 4), 4);
}

static void drift_swing(limit_scene *s)
{
    drift_keep((dmb_id){0, 0}, 0);
    limit_pendulum(s);
}

/* Four pipes on the floor of a hole that falls by 5 degrees, held by friction alone, mu 0.35 against 0.087. */
static void drift_lying(limit_scene *s, int32_t law)
{
    const double slope = 5.0 * BENCH_PI / 180.0;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = limit_pipe();
    limit_open(s, 9.81 * sin(slope), -9.81 * cos(slope));
    wall.friction_law = law;
    wall.bristle_damping = 10.0;
    limit_note(s, dmb_model_add_wall(s->model, &wall, NULL));
    string.start_free = DMB_FREE_ALL;
    string.offset[1] = -0.5 * (0.094 - 0.073);
    pipe.damping_time = 1e-4;
    drift_keep(limit_string(s, &string, &pipe, 4), 4);
}

static void drift_smoothed(limit_scene *s)
{
    drift_lying(s, DMB_FRICTION_COULOMB);
}

static void drift_bristle(limit_scene *s)
{
    drift_lying(s, DMB_FRICTION_BRISTLE);
}

/* Four pipes turned at 60 rpm on the floor of their hole. */
static void drift_turning(limit_scene *s)
{
    static const double turns[][3] = {{0.0, 1.0, 2.0 * BENCH_PI}};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = limit_pipe();
    limit_open(s, 0.0, -9.81);
    limit_note(s, dmb_model_add_wall(s->model, &wall, NULL));
    string.start_free = DMB_FREE_RX;
    pipe.eccentricity = 1e-3;
    pipe.damping_time = 1e-4;
    const dmb_id id = limit_string(s, &string, &pipe, 4);
    limit_drive(s, id, DMB_RX, limit_time_function(s, 0.0, turns, 1));
    drift_keep(id, 4);
}

static const drifter drifters[] = {
    {"bar", drift_bar, 5e-5, 1.0, 0},
    {"free_string", drift_free, 2e-4, 1.0, 0},
    {"free_string", drift_free, 2e-4, 0.8, 0},
    {"free_string", drift_free, 1e-3, 1.0, 0},
    {"free_string", drift_free, 1e-3, 0.8, 0},
    {"pendulum", drift_swing, 1e-3, 1.0, 0},
    {"pendulum", drift_swing, 1e-3, 0.8, 0},
    {"lying_coulomb", drift_smoothed, 1e-3, 0.8, 0},
    {"lying_bristle", drift_bristle, 1e-3, 0.8, 0},
    {"turning", drift_turning, 1e-3, 0.8, 1},
};

/* ---- Measures ------------------------------------------------------------------------------------------------------
 */

typedef struct drifted {
    double first;     /* [J] kinetic and stored, at the start */
    double scale;     /* [J] of motion, or put in, or given by gravity */
    double energy;    /* [-] largest change of kinetic and stored energy over the scale, where nothing is put in */
    double last;      /* [-] change at the end */
    double balance;   /* [-] of the ledger at the end */
    double ortho;     /* [-] largest element of R^T R - 1 */
    double violation; /* [m] of joints; of strings held at the rig end, of its place across */
    double crept;     /* [m] of the far end along the hole in the second half */
    double half;      /* [m] where it was after the first half */
} drifted;

static double off_orthonormal(const double R[9])
{
    double most = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            const double dot = R[i] * R[k] + R[3 + i] * R[3 + k] + R[6 + i] * R[6 + k];
            most = fmax(most, fabs(dot - (i == k)));
        }
    return most;
}

static void look_at_string(const limit_scene *s, int sample, drifted *d)
{
    dmb_pose pose = dmb_pose_default();
    for (uint32_t i = 0; i < drift_pipes; ++i) {
        (void)dmb_query_pose(s->sim, dmb_station(drift_string, i, 1.0), &pose);
        d->ortho = fmax(d->ortho, off_orthonormal(pose.rotation));
    }
    if (sample == DRIFT_SAMPLES / 2) d->half = pose.displacement[0];
    d->crept = pose.displacement[0] - d->half;
}

static void look(const limit_scene *s, int sample, drifted *d)
{
    dmb_energy e = dmb_energy_default();
    dmb_statistics statistics = dmb_statistics_default();
    (void)dmb_query_energy(s->sim, &e);
    (void)dmb_query_statistics(s->sim, &statistics);
    const double now = e.kinetic + e.strain + e.gravity + e.contact;
    if (sample == 0) d->first = now;
    d->scale = fmax(d->scale, fmax(fmax(e.kinetic, e.input), fabs(e.gravity)));
    d->last = (now - d->first) / d->scale;
    d->energy = fmax(d->energy, fabs(d->last));
    d->balance = e.balance / d->scale;
    d->violation = fmax(d->violation, statistics.violation);
    if (drift_pipes > 0) look_at_string(s, sample, d);
}

static int32_t drift_one(const drifter *of, const drift_choice *choice, limit_scene *s, drifted *d)
{
    dmb_sim_options options = dmb_sim_options_default();
    memset(s, 0, sizeof *s);
    memset(d, 0, sizeof *d);
    options.spectral_radius = of->radius;
    options.newton_tolerance = choice->tolerance;
    of->describe(s);
    if (s->status >= 0) limit_note(s, dmb_model_compile(s->model, NULL));
    if (s->status >= 0) limit_note(s, dmb_sim_create(s->model, &options, &s->sim));
    if (s->status >= 0 && of->statics) limit_note(s, dmb_analysis_static(s->sim, NULL, NULL));
    if (s->status >= 0) look(s, 0, d);
    for (int k = 1; k <= DRIFT_SAMPLES && s->status >= 0; ++k) {
        for (int i = 0; i < choice->steps && s->status >= 0; ++i) limit_note(s, dmb_sim_step(s->sim, of->step, NULL));
        if (s->status >= 0) look(s, k, d);
    }
    return s->status;
}

static void print_drift(const drifter *of, const limit_scene *s, const drifted *d, FILE *csv, FILE *table)
{
    dmb_statistics n = dmb_statistics_default();
    if (s->sim) (void)dmb_query_statistics(s->sim, &n);
    const double mean = (double)n.iterations / fmax(1.0, (double)n.steps);
    printf("drift=%s dt=%g radius=%g status=%s t=%.6g steps=%llu iterations=%.3g worst=%u rejected=%llu energy=%.1e "
           "energy_end=%.1e balance=%.1e orthonormal=%.1e violation=%.1e crept=%.3e\n",
           of->name, of->step, of->radius, dmb_status_name(s->status), s->sim ? dmb_sim_time(s->sim) : 0.0,
           (unsigned long long)n.steps, mean, (unsigned)n.most_iterations, (unsigned long long)n.rejected, d->energy,
           d->last, d->balance, d->ortho, d->violation, d->crept);
    fflush(stdout);
    fprintf(csv, "%s,%.9g,%g,%s,%llu,%.6g,%u,%llu,%.3e,%.3e,%.3e,%.3e,%.3e,%.6e\n", of->name, of->step, of->radius,
            dmb_status_name(s->status), (unsigned long long)n.steps, mean, (unsigned)n.most_iterations,
            (unsigned long long)n.rejected, d->energy, d->last, d->balance, d->ortho, d->violation, d->crept);
    fprintf(table, "| %s | %g | %g | %.2f/%u | %llu | %.1e | %.1e | %.1e | %.1e | %.1e | %.1e |\n", of->name, of->step,
            of->radius, mean, (unsigned)n.most_iterations, (unsigned long long)n.rejected, d->energy, d->last,
            d->balance, d->ortho, d->violation, d->crept);
}

static int drift(FILE *csv, FILE *table, const drift_choice *choice)
{
    int failed = 0;
    fputs("drift,dt,radius,status,steps,iterations,worst,rejected,energy,energy_end,balance,orthonormal,violation,"
          "crept\n",
          csv);
    fputs(
        "\n| scene | dt s | r | iterations, worst | rejected | energy, most | at the end | balance | off orthonormal | "
        "violation m | crept m |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
        table);
    for (size_t i = 0; i < sizeof drifters / sizeof *drifters; ++i) {
        limit_scene s;
        drifted d;
        if (choice->only && strcmp(choice->only, drifters[i].name) != 0) continue;
        failed |= drift_one(drifters + i, choice, &s, &d) < 0;
        print_drift(drifters + i, &s, &d, csv, table);
        dmb_sim_destroy(&s.sim);
        dmb_model_destroy(&s.model);
    }
    return failed;
}

#endif
