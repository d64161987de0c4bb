#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "study.h"

#define LOW 0.1    /* [Hz] */
#define HIGH 100.0 /* [Hz] */
#define ALIGNED_HIGH 20.0

enum { POINTS = 400, REFINEMENT = 6, ALIGNED_POINTS = 100, INPUTS = 4, AXES = 3 };
/* The cause that an input is part of. */
static const int cause_of[INPUTS] = {STUDY_DRIVE, STUDY_DRIVE, STUDY_FRICTION, STUDY_ECCENTRIC};

/* Whole friction, or only what it differs by between rest and sliding; eccentricities that are usual. */
const double study_case_friction[STUDY_CASES] = {0.30, 0.30, 0.30, 0.05, 0.05, 0.05};         /* [-] */
const double study_case_eccentricity[STUDY_CASES] = {0.5e-3, 1e-3, 2e-3, 0.5e-3, 1e-3, 2e-3}; /* [m] */

/* ---- Amplitudes -------------------------------------------------------------------------------------------------- */

/* The drives shake by a part of their speeds, the wall rubs around the string by the whole friction of sliding, the
 * eccentric masses turn. */
static void set_inputs(const study_string *s, const study_scene *scene, dmb_input inputs[INPUTS])
{
    for (int i = 0; i < INPUTS; ++i) inputs[i] = dmb_input_default();
    for (int i = 0; i < 2; ++i) {
        inputs[i].kind = DMB_INPUT_DRIVE;
        inputs[i].place.part = s->drive[i];
    }
    inputs[0].amplitude = RIG_SHAKE * RIG_FEED;
    inputs[1].amplitude = RIG_SHAKE * STUDY_ROTATION;
    inputs[2].kind = DMB_INPUT_FRICTION;
    inputs[2].component = DMB_RX;
    inputs[2].amplitude = scene->wall.mu_dynamic;
    inputs[3].kind = DMB_INPUT_ECCENTRICITY;
}

/* Adds the motion along one axis to the squares of the amplitudes. */
static int32_t add_axis(const dmb_response *response, uint32_t axis, const dmb_input inputs[INPUTS],
                        const study_response *r, double *values, double *sums)
{
    const size_t values_count = 2 * (size_t)r->points; /* real and imaginary parts */
    for (int cause = 0; cause <= STUDY_TOGETHER; ++cause) {
        for (size_t k = 0; k < values_count; ++k) sums[k] = 0.0;
        for (uint32_t i = 0; i < INPUTS; ++i) {
            if (cause != STUDY_TOGETHER && cause_of[i] != cause) continue;
            const int32_t status = dmb_response_transfer(response, i, axis, values);
            if (status < 0) return status;
            for (size_t k = 0; k < values_count; ++k) sums[k] += inputs[i].amplitude * values[k];
        }
        for (size_t k = 0; k < r->points; ++k)
            r->amplitude[k * STUDY_CAUSES + (size_t)cause] +=
                sums[2 * k] * sums[2 * k] + sums[2 * k + 1] * sums[2 * k + 1];
    }
    return DMB_OK;
}

static int32_t take(const dmb_response *response, const dmb_input inputs[INPUTS], study_response *r)
{
    uint32_t shape[3] = {0, 0, 0};
    int32_t status = dmb_response_dimensions(response, shape);
    if (status < 0) return status;
    r->points = shape[0];
    r->frequency = calloc(r->points, sizeof *r->frequency);
    r->amplitude = calloc((size_t)r->points * STUDY_CAUSES, sizeof *r->amplitude);
    double *work = calloc(4 * (size_t)r->points, sizeof *work);
    if (r->frequency == NULL || r->amplitude == NULL || work == NULL) status = DMB_ERR_NO_MEMORY;
    if (status >= 0) status = dmb_response_frequencies(response, r->frequency);
    for (uint32_t axis = 0; axis < AXES && status >= 0; ++axis)
        status = add_axis(response, axis, inputs, r, work, work + 2 * (size_t)r->points);
    for (uint32_t k = 0; k < r->points * STUDY_CAUSES && status >= 0; ++k) r->amplitude[k] = sqrt(r->amplitude[k]);
    free(work);
    return status;
}

int32_t study_respond(study_string *s, const study_scene *scene, double low, double high, uint32_t points,
                      uint32_t refinement, study_response *r)
{
    dmb_response_options options = dmb_response_options_default();
    dmb_input inputs[INPUTS];
    dmb_output outputs[AXES];
    dmb_response *response = NULL;
    set_inputs(s, scene, inputs);
    for (int32_t axis = 0; axis < AXES; ++axis) {
        outputs[axis] = dmb_output_default();
        outputs[axis].place = dmb_station(s->string, scene->pipes - 1, 0.5);
        outputs[axis].component = axis;
    }
    options.points = points;
    options.frequency_low = low;
    options.frequency_high = high;
    options.logarithmic = 1;
    options.refinement = refinement;
    options.structural_damping = STUDY_LOSS;
    options.friction = 0; /* a string that turns slides already, and sliding has next to no slope */
    int32_t status = dmb_analysis_response(s->sim, &options, inputs, INPUTS, outputs, AXES, &response);
    if (status >= 0) status = take(response, inputs, r);
    dmb_response_destroy(&response);
    return status;
}

void study_response_free(study_response *r)
{
    free(r->frequency);
    free(r->amplitude);
    r->frequency = r->amplitude = NULL;
    r->points = 0;
}

/* ---- Which is stronger ------------------------------------------------------------------------------------------- */

/* Logarithm of friction over eccentricity at a point: > 0 where friction is stronger. */
static double log_ratio(const study_response *r, uint32_t k)
{
    const double *a = r->amplitude + (size_t)k * STUDY_CAUSES;
    return log(a[STUDY_FRICTION] / a[STUDY_ECCENTRIC]);
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
    return study_amplitude_at(r, STUDY_FRICTION, frequency) / study_amplitude_at(r, STUDY_ECCENTRIC, frequency);
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

static void print_amplitudes(const study_response *r)
{
    static const double asked[] = {0.1, 0.5, 1.0, STUDY_REFERENCE_CROSSOVER, 3.0, 4.9, 10.0, 30.0, 100.0};
    printf("  %9s %13s %13s %13s %13s   mm\n", "Hz", "drives", "friction", "eccentricity", "all three");
    for (size_t i = 0; i < sizeof asked / sizeof asked[0]; ++i) {
        printf("  %9.4f", asked[i]);
        for (int cause = 0; cause < STUDY_CAUSES; ++cause)
            printf(" %13.5e", 1e3 * study_amplitude_at(r, cause, asked[i]));
        printf("\n");
    }
}

void study_shaken_print(const study_shaken *shaken)
{
    const study_scene scene = study_base();
    printf("Response of pipe %u, lying on the wall: amplitude of its middle\n", scene.pipes);
    printf(
        "  drives: %g %% of the feed of %g mm/s and of %.0f rpm; friction: %g of the wall force, around the string;\n"
        "  eccentric masses: %g mm; structural damping %g %%\n",
        100.0 * RIG_SHAKE, 1e3 * RIG_FEED, STUDY_ROTATION * 60.0 / STUDY_TURN, scene.wall.mu_dynamic,
        1e3 * scene.pipe.eccentricity, 100.0 * STUDY_LOSS);
    print_amplitudes(&shaken->response);
    printf("  linear: around the swinging of the pipes in the hole amplitudes are larger than its clearance of %g mm, "
           "and\n"
           "  only tell which cause is the stronger\n",
           1e3 * study_clearance(&scene));
    printf("  crossover from friction to eccentricity\n");
    for (int i = 0; i < STUDY_CASES; ++i)
        printf("    friction %.2f, eccentricity %.1f mm: first at %7.4f Hz, for the last time at %8.4f Hz\n",
               study_case_friction[i], 1e3 * study_case_eccentricity[i], shaken->crossover[i][0],
               shaken->crossover[i][1]);
    printf("\n");
}

int study_shaken_write(const char *folder, const study_shaken *shaken)
{
    const study_response *r = &shaken->response;
    FILE *file =
        study_table(folder, "response.csv", "frequency [Hz],drives [m],friction [m],eccentricity [m],all three [m]");
    if (file == NULL) return 1;
    for (uint32_t k = 0; k < r->points; ++k) {
        fprintf(file, "%.17g", r->frequency[k]);
        for (int cause = 0; cause < STUDY_CAUSES; ++cause)
            fprintf(file, ",%.17g", r->amplitude[(size_t)k * STUDY_CAUSES + (size_t)cause]);
        fprintf(file, "\n");
    }
    return fclose(file) != 0;
}
