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
                      double sign, spring_tangent *t)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const double tension = m->force.elastic + m->force.damper;
    double line[6], signed_line[6], A[144];
    line_at(point, m->n, line);
    for (int i = 0; i < 6; i++) signed_line[i] = sign * line[i];
    dmb_force_tangent_row(scene, &t->sum, point, signed_line, t->gradient);
    dmb_point_map_tangent(scene, point, line, A);
    dmb_force_tangent_block(scene, &t->sum, point, sign * tension, A);
    add_turn(scene, point, line, sign * tension, t);
    if (evaluation->dynamic) add_rate(scene, point, line, sign, A, t);
}

static void add_tangent(dmb_evaluation *evaluation, const dmb_scene_spring *spring, const dmb_spring_motion *m)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const double by_elongation = m->force.by_elongation, by_speed = evaluation->dynamic ? m->force.by_speed : 0.0;
    double v[3];
    spring_tangent t;
    memset(t.gradient, 0, sizeof t - offsetof(spring_tangent, gradient));
    dmb_force_tangent_begin(&t.sum);
    dmb_force_tangent_touch(scene, &m->a, &t.sum);
    dmb_force_tangent_touch(scene, &m->b, &t.sum);
    dmb_force_tangent_clear(&t.sum);
    turn_of_line(scene, m, &t);
    add_point(evaluation, m, &m->b, 1.0, &t);
    add_point(evaluation, m, &m->a, -1.0, &t);
    relative_velocity(m, v);
    const uint32_t n = t.sum.columns;
    for (uint32_t c = 0; c < n && evaluation->dynamic; c++)
        for (int i = 0; i < 3; i++) t.rate[c] += v[i] * t.turn[i][c];
    for (uint32_t r = 0; r < n; r++)
        for (uint32_t c = 0; c < n; c++)
            t.sum.K[(size_t)r * n + c] += t.gradient[r] * (by_elongation * t.gradient[c] + by_speed * t.rate[c]);
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

/* Rounding of the length, a difference of large numbers, as for springs of joints (below). */
static void count_rounding(dmb_evaluation *evaluation, const dmb_scene_spring *spring, const dmb_spring_motion *m)
{
    const double reach = dmb_vec3_norm(spring->span) + dmb_vec3_norm(m->a.x) + dmb_vec3_norm(m->b.x);
    const double k = m->force.by_elongation * reach;
    if (!evaluation->dynamic || evaluation->extrapolated || evaluation->step == 0.0) evaluation->rounding += k * k;
}

/* Replaces the force of the law by the mean force in a step that has one; the damper of a two-sided spring stays.
 * Returns the dissipated power. */
static double take_own(dmb_evaluation *evaluation, uint32_t i, dmb_spring_motion *m)
{
    const dmb_scene_spring *spring = evaluation->sim->scene->springs + i;
    const int both = spring->law.acts == DMB_SPRING_BOTH;
    const double damper = both ? m->force.damper : 0.0, by_speed = both ? spring->law.damping : 0.0;
    const dmb_bounce law = {m->length - spring->free_length, m->rate, m->force.elastic + m->force.damper - damper};
    dmb_bounce_force own;
    if (!dmb_bounce_at(evaluation, dmb_bounce_of_spring(evaluation->sim->scene, i), &law, &own))
        return -m->force.damper * m->rate;
    const dmb_spring_force force = {own.force, damper, own.by_place, by_speed};
    m->force = force;
    return own.heat - damper * m->rate;
}

static void assemble_spring(dmb_evaluation *evaluation, uint32_t i)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_spring *spring = sim->scene->springs + i;
    dmb_spring_motion m;
    dmb_spring_motion_of(sim->scene, &sim->trial, i, evaluation->dynamic, &m);
    double heat = -m.force.damper * m.rate;
    if (sim->scene->unilateral_count > 0) heat = take_own(evaluation, i, &m);
    const double tension = m.force.elastic + m.force.damper;
    pull(sim, &m.b, m.n, -tension);
    pull(sim, &m.a, m.n, tension);
    count_rounding(evaluation, spring, &m);
    evaluation->power[DMB_POWER_POTENTIAL] -= tension * m.rate + heat;
    evaluation->power[DMB_POWER_DAMPING] += heat;
    if (evaluation->tangent) add_tangent(evaluation, spring, &m);
}

void dmb_spring_press(dmb_sim *sim, uint32_t spring, double tension)
{
    dmb_spring_motion m;
    dmb_spring_motion_of(sim->scene, &sim->trial, spring, 0, &m);
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

/* ---- Joints: springs, dampers, stops, friction, drives, forces of constraint ------------------------------------- */

/* Forces on the six coordinates, their derivatives, and their points of action. */
typedef struct coordinate_forces {
    dmb_relative relative;
    dmb_joint_coordinates c;
    double speed[6];
    double force[6], by_position[6], by_speed[6];
} coordinate_forces;

static int has_forces(const dmb_sim *sim, const dmb_scene_joint *joint, uint32_t j)
{
    return (joint->law != DMB_NONE || joint->drive_count > 0) && sim->joint_state[j] != DMB_JOINT_OPEN;
}

static void begin(const dmb_evaluation *evaluation, uint32_t j, coordinate_forces *f)
{
    memset(f, 0, sizeof *f);
    dmb_joint_motion_of(evaluation->sim->scene, &evaluation->sim->trial, j, &f->relative, NULL);
    dmb_joint_coordinates_in(evaluation, j, &f->relative, &f->c);
    for (int i = 0; i < 6; i++) f->speed[i] = evaluation->dynamic ? dmb_vec6_dot(f->c.J[i], f->relative.V) : 0.0;
}

static double largest_place(const dmb_sim *sim, const dmb_scene_frame *frame)
{
    const double *u = sim->trial.displacement;
    return frame->node == DMB_NONE ? dmb_vec3_norm(frame->x)
                                   : dmb_vec3_norm(frame->x) + dmb_vec3_norm(u + 3 * (size_t)frame->node);
}

/* [N] Change of the force on coordinate i if the numbers whose difference is the coordinate change by their own size;
 * moments as forces at the length scale. */
static double stiffness_times_reach(const dmb_sim *sim, const dmb_scene_joint *joint, int i, double by_position)
{
    if (i >= 3) return by_position / sim->scene->length_scale;
    return by_position * (dmb_vec3_norm(joint->span) + largest_place(sim, &joint->a) + largest_place(sim, &joint->b));
}

/* 1: rounding of stiff springs counts. Before the first correction of a step, a residual of the size of a stiff
 * spring's rounding may be that of a soft part, which would then move without its force; one correction places it
 * correctly. Without a step, as in linearisations, rounding always counts. */
static int rounding_counts(const dmb_evaluation *evaluation)
{
    return !evaluation->dynamic || evaluation->extrapolated || evaluation->step == 0.0;
}

/* Mean force of the stop of coordinate i. */
static void take_own_stop(dmb_evaluation *evaluation, uint32_t u, const coordinate_forces *f, int i,
                          dmb_joint_force *law)
{
    dmb_joint_law bare = evaluation->sim->scene->laws[u];
    const dmb_bounce stop = {f->c.value[i], f->speed[i], -(law->stop + law->stop_damper)};
    dmb_bounce_force own;
    if (!dmb_bounce_at(evaluation, u, &stop, &own)) return;
    bare.stop_stiffness = 0.0;
    dmb_joint_force_at(&bare, f->c.value[i], f->speed[i], law);
    law->stop = -own.force;
    law->force -= own.force;
    law->by_position -= own.by_place;
    evaluation->power[DMB_POWER_POTENTIAL] -= own.heat;
    evaluation->power[DMB_POWER_IMPACT] += own.heat;
}

/* Springs, dampers, stops and friction of each coordinate c: f(c, c'), its two derivatives and the powers f c'. */
static void add_laws(dmb_evaluation *evaluation, const dmb_scene_joint *joint, coordinate_forces *f)
{
    for (int i = 0; i < 6; i++) {
        dmb_joint_force law;
        if (joint->law == DMB_NONE || (joint->law_mask >> i & 1) == 0) continue;
        dmb_joint_force_at(evaluation->sim->scene->laws + joint->law + i, f->c.value[i], f->speed[i], &law);
        if (evaluation->sim->scene->unilateral_count > 0)
            take_own_stop(evaluation, joint->law + (uint32_t)i, f, i, &law);
        f->force[i] += law.force;
        f->by_position[i] += law.by_position;
        f->by_speed[i] += law.by_speed;
        const double k = stiffness_times_reach(evaluation->sim, joint, i, law.by_position);
        if (rounding_counts(evaluation)) evaluation->rounding += k * k;
        evaluation->power[DMB_POWER_POTENTIAL] += (law.spring + law.stop) * f->speed[i];
        evaluation->power[DMB_POWER_DAMPING] += law.damper * f->speed[i];
        evaluation->power[DMB_POWER_FRICTION] += law.friction * f->speed[i];
        evaluation->power[DMB_POWER_IMPACT] += law.stop_damper * f->speed[i];
        evaluation->sim->trial.law_speed[joint->law + (uint32_t)i] = f->speed[i];
    }
}

/* Forces of drives in load or speed control; motion drives are equations (system/constrain). */
static void add_drives(dmb_evaluation *evaluation, uint32_t j, coordinate_forces *f)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_joint *joint = sim->scene->joints + j;
    for (uint32_t i = joint->first_drive; i < joint->first_drive + joint->drive_count; i++) {
        const uint32_t d = sim->scene->joint_drives[i];
        const dmb_scene_drive *drive = sim->scene->drives + d;
        double slope;
        dmb_drive_on_joint(sim, d, f->c.value[drive->component], f->speed[drive->component], 0);
        if (drive->kind == DMB_DRIVE_MOTION) continue;
        const double force = dmb_drive_force(evaluation, d, f->speed[drive->component], &slope);
        f->force[drive->component] += force;
        f->by_speed[drive->component] += evaluation->dynamic ? slope : 0.0;
        evaluation->power[DMB_POWER_DRIVES] += force * f->speed[drive->component];
    }
}

/* Drives of an open joint have no force, and track its coordinate. */
static void rest_drives(dmb_evaluation *evaluation, uint32_t j)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_joint *joint = sim->scene->joints + j;
    coordinate_forces f;
    if (joint->drive_count == 0) return;
    begin(evaluation, j, &f);
    for (uint32_t i = joint->first_drive; i < joint->first_drive + joint->drive_count; i++) {
        const uint32_t d = sim->scene->joint_drives[i];
        const dmb_scene_drive *drive = sim->scene->drives + d;
        dmb_drive_on_joint(sim, d, f.c.value[drive->component], f.speed[drive->component], 1);
    }
}

static void apply(dmb_evaluation *evaluation, const dmb_scene_joint *joint, const coordinate_forces *f)
{
    double w[6] = {0.0}, wa[6], wb[6];
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++) w[k] += f->force[i] * f->c.J[i][k];
    dmb_relative_pull_back(&f->relative, w, wa, wb);
    dmb_apply_wrench(evaluation->sim, joint->b.node, wb);
    if (joint->a.node != DMB_NONE) dmb_apply_wrench(evaluation->sim, joint->a.node, wa);
}

/* -d(J^T f)/dq: W of the gradients and J^T f' J. */
static void add_position_tangent(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                                 const coordinate_forces *f, double *K)
{
    double w[6] = {0.0}, W[36], minus[6];
    for (int i = 0; i < 6; i++) minus[i] = -f->force[i];
    dmb_joint_coordinates_tangent(f->relative.R, f->relative.p, minus, W);
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 6; k++) w[k] += minus[i] * f->c.J[i][k];
        dmb_mat6_add_outer(-f->by_position[i], f->c.J[i], f->c.J[i], W);
    }
    dmb_add_joint_tangent(scene, constraint, j, &f->relative, w, W, K);
}

static void add_speed_tangent(dmb_evaluation *evaluation, const dmb_constraint *constraint, uint32_t j,
                              const coordinate_forces *f, double *K)
{
    const uint32_t n = constraint->columns;
    for (int i = 0; i < 6; i++) {
        double row[DMB_CONSTRAINT_COLUMNS] = {0.0};
        const double factor = -evaluation->velocity_factor * f->by_speed[i];
        if (factor == 0.0) continue;
        dmb_add_joint_row(evaluation->sim->scene, constraint, j, &f->relative, 1.0, f->c.J[i], row);
        for (uint32_t r = 0; r < n; r++)
            for (uint32_t s = 0; s < n; s++) K[(size_t)r * n + s] += factor * row[r] * row[s];
    }
}

/* K <- K T6 in the columns of six-DOF nodes, as for the blocks of the nodes. */
static void to_parameters(const dmb_evaluation *evaluation, const dmb_constraint *constraint, double *K)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    if (!evaluation->dynamic) return;
    for (uint32_t i = 0; i < constraint->node_count; i++) {
        const uint32_t node = constraint->node[i];
        dmb_se3_tangent T;
        if (scene->layout.size[node] != DMB_NODE_SIX_DOF) continue;
        dmb_se3_tangent_at(sim->increment + scene->layout.row[node], NULL, &T);
        for (uint32_t r = 0; r < constraint->columns; r++) {
            double *row = K + (size_t)r * constraint->columns + constraint->column[i];
            dmb_se3_tangent_apply_transpose(&T, row, row);
        }
    }
}

/* The tangent by speeds already is with respect to parameters. */
static void add_joint_tangent(dmb_evaluation *evaluation, uint32_t j, const coordinate_forces *f)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const dmb_constraint *constraint = scene->constraints + scene->joints[j].constraint;
    double *K = evaluation->sim->constraint_tangent + constraint->tangent;
    add_position_tangent(scene, constraint, j, f, K);
    to_parameters(evaluation, constraint, K);
    if (evaluation->dynamic) add_speed_tangent(evaluation, constraint, j, f, K);
}

void dmb_joint_press(dmb_evaluation *evaluation, uint32_t j, uint32_t component, double force)
{
    coordinate_forces f;
    begin(evaluation, j, &f);
    f.force[component] = -force;
    apply(evaluation, evaluation->sim->scene->joints + j, &f);
}

/* Laws of an open joint have no force and no speed: a speed kept from before the opening would belong to an earlier
 * step, and would differ after a restored state. */
static void rest_laws(dmb_sim *sim, const dmb_scene_joint *joint)
{
    if (joint->law == DMB_NONE) return;
    for (uint32_t i = 0; i < 6; i++) {
        sim->trial.law_speed[joint->law + i] = 0.0;
        if (sim->scene->unilateral_count > 0) dmb_bounce_rest(sim, joint->law + i);
    }
}

static void assemble_forces(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        coordinate_forces f;
        if (evaluation->sim->joint_state[j] == DMB_JOINT_OPEN) {
            rest_drives(evaluation, j);
            rest_laws(evaluation->sim, joint);
        }
        if (!has_forces(evaluation->sim, joint, j)) continue;
        begin(evaluation, j, &f);
        add_laws(evaluation, joint, &f);
        add_drives(evaluation, j, &f);
        apply(evaluation, joint, &f);
        if (evaluation->tangent) add_joint_tangent(evaluation, j, &f);
    }
}

/* Adds the curvature of the equations to the tangents of the forces. */
static int32_t gather_curvatures(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < scene->constraint_count && status >= 0; i++) {
        const dmb_constraint *constraint = scene->constraints + i;
        const size_t size = (size_t)constraint->columns * constraint->columns;
        double K[DMB_CONSTRAINT_COLUMNS * DMB_CONSTRAINT_COLUMNS];
        memset(K, 0, size * sizeof(double));
        status = dmb_constraint_curvature(evaluation, i, K);
        to_parameters(evaluation, constraint, K);
        for (size_t k = 0; k < size; k++) sim->constraint_tangent[constraint->tangent + k] += K[k];
    }
    return status;
}

int32_t dmb_assemble_joints(dmb_evaluation *evaluation)
{
    assemble_forces(evaluation);
    dmb_clusters_balance(evaluation);
    return evaluation->tangent ? gather_curvatures(evaluation) : DMB_OK;
}
