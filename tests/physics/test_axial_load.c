/* Pipes under axial load with few elements: stiffness against the closed form of a Timoshenko beam, frequencies against
 * those of a tensioned beam, section forces against equilibrium; and strings that are pulled and twisted hard stay at
 * rest. The element counts how bending inside it shortens it (lib/element/beam_math.h). Checks
 * eq:beam.pulled-stiffness. */
#include <stdio.h>
#include <string.h>

#include "modal.h"

/* OD 50, ID 39 mm. */
static dmb_pipe_def slim_pipe(double length, uint32_t elements)
{
    dmb_pipe_def pipe = s1_pipe();
    pipe.outer_diameter = 0.050;
    pipe.inner_diameter = 0.039;
    pipe.length = length;
    pipe.elements = elements;
    return pipe;
}

/* Its stiffnesses; kappa 0.5, nu 0.3. */
typedef struct stiffness {
    double EA, GA, EI, mass;
} stiffness;

static stiffness slim_values(void)
{
    const double E = 210e9, A = PI / 4.0 * (0.050 * 0.050 - 0.039 * 0.039);
    const double I = PI / 64.0 * (pow(0.050, 4.0) - pow(0.039, 4.0));
    const stiffness v = {E * A, 0.5 * E / 2.6 * A, E * I, 7850.0 * A};
    return v;
}

/* ---- Cantilever -------------------------------------------------------------------------------------------------- */

/* A beam of 3 m, clamped, under the dead axial force N and the side force V at its tip, without shear and stretch,
 * which the closed form leaves out: EI t'' = N t - V, w(L) = V/N (L - tanh(k L)/k), k^2 = N/EI. */
static double flexibility(double N, double EI, double L)
{
    const double k = sqrt(fabs(N) / EI);
    return (L - (N > 0.0 ? tanh(k * L) : tan(k * L)) / k) / N;
}

/* Relative error of the lateral stiffness. */
static double stiffness_error(double N, uint32_t elements)
{
    rig s;
    dmb_load_def load = dmb_load_def_default();
    dmb_static_options options = dmb_static_options_default();
    const double EI = slim_values().EI;
    const dmb_pipe_def pipe = beam_pipe(3.0, elements, 1e6 * EI, 1e6 * EI, EI, EI);
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id string = add_beam(&s, &pipe, DMB_FREE_NONE);
    load.place = dmb_station(string, 0, 1.0);
    load.force[0] = N;
    load.force[1] = 1.0;
    (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    options.tolerance = 1e-13;
    (void)find_equilibrium(&s, &options);
    const double error = flexibility(N, EI, 3.0) / pose_at(&s, load.place).displacement[1] - 1.0;
    rig_close(&s);
    return error;
}

/* Closed form by 40 digits (eq:beam.axial-shear); without the coupling the first is 0.12, 3.1 (negative) and 0.13. */
static void lateral_stiffness_of_a_cantilever(void **state)
{
    (void)state;
    const double N[3] = {30e3, 120e3, -8e3};
    const double want[3][4] = {
        {9.8e-3, 9.5e-4, 6.7e-5, 4.0e-6}, {3.0e-2, 4.4e-3, 4.0e-4, 2.7e-5}, {1.3e-2, 9.3e-4, 6.0e-5, 3.8e-6}};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++) {
            char what[80];
            (void)snprintf(what, sizeof what, "%g kN, %d elements: lateral stiffness", 1e-3 * N[i], 1 << k);
            check_below(what, stiffness_error(N[i], 1u << k), 1.1 * want[i][k]);
        }
}

/* ---- Strings in a hole ------------------------------------------------------------------------------------------- */

typedef struct pulled {
    double pull, torque; /* [N, N m] at the far end */
    int jointed;         /* every pipe a string of its own, fixed joints between them; 2: described side by side */
} pulled;

static dmb_id add_jointed(rig *s, dmb_string_def def, dmb_pipe_def pipe, uint32_t count, int side_by_side)
{
    dmb_id before = {0, 0};
    for (uint32_t k = 0; k < count; k++) {
        if (k > 0) def.start_free = DMB_FREE_ALL;
        if (side_by_side)
            def.offset[0] = 3.0 * k;
        else
            def.start_depth = 3.0 * k;
        pipe.string = add_string(s, &def);
        const dmb_id string = add_pipes(s, &pipe, 1);
        if (k > 0)
            (void)add_joint_between(s, DMB_JOINT_FIXED, dmb_station(before, 0, 1.0), dmb_station(string, 0, 0.0));
        before = string;
    }
    return before;
}

/* Kinetic energy a second after the load has come on 20 pipes of 3 m at rest on the low side of a hole of 75 mm. */
static double unrest(const pulled *p)
{
    rig s;
    dmb_wall_def wall = s1_hole();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = slim_pipe(3.0, 1);
    dmb_load_def load = dmb_load_def_default();
    rig_open(&s, 0.0, 0.0, -9.81);
    wall.diameter = 0.075;
    (void)add_wall(&s, &wall);
    dmb_id last;
    def.start_free = DMB_FREE_NONE;
    def.offset[1] = -0.0125;
    if (p->jointed) {
        last = add_jointed(&s, def, pipe, 20, p->jointed == 2);
    } else {
        pipe.string = add_string(&s, &def);
        last = add_pipes(&s, &pipe, 20);
    }
    load.place = dmb_station(last, p->jointed ? 0 : 19, 1.0);
    load.force[0] = p->pull;
    load.moment[0] = p->torque;
    (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    const dmb_static_report report = find_equilibrium(&s, NULL);
    assert_int_equal(report.negative, 0);
    take_steps(&s, 1e-3, 1000);
    const double kinetic = energy_of(&s).kinetic;
    rig_close(&s);
    return kinetic;
}

static void pulled_strings_stay_at_rest(void **state)
{
    (void)state;
    const pulled scene[] = {{60e3, 0.0, 0},   {60e3, 0.0, 1},  {100e3, 0.0, 0},  {180e3, 0.0, 0}, {180e3, 0.0, 1},
                            {60e3, 500.0, 0}, {100e3, 1e3, 0}, {180e3, -1e3, 1}, {60e3, 0.0, 2},  {180e3, -1e3, 2}};
    for (size_t i = 0; i < sizeof scene / sizeof *scene; i++) {
        char what[96];
        (void)snprintf(what, sizeof what, "%g kN, %g N m%s: kinetic energy after 1 s [J]", 1e-3 * scene[i].pull,
                       scene[i].torque, scene[i].jointed ? ", joints" : "");
        check_below(what, unrest(&scene[i]), 1e-4);
    }
}

/* ---- Frequencies ------------------------------------------------------------------------------------------------- */

/* Half of a pinned beam of 2 L under tension N, without shear and rotary inertia: w^2 = q^2 (N + EI q^2)/m with q = n
 * pi/(2 L), n = 1, 3, 5 in the half. */
static double frequency_error(double N, uint32_t elements, uint32_t pair)
{
    const double L = 6.0, EI = 5e4, m = 6.0, q = (2.0 * pair + 1.0) * PI / (2.0 * L);
    rig s;
    dmb_load_def load = dmb_load_def_default();
    dmb_pipe_def pipe = beam_pipe(L, elements, 1e11, 1e11, EI, EI);
    pipe.section_mass = m;
    pipe.section_inertia[0] = 1e-2;
    pipe.section_inertia[1] = 1e-8;
    const dmb_id string = lay_string(&s, &pipe, 1, DMB_FREE_SPHERICAL, DMB_FREE_TRANSLATIONS);
    load.place = dmb_station(string, 0, 1.0);
    load.force[0] = N;
    (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 2 * pair + 4);
    const double got = frequency_of_kind(modes, 2, 2 * pair);
    dmb_modes_destroy(&modes);
    rig_close(&s);
    return got / (q * sqrt((N + EI * q * q) / m) / (2.0 * PI)) - 1.0;
}

static void frequencies_under_tension(void **state)
{
    (void)state;
    const double N[3] = {-2e3, 2e4, 1.5e5}, most[2][2] = {{5e-5, 1e-5}, {1.5e-3, 1.2e-4}};
    for (int i = 0; i < 3; i++)
        for (uint32_t pair = 0; pair < 2; pair++) {
            char what[80];
            const double coarse = frequency_error(N[i], 4, pair), fine = frequency_error(N[i], 8, pair);
            (void)snprintf(what, sizeof what, "%g kN, mode %u, 4 elements", 1e-3 * N[i], 2 * pair + 1);
            check_below(what, coarse, most[pair][0]);
            check_below("    8 elements", fine, most[pair][1]);
        }
}

/* ---- Section forces ---------------------------------------------------------------------------------------------- */

/* The section force against the loads beyond the section, at the places of the bent and pulled beam. */
static void section_forces_are_in_equilibrium(void **state)
{
    (void)state;
    const double F[3] = {120e3, 300.0, -200.0};
    rig s;
    dmb_load_def load = dmb_load_def_default();
    dmb_static_options options = dmb_static_options_default();
    const dmb_pipe_def pipe = slim_pipe(3.0, 2);
    double worst[3] = {0.0, 0.0, 0.0};
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id string = add_beam(&s, &pipe, DMB_FREE_NONE);
    load.place = dmb_station(string, 0, 1.0);
    memcpy(load.force, F, sizeof F);
    (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    options.tolerance = 1e-13;
    (void)find_equilibrium(&s, &options);
    const dmb_pose tip = pose_at(&s, load.place);
    for (int i = 0; i <= 20; i++) {
        const dmb_place place = dmb_station(string, 0, i / 20.0);
        const dmb_pose at = pose_at(&s, place);
        dmb_section section = dmb_section_default();
        double arm[3], m[3];
        must(&s, dmb_query_section(s.sim, place, &section));
        for (int k = 0; k < 3; k++) arm[k] = tip.position[k] - at.position[k];
        for (int k = 0; k < 3; k++) m[k] = arm[(k + 1) % 3] * F[(k + 2) % 3] - arm[(k + 2) % 3] * F[(k + 1) % 3];
        for (int k = 0; k < 3; k++) {
            double force = 0.0, moment = 0.0;
            for (int j = 0; j < 3; j++) {
                force += at.rotation[3 * j + k] * F[j];
                moment += at.rotation[3 * j + k] * m[j];
            }
            const int node = i % 10 == 0;
            worst[node ? 0 : 1] = fmax(worst[node ? 0 : 1], fabs(section.force[k] - force));
            worst[node ? 0 : 2] = fmax(worst[node ? 0 : 2], fabs(section.force[3 + k] - moment));
        }
        const double stretch = section.strain[0] * slim_values().EA;
        if (i % 10 == 5) check_relative("axial strain against its force", stretch, section.force[0], 1e-4);
    }
    check_below("at nodes [N, N m]", worst[0], 1e-6);
    check_below("between them: forces [N]", worst[1], 0.2);
    check_below("between them: moments [N m]", worst[2], 0.06);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lateral_stiffness_of_a_cantilever),
        cmocka_unit_test(pulled_strings_stay_at_rest),
        cmocka_unit_test(frequencies_under_tension),
        cmocka_unit_test(section_forces_are_in_equilibrium),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
