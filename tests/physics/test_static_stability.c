/* Whether a static state is stable, its report against closed forms, its modes and a run in time: shafts under end
 * torque (Greenhill 1883), where moments with a fixed axis make the stiffness unsymmetric, and columns that may turn.
 * Equations: eq:static.characteristic, eq:static.friction-turned. */
#include "mechanism.h"
#include "pushed_column.h"

#define EI 2e5 /* [N m2] stiff in stretch and shear, which the closed forms leave out */
#define LENGTH 10.0
#define GREENHILL (2.0 * PI * EI / LENGTH)              /* [N m] pinned, both moments with a fixed axis */
#define CLAMPED (2.0 * 4.493409457909064 * EI / LENGTH) /* [N m] tan x = x, T = 2 x EI/L */

enum { ENDS_PINNED, ENDS_CLAMPED, END_FREE };

typedef struct shaft {
    rig s;
    dmb_id string, kick;
} shaft;

static dmb_place none(void)
{
    return dmb_station((dmb_id){0, 0}, 0, 0.0);
}

static void add_moment(shaft *h, uint32_t end, int32_t frame, double moment)
{
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(h->string, end, end);
    load.frame = frame;
    load.moment[0] = moment;
    (void)add_load(&h->s, &load);
}

/* A push aside in the middle that is there for a hundredth of a second, from 0.1 s on. */
static void add_kick(shaft *h)
{
    dmb_load_def load = dmb_load_def_default();
    dmb_segment on[2] = {dmb_segment_default(), dmb_segment_default()};
    for (int i = 0; i < 2; i++) {
        on[i].kind = DMB_SEGMENT_STEP;
        on[i].x0 = 0.1 + 0.01 * i;
        on[i].x1 = 0.105 + 0.01 * i;
        on[i].h1 = i ? -1.0 : 1.0;
    }
    load.place = dmb_station(h->string, 0, 1.0);
    load.force[1] = 1e-6;
    load.time_function = add_time_function(&h->s, on, 2);
    h->kick = add_load(&h->s, &load);
}

static void open_shaft(shaft *h, uint32_t elements, int ends, int32_t frame, double torque)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(0.5 * LENGTH, elements / 2, 1e6 * EI, 1e6 * EI, EI / 1.3, EI);
    rig_open(&h->s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = ends == ENDS_PINNED ? DMB_FREE_ALL : DMB_FREE_NONE;
    string.end_free = ends == ENDS_CLAMPED ? DMB_FREE_CYLINDRICAL : DMB_FREE_ALL;
    pipe.string = h->string = add_string(&h->s, &string);
    (void)add_pipes(&h->s, &pipe, 2);
    if (ends == ENDS_PINNED) { /* the foot does not turn about the axis, but nothing turns it: it bears no torque */
        (void)add_joint_between(&h->s, DMB_JOINT_UNIVERSAL, none(), dmb_station(h->string, 0, 0.0));
        (void)add_joint_between(&h->s, DMB_JOINT_POINT_ON_LINE, none(), dmb_station(h->string, 1, 1.0));
        add_moment(h, 0, frame, -torque);
    }
    add_moment(h, 1, frame, torque);
    add_kick(h);
    (void)rig_start(&h->s, NULL);
}

static dmb_static_report settle(const shaft *h)
{
    dmb_static_report report = dmb_static_report_default();
    const int32_t status = dmb_analysis_static(h->s.sim, NULL, &report);
    must(&h->s, status);
    assert_int_equal(status, report.negative > 0 ? DMB_NOTE_UNSTABLE : DMB_OK);
    return report;
}

/* Real growing modes, and the fastest growth [1/s] of any, without damping. */
static int32_t diverging_modes(const shaft *h, double *growth)
{
    dmb_modes *modes = NULL;
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes_info info = dmb_modes_info_default();
    int32_t count = 0;
    options.select = DMB_MODES_ALL;
    must(&h->s, dmb_analysis_modes(h->s.sim, &options, &modes));
    assert_int_equal(dmb_modes_get_info(modes, &info), DMB_OK);
    *growth = 0.0;
    for (uint32_t i = 0; i < info.count; i++) {
        dmb_mode mode = dmb_mode_default();
        assert_int_equal(dmb_modes_get(modes, i, &mode), DMB_OK);
        *growth = fmax(*growth, mode.eigenvalue[0]);
        if (mode.eigenvalue[0] < 0.01 || mode.eigenvalue[1] > 1e-3 * mode.eigenvalue[0]) continue;
        count += mode.eigenvalue[1] > 0.0 ? 2 : 1; /* rounding may split a double root into a pair */
    }
    dmb_modes_destroy(&modes);
    return count;
}

/* Two directions at once leave the pinned shaft at each multiple of Greenhill's torque, either way round. */
static void pinned_shaft_diverges(void **state)
{
    (void)state;
    const double part[6] = {0.95, 0.99, 1.01, 1.2, -1.2, 3.05};
    const int32_t want[6] = {0, 0, 2, 2, 2, 6};
    for (int i = 0; i < 6; i++) {
        shaft h;
        double growth;
        open_shaft(&h, 16, ENDS_PINNED, DMB_FRAME_WORLD, part[i] * GREENHILL);
        const dmb_static_report report = settle(&h);
        if (want[i] > 0) must_say(&h.s, "real negative eigenvalues");
        const int32_t modes = diverging_modes(&h, &growth);
        print_message("    %5.2f of Greenhill's torque: %d negative, %d modes diverge, growth %.4g/s\n", part[i],
                      report.negative, modes, growth);
        assert_int_equal(report.stiffness, DMB_STIFFNESS_UNSYMMETRIC);
        assert_int_equal(report.negative, want[i]);
        assert_true((modes > 0) == (want[i] > 0)); /* a double root may be told as one mode or two */
        rig_close(&h.s);
    }
}

/* A kick dies away or stays below, and grows as the mode does above. */
static void run_in_time_agrees(void **state)
{
    (void)state;
    const double part[2] = {0.97, 1.03};
    double late[2], growth = 0.0;
    for (int i = 0; i < 2; i++) {
        shaft h;
        open_shaft(&h, 16, ENDS_PINNED, DMB_FRAME_WORLD, part[i] * GREENHILL);
        (void)settle(&h);
        (void)diverging_modes(&h, &growth);
        take_steps(&h.s, 5e-3, 300);
        const dmb_pose then = pose_at(&h.s, dmb_station(h.string, 0, 1.0));
        take_steps(&h.s, 5e-3, 40);
        const dmb_pose now = pose_at(&h.s, dmb_station(h.string, 0, 1.0));
        late[i] = hypot(now.displacement[1], now.displacement[2]);
        if (i == 1)
            check_relative("growth of the kick, that of the mode [1/s]",
                           log(late[1] / hypot(then.displacement[1], then.displacement[2])) / 0.2, growth, 1e-2);
        rig_close(&h.s);
    }
    tell("middle aside after 1.7 s, 3 % below [m]", late[0]);
    tell("  3 % above [m]", late[1]);
    assert_true(late[1] > 1e3 * late[0]);
}

/* Clamped ends do not turn the moment's axis: the stiffness is symmetric, and two directions leave at T = 2 x EI/L. */
static void clamped_shaft_buckles(void **state)
{
    (void)state;
    const double part[3] = {0.99, 1.01, -1.01};
    for (int i = 0; i < 3; i++) {
        shaft h;
        double growth;
        open_shaft(&h, 32, ENDS_CLAMPED, DMB_FRAME_WORLD, part[i] * CLAMPED);
        const dmb_static_report report = settle(&h);
        assert_int_equal(report.stiffness, DMB_STIFFNESS_SYMMETRIC);
        assert_int_equal(report.negative, i > 0 ? 2 : 0);
        assert_int_equal(diverging_modes(&h, &growth) > 0, i > 0);
        rig_close(&h.s);
    }
}

/* A cantilever under a moment with a fixed axis flutters at any torque without damping and never diverges: the report
 * tells the kind of stiffness, and that nothing diverges. */
static void cantilever_flutters(void **state)
{
    (void)state;
    shaft h;
    double growth;
    open_shaft(&h, 16, END_FREE, DMB_FRAME_WORLD, 6.0 * EI / LENGTH);
    const dmb_static_report report = settle(&h);
    assert_int_equal(report.stiffness, DMB_STIFFNESS_UNSYMMETRIC);
    assert_int_equal(report.negative, 0);
    assert_int_equal(diverging_modes(&h, &growth), 0);
    tell("flutter of a cantilever under end torque, growth [1/s]", growth);
    assert_true(growth > 1.0);
    rig_close(&h.s);
}

/* The path of equilibria crosses Greenhill's torque, as a bifurcation in two directions, of second order in the mesh.
 */
static void path_tells_greenhills_torque(void **state)
{
    (void)state;
    const uint32_t elements[4] = {16, 32, 64, 128};
    double error[4];
    for (int i = 0; i < 4; i++) {
        shaft h;
        dmb_path_options options = dmb_path_options_default();
        dmb_path_report report = dmb_path_report_default();
        open_shaft(&h, elements[i], ENDS_PINNED, DMB_FRAME_WORLD, EI / LENGTH);
        (void)settle(&h);
        options.factor_end = 6.0; /* on top of the present torque */
        must(&h.s, dmb_analysis_path(h.s.sim, &options, &report));
        assert_int_equal(report.bifurcations, 1);
        error[i] = fabs((1.0 + report.first_bifurcation) / (2.0 * PI) - 1.0);
        print_message("    %3u elements: T L/EI %.8f\n", elements[i], 1.0 + report.first_bifurcation);
        rig_close(&h.s);
    }
    check_below("2 pi with 64 elements", error[2], 1e-4);
    check_below("  with 128 elements", error[3], 2.5e-5);
    check_order("Greenhill's torque, 32 and 64 elements", error[1], error[2], 2.0, 0.05);
}

/* At the end of a path the report tells how far it came: twisted by 2.5 rad an element. */
static void lost_path_is_reported(void **state)
{
    (void)state;
    shaft h;
    dmb_path_options options = dmb_path_options_default();
    dmb_path_report report = dmb_path_report_default();
    open_shaft(&h, 8, ENDS_CLAMPED, DMB_FRAME_WORLD, EI / LENGTH);
    (void)settle(&h);
    options.factor_end = 30.0;
    assert_int_equal(dmb_analysis_path(h.s.sim, &options, &report), DMB_ERR_ROTATION);
    must_say(&h.s, "2.5 rad");
    assert_true(report.points > 3 && report.bifurcations >= 1 && report.first_bifurcation < 9.0);
    check_relative("end of the path, T L/(8 GJ) = 2.5", 1.0 + report.factor, 8.0 * 2.5 / 1.3, 1e-3);
    rig_close(&h.s);
}

/* A buckled column with a hinged foot may turn about its load, with joints and without: that is no instability, but one
 * eigenvalue is of rounding size, and the count is reported as not resolved. */
static void turning_about_the_load_is_neutral(void **state)
{
    (void)state;
    for (int jointed = 0; jointed < 2; jointed++) {
        rig s;
        dmb_string_def string = dmb_string_def_default();
        dmb_pipe_def pipe = beam_pipe(LENGTH, 16, 1e6 * EI, 1e6 * EI, EI / 1.3, EI);
        dmb_load_def push = dmb_load_def_default();
        dmb_static_report report = dmb_static_report_default();
        dmb_segment aside = dmb_segment_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        string.follows_hole = 0;
        string.start_free = jointed ? DMB_FREE_ALL : DMB_FREE_NONE;
        pipe.string = add_string(&s, &string);
        (void)add_pipes(&s, &pipe, 1);
        if (jointed) (void)add_joint_between(&s, DMB_JOINT_FIXED, none(), dmb_station(pipe.string, 0, 0.0));
        push.place = dmb_station(pipe.string, 0, 1.0);
        push.force[0] = -1.1 * PI * PI * EI / (4.0 * LENGTH * LENGTH);
        (void)add_load(&s, &push);
        aside.kind = DMB_SEGMENT_STEP;
        aside.h0 = 1.0;
        aside.x1 = 1e-6;
        push.time_function = add_time_function(&s, &aside, 1);
        push.force[0] = 0.0;
        push.force[1] = 0.6 * 500.0;
        push.force[2] = 0.8 * 500.0;
        (void)add_load(&s, &push);
        (void)rig_start(&s, NULL);
        assert_int_equal(dmb_analysis_static(s.sim, NULL, &report), DMB_OK);
        must(&s, dmb_sim_step(s.sim, 1e-6, NULL));
        const int32_t status = dmb_analysis_static(s.sim, NULL, &report);
        must(&s, status);
        const dmb_pose end = pose_at(&s, push.place);
        print_message("    %s: end aside %.6f m, %d negative\n", jointed ? "on a joint" : "on a support",
                      hypot(end.displacement[1], end.displacement[2]), report.negative);
        assert_true(hypot(end.displacement[1], end.displacement[2]) > 1.0);
        assert_int_equal(status, DMB_NOTE_INCOMPLETE);
        assert_int_equal(report.negative, -1);
        assert_int_equal(report.unresolved, 1);
        assert_true(report.resolution > 0.0 && report.resolution < 1e-6 * 1e6 * EI * 16.0 / LENGTH);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pinned_shaft_diverges),
        cmocka_unit_test(run_in_time_agrees),
        cmocka_unit_test(clamped_shaft_buckles),
        cmocka_unit_test(cantilever_flutters),
        cmocka_unit_test(path_tells_greenhills_torque),
        cmocka_unit_test(lost_path_is_reported),
        cmocka_unit_test(turning_about_the_load_is_neutral),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
