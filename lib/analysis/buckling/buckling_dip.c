/* Strings that are not perfectly straight have no bifurcation: the equilibria bend into the buckled shape, and the
 * lowest eigenvalue of K x = mu E x, E the lateral displacements of the string, has a minimum above 0 near the factor
 * at which the perfect string would buckle (Koiter 1945). Golden sections of the arc locate it (eq:buckling.dip). */
#include <math.h>
#include <string.h>

#include "analysis/buckling/buckling.h"
#include "base/memory.h"
#include "drillmbd/ask.h"
#include "query/query.h"
#include "sim/access.h"
#include "system/system.h"

/* A minimum counts below the first fraction of the largest value before; below the second one it is located, because
 * the minimum may be lower between the points. */
#define DMB_DIP_DEEP 0.5
#define DMB_DIP_SHALLOW 0.9
/* Fraction of a minimum by which the value must rise before the path ends there; otherwise it may be one of many on a
 * descent. */
#define DMB_DIP_RISE 0.01
#define DMB_DIP_SECTIONS 14
#define DMB_GOLDEN 0.6180339887498949

/* Lowest eigenvalue [N/m] of the trial; negative for unstable states. The factors are overwritten. */
static int32_t softest_of(dmb_dip *dip, dmb_path *path, double *value)
{
    path->search.evaluation.extrapolated = 0;
    int32_t status = dmb_path_evaluate(path, 1);
    if (status < 0) return status;
    dmb_system_iteration_matrix(&path->search.evaluation);
    *value = dip->value;
    status = dmb_softest_find(&dip->softest, path->work, dip->guessed, value, dip->shape);
    dip->guessed = status >= 0;
    dip->value = *value;
    return status;
}

/* Moves next to the point at `arc` from the last one, with its stiffness factored. */
static int32_t go_to(dmb_path *path, double arc)
{
    const int32_t status = dmb_path_correct(path, path->last.tangent, path->last.rate, arc);
    return status < 0 ? status : dmb_path_tangent(path, path->last.tangent);
}

static int32_t probe(dmb_dip *dip, dmb_path *path, double arc, dmb_dip_point *point)
{
    int32_t status = dmb_path_correct(path, path->last.tangent, path->last.rate, arc);
    if (status >= 0) status = softest_of(dip, path, &point->value);
    point->arc = arc;
    point->factor = path->next.factor;
    return status;
}

/* Ends of an interval of arcs from the last point. */
typedef struct ends {
    dmb_dip_point low, high;
} ends;

/* Locates the minimum between the ends by golden sections, arcs from the last point; the ends become its neighbours. */
static int32_t close_in(dmb_dip *dip, dmb_path *path, ends *e, dmb_dip_point *least)
{
    dmb_dip_point inner[2] = {{0}};
    int32_t status = probe(dip, path, e->high.arc - DMB_GOLDEN * (e->high.arc - e->low.arc), &inner[0]);
    if (status >= 0) status = probe(dip, path, e->low.arc + DMB_GOLDEN * (e->high.arc - e->low.arc), &inner[1]);
    for (int k = 0; k < DMB_DIP_SECTIONS && status >= 0; k++) {
        const int right = inner[1].value < inner[0].value;
        if (right) {
            e->low = inner[0];
            inner[0] = inner[1];
            status = probe(dip, path, e->low.arc + DMB_GOLDEN * (e->high.arc - e->low.arc), &inner[1]);
        } else {
            e->high = inner[1];
            inner[1] = inner[0];
            status = probe(dip, path, e->high.arc - DMB_GOLDEN * (e->high.arc - e->low.arc), &inner[0]);
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

/* 1: value found. If eigenvalues cannot be computed, the analysis continues and consecutive points are counted anew. */
static int32_t value_here(dmb_dip *dip, dmb_path *path, double *value)
{
    const int32_t status = softest_of(dip, path, value);
    if (status < 0 && dmb_is_final(status)) return status;
    if (status >= 0 && *value > 0.0) return 1;
    dip->points = 0;
    return 0;
}

int32_t dmb_dip_begin(dmb_dip *dip, dmb_path *path)
{
    const size_t rows = path->work->scene->row_count;
    dmb_dip_point point = {0.0, 0.0, path->last.factor};
    dip->shape = dmb_allocate_array(&path->work->allocator, 2 * rows, sizeof(double));
    if (dip->shape == NULL) return DMB_ERR_NO_MEMORY;
    dip->least_shape = dip->shape + rows;
    int32_t status = dmb_softest_open(path->work, &dip->softest);
    path->next.factor = path->last.factor;
    if (status >= 0) status = value_here(dip, path, &point.value);
    if (status > 0) step_to(dip, point);
    return status < 0 ? status : DMB_OK;
}

void dmb_dip_close(dmb_dip *dip, const dmb_sim *sim)
{
    if (dip->shape != NULL)
        dmb_release(&sim->allocator, dip->shape, 2 * sizeof(double) * dmb_dense_scene(sim->scene)->row_count);
    dmb_softest_close(&dip->softest, sim);
    dmb_state_discard(dip->state);
    dip->shape = dip->least_shape = NULL;
    dip->state = NULL;
}

/* Accepts the trial in dip->state; the path stays at its last point. `spare`: a state that is overwritten. */
static int32_t keep(dmb_dip *dip, dmb_path *path, dmb_sim *spare)
{
    dmb_state_assign(path->work, spare);
    const int32_t status = dmb_path_accept(path);
    if (status < 0) return status;
    const dmb_path_place least = path->last;
    path->last = path->next;
    path->next = least;
    if (dip->state != NULL) dmb_state_assign(path->work, dip->state);
    if (dip->state == NULL) dip->state = dmb_state_copy(path->work);
    if (dip->state == NULL) return DMB_ERR_NO_MEMORY;
    dmb_state_assign(spare, path->work);
    memcpy(dip->least_shape, dip->shape, path->work->scene->row_count * sizeof(double));
    return DMB_OK;
}

/* Locates the minimum; the last point is the lowest of three. If a contact opens or closes the value jumps, and the
 * larger side counts: a string with softer support from there on has not buckled. */
static int32_t look_closely(dmb_dip *dip, dmb_path *path, const dmb_dip_point *next, dmb_sim *spare)
{
    dmb_dip_point least;
    ends e = {dip->before, *next};
    e.low.arc -= dip->last.arc;
    e.high.arc -= dip->last.arc;
    int32_t status = close_in(dip, path, &e, &least);
    if (status < 0 && dmb_is_final(status)) return status;
    if (status < 0) { /* lost between contacts that open and close: the point itself */
        least = e.low = e.high = dip->last;
        least.arc = 0.0;
    }
    if (fmax(e.low.value, e.high.value) < DMB_DIP_DEEP * dip->most) {
        status = probe(dip, path, least.arc, &least);
        least.arc += dip->last.arc;
        dip->depth = 1.0 - least.value / dip->most;
        dip->least = least;
        if (status >= 0) status = keep(dip, path, spare);
        dip->found = status >= 0;
        if (status < 0 && dmb_is_final(status)) return status;
    }
    return go_to(path, next->arc - dip->last.arc);
}

static int is_minimum(const dmb_dip *dip, double next)
{
    return dip->points > 1 && dip->before.value > dip->last.value && next > dip->last.value &&
           dip->last.value < DMB_DIP_SHALLOW * dip->most;
}

/* After a minimum was kept the path continues: it counts as soon as the value has risen by DMB_DIP_RISE (1), and is
 * dropped if the value falls below it. The minimum is searched among three consecutive points, of which the middle one
 * is lowest. */
int32_t dmb_dip_look(dmb_dip *dip, dmb_path *path, double arc, dmb_sim *spare)
{
    dmb_dip_point next = {path->last.arc + arc, 0.0, path->next.factor};
    int32_t status = value_here(dip, path, &next.value);
    if (status <= 0) return status;
    if (dip->found && next.value < dip->least.value) dip->found = 0;
    if (dip->found && next.value > (1.0 + DMB_DIP_RISE) * dip->least.value) return 1;
    status = !dip->found && is_minimum(dip, next.value) ? look_closely(dip, path, &next, spare) : DMB_OK;
    step_to(dip, next);
    return status;
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
    if (dmb_answer_profile(at, &profile) < 0) return most;
    for (int i = 0; i < STATIONS; i++) most = fmax(most, values[i]); /* fmax ignores NaN */
    return most;
}

double dmb_dip_sinusoidal_ratio(dmb_sim *at)
{
    double most = (double)NAN;
    for (uint32_t i = 0; i < at->scene->string_count; i++)
        most = fmax(most, largest_share(at, dmb_model_id(at->model, DMB_PART_STRING, i)));
    return most;
}
