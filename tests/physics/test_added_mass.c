/* Mud that goes along with bodies, bits, rings and rigid pipes: accelerations, frequencies and coupled modes in closed
 * form, the tumbling of a body in an ideal fluid against Kirchhoff's equations integrated by themselves, its energy and
 * momentum, the centre of mass of pipes, and what is refused. Equations: eq:mud.kirchhoff, eq:mud.added-mass. */
#include <string.h>

#include "mechanism.h"
#include "modal.h"
#include "ode.h"

static const double rho = 1200.0;

static void set_mud(rig *s, double added, double g)
{
    dmb_environment_def e = dmb_environment_def_default();
    e.gravity[2] = -g;
    e.fluid_density = rho;
    e.added_mass = added;
    must_model(s, dmb_model_set_environment(s->model, &e));
}

static dmb_body_def body_in_mud(double along, double across)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 10.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = i == 0 ? 0.3 : 0.8;
    body.added_mass[0] = along;
    body.added_mass[1] = across;
    return body;
}

/* ---- A push ------------------------------------------------------------------------------------------------------ */

/* F + (m - rho V) g over m + m_a, along and across; its weight is that without inertia of the mud. */
static void a_push_moves_mud_too(void **state)
{
    static const double force[2] = {70.0, -30.0}, mud[2] = {2.0, 7.0};
    const double g = 9.81, volume = 4e-3, weight = (10.0 - rho * volume) * g, time = 0.5;
    (void)state;
    for (int across = 0; across < 2; across++) {
        rig s;
        dmb_body_def body = body_in_mud(mud[0], mud[1]);
        dmb_load_def load = dmb_load_def_default();
        rig_open(&s, 0.0, 0.0, 0.0);
        set_mud(&s, 0.0, g);
        body.displaced_volume = volume;
        if (!across) body.rotation[1] = -0.5 * PI; /* body x up */
        const dmb_id id = add_body(&s, &body);
        load.place = dmb_station(id, 0, 0.0);
        load.force[2] = force[across];
        (void)add_load(&s, &load);
        (void)mechanism_start(&s, NULL);
        take_steps(&s, 0.01, 50);
        const double a = (force[across] - weight) / (10.0 + mud[across]), v = a * time;
        check_relative("path of a body that is pushed in mud [m]", pose_at(&s, load.place).displacement[2],
                       0.5 * a * time * time, 1e-11);
        double energy = 0.0;
        must(&s, dmb_query_kinetic_energy(s.sim, id, 0, &energy));
        check_relative("its kinetic energy [J]", energy, 0.5 * (10.0 + mud[across]) * v * v, 1e-11);
        check_relative("kinetic energy of the ledger [J]", energy_of(&s).kinetic, energy, 1e-14);
        check_relative("momentum [kg m/s]", momentum_of(&s).linear[2], (force[across] - weight) * time, 1e-11);
        check_relative("mass [kg]", momentum_of(&s).mass, 10.0, 1e-15);
        check_below("energy balance [J]", energy_of(&s).balance, 1e-9);
        rig_close(&s);
    }
}

/* ---- Kirchhoff --------------------------------------------------------------------------------------------------- */

/* Lamb 1932, 124; m a sphere's part, b = x offset of the centre of the mud. v = (u; w), rotation R row by row, x. */
typedef struct swimmer {
    double mass[3];    /* [kg] along, across, across (their sums) */
    double offset;     /* [kg m] first moment of the mud across */
    double inertia[3]; /* [kg m2] at the reference point, mud included */
} swimmer;

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void momenta(const swimmer *b, const double v[6], double p[6])
{
    p[0] = b->mass[0] * v[0];
    p[1] = b->mass[1] * v[1] + b->offset * v[5];
    p[2] = b->mass[2] * v[2] - b->offset * v[4];
    p[3] = b->inertia[0] * v[3];
    p[4] = b->inertia[1] * v[4] - b->offset * v[2];
    p[5] = b->inertia[2] * v[5] + b->offset * v[1];
}

/* M^-1 f: two by two, (u_y, w_z) and (u_z, w_y). */
static void accelerations(const swimmer *b, const double f[6], double a[6])
{
    const double y = b->mass[1] * b->inertia[2] - b->offset * b->offset;
    const double z = b->mass[2] * b->inertia[1] - b->offset * b->offset;
    a[0] = f[0] / b->mass[0];
    a[3] = f[3] / b->inertia[0];
    a[1] = (b->inertia[2] * f[1] - b->offset * f[5]) / y;
    a[5] = (b->mass[1] * f[5] - b->offset * f[1]) / y;
    a[2] = (b->inertia[1] * f[2] + b->offset * f[4]) / z;
    a[4] = (b->mass[2] * f[4] + b->offset * f[2]) / z;
}

static void swim(void *context, double t, const double *y, double *rate)
{
    double p[6], f[6], moment[3];
    (void)t;
    momenta(context, y, p);
    cross(p, y + 3, f); /* p_u x w, p_w x w + p_u x u */
    cross(p + 3, y + 3, f + 3);
    cross(p, y, moment);
    for (int i = 0; i < 3; i++) f[3 + i] += moment[i];
    accelerations(context, f, rate);
    for (int i = 0; i < 3; i++) cross(y + 7 + 3 * i, y + 3, rate + 7 + 3 * i); /* rows of R: R' = R w~ */
    rate[6] = y[7] * y[0] + y[8] * y[1] + y[9] * y[2];                         /* world x of the reference point */
}

/* World x of the body after `time` by the equations alone. */
static double swims_to(const swimmer *b, const double v[6], double time)
{
    double y[16] = {0.0};
    memcpy(y, v, 6 * sizeof(double));
    y[7] = y[11] = y[15] = 1.0;
    ode_solve(swim, (void *)(uintptr_t)b, 0.0, time, 4000, 16, y);
    return y[6];
}

/* A body that is not round itself, its mud before it, thrown with spin. */
static dmb_body_def thrown(const double v[6], double ahead)
{
    dmb_body_def body = body_in_mud(1.5, 12.0);
    body.inertia[1] = 0.6;
    body.centre[0] = ahead;
    memcpy(body.velocity, v, 6 * sizeof(double));
    return body;
}

static void a_body_tumbles_as_kirchhoff_says(void **state)
{
    static const double v[6] = {2.0, 0.1, -0.2, 4.0, 0.3, 1.0};
    const swimmer same = {{11.5, 22.0, 22.0}, 0.0, {0.3, 0.6, 0.8}};
    static const char *const names[4] = {"place", "momentum", "moment of momentum", "kinetic energy"};
    double error[4][2];
    (void)state;
    const double want = swims_to(&same, v, 2.0);
    for (int k = 0; k < 2; k++) {
        rig s;
        const dmb_body_def body = thrown(v, 0.0);
        const dmb_sim_options options = sharp_options(1.0, 1e-12);
        rig_open(&s, 0.0, 0.0, 0.0);
        set_mud(&s, 0.0, 0.0);
        const dmb_id id = add_body(&s, &body);
        (void)mechanism_start(&s, &options);
        const dmb_momentum before = momentum_of(&s);
        const double kinetic = energy_of(&s).kinetic;
        take_steps(&s, 1e-3 / (1 << k), 2000U << k);
        const dmb_momentum after = momentum_of(&s);
        error[0][k] = fabs(pose_at(&s, dmb_station(id, 0, 0.0)).displacement[0] - want);
        error[1][k] = largest_difference(3, before.linear, after.linear);
        error[2][k] = largest_difference(3, before.angular, after.angular);
        error[3][k] = fabs(energy_of(&s).kinetic - kinetic);
        check_below("balance less the scheme's share [J]", fabs(energy_of(&s).unexplained), 1e-9);
        rig_close(&s);
    }
    tell("place of the body after 2 s [m]", want);
    for (int i = 0; i < 4; i++) check_order(names[i], error[i][0], error[i][1], 2.0, 0.1);
    check_below("error of the place at 0.5 ms [m]", error[0][1], 1e-4);
}

/* Small swings of a body that swims across its long side: (A - B) I^2/(A B J) of the linear impulse I = A u. */
static void the_moment_of_munk(void **state)
{
    const double A = 30.0, B = 12.0, J = 0.8, u = 0.5, omega = u * A * sqrt((A - B) / (A * B * J));
    const double small = 1e-4;
    rig s;
    dmb_body_def body = body_in_mud(20.0, 2.0);
    const dmb_sim_options options = sharp_options(1.0, 1e-13);
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    set_mud(&s, 0.0, 0.0);
    body.velocity[0] = u;
    body.velocity[5] = small * omega;
    const dmb_id id = add_body(&s, &body);
    (void)mechanism_start(&s, &options);
    const uint32_t steps = 2000;
    const double h = 1.25 * 2.0 * PI / omega / steps; /* five quarters: at the turn */
    take_steps(&s, h, steps);
    check_relative("angle of a swing over the first [-]", pose_at(&s, dmb_station(id, 0, 0.0)).rotation[3], small,
                   1e-4);
    rig_close(&s);
}

/* ---- Frequencies ------------------------------------------------------------------------------------------------- */

/* A clamped pipe with a ring at its end, in an annulus. Modes: bending twice, then axial. */
typedef struct ringed {
    double density, mass, inertia; /* of the mud; of the ring: kg, kg m2 across */
    double added[2];
    double coefficient;
} ringed;

static void frequencies_of(const ringed *of, double bending[3], double *axial)
{
    rig s;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    dmb_wall_def wall = s1_hole();
    dmb_environment_def e = dmb_environment_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    memset(e.gravity, 0, sizeof e.gravity);
    e.fluid_density = of->density;
    e.added_mass = of->coefficient;
    must_model(&s, dmb_model_set_environment(s.model, &e));
    wall.normal_law = DMB_NORMAL_NONE;
    add_wall(&s, &wall);
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(&s, &string);
    pipe.elements = 2;
    (void)add_pipes(&s, &pipe, 2);
    ring.string = pipe.string;
    ring.pipe = 1;
    ring.fraction = 1.0;
    ring.mass = of->mass;
    ring.inertia[0] = 0.05;
    ring.inertia[1] = of->inertia;
    ring.outer_diameter = 0.09;
    memcpy(ring.added_mass, of->added, sizeof ring.added_mass);
    must_model(&s, dmb_model_add_stabiliser(s.model, &ring, NULL));
    (void)mechanism_start(&s, NULL);
    dmb_modes *modes = all_modes(&s, 0);
    for (uint32_t i = 0; i < 3; i++) bending[i] = frequency_of_kind(modes, 2, 2 * i);
    *axial = frequency_of_kind(modes, 0, 0);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* Mud given in kilograms is mass of the ring in one direction and none in the other, m L^2/12 with it across; by the
 * environment it is (D^2 + d^2)/(D^2 - d^2) of what ring and pipe displace, one less the other. */
static void rings_carry_mud(void **state)
{
    const double D = 0.094, d = 0.09, p = 0.073, L = 0.3, more = 5.0;
    const double annulus =
        rho * PI / 4.0 * L * (d * d * (D * D + d * d) / (D * D - d * d) - p * p * (D * D + p * p) / (D * D - p * p));
    const double far = rho * PI / 4.0 * L * (d * d - p * p);
    const ringed dry = {rho, 20.0, 0.4, {0.0, 0.0}, 0.0}, across = {rho, 20.0, 0.4, {0.0, more}, 0.0};
    const ringed heavy = {rho, 20.0 + more, 0.4 + more * L * L / 12.0, {0.0, 0.0}, 0.0};
    const ringed along = {rho, 20.0, 0.4, {more, 0.0}, 0.0};
    double a[3], b[3], axial[2];
    (void)state;
    frequencies_of(&across, a, axial);
    frequencies_of(&heavy, b, axial + 1);
    for (int i = 0; i < 3; i++) check_relative("bending frequency, mud across [Hz]", a[i], b[i], 1e-9);
    frequencies_of(&dry, a, axial + 1);
    check_relative("axial frequency, mud across [Hz]", axial[0], axial[1], 1e-9);
    frequencies_of(&along, b, axial);
    for (int i = 0; i < 3; i++) check_relative("bending frequency, mud along [Hz]", b[i], a[i], 1e-9);
    frequencies_of(&heavy, a, axial + 1);
    check_relative("axial frequency, mud along [Hz]", axial[0], axial[1], 1e-9);
    for (int k = 0; k < 2; k++) {
        const ringed by_coefficient = {rho, 20.0, 0.4, {0.0, -1.0}, k ? 1.0 : -1.0};
        const ringed given = {rho, 20.0, 0.4, {0.0, k ? far : annulus}, k ? 1.0 : -1.0};
        frequencies_of(&by_coefficient, a, axial);
        frequencies_of(&given, b, axial + 1);
        for (int i = 0; i < 3; i++) check_relative("bending frequency by the annulus [Hz]", a[i], b[i], 1e-9);
    }
    tell("mud of the ring in its annulus [kg]", annulus);
}

static dmb_id hang_spring(rig *s, dmb_id body, double x, double stiffness)
{
    dmb_spring_def spring = dmb_spring_def_default();
    dmb_id id;
    spring.place_b = dmb_station(body, 0, 0.0);
    spring.offset_a[0] = spring.offset_b[0] = x;
    spring.offset_a[2] = 1.0;
    spring.stiffness = stiffness;
    must_model(s, dmb_model_add_spring(s->model, &spring, &id));
    return id;
}

/* On two springs the body heaves and pitches together: [m + m_a, -m c - m_a c; , J + (m + m_a) c^2] at the reference
 * point. */
static void heave_and_pitch(void **state)
{
    const double k1 = 3e4, k2 = 2e4, x1 = -0.4, x2 = 0.7, c = 0.25, m = 22.0, J = 0.8 + m * c * c;
    rig s;
    dmb_body_def body = body_in_mud(2.0, 12.0);
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    set_mud(&s, 0.0, 0.0);
    body.centre[0] = c;
    const dmb_id id = add_body(&s, &body);
    (void)hang_spring(&s, id, x1, k1);
    (void)hang_spring(&s, id, x2, k2);
    (void)mechanism_start(&s, NULL);
    dmb_modes *modes = all_modes(&s, 0);
    /* z up and turning about y lower x: z - x theta */
    const double K[3] = {k1 + k2, -(k1 * x1 + k2 * x2), k1 * x1 * x1 + k2 * x2 * x2}, M[3] = {m, -m * c, J};
    const double a = M[0] * M[2] - M[1] * M[1], b = M[0] * K[2] + M[2] * K[0] - 2.0 * M[1] * K[1];
    const double root = sqrt(b * b - 4.0 * a * (K[0] * K[2] - K[1] * K[1]));
    for (int i = 0; i < 2; i++) {
        const double omega = sqrt((b + (i ? root : -root)) / (2.0 * a));
        check_relative(i ? "second coupled frequency [Hz]" : "first coupled frequency [Hz]",
                       frequency_of_kind(modes, 2, (uint32_t)i), omega / (2.0 * PI), 1e-10);
    }
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* A bit on axial-torsional pipes: heavier along the hole, the same about it. */
static double axial_frequency(int32_t kind, double mass, double mud)
{
    rig s;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_wall_def wall = s1_hole();
    rig_open(&s, 0.0, 0.0, 0.0);
    wall.normal_law = DMB_NORMAL_NONE;
    wall.friction_law = DMB_FRICTION_NONE;
    add_wall(&s, &wall);
    string.start_free = DMB_FREE_NONE;
    pipe.kind = kind;
    bit.string = pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 4);
    bit.mass = mass;
    bit.inertia[0] = bit.inertia[1] = 1.0;
    bit.diameter = 0.0;
    bit.added_mass[0] = mud;
    must_model(&s, dmb_model_add_bit(s.model, &bit, NULL));
    (void)mechanism_start(&s, NULL);
    dmb_modes *modes = all_modes(&s, 0);
    const double frequency = frequency_of_kind(modes, 0, 0);
    dmb_modes_destroy(&modes);
    rig_close(&s);
    return frequency;
}

static void bits_carry_mud(void **state)
{
    static const int32_t kinds[2] = {DMB_PIPE_AXIAL_TORSIONAL, DMB_PIPE_FLEXIBLE};
    (void)state;
    for (int k = 0; k < 2; k++)
        check_relative("axial frequency with a bit in mud [Hz]", axial_frequency(kinds[k], 30.0, 6.0),
                       axial_frequency(kinds[k], 36.0, 0.0), 1e-10);
}

/* A rigid rod hangs in mud by its end, full of it: weight by buoyancy, inertia by the mud within and without. */
static void a_rod_swings_in_mud(void **state)
{
    const double g = 9.81, L = 1.5, Ao = PI / 4.0 * 0.073 * 0.073, Ai = PI / 4.0 * 0.055 * 0.055;
    const double m = 7850.0 * (Ao - Ai), I = PI / 64.0 * (pow(0.073, 4.0) - pow(0.055, 4.0));
    const double weight = (m - rho * (Ao - Ai)) * g * L;
    const double J = (m + rho * Ai + 1.5 * rho * Ao) * L * L * L / 3.0 + 7850.0 * I * L;
    rig s;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_environment_def e = dmb_environment_def_default();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    memset(e.gravity, 0, sizeof e.gravity);
    e.gravity[0] = g;
    e.fluid_density = rho;
    e.added_mass = 1.5;
    must_model(&s, dmb_model_set_environment(s.model, &e));
    string.follows_hole = 0;
    string.start_free = DMB_FREE_ALL;
    pipe.kind = DMB_PIPE_RIGID;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    (void)add_joint_between(&s, DMB_JOINT_SPHERICAL, dmb_station(ground_id, 0, 0.0), dmb_station(pipe.string, 0, 0.0));
    (void)mechanism_start(&s, NULL);
    dmb_modes *modes = all_modes(&s, 0);
    check_relative("frequency of a rigid rod in mud [Hz]", frequency_of_kind(modes, 2, 0),
                   sqrt(weight * 0.5 * L / J) / (2.0 * PI), 1e-10);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* ---- Momentum and centre of mass --------------------------------------------------------------------------------- */

enum { SLICES = 400 };

/* Two pipes of 3 m, pre-bent by `curvature` [1/m], clamped or free at the rig, gravity along -z. */
static dmb_id pipes_in_mud(rig *s, double added, double curvature, int32_t start_free)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(s, 0.0, 0.0, 0.0);
    set_mud(s, added, 9.81);
    string.start_free = start_free;
    pipe.outer_diameter = 0.05;
    pipe.inner_diameter = 0.04;
    pipe.length = 3.0;
    pipe.elements = 2;
    pipe.curvature[1] = curvature;
    pipe.string = add_string(s, &string);
    (void)add_pipes(s, &pipe, 2);
    (void)mechanism_start(s, NULL);
    return pipe.string;
}

/* Mean position of the sections, by the midpoint rule. */
static void mean_of_sections(const rig *s, dmb_id string, double centre[3])
{
    memset(centre, 0, 3 * sizeof(double));
    for (uint32_t i = 0; i < 2 * SLICES; i++) {
        const dmb_pose at = pose_at(s, dmb_station(string, i / SLICES, (i % SLICES + 0.5) / SLICES));
        for (int k = 0; k < 3; k++) centre[k] += at.position[k] / (2.0 * SLICES);
    }
}

/* The mud is no part: mass and centre of a sagging string are those of its steel. */
static void the_centre_is_of_the_parts(void **state)
{
    static const double added[3] = {0.0, 1.0, 5.0}, curvature[3] = {0.0, 0.02, -0.02};
    const double mass = 7850.0 * PI / 4.0 * (0.05 * 0.05 - 0.04 * 0.04) * 6.0;
    (void)state;
    for (int i = 0; i < 9; i++) {
        rig s;
        double centre[3];
        const dmb_id string = pipes_in_mud(&s, added[i % 3], curvature[i / 3], DMB_FREE_NONE);
        (void)find_equilibrium(&s, NULL);
        mean_of_sections(&s, string, centre);
        const dmb_momentum found = momentum_of(&s);
        check_relative("mass of the steel [kg]", found.mass, mass, 1e-12);
        check_below("centre of mass from the mean of the sections [m]", largest_difference(3, found.centre, centre),
                    1e-4);
        rig_close(&s);
    }
}

/* A free string that falls in mud has the impulse of its weight, in the steel and in the mud. */
static void a_string_falls_in_mud(void **state)
{
    const double steel = 7850.0 * PI / 4.0 * (0.05 * 0.05 - 0.04 * 0.04) * 6.0, time = 0.1;
    const double mud = rho * PI / 4.0 * (2.0 * 0.05 * 0.05 + 0.04 * 0.04) * 6.0; /* C = 2, and inside */
    const double weight = (steel - rho * PI / 4.0 * (0.05 * 0.05 - 0.04 * 0.04) * 6.0) * 9.81;
    rig s;
    (void)state;
    (void)pipes_in_mud(&s, 2.0, 0.0, DMB_FREE_ALL);
    const double start = momentum_of(&s).centre[2];
    take_steps(&s, 1e-3, 100);
    const dmb_momentum found = momentum_of(&s);
    check_relative("momentum [kg m/s]", found.linear[2], -weight * time, 1e-9);
    check_relative("angular momentum [kg m2/s]", found.angular[1], weight * time * 3.0, 1e-9);
    check_relative("path of the centre [m]", found.centre[2] - start, -0.5 * weight / (steel + mud) * time * time,
                   1e-9);
    rig_close(&s);
}

/* ---- Bad input --------------------------------------------------------------------------------------------------- */

static void check_refused(rig *s, int32_t status, const char *text)
{
    assert_int_equal(status, DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_model_message(s->model), text));
    must_model(s, dmb_model_clear_refused(s->model));
}

static void what_it_cannot_is_refused(void **state)
{
    rig s;
    dmb_body_def body = dmb_body_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    body.added_mass[0] = -1.0;
    check_refused(&s, dmb_model_add_body(s.model, &body, NULL), "added_mass");
    body.added_mass[0] = 0.0;
    body.added_mass[1] = 1e300;
    check_refused(&s, dmb_model_add_body(s.model, &body, NULL), "added_mass");
    bit.added_mass[1] = -0.5;
    check_refused(&s, dmb_model_add_bit(s.model, &bit, NULL), "added_mass");
    ring.added_mass[0] = -1.0;
    check_refused(&s, dmb_model_add_stabiliser(s.model, &ring, NULL), "added_mass[0] = ");
    ring.added_mass[0] = 0.0;
    ring.added_mass[1] = -0.5;
    check_refused(&s, dmb_model_add_stabiliser(s.model, &ring, NULL), "added_mass[1] = ");
    body.added_mass[1] = 0.0;
    body.added_mass[0] = (double)NAN;
    assert_int_equal(dmb_model_add_body(s.model, &body, NULL), DMB_ERR_NOT_FINITE);
    rig_close(&s);
}

/* A ring that fills the hole has no annulus, and mud given in kilograms does not follow the density. */
static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        rig s;
        dmb_string_def string = dmb_string_def_default();
        dmb_pipe_def pipe = s1_pipe();
        dmb_stabiliser_def ring = dmb_stabiliser_def_default();
        dmb_input_def input = dmb_input_def_default();
        dmb_wall_def wall = s1_hole();
        rig_open(&s, 0.0, 0.0, 0.0);
        set_mud(&s, k ? 0.0 : -1.0, 0.0);
        add_wall(&s, &wall);
        ring.string = pipe.string = add_string(&s, &string);
        (void)add_pipes(&s, &pipe, 1);
        ring.outer_diameter = k ? 0.09 : wall.diameter;
        ring.added_mass[1] = k ? 2.0 : -1.0;
        must_model(&s, dmb_model_add_stabiliser(s.model, &ring, NULL));
        strcpy(input.name, "density");
        input.target = DMB_TARGET_FLUID_DENSITY;
        if (k) must_model(&s, dmb_model_add_input(s.model, &input, NULL));
        assert_int_equal(dmb_model_compile(s.model, NULL), k ? DMB_ERR_UNSUPPORTED : DMB_ERR_GEOMETRY);
        assert_non_null(strstr(dmb_model_message(s.model), "added_mass"));
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_push_moves_mud_too),
        cmocka_unit_test(a_body_tumbles_as_kirchhoff_says),
        cmocka_unit_test(the_moment_of_munk),
        cmocka_unit_test(rings_carry_mud),
        cmocka_unit_test(heave_and_pitch),
        cmocka_unit_test(bits_carry_mud),
        cmocka_unit_test(a_rod_swings_in_mud),
        cmocka_unit_test(the_centre_is_of_the_parts),
        cmocka_unit_test(a_string_falls_in_mud),
        cmocka_unit_test(what_it_cannot_is_refused),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
