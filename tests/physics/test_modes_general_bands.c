/* Bands of many modes of which some diverge or flutter, or are rigid motions, against those of all modes by the dense
 * way. */
#include "modal.h"

/* Straight, clamped; a load along its end, which makes K unsymmetric, and a dead one beyond its critical load. */
static void open_column(rig *s, uint32_t pipes, double follower, double dead, double damping_time)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def load = dmb_load_def_default();
    pipe.damping_time = damping_time;
    const dmb_id string = lay_string(s, &pipe, pipes, DMB_FREE_NONE, DMB_FREE_ALL);
    load.place = dmb_station(string, pipes - 1, 1.0);
    load.force[0] = -dead;
    (void)add_load(s, &load);
    load.frame = DMB_FRAME_BODY;
    load.force[0] = -follower;
    (void)add_load(s, &load);
    (void)rig_start(s, NULL);
    assert_true(dmb_analysis_static(s->sim, NULL, NULL) >= 0);
}

/* Free at both ends, in mud that drags. */
static void open_free(rig *s, uint32_t pipes, double drag)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_environment_def environment = dmb_environment_def_default();
    (void)lay_string(s, &pipe, pipes, DMB_FREE_ALL, DMB_FREE_ALL);
    environment.gravity[2] = 0.0;
    environment.lateral_damping = drag;
    must_model(s, dmb_model_set_environment(s->model, &environment));
    (void)rig_start(s, NULL);
}

static int same_root(const dmb_mode *a, const dmb_mode *b, double size)
{
    return hypot(a->eigenvalue[0] - b->eigenvalue[0], fabs(a->eigenvalue[1]) - fabs(b->eigenvalue[1])) <= 1e-6 * size;
}

/* Each root of the band is one of all, as often as there; so many of them grow. */
static void check_band(const rig *s, const dmb_modes *all, int32_t kind, double low, double high, uint32_t growing)
{
    static uint8_t taken[4096];
    dmb_modes *band = modes_in_band(s, kind, low, high);
    const dmb_modes_info info = info_of(band);
    uint32_t inside = 0, matched = 0, grow = 0;
    for (uint32_t i = 0; i < info_of(all).count; i++) {
        taken[i] = 0;
        inside += frequency_at(all, i) >= low && frequency_at(all, i) <= high;
    }
    for (uint32_t k = 0; k < info.count; k++) {
        const dmb_mode got = mode_at(band, k);
        const uint32_t before = matched;
        grow += got.eigenvalue[0] > 1e-3;
        for (uint32_t i = 0; i < info_of(all).count && matched == before; i++) {
            const dmb_mode want = mode_at(all, i);
            if (taken[i] || !same_root(&got, &want, 2.0 * PI * fmax(got.frequency, 0.01 * high))) continue;
            taken[i] = 1;
            matched++;
        }
    }
    print_message("    %s, %g to %g Hz: %u modes of %u coordinates, %u grow, dense %d, %u solves\n",
                  kind == DMB_MODES_DAMPED ? "damped" : "undamped", low, high, info.count, info.coordinates, grow,
                  (int)info.dense, info.solves);
    assert_int_equal(info.count, inside);
    assert_int_equal(matched, inside);
    assert_int_equal(grow, growing);
    dmb_modes_destroy(&band);
}

/* Flutter in both planes; and with it a real root in both, which rounding may make a pair of. */
static void columns_under_a_follower(void **state)
{
    (void)state;
    for (int diverges = 0; diverges < 2; diverges++) {
        const uint32_t growing = diverges ? 4 : 2;
        rig s;
        open_column(&s, 44, 1500.0, diverges * 1800.0, 0.0);
        dmb_modes *undamped = all_modes(&s, DMB_MODES_UNDAMPED), *damped = all_modes(&s, DMB_MODES_DAMPED);
        check_band(&s, undamped, DMB_MODES_UNDAMPED, 0.0, 10.0, growing);
        check_band(&s, undamped, DMB_MODES_UNDAMPED, 20.0, 40.0, 0);
        check_band(&s, damped, DMB_MODES_DAMPED, 0.0, 20.0, growing);
        check_band(&s, damped, DMB_MODES_DAMPED, 0.0, 100.0, growing); /* so many that all are found */
        dmb_modes_destroy(&undamped);
        dmb_modes_destroy(&damped);
        rig_close(&s);
    }
}

/* K is symmetric; each root that grows has one that decays beside it, all of them modes. */
static void damped_column_that_diverges(void **state)
{
    (void)state;
    rig s;
    open_column(&s, 44, 0.0, 1800.0, 1e-4);
    dmb_modes *all = all_modes(&s, DMB_MODES_DAMPED);
    check_band(&s, all, DMB_MODES_DAMPED, 0.0, 20.0, 4);
    dmb_modes_destroy(&all);
    rig_close(&s);
}

/* Six motions of root 0; with drag, roots of drifting in two planes. */
static void free_strings(void **state)
{
    (void)state;
    for (int drags = 0; drags < 2; drags++) {
        rig s;
        open_free(&s, 44, drags * 5.0);
        dmb_modes *all = all_modes(&s, DMB_MODES_DAMPED);
        check_band(&s, all, DMB_MODES_DAMPED, 0.0, 60.0, 0);
        dmb_modes_destroy(&all);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_under_a_follower),
        cmocka_unit_test(damped_column_that_diverges),
        cmocka_unit_test(free_strings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
