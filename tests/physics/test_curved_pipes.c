/* Pipes that are bent: free fall, the right-angle cantilever of Simo and Vu-Quoc 1988, energy of a tumbling one;
 * statics against the closed form of an arc and frequencies against a fine mesh, with their orders. The last two print
 * the table of the element's accuracy. Checks eq:curved.flexibility and eq:curved.kinetic-energy. */
#include <stdio.h>

#include "modal.h"

/* ---- Falling ----------------------------------------------------------------------------------------------------- */

/* One pipe of 1 m, its ends turned by the angle against each other, after 0.1 s of free fall. */
static void falls_with_g(double bend, uint32_t elements)
{
    rig s;
    char what[80];
    double z[2], worst = 0.0;
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    pipe.length = 1.0;
    pipe.elements = elements;
    pipe.curvature[1] = bend;
    rig_open(&s, 0.0, 0.0, -9.81);
    def.start_free = def.end_free = DMB_FREE_ALL;
    pipe.string = add_string(&s, &def);
    const dmb_id string = add_pipes(&s, &pipe, 1);
    (void)rig_start(&s, NULL);
    for (int k = 0; k < 2; k++) z[k] = pose_at(&s, dmb_station(string, 0, k)).position[2];
    take_steps(&s, 1e-3, 100);
    const double fall = 0.5 * 9.81 * 0.01, speed = 9.81 * 0.1;
    for (int k = 0; k < 2; k++)
        worst = fmax(worst, fabs((z[k] - pose_at(&s, dmb_station(string, 0, k)).position[2]) / fall - 1.0));
    const dmb_momentum m = momentum_of(&s);
    const dmb_energy e = energy_of(&s);
    worst = fmax(worst, fabs(-m.linear[2] / (m.mass * speed) - 1.0));
    worst = fmax(worst, fabs(e.kinetic / (0.5 * m.mass * speed * speed) - 1.0));
    worst = fmax(worst, fabs(e.gravity / e.kinetic + 1.0));
    (void)snprintf(what, sizeof what, "bend %g rad in %u elements: fall, momentum, energies", bend, elements);
    check_below(what, worst, 1e-9);
    rig_close(&s);
}

static void free_fall(void **state)
{
    (void)state;
    for (uint32_t elements = 1; elements <= 4; elements *= 2)
        for (int k = 0; k < 4; k++) falls_with_g((double[4]){0.02, 0.3, 1.0, 2.0}[k], elements);
}

/* ---- Right-angle cantilever -------------------------------------------------------------------------------------- */

/* Two legs of 10, EA = GA = 1e6, EI = GJ = 1e3, rho A = 1, rho I = 10, about the axis 20; the force at the elbow across
 * the plane goes to 50 in 1 s and back. Displacement of the tip after 10 s. */
static double tip_of_cantilever(uint32_t elements, double step)
{
    rig s;
    dmb_pipe_def leg = beam_pipe(10.0, elements, 1e6, 1e6, 1e3, 1e3);
    dmb_string_def def = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    static const double time[4] = {0.0, 1.0, 2.0, 1e3}, force[4] = {0.0, 50.0, 0.0, 0.0};
    dmb_segment term = dmb_segment_default();
    leg.section_mass = 1.0;
    leg.section_inertia[0] = 20.0;
    leg.section_inertia[1] = 10.0;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id near_leg = add_beam(&s, &leg, DMB_FREE_NONE);
    def.position[0] = 10.0;
    def.rotation[2] = 0.5 * PI;
    def.start_free = def.end_free = DMB_FREE_ALL;
    leg.string = add_string(&s, &def);
    const dmb_id far_leg = add_pipes(&s, &leg, 1);
    dmb_joint_def elbow = joint_between(DMB_JOINT_FIXED, dmb_station(near_leg, 0, 1.0), dmb_station(far_leg, 0, 0.0));
    elbow.match = 1;
    (void)add_joint(&s, &elbow);
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = time;
    term.table_value = force;
    term.table_count = 4;
    load.place = dmb_station(near_leg, 0, 1.0);
    load.force[2] = 1.0;
    load.time_function = add_time_function(&s, &term, 1);
    (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    take_steps(&s, step, (uint32_t)lround(10.0 / step));
    const double tip = pose_at(&s, dmb_station(far_leg, 0, 1.0)).displacement[2];
    rig_close(&s);
    return tip;
}

static void right_angle_cantilever(void **state)
{
    (void)state;
    check_close("tip after 10 s, 5 elements a leg, steps of 50 ms", tip_of_cantilever(5, 0.05), 4.464, 1e-2);
    check_close("10 elements, 25 ms", tip_of_cantilever(10, 0.025), 4.464, 1e-3);
}

/* ---- Energy ------------------------------------------------------------------------------------------------------ */

static double whole_energy(const rig *s)
{
    const dmb_energy e = energy_of(s);
    return e.kinetic + e.strain + e.gravity;
}

/* Three pipes bent by 0.8 rad each in one element, tumbling and swinging: the most that their energy changes by in 0.2
 * s, of the kinetic energy at the start. */
static double energy_error(double step)
{
    rig s;
    dmb_pipe_def pipe = beam_pipe(1.0, 1, 1e5, 5e4, 40.0, 60.0);
    dmb_string_def def = dmb_string_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    pipe.curvature[1] = 0.6;
    pipe.curvature[2] = 0.5;
    rig_open(&s, 0.0, 0.0, -9.81);
    def.start_free = def.end_free = DMB_FREE_ALL;
    for (int i = 0; i < 6; i++) def.velocity[i] = 1.0 + i;
    pipe.string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, 3);
    options.spectral_radius = 1.0;
    (void)rig_start(&s, &options);
    const double kinetic = energy_of(&s).kinetic, before = whole_energy(&s);
    double worst = 0.0;
    for (double t = 0.0; t < 0.2; t += step) {
        take_steps(&s, step, 1);
        worst = fmax(worst, fabs(whole_energy(&s) - before));
    }
    rig_close(&s);
    return worst / kinetic;
}

static void energy_of_a_tumbling_one(void **state)
{
    (void)state;
    const double coarse = energy_error(2e-4), fine = energy_error(1e-4);
    check_order("energy of tumbling bent pipes", coarse, fine, 2.0, 0.2);
    check_below("in steps of 0.1 ms", fine, 1e-5);
}

/* ---- Statics and frequencies of an arc --------------------------------------------------------------------------- */

enum { ARC_MESHES = 4 };
static const double arc_length = 2.0, arc_section[4] = {4e8, 1e8, 770.0, 1000.0}; /* EA, GA, GJ, EI */

static dmb_id open_arc(rig *s, double bend, uint32_t elements)
{
    const double *K = arc_section;
    dmb_pipe_def pipe = beam_pipe(arc_length, elements, K[0], K[1], K[2], K[3]);
    pipe.curvature[1] = bend / arc_length;
    rig_open(s, 0.0, 0.0, 0.0);
    return add_beam(s, &pipe, DMB_FREE_NONE);
}

/* Deflection of the tip by a force there, in the plane along the radius or across it, by both signs of the force. */
static double deflection(double bend, uint32_t elements, int across)
{
    double moved[2];
    for (int side = 0; side < 2; side++) {
        rig s;
        dmb_load_def load = dmb_load_def_default();
        const dmb_id string = open_arc(&s, bend, elements);
        const double force = side ? 1e-2 : -1e-2, unit[3] = {sin(bend), 0.0, cos(bend)};
        load.place = dmb_station(string, 0, 1.0);
        for (int i = 0; i < 3; i++) load.force[i] = force * (across ? (i == 1 ? 1.0 : 0.0) : unit[i]);
        (void)add_load(&s, &load);
        (void)rig_start(&s, NULL);
        (void)find_equilibrium(&s, NULL);
        const dmb_pose tip = pose_at(&s, load.place);
        moved[side] = across ? tip.displacement[1] : tip.displacement[0] * unit[0] + tip.displacement[2] * unit[2];
        rig_close(&s);
    }
    return (moved[1] - moved[0]) / 2e-2;
}

/* Clamped arc of radius R and angle a: moments R sin, R (1 - cos) of the angle from the tip; forces sin, cos. */
static double arc_deflection(double bend, int across)
{
    const double R = arc_length / bend, *K = arc_section, sines = 0.5 * bend - 0.25 * sin(2.0 * bend);
    if (!across) return R * R * R / K[3] * sines + R / K[0] * sines + R / K[1] * (bend - sines);
    const double turns = 1.5 * bend - 2.0 * sin(bend) + 0.25 * sin(2.0 * bend);
    return R * R * R * (sines / K[3] + turns / K[2]) + R * bend / K[1];
}

static double frequency_of(double bend, uint32_t elements, uint32_t number)
{
    rig s;
    (void)open_arc(&s, bend, elements);
    (void)rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 4);
    const double f = frequency_at(modes, number);
    dmb_modes_destroy(&modes);
    rig_close(&s);
    return f;
}

/* A line of the table: errors with 2, 4, 8, 16 elements, the order from 4 to 8. */
static void tell_line(const char *what, double bend, const double error[ARC_MESHES])
{
    printf("    | %s, bend %.1f rad | %.1e | %.1e | %.1e | %.1e | %.1f |\n", what, bend, error[0], error[1], error[2],
           error[3], log2(error[1] / error[2]));
}

static void statics_are_of_fourth_order(void **state)
{
    static const char *const names[2] = {"deflection in the plane", "deflection across the plane"};
    (void)state;
    printf("    | clamped arc | 2 elements | 4 | 8 | 16 | order |\n");
    for (int across = 0; across < 2; across++)
        for (double bend = 0.5; bend < 2.5; bend *= 2.0) {
            double error[ARC_MESHES];
            for (int k = 0; k < ARC_MESHES; k++)
                error[k] = fabs(deflection(bend, 2u << k, across) / arc_deflection(bend, across) - 1.0);
            tell_line(names[across], bend, error);
            assert_true(error[1] / error[2] > 13.0 || error[2] < 1e-7);
        }
}

static void frequencies_are_of_fourth_order(void **state)
{
    (void)state;
    for (uint32_t number = 0; number < 4; number++) {
        double error[ARC_MESHES];
        char what[40];
        const double bend = 2.0, right = frequency_of(bend, 96, number);
        for (int k = 0; k < ARC_MESHES; k++) error[k] = fabs(frequency_of(bend, 2u << k, number) / right - 1.0);
        (void)snprintf(what, sizeof what, "frequency %u", number + 1);
        tell_line(what, bend, error);
        assert_true(error[1] / error[2] > 11.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_fall),
        cmocka_unit_test(right_angle_cantilever),
        cmocka_unit_test(energy_of_a_tumbling_one),
        cmocka_unit_test(statics_are_of_fourth_order),
        cmocka_unit_test(frequencies_are_of_fourth_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
