/* Profiles over a string's length against closed forms: a string that hangs in mud, one that is pushed along the low
 * side of its hole, one that lies in a hole that builds; and against the queries of single places. Equations:
 * eq:drilling.wall-force, eq:drilling.sinusoidal, eq:drilling.helical, eq:drilling.von-mises. Equations:
 * eq:drilling.vertical. */
#include "drill_string.h"

static scene describe(uint32_t pipes)
{
    scene s = string_of(pipes);
    s.load.frame = DMB_FRAME_BODY;
    return s;
}

static void compile(scene *s, int with_hole)
{
    add_string(s, with_hole);
    s->load.place = dmb_station(s->pipe.string, s->pipes - 1, 1.0);
    must(dmb_model_add_load(s->model, &s->load, NULL), dmb_model_message(s->model));
    finish_scene(s);
    must(dmb_analysis_static(s->sim, NULL, NULL), dmb_sim_message(s->sim));
}

static double at(const scene *s, int32_t quantity, double distance)
{
    dmb_profile profile = dmb_profile_default();
    double value = (double)NAN;
    profile.distance = &distance;
    profile.quantities = &quantity;
    profile.quantity_count = 1;
    profile.values = &value;
    must(dmb_query_profile(s->sim, &profile), dmb_profile_name(quantity, NULL));
    return value;
}

/* A string of length L hangs in mud: N = w_air (L - s) - p(L) A at depth s, whose end is pushed up by the mud's
 * pressure; N_e = w (L - s). Half its length carries no compression in the effective force, but in the true one. */
static void hanging_in_mud(void **state)
{
    scene s = describe(50);
    const double L = 100.0;
    (void)state;
    s.environment.fluid_density = 1200.0;
    s.wall.direction[0] = 0.0;
    s.wall.direction[2] = -1.0;
    s.pipe.length = 2.0;
    s.pipe.yield_strength = 7.24e8;
    compile(&s, 1);
    for (double z = 0.0; z <= L; z += 12.5) {
        const double effective = weight(&s) * (L - z);
        const double N = effective - 1200.0 * 9.81 * z * area(&s);
        check_close("effective force", at(&s, DMB_PROFILE_EFFECTIVE_FORCE, z), effective, 1e-8 * weight(&s) * L);
        check_close("true axial force", at(&s, DMB_PROFILE_AXIAL_FORCE, z), N, 1e-4 * weight(&s) * L);
        check_close("von Mises", at(&s, DMB_PROFILE_VON_MISES, z), effective / area(&s), 1e-8 * 1e8);
        check_close("share of yield", at(&s, DMB_PROFILE_YIELD_SHARE, z), effective / area(&s) / 7.24e8, 1e-8);
        check_close("buckling", at(&s, DMB_PROFILE_SINUSOIDAL_SHARE, z), 0.0, 0.0);
    }
    destroy(&s);
}

/* A vertical string stands on its far end: compression w (L - ...) against 2.55 and 5.55 (EI w^2)^(1/3). */
static void pushed_vertical(void **state)
{
    scene s = describe(20);
    double unit;
    (void)state;
    s.wall.direction[0] = 0.0;
    s.wall.direction[2] = -1.0;
    s.load.force[0] = -2000.0;
    compile(&s, 1);
    unit = cbrt(2.1e11 * second_moment(&s) * weight(&s) * weight(&s));
    check_relative("sinusoidal", at(&s, DMB_PROFILE_SINUSOIDAL_SHARE, 20.0), 2000.0 / (2.55 * unit), 1e-6);
    check_relative("helical", at(&s, DMB_PROFILE_HELICAL_SHARE, 20.0), 2000.0 / (5.55 * unit), 1e-6);
    destroy(&s);
}

/* Horizontal, on the low side, without friction: 2 sqrt(EI w/r), on the whole length alike; wall force w per metre. */
static void pushed_horizontal(void **state)
{
    scene s = describe(30);
    double EI, limit;
    (void)state;
    s.wall.friction_law = DMB_FRICTION_NONE;
    s.wall.stiffness = 1e9;
    s.string.offset[1] = -0.0105;
    s.load.force[0] = -20000.0;
    compile(&s, 1);
    EI = 2.1e11 * second_moment(&s);
    limit = 2.0 * sqrt(EI * weight(&s) / (0.5 * (s.wall.diameter - s.pipe.outer_diameter)));
    for (double x = 8.0; x < 25.0; x += 4.0) {
        check_relative("sinusoidal", at(&s, DMB_PROFILE_SINUSOIDAL_SHARE, x), 20000.0 / limit, 1e-5);
        check_relative("helical", at(&s, DMB_PROFILE_HELICAL_SHARE, x), 20000.0 / limit / sqrt(2.0), 1e-5);
        check_relative("wall", at(&s, DMB_PROFILE_NORMAL_FORCE, x), weight(&s), 1e-3);
        check_close("on the low side", at(&s, DMB_PROFILE_DEVIATION_UP, x), -0.0105, 1e-5);
        check_close("in the middle", at(&s, DMB_PROFILE_DEVIATION_SIDE, x), 0.0, 1e-9);
        check_close("deviation", at(&s, DMB_PROFILE_DEVIATION, x), 0.0105, 1e-5);
    }
    destroy(&s);
}

/* A hole that builds inclination by 0.6 rad over 120 m, and a string pushed by F in it. The wall carries |w sin i - N
 * theta'|, by the profile's own force, and the share takes the same; the hole is asked at the place of the station. */
static void building(void **state)
{
    static const double survey[6] = {0.0, 1.0, 0.0, 120.0, 1.6, 0.0};
    const double rate = 0.6 / 120.0;
    scene s = describe(60);
    (void)state;
    s.wall.survey = survey;
    s.wall.survey_count = 2;
    s.wall.friction_law = DMB_FRICTION_NONE;
    s.wall.stiffness = 1e9;
    s.string.offset[1] = -0.0105;
    s.pipe.length = 2.0;
    s.pipe.elements = 4;
    s.load.force[0] = -15000.0;
    compile(&s, 1);
    for (double x = 30.0; x < 100.0; x += 14.0) {
        const double N = at(&s, DMB_PROFILE_EFFECTIVE_FORCE, x), depth = at(&s, DMB_PROFILE_DEPTH, x);
        const double w = fabs(weight(&s) * sin(1.0 + rate * depth) - N * rate);
        const double EI = 2.1e11 * second_moment(&s);
        dmb_hole_point point = dmb_hole_point_default();
        must(dmb_query_hole(s.model, depth, &point), "hole");
        check_close("depth", depth, x, 0.02);
        check_close("inclination", point.inclination, 1.0 + rate * depth, 1e-12);
        check_close("azimuth", point.azimuth, 0.0, 1e-12);
        check_relative("curvature", point.curvature, rate, 1e-12);
        check_relative("dogleg severity", point.dogleg_severity, rate * 30.0 * 180.0 / PI, 1e-12);
        /* bent by the weight between places of contact too, w l^2/12 at them: 0.5 % */
        check_relative("string's curvature", at(&s, DMB_PROFILE_CURVATURE, x), rate, 6e-3);
        check_relative("wall", at(&s, DMB_PROFILE_NORMAL_FORCE, x), w, 5e-3);
        check_relative("sinusoidal", at(&s, DMB_PROFILE_SINUSOIDAL_SHARE, x), -N / (2.0 * sqrt(EI * w / 0.0105)), 1e-6);
        check_relative("von Mises", at(&s, DMB_PROFILE_VON_MISES, x),
                       -N / area(&s) + at(&s, DMB_PROFILE_BENDING_MOMENT, x) * 0.0365 / second_moment(&s), 1e-12);
    }
    destroy(&s);
}

/* Sections with torque: sqrt(3) T r/J where nothing else loads them. */
static void twisted(void **state)
{
    scene s = describe(10);
    (void)state;
    s.environment.gravity[2] = 0.0;
    s.load.moment[0] = 1500.0;
    compile(&s, 0);
    check_relative("von Mises", at(&s, DMB_PROFILE_VON_MISES, 3.3),
                   sqrt(3.0) * 1500.0 * 0.0365 / (2.0 * second_moment(&s)), 1e-9);
    assert_true(isnan(at(&s, DMB_PROFILE_YIELD_SHARE, 3.3)));
    assert_true(isnan(at(&s, DMB_PROFILE_SINUSOIDAL_SHARE, 3.3)));
    destroy(&s);
}

enum { STATIONS = 173 };

/* In a run that is moving: every quantity in one call, station by station and quantity by quantity, is what the queries
 * of single places say; the wall's force over the length is the sum over its sites. */
static void same_as_single_queries(void **state)
{
    scene s = describe(24);
    double rows[STATIONS][(DMB_PROFILE_GAP + 1)], columns[(DMB_PROFILE_GAP + 1)][STATIONS], wall = 0.0;
    int32_t all[(DMB_PROFILE_GAP + 1)];
    dmb_profile profile = dmb_profile_default();
    dmb_contact_total total = dmb_contact_total_default();
    (void)state;
    s.pipe.joint_length = 0.2;
    s.pipe.joint_outer_diameter = 0.08;
    s.pipe.elements = 2;
    s.pipe.eccentricity = 0.002;
    compile(&s, 1);
    for (int i = 0; i < 50; i++) must(dmb_sim_step(s.sim, 1e-3, NULL), dmb_sim_message(s.sim));
    for (int32_t q = 0; q < (DMB_PROFILE_GAP + 1); q++) all[q] = q;
    profile.station_count = STATIONS;
    profile.quantities = all;
    profile.quantity_count = (DMB_PROFILE_GAP + 1);
    profile.values = &rows[0][0];
    must(dmb_query_profile(s.sim, &profile), "rows");
    profile.values = &columns[0][0];
    profile.station_stride = 1;
    profile.quantity_stride = STATIONS;
    must(dmb_query_profile(s.sim, &profile), "columns");
    for (int i = 0; i < STATIONS; i++) {
        const double distance = 24.0 * i / (STATIONS - 1);
        const uint32_t pipe = i + 1 < STATIONS ? (uint32_t)distance : 23;
        const dmb_place place = dmb_station(s.pipe.string, pipe, distance - pipe);
        dmb_pose pose = dmb_pose_default();
        dmb_motion motion = dmb_motion_default();
        dmb_section section = dmb_section_default();
        double angle;
        for (int q = 0; q < (DMB_PROFILE_GAP + 1); q++)
            assert_true(rows[i][q] == columns[q][i] || (isnan(rows[i][q]) && isnan(columns[q][i])));
        must(dmb_query_pose(s.sim, place, &pose), "pose");
        must(dmb_query_section(s.sim, place, &section), "section");
        motion.frame = DMB_FRAME_BODY;
        must(dmb_query_motion(s.sim, place, &motion), "motion");
        for (int k = 0; k < 3; k++) check_close("position", rows[i][DMB_PROFILE_X + k], pose.position[k], 0.0);
        check_close("depth", rows[i][DMB_PROFILE_DEPTH], pose.depth, 0.0);
        check_close("force", rows[i][DMB_PROFILE_EFFECTIVE_FORCE], section.force[0], 0.0);
        check_close("torque", rows[i][DMB_PROFILE_TORQUE], section.force[3], 0.0);
        check_close("moment", rows[i][DMB_PROFILE_BENDING_MOMENT], hypot(section.force[4], section.force[5]), 0.0);
        check_close("shear", rows[i][DMB_PROFILE_SHEAR_FORCE], hypot(section.force[1], section.force[2]), 0.0);
        for (int k = 0; k < 2; k++) {
            check_close("shear", rows[i][DMB_PROFILE_SHEAR_Y + k], section.force[1 + k], 0.0);
            check_close("moment", rows[i][DMB_PROFILE_MOMENT_Y + k], section.force[4 + k], 0.0);
        }
        for (int k = 0; k < 3; k++)
            check_close("displacement", rows[i][DMB_PROFILE_DISPLACEMENT_X + k], pose.displacement[k], 0.0);
        must(dmb_query_rotation(s.sim, place, &angle), "rotation");
        check_close("rotation", rows[i][DMB_PROFILE_ROTATION], angle, 0.0);
        check_close("speed", rows[i][DMB_PROFILE_VELOCITY_AXIAL], motion.velocity[0], 0.0);
        check_close("spin", rows[i][DMB_PROFILE_SPIN], motion.velocity[3], 0.0);
        motion.frame = DMB_FRAME_WORLD;
        must(dmb_query_motion(s.sim, place, &motion), "motion");
        check_close(
            "acceleration", hypot(rows[i][DMB_PROFILE_ACCELERATION_AXIAL], rows[i][DMB_PROFILE_ACCELERATION_LATERAL]),
            sqrt(motion.acceleration[0] * motion.acceleration[0] + motion.acceleration[1] * motion.acceleration[1] +
                 motion.acceleration[2] * motion.acceleration[2]),
            1e-9);
    }
    must(dmb_query_contact_total(s.sim, &total), "total");
    for (int i = 0; i < 24000; i++) wall += 1e-3 * at(&s, DMB_PROFILE_NORMAL_FORCE, 1e-3 * (i + 0.5));
    check_relative("wall over the length", wall, total.normal_force, 1e-9);
    destroy(&s);
}

/* Axial-torsional pipes have the curvature of the hole, and its stress. */
static void axial_torsional(void **state)
{
    static const double survey[6] = {0.0, 1.0, 0.0, 120.0, 1.6, 0.0};
    scene s = describe(60);
    (void)state;
    s.wall.survey = survey;
    s.wall.survey_count = 2;
    s.pipe.length = 2.0;
    s.pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    s.load.force[0] = -15000.0;
    compile(&s, 1);
    check_relative("curvature", at(&s, DMB_PROFILE_CURVATURE, 61.0), 0.6 / 120.0, 1e-9);
    check_relative("von Mises", at(&s, DMB_PROFILE_VON_MISES, 61.0),
                   fabs(at(&s, DMB_PROFILE_EFFECTIVE_FORCE, 61.0)) / area(&s) + 2.1e11 * 0.0365 * 0.6 / 120.0, 1e-9);
    destroy(&s);
}

/* Rigid tool joints do not bend: the pipe between them turns by the angle of the hole along the whole pipe, and so more
 * per metre; its moment continues into the tool joint (eq:drilling.bending). */
static void axial_torsional_tool_joints(void **state)
{
    static const double survey[6] = {0.0, 1.0, 0.0, 120.0, 1.6, 0.0};
    const double curvature = 0.6 / 120.0 * 2.0 / 1.6;
    scene s = describe(60);
    (void)state;
    s.wall.survey = survey;
    s.wall.survey_count = 2;
    s.pipe.length = 2.0;
    s.pipe.joint_length = 0.4;
    s.pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    compile(&s, 1);
    check_relative("pipe", at(&s, DMB_PROFILE_CURVATURE, 61.0), curvature, 1e-9);
    assert_true(at(&s, DMB_PROFILE_CURVATURE, 61.8) == 0.0);
    for (int i = 0; i < 2; i++)
        check_relative("moment", at(&s, DMB_PROFILE_BENDING_MOMENT, 61.0 + 0.8 * i),
                       2.1e11 * second_moment(&s) * curvature, 1e-9);
    check_relative("von Mises", at(&s, DMB_PROFILE_VON_MISES, 61.0),
                   fabs(at(&s, DMB_PROFILE_EFFECTIVE_FORCE, 61.0)) / area(&s) + 2.1e11 * 0.0365 * curvature, 1e-9);
    destroy(&s);
}

/* On a straight line beyond both ends of the survey; a straight survey tells its ends likewise. */
static void beyond_the_survey(void **state)
{
    static const double surveys[2][6] = {{10.0, 1.0, 0.5, 40.0, 1.2, 0.5}, {10.0, 1.0, 0.5, 40.0, 1.0, 0.5}};
    (void)state;
    for (int k = 0; k < 2; k++) {
        scene s = describe(5);
        dmb_hole_point a = dmb_hole_point_default(), b = a;
        s.wall.survey = surveys[k];
        s.wall.survey_count = 2;
        s.string.start_depth = 15.0;
        compile(&s, 1);
        must(dmb_query_hole(s.model, 40.0, &a), "hole");
        assert_int_equal(a.beyond, DMB_HOLE_SURVEYED);
        must(dmb_query_hole(s.model, 45.0, &b), "hole");
        assert_int_equal(b.beyond, DMB_HOLE_BELOW);
        for (int i = 0; i < 3; i++) check_close("on a line", b.position[i], a.position[i] + 5.0 * a.tangent[i], 1e-12);
        check_close("azimuth", b.azimuth, 0.5, 1e-12);
        check_close("straight", b.curvature, 0.0, 0.0);
        must(dmb_query_hole(s.model, 9.999, &b), "hole");
        assert_int_equal(b.beyond, DMB_HOLE_ABOVE);
        check_close("inclination", b.inclination, 1.0, 1e-12);
        destroy(&s);
    }
}

static void refused(void **state)
{
    scene s = describe(5);
    dmb_hole_point point = dmb_hole_point_default();
    double distance[2] = {0.0, 5.0}, values[2] = {-7.0, -7.0};
    int32_t quantity = DMB_PROFILE_DEPTH;
    dmb_profile good = dmb_profile_default(), bad;
    (void)state;
    compile(&s, 1);
    good.station_count = 2;
    good.distance = distance;
    good.quantities = &quantity;
    good.quantity_count = 1;
    good.values = values;
#define REFUSED(field, value, status)                         \
    bad = good, bad.field = value;                            \
    assert_int_equal(dmb_query_profile(s.sim, &bad), status); \
    assert_true(values[0] == -7.0 && values[1] == -7.0)
    REFUSED(station_count, 0, DMB_ERR_VALUE);
    REFUSED(station_count, UINT32_MAX, DMB_ERR_VALUE);
    REFUSED(quantities, NULL, DMB_ERR_NULL);
    REFUSED(values, NULL, DMB_ERR_NULL);
    REFUSED(quantity_count, 0, DMB_ERR_VALUE);
    REFUSED(quantity_count, (DMB_PROFILE_GAP + 1) + 1, DMB_ERR_VALUE);
    REFUSED(station_stride, UINT64_MAX, DMB_ERR_VALUE);
    REFUSED(quantity_stride, 1, DMB_ERR_VALUE); /* both stations at one place */
    REFUSED(string.index, 12345, DMB_ERR_ID);
    quantity = -1;
    REFUSED(station_count, 2, DMB_ERR_VALUE);
    quantity = (DMB_PROFILE_GAP + 1);
    REFUSED(station_count, 2, DMB_ERR_VALUE);
    quantity = 0;
    for (int k = 0; k < 4; k++) {
        distance[1] = (const double[4]){-1e-9, 5.001, (double)NAN, (double)INFINITY}[k];
        REFUSED(station_count, 2, k < 2 ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE);
    }
    assert_int_equal(dmb_query_profile(s.sim, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_query_profile(NULL, &good), DMB_ERR_NULL);
    assert_int_equal(dmb_query_hole(s.model, (double)NAN, &point), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_query_hole(s.model, 1e300, &point), DMB_ERR_VALUE);
    assert_int_equal(dmb_query_hole(s.model, 0.0, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_query_hole(NULL, 0.0, &point), DMB_ERR_NULL);
    destroy(&s);
    s = describe(5);
    compile(&s, 0);
    assert_int_equal(dmb_query_hole(s.model, 0.0, &point), DMB_ERR_UNSUPPORTED);
    destroy(&s);
    must(dmb_model_create(NULL, &s.model), "create");
    assert_int_equal(dmb_query_hole(s.model, 0.0, &point), DMB_ERR_ORDER);
    dmb_model_destroy(&s.model);
}

static void names(void **state)
{
    const char *unit;
    (void)state;
    for (int32_t q = 0; q < (DMB_PROFILE_GAP + 1); q++) {
        assert_non_null(dmb_profile_name(q, &unit));
        assert_non_null(unit);
        for (int32_t k = 0; k < q; k++) assert_string_not_equal(dmb_profile_name(q, NULL), dmb_profile_name(k, NULL));
    }
    assert_null(dmb_profile_name(-1, &unit));
    assert_null(unit);
    assert_null(dmb_profile_name((DMB_PROFILE_GAP + 1), NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hanging_in_mud),
        cmocka_unit_test(pushed_vertical),
        cmocka_unit_test(pushed_horizontal),
        cmocka_unit_test(building),
        cmocka_unit_test(twisted),
        cmocka_unit_test(axial_torsional),
        cmocka_unit_test(axial_torsional_tool_joints),
        cmocka_unit_test(same_as_single_queries),
        cmocka_unit_test(beyond_the_survey),
        cmocka_unit_test(refused),
        cmocka_unit_test(names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
