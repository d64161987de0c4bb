/* Severity over speed, straight between the points of the curves, and the bands in which their sum is above a
 * threshold. */
#include "analysis/response/response.h"

#include <math.h>

#include "base/sized_struct.h"
#include "math/real.h"

DMB_DEFINE_INIT(dmb_speed_band, 56, {.severity = 0.0})

/* Last point at or below the speed, but for the last of all. */
static uint32_t place_of(const dmb_speeds_curve *curve, double speed)
{
    uint32_t low = 0, high = curve->count - 1;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (curve->speed[middle] <= speed)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Severity on the straight line between two points of a curve; outside of the curve the value of its end. The output is
 * that of the nearer point. */
static double value_at(const dmb_speeds_curve *curve, double speed, uint32_t *output)
{
    const uint32_t i = place_of(curve, speed);
    const double width = curve->speed[i + 1] - curve->speed[i];
    const double x = fmin(fmax((speed - curve->speed[i]) / width, 0.0), 1.0);
    *output = curve->output[x < 0.5 ? i : i + 1];
    return (1.0 - x) * curve->severity[i] + x * curve->severity[i + 1];
}

/* Sum of the severities of all orders (eq:response.severity), as if all peaked at once. Order and output of the largest
 * term are returned with it. */
double dmb_speeds_sum(const dmb_speeds_curve *curves, uint32_t count, double speed, uint32_t *order, uint32_t *output)
{
    double sum = 0.0, most = -1.0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t worst;
        const double value = value_at(curves + k, speed, &worst);
        sum += value;
        if (!(value > most)) continue;
        most = value;
        *order = k;
        *output = worst;
    }
    return sum;
}

enum { DMB_TRUNCATED_LOW = 1, DMB_TRUNCATED_HIGH = 2 }; /* of dmb_speed_band.truncated */

/* ---- Bands ------------------------------------------------------------------------------------------------------- */

typedef struct search {
    const dmb_speeds_curve *curves;
    const dmb_speeds_options *options;
    dmb_speed_band *bands;
    dmb_speed_band open, before; /* the one that is being followed, the last one that was */
    uint32_t count, room;
    int32_t is_open;
} search;

/* Bands are widened by the margin on both sides, but not beyond the range. */
static void begin_band(search *s, double speed)
{
    s->open = dmb_speed_band_default();
    s->open.low = fmax(speed * (1.0 - s->options->margin), s->options->speed_low);
    s->is_open = 1;
}

static void visit(search *s, double speed, double severity, uint32_t order, uint32_t output)
{
    if (!(severity > s->open.severity)) return;
    s->open.severity = severity;
    s->open.speed = speed;
    s->open.order = order;
    s->open.output = output;
    s->open.frequency = s->curves[order].order * speed / DMB_TWO_PI;
}

/* A band that overlaps the one before extends it. */
static void end_band(search *s, double speed)
{
    s->open.high = fmin(speed * (1.0 + s->options->margin), s->options->speed_high);
    s->is_open = 0;
    dmb_speed_band *before = &s->before;
    if (s->count > 0 && before->high >= s->open.low) {
        const double low = before->low, high = fmax(before->high, s->open.high);
        const int32_t truncated = before->truncated | s->open.truncated;
        if (s->open.severity > before->severity) *before = s->open;
        before->low = low;
        before->high = high;
        before->truncated = truncated;
    } else {
        *before = s->open;
        s->count++;
    }
    if (s->count <= s->room) s->bands[s->count - 1] = *before;
}

/* The speed at which the straight line between two speeds meets the threshold. */
static double crossing(const search *s, double a, double at_a, double b, double at_b)
{
    return a + (b - a) * (s->options->threshold - at_a) / (at_b - at_a);
}

/* One pass over the ascending speeds. Severity is straight between them, so a band begins and ends where the line meets
 * the threshold, widened by the margin; at an end of the range it is marked as truncated. */
uint32_t dmb_speeds_bands(const dmb_speeds_curves *all, const dmb_speeds_options *options, dmb_speed_band *bands,
                          uint32_t room, int32_t *truncated)
{
    search s = {.curves = all->curve, .options = options, .bands = bands, .room = room};
    const double *speeds = all->speed;
    const uint32_t points = all->points;
    double last = 0.0;
    *truncated = 0;
    for (uint32_t i = 0; i < points; i++) {
        uint32_t order = 0, output = 0;
        const double severity = dmb_speeds_sum(all->curve, all->count, speeds[i], &order, &output);
        const int32_t above = severity > options->threshold;
        if (above && !s.is_open) {
            begin_band(&s, i == 0 ? speeds[0] : crossing(&s, speeds[i - 1], last, speeds[i], severity));
            s.open.truncated = i == 0 ? DMB_TRUNCATED_LOW : 0;
            *truncated |= s.open.truncated;
        }
        if (above) visit(&s, speeds[i], severity, order, output);
        if (!above && s.is_open) end_band(&s, crossing(&s, speeds[i - 1], last, speeds[i], severity));
        last = severity;
    }
    if (s.is_open) {
        s.open.truncated |= DMB_TRUNCATED_HIGH;
        *truncated |= DMB_TRUNCATED_HIGH;
        end_band(&s, speeds[points - 1]);
    }
    return s.count;
}
