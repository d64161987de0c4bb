/* Frame b seen from frame a: pose, twist, convective term, forces and tangent, each against six-point differences of
 * the composed poses or against the power. Checks eq:joints.relative-motion, eq:joints.relative-tangent and
 * eq:joints.speed-tangent. */
#include <string.h>

#include "check.h"
#include "matrices.h"

#include "constraint/joint.h"
#include "math/mat6.h"
#include "math/se3.h"

#define ROUNDS 40
#define STEP 4e-3

typedef struct pose {
    double R[9], x[3];
} pose;

/* Two bodies, a marker on each, velocities and their derivatives. */
typedef struct two_bodies {
    pose body[2], marker[2];
    double v[2][6], rate[2][6];
    int ground; /* a is the ground: body[0] is at the origin and stays, its marker is frame a in the world */
} two_bodies;

/* out = A exp(h) */
static pose moved(const pose *A, const double h[6])
{
    pose out;
    double R[9], x[3];
    dmb_se3_exp(h, NULL, R, x);
    dmb_mat3_mul(A->R, R, out.R);
    dmb_mat3_vec(A->R, x, out.x);
    dmb_vec3_add(A->x, out.x, out.x);
    return out;
}

/* A B */
static pose composed(const pose *A, const pose *B)
{
    pose out;
    dmb_mat3_mul(A->R, B->R, out.R);
    dmb_mat3_vec(A->R, B->x, out.x);
    dmb_vec3_add(A->x, out.x, out.x);
    return out;
}

static void draw_n(uint64_t *seed, size_t n, double size, double *out)
{
    for (size_t i = 0; i < n; i++) out[i] = draw_between(seed, -size, size);
}

static pose draw_pose(uint64_t *seed)
{
    pose at = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
    double h[6];
    draw_n(seed, 6, 1.5, h);
    return moved(&at, h);
}

static two_bodies draw_bodies(uint64_t *seed, int ground)
{
    two_bodies s;
    memset(&s, 0, sizeof s);
    for (int i = 0; i < 2; i++) {
        s.body[i] = draw_pose(seed);
        s.marker[i] = draw_pose(seed);
        draw_n(seed, 6, 1.0, s.v[i]);
        draw_n(seed, 6, 1.0, s.rate[i]);
    }
    s.ground = ground;
    if (!ground) return s;
    dmb_mat3_identity(s.body[0].R);
    dmb_vec3_zero(s.body[0].x);
    memset(s.v[0], 0, sizeof s.v[0]);
    memset(s.rate[0], 0, sizeof s.rate[0]);
    return s;
}

/* The bodies a time later: body-frame velocity v at first, growing by rate. h = t v + t^2/2 rate, v = T6(h) h'. */
static two_bodies later(const two_bodies *s, double t)
{
    two_bodies out = *s;
    for (int i = 0; i < 2; i++) {
        double h[6], speed[6], T[36];
        for (int k = 0; k < 6; k++) h[k] = t * (s->v[i][k] + 0.5 * t * s->rate[i][k]);
        for (int k = 0; k < 6; k++) speed[k] = s->v[i][k] + t * s->rate[i][k];
        tangent_matrix(h, T);
        dmb_mat6_vec(T, speed, out.v[i]);
        out.body[i] = moved(&s->body[i], h);
    }
    return out;
}

static dmb_relative relative_of(const two_bodies *s)
{
    const pose a = composed(&s->body[0], &s->marker[0]), b = composed(&s->body[1], &s->marker[1]);
    dmb_relative out;
    double span[3];
    dmb_vec3_sub(b.x, a.x, span);
    dmb_relative_place(a.R, b.R, span, &out);
    dmb_relative_maps(s->ground ? NULL : s->marker[0].x, s->ground ? NULL : s->marker[0].R, s->marker[1].x,
                      s->marker[1].R, &out);
    dmb_relative_motion(s->ground ? NULL : s->v[0], s->v[1], &out);
    return out;
}

/* log of the relative pose `to` seen from the relative pose `from` */
static void relative_step(const dmb_relative *from, const dmb_relative *to, double xi[6])
{
    double R[9], d[3], x[3];
    dmb_mat3_mul_tn(from->R, to->R, R);
    dmb_vec3_sub(to->p, from->p, d);
    dmb_mat3_tvec(from->R, d, x);
    dmb_se3_log(R, x, NULL, xi);
}

/* H_a H = H_b */
static void pose_composes(void **state)
{
    uint64_t seed = 31;
    double error = 0.0;
    (void)state;
    for (int i = 0; i < ROUNDS; i++) {
        const two_bodies s = draw_bodies(&seed, i % 2);
        const dmb_relative r = relative_of(&s);
        const pose a = composed(&s.body[0], &s.marker[0]), b = composed(&s.body[1], &s.marker[1]);
        pose H;
        dmb_mat3_copy(r.R, H.R);
        dmb_vec3_copy(r.p, H.x);
        H = composed(&a, &H);
        error = fmax(error, fmax(largest_difference(9, H.R, b.R), largest_difference(3, H.x, b.x)));
    }
    check_below("H_a H = H_b", error, 1e-14);
}

/* V = (log H(0)^-1 H(t))' and V' = to_b v_b' + to_a v_a' + convective */
static void motion_is_the_derivative(void **state)
{
    uint64_t seed = 32;
    double twist_error = 0.0, rate_error = 0.0, convective = 0.0;
    (void)state;
    for (int i = 0; i < ROUNDS; i++) {
        const two_bodies s = draw_bodies(&seed, i % 2);
        const dmb_relative r = relative_of(&s);
        double twist[6][6], place[6][6], a[6], b[6];
        for (int k = 0; k < 6; k++) {
            const two_bodies next = later(&s, STEP * difference6_place[k]);
            const dmb_relative there = relative_of(&next);
            double xi[6];
            relative_step(&r, &there, xi);
            for (int c = 0; c < 6; c++) place[c][k] = xi[c];
            for (int c = 0; c < 6; c++) twist[c][k] = there.V[c];
        }
        dmb_mat6_vec(r.to_a, s.rate[0], a);
        dmb_mat6_vec(r.to_b, s.rate[1], b);
        for (int c = 0; c < 6; c++) {
            const double rate = a[c] + b[c] + r.convective[c];
            twist_error = fmax(twist_error, fabs(difference6(place[c], STEP) - r.V[c]));
            rate_error = fmax(rate_error, fabs(difference6(twist[c], STEP) - rate));
            if (s.ground) assert_true(r.convective[c] == 0.0);
        }
        convective = fmax(convective, largest(6, r.convective));
    }
    check_below("V against differences of the pose", twist_error, 1e-10);
    check_below("V' against differences of V", rate_error, 1e-10);
    assert_true(convective > 1.0);
}

/* w . V = wa . va + wb . vb; nothing to the ground */
static void forces_give_the_same_power(void **state)
{
    uint64_t seed = 33;
    double error = 0.0;
    (void)state;
    for (int i = 0; i < ROUNDS; i++) {
        const two_bodies s = draw_bodies(&seed, i % 2);
        const dmb_relative r = relative_of(&s);
        double w[6], wa[6], wb[6], alone[6];
        draw_n(&seed, 6, 1.0, w);
        dmb_relative_pull_back(&r, w, wa, wb);
        dmb_relative_pull_back(&r, w, NULL, alone);
        const double power = dmb_vec6_dot(wa, s.v[0]) + dmb_vec6_dot(wb, s.v[1]);
        error = fmax(error, fabs(dmb_vec6_dot(w, r.V) - power));
        assert_memory_equal(wb, alone, sizeof wb);
        if (s.ground) assert_true(largest(6, wa) == 0.0);
    }
    check_below("power of the wrench and of its two forces", error, 1e-13);
}

/* The two forces of the wrench w + W log(H0^-1 H) when body c/6 moves by `step` along its direction c % 6. */
static void forces_at(const two_bodies *s, const dmb_relative *r0, const double w[6], const double W[36], int c,
                      double step, double f[12])
{
    two_bodies there = *s;
    double h[6] = {0.0}, xi[6], change[6];
    h[c % 6] = step;
    there.body[c / 6] = moved(&s->body[c / 6], h);
    const dmb_relative r = relative_of(&there);
    relative_step(r0, &r, xi);
    dmb_mat6_vec(W, xi, change);
    for (int i = 0; i < 6; i++) change[i] += w[i];
    dmb_relative_pull_back(&r, change, f, f + 6);
}

static void tangent_is_the_derivative_of_the_forces(void **state)
{
    uint64_t seed = 34;
    double error = 0.0;
    (void)state;
    for (int i = 0; i < ROUNDS; i++) {
        const two_bodies s = draw_bodies(&seed, i % 2);
        const dmb_relative r = relative_of(&s);
        double w[6], W[36], K[144];
        draw_n(&seed, 6, 1.0, w);
        draw_n(&seed, 36, i < ROUNDS / 2 ? 1.0 : 0.0, W);
        for (int k = 0; k < 144; k++) K[k] = 1e300; /* is overwritten */
        dmb_relative_tangent(&r, w, W, K);
        for (int c = s.ground ? 6 : 0; c < 12; c++) {
            double f[12][6], at[12];
            for (int k = 0; k < 6; k++) {
                forces_at(&s, &r, w, W, c, STEP * difference6_place[k], at);
                for (int row = 0; row < 12; row++) f[row][k] = at[row];
            }
            for (int row = 0; row < 12; row++) error = fmax(error, fabs(difference6(f[row], STEP) - K[12 * row + c]));
        }
        for (int k = 0; k < 144 && s.ground; k++)
            if (k < 72 || k % 12 < 6) assert_true(K[k] == 0.0);
    }
    check_below("tangent against differences of the forces", error, 1e-10);
}

/* Speeds of the six coordinates when body c/6 moves by `step` along its direction c % 6, at the same body-frame
 * velocities. */
static void speeds_at(const two_bodies *s, int c, double step, double speeds[6])
{
    static const double near[2] = {0.0, 0.0};
    two_bodies there = *s;
    double h[6] = {0.0};
    dmb_joint_coordinates at;
    h[c % 6] = step;
    there.body[c / 6] = moved(&s->body[c / 6], h);
    const dmb_relative r = relative_of(&there);
    dmb_joint_coordinates_at(r.R, r.p, r.V, near, &at);
    for (int k = 0; k < 6; k++) speeds[k] = dmb_vec6_dot(at.J[k], r.V);
}

static void speeds_change_with_the_pose(void **state)
{
    static const double near[2] = {0.0, 0.0};
    uint64_t seed = 35;
    double error = 0.0;
    (void)state;
    for (int i = 0; i < ROUNDS; i++) {
        const two_bodies s = draw_bodies(&seed, i % 2);
        const dmb_relative r = relative_of(&s);
        dmb_joint_coordinates at;
        double G[6][6];
        dmb_joint_coordinates_at(r.R, r.p, r.V, near, &at);
        if (fabs(at.value[5]) > 1.2) continue; /* near the edge of the angles */
        dmb_joint_speeds_tangent(&r, &at, s.v[1], G);
        for (int c = s.ground ? 6 : 0; c < 12; c++) {
            double v[6][6], speeds[6];
            for (int p = 0; p < 6; p++) {
                speeds_at(&s, c, STEP * difference6_place[p], speeds);
                for (int k = 0; k < 6; k++) v[k][p] = speeds[k];
            }
            for (int k = 0; k < 6; k++) {
                double want = 0.0;
                for (int m = 0; m < 6; m++) want += G[k][m] * (c < 6 ? r.to_a[6 * m + c] : r.to_b[6 * m + c - 6]);
                error = fmax(error, fabs(difference6(v[k], STEP) - want) / (1.0 + fabs(want)));
            }
        }
    }
    check_below("speeds of coordinates by the pose against differences", error, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pose_composes),
        cmocka_unit_test(motion_is_the_derivative),
        cmocka_unit_test(forces_give_the_same_power),
        cmocka_unit_test(tangent_is_the_derivative_of_the_forces),
        cmocka_unit_test(speeds_change_with_the_pose),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
