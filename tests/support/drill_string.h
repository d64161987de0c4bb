/* A string of equal pipes, in a hole or not, that is described by the fields of this struct and then made. */
#ifndef DMB_TESTS_DRILL_STRING_H
#define DMB_TESTS_DRILL_STRING_H

#include "check.h"
#include "drillmbd/drillmbd.h"

typedef struct scene {
    dmb_model *model;
    dmb_sim *sim;
    dmb_wall_def wall;
    dmb_environment_def environment;
    dmb_string_def string;
    dmb_pipe_def pipe;
    dmb_load_def load; /* at the far end, where a test adds it */
    uint32_t pipes;
} scene;

static inline void must(int32_t status, const char *message)
{
    if (status < 0) fail_msg("%d: %s", (int)status, message);
}

static inline scene string_of(uint32_t pipes)
{
    scene s = {.wall = dmb_wall_def_default(),
               .environment = dmb_environment_def_default(),
               .string = dmb_string_def_default(),
               .pipe = dmb_pipe_def_default(),
               .load = dmb_load_def_default(),
               .pipes = pipes};
    s.string.start_free = DMB_FREE_NONE;
    return s;
}

static inline void add_string(scene *s, int with_hole)
{
    must(dmb_model_create(NULL, &s->model), "create");
    must(dmb_model_set_environment(s->model, &s->environment), dmb_model_message(s->model));
    if (with_hole) must(dmb_model_add_wall(s->model, &s->wall, NULL), dmb_model_message(s->model));
    must(dmb_model_add_string(s->model, &s->string, &s->pipe.string), dmb_model_message(s->model));
    must(dmb_model_add_pipes(s->model, &s->pipe, s->pipes, NULL), dmb_model_message(s->model));
}

static inline void finish_scene(scene *s)
{
    must(dmb_model_compile(s->model, NULL), dmb_model_message(s->model));
    must(dmb_sim_create(s->model, NULL, &s->sim), dmb_model_message(s->model));
}

static inline void destroy(scene *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

static inline double area(const scene *s)
{
    return 0.25 * PI * (pow(s->pipe.outer_diameter, 2) - pow(s->pipe.inner_diameter, 2));
}

static inline double second_moment(const scene *s)
{
    return PI / 64.0 * (pow(s->pipe.outer_diameter, 4) - pow(s->pipe.inner_diameter, 4));
}

/* [N/m] in the fluid */
static inline double weight(const scene *s)
{
    return 9.81 * area(s) * (s->pipe.density - s->environment.fluid_density);
}

#endif
