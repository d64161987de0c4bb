/* Sums over a scene: kinetic energy pipe by pipe and as a whole, momentum and centre of mass, the energy ledger. */
#include <string.h>

#include "close.h"
#include "rig.h"

/* A free string with head, bit and pipes of given kinds, all eccentric, with tool joints but on the last one. */
typedef struct craft {
    rig s;
    dmb_id string, head, bit;
    uint32_t pipes;
} craft;

static craft launch(const int32_t *kinds, uint32_t count, double eccentricity)
{
    craft c = {.pipes = count};
    dmb_string_def def = dmb_string_def_default();
    dmb_body_def head = dmb_body_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    rig_open(&c.s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    for (int i = 0; i < 3; i++) def.rotation[i] = 0.5 - 0.2 * i, def.position[i] = 1.0 + i;
    for (int i = 0; i < 6; i++) def.velocity[i] = 1.5 - 0.7 * i;
    c.string = add_string(&c.s, &def);
    for (uint32_t i = 0; i < count; i++) {
        dmb_pipe_def pipe = s1_pipe();
        pipe.kind = kinds[i];
        pipe.elements = 1 + i % 2;
        pipe.joint_length = i + 1 < count ? 0.2 : 0.0;
        pipe.joint_outer_diameter = 0.09;
        pipe.eccentricity = eccentricity;
        pipe.eccentricity_angle = 0.7 * i;
        add_pipes(&c.s, &pipe, 1);
    }
    head.attach = DMB_ATTACH_START;
    head.mass = 30.0;
    head.centre[0] = -0.2, head.centre[1] = 0.05;
    head.inertia[0] = 0.3, head.inertia[1] = head.inertia[2] = 0.6, head.inertia[3] = 0.1;
    c.head = add_body(&c.s, &head);
    bit.mass = 9.0;
    must_model(&c.s, dmb_model_add_bit(c.s.model, &bit, &c.bit));
    rig_start(&c.s, NULL);
    return c;
}

static double kinetic(const craft *c, dmb_id part, uint32_t pipe)
{
    double energy = (double)NAN;
    must(&c->s, dmb_query_kinetic_energy(c->s.sim, part, pipe, &energy));
    return energy;
}

/* Every part once: pipes hold half of head and bit, so the other halves are added. */
static void pipes_add_up(void **state)
{
    (void)state;
    enum { F = DMB_PIPE_FLEXIBLE, R = DMB_PIPE_RIGID };
    const int32_t kinds[][5] = {{F, F, F, F, F}, {R, R, R, R, R}, {F, R, R, F, F}, {R, F, R, F, R}, {F, F, R, R, R}};
    for (int k = 0; k < 5; k++)
        for (int e = 0; e < 2; e++) {
            craft c = launch(kinds[k], 5, e * 2e-3);
            for (int run = 0; run < 2; run++) {
                double sum = 0.5 * (kinetic(&c, c.head, 0) + kinetic(&c, c.bit, 0));
                for (uint32_t i = 0; i < c.pipes; i++) sum += kinetic(&c, c.string, i);
                const double whole = energy_of(&c.s).kinetic;
                CHECK_CLOSE(sum, whole, 1e-12 * whole);
                take_steps(&c.s, 1e-4, 20);
            }
            rig_close(&c.s);
        }
}

/* A head turning alone: m v^2/2 + w J w/2 with its own inertia. */
static void kinetic_energy_of_a_body(void **state)
{
    (void)state;
    dmb_body_def def = dmb_body_def_default();
    rig s;
    double energy;
    rig_open(&s, 0.0, 0.0, 0.0);
    def.mass = 2.0;
    def.centre[1] = 0.5;
    def.inertia[0] = 0.3, def.inertia[1] = 0.4, def.inertia[2] = 0.5;
    def.velocity[0] = 3.0, def.velocity[5] = 4.0;
    const dmb_id body = add_body(&s, &def);
    rig_start(&s, NULL);
    must(&s, dmb_query_kinetic_energy(s.sim, body, 0, &energy));
    CHECK_CLOSE(energy, 0.5 * 2.0 * (3.0 - 4.0 * 0.5) * (3.0 - 4.0 * 0.5) + 0.5 * 0.5 * 16.0, 1e-14);
    rig_close(&s);
}

/* In free flight the centre of mass goes straight on, and linear and angular momentum stay. */
static void momentum_in_flight(void **state)
{
    (void)state;
    const int32_t kinds[5] = {DMB_PIPE_FLEXIBLE, DMB_PIPE_RIGID, DMB_PIPE_FLEXIBLE, DMB_PIPE_FLEXIBLE,
                              DMB_PIPE_FLEXIBLE};
    craft c = launch(kinds, 5, 2e-3);
    dmb_model_info info = dmb_model_info_default();
    const dmb_momentum start = momentum_of(&c.s);
    must(&c.s, dmb_model_get_info(c.s.model, &info));
    CHECK_CLOSE(start.mass, info.mass, 1e-12 * info.mass);
    take_steps(&c.s, 1e-4, 200);
    const dmb_momentum end = momentum_of(&c.s);
    for (int k = 0; k < 3; k++) {
        CHECK_CLOSE(end.linear[k], start.linear[k], 1e-6 * info.mass);
        CHECK_CLOSE(end.angular[k], start.angular[k], 1e-5 * info.mass);
        CHECK_CLOSE(end.centre[k] - start.centre[k], 0.02 * start.linear[k] / info.mass, 1e-6);
    }
    rig_close(&c.s);
}

/* One straight pipe turning about a point away from it: m v_c and x_c x m v_c + J w, with the section's own inertia. */
static void momentum_of_a_pipe(void **state)
{
    (void)state;
    const s1_section v = s1_values();
    const double L = 1.5, m = v.mass * L, w = 3.0, across = 7850.0 * v.I * L + m * L * L / 12.0;
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_RIGID; kind += 2) {
        dmb_string_def def = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        def.follows_hole = 0;
        def.start_free = DMB_FREE_ALL;
        def.position[1] = 5.0;
        def.velocity[1] = 2.0, def.velocity[3] = 7.0, def.velocity[5] = w;
        add_string(&s, &def);
        pipe.kind = kind;
        add_pipes(&s, &pipe, 1);
        rig_start(&s, NULL);
        const dmb_momentum p = momentum_of(&s);
        const double speed = 2.0 + w * 0.5 * L;
        const double want[6] = {
            0.0, m * speed, 0.0, 2.0 * 7850.0 * v.I * L * 7.0, 0.0, across * w + 0.5 * L * m * speed};
        CHECK_CLOSE(p.mass, m, 1e-13 * m);
        CHECK_CLOSE(p.centre[0], 0.5 * L, 1e-13);
        CHECK_CLOSE(p.centre[1], 5.0, 1e-13);
        for (int k = 0; k < 3; k++) CHECK_CLOSE(p.linear[k], want[k], 1e-11);
        for (int k = 0; k < 3; k++) CHECK_CLOSE(p.angular[k], want[3 + k], 1e-11);
        rig_close(&s);
    }
}

/* A damped string that rattles on a wall, driven and loaded: steps that resolve the bounces, of which `error` falls
 * with the step; what the iterations left is small. */
static dmb_energy ledger_of_a_run(double h)
{
    const dmb_segment ramp = {.struct_size = sizeof ramp, .kind = DMB_SEGMENT_STEP, .x0 = 0.0, .x1 = 0.05, .h1 = 2.0};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    environment.lateral_damping = 5.0;
    must_model(&s, dmb_model_set_environment(s.model, &environment));
    wall.stiffness = 1e6;
    add_wall(&s, &wall);
    pipe.damping_time = 1e-4;
    const dmb_id string = add_pipes(&s, &pipe, 3);
    drive.time_function = add_time_function(&s, &ramp, 1);
    drive.component = DMB_RX;
    add_drive(&s, &drive);
    load.place = dmb_station(string, 2, 1.0);
    load.force[0] = 500.0;
    load.time_function = drive.time_function;
    must_model(&s, dmb_model_add_load(s.model, &load, NULL));
    options.newton_tolerance = 1e-11;
    rig_start(&s, &options);
    take_steps(&s, h, (uint32_t)(0.1 / h + 0.5));
    const dmb_energy energy = energy_of(&s);
    rig_close(&s);
    return energy;
}

static void the_ledger_balances(void **state)
{
    (void)state;
    const dmb_energy coarse = ledger_of_a_run(5e-4), fine = ledger_of_a_run(1.25e-4);
    const double gained = fine.kinetic + fine.strain + fine.gravity + fine.contact;
    CHECK_CLOSE(fine.balance,
                fine.drives + fine.loads - fine.friction - fine.impact - fine.damping - fine.rock - gained,
                1e-12 * fine.input);
    CHECK_CLOSE(fine.balance, fine.scheme + fine.unexplained, 1e-12 * fine.input);
    CHECK_CLOSE(fine.error, fabs(fine.balance) / fine.input, 1e-15);
    CHECK_CLOSE(fine.unexplained, 0.0, 1e-6 * fine.input);
    assert_true(fine.drives > 0.0 && fine.loads > 0.0 && fine.friction > 0.0 && fine.damping > 0.0);
    assert_true(fabs(fine.balance) < 0.2 * fabs(coarse.balance));
}

/* ---- In mud that goes along -------------------------------------------------------------------------------------- */

static const double mud_density = 1200.0, added_far = 1.5;
static const double head_mud[2] = {2.0, 5.0}, bit_mud[2] = {1.0, 3.0}, ring_along = 0.5;

typedef struct wet_craft {
    rig s;
    dmb_id string, head, bit, ring, wide;
} wet_craft;

static dmb_stabiliser_def ring_at(uint32_t pipe, double added_across)
{
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    ring.pipe = pipe;
    ring.outer_diameter = 0.11;
    ring.length = 0.4;
    ring.added_mass[0] = ring_along;
    ring.added_mass[1] = added_across;
    return ring;
}

/* A free string far from any wall, kinds by pipe, of body velocity `v`, with head, bit and two rings, one whose mud is
 * by the environment. */
static wet_craft launch_in_mud(const int32_t kinds[3], double joint, const double v[6])
{
    wet_craft c;
    dmb_string_def def = dmb_string_def_default();
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_body_def head = dmb_body_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    rig_open(&c.s, 0.0, 0.0, 0.0);
    memset(mud.gravity, 0, sizeof mud.gravity);
    mud.fluid_density = mud_density, mud.inner_density = 1000.0, mud.added_mass = added_far;
    must_model(&c.s, dmb_model_set_environment(c.s.model, &mud));
    def.follows_hole = 0, def.start_free = DMB_FREE_ALL;
    memcpy(def.velocity, v, sizeof def.velocity);
    c.string = add_string(&c.s, &def);
    for (int i = 0; i < 3; i++) {
        dmb_pipe_def pipe = s1_pipe();
        pipe.kind = kinds[i];
        pipe.joint_length = i < 2 ? joint : 0.0, pipe.joint_outer_diameter = 0.09;
        add_pipes(&c.s, &pipe, 1);
    }
    head.attach = DMB_ATTACH_START, head.mass = 30.0, head.centre[0] = -0.2;
    memcpy(head.added_mass, head_mud, sizeof head_mud);
    c.head = add_body(&c.s, &head);
    bit.mass = 9.0;
    memcpy(bit.added_mass, bit_mud, sizeof bit_mud);
    must_model(&c.s, dmb_model_add_bit(c.s.model, &bit, &c.bit));
    const dmb_stabiliser_def ring = ring_at(1, -1.0), wide = ring_at(2, 4.0);
    must_model(&c.s, dmb_model_add_stabiliser(c.s.model, &ring, &c.ring));
    must_model(&c.s, dmb_model_add_stabiliser(c.s.model, &wide, &c.wide));
    rig_start(&c.s, NULL);
    return c;
}

static double wet_kinetic(const wet_craft *c, dmb_id part, uint32_t pipe)
{
    double energy = (double)NAN;
    must(&c->s, dmb_query_kinetic_energy(c->s.sim, part, pipe, &energy));
    return energy;
}

static void pipes_add_up_in_mud(void **state)
{
    (void)state;
    enum { F = DMB_PIPE_FLEXIBLE, R = DMB_PIPE_RIGID };
    const int32_t kinds[][3] = {{F, F, F}, {R, R, R}, {F, R, F}, {R, F, R}};
    const double v[6] = {1.5, 0.8, 0.1, -0.6, -1.3, 2.0};
    for (int k = 0; k < 4; k++) {
        wet_craft c = launch_in_mud(kinds[k], 0.2, v);
        for (int run = 0; run < 2; run++) {
            double sum = 0.5 * (wet_kinetic(&c, c.head, 0) + wet_kinetic(&c, c.bit, 0)) + wet_kinetic(&c, c.ring, 0) +
                         wet_kinetic(&c, c.wide, 0);
            for (uint32_t i = 0; i < 3; i++) sum += wet_kinetic(&c, c.string, i);
            const double whole = energy_of(&c.s).kinetic;
            CHECK_CLOSE(sum, whole, 1e-12 * whole);
            take_steps(&c.s, 1e-4, 20);
        }
        rig_close(&c.s);
    }
}

/* Drifting without turning at u along and w across: (m + m_along) u^2/2 + (m + m_across) w^2/2 of each part. A pipe
 * takes along c rho pi D^2/4 + rho_i pi d^2/4 a metre; the ring by the environment c rho of what it displaces beyond
 * the pipe. */
static void kinetic_energy_in_mud(void **state)
{
    (void)state;
    const int32_t kinds[3] = {DMB_PIPE_RIGID, DMB_PIPE_RIGID, DMB_PIPE_RIGID};
    const double u = 0.7, w = 1.1, v[6] = {u, w, 0.0, 0.0, 0.0, 0.0}, D = 0.073, d = 0.055, L = 1.5;
    const double beyond = 0.25 * PI * (0.11 * 0.11 - D * D) * 0.4, iron = 7850.0 * beyond;
    const double mud_of_pipe = 0.25 * PI * (added_far * mud_density * D * D + 1000.0 * d * d) * L;
    const double mass_of_pipe = s1_values().mass * L;
    wet_craft c = launch_in_mud(kinds, 0.0, v);
    const double head = 0.5 * ((30.0 + head_mud[0]) * u * u + (30.0 + head_mud[1]) * w * w);
    const double bit = 0.5 * ((9.0 + bit_mud[0]) * u * u + (9.0 + bit_mud[1]) * w * w);
    const double pipe = 0.5 * (mass_of_pipe * u * u + (mass_of_pipe + mud_of_pipe) * w * w);
    const double ring = 0.5 * ((iron + ring_along) * u * u + (iron + added_far * mud_density * beyond) * w * w);
    CHECK_CLOSE(wet_kinetic(&c, c.head, 0), head, 1e-12 * head);
    CHECK_CLOSE(wet_kinetic(&c, c.bit, 0), bit, 1e-12 * bit);
    CHECK_CLOSE(wet_kinetic(&c, c.string, 0), pipe + 0.5 * head, 1e-12 * pipe);
    CHECK_CLOSE(wet_kinetic(&c, c.string, 1), pipe, 1e-12 * pipe);
    CHECK_CLOSE(wet_kinetic(&c, c.ring, 0), ring, 1e-12 * ring);
    CHECK_CLOSE(wet_kinetic(&c, c.wide, 0), 0.5 * ((iron + ring_along) * u * u + (iron + 4.0) * w * w), 1e-12 * ring);
    const dmb_momentum p = momentum_of(&c.s);
    const double mass = 30.0 + 9.0 + 3.0 * mass_of_pipe + 2.0 * iron;
    const double across = mass + head_mud[1] + bit_mud[1] + 4.0 + 3.0 * mud_of_pipe + added_far * mud_density * beyond;
    CHECK_CLOSE(p.mass, mass, 1e-12 * mass);
    CHECK_CLOSE(p.linear[0], (mass + head_mud[0] + bit_mud[0] + 2.0 * ring_along) * u, 1e-12 * mass);
    CHECK_CLOSE(p.linear[1], across * w, 1e-12 * mass);
    CHECK_CLOSE(p.linear[2], 0.0, 1e-12 * mass);
    rig_close(&c.s);
}

/* On the hole's axis a body feels its mass along the hole and its inertia about it, and of its mud what goes along. */
static void momentum_on_the_axis(void **state)
{
    (void)state;
    const dmb_wall_def wall = s1_hole();
    const double L = 1.5, m = s1_values().mass * L, speed = 0.4, spin = 3.0;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_body_def head = dmb_body_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    (void)add_wall(&s, &wall);
    def.start_free = DMB_FREE_CYLINDRICAL;
    def.velocity[0] = speed, def.velocity[3] = spin;
    add_string(&s, &def);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    const dmb_id string = add_pipes(&s, &pipe, 2);
    head.attach = DMB_ATTACH_START, head.mass = 30.0;
    head.inertia[0] = 0.3, head.inertia[1] = head.inertia[2] = 0.6;
    head.added_mass[0] = head_mud[0], head.added_mass[1] = head_mud[1];
    const dmb_id id = add_body(&s, &head);
    rig_start(&s, NULL);
    const dmb_momentum p = momentum_of(&s);
    const double polar = 2.0 * 7850.0 * s1_values().I * 2.0 * L + 0.3, mass = 30.0 + 2.0 * m;
    double energy[3];
    must(&s, dmb_query_kinetic_energy(s.sim, id, 0, energy));
    for (uint32_t i = 0; i < 2; i++) must(&s, dmb_query_kinetic_energy(s.sim, string, i, energy + 1 + i));
    const double of_head = 0.5 * ((30.0 + head_mud[0]) * speed * speed + 0.3 * spin * spin);
    CHECK_CLOSE(p.mass, mass, 1e-12 * mass);
    CHECK_CLOSE(p.linear[0], (mass + head_mud[0]) * speed, 1e-12 * mass);
    CHECK_CLOSE(p.angular[0], polar * spin, 1e-12);
    CHECK_CLOSE(energy[0], of_head, 1e-12 * of_head);
    const double whole = energy_of(&s).kinetic;
    CHECK_CLOSE(energy[1] + energy[2] + 0.5 * of_head, whole, 1e-12 * whole);
    CHECK_CLOSE(whole, 0.5 * ((mass + head_mud[0]) * speed * speed + polar * spin * spin), 1e-12 * whole);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pipes_add_up),          cmocka_unit_test(kinetic_energy_of_a_body),
        cmocka_unit_test(momentum_in_flight),    cmocka_unit_test(momentum_of_a_pipe),
        cmocka_unit_test(the_ledger_balances),   cmocka_unit_test(pipes_add_up_in_mud),
        cmocka_unit_test(kinetic_energy_in_mud), cmocka_unit_test(momentum_on_the_axis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
