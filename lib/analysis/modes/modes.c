/* Modal analysis (dmb_analysis_modes; eq:modes.undamped, eq:modes.damped): options, checks, selection of method, and
 * summary of all modes. Order:
 *
 *   search_modes    checks (equilibrium, constant coefficients, count), dmb_modes_find, refinement, check of every mode
 *   find_weakly_skew   undamped modes of a K that is weakly non-symmetric: those of its symmetric part, refined
 *   dmb_modes_find  1. rigid-body motions (modes_rigid.c), separated if K is symmetric and without damping of them
 *                   2. shift (dmb_modes_choose_shift), unless all modes are requested
 *                   3. LOWEST: modes_lowest.c;  ALL: dense (modes_dense.c);  BAND: find_band
 *   choose_shift    1. no shift: K pinned (modes_free.c) if the motions are separated, or K regular
 *                   2. otherwise a small shift from a first sparse iteration (find_scale)
 *   find_band       1. general and not dense: root strips (find_many_roots), or refusal of too many roots
 *                   2. sparse iteration for 16, 32, ... modes until they cover the band; dense once that is faster
 *                   3. subdivision of the band (modes_band.c) */
#include <float.h>
#include <math.h>
#include <string.h>

#include "analysis/modes/modes.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "math/dense.h"
#include "math/real.h"
#include "model/field_check.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/assemble/actuators.h"
#include "system/system.h"

static void measure(dmb_mode_search *search)
{
    const dmb_linear *linear = search->linear;
    const dmb_block_layout *layout = &linear->scene.layout;
    double most = 0.0;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const double m = dmb_linear_diagonal(linear, &linear->mass, i, c);
            if (m > 0.0) most = fmax(most, linear->stiffness_size[layout->row[i] + c] / m);
        }
    search->noise = DMB_NOISE * most;
    search->modes->info.residual_of_state = linear->relative_residual;
    search->modes->info.coordinates = linear->coordinates;
    search->modes->info.asymmetry = dmb_linear_asymmetry(linear, search->work);
    if (search->options->kind == DMB_MODES_UNDAMPED) dmb_linear_clear(search->linear, &search->linear->damping);
    search->symmetric = search->modes->info.asymmetry <= DMB_MODES_ASYMMETRY;
    search->general = search->options->kind == DMB_MODES_DAMPED || !search->symmetric;
}

static int32_t read_options(const dmb_modes_options *given, dmb_modes_options *out, dmb_message *message)
{
    dmb_check check = dmb_check_of(message, "modes options", DMB_NONE);
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_modes_options), given, out);
    dmb_check_above_field(&check, "band[1]", out->band[1], "band[0]", out->band[0]);
    return check.status;
}

static int32_t check_balance(const dmb_mode_search *search)
{
    const dmb_linear *linear = search->linear;
    const double allowed = search->options->equilibrium_tolerance;
    if (linear->relative_residual <= allowed || (linear->balanced && allowed >= DMB_LINEAR_BALANCED)) return DMB_OK;
    const dmb_owner owner = dmb_owner_of_node(&linear->scene, linear->largest_node);
    dmb_message_set(search->message,
                    "modes: the state is no equilibrium: residual = %g of the forces, must be <= %g; up to %g N at %s, "
                    "call dmb_analysis_static first",
                    linear->relative_residual, allowed, linear->largest_force, owner.text.text);
    return DMB_ERR_VALUE;
}

static int32_t check_count(const dmb_mode_search *search)
{
    const int32_t damped = search->options->kind == DMB_MODES_DAMPED;
    const uint32_t n = search->linear->coordinates, count = search->options->count;
    if (n == 0) {
        dmb_message_set(search->message, "modes: the scene has no coordinates that are free to move");
        return DMB_ERR_VALUE;
    }
    if (search->options->select != DMB_MODES_LOWEST || count <= (damped ? 2 * (uint64_t)n : n)) return DMB_OK;
    dmb_message_set(search->message, "modes options: count = %u, must be <= %u, %s", count, damped ? 2 * n : n,
                    damped ? "twice the number of coordinates: every real root is a mode"
                           : "the number of coordinates");
    return DMB_ERR_VALUE;
}

/* Modes kept beyond the requested ones of a general problem until double roots are joined: number, and relative margin
 * of a band. */
enum { DMB_MODES_BESIDE = 4 };
#define DMB_BESIDE_BAND 1e-2

static void keep_asked(const dmb_mode_search *search, double aside, uint32_t beside)
{
    const dmb_modes_options *options = search->options;
    dmb_modes *modes = search->modes;
    if (options->select == DMB_MODES_BAND)
        dmb_modes_keep_band(modes, (1.0 - aside) * options->band[0], (1.0 + aside) * options->band[1]);
    dmb_modes_sort(modes, options->select == DMB_MODES_LOWEST ? options->count + beside : modes->count);
}

/* Refines the roots, and sorts and selects the requested ones. */
static int32_t refine(dmb_mode_search *search)
{
    keep_asked(search, search->general ? DMB_BESIDE_BAND : 0.0, search->general ? DMB_MODES_BESIDE : 0);
    int32_t status = dmb_modes_refine_shapes(search);
    if (status < 0 || !search->general) return status;
    status = dmb_modes_join(search);
    keep_asked(search, 0.0, 0);
    return status;
}

/* Requested modes, and the summary of all of them. */
static int32_t finish(dmb_mode_search *search)
{
    const dmb_modes_options *options = search->options;
    dmb_modes *modes = search->modes;
    dmb_modes_weigh_coordinates(search);
    int32_t status = refine(search);
    if (status < 0) return status;
    if (modes->count == 0) {
        dmb_message_set(search->message, "modes options: no mode in band = %g .. %g Hz", options->band[0],
                        options->band[1]);
        return DMB_ERR_VALUE;
    }
    status = dmb_modes_check(search);
    modes->info.count = modes->count;
    for (uint32_t k = 0; k < modes->count; k++) {
        modes->info.rigid += modes->rigid[k];
        modes->info.residual = fmax(modes->info.residual, dmb_modes_residual(search, k));
    }
    return status;
}

static int32_t find_and_finish(dmb_mode_search *search)
{
    const int32_t status = dmb_modes_find(search);
    return status < 0 ? status : finish(search);
}

/* Undamped modes by the symmetric part H of K first, whose modes counts confirm; K then refines each of them. The skew
 * part changes s^2 by its square, unless two modes are nearer than it (eq:modes.skew). */
static int32_t find_by_symmetric_part(dmb_mode_search *search)
{
    dmb_linear_matrix K;
    int32_t status = dmb_modes_keep_symmetric(search->linear, &K);
    if (status < 0) return status;
    search->symmetric = 1;
    search->general = 0;
    status = dmb_modes_find(search);
    dmb_modes_put_back(search->linear, &K);
    return status < 0 ? status : finish(search);
}

/* Modes that the refinement may have found twice: relative distance of their sizes, and least cosine of their shapes.
 */
#define DMB_TWIN_NEAR 1e-9
#define DMB_TWIN_COSINE 0.5

/* 1: two modes next to each other in the order have one root and one shape. */
static int has_twins(dmb_mode_search *search)
{
    const dmb_modes *modes = search->modes;
    const size_t rows = modes->rows;
    for (uint32_t k = 1; k < modes->count; k++) {
        const double *x = modes->re + rows * k, size = dmb_modes_size(modes, k);
        if (modes->rigid[k] || size - dmb_modes_size(modes, k - 1) > DMB_TWIN_NEAR * size) continue;
        dmb_linear_multiply(search->linear, &search->linear->mass, x - rows, search->work);
        if (fabs(dmb_dot(rows, x, search->work)) > DMB_TWIN_COSINE) return 1;
    }
    return 0;
}

/* If a mode cannot be refined, as where the skew part joins two: the general iteration. */
static int32_t find_weakly_skew(dmb_mode_search *search)
{
    const dmb_mode_search before = *search;
    const int32_t status = find_by_symmetric_part(search);
    if (dmb_is_final(status) || status == DMB_ERR_NO_MEMORY || (status == DMB_OK && !has_twins(search))) return status;
    if (search->rigid != NULL) dmb_modes_forget_rigid(search);
    *search = before;
    search->modes->count = search->modes->info.rigid = 0;
    search->modes->info.residual = 0.0;
    dmb_message_clear(search->message);
    const int32_t again = dmb_modes_reserve(search->modes, search->modes->capacity + 1, 1);
    return again < 0 ? again : find_and_finish(search);
}

static int32_t search_modes(dmb_mode_search *search)
{
    int32_t status = check_balance(search);
    if (status >= 0) status = dmb_linear_check_coefficients(search->linear, "modes", search->message);
    if (status >= 0) status = check_count(search);
    if (status < 0) return status;
    measure(search);
    const int undamped = search->options->kind == DMB_MODES_UNDAMPED;
    const int weak = !search->symmetric && search->modes->info.asymmetry <= DMB_MODES_WEAK;
    return undamped && weak ? find_weakly_skew(search) : find_and_finish(search);
}

/* Checks that coefficients are constant: modes do not exist if coefficients change with the rotation of parts. */
static int32_t check_turned(const dmb_mode_search *search, const dmb_sim *sim, const dmb_linear_options *how)
{
    const dmb_modes *modes = search->modes;
    dmb_linear_turned turned;
    int32_t status = dmb_linear_turn_on(search->linear, sim, how, &turned);
    if (turned.linear != NULL && search->options->kind == DMB_MODES_UNDAMPED)
        dmb_linear_clear(turned.linear, &turned.linear->damping); /* as for the modes */
    for (uint32_t k = 0; k < modes->count && status >= 0; k++) {
        const size_t at = (size_t)k * modes->rows;
        if (modes->rigid[k]) continue;
        (void)dmb_linear_change_of(&turned, search->linear, modes->s + 2 * (size_t)k, modes->re + at,
                                   modes->im != NULL ? modes->im + at : NULL);
    }
    if (status >= 0)
        status = dmb_linear_check_change(&turned, "modes", "take the other axes, or run in time", search->message);
    dmb_linear_turned_release(&turned, &search->linear->allocator);
    return status;
}

static int32_t analyse(const dmb_sim *sim, const dmb_modes_options *options, double load_growth, dmb_message *message,
                       dmb_modes *modes)
{
    const dmb_linear_options how = {.contact = options->contact,
                                    .no_friction = !options->friction,
                                    .gap = options->contact_gap,
                                    .inertial_axes = options->axes == DMB_MODES_AXES_AT_REST,
                                    .spin = options->spin,
                                    .load_growth = load_growth};
    const size_t bytes = 10 * (size_t)modes->rows * sizeof(double); /* workspace, and the masses of coordinates */
    dmb_mode_search search;
    memset(&search, 0, sizeof search);
    search.options = options;
    search.modes = modes;
    search.message = message;
    int32_t status = dmb_actuators_check_linear(sim, "modes", 0, message);
    if (status >= 0) status = dmb_linear_make(sim, &how, &search.linear);
    if (status < 0) return status;
    search.work = dmb_allocate(&modes->allocator, bytes);
    search.coordinate_mass = search.work + 9 * (size_t)modes->rows;
    status = search.work != NULL ? search_modes(&search) : DMB_ERR_NO_MEMORY;
    const int32_t turned = status < 0 ? status : check_turned(&search, sim, &how);
    if (turned < 0) status = turned; /* the status of a note is kept */
    if (search.rigid != NULL) dmb_modes_forget_rigid(&search);
    dmb_release(&modes->allocator, search.work, bytes);
    dmb_linear_release(&search.linear);
    return status;
}

int32_t dmb_analysis_modes(dmb_sim *sim, const dmb_modes_options *options, dmb_modes **modes)
{
    dmb_modes_options taken;
    if (modes == NULL) return dmb_sim_failed(sim, "modes", DMB_ERR_NULL);
    *modes = NULL;
    int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    status = read_options(options, &taken, &sim->message);
    if (status >= 0) status = dmb_state_copy_check(sim, "modes");
    if (status >= 0) status = dmb_modes_open(sim, modes);
    if (status >= 0) status = dmb_progress_end(sim, analyse(sim, &taken, 0.0, &sim->message, *modes));
    if (status < 0) dmb_modes_destroy(modes);
    return dmb_sim_leave(sim, status);
}

/* Number of coordinates up to which all modes are examined, by the dense method; for more, number of lowest modes. */
enum { DMB_GROWTH_ALL = 60, DMB_GROWTH_LOWEST = 24 };

static uint32_t coordinates_of(const dmb_sim *state)
{
    const dmb_scene *scene = state->scene;
    uint32_t count = 0, rank = 0;
    for (uint32_t i = 0; i < scene->row_count; i++) count += scene->solved_row[i] != 0;
    for (uint32_t k = 0; k < scene->cluster_count; k++) rank += state->partition_rank[k];
    return count - rank;
}

int32_t dmb_modes_growth(const dmb_sim *state, double load_growth, dmb_message *message, double root[2])
{
    const uint32_t n = coordinates_of(state);
    dmb_modes *modes = NULL;
    dmb_modes_options options;
    (void)dmb_modes_options_init(&options, (uint32_t)sizeof options);
    options.kind = DMB_MODES_DAMPED;
    options.select = n <= DMB_GROWTH_ALL ? DMB_MODES_ALL : DMB_MODES_LOWEST;
    options.count = DMB_GROWTH_LOWEST;
    int32_t status = dmb_modes_open(state, &modes);
    if (status >= 0) status = analyse(state, &options, load_growth, message, modes);
    if (status == DMB_NOTE_INCOMPLETE) status = DMB_ERR_NO_CONVERGENCE; /* a growing mode may be missing */
    root[0] = -(double)INFINITY;
    root[1] = 0.0;
    for (uint32_t i = 0; status >= 0 && i < modes->count; i++)
        if (modes->s[2 * (size_t)i] > root[0]) memcpy(root, modes->s + 2 * (size_t)i, sizeof(double[2]));
    dmb_modes_destroy(&modes);
    return status;
}

/* ---- Selection of method ----------------------------------------------------------------------------------------- */

/* Maximum number of modes per iteration; a band with more modes is divided. Damped roots lie in a plane, where a single
 * iteration replaces many chunks. */
enum { DMB_BAND_AT_ONCE = 64, DMB_ROOTS_AT_ONCE = 256, DMB_ROOTS_BY_STRIP = 32 };

/* Separates rigid-body motions if K is symmetric and damping does not act on them. */
static int32_t set_rigid_apart(dmb_mode_search *search)
{
    const int32_t status = dmb_modes_find_rigid(search);
    if (status < 0 || search->rigid_count == 0) return status;
    search->apart =
        search->symmetric && (search->options->kind == DMB_MODES_UNDAMPED || dmb_modes_rigid_undamped(search));
    return DMB_OK;
}

/* 1: the modes found extend beyond the band: the set of modes nearest the shift is complete. */
static int covers_band(const dmb_mode_search *search, double low, double high)
{
    double farthest = 0.0;
    for (uint32_t i = 0; i < search->modes->count; i++) {
        const double size = dmb_modes_size(search->modes, i), square = size * size;
        farthest = fmax(farthest, search->general ? size : fabs(square - search->shift));
    }
    if (search->general) return farthest > DMB_TWO_PI * high;
    const double edge = DMB_TWO_PI * high, other = DMB_TWO_PI * low;
    return farthest > fmax(fabs(edge * edge - search->shift), fabs(other * other - search->shift));
}

/* Many roots, estimated by the undamped modes below the upper edge. Roots in a strip are computed chunk by chunk;
 * others are refused if there are too many. 1: computed; 0: there are few. */
static int32_t find_many_roots(dmb_mode_search *search, double low, double high)
{
    const double edge = DMB_TWO_PI * high;
    double strip[2];
    const int64_t below = dmb_linear_count(search->linear, edge * edge);
    if (below > DMB_ROOTS_BY_STRIP && dmb_modes_find_strip(search, high, strip)) {
        const int32_t status = dmb_modes_band_of_roots(search, low, high);
        return status < 0 ? status : 1;
    }
    if (below > DMB_ROOTS_AT_ONCE) {
        dmb_message_set(search->message,
                        "modes: some %u damped modes lie below band[1] = %g Hz, and friction, joints or strong damping "
                        "let them stand anywhere: must be <= %d; lower it, or take undamped modes",
                        (uint32_t)below, high, (int)DMB_ROOTS_AT_ONCE);
        return DMB_ERR_TOO_LARGE;
    }
    return 0;
}

/* Modes of a band. In a band above 0 the shift is its centre, unless the problem is general: a real shift stays at
 * 0. */
static int32_t find_band(dmb_mode_search *search)
{
    const double low = search->options->band[0], high = search->options->band[1];
    if (low > 0.0 && !search->general) {
        search->shift = 0.5 * DMB_TWO_PI * DMB_TWO_PI * (low * low + high * high);
        search->pinned = 0;
    }
    if (search->general && !dmb_modes_is_dense(search, 16)) {
        const int32_t status = find_many_roots(search, low, high);
        if (status != 0) return status < 0 ? status : DMB_OK;
        const int32_t again = dmb_modes_choose_shift(search); /* the counts have overwritten the factors */
        if (again < 0) return again;
    }
    const uint32_t most = search->general ? DMB_ROOTS_AT_ONCE : DMB_BAND_AT_ONCE;
    for (uint32_t wanted = 16; wanted <= most; wanted *= 2) {
        search->modes->count = 0;
        if (dmb_modes_is_dense(search, wanted)) return dmb_modes_dense(search);
        const int32_t status = dmb_modes_sparse(search, wanted);
        if (status >= 0 && covers_band(search, low, high)) return status;
        if (status < 0 && status != DMB_ERR_NO_CONVERGENCE) return status;
    }
    return (search->general ? dmb_modes_band_of_roots : dmb_modes_band_of_squares)(search, low, high);
}

int32_t dmb_modes_find(dmb_mode_search *search)
{
    const dmb_modes_options *options = search->options;
    int32_t status = set_rigid_apart(search);
    if (status < 0) return status;
    if (options->select != DMB_MODES_ALL) status = dmb_modes_choose_shift(search);
    if (status >= 0)
        status = options->select == DMB_MODES_LOWEST ? dmb_modes_lowest(search)
                 : options->select == DMB_MODES_ALL  ? dmb_modes_dense(search)
                                                     : find_band(search);
    if (status >= 0) status = dmb_modes_put_rigid(search);
    if (status == DMB_ERR_NO_CONVERGENCE) dmb_message_set(search->message, "modes: the eigenvalues did not converge");
    return status;
}
