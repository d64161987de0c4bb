/* Functionals: derivatives of public queries, by evaluating them for a copy of the state in which one row at a time
 * moves. An output of a linear analysis is thus the derivative of the same query that users call. */
#include "analysis/linear/linear.h"

#include <string.h>

#include "math/se3.h"
#include "query/query.h"
#include "sim/node.h"

/* Central differences of the pose: (h/L)^2 of non-linearity and eps L/h of rounding are both near 1e-10. */
#define DMB_FUNCTIONAL_STEP 1e-5

/* ---- Motion ------------------------------------------------------------------------------------------------------ */

static int32_t motion_component(const dmb_sim *copy, dmb_place place, int32_t frame, int32_t component, double *value)
{
    dmb_motion motion = dmb_motion_default();
    motion.frame = frame;
    const int32_t status = dmb_answer_motion(copy, place, &motion);
    *value = motion.velocity[component];
    return status;
}

static void exchange(double **a, double **b)
{
    double *kept = *a;
    *a = *b;
    *b = kept;
}

/* Exchanges the speeds of the state with those of the trial, and back: the trial's arrays take the unit motions, and
 * the state keeps its own without a copy. */
static void exchange_motion(dmb_sim *copy)
{
    exchange(&copy->now.velocity, &copy->trial.velocity);
    exchange(&copy->now.acceleration, &copy->trial.acceleration);
}

/* Appends a row and its coefficient. Rows between the last one and this one are included with 0, so that functionals of
 * one place have the same rows and are added entry by entry (dmb_functional_add). */
static void set_value(uint32_t row, double value, dmb_functional *out)
{
    do out->row[out->count] = out->count > 0 ? out->row[out->count - 1] + 1 : row;
    while (out->row[out->count++] < row);
    out->pose[out->count - 1] = value;
}

/* The result for each row moving alone at unit speed, from the first to the last row on which it depends. */
static int32_t all_rows(dmb_sim *copy, dmb_place place, int32_t frame, int32_t component, dmb_functional *out)
{
    const uint32_t rows = copy->scene->row_count;
    int32_t status = DMB_OK;
    exchange_motion(copy);
    memset(copy->now.velocity, 0, rows * sizeof(double));
    memset(copy->now.acceleration, 0, rows * sizeof(double));
    for (uint32_t r = 0; r < rows && status >= 0; r++) {
        copy->now.velocity[r] = 1.0;
        double value = 0.0;
        status = motion_component(copy, place, frame, component, &value);
        copy->now.velocity[r] = 0.0;
        if (value != 0.0) set_value(r, value, out);
    }
    exchange_motion(copy);
    return status;
}

/* A velocity is linear in the velocities of the rows, and a small displacement has the same coefficients. */
int32_t dmb_functional_of_motion(dmb_sim *copy, dmb_place place, int32_t frame, int32_t component, dmb_functional *out)
{
    memset(out, 0, sizeof *out);
    return all_rows(copy, place, frame, component, out);
}

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

void dmb_functional_add_node(const dmb_scene *scene, uint32_t node, dmb_functional *out)
{
    for (uint32_t c = 0; c < scene->layout.size[node]; c++) out->row[out->count++] = scene->layout.row[node] + c;
}

/* The rows on which a section at a place may depend: those of the nodes that move it, and of one more node on either
 * side: the force at a node is that of the element beside it, whose far end counts too. */
int32_t dmb_functional_around(dmb_sim *copy, dmb_place place, dmb_functional *out)
{
    const dmb_scene *scene = copy->scene;
    dmb_functional x;
    const int32_t status = dmb_functional_of_motion(copy, place, DMB_FRAME_BODY, DMB_X, &x);
    if (status < 0) return status;
    uint32_t low = dmb_node_of_row(scene, x.row[0]), high = dmb_node_of_row(scene, x.row[x.count ? x.count - 1 : 0]);
    if (low > 0) low--;
    if (high + 1 < scene->node_count) high++;
    memset(out, 0, sizeof *out);
    for (uint32_t i = low; i <= high; i++) dmb_functional_add_node(scene, i, out);
    return DMB_OK;
}

void dmb_functional_add(double factor, const dmb_functional *from, dmb_functional *to)
{
    for (uint32_t i = 0; i < to->count; i++) {
        to->pose[i] += factor * from->pose[i];
        to->speed[i] += factor * from->speed[i];
        to->acceleration[i] += factor * from->acceleration[i];
    }
}

void dmb_functional_add_rate(double factor, const dmb_functional *from, dmb_functional *to)
{
    for (uint32_t i = 0; i < to->count; i++) to->speed[i] += factor * from->pose[i];
}

/* ---- Differences ------------------------------------------------------------------------------------------------- */

/* The answer after the pose of one row alone has changed by `step` in body axes; the pose is restored. */
static double moved_answer(dmb_sim *copy, dmb_answer *answer, const void *what, uint32_t row, double step)
{
    const dmb_scene *scene = copy->scene;
    const uint32_t node = dmb_node_of_row(scene, row), c = row - scene->layout.row[node];
    double *q = copy->now.quaternion + 4 * (size_t)node, *x = copy->now.displacement + 3 * (size_t)node;
    double start_q[4], start_x[3], z[6] = {0.0};
    const double start_turn = copy->now.turn[node];
    memcpy(start_q, q, sizeof start_q);
    memcpy(start_x, x, sizeof start_x);
    z[c] = step;
    if (scene->layout.size[node] == DMB_NODE_SIX_DOF) {
        dmb_se3_advance(q, x, z);
    } else {
        x[0] += z[0];
        copy->now.turn[node] += z[1];
    }
    const double value = answer(copy, what);
    memcpy(q, start_q, sizeof start_q);
    memcpy(x, start_x, sizeof start_x);
    copy->now.turn[node] = start_turn;
    return value;
}

static double slope(double *number, double step, const dmb_sim *copy, dmb_answer *answer, const void *what)
{
    const double kept = *number;
    *number = kept + step;
    const double after = answer(copy, what);
    *number = kept - step;
    const double before = answer(copy, what);
    *number = kept;
    return (after - before) / (2.0 * step);
}

/* Central differences by the pose. Those by accelerations and speeds are exact for any step, since queries are linear
 * in accelerations and at most quadratic in speeds: the even term cancels. */
static void differences(dmb_sim *copy, dmb_answer *answer, const void *what, dmb_functional *out)
{
    const dmb_scene *scene = copy->scene;
    for (uint32_t i = 0; i < out->count; i++) {
        const uint32_t row = out->row[i], node = dmb_node_of_row(scene, row);
        const int turns = 2 * (row - scene->layout.row[node]) >= scene->layout.size[node];
        const double step = DMB_FUNCTIONAL_STEP * (turns ? 1.0 : scene->length_scale);
        out->pose[i] =
            (moved_answer(copy, answer, what, row, step) - moved_answer(copy, answer, what, row, -step)) / (2.0 * step);
        out->speed[i] = slope(copy->now.velocity + row, 1.0, copy, answer, what);
        out->acceleration[i] = slope(copy->now.acceleration + row, 1.0, copy, answer, what);
    }
}

/* to += row v^, row^T v^ = ad(v)^T row */
static void add_turned(const double v[6], const double row[6], double to[6])
{
    double product[6];
    dmb_ad_transpose(v, row, product);
    for (int i = 0; i < 6; i++) to[i] += product[i];
}

/* Body-frame speeds and their rates change by d' + g^ d and d'' + (g^ - w^) d' + (b^ - w^ g^) d (linearise.c), with ^
 * the matrix of ad, g `rest`, w `spin`, b `change`. Inserted into p d + s v + a v', this adds to the coefficients of d
 * the rows s g^ + a (b^ - w^ g^), and to those of d' the rows a (g^ - w^): of a row by v^, that is ad(v)^T of it. */
void dmb_functional_turn_frames(const dmb_linear *linear, dmb_functional *out)
{
    const dmb_scene *scene = &linear->scene;
    for (uint32_t at = 0; at < out->count;) {
        const uint32_t node = dmb_node_of_row(scene, out->row[at]), row = scene->layout.row[node];
        if (scene->layout.size[node] == DMB_NODE_SIX_DOF) {
            double back[6] = {0.0};
            add_turned(linear->spin + row, out->acceleration + at, back);
            for (int i = 0; i < 6; i++) back[i] = -back[i];
            add_turned(linear->rest + row, out->speed + at, out->pose + at);
            add_turned(linear->change + row, out->acceleration + at, out->pose + at);
            add_turned(linear->rest + row, back, out->pose + at);
            add_turned(linear->rest + row, out->acceleration + at, out->speed + at);
            for (uint32_t i = 0; i < 6; i++) out->speed[at + i] += back[i];
        }
        at += scene->layout.size[node];
    }
}

void dmb_functional_of_answer(dmb_linear *linear, dmb_answer *answer, const void *what, dmb_functional *out)
{
    differences(linear->work, answer, what, out);
    dmb_functional_turn_frames(linear, out);
}

static double of_motion(const dmb_sim *sim, const dmb_asked_output *o, int32_t *status)
{
    dmb_motion motion = dmb_motion_default();
    motion.frame = o->frame;
    *status = dmb_answer_motion(sim, o->place, &motion);
    return o->kind == DMB_ASKED_VELOCITY ? motion.velocity[o->component] : motion.acceleration[o->component];
}

static double of_section(const dmb_sim *sim, const dmb_asked_output *o, int32_t *status)
{
    dmb_section section = dmb_section_default();
    *status = dmb_answer_section(sim, o->place, &section);
    return o->kind == DMB_ASKED_SECTION_FORCE ? section.force[o->component] : section.strain[o->component];
}

static double of_contact(const dmb_sim *sim, const dmb_asked_output *o, int32_t *status)
{
    dmb_contact contact = dmb_contact_default();
    *status = dmb_answer_contact(sim, o->place.pipe, &contact);
    return o->component == DMB_Z ? contact.normal_force : contact.friction[o->component == DMB_Y];
}

static double of_drive(const dmb_sim *sim, const dmb_asked_output *o, int32_t *status)
{
    dmb_drive_state state = dmb_drive_state_default();
    *status = dmb_answer_drive(sim, o->place.part, &state);
    return state.force;
}

static double of_support(const dmb_sim *sim, const dmb_asked_output *o, int32_t *status)
{
    double reaction[6] = {0.0};
    *status = dmb_answer_reaction(sim, o->place.part, reaction);
    return reaction[o->component];
}

static double of_joint(const dmb_sim *sim, const dmb_asked_output *o, int32_t *status)
{
    dmb_joint_state state = dmb_joint_state_default();
    state.frame = o->frame;
    *status = dmb_answer_joint(sim, o->place.part, &state);
    switch (o->kind) {
    case DMB_ASKED_JOINT_POSITION: return state.position[o->component];
    case DMB_ASKED_JOINT_SPEED: return state.speed[o->component];
    case DMB_ASKED_JOINT_ACCELERATION: return state.acceleration[o->component];
    case DMB_ASKED_JOINT_REACTION: return state.reaction[o->component];
    default: return state.action[o->component];
    }
}

static double of_multiplier(const dmb_sim *sim, const dmb_asked_output *o, int32_t *status)
{
    double multipliers[6] = {0.0};
    uint32_t count = 0;
    *status = dmb_answer_multipliers(sim, o->place.part, multipliers, &count);
    if (*status >= 0 && (uint32_t)o->component >= count) *status = DMB_ERR_VALUE;
    return multipliers[o->component];
}

static double of_bit(const dmb_sim *sim, const dmb_asked_output *o, int32_t *status)
{
    dmb_bit_state state = dmb_bit_state_default();
    *status = dmb_answer_bit(sim, o->place.part, &state);
    return o->component == DMB_X ? state.weight : state.torque;
}

static double of_output(const dmb_sim *sim, const dmb_asked_output *o, int32_t *status)
{
    const dmb_output output = {o->place, o->component, 0};
    double value = 0.0;
    *status = dmb_output_value(sim, &output, &value);
    return value;
}

double dmb_answer_of(const dmb_sim *sim, const dmb_asked_output *output, int32_t *status)
{
    switch (output->kind) {
    case DMB_ASKED_VELOCITY:
    case DMB_ASKED_ACCELERATION: return of_motion(sim, output, status);
    case DMB_ASKED_SECTION_FORCE:
    case DMB_ASKED_SECTION_STRAIN: return of_section(sim, output, status);
    case DMB_ASKED_CONTACT: return of_contact(sim, output, status);
    case DMB_ASKED_DRIVE: return of_drive(sim, output, status);
    case DMB_ASKED_REACTION: return of_support(sim, output, status);
    case DMB_ASKED_MULTIPLIER: return of_multiplier(sim, output, status);
    case DMB_ASKED_BIT: return of_bit(sim, output, status);
    case DMB_ASKED_OUTPUT: return of_output(sim, output, status);
    default: return of_joint(sim, output, status);
    }
}
