/* Statics of strings that slide and turn with their axes at rest, held against runs in time that settle there, against
 * closed forms, Newton's law of the whole, and refusals of what is not steady. Equations: eq:sliding.motion,
 * eq:sliding.tangent. */
#include <string.h>

#include "modal.h"

typedef struct scene_choice {
    int32_t law, kind;
    double inclination, bend; /* of the hole, in its plane */
    double speed, spin;       /* of the drives */
    double damping_time;
    uint32_t pipes;
} scene_choice;

typedef struct scene {
    rig rig;
    dmb_id string, feed, turning;
    const scene_choice *choice;
} scene;

static void add_hole(scene *s)
{
    const scene_choice *c = s->choice;
    const double survey[6] = {0.0, c->inclination, 0.0, 200.0, c->inclination + 200.0 * c->bend, 0.0};
    dmb_wall_def wall = s1_hole();
    wall.survey = survey;
    wall.survey_count = 2;
    wall.friction_law = c->law;
    wall.stiffness = 1e7;
    wall.mu_static = wall.mu_dynamic = 0.3;
    wall.smoothing_speed = 1e-4;
    wall.stribeck_speed = 1e-2;
    if (c->law == DMB_FRICTION_STRIBECK || c->law == DMB_FRICTION_BRISTLE) wall.mu_static = 0.35;
    (void)add_wall(&s->rig, &wall);
}

static void describe(scene *s, const scene_choice *choice)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    s->choice = choice;
    rig_open(&s->rig, 0.0, 0.0, -9.81);
    add_hole(s);
    def.start_free = DMB_FREE_X | DMB_FREE_RX;
    def.start_depth = 5.0;
    pipe.kind = choice->kind;
    pipe.damping_time = choice->damping_time;
    pipe.string = s->string = add_string(&s->rig, &def);
    (void)add_pipes(&s->rig, &pipe, choice->pipes);
    s->feed = add_simple_drive(&s->rig, DMB_DRIVE_MOTION, s->string, DMB_X, add_constant(&s->rig, choice->speed));
    s->turning = add_simple_drive(&s->rig, DMB_DRIVE_MOTION, s->string, DMB_RX, add_constant(&s->rig, choice->spin));
}

static dmb_static_report rest(const scene *s, int32_t steady)
{
    dmb_static_options options = dmb_static_options_default();
    options.steady = steady;
    options.tolerance = 1e-12;
    return find_equilibrium(&s->rig, &options);
}

static double force_of(const scene *s, dmb_id drive)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(&s->rig, dmb_query_drive(s->rig.sim, drive, &state));
    return state.force;
}

/* Mean over n steps of the feed's force, the torque and the sum of normal forces. */
static void mean_of(const scene *s, double h, uint32_t n, double out[3])
{
    memset(out, 0, 3 * sizeof *out);
    for (uint32_t k = 0; k < n; k++) {
        must(&s->rig, dmb_sim_step(s->rig.sim, h, NULL));
        out[0] += force_of(s, s->feed) / n;
        out[1] += force_of(s, s->turning) / n;
        out[2] += contacts_of(&s->rig).normal_force / n;
    }
}

static void forces_now(const scene *s, double out[3])
{
    out[0] = force_of(s, s->feed);
    out[1] = force_of(s, s->turning);
    out[2] = contacts_of(&s->rig).normal_force;
}

/* From the steady state on nothing happens; from a state at rest with the same drives the run settles there. */
static void settles_there(const scene_choice *c, double tolerance)
{
    scene s;
    double found[3], first[3], later[3];
    describe(&s, c);
    (void)rig_start(&s.rig, NULL);
    const dmb_static_report report = rest(&s, DMB_STEADY_AUTO);
    assert_int_equal(report.steady, DMB_STEADY_SLIDING);
    forces_now(&s, found);
    const dmb_motion tip = motion_at(&s.rig, dmb_station(s.string, c->pipes - 1, 1.0), DMB_FRAME_BODY);
    print_message(
        "law %d, kind %d, bend %g, %g m/s, %g rad/s: feed %.6g N, torque %.6g Nm, normal %.6g N (%u iterations)\n",
        c->law, c->kind, c->bend, c->speed, c->spin, found[0], found[1], found[2], report.iterations);
    check_close("speed of the tip", tip.velocity[0], c->speed, 1e-4 * fabs(c->speed) + 1e-12);
    check_close("spin of the tip", tip.velocity[3], c->spin, 1e-4 * fabs(c->spin) + 1e-12);
    mean_of(&s, 1e-4, 50, first);
    for (int i = 0; i < 3; i++)
        check_close("  goes on", first[i], found[i], tolerance * (i == 1 ? 0.0365 : 1.0) * found[2]);
    rig_close(&s.rig);

    describe(&s, c);
    (void)rig_start(&s.rig, NULL);
    (void)rest(&s, DMB_STEADY_AT_REST);
    for (int k = 0; k < 2000; k++) must(&s.rig, dmb_sim_step(s.rig.sim, 1e-3, NULL)); /* a start may cut steps */
    mean_of(&s, 1e-3, 500, later);
    for (int i = 0; i < 3; i++)
        check_close("  settles there", later[i], found[i], 1e-2 * (i == 1 ? 0.0365 : 1.0) * found[2]);
    rig_close(&s.rig);
}

static void runs_settle_in_the_static_state(void **state)
{
    static const scene_choice choices[] = {
        {DMB_FRICTION_COULOMB, DMB_PIPE_FLEXIBLE, 0.5 * PI, 0.0, 0.02, 0.0, 2e-3, 10},
        {DMB_FRICTION_STRIBECK, DMB_PIPE_FLEXIBLE, 0.5 * PI, 0.0, 0.0, 1.0, 2e-3, 10},
        {DMB_FRICTION_COULOMB, DMB_PIPE_FLEXIBLE, 0.45 * PI, 2e-3, 0.02, 3.0, 2e-3, 10},
        {DMB_FRICTION_BRISTLE, DMB_PIPE_FLEXIBLE, 0.45 * PI, 2e-3, -0.02, 3.0, 2e-3, 10},
        {DMB_FRICTION_COULOMB, DMB_PIPE_AXIAL_TORSIONAL, 0.5 * PI, 2e-3, 0.02, 3.0, 2e-3, 10},
        {DMB_FRICTION_BRISTLE, DMB_PIPE_AXIAL_TORSIONAL, 0.5 * PI, 0.0, 0.02, -3.0, 2e-3, 10},
    };
    (void)state;
    for (size_t i = 0; i < sizeof choices / sizeof choices[0]; i++) settles_there(choices + i, 2e-5);
}

/* ---- Drilling ---------------------------------------------------------------------------------------------------- */

static dmb_bit_state bit_of(const scene *s, dmb_id bit)
{
    dmb_bit_state state = dmb_bit_state_default();
    must(&s->rig, dmb_query_bit(s->rig.sim, bit, &state));
    return state;
}

/* CASES, bit and coal: d 6e-3 m, W 2162.0 N, T 71.7925 N m from the static state on; the feed holds W and what the wall
 * takes along, mu N v/|v| each. Off the bottom nothing is cut. */
static void bit_cuts_in_the_steady_state(void **state)
{
    static const int32_t laws[] = {DMB_ROCK_RATE, DMB_ROCK_REGENERATIVE};
    (void)state;
    for (int i = 0; i < 4; i++) {
        const int ahead = i >= 2;
        const scene_choice c = {DMB_FRICTION_COULOMB, DMB_PIPE_FLEXIBLE, 0.5 * PI, 0.0, 0.02, 20.943951, 1e-3, 4};
        dmb_bit_def def = dmb_bit_def_default();
        scene s;
        describe(&s, &c);
        def.string = s.string;
        def.rock_law = laws[i % 2];
        def.bottom = ahead ? 0.01 : 0.0;
        def.contact_strength = 1e7;
        dmb_id bit;
        must_model(&s.rig, dmb_model_add_bit(s.rig.model, &def, &bit));
        (void)rig_start(&s.rig, NULL);
        (void)rest(&s, DMB_STEADY_AUTO);
        const dmb_bit_state found = bit_of(&s, bit);
        const dmb_contact_total sum = contacts_of(&s.rig);
        check_close("weight on bit", found.weight, ahead ? 0.0 : 2162.0, 2e-4);
        check_close("torque on bit", found.torque, ahead ? 0.0 : 71.7925, 2e-5);
        check_close("feed", force_of(&s, s.feed), found.weight - sum.friction[0], 1e-4 * sum.normal_force);
        for (int k = 0; k < 100; k++) must(&s.rig, dmb_sim_step(s.rig.sim, 1e-4, NULL));
        const dmb_bit_state later = bit_of(&s, bit);
        check_close("weight goes on", later.weight, found.weight, 2e-3 * 2162.0);
        check_close("torque goes on", later.torque, found.torque, 2e-3 * 71.8);
        rig_close(&s.rig);
    }
}

/* ---- With joints ------------------------------------------------------------------------------------------------- */

/* A body at the far end: joined fast it slides and turns with the string, in a swivel it slides along. */
static void bodies_move_as_joints_let_them(void **state)
{
    static const int32_t kinds[] = {DMB_JOINT_FIXED, DMB_JOINT_REVOLUTE};
    (void)state;
    for (int i = 0; i < 2; i++) {
        const scene_choice c = {DMB_FRICTION_COULOMB, DMB_PIPE_FLEXIBLE, 0.5 * PI, 0.0, 0.02, 3.0, 1e-3, 4};
        dmb_body_def def = dmb_body_def_default();
        dmb_joint_def joint;
        scene s;
        describe(&s, &c);
        def.position[0] = 5.0 + 4 * 1.5;
        def.mass = 3.0;
        def.free_mask = DMB_FREE_ALL;
        const dmb_id body = add_body(&s.rig, &def);
        joint = joint_between(kinds[i], dmb_station(s.string, 3, 1.0), dmb_station(body, 0, 0.0));
        joint.match = 1;
        (void)add_joint(&s.rig, &joint);
        (void)rig_start(&s.rig, NULL);
        const dmb_static_report report = rest(&s, DMB_STEADY_AUTO);
        assert_int_equal(report.steady, DMB_STEADY_SLIDING);
        const dmb_motion motion = motion_at(&s.rig, dmb_station(body, 0, 0.0), DMB_FRAME_BODY);
        check_close("body slides", motion.velocity[0], 0.02, 1e-6);
        check_close("body turns", motion.velocity[3], i == 0 ? 3.0 : motion.velocity[3], 1e-6);
        const double before = force_of(&s, s.feed), torque = force_of(&s, s.turning);
        for (int k = 0; k < 100; k++) must(&s.rig, dmb_sim_step(s.rig.sim, 1e-4, NULL));
        check_close("feed goes on", force_of(&s, s.feed), before, 1e-3 * fabs(before));
        check_close("torque goes on", force_of(&s, s.turning), torque, 1e-3 * fabs(torque));
        rig_close(&s.rig);
    }
}

/* ---- Modes about it ---------------------------------------------------------------------------------------------- */

/* A string that slides and turns is in balance to the tolerance that modes ask for, and has those of the string at rest
 * that assumes the slip and is spun, but for the tilt of the pipes. */
static void modes_about_a_sliding_string(void **state)
{
    const scene_choice c = {DMB_FRICTION_COULOMB, DMB_PIPE_FLEXIBLE, 0.5 * PI, 0.0, 0.05, 3.0, 0.0, 10};
    scene s;
    (void)state;
    describe(&s, &c);
    (void)rig_start(&s.rig, NULL);
    (void)rest(&s, DMB_STEADY_AUTO);
    dmb_modes_options options = dmb_modes_options_default();
    options.axes = DMB_MODES_AXES_AT_REST;
    options.kind = DMB_MODES_DAMPED;
    options.count = 6;
    dmb_modes *modes = find_modes(&s.rig, &options);
    check_below("out of balance", info_of(modes).residual_of_state, 1e-8);
    check_below("residual", info_of(modes).residual, 1e-9);
    dmb_modes_destroy(&modes);
    rig_close(&s.rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_settle_in_the_static_state),
        cmocka_unit_test(bit_cuts_in_the_steady_state),
        cmocka_unit_test(bodies_move_as_joints_let_them),
        cmocka_unit_test(modes_about_a_sliding_string),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
