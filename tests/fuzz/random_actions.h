/* Actions of random scenes beyond steps and statics, out of bytes: inputs with their log and its replay, events,
 * windows and recorders, twins that have to get the same bits, sensitivities. */
#ifndef DMB_TESTS_RANDOM_ACTIONS_H
#define DMB_TESTS_RANDOM_ACTIONS_H

#if DMB_RED_ZONES > 0
#include <sanitizer/asan_interface.h>

#include "sim/sim.h"
#endif

#include "hash.h"
#include "random_questions.h"

/* ---- Bytes of a state ---------------------------------------------------------------------------------------------
 */

typedef struct saved_state {
    void *block;
    size_t size;
} saved_state;

static inline saved_state save(const dmb_sim *sim)
{
    saved_state saved = {NULL, 0};
    MUST(dmb_sim_snapshot_size(sim, &saved.size) == DMB_OK);
    saved.block = malloc(saved.size);
    MUST(saved.block != NULL && dmb_sim_snapshot(sim, saved.block, saved.size) == DMB_OK);
    return saved;
}

static inline void restore(dmb_sim *sim, const saved_state *saved, uint64_t hash)
{
    MUST(dmb_sim_restore(sim, saved->block, saved->size) == DMB_OK && hash_of(sim) == hash);
}

/* The state that a call has left is one of its scene; and what lies behind its arrays is guarded. */
static inline void must_be_sound(dmb_sim *sim)
{
#if DMB_RED_ZONES > 0
    MUST(__asan_address_is_poisoned((const unsigned char *)sim + sizeof *sim));
#endif
    const saved_state saved = save(sim);
    restore(sim, &saved, hash_of(sim));
    free(saved.block);
}

/* ---- Inputs -------------------------------------------------------------------------------------------------------
 */

typedef struct input_run {
    double value[2][DRAW_INPUTS], h;
    uint32_t count;
} input_run;

static inline input_run draw_input_run(random_scene *c)
{
    byte_source *s = &c->source;
    input_run run = {.h = draw_size(s, 1e-5, 1e-3), .count = 1 + draw_below(s, c->inputs)};
    for (uint32_t i = 0; i < 2 * run.count; i++) {
        double *value = &run.value[i / run.count][i % run.count];
        *value = draw_chance(s, 8) ? draw_nonsense(s) : draw_number(s, -2.0, 2.0) * draw_size(s, 1e-2, 1e3);
    }
    return run;
}

/* The run that is recorded, step by step with inputs set before each, or from the log. It ends at a step that fails:
 * inputs set after it would have the time of those before, and a replay sets them together. */
static inline void run_inputs(dmb_sim *sim, const random_scene *c, const input_run *run, dmb_input_record *log,
                              uint32_t *logged)
{
    uint32_t next = 0;
    int32_t stepped = DMB_OK;
    for (uint32_t i = 0; i < 2 && stepped >= 0; i++) {
        if (log == NULL) {
            const uint64_t before = hash_of(sim);
            const int32_t status = dmb_sim_set_inputs(sim, c->input, run->value[i], run->count);
            must_be_known(status);
            MUST(status >= 0 || hash_of(sim) == before);
        } else {
            MUST(dmb_sim_replay_inputs(sim, log, *logged, &next) >= 0);
        }
        stepped = dmb_sim_step(sim, run->h, NULL);
        must_be_known(stepped);
    }
}

static inline void act_inputs(dmb_sim *sim, random_scene *c)
{
    if (c->inputs == 0) return;
    const uint64_t before = hash_of(sim);
    const saved_state saved = save(sim);
    const input_run run = draw_input_run(c);
    dmb_input_record log[2 * DRAW_INPUTS];
    MUST(dmb_sim_record_inputs(sim, log, 2 * DRAW_INPUTS) == DMB_OK);
    run_inputs(sim, c, &run, NULL, NULL);
    uint32_t logged = dmb_sim_recorded_inputs(sim);
    const uint64_t after = hash_of(sim);
    MUST(logged <= 2 * DRAW_INPUTS && dmb_sim_record_inputs(sim, NULL, 0) == DMB_OK);
    restore(sim, &saved, before);
    run_inputs(sim, c, &run, log, &logged);
    MUST(hash_of(sim) == after);
    free(saved.block);
}

static inline void act_event(dmb_sim *sim, random_scene *c)
{
    dmb_event_report report = dmb_event_report_default();
    const double end = dmb_sim_time(sim) + draw_size(&c->source, 1e-5, 1e-3);
    const int32_t status = dmb_sim_advance_to_event(sim, end, &report, NULL);
    must_be_known(status);
    MUST(dmb_sim_time(sim) <= end);
    MUST(status != DMB_NOTE_EVENT || (report.count > 0 && report.events != 0 && report.time == dmb_sim_time(sim)));
    must_be_known(dmb_sim_steps_to_event(sim, 1e-4, 3, NULL, &report, NULL));
}

/* ---- Windows and recorders ----------------------------------------------------------------------------------------
 */

static inline void take_rows(dmb_sim *sim, random_scene *c, dmb_window *window, const dmb_output *outputs)
{
    enum { ROWS = 2 };
    double table[ROWS * 3 + 1];
    dmb_recorder recorder = dmb_recorder_default();
    recorder.outputs = outputs;
    recorder.output_count = 2;
    recorder.table = table;
    recorder.capacity = ROWS;
    recorder.window = draw_chance(&c->source, 128) ? window : NULL;
    recorder.interval = draw_chance(&c->source, 60) ? draw_size(&c->source, 1e-5, 1e-2) : 0.0;
    table[3 * ROWS] = 0.5;
    for (int i = 0; i < 3; i++) {
        must_be_known(dmb_sim_step(sim, 1e-4, NULL));
        if (window != NULL) must_be_known(dmb_window_take(window, sim));
        must_be_known(dmb_recorder_take(&recorder, sim));
    }
    MUST(recorder.row_count <= ROWS && table[3 * ROWS] == 0.5);
    must_be_known(dmb_recorder_write_csv(&recorder, NULL, "/dev/null"));
}

static inline void act_window(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    dmb_window_options options = dmb_window_options_default();
    dmb_window_result result = dmb_window_result_default();
    dmb_window *window = NULL;
    dmb_output outputs[2] = {draw_output(c), draw_output(c)};
    options.slots = 1 + draw_below(s, 6);
    options.length = draw_chance(s, 128) ? draw_size(s, 1e-5, 1e-2) : 0.0;
    const int32_t status = dmb_window_create(sim, &options, outputs, 2, &window);
    must_be_known(status);
    MUST((status >= 0) == (window != NULL));
    if (draw_chance(s, 60)) outputs[1].quantity = DMB_OUTPUT_WINDOW_MEAN;
    take_rows(sim, c, window, outputs);
    if (window != NULL) must_be_known(dmb_window_get(window, draw_below(s, 3), &result));
    if (window != NULL) MUST(dmb_window_reset(window) == DMB_OK);
    dmb_window_destroy(&window);
}

static inline void act_rows(dmb_sim *sim, random_scene *c)
{
    enum { ROWS = 2, WIDTH = 1 + 2 * 2 };
    dmb_profile profile = dmb_profile_default();
    dmb_profile_recorder recorder = dmb_profile_recorder_default();
    const int32_t quantities[2] = {(int32_t)draw_below(&c->source, (DMB_PROFILE_GAP + 1)),
                                   (int32_t)draw_below(&c->source, (DMB_PROFILE_GAP + 1))};
    double table[ROWS * WIDTH + 1];
    if (c->strings > 0) profile.string = c->string[draw_below(&c->source, c->strings)];
    profile.station_count = profile.quantity_count = 2;
    profile.quantities = quantities;
    recorder.profile = &profile;
    recorder.table = table;
    recorder.capacity = ROWS;
    table[ROWS * WIDTH] = 0.5;
    for (int i = 0; i < 3; i++) must_be_known(dmb_profile_recorder_take(&recorder, sim));
    MUST(recorder.row_count <= ROWS && table[ROWS * WIDTH] == 0.5);
    must_be_known(dmb_profile_recorder_write_csv(&recorder, "/dev/null"));
}

static inline void act_fatigue(dmb_sim *sim, random_scene *c)
{
    enum { CLASSES = 8 };
    byte_source *s = &c->source;
    dmb_fatigue_options options = dmb_fatigue_options_default();
    dmb_fatigue_result result = dmb_fatigue_result_default();
    dmb_fatigue *fatigue = NULL;
    const dmb_place places[2] = {draw_place(c), draw_place(c)};
    double cycles[CLASSES];
    options.classes = CLASSES;
    options.points = 2 + draw_below(s, 3);
    options.stress_range = draw_size(s, 1e3, 1e9);
    options.curve_stress = 1e8;
    options.slope = draw_number(s, 1.0, 50.0);
    options.tensile_strength = draw_chance(s, 128) ? 1e8 : 0.0;
    draw_spoil(s, &options.stress_range, 7);
    const int32_t status = dmb_fatigue_create(sim, &options, places, 2, &fatigue);
    must_be_known(status);
    MUST((status >= 0) == (fatigue != NULL));
    for (int i = 0; i < 3 && fatigue != NULL; i++) {
        must_be_known(dmb_sim_step(sim, 1e-4, NULL));
        must_be_known(dmb_fatigue_take(fatigue, sim));
    }
    if (fatigue != NULL) must_be_known(dmb_fatigue_get(fatigue, draw_below(s, 3), &result));
    if (fatigue != NULL) must_be_known(dmb_fatigue_histogram(fatigue, draw_below(s, 3), cycles));
    dmb_fatigue_destroy(&fatigue);
}

/* ---- Twins --------------------------------------------------------------------------------------------------------
 */

/* Parts in backward order, in one thread. */
static inline int32_t in_parts(void *context, uint32_t count, dmb_part_fn part, void *work)
{
    (void)context;
    for (uint32_t i = count; i > 0; i--) part(work, i - 1);
    return 0;
}

/* One sim from the allocator, and one in a block of the caller's whose steps are made in parts: the same bits. */
static inline void act_twins(dmb_sim *sim, random_scene *c)
{
    dmb_sim_options options = draw_options(c);
    dmb_sim *one = NULL, *other = NULL;
    size_t size = 0;
    (void)sim;
    const int32_t made = dmb_sim_create(c->model, &options, &one);
    must_be_known(made);
    options.parallel = in_parts;
    options.parallel_least = 1;
    options.parallel_parts = 1 + draw_below(&c->source, 4);
    const int32_t told = dmb_sim_memory_size(c->model, &options, &size);
    must_be_known(told);
    void *block = told >= 0 ? malloc(size + 1) : NULL;
    if (block != NULL) {
        MUST(dmb_sim_create_in(c->model, &options, (char *)block + 1, size, &other) == made);
        MUST((one != NULL) == (other != NULL));
    }
    for (uint32_t i = 0; i < 2 && other != NULL; i++) {
        const double h = draw_size(&c->source, 1e-6, 1e-2);
        MUST(dmb_sim_step(one, h, NULL) == dmb_sim_step(other, h, NULL) && hash_of(one) == hash_of(other));
    }
    dmb_sim_destroy(&other);
    dmb_sim_destroy(&one);
    free(block);
}

/* ---- Sensitivities ------------------------------------------------------------------------------------------------
 */

/* Set differently by a little, where there is something to set. */
static inline void nudge(dmb_sim *sim, random_scene *c, double by)
{
    if (c->inputs > 0)
        (void)dmb_sim_set_input(sim, c->input[0], by);
    else if (c->drives > 0)
        (void)dmb_sim_set_drive(sim, c->drive[0], by);
}

static inline void ask_sensitivity(dmb_sensitivity *sensitivity, random_scene *c)
{
    const dmb_output outputs[2] = {draw_output(c), draw_output(c)};
    double values[2], derivatives[2];
    uint64_t kinks = 0;
    uint32_t rows = 0;
    must_be_known(dmb_sensitivity_outputs(sensitivity, outputs, 2, values, derivatives));
    must_be_known(dmb_sensitivity_rows(sensitivity, 0, NULL, NULL, &rows));
    must_be_known(dmb_sensitivity_kinks(sensitivity, draw_below(&c->source, 2), &kinks));
}

/* Steps with derivatives have the bits of steps without. */
static inline void run_sensitivity(dmb_sim *sim, dmb_sim *plain, dmb_sensitivity *sensitivity, random_scene *c)
{
    for (int i = 0; i < 2; i++) {
        const double h = draw_size(&c->source, 1e-6, 1e-3);
        const int32_t status = dmb_sensitivity_step(sensitivity, h, NULL);
        const uint64_t before = hash_of(plain);
        must_be_known(status);
        if (status < 0) {
            MUST(hash_of(sim) == before);
            return;
        }
        must_be_known(dmb_sim_step(plain, h, NULL));
        MUST(hash_of(sim) == hash_of(plain));
        ask_sensitivity(sensitivity, c);
    }
    must_be_known(dmb_sensitivity_advance(sensitivity, dmb_sim_time(sim) + 1e-4, NULL));
}

static inline void act_sensitivity(dmb_sim *sim, random_scene *c)
{
    byte_source *s = &c->source;
    dmb_sim *other[3] = {NULL, NULL, NULL};
    dmb_sensitivity *sensitivity = NULL;
    dmb_parameter parameter = dmb_parameter_default();
    const saved_state saved = save(sim);
    int ready = 1;
    for (int i = 0; i < 3; i++) {
        ready &= dmb_sim_create(c->model, &c->options, &other[i]) >= 0;
        if (ready) restore(other[i], &saved, hash_of(sim));
    }
    if (ready) {
        parameter.step = draw_size(s, 1e-9, 1e-3);
        parameter.one_sided = draw_chance(s, 80);
        nudge(sim, c, 0.0), nudge(other[0], c, 0.0);
        nudge(other[1], c, -parameter.step), nudge(other[2], c, parameter.step);
        parameter.low = other[1], parameter.high = other[2];
        const int32_t status = dmb_sensitivity_create(sim, &parameter, 1, &sensitivity);
        must_be_known(status);
        MUST((status >= 0) == (sensitivity != NULL));
        if (sensitivity != NULL) run_sensitivity(sim, other[0], sensitivity, c);
    }
    dmb_sensitivity_destroy(&sensitivity);
    for (int i = 0; i < 3; i++) dmb_sim_destroy(&other[i]);
    free(saved.block);
}

/* ---- One of them --------------------------------------------------------------------------------------------------
 */

/* So many as the last byte says, after all that inputs without it do. */
static inline void act_more(dmb_sim *sim, random_scene *c)
{
    static const struct {
        const char *name;
        void (*act)(dmb_sim *sim, random_scene *c);
    } actions[] = {
        {"questions", ask_anything}, {"inputs", act_inputs},   {"event", act_event}, {"window", act_window},
        {"rows", act_rows},          {"fatigue", act_fatigue}, {"twins", act_twins}, {"sensitivity", act_sensitivity},
    };
    swap_sources(c);
    for (uint32_t i = (c->more & MORE_ACTIONS) >> 1; i > 0; i--) {
        const uint32_t k = draw_below(&c->source, sizeof actions / sizeof actions[0]);
        present_action = actions[k].name;
        actions[k].act(sim, c);
        must_be_sound(sim);
        const uint64_t before = hash_of(sim);
        for (uint32_t q = 0; q < 4; q++) ask_anything(sim, c);
        MUST(hash_of(sim) == before);
    }
    swap_sources(c);
}

#endif
