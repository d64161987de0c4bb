/* Forces by the caller's functions against built-in loads and springs written again as callbacks, against independent
 * integration, and against what they must conserve; refusals of wrong tangents and failing callbacks. */
#include <string.h>

#include "drillmbd/scene.h"
#include "mechanism.h"
#include "modal.h"
#include "ode.h"

static dmb_id add_force(rig *s, const dmb_force_def *def)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_force(s->model, def, &id));
    return id;
}

static dmb_place nowhere(void)
{
    return dmb_station(ground_id, 0, 0.0);
}

static dmb_id add_ball(rig *s, double x, double z)
{
    dmb_body_def body = dmb_body_def_default();
    body.position[0] = x;
    body.position[2] = z;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.1;
    return add_body(s, &body);
}

/* ---- A spring written again -------------------------------------------------------------------------------------- */

typedef struct line {
    double k, c, length; /* spring and damper to the world's origin */
} line;

/* f = -(k (l - l0) + c l') n with its derivatives by x and v; U = k (l - l0)^2/2. */
static int32_t spring_force(void *context, double time, uint32_t count, const double (*poses)[12],
                            const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                            const dmb_law_memory *memory)
{
    (void)memory;
    const line *o = context;
    const double *x = poses[0], *v = velocities[0];
    const double l = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    const double n[3] = {x[0] / l, x[1] / l, x[2] / l}, rate = n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
    const double t = o->k * (l - o->length) + o->c * rate;
    (void)time, (void)count;
    for (int i = 0; i < 3; i++) forces[0][i] = -t * n[i];
    *potential = 0.5 * o->k * (l - o->length) * (l - o->length);
    for (int i = 0; i < 3 && tangent != NULL; i++)
        for (int j = 0; j < 3; j++) {
            const double P = (i == j ? 1.0 : 0.0) - n[i] * n[j];
            double turn = 0.0; /* d rate/dx_j = sum_m v_m P_mj/l */
            for (int m = 0; m < 3; m++) turn += v[m] * ((m == j ? 1.0 : 0.0) - n[m] * n[j]) / l;
            tangent[6 * i + j] = -(o->k * n[j] + o->c * turn) * n[i] - t * P / l;
            tangent[36 + 6 * i + j] = -o->c * n[i] * n[j];
        }
    return 0;
}

enum { BUILT_IN, BY_DIFFERENCES, WITH_TANGENT };

/* A flexible rod on a spherical joint at (1, 0, 0) and a spring from inside it to the origin. */
static dmb_id built_in; /* the spring of the last rod that has one */

static rig rod_on_a_spring(line *o, int how)
{
    const dmb_sim_options options = sharp_options(0.9, 1e-11);
    const dmb_compile_options all = dmb_compile_options_default();
    dmb_string_def string = dmb_string_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    dmb_pipe_def pipe = beam_pipe(1.0, 2, 2e4, 1e4, 50.0, 60.0);
    string.follows_hole = 0;
    string.position[0] = 1.0;
    string.start_free = DMB_FREE_SPHERICAL;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    if (how == BUILT_IN) {
        dmb_spring_def def = dmb_spring_def_default();
        def.place_b = dmb_station(pipe.string, 0, 0.7);
        def.offset_b[2] = 0.1;
        def.stiffness = o->k;
        def.damping = o->c;
        def.free_length = o->length;
        must_model(&s, dmb_model_add_spring(s.model, &def, &built_in));
    } else {
        dmb_force_def def = dmb_force_def_default();
        def.place[0] = dmb_station(pipe.string, 0, 0.7);
        def.offset[2] = 0.1;
        def.callback = spring_force;
        def.callback_context = o;
        def.provides = DMB_PROVIDES_POTENTIAL | (how == WITH_TANGENT ? DMB_PROVIDES_TANGENT : 0);
        (void)add_force(&s, &def);
    }
    (void)rig_start_with(&s, &all, &options);
    return s;
}

static double rate_of_length(const rig *s, dmb_id spring)
{
    dmb_spring_state state = dmb_spring_state_default();
    must(s, dmb_query_spring(s->sim, spring, &state));
    return state.speed;
}

/* The work of a damper that is built in is that of the step, c ((r0 + r1)/2)^2 h; that of a callback goes by the
 * trapezoidal rule, which has c (r1 - r0)^2 h/4 more. */
static void compare_runs(const rig *a, dmb_id spring, const rig *b, double damping, const char *what)
{
    const double h = 2e-3;
    double worst = 0.0, energy = 0.0, more = 0.0;
    for (int i = 0; i < 100; i++) {
        const double before = rate_of_length(a, spring);
        take_steps(a, h, 1);
        take_steps(b, h, 1);
        const double change = rate_of_length(a, spring) - before;
        more += 0.25 * h * damping * change * change;
        const dmb_energy ea = energy_of(a), eb = energy_of(b);
        worst = fmax(worst, fabs(ea.kinetic - eb.kinetic) + fabs(ea.gravity - eb.gravity));
        energy = fmax(energy, fabs(ea.strain - eb.strain) + fabs(ea.damping + more - (eb.damping - eb.loads)));
    }
    check_below(what, worst, 1e-8);
    check_below("its stored energy and loss [J]", energy, 1e-6);
}

static void a_spring_written_again_is_the_spring(void **state)
{
    line o = {80.0, 1.5, 1.2};
    rig built = rod_on_a_spring(&o, BUILT_IN), differences = rod_on_a_spring(&o, BY_DIFFERENCES);
    const dmb_id first = built_in;
    rig again = rod_on_a_spring(&o, BUILT_IN), given = rod_on_a_spring(&o, WITH_TANGENT);
    (void)state;
    compare_runs(&built, first, &differences, o.c, "spring by a callback, tangent by differences [J]");
    compare_runs(&again, built_in, &given, o.c, "spring by a callback with its tangent [J]");
    (void)find_equilibrium(&again, NULL);
    (void)find_equilibrium(&given, NULL);
    (void)find_equilibrium(&differences, NULL);
    dmb_modes *a = all_modes(&again, DMB_MODES_DAMPED), *b = all_modes(&given, DMB_MODES_DAMPED);
    dmb_modes *c = all_modes(&differences, DMB_MODES_DAMPED);
    for (uint32_t i = 0; i < 2; i++) {
        const dmb_mode m = mode_at(a, i), n = mode_at(b, i), d = mode_at(c, i);
        const double size = hypot(m.eigenvalue[0], m.eigenvalue[1]);
        check_below("root of a damped mode, tangent given",
                    hypot(m.eigenvalue[0] - n.eigenvalue[0], m.eigenvalue[1] - n.eigenvalue[1]) / size, 1e-8);
        check_below("root of a damped mode, by differences",
                    hypot(m.eigenvalue[0] - d.eigenvalue[0], m.eigenvalue[1] - d.eigenvalue[1]) / size, 1e-7);
    }
    dmb_modes_destroy(&a);
    dmb_modes_destroy(&b);
    dmb_modes_destroy(&c);
    rig_close(&built);
    rig_close(&differences);
    rig_close(&again);
    rig_close(&given);
}

/* The same force in axes of the place: it turns, and is off the middle of the bar. */
static int32_t spring_in_body_axes(void *context, double time, uint32_t count, const double (*poses)[12],
                                   const double (*velocities)[6], double (*forces)[6], double *tangent,
                                   double *potential, const dmb_law_memory *memory)
{
    const double *R = poses[0] + 3, *v = velocities[0];
    double speed[1][6] = {{0.0}}, force[1][6] = {{0.0}};
    (void)tangent;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) speed[0][i] += R[3 * i + j] * v[j];
    const int32_t status =
        spring_force(context, time, count, poses, (const double(*)[6])speed, force, NULL, potential, memory);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) forces[0][i] += R[3 * j + i] * force[0][j];
    return status;
}

static rig bar_on_a_spring(line *o, int32_t frame)
{
    const dmb_sim_options options = sharp_options(0.9, 1e-11);
    dmb_force_def def = dmb_force_def_default();
    dmb_body_def body = dmb_body_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    body.position[0] = 1.0;
    body.velocity[3] = 0.5, body.velocity[4] = -1.0, body.velocity[5] = 2.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.1 + 0.05 * i;
    def.place[0] = dmb_station(add_body(&s, &body), 0, 0.0);
    def.offset[1] = 0.2;
    def.frame = frame;
    def.callback = frame == DMB_FRAME_BODY ? spring_in_body_axes : spring_force;
    def.callback_context = o;
    def.provides = DMB_PROVIDES_POTENTIAL;
    (void)add_force(&s, &def);
    (void)mechanism_start(&s, &options);
    return s;
}

/* Stored energy and loss are alike, and the balance closes. */
static void a_potential_in_axes_of_the_place(void **state)
{
    line o = {80.0, 1.5, 1.2};
    (void)state;
    rig world = bar_on_a_spring(&o, DMB_FRAME_WORLD), place = bar_on_a_spring(&o, DMB_FRAME_BODY);
    take_steps(&world, 2e-3, 200);
    take_steps(&place, 2e-3, 200);
    const dmb_energy a = energy_of(&world), b = energy_of(&place);
    check_close("kinetic energy [J]", b.kinetic, a.kinetic, 1e-8);
    check_close("stored energy [J]", b.strain, a.strain, 1e-8);
    check_close("work of its damper [J]", b.loads, a.loads, 1e-8);
    check_below("energy balance [J]", fabs(b.balance), 1e-3);
    assert_true(a.loads < -0.1 && a.strain > 0.1);
    rig_close(&world);
    rig_close(&place);
}

/* ---- Followers --------------------------------------------------------------------------------------------------- */

static int32_t push_along(void *context, double time, uint32_t count, const double (*poses)[12],
                          const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                          const dmb_law_memory *memory)
{
    (void)memory;
    (void)time, (void)count, (void)poses, (void)velocities, (void)tangent, (void)potential;
    forces[0][0] = -*(const double *)context;
    return 0;
}

/* Largest real part of the roots of a clamped column of EI = m = L = 1 under a follower P at its tip. */
static double growth(double P, int callback)
{
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_pipe_def pipe = beam_pipe(1.0, 8, 1e6, 1e6, 1.0, 1.0);
    pipe.section_mass = 1.0;
    pipe.section_inertia[0] = pipe.section_inertia[1] = 1e-6;
    const dmb_id beam = add_beam(&s, &pipe, DMB_FREE_NONE);
    if (callback) {
        dmb_force_def def = dmb_force_def_default();
        def.place[0] = dmb_station(beam, 0, 1.0);
        def.frame = DMB_FRAME_BODY;
        def.callback = push_along;
        def.callback_context = &P;
        (void)add_force(&s, &def);
    } else {
        dmb_load_def load = dmb_load_def_default();
        load.place = dmb_station(beam, 0, 1.0);
        load.frame = DMB_FRAME_BODY;
        load.force[0] = -P;
        (void)add_load(&s, &load);
    }
    (void)mechanism_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_DAMPED, 8);
    double most = -1e30;
    for (uint32_t i = 0; i < info_of(modes).count; i++) most = fmax(most, mode_at(modes, i).eigenvalue[0]);
    dmb_modes_destroy(&modes);
    rig_close(&s);
    return most;
}

/* Beck 1952: flutter at 20.05 EI/L^2. */
static void a_column_flutters_under_a_follower(void **state)
{
    (void)state;
    check_below("growth below the load of Beck [1/s]", growth(19.8, 1), 1e-5);
    const double by_callback = growth(20.4, 1);
    assert_true(by_callback > 0.1);
    check_relative("growth above it, against a follower load", by_callback, growth(20.4, 0), 1e-6);
}

/* ---- Independent integration ------------------------------------------------------------------------------------- */

/* Van der Pol along a slider: x'' = mu (1 - x^2) x' - x. */
static int32_t van_der_pol(void *context, double time, uint32_t count, const double (*poses)[12],
                           const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                           const dmb_law_memory *memory)
{
    (void)memory;
    const double mu = *(const double *)context, x = poses[0][0], v = velocities[0][0];
    (void)time, (void)count;
    forces[0][0] = mu * (1.0 - x * x) * v - x;
    *potential = 0.5 * x * x;
    if (tangent == NULL) return 0;
    tangent[0] = -2.0 * mu * x * v - 1.0;
    tangent[36] = mu * (1.0 - x * x);
    return 0;
}

static void van_der_pol_rate(void *context, double t, const double *y, double *rate)
{
    const double mu = *(const double *)context;
    (void)t;
    rate[0] = y[1];
    rate[1] = mu * (1.0 - y[0] * y[0]) * y[1] - y[0];
}

static double van_der_pol_error(double step, int provides, double *balance)
{
    const dmb_sim_options options = sharp_options(1.0, 1e-11);
    double mu = 2.0, y[2] = {0.5, 0.0};
    dmb_force_def def = dmb_force_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_joint_def slider = joint_between(DMB_JOINT_PRISMATIC, nowhere(), dmb_station(add_ball(&s, 0.5, 0.0), 0, 0.0));
    def.place[0] = dmb_station(add_joint(&s, &slider), 0, 0.0);
    def.callback = van_der_pol;
    def.callback_context = &mu;
    def.provides = provides;
    (void)add_force(&s, &def);
    (void)mechanism_start(&s, &options);
    take_steps(&s, step, (uint32_t)lround(8.0 / step));
    ode_solve(van_der_pol_rate, &mu, 0.0, 8.0, 1000, 2, y);
    dmb_joint_state joint = joint_at(&s, def.place[0].part);
    *balance = energy_of(&s).balance;
    rig_close(&s);
    return hypot(joint.position[0] - y[0], joint.speed[0] - y[1]);
}

static void an_oscillator_finds_its_limit_cycle(void **state)
{
    const int32_t all = DMB_PROVIDES_TANGENT | DMB_PROVIDES_POTENTIAL;
    double rough, fine, unused;
    (void)state;
    const double coarse = van_der_pol_error(4e-3, all, &rough), half = van_der_pol_error(2e-3, all, &fine);
    check_below("van der Pol's oscillator against another integration", half, 1e-3);
    check_order("van der Pol's oscillator", coarse, half, 2.0, 0.1);
    check_order("its energy balance [J]", fabs(rough), fabs(fine), 2.0, 0.3);
    check_relative("the same by differences and without a potential", van_der_pol_error(2e-3, 0, &unused), half, 1e-4);
    check_below("its energy balance, all of it work [J]", unused, 1e-5);
}

/* Two balls attract each other by G/r^2. */
static int32_t attract(void *context, double time, uint32_t count, const double (*poses)[12],
                       const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                       const dmb_law_memory *memory)
{
    (void)memory;
    const double G = *(const double *)context;
    double d[3], r = 0.0;
    (void)time, (void)count, (void)velocities, (void)tangent;
    for (int i = 0; i < 3; i++) d[i] = poses[1][i] - poses[0][i];
    r = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int i = 0; i < 3; i++) {
        forces[0][i] = G * d[i] / (r * r * r);
        forces[1][i] = -forces[0][i];
    }
    *potential = -G / r;
    return 0;
}

/* A circle about each other: radius 1/2 each, r = 1, speed v: v^2/(1/2) = G. After a turn all is as before. */
static double circle_error(double step, double *balance)
{
    const dmb_sim_options options = sharp_options(1.0, 1e-11);
    double G = 2.0;
    dmb_force_def def = dmb_force_def_default();
    dmb_id ball[2];
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 2; i++) {
        dmb_body_def body = dmb_body_def_default();
        body.position[0] = i == 0 ? -0.5 : 0.5;
        body.velocity[1] = i == 0 ? -1.0 : 1.0;
        ball[i] = add_body(&s, &body);
        def.place[i] = dmb_station(ball[i], 0, 0.0);
    }
    def.place_count = 2;
    def.callback = attract;
    def.callback_context = &G;
    def.provides = DMB_PROVIDES_POTENTIAL;
    (void)add_force(&s, &def);
    (void)mechanism_start(&s, &options);
    take_steps(&s, step, (uint32_t)lround(PI / step)); /* half a length of 2 pi/2 at speed 1: one turn */
    const dmb_pose pose = pose_at(&s, dmb_station(ball[1], 0, 0.0));
    const dmb_momentum sum = momentum_of(&s);
    check_below("momentum of two balls that attract each other", fabs(sum.linear[0]) + fabs(sum.linear[1]), 1e-12);
    *balance = energy_of(&s).balance;
    rig_close(&s);
    const double angle = 2.0 * step * round(PI / step);
    return hypot(pose.position[0] - 0.5 * cos(angle), pose.position[1] - 0.5 * sin(angle));
}

static void balls_circle_about_each_other(void **state)
{
    double rough, fine;
    (void)state;
    const double coarse = circle_error(4e-3, &rough), half = circle_error(2e-3, &fine);
    check_below("two balls about each other [m]", half, 1e-4);
    check_order("two balls about each other", coarse, half, 2.0, 0.1);
    check_below("their energy balance [J]", fine, 1e-6);
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static int32_t wrong_tangent(void *context, double time, uint32_t count, const double (*poses)[12],
                             const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                             const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)velocities, (void)potential;
    forces[0][2] = -3.0 * poses[0][2];
    if (tangent != NULL) tangent[14] = 3.0;
    return 0;
}

static int32_t fails_later(void *context, double time, uint32_t count, const double (*poses)[12],
                           const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                           const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)count, (void)poses, (void)velocities, (void)tangent, (void)potential;
    forces[0][1] = time < 0.5 ? 1.0 : (double)NAN;
    return 0;
}

static void wrong_tangents_are_refused(void **state)
{
    dmb_force_def def = dmb_force_def_default();
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    def.place[0] = dmb_station(add_ball(&s, 0.0, 1.0), 0, 0.0);
    def.callback = wrong_tangent;
    def.provides = DMB_PROVIDES_TANGENT;
    memcpy(def.name, "magnet", 7);
    (void)add_force(&s, &def);
    const refusal found = refused_start(&s);
    assert_int_equal(found.status, DMB_ERR_CALLBACK);
    assert_non_null(strstr(found.text, "force 0 (magnet)"));
    assert_non_null(strstr(found.text, "[2][2] = 3, must be -3"));
    rig_close(&s);
}

static void a_failing_callback_changes_nothing(void **state)
{
    dmb_force_def def = dmb_force_def_default();
    rig s;
    uint64_t before;
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    def.place[0] = dmb_station(add_ball(&s, 0.0, 1.0), 0, 0.0);
    def.callback = fails_later;
    memcpy(def.name, "fan", 4);
    (void)add_force(&s, &def);
    (void)mechanism_start(&s, NULL);
    take_steps(&s, 0.1, 4);
    before = rig_hash(&s);
    int32_t status = DMB_OK;
    for (int i = 0; i < 3 && status >= 0; i++) {
        before = rig_hash(&s);
        status = dmb_sim_step(s.sim, 0.1, NULL);
    }
    assert_int_equal(status, DMB_ERR_CALLBACK);
    assert_non_null(strstr(dmb_sim_message(s.sim), "force 0 (fan)"));
    assert_true(rig_hash(&s) == before);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_spring_written_again_is_the_spring), cmocka_unit_test(a_column_flutters_under_a_follower),
        cmocka_unit_test(an_oscillator_finds_its_limit_cycle),  cmocka_unit_test(balls_circle_about_each_other),
        cmocka_unit_test(a_potential_in_axes_of_the_place),     cmocka_unit_test(wrong_tangents_are_refused),
        cmocka_unit_test(a_failing_callback_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
