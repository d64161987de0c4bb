/* Slack strings: 200 m of rods 73 x 6 mm, pinned at both ends 190 m apart (closed at creation by pressing the string
 * together), hang in the catenary for any number of pipes and elements: their weight bears on the pins, the middle is
 * 27.2 m below them. The straight string is an equilibrium as well, far beyond its buckling load, and is left.
 * Equations: eq:static.relaxation. */
#include "rig.h"

static const double length = 200.0, span = 190.0; /* [m] */

static void hangs(uint32_t pipes, uint32_t elements, double direction)
{
    rig s;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_joint_def pin = dmb_joint_def_default();
    rig_open(&s, 0.0, 0.0, -9.81);
    def.follows_hole = 0, def.start_free = DMB_FREE_RY, def.rotation[2] = direction;
    pipe.string = add_string(&s, &def);
    pipe.length = length / pipes, pipe.elements = elements;
    (void)add_pipes(&s, &pipe, pipes);
    pin.kind = DMB_JOINT_REVOLUTE, pin.place_b = dmb_station(pipe.string, pipes - 1, 1.0);
    pin.origin_a[0] = span * cos(direction), pin.origin_a[1] = span * sin(direction);
    pin.axis_a[0] = -sin(direction), pin.axis_a[1] = cos(direction);
    pin.axis_b[0] = 0.0, pin.axis_b[1] = 1.0;
    (void)add_joint(&s, &pin);
    dmb_sim_options options = dmb_sim_options_default();
    options.assembly_energy = 1e12;
    (void)rig_start(&s, &options);
    const dmb_static_report report = find_equilibrium(&s, NULL);
    const dmb_pose middle = pose_at(&s, dmb_station(pipe.string, pipes / 2 - 1, 1.0));
    print_message("  %u pipes, %u elements: %u iterations, %d negative, middle at %.4f m\n", pipes, elements,
                  report.iterations, report.negative, middle.position[2]);
    assert_int_equal(report.negative, 0);
    check_relative("    depth of the middle", -middle.position[2], 27.213, pipes % 2 ? 5e-2 : 1e-3);
    rig_close(&s);
}

static void slack_strings_hang(void **state)
{
    (void)state;
    const uint32_t pipes[] = {10, 26, 50, 80};
    for (size_t i = 0; i < sizeof pipes / sizeof *pipes; i++)
        for (uint32_t elements = 1; elements <= 2; elements++) hangs(pipes[i], elements, 0.0);
    hangs(50, 1, 0.7);
    hangs(100, 1, 0.0);
    hangs(60, 2, 2.0);
    hangs(60, 4, 2.0);
}

/* A body that may turn about x alone, its centre 1 m off the axis, from up to 160 degrees: it hangs. */
static void supportd_body_hangs(void **state)
{
    (void)state;
    for (int degrees = -160; degrees <= 160; degrees++) {
        rig s;
        dmb_body_def body = dmb_body_def_default();
        rig_open(&s, 0.0, 0.0, -9.81);
        body.mass = 10.0, body.centre[2] = -1.0, body.free_mask = DMB_FREE_RX;
        body.inertia[0] = body.inertia[1] = body.inertia[2] = 1.0;
        body.rotation[0] = degrees * 3.141592653589793 / 180.0;
        (void)add_body(&s, &body);
        (void)rig_start(&s, NULL);
        const dmb_static_report report = find_equilibrium(&s, NULL);
        const dmb_momentum m = momentum_of(&s);
        if (report.negative != 0 || !(fabs(m.centre[2] + 1.0) < 1e-9))
            fail_msg("from %d degrees: %d negative, centre at %g", degrees, report.negative, m.centre[2]);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slack_strings_hang),
        cmocka_unit_test(supportd_body_hangs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
