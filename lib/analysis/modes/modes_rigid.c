/* Rigid-body motions: the null space of K among motions that move every part as a rigid body.
 *
 * Parts are runs of nodes connected by elements. A part of six-DOF nodes has six candidates, translations along the
 * world axes and rotations about them through its centre, d = Ad(H^-1) xi at each node; a part of axial-torsional nodes
 * has two. A bent string may rotate about its own axis, section by section: an axisymmetric string with straight rest
 * shape has no stiffness against this rotation, which is therefore one more candidate. With B the candidates of all
 * parts, the motions are B q with
 *
 *     (1 - R E) B q = 0     joints and supports permit the motion (E selects the coordinates of d),
 *     R^T K B q = 0         no force of the state resists it.
 *
 * An element's strain is 0 in a candidate, so that its part of K B is rounding however long, bent or soft the string
 * is: a row is 0 if it is below a fraction of its terms, sum |K_ij| |B_jk|, and the rank is that of few and well-scaled
 * numbers, by Givens rotations of its rows and Householder's QR with column pivoting (Golub, Van Loan 2013, 5.2 and
 * 5.4).
 *
 * Candidates that nearly cancel are checked once more, by the remaining motion (modes_rigid_check). */
#include <float.h>
#include <math.h>
#include <string.h>

#include "analysis/modes/modes.h"
#include "base/memory.h"
#include "math/dense.h"
#include "math/null_space.h"
#include "math/so3.h"
#include "sim/node.h"

/* [-] A row of the conditions below this fraction of its terms is rounding. */
#define DMB_RIGID_ROUNDING 1e-12
/* [rad] Bend of a string above which rotation about its own axis differs from a rigid-body motion. */
#define DMB_RIGID_BENT 1e-6
/* Limit, because the conditions are dense in the candidates: 200 parts. */
enum { DMB_CANDIDATES_MAX = 1200 };

typedef struct entry {
    uint32_t condition, candidate;
    double value;
} entry;

typedef struct rigid_part {
    uint32_t first, count; /* nodes */
    uint32_t candidate;    /* index of its first candidate */
    uint32_t candidates;
    int32_t full;           /* 1: six-DOF nodes */
    double bend;            /* [rad] largest angle between the axes of its nodes and that of the first */
    double middle[3], size; /* [m] */
} rigid_part;

typedef struct conditions {
    dmb_mode_search *search;
    dmb_linear *linear;
    const dmb_allocator *allocator;
    rigid_part *parts; /* shape (nodes) */
    uint32_t part_count, candidates;
    uint32_t count; /* number of conditions: rows, then coordinates */
    entry *entries; /* by candidate */
    size_t entry_count, entry_room;
    double *terms;            /* of each condition, shape (count) */
    double *d, *Kd, *terms_d; /* shape (rows) */
    double *g, *terms_g;      /* shape (coordinates) */
    double tolerance;
    void *block;
    size_t bytes;
} conditions;

/* ---- Parts and candidates ---------------------------------------------------------------------------------------- */

static void node_place(const dmb_linear *linear, uint32_t node, double rotation[9], double place[3])
{
    dmb_node_pose(&linear->scene, &linear->work->now, node, rotation, place);
    dmb_vec3_add(place, linear->scene.reference_position + 3 * (size_t)node, place);
}

static void measure_part(conditions *c, rigid_part *p)
{
    double rotation[9], place[3], axis[3], first[3] = {0.0, 0.0, 0.0}, away = 0.0;
    for (uint32_t i = p->first; i < p->first + p->count; i++) {
        node_place(c->linear, i, rotation, place);
        for (int k = 0; k < 3; k++) p->middle[k] += place[k] / p->count;
        away = fmax(away, dmb_vec3_norm(place));
        for (int k = 0; k < 3; k++) axis[k] = rotation[3 * k];
        if (i == p->first) dmb_vec3_copy(axis, first);
        dmb_vec3_sub(axis, first, axis);
        p->bend = fmax(p->bend, dmb_vec3_norm(axis));
    }
    p->size = p->count > 1 ? 0.0 : c->linear->scene.chains[c->linear->scene.node_chain[p->first]].length;
    for (uint32_t i = p->first; i < p->first + p->count; i++) {
        node_place(c->linear, i, rotation, place);
        dmb_vec3_sub(place, p->middle, place);
        p->size = fmax(p->size, dmb_vec3_norm(place));
    }
    c->tolerance = fmax(c->tolerance, DMB_RIGID_ROUNDING + DMB_RIGID_AWAY * away / p->size);
}

static int begins_part(const dmb_scene *scene, uint32_t node)
{
    if (node == 0 || scene->node_chain[node] != scene->node_chain[node - 1]) return 1;
    return scene->layout.size[node] != scene->layout.size[node - 1] ||
           dmb_element_between(scene, node - 1, 1) == DMB_NONE;
}

static void find_parts(conditions *c)
{
    const dmb_scene *scene = &c->linear->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        if (begins_part(scene, i)) c->parts[c->part_count++].first = i;
        c->parts[c->part_count - 1].count++;
    }
    for (uint32_t k = 0; k < c->part_count; k++) {
        rigid_part *p = c->parts + k;
        p->candidate = c->candidates;
        p->full = scene->layout.size[p->first] == DMB_NODE_SIX_DOF;
        measure_part(c, p);
        p->candidates = scene->layout.size[p->first] + (p->full && p->bend > DMB_RIGID_BENT ? 1U : 0U);
        c->candidates += p->candidates;
    }
}

/* d += factor times the motion of a part, by its candidate. */
static void add_candidate(const conditions *c, const rigid_part *p, uint32_t candidate, double factor, double *d)
{
    const dmb_block_layout *layout = &c->linear->scene.layout;
    double turn[3] = {0.0, 0.0, 0.0};
    if (p->full && candidate >= 3 && candidate < DMB_NODE_SIX_DOF) turn[candidate - 3] = factor / p->size;
    for (uint32_t i = p->first; i < p->first + p->count; i++) {
        double rotation[9], arm[3], shift[3], local[3], *to = d + layout->row[i];
        if (!p->full || candidate == DMB_NODE_SIX_DOF) {
            to[p->full ? 3 : candidate] += p->full ? factor / p->size : factor;
            continue;
        }
        node_place(c->linear, i, rotation, arm);
        dmb_vec3_sub(arm, p->middle, arm);
        dmb_vec3_cross(turn, arm, shift);
        if (candidate < 3) shift[candidate] += factor;
        dmb_mat3_tvec(rotation, shift, local);
        dmb_vec3_add(to, local, to);
        dmb_mat3_tvec(rotation, turn, local);
        dmb_vec3_add(to + 3, local, to + 3);
    }
}

/* ---- Conditions -------------------------------------------------------------------------------------------------- */

static int32_t put(conditions *c, uint32_t condition, uint32_t candidate, double value)
{
    if (c->entry_count == c->entry_room) {
        const size_t room = 2 * c->entry_room + 1024;
        entry *more = dmb_allocate_array(c->allocator, room, sizeof *more);
        if (more == NULL) return DMB_ERR_NO_MEMORY;
        if (c->entry_count > 0) memcpy(more, c->entries, c->entry_count * sizeof *more);
        if (c->entries != NULL) dmb_release(c->allocator, c->entries, c->entry_room * sizeof *more);
        c->entries = more;
        c->entry_room = room;
    }
    const entry made = {condition, candidate, value};
    c->entries[c->entry_count++] = made;
    return DMB_OK;
}

/* Stores a value above the rounding of its terms, and adds the terms. */
static int32_t put_row(conditions *c, uint32_t condition, uint32_t candidate, double value, double terms)
{
    c->terms[condition] += terms;
    return fabs(value) > c->tolerance * terms ? put(c, condition, candidate, value) : DMB_OK;
}

/* (1 - R E) d */
static int32_t put_constrained_rows(conditions *c, uint32_t candidate)
{
    const dmb_linear *linear = c->linear;
    int32_t status = DMB_OK;
    for (uint32_t r = 0; r < linear->rows && status >= 0; r++) {
        double value = c->d[r], terms = fabs(value);
        for (uint32_t i = linear->start[r]; i < linear->start[r + 1]; i++) {
            const double part = linear->value[i] * c->d[linear->row_of[linear->column[i]]];
            value -= part;
            terms += fabs(part);
        }
        if (terms > 0.0) status = put_row(c, r, candidate, value, terms);
    }
    return status;
}

/* R^T K d */
static int32_t put_forces(conditions *c, uint32_t candidate)
{
    dmb_linear *linear = c->linear;
    int32_t status = DMB_OK;
    dmb_linear_multiply(linear, &linear->stiffness, c->d, c->Kd);
    dmb_modes_rigid_terms(linear, c->tolerance, c->d, c->terms_d);
    dmb_linear_restrict(linear, c->Kd, c->g);
    dmb_linear_restrict_terms(linear, c->terms_d, c->terms_g);
    for (uint32_t i = 0; i < linear->coordinates && status >= 0; i++)
        if (c->terms_g[i] > 0.0) status = put_row(c, linear->rows + i, candidate, c->g[i], c->terms_g[i]);
    return status;
}

static int32_t make_conditions(conditions *c)
{
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < c->part_count; k++)
        for (uint32_t i = 0; i < c->parts[k].candidates && status >= 0; i++) {
            memset(c->d, 0, c->linear->rows * sizeof(double));
            add_candidate(c, c->parts + k, i, 1.0, c->d);
            status = put_constrained_rows(c, c->parts[k].candidate + i);
            if (status >= 0) status = put_forces(c, c->parts[k].candidate + i);
        }
    return status;
}

/* ---- Motions ----------------------------------------------------------------------------------------------------- */

/* Offsets of the entries of each condition, and the entries sorted by condition. */
static void sort_entries(const conditions *c, size_t *start, entry *sorted)
{
    for (size_t i = 0; i < c->entry_count; i++) start[c->entries[i].condition + 1]++;
    for (uint32_t r = 0; r < c->count; r++) start[r + 1] += start[r];
    for (size_t i = 0; i < c->entry_count; i++) sorted[start[c->entries[i].condition]++] = c->entries[i];
    for (uint32_t r = c->count; r > 0; r--) start[r] = start[r - 1];
    start[0] = 0;
}

static void gather(const conditions *c, const size_t *start, const entry *sorted, double *R, double *row)
{
    const size_t n = c->candidates;
    for (uint32_t r = 0; r < c->count; r++) {
        if (start[r] == start[r + 1]) continue;
        memset(row, 0, n * sizeof(double));
        for (size_t i = start[r]; i < start[r + 1]; i++) {
            const double value = sorted[i].value / c->terms[r];
            row[sorted[i].candidate] = fabs(value) > c->tolerance ? value : 0.0;
        }
        dmb_rotate_in(n, sorted[start[r]].candidate, R, row);
    }
}

/* r = R E B q, which joints permit exactly. */
static void motion_of(const conditions *c, const double *q, double *r)
{
    const dmb_linear *linear = c->linear;
    memset(c->d, 0, linear->rows * sizeof(double));
    for (uint32_t k = 0; k < c->part_count; k++)
        for (uint32_t i = 0; i < c->parts[k].candidates; i++)
            if (q[c->parts[k].candidate + i] != 0.0)
                add_candidate(c, c->parts + k, i, q[c->parts[k].candidate + i], c->d);
    for (uint32_t i = 0; i < linear->coordinates; i++) c->g[i] = c->d[linear->row_of[i]];
    dmb_linear_expand(linear, c->g, r);
}

/* Norm of a motion's component orthogonal to the previous motions below which it is one of them. */
#define DMB_RIGID_AGAIN 1e-6

/* Adds the motion, orthonormalised in M. */
static void add_motion(const conditions *c, const double *q)
{
    dmb_mode_search *search = c->search;
    const size_t rows = c->linear->rows;
    double *r = search->rigid + rows * search->rigid_count, *Mr = search->rigid_momentum + rows * search->rigid_count;
    motion_of(c, q, r);
    for (int pass = 0; pass < 3; pass++) {
        if (pass > 0) dmb_modes_add_rigid(search, search->rigid_momentum, search->rigid, r);
        dmb_linear_multiply(c->linear, &c->linear->mass, r, Mr);
        const double size = sqrt(dmb_dot(rows, r, Mr));
        if (!(size > (pass > 0 ? DMB_RIGID_AGAIN : 0.0)) || !isfinite(size)) return;
        for (size_t i = 0; i < rows; i++) r[i] /= size;
    }
    dmb_linear_multiply(c->linear, &c->linear->mass, r, Mr);
    search->rigid_count++;
}

static int32_t reserve(dmb_mode_search *search, size_t count)
{
    const size_t rows = search->linear->rows;
    search->rigid_bytes = 2 * rows * count * sizeof(double);
    search->rigid = dmb_allocate(&search->linear->allocator, search->rigid_bytes);
    if (search->rigid == NULL) return DMB_ERR_NO_MEMORY;
    search->rigid_momentum = search->rigid + rows * count;
    return DMB_OK;
}

static int32_t read_null_space(conditions *c)
{
    const size_t n = c->candidates, starts = ((size_t)c->count + 2) * sizeof(size_t);
    const size_t bytes =
        (n * n + 4 * n) * sizeof(double) + c->entry_count * sizeof(entry) + starts + n * sizeof(uint32_t);
    double *R = dmb_allocate(c->allocator, bytes);
    if (R == NULL) return DMB_ERR_NO_MEMORY;
    double *v = R + n * n, *q = v + 2 * n, *work = q + n;
    entry *sorted = (entry *)(void *)(work + n);
    size_t *start = (size_t *)(void *)(sorted + c->entry_count);
    uint32_t *order = (uint32_t *)(void *)(start + c->count + 2);
    sort_entries(c, start, sorted);
    gather(c, start, sorted, R, q);
    const size_t rank = dmb_triangulate(n, c->tolerance, R, order, v);
    const int32_t status = rank < n ? reserve(c->search, n - rank) : DMB_OK;
    for (size_t i = 0; i < n - rank && status >= 0; i++) {
        const dmb_triangle triangle = {n, rank, R, order};
        dmb_null_vector(&triangle, i, work, q);
        add_motion(c, q);
    }
    dmb_release(c->allocator, R, bytes);
    return status < 0 ? status : dmb_modes_check_rigid(c->search, c->tolerance - DMB_RIGID_ROUNDING);
}

static int32_t open_conditions(conditions *c)
{
    const dmb_linear *linear = c->linear;
    const size_t rows = linear->rows, n = linear->coordinates, nodes = linear->scene.node_count;
    c->count = linear->rows + linear->coordinates;
    c->bytes = (rows + n + 3 * rows + 2 * n) * sizeof(double) + nodes * sizeof(rigid_part);
    c->block = dmb_allocate(c->allocator, c->bytes);
    if (c->block == NULL) return DMB_ERR_NO_MEMORY;
    c->terms = c->block;
    c->d = c->terms + rows + n;
    c->Kd = c->d + rows;
    c->terms_d = c->Kd + rows;
    c->g = c->terms_d + rows;
    c->terms_g = c->g + n;
    c->parts = (rigid_part *)(void *)(c->terms_g + n);
    return DMB_OK;
}

int32_t dmb_modes_find_rigid(dmb_mode_search *search)
{
    conditions c = {.search = search, .linear = search->linear, .allocator = &search->linear->allocator};
    int32_t status = open_conditions(&c);
    if (status < 0) return status;
    find_parts(&c);
    if (c.candidates <= DMB_CANDIDATES_MAX) {
        search->apart = 1; /* during orthogonalisation */
        status = make_conditions(&c);
        if (status >= 0) status = read_null_space(&c);
        search->apart = 0;
    }
    if (c.entries != NULL) dmb_release(c.allocator, c.entries, c.entry_room * sizeof(entry));
    dmb_release(c.allocator, c.block, c.bytes);
    return status;
}
