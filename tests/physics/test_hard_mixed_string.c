/* Strings of flexible, axial-torsional and rigid pipes: where they stretch and twist alike they answer alike, and a
 * string of rigid pipes is a rigid body. */
#include "contact_scene.h"

static const int32_t flexible = DMB_PIPE_FLEXIBLE, bar = DMB_PIPE_AXIAL_TORSIONAL, rigid = DMB_PIPE_RIGID;

typedef struct answer {
    double shortening, twist;   /* [m, rad] of the far end */
    double reaction[6];         /* [N, N m] of the rig end */
    double compression, torque; /* [N, N m] in the first elastic pipe */
    double mass;                /* [kg] */
} answer;

/* `count` pipes of the given kinds, held at the rig end; pushed and turned at the far end. */
static answer load_string(const int32_t *kinds, uint32_t count, const double force[3], const double moment[3])
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_section section = dmb_section_default();
    dmb_pose pose = dmb_pose_default();
    rig scene;
    answer out;
    dmb_id id = {0, 0};
    memset(&out, 0, sizeof out);
    string.start_free = DMB_FREE_NONE;
    scene_open(&scene, 0.0);
    add_string(&scene, &string);
    for (uint32_t i = 0; i < count; i++) {
        pipe.kind = kinds[i];
        id = add_pipes(&scene, &pipe, 1);
    }
    load.place = dmb_station(id, count - 1, 1.0);
    for (int i = 0; i < 3; i++) {
        load.force[i] = force[i];
        load.moment[i] = moment[i];
    }
    add_load(&scene, &load);
    rig_start_with(&scene, NULL, NULL);
    scene_must(&scene, dmb_analysis_static(scene.sim, NULL, NULL));
    assert_int_equal(dmb_query_pose(scene.sim, load.place, &pose), DMB_OK);
    assert_int_equal(dmb_query_rotation(scene.sim, load.place, &out.twist), DMB_OK);
    assert_int_equal(dmb_query_reaction(scene.sim, id, out.reaction), DMB_OK);
    for (uint32_t i = 0; i < count; i++) {
        if (kinds[i] == rigid) continue;
        assert_int_equal(dmb_query_section(scene.sim, dmb_station(id, i, 0.5), &section), DMB_OK);
        out.compression = -section.force[0];
        out.torque = section.force[3];
        break;
    }
    out.shortening = -pose.displacement[0];
    out.mass = scene_info(&scene).mass;
    rig_close(&scene);
    return out;
}

static double EA(void)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    return pipe.young_modulus * 0.25 * PI * (pow(pipe.outer_diameter, 2.0) - pow(pipe.inner_diameter, 2.0));
}

static double GJ(void)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    return pipe.young_modulus / 2.6 * PI / 32.0 * (pow(pipe.outer_diameter, 4.0) - pow(pipe.inner_diameter, 4.0));
}

/* Compression and twist of elastic pipes add up as F l/EA and M l/GJ in every mixture and order. The beam's axial law
 * is that of the logarithm, linear in its stretch too, so all agree to round-off. */
static void same_compression_and_twist(void **state)
{
    const int32_t cases[6][4] = {{flexible, flexible, flexible, flexible}, {bar, bar, bar, bar},
                                 {flexible, bar, flexible, bar},           {bar, flexible, flexible, bar},
                                 {bar, bar, flexible, flexible},           {flexible, flexible, bar, bar}};
    const double force[3] = {-2960.0, 0.0, 0.0}, moment[3] = {100.0, 0.0, 0.0};
    (void)state;
    for (int k = 0; k < 6; k++) {
        const answer a = load_string(cases[k], 4, force, moment);
        CHECK_RELATIVE(a.shortening, 4.0 * 2960.0 / EA(), 1e-9);
        CHECK_RELATIVE(a.twist, 4.0 * 100.0 / GJ(), 1e-9);
        CHECK_RELATIVE(a.compression, 2960.0, 1e-9);
        CHECK_RELATIVE(a.torque, 100.0, 1e-9);
        CHECK_RELATIVE(a.reaction[0], 2960.0, 1e-9);
        CHECK_RELATIVE(a.reaction[3], -100.0, 1e-9);
        CHECK_RELATIVE(a.mass, 4.0 * EA() / 2.1e11 * 7850.0, 1e-12);
    }
}

/* Rigid pipes among them take their part of the length out of it and nothing else. */
static void rigid_pipes_between(void **state)
{
    const int32_t cases[5][5] = {{rigid, flexible, flexible, rigid, bar},
                                 {flexible, rigid, rigid, bar, bar},
                                 {bar, rigid, flexible, flexible, rigid},
                                 {rigid, rigid, bar, flexible, bar},
                                 {flexible, bar, rigid, rigid, flexible}};
    const double force[3] = {-2960.0, 0.0, 0.0}, moment[3] = {100.0, 0.0, 0.0};
    (void)state;
    for (int k = 0; k < 5; k++) {
        uint32_t elastic = 0;
        for (int i = 0; i < 5; i++) elastic += cases[k][i] != rigid;
        const answer a = load_string(cases[k], 5, force, moment);
        CHECK_RELATIVE(a.shortening, elastic * 2960.0 / EA(), 1e-9);
        CHECK_RELATIVE(a.twist, elastic * 100.0 / GJ(), 1e-9);
        CHECK_RELATIVE(a.compression, 2960.0, 1e-9);
        CHECK_RELATIVE(a.reaction[0], 2960.0, 1e-9);
        CHECK_RELATIVE(a.mass, 5.0 * EA() / 2.1e11 * 7850.0, 1e-12);
    }
}

/* Bending: a rigid pipe behind a flexible one is a lever. Tip force P at the end of a lever b behind a beam of length
 * l: deflection at the load P (l^3/3 + l^2 b + l b^2)/EI and slope P (l^2/2 + l b)/EI, plus shear P l/GA. */
static void rigid_lever(void **state)
{
    const int32_t kinds[2] = {flexible, rigid};
    const double force[3] = {0.0, 1.0, 0.0}, none[3] = {0.0, 0.0, 0.0};
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const double EI = GJ() * 1.3, GA = 0.5 * EA() / 2.6;
    dmb_string_def string = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_pose pose = dmb_pose_default();
    rig scene;
    dmb_id id = {0, 0};
    (void)state;
    string.start_free = DMB_FREE_NONE;
    scene_open(&scene, 0.0);
    add_string(&scene, &string);
    for (int i = 0; i < 2; i++) {
        dmb_pipe_def one = pipe;
        one.kind = kinds[i];
        id = add_pipes(&scene, &one, 1);
    }
    load.place = dmb_station(id, 1, 1.0);
    for (int i = 0; i < 3; i++) {
        load.force[i] = force[i];
        load.moment[i] = none[i];
    }
    add_load(&scene, &load);
    rig_start_with(&scene, NULL, NULL);
    scene_must(&scene, dmb_analysis_static(scene.sim, NULL, NULL));
    assert_int_equal(dmb_query_pose(scene.sim, load.place, &pose), DMB_OK);
    CHECK_RELATIVE(pose.displacement[1], (1.0 / 3.0 + 1.0 + 1.0) / EI + 1.0 / GA, 1e-6);
    CHECK_RELATIVE(pose.rotation[3], (0.5 + 1.0) / EI, 1e-6);
    rig_close(&scene);
}

/* ---- Rigid string ------------------------------------------------------------------------------------------------ */

/* Moments of inertia of `count` rigid pipes of 1 m about their common centre: hollow cylinders in a row. */
static void inertia_of_pipes(uint32_t count, double *mass, double *axial, double *across)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const double l = (double)count, m = l * EA() / 2.1e11 * 7850.0;
    const double r2 = 0.25 * (pow(pipe.outer_diameter, 2.0) + pow(pipe.inner_diameter, 2.0));
    *mass = m;
    *axial = 0.5 * m * r2;
    *across = m * l * l / 12.0 + 0.25 * m * r2;
}

/* A free rigid string thrown with spin about its axis and across it: a symmetric top without moments. The angular
 * momentum stands still, and the axis goes round it with H/J_across. */
static void free_top(void **state)
{
    double mass, axial, across;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_momentum momentum = dmb_momentum_default();
    dmb_pose pose = dmb_pose_default();
    rig scene;
    (void)state;
    inertia_of_pipes(2, &mass, &axial, &across);
    string.start_free = string.end_free = DMB_FREE_ALL;
    string.velocity[3] = 40.0;
    string.velocity[5] = 3.0;  /* about z at the rig end, so the centre 1 m ahead moves with 3 m/s along y */
    string.velocity[1] = -3.0; /* and stands still */
    pipe.kind = DMB_PIPE_RIGID;
    options.spectral_radius = 1.0;
    scene_open(&scene, 0.0);
    add_string(&scene, &string);
    const dmb_id id = add_pipes(&scene, &pipe, 2);
    rig_start_with(&scene, NULL, &options);
    assert_int_equal(scene_info(&scene).degrees_of_freedom, 6);
    assert_int_equal(scene_info(&scene).rigid_bodies, 1);
    const double H[3] = {axial * 40.0, 0.0, across * 3.0}, size = hypot(H[0], H[2]), rate = size / across;
    for (int i = 1; i <= 10000; i++) {
        scene_step(&scene, 1e-4);
        if (i % 1000) continue;
        const double t = dmb_sim_time(scene.sim), c = cos(rate * t), s = sin(rate * t);
        const double e[3] = {H[0] / size, 0.0, H[2] / size}; /* axis x turned about e by rate t (Rodrigues) */
        const double want[3] = {c + (1.0 - c) * e[0] * e[0], s * e[2], (1.0 - c) * e[0] * e[2]};
        assert_int_equal(dmb_query_pose(scene.sim, dmb_station(id, 1, 0.0), &pose), DMB_OK);
        for (int k = 0; k < 3; k++) CHECK_CLOSE(pose.rotation[3 * k], want[k], 1e-4);
        assert_int_equal(dmb_query_momentum(scene.sim, &momentum), DMB_OK);
        for (int k = 0; k < 3; k++) {
            CHECK_CLOSE(momentum.angular[k], H[k], 1e-4 * size);
            CHECK_CLOSE(momentum.linear[k], 0.0, 1e-4 * mass);
        }
        CHECK_RELATIVE(energy_of(&scene).kinetic, 0.5 * (axial * 1600.0 + across * 9.0), 1e-6);
    }
    rig_close(&scene);
}

/* A rigid string hinged at its rig end is a compound pendulum: w^2 = m g s/J for small swings, J = m l^2/3 + m r^2/4.
 */
static void compound_pendulum(void **state)
{
    double mass, axial, across;
    const double g = 9.81, amplitude = 1e-3, l = 3.0;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_motion motion = dmb_motion_default();
    rig scene;
    (void)state;
    inertia_of_pipes(3, &mass, &axial, &across);
    const double w = sqrt(mass * g * 0.5 * l / (across + 0.25 * mass * l * l)), quarter = 0.5 * PI / w;
    string.start_free = DMB_FREE_RZ;
    string.follows_hole = 0;
    string.rotation[1] = 0.5 * PI; /* x down, z along world x; RZ swings in the vertical plane */
    string.velocity[5] = amplitude * w;
    pipe.kind = DMB_PIPE_RIGID;
    scene_open(&scene, g);
    add_string(&scene, &string);
    const dmb_id id = add_pipes(&scene, &pipe, 3);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 4000; i++) scene_step(&scene, quarter / 2000.0);
    motion.frame = DMB_FRAME_BODY;
    assert_int_equal(dmb_query_motion(scene.sim, dmb_station(id, 0, 0.0), &motion), DMB_OK);
    CHECK_RELATIVE(motion.velocity[5], -amplitude * w, 1e-5); /* half a period later */
    rig_close(&scene);
}

/* A rigid string on the floor of its hole rests on its sites: their forces carry its weight. */
static void rigid_string_at_rest(void **state)
{
    double mass, axial, across;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_contact_total sum = dmb_contact_total_default();
    rig scene;
    (void)state;
    inertia_of_pipes(4, &mass, &axial, &across);
    string.start_free = string.end_free = DMB_FREE_ALL;
    pipe.kind = DMB_PIPE_RIGID;
    scene_open(&scene, 9.81);
    add_wall(&scene, &wall);
    add_string(&scene, &string);
    add_pipes(&scene, &pipe, 4);
    rig_start_with(&scene, NULL, NULL);
    for (int i = 0; i < 3000; i++) scene_step(&scene, 1e-3);
    assert_int_equal(dmb_query_contact_total(scene.sim, &sum), DMB_OK);
    CHECK_RELATIVE(sum.normal_force, mass * 9.81, 1e-3);
    for (uint32_t i = 0; i < 5; i++) /* a site stands for a metre, at the ends for half of one: all sink alike */
        CHECK_RELATIVE(-scene_contact(&scene, i).gap, mass * 9.81 / 4.0 / 1e7, 1e-2);
    rig_close(&scene);
}

/* One motion of many kinds: a string of each kind driven along its axis by a motion drive carries m a at its rig end.
 */
static void driven_alike(void **state)
{
    const int32_t kinds[3] = {flexible, bar, rigid};
    (void)state;
    for (int k = 0; k < 3; k++) {
        dmb_pipe_def pipe = dmb_pipe_def_default();
        dmb_drive_def drive = dmb_drive_def_default();
        dmb_drive_state told = dmb_drive_state_default();
        const dmb_segment ramp = scene_step_segment(0.0, 0.0, 2.0, 1.0);
        rig scene;
        pipe.kind = kinds[k];
        pipe.damping_time = 1e-4;
        scene_open(&scene, 0.0);
        add_pipes(&scene, &pipe, 4);
        drive.time_function = add_time_function(&scene, &ramp, 1);
        const dmb_id id = add_drive(&scene, &drive);
        rig_start_with(&scene, NULL, NULL);
        for (int i = 0; i < 1000; i++) scene_step(&scene, 1e-3);
        assert_int_equal(dmb_query_drive(scene.sim, id, &told), DMB_OK);
        CHECK_RELATIVE(told.force, scene_info(&scene).mass * 0.75, 1e-4); /* steepest slope of the ramp, 1.5/2 */
        rig_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_compression_and_twist),
        cmocka_unit_test(rigid_pipes_between),
        cmocka_unit_test(rigid_lever),
        cmocka_unit_test(free_top),
        cmocka_unit_test(compound_pendulum),
        cmocka_unit_test(rigid_string_at_rest),
        cmocka_unit_test(driven_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
