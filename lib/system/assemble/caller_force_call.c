/* Call of a caller's force function: arguments, result, and derivatives of the result. Derivatives are those given by
 * the function or central differences of fourth order, f' h = (f(-2h) - 8 f(-h) + 8 f(h) - f(2h))/12. Differences call
 * with the state of the law at the last accepted time and write its new state to `spare`, so that the state of the
 * trial is that of the one call at the trial's own arguments. */
#include <string.h>

#include "math/mat6.h"
#include "math/so3.h"
#include "system/assemble/caller_force.h"

#define DMB_MOTION_STEP 3e-4   /* [m, rad; s] of derivatives of a potential along the motion */
#define DMB_TANGENT_CHECK 1e-4 /* largest difference of a given tangent from differences, over its row's size */

/* Weights of f at -2h, -h, h, 2h for f' h. */
static const double first_weight[4] = {1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};
static const double places_of_weight[4] = {-2.0, -1.0, 1.0, 2.0};

/* ---- Asking ------------------------------------------------------------------------------------------------------ */

/* Adds the magnitudes of the state. */
static double size_of_state(const dmb_scene_force *force, const double *state, double sum)
{
    for (uint32_t i = 0; i < force->states; i++) sum += fabs(state[i]);
    return sum;
}

/* tangent: shape (2, 6 count, 6 count), or NULL; state: of the law, written */
static int32_t call(const dmb_caller_question *ask, dmb_caller_values *to, double *tangent, double *state)
{
    const dmb_scene_force *force = ask->force;
    const dmb_law_memory memory = {ask->accepted, state, ask->step};
    double poses[DMB_CONSTRAINT_PLACES][12], sum = 0.0;
    memset(to->f, 0, sizeof to->f);
    to->potential = 0.0;
    for (uint32_t i = 0; i < force->count; i++) {
        dmb_vec3_copy(ask->x[i], poses[i]);
        dmb_mat3_copy(ask->R[i], poses[i] + 3);
    }
    if (force->states > 0) memcpy(state, ask->accepted, force->states * sizeof *state);
    if (force->callback(force->context, ask->time, force->count, (const double(*)[12])poses, (const double(*)[6])ask->v,
                        to->f, tangent, &to->potential, &memory) != 0)
        return DMB_ERR_CALLBACK;
    for (uint32_t i = 0; i < force->count; i++)
        for (int k = 0; k < 6; k++) sum += fabs(to->f[i][k]);
    if (!(force->provides & DMB_PROVIDES_POTENTIAL)) to->potential = 0.0;
    sum = size_of_state(force, state, sum);
    return sum + fabs(to->potential) <= DMB_CALLBACK_MAX ? DMB_OK : DMB_ERR_CALLBACK; /* nor is a NaN */
}

/* Displaces the pose of place i by s along component c of the requested axes. */
static void displace(dmb_caller_question *ask, uint32_t i, uint32_t c, double s)
{
    double e[3] = {0.0}, turn[9], R[9];
    if (!dmb_caller_is_place(ask->force, i)) {
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

/* 48 calls for each place, 8 for each joint coordinate: four along each displacement and each velocity, in steps of the
 * description (pose_step, speed_step). */
static int32_t tangent_by_differences(const dmb_caller_question *ask, dmb_caller_matrix A, dmb_caller_matrix B)
{
    const uint32_t n = 6 * ask->force->count;
    dmb_caller_values there;
    memset(A, 0, sizeof(dmb_caller_matrix));
    memset(B, 0, sizeof(dmb_caller_matrix));
    for (uint32_t c = 0; c < 2 * n; c++)
        for (int k = 0; k < 4; k++) {
            const int by_speed = c >= n;
            const uint32_t column = by_speed ? c - n : c, i = column / 6;
            const double step = by_speed ? ask->force->speed_step : ask->force->pose_step;
            dmb_caller_question moved = *ask;
            if (!dmb_caller_is_place(ask->force, i) && column % 6 != 0) continue;
            if (by_speed)
                moved.v[i][column % 6] += places_of_weight[k] * step;
            else
                displace(&moved, i, column % 6, places_of_weight[k] * step);
            if (call(&moved, &there, NULL, ask->spare) < 0) return DMB_ERR_CALLBACK;
            for (uint32_t r = 0; r < n; r++)
                (by_speed ? B : A)[r][column] += first_weight[k] * there.f[r / 6][r % 6] / step;
        }
    return DMB_OK;
}

/* Expands the given tangent in place, from the last entry, so that none is overwritten. A second copy would be the
 * largest object on the stack. */
static int32_t given_tangent(const dmb_caller_question *ask, dmb_caller_answer *to)
{
    const uint32_t n = 6 * ask->force->count;
    double sum = 0.0;
    memset(to->given, 0, sizeof to->given);
    if (call(ask, &to->at, to->given, ask->trial) < 0) return DMB_ERR_CALLBACK;
    for (uint32_t k = 0; k < 2 * n * n; k++) sum += fabs(to->given[k]);
    for (uint32_t k = 2 * n * n; k-- > 0;) {
        const uint32_t half = k / (n * n), r = k % (n * n) / n, c = k % n;
        to->given[DMB_CALLER_WIDE * (DMB_CALLER_WIDE * half + r) + c] = to->given[k];
    }
    return sum <= DMB_CALLBACK_MAX ? DMB_OK : DMB_ERR_CALLBACK;
}

int32_t dmb_caller_ask(const dmb_caller_question *ask, int tangent, dmb_caller_answer *to)
{
    if (tangent && ask->force->provides & DMB_PROVIDES_TANGENT) return given_tangent(ask, to);
    const int32_t status = call(ask, &to->at, NULL, ask->trial);
    return status < 0 || !tangent ? status : tangent_by_differences(ask, to->A, to->B);
}

/* Differences along the motion q exp(s v), t + s, with a step in time by which no place moves more than
 * DMB_MOTION_STEP. */
int32_t dmb_caller_potential_rate(const dmb_caller_question *ask, double *rate)
{
    double fastest = 1.0;
    *rate = 0.0;
    for (uint32_t i = 0; i < ask->force->count; i++)
        for (int k = 0; k < 6; k++) fastest = fmax(fastest, fabs(ask->v[i][k]));
    const double h = DMB_MOTION_STEP / fastest;
    for (int k = 0; k < 4; k++) {
        const double s = places_of_weight[k] * h;
        dmb_caller_question moved = *ask;
        dmb_caller_values there;
        moved.time += s;
        for (uint32_t i = 0; i < ask->force->count; i++) {
            const double *v = ask->v[i], turn[3] = {s * v[3], s * v[4], s * v[5]};
            double move[3] = {s * v[0], s * v[1], s * v[2]}, Q[9], R[9];
            if (!dmb_caller_is_place(ask->force, i)) {
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
        if (call(&moved, &there, NULL, ask->spare) < 0) return DMB_ERR_CALLBACK;
        *rate += first_weight[k] * there.potential / h;
    }
    return DMB_OK;
}

/* ---- Check of a given tangent ------------------------------------------------------------------------------------ */

/* Size of a row: its largest entry of either, and its force over a unit. */
static double row_size(const dmb_caller_answer *given, const dmb_caller_matrix found, const dmb_caller_matrix of_given,
                       uint32_t r, uint32_t n)
{
    double size = fabs(given->at.f[r / 6][r % 6]);
    for (uint32_t c = 0; c < n; c++) size = fmax(size, fmax(fabs(found[r][c]), fabs(of_given[r][c])));
    return size;
}

typedef struct compared {
    const char *owner, *by;
    dmb_message *message;
} compared;

static int32_t compare(const dmb_caller_question *ask, const compared *of, const dmb_caller_answer *given,
                       const dmb_caller_matrix of_given, const dmb_caller_matrix found)
{
    const uint32_t n = 6 * ask->force->count;
    for (uint32_t r = 0; r < n; r++)
        for (uint32_t c = 0; c < n; c++) {
            if (!dmb_caller_is_place(ask->force, r / 6) && r % 6 != 0) continue;
            if (!dmb_caller_is_place(ask->force, c / 6) && c % 6 != 0) continue;
            const double bound = DMB_TANGENT_CHECK * row_size(given, found, of_given, r, n);
            if (fabs(of_given[r][c] - found[r][c]) <= bound) continue;
            dmb_message_set(
                of->message,
                "%s: tangent by %s[%u][%u] = %g, must be %g by differences; give the derivative of the force, "
                "or leave DMB_PROVIDES_TANGENT out",
                of->owner, of->by, r, c, of_given[r][c], found[r][c]);
            return DMB_ERR_CALLBACK;
        }
    return DMB_OK;
}

int32_t dmb_caller_compare(const dmb_caller_question *ask, const char *owner, dmb_message *message)
{
    dmb_caller_answer given;
    dmb_caller_matrix A, B;
    if (given_tangent(ask, &given) < 0 || tangent_by_differences(ask, A, B) < 0) {
        dmb_message_set(message, "%s: its callback failed or gave a value beyond +-1e30", owner);
        return DMB_ERR_CALLBACK;
    }
    const compared displacement = {owner, "displacement", message}, velocity = {owner, "velocity", message};
    const int32_t status = compare(ask, &displacement, &given, (const double(*)[DMB_CALLER_WIDE])given.A,
                                   (const double(*)[DMB_CALLER_WIDE])A);
    if (status < 0) return status;
    return compare(ask, &velocity, &given, (const double(*)[DMB_CALLER_WIDE])given.B,
                   (const double(*)[DMB_CALLER_WIDE])B);
}
