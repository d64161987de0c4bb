/* The hole's axis: minimum curvature against known curves, frames, and projection. Equations: eq:hole.tangent,
 * eq:hole.arc, eq:hole.project, eq:hole.carried. */
#include "force/hole.h"

#include "force_test.h"

#define DEG (PI / 180.0)

static const double at_origin[3] = {0, 0, 0};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double distance(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};

    return sqrt(dot(d, d));
}

static dmb_hole surveyed(uint32_t n, const double *survey, dmb_hole_station *storage)
{
    dmb_hole hole;

    memset(&hole, 0, sizeof hole);
    assert_int_equal(dmb_hole_setup_survey(&hole, n, survey, at_origin, 0.047, storage), -1);
    return hole;
}

/* A winding hole of n stations, with straight pieces in it; starts at depth 7. */
enum { WINDING = 40 };
static dmb_hole winding(dmb_hole_station storage[WINDING])
{
    double survey[3 * WINDING];
    uint64_t seed = 2024;

    for (int i = 0; i < WINDING; ++i) {
        const int held = i % 7 == 3; /* straight to here */
        survey[3 * i] = i == 0 ? 7.0 : survey[3 * i - 3] + draw(&seed, 5, 30);
        survey[3 * i + 1] = held ? survey[3 * i - 2] : (70 + 20 * sin(0.3 * i)) * DEG + draw(&seed, -0.05, 0.05);
        survey[3 * i + 2] = held ? survey[3 * i - 1] : 0.02 * i + draw(&seed, -0.05, 0.05);
    }
    return surveyed(WINDING, survey, storage);
}

static void straight_hole(void **state)
{
    const double origin[3] = {1, 2, 3}, along_x[3] = {250, 0, 0}, tiny[3] = {3e-200, 0, 4e-200};
    const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double x[3], t[3], curvature[3], R[9], s;
    dmb_hole hole;
    uint32_t segment = 77;
    (void)state;

    assert_int_equal(dmb_hole_setup_straight(&hole, origin, along_x, 0.047), DMB_OK);
    assert_true(dmb_hole_is_straight(&hole) && hole.radius == 0.047);
    dmb_hole_frame(&hole, 10, x, t, curvature);
    assert_true(x[0] == 11 && x[1] == 2 && x[2] == 3 && t[0] == 1 && t[1] == 0 && t[2] == 0);
    assert_true(curvature[0] == 0 && curvature[1] == 0 && curvature[2] == 0);
    dmb_hole_frame_rotation(&hole, 10, R);
    assert_memory_equal(R, identity, sizeof R);
    const double off[3] = {5, 2.5, 3.25};
    dmb_hole_project(&hole, off, &s, &segment, x, t);
    assert_true(s == 4 && segment == 0 && x[0] == 5 && x[1] == 2 && x[2] == 3 && t[0] == 1);
    assert_int_equal(dmb_hole_setup_straight(&hole, origin, tiny, 0.047), DMB_OK);
    CHECK_CLOSE(hole.direction[0], 0.6, 1e-15);
    CHECK_CLOSE(hole.direction[2], 0.8, 1e-15);
}

static void refusals(void **state)
{
    const double zero[3] = {0, 0, 0}, bad[3] = {1, (double)NAN, 0}, x[3] = {1, 0, 0};
    dmb_hole_station storage[4];
    dmb_hole hole, before;
    (void)state;

    assert_int_equal(dmb_hole_setup_straight(&hole, zero, x, 0.05), DMB_OK);
    before = hole;
    assert_int_equal(dmb_hole_setup_straight(&hole, zero, zero, 0.05), DMB_ERR_VALUE);
    assert_int_equal(dmb_hole_setup_straight(&hole, bad, x, 0.05), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_hole_setup_straight(&hole, zero, bad, 0.05), DMB_ERR_NOT_FINITE);
    for (int k = 0; k < 3; ++k) {
        double off[3] = {0, 0, 0}, way[3] = {1, 0, 0};
        off[k] = way[k] = (double)INFINITY;
        assert_int_equal(dmb_hole_setup_straight(&hole, off, x, 0.05), DMB_ERR_NOT_FINITE);
        assert_int_equal(dmb_hole_setup_straight(&hole, zero, way, 0.05), DMB_ERR_NOT_FINITE);
    }
    assert_int_equal(dmb_hole_setup_straight(&hole, zero, x, (double)NAN), DMB_ERR_NOT_FINITE);
    const double survey[4][12] = {{0, 1, 0, 10, 1, 0, 10, 1, 0, 30, 1, 0},
                                  {0, 1, 0, 10, 1, (double)NAN, 20, 1, 0, 30, 1, 0},
                                  {0, 1, 0, 10, 1, 0, 20, 1, 0, 30, 1 + 2.51, 0},
                                  {(double)INFINITY, 1, 0, 10, 1, 0, 20, 1, 0, 30, 1, 0}};
    const int expected[4] = {2, 1, 3, 0};
    for (int i = 0; i < 4; ++i)
        assert_int_equal(dmb_hole_setup_survey(&hole, 4, survey[i], zero, 0.05, storage), expected[i]);
    assert_int_equal(dmb_hole_setup_survey(&hole, 1, survey[2], zero, 0.05, storage), 0);
    assert_int_equal(dmb_hole_setup_survey(&hole, 3, survey[2], bad, 0.05, storage), 0);
    assert_int_equal(dmb_hole_setup_survey(&hole, 3, survey[2], zero, (double)INFINITY, storage), 0);
    assert_memory_equal(&hole, &before, sizeof hole);
    const double sharp[6] = {0, 1, 0, 10, 1 + 2.49, 0};
    assert_int_equal(dmb_hole_setup_survey(&hole, 2, sharp, zero, 0.05, storage), -1);
}

/* R' = (t x dt/ds)^ R: no turning about the tangent, also where the hole passes the vertical. */
static void carried_frame_does_not_twist(void **state)
{
    dmb_hole_station storage[WINDING], drop[3];
    const double survey[9] = {0, 10 * DEG, 0, 100, 10 * DEG, PI, 160, 30 * DEG, PI};
    const dmb_hole holes[2] = {winding(storage), surveyed(3, survey, drop)};
    (void)state;

    for (int i = 0; i < 2; ++i)
        for (double s = 8.0; s < 150.0; s += 0.37) {
            const double h = 1e-4;
            double x[3], t[3], k[3], w[3], a[9], b[9], R[9];
            dmb_hole_frame(&holes[i], s, x, t, k);
            dmb_vec3_cross(t, k, w);
            dmb_hole_carried_rotation(&holes[i], s - h, a);
            dmb_hole_carried_rotation(&holes[i], s, R);
            dmb_hole_carried_rotation(&holes[i], s + h, b);
            for (int c = 0; c < 3; ++c) {
                const double v[3] = {R[c], R[3 + c], R[6 + c]};
                double rate[3];
                dmb_vec3_cross(w, v, rate);
                CHECK_CLOSE(R[3 * c], t[c], 1e-14);
                CHECK_CLOSE(dot(v, v), 1, 1e-13);
                for (int r = 0; r < 3; ++r) /* the curvature jumps at stations */
                    CHECK_CLOSE((b[3 * r + c] - a[3 * r + c]) / (2 * h), rate[r], 1e-2);
            }
        }
}

/* Every minimum of the distance is found, and the one that is asked for is taken. */
static void places_are_searched(void **state)
{
    enum { LOOP = 38 };
    dmb_hole_station storage[LOOP];
    double survey[3 * LOOP], x[3], t[3], s;
    (void)state;
    for (int i = 0; i < LOOP; ++i) { /* a full circle of radius 100/(10 DEG) and on */
        survey[3 * i] = 100.0 * i;
        survey[3 * i + 1] = 90 * DEG;
        survey[3 * i + 2] = 10 * DEG * (i < 37 ? i : 36);
    }
    const dmb_hole hole = surveyed(LOOP, survey, storage);
    dmb_hole_frame(&hole, 0.0, x, t, NULL);
    assert_int_equal(dmb_hole_search(&hole, x, 10.0, 500.0, NULL, &s), 0);
    CHECK_CLOSE(s, 0, 1e-9);
    assert_int_equal(dmb_hole_search(&hole, x, 3500.0, 500.0, NULL, &s) >= 35, 1);
    CHECK_CLOSE(s, 3600, 1e-9);
    for (double at = 50.0; at < 3600.0; at += 333.0) {
        dmb_hole_frame(&hole, at, x, t, NULL);
        (void)dmb_hole_search(&hole, x, 0.0, (double)INFINITY, t, &s);
        CHECK_CLOSE(s, at, 1e-9);
    }
    dmb_hole_frame(&hole, 1800.0, x, t, NULL);
    x[0] *= 1.5, x[1] *= 1.5;
    uint32_t feet = 0;
    for (uint32_t arc = dmb_hole_next_foot(&hole, x, 0); arc < LOOP; arc = dmb_hole_next_foot(&hole, x, arc + 1))
        feet++;
    assert_in_range(feet, 1, 3);
}

/* Angles mean what the header says (eq:kinematics.hole-tangent); a survey without bends is the straight hole. */
static void directions(void **state)
{
    dmb_hole_station storage[3];
    const double level[9] = {5, 90 * DEG, 0, 15, 90 * DEG, 0, 55, 90 * DEG, 0};
    const double east[6] = {0, 60 * DEG, 90 * DEG, 10, 60 * DEG, 90 * DEG};
    double x[3], t[3], s;
    uint32_t segment = 0;
    dmb_hole hole = surveyed(3, level, storage);
    (void)state;

    assert_true(dmb_hole_is_straight(&hole));
    dmb_hole_frame(&hole, 25, x, t, NULL);
    CHECK_CLOSE(x[0], 20, 1e-14);
    CHECK_CLOSE(x[2], 0, 1e-14);
    dmb_hole_project(&hole, x, &s, &segment, x, t);
    CHECK_CLOSE(s, 25, 1e-14);
    hole = surveyed(2, east, storage);
    CHECK_CLOSE(hole.direction[0], 0, 1e-15);
    CHECK_CLOSE(hole.direction[1], -sin(60 * DEG), 1e-15); /* y is west */
    CHECK_CLOSE(hole.direction[2], -cos(60 * DEG), 1e-15);
}

/* Constant build-up: from vertical to horizontal at 3 deg per 10 m is a quarter of a circle of R = 600/pi m. */
static void constant_dogleg_is_a_circle(void **state)
{
    double survey[3 * 31];
    dmb_hole_station storage[31];
    const double R = 600 / PI, azimuth = 0.7;
    const double outwards[3] = {cos(azimuth), -sin(azimuth), 0};
    const double centre[3] = {R * outwards[0], R * outwards[1], 0};
    (void)state;

    for (int i = 0; i < 31; ++i) {
        survey[3 * i] = 10.0 * i;
        survey[3 * i + 1] = 3 * DEG * i;
        survey[3 * i + 2] = azimuth;
    }
    const dmb_hole hole = surveyed(31, survey, storage);
    assert_false(dmb_hole_is_straight(&hole));
    for (double s = 0; s <= 300; s += 0.37) {
        double x[3], t[3], curvature[3];
        const double angle = s / R;
        dmb_hole_frame(&hole, s, x, t, curvature);
        const double exact[3] = {R * (1 - cos(angle)) * outwards[0], R * (1 - cos(angle)) * outwards[1],
                                 -R * sin(angle)};
        const double to_centre[3] = {(centre[0] - x[0]) / (R * R), (centre[1] - x[1]) / (R * R),
                                     (centre[2] - x[2]) / (R * R)};
        CHECK_CLOSE(distance(x, exact), 0, 1e-12);
        CHECK_CLOSE(distance(x, centre), R, 1e-12);
        CHECK_CLOSE(distance(curvature, to_centre), 0, 1e-15);
        CHECK_CLOSE(dot(t, curvature), 0, 1e-17);
    }
}

/* A published hand calculation: 3500 to 3600 ft, inclination 15 to 25 deg, azimuth 20 to 45 deg gives north 27.22,
 * east 19.45, down 94.01 ft. */
static void textbook_station(void **state)
{
    const double survey[6] = {3500, 15 * DEG, 20 * DEG, 3600, 25 * DEG, 45 * DEG};
    dmb_hole_station storage[2];
    const dmb_hole hole = surveyed(2, survey, storage);
    double x[3];
    (void)state;

    dmb_hole_frame(&hole, 3600, x, NULL, NULL);
    CHECK_CLOSE(x[0], 27.22, 0.005);
    CHECK_CLOSE(x[1], -19.45, 0.005);
    CHECK_CLOSE(x[2], -94.01, 0.005);
}

/* x' = t, t' = curvature, unit tangent, nothing jumps at a station, ends extend straight. */
static void frames_of_a_winding_hole(void **state)
{
    dmb_hole_station storage[WINDING];
    const dmb_hole hole = winding(storage);
    const double end = storage[WINDING - 1].depth;
    (void)state;

    for (double s = -20; s < end + 30; s += 0.731) {
        double x[3], t[3], curvature[3], xa[3], ta[3], xb[3], tb[3];
        const double h = 1e-5;
        dmb_hole_frame(&hole, s, x, t, curvature);
        dmb_hole_frame(&hole, s + h, xa, ta, NULL);
        dmb_hole_frame(&hole, s - h, xb, tb, NULL);
        CHECK_CLOSE(dot(t, t), 1, 4e-15);
        for (int i = 0; i < 3; ++i) {
            CHECK_CLOSE((xa[i] - xb[i]) / (2 * h), t[i], 1e-7);
            CHECK_CLOSE((ta[i] - tb[i]) / (2 * h), curvature[i], 1e-9);
        }
        if (s < 7 || s > end) assert_true(curvature[0] == 0 && curvature[1] == 0 && curvature[2] == 0);
    }
    for (int i = 1; i < WINDING; ++i) {
        double x[3], t[3], xb[3], tb[3];
        dmb_hole_frame(&hole, storage[i].depth, x, t, NULL);
        dmb_hole_frame(&hole, nextafter(storage[i].depth, 0), xb, tb, NULL);
        CHECK_CLOSE(distance(x, xb), 0, 1e-12);
        CHECK_CLOSE(distance(t, tb), 0, 4e-15);
    }
}

static void frame_rotations(void **state)
{
    dmb_hole_station storage[WINDING];
    const dmb_hole hole = winding(storage);
    double R[9];
    (void)state;

    for (double s = -5; s < 800; s += 3.3) {
        double x[3], t[3];
        dmb_hole_frame_rotation(&hole, s, R);
        dmb_hole_frame(&hole, s, x, t, NULL);
        for (int i = 0; i < 3; ++i) {
            assert_true(R[3 * i] == t[i]);
            for (int j = 0; j < 3; ++j)
                CHECK_CLOSE(R[i] * R[j] + R[3 + i] * R[3 + j] + R[6 + i] * R[6 + j], i == j ? 1 : 0, 1e-14);
        }
        assert_true(R[7] == 0.0 && R[8] > 0.0); /* y is horizontal, z looks up */
    }
    const double down[3] = {0, 0, -1}, nearly[3] = {1e-5, 0, -1}, up[3] = {1e-12, 1e-12, 1};
    const double expected[9] = {0, 0, 1, 0, 1, 0, -1, 0, 0};
    dmb_hole vertical;
    assert_int_equal(dmb_hole_setup_straight(&vertical, at_origin, down, 0.05), DMB_OK);
    dmb_hole_frame_rotation(&vertical, 1, R);
    for (int i = 0; i < 9; ++i) CHECK_CLOSE(R[i], expected[i], 1e-15);
    assert_int_equal(dmb_hole_setup_straight(&vertical, at_origin, nearly, 0.05), DMB_OK);
    dmb_hole_frame_rotation(&vertical, 1, R);
    for (int i = 0; i < 9; ++i) CHECK_CLOSE(R[i], expected[i], 1.1e-5);
    assert_int_equal(dmb_hole_setup_straight(&vertical, at_origin, up, 0.05), DMB_OK);
    dmb_hole_frame_rotation(&vertical, 1, R);
    CHECK_CLOSE(R[4], 1, 1e-15);
}

/* A unit vector square to t. */
static void square_to(const double t[3], double angle, double out[3])
{
    const double y[3] = {-t[1], t[0], 0};
    const double length = sqrt(dot(y, y));
    const double z[3] = {-t[2] * y[1], t[2] * y[0], t[0] * y[1] - t[1] * y[0]};

    for (int i = 0; i < 3; ++i) out[i] = (cos(angle) * y[i] + sin(angle) * z[i]) / length;
}

/* Stepping off the axis at a right angle and back again gives the same depth, from any hint. */
static void projection_is_exact(void **state)
{
    dmb_hole_station storage[WINDING];
    const dmb_hole hole = winding(storage);
    const double end = storage[WINDING - 1].depth;
    uint64_t seed = 55;
    (void)state;

    for (int i = 0; i < 5000; ++i) {
        const double depth = i < 2 * WINDING ? storage[i / 2].depth : draw(&seed, -20, end + 30);
        const double e = i % 4 == 0 ? 0 : draw(&seed, 0, 5);
        double x[3], t[3], n[3], point[3], tangent[3], s = -1;
        dmb_hole_frame(&hole, depth, x, t, NULL);
        square_to(t, draw(&seed, 0, 6.3), n);
        const double off[3] = {x[0] + e * n[0], x[1] + e * n[1], x[2] + e * n[2]};
        uint32_t found = 0;
        for (int j = 0; j < 4; ++j) {
            uint32_t segment = j == 0 ? 0 : j == 1 ? UINT32_MAX : j == 2 ? found : (uint32_t)draw(&seed, 0, WINDING);
            dmb_hole_project(&hole, off, &s, &segment, point, tangent);
            assert_true(j == 0 || segment == found);
            found = segment;
            CHECK_CLOSE(s, depth, 2e-12); /* a depth of 700 m has a last digit of 1e-13 */
            CHECK_CLOSE(distance(point, x), 0, 1e-12);
            CHECK_CLOSE(distance(tangent, t), 0, 1e-13);
        }
    }
}

/* Closest indeed: no place along the axis is nearer. */
static void projection_is_closest(void **state)
{
    dmb_hole_station storage[WINDING];
    const dmb_hole hole = winding(storage);
    uint64_t seed = 6;
    (void)state;

    for (int i = 0; i < 200; ++i) {
        double x[3], t[3], point[3], tangent[3], s;
        uint32_t segment = 20;
        dmb_hole_frame(&hole, draw(&seed, 0, 700), x, t, NULL);
        for (int k = 0; k < 3; ++k) x[k] += draw(&seed, -3, 3);
        dmb_hole_project(&hole, x, &s, &segment, point, tangent);
        const double nearest = distance(x, point);
        for (double other = -40; other < 800; other += 0.5) {
            double y[3];
            dmb_hole_frame(&hole, other, y, NULL, NULL);
            assert_true(distance(x, y) >= nearest - 1e-12);
        }
    }
}

/* A point carried across station planes sees no jump, with the hint of its last place. */
static void projection_is_continuous(void **state)
{
    dmb_hole_station storage[WINDING];
    const dmb_hole hole = winding(storage);
    (void)state;

    for (int i = 1; i < WINDING; ++i) {
        double n[3], x[3], s, point[3], tangent[3], last_s = 0, last_point[3] = {0, 0, 0};
        uint32_t segment = (uint32_t)(i - 1);
        square_to(storage[i].tangent, 1.0, n);
        for (int k = -50; k <= 50; ++k) {
            for (int j = 0; j < 3; ++j) x[j] = storage[i].point[j] + 0.01 * n[j] + 1e-13 * k * storage[i].tangent[j];
            dmb_hole_project(&hole, x, &s, &segment, point, tangent);
            if (k > -50) {
                CHECK_CLOSE(s, last_s, 1e-12);
                CHECK_CLOSE(distance(point, last_point), 0, 1e-12);
            }
            last_s = s;
            memcpy(last_point, point, sizeof point);
        }
    }
}

/* Next to straight, through the centre of the arc, beyond it: finite answers on the axis. */
static void delicate_projections(void **state)
{
    dmb_hole_station storage[3];
    double x[3], t[3], point[3], tangent[3], s;
    uint32_t segment = 0;
    (void)state;

    for (double bend = 1e-13; bend < 1; bend *= 10) {
        const double survey[9] = {0, 90 * DEG, 0, 20, 90 * DEG, bend, 40, 90 * DEG, 0};
        const dmb_hole hole = surveyed(3, survey, storage);
        for (double depth = -3; depth < 45; depth += 0.9) {
            dmb_hole_frame(&hole, depth, x, t, NULL);
            dmb_hole_project(&hole, x, &s, &segment, point, tangent);
            CHECK_CLOSE(s, depth, 1e-12);
            CHECK_CLOSE(distance(x, point), 0, 1e-12);
            CHECK_CLOSE(distance(t, tangent), 0, 1e-12);
        }
    }
    const double survey[6] = {0, 90 * DEG, 0, 20, 90 * DEG, 2.0}; /* R = 10, centre (0, 10, 0) */
    const dmb_hole hole = surveyed(2, survey, storage);
    const double places[4][3] = {{0, 10, 0}, {0.5, 10.5, 0}, {-1, 30, 4}, {1e5, -1e5, 1e5}};
    for (int i = 0; i < 4; ++i)
        for (uint32_t hint = 0; hint < 3; ++hint) {
            segment = hint;
            dmb_hole_project(&hole, places[i], &s, &segment, point, tangent);
            assert_true(isfinite(s) && isfinite(point[0]) && isfinite(tangent[0]));
            CHECK_CLOSE(dot(tangent, tangent), 1, 1e-14);
            dmb_hole_frame(&hole, s, x, t, NULL);
            CHECK_CLOSE(distance(x, point), 0, 1e-9);
        }
}

static void radial_offset(void **state)
{
    const double x[3] = {3, 1e-3, -2e-3}, p[3] = {2, 0, 0}, t[3] = {1, 0, 0}, last[3] = {0, 0.6, 0.8};
    double e, n[3] = {0, 0.6, 0.8};
    (void)state;

    dmb_radial(x, p, t, last, &e, n);
    CHECK_RELATIVE(e, sqrt(5e-6), 1e-15);
    assert_true(n[0] == 0.0);
    CHECK_CLOSE(n[1], 1 / sqrt(5.0), 1e-15);
    CHECK_CLOSE(n[2], -2 / sqrt(5.0), 1e-15);
    dmb_radial(p, p, t, n, &e, n); /* concentric: the last direction stays */
    assert_true(e == 0.0);
    CHECK_CLOSE(n[1], 1 / sqrt(5.0), 1e-15);
    const double near[3] = {2, 5e-13, 0};
    dmb_radial(near, p, t, last, &e, n);
    assert_true(e == 5e-13 && n[1] == 0.6 && n[2] == 0.8);
    const double bad[3] = {2, (double)NAN, 0};
    dmb_radial(bad, p, t, last, &e, n);
    assert_true(isnan(e));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(straight_hole),
        cmocka_unit_test(refusals),
        cmocka_unit_test(carried_frame_does_not_twist),
        cmocka_unit_test(places_are_searched),
        cmocka_unit_test(directions),
        cmocka_unit_test(constant_dogleg_is_a_circle),
        cmocka_unit_test(textbook_station),
        cmocka_unit_test(frames_of_a_winding_hole),
        cmocka_unit_test(frame_rotations),
        cmocka_unit_test(projection_is_exact),
        cmocka_unit_test(projection_is_closest),
        cmocka_unit_test(projection_is_continuous),
        cmocka_unit_test(delicate_projections),
        cmocka_unit_test(radial_offset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
