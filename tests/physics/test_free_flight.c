/* Free flight against the straight line and the parabola: the centre of mass of a rigid body or string keeps to them to
 * rounding over 100 s, whatever point was named; strings of flexible pipes and bodies that joints connect keep linear
 * and angular momentum to second order. Checks eq:integration.free-rigid. */
#include <stdio.h>

#include "rig.h"

/* Largest difference of the centre of mass from x0 + v0 t + g t^2/2 over `steps` steps. */
static double off_the_parabola(const rig *s, const double g[3], double h, uint32_t steps)
{
    const dmb_momentum start = momentum_of(s);
    double worst = 0.0;
    for (int k = 1; k <= 4; k++) {
        take_steps(s, h, steps / 4);
        const double t = h * (steps / 4) * k;
        const dmb_momentum now = momentum_of(s);
        for (int i = 0; i < 3; i++) {
            const double want = start.centre[i] + (start.linear[i] / start.mass + 0.5 * g[i] * t) * t;
            worst = fmax(worst, fabs(now.centre[i] - want));
        }
    }
    return worst;
}

/* Angular momentum about the centre of mass. */
static void spin_of(const rig *s, double spin[3])
{
    const dmb_momentum m = momentum_of(s);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        spin[i] = m.angular[i] - (m.centre[j] * m.linear[k] - m.centre[k] * m.linear[j]);
    }
}

static double relative_change(const double before[3], const double after[3])
{
    return largest_difference(3, before, after) /
           sqrt(before[0] * before[0] + before[1] * before[1] + before[2] * before[2]);
}

/* ---- Rigid parts ------------------------------------------------------------------------------------------------- */

/* A body whose reference point lies `centre` from its centre of mass, tumbling at 20 rad/s. */
static void build_body(rig *s, const double centre[3], const double g[3])
{
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, g[0], g[1], g[2]);
    body.mass = 3.0;
    for (int i = 0; i < 3; i++) {
        body.inertia[i] = 1.0 + 0.4 * i;
        body.centre[i] = centre[i];
    }
    body.inertia[3] = 0.2;
    body.velocity[1] = 2.0;
    body.velocity[3] = 0.5;
    body.velocity[4] = 1.0;
    body.velocity[5] = 20.0;
    (void)add_body(s, &body);
}

/* Rigid pipes of two kinds, the far ones eccentric, turning end over end. */
static void build_string(rig *s, const double g[3])
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(s, g[0], g[1], g[2]);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_ALL;
    string.velocity[1] = 1.0;
    string.velocity[3] = 5.0;
    string.velocity[5] = 20.0;
    pipe.string = add_string(s, &string);
    pipe.kind = DMB_PIPE_RIGID;
    (void)add_pipes(s, &pipe, 10);
    pipe.outer_diameter = 0.1;
    pipe.eccentricity = 5e-3;
    (void)add_pipes(s, &pipe, 10);
}

static void rigid_parts_fly_straight(void **state)
{
    static const double centres[3][3] = {{0.0, 0.0, 0.0}, {10.0, 0.0, 0.0}, {6.0, -7.0, 3.0}};
    static const double fields[2][3] = {{0.0, 0.0, 0.0}, {1.0, 0.0, -9.81}};
    (void)state;
    for (int k = 0; k < 8; k++) {
        const double *g = fields[k % 2];
        double before[3], after[3];
        char what[96];
        rig s;
        if (k < 6)
            build_body(&s, centres[k / 2], g);
        else
            build_string(&s, g);
        (void)rig_start(&s, NULL);
        spin_of(&s, before);
        /* 26 km are flown and 49 km fallen */
        (void)snprintf(what, sizeof what, "%s, %s: centre off its path in 100 s", k < 6 ? "body" : "string",
                       k % 2 ? "falling" : "free");
        check_below(what, off_the_parabola(&s, g, 1e-3, 100000), 5e-8);
        spin_of(&s, after);
        check_below("    angular momentum about it", relative_change(before, after), 1e-4);
        rig_close(&s);
    }
}

/* The rotation is integrated by the scheme: second order. */
static void angular_momentum_is_of_second_order(void **state)
{
    const double g[3] = {0.0, 0.0, 0.0}, centre[3] = {6.0, -7.0, 3.0};
    double error[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        double before[3], after[3];
        rig s;
        dmb_sim_options options = dmb_sim_options_default();
        options.newton_tolerance = 1e-13;
        build_body(&s, centre, g);
        (void)rig_start(&s, &options);
        spin_of(&s, before);
        take_steps(&s, 2e-3 / (1 << k), 1000U << k);
        spin_of(&s, after);
        error[k] = relative_change(before, after);
        rig_close(&s);
    }
    check_order("angular momentum of a rigid body", error[0], error[1], 2.0, 0.05);
}

/* ---- Flexible strings, bodies that joints connect ---------------------------------------------------------------- */

static void build_flexible(rig *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_ALL;
    string.velocity[1] = 1.0;
    string.velocity[3] = 5.0;
    string.velocity[5] = 4.0;
    pipe.string = add_string(s, &string);
    pipe.young_modulus = 2.1e9;
    (void)add_pipes(s, &pipe, 4);
}

static void build_pair(rig *s)
{
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.3 + 0.1 * i;
    const dmb_id a = add_body(s, &body);
    body.position[0] = 2.0;
    body.velocity[1] = 4.0;
    body.velocity[3] = 3.0;
    body.velocity[5] = 6.0;
    const dmb_id b = add_body(s, &body);
    dmb_joint_def joint = joint_between(DMB_JOINT_SPHERICAL, dmb_station(a, 0, 0.0), dmb_station(b, 0, 0.0));
    joint.origin_a[0] = 1.0;
    joint.origin_b[0] = -1.0;
    (void)add_joint(s, &joint);
}

/* Relative change of linear and of angular momentum over t. */
static void change_of(void (*build)(rig *), double h, double t, double change[2])
{
    rig s;
    dmb_sim_options options = dmb_sim_options_default();
    options.newton_tolerance = 1e-12;
    build(&s);
    (void)rig_start(&s, &options);
    const dmb_momentum before = momentum_of(&s);
    take_steps(&s, h, (uint32_t)lround(t / h));
    const dmb_momentum after = momentum_of(&s);
    change[0] = relative_change(before.linear, after.linear);
    change[1] = relative_change(before.angular, after.angular);
    rig_close(&s);
}

static void others_keep_momentum_to_second_order(void **state)
{
    (void)state;
    for (int which = 0; which < 2; which++) {
        void (*build)(rig *) = which == 0 ? build_flexible : build_pair;
        double usual[2], coarse[2], fine[2];
        change_of(build, 1e-3, 2.0, usual);
        change_of(build, 1e-4, 0.2, coarse);
        change_of(build, 5e-5, 0.2, fine);
        tell(which == 0 ? "flexible string" : "two jointed bodies", which);
        tell("    linear momentum off in 2 s at 1 ms, relative", usual[0]);
        tell("    angular momentum off in 2 s at 1 ms, relative", usual[1]);
        check_order("    linear momentum", coarse[0], fine[0], 2.0, 0.1);
        check_order("    angular momentum", coarse[1], fine[1], 2.0, 0.1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rigid_parts_fly_straight),
        cmocka_unit_test(angular_momentum_is_of_second_order),
        cmocka_unit_test(others_keep_momentum_to_second_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
