#include "answers.h"

#include <math.h>
#include <string.h>

typedef struct taker {
    const scene *s; /* the original one */
    scene_view view;
    double roll[SCENE_STRINGS];
    const built *b;
    answers *out;
} taker;

static void put(taker *t, answer_group group, double value)
{
    answers *const a = t->out;
    if (a->count >= ANSWERS_MOST) {
        a->overflow = 1;
        return;
    }
    a->value[a->count] = value;
    a->group[a->count++] = (unsigned char)group;
}

static void put_vector(taker *t, answer_group group, const double v[3])
{
    for (int i = 0; i < 3; ++i) put(t, group, v[i]);
}

static double force_unit(const taker *t)
{
    return t->view.mass * t->view.length;
}

/* A force and a moment, world axes of the transformed scene. */
static void put_wrench(taker *t, const double force[3], const double moment[3])
{
    const double unit = force_unit(t);
    double f[3], m[3];
    view_back(&t->view, 1, force, f);
    view_back(&t->view, 0, moment, m);
    for (int i = 0; i < 3; ++i) put(t, ANSWER_FORCE, f[i] / unit);
    for (int i = 0; i < 3; ++i) put(t, ANSWER_MOMENT, m[i] / (unit * t->view.length));
}

/* The same with components in the axes R of the transformed scene. */
static void put_wrench_in(taker *t, const double R[9], const double wrench[6])
{
    double f[3], m[3];
    matrix_apply(R, wrench, f);
    matrix_apply(R, wrench + 3, m);
    put_wrench(t, f, m);
}

static void put_motion(taker *t, dmb_place place, double roll, double R[9])
{
    dmb_pose pose = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    double x[3], turned[9], v[3], w[3];
    if (dmb_query_pose(t->b->sim, place, &pose) < 0) put(t, ANSWER_POSITION, (double)NAN);
    if (dmb_query_motion(t->b->sim, place, &motion) < 0) put(t, ANSWER_VELOCITY, (double)NAN);
    view_position_back(&t->view, pose.position, x);
    put_vector(t, ANSWER_POSITION, x);
    view_rotation_back(&t->view, roll, pose.rotation, turned);
    for (int i = 0; i < 9; ++i) put(t, ANSWER_ROTATION, turned[i]);
    view_back(&t->view, 1, motion.velocity, v);
    view_back(&t->view, 0, motion.velocity + 3, w);
    for (int i = 0; i < 3; ++i) put(t, ANSWER_VELOCITY, v[i] / t->view.length);
    put_vector(t, ANSWER_SPIN, w);
    memcpy(R, pose.rotation, sizeof pose.rotation);
}

/* ---- Strings ---------------------------------------------------------------------------------------------------- */

/* Quarters and ends of the pipes: a middle is an end where pipes are halved. */
static dmb_place station_of(const taker *t, uint32_t k, uint32_t pipe, double fraction)
{
    if (!t->view.halved) return dmb_station(t->b->string[k], pipe, fraction);
    return dmb_station(t->b->string[k], fraction > 0.5 ? 2 * pipe + 1 : 2 * pipe,
                       fraction > 0.5 ? 2.0 * fraction - 1.0 : 2.0 * fraction);
}

static void put_station(taker *t, uint32_t k, uint32_t pipe, double fraction)
{
    const dmb_place place = station_of(t, k, pipe, fraction);
    dmb_section section = dmb_section_default();
    double R[9], turn = 0.0;
    put_motion(t, place, t->roll[k], R);
    if (dmb_query_rotation(t->b->sim, place, &turn) < 0) turn = (double)NAN;
    put(t, ANSWER_ROTATION, t->view.handed * turn);
    if (t->s->string[k].pipe[pipe].kind == DMB_PIPE_RIGID || t->view.motion_only) return;
    if (dmb_query_section(t->b->sim, place, &section) < 0) put(t, ANSWER_FORCE, (double)NAN);
    put_wrench_in(t, R, section.force);
}

static void put_string(taker *t, uint32_t k)
{
    double reaction[6], R[9];
    put_station(t, k, 0, 0.0);
    for (uint32_t p = 0; p < t->s->string[k].pipes; ++p) {
        put_station(t, k, p, 0.25);
        put_station(t, k, p, 1.0);
    }
    if (t->view.motion_only) return;
    put_motion(t, dmb_station(t->b->string[k], 0, 0.0), t->roll[k], R);
    if (dmb_query_reaction(t->b->sim, t->b->string[k], reaction) < 0) put(t, ANSWER_FORCE, (double)NAN);
    put_wrench_in(t, R, reaction);
}

/* ---- Contacts, by part and pipe: their numbers go by the order in which parts were added ------------------------ */

enum { SLOTS_STRING = SCENE_PIPES + 1, SLOTS = SCENE_STRINGS * SLOTS_STRING + SCENE_BODIES + 1 };

static uint32_t slot_of(const taker *t, const dmb_contact *c)
{
    for (uint32_t k = 0; k < t->s->strings; ++k)
        if (t->b->string[k].index == c->part.index)
            return k * SLOTS_STRING + (c->pipe == DMB_NONE ? 0 : (t->view.halved ? c->pipe / 2 : c->pipe) + 1);
    for (uint32_t i = 0; i < t->s->bodies; ++i)
        if (t->b->body[i].index == c->part.index) return SCENE_STRINGS * SLOTS_STRING + i;
    return SLOTS - 1;
}

static void put_contacts(taker *t)
{
    double slot[SLOTS][6];
    dmb_model_info info = dmb_model_info_default();
    memset(slot, 0, sizeof slot);
    (void)dmb_model_get_info(t->b->model, &info);
    for (uint32_t i = 0; i < info.contact_points; ++i) {
        dmb_contact c = dmb_contact_default();
        double normal[3];
        if (dmb_query_contact(t->b->sim, i, &c) < 0) put(t, ANSWER_FORCE, (double)NAN);
        double *const sum = slot[slot_of(t, &c)];
        view_back(&t->view, 1, c.normal, normal);
        for (int k = 0; k < 3; ++k) sum[k] += c.normal_force * normal[k] / force_unit(t);
        sum[3] += c.friction[0] / force_unit(t);
        sum[4] += t->view.handed * c.friction[1] / force_unit(t);
    }
    for (uint32_t i = 0; i < SLOTS && info.contact_points > 0; ++i)
        for (int k = 0; k < 5; ++k) put(t, ANSWER_FORCE, slot[i][k]);
}

/* ---- Joints, drives, sums --------------------------------------------------------------------------------------- */

static void put_joint(taker *t, uint32_t i)
{
    dmb_joint_state j = dmb_joint_state_default(), again = dmb_joint_state_default();
    if (dmb_query_joint(t->b->sim, t->b->joint[i], &j) < 0) put(t, ANSWER_FORCE, (double)NAN);
    for (int k = 0; k < 6; ++k) {
        const double sign = k >= 2 && k <= 4 ? t->view.handed : 1.0;
        const double unit = k < 3 ? t->view.length : 1.0;
        put(t, k < 3 ? ANSWER_POSITION : ANSWER_ROTATION, sign * j.position[k] / unit);
        put(t, k < 3 ? ANSWER_VELOCITY : ANSWER_SPIN, sign * j.speed[k] / unit);
        put(t, k < 3 ? ANSWER_FORCE : ANSWER_MOMENT,
            sign * j.action[k] / (force_unit(t) * (k < 3 ? 1.0 : t->view.length)));
    }
    if (t->view.doubled && dmb_query_joint(t->b->sim, t->b->joint[i + t->s->joints], &again) < 0)
        put(t, ANSWER_FORCE, (double)NAN);
    for (int k = 0; k < 6; ++k) j.reaction[k] += again.reaction[k];
    put_wrench(t, j.reaction, j.reaction + 3);
}

static void put_drive(taker *t, uint32_t i)
{
    const int32_t component = t->s->drive[i].def.component;
    const double sign = component >= 2 && component <= 4 ? t->view.handed : 1.0;
    const double length = t->view.length, unit = force_unit(t);
    dmb_drive_state d = dmb_drive_state_default();
    if (dmb_query_drive(t->b->sim, t->b->drive[i], &d) < 0) put(t, ANSWER_FORCE, (double)NAN);
    if (component < DMB_RX) {
        put(t, ANSWER_POSITION, sign * d.position / length);
        put(t, ANSWER_VELOCITY, sign * d.speed / length);
        put(t, ANSWER_FORCE, sign * d.force / unit);
    } else {
        put(t, ANSWER_ROTATION, sign * d.position);
        put(t, ANSWER_SPIN, sign * d.speed);
        put(t, ANSWER_MOMENT, sign * d.force / (unit * length));
    }
    put(t, ANSWER_ENERGY, d.work / (unit * length));
}

static void put_energy(taker *t)
{
    const double unit = force_unit(t) * t->view.length;
    dmb_energy e = dmb_energy_default();
    if (dmb_query_energy(t->b->sim, &e) < 0) put(t, ANSWER_ENERGY, (double)NAN);
    const double list[] = {e.kinetic,  e.strain, e.gravity, e.contact, e.drives, e.loads,
                           e.friction, e.impact, e.damping, e.rock,    e.scheme, e.input};
    for (size_t i = 0; i < sizeof list / sizeof list[0]; ++i) put(t, ANSWER_ENERGY, list[i] / unit);
}

static void put_bit(taker *t)
{
    dmb_bit_state bit = dmb_bit_state_default();
    if (dmb_query_bit(t->b->sim, t->b->bit, &bit) < 0) put(t, ANSWER_FORCE, (double)NAN);
    put(t, ANSWER_FORCE, bit.weight / force_unit(t));
    put(t, ANSWER_MOMENT, bit.torque / (force_unit(t) * t->view.length));
    put(t, ANSWER_POSITION, bit.advance / t->view.length);
}

void answers_take(const scene *original, const scene *transformed, const scene_view *view, const built *b, answers *out)
{
    taker t = {original, view ? *view : view_identity(), {0.0}, b, out};
    double R[9];
    out->count = 0;
    out->overflow = 0;
    for (uint32_t k = 0; k < t.s->strings && view; ++k) t.roll[k] = view_roll(original, transformed, view, k);
    for (uint32_t k = 0; k < t.s->strings; ++k) put_string(&t, k);
    for (uint32_t i = 0; i < t.s->bodies; ++i)
        if (t.s->body[i].def.attach == DMB_ATTACH_NONE) put_motion(&t, dmb_station(b->body[i], 0, 0.0), 0.0, R);
    for (uint32_t i = 0; i < t.s->joints; ++i) put_joint(&t, i);
    for (uint32_t i = 0; i < t.s->drives; ++i) put_drive(&t, i);
    if (t.s->has_bit) put_bit(&t);
    if (t.s->has_wall && !t.view.motion_only) put_contacts(&t);
    put_energy(&t);
}

/* ---- Comparison ------------------------------------------------------------------------------------------------- */

const char *answer_group_name(answer_group group)
{
    static const char *const names[] = {"positions", "rotations", "velocities", "spins",
                                        "forces",    "moments",   "energies"};
    return names[group];
}

void answers_difference(const answers *a, const answers *b, double difference[ANSWER_GROUPS])
{
    for (int g = 0; g < ANSWER_GROUPS; ++g) difference[g] = a->count == b->count ? 0.0 : (double)NAN;
    for (uint32_t i = 0; i < a->count && i < b->count; ++i) {
        const double d = fabs(a->value[i] - b->value[i]);
        if (!(d <= difference[a->group[i]])) difference[a->group[i]] = d;
    }
}

void answers_size(const answers *a, double size[ANSWER_GROUPS])
{
    for (int g = 0; g < ANSWER_GROUPS; ++g) size[g] = 0.0;
    for (uint32_t i = 0; i < a->count; ++i)
        if (fabs(a->value[i]) > size[a->group[i]]) size[a->group[i]] = fabs(a->value[i]);
}
