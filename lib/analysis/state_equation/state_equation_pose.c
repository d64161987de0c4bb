/* Poses and velocities of a state: charts of the nodes, and Newton for the coordinates that joints make dependent. */
#include <math.h>
#include <string.h>

#include "analysis/state_equation/state_equation.h"
#include "constraint/partition.h"
#include "math/elementary.h"
#include "math/mat6.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "sim/node.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"

/* [rad] Largest tilt of a node against the origin; at pi the chart is singular. */
#define DMB_TILT_MAX 2.5
/* [rad], [lengths of parts] from one place to the next on the way from the origin, and the most places. */
#define DMB_STATE_STRIDE 0.5
enum { PLACES_MAX = 400, ITERATIONS_MAX = 30 };
/* [-] Violation over the size of the scene at which the iteration ends, also when stagnating below the second. */
#define DMB_STATE_CLOSED 2e-15
#define DMB_STATE_UNCLOSED 2e-10
/* [-] Fraction of the quality of the partition at the origin that is left at least. */
#define DMB_STATE_QUALITY 1e-3

/* ---- Charts (eq:joints.chart) -------------------------------------------------------------------------------------
 */

/* At z of a six-DOF node: T of the tilt (0, a, b), and cosine and sine of phi. */
typedef struct chart {
    double T[9], cosine, sine;
} chart;

static void chart_at(const double *z, chart *c)
{
    const double tilt[3] = {0.0, z[4], z[5]};
    dmb_so3_tangent(tilt, NULL, c->T);
    dmb_sin_cos(z[3], &c->sine, &c->cosine);
}

/* y and z of Rx(phi) w, and of Rx(phi)^T w. */
static void turn_ahead(const chart *c, const double w[3], double out[2])
{
    out[0] = c->cosine * w[1] - c->sine * w[2];
    out[1] = c->sine * w[1] + c->cosine * w[2];
}

static void turn_back(const chart *c, const double w[3], double out[2])
{
    out[0] = c->cosine * w[1] + c->sine * w[2];
    out[1] = -c->sine * w[1] + c->cosine * w[2];
}

/* Rotation of the node from that of the origin, as a quaternion. S = exp(0, a, b) Rx(phi) of eq:joints.chart: the
 * swing first, then the twist about the node's own axis. */
static void relative_rotation(const double *z, double q[4])
{
    const double tilt[3] = {0.0, z[4], z[5]}, half[4] = {dmb_cos(0.5 * z[3]), dmb_sin(0.5 * z[3]), 0.0, 0.0};
    double swing[4];
    dmb_quat_exp(tilt, swing);
    dmb_quat_mul(swing, half, q);
}

/* The twist is unwrapped to the revolution that phi predicts, so that rotations of many revolutions keep their
 * count. */
static void place_six_dof(const dmb_state_equation *s, uint32_t i, const double *z)
{
    const dmb_scene *scene = s->work->scene;
    double *x = s->work->trial.displacement + 3 * (size_t)i, *q = s->work->trial.quaternion + 4 * (size_t)i;
    double relative[4], described[4];
    dmb_quat_rotate(s->quaternion + 4 * (size_t)i, z, x);
    dmb_vec3_add(x, s->displacement + 3 * (size_t)i, x);
    relative_rotation(z, relative);
    dmb_quat_mul(s->quaternion + 4 * (size_t)i, relative, q);
    dmb_quat_normalize(q);
    dmb_quat_between(scene->reference_quaternion + 4 * (size_t)i, q, described);
    s->work->trial.turn[i] = dmb_quat_twist(described, s->turn[i] + z[3]);
}

/* Trial poses by z. */
static void place_nodes(const dmb_state_equation *s)
{
    const dmb_scene *scene = s->work->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const double *z = s->z + scene->layout.row[i];
        if (scene->layout.size[i] == DMB_NODE_SIX_DOF) {
            place_six_dof(s, i, z);
            continue;
        }
        s->work->trial.displacement[3 * (size_t)i] = s->displacement[3 * (size_t)i] + z[0];
        s->work->trial.turn[i] = s->turn[i] + z[1];
    }
}

/* Solves eq:joints.chart-rate for a', b' by the 2 x 2 part of T in y and z, then for phi' by its x component. */
void dmb_state_chart_rate(const dmb_state_equation *s, uint32_t node, const double *v, double *rate)
{
    const dmb_block_layout *layout = &s->work->scene->layout;
    const double *z = s->z + layout->row[node];
    double q[4], w[2];
    chart c;
    if (layout->size[node] != DMB_NODE_SIX_DOF) {
        memcpy(rate, v, layout->size[node] * sizeof *rate);
        return;
    }
    chart_at(z, &c);
    relative_rotation(z, q);
    dmb_quat_rotate(q, v, rate);
    turn_ahead(&c, v + 3, w);
    const double by = 1.0 / (c.T[4] * c.T[8] - c.T[5] * c.T[7]);
    rate[4] = by * (c.T[8] * w[0] - c.T[5] * w[1]);
    rate[5] = by * (c.T[4] * w[1] - c.T[7] * w[0]);
    rate[3] = v[3] - c.T[1] * rate[4] - c.T[2] * rate[5];
}

/* Body-frame motion (u; w) of a six-DOF node per unit of z, E with v = E z' (eq:joints.chart-rate). */
static void chart_matrix(const double *z, double E[36])
{
    double q[4], R[9];
    chart c;
    chart_at(z, &c);
    relative_rotation(z, q);
    dmb_quat_to_matrix(q, R);
    memset(E, 0, 36 * sizeof *E);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) E[6 * i + k] = R[3 * k + i];
    E[6 * 3 + 3] = 1.0;
    for (int k = 1; k < 3; k++) {
        const double column[3] = {c.T[k], c.T[3 + k], c.T[6 + k]};
        double turned[2];
        turn_back(&c, column, turned);
        E[6 * 3 + 3 + k] = column[0];
        E[6 * 4 + 3 + k] = turned[0];
        E[6 * 5 + 3 + k] = turned[1];
    }
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static int32_t refuse_tilt(const dmb_state_equation *s, uint32_t node, double tilt)
{
    dmb_message_set(&s->work->message,
                    "state equation: %s: tilt against the origin of the coordinates = %g rad, must be <= %g; make a "
                    "state before that the origin (dmb_state_equation_begin)",
                    dmb_owner_of_node(s->work->scene, node).text.text, tilt, DMB_TILT_MAX);
    return DMB_ERR_GEOMETRY;
}

static int32_t check_tilts(const dmb_state_equation *s)
{
    const dmb_scene *scene = s->work->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const double *z = s->z + scene->layout.row[i];
        if (scene->layout.size[i] != DMB_NODE_SIX_DOF) continue;
        const double square = z[4] * z[4] + z[5] * z[5];
        if (!(square <= DMB_TILT_MAX * DMB_TILT_MAX)) return refuse_tilt(s, i, sqrt(square));
    }
    return DMB_OK;
}

static int32_t refuse_far(const dmb_state_equation *s, uint32_t node, double distance, const char *unit)
{
    dmb_message_set(&s->work->message,
                    "state equation: %s: %g %s from the origin of the coordinates, too far for joints to be closed; "
                    "make a state before that the origin (dmb_state_equation_begin)",
                    dmb_owner_of_node(s->work->scene, node).text.text, distance, unit);
    return DMB_ERR_GEOMETRY;
}

static int32_t explain(const dmb_state_equation *s, int32_t status, const char *what)
{
    dmb_message reason;
    if (status >= 0 || status == DMB_ERR_CALLBACK) return status;
    dmb_clusters_explain(s->work, what);
    reason = s->work->message;
    dmb_message_set(&s->work->message,
                    "state equation: %s; make a state before that the origin (dmb_state_equation_begin)", reason.text);
    return status;
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

/* Rotation of a node from the origin, in its axes there, about a column of M: exact if it turns about that alone. */
static double turn_about(const dmb_state_equation *s, const dmb_scene_frame *frame, int column)
{
    if (frame->node == DMB_NONE) return 0.0;
    const dmb_block_layout *layout = &s->work->scene->layout;
    const double *z = s->z + layout->row[frame->node];
    if (layout->size[frame->node] != DMB_NODE_SIX_DOF) return frame->M[column] * z[1];
    return frame->M[column] * z[3] + frame->M[3 + column] * z[4] + frame->M[6 + column] * z[5];
}

/* Predicts the angles [rad] of joints from the rotations of their nodes. An angle is then determined in the revolution
 * nearest to its prediction. */
static void expect_turns(const dmb_state_equation *s)
{
    const dmb_scene *scene = s->work->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++)
        for (int k = 0; k < 2; k++)
            s->work->now.joint_turn[2 * j + (uint32_t)k] = s->joint_turn[2 * j + (uint32_t)k] +
                                                           turn_about(s, &scene->joints[j].b, k) -
                                                           turn_about(s, &scene->joints[j].a, k);
}

/* B of a component by chart coordinates: B E, in place. */
static void turn_columns(const dmb_state_equation *s, const dmb_cluster *cluster)
{
    const dmb_scene *scene = s->work->scene;
    double *B = dmb_cluster_matrix(s->work, cluster), E[36], row[6];
    for (uint32_t i = cluster->node; i < cluster->node + cluster->node_count; i++) {
        const uint32_t node = scene->cluster_nodes[i];
        if (scene->layout.size[node] != DMB_NODE_SIX_DOF) continue;
        chart_matrix(s->z + scene->layout.row[node], E);
        for (uint32_t r = 0; r < cluster->rows; r++) {
            double *b = B + (size_t)r * cluster->columns + scene->node_place[node];
            dmb_mat6_row(b, 1, E, row);
            memcpy(b, row, sizeof row);
        }
    }
}

/* x = C_d^-1 values of the pivot rows, with the present matrix, into cluster_rows in the order of dependent columns. */
static int32_t solve_dependent(const dmb_state_equation *s, uint32_t k, const double *value)
{
    dmb_sim *work = s->work;
    const dmb_cluster *cluster = work->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(work, k);
    double *lu = work->cluster_lu + cluster->square;
    uint32_t *pivot = work->cluster_pivot + cluster->row;
    const double quality = dmb_partition_factor(dmb_cluster_matrix(work, cluster), cluster->columns,
                                                work->cluster_weight + cluster->column, &partition, lu, pivot);
    if (!(quality > DMB_STATE_QUALITY * work->partition_quality[k]))
        return dmb_cluster_singular(work, cluster->row, 0.0);
    for (uint32_t i = 0; i < partition.rank; i++) work->cluster_rows[i] = value[cluster->row + partition.row_order[i]];
    dmb_partition_solve(&partition, lu, pivot, work->cluster_rows);
    return DMB_OK;
}

/* One step of Newton on C(z, t) = 0 in the dependent coordinates. */
static int32_t correct(const dmb_state_equation *s)
{
    const dmb_scene *scene = s->work->scene;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        const dmb_partition partition = dmb_cluster_partition(s->work, k);
        turn_columns(s, cluster);
        const int32_t status = solve_dependent(s, k, s->work->constraint_value);
        if (status < 0) return status;
        for (uint32_t i = 0; i < partition.rank; i++)
            s->z[scene->cluster_columns[cluster->column + partition.column_order[i]]] -= s->work->cluster_rows[i];
    }
    return DMB_OK;
}

/* [m] Size that scales the rounding of positions. */
static double size_of(const dmb_state_equation *s)
{
    const dmb_scene *scene = s->work->scene;
    double far = 0.0;
    for (uint32_t i = 0; i < 3 * scene->node_count; i++) far = fmax(far, fabs(s->work->trial.displacement[i]));
    return s->work->reduced_mode->size + far;
}

/* Newton in the dependent coordinates. It ends at rounding (DMB_STATE_CLOSED), or where it stagnates at a violation
 * that is still small; a larger one after ITERATIONS_MAX is no convergence. A partition whose quality has fallen below
 * a fraction of that at the origin is singular for this state: the caller moves the origin. */
static int32_t close_joints(const dmb_state_equation *s, dmb_evaluation *evaluation)
{
    double last = (double)INFINITY;
    uint32_t row = 0;
    for (int k = 0;; k++) {
        place_nodes(s);
        expect_turns(s);
        int32_t status = dmb_clusters_assemble(evaluation);
        if (status < 0) return status;
        const double size = size_of(s), violation = dmb_clusters_pivot_violation(s->work, &row);
        if (violation <= DMB_STATE_CLOSED * size) return DMB_OK;
        if (violation < DMB_STATE_UNCLOSED * size && violation > 0.5 * last) return DMB_OK;
        if (k == ITERATIONS_MAX || !isfinite(violation)) {
            (void)dmb_cluster_singular(s->work, row, fabs(s->work->constraint_value[row]));
            return DMB_ERR_NO_CONVERGENCE;
        }
        last = violation;
        status = correct(s);
        if (status < 0) return status;
        status = check_tilts(s);
        if (status < 0) return status;
    }
}

/* ---- From the origin to a state ---------------------------------------------------------------------------------- */

dmb_evaluation dmb_state_evaluation(const dmb_state_equation *s, double time)
{
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = s->work;
    evaluation.time = time;
    evaluation.load_factor = 1.0;
    evaluation.mass_factor = 1.0;
    evaluation.pseudo_factor = 1.0;
    evaluation.dynamic = 1;
    s->work->reduced_mode->row = DMB_NONE;
    return evaluation;
}

/* Values of time functions at evaluation->time, and travels of motion drives since the origin. */
static int32_t prescribe(const dmb_state_equation *s, dmb_evaluation *evaluation)
{
    dmb_sim *work = s->work;
    work->clock->time = s->time;
    for (uint32_t i = 0; i < work->scene->drive_count; i++) work->now.drives[i].position = s->drive_position[i];
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    for (uint32_t i = 0; i < work->scene->row_count; i++)
        if (s->kind[i] >= DMB_STATE_DRIVEN) work->trial.velocity[i] = 0.0;
    return dmb_system_prescribe(evaluation);
}

/* Raises *strides to those of a coordinate of a part on joints that moves by `way` [m, rad]. */
static int32_t count_way(const dmb_state_equation *s, uint32_t node, double way, int turns, double *strides)
{
    const double here = fabs(way) / (DMB_STATE_STRIDE * (turns ? 1.0 : s->work->reduced_mode->length));
    if (!(here <= PLACES_MAX)) return refuse_far(s, node, way, turns ? "rad" : "m");
    *strides = fmax(*strides, here);
    return DMB_OK;
}

static int32_t count_row(const dmb_state_equation *s, uint32_t row, double way, double *strides)
{
    const dmb_scene *scene = s->work->scene;
    const uint32_t node = dmb_node_of_row(scene, row);
    if (scene->node_cluster[node] == DMB_NONE) return DMB_OK;
    return count_way(s, node, way, 2 * (row - scene->layout.row[node]) >= scene->layout.size[node], strides);
}

static int32_t count_drive(const dmb_state_equation *s, uint32_t i, double *strides)
{
    const dmb_scene_drive *drive = s->work->scene->drives + i;
    if (drive->kind != DMB_DRIVE_MOTION) return DMB_OK;
    if (drive->joint == DMB_NONE) return count_row(s, drive->row, s->work->increment[drive->row], strides);
    if (s->work->joint_state[drive->joint] == DMB_JOINT_OPEN) return DMB_OK;
    const double way = s->work->trial.drives[i].position - s->drive_position[i];
    return count_way(s, s->work->scene->joints[drive->joint].b.node, way, drive->component >= DMB_RX, strides);
}

/* [strides] From the origin to the state, the longest of independent and prescribed coordinates. */
static int32_t count_strides(const dmb_state_equation *s, const double *y, double *strides)
{
    int32_t status = DMB_OK;
    *strides = 1.0;
    for (uint32_t i = 0; i < s->count && status >= 0; i++) status = count_row(s, s->row_of[i], y[i], strides);
    for (uint32_t i = 0; i < s->work->scene->drive_count && status >= 0; i++) status = count_drive(s, i, strides);
    return status;
}

/* z at the fraction `part` of the way: independent and prescribed rows, and a guess of the dependent ones. The guess
 * of dependent coordinates continues their last stride in a straight line. */
static void go_to(const dmb_state_equation *s, const double *y, double part)
{
    const dmb_sim *work = s->work;
    for (uint32_t i = 0; i < work->scene->row_count; i++) {
        const double before = s->z[i];
        if (s->kind[i] == DMB_STATE_DRIVEN) s->z[i] = work->increment[i];
        if (s->kind[i] == DMB_STATE_DEPENDENT) s->z[i] += s->z[i] - s->older[i];
        s->older[i] = before;
    }
    for (uint32_t i = 0; i < s->count; i++) s->z[s->row_of[i]] = part == 1.0 ? y[i] : part * y[i];
}

/* Prescribed travels at the fraction `part` of the way: of those at its end, since travel does not grow in proportion
 * to time. */
static int32_t prescribe_part(const dmb_state_equation *s, double time, double part)
{
    dmb_sim *work = s->work;
    dmb_evaluation end = dmb_state_evaluation(s, time);
    const int32_t status = prescribe(s, &end);
    if (status < 0 || part == 1.0) return status;
    for (uint32_t i = 0; i < work->scene->row_count; i++) work->increment[i] *= part;
    for (uint32_t i = 0; i < work->scene->drive_count; i++)
        work->trial.drives[i].position =
            s->drive_position[i] + part * (work->trial.drives[i].position - s->drive_position[i]);
    return status;
}

static int32_t go(const dmb_state_equation *s, double time, double part, const double *y)
{
    dmb_evaluation evaluation = dmb_state_evaluation(s, part == 1.0 ? time : s->time + part * (time - s->time));
    int32_t status = prescribe_part(s, time, part);
    if (status < 0) return status;
    go_to(s, y, part);
    status = check_tilts(s);
    if (status < 0) return status;
    if (s->work->scene->cluster_count > 0) return explain(s, close_joints(s, &evaluation), "it cannot be closed there");
    place_nodes(s);
    expect_turns(s);
    return DMB_OK;
}

/* With joints along the way from the origin in strides, so that it is the same of equal states, whatever came before.
 */
int32_t dmb_state_find_pose(dmb_state_equation *s, double time, const double *y)
{
    double strides = 1.0;
    memset(s->z, 0, s->work->scene->row_count * sizeof(double));
    memset(s->older, 0, s->work->scene->row_count * sizeof(double));
    if (s->work->scene->cluster_count > 0) {
        dmb_evaluation end = dmb_state_evaluation(s, time);
        int32_t status = prescribe(s, &end);
        if (status >= 0) status = count_strides(s, y, &strides);
        if (status < 0) return status;
    }
    const uint32_t places = (uint32_t)ceil(strides);
    for (uint32_t k = 1; k <= places; k++) {
        const int32_t status = go(s, time, (double)k / places, y);
        if (status < 0) return status;
    }
    return DMB_OK;
}

/* C_d v_d = -(rate + C_i v_i) with the matrix by velocities. */
static int32_t solve_velocities(const dmb_state_equation *s, uint32_t k)
{
    dmb_sim *work = s->work;
    const dmb_cluster *cluster = work->scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(work, k);
    const uint32_t *row_of = work->scene->cluster_columns + cluster->column;
    const double *B = dmb_cluster_matrix(work, cluster);
    double *d = work->cluster_scratch;
    for (uint32_t r = 0; r < cluster->rows; r++) {
        d[cluster->row + r] = work->constraint_rate[cluster->row + r];
        for (uint32_t c = 0; c < cluster->columns; c++)
            d[cluster->row + r] += B[(size_t)r * cluster->columns + c] * work->trial.velocity[row_of[c]];
    }
    const int32_t status = solve_dependent(s, k, d);
    for (uint32_t i = 0; i < partition.rank && status >= 0; i++)
        work->trial.velocity[row_of[partition.column_order[i]]] = -work->cluster_rows[i];
    return status;
}

int32_t dmb_state_find_velocity(dmb_state_equation *s, double time, const double *u)
{
    dmb_sim *work = s->work;
    dmb_evaluation evaluation = dmb_state_evaluation(s, time);
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < s->count; i++) work->trial.velocity[s->row_of[i]] = u[i];
    for (uint32_t i = 0; i < work->scene->row_count; i++)
        if (s->kind[i] == DMB_STATE_DEPENDENT) work->trial.velocity[i] = 0.0;
    if (work->scene->cluster_count > 0) status = dmb_clusters_assemble(&evaluation);
    for (uint32_t k = 0; k < work->scene->cluster_count && status >= 0; k++) status = solve_velocities(s, k);
    status = explain(s, status, "its speeds are not determined there");
    if (status >= 0) dmb_joints_follow(&evaluation);
    return status;
}
