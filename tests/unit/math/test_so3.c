/* Rotations: coefficients and operators against long double, identities, quaternions, the arc tangent of turns. Checks
 * eq:kinematics.exp-rotation, eq:kinematics.tangent-rotation, eq:kinematics.inverse-tangent-rotation,
 * eq:kinematics.log-rotation, eq:kinematics.coefficients and eq:kinematics.coefficient-rates. */
#include <stdio.h>

#include "math_test.h"
#include "matrices.h"

#include "math/so3.h"

static double relative(double got, long double want, double floor)
{
    return (double)(fabsl((long double)got - want) / fmaxl(fabsl(want), (long double)floor));
}

/* All to 1e-15 relative up to pi and a little beyond; sin t/t, which has a zero at pi, to 1e-15 of its scale there. */
static void coefficients_are_exact(void **state)
{
    (void)state;
    NEEDS_LONG_DOUBLE();
    for (int i = 0; i <= 6400; i++) {
        const double t = i < 3200 ? 3.24 * pow(10.0, -9.0 * i / 3200.0) : 3.24 * (i - 3200) / 3200.0, x = t * t;
        const exact_coefficients r = exact_at((long double)x);
        dmb_so3_coefficients k;
        dmb_so3_inverse_coefficients n;
        dmb_so3_coefficients_at(x, &k);
        dmb_so3_inverse_coefficients_at(x, &n);
        CHECK_BELOW(relative(k.a, r.a, 0.5), 1e-15);
        CHECK_BELOW(relative(k.b, r.b, 0.0), 1e-15);
        CHECK_BELOW(relative(k.a2, r.a2, 0.0), 1e-15);
        CHECK_BELOW(relative(k.db, r.db, 0.0), 1e-15);
        CHECK_BELOW(relative(k.da2, r.da2, 0.0), 1e-15);
        CHECK_BELOW(relative(n.c, r.c, 0.0), 1e-15);
        CHECK_BELOW(relative(n.e, r.e, 0.0), 1e-15);
        CHECK_BELOW(relative(n.e2, r.e2, 0.0), 1e-15);
    }
}

/* Closed forms beyond: a few digits go by cancellation, and the inverse grows towards its pole at 2 pi. */
static void coefficients_beyond_pi(void **state)
{
    (void)state;
    NEEDS_LONG_DOUBLE();
    for (int i = 0; i < 2760; i++) {
        const double t = 3.2404 + 0.001 * i, x = t * t;
        const exact_coefficients r = exact_at((long double)x);
        dmb_so3_coefficients k;
        dmb_so3_inverse_coefficients n;
        dmb_so3_coefficients_at(x, &k);
        dmb_so3_inverse_coefficients_at(x, &n);
        CHECK_BELOW(relative(k.a, r.a, 0.1), 1e-15);
        CHECK_BELOW(relative(k.b, r.b, 0.02), 1e-15);
        CHECK_BELOW(relative(k.a2, r.a2, 0.0), 1e-15);
        CHECK_BELOW(relative(k.db, r.db, 0.02), 1e-15);
        CHECK_BELOW(relative(k.da2, r.da2, 0.004), 1e-15);
        CHECK_BELOW(relative(n.c, r.c, 0.0), 1e-14);
        CHECK_BELOW(relative(n.e, r.e, 0.0), 1e-14);
        CHECK_BELOW(relative(n.e2, r.e2, 0.0), 2e-14);
    }
}

static void limits_at_zero(void **state)
{
    (void)state;
    dmb_so3_coefficients k;
    dmb_so3_inverse_coefficients n;
    dmb_so3_coefficients_at(0.0, &k);
    dmb_so3_inverse_coefficients_at(0.0, &n);
    assert_true(k.a == 1.0 && k.b == 0.5 && k.a2 == 1.0 / 6.0 && k.db == -1.0 / 12.0);
    CHECK_CLOSE(k.da2, -1.0 / 60.0, 4e-18);
    assert_true(n.c == 1.0 / 12.0 && n.e == 1.0 / 360.0 && n.e2 == 1.0 / 3780.0);
    const double zero[3] = {0.0, 0.0, 0.0};
    double A[9], q[4], O[3];
    dmb_so3_exp(zero, NULL, A);
    assert_true(identity_error(3, A) == 0.0);
    dmb_so3_tangent(zero, NULL, A);
    assert_true(identity_error(3, A) == 0.0);
    dmb_so3_inverse_tangent(zero, NULL, A);
    assert_true(identity_error(3, A) == 0.0);
    dmb_quat_exp(zero, q);
    assert_true(q[0] == 1.0 && q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0);
    dmb_quat_log(q, O);
    assert_true(dmb_vec3_norm(O) == 0.0);
}

/* I + p O~ + q O~^2 in long double */
static void exact_polynomial(const double O[3], long double p, long double q, double out[9])
{
    const long double o[3] = {(long double)O[0], (long double)O[1], (long double)O[2]};
    const long double x = o[0] * o[0] + o[1] * o[1] + o[2] * o[2];
    const long double K[9] = {0, -o[2], o[1], o[2], 0, -o[0], -o[1], o[0], 0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[3 * i + j] = (double)((i == j ? 1.0L - q * x : 0.0L) + p * K[3 * i + j] + q * o[i] * o[j]);
}

static exact_coefficients exact_of(const double O[3])
{
    const long double x = (long double)O[0], y = (long double)O[1], z = (long double)O[2];
    return exact_at(x * x + y * y + z * z);
}

static void operators_are_exact(void **state)
{
    (void)state;
    NEEDS_LONG_DOUBLE();
    random_stream r = {11};
    for (int i = 0; i < 40 * TEST_ANGLE_COUNT; i++) {
        const double t = test_angles[i % TEST_ANGLE_COUNT];
        double O[3], A[9], want[9];
        draw_rotation(&r, t, O);
        const exact_coefficients k = exact_of(O);
        dmb_so3_exp(O, NULL, A);
        exact_polynomial(O, k.a, k.b, want);
        CHECK_BELOW(max_difference(9, A, want), 1e-15);
        dmb_so3_tangent(O, NULL, A);
        exact_polynomial(O, -k.b, k.a2, want);
        CHECK_BELOW(max_difference(9, A, want), 1e-15);
        dmb_so3_inverse_tangent(O, NULL, A);
        exact_polynomial(O, 0.5L, k.c, want);
        const double amplified = 1.0 + t * t / (4.0 * DMB_PI * DMB_PI - t * t); /* of a rounding in |O|^2 */
        CHECK_BELOW(max_difference(9, A, want), 1e-15 * amplified * fmax(1.0, max_abs(9, want)));
    }
}

static void tangents_are_inverse_and_turn_with_sign(void **state)
{
    (void)state;
    random_stream r = {12};
    for (int i = 0; i < 20 * TEST_ANGLE_COUNT; i++) {
        double O[3], M[3], T[9], S[9], P[9], Q[9], R[9];
        draw_rotation(&r, test_angles[i % TEST_ANGLE_COUNT], O);
        dmb_vec3_scale(-1.0, O, M);
        dmb_so3_tangent(O, NULL, T);
        dmb_so3_inverse_tangent(O, NULL, S);
        multiply(3, T, S, P);
        CHECK_BELOW(identity_error(3, P), 2e-15 * fmax(1.0, max_abs(9, S)) * fmax(1.0, max_abs(9, S)));
        dmb_so3_tangent(M, NULL, P); /* T(-O) = T(O)^T = exp(O) T(O) */
        transpose(3, T, Q);
        assert_memory_equal(P, Q, sizeof P);
        dmb_so3_exp(O, NULL, R);
        multiply(3, R, T, P);
        CHECK_BELOW(max_difference(9, P, Q), 1e-15);
    }
}

static void exp_is_a_rotation(void **state)
{
    (void)state;
    random_stream r = {13};
    for (int i = 0; i < 20 * TEST_ANGLE_COUNT; i++) {
        double O[3], R[9], P[9], q[4], Q[9];
        draw_rotation(&r, test_angles[i % TEST_ANGLE_COUNT], O);
        dmb_so3_exp(O, NULL, R);
        dmb_mat3_mul_tn(R, R, P);
        CHECK_BELOW(identity_error(3, P), 2e-15);
        CHECK_CLOSE(determinant_of(R), 1.0, 2e-15);
        dmb_quat_exp(O, q);
        CHECK_CLOSE(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 1e-15);
        dmb_quat_to_matrix(q, Q);
        CHECK_BELOW(max_difference(9, R, Q), 1.5e-15);
    }
}

static void log_inverts_exp(void **state)
{
    (void)state;
    random_stream r = {14};
    for (int i = 0; i < 40 * TEST_ANGLE_COUNT; i++) {
        const double t = fmin(test_angles[i % TEST_ANGLE_COUNT], DMB_PI - 1e-7);
        double O[3], q[4], R[9], back[3];
        draw_rotation(&r, t, O);
        dmb_quat_exp(O, q);
        dmb_quat_log(q, back);
        CHECK_BELOW(max_difference(3, O, back), 1e-15 * t);
        for (int j = 0; j < 4; j++) q[j] *= -3.0; /* neither sign nor length matter */
        dmb_quat_log(q, back);
        CHECK_BELOW(max_difference(3, O, back), 1e-15 * t);
        dmb_so3_exp(O, NULL, R);
        log_of_rotation(R, back);
        CHECK_BELOW(max_difference(3, O, back), 2e-15 * fmax(t, 0.1)); /* R holds angles to 1e-16 absolute */
    }
}

static void log_at_half_turn(void **state)
{
    (void)state;
    const double q[4] = {0.0, 0.6, 0.0, -0.8}, want[3] = {0.6 * DMB_PI, 0.0, -0.8 * DMB_PI};
    double O[3], R[9], p[4];
    dmb_quat_log(q, O);
    CHECK_BELOW(max_difference(3, O, want), 1e-15);
    dmb_quat_to_matrix(q, R);
    dmb_quat_from_matrix(R, p);
    const double sign = p[1] < 0.0 ? -1.0 : 1.0; /* both senses are right */
    log_of_rotation(R, O);
    dmb_vec3_scale(sign, O, O);
    CHECK_BELOW(max_difference(3, O, want), 1e-15);
}

static void quaternion_matrix_round_trip(void **state)
{
    (void)state;
    random_stream r = {15};
    for (int i = 0; i < 20000; i++) {
        double q[4], p[4], R[9];
        draw_vector(&r, 4, q);
        if (i % 4 == 1) q[0] *= 1e-9;               /* close to half turns */
        if (i % 4 == 2) q[1] *= 1e-9, q[2] *= 1e-9; /* nearly about an axis */
        dmb_quat_normalize(q);
        if (q[0] < 0.0) dmb_vec3_scale(-1.0, q + 1, q + 1), q[0] = -q[0];
        dmb_quat_to_matrix(q, R);
        dmb_quat_from_matrix(R, p);
        CHECK_BELOW(max_difference(4, p, q), 1e-15);
    }
}

static void quaternion_product_is_matrix_product(void **state)
{
    (void)state;
    random_stream r = {16};
    for (int i = 0; i < 1000; i++) {
        double p[4], q[4], s[4], P[9], Q[9], S[9], PQ[9], v[3], w[3], x[3];
        draw_vector(&r, 4, p);
        draw_vector(&r, 4, q);
        draw_vector(&r, 3, v);
        dmb_quat_normalize(p);
        dmb_quat_normalize(q);
        dmb_quat_to_matrix(p, P);
        dmb_quat_to_matrix(q, Q);
        dmb_quat_mul(p, q, s);
        dmb_quat_to_matrix(s, S);
        dmb_mat3_mul(P, Q, PQ);
        CHECK_BELOW(max_difference(9, S, PQ), 2e-15);
        dmb_quat_between(p, q, s);
        dmb_quat_to_matrix(s, S);
        dmb_mat3_mul_tn(P, Q, PQ);
        CHECK_BELOW(max_difference(9, S, PQ), 2e-15);
        dmb_quat_rotate(p, v, w);
        dmb_mat3_vec(P, v, x);
        CHECK_BELOW(max_difference(3, w, x), 2e-15);
        dmb_quat_rotate_inverse(p, w, w);
        CHECK_BELOW(max_difference(3, w, v), 2e-15);
    }
}

/* 1e6 steps of about a milliradian: still a rotation to rounding, and drifted from the exact one by far less than
 * the 1e-10 that 1e6 roundings of one sense would make. */
static void million_steps_stay_orthonormal(void **state)
{
    (void)state;
    const double O[3] = {1.0e-3, -2.0e-4, 5.0e-4}, turn = 1e6 * dmb_vec3_norm(O);
    double q[4], step[4], R[9], P[9], axis[3], v[3], want[4];
    dmb_vec3_zero(q + 1);
    q[0] = 1.0;
    for (int i = 0; i < 1000000; i++) {
        dmb_quat_exp(O, step);
        dmb_quat_mul(q, step, q);
        dmb_quat_normalize(q);
        if (i % 1000 == 0) {
            dmb_quat_to_matrix(q, R);
            dmb_mat3_mul_tn(R, R, P);
            CHECK_BELOW(identity_error(3, P), 2e-15);
        }
    }
    dmb_vec3_scale(1.0 / dmb_vec3_norm(O), O, axis);
    dmb_vec3_scale(sin(0.5 * turn), axis, v);
    want[0] = cos(0.5 * turn);
    dmb_vec3_copy(v, want + 1);
    CHECK_BELOW(max_difference(4, q, want), 4e-12);
    dmb_quat_rotate(q, axis, v);
    CHECK_BELOW(max_difference(3, v, axis), 4e-12);
}

static void normalize_near_and_far(void **state)
{
    (void)state;
    const double lengths[] = {1e-3, 0.5, 1.0 - 1e-9, 1.0, 1.0 + 4e-9, 1.0 + 1e-8, 1.001, 7.0};
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        double q[4] = {0.5 * lengths[i], -0.1 * lengths[i], 0.7 * lengths[i], 0.5 * lengths[i]};
        dmb_quat_normalize(q);
        CHECK_CLOSE(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 5e-16);
        CHECK_CLOSE(q[0], 0.5, 2e-16);
    }
}

/* Swing-twist: the twist is found under any swing below a half turn, over many turns, in both senses. */
static void twist_follows_turns(void **state)
{
    (void)state;
    random_stream r = {17};
    for (int i = 0; i < 5000; i++) {
        const double angle = 400.0 * draw(&r), swing = 3.0 * draw(&r), where = 3.0 * draw(&r);
        const double about_x[3] = {fmod(angle, 2.0 * DMB_PI), 0.0, 0.0};
        const double across[3] = {0.0, swing * cos(where), swing * sin(where)};
        double q[4], s[4];
        dmb_quat_exp(about_x, q);
        dmb_quat_exp(across, s);
        dmb_quat_mul(s, q, q);
        CHECK_CLOSE(dmb_quat_twist(q, angle + 3.0 * draw(&r)), angle, 2e-13);
    }
    const double undefined[4] = {0.0, 0.0, 1.0, 0.0};
    assert_true(dmb_quat_twist(undefined, 12.5) == 12.5);
}

/* Largest difference from the C library's arc tangent so far, over pi, in all eight octants. */
static double arc_tangent_error(double x, double y, double worst)
{
    for (int octant = 0; octant < 8; octant++) {
        const double a = octant & 4 ? y : x, b = octant & 4 ? x : y;
        const double u = octant & 1 ? -a : a, v = octant & 2 ? -b : b;
        const double got = dmb_real_atan2(v, u), error = fabs(got - atan2(v, u)) / DMB_PI;
        if (!(error <= 5e-16)) fail_msg("atan2(%.17g, %.17g) = %.17g, off by %.3g pi", v, u, got, error);
        assert_true(signbit(got) == signbit(v));
        worst = fmax(worst, error);
    }
    return worst;
}

/* Round the circle at sizes from 1e-300 to 1e300, and from the last digits on either side of tan(pi/8), where the
 * formula changes, on to the diagonal. */
static void arc_tangent_is_that_of_the_c_library(void **state)
{
    (void)state;
    const double sizes[] = {1e-300, 1e-8, 1.0, 3e5, 1e300};
    const double edge = 0.41421356237309503;
    double worst = 0.0;
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        for (int i = 1; i <= 4000; i++) {
            const double t = 0.25 * DMB_PI * i / 4000.0;
            worst = arc_tangent_error(sizes[s] * cos(t), sizes[s] * sin(t), worst);
        }
        for (int i = -40; i <= 40; i++)
            worst = arc_tangent_error(sizes[s], sizes[s] * edge * (1.0 + i * 0x1p-52), worst);
        worst = arc_tangent_error(sizes[s], sizes[s], worst);
    }
    for (int i = 0; i <= 300; i++) worst = arc_tangent_error(1.0, pow(10.0, -i), worst);
    printf("arc tangent: %.2g pi off the C library's at most\n", worst);
}

/* On the axes. A zero counts as positive whatever its sign, unlike in the C library: turns are asked for by the nearest
 * revolution, to which both answers lead. There is no angle if both are 0. */
static void arc_tangent_on_axes(void **state)
{
    (void)state;
    const double sizes[] = {1e-300, 1.0, 1e300};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        const double r = sizes[s];
        assert_true(dmb_real_atan2(0.0, r) == 0.0 && !signbit(dmb_real_atan2(0.0, r)));
        assert_true(dmb_real_atan2(-0.0, r) == 0.0);
        assert_true(dmb_real_atan2(0.0, -r) == DMB_PI && dmb_real_atan2(-0.0, -r) == DMB_PI);
        assert_true(dmb_real_atan2(r, 0.0) == 0.5 * DMB_PI && dmb_real_atan2(-r, 0.0) == -0.5 * DMB_PI);
        assert_true(dmb_real_atan2(r, -0.0) == 0.5 * DMB_PI && dmb_real_atan2(-r, -0.0) == -0.5 * DMB_PI);
    }
    assert_true(isnan(dmb_real_atan2(0.0, 0.0)) && isnan(dmb_real_atan2(0.0, -0.0)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coefficients_are_exact),
        cmocka_unit_test(coefficients_beyond_pi),
        cmocka_unit_test(limits_at_zero),
        cmocka_unit_test(operators_are_exact),
        cmocka_unit_test(tangents_are_inverse_and_turn_with_sign),
        cmocka_unit_test(exp_is_a_rotation),
        cmocka_unit_test(log_inverts_exp),
        cmocka_unit_test(log_at_half_turn),
        cmocka_unit_test(quaternion_matrix_round_trip),
        cmocka_unit_test(quaternion_product_is_matrix_product),
        cmocka_unit_test(million_steps_stay_orthonormal),
        cmocka_unit_test(normalize_near_and_far),
        cmocka_unit_test(twist_follows_turns),
        cmocka_unit_test(arc_tangent_is_that_of_the_c_library),
        cmocka_unit_test(arc_tangent_on_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
