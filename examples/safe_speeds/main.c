/* Which rotary speeds should be kept away from, and at which depths?
 *
 * usage: safe_speeds [--output FOLDER] [--threads N] [--depth METRES], then plot.py FOLDER for the picture
 *
 * A string of 73 x 6 mm pipes of 1 m lies on the low side of its hole of 94 mm. What shakes it while it turns:
 *     1x  the eccentric masses of the pipes, 1 mm off their axis in directions of their own
 *     2x  a bent pipe or a misaligned head, 300 N sideways at the bit
 *     3x  a bit that walks, 500 N along the hole
 *     4x  the four blades of the bit, 40 N m of torque and 500 N along the hole
 * and what must not be exceeded: forces and moments at the head and behind the bit, as amplitudes. For each depth a
 * sim is put at rest, its bands of speed to avoid and its natural frequencies are found; depths are shared out to
 * threads, which changes no digit. Tables go to FOLDER/bands.csv, severity.csv and modes.csv; plot.py makes the picture
 * of them. */
#include <drillmbd/drillmbd.h>

#include <argp.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#include "../gas_drainage_rig/folder.h"

#define TURN (2.0 * 3.14159265358979323846)
#define RPM (60.0 / TURN) /* [1/min] of 1 rad/s */
#define BLADES 4

enum { DEPTHS = 15, DEPTH_STEP = 10, BANDS = 24, SPEEDS = 271, MODES = 400, ORDERS = 5, LIMITS = 5, THREADS = 64 };

static const char *const order_names[ORDERS] = {"1x eccentric pipes", "2x misalignment", "3x walking bit",
                                                "4x blades, torque", "4x blades, thrust"};
static const char *const limit_names[LIMITS] = {"thrust at head", "torque at head", "sideways at bit", "torque at bit",
                                                "bending at bit"};
static const double limits[LIMITS] = {8000.0, 600.0, 1500.0, 400.0, 500.0}; /* [N, N m] */

/* What is known of one depth. */
typedef struct depth {
    uint32_t pipes;
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, bit;
    int32_t status;
    char message[256];
    dmb_speed_band bands[BANDS];
    uint32_t band_count, mode_count;
    double severity[SPEEDS];
    dmb_mode modes[MODES];
} depth;

/* ---- The scene --------------------------------------------------------------------------------------------------- */

/* Head: it feeds and turns, and holds still while the string is looked at. */
static int32_t add_head(dmb_model *model)
{
    const dmb_term still = dmb_term_default();
    dmb_drive_def drive = dmb_drive_def_default();
    int32_t status = dmb_model_add_programme(model, &still, 1, &drive.programme);
    for (int32_t c = DMB_X; c <= DMB_RX && status >= 0; c += DMB_RX - DMB_X) {
        drive.component = c;
        status = dmb_model_add_drive(model, &drive, NULL);
    }
    return status;
}

static int32_t describe(depth *d)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_bit_def bit = dmb_bit_def_default();
    int32_t status = dmb_model_create(NULL, &d->model);
    pipe.eccentricity = 1e-3;
    pipe.angle_spread = 0.5 * TURN;
    if (status >= 0) status = dmb_model_add_wall(d->model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(d->model, &pipe, d->pipes, &d->string);
    if (status >= 0) status = dmb_model_add_bit(d->model, &bit, &d->bit);
    if (status >= 0) status = add_head(d->model);
    if (status >= 0) status = dmb_model_compile(d->model, NULL);
    if (status >= 0) status = dmb_sim_create(d->model, NULL, &d->sim);
    return status < 0 ? status : dmb_analysis_static(d->sim, NULL, NULL);
}

static dmb_order order_of(double order, int32_t kind, dmb_place place, int32_t component, double amplitude)
{
    dmb_order made = dmb_order_default();
    made.order = order;
    made.input.kind = kind;
    made.input.place = place;
    made.input.component = component;
    made.input.amplitude = amplitude;
    return made;
}

static dmb_output load_of(dmb_place place, int32_t component)
{
    dmb_output made = dmb_output_default();
    made.kind = DMB_OUTPUT_SECTION_FORCE;
    made.place = place;
    made.component = component;
    return made;
}

/* ---- Analyses ---------------------------------------------------------------------------------------------------- */

static int32_t find_bands(depth *d)
{
    const dmb_place bit = dmb_station(d->bit, 0, 0.0), nowhere = dmb_station((dmb_id){0, 0}, 0, 0.0);
    const dmb_place head = dmb_station(d->string, 0, 0.0), last = dmb_station(d->string, d->pipes - 1, 0.0);
    const dmb_order orders[ORDERS] = {
        order_of(1.0, DMB_INPUT_ECCENTRICITY, nowhere, DMB_X, 1.0), order_of(2.0, DMB_INPUT_FORCE, bit, DMB_Y, 300.0),
        order_of(3.0, DMB_INPUT_BIT_LOAD, bit, DMB_X, 500.0), order_of(BLADES, DMB_INPUT_FORCE, bit, DMB_RX, 40.0),
        order_of(BLADES, DMB_INPUT_BIT_LOAD, bit, DMB_X, 500.0)};
    const dmb_output outputs[LIMITS] = {load_of(head, DMB_X), load_of(head, DMB_RX), load_of(last, DMB_Y),
                                        load_of(last, DMB_RX), load_of(last, DMB_RZ)};
    dmb_speeds_options options = dmb_speeds_options_default();
    options.points = SPEEDS;
    options.speed_low = 30.0 / RPM;
    options.speed_high = 300.0 / RPM;
    options.structural_damping = 0.03;
    d->band_count = BANDS;
    for (uint32_t i = 0; i < BANDS; i++) d->bands[i] = dmb_speed_band_default();
    return dmb_analysis_speeds(d->sim, &options, orders, ORDERS, outputs, limits, LIMITS, d->bands, &d->band_count,
                               d->severity);
}

/* Those that four times 300 rpm can reach. */
static int32_t find_modes(depth *d)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes_info info = dmb_modes_info_default();
    dmb_modes *modes = NULL;
    options.select = DMB_MODES_BAND;
    options.band[1] = BLADES * 300.0 / 60.0;
    options.friction = 0;
    int32_t status = dmb_analysis_modes(d->sim, &options, &modes);
    if (status >= 0) status = dmb_modes_get_info(modes, &info);
    d->mode_count = info.count < MODES ? info.count : MODES;
    for (uint32_t i = 0; i < d->mode_count && status >= 0; i++) {
        d->modes[i] = dmb_mode_default();
        status = dmb_modes_get(modes, i, d->modes + i);
    }
    dmb_modes_destroy(&modes);
    return status;
}

static void look_at(depth *d)
{
    d->status = describe(d);
    if (d->status >= 0) d->status = find_bands(d);
    if (d->status >= 0) d->status = find_modes(d);
    if (d->status < 0)
        (void)snprintf(d->message, sizeof d->message, "%s",
                       d->sim ? dmb_sim_message(d->sim) : dmb_model_message(d->model));
    dmb_sim_destroy(&d->sim);
    dmb_model_destroy(&d->model);
}

/* ---- Threads ----------------------------------------------------------------------------------------------------- */

typedef struct worker {
    depth *depths;
    int first, step, count;
} worker;

static void *work(void *context)
{
    const worker *w = context;
    for (int i = w->first; i < w->count; i += w->step) look_at(w->depths + i);
    return NULL;
}

static void share_out(depth *depths, int count, int threads)
{
    pthread_t started[THREADS];
    worker workers[THREADS];
    int running = 0;
    for (int i = 0; i < threads; i++) {
        workers[i] = (worker){depths, i, threads, count};
        if (pthread_create(started + running, NULL, work, workers + i) == 0)
            running++;
        else
            (void)work(workers + i);
    }
    for (int i = 0; i < running; i++) (void)pthread_join(started[i], NULL);
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
}

static FILE *open_table(const char *folder, const char *name, const char *head)
{
    char path[4096];
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (file != NULL) fprintf(file, "%s\n", head);
    return file;
}

static const char *kind_of(const dmb_mode *mode)
{
    static const char *const kinds[3] = {"axial", "torsional", "lateral"};
    int most = 0;
    for (int k = 1; k < 3; k++)
        if (mode->share[k] > mode->share[most]) most = k;
    return kinds[most];
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
                    depths[i].modes[k].damping, kind_of(depths[i].modes + k));
    return fclose(file) != 0;
}

static int write_severity(const char *folder, const depth *depths, int count)
{
    FILE *file = open_table(folder, "severity.csv", "depth [m],speed [rpm],severity");
    if (file == NULL) return 1;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < SPEEDS; k++)
            fprintf(file, "%u,%.3f,%.5g\n", (unsigned)depths[i].pipes, 30.0 + 270.0 * k / (SPEEDS - 1),
                    depths[i].severity[k]);
    return fclose(file) != 0;
}

/* ---- Main -------------------------------------------------------------------------------------------------------- */

typedef struct options {
    const char *folder; /* NULL: no tables */
    int threads, depth; /* depth 0: every DEPTH_STEP metres */
} options;

enum { KEY_THREADS = 256, KEY_DEPTH };

static int whole_number(const struct argp_state *state, const char *word, long low, long high)
{
    char *rest = NULL;
    const long value = strtol(word, &rest, 10);
    if (rest == word || *rest != '\0' || value < low || value > high)
        argp_error(state, "'%s' is not a whole number from %ld to %ld", word, low, high);
    return (int)value;
}

static error_t take_option(int key, char *word, struct argp_state *state)
{
    options *asked = state->input;
    switch (key) {
    case 'o': asked->folder = word; return 0;
    case KEY_THREADS: asked->threads = whole_number(state, word, 1, THREADS); return 0;
    case KEY_DEPTH: asked->depth = whole_number(state, word, 1, 1000); return 0;
    case ARGP_KEY_ARG: argp_error(state, "'%s' is not an option", word); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static options read_options(int count, char **words)
{
    static const struct argp_option table[] = {
        {"output", 'o', "FOLDER", 0, "folder for tables; plot.py FOLDER makes the picture of them", 0},
        {"threads", KEY_THREADS, "N", 0, "depths at a time (2), which changes no digit", 0},
        {"depth", KEY_DEPTH, "METRES", 0, "one depth; otherwise every 10 m down to 150 m", 0},
        {0, 0, 0, 0, 0, 0}};
    static const char about[] = "Which rotary speeds should be kept away from, and at which depths?";
    const struct argp parser = {table, take_option, NULL, about, NULL, NULL, NULL};
    options asked = {NULL, 2, 0};
    argp_parse(&parser, count, words, 0, NULL, &asked);
    return asked;
}

int main(int count, char **words)
{
    static depth depths[DEPTHS];
    const options asked = read_options(count, words);
    const char *folder = asked.folder;
    const int found = asked.depth > 0 ? 1 : DEPTHS;
    int failed = 0;
    if (folder != NULL && rig_make_folder(folder) != 0) return perror(folder), EXIT_FAILURE;
    for (int i = 0; i < DEPTHS; i++) depths[i].pipes = (uint32_t)((i + 1) * DEPTH_STEP);
    if (asked.depth > 0) depths[0].pipes = (uint32_t)asked.depth;
    share_out(depths, found, asked.threads);
    printf("Speeds to avoid (severity above 1: a limit is exceeded)\n");
    for (int i = 0; i < found; i++) {
        if (depths[i].status < 0)
            printf("%4u m: %s: %s\n", (unsigned)depths[i].pipes, dmb_status_name(depths[i].status), depths[i].message);
        else
            print_depth(depths + i);
        failed |= depths[i].status < 0;
    }
    if (folder != NULL)
        failed |= write_bands(folder, depths, found) | write_modes(folder, depths, found) |
                  write_severity(folder, depths, found);
    return failed;
}
