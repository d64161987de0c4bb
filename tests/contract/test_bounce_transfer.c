/* A run that is handed over to a new sim of the same model after every step, through bounces that the steps do not
 * resolve, against the run that stays: contacts keep their mean forces (eq:unilateral.mean, eq:contact.mean). At
 * spectral radius 1 accelerations are all that a step leaves behind, so that both are the same run to rounding. So do
 * springs between points and of joints whose mean forces last while the body spins (eq:unilateral.holding). The other
 * model may have stops elsewhere or other supports. */
#include <math.h>
#include <string.h>

#include "drillmbd/scene.h"
#include "mechanism.h"

enum { ON_SPRINGS, IN_STOPS, IN_A_HOLE, ON_A_SPRING, ON_A_ROPE, ON_A_JOINT, KINDS };
static const char *const names[KINDS] = {
    "on one-sided springs", "in stops",           "in a hole",
    "spinning on a spring", "spinning on a rope", "spinning on springs of a joint"};
enum { STEPS = 120 };
static const double h = 1e-3, mass = 2.0;

static void add_springs(rig *s, dmb_id body, double k)
{
    for (int i = 0; i < 2; i++) {
        dmb_spring_def def = dmb_spring_def_default();
        dmb_id id = {0, 0};
        def.place_a = dmb_station(ground_id, 0, 0.0);
        def.place_b = dmb_station(body, 0, 0.0);
        def.offset_a[0] = def.offset_b[0] = 0.1;
        def.offset_a[1] = i == 0 ? 0.5 : -0.5;
        def.acts = DMB_SPRING_COMPRESSION;
        def.stiffness = k;
        def.damping = 0.1 * mass / h;
        def.free_length = 0.48;
        must_model(s, dmb_model_add_spring(s->model, &def, &id));
    }
}

static void add_stops(rig *s, dmb_id body, double k)
{
    dmb_joint_def play = joint_between(DMB_JOINT_FREE, dmb_station(ground_id, 0, 0.0), dmb_station(body, 0, 0.0));
    for (int i = 0; i < 3; i++) play.stop_low[i] = -0.02, play.stop_high[i] = 0.02;
    play.stop_stiffness = k;
    play.stop_damping = 0.1 * mass / h;
    (void)add_joint(s, &play);
}

/* Beside the axis about which the body spins, stretched. */
static void add_turning_spring(rig *s, dmb_id body, int acts, double k)
{
    dmb_spring_def def = dmb_spring_def_default();
    dmb_id id = {0, 0};
    def.place_a = dmb_station(ground_id, 0, 0.0);
    def.place_b = dmb_station(body, 0, 0.0);
    def.offset_a[0] = def.offset_b[0] = 0.1;
    def.offset_a[1] = 0.55, def.offset_b[1] = 0.05;
    def.acts = acts;
    def.stiffness = k;
    def.free_length = 0.5;
    must_model(s, dmb_model_add_spring(s->model, &def, &id));
}

static void add_bushing(rig *s, dmb_id body, double k)
{
    dmb_joint_def joint = joint_between(DMB_JOINT_FREE, dmb_station(ground_id, 0, 0.0), dmb_station(body, 0, 0.0));
    joint.origin_a[0] = joint.origin_b[0] = 0.1;
    joint.origin_a[1] = joint.origin_b[1] = 0.05;
    for (int i = 0; i < 3; i++) joint.stiffness[i] = k;
    (void)add_joint(s, &joint);
}

static void add_hole(rig *s, double k)
{
    dmb_wall_def wall = s1_hole();
    wall.diameter = 0.2;
    wall.stiffness = k;
    wall.restitution = 0.7;
    (void)add_wall(s, &wall);
}

/* A second body on a joint that is described first: its stops, which it does not reach, are numbered first. */
enum { ALONE, BESIDE, BESIDE_STOPS };
static void add_beside(rig *s, int beside)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 1.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.01;
    const dmb_place place = dmb_station(add_body(s, &body), 0, 0.0);
    dmb_joint_def joint = joint_between(DMB_JOINT_PRISMATIC, dmb_station(ground_id, 0, 0.0), place);
    joint.stop_stiffness = 1e6;
    if (beside == BESIDE_STOPS) joint.stop_low[0] = -1.0, joint.stop_high[0] = 1.0;
    (void)add_joint(s, &joint);
}

/* (h w)^2 = 100: a bounce takes a few steps. */
static dmb_id open_scene(rig *s, int kind, int beside)
{
    const double k = 100.0 * mass / (h * h);
    dmb_body_def body = dmb_body_def_default();
    const double start[6] = {0.0, 3.0, 0.31, 5.0, 0.5, 0.0};
    const dmb_sim_options options = sharp_options(1.0, kind >= ON_A_SPRING ? 1e-10 : 1e-12);
    memcpy(body.velocity, start, sizeof start);
    if (kind >= ON_A_SPRING) body.velocity[1] = 0.3, body.velocity[2] = 0.03, body.velocity[3] = 50.0;
    body.mass = mass;
    body.inertia[0] = 0.004, body.inertia[1] = 0.006, body.inertia[2] = 0.005;
    body.position[0] = 1.0;
    body.contact_diameter = 0.16;
    body.contact_length = 0.1;
    rig_open(s, 0.0, 0.0, -9.81);
    if (beside != ALONE) add_beside(s, beside);
    if (kind == IN_A_HOLE) add_hole(s, k);
    if (kind != IN_A_HOLE) body.position[0] = 0.0, body.contact_diameter = 0.0;
    const dmb_id id = add_body(s, &body);
    if (kind == ON_SPRINGS) add_springs(s, id, k);
    if (kind == IN_STOPS) add_stops(s, id, k);
    if (kind == ON_A_SPRING) add_turning_spring(s, id, DMB_SPRING_BOTH, k);
    if (kind == ON_A_ROPE) add_turning_spring(s, id, DMB_SPRING_TENSION, k);
    if (kind == ON_A_JOINT) add_bushing(s, id, k);
    assert_int_equal(mechanism_start(s, &options), DMB_OK);
    return id;
}

/* Hands the state to a new sim. */
static dmb_id hand_over(rig *s, int kind, int beside)
{
    rig next;
    const dmb_id id = open_scene(&next, kind, beside);
    must(&next, dmb_sim_transfer_state(next.sim, s->sim));
    rig_close(s);
    *s = next;
    return id;
}

/* [m/s, rad/s] of velocities, and of accelerations in a step. */
static double apart(const rig *a, dmb_id on_a, const rig *b, dmb_id on_b)
{
    const dmb_motion ma = motion_at(a, dmb_station(on_a, 0, 0.0), DMB_FRAME_WORLD);
    const dmb_motion mb = motion_at(b, dmb_station(on_b, 0, 0.0), DMB_FRAME_WORLD);
    double most = 0.0;
    for (int i = 0; i < 6; i++) {
        most = fmax(most, fabs(ma.velocity[i] - mb.velocity[i]));
        most = fmax(most, h * fabs(ma.acceleration[i] - mb.acceleration[i]));
    }
    return most;
}

/* The body beside has no stops in every second sim. */
static void hold_handed_over(int kind, int beside)
{
    rig a, b;
    double most = 0.0;
    const dmb_id id = open_scene(&a, kind, beside);
    (void)open_scene(&b, kind, beside);
    for (int n = 0; n < STEPS; n++) {
        must(&a, dmb_sim_step(a.sim, h, NULL));
        must(&b, dmb_sim_step(b.sim, h, NULL));
        const dmb_id next = hand_over(&b, kind, beside != ALONE && n % 2 == 0 ? BESIDE : beside);
        most = fmax(most, apart(&a, id, &b, next));
    }
    const dmb_statistics sa = statistics_of(&a), sb = statistics_of(&b);
    assert_true(sa.bounces > 2 || kind >= ON_A_SPRING);
    assert_true(sa.bounces == sb.bounces);
    check_below(names[kind], most, 1e-7);
    rig_close(&a);
    rig_close(&b);
}

static void a_run_handed_over_in_bounces_is_the_same_run(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) hold_handed_over(kind, ALONE);
}

/* Ages of bounces go by joint and spring, not by number. */
static void stops_of_another_joint_may_be_removed(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        if (kind != IN_A_HOLE) hold_handed_over(kind, BESIDE_STOPS);
}

/* ---- Supports ---------------------------------------------------------------------------------------------------- */

/* A pipe along world x held at its rig end, with those directions free, beside the body in its stops. */
static dmb_id open_held(rig *s, int32_t start_free)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_joint_def play;
    dmb_body_def body = dmb_body_def_default();
    const dmb_sim_options options = sharp_options(1.0, 1e-12);
    rig_open(s, 0.0, 0.0, -9.81);
    string.position[1] = 3.0;
    string.start_free = start_free;
    pipe.string = add_string(s, &string);
    pipe.kind = DMB_PIPE_RIGID;
    (void)add_pipes(s, &pipe, 1);
    body.mass = mass;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.01;
    body.velocity[2] = -3.0;
    play = joint_between(DMB_JOINT_FREE, dmb_station(ground_id, 0, 0.0), dmb_station(add_body(s, &body), 0, 0.0));
    play.stop_low[2] = -0.02, play.stop_high[2] = 0.02;
    play.stop_stiffness = 100.0 * mass / (h * h);
    (void)add_joint(s, &play);
    assert_int_equal(mechanism_start(s, &options), DMB_OK);
    return pipe.string;
}

/* Reactions of other supports are not copied row by row, in the middle of a bounce either: nothing pushes along the
 * direction that is free in one of the two. */
static void supports_that_differ_have_their_own_reactions(void **state)
{
    rig a, b;
    (void)state;
    const dmb_id on_a = open_held(&a, DMB_FREE_Y), on_b = open_held(&b, DMB_FREE_NONE);
    for (int n = 0; n < 14; n++) {
        double before[6], after[6];
        must(&a, dmb_sim_step(a.sim, h, NULL));
        must(&a, dmb_query_reaction(a.sim, on_a, before));
        must(&b, dmb_sim_transfer_state(b.sim, a.sim));
        must(&b, dmb_query_reaction(b.sim, on_b, after));
        assert_true(before[2] > 1.0);
        for (int i = 0; i < 6; i++) check_close("reaction", after[i], before[i], 1e-6 * before[2]);
    }
    assert_true(statistics_of(&a).bounces > 0);
    rig_close(&a);
    rig_close(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_run_handed_over_in_bounces_is_the_same_run),
                                       cmocka_unit_test(stops_of_another_joint_may_be_removed),
                                       cmocka_unit_test(supports_that_differ_have_their_own_reactions)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
