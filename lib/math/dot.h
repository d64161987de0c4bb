/* Scalar product of long vectors, in eight sums side by side. */
#ifndef DMB_MATH_DOT_H
#define DMB_MATH_DOT_H

#include <stddef.h>

static inline double dmb_dot(size_t n, const double *a, const double *b)
{
    double part[8] = {0.0}, sum = 0.0;
    size_t i = 0;
    for (; i + 8 <= n; i += 8)
        for (size_t k = 0; k < 8; k++) part[k] += a[i + k] * b[i + k];
    for (; i < n; i++) sum += a[i] * b[i];
    for (size_t k = 0; k < 8; k++) sum += part[k];
    return sum;
}

#endif
