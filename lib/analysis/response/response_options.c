/* Options of frequency responses and stepped sines with the conditions between fields, frequencies of the grid, and the
 * fields of excitations that do not depend on the scene. */
#include "analysis/response/response.h"

#include <math.h>
#include <string.h>

#include "base/sized_struct.h"
#include "base/value_check.h"
#include "drillmbd/ask.h"
#include "model/field_check.h"

DMB_DEFINE_INIT(dmb_excitation, 56, {.kind = DMB_EXCITATION_FORCE, .amplitude = 1.0})

DMB_DEFINE_INIT(dmb_stepped_sine_report, 48, {.settled = 0})

/* ---- Options ----------------------------------------------------------------------------------------------------- */

static void check_band(dmb_check *check, const dmb_response_options *o)
{
    dmb_check_at_least_field(check, "frequency_high", o->frequency_high, "frequency_low", o->frequency_low);
    if (check->status < 0) return;
    if (o->logarithmic) dmb_check_above(check, "frequency_low", o->frequency_low, 0.0);
    if (o->frequency_high == o->frequency_low) dmb_check_count(check, "points", o->points, 1, 1);
    if (o->frequency_high > o->frequency_low && o->points < 2)
        dmb_check_fail(check, DMB_ERR_VALUE, "points", o->points, "2 .. 1000000 of a band");
}

static void check_list(dmb_check *check, const dmb_response_options *o)
{
    for (uint32_t i = 0; i < o->points && check->status == DMB_OK; i++) {
        dmb_check_within(check, "frequencies", o->frequencies[i], 0.0, DMB_FREQUENCY_MAX);
        if (i > 0)
            dmb_check_above_field(check, "frequencies", o->frequencies[i], "the one before", o->frequencies[i - 1]);
    }
}

int32_t dmb_response_options_get(const dmb_response_options *given, dmb_message *message, dmb_response_options *out)
{
    dmb_check check = dmb_check_of(message, "response options", DMB_NONE);
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_response_options), given, out);
    if (check.status == DMB_OK && out->frequencies != NULL)
        check_list(&check, out);
    else
        check_band(&check, out);
    return check.status;
}

int32_t dmb_stepped_sine_options_get(const dmb_stepped_sine_options *given, double frequency, dmb_message *message,
                                     dmb_stepped_sine_options *out)
{
    dmb_check check = dmb_check_of(message, "sine options", DMB_NONE);
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_stepped_sine_options), given, out);
    dmb_check_within(&check, "frequency", frequency, 1e-9, DMB_FREQUENCY_MAX);
    if (check.status == DMB_OK && out->harmonics > out->steps_per_period / 8)
        dmb_check_fail(&check, DMB_ERR_VALUE, "harmonics", out->harmonics, "<= steps_per_period/8");
    return check.status;
}

/* The ends of the band are exact; in between steps are equal, or equal in ratio. */
double dmb_response_grid(const dmb_response_options *o, uint32_t i)
{
    if (o->frequencies != NULL) return o->frequencies[i];
    if (i == 0) return o->frequency_low;
    if (i == o->points - 1) return o->frequency_high;
    const double x = (double)i / (o->points - 1);
    if (o->logarithmic) return o->frequency_low * pow(o->frequency_high / o->frequency_low, x);
    return o->frequency_low + x * (o->frequency_high - o->frequency_low);
}

/* ---- Excitations ------------------------------------------------------------------------------------------------- */

/* Arrays of sized structs have the stride of their first item; all must be of that size. */
static const void *item_of(const void *items, uint32_t stride, uint32_t i, uint32_t *size)
{
    const unsigned char *item = (const unsigned char *)items + (size_t)stride * i;
    memcpy(size, item, sizeof *size);
    return item;
}

int32_t dmb_input_get(const dmb_excitation *excitations, uint32_t i, dmb_message *message, dmb_excitation *out)
{
    dmb_check check = dmb_check_of(message, "excitation", i);
    uint32_t size;
    const void *item = item_of(excitations, excitations->struct_size, i, &size);
    *out = dmb_excitation_default();
    if (size != excitations->struct_size || dmb_excitation_read(out, item) < 0) {
        dmb_message_set(message, "excitation %u: struct_size is not one of this library, or not that of the first", i);
        return DMB_ERR_STRUCT_SIZE;
    }
    const int32_t last = out->kind == DMB_EXCITATION_UNBALANCE ? DMB_RX : DMB_RZ;
    dmb_check_choice(&check, "kind", out->kind, DMB_EXCITATION_DRIVE, DMB_EXCITATION_SETTING);
    dmb_check_choice(&check, "component", out->component, DMB_X, last);
    dmb_check_choice(&check, "frame", out->frame, DMB_FRAME_WORLD, DMB_FRAME_BODY);
    dmb_check_within(&check, "amplitude", out->amplitude, -1e30, 1e30);
    dmb_check_within(&check, "phase", out->phase, -1e9, 1e9);
    return check.status;
}
