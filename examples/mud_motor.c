/* A bit behind a mud motor, which adds its speed to the string's and gives way as the torque on the bit grows. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"
static dmb_model *model;

static dmb_id add_section(double position, int32_t start_free)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    string.follows_hole = 0;
    string.position[0] = position;
    string.start_free = start_free;
    (void)dmb_model_add_string(model, &string, &rod.string);
    (void)dmb_model_add_pipes(model, &rod, 2, NULL);
    return rod.string;
}

static dmb_id add_constant(double value)
{
    dmb_segment constant = dmb_segment_default();
    dmb_id time_function;
    constant.h0 = value;
    return dmb_model_add_time_function(model, &constant, 1, &time_function) < 0 ? (dmb_id){0, 0} : time_function;
}

static dmb_id describe(void)
{
    const double times[] = {1.0, 11.0}, torques[] = {0.0, -1000.0};
    const double speeds[] = {0.0, 3.0, 5.5, 6.3}, sheet[] = {900.0, 820.0, 450.0, 0.0}; /* [rad/s], [N m] */
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_motor motor = dmb_motor_default();
    dmb_drive_def turn = dmb_drive_def_default(), drive = dmb_drive_def_default();
    dmb_load_def rock = dmb_load_def_default();
    dmb_segment ramp = {.struct_size = sizeof ramp, .kind = DMB_SEGMENT_TABLE, .table_time = times, .table_count = 2};
    double no_load_speed = 0.0;
    dmb_id id;
    mud.gravity[2] = 0.0;
    mud.lateral_damping = 100.0;
    mud.torsional_damping = 0.5;
    (void)dmb_model_set_environment(model, &mud);
    turn.part = add_section(0.0, DMB_FREE_RX);
    turn.component = DMB_RX, turn.time_function = add_constant(2.0);
    (void)dmb_model_add_drive(model, &turn, NULL);
    joint.kind = DMB_JOINT_REVOLUTE;
    joint.place_a = dmb_station(turn.part, 1, 1.0);
    joint.place_b = dmb_station(add_section(2.0, DMB_FREE_ALL), 0, 0.0);
    (void)dmb_model_add_joint(model, &joint, &drive.part);
    motor.table_flow = 0.012, motor.flow = 0.015; /* [m3/s] of its data sheet, and here */
    motor.table_count = 4;
    for (int i = 0; i < 4; i++) motor.table_speed[i] = speeds[i], motor.table_torque[i] = sheet[i];
    (void)dmb_motor_drive(&motor, &drive, &no_load_speed);
    drive.time_function = add_constant(no_load_speed);
    (void)dmb_model_add_drive(model, &drive, &id);
    ramp.table_value = torques;
    rock.place = dmb_station(joint.place_b.part, 1, 1.0);
    rock.moment[0] = 1.0;
    (void)dmb_model_add_time_function(model, &ramp, 1, &rock.time_function);
    (void)dmb_model_add_load(model, &rock, NULL);
    return id;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words,
                            "A bit behind a mud motor, which adds its speed to the string's and gives way as the "
                            "torque on the bit grows.",
                            NULL, 0);
    dmb_sim *sim = NULL;
    dmb_drive_state at = dmb_drive_state_default();
    if (dmb_model_create(NULL, &model) < 0) return 1;
    const dmb_id motor = describe();
    int32_t status = dmb_model_compile(model, NULL); /* fails with what was refused before, too */
    if (status >= 0) status = dmb_sim_create(model, NULL, &sim);
    for (double time = 1.0; time < 10.0 && status >= 0; time += 2.0) {
        status = dmb_sim_advance(sim, time, NULL);
        if (status >= 0) status = dmb_query_drive(sim, motor, &at);
        printf("%5.1f N m: motor %5.2f rad/s, bit %5.2f rad/s, %5.0f W\n", at.force, at.speed, 2.0 + at.speed,
               at.power);
    }
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status < 0;
}
