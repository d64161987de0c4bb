/* Which rotary speeds should be kept away from, and at which depths?
 *
 * usage: safe_speeds [--output FOLDER] [--threads N] [--depth METRES] [--order NUMBER], then plot.py FOLDER
 *
 * A string of 73 x 6 mm pipes of 1 m lies on the low side of its hole of 94 mm. Causes of vibration while it turns:
 *     1x  the eccentric masses of the pipes, 1 mm off their axis in directions of their own
 *     2x  a bent pipe or a misaligned head, 300 N sideways at the bit
 *     3x  a bit that walks, 500 N along the hole
 *     4x  the four blades of the bit, 40 N m of torque and 500 N along the hole
 *     and, where --order asks for it, 500 N along the hole at any other number times the speed
 * and what must not be exceeded: forces and moments at the head and behind the bit, as amplitudes. For each depth a
 * sim is put at rest, its bands of speed to avoid and its natural frequencies are found; then, at one depth, natural
 * frequencies while the string turns (campbell.c). Depths and speeds are shared out to threads, which changes no digit.
 * Tables go to FOLDER/bands.csv, severity.csv, modes.csv, orders.csv and campbell.csv; plot.py makes the picture. */
#include <drillmbd/drillmbd.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../command_line.h"
#include "../gas_drainage_rig/folder.h"
#include "../share_out.h"
#include "campbell.h"
#include "scene.h"
#include "tables.h"

#define BLADES 4
#define CAMPBELL_DEPTH 100 /* [m] unless one depth is asked for */

enum { DEPTHS = 15, DEPTH_STEP = 10, BANDS = 24, SPEEDS = 271, ORDERS = 6, LIMITS = 5 };

static char given_name[32]; /* of the last order, where one is asked for */
static const char *const order_names[ORDERS] = {"1x eccentric pipes", "2x misalignment",   "3x walking bit",
                                                "4x blades, torque",  "4x blades, thrust", given_name};
static const char *const limit_names[LIMITS] = {"thrust at head", "torque at head", "sideways at bit", "torque at bit",
                                                "bending at bit"};
static const double limits[LIMITS] = {8000.0, 600.0, 1500.0, 400.0, 500.0}; /* [N, N m] */

/* Results at one depth. */
typedef struct depth {
    uint32_t pipes;
    double given_order; /* 0: none */
    speeds_scene scene;
    int32_t status;
    char message[256];
    dmb_speed_band bands[BANDS];
    uint32_t band_count, mode_count;
    int more_bands; /* than there is room for */
    double severity[SPEEDS];
    dmb_mode *modes;
} depth;

/* ---- Analyses ---------------------------------------------------------------------------------------------------- */

static dmb_order order_of(double order, int32_t kind, dmb_place place, int32_t component, double amplitude)
{
    dmb_order made = dmb_order_default();
    made.order = order;
    made.excitation.kind = kind;
    made.excitation.place = place;
    made.excitation.component = component;
    made.excitation.amplitude = amplitude;
    return made;
}

static dmb_output load_of(dmb_place place, int32_t component)
{
    dmb_output made = {.quantity = DMB_OUTPUT_SECTION_FORCE};
    made.place = place;
    made.quantity += component;
    return made;
}

static int32_t find_bands(depth *d)
{
    const dmb_place bit = dmb_station(d->scene.bit, 0, 0.0), nowhere = dmb_station((dmb_id){0, 0}, 0, 0.0);
    const dmb_place head = dmb_station(d->scene.string, 0, 0.0);
    const dmb_place last = dmb_station(d->scene.string, d->pipes - 1, 0.0);
    const dmb_order orders[ORDERS] = {order_of(1.0, DMB_EXCITATION_ECCENTRICITY, nowhere, DMB_X, 1.0),
                                      order_of(2.0, DMB_EXCITATION_FORCE, bit, DMB_Y, 300.0),
                                      order_of(3.0, DMB_EXCITATION_BIT_LOAD, bit, DMB_X, 500.0),
                                      order_of(BLADES, DMB_EXCITATION_FORCE, bit, DMB_RX, 40.0),
                                      order_of(BLADES, DMB_EXCITATION_BIT_LOAD, bit, DMB_X, 500.0),
                                      order_of(d->given_order, DMB_EXCITATION_BIT_LOAD, bit, DMB_X, 500.0)};
    const dmb_output outputs[LIMITS] = {load_of(head, DMB_X), load_of(head, DMB_RX), load_of(last, DMB_Y),
                                        load_of(last, DMB_RX), load_of(last, DMB_RZ)};
    dmb_speeds_options options = dmb_speeds_options_default();
    options.points = SPEEDS;
    options.speed_low = LOW_RPM / RPM;
    options.speed_high = HIGH_RPM / RPM;
    options.structural_damping = 0.03;
    d->band_count = BANDS;
    for (uint32_t i = 0; i < BANDS; i++) d->bands[i] = dmb_speed_band_default();
    const int32_t status =
        dmb_analysis_speeds(d->scene.sim, &options, orders, d->given_order > 0.0 ? ORDERS : ORDERS - 1, outputs, limits,
                            LIMITS, d->bands, &d->band_count, d->severity);
    d->more_bands = status == DMB_NOTE_FULL;
    return status;
}

/* [Hz] that orders of the speed can reach. */
static double highest_frequency(double given_order)
{
    return fmax(BLADES, given_order) * HIGH_RPM / 60.0;
}

static int32_t find_modes(depth *d)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes_info info = dmb_modes_info_default();
    dmb_modes *modes = NULL;
    options.select = DMB_MODES_BAND;
    options.band[1] = highest_frequency(d->given_order);
    options.friction = 0;
    int32_t status = dmb_analysis_modes(d->scene.sim, &options, &modes);
    if (status >= 0) status = dmb_modes_get_info(modes, &info);
    if (status >= 0) d->modes = calloc((size_t)info.count + 1, sizeof *d->modes);
    if (status >= 0 && d->modes == NULL) status = DMB_ERR_NO_MEMORY;
    for (uint32_t i = 0; i < info.count && status >= 0; i++) {
        d->modes[i] = dmb_mode_default();
        status = dmb_modes_get(modes, i, d->modes + i);
        d->mode_count += status >= 0;
    }
    dmb_modes_destroy(&modes);
    return status;
}

static void look_at(void *depths, int number)
{
    depth *d = (depth *)depths + number;
    d->status = speeds_scene_make(d->pipes, 1e-3, 0.0, &d->scene);
    if (d->status >= 0) d->status = find_bands(d);
    if (d->status >= 0) d->status = find_modes(d);
    if (d->status < 0) (void)snprintf(d->message, sizeof d->message, "%s", speeds_scene_message(&d->scene));
    speeds_scene_free(&d->scene);
}

static void look_while_turning(void *speeds, int number)
{
    campbell_find((campbell *)speeds + number);
}

/* ---- Report ------------------------------------------------------------------------------------------------------ */

static void print_depth(const depth *d)
{
    printf("%4u m", (unsigned)d->pipes);
    if (d->band_count == 0) printf("   every speed is fine");
    printf("\n");
    for (uint32_t i = 0; i < d->band_count; i++) {
        const dmb_speed_band *b = d->bands + i;
        printf("    %6.1f to %6.1f rpm   worst %5.1f   severity %6.2f   %s: %s\n", b->low * RPM, b->high * RPM,
               b->speed * RPM, b->severity, order_names[b->order], limit_names[b->output]);
    }
    if (d->more_bands) printf("    and more than the first %d that are told here\n", BANDS);
}

static int write_bands(const char *folder, const depth *depths, int count)
{
    FILE *file = open_table(folder, "bands.csv", "depth [m],low [rpm],high [rpm],worst [rpm],severity,order,limit");
    if (file == NULL) return 1;
    for (int i = 0; i < count; i++)
        for (uint32_t k = 0; k < depths[i].band_count; k++) {
            const dmb_speed_band *b = depths[i].bands + k;
            fprintf(file, "%u,%.3f,%.3f,%.3f,%.5g,\"%s\",\"%s\"\n", (unsigned)depths[i].pipes, b->low * RPM,
                    b->high * RPM, b->speed * RPM, b->severity, order_names[b->order], limit_names[b->output]);
        }
    return fclose(file) != 0;
}

static int write_modes(const char *folder, const depth *depths, int count)
{
    FILE *file = open_table(folder, "modes.csv", "depth [m],frequency [Hz],damping,kind");
    if (file == NULL) return 1;
    for (int i = 0; i < count; i++)
        for (uint32_t k = 0; k < depths[i].mode_count; k++)
            fprintf(file, "%u,%.6g,%.4g,%s\n", (unsigned)depths[i].pipes, depths[i].modes[k].frequency,
                    depths[i].modes[k].damping, kind_names[kind_of(depths[i].modes + k)]);
    return fclose(file) != 0;
}

static int write_orders(const char *folder, double given)
{
    FILE *file = open_table(folder, "orders.csv", "order,name");
    if (file == NULL) return 1;
    fprintf(file, "1,eccentric pipes\n2,misalignment\n3,walking bit\n%d,blades\n", BLADES);
    if (given > 0.0) fprintf(file, "%.9g,given\n", given);
    return fclose(file) != 0;
}

static int write_severity(const char *folder, const depth *depths, int count)
{
    FILE *file = open_table(folder, "severity.csv", "depth [m],speed [rpm],severity");
    if (file == NULL) return 1;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < SPEEDS; k++)
            fprintf(file, "%u,%.3f,%.5g\n", (unsigned)depths[i].pipes,
                    LOW_RPM + (HIGH_RPM - LOW_RPM) * k / (SPEEDS - 1), depths[i].severity[k]);
    return fclose(file) != 0;
}

/* ---- Main -------------------------------------------------------------------------------------------------------- */

typedef struct options {
    const char *folder; /* NULL: no tables */
    int threads, depth; /* depth 0: every DEPTH_STEP metres */
    double order;       /* 0: none but those of the table above */
} options;

static options read_options(int count, char **words)
{
    options asked = {NULL, 2, 0, 0.0};
    uint32_t threads = 2, metres = 0;
    const command_option table[] = {
        {.name = "output",
         .letter = 'o',
         .value = "FOLDER",
         .help = "folder for tables; plot.py FOLDER makes the picture of them",
         .text = &asked.folder},
        {.name = "threads",
         .value = "N",
         .help = "depths at a time (2), which changes no digit",
         .low = 1.0,
         .high = THREADS,
         .whole = &threads},
        {.name = "depth",
         .value = "METRES",
         .help = "one depth; otherwise every 10 m down to 150 m",
         .low = 1.0,
         .high = 1000.0,
         .whole = &metres},
        {.name = "order",
         .value = "NUMBER",
         .low = 0.1,
         .high = 20.0,
         .number = &asked.order,
         .help = "an excitation along the hole at this many times the speed, besides the others"}};
    const int stop = command_line(count, words, "Which rotary speeds should be kept away from, and at which depths?",
                                  table, sizeof table / sizeof *table);
    if (stop >= 0) exit(stop);
    asked.threads = (int)threads;
    asked.depth = (int)metres;
    return asked;
}

static int print_bands(const depth *depths, int count)
{
    int failed = 0;
    printf("Speeds to avoid (severity above 1: a limit is exceeded)\n");
    for (int i = 0; i < count; i++) {
        if (depths[i].status < 0)
            printf("%4u m: %s: %s\n", (unsigned)depths[i].pipes, dmb_status_name(depths[i].status), depths[i].message);
        else
            print_depth(depths + i);
        failed |= depths[i].status < 0;
    }
    return failed;
}

static void prepare(const options *asked, depth *depths, campbell *turning)
{
    const int there = asked->depth > 0 ? asked->depth : CAMPBELL_DEPTH;
    for (int i = 0; i < DEPTHS; i++) {
        depths[i].pipes = (uint32_t)((i + 1) * DEPTH_STEP);
        depths[i].given_order = asked->order;
    }
    if (asked->depth > 0) depths[0].pipes = (uint32_t)asked->depth;
    for (int i = 0; i < CAMPBELL_SPEEDS; i++)
        campbell_prepare(turning + i, (uint32_t)there, i, highest_frequency(asked->order));
    if (asked->order > 0.0) (void)snprintf(given_name, sizeof given_name, "%gx given", asked->order);
}

int main(int count, char **words)
{
    static depth depths[DEPTHS];
    static campbell turning[CAMPBELL_SPEEDS];
    const options asked = read_options(count, words);
    const int found = asked.depth > 0 ? 1 : DEPTHS;
    if (asked.folder != NULL && rig_make_folder(asked.folder) != 0) return perror(asked.folder), EXIT_FAILURE;
    prepare(&asked, depths, turning);
    share_out(look_at, depths, found, asked.threads);
    share_out(look_while_turning, turning, CAMPBELL_SPEEDS, asked.threads);
    int failed = print_bands(depths, found);
    campbell_print(turning);
    for (int i = 0; i < CAMPBELL_SPEEDS; i++) failed |= turning[i].status < 0;
    if (asked.folder != NULL)
        failed |= write_bands(asked.folder, depths, found) | write_modes(asked.folder, depths, found) |
                  write_severity(asked.folder, depths, found) | write_orders(asked.folder, asked.order) |
                  campbell_write(asked.folder, turning);
    for (int i = 0; i < DEPTHS; i++) free(depths[i].modes);
    for (int i = 0; i < CAMPBELL_SPEEDS; i++) free(turning[i].modes);
    return failed;
}
