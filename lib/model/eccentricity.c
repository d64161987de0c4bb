#include "model/eccentricity.h"

#include <math.h>

#include "math/elementary.h"

bool dmb_pipe_is_eccentric(const dmb_pipe_def *def)
{
    return def->eccentricity > 0.0 || def->eccentricity_spread > 0.0;
}

/* SplitMix64 (Steele, Lea, Flood 2014): a counter through a mixing function, so that draw number k needs no others. */
static uint64_t mix(uint64_t z)
{
    z += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

/* Uniform in -1 .. 1, the 53 upper bits of a draw. */
static double draw(uint32_t seed, uint32_t pipe, uint32_t which)
{
    const uint64_t bits = mix(mix((uint64_t)seed << 32 | pipe) + which);
    return (double)(bits >> 11) * 0x1p-52 - 1.0;
}

void dmb_pipe_offset(const dmb_pipe_def *def, uint32_t pipe, double e[2])
{
    const double distance = fmax(0.0, def->eccentricity + def->eccentricity_spread * draw(def->seed, pipe, 0));
    const double angle = def->eccentricity_angle + def->angle_spread * draw(def->seed, pipe, 1);
    double sine, cosine;
    dmb_sin_cos(angle, &sine, &cosine);
    e[0] = distance * cosine;
    e[1] = distance * sine;
}
