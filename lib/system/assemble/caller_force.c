/* Forces of the caller's functions in the residual and its tangent (eq:motion.caller-force). Order of one force:
 *
 *     read_arguments   poses, twists and joint coordinates of the trial, in the axes that the function asks for
 *     dmb_caller_ask   wrenches, and for a tangent A and B by those arguments (caller_force_call.c)
 *     to_axes          wrenches into the axes of the places
 *     apply            L^T w on the nodes
 *     add_power        power, that of the potential apart
 *     add_tangent      A and B into the axes of the places, then onto the nodes: -L^T (A L + B dV/dq) - d(L^T) w */
#include "system/assemble/caller_force.h"

#include <string.h>

#include "math/mat6.h"
#include "math/so3.h"
#include "system/constrain/constrain.h"

#define DMB_STEP_CHECK 1e-3 /* [s] at which the tangent of a law with a state is compared, besides 0 */

/* An argument: a place, or a joint's coordinate. */
typedef struct argument {
    union { /* a union, because four of both need 3 kB more stack */
        dmb_point_motion point;
        struct {
            dmb_relative relative;
            dmb_joint_coordinates c;
        };
    };
    uint32_t joint; /* DMB_NONE: a place */
    int32_t component;
    int open; /* the joint is open: its coordinate is an argument, but its force is ignored */
} argument;

/* ---- From the scene to the question ------------------------------------------------------------------------------ */

/* Without rates, in statics, velocities are 0 whatever the state has. */
static void read_place(const dmb_scene *scene, const dmb_configuration *c, int rates, uint32_t i, argument *a,
                       dmb_caller_question *ask)
{
    const dmb_scene_force *force = ask->force;
    dmb_point_motion_of(scene, c, force->point + i, &a->point);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)a->point.node[0], a->point.x, ask->x[i]);
    dmb_mat3_copy(a->point.R, ask->R[i]);
    for (int k = 0; k < 6 && !rates; k++) a->point.V[k] = 0.0;
    for (int k = 0; k < 12 && !rates; k++) a->point.v[k] = 0.0;
    dmb_vec6_copy(a->point.V, ask->v[i]);
    if (force->frame == DMB_FRAME_BODY) return;
    dmb_mat3_vec(a->point.R, ask->v[i], ask->v[i]);
    dmb_mat3_vec(a->point.R, ask->v[i] + 3, ask->v[i] + 3);
}

static void read_joint(const dmb_sim *sim, const dmb_configuration *c, int rates, uint32_t i, argument *a,
                       dmb_caller_question *ask)
{
    dmb_joint_motion_of(sim->scene, c, a->joint, &a->relative, NULL);
    dmb_joint_coordinates_at(a->relative.R, a->relative.p, a->relative.V, sim->now.joint_turn + 2 * a->joint, &a->c);
    a->open = sim->joint_state[a->joint] == DMB_JOINT_OPEN;
    dmb_mat3_identity(ask->R[i]);
    ask->x[i][0] = a->c.value[a->component];
    if (rates) ask->v[i][0] = dmb_vec6_dot(a->c.J[a->component], a->relative.V);
}

/* Arguments of ask->force at ask->time. */
static void read_arguments(const dmb_sim *sim, const dmb_configuration *c, int rates, argument a[DMB_CONSTRAINT_PLACES],
                           dmb_caller_question *ask)
{
    for (uint32_t i = 0; i < ask->force->count; i++) {
        a[i].joint = ask->force->joint[i];
        a[i].component = ask->force->component[i];
        a[i].open = 0;
        if (dmb_caller_is_place(ask->force, i))
            read_place(sim->scene, c, rates, i, a + i, ask);
        else
            read_joint(sim, c, rates, i, a + i, ask);
    }
}

/* Transforms wrenches to the axes of the places. */
static void to_axes(const dmb_caller_question *ask, const argument *a, dmb_caller_answer *to)
{
    for (uint32_t i = 0; i < ask->force->count; i++) {
        if (!dmb_caller_is_place(ask->force, i)) {
            const double q = a[i].open ? 0.0 : to->at.f[i][0];
            memset(to->at.f[i], 0, sizeof to->at.f[i]);
            to->at.f[i][0] = q;
        } else if (ask->force->frame != DMB_FRAME_BODY) {
            dmb_mat3_tvec(ask->R[i], to->at.f[i], to->at.f[i]);
            dmb_mat3_tvec(ask->R[i], to->at.f[i] + 3, to->at.f[i] + 3);
        }
    }
}

/* ---- Tangent in the axes of the places --------------------------------------------------------------------------- */

static void get_block(const dmb_caller_matrix M, uint32_t r, uint32_t c, double block[9])
{
    for (uint32_t k = 0; k < 9; k++) block[k] = M[3 * r + k / 3][3 * c + k % 3];
}

static void add_block(const double block[9], double factor, uint32_t r, uint32_t c, dmb_caller_matrix M)
{
    for (uint32_t k = 0; k < 9; k++) M[3 * r + k / 3][3 * c + k % 3] += factor * block[k];
}

/* M <- R^T M R block by block; r, c count blocks of three. First terms of A and B for forces given in world axes (head
 * of caller_force.h). */
static void turn_matrix(const dmb_caller_question *ask, dmb_caller_matrix M)
{
    const uint32_t blocks = 2 * ask->force->count;
    for (uint32_t r = 0; r < blocks; r++)
        for (uint32_t c = 0; c < blocks; c++) {
            double block[9], half[9];
            get_block((const double(*)[DMB_CALLER_WIDE])M, r, c, block);
            add_block(block, -1.0, r, c, M);
            dmb_mat3_mul_tn(ask->R[r / 2], block, half);
            dmb_mat3_mul(half, ask->R[c / 2], block);
            add_block(block, 1.0, r, c, M);
        }
}

/* B (z_r x V) = -B V~ z_r, and w x z_r = w~ z_r; f: wrenches in the axes of the places. The remaining terms of A for
 * such forces: in the axes of the place, velocity and wrench turn back by the rotation z_r of the place. */
static void add_turning(const dmb_caller_question *ask, const argument *a, dmb_caller_answer *to)
{
    const uint32_t blocks = 2 * ask->force->count;
    for (uint32_t i = 0; i < ask->force->count; i++) {
        double skew[9], block[9], product[9];
        if (!dmb_caller_is_place(ask->force, i)) continue;
        for (uint32_t r = 0; r < blocks; r++)
            for (uint32_t part = 0; part < 2; part++) {
                dmb_skew(a[i].point.V + 3 * part, skew);
                get_block((const double(*)[DMB_CALLER_WIDE])to->B, r, 2 * i + part, block);
                dmb_mat3_mul(block, skew, product);
                add_block(product, -1.0, r, 2 * i + 1, to->A);
            }
        for (uint32_t part = 0; part < 2; part++) {
            dmb_skew(to->at.f[i] + 3 * part, skew);
            add_block(skew, 1.0, 2 * i + part, 2 * i + 1, to->A);
        }
    }
}

/* Clears the force on the coordinate of an open joint. */
static void clear_open(const dmb_caller_question *ask, const argument *a, dmb_caller_answer *to)
{
    for (uint32_t i = 0; i < ask->force->count; i++)
        for (uint32_t c = 0; a[i].joint != DMB_NONE && c < DMB_CALLER_WIDE; c++)
            for (uint32_t k = a[i].open ? 0 : 1; k < 6; k++) to->A[6 * i + k][c] = to->B[6 * i + k][c] = 0.0;
}

/* ---- Onto the nodes ---------------------------------------------------------------------------------------------- */

typedef double wide_row[DMB_CONSTRAINT_COLUMNS];

typedef struct caller_tangent {
    dmb_force_tangent sum;
    wide_row L[DMB_CALLER_WIDE];    /* of V by the nodes' velocities, and of z by their displacements */
    wide_row rate[DMB_CALLER_WIDE]; /* of V by displacements at constant velocities of the nodes */
} caller_tangent;

static void read_nodes(const dmb_scene *scene, const dmb_scene_force *force, const argument *a, dmb_force_tangent *t)
{
    dmb_force_tangent_begin(t);
    if (force->constraint != DMB_NONE) {
        const dmb_constraint *constraint = scene->constraints + force->constraint;
        t->nodes = constraint->node_count;
        t->columns = constraint->columns;
        memcpy(t->node, constraint->node, sizeof t->node);
        memcpy(t->column, constraint->column, sizeof t->column);
    } else {
        for (uint32_t i = 0; i < force->count; i++) dmb_force_tangent_touch(scene, &a[i].point, t);
    }
    dmb_force_tangent_clear(t);
}

/* V of a point inside an element also changes by its map: v^T d(map^T e_k). */
static void fill_rows(const dmb_scene *scene, const dmb_scene_force *force, const argument *a, uint32_t i,
                      caller_tangent *t)
{
    if (!dmb_caller_is_place(force, i)) {
        dmb_add_joint_row(scene, scene->constraints + force->constraint, a->joint, &a->relative, 1.0,
                          a->c.J[a->component], t->L[6 * i]);
        return;
    }
    for (uint32_t k = 0; k < 6; k++) {
        double e[6] = {0.0}, K[144], change[12] = {0.0};
        e[k] = 1.0;
        dmb_force_tangent_row(scene, &t->sum, &a->point, e, t->L[6 * i + k]);
        if (a->point.nodes < 2) continue;
        dmb_point_map_tangent(scene, &a->point, e, K);
        for (uint32_t r = 0; r < 12; r++)
            for (uint32_t c = 0; c < 12; c++) change[c] += a->point.v[r] * K[12 * r + c];
        dmb_force_tangent_columns(scene, &t->sum, &a->point, change, t->rate[6 * i + k]);
    }
}

/* -d(L^T) w */
static void add_geometric(const dmb_scene *scene, const dmb_scene_force *force, const argument *a, const double f[6],
                          dmb_force_tangent *t)
{
    double K[144], minus[6] = {0.0}, w[6], W[36];
    if (a->joint == DMB_NONE) {
        dmb_point_map_tangent(scene, &a->point, f, K);
        dmb_force_tangent_block(scene, t, &a->point, -1.0, K);
        return;
    }
    minus[a->component] = -f[0];
    dmb_joint_coordinates_tangent(a->relative.R, a->relative.p, minus, W);
    for (int k = 0; k < 6; k++) w[k] = -f[0] * a->c.J[a->component][k];
    dmb_add_joint_tangent(scene, scene->constraints + force->constraint, a->joint, &a->relative, w, W, t->K);
}

/* K -= L^T (M L + N rate); N NULL: without N rate */
static void add_products(const dmb_caller_matrix M, const dmb_caller_matrix *N, uint32_t rows, caller_tangent *t)
{
    const uint32_t n = t->sum.columns;
    for (uint32_t r = 0; r < rows; r++) {
        wide_row product = {0.0};
        for (uint32_t k = 0; k < rows; k++)
            for (uint32_t c = 0; c < n; c++)
                product[c] += M[r][k] * t->L[k][c] + (N != NULL ? (*N)[r][k] * t->rate[k][c] : 0.0);
        for (uint32_t i = 0; i < n; i++)
            for (uint32_t c = 0; c < n; c++) t->sum.K[(size_t)i * n + c] -= t->L[r][i] * product[c];
    }
}

/* First the tangent by displacements, with A and B, then the one by velocities, with B alone (dmb_force_tangent_add).
 */
static void add_tangent(const dmb_evaluation *evaluation, const dmb_caller_question *ask, const argument *a,
                        dmb_caller_answer *to)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const dmb_scene_force *force = ask->force;
    caller_tangent t;
    memset(t.L, 0, sizeof t.L);
    memset(t.rate, 0, sizeof t.rate);
    read_nodes(scene, force, a, &t.sum);
    if (force->frame != DMB_FRAME_BODY) {
        turn_matrix(ask, to->A);
        turn_matrix(ask, to->B);
        add_turning(ask, a, to);
    }
    clear_open(ask, a, to);
    for (uint32_t i = 0; i < force->count; i++) {
        fill_rows(scene, force, a + i, i, &t);
        add_geometric(scene, force, a + i, to->at.f[i], &t.sum);
    }
    add_products((const double(*)[DMB_CALLER_WIDE])to->A, (const dmb_caller_matrix *)&to->B, 6 * force->count, &t);
    dmb_force_tangent_add(evaluation, force->constraint, DMB_BY_DISPLACEMENT, &t.sum);
    dmb_force_tangent_clear(&t.sum);
    add_products((const double(*)[DMB_CALLER_WIDE])to->B, NULL, 6 * force->count, &t);
    dmb_force_tangent_add(evaluation, force->constraint, DMB_BY_VELOCITY, &t.sum);
}

static void apply(dmb_sim *sim, const argument *a, const double f[6])
{
    const dmb_scene_joint *joint;
    double w[6], wa[6], wb[6];
    if (a->joint == DMB_NONE) {
        dmb_point_apply(sim, &a->point, f);
        return;
    }
    joint = sim->scene->joints + a->joint;
    for (int k = 0; k < 6; k++) w[k] = f[0] * a->c.J[a->component][k];
    dmb_relative_pull_back(&a->relative, w, wa, wb);
    dmb_apply_wrench(sim, joint->b.node, wb);
    if (joint->a.node != DMB_NONE) dmb_apply_wrench(sim, joint->a.node, wa);
}

/* Adds the powers: the rate of the potential to potential forces, the remainder to loads. dU/dt along the motion
 * includes its explicit dependence on time; the power that the potential does not explain is work of a load. */
static int32_t add_power(dmb_evaluation *evaluation, const dmb_caller_question *ask, const argument *a,
                         const dmb_caller_answer *to)
{
    double power = 0.0, rate = 0.0;
    if (!evaluation->dynamic) return DMB_OK;
    for (uint32_t i = 0; i < ask->force->count; i++)
        power += dmb_caller_is_place(ask->force, i) ? dmb_vec6_dot(to->at.f[i], a[i].point.V)
                                                    : to->at.f[i][0] * ask->v[i][0];
    if (ask->force->provides & DMB_PROVIDES_POTENTIAL && dmb_caller_potential_rate(ask, &rate) < 0)
        return DMB_ERR_CALLBACK;
    evaluation->power[DMB_POWER_POTENTIAL] -= rate;
    evaluation->power[DMB_POWER_LOADS] += power + rate;
    return DMB_OK;
}

/* The question without its arguments. Trial and work fields are written. */
static void begin(dmb_sim *sim, uint32_t i, double time, dmb_caller_question *ask)
{
    memset(ask, 0, sizeof *ask);
    ask->force = sim->scene->forces + i;
    ask->time = time;
    ask->accepted = sim->now.force_state + ask->force->state;
    ask->trial = sim->trial.force_state + ask->force->state;
    ask->spare = sim->force_spare;
}

static int32_t assemble_force(dmb_evaluation *evaluation, uint32_t i)
{
    dmb_sim *sim = evaluation->sim;
    argument a[DMB_CONSTRAINT_PLACES];
    dmb_caller_question ask;
    dmb_caller_answer to;
    begin(sim, i, evaluation->time, &ask);
    ask.step = evaluation->dynamic ? evaluation->step : 0.0;
    read_arguments(sim, &sim->trial, evaluation->dynamic, a, &ask);
    int32_t status = dmb_caller_ask(&ask, evaluation->tangent, &to);
    if (status < 0) return status;
    to_axes(&ask, a, &to);
    sim->trial.force_potential[i] = to.at.potential;
    for (uint32_t k = 0; k < ask.force->count; k++) apply(sim, a + k, to.at.f[k]);
    status = add_power(evaluation, &ask, a, &to);
    if (status >= 0 && evaluation->tangent) add_tangent(evaluation, &ask, a, &to);
    return status;
}

int32_t dmb_assemble_caller_forces(dmb_evaluation *evaluation)
{
    for (uint32_t i = 0; i < evaluation->sim->scene->force_count; i++)
        if (assemble_force(evaluation, i) < 0) {
            evaluation->sim->reduced_mode->force = 1 + i;
            return DMB_ERR_CALLBACK;
        }
    return DMB_OK;
}

int dmb_failed_force(dmb_sim *sim, dmb_message *text)
{
    const uint32_t force = sim->reduced_mode->force;
    sim->reduced_mode->force = 0;
    if (force == 0) return 0;
    if (force > sim->scene->force_count)
        dmb_message_set(text, "friction_callback of the wall");
    else
        (void)dmb_part_text(text, "force", force - 1, sim->scene->forces[force - 1].name, 24);
    return 1;
}

double dmb_caller_forces_energy(const dmb_scene *scene, const dmb_configuration *configuration)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->force_count; i++) sum += configuration->force_potential[i];
    return sum;
}

/* A law with a state is compared at step length 0 and at one with which its state moves: both parts of the total
 * derivative. */
int32_t dmb_caller_force_check(dmb_sim *sim, uint32_t force)
{
    argument a[DMB_CONSTRAINT_PLACES];
    dmb_caller_question ask;
    dmb_message owner;
    begin(sim, force, sim->clock->time, &ask);
    read_arguments(sim, &sim->now, 1, a, &ask);
    if (!(ask.force->provides & DMB_PROVIDES_TANGENT)) return DMB_OK;
    (void)dmb_part_text(&owner, "force", force, ask.force->name, 24);
    const int32_t status = dmb_caller_compare(&ask, owner.text, &sim->message);
    ask.step = DMB_STEP_CHECK;
    return status < 0 || ask.force->states == 0 ? status : dmb_caller_compare(&ask, owner.text, &sim->message);
}

void dmb_caller_laws_accept(const dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->force_count; i++) {
        const dmb_scene_force *force = sim->scene->forces + i;
        if (force->accept != NULL)
            force->accept(force->context, sim->clock->time, 0, sim->now.force_state + force->state);
    }
}
