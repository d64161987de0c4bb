/* The golden run: one scene, 1000 steps of 1 ms, the same bits for ever. When the hash of the end state differs, the
 * table of figures tells what has moved; they are held to 1e-9. A change of results that is meant is stored by
 * tests/golden/update, with its reason. `--write FILE` writes golden_values.h. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"

/* -ffp-contract=off leaves compilers no choice: gcc 12 and clang 14 give the same bits from -O0 to -O3. Sine,
 * exponential and the like are the library's own (contract/test_processors). gcc 12 with -mfma fuses alternating sums
 * of products all the same (unless -fno-tree-slp-vectorize), which moves the figures by 1e-11 of their scale. */
#if defined(__x86_64__)
#define ARCHITECTURE "x86_64"
#elif defined(__aarch64__)
#define ARCHITECTURE "aarch64"
#else
#define ARCHITECTURE "other"
#endif
#if defined(__GLIBC__)
#define C_LIBRARY "glibc"
#else
#define C_LIBRARY "other"
#endif
static const char platform[] = ARCHITECTURE " " C_LIBRARY;

typedef struct golden_hash {
    const char *platform;
    uint64_t hash;
} golden_hash;

typedef struct golden_figure {
    const char *name;
    double value;
    double scale; /* size of the numbers that it is made of: the tolerance is 1e-9 of it */
} golden_figure;

#include "golden_values.h"

enum { STEPS = 1000, PIPES = 12, FIGURES_MAX = 64 };

/* ---- The scene --------------------------------------------------------------------------------------------------- */

static struct {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, bit, feed, turning;
    uint64_t hash;
    golden_figure figures[FIGURES_MAX];
    size_t figure_count;
} run;

static void must(int32_t status)
{
    if (status >= 0) return;
    fail_msg("%s: %s", dmb_status_name(status),
             run.sim != NULL ? dmb_sim_message(run.sim) : dmb_model_message(run.model));
}

static dmb_id add_step(double end, double value)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id = {0, 0};
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = end;
    term.h1 = value;
    must(dmb_model_add_time_function(run.model, &term, 1, &id));
    return id;
}

static dmb_id add_harmonic(void)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id = {0, 0};
    term.kind = DMB_SEGMENT_HARMONIC;
    term.h1 = 0.002;
    term.omega = 60.0;
    must(dmb_model_add_time_function(run.model, &term, 1, &id));
    return id;
}

static void add_hole(void)
{
    static const double survey[3][3] = {
        {0.0, 1.5707963267948966, 0.0}, {6.0, 1.5707963267948966, 0.0}, {40.0, 1.62, -0.03}};
    dmb_wall_def wall = dmb_wall_def_default();
    wall.survey = survey[0];
    wall.survey_count = 3;
    must(dmb_model_add_wall(run.model, &wall, NULL));
}

static void add_string(void)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.elements = 2;
    pipe.damping_time = 1e-5;
    pipe.joint_length = 0.1;
    pipe.joint_outer_diameter = 0.079;
    pipe.eccentricity = 1e-3;
    pipe.eccentricity_spread = 5e-4;
    pipe.angle_spread = 3.0;
    must(dmb_model_add_pipes(run.model, &pipe, PIPES - 2, &run.string));
    pipe.kind = DMB_PIPE_RIGID;
    must(dmb_model_add_pipes(run.model, &pipe, 2, NULL));
}

static void add_bit(void)
{
    dmb_bit_def bit = dmb_bit_def_default();
    bit.rock_law = DMB_ROCK_RATE;
    bit.load = add_step(0.3, 500.0);
    must(dmb_model_add_bit(run.model, &bit, &run.bit));
}

static void add_drives(void)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.time_function = add_step(0.2, 0.02);
    drive.excitation = add_harmonic();
    must(dmb_model_add_drive(run.model, &drive, &run.feed));
    drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_CONTROL;
    drive.component = DMB_RX;
    drive.time_function = add_step(0.3, 20.0);
    drive.gain = 300.0;
    drive.integral_gain = 100.0;
    must(dmb_model_add_drive(run.model, &drive, &run.turning));
}

/* ---- The run and its figures ------------------------------------------------------------------------------------- */

static void note(const char *name, double value, double scale)
{
    golden_figure *figure = &run.figures[run.figure_count++];
    assert_true(run.figure_count <= FIGURES_MAX);
    figure->name = name;
    figure->value = value;
    figure->scale = scale;
}

static void note_poses(void)
{
    dmb_pose middle = dmb_pose_default(), tip = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    double angle = 0.0;
    must(dmb_query_pose(run.sim, dmb_station(run.string, PIPES / 2, 0.3), &middle));
    must(dmb_query_pose(run.sim, dmb_station(run.string, PIPES - 1, 1.0), &tip));
    must(dmb_query_motion(run.sim, dmb_station(run.string, PIPES - 1, 1.0), &motion));
    must(dmb_query_rotation(run.sim, dmb_station(run.string, PIPES - 1, 1.0), &angle));
    note("middle displacement x [m]", middle.displacement[0], 1.0);
    note("middle displacement y [m]", middle.displacement[1], 1.0);
    note("middle displacement z [m]", middle.displacement[2], 1.0);
    note("tip displacement x [m]", tip.displacement[0], 1.0);
    note("tip displacement y [m]", tip.displacement[1], 1.0);
    note("tip displacement z [m]", tip.displacement[2], 1.0);
    note("tip speed x [m/s]", motion.velocity[0], 1.0);
    note("tip spin x [rad/s]", motion.velocity[3], 20.0);
    note("tip rotation [rad]", angle, 20.0);
}

static void note_forces(void)
{
    dmb_section section = dmb_section_default();
    dmb_contact_total sum = dmb_contact_total_default();
    dmb_bit_state bit = dmb_bit_state_default();
    dmb_drive_state feed = dmb_drive_state_default(), turning = dmb_drive_state_default();
    must(dmb_query_section(run.sim, dmb_station(run.string, 3, 0.5), &section));
    must(dmb_query_contact_total(run.sim, &sum));
    must(dmb_query_bit(run.sim, run.bit, &bit));
    must(dmb_query_drive(run.sim, run.feed, &feed));
    must(dmb_query_drive(run.sim, run.turning, &turning));
    note("axial force in pipe 3 [N]", section.force[0], 1e4);
    note("torque in pipe 3 [N m]", section.force[3], 1e3);
    note("bending moment in pipe 3 [N m]", section.force[5], 1e3);
    note("sites that touch [-]", sum.closed, 1.0);
    note("normal force in all [N]", sum.normal_force, 1e4);
    note("friction along the hole [N]", sum.friction[0], 1e4);
    note("depth of cut [m]", bit.depth_of_cut, 1.0);
    note("weight on bit [N]", bit.weight, 1e4);
    note("torque on bit [N m]", bit.torque, 1e3);
    note("feed force [N]", feed.force, 1e4);
    note("feed travel [m]", feed.position, 1.0);
    note("turning torque [N m]", turning.force, 1e3);
}

static void note_sums(void)
{
    dmb_energy energy = dmb_energy_default();
    dmb_momentum momentum = dmb_momentum_default();
    dmb_statistics statistics = dmb_statistics_default();
    must(dmb_query_energy(run.sim, &energy));
    must(dmb_query_momentum(run.sim, &momentum));
    must(dmb_query_statistics(run.sim, &statistics));
    note("kinetic energy [J]", energy.kinetic, 1e3);
    note("strain energy [J]", energy.strain, 1e3);
    note("work of the drives [J]", energy.drives, 1e3);
    note("lost to friction [J]", energy.friction, 1e3);
    note("spent at the bit [J]", energy.rock, 1e3);
    note("momentum x [kg m/s]", momentum.linear[0], 1e2);
    note("steps [-]", (double)statistics.steps, 1.0);
    note("iterations [-]", (double)statistics.iterations, 1.0);
}

static int set_up(void **state)
{
    (void)state;
    memset(&run, 0, sizeof run);
    must(dmb_model_create(NULL, &run.model));
    add_hole();
    add_string();
    add_bit();
    add_drives();
    must(dmb_model_compile(run.model, NULL));
    must(dmb_sim_create(run.model, NULL, &run.sim));
    for (int i = 0; i < STEPS; i++) must(dmb_sim_step(run.sim, 1e-3, NULL));
    must(dmb_sim_hash(run.sim, &run.hash));
    note_poses();
    note_forces();
    note_sums();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    dmb_sim_destroy(&run.sim);
    dmb_model_destroy(&run.model);
    return 0;
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

enum {
    STORED_FIGURES = sizeof golden_figures / sizeof golden_figures[0],
    STORED_HASHES = sizeof golden_hashes / sizeof golden_hashes[0]
};

static void figures_are_as_stored(void **state)
{
    size_t wrong = 0;
    (void)state;
    assert_int_equal(run.figure_count, STORED_FIGURES);
    for (size_t i = 0; i < STORED_FIGURES; i++) {
        const golden_figure *is = &run.figures[i], *was = &golden_figures[i];
        const double off = fabs(is->value - was->value);
        const int bad = !(off <= 1e-9 * was->scale);
        assert_string_equal(is->name, was->name);
        print_message("    %-34s %24.17g  %24.17g  %9.2g%s\n", is->name, is->value, was->value, off, bad ? "  *" : "");
        wrong += (size_t)bad;
    }
    if (wrong > 0) fail_msg("%zu figures differ from the stored ones by more than 1e-9", wrong);
}

static void hash_is_as_stored_skipped_on_platforms_without_one(void **state)
{
    (void)state;
    for (size_t i = 0; i < STORED_HASHES; i++) {
        if (strcmp(golden_hashes[i].platform, platform) != 0) continue;
        if (run.hash != golden_hashes[i].hash)
            fail_msg("the end state has the hash %016llx, stored is %016llx", (unsigned long long)run.hash,
                     (unsigned long long)golden_hashes[i].hash);
        return;
    }
    skip();
}

/* ---- golden_values.h --------------------------------------------------------------------------------------------- */

static const char *file_name;

static void write_values(void **state)
{
    FILE *file = fopen(file_name, "w");
    (void)state;
    assert_non_null(file);
    fprintf(file, "/* Written by tests/golden/update; reasons of changes stand under Numerics in CHANGELOG.md. */\n");
    fprintf(file, "static const golden_hash golden_hashes[] = {\n");
    fprintf(file, "    {\"%s\", UINT64_C(0x%016llx)},\n", platform, (unsigned long long)run.hash);
    for (size_t i = 0; i < STORED_HASHES; i++) {
        if (strcmp(golden_hashes[i].platform, platform) == 0) continue;
        fprintf(file, "    {\"%s\", UINT64_C(0x%016llx)},\n", golden_hashes[i].platform,
                (unsigned long long)golden_hashes[i].hash);
    }
    fprintf(file, "};\n\nstatic const golden_figure golden_figures[] = {\n");
    for (size_t i = 0; i < run.figure_count; i++)
        fprintf(file, "    {\"%s\", %.17g, %g},\n", run.figures[i].name, run.figures[i].value, run.figures[i].scale);
    fprintf(file, "};\n");
    assert_int_equal(fclose(file), 0);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_are_as_stored),
        cmocka_unit_test(hash_is_as_stored_skipped_on_platforms_without_one),
    };
    const struct CMUnitTest writer[] = {cmocka_unit_test(write_values)};
    if (argc != 3 || strcmp(argv[1], "--write") != 0) return cmocka_run_group_tests(tests, set_up, tear_down);
    file_name = argv[2];
    return cmocka_run_group_tests(writer, set_up, tear_down);
}
