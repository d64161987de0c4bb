/* A run against the same run of the scene turned, moved, mirrored, in other units, or described in another order. The
 * equations are the same, so all answers are, to rounding. */
#include "relations.h"

enum { STEPS = 100, TOPIC_VIEW = TOPIC_OF_RELATION };

static scene seen;

static void compare(trial *t, const scene_view *view, int reversed)
{
    scene_transform(&t->s, view, &seen);
    const comparison c = {&seen, view, reversed, STEPS, NULL, 0};
    hold_runs(t, &c);
}

/* Axial-torsional pipes in a bent hole turn with its frame, whose y axis is horizontal: about the vertical alone is
 * such a scene the same. */
static int upright(const scene *s)
{
    return s->family == FAMILY_BENT && s->string[0].pipe[0].kind == DMB_PIPE_AXIAL_TORSIONAL;
}

static void draw_rotation(const trial *t, double rotation[3])
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_VIEW);
    const double angle = draw_number(&n, -3.0, 3.0);
    draw_direction(&n, rotation);
    if (upright(&t->s)) rotation[0] = rotation[1] = 0.0, rotation[2] = 1.0;
    for (int i = 0; i < 3; ++i) rotation[i] *= angle;
}

static void check_turned(trial *t)
{
    double rotation[3];
    draw_rotation(t, rotation);
    const scene_view view = view_turned(rotation);
    compare(t, &view, 0);
}

static void check_moved(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_VIEW + 1);
    scene_view view = view_identity();
    for (int i = 0; i < 3; ++i) view.shift[i] = draw_number(&n, -200.0, 200.0);
    compare(t, &view, 0);
}

/* Bits cut one way round, so there are none. */
static void check_mirrored(trial *t)
{
    double rotation[3];
    draw_rotation(t, rotation);
    scene_view view = view_turned(rotation);
    const double mirror[9] = {1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0};
    view.handed = -1.0;
    matrix_times(view.matrix, mirror, view.matrix);
    compare(t, &view, 0);
}

static void check_units(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_VIEW + 2);
    scene_view view = view_identity();
    view.length = draw_chance(&n, 0.5) ? 1000.0 : 1.0;                      /* millimetres */
    view.mass = view.length == 1.0 || draw_chance(&n, 0.5) ? 1000.0 : 1e-3; /* grams or tonnes */
    compare(t, &view, 0);
}

static void check_order(trial *t)
{
    const scene_view view = view_identity();
    compare(t, &view, 1);
}

const relation relation_turned = {
    "turned", "a run against that of the scene turned, gravity with it", {FAMILY_ALL, 0, 0}, 40, 0.7, check_turned,
    0.0};
const relation relation_moved = {
    "moved", "a run against that of the scene moved by some 100 m", {FAMILY_ALL, 0, 0}, 40, 0.7, check_moved, 0.0};
const relation relation_mirrored = {
    "mirrored", "a run against that of the scene in a mirror", {FAMILY_ALL, WISH_NO_BIT, 0}, 40, 0.7, check_mirrored,
    0.0};
const relation relation_units = {
    "units", "a run against that in millimetres, in grams or in tonnes", {FAMILY_ALL, 0, 0}, 40, 0.7, check_units, 0.0};
const relation relation_order = {
    "order", "a run against that of the parts added in another order", {FAMILY_ALL, 0, 0}, 40, 0.7, check_order, 0.0};
