#include "recording.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void watch(dmb_output *output, dmb_place place, int32_t quantity)
{
    output->place = place;
    output->quantity = quantity;
    output->reserved = 0;
}

static void choose_outputs(rig_recording *recording, const rig_scene *scene)
{
    dmb_output *next = recording->outputs;
    for (int p = 0; p < RIG_PLACES; ++p) {
        const dmb_place place =
            p == RIG_BIT ? dmb_station(scene->bit, 0, 0.0) : dmb_station(scene->string, recording->pipe[p], 1.0);
        for (int32_t q = DMB_OUTPUT_DISPLACEMENT_X; q <= DMB_OUTPUT_VELOCITY_Z; ++q) watch(next++, place, q);
    }
    const dmb_place last = dmb_station(scene->string, recording->pipe[RIG_LAST], 1.0);
    const dmb_place feed = dmb_station(scene->feed, 0, 0.0), rotation = dmb_station(scene->rotation, 0, 0.0);
    watch(next++, last, DMB_OUTPUT_KINETIC_ENERGY);
    watch(next++, feed, DMB_OUTPUT_DRIVE_FORCE);
    watch(next++, feed, DMB_OUTPUT_DRIVE_SPEED);
    watch(next++, rotation, DMB_OUTPUT_DRIVE_FORCE);
    watch(next++, rotation, DMB_OUTPUT_DRIVE_SPEED);
    watch(next++, last, DMB_OUTPUT_NORMAL_FORCE);
    watch(next++, dmb_station(scene->bit, 0, 0.0), DMB_OUTPUT_NORMAL_FORCE);
    watch(next++, last, DMB_OUTPUT_ENERGY_ERROR);
}

double rig_samples_a_second(const rig_options *options)
{
    return fmax(options->rate, 1000.0);
}

int32_t rig_recording_open(rig_recording *recording, const rig_options *options, const rig_scene *scene)
{
    const double rows = ceil(options->end * rig_samples_a_second(options)) + 2.0;
    memset(recording, 0, sizeof *recording);
    recording->pipe[RIG_FIRST] = 0;
    recording->pipe[RIG_MIDDLE] = options->pipes > 1 ? options->pipes / 2 - 1 : 0;
    recording->pipe[RIG_LAST] = options->pipes - 1;
    choose_outputs(recording, scene);
    recording->recorder = dmb_recorder_default();
    recording->recorder.outputs = recording->outputs;
    recording->recorder.output_count = RIG_COLUMNS - 1;
    recording->recorder.capacity = (uint64_t)rows;
    recording->recorder.interval = 1.0 / rig_samples_a_second(options);
    recording->recorder.table = calloc((size_t)rows, RIG_COLUMNS * sizeof(double));
    recording->wall_force = calloc((size_t)rows, sizeof(double));
    return recording->recorder.table == NULL || recording->wall_force == NULL ? DMB_ERR_NO_MEMORY : DMB_OK;
}

/* The sum over the wall is no output of the recorder, so it is asked for whenever a row was written. */
int32_t rig_recording_take(rig_recording *recording, const dmb_sim *sim)
{
    const uint64_t before = recording->recorder.row_count;
    dmb_contact_total sum = dmb_contact_total_default();
    int32_t status = dmb_recorder_take(&recording->recorder, sim);
    if (status < 0 || recording->recorder.row_count == before) return status;
    status = dmb_query_contact_total(sim, &sum);
    recording->wall_force[before] = sum.normal_force;
    return status;
}

int32_t rig_recording_write(const rig_recording *recording, const rig_options *options, const char *path)
{
    const uint64_t stride = (uint64_t)(rig_samples_a_second(options) / options->rate);
    dmb_recorder thin = recording->recorder;
    thin.row_count = (recording->recorder.row_count + stride - 1) / stride;
    thin.table = malloc((size_t)thin.row_count * RIG_COLUMNS * sizeof(double));
    if (thin.table == NULL) return DMB_ERR_NO_MEMORY;
    for (uint64_t row = 0; row < thin.row_count; ++row)
        memcpy(thin.table + row * RIG_COLUMNS, recording->recorder.table + row * stride * RIG_COLUMNS,
               RIG_COLUMNS * sizeof(double));
    const int32_t status = dmb_recorder_write_csv(&thin, NULL, path);
    free(thin.table);
    return status;
}

void rig_recording_close(rig_recording *recording)
{
    free(recording->recorder.table);
    free(recording->wall_force);
    recording->recorder.table = NULL;
    recording->wall_force = NULL;
}

static rig_extent extent(const rig_recording *recording, const double *value, size_t stride, double from, double to)
{
    rig_extent found = {HUGE_VAL, -HUGE_VAL, 0.0, 0.0};
    const double *time = recording->recorder.table, slack = 1e-9;
    double count = 0.0;
    for (uint64_t row = 0; row < recording->recorder.row_count; ++row, time += RIG_COLUMNS, value += stride) {
        if (*time < from - slack || *time > to + slack) continue;
        if (count > 0.0) found.jump = fmax(found.jump, fabs(value[0] - value[-(ptrdiff_t)stride]));
        found.low = fmin(found.low, *value);
        found.high = fmax(found.high, *value);
        found.mean += *value;
        count += 1.0;
    }
    if (count > 0.0)
        found.mean /= count;
    else
        found.low = found.high = 0.0;
    return found;
}

rig_extent rig_column_extent(const rig_recording *recording, int column, double from, double to)
{
    return extent(recording, recording->recorder.table + column, RIG_COLUMNS, from, to);
}

rig_extent rig_wall_extent(const rig_recording *recording, double from, double to)
{
    return extent(recording, recording->wall_force, 1, from, to);
}
