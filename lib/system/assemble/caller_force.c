#include "system/assemble/caller_force.h"

#include <string.h>

#include "math/mat6.h"
#include "math/so3.h"
#include "system/constrain/constraint_rows.h"

#define DMB_MOTION_STEP 3e-4   /* [m, rad; s] of derivatives of a potential along the motion */
#define DMB_TANGENT_CHECK 1e-4 /* largest difference of a given tangent from differences, over its row's size */

enum { PLACES = DMB_CONSTRAINT_PLACES, WIDE = 6 * PLACES };

/* Weights of f at -2h, -h, h, 2h for f' h. */
static const double first_weight[4] = {1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};
static const double places_of_weight[4] = {-2.0, -1.0, 1.0, 2.0};

typedef double matrix[WIDE][WIDE];

/* Arguments of a callback: poses in the world, velocities in the axes that it asks for; of a joint its coordinate in
 * x[0] and v[0]. */
typedef struct question {
    const dmb_scene_force *force;
    double time;
    double R[PLACES][9], x[PLACES][3], v[PLACES][6];
} question;

typedef struct values {
    double f[PLACES][6]; /* [N, N m] in the same axes */
    double potential;    /* [J] 0 where none is given */
} values;

typedef struct answer {
    values at;
    union {
        struct {
            matrix A, B; /* by displacements and velocities in those axes */
        };
        double given[2 * WIDE * WIDE]; /* the same as a callback gives them, row by row as long as the count asks for */
    };
} answer;

/* An argument: a place, or a joint's coordinate. */
typedef struct argument {
    union { /* one or the other: four of both are 3 kB more of stack */
        dmb_point_motion point;
        struct {
            dmb_relative relative;
            dmb_joint_coordinates c;
        };
    };
    uint32_t joint; /* DMB_NONE: a place */
    int32_t component;
    int open; /* the joint is: its coordinate is told, but nothing acts */
} argument;

/* ---- Asking ------------------------------------------------------------------------------------------------------ */

static int is_place(const dmb_scene_force *force, uint32_t i)
{
    return force->joint[i] == DMB_NONE;
}

/* tangent: shape (2, 6 count, 6 count), or NULL */
static int32_t call(const question *ask, values *to, double *tangent)
{
    const dmb_scene_force *force = ask->force;
    double poses[PLACES][12], sum = 0.0;
    memset(to->f, 0, sizeof to->f);
    to->potential = 0.0;
    for (uint32_t i = 0; i < force->count; i++) {
        dmb_vec3_copy(ask->x[i], poses[i]);
        dmb_mat3_copy(ask->R[i], poses[i] + 3);
    }
    if (force->callback(force->context, ask->time, force->count, (const double(*)[12])poses, (const double(*)[6])ask->v,
                        to->f, tangent, &to->potential) != 0)
        return DMB_ERR_CALLBACK;
    for (uint32_t i = 0; i < force->count; i++)
        for (int k = 0; k < 6; k++) sum += fabs(to->f[i][k]);
    if (!(force->provides & DMB_PROVIDES_POTENTIAL)) to->potential = 0.0;
    return sum + fabs(to->potential) <= DMB_CALLBACK_MAX ? DMB_OK : DMB_ERR_CALLBACK; /* nor is a NaN */
}

/* The pose of place i displaced by s along component c of the axes that are asked for. */
static void displace(question *ask, uint32_t i, uint32_t c, double s)
{
    double e[3] = {0.0}, turn[9], R[9];
    if (!is_place(ask->force, i)) {
        if (c == 0) ask->x[i][0] += s;
        return;
    }
    e[c % 3] = s;
    if (c < 3) {
        if (ask->force->frame == DMB_FRAME_BODY) dmb_mat3_vec(ask->R[i], e, e);
        dmb_vec3_add(ask->x[i], e, ask->x[i]);
        return;
    }
    dmb_so3_exp(e, NULL, turn);
    if (ask->force->frame == DMB_FRAME_BODY)
        dmb_mat3_mul(ask->R[i], turn, R);
    else
        dmb_mat3_mul(turn, ask->R[i], R);
    dmb_mat3_copy(R, ask->R[i]);
}

static int32_t tangent_by_differences(const question *ask, matrix A, matrix B)
{
    const uint32_t n = 6 * ask->force->count;
    values there;
    memset(A, 0, sizeof(matrix));
    memset(B, 0, sizeof(matrix));
    for (uint32_t c = 0; c < 2 * n; c++)
        for (int k = 0; k < 4; k++) {
            const int by_speed = c >= n;
            const uint32_t column = by_speed ? c - n : c, i = column / 6;
            const double step = by_speed ? ask->force->speed_step : ask->force->pose_step;
            question moved = *ask;
            if (!is_place(ask->force, i) && column % 6 != 0) continue;
            if (by_speed)
                moved.v[i][column % 6] += places_of_weight[k] * step;
            else
                displace(&moved, i, column % 6, places_of_weight[k] * step);
            if (call(&moved, &there, NULL) < 0) return DMB_ERR_CALLBACK;
            for (uint32_t r = 0; r < n; r++)
                (by_speed ? B : A)[r][column] += first_weight[k] * there.f[r / 6][r % 6] / step;
        }
    return DMB_OK;
}

/* In place: entries move up, the last first, so that none is lost. A second copy would be the largest on the stack. */
static int32_t given_tangent(const question *ask, answer *to)
{
    const uint32_t n = 6 * ask->force->count;
    double sum = 0.0;
    memset(to->given, 0, sizeof to->given);
    if (call(ask, &to->at, to->given) < 0) return DMB_ERR_CALLBACK;
    for (uint32_t k = 0; k < 2 * n * n; k++) sum += fabs(to->given[k]);
    for (uint32_t k = 2 * n * n; k-- > 0;) {
        const uint32_t half = k / (n * n), r = k % (n * n) / n, c = k % n;
        to->given[WIDE * (WIDE * half + r) + c] = to->given[k];
    }
    return sum <= DMB_CALLBACK_MAX ? DMB_OK : DMB_ERR_CALLBACK;
}

static int32_t ask_all(const question *ask, int tangent, answer *to)
{
    if (tangent && ask->force->provides & DMB_PROVIDES_TANGENT) return given_tangent(ask, to);
    const int32_t status = call(ask, &to->at, NULL);
    return status < 0 || !tangent ? status : tangent_by_differences(ask, to->A, to->B);
}

/* [W] dU/dt along the motion, time included. */
static int32_t potential_rate(const question *ask, double *rate)
{
    double fastest = 1.0;
    *rate = 0.0;
    for (uint32_t i = 0; i < ask->force->count; i++)
        for (int k = 0; k < 6; k++) fastest = fmax(fastest, fabs(ask->v[i][k]));
    const double h = DMB_MOTION_STEP / fastest;
    for (int k = 0; k < 4; k++) {
        const double s = places_of_weight[k] * h;
        question moved = *ask;
        values there;
        moved.time += s;
        for (uint32_t i = 0; i < ask->force->count; i++) {
            const double *v = ask->v[i], turn[3] = {s * v[3], s * v[4], s * v[5]};
            double move[3] = {s * v[0], s * v[1], s * v[2]}, Q[9], R[9];
            if (!is_place(ask->force, i)) {
                moved.x[i][0] += move[0];
                continue;
            }
            const int body = ask->force->frame == DMB_FRAME_BODY;
            if (body) dmb_mat3_vec(ask->R[i], move, move);
            dmb_vec3_add(moved.x[i], move, moved.x[i]);
            dmb_so3_exp(turn, NULL, Q);
            dmb_mat3_mul(body ? ask->R[i] : Q, body ? Q : ask->R[i], R);
            dmb_mat3_copy(R, moved.R[i]);
        }
        if (call(&moved, &there, NULL) < 0) return DMB_ERR_CALLBACK;
        *rate += first_weight[k] * there.potential / h;
    }
    return DMB_OK;
}

/* ---- From the scene to the question ------------------------------------------------------------------------------ */

static void take_place(const dmb_scene *scene, const dmb_configuration *c, int rates, uint32_t i, argument *a,
                       question *ask)
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

static void take_joint(const dmb_sim *sim, const dmb_configuration *c, int rates, uint32_t i, argument *a,
                       question *ask)
{
    dmb_joint_motion_of(sim->scene, c, a->joint, &a->relative, NULL);
    dmb_joint_coordinates_at(a->relative.R, a->relative.p, a->relative.V, sim->now.joint_turn + 2 * a->joint, &a->c);
    a->open = sim->joint_state[a->joint] == DMB_JOINT_OPEN;
    dmb_mat3_identity(ask->R[i]);
    ask->x[i][0] = a->c.value[a->component];
    if (rates) ask->v[i][0] = dmb_vec6_dot(a->c.J[a->component], a->relative.V);
}

/* Arguments of ask->force at ask->time. */
static void take_arguments(const dmb_sim *sim, const dmb_configuration *c, int rates, argument a[PLACES], question *ask)
{
    for (uint32_t i = 0; i < ask->force->count; i++) {
        a[i].joint = ask->force->joint[i];
        a[i].component = ask->force->component[i];
        a[i].open = 0;
        if (is_place(ask->force, i))
            take_place(sim->scene, c, rates, i, a + i, ask);
        else
            take_joint(sim, c, rates, i, a + i, ask);
    }
}

/* Wrenches in the axes of the places. */
static void to_axes(const question *ask, const argument *a, answer *to)
{
    for (uint32_t i = 0; i < ask->force->count; i++) {
        if (!is_place(ask->force, i)) {
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

static void get_block(const matrix M, uint32_t r, uint32_t c, double block[9])
{
    for (uint32_t k = 0; k < 9; k++) block[k] = M[3 * r + k / 3][3 * c + k % 3];
}

static void add_block(const double block[9], double factor, uint32_t r, uint32_t c, matrix M)
{
    for (uint32_t k = 0; k < 9; k++) M[3 * r + k / 3][3 * c + k % 3] += factor * block[k];
}

/* M <- R^T M R block by block; r, c count blocks of three. */
static void turn_matrix(const question *ask, matrix M)
{
    const uint32_t blocks = 2 * ask->force->count;
    for (uint32_t r = 0; r < blocks; r++)
        for (uint32_t c = 0; c < blocks; c++) {
            double block[9], half[9];
            get_block((const double(*)[WIDE])M, r, c, block);
            add_block(block, -1.0, r, c, M);
            dmb_mat3_mul_tn(ask->R[r / 2], block, half);
            dmb_mat3_mul(half, ask->R[c / 2], block);
            add_block(block, 1.0, r, c, M);
        }
}

/* B (z_r x V) = -B V~ z_r, and w x z_r = w~ z_r; f: wrenches in the axes of the places. */
static void add_turning(const question *ask, const argument *a, answer *to)
{
    const uint32_t blocks = 2 * ask->force->count;
    for (uint32_t i = 0; i < ask->force->count; i++) {
        double skew[9], block[9], product[9];
        if (!is_place(ask->force, i)) continue;
        for (uint32_t r = 0; r < blocks; r++)
            for (uint32_t part = 0; part < 2; part++) {
                dmb_skew(a[i].point.V + 3 * part, skew);
                get_block((const double(*)[WIDE])to->B, r, 2 * i + part, block);
                dmb_mat3_mul(block, skew, product);
                add_block(product, -1.0, r, 2 * i + 1, to->A);
            }
        for (uint32_t part = 0; part < 2; part++) {
            dmb_skew(to->at.f[i] + 3 * part, skew);
            add_block(skew, 1.0, 2 * i + part, 2 * i + 1, to->A);
        }
    }
}

/* Nothing acts on the coordinate of an open joint. */
static void clear_open(const question *ask, const argument *a, answer *to)
{
    for (uint32_t i = 0; i < ask->force->count; i++)
        for (uint32_t c = 0; a[i].joint != DMB_NONE && c < WIDE; c++)
            for (uint32_t k = a[i].open ? 0 : 1; k < 6; k++) to->A[6 * i + k][c] = to->B[6 * i + k][c] = 0.0;
}

/* ---- Onto the nodes ---------------------------------------------------------------------------------------------- */

typedef double wide_row[DMB_CONSTRAINT_COLUMNS];

typedef struct caller_tangent {
    dmb_force_tangent sum;
    wide_row L[WIDE];    /* of V by the nodes' velocities, and of z by their displacements */
    wide_row rate[WIDE]; /* of V by displacements, velocities of the nodes staying the same */
} caller_tangent;

static void take_nodes(const dmb_scene *scene, const dmb_scene_force *force, const argument *a, dmb_force_tangent *t)
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
    if (!is_place(force, i)) {
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

/* K -= L^T (M L + N rate); N NULL: without the latter */
static void add_products(const matrix M, const matrix *N, uint32_t rows, caller_tangent *t)
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

static void add_tangent(const dmb_evaluation *evaluation, const question *ask, const argument *a, answer *to)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const dmb_scene_force *force = ask->force;
    caller_tangent t;
    memset(t.L, 0, sizeof t.L);
    memset(t.rate, 0, sizeof t.rate);
    take_nodes(scene, force, a, &t.sum);
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
    add_products((const double(*)[WIDE])to->A, (const matrix *)&to->B, 6 * force->count, &t);
    dmb_force_tangent_add(evaluation, force->constraint, DMB_BY_DISPLACEMENT, &t.sum);
    dmb_force_tangent_clear(&t.sum);
    add_products((const double(*)[WIDE])to->B, NULL, 6 * force->count, &t);
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

/* The rate of a potential is work of potential forces, the rest of the power is that of loads. */
static int32_t add_power(dmb_evaluation *evaluation, const question *ask, const argument *a, const answer *to)
{
    double power = 0.0, rate = 0.0;
    if (!evaluation->dynamic) return DMB_OK;
    for (uint32_t i = 0; i < ask->force->count; i++)
        power += is_place(ask->force, i) ? dmb_vec6_dot(to->at.f[i], a[i].point.V) : to->at.f[i][0] * ask->v[i][0];
    if (ask->force->provides & DMB_PROVIDES_POTENTIAL && potential_rate(ask, &rate) < 0) return DMB_ERR_CALLBACK;
    evaluation->power[DMB_POWER_POTENTIAL] -= rate;
    evaluation->power[DMB_POWER_LOADS] += power + rate;
    return DMB_OK;
}

static int32_t gather_force(dmb_evaluation *evaluation, uint32_t i)
{
    dmb_sim *sim = evaluation->sim;
    argument a[PLACES];
    question ask;
    answer to;
    memset(&ask, 0, sizeof ask);
    ask.force = sim->scene->forces + i;
    ask.time = evaluation->time;
    take_arguments(sim, &sim->trial, evaluation->dynamic, a, &ask);
    int32_t status = ask_all(&ask, evaluation->tangent, &to);
    if (status < 0) return status;
    to_axes(&ask, a, &to);
    sim->trial.force_potential[i] = to.at.potential;
    for (uint32_t k = 0; k < ask.force->count; k++) apply(sim, a + k, to.at.f[k]);
    status = add_power(evaluation, &ask, a, &to);
    if (status >= 0 && evaluation->tangent) add_tangent(evaluation, &ask, a, &to);
    return status;
}

int32_t dmb_gather_caller_forces(dmb_evaluation *evaluation)
{
    for (uint32_t i = 0; i < evaluation->sim->scene->force_count; i++)
        if (gather_force(evaluation, i) < 0) {
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
    (void)dmb_part_text(text, "force", force - 1, sim->scene->forces[force - 1].name, 24);
    return 1;
}

double dmb_caller_forces_energy(const dmb_scene *scene, const dmb_configuration *configuration)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->force_count; i++) sum += configuration->force_potential[i];
    return sum;
}

/* ---- Check of a given tangent ------------------------------------------------------------------------------------ */

/* Size of a row: its largest entry of either, and its force over a unit. */
static double row_size(const answer *given, const matrix found, const matrix of_given, uint32_t r, uint32_t n)
{
    double size = fabs(given->at.f[r / 6][r % 6]);
    for (uint32_t c = 0; c < n; c++) size = fmax(size, fmax(fabs(found[r][c]), fabs(of_given[r][c])));
    return size;
}

static int32_t compare(dmb_sim *sim, const question *ask, const char *by, const answer *given, const matrix of_given,
                       const matrix found)
{
    dmb_message owner;
    const uint32_t n = 6 * ask->force->count;
    for (uint32_t r = 0; r < n; r++)
        for (uint32_t c = 0; c < n; c++) {
            if (!is_place(ask->force, r / 6) && r % 6 != 0) continue;
            if (!is_place(ask->force, c / 6) && c % 6 != 0) continue;
            const double bound = DMB_TANGENT_CHECK * row_size(given, found, of_given, r, n);
            if (fabs(of_given[r][c] - found[r][c]) <= bound) continue;
            (void)dmb_part_text(&owner, "force", (uint32_t)(ask->force - sim->scene->forces), ask->force->name, 24);
            dmb_message_set(
                &sim->message,
                "%s: tangent by %s[%u][%u] = %g, must be %g by differences; give the derivative of the force, "
                "or leave DMB_PROVIDES_TANGENT out",
                owner.text, by, r, c, of_given[r][c], found[r][c]);
            return DMB_ERR_CALLBACK;
        }
    return DMB_OK;
}

int32_t dmb_caller_force_check(dmb_sim *sim, uint32_t force)
{
    argument a[PLACES];
    question ask;
    answer given;
    matrix A, B;
    dmb_message owner;
    memset(&ask, 0, sizeof ask);
    ask.force = sim->scene->forces + force;
    ask.time = sim->clock->time;
    take_arguments(sim, &sim->now, 1, a, &ask);
    if (!(ask.force->provides & DMB_PROVIDES_TANGENT)) return DMB_OK;
    (void)dmb_part_text(&owner, "force", force, ask.force->name, 24);
    if (given_tangent(&ask, &given) < 0 || tangent_by_differences(&ask, A, B) < 0) {
        dmb_message_set(&sim->message, "%s: its callback failed or gave a value beyond +-1e30", owner.text);
        return DMB_ERR_CALLBACK;
    }
    const int32_t status =
        compare(sim, &ask, "displacement", &given, (const double(*)[WIDE])given.A, (const double(*)[WIDE])A);
    return status < 0
               ? status
               : compare(sim, &ask, "velocity", &given, (const double(*)[WIDE])given.B, (const double(*)[WIDE])B);
}
