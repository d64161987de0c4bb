/* Estimated discretisation error of long elements against the spurious moment of a string that lies on the wall, which
 * statics of the same mesh have, and against its closed form in a curved hole; scenes without such an error have none.
 * Checks eq:beam.mesh-error. */
#include <stdio.h>
#include <string.h>

#include "rig.h"

#define G 9.80665

typedef struct tube {
    double outer, inner, length;
    uint32_t elements, points;
} tube;

static dmb_pipe_def tube_pipe(const tube *t)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.outer_diameter = t->outer;
    pipe.inner_diameter = t->inner;
    pipe.length = t->length;
    pipe.elements = t->elements;
    pipe.contact_points = t->points;
    return pipe;
}

static double second_moment(const tube *t)
{
    return PI / 64.0 * (pow(t->outer, 4.0) - pow(t->inner, 4.0));
}

/* [N/m] */
static double weight(const tube *t)
{
    return 7850.0 * G * PI / 4.0 * (t->outer * t->outer - t->inner * t->inner);
}

/* 12 pipes in a level hole; error by pipe. */
static dmb_id level_string(rig *s, const tube *t, double hole, double error[12])
{
    dmb_wall_def wall = s1_hole();
    const dmb_pipe_def pipe = tube_pipe(t);
    rig_open(s, 0.0, 0.0, -G);
    wall.diameter = hole;
    (void)add_wall(s, &wall);
    const dmb_id string = add_pipes(s, &pipe, 12);
    (void)rig_start(s, NULL);
    assert_int_equal(dmb_analysis_mesh(s->model, string, error, 12), DMB_OK);
    return string;
}

/* The moment at a node in the middle of the lying string is q L^2/12, where a real one has none. */
static void as_statics_have_it(void **state)
{
    static const tube tubes[3] = {{0.073, 0.061, 3.0, 1, 0}, {0.203, 0.071, 37.7, 8, 0}, {0.127, 0.108, 9.4, 2, 0}};
    static const double holes[3] = {0.094, 0.311, 0.216};
    (void)state;
    for (int i = 0; i < 3; i++) {
        rig s;
        double error[12];
        dmb_section section = dmb_section_default();
        char text[64];
        const dmb_id string = level_string(&s, &tubes[i], holes[i], error);
        (void)find_equilibrium(&s, NULL);
        must(&s, dmb_query_section(s.sim, dmb_station(string, 6, 0.0), &section));
        const double found = fabs(section.force[4]) * 0.5 * tubes[i].outer / (2.1e11 * second_moment(&tubes[i]) * 3e-3);
        (void)snprintf(text, sizeof text, "tube of %g mm: estimate over moment of statics", 1e3 * tubes[i].outer);
        check_relative(text, error[6], found, 0.02);
        rig_close(&s);
    }
}

/* Rods of usual length stay one element; a tally's line of collars does not; shorter spacing of contact is counted. */
static void usual_rods(void **state)
{
    static const double outer[5] = {0.050, 0.060, 0.063, 0.073, 0.089}, inner[5] = {0.039, 0.048, 0.049, 0.061, 0.077};
    tube collar = {0.20955, 0.073025, 37.72, 1, 0};
    double error[12];
    rig s;
    (void)state;
    for (int i = 0; i < 5; i++) {
        const tube rod = {outer[i], inner[i], 3.0, 1, 0};
        (void)level_string(&s, &rod, 0.094, error);
        check_below("rods of 3 m", error[0], 0.01);
        rig_close(&s);
    }
    (void)level_string(&s, &collar, 0.311, error);
    const double nodes = error[3];
    check_relative("collars of 37.72 m", nodes,
                   weight(&collar) * pow(37.72, 2.0) / 12.0 * 0.5 * 0.20955 / (2.1e11 * second_moment(&collar) * 3e-3),
                   1e-6);
    rig_close(&s);
    collar.points = 3;
    (void)level_string(&s, &collar, 0.311, error);
    check_relative("with three points of contact", error[3], 0.25 * nodes, 1e-12);
    rig_close(&s);
    collar.points = 0;
    collar.elements = 8;
    (void)level_string(&s, &collar, 0.311, error);
    check_relative("with eight elements", error[3], nodes / 64.0, 1e-12);
    rig_close(&s);
}

/* A hole that builds from the vertical with 1/100 m: weight across and tension times curvature have one direction. */
static void in_a_bend(void **state)
{
    static const double survey[] = {0.0, 0.0, 0.0, 120.0, 1.2, 0.0};
    const tube t = {0.127, 0.108, 10.0, 1, 0};
    const dmb_pipe_def pipe = tube_pipe(&t);
    dmb_wall_def wall = s1_hole();
    dmb_string_def def = dmb_string_def_default();
    double error[12];
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, -G);
    wall.diameter = 0.216;
    wall.survey = survey;
    wall.survey_count = 2;
    (void)add_wall(&s, &wall);
    def.follows_hole = 1;
    const dmb_id string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, 12);
    (void)rig_start(&s, NULL);
    assert_int_equal(dmb_analysis_mesh(s.model, string, error, 12), DMB_OK);
    for (int k = 0; k < 12; k++) {
        const double at = 10.0 * k + 5.0, R = 100.0, w = weight(&t);
        const double tension = w * R * (sin(1.2) - sin(at / R)); /* integral of w cos(s/R) from there to the end */
        const double q = fabs(tension / R - w * sin(at / R));    /* the bend's centre is on the upper side */
        check_relative("side load in a bend", error[k],
                       q * 100.0 / 12.0 * 0.5 * t.outer / (2.1e11 * second_moment(&t) * 3e-3), 0.02);
    }
    rig_close(&s);
}

/* ---- What hangs below -------------------------------------------------------------------------------------------- */

enum { UPPER = 20, COLLARS = 10 };

/* Parts of one weight that hang on the pipes: collars of each kind, tool joints, a bit, a ring, sections on a sub. */
enum { FLEXIBLE, RIGID, AXIAL_TORSIONAL, TOOL_JOINT, BIT, RING, SUB, TWO_SUBS, BELOW };

static const double collar_mass = 7850.0 * PI / 4.0 * (0.2 * 0.2 - 0.07 * 0.07) * 10.0 * COLLARS;

static void add_collars(rig *s, dmb_id string, int32_t kind, uint32_t count)
{
    const tube collar = {0.2, 0.07, 10.0, 1, 0};
    dmb_pipe_def pipe = tube_pipe(&collar);
    pipe.kind = kind;
    pipe.string = string;
    (void)add_pipes(s, &pipe, count);
}

/* A sub with no weight worth mentioning, on a joint of that kind to the string before it; the section after it. */
static dmb_id add_sub(rig *s, dmb_id string, int32_t kind)
{
    dmb_sub_def def = dmb_sub_def_default();
    dmb_sub made = dmb_sub_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = kind;
    body.mass = 1e-3;
    for (int i = 0; i < 3; i++) body.inertia[i] = 1e-6;
    def.string = string;
    def.body = &body;
    def.before = &joint;
    must_model(s, dmb_model_add_sub(s->model, &def, &made));
    return made.section;
}

static void hang(rig *s, dmb_id string, int below)
{
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    bit.string = ring.string = string;
    if (below == FLEXIBLE) add_collars(s, string, DMB_PIPE_FLEXIBLE, COLLARS);
    if (below == RIGID) add_collars(s, string, DMB_PIPE_RIGID, COLLARS);
    if (below == AXIAL_TORSIONAL) add_collars(s, string, DMB_PIPE_AXIAL_TORSIONAL, COLLARS);
    if (below == SUB) add_collars(s, add_sub(s, string, DMB_JOINT_REVOLUTE), DMB_PIPE_FLEXIBLE, COLLARS);
    if (below == TWO_SUBS) {
        const dmb_id second = add_sub(s, string, DMB_JOINT_FIXED);
        add_collars(s, second, DMB_PIPE_RIGID, COLLARS / 2);
        add_collars(s, add_sub(s, second, DMB_JOINT_UNIVERSAL), DMB_PIPE_FLEXIBLE, COLLARS / 2);
    }
    bit.mass = ring.mass = collar_mass;
    ring.pipe = UPPER - 1;
    ring.fraction = 1.0;
    ring.outer_diameter = 0.2;
    if (below == BIT) must_model(s, dmb_model_add_bit(s->model, &bit, NULL));
    if (below == RING) must_model(s, dmb_model_add_stabiliser(s->model, &ring, NULL));
}

/* Pipes from the vertical through a build of 20 degrees in 100 m, down to 200 m; error by pipe. */
static void hung(rig *s, int below, double mud, double error[UPPER + COLLARS])
{
    static const double survey[] = {0.0, 0.0, 0.0, 50.0, 0.0, 0.0, 150.0, PI / 9.0, 0.0, 400.0, PI / 9.0, 0.0};
    const tube t = {0.127, 0.108, 10.0, 1, 0};
    dmb_pipe_def pipe = tube_pipe(&t);
    dmb_wall_def wall = s1_hole();
    dmb_string_def def = dmb_string_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    rig_open(s, 0.0, 0.0, -G);
    environment.gravity[2] = -G;
    environment.fluid_density = mud;
    must_model(s, dmb_model_set_environment(s->model, &environment));
    wall.diameter = 0.216;
    wall.survey = survey;
    wall.survey_count = 4;
    (void)add_wall(s, &wall);
    def.follows_hole = 1;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, below == TOOL_JOINT ? UPPER - 1 : UPPER);
    pipe.joint_length = below == TOOL_JOINT ? 0.5 : 0.0;
    pipe.joint_mass = below == TOOL_JOINT ? collar_mass : 0.0;
    if (below == TOOL_JOINT) (void)add_pipes(s, &pipe, 1);
    hang(s, pipe.string, below);
    (void)rig_start(s, NULL);
    assert_int_equal(dmb_analysis_mesh(s->model, pipe.string, error, UPPER + COLLARS), DMB_OK);
}

/* [-] In the bend: tension, the integral of w cos over the pipes and the weight of what hangs, both less buoyancy. */
static double error_in_bend(uint32_t pipe, double buoyancy)
{
    const tube t = {0.127, 0.108, 10.0, 1, 0};
    const double R = 100.0 / (PI / 9.0), angle = (10.0 * pipe + 5.0 - 50.0) / R, w = buoyancy * weight(&t);
    const double hanging = (buoyancy * collar_mass * G + w * 50.0) * cos(PI / 9.0);
    const double tension = hanging + w * R * (sin(PI / 9.0) - sin(angle));
    const double q = fabs(tension / R - w * sin(angle));
    return q * 100.0 / 12.0 * 0.5 * t.outer / (2.1e11 * second_moment(&t) * 3e-3);
}

static void by_what_hangs_below(void **state)
{
    (void)state;
    for (int below = 0; below < BELOW; below++) {
        const int pipes = below == FLEXIBLE || below == RIGID || below == AXIAL_TORSIONAL || below > RING;
        for (int wet = 0; wet <= pipes; wet++) {
            rig s;
            char text[64];
            double error[UPPER + COLLARS];
            hung(&s, below, wet ? 1200.0 : 0.0, error);
            for (uint32_t k = 5; k < 15; k++) {
                (void)snprintf(text, sizeof text, "error of pipe %u above %d", k, below);
                check_relative(text, error[k], error_in_bend(k, wet ? 1.0 - 1200.0 / 7850.0 : 1.0), 0.01);
            }
            check_below("pipes in the vertical hole", error[2], 1e-9);
            rig_close(&s);
        }
    }
}

static void nothing_to_divide(void **state)
{
    const tube t = {0.2, 0.07, 30.0, 1, 0};
    dmb_pipe_def pipe = tube_pipe(&t);
    double error[12] = {1.0, 1.0, 1.0};
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, -G);
    dmb_id string = add_beam(&s, &pipe, DMB_FREE_NONE);
    assert_int_equal(dmb_analysis_mesh(s.model, string, error, 12), DMB_ERR_ORDER);
    (void)rig_start(&s, NULL);
    assert_int_equal(dmb_analysis_mesh(s.model, string, error, 0), DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_mesh(s.model, (dmb_id){0, 0}, error, 12), DMB_ERR_ID);
    assert_int_equal(dmb_analysis_mesh(NULL, string, error, 12), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_mesh(s.model, string, NULL, 12), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_mesh(s.model, string, error, 12), DMB_OK);
    assert_true(error[0] == 0.0); /* no wall */
    rig_close(&s);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    rig_open(&s, 0.0, 0.0, -G);
    const dmb_wall_def wall = s1_hole();
    (void)add_wall(&s, &wall);
    pipe.outer_diameter = 0.07;
    pipe.inner_diameter = 0.05;
    string = add_pipes(&s, &pipe, 3);
    (void)rig_start(&s, NULL);
    assert_int_equal(dmb_analysis_mesh(s.model, string, error, 12), DMB_OK);
    assert_true(error[0] == 0.0 && error[2] == 0.0);
    rig_close(&s);
}

/* The model check names pipe, elements and error, or nothing. */
static void as_a_warning(void **state)
{
    const tube rod = {0.073, 0.061, 3.0, 1, 0}, collar = {0.20955, 0.073025, 37.72, 1, 0};
    static char text[20000], advice[64];
    double error[12];
    rig s;
    (void)state;
    (void)level_string(&s, &rod, 0.094, error);
    assert_true(dmb_analysis_check_text(s.sim, text, sizeof text, NULL) >= 0);
    assert_null(strstr(text, "set elements"));
    rig_close(&s);
    (void)level_string(&s, &collar, 0.311, error);
    assert_true(dmb_analysis_check_text(s.sim, text, sizeof text, NULL) >= 0);
    assert_non_null(strstr(text, "(and 11 more): 1 element(s) in 37.72 m"));
    (void)snprintf(advice, sizeof advice, "set elements to at least %.0f", ceil(sqrt(error[0] / 0.01)));
    assert_non_null(strstr(text, advice));
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_statics_have_it),  cmocka_unit_test(usual_rods),        cmocka_unit_test(in_a_bend),
        cmocka_unit_test(by_what_hangs_below), cmocka_unit_test(nothing_to_divide), cmocka_unit_test(as_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
