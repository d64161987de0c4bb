/* Linear buckling of strings with joints against closed forms: rigid links and columns with springs in their joints,
 * hinges in one plane and in both, joints that hold all they could, and a shallow truss near its limit point. */
#include "mechanism.h"

#define EI 2e5 /* [N m2] of all columns; stiff in stretch and shear, which the closed forms leave out */

enum {
    PINNED = 0,
    CLAMPED = 1,
    CLAMPED_ROLLER = DMB_FREE_X,
    FREE_TO_MOVE = DMB_FREE_TRANSLATIONS
}; /* ends of columns; degrees_of_freedom of strings */

static dmb_id add_push(rig *s, dmb_place place)
{
    dmb_load_def push = dmb_load_def_default();
    const dmb_segment off = dmb_segment_default(); /* of height 0: there is no push at present */
    push.place = place;
    push.force[0] = -1.0;
    push.time_function = add_time_function(s, &off, 1);
    return add_load(s, &push);
}

static dmb_buckling *critical_by(const rig *s, dmb_id push, uint32_t count, int32_t follow)
{
    dmb_buckling *found = NULL;
    dmb_buckling_options options = dmb_buckling_options_default();
    uint64_t before, after;
    options.scale = DMB_SCALE_PART;
    options.part = push;
    options.count = count;
    options.factor_max = 1e15;
    options.follow = follow;
    must(s, dmb_sim_hash(s->sim, &before));
    const int32_t status = dmb_analysis_buckling(s->sim, &options, &found);
    must(s, status);
    assert_int_equal(status, follow ? DMB_OK : DMB_NOTE_EXTRAPOLATED);
    must(s, dmb_sim_hash(s->sim, &after));
    assert_true(before == after);
    return found;
}

static dmb_buckling *critical(const rig *s, dmb_id push, uint32_t count)
{
    return critical_by(s, push, count, 1);
}

static double factor_of(const dmb_buckling *found, uint32_t mode)
{
    double factor = 0.0;
    assert_int_equal(dmb_buckling_factor(found, mode, &factor), DMB_OK);
    return factor;
}

/* A joint between strings or to the ground (part {0, 0}), whose place is then the origin. */
static dmb_joint_def joint_of(int32_t kind, dmb_place a, dmb_place b, double spring)
{
    dmb_joint_def joint = joint_between(kind, a, b);
    joint.stiffness[DMB_RY] = joint.stiffness[DMB_RZ] = spring;
    return joint;
}

/* One string of `elements` from x on, a column of that length. */
static dmb_id add_link(rig *s, double x, double length, int32_t kind, uint32_t elements, int32_t start, int32_t end)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(length, elements, 1e6 * EI, 1e6 * EI, EI, EI);
    string.position[0] = x;
    string.start_free = start;
    string.end_free = end;
    pipe.kind = kind;
    pipe.string = add_string(s, &string);
    (void)add_pipes(s, &pipe, 1);
    return pipe.string;
}

/* ---- Rigid links --------------------------------------------------------------------------------------------------
 */

/* Two links of length L stand on a spring k and bear another between them, the push on top: (3 -+ sqrt 5)/2 k/L. */
static void two_links(void **state)
{
    (void)state;
    const double k = 300.0, L = 2.0;
    rig s;
    double base[6], tip[6];
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id lower = add_link(&s, 0.0, L, DMB_PIPE_RIGID, 1, DMB_FREE_ALL, DMB_FREE_ALL);
    const dmb_id upper = add_link(&s, L, L, DMB_PIPE_RIGID, 1, DMB_FREE_ALL, DMB_FREE_ALL);
    const dmb_joint_def foot =
        joint_of(DMB_JOINT_UNIVERSAL, dmb_station(ground_id, 0, 0.0), dmb_station(lower, 0, 0.0), k);
    const dmb_joint_def knee = joint_of(DMB_JOINT_UNIVERSAL, dmb_station(lower, 0, 1.0), dmb_station(upper, 0, 0.0), k);
    (void)add_joint(&s, &foot);
    (void)add_joint(&s, &knee);
    const dmb_id push = add_push(&s, dmb_station(upper, 0, 1.0));
    (void)mechanism_start(&s, NULL);
    dmb_buckling *found = critical(&s, push, 4);
    check_relative("two links, (3 - sqrt 5)/2 k/L", factor_of(found, 0), 0.5 * (3.0 - sqrt(5.0)) * k / L, 1e-9);
    check_relative("  in the other plane", factor_of(found, 1), 0.5 * (3.0 - sqrt(5.0)) * k / L, 1e-9);
    check_relative("  (3 + sqrt 5)/2 k/L", factor_of(found, 2), 0.5 * (3.0 + sqrt(5.0)) * k / L, 1e-9);
    check_relative("  in the other plane", factor_of(found, 3), 0.5 * (3.0 + sqrt(5.0)) * k / L, 1e-9);
    /* the upper link turns by (1 + sqrt 5)/2 times the lower one's angle */
    assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(lower, 0, 0.5), base), DMB_OK);
    assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(upper, 0, 0.5), tip), DMB_OK);
    check_relative("  angles of the shape", hypot(tip[4], tip[5]) / hypot(base[4], base[5]), 0.5 * (1.0 + sqrt(5.0)),
                   1e-7);
    dmb_buckling_destroy(&found);
    rig_close(&s);
}

/* ---- Columns with a joint in the middle ----------------------------------------------------------------------------
 */

#define LENGTH 10.0

/* A foot hinged to the ground in two planes, and a top that stays on the x axis. */
static void pin_ends(rig *s, dmb_id foot, dmb_id top)
{
    const dmb_place ground = dmb_station(ground_id, 0, 0.0);
    const dmb_joint_def hinge = joint_of(DMB_JOINT_UNIVERSAL, ground, dmb_station(foot, 0, 0.0), 0.0);
    const dmb_joint_def line = joint_of(DMB_JOINT_POINT_ON_LINE, ground, dmb_station(top, 0, 1.0), 0.0);
    (void)add_joint(s, &hinge);
    (void)add_joint(s, &line);
}

/* Two halves of 16 elements joined in the middle. */
static dmb_id open_column(rig *s, const dmb_joint_def *middle, int ends)
{
    dmb_joint_def joint = *middle;
    rig_open(s, 0.0, 0.0, 0.0);
    const dmb_id lower = add_link(s, 0.0, 0.5 * LENGTH, DMB_PIPE_FLEXIBLE, 16,
                                  ends == CLAMPED ? DMB_FREE_NONE : DMB_FREE_ALL, DMB_FREE_ALL);
    const dmb_id upper = add_link(s, 0.5 * LENGTH, 0.5 * LENGTH, DMB_PIPE_FLEXIBLE, 16, DMB_FREE_ALL,
                                  ends == CLAMPED ? CLAMPED_ROLLER : DMB_FREE_ALL);
    joint.place_a = dmb_station(lower, 0, 1.0);
    joint.place_b = dmb_station(upper, 0, 0.0);
    (void)add_joint(s, &joint);
    if (ends == PINNED) pin_ends(s, lower, upper);
    return add_push(s, dmb_station(upper, 0, 1.0));
}

/* x tan x = k L/EI, P = 4 EI x^2/L^2: between the links' 4 k/L and Euler's load. */
static double sprung_column(double k)
{
    double low = 0.0, high = 0.5 * PI;
    for (int i = 0; i < 200; i++) {
        const double x = 0.5 * (low + high);
        if (x * tan(x) < k * LENGTH / EI)
            low = x;
        else
            high = x;
    }
    return 4.0 * EI * low * low / (LENGTH * LENGTH);
}

static void spring_in_the_middle(void **state)
{
    (void)state;
    const double springs[] = {1e2, 1e4, 1e5, 1e7};
    const dmb_place none = dmb_station(ground_id, 0, 0.0);
    for (int i = 0; i < 4; i++) {
        rig s;
        const dmb_joint_def middle = joint_of(DMB_JOINT_UNIVERSAL, none, none, springs[i]);
        const dmb_id push = open_column(&s, &middle, PINNED);
        (void)mechanism_start(&s, NULL);
        dmb_buckling *found = critical(&s, push, 2);
        print_message("spring of %g N m/rad: %.6f N\n", springs[i], factor_of(found, 0));
        check_relative("  x tan x = k L/EI", factor_of(found, 0), sprung_column(springs[i]), 2e-6);
        check_relative("  in the other plane", factor_of(found, 1), factor_of(found, 0), 1e-8);
        dmb_buckling_destroy(&found);
        rig_close(&s);
    }
}

/* Clamped at both ends, hinged in the middle: each half is a cantilever, pi^2 EI/L^2; a hinge about y alone leaves the
 * other plane the clamped column's 4 pi^2 EI/L^2. */
static void hinge_between_clamps(void **state)
{
    (void)state;
    const double euler = PI * PI * EI / (LENGTH * LENGTH);
    const dmb_place none = dmb_station(ground_id, 0, 0.0);
    for (int revolute = 0; revolute < 2; revolute++) {
        rig s;
        dmb_joint_def middle = joint_of(revolute ? DMB_JOINT_REVOLUTE : DMB_JOINT_UNIVERSAL, none, none, 0.0);
        if (revolute) {
            middle.axis_a[0] = middle.axis_b[0] = 0.0;
            middle.axis_a[1] = middle.axis_b[1] = 1.0;
        }
        const dmb_id push = open_column(&s, &middle, CLAMPED);
        (void)mechanism_start(&s, NULL);
        dmb_buckling *found = critical(&s, push, 2);
        check_relative(revolute ? "clamped, hinged about y" : "clamped, crossed hinges", factor_of(found, 0), euler,
                       2e-6);
        check_relative("  in the other plane", factor_of(found, 1), (revolute ? 4.0 : 1.0) * euler, 2e-5);
        dmb_buckling_destroy(&found);
        rig_close(&s);
    }
}

/* Euler's column on hinges, and beside it half of another without any joint. */
static void columns_side_by_side(void **state)
{
    (void)state;
    rig s;
    const double euler = PI * PI * EI / (LENGTH * LENGTH);
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id jointed = add_link(&s, 0.0, LENGTH, DMB_PIPE_FLEXIBLE, 48, DMB_FREE_ALL, DMB_FREE_ALL);
    const dmb_id plain = add_link(&s, 0.0, 0.4 * LENGTH, DMB_PIPE_FLEXIBLE, 16, DMB_FREE_SPHERICAL, FREE_TO_MOVE);
    pin_ends(&s, jointed, jointed);
    dmb_load_def push = dmb_load_def_default();
    push.force[0] = -1.0;
    push.place = dmb_station(jointed, 0, 1.0);
    (void)add_load(&s, &push);
    push.place = dmb_station(plain, 0, 1.0);
    (void)add_load(&s, &push);
    (void)mechanism_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    dmb_buckling *found = NULL;
    dmb_buckling_options options = dmb_buckling_options_default();
    options.count = 6;
    must(&s, dmb_analysis_buckling(s.sim, &options, &found));
    const double want[6] = {1.0, 1.0, 1.5625, 1.5625, 4.0, 4.0};
    double worst = 0.0;
    for (uint32_t i = 0; i < 6; i++) worst = fmax(worst, fabs((1.0 + factor_of(found, i)) / (want[i] * euler) - 1.0));
    check_below("with and without joints, the first 6 critical loads", worst, 5e-6);
    dmb_buckling_destroy(&found);
    rig_close(&s);
}

/* Nothing holds the joint: as a mechanism it is told from a column. */
static void mechanisms_are_refused(void **state)
{
    (void)state;
    rig s;
    dmb_buckling *found = NULL;
    const dmb_place none = dmb_station(ground_id, 0, 0.0);
    const dmb_joint_def middle = joint_of(DMB_JOINT_UNIVERSAL, none, none, 0.0);
    (void)open_column(&s, &middle, PINNED);
    (void)mechanism_start(&s, NULL);
    assert_int_equal(dmb_analysis_buckling(s.sim, NULL, &found), DMB_ERR_SINGULAR);
    assert_null(found);
    print_message("mechanism: %s\n", dmb_sim_message(s.sim));
    rig_close(&s);
}

/* ---- A shallow truss -----------------------------------------------------------------------------------------------
 */

#define HALF_SPAN 10.0
#define RISE 1.0
#define EA 1e6

/* Load on the top at height h: 2 EA (h/l - h/l0), l^2 = b^2 + h^2, at most where l^3 = b^2 l0. */
static double truss_load(double h)
{
    return 2.0 * EA * (h / hypot(HALF_SPAN, h) - h / hypot(HALF_SPAN, RISE));
}

static double truss_limit(void)
{
    const double l = cbrt(HALF_SPAN * HALF_SPAN * hypot(HALF_SPAN, RISE));
    return truss_load(sqrt(l * l - HALF_SPAN * HALF_SPAN));
}

/* The truss is in the plane of x and `up`, its top on the positive or negative side. */
typedef struct truss {
    int up;
    double side;
} truss;

/* Two bars on hinges, their top pushed towards the line of the supports by `present` and by what the analyses add. */
static dmb_id open_truss(rig *s, const truss *t, double present)
{
    const int about = t->up == 2 ? 1 : 2;
    const double length = hypot(HALF_SPAN, RISE), angle = (t->up == 2 ? -t->side : t->side) * atan2(RISE, HALF_SPAN);
    dmb_id bars[2];
    rig_open(s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 2; i++) {
        dmb_string_def string = dmb_string_def_default();
        dmb_pipe_def pipe = beam_pipe(length, 1, EA, EA, EA, EA);
        string.position[0] = i == 0 ? -HALF_SPAN : 0.0;
        string.position[t->up] = i == 0 ? 0.0 : t->side * RISE;
        string.rotation[about] = i == 0 ? angle : -angle;
        string.start_free = DMB_FREE_ALL;
        pipe.string = bars[i] = add_string(s, &string);
        (void)add_pipes(s, &pipe, 1);
    }
    for (int i = 0; i < 3; i++) {
        dmb_joint_def hinge = dmb_joint_def_default();
        hinge.kind = DMB_JOINT_REVOLUTE;
        hinge.axis_a[0] = 0.0;
        hinge.axis_a[about] = 1.0;
        hinge.match = 1;
        hinge.place_a = i == 1 ? dmb_station(bars[0], 0, 1.0) : dmb_station(ground_id, 0, 0.0);
        hinge.place_b = i == 0 ? dmb_station(bars[0], 0, 0.0) : dmb_station(bars[1], 0, i == 1 ? 0.0 : 1.0);
        if (i != 1) hinge.origin_a[0] = i == 0 ? -HALF_SPAN : HALF_SPAN;
        (void)add_joint(s, &hinge);
    }
    dmb_load_def push = dmb_load_def_default();
    push.place = dmb_station(bars[0], 0, 1.0);
    push.force[t->up] = -t->side * present;
    (void)add_load(s, &push);
    const dmb_segment off = dmb_segment_default();
    push.force[t->up] = -t->side;
    push.time_function = add_time_function(s, &off, 1);
    const dmb_id more = add_load(s, &push);
    (void)mechanism_start(s, NULL);
    return more;
}

/* Towards a limit point the stiffness falls with the root of what is left of the load, so that the factor extrapolated
 * from one state tells twice of it: the nearer, the more exactly, and only if the turning of the joints' own equations
 * is in it. Followed along the equilibria it tells the limit itself. */
static void near_the_limit(const truss *t)
{
    const double limit = truss_limit(), parts[] = {0.9, 0.99, 0.999, 0.9999};
    rig s;
    dmb_path_options options = dmb_path_options_default();
    dmb_path_report report = dmb_path_report_default();
    options.scale = DMB_SCALE_PART;
    options.part = open_truss(&s, t, 0.0);
    options.factor_end = 2.0 * limit;
    options.max_points = 60;
    must(&s, dmb_analysis_path(s.sim, &options, &report));
    check_relative("limit load of the truss by its path", report.first_limit, limit, 1e-7);
    rig_close(&s);
    for (int i = 0; i < 4; i++) {
        const dmb_id more = open_truss(&s, t, parts[i] * limit);
        (void)find_equilibrium(&s, NULL);
        dmb_buckling *found = critical_by(&s, more, 1, 0);
        const double ratio = factor_of(found, 0) / ((1.0 - parts[i]) * limit);
        print_message("at %g of the limit: linear factor over what is left %.6f\n", parts[i], ratio);
        check_close("  twice", ratio, 2.0, 1.1 * sqrt(1.0 - parts[i]));
        dmb_buckling_destroy(&found);
        dmb_buckling_info info = dmb_buckling_info_default();
        found = critical(&s, more, 1);
        assert_int_equal(dmb_buckling_get_info(found, &info), DMB_OK);
        assert_int_equal(info.end, DMB_BUCKLING_LIMIT);
        check_relative("  followed", factor_of(found, 0), (1.0 - parts[i]) * limit, 1e-6);
        dmb_buckling_destroy(&found);
        rig_close(&s);
    }
}

static void truss_near_its_limit(void **state)
{
    static const truss all[] = {{2, 1.0}, {2, -1.0}, {1, 1.0}, {1, -1.0}};
    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) near_the_limit(&all[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_links),
        cmocka_unit_test(spring_in_the_middle),
        cmocka_unit_test(hinge_between_clamps),
        cmocka_unit_test(columns_side_by_side),
        cmocka_unit_test(mechanisms_are_refused),
        cmocka_unit_test(truss_near_its_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
