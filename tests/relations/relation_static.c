/* A static state against where a damped run settles. `negative` of the static report against the number of modes that
 * diverge. The largest real part of the damped modes against growth or decay of a run. */
#include "relations.h"

enum { MODES_MOST = 600, TOPIC_STATIC = TOPIC_OF_RELATION + 30 };

/* ---- Tools ------------------------------------------------------------------------------------------------------ */

static answers rest, before, after;

static int32_t open_at_rest(const scene *s, const dmb_sim_options *options, built *b, dmb_static_report *report)
{
    int32_t status = scene_open(s, 0, options, b);
    if (status < 0) return status;
    status = dmb_analysis_static(b->sim, NULL, report);
    return status < 0 ? built_fail(b, status) : status;
}

/* All modes about the present state; returns their number, or a status < 0. */
static int32_t all_modes(built *b, int32_t kind, dmb_mode *modes, uint32_t most)
{
    dmb_modes *found = NULL;
    dmb_modes_info info = dmb_modes_info_default();
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = kind;
    options.select = DMB_MODES_ALL;
    const int32_t status = dmb_analysis_modes(b->sim, &options, &found);
    if (status < 0) return built_fail(b, status);
    (void)dmb_modes_get_info(found, &info);
    const uint32_t count = info.count < most ? info.count : most;
    for (uint32_t i = 0; i < count; ++i) {
        modes[i] = dmb_mode_default();
        (void)dmb_modes_get(found, i, &modes[i]);
    }
    dmb_modes_destroy(&found);
    return (int32_t)count;
}

static double largest_move(const answers *a, const answers *b)
{
    double difference[ANSWER_GROUPS];
    answers_difference(a, b, difference);
    return difference[ANSWER_POSITION];
}

static void take_positions(const scene *s, const built *b, answers *out)
{
    scene_view view = view_identity();
    view.motion_only = 1;
    answers_take(s, s, &view, b, out);
}

/* ---- Settled ---------------------------------------------------------------------------------------------------- */

/* [kg, m] of the pipes, [kg] of the bodies fixed to them */
static void masses(const scene *s, double *per_metre, double *inertia, double *share)
{
    const dmb_pipe_def *const p = &s->string[0].pipe[0];
    const double o2 = p->outer_diameter * p->outer_diameter, i2 = p->inner_diameter * p->inner_diameter;
    double bodies = 0.0;
    for (uint32_t i = 0; i < s->bodies; ++i) bodies += s->body[i].def.mass;
    *per_metre = p->density * 0.25 * PI * (o2 - i2);
    *inertia = *per_metre * (o2 + i2) / 8.0;
    *share = 1.0 + bodies / (*per_metre * s->span);
}

/* Drag that damps motion of the lowest frequency w about critically, and all others at the same rate. */
static void drag_for(scene *s, double w)
{
    double m, j, share;
    masses(s, &m, &j, &share);
    s->environment.lateral_damping = s->environment.axial_damping = 2.0 * m * share * w;
    s->environment.torsional_damping = 2.0 * j * share * w;
}

static double lowest_frequency(built *b)
{
    static dmb_mode modes[MODES_MOST];
    const int32_t count = all_modes(b, DMB_MODES_UNDAMPED, modes, MODES_MOST);
    double w = 0.0;
    for (int32_t i = 0; i < count; ++i)
        if (!modes[i].rigid && (w == 0.0 || 2.0 * PI * modes[i].frequency < w)) w = 2.0 * PI * modes[i].frequency;
    for (int32_t i = 0; i < count; ++i)
        if (modes[i].rigid) w = 0.0;
    return w;
}

/* From the described pose; *remaining: move in the last fifth. *parts: of ten steps after the first twenty; more than
 * MOST_PARTS, and the run ends there. In scene 30 of seed 1 mean forces of damped springs begin again in each part, and
 * the scheme supplies what the dampers take (limits.md); with a hundredth of the step it does not. */
enum { SETTLE_STEPS = 500, MOST_PARTS = 1000 };

static int32_t settle(scene *s, double w, built *b, uint32_t *parts, double *remaining)
{
    const double step = 40.0 / w / SETTLE_STEPS;
    dmb_step_report report = dmb_step_report_default();
    drag_for(s, w);
    int32_t status = scene_open(s, 0, NULL, b);
    if (status >= 0) status = run_steps(b, step, 20, NULL);
    if (status < 0) return status;
    status = dmb_sim_steps(b->sim, step, 10, NULL, &report);
    if (status < 0) return built_fail(b, status);
    *parts = report.steps;
    if (*parts > MOST_PARTS) return status;
    status = run_steps(b, step, SETTLE_STEPS * 8 / 10 - 30, NULL);
    if (status >= 0) take_positions(s, b, &before);
    if (status >= 0) status = run_steps(b, step, SETTLE_STEPS * 2 / 10, NULL);
    if (status < 0) return status;
    take_positions(s, b, &after);
    *remaining = largest_move(&before, &after);
    return status;
}

static void check_settled(trial *t)
{
    if (scene_drives_tilt(&t->s)) {
        left_out(t, "a drive along axes that tilt");
        return;
    }
    built b;
    dmb_static_report report = dmb_static_report_default();
    double remaining = 0.0, w = 0.0;
    uint32_t parts = 0;
    int32_t status = open_at_rest(&t->s, NULL, &b, &report);
    if (status < 0) {
        refused(t, status, b.message);
    } else if (report.negative != 0) {
        left_out(t, "an equilibrium that is not stable");
    } else {
        take_positions(&t->s, &b, &rest);
        w = lowest_frequency(&b);
        if (!(w > 0.0)) left_out(t, "nothing holds it somewhere");
    }
    scene_close(&b);
    if (t->verdict != VERDICT_HELD) return;
    status = settle(&t->s, w, &b, &parts, &remaining);
    if (status < 0)
        refused(t, status, b.message);
    else if (parts > MOST_PARTS)
        left_out(t, "mean forces that begin again in parts of steps");
    else if (remaining > 1e-6 * t->s.span)
        left_out(t, "a run that does not settle in time");
    else
        hold(t, "run's end beside the static state", largest_move(&after, &rest), 5.0 * remaining + 1e-7 * t->s.span);
    scene_close(&b);
}

/* ---- Negative eigenvalues --------------------------------------------------------------------------------------- */

/* A straight line without weight, pushed or pulled along by so many times Euler's load. */
static void straighten(scene *s, double push)
{
    load_data *const l = &s->load[0];
    const dmb_pipe_def *const p = &s->string[0].pipe[0];
    const double column = 0.25 * PI * PI * p->young_modulus * PI / 64.0 *
                          (pow(p->outer_diameter, 4) - pow(p->inner_diameter, 4)) / (s->span * s->span);
    double R[9];
    rotation_of_vector(s->string[0].def.rotation, R);
    for (int i = 0; i < 3; ++i) {
        s->environment.gravity[i] = 0.0;
        l->def.force[i] = -push * column * R[3 * i];
        l->def.moment[i] = 0.0;
    }
    l->def.frame = DMB_FRAME_WORLD;
}

/* A root of s^2 = -mu with mu < 0 is real; rounding may split a double one into a pair this close to the real axis. */
static int32_t diverging_of(const dmb_mode *mode)
{
    if (!(mode->eigenvalue[0] > 0.0) || mode->eigenvalue[1] > 1e-4 * mode->eigenvalue[0]) return 0;
    return mode->eigenvalue[1] > 0.0 ? 2 : 1;
}

static void check_negative(trial *t)
{
    static dmb_mode modes[MODES_MOST];
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_STATIC);
    built b;
    dmb_static_report report = dmb_static_report_default();
    int32_t diverging = 0, count = 0;
    const int straight = draw_chance(&n, 0.7);
    if (t->s.family == FAMILY_LINE && straight) straighten(&t->s, draw_number(&n, 0.1, 12.0));
    int32_t status = open_at_rest(&t->s, NULL, &b, &report);
    if (status >= 0) count = all_modes(&b, DMB_MODES_UNDAMPED, modes, MODES_MOST);
    if (status < 0 || count < 0) refused(t, b.status, b.message);
    for (int32_t i = 0; i < count; ++i) diverging += diverging_of(modes + i);
    if (t->verdict == VERDICT_HELD && diverging != report.negative)
        broken(t, "negative eigenvalues of the stiffness, modes that diverge", report.negative, diverging);
    t->telling = report.negative > 0;
    if (count == (int32_t)MODES_MOST) left_out(t, "more modes than there is room for");
    scene_close(&b);
}

/* ---- Growth and decay ------------------------------------------------------------------------------------------- */

/* Root of the mean square of how far the stations are from rest, over `steps` steps. */
static int32_t distance(const scene *s, built *b, double step, uint32_t steps, double *out)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < steps; ++i) {
        const int32_t status = run_steps(b, step, 1, NULL);
        if (status < 0) return status;
        take_positions(s, b, &after);
        for (uint32_t k = 0; k < after.count; ++k)
            if (after.group[k] == ANSWER_POSITION) sum += pow(after.value[k] - rest.value[k], 2.0);
    }
    *out = sqrt(sum / steps);
    return DMB_OK;
}

/* The slowest to decay or fastest to grow of the damped modes, and the next real part that differs from it. */
typedef struct leading {
    double real, imaginary, next;
} leading;

static leading leading_of(const dmb_mode *modes, int32_t count)
{
    leading l = {-1e30, 0.0, -1e30};
    for (int32_t i = 0; i < count; ++i)
        if (modes[i].eigenvalue[0] > l.real) {
            l.real = modes[i].eigenvalue[0];
            l.imaginary = modes[i].eigenvalue[1];
        }
    for (int32_t i = 0; i < count; ++i)
        if (modes[i].eigenvalue[0] < l.real - 1e-3 * fabs(l.real) && modes[i].eigenvalue[0] > l.next)
            l.next = modes[i].eigenvalue[0];
    return l;
}

/* The rate is measured where the other modes have fallen behind by e to this. */
#define OTHERS_GONE 14.0

/* Growth of the distance from rest between two windows of one period each: e^(real (end - begin)). */
static void hold_growth(trial *t, const leading *l, built *b)
{
    const double period = l->imaginary > 0.0 ? 2.0 * PI / l->imaginary : 0.2 / fabs(l->real);
    const uint32_t of_period = 100, first = (uint32_t)ceil(OTHERS_GONE / (l->real - l->next) / period) + 2;
    const uint32_t apart = (uint32_t)fmax(1.0, ceil(1.5 / fabs(l->real) / period));
    const double step = period / of_period;
    double d[2] = {0.0, 0.0};
    if ((first + apart + 2) * of_period > 12000) {
        left_out(t, "modes of nearly one rate");
        return;
    }
    int32_t status = run_steps(b, step, first * of_period, NULL);
    if (status >= 0) status = distance(&t->s, b, step, of_period, &d[0]);
    if (status >= 0 && apart > 1) status = run_steps(b, step, (apart - 1) * of_period, NULL);
    if (status >= 0) status = distance(&t->s, b, step, of_period, &d[1]);
    if (status < 0) {
        refused(t, status, b->message);
        return;
    }
    if (fmax(d[0], d[1]) > 1e-3 * t->s.span || fmin(d[0], d[1]) < 1e-10 * t->s.span) {
        left_out(t, "motion too large or too small to be told");
        return;
    }
    /* Scheme: (h |s|)^2/12 of |s|; other modes: e^-14, which the kick may excite more; size of the motion: its square;
     * rounding: 1e-13 of the span. */
    const double size = hypot(l->real, l->imaginary), rate = log(d[1] / d[0]) / (apart * period);
    const double scheme = pow(step * size, 2.0) / 6.0 * size;
    const double other = (4e-4 + 1e-13 * t->s.span / fmin(d[0], d[1])) / (apart * period) + 1e-3 * fabs(l->real);
    hold(t, "rate of the run beside the real part", fabs(rate - l->real), scheme + other);
}

/* Stiffness-proportional damping alone, whose rates differ from mode to mode; half of the lines straight, pushed below
 * and beyond what they bear, by a dead load or one that follows the end. */
static void prepare_growth(scene *s)
{
    stream n = stream_of(s->seed, s->number, TOPIC_STATIC + 2);
    const int straight = draw_chance(&n, 0.6), follows = draw_chance(&n, 0.3);
    double R[9];
    s->environment.lateral_damping = s->environment.axial_damping = s->environment.torsional_damping = 0.0;
    for (uint32_t k = 0; k < s->strings; ++k)
        for (uint32_t i = 0; i < s->string[k].pipes; ++i)
            s->string[k].pipe[i].damping_time = draw_number(&n, 1e-3, 1e-2);
    if (!straight) return;
    straighten(s, draw_number(&n, 0.2, 6.0));
    if (!follows) return;
    s->load[0].def.frame = DMB_FRAME_BODY;
    rotation_of_vector(s->string[0].def.rotation, R);
    matrix_apply_transposed(R, s->load[0].def.force, s->load[0].def.force);
}

/* A kick whose share in the mode is some 1e-6 of the span where the rate is measured. */
static void kick_growing(scene *s, const leading *l)
{
    stream n = stream_of(s->seed, s->number, TOPIC_STATIC + 1);
    const double period = l->imaginary > 0.0 ? 2.0 * PI / l->imaginary : 0.2 / fabs(l->real);
    const double first = OTHERS_GONE / (l->real - l->next), speed = 1e-6 * s->span * exp(-l->real * first) / period;
    double m, j, share, force[3];
    masses(s, &m, &j, &share);
    draw_direction(&n, force);
    for (int i = 0; i < 3; ++i) force[i] *= m * s->span * speed / (0.1 * period);
    scene_kick(s, force, 0.1 * period);
}

static void check_growth(trial *t)
{
    static dmb_mode modes[MODES_MOST];
    built b;
    dmb_sim_options options = scene_options(&t->s);
    leading l = {0.0, 0.0, 0.0};
    options.spectral_radius = 1.0;
    prepare_growth(&t->s);
    int32_t status = open_at_rest(&t->s, &options, &b, NULL);
    if (status >= 0) status = all_modes(&b, DMB_MODES_DAMPED, modes, MODES_MOST);
    if (status < 0)
        refused(t, b.status, b.message);
    else
        l = leading_of(modes, status);
    if (status >= 0) take_positions(&t->s, &b, &rest);
    scene_close(&b);
    if (t->verdict == VERDICT_HELD && -OTHERS_GONE * l.real > 6.0 * (l.real - l.next))
        left_out(t, "modes of nearly one rate");
    if (t->verdict != VERDICT_HELD) return;
    t->telling = l.real > 0.0;
    kick_growing(&t->s, &l);
    status = open_at_rest(&t->s, &options, &b, NULL);
    if (status < 0)
        refused(t, status, b.message);
    else
        hold_growth(t, &l, &b);
    scene_close(&b);
}

const relation relation_settled = {
    "settled",
    "a static state against where a damped run settles",
    {FAMILY_LINE | FAMILY_HOLE | FAMILY_BENT,
     WISH_STILL | WISH_DAMPED | WISH_ELASTIC | WISH_NO_FRICTION | WISH_HARD | WISH_NO_CONTROL, 3},
    40,
    0.3,
    check_settled,
    0.0};
const relation relation_negative = {"negative",
                                    "negative of the static report against the modes that diverge",
                                    {FAMILY_LINE | FAMILY_HOLE | FAMILY_BENT,
                                     WISH_STILL | WISH_NO_FRICTION | WISH_ELASTIC | WISH_NO_CONTROL | WISH_ROUND, 3},
                                    60,
                                    0.5,
                                    check_negative,
                                    0.1};
const relation relation_growth = {
    "growth",
    "the largest real part of damped modes against growth or decay of a run",
    {FAMILY_LINE, WISH_STILL | WISH_ELASTIC | WISH_NO_CONTROL | WISH_ROUND | WISH_FLEXIBLE, 3},
    12,
    0.15,
    check_growth,
    0.1};
