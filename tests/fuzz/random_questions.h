/* Questions of a sim about anything, out of bytes: each ends with a known status, writes finite numbers where it says
 * so, and changes nothing. */
#ifndef DMB_TESTS_RANDOM_QUESTIONS_H
#define DMB_TESTS_RANDOM_QUESTIONS_H

#include "random_parts.h"

static inline dmb_id draw_any(random_scene *c)
{
    const dmb_id none = {0, 0};
    return c->anys > 0 ? c->any[draw_below(&c->source, c->anys)] : none;
}

static inline void ask_output(dmb_sim *sim, random_scene *c)
{
    const dmb_output output = draw_output(c);
    double value = 0.5;
    const int32_t status = dmb_query_output(sim, &output, &value);
    const char *name = dmb_output_name(output.quantity, NULL);
    int32_t quantity = -1;
    must_be_known(status);
    MUST(status >= 0 || value == 0.5);
    MUST((dmb_output_check(sim, &output, 1) >= 0) == (status >= 0));
    if (name != NULL) MUST(dmb_output_quantity(name, &quantity) == DMB_OK && quantity == output.quantity);
}

/* In the places that strides say, with what is between them left alone. */
static inline void ask_profile(dmb_sim *sim, random_scene *c)
{
    enum { STATIONS = 4, QUANTITIES = 4, GUARD = 2 };
    byte_source *s = &c->source;
    dmb_profile profile = dmb_profile_default();
    double values[GUARD + STATIONS * QUANTITIES], distance[STATIONS];
    double extremes[4 * QUANTITIES + 1];
    int32_t quantities[QUANTITIES];
    for (int i = 0; i < GUARD + STATIONS * QUANTITIES; i++) values[i] = 0.5;
    for (int i = 0; i <= 4 * QUANTITIES; i++) extremes[i] = 0.5;
    for (int i = 0; i < QUANTITIES; i++) quantities[i] = (int32_t)draw_below(s, (DMB_PROFILE_GAP + 1) + 1);
    for (int i = 0; i < STATIONS; i++) distance[i] = draw_number(s, 0.0, 5.0);
    if (c->strings > 0) profile.string = c->string[draw_below(s, c->strings)];
    profile.station_count = 1 + draw_below(s, STATIONS);
    profile.quantity_count = 1 + draw_below(s, QUANTITIES);
    profile.distance = draw_chance(s, 128) ? distance : NULL;
    profile.quantities = quantities;
    profile.values = values + 1;
    const int32_t status = dmb_query_profile(sim, &profile);
    must_be_known(status);
    for (uint32_t i = 1; status < 0 && i < GUARD + STATIONS * QUANTITIES; i++) MUST(values[i] == 0.5);
    MUST(values[0] == 0.5 && values[1 + profile.station_count * profile.quantity_count] == 0.5);
    must_be_known(dmb_query_profile_extremes(sim, &profile, extremes));
    MUST(extremes[4 * profile.quantity_count] == 0.5);
}

static inline void ask_reactions(dmb_sim *sim, random_scene *c)
{
    double six[7] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5};
    uint32_t count = 6, first = 0;
    dmb_joint_state joint = dmb_joint_state_default();
    const dmb_id part = draw_any(c);
    joint.frame = (int32_t)draw_below(&c->source, 3);
    must_be_known(dmb_query_reaction(sim, part, six));
    must_be_finite(six, 6);
    must_be_known(dmb_query_multipliers(sim, part, six, &count));
    must_be_finite(six, 6);
    must_be_known(dmb_query_constraint_rows(sim, part, &first, &count));
    must_be_known(dmb_query_joint(sim, part, &joint));
    must_be_finite(joint.position, 31);
    MUST(six[6] == 0.5);
}

static inline void ask_springs(dmb_sim *sim, random_scene *c)
{
    dmb_spring_state spring = dmb_spring_state_default();
    dmb_stuck_state stuck = dmb_stuck_state_default();
    dmb_input_state input = dmb_input_state_default();
    double energy = 0.0;
    const dmb_id part = draw_any(c);
    must_be_known(dmb_query_spring(sim, part, &spring));
    must_be_known(dmb_query_stuck(sim, part, &stuck));
    must_be_known(dmb_sim_get_input(sim, part, &input));
    must_be_known(dmb_query_kinetic_energy(sim, part, draw_below(&c->source, 4), &energy));
    must_be_finite(&spring.length, 16);
    must_be_finite(stuck.offset, 10);
    must_be_finite(&input.value, 4);
    MUST(isfinite(energy) && energy >= 0.0);
}

static inline void ask_hole(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    dmb_hole_point described = dmb_hole_point_default(), now = dmb_hole_point_default();
    dmb_flow_state flow = dmb_flow_state_default();
    const double depth = draw_chance(s, 10) ? draw_nonsense(s) : draw_number(s, -5.0, 80.0);
    const int32_t status = dmb_query_hole(c->model, depth, &described);
    must_be_known(status);
    MUST(dmb_query_hole_now(sim, depth, &now) == status);
    must_be_known(dmb_query_flow(sim, &flow));
    must_be_finite(described.position, 20);
    must_be_finite(now.position, 20);
    must_be_finite(&flow.rate, 12);
    MUST(now.diameter >= described.diameter);
}

static inline void ask_places(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    dmb_place place = draw_place(c);
    dmb_pose pose = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    double offset[3] = {0.0, 0.0, 0.0}, values[24];
    uint32_t rows[24], count = 24;
    if (draw_chance(s, 128)) place.part = draw_any(c);
    offset[draw_below(s, 3)] = draw_number(s, -1.0, 1.0);
    motion.frame = (int32_t)draw_below(s, 3);
    draw_spoil(s, offset, 3);
    must_be_known(dmb_query_pose_at(sim, place, offset, &pose));
    must_be_known(dmb_query_motion_at(sim, place, offset, &motion));
    must_be_finite(pose.position, 16);
    must_be_finite(motion.velocity, 12);
    const int32_t status =
        dmb_analysis_place_rows(sim, place, (int32_t)draw_below(s, 3), (int32_t)draw_below(s, 7), rows, values, &count);
    must_be_known(status);
    for (uint32_t i = 0; status >= 0 && i < count; i++) {
        dmb_row row = dmb_row_default();
        MUST(count <= 24 && isfinite(values[i]) && dmb_query_row(sim, rows[i], &row) == DMB_OK);
    }
}

static inline void ask_arrays(dmb_sim *sim, random_scene *c)
{
    const int32_t array = (int32_t)draw_below(&c->source, 7);
    uint64_t count = 0, room;
    const int32_t status = dmb_analysis_array(sim, array, NULL, &count);
    must_be_known(status);
    if (status < 0 || count == 0 || count > 10000) return;
    double *values = malloc((size_t)count * sizeof *values);
    if (values == NULL) return;
    room = count - 1;
    MUST(dmb_analysis_array(sim, array, values, &room) < 0);
    room = count;
    const int32_t filled = dmb_analysis_array(sim, array, values, &room);
    must_be_known(filled);
    if (filled >= 0) must_be_finite(values, (size_t)room);
    free(values);
}

static inline void ask_names(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    char name[DMB_NAME_SIZE] = "";
    dmb_id part = {0, 0}, found = {0, 0};
    dmb_input_info input = dmb_input_info_default();
    dmb_event_def event = dmb_event_def_default();
    uint32_t first, count;
    (void)sim;
    part = draw_any(c);
    must_be_known(dmb_model_get_name(c->model, part, name, sizeof name));
    const int32_t status = dmb_model_find(c->model, (int32_t)(part.index >> 24), name, &found);
    must_be_known(status);
    if (name[0] != '\0') MUST(status == DMB_OK && found.index == part.index);
    name[0] = (char)('a' + draw_below(s, 12));
    must_be_known(dmb_model_find(c->model, (int32_t)draw_below(s, 23), name, &found));
    must_be_known(dmb_model_find_pipes(c->model, name, &found, &first, &count));
    must_be_known(dmb_model_find_input(c->model, name, &found));
    must_be_known(dmb_model_find_event(c->model, name, &found));
    MUST(dmb_model_input_count(c->model) == c->inputs && dmb_model_event_count(c->model) == c->events);
    MUST((dmb_model_get_input(c->model, draw_below(s, 4), &input) >= 0) == (input.input.generation != 0));
    must_be_known(dmb_model_get_event(c->model, draw_below(s, 2), &event));
}

static inline void ask_pictures(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    const double spacing = draw_chance(s, 10) ? draw_nonsense(s) : draw_size(s, 0.1, 10.0);
    must_be_known(dmb_write_vtk_strings(sim, draw_below(s, 4), "/dev/null"));
    must_be_known(dmb_write_vtk_hole(c->model, draw_number(s, -5.0, 5.0), draw_number(s, 0.0, 10.0), spacing,
                                     2 + draw_below(s, 4), "/dev/null"));
}

static inline void ask_anything(dmb_sim *sim, random_scene *c)
{
    static void (*const questions[])(dmb_sim * sim, random_scene * c) = {
        ask_output, ask_profile, ask_reactions, ask_springs, ask_hole,
        ask_places, ask_arrays,  ask_names,     ask_output,  ask_pictures,
    };
    questions[draw_below(&c->source, sizeof questions / sizeof questions[0])](sim, c);
}

#endif
