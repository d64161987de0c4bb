/* Bands of many modes against those of all modes by LAPACK: undamped ones divided by their counts, damped ones, with
 * and without joints, from 0 and from above it. Equations: eq:modes.count. */
#include <stdio.h>

#include "mechanism.h"
#include "modal.h"

/* A free string that lies on nothing, in one piece or in two with a sprung joint between them. */
static void open_string(rig *s, uint32_t pipes, int joint, double damping_time)
{
    dmb_pipe_def pipe = s1_pipe();
    pipe.damping_time = damping_time;
    const dmb_id first = lay_string(s, &pipe, joint ? pipes / 2 : pipes, DMB_FREE_CYLINDRICAL, DMB_FREE_ALL);
    if (joint) {
        dmb_string_def string = dmb_string_def_default();
        string.follows_hole = 0;
        string.position[0] = 1.5 * (pipes / 2);
        string.start_free = DMB_FREE_ALL;
        pipe.string = add_string(s, &string);
        (void)add_pipes(s, &pipe, pipes - pipes / 2);
        dmb_joint_def hinge = joint_between(DMB_JOINT_SPHERICAL, dmb_station(first, pipes / 2 - 1, 1.0),
                                            dmb_station(pipe.string, 0, 0.0));
        for (int c = DMB_RX; c <= DMB_RZ; c++) hinge.stiffness[c] = 1e5;
        (void)add_joint(s, &hinge);
    }
    (void)mechanism_start(s, NULL);
}

/* The band found by itself has the modes that all of them have in it. */
static void check_band(const char *what, const rig *s, int32_t kind, double low, double high, uint32_t least)
{
    dmb_modes *band = modes_in_band(s, kind, low, high), *all = all_modes(s, kind);
    const dmb_modes_info info = info_of(band);
    uint32_t inside = 0, k = 0;
    double worst = 0.0;
    assert_int_equal(info.dense, 0);
    for (uint32_t i = 0; i < info_of(all).count; i++) {
        const double f = frequency_at(all, i);
        if (f < low || f > high) continue;
        if (k < info.count && f > 0.0) worst = fmax(worst, fabs(frequency_at(band, k) / f - 1.0));
        if (k < info.count) assert_int_equal(mode_at(band, k).rigid, mode_at(all, i).rigid);
        inside++;
        k++;
    }
    print_message("%s, %g to %g Hz: %u modes of %u coordinates, %u solves\n", what, low, high, info.count,
                  info.coordinates, info.solves);
    assert_int_equal(info.count, inside);
    assert_true(inside >= least);
    check_below("  frequencies against all of them", worst, 1e-7);
    check_below("  residual", info.residual, 1e-10);
    dmb_modes_destroy(&band);
    dmb_modes_destroy(&all);
}

static void undamped_bands_are_divided(void **state)
{
    (void)state;
    for (int joint = 0; joint < 2; joint++) {
        rig s;
        open_string(&s, 80, joint, 0.0);
        const char *what = joint ? "undamped, with a joint" : "undamped";
        check_band(what, &s, DMB_MODES_UNDAMPED, 0.0, 80.0, 100);
        check_band(what, &s, DMB_MODES_UNDAMPED, 3.0, 75.0, 80);
        rig_close(&s);
    }
}

static void damped_bands(void **state)
{
    (void)state;
    for (int joint = 0; joint < 2; joint++) {
        rig s;
        open_string(&s, 80, joint, 2e-4);
        check_band(joint ? "damped, with a joint" : "damped", &s, DMB_MODES_DAMPED, 0.0, 35.0, 40);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(undamped_bands_are_divided),
        cmocka_unit_test(damped_bands),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
