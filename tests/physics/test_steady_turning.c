/* Statics of a string that turns as a rigid body, and modes about it, held against the turning beam: Wright, Smith,
 * Thresher, Wang 1982 (hub radius 0), a Ritz series (other hub radii), the extension rho Omega^2 L^3/(3 E) and its
 * closed form at finite strain, a hinged rigid blade, and runs in time. Equations: eq:sliding.tangent. */
#include <string.h>

#include "modal.h"

#define LENGTH 10.0
#define EI 1.0e4
#define MASS 1.5

/* A slender beam: EA L^2/EI 1e6 for its stretch to be small, and hardly any shear and rotary inertia. */
typedef struct blade {
    rig rig;
    dmb_id string;
} blade;

typedef struct blade_choice {
    double eta;        /* [-] Omega sqrt(m L^4/EI) */
    double hub;        /* [-] radius over length */
    int32_t component; /* DMB_RY or DMB_RZ */
    uint32_t pipes, elements;
    double turn[3]; /* [rad] rotation vector of the scene */
    double EA;      /* [N] */
} blade_choice;

static double speed_of(const blade_choice *c)
{
    return c->eta * sqrt(EI / MASS) / (LENGTH * LENGTH);
}

static dmb_pipe_def blade_pipe(const blade_choice *c)
{
    dmb_pipe_def pipe = beam_pipe(LENGTH / c->pipes, c->elements, c->EA, 1e10, 1e6, EI);
    pipe.section_mass = MASS;
    pipe.section_inertia[0] = 2e-5;
    pipe.section_inertia[1] = 1e-5;
    return pipe;
}

static void add_hub(blade *b, const blade_choice *c)
{
    dmb_pipe_def hub = dmb_pipe_def_default();
    if (c->hub == 0.0) return;
    hub.kind = DMB_PIPE_RIGID;
    hub.string = b->string;
    hub.length = c->hub * LENGTH;
    (void)add_pipes(&b->rig, &hub, 1);
}

static uint32_t last_pipe(const blade_choice *c)
{
    return c->pipes - 1 + (c->hub != 0.0);
}

static void open_blade(blade *b, const blade_choice *c)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = blade_pipe(c);
    rig_open(&b->rig, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_X << c->component;
    memcpy(def.rotation, c->turn, sizeof def.rotation);
    b->string = pipe.string = add_string(&b->rig, &def);
    add_hub(b, c);
    (void)add_pipes(&b->rig, &pipe, c->pipes);
    (void)add_simple_drive(&b->rig, DMB_DRIVE_MOTION, b->string, c->component, add_constant(&b->rig, speed_of(c)));
    (void)rig_start(&b->rig, NULL);
}

static dmb_static_report turn(const blade *b, int32_t steady)
{
    dmb_static_options options = dmb_static_options_default();
    options.steady = steady;
    options.tolerance = 1e-13;
    return find_equilibrium(&b->rig, &options);
}

/* mu of the lowest two modes: lag and flap, w^2_lag = w^2_flap - Omega^2. */
static void lowest_two(const blade *b, double mu[2])
{
    dmb_modes *modes = lowest_modes(&b->rig, DMB_MODES_DAMPED, 6);
    for (uint32_t i = 0; i < 2; i++) mu[i] = 2.0 * PI * frequency_at(modes, i) * LENGTH * LENGTH / sqrt(EI / MASS);
    dmb_modes_destroy(&modes);
}

/* ---- Flap and lag ------------------------------------------------------------------------------------------------ */

static void flap_of(const blade_choice *c, double want, double tolerance)
{
    blade b;
    double mu[2];
    open_blade(&b, c);
    const dmb_static_report report = turn(&b, DMB_STEADY_AUTO);
    assert_int_equal(report.steady, c->eta == 0.0 ? DMB_STEADY_AT_REST : DMB_STEADY_RIGID);
    assert_int_equal(report.negative, 0);
    lowest_two(&b, mu);
    print_message("eta %g, hub %g, component %d, %u x %u elements: lag %.6f, flap %.6f\n", c->eta, c->hub, c->component,
                  c->pipes, c->elements, mu[0], mu[1]);
    check_relative("flap", mu[1], want, tolerance);
    /* of second order in the mesh: 24 elements, with the centrifugal force of the hub in the beam */
    check_relative("lag", mu[0] * mu[0], want * want - c->eta * c->eta, 2e-4 + 1.1e-3 * c->hub);
    rig_close(&b.rig);
}

static void flap_of_the_literature(void **state)
{
    static const double table[][2] = {{0, 3.5160}, {1, 3.6816}, {2, 4.1373}, {3, 4.7973},
                                      {4, 5.5850}, {5, 6.4495}, {6, 7.3604}, {12, 13.1702}};
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        const blade_choice c = {table[i][0], 0.0, DMB_RZ, 1, 24, {0.0, 0.0, 0.0}, 1e10};
        flap_of(&c, table[i][1], 2e-5);
    }
}

/* ---- Other hub radii, axes, meshes, directions ------------------------------------------------------------------- */

enum { TERMS = 10, CELLS = 5 };

/* x^2 P_k(2 x - 1), its slope and curvature on 0 .. 1 */
static void shape_of(double x, double f[TERMS][3])
{
    double P[TERMS][3] = {{1.0, 0.0, 0.0}, {2.0 * x - 1.0, 2.0, 0.0}};
    for (int k = 1; k + 1 < TERMS; k++) {
        const double z = 2.0 * x - 1.0, a = (2.0 * k + 1.0) / (k + 1.0), b = k / (k + 1.0);
        P[k + 1][0] = a * z * P[k][0] - b * P[k - 1][0];
        P[k + 1][1] = a * (2.0 * P[k][0] + z * P[k][1]) - b * P[k - 1][1];
        P[k + 1][2] = a * (4.0 * P[k][1] + z * P[k][2]) - b * P[k - 1][2];
    }
    for (int k = 0; k < TERMS; k++) {
        f[k][0] = x * x * P[k][0];
        f[k][1] = 2.0 * x * P[k][0] + x * x * P[k][1];
        f[k][2] = 2.0 * P[k][0] + 4.0 * x * P[k][1] + x * x * P[k][2];
    }
}

typedef struct ritz {
    double K[TERMS][TERMS], M[TERMS][TERMS];
} ritz;

/* (w_xx)^2 + T (w_x)^2 and w^2, T = eta^2 [(1 - x^2)/2 + hub (1 - x)], by eight Gauss points in each of five cells. */
static void integrate(double eta, double hub, ritz *r)
{
    static const double node[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    static const double weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    memset(r, 0, sizeof *r);
    for (int p = 0; p < 8 * CELLS; p++) {
        const double z = p % 8 < 4 ? node[p % 4] : -node[p % 4];
        const double s = (p / 8 + 0.5 + 0.5 * z) / CELLS, w = weight[p % 4] * 0.5 / CELLS;
        const double T = eta * eta * (0.5 * (1.0 - s * s) + hub * (1.0 - s));
        double f[TERMS][3];
        shape_of(s, f);
        for (int i = 0; i < TERMS; i++)
            for (int j = 0; j < TERMS; j++) {
                r->K[i][j] += w * (f[i][2] * f[j][2] + T * f[i][1] * f[j][1]);
                r->M[i][j] += w * f[i][0] * f[j][0];
            }
    }
}

/* y <- K^-1 y by elimination, K symmetric and positive; K is gone. */
static void eliminate(double K[TERMS][TERMS], double y[TERMS])
{
    for (int i = 0; i < TERMS; i++)
        for (int r = i + 1; r < TERMS; r++) {
            const double q = K[r][i] / K[i][i];
            for (int c = i; c < TERMS; c++) K[r][c] -= q * K[i][c];
            y[r] -= q * y[i];
        }
    for (int i = TERMS - 1; i >= 0; i--) {
        for (int c = i + 1; c < TERMS; c++) y[i] -= K[i][c] * y[c];
        y[i] /= K[i][i];
    }
}

static double product(double A[TERMS][TERMS], const double x[TERMS])
{
    double sum = 0.0;
    for (int i = 0; i < TERMS; i++)
        for (int j = 0; j < TERMS; j++) sum += x[i] * A[i][j] * x[j];
    return sum;
}

/* Flap of a turning beam, w_xxxx - (T w_x)_x = mu^2 w, by the principle of Ritz and inverse iteration. */
static double flap_by_ritz(double eta, double hub)
{
    ritz r;
    double x[TERMS] = {1.0};
    integrate(eta, hub, &r);
    for (int k = 0; k < 60; k++) {
        double A[TERMS][TERMS], y[TERMS] = {0.0};
        memcpy(A, r.K, sizeof A);
        for (int i = 0; i < TERMS; i++)
            for (int j = 0; j < TERMS; j++) y[i] += r.M[i][j] * x[j];
        eliminate(A, y);
        const double size = largest(TERMS, y);
        for (int i = 0; i < TERMS; i++) x[i] = y[i] / size;
    }
    return sqrt(product(r.K, x) / product(r.M, x));
}

static void flap_with_a_hub(void **state)
{
    static const double table[][2] = {{0.0, 0.0}, {5.0, 0.0}, {5.0, 0.1}, {5.0, 1.0}, {3.0, 5.0}, {10.0, 0.5}};
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        const blade_choice c = {table[i][0], table[i][1], DMB_RZ, 1, 24, {0.0, 0.0, 0.0}, 1e10};
        flap_of(&c, flap_by_ritz(table[i][0], table[i][1]), 2e-5);
    }
}

/* Driven about either axis, laid in any direction, pipe by pipe. */
static void flap_in_any_direction(void **state)
{
    static const double turns[][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 1.5}, {0.0, -1.2, 0.0}, {0.4, 2.0, -0.9}};
    (void)state;
    for (size_t i = 0; i < 8; i++) {
        blade_choice c = {5.0, i % 2 ? 0.3 : 0.0, i < 4 ? DMB_RZ : DMB_RY, i % 3 ? 6 : 1, i % 3 ? 4 : 24, {0.0}, 1e10};
        memcpy(c.turn, turns[i % 4], sizeof c.turn);
        flap_of(&c, flap_by_ritz(c.eta, c.hub), 2e-5);
    }
}

/* ---- The state --------------------------------------------------------------------------------------------------- */

static void tip_in_the_frame_of_the_root(const blade *b, uint32_t last, double out[3])
{
    const dmb_pose root = pose_at(&b->rig, dmb_station(b->string, 0, 0.0));
    const dmb_pose tip = pose_at(&b->rig, dmb_station(b->string, last, 1.0));
    for (int i = 0; i < 3; i++) {
        out[i] = 0.0;
        for (int j = 0; j < 3; j++) out[i] += root.rotation[3 * j + i] * (tip.position[j] - root.position[j]);
    }
}

/* EA u_xx + m W^2 (x + u) = 0: u(L) = tan(k L)/k - L, k^2 = m W^2/EA; m W^2 L^3/(3 EA) where k L is small. */
static void extension_of_a_turning_bar(void **state)
{
    static const double speeds[] = {0.5, 6.0, 30.0};
    (void)state;
    for (int i = 0; i < 3; i++) {
        const double eta = speeds[i] / (sqrt(EI / MASS) / (LENGTH * LENGTH));
        const blade_choice c = {eta, 0.0, DMB_RZ, 1, 64, {0.0, 0.0, 0.0}, 2.8e7};
        const double k = sqrt(MASS * speeds[i] * speeds[i] / 2.8e7);
        const double want = tan(k * LENGTH) / k - LENGTH;
        blade b;
        double tip[3];
        open_blade(&b, &c);
        (void)turn(&b, DMB_STEADY_RIGID);
        tip_in_the_frame_of_the_root(&b, 0, tip);
        check_relative("steady extension", tip[0] - LENGTH, want, 1.5e-5);
        if (i == 0)
            check_relative("    rho W^2 L^3/(3 E)", tip[0] - LENGTH, k * k * LENGTH * LENGTH * LENGTH / 3.0, 1.5e-5);
        rig_close(&b.rig);
    }
}

static double extension_error(uint32_t elements)
{
    dmb_pipe_def beam = beam_pipe(10.0, elements, 2.8e7, 1e7, 1e4, 1.4e4);
    blade b;
    double tip[3];
    beam.section_mass = 1.2;
    beam.section_inertia[0] = 1.2e-3;
    beam.section_inertia[1] = 6e-4;
    rig_open(&b.rig, 0.0, 0.0, 0.0);
    b.string = add_beam(&b.rig, &beam, DMB_FREE_RZ);
    (void)add_simple_drive(&b.rig, DMB_DRIVE_MOTION, b.string, DMB_RZ, add_constant(&b.rig, 6.0));
    (void)rig_start(&b.rig, NULL);
    (void)turn(&b, DMB_STEADY_AUTO);
    tip_in_the_frame_of_the_root(&b, 0, tip);
    rig_close(&b.rig);
    return fabs(tip[0] - 10.0 - 5.143174550e-4);
}

/* CASES: the spin-up beam's steady extension, without the transient; of second order, as the mass along a pipe is half
 * way between the consistent and the lumped one. */
static void extension_of_the_spin_up_beam(void **state)
{
    (void)state;
    const double coarse = extension_error(16), fine = extension_error(32);
    check_below("16 elements", coarse / 5.143174550e-4, 2.1e-4);
    check_below("32 elements", fine / 5.143174550e-4, 5.5e-5);
    check_order("extension", coarse, fine, 2.0, 0.15);
}

/* Velocity is that of the rigid motion, acceleration centripetal; a second later all is where it was in the turning
 * frame. */
static void goes_on_without_a_transient(void **state)
{
    static const blade_choice choices[] = {{5.0, 0.0, DMB_RZ, 1, 8, {0.0, 0.0, 0.0}, 1e8},
                                           {5.0, 0.4, DMB_RY, 2, 6, {0.4, 2.0, -0.9}, 1e8}};
    (void)state;
    for (int i = 0; i < 2; i++) {
        blade b;
        double before[3], after[3], reaction[6], later[6];
        open_blade(&b, choices + i);
        (void)turn(&b, DMB_STEADY_AUTO);
        const double speed = speed_of(choices + i);
        const dmb_place end = dmb_station(b.string, last_pipe(choices + i), 1.0);
        const dmb_motion motion = motion_at(&b.rig, end, DMB_FRAME_WORLD),
                         body = motion_at(&b.rig, end, DMB_FRAME_BODY);
        tip_in_the_frame_of_the_root(&b, last_pipe(choices + i), before);
        must(&b.rig, dmb_query_reaction(b.rig.sim, b.string, reaction));
        const double v = sqrt(pow(motion.velocity[0], 2) + pow(motion.velocity[1], 2) + pow(motion.velocity[2], 2));
        const double a =
            sqrt(pow(motion.acceleration[0], 2) + pow(motion.acceleration[1], 2) + pow(motion.acceleration[2], 2));
        check_relative("speed of the tip", v, speed * before[0], 1e-9);
        check_relative("acceleration of the tip", a, speed * v, 1e-6);
        check_below("rate of the body-frame velocity", largest(6, body.acceleration), 1e-5 * a);
        take_steps(&b.rig, 2e-3, 500);
        tip_in_the_frame_of_the_root(&b, last_pipe(choices + i), after);
        must(&b.rig, dmb_query_reaction(b.rig.sim, b.string, later));
        check_below("tip moves in the turning frame", largest_difference(3, before, after), 1e-9);
        check_below("reaction changes", largest_difference(6, reaction, later), 1e-7 * largest(6, reaction));
        rig_close(&b.rig);
    }
}

/* ---- Hinges, decay ----------------------------------------------------------------------------------------------- */

/* A slender rigid rod hinged at e from the axis: w^2 = W^2 (1 + 3 e/(2 L)) in flap, W^2 3 e/(2 L) in lag. The hub is a
 * body that is turned, or a joint to the ground is driven. */
static double hinged(double e, int lag, int by_joint, double speed, double length)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def def = dmb_string_def_default();
    dmb_body_def hub = dmb_body_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    def.position[0] = e;
    pipe.kind = DMB_PIPE_RIGID;
    pipe.length = length;
    pipe.outer_diameter = 2e-3;
    pipe.inner_diameter = 0.0;
    pipe.string = add_string(&s, &def);
    (void)add_pipes(&s, &pipe, 1);
    hub.free_mask = by_joint ? DMB_FREE_ALL : DMB_FREE_RZ;
    const dmb_id body = add_body(&s, &hub);
    dmb_joint_def hinge =
        joint_between(DMB_JOINT_REVOLUTE, dmb_station(body, 0, 0.0), dmb_station(pipe.string, 0, 0.0));
    hinge.origin_a[0] = e;
    hinge.axis_a[0] = 0.0;
    hinge.axis_a[lag ? 2 : 1] = 1.0;
    hinge.match = 1;
    (void)add_joint(&s, &hinge);
    if (by_joint) {
        const dmb_id none = {0, 0};
        dmb_joint_def bearing = joint_between(DMB_JOINT_REVOLUTE, dmb_station(none, 0, 0.0), dmb_station(body, 0, 0.0));
        bearing.axis_a[0] = 0.0;
        bearing.axis_a[2] = 1.0;
        bearing.match = 1;
        const dmb_id joint = add_joint(&s, &bearing);
        (void)add_simple_drive(&s, DMB_DRIVE_MOTION, joint, DMB_RX, add_constant(&s, speed));
    } else {
        (void)add_simple_drive(&s, DMB_DRIVE_MOTION, body, DMB_RZ, add_constant(&s, speed));
    }
    (void)rig_start(&s, NULL);
    const blade b = {s, pipe.string};
    assert_int_equal(turn(&b, DMB_STEADY_AUTO).steady, DMB_STEADY_RIGID);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 1);
    const double w = 2.0 * PI * frequency_at(modes, 0);
    dmb_modes_destroy(&modes);
    const dmb_pose before = pose_at(&s, dmb_station(pipe.string, 0, 1.0));
    for (int k = 0; k < 200; k++) must(&s, dmb_sim_step(s.sim, 5e-3, NULL));
    const dmb_pose after = pose_at(&s, dmb_station(pipe.string, 0, 1.0));
    check_close("distance from the axis goes on", hypot(after.position[0], after.position[1]),
                hypot(before.position[0], before.position[1]), 1e-9);
    rig_close(&s);
    return w;
}

static void hinged_rods(void **state)
{
    static const double offsets[] = {0.0, 0.2, 1.5};
    const double speed = 7.0, length = 2.0;
    (void)state;
    for (int i = 0; i < 6; i++) {
        const double e = offsets[i % 3];
        const int by_joint = i >= 3;
        check_relative("flap", hinged(e, 0, by_joint, speed, length), speed * sqrt(1.0 + 1.5 * e / length), 1e-5);
        if (e > 0.0) check_relative("lag", hinged(e, 1, by_joint, speed, length), speed * sqrt(1.5 * e / length), 1e-5);
    }
}

static int32_t until_the_start(void *context, double t, double out[3])
{
    (void)context;
    out[0] = t <= 0.0 ? 1.0 : 0.0;
    out[1] = out[2] = 0.0;
    return 0;
}

/* Bent out of its plane by a force that lets go at the start, the turning blade swings with its flap mode. */
static void decay_in_a_turning_run(void **state)
{
    const blade_choice c = {5.0, 0.0, DMB_RZ, 1, 8, {0.0, 0.0, 0.0}, 1e8};
    dmb_sim_options options = dmb_sim_options_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_pipe_def pipe = blade_pipe(&c);
    blade b;
    double mu[2], last, tip[3], first = 0.0, end = 0.0;
    uint32_t crossings = 0;
    (void)state;
    rig_open(&b.rig, 0.0, 0.0, 0.0);
    b.string = add_beam(&b.rig, &pipe, DMB_FREE_RZ);
    (void)add_simple_drive(&b.rig, DMB_DRIVE_MOTION, b.string, DMB_RZ, add_constant(&b.rig, speed_of(&c)));
    load.place = dmb_station(b.string, 0, 1.0);
    load.frame = DMB_FRAME_BODY;
    load.force[2] = 1.0;
    load.time_function = add_callback(&b.rig, until_the_start, NULL);
    (void)add_load(&b.rig, &load);
    options.spectral_radius = 1.0;
    (void)rig_start(&b.rig, &options);
    (void)turn(&b, DMB_STEADY_AUTO);
    lowest_two(&b, mu);
    const double w = mu[1] * sqrt(EI / MASS) / (LENGTH * LENGTH), h = 2.0 * PI / w / 200.0;
    tip_in_the_frame_of_the_root(&b, 0, tip);
    for (uint32_t k = 1; k < 8000; k++) { /* higher modes shift the first and last crossing */
        last = tip[2];
        take_steps(&b.rig, h, 1);
        tip_in_the_frame_of_the_root(&b, 0, tip);
        if (!(last < 0.0 && tip[2] >= 0.0)) continue;
        end = h * (k - tip[2] / (tip[2] - last));
        if (crossings++ == 0) first = end;
    }
    assert_true(crossings > 35);
    check_relative("flap in time", 2.0 * PI * (crossings - 1) / (end - first), w, 1e-3);
    rig_close(&b.rig);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flap_of_the_literature),
        cmocka_unit_test(flap_with_a_hub),
        cmocka_unit_test(flap_in_any_direction),
        cmocka_unit_test(extension_of_a_turning_bar),
        cmocka_unit_test(extension_of_the_spin_up_beam),
        cmocka_unit_test(goes_on_without_a_transient),
        cmocka_unit_test(hinged_rods),
        cmocka_unit_test(decay_in_a_turning_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
