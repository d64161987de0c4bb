/* Flutter that a buckling analysis meets before divergence, against closed forms: Beck's column, pushed along its own
 * axis, without damping 20.0509 EI/L^2 (Beck 1952), with little damping of the material 10.94 EI/L^2 (Bolotin 1963); a
 * cantilever under a moment with a fixed axis, at any torque (Ziegler 1952). Greenhill's shaft, which diverges and does
 * not flutter, is in test_buckling_follow.c.
 * Equations: eq:static.characteristic. */
#include "mechanism.h"

#define EI 2e5 /* [N m2] stiff in stretch and shear, which the closed forms leave out */
#define LENGTH 10.0
#define BECK 20.05095
#define BOLOTIN 10.94

typedef struct column {
    rig s;
    dmb_id string;
} column;

static void add_end_load(column *c, int32_t frame, uint32_t pipe, double end, double force, double moment)
{
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(c->string, pipe, end);
    load.frame = frame;
    load.force[0] = force;
    load.moment[0] = moment;
    (void)add_load(&c->s, &load);
}

static void open_column(column *c, uint32_t elements, double damping_time)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(0.5 * LENGTH, elements / 2, 1e6 * EI, 1e6 * EI, EI / 1.3, EI);
    rig_open(&c->s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_NONE;
    string.end_free = DMB_FREE_ALL;
    pipe.damping_time = damping_time;
    pipe.string = c->string = add_string(&c->s, &string);
    (void)add_pipes(&c->s, &pipe, 2);
}

/* Status of the analysis about the present loads; *factor NaN: none. */
static int32_t analyse(column *c, int32_t follow, double factor_max, double *factor, dmb_buckling_info *info)
{
    dmb_buckling *found = NULL;
    dmb_buckling_options options = dmb_buckling_options_default();
    options.follow = follow;
    options.factor_max = factor_max;
    (void)rig_start(&c->s, NULL);
    must(&c->s, dmb_analysis_static(c->s.sim, NULL, NULL));
    const int32_t status = dmb_analysis_buckling(c->s.sim, &options, &found);
    must(&c->s, status);
    *factor = (double)NAN;
    *info = dmb_buckling_info_default();
    assert_int_equal(dmb_buckling_get_info(found, info), DMB_OK);
    if (dmb_buckling_count(found) > 0) assert_int_equal(dmb_buckling_factor(found, 0, factor), DMB_OK);
    dmb_buckling_destroy(&found);
    if (status != DMB_OK) print_message("    %s\n", dmb_sim_message(c->s.sim));
    rig_close(&c->s);
    return status;
}

/* [EI/L^2] that Beck's column flutters under. det K never vanishes: the way goes to factor_max. */
static double beck(uint32_t elements, double damping_time)
{
    const double unit = EI / (LENGTH * LENGTH);
    double factor;
    dmb_buckling_info info;
    column c;
    open_column(&c, elements, damping_time);
    add_end_load(&c, DMB_FRAME_BODY, 1, 1.0, -5.0 * unit, 0.0);
    const int32_t status = analyse(&c, 1, 5.0, &factor, &info);
    assert_int_equal(status, DMB_NOTE_FLUTTER);
    assert_int_equal(info.stiffness, DMB_STIFFNESS_UNSYMMETRIC);
    assert_int_equal(info.end, DMB_BUCKLING_STABLE);
    assert_int_equal(info.flutter, DMB_FLUTTER_FOUND);
    assert_int_equal(info.count, 0);
    assert_true(info.flutter_root[1] > 0.0);
    return 5.0 * (1.0 + info.flutter_factor);
}

static void becks_column(void **state)
{
    (void)state;
    const double error[2] = {fabs(beck(8, 0.0) / BECK - 1.0), fabs(beck(16, 0.0) / BECK - 1.0)};
    check_below("Beck's 20.0509 EI/L^2, 8 elements", error[0], 3e-3);
    check_below("  16", error[1], 1e-4);
}

/* Damping of the material, however little, lets it flutter under little more than half of that. */
static void damping_destabilises(void **state)
{
    (void)state;
    check_relative("damped a little [EI/L^2]", beck(8, 1e-3), BOLOTIN, 3e-3);
}

/* Any torque makes it flutter: the present state already does, and det K never vanishes. */
static void twisted_cantilever(void **state)
{
    (void)state;
    for (int follow = 0; follow < 2; follow++) {
        double factor;
        dmb_buckling_info info;
        column c;
        open_column(&c, 8, 0.0);
        add_end_load(&c, DMB_FRAME_WORLD, 1, 1.0, 0.0, EI / LENGTH);
        assert_int_equal(analyse(&c, follow, 1e12, &factor, &info), DMB_NOTE_FLUTTER);
        assert_int_equal(info.flutter, DMB_FLUTTER_FOUND);
        assert_true(info.flutter_factor == 0.0 && info.flutter_root[0] > 0.0 && info.flutter_root[1] > 0.0);
    }
}

/* With friction that is assumed to slip, which is no motion, nothing is judged. */
static void slip_is_no_motion(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        column c;
        dmb_buckling *found = NULL;
        dmb_buckling_info info = dmb_buckling_info_default();
        dmb_buckling_options options = dmb_buckling_options_default();
        options.slip_axial = k == 0 ? 1.0 : 0.0;
        options.slip_rotation = k == 0 ? 0.0 : 1.0;
        options.follow = 0;
        open_column(&c, 8, 0.0);
        add_end_load(&c, DMB_FRAME_WORLD, 1, 1.0, 0.0, EI / LENGTH);
        (void)rig_start(&c.s, NULL);
        must(&c.s, dmb_analysis_static(c.s.sim, NULL, NULL));
        must(&c.s, dmb_analysis_buckling(c.s.sim, &options, &found));
        assert_int_equal(dmb_buckling_get_info(found, &info), DMB_OK);
        assert_int_equal(info.stiffness, DMB_STIFFNESS_UNSYMMETRIC);
        assert_int_equal(info.flutter, DMB_FLUTTER_NOT_JUDGED);
        dmb_buckling_destroy(&found);
        rig_close(&c.s);
    }
}

/* A dead push has a potential: nothing is to be judged, and nothing is. */
static void dead_push(void **state)
{
    (void)state;
    double factor;
    dmb_buckling_info info;
    column c;
    open_column(&c, 16, 0.0);
    add_end_load(&c, DMB_FRAME_WORLD, 1, 1.0, -EI / (LENGTH * LENGTH), 0.0);
    assert_int_equal(analyse(&c, 1, 1e12, &factor, &info), DMB_OK);
    assert_int_equal(info.stiffness, DMB_STIFFNESS_SYMMETRIC);
    assert_int_equal(info.flutter, DMB_FLUTTER_NOT_JUDGED);
    check_relative("Euler [EI/L^2]", 1.0 + factor, 0.25 * PI * PI, 1e-4);
}

/* ---- Rigid links, which loads along them do not move: told from the present pose --------------------------------- */

#define HINGE 100.0 /* [N m/rad] */
#define LINK 2.0    /* [m] */

/* A point mass at x, on a link along x from `from`, hinged there and held straight by a spring. */
static dmb_id add_link(rig *s, dmb_id from, double x, double y, double mass)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def hinge = dmb_joint_def_default();
    body.position[0] = x;
    body.position[1] = y;
    body.mass = mass;
    for (int i = 0; i < 3; i++) body.inertia[i] = 1e-9;
    const dmb_id link = add_body(s, &body);
    hinge.kind = DMB_JOINT_REVOLUTE;
    hinge.place_a = dmb_station(from, 0, 0.0);
    hinge.place_b = dmb_station(link, 0, 0.0);
    if (from.index == 0) hinge.origin_a[1] = y;
    hinge.origin_b[0] = -LINK;
    for (int i = 0; i < 3; i++) hinge.axis_a[i] = hinge.axis_b[i] = i == 2 ? 1.0 : 0.0;
    hinge.normal_a[0] = hinge.normal_b[0] = 1.0;
    hinge.stiffness[DMB_RX] = HINGE;
    (void)add_joint(s, &hinge);
    return link;
}

static void push_link(rig *s, dmb_id link, int32_t frame, double force)
{
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(link, 0, 0.0);
    load.frame = frame;
    load.force[0] = -force;
    (void)add_load(s, &load);
}

/* Ziegler's double pendulum, masses 2 m and m, follower push P: w = m l^2 |s|^2 from 2 w^2 - (7 k - 2 P l) w + k^2 = 0,
 * flutter from P l/k = 7/2 - sqrt 2 on (Ziegler 1952); beside it a pendulum that a dead push tips over. */
static dmb_buckling_info zieglers_pendulum(double push, double dead, double factor_max, int32_t wanted, double *factor)
{
    rig s;
    dmb_buckling *found = NULL;
    dmb_buckling_info info = dmb_buckling_info_default();
    dmb_buckling_options options = dmb_buckling_options_default();
    options.factor_max = factor_max;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id first = add_link(&s, ground_id, LINK, 0.0, 6.0), second = add_link(&s, first, 2.0 * LINK, 0.0, 3.0);
    push_link(&s, second, DMB_FRAME_BODY, push * HINGE / LINK);
    push_link(&s, add_link(&s, ground_id, LINK, 5.0, 1.0), DMB_FRAME_WORLD, dead * HINGE / LINK);
    (void)rig_start(&s, NULL);
    assert_int_equal(dmb_analysis_buckling(s.sim, &options, &found), wanted);
    assert_int_equal(dmb_buckling_get_info(found, &info), DMB_OK);
    assert_int_equal(info.stiffness, DMB_STIFFNESS_UNSYMMETRIC);
    if (dmb_buckling_count(found) > 0) assert_int_equal(dmb_buckling_factor(found, 0, factor), DMB_OK);
    dmb_buckling_destroy(&found);
    rig_close(&s);
    return info;
}

static void links_that_flutter_before_one_tips(void **state)
{
    const double flutter = 3.5 - sqrt(2.0);
    double factor;
    (void)state;
    dmb_buckling_info info = zieglers_pendulum(1.0, 1.0 / 3.0, 1e12, DMB_NOTE_FLUTTER, &factor);
    check_relative("flutter", 1.0 + info.flutter_factor, flutter, 1e-5);
    check_relative("divergence of the other", factor, 2.0, 1e-9);
    info = zieglers_pendulum(0.5, 1.0 / 3.0, 1e12, DMB_OK, &factor);
    assert_int_equal(info.flutter, DMB_FLUTTER_NONE);
    check_relative("divergence before flutter", factor, 2.0, 1e-9);
    info = zieglers_pendulum(flutter * 1.01, 1.0 / 3.0, 1e12, DMB_NOTE_FLUTTER, &factor);
    assert_true(info.flutter_factor == 0.0);
}

/* Nothing tips: without end nobody looks beyond the present state, else up to factor_max, the last stretch included. */
static void links_that_flutter_where_none_tips(void **state)
{
    const double flutter = 3.5 - sqrt(2.0), above[3] = {flutter - 1.0 + 0.01, 1.5, 3.0};
    double factor;
    (void)state;
    for (int i = 0; i < 3; i++) {
        const dmb_buckling_info info = zieglers_pendulum(1.0, 0.0, above[i], DMB_NOTE_FLUTTER, &factor);
        assert_int_equal(info.count, 0);
        check_relative("flutter below factor_max", 1.0 + info.flutter_factor, flutter, 1e-5);
    }
    dmb_buckling_info info = zieglers_pendulum(1.0, 0.0, flutter - 1.0 - 0.01, DMB_NOTE_STOPPED, &factor);
    assert_int_equal(info.flutter, DMB_FLUTTER_NONE);
    info = zieglers_pendulum(1.0, 0.0, 1e12, DMB_NOTE_STOPPED, &factor);
    assert_int_equal(info.flutter, DMB_FLUTTER_NOT_JUDGED);
    assert_int_equal(info.end, DMB_BUCKLING_EXTRAPOLATED);
    info = zieglers_pendulum(flutter * 1.01, 0.0, 1e12, DMB_NOTE_FLUTTER, &factor);
    assert_true(info.flutter_factor == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(becks_column),
        cmocka_unit_test(damping_destabilises),
        cmocka_unit_test(twisted_cantilever),
        cmocka_unit_test(dead_push),
        cmocka_unit_test(slip_is_no_motion),
        cmocka_unit_test(links_that_flutter_before_one_tips),
        cmocka_unit_test(links_that_flutter_where_none_tips),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
