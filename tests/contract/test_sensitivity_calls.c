/* Sensitivities as an object: the bits of the sim's own steps, what is refused and what a refusal leaves, breakpoints
 * told, no allocation in a step, all memory given back. */
#include <stdlib.h>
#include <string.h>

#include "rig.h"
#include "sim/sim.h"

static double height = -0.0437;

static uint32_t allocations, live;

static void *allocate(void *context, size_t size, size_t alignment)
{
    (void)context;
    allocations++;
    live++;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release(void *context, void *block, size_t size, size_t alignment)
{
    (void)context, (void)size, (void)alignment;
    live--;
    free(block);
}

/* A ball above the wall. */
static rig ball(double at, int32_t friction, uint32_t more)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = dmb_body_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    wall.diameter = 0.2;
    wall.stiffness = 1e5;
    wall.friction_law = friction;
    (void)add_wall(&s, &wall);
    body.contact_diameter = 0.1;
    body.position[2] = at;
    for (uint32_t i = 0; i <= more; i++) {
        body.position[0] = i;
        (void)add_body(&s, &body);
    }
    dmb_allocator allocator = dmb_allocator_default();
    dmb_sim_options options = dmb_sim_options_default();
    allocator.allocate = allocate;
    allocator.release = release;
    options.allocator = &allocator;
    (void)rig_start(&s, &options);
    return s;
}

typedef struct trio {
    rig s, low, high;
    dmb_parameter parameter;
} trio;

static trio trio_of(double step)
{
    trio t;
    t.s = ball(height, DMB_FRICTION_STRIBECK, 0);
    t.low = ball(height - step, DMB_FRICTION_STRIBECK, 0);
    t.high = ball(height + step, DMB_FRICTION_STRIBECK, 0);
    t.parameter = dmb_parameter_default();
    t.parameter.step = step;
    t.parameter.low = t.low.sim;
    t.parameter.high = t.high.sim;
    return t;
}

static void trio_close(trio *t)
{
    rig_close(&t->s);
    rig_close(&t->low);
    rig_close(&t->high);
}

static void test_bits(void **state)
{
    trio t = trio_of(1e-6);
    rig alone = ball(height, DMB_FRICTION_STRIBECK, 0);
    dmb_sensitivity *sensitivity;
    (void)state;
    must(&t.s, dmb_sensitivity_create(t.s.sim, &t.parameter, 1, &sensitivity));
    for (int i = 0; i < 100; i++) {
        must(&alone, dmb_sim_step(alone.sim, 1e-3, NULL));
        must(&t.s, dmb_sensitivity_step(sensitivity, 1e-3, NULL));
    }
    assert_true(rig_hash(&alone) == rig_hash(&t.s));
    must(&alone, dmb_sim_advance(alone.sim, 0.3, NULL));
    must(&t.s, dmb_sensitivity_advance(sensitivity, 0.3, NULL));
    assert_true(rig_hash(&alone) == rig_hash(&t.s));
    dmb_sensitivity_destroy(&sensitivity);
    assert_null(sensitivity);
    rig_close(&alone);
    trio_close(&t);
}

/* One side touches the wall in a step and the other does not. */
static void test_corner(void **state)
{
    trio t = trio_of(1e-3);
    dmb_sensitivity *sensitivity;
    int32_t status = DMB_OK;
    (void)state;
    must(&t.s, dmb_sensitivity_create(t.s.sim, &t.parameter, 1, &sensitivity));
    for (int i = 0; i < 100 && status == DMB_OK; i++) status = dmb_sensitivity_step(sensitivity, 1e-3, NULL);
    assert_int_equal(status, DMB_NOTE_NOT_SMOOTH);
    assert_non_null(strstr(dmb_sim_message(t.s.sim), "a mean of two derivatives"));
    uint64_t kinks = 0;
    must(&t.s, dmb_sensitivity_kinks(sensitivity, 0, &kinks));
    assert_true(kinks == 1);
    assert_int_equal(dmb_sensitivity_kinks(sensitivity, 1, &kinks), DMB_ERR_VALUE);
    dmb_sensitivity_destroy(&sensitivity);
    trio_close(&t);
}

static void refuse(trio *t, int32_t status, const char *word)
{
    dmb_sensitivity *sensitivity = (dmb_sensitivity *)(void *)&height;
    const uint64_t before = rig_hash(&t->s);
    assert_int_equal(dmb_sensitivity_create(t->s.sim, &t->parameter, 1, &sensitivity), status);
    assert_null(sensitivity);
    assert_non_null(strstr(dmb_sim_message(t->s.sim), word));
    assert_true(rig_hash(&t->s) == before);
}

static void test_refusals(void **state)
{
    const double steps[5] = {0.0, -1.0, (double)NAN, (double)INFINITY, 1e300};
    trio t = trio_of(1e-6);
    rig other = ball(height, DMB_FRICTION_NONE, 0), two = ball(height, DMB_FRICTION_STRIBECK, 1);
    dmb_sensitivity *sensitivity;
    (void)state;
    for (int i = 0; i < 5; i++) {
        t.parameter.step = steps[i];
        refuse(&t, i == 2 || i == 3 ? DMB_ERR_NOT_FINITE : DMB_ERR_VALUE, "step");
    }
    t.parameter.step = 1e-6;
    t.parameter.one_sided = 2;
    refuse(&t, DMB_ERR_VALUE, "one_sided");
    t.parameter.one_sided = 0;
    t.parameter.low = NULL;
    refuse(&t, DMB_ERR_NULL, "low");
    t.parameter.low = other.sim;
    refuse(&t, DMB_ERR_VALUE, "other parts");
    t.parameter.low = two.sim;
    refuse(&t, DMB_ERR_VALUE, "other parts");
    t.parameter.low = t.low.sim;
    must(&t.high, dmb_sim_step(t.high.sim, 1e-3, NULL));
    refuse(&t, DMB_ERR_VALUE, "time");
    t.parameter.high = t.low.sim; /* any pair of the make will do */
    assert_int_equal(dmb_sensitivity_create(t.s.sim, &t.parameter, 0, &sensitivity), DMB_ERR_VALUE);
    assert_int_equal(dmb_sensitivity_create(t.s.sim, &t.parameter, UINT32_MAX, &sensitivity), DMB_ERR_VALUE);
    assert_int_equal(dmb_sensitivity_create(t.s.sim, NULL, 1, &sensitivity), DMB_ERR_NULL);
    assert_int_equal(dmb_sensitivity_create(NULL, &t.parameter, 1, &sensitivity), DMB_ERR_NULL);
    assert_int_equal(dmb_sensitivity_create(t.s.sim, &t.parameter, 1, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_sensitivity_step(NULL, 1e-3, NULL), DMB_ERR_NULL);
    dmb_sensitivity_destroy(NULL);
    rig_close(&other);
    rig_close(&two);
    trio_close(&t);
}

/* A breakpoint of a time function at another time on one side: steps end at the sim's. */
static void test_times_differ(void **state)
{
    rig s[3];
    dmb_sensitivity *sensitivity;
    dmb_parameter parameter = dmb_parameter_default();
    (void)state;
    for (int i = 0; i < 3; i++) {
        dmb_segment term = dmb_segment_default();
        dmb_body_def body = dmb_body_def_default();
        rig_open(&s[i], 0.0, 0.0, 0.0);
        term.kind = DMB_SEGMENT_STEP;
        term.x1 = 0.1 + 1e-6 * i;
        term.h1 = 1.0;
        (void)add_simple_drive(&s[i], DMB_DRIVE_MOTION, add_body(&s[i], &body), DMB_X,
                               add_time_function(&s[i], &term, 1));
        (void)rig_start(&s[i], NULL);
    }
    parameter.step = 1e-6;
    parameter.low = s[0].sim;
    parameter.high = s[2].sim;
    assert_int_equal(dmb_sensitivity_create(s[1].sim, &parameter, 1, &sensitivity), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(s[1].sim), "times"));
    for (int i = 0; i < 3; i++) rig_close(&s[i]);
}

/* Calls that fail leave state and derivatives as they were. */
static void test_failures(void **state)
{
    trio t = trio_of(1e-6);
    dmb_sensitivity *sensitivity;
    double before, after, none[1];
    uint32_t rows;
    (void)state;
    must(&t.s, dmb_sensitivity_create(t.s.sim, &t.parameter, 1, &sensitivity));
    must(&t.s, dmb_sensitivity_step(sensitivity, 1e-2, NULL));
    const dmb_id body = {(UINT32_C(4) << 24), 0};
    dmb_output output = {dmb_station(body, 0, 0.0), DMB_OUTPUT_ENERGY_ERROR, 0};
    assert_int_equal(dmb_sensitivity_outputs(sensitivity, &output, 1, NULL, none), DMB_ERR_UNSUPPORTED);
    output.quantity = DMB_OUTPUT_POSITION_Z;
    assert_int_equal(dmb_sensitivity_outputs(sensitivity, &output, 1, NULL, none), DMB_ERR_ID);
    assert_int_equal(dmb_sensitivity_outputs(sensitivity, NULL, 1, NULL, none), DMB_ERR_NULL);
    assert_int_equal(dmb_sensitivity_rows(sensitivity, 1, NULL, NULL, &rows), DMB_ERR_VALUE);
    double velocity[6];
    must(&t.s, dmb_sensitivity_rows(sensitivity, 0, NULL, velocity, &rows));
    before = velocity[2];
    assert_int_equal(dmb_sensitivity_step(sensitivity, -1.0, NULL), DMB_ERR_VALUE);
    assert_int_equal(dmb_sensitivity_step(sensitivity, (double)NAN, NULL), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_sensitivity_advance(sensitivity, 0.0, NULL), DMB_ERR_VALUE);
    must(&t.s, dmb_sensitivity_rows(sensitivity, 0, NULL, velocity, &rows));
    after = velocity[2];
    assert_true(before == after);
    dmb_sensitivity_destroy(&sensitivity);
    trio_close(&t);
}

/* Energies that a run sums up and counts of steps have none; that of the whole as it is has: m v by v. */
static void test_outputs_of_the_whole(void **state)
{
    static const int32_t summed[] = {DMB_OUTPUT_ENERGY_DRIVES, DMB_OUTPUT_ENERGY_UNEXPLAINED, DMB_OUTPUT_STEPS,
                                     DMB_OUTPUT_REDUNDANT, DMB_OUTPUT_DRIVE_WORK};
    trio t = trio_of(1e-6);
    dmb_sensitivity *sensitivity;
    dmb_output output = {.quantity = DMB_OUTPUT_ENERGY_KINETIC};
    double derivative = 0.0, value = 0.0, velocity[6], by[6];
    uint32_t rows;
    (void)state;
    must(&t.s, dmb_sensitivity_create(t.s.sim, &t.parameter, 1, &sensitivity));
    for (int i = 0; i < 60; i++) (void)dmb_sensitivity_step(sensitivity, 1e-3, NULL); /* into the wall */
    must(&t.s, dmb_sensitivity_outputs(sensitivity, &output, 1, &value, &derivative));
    must(&t.s, dmb_sensitivity_rows(sensitivity, 0, NULL, by, &rows));
    memcpy(velocity, t.s.sim->now.velocity, sizeof velocity);
    check_relative("    kinetic energy", value, 0.5 * velocity[2] * velocity[2], 1e-9);
    assert_true(fabs(derivative) > 0.1);
    check_relative("    by the height", derivative, velocity[2] * by[2], 1e-4);
    for (size_t i = 0; i < sizeof summed / sizeof summed[0]; i++) {
        output.quantity = summed[i];
        assert_int_equal(dmb_sensitivity_outputs(sensitivity, &output, 1, &value, &derivative), DMB_ERR_UNSUPPORTED);
        assert_non_null(strstr(dmb_sim_message(t.s.sim), "sums and counts"));
    }
    dmb_sensitivity_destroy(&sensitivity);
    trio_close(&t);
}

static void test_allocates_nothing(void **state)
{
    trio t = trio_of(1e-6);
    dmb_sensitivity *sensitivity;
    (void)state;
    must(&t.s, dmb_sensitivity_create(t.s.sim, &t.parameter, 1, &sensitivity));
    const uint32_t before = allocations;
    for (int i = 0; i < 20; i++) must(&t.s, dmb_sensitivity_step(sensitivity, 1e-3, NULL));
    assert_int_equal(allocations, before);
    dmb_sensitivity_destroy(&sensitivity);
    trio_close(&t);
    assert_int_equal(live, 0);
}

/* ---- Forces of the caller that fail ------------------------------------------------------------------------------ */

static uint32_t calls, fails_at; /* of the force; 0: never */
static dmb_sensitivity *within;  /* asked by the force; NULL: none */

/* The call under way goes on with it. */
static void ask_within(void)
{
    dmb_sensitivity *kept = within;
    assert_int_equal(dmb_sensitivity_step(within, 1e-3, NULL), DMB_ERR_ORDER);
    dmb_sensitivity_destroy(&within);
    assert_ptr_equal(within, kept);
}

static int32_t pull(void *context, double time, uint32_t count, const double (*poses)[12],
                    const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                    const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)velocities, (void)tangent, (void)potential;
    forces[0][0] = -50.0 * poses[0][0];
    if (within != NULL) ask_within();
    return ++calls == fails_at;
}

/* A body on that force, pushed by a drive. */
static rig pulled_body(double velocity, dmb_id *push)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_force_def force = dmb_force_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    body.velocity[0] = velocity;
    force.place[0] = dmb_station(add_body(&s, &body), 0, 0.0);
    force.callback = pull;
    must_model(&s, dmb_model_add_force(s.model, &force, NULL));
    *push = add_simple_drive(&s, DMB_DRIVE_LOAD, force.place[0].part, DMB_X, add_constant(&s, 0.0));
    (void)rig_start(&s, NULL);
    return s;
}

typedef struct derivative {
    double pose[6], velocity[6];
} derivative;

static derivative rates_of(const rig *s, dmb_sensitivity *sensitivity)
{
    derivative d;
    uint32_t rows = 0;
    memset(&d, 0, sizeof d);
    must(s, dmb_sensitivity_rows(sensitivity, 0, d.pose, d.velocity, &rows));
    assert_int_equal(rows, 6);
    return d;
}

/* The force fails at its first call of a step, then at the second, and so on through the steps beside: each time the
 * state stays, and so do the derivatives. In the second step the drive has just been set, so that accelerations jump.
 * Then the step is as if nothing had failed: the derivative by the speed at the start is that of an oscillator. */
static void test_forces_that_fail(void **state)
{
    (void)state;
    for (int32_t one_sided = 0; one_sided < 2; one_sided++) {
        dmb_id push, other;
        rig s = pulled_body(0.1, &push), low = pulled_body(0.1 - 1e-4, &other), high = pulled_body(0.1 + 1e-4, &other);
        dmb_sensitivity *sensitivity;
        dmb_parameter parameter = dmb_parameter_default();
        uint32_t failures = 0;
        parameter.step = 1e-4;
        parameter.one_sided = one_sided;
        parameter.low = low.sim;
        parameter.high = high.sim;
        must(&s, dmb_sensitivity_create(s.sim, &parameter, 1, &sensitivity));
        for (int step = 0; step < 2; step++) {
            if (step == 1) must(&s, dmb_sim_set_drive(s.sim, push, 3.0));
            const uint64_t before = rig_hash(&s);
            const derivative rates = rates_of(&s, sensitivity);
            int32_t status = DMB_ERR_CALLBACK;
            for (uint32_t k = 1; status < 0; k++) {
                calls = 0;
                fails_at = k;
                status = dmb_sensitivity_step(sensitivity, 1e-3, NULL);
                fails_at = 0;
                if (status >= 0) break;
                failures++;
                assert_int_equal(status, DMB_ERR_CALLBACK);
                assert_true(dmb_sim_message(s.sim)[0] != '\0');
                assert_true(rig_hash(&s) == before);
                const derivative now = rates_of(&s, sensitivity);
                if (step == 0) assert_memory_equal(&now, &rates, sizeof now);
                assert_true(largest_difference(12, (const double *)&now, (const double *)&rates) <= 1e-14);
            }
        }
        print_message("    %u failures\n", failures);
        assert_true(failures > 10);
        const double w = sqrt(50.0), t = 2e-3;
        const derivative last = rates_of(&s, sensitivity);
        check_close("    displacement by the speed at the start", last.pose[0], sin(w * t) / w, 1e-8);
        check_close("    speed by the speed at the start", last.velocity[0], cos(w * t), 1e-6);
        dmb_sensitivity_destroy(&sensitivity);
        rig_close(&s);
        rig_close(&low);
        rig_close(&high);
    }
}

static void test_calls_within_a_call(void **state)
{
    dmb_id push, other;
    rig s = pulled_body(0.1, &push), low = pulled_body(0.1 - 1e-4, &other), high = pulled_body(0.1 + 1e-4, &other);
    dmb_sensitivity *sensitivity;
    dmb_parameter parameter = dmb_parameter_default();
    (void)state;
    parameter.step = 1e-4;
    parameter.low = low.sim;
    parameter.high = high.sim;
    must(&s, dmb_sensitivity_create(s.sim, &parameter, 1, &sensitivity));
    within = sensitivity;
    calls = 0;
    must(&s, dmb_sensitivity_step(sensitivity, 1e-3, NULL));
    within = NULL;
    assert_true(calls > 2);
    must(&s, dmb_sensitivity_step(sensitivity, 1e-3, NULL));
    dmb_sensitivity_destroy(&sensitivity);
    assert_null(sensitivity);
    rig_close(&s);
    rig_close(&low);
    rig_close(&high);
}

/* A body on that force, moved across by a drive whose acceleration jumps within an advance. */
static rig moved_body(double velocity)
{
    static const double times[3] = {0.0, 0.0071, 0.1}, speeds[3] = {0.0, 0.5, -1.0};
    dmb_body_def body = dmb_body_def_default();
    dmb_force_def force = dmb_force_def_default();
    dmb_segment table = dmb_segment_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    body.velocity[0] = velocity;
    force.place[0] = dmb_station(add_body(&s, &body), 0, 0.0);
    force.callback = pull;
    must_model(&s, dmb_model_add_force(s.model, &force, NULL));
    table.kind = DMB_SEGMENT_TABLE;
    table.table_time = times;
    table.table_value = speeds;
    table.table_count = 3;
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, force.place[0].part, DMB_Y, add_time_function(&s, &table, 1));
    dmb_sim_options options = dmb_sim_options_default();
    options.tolerance_translation = 1e-10; /* steps of different lengths after a failure come to the same */
    (void)rig_start(&s, &options);
    return s;
}

/* Advances to 20 ms with a force that fails at one of its calls, and then the rest. */
static int32_t advance_past_failure(uint32_t at, derivative *rates)
{
    rig s = moved_body(0.1), low = moved_body(0.1 - 1e-4), high = moved_body(0.1 + 1e-4);
    dmb_sensitivity *sensitivity;
    dmb_parameter parameter = dmb_parameter_default();
    parameter.step = 1e-4;
    parameter.low = low.sim;
    parameter.high = high.sim;
    must(&s, dmb_sensitivity_create(s.sim, &parameter, 1, &sensitivity));
    calls = 0;
    fails_at = at;
    const int32_t status = dmb_sensitivity_advance(sensitivity, 0.02, NULL);
    fails_at = 0;
    if (status < 0) {
        if (status != DMB_ERR_CALLBACK) fail_msg("%s", dmb_sim_message(s.sim));
        assert_true(dmb_sim_time(s.sim) < 0.02);
        must(&s, dmb_sensitivity_advance(sensitivity, 0.02, NULL));
    }
    *rates = rates_of(&s, sensitivity);
    dmb_sensitivity_destroy(&sensitivity);
    rig_close(&s);
    rig_close(&low);
    rig_close(&high);
    return status;
}

#ifdef DMB_SOME_CASES
enum { EVERY = 5 };
#else
enum { EVERY = 1 };
#endif

static void test_failures_beside_a_jump(void **state)
{
    derivative whole, rates;
    uint32_t failures = 0;
    double worst = 0.0;
    (void)state;
    assert_true(advance_past_failure(0, &whole) >= 0);
    for (uint32_t k = 1; advance_past_failure(k, &rates) < 0; k += EVERY, failures++)
        worst = fmax(worst, largest_difference(12, (const double *)&rates, (const double *)&whole));
    print_message("    %u failures\n", failures);
    assert_true(failures > 50 / EVERY);
    check_below("    derivatives after a failure, off those without", worst, 1e-5);
    check_close("    of the place by the speed at the start", whole.pose[0], sin(sqrt(50.0) * 0.02) / sqrt(50.0), 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bits),
        cmocka_unit_test(test_corner),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_failures),
        cmocka_unit_test(test_times_differ),
        cmocka_unit_test(test_outputs_of_the_whole),
        cmocka_unit_test(test_calls_within_a_call),
        cmocka_unit_test(test_allocates_nothing),
        cmocka_unit_test(test_forces_that_fail),
        cmocka_unit_test(test_failures_beside_a_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
