/* Buckling of a vertical string that stands on its bit in mud, of two densities and as it flows: the effective force
 * alone rules. Against an integration of the column under N_e (Lubinski 1950), his neutral point, and the string of the
 * same effective weight in air. Equations: eq:mud.effective. */
#include <string.h>

#include "ode.h"
#include "rig.h"

static const double g = 9.81, outer = 0.089, inner = 0.07, steel = 7850.0, hole = 0.15;

static double ring(double D, double d)
{
    return PI / 4.0 * (D - d) * (D + d);
}

typedef struct standing {
    rig s;
    dmb_id string, push, weight;
    double length, EI;
    double per_metre; /* [N/m] effective weight */
    double thrust;    /* [N] of the flow */
} standing;

/* Clamped at the rig, its far end on the axis of the hole, which it slides along; pushed by 1 N times a factor. */
static void stand(standing *c, const dmb_environment_def *mud, double section_mass, double weight_on_bit)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    const double EI = 2.1e11 * PI / 64.0 * (pow(outer, 4.0) - pow(inner, 4.0));
    dmb_pipe_def pipe = beam_pipe(c->length / 10.0, 4, 2.1e11 * ring(outer, inner), 1e6 * EI, EI, EI);
    dmb_load_def push = dmb_load_def_default();
    const dmb_segment off = dmb_segment_default();
    rig_open(&c->s, 0.0, 0.0, 0.0);
    must_model(&c->s, dmb_model_set_environment(c->s.model, mud));
    wall.diameter = hole;
    wall.normal_law = DMB_NORMAL_NONE;
    (void)add_wall(&c->s, &wall);
    string.start_free = DMB_FREE_NONE;
    pipe.outer_diameter = outer;
    pipe.inner_diameter = inner;
    pipe.density = steel;
    pipe.section_mass = section_mass;
    pipe.string = add_string(&c->s, &string);
    c->string = add_pipes(&c->s, &pipe, 10);
    (void)add_joint_between(&c->s, DMB_JOINT_POINT_ON_HOLE, dmb_station((dmb_id){0, 0}, 0, 0.0),
                            dmb_station(c->string, 9, 1.0));
    push.place = dmb_station(c->string, 9, 1.0);
    push.frame = DMB_FRAME_WORLD;
    push.force[0] = -1.0;
    push.time_function = add_time_function(&c->s, &off, 1);
    c->push = add_load(&c->s, &push);
    push.force[0] = -weight_on_bit;
    push.time_function = (dmb_id){0, 0};
    if (weight_on_bit > 0.0) c->weight = add_load(&c->s, &push);
    (void)rig_start(&c->s, NULL);
    (void)find_equilibrium(&c->s, NULL);
    c->EI = EI;
}

static dmb_environment_def mud_of(double outside, double inside, double rate)
{
    dmb_environment_def e = dmb_environment_def_default();
    e.gravity[2] = 0.0;
    e.gravity[0] = g;
    e.fluid_density = outside;
    e.inner_density = inside;
    e.flow_rate = rate;
    e.consistency = 0.02;
    e.nozzle_area = rate > 0.0 ? 4e-4 : 0.0;
    return e;
}

static double critical_push(const standing *c)
{
    dmb_buckling *found = NULL;
    dmb_buckling_options options = dmb_buckling_options_default();
    double factor = 0.0;
    options.scale = DMB_SCALE_PART;
    options.part = c->push;
    options.count = 1;
    must(&c->s, dmb_analysis_buckling(c->s.sim, &options, &found));
    assert_int_equal(dmb_buckling_factor(found, 0, &factor), DMB_OK);
    dmb_buckling_destroy(&found);
    return factor;
}

/* ---- The column -------------------------------------------------------------------------------------------------- */

typedef struct column {
    const standing *c;
    double push, side; /* [N] side: the constant force across */
} column;

/* EI t'' - N_e t = side, t = dy/ds; y. */
static void bend(void *context, double s, const double *y, double *rate)
{
    const column *k = context;
    const double N = k->c->per_metre * (k->c->length - s) - k->c->thrust - k->push;
    rate[0] = y[1];
    rate[1] = (N * y[0] + k->side) / k->c->EI;
    rate[2] = y[0];
}

/* 0 where a shape with t(0) = 0, t'(L) = 0, y(L) = 0 exists. */
static double condition(const standing *c, double push)
{
    double bent[3] = {0.0, 1.0, 0.0}, across[3] = {0.0, 0.0, 0.0};
    column k = {c, push, 0.0};
    ode_solve(bend, &k, 0.0, c->length, 200, 3, bent);
    k.side = 1.0;
    ode_solve(bend, &k, 0.0, c->length, 200, 3, across);
    return bent[1] * across[2] - across[1] * bent[2];
}

static double critical_of_column(const standing *c)
{
    const double unit = cbrt(c->EI * c->per_metre * c->per_metre), step = 0.02 * unit;
    double low = 0.5 * unit - c->thrust, at = condition(c, low);
    while (at * condition(c, low + step) > 0.0) low += step;
    double high = low + step;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        if (at * condition(c, middle) > 0.0)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static double weight_in(double outside, double inside)
{
    return g * (steel * ring(outer, inner) + inside * ring(inner, 0.0) - outside * ring(outer, 0.0));
}

static void effective_force_rules(void **state)
{
    static const double muds[3][2] = {{0.0, 0.0}, {1600.0, 1.2}, {1000.0, 2200.0}};
    (void)state;
    for (int i = 0; i < 3; i++) {
        standing c = {.length = 120.0}, alone = {.length = 120.0};
        const dmb_environment_def mud = mud_of(muds[i][0], muds[i][1], 0.0), air = mud_of(0.0, -1.0, 0.0);
        c.per_metre = weight_in(muds[i][0], muds[i][1]);
        stand(&c, &mud, steel * ring(outer, inner), 0.0);
        stand(&alone, &air, c.per_metre / g, 0.0);
        const double push = critical_push(&c), unit = cbrt(c.EI * c.per_metre * c.per_metre);
        print_message("    %4.0f outside, %4.0f inside: %.3f N, %.4f (EI w^2)^(1/3)\n", muds[i][0], muds[i][1], push,
                      push / unit);
        check_relative("column under the effective force", push, critical_of_column(&c), 2e-5);
        check_relative("string of that weight in air", push, critical_push(&alone), 1e-9);
        rig_close(&c.s);
        rig_close(&alone.s);
    }
}

static void flow_takes_its_share(void **state)
{
    standing c = {.length = 120.0};
    const dmb_environment_def mud = mud_of(1200.0, 1150.0, 0.03);
    dmb_flow_state flow = dmb_flow_state_default();
    (void)state;
    stand(&c, &mud, steel * ring(outer, inner), 0.0);
    must(&c.s, dmb_query_flow(c.s.sim, &flow));
    c.thrust = flow.thrust;
    c.per_metre = weight_in(1200.0, 1150.0) - flow.drag / c.length;
    const double push = critical_push(&c);
    assert_true(flow.drag > 0.05 * weight_in(1200.0, 1150.0) * c.length);
    check_relative("column under the effective force of the flow", push, critical_of_column(&c), 2e-5);
    rig_close(&c.s);
}

/* W/w above the bit, whatever the true axial force there. */
static void neutral_point(void **state)
{
    const double W = 10e3;
    standing c = {.length = 120.0};
    const dmb_environment_def mud = mud_of(1600.0, 1.2, 0.0);
    (void)state;
    c.per_metre = weight_in(1600.0, 1.2);
    stand(&c, &mud, steel * ring(outer, inner), W);
    const double at = c.length - W / c.per_metre;
    const dmb_output effective = {.place = dmb_station(c.string, (uint32_t)(at / 12.0), fmod(at, 12.0) / 12.0),
                                  .quantity = DMB_OUTPUT_PROFILE + DMB_PROFILE_EFFECTIVE_FORCE};
    dmb_output true_force = effective;
    double N = 1.0, there = 0.0;
    true_force.quantity = DMB_OUTPUT_PROFILE + DMB_PROFILE_AXIAL_FORCE;
    must(&c.s, dmb_query_output(c.s.sim, &effective, &N));
    must(&c.s, dmb_query_output(c.s.sim, &true_force, &there));
    check_below("effective force at the neutral point over W", fabs(N) / W, 1e-8);
    check_relative("true force there, -(p_o A_o - p_i A_i) [N]", there,
                   -g * at * (1600.0 * ring(outer, 0.0) - 1.2 * ring(inner, 0.0)), 1e-4);
    rig_close(&c.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(effective_force_rules),
        cmocka_unit_test(flow_takes_its_share),
        cmocka_unit_test(neutral_point),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
