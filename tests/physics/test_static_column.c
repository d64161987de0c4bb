/* Buckling of a column under a dead axial force, as a cantilever that is half of a pinned column of 10 m: Euler's load
 * by the softening below it, and the elastica beyond it. */
#include <stdio.h>

#include "rig.h"

/* The far end is clamped; the rig end is free, carries the axial force and can be pushed sideways by a load drive. */
typedef struct column {
    rig s;
    dmb_id string, drive;
} column;

static void open_column(column *c, uint32_t elements, double EI, double stiff, double push)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def beam = beam_pipe(5.0, elements, stiff, stiff, EI, EI);
    dmb_load_def load = dmb_load_def_default();
    rig_open(&c->s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    def.end_free = DMB_FREE_NONE;
    beam.string = add_string(&c->s, &def);
    c->string = add_pipes(&c->s, &beam, 1);
    load.place = dmb_station(c->string, 0, 0.0);
    load.force[0] = push;
    (void)add_load(&c->s, &load);
    c->drive = add_simple_drive(&c->s, DMB_DRIVE_LOAD, c->string, DMB_Y, add_constant(&c->s, 0.0));
    (void)rig_start(&c->s, NULL);
}

static dmb_static_report settle(const column *c, double sideways)
{
    dmb_static_options options = dmb_static_options_default();
    options.lay_on_wall = 0;
    options.tolerance = 1e-12;
    must(&c->s, dmb_sim_set_drive(c->s.sim, c->drive, sideways));
    return find_equilibrium(&c->s, &options);
}

/* ---- Euler's load ------------------------------------------------------------------------------------------------ */

/* S1, 10 m pinned: 19582.398515 N. A small side force F moves the loaded end by F (tan(k l)/k - l)/P, k^2 = P/EI, l = 5
 * m, which grows without bound at Euler's load: at 99.9 % of it the amplification tells the load to 1e-5 only if it is
 * right to 1e-5 as well. Without shear and stretch, which Euler's formula leaves out. */
static void softening_below_eulers_load(void **state)
{
    (void)state;
    const double EI = s1_values().EI, euler = PI * PI * EI / 100.0, part[3] = {0.5, 0.9, 0.999};
    check_relative("closed form of Euler's load", euler, 19582.398515, 1e-9);
    for (int i = 0; i < 3; i++) {
        column c;
        const double P = part[i] * euler, k = sqrt(P / EI), want = (tan(5.0 * k) / k - 5.0) / P;
        open_column(&c, 16, EI, 1e6 * EI, P);
        (void)settle(&c, 1e-6);
        const double got = pose_at(&c.s, dmb_station(c.string, 0, 0.0)).displacement[1] / 1e-6;
        /* the amplification near the load goes with 1/(1 - P/Pcr) */
        const double load_error = fabs(got / want - 1.0) * (1.0 - part[i]);
        tell("part of Euler's load", part[i]);
        check_below("    load told by the softening, relative", load_error, 1e-5);
        rig_close(&c.s);
    }
}

/* ---- Beyond ------------------------------------------------------------------------------------------------------ */

/* Elastica with an end slope of 60 degrees: P/Pcr 1.1517196205, v_mid/L .2966038231, shortening .2589803939 (CASES.md).
 * The column is pushed aside, then the side force taken away. */
static void elastica_beyond_it(void **state)
{
    (void)state;
    const double EI = s1_values().EI, euler = PI * PI * EI / 100.0;
    double error[2];
    for (int k = 0; k < 2; k++) {
        column c;
        open_column(&c, k ? 32 : 16, EI, 1e7 * EI, 1.1517196205 * euler);
        const dmb_static_report aside_first = settle(&c, 2000.0);
        print_message("    pushed aside: %u load steps, %u cuts\n", aside_first.load_steps, aside_first.cuts);
        (void)settle(&c, 0.0);
        const dmb_pose end = pose_at(&c.s, dmb_station(c.string, 0, 0.0));
        const double slope = fabs(atan2(end.rotation[3], end.rotation[0])) * 180.0 / PI;
        const double aside = fabs(end.displacement[1]) / 10.0, shorter = end.displacement[0] / 5.0;
        print_message("    %d elements: slope %.6f deg, v %.8f, shortening %.8f\n", k ? 32 : 16, slope, aside, shorter);
        error[k] = fmax(fabs(aside - 0.2966038231), fabs(shorter - 0.2589803939));
        check_close("    end slope [deg]", slope, 60.0, k ? 1e-3 : 1e-2);
        rig_close(&c.s);
    }
    check_below("16 elements: deflection and shortening over L", error[0], 1e-5);
    check_below("32 elements", error[1], 1e-6);
}

/* The straight column is in equilibrium under any load; above Euler's it is not stable: two directions to buckle to,
 * and two more from the second load of a pinned column of 10 m that this half of it has, nine times Euler's. */
static void straight_column_tells_that_it_is_unstable(void **state)
{
    (void)state;
    const double EI = s1_values().EI, euler = PI * PI * EI / 100.0, part[3] = {0.999, 1.001, 9.01};
    const int32_t want[3] = {0, 2, 4};
    for (int i = 0; i < 3; i++) {
        column c;
        open_column(&c, 16, EI, 1e6 * EI, part[i] * euler);
        const dmb_static_report report = settle(&c, 0.0);
        print_message("    %.3f of Euler's load: %d negative eigenvalues\n", part[i], report.negative);
        assert_int_equal(report.negative, want[i]);
        rig_close(&c.s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(softening_below_eulers_load),
        cmocka_unit_test(elastica_beyond_it),
        cmocka_unit_test(straight_column_tells_that_it_is_unstable),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
