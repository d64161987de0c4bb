/* Linear dynamics: axial waves in S1, decay by material damping, energy over a million steps. Checks eq:bar.force. */
#include <stdio.h>

#include "rig.h"

/* ---- Axial wave -------------------------------------------------------------------------------------------------- */

#define WAVE 5172.194       /* [m/s] c of S1 */
#define IMPEDANCE 73471.134 /* [N s/m] Z of S1 */
/* Steps over the time a wave takes through an element. Waves of the elements lead by (k L)^4/480, those of the scheme
 * with r 0.8 lag by 1.05 (w h)^2/12. */
#define PACE 0.69
#define FINE_PACE 0.2

/* 100 m of S1 in `elements` elements, on its own axis, without gravity. */
static dmb_id open_bar(rig *s, int32_t kind, uint32_t elements, int32_t start_free, double speed, double push)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig_open(s, 0.0, 0.0, 0.0);
    pipe.kind = kind;
    pipe.length = 100.0;
    pipe.elements = elements;
    def.start_free = start_free;
    def.velocity[0] = speed;
    pipe.string = add_string(s, &def);
    const dmb_id string = add_pipes(s, &pipe, 1);
    if (push != 0.0) {
        dmb_load_def load = dmb_load_def_default();
        load.place = dmb_station(string, 0, 0.0);
        load.force[0] = push;
        (void)add_load(s, &load);
    }
    options.spectral_radius = 0.8;
    (void)rig_start(s, &options);
    return string;
}

/* The bar strikes a rigid wall with its rig end at 1 m/s: Z v for 2 L/c, then it lets go. 1000 elements. Plateau: mean
 * and spread between 5 and 95 % of it; front: where half is crossed. */
static void bar_strikes_a_wall(void **state)
{
    (void)state;
    const int32_t kinds[2] = {DMB_PIPE_AXIAL_TORSIONAL, DMB_PIPE_FLEXIBLE};
    for (int k = 0; k < 3; k++) {
        rig s;
        const uint32_t elements = 1000;
        const dmb_id string = open_bar(&s, kinds[k / 2], elements, DMB_FREE_NONE, -1.0, 0.0);
        const double pace = k == 1 ? FINE_PACE : PACE, h = pace * 100.0 / elements / WAVE, end = 200.0 / WAVE;
        double reaction[6], mean = 0.0, spread = 0.0, front = 0.0, before = IMPEDANCE;
        uint32_t count = 0;
        for (int i = 1; i * h < 1.05 * end; i++) {
            take_steps(&s, h, 1);
            must(&s, dmb_query_reaction(s.sim, string, reaction));
            const double t = i * h, half = 0.5 * IMPEDANCE;
            if (t > 0.05 * end && t < 0.95 * end) {
                mean += reaction[0];
                count++;
                spread = fmax(spread, fabs(reaction[0] / IMPEDANCE - 1.0));
            }
            if (front == 0.0 && before >= half && reaction[0] < half && t > 0.5 * end)
                front = t - h * (half - reaction[0]) / (before - reaction[0]);
            before = reaction[0];
        }
        tell("kind of pipes", kinds[k / 2]);
        tell("    step over the time through an element", pace);
        check_relative("    plateau, mean", mean / count, IMPEDANCE, 1e-3);
        check_below("    plateau, largest deviation", spread, 1e-2);
        check_relative("    end of the plateau", front, 0.0386683087, 1e-3);
        rig_close(&s);
    }
}

/* When the speed before one step and after it, t and t - h, passed `level`. */
static void note_passing(double *passing, double level, double t, double h, double before, double after)
{
    if (*passing == 0.0 && before < level && after >= level) *passing = t - h * (after - level) / (after - before);
}

typedef struct front {
    double near, far;   /* [m/s] means of the loaded and of the far end, between echoes */
    double third, half; /* [s] when the far end has a third and a half of its speed */
} front;

static front run_step(double pace)
{
    rig s;
    front f = {0.0, 0.0, 0.0, 0.0};
    const uint32_t elements = 1000;
    const dmb_id string = open_bar(&s, DMB_PIPE_AXIAL_TORSIONAL, elements, DMB_FREE_CYLINDRICAL, 0.0, 1000.0);
    const double h = pace * 100.0 / elements / WAVE, pass = 100.0 / WAVE, full = 2000.0 / IMPEDANCE;
    double before = 0.0;
    uint32_t near_count = 0, far_count = 0;
    for (int i = 1; i * h < 2.9 * pass; i++) {
        take_steps(&s, h, 1);
        const double t = i * h, v = motion_at(&s, dmb_station(string, 0, 0.0), DMB_FRAME_WORLD).velocity[0];
        const double w = motion_at(&s, dmb_station(string, 0, 1.0), DMB_FRAME_WORLD).velocity[0];
        if (t > 0.1 * pass && t < 1.9 * pass) f.near += v, near_count++;
        if (t > 1.1 * pass && t < 2.9 * pass) f.far += w, far_count++;
        note_passing(&f.third, full / 3.0, t, h, before, w);
        note_passing(&f.half, full / 2.0, t, h, before, w);
        before = w;
    }
    f.near /= near_count;
    f.far /= far_count;
    rig_close(&s);
    return f;
}

/* A step of 1 kN on the free end of a free bar: F/Z there until the echo, and twice that at the far end. Waves that lag
 * by b k^2 make of its front the integral of Airy's function over x/(3 b c t)^(1/3): a third where the sharp one is,
 * whatever b, and a half later by the root of the step. */
static void step_on_a_free_end(void **state)
{
    (void)state;
    const double paces[2] = {PACE, FINE_PACE}, pass = 100.0 / WAVE;
    for (int i = 0; i < 2; i++) {
        const front f = run_step(paces[i]);
        tell("step over the time through an element", paces[i]);
        check_relative("    speed of the loaded end", f.near, 1.361079e-2, 1e-3);
        check_relative("    speed of the far end", f.far, 2.0 * 1.361079e-2, 1e-3);
        check_relative("    arrival there, a third of the front", f.third, pass, 1e-4);
        tell("    arrival there, half the front: off by", f.half / pass - 1.0);
        if (i == 1) check_relative("    arrival there, half the front", f.half, pass, 1e-3);
    }
}

/* ---- Material damping -------------------------------------------------------------------------------------------- */

/* One element held at one end: m u'' + tau k u' + k u = 0 with k = EA/L, m = 5/12 rho A L; from u' = v the closed form
 * u = v/wd exp(-tau w^2 t/2) sin(wd t). */
static double decay_error(int32_t kind, double h, double *end)
{
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    const double w2 = 2.4 * pipe.young_modulus / (pipe.density * pipe.length * pipe.length), tau = 2e-5;
    const double a = 0.5 * tau * w2, wd = sqrt(w2 - a * a), v = 1e-3;
    double worst = 0.0;
    rig_open(&s, 0.0, 0.0, 0.0);
    pipe.kind = kind;
    pipe.damping_time = tau;
    def.start_free = DMB_FREE_NONE;
    def.velocity[0] = v;
    pipe.string = add_string(&s, &def);
    const dmb_id string = add_pipes(&s, &pipe, 1);
    options.spectral_radius = 1.0;
    options.newton_tolerance = 1e-12;
    (void)rig_start(&s, &options);
    const double period = 2.0 * PI / wd;
    for (int i = 1; i * h < 10.0 * period; i++) {
        take_steps(&s, h, 1);
        const double t = i * h, u = pose_at(&s, dmb_station(string, 0, 1.0)).displacement[0];
        worst = fmax(worst, fabs(u - v / wd * exp(-a * t) * sin(wd * t)) * wd / v);
    }
    *end = exp(-a * 10.0 * period);
    rig_close(&s);
    return worst;
}

static void axial_mode_decays(void **state)
{
    (void)state;
    const int32_t kinds[2] = {DMB_PIPE_AXIAL_TORSIONAL, DMB_PIPE_FLEXIBLE};
    for (int k = 0; k < 2; k++) {
        double end;
        const double coarse = decay_error(kinds[k], 2e-6, &end), fine = decay_error(kinds[k], 1e-6, &end);
        tell("kind of pipes", kinds[k]);
        tell("    amplitude left after 10 periods", end);
        check_below("    off the closed form, 1e-6 s", fine, 1e-4);
        check_order("    order", coarse, fine, 2.0, 0.02);
    }
}

/* ---- Hard case 12 ------------------------------------------------------------------------------------------------ */

static double energy_drift(const rig *s, double h, uint32_t steps)
{
    const dmb_energy first = energy_of(s);
    double worst = 0.0;
    for (uint32_t i = 0; i < steps / 1000; i++) {
        take_steps(s, h, 1000);
        const dmb_energy e = energy_of(s);
        worst = fmax(worst, fabs((e.kinetic + e.strain) / (first.kinetic + first.strain) - 1.0));
    }
    return worst;
}

/* Bar of three elements, held at one end, ringing in all its modes: r = 1, 1e6 steps, no damping. */
static void bar_keeps_its_energy(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.elements = 3;
    def.start_free = DMB_FREE_NONE;
    def.velocity[0] = 1.0;
    def.velocity[3] = 2.0;
    pipe.string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, 1);
    options.spectral_radius = 1.0;
    options.newton_tolerance = 1e-14;
    (void)rig_start(&s, &options);
    check_below("bar, 1e6 steps: energy", energy_drift(&s, 5e-5, 1000000), 1e-9);
    rig_close(&s);
}

/* A cantilever of one element swinging by 4e-6 of its length: as good as linear. With steps of 1e-3 s, which do not
 * resolve its second mode and the stretch that follows bending, it would be 5e-8. */
static void beam_keeps_its_energy(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    def.start_free = DMB_FREE_NONE;
    def.velocity[2] = 1e-3;
    pipe.string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, 1);
    options.spectral_radius = 1.0;
    options.newton_tolerance = 1e-14;
    (void)rig_start(&s, &options);
    check_below("beam, 1e6 steps: energy", energy_drift(&s, 2e-4, 1000000), 1e-9);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bar_strikes_a_wall),    cmocka_unit_test(step_on_a_free_end),
        cmocka_unit_test(axial_mode_decays),     cmocka_unit_test(bar_keeps_its_energy),
        cmocka_unit_test(beam_keeps_its_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
