/* Relations between the fields of a state: values that are each in their range (run/snapshot.c) may still contradict
 * each other. Required is what later calls rely on: rotations that are orthogonal, times in order, marks that agree
 * with the setting they repeat, constrained rows at rest and at their described place, dependent coordinates that are
 * free.
 *
 * Not compared, because any value is harmless: the next step computes it again and converges or is refused, or it is
 * reported only (tests/fuzz/test_forged_relations.c):
 *
 *     segments, depths          starting points of searches and their results
 *     contacts                  penetration, speeds, bristles, whether they stick. A contact stored as closed and open
 *                               by its pose has no force; the step evaluates all of them from the pose
 *     supports                  of a state that counts as transferred from another model, where they may be anywhere:
 *                               any such state could be the result of a transfer
 *     poses, speeds, offsets    that violate the joints: the step projects them or is refused. Multipliers are solved
 *                               for; of turns, whole revolutions are kept
 *     dependent coordinates     with a singular matrix: the step fails with a message. A choice that leaves equations
 *                               out is replaced, or the equations are found violated
 *     kept factors              of another matrix: a correction by them does not move constrained rows and has to lower
 *                               the true residual, or new factors are computed
 *     rock, loads, drives, actuators, energies, powers, statistics: any finite history is possible */
#include "run/run.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "force/hole.h"
#include "math/mat6.h"
#include "math/so3.h"
#include "sim/own_scene.h"
#include "system/constrain/constrain.h"

#define DMB_REST_ROUNDING 1e-9   /* [-] rounding relative to the largest speed */
#define DMB_RADIUS_ROUNDING 1e-9 /* [-] rounding relative to a radius */
#define DMB_TIME_LEEWAY 1e-5     /* [-] of the time: a breakpoint that a step nearly reached counts as reached */

static int32_t refuse(dmb_sim *sim, const char *field, size_t item, double value, const char *bound)
{
    dmb_message_set(
        &sim->message,
        "snapshot: %s, number %zu = %g, must be %s; these are no state of this model, take another snapshot", field,
        item, value, bound);
    return DMB_ERR_VALUE;
}

/* ---- Rotations and directions ------------------------------------------------------------------------------------ */

static double length_of(const double *a, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += a[i] * a[i];
    return sqrt(sum);
}

static int32_t check_lengths(dmb_sim *sim, const char *field, const double *vectors, size_t count, size_t size)
{
    for (size_t i = 0; i < count; i++) {
        const double length = length_of(vectors + size * i, size);
        if (fabs(length - 1.0) <= DMB_ROTATION_ROUNDING) continue;
        dmb_message_set(&sim->message,
                        "snapshot: %s, numbers from %zu on: length = %g, must be 1; these are no state of this model, "
                        "take another snapshot",
                        field, size * i, length);
        return DMB_ERR_VALUE;
    }
    return DMB_OK;
}

/* [-] Deviation of the rows from a right-handed frame of unit vectors. */
static double rotation_error(const double R[9])
{
    double most = 0.0, cross[3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++) most = fmax(most, fabs(dmb_vec3_dot(R + 3 * i, R + 3 * j) - (i == j ? 1.0 : 0.0)));
    dmb_vec3_cross(R, R + 3, cross);
    return fmax(most, fabs(dmb_vec3_dot(cross, R + 6) - 1.0));
}

/* R and x of a place: the first nine of twelve numbers. */
static int32_t check_rotation(dmb_sim *sim, const char *field, size_t item, const double *pose)
{
    const double error = rotation_error(pose);
    if (error <= DMB_ROTATION_ROUNDING) return DMB_OK;
    dmb_message_set(&sim->message,
                    "snapshot: %s, numbers from %zu on: they are a rotation but for = %g, must be <= %g; these are no "
                    "state of this model, take another snapshot",
                    field, 12 * item, error, DMB_ROTATION_ROUNDING);
    return DMB_ERR_VALUE;
}

static int32_t check_rotations(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    int32_t status = check_lengths(sim, "quaternion", sim->now.quaternion, scene->node_count, 4);
    if (status >= 0) status = check_lengths(sim, "site_normal", sim->now.site_normal, scene->site_count, 3);
    for (uint32_t i = 0; i < scene->stuck_count && status >= 0; i++)
        status = check_rotation(sim, "stuck_anchor", i, sim->stuck_anchor + 12 * (size_t)i);
    for (uint32_t j = 0; j < scene->joint_count && status >= 0; j++)
        status = check_rotation(sim, "joint_lock", j, sim->joint_lock + 12 * (size_t)j);
    return status;
}

/* ---- Rows that are held ------------------------------------------------------------------------------------------ */

static int is_driven(const dmb_scene *scene, uint32_t row)
{
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].kind == DMB_DRIVE_MOTION && scene->drives[i].row == row) return 1;
    return 0;
}

static int32_t check_at_rest(dmb_sim *sim, const char *field, const double *rows)
{
    const dmb_scene *scene = sim->scene;
    double largest = 0.0;
    for (uint32_t i = 0; i < scene->row_count; i++) largest = fmax(largest, fabs(rows[i]));
    for (uint32_t i = 0; i < scene->constrained_count; i++) {
        const uint32_t row = dmb_constrained_row(scene, i);
        if (fabs(rows[row]) <= DMB_REST_ROUNDING * largest || is_driven(scene, row)) continue;
        return refuse(sim, field, row, rows[row], "0, since this row is held");
    }
    return DMB_OK;
}

/* A number fixed by the support of a node, with its described value. */
typedef struct misfit {
    const char *field;
    size_t item;
    double value; /* [m, -] */
} misfit;

static int differs(misfit *found, const char *field, size_t item, double value, double bound)
{
    if (fabs(value) <= bound) return 0;
    *found = (misfit){field, item, value};
    return 1;
}

/* 1: a node violates its support. Free components are closed under motion, so the others are 0 in the axes of the
 * described pose: of the displacement, and of the rotation in all or all but one components. */
static int is_off_support(const dmb_sim *sim, uint32_t node, misfit *found)
{
    const dmb_scene *scene = sim->scene;
    const uint8_t *open = scene->free_row + scene->layout.row[node];
    const double *u = sim->now.displacement + 3 * (size_t)node, *q0 = scene->reference_quaternion + 4 * (size_t)node;
    const double far = DMB_ROTATION_ROUNDING * (scene->length_scale + dmb_vec3_norm(u));
    double moved[3], turned[4];
    if (scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL)
        return (!open[0] && differs(found, "displacement", 3 * (size_t)node, u[0], far)) ||
               (!open[1] && differs(found, "turn", node, sim->now.turn[node], DMB_ROTATION_ROUNDING));
    dmb_quat_rotate_inverse(q0, u, moved);
    dmb_quat_between(q0, sim->now.quaternion + 4 * (size_t)node, turned);
    for (uint32_t c = 0; c < 3; c++) {
        if (!open[c] && differs(found, "displacement", 3 * (size_t)node + c, moved[c], far)) return 1;
        if (!open[3 + c] &&
            differs(found, "quaternion", 4 * (size_t)node + 1 + c, turned[1 + c], DMB_ROTATION_ROUNDING))
            return 1;
    }
    return 0;
}

static int any_off_support(const dmb_sim *sim, misfit *found)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constrained_count; i++)
        if (is_off_support(sim, scene->constrained_node[i], found)) return 1;
    return 0;
}

int dmb_is_off_supports(const dmb_sim *sim)
{
    misfit unused;
    return any_off_support(sim, &unused);
}

/* Supports are at their described positions, unless a state transfer has moved them. */
static int32_t check_supports(dmb_sim *sim)
{
    misfit found;
    if (sim->counters->carried > 1)
        return refuse(sim, "counters", offsetof(dmb_counters, carried) / 8, (double)sim->counters->carried, "0 or 1");
    if (sim->counters->carried || !any_off_support(sim, &found)) return DMB_OK;
    return refuse(sim, found.field, found.item, found.value, "0 in the axes of its described pose, since it is held");
}

static int32_t check_constrained(dmb_sim *sim)
{
    int32_t status = check_at_rest(sim, "velocity", sim->now.velocity);
    if (status >= 0) status = check_at_rest(sim, "acceleration", sim->now.acceleration);
    if (status >= 0) status = check_at_rest(sim, "pseudo_acceleration", sim->now.pseudo_acceleration);
    return status < 0 ? status : check_supports(sim);
}

/* ---- Times ------------------------------------------------------------------------------------------------------- */

static int32_t check_clock(dmb_sim *sim)
{
    const dmb_clock *clock = sim->clock;
    const dmb_sim_options *options = &sim->options;
    if (!(fabs(clock->rest) <= 8.0 * DBL_EPSILON * clock->time))
        return refuse(sim, "clock", 1, clock->rest, "at most the rounding of its time");
    if (!(clock->breakpoint >= 0.0 && clock->breakpoint <= (1.0 + DMB_TIME_LEEWAY) * clock->time))
        return refuse(sim, "clock", 2, clock->breakpoint, "from 0 to its time");
    if (!(clock->step <= (1.0 + DMB_TIME_LEEWAY) * clock->time))
        return refuse(sim, "clock", 3, clock->step, "at most its time");
    if (clock->next_step != 0.0 && !(clock->next_step >= options->step_min && clock->next_step <= options->step_max))
        return refuse(sim, "clock", 4, clock->next_step, "0, or from step_min to step_max");
    return DMB_OK;
}

/* Samples of a delay: sorted, as searches in them require, and none in the future. */
static int32_t check_line(dmb_sim *sim, uint32_t line)
{
    const size_t first = 2 * (size_t)DMB_DELAY_SAMPLES * line;
    const double *time = sim->delay_line + first, now = sim->clock->time;
    for (size_t i = 0; i + 1 < DMB_DELAY_SAMPLES; i++)
        if (!(time[i] <= time[i + 1]))
            return refuse(sim, "delay_line", first + i + 1, time[i + 1], "not before the last");
    const double newest = time[DMB_DELAY_SAMPLES - 1];
    if (newest <= (1.0 + DMB_TIME_LEEWAY) * now) return DMB_OK;
    return refuse(sim, "delay_line", first + DMB_DELAY_SAMPLES - 1, newest, "at most the time of the state");
}

static int32_t check_times(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const double now = (1.0 + DMB_TIME_LEEWAY) * sim->clock->time;
    int32_t status = check_clock(sim);
    for (uint32_t i = 0; i < scene->delay_count && status >= 0; i++) status = check_line(sim, i);
    for (uint32_t i = 0; i < scene->input_count && status >= 0; i++) {
        const double begin = sim->input_begin[3 * (size_t)i];
        if (!(begin >= 0.0 && begin <= now))
            status = refuse(sim, "input_begin", 3 * (size_t)i, begin, "from 0 to the time of the state");
    }
    for (uint32_t i = 0; i < scene->event_count && status >= 0; i++)
        if (isfinite(sim->event_since[i]) && !(sim->event_since[i] <= now))
            status = refuse(sim, "event_since", i, sim->event_since[i], "at most the time of the state, or no time");
    return status;
}

/* ---- Settings ---------------------------------------------------------------------------------------------------- */

/* Values that dmb_sim_set_drive would reject. */
static int32_t check_drives(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].kind == DMB_DRIVE_MOTION && !isnan(sim->drive_input[i]))
            return refuse(sim, "drive_input", i, sim->drive_input[i],
                          "NaN, since a motion drive follows its time function");
    for (uint32_t i = 0; i < scene->input_count; i++) {
        const uint32_t drive = scene->inputs[i].index;
        if (scene->inputs[i].target == DMB_TARGET_SET_POINT && !isnan(sim->drive_input[drive]))
            return refuse(sim, "drive_input", drive, sim->drive_input[drive], "NaN, since an input is its set point");
    }
    return DMB_OK;
}

/* Limit by the input of that target, or as described. */
static double limit_of(const dmb_sim *sim, uint32_t drive, int32_t target)
{
    const dmb_scene_drive *described = sim->model->scene->drives + drive;
    for (uint32_t i = 0; i < sim->scene->input_count; i++)
        if (sim->scene->inputs[i].target == target && sim->scene->inputs[i].index == drive) return sim->input_value[i];
    return target == DMB_TARGET_LIMIT_LOW ? described->limit_low : described->limit_high;
}

static int32_t check_limits(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->input_count; i++) {
        const dmb_scene_input *input = sim->scene->inputs + i;
        if (input->target != DMB_TARGET_LIMIT_LOW && input->target != DMB_TARGET_LIMIT_HIGH) continue;
        const double low = limit_of(sim, input->index, DMB_TARGET_LIMIT_LOW);
        const double high = limit_of(sim, input->index, DMB_TARGET_LIMIT_HIGH);
        if (!(low < high))
            return refuse(sim, "input_value", i, sim->input_value[i], "such that limit_low < limit_high of its drive");
    }
    return DMB_OK;
}

static int32_t check_sides(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->event_count; i++) {
        const double side = sim->event_side[i];
        if (side != 0.0 && fabs(side) != 1.0) return refuse(sim, "event_side", i, side, "-1, 0 or 1");
    }
    return DMB_OK;
}

/* A stuck place must agree with its input; a joint is fixed on the axis of the hole if it is locked. */
static int32_t check_marks(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->stuck_count; i++) {
        const uint32_t input = scene->stuck[i].input;
        if (input != DMB_NONE && sim->stuck_held[i] != (sim->input_value[input] > 0.5))
            return refuse(sim, "stuck_held", i, sim->stuck_held[i], "the value of its input");
    }
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const int held = (sim->now.joint_segment[j] & DMB_SEGMENT_HELD) != 0;
        const int locked = sim->joint_state[j] == DMB_JOINT_LOCKED;
        if (held != (locked && scene->joints[j].kind == DMB_JOINT_POINT_ON_HOLE))
            return refuse(sim, "joint_segment", j, sim->now.joint_segment[j],
                          "marked as held where its joint is locked on the axis of the hole, and only there");
    }
    return DMB_OK;
}

static int32_t check_settings(dmb_sim *sim)
{
    int32_t status = check_drives(sim);
    if (status >= 0) status = check_limits(sim);
    if (status >= 0) status = check_sides(sim);
    return status < 0 ? status : check_marks(sim);
}

/* ---- Cut holes --------------------------------------------------------------------------------------------------- */

/* No station is wider than the widest cutter. */
static int32_t check_widening(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    double widest = 0.0;
    for (uint32_t k = 0; k < scene->bit_count; k++) widest = fmax(widest, scene->bits[k].law.radius);
    for (uint32_t j = 0; j < scene->hole.cuts; j++) {
        const double more = sim->hole_widening[j];
        const double radius = dmb_hole_described_radius(&scene->hole, dmb_hole_cut_depth(&scene->hole, j)) + more;
        if (more < 0.0 || (more > 0.0 && radius > (1.0 + DMB_RADIUS_ROUNDING) * widest))
            return refuse(sim, "hole_widening", j, more, "from 0 to what the widest cutter leaves");
    }
    return DMB_OK;
}

/* Samples fill the circular buffer before it wraps, and their angles increase. */
static int32_t check_history(dmb_sim *sim, uint32_t k)
{
    const dmb_scene_bit *bit = sim->scene->bits + k;
    const dmb_history_head *head = sim->history_head + k;
    const double *angle = sim->history_angle + bit->history_first;
    if (head->count < bit->history_capacity && head->head + 1 != head->count)
        return refuse(sim, "history_head", k, head->count, "its head + 1, or all that there is room for");
    for (uint32_t i = 1; i < head->count; i++) {
        const uint32_t at = (head->head + i) % head->count, next = (at + 1) % head->count;
        if (angle[next] > angle[at]) continue;
        return refuse(sim, "history_angle", bit->history_first + next, angle[next], "above that of the sample before");
    }
    return DMB_OK;
}

static int32_t check_histories(dmb_sim *sim)
{
    int32_t status = check_widening(sim);
    for (uint32_t k = 0; k < sim->scene->bit_count && status >= 0; k++)
        if (sim->scene->bits[k].history_capacity > 0) status = check_history(sim, k);
    return status;
}

/* ---- Dependent coordinates --------------------------------------------------------------------------------------- */

static int32_t check_partition(dmb_sim *sim, uint32_t k)
{
    const dmb_cluster *cluster = sim->scene->clusters + k;
    const double quality = sim->partition_quality[k];
    if (!(quality >= 0.0 && quality <= 1.0)) return refuse(sim, "partition_quality", k, quality, "from 0 to 1");
    for (uint32_t i = 0; i < sim->partition_rank[k] && !cluster->sparse; i++) {
        const uint32_t column = sim->partition_column[cluster->column + i];
        if (!sim->scene->solved_row[sim->scene->cluster_columns[cluster->column + column]])
            return refuse(sim, "partition_column", cluster->column + i, column,
                          "a coordinate that may depend on others, which one that is held may not");
    }
    return DMB_OK;
}

static int32_t check_partitions(dmb_sim *sim)
{
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < sim->scene->cluster_count && status >= 0; k++) status = check_partition(sim, k);
    return status;
}

/* ---- The whole --------------------------------------------------------------------------------------------------- */

int32_t dmb_snapshot_relations(dmb_sim *sim)
{
    int32_t status = check_rotations(sim);
    if (status >= 0) status = check_constrained(sim);
    if (status >= 0) status = check_times(sim);
    if (status >= 0) status = check_settings(sim);
    if (status >= 0) status = check_histories(sim);
    return status < 0 ? status : check_partitions(sim);
}
