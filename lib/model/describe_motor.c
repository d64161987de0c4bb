/* A mud motor as a drive of a joint. */
#include "base/value_check.h"
#include "drillmbd/bha.h"
#include "math/so3.h"
#include "model/describe.h"
#include "model/field_check.h"

DMB_DECLARE_STRUCT(dmb_motor)
DMB_DEFINE_INIT(dmb_motor, 32, {.stall_torque = 0.0})

static int32_t check_motor(const dmb_motor *motor)
{
    dmb_check check = dmb_check_of(NULL, "motor", DMB_NONE);
    dmb_check_choice(&check, "brakes", motor->brakes, 0, 1);
    dmb_check_within(&check, "stall_torque", motor->stall_torque, DMB_DEPTH_MIN, DMB_FORCE_MAX);
    dmb_check_within(&check, "displacement", motor->displacement, DMB_DEPTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(&check, "flow", motor->flow, DMB_DEPTH_MIN, DMB_LENGTH_MAX);
    return check.status;
}

/* T = k (w0 - w), k = stall_torque/w0, at most stall_torque. */
int32_t dmb_motor_drive(const dmb_motor *motor, dmb_drive_def *drive, double *no_load_speed)
{
    dmb_motor read = dmb_motor_default();
    dmb_drive_def made = dmb_drive_def_default();
    if (motor == NULL || drive == NULL || no_load_speed == NULL) return DMB_ERR_NULL;
    int32_t status = dmb_motor_read(&read, motor);
    if (status >= 0) status = check_motor(&read);
    if (status >= 0) status = dmb_drive_def_read(&made, drive);
    if (status < 0) return status;
    const double speed = DMB_TWO_PI * read.flow / read.displacement;
    made.kind = DMB_DRIVE_CONTROL;
    made.component = DMB_RX;
    made.gain = read.stall_torque / speed;
    made.integral_gain = 0.0;
    made.limit_high = read.stall_torque;
    made.limit_low = read.brakes ? -DMB_FORCE_MAX : 0.0;
    *no_load_speed = speed;
    return dmb_drive_def_write(drive, &made);
}
