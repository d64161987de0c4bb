/* Factors and shapes of linear buckling about one state. */
#include "analysis/buckling/buckling.h"

#include "sim/access.h"

/* [-] Relative difference below which factors count as equal, with mutually orthogonal vectors. */
#define DMB_SAME_FACTOR 1e-6

/* Scales a shape to a largest displacement of 1 m, or rotation of 1 rad if nothing else moves; its largest component is
 * positive. */
void dmb_buckling_normalise(const dmb_scene *scene, double *x)
{
    double most[2] = {0.0, 0.0};
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i];
        for (uint32_t c = 0; c < size; c++) {
            const double value = x[scene->layout.row[i] + c];
            double *of = most + (2 * c < size ? 0 : 1);
            if (fabs(value) > fabs(*of)) *of = value;
        }
    }
    const double unit = fabs(most[0]) > 1e-9 * fabs(most[1]) ? most[0] : most[1];
    for (uint32_t i = 0; i < scene->row_count; i++) x[i] /= unit;
}

static void store_shape(dmb_buckling *buckling, uint32_t k)
{
    const size_t rows = buckling->work->scene->row_count, unknowns = buckling->pencil.unknowns;
    dmb_buckling_expand(buckling, buckling->vector + k * unknowns, buckling->shape + k * rows);
    dmb_buckling_normalise(buckling->work->scene, buckling->shape + k * rows);
}

/* distance: of the factor from the linearised state. Factors closer than DMB_SAME_FACTOR belong to one eigenspace:
 * the vector is made orthogonal to those found in it, as the count has shown that there are as many. */
static void find_shape(dmb_buckling *buckling, uint32_t k, double distance)
{
    const size_t unknowns = buckling->pencil.unknowns;
    uint32_t first = k;
    while (first > 0 && buckling->factor[k] - buckling->factor[first - 1] < DMB_SAME_FACTOR * distance) first--;
    (void)dmb_pencil_vector(&buckling->pencil, distance, buckling->vector + first * unknowns, k - first,
                            buckling->vector + k * unknowns);
    store_shape(buckling, k);
}

/* Factor k + 1 is searched from factor k on. Its number is known from the count, so none is missed and the end of the
 * list is certain: fewer than requested exist up to factor_max (DMB_NOTE_STOPPED). */
static int32_t find_symmetric(dmb_buckling *buckling, const dmb_buckling_options *options, dmb_message *message)
{
    const double most = options->factor_max - buckling->at;
    double guess = fmin(buckling->at > 0.0 && isfinite(buckling->first[0]) ? buckling->first[0] : 1.0, most);
    for (uint32_t k = 0; k < options->count; k++) {
        dmb_progress_at(buckling->work, 0.5 * k / options->count);
        const double factor = dmb_pencil_factor(&buckling->pencil, k, guess, most, options->tolerance);
        if (isnan(factor)) {
            dmb_message_set(message, "buckling: critical factor %u cannot be counted, the stiffness stays singular", k);
            return DMB_ERR_SINGULAR;
        }
        if (!isfinite(factor)) return DMB_NOTE_STOPPED;
        guess = factor;
        buckling->factor[k] = buckling->at + factor;
        buckling->count = k + 1;
        find_shape(buckling, k, factor);
    }
    return DMB_OK;
}

static int32_t find_general(dmb_buckling *buckling, const dmb_buckling_options *options, dmb_message *message)
{
    const dmb_pencil_search search = {options->count, options->factor_max - buckling->at, &buckling->allocator};
    const int32_t status =
        dmb_pencil_general(&buckling->pencil, &search, buckling->factor, buckling->vector, &buckling->count);
    if (status < 0 && status != DMB_ERR_NO_MEMORY)
        dmb_message_set(
            message, "buckling: the critical factors of the unsymmetric stiffness at factor = %g cannot be found, %s",
            buckling->at, dmb_status_text(status));
    if (status < 0) return status;
    for (uint32_t k = 0; k < buckling->count; k++) {
        buckling->factor[k] += buckling->at;
        store_shape(buckling, k);
    }
    return buckling->count < options->count ? DMB_NOTE_STOPPED : DMB_OK;
}

int32_t dmb_buckling_find(dmb_buckling *buckling, const dmb_buckling_options *options, dmb_message *message)
{
    buckling->count = 0;
    buckling->info.linearisations++;
    buckling->info.linearised_at = buckling->at;
    return buckling->info.stiffness == DMB_STIFFNESS_UNSYMMETRIC ? find_general(buckling, options, message)
                                                                 : find_symmetric(buckling, options, message);
}
