/* Surveys of holes that turn back: turns, S, U, spirals and loops that cross themselves, in a random plane each. */
#ifndef DMB_TESTS_RANDOM_HOLE_H
#define DMB_TESTS_RANDOM_HOLE_H

#include <math.h>
#include <stdint.h>

enum { RANDOM_HOLE_SHAPES = 6, RANDOM_HOLE_STATIONS = 400 };

typedef struct random_hole {
    uint32_t stations;
    double survey[RANDOM_HOLE_STATIONS][3]; /* [m, rad, rad] */
    double curvature;                       /* [rad/m] at most */
    double turned;                          /* [rad] in all */
} random_hole;

/* Numbers 0 .. 1 of a seed that is not 0. */
static inline double random_hole_number(uint64_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return (double)(*seed >> 11) * 0x1p-53;
}

/* v turned by an angle about a unit axis. */
static inline void random_hole_turn(const double axis[3], double angle, double v[3])
{
    const double c = cos(angle), s = sin(angle);
    const double along = (axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]) * (1.0 - c);
    const double cross[3] = {axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2],
                             axis[0] * v[1] - axis[1] * v[0]};
    for (int i = 0; i < 3; i++) v[i] = c * v[i] + s * cross[i] + along * axis[i];
}

static inline void random_hole_direction(uint64_t *seed, double v[3])
{
    const double z = 2.0 * random_hole_number(seed) - 1.0, a = 6.283185307179586 * random_hole_number(seed);
    v[0] = sqrt(1.0 - z * z) * cos(a);
    v[1] = sqrt(1.0 - z * z) * sin(a);
    v[2] = z;
}

/* Station at a depth that looks along t (z up; the azimuth turns from +x towards +y here, whichever way it is counted:
 * the other way makes the mirrored hole). */
static inline void random_hole_add(random_hole *h, double depth, const double t[3])
{
    double *row = h->survey[h->stations++];
    row[0] = depth;
    row[1] = acos(fmax(-1.0, fmin(1.0, -t[2])));
    row[2] = hypot(t[0], t[1]) > 1e-12 ? atan2(t[1], t[0]) : 0.0;
}

/* shape 0: one turn of up to 720 deg; 1: S; 2: U; 3: spiral (a turn whose plane tilts); 4: a loop of 300 to 400 deg
 * that crosses or passes its own beginning; 5: a wandering hole. Doglegs of 2 to 15 deg per 30 m, stations every 10 m,
 * after a straight beginning of 30 m. */
static inline void random_hole_draw(uint64_t seed, int shape, random_hole *h)
{
    const double pi = 3.14159265358979323846;
    const double rate = (2.0 + 13.0 * random_hole_number(&seed)) * pi / 180.0 / 30.0 * 10.0; /* [rad] a station */
    const double most = shape == 2   ? pi
                        : shape == 4 ? (300.0 + 100.0 * random_hole_number(&seed)) * pi / 180.0
                                     : 4.0 * pi * random_hole_number(&seed);
    double t[3], axis[3], tilt[3], sign = 1.0, since = 0.0, depth = 0.0;
    h->stations = 0;
    h->turned = 0.0;
    h->curvature = rate / 10.0;
    random_hole_direction(&seed, t);
    random_hole_direction(&seed, axis);
    random_hole_direction(&seed, tilt);
    if (shape != 3) { /* the axis across the hole: a plane curve */
        const double d = axis[0] * t[0] + axis[1] * t[1] + axis[2] * t[2];
        double length = 0.0;
        for (int i = 0; i < 3; i++) axis[i] -= d * t[i], length += axis[i] * axis[i];
        for (int i = 0; i < 3; i++) axis[i] /= sqrt(length);
    }
    random_hole_add(h, depth, t);
    random_hole_add(h, depth = 30.0, t);
    while (h->turned < most && h->stations < RANDOM_HOLE_STATIONS - 1) {
        if (shape == 1 && since > 0.4 * most) sign = -sign, since = 0.0;
        if (shape == 5) random_hole_turn(tilt, 0.1, axis);
        random_hole_turn(axis, sign * rate, t);
        random_hole_add(h, depth += 10.0, t);
        h->turned += rate;
        since += rate;
    }
    random_hole_add(h, depth + 120.0, t);
}

#endif
