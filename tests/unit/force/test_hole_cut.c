/* The widening of a hole by cutters: its derivatives against differences, its shares, its values at stations, beyond
 * the ends and with described sections. Equations: eq:hole.section, eq:hole.cut. */
#include "check.h"
#include "force/hole.h"

enum { STATIONS = 9 };
static const double widening[STATIONS] = {0.0, 0.0, 0.013, 0.02, 0.02, 0.007, 0.0, 0.011, 0.0};
static const dmb_hole_piece pieces[2] = {{.depth = 0.0, .value = {0.05, 1e6}, .slope = {0.01}, .bend = {0.002}},
                                         {.depth = 1.0, .value = {0.062, 1e6}, .slope = {0.014}, .bend = {-0.003}}};

static dmb_hole hole_with(uint32_t count)
{
    const dmb_hole hole = {.pieces = count,
                           .piece = pieces,
                           .radius = 0.05,
                           .friction = 1.0,
                           .widening = widening,
                           .cuts = STATIONS,
                           .cut_start = -0.3,
                           .cut_spacing = 0.25};
    return hole;
}

static double value_at(const dmb_hole *hole, double s, int which)
{
    double w[3];
    dmb_hole_widening_at(hole, s, w);
    return w[which];
}

static void derivatives_are_those_of_the_widening(void **state)
{
    const dmb_hole hole = hole_with(2);
    const double step = 1e-5;
    double worst[2] = {0.0, 0.0};
    (void)state;
    for (int i = 0; i < 1000; i++) {
        const double s = -0.6 + 2.6 * (i + 0.37) / 1000.0, x = 2.0 * (s - hole.cut_start) / hole.cut_spacing;
        if (fabs(x - floor(x + 0.5)) < 1e-3) continue; /* the second derivative jumps there */
        for (int k = 0; k < 2; k++) {
            const double slope = (value_at(&hole, s + step, k) - value_at(&hole, s - step, k)) / (2.0 * step);
            worst[k] = fmax(worst[k], fabs(slope - value_at(&hole, s, k + 1)));
        }
    }
    check_below("slope against differences [-]", worst[0], 1e-11);
    check_below("second derivative against differences [1/m]", worst[1], 1e-9);
}

static void stations_have_their_values(void **state)
{
    const dmb_hole hole = hole_with(2);
    dmb_local_wall wall;
    (void)state;
    for (uint32_t j = 0; j < STATIONS; j++) {
        const double s = dmb_hole_cut_depth(&hole, j);
        check_close("widening at a station [m]", value_at(&hole, s, 0), widening[j], 1e-16);
        check_close("radius there [m]", dmb_hole_radius(&hole, s), dmb_hole_described_radius(&hole, s) + widening[j],
                    1e-16);
        check_close("slope there [-]", value_at(&hole, s, 1), 0.0, 1e-14);
    }
    const dmb_normal_law normal = {.kind = DMB_NORMAL_KELVIN_VOIGT, .exponent = 1.0};
    const dmb_friction_law friction = {.kind = DMB_FRICTION_NONE};
    dmb_local_wall_at(&hole, &normal, &friction, 0.77, 1.0, &wall);
    check_close("radius of the wall at a place [m]", wall.radius, dmb_hole_radius(&hole, 0.77), 0.0);
    check_close("its slope [-]", wall.radius_slope, 0.01 + 2.0 * 0.002 * 0.77 + value_at(&hole, 0.77, 1), 1e-16);
    assert_true(value_at(&hole, -0.3, 0) == 0.0 && value_at(&hole, 1.7, 0) == 0.0 && value_at(&hole, 1e30, 0) == 0.0);
    assert_true(value_at(&hole, (double)NAN, 0) == 0.0);
}

static void shares_add_up_to_the_widening(void **state)
{
    const dmb_hole hole = hole_with(1);
    double worst = 0.0;
    (void)state;
    for (int i = 0; i < 1000; i++) {
        const double s = -0.6 + 2.6 * (i + 0.37) / 1000.0;
        double sum = 0.0;
        for (uint32_t j = 0; j < STATIONS; j++) sum += dmb_hole_fraction_of_cut(&hole, j, s) * widening[j];
        worst = fmax(worst, fabs(sum - value_at(&hole, s, 0)));
    }
    check_below("widening less the sum of shares [m]", worst, 1e-16);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(derivatives_are_those_of_the_widening),
        cmocka_unit_test(stations_have_their_values),
        cmocka_unit_test(shares_add_up_to_the_widening),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
