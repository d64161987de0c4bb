/* Constraints of the caller's functions: rows, convective terms and curvature, by the function where it gives them and
 * by central differences of fourth order otherwise (table and reasons: constrain.h).
 *
 *     quantity          with the function's Jacobian                        without it
 *     ---------------   -------------------------------------------------   ---------------------------------------
 *     B                 as given                                            C along each component of each place
 *     rate              C along time at fixed poses, or b of a nonholonomic constraint (eq:joints.nonholonomic)
 *     convective        (J v)' along the motion + d(J v)/dt + d2C/dt2       C twice along the motion
 *     curvature         J^T f along each component                          left out of the tangent */
#include "system/constrain/constrain.h"

#include <string.h>

#include "math/mat6.h"
#include "math/se3.h"
#include "sim/node.h"

#define DMB_POSE_STEP 2e-4      /* [m, rad] first derivatives by pose */
#define DMB_TIME_STEP 1e-4      /* [s] first derivatives by time */
#define DMB_TURN_STEP 1e-3      /* [s] second derivatives by time */
#define DMB_MOTION_STEP 3e-4    /* [m, rad; s] of first derivatives along the motion */
#define DMB_BEND_STEP 2e-3      /* [m, rad; s] of second derivatives along the motion */
#define DMB_JACOBIAN_CHECK 1e-5 /* largest difference of a given Jacobian from differences, over its row's size */

enum { PLACES = DMB_CONSTRAINT_PLACES, COLUMNS = 6 * DMB_CONSTRAINT_PLACES, ROWS = DMB_CONSTRAINT_ROWS };

/* Weights of f at -2h, -h, h, 2h for f' h, and with -30/12 f(0) for f'' h^2. */
static const double first_weight[4] = {1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};
static const double second_weight[4] = {-1.0 / 12.0, 16.0 / 12.0, 16.0 / 12.0, -1.0 / 12.0};
static const double places_of_weight[4] = {-2.0, -1.0, 1.0, 2.0};

/* Quaternions and positions of the places, requested quantities, and destinations. */
typedef struct question {
    const dmb_scene_callback *callback;
    double time;
    double q[PLACES][4], x[PLACES][3], v[PLACES][6];
} question;

static void ask_place(const dmb_scene *scene, const dmb_configuration *c, const dmb_scene_frame *frame, double q[4],
                      double x[3], double v[6])
{
    double R[9], u[3], arm[3], turn[3];
    dmb_node_pose(scene, c, frame->node, R, u);
    dmb_quat_from_matrix(R, q);
    dmb_mat3_vec(R, frame->x, arm);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)frame->node, u, x);
    dmb_vec3_add(x, arm, x);
    dmb_node_vector(scene, c, frame->node, c->velocity, v);
    dmb_vec3_cross(v + 3, frame->x, turn);
    dmb_vec3_add(v, turn, v);
}

static question question_of(const dmb_scene *scene, const dmb_configuration *c, uint32_t callback, double time)
{
    question ask;
    memset(&ask, 0, sizeof ask);
    ask.callback = scene->callbacks + callback;
    ask.time = time;
    for (uint32_t i = 0; i < ask.callback->count; i++)
        ask_place(scene, c, ask.callback->place + i, ask.q[i], ask.x[i], ask.v[i]);
    return ask;
}

static int32_t call(const question *ask, double value[ROWS], double jacobian[ROWS * COLUMNS])
{
    double poses[PLACES][12];
    double spare[ROWS * COLUMNS];
    double sum = 0.0, *J = jacobian != NULL ? jacobian : spare;
    memset(value, 0, ROWS * sizeof(double));
    memset(J, 0, ROWS * COLUMNS * sizeof(double));
    for (uint32_t i = 0; i < ask->callback->count; i++) {
        dmb_vec3_copy(ask->x[i], poses[i]);
        dmb_quat_to_matrix(ask->q[i], poses[i] + 3);
    }
    if (ask->callback->callback(ask->callback->context, ask->time, ask->callback->count, (const double(*)[12])poses,
                                value, J) != 0)
        return DMB_ERR_CALLBACK;
    for (uint32_t i = 0; i < ROWS; i++) sum += fabs(value[i]);
    for (uint32_t i = 0; i < ROWS * COLUMNS; i++) sum += fabs(J[i]);
    return sum <= DMB_CALLBACK_MAX ? DMB_OK : DMB_ERR_CALLBACK; /* nor is a NaN */
}

/* The arguments advanced along the motion: all places by s times their speeds, and the time by s. */
static question along_motion(const question *ask, double s)
{
    question moved = *ask;
    for (uint32_t i = 0; i < ask->callback->count; i++) {
        double step[6];
        for (int k = 0; k < 6; k++) step[k] = s * ask->v[i][k];
        dmb_se3_advance(moved.q[i], moved.x[i], step);
    }
    moved.time += s;
    return moved;
}

static question along_component(const question *ask, uint32_t column, double s)
{
    question moved = *ask;
    double step[6] = {0.0};
    step[column % 6] = s;
    dmb_se3_advance(moved.q[column / 6], moved.x[column / 6], step);
    return moved;
}

/* J (rows, 6 count) by places, by differences of the value. */
static int32_t jacobian_by_differences(const question *ask, double J[ROWS * COLUMNS])
{
    const uint32_t columns = 6 * ask->callback->count;
    double value[ROWS];
    memset(J, 0, ROWS * COLUMNS * sizeof(double));
    for (uint32_t c = 0; c < columns; c++)
        for (int k = 0; k < 4; k++) {
            const question moved = along_component(ask, c, places_of_weight[k] * DMB_POSE_STEP);
            if (call(&moved, value, NULL) < 0) return DMB_ERR_CALLBACK;
            for (uint32_t r = 0; r < ask->callback->rows; r++)
                J[r * columns + c] += first_weight[k] * value[r] / DMB_POSE_STEP;
        }
    return DMB_OK;
}

/* J as given, or by differences. */
static int32_t jacobian_of(const question *ask, double value[ROWS], double J[ROWS * COLUMNS])
{
    const int32_t status = call(ask, value, J);
    if (status < 0 || ask->callback->provides & DMB_PROVIDES_JACOBIAN) return status;
    return jacobian_by_differences(ask, J);
}

/* value_r = (J v)_r, plus b_r for a constraint of speeds. */
static int32_t speed_value(const question *ask, double value[ROWS])
{
    const uint32_t columns = 6 * ask->callback->count;
    double A[ROWS * COLUMNS];
    const int32_t status = call(ask, value, A);
    if (ask->callback->kind == DMB_CONSTRAINT_HOLONOMIC) memset(value, 0, ROWS * sizeof(double));
    for (uint32_t r = 0; r < ask->callback->rows; r++)
        for (uint32_t c = 0; c < columns; c++) value[r] += A[r * columns + c] * ask->v[c / 6][c % 6];
    return status;
}

static question at_time(const question *ask, double s)
{
    question moved = *ask;
    moved.time += s;
    return moved;
}

/* A path of arguments over s, and a quantity that depends on them. */
typedef question (*path)(const question *ask, double s);
typedef int32_t (*quantity)(const question *ask, double value[ROWS]);

static int32_t value_of(const question *ask, double value[ROWS])
{
    return call(ask, value, NULL);
}

/* out += first derivative of a quantity along a path. */
static int32_t add_first(const question *ask, path along, quantity what, double h, double out[ROWS])
{
    int32_t status = DMB_OK;
    for (int k = 0; k < 4 && status >= 0; k++) {
        const question moved = along(ask, places_of_weight[k] * h);
        double value[ROWS];
        status = what(&moved, value);
        for (uint32_t r = 0; r < ROWS; r++) out[r] += first_weight[k] * value[r] / h;
    }
    return status;
}

/* out += second derivative of C along a path. */
static int32_t add_second(const question *ask, path along, double h, double out[ROWS])
{
    double value[ROWS];
    int32_t status = call(ask, value, NULL);
    for (uint32_t r = 0; r < ROWS; r++) out[r] -= 2.5 * value[r] / (h * h);
    for (int k = 0; k < 4 && status >= 0; k++) {
        const question moved = along(ask, places_of_weight[k] * h);
        status = call(&moved, value, NULL);
        for (uint32_t r = 0; r < ROWS; r++) out[r] += second_weight[k] * value[r] / (h * h);
    }
    return status;
}

/* Step along the motion that travels no more than `most`, and no longer in time. */
static double motion_step(const question *ask, double most)
{
    double fastest = 1.0;
    for (uint32_t c = 0; c < 6 * ask->callback->count; c++) fastest = fmax(fastest, fabs(ask->v[c / 6][c % 6]));
    return most / fastest;
}

/* Of a nonholonomic constraint the derivative of A v + b along the motion at constant v is all of it. */
static int32_t convective_of(const question *ask, double convective[ROWS])
{
    memset(convective, 0, ROWS * sizeof(double));
    if ((ask->callback->provides & DMB_PROVIDES_JACOBIAN) == 0)
        return add_second(ask, along_motion, motion_step(ask, DMB_BEND_STEP), convective);
    int32_t status = add_first(ask, along_motion, speed_value, motion_step(ask, DMB_MOTION_STEP), convective);
    if (status < 0 || ask->callback->kind == DMB_CONSTRAINT_NONHOLONOMIC) return status;
    status = add_first(ask, at_time, speed_value, DMB_TIME_STEP, convective);
    return status < 0 ? status : add_second(ask, at_time, DMB_TURN_STEP, convective);
}

/* dC/dt at fixed poses; of a nonholonomic constraint b itself (eq:joints.nonholonomic). */
static int32_t rate_of(const question *ask, const double value[ROWS], double rate[ROWS])
{
    memcpy(rate, value, ROWS * sizeof(double));
    if (ask->callback->kind == DMB_CONSTRAINT_NONHOLONOMIC) return DMB_OK;
    memset(rate, 0, ROWS * sizeof(double));
    return add_first(ask, at_time, value_of, DMB_TIME_STEP, rate);
}

/* Columns of a place as columns of its node: v_place = v + w x x, so the moment gains x cross the force. */
static void to_node(const dmb_scene *scene, const dmb_constraint *constraint, const dmb_scene_frame *frame,
                    const double J[6], double *row)
{
    double wrench[6], moment[3];
    dmb_vec6_copy(J, wrench);
    dmb_vec3_cross(frame->x, J, moment);
    dmb_vec3_add(wrench + 3, moment, wrench + 3);
    dmb_add_node_columns(scene, frame->node, wrench, row + dmb_constraint_column(constraint, frame->node));
}

int32_t dmb_callback_rows(dmb_evaluation *evaluation, uint32_t callback)
{
    dmb_sim *sim = evaluation->sim;
    const question ask = question_of(sim->scene, &sim->trial, callback, evaluation->time);
    const dmb_scene_callback *own = ask.callback;
    const dmb_constraint *constraint = sim->scene->constraints + own->constraint;
    const int speeds = own->kind == DMB_CONSTRAINT_NONHOLONOMIC;
    double value[ROWS], rate[ROWS], convective[ROWS], J[ROWS * COLUMNS];
    int32_t status = jacobian_of(&ask, value, J);
    if (status >= 0) status = rate_of(&ask, value, rate);
    if (status >= 0) status = convective_of(&ask, convective);
    if (status < 0) {
        sim->reduced_mode->row = constraint->row; /* for the message */
        return status;
    }
    for (uint32_t r = 0; r < own->rows; r++) {
        double *row = sim->constraint_jacobian + constraint->jacobian + (size_t)r * constraint->columns;
        sim->constraint_type[constraint->row + r] = speeds ? DMB_ROW_SPEED : DMB_ROW_POSITION;
        sim->constraint_value[constraint->row + r] = speeds ? 0.0 : value[r];
        sim->constraint_rate[constraint->row + r] = rate[r];
        sim->constraint_convective[constraint->row + r] = convective[r];
        for (uint32_t i = 0; i < own->count; i++)
            to_node(sim->scene, constraint, own->place + i, J + (r * own->count + i) * 6, row);
    }
    return DMB_OK;
}

/* Derivative of J^T f by differences of the given Jacobian. A Jacobian built by differences is not accurate enough for
 * that, and the term is neglected in the tangent. */
int32_t dmb_callback_curvature(dmb_evaluation *evaluation, uint32_t callback, double *K)
{
    dmb_sim *sim = evaluation->sim;
    const question ask = question_of(sim->scene, &sim->trial, callback, evaluation->time);
    const dmb_scene_callback *own = ask.callback;
    const dmb_constraint *constraint = sim->scene->constraints + own->constraint;
    const double *f = sim->trial.multiplier + constraint->row;
    const uint32_t columns = 6 * own->count;
    if ((own->provides & DMB_PROVIDES_JACOBIAN) == 0) return DMB_OK;
    double by_place[COLUMNS][COLUMNS] = {{0.0}}; /* [force component][place component] */
    for (uint32_t c = 0; c < columns; c++)
        for (int k = 0; k < 4; k++) {
            double value[ROWS], J[ROWS * COLUMNS];
            const question moved = along_component(&ask, c, places_of_weight[k] * DMB_POSE_STEP);
            if (call(&moved, value, J) < 0) return DMB_ERR_CALLBACK;
            for (uint32_t r = 0; r < own->rows; r++)
                for (uint32_t i = 0; i < columns; i++)
                    by_place[i][c] += first_weight[k] * f[r] * J[r * columns + i] / DMB_POSE_STEP;
        }
    double half[COLUMNS][COLUMNS] = {{0.0}}; /* [force component][node column] */
    for (uint32_t i = 0; i < columns; i++)
        for (uint32_t p = 0; p < own->count; p++)
            to_node(sim->scene, constraint, own->place + p, by_place[i] + 6 * p, half[i]);
    for (uint32_t c = 0; c < constraint->columns; c++) {
        double column[COLUMNS] = {0.0}, full[COLUMNS] = {0.0};
        for (uint32_t i = 0; i < columns; i++) column[i] = half[i][c];
        for (uint32_t p = 0; p < own->count; p++) to_node(sim->scene, constraint, own->place + p, column + 6 * p, full);
        for (uint32_t r = 0; r < constraint->columns; r++) K[(size_t)r * constraint->columns + c] += full[r];
    }
    return DMB_OK;
}

/* Sizes of the rows: values, entries, and changes over a step per length of it, so that the derivative of a constant
 * row is not compared with rounding errors. */
static int32_t row_sizes(const question *ask, const double value[ROWS], const double given[ROWS * COLUMNS],
                         const double found[ROWS * COLUMNS], double size[ROWS])
{
    const uint32_t columns = 6 * ask->callback->count;
    double there[ROWS];
    for (uint32_t r = 0; r < ask->callback->rows; r++) size[r] = fabs(value[r]);
    for (uint32_t c = 0; c < columns; c++) {
        const question moved = along_component(ask, c, DMB_POSE_STEP);
        if (call(&moved, there, NULL) < 0) return DMB_ERR_CALLBACK;
        for (uint32_t r = 0; r < ask->callback->rows; r++) {
            const double entry = fmax(fabs(given[r * columns + c]), fabs(found[r * columns + c]));
            size[r] = fmax(size[r], fmax(entry, fabs(there[r] - value[r]) / DMB_POSE_STEP));
        }
    }
    return DMB_OK;
}

static int32_t check_jacobian(dmb_sim *sim, const question *ask, const char *owner)
{
    const uint32_t columns = 6 * ask->callback->count;
    double value[ROWS], given[ROWS * COLUMNS], found[ROWS * COLUMNS], size[ROWS];
    int32_t status = call(ask, value, given);
    if (status >= 0) status = jacobian_by_differences(ask, found);
    if (status >= 0) status = row_sizes(ask, value, given, found, size);
    if (status < 0) dmb_message_set(&sim->message, "%s: the callback failed or gave a value beyond +-1e30", owner);
    for (uint32_t i = 0; status >= 0 && i < ask->callback->rows * columns; i++) {
        if (fabs(given[i] - found[i]) <= DMB_JACOBIAN_CHECK * size[i / columns]) continue;
        dmb_message_set(&sim->message, "%s: jacobian[%u][%u] = %g, must be %g by differences", owner, i / columns,
                        i % columns, given[i], found[i]);
        return DMB_ERR_CALLBACK;
    }
    return status;
}

int32_t dmb_callback_check(dmb_sim *sim, uint32_t callback)
{
    const question ask = question_of(sim->scene, &sim->now, callback, sim->clock->time);
    const dmb_scene_callback *own = ask.callback;
    dmb_message owner;
    if (own->kind != DMB_CONSTRAINT_HOLONOMIC || (own->provides & DMB_PROVIDES_JACOBIAN) == 0) return DMB_OK;
    dmb_constraint_text(sim->scene, own->constraint, &owner);
    return check_jacobian(sim, &ask, owner.text);
}
