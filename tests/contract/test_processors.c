/* The same bits on processors with and without fused multiply-add and wide vectors: runs itself once as it is and once
 * with glibc told that the processor has none (its sine, exponential and power then round in their other way), and
 * compares the hashes of scenes that take every law and function a step has. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>

#include "joint_scene.h"
#include "whole_scene.h"

static const char *program;

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

static uint64_t parts_of_all_kinds(void)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim *sim = whole_sim(model, NULL);
    whole_run(sim, 40, 1e-3);
    const uint64_t hash = whole_hash(sim);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return hash;
}

static uint64_t joints_of_all_kinds(void)
{
    joint_scene scene;
    joint_scene_open(&scene, NULL);
    dmb_sim *sim = whole_sim(scene.s.model, NULL);
    whole_run(sim, 40, 1e-3);
    const uint64_t hash = whole_hash(sim);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&scene.s.model);
    return hash;
}

/* A wall whose force goes with a power of depth, Stribeck's curve, an oscillating feed, eccentric pipes, error
 * control. */
static uint64_t string_on_the_wall(int32_t pipe_kind, int32_t normal_law)
{
    dmb_model *model = NULL;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment term = dmb_segment_default();
    dmb_body_def head = dmb_body_def_default();
    assert_int_equal(dmb_model_create(NULL, &model), DMB_OK);
    wall.normal_law = normal_law;
    wall.exponent = 1.3;
    wall.friction_law = DMB_FRICTION_STRIBECK;
    whole_must(model, dmb_model_add_wall(model, &wall, NULL));
    pipe.kind = pipe_kind;
    if (pipe_kind != DMB_PIPE_AXIAL_TORSIONAL) pipe.eccentricity = 2e-3, pipe.angle_spread = 3.0;
    whole_must(model, dmb_model_add_pipes(model, &pipe, 4, NULL));
    head.attach = DMB_ATTACH_START;
    whole_must(model, dmb_model_add_body(model, &head, NULL));
    term.kind = DMB_SEGMENT_HARMONIC;
    term.h1 = 0.3;
    term.omega = 37.0;
    whole_must(model, dmb_model_add_time_function(model, &term, 1, &drive.time_function));
    whole_must(model, dmb_model_add_drive(model, &drive, NULL));
    drive.kind = DMB_DRIVE_LOAD;
    drive.component = DMB_RX;
    whole_must(model, dmb_model_add_drive(model, &drive, NULL));
    whole_must(model, dmb_model_compile(model, NULL));
    dmb_sim *sim = whole_sim(model, NULL);
    whole_run(sim, 40, 1e-3);
    assert_true(dmb_sim_advance(sim, 0.06, NULL) >= 0);
    const uint64_t hash = whole_hash(sim);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return hash;
}

/* ---- The two runs ------------------------------------------------------------------------------------------------ */

enum { HASHES = 6 };

static void write_hashes(FILE *to)
{
    const uint64_t hashes[HASHES] = {parts_of_all_kinds(),
                                     joints_of_all_kinds(),
                                     string_on_the_wall(DMB_PIPE_FLEXIBLE, DMB_NORMAL_KELVIN_VOIGT),
                                     string_on_the_wall(DMB_PIPE_FLEXIBLE, DMB_NORMAL_EXACT),
                                     string_on_the_wall(DMB_PIPE_RIGID, DMB_NORMAL_KELVIN_VOIGT),
                                     string_on_the_wall(DMB_PIPE_AXIAL_TORSIONAL, DMB_NORMAL_KELVIN_VOIGT)};
    for (int i = 0; i < HASHES; i++) fprintf(to, "%016llx\n", (unsigned long long)hashes[i]);
}

static void run(const char *environment, char text[17 * HASHES + 1])
{
    char command[1024];
    assert_true(snprintf(command, sizeof command, "%s '%s' --hash", environment, program) < (int)sizeof command);
    FILE *from = popen(command, "r");
    assert_non_null(from);
    const size_t read = fread(text, 1, 17 * HASHES, from);
    text[read] = '\0';
    assert_int_equal(pclose(from), 0);
    assert_int_equal(read, 17 * HASHES);
}

static void processors_agree(void **state)
{
    (void)state;
    char wide[17 * HASHES + 1], narrow[17 * HASHES + 1];
    run("", wide);
    run("GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4", narrow);
    assert_string_equal(wide, narrow);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(processors_agree)};
    program = argv[0];
    if (argc > 1) {
        write_hashes(stdout);
        return 0;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
