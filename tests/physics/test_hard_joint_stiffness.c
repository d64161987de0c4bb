/* Hard case 4, with joints: springs of 1e-3 next to such of 1e12, turning and sliding, at rest and in steps. Converged
 * to 1e-10 in every equation, as far as a position can show the force of the stiff ones: an angle of 1e-16 rad is
 * 1e-4 N m there. */
#include "rig.h"

enum { BODIES = 4 };
static const double stiffness[BODIES] = {1e12, 1e-3, 1e12, 1e-3};

typedef struct line {
    rig s;
    dmb_id bodies[BODIES], joints[BODIES];
} line;

/* Discs in a line along x, each on a joint of `kind` to the one before, the first to the ground; `load` on the last,
 * force or torque. */
static line open_line(int32_t kind, int32_t component, double load)
{
    line l;
    dmb_sim_options options = dmb_sim_options_default();
    rig_open(&l.s, 0.0, 0.0, 0.0);
    for (uint32_t i = 0; i < BODIES; i++) {
        dmb_body_def body = dmb_body_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        body.position[0] = i;
        for (int k = 0; k < 3; k++) body.inertia[k] = 1.0;
        l.bodies[i] = add_body(&l.s, &body);
        joint.kind = kind;
        if (i > 0) joint.place_a = dmb_station(l.bodies[i - 1], 0, 0.0);
        joint.place_b = dmb_station(l.bodies[i], 0, 0.0);
        joint.match = 1;
        joint.stiffness[component] = stiffness[i];
        must_model(&l.s, dmb_model_add_joint(l.s.model, &joint, &l.joints[i]));
    }
    dmb_load_def def = dmb_load_def_default();
    def.place = dmb_station(l.bodies[BODIES - 1], 0, 0.0);
    if (component == DMB_X)
        def.force[0] = load;
    else
        def.moment[0] = load;
    (void)add_load(&l.s, &def);
    options.spectral_radius = 1.0;
    options.newton_tolerance = 1e-12;
    (void)rig_start(&l.s, &options);
    return l;
}

static double coordinate_of(const line *l, uint32_t joint, int32_t component)
{
    dmb_joint_state state = dmb_joint_state_default();
    must(&l->s, dmb_query_joint(l->s.sim, l->joints[joint], &state));
    return state.position[component];
}

/* The soft ones give way by load/1e-3, the stiff ones by nothing that a double can show. */
static void at_rest(void **state)
{
    static const int32_t kinds[2] = {DMB_JOINT_REVOLUTE, DMB_JOINT_PRISMATIC}, components[2] = {DMB_RX, DMB_X};
    (void)state;
    for (int i = 0; i < 2; i++) {
        line l = open_line(kinds[i], components[i], 5e-4);
        const dmb_static_report report = find_equilibrium(&l.s, NULL);
        print_message("%s: %u iterations, method %d\n", i == 0 ? "turning" : "sliding", report.iterations,
                      report.method);
        check_relative("    first soft joint", coordinate_of(&l, 1, components[i]), 0.5, 1e-10);
        check_relative("    second soft joint", coordinate_of(&l, 3, components[i]), 0.5, 1e-10);
        check_below("    stiff joints",
                    fmax(fabs(coordinate_of(&l, 0, components[i])), fabs(coordinate_of(&l, 2, components[i]))), 1e-15);
        rig_close(&l.s);
    }
}

/* Bodies 1 and 2 move as one of twice the inertia: x = F/k (...) of two masses 2 and 1 on two springs, m x'' = K x. */
static void in_steps(void **state)
{
    static const int32_t kinds[2] = {DMB_JOINT_REVOLUTE, DMB_JOINT_PRISMATIC}, components[2] = {DMB_RX, DMB_X};
    (void)state;
    for (int i = 0; i < 2; i++) {
        line l = open_line(kinds[i], components[i], 5e-4);
        double x[2] = {0.0, 0.0}, v[2] = {0.0, 0.0}, worst = 0.0;
        for (int n = 0; n < 2000; n++) {
            take_steps(&l.s, 0.05, 1);
            for (int k = 0; k < 50; k++) { /* leapfrog, 1e-3 s: w h of 4e-5 */
                const double h = 1e-3;
                for (int half = 0; half < 2; half++) {
                    v[0] += 0.5 * h * (1e-3 * (x[1] - x[0]) - 1e-3 * x[0]) / 2.0;
                    v[1] += 0.5 * h * (5e-4 - 1e-3 * (x[1] - x[0]));
                    if (half == 0) x[0] += h * v[0], x[1] += h * v[1];
                }
            }
            worst = fmax(worst, fabs(coordinate_of(&l, 1, components[i]) - x[0]));
            worst = fmax(worst, fabs(coordinate_of(&l, 3, components[i]) + coordinate_of(&l, 1, components[i]) - x[1]));
        }
        check_below(i == 0 ? "turning: from two masses on two springs, 100 s [rad]"
                           : "sliding: from two masses on two springs, 100 s [m]",
                    worst, 1e-6);
        check_below("    stiff joints", fabs(coordinate_of(&l, 2, components[i])), 1e-14);
        check_below("    worst iterations", statistics_of(&l.s).most_iterations, 4);
        assert_int_equal(statistics_of(&l.s).rejected, 0);
        rig_close(&l.s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_rest),
        cmocka_unit_test(in_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
