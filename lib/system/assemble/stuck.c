/* Stuck places: springs and dampers to the pose in which they got stuck, until they release (eq:motion.stuck). */
#include "system/assemble/assemble.h"

#include <string.h>

#include "math/elementary.h"
#include "math/mat6.h"
#include "math/vec3.h"
#include "system/assemble/point_motion.h"

enum { COORDINATES = DMB_STUCK_COORDINATES };

/* With the anchor (R0, x0), Q = R0^T R and d = R0^T (x - x0), the coordinates are
 *
 *     s = (d_x, d_y, d_z, theta),   theta = dmb_atan2(Q_zy - Q_yz, Q_yy + Q_zz),   s' = J V
 *
 * theta is the twist of the rotation Q about the anchor's x axis (swing and twist: 2 atan2(q_x, q_w) of its
 * quaternion). V is the twist of the place in its own axes, so
 *
 *     J_k = (row k of Q, 0), k = x, y, z;   J_theta = (0; 1, Q_xy/(1 + Q_xx), Q_xz/(1 + Q_xx))
 *
 * and with dQ = Q w~ each row r of Q changes by r x w. */
typedef struct stuck_motion {
    dmb_point_motion point;
    double s[COORDINATES];
    double J[COORDINATES][6];
} stuck_motion;

/* Index of stiffness[3] (along, about, sideways) of each coordinate. */
static const int kind_of[COORDINATES] = {0, 2, 2, 1};

/* The coordinates are singular at Q_xx = -1, half a turn of the place across the anchor's axis. */
static void motion_of(const dmb_sim *sim, const dmb_configuration *c, uint32_t i, stuck_motion *m)
{
    const double *R0 = sim->stuck_anchor + 12 * (size_t)i, *x0 = R0 + 9;
    double Q[9], d[3];
    memset(m, 0, sizeof *m);
    dmb_point_motion_of(sim->scene, c, &sim->scene->stuck[i].point, &m->point);
    dmb_mat3_mul_tn(R0, m->point.R, Q);
    dmb_vec3_sub(m->point.x, x0, d);
    dmb_mat3_tvec(R0, d, m->s);
    m->s[3] = dmb_atan2(Q[7] - Q[5], Q[4] + Q[8]);
    for (int k = 0; k < 3; k++) dmb_vec3_copy(Q + 3 * k, m->J[k]);
    m->J[3][3] = 1.0;
    m->J[3][4] = Q[1] / (1.0 + Q[0]);
    m->J[3][5] = Q[2] / (1.0 + Q[0]);
}

static void hold_of(const dmb_scene_stuck *stuck, const stuck_motion *m, int rates, dmb_stuck_hold *hold)
{
    for (int k = 0; k < COORDINATES; k++) {
        const double speed = rates ? dmb_vec6_dot(m->J[k], m->point.V) : 0.0;
        hold->s[k] = m->s[k];
        hold->force[k] = stuck->stiffness[kind_of[k]] * m->s[k] + stuck->damping[kind_of[k]] * speed;
    }
}

void dmb_stuck_hold_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates,
                       dmb_stuck_hold *hold)
{
    stuck_motion m;
    motion_of(sim, configuration, i, &m);
    hold_of(sim->scene->stuck + i, &m, rates, hold);
}

void dmb_stuck_wrench_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates, double w[6])
{
    stuck_motion m;
    dmb_stuck_hold hold;
    motion_of(sim, configuration, i, &m);
    hold_of(sim->scene->stuck + i, &m, rates, &hold);
    for (int c = 0; c < 6; c++) {
        w[c] = 0.0;
        for (int k = 0; k < COORDINATES; k++) w[c] -= hold.force[k] * m.J[k][c];
    }
}

/* Release is by the force along the hole or the torque about it, whichever is nearer to its limit; sideways forces do
 * not free a place. */
double dmb_stuck_ratio(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates)
{
    const dmb_scene_stuck *stuck = sim->scene->stuck + i;
    dmb_stuck_hold hold;
    if (!sim->stuck_held[i]) return 0.0;
    dmb_stuck_hold_of(sim, configuration, i, rates, &hold);
    return fmax(fabs(hold.force[0]) / stuck->release[0], fabs(hold.force[3]) / stuck->release[1]);
}

double dmb_stuck_largest_ratio(const dmb_sim *sim, const dmb_configuration *configuration, int rates)
{
    double most = 0.0;
    for (uint32_t i = 0; i < sim->scene->stuck_count; i++)
        most = fmax(most, dmb_stuck_ratio(sim, configuration, i, rates));
    return most;
}

/* ---- Tangent ----------------------------------------------------------------------------------------------------- */

/* W, shape (6, 6): sum of f_k dJ_k/dz by displacements z of the place in its axes; r x w = r~ w. */
static void add_turning(const double J[6], double f, double W[36])
{
    W[4] -= f * J[2];
    W[5] += f * J[1];
    W[9] += f * J[2];
    W[11] -= f * J[0];
    W[15] -= f * J[1];
    W[16] += f * J[0];
}

/* By r = row x of Q: g_j = r_j/(1 + r_x), dg_j = dr_j/(1 + r_x) - g_j dr_x/(1 + r_x), dr = r x w. */
static void add_twist(const double r[3], double f, double W[36])
{
    const double n = 1.0 / (1.0 + r[0]);
    const double dr[3][3] = {{0.0, -r[2], r[1]}, {r[2], 0.0, -r[0]}, {-r[1], r[0], 0.0}};
    for (int j = 1; j < 3; j++)
        for (int c = 0; c < 3; c++) W[6 * (3 + j) + 3 + c] += f * n * (dr[j][c] - r[j] * n * dr[0][c]);
}

static void turning_of(const stuck_motion *m, const double f[COORDINATES], double W[36])
{
    memset(W, 0, 36 * sizeof(double));
    for (int k = 0; k < 3; k++) add_turning(m->J[k], f[k], W);
    add_twist(m->J[0], f[3], W);
}

/* Row of ds'_k/dq: V^T dJ_k, and J_k by the change of the map. */
static void rate_row(const dmb_scene *scene, const dmb_force_tangent *t, const stuck_motion *m, int k, double *row)
{
    double unit[COORDINATES] = {0.0}, W[36], w[6] = {0.0}, A[144], values[DMB_POINT_COLUMNS] = {0.0};
    unit[k] = 1.0;
    turning_of(m, unit, W);
    for (int c = 0; c < 6; c++)
        for (int r = 0; r < 6; r++) w[c] += m->point.V[r] * W[6 * r + c];
    dmb_force_tangent_row(scene, t, &m->point, w, row);
    dmb_point_map_tangent(scene, &m->point, m->J[k], A);
    for (int r = 0; r < DMB_POINT_COLUMNS; r++)
        for (int c = 0; c < DMB_POINT_COLUMNS; c++) values[c] += m->point.v[r] * A[12 * r + c];
    dmb_force_tangent_columns(scene, t, &m->point, values, row);
}

static void add_product(dmb_force_tangent *t, double factor, const double *left, const double *right)
{
    for (uint32_t r = 0; r < t->columns; r++)
        for (uint32_t c = 0; c < t->columns; c++) t->K[(size_t)r * t->columns + c] += factor * left[r] * right[c];
}

/* K = J^T (k J + c ds'/dq) + sum of f dJ^T; plus the change of the map under w. */
static void add_stiffness(dmb_evaluation *evaluation, const dmb_scene_stuck *stuck, const stuck_motion *m,
                          const double f[COORDINATES], const double w[6], dmb_force_tangent *t)
{
    const dmb_scene *scene = evaluation->sim->scene;
    double A[144], W[36];
    dmb_force_tangent_clear(t);
    dmb_point_map_tangent(scene, &m->point, w, A);
    dmb_force_tangent_block(scene, t, &m->point, 1.0, A);
    turning_of(m, f, W);
    for (int a = 0; a < 6; a++) {
        double move[DMB_CONSTRAINT_COLUMNS] = {0.0}, change[DMB_CONSTRAINT_COLUMNS] = {0.0}, unit[6] = {0.0};
        unit[a] = 1.0;
        dmb_force_tangent_row(scene, t, &m->point, unit, move);
        dmb_force_tangent_row(scene, t, &m->point, W + 6 * a, change);
        add_product(t, 1.0, move, change);
    }
    for (int k = 0; k < COORDINATES; k++) {
        double row[DMB_CONSTRAINT_COLUMNS] = {0.0}, rate[DMB_CONSTRAINT_COLUMNS] = {0.0};
        const double c = evaluation->dynamic ? stuck->damping[kind_of[k]] : 0.0;
        dmb_force_tangent_row(scene, t, &m->point, m->J[k], row);
        add_product(t, stuck->stiffness[kind_of[k]], row, row);
        if (c == 0.0) continue;
        rate_row(scene, t, m, k, rate);
        add_product(t, c, row, rate);
    }
    dmb_force_tangent_add(evaluation, DMB_NONE, DMB_BY_DISPLACEMENT, t);
}

static void add_tangent(dmb_evaluation *evaluation, const dmb_scene_stuck *stuck, const stuck_motion *m,
                        const double f[COORDINATES], const double w[6])
{
    const dmb_scene *scene = evaluation->sim->scene;
    dmb_force_tangent t;
    dmb_force_tangent_begin(&t);
    dmb_force_tangent_touch(scene, &m->point, &t);
    add_stiffness(evaluation, stuck, m, f, w, &t);
    if (!evaluation->dynamic) return;
    dmb_force_tangent_clear(&t);
    for (int k = 0; k < COORDINATES; k++) {
        double row[DMB_CONSTRAINT_COLUMNS] = {0.0};
        if (stuck->damping[kind_of[k]] == 0.0) continue;
        dmb_force_tangent_row(scene, &t, &m->point, m->J[k], row);
        add_product(&t, stuck->damping[kind_of[k]], row, row);
    }
    dmb_force_tangent_add(evaluation, DMB_NONE, DMB_BY_VELOCITY, &t);
}

/* ---- Residual ---------------------------------------------------------------------------------------------------- */

/* Rounding of its pose times the stiffness (system/assemble/springs). */
static void count_rounding(dmb_evaluation *evaluation, uint32_t i, const dmb_scene_stuck *stuck, const stuck_motion *m)
{
    const double *x0 = evaluation->sim->stuck_anchor + 12 * (size_t)i + 9;
    const double reach = dmb_vec3_norm(m->point.x) + dmb_vec3_norm(x0);
    const double k = fmax(stuck->stiffness[0], stuck->stiffness[2]) * reach;
    if (dmb_rounding_counts(evaluation)) evaluation->rounding += k * k + stuck->stiffness[1] * stuck->stiffness[1];
}

/* Adds w = J^T f, f = k s + c s' of each coordinate, to the nodes; the springs count as potential, the dampers as
 * damping. */
static void gather(dmb_evaluation *evaluation, uint32_t i)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_stuck *stuck = sim->scene->stuck + i;
    stuck_motion m;
    dmb_stuck_hold hold;
    double w[6] = {0.0}, pull[6];
    motion_of(sim, &sim->trial, i, &m);
    hold_of(stuck, &m, evaluation->dynamic, &hold);
    for (int k = 0; k < COORDINATES; k++) {
        const double speed = dmb_vec6_dot(m.J[k], m.point.V), elastic = stuck->stiffness[kind_of[k]] * m.s[k];
        for (int c = 0; c < 6; c++) w[c] += hold.force[k] * m.J[k][c];
        evaluation->power[DMB_POWER_POTENTIAL] -= elastic * speed;
        evaluation->power[DMB_POWER_DAMPING] -= (hold.force[k] - elastic) * speed;
    }
    for (int c = 0; c < 6; c++) pull[c] = -w[c];
    dmb_point_apply(sim, &m.point, pull);
    count_rounding(evaluation, i, stuck, &m);
    if (evaluation->tangent) add_tangent(evaluation, stuck, &m, hold.force, w);
}

void dmb_assemble_stuck(dmb_evaluation *evaluation)
{
    for (uint32_t i = 0; i < evaluation->sim->scene->stuck_count; i++)
        if (evaluation->sim->stuck_held[i]) gather(evaluation, i);
}

static double energy_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i)
{
    const dmb_scene_stuck *stuck = sim->scene->stuck + i;
    stuck_motion m;
    double sum = 0.0;
    if (!sim->stuck_held[i]) return 0.0;
    motion_of(sim, configuration, i, &m);
    for (int k = 0; k < COORDINATES; k++) sum += 0.5 * stuck->stiffness[kind_of[k]] * m.s[k] * m.s[k];
    return sum;
}

double dmb_stuck_energy(const dmb_sim *sim, const dmb_configuration *configuration)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < sim->scene->stuck_count; i++) sum += energy_of(sim, configuration, i);
    return sum;
}

/* ---- Stuck and free ---------------------------------------------------------------------------------------------- */

static void set_anchor(dmb_sim *sim, uint32_t i)
{
    dmb_point_motion m;
    double *to = sim->stuck_anchor + 12 * (size_t)i;
    dmb_point_motion_of(sim->scene, &sim->now, &sim->scene->stuck[i].point, &m);
    dmb_mat3_copy(m.R, to);
    dmb_vec3_copy(m.x, to + 9);
}

void dmb_stuck_start(dmb_sim *sim, uint32_t i)
{
    const dmb_scene_stuck *stuck = sim->scene->stuck + i;
    set_anchor(sim, i);
    sim->stuck_held[i] = stuck->input != DMB_NONE ? sim->input_value[stuck->input] > 0.5 : stuck->initially;
}

/* Setting what is set already keeps the anchor, and with it the force.
 *
 *     by                            from -> to        anchor         energy of the springs
 *     ---------------------------   ---------------   ------------   ---------------------------------
 *     dmb_stuck_start               -> described      pose at 0      0
 *     an input, 0 to 1              free -> stuck     present pose   0
 *     an input, 1 to 0              stuck -> free     kept           counted as loss (dmb_stuck_lose)
 *     release (dmb_stuck_let_go)    stuck -> free     kept           counted as loss; its input becomes 0
 *     state transfer                as in the other   converted      as in the other */
void dmb_stuck_set(dmb_sim *sim, uint32_t i, int32_t held)
{
    if (sim->stuck_held[i] == held) return;
    if (held) set_anchor(sim, i);
    sim->stuck_held[i] = held;
}

/* Positions are relative to the described one of the node (point_motion.h), which may differ between the models. */
void dmb_stuck_transfer(dmb_sim *sim, const dmb_sim *from, uint32_t i)
{
    double *to = sim->stuck_anchor + 12 * (size_t)i;
    const uint32_t node = sim->scene->stuck[i].point.node, old = from->scene->stuck[i].point.node;
    memcpy(to, from->stuck_anchor + 12 * (size_t)i, 12 * sizeof(double));
    dmb_vec3_add(to + 9, from->scene->reference_position + 3 * (size_t)old, to + 9);
    dmb_vec3_sub(to + 9, sim->scene->reference_position + 3 * (size_t)node, to + 9);
    sim->stuck_held[i] = from->stuck_held[i];
}
