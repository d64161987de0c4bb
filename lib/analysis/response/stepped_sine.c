/* Stepped sine: response from a simulation in time. */
#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "analysis/response/response.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "drillmbd/analyse.h"
#include "math/so3.h"
#include "query/query.h"
#include "sim/access.h"
#include "sim/sim.h"

/* ---- Outputs, asked at one instant ------------------------------------------------------------------------------- */

typedef struct sine_output {
    dmb_output output;
    dmb_asked_output asked; /* of a vibration; else of kind DMB_ASKED_OUTPUT */
    double start[9];        /* [-] axes of the place at the call, columns, world */
    double angle;           /* [rad] about its axis at the call */
} sine_output;

static void part_along(const double axes[9], int32_t frame, const double world[3], double out[3])
{
    if (frame == DMB_FRAME_BODY)
        dmb_mat3_tvec(axes, world, out);
    else
        dmb_vec3_copy(world, out);
}

/* Rotation from the pose at the call, R = R_0 R_D exp(phi x~), phi the unwrapped angle about the own axis: the world
 * components of (phi, 0, 0) + log R_D in the axes at the call, to first order those of the vibration however far the
 * place has turned about its axis. */
static void rotation_since(const sine_output *o, const double now[9], double angle, double out[3])
{
    const double phi = angle - o->angle, c = cos(phi), s = sin(phi);
    const double back[9] = {1.0, 0.0, 0.0, 0.0, c, s, 0.0, -s, c};
    double turned[9], tilt[9], q[4], own[3];
    dmb_mat3_mul_tn(o->start, now, turned);
    dmb_mat3_mul(turned, back, tilt);
    dmb_quat_from_matrix(tilt, q);
    dmb_quat_log(q, own);
    own[0] += phi;
    dmb_mat3_vec(o->start, own, out);
}

static double displacement(const dmb_sim *sim, const sine_output *o, int32_t *status)
{
    dmb_pose pose = dmb_pose_default();
    double angle = 0.0, world[3], out[3];
    *status = dmb_answer_pose(sim, o->output.place, &pose);
    if (*status >= 0) *status = dmb_answer_rotation(sim, o->output.place, &angle);
    if (*status < 0) return 0.0;
    if (o->asked.component < DMB_RX)
        dmb_vec3_copy(pose.displacement, world);
    else
        rotation_since(o, pose.rotation, angle, world);
    part_along(o->start, o->asked.frame, world, out);
    return out[o->asked.component % 3];
}

/* Of the angular velocity w of a place that spins by s about its axis t, the part that is the rate of rotation_since:
 * w - s (t - t_0); of the angular acceleration a the rate of that, a - s' (t - t_0) - s w x t. */
static void without_spin(const dmb_sim *sim, const sine_output *o, const dmb_motion *world, double out[3])
{
    dmb_motion own = dmb_motion_default();
    dmb_pose pose = dmb_pose_default();
    double t[3], swing[3];
    const int is_velocity = o->asked.kind == DMB_ASKED_VELOCITY;
    own.frame = DMB_FRAME_BODY;
    (void)dmb_answer_motion(sim, o->output.place, &own);
    (void)dmb_answer_pose(sim, o->output.place, &pose);
    for (int i = 0; i < 3; i++) t[i] = pose.rotation[3 * i];
    dmb_vec3_cross(world->velocity + 3, t, swing);
    for (int i = 0; i < 3; i++) {
        const double moved = t[i] - o->start[3 * i];
        out[i] = is_velocity ? world->velocity[3 + i] - own.velocity[3] * moved
                             : world->acceleration[3 + i] - own.acceleration[3] * moved - own.velocity[3] * swing[i];
    }
}

/* Rates of the displacement, in its axes: those of the world, or those at the call, which do not turn with the place.
 */
static double rate_of(const dmb_sim *sim, const sine_output *o, int32_t *status)
{
    dmb_motion motion = dmb_motion_default();
    double world[3], out[3];
    *status = dmb_answer_motion(sim, o->output.place, &motion);
    if (*status < 0) return 0.0;
    if (o->asked.component < DMB_RX)
        dmb_vec3_copy(o->asked.kind == DMB_ASKED_VELOCITY ? motion.velocity : motion.acceleration, world);
    else
        without_spin(sim, o, &motion, world);
    part_along(o->start, o->asked.frame, world, out);
    return out[o->asked.component % 3];
}

static double value_of(const dmb_sim *sim, const sine_output *o, int32_t *status)
{
    if (o->asked.kind == DMB_ASKED_DISPLACEMENT) return displacement(sim, o, status);
    if (o->asked.kind == DMB_ASKED_OUTPUT) return dmb_answer_of(sim, &o->asked, status);
    return rate_of(sim, o, status);
}

/* Takes the pose of the call. Errors: those of the queries. */
static int32_t begin_output(const dmb_sim *sim, sine_output *output)
{
    dmb_pose pose = dmb_pose_default();
    int32_t status = DMB_OK;
    output->angle = 0.0;
    if (output->asked.kind != DMB_ASKED_OUTPUT) {
        status = dmb_answer_pose(sim, output->output.place, &pose);
        if (status >= 0) status = dmb_answer_rotation(sim, output->output.place, &output->angle);
    }
    memcpy(output->start, pose.rotation, sizeof output->start);
    if (status >= 0) (void)value_of(sim, output, &status);
    return status;
}

/* Value now, of an output that has begun. */
static double sample_of(const dmb_sim *sim, const sine_output *output)
{
    int32_t status;
    return value_of(sim, output, &status);
}

/* Stepped sine at one frequency. Over a window of n = periods times steps_per_period steps
 *
 *     A_k = 2/n sum_j (x_j - s (t_j - t_m)) e^(-i k w t_j),     mean = 1/n sum_j (x_j - s (t_j - t_m)),
 *
 * s being the drift of a displacement from the first to the last instant over the length of the window and t_m its
 * middle. If successive windows differ by c_1, c_2 = q c_1, ..., the remaining change is c_2 q/(1 - q) (Aitken). */

DMB_DECLARE_STRUCT(dmb_stepped_sine_report)

typedef struct sine_run {
    dmb_sim *sim;
    dmb_stepped_sine_options options;
    double omega;
    uint32_t outputs, width; /* width: numbers of one output, 2 (1 + harmonics) */
    sine_output *output;
    double *first;                                         /* value at the start of the window, shape (outputs) */
    double *sum;                                           /* shape (outputs, width) */
    double *last;                                          /* amplitudes of the window before, same shape */
    double ramp[2 * (DMB_STEPPED_SINE_HARMONICS_MAX + 1)]; /* sum of (t_j - t_m) e^(-i k w t_j) */
    double begin, step;                                    /* [s] of the window and of a step */
    double change[2];                                      /* the window before, this one */
    dmb_stepped_sine_report report;
    void *block;
    size_t block_size;
} sine_run;

/* ---- Windows ----------------------------------------------------------------------------------------------------- */

static uint32_t steps_of(const sine_run *r)
{
    return r->options.periods * r->options.steps_per_period;
}

/* Cosine and minus sine of the harmonics at an instant, as used in the sums. */
static void turn_of(const sine_run *r, double time, double *turn)
{
    for (size_t k = 0; k <= r->options.harmonics; k++) {
        turn[2 * k] = cos((double)k * r->omega * time);
        turn[2 * k + 1] = -sin((double)k * r->omega * time);
    }
}

static void add_sample(sine_run *r, double time)
{
    double turn[2 * (DMB_STEPPED_SINE_HARMONICS_MAX + 1)] = {0.0};
    const double middle = r->begin + 0.5 * r->step * steps_of(r);
    turn_of(r, time, turn);
    for (uint32_t i = 0; i < r->width; i++) r->ramp[i] += (time - middle) * turn[i];
    for (uint32_t o = 0; o < r->outputs; o++) {
        const double x = sample_of(r->sim, r->output + o);
        if (time == r->begin) r->first[o] = x;
        for (uint32_t i = 0; i < r->width; i++) r->sum[(size_t)r->width * o + i] += x * turn[i];
    }
}

static void begin_window(sine_run *r)
{
    r->begin = dmb_sim_time(r->sim);
    memset(r->ramp, 0, sizeof r->ramp);
    memset(r->sum, 0, (size_t)r->outputs * r->width * sizeof(double));
}

static double drift_of(const sine_run *r, uint32_t o)
{
    if (r->output[o].asked.kind != DMB_ASKED_DISPLACEMENT) return 0.0;
    return (sample_of(r->sim, r->output + o) - r->first[o]) / (r->step * steps_of(r));
}

/* Sums become amplitudes. */
static void end_window(sine_run *r)
{
    for (uint32_t o = 0; o < r->outputs; o++) {
        double *A = r->sum + (size_t)r->width * o;
        const double drift = drift_of(r, o);
        for (uint32_t i = 0; i < r->width; i++) A[i] = (i < 2 ? 1.0 : 2.0) / steps_of(r) * (A[i] - drift * r->ramp[i]);
    }
}

/* Runs one window. Each step ends at a whole number of steps from its start, so that rounding does not accumulate. */
static int32_t run_window(sine_run *r)
{
    const uint32_t n = steps_of(r);
    begin_window(r);
    for (uint32_t j = 0; j < n; j++) {
        dmb_step_report report = dmb_step_report_default();
        const double now = dmb_sim_time(r->sim);
        add_sample(r, now);
        const double done = (r->report.windows + (double)j / n) / r->options.windows;
        dmb_sim_hand_on(r->sim, done, done);
        const int32_t status = dmb_sim_step(r->sim, r->begin + (j + 1) * r->step - now, &report);
        dmb_sim_resume(r->sim);
        if (status < 0) return status;
        r->report.steps += report.steps;
        r->report.rejected += report.rejected;
    }
    end_window(r);
    r->report.windows++;
    return DMB_OK;
}

/* ---- Settling ---------------------------------------------------------------------------------------------------- */

/* Largest difference of a harmonic between the two windows over the largest harmonic of the output. Relative to the
 * largest harmonic of the output, but not below floor/tolerance: an output that hardly moves counts as settled at the
 * absolute change `floor`. */
static double change_of(const sine_run *r, uint32_t o)
{
    const double *A = r->sum + (size_t)r->width * o, *B = r->last + (size_t)r->width * o;
    double most = 0.0, largest = r->options.floor / r->options.tolerance;
    for (uint32_t i = 2; i < r->width; i += 2) {
        most = fmax(most, hypot(A[i] - B[i], A[i + 1] - B[i + 1]));
        largest = fmax(largest, hypot(A[i], A[i + 1]));
    }
    return most / largest;
}

static void compare(sine_run *r)
{
    double worst = 0.0;
    for (uint32_t o = 0; o < r->outputs; o++) worst = fmax(worst, change_of(r, o));
    r->change[0] = r->change[1];
    r->change[1] = worst;
}

/* Changes between windows that no longer decrease belong to the motion itself (eq:response.sine). */
static double remaining(const sine_run *r)
{
    const double q = r->change[1] / r->change[0];
    if (r->change[1] == 0.0) return 0.0;
    return q < 1.0 ? fmax(r->change[1], r->change[1] * q / (1.0 - q)) : r->change[1];
}

/* At least three windows: a change needs two, its ratio three. The last window is the result even if it has not settled
 * (DMB_NOTE_STOPPED). */
static int32_t settle(sine_run *r)
{
    const size_t bytes = (size_t)r->outputs * r->width * sizeof(double);
    while (r->report.windows < r->options.windows) {
        const int32_t status = run_window(r);
        if (status < 0) return status;
        if (r->report.windows > 1) compare(r);
        memcpy(r->last, r->sum, bytes);
        if (r->report.windows < 3) continue;
        r->report.change = r->change[1];
        r->report.remaining = remaining(r);
        r->report.settled = r->report.remaining <= r->options.tolerance;
        if (r->report.settled) return DMB_OK;
    }
    return DMB_NOTE_STOPPED;
}

/* ---- The call ---------------------------------------------------------------------------------------------------- */

static int32_t allocate_memory(sine_run *r)
{
    const size_t numbers = (size_t)r->outputs * (1 + 2 * (size_t)r->width);
    r->block_size = r->outputs * sizeof(sine_output) + numbers * sizeof(double);
    r->block = dmb_allocate(&r->sim->allocator, r->block_size);
    if (r->block == NULL) {
        dmb_message_set(&r->sim->message, "sine: no memory for %zu bytes", r->block_size);
        return DMB_ERR_NO_MEMORY;
    }
    r->output = r->block;
    r->first = (double *)(void *)(r->output + r->outputs);
    r->sum = r->first + r->outputs;
    r->last = r->sum + (size_t)r->outputs * r->width;
    return DMB_OK;
}

static int32_t read_outputs(sine_run *r, const dmb_output *outputs)
{
    for (uint32_t i = 0; i < r->outputs; i++) {
        sine_output *output = r->output + i;
        int32_t status = dmb_output_known(outputs + i, i, &r->sim->message);
        if (status < 0) return status;
        output->output = outputs[i];
        (void)dmb_asked_vibration(&output->output, &output->asked);
        status = begin_output(r->sim, output);
        if (status < 0) {
            dmb_output_explain(r->sim->model, &output->output, i, status, &r->sim->message);
            return status;
        }
    }
    return DMB_OK;
}

static int32_t shake(sine_run *r, const dmb_output *outputs)
{
    int32_t status = allocate_memory(r);
    if (status >= 0) status = read_outputs(r, outputs);
    if (status >= 0) status = settle(r);
    r->report.time = dmb_sim_time(r->sim);
    return status;
}

static int32_t analyse(sine_run *r, double frequency, const dmb_stepped_sine_options *options,
                       const dmb_output *outputs, double *amplitudes, dmb_stepped_sine_report *report)
{
    dmb_sim *sim = r->sim;
    r->report = dmb_stepped_sine_report_default();
    if (report != NULL && dmb_stepped_sine_report_read(&r->report, report) < 0) return DMB_ERR_STRUCT_SIZE;
    r->report = dmb_stepped_sine_report_default();
    int32_t status = dmb_stepped_sine_options_get(options, frequency, &sim->message, &r->options);
    dmb_check check = dmb_check_of(&sim->message, "sine", DMB_NONE);
    if (status >= 0) dmb_check_count(&check, "output_count", r->outputs, 1, DMB_RESPONSE_INPUTS_MAX);
    if (status < 0 || check.status < 0) return status < 0 ? status : check.status;
    r->width = 2 * (1 + r->options.harmonics);
    r->omega = DMB_TWO_PI * frequency;
    r->step = 1.0 / (frequency * r->options.steps_per_period);
    status = shake(r, outputs);
    if (status >= 0) {
        memcpy(amplitudes, r->sum, (size_t)r->outputs * r->width * sizeof(double));
        if (report != NULL) (void)dmb_stepped_sine_report_write(report, &r->report);
    }
    if (r->block != NULL) dmb_release(&sim->allocator, r->block, r->block_size);
    return status;
}

int32_t dmb_analysis_stepped_sine(dmb_sim *sim, double frequency, const dmb_stepped_sine_options *options,
                                  const dmb_output *outputs, uint32_t output_count, double *amplitudes,
                                  dmb_stepped_sine_report *report)
{
    if (sim == NULL || outputs == NULL || amplitudes == NULL) return dmb_sim_failed(sim, "stepped sine", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    sine_run r;
    memset(&r, 0, sizeof r);
    r.sim = sim;
    r.outputs = output_count;
    return dmb_sim_leave(sim, analyse(&r, frequency, options, outputs, amplitudes, report));
}
