/* Between two nodes: the Timoshenko shapes for small bending, the exact arc for uniform curvature, motion as the time
 * derivative of the pose. */
#include "matrices.h"
#include "one_element.h"

static const double stations[] = {0.0, 0.1, 0.25, 0.5, 0.7, 0.9, 1.0};
enum { STATIONS = sizeof stations / sizeof stations[0] };

static const double large_a[6] = {0.02, -0.05, 0.03, 0.4, -0.3, 0.2}, large_b[6] = {-0.04, 0.06, 0.02, 0.7, 0.5, -0.6};

/* The ends of the flexible part are those of the nodes moved by their arms. */
static void ends_are_reproduced(void **state)
{
    (void)state;
    one_element o;
    one_element_make(&o, 1.3, 0.2, 0.35, 50.0);
    one_element_move(&o, 0, large_a);
    one_element_move(&o, 1, large_b);
    for (int end = 0; end < 2; end++) {
        const dmb_material_point fixed = {(uint32_t)end, 0, end ? -0.35 : 0.2, end, 0.0, 1, 0};
        const dmb_material_point_pose inner = one_element_pose(&o, end);
        dmb_material_point_pose outer;
        dmb_material_point_pose_of(&o.scene, &o.configuration, &fixed, &outer);
        for (int i = 0; i < 9; i++) CHECK_CLOSE(inner.rotation[i], outer.rotation[i], 4e-15);
        for (int i = 0; i < 3; i++) CHECK_CLOSE(inner.position[i], outer.position[i], 1e-14);
        for (int i = 0; i < 3; i++) CHECK_CLOSE(inner.displacement[i], outer.displacement[i], 4e-15);
    }
}

/* Undeformed and moved as one body: a straight line of points, no displacement at rest. */
static void rigid_motion_is_exact(void **state)
{
    (void)state;
    const double whole[6] = {0.5, -0.4, 0.3, 1.0, -2.0, 0.5};
    one_element o;
    one_element_make(&o, 1.3, 0.2, 0.35, 50.0);
    for (int i = 0; i < STATIONS; i++) {
        const dmb_material_point_pose pose = one_element_pose(&o, stations[i]);
        for (int k = 0; k < 3; k++) CHECK_CLOSE(pose.displacement[k], 0.0, 2e-16);
    }
    const double along[3] = {1.85, 0.0, 0.0};
    double far_place[3];
    one_element_move(&o, 0, whole);
    dmb_quat_copy(o.quaternion, o.quaternion + 4);
    dmb_quat_rotate(o.quaternion, along, far_place);
    for (int k = 0; k < 3; k++) o.displacement[3 + k] = o.displacement[k] + far_place[k] - o.span[k];
    for (int i = 0; i < STATIONS; i++) {
        const dmb_material_point_pose pose = one_element_pose(&o, stations[i]);
        const double arm[3] = {0.2 + 1.3 * stations[i], 0.0, 0.0};
        double want[3], R[9];
        dmb_quat_rotate(o.quaternion, arm, want);
        dmb_quat_to_matrix(o.quaternion, R);
        for (int k = 0; k < 9; k++) CHECK_CLOSE(pose.rotation[k], R[k], 2e-15);
        for (int k = 0; k < 3; k++)
            CHECK_CLOSE(pose.position[k], o.reference_position[k] + o.displacement[k] + want[k], 1e-14);
    }
}

/* N1 .. N4 and G1 .. G4 (eq:beam.shapes, eq:beam.section-pose) in both planes, linear along and about the axis, for
 * displacements of size 1e-7. */
static void small_bending_follows_the_cubic_shapes(void **state)
{
    (void)state;
    const double s = 1e-7, L = 1.3;
    const double a[6] = {0.3 * s, -0.7 * s, 0.4 * s, 0.9 * s, 0.5 * s, -0.2 * s};
    const double b[6] = {-0.6 * s, 0.8 * s, -0.1 * s, -0.4 * s, 0.3 * s, 0.6 * s};
    one_element o;
    one_element_make(&o, L, 0.0, 0.0, 8.0);
    one_element_move(&o, 0, a);
    one_element_move(&o, 1, b);
    for (int i = 0; i < STATIONS; i++) {
        const double x = stations[i];
        const dmb_material_point_pose pose = one_element_pose(&o, x);
        double u[3], Q[9], theta[3], R0[9];
        dmb_quat_to_matrix(o.reference_quaternion, R0);
        dmb_mat3_tvec(R0, pose.displacement, u);
        dmb_mat3_mul_tn(R0, pose.rotation, Q);
        log_of_rotation(Q, theta);
        CHECK_CLOSE(u[0], a[0] + x * (b[0] - a[0]), 1e-12);
        CHECK_CLOSE(theta[0], a[3] + x * (b[3] - a[3]), 1e-12);
        for (int plane = 0; plane < 2; plane++) {
            const double *K = o.type.strain_stiffness, sign = plane ? -1.0 : 1.0;
            const double P = 12.0 * K[5 - plane] / (K[1 + plane] * L * L), q = 1.0 / (1.0 + P), y = x * x, z = y * x;
            const double N[4] = {(1 - 3 * y + 2 * z + P * (1 - x)) * q, L * (x - 2 * y + z + P * (x - y) / 2) * q,
                                 (3 * y - 2 * z + P * x) * q, L * (-y + z - P * (x - y) / 2) * q};
            const double G[4] = {6 * (y - x) * q / L, (1 - 4 * x + 3 * y + P * (1 - x)) * q, -6 * (y - x) * q / L,
                                 (3 * y - 2 * x + P * x) * q};
            const double ends[4] = {a[1 + plane], sign * a[5 - plane], b[1 + plane], sign * b[5 - plane]};
            double want_u = 0.0, want_t = 0.0;
            for (int k = 0; k < 4; k++) want_u += N[k] * ends[k], want_t += G[k] * ends[k];
            CHECK_CLOSE(u[1 + plane], want_u, 1e-12);
            CHECK_CLOSE(sign * theta[5 - plane - 3], want_t, 1e-12);
        }
    }
}

/* A quarter of a circle in one element: every point lies on it. */
static void uniform_curvature_is_an_exact_arc(void **state)
{
    (void)state;
    const double L = 1.3, angle = 0.5 * DMB_PI, radius = L / angle;
    const double d[6] = {L, 0.0, 0.0, 0.0, 0.0, angle}, straight[6] = {-L, 0.0, 0.0, 0.0, 0.0, 0.0};
    one_element o;
    one_element_make(&o, L, 0.0, 0.0, 8.0);
    one_element_move(&o, 1, straight);
    one_element_move(&o, 1, d);
    for (int i = 0; i < STATIONS; i++) {
        const double turn = stations[i] * angle;
        const dmb_material_point_pose pose = one_element_pose(&o, stations[i]);
        double x[3], R0[9];
        dmb_vec3_sub(pose.position, o.reference_position, x);
        dmb_quat_to_matrix(o.reference_quaternion, R0);
        dmb_mat3_tvec(R0, x, x);
        CHECK_CLOSE(x[0], radius * sin(turn), 4e-15);
        CHECK_CLOSE(x[1], radius * (1.0 - cos(turn)), 4e-15);
        CHECK_CLOSE(x[2], 0.0, 4e-15);
    }
}

/* Both nodes move with a given velocity and acceleration in their own frames: pose at time t to third order. */
static void advance(one_element *o, double t)
{
    for (int n = 0; n < 2; n++) {
        double h[6];
        for (int i = 0; i < 6; i++) h[i] = t * o->velocity[6 * n + i] + 0.5 * t * t * o->acceleration[6 * n + i];
        one_element_move(o, n, h);
        for (int i = 0; i < 6; i++) o->velocity[6 * n + i] += t * o->acceleration[6 * n + i];
    }
}

static void moving(one_element *o)
{
    const double speeds[12] = {0.7, -0.4, 0.9, 1.5, -0.8, 0.6, -0.5, 0.3, 0.8, -0.9, 0.4, 1.2};
    one_element_make(o, 1.3, 0.2, 0.35, 8.0);
    one_element_move(o, 0, large_a);
    one_element_move(o, 1, large_b);
    for (int i = 0; i < 12; i++) o->velocity[i] = speeds[i], o->acceleration[i] = 0.7 * speeds[(i + 5) % 12] - 0.1;
}

/* Velocity from the pose by central differences: (R^T x', axial(R^T R')). */
static void velocity_is_the_derivative_of_pose(void **state)
{
    (void)state;
    const double t = 1e-4;
    one_element now, before, after;
    moving(&now);
    moving(&before), advance(&before, -t);
    moving(&after), advance(&after, t);
    for (int i = 0; i < STATIONS; i++) {
        const dmb_material_point_pose p0 = one_element_pose(&before, stations[i]),
                                      p1 = one_element_pose(&after, stations[i]);
        const dmb_material_point_pose p = one_element_pose(&now, stations[i]);
        const dmb_material_point_motion m = one_element_motion(&now, stations[i]);
        double dx[3], Q[9], O[3];
        dmb_vec3_sub(p1.displacement, p0.displacement, dx);
        dmb_mat3_tvec(p.rotation, dx, dx);
        dmb_mat3_mul_tn(p0.rotation, p1.rotation, Q);
        log_of_rotation(Q, O);
        for (int k = 0; k < 3; k++) CHECK_CLOSE(m.velocity[k], dx[k] / (2.0 * t), 1e-6);
        for (int k = 0; k < 3; k++) CHECK_CLOSE(m.velocity[3 + k], O[k] / (2.0 * t), 1e-6);
    }
}

/* Acceleration is the rate of the body-frame velocity. */
static void acceleration_is_the_derivative_of_velocity(void **state)
{
    (void)state;
    const double t = 1e-4;
    one_element now, before, after;
    moving(&now);
    moving(&before), advance(&before, -t);
    moving(&after), advance(&after, t);
    for (int i = 0; i < STATIONS; i++) {
        const dmb_material_point_motion m = one_element_motion(&now, stations[i]);
        const dmb_material_point_motion m0 = one_element_motion(&before, stations[i]),
                                        m1 = one_element_motion(&after, stations[i]);
        for (int k = 0; k < 6; k++) CHECK_CLOSE(m.acceleration[k], (m1.velocity[k] - m0.velocity[k]) / (2.0 * t), 1e-6);
    }
}

/* Inside a bent element that spins as one body about its own node, speeds are w x r. */
static void rigid_spin_of_a_bent_element(void **state)
{
    (void)state;
    one_element o;
    double Ra[9], Rb[9], R[9], w[3] = {1.3, -0.7, 2.1}, world[3], r[3], v[3];
    one_element_make(&o, 1.3, 0.0, 0.0, 8.0);
    one_element_move(&o, 0, large_a);
    one_element_move(&o, 1, large_b);
    dmb_quat_to_matrix(o.quaternion, Ra);
    dmb_quat_to_matrix(o.quaternion + 4, Rb);
    dmb_mat3_vec(Ra, w, world);
    dmb_vec3_copy(w, o.velocity + 3);
    dmb_mat3_tvec(Rb, world, o.velocity + 9);
    for (int k = 0; k < 3; k++) r[k] = o.span[k] + o.displacement[3 + k] - o.displacement[k];
    dmb_vec3_cross(world, r, v);
    dmb_mat3_tvec(Rb, v, o.velocity + 6);
    for (int i = 0; i < STATIONS; i++) {
        const dmb_material_point_pose p = one_element_pose(&o, stations[i]);
        const dmb_material_point_motion m = one_element_motion(&o, stations[i]);
        for (int k = 0; k < 3; k++) r[k] = p.position[k] - o.reference_position[k] - o.displacement[k];
        dmb_mat3_copy(p.rotation, R);
        dmb_vec3_cross(world, r, v);
        dmb_mat3_tvec(R, v, v);
        dmb_mat3_tvec(R, world, r);
        for (int k = 0; k < 3; k++) CHECK_CLOSE(m.velocity[k], v[k], 1e-14);
        for (int k = 0; k < 3; k++) CHECK_CLOSE(m.velocity[3 + k], r[k], 1e-14);
    }
}

static void turns_are_linear(void **state)
{
    (void)state;
    one_element o;
    one_element_make(&o, 1.0, 0.0, 0.0, 8.0);
    o.turn[0] = 628.0, o.turn[1] = 632.0;
    for (int i = 0; i < STATIONS; i++) {
        const dmb_material_point point = one_element_spot(stations[i]);
        CHECK_CLOSE(dmb_material_point_turn(&o.configuration, &point), 628.0 + 4.0 * stations[i], 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ends_are_reproduced),
        cmocka_unit_test(rigid_motion_is_exact),
        cmocka_unit_test(small_bending_follows_the_cubic_shapes),
        cmocka_unit_test(uniform_curvature_is_an_exact_arc),
        cmocka_unit_test(velocity_is_the_derivative_of_pose),
        cmocka_unit_test(acceleration_is_the_derivative_of_velocity),
        cmocka_unit_test(rigid_spin_of_a_bent_element),
        cmocka_unit_test(turns_are_linear),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
