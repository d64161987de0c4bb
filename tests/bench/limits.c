/* Where it stays stable: scenes, easy and hard, in steps of 10 us to 0.1 s at three spectral radii; and what a million
 * steps drift by. usage: limits ROWS.csv TABLE.md [grid | drift [NAME [TOLERANCE STEPS]]]. One line a result;
 * tests/bench/run calls it. TOLERANCE of Newton, default 1e-12, 0: it follows the error of the step. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "limits_drift.h"
#include "limits_scenes.h"

/* ---- One run of the grid -------------------------------------------------------------------------------------------
 */

enum { STEP_COUNT = 9, RADIUS_COUNT = 3, MOST_CALLS = 3000, MOST_ITERATIONS = 60000 };
static const double radii[RADIUS_COUNT] = {1.0, 0.8, 0.5};
/* [-] of the energy that goes through, above what was there and put in: from here on a run counts as unstable */
static const double most_excess = 0.01;

typedef struct result {
    int kind;
    double step, radius;
    int32_t status; /* DMB_..., of the call that failed, or of the last one */
    int used_up;    /* 1: stopped at MOST_ITERATIONS */
    int finite;
    double time;    /* [s] reached */
    double horizon; /* [s] */
    uint64_t calls, steps, iterations, rejected;
    uint32_t worst; /* [-] iterations */
    double excess;  /* [-] most mechanical energy at any time above that of the start and what drives and loads have put
                       in, over the energy that went through: nothing else in a scene may add to it */
    double error;   /* [-] of C, in parts of the speed driven; NaN of others */
    double balance; /* [-] open at the end, likewise */
    char message[160];
} result;

/* "stable", or what is wrong. */
static const char *verdict(const result *r)
{
    if (r->status < 0) return "refused";
    if (!r->finite) return "not_finite";
    if (r->used_up) return "used_up";
    return r->excess > most_excess ? "grows" : "stable";
}

typedef struct energies {
    dmb_energy first;
    double moved; /* [J] most that gravity, springs and motion held in turn */
    double most;  /* [J] excess */
} energies;

/* Energy that has gone through the scene, of motion that was there at the start too. */
static double through(const energies *e, const dmb_energy *now)
{
    return fmax(now->input + fmax(e->moved, e->first.kinetic), 1e-30);
}

static double stored(const dmb_energy *e)
{
    return e->kinetic + e->strain + e->gravity + e->contact;
}

static int watch(const limit_scene *s, energies *e, result *r)
{
    dmb_energy now = dmb_energy_default();
    if (dmb_query_energy(s->sim, &now) < 0) return 0;
    e->moved = fmax(e->moved, fabs(now.gravity - e->first.gravity));
    e->most = fmax(e->most, stored(&now) - stored(&e->first) - now.drives - now.loads);
    r->excess = e->most / through(e, &now);
    r->balance = fabs(now.balance) / through(e, &now);
    return isfinite(now.kinetic) && isfinite(now.strain) && isfinite(now.balance);
}

static void walk(limit_scene *s, result *r)
{
    energies e;
    memset(&e, 0, sizeof e);
    e.first = dmb_energy_default();
    r->status = dmb_query_energy(s->sim, &e.first);
    const double steps = floor(r->horizon / r->step + 0.5);
    for (double k = 1.0; k <= steps && r->status >= 0 && r->finite && !r->used_up; k += 1.0) {
        dmb_step_report report = dmb_step_report_default();
        r->status = dmb_sim_step(s->sim, k * r->step - dmb_sim_time(s->sim), &report);
        r->calls++;
        r->steps += report.steps;
        r->rejected += report.rejected;
        r->iterations += report.iterations;
        if (r->status >= 0 && report.most_iterations > r->worst) r->worst = report.most_iterations;
        r->finite = watch(s, &e, r);
        r->used_up = r->iterations > MOST_ITERATIONS;
    }
}

/* Message without the commas that would part it in CSV. */
static void note_message(const limit_scene *s, result *r)
{
    const char *text = s->sim ? dmb_sim_message(s->sim) : s->model ? dmb_model_message(s->model) : "";
    (void)snprintf(r->message, sizeof r->message, "%s", r->status < 0 ? text : "");
    for (char *c = r->message; *c; ++c)
        if (*c == ',' || *c == '"') *c = ';';
}

static result try_one(int kind, double step, double radius)
{
    limit_scene s;
    result r;
    dmb_sim_options options = dmb_sim_options_default();
    memset(&r, 0, sizeof r);
    r.kind = kind;
    r.step = step;
    r.radius = radius;
    r.finite = 1;
    r.horizon = fmax(step, fmin(limit_times[kind], MOST_CALLS * step));
    options.spectral_radius = radius;
    r.status = limit_make(&s, kind);
    if (r.status >= 0) r.status = limit_start(&s, &options);
    if (r.status >= 0) walk(&s, &r);
    r.time = s.sim ? dmb_sim_time(s.sim) : 0.0;
    r.error = r.status >= 0 ? limit_error(&s, r.time) : (double)NAN;
    note_message(&s, &r);
    dmb_sim_destroy(&s.sim);
    dmb_model_destroy(&s.model);
    return r;
}

/* ---- Grid ----------------------------------------------------------------------------------------------------------
 */

static double step_of(int i)
{
    return 1e-5 * pow(10.0, 0.5 * i);
}

static double mean_iterations(const result *r)
{
    return (double)r->iterations / fmax(1.0, (double)r->steps);
}

static void print_result(const result *r, FILE *csv)
{
    printf("scene=%s dt=%.3g radius=%g verdict=%s status=%s t=%.4g horizon=%.4g calls=%llu steps=%llu iterations=%.3g "
           "worst=%u rejected=%llu excess=%.1e balance=%.1e error=%.1e message=\"%s\"\n",
           limit_names[r->kind], r->step, r->radius, verdict(r), dmb_status_name(r->status), r->time, r->horizon,
           (unsigned long long)r->calls, (unsigned long long)r->steps, mean_iterations(r), (unsigned)r->worst,
           (unsigned long long)r->rejected, r->excess, r->balance, r->error, r->message);
    fflush(stdout);
    fprintf(csv, "%s,%.9g,%g,%s,%s,%.9g,%.9g,%llu,%llu,%.6g,%u,%llu,%.3e,%.3e,%.3e,%s\n", limit_names[r->kind], r->step,
            r->radius, verdict(r), dmb_status_name(r->status), r->time, r->horizon, (unsigned long long)r->calls,
            (unsigned long long)r->steps, mean_iterations(r), (unsigned)r->worst, (unsigned long long)r->rejected,
            r->excess, r->balance, r->error, r->message);
}

/* "1.9/7", with "+12" rejected steps in 1000, in brackets where it is not stable. */
static void write_cell(const result *r, FILE *table)
{
    const double rejected = 1e3 * (double)r->rejected / fmax(1.0, (double)r->calls);
    const int stable = strcmp(verdict(r), "stable") == 0;
    fprintf(table, " %s%.1f/%u", stable ? "" : "**", mean_iterations(r), (unsigned)r->worst);
    if (r->rejected > 0) fprintf(table, " +%.3g", rejected);
    fprintf(table, "%s |",
            stable                             ? ""
            : strcmp(verdict(r), "grows") == 0 ? " grows**"
            : r->used_up                       ? " used up**"
                                               : " refused**");
}

static int grid(FILE *csv, FILE *table)
{
    int failed = 0;
    fputs(
        "scene,dt,radius,verdict,status,t,horizon,calls,steps,iterations,worst,rejected,excess,balance,error,message\n",
        csv);
    fputs("| scene | r |", table);
    for (int i = 0; i < STEP_COUNT; ++i) fprintf(table, " %.2g |", step_of(i));
    fputs(" largest excess |\n|---|---|", table);
    for (int i = 0; i <= STEP_COUNT; ++i) fputs("---|", table);
    for (int kind = 0; kind < LIMIT_COUNT; ++kind)
        for (int k = 0; k < RADIUS_COUNT; ++k) {
            double excess = 0.0;
            fprintf(table, "\n| %s | %g |", limit_names[kind], radii[k]);
            for (int i = 0; i < STEP_COUNT; ++i) {
                const result r = try_one(kind, step_of(i), radii[k]);
                print_result(&r, csv);
                write_cell(&r, table);
                excess = fmax(excess, r.excess);
                failed |= strcmp(verdict(&r), "stable") != 0;
            }
            fprintf(table, " %.0e |", excess);
        }
    fputs("\n", table);
    return failed;
}

/* ---- Denormal numbers ----------------------------------------------------------------------------------------------
 */

/* [s] of processor time for 2000 steps of 100 pipes that a thick fluid brakes, thrown with `speed`. */
static double time_braked(double speed)
{
    limit_scene s;
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_string_def string = dmb_string_def_default();
    const dmb_pipe_def pipe = limit_pipe();
    memset(&s, 0, sizeof s);
    limit_open(&s, 0.0, 0.0);
    environment.gravity[2] = 0.0;
    environment.axial_damping = environment.lateral_damping = 10.0;
    limit_note(&s, dmb_model_set_environment(s.model, &environment));
    string.start_free = DMB_FREE_ALL;
    for (int i = 0; i < 3; ++i) string.velocity[i] = speed;
    (void)limit_string(&s, &string, &pipe, 100);
    limit_note(&s, dmb_model_compile(s.model, NULL));
    limit_note(&s, dmb_sim_create(s.model, NULL, &s.sim));
    const clock_t begin = clock();
    for (int i = 0; i < 2000; ++i) limit_note(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    const double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    if (s.status < 0) fprintf(stderr, "limits: %s\n", dmb_status_text(s.status));
    dmb_sim_destroy(&s.sim);
    dmb_model_destroy(&s.model);
    return s.status < 0 ? (double)NAN : seconds;
}

/* Speeds that are denormal numbers from the start, and such that are not: hard case 16. */
static int denormals(void)
{
    double ratio[3];
    for (int i = 0; i < 3; ++i) {
        const double usual = time_braked(1.0);
        ratio[i] = time_braked(1e-309) / usual;
    }
    const double low = fmin(ratio[0], fmin(ratio[1], ratio[2])), high = fmax(ratio[0], fmax(ratio[1], ratio[2]));
    printf("denormals=on time_over_usual=%.3g lowest=%.3g highest=%.3g\n", ratio[0] + ratio[1] + ratio[2] - low - high,
           low, high);
    return !(high > 0.0);
}

int main(int count, char **words)
{
    if (count < 3) return fputs("usage: limits ROWS.csv TABLE.md [grid | drift [NAME [TOLERANCE STEPS]]]\n", stderr), 2;
    FILE *csv = fopen(words[1], "w"), *table = fopen(words[2], "w");
    if (!csv || !table) return fputs("limits: cannot write\n", stderr), 2;
    const int only_drift = count > 3 && strcmp(words[3], "drift") == 0;
    const int only_grid = count > 3 && strcmp(words[3], "grid") == 0;
    const drift_choice choice = {count > 4 ? words[4] : NULL, count > 5 ? atof(words[5]) : 1e-12,
                                 count > 6 ? atoi(words[6]) / DRIFT_SAMPLES : 1000};
    int failed = 0;
    if (!only_drift) failed |= grid(csv, table);
    if (!only_grid) failed |= drift(csv, table, &choice);
    if (!only_grid && count <= 4) failed |= denormals();
    (void)fclose(csv);
    (void)fclose(table);
    return failed;
}
