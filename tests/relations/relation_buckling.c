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

/* Loads beside the push. */
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
    double stable, unstable; /* [-] largest factor with an even number of negative eigenvalues, smallest with another */
    int32_t before;          /* negative eigenvalues there */
    int32_t changed;         /* their number at the bifurcation less that */
    int32_t symmetric;       /* 1: K is, and any negative eigenvalue is a loss of stability */
    int32_t to_event;        /* 1: the path ends at its first event */
    double rate;             /* largest of the factor along the path [1/m] */
} signs;

/* A complex pair of an unsymmetric K that becomes real and negative adds 2 to the count and passes no 0: only the
 * bifurcation tells then. */
static int32_t look(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    signs *const s = context;
    (void)at;
    s->rate = fmax(s->rate, point->rate);
    if (point->kind == DMB_PATH_BIFURCATION) s->changed = point->negative - s->before;
    if (point->kind != DMB_PATH_REGULAR) return s->to_event; /* there the sign is told for what is beyond */
    const int beyond = s->symmetric ? point->negative > 0 : s->changed != 0;
    if (!beyond && point->factor > s->stable) s->stable = point->factor;
    if (!beyond) s->before = point->negative;
    if (beyond && point->factor < s->unstable) s->unstable = point->factor;
    return 0;
}

/* next: the factor after it; an unsymmetric K may be stable again beyond, and the path ends before. step: first one of
 * the path, over the factor. */
static void hold_path(trial *t, built *b, const double factor_and_next[2], double step, double tolerance)
{
    const double factor = factor_and_next[0], next = factor_and_next[1];
    signs s = {0.0, 1e300, 0, 0, extras_of(&t->s).torque == 0.0, 0, 0.0};
    dmb_path_options options = dmb_path_options_default();
    dmb_path_report report = dmb_path_report_default();
    options.factor_end = s.symmetric ? 1.2 * factor : fmin(1.2 * factor, 0.5 * (factor + next));
    options.first_step = step * factor;
    options.callback = look;
    options.callback_context = &s;
    const int32_t status = dmb_analysis_path(b->sim, &options, &report);
    if (status < 0) {
        broken(t, dmb_sim_message(b->sim), status, 0.0);
        return;
    }
    if (report.bifurcations == 0) broken(t, "no bifurcation on the path", report.factor, factor);
    hold(t, "factor beside the bifurcation of the path", fabs(report.first_bifurcation / factor - 1.0), tolerance);
    hold(t, "last stable point of the path over the factor", s.stable / factor - 1.0, tolerance);
    hold(t, "factor over the first unstable point of the path", 1.0 - s.unstable / factor, tolerance);
    if (s.unstable == 1e300) broken(t, "no unstable point beyond the bifurcation", report.factor, factor);
    if (report.limits > 0) broken(t, "limit points of a straight path", report.limits, 0.0);
    if (s.changed == 0) broken(t, "negative eigenvalues at the bifurcation", s.changed, 1.0);
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

/* ---- Flutter ---------------------------------------------------------------------------------------------------- */

/* Largest real part of all damped modes under `push`, its root to `root`; 0 where they cannot be had. */
static int growth_under(trial *t, double push, double root[2])
{
    static scene s;
    built b;
    dmb_modes *found = NULL;
    dmb_mode mode = dmb_mode_default();
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = DMB_MODES_DAMPED;
    options.select = DMB_MODES_ALL;
    s = t->s;
    push_along(&s, push);
    int32_t status = scene_open(&s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, NULL);
    if (status >= 0) status = dmb_analysis_modes(b.sim, &options, &found);
    root[0] = -1e300;
    for (uint32_t i = 0; status >= 0 && dmb_modes_get(found, i, &mode) >= 0; ++i)
        if (mode.eigenvalue[0] > root[0]) memcpy(root, mode.eigenvalue, sizeof mode.eigenvalue);
    dmb_modes_destroy(&found);
    scene_close(&b);
    return status >= 0;
}

/* Far enough beyond the load of flutter a run leaves as its fastest mode grows: e^6 in the time of e^6. */
static void hold_leaving(trial *t, double push)
{
    static scene s;
    built b;
    double root[2], first = 0.0, force[3];
    scene_view view = view_identity();
    if (!growth_under(t, push, root) || !(root[0] > 0.0)) return;
    const double step = fmin(0.05 / hypot(root[0], root[1]), 0.02 / root[0]), time = 6.0 / root[0];
    if (time / step > 6000.0) return;
    s = t->s;
    push_along(&s, push);
    stream n = stream_of(s.seed, s.number, TOPIC_BUCKLING + 3);
    draw_direction(&n, force);
    for (int i = 0; i < 3; ++i) force[i] *= 1e-9 * push;
    scene_kick(&s, force, 5.0 * step);
    view.motion_only = 1;
    int32_t status = scene_open(&s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, NULL);
    if (status >= 0) answers_take(&s, &s, &view, &b, &rest);
    const uint32_t steps = (uint32_t)(time / step);
    double most = 0.0;
    for (uint32_t i = 0; i < 3 * steps && status >= 0; ++i) {
        status = run_steps(&b, step, 1, NULL);
        if (status >= 0 && i < steps) first = fmax(first, largest_distance(&s, &b));
        if (status >= 0 && i >= 2 * steps) most = fmax(most, largest_distance(&s, &b));
    }
    scene_close(&b);
    /* between the ends of the first and the third stretch e^12, of which 8 digits stand over rounding */
    if (status >= 0 && first > 1e-13 * s.span)
        hold(t, "growth of a run beyond flutter", fabs(log(most / first) / 12.0 - 1.0), 0.25);
}

static void hold_flutter(trial *t, const dmb_buckling_info *info, double push, double factor)
{
    double below[2], above[2];
    if (info->stiffness != DMB_STIFFNESS_UNSYMMETRIC) broken(t, "stiffness under a fixed moment", info->stiffness, 1);
    if (info->flutter == DMB_FLUTTER_NOT_JUDGED) {
        if (t->verdict == VERDICT_HELD) left_out(t, "modes that cannot be found sharply");
        return;
    }
    if (info->flutter == DMB_FLUTTER_NONE) {
        if (growth_under(t, (1.0 + 0.97 * factor) * push, below) && below[0] > 1e-6 * hypot(below[0], below[1]))
            broken(t, "a mode grows below the factor, and no flutter was told", below[0], below[1]);
        return;
    }
    t->telling = 1;
    const double load = 1.0 + info->flutter_factor;
    if (info->flutter_factor > factor) broken(t, "flutter beyond the factor", info->flutter_factor, factor);
    if (info->flutter_factor > 0.0 && growth_under(t, 0.998 * load * push, below) && below[0] > 0.0)
        broken(t, "a mode grows below flutter", below[0], below[1]);
    if (growth_under(t, (info->flutter_factor > 0.0 ? 1.002 : 1.0) * load * push, above) && !(above[0] > 0.0))
        broken(t, "no mode grows above flutter", above[0], above[1]);
    hold_leaving(t, 1.1 * load * push);
}

/* ---- In a hole -------------------------------------------------------------------------------------------------- */

/* A string that lies in a straight hole by its weight, pushed at its far end along the axis by a part of what would
 * make it snake there, 2 sqrt(EI w/r) (Dawson, Paslay 1984), or of Euler's load where that is more. */
static void push_in_hole(scene *s, double part)
{
    const dmb_pipe_def *const p = &s->string[0].pipe[0];
    const double EI = p->young_modulus * PI / 64.0 * (pow(p->outer_diameter, 4) - pow(p->inner_diameter, 4));
    const double w = 9.81 * line_mass(s) / s->span * fabs(s->wall.direction[0]);
    const double r = 0.5 * (s->wall.diameter - p->outer_diameter);
    const double push = part * fmax(2.0 * sqrt(EI * w / r), 8.0 * column_load(s));
    load_data *const l = &s->load[0];
    s->loads = 1;
    s->bit_load.terms = 0;
    l->def = dmb_load_def_default();
    l->def.frame = DMB_FRAME_WORLD;
    for (int i = 0; i < 3; ++i) l->def.force[i] = -push * s->wall.direction[i];
    l->place.kind = PART_STRING;
    l->place.index = s->strings - 1;
    l->place.pipe = s->string[s->strings - 1].pipes - 1;
    l->place.fraction = 1.0;
}

/* The path passes unstable stretches of a twentieth of the factor by where single contacts open and close
 * (lib/theory/limits.md).
 */
#define PASSED_BY 0.05

static void hold_path_in_hole(trial *t, built *b, double factor)
{
    signs s = {0.0, 1e300, 0, 0, 1, 1, 0.0};
    dmb_path_options options = dmb_path_options_default();
    dmb_path_report report = dmb_path_report_default();
    options.factor_end = 1.02 * factor;
    options.first_step = 0.02 * factor;
    options.max_points = 400;
    options.callback = look;
    options.callback_context = &s;
    int32_t status = dmb_analysis_path(b->sim, &options, &report);
    if (status >= 0 && isnan(fmin(report.first_limit, report.first_bifurcation))) { /* passed by: in shorter steps */
        options.step_max = 2e-4 * factor / s.rate;
        options.max_points = 6000;
        status = dmb_analysis_path(b->sim, &options, &report);
    }
    const double event = fmin(report.first_limit, report.first_bifurcation); /* fmin leaves NaN out */
    if (isnan(event) && status < 0) {
        left_out(t, "a path in a hole that is lost before its event");
        return;
    }
    if (isnan(event)) broken(t, "no event on the path in a hole", report.factor, factor);
    hold(t, "factor beside the event of the path in a hole", fabs(event / factor - 1.0), PASSED_BY);
    if (s.unstable < 1e300)
        hold(t, "factor over the first unstable point in a hole", 1.0 - s.unstable / factor, PASSED_BY);
    t->telling = 1;
}

/* After a kick the string stays near: it swings no further late than early. */
static void hold_staying(trial *t, double factor)
{
    static scene s;
    built b;
    dmb_static_report report = dmb_static_report_default();
    scene_view view = view_identity();
    const double axis[3] = {-t->s.wall.direction[2], 0.3, t->s.wall.direction[0]};
    double early = 0.0, late = 0.0, force[3];
    s = t->s;
    for (int i = 0; i < 3; ++i) {
        force[i] = 1e-7 * (1.0 + 0.9 * factor) * fabs(s.load[0].def.force[0]) * axis[i];
        s.load[0].def.force[i] *= 1.0 + 0.9 * factor;
    }
    scene_kick(&s, force, 5.0 * s.step);
    view.motion_only = 1;
    int32_t status = scene_open(&s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, &report);
    if (status >= 0) answers_take(&s, &s, &view, &b, &rest);
    for (int i = 0; i < 1200 && status >= 0 && report.negative == 0; ++i) {
        status = run_steps(&b, s.step, 1, NULL);
        double *const most = i < 600 ? &early : &late;
        if (status >= 0) *most = fmax(*most, largest_distance(&s, &b));
    }
    scene_close(&b);
    if (status < 0 || report.negative != 0) return;
    hold(t, "late beside early distance below the factor in a hole", late / (early + 1e-9 * s.span), 10.0);
}

static void check_snaked(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_BUCKLING);
    built b;
    dmb_buckling *found = NULL;
    dmb_static_report report = dmb_static_report_default();
    double factor = 0.0;
    push_in_hole(&t->s, draw_number(&n, 0.02, 0.3));
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, &report);
    if (status >= 0 && report.negative == 0) status = dmb_analysis_buckling(b.sim, NULL, &found);
    if (status < 0)
        refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
    else if (report.negative != 0)
        left_out(t, "a start above the critical load");
    else if (dmb_buckling_factor(found, 0, &factor) < 0)
        left_out(t, "no critical factor");
    if (t->verdict == VERDICT_HELD) hold_path_in_hole(t, &b, factor);
    dmb_buckling_destroy(&found);
    scene_close(&b);
    if (t->verdict == VERDICT_HELD) hold_staying(t, factor);
}

/* ---- All -------------------------------------------------------------------------------------------------------- */

/* First step of a path over the factor; the path of twice the elements has half of it. */
#define BUCKLED_STEP 0.07
/* [-] Load beside that of twice the elements: one element a column has 0.0075, two have 0.0005. */
#define BUCKLED_MESH 0.015

/* The answer of the analysis about the line under its present push. */
typedef struct told {
    double factor[2]; /* two lowest, infinite: none */
    dmb_buckling_info info;
} told;

static void ask(trial *t, built *b, told *out)
{
    dmb_buckling *found = NULL;
    dmb_static_report report = dmb_static_report_default();
    dmb_buckling_options options = dmb_buckling_options_default();
    options.count = 2;
    out->factor[0] = out->factor[1] = (double)INFINITY;
    out->info = dmb_buckling_info_default();
    int32_t status = scene_open(&t->s, 0, NULL, b);
    if (status >= 0) status = dmb_analysis_static(b->sim, NULL, &report);
    if (status >= 0 && report.negative == 0) status = dmb_analysis_buckling(b->sim, &options, &found);
    if (status < 0) refused(t, status, b->sim ? dmb_sim_message(b->sim) : b->message);
    if (report.negative != 0) left_out(t, "a start above the critical load");
    for (uint32_t i = 0; i < 2; ++i) (void)dmb_buckling_factor(found, i, &out->factor[i]);
    if (found != NULL) (void)dmb_buckling_get_info(found, &out->info);
    dmb_buckling_destroy(&found);
}

static void multiply_elements(scene *s, uint32_t by)
{
    for (uint32_t i = 0; i < s->strings; ++i)
        for (uint32_t p = 0; p < s->string[i].pipes; ++p) s->string[i].pipe[p].elements *= by;
}

/* The same line with twice the elements, and its path in half the steps. */
static void hold_finer(trial *t, const told *coarse, double tolerance)
{
    built b;
    told fine;
    multiply_elements(&t->s, 2);
    ask(t, &b, &fine);
    const double load = 1.0 + coarse->factor[0], finer = 1.0 + fine.factor[0];
    if (t->verdict == VERDICT_HELD) {
        hold(t, "load of buckling beside that of twice the elements", fabs(finer / load - 1.0),
             BUCKLED_MESH + tolerance);
        if (isfinite(finer))
            hold_path(t, &b, fine.factor, 0.5 * BUCKLED_STEP, tolerance * (1.0 + 1.0 / fine.factor[0]));
    }
    scene_close(&b);
}

static void check_buckled(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_BUCKLING);
    built b;
    told said;
    for (uint32_t i = 0; i < t->s.strings; ++i)
        for (uint32_t p = 0; p < t->s.string[i].pipes; ++p) t->s.string[i].pipe[p].elements = 1U << t->s.number % 3;
    const double push = column_load(&t->s) * draw_number(&n, 0.02, 0.5);
    push_along(&t->s, push);
    t->s.radius = 1.0; /* no growth is damped away */
    ask(t, &b, &said);
    const int flutters = said.info.flutter == DMB_FLUTTER_FOUND, factor = isfinite(said.factor[0]);
    const double most = factor ? said.factor[0] : flutters ? said.info.flutter_factor : 0.0;
    const double critical = (1.0 + most) * push, weight = fabs(extras_of(&t->s).weight);
    const double tolerance = 1e-6 + 20.0 * shortening(&t->s, critical + weight);
    if (!factor && !flutters) left_out(t, "no critical factor");
    if (tolerance > 0.02) left_out(t, "a line that shortens much");
    if (t->verdict == VERDICT_HELD && factor)
        hold_path(t, &b, said.factor, BUCKLED_STEP, tolerance * (1.0 + 1.0 / said.factor[0]));
    scene_close(&b);
    if (t->verdict != VERDICT_HELD) return;
    static scene present;
    present = t->s;
    if (factor) hold_finer(t, &said, tolerance);
    t->s = present;
    if (t->verdict != VERDICT_HELD) return;
    if (extras_of(&t->s).torque == 0.0)
        hold_runs_apart(t, critical);
    else
        hold_flutter(t, &said.info, push, said.factor[0]);
}

const relation relation_buckled = {
    "buckled",
    "the factors of buckling and flutter against twice the elements, the path, modes, and runs below and above",
    {FAMILY_LINE, WISH_STILL | WISH_ELASTIC | WISH_NO_CONTROL | WISH_ROUND | WISH_FLEXIBLE | WISH_CONSERVATIVE, 3},
    12,
    0.4,
    check_buckled,
    0.0};
const relation relation_snaked = {
    "snaked",
    "the buckling factor of a string that lies in a hole against the path and a run below",
    {FAMILY_HOLE,
     WISH_STILL | WISH_ELASTIC | WISH_NO_CONTROL | WISH_ROUND | WISH_FLEXIBLE | WISH_CONSERVATIVE | WISH_HARD |
         WISH_NO_BIT,
     4},
    8,
    0.3,
    check_snaked,
    0.0};
