/* A run of n pipes of two elements against that of 2n pipes of one, which are the same nodes. Flexible pipes against
 * axial-torsional ones where nothing bends them: the same bars. Flexible pipes against rigid ones as they stiffen: the
 * static states differ by 1/E. */
#include "relations.h"

enum { STEPS = 100, TOPIC_MESH = TOPIC_OF_RELATION + 10 };
static scene seen;

/* ---- Two elements or two pipes ---------------------------------------------------------------------------------- */

/* Of rigid pipes each end is a ring that meets the wall, so more of them are another scene. */
static void check_merged(trial *t)
{
    scene_view view = view_identity();
    for (uint32_t k = 0; k < t->s.strings; ++k) {
        for (uint32_t i = 0; i < t->s.string[k].pipes; ++i) {
            dmb_pipe_def *const p = &t->s.string[k].pipe[i];
            p->elements = 2;
            p->joint_length = p->joint_outer_diameter = 0.0;
        }
    }
    if (t->s.string[0].pipe[0].kind == DMB_PIPE_RIGID) {
        left_out(t, "rigid pipes");
        return;
    }
    view.halved = 1;
    scene_transform(&t->s, &view, &seen);
    const comparison c = {&seen, &view, 0, STEPS, NULL, 0};
    hold_runs(t, &c);
}

/* ---- Bars ------------------------------------------------------------------------------------------------------- */

static void set_kind(scene *s, int32_t kind)
{
    for (uint32_t k = 0; k < s->strings; ++k)
        for (uint32_t i = 0; i < s->string[k].pipes; ++i) s->string[k].pipe[i].kind = kind;
}

/* In a straight hole, with gravity along it and nothing eccentric, pipes stay on the axis. */
static void check_bars(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_MESH);
    const double along = draw_number(&n, -9.81, 9.81);
    scene_view view = view_identity();
    for (int i = 0; i < 3; ++i) t->s.environment.gravity[i] = along * t->s.wall.direction[i];
    set_kind(&t->s, DMB_PIPE_FLEXIBLE);
    seen = t->s;
    set_kind(&seen, DMB_PIPE_AXIAL_TORSIONAL);
    view.motion_only = 1;
    const comparison c = {&seen, &view, 0, STEPS, NULL, 0};
    hold_runs(t, &c);
}

/* ---- Stiff pipes ------------------------------------------------------------------------------------------------ */

static answers rigid, stiff, stiffer;

static int32_t at_rest(const scene *s, answers *out, char message[256])
{
    built b;
    scene_view view = view_identity();
    int32_t status = scene_open(s, 0, NULL, &b);
    view.motion_only = 1;
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, NULL);
    if (status < 0) (void)built_fail(&b, status);
    if (status >= 0) answers_take(s, s, &view, &b, out);
    memcpy(message, b.message, sizeof b.message);
    scene_close(&b);
    return status;
}

static void stiffen(scene *s, double factor)
{
    for (uint32_t k = 0; k < s->strings; ++k)
        for (uint32_t i = 0; i < s->string[k].pipes; ++i) s->string[k].pipe[i].young_modulus *= factor;
}

/* Positions at E and 30 E: the second is 30 times nearer to the rigid one, by 1/E and by what is left of 1/E^2. */
static void check_rigid(trial *t)
{
    char message[256];
    double near[ANSWER_GROUPS], nearer[ANSWER_GROUPS];
    seen = t->s;
    set_kind(&seen, DMB_PIPE_RIGID);
    const int32_t first = at_rest(&seen, &rigid, message);
    if (first < 0) {
        refused(t, first, message);
        return;
    }
    seen = t->s;
    stiffen(&seen, 100.0);
    int32_t status = at_rest(&seen, &stiff, message);
    stiffen(&seen, 30.0);
    if (status >= 0) status = at_rest(&seen, &stiffer, message);
    if (status < 0) {
        refused(t, status, message);
        return;
    }
    answers_difference(&rigid, &stiff, near);
    answers_difference(&rigid, &stiffer, nearer);
    if (fmax(near[ANSWER_POSITION], nearer[ANSWER_POSITION]) > 0.01 * t->s.span) {
        left_out(t, "pipes that bend a lot, or find another equilibrium");
        return;
    }
    const double rounding = 1e-9 * t->s.span; /* of statics: 1e-10 of the forces, and springs as soft as they are */
    const double part = near[ANSWER_POSITION] / t->s.span;
    hold(t, "positions at 30 E beside those at E", fabs(30.0 * nearer[ANSWER_POSITION] - near[ANSWER_POSITION]),
         30.0 * rounding + (0.02 + 10.0 * part) * near[ANSWER_POSITION]);
}

const relation relation_merged = {"merged",
                                  "a run of n pipes of two elements against that of 2n pipes of one",
                                  {FAMILY_ALL & ~FAMILY_BODIES, 0, 0},
                                  40,
                                  0.7,
                                  check_merged,
                                  0.0};
const relation relation_bars = {"bars",
                                "flexible pipes that nothing bends against axial-torsional ones",
                                {FAMILY_HOLE, WISH_ROUND | WISH_NO_FRICTION | WISH_FLEXIBLE | WISH_NO_JOINTS, 0},
                                40,
                                0.7,
                                check_bars,
                                0.0};
const relation relation_rigid = {
    "rigid",
    "static states of flexible pipes as E grows against rigid pipes",
    {FAMILY_LINE, WISH_STILL | WISH_FLEXIBLE | WISH_ELASTIC | WISH_JOINTS | WISH_NO_CONTROL, 3},
    40,
    0.5,
    check_rigid,
    0.0};
