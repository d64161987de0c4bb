/* Rows one after the other, all alike: as wide as the compiler makes the loops for this processor. */
#ifndef DMB_KERNEL_LANES_ROW_H
#define DMB_KERNEL_LANES_ROW_H

#include <string.h>

#include "kernel/kernels.h"

/* Generalized-alpha from an acceleration that stays (THEORY 4): a0 carried over from the last step, which may have had
 * another length (ratio), a1 from a0 and v', then v1 = v + h ((1 - gamma) a0 + gamma a1) and the increment
 * z = h v + h^2 ((1/2 - beta) a0 + beta a1). Nothing overlaps, so that the loops vectorise. */
static void predict(const dmb_predict_job *job)
{
    const double h = job->step, ratio = job->ratio, a_a0 = job->a_from_a0, a_dv = job->a_from_dv;
    const double v_a0 = job->v_from_a0, v_a1 = job->v_from_a1, z_a0 = job->z_from_a0, z_a1 = job->z_from_a1;
    const double *restrict now_v = job->now_velocity, *restrict now_dv = job->now_acceleration,
                           *restrict now_a = job->now_pseudo_acceleration;
    double *restrict v = job->velocity, *restrict dv = job->acceleration, *restrict a = job->pseudo_acceleration,
                     *restrict z = job->increment;
    for (uint32_t i = 0; i < job->count; i++) {
        const double a0 = now_dv[i] + ratio * (now_a[i] - now_dv[i]), a1 = a_dv * now_dv[i] + a_a0 * a0;
        dv[i] = now_dv[i];
        a[i] = a1;
        v[i] = now_v[i] + v_a0 * a0 + v_a1 * a1;
        z[i] = h * now_v[i] + (z_a0 * a0 + z_a1 * a1);
    }
}

/* z, v, v' and a follow a correction of the increment by constant factors. */
static void correct(const dmb_correct_job *job)
{
    const double to_v = job->to_velocity, to_dv = job->to_acceleration, to_a = job->to_pseudo_acceleration;
    const double *restrict z = job->correction;
    double *restrict v = job->velocity, *restrict dv = job->acceleration, *restrict a = job->pseudo_acceleration,
                     *restrict increment = job->increment;
    for (uint32_t i = 0; i < job->count; i++) {
        increment[i] += z[i];
        v[i] += to_v * z[i];
        dv[i] += to_dv * z[i];
        a[i] += to_a * z[i];
    }
}

/* Rows i .. i + count - 1 into the sums beside them. */
static inline void add_squares(uint32_t count, const double *restrict residual, const double *restrict scale,
                               const uint8_t *restrict solved, double *restrict rest, double *restrict all)
{
    static const uint8_t every[DMB_SQUARES] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    if (memcmp(solved, every, count) == 0) {
        for (uint32_t c = 0; c < count; c++) rest[c] += residual[c] * residual[c];
        for (uint32_t c = 0; c < count; c++) all[c] += scale[c] * scale[c];
        return;
    }
    for (uint32_t c = 0; c < count; c++) {
        rest[c] += solved[c] ? residual[c] * residual[c] : 0.0;
        all[c] += solved[c] ? scale[c] * scale[c] : 0.0;
    }
}

/* Sums of r^2 and of the scales' squares of the solved rows, in DMB_SQUARES sums side by side, whatever the width. */
static void squares(uint32_t count, const double *residual, const double *scale, const uint8_t *solved,
                    double rest[DMB_SQUARES], double all[DMB_SQUARES])
{
    double r[DMB_SQUARES] = {0.0}, s[DMB_SQUARES] = {0.0};
    uint32_t i = 0;
    for (; i + DMB_SQUARES <= count; i += DMB_SQUARES)
        add_squares(DMB_SQUARES, residual + i, scale + i, solved + i, r, s);
    if (i < count) add_squares(count - i, residual + i, scale + i, solved + i, r, s);
    memcpy(rest, r, sizeof r);
    memcpy(all, s, sizeof s);
}

#endif
