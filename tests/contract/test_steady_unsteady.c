/* Parts of a scene that do not let a state be steady (drives, supports, joints and springs) are refused by name; and
 * analyses that judge stiffness at rest, buckling and paths, held against states that move: refused, and answered at
 * rest. */
#include <string.h>

#include "rig.h"

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static dmb_id constant_drive(rig *s, int32_t kind, dmb_id part, int32_t component, double value)
{
    return add_simple_drive(s, kind, part, component, add_constant(s, value));
}

static void refused(rig *s, int32_t steady, const char *word)
{
    dmb_static_options options = dmb_static_options_default();
    const uint64_t before = rig_hash(s);
    options.steady = steady;
    const int32_t status = dmb_analysis_static(s->sim, &options, NULL);
    print_message("%s\n", dmb_sim_message(s->sim));
    assert_int_equal(status, DMB_ERR_UNSUPPORTED);
    if (strstr(dmb_sim_message(s->sim), word) == NULL) fail_msg("no \"%s\" in: %s", word, dmb_sim_message(s->sim));
    if (strstr(dmb_sim_message(s->sim), "take DMB_") == NULL || strstr(dmb_sim_message(s->sim), "DMB_STEADY_") == NULL)
        fail_msg("no remedy: %s", dmb_sim_message(s->sim));
    assert_true(rig_hash(s) == before);
    rig_close(s);
}

static dmb_id string_of(rig *s, int32_t start_free, int32_t end_free, int32_t kind)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    def.start_free = start_free;
    def.end_free = end_free;
    pipe.kind = kind;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 3);
    return pipe.string;
}

/* ---- Drives and supports -------------------------------------------------------------------------------------------
 */

static void drives_that_disagree(void **state)
{
    (void)state;
    rig s;
    const dmb_id string = string_of(&s, DMB_FREE_RZ, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    dmb_body_def free_body = dmb_body_def_default();
    free_body.position[1] = 5.0;
    free_body.free_mask = DMB_FREE_RX;
    const dmb_id other = add_body(&s, &free_body);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RZ, 3.0);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, other, DMB_RX, 2.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_RIGID, "different axes");
}

static void forces_that_turn(void **state)
{
    (void)state;
    rig s;
    const dmb_id string = string_of(&s, DMB_FREE_SPHERICAL, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, 3.0);
    (void)constant_drive(&s, DMB_DRIVE_LOAD, string, DMB_RZ, 10.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_SLIDING, "its force turns with its string");
}

static void supports_that_hold(void **state)
{
    (void)state;
    rig s;
    dmb_id string = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_ALL & ~DMB_FREE_SPHERICAL, DMB_PIPE_FLEXIBLE);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, 3.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_SLIDING, "keeps it from turning");
    string = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_SPHERICAL, DMB_PIPE_FLEXIBLE);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_X, 0.1);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_SLIDING, "keeps it from sliding");
    string = string_of(&s, DMB_FREE_RZ, DMB_FREE_X | DMB_FREE_RX, DMB_PIPE_FLEXIBLE); /* swung, its far end held */
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RZ, 3.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_RIGID, "its support or drive holds");
}

static void pipes_that_only_slide(void **state)
{
    (void)state;
    rig s;
    const dmb_id string = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_ALL, DMB_PIPE_AXIAL_TORSIONAL);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, 3.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_RIGID, "axial-torsional");
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

static dmb_id body_at(rig *s, double x, int32_t free_mask)
{
    dmb_body_def def = dmb_body_def_default();
    def.position[0] = x;
    def.free_mask = free_mask;
    return add_body(s, &def);
}

static dmb_id hinge(rig *s, dmb_id a, dmb_id b, double stiffness)
{
    dmb_joint_def def = joint_between(DMB_JOINT_REVOLUTE, dmb_station(a, 0, 0.0), dmb_station(b, 0, 0.0));
    def.axis_a[0] = 0.0;
    def.axis_a[2] = 1.0;
    def.match = 1;
    def.stiffness[DMB_RX] = stiffness;
    return add_joint(s, &def);
}

static void joints_that_are_driven(void **state)
{
    (void)state;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id first = body_at(&s, 0.0, DMB_FREE_RZ), second = body_at(&s, 1.0, DMB_FREE_ALL);
    const dmb_id between = hinge(&s, first, second, 0.0);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, between, DMB_RX, 2.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_RIGID, "two parts against each other");
}

static void springs_to_the_ground(void **state)
{
    (void)state;
    rig s;
    const dmb_id none = {0, 0};
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id hub = body_at(&s, 0.0, DMB_FREE_ALL), arm = body_at(&s, 1.0, DMB_FREE_ALL);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, hinge(&s, none, hub, 0.0), DMB_RX, 2.0);
    (void)add_joint_between(&s, DMB_JOINT_FIXED, dmb_station(hub, 0, 0.0), dmb_station(arm, 0, 0.0));
    dmb_joint_def spring = joint_between(DMB_JOINT_SPHERICAL, dmb_station(none, 0, 0.0), dmb_station(hub, 0, 0.0));
    spring.match = 1;
    spring.stiffness[DMB_RX] = 5.0;
    spring.state = DMB_JOINT_ACTIVE;
    (void)add_joint(&s, &spring);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_RIGID, "a law about the ground");
}

/* A string that a hinge to the ground, with a spring about its axis, holds at its far end: the drive winds the spring
 * up. */
static void springs_that_change(void **state)
{
    (void)state;
    rig s;
    const dmb_id none = {0, 0}, string = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    dmb_joint_def def = joint_between(DMB_JOINT_REVOLUTE, dmb_station(none, 0, 0.0), dmb_station(string, 2, 1.0));
    def.match = 1; /* about x */
    def.origin_a[0] = 3.0 * dmb_pipe_def_default().length;
    def.stiffness[DMB_RX] = 5.0;
    (void)add_joint(&s, &def);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, 3.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_SLIDING, "its spring along coordinate");
}

static void joints_that_do_not_let_it(void **state)
{
    (void)state;
    rig s;
    const dmb_id none = {0, 0}, string = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    dmb_joint_def def = joint_between(DMB_JOINT_FIXED, dmb_station(none, 0, 0.0), dmb_station(string, 2, 1.0));
    def.match = 1;
    def.origin_a[0] = 3.0 * dmb_pipe_def_default().length;
    (void)add_joint(&s, &def);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, 3.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_SLIDING, "joints do not allow");
}

/* ---- Round about the axis ---------------------------------------------------------------------------------------- */

/* A string that is moved along and turned. */
static dmb_id moved_string(rig *s, double along, double turning)
{
    const dmb_id string = string_of(s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    (void)constant_drive(s, DMB_DRIVE_MOTION, string, DMB_X, along);
    (void)constant_drive(s, DMB_DRIVE_MOTION, string, DMB_RX, turning);
    return string;
}

static void accepted(rig *s, int32_t steady)
{
    dmb_static_options options = dmb_static_options_default();
    options.steady = steady;
    (void)rig_start(s, NULL);
    assert_int_equal(find_equilibrium(s, &options).steady, steady);
    rig_close(s);
}

static void not_accepted(rig *s, int32_t steady, const char *word)
{
    (void)rig_start(s, NULL);
    refused(s, steady, word);
}

/* Each way in which a tool at the far end is not round about the axis: its centre off along y or z, products of
 * inertia, unequal moments. */
static void tools_that_are_not_round(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        rig s;
        dmb_body_def tool = dmb_body_def_default();
        tool.string = moved_string(&s, 0.0, 3.0);
        tool.attach = DMB_ATTACH_END;
        tool.mass = 5.0;
        tool.inertia[0] = tool.inertia[1] = tool.inertia[2] = 0.02;
        tool.centre[1] = k == 1 ? 1e-3 : 0.0;
        tool.centre[2] = k == 2 ? 1e-3 : 0.0;
        tool.inertia[3] = k == 3 ? 1e-3 : 0.0;
        tool.inertia[4] = k == 4 ? 1e-3 : 0.0;
        if (k == 5) tool.inertia[2] = 0.021;
        (void)add_body(&s, &tool);
        if (k == 0)
            accepted(&s, DMB_STEADY_SLIDING);
        else
            not_accepted(&s, DMB_STEADY_SLIDING, "its mass is not round about its axis");
    }
}

/* Pipes bent about z when unloaded, a moment that turns with them, a force of a drive across: steady while they only
 * slide. */
static void what_turns_with_a_string(void **state)
{
    static const char *const words[3] = {"it is bent when unloaded", "load 0: it turns with its string",
                                         "its force turns with its string"};
    (void)state;
    for (int k = 0; k < 6; k++) {
        rig s;
        const int turning = k >= 3;
        dmb_pipe_def bent = dmb_pipe_def_default();
        dmb_load_def load = dmb_load_def_default();
        bent.string = string_of(&s, DMB_FREE_ALL, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
        bent.curvature[2] = k % 3 == 0 ? 1e-3 : 0.0;
        (void)add_pipes(&s, &bent, 1);
        (void)constant_drive(&s, DMB_DRIVE_MOTION, bent.string, DMB_X, turning ? 0.0 : 0.1);
        (void)constant_drive(&s, DMB_DRIVE_MOTION, bent.string, DMB_RX, turning ? 3.0 : 0.0);
        load.place = dmb_station(bent.string, 2, 1.0);
        load.frame = DMB_FRAME_BODY;
        load.moment[2] = k % 3 == 1 ? 0.1 : 0.0;
        (void)add_load(&s, &load);
        dmb_joint_def bearing =
            joint_between(DMB_JOINT_FREE, dmb_station((dmb_id){0, 0}, 0, 0.0), dmb_station(bent.string, 0, 0.0));
        for (int i = 1; i < 6; i++) bearing.stiffness[i] = i == DMB_RX ? 0.0 : 1e6;
        (void)add_joint(&s, &bearing);
        if (k % 3 == 2) (void)constant_drive(&s, DMB_DRIVE_LOAD, bent.string, DMB_RZ, 0.1);
        if (turning)
            not_accepted(&s, DMB_STEADY_SLIDING, words[k % 3]);
        else
            accepted(&s, DMB_STEADY_SLIDING);
    }
}

/* An actuator has a force by speed; along what stands still that is none. */
static void actuator_of_what_stands_still(void **state)
{
    (void)state;
    rig s;
    dmb_drive_def push = dmb_drive_def_default();
    push.part = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, push.part, DMB_RX, 3.0);
    dmb_joint_def spring =
        joint_between(DMB_JOINT_FREE, dmb_station((dmb_id){0, 0}, 0, 0.0), dmb_station(push.part, 0, 0.0));
    spring.stiffness[DMB_X] = 1e5;
    (void)add_joint(&s, &spring);
    push.kind = DMB_DRIVE_LOAD;
    push.component = DMB_X;
    push.drag = 2.0;
    push.time_function = add_constant(&s, 100.0);
    (void)add_drive(&s, &push);
    (void)rig_start(&s, NULL);
    dmb_static_options options = dmb_static_options_default();
    options.steady = DMB_STEADY_SLIDING;
    assert_int_equal(find_equilibrium(&s, &options).steady, DMB_STEADY_SLIDING);
    check_relative("pushed against its spring", pose_at(&s, dmb_station(push.part, 0, 0.0)).displacement[0], 1e-3,
                   1e-9);
    rig_close(&s);
}

/* ---- Turning as one body ----------------------------------------------------------------------------------------- */

/* A body on a ball joint whose three angles are driven, one of them at 2 rad/s: R = Ry(RY) Rz(RZ) Rx(RX), so that it
 * turns about y of the ground, about Ry z, about Ry Rz x. Its centre of mass off the joint takes the force of its
 * centripetal acceleration, m w x (w x r). */
static void bodies_turned_by_angles(void **state)
{
    const double speed = 2.0, angle[3] = {0.3, 0.4, 0.5}, mass = 3.0; /* RX, RY, RZ */
    const double cy = cos(angle[1]), sy = sin(angle[1]), cz = cos(angle[2]), sz = sin(angle[2]);
    const double axes[3][3] = {{cy * cz, sz, -sy * cz}, {0.0, 1.0, 0.0}, {sy, 0.0, cy}};
    (void)state;
    for (int k = 0; k < 3; k++) {
        rig s;
        dmb_body_def body = dmb_body_def_default();
        dmb_joint_state at = dmb_joint_state_default();
        double w[3], r[3], turned[3], want[3];
        rig_open(&s, 0.0, 0.0, 0.0);
        body.mass = mass;
        body.centre[1] = 0.25;
        const dmb_place ground = dmb_station((dmb_id){0, 0}, 0, 0.0), place = dmb_station(add_body(&s, &body), 0, 0.0);
        dmb_joint_def ball = joint_between(DMB_JOINT_SPHERICAL, ground, place);
        ball.initial_mask = DMB_FREE_SPHERICAL;
        for (int i = 0; i < 3; i++) ball.initial_position[DMB_RX + i] = angle[i];
        const dmb_id joint = add_joint(&s, &ball);
        for (int i = 0; i < 3; i++) (void)constant_drive(&s, DMB_DRIVE_MOTION, joint, DMB_RX + i, i == k ? speed : 0.0);
        (void)rig_start(&s, NULL);
        dmb_static_options options = dmb_static_options_default();
        options.steady = DMB_STEADY_RIGID;
        assert_int_equal(find_equilibrium(&s, &options).steady, DMB_STEADY_RIGID);
        const dmb_pose pose = pose_at(&s, place);
        must(&s, dmb_query_joint(s.sim, joint, &at));
        for (int i = 0; i < 3; i++) {
            w[i] = speed * axes[k][i];
            r[i] = 0.25 * pose.rotation[3 * i + 1];
            check_close("angular velocity", motion_at(&s, place, DMB_FRAME_WORLD).velocity[3 + i], w[i], 1e-12);
        }
        cross(w, r, turned);
        cross(w, turned, want);
        for (int i = 0; i < 3; i++) check_close("force of the joint", at.reaction[i], mass * want[i], 1e-9);
        rig_close(&s);
    }
}

/* A load along the axis of what turns, and one that is 0, are steady; a moment of the world across the axis is not.
 * Frames of the hole are those at the place. */
static void loads_on_what_turns(void **state)
{
    (void)state;
    for (int k = 0; k < 5; k++) {
        rig s;
        dmb_wall_def hole = s1_hole();
        dmb_string_def def = dmb_string_def_default();
        dmb_pipe_def pipe = dmb_pipe_def_default();
        dmb_load_def load = dmb_load_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        (void)add_wall(&s, &hole);
        def.start_free = DMB_FREE_RX;
        pipe.eccentricity = 1e-5;
        pipe.string = add_string(&s, &def);
        (void)add_pipes(&s, &pipe, 3);
        (void)constant_drive(&s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, 3.0);
        load.place = dmb_station(pipe.string, 2, 1.0);
        load.frame = k < 2 ? DMB_FRAME_HOLE : DMB_FRAME_WORLD;
        load.force[0] = k == 0 || k == 2 ? 5.0 : 0.0;
        load.force[1] = k == 1 || k == 3 ? 5.0 : 0.0;
        load.moment[2] = k == 4 ? 5.0 : 0.0;
        if (k == 3) load.time_function = add_constant(&s, 0.0);
        (void)add_load(&s, &load);
        if (k == 1 || k == 4)
            not_accepted(&s, DMB_STEADY_RIGID, "load 0: it does not turn with the whole");
        else
            accepted(&s, DMB_STEADY_RIGID);
    }
}

/* A body that its support holds on the axis does not meet the wall; one that may meet it turns steadily about the axis
 * of a straight hole only: not beside it, not in an arc. */
static void holes_of_what_turns(void **state)
{
    static const double arc[3][3] = {{0.0, 0.5 * PI, 0.0}, {5.0, 0.5 * PI, 0.02}, {60.0, 0.5 * PI, 0.3}};
    (void)state;
    for (int k = 0; k < 3; k++) {
        rig s;
        dmb_wall_def hole = s1_hole();
        dmb_body_def body = dmb_body_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        hole.survey = k == 2 ? arc[0] : NULL;
        hole.survey_count = k == 2 ? 3 : 0;
        (void)add_wall(&s, &hole);
        body.contact_diameter = 0.05;
        body.position[0] = 1.0;
        body.position[1] = k == 1 ? 0.01 : 0.0;
        body.free_mask = k == 0 ? DMB_FREE_RX : DMB_FREE_ALL;
        (void)constant_drive(&s, DMB_DRIVE_MOTION, add_body(&s, &body), DMB_RX, 3.0);
        if (k == 0)
            accepted(&s, DMB_STEADY_RIGID);
        else
            not_accepted(&s, DMB_STEADY_RIGID, "wall: the whole does not turn about the axis of a straight hole");
    }
}

/* A law about the ground counts where its joint is not open. */
static void laws_of_open_joints(void **state)
{
    (void)state;
    for (int open = 0; open < 2; open++) {
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_place ground = dmb_station((dmb_id){0, 0}, 0, 0.0);
        const dmb_place hub = dmb_station(body_at(&s, 0.0, DMB_FREE_RX), 0, 0.0);
        (void)constant_drive(&s, DMB_DRIVE_MOTION, hub.part, DMB_RX, 2.0);
        dmb_joint_def damper = joint_between(DMB_JOINT_REVOLUTE, ground, hub);
        damper.damping[DMB_RX] = 5.0;
        damper.state = open ? DMB_JOINT_OPEN : DMB_JOINT_ACTIVE;
        (void)add_joint(&s, &damper);
        if (open)
            accepted(&s, DMB_STEADY_RIGID);
        else
            not_accepted(&s, DMB_STEADY_RIGID, "a law about the ground");
    }
}

/* ---- Springs, places that are stuck, forces of the caller -------------------------------------------------------- */

static int32_t no_force(void *context, double time, uint32_t count, const double (*poses)[12],
                        const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                        const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)poses, (void)velocities, (void)forces, (void)tangent, (void)potential;
    return 0;
}

/* Beside a string that turns, a flap on a hinge with a spring. Forces on the flap alone are steady. */
static dmb_id string_and_flap(rig *s, dmb_id *flap, dmb_id *joint)
{
    const dmb_id string = moved_string(s, 0.0, 3.0), none = {0, 0};
    *flap = body_at(s, -1.0, DMB_FREE_ALL);
    *joint = hinge(s, none, *flap, 50.0);
    return string;
}

static void forces_on_what_moves(void **state)
{
    static const char *const words[6] = {NULL, "force 0: place 1 moves", NULL, "force 0: place 0 moves", NULL, "stuck"};
    (void)state;
    for (int k = 0; k < 6; k++) {
        rig s;
        dmb_id flap, joint;
        const dmb_id string = string_and_flap(&s, &flap, &joint);
        dmb_force_def force = dmb_force_def_default();
        dmb_stuck_def stuck = dmb_stuck_def_default();
        force.callback = no_force;
        force.place_count = k < 2 ? 2 : 1;
        force.place[0] = force.place[1] = dmb_station(flap, 0, 0.0);
        force.component[0] = DMB_RX;
        stuck.place = dmb_station(string, 1, 1.0);
        stuck.stuck = k == 5;
        stuck.holds = DMB_STUCK_AXIAL;
        if (k == 1) force.place[1] = dmb_station(string, 2, 1.0);
        if (k == 2) force.place[0] = dmb_station(joint, 0, 0.0); /* the coordinate of a hinge that stands still */
        if (k == 3) {                                            /* and of one that turns with the string */
            dmb_joint_def free =
                joint_between(DMB_JOINT_FREE, dmb_station((dmb_id){0, 0}, 0, 0.0), dmb_station(string, 2, 1.0));
            free.match = 1;
            free.damping[DMB_RX] = 1.0;
            force.place[0] = dmb_station(add_joint(&s, &free), 0, 0.0);
        }
        if (k < 4) must_model(&s, dmb_model_add_force(s.model, &force, NULL));
        if (k >= 4) must_model(&s, dmb_model_add_stuck(s.model, &stuck, NULL));
        if (words[k] == NULL)
            accepted(&s, DMB_STEADY_SLIDING);
        else
            not_accepted(&s, DMB_STEADY_SLIDING, words[k]);
    }
}

/* A spring holds on to a point that stands still, on the axis, or to one that goes round. Dampers of joints do not
 * count, nor joints that are open. */
static void springs_of_what_turns(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        rig s;
        dmb_id flap, joint;
        const dmb_id string = string_and_flap(&s, &flap, &joint), none = {0, 0};
        dmb_spring_def line = dmb_spring_def_default();
        dmb_joint_def more = joint_between(DMB_JOINT_FREE, dmb_station(none, 0, 0.0), dmb_station(string, 2, 1.0));
        more.match = 1;
        more.damping[DMB_RX] = k == 2 ? 2.0 : 0.0;
        more.stiffness[DMB_RX] = k == 3 ? 2.0 : 0.0;
        more.state = k == 3 ? DMB_JOINT_OPEN : DMB_JOINT_ACTIVE;
        if (k >= 2) (void)add_joint(&s, &more);
        line.place_a = dmb_station(string, 2, 1.0);
        line.place_b = dmb_station(k == 1 ? none : flap, 0, 0.0);
        line.offset_a[2] = k == 1 ? 0.1 : 0.0;
        line.stiffness = 10.0;
        if (k < 2) must_model(&s, dmb_model_add_spring(s.model, &line, NULL));
        if (k == 1)
            not_accepted(&s, DMB_STEADY_SLIDING, "spring 0: its points move");
        else
            accepted(&s, DMB_STEADY_SLIDING);
    }
}

/* Springs between parts of a whole that turns keep their length and turn with it. One to a point of the ground on the
 * axis keeps its length too, and its force turns. */
static void springs_in_what_turns(void **state)
{
    (void)state;
    for (int grounded = 0; grounded < 2; grounded++) {
        rig s;
        const dmb_id none = {0, 0};
        dmb_spring_def line = dmb_spring_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_id hub = body_at(&s, 0.0, DMB_FREE_ALL), arm = body_at(&s, 1.0, DMB_FREE_ALL);
        (void)constant_drive(&s, DMB_DRIVE_MOTION, hinge(&s, none, hub, 0.0), DMB_RX, 2.0);
        dmb_joint_def fixed = joint_between(DMB_JOINT_FIXED, dmb_station(hub, 0, 0.0), dmb_station(arm, 0, 0.0));
        fixed.match = 1;
        (void)add_joint(&s, &fixed);
        line.place_a = dmb_station(grounded ? none : hub, 0, 0.0);
        line.place_b = dmb_station(arm, 0, 0.0);
        line.offset_b[1] = grounded ? 0.0 : 0.3;
        line.stiffness = 10.0;
        must_model(&s, dmb_model_add_spring(s.model, &line, NULL));
        if (grounded)
            not_accepted(&s, DMB_STEADY_RIGID, "spring 0: its points move at 0 and 2 m/s");
        else
            accepted(&s, DMB_STEADY_RIGID);
    }
}

/* ---- What judges a stiffness at rest ----------------------------------------------------------------------------- */

enum { SLIDES, TURNS, SWINGS, MOTIONS };

/* A column under a push at its far end, driven along, about its axis, or across. */
static void column(rig *s, int motion)
{
    dmb_load_def load = dmb_load_def_default();
    const int32_t start_free = motion == SWINGS ? DMB_FREE_RZ : DMB_FREE_X | DMB_FREE_RX;
    const dmb_id string = string_of(s, start_free, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    load.place = dmb_station(string, 2, 1.0);
    load.force[0] = -10.0;
    load.frame = motion == SWINGS ? DMB_FRAME_BODY : DMB_FRAME_WORLD;
    (void)add_load(s, &load);
    if (motion == SWINGS) {
        (void)constant_drive(s, DMB_DRIVE_MOTION, string, DMB_RZ, 0.5);
    } else {
        (void)constant_drive(s, DMB_DRIVE_MOTION, string, DMB_X, motion == SLIDES ? 0.1 : 0.0);
        (void)constant_drive(s, DMB_DRIVE_MOTION, string, DMB_RX, motion == TURNS ? 5.0 : 0.0);
    }
    (void)rig_start(s, NULL);
}

static int32_t buckle(const rig *s, double *factor)
{
    dmb_buckling *buckling = NULL;
    const int32_t status = dmb_analysis_buckling(s->sim, NULL, &buckling);
    assert_true((status >= 0) == (buckling != NULL));
    if (dmb_buckling_count(buckling) > 0) must(s, dmb_buckling_factor(buckling, 0, factor));
    dmb_buckling_destroy(&buckling);
    return status;
}

static int32_t follow(const rig *s)
{
    dmb_path_options options = dmb_path_options_default();
    options.max_points = 3;
    return dmb_analysis_path(s->sim, &options, NULL);
}

static void check_refused(rig *s)
{
    double factor;
    const uint64_t before = rig_hash(s);
    for (int call = 0; call < 2; call++) {
        assert_int_equal(call == 0 ? buckle(s, &factor) : follow(s), DMB_ERR_UNSUPPORTED);
        assert_non_null(strstr(dmb_sim_message(s->sim), "DMB_STEADY_AT_REST"));
        assert_true(rig_hash(s) == before);
    }
    print_message("%s\n", dmb_sim_message(s->sim));
}

static void stiffness_of_what_moves(void **state)
{
    static const int32_t kinds[] = {DMB_STEADY_SLIDING, DMB_STEADY_SLIDING, DMB_STEADY_RIGID};
    double euler = 0.0;
    (void)state;
    for (int motion = 0; motion < MOTIONS; motion++) {
        rig s;
        dmb_static_options options = dmb_static_options_default();
        double factor = 0.0;
        column(&s, motion);
        assert_int_equal(find_equilibrium(&s, NULL).steady, kinds[motion]);
        check_refused(&s);
        take_steps(&s, 1e-4, 5); /* a run goes on in that state */
        check_refused(&s);
        options.steady = DMB_STEADY_AT_REST;
        (void)find_equilibrium(&s, &options);
        if (buckle(&s, &factor) < 0) fail_msg("%s", dmb_sim_message(s.sim));
        assert_true(follow(&s) >= 0);
        if (motion != SWINGS) { /* of a dead load; all the same column */
            if (motion > 0) check_relative("critical factor", factor, euler, 1e-6);
            euler = factor;
        }
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drives_that_disagree),
        cmocka_unit_test(forces_that_turn),
        cmocka_unit_test(supports_that_hold),
        cmocka_unit_test(pipes_that_only_slide),
        cmocka_unit_test(joints_that_are_driven),
        cmocka_unit_test(springs_to_the_ground),
        cmocka_unit_test(springs_that_change),
        cmocka_unit_test(joints_that_do_not_let_it),
        cmocka_unit_test(tools_that_are_not_round),
        cmocka_unit_test(what_turns_with_a_string),
        cmocka_unit_test(actuator_of_what_stands_still),
        cmocka_unit_test(bodies_turned_by_angles),
        cmocka_unit_test(loads_on_what_turns),
        cmocka_unit_test(holes_of_what_turns),
        cmocka_unit_test(laws_of_open_joints),
        cmocka_unit_test(forces_on_what_moves),
        cmocka_unit_test(springs_of_what_turns),
        cmocka_unit_test(springs_in_what_turns),
        cmocka_unit_test(stiffness_of_what_moves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
