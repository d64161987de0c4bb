/* The factor of linear buckling against the sign change of det K on the path of equilibria, against the static states
 * below and above it, and against the load at which a run in time leaves. Straight lines pushed along: sections do not
 * bend on the way there. A third has no weight, a third stands on or hangs from its rig end by a weight that does not
 * grow with the push, a third is twisted by a moment with a fixed axis, which makes the stiffness unsymmetric: such a
 * line may flutter before it diverges, so that its runs in time are left out. */
#include "relations.h"

enum { TOPIC_BUCKLING = TOPIC_OF_RELATION + 40 };

/* ---- The line --------------------------------------------------------------------------------------------------- */

/* Euler's load of the strings as one clamped-free column */
static double column_load(const scene *s)
{
    const dmb_pipe_def *const p = &s->string[0].pipe[0];
    return 0.25 * PI * PI * p->young_modulus * PI / 64.0 * (pow(p->outer_diameter, 4) - pow(p->inner_diameter, 4)) /
           (s->span * s->span);
}

/* What acts beside the push. */
typedef struct extras {
    double weight; /* [N] of the line, towards its rig end */
    double torque; /* [N m] over a newton of the push */
} extras;

static extras extras_of(const scene *s)
{
    stream n = stream_of(s->seed, s->number, TOPIC_BUCKLING + 2);
    extras e = {0.0, 0.0};
    const uint32_t kind = draw_count(&n, 0, 2);
    if (kind == 1) e.weight = draw_number(&n, -1.0, 1.0) * column_load(s);
    if (kind == 2) e.torque = draw_number(&n, 0.02, 0.3) * s->span;
    return e;
}

/* [kg] of the pipes */
static double line_mass(const scene *s)
{
    const dmb_pipe_def *const p = &s->string[0].pipe[0];
    return s->span * p->density * 0.25 * PI * (pow(p->outer_diameter, 2) - pow(p->inner_diameter, 2));
}

static void push_along(scene *s, double push)
{
    const extras e = extras_of(s);
    double R[9];
    rotation_of_vector(s->string[0].def.rotation, R);
    s->load[0].def.frame = DMB_FRAME_WORLD;
    for (int i = 0; i < 3; ++i) {
        s->environment.gravity[i] = -e.weight / line_mass(s) * R[3 * i];
        s->load[0].def.force[i] = -push * R[3 * i];
        s->load[0].def.moment[i] = e.torque * push * R[3 * i];
    }
}

/* [-] by how much the line is shorter under `push`: of pipes and springs, beside its length. */
static double shortening(const scene *s, double push)
{
    const dmb_pipe_def *const p = &s->string[0].pipe[0];
    const double o = p->outer_diameter, i = p->inner_diameter;
    double flexible = s->span / (p->young_modulus * 0.25 * PI * (o * o - i * i));
    for (uint32_t k = 0; k < s->joints; ++k)
        if (s->joint[k].def.stiffness[DMB_X] > 0.0) flexible += 1.0 / s->joint[k].def.stiffness[DMB_X];
    return push * flexible / s->span;
}

/* ---- The path --------------------------------------------------------------------------------------------------- */

typedef struct signs {
    double stable, unstable; /* [-] largest factor with no negative eigenvalue, smallest with one */
    int32_t at, beyond;      /* negative eigenvalues at the bifurcation, and at the first unstable point */
} signs;

static int32_t look(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    signs *const s = context;
    (void)at;
    if (point->kind == DMB_PATH_BIFURCATION) s->at = point->negative;
    if (point->kind != DMB_PATH_REGULAR) return 0; /* there the sign is told for what is beyond */
    if (point->negative == 0 && point->factor > s->stable) s->stable = point->factor;
    if (point->negative > 0 && point->factor < s->unstable) {
        s->unstable = point->factor;
        s->beyond = point->negative;
    }
    return 0;
}

static void hold_path(trial *t, built *b, double factor, double tolerance)
{
    signs s = {0.0, 1e300, 0, 0};
    dmb_path_options options = dmb_path_options_default();
    dmb_path_report report = dmb_path_report_default();
    options.factor_end = 1.2 * factor;
    options.first_step = 0.07 * factor;
    options.callback = look;
    options.callback_context = &s;
    const int32_t status = dmb_analysis_path(b->sim, &options, &report);
    if (status < 0) {
        broken(t, dmb_sim_message(b->sim), status, 0.0);
        return;
    }
    /* a complex pair of an unsymmetric stiffness that becomes real and negative passes no 0 */
    const int pair = extras_of(&t->s).torque != 0.0 && report.bifurcations == 0 && s.beyond == 2;
    if (report.bifurcations == 0 && !pair) broken(t, "no bifurcation on the path", report.factor, factor);
    if (!pair)
        hold(t, "factor beside the bifurcation of the path", fabs(report.first_bifurcation / factor - 1.0), tolerance);
    hold(t, "last stable point of the path over the factor", s.stable / factor - 1.0, tolerance);
    hold(t, "factor over the first unstable point of the path", 1.0 - s.unstable / factor, tolerance);
    if (s.unstable == 1e300) broken(t, "no unstable point beyond the bifurcation", report.factor, factor);
    if (report.limits > 0) broken(t, "limit points of a straight path", report.limits, 0.0);
    if (s.at < 1 && !pair) broken(t, "negative eigenvalues at the bifurcation", s.at, 1.0);
}

/* ---- In time ---------------------------------------------------------------------------------------------------- */

static answers rest, now;

static double largest_distance(const scene *s, const built *b)
{
    double difference[ANSWER_GROUPS];
    scene_view view = view_identity();
    view.motion_only = 1;
    answers_take(s, s, &view, b, &now);
    answers_difference(&rest, &now, difference);
    return difference[ANSWER_POSITION];
}

static double fastest_growth(built *b)
{
    dmb_modes *found = NULL;
    dmb_mode mode = dmb_mode_default();
    double most = 0.0;
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = DMB_MODES_DAMPED; /* drag slows it down */
    options.select = DMB_MODES_ALL;
    if (dmb_analysis_modes(b->sim, &options, &found) < 0) return 0.0;
    for (uint32_t i = 0; dmb_modes_get(found, i, &mode) >= 0; ++i) most = fmax(most, mode.eigenvalue[0]);
    dmb_modes_destroy(&found);
    return most;
}

/* A short push to the side on the static state under `push`; *growth is that of its modes, and where it is 0 on entry
 * tells how long the run is: until a growing one is e^8 times as large. Returns the largest distance from rest. */
static double leave(trial *t, double push, double *growth, int32_t *negative)
{
    static scene s;
    built b;
    dmb_static_report report = dmb_static_report_default();
    scene_view view = view_identity();
    double most = 0.0;
    s = t->s;
    push_along(&s, push);
    view.motion_only = 1;
    int32_t status = scene_open(&s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, &report);
    *negative = report.negative;
    if (status >= 0 && *growth == 0.0) *growth = fastest_growth(&b);
    scene_close(&b);
    if (status < 0 || *growth == 0.0) return most;
    const double time = 8.0 / *growth, step = time / 400.0;
    stream n = stream_of(s.seed, s.number, TOPIC_BUCKLING + 1);
    double force[3];
    draw_direction(&n, force);
    for (int i = 0; i < 3; ++i) force[i] *= 1e-6 * push;
    scene_kick(&s, force, 5.0 * step);
    status = scene_open(&s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, NULL);
    if (status >= 0) answers_take(&s, &s, &view, &b, &rest);
    for (int i = 0; i < 400 && status >= 0; ++i) {
        status = run_steps(&b, step, 1, NULL);
        most = fmax(most, largest_distance(&s, &b));
    }
    scene_close(&b);
    return most;
}

static void hold_runs_apart(trial *t, double critical)
{
    double growth = 0.0;
    int32_t above = 0, below = 0;
    const double left = leave(t, 1.03 * critical, &growth, &above);
    if (above < 1 || growth == 0.0) {
        broken(t, "stable above the critical load: negative, growth", above, growth);
        return;
    }
    const double stayed = leave(t, 0.97 * critical, &growth, &below);
    if (below != 0) broken(t, "negative eigenvalues below the critical load", below, 0);
    hold(t, "distance below beside that above the critical load", 15.0 * stayed / left, 1.0);
}

/* ---- All -------------------------------------------------------------------------------------------------------- */

static void check_buckled(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_BUCKLING);
    built b;
    dmb_buckling *found = NULL;
    dmb_static_report report = dmb_static_report_default();
    double factor = 0.0, push = column_load(&t->s) * draw_number(&n, 0.02, 0.5);
    push_along(&t->s, push);
    t->s.radius = 1.0; /* no growth is damped away */
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, &report);
    if (status >= 0 && report.negative == 0) status = dmb_analysis_buckling(b.sim, NULL, &found);
    if (status < 0)
        refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
    else if (report.negative != 0)
        left_out(t, "a start above the critical load");
    else if (dmb_buckling_factor(found, 0, &factor) < 0)
        left_out(t, "no critical factor");
    const double critical = (1.0 + factor) * push, weight = fabs(extras_of(&t->s).weight);
    const double tolerance = 1e-6 + 20.0 * shortening(&t->s, critical + weight);
    if (t->verdict == VERDICT_HELD && tolerance > 0.02) left_out(t, "a line that shortens much");
    if (t->verdict == VERDICT_HELD) hold_path(t, &b, factor, tolerance * (1.0 + 1.0 / factor));
    dmb_buckling_destroy(&found);
    scene_close(&b);
    if (t->verdict == VERDICT_HELD && extras_of(&t->s).torque == 0.0) hold_runs_apart(t, critical);
}

const relation relation_buckled = {
    "buckled",
    "the buckling factor against det K on the path and runs below and above",
    {FAMILY_LINE, WISH_STILL | WISH_ELASTIC | WISH_NO_CONTROL | WISH_ROUND | WISH_FLEXIBLE | WISH_CONSERVATIVE, 3},
    12,
    0.4,
    check_buckled,
    0.0};
