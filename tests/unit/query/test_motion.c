/* Speeds and accelerations of places: of strings in flight, of rigid ones exactly, of flexible ones against differences
 * of what the sim did (eq:kinematics.velocity); of pipes on the axis of a curved hole (eq:kinematics.path-velocity). */
#include "close.h"
#include "rig.h"

static const double stations[] = {0.0, 0.13, 0.5, 0.77, 1.0};
enum { STATIONS = sizeof stations / sizeof stations[0] };

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void to_world(const double R[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = R[3 * i] * v[0] + R[3 * i + 1] * v[1] + R[3 * i + 2] * v[2];
}

/* A free string of three pipes in the given kind, moving as one body at time 0. */
static dmb_id fly(rig *s, int32_t kind, double joint, const double velocity[6])
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    for (int i = 0; i < 3; i++) def.rotation[i] = 0.5 - 0.2 * i, def.position[i] = 1.0 + i;
    for (int i = 0; i < 6; i++) def.velocity[i] = velocity[i];
    const dmb_id string = add_string(s, &def);
    pipe.kind = kind;
    pipe.elements = 2;
    pipe.joint_length = joint;
    add_pipes(s, &pipe, 3);
    rig_start(s, NULL);
    return string;
}

/* At time 0 every place of an unstressed string moves as the one body it was described as. */
static void described_velocity(void **state)
{
    (void)state;
    const double v[6] = {1.0, -2.0, 0.5, 3.0, 0.7, -1.1};
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_RIGID; kind += 2) {
        rig s;
        const dmb_id string = fly(&s, kind, 0.2, v);
        for (uint32_t pipe = 0; pipe < 3; pipe++)
            for (int i = 0; i < STATIONS; i++) {
                const dmb_place place = dmb_station(string, pipe, stations[i]);
                const dmb_motion body = motion_at(&s, place, DMB_FRAME_BODY),
                                 world = motion_at(&s, place, DMB_FRAME_WORLD);
                const dmb_pose pose = pose_at(&s, place);
                const double arm[3] = {1.5 * (pipe + stations[i]), 0.0, 0.0};
                double want[3], turned[3];
                cross(v + 3, arm, want);
                for (int k = 0; k < 3; k++) CHECK_CLOSE(body.velocity[k], v[k] + want[k], 1e-13);
                for (int k = 0; k < 3; k++) CHECK_CLOSE(body.velocity[3 + k], v[3 + k], 1e-13);
                to_world(pose.rotation, body.velocity, turned);
                for (int k = 0; k < 3; k++) CHECK_CLOSE(world.velocity[k], turned[k], 1e-13);
                for (int k = 0; k < 3; k++) CHECK_CLOSE(pose.displacement[k], 0.0, 1e-15);
            }
        rig_close(&s);
    }
}

/* A rigid string that turns about its own y axis: its centre flies straight, every place is drawn towards it. */
static void rigid_acceleration(void **state)
{
    (void)state;
    const double spin = 2.0, v[6] = {0.3, 0.0, 0.0, 0.0, spin, 0.0};
    rig s;
    const dmb_id string = fly(&s, DMB_PIPE_RIGID, 0.0, v);
    take_steps(&s, 1e-3, 100);
    for (uint32_t pipe = 0; pipe < 3; pipe++)
        for (int i = 0; i < STATIONS; i++) {
            const dmb_place place = dmb_station(string, pipe, stations[i]);
            const dmb_motion m = motion_at(&s, place, DMB_FRAME_WORLD);
            const dmb_pose pose = pose_at(&s, place);
            const double inward[3] = {-spin * spin * (1.5 * (pipe + stations[i]) - 2.25), 0.0, 0.0};
            double want[3];
            to_world(pose.rotation, inward, want);
            for (int k = 0; k < 3; k++) CHECK_CLOSE(m.acceleration[k], want[k], 1e-9);
            for (int k = 3; k < 6; k++) CHECK_CLOSE(m.acceleration[k], 0.0, 1e-9);
        }
    rig_close(&s);
}

/* The motion between two instants agrees with the query at the one in between. */
static void differences_of_a_run(void **state)
{
    (void)state;
    const double v[6] = {1.0, -2.0, 0.5, 3.0, 2.7, -4.1}, h = 1e-5;
    rig s;
    const dmb_id string = fly(&s, DMB_PIPE_FLEXIBLE, 0.2, v);
    take_steps(&s, 1e-4, 400); /* long enough to be bent and to vibrate */
    dmb_pose pose[3][STATIONS];
    dmb_motion motion[3][STATIONS];
    for (int n = 0; n < 3; n++) {
        for (int i = 0; i < STATIONS; i++) {
            const dmb_place place = dmb_station(string, 1, stations[i]);
            pose[n][i] = pose_at(&s, place);
            motion[n][i] = motion_at(&s, place, DMB_FRAME_WORLD);
        }
        if (n < 2) take_steps(&s, h, 1);
    }
    for (int i = 0; i < STATIONS; i++)
        for (int k = 0; k < 3; k++) {
            const double speed = (pose[2][i].displacement[k] - pose[0][i].displacement[k]) / (2.0 * h);
            const double rate = (motion[2][i].velocity[k] - motion[0][i].velocity[k]) / (2.0 * h);
            const double turning = (motion[2][i].velocity[3 + k] - motion[0][i].velocity[3 + k]) / (2.0 * h);
            CHECK_CLOSE(motion[1][i].velocity[k], speed, 5e-6);
            CHECK_CLOSE(motion[1][i].acceleration[k], rate, 0.05);
            CHECK_CLOSE(motion[1][i].acceleration[3 + k], turning, 0.2);
        }
    rig_close(&s);
}

/* Axial-torsional pipes in a bend of 30 m radius: on the axis, their depth the advance, x along the hole. */
static void on_the_axis_of_a_bend(void **state)
{
    (void)state;
    const double radius = 30.0, survey[6] = {0.0, 0.5 * PI, 0.0, 15.0, 0.5 * PI, -0.5}; /* to the left */
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    wall.survey_count = 2;
    wall.survey = survey;
    add_wall(&s, &wall);
    def.start_depth = 1.0;
    def.velocity[0] = 0.5;
    def.velocity[3] = 3.0;
    const dmb_id string = add_string(&s, &def);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    add_pipes(&s, &pipe, 4);
    rig_start(&s, NULL);
    for (uint32_t p = 0; p < 4; p++)
        for (int i = 0; i < STATIONS; i++) {
            const dmb_place place = dmb_station(string, p, stations[i]);
            const dmb_pose pose = pose_at(&s, place);
            const dmb_motion m = motion_at(&s, place, DMB_FRAME_BODY);
            const double depth = 1.0 + 1.5 * (p + stations[i]), turn = depth / radius;
            CHECK_CLOSE(pose.depth, depth, 1e-9);
            CHECK_CLOSE(pose.position[0], radius * sin(turn), 1e-9);
            CHECK_CLOSE(pose.position[1], radius * (1.0 - cos(turn)), 1e-9);
            CHECK_CLOSE(pose.rotation[0], cos(turn), 1e-9);
            CHECK_CLOSE(m.velocity[0], 0.5, 1e-9);
            CHECK_CLOSE(m.velocity[3], 3.0, 1e-6);
            CHECK_CLOSE(hypot(m.velocity[4], m.velocity[5]), 0.5 / radius, 1e-6);
        }
    rig_close(&s);
}

/* Revolutions are counted, also of two pipes that have not turned alike. */
static void revolutions(void **state)
{
    (void)state;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    def.velocity[3] = -200.0;
    const dmb_id string = add_string(&s, &def);
    pipe.elements = 2;
    add_pipes(&s, &pipe, 1);
    rig_start(&s, NULL);
    take_steps(&s, 1e-3, 500);
    for (int i = 0; i < STATIONS; i++) {
        const double angle = rotation_at(&s, dmb_station(string, 0, stations[i]));
        CHECK_CLOSE(angle, -100.0, 1e-9);
    }
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(described_velocity),   cmocka_unit_test(rigid_acceleration),
        cmocka_unit_test(differences_of_a_run), cmocka_unit_test(on_the_axis_of_a_bend),
        cmocka_unit_test(revolutions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
