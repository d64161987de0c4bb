/* A mud motor between two sections of a string: speed of the bit, stall and reactions against the closed forms of its
 * torque-speed line or table, its power against the ledger of energies, a table's run-up against exponentials piece by
 * piece, its linearisation against a line's, its sensitivities against the derivative of the closed form. Equations:
 * eq:drive.motor. */
#include <stdlib.h>
#include <string.h>

#include "drillmbd/scene.h"
#include "mechanism.h"

static const double stall = 800.0, displacement = 0.02, flow = 0.03, head_speed = 4.0;

typedef struct motor_rig {
    rig s;
    dmb_id above, below, joint, motor, head, input;
    double free_speed; /* [rad/s] w0 */
} motor_rig;

/* In the place of the line; the set point of the drive too, where it is not 0. */
static const dmb_motor *instead;
static double gain_instead, set_point_instead, point_mass;
static int with_input;
static int32_t pipe_kind = DMB_PIPE_FLEXIBLE;

static dmb_id section(rig *s, double position, int32_t start_free)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.follows_hole = 0;
    string.position[0] = position;
    string.start_free = start_free;
    pipe.length = 2.0;
    pipe.damping_time = 5e-3;
    pipe.kind = pipe_kind;
    pipe.string = add_string(s, &string);
    (void)add_pipes(s, &pipe, 2);
    return pipe.string;
}

/* Two sections along x, the upper one turned at head_speed; a torque against the rotation at the bit, as given and by
 * its speed. held: the bit does not turn. */
static motor_rig describe(double torque, double resistance, int held, int32_t brakes)
{
    motor_rig r;
    dmb_motor motor = dmb_motor_default();
    dmb_drive_def drive = dmb_drive_def_default(), turn = dmb_drive_def_default();
    dmb_environment_def e = dmb_environment_def_default();
    rig_open(&r.s, 0.0, 0.0, 0.0);
    e.torsional_damping = resistance / 4.0; /* of the 4 m below; above it only adds to the rig's torque */
    e.gravity[2] = 0.0;
    e.lateral_damping = 2e3; /* damped pipes that turn faster than they bend would whirl */
    must_model(&r.s, dmb_model_set_environment(r.s.model, &e));
    r.above = section(&r.s, 0.0, DMB_FREE_RX);
    r.below = section(&r.s, 4.0, DMB_FREE_ALL);
    dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, dmb_station(r.above, 1, 1.0), dmb_station(r.below, 0, 0.0));
    r.joint = add_joint(&r.s, &joint);
    motor.stall_torque = stall;
    motor.displacement = displacement;
    motor.flow = flow;
    motor.brakes = brakes;
    drive.part = r.joint;
    if (instead != NULL) motor = *instead;
    assert_int_equal(dmb_motor_drive(&motor, &drive, &r.free_speed), DMB_OK);
    if (gain_instead > 0.0) drive.gain = gain_instead, drive.limit_high = 1000.0, r.free_speed = set_point_instead;
    drive.time_function = add_constant(&r.s, r.free_speed);
    must_model(&r.s, dmb_model_add_drive(r.s.model, &drive, &r.motor));
    if (with_input) {
        dmb_input_def input = dmb_input_def_default();
        input.part = r.motor;
        input.high = 100.0;
        (void)strcpy(input.name, "motor");
        must_model(&r.s, dmb_model_add_input(r.s.model, &input, &r.input));
    }
    if (point_mass > 0.0) {
        dmb_body_def bit = dmb_body_def_default();
        bit.attach = DMB_ATTACH_END;
        bit.string = r.below;
        bit.mass = 1.0;
        bit.inertia[0] = bit.inertia[1] = bit.inertia[2] = point_mass;
        (void)add_body(&r.s, &bit);
    }
    turn.part = r.above;
    turn.component = DMB_RX;
    turn.time_function = add_constant(&r.s, held || point_mass > 0.0 ? 0.0 : head_speed);
    must_model(&r.s, dmb_model_add_drive(r.s.model, &turn, &r.head));
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(r.below, 1, 1.0);
    load.moment[0] = -torque;
    load.frame = DMB_FRAME_BODY;
    must_model(&r.s, dmb_model_add_load(r.s.model, &load, NULL));
    if (held) {
        dmb_stuck_def stuck = dmb_stuck_def_default();
        stuck.place = load.place;
        must_model(&r.s, dmb_model_add_stuck(r.s.model, &stuck, NULL));
    }
    (void)mechanism_start(&r.s, NULL);
    return r;
}

static double value_of(const motor_rig *r, int32_t quantity, dmb_place place)
{
    const dmb_output reading = {.place = place, .quantity = quantity};
    double value = 0.0;
    must(&r->s, dmb_query_output(r->s.sim, &reading, &value));
    return value;
}

static dmb_place bit_of(const motor_rig *r)
{
    return dmb_station(r->below, 1, 1.0);
}

static void the_bit_turns_faster_than_the_string(void **state)
{
    const double torque = 300.0, resistance = 2.0;
    (void)state;
    motor_rig r = describe(torque, resistance, 0, 0);
    must(&r.s, dmb_sim_advance(r.s.sim, 8.0, NULL));
    /* T = stall (1 - w/w0) = torque + resistance (head + w) */
    const double w = (stall - torque - resistance * head_speed) / (stall / r.free_speed + resistance);
    const double T = stall * (1.0 - w / r.free_speed);
    check_relative("no-load speed, 2 pi flow/displacement [rad/s]", r.free_speed, 2.0 * PI * 1.5, 1e-14);
    check_relative("speed of the bit, string + motor [rad/s]", value_of(&r, DMB_OUTPUT_SPIN, bit_of(&r)),
                   head_speed + w, 1e-7);
    check_relative("torque of the motor [N m]", value_of(&r, DMB_OUTPUT_DRIVE_FORCE, dmb_station(r.motor, 0, 0.0)), T,
                   1e-7);
    check_relative("torque at the rig, that of the motor and of the mud [N m]",
                   value_of(&r, DMB_OUTPUT_DRIVE_FORCE, dmb_station(r.head, 0, 0.0)), T + resistance * head_speed,
                   1e-7);
    check_relative("power of the motor, T w [W]", value_of(&r, DMB_OUTPUT_DRIVE_POWER, dmb_station(r.motor, 0, 0.0)),
                   T * w, 1e-6);
    const dmb_energy e = energy_of(&r.s);
    check_below("energy balance over what went in", e.balance / e.input, 1e-5);
    rig_close(&r.s);
}

static void it_stalls(void **state)
{
    (void)state;
    motor_rig r = describe(0.0, 2.0, 1, 0);
    must(&r.s, dmb_sim_advance(r.s.sim, 4.0, NULL));
    check_relative("torque at stall [N m]", value_of(&r, DMB_OUTPUT_DRIVE_FORCE, dmb_station(r.motor, 0, 0.0)), stall,
                   1e-6);
    check_below("speed at stall [rad/s]", value_of(&r, DMB_OUTPUT_JOINT_SPEED + 3, dmb_station(r.joint, 0, 0.0)), 1e-5);
    rig_close(&r.s);
}

/* Overrun by a torque that helps: free without brakes, on the same line with them. */
static void beyond_its_speed_it_runs_free_or_brakes(void **state)
{
    (void)state;
    motor_rig runs = describe(-100.0, 2.0, 0, 0), brakes = describe(-100.0, 2.0, 0, 1);
    must(&runs.s, dmb_sim_advance(runs.s.sim, 20.0, NULL));
    must(&brakes.s, dmb_sim_advance(brakes.s.sim, 8.0, NULL));
    const double w = (stall + 100.0 - 2.0 * head_speed) / (stall / brakes.free_speed + 2.0);
    check_relative("speed of one that runs free [rad/s]", value_of(&runs, DMB_OUTPUT_SPIN, bit_of(&runs)), 50.0, 1e-5);
    check_below("its torque [N m]", value_of(&runs, DMB_OUTPUT_DRIVE_FORCE, dmb_station(runs.motor, 0, 0.0)), 1e-12);
    check_relative("speed of one that brakes [rad/s]", value_of(&brakes, DMB_OUTPUT_SPIN, bit_of(&brakes)),
                   head_speed + w, 1e-7);
    rig_close(&runs.s);
    rig_close(&brakes.s);
}

/* ---- By a table ---------------------------------------------------------------------------------------------------
 */

static dmb_motor by_table(void)
{
    static const double speeds[] = {0.0, 4.0, 8.0, 10.0}, torques[] = {800.0, 700.0, 400.0, 0.0};
    dmb_motor motor = dmb_motor_default();
    motor.flow = flow;
    motor.table_count = 4;
    memcpy(motor.table_speed, speeds, sizeof speeds);
    memcpy(motor.table_torque, torques, sizeof torques);
    return motor;
}

static motor_rig describe_by(const dmb_motor *motor, double torque, double resistance, int held)
{
    instead = motor;
    const motor_rig r = describe(torque, resistance, held, 0);
    instead = NULL;
    return r;
}

static double speed_of(const motor_rig *r)
{
    return value_of(r, DMB_OUTPUT_JOINT_SPEED + 3, dmb_station(r->joint, 0, 0.0));
}

/* The torque of the table, linear between its points, equals that on the bit: in each piece, and at twice the flow and
 * half the pressure of the table. */
static void a_table_gives_the_speed(void **state)
{
    const double torques[] = {750.0, 500.0, 100.0}, resistance = 2.0;
    (void)state;
    for (int i = 0; i < 6; i++) {
        dmb_motor motor = by_table();
        const double fast = i < 3 ? 1.0 : 2.0, strong = i < 3 ? 1.0 : 0.5, torque = strong * torques[i % 3];
        motor.flow = fast * flow;
        if (i >= 3) motor.table_flow = flow, motor.table_pressure = 2e6, motor.pressure = 1e6;
        motor_rig r = describe_by(&motor, torque, resistance, 0);
        must(&r.s, dmb_sim_advance(r.s.sim, 8.0, NULL));
        const double *w = motor.table_speed, *T = motor.table_torque;
        double found = -1.0;
        for (int k = 0; k < 3; k++) { /* strong (T_k + s (w - w_k)) = torque + resistance (head + fast w) */
            const double s = (T[k + 1] - T[k]) / (w[k + 1] - w[k]);
            const double at =
                (torque + resistance * head_speed - strong * (T[k] - s * w[k])) / (strong * s - resistance * fast);
            if (at >= w[k] && at <= w[k + 1]) found = fast * at;
        }
        check_relative("w0 [rad/s]", r.free_speed, fast * 10.0, 1e-14);
        check_relative("speed of the motor [rad/s]", speed_of(&r), found, 1e-7);
        check_relative("its torque [N m]", value_of(&r, DMB_OUTPUT_DRIVE_FORCE, dmb_station(r.motor, 0, 0.0)),
                       torque + resistance * (head_speed + found), 1e-7);
        const dmb_energy e = energy_of(&r.s);
        check_below("energy balance over what went in", e.balance / e.input, 1e-5);
        rig_close(&r.s);
    }
}

static void a_table_stalls_and_runs_free(void **state)
{
    dmb_motor motor = by_table();
    (void)state;
    motor_rig held = describe_by(&motor, 0.0, 2.0, 1), runs = describe_by(&motor, -100.0, 2.0, 0);
    motor.brakes = 1;
    motor_rig brakes = describe_by(&motor, -100.0, 2.0, 0);
    must(&held.s, dmb_sim_advance(held.s.sim, 4.0, NULL));
    must(&runs.s, dmb_sim_advance(runs.s.sim, 20.0, NULL));
    must(&brakes.s, dmb_sim_advance(brakes.s.sim, 8.0, NULL));
    check_relative("torque at stall [N m]", value_of(&held, DMB_OUTPUT_DRIVE_FORCE, dmb_station(held.motor, 0, 0.0)),
                   800.0, 1e-6);
    check_relative("one that runs free [rad/s]", value_of(&runs, DMB_OUTPUT_SPIN, bit_of(&runs)), 50.0, 1e-5);
    /* 400/2 (10 - w) = -100 + 2 (head + w) */
    check_relative("one that brakes along its last line [rad/s]", speed_of(&brakes), 2092.0 / 202.0, 1e-7);
    rig_close(&held.s), rig_close(&runs.s), rig_close(&brakes.s);
}

/* T_s = efficiency V dp/(2 pi), n = Q/V. */
static void pressure_gives_the_torque(void **state)
{
    dmb_motor motor = dmb_motor_default();
    dmb_drive_def drive = dmb_drive_def_default();
    double speed;
    (void)state;
    motor.displacement = 0.0125;
    motor.flow = 0.025;
    motor.pressure = 4e6;
    motor.efficiency = 0.8;
    assert_int_equal(dmb_motor_drive(&motor, &drive, &speed), DMB_OK);
    check_relative("stall torque [N m]", drive.limit_high, 0.8 * 0.0125 * 4e6 / (2.0 * PI), 1e-14);
    check_relative("two revolutions a second [rad/s]", speed, 4.0 * PI, 1e-14);
    check_relative("at half the speed: power of the mud times efficiency/2 [W]", drive.gain * 0.5 * speed * 0.5 * speed,
                   0.8 * 0.5 * motor.pressure * 0.5 * motor.flow, 1e-14);
}

static void run(const motor_rig *r, int count)
{
    for (int i = 0; i < count; i++) assert_true(dmb_sim_step(r->s.sim, 2e-3, NULL) >= 0);
}

/* An input of the set point is the flow: after it the motor is the one of that flow from the beginning, its torque by
 * what leaks; snapshot and replay have the same hash. */
static void another_flow_while_it_runs(void **state)
{
    dmb_motor motor = by_table();
    dmb_input_record log[4];
    uint32_t next = 0;
    (void)state;
    with_input = 1;
    motor_rig r = describe_by(&motor, 500.0, 2.0, 0), again = describe_by(&motor, 500.0, 2.0, 0);
    with_input = 0;
    must(&r.s, dmb_sim_record_inputs(r.s.sim, log, 4));
    run(&r, 200);
    must(&r.s, dmb_sim_set_input(r.s.sim, r.input, 15.0)); /* 1.5 times the flow: 5 rad/s more */
    run(&r, 1800);
    const double w = (700.0 + 75.0 * (4.0 + 5.0) - 500.0 - 2.0 * head_speed) / (75.0 + 2.0);
    check_relative("speed at the other flow [rad/s]", speed_of(&r), w, 1e-6);
    for (int i = 0; i < 2000; i++) {
        must(&again.s, dmb_sim_replay_inputs(again.s.sim, log, dmb_sim_recorded_inputs(r.s.sim), &next));
        run(&again, 1);
    }
    assert_true(rig_hash(&r.s) == rig_hash(&again.s));
    rig_close(&r.s), rig_close(&again.s);
}

/* A heavy bit, rigid pipes: I w' = T(w) - torque - resistance w, in each piece an exponential. */
static void run_up_is_made_of_exponentials(void **state)
{
    const dmb_motor motor = by_table();
    const double resistance = 2.0, *w = motor.table_speed, *T = motor.table_torque;
    double time = 0.0, from = 0.0;
    (void)state;
    point_mass = 4000.0;
    pipe_kind = DMB_PIPE_RIGID;
    motor_rig r = describe_by(&motor, 100.0, resistance, 0);
    point_mass = 0.0;
    pipe_kind = DMB_PIPE_FLEXIBLE;
    for (int k = 0; k < 2; k++) {
        const double s = (T[k + 1] - T[k]) / (w[k + 1] - w[k]), S = s - resistance;
        const double end = -(T[k] - s * w[k] - 100.0) / S;
        time += 4000.0 / S * log((w[k + 1] - end) / (from - end));
        must(&r.s, dmb_sim_advance(r.s.sim, time, NULL));
        check_relative("speed at the end of a piece of the table [rad/s]", speed_of(&r), w[k + 1], 1e-3);
        from = w[k + 1];
    }
    rig_close(&r.s);
}

/* ---- Linear analyses and sensitivities ----------------------------------------------------------------------------
 */

static double *space_of(const motor_rig *r, size_t *count)
{
    dmb_state_space_options options = dmb_state_space_options_default();
    dmb_state_space_info info = dmb_state_space_info_default();
    dmb_state_space *space = NULL;
    dmb_excitation input = {
        .struct_size = sizeof input, .place = dmb_station(r->motor, 0, 0.0), .kind = DMB_EXCITATION_DRIVE};
    dmb_output output = {.place = dmb_station(r->motor, 0, 0.0), .quantity = DMB_OUTPUT_DRIVE_FORCE};
    must(&r->s, dmb_analysis_state_space(r->s.sim, &options, &input, 1, &output, 1, &space));
    assert_int_equal(dmb_state_space_get_info(space, &info), DMB_OK);
    const size_t n = info.states, sizes[] = {n * n, n, n, 1};
    const int32_t which[] = {DMB_MATRIX_A, DMB_MATRIX_B, DMB_MATRIX_C, DMB_MATRIX_D};
    double *all = calloc(n * n + 2 * n + 1, sizeof *all), *to = all;
    for (int k = 0; k < 4; to += sizes[k++]) assert_int_equal(dmb_state_space_dense(space, which[k], to), DMB_OK);
    *count = n * n + 2 * n + 1;
    dmb_state_space_destroy(&space);
    return all;
}

/* In its state a table is the line that its piece lies on; the two runs differ by rounding. */
static void linearised_it_is_a_line(void **state)
{
    dmb_motor motor = by_table();
    motor.table_torque[0] = 1000.0;
    motor.table_speed[1] = 8.0, motor.table_torque[1] = 400.0;
    motor.table_speed[2] = 10.0, motor.table_torque[2] = 0.0;
    motor.table_count = 3;
    size_t count, other;
    (void)state;
    motor_rig table = describe_by(&motor, 500.0, 2.0, 0);
    gain_instead = 75.0; /* (1000 - 400)/8; T = 75 (40/3 - w) */
    set_point_instead = 40.0 / 3.0;
    motor_rig line = describe(500.0, 2.0, 0, 1);
    gain_instead = 0.0;
    must(&table.s, dmb_sim_advance(table.s.sim, 12.0, NULL));
    must(&line.s, dmb_sim_advance(line.s.sim, 12.0, NULL));
    check_relative("the same speed [rad/s]", speed_of(&table), speed_of(&line), 1e-7);
    double *a = space_of(&table, &count), *b = space_of(&line, &other), worst = 0.0, most = 0.0;
    assert_true(count == other);
    for (size_t i = 0; i < count; i++) {
        worst = fmax(worst, fabs(a[i] - b[i]));
        most = fmax(most, fabs(b[i]));
    }
    check_relative("D is the slope of the piece [N m s]", a[count - 1], 75.0, 1e-6);
    check_below("A, B, C, D of table and line, over the largest", worst / most, 1e-7);
    free(a), free(b);
    rig_close(&table.s), rig_close(&line.s);
}

static void a_flat_piece_answers_to_nothing(void **state)
{
    const dmb_motor motor = by_table();
    dmb_state_space_options options = dmb_state_space_options_default();
    dmb_state_space *space = NULL;
    (void)state;
    motor_rig r = describe_by(&motor, 0.0, 2.0, 1);
    dmb_excitation input = {
        .struct_size = sizeof input, .place = dmb_station(r.motor, 0, 0.0), .kind = DMB_EXCITATION_DRIVE};
    dmb_output output = {.place = dmb_station(r.motor, 0, 0.0), .quantity = DMB_OUTPUT_DRIVE_FORCE};
    take_steps(&r.s, 1e-3, 1);
    (void)dmb_analysis_static(r.s.sim, NULL, NULL);
    assert_int_equal(dmb_analysis_state_space(r.s.sim, &options, &input, 1, &output, 1, &space), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(r.s.sim), "answers to nothing"));
    rig_close(&r.s);
}

/* d w/d torque = 1/(s - resistance), in the second piece. */
static void sensitivity_is_that_of_the_closed_form(void **state)
{
    const dmb_motor motor = by_table();
    (void)state;
    motor_rig r = describe_by(&motor, 500.0, 2.0, 0), low = describe_by(&motor, 499.999, 2.0, 0);
    motor_rig high = describe_by(&motor, 500.001, 2.0, 0);
    dmb_parameter torque = {.struct_size = sizeof torque, .step = 1e-3, .low = low.s.sim, .high = high.s.sim};
    dmb_sensitivity *along = NULL;
    double slope = 0.0;
    must(&r.s, dmb_sensitivity_create(r.s.sim, &torque, 1, &along));
    for (int i = 0; i < 2000; i++) assert_true(dmb_sensitivity_step(along, 2e-3, NULL) >= 0);
    const dmb_output reading = {.place = dmb_station(r.joint, 0, 0.0), .quantity = DMB_OUTPUT_JOINT_SPEED + 3};
    assert_true(dmb_sensitivity_outputs(along, &reading, 1, NULL, &slope) >= 0);
    check_relative("d w/d torque [rad/(N m s)]", slope, -1.0 / (75.0 + 2.0), 1e-5);
    dmb_sensitivity_destroy(&along);
    rig_close(&r.s), rig_close(&low.s), rig_close(&high.s);
}

/* ---- Nonsense -----------------------------------------------------------------------------------------------------
 */

static void nonsense_tables_are_refused(void **state)
{
    dmb_drive_def drive = dmb_drive_def_default(), before = drive;
    double speed = 7.0;
    (void)state;
    for (int i = 0; i < 17; i++) {
        dmb_motor m = by_table();
        if (i == 0) m.table_count = 1;
        if (i == 1) m.table_count = 16;
        if (i == 2) m.table_speed[2] = m.table_speed[1];
        if (i == 3) m.table_speed[0] = 1.0;
        if (i == 4) m.table_torque[3] = 1.0;
        if (i == 5) m.table_torque[0] = 0.0;
        if (i == 6) m.table_torque[1] = (double)NAN;
        if (i == 7) m.table_speed[1] = (double)INFINITY;
        if (i == 8) m.stall_torque = 800.0;
        if (i == 9) m.displacement = 0.01;
        if (i == 10) m.pressure = 1e6;
        if (i == 11) m.table_flow = -1.0;
        if (i == 12) m.table_pressure = (double)NAN;
        if (i == 13) m.efficiency = 0.0;
        if (i == 14) m.efficiency = 1.5;
        if (i == 15) m.table_torque[1] = -1.0;
        if (i == 16) m.flow = 0.0;
        assert_true(dmb_motor_drive(&m, &drive, &speed) < 0);
    }
    dmb_motor both = dmb_motor_default();
    both.flow = flow, both.displacement = displacement, both.stall_torque = stall, both.pressure = 1e6;
    assert_int_equal(dmb_motor_drive(&both, &drive, &speed), DMB_ERR_VALUE);
    const dmb_motor good = by_table();
    drive.struct_size = before.struct_size = 72; /* of a program that knows no tables */
    assert_int_equal(dmb_motor_drive(&good, &drive, &speed), DMB_ERR_STRUCT_SIZE);
    assert_memory_equal(&drive, &before, sizeof drive);
    assert_true(fabs(speed - 7.0) < 1e-15);
}

static void nonsense_gain_tables_are_refused(void **state)
{
    const char *told[] = {"gain_count", "gain_count",       "gain_error[1]", "gain_force[1]", "gain = 1",
                          "kind = 1",   "DMB_TARGET_GAIN:", "gain_error[1]", "gain_error[2]"};
    (void)state;
    for (int i = 0; i < 9; i++) {
        rig s;
        dmb_drive_def drive = dmb_drive_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        drive.part = section(&s, 0.0, DMB_FREE_RX);
        drive.time_function = add_constant(&s, 1.0);
        drive.kind = i == 5 ? DMB_DRIVE_LOAD : DMB_DRIVE_CONTROL;
        drive.component = DMB_RX;
        drive.gain = i == 4 ? 1.0 : 0.0;
        drive.gain_count = i == 0 ? 1 : i == 1 ? 17 : 3;
        drive.gain_error[1] = i == 2 ? (double)NAN : i == 7 ? 1e300 : 1.0;
        drive.gain_error[2] = i == 8 ? 1.0 : 2.0;
        drive.gain_force[1] = i == 3 ? (double)INFINITY : 1.0;
        dmb_id id;
        int32_t status = dmb_model_add_drive(s.model, &drive, &id);
        if (i == 6) {
            dmb_input_def input = dmb_input_def_default();
            assert_int_equal(status, DMB_OK);
            input.part = id;
            input.target = DMB_TARGET_GAIN;
            (void)strcpy(input.name, "gain");
            status = dmb_model_add_input(s.model, &input, NULL);
        }
        assert_true(status < 0);
        if (strstr(dmb_model_message(s.model), told[i]) == NULL) fail_msg("%s", dmb_model_message(s.model));
        rig_close(&s);
    }
}

static void nonsense_is_refused(void **state)
{
    const double nonsense[] = {0.0, -1.0, (double)NAN, (double)INFINITY, 1e300};
    dmb_drive_def drive = dmb_drive_def_default(), before = drive;
    double speed = 7.0;
    (void)state;
    for (size_t i = 0; i < sizeof nonsense / sizeof nonsense[0]; i++)
        for (int field = 0; field < 3; field++) {
            dmb_motor motor = dmb_motor_default();
            motor.stall_torque = field == 0 ? nonsense[i] : stall;
            motor.displacement = field == 1 ? nonsense[i] : displacement;
            motor.flow = field == 2 ? nonsense[i] : flow;
            assert_true(dmb_motor_drive(&motor, &drive, &speed) < 0);
        }
    assert_int_equal(dmb_motor_drive(NULL, &drive, &speed), DMB_ERR_NULL);
    assert_memory_equal(&drive, &before, sizeof drive);
    assert_true(fabs(speed - 7.0) < 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bit_turns_faster_than_the_string),
        cmocka_unit_test(it_stalls),
        cmocka_unit_test(beyond_its_speed_it_runs_free_or_brakes),
        cmocka_unit_test(a_table_gives_the_speed),
        cmocka_unit_test(a_table_stalls_and_runs_free),
        cmocka_unit_test(pressure_gives_the_torque),
        cmocka_unit_test(another_flow_while_it_runs),
        cmocka_unit_test(run_up_is_made_of_exponentials),
        cmocka_unit_test(linearised_it_is_a_line),
        cmocka_unit_test(a_flat_piece_answers_to_nothing),
        cmocka_unit_test(sensitivity_is_that_of_the_closed_form),
        cmocka_unit_test(nonsense_tables_are_refused),
        cmocka_unit_test(nonsense_gain_tables_are_refused),
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
