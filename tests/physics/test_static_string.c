/* Statics of the reference string S1 in its hole: at rest, pushed, turning, falling on the wall, refined, and long.
 * Equations: eq:static.line-search. */
#include <stdio.h>
#include <stdlib.h>

#include "rig.h"

/* Friction that acts in full at the slips given: Coulomb, mu 0.3, 1000 m/s against a smoothing of 1e-6 m/s. */
#define FAST 1e3

typedef struct s1_choice {
    int32_t kind; /* DMB_PIPE_... */
    uint32_t pipes, elements;
    double push, torque; /* [N] against the feed and [N m] against the rotation, at the far end */
} s1_choice;

static dmb_id open_s1(rig *s, const s1_choice *choice)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.mu_static = wall.mu_dynamic = 0.3;
    wall.smoothing_speed = 1e-6;
    def.start_free = DMB_FREE_NONE;
    rig_open(s, 0.0, 0.0, -9.81);
    (void)add_wall(s, &wall);
    pipe.kind = choice->kind;
    pipe.elements = choice->elements;
    pipe.string = add_string(s, &def);
    const dmb_id string = add_pipes(s, &pipe, choice->pipes);
    if (choice->push != 0.0 || choice->torque != 0.0) {
        dmb_load_def load = dmb_load_def_default();
        load.frame = DMB_FRAME_HOLE;
        load.place = dmb_station(string, choice->pipes - 1, 1.0);
        load.force[0] = -choice->push;
        load.moment[0] = -choice->torque;
        (void)add_load(s, &load);
    }
    (void)rig_start(s, NULL);
    return string;
}

static dmb_static_report rest(const rig *s, double slip_axial, double slip_rotation)
{
    dmb_static_options options = dmb_static_options_default();
    options.slip_axial = slip_axial;
    options.slip_rotation = slip_rotation;
    options.tolerance = 1e-12;
    return find_equilibrium(s, &options);
}

static void rig_end_reaction(const rig *s, dmb_id string, double reaction[6])
{
    must(s, dmb_query_reaction(s->sim, string, reaction));
}

/* ---- At rest in the hole ----------------------------------------------------------------------------------------- */

/* Closed form of the stiff string (CASES.md): sum of normals w L, rig force WOB + mu w L, compression
 * WOB L/EA + mu w L^2/(2 EA), rig torque T + mu w L r, twist T L/GJ + mu w r L^2/(2 GJ). */
static void pushed_axial_torsional_string(void **state)
{
    (void)state;
    const s1_choice choice = {DMB_PIPE_AXIAL_TORSIONAL, 100, 1, 2960.0, 0.0};
    rig s;
    double reaction[6];
    const dmb_id string = open_s1(&s, &choice);
    (void)rest(&s, FAST, 0.0);
    rig_end_reaction(&s, string, reaction);
    const dmb_pose tip = pose_at(&s, dmb_station(string, 99, 1.0));
    check_relative("sum of normals", contacts_of(&s).normal_force, 20902.6948, 1e-8);
    check_relative("rig force", reaction[0], 9230.80843743, 1e-9);
    check_relative("compression", -tip.displacement[0], 2.40603599e-3, 1e-8);
    check_below("torque", reaction[3], 1e-9);
    rig_close(&s);
}

static void turning_axial_torsional_string(void **state)
{
    (void)state;
    const s1_choice choice = {DMB_PIPE_AXIAL_TORSIONAL, 100, 1, 0.0, 100.0};
    rig s;
    double reaction[6];
    const dmb_id string = open_s1(&s, &choice);
    (void)rest(&s, 0.0, FAST);
    rig_end_reaction(&s, string, reaction);
    check_relative("rig torque", reaction[3], 328.884508, 1e-8);
    check_relative("twist", -rotation_at(&s, dmb_station(string, 99, 1.0)), 0.2107554605, 1e-8);
    check_below("rig force", reaction[0], 1e-7);
    rig_close(&s);
}

/* A flexible string sags between pipe ends and hangs in its support; wall and support together carry the weight, and
 * the rig pushes with WOB + mu times what the wall carries. */
static void pushed_flexible_string(void **state)
{
    (void)state;
    const s1_choice choice = {DMB_PIPE_FLEXIBLE, 100, 1, 2960.0, 0.0};
    const double weight = 150.0 * s1_values().weight;
    rig s;
    double reaction[6];
    const dmb_id string = open_s1(&s, &choice);
    const dmb_static_report report = rest(&s, FAST, 0.0);
    rig_end_reaction(&s, string, reaction);
    const dmb_contact_total sum = contacts_of(&s);
    const dmb_pose tip = pose_at(&s, dmb_station(string, 99, 1.0));
    check_relative("wall and support carry the weight", sum.normal_force + reaction[2], weight, 1e-6);
    check_relative("rig force", reaction[0], 2960.0 + 0.3 * sum.normal_force, 1e-9);
    tell("    share of the support [N]", reaction[2]);
    check_relative("compression against the stiff string", -tip.displacement[0], 2.40603599e-3, 0.01);
    check_below("iterations", report.iterations, 20.0);
    rig_close(&s);
}

/* The same turning: torque by friction around the axis climbs the wall by little; what is left is that of the normals.
 */
static void turning_flexible_string(void **state)
{
    (void)state;
    const s1_choice choice = {DMB_PIPE_FLEXIBLE, 100, 1, 0.0, 100.0};
    rig s;
    double reaction[6];
    const dmb_id string = open_s1(&s, &choice);
    const dmb_static_report report = rest(&s, 0.0, FAST);
    rig_end_reaction(&s, string, reaction);
    const dmb_contact_total sum = contacts_of(&s);
    check_below("iterations", report.iterations, 20.0);
    /* Each ring rests at the angle atan(mu) up the wall: normal and friction together balance the weight. */
    check_relative("wall carries the weight through normal and friction",
                   sum.normal_force * sqrt(1.0 + 0.09) + reaction[2], 150.0 * s1_values().weight, 1e-4);
    check_relative("rig torque", reaction[3], 100.0 + 0.3 * 0.0365 * sum.normal_force, 1e-6);
    rig_close(&s);
}

/* ---- Hard case 14: everything falls on the wall at once ---------------------------------------------------------- */

/* Clamped on the axis, it touches down where moment and slope vanish: 72 EI c = w l^4, and 2 w l/3 hangs in the clamp.
 * So of S1 in a hole of 94 mm the nodes on the first 5.73 m stay in the air. */
static double touchdown(void)
{
    const s1_section v = s1_values();
    return sqrt(sqrt(72.0 * v.EI * 0.0105 / v.weight));
}

static void check_fall(uint32_t nodes, int32_t lay, double iterations)
{
    const s1_choice choice = {DMB_PIPE_FLEXIBLE, nodes, 1, 0.0, 0.0};
    rig s;
    dmb_static_options options = dmb_static_options_default();
    double reaction[6];
    const dmb_id string = open_s1(&s, &choice);
    options.lay_on_wall = lay;
    const dmb_static_report report = find_equilibrium(&s, &options);
    const dmb_contact_total sum = contacts_of(&s);
    rig_end_reaction(&s, string, reaction);
    print_message("    %u nodes, %s\n", nodes, lay ? "laid on the wall first" : "from the axis");
    check_below("    iterations", report.iterations, iterations);
    check_relative("    weight on wall and clamp", sum.normal_force + reaction[2], 1.5 * nodes * s1_values().weight,
                   1e-6);
    assert_int_equal(nodes - sum.closed, (int)(touchdown() / 1.5));
    if (lay) assert_int_equal(report.method, DMB_STATIC_NEWTON);
    rig_close(&s);
}

static void string_falls_on_the_wall(void **state)
{
    (void)state;
    check_fall(100, 1, 19.0);
    check_fall(1000, 1, 19.0);
}

/* Without the first guess Newton alone does not find the wall; the relaxation does, in 24 iterations in all. */
static void string_falls_from_the_axis(void **state)
{
    (void)state;
    check_fall(100, 0, 30.0);
    check_fall(1000, 0, 30.0);
}

/* A short string from the axis: the whole load at once fails, a quarter and an eighth of it too; a sixteenth does with
 * corrections that the line search shortens, and from there steps double. */
static void load_steps_choose_themselves(void **state)
{
    (void)state;
    rig s;
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    dmb_static_options options = dmb_static_options_default();
    double reaction[6];
    def.start_free = DMB_FREE_NONE;
    rig_open(&s, 0.0, 0.0, -9.81);
    (void)add_wall(&s, &wall);
    pipe.length = 1.0;
    pipe.string = add_string(&s, &def);
    const dmb_id string = add_pipes(&s, &pipe, 40);
    (void)rig_start(&s, NULL);
    options.lay_on_wall = 0;
    const dmb_static_report report = find_equilibrium(&s, &options);
    rig_end_reaction(&s, string, reaction);
    print_message("    %u iterations, %u load steps, %u cuts, %u line searches\n", report.iterations, report.load_steps,
                  report.cuts, report.line_searches);
    assert_int_equal(report.method, DMB_STATIC_NEWTON);
    assert_true(report.load_steps > 1 && report.load_steps < 16);
    assert_true(report.cuts > 0);
    assert_true(report.line_searches > 0);
    assert_int_equal(report.negative, 0);
    check_relative("    weight on wall and clamp", contacts_of(&s).normal_force + reaction[2],
                   40.0 * s1_values().weight, 1e-6);
    rig_close(&s);
}

/* ---- Hard case 3: long strings ----------------------------------------------------------------------------------- */

static uint64_t bytes_of_string(uint32_t pipes, uint32_t *iterations)
{
    const s1_choice choice = {DMB_PIPE_FLEXIBLE, pipes, 1, 2960.0, 0.0};
    rig s;
    dmb_model_info info = dmb_model_info_default();
    (void)open_s1(&s, &choice);
    must_model(&s, dmb_model_get_info(s.model, &info));
    *iterations = rest(&s, FAST, 0.0).iterations;
    rig_close(&s);
    return info.model_bytes + info.sim_bytes;
}

/* Memory grows with the number of pipes and iterations do not: with linear work an iteration the time is linear. */
static void long_strings_cost_in_proportion(void **state)
{
    (void)state;
    uint32_t few, many;
    const double small = (double)bytes_of_string(1000, &few);
    const double large = (double)bytes_of_string(10000, &many);
    check_below("1000 pipes: iterations", few, 20.0);
    check_below("10000 pipes: iterations", many, 20.0);
    tell("    bytes a pipe", large / 10000.0);
    check_relative("memory of 10000 pipes over that of 1000", large / small, 10.0, 0.01);
}

/* ---- Refinement -------------------------------------------------------------------------------------------------- */

/* Forces of S1 with 1, 2, 4 .. elements in a pipe of 1.5 m. The wall carries what the clamp leaves; the clamp carries
 * 2 w l/3 of the closed form above (531.96 N with a rigid wall, without shear). Where the string touches down is known
 * to one element, so the convergence is not smooth: 536.9, 531.1, 531.7, 531.7 N. */
static void forces_do_not_depend_on_the_mesh(void **state)
{
    (void)state;
    const double want = 2.0 / 3.0 * s1_values().weight * touchdown();
    const double tolerance[4] = {0.01, 0.003, 0.001, 0.001};
    for (uint32_t k = 0; k < 4; k++) {
        const s1_choice choice = {DMB_PIPE_FLEXIBLE, 100, 1u << k, 0.0, 0.0};
        rig s;
        double reaction[6];
        const dmb_id string = open_s1(&s, &choice);
        (void)rest(&s, 0.0, 0.0);
        rig_end_reaction(&s, string, reaction);
        print_message("    %u elements a pipe: clamp %.3f N, wall %.3f N, deepest %.4g m\n", 1u << k, reaction[2],
                      contacts_of(&s).normal_force, contacts_of(&s).deepest);
        check_relative("    clamp", reaction[2], want, tolerance[k]);
        check_relative("    clamp and wall", contacts_of(&s).normal_force + reaction[2], 150.0 * s1_values().weight,
                       1e-10);
        rig_close(&s);
    }
}

/* A pipe of 24 m, clamped at its rig end, whose far end lies on the wall of a wide hole through the ring of a body:
 * contact force, sag at the middle and moment in the clamp under its weight, with bending so large that the nodes are
 * no longer exact. */
typedef struct prop {
    double normal, sag, moment;
} prop;

static prop propped(uint32_t elements)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def def = dmb_string_def_default();
    dmb_body_def ring = dmb_body_def_default();
    rig s;
    prop out;
    double reaction[6];
    wall.diameter = 8.0;
    wall.stiffness = 1e6;
    wall.friction_law = DMB_FRICTION_NONE;
    def.start_free = DMB_FREE_NONE;
    rig_open(&s, 0.0, 0.0, -9.81);
    (void)add_wall(&s, &wall);
    pipe.length = 24.0;
    pipe.elements = elements;
    pipe.string = add_string(&s, &def);
    const dmb_id string = add_pipes(&s, &pipe, 1);
    ring.attach = DMB_ATTACH_END;
    ring.string = string;
    ring.mass = 1e-6;
    ring.contact_diameter = 7.9;
    ring.contact_length = 1.0;
    (void)add_body(&s, &ring);
    (void)rig_start(&s, NULL);
    (void)rest(&s, 0.0, 0.0);
    rig_end_reaction(&s, string, reaction);
    out.normal = contacts_of(&s).normal_force;
    out.sag = pose_at(&s, dmb_station(string, 0, 0.5)).displacement[2];
    out.moment = reaction[4];
    rig_close(&s);
    return out;
}

static void elements_are_of_fourth_order(void **state)
{
    (void)state;
    const prop exact = propped(128);
    prop error[4];
    for (uint32_t k = 0; k < 4; k++) {
        const prop got = propped(2u << k);
        error[k].normal = fabs(got.normal - exact.normal);
        error[k].sag = fabs(got.sag - exact.sag);
        error[k].moment = fabs(got.moment - exact.moment);
        print_message("    %2u elements: contact force off by %.3g, sag %.3g, moment %.3g (relative)\n", 2u << k,
                      error[k].normal / exact.normal, error[k].sag / fabs(exact.sag),
                      error[k].moment / fabs(exact.moment));
    }
    check_order("contact force, 8 and 16 elements", error[2].normal, error[3].normal, 4.0, 0.3);
    check_below("sag, 8 elements, falling faster than that", error[2].sag / fabs(exact.sag), 3e-6);
    check_below("sag, 16 elements", error[3].sag / fabs(exact.sag), 1.5e-7);
    check_order("moment in the clamp, 8 and 16 elements", error[2].moment, error[3].moment, 4.0, 0.3);
}

/* ---- Held by nothing along the hole ------------------------------------------------------------------------------ */

/* Sections and poses of a string with a heavy bit that may slide along its hole, and of one that may not. */
static void lie(int32_t start_free, double pose[2][3], double *moment)
{
    rig s;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_section section = dmb_section_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    def.start_free = start_free;
    bit.rock_law = DMB_ROCK_RATE;
    bit.bottom = 2e-3;
    pipe.length = 1.5;
    wall.stiffness = 1e7;
    rig_open(&s, 0.0, 0.0, -9.81);
    (void)add_wall(&s, &wall);
    pipe.string = add_string(&s, &def);
    const dmb_id string = add_pipes(&s, &pipe, 50);
    must_model(&s, dmb_model_add_bit(s.model, &bit, NULL));
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    for (uint32_t k = 0; k < 2; k++) {
        const dmb_pose p = pose_at(&s, dmb_station(string, k ? 49 : 0, k ? 1.0 : 0.0));
        for (int i = 0; i < 3; i++) pose[k][i] = p.position[i];
    }
    must(&s, dmb_query_section(s.sim, dmb_station(string, 48, 0.0), &section));
    *moment = section.force[4];
    rig_close(&s);
}

static void string_that_may_slide_stays(void **state)
{
    (void)state;
    double held[2][3], free_along[2][3], free_too[2][3], moment[3];
    lie(DMB_FREE_NONE, held, &moment[0]);
    lie(DMB_FREE_X, free_along, &moment[1]);
    lie(DMB_FREE_CYLINDRICAL, free_too, &moment[2]);
    for (int i = 0; i < 3; i++) {
        check_below("rig end", fabs(free_along[0][i] - held[0][i]), 1e-9);
        check_below("bit", fabs(free_along[1][i] - held[1][i]), 1e-7);
        check_below("rig end, rotation free too", fabs(free_too[0][i] - held[0][i]), 1e-9);
        check_below("bit, rotation free too", fabs(free_too[1][i] - held[1][i]), 1e-7);
    }
    check_relative("bending moment", moment[1], moment[0], 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pushed_axial_torsional_string),    cmocka_unit_test(turning_axial_torsional_string),
        cmocka_unit_test(pushed_flexible_string),           cmocka_unit_test(turning_flexible_string),
        cmocka_unit_test(load_steps_choose_themselves),     cmocka_unit_test(string_falls_on_the_wall),
        cmocka_unit_test(string_falls_from_the_axis),       cmocka_unit_test(long_strings_cost_in_proportion),
        cmocka_unit_test(forces_do_not_depend_on_the_mesh), cmocka_unit_test(elements_are_of_fourth_order),
        cmocka_unit_test(string_that_may_slide_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
