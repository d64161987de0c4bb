/* Buckling of a string on the low side of a hole that bends, in axes of its own: the push at its far end at which the
 * equilibria lose their stability or bend off (a dip of the tangent's lowest eigenvalue) is that of twice the elements
 * and of another wall; and a path in steps of half the length is stable up to it, and has its event there. */
#include "relations.h"

enum { TOPIC_BENT = TOPIC_OF_RELATION + 70 };

#define BENT_MESH 0.05 /* of the push, twice the elements */
#define BENT_WALL 0.02 /* of the push, a wall four times as stiff */
#define BENT_PATH 1e-3 /* of the push, an event of the path; a dip is closed in to this */
/* A shallower dip is a string that bends off gradually: with another mesh another minimum may be the first that counts.
 */
#define BENT_SHALLOW 0.92

typedef struct bent {
    double outer, inner, clearance; /* [m] */
    double dip, turn, azimuth;      /* [rad] from the horizontal; by which the hole turns; towards: 0 up, pi/2 aside */
    double pipe;                    /* [m] */
    double push;                    /* [N] at the start, a part of `sinusoidal` */
    double sinusoidal;              /* [N] closed form of the straight hole (Dawson, Paslay 1984) */
    double stiffness;               /* [N/m2] of the wall */
    uint32_t pipes, elements;
    int32_t end_free; /* of the far end; of the rig end all where it is pinned, else none */
    int32_t pinned;   /* 1: the rig end on a universal joint */
    int32_t on_hole;  /* 1: the far end on the axis of the hole */
} bent;

/* Answer of one analysis. */
typedef struct said {
    int32_t status, negative;
    char message[200];
    double push; /* [N] at the first factor */
    dmb_buckling_info info;
} said;

static void draw(const trial *t, bent *b)
{
    static const int32_t ends[] = {DMB_FREE_ALL, DMB_FREE_CYLINDRICAL, DMB_FREE_ALL};
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_BENT);
    const uint32_t end = draw_count(&n, 0, 2);
    b->outer = draw_number(&n, 0.05, 0.1);
    b->inner = b->outer * draw_number(&n, 0.6, 0.9);
    b->clearance = b->outer * draw_number(&n, 0.1, 0.3);
    b->dip = draw_number(&n, -0.4, 0.4);
    b->turn = draw_chance(&n, 0.3) ? 0.0 : draw_size(&n, 1e-3, 0.2);
    b->azimuth = draw_number(&n, -PI, PI);
    b->stiffness = draw_size(&n, 1e7, 1e9);
    b->pipes = draw_count(&n, 8, 30);
    b->elements = 1;
    b->pinned = draw_chance(&n, 0.5);
    b->end_free = ends[end];
    b->on_hole = end == 2;
    const double EI = 210e9 * PI / 64.0 * (pow(b->outer, 4) - pow(b->inner, 4));
    const double w = 9.81 * 7850.0 * 0.25 * PI * (pow(b->outer, 2) - pow(b->inner, 2)) * cos(b->dip);
    b->sinusoidal = 2.0 * sqrt(EI * w / b->clearance);
    b->pipe = PI * sqrt(sqrt(EI * b->clearance / w)) / draw_number(&n, 4.0, 6.0); /* of half a wave */
    b->push = draw_number(&n, 0.01, 0.2) * b->sinusoidal;
}

static int32_t add_hole(const bent *b, dmb_model *model)
{
    const double length = b->pipe * b->pipes, up = b->turn * cos(b->azimuth), aside = b->turn * sin(b->azimuth);
    const double at = 0.5 * PI + b->dip;
    const double survey[9] = {0.0, at, 0.0, 0.5 * length, at + 0.5 * up, 0.5 * aside, length, at + up, aside};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    wall.diameter = b->outer + 2.0 * b->clearance;
    wall.stiffness = b->stiffness;
    wall.friction_law = DMB_FRICTION_NONE;
    wall.survey = survey;
    wall.survey_count = 3;
    environment.gravity[0] = environment.gravity[1] = 0.0;
    environment.gravity[2] = -9.81;
    const int32_t status = dmb_model_set_environment(model, &environment);
    return status < 0 ? status : dmb_model_add_wall(model, &wall, NULL);
}

static int32_t add_string(const bent *b, dmb_model *model, dmb_id *string)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    def.start_free = b->pinned ? DMB_FREE_ALL : DMB_FREE_NONE;
    def.end_free = b->end_free;
    int32_t status = dmb_model_add_string(model, &def, string);
    pipe.string = *string;
    pipe.length = b->pipe;
    pipe.elements = b->elements;
    pipe.outer_diameter = b->outer;
    pipe.inner_diameter = b->inner;
    pipe.young_modulus = 210e9;
    pipe.density = 7850.0;
    if (status >= 0) status = dmb_model_add_pipes(model, &pipe, b->pipes, NULL);
    joint.kind = DMB_JOINT_UNIVERSAL;
    joint.place_b = dmb_station(*string, 0, 0.0);
    if (status >= 0 && b->pinned) status = dmb_model_add_joint(model, &joint, NULL);
    joint = dmb_joint_def_default();
    joint.kind = DMB_JOINT_POINT_ON_HOLE;
    joint.place_b = dmb_station(*string, b->pipes - 1, 1.0);
    return status < 0 || !b->on_hole ? status : dmb_model_add_joint(model, &joint, NULL);
}

static int32_t open_bent(const bent *b, dmb_model **model, dmb_sim **sim, dmb_id *push)
{
    dmb_id string = {0, 0};
    dmb_load_def load = dmb_load_def_default();
    int32_t status = dmb_model_create(NULL, model);
    if (status >= 0) status = add_hole(b, *model);
    if (status >= 0) status = add_string(b, *model, &string);
    load.frame = DMB_FRAME_HOLE;
    load.place = dmb_station(string, b->pipes - 1, 1.0);
    load.force[0] = -b->push;
    if (status >= 0) status = dmb_model_add_load(*model, &load, push);
    if (status >= 0) status = dmb_model_compile(*model, NULL);
    return status < 0 ? status : dmb_sim_create(*model, NULL, sim);
}

static void close_bent(dmb_model **model, dmb_sim **sim)
{
    dmb_sim_destroy(sim);
    dmb_model_destroy(model);
}

/* ---- The path ---------------------------------------------------------------------------------------------------- */

/* First event of a path, and its first point with a negative eigenvalue. */
typedef struct events {
    double event, unstable;
} events;

static int32_t look(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    events *const e = context;
    (void)at;
    if (point->kind == DMB_PATH_REGULAR && point->negative > 0) e->unstable = fmin(e->unstable, point->factor);
    if (point->kind != DMB_PATH_REGULAR) e->event = fmin(e->event, point->factor);
    return e->event < 1e300;
}

/* To a little beyond the factor. */
static int32_t path_of(dmb_sim *sim, dmb_id push, double factor, double part, events *e)
{
    dmb_path_options options = dmb_path_options_default();
    e->event = e->unstable = 1e300;
    options.scale = DMB_SCALE_PART;
    options.part = push;
    options.factor_end = 1.01 * factor;
    options.first_step = part * factor;
    options.max_points = 4000;
    options.callback = look;
    options.callback_context = e;
    return dmb_analysis_path(sim, &options, NULL);
}

/* Steps of the path grow as they like from the first one: two paths, the second from half of it. */
static void hold_path(trial *t, const bent *b, const said *a, dmb_sim *sim, dmb_id push)
{
    const double factor = a->push / b->push - 1.0;
    for (double part = 0.02; part > 0.009; part *= 0.5) {
        events e;
        if (path_of(sim, push, factor, part, &e) < 0 && e.event == 1e300) {
            left_out(t, "a path that is lost before its event");
            return;
        }
        const double first = fmin(e.event, e.unstable);
        hold(t, "factor over the first event of the path", factor / first - 1.0, BENT_PATH);
        if (a->info.end == DMB_BUCKLING_BIFURCATION)
            hold(t, "first event of the path beside the factor", fabs(first / factor - 1.0), BENT_PATH);
    }
}

/* ---- The relation ------------------------------------------------------------------------------------------------ */

/* with_path: of the trial's own scene. */
static void ask(trial *t, const bent *b, int with_path, said *out)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_id push;
    dmb_buckling *found = NULL;
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_static_report report = dmb_static_report_default();
    double factor = (double)INFINITY;
    memset(out, 0, sizeof *out);
    out->info = dmb_buckling_info_default();
    options.scale = DMB_SCALE_PART;
    out->status = open_bent(b, &model, &sim, &push);
    options.part = push;
    if (out->status >= 0) out->status = dmb_analysis_static(sim, NULL, &report);
    out->negative = report.negative;
    if (out->status >= 0 && report.negative == 0) out->status = dmb_analysis_buckling(sim, &options, &found);
    (void)snprintf(out->message, sizeof out->message, "%s", sim ? dmb_sim_message(sim) : dmb_model_message(model));
    (void)dmb_buckling_factor(found, 0, &factor);
    out->push = (1.0 + factor) * b->push;
    if (found != NULL) (void)dmb_buckling_get_info(found, &out->info);
    dmb_buckling_destroy(&found);
    if (with_path && out->status >= 0 && out->info.confirmed > 0) hold_path(t, b, out, sim, push);
    close_bent(&model, &sim);
}

static int is_shallow(const said *a)
{
    return a->info.end == DMB_BUCKLING_DIP && a->info.dip < BENT_SHALLOW;
}

/* Of a scene that another one was made of. */
static void hold_alike(trial *t, const char *what, const bent *other, const said *a, double tolerance)
{
    said c;
    if (t->verdict != VERDICT_HELD) return;
    ask(t, other, 0, &c);
    if (c.status < 0) {
        broken(t, c.message, c.status, a->push);
        return;
    }
    if (c.info.confirmed == 0) {
        left_out(t, "a factor that is not confirmed with another mesh or wall");
        return;
    }
    if (is_shallow(a) || is_shallow(&c)) {
        left_out(t, "a string that bends off gradually");
        return;
    }
    hold(t, what, fabs(c.push / a->push - 1.0), tolerance);
}

static void check_bent(trial *t)
{
    bent b, other;
    said a;
    draw(t, &b);
    ask(t, &b, 1, &a);
    if (a.status < 0)
        refused(t, a.status, a.message);
    else if (a.negative != 0)
        left_out(t, "a start above the critical load");
    else if (a.info.confirmed == 0)
        left_out(t, isfinite(a.push) ? "a factor that is not confirmed" : "no critical factor");
    other = b;
    other.elements = 2;
    hold_alike(t, "push at buckling beside that of twice the elements", &other, &a, BENT_MESH);
    other = b;
    other.stiffness *= 4.0;
    hold_alike(t, "push at buckling beside that of a wall four times as stiff", &other, &a, BENT_WALL);
    t->telling = a.info.end == DMB_BUCKLING_DIP;
}

const relation relation_bent = {
    "bent",
    "the buckling load of a string in a bent hole against half the steps, twice the mesh and a stiffer wall",
    {FAMILY_BENT, WISH_FLEXIBLE, 0},
    8,
    0.3,
    check_bent,
    0.2};
