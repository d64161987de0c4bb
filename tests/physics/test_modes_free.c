/* Rigid-body modes of free and partly held systems against their numbers by hand; few modes against all of them, damped
 * equations without damping against undamped ones, and a string that is hardly bent against a straight one. */
#include <stdio.h>
#include <string.h>

#include "mechanism.h"
#include "modal.h"

enum { MODES = 14 };

/* Expected modes of a scene: so many rigid ones, the same elastic ones in all ways of finding them. */
static void check_ways(const char *what, const rig *s, uint32_t rigid, double tolerance)
{
    dmb_modes *found[4] = {lowest_modes(s, DMB_MODES_UNDAMPED, MODES), all_modes(s, DMB_MODES_UNDAMPED),
                           lowest_modes(s, DMB_MODES_DAMPED, MODES), all_modes(s, DMB_MODES_DAMPED)};
    double worst = 0.0, residual = 0.0;
    for (int way = 0; way < 4; way++) {
        const dmb_modes_info info = info_of(found[way]);
        assert_int_equal(info.rigid, rigid);
        assert_int_equal(info.dense, way % 2);
        if (way % 2) assert_int_equal(info.count, info.coordinates);
        residual = fmax(residual, info.residual);
        for (uint32_t i = 0; i < MODES; i++) {
            assert_int_equal(mode_at(found[way], i).rigid, i < rigid);
            if (i < rigid)
                assert_true(frequency_at(found[way], i) == 0.0);
            else
                worst = fmax(worst, fabs(frequency_at(found[way], i) / frequency_at(found[1], i) - 1.0));
        }
    }
    print_message("%s: %u rigid modes of %u coordinates, residual %.1e\n", what, rigid, info_of(found[0]).coordinates,
                  residual);
    check_below("  elastic frequencies in four ways, apart", worst, tolerance);
    check_below("  residual", residual, 1e-11);
    for (int way = 0; way < 4; way++) dmb_modes_destroy(found + way);
}

/* ---- One string -------------------------------------------------------------------------------------------------- */

typedef struct place {
    double position[3], rotation[3];
} place;

static const place home, away = {{300.0, -200.0, 50.0}, {1.0, 0.5, 2.0}};

/* Bent by an angle from end to end in its rest shape. */
static dmb_id add_bent(rig *s, const place *at, uint32_t pipes, double angle, int32_t start_free, int32_t end_free)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    memcpy(string.position, at->position, sizeof string.position);
    memcpy(string.rotation, at->rotation, sizeof string.rotation);
    string.follows_hole = 0;
    string.start_free = start_free;
    string.end_free = end_free;
    pipe.string = add_string(s, &string);
    pipe.curvature[2] = angle / (pipe.length * pipes);
    (void)add_pipes(s, &pipe, pipes);
    return pipe.string;
}

static void free_strings_have_six(void **state)
{
    (void)state;
    static const uint32_t pipes[2] = {12, 60};
    static const double angle[5] = {0.0, 1e-3, 0.1, 1.5, 7.0};
    for (int n = 0; n < 2; n++)
        for (int a = 0; a < 5; a++)
            for (int moved = 0; moved < 2; moved++) {
                char what[64];
                rig s;
                rig_open(&s, 0, 0, 0);
                (void)add_bent(&s, moved ? &away : &home, pipes[n], angle[a], DMB_FREE_ALL, DMB_FREE_ALL);
                rig_start(&s, NULL);
                (void)snprintf(what, sizeof what, "%u free pipes bent by %g%s", pipes[n], angle[a],
                               moved ? ", moved" : "");
                check_ways(what, &s, 6, n == 0 ? 1e-9 : 2e-6);
                rig_close(&s);
            }
}

/* The frequencies of a free string of 100 pipes that is bent by 0.1 rad are those of a straight one but for the square
 * of that; modes in the plane that turn into twist apart. beta L = 4.7300 of the first (Bernoulli; shear takes 1e-4).
 */
static void a_hundred_pipes_hardly_bent(void **state)
{
    (void)state;
    double f[2];
    for (int bent = 0; bent < 2; bent++) {
        rig s;
        rig_open(&s, 0, 0, 0);
        (void)add_bent(&s, &home, 100, bent ? 0.1 : 0.0, DMB_FREE_ALL, DMB_FREE_ALL);
        rig_start(&s, NULL);
        for (int32_t kind = DMB_MODES_UNDAMPED; kind <= DMB_MODES_DAMPED; kind++) {
            dmb_modes *modes = lowest_modes(&s, kind, 10);
            assert_int_equal(info_of(modes).rigid, 6);
            f[bent] = frequency_at(modes, 6);
            check_below("residual", info_of(modes).residual, 1e-11);
            dmb_modes_destroy(&modes);
        }
        rig_close(&s);
    }
    const s1_section v = s1_values();
    const double b = 4.730040744862704 / 150.0;
    check_relative("straight, closed form", f[0], b * b * sqrt(v.EI / v.mass) / (2.0 * PI), 1e-3);
    check_relative("bent against straight", f[1], f[0], 1e-3);
}

/* Motions that the ends leave free count: a shaft that spins, one that slides too, a ball joint, a straight hole's
 * worth of supports.
 */
static void partly_held_strings(void **state)
{
    (void)state;
    static const struct {
        const char *what;
        int32_t start, end;
        uint32_t rigid;
    } scene[6] = {{"clamped", DMB_FREE_NONE, DMB_FREE_ALL, 0},
                  {"free to spin", DMB_FREE_RX, DMB_FREE_ALL, 1},
                  {"free to slide", DMB_FREE_X, DMB_FREE_ALL, 1},
                  {"free to spin and slide", DMB_FREE_CYLINDRICAL, DMB_FREE_ALL, 2},
                  {"in a ball joint", DMB_FREE_SPHERICAL, DMB_FREE_ALL, 3},
                  {"in supports at both ends", DMB_FREE_CYLINDRICAL, DMB_FREE_CYLINDRICAL, 2}};
    for (int i = 0; i < 6; i++)
        for (int moved = 0; moved < 2; moved++) {
            rig s;
            rig_open(&s, 0, 0, 0);
            (void)add_bent(&s, moved ? &away : &home, 30, 0.0, scene[i].start, scene[i].end);
            rig_start(&s, NULL);
            check_ways(scene[i].what, &s, scene[i].rigid, 1e-6);
            rig_close(&s);
        }
}

/* Gravity turns a hanging string back about two axes, and leaves the third. */
static void hanging_in_a_ball_joint(void **state)
{
    (void)state;
    const place down = {{0.0, 0.0, 0.0}, {0.0, 0.5 * PI, 0.0}};
    rig s;
    rig_open(&s, 0, 0, -9.81);
    (void)add_bent(&s, &down, 30, 0.0, DMB_FREE_SPHERICAL, DMB_FREE_ALL);
    rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    check_ways("hanging in a ball joint", &s, 1, 1e-7);
    rig_close(&s);
}

/* ---- Joints and several parts ------------------------------------------------------------------------------------ */

static dmb_id fix(rig *s, dmb_place a, dmb_place b)
{
    dmb_joint_def joint = joint_between(DMB_JOINT_FIXED, a, b);
    joint.match = 1;
    return add_joint(s, &joint);
}

static void rings_have_six(void **state)
{
    (void)state;
    for (uint32_t pipes = 24; pipes <= 96; pipes *= 4) {
        rig s;
        rig_open(&s, 0, 0, 0);
        const dmb_id string = add_bent(&s, &away, pipes, 2.0 * PI, DMB_FREE_ALL, DMB_FREE_ALL);
        (void)fix(&s, dmb_station(string, pipes - 1, 1.0), dmb_station(string, 0, 0.0));
        rig_start(&s, NULL);
        check_ways("stabiliser", &s, 6, 1e-6);
        rig_close(&s);
    }
}

static void two_strings(void **state)
{
    (void)state;
    static const place beside = {{0.0, 3.0, 0.0}, {0.0, 0.0, 0.3}};
    rig s;
    rig_open(&s, 0, 0, 0);
    (void)add_bent(&s, &home, 16, 0.0, DMB_FREE_ALL, DMB_FREE_ALL);
    (void)add_bent(&s, &beside, 12, 0.4, DMB_FREE_ALL, DMB_FREE_ALL);
    rig_start(&s, NULL);
    check_ways("two free strings", &s, 12, 1e-8);
    rig_close(&s);
}

/* Bodies in a row, each with a joint to the one before it; spring: in all the coordinates that it leaves free. */
static void open_bodies(rig *s, uint32_t count, int32_t kind, double spring)
{
    dmb_id last = {0, 0};
    rig_open(s, 0, 0, 0);
    for (uint32_t i = 0; i < count; i++) {
        dmb_body_def body = dmb_body_def_default();
        body.mass = 2.0 + i % 3;
        body.position[0] = 0.5 * i;
        body.position[1] = 0.1 * i * (i % 2);
        body.rotation[1] = 0.2 * i;
        const dmb_id here = add_body(s, &body);
        if (i > 0) {
            dmb_joint_def joint = joint_between(kind, dmb_station(last, 0, 0.0), dmb_station(here, 0, 0.0));
            const int first = kind == DMB_JOINT_FREE ? DMB_X : DMB_RX, end = kind == DMB_JOINT_REVOLUTE ? DMB_RY : 6;
            joint.match = 1;
            joint.origin_a[0] = 0.25;
            for (int c = first; c < end; c++) joint.stiffness[c] = spring;
            (void)add_joint(s, &joint);
        }
        last = here;
    }
    (void)mechanism_start(s, NULL);
}

/* With springs six motions are left, without them every coordinate is one. */
static void jointed_bodies(void **state)
{
    (void)state;
    static const int32_t kind[3] = {DMB_JOINT_REVOLUTE, DMB_JOINT_SPHERICAL, DMB_JOINT_FREE};
    static const uint32_t leaves[3] = {1, 3, 6};
    for (int k = 0; k < 3; k++)
        for (uint32_t count = 2; count <= 30; count += 28)
            for (int sprung = 0; sprung < 2; sprung++)
                for (int32_t damped = DMB_MODES_UNDAMPED; damped <= DMB_MODES_DAMPED; damped++) {
                    rig s;
                    open_bodies(&s, count, kind[k], sprung ? 1e4 : 0.0);
                    const uint32_t n = 6 + (count - 1) * leaves[k];
                    dmb_modes *all = all_modes(&s, damped), *few = lowest_modes(&s, damped, n < 20 ? n : 20);
                    assert_int_equal(info_of(all).coordinates, n);
                    assert_int_equal(info_of(all).count, n);
                    assert_int_equal(info_of(all).rigid, sprung ? 6 : n);
                    assert_int_equal(info_of(few).rigid, sprung ? 6 : info_of(few).count);
                    double worst = 0.0;
                    for (uint32_t i = info_of(few).rigid; i < info_of(few).count; i++)
                        worst = fmax(worst, fabs(frequency_at(few, i) / frequency_at(all, i) - 1.0));
                    check_below("few against all", worst, 1e-8);
                    check_below("  residual", fmax(info_of(few).residual, info_of(all).residual), 1e-7);
                    dmb_modes_destroy(&all);
                    dmb_modes_destroy(&few);
                    rig_close(&s);
                }
}

/* Two equal bodies with a spring between them: w^2 = 2 k/m. */
static void two_bodies_with_a_spring(void **state)
{
    (void)state;
    rig s;
    dmb_body_def body = dmb_body_def_default();
    rig_open(&s, 0, 0, 0);
    body.mass = 3.0;
    const dmb_id a = add_body(&s, &body), b = add_body(&s, &body);
    dmb_joint_def joint = joint_between(DMB_JOINT_PRISMATIC, dmb_station(a, 0, 0.0), dmb_station(b, 0, 0.0));
    joint.stiffness[DMB_X] = 2e4;
    (void)add_joint(&s, &joint);
    (void)mechanism_start(&s, NULL);
    for (int32_t kind = DMB_MODES_UNDAMPED; kind <= DMB_MODES_DAMPED; kind++) {
        dmb_modes *modes = all_modes(&s, kind);
        assert_int_equal(info_of(modes).rigid, 6);
        assert_int_equal(info_of(modes).count, 7);
        check_relative("two bodies and a spring", frequency_at(modes, 6), sqrt(2.0 * 2e4 / 3.0) / (2.0 * PI), 1e-12);
        dmb_modes_destroy(&modes);
    }
    rig_close(&s);
}

/* ---- Damping ----------------------------------------------------------------------------------------------------- */

/* A body in drag-like dampers of a joint that holds nothing: a root 0 and a root -c/m of each coordinate, twice as many
 * modes as coordinates. */
static void damped_roots_are_twice_the_coordinates(void **state)
{
    (void)state;
    rig s;
    dmb_body_def body = dmb_body_def_default();
    rig_open(&s, 0, 0, 0);
    body.mass = 4.0;
    dmb_joint_def joint =
        joint_between(DMB_JOINT_FREE, dmb_station(ground_id, 0, 0.0), dmb_station(add_body(&s, &body), 0, 0.0));
    for (int c = 0; c < 3; c++) joint.damping[c] = 2.0 * (c + 1);
    (void)add_joint(&s, &joint);
    (void)mechanism_start(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 12);
    const dmb_modes_info info = info_of(modes);
    assert_int_equal(info.coordinates, 6);
    assert_int_equal(info.rigid, 6);
    assert_int_equal(info.count, 9);
    for (uint32_t i = 0; i < 3; i++)
        check_relative("root of a damper, -c/m", mode_at(modes, 6 + i).eigenvalue[0], -0.5 * (i + 1), 1e-12);
    dmb_modes_destroy(&modes);
    dmb_modes_options options = dmb_modes_options_default();
    options.kind = DMB_MODES_DAMPED;
    options.count = 13;
    modes_refusal refused = refused_modes(&s, &options);
    assert_int_equal(refused.status, DMB_ERR_VALUE);
    assert_non_null(strstr(refused.text, "count = 13, must be <= 12"));
    options.kind = DMB_MODES_UNDAMPED;
    options.count = 7;
    refused = refused_modes(&s, &options);
    assert_non_null(strstr(refused.text, "count = 7, must be <= 6"));
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_strings_have_six),
        cmocka_unit_test(a_hundred_pipes_hardly_bent),
        cmocka_unit_test(partly_held_strings),
        cmocka_unit_test(hanging_in_a_ball_joint),
        cmocka_unit_test(rings_have_six),
        cmocka_unit_test(two_strings),
        cmocka_unit_test(jointed_bodies),
        cmocka_unit_test(two_bodies_with_a_spring),
        cmocka_unit_test(damped_roots_are_twice_the_coordinates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
