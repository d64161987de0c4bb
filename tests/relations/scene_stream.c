/* The random numbers of a scene: splitmix64, begun anew for each topic. */
#include <math.h>

#include "scene_draw.h"

/* splitmix64 */
static uint64_t next_bits(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

stream stream_of(uint64_t seed, uint32_t number, uint32_t topic)
{
    stream t = {seed};
    t.state = next_bits(&t.state) ^ number;
    t.state = next_bits(&t.state) ^ topic;
    t.state = next_bits(&t.state);
    return t;
}

double draw_number(stream *t, double low, double high)
{
    return low + (high - low) * ((double)(next_bits(&t->state) >> 11) * 0x1p-53);
}

double draw_size(stream *t, double low, double high)
{
    return low * pow(high / low, draw_number(t, 0.0, 1.0));
}

uint32_t draw_count(stream *t, uint32_t low, uint32_t high)
{
    return low + (uint32_t)draw_number(t, 0.0, (double)(high - low + 1));
}

int draw_chance(stream *t, double probability)
{
    return draw_number(t, 0.0, 1.0) < probability;
}

void draw_direction(stream *t, double unit[3])
{
    const double z = draw_number(t, -1.0, 1.0), angle = draw_number(t, -PI, PI), r = sqrt(1.0 - z * z);
    unit[0] = r * cos(angle);
    unit[1] = r * sin(angle);
    unit[2] = z;
}
