/* Linear analyses held against each other and against the runs that they are the slope of: matrices of the state space
 * against the frequency response; few modes, and those of a band, against all; modes in axes that turn against modes in
 * axes at rest; derivatives along a run against two runs; a path of equilibria against the static states on it. */
#include <stdlib.h>

#include "linear_tools.h"

enum { TOPIC_LINEAR = TOPIC_OF_RELATION + 90, PLACES = 3, FREQUENCIES = 3 };

/* ---- State space ------------------------------------------------------------------------------------------------- */

/* x <- A^-1 x by elimination, A row by row; 0: singular. */
static int solve(uint32_t n, double complex *A, double complex *x)
{
    for (uint32_t k = 0; k < n; ++k) {
        uint32_t pivot = k;
        for (uint32_t i = k + 1; i < n; ++i)
            if (cabs(A[(size_t)n * i + k]) > cabs(A[(size_t)n * pivot + k])) pivot = i;
        if (!(cabs(A[(size_t)n * pivot + k]) > 0.0)) return 0;
        for (uint32_t j = k; j < n && pivot != k; ++j) {
            const double complex other = A[(size_t)n * k + j];
            A[(size_t)n * k + j] = A[(size_t)n * pivot + j];
            A[(size_t)n * pivot + j] = other;
        }
        const double complex mine = x[k];
        x[k] = x[pivot];
        x[pivot] = mine;
        for (uint32_t i = k + 1; i < n; ++i) {
            const double complex f = A[(size_t)n * i + k] / A[(size_t)n * k + k];
            for (uint32_t j = k; j < n; ++j) A[(size_t)n * i + j] -= f * A[(size_t)n * k + j];
            x[i] -= f * x[k];
        }
    }
    for (uint32_t k = n; k-- > 0;) {
        for (uint32_t j = k + 1; j < n; ++j) x[k] -= A[(size_t)n * k + j] * x[j];
        x[k] /= A[(size_t)n * k + k];
    }
    return 1;
}

/* C (i w - A)^-1 B + D of one input, by outputs. */
static void answer_of(const dmb_state_space *space, uint32_t n, uint32_t input, double w, double complex out[PLACES])
{
    double *A = malloc((size_t)n * n * sizeof *A), *B = malloc((size_t)n * PLACES * sizeof *B);
    double *C = malloc((size_t)PLACES * n * sizeof *C), D[PLACES * PLACES];
    double complex *M = malloc((size_t)n * n * sizeof *M), *x = malloc(n * sizeof *x);
    (void)dmb_state_space_dense(space, DMB_MATRIX_A, A);
    (void)dmb_state_space_dense(space, DMB_MATRIX_B, B);
    (void)dmb_state_space_dense(space, DMB_MATRIX_C, C);
    (void)dmb_state_space_dense(space, DMB_MATRIX_D, D);
    for (size_t i = 0; i < (size_t)n * n; ++i) M[i] = -A[i];
    for (uint32_t i = 0; i < n; ++i) {
        M[(size_t)n * i + i] += w * (double complex)I;
        x[i] = B[PLACES * (size_t)i + input];
    }
    const int regular = solve(n, M, x);
    for (uint32_t k = 0; k < PLACES; ++k) {
        out[k] = regular ? D[PLACES * k + input] : (double complex)NAN;
        for (uint32_t i = 0; i < n; ++i) out[k] += C[(size_t)n * k + i] * x[i];
    }
    free(A);
    free(B);
    free(C);
    free(M);
    free(x);
}

/* Forces at two places and, where there is one, what a drive is asked for; places that move, and a section force. */
static void choose(const scene *s, const built *b, stream *n, dmb_excitation in[PLACES], dmb_output out[PLACES])
{
    for (int i = 0; i < PLACES; ++i) {
        const material_point from = draw_spot(s, n, 6), to = draw_spot(s, n, 6);
        in[i] = input_of(b, &from);
        out[i] = output_of(b, &to);
    }
    if (s->drives > 0) {
        in[2].kind = DMB_EXCITATION_DRIVE;
        in[2].place.part = b->drive[0];
    }
    out[1].quantity +=
        (s->drives == 0 ? DMB_OUTPUT_VIBRATION_ACCELERATION : DMB_OUTPUT_VIBRATION_VELOCITY) - DMB_OUTPUT_VIBRATION;
    if (s->drives > 0 && s->drive[0].def.kind == DMB_DRIVE_MOTION) return; /* forces beside it would feel its rate */
    out[2].quantity += DMB_OUTPUT_SECTION_FORCE - DMB_OUTPUT_VIBRATION;
    out[2].place.fraction = 0.5;
}

static void check_spaced(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_LINEAR);
    dmb_excitation in[PLACES];
    dmb_output out[PLACES];
    double list[FREQUENCIES], pair[FREQUENCIES][2];
    dmb_response *response = NULL;
    dmb_state_space *space = NULL;
    dmb_state_space_info info = dmb_state_space_info_default();
    dmb_response_options options = dmb_response_options_default();
    built b;
    int32_t status = open_at_rest(&t->s, NULL, &b);
    if (status >= 0) {
        choose(&t->s, &b, &n, in, out);
        for (int i = 0; i < FREQUENCIES; ++i) list[i] = (double)(i + 1) * draw_size(&n, 0.5, 50.0);
        for (int i = 1; i < FREQUENCIES; ++i) list[i] = fmax(list[i], 1.1 * list[i - 1]);
        options.frequencies = list;
        options.points = FREQUENCIES;
        status = dmb_analysis_response(b.sim, &options, in, PLACES, out, PLACES, &response);
    }
    if (status >= 0) status = dmb_analysis_state_space(b.sim, NULL, in, PLACES, out, PLACES, &space);
    if (status < 0) refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
    if (space != NULL) (void)dmb_state_space_get_info(space, &info);
    for (int f = 0; f < FREQUENCIES && t->verdict == VERDICT_HELD; ++f)
        for (uint32_t i = 0; i < PLACES; ++i) {
            double complex found[PLACES];
            answer_of(space, info.states, i, 2.0 * PI * list[f], found);
            for (uint32_t k = 0; k < PLACES; ++k) {
                double most = 0.0;
                (void)dmb_response_transfer(response, i, k, pair[0]);
                for (int j = 0; j < FREQUENCIES; ++j) most = fmax(most, cabs(number(pair[j])));
                hold(t, "response of the matrices", cabs(found[k] - number(pair[f])), 1e-6 * most + 1e-15);
            }
        }
    dmb_response_destroy(&response);
    dmb_state_space_destroy(&space);
    scene_close(&b);
}

/* ---- Few modes and all ------------------------------------------------------------------------------------------- */

enum { MODES_MOST = 4000, ASKED = 6 };

typedef struct roots {
    uint32_t count;
    double complex s[MODES_MOST];
} roots;

static int32_t take_roots(built *b, const dmb_modes_options *options, roots *r)
{
    dmb_modes *found = NULL;
    dmb_mode mode = dmb_mode_default();
    const int32_t status = dmb_analysis_modes(b->sim, options, &found);
    r->count = 0;
    while (status >= 0 && r->count < MODES_MOST && dmb_modes_get(found, r->count, &mode) >= 0)
        r->s[r->count++] = number(mode.eigenvalue);
    dmb_modes_destroy(&found);
    return status < 0 ? built_fail(b, status) : status;
}

/* Distance of the closest root of r that has no partner yet, which it becomes. */
static double take_closest(const roots *r, double complex s, unsigned char *taken)
{
    double least = (double)INFINITY;
    uint32_t best = 0;
    for (uint32_t i = 0; i < r->count; ++i)
        if (!taken[i] && cabs(r->s[i] - s) < least) {
            least = cabs(r->s[i] - s);
            best = i;
        }
    if (isfinite(least)) taken[best] = 1;
    return least;
}

static void hold_partners(trial *t, const char *what, const roots *few, const roots *all, double part, double noise)
{
    unsigned char taken[MODES_MOST] = {0};
    for (uint32_t i = 0; i < few->count; ++i)
        hold(t, what, take_closest(all, few->s[i], taken), part * cabs(few->s[i]) + noise);
}

/* A band of four roots that stand off their neighbours by more than a thousandth: the first of them, 0: none. */
static uint32_t band_of(const roots *all, double noise, double band[2])
{
    for (uint32_t first = 1; first + 4 < all->count; ++first) {
        const double ends[4] = {cabs(all->s[first - 1]), cabs(all->s[first]), cabs(all->s[first + 3]),
                                cabs(all->s[first + 4])};
        if (ends[1] < 1.001 * ends[0] + 1e3 * noise || ends[3] < 1.001 * ends[2]) continue;
        band[0] = 0.25 * (ends[0] + ends[1]) / PI;
        band[1] = 0.25 * (ends[2] + ends[3]) / PI;
        return first;
    }
    return 0;
}

/* The lowest have partners among all, and no other of all is lower; so in a band. */
static void hold_choice(trial *t, built *b, int32_t kind, roots *all, roots *few)
{
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = kind;
    options.select = DMB_MODES_ALL;
    int32_t status = take_roots(b, &options, all);
    if (status < 0) {
        refused(t, status, b->message);
        return;
    }
    if (all->count < ASKED + 2) {
        left_out(t, "few modes");
        return;
    }
    const double size = cabs(all->s[all->count - 1]), noise = 1e-9 * size;
    options.select = DMB_MODES_LOWEST;
    options.count = ASKED;
    status = take_roots(b, &options, few);
    if (status < 0) {
        refused(t, status, b->message);
        return;
    }
    hold(t, "modes that are missing", (double)ASKED - few->count, 0.5);
    hold_partners(t, "one of the lowest modes beside all", few, all, 2e-6, noise);
    if (few->count == ASKED && t->verdict == VERDICT_HELD)
        hold(t, "the last of the lowest modes beside all", fabs(cabs(few->s[ASKED - 1]) - cabs(all->s[ASKED - 1])),
             2e-6 * cabs(all->s[ASKED - 1]) + noise);
    options.select = DMB_MODES_BAND;
    const uint32_t first = band_of(all, noise, options.band), last = first + 3;
    if (first == 0 || t->verdict != VERDICT_HELD) return;
    status = take_roots(b, &options, few);
    if (status < 0) {
        refused(t, status, b->message);
        return;
    }
    hold(t, "modes of the band less those of all", fabs((double)few->count - (last - first + 1)), 0.5);
    hold_partners(t, "one of the band beside all", few, all, 2e-6, noise);
}

static void check_counted(trial *t)
{
    static roots all, few;
    built b;
    int32_t status = open_at_rest(&t->s, NULL, &b);
    if (status < 0) refused(t, status, b.message);
    for (int32_t kind = DMB_MODES_UNDAMPED; kind <= DMB_MODES_DAMPED && t->verdict == VERDICT_HELD; ++kind)
        hold_choice(t, &b, kind, &all, &few);
    scene_close(&b);
}

/* ---- Axes -------------------------------------------------------------------------------------------------------- */

static double size_of(const roots *r)
{
    double size = 0.0;
    for (uint32_t i = 0; i < r->count; ++i) size = fmax(size, cabs(r->s[i]));
    return size;
}

/* Roots of straight motion, which are double in axes that turn, are parted by the root of rounding; what is not round,
 * or held unlike, by less than a ten-thousandth is not told. A root seen from axes at rest is what it is in axes that
 * turn with W, or i W more or less. */
static void check_seen(trial *t)
{
    static roots turning, rest, shifted, few;
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_LINEAR + 1);
    dmb_modes_options options = dmb_modes_options_default();
    built b;
    t->s.loads = t->s.drives = 0;
    t->s.environment.torsional_damping = 0.0; /* it would brake */
    memset(t->s.environment.gravity, 0, sizeof t->s.environment.gravity);
    options.kind = DMB_MODES_DAMPED;
    options.select = DMB_MODES_ALL;
    options.spin = draw_size(&n, 1.0, 60.0);
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    if (status >= 0) status = take_roots(&b, &options, &turning);
    options.axes = DMB_MODES_AXES_AT_REST;
    if (status >= 0) status = take_roots(&b, &options, &rest);
    if (status < 0) refused(t, status, b.message);
    options.select = DMB_MODES_LOWEST;
    options.count = ASKED;
    for (int32_t axes = DMB_MODES_AXES_TURNING; axes <= DMB_MODES_AXES_AT_REST && t->verdict == VERDICT_HELD; ++axes) {
        options.axes = axes;
        status = take_roots(&b, &options, &few);
        if (status < 0)
            refused(t, status, b.message);
        else
            hold_partners(t, "one of the lowest modes in axes beside all", &few, axes ? &rest : &turning, 3e-4,
                          1e-9 * size_of(&rest));
    }
    scene_close(&b);
    if (t->verdict != VERDICT_HELD) return;
    shifted.count = 0;
    for (uint32_t i = 0; i < turning.count && 3 * (i + 1) <= MODES_MOST; ++i)
        for (int k = -1; k <= 1; ++k) {
            const double complex s = turning.s[i] + k * options.spin * (double complex)I;
            shifted.s[shifted.count++] = cimag(s) < 0.0 ? conj(s) : s;
        }
    const double size = size_of(&rest);
    for (uint32_t i = 0; i < rest.count && t->verdict == VERDICT_HELD; ++i) {
        unsigned char taken[MODES_MOST] = {0};
        hold(t, "a mode in axes at rest beside those that turn", take_closest(&shifted, rest.s[i], taken),
             (t->s.joints + t->s.bodies > 0 ? 1e-4 : 1e-6) * (cabs(rest.s[i]) + options.spin) + 1e-9 * size);
    }
}

/* Motion in the sense of turning that a force going round with it by w makes at a place, in some axes. */
static int32_t circle(built *b, part_ref place, const dmb_response_options *options, double complex *out)
{
    dmb_excitation in[2];
    dmb_output answer[2];
    double pair[2];
    dmb_response *response = NULL;
    *out = 0.0;
    for (int32_t i = 0; i < 2; ++i) {
        const material_point at = {place, DMB_Y + i};
        in[i] = input_of(b, &at);
        answer[i] = output_of(b, &at);
        in[i].frame = DMB_FRAME_BODY;
        answer[i].quantity += DMB_OUTPUT_VIBRATION_BODY - DMB_OUTPUT_VIBRATION;
    }
    const int32_t status = dmb_analysis_response(b->sim, options, in, 2, answer, 2, &response);
    for (uint32_t i = 0; i < 2 && status >= 0; ++i)
        for (uint32_t k = 0; k < 2; ++k) { /* y + i z over 2 of y = cos w t, z = sin w t */
            (void)dmb_response_transfer(response, i, k, pair);
            *out += 0.5 * number(pair) * (k == 0 ? 1.0 : (double complex)I) * (i == 0 ? 1.0 : -(double complex)I);
        }
    dmb_response_destroy(&response);
    return status < 0 ? built_fail(b, status) : status;
}

/* Motion that goes round with w at rest goes round with w - W in axes that turn with W. */
static void check_circled(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_LINEAR + 3);
    dmb_response_options options = dmb_response_options_default();
    double frequency = 0.0;
    double complex rest = 0.0, turning = 0.0;
    built b;
    t->s.loads = t->s.drives = 0;
    t->s.environment.torsional_damping = 0.0; /* it would brake */
    memset(t->s.environment.gravity, 0, sizeof t->s.environment.gravity);
    const material_point at = draw_spot(&t->s, &n, 1);
    const double spin = draw_size(&n, 1.0, 60.0), aside = draw_size(&n, 0.3, 300.0);
    options.frequencies = &frequency;
    options.points = 1;
    options.spin = spin;
    frequency = aside;
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    if (status >= 0) status = circle(&b, at.place, &options, &turning);
    options.axes = DMB_RESPONSE_AXES_AT_REST;
    frequency = aside + spin / (2.0 * PI);
    const int32_t noted = status;
    if (status >= 0) status = circle(&b, at.place, &options, &rest);
    if (status < 0)
        refused(t, status, b.message);
    else if (status != DMB_OK || noted != DMB_OK)
        left_out(t, "what a note tells");
    else
        hold(t, "response at rest beside that in axes that turn", cabs(rest - turning),
             (t->s.joints + t->s.bodies > 0 ? 1e-3 : 1e-6) * cabs(rest) + 1e-14);
    scene_close(&b);
}

/* ---- Derivatives along a run ------------------------------------------------------------------------------------- */

enum { ROWS_MOST = 4000, STEPS = 40 };
#define ASIDE 1e-6

typedef struct speeds {
    uint32_t rows;
    double v[ROWS_MOST];
    decisions decisions;
} speeds;

static int32_t take_speeds(built *b, speeds *out)
{
    uint64_t count = ROWS_MOST;
    const int32_t status = dmb_analysis_array(b->sim, DMB_ARRAY_VELOCITY, out->v, &count);
    out->rows = (uint32_t)count;
    return status < 0 ? built_fail(b, status) : status;
}

static int32_t run_aside(const scene *s, double p, speeds *out)
{
    static scene moved;
    built b;
    scene_perturb(s, p, &moved);
    memset(&out->decisions, 0, sizeof out->decisions);
    int32_t status = scene_open(&moved, 0, NULL, &b);
    if (status >= 0) status = run_steps(&b, s->step, STEPS, &out->decisions);
    if (status >= 0) status = take_speeds(&b, out);
    scene_close(&b);
    return status;
}

/* Speeds after STEPS steps by the part p that everything is changed by. */
static int32_t follow_derivatives(trial *t, double *by, uint32_t *rows)
{
    static scene moved;
    built b, side[2] = {{0}};
    dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *made = NULL;
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    for (int i = 0; i < 2 && status >= 0; ++i) {
        scene_perturb(&t->s, i == 0 ? -ASIDE : ASIDE, &moved);
        status = scene_open(&moved, 0, NULL, side + i);
    }
    parameter.step = ASIDE;
    parameter.low = side[0].sim;
    parameter.high = side[1].sim;
    if (status >= 0) status = dmb_sensitivity_create(b.sim, &parameter, 1, &made);
    for (int i = 0; i < STEPS && status >= 0; ++i) {
        status = dmb_sensitivity_step(made, t->s.step, NULL);
        if (status == DMB_NOTE_NOT_SMOOTH) left_out(t, "a corner");
    }
    if (status >= 0) status = dmb_sensitivity_rows(made, 0, NULL, NULL, rows);
    if (status >= 0 && *rows <= ROWS_MOST) status = dmb_sensitivity_rows(made, 0, NULL, by, rows);
    if (status < 0) refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
    dmb_sensitivity_destroy(&made);
    scene_close(&side[0]);
    scene_close(&side[1]);
    scene_close(&b);
    return status;
}

static void check_sensed(trial *t)
{
    static speeds low, high, here;
    static double by[ROWS_MOST];
    uint32_t rows = 0;
    double floor[ANSWER_GROUPS];
    double most[2] = {0.0, 0.0}, size[2] = {0.0, 0.0}, worst[2] = {0.0, 0.0};
    if (follow_derivatives(t, by, &rows) < 0 || t->verdict != VERDICT_HELD) return;
    int32_t status = run_aside(&t->s, -ASIDE, &low);
    if (status >= 0) status = run_aside(&t->s, ASIDE, &high);
    if (status >= 0) status = run_aside(&t->s, 0.0, &here);
    if (status < 0 || rows > ROWS_MOST) {
        left_out(t, "a run that fails a hair aside");
        return;
    }
    if (low.decisions.divided != high.decisions.divided || here.decisions.divided != high.decisions.divided) {
        left_out(t, "a step that is divided by a hair");
        return;
    }
    for (uint32_t i = 0; i < rows; ++i) {
        const int kind = i % 6 >= 3;
        const double slope = (high.v[i] - low.v[i]) / (2.0 * ASIDE);
        most[kind] = fmax(most[kind], fabs(slope));
        size[kind] = fmax(size[kind], fabs(here.v[i]));
        worst[kind] = fmax(worst[kind], fabs(slope - by[i]));
    }
    rounding_of(&t->s, t->s.span + 10.0, t->s.step, floor);
    const double rounding[2] = {floor[ANSWER_VELOCITY], floor[ANSWER_SPIN]};
    for (int kind = 0; kind < 2; ++kind)
        hold(t, kind == 0 ? "derivative of speeds beside two runs" : "of turning", worst[kind],
             1e-3 * most[kind] + 1e-4 * size[kind] + 10.0 * rounding[kind] / ASIDE);
}

/* ---- Paths ------------------------------------------------------------------------------------------------------- */

typedef struct reached {
    const built *b;
    part_ref at;
    double position[3], factor;
    int32_t negative;
} reached;

static int32_t hear(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    reached *r = context;
    dmb_pose pose = dmb_pose_default();
    if (dmb_query_pose(at, built_place(r->b, r->at), &pose) < 0) return 1;
    memcpy(r->position, pose.position, sizeof r->position);
    r->factor = point->factor;
    r->negative = point->negative;
    return 0;
}

/* The end of a path on which the first load grows is where the static state under the grown load is. */
static void check_walked(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_LINEAR + 2);
    dmb_path_options options = dmb_path_options_default();
    dmb_path_report report = dmb_path_report_default();
    dmb_pose pose = dmb_pose_default(), before = dmb_pose_default();
    built b;
    if (t->s.loads == 0) {
        left_out(t, "no load that could grow");
        return;
    }
    reached end = {.b = &b, .at = t->s.load[0].place};
    int32_t status = open_at_rest(&t->s, NULL, &b);
    if (status >= 0) (void)dmb_query_pose(b.sim, built_place(&b, end.at), &before);
    options.scale = DMB_SCALE_PART;
    options.part = b.load[0];
    options.factor_end = draw_number(&n, -0.5, 0.5);
    options.tolerance = 1e-12;
    options.callback = hear;
    options.callback_context = &end;
    if (status >= 0) status = dmb_analysis_path(b.sim, &options, &report);
    if (status < 0)
        refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
    else if (report.limits > 0 || report.bifurcations > 0 || status != DMB_OK || end.negative != 0)
        left_out(t, "a path that loses its stability");
    scene_close(&b);
    if (t->verdict != VERDICT_HELD) return;
    time_function_data *const p = &t->s.load[0].time_function;
    const double now = p->terms > 0 ? p->term[0].h0 : 1.0;
    *p = time_function_step(now + end.factor, 0.0, 0.0, 1.0);
    status = open_at_rest(&t->s, NULL, &b);
    if (status != DMB_OK) {
        left_out(t, "another static state, or none, under the grown load alone");
    } else {
        (void)dmb_query_pose(b.sim, built_place(&b, end.at), &pose);
        double moved = 0.0, apart = 0.0;
        for (int i = 0; i < 3; ++i) {
            moved = fmax(moved, fabs(end.position[i] - before.position[i]));
            apart = fmax(apart, fabs(end.position[i] - pose.position[i]));
        }
        hold(t, "static state at the end of the path", apart, 1e-6 * moved + 1e-9 * t->s.span);
    }
    scene_close(&b);
}

const relation relation_spaced = {"spaced",
                                  "frequency responses against the matrices of the state space",
                                  {FAMILY_LINE | FAMILY_HOLE | FAMILY_BENT, WISH_STILL | WISH_ELASTIC, 3},
                                  15,
                                  0.3,
                                  check_spaced,
                                  0.0};
const relation relation_counted = {"counted",
                                   "few modes, and those of a band, against all",
                                   {FAMILY_LINE | FAMILY_HOLE | FAMILY_BENT | FAMILY_FREE, WISH_STILL, 16},
                                   15,
                                   0.3,
                                   check_counted,
                                   0.0};
const relation relation_seen = {"seen",
                                "modes in axes that turn against modes in axes at rest",
                                {FAMILY_LINE | FAMILY_FREE, WISH_STILL | WISH_ROUND | WISH_NO_LOADS, 8},
                                15,
                                0.2,
                                check_seen,
                                0.0};
const relation relation_circled = {"circled",
                                   "responses in axes that turn against responses in axes at rest",
                                   {FAMILY_LINE | FAMILY_FREE, WISH_STILL | WISH_ROUND | WISH_NO_LOADS, 8},
                                   20,
                                   0.2,
                                   check_circled,
                                   0.0};
const relation relation_sensed = {
    "sensed", "derivatives along a run against two runs", {FAMILY_ALL, WISH_NO_BIT, 4}, 20, 0.2, check_sensed, 0.0};
const relation relation_walked = {"walked",
                                  "the end of a path of equilibria against the static state there",
                                  {FAMILY_LINE | FAMILY_HOLE | FAMILY_BENT, WISH_STILL | WISH_ELASTIC | WISH_HARD, 4},
                                  20,
                                  0.2,
                                  check_walked,
                                  0.0};
