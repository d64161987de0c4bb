/* Energy of spinning and swinging bodies on springs that steps do not resolve (h w >= 3, w of the body on its spring):
 * at most 1.01 of the initial energy with every spectral radius, and that energy with radius 1. Two-sided springs
 * beside the axis, stretched and not, between ground and body and between two bodies; ropes; springs of joints; a body
 * of revolution on a joint; a spring far from the centre of mass, and one about the axis of a thin rod aslant in its
 * body, which are stiff for the rotation only. Before, it grew without bound. Springs of an open joint do not act.
 * A stiff spring whose force changes slowly has the reactions and accelerations of its law, also after a run-up and
 * after an impact.
 * Equations: eq:unilateral.holding, eq:unilateral.turning, eq:unilateral.bias. */
#include <math.h>
#include <string.h>

#include "drillmbd/scene.h"
#include "mechanism.h"

enum { FOUR_SPRINGS, STRETCHED, TWO_BODIES, SWINGING, ROPE, ROTOR, BUSHING, BUSHING_OF_TWO, FAR_CENTRE, ASLANT, KINDS };
static const char *const names[KINDS] = {"four springs beside the axis",
                                         "a stretched spring",
                                         "a stretched spring between two bodies",
                                         "swinging on a spring",
                                         "swinging on a rope",
                                         "a rotor on a ball joint with a spring",
                                         "on springs of a joint",
                                         "two bodies on springs of a joint",
                                         "a spring far from the centre of mass",
                                         "a rod aslant in its body"};

static const double mass = 2.0, spin = 100.0;

typedef struct held {
    int kind;
    double per_step, hw, radius;
} held;

static dmb_id add_turning(rig *s, double turned, double across, double y, int round)
{
    dmb_body_def body = dmb_body_def_default();
    const double start[6] = {0.0, across, 0.31, turned * spin, turned != 0.0 ? 3.0 : 0.0, 0.0};
    body.mass = mass;
    body.inertia[0] = 0.004, body.inertia[1] = round ? 0.005 : 0.006, body.inertia[2] = 0.005;
    body.position[1] = y;
    memcpy(body.velocity, start, sizeof start);
    return add_body(s, &body);
}

/* A spring from `from` to a body at x = 0.1 and y = beside, stretched by [m]. */
static void add_held(rig *s, dmb_place from, dmb_id body, double beside, const double to[3], double k, double stretched,
                     int acts)
{
    dmb_spring_def def = dmb_spring_def_default();
    dmb_id id = {0, 0};
    def.place_a = from;
    def.place_b = dmb_station(body, 0, 0.0);
    def.offset_b[0] = 0.1, def.offset_b[1] = beside;
    memcpy(def.offset_a, to, 3 * sizeof(double));
    def.acts = acts;
    def.stiffness = k;
    def.free_length = 0.5 - stretched;
    must_model(s, dmb_model_add_spring(s->model, &def, &id));
}

static void add_four(rig *s, dmb_id body, double k)
{
    for (int i = 0; i < 4; i++) {
        double to[3] = {0.1, 0.05, 0.0};
        to[1 + i % 2] += i < 2 ? 0.5 : -0.5;
        add_held(s, dmb_station(ground_id, 0, 0.0), body, 0.05, to, k, 0.0, DMB_SPRING_BOTH);
    }
}

static void add_bushing(rig *s, dmb_place from, dmb_id body, double k)
{
    dmb_joint_def joint = joint_between(DMB_JOINT_FREE, from, dmb_station(body, 0, 0.0));
    joint.origin_a[0] = joint.origin_b[0] = 0.1;
    joint.origin_a[1] = joint.origin_b[1] = 0.05;
    for (int i = 0; i < 3; i++) joint.stiffness[i] = k;
    joint.rest[1] = 0.05;
    (void)add_joint(s, &joint);
}

static void add_rotor(rig *s, double k)
{
    const double to[3] = {0.1, 0.55, 0.0};
    dmb_body_def body = dmb_body_def_default();
    body.mass = mass;
    body.inertia[0] = 0.004, body.inertia[1] = body.inertia[2] = 0.005;
    body.velocity[3] = spin, body.velocity[4] = 3.0;
    const dmb_id id = add_body(s, &body);
    const dmb_joint_def ball =
        joint_between(DMB_JOINT_SPHERICAL, dmb_station(ground_id, 0, 0.0), dmb_station(id, 0, 0.0));
    (void)add_joint(s, &ball);
    add_held(s, dmb_station(ground_id, 0, 0.0), id, 0.05, to, k, 0.05, DMB_SPRING_BOTH);
}

/* A body held by a stretched spring of 0.5 m from `at` along `line`. */
static dmb_id add_one(rig *s, const dmb_body_def *body, const double at[3], const double line[3], double k)
{
    dmb_spring_def def = dmb_spring_def_default();
    const dmb_id made = add_body(s, body);
    dmb_id id = {0, 0};
    def.place_a = dmb_station(ground_id, 0, 0.0);
    def.place_b = dmb_station(made, 0, 0.0);
    for (int i = 0; i < 3; i++) {
        def.offset_b[i] = at[i];
        def.offset_a[i] = at[i] + 0.5 * line[i];
    }
    def.stiffness = k;
    def.free_length = 0.45;
    must_model(s, dmb_model_add_spring(s->model, &def, &id));
    return made;
}

/* 1/m + (1 m)^2/J = 200.5/kg along the spring. */
static void add_far(rig *s, double k)
{
    const double at[3] = {0.0, 0.0, 0.0}, line[3] = {0.0, 1.0, 0.0};
    dmb_body_def body = dmb_body_def_default();
    body.mass = mass;
    body.inertia[0] = 0.004, body.inertia[1] = 0.006, body.inertia[2] = 0.005;
    body.centre[0] = -1.0;
    body.velocity[3] = spin, body.velocity[4] = 3.0;
    (void)add_one(s, &body, at, line, k / (mass * 200.5));
}

/* 1/m + (0.3 m)^2/J = 180.5/kg, J = 0.0005 kg m2 about (1, 1, 0), 1 kg m2 across. */
static void add_aslant(rig *s, double k)
{
    const double at[3] = {0.0, 0.0, 0.3}, line[3] = {sqrt(0.5), -sqrt(0.5), 0.0};
    dmb_body_def body = dmb_body_def_default();
    body.mass = mass;
    body.inertia[0] = body.inertia[1] = 0.50025, body.inertia[2] = 1.0, body.inertia[3] = -0.49975;
    body.velocity[3] = body.velocity[4] = sqrt(0.5) * spin;
    (void)add_one(s, &body, at, line, k / (mass * 180.5));
}

static void add_kind(rig *s, int kind, double k)
{
    const dmb_place ground = dmb_station(ground_id, 0, 0.0);
    const double beside[3] = {0.1, 0.55, 0.0}, mate[3] = {0.1, 0.05, 0.02};
    if (kind == FOUR_SPRINGS) add_four(s, add_turning(s, 1.0, 0.5, 0.0, 0), k);
    if (kind == STRETCHED)
        add_held(s, ground, add_turning(s, 1.0, 0.5, 0.0, 0), 0.05, beside, k, 0.05, DMB_SPRING_BOTH);
    if (kind == TWO_BODIES) {
        const dmb_id a = add_turning(s, -0.5, -0.5, 0.5, 0);
        add_held(s, dmb_station(a, 0, 0.0), add_turning(s, 1.0, 0.5, 0.0, 0), 0.05, mate, 0.5 * k, 0.05,
                 DMB_SPRING_BOTH);
    }
    if (kind == SWINGING || kind == ROPE) {
        const double over[3] = {0.1, 0.0, 0.5};
        const int acts = kind == ROPE ? DMB_SPRING_TENSION : DMB_SPRING_BOTH;
        add_held(s, ground, add_turning(s, 0.0, 0.5 * spin, 0.0, 0), 0.0, over, k, 0.0, acts);
    }
    if (kind == ROTOR) add_rotor(s, k);
    if (kind == FAR_CENTRE) add_far(s, k);
    if (kind == ASLANT) add_aslant(s, k);
    if (kind == BUSHING) add_bushing(s, ground, add_turning(s, 1.0, 0.5, 0.0, 0), k);
    if (kind == BUSHING_OF_TWO) {
        const dmb_id a = add_turning(s, -0.5, -0.5, 0.0, 0);
        add_bushing(s, dmb_station(a, 0, 0.0), add_turning(s, 1.0, 0.5, 0.0, 0), 0.5 * k);
    }
}

static void open_scene(rig *s, const held *of)
{
    const double w = of->hw * spin / of->per_step;
    dmb_sim_options options = sharp_options(of->radius, 1e-10);
    options.energy_ledger = 1;
    rig_open(s, 0.0, 0.0, 0.0);
    add_kind(s, of->kind, mass * w * w);
    assert_int_equal(mechanism_start(s, &options), DMB_OK);
}

/* Largest energy over the initial one; *error: that of the ledger at the end. */
static double most_of(const held *of, uint32_t steps, double *error)
{
    rig s;
    open_scene(&s, of);
    const double most = largest_energy(&s, of->per_step / spin, steps);
    *error = fabs(energy_of(&s).error);
    rig_close(&s);
    return most;
}

static void steps_gain_nothing(void **state)
{
    static const double radii[] = {0.0, 0.5, 0.8, 0.95, 1.0}, ratios[] = {3.0, 100.0}, turns[] = {0.03, 0.3};
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        double most = 0.0, off = 0.0;
        for (int i = 0; i < 20; i++) {
            const held of = {kind, turns[i / 10], ratios[i / 5 % 2], radii[i % 5]};
            double error;
            most = fmax(most, most_of(&of, 30, &error));
            if (of.radius == 1.0) off = fmax(off, error);
        }
        check_below(names[kind], most, 1.01);
        check_below("error of the energy with radius 1", off, 0.01);
    }
}

/* Kinetic energy after 100 steps of a body on a joint that is open. */
static double left_open(double k)
{
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_joint_def joint = joint_between(DMB_JOINT_FREE, dmb_station(ground_id, 0, 0.0),
                                        dmb_station(add_turning(&s, 1.0, 0.5, 0.0, 0), 0, 0.0));
    for (int i = 0; i < 6; i++) joint.stiffness[i] = k;
    joint.state = DMB_JOINT_OPEN;
    (void)add_joint(&s, &joint);
    const dmb_sim_options options = sharp_options(1.0, 1e-12);
    assert_int_equal(mechanism_start(&s, &options), DMB_OK);
    for (int i = 0; i < 100; i++) assert_int_equal(dmb_sim_step(s.sim, 1e-3, NULL), DMB_OK);
    const double energy = energy_of(&s).kinetic;
    rig_close(&s);
    return energy;
}

static void open_joints_hold_nothing(void **state)
{
    const double soft = left_open(1.0), stiff = left_open(1e8);
    (void)state;
    assert_true(soft == stiff);
}

/* A body that rotates steadily on a ball joint, held by a spring from there: the joint bears the spring's force. */
static void steady_reactions_are_of_the_law(void **state)
{
    static const double radii[] = {0.0, 0.8, 1.0}, at[3] = {0.0, 0.5, 0.0}, line[3] = {0.0, -1.0, 0.0};
    (void)state;
    for (int i = 0; i < 3; i++) {
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        dmb_body_def body = dmb_body_def_default();
        body.mass = mass;
        body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.4;
        body.velocity[3] = spin;
        const dmb_place end = dmb_station(add_one(&s, &body, at, line, 1e6), 0, 0.0);
        const dmb_joint_def ball = joint_between(DMB_JOINT_SPHERICAL, dmb_station(ground_id, 0, 0.0), end);
        const dmb_id joint = add_joint(&s, &ball);
        const dmb_sim_options options = sharp_options(radii[i], 1e-10);
        assert_int_equal(mechanism_start(&s, &options), DMB_OK);
        for (int k = 0; k < 20; k++) assert_int_equal(dmb_sim_step(s.sim, 1e-3, NULL), DMB_OK);
        const dmb_joint_state at_end = joint_at(&s, joint);
        check_close("reaction", hypot(at_end.reaction[1], at_end.reaction[2]), 0.05 * 1e6, 1e-4);
        rig_close(&s);
    }
}

/* A force [N] across that rises and falls within 2 ms at 0.3 s. */
static void add_blow(rig *s, dmb_id body, double force)
{
    dmb_segment terms[2] = {dmb_segment_default(), dmb_segment_default()};
    dmb_load_def load = dmb_load_def_default();
    for (int i = 0; i < 2; i++) {
        terms[i].kind = DMB_SEGMENT_STEP5;
        terms[i].x0 = 0.3 + 1e-3 * i, terms[i].x1 = terms[i].x0 + 1e-3;
        terms[i].h1 = i == 0 ? 1.0 : -1.0;
    }
    load.time_function = add_time_function(s, terms, 2);
    load.place = dmb_station(body, 0, 0.0);
    load.offset[0] = 0.1;
    load.force[1] = force;
    (void)add_load(s, &load);
}

/* A shaft in a bearing runs up to 200 rpm within 0.2 s; a body whose centre is off its axis hangs on it by a ball joint
 * with stiff springs, h w = 3 at steps of 1 ms and 0.75 at 0.25 ms. State of the joint at 0.5 s. */
static dmb_joint_state knuckle_at(double step, double radius, double blow)
{
    rig s;
    dmb_id run_up = {0, 0};
    rig_open(&s, 0.0, 0.0, -9.81);
    dmb_body_def body = dmb_body_def_default();
    body.mass = mass;
    body.inertia[0] = 0.004, body.inertia[1] = 0.006, body.inertia[2] = 0.005;
    const dmb_id shaft = add_body(&s, &body);
    body.position[0] = 0.3;
    body.centre[1] = 0.01;
    const dmb_id hung = add_body(&s, &body);
    const dmb_id bearing =
        add_joint_between(&s, DMB_JOINT_REVOLUTE, dmb_station(ground_id, 0, 0.0), dmb_station(shaft, 0, 0.0));
    must_model(&s, dmb_model_add_ramp(s.model, 0.0, 200.0 * PI / 30.0, 0.0, 0.2, &run_up));
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, bearing, DMB_RX, run_up);
    dmb_joint_def ball = joint_between(DMB_JOINT_SPHERICAL, dmb_station(shaft, 0, 0.0), dmb_station(hung, 0, 0.0));
    ball.origin_a[0] = 0.3;
    for (int i = 3; i < 6; i++) ball.stiffness[i] = 0.005 * 9e6, ball.damping[i] = 1.0;
    const dmb_id knuckle = add_joint(&s, &ball);
    add_blow(&s, hung, blow);
    const dmb_sim_options options = sharp_options(radius, 1e-10);
    assert_int_equal(mechanism_start(&s, &options), DMB_OK);
    const uint32_t count = (uint32_t)lround(0.5 / step);
    for (uint32_t i = 0; i < count; i++) assert_int_equal(dmb_sim_step(s.sim, step, NULL), DMB_OK);
    const dmb_joint_state at_end = joint_at(&s, knuckle);
    rig_close(&s);
    return at_end;
}

static void slow_forces_are_of_the_law(void **state)
{
    static const double blows[] = {0.0, 0.0, 0.0, 2000.0, 2000.0}, radii[] = {0.0, 0.8, 1.0, 0.0, 0.8};
    (void)state;
    for (int i = 0; i < 5; i++) {
        const dmb_joint_state coarse = knuckle_at(1e-3, radii[i], blows[i]),
                              fine = knuckle_at(2.5e-4, radii[i], blows[i]);
        for (int k = 0; k < 3; k++) {
            check_close("reaction [N]", coarse.reaction[k], fine.reaction[k], 5e-3);
            check_close("moment of the springs [N m]", coarse.action[3 + k], fine.action[3 + k], 2e-3);
            check_close("acceleration [rad/s2]", coarse.acceleration[3 + k], fine.acceleration[3 + k], 0.3);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_gain_nothing),
        cmocka_unit_test(open_joints_hold_nothing),
        cmocka_unit_test(steady_reactions_are_of_the_law),
        cmocka_unit_test(slow_forces_are_of_the_law),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
