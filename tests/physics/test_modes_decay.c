/* Damping of modes, and a free decay in time beside them. */
#include <stdio.h>

#include "modal.h"

/* ---- Damping ----------------------------------------------------------------------------------------------------- */

/* Damping in proportion to the stress: zeta = tau w/2 in every mode. */
static void stress_proportional_damping(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    pipe.damping_time = 3e-5;
    (void)lay_string(&s, &pipe, 20, DMB_FREE_NONE, DMB_FREE_ALL);
    rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 12);
    double worst = 0.0;
    for (uint32_t i = 0; i < 12; i++) {
        const dmb_mode mode = mode_at(modes, i);
        worst = fmax(worst, fabs(mode.damping / (0.5 * 3e-5 * 2.0 * PI * mode.frequency) - 1.0));
    }
    check_below("damping of 12 modes against tau w/2", worst, 1e-6);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* ---- A free decay in time ---------------------------------------------------------------------------------------- */

enum { SAMPLES = 40000 };

/* Amplitude of a damped oscillation e^((-d + i w) t) in samples with a Hann window. */
static double amplitude(const double *x, double h, double w)
{
    double re = 0.0, im = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
        const double t = i * h, window = 0.5 - 0.5 * cos(2.0 * PI * i / SAMPLES);
        re += window * x[i] * cos(w * t);
        im += window * x[i] * sin(w * t);
    }
    return hypot(re, im);
}

/* Frequency of the highest amplitude near a guess, by golden sections. */
static double peak(const double *x, double h, double guess)
{
    const double golden = 0.5 * (sqrt(5.0) - 1.0);
    double low = guess - PI / (SAMPLES * h), high = guess + PI / (SAMPLES * h);
    for (int i = 0; i < 40; i++) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        if (amplitude(x, h, a) > amplitude(x, h, b))
            high = b;
        else
            low = a;
    }
    return 0.5 * (low + high);
}

/* A clamped string of 12 m lets go of a load at its end; three modes ring, lightly damped. With spectral radius 1
 * generalized-alpha is the midpoint rule, which turns w into 2/h atan(w h/2): that is taken back. */
static void free_decay_rings_at_the_modes(void **state)
{
    (void)state;
    static double x[SAMPLES];
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def load = dmb_load_def_default();
    dmb_segment let_go = dmb_segment_default();
    dmb_sim_options options = dmb_sim_options_default();
    pipe.damping_time = 2e-5;
    pipe.string = lay_string(&s, &pipe, 8, DMB_FREE_NONE, DMB_FREE_ALL);
    options.spectral_radius = 1.0;
    options.newton_tolerance = 1e-13;
    options.energy_ledger = 0;
    let_go.kind = DMB_SEGMENT_STEP;
    let_go.h0 = 1.0;
    let_go.x1 = 1e-3;
    load.place = dmb_station(pipe.string, 7, 1.0);
    load.force[2] = 1.0;
    load.time_function = add_time_function(&s, &let_go, 1);
    (void)add_load(&s, &load);
    rig_start(&s, &options);
    (void)find_equilibrium(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 8);
    const double h = 1.0 / (60.0 * frequency_of_kind(modes, 2, 4));
    take_steps(&s, 2e-3, 1);
    for (int i = 0; i < SAMPLES; i++) {
        x[i] = pose_at(&s, load.place).displacement[2];
        take_steps(&s, h, 1);
    }
    for (uint32_t i = 0; i < 3; i++) {
        char what[80];
        const double w = 2.0 * PI * frequency_of_kind(modes, 2, 2 * i);
        (void)snprintf(what, sizeof what, "Fourier peak of a free decay at mode %u", i + 1);
        check_relative(what, 2.0 / h * tan(0.5 * h * peak(x, h, 2.0 / h * atan(0.5 * h * w))), w, 1e-5);
    }
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stress_proportional_damping),
        cmocka_unit_test(free_decay_rings_at_the_modes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
