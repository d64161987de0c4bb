#include "model/lump_sum.h"

/* J_node = J_centre + m (|c|^2 I - c c^T), parallel axes */
void dmb_lump_add(dmb_lump *lump, double mass, const double c[3], const double inertia[6])
{
    lump->mass += mass;
    for (int i = 0; i < 3; ++i) lump->moment[i] += mass * c[i];
    lump->inertia[0] += inertia[0] + mass * (c[1] * c[1] + c[2] * c[2]);
    lump->inertia[1] += inertia[1] + mass * (c[0] * c[0] + c[2] * c[2]);
    lump->inertia[2] += inertia[2] + mass * (c[0] * c[0] + c[1] * c[1]);
    lump->inertia[3] += inertia[3] - mass * c[0] * c[1];
    lump->inertia[4] += inertia[4] - mass * c[0] * c[2];
    lump->inertia[5] += inertia[5] - mass * c[1] * c[2];
}

/* The difference of m (|c|^2 I - c c^T) between c = (x, e_y, e_z) and (x, 0, 0): -m e~ e~ and the product with x */
void dmb_lump_shift(dmb_lump *lump, double mass, double x, const double e[2])
{
    lump->moment[1] += mass * e[0];
    lump->moment[2] += mass * e[1];
    lump->inertia[0] += mass * (e[0] * e[0] + e[1] * e[1]);
    lump->inertia[1] += mass * e[1] * e[1];
    lump->inertia[2] += mass * e[0] * e[0];
    lump->inertia[3] -= mass * x * e[0];
    lump->inertia[4] -= mass * x * e[1];
    lump->inertia[5] -= mass * e[0] * e[1];
}
