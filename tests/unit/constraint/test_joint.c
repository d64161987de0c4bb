/* Rows of every kind of joint, of a locked joint, and the six coordinates: values against formulas, J against six-point
 * differences of the values along exp of a body-frame twist, JV and the tangent against differences of J. Checks
 * eq:joints.rows, eq:joints.rolling and eq:joints.coordinates. */
#include <string.h>

#include "check.h"

#include "constraint/joint.h"
#include "math/mat6.h"
#include "math/se3.h"

#define ROUNDS 60
#define STEP 2e-3
#define CLOSE 5e-11

typedef struct pose {
    double R[9], p[3];
} pose;

/* The functions that are differentiated: rows of a kind; of a joint locked at `at`; the coordinates. */
enum { LOCKED = DMB_JOINT_KINDS, COORDINATES = DMB_JOINT_KINDS + 1, ALL_KINDS = DMB_JOINT_KINDS + 2 };
typedef struct joint {
    int32_t kind;
    double length;
    pose at;
} joint;

static pose moved(const pose *at, double t, const double V[6])
{
    pose out;
    double h[6], R[9], x[3];
    for (int i = 0; i < 6; i++) h[i] = t * V[i];
    dmb_se3_exp(h, NULL, R, x);
    dmb_mat3_mul(at->R, R, out.R);
    dmb_mat3_vec(at->R, x, out.p);
    dmb_vec3_add(at->p, out.p, out.p);
    return out;
}

static void draw_n(uint64_t *seed, int n, double *out)
{
    for (int i = 0; i < n; i++) out[i] = draw_between(seed, -1.0, 1.0);
}

/* Anywhere, but for a lean of less than 0.3 on the x axis of b, where differences of rolling and angles go bad. */
static pose draw_pose(uint64_t *seed)
{
    const pose zero = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
    pose out;
    do {
        double h[6];
        draw_n(seed, 6, h);
        out = moved(&zero, 2.5, h);
    } while (hypot(out.R[1], out.R[2]) < 0.3 || hypot(out.R[4], out.R[5]) < 0.3 || dmb_vec3_norm(out.p) < 0.3);
    return out;
}

static void rows_at(const joint *j, const pose *at, const double V[6], dmb_joint_rows *rows)
{
    static const double near[2] = {0.0, 0.0};
    dmb_joint_coordinates c;
    memset(rows, 0, sizeof *rows);
    if (j->kind < DMB_JOINT_KINDS) {
        dmb_joint_rows_at(j->kind, j->length, at->R, at->p, V, rows);
    } else if (j->kind == LOCKED) {
        dmb_joint_locked_at(j->at.R, j->at.p, at->R, at->p, V, rows);
    } else {
        dmb_joint_coordinates_at(at->R, at->p, V, near, &c);
        rows->count = 6;
        rows->holonomic = 63;
        memcpy(rows->value, c.value, sizeof c.value);
        memcpy(rows->J, c.J, sizeof c.J);
        memcpy(rows->JV, c.JV, sizeof c.JV);
    }
}

static void tangent_at(const joint *j, const pose *at, const double f[6], double W[36])
{
    if (j->kind < DMB_JOINT_KINDS)
        dmb_joint_rows_tangent(j->kind, j->length, at->R, at->p, f, W);
    else if (j->kind == LOCKED)
        dmb_joint_locked_tangent(j->at.R, j->at.p, at->R, at->p, f, W);
    else
        dmb_joint_coordinates_tangent(at->R, at->p, f, W);
}

/* Rows at the six places of a difference along V */
static void rows_along(const joint *j, const pose *at, const double V[6], dmb_joint_rows rows[6])
{
    for (int k = 0; k < 6; k++) {
        const pose there = moved(at, STEP * difference6_place[k], V);
        rows_at(j, &there, V, &rows[k]);
    }
}

static double value_rate(const dmb_joint_rows rows[6], uint32_t row)
{
    double f[6];
    for (int k = 0; k < 6; k++) f[k] = rows[k].value[row];
    for (int k = 0; k < 6; k++) f[k] -= 2.0 * PI * round((f[k] - f[0]) / (2.0 * PI)); /* angles cross +-pi */
    return difference6(f, STEP);
}

static double J_rate(const dmb_joint_rows rows[6], uint32_t row, int i)
{
    double f[6];
    for (int k = 0; k < 6; k++) f[k] = rows[k].J[row][i];
    return difference6(f, STEP);
}

static joint draw_joint(uint64_t *seed, int32_t kind)
{
    const joint j = {kind, draw_between(seed, 0.2, 1.5), draw_pose(seed)};
    return j;
}

static void J_is_the_gradient_of_the_value(void **state)
{
    (void)state;
    for (int32_t kind = 0; kind < ALL_KINDS; kind++) {
        uint64_t seed = 71;
        double error = 0.0;
        for (int i = 0; i < ROUNDS; i++) {
            const joint j = draw_joint(&seed, kind);
            const pose at = draw_pose(&seed);
            double V[6];
            dmb_joint_rows here, there[6];
            draw_n(&seed, 6, V);
            rows_at(&j, &at, V, &here);
            rows_along(&j, &at, V, there);
            for (uint32_t k = 0; k < here.count; k++) {
                if ((here.holonomic >> k & 1U) != 0)
                    error = fmax(error, fabs(value_rate(there, k) - dmb_vec6_dot(here.J[k], V)));
                else
                    assert_true(here.value[k] == 0.0);
            }
        }
        print_message("    kind %2d ", (int)kind);
        check_below("J against differences of the value", error, CLOSE);
    }
}

/* JV along V, and W column by column */
static void derivatives_of_J(void **state)
{
    (void)state;
    for (int32_t kind = 0; kind < ALL_KINDS; kind++) {
        uint64_t seed = 72;
        double rate_error = 0.0, tangent_error = 0.0;
        for (int i = 0; i < ROUNDS; i++) {
            const joint j = draw_joint(&seed, kind);
            const pose at = draw_pose(&seed);
            double V[6], f[6], W[36], change[6] = {0.0}, along[6];
            dmb_joint_rows here, there[6];
            draw_n(&seed, 6, V);
            draw_n(&seed, 6, f);
            rows_at(&j, &at, V, &here);
            rows_along(&j, &at, V, there);
            tangent_at(&j, &at, f, W);
            for (uint32_t k = 0; k < here.count; k++)
                for (int c = 0; c < 6; c++) {
                    const double rate = J_rate(there, k, c);
                    rate_error = fmax(rate_error, fabs(rate - here.JV[k][c]));
                    change[c] += f[k] * rate;
                }
            dmb_mat6_vec(W, V, along);
            tangent_error = fmax(tangent_error, largest_difference(6, change, along));
        }
        print_message("    kind %2d ", (int)kind);
        check_below("JV against differences of J", rate_error, CLOSE);
        print_message("    kind %2d ", (int)kind);
        check_below("tangent against differences of J^T f", tangent_error, CLOSE);
    }
}

/* ---- kinds ---- */

static void product(const double A[9], const double B[9], double out[9])
{
    double C[9];
    dmb_mat3_mul(A, B, C);
    dmb_mat3_copy(C, out);
}

/* The pose of six coordinates: R = Ry Rz Rx */
static pose pose_of(const double c[6])
{
    const double x[3] = {c[3], 0, 0}, y[3] = {0, c[4], 0}, z[3] = {0, 0, c[5]};
    double X[9], Z[9];
    pose out = {{0}, {c[0], c[1], c[2]}};
    dmb_so3_exp(x, NULL, X);
    dmb_so3_exp(z, NULL, Z);
    dmb_so3_exp(y, NULL, out.R);
    product(out.R, Z, out.R);
    product(out.R, X, out.R);
    return out;
}

static double largest_value(const dmb_joint_rows *rows)
{
    return largest(rows->count, rows->value);
}

/* A joint that keeps frames parallel or points on lines holds just what is not free. */
static void rows_hold_what_is_not_free(void **state)
{
    static const double still[6] = {0.0};
    uint64_t seed = 73;
    (void)state;
    for (int32_t kind = DMB_JOINT_FIXED; kind < DMB_JOINT_KINDS; kind++) {
        if (kind > DMB_JOINT_POINT_ON_LINE && kind < DMB_JOINT_TRANSLATIONAL) continue; /* of other rows */
        const uint32_t free = dmb_joint_free_mask(kind);
        dmb_joint_rows rows;
        for (int i = 0; i < ROUNDS; i++) {
            double c[6];
            uint32_t degrees_of_freedom = 0;
            for (int k = 0; k < 6; k++) c[k] = (free >> k & 1U) != 0 ? draw_between(&seed, -1.4, 1.4) : 0.0;
            for (int k = 0; k < 6; k++) degrees_of_freedom += free >> k & 1U;
            const pose good = pose_of(c);
            dmb_joint_rows_at(kind, 1.0, good.R, good.p, still, &rows);
            assert_int_equal(rows.count, dmb_joint_row_count(kind));
            assert_int_equal(rows.count, 6 - degrees_of_freedom);
            assert_int_equal(rows.holonomic, (1U << rows.count) - 1U);
            if (rows.count > 0) assert_true(largest_value(&rows) < 1e-15);
            for (int k = 0; k < 6; k++) { /* any other coordinate is felt */
                if ((free >> k & 1U) != 0) continue;
                double off[6];
                memcpy(off, c, sizeof off);
                off[k] = 0.01;
                const pose bad = pose_of(off);
                dmb_joint_rows_at(kind, 1.0, bad.R, bad.p, still, &rows);
                assert_true(largest_value(&rows) > 0.001);
            }
        }
    }
}

static void counts_and_masks(void **state)
{
    static const uint32_t count[] = {6, 5, 5, 4, 4, 3, 3, 2, 2, 1, 0, 1, 3, 3, 4, 2};
    static const uint32_t mask[] = {0, 8, 1, 9, 48, 56, 14, 57, 0, 63, 63, 63, 63, 7, 6, 15};
    static const double still[6] = {0.0};
    uint64_t seed = 74;
    (void)state;
    for (int32_t kind = 0; kind < DMB_JOINT_KINDS; kind++) {
        const pose at = draw_pose(&seed);
        dmb_joint_rows rows;
        dmb_joint_rows_at(kind, 0.7, at.R, at.p, still, &rows);
        assert_int_equal(dmb_joint_row_count(kind), count[kind]);
        assert_int_equal(dmb_joint_free_mask(kind), mask[kind]);
        assert_int_equal(rows.count, count[kind]);
        if (kind == DMB_JOINT_ROLLING) assert_int_equal(rows.holonomic, 1);
        if (kind == DMB_JOINT_KNIFE_EDGE) assert_int_equal(rows.holonomic, 0);
        if (kind == DMB_JOINT_DISTANCE) check_close("distance", rows.value[0], dmb_vec3_norm(at.p) - 0.7, 1e-15);
    }
}

/* Ends that meet have no direction; the blade slides along its edge and not across. */
static void distance_of_zero_and_knife_edge(void **state)
{
    static const double V[6] = {1, 2, 3, 4, 5, 6}, zero[3] = {0, 0, 0};
    uint64_t seed = 75;
    const pose at = draw_pose(&seed);
    dmb_joint_rows rows;
    (void)state;
    dmb_joint_rows_at(DMB_JOINT_DISTANCE, 2.0, at.R, zero, V, &rows);
    assert_true(rows.value[0] == -2.0 && largest(6, rows.J[0]) == 0.0 && largest(6, rows.JV[0]) == 0.0);
    dmb_joint_rows_at(DMB_JOINT_KNIFE_EDGE, 1.0, at.R, at.p, V, &rows);
    assert_true(rows.value[0] == 0.0 && dmb_vec6_dot(rows.J[0], V) == V[1] && largest(6, rows.JV[0]) == 0.0);
}

/* Locked rows are those of FIXED for b turned back by R0 and moved by p0, and vanish at (R0, p0). */
static void locked_is_fixed_elsewhere(void **state)
{
    uint64_t seed = 76;
    double error = 0.0, rest = 0.0;
    (void)state;
    for (int i = 0; i < ROUNDS; i++) {
        const pose at0 = draw_pose(&seed), at = draw_pose(&seed);
        static const double still[6] = {0.0};
        double R[9], p[3];
        dmb_joint_rows locked, fixed;
        dmb_mat3_mul_nt(at.R, at0.R, R);
        dmb_vec3_sub(at.p, at0.p, p);
        dmb_joint_locked_at(at0.R, at0.p, at.R, at.p, still, &locked);
        dmb_joint_rows_at(DMB_JOINT_FIXED, 1.0, R, p, still, &fixed);
        assert_true(locked.count == 6 && locked.holonomic == 63);
        error = fmax(error, largest_difference(6, locked.value, fixed.value));
        dmb_joint_locked_at(at0.R, at0.p, at0.R, at0.p, still, &locked);
        rest = fmax(rest, largest(6, locked.value));
    }
    check_below("locked against fixed", error, 5e-15);
    check_below("locked where it is locked", rest, 5e-15);
}

/* ---- rolling ---- */

/* Lowest of points of the rim, in b: the one with least height of all, found by trial. */
static double lowest_height(const pose *at, double r, double point[3])
{
    double least = 1e300;
    for (int i = 0; i < 200000; i++) {
        const double angle = 2.0 * PI * i / 200000;
        const double c[3] = {0.0, r * cos(angle), r * sin(angle)};
        const double height = at->p[0] + dmb_vec3_dot(at->R, c);
        if (height < least) dmb_vec3_copy(c, point);
        least = fmin(least, height);
    }
    return least;
}

/* The value is the height of the lowest point; rows times V are its velocity upwards, along the way of the rim
 * (x axis of b) x e_x, and along the shadow of the x axis of b on the plane. */
static void rolling_rows_are_the_velocity_at_the_lowest_point(void **state)
{
    uint64_t seed = 77;
    double height_error = 0.0, speed_error = 0.0;
    (void)state;
    for (int i = 0; i < 12; i++) {
        const pose at = draw_pose(&seed);
        const double r = draw_between(&seed, 0.2, 2.0), shadow = hypot(at.R[3], at.R[6]);
        double V[6], c[3] = {0.0}, v[3], speed[3], got[3];
        dmb_joint_rows rows;
        draw_n(&seed, 6, V);
        dmb_joint_rows_at(DMB_JOINT_ROLLING, r, at.R, at.p, V, &rows);
        height_error = fmax(height_error, fabs(lowest_height(&at, r, c) - rows.value[0]));
        dmb_vec3_cross(V + 3, c, v);
        dmb_vec3_add(V, v, v);
        dmb_mat3_vec(at.R, v, v); /* in axes of a */
        dmb_vec3_set(v[0], (v[1] * at.R[6] - v[2] * at.R[3]) / shadow, (v[1] * at.R[3] + v[2] * at.R[6]) / shadow,
                     speed);
        for (int k = 0; k < 3; k++) got[k] = dmb_vec6_dot(rows.J[k], V);
        speed_error = fmax(speed_error, largest_difference(3, got, speed));
    }
    check_below("height of the lowest point", height_error, 1e-8);
    check_below("velocity of the lowest point", speed_error, 2e-4); /* the trial's step of angle */
}

static double slip(const pose *at, double r, const double V[6], double rows_times_V[3])
{
    dmb_joint_rows rows;
    dmb_joint_rows_at(DMB_JOINT_ROLLING, r, at->R, at->p, V, &rows);
    for (int k = 0; k < 3; k++) rows_times_V[k] = dmb_vec6_dot(rows.J[k], V);
    return largest(3, rows_times_V);
}

/* An upright disc, its axis along y of a, its z axis up: spin w_x takes it along -y of b, along t. Spinning on the
 * material_point about the normal does not slip either; sliding along and across does, and is told apart. */
static void upright_disc(void **state)
{
    const double r = 0.4;
    const pose at = {{0, 0, 1, 1, 0, 0, 0, 1, 0}, {0.4, 3.0, -2.0}};
    const double rolls[6] = {0, -0.4 * 5.0, 0, 5.0, 0, 0}, pivots[6] = {0, 0, 0, 0, 0, 2.0};
    const double slides[6] = {0, -1.0, 0, 0, 0, 0}, skids[6] = {1.0, 0, 0, 0, 0, 0}, lifts[6] = {0, 0, 1.0, 0, 0, 0};
    dmb_joint_rows rows;
    double s[3];
    (void)state;
    dmb_joint_rows_at(DMB_JOINT_ROLLING, r, at.R, at.p, rolls, &rows);
    check_below("stands on the plane", rows.value[0], 1e-15);
    check_below("rolls", slip(&at, r, rolls, s), 1e-15);
    check_below("pivots", slip(&at, r, pivots, s), 1e-15);
    assert_true(slip(&at, r, slides, s) == 1.0 && s[1] == 1.0 && s[2] == 0.0);
    assert_true(slip(&at, r, skids, s) == 1.0 && s[2] == 1.0 && s[1] == 0.0);
    assert_true(slip(&at, r, lifts, s) == 1.0 && s[0] == 1.0);
}

/* Without slip a disc turns about its lowest point, u = -w x r m, whatever w: the rows allow that motion, and it keeps
 * the rim on the plane. */
static void rolling_stays_on_the_plane(void **state)
{
    const double r = 0.5, h = 1e-3;
    pose at = {{0, 0, 1, 1, 0, 0, 0, 1, 0}, {0.5, 0.0, 0.0}};
    const double lean_over[6] = {0, 0, 0, 0, 0.7, 0};
    double drift = 0.0, slipping = 0.0;
    (void)state;
    at = moved(&at, 1.0, lean_over);
    at.p[0] = r * hypot(at.R[1], at.R[2]);
    for (int i = 0; i < 3000; i++) {
        const double w[3] = {3.0 + sin(1e-3 * i), 0.3 * cos(2e-3 * i), 0.8};
        double V[6] = {0.0}, s[3];
        pose middle = at;
        for (int pass = 0; pass < 2; pass++) { /* midpoint rule */
            const double length = hypot(middle.R[1], middle.R[2]);
            const double lowest[3] = {0.0, -r * middle.R[1] / length, -r * middle.R[2] / length};
            dmb_vec3_cross(lowest, w, V);
            dmb_vec3_copy(w, V + 3);
            slipping = fmax(slipping, slip(&middle, r, V, s));
            middle = moved(&at, 0.5 * h, V);
        }
        at = moved(&at, h, V);
        drift = fmax(drift, fabs(at.p[0] - r * hypot(at.R[1], at.R[2])));
    }
    check_below("slip of a rim turning about its lowest point", slipping, 1e-14);
    check_below("drift off the plane", drift, 1e-6);
    assert_true(hypot(at.R[1], at.R[2]) > 0.1 && hypot(at.p[1], at.p[2]) > 0.1);
}

/* A rim lying flat touches everywhere: it may slide, and lies at the height of the plane. */
static void rim_lying_flat(void **state)
{
    static const double V[6] = {1, 2, 3, 4, 5, 6};
    const pose at = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.25, 0.0, 0.0}};
    const double f[3] = {1, 2, 3};
    dmb_joint_rows rows;
    double W[36];
    (void)state;
    dmb_joint_rows_at(DMB_JOINT_ROLLING, 0.5, at.R, at.p, V, &rows);
    assert_true(rows.count == 3 && rows.value[0] == 0.25 && rows.J[0][0] == 1.0);
    assert_true(largest(12, rows.J[1]) == 0.0 && largest(12, rows.JV[1]) == 0.0 && largest(5, rows.J[0] + 1) == 0.0);
    dmb_joint_rows_tangent(DMB_JOINT_ROLLING, 0.5, at.R, at.p, f, W);
    assert_true(isfinite(largest(36, W)));
}

/* ---- coordinates ---- */

static void coordinates_come_back(void **state)
{
    static const double still[6] = {0.0};
    uint64_t seed = 78;
    double error = 0.0;
    (void)state;
    for (int i = 0; i < 20 * ROUNDS; i++) {
        double c[6];
        dmb_joint_coordinates got;
        draw_n(&seed, 3, c);
        c[3] = draw_between(&seed, -30.0, 30.0);
        c[4] = draw_between(&seed, -30.0, 30.0);
        c[5] = draw_between(&seed, -1.5, 1.5);
        const pose at = pose_of(c);
        const double near[2] = {c[3] + draw_between(&seed, -3.1, 3.1), c[4] + draw_between(&seed, -3.1, 3.1)};
        dmb_joint_coordinates_at(at.R, at.p, still, near, &got);
        error = fmax(error, largest_difference(6, got.value, c));
    }
    check_below("coordinates of the pose of coordinates", error, 1e-13);
}

/* Turning on and on, each turn told from the one before. */
static void angles_keep_their_turns(void **state)
{
    static const double still[6] = {0.0};
    double near[2] = {0.0, 0.0}, error = 0.0;
    (void)state;
    for (int i = 0; i <= 400; i++) {
        const double c[6] = {0, 0, 0, 0.3 * i, -0.2 * i, 0.4};
        const pose at = pose_of(c);
        dmb_joint_coordinates got;
        dmb_joint_coordinates_at(at.R, at.p, still, near, &got);
        error = fmax(error, fmax(fabs(got.value[3] - c[3]), fabs(got.value[4] - c[4])));
        near[0] = got.value[3];
        near[1] = got.value[4];
    }
    check_below("19 and 12 revolutions", error, 1e-11);
}

/* At a right angle RZ keeps its value, RX and RY stay where they were, and no gradient is infinite. */
static void right_angle(void **state)
{
    static const double V[6] = {1, 2, 3, 4, 5, 6}, near[2] = {0.5, 7.0};
    (void)state;
    for (int side = -1; side <= 1; side += 2) {
        const double c[6] = {1, 2, 3, 0.1, 0.2, side * PI / 2};
        const pose at = pose_of(c);
        dmb_joint_coordinates got;
        dmb_joint_coordinates_at(at.R, at.p, V, near, &got);
        check_close("RZ", got.value[5], side * PI / 2, 1e-15);
        assert_true(got.value[3] == near[0] && got.value[4] == near[1]);
        assert_true(largest(18, got.J[3]) == 0.0 && largest(18, got.JV[3]) == 0.0);
        assert_true(largest(18, got.J[0]) > 0.1);
    }
}

/* ---- flipped frames ---- */

/* Rows of position that are satisfied */
static int fits(int32_t kind, const pose *at)
{
    static const double still[6] = {0.0};
    dmb_joint_rows rows;
    dmb_joint_rows_at(kind, 1.0, at->R, at->p, still, &rows);
    return largest_value(&rows) < 1e-12;
}

/* Half turns about z (x points back), about x (y points back), y: of the kinds that hold frames parallel the rows are
 * satisfied there, and only the flip tells. */
static void half_turns_are_flips(void **state)
{
    const double about[3][6] = {{0, 0, 0, PI, 0, 0}, {0, 0, 0, 0, PI, 0}, {0, 0, 0, 0, 0, PI}};
    (void)state;
    for (int32_t kind = DMB_JOINT_FIXED; kind < DMB_JOINT_KINDS; kind++) {
        const uint32_t free = dmb_joint_free_mask(kind);
        const int keeps_x = (free & 48U) == 0 && kind != DMB_JOINT_POINT_ON_HOLE;
        const int keeps_y = (free & 56U) == 0 && kind != DMB_JOINT_POINT_ON_HOLE;
        for (int i = 0; i < 3; i++) {
            const pose at = pose_of(about[i]);
            const int flipped = i == 0 ? keeps_y : keeps_x;
            const double angle = dmb_joint_flip(kind, at.R);
            if (flipped) assert_true(fits(kind, &at) && fabs(angle - PI) < 1e-12);
            if (!flipped) assert_true(angle == 0.0);
        }
    }
    assert_true(dmb_joint_flip(DMB_JOINT_UNIVERSAL, pose_of(about[1]).R) == 0.0);
}

/* From a right angle on; and never where the rows hold and the free coordinates are anything. */
static void flips_begin_at_a_right_angle(void **state)
{
    uint64_t seed = 79;
    (void)state;
    for (int32_t kind = DMB_JOINT_FIXED; kind < DMB_JOINT_KINDS; kind++) {
        const uint32_t free = dmb_joint_free_mask(kind);
        for (int i = 0; i < ROUNDS; i++) {
            double c[6];
            for (int k = 0; k < 6; k++) c[k] = (free >> k & 1U) != 0 ? draw_between(&seed, -3.0, 3.0) : 0.0;
            assert_true(dmb_joint_flip(kind, pose_of(c).R) == 0.0);
        }
    }
    for (int i = 1; i < 180; i++) {
        const double x[6] = {0, 0, 0, i * PI / 180.0, 0, 0}, z[6] = {0, 0, 0, 0, i * PI / 180.0, 0};
        if (i == 90) continue;
        const double want = i < 90 ? 0.0 : i * PI / 180.0;
        assert_true(fabs(dmb_joint_flip(DMB_JOINT_FIXED, pose_of(x).R) - want) < 1e-12);
        assert_true(fabs(dmb_joint_flip(DMB_JOINT_REVOLUTE, pose_of(z).R) - want) < 1e-12);
        assert_true(dmb_joint_flip(DMB_JOINT_REVOLUTE, pose_of(x).R) == 0.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(J_is_the_gradient_of_the_value),
        cmocka_unit_test(derivatives_of_J),
        cmocka_unit_test(rows_hold_what_is_not_free),
        cmocka_unit_test(counts_and_masks),
        cmocka_unit_test(distance_of_zero_and_knife_edge),
        cmocka_unit_test(locked_is_fixed_elsewhere),
        cmocka_unit_test(rolling_rows_are_the_velocity_at_the_lowest_point),
        cmocka_unit_test(upright_disc),
        cmocka_unit_test(rolling_stays_on_the_plane),
        cmocka_unit_test(rim_lying_flat),
        cmocka_unit_test(coordinates_come_back),
        cmocka_unit_test(angles_keep_their_turns),
        cmocka_unit_test(right_angle),
        cmocka_unit_test(half_turns_are_flips),
        cmocka_unit_test(flips_begin_at_a_right_angle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
