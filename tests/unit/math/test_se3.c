/* Poses: exponential and logarithm, tangent operators, their derivatives against central differences. Checks
 * eq:kinematics.exp-pose, eq:kinematics.tangent-pose, eq:kinematics.inverse-tangent-pose, eq:kinematics.reversal,
 * eq:beam.both-ends and eq:beam.stress-derivative. */
#include "math_test.h"
#include "matrices.h"

#include "math/se3.h"

static void draw_pose_vector(random_stream *r, double angle, double h[6])
{
    draw_vector(r, 3, h);
    draw_rotation(r, angle, h + 3);
}

static void negate(int n, const double *a, double *out)
{
    for (int i = 0; i < n; i++) out[i] = -a[i];
}

/* p U~ + q (U~O~ + O~U~) + (O.U)(dp O~ + dq O~^2) in long double */
static void exact_block(const double h[6], const long double k[4], double out[9])
{
    long double U[9], O[9], s = 0.0L;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, l = (i + 2) % 3;
        U[4 * i] = O[4 * i] = 0.0L;
        U[3 * l + j] = (long double)h[i], U[3 * j + l] = -(long double)h[i];
        O[3 * l + j] = (long double)h[3 + i], O[3 * j + l] = -(long double)h[3 + i];
        s += (long double)h[i] * (long double)h[3 + i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            long double mixed = 0.0L, square = 0.0L;
            for (int l = 0; l < 3; l++) {
                mixed += U[3 * i + l] * O[3 * l + j] + O[3 * i + l] * U[3 * l + j];
                square += O[3 * i + l] * O[3 * l + j];
            }
            out[3 * i + j] = (double)(k[0] * U[3 * i + j] + k[1] * mixed + s * (k[2] * O[3 * i + j] + k[3] * square));
        }
}

static void mixed_blocks_are_exact(void **state)
{
    (void)state;
    NEEDS_LONG_DOUBLE();
    random_stream r = {21};
    for (int i = 0; i < 40 * TEST_ANGLE_COUNT; i++) {
        const double t = test_angles[i % TEST_ANGLE_COUNT];
        double h[6], want[9];
        dmb_se3_tangent T;
        draw_pose_vector(&r, t, h);
        const long double O[3] = {(long double)h[3], (long double)h[4], (long double)h[5]};
        const exact_coefficients k = exact_at(O[0] * O[0] + O[1] * O[1] + O[2] * O[2]);
        dmb_se3_tangent_at(h, NULL, &T);
        exact_block(h, (const long double[4]){-k.b, k.a2, -k.db, k.da2}, want);
        CHECK_BELOW(max_difference(9, T.B, want), 1e-15);
        dmb_se3_inverse_tangent_at(h, NULL, &T);
        exact_block(h, (const long double[4]){0.5L, k.c, 0.0L, k.e}, want);
        const double amplified = 1.0 + t * t / (4.0 * DMB_PI * DMB_PI - t * t);
        CHECK_BELOW(max_difference(9, T.B, want), 1e-15 * amplified * fmax(1.0, max_abs(9, want)));
    }
}

static void log_inverts_exp(void **state)
{
    (void)state;
    random_stream r = {22};
    for (int i = 0; i < 40 * TEST_ANGLE_COUNT; i++) {
        const double t = fmin(test_angles[i % TEST_ANGLE_COUNT], DMB_PI - 1e-6);
        double h[6], R[9], Q[9], q[4], x[3], y[3], d[6];
        dmb_so3_inverse_coefficients k, want;
        draw_pose_vector(&r, t, h);
        dmb_se3_exp(h, NULL, R, x);
        dmb_se3_exp_to_quat(h, q, y);
        dmb_quat_to_matrix(q, Q);
        CHECK_BELOW(max_difference(3, x, y), 1e-15);
        CHECK_BELOW(max_difference(9, R, Q), 2e-15);
        dmb_se3_log_from_quat(q, y, &k, d);
        CHECK_BELOW(max_difference(3, d, h), 4e-15);
        CHECK_BELOW(max_difference(3, d + 3, h + 3), 1e-15 * t);
        dmb_so3_inverse_coefficients_at(dmb_vec3_norm_squared(d + 3), &want);
        assert_memory_equal(&k, &want, sizeof k);
        dmb_se3_log(R, x, NULL, d);
        CHECK_BELOW(max_difference(6, d, h), 8e-15);
    }
}

static void exp_of_a_screw(void **state)
{
    (void)state;
    const double h[6] = {0.3, 0.0, 0.0, 1.2, 0.0, 0.0}; /* along and about the same axis */
    const double arc[6] = {2.0, 0.0, 0.0, 0.0, 0.0, 2.0};
    double R[9], x[3];
    dmb_se3_exp(h, NULL, R, x);
    CHECK_CLOSE(x[0], 0.3, 1e-16);
    CHECK_CLOSE(R[4], cos(1.2), 2e-16);
    CHECK_CLOSE(R[7], sin(1.2), 2e-16);
    dmb_se3_exp(arc, NULL, R, x); /* a beam bent to a circle of radius 1 over 2 rad */
    CHECK_CLOSE(x[0], sin(2.0), 3e-16);
    CHECK_CLOSE(x[1], 1.0 - cos(2.0), 3e-16);
}

static void advance_composes(void **state)
{
    (void)state;
    random_stream r = {23};
    for (int i = 0; i < 200; i++) {
        double g[6], h[6], q[4], x[3], R[9], P[9], RP[9], Q[9], y[3], z[3];
        draw_pose_vector(&r, 2.0, g);
        draw_pose_vector(&r, test_angles[i % TEST_ANGLE_COUNT], h);
        dmb_se3_exp_to_quat(g, q, x);
        dmb_se3_advance(q, x, h);
        dmb_se3_exp(g, NULL, R, y);
        dmb_se3_exp(h, NULL, P, z);
        dmb_mat3_mul(R, P, RP);
        dmb_mat3_vec(R, z, z);
        dmb_vec3_add(y, z, y);
        dmb_quat_to_matrix(q, Q);
        CHECK_BELOW(max_difference(9, Q, RP), 2e-15);
        CHECK_BELOW(max_difference(3, x, y), 3e-15);
    }
}

static void tangent_identities(void **state)
{
    (void)state;
    random_stream r = {24};
    for (int i = 0; i < 20 * TEST_ANGLE_COUNT; i++) {
        double h[6], m[6], T[36], Ti[36], P[36], A[36], Q[36], R[9], x[3];
        draw_pose_vector(&r, test_angles[i % TEST_ANGLE_COUNT], h);
        negate(6, h, m);
        tangent_matrix(h, T);
        inverse_tangent_matrix(h, Ti);
        const double scale = 1.0 + max_abs(36, Ti);
        multiply(6, T, Ti, P);
        CHECK_BELOW(identity_error(6, P), 3e-15 * scale * scale);
        dmb_se3_exp(h, NULL, R, x); /* T6(-h) = Ad(exp h) T6(h) */
        dmb_adjoint6(R, x, A);
        multiply(6, A, T, P);
        tangent_matrix(m, Q);
        CHECK_BELOW(max_difference(36, P, Q), 3e-15);
        dmb_se3_exp(m, NULL, R, x); /* T6^-1(-h) = T6^-1(h) Ad(exp(-h)) */
        dmb_adjoint6(R, x, A);
        multiply(6, Ti, A, P);
        inverse_tangent_matrix(m, Q);
        CHECK_BELOW(max_difference(36, P, Q), 3e-15 * scale);
    }
}

static void reversed_operator_is_transposed_blocks(void **state)
{
    (void)state;
    random_stream r = {25};
    for (int i = 0; i < 200; i++) {
        double h[6], m[6];
        dmb_se3_tangent T, back, want;
        draw_pose_vector(&r, 2.5 * fabs(draw(&r)) + 1e-6, h);
        negate(6, h, m);
        dmb_se3_inverse_tangent_at(h, NULL, &T);
        dmb_se3_inverse_tangent_at(m, NULL, &want);
        dmb_se3_tangent_reverse(&T, &back);
        CHECK_BELOW(max_difference(18, back.S, want.S), 1e-15);
        dmb_se3_tangent_at(h, NULL, &T);
        dmb_se3_tangent_at(m, NULL, &want);
        dmb_se3_tangent_reverse(&T, &back);
        CHECK_BELOW(max_difference(9, back.S, want.S), 1e-15);
        CHECK_BELOW(max_difference(9, back.B, want.B), 1e-15);
    }
}

static void block_forms_match_full_matrices(void **state)
{
    (void)state;
    random_stream r = {26};
    for (int i = 0; i < 200; i++) {
        double h[6], m[6], v[6], A[36], M[36], y[6], z[6], kA[36], At[36], C[36], D[36];
        dmb_se3_inverse_tangent T, reverse;
        dmb_se3_rows rows;
        draw_pose_vector(&r, 2.5 * fabs(draw(&r)) + 1e-6, h);
        draw_vector(&r, 6, v);
        negate(6, h, m);
        dmb_se3_inverse_tangent_at(h, NULL, &T);
        inverse_tangent_matrix(h, A);
        inverse_tangent_matrix(m, M);
        dmb_mat6_vec(A, v, y);
        dmb_se3_tangent_apply(&T, v, z);
        CHECK_BELOW(max_difference(6, y, z), 2e-15);
        dmb_mat6_tvec(A, v, y);
        dmb_vec6_copy(v, z);
        dmb_se3_tangent_apply_transpose(&T, z, z);
        CHECK_BELOW(max_difference(6, y, z), 2e-15);
        dmb_mat6_vec(M, v, y);
        dmb_vec6_copy(v, z);
        dmb_se3_tangent_apply_reverse(&T, z, z);
        CHECK_BELOW(max_difference(6, y, z), 2e-15);
        dmb_mat6_tvec(M, v, y);
        dmb_se3_tangent_apply_reverse_transpose(&T, v, z);
        CHECK_BELOW(max_difference(6, y, z), 2e-15);
        draw_vector(&r, 36, kA);
        for (int j = 0; j < 3; j++) kA[18 + j] = 0.0;
        transpose(6, M, At);
        multiply(6, At, kA, C);
        dmb_se3_tangent_reverse(&T, &reverse);
        for (int j = 0; j < 9; j++) {
            rows.U[j] = kA[6 * (j / 3) + j % 3], rows.V[j] = kA[6 * (j / 3) + 3 + j % 3];
            rows.X[j] = kA[18 + 6 * (j / 3) + j % 3], rows.W[j] = kA[18 + 6 * (j / 3) + 3 + j % 3];
        }
        dmb_se3_tangent_times_rows(&reverse, &rows, D);
        CHECK_BELOW(max_difference(36, C, D), 5e-15);
    }
}

/* Both ends at once, without the matrices, against full matrices. */
static void ends_match_full_matrices(void **state)
{
    (void)state;
    random_stream r = {31};
    for (int i = 0; i < 200; i++) {
        double h[6], m[6], va[6], vb[6], s[6], A[36], M[36], x[6], y[6], z[6], back[6], ahead[6];
        dmb_so3_inverse_coefficients k;
        draw_pose_vector(&r, 2.5 * fabs(draw(&r)) + 1e-6, h);
        draw_vector(&r, 6, va);
        draw_vector(&r, 6, vb);
        draw_vector(&r, 6, s);
        negate(6, h, m);
        inverse_tangent_matrix(h, A);
        inverse_tangent_matrix(m, M);
        dmb_so3_inverse_coefficients_at(dmb_vec3_norm_squared(h + 3), &k);
        dmb_mat6_vec(A, vb, x);
        dmb_mat6_vec(M, va, y);
        for (int j = 0; j < 6; j++) x[j] -= y[j];
        dmb_se3_inverse_tangents_apply(h, &k, va, vb, z);
        CHECK_BELOW(max_difference(6, x, z), 4e-15);
        dmb_se3_inverse_tangents_transpose(h, &k, s, back, ahead);
        dmb_mat6_tvec(M, s, y);
        CHECK_BELOW(max_difference(6, y, back), 4e-15);
        dmb_mat6_tvec(A, s, y);
        CHECK_BELOW(max_difference(6, y, ahead), 4e-15);
    }
}

/* log(exp(-h) exp(h + e)) = T6(h) e + O(e^2) */
static void tangent_is_the_derivative_of_exp(void **state)
{
    (void)state;
    random_stream r = {27};
    const double step = 1e-5;
    for (int i = 0; i < 60; i++) {
        double h[6], T[36];
        draw_pose_vector(&r, 3.0 * fabs(draw(&r)) + 1e-3, h);
        tangent_matrix(h, T);
        for (int j = 0; j < 6; j++) {
            double d[2][6];
            for (int side = 0; side < 2; side++) {
                double p[6], q0[4], q1[4], q[4], x0[3], x1[3], x[3];
                dmb_vec6_copy(h, p);
                p[j] += side ? -step : step;
                dmb_se3_exp_to_quat(h, q0, x0);
                dmb_se3_exp_to_quat(p, q1, x1);
                dmb_quat_between(q0, q1, q);
                dmb_vec3_sub(x1, x0, x);
                dmb_quat_rotate_inverse(q0, x, x);
                dmb_se3_log_from_quat(q, x, NULL, d[side]);
            }
            for (int l = 0; l < 6; l++) CHECK_CLOSE((d[0][l] - d[1][l]) / (2.0 * step), T[6 * l + j], 1e-9);
        }
    }
}

typedef void vector_map(const double h[6], const double s[6], double out[6]);

static void stress_map(const double h[6], const double s[6], double out[6])
{
    dmb_se3_inverse_tangent T;
    dmb_se3_inverse_tangent_at(h, NULL, &T);
    dmb_se3_tangent_apply_transpose(&T, s, out);
}

static void velocity_map(const double h[6], const double v[6], double out[6])
{
    dmb_se3_inverse_tangent T;
    dmb_se3_inverse_tangent_at(h, NULL, &T);
    dmb_se3_tangent_apply(&T, v, out);
}

/* Central differences of fourth order: error a few 1e-12 at this step. */
static void difference(vector_map *f, const double h[6], const double s[6], double J[36])
{
    const double step = 1e-3, weight[2] = {8.0 / 12.0, -1.0 / 12.0};
    dmb_mat6_zero(J);
    for (int j = 0; j < 6; j++)
        for (int n = 1; n <= 2; n++)
            for (int sign = -1; sign <= 1; sign += 2) {
                double p[6], y[6];
                dmb_vec6_copy(h, p);
                p[j] += sign * n * step;
                f(p, s, y);
                for (int i = 0; i < 6; i++) J[6 * i + j] += sign * weight[n - 1] / step * y[i];
            }
}

static void derivatives_match_differences(void **state)
{
    (void)state;
    random_stream r = {28};
    const double angles[] = {1e-6, 1e-3, 0.1, 0.3, 0.6, 1.0, 1.7, 2.5, 3.1, 4.0};
    for (int i = 0; i < 200; i++) {
        double h[6], s[6], D[36], want[36];
        draw_pose_vector(&r, angles[i % 10], h);
        draw_vector(&r, 6, s);
        stress_derivative_matrix(h, s, D);
        difference(stress_map, h, s, want);
        CHECK_BELOW(max_difference(36, D, want), 1e-10);
        dmb_se3_velocity_derivative(h, s, NULL, D);
        difference(velocity_map, h, s, want);
        CHECK_BELOW(max_difference(36, D, want), 1e-10);
    }
}

static void stress_blocks_serve_both_signs(void **state)
{
    (void)state;
    random_stream r = {29};
    for (int i = 0; i < 200; i++) {
        double h[6], m[6], s[6], D[36], E[36], T6[36], C[36], F[36];
        dmb_so3_inverse_coefficients k;
        dmb_se3_stress_blocks plus, minus;
        dmb_se3_inverse_tangent T;
        draw_pose_vector(&r, 2.5 * fabs(draw(&r)) + 1e-6, h);
        draw_vector(&r, 6, s);
        negate(6, h, m);
        dmb_so3_inverse_coefficients_at(dmb_vec3_norm_squared(h + 3), &k);
        dmb_se3_stress_blocks_at(h, s, &k, &plus, &minus);
        stress_derivative_matrix(m, s, D);
        stress_matrix(&minus, E);
        CHECK_BELOW(max_difference(36, D, E), 1e-15);
        stress_derivative_matrix(h, s, D);
        stress_matrix(&plus, E);
        assert_memory_equal(D, E, sizeof D); /* given and own coefficients: the same bits */
        dmb_se3_inverse_tangent_at(h, &k, &T);
        inverse_tangent_matrix(h, T6);
        multiply(6, E, T6, C);
        for (int j = 0; j < 36; j++) F[j] = s[j % 6];
        for (int j = 0; j < 36; j++) C[j] = s[j % 6] - 2.0 * C[j];
        dmb_se3_stress_times_tangent(-2.0, &plus, &T, F);
        CHECK_BELOW(max_difference(36, C, F), 1e-14);
    }
}

/* Virtual work: s . (T6^-1 v) = v . (T6^-T s), and along h itself T6(h) h = h. */
static void work_and_fixed_direction(void **state)
{
    (void)state;
    random_stream r = {30};
    for (int i = 0; i < 200; i++) {
        double h[6], v[6], s[6], y[6], z[6], T[36];
        dmb_se3_inverse_tangent Ti;
        draw_pose_vector(&r, 3.0 * fabs(draw(&r)) + 1e-8, h);
        draw_vector(&r, 6, v);
        draw_vector(&r, 6, s);
        dmb_se3_inverse_tangent_at(h, NULL, &Ti);
        dmb_se3_tangent_apply(&Ti, v, y);
        dmb_se3_tangent_apply_transpose(&Ti, s, z);
        CHECK_CLOSE(dmb_vec6_dot(s, y), dmb_vec6_dot(v, z), 1e-14);
        tangent_matrix(h, T);
        dmb_mat6_vec(T, h, y);
        CHECK_BELOW(max_difference(6, y, h), 2e-15);
        dmb_se3_tangent_apply(&Ti, h, y);
        CHECK_BELOW(max_difference(6, y, h), 4e-15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mixed_blocks_are_exact),
        cmocka_unit_test(log_inverts_exp),
        cmocka_unit_test(exp_of_a_screw),
        cmocka_unit_test(advance_composes),
        cmocka_unit_test(tangent_identities),
        cmocka_unit_test(reversed_operator_is_transposed_blocks),
        cmocka_unit_test(block_forms_match_full_matrices),
        cmocka_unit_test(ends_match_full_matrices),
        cmocka_unit_test(tangent_is_the_derivative_of_exp),
        cmocka_unit_test(derivatives_match_differences),
        cmocka_unit_test(stress_blocks_serve_both_signs),
        cmocka_unit_test(work_and_fixed_direction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
