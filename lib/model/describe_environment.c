/* Gravity, fluid and external damping. */
#include "model/defaults.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/limits.h"

static int32_t check_environment(dmb_model *model, const dmb_environment_def *def)
{
    dmb_check check = dmb_check_of(&model->message, "environment", DMB_NO_INDEX);
    dmb_check_each_within(&check, "gravity", def->gravity, 3, -DMB_ACCELERATION_MAX, DMB_ACCELERATION_MAX);
    dmb_check_within(&check, "fluid_density", def->fluid_density, 0.0, DMB_DENSITY_MAX);
    dmb_check_within(&check, "lateral_damping", def->lateral_damping, 0.0, DMB_DAMPING_MAX);
    dmb_check_within(&check, "axial_damping", def->axial_damping, 0.0, DMB_DAMPING_MAX);
    dmb_check_within(&check, "torsional_damping", def->torsional_damping, 0.0, DMB_DAMPING_MAX);
    return check.status;
}

int32_t dmb_model_set_environment(dmb_model *model, const dmb_environment_def *def)
{
    dmb_environment_def read;
    int32_t status = dmb_describe_open(model, "environment", def);
    if (status < 0) return status;
    status = dmb_environment_def_read(&read, def);
    if (status >= 0) status = check_environment(model, &read);
    if (status >= 0) model->environment = read;
    return dmb_describe_end(model, "environment", NULL, 0, status);
}
