/* Linear buckling: Euler's column and the string that lies in its hole (Dawson, Paslay 1984), each as the half of a
 * pinned one: pinned at the rig end, and free to move but not to turn at the other, the middle of the whole. Equations:
 * eq:buckling.pencil. Equations: eq:drilling.sinusoidal. */
#include <stdio.h>

#include "rig.h"

enum { FREE_TO_MOVE = DMB_FREE_TRANSLATIONS };
#define PIPE 1.5 /* [m] in the hole, of four elements */

typedef struct half {
    rig s;
    dmb_id string, push;
    dmb_id strings[20];
    uint32_t pipes;
    int jointed; /* 1: every pipe a string of its own, with fixed joints between them */
} half;

/* Part 0 .. 1 of the half from its pin on. */
static dmb_place at_part(const half *h, double part)
{
    const uint32_t pipe = part < 1.0 ? (uint32_t)(part * h->pipes) : h->pipes - 1;
    return h->jointed ? dmb_station(h->strings[pipe], 0, part * h->pipes - pipe)
                      : dmb_station(h->string, pipe, part * h->pipes - pipe);
}

/* The pipes, each but the first held by the one before. */
static void add_jointed_pipes(half *h, const dmb_string_def *first, dmb_pipe_def pipe)
{
    for (uint32_t i = 0; i < h->pipes; i++) {
        dmb_string_def def = *first;
        dmb_joint_def joint = dmb_joint_def_default();
        def.start_depth = i * pipe.length;
        if (i > 0) def.start_free = DMB_FREE_ALL;
        if (i + 1 < h->pipes) def.end_free = DMB_FREE_ALL;
        pipe.string = h->strings[i] = add_string(&h->s, &def);
        (void)add_pipes(&h->s, &pipe, 1);
        if (i == 0) continue;
        joint.place_a = dmb_station(h->strings[i - 1], 0, 1.0);
        joint.place_b = dmb_station(h->strings[i], 0, 0.0);
        must_model(&h->s, dmb_model_add_joint(h->s.model, &joint, NULL));
    }
}

/* Without shear and stretch, which the closed forms leave out. */
static void open_half(half *h, double length, uint32_t pipes, uint32_t elements, int in_hole, double preload)
{
    const double EI = s1_values().EI;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(length / pipes, elements, 1e6 * EI, 1e6 * EI, EI, EI);
    dmb_load_def push = dmb_load_def_default();
    rig_open(&h->s, 0.0, 0.0, in_hole ? -9.81 : 0.0);
    if (in_hole) {
        dmb_wall_def wall = s1_hole();
        wall.stiffness = 1e9;
        wall.friction_law = DMB_FRICTION_NONE;
        (void)add_wall(&h->s, &wall);
        pipe.outer_diameter = 0.073;
        pipe.section_mass = s1_values().mass;
        def.offset[1] = -(0.0105 + s1_values().weight / wall.stiffness); /* where the wall carries the weight */
    } else {
        def.follows_hole = 0;
    }
    def.start_free = DMB_FREE_SPHERICAL;
    def.end_free = FREE_TO_MOVE;
    h->pipes = pipes;
    if (h->jointed) {
        add_jointed_pipes(h, &def, pipe);
    } else {
        pipe.string = add_string(&h->s, &def);
        h->string = add_pipes(&h->s, &pipe, pipes);
    }
    push.place = at_part(h, 1.0);
    push.force[0] = -1.0;
    const dmb_segment off = dmb_segment_default(); /* of height 0: there is no push at present */
    push.time_function = add_time_function(&h->s, &off, 1);
    h->push = add_load(&h->s, &push);
    push.force[0] = -preload;
    push.time_function = (dmb_id){0, 0};
    if (preload > 0.0) (void)add_load(&h->s, &push);
    (void)rig_start(&h->s, NULL);
    (void)find_equilibrium(&h->s, NULL);
}

static dmb_buckling *critical(const half *h, uint32_t count)
{
    dmb_buckling *found = NULL;
    dmb_buckling_options options = dmb_buckling_options_default();
    uint64_t before, after;
    options.scale = DMB_SCALE_PART;
    options.part = h->push;
    options.count = count;
    must(&h->s, dmb_sim_hash(h->s.sim, &before));
    const int32_t status = dmb_analysis_buckling(h->s.sim, &options, &found);
    must(&h->s, status);
    assert_int_equal(status, DMB_OK);
    must(&h->s, dmb_sim_hash(h->s.sim, &after));
    assert_true(before == after);
    assert_int_equal(dmb_buckling_count(found), count);
    return found;
}

static double factor_of(const dmb_buckling *found, uint32_t mode)
{
    double factor = 0.0;
    assert_int_equal(dmb_buckling_factor(found, mode, &factor), DMB_OK);
    return factor;
}

/* ---- Euler ------------------------------------------------------------------------------------------------------- */

/* S1, 10 m pinned: 19582.398515 N, twice (in y and z), then 9 and 25 times as much; the shape is a sine. */
static void euler_column(void **state)
{
    (void)state;
    const uint32_t elements[3] = {4, 8, 16};
    double error[3];
    for (int k = 0; k < 3; k++) {
        half h = {0};
        open_half(&h, 5.0, 1, elements[k], 0, 0.0);
        dmb_buckling *found = critical(&h, 6);
        error[k] = fabs(factor_of(found, 0) / 19582.398515 - 1.0);
        print_message("    %2u elements for 5 m: %.6f N, off by %.3g\n", elements[k], factor_of(found, 0), error[k]);
        check_relative("    the other direction", factor_of(found, 1), factor_of(found, 0), 1e-8);
        if (elements[k] == 16) {
            double worst = 0.0, end[6], other[6], at[6];
            check_relative("    9 times", factor_of(found, 2), 9.0 * 19582.398515, 1e-4);
            check_relative("    25 times", factor_of(found, 5), 25.0 * 19582.398515, 1e-3);
            assert_int_equal(dmb_buckling_shape(found, 0, at_part(&h, 1.0), end), DMB_OK);
            assert_int_equal(dmb_buckling_shape(found, 1, at_part(&h, 1.0), other), DMB_OK);
            for (int i = 0; i <= 40; i++) {
                assert_int_equal(dmb_buckling_shape(found, 0, at_part(&h, i / 40.0), at), DMB_OK);
                for (int c = 1; c < 3; c++) worst = fmax(worst, fabs(at[c] - end[c] * sin(0.5 * PI * i / 40.0)));
            }
            check_below("    shape less a sine, between nodes too", worst, 1e-5);
            check_below("    the second direction is across the first", end[1] * other[1] + end[2] * other[2], 1e-6);
        }
        dmb_buckling_destroy(&found);
        rig_close(&h.s);
    }
    check_below("4 elements for half the column", error[0], 3e-4);
    check_below("8 elements", error[1], 2e-5);
    check_below("16 elements, wanted 1e-5", error[2], 2e-6);
    check_order("Euler's load, 4 and 8 elements", error[0], error[1], 4.0, 0.2);
}

/* A column of 3 m, clamped at the rig end, whose far end a support lets move in a plane, and not turn: pi^2 E I/L^2 in
 * that plane, 4 pi^2 E I/L^2 across it, where the end may move along alone. Bars beside it, which do not turn, change
 * nothing. */
static void support_that_leaves_a_plane(void **state)
{
    (void)state;
    const double EI = s1_values().EI, length = 3.0, euler = PI * PI * EI / (length * length);
    for (int k = 0; k < 2; k++) {
        rig s;
        dmb_string_def def = dmb_string_def_default();
        dmb_pipe_def pipe = beam_pipe(length, 12, 1e6 * EI, 1e6 * EI, EI, EI);
        dmb_load_def push = dmb_load_def_default();
        dmb_buckling_options options = dmb_buckling_options_default();
        dmb_buckling *found = NULL;
        double shape[6];
        rig_open(&s, 0.0, 0.0, 0.0);
        def.follows_hole = 0;
        def.start_free = DMB_FREE_NONE;
        def.end_free = k == 0 ? DMB_FREE_XY : DMB_FREE_XZ;
        pipe.string = add_string(&s, &def);
        (void)add_pipes(&s, &pipe, 1);
        push.place = dmb_station(pipe.string, 0, 1.0);
        push.force[0] = -1.0;
        (void)add_load(&s, &push);
        def.end_free = DMB_FREE_ALL;
        dmb_pipe_def bars = s1_pipe();
        bars.kind = DMB_PIPE_AXIAL_TORSIONAL;
        bars.string = add_string(&s, &def);
        (void)add_pipes(&s, &bars, 3);
        (void)rig_start(&s, NULL);
        (void)find_equilibrium(&s, NULL);
        options.count = 2;
        must(&s, dmb_analysis_buckling(s.sim, &options, &found));
        check_relative("a support that leaves a plane: in it", 1.0 + factor_of(found, 0), euler, 1e-4);
        check_relative("    across it", 1.0 + factor_of(found, 1), 4.0 * euler, 1e-3);
        assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(pipe.string, 0, 0.5), shape), DMB_OK);
        check_below("    the shape stays in the plane", shape[k == 0 ? DMB_Z : DMB_Y], 1e-9);
        dmb_buckling_destroy(&found);
        rig_close(&s);
    }
}

/* ---- On the low side of the hole --------------------------------------------------------------------------------- */

/* F = EI k^2 + w/(r k^2), k = n pi/L: the least over the whole number n of half waves, those with a crest in the middle
 * in the half. */
static double dawson_paslay(double length, uint32_t *waves)
{
    double least = (double)INFINITY;
    for (uint32_t n = 1; n < 1000; n += 2) {
        const double k = n * PI / length, F = s1_values().EI * k * k + s1_values().weight / (0.0105 * k * k);
        if (F < least) *waves = n;
        least = fmin(least, F);
    }
    return least;
}

static uint32_t half_waves(const dmb_buckling *found, const half *h)
{
    uint32_t waves = 1; /* a crest at the end is half of one */
    double last = 0.0, at[6];
    for (int i = 1; i <= 4000; i++) {
        assert_int_equal(dmb_buckling_shape(found, 0, at_part(h, i / 4000.0), at), DMB_OK);
        if (last * at[1] < 0.0) waves += 2;
        last = at[1];
    }
    return waves;
}

/* S1, 30 m pinned on the low side: 102804.3692 N with five half waves of 6 m; 2 sqrt(EI w/r) = 102629.9047 N and
 * 6.177 m without an end. */
static void sinusoidal_buckling_in_the_hole(void **state)
{
    (void)state;
    const double length[3] = {30.0, 300.0, 1500.0},
                 unlimited = 2.0 * sqrt(s1_values().EI * s1_values().weight / 0.0105);
    check_relative("closed form without an end", unlimited, 102629.9047, 1e-8);
    for (int k = 0; k < 3; k++) {
        half h = {0};
        uint32_t waves = 0;
        const double want = dawson_paslay(length[k], &waves);
        open_half(&h, 0.5 * length[k], (uint32_t)(0.5 * length[k] / PIPE), 4, 1, 0.0);
        assert_true(contacts_of(&h.s).closed >= 4 * (uint32_t)(0.5 * length[k] / PIPE)); /* all but the pinned end */
        dmb_buckling *found = critical(&h, 1);
        const uint32_t got = half_waves(found, &h);
        print_message("    %.0f m: %.4f N, %u half waves of %.4f m\n", length[k], factor_of(found, 0), got,
                      length[k] / got);
        if (k == 0) check_relative("    102804.3692 N at 30 m", factor_of(found, 0), 102804.3692, 1e-4);
        check_relative("    closed form of this length", factor_of(found, 0), want, 1e-4);
        assert_int_equal(got, waves);
        if (k == 2) {
            check_relative("    2 sqrt(EI w/r)", factor_of(found, 0), unlimited, 1e-4);
            check_relative("    half wave 6.177 m", length[k] / got, 6.177, 5e-3);
        }
        dmb_buckling_destroy(&found);
        rig_close(&h.s);
    }
}

/* A preload is subtracted: under a part of the critical push the rest of it is left. */
static void preload_counts(void **state)
{
    (void)state;
    double left[2];
    for (int k = 0; k < 2; k++) {
        half h = {0};
        open_half(&h, 15.0, 10, 4, 1, 60e3 * k);
        dmb_buckling *found = critical(&h, 1);
        left[k] = factor_of(found, 0);
        rig_close(&h.s); /* what was found stands on its own */
        double shape[6];
        assert_int_equal(dmb_buckling_shape(found, 0, at_part(&h, 0.5), shape), DMB_OK);
        dmb_buckling_destroy(&found);
        assert_null(found);
    }
    check_relative("what is left under 60 kN, and 60 kN", left[1] + 60e3, left[0], 1e-6);
}

/* The same string with an explicit joint at every pipe: 54 equations more, and the same factors and shape. */
static void explicit_joints_change_nothing(void **state)
{
    (void)state;
    half h[2] = {{.jointed = 0}, {.jointed = 1}};
    dmb_buckling *found[2];
    double worst = 0.0, shapes = 0.0;
    for (int k = 0; k < 2; k++) {
        open_half(h + k, 15.0, 10, 4, 1, 60e3);
        found[k] = critical(h + k, 4);
    }
    for (uint32_t i = 0; i < 4; i++) worst = fmax(worst, fabs(factor_of(found[1], i) / factor_of(found[0], i) - 1.0));
    for (int i = 0; i <= 40; i++) {
        double a[6], b[6];
        assert_int_equal(dmb_buckling_shape(found[0], 0, at_part(h, i / 40.0), a), DMB_OK);
        assert_int_equal(dmb_buckling_shape(found[1], 0, at_part(h + 1, i / 40.0), b), DMB_OK);
        shapes = fmax(shapes, fabs(fabs(a[1]) - fabs(b[1])));
    }
    check_below("joints at every pipe, on the low side under 60 kN: 4 factors", worst, 1e-8);
    check_below("  the shape", shapes, 1e-6);
    for (int k = 0; k < 2; k++) {
        dmb_buckling_destroy(found + k);
        rig_close(&h[k].s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(euler_column),
        cmocka_unit_test(support_that_leaves_a_plane),
        cmocka_unit_test(sinusoidal_buckling_in_the_hole),
        cmocka_unit_test(preload_counts),
        cmocka_unit_test(explicit_joints_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
