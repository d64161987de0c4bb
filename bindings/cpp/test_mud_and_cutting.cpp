// Fields by which mud goes along with bodies, bits and rings, motors take pressure, and cutters widen the hole, from
// C++ against closed forms and against the C interface.
#include "drillmbd.hpp"
#include "expect.h"

#include <cmath>
#include <iostream>
#include <string>

namespace {

const double pi = 3.14159265358979323846;

bool near(double found, double wanted)
{
    if (std::fabs(found - wanted) <= 1e-9 * std::fabs(wanted)) return true;
    std::cerr << found << ", not " << wanted << '\n';
    return false;
}

dmb_segment constant(double value)
{
    dmb_segment term = dmb_segment_default();
    term.h0 = value;
    return term;
}

dmb_environment_def mud()
{
    dmb_environment_def environment = dmb_environment_def_default();
    environment.gravity[2] = 0.0;
    environment.fluid_density = 1200.0;
    return environment;
}

// Half of the mass and of the mud that goes along, times the speed squared: a rigid string with a ring and a bit, and a
// body that is pushed.
void mud_goes_along(int axis)
{
    drillmbd::model model;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_load_def load = dmb_load_def_default();
    model.set_environment(mud());
    string.start_free = DMB_FREE_ALL;
    string.velocity[axis] = 2.0;
    model.add_string(string);
    pipe.kind = DMB_PIPE_RIGID;
    model.add_pipes(pipe, 1);
    ring.mass = 6.0;
    ring.outer_diameter = 0.1;
    ring.added_mass[0] = 1.0;
    ring.added_mass[1] = 4.0;
    model.add_stabiliser(ring);
    bit.mass = 20.0;
    bit.added_mass[0] = 0.5;
    bit.added_mass[1] = 8.0;
    model.add_bit(bit);
    body.mass = 10.0;
    body.position[1] = 3.0;
    body.added_mass[0] = 2.0;
    body.added_mass[1] = 7.0;
    const auto sphere = model.add_body(body);
    load.place = dmb_station(sphere, 0, 0.0);
    load.force[axis] = 60.0;
    model.add_load(load);
    model.compile();
    drillmbd::sim sim(model);
    const double mass = sim.momentum().mass - body.mass, added = axis == 0 ? 1.5 : 12.0;
    EXPECT(mass > 26.0);
    EXPECT(near(sim.energy().kinetic, 0.5 * (mass + added) * 4.0));
    for (int i = 0; i < 50; ++i) EXPECT(sim.step(0.01) >= 0);
    EXPECT(near(sim.pose(load.place).displacement[axis], 0.125 * 60.0 / (axis == 0 ? 12.0 : 17.0)));
}

// Torque and pressure of a motor at stall, by its line.
void motors_take_pressure()
{
    drillmbd::model model;
    dmb_environment_def environment = mud();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_motor motor = dmb_motor_default();
    dmb_drive_def drive = dmb_drive_def_default();
    environment.consistency = 0.05;
    environment.flow_rate = 0.012;
    model.set_environment(environment);
    model.add_wall(wall);
    pipe.kind = DMB_PIPE_RIGID;
    const auto string = model.add_pipes(pipe, 2);
    body.mass = 50.0;
    body.position[0] = 2.0;
    const auto shaft = model.add_body(body);
    joint.kind = DMB_JOINT_REVOLUTE;
    joint.place_a = dmb_station(string, 1, 1.0);
    joint.place_b = dmb_station(shaft, 0, 0.0);
    drive.part = model.add_joint(joint);
    motor.displacement = 0.02;
    motor.flow = environment.flow_rate;
    motor.pressure = 4e6;
    motor.efficiency = 0.8;
    const double speed = model.set_motor(motor, drive);
    EXPECT(near(drive.mud_pressure, 2.0 * pi / (0.8 * 0.02)));
    EXPECT(near(speed, 2.0 * pi * 0.012 / 0.02));
    drive.time_function = model.add_time_function(constant(speed));
    const auto turning = model.add_drive(drive);
    model.compile();
    drillmbd::sim sim(model);
    EXPECT(near(sim.flow().motor_loss, 4e6));
    EXPECT(sim.step(0.01) >= 0);
    const dmb_flow_state flow = sim.flow();
    EXPECT(flow.motor_loss < 4e6);
    EXPECT(near(flow.motor_loss, drive.mud_pressure * sim.drive(turning).force));
    EXPECT(
        near(flow.pump_pressure, flow.bore_loss + flow.bit_loss + flow.annulus_loss + flow.column + flow.motor_loss));
}

// A bit wider than the hole goes two metres on from two.
void cutters_widen_the_hole()
{
    drillmbd::model model;
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    environment.gravity[2] = 0.0;
    model.set_environment(environment);
    wall.diameter = 0.1;
    wall.friction_law = DMB_FRICTION_NONE;
    wall.cut_spacing = 0.1;
    wall.cut_start = 1.0;
    wall.cut_end = 8.0;
    model.add_wall(wall);
    pipe.kind = DMB_PIPE_RIGID;
    model.add_pipes(pipe, 2);
    bit.diameter = 0.0;
    bit.radius = 0.06;
    bit.rock_law = DMB_ROCK_RATE;
    bit.intrinsic_energy = 1e4;
    bit.contact_strength = 0.0;
    model.add_bit(bit);
    drive.time_function = model.add_time_function(constant(1.0));
    model.add_drive(drive);
    drive.component = DMB_RX;
    drive.time_function = model.add_time_function(constant(10.0));
    model.add_drive(drive);
    model.compile();
    drillmbd::sim sim(model);
    EXPECT(near(sim.hole(2.5).diameter, 0.1));
    for (int i = 0; i < 200; ++i) EXPECT(sim.step(0.01) >= 0);
    for (double depth = 0.25; depth < 9.0; depth += 0.25) {
        dmb_hole_point point = dmb_hole_point_default();
        EXPECT(dmb_query_hole_now(sim.get(), depth, &point) == DMB_OK);
        EXPECT(point.diameter == sim.hole(depth).diameter);
        if (depth < 1.9 || (depth > 2.1 && depth < 3.8) || depth > 4.2)
            EXPECT(near(point.diameter, depth > 2.0 && depth < 4.0 ? 0.12 : 0.1));
        EXPECT(near(model.hole(depth).diameter, 0.1));
    }
    wall.cut_spacing = -0.1;
    drillmbd::model refused;
    try {
        refused.add_wall(wall);
        EXPECT(false);
    } catch (const drillmbd::error &error) {
        EXPECT(error.status() == DMB_ERR_VALUE);
        EXPECT(std::string(error.what()).find("cut_spacing") != std::string::npos);
    }
}

} // namespace

int main()
{
    try {
        for (int axis = 0; axis < 3; ++axis) mud_goes_along(axis);
        motors_take_pressure();
        cutters_widen_the_hole();
    } catch (const std::exception &error) {
        std::cerr << "unexpected: " << error.what() << '\n';
        ++failures;
    }
    if (failures == 0) std::cout << "all as expected\n";
    return failures == 0 ? 0 : 1;
}
