/* Further parts that a string meets, out of bytes: springs, stuck places, mud that flows, rings, sections of the hole,
 * forces of the caller's, inputs and events. */
#ifndef DMB_TESTS_RANDOM_PARTS_H
#define DMB_TESTS_RANDOM_PARTS_H

#include "random_judge.h"
#include "random_scene.h"

static inline dmb_place draw_place(random_scene *c)
{
    byte_source *s = &c->source;
    const dmb_id part = draw_part(c);
    const int of_string = part.index >> 24 == DMB_PART_STRING;
    dmb_place place = dmb_station(part, of_string ? draw_below(s, 4) : 0, of_string ? draw_below(s, 2) : 0.0);
    if (has_more(c)) place.pipe = fitting_pipe(c, part, place.pipe);
    return place;
}

static inline dmb_id keep_known(random_scene *c, int32_t status, dmb_id id)
{
    must_be_known(status);
    (void)keep_id(c, status, id);
    return id;
}

static inline void draw_spring_table(random_scene *c, dmb_spring_def *def)
{
    static const double elongation[4] = {-0.5, 0.0, 0.1, 2.0}, force[4] = {-1e4, 0.0, 10.0, 1e5};
    def->table_elongation = elongation;
    def->table_force = force;
    def->table_count = 1 + draw_below(&c->source, 4);
    def->table_kind = (int32_t)draw_below(&c->source, 3);
}

static inline void draw_spring(random_scene *c)
{
    byte_source *s = &c->source;
    dmb_spring_def def = dmb_spring_def_default();
    dmb_id id = {0, 0};
    def.acts = (int32_t)draw_below(s, 3);
    def.place_a = draw_place(c);
    def.offset_b[1] = draw_number(s, -2.0, 2.0);
    def.free_length = draw_chance(s, 128) ? -1.0 : draw_number(s, 0.0, 2.0);
    def.stiffness = draw_size(s, 1.0, 1e7);
    def.damping = draw_size(s, 1e-2, 1e3);
    def.preload = draw_number(s, -10.0, 10.0);
    draw_spoil(s, def.offset_a, 9);
    if (has_more(c) && draw_chance(s, 80)) draw_spring_table(c, &def);
    if (has_more(c) && draw_chance(s, 80)) def.place_b = draw_place(c);
    const int32_t status = dmb_model_add_spring(c->model, &def, &id);
    (void)keep_known(c, status, id);
}

static inline dmb_id draw_stuck(random_scene *c)
{
    byte_source *s = &c->source;
    dmb_stuck_def def = dmb_stuck_def_default();
    dmb_id id = {0, 0};
    def.place = draw_place(c);
    def.holds = 1 + (int32_t)draw_below(s, 7);
    def.stuck = (int32_t)draw_below(s, 2);
    def.overpull = draw_chance(s, 128) ? draw_size(s, 1.0, 1e6) : 0.0;
    draw_spoil(s, def.stiffness, 8);
    if (has_more(c) && draw_chance(s, 80)) def.overtorque = draw_size(s, 1e-2, 1e5);
    const int32_t status = dmb_model_add_stuck(c->model, &def, &id);
    return keep_known(c, status, id);
}

static inline void draw_flow(random_scene *c)
{
    byte_source *s = &c->source;
    dmb_environment_def def = dmb_environment_def_default();
    def.fluid_density = draw_number(s, 0.0, 2000.0);
    def.flow_rate = draw_size(s, 1e-6, 1e-1);
    def.consistency = draw_size(s, 1e-4, 1.0);
    def.flow_exponent = draw_number(s, 0.2, 1.0);
    draw_spoil(s, &def.flow_rate, 3);
    must_be_known(dmb_model_set_environment(c->model, &def));
}

static inline void draw_input_limits(random_scene *c, dmb_input_def *def)
{
    byte_source *s = &c->source;
    if (draw_chance(s, 80)) def->slope_limit = draw_size(s, 1.0, 1e7);
    if (draw_chance(s, 60)) def->low = -draw_size(s, 1e-2, 1e5);
    if (draw_chance(s, 60)) def->high = draw_size(s, 1e-2, 1e5);
    if (draw_chance(s, 60)) def->initial = draw_number(s, -1.0, 1.0);
    def->outside = (int32_t)draw_below(s, 2);
    draw_spoil(s, &def->initial, 5);
}

static inline void draw_sim_input(random_scene *c, dmb_id stuck)
{
    byte_source *s = &c->source;
    dmb_input_def def = dmb_input_def_default();
    dmb_id id = {0, 0};
    const dmb_id none = {0, 0};
    if (c->inputs >= DRAW_INPUTS) return;
    def.target = (int32_t)draw_below(s, DMB_TARGET_FLOW_RATE + (has_more(c) ? 2 : 1)); /* 14 is none */
    def.name[0] = (char)('a' + c->inputs);
    def.part = def.target == DMB_TARGET_STUCK                         ? stuck
               : def.target <= DMB_TARGET_LIMIT_HIGH && c->drives > 0 ? c->drive[0]
               : def.target == DMB_TARGET_BIT_LOAD                    ? c->bit
                                                                      : none;
    def.rate_limit = draw_chance(s, 128) ? draw_size(s, 1.0, 1e5) : 0.0;
    if (has_more(c)) draw_input_limits(c, &def);
    const int32_t status = dmb_model_add_input(c->model, &def, &id);
    c->input[c->inputs] = keep_known(c, status, id);
    c->inputs += status >= 0;
}

/* One of those that have a name, now and then none. */
static inline int32_t draw_quantity(byte_source *s)
{
    static int32_t named[512];
    static uint32_t count;
    if (count == 0)
        for (int32_t q = dmb_output_next(-1); q >= 0 && count < 512; q = dmb_output_next(q)) named[count++] = q;
    const uint32_t drawn = draw_byte(s) << 8 | draw_byte(s);
    return draw_chance(s, 6) ? (int32_t)drawn : named[drawn % count];
}

/* Of any part, or at a station of a string. */
static inline dmb_output draw_output(random_scene *c)
{
    byte_source *s = &c->source;
    dmb_output output = {.quantity = draw_quantity(s)};
    output.place = draw_place(c);
    if (draw_chance(s, 160) && c->anys > 0) output.place.part = c->any[draw_below(s, c->anys)];
    if (output.place.part.index >> 24 != DMB_PART_STRING) output.place.fraction = 0.0;
    if (draw_chance(s, 10)) output.place.fraction = draw_nonsense(s);
    return output;
}

static inline void draw_event(random_scene *c)
{
    byte_source *s = &c->source;
    dmb_event_def def = dmb_event_def_default();
    dmb_id id = {0, 0};
    def.name[0] = 'e';
    def.output.quantity = (int32_t)draw_below(s, 40);
    def.output.place = draw_place(c);
    def.level = draw_number(s, -1.0, 1.0);
    def.hold = draw_chance(s, 60) ? 1e-4 : 0.0;
    if (has_more(c)) {
        if (draw_chance(s, 200)) def.output = draw_output(c);
        def.direction = (int32_t)draw_below(s, 3);
        def.level *= draw_size(s, 1e-6, 1e6);
        draw_spoil(s, &def.level, 3);
    }
    const int32_t status = dmb_model_add_event(c->model, &def, &id);
    c->event = keep_known(c, status, id);
    c->events += status >= 0;
}

static inline void draw_rest(random_scene *c)
{
    byte_source *s = &c->source;
    dmb_id stuck = {0, 0};
    if (draw_chance(s, 100)) draw_spring(c);
    if (draw_chance(s, 60)) stuck = draw_stuck(c);
    if (draw_chance(s, 60) && c->strings == 1) draw_flow(c);
    for (uint32_t i = draw_below(s, 4); i > 0; i--) draw_sim_input(c, stuck);
    if (draw_chance(s, 80)) draw_event(c);
}

/* ---- Where there is more ------------------------------------------------------------------------------------------
 */

static inline void draw_sections(random_scene *c)
{
    byte_source *s = &c->source;
    dmb_hole_section sections[3];
    const uint32_t count = 1 + draw_below(s, 3);
    for (uint32_t i = 0; i < count; i++) {
        dmb_hole_section *section = sections + i;
        *section = dmb_hole_section_default();
        section->shape = i + 1 < count ? (int32_t)draw_below(s, 2) : DMB_HOLE_STEP;
        section->depth = (i > 0 ? sections[i - 1].depth : -1.0) + draw_size(s, 0.3, 10.0);
        section->transition = draw_size(s, 0.03, 0.3);
        if (draw_chance(s, 160)) section->diameter = draw_number(s, 0.085, 0.15);
        if (draw_chance(s, 80)) section->stiffness = draw_size(s, 1e5, 1e10);
        if (draw_chance(s, 80)) section->mu_dynamic = draw_number(s, 0.0, 0.3);
        draw_name(s, section->name);
        draw_spoil(s, &section->depth, 9);
    }
    must_be_known(dmb_model_add_hole_sections(c->model, sections, count));
}

/* With a cutting surface of its own at times: a reamer. */
static inline void draw_stabiliser(random_scene *c)
{
    byte_source *s = &c->source;
    dmb_stabiliser_def def = dmb_stabiliser_def_default();
    dmb_id id = {0, 0};
    if (c->strings > 0) def.string = c->string[draw_below(s, c->strings)];
    def.pipe = fitting_pipe(c, def.string, draw_below(s, 3));
    def.fraction = draw_chance(s, 60) ? draw_below(s, 3) / 2.0 : draw_number(s, 0.0, 1.0);
    def.outer_diameter = draw_number(s, 0.073, 0.094);
    def.length = draw_size(s, 0.01, 0.5);
    draw_name(s, def.name);
    draw_spoil(s, &def.fraction, 6);
    const int32_t status = dmb_model_add_stabiliser(c->model, &def, &id);
    (void)keep_known(c, status, id);
    if (status < 0 || !draw_chance(s, 80)) return;
    dmb_bit_def reamer = dmb_bit_def_default();
    reamer.stabiliser = id;
    reamer.rock_law = (int32_t)draw_below(s, 3);
    reamer.history = 64;
    reamer.inner_radius = draw_number(s, 0.0, 0.04);
    const int32_t made = dmb_model_add_bit(c->model, &reamer, &id);
    (void)keep_known(c, made, id);
}

static inline int32_t draw_push(void *context, double time, uint32_t count, const double (*poses)[12],
                                const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                                const dmb_law_memory *memory)
{
    (void)memory;
    const random_scene *c = context;
    (void)count, (void)tangent, (void)potential;
    forces[0][0] = 5.0 * sin(10.0 * time) - 3.0 * velocities[0][0];
    forces[0][2] = -20.0 * poses[0][2];
    return c->callback_status;
}

static inline void draw_force(random_scene *c)
{
    dmb_force_def def = dmb_force_def_default();
    dmb_id id = {0, 0};
    def.frame = (int32_t)draw_below(&c->source, 2);
    def.place_count = 1 + draw_below(&c->source, 2);
    for (uint32_t i = 0; i < def.place_count; i++) def.place[i] = draw_place(c);
    def.callback = draw_push;
    def.callback_context = c;
    const int32_t status = dmb_model_add_force(c->model, &def, &id);
    (void)keep_known(c, status, id);
}

static inline void draw_new_name(random_scene *c)
{
    char name[DMB_NAME_SIZE] = "";
    draw_name(&c->source, name);
    if (c->anys > 0) must_be_known(dmb_model_set_name(c->model, c->any[draw_below(&c->source, c->anys)], name));
}

static inline void draw_more_parts(random_scene *c)
{
    byte_source *s = &c->source;
    swap_sources(c);
    if (draw_chance(s, c->has_wall ? 80 : 2)) draw_sections(c);
    for (uint32_t i = draw_below(s, 3); i > 0; i--) draw_stabiliser(c);
    if (draw_chance(s, 50)) draw_force(c);
    draw_rest(c);
    draw_new_name(c);
    swap_sources(c);
}

#endif
