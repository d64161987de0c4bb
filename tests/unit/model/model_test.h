/* Shared by the tests of lib/model: small scenes, compiled, with their scene at hand. */
#ifndef MODEL_TEST_H
#define MODEL_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <math.h>

#include "model/mesh.h"

#define TEST(name) cmocka_unit_test(name)
#define assert_ok(call) assert_int_equal((call), DMB_OK)

/* |a - b| <= tolerance * scale */
#define assert_near(a, b, tolerance)                                                  \
    do {                                                                              \
        const double a_ = (a), b_ = (b);                                              \
        if (!(fabs(a_ - b_) <= (tolerance)*fmax(1e-300, fmax(fabs(a_), fabs(b_))))) { \
            print_error("%s = %.17g, expected %.17g\n", #a, a_, b_);                  \
            fail();                                                                   \
        }                                                                             \
    } while (0)
#define assert_close(a, b, tolerance)                                                           \
    do {                                                                                        \
        const double a_ = (a), b_ = (b);                                                        \
        if (!(fabs(a_ - b_) <= (tolerance))) {                                                  \
            print_error("%s = %.17g, expected %.17g +- %g\n", #a, a_, b_, (double)(tolerance)); \
            fail();                                                                             \
        }                                                                                       \
    } while (0)

/* Reference string S1 of lib/theory/limits.md. */
static inline dmb_pipe_def s1_pipe(void)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.055;
    pipe.length = 1.5;
    pipe.young_modulus = 2.1e11;
    return pipe;
}

static inline dmb_model *new_model(void)
{
    dmb_model *model = NULL;
    assert_ok(dmb_model_create(NULL, &model));
    return model;
}

static inline dmb_id add_pipes(dmb_model *model, const dmb_pipe_def *pipe, uint32_t count)
{
    dmb_id id = {0, 0};
    assert_ok(dmb_model_add_pipes(model, pipe, count, &id));
    return id;
}

static inline dmb_id add_wall(dmb_model *model)
{
    const dmb_wall_def wall = dmb_wall_def_default();
    dmb_id id = {0, 0};
    assert_ok(dmb_model_add_wall(model, &wall, &id));
    return id;
}

static inline dmb_id add_constant(dmb_model *model, double value)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id = {0, 0};
    term.h0 = value;
    assert_ok(dmb_model_add_time_function(model, &term, 1, &id));
    return id;
}

static inline const dmb_scene *compiled(dmb_model *model)
{
    const int32_t status = dmb_model_compile(model, NULL);
    if (status != DMB_OK) print_error("%s: %s\n", dmb_status_name(status), dmb_model_message(model));
    assert_int_equal(status, DMB_OK);
    return model->scene;
}

static inline const dmb_scene *compiled_with(dmb_model *model, int32_t features, int32_t pipe_kind)
{
    dmb_compile_options options = dmb_compile_options_default();
    options.features = features;
    options.pipe_kind = pipe_kind;
    assert_ok(dmb_model_compile(model, &options));
    return model->scene;
}

#endif
