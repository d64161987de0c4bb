/* Analyses of random scenes with the options and answers that are asked for less often, out of bytes: axes at rest,
 * state spaces, torque and drag, steady statics. */
#ifndef DMB_TESTS_RANDOM_LINEAR_H
#define DMB_TESTS_RANDOM_LINEAR_H

#include "random_actions.h"

/* Of that kind, where there is one. */
static inline dmb_id part_of_kind(const random_scene *c, uint32_t kind)
{
    const dmb_id none = {0, 0};
    for (uint32_t i = 0; i < c->anys; i++)
        if (c->any[i].index >> 24 == kind) return c->any[i];
    return none;
}

static inline dmb_output draw_any_output(random_scene *c)
{
    byte_source *s = &c->source;
    const dmb_output reading = draw_output(c);
    dmb_output output = {.place = reading.place, .quantity = reading.quantity};
    if (draw_chance(s, 60)) return output;
    output.quantity = DMB_OUTPUT_VIBRATION + 10 * (int32_t)draw_below(s, 6) + (int32_t)draw_below(s, 7);
    output.place = draw_place(c);
    return output;
}

static inline dmb_excitation draw_any_input(random_scene *c)
{
    byte_source *s = &c->source;
    dmb_excitation input = dmb_excitation_default();
    input.kind = (int32_t)draw_choice(s, 8);
    input.place = draw_place(c);
    input.component = (int32_t)draw_below(s, 6);
    input.frame = (int32_t)draw_below(s, 2);
    const uint32_t kind = input.kind == DMB_EXCITATION_SETTING    ? DMB_PART_INPUT
                          : input.kind == DMB_EXCITATION_DRIVE    ? DMB_PART_DRIVE
                          : input.kind == DMB_EXCITATION_LOAD     ? DMB_PART_LOAD
                          : input.kind == DMB_EXCITATION_BIT_LOAD ? DMB_PART_BIT
                                                                  : 0;
    if (kind != 0) input.place = dmb_station(part_of_kind(c, kind), 0, 0.0);
    return input;
}

/* ---- Statics ------------------------------------------------------------------------------------------------------
 */

static inline void act_steady(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    dmb_static_options options = dmb_static_options_default();
    dmb_static_report report = dmb_static_report_default();
    options.max_iterations = 1 + draw_below(s, 8);
    options.steady = (int32_t)draw_choice(s, 3);
    options.slip_axial = draw_chance(s, 60) ? draw_number(s, -0.1, 0.1) : 0.0;
    options.slip_rotation = draw_chance(s, 60) ? draw_number(s, -10.0, 10.0) : 0.0;
    options.load_steps = draw_below(s, 3);
    options.lay_on_wall = draw_chance(s, 128);
    draw_spoil(s, &options.tolerance, 3);
    must_be_known(dmb_analysis_static(sim, &options, &report));
    must_be_finite(&report.residual, 3);
}

/* ---- Modes and responses ------------------------------------------------------------------------------------------
 */

static inline void ask_modes(const dmb_modes *modes, random_scene *c)
{
    byte_source *s = &c->source;
    dmb_modes_info info = dmb_modes_info_default();
    double kinetic = 0.0, strain = 0.0;
    MUST(dmb_modes_get_info(modes, &info) == DMB_OK);
    for (uint32_t i = 0; i < info.count; i++) {
        dmb_mode mode = dmb_mode_default();
        MUST(dmb_modes_get(modes, i, &mode) == DMB_OK);
        must_be_finite(&mode.frequency, 19);
    }
    const uint32_t which = draw_below(s, 5);
    const uint32_t pipe = draw_chance(s, 100) ? DMB_NONE : draw_below(s, 4);
    must_be_known(dmb_modes_part(modes, which, draw_any(c), pipe, &kinetic, &strain));
    must_be_known(dmb_write_vtk_mode(modes, which, draw_number(s, 0.0, 1.0), 0.5, draw_below(s, 3), "/dev/null"));
}

static inline void act_modes_in_axes(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    const uint64_t before = hash_of(sim);
    options.kind = (int32_t)draw_below(s, 2);
    options.select = (int32_t)draw_below(s, 3);
    options.count = 1 + draw_below(s, 6);
    options.band[1] = draw_size(s, 1.0, 1e4);
    options.contact = (int32_t)draw_below(s, 3);
    options.friction = (int32_t)draw_below(s, 2);
    options.contact_gap = draw_chance(s, 100) ? draw_size(s, 1e-6, 1e-1) : 0.0;
    options.equilibrium_tolerance = 1.0;
    options.axes = (int32_t)draw_choice(s, 2);
    options.spin = draw_chance(s, 128) ? draw_number(s, -50.0, 50.0) : 0.0;
    const int32_t status = dmb_analysis_modes(sim, &options, &modes);
    must_be_known(status);
    MUST((status >= 0) == (modes != NULL) && hash_of(sim) == before);
    if (modes != NULL) ask_modes(modes, c);
    dmb_modes_destroy(&modes);
}

static inline void ask_response(const dmb_response *response)
{
    enum { ROOM = 64 };
    uint32_t dimensions[3] = {0, 0, 0};
    double frequencies[ROOM], values[2 * ROOM];
    MUST(dmb_response_dimensions(response, dimensions) == DMB_OK && dimensions[0] <= ROOM);
    MUST(dmb_response_frequencies(response, frequencies) == DMB_OK);
    must_be_finite(frequencies, dimensions[0]);
    for (uint32_t i = 0; i <= dimensions[1]; i++) {
        const uint32_t input = i < dimensions[1] ? i : DMB_COMBINED;
        MUST(dmb_response_transfer(response, input, 0, values) == DMB_OK);
        must_be_finite(values, 2 * dimensions[0]);
    }
    MUST(dmb_response_transfer(response, dimensions[1], 0, values) < 0);
}

static inline void act_response_in_axes(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    const double frequencies[3] = {1.0, 2.0, 30.0};
    dmb_response_options options = dmb_response_options_default();
    const dmb_excitation inputs[2] = {draw_any_input(c), draw_any_input(c)};
    const dmb_output outputs[2] = {draw_any_output(c), draw_any_output(c)};
    dmb_response *response = NULL;
    const uint64_t before = hash_of(sim);
    options.points = 3;
    options.frequencies = draw_chance(s, 100) ? frequencies : NULL;
    options.logarithmic = (int32_t)draw_below(s, 2);
    options.frequency_low = draw_chance(s, 60) ? 0.0 : 1.0;
    options.refinement = draw_below(s, 3);
    options.structural_damping = draw_chance(s, 80) ? 0.02 : 0.0;
    options.contact = (int32_t)draw_below(s, 3);
    options.friction = (int32_t)draw_below(s, 2);
    options.equilibrium_tolerance = 1.0;
    options.axes = (int32_t)draw_choice(s, 2);
    options.spin = draw_chance(s, 100) ? draw_number(s, -50.0, 50.0) : 0.0;
    const int32_t status =
        dmb_analysis_response(sim, &options, inputs, 1 + draw_below(s, 2), outputs, 1 + draw_below(s, 2), &response);
    must_be_known(status);
    MUST((status >= 0) == (response != NULL) && hash_of(sim) == before);
    if (response != NULL) ask_response(response);
    dmb_response_destroy(&response);
}

/* ---- State space --------------------------------------------------------------------------------------------------
 */

static inline void ask_dense(const dmb_state_space *space, const dmb_state_space_info *info)
{
    const uint64_t rows[4] = {info->states, info->states, info->outputs, info->outputs};
    const uint64_t columns[4] = {info->states, info->inputs, info->states, info->inputs};
    for (int32_t i = 0; i < 4; i++) {
        const uint64_t count = rows[i] * columns[i];
        double *values = malloc((size_t)(count + 1) * sizeof *values);
        if (values == NULL) return;
        const int32_t status = dmb_state_space_dense(space, i, values);
        must_be_known(status);
        if (status >= 0) must_be_finite(values, (size_t)count);
        free(values);
    }
}

static inline void ask_sparse(const dmb_state_space *space, const dmb_state_space_info *info, int32_t matrix)
{
    uint64_t count = 0, room;
    if (dmb_state_space_sparse(space, matrix, NULL, NULL, NULL, &count) < 0) return;
    uint32_t *rows = malloc((size_t)(2 * count + 1) * sizeof *rows);
    double *values = malloc((size_t)(count + 1) * sizeof *values);
    if (rows != NULL && values != NULL) {
        room = count;
        MUST(dmb_state_space_sparse(space, matrix, rows, rows + count, values, &room) == DMB_OK && room == count);
        must_be_finite(values, (size_t)count);
        for (uint64_t i = 0; i < count; i++)
            MUST(rows[count + i] < info->rows + info->independent && rows[i] < info->rows + info->constraint_rows);
    }
    free(rows);
    free(values);
}

static inline void act_state_space(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    dmb_state_space_options options = dmb_state_space_options_default();
    dmb_state_space_info info = dmb_state_space_info_default();
    dmb_modes_options of_modes = dmb_modes_options_default();
    const dmb_excitation inputs[2] = {draw_any_input(c), draw_any_input(c)};
    const dmb_output outputs[2] = {draw_any_output(c), draw_any_output(c)};
    dmb_state_space *space = NULL;
    dmb_modes *modes = NULL;
    const uint64_t before = hash_of(sim);
    options.form = (int32_t)draw_choice(s, 3);
    options.motion = (int32_t)draw_below(s, 2);
    options.static_correction = (int32_t)draw_below(s, 2);
    options.contact = of_modes.contact = (int32_t)draw_below(s, 3);
    options.equilibrium_tolerance = of_modes.equilibrium_tolerance = 1.0;
    options.shift = draw_chance(s, 100) ? draw_size(s, 1e-3, 10.0) : 0.0;
    of_modes.count = 1 + draw_below(s, 4);
    if (options.form == DMB_STATE_REDUCED) must_be_known(dmb_analysis_modes(sim, &of_modes, &modes));
    options.modes = modes;
    const int32_t status =
        dmb_analysis_state_space(sim, &options, inputs, draw_below(s, 3), outputs, draw_below(s, 3), &space);
    must_be_known(status);
    MUST((status >= 0) == (space != NULL) && hash_of(sim) == before);
    if (space != NULL) {
        MUST(dmb_state_space_get_info(space, &info) == DMB_OK);
        ask_dense(space, &info);
        ask_sparse(space, &info, DMB_MATRIX_MASS + (int32_t)draw_below(s, 6));
    }
    dmb_state_space_destroy(&space);
    dmb_modes_destroy(&modes);
}

/* ---- Buckling -----------------------------------------------------------------------------------------------------
 */

static inline void act_buckling_of_part(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling_info info = dmb_buckling_info_default();
    dmb_buckling *buckling = NULL;
    const uint64_t before = hash_of(sim);
    options.count = 1 + draw_below(s, 3);
    options.scale = (int32_t)draw_below(s, 3);
    options.follow = (int32_t)draw_below(s, 2);
    options.part = c->drives > 0 && draw_chance(s, 128) ? c->drive[0] : draw_any(c);
    options.factor_max = draw_size(s, 1.0, 1e6);
    options.slip_axial = draw_chance(s, 60) ? 0.01 : 0.0;
    draw_spoil(s, &options.factor_max, 5);
    const int32_t status = dmb_analysis_buckling(sim, &options, &buckling);
    must_be_known(status);
    MUST((status >= 0) == (buckling != NULL) && hash_of(sim) == before);
    if (buckling != NULL) {
        MUST(dmb_buckling_get_info(buckling, &info) == DMB_OK && info.count == dmb_buckling_count(buckling));
        for (uint32_t i = 0; i < info.count; i++) {
            double factor = 0.0, shape[6];
            MUST(dmb_buckling_factor(buckling, i, &factor) == DMB_OK && isfinite(factor));
            must_be_known(dmb_buckling_shape(buckling, i, draw_place(c), shape));
        }
    }
    dmb_buckling_destroy(&buckling);
}

/* ---- Torque and drag ----------------------------------------------------------------------------------------------
 */

static inline void act_torque_drag(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    dmb_torque_drag_row rows[2] = {dmb_torque_drag_row_default(), dmb_torque_drag_row_default()};
    dmb_operation operation = dmb_operation_default();
    double along[4][3], friction = 0.0;
    const double depths[2] = {draw_number(s, 0.0, 20.0), draw_number(s, 0.0, 20.0)};
    const uint64_t before = hash_of(sim);
    must_be_known(dmb_operation_usual((int32_t)draw_choice(s, (DMB_OPERATION_BACK_REAM + 1)), &operation));
    operation.weight_on_bit = draw_chance(s, 128) ? draw_size(s, 1.0, 1e6) : 0.0;
    operation.torque_on_bit = draw_chance(s, 128) ? draw_size(s, 1.0, 1e5) : 0.0;
    draw_spoil(s, &operation.axial_speed, 4);
    if (c->strings > 0) options.string = c->string[draw_below(s, c->strings)];
    options.friction = draw_chance(s, 128) ? -1.0 : draw_number(s, 0.0, 1.0);
    options.depths = draw_chance(s, 128) ? depths : NULL;
    options.depth_count = options.depths != NULL ? 2 : 1;
    options.friction_by_depth = (int32_t)draw_below(s, 2);
    must_be_known(dmb_analysis_torque_drag(sim, &options, &operation, 1, rows));
    must_be_known(dmb_analysis_torque_drag_profile(sim, &options, &operation, 2 + draw_below(s, 2), along[0], along[1],
                                                   along[2], along[3]));
    must_be_known(dmb_analysis_friction_factor(sim, &options, &operation, (int32_t)draw_below(s, 3),
                                               draw_number(s, -1e4, 1e4), &friction));
    MUST(isfinite(friction) && hash_of(sim) == before);
}

/* ---- One of them --------------------------------------------------------------------------------------------------
 */

static inline void analyse_more(dmb_sim *sim, random_scene *c)
{
    static const struct {
        const char *name;
        void (*act)(dmb_sim *sim, random_scene *c);
    } actions[] = {
        {"modes in axes", act_modes_in_axes}, {"response in axes", act_response_in_axes},
        {"state space", act_state_space},     {"buckling of a part", act_buckling_of_part},
        {"torque and drag", act_torque_drag}, {"steady", act_steady},
    };
    if ((c->more & MORE_ACTIONS) == 0) return;
    swap_sources(c);
    if (draw_chance(&c->source, 128)) act_steady(sim, c);
    const uint32_t k = draw_below(&c->source, sizeof actions / sizeof actions[0]);
    present_action = actions[k].name;
    actions[k].act(sim, c);
    swap_sources(c);
}

#endif
