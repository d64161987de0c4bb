/* Analyses, their results, recorders, windows and look-ups: every pointer that has to be given is missing once, every
 * result is once some memory that is none; the status says which, and the sim is as it was. */
#include <string.h>

#include "rig.h"

static struct {
    rig r;
    dmb_id string, drive;
    dmb_place place;
    dmb_modes *modes;
    dmb_buckling *buckling;
    dmb_response *response;
    dmb_state_space *space;
    dmb_fatigue *fatigue;
    dmb_window *window;
    dmb_sensitivity *sensitivity;
    dmb_state_equation *equation;
    dmb_sim *low, *high, *beside;
} s;

static uint64_t junk[64]; /* no object of any kind */

static void expect(int32_t status, int32_t wanted, const char *call)
{
    if (status != wanted) fail_msg("%s: %s, wanted %s", call, dmb_status_name(status), dmb_status_name(wanted));
}
#define MISSING(call) expect(call, DMB_ERR_NULL, #call)
#define NO_OBJECT(call) expect(call, DMB_ERR_HANDLE, #call)
#define JUNK(type) ((type *)(void *)junk)

/* ---- Scene ------------------------------------------------------------------------------------------------------- */

static const dmb_output height = {.quantity = DMB_OUTPUT_POSITION_Y};

static dmb_excitation force(void)
{
    dmb_excitation input = dmb_excitation_default();
    input.place = s.place;
    return input;
}

static dmb_output motion(void)
{
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    output.place = s.place;
    return output;
}

static dmb_fatigue_options fatigue_options(void)
{
    dmb_fatigue_options options = dmb_fatigue_options_default();
    options.classes = 16;
    options.curve_stress = 1e8;
    options.slope = 5.0;
    return options;
}

static dmb_parameter parameter(void)
{
    dmb_parameter p = dmb_parameter_default();
    p.low = s.low;
    p.high = s.high;
    p.step = 1e-6;
    return p;
}

static void describe(void)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def push = dmb_load_def_default();
    memset(&s, 0, sizeof s);
    rig_open(&s.r, 0.0, 0.0, -9.81);
    s.string = add_pipes(&s.r, &pipe, 3);
    s.place = dmb_station(s.string, 2, 1.0);
    s.drive = add_simple_drive(&s.r, DMB_DRIVE_MOTION, s.string, DMB_X, add_constant(&s.r, 0.0));
    (void)add_simple_drive(&s.r, DMB_DRIVE_MOTION, s.string, DMB_RX, add_constant(&s.r, 0.0));
    push.place = s.place;
    push.force[0] = -10.0;
    (void)add_load(&s.r, &push);
    (void)rig_start(&s.r, NULL);
    must_model(&s.r, dmb_sim_create(s.r.model, NULL, &s.low));
    must_model(&s.r, dmb_sim_create(s.r.model, NULL, &s.high));
    must_model(&s.r, dmb_sim_create(s.r.model, NULL, &s.beside));
}

static int set_up(void **state)
{
    (void)state;
    describe();
    const dmb_excitation input = force();
    const dmb_output output = motion();
    const dmb_parameter p = parameter();
    const dmb_fatigue_options fatigue = fatigue_options();
    dmb_modes_options modes = dmb_modes_options_default();
    dmb_buckling_options buckling = dmb_buckling_options_default();
    dmb_response_options response = dmb_response_options_default();
    dmb_output reading = height;
    reading.place = s.place;
    modes.count = 2;
    response.points = 3;
    (void)find_equilibrium(&s.r, NULL);
    must(&s.r, dmb_analysis_modes(s.r.sim, &modes, &s.modes));
    buckling.follow = 0;
    must(&s.r, dmb_analysis_buckling(s.r.sim, &buckling, &s.buckling));
    must(&s.r, dmb_analysis_response(s.r.sim, &response, &input, 1, &output, 1, &s.response));
    must(&s.r, dmb_analysis_state_space(s.r.sim, NULL, &input, 1, &output, 1, &s.space));
    must(&s.r, dmb_fatigue_create(s.r.sim, &fatigue, &s.place, 1, &s.fatigue));
    must(&s.r, dmb_window_create(s.r.sim, NULL, &reading, 1, &s.window));
    assert_true(dmb_sensitivity_create(s.beside, &p, 1, &s.sensitivity) >= 0);
    must(&s.r, dmb_state_equation_create(s.beside, &s.equation));
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    dmb_state_equation_destroy(&s.equation);
    dmb_sensitivity_destroy(&s.sensitivity);
    dmb_window_destroy(&s.window);
    dmb_fatigue_destroy(&s.fatigue);
    dmb_state_space_destroy(&s.space);
    dmb_response_destroy(&s.response);
    dmb_buckling_destroy(&s.buckling);
    dmb_modes_destroy(&s.modes);
    dmb_sim_destroy(&s.low);
    dmb_sim_destroy(&s.high);
    dmb_sim_destroy(&s.beside);
    rig_close(&s.r);
    return 0;
}

/* ---- Results ----------------------------------------------------------------------------------------------------- */

static void of_modes(void **state)
{
    (void)state;
    dmb_modes *made = NULL;
    dmb_modes_info info = dmb_modes_info_default();
    dmb_mode mode = dmb_mode_default();
    dmb_mode_shape shape = dmb_mode_shape_default();
    double kinetic, strain;
    MISSING(dmb_analysis_modes(NULL, NULL, &made));
    MISSING(dmb_analysis_modes(s.r.sim, NULL, NULL));
    MISSING(dmb_modes_get_info(NULL, &info));
    MISSING(dmb_modes_get_info(s.modes, NULL));
    MISSING(dmb_modes_get(NULL, 0, &mode));
    MISSING(dmb_modes_get(s.modes, 0, NULL));
    MISSING(dmb_modes_shape(NULL, 0, s.place, &shape));
    MISSING(dmb_modes_shape(s.modes, 0, s.place, NULL));
    MISSING(dmb_modes_part(NULL, 0, s.string, 0, &kinetic, &strain));
    MISSING(dmb_modes_part(s.modes, 0, s.string, 0, NULL, NULL));
    MISSING(dmb_write_vtk_mode(NULL, 0, 1.0, 0.0, 2, "/dev/null"));
    MISSING(dmb_write_vtk_mode(s.modes, 0, 1.0, 0.0, 2, NULL));
    NO_OBJECT(dmb_modes_get_info(JUNK(dmb_modes), &info));
    NO_OBJECT(dmb_modes_get(JUNK(dmb_modes), 0, &mode));
    NO_OBJECT(dmb_modes_shape(JUNK(dmb_modes), 0, s.place, &shape));
    NO_OBJECT(dmb_modes_part(JUNK(dmb_modes), 0, s.string, 0, &kinetic, &strain));
    NO_OBJECT(dmb_write_vtk_mode(JUNK(dmb_modes), 0, 1.0, 0.0, 2, "/dev/null"));
}

static void of_buckling(void **state)
{
    (void)state;
    dmb_buckling *made = NULL;
    dmb_buckling_info info = dmb_buckling_info_default();
    double factor, shape[6];
    MISSING(dmb_analysis_buckling(NULL, NULL, &made));
    MISSING(dmb_analysis_buckling(s.r.sim, NULL, NULL));
    MISSING(dmb_buckling_get_info(NULL, &info));
    MISSING(dmb_buckling_get_info(s.buckling, NULL));
    MISSING(dmb_buckling_factor(NULL, 0, &factor));
    MISSING(dmb_buckling_factor(s.buckling, 0, NULL));
    MISSING(dmb_buckling_shape(NULL, 0, s.place, shape));
    MISSING(dmb_buckling_shape(s.buckling, 0, s.place, NULL));
    NO_OBJECT(dmb_buckling_get_info(JUNK(dmb_buckling), &info));
    NO_OBJECT(dmb_buckling_factor(JUNK(dmb_buckling), 0, &factor));
    NO_OBJECT(dmb_buckling_shape(JUNK(dmb_buckling), 0, s.place, shape));
    assert_int_equal(dmb_buckling_count(NULL), 0);
    assert_int_equal(dmb_buckling_count(JUNK(dmb_buckling)), 0);
    assert_int_not_equal(dmb_buckling_count(s.buckling), 0);
}

static void of_responses(void **state)
{
    (void)state;
    dmb_response *made = NULL;
    const dmb_excitation input = force();
    const dmb_output output = motion();
    uint32_t dimensions[3];
    double values[8];
    MISSING(dmb_analysis_response(NULL, NULL, &input, 1, &output, 1, &made));
    MISSING(dmb_analysis_response(s.r.sim, NULL, NULL, 1, &output, 1, &made));
    MISSING(dmb_analysis_response(s.r.sim, NULL, &input, 1, NULL, 1, &made));
    MISSING(dmb_analysis_response(s.r.sim, NULL, &input, 1, &output, 1, NULL));
    MISSING(dmb_response_dimensions(NULL, dimensions));
    MISSING(dmb_response_dimensions(s.response, NULL));
    MISSING(dmb_response_frequencies(NULL, values));
    MISSING(dmb_response_frequencies(s.response, NULL));
    MISSING(dmb_response_transfer(NULL, 0, 0, values));
    MISSING(dmb_response_transfer(s.response, 0, 0, NULL));
    MISSING(dmb_response_write_csv(NULL, NULL, "/dev/null"));
    MISSING(dmb_response_write_csv(s.response, NULL, NULL));
    NO_OBJECT(dmb_response_dimensions(JUNK(dmb_response), dimensions));
    NO_OBJECT(dmb_response_frequencies(JUNK(dmb_response), values));
    NO_OBJECT(dmb_response_transfer(JUNK(dmb_response), 0, 0, values));
    NO_OBJECT(dmb_response_write_csv(JUNK(dmb_response), NULL, "/dev/null"));
    expect(dmb_response_transfer(s.response, 1, 0, values), DMB_ERR_VALUE, "excitation 1 of one");
    expect(dmb_response_transfer(s.response, 0, 1, values), DMB_ERR_VALUE, "output 1 of one");
}

static void of_stepped_sines_and_speeds(void **state)
{
    (void)state;
    const dmb_output output = motion();
    const double limit = 1.0;
    double amplitudes[8];
    dmb_order order = dmb_order_default();
    dmb_speed_band bands[2] = {dmb_speed_band_default(), dmb_speed_band_default()};
    uint32_t count = 2;
    order.excitation = force();
    MISSING(dmb_analysis_stepped_sine(NULL, 10.0, NULL, &output, 1, amplitudes, NULL));
    MISSING(dmb_analysis_stepped_sine(s.r.sim, 10.0, NULL, NULL, 1, amplitudes, NULL));
    MISSING(dmb_analysis_stepped_sine(s.r.sim, 10.0, NULL, &output, 1, NULL, NULL));
    MISSING(dmb_analysis_speeds(NULL, NULL, &order, 1, &output, &limit, 1, bands, &count, NULL));
    MISSING(dmb_analysis_speeds(s.r.sim, NULL, NULL, 1, &output, &limit, 1, bands, &count, NULL));
    MISSING(dmb_analysis_speeds(s.r.sim, NULL, &order, 1, NULL, &limit, 1, bands, &count, NULL));
    MISSING(dmb_analysis_speeds(s.r.sim, NULL, &order, 1, &output, NULL, 1, bands, &count, NULL));
    MISSING(dmb_analysis_speeds(s.r.sim, NULL, &order, 1, &output, &limit, 1, NULL, &count, NULL));
    MISSING(dmb_analysis_speeds(s.r.sim, NULL, &order, 1, &output, &limit, 1, bands, NULL, NULL));
}

static void of_state_spaces(void **state)
{
    (void)state;
    dmb_state_space *made = NULL;
    const dmb_excitation input = force();
    const dmb_output output = motion();
    dmb_state_space_info info = dmb_state_space_info_default();
    double values[24];
    uint32_t rows[24], count;
    uint64_t length = 24;
    dmb_row row = dmb_row_default();
    MISSING(dmb_analysis_state_space(NULL, NULL, &input, 1, &output, 1, &made));
    MISSING(dmb_analysis_state_space(s.r.sim, NULL, NULL, 1, &output, 1, &made));
    MISSING(dmb_analysis_state_space(s.r.sim, NULL, &input, 1, NULL, 1, &made));
    MISSING(dmb_analysis_state_space(s.r.sim, NULL, &input, 1, &output, 1, NULL));
    MISSING(dmb_state_space_get_info(NULL, &info));
    MISSING(dmb_state_space_get_info(s.space, NULL));
    MISSING(dmb_state_space_dense(NULL, 0, values));
    MISSING(dmb_state_space_dense(s.space, 0, NULL));
    MISSING(dmb_state_space_sparse(NULL, 0, rows, rows, values, &length));
    MISSING(dmb_state_space_sparse(s.space, 0, rows, rows, values, NULL));
    MISSING(dmb_state_space_shapes(NULL, values));
    MISSING(dmb_state_space_shapes(s.space, NULL));
    MISSING(dmb_analysis_array(NULL, DMB_ARRAY_RESIDUAL, values, &length));
    MISSING(dmb_analysis_array(s.r.sim, DMB_ARRAY_RESIDUAL, values, NULL));
    MISSING(dmb_query_row(NULL, 0, &row));
    MISSING(dmb_query_row(s.r.sim, 0, NULL));
    MISSING(dmb_analysis_place_rows(NULL, s.place, 0, 0, rows, values, &count));
    MISSING(dmb_analysis_place_rows(s.r.sim, s.place, 0, 0, NULL, values, &count));
    MISSING(dmb_analysis_place_rows(s.r.sim, s.place, 0, 0, rows, NULL, &count));
    MISSING(dmb_analysis_place_rows(s.r.sim, s.place, 0, 0, rows, values, NULL));
    MISSING(dmb_query_constraint_rows(NULL, s.string, rows, &count));
    MISSING(dmb_query_constraint_rows(s.r.sim, s.string, NULL, &count));
    MISSING(dmb_query_constraint_rows(s.r.sim, s.string, rows, NULL));
    NO_OBJECT(dmb_state_space_get_info(JUNK(dmb_state_space), &info));
    NO_OBJECT(dmb_state_space_dense(JUNK(dmb_state_space), 0, values));
    NO_OBJECT(dmb_state_space_sparse(JUNK(dmb_state_space), 0, rows, rows, values, &length));
    NO_OBJECT(dmb_state_space_shapes(JUNK(dmb_state_space), values));
}

static void of_fatigue_and_windows(void **state)
{
    (void)state;
    const dmb_fatigue_options options = fatigue_options();
    dmb_fatigue_result result = dmb_fatigue_result_default();
    dmb_window_result reading = dmb_window_result_default();
    dmb_window *window = NULL;
    dmb_fatigue *fatigue = NULL;
    size_t size = 0;
    double cycles[16];
    MISSING(dmb_fatigue_create(NULL, &options, &s.place, 1, &fatigue));
    MISSING(dmb_fatigue_create(s.r.sim, &options, NULL, 1, &fatigue));
    MISSING(dmb_fatigue_create(s.r.sim, &options, &s.place, 1, NULL));
    MISSING(dmb_fatigue_take(NULL, s.r.sim));
    MISSING(dmb_fatigue_take(s.fatigue, NULL));
    MISSING(dmb_fatigue_get(NULL, 0, &result));
    MISSING(dmb_fatigue_get(s.fatigue, 0, NULL));
    MISSING(dmb_fatigue_histogram(NULL, 0, cycles));
    MISSING(dmb_fatigue_histogram(s.fatigue, 0, NULL));
    MISSING(dmb_fatigue_snapshot_size(NULL, &size));
    MISSING(dmb_fatigue_snapshot_size(s.fatigue, NULL));
    MISSING(dmb_fatigue_snapshot(NULL, cycles, sizeof cycles));
    MISSING(dmb_fatigue_snapshot(s.fatigue, NULL, sizeof cycles));
    MISSING(dmb_fatigue_restore(NULL, cycles, sizeof cycles));
    MISSING(dmb_fatigue_restore(s.fatigue, NULL, sizeof cycles));
    MISSING(dmb_window_create(NULL, NULL, &height, 1, &window));
    MISSING(dmb_window_create(s.r.sim, NULL, NULL, 1, &window));
    MISSING(dmb_window_create(s.r.sim, NULL, &height, 1, NULL));
    MISSING(dmb_window_take(NULL, s.r.sim));
    MISSING(dmb_window_take(s.window, NULL));
    MISSING(dmb_window_get(NULL, 0, &reading));
    MISSING(dmb_window_get(s.window, 0, NULL));
    MISSING(dmb_window_reset(NULL));
    NO_OBJECT(dmb_fatigue_take(JUNK(dmb_fatigue), s.r.sim));
    NO_OBJECT(dmb_fatigue_take(s.fatigue, JUNK(dmb_sim)));
    NO_OBJECT(dmb_fatigue_get(JUNK(dmb_fatigue), 0, &result));
    NO_OBJECT(dmb_fatigue_histogram(JUNK(dmb_fatigue), 0, cycles));
    NO_OBJECT(dmb_fatigue_snapshot_size(JUNK(dmb_fatigue), &size));
    NO_OBJECT(dmb_fatigue_snapshot(JUNK(dmb_fatigue), cycles, sizeof cycles));
    NO_OBJECT(dmb_fatigue_restore(JUNK(dmb_fatigue), cycles, sizeof cycles));
    NO_OBJECT(dmb_window_take(JUNK(dmb_window), s.r.sim));
    NO_OBJECT(dmb_window_take(s.window, JUNK(dmb_sim)));
    NO_OBJECT(dmb_window_get(JUNK(dmb_window), 0, &reading));
    NO_OBJECT(dmb_window_reset(JUNK(dmb_window)));
}

static void of_state_equations(void **state)
{
    (void)state;
    dmb_state_equation *made = NULL;
    double time, y[64], rate[64];
    uint32_t rows[32];
    assert_in_range(dmb_state_equation_count(s.equation), 1, 32);
    MISSING(dmb_state_equation_create(NULL, &made));
    MISSING(dmb_state_equation_create(s.beside, NULL));
    NO_OBJECT(dmb_state_equation_create(JUNK(dmb_sim), &made));
    assert_null(made);
    MISSING(dmb_state_equation_rows(NULL, rows));
    MISSING(dmb_state_equation_rows(s.equation, NULL));
    NO_OBJECT(dmb_state_equation_rows(JUNK(dmb_state_equation), rows));
    MISSING(dmb_state_equation_origin(NULL, &time, y));
    MISSING(dmb_state_equation_origin(s.equation, &time, NULL));
    NO_OBJECT(dmb_state_equation_origin(JUNK(dmb_state_equation), &time, y));
    expect(dmb_state_equation_origin(s.equation, NULL, y), DMB_OK, "origin without its time");
    MISSING(dmb_state_equation_rate(NULL, 0.0, y, rate));
    MISSING(dmb_state_equation_rate(s.equation, 0.0, NULL, rate));
    MISSING(dmb_state_equation_rate(s.equation, 0.0, y, NULL));
    NO_OBJECT(dmb_state_equation_rate(JUNK(dmb_state_equation), 0.0, y, rate));
    MISSING(dmb_state_equation_begin(NULL, 0.0, y));
    MISSING(dmb_state_equation_begin(s.equation, 0.0, NULL));
    NO_OBJECT(dmb_state_equation_begin(JUNK(dmb_state_equation), 0.0, y));
    assert_int_equal(dmb_state_equation_count(NULL), 0);
    assert_int_equal(dmb_state_equation_count(JUNK(dmb_state_equation)), 0);
    assert_null(dmb_state_equation_sim(NULL));
    assert_null(dmb_state_equation_sim(JUNK(dmb_state_equation)));
}

static void of_sensitivities(void **state)
{
    (void)state;
    dmb_parameter p = parameter();
    dmb_sensitivity *made = NULL;
    double values[32], derivatives[32];
    uint32_t rows;
    uint64_t kinks;
    MISSING(dmb_sensitivity_create(NULL, &p, 1, &made));
    MISSING(dmb_sensitivity_create(s.beside, NULL, 1, &made));
    MISSING(dmb_sensitivity_create(s.beside, &p, 1, NULL));
    p.high = NULL;
    MISSING(dmb_sensitivity_create(s.beside, &p, 1, &made));
    assert_non_null(strstr(dmb_sim_message(s.beside), "high"));
    p.high = JUNK(dmb_sim);
    NO_OBJECT(dmb_sensitivity_create(s.beside, &p, 1, &made));
    p = parameter();
    p.low = JUNK(dmb_sim);
    NO_OBJECT(dmb_sensitivity_create(s.beside, &p, 1, &made));
    MISSING(dmb_sensitivity_step(NULL, 1e-3, NULL));
    MISSING(dmb_sensitivity_advance(NULL, 1e-3, NULL));
    MISSING(dmb_sensitivity_outputs(NULL, &height, 1, values, derivatives));
    MISSING(dmb_sensitivity_outputs(s.sensitivity, NULL, 1, values, derivatives));
    MISSING(dmb_sensitivity_rows(NULL, 0, values, derivatives, &rows));
    MISSING(dmb_sensitivity_rows(s.sensitivity, 0, values, derivatives, NULL));
    MISSING(dmb_sensitivity_kinks(NULL, 0, &kinks));
    MISSING(dmb_sensitivity_kinks(s.sensitivity, 0, NULL));
    NO_OBJECT(dmb_sensitivity_step(JUNK(dmb_sensitivity), 1e-3, NULL));
    NO_OBJECT(dmb_sensitivity_advance(JUNK(dmb_sensitivity), 1e-3, NULL));
    NO_OBJECT(dmb_sensitivity_outputs(JUNK(dmb_sensitivity), &height, 1, values, derivatives));
    NO_OBJECT(dmb_sensitivity_rows(JUNK(dmb_sensitivity), 0, values, derivatives, &rows));
    NO_OBJECT(dmb_sensitivity_kinks(JUNK(dmb_sensitivity), 0, &kinks));
    expect(dmb_sensitivity_kinks(s.sensitivity, 1, &kinks), DMB_ERR_VALUE, "kinks of parameter 1 of one");
    expect(dmb_sensitivity_rows(s.sensitivity, 1, values, derivatives, &rows), DMB_ERR_VALUE, "rows of it");
    expect(dmb_sensitivity_rows(s.sensitivity, 0, NULL, NULL, &rows), DMB_OK, "number of rows alone");
}

/* ---- Torque and drag --------------------------------------------------------------------------------------------- */

static void of_torque_and_drag(void **state)
{
    (void)state;
    dmb_operation operation = dmb_operation_default();
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    dmb_hydraulics pressures = dmb_hydraulics_default();
    double depth[4], friction;
    MISSING(dmb_operation_usual(0, NULL));
    MISSING(dmb_analysis_hydraulics(NULL, 1.0, 0.1, &pressures));
    MISSING(dmb_analysis_hydraulics(s.r.sim, 1.0, 0.1, NULL));
    MISSING(dmb_analysis_torque_drag(NULL, NULL, &operation, 1, &row));
    MISSING(dmb_analysis_torque_drag(s.r.sim, NULL, NULL, 1, &row));
    MISSING(dmb_analysis_torque_drag(s.r.sim, NULL, &operation, 1, NULL));
    MISSING(dmb_analysis_torque_drag_profile(NULL, NULL, &operation, 4, depth, NULL, NULL, NULL));
    MISSING(dmb_analysis_torque_drag_profile(s.r.sim, NULL, NULL, 4, depth, NULL, NULL, NULL));
    MISSING(dmb_analysis_friction_factor(NULL, NULL, &operation, 0, 1.0, &friction));
    MISSING(dmb_analysis_friction_factor(s.r.sim, NULL, NULL, 0, 1.0, &friction));
    MISSING(dmb_analysis_friction_factor(s.r.sim, NULL, &operation, 0, 1.0, NULL));
    assert_null(dmb_operation_name(-1));
}

/* ---- Names, inputs, events --------------------------------------------------------------------------------------- */

static void of_names(void **state)
{
    (void)state;
    dmb_model *model = s.r.model;
    dmb_model *none = NULL;
    char name[24];
    dmb_id id;
    uint32_t first, count;
    size_t size;
    MISSING(dmb_model_set_name(NULL, s.string, "a"));
    MISSING(dmb_model_get_name(NULL, s.string, name, sizeof name));
    MISSING(dmb_model_get_name(model, s.string, NULL, sizeof name));
    MISSING(dmb_model_find(NULL, DMB_PART_STRING, "a", &id));
    MISSING(dmb_model_find(model, DMB_PART_STRING, NULL, &id));
    MISSING(dmb_model_find(model, DMB_PART_STRING, "a", NULL));
    MISSING(dmb_model_part(NULL, id.index, &id));
    MISSING(dmb_model_part(model, id.index, NULL));
    MISSING(dmb_model_find_pipes(NULL, "a", &id, &first, &count));
    MISSING(dmb_model_find_pipes(model, NULL, &id, &first, &count));
    MISSING(dmb_model_write(NULL, NULL, 0, &size));
    MISSING(dmb_model_write(model, NULL, 0, NULL));
    MISSING(dmb_model_write(model, NULL, 1, &size));
    MISSING(dmb_model_read(NULL, 1, NULL, &none));
    MISSING(dmb_model_read(name, 1, NULL, NULL));
    NO_OBJECT(dmb_model_write(JUNK(dmb_model), NULL, 0, &size));
    NO_OBJECT(dmb_model_set_name(JUNK(dmb_model), s.string, "a"));
    NO_OBJECT(dmb_model_get_name(JUNK(dmb_model), s.string, name, sizeof name));
    NO_OBJECT(dmb_model_find(JUNK(dmb_model), DMB_PART_STRING, "a", &id));
    NO_OBJECT(dmb_model_part(JUNK(dmb_model), 1, &id));
    NO_OBJECT(dmb_model_find_pipes(JUNK(dmb_model), "a", &id, &first, &count));
}

static void of_inputs(void **state)
{
    (void)state;
    dmb_model *model = s.r.model;
    dmb_input_info info = dmb_input_info_default();
    dmb_input_state value = dmb_input_state_default();
    dmb_id id = s.drive;
    const double number = 1.0;
    uint32_t next = 0;
    dmb_input_record record;
    memset(&record, 0, sizeof record);
    MISSING(dmb_model_get_input(NULL, 0, &info));
    MISSING(dmb_model_get_input(model, 0, NULL));
    MISSING(dmb_model_find_input(NULL, "a", &id));
    MISSING(dmb_model_find_input(model, NULL, &id));
    MISSING(dmb_model_find_input(model, "a", NULL));
    MISSING(dmb_sim_set_inputs(NULL, &id, &number, 1));
    MISSING(dmb_sim_set_inputs(s.r.sim, NULL, &number, 1));
    MISSING(dmb_sim_set_inputs(s.r.sim, &id, NULL, 1));
    MISSING(dmb_sim_get_input(NULL, id, &value));
    MISSING(dmb_sim_get_input(s.r.sim, id, NULL));
    MISSING(dmb_sim_record_inputs(NULL, &record, 1));
    MISSING(dmb_sim_record_inputs(s.r.sim, NULL, 1));
    MISSING(dmb_sim_replay_inputs(NULL, &record, 1, &next));
    MISSING(dmb_sim_replay_inputs(s.r.sim, NULL, 1, &next));
    MISSING(dmb_sim_replay_inputs(s.r.sim, &record, 1, NULL));
    NO_OBJECT(dmb_model_get_input(JUNK(dmb_model), 0, &info));
    NO_OBJECT(dmb_model_find_input(JUNK(dmb_model), "a", &id));
    assert_int_equal(dmb_model_input_count(NULL), 0);
    assert_int_equal(dmb_model_input_count(JUNK(dmb_model)), 0);
    assert_int_equal(dmb_sim_recorded_inputs(NULL), 0);
    assert_int_equal(dmb_sim_recorded_inputs(JUNK(dmb_sim)), 0);
}

static void of_events(void **state)
{
    (void)state;
    dmb_model *model = s.r.model;
    dmb_event_def event = dmb_event_def_default();
    dmb_event_report report = dmb_event_report_default();
    dmb_id id;
    MISSING(dmb_model_get_event(NULL, 0, &event));
    MISSING(dmb_model_get_event(model, 0, NULL));
    MISSING(dmb_model_find_event(NULL, "a", &id));
    MISSING(dmb_model_find_event(model, NULL, &id));
    MISSING(dmb_model_find_event(model, "a", NULL));
    MISSING(dmb_sim_advance_to_event(NULL, 1.0, &report, NULL));
    MISSING(dmb_sim_steps_to_event(NULL, 1.0, 1, NULL, &report, NULL));
    NO_OBJECT(dmb_model_get_event(JUNK(dmb_model), 0, &event));
    NO_OBJECT(dmb_model_find_event(JUNK(dmb_model), "a", &id));
    assert_int_equal(dmb_model_event_count(NULL), 0);
    assert_int_equal(dmb_model_event_count(JUNK(dmb_model)), 0);
}

/* ---- Queries, recorders, parts of a string ----------------------------------------------------------------------- */

static void of_outputs(void **state)
{
    (void)state;
    double value;
    int32_t quantity;
    dmb_profile_recorder profile = dmb_profile_recorder_default();
    MISSING(dmb_query_output(NULL, &height, &value));
    MISSING(dmb_query_output(s.r.sim, NULL, &value));
    MISSING(dmb_query_output(s.r.sim, &height, NULL));
    MISSING(dmb_output_quantity(NULL, &quantity));
    MISSING(dmb_output_quantity("position_x", NULL));
    MISSING(dmb_output_check(NULL, &height, 1));
    MISSING(dmb_output_check(s.r.sim, NULL, 1));
    MISSING(dmb_profile_recorder_take(NULL, s.r.sim));
    MISSING(dmb_profile_recorder_take(&profile, s.r.sim)); /* its profile */
    MISSING(dmb_profile_recorder_write_csv(NULL, "/dev/null"));
    MISSING(dmb_profile_recorder_write_csv(&profile, "/dev/null"));
    assert_null(dmb_output_name(-1, NULL));
    assert_null(dmb_profile_name(-1, NULL));
}

static void of_queries(void **state)
{
    (void)state;
    const double offset[3] = {0.0, 0.0, 0.0};
    dmb_pose pose = dmb_pose_default();
    dmb_motion moves = dmb_motion_default();
    dmb_flow_state flow = dmb_flow_state_default();
    dmb_spring_state spring = dmb_spring_state_default();
    dmb_stuck_state stuck = dmb_stuck_state_default();
    dmb_hole_point point = dmb_hole_point_default();
    MISSING(dmb_query_pose_at(NULL, s.place, offset, &pose));
    MISSING(dmb_query_pose_at(s.r.sim, s.place, NULL, &pose));
    MISSING(dmb_query_pose_at(s.r.sim, s.place, offset, NULL));
    MISSING(dmb_query_motion_at(NULL, s.place, offset, &moves));
    MISSING(dmb_query_motion_at(s.r.sim, s.place, NULL, &moves));
    MISSING(dmb_query_motion_at(s.r.sim, s.place, offset, NULL));
    MISSING(dmb_query_flow(NULL, &flow));
    MISSING(dmb_query_flow(s.r.sim, NULL));
    MISSING(dmb_query_profile(NULL, NULL));
    MISSING(dmb_query_profile(s.r.sim, NULL));
    MISSING(dmb_query_profile_extremes(NULL, NULL, NULL));
    MISSING(dmb_query_profile_extremes(s.r.sim, NULL, NULL));
    MISSING(dmb_query_spring(NULL, s.string, &spring));
    MISSING(dmb_query_spring(s.r.sim, s.string, NULL));
    MISSING(dmb_query_stuck(NULL, s.string, &stuck));
    MISSING(dmb_query_stuck(s.r.sim, s.string, NULL));
    MISSING(dmb_query_hole(NULL, 0.0, &point));
    NO_OBJECT(dmb_query_hole(JUNK(dmb_model), 0.0, &point));
}

static void of_subs_and_motors(void **state)
{
    (void)state;
    dmb_model *open = NULL;
    dmb_sub_def def = dmb_sub_def_default();
    dmb_sub sub = dmb_sub_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_motor motor = dmb_motor_default();
    dmb_drive_def drive = dmb_drive_def_default();
    double speed;
    assert_int_equal(dmb_model_create(NULL, &open), DMB_OK);
    MISSING(dmb_model_add_sub(NULL, &def, &sub));
    MISSING(dmb_model_add_sub(open, NULL, &sub));
    MISSING(dmb_model_add_sub(open, &def, NULL));
    MISSING(dmb_model_place_at_end(NULL, s.string, 1.0, &body, NULL));
    MISSING(dmb_motor_drive(NULL, &drive, &speed));
    MISSING(dmb_motor_drive(&motor, NULL, &speed));
    MISSING(dmb_motor_drive(&motor, &drive, NULL));
    NO_OBJECT(dmb_model_add_sub(JUNK(dmb_model), &def, &sub));
    NO_OBJECT(dmb_model_place_at_end(JUNK(dmb_model), s.string, 1.0, &body, NULL));
    dmb_model_destroy(&open);
}

/* ---- Destroying -------------------------------------------------------------------------------------------------- */

#define NOTHING_TO_DESTROY(name)              \
    do {                                      \
        dmb_##name *none = NULL;              \
        dmb_##name *other = JUNK(dmb_##name); \
        dmb_##name##_destroy(NULL);           \
        dmb_##name##_destroy(&none);          \
        dmb_##name##_destroy(&other);         \
        assert_null(other);                   \
    } while (0)

static void destroying_nothing_does_nothing(void **state)
{
    (void)state;
    uint64_t before[64];
    memcpy(before, junk, sizeof junk);
    NOTHING_TO_DESTROY(modes);
    NOTHING_TO_DESTROY(buckling);
    NOTHING_TO_DESTROY(response);
    NOTHING_TO_DESTROY(state_space);
    NOTHING_TO_DESTROY(fatigue);
    NOTHING_TO_DESTROY(window);
    NOTHING_TO_DESTROY(sensitivity);
    NOTHING_TO_DESTROY(state_equation);
    assert_memory_equal(junk, before, sizeof junk);
}

static void nothing_has_changed(void **state)
{
    (void)state;
    const uint64_t before = rig_hash(&s.r);
    void (*const all[])(void **) = {of_modes,           of_buckling,
                                    of_responses,       of_stepped_sines_and_speeds,
                                    of_state_spaces,    of_fatigue_and_windows,
                                    of_sensitivities,   of_state_equations,
                                    of_torque_and_drag, of_inputs,
                                    of_events,          of_outputs,
                                    of_queries};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) all[i](state);
    assert_true(rig_hash(&s.r) == before);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(of_modes),
        TEST(of_buckling),
        TEST(of_responses),
        TEST(of_stepped_sines_and_speeds),
        TEST(of_state_spaces),
        TEST(of_fatigue_and_windows),
        TEST(of_state_equations),
        TEST(of_sensitivities),
        TEST(of_torque_and_drag),
        TEST(of_names),
        TEST(of_inputs),
        TEST(of_events),
        TEST(of_outputs),
        TEST(of_queries),
        TEST(of_subs_and_motors),
        TEST(nothing_has_changed),
        TEST(destroying_nothing_does_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
