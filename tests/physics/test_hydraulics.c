/* Pressures of mud by depth: against the flow of the described string, muds with a yield stress against pressures by
 * hand, tripping in Newtonian mud against the exact flow past a pipe that moves, equivalent densities, refusals.
 * Equations: eq:mud.ecd, eq:mud.trip. */
#include <string.h>

#include "drillmbd/analyse.h"
#include "mechanism.h"

static const double g = 9.81, outer = 0.089, inner = 0.07, hole = 0.12;

static dmb_environment_def mud_of(double consistency, double exponent, double yield_stress)
{
    dmb_environment_def e = dmb_environment_def_default();
    e.gravity[2] = -g;
    e.fluid_density = 1250.0;
    e.flow_rate = 0.012;
    e.consistency = consistency;
    e.flow_exponent = exponent;
    e.yield_stress = yield_stress;
    e.nozzle_area = 3e-4;
    return e;
}

/* 60 pipes of 3 m with tool joints in a hole that goes straight at `inclination` from the downward vertical. */
static rig string_in(const dmb_environment_def *e, double inclination)
{
    rig s;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    must_model(&s, dmb_model_set_environment(s.model, e));
    wall.direction[0] = sin(inclination);
    wall.direction[1] = 0.0;
    wall.direction[2] = -cos(inclination);
    wall.diameter = hole;
    add_wall(&s, &wall);
    string.start_free = DMB_FREE_NONE;
    pipe.outer_diameter = outer;
    pipe.inner_diameter = inner;
    pipe.length = 3.0;
    pipe.joint_length = 0.2;
    pipe.joint_outer_diameter = 0.1;
    pipe.joint_inner_diameter = 0.06;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 60);
    (void)mechanism_start(&s, NULL);
    return s;
}

static dmb_hydraulics at_depth(const rig *s, double depth, double trip_speed)
{
    dmb_hydraulics answer = dmb_hydraulics_default();
    must(s, dmb_analysis_hydraulics(s->sim, depth, trip_speed, &answer));
    return answer;
}

static void as_the_flow_of_the_string(void **state)
{
    const double inclination = 0.6;
    (void)state;
    for (int i = 0; i < 3; i++) {
        const dmb_environment_def e = mud_of(i == 0 ? 0.02 : 0.4, i == 0 ? 1.0 : 0.6, i == 2 ? 4.0 : 0.0);
        rig s = string_in(&e, inclination);
        dmb_flow_state flow = dmb_flow_state_default();
        must(&s, dmb_query_flow(s.sim, &flow));
        const dmb_hydraulics full = at_depth(&s, 180.0, 0.0), half = at_depth(&s, 90.0, 0.0);
        check_relative("loss in the bore [Pa]", full.bore_loss, flow.bore_loss, 1e-10);
        check_relative("loss in the annulus [Pa]", full.annulus_loss, flow.annulus_loss, 1e-10);
        check_relative("loss through the nozzles [Pa]", full.bit_loss, flow.bit_loss, 1e-14);
        check_relative("pressure of the pump [Pa]", full.pump_pressure, flow.pump_pressure, 1e-10);
        check_relative("half the string", half.annulus_loss, 0.5 * full.annulus_loss, 1e-10);
        check_relative("vertical depth [m]", full.vertical_depth, 180.0 * cos(inclination), 1e-12);
        check_relative("equivalent circulating density [kg/m3]", full.circulating_density,
                       1250.0 + flow.annulus_loss / (g * 180.0 * cos(inclination)), 1e-10);
        assert_true(full.trip_pressure <= 0.0);
        check_relative("at rest", full.surge_density, 1250.0, 1e-15);
        rig_close(&s);
    }
}

/* Bingham's fluid that barely flows holds 4 tau_y/(D - d) per metre of the annulus and 4 tau_y/d in the bore. */
static void yield_stress(void **state)
{
    const double yield = 8.0, joint = 0.2 / 3.0;
    dmb_environment_def e = mud_of(1e-6, 1.0, yield);
    (void)state;
    e.flow_rate = 1e-8;
    rig s = string_in(&e, 0.0);
    const dmb_hydraulics h = at_depth(&s, 180.0, 0.0);
    check_relative("annulus", h.annulus_loss,
                   180.0 * 4.0 * yield * (joint / (hole - 0.1) + (1.0 - joint) / (hole - outer)), 1e-3);
    check_relative("bore", h.bore_loss, 180.0 * 4.0 * yield * (joint / 0.06 + (1.0 - joint) / inner), 1e-3);
    rig_close(&s);
}

/* mu w'' x + mu w' = -G x with w = v on the pipe and 0 on the wall, of which the flux upwards is v A_o: Poiseuille's
 * flow with the speed v A_o/A + (mean speed of v ln(x)/ln(kappa)) past a pipe at rest. */
static double exact_trip(double mu, double v, double d)
{
    const double R = 0.5 * hole, k = d / hole, area = 1.0 - k * k, across = -1.0 / log(k);
    const double drag = -(0.5 + k * k * log(k) - 0.5 * k * k) / (area * log(k));
    const double Q = PI * R * R * (k * k + drag * area) * v;
    return 8.0 * mu * Q / (PI * R * R * R * R * (1.0 - k * k * k * k - area * area * across));
}

static void tripping(void **state)
{
    const double mu = 0.3, v = 0.2, joint = 0.2 / 3.0;
    const dmb_environment_def e = mud_of(mu, 1.0, 0.0);
    (void)state;
    rig s = string_in(&e, 0.0);
    const dmb_hydraulics h = at_depth(&s, 180.0, v), fast = at_depth(&s, 180.0, 2.0 * v);
    const double exact = 180.0 * (joint * exact_trip(mu, v, 0.1) + (1.0 - joint) * exact_trip(mu, v, outer));
    check_relative("surge in laminar Newtonian mud [Pa]", h.trip_pressure, exact, 1e-10);
    check_relative("which goes with the speed", fast.trip_pressure, 2.0 * exact, 1e-10);
    check_relative("density going in [kg/m3]", h.surge_density, 1250.0 + exact / (g * 180.0), 1e-12);
    check_relative("density coming out [kg/m3]", h.swab_density, 1250.0 - exact / (g * 180.0), 1e-12);
    rig_close(&s);
}

/* A hole that rises has no equivalent density. */
static void rising_hole(void **state)
{
    const dmb_environment_def e = mud_of(0.02, 1.0, 0.0);
    (void)state;
    rig s = string_in(&e, 0.5 * PI + 0.1);
    const dmb_hydraulics h = at_depth(&s, 100.0, 0.1);
    check_relative("vertical depth [m]", h.vertical_depth, -100.0 * sin(0.1), 1e-12);
    assert_true(isnan(h.circulating_density) && isnan(h.surge_density) && isnan(h.swab_density));
    assert_true(h.annulus_loss > 0.0 && h.trip_pressure > 0.0);
    rig_close(&s);
}

static void refused(const rig *s, double depth, double speed, int32_t status, const char *word)
{
    dmb_hydraulics answer = dmb_hydraulics_default();
    assert_int_equal(dmb_analysis_hydraulics(s->sim, depth, speed, &answer), status);
    assert_non_null(strstr(dmb_sim_message(s->sim), word));
    assert_true(answer.depth <= 0.0 && answer.annulus_loss <= 0.0);
}

static void what_is_refused(void **state)
{
    dmb_environment_def e = mud_of(0.02, 1.0, 0.0);
    (void)state;
    rig s = string_in(&e, 0.3);
    refused(&s, -1.0, 0.0, DMB_ERR_VALUE, "depth");
    refused(&s, 181.0, 0.0, DMB_ERR_VALUE, "depth");
    refused(&s, (double)NAN, 0.0, DMB_ERR_NOT_FINITE, "depth");
    refused(&s, 100.0, -0.1, DMB_ERR_VALUE, "trip_speed");
    refused(&s, 100.0, 11.0, DMB_ERR_VALUE, "trip_speed");
    rig_close(&s);
}

static void without_a_flow(void **state)
{
    dmb_environment_def e = mud_of(0.02, 1.0, 0.0);
    (void)state;
    e.flow_rate = 0.0;
    rig s = string_in(&e, 0.3);
    refused(&s, 100.0, 0.1, DMB_ERR_UNSUPPORTED, "flow_rate");
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_the_flow_of_the_string),
        cmocka_unit_test(yield_stress),
        cmocka_unit_test(tripping),
        cmocka_unit_test(rising_hole),
        cmocka_unit_test(what_is_refused),
        cmocka_unit_test(without_a_flow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
