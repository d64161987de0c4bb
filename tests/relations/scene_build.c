#include "scene_build.h"

#include <stdio.h>
#include <string.h>

dmb_place built_place(const built *b, part_ref r)
{
    const dmb_id none = {0, 0};
    const dmb_id part = r.kind == PART_STRING  ? b->string[r.index]
                        : r.kind == PART_BODY  ? b->body[r.index]
                        : r.kind == PART_JOINT ? b->joint[r.index]
                        : r.kind == PART_BIT   ? b->bit
                                               : none;
    return dmb_station(part, r.pipe, r.fraction);
}

int32_t built_fail(built *b, int32_t status)
{
    const char *const text = b->sim ? dmb_sim_message(b->sim) : dmb_model_message(b->model);
    b->status = status;
    (void)snprintf(b->message, sizeof b->message, "%s", text);
    return status;
}

/* The first failure stays. */
static void take(built *b, int32_t status)
{
    if (b->status >= 0 && status < 0) (void)built_fail(b, status);
}

static dmb_id add_time_function(built *b, const time_function_data *p)
{
    dmb_id id = {0, 0};
    if (p->terms > 0) take(b, dmb_model_add_time_function(b->model, p->term, p->terms, &id));
    return id;
}

static void add_surroundings(const scene *s, built *b)
{
    dmb_wall_def wall = s->wall;
    take(b, dmb_model_set_environment(b->model, &s->environment));
    if (!s->has_wall) return;
    if (s->survey_count > 0) wall.survey = s->survey[0], wall.survey_count = s->survey_count;
    take(b, dmb_model_add_wall(b->model, &wall, NULL));
}

/* Pipe by pipe, the strings in turns. */
static void add_strings(const scene *s, int reversed, built *b)
{
    for (uint32_t i = 0; i < s->strings; ++i) {
        const uint32_t k = reversed ? s->strings - 1 - i : i;
        take(b, dmb_model_add_string(b->model, &s->string[k].def, &b->string[k]));
    }
    for (uint32_t p = 0; p < SCENE_PIPES; ++p) {
        for (uint32_t i = 0; i < s->strings; ++i) {
            const uint32_t k = reversed ? s->strings - 1 - i : i;
            if (p >= s->string[k].pipes) continue;
            dmb_pipe_def pipe = s->string[k].pipe[p];
            pipe.string = b->string[k];
            take(b, dmb_model_add_pipes(b->model, &pipe, 1, NULL));
        }
    }
}

static void add_body(const scene *s, uint32_t i, built *b)
{
    dmb_body_def body = s->body[i].def;
    if (body.attach != DMB_ATTACH_NONE) body.string = b->string[s->body[i].string];
    take(b, dmb_model_add_body(b->model, &body, &b->body[i]));
}

static void add_bit(const scene *s, built *b)
{
    dmb_bit_def bit = s->bit;
    if (!s->has_bit) return;
    bit.string = b->string[s->bit_string];
    bit.load = add_time_function(b, &s->bit_load);
    take(b, dmb_model_add_bit(b->model, &bit, &b->bit));
}

static void add_joint(const scene *s, uint32_t i, built *b)
{
    dmb_joint_def joint = s->joint[i].def;
    joint.place_a = built_place(b, s->joint[i].a);
    joint.place_b = built_place(b, s->joint[i].b);
    take(b, dmb_model_add_joint(b->model, &joint, &b->joint[i]));
}

static void add_drive(const scene *s, uint32_t i, built *b)
{
    dmb_drive_def drive = s->drive[i].def;
    drive.time_function = add_time_function(b, &s->drive[i].time_function);
    drive.part = built_place(b, s->drive[i].part).part;
    take(b, dmb_model_add_drive(b->model, &drive, &b->drive[i]));
}

static void add_load(const scene *s, uint32_t i, built *b)
{
    dmb_load_def load = s->load[i].def;
    load.time_function = add_time_function(b, &s->load[i].time_function);
    load.place = built_place(b, s->load[i].place);
    take(b, dmb_model_add_load(b->model, &load, &b->load[i]));
}

typedef void add_fn(const scene *s, uint32_t i, built *b);

static void add_each(const scene *s, uint32_t count, int reversed, add_fn *add, built *b)
{
    for (uint32_t i = 0; i < count; ++i) add(s, reversed ? count - 1 - i : i, b);
}

int32_t scene_build(const scene *s, int reversed, built *b)
{
    memset(b, 0, sizeof *b);
    take(b, dmb_model_create(NULL, &b->model));
    if (!reversed) add_surroundings(s, b);
    add_strings(s, reversed, b);
    if (reversed) add_bit(s, b);
    add_each(s, s->bodies, reversed, add_body, b);
    if (reversed) add_each(s, s->loads, reversed, add_load, b);
    add_each(s, s->joints, reversed, add_joint, b);
    if (!reversed) add_bit(s, b);
    add_each(s, s->drives, reversed, add_drive, b);
    if (!reversed) add_each(s, s->loads, reversed, add_load, b);
    if (reversed) add_surroundings(s, b);
    if (b->status >= 0) take(b, dmb_model_compile(b->model, NULL));
    return b->status;
}

dmb_sim_options scene_options(const scene *s)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = s->radius;
    options.newton_tolerance = 1e-12; /* next to nothing but rounding is left */
    options.max_iterations = 40;
    return options;
}

int32_t scene_open(const scene *s, int reversed, const dmb_sim_options *options, built *b)
{
    const dmb_sim_options usual = scene_options(s);
    int32_t status = scene_build(s, reversed, b);
    if (status < 0) return status;
    status = dmb_sim_create(b->model, options ? options : &usual, &b->sim);
    return status < 0 ? built_fail(b, status) : (b->status = status);
}

void scene_close(built *b)
{
    dmb_sim_destroy(&b->sim);
    dmb_model_destroy(&b->model);
}
