#include "analysis/symmetry.h"

#include <math.h>

/* ---- Symmetric part ---------------------------------------------------------------------------------------------- */

/* U and L^T of shape (n, m) become their mean, and L its transpose. */
static void average_link(uint32_t n, uint32_t m, double *U, double *L)
{
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < m; j++)
            U[(size_t)m * i + j] = L[(size_t)n * j + i] = 0.5 * (U[(size_t)m * i + j] + L[(size_t)n * j + i]);
}

static void average_block(uint32_t n, double *D)
{
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < i; j++)
            D[(size_t)n * i + j] = D[(size_t)n * j + i] = 0.5 * (D[(size_t)n * i + j] + D[(size_t)n * j + i]);
}

void dmb_make_blocks_symmetric(const dmb_block_layout *layout, double *diagonal, double *lower, double *upper)
{
    for (uint32_t k = 0; k < layout->n; k++) {
        average_block(layout->size[k], diagonal + layout->diag[k]);
        if (k + 1 < layout->n)
            average_link(layout->size[k], layout->size[k + 1], upper + layout->link[k], lower + layout->link[k]);
    }
}

void dmb_make_linked_symmetric(const dmb_sim *sim, double *values)
{
    const dmb_block_pattern *pattern = &sim->scene->pattern;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t n = sim->linked_size[pattern->order[k]];
        average_block(n, values + pattern->diagonal[k]);
        for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++)
            average_link(n, sim->linked_size[pattern->order[pattern->later[e]]], values + pattern->upper[e],
                         values + pattern->lower[e]);
    }
}

/* ---- Asymmetry --------------------------------------------------------------------------------------------------- */

/* Of entries ij of A, shape (n, m), and ji of B, shape (m, n); Di, Dj: diagonal blocks of their rows. */
static double worst_pair(uint32_t n, uint32_t m, const double *A, const double *B, const double *Di, const double *Dj,
                         double rounding)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < m; j++) {
            const double apart = fabs(A[(size_t)m * i + j] - B[(size_t)n * j + i]);
            if (!(apart > rounding)) continue;
            const double size = sqrt(fabs(Di[(size_t)(n + 1) * i] * Dj[(size_t)(m + 1) * j]));
            worst = fmax(worst, apart / fmax(size, rounding));
        }
    return worst;
}

static double asymmetry_of_chain(const dmb_sim *sim, const dmb_chain *chain, double rounding)
{
    const dmb_block_layout *layout = &sim->scene->layout;
    double worst = 0.0;
    for (uint32_t k = chain->first; k < chain->first + chain->count; k++) {
        const uint32_t n = layout->size[k];
        const double *D = sim->stiffness_diagonal + layout->diag[k];
        worst = fmax(worst, worst_pair(n, n, D, D, D, D, rounding));
        if (k + 1 == chain->first + chain->count) continue;
        worst = fmax(worst, worst_pair(n, layout->size[k + 1], sim->stiffness_upper + layout->link[k],
                                       sim->stiffness_lower + layout->link[k], D,
                                       sim->stiffness_diagonal + layout->diag[k + 1], rounding));
    }
    return worst;
}

static double asymmetry_of_linked(const dmb_sim *sim, double rounding)
{
    const dmb_block_pattern *pattern = &sim->scene->pattern;
    const double *values = sim->linked_value;
    double worst = 0.0;
    for (uint32_t k = 0; k < pattern->n; k++) {
        const uint32_t n = sim->linked_size[pattern->order[k]];
        const double *D = values + pattern->diagonal[k];
        worst = fmax(worst, worst_pair(n, n, D, D, D, D, rounding));
        for (uint32_t e = pattern->column[k]; e < pattern->column[k + 1]; e++) {
            const uint32_t later = pattern->later[e];
            worst = fmax(worst, worst_pair(n, sim->linked_size[pattern->order[later]], values + pattern->upper[e],
                                           values + pattern->lower[e], D, values + pattern->diagonal[later], rounding));
        }
    }
    return worst;
}

double dmb_asymmetry_of(const dmb_sim *sim, double rounding)
{
    const dmb_scene *scene = sim->scene;
    const double arm = fmax(1.0, scene->length_scale), unit = rounding * arm * arm;
    double worst = scene->cluster_count ? asymmetry_of_linked(sim, unit) : 0.0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        if (!scene->chains[c].linked) worst = fmax(worst, asymmetry_of_chain(sim, scene->chains + c, unit));
    return worst;
}
