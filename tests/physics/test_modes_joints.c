/* Modes of scenes with joints: pendulums in closed form, and a string drawn with explicit joints beside the same one in
 * one piece. */
#include <stdio.h>
#include <string.h>

#include "mechanism.h"
#include "modal.h"

/* ---- Pendulums --------------------------------------------------------------------------------------------------- */

/* Uniform bars of length L hang one from the other by hinges. */
static void open_pendulum(rig *s, uint32_t count, double L, double mass)
{
    dmb_id above = ground_id;
    rig_open(s, 0, 0, -9.81);
    for (uint32_t i = 0; i < count; i++) {
        const bar def = {{0.0, -(double)i * L}, {0.0, -(double)(i + 1) * L}, mass};
        char name[24];
        const dmb_id below = add_bar(s, &def);
        (void)snprintf(name, sizeof name, "pin %u", i);
        (void)add_hinge(s, name, DMB_JOINT_REVOLUTE, i == 0 ? pin_ground(0.0, 0.0) : pin_on(above, 0.5 * L),
                        pin_on(below, -0.5 * L));
        above = below;
    }
    (void)mechanism_start(s, NULL);
}

static void pendulum(void **state)
{
    (void)state;
    rig s;
    open_pendulum(&s, 1, 0.8, 3.0);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 1);
    assert_int_equal(info_of(modes).coordinates, 1);
    check_relative("pendulum, sqrt(3 g/(2 L))", frequency_at(modes, 0), sqrt(1.5 * 9.81 / 0.8) / (2.0 * PI), 1e-12);
    const dmb_mode mode = mode_at(modes, 0);
    assert_int_equal(mode.rigid, 0); /* weight holds it */
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* m L^2 [4/3 1/2; 1/2 1/3] a'' + m g L [3/2 0; 0 1/2] a = 0: w^2 = (3 -+ 6/sqrt 7) g/L. */
static void double_pendulum(void **state)
{
    (void)state;
    rig s;
    open_pendulum(&s, 2, 0.8, 3.0);
    for (int32_t kind = DMB_MODES_UNDAMPED; kind <= DMB_MODES_DAMPED; kind++) {
        dmb_modes *modes = lowest_modes(&s, kind, 2);
        for (uint32_t i = 0; i < 2; i++) {
            const double square = (3.0 + (i == 0 ? -6.0 : 6.0) / sqrt(7.0)) * 9.81 / 0.8;
            check_relative(kind ? "two pendulums, first order" : "two pendulums", frequency_at(modes, i),
                           sqrt(square) / (2.0 * PI), 1e-11);
        }
        dmb_modes_destroy(&modes);
    }
    rig_close(&s);
}

/* A spring and a damper in the hinge of a bar without weight: w0^2 = k/J, zeta = c/(2 sqrt(k J)). */
static void spring_and_damper_of_a_joint(void **state)
{
    (void)state;
    rig s;
    const bar def = {{0.0, 0.0}, {1.0, 0.0}, 3.0};
    rig_open(&s, 0, 0, 0);
    dmb_joint_def hinge = hinge_of("hinge", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(add_bar(&s, &def), -0.5));
    hinge.stiffness[DMB_RX] = 100.0;
    hinge.damping[DMB_RX] = 4.0;
    (void)add_joint(&s, &hinge);
    (void)mechanism_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 1);
    const dmb_mode mode = mode_at(modes, 0);
    check_relative("spring in a hinge, sqrt(k/J)", mode.frequency, sqrt(100.0 / 1.0) / (2.0 * PI), 1e-12);
    check_relative("its damper, c/(2 sqrt(k J))", mode.damping, 0.2, 1e-12);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* A body that slides along an oblique axis against a spring, unloaded: nothing but rounding of the place acts, and a
 * state that statics take is one that modes take. */
static void spring_without_load(void **state)
{
    (void)state;
    for (double stiffness = 1.0; stiffness <= 1e8; stiffness *= 100.0) {
        rig s;
        dmb_body_def body = dmb_body_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        rig_open(&s, 0, 0, 0);
        body.mass = 3.0;
        for (int c = 0; c < 3; c++) {
            body.position[c] = 0.3 + 0.7 * c;
            body.rotation[c] = 0.4 - 0.3 * c;
            joint.origin_a[c] = 0.1 + 0.2 * c;
            joint.axis_a[c] = 1.0 / (1.0 + c);
        }
        joint.kind = DMB_JOINT_CYLINDRICAL;
        joint.place_a = dmb_station(ground_id, 0, 0.0);
        joint.place_b = dmb_station(add_body(&s, &body), 0, 0.0);
        joint.match = 1;
        joint.stiffness[DMB_X] = stiffness;
        (void)add_joint(&s, &joint);
        (void)mechanism_start(&s, NULL);
        dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 2);
        check_relative("unloaded spring along an oblique axis, sqrt(k/m)", frequency_at(modes, 1),
                       sqrt(stiffness / 3.0) / (2.0 * PI), 1e-10);
        dmb_modes_destroy(&modes);
        rig_close(&s);
    }
}

/* ---- A string of strings ----------------------------------------------------------------------------------------- */

/* Pipes one after the other from x = 0, clamped at the start: one string, or strings of one pipe each with fixed
 * joints. */
static void open_row(rig *s, uint32_t pipes, int explicit_joints)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_place last = dmb_station(ground_id, 0, 0.0);
    rig_open(s, 0, 0, 0);
    for (uint32_t i = 0; i < (explicit_joints ? pipes : 1); i++) {
        dmb_string_def string = dmb_string_def_default();
        string.start_free = explicit_joints ? DMB_FREE_ALL : DMB_FREE_NONE;
        string.position[0] = 1.5 * i;
        pipe.string = add_string(s, &string);
        (void)add_pipes(s, &pipe, explicit_joints ? 1 : pipes);
        if (!explicit_joints) continue;
        dmb_joint_def joint = dmb_joint_def_default();
        joint.place_a = last;
        joint.place_b = dmb_station(pipe.string, 0, 0.0);
        if (i == 0) joint.match = 1;
        (void)add_joint(s, &joint);
        last = dmb_station(pipe.string, 0, 1.0);
    }
    (void)mechanism_start(s, NULL);
}

/* All 100 pipes as flexible bodies of their own: 1200 coordinates, 600 equations, and the modes of the string. */
static void explicit_joints_change_nothing(void **state)
{
    (void)state;
    rig a, b;
    open_row(&a, 100, 0);
    open_row(&b, 100, 1);
    dmb_modes *one = lowest_modes(&a, DMB_MODES_UNDAMPED, 20), *many = lowest_modes(&b, DMB_MODES_UNDAMPED, 20);
    assert_int_equal(info_of(one).coordinates, 600);
    assert_int_equal(info_of(many).coordinates, 600);
    assert_int_equal(info_of(many).dense, 0);
    double worst = 0.0;
    for (uint32_t i = 0; i < 20; i++) worst = fmax(worst, fabs(frequency_at(many, i) / frequency_at(one, i) - 1.0));
    check_below("100 pipes with explicit joints against one string, 20 modes", worst, 1e-7);
    dmb_modes_destroy(&one);
    dmb_modes_destroy(&many);
    rig_close(&a);
    rig_close(&b);
}

/* The whole spectrum of a shorter one, by LAPACK. */
static void whole_spectrum_with_joints(void **state)
{
    (void)state;
    rig a, b;
    open_row(&a, 20, 0);
    open_row(&b, 20, 1);
    dmb_modes *one = all_modes(&a, DMB_MODES_UNDAMPED), *many = all_modes(&b, DMB_MODES_UNDAMPED);
    assert_int_equal(info_of(one).count, 120);
    assert_int_equal(info_of(many).count, 120);
    double worst = 0.0;
    for (uint32_t i = 0; i < 120; i++) worst = fmax(worst, fabs(frequency_at(many, i) / frequency_at(one, i) - 1.0));
    check_below("20 pipes, all 120 modes", worst, 1e-9);
    tell("  highest of them [Hz]", frequency_at(one, 119));
    dmb_modes_destroy(&one);
    dmb_modes_destroy(&many);
    rig_close(&a);
    rig_close(&b);
}

/* A string with joints that is free to slide and turn: K is singular, and the shift does its work. */
static void free_with_joints(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_joint_def joint = dmb_joint_def_default();
    rig_open(&s, 0, 0, 0);
    dmb_place last = dmb_station(ground_id, 0, 0.0);
    for (uint32_t i = 0; i < 2; i++) {
        dmb_string_def string = dmb_string_def_default();
        string.start_free = DMB_FREE_ALL;
        string.position[0] = 30.0 * i;
        pipe.string = add_string(&s, &string);
        (void)add_pipes(&s, &pipe, 20);
        joint.kind = i == 0 ? DMB_JOINT_CYLINDRICAL : DMB_JOINT_FIXED;
        joint.match = i == 0;
        joint.place_a = last;
        joint.place_b = dmb_station(pipe.string, 0, 0.0);
        (void)add_joint(&s, &joint);
        last = dmb_station(pipe.string, 19, 1.0);
    }
    (void)mechanism_start(&s, NULL);
    for (int32_t kind = DMB_MODES_UNDAMPED; kind <= DMB_MODES_DAMPED; kind++) {
        dmb_modes *modes = lowest_modes(&s, kind, 8);
        assert_int_equal(info_of(modes).dense, 0);
        assert_true(info_of(modes).rigid >= 2);
        const s1_section v = s1_values();
        const double want = pow(1.875104068712 / 60.0, 2) * sqrt(v.EI / v.mass) / (2.0 * PI);
        check_relative(kind ? "60 m guided by a joint, first order" : "60 m guided by a joint",
                       frequency_of_kind(modes, 2, 0), want, 1e-5);
        dmb_modes_destroy(&modes);
    }
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pendulum),
        cmocka_unit_test(double_pendulum),
        cmocka_unit_test(spring_and_damper_of_a_joint),
        cmocka_unit_test(spring_without_load),
        cmocka_unit_test(explicit_joints_change_nothing),
        cmocka_unit_test(whole_spectrum_with_joints),
        cmocka_unit_test(free_with_joints),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
