/* Strings without their pipes. */
#include "drillmbd/scene.h"
#include "math/quadrature.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/model.h"
#include "model/section.h"

int32_t dmb_model_add_string(dmb_model *model, const dmb_string_def *def, dmb_id *string)
{
    dmb_string_plan plan = {dmb_string_def_default(), 0, 0};
    int32_t status = dmb_describe_open(model, "string", def);
    if (status < 0) return status;
    status = dmb_string_def_read(&plan.def, def);
    if (status >= 0) status = dmb_describe_check(model, DMB_FIELDS_OF(dmb_string_def), &plan.def, NULL);
    if (status >= 0) {
        status = dmb_describe_append(model, &model->strings, &plan, sizeof plan, DMB_PART_STRING, string);
    }
    return dmb_describe_end(model, "string", &plan.def, sizeof plan.def, status);
}

/* Pipes, appended to a string run by run. */

enum { COUNT_MAX = 1 << 20 };

/* The pipe's own diameter stands in for one of its joint that is 0. */
static void check_joint(dmb_check *check, const dmb_pipe_def *def)
{
    const double outer = def->joint_outer_diameter > 0.0 ? def->joint_outer_diameter : def->outer_diameter;
    const double inner = def->joint_inner_diameter > 0.0 ? def->joint_inner_diameter : def->inner_diameter;
    if (!(def->joint_length > 0.0)) return;
    dmb_check_above_field(check, "joint_outer_diameter", outer, "joint_inner_diameter", inner);
    if (!(def->length - def->joint_length >= DMB_LENGTH_MIN)) {
        dmb_check_fail(check, DMB_ERR_VALUE, "joint_length", def->joint_length, "< length, by 1e-6 m or more");
    }
}

static void check_rigid_parts(dmb_check *check, const dmb_pipe_def *def)
{
    dmb_rigid_part joint;
    if (check->status < 0) return;
    dmb_joint_of(def, &joint);
    dmb_check_inertia_of_revolution(check, "joint_inertia", joint.inertia);
    if (def->kind == DMB_PIPE_RIGID) dmb_check_rigid_pipe_inertia(check, def);
}

/* Half a turn of one element is where its deformation stops being unique. */
static void check_curvature(dmb_check *check, const dmb_pipe_def *def)
{
    const double *k = def->curvature;
    const double bend =
        sqrt(k[0] * k[0] + k[1] * k[1] + k[2] * k[2]) * (def->length - def->joint_length) / def->elements;
    if (bend <= DMB_REST_ROTATION_MAX) return;
    dmb_check_fail(check, DMB_ERR_VALUE, "curvature times length of an element", bend,
                   "<= 2.5 rad: take more elements");
}

static int32_t check_pipes(dmb_model *model, uint32_t string, const dmb_pipe_def *def, uint32_t count)
{
    dmb_message part;
    dmb_check check = dmb_check_of(&model->message, dmb_pipes_text(&part, string, def), DMB_NONE);
    dmb_check_count(&check, "count", count, 1, COUNT_MAX);
    dmb_check_fields(&check, model, DMB_FIELDS_OF(dmb_pipe_def), def);
    dmb_check_pipes_name(&check, model, def->name);
    dmb_check_above_field(&check, "outer_diameter", def->outer_diameter, "inner_diameter", def->inner_diameter);
    if (check.status < 0) return check.status;
    check_joint(&check, def);
    check_rigid_parts(&check, def);
    check_curvature(&check, def);
    return check.status;
}

/* The string the pipes go to; one past the last where it has to be made. */
static uint32_t string_of(dmb_check *check, const dmb_model *model, dmb_id id)
{
    if (dmb_id_is_none(id)) return 0;
    dmb_check_id(check, model, "string", id, DMB_PART_STRING, "string");
    return dmb_model_part_index(model, id, DMB_PART_STRING);
}

/* Both or nothing: the string, if it has to be made, and the run. */
static int32_t append_run(dmb_model *model, const dmb_pipe_def *def, uint32_t string, uint32_t count)
{
    const uint32_t strings = model->strings.count;
    int32_t status = DMB_OK;
    if (string == strings) {
        const dmb_string_plan made = {dmb_string_def_default(), 0, 0};
        status = dmb_list_append(&model->strings, &model->allocator, &made, sizeof made);
        if (status < 0) return status;
    }
    dmb_string_plan *plan = DMB_LIST_AT(dmb_string_plan, model->strings, string);
    const dmb_pipe_run run = {*def, string, plan->pipes, count, 0};
    if (run.first > (uint32_t)DMB_NODES_MAX - count) status = DMB_ERR_TOO_LARGE;
    if (status >= 0) status = dmb_list_append(&model->runs, &model->allocator, &run, sizeof run);
    if (status >= 0)
        plan->pipes += count;
    else
        model->strings.count = strings;
    return status;
}

int32_t dmb_model_add_pipes(dmb_model *model, const dmb_pipe_def *def, uint32_t count, dmb_id *string)
{
    dmb_pipe_def read = dmb_pipe_def_default();
    const dmb_described given = {"pipes", &read, sizeof read, count};
    uint32_t index = 0;
    int32_t status = dmb_describe_open(model, "pipes", def);
    if (status < 0) return status;
    status = dmb_pipe_def_read(&read, def);
    if (status >= 0) {
        dmb_check check = dmb_check_of(&model->message, "pipes", DMB_NONE);
        index = string_of(&check, model, read.string);
        status = check.status;
    }
    if (status >= 0) status = dmb_string_is_open(model, "pipes", index);
    if (status >= 0) status = check_pipes(model, index, &read, count);
    if (status >= 0) status = append_run(model, &read, index, count);
    if (status >= 0 && string != NULL) *string = dmb_model_id(model, DMB_PART_STRING, index);
    return dmb_describe_part(model, &given, status);
}

/* ---- Stabilisers ------------------------------------------------------------------------------------------------- */

/* One of the two inertias may be that of the cylinder, whose inner diameter is known when the string is: it is judged
 * with none, where its share about the axis is least. */
static void relate_stabiliser(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_stabiliser_def *def = part;
    dmb_rigid_part body;
    (void)model;
    dmb_check_each_within(check, "added_mass", def->added_mass, 1, 0.0, DMB_MASS_MAX);
    dmb_ring_body_of(def, 0.0, &body);
    dmb_check_inertia_of_revolution(check, "inertia", body.inertia);
}

int32_t dmb_model_add_stabiliser(dmb_model *model, const dmb_stabiliser_def *def, dmb_id *stabiliser)
{
    dmb_stabiliser_def read = dmb_stabiliser_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_stabiliser_def), def, &read, relate_stabiliser, stabiliser);
}
