/* Forces of the caller with a state (dmb_law_memory): the loop of an elastic-plastic slider against its closed form, a
 * LuGre element against independent integration with its order, a delay against the shifted signal; the state in
 * snapshots, rejected steps and transfers; what is refused. */
#include <stdlib.h>
#include <string.h>

#include "mechanism.h"
#include "modal.h"
#include "ode.h"

typedef struct law {
    double k, limit;         /* [N/m, N] of the slider */
    uint32_t told;           /* calls of accept */
    double time, state;      /* of the last of them */
    uint32_t asked, fail_at; /* calls of the law, and the one that fails; 0: none */
    double wrong;            /* error of the tangent by the state */
} law;

static void hear(void *context, double time, uint32_t number, const double *state)
{
    law *o = context;
    assert_int_equal(number, 0);
    o->told++;
    o->time = time;
    o->state = state[0];
}

/* Spring in series with a slider: state s its stretch and x the place before. */
static int32_t slider(void *context, double time, uint32_t count, const double (*poses)[12],
                      const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                      const dmb_law_memory *memory)
{
    law *o = context;
    const double most = o->limit / o->k, s = memory->accepted[0] + poses[0][0] - memory->accepted[1];
    (void)time, (void)count, (void)velocities, (void)potential;
    o->asked++;
    memory->trial[0] = fmin(fmax(s, -most), most);
    memory->trial[1] = poses[0][0];
    forces[0][0] = -o->k * memory->trial[0];
    if (tangent != NULL && fabs(s) < most) tangent[dmb_tangent_index(1, 0, 0, DMB_X, 0, DMB_X)] = -o->k;
    return o->asked == o->fail_at;
}

static dmb_id body;

/* A body of 2 kg that moves along x with the law on it; a drive may hold its speed. */
static rig open_law(law *o, dmb_force_fn function, uint32_t states, const dmb_segment *speed)
{
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_body_def def = dmb_body_def_default();
    dmb_force_def force = dmb_force_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    def.free_mask = DMB_FREE_X;
    def.mass = 2.0;
    def.velocity[0] = function == slider && speed == NULL ? 1.0 : 0.0;
    drive.part = body = add_body(&s, &def);
    force.place[0] = dmb_station(body, 0, 0.0);
    force.callback = function;
    force.callback_context = o;
    force.state_count = states;
    force.accept = hear;
    force.provides = DMB_PROVIDES_TANGENT;
    must_model(&s, dmb_model_add_force(s.model, &force, NULL));
    if (speed == NULL) return s;
    must_model(&s, dmb_model_add_time_function(s.model, speed, 1, &drive.time_function));
    must_model(&s, dmb_model_add_drive(s.model, &drive, NULL));
    return s;
}

static dmb_segment cosine(double amplitude, double omega)
{
    dmb_segment speed = dmb_segment_default();
    speed.kind = DMB_SEGMENT_HARMONIC;
    speed.h1 = amplitude * omega;
    speed.omega = omega;
    speed.phase = 0.5 * PI;
    return speed;
}

/* Over a cycle of amplitude a the slider takes 4 limit (a - limit/k); the ledger counts it as work of loads. */
static void a_loop_dissipates(void **state)
{
    const double a = 0.01, omega = 2.0 * PI;
    double error[2];
    (void)state;
    for (int n = 0; n < 2; n++) {
        const uint32_t steps = n ? 2000 : 1000;
        law o = {.k = 1e5, .limit = 300.0};
        const dmb_segment speed = cosine(a, omega);
        rig s = open_law(&o, slider, 2, &speed);
        (void)rig_start(&s, NULL);
        take_steps(&s, 1.0 / steps, steps); /* the first cycle begins unstretched */
        const double before = energy_of(&s).loads;
        take_steps(&s, 1.0 / steps, steps);
        error[n] = fabs(before - energy_of(&s).loads - 4.0 * o.limit * (a - o.limit / o.k));
        assert_int_equal(o.told, 2 * steps);
        assert_true(o.time == dmb_sim_time(s.sim));
        rig_close(&s);
    }
    check_below("work of a loop [J] of 8.4 J", error[1], 2e-4);
    check_below("and with twice the step", error[0], 8e-4);
}

/* ---- LuGre ------------------------------------------------------------------------------------------------------- */

#define SIGMA0 1e4
#define SIGMA1 30.0

static double limit_of(double v)
{
    return 10.0 + 5.0 * exp(-v * v / 1e-2);
}

static double bristle_rate(double v, double z)
{
    return v - SIGMA0 * fabs(v) * z / limit_of(v);
}

/* z by the trapezoidal rule: z1 (1 + h/2 r1) = z0 + h/2 (z0' + v1), r = SIGMA0 |v|/g; state: z and the speed before.
 * The derivative by v takes z along. */
static int32_t lugre(void *context, double time, uint32_t count, const double (*poses)[12],
                     const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                     const dmb_law_memory *memory)
{
    law *o = context;
    const double v = velocities[0][0], g = limit_of(v), h = memory->step, z0 = memory->accepted[0];
    const double r = SIGMA0 * fabs(v) / g, over = 1.0 + 0.5 * h * r;
    const double z = (z0 + 0.5 * h * (bristle_rate(memory->accepted[1], z0) + v)) / over;
    (void)time, (void)count, (void)poses, (void)potential;
    o->asked++;
    memory->trial[0] = z;
    memory->trial[1] = h > 0.0 ? v : memory->accepted[1];
    const double rate = bristle_rate(v, z), slope = -v / 1e-2 * 2.0 * (g - 10.0);
    forces[0][0] = -(SIGMA0 * z + SIGMA1 * rate);
    if (tangent == NULL) return 0;
    const double r_v = SIGMA0 * ((v > 0.0) - (v < 0.0)) / g - r * slope / g;
    const double z_v = 0.5 * h * (1.0 - r_v * z) / over;
    tangent[dmb_tangent_index(1, 1, 0, DMB_X, 0, DMB_X)] =
        -((SIGMA0 - SIGMA1 * r) * z_v + SIGMA1 * (1.0 - r_v * z)) * (1.0 + o->wrong * (h > 0.0));
    return 0;
}

static void lugre_rate(void *context, double t, const double *y, double *rate)
{
    (void)context;
    const double zr = bristle_rate(y[1], y[2]);
    rate[0] = y[1];
    rate[1] = (14.0 * sin(40.0 * t) - SIGMA0 * y[2] - SIGMA1 * zr) / 2.0;
    rate[2] = zr;
}

/* A load of 14 N sin(40 t): presliding and sliding; compared at the end, of second order. */
static void lugre_is_of_second_order(void **state)
{
    double error[3];
    (void)state;
    double y[3] = {0.0, 0.0, 0.0};
    ode_solve(lugre_rate, NULL, 0.0, 0.06, 6000, 3, y); /* before the speed changes its sign, where |v| has a kink */
    assert_true(y[1] > 1e-3);
    for (int n = 0; n < 3; n++) {
        law o = {0};
        dmb_segment load = dmb_segment_default();
        load.kind = DMB_SEGMENT_HARMONIC;
        load.h1 = 14.0;
        load.omega = 40.0;
        rig s = open_law(&o, lugre, 2, NULL);
        dmb_drive_def drive = dmb_drive_def_default();
        drive.part = body;
        drive.kind = DMB_DRIVE_LOAD;
        must_model(&s, dmb_model_add_time_function(s.model, &load, 1, &drive.time_function));
        must_model(&s, dmb_model_add_drive(s.model, &drive, NULL));
        const dmb_sim_options options = sharp_options(0.9, 1e-12);
        (void)rig_start(&s, &options);
        const uint32_t steps = 120u << n;
        take_steps(&s, 0.06 / steps, steps);
        error[n] = fabs(dmb_sim_value(s.sim, DMB_OUTPUT_DISPLACEMENT_X, dmb_station(body, 0, 0.0)) - y[0]);
        rig_close(&s);
    }
    check_order("LuGre of one's own", error[1], error[2], 2.0, 0.3);
}

/* Linear analyses see the bristles as a spring beside their damper: w^2 = SIGMA0/m, 2 D w = SIGMA1/m. */
static void modes_have_the_bristles(void **state)
{
    (void)state;
    law o = {0};
    rig s = open_law(&o, lugre, 2, NULL);
    (void)rig_start(&s, NULL);
    dmb_modes *modes = all_modes(&s, DMB_MODES_DAMPED);
    const dmb_mode mode = mode_at(modes, 0);
    check_relative("real part of the mode [1/s]", mode.eigenvalue[0], -SIGMA1 / 4.0, 1e-5);
    check_relative("its magnitude [1/s]", hypot(mode.eigenvalue[0], mode.eigenvalue[1]), sqrt(SIGMA0 / 2.0), 1e-5);
    dmb_modes_destroy(&modes);
    rig_close(&s);
}

/* ---- The state is part of the sim -------------------------------------------------------------------------------- */

static rig swinging(law *o)
{
    const dmb_segment speed = cosine(0.01, 20.0);
    rig s = open_law(o, slider, 2, &speed);
    (void)rig_start(&s, NULL);
    return s;
}

static void the_state_is_saved(void **state)
{
    (void)state;
    law o = {.k = 1e5, .limit = 300.0};
    rig s = swinging(&o);
    take_steps(&s, 1e-3, 33);
    size_t size = 0;
    must(&s, dmb_sim_snapshot_size(s.sim, &size));
    void *saved = malloc(size);
    must(&s, dmb_sim_snapshot(s.sim, saved, size));
    const uint64_t then = rig_hash(&s);
    const double stretch = o.state;
    assert_true(stretch != 0.0);
    take_steps(&s, 1e-3, 50);
    const uint64_t end = rig_hash(&s);
    must(&s, dmb_sim_restore(s.sim, saved, size));
    assert_true(rig_hash(&s) == then);
    take_steps(&s, 1e-3, 50);
    assert_true(rig_hash(&s) == end);
    free(saved);
    rig_close(&s);
}

/* A step that fails leaves the state before it, and the next one goes on as if there had been none; a step that is
 * divided is told once. */
static void rejected_steps_leave_it(void **state)
{
    (void)state;
    law o = {.k = 1e5, .limit = 300.0}, p = o;
    rig s = open_law(&o, slider, 2, NULL), plain = open_law(&p, slider, 2, NULL);
    (void)rig_start(&s, NULL);
    (void)rig_start(&plain, NULL);
    take_steps(&s, 1e-3, 20);
    take_steps(&plain, 1e-3, 20);
    const uint64_t before = rig_hash(&s);
    for (uint32_t k = 1; k <= 2; k++) {
        o.fail_at = o.asked + k;
        assert_int_equal(dmb_sim_step(s.sim, 1e-3, NULL), DMB_ERR_CALLBACK);
        assert_true(rig_hash(&s) == before && o.told == 20);
    }
    o.fail_at = 0;
    take_steps(&s, 1e-3, 20);
    take_steps(&plain, 1e-3, 20);
    assert_true(rig_hash(&s) == rig_hash(&plain));
    assert_true(o.told == 40 && o.state == p.state);
    rig_close(&s);
    rig_close(&plain);
}

static void it_is_transferred(void **state)
{
    (void)state;
    law o = {.k = 1e5, .limit = 300.0}, p = o, q = o;
    rig s = swinging(&o), other = swinging(&p);
    take_steps(&s, 1e-3, 20);
    must(&other, dmb_sim_transfer_state(other.sim, s.sim));
    take_steps(&s, 1e-3, 20);
    take_steps(&other, 1e-3, 20);
    check_close("stretch after a transfer", p.state, o.state, 1e-15);
    rig_close(&other);
    other = open_law(&q, slider, 3, NULL);
    const dmb_segment speed = cosine(0.01, 20.0);
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = body;
    must_model(&other, dmb_model_add_time_function(other.model, &speed, 1, &drive.time_function));
    must_model(&other, dmb_model_add_drive(other.model, &drive, NULL));
    (void)rig_start(&other, NULL);
    assert_int_equal(dmb_sim_transfer_state(other.sim, s.sim), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(other.sim), "state_count"));
    rig_close(&other);
    rig_close(&s);
}

/* Statics follow the path: beside a spring of the same stiffness the slider is elastic under 500 N, slides under 1000
 * N, and without load the set remains at which k x + limit - k (7 mm - x) = 0. */
static void statics_follow_the_path(void **state)
{
    static const double load[3] = {500.0, 1000.0, 0.0}, want[3] = {2.5e-3, 7e-3, 2e-3};
    (void)state;
    law o = {.k = 1e5, .limit = 300.0};
    dmb_segment none = dmb_segment_default();
    rig s = open_law(&o, slider, 2, NULL);
    dmb_drive_def pull = dmb_drive_def_default();
    dmb_spring_def spring = dmb_spring_def_default();
    dmb_id drive;
    pull.part = body;
    pull.kind = DMB_DRIVE_LOAD;
    must_model(&s, dmb_model_add_time_function(s.model, &none, 1, &pull.time_function));
    must_model(&s, dmb_model_add_drive(s.model, &pull, &drive));
    spring.place_b = dmb_station(body, 0, 0.0);
    spring.offset_a[0] = -1.0;
    spring.stiffness = 1e5;
    must_model(&s, dmb_model_add_spring(s.model, &spring, NULL));
    (void)rig_start(&s, NULL);
    for (int i = 0; i < 3; i++) {
        must(&s, dmb_sim_set_drive(s.sim, drive, load[i]));
        (void)find_equilibrium(&s, NULL);
        check_close("rest on the path", dmb_sim_value(s.sim, DMB_OUTPUT_DISPLACEMENT_X, spring.place_b), want[i], 1e-9);
    }
    rig_close(&s);
}

/* ---- Refused ----------------------------------------------------------------------------------------------------- */

static void what_is_refused(void **state)
{
    (void)state;
    law o = {.wrong = 0.01};
    rig s = open_law(&o, lugre, 2, NULL);
    must_model(&s, dmb_model_compile(s.model, NULL));
    assert_int_equal(dmb_sim_create(s.model, NULL, &s.sim), DMB_ERR_CALLBACK); /* the tangent leaves a part out */
    rig_close(&s);
    o.wrong = 0.0;
    s = open_law(&o, lugre, 2, NULL);
    (void)rig_start(&s, NULL);
    dmb_state_equation *equation = NULL;
    assert_int_equal(dmb_state_equation_create(s.sim, &equation), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(s.sim), "state_count"));
    rig_close(&s);
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_body_def def = dmb_body_def_default();
    dmb_force_def force = dmb_force_def_default();
    force.place[0] = dmb_station(add_body(&s, &def), 0, 0.0);
    force.callback = slider;
    force.state_count = 65537;
    assert_int_equal(dmb_model_add_force(s.model, &force, NULL), DMB_ERR_VALUE);
    force.state_count = 1;
    force.provides = DMB_PROVIDES_POTENTIAL;
    assert_int_equal(dmb_model_add_force(s.model, &force, NULL), DMB_ERR_UNSUPPORTED);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_loop_dissipates),       cmocka_unit_test(lugre_is_of_second_order),
        cmocka_unit_test(modes_have_the_bristles), cmocka_unit_test(the_state_is_saved),
        cmocka_unit_test(rejected_steps_leave_it), cmocka_unit_test(it_is_transferred),
        cmocka_unit_test(statics_follow_the_path), cmocka_unit_test(what_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
