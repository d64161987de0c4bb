/* Damped bodies on stiff springs, loaded and released beside their equilibrium, come to rest in the equilibrium of the
 * static analysis, and where there is one in closed form, in that, although the steps do not resolve the springs (h w
 * of 1.2 to 40) and their gradients turn: mean forces begin, and have to end. Springs between a body and the ground,
 * pulled and pressed, and between two bodies; a rope; six springs of a joint beside the centre of mass, and three of a
 * ball joint, whose mean forces move each other's coordinates. At rest the springs have the forces of their law.
 * Equations: eq:unilateral.holding, eq:unilateral.bias. */
#include <math.h>
#include <string.h>

#include "drillmbd/scene.h"
#include "mechanism.h"

enum { LINE, PAIR, ROPE, BUSHING, BALL, KINDS };
static const char *const names[KINDS] = {"a spring", "a spring between two bodies", "a rope", "six springs of a joint",
                                         "three springs of a ball joint"};

/* [rad/s] of the stiff springs, and of soft ones that hold bodies across the line of a stiff one. Dampers end the
 * motion of a soft spring critically. */
#define STIFF 1000.0
#define SOFT 40.0
static const double mass = 2.0, inertia[3] = {0.004, 0.006, 0.005};
static const double origin[3] = {0.0, 0.0, 0.0}, above[3] = {0.0, 0.0, 0.5};

typedef struct loaded {
    int kind;
    double hw, radius, side; /* side: -1 presses */
} loaded;

typedef struct subject {
    rig s;
    dmb_id body[2], joint;
    uint32_t bodies;
} subject;

/* Stiffness or damping of a frequency or rate for all six coordinates. */
static void fill(double k[6], double factor)
{
    for (int i = 0; i < 3; i++) {
        k[i] = factor * mass;
        k[3 + i] = factor * inertia[i];
    }
}

static dmb_place on(dmb_id part)
{
    return dmb_station(part, 0, 0.0);
}

/* Beside `at`, turned about an axis across to all of its own. */
static dmb_id add_beside(subject *t, const double at[3])
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = mass;
    memcpy(body.inertia, inertia, sizeof inertia);
    for (int i = 0; i < 3; i++) {
        body.position[i] = at[i] + 0.01 * (i == 1 ? -0.6 : 0.8);
        body.rotation[i] = 0.03 * (i == 2 ? -0.7 : 0.5);
    }
    return t->body[t->bodies++] = add_body(&t->s, &body);
}

static void push(subject *t, dmb_id body, double x, double z, const double moment[3])
{
    dmb_load_def load = dmb_load_def_default();
    load.place = on(body);
    load.force[0] = x, load.force[2] = z;
    memcpy(load.moment, moment, sizeof load.moment);
    (void)add_load(&t->s, &load);
}

/* Holds a body softly at a place, on all coordinates. */
static void hold(subject *t, dmb_id body, const double at[3])
{
    dmb_joint_def joint = joint_between(DMB_JOINT_FREE, on(ground_id), on(body));
    memcpy(joint.origin_a, at, sizeof joint.origin_a);
    fill(joint.stiffness, SOFT * SOFT);
    fill(joint.damping, 2.0 * SOFT);
    (void)add_joint(&t->s, &joint);
}

/* A spring of 0.5 m down to the body, which a force pulls or presses along it. */
static void add_line(subject *t, dmb_id from, const double top[3], double stiffness, int acts, double force)
{
    dmb_spring_def spring = dmb_spring_def_default();
    dmb_id id = {0, 0};
    const dmb_id body = add_beside(t, origin);
    hold(t, body, origin);
    spring.place_a = on(from);
    spring.place_b = on(body);
    memcpy(spring.offset_a, top, sizeof spring.offset_a);
    spring.free_length = 0.5;
    spring.stiffness = stiffness;
    spring.acts = acts;
    must_model(&t->s, dmb_model_add_spring(t->s.model, &spring, &id));
    push(t, body, 0.0, -force, origin);
}

/* Springs of a joint, turned by some hundredths of a radian by their load. */
static void add_bushing(subject *t, int kind, double side)
{
    const double moment[3] = {side * 0.02 * inertia[0] * STIFF * STIFF, -side * 0.01 * inertia[1] * STIFF * STIFF,
                              side * 0.015 * inertia[2] * STIFF * STIFF};
    const dmb_id body = add_beside(t, origin);
    dmb_joint_def joint = joint_between(kind, on(ground_id), on(body));
    fill(joint.stiffness, STIFF * STIFF);
    fill(joint.damping, 2.0 * SOFT);
    for (int i = 0; i < 2; i++) joint.origin_b[i] = kind == DMB_JOINT_FREE ? 0.1 - 0.05 * i : 0.0;
    for (int i = 0; i < 3 && kind == DMB_JOINT_SPHERICAL; i++) joint.stiffness[i] = joint.damping[i] = 0.0;
    t->joint = add_joint(&t->s, &joint);
    push(t, body, kind == DMB_JOINT_FREE ? side * 1e-3 * mass * STIFF * STIFF : 0.0, 0.0, moment);
}

/* [N] below the load under which a pressed body would move across */
#define FORCE (0.1 * mass * SOFT * SOFT)

static void open_subject(subject *t, const loaded *of)
{
    const double k = mass * STIFF * STIFF, force = of->side * FORCE;
    dmb_sim_options options = sharp_options(of->radius, 1e-12);
    options.max_iterations = 40;
    memset(t, 0, sizeof *t);
    rig_open(&t->s, 0.0, 0.0, 0.0);
    if (of->kind == LINE) add_line(t, ground_id, above, k, DMB_SPRING_BOTH, force);
    if (of->kind == ROPE) add_line(t, ground_id, above, k, DMB_SPRING_TENSION, FORCE);
    if (of->kind == PAIR) {
        const dmb_id upper = add_beside(t, above);
        hold(t, upper, above);
        push(t, upper, 0.0, force, origin);
        add_line(t, upper, origin, 0.5 * k, DMB_SPRING_BOTH, force);
    }
    if (of->kind == BUSHING) add_bushing(t, DMB_JOINT_FREE, of->side);
    if (of->kind == BALL) add_bushing(t, DMB_JOINT_SPHERICAL, of->side);
    (void)mechanism_start(&t->s, &options); /* closes the ball joint */
}

static void run_to_rest(const subject *t, double h)
{
    const uint32_t count = 600 + (uint32_t)ceil(60.0 / (SOFT * h));
    for (uint32_t i = 0; i < count; i++) {
        const int32_t status = dmb_sim_step(t->s.sim, h, NULL);
        assert_true(status == DMB_OK || status == DMB_NOTE_STEP_CUT);
    }
}

typedef struct beside {
    double place, speed, acceleration, force; /* [m, -], of a step; over the stiffness */
} beside;

static beside difference(const subject *run, const subject *rest, double h)
{
    beside most = {0.0, 0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < run->bodies; i++) {
        const dmb_pose a = pose_at(&run->s, on(run->body[i])), b = pose_at(&rest->s, on(rest->body[i]));
        const dmb_motion motion = motion_at(&run->s, on(run->body[i]), DMB_FRAME_WORLD);
        most.place = fmax(most.place, largest_difference(3, a.position, b.position));
        most.place = fmax(most.place, largest_difference(9, a.rotation, b.rotation));
        most.speed = fmax(most.speed, h * largest(6, motion.velocity));
        most.acceleration = fmax(most.acceleration, largest(6, motion.acceleration) / (STIFF * STIFF));
    }
    if (run->joint.index == 0 && run->joint.generation == 0) return most;
    const dmb_joint_state a = joint_at(&run->s, run->joint), b = joint_at(&rest->s, rest->joint);
    most.force = fmax(largest_difference(6, a.action, b.action), largest_difference(6, a.reaction, b.reaction));
    most.force /= mass * STIFF * STIFF;
    return most;
}

static void check_kind(const loaded *of)
{
    subject run, rest;
    const double h = of->hw / STIFF;
    open_subject(&run, of);
    open_subject(&rest, of);
    assert_int_equal(find_equilibrium(&rest.s, NULL).negative, 0);
    run_to_rest(&run, h);
    const beside off = difference(&run, &rest, h);
    check_below(names[of->kind], off.place, 1e-9);
    check_below("displacement of a step", off.speed, 1e-9);
    check_below("acceleration", off.acceleration, 1e-9);
    check_below("action and reaction", off.force, 1e-9);
    if (of->kind == LINE || of->kind == ROPE) {
        const double side = of->kind == ROPE ? 1.0 : of->side, all = mass * (STIFF * STIFF + SOFT * SOFT);
        check_close("stretch", pose_at(&run.s, on(run.body[0])).position[2], -side * FORCE / all, 1e-9);
    }
    rig_close(&run.s);
    rig_close(&rest.s);
}

static void rest_is_the_equilibrium(void **state)
{
    static const double ratios[] = {2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 15.0, 25.0, 40.0},
                        radii[] = {0.3, 0.5};
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int i = 0; i < 12; i++)
            for (int k = 0; k < 4; k++) {
                const loaded of = {kind, ratios[i], radii[k / 2], k % 2 ? -1.0 : 1.0};
                check_kind(&of);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rest_is_the_equilibrium)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
