/* Definitions that are refused for what their fields are together, or in a scene as compile sees it: the status, what
 * the message names, and a model that goes on. */
#include <stdio.h>
#include <string.h>

#include "rig.h"

/* A string of two pipes with its hole, a body that hangs on a hinge below it, one that stands by itself; mud. */
typedef struct scene {
    rig s;
    dmb_id string, body, hinge, slide, time_function;
} scene;

static void open_scene(scene *c)
{
    const dmb_wall_def hole = s1_hole();
    const dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    const dmb_body_def body = dmb_body_def_default();
    rig_open(&c->s, 0.0, 0.0, 0.0);
    (void)add_wall(&c->s, &hole);
    c->string = pipe.string = add_string(&c->s, &string);
    (void)add_pipes(&c->s, &pipe, 2);
    c->body = add_body(&c->s, &body);
    const dmb_place far_end = dmb_station(c->string, 1, 1.0), ground = dmb_station((dmb_id){0, 0}, 0, 0.0);
    dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, far_end, dmb_station(c->body, 0, 0.0));
    joint.match = 1;
    c->hinge = add_joint(&c->s, &joint);
    joint = joint_between(DMB_JOINT_PRISMATIC, ground, dmb_station(add_body(&c->s, &body), 0, 0.0));
    c->slide = add_joint(&c->s, &joint);
    c->time_function = add_constant(&c->s, 0.0);
}

static dmb_environment_def muddy(void)
{
    dmb_environment_def mud = dmb_environment_def_default();
    mud.fluid_density = 1200.0;
    mud.consistency = 0.05;
    mud.flow_rate = 0.01;
    return mud;
}

static void says(const rig *s, const char *word)
{
    print_message("    %s\n", dmb_model_message(s->model));
    if (strstr(dmb_model_message(s->model), word) == NULL) fail_msg("no \"%s\"", word);
}

/* Refused, and after it the model is as if nothing had been said. */
static void refused(scene *c, int32_t got, int32_t status, const char *word)
{
    says(&c->s, word);
    if (got != status) fail_msg("%s", dmb_status_name(got));
    must_model(&c->s, dmb_model_clear_refused(c->s.model));
}

static void not_compiled(scene *c, int32_t status, const char *word)
{
    const int32_t got = dmb_model_compile(c->s.model, NULL);
    says(&c->s, word);
    if (got != status) fail_msg("%s", dmb_status_name(got));
    rig_close(&c->s);
}

/* ---- Drives ------------------------------------------------------------------------------------------------------ */

static void actuators_of_motion_drives(void **state)
{
    (void)state;
    scene c;
    open_scene(&c);
    for (int k = 0; k < 6; k++) {
        dmb_drive_def drive = dmb_drive_def_default();
        drive.time_function = c.time_function;
        drive.delay = k == 0 ? 0.1 : 0.0;
        drive.force_rate = k == 1 ? 10.0 : 0.0;
        drive.lag = k == 2 ? 0.1 : 0.0;
        drive.drag = k == 3 ? 1.0 : 0.0;
        drive.back_drag = k == 4 ? 1.0 : 0.0;
        drive.curve_count = k == 5 ? 2 : 0;
        drive.curve_speed[1] = drive.curve_force[0] = 10.0;
        refused(&c, dmb_model_add_drive(c.s.model, &drive, NULL), DMB_ERR_UNSUPPORTED,
                "must be DMB_DRIVE_LOAD or _CONTROL with delay");
    }
    rig_close(&c.s);
}

static void rotors_and_motors(void **state)
{
    (void)state;
    scene c;
    open_scene(&c);
    dmb_drive_def drive = dmb_drive_def_default();
    drive.time_function = c.time_function;
    drive.kind = DMB_DRIVE_LOAD;
    drive.inertia = 0.1;
    drive.component = DMB_X;
    refused(&c, dmb_model_add_drive(c.s.model, &drive, NULL), DMB_ERR_UNSUPPORTED, "inertia = 0.1, must be 0 but of");
    drive.component = DMB_RX;
    drive.part = c.hinge;
    refused(&c, dmb_model_add_drive(c.s.model, &drive, NULL), DMB_ERR_UNSUPPORTED, "inertia = 0.1, must be 0 but of");
    drive.inertia = 0.0;
    drive.mud_pressure = 1e4;
    drive.part = c.slide;
    drive.component = DMB_X;
    refused(&c, dmb_model_add_drive(c.s.model, &drive, NULL), DMB_ERR_UNSUPPORTED, "the shaft of a motor");
    drive.part = c.string;
    drive.component = DMB_RX;
    refused(&c, dmb_model_add_drive(c.s.model, &drive, NULL), DMB_ERR_UNSUPPORTED, "the shaft of a motor");
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_CALLBACK;
    refused(&c, dmb_model_add_time_function(c.s.model, &term, 1, NULL), DMB_ERR_NULL, "callback is NULL");
    term.provides = 64;
    refused(&c, dmb_model_add_time_function(c.s.model, &term, 1, NULL), DMB_ERR_VALUE, "provides");
    rig_close(&c.s);
}

/* ---- Joints, springs, forces, stuck places ----------------------------------------------------------------------- */

static int32_t nothing_done(void *context, double time, uint32_t count, const double (*poses)[12],
                            const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                            const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)poses, (void)velocities, (void)forces, (void)tangent, (void)potential;
    return 0;
}

static void frames_and_grounds(void **state)
{
    (void)state;
    scene c;
    open_scene(&c);
    dmb_joint_def joint = dmb_joint_def_default();
    refused(&c, dmb_model_add_joint(c.s.model, &joint, NULL), DMB_ERR_VALUE, "the ground as place_a");
    joint.place_a = joint.place_b = dmb_station(c.body, 0, 0.0);
    refused(&c, dmb_model_add_joint(c.s.model, &joint, NULL), DMB_ERR_VALUE, "place_b = place_a");
    joint.place_a = joint.place_b = dmb_station(c.string, 0, 1.0);
    refused(&c, dmb_model_add_joint(c.s.model, &joint, NULL), DMB_ERR_VALUE, "place_b = place_a");
    joint.place_a.fraction = 0.0;
    joint.kind = 99;
    joint.place_a.part = joint.place_b.part = (dmb_id){0, 0}; /* the first fault is told */
    refused(&c, dmb_model_add_joint(c.s.model, &joint, NULL), DMB_ERR_VALUE, "kind = 99");
    for (int k = 0; k < 3; k++) { /* a normal along the axis */
        joint = dmb_joint_def_default();
        joint.place_b = dmb_station(c.body, 0, 0.0);
        joint.axis_a[0] = 0.0;
        joint.axis_a[k] = joint.normal_a[k] = 1.0;
        refused(&c, dmb_model_add_joint(c.s.model, &joint, NULL), DMB_ERR_VALUE, "normal_a = 1, must be 0 or away");
    }
    rig_close(&c.s);
}

/* Points that differ in one thing alone are two points. */
static void points_of_springs(void **state)
{
    (void)state;
    scene c;
    open_scene(&c);
    dmb_spring_def spring = dmb_spring_def_default();
    spring.stiffness = 1.0;
    refused(&c, dmb_model_add_spring(c.s.model, &spring, NULL), DMB_ERR_VALUE, "the ground as place_a");
    for (int k = 0; k < 5; k++) {
        spring.place_a = spring.place_b = dmb_station(c.string, 0, 1.0);
        for (int i = 0; i < 3; i++) spring.offset_a[i] = spring.offset_b[i] = 0.5;
        refused(&c, dmb_model_add_spring(c.s.model, &spring, NULL), DMB_ERR_VALUE, "the point of place_a");
        if (k < 3) spring.offset_b[k] = 0.25;
        if (k == 3) spring.place_b.fraction = 0.0;
        if (k == 4) spring.place_b.pipe = 1;
        must_model(&c.s, dmb_model_add_spring(c.s.model, &spring, NULL));
        spring.offset_b[0] = 0.75; /* and beyond */
        must_model(&c.s, dmb_model_add_spring(c.s.model, &spring, NULL));
    }
    rig_close(&c.s);
}

static void arguments_of_forces(void **state)
{
    (void)state;
    scene c;
    open_scene(&c);
    dmb_force_def force = dmb_force_def_default();
    force.place[0] = dmb_station(c.hinge, 0, 0.0);
    force.component[0] = DMB_RX;
    refused(&c, dmb_model_add_force(c.s.model, &force, NULL), DMB_ERR_NULL, "callback");
    force.callback = nothing_done;
    must_model(&c.s, dmb_model_add_force(c.s.model, &force, NULL));
    force.component[0] = DMB_X;
    refused(&c, dmb_model_add_force(c.s.model, &force, NULL), DMB_ERR_VALUE,
            "component[0] = 0, must be free in its joint");
    force.component[0] = 7;
    refused(&c, dmb_model_add_force(c.s.model, &force, NULL), DMB_ERR_VALUE, "component[0] = 7");
    rig_close(&c.s);
}

static void sizes_of_structs(void **state)
{
    (void)state;
    scene c;
    open_scene(&c);
#define WRONG_SIZE(what)                                                                               \
    do {                                                                                               \
        dmb_##what##_def def = dmb_##what##_def_default();                                             \
        def.struct_size = 3;                                                                           \
        assert_int_equal(dmb_model_add_##what(c.s.model, &def, NULL), DMB_ERR_STRUCT_SIZE);            \
        must_model(&c.s, dmb_model_clear_refused(c.s.model));                                          \
        assert_int_equal(dmb_model_add_##what(NULL, &def, NULL), DMB_ERR_NULL);                        \
        assert_int_equal(dmb_model_add_##what((dmb_model *)(void *)&def, &def, NULL), DMB_ERR_HANDLE); \
    } while (0)
    WRONG_SIZE(spring);
    WRONG_SIZE(force);
    WRONG_SIZE(stuck);
    WRONG_SIZE(input);
    WRONG_SIZE(event);
    WRONG_SIZE(stabiliser);
    WRONG_SIZE(joint);
    WRONG_SIZE(coupling);
    WRONG_SIZE(constraint);
    WRONG_SIZE(drive);
    WRONG_SIZE(load);
    WRONG_SIZE(body);
    WRONG_SIZE(bit);
    WRONG_SIZE(string);
#undef WRONG_SIZE
    dmb_hole_section sections[2] = {dmb_hole_section_default(), dmb_hole_section_default()};
    sections[1].depth = 5.0;
    sections[1].struct_size -= 8;
    refused(&c, dmb_model_add_hole_sections(c.s.model, sections, 2), DMB_ERR_STRUCT_SIZE, "");
    sections[1].struct_size += 8;
    must_model(&c.s, dmb_model_add_hole_sections(c.s.model, sections, 2));
    refused(&c, dmb_model_add_hole_sections(c.s.model, sections + 1, 1), DMB_ERR_VALUE, "depth");
    rig_close(&c.s);
}

/* ---- Inputs and events ------------------------------------------------------------------------------------------- */

static dmb_input_def input_named(const char *name, int32_t target, dmb_id part)
{
    dmb_input_def def = dmb_input_def_default();
    (void)snprintf(def.name, sizeof def.name, "%s", name);
    def.target = target;
    def.part = part;
    return def;
}

static void inputs_and_events(void **state)
{
    (void)state;
    scene c;
    open_scene(&c);
    dmb_stuck_def stuck = dmb_stuck_def_default();
    dmb_id jam = {0, 0}, load[2] = {{0, 0}, {0, 0}};
    stuck.place = dmb_station(c.string, 0, 1.0);
    must_model(&c.s, dmb_model_add_stuck(c.s.model, &stuck, &jam));
    for (int i = 0; i < 2; i++) {
        dmb_load_def def = dmb_load_def_default();
        def.place = stuck.place;
        load[i] = add_load(&c.s, &def);
    }
    dmb_input_def def = input_named("jam", DMB_TARGET_STUCK, jam);
    def.initial = 0.5;
    refused(&c, dmb_model_add_input(c.s.model, &def, NULL), DMB_ERR_VALUE, "initial = 0.5, must be 0 (free) or 1");
    def.initial = 1.0;
    def.slope_limit = 2.0;
    refused(&c, dmb_model_add_input(c.s.model, &def, NULL), DMB_ERR_UNSUPPORTED,
            "slope_limit = 2, must be 0: only set");
    def.slope_limit = 0.0;
    def.low = 2.0;
    refused(&c, dmb_model_add_input(c.s.model, &def, NULL), DMB_ERR_VALUE, "low = 2, must be within");
    def.low = -2.0;
    def.high = -1.0;
    refused(&c, dmb_model_add_input(c.s.model, &def, NULL), DMB_ERR_VALUE, "high = -1, must be within");
    def = input_named("part", DMB_TARGET_FRICTION, c.string);
    refused(&c, dmb_model_add_input(c.s.model, &def, NULL), DMB_ERR_ID, "part must be {0, 0}");
    def = input_named("one", DMB_TARGET_LOAD_FACTOR, load[0]);
    must_model(&c.s, dmb_model_add_input(c.s.model, &def, NULL));
    def = input_named("one", DMB_TARGET_LOAD_FACTOR, load[1]);
    refused(&c, dmb_model_add_input(c.s.model, &def, NULL), DMB_ERR_VALUE,
            "name = one, must be of its own, and input 0 has it");
    def = input_named("two", DMB_TARGET_LOAD_FACTOR, load[0]);
    refused(&c, dmb_model_add_input(c.s.model, &def, NULL), DMB_ERR_VALUE, "its target is that of input 0 (one)");
    def = input_named("two", DMB_TARGET_LOAD_FACTOR, load[1]); /* the same target of another load */
    must_model(&c.s, dmb_model_add_input(c.s.model, &def, NULL));
    dmb_event_def event = dmb_event_def_default(), kept = event;
    event.output.place = dmb_station(c.body, 0, 0.0);
    refused(&c, dmb_model_add_event(c.s.model, &event, NULL), DMB_ERR_VALUE, "name is empty");
    (void)snprintf(event.name, sizeof event.name, "first");
    must_model(&c.s, dmb_model_add_event(c.s.model, &event, NULL));
    refused(&c, dmb_model_add_event(c.s.model, &event, NULL), DMB_ERR_VALUE,
            "name = first, must be of its own, and event 0 has it");
    (void)snprintf(event.name, sizeof event.name, "second");
    event.direction = DMB_EVENT_EITHER;
    event.hold = 1.0;
    refused(&c, dmb_model_add_event(c.s.model, &event, NULL), DMB_ERR_VALUE,
            "hold = 1, must be 0 with DMB_EVENT_EITHER");
    event.level = (double)NAN;
    refused(&c, dmb_model_add_event(c.s.model, &event, NULL), DMB_ERR_NOT_FINITE, "level");
    event.level = event.hold = 0.0;
    must_model(&c.s, dmb_model_add_event(c.s.model, &event, NULL));
    dmb_id found = {0, 0};
    must_model(&c.s, dmb_model_find_event(c.s.model, "second", &found));
    must_model(&c.s, dmb_model_get_event(c.s.model, found.index & 0xFFFFFF, &kept));
    assert_string_equal(kept.name, "second");
    assert_int_equal(dmb_model_find_event(c.s.model, "third", &found), DMB_ERR_ID);
    assert_int_equal(dmb_model_get_event(c.s.model, 2, &kept), DMB_ERR_ID);
    rig_close(&c.s);
}

/* A density that changes moves neither mud that goes along nor the moments of what is not round. */
static void density_that_changes(void **state)
{
    static const char *const words[7] = {"where added_mass is 0",
                                         "where the added_mass of bodies is 0",
                                         "where the added_mass of bits is 0",
                                         "where the added_mass of rings is 0",
                                         "where flow_rate is 0",
                                         "no input has the target DMB_TARGET_FLOW_RATE",
                                         "their centre on the x axis"};
    (void)state;
    for (int k = 0; k < 7; k++)
        for (int along = 0; along < 2; along++) {
            scene c;
            open_scene(&c);
            dmb_environment_def mud = muddy();
            mud.flow_rate = k == 4 ? 0.01 : 0.0;
            mud.added_mass = k > 0 ? 0.0 : along ? 1.0 : -1.0;
            must_model(&c.s, dmb_model_set_environment(c.s.model, &mud));
            dmb_body_def body = dmb_body_def_default();
            dmb_bit_def bit = dmb_bit_def_default();
            dmb_stabiliser_def stabiliser = dmb_stabiliser_def_default();
            if (k == 1) body.added_mass[along] = 1.0;
            if (k == 2) bit.added_mass[along] = 1.0;
            stabiliser.added_mass[0] = k == 3 && along ? 1.0 : 0.0;
            stabiliser.added_mass[1] = k == 3 && !along ? 1.0 : 0.0;
            body.displaced_volume = 1e-3;
            body.centre[0] = 0.5;
            if (k == 6) body.centre[1 + along] = 0.1;
            (void)add_body(&c.s, &body);
            bit.diameter = 0.0;
            if (k == 2) must_model(&c.s, dmb_model_add_bit(c.s.model, &bit, NULL));
            must_model(&c.s, dmb_model_add_stabiliser(c.s.model, &stabiliser, NULL));
            dmb_input_def def = input_named("density", DMB_TARGET_FLUID_DENSITY, (dmb_id){0, 0});
            must_model(&c.s, dmb_model_add_input(c.s.model, &def, NULL));
            def = input_named("flow", DMB_TARGET_FLOW_RATE, (dmb_id){0, 0});
            if (k == 5) must_model(&c.s, dmb_model_add_input(c.s.model, &def, NULL));
            not_compiled(&c, DMB_ERR_UNSUPPORTED, words[k]);
        }
}

/* The limits of a drive at time 0, set by inputs or described. */
static void limits_at_the_start(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        scene c;
        open_scene(&c);
        dmb_drive_def drive = dmb_drive_def_default();
        drive.kind = DMB_DRIVE_CONTROL;
        drive.time_function = c.time_function;
        drive.gain = 1.0;
        drive.limit_low = -5.0;
        drive.limit_high = 5.0;
        const dmb_id first = add_drive(&c.s, &drive);
        drive.component = DMB_RX;
        const dmb_id id = add_drive(&c.s, &drive);
        dmb_input_def other = input_named("other", DMB_TARGET_LIMIT_LOW, first);
        dmb_input_def low = input_named("low", DMB_TARGET_LIMIT_LOW, id);
        dmb_input_def high = input_named("high", DMB_TARGET_LIMIT_HIGH, id);
        other.initial = 4.0;
        low.initial = k == 0 ? 6.0 : k == 1 ? 2.0 : (double)NAN;
        high.initial = k == 1 ? 1.0 : k == 2 ? -5.0 : (double)NAN;
        must_model(&c.s, dmb_model_add_input(c.s.model, &other, NULL));
        must_model(&c.s, dmb_model_add_input(c.s.model, &low, NULL));
        must_model(&c.s, dmb_model_add_input(c.s.model, &high, NULL));
        not_compiled(&c, DMB_ERR_VALUE, "must be < limit_high");
    }
}

/* ---- Mud --------------------------------------------------------------------------------------------------------- */

static void mud_that_cannot_flow(void **state)
{
    static const char *const words[] = {"inner_density = 0, must be > 0 with a flow_rate",
                                        "in a model with other than one string",
                                        "without a string that follows its hole",
                                        "must be on a joint at the far end",
                                        "fluid_density of the environment is 0",
                                        "inner_density of the environment is 0",
                                        "consistency of the environment is 0",
                                        "the Reynolds number at",
                                        "the Reynolds number at",
                                        "must leave the mud an annulus"};
    static const int32_t statuses[] = {DMB_ERR_VALUE, DMB_ERR_UNSUPPORTED, DMB_ERR_UNSUPPORTED, DMB_ERR_UNSUPPORTED,
                                       DMB_ERR_VALUE, DMB_ERR_VALUE,       DMB_ERR_VALUE,       DMB_ERR_VALUE,
                                       DMB_ERR_VALUE, DMB_ERR_GEOMETRY};
    (void)state;
    for (int k = 0; k < 10; k++) {
        scene c;
        dmb_environment_def mud = muddy();
        dmb_string_def string = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        dmb_wall_def hole = s1_hole();
        memset(&c, 0, sizeof c);
        rig_open(&c.s, 0.0, 0.0, 0.0);
        if (k == 9) hole.diameter = pipe.outer_diameter * (1.0 + 1e-5);
        (void)add_wall(&c.s, &hole);
        string.follows_hole = k != 2;
        if (k == 0 || k == 5) mud.inner_density = 0.0;
        if (k == 4) mud.fluid_density = 0.0;
        if (k == 6) mud.consistency = 0.0;
        if (k >= 4 && k <= 6) mud.flow_rate = 0.0;
        if (k == 7 || k == 8) mud.flow_rate = 5.0;
        if (k == 7) pipe.inner_diameter = 1e-3; /* the faster flow is that in the bore */
        if (k == 0) {
            refused(&c, dmb_model_set_environment(c.s.model, &mud), statuses[k], words[k]);
            rig_close(&c.s);
            continue;
        }
        must_model(&c.s, dmb_model_set_environment(c.s.model, &mud));
        pipe.string = add_string(&c.s, &string);
        (void)add_pipes(&c.s, &pipe, 2);
        if (k == 1) {
            pipe.string = add_string(&c.s, &string);
            (void)add_pipes(&c.s, &pipe, 1);
        }
        if (k == 3) { /* a motor in the middle */
            dmb_body_def shaft = dmb_body_def_default();
            dmb_drive_def motor = dmb_drive_def_default();
            dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, dmb_station(pipe.string, 0, 1.0),
                                                dmb_station(add_body(&c.s, &shaft), 0, 0.0));
            joint.match = 1;
            motor.kind = DMB_DRIVE_LOAD;
            motor.part = add_joint(&c.s, &joint);
            motor.component = DMB_RX;
            motor.mud_pressure = 1e3;
            motor.time_function = add_constant(&c.s, 0.0);
            (void)add_drive(&c.s, &motor);
        }
        const dmb_input_def input = input_named("pump", DMB_TARGET_FLOW_RATE, (dmb_id){0, 0});
        if (k >= 4 && k <= 6) must_model(&c.s, dmb_model_add_input(c.s.model, &input, NULL));
        not_compiled(&c, statuses[k], words[k]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(actuators_of_motion_drives), cmocka_unit_test(rotors_and_motors),
        cmocka_unit_test(frames_and_grounds),         cmocka_unit_test(points_of_springs),
        cmocka_unit_test(arguments_of_forces),        cmocka_unit_test(sizes_of_structs),
        cmocka_unit_test(inputs_and_events),          cmocka_unit_test(density_that_changes),
        cmocka_unit_test(limits_at_the_start),        cmocka_unit_test(mud_that_cannot_flow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
