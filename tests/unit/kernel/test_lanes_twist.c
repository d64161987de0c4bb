/* Kernel that takes vectors to frames twisted about the axes of their nodes: every width gives the bits of nodes one at
 * a time, and vectors stay what they are in space. */
#include <string.h>

#include "check.h"
#include "kernel/kernels.h"
#include "math/so3.h"

enum { NODES = 21, ROWS = 6 * NODES };

typedef struct twist_input {
    double from[4 * NODES], to[4 * NODES], angle[NODES], rows[ROWS];
} twist_input;

static void about_x(double angle, double q[4])
{
    q[0] = cos(0.5 * angle);
    q[1] = sin(0.5 * angle);
    q[2] = q[3] = 0.0;
}

/* from = any; to = from twisted by the angle. */
static void draw_input(uint64_t *seed, twist_input *in)
{
    for (uint32_t i = 0; i < NODES; i++) {
        double q[4];
        for (int c = 0; c < 4; c++) in->from[4 * i + (uint32_t)c] = draw_between(seed, -1.0, 1.0);
        const double *f = in->from + 4 * i;
        const double n = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3]);
        for (uint32_t c = 0; c < 4; c++) in->from[4 * i + c] /= n;
        in->angle[i] = draw_between(seed, -DMB_PI, DMB_PI);
        about_x(in->angle[i], q);
        dmb_quat_mul(in->from + 4 * i, q, in->to + 4 * i);
    }
    for (uint32_t i = 0; i < ROWS; i++) in->rows[i] = draw_between(seed, -1.0, 1.0);
}

static void twist(uint32_t lanes, const twist_input *in, uint32_t first, uint32_t count, double *rows)
{
    const dmb_twist_args args = {count, 0, in->from + 4 * first, in->to + 4 * first, rows + 6 * first};
    dmb_kernels_of(lanes)->twist(&args);
}

static void all_widths_give_the_same_bits(void **state)
{
    uint64_t seed = 5;
    (void)state;
    for (int draw = 0; draw < 100; draw++) {
        twist_input in;
        double alone[ROWS], rows[ROWS];
        draw_input(&seed, &in);
        memcpy(alone, in.rows, sizeof alone);
        for (uint32_t i = 0; i < NODES; i++) twist(1, &in, i, 1, alone);
        for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
            if (!dmb_kernels_of(lanes)) continue;
            memcpy(rows, in.rows, sizeof rows);
            twist(lanes, &in, 0, 8, rows);
            twist(lanes, &in, 8, NODES - 8, rows);
            assert_memory_equal(rows, alone, sizeof rows);
        }
    }
}

/* Where the frames differ by a twist, R_from x_from = R_to x_to. */
static void vectors_stay_in_space(void **state)
{
    uint64_t seed = 6;
    double worst = 0.0;
    twist_input in;
    (void)state;
    draw_input(&seed, &in);
    double rows[ROWS];
    memcpy(rows, in.rows, sizeof rows);
    twist(1, &in, 0, NODES, rows);
    for (uint32_t i = 0; i < 2 * NODES; i++) {
        double before[3], after[3], R[9];
        dmb_quat_to_matrix(in.from + i / 2 * 4, R);
        dmb_mat3_vec(R, in.rows + 3 * i, before);
        dmb_quat_to_matrix(in.to + i / 2 * 4, R);
        dmb_mat3_vec(R, rows + 3 * i, after);
        for (int c = 0; c < 3; c++) worst = fmax(worst, fabs(after[c] - before[c]));
    }
    check_below("difference in space", worst, 1e-14);
}

/* A half turn about an axis across leaves no twist to tell: vectors stay as they are. */
static void half_turns_across(void **state)
{
    const double from[4] = {1.0, 0.0, 0.0, 0.0}, to[4] = {0.0, 0.0, 1.0, 0.0};
    (void)state;
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
        double rows[6] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
        const dmb_twist_args args = {1, 0, from, to, rows};
        if (!dmb_kernels_of(lanes)) continue;
        dmb_kernels_of(lanes)->twist(&args);
        for (int c = 0; c < 6; c++) assert_true(rows[c] == c + 1.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_widths_give_the_same_bits),
                                       cmocka_unit_test(vectors_stay_in_space), cmocka_unit_test(half_turns_across)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
