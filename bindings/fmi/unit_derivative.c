/* Directional derivatives (FMI 2.0, 2.1.9; FMI 3.0, 2.2.11): outputs by inputs at the communication point, time and
 * state held. Nearly all that depends on inputs there is linear in them, so that central differences of the unit's own
 * outputs are exact to rounding. Exceptions are powers of the flow rate and controllers at their limits. At a bound of
 * the input, and where the far side is refused, differences are one-sided. Outputs of the state alone (poses, speeds,
 * contact forces) have 0, and so has all that an input with a rate limit moves later on. */
#include <math.h>
#include <stdlib.h>

#include "unit.h"

#define DERIVATIVE_STEP 1e-4 /* [-] of the input, or of a thousandth of its range where it is small */

typedef struct derivative {
    unit *u;
    const uint32_t *unknowns; /* shape (count) */
    size_t count;             /* [-] of unknowns */
    double *sides;            /* outputs on either side, shape (2, count) */
    double *sum;              /* shape (count) */
    unsigned char *held;      /* snapshot, shape (size) */
    size_t size;              /* [byte] */
} derivative;

static unit_status restore(const derivative *d)
{
    if (dmb_sim_restore(d->u->sim, d->held, d->size) >= 0) return UNIT_OK;
    return unit_tell(d->u, UNIT_ERROR, "derivative failed: the state cannot be set back: %s",
                     dmb_sim_message(d->u->sim));
}

/* Outputs with the input at `value` go to `outputs`, the value that it takes to *taken; refused by the sim: both as
 * now. */
static unit_status outputs_at(const derivative *d, uint32_t input, double value, double *outputs, double *taken)
{
    dmb_input_state state = dmb_input_state_default();
    (void)dmb_sim_set_input(d->u->sim, d->u->inputs[input].input, value);
    if (dmb_sim_get_input(d->u->sim, d->u->inputs[input].input, &state) < 0)
        return unit_tell(d->u, UNIT_ERROR, "derivative failed: %s", dmb_sim_message(d->u->sim));
    *taken = state.value;
    const unit_status status = unit_get(d->u, d->unknowns, d->count, outputs);
    return restore(d) == UNIT_OK ? status : UNIT_ERROR;
}

static double step_of(const dmb_input_info *input, double value)
{
    const double range = input->high - input->low;
    return DERIVATIVE_STEP * fmax(fabs(value), 1e-3 * (isfinite(range) && range > 0.0 ? range : 1.0));
}

/* Adds seed times the derivatives by one input. */
static unit_status add_input(const derivative *d, uint32_t input, double seed)
{
    const dmb_input_info *info = &d->u->inputs[input];
    dmb_input_state now = dmb_input_state_default();
    double *above = d->sides, *below = d->sides + d->count;
    double high, low;
    if (seed == 0.0) return UNIT_OK;
    if (dmb_sim_get_input(d->u->sim, info->input, &now) < 0)
        return unit_tell(d->u, UNIT_ERROR, "derivative failed: %s", dmb_sim_message(d->u->sim));
    const double step = step_of(info, now.value);
    unit_status status = outputs_at(d, input, now.value + step, above, &high);
    if (status == UNIT_OK) status = outputs_at(d, input, now.value - step, below, &low);
    if (status != UNIT_OK) return status;
    if (!(high > low))
        return unit_tell(d->u, UNIT_DISCARD, "derivative refused: input %s = %g %s cannot be moved to either side",
                         info->name, now.value, info->unit);
    for (size_t i = 0; i < d->count; ++i) d->sum[i] += seed * ((above[i] - below[i]) / (high - low));
    return UNIT_OK;
}

static unit_status check(const unit *u, const uint32_t *unknowns, size_t unknown_count, const uint32_t *knowns,
                         size_t known_count, const double *seed)
{
    for (size_t i = 0; i < unknown_count; ++i)
        if (!unit_has_output(u, unknowns[i]))
            return unit_tell(u, UNIT_ERROR, "derivative refused: value reference %u is no output: %d .. + %u",
                             unknowns[i], UNIT_OUTPUTS, u->scene.settings.output_count);
    for (size_t i = 0; i < known_count; ++i) {
        if (!unit_has_input(u, knowns[i]))
            return unit_tell(u, UNIT_ERROR, "derivative refused: value reference %u is no input: %d .. + %u", knowns[i],
                             UNIT_INPUTS, u->input_count);
        const dmb_input_info *input = &u->inputs[knowns[i] - UNIT_INPUTS];
        if (!isfinite(seed[i]))
            return unit_tell(u, UNIT_DISCARD, "derivative refused: seed of input %s = %g, must be finite", input->name,
                             seed[i]);
        if (u->mode <= UNIT_INITIALISING && !unit_input_is_controlled(input))
            return unit_tell(u, UNIT_DISCARD,
                             "derivative refused: parameter %s goes into the state at the start; ask after "
                             "initialization",
                             input->name);
    }
    return UNIT_OK;
}

static unit_status take(derivative *d, const uint32_t *knowns, size_t known_count, const double *seed)
{
    if (!d->sides || !d->sum || !d->held) return unit_tell(d->u, UNIT_ERROR, "derivative failed: no memory");
    if (dmb_sim_snapshot(d->u->sim, d->held, d->size) < 0)
        return unit_tell(d->u, UNIT_ERROR, "derivative failed: %s", dmb_sim_message(d->u->sim));
    unit_status status = UNIT_OK;
    for (size_t i = 0; i < known_count && status == UNIT_OK; ++i)
        status = add_input(d, knowns[i] - UNIT_INPUTS, seed[i]);
    return status;
}

unit_status unit_derivative(unit *u, const uint32_t *unknowns, size_t unknown_count, const uint32_t *knowns,
                            size_t known_count, const double *seed, double *sensitivity)
{
    derivative d = {.u = u, .unknowns = unknowns, .count = unknown_count};
    const unsigned modes = 1u << UNIT_INITIALISING | 1u << UNIT_AT_EVENT | 1u << UNIT_STEPPING;
    unit_status status = unit_require(u, modes, "derivatives");
    if (status != UNIT_OK) return status;
    status = check(u, unknowns, unknown_count, knowns, known_count, seed);
    if (status != UNIT_OK) return status;
    if (unit_prepare(u) != UNIT_OK) return UNIT_ERROR;
    if (dmb_sim_snapshot_size(u->sim, &d.size) < 0)
        return unit_tell(u, UNIT_ERROR, "derivative failed: %s", dmb_sim_message(u->sim));
    d.sides = malloc((2u * unknown_count + 1u) * sizeof *d.sides);
    d.sum = calloc(unknown_count + 1u, sizeof *d.sum);
    d.held = malloc(d.size + 1u);
    status = take(&d, knowns, known_count, seed);
    for (size_t i = 0; i < unknown_count && status == UNIT_OK; ++i) sensitivity[i] = d.sum[i];
    free(d.sides);
    free(d.sum);
    free(d.held);
    return status;
}
