/* A state goes on only in a sim of the same parts: each difference that matters is refused by a message that names the
 * part and the field, and nothing changes. */
#include <string.h>

#include "rig.h"

/* The difference between the model that goes on and the first. */
typedef enum difference {
    SAME,
    ONE_STRING,
    ONE_BODY,
    ONE_BIT,
    NO_DRIVE,
    NO_LOAD,
    NO_INPUT,
    NO_EVENT,
    NO_WALL,
    NO_JOINT,
    NO_COUPLING,
    NO_CONSTRAINT,
    SPRING,
    FORCE,
    STUCK,
    BODY_AT_END,
    BODY_ON_SECOND,
    BIT_ON_SECOND,
    REAMER_RING,
    ROCK_LAW,
    BLADES,
    HISTORY,
    DRIVE_KIND,
    DRIVE_COMPONENT,
    DRIVE_PART,
    ACTUATOR,
    DELAY,
    LOAD_FRAME,
    LOAD_PART,
    INPUT_NAME,
    INPUT_TARGET,
    INPUT_PART,
    INPUT_BOUNDS,
    INPUT_LOWER_BOUND,
    INPUT_INITIAL,
    EVENT_NAME,
    EVENT_DIRECTION,
    EVENT_OUTPUT,
    JOINT_KIND,
    JOINT_PART,
    JOINT_GROUND,
    JOINT_FAR_PART,
    COUPLING_COUNT,
    COUPLING_JOINT,
    COUPLING_COMPONENT,
    CONSTRAINT_KIND,
    CONSTRAINT_ROWS,
    CONSTRAINT_PLACES,
    NORMAL_LAW,
    FRICTION_LAW,
    WALL_ORIGIN,
    WALL_STATIONS,
    WALL_DEPTHS,
    WALL_DIRECTIONS,
    PIPE_KIND,
    PIPE_ELEMENTS,
    PIPE_LENGTH,
    JOINT_LENGTH,
    PIPE_SECTION,
    RING_PLACE,
    FLUID
} difference;

typedef struct scene {
    rig r;
    dmb_id string, second, ring[2], block, arm, hinge, axle, bit, reamer, drives[3], loads[2];
} scene;

/* ---- Parts of a scene -------------------------------------------------------------------------------------------- */

static void add_hole(scene *s, difference d)
{
    static const double bent[9] = {0.0, PI / 2.0, 0.0, 30.0, PI / 2.0, 0.0, 60.0, 1.56, 0.0};
    static const double more[9] = {0.0, PI / 2.0, 0.0, 30.0, PI / 2.0, 0.0, 60.0, 1.55, 0.0};
    static const double later[9] = {0.0, PI / 2.0, 0.0, 31.0, PI / 2.0, 0.0, 60.0, 1.56, 0.0};
    dmb_wall_def wall = s1_hole();
    wall.survey = d == WALL_DIRECTIONS ? more : d == WALL_DEPTHS ? later : bent;
    wall.survey_count = d == WALL_STATIONS ? 2 : 3;
    if (d == WALL_ORIGIN) wall.origin[2] = 1.0;
    if (d == NORMAL_LAW) wall.normal_law = DMB_NORMAL_HUNT_CROSSLEY;
    if (d == FRICTION_LAW) wall.friction_law = DMB_FRICTION_BRISTLE;
    if (d != NO_WALL) (void)add_wall(&s->r, &wall);
}

static void add_stabiliser_at(scene *s, int i, double fraction)
{
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    ring.string = s->string;
    ring.pipe = 1;
    ring.fraction = fraction;
    ring.length = 0.2;
    must_model(&s->r, dmb_model_add_stabiliser(s->r.model, &ring, &s->ring[i]));
}

static void add_strings(scene *s, difference d)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    s->string = add_string(&s->r, &string);
    pipe.string = s->string;
    pipe.elements = d == PIPE_ELEMENTS ? 4 : 2;
    if (d == PIPE_KIND) pipe.kind = DMB_PIPE_RIGID;
    if (d == PIPE_LENGTH) pipe.length = 1.4;
    if (d == JOINT_LENGTH) pipe.joint_length = 0.1, pipe.joint_outer_diameter = 0.08;
    if (d == PIPE_SECTION) pipe.outer_diameter = 0.074;
    (void)add_pipes(&s->r, &pipe, 3);
    add_stabiliser_at(s, 0, 0.3);
    add_stabiliser_at(s, 1, d == RING_PLACE ? 0.5 : 0.7);
    string.start_depth = 20.0;
    if (d == ONE_STRING) return;
    s->second = add_string(&s->r, &string);
    pipe = s1_pipe();
    pipe.string = s->second;
    (void)add_pipes(&s->r, &pipe, 2);
}

static void add_bodies(scene *s, difference d)
{
    dmb_body_def body = dmb_body_def_default();
    body.attach = d == BODY_AT_END ? DMB_ATTACH_END : DMB_ATTACH_START;
    body.string = d == BODY_ON_SECOND ? s->second : s->string;
    (void)add_body(&s->r, &body);
    body = dmb_body_def_default();
    body.position[2] = 5.0;
    s->block = add_body(&s->r, &body);
    if (d != ONE_BODY) s->arm = add_body(&s->r, &body);
}

static void add_bits(scene *s, difference d)
{
    dmb_bit_def bit = dmb_bit_def_default();
    bit.string = d == BIT_ON_SECOND ? s->second : s->string;
    bit.rock_law = d == ROCK_LAW ? DMB_ROCK_RATE : DMB_ROCK_REGENERATIVE;
    bit.bottom = 1.0;
    if (d == BLADES) bit.blades = 3;
    if (d == HISTORY) bit.history = 256;
    must_model(&s->r, dmb_model_add_bit(s->r.model, &bit, &s->bit));
    bit = dmb_bit_def_default();
    bit.rock_law = DMB_ROCK_RATE;
    bit.bottom = 1.0;
    bit.stabiliser = s->ring[d == REAMER_RING];
    if (d != ONE_BIT) must_model(&s->r, dmb_model_add_bit(s->r.model, &bit, &s->reamer));
}

static void add_drives(scene *s, difference d)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = s->string;
    drive.time_function = add_constant(&s->r, 0.0);
    s->drives[0] = add_drive(&s->r, &drive);
    drive.kind = d == DRIVE_KIND ? DMB_DRIVE_CONTROL : DMB_DRIVE_LOAD;
    drive.part = d == DRIVE_PART ? s->block : s->string;
    drive.component = DMB_RX;
    if (d == DRIVE_COMPONENT) drive.part = s->block, drive.component = DMB_RY;
    if (d == DRIVE_KIND) drive.gain = 1.0;
    if (d == ACTUATOR) drive.lag = 0.1;
    s->drives[1] = add_drive(&s->r, &drive);
    if (d == NO_DRIVE) return;
    drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_LOAD;
    drive.part = s->arm;
    drive.component = DMB_Y;
    drive.time_function = add_constant(&s->r, 0.0);
    drive.delay = d == DELAY ? 0.2 : 0.1;
    if (d != ONE_BODY) s->drives[2] = add_drive(&s->r, &drive);
}

static void add_loads(scene *s, difference d)
{
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(d == LOAD_PART ? s->block : s->string, 0, 0.0);
    load.frame = d == LOAD_FRAME ? DMB_FRAME_BODY : DMB_FRAME_WORLD;
    s->loads[0] = add_load(&s->r, &load);
    load = dmb_load_def_default();
    load.place = dmb_station(s->block, 0, 0.0);
    if (d != NO_LOAD) s->loads[1] = add_load(&s->r, &load);
}

static void add_inputs(scene *s, difference d)
{
    dmb_input_def input = dmb_input_def_default();
    strcpy(input.name, d == INPUT_NAME ? "torque" : "push");
    input.target = d == INPUT_TARGET ? DMB_TARGET_SET_POINT : DMB_TARGET_LOAD_FACTOR;
    input.part = d == INPUT_TARGET ? s->drives[1] : s->loads[0];
    if (d == INPUT_PART) input.part = s->loads[1];
    input.low = d == INPUT_LOWER_BOUND ? -3.0 : -2.0;
    input.high = d == INPUT_BOUNDS ? 3.0 : 2.0;
    if (d == INPUT_INITIAL) input.initial = 1.0;
    if (d != NO_INPUT) must_model(&s->r, dmb_model_add_input(s->r.model, &input, NULL));
}

static void add_events(scene *s, difference d)
{
    dmb_event_def event = dmb_event_def_default();
    strcpy(event.name, d == EVENT_NAME ? "down" : "up");
    event.direction = d == EVENT_DIRECTION ? DMB_EVENT_FALLING : DMB_EVENT_RISING;
    event.output.place = dmb_station(s->block, 0, 0.0);
    event.output.quantity = d == EVENT_OUTPUT ? DMB_OUTPUT_POSITION_Y : DMB_OUTPUT_POSITION_Z;
    event.level = 9.0;
    if (d != NO_EVENT) must_model(&s->r, dmb_model_add_event(s->r.model, &event, NULL));
}

static int32_t level(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                     double *jacobian)
{
    (void)context, (void)time, (void)jacobian;
    value[0] = poses[0][1];
    value[1] = poses[count - 1][2] - 5.0;
    return 0;
}

/* Rows of `level` are two; of the speed kind, the Jacobian is its own. */
static int32_t speed_level(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                           double *jacobian)
{
    (void)context, (void)time, (void)poses;
    value[0] = value[1] = 0.0;
    if (jacobian == NULL) return 0;
    memset(jacobian, 0, 12 * (size_t)count * sizeof *jacobian);
    jacobian[1] = jacobian[6 * (size_t)count + 2] = 1.0;
    return 0;
}

static int32_t one_level(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                         double *jacobian)
{
    (void)context, (void)time, (void)count, (void)jacobian;
    value[0] = poses[0][1];
    return 0;
}

static void add_rule(scene *s, difference d)
{
    dmb_constraint_def rule = dmb_constraint_def_default();
    rule.row_count = d == CONSTRAINT_ROWS ? 1 : 2;
    rule.callback = d == CONSTRAINT_ROWS ? one_level : level;
    rule.place_count = d == CONSTRAINT_PLACES ? 2 : 1;
    rule.place[0] = rule.place[1] = dmb_station(s->block, 0, 0.0);
    if (d == CONSTRAINT_PLACES) rule.place[1] = dmb_station(s->arm, 0, 0.0);
    if (d == CONSTRAINT_KIND) {
        rule.kind = DMB_CONSTRAINT_NONHOLONOMIC;
        rule.provides = DMB_PROVIDES_JACOBIAN;
        rule.callback = speed_level;
    }
    if (d != NO_CONSTRAINT) must_model(&s->r, dmb_model_add_constraint(s->r.model, &rule, NULL));
}

/* The block on the ground, and the arm on the block. */
static void add_links(scene *s, difference d)
{
    const dmb_id ground = {0, 0};
    dmb_joint_def joint =
        joint_between(DMB_JOINT_CYLINDRICAL, dmb_station(ground, 0, 0.0), dmb_station(s->block, 0, 0.0));
    dmb_coupling_def gear = dmb_coupling_def_default();
    if (d == ONE_BODY) return;
    joint.match = 1;
    s->hinge = add_joint(&s->r, &joint);
    joint.kind = d == JOINT_KIND ? DMB_JOINT_PLANAR : DMB_JOINT_CYLINDRICAL;
    joint.place_a = dmb_station(d == JOINT_GROUND ? ground : s->block, 0, 0.0);
    joint.place_b = dmb_station(s->arm, 0, 0.0);
    if (d == JOINT_FAR_PART) joint.place_b = dmb_station(s->string, 0, 0.0);
    if (d == JOINT_PART) joint.place_a = dmb_station(s->string, 0, 0.0);
    if (d != NO_JOINT) s->axle = add_joint(&s->r, &joint);
    gear.joint[0] = gear.joint[1] = s->hinge;
    gear.component[0] = DMB_X, gear.component[1] = DMB_RX;
    if (d == COUPLING_JOINT) gear.joint[1] = s->axle;
    if (d == COUPLING_COMPONENT) gear.component[0] = DMB_RX, gear.component[1] = DMB_X;
    if (d == COUPLING_COUNT) gear.third_joint = s->axle;
    if (d != NO_COUPLING) must_model(&s->r, dmb_model_add_coupling(s->r.model, &gear, NULL));
}

static int32_t nothing(void *context, double time, uint32_t count, const double (*poses)[12],
                       const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                       const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)poses, (void)velocities, (void)forces, (void)tangent, (void)potential;
    return 0;
}

static void add_extra(scene *s, difference d)
{
    dmb_spring_def spring = dmb_spring_def_default();
    dmb_force_def force = dmb_force_def_default();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    spring.place_b = force.place[0] = dmb_station(s->block, 0, 0.0);
    spring.offset_a[2] = 8.0;
    spring.stiffness = 1.0;
    force.callback = nothing;
    stuck.place = dmb_station(s->string, 1, 0.5);
    stuck.stuck = 0;
    if (d == SPRING) must_model(&s->r, dmb_model_add_spring(s->r.model, &spring, NULL));
    if (d == FORCE) must_model(&s->r, dmb_model_add_force(s->r.model, &force, NULL));
    if (d == STUCK) must_model(&s->r, dmb_model_add_stuck(s->r.model, &stuck, NULL));
}

static void open_scene(scene *s, difference d)
{
    dmb_environment_def around = dmb_environment_def_default();
    memset(s, 0, sizeof *s);
    rig_open(&s->r, 0.0, 0.0, 0.0);
    around.gravity[2] = 0.0;
    if (d == FLUID) around.fluid_density = 1000.0;
    must_model(&s->r, dmb_model_set_environment(s->r.model, &around));
    add_hole(s, d);
    add_strings(s, d);
    add_bodies(s, d);
    add_bits(s, d);
    add_drives(s, d);
    add_loads(s, d);
    add_inputs(s, d);
    add_events(s, d);
    add_links(s, d);
    if (d != ONE_BODY) add_rule(s, d);
    add_extra(s, d);
    (void)rig_start(&s->r, NULL);
}

/* ---- Each difference --------------------------------------------------------------------------------------------- */

static const struct {
    difference what;
    const char *message;
} rows[] = {
    {ONE_STRING, "strings = 1, must be 2"},
    {ONE_BODY, "bodies = 2, must be 3"},
    {ONE_BIT, "bits = 1, must be 2"},
    {NO_DRIVE, "drives = 2, must be 3"},
    {NO_LOAD, "loads = 1, must be 2"},
    {NO_INPUT, "inputs = 0, must be 1"},
    {NO_EVENT, "events = 0, must be 1"},
    {NO_WALL, "walls = 0, must be 1"},
    {NO_JOINT, "joints = 1, must be 2"},
    {NO_COUPLING, "couplings = 0, must be 1"},
    {NO_CONSTRAINT, "constraints = 0, must be 1"},
    {SPRING, "springs = 1, must be 0"},
    {FORCE, "forces = 1, must be 0"},
    {STUCK, "stuck places = 1, must be 0"},
    {BODY_AT_END, "body 0: attach, must be as in the sim it continues"},
    {BODY_ON_SECOND, "body 0: string, "},
    {BIT_ON_SECOND, "bit 0: string, "},
    {REAMER_RING, "bit 1: stabiliser, "},
    {ROCK_LAW, "bit 0: rock_law, "},
    {BLADES, "bit 0: blades, "},
    {HISTORY, "bit 0: history, "},
    {DRIVE_KIND, "drive 1: kind, "},
    {DRIVE_COMPONENT, "drive 1: component, "},
    {DRIVE_PART, "drive 1: part, "},
    {ACTUATOR, "drive 1: actuator, "},
    {DELAY, "drive 2: delay, "},
    {LOAD_FRAME, "load 0: frame, "},
    {LOAD_PART, "load 0: part, "},
    {INPUT_NAME, "input 0 (torque): name, "},
    {INPUT_TARGET, "input 0 (push): target, "},
    {INPUT_PART, "input 0 (push): part, "},
    {INPUT_BOUNDS, "input 0 (push): low or high, "},
    {INPUT_LOWER_BOUND, "input 0 (push): low or high, "},
    {INPUT_INITIAL, "input 0 (push): initial (given or not), "},
    {EVENT_NAME, "event 0 (down): name, "},
    {EVENT_DIRECTION, "event 0 (up): direction, "},
    {EVENT_OUTPUT, "event 0 (up): output, "},
    {JOINT_KIND, "joint 1: kind, "},
    {JOINT_PART, "joint 1: part of place_a, "},
    {JOINT_GROUND, "joint 1: part of place_a, "},
    {JOINT_FAR_PART, "joint 1: part of place_b, "},
    {COUPLING_JOINT, "coupling 0: joint or component, "},
    {COUPLING_COUNT, "coupling 0: joint or component, "},
    {COUPLING_COMPONENT, "coupling 0: joint or component, "},
    {CONSTRAINT_KIND, "constraint 0: kind, "},
    {CONSTRAINT_ROWS, "constraint 0: rows, "},
    {CONSTRAINT_PLACES, "constraint 0: count, "},
    {NORMAL_LAW, "wall 0: normal_law, "},
    {FRICTION_LAW, "wall 0: friction_law, "},
    {WALL_ORIGIN, "wall 0: axis, "},
    {WALL_STATIONS, "wall 0: axis, "},
    {WALL_DEPTHS, "wall 0: axis, "},
    {WALL_DIRECTIONS, "wall 0: axis, "},
    {PIPE_KIND, "string 0, pipe 2: kind, must be as of pipe 2 of the sim it continues"},
    {PIPE_ELEMENTS, "string 0, pipe 2: elements, "},
    {PIPE_LENGTH, "string 0, pipe 2: length, "},
    {JOINT_LENGTH, "string 0, pipe 2: joint_length, "},
    {PIPE_SECTION, "string 0, pipe 2: section, "},
    {RING_PLACE, "string 0, pipe 1: places of its rings, "},
    {FLUID, "string 0: elements of its pipes (surroundings, options of the compile step), "},
};

static void each_difference_is_refused(void **state)
{
    (void)state;
    scene from, to;
    open_scene(&from, SAME);
    take_divided_steps(&from.r, 1e-4, 3);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        open_scene(&to, rows[i].what);
        const uint64_t before = rig_hash(&to.r);
        const int32_t status = dmb_sim_transfer_state(to.r.sim, from.r.sim);
        const char *message = dmb_sim_message(to.r.sim);
        if (status != DMB_ERR_VALUE || strstr(message, rows[i].message) == NULL)
            fail_msg("row %zu lacks \"%s\": %s: %s", i, rows[i].message, dmb_status_name(status), message);
        assert_true(rig_hash(&to.r) == before);
        rig_close(&to.r);
    }
    rig_close(&from.r);
}

static void the_same_parts_go_on(void **state)
{
    (void)state;
    scene from, to;
    open_scene(&from, SAME);
    open_scene(&to, SAME);
    take_divided_steps(&from.r, 1e-4, 3);
    must(&to.r, dmb_sim_transfer_state(to.r.sim, from.r.sim));
    take_divided_steps(&from.r, 1e-4, 3);
    take_divided_steps(&to.r, 1e-4, 3);
    for (uint32_t pipe = 0; pipe < 3; pipe++) {
        const dmb_pose a = pose_at(&from.r, dmb_station(from.string, pipe, 1.0));
        const dmb_pose b = pose_at(&to.r, dmb_station(to.string, pipe, 1.0));
        check_below("apart [m]", largest_difference(3, a.position, b.position), 1e-12);
    }
    rig_close(&from.r);
    rig_close(&to.r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_difference_is_refused),
        cmocka_unit_test(the_same_parts_go_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
