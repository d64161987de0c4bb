/* Flutter that a buckling analysis meets before divergence, against closed forms: Beck's column, pushed along its own
 * axis, without damping 20.0509 EI/L^2 (Beck 1952), with little damping of the material 10.94 EI/L^2 (Bolotin 1963); a
 * cantilever under a moment with a fixed axis, at any torque (Ziegler 1952); Greenhill's shaft, which diverges and does
 * not flutter. */
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

static void open_column(column *c, uint32_t elements, int pinned, double damping_time)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(0.5 * LENGTH, elements / 2, 1e6 * EI, 1e6 * EI, EI / 1.3, EI);
    const dmb_place ground = dmb_station((dmb_id){0, 0}, 0, 0.0);
    rig_open(&c->s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = pinned ? DMB_FREE_ALL : DMB_FREE_NONE;
    string.end_free = DMB_FREE_ALL;
    pipe.damping_time = damping_time;
    pipe.string = c->string = add_string(&c->s, &string);
    (void)add_pipes(&c->s, &pipe, 2);
    if (!pinned) return;
    (void)add_joint_between(&c->s, DMB_JOINT_UNIVERSAL, ground, dmb_station(c->string, 0, 0.0));
    (void)add_joint_between(&c->s, DMB_JOINT_POINT_ON_LINE, ground, dmb_station(c->string, 1, 1.0));
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
    open_column(&c, elements, 0, damping_time);
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
        open_column(&c, 8, 0, 0.0);
        add_end_load(&c, DMB_FRAME_WORLD, 1, 1.0, 0.0, EI / LENGTH);
        assert_int_equal(analyse(&c, follow, 1e12, &factor, &info), DMB_NOTE_FLUTTER);
        assert_int_equal(info.flutter, DMB_FLUTTER_FOUND);
        assert_true(info.flutter_factor == 0.0 && info.flutter_root[0] > 0.0 && info.flutter_root[1] > 0.0);
    }
}

/* Its eigenvalues stay real although K is unsymmetric: nothing grows before 2 pi EI/L. */
static void greenhills_shaft(void **state)
{
    (void)state;
    double factor;
    dmb_buckling_info info;
    column c;
    open_column(&c, 64, 1, 0.0);
    add_end_load(&c, DMB_FRAME_WORLD, 0, 0.0, 0.0, -EI / LENGTH);
    add_end_load(&c, DMB_FRAME_WORLD, 1, 1.0, 0.0, EI / LENGTH);
    assert_int_equal(analyse(&c, 1, 1e12, &factor, &info), DMB_OK);
    assert_int_equal(info.stiffness, DMB_STIFFNESS_UNSYMMETRIC);
    assert_int_equal(info.flutter, DMB_FLUTTER_NONE);
    check_relative("Greenhill [EI/L]", 1.0 + factor, 2.0 * PI, 1e-4);
}

/* A dead push has a potential: nothing is to be judged, and nothing is. */
static void dead_push(void **state)
{
    (void)state;
    double factor;
    dmb_buckling_info info;
    column c;
    open_column(&c, 16, 0, 0.0);
    add_end_load(&c, DMB_FRAME_WORLD, 1, 1.0, -EI / (LENGTH * LENGTH), 0.0);
    assert_int_equal(analyse(&c, 1, 1e12, &factor, &info), DMB_OK);
    assert_int_equal(info.stiffness, DMB_STIFFNESS_SYMMETRIC);
    assert_int_equal(info.flutter, DMB_FLUTTER_NOT_JUDGED);
    check_relative("Euler [EI/L^2]", 1.0 + factor, 0.25 * PI * PI, 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(becks_column),       cmocka_unit_test(damping_destabilises),
        cmocka_unit_test(twisted_cantilever), cmocka_unit_test(greenhills_shaft),
        cmocka_unit_test(dead_push),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
