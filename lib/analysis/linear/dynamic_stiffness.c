/* The dynamic stiffness of a linearised scene at one frequency,
 *
 *     A(w) = (1 + i eta) K + i w C - w^2 M,     A d = f,
 *
 * or of growing motions, d ~ e^(p t), p = growth + i w: A(p) = (1 + i eta) K + p C + p^2 M,
 *
 * assembled in complex blocks, factored and solved: block-tridiagonal along a chain, block-sparse in the independent
 * coordinates where joints connect chains (dynamic_stiffness_chains.c). Supported rows do not move. Rows moved by
 * drives have prescribed displacements p, which satisfy all equations of joints: d = p + R z, R^T A R z = -R^T A p. */
#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "base/memory.h"
#include "system/constrain/constrain.h"

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static void lay_out(dmb_arena *arena, const dmb_linear *linear, dmb_jointed_chains_size links,
                    dmb_dynamic_stiffness *out)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    out->factors.diagonal = dmb_complex_lay_out(arena, layout->diag[layout->n]);
    out->factors.lower = dmb_complex_lay_out(arena, layout->link[layout->n - 1]);
    out->factors.upper = dmb_complex_lay_out(arena, layout->link[layout->n - 1]);
    out->factors.pivot = DMB_ARENA_ARRAY(arena, uint32_t, linear->rows);
    out->prescribed = dmb_complex_lay_out(arena, linear->rows);
    dmb_jointed_chains_lay_out(arena, linear, links, &out->links);
}

int32_t dmb_dynamic_stiffness_make(const dmb_linear *linear, double structural_damping, dmb_dynamic_stiffness *out)
{
    const dmb_jointed_chains_size links = dmb_jointed_chains_sizes(linear);
    dmb_arena arena;
    memset(out, 0, sizeof *out);
    out->linear = linear;
    out->structural_damping = structural_damping;
    dmb_arena_count(&arena);
    lay_out(&arena, linear, links, out);
    out->block_size = dmb_arena_block_size(&arena);
    out->block = dmb_allocate(&linear->allocator, out->block_size);
    if (out->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, out->block, out->block_size);
    lay_out(&arena, linear, links, out);
    dmb_jointed_chains_number(linear, links, &out->links);
    return DMB_OK;
}

void dmb_dynamic_stiffness_release(dmb_dynamic_stiffness *stiffness)
{
    if (stiffness->linear != NULL) dmb_release(&stiffness->linear->allocator, stiffness->block, stiffness->block_size);
    memset(stiffness, 0, sizeof *stiffness);
}

/* ---- Assembly ---------------------------------------------------------------------------------------------------- */

static dmb_complex_array part(dmb_complex_array array, size_t offset)
{
    const dmb_complex_array out = {array.re + offset, array.im + offset};
    return out;
}

/* Assembles A of a chain without joints. */
static void assemble_chain(dmb_dynamic_stiffness *s, const dmb_chain *chain)
{
    const dmb_linear_matrix *M = &s->linear->mass, *C = &s->linear->damping, *K = &s->linear->stiffness;
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const dmb_complex_block_matrix *A = &s->factors;
    const size_t end = chain->first + chain->count, d = layout->diag[chain->first], l = layout->link[chain->first];
    const size_t diagonal = layout->diag[end] - d, link = layout->link[end - 1] - l;
    dmb_dynamic_assemble(s, diagonal, M->diagonal + d, C->diagonal + d, K->diagonal + d, part(A->diagonal, d));
    dmb_dynamic_assemble(s, link, M->lower + l, C->lower + l, K->lower + l, part(A->lower, l));
    dmb_dynamic_assemble(s, link, M->upper + l, C->upper + l, K->upper + l, part(A->upper, l));
}

/* Assembles A of chains without joints; constrained rows and columns are identity. */
static void assemble(dmb_dynamic_stiffness *s)
{
    const dmb_scene *scene = &s->linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    const dmb_complex_block_matrix *A = &s->factors;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed) assemble_chain(s, scene->chains + c);
    for (uint32_t i = 0; i < scene->constrained_count; i++) {
        const uint32_t node = scene->constrained_node[i];
        A->diagonal.re[layout->diag[node] + (layout->size[node] + 1u) * scene->constrained_component[i]] = 1.0;
    }
}

/* ---- Factors and solution ---------------------------------------------------------------------------------------- */

/* First node of a chain with a pivot of rounding size, or -1. The reciprocal pivots are on the diagonal. Factors of
 * rounding size are not singular to the elimination: a motion that neither stiffness nor inertia resists at this
 * frequency would get a huge, meaningless response. The pivot is compared with the terms of which it is the
 * difference. */
static int64_t unconstrained_node(const dmb_dynamic_stiffness *s, const dmb_chain *chain)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const double *M = s->linear->mass.diagonal, *K = s->linear->stiffness.diagonal;
    for (uint32_t node = chain->first; node < chain->first + chain->count; node++)
        for (uint32_t c = 0; c < layout->size[node]; c++) {
            const uint32_t at = layout->diag[node] + (layout->size[node] + 1u) * c;
            if (dmb_dynamic_is_unconstrained(s, s->factors.diagonal.re[at], s->factors.diagonal.im[at], fabs(K[at]),
                                             fabs(M[at])))
                return (int64_t)node;
        }
    return -1;
}

int64_t dmb_dynamic_stiffness_factor(dmb_dynamic_stiffness *s, double omega)
{
    return dmb_dynamic_stiffness_factor_at(s, 0.0, omega);
}

int64_t dmb_dynamic_stiffness_factor_at(dmb_dynamic_stiffness *s, double growth, double omega)
{
    const dmb_scene *scene = &s->linear->scene;
    s->growth = growth;
    s->omega = omega;
    assemble(s);
    for (uint32_t c = 0; c < scene->chain_count; c++) {
        const dmb_chain *chain = scene->chains + c;
        if (chain->jointed) continue;
        int64_t bad = dmb_complex_block_factor(&scene->layout, &s->factors, chain->first, chain->count);
        if (bad < 0) bad = unconstrained_node(s, chain);
        if (bad >= 0) return bad;
    }
    return scene->cluster_count > 0 ? dmb_jointed_chains_factor(s) : -1;
}

/* Right-hand side -A p of a prescribed motion p, which is kept for the solution d = p + x. */
void dmb_dynamic_set_prescribed(dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    const size_t bytes = s->linear->rows * sizeof(double);
    memcpy(s->prescribed.re, x.re, bytes);
    memcpy(s->prescribed.im, x.im, bytes);
    memset(x.re, 0, bytes);
    memset(x.im, 0, bytes);
    dmb_dynamic_subtract(s, s->prescribed, x);
}

void dmb_dynamic_add_prescribed(const dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    for (uint32_t r = 0; r < s->linear->rows; r++) {
        x.re[r] += s->prescribed.re[r];
        x.im[r] += s->prescribed.im[r];
    }
}

void dmb_dynamic_stiffness_solve(dmb_dynamic_stiffness *s, int32_t moves, dmb_complex_array x)
{
    const dmb_scene *scene = &s->linear->scene;
    if (moves) dmb_dynamic_set_prescribed(s, x);
    for (uint32_t r = 0; r < scene->row_count; r++)
        if (!scene->solved_row[r]) x.re[r] = x.im[r] = 0.0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].jointed)
            dmb_complex_block_solve(&scene->layout, &s->factors, scene->chains[c].first, scene->chains[c].count, x);
    if (scene->cluster_count > 0) dmb_jointed_chains_solve(s, x);
    if (moves) dmb_dynamic_add_prescribed(s, x);
}

/* ---- Products ---------------------------------------------------------------------------------------------------- */

static void subtract(dmb_complex_number a, dmb_complex_array x, uint32_t from, dmb_complex_array y, uint32_t to)
{
    y.re[to] -= a.re * x.re[from] - a.im * x.im[from];
    y.im[to] -= a.re * x.im[from] + a.im * x.re[from];
}

static void add(dmb_complex_number a, dmb_complex_array x, uint32_t from, dmb_complex_number *sum)
{
    sum->re += a.re * x.re[from] - a.im * x.im[from];
    sum->im += a.re * x.im[from] + a.im * x.re[from];
}

static int moves(dmb_complex_array p, uint32_t row)
{
    return p.re[row] != 0.0 || p.im[row] != 0.0;
}

/* ---- Entries of A ------------------------------------------------------------------------------------------------ */

static dmb_complex_number entry_of(const dmb_dynamic_stiffness *s, const double *M, const double *C, const double *K,
                                   size_t at)
{
    return dmb_dynamic_entry(s, M[at], C[at], K[at]);
}

/* Row r of node i, column c of node j, both solved and j next to i or i itself. */
static dmb_complex_number entry_of_nodes(const dmb_dynamic_stiffness *s, uint32_t i, uint32_t r, uint32_t j, uint32_t c)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const dmb_linear_matrix *M = &s->linear->mass, *C = &s->linear->damping, *K = &s->linear->stiffness;
    const size_t at = (size_t)layout->size[j] * r + c;
    if (j == i) return entry_of(s, M->diagonal, C->diagonal, K->diagonal, layout->diag[i] + at);
    if (j > i) return entry_of(s, M->upper, C->upper, K->upper, layout->link[i] + at);
    return entry_of(s, M->lower, C->lower, K->lower, layout->link[j] + at);
}

/* Entry of a constrained row or column, of which 18 per matrix are stored, with component c of its node or a neighbour.
 */
static dmb_complex_number entry_of_constrained(const dmb_dynamic_stiffness *s, const double *lines, uint32_t i,
                                               uint32_t node, uint32_t c)
{
    const double *M = lines + 54 * (size_t)i;
    const size_t at = 6 * ((size_t)node + 1 - s->linear->scene.constrained_node[i]) + c;
    return entry_of(s, M, M + 18, M + 36, at);
}

static dmb_complex_number entry_of_joint(const dmb_dynamic_stiffness *s, size_t at)
{
    const double *M = s->linear->whole_joints, *C = M + s->linear->scene.tangent_count;
    return entry_of(s, M, C, C + s->linear->scene.tangent_count, at);
}

static int is_next_to(const dmb_scene *scene, uint32_t i, uint32_t node)
{
    const uint32_t held = scene->constrained_node[i];
    return held <= node + 1 && node <= held + 1;
}

/* ---- Columns ----------------------------------------------------------------------------------------------------- */

/* y -= A_.c p_c in the rows of the node and the nodes next to it. */
static void subtract_column(const dmb_dynamic_stiffness *s, uint32_t node, uint32_t c, dmb_complex_array p,
                            dmb_complex_array y)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    const uint32_t first = node > 0 ? node - 1 : node, last = node + 1 < layout->n ? node + 1 : node;
    for (uint32_t i = first; i <= last; i++)
        for (uint32_t r = 0; r < layout->size[i]; r++)
            subtract(entry_of_nodes(s, i, r, node, c), p, layout->row[node] + c, y, layout->row[i] + r);
}

static void subtract_constrained_column(const dmb_dynamic_stiffness *s, uint32_t h, dmb_complex_array p,
                                        dmb_complex_array y)
{
    const dmb_scene *scene = &s->linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t node = scene->constrained_node[h];
    const uint32_t first = node > 0 ? node - 1 : node, last = node + 1 < layout->n ? node + 1 : node;
    for (uint32_t i = first; i <= last; i++)
        for (uint32_t r = 0; r < layout->size[i]; r++)
            subtract(entry_of_constrained(s, s->linear->constrained_columns, h, i, r), p, dmb_constrained_row(scene, h),
                     y, layout->row[i] + r);
}

/* y -= force of a joint on node a due to the motion p of its node b. */
static void subtract_joint(const dmb_dynamic_stiffness *s, const dmb_constraint *c, uint32_t a, uint32_t b,
                           dmb_complex_array p, dmb_complex_array y)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    for (uint32_t q = 0; q < layout->size[c->node[b]]; q++) {
        const uint32_t from = layout->row[c->node[b]] + q;
        if (!moves(p, from)) continue;
        for (uint32_t r = 0; r < layout->size[c->node[a]]; r++)
            subtract(entry_of_joint(s, c->tangent + (size_t)(c->column[a] + r) * c->columns + c->column[b] + q), p,
                     from, y, layout->row[c->node[a]] + r);
    }
}

/* y -= A p for all rows of a sparse p: columns of solved rows from the blocks, of constrained rows from their copies,
 * and joints by their tangents. */
void dmb_dynamic_subtract(const dmb_dynamic_stiffness *s, dmb_complex_array p, dmb_complex_array y)
{
    const dmb_scene *scene = &s->linear->scene;
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++) {
            const uint32_t row = scene->layout.row[i] + c;
            if (scene->solved_row[row] && moves(p, row)) subtract_column(s, i, c, p, y);
        }
    for (uint32_t h = 0; h < scene->constrained_count; h++)
        if (moves(p, dmb_constrained_row(scene, h))) subtract_constrained_column(s, h, p, y);
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t a = 0; a < c->node_count; a++)
            for (uint32_t b = 0; b < c->node_count; b++) subtract_joint(s, c, a, b, p, y);
    }
}

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

/* Index of a row among the constrained rows, or DMB_NONE. */
static uint32_t constrained_of(const dmb_scene *scene, uint32_t node, uint32_t c)
{
    for (uint32_t i = 0; i < scene->constrained_count; i++)
        if (scene->constrained_node[i] == node && scene->constrained_component[i] == c) return i;
    return DMB_NONE;
}

/* The row times the solved and the prescribed motion of the node and its neighbours. */
static dmb_complex_number chain_row(const dmb_dynamic_stiffness *s, uint32_t node, uint32_t c, dmb_complex_array x)
{
    const dmb_scene *scene = &s->linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    const uint32_t first = node > 0 ? node - 1 : node, last = node + 1 < layout->n ? node + 1 : node;
    const uint32_t held = scene->solved_row[layout->row[node] + c] ? DMB_NONE : constrained_of(scene, node, c);
    dmb_complex_number sum = {0.0, 0.0};
    for (uint32_t j = first; j <= last; j++)
        for (uint32_t q = 0; q < layout->size[j]; q++) {
            if (!scene->solved_row[layout->row[j] + q]) continue;
            add(held == DMB_NONE ? entry_of_nodes(s, node, c, j, q)
                                 : entry_of_constrained(s, s->linear->constrained_rows, held, j, q),
                x, layout->row[j] + q, &sum);
        }
    for (uint32_t h = 0; h < scene->constrained_count; h++)
        if (is_next_to(scene, h, node) && moves(x, dmb_constrained_row(scene, h)))
            add(entry_of_constrained(s, s->linear->constrained_columns, h, node, c), x, dmb_constrained_row(scene, h),
                &sum);
    return sum;
}

static void add_joint_row(const dmb_dynamic_stiffness *s, const dmb_constraint *c, uint32_t a, uint32_t r,
                          dmb_complex_array x, dmb_complex_number *sum)
{
    const dmb_block_layout *layout = &s->linear->scene.layout;
    for (uint32_t b = 0; b < c->node_count; b++)
        for (uint32_t q = 0; q < layout->size[c->node[b]]; q++)
            add(entry_of_joint(s, c->tangent + (size_t)(c->column[a] + r) * c->columns + c->column[b] + q), x,
                layout->row[c->node[b]] + q, sum);
}

/* Row of A x, also of a constrained row: the force that its support carries, with joints that act on the node. */
dmb_complex_number dmb_dynamic_row(const dmb_dynamic_stiffness *s, uint32_t node, uint32_t c, dmb_complex_array x)
{
    const dmb_scene *scene = &s->linear->scene;
    dmb_complex_number sum = chain_row(s, node, c, x);
    if (scene->cluster_count == 0 || scene->node_cluster[node] == DMB_NONE) return sum;
    const dmb_cluster *cluster = scene->clusters + scene->node_cluster[node];
    for (uint32_t i = cluster->constraint; i < cluster->constraint + cluster->constraint_count; i++)
        for (uint32_t a = 0; a < scene->constraints[i].node_count; a++)
            if (scene->constraints[i].node[a] == node) add_joint_row(s, scene->constraints + i, a, c, x, &sum);
    return sum;
}

/* ---- Multipliers ------------------------------------------------------------------------------------------------- */

/* C_d^T f = -(A x - f) in the dependent rows; `rest` in the order of dependent columns. */
static void solve_multipliers(dmb_sim *sim, uint32_t k, double *rest, double *multipliers)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(sim, k);
    const double *lu = sim->cluster_lu + cluster->square;
    const uint32_t *pivot = sim->cluster_pivot + cluster->row;
    dmb_partition_solve_transposed(&partition, lu, pivot, rest);
    memset(multipliers, 0, cluster->rows * sizeof(double));
    for (uint32_t i = 0; i < partition.rank; i++) multipliers[partition.row_order[i]] = rest[i];
    if (partition.rank < dmb_cluster_active_rows(sim, cluster))
        dmb_partition_least_norm(&(dmb_jacobian){sim->cluster_matrix + cluster->dense, cluster->columns, NULL},
                                 &partition, lu, pivot, sim->cluster_gram + cluster->square, multipliers);
}

/* Multipliers of a cluster by the dependent rows (eq:static.blocks): C_d^T f = f_d - (A x)_d for real and imaginary
 * part. With redundant equations the solution of least norm (eq:joints.least-norm). */
void dmb_dynamic_multipliers(const dmb_dynamic_stiffness *s, uint32_t k, dmb_complex_array x, dmb_complex_array f,
                             dmb_complex_array multipliers)
{
    dmb_sim *work = s->linear->work;
    const dmb_scene *scene = &s->linear->scene;
    const dmb_cluster *cluster = scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(work, k);
    double *re = s->links.rest, *im = re + cluster->rows;
    for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count; i++) {
        const uint32_t node = scene->cluster_nodes[i];
        for (uint32_t c = 0; c < scene->layout.size[node]; c++) {
            const uint32_t place = work->cluster_place[cluster->column + scene->node_place[node] + c];
            const uint32_t row = scene->layout.row[node] + c;
            if (place >= partition.rank) continue;
            const dmb_complex_number a = dmb_dynamic_row(s, node, c, x);
            re[place] = f.re[row] - a.re;
            im[place] = f.im[row] - a.im;
        }
    }
    solve_multipliers(work, k, re, multipliers.re);
    solve_multipliers(work, k, im, multipliers.im);
}
