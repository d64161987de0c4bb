#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "study.h"

#define LOW 0.1    /* [Hz] */
#define HIGH 100.0 /* [Hz] */
#define ALIGNED_HIGH 20.0

enum { POINTS = 400, REFINEMENT = 6, ALIGNED_POINTS = 100, INPUTS = 5 };
/* The cause that an input is part of. */
static const int cause_of[INPUTS] = {STUDY_DRIVE, STUDY_DRIVE, STUDY_FRICTION, STUDY_ECCENTRIC, STUDY_ALONG};

/* Whole friction, or only what it differs by between rest and sliding; eccentricities that are usual. */
const double study_case_friction[STUDY_CASES] = {0.30, 0.30, 0.30, 0.05, 0.05, 0.05};         /* [-] */
const double study_case_eccentricity[STUDY_CASES] = {0.5e-3, 1e-3, 2e-3, 0.5e-3, 1e-3, 2e-3}; /* [m] */

/* ---- Amplitudes -------------------------------------------------------------------------------------------------- */

/* The drives shake by a part of their speeds, the wall rubs around the string by the whole friction of sliding, the
 * eccentric masses turn. */
static void set_inputs(const study_string *s, const study_scene *scene, dmb_excitation inputs[INPUTS])
{
    for (int i = 0; i < INPUTS; ++i) inputs[i] = dmb_excitation_default();
    for (int i = 0; i < 2; ++i) {
        inputs[i].kind = DMB_EXCITATION_DRIVE;
        inputs[i].place.part = s->drive[i];
    }
    inputs[0].amplitude = RIG_SHAKE * RIG_FEED;
    inputs[1].amplitude = RIG_SHAKE * STUDY_ROTATION;
    inputs[2].kind = DMB_EXCITATION_FRICTION;
    inputs[2].component = DMB_RX;
    inputs[2].amplitude = scene->wall.mu_dynamic;
    inputs[3].kind = DMB_EXCITATION_ECCENTRICITY;
    inputs[4] = inputs[2];
    inputs[4].component = DMB_X;
}

static int part_of(uint32_t input, int cause)
{
    return cause_of[input] == cause || (cause == STUDY_TOGETHER && cause_of[input] != STUDY_ALONG);
}

/* Amplitudes along one axis, |sum of amplitude times transfer| over the inputs of each cause. */
static int32_t take_axis(const dmb_response *response, uint32_t axis, const dmb_excitation inputs[INPUTS],
                         study_response *r, double *values, double *sums)
{
    const size_t values_count = 2 * (size_t)r->points; /* real and imaginary parts */
    for (int cause = 0; cause < STUDY_CAUSES; ++cause) {
        for (size_t k = 0; k < values_count; ++k) sums[k] = 0.0;
        for (uint32_t i = 0; i < INPUTS; ++i) {
            if (!part_of(i, cause)) continue;
            const int32_t status = dmb_response_transfer(response, i, axis, values);
            if (status < 0) return status;
            for (size_t k = 0; k < values_count; ++k) sums[k] += inputs[i].amplitude * values[k];
        }
        for (size_t k = 0; k < r->points; ++k)
            r->axis[axis][k * STUDY_CAUSES + (size_t)cause] =
                sqrt(sums[2 * k] * sums[2 * k] + sums[2 * k + 1] * sums[2 * k + 1]);
    }
    return DMB_OK;
}

static void add_axes(study_response *r)
{
    for (size_t k = 0; k < (size_t)r->points * STUDY_CAUSES; ++k) {
        double sum = 0.0;
        for (int axis = 0; axis < STUDY_AXES; ++axis) sum += r->axis[axis][k] * r->axis[axis][k];
        r->amplitude[k] = sqrt(sum);
    }
}

/* Room for `points` frequencies. */
static int32_t make_room(study_response *r, uint32_t points)
{
    const size_t values = (size_t)points * STUDY_CAUSES;
    r->points = points;
    r->friction = STUDY_FRICTION;
    r->frequency = calloc(points, sizeof *r->frequency);
    r->amplitude = calloc(values, sizeof *r->amplitude);
    int room = r->frequency != NULL && r->amplitude != NULL;
    for (int axis = 0; axis < STUDY_AXES; ++axis) {
        r->axis[axis] = calloc(values, sizeof *r->axis[axis]);
        room &= r->axis[axis] != NULL;
    }
    return room ? DMB_OK : DMB_ERR_NO_MEMORY;
}

static int32_t take(const dmb_response *response, const dmb_excitation inputs[INPUTS], study_response *r)
{
    uint32_t shape[3] = {0, 0, 0};
    int32_t status = dmb_response_dimensions(response, shape);
    if (status < 0) return status;
    status = make_room(r, shape[0]);
    double *work = calloc(4 * (size_t)shape[0], sizeof *work);
    if (work == NULL) status = DMB_ERR_NO_MEMORY;
    if (status >= 0) status = dmb_response_frequencies(response, r->frequency);
    for (uint32_t axis = 0; axis < STUDY_AXES && status >= 0; ++axis)
        status = take_axis(response, axis, inputs, r, work, work + 2 * (size_t)r->points);
    if (status >= 0) add_axes(r);
    free(work);
    return status;
}

int32_t study_respond(study_string *s, const study_scene *scene, double low, double high, uint32_t points,
                      uint32_t refinement, study_response *r)
{
    dmb_response_options options = dmb_response_options_default();
    dmb_excitation inputs[INPUTS];
    dmb_output outputs[STUDY_AXES];
    dmb_response *response = NULL;
    set_inputs(s, scene, inputs);
    for (int32_t axis = 0; axis < STUDY_AXES; ++axis) {
        outputs[axis] = (dmb_output){.quantity = DMB_OUTPUT_VIBRATION};
        outputs[axis].place = dmb_station(s->string, scene->pipes - 1, 0.5);
        outputs[axis].quantity += axis;
    }
    options.points = points;
    options.frequency_low = low;
    options.frequency_high = high;
    options.logarithmic = 1;
    options.refinement = refinement;
    options.structural_damping = STUDY_LOSS;
    options.friction = 0; /* a string that turns slides already, and sliding has next to no slope */
    int32_t status = dmb_analysis_response(s->sim, &options, inputs, INPUTS, outputs, STUDY_AXES, &response);
    if (status >= 0) status = take(response, inputs, r);
    dmb_response_destroy(&response);
    return status;
}

void study_response_free(study_response *r)
{
    free(r->frequency);
    free(r->amplitude);
    r->frequency = r->amplitude = NULL;
    for (int axis = 0; axis < STUDY_AXES; ++axis) {
        free(r->axis[axis]);
        r->axis[axis] = NULL;
    }
    r->points = 0;
}

study_response study_response_view(const study_response *r, int axis, int32_t friction)
{
    study_response view = *r;
    if (axis < STUDY_AXES) view.amplitude = r->axis[axis];
    view.friction = friction;
    return view;
}

/* ---- Which is stronger ------------------------------------------------------------------------------------------- */

/* Logarithm of friction over eccentricity at a point: > 0 where friction is stronger. */
static double log_ratio(const study_response *r, uint32_t k)
{
    const double *a = r->amplitude + (size_t)k * STUDY_CAUSES;
    return log(a[r->friction] / a[STUDY_ECCENTRIC]);
}

/* Logarithm of the frequency between k - 1 and k at which a straight line through their ratios reaches zero. */
static double crossing(const study_response *r, uint32_t k, double before, double after)
{
    const double from = log(r->frequency[k - 1]), to = log(r->frequency[k]);
    return from + (to - from) * before / (before - after);
}

void study_crossover(const study_response *r, double friction, double eccentric, double found[2])
{
    const double shift = log(friction / eccentric);
    double before = log_ratio(r, 0) + shift;
    found[0] = found[1] = (double)NAN;
    for (uint32_t k = 1; k < r->points; ++k) {
        const double after = log_ratio(r, k) + shift;
        if (before > 0.0 && after <= 0.0) {
            found[1] = exp(crossing(r, k, before, after));
            if (isnan(found[0])) found[0] = found[1];
        }
        before = after;
    }
}

uint32_t study_peak(const study_response *r, int cause)
{
    uint32_t most = 0;
    for (uint32_t k = 1; k < r->points; ++k)
        if (r->amplitude[(size_t)k * STUDY_CAUSES + (size_t)cause] >
            r->amplitude[(size_t)most * STUDY_CAUSES + (size_t)cause])
            most = k;
    return most;
}

double study_amplitude_at(const study_response *r, int cause, double frequency)
{
    uint32_t k = 1;
    while (k + 1 < r->points && r->frequency[k] < frequency) k++;
    const double from = log(r->frequency[k - 1]), to = log(r->frequency[k]);
    const double before = log(r->amplitude[(size_t)(k - 1) * STUDY_CAUSES + (size_t)cause]);
    const double after = log(r->amplitude[(size_t)k * STUDY_CAUSES + (size_t)cause]);
    return exp(before + (after - before) * (log(frequency) - from) / (to - from));
}

double study_ratio_at(const study_response *r, double frequency)
{
    return study_amplitude_at(r, r->friction, frequency) / study_amplitude_at(r, STUDY_ECCENTRIC, frequency);
}

double study_eccentric_share(const study_response *r, double low, double high)
{
    double stronger = 0.0, whole = 0.0;
    for (uint32_t k = 1; k < r->points; ++k) {
        if (r->frequency[k - 1] < low || r->frequency[k] > high) continue;
        const double width = log(r->frequency[k] / r->frequency[k - 1]);
        whole += width;
        if (log_ratio(r, k - 1) + log_ratio(r, k) < 0.0) stronger += width;
    }
    return stronger / whole;
}

/* ---- The last of a hundred pipes --------------------------------------------------------------------------------- */

static int32_t shake(study_shaken *shaken, study_string *s)
{
    const study_scene scene = study_base();
    int32_t status = study_make(&scene, s);
    if (status >= 0) status = study_respond(s, &scene, LOW, HIGH, POINTS, REFINEMENT, &shaken->response);
    for (int i = 0; i < STUDY_CASES && status >= 0; ++i)
        study_crossover(&shaken->response, study_case_friction[i] / scene.wall.mu_dynamic,
                        study_case_eccentricity[i] / scene.pipe.eccentricity, shaken->crossover[i]);
    return status;
}

static int32_t shake_aligned(study_shaken *shaken, study_string *s)
{
    study_scene scene = study_base();
    scene.pipe.angle_spread = 0.0;
    const int32_t status = study_make(&scene, s);
    return status < 0 ? status : study_respond(s, &scene, LOW, ALIGNED_HIGH, ALIGNED_POINTS, 0, &shaken->aligned);
}

void study_shaken_work(void *context)
{
    static int32_t (*const shakes[])(study_shaken *, study_string *) = {shake, shake_aligned};
    study_shaken *shaken = context;
    for (size_t i = 0; i < sizeof shakes / sizeof shakes[0] && shaken->status >= 0; ++i) {
        study_string s = {0};
        shaken->status = shakes[i](shaken, &s);
        if (shaken->status < 0) (void)snprintf(shaken->message, sizeof shaken->message, "%s", study_message(&s));
        study_free(&s);
    }
}

static const char *const axis_names[STUDY_AXES + 1] = {"X", "Y", "Z", "all"};

static void print_amplitudes(const study_response *r)
{
    static const double asked[] = {0.1, 0.5, 1.0, STUDY_REFERENCE_CROSSOVER, 3.0, 4.9, 10.0, 30.0, 100.0};
    printf("  %4s %9s %13s %13s %13s %13s %13s   mm\n", "axis", "Hz", "drives", "friction", "eccentricity", "all three",
           "along");
    for (int axis = 0; axis <= STUDY_AXES; ++axis) {
        const study_response view = study_response_view(r, axis, STUDY_FRICTION);
        for (size_t i = 0; i < sizeof asked / sizeof asked[0]; ++i) {
            printf("  %4s %9.4f", axis_names[axis], asked[i]);
            for (int cause = 0; cause < STUDY_CAUSES; ++cause)
                printf(" %13.5e", 1e3 * study_amplitude_at(&view, cause, asked[i]));
            printf("\n");
        }
    }
}

/* The first and the last frequency at which friction falls below eccentricity, by axis. */
static void print_crossings(const study_response *r)
{
    static const char *const ways[] = {"around", "along"};
    static const int32_t frictions[] = {STUDY_FRICTION, STUDY_ALONG};
    printf("  friction over eccentricity by axis\n");
    for (int axis = 0; axis <= STUDY_AXES; ++axis)
        for (int way = 0; way < 2; ++way) {
            const study_response view = study_response_view(r, axis, frictions[way]);
            double found[2];
            study_crossover(&view, 1.0, 1.0, found);
            printf("    %-3s friction %-6s at 0.1 Hz %10.3e, at 1.58 Hz %10.3e; ", axis_names[axis], ways[way],
                   study_ratio_at(&view, LOW), study_ratio_at(&view, STUDY_REFERENCE_CROSSOVER));
            if (isnan(found[0]))
                printf("does not fall from above 1 to below\n");
            else
                printf("falls below 1 first at %.4f Hz, for the last time at %.4f Hz\n", found[0], found[1]);
        }
}

void study_shaken_print(const study_shaken *shaken)
{
    const study_scene scene = study_base();
    printf("Response of pipe %u, lying on the wall: amplitude of its middle, by axis\n", scene.pipes);
    printf("  drives: %g %% of the feed of %g mm/s and of %.0f rpm; friction: %g of the wall force, around the string "
           "(last\n  column: along it); eccentric masses: %g mm; structural damping %g %%\n",
           100.0 * RIG_SHAKE, 1e3 * RIG_FEED, STUDY_ROTATION * 60.0 / STUDY_TURN, scene.wall.mu_dynamic,
           1e3 * scene.pipe.eccentricity, 100.0 * STUDY_LOSS);
    print_amplitudes(&shaken->response);
    printf("  linear: around the swinging of the pipes in the hole amplitudes are larger than its clearance of %g mm, "
           "and\n"
           "  only tell which cause is the stronger\n",
           1e3 * study_clearance(&scene));
    print_crossings(&shaken->response);
    printf("  crossover from friction around to eccentricity, over all axes\n");
    for (int i = 0; i < STUDY_CASES; ++i)
        printf("    friction %.2f, eccentricity %.1f mm: first at %7.4f Hz, for the last time at %8.4f Hz\n",
               study_case_friction[i], 1e3 * study_case_eccentricity[i], shaken->crossover[i][0],
               shaken->crossover[i][1]);
    printf("\n");
}

int study_shaken_write(const char *folder, const study_shaken *shaken)
{
    static const char *const causes[STUDY_CAUSES] = {"drives", "friction", "eccentricity", "all three",
                                                     "friction along"};
    const study_response *r = &shaken->response;
    FILE *file = study_table(folder, "response.csv", NULL);
    if (file == NULL) return 1;
    fprintf(file, "frequency [Hz]");
    for (int axis = STUDY_AXES; axis >= 0; --axis)
        for (int cause = 0; cause < STUDY_CAUSES; ++cause)
            fprintf(file, ",%s%s%s [m]", causes[cause], axis < STUDY_AXES ? " " : "",
                    axis < STUDY_AXES ? axis_names[axis] : "");
    fprintf(file, "\n");
    for (uint32_t k = 0; k < r->points; ++k) {
        fprintf(file, "%.17g", r->frequency[k]);
        for (int axis = STUDY_AXES; axis >= 0; --axis) {
            const study_response view = study_response_view(r, axis, STUDY_FRICTION);
            for (int cause = 0; cause < STUDY_CAUSES; ++cause)
                fprintf(file, ",%.17g", view.amplitude[(size_t)k * STUDY_CAUSES + (size_t)cause]);
        }
        fprintf(file, "\n");
    }
    return fclose(file) != 0;
}
