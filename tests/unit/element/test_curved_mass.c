/* Mass of bent elements: rigid motion against rigid bodies, straight elements against the constant mass, forces of
 * inertia against Lagrange's equations by differences, the mass matrix by its smallest eigenvalue. Checks
 * eq:curved.line, eq:curved.centre, eq:curved.kinetic-energy, eq:curved.inertia, eq:curved.mean-axes, eq:curved.spin,
 * eq:curved.forces and eq:curved.weight. */
#include <string.h>

#include "check.h"

#include "element/beam.h"
#include "element/curved.h"
#include "element/curved_element.h"
#include "math/bridge.h"
#include "math/quadrature.h"
#include "math/se3.h"
#include "model/section.h"

static void type_of(double length, double radius, dmb_element_type *type)
{
    static const double arm[2] = {0.0, 0.0};
    dmb_pipe_def def = dmb_pipe_def_default();
    def.length = length;
    def.section_mass = 1.3;
    def.section_inertia[0] = 2.2 * radius * radius;
    def.section_inertia[1] = 1.3 * radius * radius;
    for (int i = 0; i < 3; i++) def.section_stiffness[i] = 900.0 + 50.0 * i;
    for (int i = 3; i < 6; i++) def.section_stiffness[i] = 900.0 * radius * radius * (1.0 + 0.1 * i);
    dmb_element_type_of(&def, arm, 0.0, type);
    dmb_element_make_curved(&def, type);
}

static void draw(uint64_t *seed, double size, size_t n, double *x)
{
    for (size_t i = 0; i < n; i++) x[i] = draw_between(seed, -size, size);
}

/* Bent by the angle, sheared by a part of the length. */
static void draw_shape(uint64_t *seed, double length, double angle, double shear, double d[6])
{
    draw(seed, 1.0, 3, d + 3);
    dmb_vec3_scale(angle / dmb_vec3_norm(d + 3), d + 3, d + 3);
    draw(seed, shear * length, 3, d);
    d[0] += length;
}

/* ---- Straight ---------------------------------------------------------------------------------------------------- */

static void a_straight_one_has_the_constant_mass(void **state)
{
    uint64_t seed = 1;
    double worst = 0.0;
    (void)state;
    for (int k = 0; k < 200; k++) {
        dmb_element_type type;
        double v[12], p[12], want[12], d[6] = {0.0};
        type_of(draw_between(&seed, 0.3, 3.0), draw_between(&seed, 0.01, 1.0), &type);
        d[0] = type.length;
        draw(&seed, 1.0, 12, v);
        dmb_element_momentum(&type, d, v, v + 6, p, p + 6);
        dmb_beam_mass_times(&type.mass, v, v + 6, want, want + 6);
        worst = fmax(worst, largest_difference(12, p, want) / largest(12, want));
    }
    check_below("momentum of straight elements, of the constant mass", worst, 1e-14);
}

/* ---- Rigid motion ------------------------------------------------------------------------------------------------ */

/* Velocity of end B in a motion that is rigid: Ad^-1(exp d) v_A. */
static void follow_rigidly(const double d[6], double v[12])
{
    double R[9], x[3];
    dmb_se3_exp(d, NULL, R, x);
    dmb_adjoint_inverse_apply(R, x, v, v + 6);
}

/* Momentum of slices along the helix, about end A in its axes; the bending shapes are left out (d has no shear). */
static void of_slices(const dmb_element_type *type, const double d[6], const double v[6], double p[6])
{
    const dmb_gauss_rule *rule = dmb_gauss(5);
    memset(p, 0, 6 * sizeof *p);
    for (int piece = 0; piece < 64; piece++)
        for (int i = 0; i < rule->count; i++) {
            const double x = (piece + rule->node[i]) / 64.0, part = rule->weight[i] / 64.0;
            double h[6], R[9], r[3], w[3], u[3], q[3], m[3];
            for (int j = 0; j < 6; j++) h[j] = x * d[j];
            dmb_se3_exp(h, NULL, R, r);
            dmb_vec3_cross(v + 3, r, u);
            dmb_vec3_add(u, v, u);
            dmb_vec3_scale(part * type->curved.mass, u, u);
            dmb_vec3_add(p, u, p);
            dmb_vec3_cross(r, u, m);
            dmb_vec3_add(p + 3, m, p + 3);
            dmb_mat3_tvec(R, v + 3, w);
            for (int j = 0; j < 3; j++) w[j] *= part * type->curved.rotary[j > 0];
            dmb_mat3_vec(R, w, q);
            dmb_vec3_add(p + 3, q, p + 3);
        }
}

/* Sum of the momenta of both ends, about end A in its axes. */
static void sum_of_ends(const double d[6], const double p[12], double sum[6])
{
    double R[9], x[3], u[3], m[3];
    dmb_se3_exp(d, NULL, R, x);
    dmb_mat3_vec(R, p + 6, u);
    dmb_mat3_vec(R, p + 9, m);
    dmb_vec3_add(p, u, sum);
    dmb_vec3_add(p + 3, m, sum + 3);
    dmb_vec3_cross(x, u, m);
    dmb_vec3_add(sum + 3, m, sum + 3);
}

static void rigid_motion_has_the_momentum_of_slices(void **state)
{
    uint64_t seed = 2;
    double momentum = 0.0, energy = 0.0;
    (void)state;
    for (int k = 0; k < 300; k++) {
        dmb_element_type type;
        double v[12], p[12], d[6], sum[6], want[6];
        type_of(draw_between(&seed, 0.3, 3.0), draw_between(&seed, 0.01, 1.0), &type);
        draw_shape(&seed, type.length, draw_between(&seed, 0.0, 2.5), 0.0, d);
        draw(&seed, 1.0, 6, v);
        follow_rigidly(d, v);
        dmb_element_momentum(&type, d, v, v + 6, p, p + 6);
        sum_of_ends(d, p, sum);
        of_slices(&type, d, v, want);
        momentum = fmax(momentum, largest_difference(6, sum, want) / largest(6, want));
        const double of_ends = dmb_vec6_dot(v, p) + dmb_vec6_dot(v + 6, p + 6), right = dmb_vec6_dot(v, want);
        energy = fmax(energy, fabs(of_ends / right - 1.0));
    }
    check_below("momentum in rigid motion, of slices", momentum, 1e-13);
    check_below("kinetic energy in rigid motion, of slices", energy, 1e-13);
}

/* ---- Lagrange ---------------------------------------------------------------------------------------------------- */

typedef struct two_ends {
    double qa[4], qb[4], xa[3], xb[3];
} two_ends;

static void move_ends(const two_ends *from, const double h[12], two_ends *to)
{
    *to = *from;
    dmb_se3_advance(to->qa, to->xa, h);
    dmb_se3_advance(to->qb, to->xb, h + 6);
}

static void relative(const two_ends *ends, double d[6])
{
    double q[4], x[3];
    dmb_quat_between(ends->qa, ends->qb, q);
    dmb_vec3_sub(ends->xb, ends->xa, x);
    dmb_quat_rotate_inverse(ends->qa, x, x);
    dmb_se3_log_from_quat(q, x, NULL, d);
}

static double kinetic(const dmb_element_type *type, const two_ends *ends, const double v[12])
{
    double p[12], d[6];
    relative(ends, d);
    dmb_element_momentum(type, d, v, v + 6, p, p + 6);
    return 0.5 * (dmb_vec6_dot(v, p) + dmb_vec6_dot(v + 6, p + 6));
}

/* Momentum after a time: poses H exp(t v + t^2 a/2), speeds v + t a, right to the first order that differences ask for;
 * of higher ones the even part cancels and the odd part is of the order of the difference. */
static void momentum_after(const dmb_element_type *type, const two_ends *ends, const double v[12], const double a[12],
                           double t, double p[12])
{
    two_ends then;
    double h[12], w[12], d[6];
    for (int i = 0; i < 12; i++) {
        h[i] = t * v[i] + 0.5 * t * t * a[i];
        w[i] = v[i] + t * a[i];
    }
    move_ends(ends, h, &then);
    relative(&then, d);
    dmb_element_momentum(type, d, w, w + 6, p, p + 6);
}

/* f = p' - ad(v)^T p - dT/dq */
static double worst_of_lagrange(uint64_t *seed)
{
    const double step = 1e-3;
    dmb_element_type type;
    two_ends ends = {.qa = {1.0}, .qb = {1.0}};
    double v[12], a[12], f[12], d[6], p[12], turned[12], want[12], series[6][12];
    type_of(draw_between(seed, 0.3, 3.0), draw_between(seed, 0.01, 1.0), &type);
    draw_shape(seed, type.length, draw_between(seed, 0.0, 2.3), 0.2, d);
    draw(seed, 1.0, 12, v);
    draw(seed, 1.0, 12, a);
    dmb_se3_advance(ends.qb, ends.xb, d);
    for (int k = 0; k < 6; k++) momentum_after(&type, &ends, v, a, step * difference6_place[k], series[k]);
    relative(&ends, d);
    dmb_element_momentum(&type, d, v, v + 6, p, p + 6);
    dmb_ad_transpose(v, p, turned);
    dmb_ad_transpose(v + 6, p + 6, turned + 6);
    for (int i = 0; i < 12; i++) {
        double T[6], one[6], h[12] = {0.0};
        for (int k = 0; k < 6; k++) {
            two_ends beside;
            h[i] = step * difference6_place[k];
            move_ends(&ends, h, &beside);
            T[k] = kinetic(&type, &beside, v);
            one[k] = series[k][i];
        }
        want[i] = difference6(one, step) - turned[i] - difference6(T, step);
    }
    dmb_element_inertia(&type, d, v, a, f);
    return largest_difference(12, f, want) / largest(12, want);
}

static void forces_are_those_of_lagrange(void **state)
{
    uint64_t seed = 3;
    double worst = 0.0;
    (void)state;
    for (int k = 0; k < 100; k++) worst = fmax(worst, worst_of_lagrange(&seed));
    check_below("forces of inertia, of p' - ad(v)^T p - dT/dq", worst, 1e-9);
}

/* ---- The middle -------------------------------------------------------------------------------------------------- */

/* Rotation of the middle, R_A exp(Theta/2), after the ends have turned for a time; and Theta then. */
static void middle_after(const double qa[4], const double qb[4], const double w[6], double time, double at[4],
                         double Theta[3])
{
    double turn[3], step[4], ends[2][4], between[4];
    for (int k = 0; k < 2; k++) {
        dmb_vec3_scale(time, w + 3 * k, turn);
        dmb_quat_exp(turn, step);
        dmb_quat_mul(k == 0 ? qa : qb, step, ends[k]);
    }
    dmb_quat_between(ends[0], ends[1], between);
    dmb_quat_log(between, Theta);
    dmb_vec3_scale(0.5, Theta, turn);
    dmb_quat_exp(turn, step);
    dmb_quat_mul(ends[0], step, at);
}

/* eq:curved.middle-rate, with the rate of Theta by differences as well. */
static void rate_of_the_middle(void **state)
{
    const double qa[4] = {1.0, 0.0, 0.0, 0.0}, h = 1e-4;
    uint64_t seed = 17;
    double worst = 0.0;
    (void)state;
    for (int k = 0; k < 50; k++) {
        double qb[4], half[4], q[2][4], between[4], w[6], Theta[3], to[2][3], turned[3], rate[3], bent[3], wa[3], wb[3];
        draw(&seed, 1.0, 6, w);
        draw(&seed, 0.8, 3, Theta);
        dmb_quat_exp(Theta, qb);
        middle_after(qa, qb, w, 0.0, half, Theta);
        middle_after(qa, qb, w, -h, q[0], to[0]);
        middle_after(qa, qb, w, h, q[1], to[1]);
        dmb_quat_between(q[0], q[1], between);
        dmb_quat_log(between, turned);
        dmb_quat_rotate_inverse(half, w, wa);
        dmb_quat_rotate(half, w + 3, wb);
        dmb_vec3_sub(to[1], to[0], rate);
        dmb_vec3_scale(0.5 / h, rate, rate);
        dmb_vec3_cross(Theta, rate, bent);
        const double angle = 0.5 * dmb_vec3_norm(Theta), b = (1.0 - cos(angle)) / (angle * angle);
        for (int i = 0; i < 3; i++)
            worst = fmax(worst, fabs(turned[i] / (2.0 * h) - (0.5 * (wa[i] + wb[i]) - 0.25 * b * bent[i])));
    }
    check_below("rate of the middle against differences [rad/s]", worst, 1e-7);
}

/* ---- Spin -------------------------------------------------------------------------------------------------------- */

/* Both ends of a round element spin about their own axes: the centre line stands still, and each section has the
 * angular momentum of its rotary inertia, since eq:curved.spin takes eq:curved.spin-defect off the energy. Largest
 * force over m W^2 times the bow, and error of the energy over the bow's. */
static void spin_errors(uint64_t *seed, double angle, double shear, double error[2])
{
    static const double arm[2] = {0.0, 0.0}, W = 3.0;
    dmb_pipe_def def = dmb_pipe_def_default();
    dmb_element_type type;
    double d[6], v[12] = {0.0}, a[12] = {0.0}, p[12], f[12];
    def.length = 2.0;
    dmb_element_type_of(&def, arm, 0.0, &type);
    dmb_element_make_curved(&def, &type);
    draw_shape(seed, def.length, angle, shear * angle, d);
    d[3] = 0.0;
    d[0] = def.length;
    v[3] = v[9] = W;
    dmb_element_inertia(&type, d, v, a, f);
    dmb_element_momentum(&type, d, v, v + 6, p, p + 6);
    const double bow = angle * def.length / 8.0, energy = 0.5 * W * (p[3] + p[9]);
    error[0] = largest(12, f) / (type.curved.mass * W * W * bow);
    error[1] = fabs(energy / (0.5 * W * W * type.curved.rotary[0]) - 1.0);
}

static void spin_about_the_bent_axis_has_no_inertia(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        const double shear = k < 2 ? 0.0 : 0.1;
        uint64_t coarse_seed = (uint64_t)(7 + k), fine_seed = coarse_seed;
        double coarse[2], fine[2];
        spin_errors(&coarse_seed, 0.2, shear, coarse);
        spin_errors(&fine_seed, 0.1, shear, fine);
        check_below("force of a spin, of that of the bow", fine[0], 5e-3);
        check_below("its fall with the bend", fine[0] / coarse[0], 0.3);
        check_below("energy of a spin, of the rotary one", fine[1], 5e-3);
        check_below("its fall with the bend", fine[1] / coarse[1], 0.1);
    }
}

/* ---- Definite ---------------------------------------------------------------------------------------------------- */

/* Pivots of Cholesky's factors, lengths over that of the element; the smallest over the smallest of the straight one.
 */
static double smallest_pivot(const dmb_element_type *type, const double d[6])
{
    double M[12][12], least = (double)INFINITY;
    for (int k = 0; k < 12; k++) {
        double v[12] = {0.0};
        v[k] = k % 6 < 3 ? 1.0 : 1.0 / type->length;
        dmb_element_momentum(type, d, v, v + 6, M[k], M[k] + 6);
        for (int i = 0; i < 12; i++) M[k][i] *= i % 6 < 3 ? 1.0 : 1.0 / type->length;
    }
    for (int k = 0; k < 12; k++) {
        least = fmin(least, M[k][k]);
        for (int i = k + 1; i < 12; i++)
            for (int j = i; j < 12; j++) M[i][j] -= M[k][i] * M[k][j] / M[k][k];
    }
    return least;
}

static void mass_is_positive_definite(void **state)
{
    uint64_t seed = 4;
    double least = (double)INFINITY;
    (void)state;
    for (int k = 0; k < 2000; k++) {
        dmb_element_type type;
        double d[6], straight[6] = {0.0};
        type_of(draw_between(&seed, 0.3, 3.0), draw_between(&seed, 0.01, 1.0), &type);
        straight[0] = type.length;
        draw_shape(&seed, type.length, draw_between(&seed, 0.0, 2.5), 0.3, d);
        least = fmin(least, smallest_pivot(&type, d) / smallest_pivot(&type, straight));
    }
    tell("smallest pivot of the mass, of the straight element's", least);
    assert_true(least > 0.1);
}

/* ---- Weight ------------------------------------------------------------------------------------------------------ */

/* With what the nodes carry, gravity is the force of inertia of an element that falls. */
static void a_free_one_falls_with_g(void **state)
{
    static const double gravity[3] = {1.0, -2.0, 3.0};
    uint64_t seed = 5;
    double worst = 0.0;
    (void)state;
    for (int k = 0; k < 200; k++) {
        dmb_element_type type;
        double d[6], R[9], x[3], v[12] = {0.0}, a[12] = {0.0}, f[12], w[12], sum = 0.0;
        const double unit[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
        type_of(draw_between(&seed, 0.3, 3.0), draw_between(&seed, 0.01, 1.0), &type);
        type.weight_mass = type.curved.mass;
        draw_shape(&seed, type.length, draw_between(&seed, 0.0, 2.5), 0.3, d);
        dmb_se3_exp(d, NULL, R, x);
        dmb_vec3_copy(gravity, a);
        dmb_mat3_tvec(R, gravity, a + 6);
        dmb_element_inertia(&type, d, v, a, f);
        dmb_element_bent_weight(&type, d, unit, gravity, w);
        for (int end = 0; end < 2; end++) {
            const double arm[3] = {(end ? -1.0 : 1.0) * type.length / 6.0, 0.0, 0.0};
            double moment[3];
            dmb_vec3_cross(arm, a + 6 * end, moment);
            for (int i = 0; i < 3; i++) {
                w[6 * end + i] += 0.5 * type.weight_mass * a[6 * end + i];
                w[6 * end + 3 + i] += 0.5 * type.weight_mass * moment[i];
            }
        }
        for (int i = 0; i < 12; i++) sum = fmax(sum, fabs(w[i] - f[i]));
        worst = fmax(worst, sum / largest(12, f));
    }
    check_below("weight less inertia of an element that falls", worst, 1e-13);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_straight_one_has_the_constant_mass),
        cmocka_unit_test(rigid_motion_has_the_momentum_of_slices),
        cmocka_unit_test(forces_are_those_of_lagrange),
        cmocka_unit_test(rate_of_the_middle),
        cmocka_unit_test(spin_about_the_bent_axis_has_no_inertia),
        cmocka_unit_test(mass_is_positive_definite),
        cmocka_unit_test(a_free_one_falls_with_g),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
