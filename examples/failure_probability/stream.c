#include "stream.h"

#include <math.h>

#define TURN 6.283185307179586477

/* The upper and lower half of a product of 128 bits. */
static void multiply(uint64_t a, uint64_t b, uint64_t *high, uint64_t *low)
{
    const uint64_t mask = 0xffffffffu, a0 = a & mask, a1 = a >> 32, b0 = b & mask, b1 = b >> 32;
    const uint64_t middle = a1 * b0 + (a0 * b0 >> 32), other = a0 * b1 + (middle & mask);
    *high = a1 * b1 + (middle >> 32) + (other >> 32);
    *low = a * b;
}

/* Philox 4x64 with ten rounds (Salmon et al. 2011): the block of a counter, which nothing came before. numpy's Philox
 * has the same numbers. */
static void philox(const uint64_t key[2], uint64_t counter, uint64_t x[4])
{
    uint64_t k0 = key[0], k1 = key[1];
    x[0] = counter;
    x[1] = x[2] = x[3] = 0;
    for (int round = 0; round < 10; round++) {
        uint64_t high0, low0, high1, low1;
        multiply(UINT64_C(0xD2E7470EE14C6C93), x[0], &high0, &low0);
        multiply(UINT64_C(0xCA5A826395121157), x[2], &high1, &low1);
        x[0] = high1 ^ x[1] ^ k0;
        x[2] = high0 ^ x[3] ^ k1;
        x[1] = low1;
        x[3] = low0;
        k0 += UINT64_C(0x9E3779B97F4A7C15);
        k1 += UINT64_C(0xBB67AE8584CAA73B);
    }
}

stream stream_of(uint64_t seed, uint64_t number)
{
    return (stream){{seed, number}, 0, {0}, 4};
}

double stream_uniform(stream *s)
{
    if (s->used == 4) {
        philox(s->key, ++s->counter, s->buffer);
        s->used = 0;
    }
    return (double)(s->buffer[s->used++] >> 11) * 0x1p-53;
}

/* Box and Muller. */
double stream_normal(stream *s)
{
    const double u = 1.0 - stream_uniform(s);
    return sqrt(-2.0 * log(u)) * cos(TURN * stream_uniform(s));
}
