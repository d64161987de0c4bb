/* Strings without their pipes. */
#include "drillmbd/scene.h"
#include "math/quadrature.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/model.h"
#include "model/section.h"

static int32_t check_string(dmb_model *model, const dmb_string_def *def)
{
    dmb_message part;
    dmb_check check = dmb_check_of(
        &model->message, dmb_part_text(&part, "string", model->strings.count, def->name, sizeof def->name), DMB_NONE);
    dmb_check_part_name(&check, model, DMB_PART_STRING, def->name);
    dmb_check_choice(&check, "follows_hole", def->follows_hole, 0, 1);
    dmb_check_within(&check, "start_depth", def->start_depth, -DMB_POSITION_MAX, DMB_POSITION_MAX);
    dmb_check_each_within(&check, "offset", def->offset, 2, -DMB_LENGTH_MAX, DMB_LENGTH_MAX);
    dmb_check_each_within(&check, "position", def->position, 3, -DMB_POSITION_MAX, DMB_POSITION_MAX);
    dmb_check_each_within(&check, "rotation", def->rotation, 3, -DMB_ANGLE_MAX, DMB_ANGLE_MAX);
    dmb_check_each_within(&check, "velocity", def->velocity, 6, -DMB_SPEED_MAX, DMB_SPEED_MAX);
    dmb_check_motion_mask(&check, "start_free", def->start_free);
    dmb_check_motion_mask(&check, "end_free", def->end_free);
    return check.status;
}

int32_t dmb_model_add_string(dmb_model *model, const dmb_string_def *def, dmb_id *string)
{
    dmb_string_plan plan = {dmb_string_def_default(), 0, 0};
    int32_t status = dmb_describe_open(model, "string", def);
    if (status < 0) return status;
    status = dmb_string_def_read(&plan.def, def);
    if (status >= 0) status = check_string(model, &plan.def);
    if (status >= 0) {
        status = dmb_describe_append(model, &model->strings, &plan, sizeof plan, DMB_PART_STRING, string);
    }
    return dmb_describe_end(model, "string", &plan.def, sizeof plan.def, status);
}

/* Pipes, appended to a string run by run. */

enum { COUNT_MAX = 1 << 20 };

static void check_tube(dmb_check *check, const dmb_pipe_def *def)
{
    dmb_check_within(check, "length", def->length, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(check, "inner_diameter", def->inner_diameter, 0.0, DMB_LENGTH_MAX);
    dmb_check_above_field(check, "outer_diameter", def->outer_diameter, "inner_diameter", def->inner_diameter);
    dmb_check_within(check, "outer_diameter", def->outer_diameter, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
}

static void check_material(dmb_check *check, const dmb_pipe_def *def)
{
    dmb_check_within(check, "young_modulus", def->young_modulus, DMB_MODULUS_MIN, DMB_MODULUS_MAX);
    dmb_check_between(check, "poisson_ratio", def->poisson_ratio, -1.0, 0.5);
    dmb_check_within(check, "density", def->density, DMB_DENSITY_MIN, DMB_DENSITY_MAX);
    dmb_check_within(check, "shear_factor", def->shear_factor, DMB_NUMBER_MIN, DMB_NUMBER_MAX);
    dmb_check_within(check, "damping_time", def->damping_time, 0.0, DMB_TIME_MAX);
    dmb_check_each_zero_or_within(check, "yield_strength", &def->yield_strength, 1, DMB_MODULUS_MIN, DMB_MODULUS_MAX);
}

static void check_section(dmb_check *check, const dmb_pipe_def *def)
{
    dmb_check_each_zero_or_within(check, "section_stiffness", def->section_stiffness, 6, DMB_STIFFNESS_MIN,
                                  DMB_STIFFNESS_MAX);
    dmb_check_zero_or_within(check, "section_mass", def->section_mass, DMB_MASS_MIN, DMB_MASS_MAX);
    dmb_check_each_zero_or_within(check, "section_inertia", def->section_inertia, 2, DMB_INERTIA_MIN, DMB_INERTIA_MAX);
}

/* The pipe's own diameter stands in for one that is 0. */
static void check_joint(dmb_check *check, const dmb_pipe_def *def)
{
    const double outer = def->joint_outer_diameter > 0.0 ? def->joint_outer_diameter : def->outer_diameter;
    const double inner = def->joint_inner_diameter > 0.0 ? def->joint_inner_diameter : def->inner_diameter;
    dmb_check_within(check, "joint_length", def->joint_length, 0.0, DMB_LENGTH_MAX);
    dmb_check_zero_or_within(check, "joint_inner_diameter", def->joint_inner_diameter, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    dmb_check_zero_or_within(check, "joint_outer_diameter", def->joint_outer_diameter, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    dmb_check_zero_or_within(check, "joint_mass", def->joint_mass, DMB_MASS_MIN, DMB_MASS_MAX);
    dmb_check_each_zero_or_within(check, "joint_inertia", def->joint_inertia, 2, DMB_INERTIA_MIN, DMB_INERTIA_MAX);
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

static void check_eccentricity(dmb_check *check, const dmb_pipe_def *def)
{
    dmb_check_within(check, "eccentricity", def->eccentricity, 0.0, DMB_LENGTH_MAX);
    dmb_check_within(check, "eccentricity_angle", def->eccentricity_angle, -DMB_ANGLE_MAX, DMB_ANGLE_MAX);
    dmb_check_within(check, "eccentricity_spread", def->eccentricity_spread, 0.0, DMB_LENGTH_MAX);
    dmb_check_within(check, "angle_spread", def->angle_spread, 0.0, DMB_ANGLE_MAX);
}

/* Half a turn of one element is where its deformation stops being unique. */
static void check_curvature(dmb_check *check, const dmb_pipe_def *def)
{
    const double *k = def->curvature;
    dmb_check_each_within(check, "curvature", k, 3, -DMB_CURVATURE_MAX, DMB_CURVATURE_MAX);
    if (check->status < 0) return;
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
    dmb_check_pipes_name(&check, model, def->name);
    dmb_check_count(&check, "count", count, 1, COUNT_MAX);
    dmb_check_choice(&check, "kind", def->kind, DMB_PIPE_FLEXIBLE, DMB_PIPE_RIGID);
    dmb_check_count(&check, "elements", def->elements, 1, DMB_PIPE_ELEMENTS_MAX);
    if (def->contact_points != 0)
        dmb_check_count(&check, "contact_points (0, or)", def->contact_points, 3, DMB_LOBATTO_MOST);
    check_tube(&check, def);
    check_material(&check, def);
    check_section(&check, def);
    check_joint(&check, def);
    check_rigid_parts(&check, def);
    check_eccentricity(&check, def);
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

/* Rings on strings, as the caller gives them. */

/* ---- Rings ------------------------------------------------------------------------------------------------------- */

DMB_DEFINE_INIT(dmb_stabiliser_def, 96,
                {.fraction = 0.5, .outer_diameter = 0.09, .length = 0.3, .density = 7850.0, .added_mass = {0.0, -1.0}})

/* One of the two inertias may be that of the cylinder, whose inner diameter is known when the string is: it is judged
 * with none, where its share about the axis is least. */
static void check_mass(dmb_check *check, const dmb_stabiliser_def *def)
{
    dmb_rigid_part part;
    dmb_check_zero_or_within(check, "mass", def->mass, DMB_MASS_MIN, DMB_MASS_MAX);
    dmb_check_each_zero_or_within(check, "inertia", def->inertia, 2, DMB_INERTIA_MIN, DMB_INERTIA_MAX);
    dmb_check_within(check, "density", def->density, DMB_DENSITY_MIN, DMB_DENSITY_MAX);
    if (check->status < 0) return;
    dmb_ring_body_of(def, 0.0, &part);
    dmb_check_inertia_of_revolution(check, "inertia", part.inertia);
}

static int32_t check_ring(dmb_model *model, const dmb_stabiliser_def *def)
{
    dmb_message part;
    dmb_check check = dmb_check_of(
        &model->message, dmb_part_text(&part, "stabiliser", model->rings.count, def->name, sizeof def->name), DMB_NONE);
    dmb_check_part_name(&check, model, DMB_PART_STABILISER, def->name);
    dmb_check_id_or_none(&check, model, "string", def->string, DMB_PART_STRING, "string");
    dmb_check_within(&check, "fraction", def->fraction, 0.0, 1.0);
    dmb_check_within(&check, "outer_diameter", def->outer_diameter, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    dmb_check_within(&check, "length", def->length, DMB_LENGTH_MIN, DMB_LENGTH_MAX);
    check_mass(&check, def);
    dmb_check_within(&check, "added_mass along", def->added_mass[0], 0.0, DMB_MASS_MAX);
    if (def->added_mass[1] != -1.0)
        dmb_check_within(&check, "added_mass across", def->added_mass[1], 0.0, DMB_MASS_MAX);
    return check.status;
}

int32_t dmb_model_add_stabiliser(dmb_model *model, const dmb_stabiliser_def *def, dmb_id *ring)
{
    dmb_stabiliser_def read = dmb_stabiliser_def_default();
    int32_t status = dmb_describe_open(model, "stabiliser", def);
    if (status < 0) return status;
    status = dmb_stabiliser_def_read(&read, def);
    if (status >= 0) status = check_ring(model, &read);
    if (status >= 0) status = dmb_describe_append(model, &model->rings, &read, sizeof read, DMB_PART_STABILISER, ring);
    return dmb_describe_end(model, "stabiliser", &read, sizeof read, status);
}
