/* Minimum, maximum and mean of outputs over a moving window. Time since the first sample is divided into slots of
 * length/slots. Slots that have left the window are reused, so that memory does not grow. Between samples an output is
 * linear: over an interval h from a to b the integral is h (a + b)/2, and that of its square h (a a + a b + b b)/3. An
 * interval belongs to the slot of its end. */
#include "output/output.h"

#include <math.h>
#include <string.h>

#include "base/failure.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "query/query.h"
#include "sim/access.h"

DMB_DEFINE_INIT(dmb_window_options, 24, {.slots = 100})
DMB_DEFINE_INIT(dmb_window_result, 72, {.samples = 0})

enum { OUTPUTS_MAX = 4096, SLOTS_MIN = 2, SLOTS_MAX = 65536 };
/* Upper bound of slot numbers since the first sample; larger ones are not exact integers. */
#define SLOT_NUMBER_MAX 9e15

/* One output in one slot. */
typedef struct slot_sum {
    double minimum, maximum;
    double integral, square; /* [unit s], [unit2 s] */
    double low;              /* [s] */
    double unused;
} slot_sum;

typedef struct slot {
    double number; /* number since the first sample; -1: empty */
    uint64_t samples;
    double time; /* [s] */
} slot;

typedef struct watched {
    dmb_output output;
    double level;
    double last; /* value of the last sample */
    double next; /* value of the sample that is being recorded */
} watched;

struct dmb_window {
    uint32_t magic;
    uint32_t output_count;
    size_t bytes; /* of this block, which includes all arrays */
    dmb_allocator allocator;
    uint32_t slot_count; /* 1 if there is no length */
    int32_t taken;       /* 1: at least one sample has been recorded */
    double length;       /* [s] */
    double first, last;  /* [s] times of samples */
    watched *outputs;    /* shape (output_count) */
    slot *slots;         /* shape (slot_count) */
    slot_sum *sums;      /* shape (slot_count, output_count) */
};

/* ---- Creation ---------------------------------------------------------------------------------------------------- */

static int32_t check_options(dmb_sim *sim, const dmb_window_options *options, uint32_t output_count)
{
    dmb_check check = dmb_check_of(&sim->message, "window", DMB_NONE);
    dmb_check_count(&check, "output_count", output_count, 1, OUTPUTS_MAX);
    dmb_check_count(&check, "slots", options->slots, SLOTS_MIN, SLOTS_MAX);
    dmb_check_within(&check, "length", options->length, 0.0, 1e15);
    for (uint32_t i = 0; options->levels != NULL && i < output_count && check.status >= 0; i++)
        dmb_check_at_least(&check, "levels", options->levels[i], 0.0);
    return check.status;
}

/* Structs first, each a multiple of 8 bytes. */
static void lay_out(dmb_window *w, const dmb_window_options *options, const dmb_output *outputs)
{
    w->outputs = (watched *)(void *)(w + 1);
    w->slots = (slot *)(void *)(w->outputs + w->output_count);
    w->sums = (slot_sum *)(void *)(w->slots + w->slot_count);
    for (uint32_t i = 0; i < w->output_count; i++) {
        w->outputs[i].output = outputs[i];
        w->outputs[i].level = options->levels != NULL ? options->levels[i] : 0.0;
    }
    for (uint32_t k = 0; k < w->slot_count; k++) w->slots[k].number = -1.0;
}

static size_t bytes_of(uint32_t outputs, uint32_t slots)
{
    return sizeof(dmb_window) + outputs * sizeof(watched) + slots * sizeof(slot) +
           (size_t)slots * outputs * sizeof(slot_sum);
}

static int32_t make(dmb_sim *sim, const dmb_window_options *options, const dmb_output *outputs, uint32_t output_count,
                    dmb_window **out)
{
    const uint32_t slots = options->length > 0.0 ? options->slots : 1;
    const size_t bytes = bytes_of(output_count, slots);
    dmb_window *made = dmb_allocate(&sim->allocator, bytes);
    if (made == NULL) {
        dmb_message_set(&sim->message, "window: no memory for %u outputs and %u slots; ask for fewer", output_count,
                        slots);
        return DMB_ERR_NO_MEMORY;
    }
    made->magic = DMB_HANDLE_WINDOW;
    made->bytes = bytes;
    made->allocator = sim->allocator;
    made->output_count = output_count;
    made->slot_count = slots;
    made->length = options->length;
    lay_out(made, options, outputs);
    *out = made;
    return DMB_OK;
}

int32_t dmb_window_create(dmb_sim *sim, const dmb_window_options *given, const dmb_output *outputs,
                          uint32_t output_count, dmb_window **window)
{
    dmb_window_options options = dmb_window_options_defaults;
    if (window == NULL) return dmb_sim_failed(sim, "window", DMB_ERR_NULL);
    *window = NULL;
    if (sim == NULL || outputs == NULL) return dmb_sim_failed(sim, "window", DMB_ERR_NULL);
    int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    if (given != NULL) status = dmb_window_options_read(&options, given);
    if (status < 0) dmb_message_set(&sim->message, "window: struct_size of the options is not one of this library");
    if (status >= 0) status = check_options(sim, &options, output_count);
    status = dmb_sim_leave(sim, status);
    if (status >= 0) status = dmb_output_check(sim, outputs, output_count);
    if (status < 0) return status;
    status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, make(sim, &options, outputs, output_count, window));
}

void dmb_window_destroy(dmb_window **window)
{
    dmb_window *found;
    if (window == NULL) return;
    found = *window;
    *window = NULL;
    if (!dmb_handle_is(found, DMB_HANDLE_WINDOW)) return;
    const dmb_allocator allocator = found->allocator;
    found->magic = DMB_HANDLE_DEAD;
    dmb_release(&allocator, found, found->bytes);
}

int32_t dmb_window_reset(dmb_window *window)
{
    if (window == NULL) return dmb_failed("window", DMB_ERR_NULL);
    if (!dmb_handle_is(window, DMB_HANDLE_WINDOW)) return dmb_failed("window", DMB_ERR_HANDLE);
    window->taken = 0;
    for (uint32_t k = 0; k < window->slot_count; k++) window->slots[k].number = -1.0;
    return DMB_OK;
}

/* ---- Samples ----------------------------------------------------------------------------------------------------- */

/* Number of the slot that contains a time. Numbers are doubles, because a long run of short slots has more than 2^32;
 * up to SLOT_NUMBER_MAX they are exact, and so is their remainder below. */
static double slot_number(const dmb_window *w, double time)
{
    if (!(w->length > 0.0)) return 0.0;
    return fmin(floor((time - w->first) * w->slot_count / w->length), SLOT_NUMBER_MAX);
}

/* The slot of a number is its remainder: the slot found there is older by a whole number of windows and is emptied.
 * Slots that no sample falls into keep their old number, by which result_of leaves them out. */
static slot *open_slot(dmb_window *w, double number)
{
    const uint32_t place = (uint32_t)fmod(number, w->slot_count);
    slot *at = w->slots + place;
    if (at->number == number) return at;
    memset(w->sums + (size_t)place * w->output_count, 0, w->output_count * sizeof(slot_sum));
    at->number = number;
    at->samples = 0;
    at->time = 0.0;
    return at;
}

static void add_sample(watched *c, double step, int is_first, slot_sum *sum)
{
    const double a = c->last, b = c->next;
    sum->minimum = is_first ? b : fmin(sum->minimum, b);
    sum->maximum = is_first ? b : fmax(sum->maximum, b);
    sum->integral += 0.5 * step * (a + b);
    sum->square += step * (a * a + a * b + b * b) / 3.0;
    if (fabs(b) <= c->level) sum->low += step;
}

/* Reads all outputs before any is recorded, so that an error in one of them changes nothing. */
static int32_t ask_all(dmb_window *w, const dmb_sim *sim, dmb_message *why)
{
    for (uint32_t i = 0; i < w->output_count; i++) {
        int32_t status = dmb_output_value(sim, &w->outputs[i].output, &w->outputs[i].next);
        if (status >= 0 && !isfinite(w->outputs[i].next)) status = DMB_ERR_NOT_FINITE;
        if (status < 0) dmb_output_explain(sim->model, &w->outputs[i].output, i, status, why);
        if (status < 0) return status;
    }
    return DMB_OK;
}

static int32_t take(dmb_window *window, const dmb_sim *sim, dmb_message *why)
{
    int32_t status = dmb_sim_check(sim);
    if (status < 0) return status;
    if (window == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(window, DMB_HANDLE_WINDOW)) return DMB_ERR_HANDLE;
    const double time = dmb_sim_time(sim);
    if (window->taken && time < window->last) {
        dmb_message_set(why,
                        "window: time of the sim = %g s, must be >= %g s, that of the last sample; reset the window "
                        "after a restore",
                        time, window->last);
        return DMB_ERR_ORDER;
    }
    if (window->taken && !(time > window->last)) return DMB_OK;
    status = ask_all(window, sim, why);
    if (status < 0) return status;
    if (!window->taken) window->first = window->last = time;
    const double step = time - window->last;
    slot *at = open_slot(window, slot_number(window, time));
    slot_sum *sums = window->sums + (size_t)(at - window->slots) * window->output_count;
    for (uint32_t i = 0; i < window->output_count; i++) {
        watched *c = window->outputs + i;
        if (!window->taken) c->last = c->next;
        add_sample(c, step, at->samples == 0, sums + i);
        c->last = c->next;
    }
    at->samples++;
    at->time += step;
    window->last = time;
    window->taken = 1;
    return DMB_OK;
}

int32_t dmb_window_take(dmb_window *window, const dmb_sim *sim)
{
    dmb_message why;
    dmb_message_clear(&why);
    const int32_t status = take(window, sim, &why);
    return status < 0 ? dmb_sim_fail(sim, status, "window", why.text) : status;
}

/* ---- Results ----------------------------------------------------------------------------------------------------- */

/* Without any time (a single sample) mean and root mean square are that sample. `index` is the stick-slip severity of
 * eq:drilling.window. */
static void set_means(const slot_sum *total, double last, dmb_window_result *r)
{
    const double range = r->maximum - r->minimum;
    r->mean = r->time > 0.0 ? total->integral / r->time : last;
    r->rms = r->time > 0.0 ? sqrt(total->square / r->time) : fabs(last);
    r->index = range > 0.0 ? range / (2.0 * fabs(r->mean)) : 0.0;
    r->low_share = r->time > 0.0 ? total->low / r->time : 0.0;
}

/* Slots above now - slot_count, the present one included: the window is between length - length/slots and length long,
 * and the last slot is not full. Extremes of a slot that is partly beyond cannot be divided. */
static dmb_window_result result_of(const dmb_window *w, uint32_t output)
{
    const double nan = (double)NAN, now = slot_number(w, w->last);
    dmb_window_result r = {.minimum = nan, .maximum = nan, .mean = nan, .rms = nan, .index = nan, .low_share = nan};
    slot_sum total = {0};
    for (uint32_t k = 0; k < w->slot_count; k++) {
        const slot *at = w->slots + k;
        const slot_sum *sum = w->sums + (size_t)k * w->output_count + output;
        if (at->number < 0.0 || at->number <= now - w->slot_count) continue;
        r.minimum = r.samples == 0 ? sum->minimum : fmin(r.minimum, sum->minimum);
        r.maximum = r.samples == 0 ? sum->maximum : fmax(r.maximum, sum->maximum);
        r.samples += at->samples;
        r.time += at->time;
        total.integral += sum->integral;
        total.square += sum->square;
        total.low += sum->low;
    }
    if (r.samples > 0) set_means(&total, w->outputs[output].last, &r);
    return r;
}

static int32_t check_ask(const dmb_window *window, uint32_t output)
{
    if (window == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(window, DMB_HANDLE_WINDOW)) return DMB_ERR_HANDLE;
    return output < window->output_count ? DMB_OK : DMB_ERR_VALUE;
}

int32_t dmb_window_get(const dmb_window *window, uint32_t output, dmb_window_result *result)
{
    const int32_t status = check_ask(window, output);
    if (result == NULL) return dmb_failed("window", DMB_ERR_NULL);
    if (status < 0) return dmb_failed("window", status);
    const dmb_window_result answer = result_of(window, output);
    return dmb_failed("window", dmb_window_result_write(result, &answer));
}

int32_t dmb_window_value(const dmb_window *window, const dmb_output *output, double *value)
{
    const int32_t status = check_ask(window, output->place.pipe);
    if (status < 0) return status;
    const dmb_window_result r = result_of(window, output->place.pipe);
    const double values[] = {r.minimum, r.maximum, r.mean, r.rms, r.index, r.low_share};
    *value = values[output->quantity - DMB_OUTPUT_WINDOW_MINIMUM];
    return DMB_OK;
}
