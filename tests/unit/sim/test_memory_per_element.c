/* Memory of an element: bytes of model and sim over elements of the benchmark's scenes, by field, and their bound. */
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "sim/layout.h"

#include "../../bench/scenes.h"

enum { ELEMENTS = 100, SHOWN = 8 }; /* fields of 8 bytes and more an element are printed */
#define BYTES_MAX 3700.0

static double tell_group(const dmb_sim *sim, int32_t group, const char *name, int shown)
{
    dmb_field fields[DMB_FIELD_MAX];
    const size_t count = dmb_sim_fields(sim, group, group, fields);
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        const double bytes = (double)fields[i].bytes / ELEMENTS;
        sum += bytes;
        if (shown && bytes >= SHOWN) print_message("        %-22s %7.1f\n", fields[i].name, bytes);
    }
    print_message("    %-26s %7.1f\n", name, sum);
    return sum;
}

static void tell_fields(const scene *s, int shown)
{
    static const char *const names[] = {"configuration, accepted", "memory", "reused factors", "configuration, trial",
                                        "work"};
    static const int32_t groups[] = {DMB_GROUP_NOW, DMB_GROUP_MEMORY, DMB_GROUP_FACTORS, DMB_GROUP_TRIAL,
                                     DMB_GROUP_WORK};
    const dmb_sim_options options = dmb_sim_options_default();
    dmb_model_info info = dmb_model_info_default();
    dmb_sim *sim = NULL;
    assert_int_equal(dmb_sim_create(s->model, &options, &sim), DMB_OK);
    for (int i = 0; i < 5; i++) tell_group(sim, groups[i], names[i], shown);
    assert_int_equal(dmb_model_get_info(s->model, &info), DMB_OK);
    print_message("    %-26s %7.1f\n", "sim", (double)info.sim_bytes / ELEMENTS);
    print_message("    %-26s %7.1f\n", "model", (double)info.model_bytes / ELEMENTS);
    dmb_sim_destroy(&sim);
}

static void an_element_is_small(void **state)
{
    (void)state;
    for (int kind = SCENE_C; kind <= SCENE_R; kind++) {
        scene s = {.kind = kind, .pipes = ELEMENTS, .per_pipe = 1, .length = 1.0, .pipe_kind = DMB_PIPE_FLEXIBLE};
        if (kind == SCENE_B_COSINE) continue;
        assert_true(scene_open(&s) >= 0);
        print_message("    scene %s, bytes an element:\n", scene_names[kind]);
        tell_fields(&s, kind == SCENE_R);
        check_below("model and sim [byte]", s.bytes, BYTES_MAX);
        dmb_model_destroy(&s.model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(an_element_is_small)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
