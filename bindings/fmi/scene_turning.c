/* A speed that swings once (or `order` times) a revolution of another time function, as drillmbd/scene/terms.py has it:
 * with w the rate of the other and theta its integral from 0, value  share w sin(order theta),   rate  share (w'
 * sin(order theta) + order w^2 cos(order theta)), integral  share (1 - cos(order theta))/order. */
#include <math.h>

#include "scene_file.h"

/* Rate, value, integral of the smooth step from 0 to 1. */
static void smooth_step(double t, double begin, double end, double out[3])
{
    const double length = end - begin, x = (t - begin) / length;
    out[0] = out[1] = out[2] = 0.0;
    if (x >= 1.0) {
        out[1] = 1.0;
        out[2] = 0.5 * length + (t - end);
    } else if (x > 0.0) {
        out[0] = 6.0 * x * (1.0 - x) / length;
        out[1] = x * x * (3.0 - 2.0 * x);
        out[2] = length * x * x * x * (1.0 - 0.5 * x);
    }
}

static void one_segment(double t, const dmb_segment *term, double out[3])
{
    if (term->kind == DMB_SEGMENT_STEP) {
        const double height = term->h1 - term->h0;
        smooth_step(t, term->x0, term->x1, out);
        out[0] *= height;
        out[1] = term->h0 + height * out[1];
        out[2] = term->h0 * t + height * out[2];
    } else if (term->kind == DMB_SEGMENT_HARMONIC) {
        const double w = term->omega, phase = term->phase;
        const double swing = w != 0.0 ? (cos(phase) - cos(w * t + phase)) / w : sin(phase) * t;
        out[0] = term->h1 * w * cos(w * t + phase);
        out[1] = term->h0 + term->h1 * sin(w * t + phase);
        out[2] = term->h0 * t + term->h1 * swing;
    } else {
        out[0] = 0.0;
        out[1] = term->h0;
        out[2] = term->h0 * t;
    }
}

int32_t scene_turning_value(void *context, double time, double out[3])
{
    const scene_turning *turning = context;
    double sum[3] = {0.0, 0.0, 0.0}, more[3];
    for (uint32_t i = 0; i < turning->segment_count; ++i) {
        one_segment(time, &turning->terms[i], more);
        for (int k = 0; k < 3; ++k) sum[k] += more[k];
    }
    const double share = turning->share, order = turning->order;
    const double sine = sin(order * sum[2]), cosine = cos(order * sum[2]);
    out[0] = share * sum[1] * sine;
    out[1] = share * (sum[0] * sine + order * sum[1] * sum[1] * cosine);
    out[2] = share * (1.0 - cosine) / order;
    return 0;
}
