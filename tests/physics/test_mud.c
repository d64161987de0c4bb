/* Mud of two densities, its inertia, and bodies in it, against closed forms: hook load, true and effective axial force
 * of a hanging string, torque and drag, frequencies in an annulus, a body that falls and one that rises. Equations:
 * eq:mud.effective, eq:mud.added-mass. */
#include <string.h>

#include "drillmbd/analyse.h"
#include "mechanism.h"
#include "modal.h"

static const double g = 9.81, outer = 0.089, inner = 0.07, steel = 7850.0, depth = 60.0;
static const double heavy = 1400.0, light = 1000.0;

static double ring(double D, double d)
{
    return PI / 4.0 * (D - d) * (D + d);
}

static void set_mud(rig *s, double outside, double inside, double added, int32_t down)
{
    dmb_environment_def e = dmb_environment_def_default();
    e.gravity[2] = 0.0;
    e.gravity[0] = down ? g : 0.0;
    e.fluid_density = outside;
    e.inner_density = inside;
    e.added_mass = added;
    must_model(s, dmb_model_set_environment(s->model, &e));
}

static dmb_pipe_def pipe_of(int32_t kind)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.kind = kind;
    pipe.outer_diameter = outer;
    pipe.inner_diameter = inner;
    pipe.density = steel;
    pipe.length = 6.0;
    return pipe;
}

/* ---- Hanging ----------------------------------------------------------------------------------------------------- */

typedef struct hanging {
    rig s;
    dmb_id string, density;
} hanging;

static hanging hang(int32_t kind, double outside, double inside)
{
    const double down[3] = {1.0, 0.0, 0.0};
    hanging h;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_input_def input = dmb_input_def_default();
    dmb_pipe_def pipe = pipe_of(kind);
    rig_open(&h.s, 0.0, 0.0, 0.0);
    set_mud(&h.s, outside, inside, 0.0, 1);
    memcpy(wall.direction, down, sizeof down);
    wall.diameter = 0.2;
    add_wall(&h.s, &wall);
    string.start_free = DMB_FREE_NONE;
    h.string = pipe.string = add_string(&h.s, &string);
    (void)add_pipes(&h.s, &pipe, 10);
    strcpy(input.name, "density");
    input.target = DMB_TARGET_FLUID_DENSITY;
    must_model(&h.s, dmb_model_add_input(h.s.model, &input, &h.density));
    (void)mechanism_start(&h.s, NULL);
    must(&h.s, dmb_analysis_static(h.s.sim, NULL, NULL));
    return h;
}

static double value_of(const hanging *h, int32_t quantity, dmb_place place)
{
    const dmb_output output = {.place = place, .quantity = quantity};
    double value = 0.0;
    must(&h->s, dmb_query_output(h->s.sim, &output, &value));
    return value;
}

static double hook_load(double outside, double inside)
{
    return (steel * ring(outer, inner) + inside * ring(inner, 0.0) - outside * ring(outer, 0.0)) * g * depth;
}

static void check_hanging(int32_t kind)
{
    hanging h = hang(kind, heavy, light);
    const dmb_place top = dmb_station(h.string, 0, 0.0), middle = dmb_station(h.string, 5, 0.5);
    const double load = hook_load(heavy, light), at = 33.0;
    const double pressures = value_of(&h, DMB_OUTPUT_PROFILE + DMB_PROFILE_X, middle) * g *
                             (heavy * ring(outer, 0.0) - light * ring(inner, 0.0));
    check_relative("hook load in two fluids [N]", value_of(&h, DMB_OUTPUT_HOOK_LOAD, top), load, 1e-10);
    check_relative("effective axial force at 33 m [N]",
                   value_of(&h, DMB_OUTPUT_PROFILE + DMB_PROFILE_EFFECTIVE_FORCE, middle), load * (1.0 - at / depth),
                   1e-8);
    check_relative("true axial force there, N_e - p_o A_o + p_i A_i [N]",
                   value_of(&h, DMB_OUTPUT_PROFILE + DMB_PROFILE_AXIAL_FORCE, middle),
                   load * (1.0 - at / depth) - pressures, 1e-8);
    dmb_operation up = dmb_operation_default();
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    (void)dmb_operation_usual(DMB_OPERATION_PICK_UP, &up);
    must(&h.s, dmb_analysis_torque_drag(h.s.sim, NULL, &up, 1, &row));
    check_relative("hook load of torque and drag [N]", row.hook_load, load, 1e-9);
    must(&h.s, dmb_sim_set_input(h.s.sim, h.density, 1200.0)); /* outside alone */
    must(&h.s, dmb_analysis_static(h.s.sim, NULL, NULL));
    check_relative("hook load in another mud outside [N]", value_of(&h, DMB_OUTPUT_HOOK_LOAD, top),
                   hook_load(1200.0, light), 1e-10);
    rig_close(&h.s);
}

static void a_string_hangs_in_two_fluids(void **state)
{
    (void)state;
    check_hanging(DMB_PIPE_FLEXIBLE);
    check_hanging(DMB_PIPE_AXIAL_TORSIONAL);
}

static void equal_fluids_are_one(void **state)
{
    (void)state;
    hanging one = hang(DMB_PIPE_FLEXIBLE, light, -1.0), two = hang(DMB_PIPE_FLEXIBLE, light, light);
    const dmb_place top = dmb_station(one.string, 0, 0.0), below = dmb_station(two.string, 0, 0.0);
    check_relative("hook load in one fluid, inside told or not [N]", value_of(&two, DMB_OUTPUT_HOOK_LOAD, below),
                   value_of(&one, DMB_OUTPUT_HOOK_LOAD, top), 1e-15);
    rig_close(&one.s);
    rig_close(&two.s);
}

/* ---- Inertia ----------------------------------------------------------------------------------------------------- */

/* Lowest bending frequency of a clamped pipe, with the first axial one in the same list. */
static double lowest(double outside, double inside, double added, double hole)
{
    rig s;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = pipe_of(DMB_PIPE_FLEXIBLE);
    rig_open(&s, 0.0, 0.0, 0.0);
    set_mud(&s, outside, inside, added, 0);
    if (hole > 0.0) {
        dmb_wall_def wall = dmb_wall_def_default();
        wall.diameter = hole;
        wall.normal_law = DMB_NORMAL_NONE;
        add_wall(&s, &wall);
    }
    string.start_free = DMB_FREE_NONE;
    pipe.section_inertia[1] = 1e-5; /* next to none across: Euler and Bernoulli */
    pipe.elements = 8;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    (void)mechanism_start(&s, NULL);
    dmb_modes *modes = all_modes(&s, 0);
    const double frequency = mode_at(modes, 0).frequency;
    dmb_modes_destroy(&modes);
    rig_close(&s);
    return frequency;
}

static void mud_goes_along_sideways(void **state)
{
    const double m = steel * ring(outer, inner), hole = 0.12;
    const double in = light * ring(inner, 0.0), out = heavy * ring(outer, 0.0);
    const double annulus = (hole * hole + outer * outer) / (hole * hole - outer * outer);
    (void)state;
    const double dry = lowest(0.0, -1.0, 0.0, 0.0);
    check_relative("frequency in mud without inertia", lowest(heavy, light, 0.0, 0.0), dry, 1e-12);
    check_relative("frequency far from walls", lowest(heavy, light, 1.0, 0.0), dry * sqrt(m / (m + in + out)), 1e-6);
    check_relative("frequency in an annulus (Fritz 1972)", lowest(heavy, light, -1.0, hole),
                   dry * sqrt(m / (m + in + annulus * out)), 1e-6);
}

/* ---- Bodies ------------------------------------------------------------------------------------------------------ */

static void bodies_fall_and_rise(void **state)
{
    const double volumes[2] = {1e-3, 2e-2}, mass = 10.0, time = 0.5;
    (void)state;
    for (int i = 0; i < 2; i++) {
        rig s;
        dmb_body_def body = dmb_body_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        set_mud(&s, light, -1.0, 0.0, 1);
        body.mass = mass;
        body.displaced_volume = volumes[i];
        const dmb_id id = add_body(&s, &body);
        (void)mechanism_start(&s, NULL);
        take_steps(&s, 0.01, 50);
        check_relative("fall of a body in mud [m]", pose_at(&s, dmb_station(id, 0, 0.0)).displacement[0],
                       0.5 * g * (1.0 - light * volumes[i] / mass) * time * time, 1e-12);
        check_below("its energy balance [J]", energy_of(&s).balance, 1e-10);
        rig_close(&s);
    }
}

static void what_it_cannot_is_refused(void **state)
{
    dmb_environment_def e = dmb_environment_def_default();
    dmb_pipe_def pipe = pipe_of(DMB_PIPE_RIGID);
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    e.inner_density = -2.0;
    assert_int_equal(dmb_model_set_environment(s.model, &e), DMB_ERR_VALUE);
    e.inner_density = -1.0;
    e.added_mass = -0.5;
    assert_int_equal(dmb_model_set_environment(s.model, &e), DMB_ERR_VALUE);
    must_model(&s, dmb_model_clear_refused(s.model));
    rig_close(&s);
    e.added_mass = -1.0;
    for (int k = 0; k < 2; k++) {
        pipe.kind = k ? DMB_PIPE_RIGID : DMB_PIPE_FLEXIBLE;
        rig_open(&s, 0.0, 0.0, 0.0);
        must_model(&s, dmb_model_set_environment(s.model, &e));
        (void)add_pipes(&s, &pipe, 1);
        assert_int_equal(dmb_model_compile(s.model, NULL), DMB_ERR_VALUE); /* no wall */
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_string_hangs_in_two_fluids), cmocka_unit_test(equal_fluids_are_one),
        cmocka_unit_test(mud_goes_along_sideways),      cmocka_unit_test(bodies_fall_and_rise),
        cmocka_unit_test(what_it_cannot_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
