/* dmb_analysis_modes: options, checks, and what is told of all modes. */
#include "analysis/modes/modes.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/handle.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/copy.h"

DMB_DECLARE_STRUCT(dmb_modes_options)

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
    search->general =
        search->options->kind == DMB_MODES_DAMPED || !(search->modes->info.asymmetry <= DMB_MODES_ASYMMETRY);
}

static int32_t take_options(const dmb_modes_options *given, dmb_modes_options *out, dmb_message *message)
{
    dmb_check check = dmb_check_of(message, "modes options", DMB_NONE);
    (void)dmb_modes_options_init(out, (uint32_t)sizeof *out);
    if (given != NULL) {
        const int32_t status = dmb_modes_options_read(out, given);
        if (status < 0) {
            dmb_message_set(message, "modes options: struct_size is not one this library knows");
            return status;
        }
    }
    dmb_check_choice(&check, "kind", out->kind, DMB_MODES_UNDAMPED, DMB_MODES_DAMPED);
    dmb_check_choice(&check, "select", out->select, DMB_MODES_LOWEST, DMB_MODES_BAND);
    dmb_check_count(&check, "count", out->count, 1, UINT32_MAX - 1);
    dmb_check_within(&check, "band[0]", out->band[0], 0.0, 1e12);
    dmb_check_above_field(&check, "band[1]", out->band[1], "band[0]", out->band[0]);
    dmb_check_within(&check, "band[1]", out->band[1], 0.0, 1e12);
    dmb_check_choice(&check, "contact", out->contact, DMB_CONTACT_AS_IS, DMB_CONTACT_CLOSED);
    dmb_check_choice(&check, "friction", out->friction, 0, 1);
    dmb_check_within(&check, "contact_gap", out->contact_gap, 0.0, 1e6);
    dmb_check_above(&check, "equilibrium_tolerance", out->equilibrium_tolerance, 0.0);
    dmb_check_choice(&check, "axes", out->axes, DMB_MODES_AXES_TURNING, DMB_MODES_AXES_AT_REST);
    dmb_check_within(&check, "spin", out->spin, -1e6, 1e6);
    return check.status;
}

static int32_t check_balance(const dmb_mode_search *search)
{
    const dmb_linear *linear = search->linear;
    const double allowed = search->options->equilibrium_tolerance;
    if (linear->relative_residual <= allowed || (linear->balanced && allowed >= DMB_LINEAR_BALANCED)) return DMB_OK;
    const dmb_owner owner = dmb_owner_of_node(&linear->scene, linear->largest_node);
    dmb_message_set(search->message,
                    "modes: the state is no equilibrium: residual = %g of the forces, must be <= %g; up to %g N at %s",
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

/* The ones asked for, in order, and what is told about all of them. */
static int32_t finish(dmb_mode_search *search)
{
    const dmb_modes_options *options = search->options;
    dmb_modes *modes = search->modes;
    if (options->select == DMB_MODES_BAND) dmb_modes_keep_band(modes, options->band[0], options->band[1]);
    dmb_modes_sort(modes, options->select == DMB_MODES_LOWEST ? options->count : modes->count);
    if (modes->count == 0) {
        dmb_message_set(search->message, "modes options: no mode in band = %g .. %g Hz", options->band[0],
                        options->band[1]);
        return DMB_ERR_VALUE;
    }
    modes->info.count = modes->count;
    dmb_modes_weigh_coordinates(search);
    const int32_t status = dmb_modes_polish(search);
    if (status < 0) return status;
    for (uint32_t k = 0; k < modes->count; k++) {
        modes->info.rigid += modes->rigid[k];
        modes->info.residual = fmax(modes->info.residual, dmb_modes_residual(search, k));
    }
    return dmb_modes_check(search);
}

static int32_t search_modes(dmb_mode_search *search)
{
    int32_t status = check_balance(search);
    if (status >= 0) status = check_count(search);
    if (status < 0) return status;
    measure(search);
    status = dmb_modes_find(search);
    return status < 0 ? status : finish(search);
}

static int32_t analyse(const dmb_sim *sim, const dmb_modes_options *options, double load_growth, dmb_message *message,
                       dmb_modes *modes)
{
    const dmb_linear_options how = {.contact = options->contact,
                                    .no_friction = !options->friction,
                                    .gap = options->contact_gap,
                                    .still = options->axes == DMB_MODES_AXES_AT_REST,
                                    .spin = options->spin,
                                    .load_growth = load_growth};
    const size_t bytes = 10 * (size_t)modes->rows * sizeof(double); /* of work, and the masses of coordinates */
    dmb_mode_search search;
    memset(&search, 0, sizeof search);
    search.options = options;
    search.modes = modes;
    search.message = message;
    int32_t status = dmb_linear_make(sim, &how, &search.linear);
    if (status < 0) return status;
    search.work = dmb_allocate(&modes->allocator, bytes);
    search.coordinate_mass = search.work + 9 * (size_t)modes->rows;
    status = search.work != NULL ? search_modes(&search) : DMB_ERR_NO_MEMORY;
    if (search.rigid != NULL) dmb_modes_forget_rigid(&search);
    dmb_release(&modes->allocator, search.work, bytes);
    dmb_linear_release(&search.linear);
    return status;
}

int32_t dmb_analysis_modes(dmb_sim *sim, const dmb_modes_options *options, dmb_modes **modes)
{
    dmb_modes_options taken;
    if (modes == NULL) return DMB_ERR_NULL;
    *modes = NULL;
    int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    status = take_options(options, &taken, &sim->message);
    if (status >= 0) status = dmb_state_copy_check(sim, "modes");
    if (status >= 0) status = dmb_modes_open(sim, modes);
    if (status >= 0) status = dmb_progress_end(sim, analyse(sim, &taken, 0.0, &sim->message, *modes));
    if (status < 0) dmb_modes_destroy(modes);
    return dmb_sim_leave(sim, status);
}

/* Up to so many coordinates all modes are looked at, which the dense way finds together; of more the lowest ones. */
enum { DMB_GROWTH_ALL = 60, DMB_GROWTH_LOWEST = 24 };

static uint32_t coordinates_of(const dmb_sim *state)
{
    const dmb_scene *scene = state->scene;
    uint32_t count = 0, rank = 0;
    for (uint32_t i = 0; i < scene->row_count; i++) count += scene->solved_row[i] != 0;
    for (uint32_t k = 0; k < scene->cluster_count; k++) rank += state->partition_rank[k];
    return count > rank ? count - rank : 0;
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
    root[0] = -(double)INFINITY;
    root[1] = 0.0;
    for (uint32_t i = 0; status >= 0 && i < modes->count; i++)
        if (!modes->rigid[i] && modes->s[2 * (size_t)i] > root[0])
            memcpy(root, modes->s + 2 * (size_t)i, sizeof(double[2]));
    dmb_modes_destroy(&modes);
    return status;
}
