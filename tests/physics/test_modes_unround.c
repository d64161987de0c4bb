/* Shafts that are not round, and springs that hold them unlike across: answered in the axes in which coefficients stay
 * the same while the shaft turns, against closed forms, refused in the others, and in both where nothing stays.
 * Equations: eq:modes.turned. */
#include <string.h>

#include "harmonic.h"
#include "modal.h"

#define MASS 50.0
#define SPEED 60.0 /* [rad/s] */

/* ---- Springs that hold unlike ------------------------------------------------------------------------------------ */

/* A disc that turns on springs along y and z. */
static dmb_id open_disc(rig *s, double along_y, double along_z)
{
    dmb_body_def disc = dmb_body_def_default();
    dmb_joint_def springs = dmb_joint_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    disc.mass = MASS;
    disc.free_mask = DMB_FREE_Y | DMB_FREE_Z | DMB_FREE_RX;
    disc.velocity[3] = SPEED;
    const dmb_id body = add_body(s, &disc);
    springs.kind = DMB_JOINT_FREE;
    springs.place_b = dmb_station(body, 0, 0.0);
    springs.stiffness[1] = along_y;
    springs.stiffness[2] = along_z;
    must_model(s, dmb_model_add_joint(s->model, &springs, NULL));
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, body, DMB_RX, add_constant(s, SPEED));
    (void)rig_start(s, NULL);
    return body;
}

static dmb_modes_options damped_in(int32_t axes)
{
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = DMB_MODES_DAMPED;
    options.axes = axes;
    options.count = 4;
    return options;
}

static void refuses(const rig *s, int32_t axes)
{
    const dmb_modes_options options = damped_in(axes);
    const modes_refusal refusal = refused_modes(s, &options);
    assert_int_equal(refusal.status, DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(refusal.text, "while parts turn coefficients change by "));
    assert_non_null(strstr(refusal.text, "take the other axes"));
}

static void springs_unlike(void **state)
{
    (void)state;
    rig s;
    (void)open_disc(&s, 1e6, 2e6);
    const dmb_modes_options options = damped_in(DMB_MODES_AXES_AT_REST);
    dmb_modes *modes = find_modes(&s, &options);
    check_below("soft way", closest_mode(modes, sqrt(1e6 / MASS)), 1e-9);
    check_below("stiff way", closest_mode(modes, sqrt(2e6 / MASS)), 1e-9);
    dmb_modes_destroy(&modes);
    refuses(&s, DMB_MODES_AXES_TURNING);
    rig_close(&s);
}

/* Alike they may be seen from either: sqrt(k/m), and that +- W. */
static void springs_alike(void **state)
{
    const double w = sqrt(1e6 / MASS);
    (void)state;
    rig s;
    (void)open_disc(&s, 1e6, 1e6);
    for (int32_t axes = DMB_MODES_AXES_TURNING; axes <= DMB_MODES_AXES_AT_REST; axes++) {
        const dmb_modes_options options = damped_in(axes);
        dmb_modes *modes = find_modes(&s, &options);
        for (int sense = -1; sense <= 1; sense += 2)
            check_below("seen", closest_mode(modes, axes == DMB_MODES_AXES_AT_REST ? w : w + sense * SPEED), 1e-9);
        dmb_modes_destroy(&modes);
    }
    rig_close(&s);
}

/* Responses tell what they leave out; at rest they are 1/(k - m w^2). */
static void responses_on_springs_unlike(void **state)
{
    const double frequency = 15.0, w = 2.0 * PI * frequency;
    (void)state;
    rig s;
    const dmb_place place = dmb_station(open_disc(&s, 1e6, 2e6), 0, 0.0);
    const dmb_excitation input = force_at(place, DMB_Z);
    const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, place, DMB_Z);
    dmb_response_options options = dmb_response_options_default();
    double complex value;
    dmb_response *response = NULL;
    options.axes = DMB_RESPONSE_AXES_AT_REST;
    transfer(&s, &options, &input, &output, &frequency, 1, &value);
    check_relative("along the stiff springs", creal(value), 1.0 / (2e6 - MASS * w * w), 1e-9);
    options.axes = DMB_RESPONSE_AXES_TURNING;
    assert_int_equal(dmb_analysis_response(s.sim, &options, &input, 1, &output, 1, &response), DMB_NOTE_INCOMPLETE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "what that changes is left out"));
    dmb_response_destroy(&response);
    rig_close(&s);
}

static int32_t state_space_status(const rig *s, dmb_id body)
{
    const dmb_excitation input = force_at(dmb_station(body, 0, 0.0), DMB_Z);
    dmb_state_space *space = NULL;
    const int32_t status = dmb_analysis_state_space(s->sim, NULL, &input, 1, NULL, 0, &space);
    assert_non_null(space);
    dmb_state_space_destroy(&space);
    return status;
}

/* State spaces, which keep to axes that turn, tell of springs unlike across, by less than a thousandth too. */
static void state_spaces_on_springs_unlike(void **state)
{
    static const double more[3] = {0.0, 5e-4, 1.0};
    (void)state;
    for (int i = 0; i < 3; i++) {
        rig s;
        const dmb_id body = open_disc(&s, 1e6, (1.0 + more[i]) * 1e6);
        assert_int_equal(state_space_status(&s, body), i == 0 ? DMB_OK : DMB_NOTE_INCOMPLETE);
        if (i > 0) assert_non_null(strstr(dmb_sim_message(s.sim), "state space: while parts turn coefficients change"));
        rig_close(&s);
    }
}

/* ---- Shafts that are not round ----------------------------------------------------------------------------------- */

#define LENGTH 2.0
#define LINE 2.0 /* [kg/m] */

/* Pinned at both ends or, with a spring along y there, held by that across its far end. */
static void open_flat(rig *s, double EI_y, double EI_z, double spring)
{
    dmb_pipe_def pipe = beam_pipe(LENGTH, 24, 1e9, 1e12, 1e6, EI_y);
    dmb_string_def string = dmb_string_def_default();
    pipe.section_stiffness[5] = EI_z;
    pipe.section_mass = LINE;
    pipe.section_inertia[0] = 2e-6;
    pipe.section_inertia[1] = 1e-6;
    rig_open(s, 0.0, 0.0, 0.0);
    string.start_free = DMB_FREE_SPHERICAL;
    string.end_free = spring > 0.0 ? DMB_FREE_ALL : DMB_FREE_SPHERICAL;
    string.velocity[3] = SPEED;
    pipe.string = add_string(s, &string);
    (void)add_pipes(s, &pipe, 1);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s, SPEED));
    if (spring > 0.0) {
        dmb_joint_def across = dmb_joint_def_default();
        across.kind = DMB_JOINT_FREE;
        across.place_b = dmb_station(pipe.string, 0, 1.0);
        across.stiffness[1] = spring;
        across.stiffness[2] = 3.0 * spring;
        must_model(s, dmb_model_add_joint(s->model, &across, NULL));
    }
    (void)rig_start(s, NULL);
}

/* Both ways of bending in axes that turn with W: (p^2 - w^2 - W^2)(q^2 - w^2 - W^2) = 4 W^2 w^2, p and q at rest. */
static void flat_shaft(void **state)
{
    const double b4 = pow(PI / LENGTH, 4), p = 2e3 * b4 / LINE, q = 5e3 * b4 / LINE, W2 = SPEED * SPEED;
    const double half = 0.5 * (p + q + 2.0 * W2), root = sqrt(half * half - (p - W2) * (q - W2));
    (void)state;
    rig s;
    open_flat(&s, 2e3, 5e3, 0.0);
    dmb_modes_options options = damped_in(DMB_MODES_AXES_TURNING);
    options.count = 8;
    dmb_modes *modes = find_modes(&s, &options);
    if (p > W2) check_below("lower", closest_mode(modes, sqrt(half - root)), 2e-5);
    check_below("upper", closest_mode(modes, sqrt(half + root)), 2e-5);
    dmb_modes_destroy(&modes);
    refuses(&s, DMB_MODES_AXES_AT_REST);
    rig_close(&s);
}

static void nothing_stays(void **state)
{
    (void)state;
    rig s;
    open_flat(&s, 2e3, 5e3, 1e4);
    refuses(&s, DMB_MODES_AXES_TURNING);
    refuses(&s, DMB_MODES_AXES_AT_REST);
    rig_close(&s);
}

/* A long shaft, held along at both ends, that its weight bends is stiffer in the plane of its sag, which stands still
 * while it turns: in axes at rest the modes of the same shaft that does not turn, but for gyroscopic terms; refused in
 * axes that turn. */
static void bent_by_its_weight(void **state)
{
    (void)state;
    rig s[2];
    dmb_modes *modes[2];
    for (int k = 0; k < 2; k++) {
        const double speed = k == 0 ? 0.0 : SPEED;
        dmb_pipe_def pipe = s1_pipe();
        dmb_string_def string = dmb_string_def_default();
        rig_open(s + k, 0.0, 0.0, -9.81);
        string.start_free = string.end_free = DMB_FREE_SPHERICAL;
        pipe.string = add_string(s + k, &string);
        (void)add_pipes(s + k, &pipe, 6);
        (void)add_simple_drive(s + k, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s + k, speed));
        (void)rig_start(s + k, NULL);
        (void)find_equilibrium(s + k, NULL);
        const dmb_modes_options options = damped_in(DMB_MODES_AXES_AT_REST);
        modes[k] = find_modes(s + k, &options);
    }
    check_below("sag apart", 1.05, frequency_at(modes[0], 1) / frequency_at(modes[0], 0));
    for (uint32_t i = 0; i < 2; i++) {
        tell("[Hz]", frequency_at(modes[0], i));
        check_relative("    turning", frequency_at(modes[1], i), frequency_at(modes[0], i), 2e-3);
    }
    refuses(s + 1, DMB_MODES_AXES_TURNING);
    for (int k = 0; k < 2; k++) {
        dmb_modes_destroy(modes + k);
        rig_close(s + k);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(springs_unlike),
        cmocka_unit_test(springs_alike),
        cmocka_unit_test(responses_on_springs_unlike),
        cmocka_unit_test(state_spaces_on_springs_unlike),
        cmocka_unit_test(flat_shaft),
        cmocka_unit_test(nothing_stays),
        cmocka_unit_test(bent_by_its_weight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
