#include "run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "progress.h"

/* ---- Files ------------------------------------------------------------------------------------------------------- */

typedef struct rig_path {
    char text[4096];
} rig_path;

static rig_path file_of(const rig_options *options, const rig_result *result, const char *ending)
{
    rig_path path;
    snprintf(path.text, sizeof path.text, "%s/%s%s", options->output, result->name, ending);
    return path;
}

static int32_t write_string(const rig_options *options, const rig_result *result, const dmb_sim *sim)
{
    char ending[40];
    if (options->output == NULL) return DMB_OK;
    snprintf(ending, sizeof ending, "_string_at_%gs.vtp", dmb_sim_time(sim));
    const rig_path path = file_of(options, result, ending);
    return dmb_write_vtk_strings(sim, 2, path.text);
}

/* Every variant has the same hole. */
static int32_t write_hole(const rig_options *options, const rig_result *result, const dmb_model *model)
{
    rig_path path;
    if (options->output == NULL) return DMB_OK;
    snprintf(path.text, sizeof path.text, "%s/hole.vtp", options->output);
    return dmb_write_vtk_hole(model, 0.0, result->info.length + 1.0, 1.0, 32, path.text);
}

static int32_t write_table(const rig_options *options, const rig_result *result)
{
    if (options->output == NULL) return DMB_OK;
    const rig_path path = file_of(options, result, ".csv");
    const int32_t status = rig_recording_write(&result->recording, options, path.text);
    if (status < 0) fprintf(stderr, "%s: %s\n", path.text, dmb_status_text(status));
    return status;
}

/* ---- Time -------------------------------------------------------------------------------------------------------- */

/* Stage ends between two times, so that a picture of the string can be kept of each. */
static int passes_stage_end(const rig_options *options, double before, double now)
{
    for (int i = 1; i <= RIG_STAGES; ++i) {
        const double end = options->cycle.time[i] - 1e-9;
        if (before < end && now >= end) return 1;
    }
    return now >= options->end - 1e-9;
}

static int32_t run_through(const rig_options *options, dmb_sim *sim, rig_result *result)
{
    rig_progress progress = rig_progress_begin(result->name, options->end, options->quiet);
    int32_t status = rig_recording_take(&result->recording, sim);
    if (status >= 0) status = write_string(options, result, sim);
    for (double k = 1.0; status >= 0 && dmb_sim_time(sim) < options->end - 1e-9; k += 1.0) {
        const double before = dmb_sim_time(sim);
        const double next = fmin(k * options->step, options->end);
        status = dmb_sim_step(sim, next - before, NULL);
        if (status >= 0) status = rig_recording_take(&result->recording, sim);
        if (status >= 0 && passes_stage_end(options, before, next)) status = write_string(options, result, sim);
        rig_progress_show(&progress, dmb_sim_time(sim));
    }
    result->seconds = rig_clock() - progress.started;
    rig_progress_end(&progress);
    return status;
}

/* The string starts at rest on the low side of its hole, or falls onto it. */
static int32_t start_and_run(const rig_options *options, const rig_scene *scene, dmb_sim *sim, rig_result *result)
{
    int32_t status = options->dropped ? DMB_OK : dmb_analysis_static(sim, NULL, &result->start);
    if (status >= 0) status = dmb_query_energy(sim, &result->energy_at_start);
    if (status >= 0) status = rig_recording_open(&result->recording, options, scene);
    if (status >= 0) status = run_through(options, sim, result);
    if (status < 0) {
        fprintf(stderr, "%s, %g s: %s: %s\n", result->name, dmb_sim_time(sim), dmb_status_text(status),
                dmb_sim_message(sim));
        return status;
    }
    dmb_query_statistics(sim, &result->statistics);
    dmb_query_energy(sim, &result->energy);
    return write_table(options, result);
}

/* ---- A variant --------------------------------------------------------------------------------------------------- */

static void begin(const rig_variant *variant, rig_result *result)
{
    memset(result, 0, sizeof *result);
    result->variant = *variant;
    result->info = dmb_model_info_default();
    result->start = dmb_static_report_default();
    result->statistics = dmb_statistics_default();
    result->energy_at_start = result->energy = dmb_energy_default();
    snprintf(result->name, sizeof result->name, "%s-%s", rig_system_name(variant), rig_couple_name(variant));
}

int32_t rig_run(rig_options *options, const rig_variant *variant, rig_result *result)
{
    rig_scene scene;
    dmb_sim *sim = NULL;
    begin(variant, result);
    int32_t status = rig_scene_make(options, variant, &scene);
    if (status >= 0) status = dmb_model_get_info(scene.model, &result->info);
    if (status >= 0) status = dmb_sim_create(scene.model, NULL, &sim);
    if (status >= 0) status = write_hole(options, result, scene.model);
    if (status < 0)
        fprintf(stderr, "%s: %s: %s\n", result->name, dmb_status_text(status), dmb_model_message(scene.model));
    else
        status = start_and_run(options, &scene, sim, result);
    result->weight = 9.81 * result->info.mass;
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&scene.model);
    return status;
}

void rig_result_close(rig_result *result)
{
    rig_recording_close(&result->recording);
}
