/* Matrices of three rows and rotation vectors, apart from the library's own. */
#include "matrix3.h"

#include <math.h>
#include <string.h>

void matrix_times(const double a[9], const double b[9], double out[9])
{
    double c[9];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            c[3 * i + k] = 0.0;
            for (int l = 0; l < 3; ++l) c[3 * i + k] += a[3 * i + l] * b[3 * l + k];
        }
    memcpy(out, c, sizeof c);
}

void matrix_transpose(const double a[9], double out[9])
{
    double c[9];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) c[3 * i + k] = a[3 * k + i];
    memcpy(out, c, sizeof c);
}

void matrix_apply(const double a[9], const double x[3], double out[3])
{
    double c[3];
    for (int i = 0; i < 3; ++i) c[i] = a[3 * i] * x[0] + a[3 * i + 1] * x[1] + a[3 * i + 2] * x[2];
    memcpy(out, c, sizeof c);
}

void matrix_apply_transposed(const double a[9], const double x[3], double out[3])
{
    double t[9];
    matrix_transpose(a, t);
    matrix_apply(t, x, out);
}

/* Rodrigues */
void rotation_of_vector(const double v[3], double R[9])
{
    const double t = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), half = sin(0.5 * t);
    const double a = t > 0.0 ? sin(t) / t : 1.0, b = t > 0.0 ? 2.0 * half * half / (t * t) : 0.5;
    const double skew[9] = {0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0};
    matrix_times(skew, skew, R);
    for (int i = 0; i < 9; ++i) R[i] = (i % 4 == 0 ? 1.0 : 0.0) + a * skew[i] + b * R[i];
}

/* By the quaternion's largest component, q0 first (Shepperd). */
void vector_of_rotation(const double R[9], double v[3])
{
    const double p[4] = {1.0 + R[0] + R[4] + R[8], 1.0 + R[0] - R[4] - R[8], 1.0 - R[0] + R[4] - R[8],
                         1.0 - R[0] - R[4] + R[8]};
    const double odd[3] = {R[7] - R[5], R[2] - R[6], R[3] - R[1]};
    const double even[3] = {R[5] + R[7], R[2] + R[6], R[1] + R[3]}; /* yz, zx, xy */
    double q[4];
    int m = 0;
    for (int i = 1; i < 4; ++i) m = p[i] > p[m] ? i : m;
    q[m] = 0.5 * sqrt(p[m]);
    for (int i = 1; i < 4 && m == 0; ++i) q[i] = 0.25 * odd[i - 1] / q[0];
    for (int i = 1; i < 4 && m > 0; ++i)
        if (i != m) q[i] = 0.25 * even[6 - i - m - 1] / q[m];
    if (m > 0) q[0] = 0.25 * odd[m - 1] / q[m];
    const double size = sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double angle = 2.0 * atan2(size, fabs(q[0])), f = size > 0.0 ? (q[0] < 0.0 ? -angle : angle) / size : 2.0;
    for (int i = 0; i < 3; ++i) v[i] = f * q[i + 1];
}
