/* The state of a sim as arrays, and places as functions of rows. */
#include <string.h>

#include "analysis/linear/functional.h"
#include "base/handle.h"
#include "drillmbd/state_space.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "query/joint_query.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/cluster.h"
#include "system/copy.h"

/* Equations that act, in the order of the Jacobian: constraints stand in the order of their rows. */
static uint64_t put_multipliers(const dmb_sim *sim, double *values)
{
    const dmb_scene *scene = sim->scene;
    uint64_t used = 0;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const uint32_t active = dmb_constraint_active(sim, i);
        for (uint32_t k = 0; k < active && values != NULL; k++)
            values[used + k] = sim->now.multiplier[scene->constraints[i].row + k];
        used += active;
    }
    return used;
}

static void put_positions(const dmb_sim *sim, double *values)
{
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        double R[9], u[3];
        dmb_node_pose(sim->scene, &sim->now, i, R, u);
        dmb_vec3_add(u, sim->scene->reference_position + 3 * (size_t)i, values + 3 * (size_t)i);
    }
}

static void put_quaternions(const dmb_sim *sim, double *values)
{
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        double R[9], u[3];
        dmb_node_pose(sim->scene, &sim->now, i, R, u);
        dmb_quat_from_matrix(R, values + 4 * (size_t)i);
    }
}

/* Forces of constraint are given and 0. */
static int32_t put_residual(dmb_sim *sim, double *values)
{
    dmb_sim *copy = dmb_state_copy(sim);
    dmb_evaluation evaluation;
    if (copy == NULL) return DMB_ERR_NO_MEMORY;
    memset(&evaluation, 0, sizeof evaluation);
    dmb_clusters_clear_multipliers(copy);
    evaluation.sim = copy;
    evaluation.time = copy->clock->time;
    evaluation.pseudo_factor = 1.0;
    evaluation.load_factor = 1.0;
    evaluation.dynamic = evaluation.given = 1;
    const int32_t status = dmb_system_evaluate(&evaluation);
    if (status >= 0) memcpy(values, copy->residual, sim->scene->row_count * sizeof(double));
    dmb_state_discard(copy);
    return status;
}

static uint64_t length_of(const dmb_sim *sim, int32_t array)
{
    if (array == DMB_ARRAY_POSITION) return 3 * (uint64_t)sim->scene->node_count;
    if (array == DMB_ARRAY_QUATERNION) return 4 * (uint64_t)sim->scene->node_count;
    return array == DMB_ARRAY_MULTIPLIER ? put_multipliers(sim, NULL) : sim->scene->row_count;
}

static int32_t put_array(dmb_sim *sim, int32_t array, double *values)
{
    const size_t bytes = sim->scene->row_count * sizeof(double);
    if (array == DMB_ARRAY_VELOCITY) memcpy(values, sim->now.velocity, bytes);
    if (array == DMB_ARRAY_ACCELERATION) memcpy(values, sim->now.acceleration, bytes);
    if (array == DMB_ARRAY_POSITION) put_positions(sim, values);
    if (array == DMB_ARRAY_QUATERNION) put_quaternions(sim, values);
    if (array == DMB_ARRAY_MULTIPLIER) (void)put_multipliers(sim, values);
    return array == DMB_ARRAY_RESIDUAL ? put_residual(sim, values) : DMB_OK;
}

static int32_t answer_array(dmb_sim *sim, int32_t array, double *values, uint64_t *count)
{
    if (array < DMB_ARRAY_VELOCITY || array > DMB_ARRAY_RESIDUAL) {
        dmb_message_set(&sim->message, "array = %d, must be DMB_ARRAY_VELOCITY .. _RESIDUAL", (int)array);
        return DMB_ERR_VALUE;
    }
    const uint64_t length = length_of(sim, array);
    if (values != NULL && *count < length) {
        dmb_message_set(&sim->message, "array: *count = %llu, must be >= %llu, the length that NULL tells",
                        (unsigned long long)*count, (unsigned long long)length);
        return DMB_ERR_VALUE;
    }
    int32_t status = DMB_OK;
    if (values != NULL && array == DMB_ARRAY_RESIDUAL) status = dmb_state_copy_check(sim, "array");
    if (values != NULL && status >= 0) status = put_array(sim, array, values);
    if (status >= 0) *count = length;
    return status < 0 ? status : DMB_OK;
}

int32_t dmb_analysis_array(dmb_sim *sim, int32_t array, double *values, uint64_t *count)
{
    if (sim == NULL || count == NULL) return DMB_ERR_NULL;
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, answer_array(sim, array, values, count));
}

/* ---- Places ------------------------------------------------------------------------------------------------------ */

static int32_t refuse_place(dmb_sim *sim, dmb_place place, int32_t status)
{
    dmb_message_set(&sim->message, "place, pipe %u at %g: %s; name a place on a string, body or bit", place.pipe,
                    place.fraction, dmb_status_text(status));
    return status;
}

/* Displacement of the place as a linear function of the rows' motion. */
static int32_t motion_of_place(dmb_sim *sim, dmb_place place, int32_t frame, int32_t component, dmb_functional *f)
{
    if (component < DMB_X || component > DMB_RZ || frame < DMB_FRAME_WORLD || frame > DMB_FRAME_BODY) {
        dmb_message_set(&sim->message, "place: component = %d, must be 0 .. 5, frame = %d, must be 0 .. 1",
                        (int)component, (int)frame);
        return DMB_ERR_VALUE;
    }
    dmb_sim *copy = dmb_state_copy(sim);
    if (copy == NULL) return DMB_ERR_NO_MEMORY;
    copy->magic = DMB_HANDLE_SIM; /* so that it answers queries */
    const int32_t status = dmb_functional_of_motion(copy, place, frame, component, f);
    dmb_state_discard(copy);
    return status < 0 ? refuse_place(sim, place, status) : DMB_OK;
}

int32_t dmb_analysis_place_rows(dmb_sim *sim, dmb_place place, int32_t frame, int32_t component, uint32_t rows[24],
                                double values[24], uint32_t *count)
{
    if (sim == NULL || rows == NULL || values == NULL || count == NULL) return DMB_ERR_NULL;
    int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    status = dmb_state_copy_check(sim, "place");
    dmb_functional f;
    if (status >= 0) status = motion_of_place(sim, place, frame, component, &f);
    if (status >= 0) {
        *count = f.count;
        memcpy(rows, f.row, f.count * sizeof *rows);
        memcpy(values, f.pose, f.count * sizeof *values);
    }
    return dmb_sim_leave(sim, status);
}
