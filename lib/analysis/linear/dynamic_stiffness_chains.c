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

static dmb_complex_array take(dmb_arena *arena, size_t count)
{
    dmb_complex_array array;
    array.re = DMB_ARENA_DOUBLES(arena, count);
    array.im = DMB_ARENA_DOUBLES(arena, count);
    return array;
}

void dmb_jointed_chains_lay_out(dmb_arena *arena, const dmb_linear *linear, dmb_jointed_chains_size size,
                                dmb_jointed_chains *out)
{
    const dmb_scene *scene = &linear->scene;
    out->multiplier = take(arena, size.rows);
    out->rest = DMB_ARENA_DOUBLES(arena, 2 * (size_t)size.rows);
    if (scene->cluster_count == 0) return;
    out->size = DMB_ARENA_ARRAY(arena, uint32_t, scene->block_count);
    out->row = DMB_ARENA_ARRAY(arena, uint32_t, scene->block_count);
    out->place = DMB_ARENA_ARRAY(arena, uint32_t, linear->coordinates);
    out->matrix.values = take(arena, scene->pattern.values);
    out->matrix.pivot = DMB_ARENA_ARRAY(arena, uint32_t, scene->pattern.rows);
    out->solution = take(arena, size.count);
    out->half = take(arena, (size_t)DMB_NODE_SIX_DOF * size.widest);
    out->stiffness = DMB_ARENA_DOUBLES(arena, size.count);
    out->mass = DMB_ARENA_DOUBLES(arena, size.count);
}

/* Numbers coordinates in the order of their rows inside each block. */
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

/* Contribution of a row to the diagonals that scale the pivots. */
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

void dmb_jointed_chains_number(const dmb_linear *linear, dmb_jointed_chains_size size, dmb_jointed_chains *out)
{
    out->count = size.count;
    if (linear->scene.cluster_count == 0) return;
    out->matrix.size = out->size;
    number(linear, out);
    add_scales(linear, out);
}

/* ---- Assembly ---------------------------------------------------------------------------------------------------- */

/* half = X R_j, X: size of i x size of j, its rows `stride` apart */
static void times_null_space(const dmb_dynamic_stiffness *s, uint32_t i, uint32_t j, dmb_complex_array X, size_t stride)
{
    const dmb_linear *linear = s->linear;
    const dmb_scene *scene = &linear->scene;
    const dmb_jointed_chains *links = &s->links;
    const uint32_t rows = scene->layout.size[i], block = scene->node_block[j], width = links->size[block];
    memset(links->half.re, 0, (size_t)rows * width * sizeof(double));
    memset(links->half.im, 0, (size_t)rows * width * sizeof(double));
    for (uint32_t c = 0; c < scene->layout.size[j]; c++) {
        const uint32_t row = scene->layout.row[j] + c;
        for (uint32_t e = linear->start[row]; e < linear->start[row + 1]; e++) {
            const uint32_t m = links->place[linear->column[e]] - links->row[block];
            for (uint32_t r = 0; r < rows; r++) {
                links->half.re[(size_t)width * r + m] += X.re[stride * r + c] * linear->value[e];
                links->half.im[(size_t)width * r + m] += X.im[stride * r + c] * linear->value[e];
            }
        }
    }
}

/* A_ij += R_i^T X R_j, into the block of the two nodes at `offset`. */
static void add_block(const dmb_dynamic_stiffness *s, uint32_t i, uint32_t j, dmb_complex_array X, size_t stride,
                      size_t offset)
{
    const dmb_linear *linear = s->linear;
    const dmb_scene *scene = &linear->scene;
    const dmb_jointed_chains *links = &s->links;
    const uint32_t block = scene->node_block[i], width = links->size[scene->node_block[j]];
    times_null_space(s, i, j, X, stride);
    for (uint32_t c = 0; c < scene->layout.size[i]; c++) {
        const double *re = links->half.re + (size_t)width * c, *im = links->half.im + (size_t)width * c;
        const uint32_t row = scene->layout.row[i] + c;
        for (uint32_t e = linear->start[row]; e < linear->start[row + 1]; e++) {
            const size_t m = links->place[linear->column[e]] - links->row[block];
            double *to_re = links->matrix.values.re + offset + width * m;
            double *to_im = links->matrix.values.im + offset + width * m;
            for (uint32_t q = 0; q < width; q++) to_re[q] += linear->value[e] * re[q];
            for (uint32_t q = 0; q < width; q++) to_im[q] += linear->value[e] * im[q];
        }
    }
}

static dmb_complex_array part(dmb_complex_array array, size_t offset)
{
    const dmb_complex_array out = {array.re + offset, array.im + offset};
    return out;
}

static size_t diagonal_of(const dmb_scene *scene, uint32_t node)
{
    return scene->pattern.diagonal[scene->pattern.position[scene->node_block[node]]];
}

/* Nodes, and the elements between them. */
static void add_nodes(const dmb_dynamic_stiffness *s)
{
    const dmb_scene *scene = &s->linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    for (uint32_t i = 0; i < layout->n; i++) {
        if (!is_reduced(scene, i)) continue;
        add_block(s, i, i, part(s->factors.diagonal, layout->diag[i]), layout->size[i], diagonal_of(scene, i));
        if (scene->node_element[i] == DMB_NONE) continue;
        const size_t *link = scene->off_diagonal_offset + 2 * (size_t)i, inside = diagonal_of(scene, i);
        const int one = scene->node_block[i] == scene->node_block[i + 1];
        add_block(s, i, i + 1, part(s->factors.upper, layout->link[i]), layout->size[i + 1], one ? inside : link[0]);
        add_block(s, i + 1, i, part(s->factors.lower, layout->link[i]), layout->size[i], one ? inside : link[1]);
    }
}

/* Terms of joint c between two of its nodes, both in one component. */
static void add_joint(const dmb_dynamic_stiffness *s, const dmb_constraint *c, uint32_t a, uint32_t b)
{
    const dmb_scene *scene = &s->linear->scene;
    const uint32_t rows = scene->layout.size[c->node[a]], columns = scene->layout.size[c->node[b]];
    double re[DMB_NODE_SIX_DOF * DMB_NODE_SIX_DOF] = {0.0}, im[DMB_NODE_SIX_DOF * DMB_NODE_SIX_DOF] = {0.0};
    const dmb_complex_array X = {re, im};
    int acts = 0; /* most joints without laws and loads add nothing */
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t q = 0; q < columns; q++) {
            const size_t at = c->tangent + (size_t)(c->column[a] + r) * c->columns + c->column[b] + q;
            const dmb_complex_number x = dmb_dynamic_entry(s, s->linear->mass.joints[at], s->linear->damping.joints[at],
                                                           s->linear->stiffness.joints[at]);
            re[columns * r + q] = x.re;
            im[columns * r + q] = x.im;
            acts |= x.re != 0.0 || x.im != 0.0;
        }
    if (acts) add_block(s, c->node[a], c->node[b], X, columns, diagonal_of(scene, c->node[a]));
}

static void add_joints(const dmb_dynamic_stiffness *s)
{
    for (uint32_t i = 0; i < s->linear->scene.constraint_count; i++) {
        const dmb_constraint *c = s->linear->scene.constraints + i;
        for (uint32_t a = 0; a < c->node_count; a++)
            for (uint32_t b = 0; b < c->node_count; b++) add_joint(s, c, a, b);
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
    const dmb_block_pattern *pattern = &s->linear->scene.pattern;
    const dmb_jointed_chains *links = &s->links;
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

int64_t dmb_jointed_chains_factor(dmb_dynamic_stiffness *s)
{
    const dmb_block_pattern *pattern = &s->linear->scene.pattern;
    dmb_complex_sparse_clear(pattern, &s->links.matrix);
    add_nodes(s);
    add_joints(s);
    const int64_t bad = dmb_complex_sparse_factor(pattern, &s->links.matrix);
    if (bad >= 0) return node_of_place(s, s->links.row[bad]);
    const int64_t loose = unconstrained_place(s);
    return loose >= 0 ? (int64_t)node_of_place(s, (uint32_t)loose) : -1;
}

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

void dmb_jointed_chains_solve(dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    const dmb_scene *scene = &s->linear->scene;
    memset(s->links.solution.re, 0, s->links.count * sizeof(double));
    memset(s->links.solution.im, 0, s->links.count * sizeof(double));
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (is_reduced(scene, i)) restrict_rows(s, scene->layout.row[i], scene->layout.row[i + 1], x);
    dmb_complex_sparse_solve(&scene->pattern, &s->links.matrix, s->links.row, s->links.solution);
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (is_reduced(scene, i)) expand_rows(s, scene->layout.row[i], scene->layout.row[i + 1], x);
}
