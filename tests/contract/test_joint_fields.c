/* Joints, couplings and constraints that are none: each wrong field gives its status and a message that names the part,
 * the field, the value and the bound, and the model stays as it was. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <math.h>

#include "model/model.h"

typedef struct scene_under_test {
    dmb_model *model;
    dmb_id string, body, attached, bit, time_function, wall, joint, pin;
} scene_under_test;

static scene_under_test begin(void)
{
    scene_under_test s;
    const dmb_wall_def wall = dmb_wall_def_default();
    const dmb_segment term = dmb_segment_default();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    memset(&s, 0, sizeof s);
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    assert_int_equal(dmb_model_add_wall(s.model, &wall, &s.wall), DMB_OK);
    assert_int_equal(dmb_model_add_time_function(s.model, &term, 1, &s.time_function), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(s.model, &pipe, 3, &s.string), DMB_OK);
    assert_int_equal(dmb_model_add_body(s.model, &body, &s.body), DMB_OK);
    body.attach = DMB_ATTACH_START;
    assert_int_equal(dmb_model_add_body(s.model, &body, &s.attached), DMB_OK);
    assert_int_equal(dmb_model_add_bit(s.model, &bit, &s.bit), DMB_OK);
    joint.kind = DMB_JOINT_CYLINDRICAL;
    joint.place_b = dmb_station(s.body, 0, 0.0);
    assert_int_equal(dmb_model_add_joint(s.model, &joint, &s.joint), DMB_OK);
    joint.kind = DMB_JOINT_REVOLUTE;
    memcpy(joint.name, "pin", 4);
    assert_int_equal(dmb_model_add_joint(s.model, &joint, &s.pin), DMB_OK);
    return s;
}

static void expect_message(const dmb_model *model, const char *part, const char *text)
{
    const char *message = dmb_model_message(model);
    if (strncmp(message, part, strlen(part)) == 0 && strstr(message, text) != NULL) return;
    fail_msg("\"%s\" does not begin with \"%s\" or lacks \"%s\"", message, part, text);
}

/* A compiled model takes part in no more descriptions, so that compiling shows that nothing was taken. */
static void finish(scene_under_test *s, uint32_t joints, uint32_t couplings, uint32_t constraints)
{
    assert_int_equal(s->model->joints.count, joints);
    assert_int_equal(s->model->couplings.count, couplings);
    assert_int_equal(s->model->constraints.count, constraints);
    assert_int_equal(dmb_model_clear_refused(s->model), DMB_OK);
    assert_int_equal(dmb_model_compile(s->model, NULL), DMB_OK);
    dmb_model_destroy(&s->model);
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

static dmb_joint_def good_joint(const scene_under_test *s)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = DMB_JOINT_FREE;
    joint.place_a = dmb_station(s->body, 0, 0.0);
    joint.place_b = dmb_station(s->string, 2, 1.0);
    memcpy(joint.name, "crank", 6);
    return joint;
}

static void refuse_joint(scene_under_test *s, const dmb_joint_def *joint, int32_t wanted, const char *text)
{
    const dmb_joint_def before = *joint;
    dmb_id id = {7, 8};
    const int32_t status = dmb_model_add_joint(s->model, joint, &id);
    if (status != wanted) fail_msg("%s: %s: %s", text, dmb_status_name(status), dmb_model_message(s->model));
    expect_message(s->model, "joint 2 (crank): ", text);
    assert_int_equal(id.index, 7);
    assert_int_equal(s->model->joints.count, 2);
    assert_memory_equal(joint, &before, sizeof before);
}

static void joint_numbers(void **state)
{
    static const struct {
        size_t offset;
        double value;
        const char *text;
    } cases[] = {
#define AT(field, value, text) {offsetof(dmb_joint_def, field), value, text}
        AT(place_a.fraction, 0.5, "place_a.fraction = 0.5, must be finite, >= 0 and <= 0"),
        AT(place_b.fraction, -0.1, "place_b.fraction = -0.1, must be finite, >= 0 and <= 1"),
        AT(place_b.fraction, 1.5, "place_b.fraction = 1.5, must be finite, >= 0 and <= 1"),
        AT(origin_a[1], 2e6, "origin_a[1] = 2000000, must be finite, >= -1000000 and <= 1000000"),
        AT(origin_b[2], -2e6, "origin_b[2] = -2000000, must be finite, >= -1000000 and <= 1000000"),
        AT(axis_a[0], 0.0, "axis_a = 0, must be of length > 0"),
        AT(axis_b[0], -0.0, "axis_b = 0, must be of length > 0"),
        AT(normal_a[0], 2.0, "normal_a = 2, must be 0 or away from the axis"),
        AT(normal_b[0], -3.0, "normal_b = 3, must be 0 or away from the axis"),
        AT(length, -1.0, "length = -1, must be finite, >= 0 and <= 1000000"),
        AT(stiffness[3], -1.0, "stiffness[3] = -1, must be finite, >= 0"),
        AT(stiffness[3], 2e30, "stiffness[3] = 2e+30, must be finite, >= 0 and <= 1e+30"),
        AT(damping[0], -1.0, "damping[0] = -1, must be finite, >= 0"),
        AT(damping[5], 2e15, "damping[5] = 2e+15, must be finite, >= 0 and <= 1e+15"),
        AT(rest[2], 2e9, "rest[2] = 2000000000, must be finite, >= -1000000000 and <= 1000000000"),
        AT(friction[1], -1.0, "friction[1] = -1, must be finite, >= 0"),
        AT(friction_speed, 0.0, "friction_speed = 0, must be finite, >= 1e-12"),
        AT(friction_speed, -1.0, "friction_speed = -1, must be finite, >= 1e-12"),
        AT(stop_low[4], 2e30, "stop_low[4] = 2e+30, must be finite, >= -1e+30 and <= 1e+30"),
        AT(stop_low[4], 1e30, "stop_high[4] = 1e+30, must be finite and > stop_low[4] (1e+30)"),
        AT(stop_high[5], -1e30, "stop_high[5] = -1e+30, must be finite and > stop_low[5] (-1e+30)"),
        AT(stop_stiffness, 0.0, "stop_stiffness = 0, must be finite, >= 1e-12"),
        AT(stop_damping, -1.0, "stop_damping = -1, must be finite, >= 0"),
        AT(initial_position[0], 2e9, "initial_position[0] = 2000000000, must be finite, >= -1000000000"),
        AT(initial_speed[5], -2e9, "initial_speed[5] = -2000000000, must be finite, >= -1000000000"),
#undef AT
    };
    scene_under_test s = begin();
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        dmb_joint_def joint = good_joint(&s);
        memcpy((unsigned char *)&joint + cases[i].offset, &cases[i].value, sizeof(double));
        refuse_joint(&s, &joint, DMB_ERR_VALUE, cases[i].text);
    }
    finish(&s, 2, 0, 0);
}

static void joint_numbers_that_are_none(void **state)
{
#define OF(field)                                                                                    \
    {                                                                                                \
        offsetof(dmb_joint_def, field), sizeof(((dmb_joint_def *)0)->field) / sizeof(double), #field \
    }
    static const struct {
        size_t offset, count;
        const char *name;
    } fields[] = {OF(place_a.fraction), OF(place_b.fraction), OF(origin_a),         OF(axis_a),
                  OF(normal_a),         OF(origin_b),         OF(axis_b),           OF(normal_b),
                  OF(length),           OF(stiffness),        OF(damping),          OF(rest),
                  OF(friction),         OF(friction_speed),   OF(stop_low),         OF(stop_high),
                  OF(stop_stiffness),   OF(stop_damping),     OF(initial_position), OF(initial_speed)};
#undef OF
    static const double strange[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    scene_under_test s = begin();
    (void)state;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        for (size_t k = 0; k < fields[i].count * 3; ++k) {
            dmb_joint_def joint = good_joint(&s);
            memcpy((unsigned char *)&joint + fields[i].offset + 8 * (k / 3), &strange[k % 3], sizeof(double));
            refuse_joint(&s, &joint, DMB_ERR_NOT_FINITE, fields[i].name);
        }
    }
    finish(&s, 2, 0, 0);
}

static void joint_choices(void **state)
{
    scene_under_test s = begin();
    dmb_joint_def joint = good_joint(&s);
    (void)state;
#define TRY(field, value, text)                        \
    do {                                               \
        joint.field = (value);                         \
        refuse_joint(&s, &joint, DMB_ERR_VALUE, text); \
        joint = good_joint(&s);                        \
    } while (0)
    TRY(kind, -1, "kind = -1, must be 0 .. 15");
    TRY(kind, 16, "kind = 16, must be 0 .. 15");
    TRY(kind, INT32_MAX, "kind = 2147483647, must be 0 .. 15");
    TRY(match, 2, "match = 2, must be 0 .. 1");
    TRY(match, -1, "match = -1, must be 0 .. 1");
    TRY(state, 3, "state = 3, must be 0 .. 2");
    TRY(state, -1, "state = -1, must be 0 .. 2");
    TRY(initial_mask, 0, "initial_mask = 0, must be a set of DMB_FREE_...");
    TRY(initial_mask, DMB_X | DMB_RX, "initial_mask = 3, must be a set of DMB_FREE_..., e.g. DMB_FREE_X | DMB_FREE_RX");
    TRY(initial_mask, 1 << 15, "initial_mask = 32768, must be a set of DMB_FREE_...");
    TRY(initial_mask, -1, "initial_mask = -1, must be a set of DMB_FREE_...");
    TRY(place_a.pipe, 1, "place_a.pipe = 1, must be 0 .. 0");
#undef TRY
    finish(&s, 2, 0, 0);
}

/* Coordinates that a kind holds cannot be given. */
static void initial_coordinates_must_be_free(void **state)
{
    static const char *const without[] = {"without DMB_FREE_X",  "without DMB_FREE_Y",  "without DMB_FREE_Z",
                                          "without DMB_FREE_RX", "without DMB_FREE_RY", "without DMB_FREE_RZ"};
    static const int32_t free_mask[] = {0, 8, 1, 9, 48, 56, 14, 57, 0, 63, 63, 63, 63, 7, 6, 15};
    (void)state;
    for (int32_t kind = DMB_JOINT_FIXED; kind <= DMB_JOINT_SCHOENFLIES; ++kind) {
        scene_under_test s = begin();
        dmb_joint_def joint = good_joint(&s);
        joint.kind = kind;
        if (kind == DMB_JOINT_POINT_ON_HOLE) memset(&joint.place_a, 0, sizeof joint.place_a);
        for (int32_t k = 0; k < 6; ++k) {
            joint.initial_mask = DMB_FREE_X << k;
            if ((free_mask[kind] >> k & 1) != 0) continue;
            refuse_joint(&s, &joint, DMB_ERR_VALUE, without[k]);
        }
        joint.state = DMB_JOINT_OPEN;
        joint.initial_mask = DMB_FREE_NONE | DMB_FREE_X * free_mask[kind];
        assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_OK);
        finish(&s, 3, 0, 0);
    }
}

/* With the equations that a joint holds there is room for six. */
static void initial_coordinates_have_room(void **state)
{
    static const int32_t room[] = {0, 1, 1, 2, 2, 3, 3, 4, 0, 5, 6, 5, 3, 3, 2, 4};
    static const int32_t free_mask[] = {0, 8, 1, 9, 48, 56, 14, 57, 0, 63, 63, 63, 63, 7, 6, 15};
    (void)state;
    for (int32_t kind = DMB_JOINT_FIXED; kind <= DMB_JOINT_SCHOENFLIES; ++kind)
        for (int32_t mask = 0; mask < 64; ++mask) {
            scene_under_test s = begin();
            dmb_joint_def joint = good_joint(&s);
            int32_t bits = 0;
            for (int32_t k = 0; k < 6; ++k) bits += mask >> k & 1;
            joint.kind = kind;
            joint.initial_mask = DMB_FREE_NONE | DMB_FREE_X * (mask & free_mask[kind]);
            if (kind == DMB_JOINT_POINT_ON_HOLE) memset(&joint.place_a, 0, sizeof joint.place_a);
            if ((mask & ~free_mask[kind]) != 0) bits = 0; /* has been looked at */
            joint.state = DMB_JOINT_LOCKED;
            if (bits > 0) refuse_joint(&s, &joint, DMB_ERR_VALUE, ", must be of 0 bits at most: with its 6");
            joint.state = DMB_JOINT_ACTIVE;
            if (bits > room[kind]) {
                refuse_joint(&s, &joint, DMB_ERR_VALUE, room[kind] == 3 ? " of 3 bits at most" : " of 5 bits at most");
            } else {
                assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_OK);
            }
            dmb_model_destroy(&s.model);
        }
}

static void joint_lengths(void **state)
{
    scene_under_test s = begin();
    dmb_joint_def joint = good_joint(&s);
    (void)state;
    joint.length = 0.0;
    assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_OK); /* does not count */
    joint.kind = DMB_JOINT_DISTANCE;
    memcpy(joint.name, "other", 6);
    assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_ERR_VALUE);
    expect_message(s.model, "joint 3 (other): ", "length = 0, must be finite, >= 1e-06");
    joint.kind = DMB_JOINT_ROLLING;
    assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_ERR_VALUE);
    expect_message(s.model, "joint 3 (other): ", "length = 0");
    finish(&s, 3, 0, 0);
}

static void joint_places(void **state)
{
    scene_under_test s = begin();
    const dmb_id none = {0, 0}, strange = {s.body.index, s.body.generation + 1};
    const dmb_id wrong[] = {s.time_function, s.wall, s.joint, strange, {UINT32_MAX, s.body.generation}};
    dmb_joint_def joint = good_joint(&s);
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        joint = good_joint(&s);
        joint.place_a.part = wrong[i];
        refuse_joint(&s, &joint, DMB_ERR_ID, "place_a.part = {");
        joint = good_joint(&s);
        joint.place_b.part = wrong[i];
        refuse_joint(&s, &joint, DMB_ERR_ID, "must name a string, a body, a bit or a ring of this model");
    }
    joint = good_joint(&s);
    joint.place_b.part = none;
    refuse_joint(&s, &joint, DMB_ERR_ID, "place_b.part = {0, 0}");
    joint.place_a.part = none;
    refuse_joint(&s, &joint, DMB_ERR_VALUE, "place_b = the ground as place_a, must be on a part");
    joint.place_a = joint.place_b = dmb_station(s.body, 0, 0.0);
    refuse_joint(&s, &joint, DMB_ERR_VALUE, "place_b = place_a, must be on another part");
    joint.place_a = joint.place_b = dmb_station(s.string, 1, 1.0);
    refuse_joint(&s, &joint, DMB_ERR_VALUE, "place_b = place_a");
    joint = good_joint(&s);
    joint.place_a = dmb_station(s.bit, 0, 0.0); /* a bit is a body */
    joint.place_b = dmb_station(s.attached, 0, 0.0);
    assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_OK);
    finish(&s, 3, 0, 0);
}

static void names(void **state)
{
    scene_under_test s = begin();
    dmb_joint_def joint = good_joint(&s);
    dmb_coupling_def coupling = dmb_coupling_def_default();
    dmb_constraint_def constraint = dmb_constraint_def_default();
    (void)state;
    memset(joint.name, 'x', sizeof joint.name);
    assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_ERR_VALUE);
    expect_message(s.model, "joint 2: ", "name = 24 characters without an end, must be at most 23 and a 0 behind them");
    memset(coupling.name, 'x', sizeof coupling.name);
    assert_int_equal(dmb_model_add_coupling(s.model, &coupling, NULL), DMB_ERR_VALUE);
    expect_message(s.model, "coupling 0: ", "name");
    memset(constraint.name, 'x', sizeof constraint.name);
    assert_int_equal(dmb_model_add_constraint(s.model, &constraint, NULL), DMB_ERR_VALUE);
    expect_message(s.model, "constraint 0: ", "name");
    joint.name[23] = '\0';
    joint.kind = 99;
    assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_ERR_VALUE);
    expect_message(s.model, "joint 2 (xxxxxxxxxxxxxxxxxxxxxxx): ", "kind");
    joint.name[0] = '\0';
    assert_int_equal(dmb_model_add_joint(s.model, &joint, NULL), DMB_ERR_VALUE);
    expect_message(s.model, "joint 2: ", "kind = 99");
    finish(&s, 2, 0, 0);
}

static void point_on_hole(void **state)
{
    static const size_t laws[] = {offsetof(dmb_joint_def, stiffness), offsetof(dmb_joint_def, damping),
                                  offsetof(dmb_joint_def, friction)};
    static const char *const field[] = {"stiffness[2] = 1", "damping[2] = 1", "friction[2] = 1"};
    const double one = 1.0;
    scene_under_test s = begin();
    dmb_joint_def joint = good_joint(&s), good;
    (void)state;
    joint.kind = DMB_JOINT_POINT_ON_HOLE;
    refuse_joint(&s, &joint, DMB_ERR_VALUE, "must be {0, 0}: the ground");
    memset(&joint.place_a, 0, sizeof joint.place_a);
    good = joint;
    for (size_t i = 0; i < 3; ++i) {
        memcpy((unsigned char *)&joint + laws[i] + 16, &one, sizeof one);
        refuse_joint(&s, &joint, DMB_ERR_VALUE, field[i]);
        joint = good;
    }
    joint.stop_low[0] = -1.0;
    refuse_joint(&s, &joint, DMB_ERR_VALUE, "stop_low[0] = -1, must be left alone");
    joint = good;
    joint.stop_high[5] = 1.0;
    refuse_joint(&s, &joint, DMB_ERR_VALUE, "stop_high[5] = 1, must be left alone");
    joint = good;
    joint.match = 1;
    refuse_joint(&s, &joint, DMB_ERR_VALUE, "match = 1, must be 0 .. 0");
    assert_int_equal(dmb_model_add_joint(s.model, &good, NULL), DMB_OK);
    finish(&s, 3, 0, 0);
}

/* ---- Couplings --------------------------------------------------------------------------------------------------- */

static void refuse_coupling(scene_under_test *s, const dmb_coupling_def *coupling, int32_t wanted, const char *text)
{
    const int32_t status = dmb_model_add_coupling(s->model, coupling, NULL);
    if (status != wanted) fail_msg("%s: %s: %s", text, dmb_status_name(status), dmb_model_message(s->model));
    expect_message(s->model, "coupling 0 (gear): ", text);
}

static void couplings(void **state)
{
    static const double ratios[] = {0.0, -0.0, 1e-13, -2e12};
    scene_under_test s = begin();
    dmb_coupling_def good = dmb_coupling_def_default(), c;
    (void)state;
    good.joint[0] = s.joint;
    good.joint[1] = s.pin;
    memcpy(good.name, "gear", 5);
#define TRY(change, status, text)              \
    do {                                       \
        c = good;                              \
        change;                                \
        refuse_coupling(&s, &c, status, text); \
    } while (0)
    TRY(c.joint[0] = s.body, DMB_ERR_ID, "joint[0] = {");
    TRY(c.joint[1] = (dmb_id){0}, DMB_ERR_ID, "joint[1] = {0, 0}, must name a joint of this model");
    TRY(c.joint[1].generation++, DMB_ERR_ID, "joint[1] = {");
    TRY(c.component[0] = -1, DMB_ERR_VALUE, "component[0] = -1, must be 0 .. 5");
    TRY(c.component[1] = 6, DMB_ERR_VALUE, "component[1] = 6, must be 0 .. 5");
    TRY(c.component[0] = DMB_Y, DMB_ERR_VALUE, "component[0] = 1, must be free in its joint: joint 0");
    TRY(c.component[1] = DMB_X, DMB_ERR_VALUE, "component[1] = 0, must be free in its joint: joint 1 (pin)");
    TRY(c.joint[1] = c.joint[0], DMB_ERR_VALUE, "component[1] = 3, must be another coordinate");
    TRY(c.ratio = (double)NAN, DMB_ERR_NOT_FINITE, "ratio = nan");
    TRY(c.ratio = (double)INFINITY, DMB_ERR_NOT_FINITE, "ratio = inf");
    for (size_t i = 0; i < 4; ++i) {
        TRY(c.ratio = ratios[i], DMB_ERR_VALUE, "must be of size >= 1e-12 and <= 1e+12");
    }
#undef TRY
    assert_int_equal(dmb_model_add_coupling(s.model, &good, NULL), DMB_OK);
    good.joint[1] = good.joint[0]; /* a screw */
    memcpy(good.name, "screw", 6);
    good.component[0] = DMB_X;
    good.ratio = -1e-3;
    assert_int_equal(dmb_model_add_coupling(s.model, &good, NULL), DMB_OK);
    finish(&s, 2, 2, 0);
}

/* ---- Constraints ------------------------------------------------------------------------------------------------- */

static int32_t callback(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                        double *jacobian)
{
    (void)context, (void)time, (void)count, (void)poses, (void)value, (void)jacobian;
    return 0;
}

static void refuse_constraint(scene_under_test *s, const dmb_constraint_def *def, int32_t wanted, const char *text)
{
    const int32_t status = dmb_model_add_constraint(s->model, def, NULL);
    if (status != wanted) fail_msg("%s: %s: %s", text, dmb_status_name(status), dmb_model_message(s->model));
    expect_message(s->model, "constraint 0 (cam): ", text);
}

static void constraints(void **state)
{
    scene_under_test s = begin();
    dmb_constraint_def good = dmb_constraint_def_default(), c;
    (void)state;
    good.row_count = 6;
    good.place_count = 4;
    good.callback = callback;
    for (uint32_t i = 0; i < 4; ++i) good.place[i] = dmb_station(s.string, i / 2, i % 2);
    memcpy(good.name, "cam", 4);
#define TRY(change, status, text)                \
    do {                                         \
        c = good;                                \
        change;                                  \
        refuse_constraint(&s, &c, status, text); \
    } while (0)
    TRY(c.kind = 2, DMB_ERR_VALUE, "kind = 2, must be 0 .. 1");
    TRY(c.kind = -1, DMB_ERR_VALUE, "kind = -1, must be 0 .. 1");
    TRY(c.kind = DMB_CONSTRAINT_NONHOLONOMIC, DMB_ERR_VALUE, "provides = 0, must be 1 for a nonholonomic constraint");
    TRY(c.row_count = 0, DMB_ERR_VALUE, "row_count = 0, must be 1 .. 6");
    TRY(c.row_count = 7, DMB_ERR_VALUE, "row_count = 7, must be 1 .. 6");
    TRY(c.place_count = 0, DMB_ERR_VALUE, "place_count = 0, must be 1 .. 4");
    TRY(c.place_count = UINT32_MAX, DMB_ERR_VALUE, "place_count = 4294967295, must be 1 .. 4");
    TRY(c.provides = 2, DMB_ERR_VALUE, "provides = 2, must be made of the bits of 1");
    TRY(c.provides = -1, DMB_ERR_VALUE, "provides = -1, must be made of the bits of 1");
    TRY(c.callback = NULL, DMB_ERR_NULL, "callback is NULL");
    TRY(c.place[0].part = (dmb_id){0}, DMB_ERR_ID, "place[0].part = {0, 0}");
    TRY(c.place[3].part = s.joint, DMB_ERR_ID, "place[3].part = {");
    TRY(c.place[2].fraction = 2.0, DMB_ERR_VALUE, "place[2].fraction = 2, must be finite, >= 0 and <= 1");
    TRY(c.place[1].fraction = (double)NAN, DMB_ERR_NOT_FINITE, "place[1].fraction = nan");
    TRY(c.place[1] = dmb_station(s.body, 1, 0.0), DMB_ERR_VALUE, "place[1].pipe = 1, must be 0 .. 0");
#undef TRY
    assert_int_equal(dmb_model_add_constraint(s.model, &good, NULL), DMB_OK);
    good.kind = DMB_CONSTRAINT_NONHOLONOMIC;
    memcpy(good.name, "skate", 6);
    good.provides = DMB_PROVIDES_JACOBIAN;
    good.place_count = 1;
    good.place[1].part.index = 12345; /* does not count */
    assert_int_equal(dmb_model_add_constraint(s.model, &good, NULL), DMB_OK);
    finish(&s, 2, 0, 2);
}

/* ---- Drives of joints -------------------------------------------------------------------------------------------- */

static void drives(void **state)
{
    scene_under_test s = begin();
    dmb_drive_def drive = dmb_drive_def_default();
    (void)state;
    drive.time_function = s.time_function;
    drive.part = s.pin;
    for (int32_t k = DMB_X; k <= DMB_RZ; ++k) {
        drive.component = k;
        if (k == DMB_RX) continue;
        assert_int_equal(dmb_model_add_drive(s.model, &drive, NULL), DMB_ERR_VALUE);
        expect_message(s.model, "drive 0: component = ", "must be free in the joint: joint 1 (pin)");
    }
    drive.component = 6;
    assert_int_equal(dmb_model_add_drive(s.model, &drive, NULL), DMB_ERR_VALUE);
    drive.component = DMB_RX;
    drive.part.generation++;
    assert_int_equal(dmb_model_add_drive(s.model, &drive, NULL), DMB_ERR_ID);
    expect_message(s.model, "drive 0: part = {", "must name a string, a body or a joint of this model");
    drive.part = s.pin;
    assert_int_equal(dmb_model_add_drive(s.model, &drive, NULL), DMB_OK);
    drive.kind = DMB_DRIVE_CONTROL;
    assert_int_equal(dmb_model_add_drive(s.model, &drive, NULL), DMB_OK);
    assert_int_equal(s.model->drives.count, 2);
    finish(&s, 2, 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joint_numbers),
        cmocka_unit_test(joint_numbers_that_are_none),
        cmocka_unit_test(joint_choices),
        cmocka_unit_test(initial_coordinates_must_be_free),
        cmocka_unit_test(initial_coordinates_have_room),
        cmocka_unit_test(joint_lengths),
        cmocka_unit_test(joint_places),
        cmocka_unit_test(names),
        cmocka_unit_test(point_on_hole),
        cmocka_unit_test(couplings),
        cmocka_unit_test(constraints),
        cmocka_unit_test(drives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
