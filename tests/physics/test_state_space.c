/* State space against the frequency response, the damped modes and a run in time: strings on the wall, drives of every
 * kind, joints, a spinning rotor; all coordinates and reduced; inputs of control.h. Sparse matrices and arrays against
 * energies, balance and queries. Equations: eq:response.state-space. */
#include <stdlib.h>
#include <string.h>

#include "crowded_string.h"
#include "harmonic.h"
#include "scarce.h"

/* ---- Dense complex systems --------------------------------------------------------------------------------------- */

typedef struct model {
    dmb_state_space_info info;
    double *A, *B, *C, *D;
} model;

static double *matrix(const dmb_state_space *s, int32_t which, size_t rows, size_t columns)
{
    double *values = calloc(rows * columns + 1, sizeof *values);
    assert_int_equal(dmb_state_space_dense(s, which, values), DMB_OK);
    return values;
}

static model space_of(const rig *s, const dmb_state_space_options *options, const dmb_excitation *inputs,
                      uint32_t input_count, const dmb_output *outputs, uint32_t output_count)
{
    dmb_state_space *found = NULL;
    model m = {.info = dmb_state_space_info_default()};
    must(s, dmb_analysis_state_space(s->sim, options, inputs, input_count, outputs, output_count, &found));
    assert_int_equal(dmb_state_space_get_info(found, &m.info), DMB_OK);
    const size_t n = m.info.states;
    m.A = matrix(found, DMB_MATRIX_A, n, n);
    m.B = matrix(found, DMB_MATRIX_B, n, input_count);
    m.C = matrix(found, DMB_MATRIX_C, output_count, n);
    m.D = matrix(found, DMB_MATRIX_D, output_count, input_count);
    dmb_state_space_destroy(&found);
    return m;
}

static void discard(model *m)
{
    free(m->A), free(m->B), free(m->C), free(m->D);
}

/* x <- (s I - A)^-1 x */
static void solve(const model *m, double complex s, double complex *x)
{
    const size_t n = m->info.states;
    double complex *W = malloc(n * n * sizeof *W);
    for (size_t i = 0; i < n * n; i++) W[i] = -m->A[i];
    for (size_t i = 0; i < n; i++) W[n * i + i] += s;
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        for (size_t i = k + 1; i < n; i++)
            if (cabs(W[n * i + k]) > cabs(W[n * pivot + k])) pivot = i;
        for (size_t j = k; j < n && pivot != k; j++) {
            const double complex kept = W[n * k + j];
            W[n * k + j] = W[n * pivot + j];
            W[n * pivot + j] = kept;
        }
        const double complex kept = x[k];
        x[k] = x[pivot];
        x[pivot] = kept;
        for (size_t i = k + 1; i < n; i++) {
            const double complex f = W[n * i + k] / W[n * k + k];
            if (f == 0.0) continue;
            for (size_t j = k + 1; j < n; j++) W[n * i + j] -= f * W[n * k + j];
            x[i] -= f * x[k];
        }
    }
    for (size_t i = n; i-- > 0;) {
        for (size_t j = i + 1; j < n; j++) x[i] -= W[n * i + j] * x[j];
        x[i] /= W[n * i + i];
    }
    free(W);
}

/* C (s I - A)^-1 B + D of one input, all outputs. */
static void transfer_of(const model *m, double frequency, uint32_t input, double complex *values)
{
    const size_t n = m->info.states, inputs = m->info.inputs;
    double complex *x = malloc((n + 1) * sizeof *x);
    for (size_t i = 0; i < n; i++) x[i] = m->B[inputs * i + input];
    solve(m, 2.0 * PI * frequency * i_, x);
    for (size_t k = 0; k < m->info.outputs; k++) {
        values[k] = m->D[inputs * k + input];
        for (size_t i = 0; i < n; i++) values[k] += m->C[n * k + i] * x[i];
    }
    free(x);
}

/* Largest difference to the frequency response, over the largest value of each transfer function. */
static double against_response(const rig *s, const model *m, const dmb_response_options *about,
                               const dmb_excitation *inputs, const dmb_output *outputs, const double *frequencies,
                               uint32_t points)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < m->info.inputs; i++) {
        double complex got[8][16], want[8][16];
        for (uint32_t p = 0; p < points; p++) transfer_of(m, frequencies[p], i, got[p]);
        for (uint32_t k = 0; k < m->info.outputs; k++) {
            double complex response[8];
            double size = 1e-300;
            transfer(s, about, inputs + i, outputs + k, frequencies, points, response);
            for (uint32_t p = 0; p < points; p++) want[p][k] = response[p], size = fmax(size, cabs(response[p]));
            for (uint32_t p = 0; p < points; p++) {
                const double off = cabs(got[p][k] - want[p][k]) / size;
                worst = fmax(worst, off);
            }
        }
    }
    return worst;
}

static const double frequencies[5] = {0.5, 7.0, 21.0, 60.0, 200.0};

/* ---- A string on its wall ---------------------------------------------------------------------------------------- */

typedef struct string_rig {
    rig s;
    dmb_id string, feed, turn, load, bit;
    dmb_id setting[5]; /* of feed, turn, load, bit, friction */
} string_rig;

/* Inputs of all that a string has; a motion drive's keeps to a rate. */
static void add_settings(string_rig *r, int moved)
{
    static const char *const names[5] = {"feed", "turn", "load", "bit", "friction"};
    const int32_t targets[5] = {DMB_TARGET_SET_POINT, DMB_TARGET_SET_POINT, DMB_TARGET_LOAD_FACTOR, DMB_TARGET_BIT_LOAD,
                                DMB_TARGET_FRICTION};
    const dmb_id parts[5] = {r->feed, r->turn, r->load, r->bit, {0, 0}};
    for (int i = 0; i < 5; i++) {
        dmb_input_def def = dmb_input_def_default();
        strcpy(def.name, names[i]);
        def.target = targets[i];
        def.part = parts[i];
        def.low = i == 4 ? 0.0 : def.low;
        def.rate_limit = i == !moved ? 100.0 : 0.0;
        must_model(&r->s, dmb_model_add_input(r->s.model, &def, &r->setting[i]));
    }
}

/* Fed by a controller or by motion, turned by motion or by a controller; a load and a bit at its end; with inputs or
 * without. */
static string_rig open_string_with(int32_t kind, int moved, uint32_t pipes, double load_at, int settable)
{
    const dmb_segment step = {
        .struct_size = sizeof step, .kind = DMB_SEGMENT_STEP, .x0 = 0.0, .x1 = load_at, .h1 = 1.0};
    string_rig r;
    dmb_wall_def hole = s1_hole();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    rig_open(&r.s, 0.0, 0.0, -9.81);
    hole.normal_law = DMB_NORMAL_KELVIN_VOIGT;
    hole.damping = 3e3;
    hole.friction_law = DMB_FRICTION_COULOMB;
    hole.smoothing_speed = 1e-2;
    add_wall(&r.s, &hole);
    def.start_free = DMB_FREE_CYLINDRICAL;
    pipe.kind = kind;
    pipe.damping_time = 1e-3;
    r.string = add_string(&r.s, &def);
    pipe.string = r.string;
    add_pipes(&r.s, &pipe, pipes);
    must_model(&r.s, dmb_model_add_bit(r.s.model, &bit, &r.bit));
    drive.time_function = add_constant(&r.s, 0.0);
    drive.part = r.string;
    drive.gain = 3e3;
    drive.integral_gain = 2e5;
    drive.kind = moved ? DMB_DRIVE_MOTION : DMB_DRIVE_CONTROL;
    r.feed = add_drive(&r.s, &drive);
    drive.component = DMB_RX;
    drive.gain = 20.0;
    drive.integral_gain = 400.0;
    drive.kind = moved ? DMB_DRIVE_CONTROL : DMB_DRIVE_MOTION;
    r.turn = add_drive(&r.s, &drive);
    load.place = dmb_station(r.string, pipes - 1, 1.0);
    load.frame = DMB_FRAME_BODY;
    load.force[0] = 30.0;
    load.moment[0] = 2.0;
    load.time_function = load_at > 0.0 ? add_time_function(&r.s, &step, 1) : add_constant(&r.s, 0.0);
    r.load = add_load(&r.s, &load);
    if (settable) add_settings(&r, moved);
    rig_start(&r.s, NULL);
    find_equilibrium(&r.s, NULL);
    return r;
}

static string_rig open_string(int32_t kind, int moved, uint32_t pipes, double load_at)
{
    return open_string_with(kind, moved, pipes, load_at, 0);
}

static dmb_output reading_at(dmb_id string, uint32_t pipe, double fraction, int32_t quantity)
{
    return output_at(quantity, dmb_station(string, pipe, fraction), 0);
}

static void transfer_of_a_string(void **state)
{
    (void)state;
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_AXIAL_TORSIONAL; kind++)
        for (int moved = 0; moved < 2; moved++)
            for (int motion = 0; motion < 2; motion++) {
                string_rig r = open_string(kind, moved, 6, 0.0);
                dmb_state_space_options options = dmb_state_space_options_default();
                const dmb_excitation inputs[4] = {
                    input_of(DMB_EXCITATION_DRIVE, r.feed, DMB_X), input_of(DMB_EXCITATION_DRIVE, r.turn, DMB_X),
                    input_of(DMB_EXCITATION_LOAD, r.load, DMB_X), force_at(dmb_station(r.string, 3, 0.5), DMB_X)};
                const dmb_place none = dmb_station((dmb_id){0, 0}, 4, 0.0);
                const dmb_output outputs[9] = {
                    reading_at(r.string, 0, 0.0, DMB_OUTPUT_BIT_SPEED),
                    reading_at(r.string, 2, 0.5, DMB_OUTPUT_SECTION_STRAIN),
                    output_at(DMB_OUTPUT_VIBRATION_VELOCITY, dmb_station(r.string, 5, 1.0), DMB_X),
                    output_at(DMB_OUTPUT_VIBRATION, dmb_station(r.string, 3, 1.0), DMB_RX),
                    output_at(DMB_OUTPUT_CONTACT_FRICTION_AXIAL, none, 0),
                    output_at(DMB_OUTPUT_DRIVE_FORCE, dmb_station(moved ? r.turn : r.feed, 0, 0.0), 0),
                    reading_at(r.string, 0, 0.0, DMB_OUTPUT_HOOK_LOAD),
                    output_at(DMB_OUTPUT_DRIVE_FORCE, dmb_station(moved ? r.feed : r.turn, 0, 0.0), 0),
                    output_at(DMB_OUTPUT_REACTION, dmb_station(r.string, 0, 0.0), DMB_RX)};
                options.motion = motion;
                const uint32_t count = motion == DMB_MOTION_SPEED ? 6 : 9;
                model m = space_of(&r.s, &options, inputs, 4, outputs, count);
                if (motion == DMB_MOTION_ACCELERATION) /* u = i w times the speed */
                    for (uint32_t i = 0; i < 2; i++)
                        if (moved == (i == 0)) {
                            double worst = 0.0;
                            for (int p = 0; p < 5; p++) {
                                double complex got[16], want;
                                transfer_of(&m, frequencies[p], i, got);
                                for (uint32_t k = 0; k < count; k++) {
                                    transfer(&r.s, NULL, inputs + i, outputs + k, frequencies + p, 1, &want);
                                    got[k] *= 2.0 * PI * frequencies[p] * i_;
                                    if (cabs(want) > 1e-9) worst = fmax(worst, cabs(got[k] - want) / cabs(want));
                                }
                            }
                            check_below("acceleration of a drive: against the response", worst, 1e-6);
                        }
                dmb_excitation forces[4];
                model n;
                memcpy(forces, inputs, sizeof forces);
                forces[moved ? 0 : 1] = inputs[2];
                n = space_of(&r.s, &options, motion ? forces : inputs, 4, outputs, count);
                check_below("a string: against the frequency response",
                            against_response(&r.s, &n, NULL, motion ? forces : inputs, outputs, frequencies, 5), 1e-9);
                assert_int_equal(m.info.states, 2 * m.info.coordinates + m.info.input_states);
                assert_int_equal(m.info.input_states, motion ? 3 : 2);
                discard(&m);
                discard(&n);
                rig_close(&r.s);
            }
}

/* Rings, contact points along elements, a stuck place and mud at once. */
static void transfer_of_a_crowded_string(void **state)
{
    (void)state;
    rig s;
    crowded_string c = crowded_string_default();
    rig_open(&s, 0.0, 0.0, -9.81);
    add_crowded_string(&s, &c);
    rig_start(&s, NULL);
    find_equilibrium(&s, NULL);
    const dmb_excitation inputs[2] = {input_of(DMB_EXCITATION_DRIVE, c.drive, DMB_X),
                                      force_at(dmb_station(c.string, 1, 0.35), DMB_Z)};
    const dmb_output outputs[3] = {output_at(DMB_OUTPUT_VIBRATION, dmb_station(c.string, 2, 0.5), DMB_Z),
                                   output_at(DMB_OUTPUT_VIBRATION_VELOCITY, dmb_station(c.string, 1, 0.35), DMB_RX),
                                   reading_at(c.string, 3, 0.2, DMB_OUTPUT_TORQUE)};
    model m = space_of(&s, NULL, inputs, 2, outputs, 3);
    check_below("a crowded string: against the frequency response",
                against_response(&s, &m, NULL, inputs, outputs, frequencies, 5), 1e-9);
    discard(&m);
    rig_close(&s);
}

/* Forces beside a motion drive feel its acceleration: refused for its speed. */
static void rate_is_refused(void **state)
{
    (void)state;
    string_rig r = open_string(DMB_PIPE_FLEXIBLE, 1, 3, 0.0);
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, r.feed, DMB_X);
    const dmb_output output = output_at(DMB_OUTPUT_DRIVE_FORCE, dmb_station(r.feed, 0, 0.0), 0);
    dmb_state_space *space = NULL;
    assert_int_equal(dmb_analysis_state_space(r.s.sim, NULL, &input, 1, &output, 1, &space), DMB_ERR_UNSUPPORTED);
    assert_null(space);
    assert_non_null(strstr(dmb_sim_message(r.s.sim), "DMB_MOTION_ACCELERATION"));
    rig_close(&r.s);
}

/* ---- Modes ------------------------------------------------------------------------------------------------------- */

/* The eigenvalue of A nearest to s by inverse iteration. */
static double complex nearest_root(const model *m, double complex s)
{
    const size_t n = m->info.states;
    double complex *x = malloc(n * sizeof *x), *y = malloc(n * sizeof *y), root = s;
    for (size_t i = 0; i < n; i++) x[i] = 1.0 + 0.3 * (double)(i % 7);
    for (int k = 0; k < 6; k++) {
        double complex xy = 0.0, xx = 0.0;
        double size = 0.0;
        memcpy(y, x, n * sizeof *x);
        solve(m, s * (1.0 + 1e-5), y);
        for (size_t i = 0; i < n; i++)
            xy += conj(y[i]) * x[i], xx += conj(y[i]) * y[i], size += cabs(y[i]) * cabs(y[i]);
        root = s * (1.0 + 1e-5) - xy / xx;
        for (size_t i = 0; i < n; i++) x[i] = y[i] / sqrt(size);
    }
    free(x), free(y);
    return root;
}

static void roots_are_modes(void **state)
{
    (void)state;
    string_rig r = open_string(DMB_PIPE_FLEXIBLE, 0, 5, 0.0);
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    options.kind = DMB_MODES_DAMPED;
    options.count = 16;
    must(&r.s, dmb_analysis_modes(r.s.sim, &options, &modes));
    model m = space_of(&r.s, NULL, NULL, 0, NULL, 0);
    double worst = 0.0;
    for (uint32_t i = 0; i < 16; i++) {
        dmb_mode mode = dmb_mode_default();
        assert_int_equal(dmb_modes_get(modes, i, &mode), DMB_OK);
        const double complex s = mode.eigenvalue[0] + i_ * mode.eigenvalue[1];
        worst = fmax(worst, cabs(nearest_root(&m, s) - s) / cabs(s));
    }
    check_below("eigenvalues of A against damped modes", worst, 1e-6);
    dmb_modes_destroy(&modes);
    discard(&m);
    rig_close(&r.s);
}

/* A rotor on springs of a joint that spins: gyroscopic terms, unsymmetric axes. */
static void gyroscopic(void **state)
{
    (void)state;
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    body.mass = 20.0;
    body.inertia[0] = 1.2;
    body.inertia[1] = body.inertia[2] = 0.7;
    body.velocity[3] = 60.0;
    const dmb_id id = add_body(&s, &body);
    joint.kind = DMB_JOINT_FREE;
    joint.place_b = dmb_station(id, 0, 0.0);
    joint.stiffness[DMB_X] = joint.stiffness[DMB_Y] = joint.stiffness[DMB_Z] = 4e5;
    joint.damping[DMB_X] = 30.0;
    add_joint(&s, &joint);
    rig_start(&s, NULL);
    const dmb_place centre = dmb_station(id, 0, 0.0);
    dmb_excitation inputs[2] = {force_at(centre, DMB_Y), force_at(centre, DMB_RY)};
    dmb_output outputs[3] = {output_at(DMB_OUTPUT_VIBRATION, centre, DMB_Y),
                             output_at(DMB_OUTPUT_VIBRATION_VELOCITY, centre, DMB_RZ),
                             output_at(DMB_OUTPUT_VIBRATION_ACCELERATION, centre, DMB_Z)};
    for (int i = 0; i < 2; i++) inputs[i].frame = DMB_FRAME_BODY;
    for (int i = 0; i < 3; i++) outputs[i].quantity += DMB_OUTPUT_VIBRATION_BODY - DMB_OUTPUT_VIBRATION;
    model m = space_of(&s, NULL, inputs, 2, outputs, 3);
    check_below("a spinning rotor: against the response",
                against_response(&s, &m, NULL, inputs, outputs, frequencies, 5), 1e-9);
    discard(&m);
    rig_close(&s);
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

/* Two pipes hang on a hinge that is driven, with a body on a spring joint at their end. */
typedef struct jointed {
    rig s;
    dmb_id string, hinge, slider, body, drive;
} jointed;

static jointed open_jointed(int32_t drive_kind)
{
    jointed r;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    rig_open(&r.s, 0.0, 0.0, 0.0);
    def.start_free = DMB_FREE_ALL;
    pipe.damping_time = 1e-3;
    r.string = add_string(&r.s, &def);
    pipe.string = r.string;
    add_pipes(&r.s, &pipe, 2);
    body.position[0] = 3.0;
    body.mass = 8.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.2;
    r.body = add_body(&r.s, &body);
    dmb_joint_def hinge =
        joint_between(DMB_JOINT_REVOLUTE, dmb_station((dmb_id){0, 0}, 0, 0.0), dmb_station(r.string, 0, 0.0));
    hinge.axis_a[0] = hinge.axis_b[0] = 0.0;
    hinge.axis_a[1] = hinge.axis_b[1] = 1.0;
    r.hinge = add_joint(&r.s, &hinge);
    dmb_joint_def slider =
        joint_between(DMB_JOINT_PRISMATIC, dmb_station(r.string, 1, 1.0), dmb_station(r.body, 0, 0.0));
    slider.axis_a[0] = slider.axis_b[0] = 0.0;
    slider.axis_a[2] = slider.axis_b[2] = 1.0;
    slider.stiffness[DMB_X] = 2e4;
    slider.damping[DMB_X] = 50.0;
    r.slider = add_joint(&r.s, &slider);
    drive.kind = drive_kind;
    drive.part = r.hinge;
    drive.component = DMB_RX;
    drive.gain = 200.0;
    drive.integral_gain = 3e4;
    drive.time_function = add_constant(&r.s, 0.0);
    r.drive = add_drive(&r.s, &drive);
    rig_start(&r.s, NULL);
    return r;
}

static void joints(void **state)
{
    (void)state;
    for (int32_t kind = DMB_DRIVE_MOTION; kind <= DMB_DRIVE_CONTROL; kind++) {
        jointed r = open_jointed(kind);
        if (kind == DMB_DRIVE_LOAD) {
            rig_close(&r.s);
            continue; /* nothing would hold it */
        }
        const dmb_excitation inputs[2] = {force_at(dmb_station(r.string, 0, 0.5), DMB_Z),
                                          input_of(DMB_EXCITATION_DRIVE, r.drive, DMB_X)};
        const dmb_output outputs[6] = {output_at(DMB_OUTPUT_JOINT_SPEED, dmb_station(r.slider, 0, 0.0), DMB_X),
                                       output_at(DMB_OUTPUT_JOINT_POSITION, dmb_station(r.hinge, 0, 0.0), DMB_RX),
                                       output_at(DMB_OUTPUT_JOINT_ACTION, dmb_station(r.slider, 0, 0.0), DMB_X),
                                       output_at(DMB_OUTPUT_JOINT_REACTION, dmb_station(r.hinge, 0, 0.0), DMB_Z),
                                       output_at(DMB_OUTPUT_MULTIPLIER, dmb_station(r.slider, 0, 0.0), 1),
                                       output_at(DMB_OUTPUT_DRIVE_FORCE, dmb_station(r.drive, 0, 0.0), 0)};
        model force = space_of(&r.s, NULL, inputs, 1, outputs, 6);
        check_below("joints: a force against the response",
                    against_response(&r.s, &force, NULL, inputs, outputs, frequencies, 5), 1e-6);
        const uint32_t count = kind == DMB_DRIVE_MOTION ? 3 : 6;
        model both = space_of(&r.s, NULL, inputs, 2, outputs, count);
        check_below("    with the drive of a joint",
                    against_response(&r.s, &both, NULL, inputs, outputs, frequencies, 5), 1e-6);
        discard(&force);
        discard(&both);
        rig_close(&r.s);
    }
}

/* A body that slides by its free_mask and one that a joint lets slide: one transfer function. */
static void joint_or_support(void **state)
{
    (void)state;
    double complex values[2][5];
    for (int jointed_ = 0; jointed_ < 2; jointed_++) {
        dmb_body_def body = dmb_body_def_default();
        dmb_drive_def drive = dmb_drive_def_default();
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        body.mass = 7.0;
        for (int i = 0; i < 3; i++) body.inertia[i] = 0.1;
        if (!jointed_) body.free_mask = DMB_FREE_X;
        drive.part = add_body(&s, &body);
        const dmb_id id = drive.part;
        if (jointed_)
            drive.part = add_joint_between(&s, DMB_JOINT_PRISMATIC, dmb_station((dmb_id){0, 0}, 0, 0.0),
                                           dmb_station(id, 0, 0.0));
        drive.kind = DMB_DRIVE_CONTROL;
        drive.gain = 60.0;
        drive.integral_gain = 5e3;
        drive.time_function = add_constant(&s, 0.0);
        const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, add_drive(&s, &drive), DMB_X);
        rig_start(&s, NULL);
        const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, dmb_station(id, 0, 0.0), DMB_X);
        model m = space_of(&s, NULL, &input, 1, &output, 1);
        assert_int_equal(m.info.states, 3);
        for (int p = 0; p < 5; p++) {
            const double w = 2.0 * PI * frequencies[p];
            const double complex f = 60.0 + 5e3 / (i_ * w);
            transfer_of(&m, frequencies[p], 0, values[jointed_] + p);
            check_below("    against the closed form", cabs(values[jointed_][p] * (i_ * w * f - 7.0 * w * w) / f - 1.0),
                        1e-9);
        }
        discard(&m);
        rig_close(&s);
    }
    for (int p = 0; p < 5; p++)
        check_below("sliding by a joint or a support", cabs(values[0][p] - values[1][p]) / cabs(values[0][p]), 1e-10);
}

/* ---- Reduced, and in time ---------------------------------------------------------------------------------------- */

/* Trapezoidal steps of x' = A x + B u, u a ramp 3 D^2 - 2 D^3 over 0 .. rise, or 1 from the start. */
static double simulate(const model *m, double rise, double end, uint32_t steps)
{
    const size_t n = m->info.states;
    const double h = end / steps;
    double complex *x = calloc(n, sizeof *x);
    double y = 0.0;
    for (uint32_t k = 0; k < steps; k++) {
        double u[2];
        for (uint32_t e = 0; e < 2; e++) {
            const double D = rise > 0.0 ? fmin((k + e) * h / rise, 1.0) : 1.0;
            u[e] = D * D * (3.0 - 2.0 * D);
        }
        double complex *f = calloc(n, sizeof *f); /* (2/h) x + A x + B (u0 + u1) */
        for (size_t i = 0; i < n; i++) {
            f[i] = 2.0 / h * x[i] + m->B[i] * (u[0] + u[1]);
            for (size_t j = 0; j < n; j++) f[i] += m->A[n * i + j] * x[j];
        }
        solve(m, 2.0 / h, f);
        memcpy(x, f, n * sizeof *x);
        free(f);
        y = m->D[0] * u[1];
        for (size_t i = 0; i < n; i++) y += m->C[i] * creal(x[i]);
    }
    free(x);
    return y;
}

/* A load steps up at the end of an axial-torsional string: bit speed by the run and by both models. */
static void in_time(void **state)
{
    (void)state;
    const double rise = 0.02, end = 0.012;
    string_rig still = open_string(DMB_PIPE_AXIAL_TORSIONAL, 0, 12, 0.0);
    string_rig run = open_string(DMB_PIPE_AXIAL_TORSIONAL, 0, 12, rise);
    dmb_modes_options lowest = dmb_modes_options_default();
    dmb_state_space_options options = dmb_state_space_options_default();
    dmb_modes *modes = NULL;
    const dmb_excitation input = input_of(DMB_EXCITATION_LOAD, still.load, DMB_X);
    for (int which = 0; which < 2; which++) {
        const int32_t quantity = which ? DMB_OUTPUT_BIT_SPEED : DMB_OUTPUT_POSITION_X;
        const dmb_output output = reading_at(still.string, which ? 0 : 11, which ? 0.0 : 1.0, quantity);
        const dmb_output reading = {dmb_station(run.string, which ? 0 : 11, which ? 0.0 : 1.0), quantity, 0};
        double before, after;
        model full = space_of(&still.s, NULL, &input, 1, &output, 1);
        lowest.count = 10;
        must(&still.s, dmb_analysis_modes(still.s.sim, &lowest, &modes));
        options.form = DMB_STATE_REDUCED;
        options.modes = modes;
        model reduced = space_of(&still.s, &options, &input, 1, &output, 1);
        assert_int_equal(reduced.info.coordinates, 11);
        assert_int_equal(reduced.info.mode_shapes, 10);
        dmb_modes_destroy(&modes);
        dmb_output at_rest = reading;
        at_rest.place.part = still.string;
        must(&still.s, dmb_query_output(still.s.sim, &at_rest, &before));
        if (which == 0) take_steps(&run.s, 5e-5, (uint32_t)(end / 5e-5 + 0.5));
        must(&run.s, dmb_query_output(run.s.sim, &reading, &after));
        const double by_full = simulate(&full, rise, end, 500), by_reduced = simulate(&reduced, rise, end, 500);
        tell("change of the output", after - before);
        check_relative("    by all coordinates", by_full, after - before, 2e-3);
        check_relative("    by ten modes and a quasi-static shape", by_reduced, after - before, 1e-2);
        discard(&full);
        discard(&reduced);
    }
    rig_close(&still.s);
    rig_close(&run.s);
}

/* ---- Inputs of control.h ----------------------------------------------------------------------------------------- */

/* Each is, bit for bit, the drive, load or bit that it moves. */
static void settings_are_their_parts(void **state)
{
    (void)state;
    for (int moved = 0; moved < 2; moved++) {
        string_rig r = open_string_with(DMB_PIPE_FLEXIBLE, moved, 4, 0.0, 1);
        const dmb_id parts[4] = {r.feed, r.turn, r.load, r.bit};
        const int32_t kinds[4] = {DMB_EXCITATION_DRIVE, DMB_EXCITATION_DRIVE, DMB_EXCITATION_LOAD,
                                  DMB_EXCITATION_BIT_LOAD};
        dmb_state_space_options options = dmb_state_space_options_default();
        dmb_excitation by_part[4], by_setting[4];
        const dmb_output outputs[2] = {reading_at(r.string, 0, 0.0, DMB_OUTPUT_BIT_SPEED),
                                       reading_at(r.string, 0, 0.0, DMB_OUTPUT_WEIGHT_ON_BIT)};
        for (int i = 0; i < 4; i++) {
            by_part[i] = input_of(kinds[i], parts[i], DMB_X);
            by_setting[i] = input_of(DMB_EXCITATION_SETTING, r.setting[i], DMB_X);
        }
        options.motion = DMB_MOTION_ACCELERATION;
        model a = space_of(&r.s, &options, by_part, 4, outputs, 2),
              b = space_of(&r.s, &options, by_setting, 4, outputs, 2);
        const size_t n = a.info.states;
        double size = 0.0;
        assert_int_equal(n, b.info.states);
        for (size_t i = 0; i < 4 * n; i++) size = fmax(size, fabs(a.B[i]));
        assert_true(size > 0.0 && n > 0);
        check_close("A", largest_difference(n * n, a.A, b.A), 0.0, 0.0);
        check_close("B", largest_difference(n * 4, a.B, b.B), 0.0, 0.0);
        check_close("C", largest_difference(2 * n, a.C, b.C), 0.0, 0.0);
        check_close("D", largest_difference(8, a.D, b.D), 0.0, 0.0);
        discard(&a);
        discard(&b);
        rig_close(&r.s);
    }
}

/* A small step of one input in a run against the state space: the far end, and the bit load's own output. */
static void step_of_a_setting(void **state)
{
    (void)state;
    static const double steps[4] = {1e-4, 1e-3, 0.01, 0.5}; /* [m/s], [rad/s], [-], [N] */
    const double end = 0.012;
    for (int i = 0; i < 4; i++) {
        const int moved = i == 1;
        string_rig r = open_string_with(DMB_PIPE_AXIAL_TORSIONAL, moved, 12, 0.0, 1);
        const int32_t quantity = i == 1 ? DMB_OUTPUT_ROTATION : DMB_OUTPUT_POSITION_X;
        const uint32_t pipe = i < 2 ? 2 : 11; /* drives push the rig end, the others the far end */
        const dmb_excitation input = input_of(DMB_EXCITATION_SETTING, r.setting[i], DMB_X);
        const dmb_output output = reading_at(r.string, pipe, 1.0, quantity);
        const dmb_output reading = {output.place, quantity, 0};
        double before, after;
        model m = space_of(&r.s, NULL, &input, 1, &output, 1);
        must(&r.s, dmb_query_output(r.s.sim, &reading, &before));
        must(&r.s, dmb_sim_set_input(r.s.sim, r.setting[i], steps[i]));
        take_steps(&r.s, 2.5e-5, (uint32_t)(end / 2.5e-5 + 0.5));
        must(&r.s, dmb_query_output(r.s.sim, &reading, &after));
        tell("change of the output", after - before);
        check_relative("    by the state space", steps[i] * simulate(&m, 0.0, end, 500), after - before, 1e-5);
        discard(&m);
        rig_close(&r.s);
    }
}

/* The torque of a load drive on a disc with a torsion spring and a damper, as an input: I x'' + c x' + k x = u. */
static void step_of_a_load_drive(void **state)
{
    (void)state;
    const double I = 2.0, c = 1.5, k = 50.0, end = 0.7, u = 0.3;
    rig s;
    dmb_body_def body = dmb_body_def_default();
    dmb_input_def def = dmb_input_def_default();
    dmb_id input;
    double before, after;
    rig_open(&s, 0.0, 0.0, 0.0);
    body.mass = 1.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = I;
    const dmb_id disc = add_body(&s, &body);
    dmb_joint_def joint =
        joint_between(DMB_JOINT_REVOLUTE, dmb_station((dmb_id){0, 0}, 0, 0.0), dmb_station(disc, 0, 0.0));
    joint.stiffness[DMB_RX] = k;
    joint.damping[DMB_RX] = c;
    const dmb_id hinge = add_joint(&s, &joint);
    def.part = add_simple_drive(&s, DMB_DRIVE_LOAD, hinge, DMB_RX, add_constant(&s, 0.0));
    strcpy(def.name, "torque");
    must_model(&s, dmb_model_add_input(s.model, &def, &input));
    rig_start(&s, NULL);
    const dmb_excitation asked = input_of(DMB_EXCITATION_SETTING, input, DMB_X);
    const dmb_output output = reading_at(hinge, 0, 0.0, DMB_OUTPUT_JOINT_POSITION + DMB_RX);
    model m = space_of(&s, NULL, &asked, 1, &output, 1);
    must(&s, dmb_query_output(s.sim, &output, &before));
    must(&s, dmb_sim_set_input(s.sim, input, u));
    take_steps(&s, 1e-3, 700);
    must(&s, dmb_query_output(s.sim, &output, &after));
    const double d = c / (2.0 * I), w = sqrt(k / I - d * d);
    const double want = u / k * (1.0 - exp(-d * end) * (cos(w * end) + d / w * sin(w * end)));
    check_relative("a load drive: the state space in steps", u * simulate(&m, 0.0, end, 2000), want, 1e-5);
    check_relative("    the run", after - before, want, 1e-5);
    discard(&m);
    rig_close(&s);
}

static void refused(const rig *s, const dmb_state_space_options *o, const dmb_excitation *input,
                    const dmb_output *output, int32_t status, const char *says);

static void settings_refused(void **state)
{
    (void)state;
    string_rig r = open_string_with(DMB_PIPE_FLEXIBLE, 0, 3, 0.0, 1);
    const dmb_output output = reading_at(r.string, 0, 0.0, DMB_OUTPUT_BIT_SPEED);
    dmb_excitation input = input_of(DMB_EXCITATION_SETTING, r.setting[4], DMB_X);
    refused(&r.s, NULL, &input, &output, DMB_ERR_UNSUPPORTED, "input \"friction\" has target 7");
    input.place.part = r.feed;
    refused(&r.s, NULL, &input, &output, DMB_ERR_ID, "names no input of control.h");
    input.place.part = r.setting[1];
    must(&r.s, dmb_sim_set_input(r.s.sim, r.setting[1], 1e-6));
    refused(&r.s, NULL, &input, &output, DMB_ERR_VALUE, "on its way");
    input.kind = DMB_EXCITATION_SETTING + 1;
    refused(&r.s, NULL, &input, &output, DMB_ERR_VALUE, "kind");
    rig_close(&r.s);
}

/* With quasi-static shapes the answer at frequency 0 is exact however few the modes; without them it is not. */
static void static_correction(void **state)
{
    (void)state;
    string_rig r = open_string(DMB_PIPE_FLEXIBLE, 0, 6, 0.0);
    dmb_modes_options lowest = dmb_modes_options_default();
    dmb_state_space_options options = dmb_state_space_options_default();
    dmb_modes *modes = NULL;
    const int32_t chosen[3] = {0, 2, 3};
    const dmb_excitation inputs[2] = {force_at(dmb_station(r.string, 5, 1.0), DMB_X),
                                      input_of(DMB_EXCITATION_DRIVE, r.turn, DMB_X)};
    const dmb_output outputs[2] = {output_at(DMB_OUTPUT_VIBRATION, dmb_station(r.string, 4, 0.5), DMB_X),
                                   output_at(DMB_OUTPUT_VIBRATION, dmb_station(r.string, 4, 0.5), DMB_RX)};
    const double slow = 1e-3;
    double off[2];
    lowest.count = 4;
    lowest.kind = DMB_MODES_DAMPED; /* complex shapes: two real ones each */
    must(&r.s, dmb_analysis_modes(r.s.sim, &lowest, &modes));
    options.form = DMB_STATE_REDUCED;
    options.modes = modes;
    options.mode_list = chosen;
    options.mode_count = 3;
    for (int correct = 0; correct < 2; correct++) {
        options.static_correction = correct;
        model m = space_of(&r.s, &options, inputs, 2, outputs, 2);
        off[correct] = 0.0;
        for (uint32_t i = 0; i < 2; i++) {
            double complex got[2], want;
            transfer_of(&m, slow, i, got);
            transfer(&r.s, NULL, inputs + i, outputs + i, &slow, 1, &want);
            off[correct] = fmax(off[correct], cabs(got[i] - want) / cabs(want));
        }
        assert_true(m.info.mode_shapes >= 3 && m.info.mode_shapes <= 6);
        discard(&m);
    }
    check_below("static answers with quasi-static shapes", off[1], 1e-6);
    tell("    without", off[0]);
    assert_true(off[0] > 1e-4);
    dmb_modes_destroy(&modes);
    rig_close(&r.s);
}

/* ---- Sparse matrices and arrays ---------------------------------------------------------------------------------- */

typedef struct triplets {
    uint64_t count;
    uint32_t *rows, *columns;
    double *values;
} triplets;

static triplets sparse(const dmb_state_space *s, int32_t which)
{
    triplets t;
    assert_int_equal(dmb_state_space_sparse(s, which, NULL, NULL, NULL, &t.count), DMB_OK);
    t.rows = calloc(t.count + 1, sizeof *t.rows);
    t.columns = calloc(t.count + 1, sizeof *t.columns);
    t.values = calloc(t.count + 1, sizeof *t.values);
    uint64_t room = t.count > 0 ? t.count - 1 : 0;
    if (t.count > 0)
        assert_int_equal(dmb_state_space_sparse(s, which, t.rows, t.columns, t.values, &room), DMB_ERR_VALUE);
    assert_int_equal(dmb_state_space_sparse(s, which, t.rows, t.columns, t.values, &t.count), DMB_OK);
    return t;
}

static void release(triplets *t)
{
    free(t->rows), free(t->columns), free(t->values);
}

static double *array(const rig *s, int32_t which, uint64_t *count)
{
    must(s, dmb_analysis_array(s->sim, which, NULL, count));
    double *values = calloc(*count + 1, sizeof *values);
    must(s, dmb_analysis_array(s->sim, which, values, count));
    return values;
}

/* Shapes of all coordinates are unit motions; those of a basis are orthonormal in M, and stretch K as A says. */
static void shapes_of_the_coordinates(void **state)
{
    (void)state;
    string_rig r = open_string(DMB_PIPE_FLEXIBLE, 0, 3, 0.0);
    dmb_modes_options lowest = dmb_modes_options_default();
    dmb_state_space_options options = dmb_state_space_options_default();
    dmb_modes *modes = NULL;
    const dmb_excitation input = force_at(dmb_station(r.string, 2, 1.0), DMB_X);
    lowest.count = 4;
    must(&r.s, dmb_analysis_modes(r.s.sim, &lowest, &modes));
    for (int reduced = 0; reduced < 2; reduced++) {
        options.form = reduced ? DMB_STATE_REDUCED : DMB_STATE_FULL;
        options.modes = reduced ? modes : NULL;
        dmb_state_space *space = NULL;
        dmb_state_space_info info = dmb_state_space_info_default();
        must(&r.s, dmb_analysis_state_space(r.s.sim, &options, &input, 1, NULL, 0, &space));
        assert_int_equal(dmb_state_space_get_info(space, &info), DMB_OK);
        const size_t n = info.coordinates, rows = info.rows;
        double *shapes = calloc(n * rows, sizeof *shapes), *A = matrix(space, DMB_MATRIX_A, 2 * n, 2 * n);
        double worst[2] = {0.0, 0.0};
        assert_int_equal(dmb_state_space_shapes(space, shapes), DMB_OK);
        triplets M = sparse(space, DMB_MATRIX_MASS), K = sparse(space, DMB_MATRIX_STIFFNESS);
        for (size_t a = 0; a < n; a++)
            for (size_t b = 0; b < n; b++) {
                double mass = 0.0, stiff = 0.0, unit = 0.0;
                for (uint64_t i = 0; i < M.count; i++)
                    mass += shapes[rows * a + M.rows[i]] * M.values[i] * shapes[rows * b + M.columns[i]];
                for (uint64_t i = 0; i < K.count; i++)
                    stiff += shapes[rows * a + K.rows[i]] * K.values[i] * shapes[rows * b + K.columns[i]];
                for (size_t i = 0; i < rows; i++) unit += shapes[rows * a + i] * shapes[rows * b + i];
                const double same = reduced ? mass : unit;
                worst[0] = fmax(worst[0], fabs(same - (a == b)));
                if (reduced) worst[1] = fmax(worst[1], fabs(stiff + A[2 * n * (n + a) + b]) / fabs(A[2 * n * n]));
            }
        check_below(reduced ? "basis: orthonormal in M" : "unit motions", worst[0], reduced ? 1e-9 : 0.0);
        if (reduced) check_below("    stiffness, over the first one", worst[1], 1e-6);
        release(&M), release(&K);
        free(shapes);
        free(A);
        dmb_state_space_destroy(&space);
    }
    dmb_modes_destroy(&modes);
    rig_close(&r.s);
}

/* ---- Calls ---------------------------------------------------------------------------------------------------------
 */

static void numbers_of_matrices_and_handles(void **state)
{
    (void)state;
    string_rig r = open_string(DMB_PIPE_FLEXIBLE, 0, 3, 0.0);
    const dmb_excitation input = force_at(dmb_station(r.string, 2, 1.0), DMB_X);
    dmb_sim *none = (dmb_sim *)(void *)r.s.model;
    dmb_state_space *space = NULL;
    double values[24] = {7.0};
    uint32_t rows[24] = {7}, found = 7;
    uint64_t count = 7;
    const dmb_place place = dmb_station(r.string, 1, 0.5);
    assert_int_equal(dmb_analysis_state_space(none, NULL, &input, 1, NULL, 0, &space), DMB_ERR_HANDLE);
    assert_null(space);
    assert_int_equal(dmb_analysis_state_space(r.s.sim, NULL, NULL, 1, NULL, 0, &space), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_state_space(r.s.sim, NULL, NULL, 0, NULL, 1, &space), DMB_ERR_NULL);
    must(&r.s, dmb_analysis_state_space(r.s.sim, NULL, &input, 1, NULL, 0, &space));
    assert_int_equal(dmb_state_space_dense(space, DMB_MATRIX_A - 1, values), DMB_ERR_VALUE);
    assert_int_equal(dmb_state_space_dense(space, DMB_MATRIX_D + 1, values), DMB_ERR_VALUE);
    assert_int_equal(dmb_state_space_dense(space, DMB_MATRIX_A, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_state_space_shapes(space, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_state_space_shapes(NULL, values), DMB_ERR_NULL);
    assert_int_equal(dmb_state_space_shapes((dmb_state_space *)(void *)r.s.model, values), DMB_ERR_HANDLE);
    assert_int_equal(dmb_state_space_sparse(space, DMB_MATRIX_D, NULL, NULL, NULL, &count), DMB_ERR_VALUE);
    assert_int_equal(dmb_state_space_sparse(space, DMB_MATRIX_COORDINATES + 1, NULL, NULL, NULL, &count),
                     DMB_ERR_VALUE);
    assert_int_equal(dmb_state_space_sparse(space, DMB_MATRIX_MASS, rows, rows, NULL, &count), DMB_ERR_NULL);
    assert_int_equal(dmb_state_space_sparse(space, DMB_MATRIX_MASS, NULL, NULL, values, &count), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_array(none, DMB_ARRAY_VELOCITY, values, &count), DMB_ERR_HANDLE);
    assert_int_equal(dmb_analysis_array(r.s.sim, DMB_ARRAY_VELOCITY - 1, NULL, &count), DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_array(r.s.sim, DMB_ARRAY_RESIDUAL + 1, NULL, &count), DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_place_rows(none, place, DMB_FRAME_WORLD, DMB_X, rows, values, &found),
                     DMB_ERR_HANDLE);
    assert_int_equal(dmb_analysis_place_rows(r.s.sim, place, DMB_FRAME_HOLE, DMB_X, rows, values, &found),
                     DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_place_rows(r.s.sim, place, DMB_FRAME_WORLD, -1, rows, values, &found), DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_place_rows(r.s.sim, place, -1, DMB_X, rows, values, &found), DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_place_rows(r.s.sim, place, DMB_FRAME_BODY, 6, rows, values, &found), DMB_ERR_VALUE);
    assert_true(values[0] == 7.0 && rows[0] == 7 && count == 7 && found == 7);
    dmb_state_space_destroy(&space);
    rig_close(&r.s);
}

/* 350 pipes have 4200 states, more than the bound of dense matrices. */
static void more_states_than_the_bound(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_state_space *space = NULL;
    rig_open(&s, 0.0, 0.0, 0.0);
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 350);
    (void)rig_start(&s, NULL);
    assert_int_equal(dmb_analysis_state_space(s.sim, NULL, NULL, 0, NULL, 0, &space), DMB_ERR_TOO_LARGE);
    assert_null(space);
    assert_non_null(strstr(dmb_sim_message(s.sim), "4200 states, must be <= 4096"));
    rig_close(&s);
}

/* In a run: kinetic energy v M v/2, J v = 0, J R = 0, residual + J^T multiplier = 0 in rows that are free, positions,
 * and speeds of places by their rows. */
static void arrays(void **state)
{
    (void)state;
    jointed r = open_jointed(DMB_DRIVE_CONTROL);
    must(&r.s, dmb_sim_set_drive(r.s.sim, r.drive, 2.0));
    take_steps(&r.s, 1e-3, 40);
    dmb_state_space_options options = dmb_state_space_options_default();
    dmb_state_space *space = NULL;
    dmb_state_space_info info = dmb_state_space_info_default();
    uint64_t rows, count;
    options.form = DMB_STATE_MATRICES;
    must(&r.s, dmb_analysis_state_space(r.s.sim, &options, NULL, 0, NULL, 0, &space));
    assert_int_equal(dmb_state_space_get_info(space, &info), DMB_OK);
    triplets M = sparse(space, DMB_MATRIX_MASS), J = sparse(space, DMB_MATRIX_JACOBIAN),
             R = sparse(space, DMB_MATRIX_COORDINATES);
    double *v = array(&r.s, DMB_ARRAY_VELOCITY, &rows), *f = array(&r.s, DMB_ARRAY_RESIDUAL, &count);
    double *multipliers = array(&r.s, DMB_ARRAY_MULTIPLIER, &count), *x = array(&r.s, DMB_ARRAY_POSITION, &count);
    double *q = array(&r.s, DMB_ARRAY_QUATERNION, &count);
    double energy = 0.0, most = 0.0, scale = 0.0;
    assert_int_equal(rows, info.rows);
    assert_int_equal(info.constraint_rows, 10);
    for (uint64_t i = 0; i < M.count; i++) energy += 0.5 * v[M.rows[i]] * M.values[i] * v[M.columns[i]];
    check_relative("kinetic energy by the sparse mass", energy, energy_of(&r.s).kinetic, 1e-12);
    double Jv[16] = {0.0};
    for (uint64_t i = 0; i < J.count; i++) Jv[J.rows[i]] += J.values[i] * v[J.columns[i]];
    check_below("J v", largest(info.constraint_rows, Jv), 1e-9);
    double *JR = calloc((size_t)info.constraint_rows * info.independent, sizeof *JR);
    for (uint64_t i = 0; i < J.count; i++)
        for (uint64_t k = 0; k < R.count; k++)
            if (R.rows[k] == J.columns[i])
                JR[(size_t)J.rows[i] * info.independent + R.columns[k]] += J.values[i] * R.values[k];
    check_below("J R", largest((size_t)info.constraint_rows * info.independent, JR), 1e-9);
    for (uint64_t i = 0; i < rows; i++) scale = fmax(scale, fabs(f[i]));
    for (uint64_t i = 0; i < J.count; i++) f[J.columns[i]] += J.values[i] * multipliers[J.rows[i]];
    for (uint32_t i = 0; i < rows; i++) {
        dmb_row row = dmb_row_default();
        assert_int_equal(dmb_query_row(r.s.sim, i, &row), DMB_OK);
        if (row.state == DMB_ROW_FREE) most = fmax(most, fabs(f[i]));
    }
    tell("largest residual without forces of constraint [N]", scale);
    check_below("    with them", most, 1e-4 * scale);
    uint32_t at[24], used, first, held;
    double weight[24];
    for (int32_t c = DMB_X; c <= DMB_RZ; c++) {
        double sum = 0.0;
        const dmb_place place = dmb_station(r.string, 1, 0.37);
        must(&r.s, dmb_analysis_place_rows(r.s.sim, place, DMB_FRAME_WORLD, c, at, weight, &used));
        for (uint32_t i = 0; i < used; i++) sum += weight[i] * v[at[i]];
        check_close("    speed of a place by rows", sum, motion_at(&r.s, place, DMB_FRAME_WORLD).velocity[c], 1e-12);
    }
    assert_int_equal(dmb_query_constraint_rows(r.s.sim, r.slider, &first, &held), DMB_OK);
    double joint[6];
    uint32_t number;
    must(&r.s, dmb_query_multipliers(r.s.sim, r.slider, joint, &number));
    assert_int_equal(number, held);
    for (uint32_t i = 0; i < held; i++) assert_true(multipliers[first + i] == joint[i]);
    const dmb_pose pose = pose_at(&r.s, dmb_station(r.string, 0, 0.0));
    for (int i = 0; i < 3; i++) check_close("    position of the first node", x[i], pose.position[i], 1e-12);
    check_close("    unit quaternion", q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 1e-12);
    dmb_row row = dmb_row_default();
    assert_int_equal(dmb_query_row(r.s.sim, info.rows - 1, &row), DMB_OK);
    assert_true(row.part.index == r.body.index && row.component == DMB_RZ);
    assert_int_equal(dmb_query_row(r.s.sim, info.rows, &row), DMB_ERR_VALUE);
    free(v), free(f), free(multipliers), free(x), free(q), free(JR);
    release(&M), release(&J), release(&R);
    dmb_state_space_destroy(&space);
    rig_close(&r.s);
}

/* ---- Little to work on ------------------------------------------------------------------------------------------- */

/* A drive moves all that there is, so that no coordinate is left: the speed is the input, and the force m u'. */
static void nothing_free(void **state)
{
    (void)state;
    dmb_body_def body = dmb_body_def_default();
    dmb_state_space_options options = dmb_state_space_options_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    body.mass = 2.0;
    body.free_mask = DMB_FREE_X;
    const dmb_id id = add_body(&s, &body);
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_MOTION, id, DMB_X, add_constant(&s, 0.0));
    rig_start(&s, NULL);
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, drive, DMB_X);
    const dmb_output speed = output_at(DMB_OUTPUT_VIBRATION_VELOCITY, dmb_station(id, 0, 0.0), DMB_X);
    const dmb_output force = output_at(DMB_OUTPUT_DRIVE_FORCE, dmb_station(drive, 0, 0.0), 0);
    model m = space_of(&s, NULL, &input, 1, &speed, 1);
    assert_true(m.info.states == 1 && m.info.coordinates == 0);
    assert_true(m.A[0] == 0.0 && m.B[0] == 1.0 && m.C[0] == 0.0 && m.D[0] == 1.0);
    discard(&m);
    options.motion = DMB_MOTION_ACCELERATION;
    m = space_of(&s, &options, &input, 1, &force, 1);
    assert_int_equal(m.info.states, 2);
    check_close("force of the drive by its acceleration", m.D[0], 2.0, 1e-12);
    discard(&m);
    rig_close(&s);
}

/* Every allocation of an analysis and of a window fails once: DMB_ERR_NO_MEMORY, nothing is left behind. */
static void memory_runs_out(void **state)
{
    (void)state;
    string_rig r = open_string(DMB_PIPE_FLEXIBLE, 0, 3, 0.0);
    dmb_sim_options options = dmb_sim_options_default();
    scarce memory = {0, 0, 0};
    const dmb_allocator allocator = scarce_allocator(&memory);
    dmb_sim *sim = NULL;
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, r.feed, DMB_X);
    const dmb_output output = reading_at(r.string, 0, 0.0, DMB_OUTPUT_HOOK_LOAD);
    const dmb_output reading = {dmb_station(r.string, 0, 0.0), DMB_OUTPUT_HOOK_LOAD, 0};
    options.allocator = &allocator;
    must_model(&r.s, dmb_sim_create(r.s.model, &options, &sim));
    assert_true(dmb_analysis_static(sim, NULL, NULL) >= 0);
    const size_t live = memory.live;
    for (int window = 0; window < 2; window++)
        for (size_t k = 1;; k++) {
            dmb_state_space *found = NULL;
            dmb_window *watched = NULL;
            memory.calls = 0;
            memory.refused = k;
            const int32_t status = window ? dmb_window_create(sim, NULL, &reading, 1, &watched)
                                          : dmb_analysis_state_space(sim, NULL, &input, 1, &output, 1, &found);
            const size_t calls = memory.calls;
            memory.refused = 0;
            if (calls >= k) assert_int_equal(status, DMB_ERR_NO_MEMORY);
            if (calls >= k) assert_true(found == NULL && watched == NULL);
            dmb_state_space_destroy(&found);
            dmb_window_destroy(&watched);
            assert_int_equal(memory.live, live);
            if (calls < k) {
                assert_int_equal(status, DMB_OK);
                tell(window ? "allocations of a window" : "allocations of a state space", (double)calls);
                break;
            }
        }
    dmb_sim_destroy(&sim);
    assert_int_equal(memory.live, 0);
    rig_close(&r.s);
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static void refused(const rig *s, const dmb_state_space_options *o, const dmb_excitation *input,
                    const dmb_output *output, int32_t status, const char *says)
{
    dmb_state_space *space = (dmb_state_space *)(uintptr_t)8;
    const uint64_t before = rig_hash(s);
    assert_int_equal(dmb_analysis_state_space(s->sim, o, input, input != NULL, output, output != NULL, &space), status);
    assert_null(space);
    if (strstr(dmb_sim_message(s->sim), says) == NULL) fail_msg("says: %s", dmb_sim_message(s->sim));
    assert_true(rig_hash(s) == before);
}

static void refusals(void **state)
{
    (void)state;
    string_rig r = open_string(DMB_PIPE_FLEXIBLE, 0, 3, 0.0);
    dmb_state_space_options o = dmb_state_space_options_default();
    dmb_excitation input = force_at(dmb_station(r.string, 1, 0.5), DMB_X);
    dmb_output output = output_at(DMB_OUTPUT_VIBRATION, dmb_station(r.string, 1, 0.5), DMB_X);
    dmb_modes_options lowest = dmb_modes_options_default();
    dmb_modes *modes = NULL, *other = NULL;
    o.form = 3;
    refused(&r.s, &o, NULL, NULL, DMB_ERR_VALUE, "form = 3");
    o.form = DMB_STATE_MATRICES;
    refused(&r.s, &o, &input, NULL, DMB_ERR_VALUE, "excitation_count = 1");
    o.form = DMB_STATE_REDUCED;
    refused(&r.s, &o, &input, &output, DMB_ERR_NULL, "modes = NULL");
    o.modes = (const dmb_modes *)(const void *)r.s.model;
    refused(&r.s, &o, &input, &output, DMB_ERR_HANDLE, "no live result");
    must(&r.s, dmb_analysis_modes(r.s.sim, &lowest, &modes));
    string_rig foreign = open_string(DMB_PIPE_FLEXIBLE, 0, 3, 0.0);
    must(&foreign.s, dmb_analysis_modes(foreign.s.sim, &lowest, &other));
    o.modes = other;
    refused(&r.s, &o, &input, &output, DMB_ERR_VALUE, "same model");
    int32_t beyond = 10;
    o.modes = modes;
    o.mode_list = &beyond;
    o.mode_count = 1;
    refused(&r.s, &o, &input, &output, DMB_ERR_VALUE, "mode_list");
    beyond = -1;
    refused(&r.s, &o, &input, &output, DMB_ERR_VALUE, "mode_list");
    o = dmb_state_space_options_default();
    o.shift = (double)NAN;
    refused(&r.s, &o, NULL, NULL, DMB_ERR_NOT_FINITE, "shift");
    o.shift = 0.0;
    o.equilibrium_tolerance = 0.0;
    refused(&r.s, &o, NULL, NULL, DMB_ERR_VALUE, "equilibrium_tolerance");
    input.kind = DMB_EXCITATION_UNBALANCE;
    refused(&r.s, NULL, &input, &output, DMB_ERR_UNSUPPORTED, "square of its frequency");
    input.kind = DMB_EXCITATION_FORCE;
    output = reading_at(r.string, 0, 0.0, DMB_OUTPUT_STRETCH);
    refused(&r.s, NULL, &input, &output, DMB_ERR_UNSUPPORTED, "stretch of string 0: a magnitude");
    take_steps(&foreign.s, 1e-3, 1);
    dmb_modes_destroy(&modes);
    dmb_modes_destroy(&other);
    rig_close(&foreign.s);
    rig_close(&r.s);
    rig free_;
    dmb_body_def body = dmb_body_def_default();
    rig_open(&free_, 0.0, 0.0, 0.0);
    const dmb_id id = add_body(&free_, &body);
    rig_start(&free_, NULL);
    input = force_at(dmb_station(id, 0, 0.0), DMB_X);
    output = output_at(DMB_OUTPUT_VIBRATION_VELOCITY, dmb_station(id, 0, 0.0), DMB_X);
    lowest.count = 6;
    must(&free_, dmb_analysis_modes(free_.sim, &lowest, &modes));
    o = dmb_state_space_options_default();
    o.form = DMB_STATE_REDUCED;
    o.modes = modes;
    refused(&free_, &o, &input, &output, DMB_ERR_SINGULAR, "shift");
    o.shift = 0.01;
    model m = space_of(&free_, &o, &input, 1, &output, 1);
    check_below("a free body, reduced: against the response",
                against_response(&free_, &m, NULL, &input, &output, frequencies, 5), 1e-9);
    dmb_modes_destroy(&modes);
    discard(&m);
    rig_close(&free_);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_of_the_coordinates),
        cmocka_unit_test(numbers_of_matrices_and_handles),
        cmocka_unit_test(more_states_than_the_bound),
        cmocka_unit_test(transfer_of_a_string),
        cmocka_unit_test(transfer_of_a_crowded_string),
        cmocka_unit_test(rate_is_refused),
        cmocka_unit_test(roots_are_modes),
        cmocka_unit_test(gyroscopic),
        cmocka_unit_test(joints),
        cmocka_unit_test(joint_or_support),
        cmocka_unit_test(in_time),
        cmocka_unit_test(settings_are_their_parts),
        cmocka_unit_test(step_of_a_setting),
        cmocka_unit_test(step_of_a_load_drive),
        cmocka_unit_test(settings_refused),
        cmocka_unit_test(static_correction),
        cmocka_unit_test(arrays),
        cmocka_unit_test(refusals),
        cmocka_unit_test(nothing_free),
        cmocka_unit_test(memory_runs_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
