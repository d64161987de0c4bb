/* A mud motor between two sections of a string: speed of the bit, stall and reactions against the closed forms of its
 * torque-speed line, its power against the ledger of energies, and its run-up against an exponential. */
#include <string.h>

#include "drillmbd/bha.h"
#include "mechanism.h"

static const double stall = 800.0, displacement = 0.02, flow = 0.03, head_speed = 4.0;

typedef struct motor_rig {
    rig s;
    dmb_id above, below, joint, motor, head;
    double free_speed; /* [rad/s] w0 */
} motor_rig;

static dmb_id section(rig *s, double position, int32_t start_free)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.follows_hole = 0;
    string.position[0] = position;
    string.start_free = start_free;
    pipe.length = 2.0;
    pipe.damping_time = 5e-3;
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
    assert_int_equal(dmb_motor_drive(&motor, &drive, &r.free_speed), DMB_OK);
    drive.programme = add_constant(&r.s, r.free_speed);
    must_model(&r.s, dmb_model_add_drive(r.s.model, &drive, &r.motor));
    turn.part = r.above;
    turn.component = DMB_RX;
    turn.programme = add_constant(&r.s, held ? 0.0 : head_speed);
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
    const dmb_channel channel = {.place = place, .quantity = quantity};
    double value = 0.0;
    must(&r->s, dmb_query_channel(r->s.sim, &channel, &value));
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
    check_relative("speed of the bit, string + motor [rad/s]", value_of(&r, DMB_CHANNEL_SPIN, bit_of(&r)),
                   head_speed + w, 1e-7);
    check_relative("torque of the motor [N m]", value_of(&r, DMB_CHANNEL_DRIVE_FORCE, dmb_station(r.motor, 0, 0.0)), T,
                   1e-7);
    check_relative("torque at the rig, that of the motor and of the mud [N m]",
                   value_of(&r, DMB_CHANNEL_DRIVE_FORCE, dmb_station(r.head, 0, 0.0)), T + resistance * head_speed,
                   1e-7);
    check_relative("power of the motor, T w [W]", value_of(&r, DMB_CHANNEL_DRIVE_POWER, dmb_station(r.motor, 0, 0.0)),
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
    check_relative("torque at stall [N m]", value_of(&r, DMB_CHANNEL_DRIVE_FORCE, dmb_station(r.motor, 0, 0.0)), stall,
                   1e-6);
    check_below("speed at stall [rad/s]", value_of(&r, DMB_CHANNEL_JOINT_SPEED + 3, dmb_station(r.joint, 0, 0.0)),
                1e-5);
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
    check_relative("speed of one that runs free [rad/s]", value_of(&runs, DMB_CHANNEL_SPIN, bit_of(&runs)), 50.0, 1e-5);
    check_below("its torque [N m]", value_of(&runs, DMB_CHANNEL_DRIVE_FORCE, dmb_station(runs.motor, 0, 0.0)), 1e-12);
    check_relative("speed of one that brakes [rad/s]", value_of(&brakes, DMB_CHANNEL_SPIN, bit_of(&brakes)),
                   head_speed + w, 1e-7);
    rig_close(&runs.s);
    rig_close(&brakes.s);
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
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
