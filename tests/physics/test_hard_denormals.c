/* Hard case 16: the same result to 1e-12 with and without flushing of denormal numbers to zero. */
#include "contact_scene.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#define CAN_FLUSH 1
/* Bits of MXCSR: results that are denormal become 0 (15), operands that are denormal count as 0 (6). */
static void flush_denormals(int on)
{
    const unsigned bits = 1U << 15 | 1U << 6;
    _mm_setcsr(on ? _mm_getcsr() | bits : _mm_getcsr() & ~bits);
}
#else
#define CAN_FLUSH 0
static void flush_denormals(int on)
{
    (void)on;
}
#endif

enum { PIPES = 10, VALUES = 12 * (PIPES + 1) };

/* Displacements and velocities of every pipe's far end. */
static void read_state(const rig *scene, dmb_id string, double values[VALUES])
{
    for (uint32_t i = 0; i <= PIPES; i++) {
        const dmb_place place = dmb_station(string, i > 0 ? i - 1 : 0, i > 0 ? 1.0 : 0.0);
        dmb_pose pose = dmb_pose_default();
        dmb_motion motion = dmb_motion_default();
        assert_int_equal(dmb_query_pose(scene->sim, place, &pose), DMB_OK);
        assert_int_equal(dmb_query_motion(scene->sim, place, &motion), DMB_OK);
        for (int k = 0; k < 3; k++) values[12 * i + (uint32_t)k] = pose.displacement[k];
        for (int k = 0; k < 3; k++) values[12 * i + 3 + (uint32_t)k] = pose.rotation[3 * k];
        for (int k = 0; k < 6; k++) values[12 * i + 6 + (uint32_t)k] = motion.velocity[k];
    }
}

/* Flexible pipes that fall onto the wall, are fed and turned, with friction and eccentricity. */
static dmb_id build_rig(rig *scene)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    const dmb_segment feed = scene_step_segment(0.0, 0.0, 0.1, 0.01), turn = scene_step_segment(0.0, 0.0, 0.1, 20.0);
    pipe.eccentricity = 1e-3;
    pipe.damping_time = 1e-4;
    scene_open(scene, 9.81);
    add_wall(scene, &wall);
    const dmb_id id = add_pipes(scene, &pipe, PIPES);
    drive.time_function = add_time_function(scene, &feed, 1);
    add_drive(scene, &drive);
    drive.component = DMB_RX;
    drive.time_function = add_time_function(scene, &turn, 1);
    add_drive(scene, &drive);
    rig_start_with(scene, NULL, NULL);
    return id;
}

/* A heavily damped bar whose motion dies out. */
static dmb_id build_bar(rig *scene, double speed)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    string.start_free = DMB_FREE_X;
    string.velocity[0] = speed;
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.damping_time = 1e-3;
    environment.axial_damping = 1e6;
    scene_open(scene, 0.0);
    scene_must(scene, dmb_model_set_environment(scene->model, &environment));
    add_string(scene, &string);
    const dmb_id id = add_pipes(scene, &pipe, PIPES);
    rig_start_with(scene, NULL, NULL);
    return id;
}

static dmb_id build_fading(rig *scene)
{
    return build_bar(scene, 1e-3);
}

/* Speeds and forces that are denormal numbers from the start, or become so. Squares of forces below 1e-154 N are 0, and
 * count as solved: what is left of the speeds there has no meaning but to stay as small. */
static dmb_id build_denormal(rig *scene)
{
    return build_bar(scene, 1e-306);
}

static void run(dmb_id (*build)(rig *), int steps, double h, int flush, double values[VALUES], dmb_statistics *work)
{
    rig scene;
    flush_denormals(flush);
    const dmb_id id = build(&scene);
    for (int i = 0; i < steps; i++) scene_step(&scene, h);
    read_state(&scene, id, values);
    *work = statistics_of(&scene);
    rig_close(&scene);
    flush_denormals(0);
}

static double compare(dmb_id (*build)(rig *), int steps, double h)
{
    double with[VALUES], without[VALUES], scale[2] = {0.0, 0.0}, worst = 0.0;
    dmb_statistics flushed, kept;
    if (!CAN_FLUSH) skip();
    run(build, steps, h, 0, without, &kept);
    run(build, steps, h, 1, with, &flushed);
    print_message("%llu steps, %llu iterations\n", (unsigned long long)kept.steps, (unsigned long long)kept.iterations);
    assert_true(kept.steps == flushed.steps && kept.rejected == flushed.rejected); /* nothing stalls on them */
    assert_true(kept.iterations == flushed.iterations);
    for (int i = 0; i < VALUES; i++) {
        double *s = scale + (i % 12 >= 6);
        *s = fmax(*s, fabs(without[i]));
    }
    for (int i = 0; i < VALUES; i++) worst = fmax(worst, fabs(with[i] - without[i]) / fmax(scale[i % 12 >= 6], 1e-6));
    print_message("largest difference %.2e\n", worst);
    CHECK_BELOW(worst, 1e-12);
    return scale[1];
}

static void rig_with_contact(void **state)
{
    (void)state;
    (void)compare(build_rig, 500, 1e-3);
}

static void fading_motion(void **state)
{
    (void)state;
    print_message("largest speed left %.2e\n", compare(build_fading, 4000, 1e-2));
}

static void denormal_motion(void **state)
{
    (void)state;
    const double left = compare(build_denormal, 1000, 1e-3);
    print_message("largest speed left %.2e\n", left);
    CHECK_BELOW(left, 1e-150);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rig_with_contact),
        cmocka_unit_test(fading_motion),
        cmocka_unit_test(denormal_motion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
