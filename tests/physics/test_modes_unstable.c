/* Bands of a column far beyond its critical load against all of its modes by the dense way: those that diverge stand in
 * a band by their growth. And strings on the axis of their hole, whose torsion does not feel how fast they turn. */
#include "modal.h"

/* Straight, with so many modes that bands are searched for piece by piece. */
static void open_column(rig *s)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def load = dmb_load_def_default();
    const dmb_id string = lay_string(s, &pipe, 60, DMB_FREE_NONE, DMB_FREE_TRANSLATIONS);
    load.place = dmb_station(string, 59, 1.0);
    load.force[0] = -2e5;
    (void)add_load(s, &load);
    (void)rig_start(s, NULL);
    assert_int_equal(dmb_analysis_static(s->sim, NULL, NULL), DMB_NOTE_UNSTABLE); /* it stays straight */
}

static void check_band(const rig *s, double low, double high, uint32_t divergent)
{
    dmb_modes *band = modes_in_band(s, DMB_MODES_UNDAMPED, low, high), *all = all_modes(s, DMB_MODES_UNDAMPED);
    const dmb_modes_info info = info_of(band);
    uint32_t k = 0, growing = 0;
    double worst = 0.0;
    for (uint32_t i = 0; i < info_of(all).count; i++) {
        const dmb_mode wanted = mode_at(all, i);
        const double f = wanted.frequency;
        if (f < low || f > high) continue;
        assert_true(k < info.count);
        const dmb_mode got = mode_at(band, k++);
        worst = fmax(worst, fabs(got.frequency / f - 1.0));
        growing += got.eigenvalue[0] > 0.0;
        assert_true((got.eigenvalue[0] > 0.0) == (wanted.eigenvalue[0] > 0.0));
    }
    print_message("    %g to %g Hz: %u modes, %u grow, dense %d\n", low, high, info.count, growing, info.dense);
    assert_int_equal(info.count, k);
    assert_int_equal(info.dense, 0);
    assert_true(growing >= divergent);
    check_below("    off all of them", worst, 1e-6);
    dmb_modes_destroy(&band);
    dmb_modes_destroy(&all);
}

static void bands_of_a_column_that_diverges(void **state)
{
    (void)state;
    rig s;
    open_column(&s);
    check_band(&s, 0.0, 40.0, 4);
    check_band(&s, 0.05, 40.0, 4);
    rig_close(&s);
}

/* Path nodes have no axes across. */
static void torsion_of_what_turns(void **state)
{
    (void)state;
    double frequency[2];
    for (int turns = 0; turns < 2; turns++) {
        rig s;
        dmb_string_def def = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        dmb_modes_options options = dmb_modes_options_default();
        const dmb_wall_def hole = s1_hole();
        rig_open(&s, 0.0, 0.0, 0.0);
        (void)add_wall(&s, &hole);
        def.start_free = DMB_FREE_NONE;
        pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
        pipe.string = add_string(&s, &def);
        (void)add_pipes(&s, &pipe, 20);
        (void)rig_start(&s, NULL);
        options.kind = DMB_MODES_DAMPED;
        options.axes = DMB_MODES_AXES_AT_REST;
        options.spin = turns ? 10.0 : 0.0;
        options.count = 6;
        dmb_modes *modes = find_modes(&s, &options);
        frequency[turns] = frequency_of_kind(modes, 1, 0);
        dmb_modes_destroy(&modes);
        rig_close(&s);
    }
    const s1_section v = s1_values();
    const double speed = sqrt(v.GJ / (7850.0 * 2.0 * v.I));
    check_relative("quarter wave of torsion", frequency[0], speed / (4.0 * 30.0), 1e-3);
    check_relative("while it turns", frequency[1], frequency[0], 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_of_a_column_that_diverges),
        cmocka_unit_test(torsion_of_what_turns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
