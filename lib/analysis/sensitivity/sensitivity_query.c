/* Queries of rates: outputs, rows, number of breakpoints passed. */
#include <math.h>
#include <string.h>

#include "analysis/sensitivity/sensitivity.h"
#include "base/failure.h"
#include "base/sized_struct.h"
#include "math/so3.h"
#include "query/query.h"

/* The corresponding output in another model of the scene. */
static dmb_output output_in(const dmb_model *model, const dmb_output *output)
{
    dmb_output there = *output;
    if (there.place.part.generation != 0) there.place.part.generation = model->stamp;
    return there;
}

static int32_t output_beside(dmb_sensitivity *s, const dmb_rated_parameter *p, int side, const dmb_output *output,
                             double *value)
{
    const dmb_output there = output_in(p->model[side], output);
    dmb_sensitivity_aside(s, p, side);
    s->worker->magic = DMB_HANDLE_SIM;
    s->worker->options.energy_ledger = s->sim->options.energy_ledger; /* required for energies */
    const int32_t status = dmb_output_value(s->worker, &there, value);
    s->worker->options.energy_ledger = 0;
    s->worker->magic = 0;
    return status;
}

/* Outputs need no companion step: they are functions of the state and the scene, evaluated at y +- step dy/dp. Both
 * sides are used, also for one-sided parameters. */
static int32_t output_rate(dmb_sensitivity *s, const dmb_rated_parameter *p, const dmb_output *output, double *rate)
{
    double value[2] = {0.0, 0.0};
    int32_t status = output_beside(s, p, DMB_SIDE_LOW, output, &value[DMB_SIDE_LOW]);
    if (status >= 0) status = output_beside(s, p, DMB_SIDE_HIGH, output, &value[DMB_SIDE_HIGH]);
    *rate = (value[DMB_SIDE_HIGH] - value[DMB_SIDE_LOW]) / (2.0 * p->step);
    return status;
}

/* 1: a sum over a run or a count, which companion steps do not keep. */
static int is_summed(int32_t quantity)
{
    return quantity == DMB_OUTPUT_ENERGY_ERROR || quantity == DMB_OUTPUT_DRIVE_WORK ||
           (quantity >= DMB_OUTPUT_ENERGY_DRIVES && quantity <= DMB_OUTPUT_ENERGY_UNEXPLAINED) ||
           (quantity >= DMB_OUTPUT_STEPS && quantity <= DMB_OUTPUT_REDUNDANT);
}

static int32_t refuse_output(const dmb_sensitivity *s, uint32_t number, int32_t quantity, int32_t status)
{
    dmb_message_set(&s->sim->message, "sensitivity: output %u: %s", number,
                    is_summed(quantity) ? "sums and counts of a run have no derivative here; leave it out"
                                        : dmb_status_text(status));
    return status;
}

static int32_t check_outputs(const dmb_sensitivity *s, const dmb_output *outputs, uint32_t count)
{
    double value;
    for (uint32_t i = 0; i < count; i++) {
        const int32_t status =
            is_summed(outputs[i].quantity) ? DMB_ERR_UNSUPPORTED : dmb_output_value(s->sim, &outputs[i], &value);
        if (status < 0) return refuse_output(s, i, outputs[i].quantity, status);
    }
    return DMB_OK;
}

/* All outputs are checked before the first is written. The sim keeps its state; only the worker moves. */
int32_t dmb_sensitivity_outputs(dmb_sensitivity *sensitivity, const dmb_output *outputs, uint32_t count, double *values,
                                double *derivatives)
{
    dmb_sensitivity *s = sensitivity;
    int32_t status = dmb_sensitivity_alive(s);
    if (status < 0) return dmb_failed("sensitivity", status);
    if (outputs == NULL || derivatives == NULL) return dmb_failed("sensitivity", DMB_ERR_NULL);
    status = dmb_sensitivity_stands(s);
    if (status >= 0) status = check_outputs(s, outputs, count);
    if (status >= 0) status = dmb_sensitivity_catch_up(s);
    if (status < 0) return dmb_failed("sensitivity", status);
    dmb_sensitivity_stand(s);
    for (uint32_t i = 0; i < count; i++) {
        if (values != NULL) (void)dmb_output_value(s->sim, &outputs[i], &values[i]);
        for (uint32_t k = 0; k < s->count; k++) {
            status = output_rate(s, &s->parameters[k], &outputs[i], &derivatives[(size_t)i * s->count + k]);
            if (status < 0) return dmb_failed("sensitivity", refuse_output(s, i, outputs[i].quantity, status));
        }
    }
    return DMB_OK;
}

/* Rates of a node's displacement [m], in body axes, including that of its described position, and of its body-frame
 * rotation [rad]. */
static void pose_rate(const dmb_sensitivity *s, const dmb_rated_parameter *p, uint32_t node, const double *displacement,
                      const double *quaternion, double out[6])
{
    const double *low = p->model[DMB_SIDE_LOW]->scene->reference_position + 3 * (size_t)node;
    const double *high = p->model[DMB_SIDE_HIGH]->scene->reference_position + 3 * (size_t)node;
    const double *q = s->sim->now.quaternion + 4 * (size_t)node, *dq = quaternion + 4 * (size_t)node;
    double R[9], moved[3];
    for (int i = 0; i < 3; i++)
        moved[i] = displacement[3 * (size_t)node + (size_t)i] + (high[i] - low[i]) / (2.0 * p->step);
    dmb_quat_to_matrix(q, R);
    dmb_mat3_tvec(R, moved, out);
    out[3] = 2.0 * (q[0] * dq[1] - q[1] * dq[0] - q[2] * dq[3] + q[3] * dq[2]); /* 2 q* dq */
    out[4] = 2.0 * (q[0] * dq[2] - q[2] * dq[0] - q[3] * dq[1] + q[1] * dq[3]);
    out[5] = 2.0 * (q[0] * dq[3] - q[3] * dq[0] - q[1] * dq[2] + q[2] * dq[1]);
}

/* Rates of all rows in the order of the layout: six of a node by its displacement and quaternion, two of an
 * axial-torsional one. */
static void write_poses(const dmb_sensitivity *s, const dmb_rated_parameter *p, double *pose)
{
    const dmb_block_layout *layout = &s->sim->scene->layout;
    const double *displacement = dmb_rates_of(s, p, s->sim->now.displacement);
    const double *quaternion = dmb_rates_of(s, p, s->sim->now.quaternion), *turn = dmb_rates_of(s, p, s->sim->now.turn);
    for (uint32_t i = 0; i < s->sim->scene->node_count; i++) {
        if (layout->size[i] == DMB_NODE_SIX_DOF) {
            pose_rate(s, p, i, displacement, quaternion, pose + layout->row[i]);
            continue;
        }
        pose[layout->row[i]] = displacement[3 * (size_t)i];
        pose[layout->row[i] + 1] = turn[i];
    }
}

static int32_t check_parameter(const dmb_sensitivity *s, uint32_t number)
{
    const int32_t status = dmb_sensitivity_alive(s);
    if (status < 0 || number < s->count) return status;
    dmb_message_set(&s->sim->message, "sensitivity: parameter = %u, must be < %u", number, s->count);
    return DMB_ERR_VALUE;
}

int32_t dmb_sensitivity_rows(dmb_sensitivity *sensitivity, uint32_t parameter_number, double *pose, double *velocity,
                             uint32_t *rows)
{
    const dmb_sensitivity *s = sensitivity;
    int32_t status = check_parameter(s, parameter_number);
    if (status < 0) return dmb_failed("sensitivity", status);
    if (rows == NULL) return dmb_failed("sensitivity", DMB_ERR_NULL);
    if (velocity != NULL || pose != NULL) status = dmb_sensitivity_stands(s);
    if (status < 0) return dmb_failed("sensitivity", status);
    const dmb_rated_parameter *p = &s->parameters[parameter_number];
    *rows = s->sim->scene->row_count;
    if (velocity != NULL) memcpy(velocity, dmb_rates_of(s, p, s->sim->now.velocity), *rows * sizeof(double));
    if (pose != NULL) write_poses(s, p, pose);
    return DMB_OK;
}

int32_t dmb_sensitivity_kinks(const dmb_sensitivity *sensitivity, uint32_t parameter_number, uint64_t *kinks)
{
    const int32_t status = check_parameter(sensitivity, parameter_number);
    if (status < 0) return dmb_failed("sensitivity", status);
    if (kinks == NULL) return dmb_failed("sensitivity", DMB_ERR_NULL);
    *kinks = sensitivity->parameters[parameter_number].kinks;
    return DMB_OK;
}

/* ---- The state as numbers ---------------------------------------------------------------------------------------- */

/* The state as one array of numbers, its rates, and the worker on either side of the sim. */
