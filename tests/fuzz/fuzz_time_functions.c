/* Time functions out of bytes: terms of all kinds, tables of any times and values, callbacks that give any numbers or
 * fail. Description, compile, sim and steps end with a known status; a step that fails changes nothing; after one that
 * works target, speed and time are finite, and so they are after a restore of the state. */
#include "fuzz_frame.h"

enum { TERMS = 3, TABLE = 24, STEPS = 6 };

/* The numbers of the callback: by turns, whatever the time. */
typedef struct callback {
    double values[4];
    uint32_t calls, fails_at;
} callback;

typedef struct subject {
    byte_source source;
    uint32_t more; /* 1: the drive is excited too, 2: an input moves its set point */
    double times[TERMS][TABLE], values[TERMS][TABLE];
    callback callback;
    dmb_model *model;
    dmb_id drive, input, turning; /* turning: what segments per revolution follow */
} subject;

static double any_number(byte_source *s, double scale)
{
    double value;
    if (draw_chance(s, 12)) return draw_nonsense(s);
    if (!draw_chance(s, 12)) return draw_number(s, -scale, scale);
    uint8_t bytes[sizeof value];
    for (size_t i = 0; i < sizeof value; i++) bytes[i] = (uint8_t)draw_byte(s);
    memcpy(&value, bytes, sizeof value);
    return value;
}

static int32_t call_back(void *context, double time, double out[3])
{
    callback *c = context;
    if (++c->calls == c->fails_at) return 1;
    out[0] = c->values[0] + c->values[3] * time;
    out[1] = c->values[3] + c->values[1];
    out[2] = c->values[0] * time + 0.5 * c->values[3] * time * time + c->values[2];
    return 0;
}

static void draw_table(subject *c, uint32_t i, dmb_segment *term)
{
    byte_source *s = &c->source;
    double time = draw_number(s, -0.01, 0.01);
    term->table_count = draw_below(s, TABLE + 1);
    for (uint32_t k = 0; k < term->table_count; k++) {
        time += draw_chance(s, 6) ? any_number(s, 1.0) : draw_size(s, 1e-9, 1e-2);
        c->times[i][k] = time;
        c->values[i][k] = any_number(s, 10.0);
    }
    term->table_time = draw_chance(s, 3) ? NULL : c->times[i];
    term->table_value = c->values[i];
}

static dmb_segment draw_any_segment(subject *c, uint32_t i)
{
    byte_source *s = &c->source;
    dmb_segment term = dmb_segment_default();
    term.kind = (int32_t)draw_below(s, 10) - 1;
    term.provides = (int32_t)draw_below(s, 5);
    double *const fields[] = {&term.x0, &term.x1, &term.h0, &term.h1, &term.omega, &term.phase};
    for (size_t k = 0; k < sizeof fields / sizeof fields[0]; k++) *fields[k] = any_number(s, k < 2 ? 0.01 : 10.0);
    if (term.x1 < term.x0 && !draw_chance(s, 20)) {
        const double low = term.x1;
        term.x1 = term.x0;
        term.x0 = low;
    }
    term.callback = call_back;
    term.callback_context = &c->callback;
    draw_table(c, i, &term);
    if (draw_chance(s, 128) && term.table_count > 0) c->values[i][term.table_count - 1] = c->values[i][0];
    term.of = c->turning;
    term.share = any_number(s, 1.0);
    term.order = any_number(s, 3.0);
    return term;
}

/* With limits, as the set point of a motion drive must have. */
static void add_input(subject *c)
{
    dmb_input_def def = dmb_input_def_default();
    def.name[0] = 'a';
    def.part = c->drive;
    def.rate_limit = draw_size(&c->source, 1e-2, 1e6);
    def.slope_limit = draw_chance(&c->source, 128) ? draw_size(&c->source, 1e-2, 1e9) : 0.0;
    known(dmb_model_add_input(c->model, &def, &c->input));
    (void)dmb_model_clear_refused(c->model);
}

/* On its way from the time function to there, back to it as drawn, or refused. */
static void set_input(subject *c, dmb_sim *sim)
{
    const uint64_t before = hash_of(sim);
    const double value = any_number(&c->source, 10.0);
    const int32_t status = dmb_sim_set_input(sim, c->input, value);
    known(status);
    MUST(status >= 0 || hash_of(sim) == before);
}

static int describe(subject *c)
{
    byte_source *s = &c->source;
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment terms[TERMS];
    const uint32_t count = 1 + draw_below(s, TERMS);
    const dmb_segment turning = draw_any_segment(c, 0);
    known(dmb_model_add_time_function(c->model, &turning, 1, &c->turning));
    (void)dmb_model_clear_refused(c->model);
    for (int i = 0; i < 4; i++) c->callback.values[i] = any_number(s, 1.0);
    c->callback.fails_at = draw_chance(s, 30) ? 1 + draw_byte(s) : 0;
    for (uint32_t i = 0; i < count; i++) terms[i] = draw_any_segment(c, i);
    int32_t status = dmb_model_add_time_function(c->model, terms, count, &drive.time_function);
    known(status);
    if (status < 0) return 0;
    MUST(dmb_model_add_body(c->model, &body, &drive.part) == DMB_OK);
    drive.kind = (int32_t)draw_below(s, 3);
    drive.component = draw_chance(s, 128) ? DMB_X : DMB_RX;
    drive.gain = 1.0;
    if (draw_chance(s, 60)) drive.delay = drive.kind == DMB_DRIVE_MOTION ? 0.0 : 1e-3;
    if (c->more & 1) drive.excitation = drive.time_function;
    status = dmb_model_add_drive(c->model, &drive, &c->drive);
    known(status);
    if (status < 0) return 0;
    if (c->more & 2) add_input(c);
    status = dmb_model_compile(c->model, NULL);
    known(status);
    return status >= 0;
}

static void check_state(const subject *c, dmb_sim *sim)
{
    dmb_drive_state drive = dmb_drive_state_default();
    MUST(dmb_query_drive(sim, c->drive, &drive) == DMB_OK);
    MUST(isfinite(drive.target) && isfinite(drive.speed) && isfinite(drive.force) && isfinite(dmb_sim_time(sim)));
    check_restore(sim);
}

static void run(subject *c)
{
    byte_source *s = &c->source;
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim *sim = NULL;
    options.max_cuts = 4;
    options.max_steps = 20;
    const int32_t made = dmb_sim_create(c->model, &options, &sim);
    known(made);
    if (made < 0) return;
    for (int i = 0; i < STEPS; i++) {
        if ((c->more & 2) && draw_chance(s, 128)) set_input(c, sim);
        const uint64_t before = hash_of(sim);
        const int advances = draw_chance(s, 60);
        const double duration = draw_size(s, 1e-6, 1.0);
        const int32_t status =
            advances ? dmb_sim_advance(sim, dmb_sim_time(sim) + duration, NULL) : dmb_sim_step(sim, duration, NULL);
        known(status);
        MUST(status >= 0 || advances || hash_of(sim) == before);
        check_state(c, sim);
    }
    dmb_sim_destroy(&sim);
}

FUZZ_ENTRY(subject, describe, run)
