/* Events between two points of a path by the count of negative eigenvalues, and by the sign of det K where that count
 * is not resolved (-1). */
#include <string.h>

#include "analysis/buckling/buckling.h"
#include "rig.h"

typedef struct change {
    int32_t last, last_odd, next, next_odd;
    int32_t event;
} change;

static int32_t event_of(const change *c, double rate)
{
    dmb_path_options options = dmb_path_options_default();
    dmb_path path = {.options = &options, .side = 1.0};
    options.factor_end = 10.0;
    path.last.negative = c->last;
    path.last.odd = c->last_odd;
    path.next.negative = c->next;
    path.next.odd = c->next_odd;
    path.next.factor = 1.0;
    path.next.rate = rate;
    return dmb_path_event(&path);
}

static void a_count_that_is_not_resolved_is_no_number(void **state)
{
    static const change changes[] = {
        {0, 0, 0, 0, DMB_EVENT_NONE},         {0, 0, 1, 1, DMB_EVENT_BIFURCATION},
        {0, 0, 2, 0, DMB_EVENT_BIFURCATION},  {2, 0, 1, 1, DMB_EVENT_BIFURCATION},
        {0, 0, -1, 0, DMB_EVENT_NONE},        {-1, 0, 0, 0, DMB_EVENT_NONE},
        {1, 1, -1, 1, DMB_EVENT_NONE},        {-1, 1, 1, 1, DMB_EVENT_NONE},
        {-1, 0, -1, 0, DMB_EVENT_NONE},       {0, 0, -1, 1, DMB_EVENT_BIFURCATION},
        {-1, 1, 0, 0, DMB_EVENT_BIFURCATION}, {-1, 1, -1, 0, DMB_EVENT_BIFURCATION},
    };
    (void)state;
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; i++) {
        assert_int_equal(event_of(&changes[i], 1.0), changes[i].event);
        assert_int_equal(event_of(&changes[i], -1.0), DMB_EVENT_LIMIT);
    }
}

/* A clamped column, softer in one plane, with Euler's load of that plane at its end. */
static dmb_id column(rig *s)
{
    const double EI = 2e5;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def beam = beam_pipe(5.0, 4, 1e7 * EI, 1e7 * EI, EI, EI);
    dmb_load_def load = dmb_load_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_NONE;
    beam.section_stiffness[5] *= 3.0;
    beam.string = add_string(s, &string);
    load.place = dmb_station(add_pipes(s, &beam, 1), 0, 1.0);
    load.force[0] = -PI * PI * EI / 100.0;
    load.time_function = add_constant(s, 0.0);
    const dmb_id push = add_load(s, &load);
    (void)rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
    return push;
}

/* Points whose count is lost: the path goes on without events to Euler's load, and finds it by the sign of det K. */
static void euler_load_without_a_count(void **state)
{
    (void)state;
    for (int32_t lost = 0; lost < 2; lost++) {
        rig s;
        dmb_path_options options = dmb_path_options_default();
        dmb_path path;
        int32_t event = DMB_EVENT_NONE;
        memset(&path, 0, sizeof path);
        options.scale = DMB_SCALE_PART;
        options.part = column(&s);
        options.factor_end = 2.0;
        path.sim = s.sim;
        path.options = &options;
        must(&s, dmb_load_pattern_allocate(s.sim, "path", options.scale, options.part, &path.pattern));
        must(&s, dmb_path_open(&path));
        double arc = 0.11 / path.last.rate, before = 0.0;
        for (int k = 0; k < 30 && event == DMB_EVENT_NONE; k++) {
            if (lost) path.last.negative = -1;
            before = path.last.factor;
            must(&s, dmb_path_find_next(&path, &arc, &event));
            assert_true(path.next.factor > before);
            if (event == DMB_EVENT_NONE) must(&s, dmb_path_accept(&path));
        }
        assert_int_equal(event, DMB_EVENT_BIFURCATION);
        check_relative("Euler's load", path.next.factor, 1.0, 1e-3);
        assert_int_equal(path.next.negative, 1);
        dmb_path_close(&path);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_count_that_is_not_resolved_is_no_number),
        cmocka_unit_test(euler_load_without_a_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
