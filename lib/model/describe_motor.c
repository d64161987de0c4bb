/* A mud motor as a drive of a joint. */
#include <string.h>

#include "base/failure.h"
#include "base/value_check.h"
#include "drillmbd/scene.h"
#include "force/actuator_law.h"
#include "math/so3.h"
#include "model/describe.h"
#include "model/field_check.h"

DMB_DECLARE_STRUCT(dmb_motor)
DMB_DEFINE_INIT(dmb_motor, 32, {.efficiency = 1.0})

/* ---- Checks ------------------------------------------------------------------------------------------------------ */

enum { ROOM = 15 };

/* The drive's table has one point more, where it brakes. */
_Static_assert((int)ROOM < (int)DMB_GAIN_POINTS, "the table of a motor is longer than that of a drive");

static void check_line(dmb_check *check, const dmb_motor *motor)
{
    dmb_check_within(check, "displacement", motor->displacement, DMB_DEPTH_MIN, DMB_LENGTH_MAX);
    if (motor->pressure > 0.0) {
        dmb_check_within(check, "pressure", motor->pressure, DMB_DEPTH_MIN, DMB_FORCE_MAX);
        dmb_check_within(check, "stall_torque", motor->stall_torque, 0.0, 0.0);
    } else {
        dmb_check_within(check, "pressure", motor->pressure, 0.0, 0.0);
        dmb_check_within(check, "stall_torque", motor->stall_torque, DMB_DEPTH_MIN, DMB_FORCE_MAX);
    }
    dmb_check_within(check, "table_flow", motor->table_flow, 0.0, 0.0);
    dmb_check_within(check, "table_pressure", motor->table_pressure, 0.0, 0.0);
}

/* A pressure requires that of the table, because torques are in proportion to it: without it the torques of the table
 * would pass for those at any pressure. */
static void check_table(dmb_check *check, const dmb_motor *motor)
{
    const uint32_t n = motor->table_count;
    dmb_check_count(check, "table_count", n, 2, ROOM);
    if (check->status < 0) return;
    dmb_check_within(check, "stall_torque", motor->stall_torque, 0.0, 0.0);
    dmb_check_within(check, "displacement", motor->displacement, 0.0, 0.0);
    dmb_check_zero_or_within(check, "table_flow", motor->table_flow, DMB_DEPTH_MIN, DMB_LENGTH_MAX);
    dmb_check_zero_or_within(check, "pressure", motor->pressure, DMB_DEPTH_MIN, DMB_FORCE_MAX);
    dmb_check_zero_or_within(check, "table_pressure", motor->table_pressure, DMB_DEPTH_MIN, DMB_FORCE_MAX);
    if (check->status >= 0 && motor->pressure > 0.0 && !(motor->table_pressure > 0.0))
        dmb_check_fail(check, DMB_ERR_VALUE, "table_pressure", 0.0, "> 0 with a pressure and a table");
    dmb_check_each_within(check, "table_speed", motor->table_speed, n, 0.0, DMB_SPEED_MAX);
    dmb_check_each_within(check, "table_torque", motor->table_torque, n, 0.0, DMB_FORCE_MAX);
    dmb_check_increasing(check, "table_speed", motor->table_speed, n, 1);
    dmb_check_within(check, "table_speed", motor->table_speed[0], 0.0, 0.0);
    dmb_check_within(check, "table_torque", motor->table_torque[0], DMB_DEPTH_MIN, DMB_FORCE_MAX);
    dmb_check_within(check, "table_torque", motor->table_torque[n - 1], 0.0, 0.0);
}

static int32_t check_motor(const dmb_motor *motor)
{
    dmb_check check = dmb_check_of(NULL, "motor", DMB_NONE);
    dmb_check_choice(&check, "brakes", motor->brakes, 0, 1);
    dmb_check_within(&check, "flow", motor->flow, DMB_DEPTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(&check, "efficiency", motor->efficiency, DMB_NUMBER_MIN, 1.0);
    (motor->table_count > 0 ? check_table : check_line)(&check, motor);
    return check.status;
}

/* ---- The drive --------------------------------------------------------------------------------------------------- */

/* T = k (w0 - w), k = stall_torque/w0, at most stall_torque (eq:drive.motor); T_s = efficiency V dp/(2 pi), since of dp
 * Q, the power of the mud, T w is left and Q = V w/(2 pi). */
static double take_line(const dmb_motor *motor, dmb_drive_def *drive)
{
    const double speed = DMB_TWO_PI * motor->flow / motor->displacement;
    drive->mud_pressure = DMB_TWO_PI / (motor->efficiency * motor->displacement);
    const double by_pressure = motor->efficiency * motor->displacement * motor->pressure / DMB_TWO_PI;
    drive->limit_high = motor->pressure > 0.0 ? by_pressure : motor->stall_torque;
    drive->gain = drive->limit_high / speed;
    return speed;
}

/* Pressure per torque by the drop at stall, `pressure` or else that of the table; without both by the power of the mud
 * without losses, dp Q = T w. */
static double mud_pressure_of(const dmb_motor *motor, double stall_torque, double speed)
{
    const double drop = motor->pressure > 0.0 ? motor->pressure : motor->table_pressure;
    return drop > 0.0 ? drop / stall_torque : speed / motor->flow;
}

/* G(w0 - w) = T(w): points in reverse. It brakes along its last line, to where that has the torque at stall. */
static double read_table(const dmb_motor *motor, dmb_drive_def *drive)
{
    const uint32_t n = motor->table_count, more = motor->brakes ? 1 : 0;
    const double fast = motor->table_flow > 0.0 ? motor->flow / motor->table_flow : 1.0;
    const double strong = motor->pressure > 0.0 ? motor->pressure / motor->table_pressure : 1.0;
    const double speed = fast * motor->table_speed[n - 1];
    drive->gain_count = n + more;
    for (uint32_t i = 0; i < n; ++i) {
        drive->gain_error[more + i] = speed - fast * motor->table_speed[n - 1 - i];
        drive->gain_force[more + i] = strong * motor->table_torque[n - 1 - i];
    }
    const double *e = drive->gain_error + more, *T = drive->gain_force + more;
    if (more && T[1] > 0.0) {
        drive->gain_force[0] = -T[n - 1];
        drive->gain_error[0] = -T[n - 1] * e[1] / T[1];
    } else if (more) { /* no torque at the end of the table has no line to brake along */
        drive->gain_force[0] = 0.0;
        drive->gain_error[0] = -speed;
    }
    drive->gain = 0.0;
    drive->limit_high = DMB_FORCE_MAX;
    drive->mud_pressure = mud_pressure_of(motor, strong * motor->table_torque[0], speed);
    return speed;
}

int32_t dmb_motor_drive(const dmb_motor *motor, dmb_drive_def *drive, double *no_load_speed)
{
    dmb_motor read = dmb_motor_default();
    dmb_drive_def made = dmb_drive_def_default();
    if (motor == NULL || drive == NULL || no_load_speed == NULL) return dmb_failed("motor", DMB_ERR_NULL);
    int32_t status = dmb_motor_read(&read, motor);
    if (status >= 0) status = check_motor(&read);
    if (status >= 0) status = dmb_drive_def_read(&made, drive);
    if (status >= 0 && read.table_count > 0 && drive->struct_size < sizeof made) status = DMB_ERR_STRUCT_SIZE;
    if (status < 0) return dmb_failed("motor", status);
    made.kind = DMB_DRIVE_CONTROL;
    made.component = DMB_RX;
    made.integral_gain = 0.0;
    made.gain_count = 0;
    made.limit_low = -DMB_FORCE_MAX;
    const double speed = (read.table_count > 0 ? read_table : take_line)(&read, &made);
    if (!read.brakes && read.table_count == 0) made.limit_low = 0.0;
    status = dmb_drive_def_write(drive, &made);
    if (status >= 0) *no_load_speed = speed;
    return dmb_failed("motor", status);
}
