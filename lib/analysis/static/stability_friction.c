/* Rows of K combined such that the wall's stiffness is symmetric although friction slips (eq:static.friction-turned).
 *
 * With n the normal of a ring and f the friction of a unit normal force, the ring's tangent is k (n + f) n^T, whose
 * symmetric part is indefinite. W = I - f n^T = I - E turns it into k n n^T, since f . n = 0. Elements lose symmetry by
 * E K instead. x^T E K x is bounded by the energy norms of x and E^T x, and the latter is small only if E varies slowly
 * along the string: therefore E is interpolated between rings instead of being 0 there. */
#include "analysis/static/static.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "system/assemble/assemble.h"

/* Largest |f| for which the criterion applies: it keeps the divisor 1 - |f|/2 of the bound above 0.1. */
#define DMB_FRICTION_MOST 1.8

enum { ENTRIES = 18 };

/* f n^T of each node, n in its translations; mean over its rings. */
typedef struct friction_field {
    double *E;       /* shape (node, 6, 3) */
    uint32_t *rings; /* number of rings of each node */
    double most;     /* largest |f| */
} friction_field;

static void add_stabiliser(const dmb_evaluation *evaluation, uint32_t s, friction_field *field)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const uint32_t node = scene->sites[s].node;
    double n[3], f[6], size = 0.0, *E = field->E + ENTRIES * (size_t)node;
    if (!dmb_contact_friction_by_normal(evaluation, s, n, f)) return;
    for (int i = 0; i < 6; i++) size += f[i] * f[i] / (i < 3 ? 1.0 : scene->length_scale * scene->length_scale);
    field->most = fmax(field->most, sqrt(size));
    field->rings[node]++;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 3; j++) E[3 * i + j] += f[i] * n[j];
}

/* Interpolates linearly between rings; constant beyond the first and last ring. */
static void fill_chain(const dmb_chain *chain, friction_field *field)
{
    const uint32_t end = chain->first + chain->count;
    uint32_t before = DMB_NONE;
    for (uint32_t i = chain->first; i < end; i++) {
        if (field->rings[i] == 0) continue;
        const double *here = field->E + ENTRIES * (size_t)i,
                     *last = before < end ? here - ENTRIES * (size_t)(i - before) : here;
        for (uint32_t k = before < end ? before + 1 : chain->first; k < i; k++) {
            const double part = before < end ? (double)(k - before) / (double)(i - before) : 1.0;
            for (int e = 0; e < ENTRIES; e++)
                field->E[ENTRIES * (size_t)k + (size_t)e] = last[e] + part * (here[e] - last[e]);
        }
        before = i;
    }
    for (uint32_t k = before + 1; before < end && k < end; k++)
        memcpy(field->E + ENTRIES * (size_t)k, field->E + ENTRIES * (size_t)before, ENTRIES * sizeof(double));
}

static void assemble_rings(const dmb_evaluation *evaluation, friction_field *field)
{
    const dmb_scene *scene = evaluation->sim->scene;
    for (uint32_t s = 0; s < scene->site_count; s++) add_stabiliser(evaluation, s, field);
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (int e = 0; field->rings[i] > 1 && e < ENTRIES; e++)
            field->E[ENTRIES * (size_t)i + (size_t)e] /= field->rings[i];
    for (uint32_t c = 0; c < scene->chain_count; c++) fill_chain(scene->chains + c, field);
}

/* A <- A - E A, A of 6 rows of the node; constrained rows are unchanged and contribute nothing. */
static void turn_rows(const dmb_scene *scene, uint32_t node, const double *E, uint32_t columns, double *A)
{
    const uint8_t *solved = scene->solved_row + scene->layout.row[node];
    for (uint32_t c = 0; c < columns; c++) {
        double n[3];
        for (uint32_t j = 0; j < 3; j++) n[j] = solved[j] ? A[(size_t)columns * j + c] : 0.0;
        for (uint32_t i = 0; i < 6; i++)
            if (solved[i])
                for (uint32_t j = 0; j < 3; j++) A[(size_t)columns * i + c] -= E[3 * i + j] * n[j];
    }
}

static void turn_chain(dmb_sim *sim, const dmb_chain *chain, const double *fields)
{
    const dmb_scene *scene = sim->scene;
    const dmb_block_layout *layout = &scene->layout;
    for (uint32_t i = chain->first; i < chain->first + chain->count; i++) {
        const double *E = fields + ENTRIES * (size_t)i;
        if (layout->size[i] != DMB_NODE_SIX_DOF) continue;
        turn_rows(scene, i, E, 6, sim->stiffness_diagonal + layout->diag[i]);
        if (i > chain->first) turn_rows(scene, i, E, layout->size[i - 1], sim->stiffness_lower + layout->link[i - 1]);
        if (i + 1 < chain->first + chain->count)
            turn_rows(scene, i, E, layout->size[i + 1], sim->stiffness_upper + layout->link[i]);
    }
}

int32_t dmb_stability_turn_friction(const dmb_evaluation *evaluation, double *most)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const size_t bytes = scene->node_count * (ENTRIES * sizeof(double) + sizeof(uint32_t));
    if (scene->site_count == 0 || scene->friction_law.kind == DMB_FRICTION_NONE) return 0;
    friction_field field = {.E = dmb_allocate(&sim->allocator, bytes)};
    if (field.E == NULL) return DMB_ERR_NO_MEMORY;
    field.rings = (uint32_t *)(void *)(field.E + ENTRIES * (size_t)scene->node_count);
    assemble_rings(evaluation, &field);
    *most = field.most;
    const int done = field.most > 0.0 && field.most < DMB_FRICTION_MOST;
    for (uint32_t c = 0; c < scene->chain_count && done; c++)
        if (!scene->chains[c].jointed) turn_chain(sim, scene->chains + c, field.E);
    dmb_release(&sim->allocator, field.E, bytes);
    return done;
}
