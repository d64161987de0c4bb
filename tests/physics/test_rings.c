/* Rings on strings against closed forms: continuous beam on several supports (three moments), frequencies of a beam
 * with a point mass, weight in mud; against the same ring an arm's length beside a node; runs that settle, go on from
 * snapshots and in other models; and what is refused. */
#include <stdio.h>
#include <string.h>

#include "hash.h"
#include "modal.h"

static dmb_id add_stabiliser(rig *s, const dmb_stabiliser_def *def)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_stabiliser(s->model, def, &id));
    return id;
}

static dmb_stabiliser_def ring_at(double fraction)
{
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    ring.fraction = fraction;
    return ring;
}

static dmb_contact contact_of_part(const rig *s, dmb_id part)
{
    dmb_contact contact = dmb_contact_default();
    for (uint32_t i = 0; dmb_query_contact(s->sim, i, &contact) >= 0; i++)
        if (contact.part.index == part.index && contact.part.generation == part.generation) return contact;
    fail_msg("the part has no contact point");
    return contact;
}

/* Euler and Bernoulli. */
static dmb_pipe_def heavy_beam(double length, uint32_t elements, double mass, double EI)
{
    dmb_pipe_def pipe = beam_pipe(length, elements, 1e9, 1e12, 1e6, EI);
    pipe.outer_diameter = 0.05;
    pipe.inner_diameter = 0.0;
    pipe.section_mass = mass;
    pipe.section_inertia[0] = 1.0;
    pipe.section_inertia[1] = 1e-10;
    return pipe;
}

/* ---- Continuous beam --------------------------------------------------------------------------------------------- */

/* A pipe of 10 m on a pin and on three rings 2.5 m apart, the last span hanging over:
 *     M_(i-1) + 4 M_i + M_(i+1) = -w l^2/2,   M_0 = 0, M_3 = -w l^2/2     (Clapeyron)
 *     R_i = w l + (M_(i-1) - 2 M_i + M_(i+1))/l + weight of the ring */
static void reactions_of_a_continuous_beam(void **state)
{
    (void)state;
    const double g = 9.81, mass = 10.0, w = mass * g, l = 2.5, W = 3.0 * g;
    const double M3 = -0.5 * w * l * l, right = -0.5 * w * l * l;
    const double M1 = (4.0 * right - (right - M3)) / 15.0, M2 = (4.0 * (right - M3) - right) / 15.0;
    const double want[3] = {w * l + (M2 - 2.0 * M1) / l + W, w * l + (M1 - 2.0 * M2 + M3) / l + W,
                            1.5 * w * l + (M2 - M3) / l + W};
    for (uint32_t elements = 1; elements <= 3; elements += 2) {
        dmb_string_def string = dmb_string_def_default();
        dmb_wall_def wall = s1_hole();
        const dmb_pipe_def pipe = heavy_beam(10.0, elements, mass, 2e5);
        dmb_id ring[3];
        rig s;
        rig_open(&s, 0.0, 0.0, -g);
        wall.diameter = 0.1;
        wall.stiffness = 1e13;
        wall.friction_law = DMB_FRICTION_NONE;
        (void)add_wall(&s, &wall);
        string.start_free = DMB_FREE_SPHERICAL;
        string.offset[1] = -0.5 * (0.1 - 0.09);
        (void)add_string(&s, &string);
        (void)add_pipes(&s, &pipe, 1);
        for (uint32_t i = 0; i < 3; i++) {
            dmb_stabiliser_def def = ring_at(0.25 * (i + 1));
            def.mass = 3.0;
            ring[i] = add_stabiliser(&s, &def);
        }
        (void)rig_start(&s, NULL);
        (void)find_equilibrium(&s, NULL);
        for (uint32_t i = 0; i < 3; i++) {
            char what[80];
            (void)snprintf(what, sizeof what, "reaction of ring %u, %u elements", i + 1, elements);
            check_relative(what, contact_of_part(&s, ring[i]).normal_force, want[i], 1e-5);
        }
        assert_int_equal(contacts_of(&s).closed, 3);
        check_relative("sum of the wall's forces", contacts_of(&s).normal_force, want[0] + want[1] + want[2], 1e-5);
        rig_close(&s);
    }
}

/* ---- Mass -------------------------------------------------------------------------------------------------------- */

/* Pinned beam with a point mass m at a = x L: 1 = m z/(2 mu L) [sin zx sin z(1-x)/sin z - sinh zx sinh z(1-x)/sinh z],
 * w = z^2 sqrt(EI/(mu L^4)): the receptance of the beam at the mass. */
static double mass_equation(double z, double x, double ratio)
{
    const double a = sin(z * x) * sin(z * (1.0 - x)) / sin(z), b = sinh(z * x) * sinh(z * (1.0 - x)) / sinh(z);
    return 0.5 * ratio * z * (a - b) - 1.0;
}

static double lowest_root(double x, double ratio)
{
    double low = 0.1, high = PI - 1e-9;
    for (int i = 0; i < 200; i++) {
        const double middle = 0.5 * (low + high);
        if (mass_equation(middle, x, ratio) > 0.0)
            high = middle;
        else
            low = middle;
    }
    return low;
}

static double frequency_with(double fraction, uint32_t elements, double mass)
{
    dmb_pipe_def pipe = heavy_beam(1.0, elements, 2.0, 100.0);
    dmb_stabiliser_def ring = ring_at(fraction);
    rig s;
    pipe.outer_diameter = 0.004; /* no node is near enough to carry the ring on an arm */
    (void)lay_string(&s, &pipe, 1, DMB_FREE_SPHERICAL, DMB_FREE_SPHERICAL);
    ring.mass = mass;
    ring.length = 1e-3;
    ring.inertia[0] = ring.inertia[1] = 1e-12;
    (void)add_stabiliser(&s, &ring);
    (void)rig_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 6);
    const double frequency = frequency_of_kind(modes, 2, 0);
    dmb_modes_destroy(&modes);
    rig_close(&s);
    return frequency;
}

static void frequency_of_a_beam_with_a_point_mass(void **state)
{
    (void)state;
    const double x = 0.37, z = lowest_root(x, 2.0), want = z * z * sqrt(100.0 / 2.0) / (2.0 * PI);
    check_relative("4 elements", frequency_with(x, 4, 4.0), want, 1e-4);
    check_relative("16 elements", frequency_with(x, 16, 4.0), want, 1e-6);
    check_order("its order", frequency_with(x, 8, 4.0) - want, frequency_with(x, 16, 4.0) - want, 4.0, 0.3);
}

/* A vertical pipe hangs from its head, pipe and ring of other densities in mud. */
static void weight_in_mud(void **state)
{
    (void)state;
    const double g = 9.81, mud = 1200.0;
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_stabiliser_def ring = ring_at(0.3);
    dmb_section section = dmb_section_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    environment.fluid_density = mud;
    must_model(&s, dmb_model_set_environment(s.model, &environment));
    string.follows_hole = 0;
    string.rotation[1] = 0.5 * PI;
    string.start_free = DMB_FREE_NONE;
    const dmb_id id = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 3);
    ring.pipe = 1;
    ring.density = 2700.0;
    ring.mass = 8.0;
    (void)add_stabiliser(&s, &ring);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    const s1_section S = s1_values();
    const double want = 4.5 * S.weight * (1.0 - mud / 7850.0) + 8.0 * g * (1.0 - mud / 2700.0);
    must(&s, dmb_query_section(s.sim, dmb_station(id, 0, 0.0), &section));
    check_relative("pull at the head", section.force[0], want, 1e-10);
    must(&s, dmb_query_section(s.sim, dmb_station(id, 1, 0.3 + 1e-6), &section));
    check_relative("pull below the ring", section.force[0], (1.5 * 1.7 + 1e-6) * S.weight * (1.0 - mud / 7850.0), 1e-5);
    check_relative("mass of the scene", momentum_of(&s).mass, 4.5 * S.mass + 8.0, 1e-12);
    rig_close(&s);
}

/* J w^2/2 of a hollow cylinder on a string that turns. */
static void energy_of_a_turning_ring(void **state)
{
    (void)state;
    dmb_string_def string = dmb_string_def_default();
    const dmb_pipe_def pipe = s1_pipe();
    dmb_stabiliser_def def = ring_at(0.4);
    double energy;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.velocity[3] = 20.0;
    (void)add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    const dmb_id ring = add_stabiliser(&s, &def);
    (void)rig_start(&s, NULL);
    const double m = 7850.0 * 0.25 * PI * (0.09 * 0.09 - 0.073 * 0.073) * 0.3;
    must(&s, dmb_query_kinetic_energy(s.sim, ring, 0, &energy));
    check_relative("kinetic energy", energy, 0.5 * m * (0.09 * 0.09 + 0.073 * 0.073) / 8.0 * 400.0, 1e-12);
    check_relative("its place", pose_at(&s, dmb_station(ring, 0, 0.0)).position[0], 0.4 * 1.5, 1e-12);
    rig_close(&s);
}

/* ---- Beside a node ----------------------------------------------------------------------------------------------- */

/* A pressed ring `beside` the middle of a pipe. */
typedef struct pressed {
    double force, frequency;
} pressed;

static pressed press_beside(double beside, uint32_t elements)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_stabiliser_def ring = ring_at(0.5 + beside / 9.0);
    dmb_string_def string = dmb_string_def_default();
    pressed out;
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    (void)add_wall(&s, &wall);
    string.start_free = DMB_FREE_SPHERICAL;
    string.end_free = DMB_FREE_ALL;
    (void)add_string(&s, &string);
    pipe.length = 9.0;
    pipe.elements = elements;
    (void)add_pipes(&s, &pipe, 1);
    ring.mass = 10.0;
    const dmb_id id = add_stabiliser(&s, &ring);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    out.force = contact_of_part(&s, id).normal_force;
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 4);
    out.frequency = frequency_at(modes, 3);
    dmb_modes_destroy(&modes);
    rig_close(&s);
    return out;
}

static void a_ring_beside_a_node_is_one_at_the_node(void **state)
{
    (void)state;
    const double reach = 0.25 * 0.073;
    const pressed at = press_beside(0.0, 2), near = press_beside(1e-7, 2);
    check_relative("force a tenth of a micrometre beside", near.force, at.force, 1e-6);
    check_relative("frequency likewise", near.frequency, at.frequency, 1e-6);
    for (int k = 0; k < 3; k++) { /* beyond the node; on both sides of it by a finer mesh */
        const double side = k == 1 ? -1.0 : 1.0;
        const uint32_t elements = k == 0 ? 2 : 16;
        const pressed arm = press_beside(side * (reach - 1e-6), elements);
        const pressed own = press_beside(side * (reach + 1e-6), elements);
        check_relative("force by an arm and by a node of its own", arm.force, own.force, 3e-5);
        check_relative("frequency likewise", arm.frequency, own.frequency, 3e-4);
    }
}

/* ---- Runs -------------------------------------------------------------------------------------------------------- */

typedef struct turning {
    rig r;
    dmb_id string, ring[2];
} turning;

/* A string with two rings lies in its hole and turns, with bristles. */
static turning turning_string(int32_t friction_law, uint32_t pipes, double start, double spin)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_stabiliser_def ring = ring_at(0.3);
    turning s;
    memset(&s, 0, sizeof s);
    rig_open(&s.r, 0.0, 0.0, -9.81);
    environment.lateral_damping = 200.0;
    environment.torsional_damping = environment.axial_damping = 100.0;
    must_model(&s.r, dmb_model_set_environment(s.r.model, &environment));
    wall.friction_law = friction_law;
    (void)add_wall(&s.r, &wall);
    string.start_depth = start;
    s.string = add_string(&s.r, &string);
    pipe.length = 3.0;
    (void)add_pipes(&s.r, &pipe, pipes);
    for (uint32_t i = 0; i < 2; i++) {
        ring.pipe = pipes - 3 + i;
        ring.fraction = i == 0 ? 0.3 : 0.8;
        s.ring[i] = add_stabiliser(&s.r, &ring);
    }
    (void)add_simple_drive(&s.r, DMB_DRIVE_MOTION, s.string, DMB_X, add_constant(&s.r, 0.0));
    (void)add_simple_drive(&s.r, DMB_DRIVE_MOTION, s.string, DMB_RX, add_constant(&s.r, spin));
    (void)rig_start(&s.r, NULL);
    return s;
}

static void a_run_settles_in_the_static_state(void **state)
{
    (void)state;
    turning s = turning_string(DMB_FRICTION_COULOMB, 4, 0.0, 5.0);
    turning run = turning_string(DMB_FRICTION_COULOMB, 4, 0.0, 5.0);
    (void)find_equilibrium(&s.r, NULL);
    for (int i = 0; i < 4000; i++) must(&run.r, dmb_sim_step(run.r.sim, 1e-3, NULL));
    for (int i = 0; i < 2; i++) {
        const dmb_contact a = contact_of_part(&s.r, s.ring[i]), b = contact_of_part(&run.r, run.ring[i]);
        check_relative("normal force after 4 s", b.normal_force, a.normal_force, 1e-6);
        check_relative("friction around it", b.friction[1], a.friction[1], 1e-5);
        check_relative("friction is mu N", fabs(a.friction[1]), 0.3 * a.normal_force, 1e-4);
    }
    const dmb_energy e = energy_of(&run.r);
    check_below("energy not explained, share of the input", fabs(e.unexplained) / e.input, 1e-6);
    check_below("energy balance", fabs(e.error), 2e-3);
    rig_close(&s.r);
    rig_close(&run.r);
}

static void snapshots_go_on_bit_for_bit(void **state)
{
    (void)state;
    static unsigned char block[1 << 20];
    turning a = turning_string(DMB_FRICTION_BRISTLE, 4, 0.0, 2.0),
            b = turning_string(DMB_FRICTION_BRISTLE, 4, 0.0, 2.0);
    size_t size;
    take_steps(&a.r, 1e-3, 150);
    must(&a.r, dmb_sim_snapshot_size(a.r.sim, &size));
    assert_true(size <= sizeof block);
    must(&a.r, dmb_sim_snapshot(a.r.sim, block, size));
    must(&b.r, dmb_sim_restore(b.r.sim, block, size));
    take_steps(&a.r, 1e-3, 150);
    take_steps(&b.r, 1e-3, 150);
    assert_true(rig_hash(&a.r) == rig_hash(&b.r));
    rig_close(&a.r);
    rig_close(&b.r);
}

/* A pipe more at the rig end: rings keep their contact, their bristles and their memory. */
static void a_pipe_is_added(void **state)
{
    (void)state;
    turning from = turning_string(DMB_FRICTION_BRISTLE, 4, 3.0, 0.0),
            to = turning_string(DMB_FRICTION_BRISTLE, 5, 0.0, 0.0);
    take_steps(&from.r, 1e-3, 300);
    must(&to.r, dmb_sim_transfer_state(to.r.sim, from.r.sim));
    for (int i = 0; i < 2; i++) {
        const dmb_contact a = contact_of_part(&from.r, from.ring[i]), b = contact_of_part(&to.r, to.ring[i]);
        check_relative("normal force of a ring", b.normal_force, a.normal_force, 1e-9);
        check_close("its friction", b.friction[1], a.friction[1], 1e-9 * a.normal_force);
    }
    take_steps(&to.r, 1e-3, 100);
    rig_close(&from.r);
    rig_close(&to.r);
}

static void other_rings_are_refused(void **state)
{
    (void)state;
    turning from = turning_string(DMB_FRICTION_COULOMB, 4, 0.0, 0.0);
    rig to;
    dmb_pipe_def pipe = s1_pipe();
    dmb_wall_def wall = s1_hole();
    rig_open(&to, 0.0, 0.0, -9.81);
    wall.friction_law = DMB_FRICTION_COULOMB;
    (void)add_wall(&to, &wall);
    pipe.length = 3.0;
    const dmb_id string = add_pipes(&to, &pipe, 4);
    (void)add_simple_drive(&to, DMB_DRIVE_MOTION, string, DMB_X, add_constant(&to, 0.0));
    (void)add_simple_drive(&to, DMB_DRIVE_MOTION, string, DMB_RX, add_constant(&to, 0.0));
    (void)rig_start(&to, NULL);
    assert_int_equal(dmb_sim_transfer_state(to.sim, from.r.sim), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(to.sim), "rings"));
    rig_close(&from.r);
    rig_close(&to);
}

/* ---- Axial-torsional pipes --------------------------------------------------------------------------------------- */

/* Torque to turn them on the low side: mu N r, node by node; that of the ring by its own radius. */
static void axial_torsional_pipes_rub_at_the_ring(void **state)
{
    (void)state;
    const double g = 9.81;
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_stabiliser_def ring = ring_at(0.5);
    dmb_static_options options = dmb_static_options_default();
    dmb_section section = dmb_section_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    wall.friction_law = DMB_FRICTION_COULOMB;
    (void)add_wall(&s, &wall);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    const dmb_id string = add_pipes(&s, &pipe, 1);
    ring.mass = 20.0;
    (void)add_stabiliser(&s, &ring);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, string, DMB_X, add_constant(&s, 0.0));
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, add_constant(&s, 0.0));
    (void)rig_start(&s, NULL);
    options.slip_rotation = 1e6;
    options.steady = DMB_STEADY_AT_REST;
    (void)find_equilibrium(&s, &options);
    must(&s, dmb_query_section(s.sim, dmb_station(string, 0, 0.0), &section));
    const double w = s1_values().weight, at_ring = 0.3 * 0.045 * (0.75 * w + 20.0 * g),
                 at_end = 0.3 * 0.0365 * 0.375 * w;
    check_relative("torque in the pipe", fabs(section.force[3]), at_ring + at_end, 1e-9);
    rig_close(&s);
}

/* ---- Questions --------------------------------------------------------------------------------------------------- */

static double profile_at(const rig *s, dmb_id string, int32_t quantity, double distance)
{
    dmb_profile profile = dmb_profile_default();
    double value = 0.0;
    profile.string = string;
    profile.station_count = 1;
    profile.distance = &distance;
    profile.quantity_count = 1;
    profile.quantities = &quantity;
    profile.values = &value;
    profile.station_stride = profile.quantity_stride = 1;
    must(s, dmb_query_profile(s->sim, &profile));
    return value;
}

static void questions_along_a_string_with_rings(void **state)
{
    (void)state;
    turning s = turning_string(DMB_FRICTION_COULOMB, 4, 0.0, 5.0);
    (void)find_equilibrium(&s.r, NULL);
    const dmb_contact contact = contact_of_part(&s.r, s.ring[0]);
    const double at = 3.0 + 0.3 * 3.0;
    check_relative("contact per metre in the ring", profile_at(&s.r, s.string, DMB_PROFILE_NORMAL_FORCE, at + 0.14),
                   contact.normal_force / 0.3, 1e-12);
    check_below("beside it the pipe is free", profile_at(&s.r, s.string, DMB_PROFILE_NORMAL_FORCE, at + 0.16), 0.0);
    for (int i = 0; i < 4; i++) { /* places on both sides of the divided element meet */
        const double fraction = 0.3 + (i - 1.5) * 1e-9;
        const dmb_pose pose = pose_at(&s.r, dmb_station(s.string, 1, fraction));
        check_close("place along the hole", pose.position[0], 3.0 + 3.0 * fraction, 1e-6);
    }
    check_close("ring and pipe at one place", pose_at(&s.r, dmb_station(s.ring[0], 0, 0.0)).position[2],
                pose_at(&s.r, dmb_station(s.string, 1, 0.3)).position[2], 1e-12);
    rig_close(&s.r);
}

/* ---- What is refused --------------------------------------------------------------------------------------------- */

static void open_refused(rig *s)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(s, 0.0, 0.0, -9.81);
    (void)add_wall(s, &wall);
    pipe.joint_length = 0.2;
    pipe.joint_outer_diameter = 0.085;
    (void)add_pipes(s, &pipe, 3);
}

static void check_compile(rig *s, int32_t status, const char *text)
{
    assert_int_equal(dmb_model_compile(s->model, NULL), status);
    if (strstr(dmb_model_message(s->model), text) == NULL) fail_msg("message: %s", dmb_model_message(s->model));
    rig_close(s);
}

static void bad_rings_are_refused(void **state)
{
    (void)state;
    rig s;
    dmb_stabiliser_def ring = ring_at(0.5), other;
    open_refused(&s);
    ring.pipe = 3;
    (void)add_stabiliser(&s, &ring);
    check_compile(&s, DMB_ERR_VALUE, "stabiliser 0: pipe = 3, must be < 3");
    open_refused(&s);
    ring.pipe = 1, ring.outer_diameter = 0.072;
    (void)add_stabiliser(&s, &ring);
    check_compile(&s, DMB_ERR_GEOMETRY, "stabiliser 0: outer_diameter = 0.072 m, must be >= 0.073 m");
    open_refused(&s);
    ring.outer_diameter = 0.08, ring.fraction = 0.95;
    (void)add_stabiliser(&s, &ring);
    check_compile(&s, DMB_ERR_GEOMETRY, "tool joint");
    open_refused(&s);
    ring.outer_diameter = 0.0941;
    (void)add_stabiliser(&s, &ring);
    check_compile(&s, DMB_ERR_GEOMETRY, "stabiliser 0: outer_diameter");
    open_refused(&s);
    ring = other = ring_at(0.5);
    (void)snprintf(other.name, sizeof other.name, "second");
    (void)add_stabiliser(&s, &ring);
    (void)add_stabiliser(&s, &other);
    check_compile(&s, DMB_ERR_GEOMETRY, "must be >= 0.3 m, half of both lengths");
    open_refused(&s);
    ring.fraction = 0.99, other.fraction = 0.01, other.pipe = 1;
    (void)add_stabiliser(&s, &other);
    (void)add_stabiliser(&s, &ring);
    check_compile(&s, DMB_ERR_GEOMETRY, "second");
    open_refused(&s);
    ring.fraction = 1.01;
    assert_int_equal(dmb_model_add_stabiliser(s.model, &ring, NULL), DMB_ERR_VALUE);
    ring.fraction = (double)NAN;
    assert_int_equal(dmb_model_add_stabiliser(s.model, &ring, NULL), DMB_ERR_NOT_FINITE);
    ring.fraction = 0.5, ring.inertia[0] = 1.0, ring.inertia[1] = 0.1;
    assert_int_equal(dmb_model_add_stabiliser(s.model, &ring, NULL), DMB_ERR_VALUE);
    rig_close(&s);
}

static void the_soft_string_refuses_rings(void **state)
{
    (void)state;
    turning s = turning_string(DMB_FRICTION_COULOMB, 4, 0.0, 0.0);
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    dmb_operation operation = dmb_operation_default();
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    assert_int_equal(dmb_analysis_torque_drag(s.r.sim, &options, &operation, 1, &row), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(s.r.sim), "rings"));
    rig_close(&s.r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reactions_of_a_continuous_beam),
        cmocka_unit_test(frequency_of_a_beam_with_a_point_mass),
        cmocka_unit_test(weight_in_mud),
        cmocka_unit_test(energy_of_a_turning_ring),
        cmocka_unit_test(a_ring_beside_a_node_is_one_at_the_node),
        cmocka_unit_test(a_run_settles_in_the_static_state),
        cmocka_unit_test(snapshots_go_on_bit_for_bit),
        cmocka_unit_test(a_pipe_is_added),
        cmocka_unit_test(other_rings_are_refused),
        cmocka_unit_test(axial_torsional_pipes_rub_at_the_ring),
        cmocka_unit_test(questions_along_a_string_with_rings),
        cmocka_unit_test(bad_rings_are_refused),
        cmocka_unit_test(the_soft_string_refuses_rings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
