/* Joints closed at the start: rigid bodies move by any distance, strings move as rigid bodies, and elements are
 * strained only where the caller allows the energy. Checks eq:joints.levenberg and eq:joints.placement. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"

static dmb_body_def block_at(double x, double y, double z)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 10.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 1.0;
    body.position[0] = x;
    body.position[1] = y;
    body.position[2] = z;
    return body;
}

static dmb_id add_rod(rig *s, int32_t free, double x, double y, uint32_t elements)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.follows_hole = 0;
    string.start_free = free;
    string.position[0] = x;
    string.position[1] = y;
    const dmb_id id = add_string(s, &string);
    pipe.string = id;
    pipe.length = 1.0;
    pipe.elements = elements;
    (void)add_pipes(s, &pipe, 4);
    return id;
}

static const dmb_place ground = {0};

/* A body of any distance comes to its joint: to the ground, and to the end of a clamped string, which stays. */
static void bodies_move_by_any_distance(void **state)
{
    const double far[] = {0.0, 0.5, 5.0, 300.0, 20000.0};
    (void)state;
    for (size_t i = 0; i < sizeof far / sizeof *far; i++)
        for (uint32_t elements = 1; elements <= 4; elements *= 2)
            for (int on_string = 0; on_string < 2; on_string++) {
                rig s;
                rig_open(&s, 0.0, 0.0, -9.81);
                const dmb_body_def body = block_at(far[i], -0.3 * far[i], 0.1 * far[i]);
                const dmb_id id = add_body(&s, &body);
                const dmb_id rod = add_rod(&s, DMB_FREE_NONE, 0.0, 0.0, elements);
                (void)add_joint_between(&s, DMB_JOINT_FIXED, on_string ? dmb_station(rod, 3, 1.0) : ground,
                                        dmb_station(id, 0, 0.0));
                (void)rig_start(&s, NULL);
                check_close("body [m]", pose_at(&s, dmb_station(id, 0, 0.0)).position[0], on_string ? 4.0 : 0.0, 1e-11);
                check_close("end of the string [m]", pose_at(&s, dmb_station(rod, 3, 1.0)).position[0], 4.0, 1e-11);
                check_below("strain energy [J]", energy_of(&s).strain, 1e-12);
                rig_close(&s);
            }
}

/* A loose string comes to two points in any direction, a guided one slides and turns; neither is strained. */
static void strings_move_as_rigid_bodies(void **state)
{
    const double ends[][3] = {{4.0, 0.0, 0.0}, {0.0, 4.0, 0.0}, {0.0, 0.0, -4.0}, {2.4, 0.0, 3.2}};
    (void)state;
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_id rod = add_rod(&s, DMB_FREE_ALL, 3.0, 1.0, 1);
        dmb_joint_def pin = joint_between(DMB_JOINT_SPHERICAL, ground, dmb_station(rod, 0, 0.0));
        (void)add_joint(&s, &pin);
        pin.place_b = dmb_station(rod, 3, 1.0);
        memcpy(pin.origin_a, ends[i], sizeof pin.origin_a);
        (void)add_joint(&s, &pin);
        (void)rig_start(&s, NULL);
        const dmb_pose end = pose_at(&s, dmb_station(rod, 3, 1.0));
        check_below("end of the string [m]", largest_difference(3, end.position, ends[i]), 1e-11);
        check_below("strain energy [J]", energy_of(&s).strain, 1e-12);
        rig_close(&s);
    }
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id rod = add_rod(&s, DMB_FREE_CYLINDRICAL, 0.0, 0.0, 2);
    dmb_joint_def pin = joint_between(DMB_JOINT_SPHERICAL, ground, dmb_station(rod, 3, 1.0));
    pin.origin_a[0] = 40.0;
    (void)add_joint(&s, &pin);
    (void)rig_start(&s, NULL);
    check_close("rig end of a guided string [m]", pose_at(&s, dmb_station(rod, 0, 0.0)).position[0], 36.0, 1e-11);
    check_below("strain energy [J]", energy_of(&s).strain, 1e-12);
    rig_close(&s);
}

/* ---- Chains of strings ------------------------------------------------------------------------------------------- */

/* Strings of two pipes, joined end to start by joints of any kind, described anywhere and turned by any angle up to
 * half a turn and beyond: the first is clamped, the others and a body at the far end come to where joints hold them. */
static void open_scattered(rig *s, uint64_t *seed, uint32_t strings, int at_default, int32_t free,
                           const int32_t kinds[], uint32_t kind_count, dmb_id joints[])
{
    dmb_id before = {0, 0};
    rig_open(s, 0.0, 0.0, -9.81);
    for (uint32_t k = 0; k <= strings; k++) {
        dmb_string_def def = dmb_string_def_default();
        dmb_pipe_def pipe = dmb_pipe_def_default();
        dmb_body_def body = block_at(0.0, 0.0, 0.0);
        (void)snprintf(def.name, sizeof def.name, "string %u", k);
        def.follows_hole = 0;
        def.start_free = k == 0 ? DMB_FREE_NONE : free;
        for (int i = 0; i < 3 && k > 0 && !at_default; i++) {
            body.position[i] = def.position[i] = draw_between(seed, -200.0, 200.0);
            body.rotation[i] = def.rotation[i] = draw_between(seed, -2.0, 2.0);
        }
        dmb_place here;
        dmb_id string = before;
        if (k < strings) {
            pipe.string = string = add_string(s, &def);
            (void)add_pipes(s, &pipe, 2);
            here = dmb_station(string, 0, 0.0);
        } else {
            here = dmb_station(add_body(s, &body), 0, 0.0);
        }
        if (k > 0) {
            dmb_joint_def joint = joint_between(kinds[(k - 1) % kind_count], dmb_station(before, 1, 1.0), here);
            joint.length = 0.7;
            joints[k - 1] = add_joint(s, &joint);
        }
        before = string;
    }
}

static void check_scattered(rig *s, uint32_t count, const dmb_id joints[])
{
    (void)rig_start(s, NULL);
    check_below("strain energy [J]", energy_of(s).strain, 1e-10);
    for (uint32_t k = 0; k < count; k++) {
        dmb_joint_state state = dmb_joint_state_default();
        must(s, dmb_query_joint(s->sim, joints[k], &state));
        check_below("violation of a joint [m, -]", state.violation, 1e-11);
    }
}

/* Fixed joints continue the first string: every part lies on its axis, unturned, two pipes of 1 m further on. */
static void check_straight(const rig *s, uint32_t strings)
{
    for (uint32_t k = 0; k < strings; k++) {
        dmb_id string;
        char name[24];
        const double want[3] = {2.0 * k + 2.0, 0.0, 0.0};
        (void)snprintf(name, sizeof name, "string %u", k);
        must_model(s, dmb_model_find(s->model, DMB_PART_STRING, name, &string));
        const dmb_pose end = pose_at(s, dmb_station(string, 1, 1.0));
        check_below("end of a string [m]", largest_difference(3, end.position, want), 1e-11);
        check_below("    1 - cosines of its axes", 3.0 - end.rotation[0] - end.rotation[4] - end.rotation[8], 1e-13);
    }
}

enum { MOST_STRINGS = 40 };

/* Of 5 nodes and of 81, with and without a dense matrix of the constraints. */
static void chains_of_strings_come_together(void **state)
{
    static const int32_t fixed[] = {DMB_JOINT_FIXED};
    static const int32_t mixed[] = {DMB_JOINT_FIXED,     DMB_JOINT_REVOLUTE,  DMB_JOINT_SPHERICAL,
                                    DMB_JOINT_PRISMATIC, DMB_JOINT_UNIVERSAL, DMB_JOINT_CYLINDRICAL,
                                    DMB_JOINT_DISTANCE,  DMB_JOINT_PLANAR};
    (void)state;
    for (uint64_t k = 1; k <= 40; k++)
        for (int kind = 0; kind < 2; kind++) {
            uint64_t seed = 104729 * k;
            const uint32_t strings = k % 4 == 0 ? MOST_STRINGS : 1 + (uint32_t)(k % 4);
            dmb_id joints[MOST_STRINGS];
            rig s;
            open_scattered(&s, &seed, strings, k == 1, DMB_FREE_ALL, kind == 0 ? fixed : mixed, kind == 0 ? 1 : 8,
                           joints);
            check_scattered(&s, strings, joints);
            if (kind == 0) check_straight(&s, strings);
            rig_close(&s);
        }
}

/* Strings that supports let slide and turn come together along their supports. */
static void supportd_strings_slide_together(void **state)
{
    static const int32_t fixed[] = {DMB_JOINT_FIXED};
    static const uint32_t counts[] = {2, 3, 20};
    (void)state;
    for (int i = 0; i < 3; i++) {
        uint64_t seed = 1;
        dmb_id joints[MOST_STRINGS];
        rig s;
        open_scattered(&s, &seed, counts[i], 1, DMB_FREE_CYLINDRICAL, fixed, 1, joints);
        check_scattered(&s, counts[i], joints);
        check_straight(&s, counts[i]);
        rig_close(&s);
    }
}

/* Two clamped strings whose ends are a gap apart: EA/L (gap/2)^2/2 in each of the two elements at the joint. */
static void strain_needs_the_callers_leave(void **state)
{
    const double gap = 1e-3;
    (void)state;
    for (int allowed = 0; allowed < 2; allowed++) {
        dmb_sim_options options = dmb_sim_options_default();
        dmb_string_def string = dmb_string_def_default();
        dmb_pipe_def pipe = dmb_pipe_def_default();
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        const dmb_id one = add_rod(&s, DMB_FREE_NONE, 0.0, 0.0, 1);
        string.follows_hole = 0;
        string.start_free = DMB_FREE_NONE;
        string.position[0] = 8.0 + gap;
        string.rotation[2] = PI;
        const dmb_id two = add_string(&s, &string);
        pipe.string = two;
        pipe.length = 1.0;
        (void)add_pipes(&s, &pipe, 4);
        (void)add_joint_between(&s, DMB_JOINT_SPHERICAL, dmb_station(one, 3, 1.0), dmb_station(two, 3, 1.0));
        must_model(&s, dmb_model_compile(s.model, NULL));
        const double area = 0.25 * PI * (pow(pipe.outer_diameter, 2) - pow(pipe.inner_diameter, 2));
        const double energy = pipe.young_modulus * area * 0.25 * gap * gap;
        options.assembly_energy = allowed ? 1.01 * energy : 0.99 * energy;
        const int32_t status = dmb_sim_create(s.model, &options, &s.sim);
        if (allowed) {
            assert_int_equal(status, DMB_NOTE_PROJECTED);
            check_relative("strain energy [J]", energy_of(&s).strain, energy, 1e-6);
        } else {
            const char *text = dmb_model_message(s.model);
            assert_int_equal(status, DMB_ERR_GEOMETRY);
            assert_null(s.sim);
            if (strstr(text, "pipe 3") == NULL || strstr(text, "assembly_energy") == NULL) fail_msg("%s", text);
            const char *by = strstr(text, "by ");
            if (by == NULL) fail_msg("%s", text);
            check_relative("energy of the message [J]", strtod(by + 3, NULL), energy, 1e-4);
        }
        rig_close(&s);
    }
}

/* ---- Four-bars --------------------------------------------------------------------------------------------------- */

static void add_pin(rig *s, dmb_place a, double xa, dmb_place b, double xb)
{
    dmb_joint_def pin = joint_between(DMB_JOINT_REVOLUTE, a, b);
    pin.origin_a[0] = xa;
    pin.origin_b[0] = xb;
    for (int i = 0; i < 3; i++) {
        pin.axis_a[i] = pin.axis_b[i] = i == 2 ? 1.0 : 0.0;
        pin.normal_a[i] = pin.normal_b[i] = i == 0 ? 1.0 : 0.0;
    }
    (void)add_joint(s, &pin);
}

/* Crank, coupler and rocker described anywhere near their places, in space: their spatial loop has three redundant
 * equations once it is closed, and moves with one degree of freedom. */
static void scattered_fourbars_are_closed(void **state)
{
    const char *more = getenv("DMB_SEEDS");
    const uint64_t seeds = more != NULL ? strtoull(more, NULL, 10) : 200;
    (void)state;
    for (uint64_t k = 1; k <= seeds; k++) {
        uint64_t seed = k * 7919;
        dmb_id bar[3];
        double length[3], base;
        rig s;
        rig_open(&s, 0.0, 0.0, -9.81);
        for (int i = 0; i < 3; i++) length[i] = draw_between(&seed, 0.8, 1.2);
        base = draw_between(&seed, 0.8, 1.2);
        for (int i = 0; i < 3; i++) {
            dmb_body_def body = block_at(i == 0   ? 0.0
                                         : i == 1 ? 0.5 * length[1]
                                                  : base,
                                         i == 1 ? length[0] : 0.5 * length[i], 0.0);
            body.rotation[2] = i == 0 ? 0.5 * PI : i == 1 ? 0.0 : -0.5 * PI;
            for (int c = 0; c < 3; c++) {
                body.position[c] += draw_between(&seed, -0.4, 0.4);
                body.rotation[c] += draw_between(&seed, -0.4, 0.4);
            }
            bar[i] = add_body(&s, &body);
        }
        add_pin(&s, ground, 0.0, dmb_station(bar[0], 0, 0.0), -0.5 * length[0]);
        add_pin(&s, dmb_station(bar[0], 0, 0.0), 0.5 * length[0], dmb_station(bar[1], 0, 0.0), -0.5 * length[1]);
        add_pin(&s, dmb_station(bar[1], 0, 0.0), 0.5 * length[1], dmb_station(bar[2], 0, 0.0), -0.5 * length[2]);
        add_pin(&s, ground, base, dmb_station(bar[2], 0, 0.0), 0.5 * length[2]);
        must_model(&s, dmb_model_compile(s.model, NULL));
        const int32_t status = dmb_sim_create(s.model, NULL, &s.sim);
        if (status < 0) fail_msg("four-bar %u: %s", (unsigned)k, dmb_model_message(s.model));
        dmb_check_report report = dmb_check_report_default();
        must(&s, dmb_analysis_check(s.sim, &report));
        if (report.degrees_of_freedom != 1) fail_msg("four-bar %u: %d dof", (unsigned)k, report.degrees_of_freedom);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_move_by_any_distance),     cmocka_unit_test(strings_move_as_rigid_bodies),
        cmocka_unit_test(chains_of_strings_come_together), cmocka_unit_test(supportd_strings_slide_together),
        cmocka_unit_test(strain_needs_the_callers_leave),  cmocka_unit_test(scattered_fourbars_are_closed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
