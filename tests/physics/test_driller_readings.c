/* The readings of a driller against closed forms (a hanging string, a twisted one), balances of momentum in a run, and
 * a bit speed that is known at every time; and as outputs of a response against a run in time. Equations:
 * eq:drilling.rig-end, eq:drilling.stretch, eq:drilling.window. */
#include <stdlib.h>
#include <string.h>

#include "harmonic.h"

static double reading(const rig *s, int32_t quantity, dmb_id part)
{
    const dmb_output reading = {dmb_station(part, 0, 0.0), quantity, 0};
    double value = (double)NAN;
    const int32_t status = dmb_query_output(s->sim, &reading, &value);
    if (status < 0) fail_msg("%s: %s", dmb_output_name(quantity, NULL), dmb_status_text(status));
    return value;
}

static double first(const rig *s, int32_t quantity)
{
    return reading(s, quantity, (dmb_id){0, 0});
}

/* ---- At rest ----------------------------------------------------------------------------------------------------- */

/* A string of n pipes S1 hangs along -z under its weight, a force P and a moment T about its axis at the far end. */
static dmb_id open_hanging(rig *s, int32_t kind, uint32_t n, double P, double T)
{
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def load = dmb_load_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    wall.direction[0] = 0.0;
    wall.direction[2] = -1.0;
    add_wall(s, &wall);
    string.start_free = DMB_FREE_NONE;
    pipe.kind = kind;
    pipe.string = add_string(s, &string);
    add_pipes(s, &pipe, n);
    load.place = dmb_station(pipe.string, n - 1, 1.0);
    load.frame = DMB_FRAME_BODY;
    load.force[0] = P;
    load.moment[0] = T;
    add_load(s, &load);
    rig_start(s, NULL);
    find_equilibrium(s, NULL);
    return pipe.string;
}

/* Hook load w L + P, stretch w L^2/(2 EA) + P L/EA, wind-up T L/GJ with the sign of the rig's torque. */
static void hanging(void **state)
{
    (void)state;
    const s1_section v = s1_values();
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_AXIAL_TORSIONAL; kind++)
        for (int loaded = 0; loaded < 2; loaded++) {
            const double L = 30.0, P = loaded ? 2e4 : 0.0, T = loaded ? -1500.0 : 0.0;
            rig s;
            const dmb_id string = open_hanging(&s, kind, 20, P, T);
            const double weight = v.weight * L;
            check_relative("hook load", first(&s, DMB_OUTPUT_HOOK_LOAD), weight + P, 1e-9);
            check_relative("    force of the rig", reading(&s, DMB_OUTPUT_RIG_FORCE, string), weight + P, 1e-9);
            check_relative("    stretch", first(&s, DMB_OUTPUT_STRETCH), (0.5 * weight + P) * L / v.EA, 1e-5);
            check_close("    rotation torque", first(&s, DMB_OUTPUT_ROTATION_TORQUE), -T, 1e-7);
            check_close("    torque of the rig", first(&s, DMB_OUTPUT_RIG_TORQUE), -T, 1e-7);
            check_close("    wind-up", first(&s, DMB_OUTPUT_WIND_UP), -T * L / v.GJ, 1e-7);
            check_close("    wind-up by the rotations",
                        rotation_at(&s, dmb_station(string, 0, 0.0)) - rotation_at(&s, dmb_station(string, 19, 1.0)),
                        -T * L / v.GJ, 1e-7);
            rig_close(&s);
        }
}

/* ---- Several strings --------------------------------------------------------------------------------------------- */

static void unread(const rig *s, int32_t quantity, dmb_id part, int32_t wanted)
{
    const dmb_output reading = {dmb_station(part, 0, 0.0), quantity, 0};
    double value = 7.0;
    if (dmb_query_output(s->sim, &reading, &value) != wanted) fail_msg("%s", dmb_output_name(quantity, NULL));
    assert_true(value == 7.0);
    assert_int_equal(dmb_output_check(s->sim, &reading, 1), wanted);
    if (wanted != DMB_ERR_ID)
        assert_non_null(strstr(dmb_sim_message(s->sim), "with a bit (for off_bottom with a rock law)"));
}

static dmb_id add_falling(rig *s, int32_t first_kind, double depth, double speed)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    string.start_free = DMB_FREE_CYLINDRICAL;
    string.start_depth = depth;
    string.velocity[0] = speed;
    string.velocity[3] = 2.0 * speed;
    pipe.string = add_string(s, &string);
    pipe.kind = first_kind;
    (void)add_pipes(s, &pipe, 1);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    (void)add_pipes(s, &pipe, 2);
    return pipe.string;
}

/* Each string is read by itself: one with a bit that has no rock law and a load, one with a rigid pipe first and no
 * bit; a drive pulls the first one, another the joint of a body beside them. */
static void each_string_by_itself(void **state)
{
    (void)state;
    static const int32_t of_bits[3] = {DMB_OUTPUT_WEIGHT_ON_BIT, DMB_OUTPUT_TORQUE_ON_BIT,
                                       DMB_OUTPUT_RATE_OF_PENETRATION};
    const dmb_wall_def hole = s1_hole();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_id string[2];
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    (void)add_wall(&s, &hole);
    for (int i = 0; i < 2; i++)
        string[i] = add_falling(&s, i ? DMB_PIPE_RIGID : DMB_PIPE_FLEXIBLE, 10.0 + 20.0 * i, 0.3 + 0.5 * i);
    bit.string = string[0];
    bit.load = add_constant(&s, 250.0);
    must_model(&s, dmb_model_add_bit(s.model, &bit, NULL));
    const dmb_id block = add_body(&s, &body);
    const dmb_id slide =
        add_joint_between(&s, DMB_JOINT_CYLINDRICAL, dmb_station((dmb_id){0, 0}, 0, 0.0), dmb_station(block, 0, 0.0));
    const dmb_id pull = add_constant(&s, 400.0);
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, string[0], DMB_X, pull);
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, slide, DMB_X, pull);
    (void)rig_start(&s, NULL);
    check_close("weight on the bit of the first string [N]", reading(&s, DMB_OUTPUT_WEIGHT_ON_BIT, string[0]), 250.0,
                0.0);
    check_close("    rate of penetration [m/s]", reading(&s, DMB_OUTPUT_RATE_OF_PENETRATION, string[0]), 0.3, 1e-12);
    check_close("    force of its rig [N]", reading(&s, DMB_OUTPUT_RIG_FORCE, string[0]), -400.0, 1e-9);
    check_close("    of the other [N]", reading(&s, DMB_OUTPUT_RIG_FORCE, string[1]), 0.0, 1e-9);
    for (int i = 0; i < 2; i++) {
        check_close("feed speed [m/s]", reading(&s, DMB_OUTPUT_FEED_SPEED, string[i]), 0.3 + 0.5 * i, 1e-12);
        check_close("    bit speed [rad/s]", reading(&s, DMB_OUTPUT_BIT_SPEED, string[i]), 0.6 + i, 1e-12);
        check_close("    bit depth [m]", reading(&s, DMB_OUTPUT_BIT_DEPTH, string[i]), 14.5 + 20.0 * i, 1e-9);
    }
    for (int i = 0; i < 3; i++) unread(&s, of_bits[i], string[1], DMB_ERR_UNSUPPORTED);
    unread(&s, DMB_OUTPUT_OFF_BOTTOM, string[0], DMB_ERR_UNSUPPORTED); /* no rock */
    unread(&s, DMB_OUTPUT_OFF_BOTTOM, string[1], DMB_ERR_UNSUPPORTED); /* no bit */
    unread(&s, DMB_OUTPUT_HOOK_LOAD, string[1], DMB_ERR_UNSUPPORTED);  /* a rigid pipe has no section */
    unread(&s, DMB_OUTPUT_ROTATION_TORQUE, string[1], DMB_ERR_UNSUPPORTED);
    unread(&s, DMB_OUTPUT_STRETCH, (dmb_id){0, 7}, DMB_ERR_ID);
    rig_close(&s);
}

/* ---- In a run ---------------------------------------------------------------------------------------------------- */

typedef struct drilling {
    rig s;
    dmb_id string, bit;
} drilling;

/* Twelve pipes along x, fed and turned into rock 2 mm ahead. */
static drilling open_drilling(void)
{
    const dmb_segment feed = {.struct_size = sizeof feed, .kind = DMB_SEGMENT_STEP, .x1 = 0.1, .h1 = 0.02};
    const dmb_segment turn = {.struct_size = sizeof turn, .kind = DMB_SEGMENT_STEP, .x1 = 0.1, .h1 = 20.0};
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = dmb_bit_def_default();
    drilling d;
    rig_open(&d.s, 0.0, 0.0, -9.81);
    add_wall(&d.s, &wall);
    string.start_free = DMB_FREE_CYLINDRICAL;
    add_string(&d.s, &string);
    pipe.damping_time = 1e-4;
    d.string = add_pipes(&d.s, &pipe, 12);
    bit.rock_law = DMB_ROCK_RATE;
    bit.bottom = 2e-3;
    bit.load = add_constant(&d.s, 300.0);
    must_model(&d.s, dmb_model_add_bit(d.s.model, &bit, &d.bit));
    add_simple_drive(&d.s, DMB_DRIVE_MOTION, d.string, DMB_X, add_time_function(&d.s, &feed, 1));
    add_simple_drive(&d.s, DMB_DRIVE_MOTION, d.string, DMB_RX, add_time_function(&d.s, &turn, 1));
    rig_start(&d.s, NULL);
    return d;
}

/* Over the run the rig, the wall's friction and the bit change the momentum along the hole: d(p) = integral of
 * (friction - rig force - weight on bit), and the bit goes on by the integral of the rate of penetration once it is on
 * the bottom; the section at the rig end carries what the rig holds but for half an element. */
static void balances(void **state)
{
    (void)state;
    drilling d = open_drilling();
    const double h = 1e-4;
    double impulse = 0.0, most = 0.0, advance = 0.0, on_bottom_at = 0.0, shares = 0.0, drive = 0.0, hook = 0.0;
    double before = 0.0, rate_before = 0.0, start = first(&d.s, DMB_OUTPUT_MOMENTUM_X);
    dmb_window *window = NULL;
    dmb_window_result off = dmb_window_result_default();
    const dmb_output watched = {dmb_station(d.string, 0, 0.0), DMB_OUTPUT_OFF_BOTTOM, 0};
    must(&d.s, dmb_window_create(d.s.sim, NULL, &watched, 1, &window));
    for (int i = 0; i <= 4000; i++) {
        if (i > 0) take_steps(&d.s, h, 1);
        const double force = first(&d.s, DMB_OUTPUT_CONTACTS_FRICTION_AXIAL) - first(&d.s, DMB_OUTPUT_RIG_FORCE) -
                             first(&d.s, DMB_OUTPUT_WEIGHT_ON_BIT);
        const double rate = first(&d.s, DMB_OUTPUT_RATE_OF_PENETRATION);
        assert_int_equal(dmb_window_take(window, d.s.sim), DMB_OK);
        if (i > 0) impulse += 0.5 * h * (force + before);
        if (rate_before > 0.0) advance += 0.5 * h * (rate + rate_before);
        if (!(first(&d.s, DMB_OUTPUT_OFF_BOTTOM) > 0.0) && on_bottom_at == 0.0)
            on_bottom_at = reading(&d.s, DMB_OUTPUT_BIT_ADVANCE, d.bit);
        if (rate > 0.0 && rate_before == 0.0)
            advance = 0.0, on_bottom_at = reading(&d.s, DMB_OUTPUT_BIT_ADVANCE, d.bit);
        shares += i > 0 ? first(&d.s, DMB_OUTPUT_OFF_BOTTOM) / 4000.0 : 0.0;
        most = fmax(most, fabs(impulse));
        before = force;
        rate_before = rate;
        if (i > 3900) drive += first(&d.s, DMB_OUTPUT_RIG_FORCE), hook += first(&d.s, DMB_OUTPUT_HOOK_LOAD);
    }
    assert_int_equal(dmb_window_get(window, 0, &off), DMB_OK);
    check_close("momentum along the hole by its forces", first(&d.s, DMB_OUTPUT_MOMENTUM_X) - start, impulse,
                2e-4 * most);
    check_relative("advance by the rate of penetration", advance,
                   reading(&d.s, DMB_OUTPUT_BIT_ADVANCE, d.bit) - on_bottom_at, 1e-3);
    check_close("off-bottom share by the window", off.mean, shares, 2.0 / 4000.0);
    check_relative("thrust at the head by rig and section", hook, drive, 2e-2);
    assert_true(hook < 0.0 && off.mean > 0.05 && off.mean < 0.95);
    dmb_window_destroy(&window);
    rig_close(&d.s);
}

/* ---- Windows ----------------------------------------------------------------------------------------------------- */

/* A rigid pipe turned at 10 + A sin(w t): index A/10 over whole periods, mean 10, mean square 100 + A^2/2. The window
 * forgets what came before; a share of the time below a level is arccos. */
static void window_of_a_sine(void **state)
{
    (void)state;
    const double A = 4.0, omega = 20.0 * PI;
    const dmb_segment turn = {
        .struct_size = sizeof turn, .kind = DMB_SEGMENT_HARMONIC, .h0 = 10.0, .h1 = A, .omega = omega};
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_window_options options = dmb_window_options_default();
    dmb_window_result r = dmb_window_result_default();
    dmb_window *window = NULL, *whole = NULL;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    string.start_free = DMB_FREE_CYLINDRICAL;
    string.velocity[3] = 10.0;
    pipe.kind = DMB_PIPE_RIGID;
    pipe.string = add_string(&s, &string);
    add_pipes(&s, &pipe, 1);
    add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_time_function(&s, &turn, 1));
    rig_start(&s, NULL);
    const dmb_output watched = {dmb_station(pipe.string, 0, 0.0), DMB_OUTPUT_BIT_SPEED, 0};
    const double level = 10.0;
    options.length = 0.2;
    options.slots = 50;
    options.levels = &level;
    must(&s, dmb_window_create(s.sim, &options, &watched, 1, &window));
    must(&s, dmb_window_create(s.sim, NULL, &watched, 1, &whole));
    assert_int_equal(dmb_window_get(window, 0, &r), DMB_OK);
    assert_true(r.samples == 0 && isnan(r.mean) && isnan(r.index));
    for (int i = 0; i <= 1000; i++) {
        if (i > 0) take_steps(&s, 1e-3, 1);
        assert_int_equal(dmb_window_take(window, s.sim), DMB_OK);
        assert_int_equal(dmb_window_take(whole, s.sim), DMB_OK);
        assert_int_equal(dmb_window_take(window, s.sim), DMB_OK); /* the same time again counts for nothing */
    }
    assert_int_equal(dmb_window_get(whole, 0, &r), DMB_OK);
    assert_int_equal(r.samples, 1001);
    check_close("all: time", r.time, 1.0, 1e-12);
    check_close("    mean", r.mean, 10.0, 1e-9);
    check_relative("    root of the mean square", r.rms, sqrt(100.0 + 0.5 * A * A), 1e-3);
    check_close("    stick-slip index", r.index, A / 10.0, 1e-3);
    assert_int_equal(dmb_window_get(window, 0, &r), DMB_OK);
    check_close("window: time", r.time, 0.2, 0.2 / 50.0 + 1e-12);
    check_close("    mean", r.mean, 10.0, 0.06);
    check_close("    stick-slip index", r.index, A / 10.0, 5e-3);
    check_close("    share at or below the mean", r.low_share, 0.5, 0.03);
    assert_true(r.samples < 210);
    assert_int_equal(dmb_window_reset(window), DMB_OK);
    assert_int_equal(dmb_window_take(window, s.sim), DMB_OK);
    assert_int_equal(dmb_window_get(window, 0, &r), DMB_OK);
    assert_true(r.samples == 1 && r.time == 0.0 && r.index == 0.0);
    check_close("one sample: mean", r.mean, 10.0, 1e-9);
    dmb_window_destroy(&window);
    dmb_window_destroy(&whole);
    rig_close(&s);
}

/* Time that goes back, levels and sizes out of bounds. */
static void windows_refuse(void **state)
{
    (void)state;
    drilling d = open_drilling();
    const dmb_output good = {dmb_station(d.string, 0, 0.0), DMB_OUTPUT_HOOK_LOAD, 0};
    const dmb_output bad = {dmb_station(d.string, 0, 0.0), DMB_OUTPUT_JOINT_STATE, 0};
    dmb_window_options options = dmb_window_options_default();
    dmb_window *window = (dmb_window *)&d, *kept = NULL;
    dmb_window_result r = dmb_window_result_default();
    size_t size;
    unsigned char *snapshot;
    assert_int_equal(dmb_window_create(d.s.sim, NULL, &bad, 1, &window), DMB_ERR_ID);
    assert_null(window);
    assert_int_equal(dmb_window_create(d.s.sim, NULL, &good, 0, &window), DMB_ERR_VALUE);
    options.slots = 1;
    assert_int_equal(dmb_window_create(d.s.sim, &options, &good, 1, &window), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(d.s.sim), "slots"));
    options.slots = 10;
    for (int i = 0; i < 3; i++) {
        options.length = i == 0 ? -1.0 : i == 1 ? (double)NAN : (double)INFINITY;
        assert_int_equal(dmb_window_create(d.s.sim, &options, &good, 1, &window),
                         i == 0 ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE);
    }
    options.length = 0.0;
    const double level = -1.0;
    options.levels = &level;
    assert_int_equal(dmb_window_create(d.s.sim, &options, &good, 1, &window), DMB_ERR_VALUE);
    must(&d.s, dmb_window_create(d.s.sim, NULL, &good, 1, &kept));
    must(&d.s, dmb_sim_snapshot_size(d.s.sim, &size));
    snapshot = malloc(size);
    must(&d.s, dmb_sim_snapshot(d.s.sim, snapshot, size));
    take_steps(&d.s, 1e-4, 3);
    assert_int_equal(dmb_window_take(kept, d.s.sim), DMB_OK);
    must(&d.s, dmb_sim_restore(d.s.sim, snapshot, size));
    assert_int_equal(dmb_window_take(kept, d.s.sim), DMB_ERR_ORDER);
    assert_int_equal(dmb_window_get(kept, 1, &r), DMB_ERR_VALUE);
    assert_int_equal(dmb_window_get(kept, 0, &r), DMB_OK);
    assert_int_equal(r.samples, 1);
    free(snapshot);
    dmb_window_destroy(&kept);
    dmb_window_destroy(&kept);
    rig_close(&d.s);
}

/* ---- As outputs of a response ------------------------------------------------------------------------------------ */

static dmb_output output_output(dmb_id part, int32_t quantity)
{
    return output_at(quantity, dmb_station(part, 0, 0.0), 0);
}

/* Transfer functions of outputs from a force of the rig against the stepped sine of the same outputs. */
static void in_responses(void **state)
{
    (void)state;
    const double frequency = 30.0, amplitude = 20.0;
    const int32_t asked[6] = {DMB_OUTPUT_HOOK_LOAD,         DMB_OUTPUT_FEED_SPEED,
                              DMB_OUTPUT_POSITION_X,        DMB_OUTPUT_SECTION_STRAIN,
                              DMB_OUTPUT_BODY_ACCELERATION, DMB_OUTPUT_PROFILE + DMB_PROFILE_EFFECTIVE_FORCE};
    const dmb_segment shake = {
        .struct_size = sizeof shake, .kind = DMB_SEGMENT_HARMONIC, .h1 = amplitude, .omega = 2.0 * PI * frequency};
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    dmb_output outputs[6];
    double sine[6][4][2];
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    string.start_free = DMB_FREE_X;
    pipe.damping_time = 1e-3;
    pipe.string = add_string(&s, &string);
    add_pipes(&s, &pipe, 10);
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = pipe.string;
    drive.gain = 2e4;
    drive.integral_gain = 2e6;
    drive.time_function = add_constant(&s, 0.0);
    add_drive(&s, &drive);
    const dmb_id force = add_simple_drive(&s, DMB_DRIVE_LOAD, pipe.string, DMB_X, add_time_function(&s, &shake, 1));
    rig_start(&s, NULL);
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, force, DMB_X);
    for (int i = 0; i < 6; i++)
        outputs[i] = output_at(asked[i], dmb_station(pipe.string, i < 2 ? 0 : 4, i < 2 ? 0.0 : 0.5), 0);
    options.steps_per_period = 800;
    options.tolerance = 1e-5;
    const int32_t status = dmb_analysis_stepped_sine(s.sim, frequency, &options, outputs, 6, &sine[0][0][0], NULL);
    must(&s, status);
    rig still;
    rig_open(&still, 0.0, 0.0, 0.0);
    pipe.string = add_string(&still, &string);
    add_pipes(&still, &pipe, 10);
    drive.part = pipe.string;
    drive.time_function = add_constant(&still, 0.0);
    add_drive(&still, &drive);
    const dmb_id constant = add_simple_drive(&still, DMB_DRIVE_LOAD, pipe.string, DMB_X, add_constant(&still, 0.0));
    rig_start(&still, NULL);
    for (int i = 0; i < 6; i++) {
        const dmb_excitation same = input_of(DMB_EXCITATION_DRIVE, constant, DMB_X);
        double complex value;
        outputs[i].place.part = pipe.string;
        transfer(&still, NULL, &same, &outputs[i], &frequency, 1, &value);
        const double complex want = amplitude * value / i_, got = sine[i][1][0] + i_ * sine[i][1][1];
        assert_true(cabs(want) > 0.0);
        check_below(dmb_output_name(asked[i], NULL), cabs(got - want) / cabs(want), 1e-3);
    }
    (void)input;
    rig_close(&s);
    rig_close(&still);
}

/* A linear analysis refuses outputs that it cannot tell, by name; the bottom-hole load is in the weight. */
static void refused_in_responses(void **state)
{
    (void)state;
    drilling d = open_drilling();
    const int32_t refused[6] = {DMB_OUTPUT_STRETCH, DMB_OUTPUT_BENDING_MOMENT, DMB_OUTPUT_ENERGY_STRAIN,
                                DMB_OUTPUT_STEPS,   DMB_OUTPUT_RIG_FORCE,      DMB_OUTPUT_STICK_SLIP_INDEX};
    dmb_response_options options = dmb_response_options_default();
    const double frequency = 10.0;
    double complex value;
    const dmb_excitation load = input_of(DMB_EXCITATION_BIT_LOAD, d.bit, DMB_X);
    options.points = 1;
    options.frequencies = &frequency;
    options.equilibrium_tolerance = 1.0;
    for (int i = 0; i < 6; i++) {
        dmb_response *response = NULL;
        dmb_output output = output_output(i == 1 ? d.string : (dmb_id){0, 0}, refused[i]);
        assert_int_equal(dmb_analysis_response(d.s.sim, &options, &load, 1, &output, 1, &response),
                         DMB_ERR_UNSUPPORTED);
        const char *message = dmb_sim_message(d.s.sim);
        if (strstr(message, dmb_output_name(refused[i], NULL)) == NULL) fail_msg("says: %s", message);
    }
    const dmb_output weight = output_output((dmb_id){0, 0}, DMB_OUTPUT_WEIGHT_ON_BIT);
    transfer(&d.s, &options, &load, &weight, &frequency, 1, &value);
    check_close("weight on bit off bottom by the load", creal(value), 1.0, 0.0);
    dmb_output unknown = output_output(d.string, 99);
    dmb_response *response = NULL;
    assert_int_equal(dmb_analysis_response(d.s.sim, &options, &load, 1, &unknown, 1, &response), DMB_ERR_VALUE);
    rig_close(&d.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hanging),
        cmocka_unit_test(each_string_by_itself),
        cmocka_unit_test(balances),
        cmocka_unit_test(window_of_a_sine),
        cmocka_unit_test(windows_refuse),
        cmocka_unit_test(in_responses),
        cmocka_unit_test(refused_in_responses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
