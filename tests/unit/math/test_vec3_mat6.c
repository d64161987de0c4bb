/* Small matrices, adjoint maps, Gauss rules. Checks eq:kinematics.adjoint and eq:motion.gyroscopic. */
#include "math_test.h"
#include "matrices.h"

#include "math/mat6.h"
#include "math/quadrature.h"
#include "math/so3.h"

static void vector_products(void **state)
{
    (void)state;
    random_stream r = {1};
    for (int i = 0; i < 100; i++) {
        double a[3], b[3], c[3], d[3], A[9];
        draw_vector(&r, 3, a);
        draw_vector(&r, 3, b);
        dmb_vec3_cross(a, b, c);
        CHECK_BELOW(dmb_vec3_dot(a, c), 1e-15);
        CHECK_BELOW(dmb_vec3_dot(b, c), 1e-15);
        dmb_skew(a, A);
        dmb_mat3_vec(A, b, d);
        CHECK_BELOW(max_difference(3, c, d), 1e-15);
        dmb_mat3_tvec(A, b, d);
        dmb_vec3_add(c, d, d);
        CHECK_BELOW(dmb_vec3_norm(d), 1e-15);
        dmb_vec3_cross(a, b, a); /* output over an input */
        assert_memory_equal(a, c, sizeof a);
        const double before = dmb_vec3_dot(b, c);
        dmb_vec3_axpy(2.0, c, b);
        CHECK_CLOSE(dmb_vec3_dot(b, c), before + 2.0 * dmb_vec3_norm_squared(c), 1e-14);
    }
}

static void matrix3_products(void **state)
{
    (void)state;
    random_stream r = {2};
    for (int i = 0; i < 100; i++) {
        double A[9], B[9], T[9], C[9], want[9], x[3], y[3], z[3];
        draw_vector(&r, 9, A);
        draw_vector(&r, 9, B);
        draw_vector(&r, 3, x);
        multiply(3, A, B, want);
        dmb_mat3_mul(A, B, C);
        CHECK_BELOW(max_difference(9, C, want), 1e-15);
        dmb_mat3_transpose(A, T);
        dmb_mat3_mul_tn(T, B, C);
        CHECK_BELOW(max_difference(9, C, want), 1e-15);
        dmb_mat3_transpose(B, T);
        dmb_mat3_mul_nt(A, T, C);
        CHECK_BELOW(max_difference(9, C, want), 1e-15);
        dmb_mat3_vec(B, x, y);
        dmb_mat3_vec(A, y, y);
        dmb_mat3_vec(want, x, z);
        CHECK_BELOW(max_difference(3, y, z), 2e-15);
        dmb_mat3_transpose(A, T);
        dmb_mat3_vec(T, x, y);
        dmb_mat3_tvec(A, x, z);
        CHECK_BELOW(max_difference(3, y, z), 1e-15);
        CHECK_CLOSE(determinant_of(want), determinant_of(A) * determinant_of(B), 1e-14);
    }
}

static void matrix6_products(void **state)
{
    (void)state;
    random_stream r = {3};
    for (int i = 0; i < 100; i++) {
        double A[36], B[36], T[36], C[36], want[36], x[6], y[6], z[6];
        draw_vector(&r, 36, A);
        draw_vector(&r, 36, B);
        draw_vector(&r, 6, x);
        multiply(6, A, B, want);
        dmb_mat6_mul(A, B, C);
        CHECK_BELOW(max_difference(36, C, want), 2e-15);
        dmb_mat6_transpose(A, T);
        dmb_mat6_mul_tn(T, B, C);
        CHECK_BELOW(max_difference(36, C, want), 2e-15);
        dmb_mat6_vec(B, x, y);
        dmb_mat6_vec(A, y, y);
        dmb_mat6_vec(want, x, z);
        CHECK_BELOW(max_difference(6, y, z), 5e-15);
        dmb_mat6_transpose(A, T);
        dmb_mat6_vec(T, x, y);
        dmb_mat6_tvec(A, x, x);
        CHECK_BELOW(max_difference(6, y, x), 1e-15);
        dmb_mat6_copy(A, C);
        dmb_mat6_add_outer(2.0, y, z, C);
        dmb_mat6_axpy(-1.0, A, C);
        CHECK_CLOSE(C[6 * 4 + 1], 2.0 * y[4] * z[1], 1e-14);
        dmb_mat6_add(A, B, C);
        CHECK_CLOSE(C[17], A[17] + B[17], 0.0);
    }
}

static void blocks_of_matrix6(void **state)
{
    (void)state;
    double A[36] = {0}, block[9];
    for (int i = 0; i < 9; i++) block[i] = i + 1.0;
    dmb_mat6_set_block(block, 1, 0, A);
    assert_true(A[18] == 1.0 && A[20] == 3.0 && A[32] == 9.0 && A[21] == 0.0);
    dmb_mat6_add_block(2.0, block, 1, 0, A);
    for (int i = 0; i < 9; i++) assert_true(A[18 + 6 * (i / 3) + i % 3] == 3.0 * block[i]);
}

static void adjoint_maps(void **state)
{
    (void)state;
    random_stream r = {4};
    for (int i = 0; i < 200; i++) {
        double O[3], R[9], x[3], v[6], A[36], y[6], z[6];
        draw_rotation(&r, 3.0 * fabs(draw(&r)) + 0.01, O);
        dmb_so3_exp(O, NULL, R);
        draw_vector(&r, 3, x);
        draw_vector(&r, 6, v);
        dmb_adjoint6(R, x, A);
        dmb_mat6_vec(A, v, y);
        dmb_adjoint_apply(R, x, v, z);
        CHECK_BELOW(max_difference(6, y, z), 2e-15);
        dmb_adjoint_inverse_apply(R, x, z, z);
        CHECK_BELOW(max_difference(6, v, z), 3e-15);
    }
}

/* ad(v) = [w~, u~; 0, w~], v = (u; w): the derivative of Ad, [v, y] = ad(v) y */
static void small_adjoint(const double v[6], double out[36])
{
    double W[9], U[9];
    dmb_skew(v + 3, W);
    dmb_skew(v, U);
    dmb_mat6_zero(out);
    dmb_mat6_set_block(W, 0, 0, out);
    dmb_mat6_set_block(U, 0, 1, out);
    dmb_mat6_set_block(W, 1, 1, out);
}

static void small_adjoint_and_coadjoint(void **state)
{
    (void)state;
    random_stream r = {5};
    for (int i = 0; i < 100; i++) {
        double v[6], p[6], y[6], A[36], a[6], b[6];
        draw_vector(&r, 6, v);
        draw_vector(&r, 6, p);
        draw_vector(&r, 6, y);
        small_adjoint(v, A);
        dmb_mat6_vec(A, y, a);
        dmb_ad_apply(v, y, b);
        CHECK_BELOW(max_difference(6, a, b), 1e-15);
        dmb_ad_apply(y, v, a); /* [v, y] = -[y, v] */
        for (int j = 0; j < 6; j++) a[j] = -a[j];
        CHECK_BELOW(max_difference(6, a, b), 1e-15);
        dmb_mat6_tvec(A, p, a);
        dmb_ad_transpose(v, p, b);
        CHECK_BELOW(max_difference(6, a, b), 1e-15);
        CHECK_BELOW(dmb_vec6_dot(v, b), 2e-15); /* the gyroscopic force does no work */
        dmb_ad_transpose_derivative(p, A);
        dmb_mat6_vec(A, v, a);
        CHECK_BELOW(max_difference(6, a, b), 1e-15);
    }
}

static void gauss_rules_integrate_polynomials(void **state)
{
    (void)state;
    assert_null(dmb_gauss(1));
    assert_null(dmb_gauss(6));
    for (int n = 2; n <= 5; n++) {
        const dmb_gauss_rule *rule = dmb_gauss(n);
        assert_int_equal(rule->count, n);
        for (int degree = 0; degree < 2 * n; degree++) {
            double sum = 0.0;
            for (int i = 0; i < n; i++) sum += rule->weight[i] * pow(rule->node[i], degree);
            CHECK_CLOSE(sum, 1.0 / (degree + 1.0), 3e-16);
        }
        for (int i = 0; i < n; i++) CHECK_CLOSE(rule->node[i] + rule->node[n - 1 - i], 1.0, 3e-16);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vector_products),
        cmocka_unit_test(matrix3_products),
        cmocka_unit_test(matrix6_products),
        cmocka_unit_test(blocks_of_matrix6),
        cmocka_unit_test(adjoint_maps),
        cmocka_unit_test(small_adjoint_and_coadjoint),
        cmocka_unit_test(gauss_rules_integrate_polynomials),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
