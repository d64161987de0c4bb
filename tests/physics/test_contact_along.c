/* Contact along the element against closed forms (load at which a sagging pipe touches), against a finer mesh
 * (lift-off, modes), runs that settle in the static state, snapshots and state transfer. Equations: eq:contact.inside.
 */
#include <stdio.h>
#include <string.h>

#include "hash.h"
#include "modal.h"

/* ---- Sag --------------------------------------------------------------------------------------------------------- */

/* Sites that touch of a pipe between held ends, 9 m in three elements, under w [N/m]. */
static uint32_t touching_under(double w, double EI, double clearance, uint32_t points)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = beam_pipe(9.0, 3, 1e9, 1e12, 1e6, EI);
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    pipe.outer_diameter = 0.05;
    pipe.inner_diameter = 0.0;
    pipe.section_mass = w / 9.81;
    pipe.contact_points = points;
    wall.diameter = 0.05 + 2.0 * clearance;
    wall.friction_law = DMB_FRICTION_NONE;
    (void)add_wall(&s, &wall);
    string.start_free = DMB_FREE_NONE;
    string.end_free = DMB_FREE_X;
    (void)add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    const uint32_t closed = contacts_of(&s).closed;
    rig_close(&s);
    return closed;
}

/* Clamped at both ends the middle sags by w l^4/(384 EI); the cubic of the middle element, between exact nodes, misses
 * w h^4/(384 EI) of it. Nodes at the thirds sag by 64/81 of the whole. */
static void a_pipe_touches_in_its_middle(void **state)
{
    (void)state;
    const double EI = 2e4, c = 0.02, l = 9.0, h = 3.0, w = 384.0 * EI * c / (l * l * l * l - h * h * h * h);
    check_relative("load of the element over that of the beam", w, 384.0 * EI * c / (l * l * l * l), 0.0126);
    assert_int_equal(touching_under(w * (1.0 - 1e-4), EI, c, 3), 0);
    assert_int_equal(touching_under(w * (1.0 + 1e-4), EI, c, 3), 1);
    assert_int_equal(touching_under(w * (1.0 + 1e-4), EI, c, 0), 0); /* the nodes do not */
}

/* ---- Lift-off ---------------------------------------------------------------------------------------------------- */

static rig lying(uint32_t elements, uint32_t points, dmb_id *id)
{
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    wall.diameter = 0.1;
    wall.stiffness = 1e6;
    wall.friction_law = DMB_FRICTION_NONE;
    (void)add_wall(&s, &wall);
    string.start_free = DMB_FREE_NONE;
    *id = add_string(&s, &string);
    pipe.length = 20.0;
    pipe.elements = elements;
    pipe.outer_diameter = 0.05;
    pipe.inner_diameter = 0.03;
    pipe.contact_points = points;
    (void)add_pipes(&s, &pipe, 1);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    return s;
}

/* Moment at the clamp on the axis, from which the pipe comes down to the wall. */
static double moment_at_the_clamp(uint32_t elements, uint32_t points)
{
    dmb_section section = dmb_section_default();
    dmb_id string;
    rig s = lying(elements, points, &string);
    must(&s, dmb_query_section(s.sim, dmb_station(string, 0, 0.0), &section));
    rig_close(&s);
    return section.force[4];
}

/* The kink of the contact force at lift-off leaves a second order with both; along the element its factor is 20 times
 * smaller, and coarse meshes converge with the order of what is smooth. */
static void lift_off_converges(void **state)
{
    (void)state;
    const double want = moment_at_the_clamp(256, 5);
    for (uint32_t elements = 4; elements <= 32; elements *= 2) {
        char what[80];
        const double nodes = moment_at_the_clamp(elements, 0) / want - 1.0;
        const double along = moment_at_the_clamp(elements, 5) / want - 1.0;
        (void)snprintf(what, sizeof what, "%u elements, at nodes", elements);
        tell(what, nodes);
        check_below("    along the element", fabs(along), fmax(0.15 * fabs(nodes), 1e-4));
    }
    const double coarse = moment_at_the_clamp(4, 5) / want - 1.0, fine = moment_at_the_clamp(16, 5) / want - 1.0;
    tell("order from 4 to 16 elements", 0.5 * log2(fabs(coarse / fine)));
    assert_true(0.5 * log2(fabs(coarse / fine)) > 3.0);
}

static void profile_and_total_agree(void **state)
{
    (void)state;
    enum { STATIONS = 4000 };
    static double distance[STATIONS], value[STATIONS];
    static const int32_t quantity = DMB_PROFILE_NORMAL_FORCE;
    dmb_id id;
    rig s = lying(8, 4, &id);
    dmb_profile profile = dmb_profile_default();
    double sum = 0.0;
    for (int i = 0; i < STATIONS; i++) distance[i] = 20.0 * (i + 0.5) / STATIONS;
    profile.station_count = STATIONS;
    profile.distance = distance;
    profile.quantity_count = 1;
    profile.quantities = &quantity;
    profile.values = value;
    must(&s, dmb_query_profile(s.sim, &profile));
    for (int i = 0; i < STATIONS; i++) sum += value[i] * 20.0 / STATIONS;
    check_relative("integral of the contact force per metre", sum, contacts_of(&s).normal_force, 1e-3);
    rig_close(&s);
}

/* The wall closed by its stiffness, which is the same per metre. */
static void modes_with_the_wall_closed(void **state)
{
    (void)state;
    double frequency[2];
    for (int i = 0; i < 2; i++) {
        dmb_id id;
        rig s = lying(i == 0 ? 64 : 12, i == 0 ? 0 : 5, &id);
        dmb_modes_options options = dmb_modes_options_default();
        options.contact = DMB_CONTACT_CLOSED;
        options.contact_gap = 1.0;
        options.count = 6;
        dmb_modes *modes = find_modes(&s, &options);
        frequency[i] = frequency_of_kind(modes, 2, 0);
        dmb_modes_destroy(&modes);
        rig_close(&s);
    }
    check_relative("12 elements with points against 64 with nodes", frequency[1], frequency[0], 1e-2);
}

/* ---- Runs -------------------------------------------------------------------------------------------------------- */

static rig turning(int32_t friction_law, uint32_t pipes, double start)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    environment.lateral_damping = 400.0;
    environment.torsional_damping = environment.axial_damping = 100.0;
    must_model(&s, dmb_model_set_environment(s.model, &environment));
    wall.friction_law = friction_law;
    (void)add_wall(&s, &wall);
    string.start_depth = start;
    const dmb_id id = add_string(&s, &string);
    pipe.outer_diameter = 0.050; /* sags between its tool joints until it touches */
    pipe.inner_diameter = 0.040;
    pipe.length = 9.0;
    pipe.elements = 3;
    pipe.joint_length = 0.3;
    pipe.joint_outer_diameter = 0.065;
    pipe.contact_points = 3;
    (void)add_pipes(&s, &pipe, pipes);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, id, DMB_X, add_constant(&s, 0.0));
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, id, DMB_RX, add_constant(&s, 5.0));
    (void)rig_start(&s, NULL);
    return s;
}

static void a_run_settles_in_the_static_state(void **state)
{
    (void)state;
    rig still = turning(DMB_FRICTION_COULOMB, 3, 0.0), run = turning(DMB_FRICTION_COULOMB, 3, 0.0);
    (void)find_equilibrium(&still, NULL);
    for (int i = 0; i < 12000; i++) must(&run, dmb_sim_step(run.sim, 1e-3, NULL));
    const dmb_contact_total a = contacts_of(&still), b = contacts_of(&run);
    assert_int_equal(a.closed, b.closed);
    assert_true(a.closed > 3); /* not the tool joints alone */
    check_relative("normal force", b.normal_force, a.normal_force, 1e-6);
    check_relative("friction around", b.friction[1], a.friction[1], 1e-6);
    check_relative("friction is mu N", fabs(a.friction[1]), 0.3 * a.normal_force, 1e-4);
    check_below("energy not explained, share of the input", fabs(energy_of(&run).unexplained) / energy_of(&run).input,
                1e-6);
    check_below("energy balance", energy_of(&run).error, 2e-3);
    rig_close(&still);
    rig_close(&run);
}

static void snapshots_go_on_bit_for_bit(void **state)
{
    (void)state;
    static unsigned char block[1 << 20];
    rig a = turning(DMB_FRICTION_BRISTLE, 3, 0.0), b = turning(DMB_FRICTION_BRISTLE, 3, 0.0);
    size_t size;
    for (int i = 0; i < 150; i++) must(&a, dmb_sim_step(a.sim, 1e-3, NULL));
    must(&a, dmb_sim_snapshot_size(a.sim, &size));
    assert_true(size <= sizeof block);
    must(&a, dmb_sim_snapshot(a.sim, block, size));
    must(&b, dmb_sim_restore(b.sim, block, size));
    for (int i = 0; i < 150; i++) must(&a, dmb_sim_step(a.sim, 1e-3, NULL));
    for (int i = 0; i < 150; i++) must(&b, dmb_sim_step(b.sim, 1e-3, NULL));
    assert_true(rig_hash(&a) == rig_hash(&b));
    rig_close(&a);
    rig_close(&b);
}

/* A pipe more at the rig end: points keep contact and bristles. */
static void a_pipe_is_added(void **state)
{
    (void)state;
    rig from = turning(DMB_FRICTION_BRISTLE, 3, 9.0), to = turning(DMB_FRICTION_BRISTLE, 4, 0.0);
    dmb_contact a = dmb_contact_default(), b = dmb_contact_default();
    for (int i = 0; i < 300; i++) must(&from, dmb_sim_step(from.sim, 1e-3, NULL));
    must(&to, dmb_sim_transfer_state(to.sim, from.sim));
    dmb_model_info old = dmb_model_info_default(), now = dmb_model_info_default();
    must_model(&from, dmb_model_get_info(from.model, &old));
    must_model(&to, dmb_model_get_info(to.model, &now));
    for (uint32_t k = 1; k <= 3; k++) { /* the last sites are those inside elements */
        must(&from, dmb_query_contact(from.sim, old.contact_points - k, &a));
        must(&to, dmb_query_contact(to.sim, now.contact_points - k, &b));
        assert_int_equal(b.pipe, a.pipe + 1);
        check_close("normal force", b.normal_force, a.normal_force, 1e-8 * (1.0 + a.normal_force));
        check_close("friction around", b.friction[1], a.friction[1], 1e-8 * (1.0 + a.normal_force));
    }
    for (int i = 0; i < 50; i++) must(&to, dmb_sim_step(to.sim, 1e-3, NULL));
    rig_close(&from);
    rig_close(&to);
}

/* A pipe that falls into its hole; with a section of the same wall no point waits for the end of a step. */
static rig falling(int with_section, dmb_id *id)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    wall.friction_law = DMB_FRICTION_BRISTLE;
    (void)add_wall(&s, &wall);
    if (with_section) {
        dmb_hole_section same = dmb_hole_section_default();
        same.depth = -1.0;
        must_model(&s, dmb_model_add_hole_sections(s.model, &same, 1));
    }
    string.start_free = DMB_FREE_RX;
    pipe.string = *id = add_string(&s, &string);
    pipe.length = 9.0;
    pipe.elements = 3;
    pipe.contact_points = 5;
    pipe.joint_length = 0.3;
    pipe.joint_outer_diameter = 0.088;
    (void)add_pipes(&s, &pipe, 2);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, *id, DMB_RX, add_constant(&s, 8.0));
    (void)rig_start(&s, NULL);
    return s;
}

static void open_points_may_wait(void **state)
{
    (void)state;
    dmb_id id[2];
    rig s[2] = {falling(0, &id[0]), falling(1, &id[1])};
    dmb_model_info info = dmb_model_info_default();
    double worst = 0.0, gap = 0.0, least = 0.0;
    uint32_t closed = 0;
    must_model(&s[0], dmb_model_get_info(s[0].model, &info));
    for (int i = 0; i < 120; i++) {
        for (int k = 0; k < 2; k++) {
            const int32_t status = dmb_sim_step(s[k].sim, 1e-3, NULL);
            if (status < 0) must(&s[k], status);
        }
        const double z = pose_at(&s[0], dmb_station(id[0], 1, 0.6)).position[2];
        worst = fmax(worst, fabs(z - pose_at(&s[1], dmb_station(id[1], 1, 0.6)).position[2]));
        for (uint32_t k = 0; k < info.contact_points; k++) {
            dmb_contact a = dmb_contact_default(), b = dmb_contact_default();
            must(&s[0], dmb_query_contact(s[0].sim, k, &a));
            must(&s[1], dmb_query_contact(s[1].sim, k, &b));
            gap = fmax(gap, fabs(a.gap - b.gap));
            least = fmax(least, a.gap);
        }
        closed += contacts_of(&s[0]).closed;
    }
    assert_true(closed > 20 && least > 5e-3);
    check_below("place of a pipe that falls [m]", worst, 1e-9);
    check_below("gaps of its points [m]", gap, 1e-9);
    for (int k = 0; k < 2; k++) rig_close(&s[k]);
}

static void bad_numbers_are_refused(void **state)
{
    (void)state;
    static const uint32_t bad[] = {1, 2, 6, UINT32_MAX};
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        dmb_pipe_def pipe = s1_pipe();
        pipe.contact_points = bad[i];
        assert_int_equal(dmb_model_add_pipes(s.model, &pipe, 1, NULL), DMB_ERR_VALUE);
        assert_non_null(strstr(dmb_model_message(s.model), "contact_points"));
    }
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pipe_touches_in_its_middle),
        cmocka_unit_test(lift_off_converges),
        cmocka_unit_test(profile_and_total_agree),
        cmocka_unit_test(modes_with_the_wall_closed),
        cmocka_unit_test(a_run_settles_in_the_static_state),
        cmocka_unit_test(snapshots_go_on_bit_for_bit),
        cmocka_unit_test(a_pipe_is_added),
        cmocka_unit_test(open_points_may_wait),
        cmocka_unit_test(bad_numbers_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
