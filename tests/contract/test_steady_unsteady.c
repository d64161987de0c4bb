/* Parts of a scene that do not let a state be steady (drives, guides, joints and springs) are refused by name; and
 * analyses that judge stiffness at rest, buckling and paths, held against states that move: refused, and answered at
 * rest. */
#include <string.h>

#include "rig.h"

static dmb_id constant_drive(rig *s, int32_t kind, dmb_id part, int32_t component, double value)
{
    return add_simple_drive(s, kind, part, component, add_constant(s, value));
}

static void refused(rig *s, int32_t steady, const char *word)
{
    dmb_static_options options = dmb_static_options_default();
    const uint64_t before = rig_hash(s);
    options.steady = steady;
    const int32_t status = dmb_analysis_static(s->sim, &options, NULL);
    print_message("%s\n", dmb_sim_message(s->sim));
    assert_int_equal(status, DMB_ERR_UNSUPPORTED);
    if (strstr(dmb_sim_message(s->sim), word) == NULL) fail_msg("no \"%s\" in: %s", word, dmb_sim_message(s->sim));
    if (strstr(dmb_sim_message(s->sim), "take DMB_STEADY_") == NULL) fail_msg("no remedy: %s", dmb_sim_message(s->sim));
    assert_true(rig_hash(s) == before);
    rig_close(s);
}

static dmb_id string_of(rig *s, int32_t start_free, int32_t end_free, int32_t kind)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    def.start_free = start_free;
    def.end_free = end_free;
    pipe.kind = kind;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 3);
    return pipe.string;
}

/* ---- Drives and guides ------------------------------------------------------------------------------------------- */

static void drives_that_disagree(void **state)
{
    (void)state;
    rig s;
    const dmb_id string = string_of(&s, DMB_FREE_RZ, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    dmb_body_def free_body = dmb_body_def_default();
    free_body.position[1] = 5.0;
    free_body.free_mask = DMB_FREE_RX;
    const dmb_id other = add_body(&s, &free_body);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RZ, 3.0);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, other, DMB_RX, 2.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_RIGID, "different axes");
}

static void forces_that_turn(void **state)
{
    (void)state;
    rig s;
    const dmb_id string = string_of(&s, DMB_FREE_SPHERICAL, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, 3.0);
    (void)constant_drive(&s, DMB_DRIVE_LOAD, string, DMB_RZ, 10.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_SLIDING, "its force turns with its string");
}

static void guides_that_hold(void **state)
{
    (void)state;
    rig s;
    dmb_id string = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_ALL & ~DMB_FREE_SPHERICAL, DMB_PIPE_FLEXIBLE);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, 3.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_SLIDING, "keeps it from turning");
    string = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_SPHERICAL, DMB_PIPE_FLEXIBLE);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_X, 0.1);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_SLIDING, "keeps it from sliding");
    string = string_of(&s, DMB_FREE_RZ, DMB_FREE_X | DMB_FREE_RX, DMB_PIPE_FLEXIBLE); /* swung, its far end held */
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RZ, 3.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_RIGID, "its guide or drive holds");
}

static void pipes_that_only_slide(void **state)
{
    (void)state;
    rig s;
    const dmb_id string = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_ALL, DMB_PIPE_AXIAL_TORSIONAL);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, 3.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_RIGID, "axial-torsional");
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

static dmb_id body_at(rig *s, double x, int32_t free_mask)
{
    dmb_body_def def = dmb_body_def_default();
    def.position[0] = x;
    def.free_mask = free_mask;
    return add_body(s, &def);
}

static dmb_id hinge(rig *s, dmb_id a, dmb_id b, double stiffness)
{
    dmb_joint_def def = joint_between(DMB_JOINT_REVOLUTE, dmb_station(a, 0, 0.0), dmb_station(b, 0, 0.0));
    def.axis_a[0] = 0.0;
    def.axis_a[2] = 1.0;
    def.match = 1;
    def.stiffness[DMB_RX] = stiffness;
    return add_joint(s, &def);
}

static void joints_that_are_driven(void **state)
{
    (void)state;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id first = body_at(&s, 0.0, DMB_FREE_RZ), second = body_at(&s, 1.0, DMB_FREE_ALL);
    const dmb_id between = hinge(&s, first, second, 0.0);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, between, DMB_RX, 2.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_RIGID, "two parts against each other");
}

static void springs_to_the_ground(void **state)
{
    (void)state;
    rig s;
    const dmb_id none = {0, 0};
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id hub = body_at(&s, 0.0, DMB_FREE_ALL), arm = body_at(&s, 1.0, DMB_FREE_ALL);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, hinge(&s, none, hub, 0.0), DMB_RX, 2.0);
    (void)add_joint_between(&s, DMB_JOINT_FIXED, dmb_station(hub, 0, 0.0), dmb_station(arm, 0, 0.0));
    dmb_joint_def spring = joint_between(DMB_JOINT_SPHERICAL, dmb_station(none, 0, 0.0), dmb_station(hub, 0, 0.0));
    spring.match = 1;
    spring.stiffness[DMB_RX] = 5.0;
    spring.state = DMB_JOINT_ACTIVE;
    (void)add_joint(&s, &spring);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_RIGID, "a law about the ground");
}

/* A string that a hinge to the ground, with a spring about its axis, holds at its far end: the drive winds the spring
 * up. */
static void springs_that_change(void **state)
{
    (void)state;
    rig s;
    const dmb_id none = {0, 0}, string = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    dmb_joint_def def = joint_between(DMB_JOINT_REVOLUTE, dmb_station(none, 0, 0.0), dmb_station(string, 2, 1.0));
    def.match = 1; /* about x */
    def.origin_a[0] = 3.0 * dmb_pipe_def_default().length;
    def.stiffness[DMB_RX] = 5.0;
    (void)add_joint(&s, &def);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, 3.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_SLIDING, "its spring along coordinate");
}

static void joints_that_do_not_let_it(void **state)
{
    (void)state;
    rig s;
    const dmb_id none = {0, 0}, string = string_of(&s, DMB_FREE_X | DMB_FREE_RX, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    dmb_joint_def def = joint_between(DMB_JOINT_FIXED, dmb_station(none, 0, 0.0), dmb_station(string, 2, 1.0));
    def.match = 1;
    def.origin_a[0] = 3.0 * dmb_pipe_def_default().length;
    (void)add_joint(&s, &def);
    (void)constant_drive(&s, DMB_DRIVE_MOTION, string, DMB_RX, 3.0);
    (void)rig_start(&s, NULL);
    refused(&s, DMB_STEADY_SLIDING, "joints do not allow");
}

/* ---- What judges a stiffness at rest ----------------------------------------------------------------------------- */

enum { SLIDES, TURNS, SWINGS, MOTIONS };

/* A column under a push at its far end, driven along, about its axis, or across. */
static void column(rig *s, int motion)
{
    dmb_load_def load = dmb_load_def_default();
    const int32_t start_free = motion == SWINGS ? DMB_FREE_RZ : DMB_FREE_X | DMB_FREE_RX;
    const dmb_id string = string_of(s, start_free, DMB_FREE_ALL, DMB_PIPE_FLEXIBLE);
    load.place = dmb_station(string, 2, 1.0);
    load.force[0] = -10.0;
    load.frame = motion == SWINGS ? DMB_FRAME_BODY : DMB_FRAME_WORLD;
    (void)add_load(s, &load);
    if (motion == SWINGS) {
        (void)constant_drive(s, DMB_DRIVE_MOTION, string, DMB_RZ, 0.5);
    } else {
        (void)constant_drive(s, DMB_DRIVE_MOTION, string, DMB_X, motion == SLIDES ? 0.1 : 0.0);
        (void)constant_drive(s, DMB_DRIVE_MOTION, string, DMB_RX, motion == TURNS ? 5.0 : 0.0);
    }
    (void)rig_start(s, NULL);
}

static int32_t buckle(const rig *s, double *factor)
{
    dmb_buckling *buckling = NULL;
    const int32_t status = dmb_analysis_buckling(s->sim, NULL, &buckling);
    assert_true((status >= 0) == (buckling != NULL));
    if (dmb_buckling_count(buckling) > 0) must(s, dmb_buckling_factor(buckling, 0, factor));
    dmb_buckling_destroy(&buckling);
    return status;
}

static int32_t follow(const rig *s)
{
    dmb_path_options options = dmb_path_options_default();
    options.max_points = 3;
    return dmb_analysis_path(s->sim, &options, NULL);
}

static void check_refused(rig *s)
{
    double factor;
    const uint64_t before = rig_hash(s);
    for (int call = 0; call < 2; call++) {
        assert_int_equal(call == 0 ? buckle(s, &factor) : follow(s), DMB_ERR_UNSUPPORTED);
        assert_non_null(strstr(dmb_sim_message(s->sim), "DMB_STEADY_AT_REST"));
        assert_true(rig_hash(s) == before);
    }
    print_message("%s\n", dmb_sim_message(s->sim));
}

static void stiffness_of_what_moves(void **state)
{
    static const int32_t kinds[] = {DMB_STEADY_SLIDING, DMB_STEADY_SLIDING, DMB_STEADY_RIGID};
    double euler = 0.0;
    (void)state;
    for (int motion = 0; motion < MOTIONS; motion++) {
        rig s;
        dmb_static_options options = dmb_static_options_default();
        double factor = 0.0;
        column(&s, motion);
        assert_int_equal(find_equilibrium(&s, NULL).steady, kinds[motion]);
        check_refused(&s);
        take_steps(&s, 1e-4, 5); /* a run goes on in that state */
        check_refused(&s);
        options.steady = DMB_STEADY_AT_REST;
        (void)find_equilibrium(&s, &options);
        if (buckle(&s, &factor) < 0) fail_msg("%s", dmb_sim_message(s.sim));
        assert_true(follow(&s) >= 0);
        if (motion != SWINGS) { /* of a dead load; all the same column */
            if (motion > 0) check_relative("critical factor", factor, euler, 1e-6);
            euler = factor;
        }
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drives_that_disagree),    cmocka_unit_test(forces_that_turn),
        cmocka_unit_test(guides_that_hold),        cmocka_unit_test(pipes_that_only_slide),
        cmocka_unit_test(joints_that_are_driven),  cmocka_unit_test(springs_to_the_ground),
        cmocka_unit_test(springs_that_change),     cmocka_unit_test(joints_that_do_not_let_it),
        cmocka_unit_test(stiffness_of_what_moves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
