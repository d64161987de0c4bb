/* The library's own dense eigenproblems and rank against LAPACK, and against their equations: random, badly scaled,
 * defective, repeated, singular and triangular matrices. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "check.h"
#include "math/bridge.h"

enum { MAX = 60, SQUARE = MAX * MAX, WORK = 2 * SQUARE + 20 * MAX };

static double A[SQUARE], B[SQUARE], V[SQUARE], M[SQUARE], L[SQUARE], re[MAX], im[MAX], lre[MAX], lim[MAX], work[WORK];

static void draw(size_t n, uint64_t *seed, int symmetric)
{
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++) A[i + n * j] = draw_between(seed, -1.0, 1.0);
    for (size_t j = 0; j < n && symmetric; j++)
        for (size_t i = 0; i < j; i++) A[i + n * j] = A[j + n * i];
    memcpy(B, A, sizeof A);
}

/* Largest |B x - value x| over |B|, by columns of V; im may be NULL. */
static double residual(size_t n, const double *given, const double *imaginary)
{
    double worst = 0.0, norm = 1e-300;
    for (size_t i = 0; i < n * n; i++) norm = fmax(norm, fabs(B[i]));
    for (size_t k = 0; k < n; k++) {
        const double s = imaginary != NULL ? imaginary[k] : 0.0;
        const int second = s < 0.0;
        const double *x = V + n * (second ? k - 1 : k), *y = x + n;
        for (size_t i = 0; i < n; i++) {
            double p = -given[k] * x[i], q = 0.0;
            for (size_t j = 0; j < n; j++) p += B[i + n * j] * x[j];
            if (s != 0.0) {
                for (size_t j = 0; j < n; j++) q += B[i + n * j] * y[j];
                const double sign = second ? -1.0 : 1.0; /* (x + i sign y), value re + i s */
                p += s * sign * y[i];
                q = sign * (q - given[k] * y[i]) - s * x[i];
            }
            worst = fmax(worst, fmax(fabs(p), fabs(q)) / norm);
        }
    }
    return worst;
}

/* Each of n values has one of the others' close to it. */
static double farthest(size_t n)
{
    double worst = 0.0;
    for (size_t k = 0; k < n; k++) {
        double nearest = 1e300;
        for (size_t i = 0; i < n; i++) nearest = fmin(nearest, hypot(re[k] - lre[i], im[k] - lim[i]));
        worst = fmax(worst, nearest);
    }
    return worst;
}

static void symmetric_as_lapack(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (size_t n = 1; n <= MAX; n += n < 12 ? 1 : 8) {
        draw(n, &seed, 1);
        memcpy(L, A, sizeof A);
        assert_int_equal(dmb_eigen_symmetric(n, L, lre, work), 0);
        assert_int_equal(dmb_dense_symmetric(n, A, re, work), 0);
        memcpy(V, A, sizeof A);
        for (size_t k = 0; k < n; k++) assert_true(fabs(re[k] - lre[k]) < 1e-14 * (double)(n + 4));
        assert_true(residual(n, re, NULL) < 1e-14 * (double)(n + 4));
        for (size_t k = 0; k < n; k++) {
            double one = 0.0;
            for (size_t i = 0; i < n; i++) one += V[i + n * k] * V[i + n * k];
            assert_true(fabs(one - 1.0) < 1e-13);
        }
    }
    double wrong[4] = {1.0, (double)NAN, (double)NAN, 1.0};
    assert_true(dmb_dense_symmetric(2, wrong, re, work) != 0);
}

/* M = C^T C + 0.1; the values and vectors by their equation, and a mass that is none. */
static void pair_as_lapack(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (size_t n = 1; n <= MAX; n += n < 12 ? 1 : 9) {
        static double K[SQUARE], kept[SQUARE];
        draw(n, &seed, 1);
        for (size_t j = 0; j < n; j++)
            for (size_t i = 0; i < n; i++) {
                M[i + n * j] = i == j ? 0.1 : 0.0;
                for (size_t k = 0; k < n; k++) M[i + n * j] += A[i + n * k] * A[j + n * k];
            }
        draw(n, &seed, 1);
        memcpy(K, A, sizeof A);
        memcpy(L, M, sizeof M);
        memcpy(kept, M, sizeof M);
        assert_int_equal(dmb_eigen_pair(n, K, L, lre, work), 0);
        assert_int_equal(dmb_dense_pair(n, A, M, re, work), 0);
        for (size_t k = 0; k < n; k++) assert_true(fabs(re[k] - lre[k]) < 1e-12 * (1.0 + fabs(lre[k])) * (double)n);
        for (size_t k = 0; k < n; k++) {
            double one = 0.0;
            for (size_t i = 0; i < n; i++)
                for (size_t j = 0; j < n; j++) one += A[i + n * k] * kept[i + n * j] * A[j + n * k];
            assert_true(fabs(one - 1.0) < 1e-11);
        }
    }
    double K[4] = {1.0, 0.0, 0.0, 1.0}, none[4] = {1.0, 0.0, 0.0, -1.0};
    assert_int_equal(dmb_dense_pair(2, K, none, re, work), 4); /* as LAPACK: n + the row */
}

static void hold_general(size_t n, double values, double equation)
{
    memcpy(L, B, sizeof B);
    assert_int_equal(dmb_eigen_general(n, L, lre, lim, V, work), 0);
    assert_int_equal(dmb_dense_general(n, A, re, im, V, work), 0);
    assert_true(farthest(n) < values);
    assert_true(residual(n, re, im) < equation);
    for (size_t k = 0; k < n; k++) {
        if (im[k] > 0.0) assert_true(im[k + 1] == -im[k] && re[k + 1] == re[k]);
        if (im[k] < 0.0) assert_true(k > 0 && im[k - 1] == -im[k]);
    }
}

/* D A D^-1 with D of powers of 2, and the places of rows and columns exchanged: the values are those of A. */
static void scaled_beyond_reason(void **state)
{
    (void)state;
    const double a = 0.3, b = -0.7, c = 0.9, d = -0.2, turn = sqrt(-(0.25 * (a - d) * (a - d) + b * c));
    for (int exponent = -1010; exponent <= 1010; exponent += 505) {
        const double given[4] = {a, ldexp(c, exponent), ldexp(b, -exponent), d};
        memcpy(A, given, sizeof given);
        assert_int_equal(dmb_dense_general(2, A, re, im, V, work), 0);
        for (int k = 0; k < 2; k++) {
            if (fabs(re[k] - 0.5 * (a + d)) > 1e-14 || fabs(fabs(im[k]) - turn) > 1e-14)
                fail_msg("2^%d: %.17g %.17g", exponent, re[k], im[k]);
        }
        assert_true(im[0] == -im[1]);
    }
}

/* A row without entries beside a column with some, as a body that nothing holds. */
static void rows_of_zeros(void **state)
{
    (void)state;
    const double given[9] = {0.0, 1.0, 2.0, 0.0, 3.0, 0.0, 0.0, 1.0, -2.0};
    const double wanted[3] = {0.0, 3.0, -2.0};
    memcpy(A, given, sizeof given);
    assert_int_equal(dmb_dense_general(3, A, re, im, V, work), 0);
    for (int k = 0; k < 3; k++) {
        double nearest = 1.0;
        for (int i = 0; i < 3; i++) nearest = fmin(nearest, fabs(wanted[k] - re[i]) + fabs(im[i]));
        assert_true(nearest < 1e-14);
    }
}

static void numbers_that_are_none(void **state)
{
    (void)state;
    const double nothing[4] = {1.0, (double)NAN, (double)NAN, 1.0}, much[4] = {1.0, (double)INFINITY, 1.0, 1.0};
    double K[4] = {1.0, 0.0, 0.0, 1.0}, heavy[4] = {1.0, 0.0, 0.0, (double)INFINITY};
    memcpy(A, nothing, sizeof nothing);
    assert_int_not_equal(dmb_dense_general(2, A, re, im, V, work), 0);
    memcpy(A, much, sizeof much);
    assert_int_not_equal(dmb_dense_general(2, A, re, im, V, work), 0);
    assert_int_equal(dmb_dense_pair(2, K, heavy, re, work), 4);
}

static void general_as_lapack(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (size_t n = 1; n <= MAX; n += n < 14 ? 1 : 7) {
        draw(n, &seed, 0);
        hold_general(n, 1e-11, 1e-13 * (double)(n + 4));
    }
    draw(MAX, &seed, 1); /* all real */
    hold_general(MAX, 1e-12, 1e-12);
    for (size_t k = 0; k < MAX; k++) assert_true(im[k] == 0.0);
}

/* [0 1; -K -C] of a chain of masses, K to 1e12 and masses alike: badly scaled, values in pairs. */
static void state_matrices(void **state)
{
    (void)state;
    const size_t m = 20, n = 40;
    memset(A, 0, sizeof A);
    for (size_t i = 0; i < m; i++) {
        A[i + n * (m + i)] = 1.0;
        A[m + i + n * i] = -2e12;
        if (i > 0) A[m + i + n * (i - 1)] = A[m + i - 1 + n * i] = 1e12;
        A[m + i + n * (m + i)] = -0.3 * (double)(i + 1);
    }
    memcpy(B, A, sizeof A);
    hold_general(n, 1e-6, 1e-9);
    for (size_t k = 0; k < n; k++) assert_true(im[k] != 0.0 && re[k] < 0.0);
}

/* Hessenberg matrices that fall off from their first row to their last, as Arnoldi's do: with rows balanced by sums of
 * absolute values shapes were off by 1e-5 (Watkins, A case where balancing is harmful, 2006). */
static void falling_matrices(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int digits = 1; digits <= 2; digits++) {
        draw(MAX, &seed, 0);
        for (size_t j = 0; j < MAX; j++)
            for (size_t i = 0; i < MAX; i++)
                A[i + MAX * j] *= i > j + 1 ? 0.0 : pow(10.0, -0.1 * digits * (double)(i < j ? i : j));
        memcpy(B, A, sizeof A);
        hold_general(MAX, 1e-9, 1e-12);
    }
}

static void special_matrices(void **state)
{
    (void)state;
    const size_t n = 8;
    memset(A, 0, sizeof A); /* nothing */
    memset(B, 0, sizeof B);
    hold_general(n, 1e-300, 1e-300);
    for (size_t i = 0; i < n; i++) A[i + n * ((i + 1) % n)] = 1.0; /* a cycle: roots of one */
    memcpy(B, A, sizeof A);
    hold_general(n, 1e-13, 1e-13);
    for (size_t k = 0; k < n; k++) assert_true(fabs(hypot(re[k], im[k]) - 1.0) < 1e-14);
    memset(A, 0, sizeof A);
    for (size_t i = 0; i < n; i++) A[i + n * i] = 2.0; /* a Jordan block: one vector, eight times the value */
    for (size_t i = 0; i + 1 < n; i++) A[i + n * (i + 1)] = 1.0;
    memcpy(B, A, sizeof A);
    hold_general(n, 1e-12, 1e-13);
    double wrong[4] = {1.0, (double)INFINITY, 0.0, 1.0};
    assert_true(dmb_dense_general(2, wrong, re, im, V, work) != 0);
}

/* |R| of QR and singular values as LAPACK tells them by the rank of rows. */
static void rank_as_lapack(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int round = 0; round < 40; round++) {
        const uint32_t rows = 1 + (uint32_t)round % 13, columns = 1 + (uint32_t)(7 * round) % 11;
        const size_t least = rows < columns ? rows : columns;
        double given[13 * 11], a[13 * 11], weight[11], s[13], v[11];
        int32_t order[13], own[13];
        dmb_rank found;
        for (uint32_t i = 0; i < rows; i++) {
            double sum = 0.0;
            for (uint32_t j = 0; j < columns; j++) given[i * columns + j] = draw_between(&seed, -1.0, 1.0);
            for (uint32_t j = 0; j < columns; j++) sum += given[i * columns + j] * given[i * columns + j];
            for (uint32_t j = 0; j < columns; j++) given[i * columns + j] /= sqrt(sum);
        }
        for (uint32_t j = 0; j < columns; j++) weight[j] = 1.0;
        if (rows > 3) memcpy(given + 2 * columns, given, columns * sizeof(double)); /* twice the same */
        memcpy(a, given, sizeof a);
        assert_true(dmb_rank_work(rows, columns) < WORK);
        const dmb_weighted_rows of = {.values = given, .rows = rows, .columns = columns, .weight = weight};
        dmb_rank_of_rows(&of, 1e-9, work, order, &found);
        dmb_dense_pivoted_qr(columns, rows, a, own, v);
        uint32_t rank = 0;
        while (rank < least && fabs(a[rank * columns + rank]) > 1e-9) rank++;
        assert_int_equal(rank, found.rank);
        dmb_dense_singular(least, rows, columns, a, s);
        assert_true(fabs(s[0] - found.largest) < 1e-13);
        assert_true(fabs(s[rank - 1] - found.smallest) < 1e-13);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(symmetric_as_lapack), cmocka_unit_test(pair_as_lapack),
                                       cmocka_unit_test(general_as_lapack),   cmocka_unit_test(scaled_beyond_reason),
                                       cmocka_unit_test(rows_of_zeros),       cmocka_unit_test(numbers_that_are_none),
                                       cmocka_unit_test(state_matrices),      cmocka_unit_test(special_matrices),
                                       cmocka_unit_test(falling_matrices),    cmocka_unit_test(rank_as_lapack)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
