/* Features that a scene leaves out are not there in the step: the counts, the memory and the results of a compile
 * without contact, friction or vibration are those of a scene that never described them. */
#include "contact_scene.h"

enum { PIPES = 12 };

/* Parts to describe; what is not described cannot be left out either. */
enum {
    WITH_WALL = 1,
    WITH_FRICTION = 2,
    WITH_ECCENTRICITY = 4,
    WITH_EXCITATION = 8,
    WITH_ROCK = 16,
    WITH_DAMPING = 32,
    WITH_GRAVITY = 64,
    WITH_ALL = 127
};

static dmb_id describe(rig *scene, int parts, int32_t pipe_kind)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_segment shake = dmb_segment_default();
    const dmb_segment feed = scene_step_segment(0.0, 0.0, 0.05, 0.01), turn = scene_step_segment(0.0, 0.0, 0.05, 20.0);
    scene_open(scene, parts & WITH_GRAVITY ? 9.81 : 0.0);
    environment.gravity[2] = parts & WITH_GRAVITY ? -9.81 : 0.0;
    environment.lateral_damping = parts & WITH_DAMPING ? 20.0 : 0.0;
    scene_must(scene, dmb_model_set_environment(scene->model, &environment));
    wall.normal_law = parts & WITH_WALL ? DMB_NORMAL_HUNT_CROSSLEY : DMB_NORMAL_NONE;
    wall.friction_law = parts & WITH_FRICTION ? DMB_FRICTION_STRIBECK : DMB_FRICTION_NONE;
    add_wall(scene, &wall);
    pipe.kind = pipe_kind;
    pipe.eccentricity = parts & WITH_ECCENTRICITY ? 1e-3 : 0.0;
    const dmb_id string = add_pipes(scene, &pipe, PIPES);
    bit.rock_law = parts & WITH_ROCK ? DMB_ROCK_REGENERATIVE : DMB_ROCK_NONE;
    scene_add_bit(scene, &bit);
    shake.kind = DMB_SEGMENT_HARMONIC;
    shake.h1 = 1e-3;
    shake.omega = 50.0;
    drive.time_function = add_time_function(scene, &feed, 1);
    const dmb_id excitation = add_time_function(scene, &shake, 1);
    if (parts & WITH_EXCITATION) drive.excitation = excitation;
    add_drive(scene, &drive);
    drive.component = DMB_RX;
    drive.time_function = add_time_function(scene, &turn, 1);
    drive.excitation.index = drive.excitation.generation = 0;
    add_drive(scene, &drive);
    return string;
}

static int32_t mask_of(int parts)
{
    int32_t mask = DMB_FEATURE_ALL;
    if (!(parts & WITH_WALL)) mask &= ~DMB_FEATURE_CONTACT;
    if (!(parts & WITH_FRICTION)) mask &= ~DMB_FEATURE_FRICTION;
    if (!(parts & WITH_ECCENTRICITY)) mask &= ~DMB_FEATURE_ECCENTRICITY;
    if (!(parts & WITH_EXCITATION)) mask &= ~DMB_FEATURE_EXCITATION;
    if (!(parts & WITH_ROCK)) mask &= ~DMB_FEATURE_ROCK;
    if (!(parts & WITH_DAMPING)) mask &= ~DMB_FEATURE_DAMPING;
    if (!(parts & WITH_GRAVITY)) mask &= ~DMB_FEATURE_GRAVITY;
    return mask;
}

typedef struct outcome {
    dmb_model_info info;
    dmb_pose tip;
    double work;   /* [J] of the drives */
    double energy; /* [J] kinetic and stored */
} outcome;

/* Describes some parts, leaves in some of them, and takes 200 steps. */
static outcome run(int described, int left_in, int32_t pipe_kind)
{
    dmb_compile_options compile = dmb_compile_options_default();
    rig scene;
    outcome out;
    const dmb_id string = describe(&scene, described, pipe_kind);
    compile.features = mask_of(left_in);
    rig_start_with(&scene, &compile, NULL);
    for (int i = 0; i < 200; i++) scene_step(&scene, 1e-3);
    out.info = scene_info(&scene);
    out.tip = dmb_pose_default();
    assert_int_equal(dmb_query_pose(scene.sim, dmb_station(string, PIPES - 1, 1.0), &out.tip), DMB_OK);
    out.work = energy_of(&scene).drives;
    out.energy = scene_total_energy(&scene);
    rig_close(&scene);
    return out;
}

/* Left out is the same as never described, to the bit, and costs the same memory. */
static void same_as_never_described(void **state)
{
    static const int parts[] = {WITH_ALL & ~WITH_WALL,
                                WITH_ALL & ~WITH_FRICTION,
                                WITH_ALL & ~WITH_ECCENTRICITY,
                                WITH_ALL & ~WITH_EXCITATION,
                                WITH_ALL & ~WITH_ROCK,
                                WITH_ALL & ~WITH_DAMPING,
                                WITH_ALL & ~WITH_GRAVITY,
                                WITH_ALL & ~(WITH_ECCENTRICITY | WITH_EXCITATION),
                                0};
    static const int32_t kinds[] = {DMB_PIPE_FLEXIBLE, DMB_PIPE_AXIAL_TORSIONAL, DMB_PIPE_RIGID};
    (void)state;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 9; i++) {
            const outcome left_out = run(WITH_ALL, parts[i], kinds[k]), never = run(parts[i], WITH_ALL, kinds[k]);
            CHECK_CLOSE(left_out.work, never.work, 0.0);
            CHECK_CLOSE(left_out.energy, never.energy, 0.0);
            for (int j = 0; j < 3; j++) CHECK_CLOSE(left_out.tip.position[j], never.tip.position[j], 0.0);
            assert_int_equal(left_out.info.contact_points, never.info.contact_points);
            assert_int_equal(left_out.info.degrees_of_freedom, never.info.degrees_of_freedom);
            assert_int_equal(left_out.info.sim_bytes, never.info.sim_bytes);
        }
}

/* Sites and memory fall as promised. */
static void counts(void **state)
{
    (void)state;
    const dmb_model_info all = run(WITH_ALL, WITH_ALL, DMB_PIPE_FLEXIBLE).info;
    const dmb_model_info no_contact = run(WITH_ALL, WITH_ALL & ~WITH_WALL, DMB_PIPE_FLEXIBLE).info;
    const dmb_model_info no_friction = run(WITH_ALL, WITH_ALL & ~WITH_FRICTION, DMB_PIPE_FLEXIBLE).info;
    const dmb_model_info no_vibration =
        run(WITH_ALL, WITH_ALL & ~(WITH_ECCENTRICITY | WITH_EXCITATION), DMB_PIPE_FLEXIBLE).info;
    const dmb_model_info no_rock = run(WITH_ALL, WITH_ALL & ~WITH_ROCK, DMB_PIPE_FLEXIBLE).info;
    print_message(
        "bytes of a sim: all %llu, no contact %llu, no friction %llu, no vibration %llu, no rock %llu; of the "
        "model: all %llu, no contact %llu\n",
        (unsigned long long)all.sim_bytes, (unsigned long long)no_contact.sim_bytes,
        (unsigned long long)no_friction.sim_bytes, (unsigned long long)no_vibration.sim_bytes,
        (unsigned long long)no_rock.sim_bytes, (unsigned long long)all.model_bytes,
        (unsigned long long)no_contact.model_bytes);
    assert_int_equal(all.contact_points, PIPES + 1); /* every node but the guided one, and the bit */
    assert_int_equal(no_contact.contact_points, 0);
    assert_int_equal(no_friction.contact_points, all.contact_points);
    assert_true(no_contact.sim_bytes < all.sim_bytes);
    assert_true(no_contact.model_bytes < all.model_bytes);
    assert_true(no_friction.sim_bytes <= all.sim_bytes);
    assert_true(no_rock.sim_bytes < all.sim_bytes);
    assert_int_equal(no_vibration.degrees_of_freedom, all.degrees_of_freedom);
    /* axial-torsional pipes have sites for friction's sake alone */
    assert_true(run(WITH_ALL, WITH_ALL, DMB_PIPE_AXIAL_TORSIONAL).info.contact_points > 0);
    assert_int_equal(run(WITH_ALL, WITH_ALL & ~WITH_FRICTION, DMB_PIPE_AXIAL_TORSIONAL).info.contact_points, 0);
}

/* pipe_kind of the compile options turns all pipes into one kind: fewer degrees_of_freedom, no description changed. */
static void pipe_kind_of_compile(void **state)
{
    static const int32_t kinds[] = {DMB_PIPE_FLEXIBLE, DMB_PIPE_AXIAL_TORSIONAL, DMB_PIPE_RIGID};
    uint32_t degrees_of_freedom[3];
    (void)state;
    for (int k = 0; k < 3; k++) {
        dmb_compile_options compile = dmb_compile_options_default();
        rig scene, plain;
        compile.pipe_kind = kinds[k];
        describe(&scene, WITH_ALL, DMB_PIPE_FLEXIBLE);
        describe(&plain, WITH_ALL, kinds[k]);
        rig_start_with(&scene, &compile, NULL);
        rig_start_with(&plain, NULL, NULL);
        for (int i = 0; i < 100; i++) {
            scene_step(&scene, 1e-3);
            scene_step(&plain, 1e-3);
        }
        degrees_of_freedom[k] = scene_info(&scene).degrees_of_freedom;
        CHECK_CLOSE(scene_total_energy(&scene), scene_total_energy(&plain), 0.0);
        rig_close(&scene);
        rig_close(&plain);
    }
    print_message("degrees_of_freedom: flexible %u, axial-torsional %u, rigid %u\n", degrees_of_freedom[0],
                  degrees_of_freedom[1], degrees_of_freedom[2]);
    assert_true(degrees_of_freedom[0] > degrees_of_freedom[1] && degrees_of_freedom[1] > degrees_of_freedom[2]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_as_never_described),
        cmocka_unit_test(counts),
        cmocka_unit_test(pipe_kind_of_compile),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
