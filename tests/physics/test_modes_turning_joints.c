/* Modes of parts that turn against each other on joints: a rotor on a carrier that may tilt, an arm on a hub that
 * turns, against closed forms and a run in time; and the refusal where no axes make the coefficients constant. */
#include <string.h>

#include "mechanism.h"
#include "modal.h"

/* ---- Rotor on a carrier ------------------------------------------------------------------------------------------ */

#define CARRIER_STIFFNESS 100.0 /* [N m/rad] against tilt */
#define AXIAL 1.2               /* [kg m2] of the rotor */
#define ACROSS 1.1              /* [kg m2] of both, across the axis */

typedef struct gyroscope {
    rig s;
    dmb_id carrier, rotor;
} gyroscope;

/* The rotor spins about axis `axis` of a carrier that a ball joint with springs holds; both tilt at first. */
static gyroscope open_gyroscope(int axis, double spin, double tilt_speed)
{
    gyroscope g;
    dmb_body_def carrier = dmb_body_def_default(), rotor = dmb_body_def_default();
    rig_open(&g.s, 0.0, 0.0, 0.0);
    carrier.mass = 5.0;
    rotor.mass = 20.0;
    for (int k = 0; k < 3; k++) {
        carrier.inertia[k] = 0.4;
        rotor.inertia[k] = k == axis ? AXIAL : ACROSS - 0.4;
    }
    rotor.velocity[3 + axis] = spin;
    carrier.velocity[3 + (axis + 1) % 3] = rotor.velocity[3 + (axis + 1) % 3] = tilt_speed;
    g.carrier = add_body(&g.s, &carrier);
    g.rotor = add_body(&g.s, &rotor);
    dmb_joint_def ball =
        joint_between(DMB_JOINT_SPHERICAL, dmb_station(ground_id, 0, 0.0), dmb_station(g.carrier, 0, 0.0));
    for (int k = 3; k < 6; k++) ball.stiffness[k] = CARRIER_STIFFNESS;
    (void)add_joint(&g.s, &ball);
    dmb_joint_def bearing =
        joint_between(DMB_JOINT_REVOLUTE, dmb_station(g.carrier, 0, 0.0), dmb_station(g.rotor, 0, 0.0));
    for (int k = 0; k < 3; k++) bearing.axis_a[k] = bearing.axis_b[k] = k == axis ? 1.0 : 0.0;
    (void)strcpy(bearing.name, "bearing");
    (void)add_joint(&g.s, &bearing);
    (void)rig_start(&g.s, NULL);
    return g;
}

/* ACROSS w^2 -+ AXIAL spin w - k = 0. [rad/s] */
static double precession(double spin, double sign)
{
    const double half = 0.5 * AXIAL * spin / ACROSS;
    return sqrt(half * half + CARRIER_STIFFNESS / ACROSS) + sign * half;
}

static dmb_modes_options damped_in(int32_t axes)
{
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = DMB_MODES_DAMPED;
    options.select = DMB_MODES_ALL;
    options.axes = axes;
    return options;
}

/* In axes that do not take part in the rotor's spin. */
static void rotor_on_a_carrier(void **state)
{
    (void)state;
    for (double spin = 5.0; spin < 50.0; spin *= 4.0) {
        gyroscope g = open_gyroscope(0, spin, 0.0);
        const dmb_modes_options options = damped_in(DMB_MODES_AXES_AT_REST);
        dmb_modes *modes = find_modes(&g.s, &options);
        check_below("rotor on a carrier: slow precession", closest_mode(modes, precession(spin, -1.0)), 1e-11);
        check_below("rotor on a carrier: fast precession", closest_mode(modes, precession(spin, 1.0)), 1e-11);
        dmb_modes_destroy(&modes);
        rig_close(&g.s);
    }
}

/* The same frequencies make the way in time, tilt = e/(w1 + w2) |exp(i w1 t) - exp(-i w2 t)|. */
static void rotor_in_time(void **state)
{
    (void)state;
    const double spin = 20.0, speed = 1e-4, end = 0.4;
    const double sum = precession(spin, -1.0) + precession(spin, 1.0);
    gyroscope g = open_gyroscope(0, spin, speed);
    take_steps(&g.s, 1e-4, 4000);
    const dmb_pose pose = pose_at(&g.s, dmb_station(g.carrier, 0, 0.0));
    const double tilt = sqrt(pose.rotation[3] * pose.rotation[3] + pose.rotation[6] * pose.rotation[6]);
    check_relative("rotor on a carrier: in time", tilt, 2.0 * speed / sum * fabs(sin(0.5 * sum * end)), 1e-5);
    rig_close(&g.s);
}

static void check_refused(const rig *s, int32_t axes, const char *part)
{
    const dmb_modes_options options = damped_in(axes);
    const modes_refusal got = refused_modes(s, &options);
    assert_int_equal(got.status, DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(got.text, part));
    if (axes == DMB_MODES_AXES_AT_REST) assert_null(strstr(got.text, "choose axes"));
}

/* In the axes of the bodies what the carrier's tilt is for the rotor turns with it, and axes at rest are those about
 * the x axes alone. */
static void equations_that_turn_are_refused(void **state)
{
    (void)state;
    gyroscope along = open_gyroscope(0, 20.0, 0.0), across = open_gyroscope(1, 20.0, 0.0);
    check_refused(&along.s, DMB_MODES_AXES_TURNING, "bearing");
    check_refused(&across.s, DMB_MODES_AXES_TURNING, "bearing");
    check_refused(&across.s, DMB_MODES_AXES_AT_REST, "bearing");
    rig_close(&across.s);
    dmb_excitation input = dmb_excitation_default();
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    dmb_response *response = NULL;
    dmb_state_space *space = NULL;
    dmb_state_space_options options = dmb_state_space_options_default();
    input.place = output.place = dmb_station(along.carrier, 0, 0.0);
    input.component = DMB_RY;
    output.quantity += DMB_RY;
    assert_int_equal(dmb_analysis_response(along.s.sim, NULL, &input, 1, &output, 1, &response), DMB_NOTE_INCOMPLETE);
    assert_non_null(strstr(dmb_sim_message(along.s.sim), "bearing"));
    assert_int_equal(dmb_analysis_state_space(along.s.sim, &options, &input, 1, &output, 1, &space),
                     DMB_NOTE_INCOMPLETE);
    assert_non_null(strstr(dmb_sim_message(along.s.sim), "bearing"));
    dmb_response_destroy(&response);
    dmb_state_space_destroy(&space);
    options.form = DMB_STATE_MATRICES; /* of the moment, with the Jacobian of the joints */
    must(&along.s, dmb_analysis_state_space(along.s.sim, &options, NULL, 0, NULL, 0, &space));
    dmb_state_space_destroy(&space);
    rig_close(&along.s);
}

/* ---- Arm on a hub ------------------------------------------------------------------------------------------------ */

#define HUB_SPIN 10.0  /* [rad/s] */
#define ARM_LENGTH 1.0 /* [m] */
#define ARM_MASS 2.0   /* [kg] */
#define ARM_ROOT 0.3   /* [m] of the hinge from the axis */
#define ARM_THICK 1e-3 /* [kg m2] about its own length */

/* The hub turns about axis `spin`, the arm lies along the next one, hinged to flap out of the plane or to lag in it. */
static void open_arm(rig *s, int spin, int lags)
{
    const int along = (spin + 1) % 3, flap = (spin + 2) % 3, hinge_axis = lags ? spin : flap;
    const double square = ARM_MASS * ARM_LENGTH * ARM_LENGTH / 12.0, centre = ARM_ROOT + 0.5 * ARM_LENGTH;
    dmb_body_def hub = dmb_body_def_default(), arm = dmb_body_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    hub.velocity[3 + spin] = arm.velocity[3 + spin] = HUB_SPIN;
    arm.velocity[flap] = HUB_SPIN * centre;
    arm.mass = ARM_MASS;
    for (int k = 0; k < 3; k++) arm.inertia[k] = k == along ? ARM_THICK : square;
    arm.position[along] = centre;
    const dmb_id a = add_body(s, &hub), b = add_body(s, &arm);
    dmb_joint_def axle = joint_between(DMB_JOINT_REVOLUTE, dmb_station(ground_id, 0, 0.0), dmb_station(a, 0, 0.0));
    dmb_joint_def hinge = joint_between(DMB_JOINT_REVOLUTE, dmb_station(a, 0, 0.0), dmb_station(b, 0, 0.0));
    for (int k = 0; k < 3; k++) {
        axle.axis_a[k] = axle.axis_b[k] = k == spin ? 1.0 : 0.0;
        hinge.axis_a[k] = hinge.axis_b[k] = k == hinge_axis ? 1.0 : 0.0;
    }
    hinge.origin_a[along] = ARM_ROOT;
    hinge.origin_b[along] = -0.5 * ARM_LENGTH;
    (void)strcpy(hinge.name, "arm");
    const dmb_id turned = add_joint(s, &axle);
    (void)add_joint(s, &hinge);
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = turned;
    drive.component = DMB_RX;
    drive.time_function = add_constant(s, HUB_SPIN);
    (void)add_drive(s, &drive);
    (void)rig_start(s, NULL);
}

/* J w^2 = W^2 m r L/2 of lag; of flap J W^2 (less the arm's own thickness) more. [Hz] */
static double arm_frequency(int lags)
{
    const double square = ARM_MASS * ARM_LENGTH * ARM_LENGTH / 3.0;
    const double pull = 0.5 * ARM_MASS * ARM_ROOT * ARM_LENGTH + (lags ? 0.0 : square - ARM_THICK);
    return HUB_SPIN * sqrt(pull / square) / (2.0 * PI);
}

static void arm_on_a_hub(void **state)
{
    (void)state;
    for (int spin = 0; spin < 3; spin++)
        for (int lags = 0; lags < 2; lags++) {
            rig s;
            open_arm(&s, spin, lags);
            for (int32_t axes = DMB_MODES_AXES_TURNING; axes <= DMB_MODES_AXES_AT_REST; axes++) {
                const dmb_modes_options options = damped_in(axes);
                if (spin == 0 && axes == DMB_MODES_AXES_AT_REST) {
                    check_refused(&s, axes, "arm"); /* its hinge turns in them */
                    continue;
                }
                dmb_modes *modes = find_modes(&s, &options);
                check_relative(lags ? "arm on a hub: lag" : "arm on a hub: flap", frequency_at(modes, 0),
                               arm_frequency(lags), 1e-12);
                dmb_modes_destroy(&modes);
            }
            rig_close(&s);
        }
}

/* ---- Rolling ----------------------------------------------------------------------------------------------------- */

/* J V = 0 has terms J' V while the disc rolls: the lean of it steers. */
static void rolling_is_refused(void **state)
{
    (void)state;
    for (double speed = 0.0; speed < 3.0; speed += 2.0) {
        const double radius = 0.2;
        rig s;
        dmb_body_def disc = dmb_body_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        disc.position[0] = radius;
        disc.rotation[2] = 0.5 * PI; /* its axis lies along y, the plane's normal is x */
        disc.velocity[3] = speed / radius;
        disc.velocity[2] = -speed;
        dmb_joint_def joint =
            joint_between(DMB_JOINT_ROLLING, dmb_station(ground_id, 0, 0.0), dmb_station(add_body(&s, &disc), 0, 0.0));
        joint.length = radius;
        (void)strcpy(joint.name, "disc");
        (void)add_joint(&s, &joint);
        (void)rig_start(&s, NULL);
        if (speed > 0.0) {
            check_refused(&s, DMB_MODES_AXES_TURNING, "in axes that turn and in axes at rest: choose a state");
            check_refused(&s, DMB_MODES_AXES_AT_REST, "in axes that turn and in axes at rest: choose a state");
        } else {
            dmb_modes *modes = all_modes(&s, DMB_MODES_UNDAMPED);
            assert_int_equal(info_of(modes).rigid, info_of(modes).count); /* at rest nothing holds it */
            dmb_modes_destroy(&modes);
        }
        rig_close(&s);
    }
}

/* y of the body does not move. */
static int32_t no_side_slip(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                            double *jacobian)
{
    (void)context, (void)time, (void)count, (void)poses;
    value[0] = 0.0;
    for (int i = 0; i < 6; i++) jacobian[i] = i == 1 ? 1.0 : 0.0;
    return 0;
}

/* The caller's knife edge turns with its body, beside one that spins; at rest nothing but the edge holds it. */
static void edge_of_the_caller_is_refused(void **state)
{
    (void)state;
    for (int turns = 0; turns < 2; turns++) {
        rig s;
        dmb_body_def sledge = dmb_body_def_default();
        dmb_constraint_def edge = dmb_constraint_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        sledge.velocity[5] = turns ? 3.0 : 0.0;
        edge.kind = DMB_CONSTRAINT_NONHOLONOMIC;
        edge.place[0] = dmb_station(add_body(&s, &sledge), 0, 0.0);
        edge.provides = DMB_PROVIDES_JACOBIAN;
        edge.callback = no_side_slip;
        (void)strcpy(edge.name, "edge");
        must_model(&s, dmb_model_add_constraint(s.model, &edge, NULL));
        (void)rig_start(&s, NULL);
        if (turns) {
            check_refused(&s, DMB_MODES_AXES_TURNING, "edge");
        } else {
            dmb_modes *modes = all_modes(&s, DMB_MODES_UNDAMPED);
            assert_int_equal(info_of(modes).count, 5);
            assert_int_equal(info_of(modes).rigid, 5);
            dmb_modes_destroy(&modes);
        }
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotor_on_a_carrier),
        cmocka_unit_test(rotor_in_time),
        cmocka_unit_test(equations_that_turn_are_refused),
        cmocka_unit_test(arm_on_a_hub),
        cmocka_unit_test(rolling_is_refused),
        cmocka_unit_test(edge_of_the_caller_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
