/* Dynamic stiffness of chains that joints connect: R^T M R, R^T C R and R^T K R are formed once in the blocks of the
 * scene's pattern, and combined in complex numbers for each frequency. A block holds the independent coordinates of one
 * cluster, or those of a node between clusters; sizes follow from the partition, so that offsets are those of the
 * present sizes. */
#include "analysis/linear/linear.h"

#include <math.h>
#include <string.h>

#include "sim/node.h"

static int is_reduced(const dmb_scene *scene, uint32_t node)
{
    return scene->cluster_count > 0 && scene->node_block[node] != DMB_NONE;
}

/* ---- Coordinates ------------------------------------------------------------------------------------------------- */

/* Every block holds at most the coordinates of its capacity. */
dmb_jointed_chains_size dmb_jointed_chains_sizes(const dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    dmb_jointed_chains_size size = {0, DMB_NODE_SIX_DOF, 0};
    for (uint32_t i = 0; i < linear->coordinates; i++)
        size.count += (uint32_t)is_reduced(scene, dmb_node_of_row(scene, linear->row_of[i]));
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        if (scene->clusters[k].columns > size.widest) size.widest = scene->clusters[k].columns;
        if (scene->clusters[k].rows > size.rows) size.rows = scene->clusters[k].rows;
    }
    return size;
}

void dmb_jointed_chains_lay_out(dmb_arena *arena, const dmb_linear *linear, dmb_jointed_chains_size size,
                                dmb_jointed_chains *out)
{
    const dmb_scene *scene = &linear->scene;
    out->multiplier = dmb_complex_lay_out(arena, size.rows);
    out->rest = DMB_ARENA_DOUBLES(arena, 2 * (size_t)size.rows);
    if (scene->cluster_count == 0) return;
    out->size = DMB_ARENA_ARRAY(arena, uint32_t, scene->block_count);
    out->row = DMB_ARENA_ARRAY(arena, uint32_t, scene->block_count);
    out->place = DMB_ARENA_ARRAY(arena, uint32_t, linear->coordinates);
    out->pattern.diagonal = DMB_ARENA_ARRAY(arena, size_t, scene->block_count);
    out->pattern.upper = DMB_ARENA_ARRAY(arena, size_t, scene->pattern.entries);
    out->pattern.lower = DMB_ARENA_ARRAY(arena, size_t, scene->pattern.entries);
    for (int m = 0; m < 3; m++) out->blocks[m] = DMB_ARENA_DOUBLES(arena, scene->pattern.values);
    out->matrix.values = dmb_complex_lay_out(arena, scene->pattern.values);
    out->matrix.pivot = DMB_ARENA_ARRAY(arena, uint32_t, scene->pattern.rows);
    out->solution = dmb_complex_lay_out(arena, size.count);
    out->half = DMB_ARENA_DOUBLES(arena, (size_t)DMB_NODE_SIX_DOF * size.widest);
    out->stiffness = DMB_ARENA_DOUBLES(arena, size.count);
    out->mass = DMB_ARENA_DOUBLES(arena, size.count);
}

/* Numbers coordinates in the order of their rows inside each block. First counted block by block, then moved behind the
 * blocks before: the coordinates of a block follow each other from links->row on. */
static void number(const dmb_linear *linear, dmb_jointed_chains *links)
{
    const dmb_scene *scene = &linear->scene;
    uint32_t row = 0;
    for (uint32_t i = 0; i < linear->coordinates; i++) {
        const uint32_t node = dmb_node_of_row(scene, linear->row_of[i]);
        links->place[i] = is_reduced(scene, node) ? links->size[scene->node_block[node]]++ : DMB_NONE;
    }
    for (uint32_t b = 0; b < scene->block_count; b++) {
        links->row[b] = row;
        row += links->size[b];
    }
    for (uint32_t i = 0; i < linear->coordinates; i++)
        if (links->place[i] != DMB_NONE)
            links->place[i] += links->row[scene->node_block[dmb_node_of_row(scene, linear->row_of[i])]];
}

/* Contribution of a row to the scales of the pivots: R^T diag(|K|) R and R^T diag(|M|) R on the diagonal. A pivot is
 * the difference of such terms; what is left of it is rounding if it is far below them
 * (dmb_dynamic_is_unconstrained). */
static void add_scale(const dmb_linear *linear, const dmb_jointed_chains *links, uint32_t row, double stiffness,
                      double mass)
{
    for (uint32_t e = linear->start[row]; e < linear->start[row + 1]; e++) {
        const uint32_t place = links->place[linear->column[e]];
        links->stiffness[place] += linear->value[e] * linear->value[e] * fabs(stiffness);
        links->mass[place] += linear->value[e] * linear->value[e] * fabs(mass);
    }
}

static void add_scales(const dmb_linear *linear, const dmb_jointed_chains *links)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; is_reduced(&linear->scene, i) && c < layout->size[i]; c++) {
            const uint32_t at = layout->diag[i] + (layout->size[i] + 1u) * c;
            add_scale(linear, links, layout->row[i] + c, linear->stiffness.diagonal[at], linear->mass.diagonal[at]);
        }
    for (uint32_t i = 0; i < linear->scene.constraint_count; i++) {
        const dmb_constraint *c = linear->scene.constraints + i;
        for (uint32_t a = 0; a < c->node_count; a++)
            for (uint32_t r = 0; r < layout->size[c->node[a]]; r++)
                add_scale(linear, links, layout->row[c->node[a]] + r,
                          linear->stiffness.joints[c->tangent + (size_t)(c->columns + 1) * (c->column[a] + r)], 0.0);
    }
}

/* ---- Blocks ------------------------------------------------------------------------------------------------------ */

/* Offsets of blocks of the present sizes, without gaps. In the order of elimination: the diagonal block, then for each
 * later block that it is connected with, or that elimination connects it with, the upper and the lower one. */
static void place_blocks(const dmb_block_pattern *scene, dmb_jointed_chains *links)
{
    dmb_block_pattern *pattern = &links->pattern;
    size_t *const diagonal = pattern->diagonal, *const upper = pattern->upper, *const lower = pattern->lower, at = 0;
    *pattern = *scene;
    pattern->diagonal = diagonal;
    pattern->upper = upper;
    pattern->lower = lower;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const size_t n = links->size[pattern->order[k]];
        if (n > links->widest) links->widest = (uint32_t)n;
        diagonal[k] = at;
        at += n * n;
        for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++) {
            const size_t count = n * links->size[pattern->order[pattern->later[e]]];
            upper[e] = at;
            lower[e] = at + count;
            at += 2 * count;
        }
    }
    pattern->values = at;
}

/* A part of a matrix by rows of node i and columns of node j. */
typedef struct part_of_nodes {
    const double *values;
    size_t stride; /* from one row to the next */
    uint32_t i, j;
} part_of_nodes;

/* half = X R_j. The rows of a node depend on the coordinates of its own block only: R_j has no other columns. */
static void times_null_space(const dmb_linear *linear, const dmb_jointed_chains *links, const part_of_nodes *X)
{
    const dmb_scene *scene = &linear->scene;
    const uint32_t rows = scene->layout.size[X->i], block = scene->node_block[X->j], width = links->size[block];
    memset(links->half, 0, (size_t)rows * width * sizeof(double));
    for (uint32_t c = 0; c < scene->layout.size[X->j]; c++) {
        const uint32_t row = scene->layout.row[X->j] + c;
        for (uint32_t e = linear->start[row]; e < linear->start[row + 1]; e++) {
            const uint32_t m = links->place[linear->column[e]] - links->row[block];
            for (uint32_t r = 0; r < rows; r++)
                links->half[(size_t)width * r + m] += X->values[X->stride * r + c] * linear->value[e];
        }
    }
}

static int is_zero(const dmb_block_layout *layout, const part_of_nodes *X)
{
    for (uint32_t r = 0; r < layout->size[X->i]; r++)
        for (uint32_t c = 0; c < layout->size[X->j]; c++)
            if (X->values[X->stride * r + c] != 0.0) return 0;
    return 1;
}

/* A_ij += R_i^T X R_j in the block of the two nodes. Most joints have no laws and loads, and most parts no damping. */
static void add_block(const dmb_linear *linear, const dmb_jointed_chains *links, const part_of_nodes *X, double *A)
{
    const dmb_scene *scene = &linear->scene;
    const uint32_t block = scene->node_block[X->i], width = links->size[scene->node_block[X->j]];
    if (is_zero(&scene->layout, X)) return;
    double *to = A + dmb_block_pattern_offset(&links->pattern, block, scene->node_block[X->j]);
    times_null_space(linear, links, X);
    for (uint32_t c = 0; c < scene->layout.size[X->i]; c++) {
        const double *half = links->half + (size_t)width * c;
        const uint32_t row = scene->layout.row[X->i] + c;
        for (uint32_t e = linear->start[row]; e < linear->start[row + 1]; e++) {
            const size_t m = links->place[linear->column[e]] - links->row[block];
            for (uint32_t q = 0; q < width; q++) to[width * m + q] += linear->value[e] * half[q];
        }
    }
}

/* Nodes, and the elements between them. */
static void add_nodes(const dmb_linear *linear, const dmb_jointed_chains *links, const dmb_linear_matrix *from,
                      double *A)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    for (uint32_t i = 0; i < layout->n; i++) {
        if (!is_reduced(scene, i)) continue;
        const part_of_nodes diagonal = {from->diagonal + layout->diag[i], layout->size[i], i, i};
        add_block(linear, links, &diagonal, A);
        if (scene->node_element[i] == DMB_NONE) continue;
        const part_of_nodes upper = {from->upper + layout->link[i], layout->size[i + 1], i, i + 1};
        const part_of_nodes lower = {from->lower + layout->link[i], layout->size[i], i + 1, i};
        add_block(linear, links, &upper, A);
        add_block(linear, links, &lower, A);
    }
}

static void add_joints(const dmb_linear *linear, const dmb_jointed_chains *links, const double *joints, double *A)
{
    for (uint32_t i = 0; i < linear->scene.constraint_count; i++) {
        const dmb_constraint *c = linear->scene.constraints + i;
        for (uint32_t a = 0; a < c->node_count; a++)
            for (uint32_t b = 0; b < c->node_count; b++) {
                const size_t at = c->tangent + (size_t)c->column[a] * c->columns + c->column[b];
                const part_of_nodes X = {joints + at, c->columns, c->node[a], c->node[b]};
                add_block(linear, links, &X, A);
            }
    }
}

void dmb_jointed_chains_number(const dmb_linear *linear, dmb_jointed_chains_size size, dmb_jointed_chains *out)
{
    const dmb_linear_matrix *const all[3] = {&linear->mass, &linear->damping, &linear->stiffness};
    out->count = size.count;
    if (linear->scene.cluster_count == 0) return;
    out->matrix.size = out->size;
    number(linear, out);
    add_scales(linear, out);
    place_blocks(&linear->scene.pattern, out);
    for (int m = 0; m < 3; m++) {
        add_nodes(linear, out, all[m], out->blocks[m]);
        add_joints(linear, out, all[m]->joints, out->blocks[m]);
    }
}

/* ---- Factors and solution ---------------------------------------------------------------------------------------- */

static uint32_t node_of_place(const dmb_dynamic_stiffness *s, uint32_t place)
{
    for (uint32_t i = 0; i < s->linear->coordinates; i++)
        if (s->links.place[i] == place) return dmb_node_of_row(&s->linear->scene, s->linear->row_of[i]);
    return 0;
}

/* First coordinate whose pivot is of rounding size, or -1. */
static int64_t unconstrained_place(const dmb_dynamic_stiffness *s)
{
    const dmb_jointed_chains *links = &s->links;
    const dmb_block_pattern *pattern = &links->pattern;
    for (uint32_t b = 0; b < pattern->n; b++)
        for (uint32_t i = 0; i < links->size[b]; i++) {
            const size_t at = pattern->diagonal[pattern->position[b]] + (links->size[b] + (size_t)1) * i;
            const uint32_t place = links->row[b] + i;
            if (dmb_dynamic_is_unconstrained(s, links->matrix.values.re[at], links->matrix.values.im[at],
                                             links->stiffness[place], links->mass[place]))
                return (int64_t)place;
        }
    return -1;
}

/* M, C and K of all blocks are combined for the frequency, then factored. A block without a pivot and a pivot of
 * rounding size are both reported by the node. */
int64_t dmb_jointed_chains_factor(dmb_dynamic_stiffness *s)
{
    const dmb_block_pattern *pattern = &s->links.pattern;
    double *const *blocks = s->links.blocks;
    dmb_dynamic_assemble(s, pattern->values, blocks[0], blocks[1], blocks[2], s->links.matrix.values);
    const int64_t bad = dmb_complex_sparse_factor(pattern, &s->links.matrix);
    if (bad >= 0) return node_of_place(s, s->links.row[bad]);
    const int64_t loose = unconstrained_place(s);
    return loose >= 0 ? (int64_t)node_of_place(s, (uint32_t)loose) : -1;
}

/* g = R^T f of the rows begin .. end: dependent rows add to the coordinates that move them. */
static void restrict_rows(const dmb_dynamic_stiffness *s, uint32_t begin, uint32_t end, dmb_complex_array x)
{
    const dmb_linear *linear = s->linear;
    for (uint32_t r = begin; r < end; r++)
        for (uint32_t e = linear->start[r]; e < linear->start[r + 1]; e++) {
            const uint32_t place = s->links.place[linear->column[e]];
            s->links.solution.re[place] += linear->value[e] * x.re[r];
            s->links.solution.im[place] += linear->value[e] * x.im[r];
        }
}

/* d = R z of the rows begin .. end, with dependent rows by their coordinates, constrained ones 0. */
static void expand_rows(const dmb_dynamic_stiffness *s, uint32_t begin, uint32_t end, dmb_complex_array x)
{
    const dmb_linear *linear = s->linear;
    for (uint32_t r = begin; r < end; r++) {
        x.re[r] = x.im[r] = 0.0;
        for (uint32_t e = linear->start[r]; e < linear->start[r + 1]; e++) {
            const uint32_t place = s->links.place[linear->column[e]];
            x.re[r] += linear->value[e] * s->links.solution.re[place];
            x.im[r] += linear->value[e] * s->links.solution.im[place];
        }
    }
}

void dmb_jointed_chains_restrict(const dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    const dmb_scene *scene = &s->linear->scene;
    memset(s->links.solution.re, 0, s->links.count * sizeof(double));
    memset(s->links.solution.im, 0, s->links.count * sizeof(double));
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (is_reduced(scene, i)) restrict_rows(s, scene->layout.row[i], scene->layout.row[i + 1], x);
}

void dmb_jointed_chains_expand(const dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    const dmb_scene *scene = &s->linear->scene;
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (is_reduced(scene, i)) expand_rows(s, scene->layout.row[i], scene->layout.row[i + 1], x);
}

void dmb_jointed_chains_solve(dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    dmb_jointed_chains_restrict(s, x);
    dmb_complex_sparse_solve(&s->links.pattern, &s->links.matrix, s->links.row, s->links.solution);
    dmb_jointed_chains_expand(s, x);
}
