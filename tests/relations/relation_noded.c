/* The same scene with a node where a load acts or without: a pipe with a load inside one of its elements against two
 * pipes that meet there, with 1, 2 and 4 elements each. Linear statics of straight elements are exact at nodes, and
 * their section forces everywhere (eq:beam.section-force), so that both differ by the square of the motion alone: loads
 * and weight are made small. */
#include "relations.h"

enum { TOPIC_NODED = TOPIC_OF_RELATION + 90 };

#define NODED_LOADS 1e-4    /* of loads and weight as drawn */
#define NODED_ROUNDING 1e-6 /* of the largest displacement and force: Newton stops at 1e-10 of the forces */
#define NODED_SQUARE 1.0    /* times the motion over the length of an element */

enum { PLACES_MOST = 65 };

/* Displacements [m] and section forces [N, N m] at the same places of both scenes. Every fourth place is a node, whose
 * displacements are compared; at the others, between nodes, section forces are. */
typedef struct shape {
    double displacement[PLACES_MOST][3], force[PLACES_MOST][6];
    double size[3]; /* m, N, N m */
} shape;

static scene split;
static shape whole, parts;

/* ---- The pipe in two --------------------------------------------------------------------------------------------- */

/* Of the pipe `at` names; what was on it goes to the part that has it. */
static void move_place(const part_ref *at, part_ref *r)
{
    if (r->kind != PART_STRING || r->index != at->index || r->pipe < at->pipe) return;
    if (r->pipe > at->pipe) {
        ++r->pipe;
    } else if (r->fraction <= at->fraction) {
        r->fraction = fmin(1.0, r->fraction / at->fraction);
    } else {
        ++r->pipe;
        r->fraction = (r->fraction - at->fraction) / (1.0 - at->fraction);
    }
}

/* The tool joint is at the far end. */
static void split_pipe(const scene *s, const part_ref *at, scene *out)
{
    *out = *s;
    string_data *const string = &out->string[at->index];
    memmove(&string->pipe[at->pipe + 1], &string->pipe[at->pipe], (string->pipes - at->pipe) * sizeof string->pipe[0]);
    ++string->pipes;
    string->pipe[at->pipe].length *= at->fraction;
    string->pipe[at->pipe].joint_length = string->pipe[at->pipe].joint_outer_diameter = 0.0;
    string->pipe[at->pipe + 1].length *= 1.0 - at->fraction;
    for (uint32_t i = 0; i < out->joints; ++i) {
        move_place(at, &out->joint[i].a);
        move_place(at, &out->joint[i].b);
    }
    for (uint32_t i = 0; i < out->loads; ++i) move_place(at, &out->load[i].place);
}

/* ---- Places ------------------------------------------------------------------------------------------------------ */

static int is_node(uint32_t i)
{
    return i % 4 == 0;
}

/* The load's, then of each pipe three between and one at its far end. */
static uint32_t places_of(const scene *s, const part_ref *load, part_ref *places)
{
    uint32_t count = 0;
    places[count++] = *load;
    for (uint32_t k = 0; k < s->strings; ++k)
        for (uint32_t p = 0; p < s->string[k].pipes && count + 4 <= PLACES_MOST; ++p) {
            for (int i = 0; i < 3; ++i) places[count++] = (part_ref){PART_STRING, k, p, 0.11 + 0.37 * i};
            places[count++] = (part_ref){PART_STRING, k, p, 1.0};
        }
    return count;
}

static void take_place(const built *b, part_ref place, uint32_t i, shape *out)
{
    dmb_pose pose = dmb_pose_default();
    dmb_section section = dmb_section_default();
    (void)dmb_query_pose(b->sim, built_place(b, place), &pose);
    (void)dmb_query_section(b->sim, built_place(b, place), &section);
    for (int c = 0; c < 3; ++c) {
        out->displacement[i][c] = pose.displacement[c];
        out->size[0] = fmax(out->size[0], fabs(pose.displacement[c]));
    }
    for (int c = 0; c < 6; ++c) {
        out->force[i][c] = section.force[c];
        out->size[1 + c / 3] = fmax(out->size[1 + c / 3], fabs(section.force[c]));
    }
}

static int32_t at_rest(const scene *s, const part_ref *places, uint32_t count, shape *out, char message[256])
{
    built b;
    memset(out, 0, sizeof *out);
    int32_t status = scene_open(s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, NULL);
    if (status < 0) (void)built_fail(&b, status);
    for (uint32_t i = 0; i < count && status >= 0; ++i) take_place(&b, places[i], i, out);
    memcpy(message, b.message, sizeof b.message);
    scene_close(&b);
    return status;
}

/* ---- The relation ------------------------------------------------------------------------------------------------ */

static double shortest(const scene *s)
{
    double length = DBL_MAX;
    for (uint32_t k = 0; k < s->strings; ++k)
        for (uint32_t p = 0; p < s->string[k].pipes; ++p)
            length = fmin(length, s->string[k].pipe[p].length / s->string[k].pipe[p].elements);
    return length;
}

/* A load inside any element, all of them small; returns its place. Closer to a node than a quarter of the diameter a
 * load acts by the element's interpolation: it is drawn further away. */
static part_ref prepare(scene *s)
{
    stream n = stream_of(s->seed, s->number, TOPIC_NODED);
    for (uint32_t k = 0; k < s->strings; ++k)
        for (uint32_t p = 0; p < s->string[k].pipes; ++p) s->string[k].pipe[p].elements = 1U << draw_count(&n, 0, 2);
    for (int c = 0; c < 3; ++c) s->environment.gravity[c] *= NODED_LOADS;
    for (int c = 0; c < 3; ++c) s->load[0].def.force[c] *= NODED_LOADS;
    for (int c = 0; c < 3; ++c) s->load[0].def.moment[c] *= NODED_LOADS;
    part_ref at = {PART_STRING, draw_count(&n, 0, s->strings - 1), 0, draw_number(&n, 0.2, 0.8)};
    at.pipe = draw_count(&n, 0, s->string[at.index].pipes - 1);
    const dmb_pipe_def *const pipe = &s->string[at.index].pipe[at.pipe];
    at.fraction = (at.fraction + draw_count(&n, 0, pipe->elements - 1)) / pipe->elements;
    at.fraction *= 1.0 - pipe->joint_length / pipe->length;
    return s->load[0].place = at;
}

static void hold_alike(trial *t, uint32_t count, double motion)
{
    const double part = NODED_ROUNDING + NODED_SQUARE * motion;
    double floor[ANSWER_GROUPS];
    rounding_of(&t->s, t->s.span + 10.0, 1.0, floor);
    /* of what is looked for: 3 to 17 % of displacements, half of a force */
    t->telling = motion < 1e-3 && 1000.0 * floor[ANSWER_FORCE] < 0.05 * whole.size[1];
    for (uint32_t i = 0; i < count; ++i) {
        for (int c = 0; c < 3 && is_node(i); ++c)
            hold(t, "displacement", fabs(whole.displacement[i][c] - parts.displacement[i][c]),
                 part * whole.size[0] + 1000.0 * floor[ANSWER_POSITION]);
        for (int c = 0; c < 6 && !is_node(i); ++c)
            hold(t, c < 3 ? "section force" : "section moment", fabs(whole.force[i][c] - parts.force[i][c]),
                 part * whole.size[1 + c / 3] + 1000.0 * floor[c < 3 ? ANSWER_FORCE : ANSWER_MOMENT]);
    }
}

static void check_noded(trial *t)
{
    part_ref places[PLACES_MOST];
    char message[256];
    if (t->s.loads == 0) {
        left_out(t, "no load");
        return;
    }
    const part_ref at = prepare(&t->s);
    const uint32_t count = places_of(&t->s, &at, places);
    split_pipe(&t->s, &at, &split);
    int32_t status = at_rest(&t->s, places, count, &whole, message);
    for (uint32_t i = 0; i < count; ++i) move_place(&at, &places[i]);
    if (status >= 0) status = at_rest(&split, places, count, &parts, message);
    if (status < 0) {
        refused(t, status, message);
        return;
    }
    const double motion = whole.size[0] / shortest(&split);
    hold_alike(t, count, motion);
}

const relation relation_noded = {"noded",
                                 "statics with a load inside an element against those with a node there",
                                 {FAMILY_LINE, WISH_STILL | WISH_FLEXIBLE | WISH_ELASTIC | WISH_NO_CONTROL, 4},
                                 60,
                                 0.6,
                                 check_noded,
                                 0.5};
