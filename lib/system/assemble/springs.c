/* Springs and dampers between two points.
 *
 *     d = x_b - x_a,  l = sqrt(|d|^2 + 1e-18 m2),  n = d/l,  l' = n . (R_b v_b - R_a v_a)
 *
 * tension t(l - l0, l') acts with -t n on b and t n on a; the elastic part is the gradient of E(l - l0). */
#include "system/assemble/assemble.h"

#include <string.h>

#include "math/mat6.h"
#include "math/se3.h"
#include "math/vec3.h"
#include "system/assemble/bounces.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"

/* ---- Springs between two points ---------------------------------------------------------------------------------- */

#define DMB_SPRING_NEAR 1e-9 /* [m] points closer than a few of these have no direction */

static const dmb_spring_point *points_of(const dmb_scene *scene, const dmb_scene_spring *spring)
{
    return scene->spring_points + spring->law.first;
}

/* R_b v_b - R_a v_a */
static void relative_velocity(const dmb_spring_motion *m, double v[3])
{
    double va[3];
    dmb_mat3_vec(m->b.R, m->b.V, v);
    dmb_mat3_vec(m->a.R, m->a.V, va);
    dmb_vec3_sub(v, va, v);
}

void dmb_spring_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t spring, int rates,
                          dmb_spring_motion *motion)
{
    const dmb_scene_spring *s = scene->springs + spring;
    double d[3], v[3];
    dmb_point_motion_of(scene, configuration, &s->a, &motion->a);
    dmb_point_motion_of(scene, configuration, &s->b, &motion->b);
    dmb_vec3_sub(motion->b.x, motion->a.x, d);
    dmb_vec3_add(d, s->span, d);
    motion->length = sqrt(dmb_vec3_norm_squared(d) + DMB_SPRING_NEAR * DMB_SPRING_NEAR);
    dmb_vec3_scale(1.0 / motion->length, d, motion->n);
    relative_velocity(motion, v);
    motion->rate = rates ? dmb_vec3_dot(motion->n, v) : 0.0;
    dmb_spring_force_at(&s->law, points_of(scene, s), motion->length - s->free_length, motion->rate, &motion->force);
}

/* (R^T n; 0): direction of the spring in the axes of a point. */
static void line_at(const dmb_point_motion *point, const double n[3], double w[6])
{
    dmb_mat3_tvec(point->R, n, w);
    dmb_vec3_zero(w + 3);
}

/* ---- Tangent ----------------------------------------------------------------------------------------------------- */

/* The residual of a spring is t J^T, J the gradient of l by displacements of the nodes, l' = J v (eq:motion.spring):
 *
 *     K = J^T (dt/de J + dt/de' dl'/dq) + t dJ^T,   C = dt/de' J^T J,
 *     J = sum s (R^T n; 0)^T map,  dJ^T = sum s map^T (R^T dn + (R^T n) x theta; 0) + s d(map^T) (R^T n; 0)
 *
 * over both points, s = 1 at b and -1 at a, dn = (I - n n^T)/l (R_b z_b - R_a z_a). */
typedef double wide_row[DMB_CONSTRAINT_COLUMNS];

typedef struct spring_tangent {
    dmb_force_tangent sum;
    wide_row gradient, rate; /* J, dl'/dq */
    wide_row turn[3];        /* dn */
} spring_tangent;

/* Adds rows of R times the displacement of the point, world axis i. */
static void add_move(const dmb_scene *scene, const dmb_force_tangent *sum, const dmb_point_motion *point, int i,
                     double sign, double *row)
{
    const double *R = point->R + 3 * i, w[6] = {sign * R[0], sign * R[1], sign * R[2], 0.0, 0.0, 0.0};
    dmb_force_tangent_row(scene, sum, point, w, row);
}

static void turn_of_line(const dmb_scene *scene, const dmb_spring_motion *m, spring_tangent *t)
{
    for (int i = 0; i < 3; i++) {
        add_move(scene, &t->sum, &m->b, i, 1.0, t->turn[i]);
        add_move(scene, &t->sum, &m->a, i, -1.0, t->turn[i]);
    }
    for (uint32_t c = 0; c < t->sum.columns; c++) {
        const double x[3] = {t->turn[0][c], t->turn[1][c], t->turn[2][c]}, along = dmb_vec3_dot(m->n, x);
        for (int i = 0; i < 3; i++) t->turn[i][c] = (x[i] - along * m->n[i]) / m->length;
    }
}

/* d(R v) = R (theta x v), and v by the change of the map: n . both; A by dmb_point_map_tangent for the direction. */
static void add_rate(const dmb_scene *scene, const dmb_point_motion *point, const double line[6], double sign,
                     const double A[144], spring_tangent *t)
{
    double w[6] = {0.0}, values[12] = {0.0};
    dmb_vec3_cross(point->V, line, w + 3);
    dmb_vec3_scale(sign, w + 3, w + 3);
    dmb_force_tangent_row(scene, &t->sum, point, w, t->rate);
    for (uint32_t r = 0; r < 12; r++)
        for (uint32_t c = 0; c < 12; c++) values[c] += sign * point->v[r] * A[12 * r + c];
    dmb_force_tangent_columns(scene, &t->sum, point, values, t->rate);
}

/* t s map^T (R^T dn + (R^T n) x theta; 0) */
static void add_turn(const dmb_scene *scene, const dmb_point_motion *point, const double line[6], double factor,
                     spring_tangent *t)
{
    const uint32_t n = t->sum.columns;
    for (int i = 0; i < 3; i++) {
        wide_row move = {0.0}, turn = {0.0};
        double e[6] = {0.0}, across[6] = {0.0};
        e[i] = 1.0;
        dmb_vec3_cross(e, line, across + 3); /* e . (line x theta) = (e x line) . theta */
        dmb_force_tangent_row(scene, &t->sum, point, e, move);
        dmb_force_tangent_row(scene, &t->sum, point, across, turn);
        for (uint32_t c = 0; c < n; c++)
            for (int k = 0; k < 3; k++) turn[c] += point->R[3 * k + i] * t->turn[k][c];
        for (uint32_t r = 0; r < n; r++)
            for (uint32_t c = 0; c < n; c++) t->sum.K[(size_t)r * n + c] += factor * move[r] * turn[c];
    }
}

static void add_point(const dmb_evaluation *evaluation, const dmb_spring_motion *m, const dmb_point_motion *point,
                      double sign, double tension, spring_tangent *t)
{
    const dmb_scene *scene = evaluation->sim->scene;
    double line[6], signed_line[6], A[144];
    line_at(point, m->n, line);
    for (int i = 0; i < 6; i++) signed_line[i] = sign * line[i];
    dmb_force_tangent_row(scene, &t->sum, point, signed_line, t->gradient);
    dmb_point_map_tangent(scene, point, line, A);
    dmb_force_tangent_block(scene, &t->sum, point, sign * tension, A);
    add_turn(scene, point, line, sign * tension, t);
    if (evaluation->dynamic) add_rate(scene, point, line, sign, A, t);
}

/* One point of a spring in a step with a mean force: its state from which half of the gradient is taken, `sign` 1 at b
 * and -1 at a, and that half as wrenches on its nodes at the end of the step. */
typedef struct mean_point {
    const dmb_point_motion *at;
    double share; /* [-] of the end of the step, l1/(l0 + l1) */
    double sign, wrench[12];
    double turn[18]; /* its derivative by the rotation of a free rigid body at the end, shape (6, 3) */
} mean_point;

static void mean_point_of(const dmb_sim *sim, const dmb_spring_motion *before, const dmb_spring_motion *end, int b,
                          mean_point *to)
{
    const dmb_point_motion *last = b ? &end->b : &end->a;
    const int turns = last->nodes > 0 && dmb_bounce_turns(sim, last->node[0]);
    const dmb_spring_motion *m = turns ? before : end;
    double line[6];
    memset(to, 0, sizeof *to);
    to->at = b ? &m->b : &m->a;
    to->sign = b ? 1.0 : -1.0;
    to->share = end->length / (before->length + end->length);
    if (last->nodes == 0) return;
    line_at(to->at, m->n, line);
    for (int k = 0; k < 12; k++)
        for (int i = 0; i < 3; i++) to->wrench[k] += (1.0 - to->share) * to->sign * to->at->map[12 * i + k] * line[i];
    if (turns) dmb_bounce_carry(sim, last->node[0], to->wrench, to->turn);
}

/* The mean gradient of both ends of the step (pull_mean), and the change of its first half with the rotation of a free
 * rigid body under the tension. */
static void mean_gradient(const dmb_sim *sim, const mean_point point[2], double tension, spring_tangent *t, double *row)
{
    for (uint32_t c = 0; c < t->sum.columns; c++) row[c] *= point->share;
    for (int p = 0; p < 2; p++) {
        double A[144] = {0.0};
        if (point[p].at->nodes == 0) continue;
        dmb_force_tangent_columns(sim->scene, &t->sum, point[p].at, point[p].wrench, row);
        for (int i = 0; i < 18; i++) A[12 * (i / 3) + 3 + i % 3] = point[p].turn[i];
        dmb_force_tangent_block(sim->scene, &t->sum, point[p].at, tension, A);
    }
}

static void add_tangent(dmb_evaluation *evaluation, const dmb_scene_spring *spring, const dmb_spring_motion *m,
                        const mean_point *mean)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const double by_elongation = m->force.by_elongation, by_speed = evaluation->dynamic ? m->force.by_speed : 0.0;
    double v[3];
    wide_row rows;
    spring_tangent t;
    memset(t.gradient, 0, sizeof t - offsetof(spring_tangent, gradient));
    dmb_force_tangent_begin(&t.sum);
    dmb_force_tangent_touch(scene, &m->a, &t.sum);
    dmb_force_tangent_touch(scene, &m->b, &t.sum);
    dmb_force_tangent_clear(&t.sum);
    turn_of_line(scene, m, &t);
    const double at_end =
        mean != NULL ? mean->share * m->force.elastic + m->force.damper : m->force.elastic + m->force.damper;
    add_point(evaluation, m, &m->b, 1.0, at_end, &t);
    add_point(evaluation, m, &m->a, -1.0, at_end, &t);
    relative_velocity(m, v);
    const uint32_t n = t.sum.columns;
    for (uint32_t c = 0; c < n && evaluation->dynamic; c++)
        for (int i = 0; i < 3; i++) t.rate[c] += v[i] * t.turn[i][c];
    memcpy(rows, t.gradient, sizeof rows);
    if (mean != NULL) mean_gradient(evaluation->sim, mean, m->force.elastic, &t, rows);
    for (uint32_t r = 0; r < n; r++)
        for (uint32_t c = 0; c < n; c++)
            t.sum.K[(size_t)r * n + c] +=
                rows[r] * by_elongation * t.gradient[c] + t.gradient[r] * by_speed * t.rate[c];
    dmb_force_tangent_add(evaluation, spring->constraint, DMB_BY_DISPLACEMENT, &t.sum);
    if (by_speed == 0.0) return;
    for (uint32_t r = 0; r < n; r++)
        for (uint32_t c = 0; c < n; c++) t.sum.K[(size_t)r * n + c] = by_speed * t.gradient[r] * t.gradient[c];
    dmb_force_tangent_add(evaluation, spring->constraint, DMB_BY_VELOCITY, &t.sum);
}

/* ---- Residual ---------------------------------------------------------------------------------------------------- */

static void pull(dmb_sim *sim, const dmb_point_motion *point, const double n[3], double force)
{
    double w[6];
    if (point->nodes == 0) return;
    line_at(point, n, w);
    dmb_vec3_scale(force, w, w);
    dmb_point_apply(sim, point, w);
}

/* Couples of bodies that turn (dmb_bounce_close_gap); points inside elements have none. J: gradient that the mean force
 * had, at both nodes. The couples are the difference that closes the balance of energy of bodies that turn within the
 * step (eq:unilateral.turning). */
static void close_gap(dmb_sim *sim, uint32_t spring, const dmb_spring_motion *end, const mean_point point[2],
                      double tension)
{
    const dmb_point_motion *last[2] = {&end->a, &end->b};
    double J[2][6] = {{0.0}}, couple[6] = {0.0}, ends[2][3], line[6];
    uint32_t node[2];
    if (end->a.nodes > 1 || end->b.nodes > 1) return;
    for (int p = 0; p < 2; p++) {
        node[p] = last[p]->nodes > 0 ? last[p]->node[0] : DMB_NONE;
        line_at(last[p], end->n, line);
        for (int k = 0; k < 6; k++) {
            J[p][k] = point[p].wrench[k];
            for (int i = 0; i < 3; i++) J[p][k] += point->share * point[p].sign * last[p]->map[12 * i + k] * line[i];
        }
        dmb_vec3_copy(J[p] + 3, ends[p]);
    }
    dmb_bounce_close_gap(sim, dmb_bounce_of_spring(sim->scene, spring), node[0], J[0], node[1], J[1]);
    for (int p = 0; p < 2; p++) {
        if (node[p] == DMB_NONE) continue;
        dmb_vec3_sub(J[p] + 3, ends[p], couple + 3);
        dmb_vec3_scale(-tension, couple + 3, couple + 3);
        dmb_apply_wrench(sim, node[p], couple);
    }
}

/* A mean force: half along the gradient of the start of the step, in nodes that turn. */
static void pull_mean(dmb_sim *sim, uint32_t spring, const dmb_spring_motion *end, const mean_point point[2],
                      double tension)
{
    pull(sim, &end->b, end->n, -point->share * tension);
    pull(sim, &end->a, end->n, point->share * tension);
    for (int p = 1; p >= 0; p--)
        for (uint32_t n = 0; n < point[p].at->nodes; n++) {
            double w[6];
            dmb_vec3_scale(-tension, point[p].wrench + 6 * n, w);
            dmb_vec3_scale(-tension, point[p].wrench + 6 * n + 3, w + 3);
            dmb_apply_wrench(sim, point[p].at->node[n], w);
        }
    close_gap(sim, spring, end, point, tension);
}

static void mean_points_of(const dmb_sim *sim, uint32_t spring, const dmb_spring_motion *end, dmb_spring_motion *before,
                           mean_point point[2])
{
    dmb_spring_motion_of(sim->scene, &sim->now, spring, 0, before);
    for (int p = 0; p < 2; p++) mean_point_of(sim, before, end, p, point + p);
}

/* Rounding of the length, a difference of large numbers, as for springs of joints (system/assemble/joint_forces). */
static void count_rounding(dmb_evaluation *evaluation, const dmb_scene_spring *spring, const dmb_spring_motion *m)
{
    const double reach = dmb_vec3_norm(spring->span) + dmb_vec3_norm(m->a.x) + dmb_vec3_norm(m->b.x);
    const double k = m->force.by_elongation * reach;
    if (dmb_rounding_counts(evaluation)) evaluation->rounding += k * k;
}

/* Replaces the force of the law by the mean force in a step that has one; the damper of a two-sided spring stays.
 * Returns the dissipated power. */
static double take_own(dmb_evaluation *evaluation, uint32_t i, dmb_spring_motion *m, int *mean)
{
    const dmb_scene_spring *spring = evaluation->sim->scene->springs + i;
    const int both = spring->law.acts == DMB_SPRING_BOTH;
    const double damper = both ? m->force.damper : 0.0, by_speed = both ? spring->law.damping : 0.0;
    const dmb_bounce law = {m->length - spring->free_length, m->rate, m->force.elastic + m->force.damper - damper};
    dmb_bounce_force own;
    if (!dmb_bounce_at(evaluation, dmb_bounce_of_spring(evaluation->sim->scene, i), &law, &own))
        return -m->force.damper * m->rate;
    *mean = 1;
    const dmb_spring_force force = {own.force, damper, own.by_place, by_speed};
    m->force = force;
    return own.heat - damper * m->rate;
}

/*     step                    force along the gradient of      part
 *     ---------------------   ------------------------------   ------------------------------
 *     without a mean force    the end of the step              elastic and damper
 *     with a mean force       start and end (mean_point)       elastic, and a damper of one side
 *                             the end of the step              a damper of both sides
 *
 * Power: the elastic part changes the potential by -tension l' - heat, the rest is heat of dampers. */
static void assemble_spring(dmb_evaluation *evaluation, uint32_t i)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_spring *spring = sim->scene->springs + i;
    dmb_spring_motion m, before;
    mean_point point[2];
    int mean = 0;
    dmb_spring_motion_of(sim->scene, &sim->trial, i, evaluation->dynamic, &m);
    double heat = -m.force.damper * m.rate;
    if (sim->scene->unilateral_count > 0) heat = take_own(evaluation, i, &m, &mean);
    const double tension = m.force.elastic + m.force.damper, at_end = mean ? m.force.damper : tension;
    if (mean) {
        mean_points_of(sim, i, &m, &before, point);
        pull_mean(sim, i, &m, point, m.force.elastic);
    }
    if (at_end != 0.0 || !mean) {
        pull(sim, &m.b, m.n, -at_end);
        pull(sim, &m.a, m.n, at_end);
    }
    count_rounding(evaluation, spring, &m);
    evaluation->power[DMB_POWER_POTENTIAL] -= tension * m.rate + heat;
    evaluation->power[DMB_POWER_DAMPING] += heat;
    if (evaluation->tangent) add_tangent(evaluation, spring, &m, mean ? point : NULL);
}

void dmb_spring_press_mean(dmb_sim *sim, uint32_t spring, double tension)
{
    dmb_spring_motion before, end;
    mean_point point[2];
    dmb_spring_motion_of(sim->scene, &sim->trial, spring, 0, &end);
    mean_points_of(sim, spring, &end, &before, point);
    pull_mean(sim, spring, &end, point, tension);
}

void dmb_spring_press(dmb_sim *sim, const dmb_configuration *at, uint32_t spring, double tension)
{
    dmb_spring_motion m;
    dmb_spring_motion_of(sim->scene, at, spring, 0, &m);
    pull(sim, &m.b, m.n, -tension);
    pull(sim, &m.a, m.n, tension);
}

void dmb_assemble_springs(dmb_evaluation *evaluation)
{
    for (uint32_t i = 0; i < evaluation->sim->scene->spring_count; i++) assemble_spring(evaluation, i);
}

double dmb_springs_energy(const dmb_scene *scene, const dmb_configuration *configuration)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->spring_count; i++) {
        const dmb_scene_spring *s = scene->springs + i;
        dmb_spring_motion m;
        dmb_spring_motion_of(scene, configuration, i, 0, &m);
        sum += dmb_spring_energy_at(&s->law, points_of(scene, s), m.length - s->free_length);
    }
    return sum;
}
