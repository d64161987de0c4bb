/* Numbers and choices out of the bytes of an input. */
#ifndef DMB_TESTS_RANDOM_BYTES_H
#define DMB_TESTS_RANDOM_BYTES_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* Beyond the end there are zeros. */
typedef struct byte_source {
    const uint8_t *data;
    size_t size, at;
    int backward; /* from the end on */
} byte_source;

static inline uint32_t draw_byte(byte_source *s)
{
    if (s->at >= s->size) return 0;
    const size_t i = s->at++;
    return s->data[s->backward ? s->size - 1 - i : i];
}

/* 0 .. count - 1 */
static inline uint32_t draw_below(byte_source *s, uint32_t count)
{
    return draw_byte(s) % count;
}

/* 0 .. count - 1, now and then one too many */
static inline uint32_t draw_choice(byte_source *s, uint32_t count)
{
    const uint32_t drawn = draw_byte(s);
    return drawn >= 250 ? count : drawn % count;
}

static inline int draw_chance(byte_source *s, uint32_t of_256)
{
    return draw_byte(s) >= 256 - of_256;
}

static inline double draw_number(byte_source *s, double low, double high)
{
    const uint32_t steps = draw_byte(s) << 8 | draw_byte(s);
    return low + (high - low) * steps / 65535.0;
}

/* Evenly spread over the orders of magnitude, low > 0. */
static inline double draw_size(byte_source *s, double low, double high)
{
    return exp(draw_number(s, log(low), log(high)));
}

static inline double draw_nonsense(byte_source *s)
{
    static const double values[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, -1.0,   0.0,  -0.0,
                                    1e300,       -1e300,           4.9e-324,          1e-300, 1e30, 1e9};
    return values[draw_below(s, sizeof values / sizeof values[0])];
}

/* Now and then something else in one of the fields. */
static inline void draw_spoil(byte_source *s, double *fields, size_t count)
{
    if (draw_chance(s, 3)) fields[draw_below(s, (uint32_t)count)] = draw_nonsense(s);
}

#endif
