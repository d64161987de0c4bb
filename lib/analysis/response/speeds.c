/* Speeds to avoid: responses at the orders of the rotary speed, compared with limits (eq:response.severity). Order k
 * shakes with w = k Omega, so each order is one frequency response over the band k speed_low .. k speed_high in
 * inertial axes, and its frequencies divided by k are speeds. Then, over the speeds of all curves, severities are added
 * and bands above the threshold are read off (speeds_bands.c).
 *
 * The result is qualified by DMB_NOTE_INCOMPLETE, because "no band" would be an all-clear: orders that move no output,
 * no damping at all, bands cut off by the ends of the range, and effects that a response neglects. A list of bands that
 * is too short is DMB_NOTE_FULL. */
#include "analysis/response/response.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "drillmbd/analyse.h"
#include "model/field_check.h"
#include "sim/access.h"
#include "sim/sim.h"
#include "system/system.h"

DMB_DECLARE_STRUCT(dmb_speed_band)

DMB_DEFINE_INIT(dmb_speeds_report, 24, {.bands = 0})

enum { ORDERS_MAX = 256, BANDS_MAX = 100000 };

typedef struct speeds_run {
    dmb_sim *sim;
    dmb_speeds_options options;
    const dmb_order *orders;
    const dmb_output *outputs;
    const double *limits;
    uint32_t order_count, output_count, points; /* points: of all curves */
    dmb_speeds_curve *curves;                   /* shape (order_count) */
    double *speeds;                             /* of all curves, ascending, shape (points) */
    dmb_speed_band *found;                      /* shape (room) */
    dmb_speeds_report report;
    dmb_message left_out; /* of responses that leave something out */
    uint32_t room, count;
} speeds_run;

/* ---- Checks ------------------------------------------------------------------------------------------------------ */

static int32_t read_options(dmb_sim *sim, const dmb_speeds_options *given, dmb_speeds_options *out)
{
    dmb_check check = dmb_check_of(&sim->message, "speeds options", DMB_NONE);
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_speeds_options), given, out);
    dmb_check_above_field(&check, "speed_high", out->speed_high, "speed_low", out->speed_low);
    dmb_speeds_report unused;
    if (check.status < 0 || out->report == NULL || dmb_speeds_report_read(&unused, out->report) >= 0)
        return check.status;
    dmb_message_set(&sim->message, "speeds options: report's struct_size is not one of this library");
    return DMB_ERR_STRUCT_SIZE;
}

/* Order i of the caller's array, with the item size of the first one. */
static int32_t read_order(const speeds_run *r, uint32_t i, dmb_order *out)
{
    dmb_check check = dmb_check_of(&r->sim->message, "order", i);
    const unsigned char *item = (const unsigned char *)r->orders + (size_t)i * r->orders->struct_size;
    uint32_t size;
    memcpy(&size, item, sizeof size);
    if (size != r->orders->struct_size) {
        dmb_message_set(&r->sim->message, "order %u: struct_size is not that of the first order", i);
        return DMB_ERR_STRUCT_SIZE;
    }
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_order), item, out);
    return check.status;
}

static int32_t check_counts(const speeds_run *r)
{
    dmb_check check = dmb_check_of(&r->sim->message, "speeds", DMB_NONE);
    dmb_check_count(&check, "order_count", r->order_count, 1, ORDERS_MAX);
    dmb_check_count(&check, "output_count", r->output_count, 1, DMB_RESPONSE_INPUTS_MAX);
    dmb_check_count(&check, "band_count", r->room, 1, BANDS_MAX);
    for (uint32_t i = 0; i < r->output_count && check.status == DMB_OK; i++)
        dmb_check_within(&check, "limits", r->limits[i], 1e-30, 1e30);
    return check.status;
}

/* ---- Curves ------------------------------------------------------------------------------------------------------ */

/* speed, severity, and output behind them, in one block */
static size_t curve_bytes(uint32_t points)
{
    return points * (2 * sizeof(double) + sizeof(uint32_t));
}

static int32_t make_curve(const speeds_run *r, dmb_speeds_curve *curve, uint32_t points)
{
    double *block = dmb_allocate(&r->sim->allocator, curve_bytes(points));
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    curve->count = points;
    curve->speed = block;
    curve->severity = block + points;
    curve->output = (uint32_t *)(void *)(curve->severity + points);
    return DMB_OK;
}

/* Largest of the outputs over their limits, one after the other: the maximum over o in eq:response.severity. The sum
 * over orders follows in dmb_speeds_sum, because amplitudes of different frequencies may add and do at some instant. */
static int32_t read_curve(const speeds_run *r, const dmb_response *response, const dmb_order *order,
                          dmb_speeds_curve *curve)
{
    const size_t bytes = 2 * (size_t)curve->count * sizeof(double);
    double *values = dmb_allocate(&r->sim->allocator, bytes);
    if (values == NULL) return DMB_ERR_NO_MEMORY;
    (void)dmb_response_frequencies(response, curve->speed);
    for (uint32_t i = 0; i < curve->count; i++) curve->speed[i] *= DMB_TWO_PI / order->order;
    for (uint32_t k = 0; k < r->output_count; k++) {
        (void)dmb_response_transfer(response, DMB_COMBINED, k, values);
        for (uint32_t i = 0; i < curve->count; i++) {
            const double severity = hypot(values[2 * (size_t)i], values[2 * (size_t)i + 1]) / r->limits[k];
            if (k > 0 && !(severity > curve->severity[i])) continue;
            curve->severity[i] = severity;
            curve->output[i] = k;
        }
    }
    dmb_release(&r->sim->allocator, values, bytes);
    return DMB_OK;
}

/* Axes at rest: an order counts per revolution seen from outside, as an unbalance (order 1) or the blades of a bit do;
 * in axes that turn its frequency would be shifted by the speed itself, which differs from point to point. */
static dmb_response_options response_options(const speeds_run *r, double order)
{
    dmb_response_options options = dmb_response_options_default();
    options.points = r->options.points;
    options.frequency_low = order * r->options.speed_low / DMB_TWO_PI;
    options.frequency_high = order * r->options.speed_high / DMB_TWO_PI;
    options.refinement = r->options.refinement;
    options.structural_damping = r->options.structural_damping;
    options.equilibrium_tolerance = r->options.equilibrium_tolerance;
    options.contact = r->options.contact;
    options.friction = r->options.friction;
    options.contact_gap = r->options.contact_gap;
    options.axes = DMB_RESPONSE_AXES_AT_REST;
    options.spin = r->options.spin;
    return options;
}

/* Progress of the nested response is a part of that of this call. */
static int32_t follow_order(speeds_run *r, uint32_t k)
{
    dmb_order order;
    dmb_response *response = NULL;
    uint32_t shape[3] = {0};
    int32_t status = read_order(r, k, &order);
    if (status < 0) return status;
    const dmb_response_options options = response_options(r, order.order);
    dmb_sim_hand_on(r->sim, (double)k / r->order_count, (k + 1.0) / r->order_count);
    status = dmb_analysis_response(r->sim, &options, &order.excitation, 1, r->outputs, r->output_count, &response);
    dmb_sim_resume(r->sim);
    if (status < 0) return status;
    if (status == DMB_NOTE_INCOMPLETE) r->left_out = r->sim->message;
    if (response->undamped) r->report.undamped = 1;
    (void)dmb_response_dimensions(response, shape);
    r->curves[k].order = order.order;
    status = make_curve(r, r->curves + k, shape[0]);
    if (status >= 0) status = read_curve(r, response, &order, r->curves + k);
    dmb_response_destroy(&response);
    return status;
}

/* The curve whose next point comes first, the points of each being taken in turn. */
static dmb_speeds_curve *first_of(const speeds_run *r)
{
    dmb_speeds_curve *first = NULL;
    for (uint32_t k = 0; k < r->order_count; k++) {
        dmb_speeds_curve *curve = r->curves + k;
        if (curve->taken == curve->count) continue;
        if (first == NULL || curve->speed[curve->taken] < first->speed[first->taken]) first = curve;
    }
    return first;
}

/* Merges the ascending speeds of all curves: refinement has placed points of each order at its own peaks. */
static int32_t gather_speeds(speeds_run *r)
{
    for (uint32_t k = 0; k < r->order_count; k++) r->points += r->curves[k].count;
    r->speeds = dmb_allocate_array(&r->sim->allocator, r->points, sizeof(double));
    if (r->speeds == NULL) return DMB_ERR_NO_MEMORY;
    for (uint32_t i = 0; i < r->points; i++) {
        dmb_speeds_curve *curve = first_of(r);
        r->speeds[i] = curve->speed[curve->taken++];
    }
    return DMB_OK;
}

/* ---- Answers ----------------------------------------------------------------------------------------------------- */

static void write_bands(const speeds_run *r, dmb_speed_band *bands)
{
    const uint32_t stride = bands->struct_size;
    for (uint32_t i = 0; i < r->count && i < r->room; i++) {
        unsigned char *to = (unsigned char *)bands + (size_t)stride * i;
        memcpy(to, &stride, sizeof stride);
        (void)dmb_speed_band_write(to, r->found + i);
    }
}

/* Severity over the caller's grid: the largest one of the grid point itself and of all points of the curves that are
 * nearer to it than to other grid points, so that no peak between two grid points is lost. */
static void write_severity(const speeds_run *r, double *severity)
{
    const double low = r->options.speed_low, last = r->options.points - 1;
    const double step = (r->options.speed_high - low) / last;
    uint32_t order, output;
    for (uint32_t i = 0; i < r->options.points; i++)
        severity[i] = dmb_speeds_sum(r->curves, r->order_count, low + i * step, &order, &output);
    for (uint32_t i = 0; i < r->points; i++) {
        double *to = severity + (size_t)fmin(fmax(floor((r->speeds[i] - low) / step + 0.5), 0.0), last);
        *to = fmax(*to, dmb_speeds_sum(r->curves, r->order_count, r->speeds[i], &order, &output));
    }
}

static int32_t find_bands(speeds_run *r)
{
    int32_t status = DMB_OK;
    r->curves = dmb_allocate_array(&r->sim->allocator, r->order_count, sizeof *r->curves);
    r->found = dmb_allocate_array(&r->sim->allocator, r->room, sizeof *r->found);
    if (r->curves == NULL || r->found == NULL) return DMB_ERR_NO_MEMORY;
    for (uint32_t k = 0; k < r->order_count && status >= 0; k++) status = follow_order(r, k);
    if (status >= 0) status = gather_speeds(r);
    if (status < 0) return status;
    const dmb_speeds_curves all = {r->curves, r->order_count, r->points, r->speeds};
    r->count = dmb_speeds_bands(&all, &r->options, r->found, r->room, &r->report.truncated);
    return DMB_OK;
}

/* ---- Limits of the answer ---------------------------------------------------------------------------------------- */

static int is_silent(const dmb_speeds_curve *curve)
{
    for (uint32_t i = 0; i < curve->count; i++)
        if (curve->severity[i] > 0.0) return 0;
    return 1;
}

/* An order without an answer at any speed has nothing that shakes, or outputs that stand still. */
static uint32_t count_silent(speeds_run *r)
{
    uint32_t first = 0;
    for (uint32_t k = r->order_count; k-- > 0;) {
        if (!is_silent(r->curves + k)) continue;
        r->report.silent_orders++;
        first = k;
    }
    return first;
}

/* A result without a note claims that all dangerous speeds are in its bands; each reason why that may be wrong becomes
 * part of the message. */
static int32_t judge(speeds_run *r)
{
    static const char *const ends[] = {"", "speed_low", "speed_high", "both speed_low and speed_high"};
    const uint32_t silent = count_silent(r);
    dmb_message order, damping, cut;
    dmb_message_clear(&order);
    dmb_message_clear(&damping);
    dmb_message_clear(&cut);
    r->report.bands = r->count;
    if (r->report.silent_orders == 0 && !r->report.undamped && r->report.truncated == 0 && r->left_out.text[0] == 0)
        return DMB_OK;
    if (r->report.silent_orders > 0)
        dmb_message_set(&order, " order %u (%g) moves no output: look at its amplitude and place;", silent,
                        r->curves[silent].order);
    if (r->report.undamped)
        dmb_message_set(&damping, " nothing damps, heights at resonances mean nothing: give damping;");
    if (r->report.truncated != 0)
        dmb_message_set(&cut, " bands continue beyond %s of %g .. %g rad/s: widen the range;",
                        ends[r->report.truncated], r->options.speed_low, r->options.speed_high);
    dmb_message_set(&r->sim->message, "speeds:%s%s%s%s%s", order.text, damping.text, cut.text,
                    r->left_out.text[0] != 0 ? " " : "", r->left_out.text);
    return DMB_NOTE_INCOMPLETE;
}

static void release(speeds_run *r)
{
    const dmb_allocator *allocator = &r->sim->allocator;
    for (uint32_t k = 0; r->curves != NULL && k < r->order_count; k++)
        if (r->curves[k].speed != NULL) dmb_release(allocator, r->curves[k].speed, curve_bytes(r->curves[k].count));
    if (r->curves != NULL) dmb_release(allocator, r->curves, r->order_count * sizeof *r->curves);
    if (r->found != NULL) dmb_release(allocator, r->found, r->room * sizeof *r->found);
    if (r->speeds != NULL) dmb_release(allocator, r->speeds, r->points * sizeof(double));
}

static int32_t analyse(speeds_run *r, const dmb_speeds_options *options, dmb_speed_band *bands, uint32_t *band_count,
                       double *severity)
{
    dmb_speed_band unused;
    if (dmb_speed_band_read(&unused, bands) < 0) return DMB_ERR_STRUCT_SIZE;
    r->room = *band_count;
    int32_t status = read_options(r->sim, options, &r->options);
    if (status >= 0) status = check_counts(r);
    if (status >= 0) status = dmb_state_copy_check(r->sim, "speeds");
    if (status < 0) return status;
    status = find_bands(r);
    if (status == DMB_ERR_NO_MEMORY) dmb_message_set(&r->sim->message, "speeds: no memory");
    if (status >= 0) {
        write_bands(r, bands);
        if (severity != NULL) write_severity(r, severity);
        *band_count = r->count < r->room ? r->count : r->room;
        status = judge(r);
        if (r->options.report != NULL) (void)dmb_speeds_report_write(r->options.report, &r->report);
        if (r->count > r->room) status = DMB_NOTE_FULL;
    }
    release(r);
    return status;
}

int32_t dmb_analysis_speeds(dmb_sim *sim, const dmb_speeds_options *options, const dmb_order *orders,
                            uint32_t order_count, const dmb_output *outputs, const double *limits,
                            uint32_t output_count, dmb_speed_band *bands, uint32_t *band_count, double *severity)
{
    if (sim == NULL || orders == NULL || outputs == NULL || limits == NULL || bands == NULL || band_count == NULL)
        return dmb_sim_failed(sim, "speeds", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    speeds_run r = {.report = dmb_speeds_report_default(),
                    .sim = sim,
                    .orders = orders,
                    .outputs = outputs,
                    .limits = limits,
                    .order_count = order_count,
                    .output_count = output_count};
    return dmb_sim_leave(sim, analyse(&r, options, bands, band_count, severity));
}
