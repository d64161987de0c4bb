/* Paths of equilibrium past limit points and onto branches: a column beyond Euler's load, a truss that snaps through, a
 * circular arch. Equations: eq:buckling.arc. */
#include <stdio.h>

#include "rig.h"

enum { FREE_TO_MOVE = DMB_FREE_TRANSLATIONS };

/* The points of a path. */
typedef struct tale {
    uint32_t points;
    dmb_path_point point[400];
    double slope[400]; /* [rad] of the place looked at */
    dmb_place place;
} tale;

static int32_t hear(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    tale *t = context;
    dmb_pose pose = dmb_pose_default();
    assert_int_equal(dmb_query_pose(at, t->place, &pose), DMB_OK);
    assert_true(t->points < 400);
    t->slope[t->points] = atan2(hypot(pose.rotation[3], pose.rotation[6]), pose.rotation[0]);
    t->point[t->points++] = *point;
    return 0;
}

static void show(const tale *t)
{
    static const char *const kinds[] = {"", "limit point", "bifurcation", "branch"};
    for (uint32_t i = 0; i < t->points; i++)
        print_message("    %2u: factor %.10g, displacement %.8g, %d negative, %u iterations %s\n", t->point[i].number,
                      t->point[i].factor, t->point[i].displacement, t->point[i].negative, t->point[i].iterations,
                      kinds[t->point[i].kind]);
}

/* The path of a load on its own, looked at in one component of the place where it acts, told to t. */
static dmb_path_options path_of(dmb_id load, dmb_place place, int32_t component, tale *t)
{
    dmb_path_options options = dmb_path_options_default();
    options.scale = DMB_SCALE_PART;
    options.part = load;
    options.place = place;
    options.component = component;
    options.callback = hear;
    options.callback_context = t;
    return options;
}

/* ---- Euler's column ---------------------------------------------------------------------------------------------- */

/* Half of S1, 10 m pinned: pinned at the rig end, the middle moves but does not turn. Pushed straight up to Euler's
 * load, then along the branch to an end slope of 60 degrees: P/Pcr 1.1517196205, v_mid/L .2966038231, shortening
 * .2589803939 (elastica). */
static rig half_column(uint32_t elements, dmb_load_def *load, dmb_id *push)
{
    rig s;
    const double EI = s1_values().EI;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def beam = beam_pipe(5.0, elements, 1e7 * EI, 1e7 * EI, EI, EI);
    rig_open(&s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_SPHERICAL;
    def.end_free = FREE_TO_MOVE;
    beam.string = add_string(&s, &def);
    load->place = dmb_station(add_pipes(&s, &beam, 1), 0, 1.0);
    load->force[0] = -PI * PI * EI / 100.0;
    load->time_function = add_constant(&s, 0.0);
    *push = add_load(&s, load);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    return s;
}

static void check_elastica(uint32_t elements, double tolerance)
{
    tale t = {.points = 0};
    dmb_load_def load = dmb_load_def_default();
    dmb_path_report report = dmb_path_report_default();
    dmb_id push;
    rig s = half_column(elements, &load, &push);
    t.place = load.place;
    t.place.fraction = 0.0;
    dmb_path_options options = path_of(push, load.place, DMB_X, &t);
    options.branch = 1;
    options.branch_size = 0.05;
    options.factor_end = 2.0;
    options.displacement_end = -0.2589803939 * 5.0;
    uint64_t before, after;
    must(&s, dmb_sim_hash(s.sim, &before));
    must(&s, dmb_analysis_path(s.sim, &options, &report));
    must(&s, dmb_sim_hash(s.sim, &after));
    assert_true(before == after);
    if (elements == 16) show(&t);
    print_message("    %u elements for 5 m, %u points, %u iterations, %u cuts\n", elements, report.points,
                  report.iterations, report.cuts);
    check_relative("    bifurcation at Euler's load", report.first_bifurcation, 1.0, tolerance);
    check_close("    P/Pcr at the shortening of 60 degrees", report.factor, 1.1517196205, tolerance);
    check_close("    end slope [rad]", t.slope[t.points - 1], PI / 3.0, 2.0 * tolerance);
    assert_int_equal(report.limits, 0);
    rig_close(&s);
}

static void elastica_by_its_branch(void **state)
{
    (void)state;
    check_elastica(8, 1e-4);
    check_elastica(16, 1e-5);
    check_elastica(32, 1e-6);
}

/* [-] P/Pcr of the elastica with an end slope: (2 K(sin(slope/2))/pi)^2, K by the arithmetic-geometric mean. */
static double elastica(double slope)
{
    double a = 1.0, b = cos(0.5 * slope);
    for (int i = 0; i < 20; i++) {
        const double mean = 0.5 * (a + b);
        b = sqrt(a * b);
        a = mean;
    }
    return 1.0 / (a * a);
}

/* Steps off the straight column that are too long for the elastica are halved until one comes onto it. */
static void onto_the_branch_by_too_long_a_step(void **state)
{
    static const double size[4] = {3.0, 15.0, 80.0, 260.0}; /* [m] of 5 m */
    (void)state;
    for (int i = 0; i < 4; i++) {
        tale t = {.points = 0};
        dmb_load_def load = dmb_load_def_default();
        dmb_path_report report = dmb_path_report_default();
        dmb_id push;
        rig s = half_column(16, &load, &push);
        t.place = load.place;
        t.place.fraction = 0.0;
        dmb_path_options options = path_of(push, load.place, DMB_X, &t);
        options.branch = 1;
        options.branch_size = size[i];
        options.factor_end = 1e4;
        options.max_points = 2;
        must(&s, dmb_analysis_path(s.sim, &options, &report));
        const dmb_path_point *end = t.point + t.points - 1;
        print_message("    %g m: %u cuts, slope %g rad\n", size[i], report.cuts, t.slope[t.points - 1]);
        assert_int_equal(end->kind, DMB_PATH_BRANCH);
        assert_true(t.slope[t.points - 1] > 0.5 && (i == 0 || report.cuts > 0));
        check_relative("    P/Pcr by the slope", end->factor, elastica(t.slope[t.points - 1]), 1e-5);
        rig_close(&s);
    }
}

/* The whole column, its far end on a line by a joint, buckles in its plane under the same load. */
static void pinned_column_with_a_joint(void **state)
{
    (void)state;
    rig s;
    tale t = {.points = 0};
    const double EI = s1_values().EI, euler = PI * PI * EI / 100.0;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def beam = beam_pipe(10.0, 32, 1e6 * EI, 1e6 * EI, EI, EI);
    dmb_joint_def support = dmb_joint_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_path_report report = dmb_path_report_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_RZ; /* in the x-y plane, and not free to turn about itself */
    beam.string = add_string(&s, &def);
    const dmb_id string = add_pipes(&s, &beam, 1);
    support.kind = DMB_JOINT_POINT_ON_LINE;
    support.place_b = load.place = t.place = dmb_station(string, 0, 1.0);
    must_model(&s, dmb_model_add_joint(s.model, &support, NULL));
    load.force[0] = -euler;
    load.time_function = add_constant(&s, 0.0);
    const dmb_id push = add_load(&s, &load);
    (void)rig_start(&s, NULL);
    const dmb_static_report rest = find_equilibrium(&s, NULL);
    assert_int_equal(rest.negative, 0);
    dmb_path_options options = path_of(push, load.place, DMB_X, &t);
    options.factor_end = 10.0;
    must(&s, dmb_analysis_path(s.sim, &options, &report));
    show(&t);
    check_relative("first bifurcation at Euler's load", report.first_bifurcation, 1.0, 1e-5);
    double in_plane[2] = {0.0, 0.0};
    for (uint32_t i = 0, k = 0; i < t.points; i++)
        if (t.point[i].kind == DMB_PATH_BIFURCATION && k < 2) in_plane[k++] = t.point[i].factor;
    /* across the plane the rig end is clamped: pinned at the other it buckles at 4.4934^2/pi^2 times the load */
    check_relative("the next, clamped and pinned across the plane", in_plane[1], 4.493409458 * 4.493409458 / (PI * PI),
                   1e-4);
    options.branch = 1;
    options.branch_size = 0.05;
    options.displacement_end = -0.2589803939 * 10.0;
    t.points = 0;
    must(&s, dmb_analysis_path(s.sim, &options, &report));
    check_close("P/Pcr at the shortening of 60 degrees", report.factor, 1.1517196205, 1e-5);
    rig_close(&s);
}

/* ---- Two bars that snap through ---------------------------------------------------------------------------------- */

/* Von Mises' truss: two bars of a stretch stiffness EA, hinged on the ground 2 b apart and to each other h above it. By
 * symmetry one bar, its top guided upright and pushed down by P/2:
 *     P/2 = -EA (h - w)/l (l - L)/L,    l^2 = b^2 + (h - w)^2,  L^2 = b^2 + h^2
 * Largest where d/dw = 0: l^3 = b^2 L, so that the height is sqrt((b^2 L)^(2/3) - b^2). */
static void truss_snaps_through(void **state)
{
    (void)state;
    rig s;
    tale t = {.points = 0};
    const double b = 10.0, h = 2.0, EA = 1e6, L = sqrt(b * b + h * h);
    const double l = cbrt(b * b * L), up = sqrt(l * l - b * b), limit = -EA * up / l * (l - L) / L;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def bar = beam_pipe(L, 1, EA, 1e8, 1e8, 1e8);
    dmb_joint_def support = dmb_joint_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_path_report report = dmb_path_report_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.rotation[1] = -atan2(h, b); /* upwards */
    def.start_free = DMB_FREE_RY;
    bar.string = add_string(&s, &def);
    const dmb_id string = add_pipes(&s, &bar, 1);
    support.kind = DMB_JOINT_POINT_ON_LINE;
    support.place_b = dmb_station(string, 0, 1.0);
    support.origin_a[0] = b;
    support.axis_a[0] = 0.0;
    support.axis_a[2] = 1.0;
    must_model(&s, dmb_model_add_joint(s.model, &support, NULL));
    load.place = support.place_b;
    load.force[2] = -1.0;
    load.time_function = add_constant(&s, 0.0);
    const dmb_id push = add_load(&s, &load);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    t.place = load.place;
    dmb_path_options options = path_of(push, load.place, DMB_Z, &t);
    options.factor_end = 2.0 * limit;
    options.first_step = 0.2 * limit;
    options.displacement_end = -2.0 * h;
    must(&s, dmb_analysis_path(s.sim, &options, &report));
    show(&t);
    assert_int_equal(report.limits, 2);
    check_relative("limit load", report.first_limit, limit, 1e-10);
    for (uint32_t i = 0, first = 1; i < t.points; i++) {
        if (t.point[i].kind != DMB_PATH_LIMIT) continue;
        const double height = h + t.point[i].displacement;
        check_relative(first ? "    height there" : "    height at the other", height, first ? up : -up, 1e-6);
        check_relative("    load", t.point[i].factor, first ? limit : -limit, 1e-10);
        first = 0;
    }
    check_close("turned over it is free of load", report.factor / limit, 0.0, 1e-6);
    rig_close(&s);
}

/* ---- Circular arch ----------------------------------------------------------------------------------------------- */

/* DaDeppo, Schmidt 1975: arch of radius 100 over 215 degrees, clamped at one end and hinged at the other, EI 1e6,
 * inextensible, a dead load down on its crown: in its plane it leans over and falls at 8.97 EI/R^2. The path follows it
 * past 2.44 EI/R^2, where a round section would lean out of the plane. */
static double arch_limit(uint32_t elements)
{
    rig s;
    tale t = {.points = 0};
    const double R = 100.0, EI = 1e6, angle = 215.0 * PI / 180.0;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def half = beam_pipe(0.5 * R * angle, elements, 1e4 * EI, 1e4 * EI, EI, EI);
    dmb_load_def load = dmb_load_def_default();
    dmb_path_report report = dmb_path_report_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.rotation[2] = 0.5 * angle; /* in the x-y plane, from the left over the crown to the right */
    def.start_free = DMB_FREE_RZ;
    def.end_free = DMB_FREE_NONE;
    half.curvature[2] = -1.0 / R;
    half.string = add_string(&s, &def);
    const dmb_id string = add_pipes(&s, &half, 2);
    load.place = dmb_station(string, 0, 1.0);
    load.force[1] = -EI / (R * R);
    load.time_function = add_constant(&s, 0.0);
    const dmb_id push = add_load(&s, &load);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    t.place = load.place;
    dmb_path_options options = path_of(push, load.place, DMB_Y, &t);
    options.factor_end = 20.0;
    options.first_step = 1.0;
    options.displacement_end = -1.3 * R;
    const int32_t status = dmb_analysis_path(s.sim, &options, &report);
    show(&t);
    must(&s, status);
    rig_close(&s);
    return report.first_limit;
}

static void deep_arch_falls(void **state)
{
    (void)state;
    const double coarse = arch_limit(20), fine = arch_limit(40);
    print_message("    20 and 40 elements a half: %.6f, %.6f EI/R^2\n", coarse, fine);
    check_close("limit load, 8.97 EI/R^2", fine, 8.97, 0.005);
}

/* ---- Lee's frame ---------------------------------------------------------------------------------------------------
 */

/* Lee, Manuel, Rossow 1968; Schweizerhof, Wriggers 1986: a post and a beam of 120 each, E 720, A 6, I 2, nu 0.3,
 * clamped to each other, hinged at the other ends, pushed down a fifth of the way along the beam. The load rises
 * to 18.552, falls to -9.4 and rises again; on the way back the load point goes back too. */
static dmb_path_report follow_frame(uint32_t elements, tale *t)
{
    rig s;
    const double E = 720.0, EA = 6.0 * E, EI = 2.0 * E, GA = 5.0 * E / 2.6;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def post = beam_pipe(120.0, elements, EA, GA, EI, EI),
                 near = beam_pipe(24.0, elements / 5, EA, GA, EI, EI);
    dmb_pipe_def far = beam_pipe(96.0, elements - elements / 5, EA, GA, EI, EI);
    dmb_joint_def corner = dmb_joint_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_path_report report = dmb_path_report_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.rotation[1] = -0.5 * PI; /* upwards */
    def.start_free = DMB_FREE_RY;
    post.string = add_string(&s, &def);
    (void)add_pipes(&s, &post, 1);
    def.rotation[1] = 0.0;
    def.position[2] = 120.0;
    def.start_free = DMB_FREE_ALL;
    def.end_free = DMB_FREE_RY;
    near.string = far.string = add_string(&s, &def);
    (void)add_pipes(&s, &near, 1);
    (void)add_pipes(&s, &far, 1);
    corner.place_a = dmb_station(post.string, 0, 1.0);
    corner.place_b = dmb_station(near.string, 0, 0.0);
    corner.match = 1;
    must_model(&s, dmb_model_add_joint(s.model, &corner, NULL));
    load.place = t->place = dmb_station(near.string, 0, 1.0);
    load.force[2] = -EI / (120.0 * 120.0);
    load.time_function = add_constant(&s, 0.0);
    const dmb_id push = add_load(&s, &load);
    (void)rig_start(&s, NULL);
    dmb_path_options options = path_of(push, load.place, DMB_Z, t);
    options.factor_end = 200.0;
    options.first_step = 1.0;
    options.displacement_end = -95.0;
    must(&s, dmb_analysis_path(s.sim, &options, &report));
    rig_close(&s);
    return report;
}

static void frame_snaps_back(void **state)
{
    (void)state;
    double first[3] = {0.0};
    for (uint32_t k = 0; k < 3; k++) {
        tale t = {.points = 0};
        const dmb_path_report report = follow_frame(10u << k, &t);
        double least = 0.0, back = 0.0, deepest = 0.0;
        for (uint32_t i = 0; i < t.points; i++) {
            deepest = fmin(deepest, t.point[i].displacement);
            back = fmax(back, t.point[i].displacement - deepest);
            if (t.point[i].kind == DMB_PATH_LIMIT) least = fmin(least, t.point[i].factor);
        }
        if (k == 0) show(&t);
        print_message("    %2u elements a member: limit loads %.6f, %.6f, back by %.3f, %u points, %u iterations\n",
                      10u << k, report.first_limit, least, back, report.points, report.iterations);
        first[k] = report.first_limit;
        check_relative("    limit load, 18.552 EI/L^2", report.first_limit, 18.552, 5e-4);
        check_close("    the lower one", least, -9.4, 0.1);
        assert_true(report.limits >= 2 && back > 1.0);
        check_relative("    ends where it should", report.displacement, -95.0, 1e-6);
    }
    check_below("limit load, 10 elements against 40", first[0] - first[2], 4e-4);
    check_below("    20 elements", first[1] - first[2], 4e-5);
}

/* ---- Along the wall of a hole ------------------------------------------------------------------------------------ */

/* S1 on the low side, clamped at the rig and guided at the bit, where a load of 1 N times the factor pushes back. */
static dmb_id open_lying(rig *s, uint32_t pipes)
{
    dmb_wall_def wall = s1_hole();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def load = dmb_load_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    wall.stiffness = 1e8;
    wall.friction_law = DMB_FRICTION_NONE;
    (void)add_wall(s, &wall);
    def.start_free = DMB_FREE_NONE;
    def.end_free = DMB_FREE_CYLINDRICAL;
    def.offset[1] = -(0.0105 + 139.3513 / wall.stiffness); /* where the wall carries the weight */
    pipe.elements = 3;
    pipe.string = add_string(s, &def);
    const dmb_id string = add_pipes(s, &pipe, pipes);
    load.place = dmb_station(string, pipes - 1, 1.0);
    load.force[0] = -1.0;
    load.time_function = add_constant(s, 0.0);
    const dmb_id push = add_load(s, &load);
    (void)rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
    return push;
}

/* 30 m: two shapes buckle within 0.3 % of each other. The
 * path finds the first of them whatever its steps, where the linear analysis says, and the branch swings up the wall
 * and carries more, stable, up to 180 kN. */
static int32_t swings(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    double *most = context;
    dmb_contact_total contacts = dmb_contact_total_default();
    assert_int_equal(dmb_query_contact_total(at, &contacts), DMB_OK);
    if (point->kind == DMB_PATH_BRANCH) *most = contacts.normal_force;
    if (*most == 0.0) return 0;
    assert_int_equal(point->negative, 0);
    assert_true(point->rate > 0.0);
    assert_true(contacts.normal_force >= *most);
    *most = contacts.normal_force;
    return 0;
}

static void string_snakes_up_the_wall(void **state)
{
    (void)state;
    rig s;
    dmb_buckling *linear = NULL;
    dmb_buckling_options buckling = dmb_buckling_options_default();
    dmb_path_options options = dmb_path_options_default();
    const double first_step[3] = {5e3, 3e4, 9e4};
    double critical[2], wall_force[3];
    buckling.part = options.part = open_lying(&s, 20);
    buckling.scale = options.scale = DMB_SCALE_PART;
    buckling.count = 2;
    must(&s, dmb_analysis_buckling(s.sim, &buckling, &linear));
    for (uint32_t k = 0; k < 2; k++) must(&s, dmb_buckling_factor(linear, k, critical + k));
    dmb_buckling_destroy(&linear);
    tell("second critical push over the first", critical[1] / critical[0]);
    options.factor_end = 180e3;
    options.branch = 1;
    options.branch_size = options.step_max = 5e-4;
    options.callback = swings;
    for (int k = 0; k < 3; k++) {
        dmb_path_report report = dmb_path_report_default();
        wall_force[k] = 0.0;
        options.callback_context = wall_force + k;
        options.first_step = first_step[k];
        options.step_max = k < 2 ? 5e-4 : 3e-3;
        assert_int_equal(dmb_analysis_path(s.sim, &options, &report), DMB_OK);
        print_message("    first step %.0f N: %u points, %u iterations\n", first_step[k], report.points,
                      report.iterations);
        check_relative("    bifurcation and linear buckling", report.first_bifurcation, critical[0], 5e-4);
        check_relative("    force on the wall at 180 kN", wall_force[k], wall_force[0], 1e-6);
    }
    rig_close(&s);
}

/* Beyond what the snaking string carries it lets go of the wall ring by ring: the path has a corner where each opens or
 * closes, and turns back at many. It goes on to the push asked for (15 m), or says that it has not come so far (30 m,
 * where the branch of one side leads over to that of the other, and down along it into the straight string). */
static void rings_let_go_one_by_one(void **state)
{
    (void)state;
    for (int k = 0; k <= 1; k++) {
        rig s;
        dmb_path_options options = dmb_path_options_default();
        dmb_path_report report = dmb_path_report_default();
        const uint32_t pipes = k == 0 ? 10 : 20;
        options.part = open_lying(&s, pipes);
        options.scale = DMB_SCALE_PART;
        options.factor_end = 250e3;
        options.branch = 1;
        options.branch_size = options.step_max = k == 0 ? 1e-3 : 5e-4;
        options.max_points = k == 0 ? 2000 : 400;
        const int32_t status = dmb_analysis_path(s.sim, &options, &report);
        must(&s, status);
        print_message(
            "    %g m: %s, %u points, %u iterations, %u cuts, %u limit points from %.1f N on, ends at %.1f N\n",
            1.5 * pipes, dmb_status_name(status), report.points, report.iterations, report.cuts, report.limits,
            report.first_limit, report.factor);
        if (k == 0) assert_int_equal(status, DMB_OK);
        if (status == DMB_OK) check_relative("    where it ends", report.factor, 250e3, 1e-9);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elastica_by_its_branch),
        cmocka_unit_test(onto_the_branch_by_too_long_a_step),
        cmocka_unit_test(pinned_column_with_a_joint),
        cmocka_unit_test(truss_snaps_through),
        cmocka_unit_test(deep_arch_falls),
        cmocka_unit_test(frame_snaps_back),
        cmocka_unit_test(string_snakes_up_the_wall),
        cmocka_unit_test(rings_let_go_one_by_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
