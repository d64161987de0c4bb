#include "report.h"

#include <math.h>
#include <stdio.h>

rig_window rig_drilling(const rig_options *options)
{
    const rig_window drilling = {options->cycle.time[1], fmin(options->cycle.time[2], options->end)};
    const rig_window whole = {0.0, options->end};
    return options->end > options->cycle.time[1] ? drilling : whole;
}

void rig_report_scene(const rig_options *options)
{
    const rig_cycle *cycle = &options->cycle;
    printf("Gas drainage rig\n");
    printf("  string    %u pipes of %g m, 73 x 6 mm steel, %u element%s each, bit 5 kg, hole 94 mm\n", options->pipes,
           options->length, options->elements, options->elements == 1 ? "" : "s");
    printf("  drives    rotation %g rpm, feed %g mm/s, load on the bit %g kN\n", RIG_ROTATION_RPM, 1e3 * RIG_FEED,
           1e-3 * RIG_BOTTOM_LOAD);
    printf("  cycle    ");
    for (int i = 0; i < RIG_STAGES; ++i) printf(" %g s %s,", cycle->time[i], rig_stage_name(i));
    printf(" %g s end\n", cycle->time[RIG_STAGES]);
    printf("  computed  up to %g s with steps of %g ms\n", options->end, 1e3 * options->step);
}

/* Rounds to the digits that are printed, so that nothing is shown as -0.00000. */
static double shown(double value)
{
    return round(1e5 * value) / 1e5 + 0.0;
}

/* ---- Motion ------------------------------------------------------------------------------------------------------ */

static double half_range(const rig_extent *extent)
{
    return 0.5 * (extent->high - extent->low);
}

/* Amplitude, mean and jump of one column at the three pipes. The bit moves with the end of the last one. */
static void report_motion(const rig_result *result, const char *name, const char *unit, int column, double end)
{
    rig_extent found[RIG_PIPES];
    for (int p = 0; p < RIG_PIPES; ++p) found[p] = rig_column_extent(&result->recording, column + 6 * p, 0.0, end);
    printf("  %-16s%-14s%-6s", name, "amplitude", unit);
    for (int p = 0; p < RIG_PIPES; ++p) printf("%13.5f", shown(1e3 * half_range(&found[p])));
    printf("\n  %-16s%-14s%-6s", "", "mean", unit);
    for (int p = 0; p < RIG_PIPES; ++p) printf("%13.5f", shown(1e3 * found[p].mean));
    printf("\n  %-16s%-14s%-6s", "", "largest jump", unit);
    for (int p = 0; p < RIG_PIPES; ++p) printf("%13.5f", shown(1e3 * found[p].jump));
    printf("\n");
}

static void report_motions(const rig_options *options, const rig_result *result)
{
    printf("\n  %-36s", "up and down, whole run");
    for (int p = 0; p < RIG_PIPES; ++p) printf("%7s %5u", "pipe", result->recording.pipe[p] + 1);
    printf("\n");
    report_motion(result, "Z displacement", "mm", RIG_DISPLACEMENT_Z, options->end);
    report_motion(result, "Z speed", "mm/s", RIG_VELOCITY_Z, options->end);
}

/* ---- Forces ------------------------------------------------------------------------------------------------------ */

static void report_force(const char *name, const char *unit, double factor, const rig_extent *drilling,
                         const rig_extent *whole)
{
    printf("  %-30s%-6s%13.5f%13.5f%13.5f\n", name, unit, shown(factor * drilling->mean), shown(factor * whole->low),
           shown(factor * whole->high));
}

static void report_column(const rig_options *options, const rig_result *result, const char *name, const char *unit,
                          double factor, int column)
{
    const rig_window window = rig_drilling(options);
    const rig_extent drilling = rig_column_extent(&result->recording, column, window.from, window.to);
    const rig_extent whole = rig_column_extent(&result->recording, column, 0.0, options->end);
    report_force(name, unit, factor, &drilling, &whole);
}

static void report_forces(const rig_options *options, const rig_result *result)
{
    const rig_window window = rig_drilling(options);
    const rig_extent drilling = rig_wall_extent(&result->recording, window.from, window.to);
    const rig_extent whole = rig_wall_extent(&result->recording, 0.0, options->end);
    char name[40];
    printf("\n  %-36s%13s%13s%13s\n", "at the drives and the wall", "mean, drill", "least", "most");
    snprintf(name, sizeof name, "kinetic energy of pipe %u", result->recording.pipe[RIG_LAST] + 1);
    report_column(options, result, name, "J", 1.0, RIG_KINETIC_ENERGY);
    report_column(options, result, "rotation torque", "N m", 1.0, RIG_TORQUE);
    report_column(options, result, "feed force", "kN", 1e-3, RIG_FEED_FORCE);
    report_force("sum of wall forces", "kN", 1e-3, &drilling, &whole);
    printf("  %-30s%-6s%13.5f\n", "weight of the string", "kN", 1e-3 * result->weight);
}

/* ---- Energy and cost --------------------------------------------------------------------------------------------- */

static double stored(const dmb_energy *energy)
{
    return energy->kinetic + energy->strain + energy->gravity + energy->contact;
}

static void report_energy(const rig_result *result)
{
    const dmb_energy *energy = &result->energy;
    const int large = energy->input > 1e3;
    const double factor = large ? 1e-3 : 1.0;
    const struct {
        const char *name;
        double value;
    } rows[] = {
        {"put in by the drives", energy->drives},
        {"put in by the load on the bit", energy->loads},
        {"stored", stored(energy) - stored(&result->energy_at_start)},
        {"taken by friction", energy->friction},
        {"taken by impacts", energy->impact},
        {"taken by damping", energy->damping},
        {"taken by the time scheme", energy->scheme},
        {"unexplained", energy->unexplained},
    };
    printf("\n  %-36s%13s\n", "energy, whole run", large ? "kJ" : "J");
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i)
        printf("  %-36s%13.5f\n", rows[i].name, shown(factor * rows[i].value));
    printf("  %-36s%13.5f %%\n", "error of the balance", 100.0 * energy->error);
}

static void report_cost(const rig_options *options, const rig_result *result)
{
    const dmb_statistics *statistics = &result->statistics;
    const double steps = (double)statistics->steps;
    printf("\n  %-36s%13.0f\n", "steps", steps);
    printf("  %-36s%13.3f\n", "iterations a step", (double)statistics->iterations / steps);
    printf("  %-36s%13u\n", "iterations of the worst step", statistics->most_iterations);
    printf("  %-36s%13.0f\n", "steps rejected", (double)statistics->rejected);
    printf("  %-36s%13.3f s\n", "computing time", result->seconds);
    printf("  %-36s%13.2f simulated seconds a second\n", "real-time factor", options->end / result->seconds);
    printf("  %-36s%13.3f MB\n", "memory", 1e-6 * ((double)result->info.model_bytes + (double)statistics->bytes));
}

static const char *couple_text(const rig_result *result)
{
    static const char *const couples[] = {[RIG_NO_COUPLING] = "no wall",
                                          [RIG_CONTACT] = "contact",
                                          [RIG_FRICTION] = "contact + friction",
                                          [RIG_VIBRATION] = "contact + friction + vibration"};
    return couples[result->variant.couple];
}

void rig_report_variant(const rig_options *options, const rig_result *result)
{
    printf("\n---- %s, %s\n", rig_system_name(&result->variant), couple_text(result));
    printf("  %u degrees_of_freedom, %u elements, %u places of contact; ", result->info.degrees_of_freedom,
           result->info.elements, result->info.contact_points);
    if (options->dropped)
        printf("starts on the axis of the hole\n");
    else
        printf("static start in %u iterations\n", result->start.iterations);
    report_motions(options, result);
    report_forces(options, result);
    report_energy(result);
    report_cost(options, result);
}

/* ---- Answers ----------------------------------------------------------------------------------------------------- */

static void answer_forces(const rig_options *options, const rig_result *result)
{
    const rig_window window = rig_drilling(options);
    const rig_extent feed = rig_column_extent(&result->recording, RIG_FEED_FORCE, 0.0, options->end);
    const rig_extent torque = rig_column_extent(&result->recording, RIG_TORQUE, 0.0, options->end);
    const rig_extent feed_drilling = rig_column_extent(&result->recording, RIG_FEED_FORCE, window.from, window.to);
    const rig_extent torque_drilling = rig_column_extent(&result->recording, RIG_TORQUE, window.from, window.to);
    printf("  thrust at the rig    mean %.3f kN from %g s to %g s, largest %.3f kN\n", shown(1e-3 * feed_drilling.mean),
           window.from, window.to, shown(1e-3 * fmax(feed.high, 0.0)));
    printf("  pull at the rig      largest %.3f kN\n", shown(1e-3 * fmax(-feed.low, 0.0)));
    printf("  torque at the rig    mean %.1f N m from %g s to %g s, largest %.1f N m in either direction\n",
           shown(torque_drilling.mean), window.from, window.to, shown(fmax(torque.high, -torque.low)));
}

static void answer_sag(const rig_options *options, const rig_result *result)
{
    const rig_extent sag =
        rig_column_extent(&result->recording, RIG_DISPLACEMENT_Z + 6 * RIG_MIDDLE, 0.0, options->end);
    printf("  sag of pipe %-3u      mean %.2f mm, vertical motion %.2f mm peak to peak",
           result->recording.pipe[RIG_MIDDLE] + 1, shown(-1e3 * sag.mean), shown(1e3 * (sag.high - sag.low)));
    if (result->variant.couple != RIG_NO_COUPLING)
        printf("; radial clearance of the hole %.2f mm", 500.0 * (rig_wall().diameter - rig_pipe().outer_diameter));
    printf("\n");
}

void rig_report_answers(const rig_options *options, const rig_result *result)
{
    const dmb_energy *energy = &result->energy;
    printf("\nResults: %s pipes, %s\n", rig_system_name(&result->variant), couple_text(result));
    answer_forces(options, result);
    answer_sag(options, result);
    printf("  energy               %.4g kJ put in by the drives, %.4g kJ taken by friction; error of the balance %.2g "
           "%%\n",
           1e-3 * energy->drives, 1e-3 * energy->friction, 100.0 * energy->error);
}
