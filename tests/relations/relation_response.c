/* Frequency responses: reciprocity; against the sum over all modes; against stepped sine in time. Effective masses
 * against the mass. A pulse and the free vibration after it against the modes. */
#include "linear_tools.h"

enum { TOPIC_RESPONSE = TOPIC_OF_RELATION + 70, PLACES = 3, FREQUENCIES = 5, MODES_MOST = 500 };

/* ---- Tools ------------------------------------------------------------------------------------------------------ */

/* 0 where places do not move across the hole, or the stiffness is unsymmetric, as that of a bit load in a bend is
 * (eq:motion.turn): bent holes have no bit here. */
static int reciprocal(trial *t)
{
    if (t->s.family == FAMILY_BENT) t->s.has_bit = 0;
    if (t->s.string[0].pipe[0].kind == DMB_PIPE_AXIAL_TORSIONAL)
        left_out(t, "pipes that the hole holds across");
    else if (scene_drives_tilt(&t->s))
        left_out(t, "a drive along axes that tilt");
    return t->verdict == VERDICT_HELD;
}

static dmb_response_options frequencies_from(stream *n, double *list, double low, double high)
{
    dmb_response_options options = dmb_response_options_default();
    for (int i = 0; i < FREQUENCIES; ++i) list[i] = low * pow(high / low, (i + draw_number(n, 0.0, 1.0)) / FREQUENCIES);
    options.frequencies = list;
    options.points = FREQUENCIES;
    return options;
}

/* Transfer functions between the material_points, shape (PLACES inputs, PLACES outputs, FREQUENCIES). */
static int32_t transfer(built *b, const dmb_response_options *options, const material_point *material_points,
                        double complex h[PLACES][PLACES][FREQUENCIES])
{
    dmb_excitation inputs[PLACES];
    dmb_output outputs[PLACES];
    double values[FREQUENCIES][2];
    dmb_response *response = NULL;
    for (int i = 0; i < PLACES; ++i) {
        inputs[i] = input_of(b, &material_points[i]);
        outputs[i] = output_of(b, &material_points[i]);
    }
    const int32_t status = dmb_analysis_response(b->sim, options, inputs, PLACES, outputs, PLACES, &response);
    if (status < 0) return built_fail(b, status);
    for (uint32_t i = 0; i < PLACES; ++i) {
        for (uint32_t k = 0; k < PLACES; ++k) {
            (void)dmb_response_transfer(response, i, k, values[0]);
            for (int f = 0; f < FREQUENCIES; ++f) h[i][k][f] = number(values[f]);
        }
    }
    dmb_response_destroy(&response);
    return status;
}

/* ---- Reciprocity ------------------------------------------------------------------------------------------------ */

/* K, C and M are symmetric at a state of rest under dead loads without friction. */
static void check_reciprocal(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_RESPONSE);
    double complex h[PLACES][PLACES][FREQUENCIES];
    double list[FREQUENCIES];
    material_point material_points[PLACES];
    built b;
    if (!reciprocal(t)) return;
    const dmb_response_options options = frequencies_from(&n, list, 0.5, 500.0);
    int32_t status = open_at_rest(&t->s, NULL, &b);
    for (int i = 0; i < PLACES; ++i) material_points[i] = draw_spot(&t->s, &n, 6);
    if (status >= 0) status = transfer(&b, &options, material_points, h);
    if (status < 0) refused(t, status, b.message);
    for (int i = 0; i < PLACES && t->verdict == VERDICT_HELD; ++i)
        for (int k = 0; k < i; ++k)
            for (int f = 0; f < FREQUENCIES; ++f)
                hold(t, "transfer function from one place to another and back", cabs(h[i][k][f] - h[k][i][f]),
                     1e-7 * sqrt(cabs(h[i][i][f]) * cabs(h[k][k][f])));
    scene_close(&b);
}

/* ---- Sum over the modes ----------------------------------------------------------------------------------------- */

static void no_damping(scene *s)
{
    s->environment.lateral_damping = s->environment.axial_damping = s->environment.torsional_damping = 0.0;
    s->wall.damping = 0.0;
    for (uint32_t k = 0; k < s->strings; ++k)
        for (uint32_t i = 0; i < s->string[k].pipes; ++i) s->string[k].pipe[i].damping_time = 0.0;
    for (uint32_t i = 0; i < s->joints; ++i) memset(s->joint[i].def.damping, 0, sizeof s->joint[i].def.damping);
}

/* All undamped modes: squares of the frequencies [1/s2], and shapes at the material_points. */
typedef struct modal {
    uint32_t count;
    double square[MODES_MOST], shape[MODES_MOST][PLACES];
} modal;

static int32_t take_modes(built *b, const material_point *material_points, modal *m)
{
    dmb_modes *found = NULL;
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes_info info = dmb_modes_info_default();
    options.select = DMB_MODES_ALL;
    const int32_t status = dmb_analysis_modes(b->sim, &options, &found);
    if (status < 0) return built_fail(b, status);
    (void)dmb_modes_get_info(found, &info);
    m->count = info.count < MODES_MOST ? info.count : MODES_MOST;
    for (uint32_t i = 0; i < m->count; ++i) {
        dmb_mode mode = dmb_mode_default();
        (void)dmb_modes_get(found, i, &mode);
        /* s2 = -w2, and growth where it is not stable */
        m->square[i] = mode.eigenvalue[1] * mode.eigenvalue[1] - mode.eigenvalue[0] * mode.eigenvalue[0];
        for (int k = 0; k < PLACES; ++k) {
            dmb_mode_shape shape = dmb_mode_shape_default();
            (void)dmb_modes_shape(found, i, built_place(b, material_points[k].place), &shape);
            m->shape[i][k] = shape.re[material_points[k].component];
        }
    }
    dmb_modes_destroy(&found);
    return info.count > MODES_MOST ? DMB_ERR_TOO_LARGE : status;
}

/* H = sum phi phi^T/((1 + i eta) w_k^2 - w^2): exact, structural damping being (1 + i eta) K. */
static void check_modal(trial *t)
{
    static modal m;
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_RESPONSE + 1);
    double complex h[PLACES][PLACES][FREQUENCIES];
    double list[FREQUENCIES];
    material_point material_points[PLACES];
    built b;
    if (!reciprocal(t)) return;
    dmb_response_options options = frequencies_from(&n, list, 0.5, 500.0);
    options.structural_damping = draw_number(&n, 0.005, 0.05);
    no_damping(&t->s);
    int32_t status = open_at_rest(&t->s, NULL, &b);
    for (int i = 0; i < PLACES; ++i) material_points[i] = draw_spot(&t->s, &n, 6);
    if (status >= 0) status = transfer(&b, &options, material_points, h);
    if (status >= 0) status = take_modes(&b, material_points, &m);
    if (status < 0) refused(t, status, b.message);
    for (int i = 0; i < PLACES && t->verdict == VERDICT_HELD; ++i)
        for (int k = 0; k < PLACES; ++k)
            for (int f = 0; f < FREQUENCIES; ++f) {
                const double w = 2.0 * PI * list[f];
                const double complex eta = 1.0 + options.structural_damping * (double complex)I;
                double complex sum = 0.0;
                double size = 0.0;
                for (uint32_t q = 0; q < m.count; ++q) {
                    const double complex term = m.shape[q][i] * m.shape[q][k] / (eta * m.square[q] - w * w);
                    sum += term;
                    size += cabs(term);
                }
                hold(t, "transfer function beside the sum over the modes", cabs(h[i][k][f] - sum),
                     1e-6 * size + 1e-6 * sqrt(cabs(h[i][i][f]) * cabs(h[k][k][f])));
            }
    scene_close(&b);
}

/* ---- Effective masses ------------------------------------------------------------------------------------------- */

/* Six of a free string, two of a guided one, along and around; joints add what their springs do not hold. */
static void hold_rigid_motions(trial *t, const dmb_modes *found)
{
    const uint32_t wanted = t->s.family == FAMILY_FREE ? 6U : 2U;
    dmb_modes_info info = dmb_modes_info_default();
    (void)dmb_modes_get_info(found, &info);
    if (t->s.joints == 0 && info.rigid != wanted) broken(t, "rigid-body motions", info.rigid, wanted);
}

/* Free strings move as they are in each direction, guided ones along their support: all of their mass does. */
static void check_masses(trial *t)
{
    built b;
    dmb_modes *found = NULL;
    dmb_modes_options options = dmb_modes_options_default();
    dmb_model_info info = dmb_model_info_default();
    double R[9] = {0.0}, along = 0.0, sum[3] = {0.0, 0.0, 0.0};
    t->s.drives = 0;
    t->s.environment.gravity[2] = 0.0;
    if (t->s.family == FAMILY_LINE && t->s.string[0].def.start_free != DMB_FREE_CYLINDRICAL) {
        left_out(t, "a support that lets nothing move");
        return;
    }
    options.select = DMB_MODES_ALL;
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_modes(b.sim, &options, &found);
    if (status < 0) {
        refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
        scene_close(&b);
        return;
    }
    hold_rigid_motions(t, found);
    (void)dmb_model_get_info(b.model, &info);
    rotation_of_vector(t->s.string[0].def.rotation, R);
    dmb_mode mode = dmb_mode_default();
    for (uint32_t i = 0; dmb_modes_get(found, i, &mode) >= 0; ++i) {
        double part = 0.0;
        for (int k = 0; k < 3; ++k) {
            part += R[3 * k] * mode.participation[k];
            sum[k] += mode.effective_mass[k];
        }
        along += part * part;
    }
    if (t->verdict == VERDICT_HELD)
        hold(t, "masses along the string beside the mass", fabs(along / info.mass - 1.0), 1e-9);
    for (int k = 0; k < 3 && t->s.family == FAMILY_FREE && t->verdict == VERDICT_HELD; ++k)
        hold(t, "sum of effective masses beside the mass", fabs(sum[k] / info.mass - 1.0), 1e-9);
    dmb_modes_destroy(&found);
    scene_close(&b);
}

/* ---- Free vibration --------------------------------------------------------------------------------------------- */

enum { SAMPLES = 240, FINE = 16 };

/* Half a STEP5 up and one down. */
static double pulse_at(double now, double time)
{
    const double half = 0.5 * time, d = now < half ? now / half : (time - now) / half, e = fmin(1.0, fmax(0.0, d));
    return e * e * e * (10.0 - 15.0 * e + 6.0 * e * e);
}

/* q'' + w2 q = f phi of each mode, exact for a force that is straight between fine samples. The material_points are x,
 * y, z of one place. */
static void superpose(const modal *m, const double force[3], double step, double time, double out[SAMPLES][3])
{
    memset(out, 0, SAMPLES * sizeof *out);
    for (uint32_t k = 0; k < m->count; ++k) {
        const double w = sqrt(fabs(m->square[k])), h = step / FINE, c = cos(w * h), s = sin(w * h);
        const double gain = m->shape[k][0] * force[0] + m->shape[k][1] * force[1] + m->shape[k][2] * force[2];
        double q = 0.0, v = 0.0;
        for (int i = 0; i < SAMPLES; ++i) {
            for (int j = 0; j < FINE; ++j) {
                const double a = gain * pulse_at((i * FINE + j) * h, time);
                const double slope = (gain * pulse_at((i * FINE + j + 1) * h, time) - a) / h;
                /* particular solution (a + slope t)/w2; the rest is a free vibration */
                const double q0 = q - a / (w * w), v0 = v - slope / (w * w);
                q = q0 * c + v0 * s / w + (a + slope * h) / (w * w);
                v = v0 * c - q0 * w * s + slope / (w * w);
            }
            for (int axis = 0; axis < 3; ++axis) out[i][axis] += q * m->shape[k][axis];
        }
    }
}

static int32_t sample_run(const scene *s, part_ref place, double step, uint32_t divide, double out[SAMPLES][3])
{
    built b;
    dmb_sim_options options = scene_options(s);
    dmb_pose rest = dmb_pose_default(), now = dmb_pose_default();
    options.spectral_radius = 1.0;
    int32_t status = open_at_rest(s, &options, &b);
    if (status >= 0) (void)dmb_query_pose(b.sim, built_place(&b, place), &rest);
    for (int i = 0; i < SAMPLES && status >= 0; ++i) {
        status = run_steps(&b, step / divide, divide, NULL);
        (void)dmb_query_pose(b.sim, built_place(&b, place), &now);
        for (int k = 0; k < 3; ++k) out[i][k] = now.position[k] - rest.position[k];
    }
    scene_close(&b);
    return status;
}

/* The modes of the loaded place, and the length of a pulse: half of the lowest period. 0 where there are none to
 * compare. */
static double modes_of_load(trial *t, modal *m)
{
    built b;
    material_point material_points[PLACES];
    double lowest = 1e300;
    m->count = 0;
    for (int i = 0; i < PLACES; ++i) {
        material_points[i].place = t->s.load[0].place;
        material_points[i].component = i;
    }
    int32_t status = open_at_rest(&t->s, NULL, &b);
    if (status >= 0) status = take_modes(&b, material_points, m);
    if (status < 0) refused(t, status, b.message);
    scene_close(&b);
    for (uint32_t k = 0; k < m->count; ++k) lowest = fmin(lowest, m->square[k]);
    if (t->verdict == VERDICT_HELD && !(lowest > 1e-3)) left_out(t, "an equilibrium that does not hold");
    return t->verdict == VERDICT_HELD ? PI / sqrt(lowest) : 0.0;
}

/* The motion of the loaded place after a pulse. The scheme is of second order: extrapolated from the step and half of
 * it, and compared with the modes. */
static void check_decay(trial *t)
{
    static modal m;
    static double expected[SAMPLES][3], coarse[SAMPLES][3], fine[SAMPLES][3];
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_RESPONSE + 2);
    double force[3], most = 0.0, error = 0.0, raw = 0.0;
    no_damping(&t->s);
    if (t->s.loads == 0) left_out(t, "no load and no place of it");
    const double time = t->s.loads > 0 ? modes_of_load(t, &m) : 0.0, step = 3.0 * time / SAMPLES;
    if (t->verdict != VERDICT_HELD) return;
    draw_direction(&n, force);
    superpose(&m, force, step, time, expected);
    for (int i = 0; i < 3 * SAMPLES; ++i) most = fmax(most, fabs(expected[i / 3][i % 3]));
    const double size = 1e-6 * t->s.span / most;                  /* small: the answer is linear to some such part */
    if (!(size < 1e6)) left_out(t, "a place that does not move"); /* 1e6 N would not move it by that */
    for (int i = 0; i < 3; ++i) force[i] *= size;
    scene_kick(&t->s, force, time);
    int32_t status = sample_run(&t->s, t->s.load[0].place, step, 1, coarse);
    if (status >= 0) status = sample_run(&t->s, t->s.load[0].place, step, 2, fine);
    if (status < 0) refused(t, status, "a run that fails");
    if (t->verdict != VERDICT_HELD) return;
    for (int i = 0; i < 3 * SAMPLES; ++i) {
        const double one = coarse[i / 3][i % 3], two = fine[i / 3][i % 3], wanted = size * expected[i / 3][i % 3];
        error = fmax(error, fabs((4.0 * two - one) / 3.0 - wanted));
        raw = fmax(raw, fabs(one - wanted));
    }
    /* fourth order is left of the scheme, next to nothing where it does not resolve a mode that the pulse excites */
    const double unit = size * most;
    hold(t, "motion after a pulse beside the modes", error, 2e-4 * unit + 0.1 * raw + 1e-11 * t->s.span);
    hold(t, "motion after a pulse beside the modes, at one step", raw, 0.05 * unit);
}

/* ---- Stepped sine ----------------------------------------------------------------------------------------------- */

static int32_t sine_at(const scene *s, const material_point *at, double frequency, uint32_t steps, double complex *out)
{
    built b;
    double amplitudes[2][2];
    dmb_sim_options options = scene_options(s);
    dmb_stepped_sine_options sine = dmb_stepped_sine_options_default();
    dmb_stepped_sine_report report = dmb_stepped_sine_report_default();
    options.newton_tolerance = 1e-12; /* of forces that are far larger than their changes */
    sine.steps_per_period = steps;
    sine.harmonics = 1;
    sine.tolerance = 1e-5;
    sine.windows = 100;
    int32_t status = open_at_rest(s, &options, &b);
    const dmb_output output = output_of(&b, at);
    if (status >= 0) status = dmb_analysis_stepped_sine(b.sim, frequency, &sine, &output, 1, amplitudes[0], &report);
    scene_close(&b);
    *out = number(amplitudes[1]);
    return status;
}

/* The load varies by a small part of it, sin(w t) = Re(-i e^(i w t)). */
static void check_sine(trial *t)
{
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_RESPONSE + 3);
    built b;
    dmb_response *response = NULL;
    dmb_modes *found = NULL;
    dmb_mode mode = dmb_mode_default();
    dmb_excitation input = dmb_excitation_default();
    double pair[2] = {0.0, 0.0};
    double complex coarse = 0.0, fine = 0.0;
    if (t->s.loads == 0) {
        left_out(t, "no load that could vary");
        return;
    }
    const material_point at = {t->s.load[0].place, (int32_t)draw_count(&n, 0, 2)};
    dmb_static_report report = dmb_static_report_default();
    dmb_static_options stays = dmb_static_options_default();
    int32_t status = open_at_rest(&t->s, NULL, &b);
    stays.lay_on_wall = 0; /* once more, for its report */
    if (status >= 0) status = dmb_analysis_static(b.sim, &stays, &report);
    if (status >= 0) status = dmb_analysis_modes(b.sim, NULL, &found);
    if (status >= 0) status = dmb_modes_get(found, 0, &mode);
    double frequency = mode.frequency * draw_number(&n, 0.5, 3.0);
    const dmb_output output = output_of(&b, &at);
    dmb_response_options options = dmb_response_options_default();
    options.frequencies = &frequency;
    options.points = 1;
    options.frequency_low = options.frequency_high = frequency;
    input.kind = DMB_EXCITATION_LOAD;
    input.place.part = b.load[0];
    if (status >= 0 && frequency > 0.0)
        status = dmb_analysis_response(b.sim, &options, &input, 1, &output, 1, &response);
    if (status < 0)
        refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
    else if (mode.rigid || response == NULL)
        left_out(t, "nothing holds it");
    else if (report.negative != 0)
        left_out(t, "an equilibrium that does not hold");
    else
        (void)dmb_response_transfer(response, 0, 0, pair);
    dmb_response_destroy(&response);
    dmb_modes_destroy(&found);
    scene_close(&b);
    const double complex wanted = number(pair);
    if (t->verdict == VERDICT_HELD && cabs(wanted) < 1e-9 * t->s.span) left_out(t, "a load that does not move it");
    if (t->verdict != VERDICT_HELD) return;
    const double part = fmin(0.1, 1e-7 * t->s.span / cabs(wanted));
    t->s.load[0].time_function = time_function_step(1.0, 0.0, 0.0, 1.0);
    t->s.load[0].time_function.term[1].kind = DMB_SEGMENT_HARMONIC;
    t->s.load[0].time_function.term[1].h0 = 0.0;
    t->s.load[0].time_function.term[1].h1 = part;
    t->s.load[0].time_function.term[1].omega = 2.0 * PI * frequency;
    status = sine_at(&t->s, &at, frequency, 64, &coarse);
    if (status == DMB_OK) status = sine_at(&t->s, &at, frequency, 128, &fine);
    if (status < 0)
        refused(t, status, "stepped sine fails");
    else if (status != DMB_OK)
        left_out(t, "a run that does not settle in time");
    if (t->verdict != VERDICT_HELD) return;
    const double complex unit = -(double complex)I * part * wanted, best = (4.0 * fine - coarse) / 3.0;
    hold(t, "stepped sine, extrapolated, beside the response", cabs(best - unit),
         1e-3 * cabs(unit) + 0.1 * cabs(coarse - unit));
    hold(t, "stepped sine at half the step", cabs(fine - unit), 0.35 * cabs(coarse - unit) + 1e-4 * cabs(unit));
}

#define AT_REST (WISH_STILL | WISH_CONSERVATIVE | WISH_ELASTIC | WISH_NO_CONTROL | WISH_HARD)
const relation relation_reciprocal = {"reciprocal",
                                      "responses from one place to another against those back",
                                      {FAMILY_LINE | FAMILY_HOLE | FAMILY_BENT, AT_REST, 4},
                                      40,
                                      0.5,
                                      check_reciprocal,
                                      0.0};
const relation relation_modal = {"modal",
                                 "frequency responses against the sum over all modes",
                                 {FAMILY_LINE | FAMILY_HOLE | FAMILY_BENT, AT_REST, 3},
                                 15,
                                 0.5,
                                 check_modal,
                                 0.0};
const relation relation_masses = {"masses",
                                  "the sum of the effective masses of all modes against the mass",
                                  {FAMILY_LINE | FAMILY_FREE, AT_REST | WISH_NO_LOADS, 4},
                                  20,
                                  0.4,
                                  check_masses,
                                  0.0};
const relation relation_decay = {"decay",
                                 "a pulse and the free vibration after it against the modes",
                                 {FAMILY_LINE, AT_REST, 3},
                                 10,
                                 0.4,
                                 check_decay,
                                 0.0};
const relation relation_sine = {"sine",
                                "stepped sine in time against the frequency response",
                                {FAMILY_LINE, WISH_STILL | WISH_ELASTIC | WISH_NO_CONTROL | WISH_DAMPED, 2},
                                8,
                                0.3,
                                check_sine,
                                0.0};
