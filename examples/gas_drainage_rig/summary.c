#include <stdio.h>

#include "report.h"

static void write_extent(FILE *file, const char *name, const rig_extent *extent)
{
    fprintf(file, ",\n     \"%s\": {\"least\": %.9g, \"most\": %.9g, \"mean\": %.9g, \"jump\": %.9g}", name,
            extent->low, extent->high, extent->mean, extent->jump);
}

static void write_columns(FILE *file, const rig_options *options, const rig_result *result)
{
    static const struct {
        const char *name;
        int column;
    } drilling[] = {{"kinetic_energy_last_pipe", RIG_KINETIC_ENERGY},
                    {"feed_force", RIG_FEED_FORCE},
                    {"rotation_torque", RIG_TORQUE}};
    static const char *const places[RIG_PLACES] = {"first_pipe", "middle_pipe", "last_pipe", "bit"};
    const rig_window window = rig_drilling(options);
    for (size_t i = 0; i < sizeof drilling / sizeof drilling[0]; ++i) {
        const rig_extent extent = rig_column_extent(&result->recording, drilling[i].column, window.from, window.to);
        write_extent(file, drilling[i].name, &extent);
    }
    const rig_extent wall = rig_wall_extent(&result->recording, window.from, window.to);
    write_extent(file, "wall_force", &wall);
    for (int p = 0; p < RIG_PLACES; ++p) {
        char name[40];
        rig_extent extent = rig_column_extent(&result->recording, RIG_DISPLACEMENT_Z + 6 * p, 0.0, options->end);
        snprintf(name, sizeof name, "z_displacement_%s", places[p]);
        write_extent(file, name, &extent);
        extent = rig_column_extent(&result->recording, RIG_VELOCITY_Z + 6 * p, 0.0, options->end);
        snprintf(name, sizeof name, "z_speed_%s", places[p]);
        write_extent(file, name, &extent);
    }
}

static void write_energy(FILE *file, const rig_result *result)
{
    const dmb_energy *e = &result->energy;
    fprintf(file,
            ",\n     \"energy\": {\"drives\": %.9g, \"loads\": %.9g, \"friction\": %.9g, \"impact\": %.9g, "
            "\"damping\": %.9g, \"scheme\": %.9g, \"unexplained\": %.9g, \"error\": %.9g}",
            e->drives, e->loads, e->friction, e->impact, e->damping, e->scheme, e->unexplained, e->error);
}

static void write_variant(FILE *file, const rig_options *options, const rig_result *result)
{
    const uint32_t *pipe = result->recording.pipe;
    const dmb_statistics *statistics = &result->statistics;
    fprintf(file, "    {\"name\": \"%s\", \"system\": \"%s\", \"couple\": \"%s\", \"table\": \"%s.csv\",\n",
            result->name, rig_system_name(&result->variant), rig_couple_name(&result->variant), result->name);
    fprintf(file, "     \"pipes\": [%u, %u, %u], \"degrees_of_freedom\": %u, \"weight\": %.9g,\n", pipe[0] + 1,
            pipe[1] + 1, pipe[2] + 1, result->info.degrees_of_freedom, result->weight);
    fprintf(file, "     \"steps\": %.0f, \"iterations\": %.0f, \"rejected\": %.0f, \"seconds\": %.6g, \"bytes\": %.0f",
            (double)statistics->steps, (double)statistics->iterations, (double)statistics->rejected, result->seconds,
            (double)result->info.model_bytes + (double)statistics->bytes);
    write_columns(file, options, result);
    write_energy(file, result);
    fprintf(file, "}");
}

int rig_write_summary(const rig_options *options, const rig_result *results, int count)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/summary.json", options->output);
    FILE *file = fopen(path, "w");
    if (file == NULL) {
        perror(path);
        return -1;
    }
    fprintf(file, "{\n  \"pipes\": %u, \"pipe_length\": %.9g, \"step\": %.9g, \"end\": %.9g,\n  \"stages\": [",
            options->pipes, options->length, options->step, options->end);
    for (int i = 0; i < RIG_STAGES; ++i)
        fprintf(file, "%s{\"name\": \"%s\", \"from\": %g, \"to\": %g}", i > 0 ? ", " : "", rig_stage_name(i),
                options->cycle.time[i], options->cycle.time[i + 1]);
    fprintf(file, "],\n  \"variants\": [\n");
    for (int i = 0; i < count; ++i) {
        write_variant(file, options, &results[i]);
        fprintf(file, i + 1 < count ? ",\n" : "\n");
    }
    fprintf(file, "  ]\n}\n");
    if (fclose(file) == 0) return 0;
    perror(path);
    return -1;
}
