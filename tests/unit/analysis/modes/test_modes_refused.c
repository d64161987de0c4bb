/* Modes that are none: right ones of all kinds of search pass the check of residuals; with a wrong shape, a wrong
 * frequency, or as a rigid-body motion with a frequency of rounding size, they are refused. */
#include <stdlib.h>
#include <string.h>

#include "modal.h"

#include "analysis/modes/modes.h"

typedef struct judged {
    dmb_mode_search search;
    dmb_message message;
    double *work;
} judged;

/* The bound by which dmb_analysis_modes judges its result. */
static void open_judged(judged *j, const rig *s, const dmb_modes_options *options, dmb_modes *modes)
{
    const dmb_linear_options as_it_is = {.contact = DMB_CONTACT_AS_IS};
    double most = 0.0;
    memset(j, 0, sizeof *j);
    assert_int_equal(dmb_linear_make(s->sim, &as_it_is, &j->search.linear), DMB_OK);
    const dmb_linear *linear = j->search.linear;
    j->work = calloc(10 * (size_t)linear->rows, sizeof(double));
    assert_non_null(j->work);
    j->search.options = options;
    j->search.modes = modes;
    j->search.message = &j->message;
    j->search.work = j->work;
    j->search.coordinate_mass = j->work + 9 * (size_t)linear->rows;
    for (uint32_t i = 0; i < linear->scene.node_count; i++)
        for (uint32_t c = 0; c < linear->scene.layout.size[i]; c++) {
            const double m = dmb_linear_diagonal(linear, &linear->mass, i, c);
            if (m > 0.0) most = fmax(most, dmb_linear_diagonal(linear, &linear->stiffness, i, c) / m);
        }
    j->search.noise = DMB_NOISE * most;
    dmb_modes_weigh_coordinates(&j->search);
}

static void close_judged(judged *j)
{
    dmb_linear_release(&j->search.linear);
    free(j->work);
}

/* Among the lowest modes those before the first one that is refused stay, with a note; here number k. */
static void expect_refused(judged *j, uint32_t k, const char *what, const char *text)
{
    dmb_modes *m = j->search.modes;
    const int lowest = j->search.options->select == DMB_MODES_LOWEST && k > j->search.rigid_count;
    const uint32_t count = m->count;
    const int32_t status = dmb_modes_check(&j->search);
    print_message("    %s: %d, %s\n", what, (int)status, j->message.text);
    assert_int_equal(status, lowest ? DMB_NOTE_INCOMPLETE : DMB_ERR_NO_CONVERGENCE);
    assert_int_equal(m->count, lowest ? k : count);
    m->count = count;
    assert_non_null(strstr(j->message.text, text));
}

/* A part of another mode in shape k, and its frequency off by a part. */
static void spoil(judged *j, uint32_t k)
{
    dmb_modes *m = j->search.modes;
    double *x = m->re + (size_t)m->rows * k, *other = m->re + (size_t)m->rows * (k - 2); /* k - 1 may be its twin */
    double *s = m->s + 2 * (size_t)k;
    assert_int_equal(dmb_modes_check(&j->search), DMB_OK);
    for (uint32_t r = 0; r < m->rows; r++) x[r] += 1e-2 * other[r];
    expect_refused(j, k, "wrong shape", "was not found sharply");
    for (uint32_t r = 0; r < m->rows; r++) x[r] -= 1e-2 * other[r];
    assert_int_equal(dmb_modes_check(&j->search), DMB_OK);
    s[1] *= 1.0 + 1e-3;
    expect_refused(j, k, "wrong frequency", "was not found sharply");
    s[1] /= 1.0 + 1e-3;
    assert_int_equal(dmb_modes_check(&j->search), DMB_OK);
}

/* Ten pipes clamped at one end: by LAPACK, by Krylov subspaces; undamped, damped, in a band. */
static void spoiled_modes_are_refused(void **state)
{
    (void)state;
    static const struct {
        int32_t kind, select;
        uint32_t count;
    } searches[] = {{DMB_MODES_UNDAMPED, DMB_MODES_ALL, 8},  {DMB_MODES_UNDAMPED, DMB_MODES_LOWEST, 8},
                    {DMB_MODES_DAMPED, DMB_MODES_ALL, 8},    {DMB_MODES_DAMPED, DMB_MODES_LOWEST, 8},
                    {DMB_MODES_UNDAMPED, DMB_MODES_BAND, 8}, {DMB_MODES_DAMPED, DMB_MODES_BAND, 8}};
    for (size_t i = 0; i < sizeof searches / sizeof searches[0]; i++) {
        dmb_pipe_def pipe = s1_pipe();
        dmb_modes_options options = dmb_modes_options_default();
        judged j;
        rig s;
        pipe.damping_time = 1e-5;
        (void)lay_string(&s, &pipe, 20, DMB_FREE_NONE, DMB_FREE_ALL);
        rig_start(&s, NULL);
        options.kind = searches[i].kind;
        options.select = searches[i].select;
        options.count = searches[i].count;
        options.band[1] = 12.0;
        dmb_modes *modes = find_modes(&s, &options);
        print_message("  kind %d, select %d: %u modes, dense %d\n", (int)options.kind, (int)options.select,
                      (unsigned)info_of(modes).count, (int)info_of(modes).dense);
        assert_int_equal(info_of(modes).dense, options.select == DMB_MODES_ALL);
        open_judged(&j, &s, &options, modes);
        spoil(&j, 5);
        close_judged(&j);
        dmb_modes_destroy(&modes);
        rig_close(&s);
    }
}

/* A rigid-body motion that is not told as one, with a root of rounding size: no forces witness it, nor does strain. */
static void rigid_motion_with_a_frequency_is_refused(void **state)
{
    (void)state;
    for (int32_t kind = DMB_MODES_UNDAMPED; kind <= DMB_MODES_DAMPED; kind++)
        for (int way = 0; way < 2; way++) {
            const dmb_pipe_def pipe = s1_pipe();
            dmb_modes_options options = dmb_modes_options_default();
            judged j;
            rig s;
            (void)lay_string(&s, &pipe, 20, DMB_FREE_ALL, DMB_FREE_ALL);
            rig_start(&s, NULL);
            options.kind = kind;
            options.select = way ? DMB_MODES_LOWEST : DMB_MODES_ALL;
            options.count = 10;
            dmb_modes *modes = find_modes(&s, &options);
            assert_int_equal(info_of(modes).rigid, 6);
            open_judged(&j, &s, &options, modes);
            assert_int_equal(dmb_modes_check(&j.search), DMB_OK);
            modes->rigid[2] = 0;
            modes->s[2 * 2 + 1] = 1e-6;
            expect_refused(&j, 2, "rigid-body motion", "modes: mode 2 of");
            close_judged(&j);
            dmb_modes_destroy(&modes);
            rig_close(&s);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spoiled_modes_are_refused),
        cmocka_unit_test(rigid_motion_with_a_frequency_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
