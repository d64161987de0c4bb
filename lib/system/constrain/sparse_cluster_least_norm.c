/* Multipliers of least norm (eq:joints.proximal) are B y, orthogonal to all combinations of rows without effect. With
 * A = B W of all active rows, redundant ones included, and g = A^T f,
 *
 *     (A^T A + e I) y = g,   f := f + A y,   g := g - A^T A y,   over again
 *
 * from f = 0 (proximal points; Rockafellar 1976): each pass multiplies the part of g along a singular value s by
 * e/(s^2 + e), and every pass stays in the range of A. A^T A couples nodes as the joints do, so its pattern is that of
 * the other systems. */
#include <string.h>

#include "system/constrain/constrain.h"

/* e over the largest squared length of a row; number of passes; tolerance of g. */
#define DMB_PROXIMAL 1e-11
#define DMB_PROXIMAL_PASSES 8
#define DMB_PROXIMAL_REST 1e-14

static int has_redundant(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t r = c->row; r < c->row + c->rows && dmb_is_sparse(scene, i); r++)
            if (sim->constraint_type[r] != DMB_ROW_IDLE && sim->sparse_slot[r] == DMB_NONE) return 1;
    }
    return 0;
}

/* The row of A in columns of a constraint. */
static double weighted_row(const dmb_sim *sim, const dmb_constraint *c, uint32_t k, double a[DMB_CONSTRAINT_COLUMNS])
{
    const dmb_scene *scene = sim->scene;
    const double *b = dmb_sparse_row(sim, c, k);
    double square = 0.0;
    for (uint32_t n = 0; n < c->node_count; n++) {
        const double *w = sim->cluster_weight + dmb_sparse_column(scene, c->node[n]);
        for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++) {
            a[c->column[n] + s] = b[c->column[n] + s] * w[s];
            square += a[c->column[n] + s] * a[c->column[n] + s];
        }
    }
    return square;
}

/* A^T A of one row, upper triangle. */
static void put_product(dmb_sim *sim, const dmb_constraint *c, const double *a)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_pattern *pattern = &scene->pattern;
    for (uint32_t m = 0; m < c->node_count; m++)
        for (uint32_t n = 0; n < c->node_count; n++) {
            const uint32_t p = pattern->position[scene->node_block[c->node[m]]];
            const uint32_t q = pattern->position[scene->node_block[c->node[n]]];
            const uint32_t rows = scene->layout.size[c->node[m]], columns = scene->layout.size[c->node[n]];
            if (p > q) continue;
            double *to = sim->sparse_value +
                         (p == q ? pattern->diagonal[p] : pattern->upper[dmb_block_pattern_entry(pattern, p, q)]);
            for (uint32_t r = 0; r < rows; r++)
                for (uint32_t s = 0; s < columns; s++)
                    to[(size_t)r * columns + s] += a[c->column[m] + r] * a[c->column[n] + s];
        }
}

/* Calls `work` for every row of the sparse components; inactive rows are zero. */
typedef void row_work(dmb_sim *sim, const dmb_constraint *c, uint32_t k, const double *a);

static double for_rows(dmb_sim *sim, row_work *work)
{
    const dmb_scene *scene = sim->scene;
    double largest = 0.0;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->rows && dmb_is_sparse(scene, i); k++) {
            double a[DMB_CONSTRAINT_COLUMNS];
            if (sim->constraint_type[c->row + k] == DMB_ROW_IDLE) continue;
            largest = fmax(largest, weighted_row(sim, c, k, a));
            work(sim, c, k, a);
        }
    }
    return largest;
}

static void add_product(dmb_sim *sim, const dmb_constraint *c, uint32_t k, const double *a)
{
    (void)k;
    put_product(sim, c, a);
}

/* g += A^T f by the multipliers of the trial */
static void add_force(dmb_sim *sim, const dmb_constraint *c, uint32_t k, const double *a)
{
    const dmb_scene *scene = sim->scene;
    const double f = sim->trial.multiplier[c->row + k];
    for (uint32_t n = 0; n < c->node_count && f != 0.0; n++) {
        double *g = sim->sparse_gradient + sim->sparse_row[scene->node_block[c->node[n]]];
        for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++) g[s] += f * a[c->column[n] + s];
    }
}

/* f += A y, g -= A^T A y */
static void move_multiplier(dmb_sim *sim, const dmb_constraint *c, uint32_t k, const double *a)
{
    const dmb_scene *scene = sim->scene;
    double change = 0.0;
    for (uint32_t n = 0; n < c->node_count; n++) {
        const double *y = sim->sparse_vector + sim->sparse_row[scene->node_block[c->node[n]]];
        for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++) change += a[c->column[n] + s] * y[s];
    }
    sim->trial.multiplier[c->row + k] += change;
    for (uint32_t n = 0; n < c->node_count; n++) {
        double *g = sim->sparse_gradient + sim->sparse_row[scene->node_block[c->node[n]]];
        for (uint32_t s = 0; s < scene->layout.size[c->node[n]]; s++) g[s] -= change * a[c->column[n] + s];
    }
}

static double square_of(uint32_t n, const double *x)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < n; i++) sum += x[i] * x[i];
    return sum;
}

/* Factorises A^T A + e I. False if it is singular. */
static int factor(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_signed matrix = dmb_sparse_matrix(sim);
    dmb_block_signed_clear(&scene->pattern, &matrix);
    const double e = DMB_PROXIMAL * for_rows(sim, add_product);
    for (uint32_t b = 0; b < scene->block_count; b++) {
        double *D = sim->sparse_value + scene->pattern.diagonal[scene->pattern.position[b]];
        for (uint32_t s = 0; s < sim->sparse_size[b]; s++) D[(sim->sparse_size[b] + (size_t)1) * s] += e;
    }
    return dmb_block_signed_factor(&scene->pattern, &matrix, 0.0) < 0;
}

static void clear_multipliers(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->constraint_count; i++) {
        const dmb_constraint *c = sim->scene->constraints + i;
        if (dmb_is_sparse(sim->scene, i)) memset(sim->trial.multiplier + c->row, 0, c->rows * sizeof(double));
    }
}

/* Only if a row is redundant: otherwise multipliers are unique. The matrix of the projections is overwritten, hence
 * metric = 0, and the sizes of the blocks are those of nodes alone meanwhile. If A^T A + e I cannot be factored, the
 * multipliers stay as they are, which balance too. */
void dmb_sparse_least_norm(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_signed matrix = dmb_sparse_matrix(sim);
    if (scene->sparse_count == 0 || !has_redundant(sim)) return;
    memcpy(sim->sparse_size, sim->sparse_plus, scene->block_count * sizeof(uint32_t));
    const uint32_t n = dmb_sparse_number(sim);
    sim->reduced_mode->metric = 0;
    if (factor(sim)) {
        memset(sim->sparse_gradient, 0, n * sizeof(double));
        (void)for_rows(sim, add_force);
        const double all = square_of(n, sim->sparse_gradient);
        clear_multipliers(sim);
        for (int k = 0; k < DMB_PROXIMAL_PASSES; k++) {
            if (square_of(n, sim->sparse_gradient) <= DMB_PROXIMAL_REST * DMB_PROXIMAL_REST * all) break;
            memcpy(sim->sparse_vector, sim->sparse_gradient, n * sizeof(double));
            dmb_block_signed_solve(&scene->pattern, &matrix, sim->sparse_vector);
            (void)for_rows(sim, move_multiplier);
        }
    }
    dmb_sparse_note(sim); /* sizes with multipliers */
}
