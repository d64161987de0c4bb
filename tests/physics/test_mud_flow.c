/* Mud that flows down a string and back: hook load, true and effective force, pressures, stretch and stress against the
 * balance of forces on the steel and Lame's tube; torque and drag, a run in time and its energy, what is refused. */
#include <string.h>

#include "drillmbd/drilling.h"
#include "mechanism.h"

static const double g = 9.81, outer = 0.089, inner = 0.07, hole = 0.12, steel = 7850.0, E = 2.1e11, nu = 0.3;

static double ring(double D, double d)
{
    return PI / 4.0 * (D - d) * (D + d);
}

typedef struct hanging {
    rig s;
    dmb_id string;
    double length;
} hanging;

static dmb_environment_def mud_of(double rate, double nozzles)
{
    dmb_environment_def e = dmb_environment_def_default();
    e.gravity[2] = 0.0;
    e.gravity[0] = g;
    e.fluid_density = 1250.0;
    e.inner_density = 1150.0;
    e.flow_rate = rate;
    e.consistency = 0.05;
    e.flow_exponent = 0.8;
    e.nozzle_area = nozzles;
    return e;
}

static dmb_pipe_def pipe_of(int32_t kind)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.kind = kind;
    pipe.outer_diameter = outer;
    pipe.inner_diameter = inner;
    pipe.density = steel;
    pipe.length = 6.0;
    pipe.elements = 2;
    pipe.yield_strength = 5e8;
    return pipe;
}

static hanging describe(const dmb_pipe_def *given, const dmb_environment_def *e, uint32_t count)
{
    hanging h = {.length = count * given->length};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = *given;
    rig_open(&h.s, 0.0, 0.0, 0.0);
    must_model(&h.s, dmb_model_set_environment(h.s.model, e));
    wall.direction[0] = 1.0; /* down, as gravity here */
    wall.diameter = hole;
    add_wall(&h.s, &wall);
    string.start_free = DMB_FREE_NONE;
    h.string = pipe.string = add_string(&h.s, &string);
    (void)add_pipes(&h.s, &pipe, count);
    return h;
}

static hanging hang(int32_t kind, double rate, double nozzles)
{
    const dmb_pipe_def pipe = pipe_of(kind);
    const dmb_environment_def e = mud_of(rate, nozzles);
    hanging h = describe(&pipe, &e, 10);
    (void)mechanism_start(&h.s, NULL);
    must(&h.s, dmb_analysis_static(h.s.sim, NULL, NULL));
    return h;
}

static double value_of(const hanging *h, int32_t quantity, double fraction)
{
    const dmb_channel channel = {
        .place = dmb_station(h->string, (uint32_t)(9.99 * fraction), fraction > 0.9 ? 1.0 : 0.0), .quantity = quantity};
    double value = 0.0;
    must(&h->s, dmb_query_channel(h->s.sim, &channel, &value));
    return value;
}

static dmb_flow_state flow_in(const hanging *h)
{
    dmb_flow_state flow = dmb_flow_state_default();
    must(&h->s, dmb_query_flow(h->s.sim, &flow));
    return flow;
}

/* The steel alone: its weight, shear on its two surfaces, pressure on the ring of its end, force of the bit. */
static void check_balance(int32_t kind, double rate, double nozzles)
{
    hanging h = hang(kind, rate, nozzles);
    const dmb_environment_def e = mud_of(rate, nozzles);
    const dmb_flow_state flow = flow_in(&h);
    const double Ao = ring(outer, 0.0), Ai = ring(inner, 0.0), L = h.length, V = rate / Ai;
    const double exit = nozzles > 0.0 ? nozzles : Ai;
    const double p_o = e.fluid_density * g * L + flow.annulus_loss, p_i = p_o + flow.bit_loss;
    const double shear_inside = flow.bore_loss * Ai, shear_outside = flow.drag - flow.annulus_loss * Ao;
    const double at_end = p_i * Ai - p_o * Ao - e.inner_density * rate * (rate / exit - V);
    const double top = steel * (Ao - Ai) * g * L + shear_inside - shear_outside + at_end;
    const double effective = top - flow.pump_pressure * Ai - e.inner_density * rate * V;
    check_relative("pressure of the pump [Pa]", flow.pump_pressure, p_i + flow.bore_loss - e.inner_density * g * L,
                   1e-4);          /* the string is longer than described */
    if (kind == DMB_PIPE_FLEXIBLE) /* of axial-torsional pipes the mean over the element */
        check_relative("true axial force at the rig end [N]",
                       value_of(&h, DMB_CHANNEL_PROFILE + DMB_PROFILE_AXIAL_FORCE, 0.0), top, 1e-5);
    check_relative("hook load [N]", value_of(&h, DMB_CHANNEL_HOOK_LOAD, 0.0), effective, 1e-5);
    check_relative("hook load by weight, drag and thrust [N]", value_of(&h, DMB_CHANNEL_HOOK_LOAD, 0.0),
                   (steel * (Ao - Ai) + e.inner_density * Ai - e.fluid_density * Ao) * g * L - flow.drag - flow.thrust,
                   1e-10);
    rig_close(&h.s);
}

static void forces_on_the_steel_balance(void **state)
{
    (void)state;
    check_balance(DMB_PIPE_FLEXIBLE, 0.012, 3e-4);
    check_balance(DMB_PIPE_FLEXIBLE, 0.002, 0.0);
    check_balance(DMB_PIPE_AXIAL_TORSIONAL, 0.012, 3e-4);
}

/* Newtonian and laminar (Bird, Stewart, Lightfoot 2002, eq. 2.4-16): the annulus pulls by pi (lambda R)^2 G. */
static void poiseuille(void **state)
{
    const double Q = 2e-3, mu = 0.2, R = 0.5 * hole, k = outer / hole, turn = (1.0 - k * k) / log(1.0 / k);
    const double G = 8.0 * mu * Q / (PI * pow(R, 4.0) * (1.0 - pow(k, 4.0) - (1.0 - k * k) * turn));
    const dmb_pipe_def pipe = pipe_of(DMB_PIPE_FLEXIBLE);
    dmb_environment_def e = mud_of(Q, 0.0);
    (void)state;
    e.consistency = mu;
    e.flow_exponent = 1.0;
    hanging h = describe(&pipe, &e, 10);
    (void)mechanism_start(&h.s, NULL);
    must(&h.s, dmb_analysis_static(h.s.sim, NULL, NULL));
    const dmb_flow_state flow = flow_in(&h);
    assert_true(flow.annulus_reynolds < 100.0 && flow.bore_reynolds < 500.0);
    check_relative("loss of the annulus [Pa]", flow.annulus_loss, G * h.length, 1e-12);
    check_relative("loss of the bore [Pa]", flow.bore_loss, 128.0 * mu * Q / (PI * pow(inner, 4.0)) * h.length, 1e-12);
    check_relative("hook load [N]", value_of(&h, DMB_CHANNEL_HOOK_LOAD, 0.0),
                   (steel * ring(outer, inner) + 1150.0 * ring(inner, 0.0) - 1250.0 * ring(outer, 0.0)) * g * h.length -
                       0.5 * turn * PI * R * R * G * h.length - 1150.0 * Q * Q / ring(inner, 0.0),
                   1e-9);
    rig_close(&h.s);
}

/* The hook load without flow less that with it, pipes of every kind with tool joints. */
static void pull_of_every_kind(void **state)
{
    static const int32_t kinds[2] = {DMB_PIPE_FLEXIBLE, DMB_PIPE_AXIAL_TORSIONAL};
    (void)state;
    for (int i = 0; i < 2; i++) {
        double load[2];
        dmb_flow_state flow = dmb_flow_state_default();
        for (int k = 0; k < 2; k++) {
            dmb_pipe_def pipe = pipe_of(kinds[i]);
            const dmb_environment_def e = mud_of(k ? 0.01 : 0.0, 4e-4);
            pipe.joint_length = 0.4;
            pipe.joint_outer_diameter = 0.105;
            pipe.joint_inner_diameter = 0.06;
            hanging h = describe(&pipe, &e, 10);
            (void)mechanism_start(&h.s, NULL);
            must(&h.s, dmb_analysis_static(h.s.sim, NULL, NULL));
            load[k] = value_of(&h, DMB_CHANNEL_HOOK_LOAD, 0.0);
            if (k) flow = flow_in(&h);
            dmb_operation up = dmb_operation_default();
            dmb_torque_drag_row row = dmb_torque_drag_row_default();
            (void)dmb_operation_usual(DMB_OPERATION_PICK_UP, &up);
            must(&h.s, dmb_analysis_torque_drag(h.s.sim, NULL, &up, 1, &row));
            check_relative("hook load of torque and drag [N]", row.hook_load, load[k], 1e-9);
            rig_close(&h.s);
        }
        check_relative("what the flow takes off the hook load [N]", load[0] - load[1], flow.drag + flow.thrust, 1e-9);
    }
}

/* e = (s_a - nu (s_r + s_h))/E of Lame's tube under the true axial force and both pressures. */
static void stretch_and_stress(void **state)
{
    (void)state;
    hanging h = hang(DMB_PIPE_FLEXIBLE, 0.012, 3e-4);
    const dmb_flow_state flow = flow_in(&h);
    const dmb_environment_def e = mud_of(0.012, 3e-4);
    const double Ao = ring(outer, 0.0), Ai = ring(inner, 0.0), A = Ao - Ai, L = h.length;
    const double top = value_of(&h, DMB_CHANNEL_PROFILE + DMB_PROFILE_AXIAL_FORCE, 0.0);
    const double bottom = value_of(&h, DMB_CHANNEL_PROFILE + DMB_PROFILE_AXIAL_FORCE, 1.0);
    const double p_o = e.fluid_density * g * L + flow.annulus_loss; /* at the end; 0 at the rig end */
    const double p_i[2] = {flow.pump_pressure, p_o + flow.bit_loss};
    const double lame[2] = {2.0 * p_i[0] * Ai / A, 2.0 * (p_i[1] * Ai - p_o * Ao) / A}; /* s_r + s_h */
    check_relative("stretch by forces and pressures [m]",
                   value_of(&h, DMB_CHANNEL_STRETCH, 0.0) + flow.pressure_stretch,
                   0.5 * L / E * (top / A + bottom / A - nu * (lame[0] + lame[1])), 1e-4);
    const double radial[2] = {0.0, -p_i[0]};
    double largest = 0.0;
    for (int k = 0; k < 2; k++) { /* outer and inner surface at the rig end */
        const double hoop = k == 0 ? 2.0 * p_i[0] * Ai / A : p_i[0] * (Ao + Ai) / A, axial = top / A;
        const double r = radial[k];
        largest =
            fmax(largest,
                 sqrt(0.5 * ((axial - r) * (axial - r) + (axial - hoop) * (axial - hoop) + (r - hoop) * (r - hoop))));
    }
    check_relative("von Mises stress of Lame's tube [Pa]",
                   value_of(&h, DMB_CHANNEL_PROFILE + DMB_PROFILE_VON_MISES, 0.0), largest, 1e-6);
    rig_close(&h.s);
}

/* Let go at time 0, the flow's work goes into weight, strain and motion. */
static void a_run_in_time(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        const dmb_pipe_def pipe = pipe_of(kind == 0 ? DMB_PIPE_FLEXIBLE : DMB_PIPE_AXIAL_TORSIONAL);
        const dmb_environment_def e = mud_of(0.015, 2e-4);
        hanging h = describe(&pipe, &e, 10);
        (void)mechanism_start(&h.s, NULL);
        take_steps(&h.s, 1e-4, 200);
        const dmb_energy energy = energy_of(&h.s);
        const double far = pose_at(&h.s, dmb_station(h.string, 9, 1.0)).displacement[0];
        const dmb_flow_state flow = flow_in(&h);
        assert_true(energy.loads < 0.0 || far < 0.0);
        check_below("energy that is missing over that of weight", fabs(energy.unexplained / energy.gravity), 1e-9);
        check_below("energy balance over that of weight", fabs(energy.balance / energy.gravity), 2e-3);
        assert_true(flow.rate == e.flow_rate);
        rig_close(&h.s);
    }
}

static void refused(const dmb_environment_def *e, int32_t expected, const char *why)
{
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    assert_int_equal(dmb_model_set_environment(s.model, e), expected);
    assert_non_null(strstr(dmb_model_message(s.model), why));
    rig_close(&s);
}

static void compile_refuses(const dmb_pipe_def *pipe, const dmb_environment_def *e, int32_t expected, const char *why)
{
    hanging h = describe(pipe, e, 2);
    assert_int_equal(dmb_model_compile(h.s.model, NULL), expected);
    assert_non_null(strstr(dmb_model_message(h.s.model), why));
    rig_close(&h.s);
}

static void what_it_cannot_is_refused(void **state)
{
    dmb_environment_def e = mud_of(0.01, 0.0);
    dmb_pipe_def pipe = pipe_of(DMB_PIPE_FLEXIBLE);
    (void)state;
    e.consistency = 0.0;
    refused(&e, DMB_ERR_VALUE, "consistency");
    e = mud_of(0.01, -1.0);
    refused(&e, DMB_ERR_VALUE, "nozzle_area");
    e = mud_of((double)NAN, 0.0);
    refused(&e, DMB_ERR_NOT_FINITE, "flow_rate");
    e = mud_of(0.01, 0.0);
    e.flow_exponent = 1.2;
    refused(&e, DMB_ERR_VALUE, "flow_exponent");
    e.flow_exponent = 1.0;
    e.fluid_density = 0.0;
    refused(&e, DMB_ERR_VALUE, "fluid_density");
    e = mud_of(0.01, 0.0);
    pipe.inner_diameter = 0.0;
    compile_refuses(&pipe, &e, DMB_ERR_GEOMETRY, "inner diameter");
    pipe = pipe_of(DMB_PIPE_FLEXIBLE);
    pipe.outer_diameter = hole;
    compile_refuses(&pipe, &e, DMB_ERR_GEOMETRY, "annulus");
    pipe = pipe_of(DMB_PIPE_FLEXIBLE);
    e = mud_of(100.0, 0.0);
    compile_refuses(&pipe, &e, DMB_ERR_VALUE, "Reynolds");
    e = mud_of(1e-6, 0.0);
    e.inner_density = 2000.0;
    compile_refuses(&pipe, &e, DMB_ERR_VALUE, "falls by itself");
    e = mud_of(0.0, 0.0);
    hanging h = describe(&pipe, &e, 1);
    (void)mechanism_start(&h.s, NULL);
    dmb_flow_state flow = dmb_flow_state_default();
    must(&h.s, dmb_query_flow(h.s.sim, &flow));
    assert_true(flow.rate == 0.0 && flow.pump_pressure == 0.0 && flow.drag == 0.0);
    rig_close(&h.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forces_on_the_steel_balance),
        cmocka_unit_test(poiseuille),
        cmocka_unit_test(pull_of_every_kind),
        cmocka_unit_test(stretch_and_stress),
        cmocka_unit_test(a_run_in_time),
        cmocka_unit_test(what_it_cannot_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
