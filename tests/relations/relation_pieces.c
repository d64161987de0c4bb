/* Newton's law of pieces of a string: between two sections of an element its weight and the loads inside are all that
 * acts, at rest and at rest with an assumed slip, whatever the number of elements. In motion the inertia of a short
 * piece about the border of two elements, by its acceleration, acts besides. */
#include "relations.h"

enum { TOPIC_PIECES = TOPIC_OF_RELATION + 70, TOPIC_BORDERS };

/* [-] Half of a piece about the border of two elements, of an element. */
#define BORDER 1e-8

static double norm(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* [N/m] */
static double weight_of(const dmb_pipe_def *pipe)
{
    const double D = pipe->outer_diameter, d = pipe->inner_diameter;
    return pipe->section_mass > 0.0 ? pipe->section_mass : 0.25 * PI * (D * D - d * d) * pipe->density;
}

/* World axes. */
static void section_force(const built *b, dmb_place place, double sign, double sum[3], double *size)
{
    dmb_section section = dmb_section_default();
    dmb_pose pose = dmb_pose_default();
    double force[3];
    (void)dmb_query_section(b->sim, place, &section);
    (void)dmb_query_pose(b->sim, place, &pose);
    matrix_apply(pose.rotation, section.force, force);
    for (int i = 0; i < 3; ++i) sum[i] += sign * force[i];
    *size += norm(force);
}

/* Of the loads between two fractions of a pipe; returns how many there are. */
static uint32_t loads_between(const scene *s, const built *b, const part_ref *from, double to, double sum[3],
                              double *size)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->loads; ++i) {
        const dmb_load_def *const l = &s->load[i].def;
        const part_ref *const at = &s->load[i].place;
        double force[3];
        dmb_pose pose = dmb_pose_default();
        const scene_view straight = view_identity();
        if (at->kind != PART_STRING || at->index != from->index || at->pipe != from->pipe) continue;
        if (!(at->fraction > from->fraction && at->fraction < to)) continue;
        (void)dmb_query_pose(b->sim, built_place(b, *at), &pose);
        matrix_apply(l->frame == DMB_FRAME_BODY ? pose.rotation : straight.matrix, l->force, force);
        for (int k = 0; k < 3; ++k) sum[k] += force[k];
        *size += norm(force);
        ++count;
    }
    return count;
}

/* Between two fractions of one element; in a hole the node of a load is another contact. */
static void check_piece(trial *t, const built *b, const part_ref *from, double to)
{
    const dmb_pipe_def *const pipe = &t->s.string[from->index].pipe[from->pipe];
    const double weight = weight_of(pipe) * pipe->length * (to - from->fraction);
    double sum[3], size = 0.0, floor[ANSWER_GROUPS];
    part_ref end = *from;
    end.fraction = to;
    for (int i = 0; i < 3; ++i) sum[i] = weight * t->s.environment.gravity[i];
    size += norm(sum);
    if (loads_between(&t->s, b, from, to, sum, &size) > 0 && t->s.has_wall) return;
    section_force(b, built_place(b, *from), -1.0, sum, &size);
    section_force(b, built_place(b, end), 1.0, sum, &size);
    rounding_of(&t->s, t->s.span + 10.0, 1.0, floor);
    hold(t, "forces on a piece", norm(sum), 1e-8 * size + 1000.0 * floor[ANSWER_FORCE]);
}

static void check_pieces_of(trial *t, const built *b)
{
    for (uint32_t s = 0; s < t->s.strings; ++s)
        for (uint32_t p = 0; p < t->s.string[s].pipes; ++p) {
            const dmb_pipe_def *const pipe = &t->s.string[s].pipe[p];
            const double body = 1.0 - pipe->joint_length / pipe->length;
            if (pipe->kind != DMB_PIPE_FLEXIBLE) continue;
            for (uint32_t e = 0; e < pipe->elements; ++e) {
                const part_ref from = {PART_STRING, s, p, body * (e + 0.07) / pipe->elements};
                check_piece(t, b, &from, body * (e + 0.93) / pipe->elements);
            }
        }
}

/* 1, 2 or 4 elements a pipe, loads anywhere on it. */
static void prepare(trial *t, stream *n)
{
    for (uint32_t s = 0; s < t->s.strings; ++s)
        for (uint32_t p = 0; p < t->s.string[s].pipes; ++p) {
            t->s.string[s].pipe[p].elements = 1U << draw_count(n, 0, 2);
            t->s.string[s].pipe[p].contact_points = 0;
        }
    for (uint32_t i = 0; i < t->s.loads; ++i)
        if (t->s.load[i].place.kind == PART_STRING) t->s.load[i].place.fraction = draw_number(n, 0.0, 1.0);
    t->s.environment.fluid_density = 0.0;
}

static void check_pieces(trial *t)
{
    built b;
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_PIECES);
    dmb_static_options options = dmb_static_options_default();
    prepare(t, &n);
    if (t->s.family != FAMILY_LINE && draw_chance(&n, 0.5)) {
        options.slip_axial = draw_number(&n, -0.1, 0.1);
        options.slip_rotation = draw_number(&n, -10.0, 10.0);
    }
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, &options, NULL);
    if (status < 0)
        refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
    else
        check_pieces_of(t, &b);
    scene_close(&b);
}

const relation relation_pieces = {
    "pieces",
    "section forces of pieces at rest and with an assumed slip against weight and loads",
    {FAMILY_LINE | FAMILY_HOLE | FAMILY_BENT, WISH_STILL | WISH_FLEXIBLE | WISH_ELASTIC | WISH_NO_CONTROL, 4},
    60,
    0.4,
    check_pieces,
    0.0};

/* [N] Weight and inertia of a piece about its middle. */
static void body_force(const scene *s, const built *b, dmb_place middle, double mass, double sum[3], double *size)
{
    dmb_motion motion = dmb_motion_default();
    (void)dmb_query_motion(b->sim, middle, &motion);
    for (int i = 0; i < 3; ++i) sum[i] = mass * (s->environment.gravity[i] - motion.acceleration[i]);
    *size += norm(sum);
}

static void check_border(trial *t, const built *b, const part_ref *at, uint32_t elements)
{
    const dmb_pipe_def *const pipe = &t->s.string[at->index].pipe[at->pipe];
    const double part = BORDER / elements;
    double sum[3], size = 0.0, floor[ANSWER_GROUPS];
    part_ref from = *at, to = *at;
    from.fraction -= part, to.fraction += part;
    body_force(&t->s, b, built_place(b, *at), 2.0 * part * pipe->length * weight_of(pipe), sum, &size);
    if (loads_between(&t->s, b, &from, to.fraction, sum, &size) > 0) return;
    section_force(b, built_place(b, from), -1.0, sum, &size);
    section_force(b, built_place(b, to), 1.0, sum, &size);
    rounding_of(&t->s, t->s.span + 10.0, 1.0, floor);
    hold(t, "forces on a piece about the border of two elements", norm(sum),
         1e-6 * size + 1000.0 * floor[ANSWER_FORCE]);
}

static void check_borders_of(trial *t, const built *b)
{
    for (uint32_t s = 0; s < t->s.strings; ++s)
        for (uint32_t p = 0; p < t->s.string[s].pipes; ++p) {
            const dmb_pipe_def *const pipe = &t->s.string[s].pipe[p];
            const double body = 1.0 - pipe->joint_length / pipe->length;
            if (pipe->kind != DMB_PIPE_FLEXIBLE) continue;
            for (uint32_t e = 1; e < pipe->elements; ++e) {
                const part_ref at = {PART_STRING, s, p, body * e / pipe->elements};
                check_border(t, b, &at, pipe->elements);
            }
        }
}

static void check_borders(trial *t)
{
    built b;
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_BORDERS);
    const uint32_t steps = draw_count(&n, 1, 20);
    prepare(t, &n);
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    for (uint32_t i = 0; i < steps && status >= 0; ++i) status = dmb_sim_step(b.sim, t->s.step, NULL);
    if (status < 0)
        refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
    else
        check_borders_of(t, &b);
    scene_close(&b);
}

const relation relation_borders = {"borders",
                                   "section forces beside the borders of elements in motion",
                                   {FAMILY_LINE | FAMILY_FREE, WISH_FLEXIBLE, 4},
                                   60,
                                   0.4,
                                   check_borders,
                                   0.0};
