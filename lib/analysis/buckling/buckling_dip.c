/* Strings that are not perfectly straight do not meet a bifurcation: the equilibria bend off into the buckled shape,
 * and the lowest eigenvalue of K x = mu E x, E the displacements across the string, has a minimum above 0 where the
 * perfect string would buckle (Koiter 1945). It is closed in by golden sections of the arc (eq:buckling.dip). */
#include <math.h>
#include <string.h>

#include "analysis/buckling/buckling.h"
#include "drillmbd/query.h"
#include "sim/access.h"

/* A minimum counts below this part of the largest value before; one to be closed in may lie between the points. */
#define DMB_DIP_DEEP 0.5
#define DMB_DIP_SHALLOW 0.9
/* A rise by less than this part of the value is none. */
#define DMB_DIP_RISE 1e-3
#define DMB_DIP_SECTIONS 14
#define DMB_GOLDEN 0.6180339887498949

/* The point at `arc` from the last one; values of unstable states are negative. */
static int32_t probe(dmb_dip *dip, dmb_path *path, double arc, dmb_dip_point *point)
{
    int32_t status = dmb_path_correct(path, path->last.tangent, path->last.rate, arc);
    if (status >= 0) status = dmb_path_tangent(path, path->last.tangent);
    if (status >= 0) status = dmb_stability_softest(path->work, &point->value, dip->shape);
    if (status < 0) return status;
    if (path->next.negative > 0) point->value = -fabs(point->value);
    point->arc = arc;
    point->factor = path->next.factor;
    return DMB_OK;
}

/* Between arcs low and high of the last point, which is in `least`. */
static int32_t close_in(dmb_dip *dip, dmb_path *path, double low, double high, dmb_dip_point *least)
{
    dmb_dip_point inner[2] = {{0}};
    int32_t status = probe(dip, path, high - DMB_GOLDEN * (high - low), &inner[0]);
    if (status >= 0) status = probe(dip, path, low + DMB_GOLDEN * (high - low), &inner[1]);
    for (int k = 0; k < DMB_DIP_SECTIONS && status >= 0; k++) {
        const int right = inner[1].value < inner[0].value;
        if (right) {
            low = inner[0].arc;
            inner[0] = inner[1];
            status = probe(dip, path, low + DMB_GOLDEN * (high - low), &inner[1]);
        } else {
            high = inner[1].arc;
            inner[1] = inner[0];
            status = probe(dip, path, high - DMB_GOLDEN * (high - low), &inner[0]);
        }
    }
    *least = inner[inner[1].value < inner[0].value];
    return status;
}

static void step_to(dmb_dip *dip, dmb_dip_point next)
{
    dip->before = dip->last;
    dip->last = next;
    dip->most = fmax(dip->most, next.value);
    dip->points++;
}

/* Eigenvalues that cannot be found are no failure of the analysis: no minimum is looked for from there on. */
static int32_t value_here(dmb_dip *dip, dmb_path *path, double *value)
{
    const int32_t status = dip->off ? DMB_OK : dmb_stability_softest(path->work, value, dip->shape);
    if (status < 0 && dmb_is_final(status)) return status;
    if (status < 0 || !(*value > 0.0)) dip->off = 1;
    return DMB_OK;
}

int32_t dmb_dip_begin(dmb_dip *dip, dmb_path *path)
{
    dmb_dip_point point = {0.0, 0.0, path->last.factor};
    const int32_t status = value_here(dip, path, &point.value);
    if (status >= 0) step_to(dip, point);
    return status;
}

static int is_minimum(const dmb_dip *dip, double next)
{
    const double rise = DMB_DIP_RISE * dip->last.value;
    return dip->points > 1 && dip->before.value > dip->last.value + rise && next > dip->last.value + rise &&
           dip->last.value < DMB_DIP_SHALLOW * dip->most;
}

int32_t dmb_dip_look(dmb_dip *dip, dmb_path *path, double arc)
{
    dmb_dip_point next = {path->last.arc + arc, 0.0, path->next.factor}, least;
    int32_t status = value_here(dip, path, &next.value);
    if (status < 0 || dip->off) return status;
    if (!is_minimum(dip, next.value)) {
        step_to(dip, next);
        return 0;
    }
    status = close_in(dip, path, dip->before.arc - dip->last.arc, arc, &least);
    if (status < 0 && dmb_is_final(status)) return status;
    if (status < 0) { /* lost between contacts that open and close: the point itself */
        least = dip->last;
        least.arc = 0.0;
    }
    const int found = least.value < DMB_DIP_DEEP * dip->most;
    dip->depth = 1.0 - least.value / dip->most;
    status = probe(dip, path, found ? least.arc : arc, &least);
    if (!found) step_to(dip, next);
    return status < 0 ? status : found;
}

/* ---- Comparison with the closed form ----------------------------------------------------------------------------- */

enum { STATIONS = 64 };

static double largest_share(const dmb_sim *at, dmb_id string)
{
    static const int32_t quantity[1] = {DMB_PROFILE_SINUSOIDAL_SHARE};
    double values[STATIONS], most = (double)NAN;
    dmb_profile profile = dmb_profile_default();
    profile.string = string;
    profile.station_count = STATIONS;
    profile.quantities = quantity;
    profile.quantity_count = 1;
    profile.values = values;
    if (dmb_query_profile(at, &profile) < 0) return most;
    for (int i = 0; i < STATIONS; i++) most = fmax(most, values[i]); /* fmax leaves NaN out */
    return most;
}

double dmb_dip_sinusoidal_share(dmb_sim *at)
{
    double most = (double)NAN;
    for (uint32_t i = 0; i < at->scene->string_count; i++)
        most = fmax(most, largest_share(at, dmb_model_id(at->model, DMB_PART_STRING, i)));
    return most;
}
