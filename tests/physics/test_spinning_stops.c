/* Energy of spinning bodies that are not of revolution between stops and one-sided springs: at most 1.01 of the initial
 * energy for steps of h w from 0.01 to 100 (w of the body on its stop), every spectral radius, with and without
 * damping, in fixed and in controlled steps, up to 0.3 rad of spin a step. Equations: eq:unilateral.turning,
 * eq:unilateral.free-rigid, eq:unilateral.gyroscopic. */
#include <math.h>
#include <string.h>

#include "drillmbd/scene.h"
#include "mechanism.h"

enum { IN_A_CAGE, TWO_BODIES, ON_A_BALL, ON_SPRINGS, ALONE, OFF_CENTRE, RIGID_PIPE, KINDS };
static const char *const names[KINDS] = {"in a cage",
                                         "two bodies",
                                         "on a ball joint",
                                         "on one-sided springs",
                                         "on one-sided springs, without joints",
                                         "off its centre and axis on one-sided springs, without joints",
                                         "a rigid pipe on one-sided springs, without joints"};

typedef struct spinning {
    int kind;
    double per_step; /* [rad] of spin */
    double hw;       /* of the mass on its stop */
    double radius, damping;
} spinning;

static const double mass = 2.0, spin = 100.0, gap = 0.02, lever = 0.1;

static dmb_id add_spinning(rig *s, double turned, double off)
{
    dmb_body_def body = dmb_body_def_default();
    const double start[6] = {0.0, 0.5, 0.31, turned * spin, 3.0, 0.0};
    body.centre[0] = off, body.centre[1] = 0.5 * off;
    body.mass = mass;
    body.inertia[0] = 0.004, body.inertia[1] = 0.006, body.inertia[2] = 0.005;
    memcpy(body.velocity, start, sizeof start);
    return add_body(s, &body);
}

static void add_cage(rig *s, dmb_place from, dmb_id body, double k, double c)
{
    dmb_joint_def play = joint_between(DMB_JOINT_FREE, from, dmb_station(body, 0, 0.0));
    play.origin_a[0] = play.origin_b[0] = lever;
    for (int i = 0; i < 3; i++) play.stop_low[i] = -gap, play.stop_high[i] = gap;
    play.stop_stiffness = k;
    play.stop_damping = c;
    (void)add_joint(s, &play);
}

/* A rigid pipe of the same mass, whose place of the springs is off its centre of mass and off its axis. */
static dmb_id add_spinning_pipe(rig *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    const double start[6] = {0.0, 0.5, 0.31, spin, 3.0, 0.0};
    memcpy(string.velocity, start, sizeof start);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_ALL;
    pipe.string = add_string(s, &string);
    pipe.kind = DMB_PIPE_RIGID;
    pipe.length = 0.5;
    pipe.eccentricity = 0.03;
    pipe.section_mass = mass / pipe.length;
    (void)add_pipes(s, &pipe, 1);
    return pipe.string;
}

/* Four springs push the body back along y and z, at `lever` before its reference point and `off` beside it. */
static void add_springs(rig *s, dmb_id body, double off, double k, double c)
{
    for (int i = 0; i < 4; i++) {
        dmb_spring_def def = dmb_spring_def_default();
        dmb_id id = {0, 0};
        def.place_a = dmb_station(ground_id, 0, 0.0);
        def.place_b = dmb_station(body, 0, 0.0);
        def.offset_a[0] = def.offset_b[0] = lever;
        def.offset_a[1] = def.offset_b[1] = off;
        def.offset_a[1 + i % 2] += i < 2 ? 0.5 : -0.5;
        def.acts = DMB_SPRING_COMPRESSION;
        def.stiffness = k;
        def.damping = c;
        def.free_length = 0.5 - gap;
        must_model(s, dmb_model_add_spring(s->model, &def, &id));
    }
}

/* A body whose centre is `lever` from a ball joint, with stops of its rotation across. */
static void add_ball(rig *s, double k, double c)
{
    dmb_body_def body = dmb_body_def_default();
    const double start[3] = {spin, 3.0, 0.0};
    body.mass = mass;
    body.inertia[0] = 0.004, body.inertia[1] = 0.006, body.inertia[2] = 0.005;
    memcpy(body.velocity + 3, start, sizeof start);
    const dmb_id id = add_body(s, &body);
    dmb_joint_def ball = joint_between(DMB_JOINT_SPHERICAL, dmb_station(ground_id, 0, 0.0), dmb_station(id, 0, 0.0));
    ball.stop_low[DMB_RY] = ball.stop_low[DMB_RZ] = -gap / lever;
    ball.stop_high[DMB_RY] = ball.stop_high[DMB_RZ] = gap / lever;
    ball.stop_stiffness = k * body.inertia[1] / mass;
    ball.stop_damping = c * body.inertia[1] / mass;
    (void)add_joint(s, &ball);
}

static dmb_id add_spinning_kind(rig *s, int kind)
{
    if (kind == ON_A_BALL) return ground_id;
    return kind == RIGID_PIPE ? add_spinning_pipe(s) : add_spinning(s, 1.0, kind == OFF_CENTRE ? 0.03 : 0.0);
}

static void open_with(rig *s, const spinning *of, const dmb_sim_options *options)
{
    const double w = of->hw * spin / of->per_step, k = mass * w * w, c = 2.0 * of->damping * mass * w;
    rig_open(s, 0.0, 0.0, 0.0);
    if (of->kind == ON_A_BALL) add_ball(s, k, c);
    const dmb_id body = add_spinning_kind(s, of->kind);
    if (of->kind == IN_A_CAGE) add_cage(s, dmb_station(ground_id, 0, 0.0), body, k, c);
    if (of->kind == TWO_BODIES) add_cage(s, dmb_station(body, 0, 0.0), add_spinning(s, -0.5, 0.0), 0.5 * k, 0.5 * c);
    if (of->kind >= ON_SPRINGS) add_springs(s, body, of->kind == OFF_CENTRE ? 0.05 : 0.0, k, c);
    if (of->kind == ON_SPRINGS) add_cage(s, dmb_station(ground_id, 0, 0.0), body, 1e-3 * k, 0.0);
    assert_int_equal(mechanism_start(s, options), DMB_OK);
}

static void open_scene(rig *s, const spinning *of)
{
    const dmb_sim_options options = sharp_options(of->radius, 1e-10);
    open_with(s, of, &options);
}

/* Largest energy over the initial one. */
static double most_of(const spinning *of, uint32_t steps)
{
    rig s;
    open_scene(&s, of);
    const double most = largest_energy(&s, of->per_step / spin, steps);
    rig_close(&s);
    return most;
}

static const double radii[] = {0.0, 0.5, 0.8, 0.95, 1.0};

/* Steps of h w from 0.01 to 100, damped and not. */
static double worst_of(int kind, double per_step)
{
    static const double steps_of[] = {0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0};
    double worst = 0.0;
    for (int i = 0; i < 7; i++)
        for (int r = 0; r < 5; r++) {
            const spinning of = {kind, per_step, steps_of[i], radii[r], (i + r) % 2 ? 0.0 : 0.3};
            const spinning other = {kind, per_step, steps_of[i], radii[r], (i + r) % 2 ? 0.3 : 0.0};
            worst = fmax(worst, fmax(most_of(&of, 400), most_of(&other, 150)));
        }
    return worst;
}

static void a_tenth_of_a_radian_a_step_gains_nothing(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) check_below(names[kind], worst_of(kind, 0.1), 1.01);
}

/* The rotation itself is not resolved then. */
static void a_radian_a_step_gains_little(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        check_below(names[kind], worst_of(kind, 0.3), 1.01);
        check_below(names[kind], worst_of(kind, 1.0), 1.05);
    }
}

static void controlled_steps_gain_nothing(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        const spinning of = {kind, 0.1, 3.0, 0.8, 0.0};
        rig s;
        double most = 0.0;
        open_scene(&s, &of);
        const double before = energy_now(&s);
        for (int i = 1; i <= 10; i++) {
            must(&s, dmb_sim_advance(s.sim, 0.02 * i, NULL));
            most = fmax(most, energy_now(&s) / before);
        }
        check_below(names[kind], most, 1.01);
        rig_close(&s);
    }
}

/* A step that cannot be divided fails where it turns the body too far, says so, and changes nothing. */
static void bounded_steps_fail_that_turn_too_far(void **state)
{
    const spinning of = {IN_A_CAGE, 0.3, 100.0, 0.8, 0.0};
    dmb_sim_options options = sharp_options(of.radius, 1e-10);
    int32_t status = DMB_OK;
    rig s;
    (void)state;
    options.bounded_work = 1;
    open_with(&s, &of, &options);
    double energy = energy_now(&s);
    for (int n = 0; n < 40 && status >= 0; n++) {
        energy = energy_now(&s);
        status = dmb_sim_step(s.sim, of.per_step / spin, NULL);
    }
    assert_int_equal(status, DMB_ERR_NO_CONVERGENCE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "body 0: the step to time 0.039 of length 0.003 turns it by more"));
    assert_true(energy_now(&s) == energy);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tenth_of_a_radian_a_step_gains_nothing),
        cmocka_unit_test(a_radian_a_step_gains_little),
        cmocka_unit_test(controlled_steps_gain_nothing),
        cmocka_unit_test(bounded_steps_fail_that_turn_too_far),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
