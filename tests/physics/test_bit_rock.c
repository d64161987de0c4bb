/* The bit at work, asked through dmb_query_bit. A short rigid string without a wall is fed and turned by motion drives,
 * so that depth of cut, weight and torque follow from the drives alone; what the drives have to do is told by them.
 * Equations: eq:bit.forces. */
#include "contact_scene.h"

/* Coal of CASES: a .047 m, eps 10e6, zeta .6, sigma 10e6, l 1e-3, mu gamma .5; the header's defaults. */
static const double a = 0.047, eps = 10e6, zeta = 0.6, sigma = 10e6, wear = 1e-3, mu_gamma = 0.5;
static const double feed = 0.02, turning = 20.943951;

typedef struct drilling {
    rig scene;
    dmb_id bit, feed, turn;
} drilling;

static dmb_id motion(drilling *r, int32_t component, const dmb_segment *terms, uint32_t count)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.component = component;
    drive.time_function = add_time_function(&r->scene, terms, count);
    return add_drive(&r->scene, &drive);
}

/* Feed and rotation by the sums of `count` terms each, feed first. */
static void build_with(drilling *r, const dmb_bit_def *bit, int32_t pipe_kind, const dmb_segment *terms, uint32_t count)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    pipe.kind = pipe_kind;
    for (uint32_t i = 0; i < count; i++) {
        string.velocity[0] += terms[i].h0;
        string.velocity[3] += terms[count + i].h0;
    }
    scene_open(&r->scene, 0.0);
    add_string(&r->scene, &string);
    add_pipes(&r->scene, &pipe, 1);
    r->bit = scene_add_bit(&r->scene, bit);
    r->feed = motion(r, DMB_X, terms, count);
    r->turn = motion(r, DMB_RX, terms + count, count);
    rig_start_with(&r->scene, NULL, NULL);
}

static void build(drilling *r, int32_t rock_law, double bottom)
{
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_segment terms[2] = {dmb_segment_default(), dmb_segment_default()};
    bit.rock_law = rock_law;
    bit.bottom = bottom;
    terms[0].h0 = feed;
    terms[1].h0 = turning;
    build_with(r, &bit, DMB_PIPE_RIGID, terms, 1);
}

static dmb_bit_state bit_of(const drilling *r)
{
    dmb_bit_state state = dmb_bit_state_default();
    assert_int_equal(dmb_query_bit(r->scene.sim, r->bit, &state), DMB_OK);
    return state;
}

static dmb_drive_state drive_of(const drilling *r, dmb_id id)
{
    dmb_drive_state state = dmb_drive_state_default();
    assert_int_equal(dmb_query_drive(r->scene.sim, id, &state), DMB_OK);
    return state;
}

/* CASES: V .02, Om 20.943951: d 6e-3 m, W 2162.0 N, T 71.7925 N m; 1e-10 of the formulas at this Om. The figures of the
 * case are rounded: at 200 rpm, Om 20 pi/3, they are exact, and Om 20.943951 is 1.1e-8 less. */
static void rate_law(void **state)
{
    const double d = 2.0 * PI * feed / turning;
    drilling r;
    (void)state;
    build(&r, DMB_ROCK_RATE, 0.0);
    for (int i = 0; i < 100; i++) scene_step(&r.scene, 1e-3);
    const dmb_bit_state bit = bit_of(&r);
    assert_int_equal(bit.on_bottom, 1);
    CHECK_RELATIVE(bit.depth_of_cut, d, 1e-10);
    CHECK_RELATIVE(bit.weight, zeta * eps * a * d + sigma * a * wear, 1e-10);
    CHECK_RELATIVE(bit.torque, 0.5 * a * a * (eps * d + mu_gamma * sigma * wear), 1e-10);
    CHECK_RELATIVE(bit.depth_of_cut, 6e-3, 2e-8);
    CHECK_RELATIVE(bit.weight, 2162.0, 2e-8);
    CHECK_RELATIVE(bit.torque, 71.7925, 2e-8);
    CHECK_RELATIVE(bit.advance, 0.1 * feed, 1e-12);
    CHECK_RELATIVE(drive_of(&r, r.feed).force, bit.weight, 1e-10);
    CHECK_RELATIVE(drive_of(&r, r.turn).force, bit.torque, 1e-10);
    rig_close(&r.scene);
}

/* All that the drives spend is spent at the bit. */
static void drilling_energy(void **state)
{
    static const int32_t laws[] = {DMB_ROCK_RATE, DMB_ROCK_REGENERATIVE};
    (void)state;
    for (int k = 0; k < 2; k++) {
        drilling r;
        build(&r, laws[k], 0.0);
        for (int i = 0; i < 1000; i++) scene_step(&r.scene, 1e-3);
        const dmb_energy energy = energy_of(&r.scene);
        const double spent = drive_of(&r, r.feed).work + drive_of(&r, r.turn).work;
        CHECK_RELATIVE(energy.drives, spent, 1e-12);
        CHECK_RELATIVE(energy.rock, spent, 1e-12);
        CHECK_RELATIVE(energy.input, spent, 1e-12);
        CHECK_BELOW(energy.error, 1e-12);
        /* W V + T Om over 1 s, less what the first revolution and the wear flat's engagement took */
        if (laws[k] == DMB_ROCK_RATE) CHECK_RELATIVE(spent, 2162.0 * feed + 71.7925 * turning, 1e-2);
        rig_close(&r.scene);
    }
}

/* The regenerative law needs one blade spacing, 1/4 of a turn, to reach the depth of the rate law: each blade then cuts
 * d/n below the surface that the one before it left. */
static void regenerative_law(void **state)
{
    const double spacing = 0.5 * PI / turning;
    drilling r;
    (void)state;
    build(&r, DMB_ROCK_REGENERATIVE, 0.0);
    for (int i = 0; i < 50; i++) scene_step(&r.scene, spacing / 100.0);
    CHECK_RELATIVE(bit_of(&r).depth_of_cut, 4.0 * feed * 0.5 * spacing, 1e-9); /* flat rock so far */
    for (int i = 0; i < 400; i++) scene_step(&r.scene, spacing / 100.0);
    const dmb_bit_state bit = bit_of(&r);
    CHECK_RELATIVE(bit.depth_of_cut, 6e-3, 1e-6);
    CHECK_RELATIVE(bit.weight, 2162.0, 1e-6);
    CHECK_RELATIVE(bit.torque, 71.7925, 1e-6);
    rig_close(&r.scene);
}

/* Off bottom there is nothing until the distance is drilled through. */
static void off_bottom(void **state)
{
    drilling r;
    (void)state;
    build(&r, DMB_ROCK_RATE, 0.01);
    for (int i = 0; i < 499; i++) {
        scene_step(&r.scene, 1e-3);
        const dmb_bit_state bit = bit_of(&r);
        assert_int_equal(bit.on_bottom, 0);
        CHECK_CLOSE(bit.weight + bit.torque, 0.0, 0.0);
        CHECK_RELATIVE(bit.bottom, 0.01, 1e-15);
    }
    for (int i = 0; i < 20; i++) scene_step(&r.scene, 1e-3);
    assert_int_equal(bit_of(&r).on_bottom, 1);
    CHECK_RELATIVE(bit_of(&r).weight, 2162.0, 2e-8);
    rig_close(&r.scene);
}

/* The bottom-hole load is a force against the feed from its time function, with or without rock. */
static void bottom_hole_load(void **state)
{
    dmb_bit_def def = dmb_bit_def_default();
    dmb_segment step = scene_step_segment(0.0, 0.0, 1.0, 2960.0);
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    drilling r;
    double reaction[6];
    (void)state;
    scene_open(&r.scene, 0.0);
    string.start_free = DMB_FREE_NONE;
    add_string(&r.scene, &string);
    pipe.kind = DMB_PIPE_RIGID;
    const dmb_id id = add_pipes(&r.scene, &pipe, 2);
    def.load = add_time_function(&r.scene, &step, 1);
    r.bit = scene_add_bit(&r.scene, &def);
    rig_start_with(&r.scene, NULL, NULL);
    for (int i = 1; i <= 12; i++) {
        const double t = 0.1 * i, x = fmin(t, 1.0);
        scene_step(&r.scene, 0.1);
        CHECK_RELATIVE(bit_of(&r).load, 2960.0 * x * x * (3.0 - 2.0 * x), 1e-14);
        assert_int_equal(dmb_query_reaction(r.scene.sim, id, reaction), DMB_OK);
        CHECK_RELATIVE(reaction[0], bit_of(&r).load, 1e-12);
    }
    rig_close(&r.scene);
}

/* ---- Hard case 15 ------------------------------------------------------------------------------------------------ */

/* Drills for 1 s, stops to 1.5 s, then turns and moves backwards: no cutting, and nothing is asked of the history
 * outside of what it holds. Drilling on afterwards meets rock where it was left. */
static void reverse_rotation(void **state)
{
    static const int32_t laws[] = {DMB_ROCK_RATE, DMB_ROCK_REGENERATIVE};
    (void)state;
    for (int k = 0; k < 2; k++) {
        dmb_bit_def bit = dmb_bit_def_default();
        const dmb_segment terms[6] = {
            scene_step_segment(1.0, feed, 1.5, 0.0),       scene_step_segment(1.5, 0.0, 2.0, -feed),
            scene_step_segment(3.0, 0.0, 3.5, 2.0 * feed), scene_step_segment(1.0, turning, 1.5, 0.0),
            scene_step_segment(1.5, 0.0, 2.0, -turning),   scene_step_segment(3.0, 0.0, 3.5, 2.0 * turning)};
        double deepest = 0.0;
        int met = 0;
        drilling r;
        bit.rock_law = laws[k];
        bit.history = 64;
        build_with(&r, &bit, DMB_PIPE_RIGID, terms, 3);
        for (int i = 0; i < 6500; i++) {
            scene_step(&r.scene, 1e-3);
            const double t = dmb_sim_time(r.scene.sim);
            const dmb_bit_state now = bit_of(&r);
            assert_true(isfinite(now.weight) && isfinite(now.torque));
            if (t > 1.6 && t < 3.0) CHECK_CLOSE(now.depth_of_cut, 0.0, 0.0);
            if (t > 2.0 && t < 3.0) CHECK_CLOSE(fabs(now.weight) + fabs(now.torque), 0.0, 0.0);
            if (t > 3.0 && !met && now.on_bottom) {
                met = 1; /* rate law: but for the intrusion of the wear flat; regenerative: the last blade's ledge */
                CHECK_CLOSE(now.advance, deepest, laws[k] == DMB_ROCK_RATE ? 1.5e-4 : 1.5e-3);
            }
            if (t < 3.0) deepest = fmax(deepest, now.advance);
        }
        assert_int_equal(met, 1);
        CHECK_RELATIVE(bit_of(&r).depth_of_cut, 6e-3, 1e-4);
        CHECK_RELATIVE(bit_of(&r).weight, 2162.0, 1e-4);
        rig_close(&r.scene);
    }
}

/* Turning backwards while it is fed forwards: the wear flat presses and rubs, nothing is cut. */
static void reverse_on_bottom(void **state)
{
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_segment terms[2] = {dmb_segment_default(), dmb_segment_default()};
    drilling r;
    (void)state;
    bit.rock_law = DMB_ROCK_RATE;
    terms[0].h0 = 1e-3;
    terms[1].h0 = -turning;
    build_with(&r, &bit, DMB_PIPE_RIGID, terms, 1);
    for (int i = 0; i < 500; i++) scene_step(&r.scene, 1e-3);
    CHECK_CLOSE(bit_of(&r).depth_of_cut, 0.0, 0.0);
    CHECK_RELATIVE(bit_of(&r).weight, sigma * a * wear, 1e-10);
    CHECK_RELATIVE(bit_of(&r).torque, -0.5 * mu_gamma * sigma * a * a * wear, 1e-10);
    rig_close(&r.scene);
}

/* A string that twists and stretches carries the same torque and weight to the bit, once the start has died out. */
static void through_a_flexible_pipe(void **state)
{
    static const int32_t kinds[] = {DMB_PIPE_FLEXIBLE, DMB_PIPE_AXIAL_TORSIONAL};
    (void)state;
    for (int k = 0; k < 2; k++) {
        dmb_bit_def bit = dmb_bit_def_default();
        const dmb_segment terms[2] = {scene_step_segment(0.0, 0.0, 0.5, feed),
                                      scene_step_segment(0.0, 0.0, 0.2, turning)};
        drilling r;
        bit.rock_law = DMB_ROCK_RATE;
        build_with(&r, &bit, kinds[k], terms, 1);
        for (int i = 0; i < 2000; i++) scene_step(&r.scene, 1e-3);
        const dmb_bit_state now = bit_of(&r);
        CHECK_RELATIVE(now.weight, 2162.0, 1e-6);
        CHECK_RELATIVE(now.torque, 71.7925, 1e-6);
        CHECK_RELATIVE(drive_of(&r, r.feed).force, 2162.0, 1e-6);
        CHECK_RELATIVE(drive_of(&r, r.turn).force, 71.7925, 1e-6);
        rig_close(&r.scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rate_law),          cmocka_unit_test(drilling_energy),
        cmocka_unit_test(regenerative_law),  cmocka_unit_test(off_bottom),
        cmocka_unit_test(bottom_hole_load),  cmocka_unit_test(reverse_rotation),
        cmocka_unit_test(reverse_on_bottom), cmocka_unit_test(through_a_flexible_pipe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
