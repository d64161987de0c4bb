/* Two sims that are no pair for a derivative, told from each other one difference at a time; scenes whose steps have no
 * derivative. A refusal changes nothing. */
#include <string.h>

#include "rig.h"

/* Differences of a scene from the others. */
enum {
    SAME = 0,
    MORE_ELEMENTS,
    A_BODY_FOR_AN_ELEMENT,
    ORDER_OF_STRINGS,
    RIG_END_FREE,
    MORE_DRIVES,
    KIND_OF_DRIVE,
    COMPONENT_OF_DRIVE,
    JOINT_OF_DRIVE,
    COORDINATE_OF_DRIVE,
    MORE_JOINTS,
    KIND_OF_JOINT,
    PARTS_OF_JOINT,
    COUPLING_FOR_A_JOINT,
    NO_CONTACT,
    NORMAL_LAW,
    MORE_INPUTS,
    TARGET_OF_INPUT,
    PART_OF_INPUT,
    MORE_LOADS,
    MORE_BITS,
    MORE_TYPES,
    MORE_TIME_FUNCTIONS,
    MORE_SEGMENTS,
    KIND_OF_SEGMENT,
    BEGIN_OF_STEP,
    END_OF_STEP,
    ROWS_OF_TABLE,
    TIMES_OF_TABLE,
    STUCK_AT_FIRST,
    JOINT_LOCKED
};

typedef struct scene {
    rig s;
    dmb_id string[2], body[3], joint[3], drive, feed, load[2], stuck, input[3];
    uint32_t inputs;
} scene;

static void add_strings(scene *c, int32_t variant)
{
    for (int i = 0; i < 2; i++) {
        dmb_string_def string = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        const int bars = variant == ORDER_OF_STRINGS ? i == 0 : i == 1;
        string.start_free = variant == RIG_END_FREE && i == 0 ? DMB_FREE_X : DMB_FREE_RX;
        string.follows_hole = bars;
        c->string[i] = add_string(&c->s, &string);
        pipe.string = c->string[i];
        pipe.kind = bars ? DMB_PIPE_AXIAL_TORSIONAL : DMB_PIPE_FLEXIBLE;
        if (i == 0 && variant == MORE_ELEMENTS) pipe.elements = 2;
        (void)add_pipes(&c->s, &pipe, i == 0 && variant == A_BODY_FOR_AN_ELEMENT ? 1 : 2);
        if (i == 0 && variant == MORE_TYPES) pipe.young_modulus *= 0.9;
        (void)add_pipes(&c->s, &pipe, 1);
    }
}

static void add_bodies(scene *c, int32_t variant)
{
    const int count = variant == A_BODY_FOR_AN_ELEMENT ? 3 : 2;
    for (int i = 0; i < count; i++) {
        dmb_body_def body = dmb_body_def_default();
        body.position[0] = 0.4 * i;
        body.contact_diameter = variant == NO_CONTACT ? 0.0 : 0.05;
        c->body[i] = add_body(&c->s, &body);
    }
}

static void add_joints(scene *c, int32_t variant)
{
    const dmb_place ground = dmb_station((dmb_id){0, 0}, 0, 0.0), first = dmb_station(c->body[0], 0, 0.0);
    const dmb_place second = dmb_station(c->body[1], 0, 0.0);
    const int slides = variant == KIND_OF_JOINT;
    dmb_joint_def joint = joint_between(slides ? DMB_JOINT_PRISMATIC : DMB_JOINT_REVOLUTE, ground,
                                        variant == PARTS_OF_JOINT ? second : first);
    joint.match = 1;
    joint.stiffness[slides ? DMB_X : DMB_RX] = 10.0;
    joint.state = variant == JOINT_LOCKED ? DMB_JOINT_LOCKED : DMB_JOINT_ACTIVE;
    c->joint[0] = add_joint(&c->s, &joint);
    joint = joint_between(DMB_JOINT_CYLINDRICAL, ground, variant == PARTS_OF_JOINT ? first : second);
    joint.match = 1;
    c->joint[1] = add_joint(&c->s, &joint);
    if (variant == MORE_JOINTS) {
        joint = joint_between(DMB_JOINT_SPHERICAL, first, second);
        joint.match = 1;
        c->joint[2] = add_joint(&c->s, &joint);
    }
    if (variant == COUPLING_FOR_A_JOINT) {
        dmb_coupling_def gear = dmb_coupling_def_default();
        gear.joint[0] = c->joint[0];
        gear.joint[1] = c->joint[1];
        must_model(&c->s, dmb_model_add_coupling(c->s.model, &gear, NULL));
    }
}

/* A table, a step and a constant. */
static dmb_id add_table(scene *c, int32_t variant)
{
    static const double usual[3] = {0.0, 0.2, 0.3}, other[3] = {0.0, 0.2, 0.4}, values[3] = {0.0, 1.0, 0.5};
    dmb_segment terms[4];
    for (int i = 0; i < 4; i++) terms[i] = dmb_segment_default();
    terms[0].kind = DMB_SEGMENT_TABLE;
    terms[0].table_count = variant == ROWS_OF_TABLE ? 2 : 3;
    terms[0].table_time = variant == TIMES_OF_TABLE ? other : usual;
    terms[0].table_value = values;
    terms[1].kind = variant == KIND_OF_SEGMENT ? DMB_SEGMENT_STEP5 : DMB_SEGMENT_STEP;
    terms[1].x0 = variant == BEGIN_OF_STEP ? 0.06 : 0.05;
    terms[1].x1 = variant == END_OF_STEP ? 0.11 : 0.1;
    terms[1].h1 = 1.0;
    return add_time_function(&c->s, terms, variant == MORE_SEGMENTS ? 4 : 3);
}

static void add_actions(scene *c, int32_t variant)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = variant == KIND_OF_DRIVE ? DMB_DRIVE_LOAD : DMB_DRIVE_CONTROL;
    drive.part = variant == COMPONENT_OF_DRIVE ? c->body[0] : c->string[1];
    drive.component = DMB_RX;
    drive.gain = 10.0;
    drive.time_function = add_table(c, variant);
    c->drive = add_drive(&c->s, &drive);
    c->feed = add_simple_drive(&c->s, DMB_DRIVE_LOAD, c->string[0], variant == RIG_END_FREE ? DMB_X : DMB_RX,
                               drive.time_function);
    (void)add_simple_drive(&c->s, DMB_DRIVE_LOAD, c->joint[variant != JOINT_OF_DRIVE],
                           variant == COORDINATE_OF_DRIVE ? DMB_X : DMB_RX, drive.time_function);
    if (variant == MORE_DRIVES) (void)add_simple_drive(&c->s, DMB_DRIVE_LOAD, c->body[0], DMB_X, drive.time_function);
    if (variant == MORE_TIME_FUNCTIONS) (void)add_constant(&c->s, 1.0);
    for (int i = 0; i < (variant == MORE_LOADS ? 3 : 2); i++) {
        dmb_load_def load = dmb_load_def_default();
        load.place = dmb_station(c->string[0], 0, 1.0);
        load.force[i] = 1.0;
        const dmb_id id = add_load(&c->s, &load);
        if (i < 2) c->load[i] = id;
    }
    if (variant == MORE_BITS) {
        dmb_bit_def bit = dmb_bit_def_default();
        bit.string = c->string[0];
        bit.diameter = 0.0;
        must_model(&c->s, dmb_model_add_bit(c->s.model, &bit, NULL));
    }
    dmb_stuck_def stuck = dmb_stuck_def_default();
    stuck.place = dmb_station(c->string[0], 1, 1.0);
    stuck.stuck = variant == STUCK_AT_FIRST;
    must_model(&c->s, dmb_model_add_stuck(c->s.model, &stuck, &c->stuck));
}

static void add_input(scene *c, int32_t target, dmb_id part, const char *name)
{
    dmb_input_def def = dmb_input_def_default();
    strcpy(def.name, name);
    def.target = target;
    def.part = part;
    def.rate_limit = target == DMB_TARGET_SET_POINT ? 10.0 : 0.0;
    must_model(&c->s, dmb_model_add_input(c->s.model, &def, &c->input[c->inputs++]));
}

static void open_scene(scene *c, int32_t variant, const dmb_sim_options *options)
{
    dmb_wall_def wall = s1_hole();
    memset(c, 0, sizeof *c);
    rig_open(&c->s, 0.0, 0.0, 0.0);
    wall.normal_law = variant == NORMAL_LAW ? DMB_NORMAL_KELVIN_VOIGT : DMB_NORMAL_HUNT_CROSSLEY;
    wall.friction_law = DMB_FRICTION_COULOMB;
    (void)add_wall(&c->s, &wall);
    add_strings(c, variant);
    add_bodies(c, variant);
    add_joints(c, variant);
    add_actions(c, variant);
    add_input(c, DMB_TARGET_SET_POINT, c->drive, "speed");
    add_input(c, variant == TARGET_OF_INPUT ? DMB_TARGET_STUCK : DMB_TARGET_LOAD_FACTOR,
              variant == TARGET_OF_INPUT ? c->stuck : c->load[variant == PART_OF_INPUT], "factor");
    if (variant != TARGET_OF_INPUT) add_input(c, DMB_TARGET_STUCK, c->stuck, "stuck");
    if (variant == MORE_INPUTS || variant == TARGET_OF_INPUT)
        add_input(c, DMB_TARGET_FRICTION, (dmb_id){0, 0}, "friction");
    (void)rig_start(&c->s, options);
}

static int32_t create(const scene *s, const scene *low, const scene *high, dmb_sensitivity **out)
{
    dmb_parameter parameter = dmb_parameter_default();
    strcpy(parameter.name, "this");
    parameter.step = 1e-6;
    parameter.low = low->s.sim;
    parameter.high = high->s.sim;
    return dmb_sensitivity_create(s->s.sim, &parameter, 1, out);
}

/* The status, words of the message, the state as before. */
static void expect(const scene *s, const scene *low, const scene *high, int32_t status, const char *word)
{
    dmb_sensitivity *made = (dmb_sensitivity *)(void *)(uintptr_t)s;
    const uint64_t before = rig_hash(&s->s);
    const int32_t got = create(s, low, high, &made);
    print_message("    %s\n", dmb_sim_message(s->s.sim));
    assert_int_equal(got, status);
    assert_null(made);
    assert_non_null(strstr(dmb_sim_message(s->s.sim), word));
    assert_true(rig_hash(&s->s) == before);
}

static void expect_good(const scene *s, const scene *low, const scene *high)
{
    dmb_sensitivity *made = NULL;
    must(&s->s, create(s, low, high, &made));
    assert_non_null(made);
    dmb_sensitivity_destroy(&made);
}

/* ---- One difference ---------------------------------------------------------------------------------------------- */

static void one_difference(void **state)
{
    static const struct {
        int32_t variant, status;
        const char *word;
    } rows[] = {
        {MORE_ELEMENTS, DMB_ERR_VALUE, "other parts"},
        {A_BODY_FOR_AN_ELEMENT, DMB_ERR_VALUE, "other parts"},
        {ORDER_OF_STRINGS, DMB_ERR_VALUE, "other parts"},
        {RIG_END_FREE, DMB_ERR_VALUE, "other parts"},
        {MORE_DRIVES, DMB_ERR_VALUE, "other parts"},
        {KIND_OF_DRIVE, DMB_ERR_VALUE, "other parts"},
        {COMPONENT_OF_DRIVE, DMB_ERR_VALUE, "other parts"},
        {JOINT_OF_DRIVE, DMB_ERR_VALUE, "other parts"},
        {COORDINATE_OF_DRIVE, DMB_ERR_VALUE, "other parts"},
        {MORE_JOINTS, DMB_ERR_VALUE, "other parts"},
        {KIND_OF_JOINT, DMB_ERR_VALUE, "other parts"},
        {PARTS_OF_JOINT, DMB_ERR_VALUE, "other parts"},
        {COUPLING_FOR_A_JOINT, DMB_ERR_VALUE, "other parts"},
        {NO_CONTACT, DMB_ERR_VALUE, "other parts"},
        {NORMAL_LAW, DMB_ERR_VALUE, "laws; only numbers may differ"},
        {MORE_INPUTS, DMB_ERR_VALUE, "other parts"},
        {TARGET_OF_INPUT, DMB_ERR_VALUE, "other parts"},
        {PART_OF_INPUT, DMB_ERR_VALUE, "other parts"},
        {MORE_LOADS, DMB_ERR_VALUE, "other parts"},
        {MORE_BITS, DMB_ERR_VALUE, "other parts"},
        {MORE_TYPES, DMB_ERR_VALUE, "other parts"},
        {MORE_TIME_FUNCTIONS, DMB_ERR_UNSUPPORTED, "other terms or times"},
        {MORE_SEGMENTS, DMB_ERR_UNSUPPORTED, "other terms or times"},
        {KIND_OF_SEGMENT, DMB_ERR_UNSUPPORTED, "other terms or times"},
        {BEGIN_OF_STEP, DMB_ERR_UNSUPPORTED, "other terms or times"},
        {END_OF_STEP, DMB_ERR_UNSUPPORTED, "other terms or times"},
        {ROWS_OF_TABLE, DMB_ERR_UNSUPPORTED, "other terms or times"},
        {TIMES_OF_TABLE, DMB_ERR_UNSUPPORTED, "other terms or times"},
        {STUCK_AT_FIRST, DMB_ERR_VALUE, "other places stuck"},
        {JOINT_LOCKED, DMB_ERR_VALUE, "other joints locked or open"},
    };
    scene s, low;
    (void)state;
    open_scene(&s, SAME, NULL);
    open_scene(&low, SAME, NULL);
    expect_good(&s, &low, &low);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        scene high;
        open_scene(&high, rows[i].variant, NULL);
        expect(&s, &low, &high, rows[i].status, rows[i].word);
        expect_good(&high, &high, &high);
        rig_close(&high.s);
    }
    rig_close(&s.s);
    rig_close(&low.s);
}

/* ---- Values set by the caller ------------------------------------------------------------------------------------ */

static void what_was_set(void **state)
{
    scene s, low, high;
    (void)state;
    open_scene(&s, SAME, NULL);
    open_scene(&low, SAME, NULL);
    open_scene(&high, SAME, NULL);
    must(&high.s, dmb_sim_set_drive(high.s.sim, high.feed, 0.2));
    expect(&s, &low, &high, DMB_ERR_VALUE, "other drives or inputs set");
    must(&s.s, dmb_sim_set_drive(s.s.sim, s.feed, 0.1));
    must(&low.s, dmb_sim_set_drive(low.s.sim, low.feed, 0.1));
    expect_good(&s, &low, &high);
    must(&high.s, dmb_sim_set_input(high.s.sim, high.input[0], 0.0));
    expect(&s, &low, &high, DMB_ERR_VALUE, "other drives or inputs set");
    must(&s.s, dmb_sim_set_input(s.s.sim, s.input[0], 0.0));
    must(&low.s, dmb_sim_set_input(low.s.sim, low.input[0], 0.0));
    must(&low.s, dmb_sim_set_input(low.s.sim, low.input[1], 4.0));
    expect_good(&s, &low, &high); /* values may differ */
    must(&s.s, dmb_sim_set_input(s.s.sim, s.input[2], 1.0));
    must(&low.s, dmb_sim_set_input(low.s.sim, low.input[2], 1.0));
    must(&high.s, dmb_sim_set_input(high.s.sim, high.input[2], 1.0));
    expect_good(&s, &low, &high);
    must(&high.s, dmb_sim_set_input(high.s.sim, high.input[2], 0.0));
    expect(&s, &low, &high, DMB_ERR_VALUE, "other places stuck");
    must(&high.s, dmb_sim_set_input(high.s.sim, high.input[2], 1.0));
    expect_good(&s, &low, &high);
    must(&high.s, dmb_sim_set_joint(high.s.sim, high.joint[0], DMB_JOINT_LOCKED));
    expect(&s, &low, &high, DMB_ERR_VALUE, "other joints locked");
    rig_close(&s.s);
    rig_close(&low.s);
    rig_close(&high.s);
}

/* A set point that goes to what is set at 10 rad/s2 has not arrived, of a side and of the sim itself. */
static void inputs_on_their_way(void **state)
{
    scene c[3];
    (void)state;
    for (int i = 0; i < 3; i++) {
        open_scene(&c[i], SAME, NULL);
        must(&c[i].s, dmb_sim_set_input(c[i].s.sim, c[i].input[0], i < 2 ? 1e-3 : 1.0));
        must(&c[i].s, dmb_sim_step(c[i].s.sim, 1e-3, NULL));
    }
    expect_good(&c[0], &c[1], &c[1]);
    expect(&c[0], &c[1], &c[2], DMB_ERR_VALUE, "high has input 0 (speed) still changing");
    expect(&c[2], &c[0], &c[1], DMB_ERR_VALUE, "input 0 (speed) is still changing");
    for (int i = 0; i < 3; i++) rig_close(&c[i].s);
}

/* ---- Scenes without a derivative --------------------------------------------------------------------------------- */

static void multipliers_of_joints(void **state)
{
    dmb_sim_options options = dmb_sim_options_default();
    scene s;
    (void)state;
    options.constraint_method = DMB_METHOD_MULTIPLIERS;
    open_scene(&s, SAME, &options);
    expect(&s, &s, &s, DMB_ERR_UNSUPPORTED, "must be DMB_METHOD_INDEPENDENT");
    rig_close(&s.s);
}

/* A chain of bodies, so long that its joints are solved by sparse matrices. */
static void a_long_chain(void **state)
{
    scene s;
    dmb_place last = dmb_station((dmb_id){0, 0}, 0, 0.0);
    (void)state;
    memset(&s, 0, sizeof s);
    rig_open(&s.s, 0.0, 0.0, -9.81);
    for (int i = 0; i < 12; i++) {
        dmb_body_def body = dmb_body_def_default();
        body.position[0] = 0.5 * i;
        const dmb_place next = dmb_station(add_body(&s.s, &body), 0, 0.0);
        dmb_joint_def joint = joint_between(DMB_JOINT_SPHERICAL, last, next);
        joint.origin_a[0] = i > 0 ? 0.5 : 0.0;
        (void)add_joint(&s.s, &joint);
        last = next;
    }
    (void)rig_start(&s.s, NULL);
    expect(&s, &s, &s, DMB_ERR_TOO_LARGE, "flexible pipes between joints divide a cluster");
    rig_close(&s.s);
}

/* ---- Constraints of the caller ----------------------------------------------------------------------------------- */

static int32_t keep_level(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                          double *jacobian)
{
    (void)context, (void)time, (void)jacobian;
    value[0] = poses[0][2] + poses[count - 1][2];
    value[1] = poses[0][1];
    return 0;
}

/* Two bodies, and what holds them: one row on the first, two rows, one row on both, one on the second, a spring. */
enum { ONE_ROW, TWO_ROWS, BOTH_BODIES, SECOND_BODY, A_SPRING, HOLDS };

static void open_held(scene *c, int holds)
{
    dmb_constraint_def rule = dmb_constraint_def_default();
    dmb_spring_def spring = dmb_spring_def_default();
    memset(c, 0, sizeof *c);
    rig_open(&c->s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 2; i++) {
        dmb_body_def body = dmb_body_def_default();
        body.position[0] = i;
        c->body[i] = add_body(&c->s, &body);
    }
    rule.row_count = holds == TWO_ROWS ? 2 : 1;
    rule.place_count = holds == BOTH_BODIES ? 2 : 1;
    rule.place[0] = spring.place_a = dmb_station(c->body[holds == SECOND_BODY], 0, 0.0);
    rule.place[1] = spring.place_b = dmb_station(c->body[1], 0, 0.0);
    rule.callback = keep_level;
    spring.stiffness = 10.0;
    if (holds == A_SPRING)
        must_model(&c->s, dmb_model_add_spring(c->s.model, &spring, NULL));
    else
        must_model(&c->s, dmb_model_add_constraint(c->s.model, &rule, NULL));
    (void)rig_start(&c->s, NULL);
}

static void held_in_other_ways(void **state)
{
    scene s, low;
    (void)state;
    open_held(&s, ONE_ROW);
    open_held(&low, ONE_ROW);
    expect_good(&s, &low, &low);
    for (int holds = TWO_ROWS; holds < HOLDS; holds++) {
        scene high;
        open_held(&high, holds);
        expect(&s, &low, &high, DMB_ERR_VALUE, "other parts");
        rig_close(&high.s);
    }
    rig_close(&s.s);
    rig_close(&low.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_difference),        cmocka_unit_test(what_was_set), cmocka_unit_test(inputs_on_their_way),
        cmocka_unit_test(multipliers_of_joints), cmocka_unit_test(a_long_chain), cmocka_unit_test(held_in_other_ways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
