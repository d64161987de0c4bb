/* Rods added and taken off at the rig end in the course of a run: what is matched stays as it is, what is added comes
 * along, and the ledger goes on. */
#include <string.h>

#include "hash.h"
#include "rig.h"

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

typedef struct choice {
    uint32_t pipes;
    int32_t kind;      /* DMB_PIPE_... */
    int32_t load;      /* 1: a force at the far end for 0.05 s */
    double start;      /* [m] the rig end is described this far along */
    double gravity;    /* [m/s2] */
    double speed;      /* [m/s, rad/s] of the drives of the rig */
    int32_t curved;    /* 1: the hole bends in space */
    int32_t friction;  /* DMB_FRICTION_... */
    int32_t rock;      /* DMB_ROCK_... */
    uint32_t elements; /* in a pipe */
    double eccentricity;
    double bend; /* of the unstressed pipes, and of their flight */
} choice;

typedef struct scene {
    rig r;
    dmb_id string, feed, motor, bit, joint, head;
} scene;

static void add_pulse(scene *s)
{
    dmb_segment rise = dmb_segment_default(), fall = dmb_segment_default();
    dmb_load_def load = dmb_load_def_default();
    rise.kind = fall.kind = DMB_SEGMENT_STEP;
    rise.x1 = 0.05, rise.h1 = 1.0;
    fall.x0 = 0.05, fall.x1 = 0.1, fall.h1 = -1.0;
    const dmb_segment terms[2] = {rise, fall};
    load.time_function = add_time_function(&s->r, terms, 2);
    load.place = dmb_station(s->string, 0, 1.0);
    load.frame = DMB_FRAME_BODY;
    load.force[1] = 400.0, load.force[2] = -200.0, load.moment[0] = 60.0;
    (void)add_load(&s->r, &load);
}

static void bend_pipe(const choice *c, dmb_pipe_def *pipe)
{
    if (c->kind == DMB_PIPE_RIGID) return;
    pipe->curvature[0] = c->bend;
    if (c->kind == DMB_PIPE_FLEXIBLE) pipe->curvature[1] = -0.5 * c->bend;
}

/* A straight string in free space, turned out of the world's axes, with tool joints. */
static scene flight_of(const choice *c)
{
    scene s;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    memset(&s, 0, sizeof s);
    rig_open(&s.r, 0.0, 0.0, -c->gravity);
    string.follows_hole = 0;
    string.start_free = string.end_free = DMB_FREE_ALL;
    string.position[0] = 100.0, string.position[1] = -3.0;
    string.rotation[0] = 0.4, string.rotation[1] = -0.3, string.rotation[2] = 1.1;
    string.velocity[0] = 1.5, string.velocity[1] = -0.2, string.velocity[2] = 0.7, string.velocity[3] = 20.0;
    string.velocity[4] = 3.0 * c->bend;
    s.string = add_string(&s.r, &string);
    pipe.kind = c->kind;
    pipe.elements = c->elements;
    pipe.joint_length = 0.2;
    pipe.joint_outer_diameter = 0.08;
    pipe.eccentricity = c->eccentricity;
    bend_pipe(c, &pipe);
    (void)add_pipes(&s.r, &pipe, c->pipes);
    if (c->load) add_pulse(&s);
    (void)rig_start(&s.r, NULL);
    return s;
}

/* Up to speed within 0.05 s, down from 0.3 s to 0.35 s, up again from 0.4 s on. */
static dmb_id add_stop_and_go(rig *r, double speed)
{
    static const double time[3] = {0.0, 0.3, 0.4};
    dmb_segment terms[3];
    for (int i = 0; i < 3; i++) {
        terms[i] = dmb_segment_default();
        terms[i].kind = DMB_SEGMENT_STEP;
        terms[i].x0 = time[i];
        terms[i].x1 = time[i] + 0.05;
        terms[i].h1 = i == 1 ? -speed : speed;
    }
    return add_time_function(r, terms, 3);
}

static void add_hole(scene *s, const choice *c)
{
    static const double survey[12] = {-1.0, 1.5, 0.0, 2.0, 1.48, 0.01, 6.0, 1.44, 0.05, 40.0, 1.3, 0.0};
    dmb_wall_def wall = s1_hole();
    wall.friction_law = c->friction;
    if (c->curved) {
        wall.survey = survey;
        wall.survey_count = 4;
    }
    (void)add_wall(&s->r, &wall);
}

static scene rig_of(const choice *c)
{
    scene s;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_body_def head = dmb_body_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    memset(&s, 0, sizeof s);
    rig_open(&s.r, 0.0, 0.0, -c->gravity);
    add_hole(&s, c);
    string.start_depth = c->start;
    s.string = add_string(&s.r, &string);
    pipe.kind = c->kind;
    pipe.elements = c->elements;
    pipe.damping_time = 1e-4;
    bend_pipe(c, &pipe);
    (void)add_pipes(&s.r, &pipe, c->pipes);
    head.attach = DMB_ATTACH_START;
    head.mass = 40.0;
    (void)add_body(&s.r, &head);
    bit.rock_law = c->rock;
    must_model(&s.r, dmb_model_add_bit(s.r.model, &bit, &s.bit));
    s.feed = add_simple_drive(&s.r, DMB_DRIVE_MOTION, s.string, DMB_X, add_stop_and_go(&s.r, 0.01 * c->speed));
    s.motor = add_simple_drive(&s.r, DMB_DRIVE_MOTION, s.string, DMB_RX, add_stop_and_go(&s.r, 10.0 * c->speed));
    (void)rig_start(&s.r, NULL);
    return s;
}

static const choice flight = {3,  DMB_PIPE_FLEXIBLE, 0, 0.0, 0.0, 1.0, 0, DMB_FRICTION_STRIBECK, DMB_ROCK_NONE, 2, 0.0,
                              0.0};
static const choice drilling = {
    3, DMB_PIPE_FLEXIBLE, 0, 0.0, 9.81, 1.0, 0, DMB_FRICTION_STRIBECK, DMB_ROCK_REGENERATIVE, 2, 0.0, 0.0};

static choice with_pipes(choice c, uint32_t pipes)
{
    c.pipes = pipes;
    return c;
}

static int32_t go_over(scene *to, const scene *from)
{
    const int32_t status = dmb_sim_transfer_state(to->r.sim, from->r.sim);
    if (status < 0) fail_msg("state transfer: %s: %s", dmb_status_name(status), dmb_sim_message(to->r.sim));
    return status;
}

/* ---- Comparisons ------------------------------------------------------------------------------------------------- */

/* Quarters of the common pipes of two scenes, counted from the far end. */
static void places(const scene *a, uint32_t pipes_a, const scene *b, uint32_t pipes_b, uint32_t i, dmb_place place[2])
{
    const uint32_t common = pipes_a < pipes_b ? pipes_a : pipes_b;
    const double fraction = 0.25 * (i % 4 + 1);
    place[0] = dmb_station(a->string, pipes_a - common + i / 4, fraction);
    place[1] = dmb_station(b->string, pipes_b - common + i / 4, fraction);
}

/* Largest difference of positions, rotations and turns. */
static double poses_apart(const scene *a, uint32_t pipes_a, const scene *b, uint32_t pipes_b)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < 4 * (pipes_a < pipes_b ? pipes_a : pipes_b); i++) {
        dmb_place at[2];
        places(a, pipes_a, b, pipes_b, i, at);
        const dmb_pose p = pose_at(&a->r, at[0]), q = pose_at(&b->r, at[1]);
        worst = fmax(worst, largest_difference(3, p.position, q.position));
        worst = fmax(worst, largest_difference(9, p.rotation, q.rotation));
        worst = fmax(worst, fabs(rotation_at(&a->r, at[0]) - rotation_at(&b->r, at[1])));
    }
    return worst;
}

/* And of speeds. */
static double apart(const scene *a, uint32_t pipes_a, const scene *b, uint32_t pipes_b)
{
    double worst = poses_apart(a, pipes_a, b, pipes_b);
    for (uint32_t i = 0; i < 4 * (pipes_a < pipes_b ? pipes_a : pipes_b); i++) {
        dmb_place at[2];
        places(a, pipes_a, b, pipes_b, i, at);
        const dmb_motion v = motion_at(&a->r, at[0], DMB_FRAME_BODY), w = motion_at(&b->r, at[1], DMB_FRAME_BODY);
        worst = fmax(worst, largest_difference(6, v.velocity, w.velocity));
    }
    return worst;
}

/* Largest difference of section loads and of strains, over the stiffness of the section. */
static double stress_apart(const scene *a, uint32_t pipes_a, const scene *b, uint32_t pipes_b, int32_t forces)
{
    const uint32_t common = pipes_a < pipes_b ? pipes_a : pipes_b;
    const double EA = s1_values().EA;
    double worst = 0.0;
    for (uint32_t i = 0; i < common; i++) {
        dmb_section s = dmb_section_default(), t = dmb_section_default();
        must(&a->r, dmb_query_section(a->r.sim, dmb_station(a->string, pipes_a - common + i, 0.4), &s));
        must(&b->r, dmb_query_section(b->r.sim, dmb_station(b->string, pipes_b - common + i, 0.4), &t));
        worst = fmax(worst, largest_difference(6, s.strain, t.strain));
        if (forces) worst = fmax(worst, largest_difference(6, s.force, t.force) / EA);
    }
    return worst;
}

/* Work done and the gap in the ledger stay the same; only stored energy may have changed. */
static void check_ledger(const dmb_energy *a, const dmb_energy *b)
{
    const double stored = fabs(a->kinetic) + fabs(a->strain) + fabs(a->gravity) + fabs(a->contact);
    const double x[7] = {a->input, a->drives, a->loads, a->friction, a->impact, a->damping, a->rock};
    const double y[7] = {b->input, b->drives, b->loads, b->friction, b->impact, b->damping, b->rock};
    const double open_a[3] = {a->balance, a->scheme, a->unexplained};
    const double open_b[3] = {b->balance, b->scheme, b->unexplained};
    check_below("works of the ledger [J]", largest_difference(7, x, y), 0.0);
    check_below("its balance [J]", largest_difference(3, open_a, open_b), 1e-12 * (stored + a->input) + 1e-15);
    check_below("its error, times scale [J]", fabs(a->error * a->scale - b->error * b->scale),
                1e-12 * (stored + a->input));
}

/* ---- Free flight ------------------------------------------------------------------------------------------------- */

/* Momentum of a pipe that is added: its mass goes with its centre and spins about its axis. */
static void check_momentum(const scene *to, const scene *from, double mass, double about)
{
    const dmb_momentum a = momentum_of(&from->r), b = momentum_of(&to->r);
    const dmb_motion v = motion_at(&to->r, dmb_station(to->string, 0, 0.0), DMB_FRAME_WORLD);
    const dmb_pose pose = pose_at(&to->r, dmb_station(to->string, 0, 0.0));
    double linear[3], angular[3], centre[3];
    for (int i = 0; i < 3; i++) {
        linear[i] = mass * v.velocity[i];
        centre[i] = (b.mass * b.centre[i] - a.mass * a.centre[i]) / mass;
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        angular[i] = centre[j] * linear[k] - centre[k] * linear[j] + about * 20.0 * pose.rotation[3 * i];
        check_close("momentum", b.linear[i] - a.linear[i], linear[i], 1e-11 * mass);
        check_close("angular momentum", b.angular[i] - a.angular[i], angular[i], 1e-9 * mass);
    }
}

/* Mass and inertia about the axis of one pipe with its joint: what three pipes have more than two. */
static void added_pipes_fly_along(void **state)
{
    (void)state;
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_RIGID; kind += 2) {
        choice c = flight;
        c.kind = kind;
        scene three = flight_of(&c), again = flight_of(&c), four, back;
        take_steps(&three.r, 1e-3, 50);
        assert_int_equal(go_over(&again, &three), DMB_OK);
        c.pipes = 4;
        four = flight_of(&c);
        take_steps(&four.r, 1e-3, 7); /* whatever it did before is gone */
        assert_int_equal(go_over(&four, &three), DMB_OK);
        const double mass = momentum_of(&four.r).mass - momentum_of(&three.r).mass;
        const dmb_pipe_def pipe = s1_pipe();
        const double ri = 0.25 * pipe.inner_diameter * pipe.inner_diameter;
        const double body = 1.3 * s1_values().mass, ro = 0.25 * pipe.outer_diameter * pipe.outer_diameter;
        check_below("matched", apart(&three, 3, &four, 4), 1e-12);
        if (kind == DMB_PIPE_FLEXIBLE) check_below("stresses", stress_apart(&three, 3, &four, 4, 1), 1e-12);
        check_momentum(&four, &three, mass, 0.5 * body * (ri + ro) + 0.5 * (mass - body) * (ri + 0.25 * 0.08 * 0.08));
        check_close("time", dmb_sim_time(four.r.sim), dmb_sim_time(three.r.sim), 0.0);
        c.pipes = 3;
        back = flight_of(&c);
        assert_int_equal(go_over(&back, &four), DMB_OK);
        check_below("and back", apart(&three, 3, &back, 3), 1e-12);
        take_steps(&back.r, 1e-3, 50);
        take_steps(&again.r, 1e-3, 50); /* both have begun anew with consistent accelerations */
        check_below("goes on as without", apart(&again, 3, &back, 3), 1e-10);
        rig_close(&three.r), rig_close(&again.r), rig_close(&four.r), rig_close(&back.r);
    }
}

/* Vibrating and bending, with an eccentric mass: strains stay; there and back is nothing. */
static void strains_stay(void **state)
{
    choice c = flight;
    (void)state;
    c.load = 1;
    c.eccentricity = 2e-3;
    scene three = flight_of(&c), five, back;
    take_steps(&three.r, 1e-3, 40);
    c.pipes = 5;
    five = flight_of(&c);
    (void)go_over(&five, &three);
    check_below("matched", apart(&three, 3, &five, 5), 1e-12);
    check_below("strains", stress_apart(&three, 3, &five, 5, 0), 1e-12);
    c.pipes = 3;
    back = flight_of(&c);
    (void)go_over(&back, &five);
    check_below("and back", apart(&three, 3, &back, 3), 1e-12);
    check_below("forces and back", stress_apart(&three, 3, &back, 3, 1), 1e-12);
    rig_close(&three.r), rig_close(&five.r), rig_close(&back.r);
}

/* Under gravity, with a load at work before and after. */
static void ledger_goes_on(void **state)
{
    choice c = flight;
    (void)state;
    c.load = 1;
    c.gravity = 9.81;
    scene three = flight_of(&c), four, back;
    take_steps(&three.r, 2.5e-4, 160);
    const dmb_energy before = energy_of(&three.r);
    c.pipes = 4;
    four = flight_of(&c);
    (void)go_over(&four, &three);
    dmb_energy after = energy_of(&four.r);
    check_ledger(&before, &after);
    take_steps(&four.r, 2.5e-4, 160);
    after = energy_of(&four.r);
    assert_true(fabs(after.loads - before.loads) > 1.0);
    tell("work of the load [J]", after.loads);
    check_below("error afterwards", after.error, 2e-3);
    check_below("unexplained afterwards", fabs(after.unexplained), 1e-7 * after.input);
    c.pipes = 3;
    back = flight_of(&c);
    (void)go_over(&back, &four);
    const dmb_energy last = energy_of(&back.r);
    check_ledger(&after, &last);
    take_steps(&back.r, 2.5e-4, 160);
    check_below("error at the end", energy_of(&back.r).error, 2e-3);
    rig_close(&three.r), rig_close(&four.r), rig_close(&back.r);
}

/* ---- Drilling ---------------------------------------------------------------------------------------------------- */

static dmb_bit_state bit_of(const scene *s)
{
    dmb_bit_state bit = dmb_bit_state_default();
    must(&s->r, dmb_query_bit(s->r.sim, s->bit, &bit));
    return bit;
}

static dmb_drive_state drive_of(const scene *s, dmb_id drive)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(&s->r, dmb_query_drive(s->r.sim, drive, &state));
    return state;
}

static double depth_of(const scene *s)
{
    return pose_at(&s->r, dmb_station(s->bit, 0, 0.0)).depth;
}

static void run_to(const scene *s, double time)
{
    while (dmb_sim_time(s->r.sim) < time - 1e-9) {
        const int32_t status = dmb_sim_step(s->r.sim, 1e-3, NULL);
        must(&s->r, status);
    }
}

/* The memory of the bit and the drives is the same in both. */
static void check_bit(const scene *a, const scene *b, double tolerance)
{
    const dmb_bit_state x = bit_of(a), y = bit_of(b);
    check_close("depth of the bit", depth_of(b), depth_of(a), tolerance);
    check_close("rock ahead", y.bottom - y.advance, x.bottom - x.advance, tolerance);
    check_close("weight on bit", y.weight, x.weight, 1e8 * tolerance);
    check_close("torque on bit", y.torque, x.torque, 1e8 * tolerance);
    check_close("fed", drive_of(b, b->feed).position, drive_of(a, a->feed).position, 0.0);
    check_close("turned", drive_of(b, b->motor).position, drive_of(a, a->motor).position, 0.0);
    check_close("work", drive_of(b, b->motor).work, drive_of(a, a->motor).work, 0.0);
}

/* Places at the wall, counted from the bit: what holds them is the same. */
static void check_contacts(const scene *a, const scene *b)
{
    dmb_model_info x = dmb_model_info_default(), y = dmb_model_info_default();
    double worst = 0.0;
    must_model(&a->r, dmb_model_get_info(a->r.model, &x));
    must_model(&b->r, dmb_model_get_info(b->r.model, &y));
    const uint32_t common = x.contact_points < y.contact_points ? x.contact_points : y.contact_points;
    for (uint32_t k = 1; k <= common; k++) {
        dmb_contact p = dmb_contact_default(), q = dmb_contact_default();
        must(&a->r, dmb_query_contact(a->r.sim, x.contact_points - k, &p));
        must(&b->r, dmb_query_contact(b->r.sim, y.contact_points - k, &q));
        if (p.length != q.length) continue; /* the end of the string, where it was or is */
        worst = fmax(worst, fabs(p.normal_force - q.normal_force));
        worst = fmax(worst, largest_difference(2, p.friction, q.friction));
        worst = fmax(worst, largest_difference(3, p.normal, q.normal));
        assert_int_equal(p.sticks, q.sticks);
    }
    check_below("forces on the wall [N]", worst, 1e-6);
}

/* Drills until `time` (at rest from 0.35 s to 0.4 s), goes over to `pipes` pipes and drills on; turns must not differ
 * by more than `frames`. */
static void drill_on(choice c, double time, uint32_t pipes, double frames)
{
    const uint32_t before = c.pipes;
    scene a = rig_of(&c), b;
    if (c.kind == DMB_PIPE_FLEXIBLE && c.gravity > 0.0) (void)find_equilibrium(&a.r, NULL);
    run_to(&a, time);
    const dmb_bit_state drilled = bit_of(&a);
    tell("weight on bit [N]", drilled.weight);
    c.pipes = pipes;
    b = rig_of(&c);
    const int32_t status = go_over(&b, &a);
    if (pipes > before) { /* else the support stops what swings at the new rig end */
        assert_int_equal(status, DMB_OK);
        check_below("speeds too", apart(&a, before, &b, pipes), 1e-12 + frames);
    }
    check_below("matched", poses_apart(&a, before, &b, pipes), 1e-12 + frames);
    check_bit(&a, &b, 1e-12);
    if (pipes > before) check_contacts(&a, &b);
    const dmb_energy x = energy_of(&a.r), y = energy_of(&b.r);
    check_ledger(&x, &y);
    const double depth = depth_of(&b), turn = rotation_at(&b.r, dmb_station(b.string, pipes - 1, 1.0));
    must(&b.r, dmb_sim_step(b.r.sim, 1e-4, NULL)); /* short: what the support held springs free */
    check_below("no jump of the bit", fabs(depth_of(&b) - depth), 1e-4);
    check_below("no jump of its turn", fabs(rotation_at(&b.r, dmb_station(b.string, pipes - 1, 1.0)) - turn), 0.05);
    for (int i = 0; i < 199; i++) must(&b.r, dmb_sim_step(b.r.sim, 1e-4, NULL));
    run_to(&b, 0.7);
    const dmb_energy end = energy_of(&b.r);
    tell("error of the ledger at the end", end.error);
    tell("rock [J]", end.rock);
    check_below("error", end.error, 5e-3);
    if (c.rock == DMB_ROCK_REGENERATIVE) assert_true(drilled.torque >= 0.0 && end.rock > x.rock);
    assert_true(depth_of(&b) > depth);
    rig_close(&a.r), rig_close(&b.r);
}

static void drilling_rod_by_rod(void **state)
{
    choice c = drilling;
    (void)state;
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_RIGID; kind++) {
        c = drilling;
        c.kind = kind;
        drill_on(c, 0.37, 4, 0.0);
        drill_on(with_pipes(c, 4), 0.37, 3, 0.0);
    }
    c = drilling;
    c.rock = DMB_ROCK_RATE;
    c.friction = DMB_FRICTION_BRISTLE;
    drill_on(c, 0.37, 6, 0.0);
    c.kind = DMB_PIPE_AXIAL_TORSIONAL;
    drill_on(c, 0.37, 6, 0.0);
}

/* In a hole that bends in space the frames of two described poses differ; turns do as well, by that. */
static void in_a_bent_hole(void **state)
{
    choice c = drilling;
    (void)state;
    c.curved = 1;
    c.speed = 0.5;
    drill_on(c, 0.37, 4, 1e-3);
    drill_on(c, 0.25, 4, 1e-3); /* in full swing */
    c.kind = DMB_PIPE_AXIAL_TORSIONAL;
    drill_on(c, 0.37, 4, 1e-12);
    drill_on(c, 0.25, 4, 1e-12);
}

/* Described one pipe further back, matched pipes have their old described poses, and the advance goes on as well. */
static void described_further_back(void **state)
{
    choice c = drilling;
    (void)state;
    for (int curved = 0; curved < 2; curved++) {
        c = drilling;
        c.curved = curved;
        c.start = 1.0;
        scene a = rig_of(&c), b;
        run_to(&a, 0.37);
        c.pipes = 4;
        c.start = 0.0;
        b = rig_of(&c);
        (void)go_over(&b, &a);
        check_below("matched", apart(&a, 3, &b, 4), curved ? 1e-2 : 1e-12);
        check_close("advance", bit_of(&b).advance, bit_of(&a).advance, 1e-12);
        check_close("bottom", bit_of(&b).bottom, bit_of(&a).bottom, 1e-12);
        rig_close(&a.r), rig_close(&b.r);
    }
}

/* A driller's hand on the drive and an interrupted contact are carried, too; snapshots of the new sim hold it all. */
static void snapshots_go_on(void **state)
{
    choice c = drilling;
    (void)state;
    c.friction = DMB_FRICTION_BRISTLE;
    scene a = rig_of(&c), b, d;
    size_t size = 0;
    run_to(&a, 0.2);
    c.pipes = 4;
    b = rig_of(&c), d = rig_of(&c);
    (void)go_over(&b, &a);
    (void)go_over(&d, &a);
    assert_true(hash_of(b.r.sim) == hash_of(d.r.sim));
    must(&b.r, dmb_sim_snapshot_size(b.r.sim, &size));
    void *block = test_malloc(size);
    must(&b.r, dmb_sim_snapshot(b.r.sim, block, size));
    run_to(&b, 0.3);
    run_to(&d, 0.25);
    must(&d.r, dmb_sim_restore(d.r.sim, block, size));
    run_to(&d, 0.3);
    assert_true(hash_of(b.r.sim) == hash_of(d.r.sim));
    test_free(block);
    rig_close(&a.r), rig_close(&b.r), rig_close(&d.r);
}

/* ---- Rigid and elastic pipes ------------------------------------------------------------------------------------- */

/* Kinds of pipes from the rig end on: R rigid, F flexible, A axial-torsional. */
static scene mixed_of(const char *kinds, int32_t start_free)
{
    scene s;
    dmb_string_def string = dmb_string_def_default();
    memset(&s, 0, sizeof s);
    rig_open(&s.r, 0.0, 0.0, -9.81);
    const dmb_wall_def wall = s1_hole();
    (void)add_wall(&s.r, &wall);
    string.start_free = start_free;
    s.string = add_string(&s.r, &string);
    for (const char *k = kinds; *k != '\0'; k++) {
        dmb_pipe_def pipe = dmb_pipe_def_default();
        pipe.kind = *k == 'R' ? DMB_PIPE_RIGID : *k == 'F' ? DMB_PIPE_FLEXIBLE : DMB_PIPE_AXIAL_TORSIONAL;
        pipe.length = *k == 'R' ? 0.6 : 1.0;
        pipe.joint_length = *k == 'A' ? 0.0 : 0.1;
        (void)add_pipes(&s.r, &pipe, 1);
    }
    (void)rig_start(&s.r, NULL);
    return s;
}

/* Rigid pipes at the rig end become part of one body: its node moves, its pipes do not. */
static void rigid_pipes_merge(void **state)
{
    static const char *const to[] = {"RRFR", "FRFR", "RFRFR", "FR", "RRRRFR"};
    static const int32_t support[] = {DMB_FREE_ALL, DMB_FREE_CYLINDRICAL, DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z};
    (void)state;
    for (int k = 0; k < 15; k++) {
        const char *kinds = to[k % 5];
        scene a = mixed_of("RFR", support[k / 5]), b = mixed_of(kinds, support[k / 5]), back;
        take_steps(&a.r, 1e-3, 20);
        (void)go_over(&b, &a);
        const uint32_t n = (uint32_t)strlen(kinds);
        check_below(kinds, n > 3 ? apart(&a, 3, &b, n) : 0.0, 1e-12);
        const dmb_energy x = energy_of(&a.r), y = energy_of(&b.r);
        check_ledger(&x, &y);
        take_steps(&b.r, 1e-3, 20);
        back = mixed_of("RFR", support[k / 5]);
        (void)go_over(&back, &b);
        if (n > 3 && k < 5) check_below("back", apart(&back, 3, &b, n), 1e-12);
        take_steps(&back.r, 1e-3, 2);
        rig_close(&a.r), rig_close(&b.r), rig_close(&back.r);
    }
}

/* Tumbling, so that the node moves over to where the speed is another. */
static void tumbling_rigid_pipes(void **state)
{
    (void)state;
    scene one, four;
    choice c = {1, DMB_PIPE_RIGID, 0, 0.0, 9.81, 1.0, 0, DMB_FRICTION_STRIBECK, DMB_ROCK_NONE, 1, 0.0, 1.0};
    one = flight_of(&c);
    take_steps(&one.r, 1e-3, 100);
    c.pipes = 4;
    four = flight_of(&c);
    assert_int_equal(go_over(&four, &one), DMB_OK);
    check_below("matched", apart(&one, 1, &four, 4), 1e-12);
    take_steps(&four.r, 1e-3, 10);
    rig_close(&one.r), rig_close(&four.r);
}

/* Pipes that are bent and twisted when nothing acts on them. */
static void added_pipes_are_unstressed(void **state)
{
    dmb_section s = dmb_section_default(), t = dmb_section_default();
    choice c = flight;
    (void)state;
    c.bend = 0.05;
    scene a = flight_of(&c), b;
    c.pipes = 5;
    b = flight_of(&c);
    must(&b.r, dmb_query_section(b.r.sim, dmb_station(b.string, 1, 0.3), &s));
    take_steps(&a.r, 1e-3, 20);
    (void)go_over(&b, &a);
    must(&b.r, dmb_query_section(b.r.sim, dmb_station(b.string, 1, 0.3), &t));
    check_below("strain of a new pipe", largest_difference(6, s.strain, t.strain), 1e-12);
    rig_close(&a.r), rig_close(&b.r);
    c = drilling;
    c.kind = DMB_PIPE_AXIAL_TORSIONAL;
    c.bend = 0.05;
    a = rig_of(&c);
    run_to(&a, 0.1);
    c.pipes = 5;
    b = rig_of(&c);
    (void)go_over(&b, &a);
    must(&b.r, dmb_query_section(b.r.sim, dmb_station(b.string, 1, 0.3), &t));
    check_close("tension of a new pipe [N]", t.force[0], 0.0, 1e-6);
    check_close("its torque [N m]", t.force[3], 0.0, 1e-6);
    rig_close(&a.r), rig_close(&b.r);
}

static void axial_pipes_stay_on_the_axis(void **state)
{
    (void)state;
    scene a = mixed_of("AAF", DMB_FREE_CYLINDRICAL), b = mixed_of("AAAAF", DMB_FREE_CYLINDRICAL);
    take_steps(&a.r, 1e-3, 30);
    (void)go_over(&b, &a);
    check_below("matched", apart(&a, 3, &b, 5), 1e-12);
    take_steps(&b.r, 1e-3, 5);
    rig_close(&b.r);
    b = mixed_of("FAAF", DMB_FREE_CYLINDRICAL);
    assert_int_equal(dmb_sim_transfer_state(b.r.sim, a.r.sim), DMB_ERR_VALUE);
    assert_int_equal(dmb_sim_transfer_state(a.r.sim, b.r.sim), DMB_ERR_VALUE);
    rig_close(&a.r), rig_close(&b.r);
}

/* ---- A head of its own ------------------------------------------------------------------------------------------- */

/* The head is a body on a slide that is joined to the rig end; once open, it goes back by a rod and is closed again. */
static scene head_of(uint32_t pipes, double retract)
{
    scene s;
    dmb_body_def head = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_segment back = dmb_segment_default();
    memset(&s, 0, sizeof s);
    rig_open(&s.r, 0.0, 0.0, 0.0);
    s.string = add_string(&s.r, &string);
    (void)add_pipes(&s.r, &pipe, pipes);
    head.mass = 200.0;
    head.free_mask = DMB_FREE_X;
    s.head = add_body(&s.r, &head);
    joint.place_a = dmb_station(s.head, 0, 0.0);
    joint.place_b = dmb_station(s.string, 0, 0.0);
    must_model(&s.r, dmb_model_add_joint(s.r.model, &joint, &s.joint));
    back.kind = DMB_SEGMENT_STEP;
    back.x0 = 0.1, back.x1 = 0.2, back.h1 = -retract / 0.1 / 0.5;
    dmb_segment stop = back;
    stop.x0 = 0.2, stop.x1 = 0.3, stop.h1 = -back.h1;
    const dmb_segment terms[2] = {back, stop};
    s.feed = add_simple_drive(&s.r, DMB_DRIVE_MOTION, s.head, DMB_X, add_time_function(&s.r, terms, 2));
    (void)rig_start(&s.r, NULL);
    return s;
}

static void head_lets_go_and_grips(void **state)
{
    dmb_joint_state told = dmb_joint_state_default();
    (void)state;
    scene a = head_of(3, 0.5), b = head_of(4, 0.5);
    take_steps(&a.r, 1e-3, 50);
    const uint64_t before = hash_of(b.r.sim);
    assert_int_equal(dmb_sim_transfer_state(b.r.sim, a.r.sim), DMB_ERR_GEOMETRY); /* still closed */
    print_message("%s\n", dmb_sim_message(b.r.sim));
    assert_true(hash_of(b.r.sim) == before);
    must(&a.r, dmb_sim_set_joint(a.r.sim, a.joint, DMB_JOINT_OPEN));
    take_steps(&a.r, 1e-3, 10);
    (void)go_over(&b, &a);
    must(&b.r, dmb_query_joint(b.r.sim, b.joint, &told));
    assert_int_equal(told.state, DMB_JOINT_OPEN);
    run_to(&b, 0.35);
    must(&b.r, dmb_query_joint(b.r.sim, b.joint, &told));
    check_close("head at the new rod", told.position[0], 0.0, 1e-9);
    must(&b.r, dmb_sim_set_joint(b.r.sim, b.joint, DMB_JOINT_ACTIVE));
    take_steps(&b.r, 1e-3, 20);
    must(&b.r, dmb_query_joint(b.r.sim, b.joint, &told));
    check_below("violation", told.violation, 1e-12);
    scene c = head_of(4, 0.5), d = head_of(5, 0.5);
    (void)go_over(&c, &b);
    take_steps(&c.r, 1e-3, 5);
    take_steps(&b.r, 1e-3, 5);
    check_below("closed, no rod", apart(&b, 4, &c, 4), 1e-9);
    rig_close(&a.r), rig_close(&b.r), rig_close(&c.r), rig_close(&d.r);
}

/* A centraliser on the last pipe but one, a turbine with its own drive at the far end, and a spring to the ground; the
 * joints are described with the pipes' numbers, which count from the rig. */
static scene joints_of(uint32_t pipes)
{
    scene s;
    dmb_body_def turbine = dmb_body_def_default();
    dmb_joint_def ring = dmb_joint_def_default(), axle = dmb_joint_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_wall_def wall = s1_hole();
    memset(&s, 0, sizeof s);
    rig_open(&s.r, 0.0, 0.0, -9.81);
    (void)add_wall(&s.r, &wall);
    string.start_depth = 10.0 - pipes; /* the far end is at the same place */
    s.string = add_string(&s.r, &string);
    (void)add_pipes(&s.r, &pipe, pipes);
    turbine.mass = 8.0;
    for (int i = 0; i < 3; i++) turbine.inertia[i] = 0.05;
    turbine.position[0] = 10.0;
    s.head = add_body(&s.r, &turbine);
    ring.kind = DMB_JOINT_POINT_ON_HOLE;
    ring.place_b = dmb_station(s.string, pipes - 2, 1.0);
    must_model(&s.r, dmb_model_add_joint(s.r.model, &ring, NULL));
    axle.kind = DMB_JOINT_REVOLUTE;
    axle.place_a = dmb_station(s.string, pipes - 1, 1.0);
    axle.place_b = dmb_station(s.head, 0, 0.0);
    axle.damping[DMB_RX] = 0.1;
    must_model(&s.r, dmb_model_add_joint(s.r.model, &axle, &s.joint));
    s.feed = add_simple_drive(&s.r, DMB_DRIVE_MOTION, s.string, DMB_X, add_stop_and_go(&s.r, 0.1));
    s.motor = add_simple_drive(&s.r, DMB_DRIVE_MOTION, s.joint, DMB_RX, add_stop_and_go(&s.r, 30.0));
    const int32_t status = rig_start(&s.r, NULL);
    assert_true(status >= 0);
    return s;
}

static dmb_joint_state joint_of(const scene *s)
{
    dmb_joint_state state = dmb_joint_state_default();
    must(&s->r, dmb_query_joint(s->r.sim, s->joint, &state));
    return state;
}

static void joints_stay_closed(void **state)
{
    (void)state;
    scene a = joints_of(3), b = joints_of(5), back = joints_of(3), other = joints_of(5);
    size_t size = 0;
    run_to(&a, 0.2);
    assert_int_equal(go_over(&b, &a), DMB_OK);
    check_below("matched", apart(&a, 3, &b, 5), 1e-12);
    dmb_joint_state x = joint_of(&a), y = joint_of(&b);
    assert_true(x.position[3] > 1.0);
    check_below("coordinates", largest_difference(6, x.position, y.position), 1e-12);
    check_below("their rates", largest_difference(6, x.speed, y.speed), 1e-11);
    check_below("violation", y.violation, 1e-12);
    dmb_energy e = energy_of(&a.r), f = energy_of(&b.r);
    check_ledger(&e, &f);
    run_to(&b, 0.25);
    must(&b.r, dmb_sim_snapshot_size(b.r.sim, &size));
    void *block = test_malloc(size);
    must(&b.r, dmb_sim_snapshot(b.r.sim, block, size));
    run_to(&b, 0.5);
    must(&other.r, dmb_sim_restore(other.r.sim, block, size));
    run_to(&other, 0.5);
    assert_true(hash_of(b.r.sim) == hash_of(other.r.sim));
    y = joint_of(&b);
    check_close("driven on", y.position[3], drive_of(&b, b.motor).position, 1e-10);
    check_below("error", energy_of(&b.r).error, 1e-2);
    assert_true(go_over(&back, &b) >= 0);
    check_below("taken off", poses_apart(&back, 3, &b, 5), 1e-12);
    run_to(&back, 0.6);
    check_below("error", energy_of(&back.r).error, 1e-2);
    test_free(block);
    rig_close(&a.r), rig_close(&b.r), rig_close(&back.r), rig_close(&other.r);
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static void check_refused(scene *to, const scene *from, const char *word)
{
    const uint64_t before = hash_of(to->r.sim);
    assert_int_equal(dmb_sim_transfer_state(to->r.sim, from->r.sim), DMB_ERR_VALUE);
    print_message("%s\n", dmb_sim_message(to->r.sim));
    if (strstr(dmb_sim_message(to->r.sim), word) == NULL) fail_msg("\"%s\" is not in it", word);
    assert_true(hash_of(to->r.sim) == before);
    rig_close(&to->r);
}

static void other_rigs(void **state)
{
    static const char *const words[] = {"elements", "kind", "rock_law", "friction_law", "axis", "features"};
    (void)state;
    scene from = rig_of(&drilling);
    run_to(&from, 0.1);
    for (int k = 0; k < 6; k++) {
        choice c = drilling;
        if (k == 0) c.elements = 3;
        if (k == 1) c.kind = DMB_PIPE_RIGID;
        if (k == 2) c.rock = DMB_ROCK_RATE;
        if (k == 3) c.friction = DMB_FRICTION_BRISTLE;
        if (k == 4) c.curved = 1;
        if (k == 5) c.gravity = 0.0;
        scene to = rig_of(&c);
        check_refused(&to, &from, words[k]);
    }
    rig_close(&from.r);
}

static void other_parts(void **state)
{
    choice c = flight;
    (void)state;
    scene whole = rig_of(&drilling), from = flight_of(&flight), to = flight_of(&flight);
    check_refused(&to, &whole, "bodies");
    c.load = 1;
    to = flight_of(&c);
    check_refused(&to, &from, "loads");
    c = flight;
    c.eccentricity = 1e-3;
    to = flight_of(&c);
    check_refused(&to, &from, "section");
    rig_close(&whole.r), rig_close(&from.r);
    from = mixed_of("FRF", DMB_FREE_CYLINDRICAL);
    to = mixed_of("FFF", DMB_FREE_CYLINDRICAL);
    check_refused(&to, &from, "kind");
    to = mixed_of("FRFF", DMB_FREE_CYLINDRICAL);
    check_refused(&to, &from, "kind");
    rig_close(&from.r);
}

static void wrong_handles(void **state)
{
    (void)state;
    const choice c = drilling;
    scene s = rig_of(&c);
    uint64_t junk[64] = {0};
    const uint64_t before = hash_of(s.r.sim);
    assert_int_equal(dmb_sim_transfer_state(NULL, s.r.sim), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_transfer_state(s.r.sim, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_transfer_state((dmb_sim *)(void *)junk, s.r.sim), DMB_ERR_HANDLE);
    assert_int_equal(dmb_sim_transfer_state(s.r.sim, (dmb_sim *)(void *)junk), DMB_ERR_HANDLE);
    assert_int_equal(dmb_sim_transfer_state(s.r.sim, s.r.sim), DMB_ERR_VALUE);
    assert_true(hash_of(s.r.sim) == before);
    rig_close(&s.r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(added_pipes_fly_along),
        cmocka_unit_test(strains_stay),
        cmocka_unit_test(ledger_goes_on),
        cmocka_unit_test(drilling_rod_by_rod),
        cmocka_unit_test(in_a_bent_hole),
        cmocka_unit_test(described_further_back),
        cmocka_unit_test(snapshots_go_on),
        cmocka_unit_test(rigid_pipes_merge),
        cmocka_unit_test(tumbling_rigid_pipes),
        cmocka_unit_test(added_pipes_are_unstressed),
        cmocka_unit_test(axial_pipes_stay_on_the_axis),
        cmocka_unit_test(head_lets_go_and_grips),
        cmocka_unit_test(joints_stay_closed),
        cmocka_unit_test(other_rigs),
        cmocka_unit_test(other_parts),
        cmocka_unit_test(wrong_handles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
