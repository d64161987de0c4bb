/* Statics of strings that nothing but their head holds: they begin in line with it, far from where they come to rest.
 * Newton alone does not get there; the relaxation limits how far parts turn, not how far they travel. */
#include "rig.h"

enum { MOST_STRINGS = 4 };

typedef struct hanging {
    rig s;
    dmb_id strings[MOST_STRINGS];
    uint32_t count, pipes; /* of strings, of pipes in each */
    double length;         /* [m] of a string */
} hanging;

/* `kind` of joints between the strings, with a spring about the strings' axis where nothing else would hold it. */
static void join(hanging *h, uint32_t k, int32_t kind)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = kind;
    joint.place_a = dmb_station(h->strings[k - 1], h->pipes - 1, 1.0);
    joint.place_b = dmb_station(h->strings[k], 0, 0.0);
    if (kind == DMB_JOINT_SPHERICAL) joint.stiffness[DMB_RX] = 1e3;
    must_model(&h->s, dmb_model_add_joint(h->s.model, &joint, NULL));
}

/* Strings of pipes of 2 m in a line along x, the first one held at its rig end. */
static hanging open_line(uint32_t count, uint32_t pipes, int32_t pipe_kind, int32_t joint_kind)
{
    hanging h = {.count = count, .pipes = pipes, .length = 2.0 * pipes};
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.kind = pipe_kind;
    pipe.length = 2.0;
    rig_open(&h.s, 0.0, 0.0, -9.81);
    for (uint32_t k = 0; k < count; k++) {
        dmb_string_def string = dmb_string_def_default();
        string.position[0] = k * h.length;
        string.start_free = k == 0 ? DMB_FREE_NONE : DMB_FREE_ALL;
        pipe.string = h.strings[k] = add_string(&h.s, &string);
        (void)add_pipes(&h.s, &pipe, pipes);
        if (k > 0) join(&h, k, joint_kind);
    }
    (void)rig_start(&h.s, NULL);
    return h;
}

/* Forces and moments of the head, which is inclined by `angle`: weight, and weight times its lever. */
static void check_head(const hanging *h, double angle)
{
    double reaction[6];
    const dmb_momentum m = momentum_of(&h->s);
    must(&h->s, dmb_query_reaction(h->s.sim, h->strings[0], reaction));
    const double up = reaction[2] * cos(angle) + reaction[0] * sin(angle);
    const double along = reaction[0] * cos(angle) - reaction[2] * sin(angle);
    check_relative("    weight on the head", up, 9.81 * m.mass, 1e-9);
    check_relative("    moment on the head", -reaction[4], 9.81 * m.mass * m.centre[0], 1e-8);
    check_below("    force across and along over the weight", hypot(along, reaction[1]) / up, 1e-9);
}

/* A pipe of 73 x 6 mm clamped in line bends downwards within (EI/w)^(1/3) = 11 m; what is below hangs straight. */
static void clamped_string(void **state)
{
    static const uint32_t pipes[] = {10, 30, 60, 120};
    (void)state;
    for (int i = 0; i < 4; i++) {
        hanging h = open_line(1, pipes[i], DMB_PIPE_FLEXIBLE, 0);
        const dmb_static_report report = find_equilibrium(&h.s, NULL);
        const dmb_pose tip = pose_at(&h.s, dmb_station(h.strings[0], pipes[i] - 1, 1.0));
        print_message("%g m: %u iterations, tip at %g, %g m\n", h.length, report.iterations, tip.position[0],
                      tip.position[2]);
        check_head(&h, 0.0);
        if (pipes[i] >= 60) check_close("    last pipe from straight down", tip.rotation[6], -1.0, 1e-6);
        rig_close(&h.s);
    }
}

/* Behind a first string that cannot bend, everything hangs down from its end. */
static void rigid_chain(void **state)
{
    static const int32_t kinds[] = {DMB_JOINT_UNIVERSAL, DMB_JOINT_SPHERICAL};
    (void)state;
    for (int i = 0; i < 2; i++)
        for (uint32_t count = 2; count <= MOST_STRINGS; count++) {
            hanging h = open_line(count, 8, DMB_PIPE_RIGID, kinds[i]);
            const dmb_static_report report = find_equilibrium(&h.s, NULL);
            const dmb_pose tip = pose_at(&h.s, dmb_station(h.strings[count - 1], 7, 1.0));
            print_message("%u rigid strings, joints of kind %d: %u iterations\n", count, kinds[i], report.iterations);
            check_close("    tip along", tip.position[0], 16.0, 1e-6);
            check_close("    tip down", tip.position[2], -16.0 * (count - 1), 1e-6);
            rig_close(&h.s);
        }
}

/* The same of pipes that bend and stretch: hinges without springs, fixed joints as if there were none. */
static void flexible_chain(void **state)
{
    static const int32_t kinds[] = {DMB_JOINT_UNIVERSAL, DMB_JOINT_FIXED};
    double tip_z[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        hanging h = open_line(3, 10, DMB_PIPE_FLEXIBLE, kinds[i]);
        const dmb_static_report report = find_equilibrium(&h.s, NULL);
        tip_z[i] = pose_at(&h.s, dmb_station(h.strings[2], 9, 1.0)).position[2];
        print_message("joints of kind %d: %u iterations, tip %g m down\n", kinds[i], report.iterations, -tip_z[i]);
        check_head(&h, 0.0);
        rig_close(&h.s);
    }
    hanging whole = open_line(1, 30, DMB_PIPE_FLEXIBLE, 0);
    (void)find_equilibrium(&whole.s, NULL);
    check_relative("fixed joints as if there were none", tip_z[1],
                   pose_at(&whole.s, dmb_station(whole.strings[0], 29, 1.0)).position[2], 1e-8);
    rig_close(&whole.s);
}

/* [m] of the slender pipes of the rising chains: 46.39 by 31.48 mm. */
#define SLENDER 2.963

/* Three strings that rise from their head by `angle`, on universal joints without springs, 41 slender pipes in all and
 * a bit: on the way down parts stand on their heads and are pressed together, where the stiffness is indefinite. */
static hanging open_rising(double angle)
{
    hanging h = {.count = 3, .pipes = 14, .length = 14 * SLENDER};
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    pipe.length = SLENDER;
    pipe.elements = 3;
    pipe.outer_diameter = 0.04639;
    pipe.inner_diameter = 0.031484;
    pipe.eccentricity = 1.364e-3;
    pipe.angle_spread = PI;
    rig_open(&h.s, 0.0, 0.0, -9.81);
    for (uint32_t k = 0; k < 3; k++) {
        dmb_string_def string = dmb_string_def_default();
        string.position[0] = k * h.length * cos(angle);
        string.position[2] = k * h.length * sin(angle);
        string.rotation[1] = -angle;
        string.start_free = k == 0 ? DMB_FREE_NONE : DMB_FREE_ALL;
        pipe.string = h.strings[k] = add_string(&h.s, &string);
        pipe.seed = 28 + 1000 * k;
        (void)add_pipes(&h.s, &pipe, k < 2 ? 14 : 13);
        if (k > 0) join(&h, k, DMB_JOINT_UNIVERSAL);
    }
    bit.string = h.strings[2];
    must_model(&h.s, dmb_model_add_bit(h.s.model, &bit, NULL));
    (void)rig_start(&h.s, NULL);
    return h;
}

/* Parts below a joint hang straight down, the head carries the weight; the state is stable. */
static void rising_chain(void **state)
{
    static const double degrees[] = {0.0, 10.0, 28.24, 45.0, 60.0, 75.0, 85.0};
    (void)state;
    for (int i = 0; i < 7; i++) {
        hanging h = open_rising(degrees[i] * PI / 180.0);
        const dmb_static_report report = find_equilibrium(&h.s, NULL);
        print_message("rising by %g degrees: method %d, %u iterations, tip down %.6f m\n", degrees[i], report.method,
                      report.iterations, -pose_at(&h.s, dmb_station(h.strings[2], 12, 1.0)).position[2]);
        check_head(&h, degrees[i] * PI / 180.0);
        check_close("    middle of the second string from straight down",
                    pose_at(&h.s, dmb_station(h.strings[1], 7, 0.0)).rotation[6], -1.0, 1e-6);
        assert_int_equal(report.negative, 0);
        rig_close(&h.s);
    }
}

/* 3 strings on sliding joints in a wide hole that rises by a quarter of a radian: the first correction goes 18 element
 * lengths astray, where the dependent coordinates of the start no longer will do. Every search after it begins with
 * those of the start again. */
static void sliding_joints_in_a_hole(void **state)
{
    rig s;
    dmb_id strings[3];
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    double reaction[6];
    (void)state;
    rig_open(&s, 0.0, 0.0, -9.81);
    wall.normal_law = DMB_NORMAL_IMPACT;
    wall.direction[0] = cos(0.2525);
    wall.direction[2] = sin(0.2525);
    wall.diameter = 0.05212 + 2.0 * 0.03243;
    wall.stiffness = 2.352e8;
    wall.friction_law = DMB_FRICTION_NONE;
    (void)add_wall(&s, &wall);
    pipe.outer_diameter = 0.05212;
    pipe.inner_diameter = 0.0440;
    pipe.length = 2.215;
    pipe.elements = 2;
    pipe.eccentricity = 1.45e-3;
    pipe.angle_spread = PI;
    for (uint32_t k = 0; k < 3; k++) {
        dmb_string_def string = dmb_string_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        string.start_depth = k * 8 * pipe.length;
        string.start_free = k == 0 ? DMB_FREE_NONE : DMB_FREE_ALL;
        pipe.string = strings[k] = add_string(&s, &string);
        pipe.seed = 70 + 1000 * k;
        (void)add_pipes(&s, &pipe, 8);
        if (k == 0) continue;
        joint.kind = DMB_JOINT_PRISMATIC;
        joint.place_a = dmb_station(strings[k - 1], 7, 1.0);
        joint.place_b = dmb_station(strings[k], 0, 0.0);
        joint.stiffness[DMB_X] = 1.399e4;
        must_model(&s, dmb_model_add_joint(s.model, &joint, NULL));
    }
    bit.string = strings[2];
    bit.diameter = wall.diameter - 2e-3;
    must_model(&s, dmb_model_add_bit(s.model, &bit, NULL));
    (void)rig_start(&s, NULL);
    const dmb_static_report report = find_equilibrium(&s, NULL);
    must(&s, dmb_query_reaction(s.sim, strings[0], reaction));
    print_message("sliding joints: method %d, %u iterations\n", report.method, report.iterations);
    check_relative("wall and head carry the weight across", contacts_of(&s).normal_force + reaction[2],
                   9.81 * momentum_of(&s).mass * cos(0.2525), 1e-5);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clamped_string),           cmocka_unit_test(rigid_chain),
        cmocka_unit_test(flexible_chain),           cmocka_unit_test(rising_chain),
        cmocka_unit_test(sliding_joints_in_a_hole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
