/* A bit that cuts sideways: under a constant side force against the closed form of its drift with walk, steering by its
 * tilt against the tractrix and an independent integration, and the work that cutting takes. Equations: eq:bit.side. */
#include <string.h>

#include "drillmbd/scene.h"
#include "mechanism.h"
#include "ode.h"

static const double mass = 40.0, steer = 0.5, energy = 2e7, ratio = 0.6, radius = 0.05, walk = 0.3;

static double resistance(void)
{
    return 2.0 * PI * ratio * energy * radius / steer;
}

/* One rigid pipe, next to without mass, whose far end carries the bit. */
static dmb_id add_assembly(rig *s, int32_t start_free, double length, const double velocity[6], double walk_angle)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    string.follows_hole = 0;
    string.start_free = start_free;
    memcpy(string.velocity, velocity, sizeof string.velocity);
    const dmb_id id = add_string(s, &string);
    pipe.string = id;
    pipe.kind = DMB_PIPE_RIGID;
    pipe.length = length;
    pipe.section_mass = 1e-6;
    pipe.section_inertia[0] = pipe.section_inertia[1] = 1e-9;
    (void)add_pipes(s, &pipe, 1);
    bit.string = id;
    bit.mass = mass;
    bit.length = 0.2;
    bit.diameter = 0.0;
    bit.radius = radius;
    bit.intrinsic_energy = energy;
    bit.cutting_ratio = ratio;
    bit.side_cutting = steer;
    bit.walk_angle = walk_angle;
    strcpy(bit.name, "bit");
    must_model(s, dmb_model_add_bit(s->model, &bit, NULL));
    return id;
}

/* ---- Drift ------------------------------------------------------------------------------------------------------- */

typedef struct drift {
    double y, z;
    double rock, balance; /* [J] */
} drift;

/* Told of the bit: m a = F + the rock's force, which is eta times the speed it is cut at, turned by the walk angle. */
static void check_told(const rig *s, dmb_place place, double force, double spin)
{
    const double eta = resistance() / sqrt(spin * spin + 0.05 * 0.05);
    const dmb_motion motion = motion_at(s, place, DMB_FRAME_WORLD);
    const double *v = motion.velocity, *a = motion.acceleration;
    dmb_bit_state bit = dmb_bit_state_default();
    dmb_id id;
    must_model(s, dmb_model_find(s->model, DMB_PART_BIT, "bit", &id));
    must(s, dmb_query_bit(s->sim, id, &bit));
    check_relative("    speed it cuts sideways [m/s]", bit.side_speed, hypot(v[1], v[2]), 1e-12);
    check_relative("    force of the rock [N]", hypot(bit.side_force[1], bit.side_force[2]), eta * bit.side_speed,
                   1e-9);
    check_close("    against the speed and the walk [N m/s]", bit.side_force[1] * v[1] + bit.side_force[2] * v[2],
                -eta * bit.side_speed * bit.side_speed * cos(walk), 1e-9 * eta * bit.side_speed * bit.side_speed);
    check_close("    balance along y [N]", mass * a[1], force + bit.side_force[1], 1e-4 * force);
    check_close("    and along z [N]", mass * a[2], bit.side_force[2], 1e-4 * force);
    check_close("    nothing along the axis [N]", bit.side_force[0], 0.0, 1e-12 * force);
}

/* Free across its axis and about it, turning at `spin`, pushed along y. */
static drift pushed(double spin, double force, double time, double step)
{
    const double velocity[6] = {0.0, 0.0, 0.0, spin, 0.0, 0.0};
    const dmb_sim_options options = sharp_options(1.0, 1e-12);
    dmb_load_def load = dmb_load_def_default();
    drift d;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id id = add_assembly(&s, DMB_FREE_Y | DMB_FREE_Z | DMB_FREE_RX, 1.0, velocity, walk);
    load.place = dmb_station(id, 0, 0.0);
    load.force[1] = force;
    must_model(&s, dmb_model_add_load(s.model, &load, NULL));
    (void)mechanism_start(&s, &options);
    take_steps(&s, step, (uint32_t)lround(time / step));
    const dmb_pose pose = pose_at(&s, load.place);
    const dmb_energy e = energy_of(&s);
    d.y = pose.displacement[1];
    d.z = pose.displacement[2];
    d.rock = e.rock;
    d.balance = e.balance;
    check_told(&s, load.place, force, spin);
    rig_close(&s);
    return d;
}

/* m v' = F - eta exp(-i walk) v, complex in the plane: x = F/k (t - (1 - exp(-k t/m)) m/k), k = eta exp(-i walk). */
static void expected(double spin, double force, double t, double *y, double *z)
{
    const double eta = resistance() / sqrt(spin * spin + 0.05 * 0.05);
    const double a = eta * cos(walk), b = -eta * sin(walk), n = a * a + b * b;
    const double decay = exp(-a * t / mass), phase = -b * t / mass;
    const double u = 1.0 - decay * cos(phase), w = -decay * sin(phase);          /* 1 - exp(-k t/m) */
    const double p = mass * (u * a + w * b) / n, q = mass * (w * a - u * b) / n; /* times m/k */
    const double f = t - p, g = -q;
    *y = force * (f * a + g * b) / n;
    *z = force * (g * a - f * b) / n;
}

static void it_drifts_under_a_side_force(void **state)
{
    const double spin = 20.0, force = 5e3, time = 4e-4;
    double y, z;
    (void)state;
    expected(spin, force, time, &y, &z);
    const drift coarse = pushed(spin, force, time, 1e-5), fine = pushed(spin, force, time, 5e-6);
    const double rough = hypot(coarse.y - y, coarse.z - z), smooth = hypot(fine.y - y, fine.z - z);
    check_below("drift under a side force over itself", smooth / hypot(y, z), 2e-5);
    check_order("drift under a side force", rough, smooth, 2.0, 0.1);
    check_order("its energy balance", fabs(coarse.balance), fabs(fine.balance), 2.0, 0.2);
    check_relative("walk of the drift [rad]", atan2(fine.z, fine.y), atan2(z, y), 1e-3);
    assert_true(fine.rock > 0.0);
    /* Long after: v = F/eta, turned by the walk angle; at rest the rock creeps as at 0.05 rad/s. */
    const double rate = force * spin / resistance(), later = 2.0;
    const drift steady = pushed(spin, force, later, 1e-3);
    check_relative("side speed, steerability F w/(2 pi zeta eps a)", hypot(steady.y, steady.z) / later, rate, 1e-3);
    check_relative("walk angle [rad]", atan2(steady.z, steady.y), walk, 1e-3);
    const drift still = pushed(0.0, force, later, 1e-3);
    check_relative("creep of one that stands still", hypot(still.y, still.z) / later, force * 0.05 / resistance(),
                   1e-3);
}

/* ---- Steering ---------------------------------------------------------------------------------------------------- */

typedef struct tilting {
    double length, centre, inertia, eta;
} tilting;

/* x of the guided end, tilt, and their rates, in a plane. */
static void tilted(void *context, double t, const double *y, double *rate)
{
    const tilting *o = context;
    const double s = sin(y[1]), c = cos(y[1]), side = -y[2] * s + o->length * y[3];
    const double a = mass, b = -mass * o->centre * s, d = mass * o->centre * o->centre + o->inertia;
    const double p = mass * o->centre * y[3] * y[3] * c + o->eta * side * s, q = -o->eta * side * o->length;
    const double n = a * d - b * b;
    (void)t;
    rate[0] = y[2];
    rate[1] = y[3];
    rate[2] = (p * d - q * b) / n;
    rate[3] = (a * q - b * p) / n;
}

/* The rear end slides along x, the bit goes where it points: tilt grows as tan(t/2) = tan(t0/2) exp(x/L). */
static void its_tilt_builds_angle(void **state)
{
    const double L = 2.0, tilt = 0.02, speed = 0.05, time = 20.0;
    const double velocity[6] = {speed * cos(tilt), -speed * sin(tilt), 0.0, 0.0, 0.0, 0.0};
    const dmb_sim_options options = sharp_options(1.0, 1e-12);
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_string_def string = dmb_string_def_default();
    string.follows_hole = 0;
    string.start_free = DMB_FREE_ALL;
    string.rotation[2] = tilt;
    memcpy(string.velocity, velocity, sizeof velocity);
    const dmb_id id = add_string(&s, &string);
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.string = id;
    pipe.kind = DMB_PIPE_RIGID;
    pipe.length = L;
    pipe.section_mass = 1e-6;
    pipe.section_inertia[0] = pipe.section_inertia[1] = 1e-9;
    (void)add_pipes(&s, &pipe, 1);
    dmb_bit_def bit = dmb_bit_def_default();
    bit.string = id;
    bit.mass = mass;
    bit.length = 0.2;
    bit.diameter = 0.0;
    bit.radius = radius;
    bit.intrinsic_energy = energy;
    bit.cutting_ratio = ratio;
    bit.side_cutting = 1e3;
    must_model(&s, dmb_model_add_bit(s.model, &bit, NULL));
    dmb_joint_def joint =
        joint_between(DMB_JOINT_POINT_ON_LINE, dmb_station(ground_id, 0, 0.0), dmb_station(id, 0, 0.0));
    (void)add_joint(&s, &joint);
    (void)mechanism_start(&s, &options);
    take_steps(&s, 2e-3, (uint32_t)lround(time / 2e-3));
    const dmb_pose pose = pose_at(&s, dmb_station(id, 0, 0.0)), front = pose_at(&s, dmb_station(id, 0, 1.0));
    const double got = atan2(front.position[1] - pose.position[1], front.position[0] - pose.position[0]);
    const tilting o = {L, L + 0.1, mass * (3.0 * radius * radius + 0.04) / 12.0,
                       2.0 * PI * ratio * energy * radius / 1e3 / 0.05};
    double y[4] = {0.0, tilt, speed, 0.0};
    ode_solve(tilted, (void *)(uintptr_t)&o, 0.0, time, 400000, 4, y);
    check_relative("tilt against another integration [rad]", got, y[1], 1e-7);
    check_relative("tilt of the tractrix [rad]", tan(0.5 * got), tan(0.5 * tilt) * exp(pose.position[0] / L), 1e-4);
    assert_true(got > 1.5 * tilt);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_drifts_under_a_side_force),
        cmocka_unit_test(its_tilt_builds_angle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
