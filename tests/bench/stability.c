/* How robust: 1000 random scenes out of a Latin hypercube, each with its static start and 0.2 s in fixed steps.
 * usage: stability [SEED [NUMBER [STEP]]]   (default: seed 1, all scenes; NUMBER: that scene alone, step by step; STEP
 * [s] takes the place of the one drawn). Prints a line for every failure, and one of counts. tests/bench/run calls it.
 */
#include <drillmbd/drillmbd.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define PI 3.14159265358979323846

enum { SCENES = 1000 };
static const double end_time = 0.2, start_up = 0.05; /* [s] */

/* ---- Latin hypercube -----------------------------------------------------------------------------------------------
 */

enum {
    AXIS_PIPES,
    AXIS_LENGTH,
    AXIS_OUTER,
    AXIS_THICKNESS,
    AXIS_CLEARANCE,
    AXIS_STIFFNESS,
    AXIS_NORMAL,
    AXIS_RESTITUTION,
    AXIS_FRICTION,
    AXIS_MU,
    AXIS_SPEED,
    AXIS_FEED,
    AXIS_ECCENTRICITY,
    AXIS_BIT,
    AXIS_INCLINATION,
    AXIS_STEP,
    AXIS_RADIUS,
    AXIS_ELEMENTS,
    AXIS_KIND,
    AXIS_DAMPING,
    AXIS_COUNT
};

static double samples[AXIS_COUNT][SCENES]; /* [-] 0 .. 1 */

/* splitmix64 */
static uint64_t random_bits(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static double random_number(uint64_t *state)
{
    return (double)(random_bits(state) >> 11) * 0x1p-53;
}

/* Each of the SCENES equal parts of the axis is hit once. */
static void draw_axis(uint64_t *state, double *axis)
{
    for (uint32_t i = 0; i < SCENES; ++i) axis[i] = i;
    for (uint32_t i = SCENES - 1; i > 0; --i) {
        const uint32_t k = (uint32_t)(random_bits(state) % (i + 1));
        const double other = axis[k];
        axis[k] = axis[i];
        axis[i] = other;
    }
    for (uint32_t i = 0; i < SCENES; ++i) axis[i] = (axis[i] + random_number(state)) / SCENES;
}

static void draw_samples(uint64_t seed)
{
    for (int i = 0; i < AXIS_COUNT; ++i) draw_axis(&seed, samples[i]);
}

/* ---- What is drawn -------------------------------------------------------------------------------------------------
 */

enum { BIT_ABSENT = 0, BIT_IDLE = 1, BIT_RATE = 2, BIT_REGENERATIVE = 3 };
static const char *const bit_names[] = {"absent", "idle", "rate", "regenerative"};
static const char *const kind_names[] = {"flexible", "axial_torsional", "rigid"};
static const char *const normal_names[] = {"kelvin_voigt", "hunt_crossley", "lankarani", "flores", "exact", "impact"};
static const char *const friction_names[] = {"none", "coulomb", "ambrosio", "stribeck", "bristle"};

typedef struct drawn {
    uint32_t number, pipes, elements;
    int32_t kind, normal, friction, bit;
    double length, outer, thickness; /* [m] of a pipe */
    double clearance;                /* [m] radial */
    double stiffness, restitution, mu;
    double speed, feed;           /* [rpm, m/s] */
    double eccentricity, damping; /* [m, s] */
    double inclination;           /* [rad] of the hole, upwards */
    double step, radius;          /* [s, -] */
} drawn;

static double between(double u, double low, double high)
{
    return low + u * (high - low);
}

static double between_log(double u, double low, double high)
{
    return low * pow(high / low, u);
}

static uint32_t one_of(double u, uint32_t count)
{
    return (uint32_t)(u * count);
}

static void draw_string(uint32_t i, drawn *d)
{
    const double kind = samples[AXIS_KIND][i];
    d->pipes = 3 + one_of(samples[AXIS_PIPES][i], 58);
    d->length = between(samples[AXIS_LENGTH][i], 0.75, 3.0);
    d->outer = between(samples[AXIS_OUTER][i], 0.042, 0.089);
    d->thickness = between(samples[AXIS_THICKNESS][i], 0.004, 0.012);
    d->eccentricity = between(samples[AXIS_ECCENTRICITY][i], 0.0, 2e-3);
    d->elements = 1 + one_of(samples[AXIS_ELEMENTS][i], 3);
    d->kind = kind < 0.8 ? DMB_PIPE_FLEXIBLE : kind < 0.9 ? DMB_PIPE_AXIAL_TORSIONAL : DMB_PIPE_RIGID;
    d->damping = samples[AXIS_DAMPING][i] < 0.5 ? 0.0 : 1e-4;
    d->bit = (int32_t)one_of(samples[AXIS_BIT][i], 4);
}

static drawn draw_scene(uint32_t i)
{
    drawn d;
    memset(&d, 0, sizeof d);
    d.number = i;
    draw_string(i, &d);
    d.clearance = between(samples[AXIS_CLEARANCE][i], 0.003, 0.040);
    d.stiffness = between_log(samples[AXIS_STIFFNESS][i], 1e5, 1e9);
    d.normal = (int32_t)one_of(samples[AXIS_NORMAL][i], 6);
    d.restitution = between(samples[AXIS_RESTITUTION][i], 0.1, 0.9);
    d.friction = (int32_t)one_of(samples[AXIS_FRICTION][i], 5) - 1;
    d.mu = between(samples[AXIS_MU][i], 0.0, 0.6);
    d.speed = between(samples[AXIS_SPEED][i], 0.0, 250.0);
    d.feed = between(samples[AXIS_FEED][i], 0.0, 0.05);
    d.inclination = between(samples[AXIS_INCLINATION][i], -30.0, 30.0) * PI / 180.0;
    d.step = between_log(samples[AXIS_STEP][i], 2e-4, 2e-3);
    d.radius = between(samples[AXIS_RADIUS][i], 0.5, 1.0);
    return d;
}

static void print_drawn(const drawn *d)
{
    printf("pipes=%u elements=%u kind=%s length=%.4g od_mm=%.4g wall_mm=%.4g clearance_mm=%.4g ", (unsigned)d->pipes,
           (unsigned)d->elements, kind_names[d->kind], d->length, 1e3 * d->outer, 1e3 * d->thickness,
           1e3 * d->clearance);
    printf("stiffness=%.4g normal=%s restitution=%.4g friction=%s mu=%.4g ", d->stiffness, normal_names[d->normal],
           d->restitution, friction_names[d->friction + 1], d->mu);
    printf("rpm=%.4g feed_mm_s=%.4g eccentricity_mm=%.4g damping_time=%g bit=%s ", d->speed, 1e3 * d->feed,
           1e3 * d->eccentricity, d->damping, bit_names[d->bit]);
    printf("inclination_deg=%.4g dt=%.4g radius=%.4g\n", d->inclination * 180.0 / PI, d->step, d->radius);
}

/* ---- The scene -----------------------------------------------------------------------------------------------------
 */

typedef struct trial {
    drawn d;
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string;
    const char *stage; /* what was being done when `status` came */
    int32_t status;
    int verbose;
    double gravity; /* [J] of the start */
} trial;

/* [kg/m] */
static double mass_of_metre(const drawn *d)
{
    return 7850.0 * PI * d->thickness * (d->outer - d->thickness);
}

/* [N s/m2] of the laws that have no restitution, that of a pipe's metre on a linear spring. */
static double wall_damping(const drawn *d)
{
    const double decay = -log(d->restitution);
    return 2.0 * decay / sqrt(PI * PI + decay * decay) * sqrt(d->stiffness * mass_of_metre(d));
}

static int32_t add_hole(trial *t)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.direction[0] = cos(t->d.inclination);
    wall.direction[2] = sin(t->d.inclination);
    wall.diameter = t->d.outer + 2.0 * t->d.clearance;
    wall.normal_law = t->d.normal;
    wall.stiffness = t->d.stiffness;
    wall.restitution = t->d.restitution;
    wall.damping = wall_damping(&t->d);
    wall.friction_law = t->d.friction;
    wall.mu_static = t->d.mu;
    wall.mu_dynamic = 0.85 * t->d.mu;
    return dmb_model_add_wall(t->model, &wall, NULL);
}

/* A string of one rigid piece could not move if its head held it in line: there it swings and tilts. */
static int32_t add_string(trial *t)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    if (t->d.kind == DMB_PIPE_RIGID) string.start_free = DMB_FREE_ALL;
    const int32_t status = dmb_model_add_string(t->model, &string, &t->string);
    pipe.string = t->string;
    pipe.kind = t->d.kind;
    pipe.elements = t->d.elements;
    pipe.length = t->d.length;
    pipe.outer_diameter = t->d.outer;
    pipe.inner_diameter = t->d.outer - 2.0 * t->d.thickness;
    pipe.damping_time = t->d.damping;
    pipe.eccentricity = t->d.eccentricity;
    pipe.angle_spread = PI;
    pipe.seed = t->d.number + 1;
    return status < 0 ? status : dmb_model_add_pipes(t->model, &pipe, t->d.pipes, NULL);
}

static int32_t add_bit(trial *t)
{
    dmb_bit_def bit = dmb_bit_def_default();
    if (t->d.bit == BIT_ABSENT) return DMB_OK;
    bit.rock_law = t->d.bit - BIT_IDLE;
    bit.string = t->string;
    bit.diameter = t->d.outer + 2.0 * t->d.clearance - 2e-3;
    bit.radius = 0.5 * bit.diameter;
    return dmb_model_add_bit(t->model, &bit, NULL);
}

static int32_t add_drive(trial *t, int32_t component, double speed)
{
    dmb_term term = dmb_term_default();
    dmb_drive_def drive = dmb_drive_def_default();
    term.kind = DMB_TERM_STEP;
    term.x1 = start_up;
    term.h1 = speed;
    const int32_t status = dmb_model_add_programme(t->model, &term, 1, &drive.programme);
    drive.part = t->string;
    drive.component = component;
    return status < 0 ? status : dmb_model_add_drive(t->model, &drive, NULL);
}

static int32_t make_model(trial *t)
{
    int32_t status = dmb_model_create(NULL, &t->model);
    if (status >= 0) status = add_hole(t);
    if (status >= 0) status = add_string(t);
    if (status >= 0) status = add_bit(t);
    if (status >= 0) status = add_drive(t, DMB_X, t->d.feed);
    if (status >= 0) status = add_drive(t, DMB_RX, t->d.speed * PI / 30.0);
    return status < 0 ? status : dmb_model_compile(t->model, NULL);
}

static int32_t make_sim(trial *t)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = t->d.radius;
    return dmb_sim_create(t->model, &options, &t->sim);
}

/* ---- Counts --------------------------------------------------------------------------------------------------------
 */

static struct counts {
    uint32_t finished, retried, failed, not_finite;
    uint32_t newton, relaxed, static_failed;
    uint32_t worst, worst_static;
    uint64_t steps, iterations, rejected, cut;
    double worst_seconds, worst_balance;
    uint32_t slowest, worst_balanced; /* numbers of scenes */
    double balance[SCENES];           /* [-] of the first `finished` */
} counts;

static void print_failure(const trial *t, unsigned long long seed)
{
    const char *text = t->sim ? dmb_sim_message(t->sim) : t->model ? dmb_model_message(t->model) : "";
    printf("failed=%s seed=%llu number=%u status=%s t=%.6g message=\"%s\" ", t->stage, seed, (unsigned)t->d.number,
           dmb_status_name(t->status), t->sim ? dmb_sim_time(t->sim) : 0.0, text);
    print_drawn(&t->d);
    fflush(stdout);
}

static int is_finite(const double *values, int count)
{
    for (int i = 0; i < count; ++i)
        if (!isfinite(values[i])) return 0;
    return 1;
}

/* Poses and speeds of all pipe ends. */
static int motion_is_finite(const trial *t)
{
    int finite = 1;
    for (uint32_t i = 0; i < t->d.pipes && finite; ++i) {
        const dmb_place place = dmb_station(t->string, i, 1.0);
        dmb_pose pose = dmb_pose_default();
        dmb_motion motion = dmb_motion_default();
        finite = dmb_query_pose(t->sim, place, &pose) >= 0 && dmb_query_motion(t->sim, place, &motion) >= 0 &&
                 is_finite(pose.position, 3) && is_finite(pose.rotation, 9) && is_finite(motion.velocity, 6) &&
                 is_finite(motion.acceleration, 6);
    }
    return finite;
}

/* ---- A trial -------------------------------------------------------------------------------------------------------
 */

/* Where it fails, the run begins on the axis of the hole instead, as described. */
static int32_t settle(trial *t)
{
    dmb_static_report report = dmb_static_report_default();
    t->stage = "static";
    t->status = dmb_analysis_static(t->sim, NULL, &report);
    if (t->status < 0)
        ++counts.static_failed;
    else if (report.method == DMB_STATIC_NEWTON)
        ++counts.newton;
    else
        ++counts.relaxed;
    if (report.iterations > counts.worst_static) counts.worst_static = report.iterations;
    if (t->verbose)
        printf("static=%s method=%d iterations=%u residual=%.2e move_mm=%.3g\n", dmb_status_name(t->status),
               (int)report.method, (unsigned)report.iterations, report.residual, 1e3 * report.lateral_move);
    return t->status;
}

static void print_step(const trial *t, const dmb_step_report *r)
{
    dmb_energy e = dmb_energy_default();
    dmb_contact_sum sum = dmb_contact_sum_default();
    (void)dmb_query_energy(t->sim, &e);
    (void)dmb_query_contact_sum(t->sim, &sum);
    printf("t=%.6f status=%d steps=%u iterations=%u rejected=%u residual=%.1e kinetic=%.4g balance=%.2e closed=%u "
           "normal=%.4g deepest_mm=%.3g\n",
           dmb_sim_time(t->sim), (int)t->status, (unsigned)r->steps, (unsigned)r->iterations, (unsigned)r->rejected,
           r->residual, e.kinetic, e.balance, (unsigned)sum.closed, sum.normal_force, 1e3 * sum.deepest);
}

static int32_t run(trial *t)
{
    dmb_step_report report = dmb_step_report_default();
    dmb_energy start = dmb_energy_default();
    t->stage = "run";
    t->status = dmb_query_energy(t->sim, &start);
    t->gravity = start.gravity;
    for (double k = 1.0; t->status >= 0 && dmb_sim_time(t->sim) < end_time * (1.0 - 1e-12); k += 1.0) {
        t->status = dmb_sim_step(t->sim, fmin(k * t->d.step, end_time) - dmb_sim_time(t->sim), &report);
        if (t->status >= 0 && report.rejected > 0) ++counts.cut;
        if (t->verbose) print_step(t, &report);
        if (t->status >= 0 && !motion_is_finite(t)) t->status = DMB_ERR_NOT_FINITE, t->stage = "finite";
    }
    return t->status;
}

static void count_finished(const trial *t)
{
    dmb_statistics s = dmb_statistics_default();
    dmb_energy e = dmb_energy_default();
    (void)dmb_query_statistics(t->sim, &s);
    (void)dmb_query_energy(t->sim, &e);
    const double balance = fabs(e.balance) / fmax(e.input + fabs(e.gravity - t->gravity), 1e-30);
    if (balance > counts.worst_balance) counts.worst_balance = balance, counts.worst_balanced = t->d.number;
    counts.balance[counts.finished++] = balance;
    counts.retried += s.rejected > 0;
    counts.steps += s.steps;
    counts.iterations += s.iterations;
    counts.rejected += s.rejected;
    if (s.worst_iterations > counts.worst) counts.worst = s.worst_iterations;
    if (t->verbose)
        printf("steps=%llu iterations=%llu rejected=%llu worst=%u balance=%.2e\n", (unsigned long long)s.steps,
               (unsigned long long)s.iterations, (unsigned long long)s.rejected, (unsigned)s.worst_iterations, balance);
}

static void go(trial *t, unsigned long long seed)
{
    t->stage = "compile";
    t->status = make_model(t);
    if (t->status >= 0) t->stage = "create", t->status = make_sim(t);
    if (t->status >= 0 && settle(t) < 0) print_failure(t, seed);
    if (t->sim) (void)run(t);
    if (t->status >= 0) {
        count_finished(t);
        return;
    }
    ++counts.failed;
    counts.not_finite += strcmp(t->stage, "finite") == 0;
    print_failure(t, seed);
}

static void try_scene(uint32_t number, unsigned long long seed, int verbose, double step)
{
    trial t;
    const clock_t begin = clock();
    memset(&t, 0, sizeof t);
    t.d = draw_scene(number);
    t.verbose = verbose;
    if (step > 0.0) t.d.step = step;
    if (verbose) print_drawn(&t.d);
    go(&t, seed);
    dmb_sim_destroy(&t.sim);
    dmb_model_destroy(&t.model);
    const double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    if (seconds > counts.worst_seconds) counts.worst_seconds = seconds, counts.slowest = number;
}

/* ---- Summary -------------------------------------------------------------------------------------------------------
 */

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* NaN if nothing finished. */
static double balance_quantile(double fraction)
{
    return counts.finished ? counts.balance[(uint32_t)(fraction * (counts.finished - 1) + 0.5)] : (double)NAN;
}

static void print_summary(unsigned long long seed)
{
    qsort(counts.balance, counts.finished, sizeof *counts.balance, compare_doubles);
    printf("scene=S seed=%llu scenes=%d finished=%u retried=%u failed=%u not_finite=%u ", seed, SCENES,
           (unsigned)counts.finished, (unsigned)counts.retried, (unsigned)counts.failed, (unsigned)counts.not_finite);
    printf("static_newton=%u static_relaxed=%u static_failed=%u static_worst_iterations=%u ", (unsigned)counts.newton,
           (unsigned)counts.relaxed, (unsigned)counts.static_failed, (unsigned)counts.worst_static);
    printf("steps=%llu cut=%llu rejected=%llu iterations=%.3g worst_iterations=%u ", (unsigned long long)counts.steps,
           (unsigned long long)counts.cut, (unsigned long long)counts.rejected,
           (double)counts.iterations / fmax(1.0, (double)counts.steps), (unsigned)counts.worst);
    printf("balance_median=%.1e balance_99=%.1e balance_worst=%.1e balance_worst_number=%u ", balance_quantile(0.5),
           balance_quantile(0.99), counts.worst_balance, (unsigned)counts.worst_balanced);
    printf("seconds=%.4g slowest=%.3g slowest_number=%u\n", (double)clock() / CLOCKS_PER_SEC, counts.worst_seconds,
           (unsigned)counts.slowest);
}

int main(int count, char **words)
{
    const unsigned long long seed = count > 1 ? strtoull(words[1], NULL, 10) : 1;
    draw_samples(seed);
    if (count > 2) {
        const unsigned long number = strtoul(words[2], NULL, 10);
        if (number >= SCENES) return fputs("usage: stability [SEED [NUMBER [STEP]]], NUMBER 0 .. 999\n", stderr), 2;
        try_scene((uint32_t)number, seed, 1, count > 3 ? strtod(words[3], NULL) : 0.0);
        return counts.failed > 0 || counts.static_failed > 0;
    }
    for (uint32_t i = 0; i < SCENES; ++i) try_scene(i, seed, 0, 0.0);
    print_summary(seed);
    return counts.failed > 0 || counts.static_failed > 0;
}
