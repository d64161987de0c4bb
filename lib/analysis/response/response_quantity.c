/* Outputs as motions and forces of linear analyses. A response needs an output that is linear in a small motion with
 * constant coefficients; others are refused with what to ask for instead:
 *
 *     place        motion (is_steady), vibration    refused: axes that rotate in the state
 *     section      forces and strains               refused: stresses, magnitudes
 *     profile      components of the two above      refused: magnitudes
 *     string       hook load, torque, speeds,       refused: weight and torque on bit unless it has one bit
 *                  weight and torque on its bit
 *     bit          weight, torque, rock weight
 *     drive        force; position and speed of     refused: at the rig end, where the motion of the place is asked
 *                  its joint
 *     contact      normal force, two frictions
 *     joint        all its coordinates and forces
 *     constraint   multipliers
 *     window, part other than reactions             refused: sums, counts, extremes over time */
#include <math.h>

#include "analysis/response/response.h"
#include "query/query.h"

typedef struct meaning {
    const dmb_sim *sim;
    dmb_asked_output *out;
    uint32_t *bit;
    const char **why;
} meaning;

static int32_t means(const meaning *m, int32_t kind, int32_t component, int32_t frame)
{
    m->out->kind = kind;
    m->out->component = component;
    m->out->frame = frame;
    return DMB_OK;
}

static int32_t refuse(const meaning *m, int32_t status, const char *why)
{
    *m->why = why;
    return status;
}

static int32_t not_linear(const meaning *m)
{
    return refuse(m, DMB_ERR_UNSUPPORTED,
                  "a magnitude, a sum or a count has no linear answer to a small motion; ask for components at places, "
                  "or run a stepped sine");
}

static int32_t at_string(const meaning *m, const dmb_output *output, int at_far_end)
{
    dmb_id string;
    uint32_t index;
    if (dmb_output_string(m->sim, output, &string, &index) < 0)
        return refuse(m, DMB_ERR_ID, "place.part names no string of this model, nor {0, 0} for the first");
    const uint32_t last = m->sim->scene->strings[index].pipe_count - 1;
    m->out->place = at_far_end ? dmb_station(string, last, 1.0) : dmb_station(string, 0, 0.0);
    return DMB_OK;
}

/* The output at the bit of the string; requires a single bit. */
static int32_t at_bit(const meaning *m, const dmb_output *output)
{
    const dmb_scene *scene = m->sim->scene;
    uint32_t index, count = 0;
    dmb_id string;
    if (dmb_output_string(m->sim, output, &string, &index) < 0)
        return refuse(m, DMB_ERR_ID, "place.part names no string of this model, nor {0, 0} for the first");
    for (uint32_t k = 0; k < scene->bit_count; k++) {
        if (scene->bits[k].reamer) continue;
        if (scene->bits[k].node - scene->strings[index].first_node >= scene->strings[index].node_count) continue;
        m->out->place.part = dmb_model_id(m->sim->model, DMB_PART_BIT, k);
        *m->bit = k;
        count++;
    }
    return count == 1 ? DMB_OK
                      : refuse(m, DMB_ERR_UNSUPPORTED, "the string must have one bit; name it by a bit output");
}

/* Weight and torque on bit are those of the only bit of the string. Where the excitation is that bit's load, the weight
 * has it as a direct part (*bit); the torque has not. */
static int32_t of_driller(const meaning *m, const dmb_output *output)
{
    const int32_t q = output->quantity, far = q == DMB_OUTPUT_BIT_SPEED;
    const int32_t on_bit = q == DMB_OUTPUT_WEIGHT_ON_BIT || q == DMB_OUTPUT_TORQUE_ON_BIT;
    const int32_t status = on_bit ? at_bit(m, output) : at_string(m, output, far);
    if (status < 0) return status;
    if (q != DMB_OUTPUT_WEIGHT_ON_BIT) *m->bit = DMB_NONE;
    switch (q) {
    case DMB_OUTPUT_HOOK_LOAD:
    case DMB_OUTPUT_ROTATION_TORQUE: return DMB_OK; /* itself: a smooth function at the rig end */
    case DMB_OUTPUT_WEIGHT_ON_BIT: return means(m, DMB_ASKED_BIT, DMB_X, DMB_FRAME_BODY);
    case DMB_OUTPUT_TORQUE_ON_BIT: return means(m, DMB_ASKED_BIT, DMB_RX, DMB_FRAME_BODY);
    case DMB_OUTPUT_BIT_SPEED:
    case DMB_OUTPUT_ROTARY_SPEED: return means(m, DMB_ASKED_VELOCITY, DMB_RX, DMB_FRAME_BODY);
    case DMB_OUTPUT_FEED_SPEED: return means(m, DMB_ASKED_VELOCITY, DMB_X, DMB_FRAME_BODY);
    default: return not_linear(m);
    }
}

static int32_t of_bit(const meaning *m, int32_t q)
{
    if (q == DMB_OUTPUT_BIT_TORQUE) return means(m, DMB_ASKED_BIT, DMB_RX, DMB_FRAME_BODY);
    if (q == DMB_OUTPUT_BIT_ROCK_WEIGHT) return means(m, DMB_ASKED_BIT, DMB_X, DMB_FRAME_BODY);
    if (q != DMB_OUTPUT_BIT_WEIGHT) return not_linear(m);
    const uint32_t k = dmb_model_part_index(m->sim->model, m->out->place.part, DMB_PART_BIT);
    if (k >= m->sim->scene->bit_count) return refuse(m, DMB_ERR_ID, "place.part names no bit of this model");
    *m->bit = k;
    return means(m, DMB_ASKED_BIT, DMB_X, DMB_FRAME_BODY);
}

/* The speed of a drive is that of the coordinate of its joint, or of its row of the node. */
static int32_t of_drive(const meaning *m, int32_t q)
{
    const uint32_t i = dmb_model_part_index(m->sim->model, m->out->place.part, DMB_PART_DRIVE);
    if (i >= m->sim->scene->drive_count) return refuse(m, DMB_ERR_ID, "place.part names no drive of this model");
    const dmb_scene_drive *drive = m->sim->scene->drives + i;
    const int32_t is_speed = q == DMB_OUTPUT_DRIVE_SPEED, is_position = q == DMB_OUTPUT_DRIVE_POSITION;
    if (q == DMB_OUTPUT_DRIVE_FORCE) return means(m, DMB_ASKED_DRIVE, DMB_X, DMB_FRAME_BODY);
    if (!is_speed && !is_position) return not_linear(m);
    if (drive->joint == DMB_NONE)
        return refuse(m, DMB_ERR_UNSUPPORTED, "ask for body_velocity or displacement at the rig end instead");
    m->out->place.part = dmb_model_id(m->sim->model, DMB_PART_JOINT, drive->joint);
    return means(m, is_speed ? DMB_ASKED_JOINT_SPEED : DMB_ASKED_JOINT_POSITION, drive->component, DMB_FRAME_WORLD);
}

static int32_t of_site(const meaning *m, int32_t q)
{
    if (q == DMB_OUTPUT_CONTACT_NORMAL_FORCE) return means(m, DMB_ASKED_CONTACT, DMB_Z, DMB_FRAME_WORLD);
    if (q == DMB_OUTPUT_CONTACT_FRICTION_AXIAL) return means(m, DMB_ASKED_CONTACT, DMB_X, DMB_FRAME_WORLD);
    if (q == DMB_OUTPUT_CONTACT_FRICTION_AROUND) return means(m, DMB_ASKED_CONTACT, DMB_Y, DMB_FRAME_WORLD);
    return not_linear(m);
}

static int32_t of_joint(const meaning *m, int32_t q)
{
    const int32_t c = q % 10;
    switch (q - c) {
    case DMB_OUTPUT_JOINT_POSITION: return means(m, DMB_ASKED_JOINT_POSITION, c, DMB_FRAME_WORLD);
    case DMB_OUTPUT_JOINT_SPEED: return means(m, DMB_ASKED_JOINT_SPEED, c, DMB_FRAME_WORLD);
    case DMB_OUTPUT_JOINT_ACCELERATION: return means(m, DMB_ASKED_JOINT_ACCELERATION, c, DMB_FRAME_WORLD);
    case DMB_OUTPUT_JOINT_REACTION: return means(m, DMB_ASKED_JOINT_REACTION, c, DMB_FRAME_WORLD);
    case DMB_OUTPUT_JOINT_REACTION_BODY: return means(m, DMB_ASKED_JOINT_REACTION, c, DMB_FRAME_BODY);
    case DMB_OUTPUT_JOINT_ACTION: return means(m, DMB_ASKED_JOINT_ACTION, c, DMB_FRAME_WORLD);
    default: return not_linear(m);
    }
}

static int32_t of_section(const meaning *m, int32_t q)
{
    const int32_t c = q % 10;
    if (q == DMB_OUTPUT_AXIAL_FORCE) return means(m, DMB_ASKED_SECTION_FORCE, DMB_X, DMB_FRAME_BODY);
    if (q == DMB_OUTPUT_TORQUE) return means(m, DMB_ASKED_SECTION_FORCE, DMB_RX, DMB_FRAME_BODY);
    if (q - c == DMB_OUTPUT_SECTION_FORCE) return means(m, DMB_ASKED_SECTION_FORCE, c, DMB_FRAME_BODY);
    if (q - c == DMB_OUTPUT_SECTION_STRAIN) return means(m, DMB_ASKED_SECTION_STRAIN, c, DMB_FRAME_BODY);
    return not_linear(m);
}

/* [m/s, rad/s] Speeds below this count as rest. */
#define DMB_OUTPUT_AT_REST 1e-9

static int32_t moves(const meaning *m, int from)
{
    dmb_motion motion = dmb_motion_default();
    double most = 0.0;
    (void)dmb_answer_motion(m->sim, m->out->place, &motion);
    for (int i = from; i < 6; i++) most = fmax(most, fabs(motion.velocity[i]));
    return most > DMB_OUTPUT_AT_REST;
}

/* 1: the output has constant coefficients. About a rotating state, world axes rotate in those of the linear system, so
 * that a query in world axes is no constant multiple of the motion; nor is a body-frame speed across a motion of the
 * state, which contains the rotation of the body, d' + v^ d. Components along and about the axis of motion are. */
static int32_t is_steady(const meaning *m, int32_t q)
{
    const int32_t c = q % 10;
    if (q == DMB_OUTPUT_ROTATION || q == DMB_OUTPUT_SPIN) return 1;
    if (q < DMB_OUTPUT_BODY_VELOCITY) return !moves(m, 3);
    return c == DMB_X || c == DMB_RX || !moves(m, 0);
}

static int32_t of_place(const meaning *m, int32_t q)
{
    const int32_t c = q % 10, world = DMB_FRAME_WORLD, body = DMB_FRAME_BODY;
    if (!is_steady(m, q))
        return refuse(m, DMB_ERR_UNSUPPORTED,
                      "the place moves in the state and its axes with it; ask for its vibration (vibration_..., "
                      "vibration_velocity_...), in the axes of the linear system");
    if (q == DMB_OUTPUT_ROTATION) return means(m, DMB_ASKED_DISPLACEMENT, DMB_RX, body);
    if (q == DMB_OUTPUT_SPIN) return means(m, DMB_ASKED_VELOCITY, DMB_RX, body);
    if (q <= DMB_OUTPUT_DISPLACEMENT_Z) return means(m, DMB_ASKED_DISPLACEMENT, q, world);
    if (q <= DMB_OUTPUT_VELOCITY_Z) return means(m, DMB_ASKED_VELOCITY, q - DMB_OUTPUT_VELOCITY_X, world);
    if (q <= DMB_OUTPUT_POSITION_Z) return means(m, DMB_ASKED_DISPLACEMENT, q - DMB_OUTPUT_POSITION_X, world);
    if (q - c == DMB_OUTPUT_WORLD_VELOCITY) return means(m, DMB_ASKED_VELOCITY, c, world);
    if (q - c == DMB_OUTPUT_WORLD_ACCELERATION) return means(m, DMB_ASKED_ACCELERATION, c, world);
    if (q - c == DMB_OUTPUT_BODY_VELOCITY) return means(m, DMB_ASKED_VELOCITY, c, body);
    return means(m, DMB_ASKED_ACCELERATION, c, body);
}

/* Of a profile what has components. */
static int32_t of_profile(const meaning *m, int32_t quantity)
{
    const dmb_model *model = m->sim->model;
    if (dmb_model_part_index(model, m->out->place.part, DMB_PART_STRING) >= m->sim->scene->string_count)
        return refuse(m, DMB_ERR_ID,
                      "place must be on a pipe of a string; of a body or bit ask for position, "
                      "displacement or rotation");
    if (quantity >= DMB_PROFILE_X && quantity <= DMB_PROFILE_Z)
        return of_place(m, DMB_OUTPUT_POSITION_X + quantity - DMB_PROFILE_X);
    if (quantity >= DMB_PROFILE_DISPLACEMENT_X && quantity <= DMB_PROFILE_DISPLACEMENT_Z)
        return of_place(m, quantity - DMB_PROFILE_DISPLACEMENT_X);
    const int32_t force = DMB_ASKED_SECTION_FORCE, body = DMB_FRAME_BODY;
    switch (quantity) {
    case DMB_PROFILE_EFFECTIVE_FORCE: return means(m, force, DMB_X, body);
    case DMB_PROFILE_TORQUE: return means(m, force, DMB_RX, body);
    case DMB_PROFILE_SHEAR_Y: return means(m, force, DMB_Y, body);
    case DMB_PROFILE_SHEAR_Z: return means(m, force, DMB_Z, body);
    case DMB_PROFILE_MOMENT_Y: return means(m, force, DMB_RY, body);
    case DMB_PROFILE_MOMENT_Z: return means(m, force, DMB_RZ, body);
    case DMB_PROFILE_VELOCITY_AXIAL: return means(m, DMB_ASKED_VELOCITY, DMB_X, body);
    case DMB_PROFILE_SPIN: return means(m, DMB_ASKED_VELOCITY, DMB_RX, body);
    case DMB_PROFILE_ACCELERATION_AXIAL: return means(m, DMB_ASKED_ACCELERATION, DMB_X, body);
    case DMB_PROFILE_ROTATION: return means(m, DMB_ASKED_DISPLACEMENT, DMB_RX, body);
    default: return not_linear(m);
    }
}

/* Vibrations of a place, six components each: rates of the displacement, in the axes of the world or the section. */
int32_t dmb_asked_vibration(const dmb_output *output, dmb_asked_output *out)
{
    const int32_t from = output->quantity - DMB_OUTPUT_VIBRATION, c = from % 10;
    const int32_t is_one = from >= 0 && from < 60 && c <= DMB_RZ;
    out->place = output->place;
    out->reserved = 0;
    out->kind = is_one ? DMB_ASKED_DISPLACEMENT + from / 20 : DMB_ASKED_OUTPUT;
    out->frame = is_one && from / 10 % 2 == 1 ? DMB_FRAME_BODY : DMB_FRAME_WORLD;
    out->component = is_one ? c : output->quantity;
    return is_one;
}

int32_t dmb_asked_output_of(const dmb_sim *sim, const dmb_output *output, dmb_asked_output *out, uint32_t *bit,
                            const char **why)
{
    const meaning m = {sim, out, bit, why};
    const int32_t q = output->quantity;
    const dmb_output_entry *entry = dmb_output_name_of(q);
    *bit = DMB_NONE;
    if (dmb_asked_vibration(output, out)) return DMB_OK;
    switch (entry != NULL ? entry->place : DMB_AT_WINDOW) {
    case DMB_AT_PLACE: return of_place(&m, q);
    case DMB_AT_SECTION: return of_section(&m, q);
    case DMB_AT_PIPE: return of_profile(&m, q - DMB_OUTPUT_PROFILE);
    case DMB_AT_PART:
        return q >= DMB_OUTPUT_REACTION ? means(&m, DMB_ASKED_REACTION, q - DMB_OUTPUT_REACTION, DMB_FRAME_BODY)
                                        : not_linear(&m);
    case DMB_AT_STRING: return of_driller(&m, output);
    case DMB_AT_BIT: return of_bit(&m, q);
    case DMB_AT_DRIVE: return of_drive(&m, q);
    case DMB_AT_JOINT: return of_joint(&m, q);
    case DMB_AT_CONSTRAINT: return means(&m, DMB_ASKED_MULTIPLIER, q - DMB_OUTPUT_MULTIPLIER, DMB_FRAME_WORLD);
    case DMB_AT_CONTACT: return of_site(&m, q);
    default: return not_linear(&m);
    }
}

/* ---- Values of the answer ---------------------------------------------------------------------------------------- */

/* The value of an output for a motion x e^(i w t): its functional, forces of supports and constraints, and the direct
 * contribution of a drive that is the input. */

/* (i w)^rate sum (pose + i w speed - w^2 acceleration) d */
static dmb_complex_number of_functional(const dmb_dynamic_stiffness *s, const dmb_linear_output *output,
                                        dmb_complex_array x)
{
    const dmb_functional *f = &output->functional;
    const double omega = s->omega, eta = output->elastic ? s->structural_damping : 0.0;
    dmb_complex_number sum = {0.0, 0.0};
    for (uint32_t i = 0; i < f->count; i++) {
        const double dr = x.re[f->row[i]], di = x.im[f->row[i]];
        const double a = f->pose[i] - omega * omega * f->acceleration[i], b = omega * f->speed[i] + eta * f->pose[i];
        sum.re += a * dr - b * di;
        sum.im += a * di + b * dr;
    }
    for (int32_t k = 0; k < output->rate; k++) {
        const double kept = sum.re;
        sum.re = -omega * sum.im;
        sum.im = omega * kept;
    }
    return sum;
}

/* Reaction in a constrained row: (A x - f)_r + (B^T multiplier)_r. */
static dmb_complex_number of_constrained_row(const dmb_dynamic_stiffness *s, const dmb_linear_output *output,
                                             uint32_t held, dmb_complex_array x, dmb_complex_array f)
{
    const dmb_scene *scene = &s->linear->scene;
    const uint32_t node = scene->constrained_node[held], c = scene->constrained_component[held],
                   row = dmb_constrained_row(scene, held);
    dmb_complex_number sum = dmb_dynamic_row(s, node, c, x);
    sum.re -= f.re[row];
    sum.im -= f.im[row];
    if (output->cluster == DMB_NONE) return sum;
    const dmb_cluster *cluster = scene->clusters + output->cluster;
    const double *B = s->linear->work->cluster_matrix + cluster->dense + scene->node_place[node] + c;
    for (uint32_t k = 0; k < cluster->rows; k++) {
        sum.re += B[(size_t)k * cluster->columns] * s->links.multiplier.re[k];
        sum.im += B[(size_t)k * cluster->columns] * s->links.multiplier.im[k];
    }
    return sum;
}

dmb_complex_number dmb_linear_output_value(const dmb_dynamic_stiffness *s, const dmb_linear_output *output,
                                           const dmb_linear_excitation *input, dmb_complex_array x, dmb_complex_array f)
{
    dmb_complex_number value = of_functional(s, output, x);
    if (output->cluster != DMB_NONE) dmb_dynamic_multipliers(s, output->cluster, x, f, s->links.multiplier);
    for (uint32_t k = 0; k < output->multiplier_count; k++) {
        value.re += output->multiplier_weight[k] * s->links.multiplier.re[output->multiplier + k];
        value.im += output->multiplier_weight[k] * s->links.multiplier.im[output->multiplier + k];
    }
    for (uint32_t k = 0; k < output->support_count; k++) {
        const dmb_complex_number left = of_constrained_row(s, output, output->support[k], x, f);
        value.re += output->support_weight[k] * left.re;
        value.im += output->support_weight[k] * left.im;
    }
    if (output->bit != DMB_NONE && output->bit == input->bit) value.re += 1.0;
    if (output->drive == DMB_NONE || output->drive != input->drive) return value;
    value.re += output->direct;
    value.im -= output->integral != 0.0 ? output->integral / s->omega : 0.0;
    return value;
}
