/* Joints that lock, open and close in a run: plastic impact of a two-bar pendulum against its closed form, free flight,
 * refusals that change nothing, and the energy ledger over every switch. Checks eq:joints.impulse. */
#include <string.h>

#include "mechanism.h"

static const double g = 9.81, length = 0.8, mass = 1.5, step = 1e-3;

static void expect_message(const rig *s, const char *text)
{
    if (strstr(dmb_sim_message(s->sim), text) == NULL)
        fail_msg("message without \"%s\": %s", text, dmb_sim_message(s->sim));
}

/* ---- Two bars hanging from a hinge ------------------------------------------------------------------------------- */

typedef struct pendulum {
    rig s;
    dmb_id bar[2], hinge[2];
} pendulum;

/* Laid out along x, let go from rest; the second hinge may be changed before it is added. */
static pendulum pendulum_of(const dmb_joint_def *like)
{
    pendulum p;
    const bar first = {{0.0, 0.0}, {length, 0.0}, mass}, second = {{length, 0.0}, {2.0 * length, 0.0}, mass};
    rig_open(&p.s, 0.0, 0.0, -g);
    p.bar[0] = add_bar(&p.s, &first);
    p.bar[1] = add_bar(&p.s, &second);
    p.hinge[0] = add_hinge(&p.s, "shoulder", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(p.bar[0], -0.5 * length));
    dmb_joint_def def =
        hinge_of("elbow", DMB_JOINT_REVOLUTE, pin_on(p.bar[0], 0.5 * length), pin_on(p.bar[1], -0.5 * length));
    if (like != NULL) {
        def.state = like->state;
        memcpy(def.stiffness, like->stiffness, sizeof def.stiffness);
        memcpy(def.rest, like->rest, sizeof def.rest);
    }
    p.hinge[1] = add_joint(&p.s, &def);
    (void)mechanism_start(&p.s, NULL);
    return p;
}

/* Mass matrix by the two angular speeds of the bars. */
static void pendulum_mass(double bend, double M[2][2])
{
    const double unit = mass * length * length;
    M[0][0] = 4.0 / 3.0 * unit;
    M[1][1] = unit / 3.0;
    M[0][1] = M[1][0] = 0.5 * unit * cos(bend);
}

static void bar_speeds(const pendulum *p, double w[2])
{
    w[0] = joint_at(&p->s, p->hinge[0]).speed[DMB_RX];
    w[1] = w[0] + joint_at(&p->s, p->hinge[1]).speed[DMB_RX];
}

static double energy_before_and_after(const pendulum *p, dmb_energy *before, int32_t state, int32_t wanted)
{
    *before = energy_of(&p->s);
    const int32_t status = dmb_sim_set_joint(p->s.sim, p->hinge[1], state);
    if (status != wanted) fail_msg("set_joint: %s: %s", dmb_status_name(status), dmb_sim_message(p->s.sim));
    const dmb_energy after = energy_of(&p->s);
    check_close("balance over the switch [J]", after.balance, before->balance, 1e-12);
    check_close("unexplained over the switch [J]", after.unexplained, before->unexplained, 1e-12);
    return after.impact - before->impact;
}

static void locking_is_a_plastic_impact(void **state)
{
    (void)state;
    pendulum p = pendulum_of(NULL);
    double M[2][2], w[2], got[2], sum = 0.0, all = 0.0, energy = 0.0;
    dmb_energy before;
    take_steps(&p.s, step, 300);
    const double bend = joint_at(&p.s, p.hinge[1]).position[DMB_RX];
    bar_speeds(&p, w);
    pendulum_mass(bend, M);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++) sum += M[i][k] * w[k], all += M[i][k], energy += 0.5 * w[i] * M[i][k] * w[k];
    const double impact = energy_before_and_after(&p, &before, DMB_JOINT_LOCKED, DMB_NOTE_PROJECTED);
    bar_speeds(&p, got);
    tell("speeds of the bars before [rad/s]: first", w[0]);
    tell("second", w[1]);
    check_relative("speed after locking", got[0], sum / all, 1e-11);
    check_relative("speed of the second bar", got[1], sum / all, 1e-11);
    check_relative("energy into impact", impact, energy - 0.5 * sum * sum / all, 1e-10);
    expect_message(&p.s, "joint 1 (elbow): speeds jumped by up to ");
    expect_message(&p.s, " m/s and ");
    expect_message(&p.s, " rad/s");
    take_steps(&p.s, step, 300);
    check_close("bend stays [rad]", joint_at(&p.s, p.hinge[1]).position[DMB_RX], bend, 1e-14);
    check_below("violation", statistics_of(&p.s).violation, 1e-14);
    tell("balance at the end over the energy lost", fabs(energy_of(&p.s).balance) / impact);
    rig_close(&p.s);
}

/* Locked and bent, the two bars are one rigid body: J w' = -m g sum of levers. */
static void locked_pendulum_is_one_body(void **state)
{
    (void)state;
    pendulum p = pendulum_of(NULL);
    double M[2][2], levers = 0.0, turning = 0.0;
    take_steps(&p.s, step, 300);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_LOCKED));
    for (int k = 0; k < 2; k++) {
        const dmb_joint_state shoulder = joint_at(&p.s, p.hinge[0]), elbow = joint_at(&p.s, p.hinge[1]);
        pendulum_mass(elbow.position[DMB_RX], M);
        levers = turning = 0.0;
        for (int i = 0; i < 2; i++) {
            levers += pose_at(&p.s, dmb_station(p.bar[i], 0, 0.0)).position[0];
            for (int j = 0; j < 2; j++) turning += M[i][j];
        }
        check_relative(k == 0 ? "acceleration at once" : "acceleration 0.2 s later", shoulder.acceleration[DMB_RX],
                       -mass * g * levers / turning, 1e-9);
        if (k == 0) take_steps(&p.s, step, 200);
    }
    rig_close(&p.s);
}

/* The reaction right after the switch belongs to the new equations: it carries the second bar. */
static double newton_violation(const pendulum *p)
{
    const dmb_motion motion = motion_at(&p->s, dmb_station(p->bar[1], 0, 0.0), DMB_FRAME_WORLD);
    const dmb_joint_state elbow = joint_at(&p->s, p->hinge[1]);
    double worst = 0.0;
    for (int i = 0; i < 3; i++) {
        const double force = mass * (motion.acceleration[i] + (i == 2 ? g : 0.0));
        worst = fmax(worst, fabs(force - elbow.reaction[i]));
    }
    return worst / (mass * g);
}

static void reactions_are_made_anew(void **state)
{
    (void)state;
    pendulum p = pendulum_of(NULL);
    take_steps(&p.s, step, 300);
    check_below("reaction against Newton's law before", newton_violation(&p), 1e-9);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_LOCKED));
    check_below("reaction against Newton's law, locked", newton_violation(&p), 1e-9);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_ACTIVE));
    check_below("reaction against Newton's law, released", newton_violation(&p), 1e-9);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_OPEN));
    check_below("reaction against Newton's law, open", newton_violation(&p), 1e-9);
    rig_close(&p.s);
}

static void releasing_changes_no_speed(void **state)
{
    (void)state;
    pendulum p = pendulum_of(NULL);
    double before[2], after[2];
    dmb_energy energy;
    take_steps(&p.s, step, 300);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_LOCKED));
    take_steps(&p.s, step, 100);
    bar_speeds(&p, before);
    /* of 15 J; the rows that go on hold to rounding already */
    check_below("energy into impact [J]", energy_before_and_after(&p, &energy, DMB_JOINT_ACTIVE, DMB_OK), 1e-14);
    bar_speeds(&p, after);
    check_below("jump of the speeds", largest_difference(2, before, after), 1e-13);
    take_steps(&p.s, step, 500);
    const dmb_energy end = energy_of(&p.s);
    const double total = end.kinetic + end.gravity + end.impact;
    check_below("energy at the end over the kinetic", total / end.kinetic, 2e-5);
    rig_close(&p.s);
}

/* ---- Open and closed --------------------------------------------------------------------------------------------- */

static void open_joint_lets_go(void **state)
{
    (void)state;
    pendulum p = pendulum_of(NULL);
    dmb_energy energy;
    take_steps(&p.s, step, 250);
    const dmb_place flies = dmb_station(p.bar[1], 0, 0.0);
    const dmb_motion before = motion_at(&p.s, flies, DMB_FRAME_WORLD);
    const dmb_pose from = pose_at(&p.s, flies);
    check_below("energy into impact [J]", energy_before_and_after(&p, &energy, DMB_JOINT_OPEN, DMB_OK), 1e-14);
    const dmb_motion after = motion_at(&p.s, flies, DMB_FRAME_WORLD);
    check_below("jump of the velocity", largest_difference(6, before.velocity, after.velocity), 0.0);
    check_close("acceleration [m/s2]", after.acceleration[2], -g, 1e-11);
    take_steps(&p.s, step, 400);
    const dmb_pose to = pose_at(&p.s, flies);
    const double t = 0.4;
    double want[3];
    for (int i = 0; i < 3; i++) want[i] = from.position[i] + t * before.velocity[i] - (i == 2 ? 0.5 * g * t * t : 0.0);
    check_below("place after 0.4 s of flight [m]", largest_difference(3, to.position, want), 1e-6);
    check_below("spin in flight", motion_at(&p.s, flies, DMB_FRAME_WORLD).velocity[4] - before.velocity[4], 1e-12);
    assert_int_equal(joint_at(&p.s, p.hinge[1]).constraint_rows, 0);
    rig_close(&p.s);
}

static void apart_cannot_close(void **state)
{
    (void)state;
    pendulum p = pendulum_of(NULL);
    take_steps(&p.s, step, 250);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_OPEN));
    take_steps(&p.s, step, 10);
    const uint64_t before = rig_hash(&p.s);
    const dmb_pose pose = pose_at(&p.s, dmb_station(p.bar[1], 0, 0.0));
    assert_int_equal(dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_ACTIVE), DMB_ERR_GEOMETRY);
    print_message("    said: %s\n", dmb_sim_message(p.s.sim));
    expect_message(&p.s, "joint 1 (elbow)");
    assert_true(rig_hash(&p.s) == before);
    const dmb_pose same = pose_at(&p.s, dmb_station(p.bar[1], 0, 0.0));
    check_below("pose after the refusal", largest_difference(3, same.position, pose.position), 0.0);
    pendulum twin = pendulum_of(NULL); /* goes on as if nothing had been asked */
    take_steps(&twin.s, step, 250);
    must(&twin.s, dmb_sim_set_joint(twin.s.sim, twin.hinge[1], DMB_JOINT_OPEN));
    take_steps(&twin.s, step, 60);
    take_steps(&p.s, step, 50);
    assert_true(rig_hash(&p.s) == rig_hash(&twin.s));
    rig_close(&twin.s);
    rig_close(&p.s);
}

/* Opened and closed at once: nothing has moved. Locked where it flies: it is held there. */
static void closing_again(void **state)
{
    (void)state;
    pendulum p = pendulum_of(NULL);
    dmb_energy energy;
    take_steps(&p.s, step, 250);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_OPEN));
    check_below("energy into impact [J]", energy_before_and_after(&p, &energy, DMB_JOINT_ACTIVE, DMB_OK), 1e-14);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_OPEN));
    take_steps(&p.s, step, 100);
    const dmb_joint_state flying = joint_at(&p.s, p.hinge[1]);
    (void)energy_before_and_after(&p, &energy, DMB_JOINT_LOCKED, DMB_NOTE_PROJECTED);
    take_steps(&p.s, step, 100);
    const dmb_joint_state held = joint_at(&p.s, p.hinge[1]);
    check_below("locked apart: coordinates stay", largest_difference(6, held.position, flying.position), 1e-13);
    check_below("locked apart: speeds", largest(6, held.speed), 1e-12);
    assert_int_equal(dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_ACTIVE), DMB_ERR_GEOMETRY);
    rig_close(&p.s);
}

/* A spring that is let go of takes its energy with it. */
static void spring_of_an_open_joint(void **state)
{
    (void)state;
    dmb_joint_def like = dmb_joint_def_default();
    like.stiffness[DMB_RX] = 20.0;
    like.rest[DMB_RX] = 1.0;
    pendulum p = pendulum_of(&like);
    dmb_energy before;
    take_steps(&p.s, step, 150);
    const double impact = energy_before_and_after(&p, &before, DMB_JOINT_OPEN, DMB_OK);
    tell("strain before [J]", before.strain);
    check_relative("strain that went to impact", impact, before.strain, 1e-12);
    check_below("strain after", energy_of(&p.s).strain, 0.0);
    check_below("action of an open joint", largest(6, joint_at(&p.s, p.hinge[1]).action), 0.0);
    rig_close(&p.s);
}

/* ---- State ------------------------------------------------------------------------------------------------------- */

static void run_on(pendulum *p, uint32_t n)
{
    take_steps(&p->s, step, n);
}

static void states_survive_snapshots(void **state)
{
    (void)state;
    static unsigned char block[1 << 16];
    for (int32_t to = DMB_JOINT_ACTIVE; to <= DMB_JOINT_OPEN; to++) {
        pendulum p = pendulum_of(NULL);
        dmb_sim *fresh = NULL;
        size_t size = 0;
        run_on(&p, 200);
        must(&p.s, dmb_sim_set_joint(p.s.sim, p.hinge[1], to));
        run_on(&p, 50);
        must(&p.s, dmb_sim_snapshot_size(p.s.sim, &size));
        assert_true(size <= sizeof block);
        must(&p.s, dmb_sim_snapshot(p.s.sim, block, size));
        run_on(&p, 300);
        const uint64_t end = rig_hash(&p.s);
        assert_true(dmb_sim_create(p.s.model, NULL, &fresh) >= 0);
        dmb_sim *old = p.s.sim;
        p.s.sim = fresh;
        run_on(&p, 7);
        must(&p.s, dmb_sim_restore(p.s.sim, block, size));
        run_on(&p, 300);
        assert_true(rig_hash(&p.s) == end);
        assert_int_equal(joint_at(&p.s, p.hinge[1]).state, to);
        dmb_sim_destroy(&old);
        rig_close(&p.s);
    }
    print_message("    restored sims go on bit for bit in all three states\n");
}

static void same_state_is_no_change(void **state)
{
    (void)state;
    pendulum p = pendulum_of(NULL);
    run_on(&p, 100);
    const uint64_t before = rig_hash(&p.s);
    assert_int_equal(dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_ACTIVE), DMB_OK);
    assert_true(rig_hash(&p.s) == before);
    assert_int_equal(dmb_sim_set_joint(p.s.sim, p.hinge[1], 3), DMB_ERR_VALUE);
    assert_int_equal(dmb_sim_set_joint(p.s.sim, p.hinge[1], -1), DMB_ERR_VALUE);
    assert_int_equal(dmb_sim_set_joint(p.s.sim, p.bar[1], DMB_JOINT_OPEN), DMB_ERR_ID);
    assert_true(rig_hash(&p.s) == before);
    rig_close(&p.s);
}

static void described_locked(void **state)
{
    (void)state;
    dmb_joint_def like = dmb_joint_def_default();
    like.state = DMB_JOINT_LOCKED;
    pendulum p = pendulum_of(&like);
    double M[2][2];
    pendulum_mass(0.0, M);
    const double turning = M[0][0] + 2.0 * M[0][1] + M[1][1];
    assert_int_equal(joint_at(&p.s, p.hinge[1]).state, DMB_JOINT_LOCKED);
    assert_int_equal(joint_at(&p.s, p.hinge[1]).constraint_rows, 6);
    check_relative("one bar of twice the length: first acceleration", joint_at(&p.s, p.hinge[0]).acceleration[DMB_RX],
                   -2.0 * mass * g * length / turning, 1e-12);
    take_steps(&p.s, step, 300);
    check_below("bend [rad]", joint_at(&p.s, p.hinge[1]).position[DMB_RX], 1e-14);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_ACTIVE));
    take_steps(&p.s, step, 300);
    assert_true(fabs(joint_at(&p.s, p.hinge[1]).position[DMB_RX]) > 1e-3);
    rig_close(&p.s);
}

static void described_open(void **state)
{
    (void)state;
    dmb_joint_def like = dmb_joint_def_default();
    like.state = DMB_JOINT_OPEN;
    pendulum p = pendulum_of(&like);
    assert_int_equal(joint_at(&p.s, p.hinge[1]).constraint_rows, 0);
    take_steps(&p.s, step, 200);
    const dmb_pose pose = pose_at(&p.s, dmb_station(p.bar[1], 0, 0.0));
    check_close("height of the free bar [m]", pose.position[2], -0.5 * g * 0.04, 1e-12);
    assert_int_equal(dmb_sim_set_joint(p.s.sim, p.hinge[1], DMB_JOINT_ACTIVE), DMB_ERR_GEOMETRY);
    rig_close(&p.s);
}

/* ---- Drives and couplings ---------------------------------------------------------------------------------------- */

/* A wheel about world -y through its centre, no gravity; driven at h0, then h1 after 0.1 .. 0.2 s. */
typedef struct wheel {
    rig s;
    dmb_id body, joint, drive;
} wheel;

static wheel wheel_of(int32_t kind, double h0, double h1)
{
    wheel w;
    const bar disc = {{0.0, 0.0}, {length, 0.0}, mass};
    dmb_segment term = dmb_segment_default();
    rig_open(&w.s, 0.0, 0.0, 0.0);
    w.body = add_bar(&w.s, &disc);
    w.joint = add_hinge(&w.s, "axle", DMB_JOINT_REVOLUTE, pin_ground(0.5 * length, 0.0), pin_on(w.body, 0.0));
    term.kind = DMB_SEGMENT_STEP;
    term.x0 = 0.1;
    term.x1 = 0.2;
    term.h0 = h0;
    term.h1 = h1;
    w.drive = add_simple_drive(&w.s, kind, w.joint, DMB_RX, add_time_function(&w.s, &term, 1));
    (void)mechanism_start(&w.s, NULL);
    return w;
}

static dmb_drive_state drive_at(const wheel *w)
{
    dmb_drive_state drive = dmb_drive_state_default();
    must(&w->s, dmb_query_drive(w->s.sim, w->drive, &drive));
    return drive;
}

/* A motion drive that moves cannot be locked. */
static void driven_joint_cannot_lock(void **state)
{
    (void)state;
    wheel w = wheel_of(DMB_DRIVE_MOTION, 3.0, 3.0);
    take_steps(&w.s, step, 50);
    const uint64_t before = rig_hash(&w.s);
    assert_int_equal(dmb_sim_set_joint(w.s.sim, w.joint, DMB_JOINT_LOCKED), DMB_ERR_GEOMETRY);
    print_message("    said: %s\n", dmb_sim_message(w.s.sim));
    expect_message(&w.s, "drive 0");
    assert_true(rig_hash(&w.s) == before);
    take_steps(&w.s, step, 50);
    check_close("angle after 0.1 s [rad]", joint_at(&w.s, w.joint).position[DMB_RX], 0.3, 1e-13);
    rig_close(&w.s);
}

/* At rest it can; the step in which the time function starts to move is refused, and the joint can be released. */
static void driven_joint_locked_at_rest(void **state)
{
    (void)state;
    wheel w = wheel_of(DMB_DRIVE_MOTION, 0.0, 2.0);
    take_steps(&w.s, step, 50);
    must(&w.s, dmb_sim_set_joint(w.s.sim, w.joint, DMB_JOINT_LOCKED));
    take_steps(&w.s, step, 50);
    int32_t status = DMB_OK;
    uint64_t before = 0;
    for (int i = 0; i < 100 && status >= 0; i++) {
        before = rig_hash(&w.s);
        status = dmb_sim_step(w.s.sim, step, NULL);
    }
    print_message("    %s at %g s: %s\n", dmb_status_name(status), dmb_sim_time(w.s.sim), dmb_sim_message(w.s.sim));
    assert_int_equal(status, DMB_ERR_SINGULAR);
    expect_message(&w.s, "drive 0");
    assert_true(rig_hash(&w.s) == before);
    must(&w.s, dmb_sim_set_joint(w.s.sim, w.joint, DMB_JOINT_ACTIVE));
    while (dmb_sim_time(w.s.sim) < 0.3 - 0.5 * step) must(&w.s, dmb_sim_step(w.s.sim, step, NULL));
    check_close("speed at the end [rad/s]", joint_at(&w.s, w.joint).speed[DMB_RX], 2.0, 1e-12);
    rig_close(&w.s);
}

/* Open, the drive does nothing; closed again, it goes on from where the coordinate is. */
static void driven_joint_opens_and_closes(void **state)
{
    (void)state;
    wheel w = wheel_of(DMB_DRIVE_MOTION, 3.0, 4.0);
    take_steps(&w.s, step, 50);
    must(&w.s, dmb_sim_set_joint(w.s.sim, w.joint, DMB_JOINT_OPEN));
    take_steps(&w.s, step, 250);
    const double angle = joint_at(&w.s, w.joint).position[DMB_RX];
    check_close("angle of the free wheel [rad]", angle, 0.9, 1e-12);
    check_close("position that the drive tells", drive_at(&w).position, 0.9, 1e-12);
    check_close("speed that the drive tells", drive_at(&w).speed, 3.0, 1e-12);
    check_below("force of the idle drive", drive_at(&w).force, 0.0);
    const dmb_energy before = energy_of(&w.s);
    assert_int_equal(dmb_sim_set_joint(w.s.sim, w.joint, DMB_JOINT_ACTIVE), DMB_NOTE_PROJECTED);
    check_close("balance over the switch [J]", energy_of(&w.s).balance, before.balance, 1e-12);
    check_close("angle when closed [rad]", joint_at(&w.s, w.joint).position[DMB_RX], angle, 1e-12);
    check_close("speed when closed [rad/s]", joint_at(&w.s, w.joint).speed[DMB_RX], 4.0, 1e-12);
    take_steps(&w.s, step, 100);
    check_close("angle 0.1 s later [rad]", joint_at(&w.s, w.joint).position[DMB_RX], 1.3, 1e-12);
    check_close("position that the drive tells", drive_at(&w).position, 1.3, 1e-12);
    rig_close(&w.s);
}

/* A torque on a joint that is locked does no work; opened, it does not act. */
static void torque_on_a_switched_joint(void **state)
{
    (void)state;
    wheel w = wheel_of(DMB_DRIVE_LOAD, 0.7, 0.7);
    const double J = mass * length * length / 12.0;
    take_steps(&w.s, step, 100);
    check_relative("speed by the torque", joint_at(&w.s, w.joint).speed[DMB_RX], 0.07 / J, 1e-12);
    const double work = drive_at(&w).work;
    check_relative("work", work, 0.5 * 0.07 * 0.07 / J, 1e-9);
    must(&w.s, dmb_sim_set_joint(w.s.sim, w.joint, DMB_JOINT_LOCKED));
    check_below("speed that the drive tells, locked", drive_at(&w).speed, 1e-15);
    take_steps(&w.s, step, 100);
    check_close("work while locked [J]", drive_at(&w).work, work, 1e-15);
    check_relative("torque of the lock", joint_at(&w.s, w.joint).reaction[4], 0.7, 1e-12);
    must(&w.s, dmb_sim_set_joint(w.s.sim, w.joint, DMB_JOINT_OPEN));
    take_steps(&w.s, step, 100);
    check_below("speed while open [rad/s]", joint_at(&w.s, w.joint).speed[DMB_RX], 1e-14);
    check_below("force while open [N m]", drive_at(&w).force, 0.0);
    check_close("work while open [J]", drive_at(&w).work, work, 1e-15);
    check_below("balance", energy_of(&w.s).balance, 1e-9 * work);
    rig_close(&w.s);
}

/* A gear whose wheel was open and has turned on no longer meshes: refused, naming the coupling. */
static void gear_that_has_slipped(void **state)
{
    (void)state;
    rig s;
    dmb_id body[2], joint[2];
    dmb_coupling_def gear = dmb_coupling_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 2; i++) {
        const bar disc = {{3.0 * i, 0.0}, {3.0 * i + length, 0.0}, mass};
        body[i] = add_bar(&s, &disc);
        dmb_joint_def def = hinge_of(i == 0 ? "pinion" : "wheel", DMB_JOINT_REVOLUTE,
                                     pin_ground(3.0 * i + 0.5 * length, 0.0), pin_on(body[i], 0.0));
        def.initial_mask = i == 0 ? DMB_FREE_RX : DMB_FREE_NONE;
        def.initial_speed[DMB_RX] = 2.0;
        joint[i] = gear.joint[i] = add_joint(&s, &def);
    }
    memcpy(gear.name, "gear", 5);
    gear.ratio = -2.0;
    must_model(&s, dmb_model_add_coupling(s.model, &gear, NULL));
    (void)mechanism_start(&s, NULL);
    take_steps(&s, step, 20);
    must(&s, dmb_sim_set_joint(s.sim, joint[1], DMB_JOINT_OPEN));
    must(&s, dmb_sim_set_joint(s.sim, joint[1], DMB_JOINT_ACTIVE)); /* nothing has turned yet */
    must(&s, dmb_sim_set_joint(s.sim, joint[1], DMB_JOINT_OPEN));
    must(&s, dmb_sim_set_joint(s.sim, joint[0], DMB_JOINT_LOCKED));
    take_steps(&s, step, 50);
    must(&s, dmb_sim_set_joint(s.sim, joint[0], DMB_JOINT_ACTIVE));
    const uint64_t before = rig_hash(&s);
    assert_int_equal(dmb_sim_set_joint(s.sim, joint[1], DMB_JOINT_ACTIVE), DMB_ERR_GEOMETRY);
    print_message("    said: %s\n", dmb_sim_message(s.sim));
    expect_message(&s, "coupling 0 (gear)");
    assert_true(rig_hash(&s) == before);
    rig_close(&s);
}

/* ---- Jumps of a force -------------------------------------------------------------------------------------------- */

/* A caller's sphere whose callback fails from its n-th call on. */
typedef struct sphere {
    int64_t calls, fails_at;
} sphere;

static int32_t on_sphere(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                         double *jacobian)
{
    sphere *with = context;
    const double *x = poses[0];
    (void)time, (void)count, (void)jacobian;
    value[0] = 0.5 * (x[0] * x[0] + x[1] * x[1] + (x[2] - 9.0) * (x[2] - 9.0) - 1.0);
    return with->calls++ >= with->fails_at;
}

typedef struct jumper {
    rig s;
    sphere with;
    dmb_id drive;
} jumper;

/* Two bars that swing, a torque on their elbow that has a corner after 0.05 s, and a ball on the sphere. */
static void open_jumper(jumper *t)
{
    const bar first = {{0.0, 0.0}, {length, 0.0}, mass}, second = {{length, 0.0}, {2.0 * length, 0.0}, mass};
    dmb_constraint_def shell = dmb_constraint_def_default();
    dmb_body_def ball = dmb_body_def_default();
    static const double time[3] = {0.0, 0.05, 0.4}, speed[3] = {0.0, 0.0, 2.0};
    dmb_segment term = dmb_segment_default();
    rig_open(&t->s, 0.0, 0.0, -g);
    const dmb_id a = add_bar(&t->s, &first), b = add_bar(&t->s, &second);
    const dmb_id shoulder = add_hinge(&t->s, "", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(a, -0.5 * length));
    const dmb_id elbow = add_hinge(&t->s, "", DMB_JOINT_REVOLUTE, pin_on(a, 0.5 * length), pin_on(b, -0.5 * length));
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = time;
    term.table_value = speed;
    term.table_count = 3;
    (void)add_simple_drive(&t->s, DMB_DRIVE_MOTION, shoulder, DMB_RX, add_time_function(&t->s, &term, 1));
    t->drive = add_simple_drive(&t->s, DMB_DRIVE_LOAD, elbow, DMB_RX, add_constant(&t->s, 0.5));
    ball.position[0] = 1.0;
    ball.position[2] = 9.0;
    shell.place[0] = dmb_station(add_body(&t->s, &ball), 0, 0.0);
    memcpy(shell.name, "shell", 6);
    shell.callback = on_sphere;
    shell.callback_context = &t->with;
    must_model(&t->s, dmb_model_add_constraint(t->s.model, &shell, NULL));
    t->with.calls = 0;
    t->with.fails_at = INT64_MAX;
    (void)mechanism_start(&t->s, NULL);
}

/* Wherever the callback fails, set_drive leaves everything as it was. */
static void refused_jump_changes_nothing(void **state)
{
    (void)state;
    jumper one, twin;
    int32_t status = DMB_OK;
    int64_t n = 0;
    open_jumper(&one);
    take_steps(&one.s, step, 480); /* another partition would suit the ball by now */
    const uint64_t before = rig_hash(&one.s);
    for (one.with.fails_at = one.with.calls; n == 0 || status < 0; one.with.fails_at = one.with.calls + ++n) {
        status = dmb_sim_set_drive(one.s.sim, one.drive, 3.0);
        if (status >= 0) break;
        assert_int_equal(status, DMB_ERR_CALLBACK);
        expect_message(&one.s, "constraint 0 (shell)");
        assert_true(rig_hash(&one.s) == before);
    }
    tell("calls of one jump", (double)n);
    assert_true(n > 10);
    one.with.fails_at = INT64_MAX;
    open_jumper(&twin);
    take_steps(&twin.s, step, 480);
    must(&twin.s, dmb_sim_set_drive(twin.s.sim, twin.drive, 3.0));
    take_steps(&twin.s, step, 200);
    take_steps(&one.s, step, 200);
    assert_true(rig_hash(&one.s) == rig_hash(&twin.s));
    rig_close(&twin.s);
    rig_close(&one.s);
}

/* Rounding at jumps of forces and corners of time functions does not count as a correction of the initial velocities.
 */
static void jumps_are_no_projection(void **state)
{
    (void)state;
    jumper t;
    open_jumper(&t);
    const dmb_statistics start = statistics_of(&t.s);
    for (int i = 0; i < 20; i++) {
        take_steps(&t.s, step, 30);
        must(&t.s, dmb_sim_set_drive(t.s.sim, t.drive, i % 2 ? 1.0 : -1.0));
    }
    check_below("projection beyond that of the start",
                largest_difference(2, statistics_of(&t.s).projection, start.projection), 0.0);
    rig_close(&t.s);
}

/* ---- On the axis of a hole --------------------------------------------------------------------------------------- */

/* A ball that slides down a curved hole is held where it is locked, and slides on from there. */
static void bead_in_a_curved_hole(void **state)
{
    (void)state;
    static const double survey[9] = {0.0, 0.2, 0.0, 10.0, 0.7, 0.3, 40.0, 1.6, 1.2};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def ball = dmb_body_def_default();
    dmb_joint_def def = dmb_joint_def_default();
    static unsigned char block[1 << 16];
    size_t size = 0;
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    wall.survey = survey;
    wall.survey_count = 3;
    wall.normal_law = DMB_NORMAL_NONE;
    (void)add_wall(&s, &wall);
    ball.position[0] = 1.0;
    ball.position[2] = -5.0;
    ball.mass = mass;
    const dmb_id body = add_body(&s, &ball);
    def.kind = DMB_JOINT_POINT_ON_HOLE;
    def.place_b = dmb_station(body, 0, 0.0);
    const dmb_id joint = add_joint(&s, &def);
    (void)mechanism_start(&s, NULL);
    const double start = energy_of(&s).gravity; /* put onto the axis, it is not where it was described */
    take_steps(&s, step, 1000);
    const dmb_energy sliding = energy_of(&s);
    check_below("sliding: energy over the kinetic", (sliding.kinetic + sliding.gravity - start) / sliding.kinetic,
                1e-5);
    check_below("violation", joint_at(&s, joint).violation, 1e-13);
    must(&s, dmb_sim_set_joint(s.sim, joint, DMB_JOINT_LOCKED));
    check_relative("kinetic energy into impact", energy_of(&s).impact, sliding.kinetic, 1e-12);
    const dmb_pose held = pose_at(&s, dmb_station(body, 0, 0.0));
    take_steps(&s, step, 500);
    must(&s, dmb_sim_snapshot_size(s.sim, &size));
    assert_true(size <= sizeof block);
    must(&s, dmb_sim_snapshot(s.sim, block, size));
    take_steps(&s, step, 500);
    const uint64_t later = rig_hash(&s);
    const dmb_pose still = pose_at(&s, dmb_station(body, 0, 0.0));
    check_below("locked for 1 s: way along the hole [m]", largest_difference(3, held.position, still.position), 1e-13);
    const double weight[3] = {0.0, 0.0, mass * g};
    check_below("the lock carries the weight [N]", largest_difference(3, joint_at(&s, joint).reaction, weight), 1e-11);
    must(&s, dmb_sim_restore(s.sim, block, size));
    take_steps(&s, step, 500);
    assert_true(rig_hash(&s) == later);
    must(&s, dmb_sim_set_joint(s.sim, joint, DMB_JOINT_ACTIVE));
    const dmb_energy rest = energy_of(&s);
    take_steps(&s, step, 500);
    const dmb_energy end = energy_of(&s);
    check_below("sliding on: energy over the kinetic", (end.kinetic + end.gravity - rest.gravity) / end.kinetic, 1e-5);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(locking_is_a_plastic_impact),
        cmocka_unit_test(locked_pendulum_is_one_body),
        cmocka_unit_test(reactions_are_made_anew),
        cmocka_unit_test(releasing_changes_no_speed),
        cmocka_unit_test(open_joint_lets_go),
        cmocka_unit_test(apart_cannot_close),
        cmocka_unit_test(closing_again),
        cmocka_unit_test(spring_of_an_open_joint),
        cmocka_unit_test(states_survive_snapshots),
        cmocka_unit_test(same_state_is_no_change),
        cmocka_unit_test(described_locked),
        cmocka_unit_test(described_open),
        cmocka_unit_test(driven_joint_cannot_lock),
        cmocka_unit_test(driven_joint_locked_at_rest),
        cmocka_unit_test(driven_joint_opens_and_closes),
        cmocka_unit_test(torque_on_a_switched_joint),
        cmocka_unit_test(gear_that_has_slipped),
        cmocka_unit_test(refused_jump_changes_nothing),
        cmocka_unit_test(jumps_are_no_projection),
        cmocka_unit_test(bead_in_a_curved_hole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
