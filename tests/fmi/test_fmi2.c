/* The FMI 2.0 unit of a rig, loaded as an importer does, against the library's own run: equal bits; states, events,
 * nonsense. */
#include "fmi2_declarations.h"
#include "loader.h"

static struct {
    fmi2Component (*instantiate)(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions *,
                                 fmi2Boolean, fmi2Boolean);
    void (*free_instance)(fmi2Component);
    fmi2Status (*setup)(fmi2Component, fmi2Boolean, double, double, fmi2Boolean, double);
    fmi2Status (*enter_initialization)(fmi2Component);
    fmi2Status (*exit_initialization)(fmi2Component);
    fmi2Status (*get)(fmi2Component, const fmi2ValueReference *, size_t, double *);
    fmi2Status (*set)(fmi2Component, const fmi2ValueReference *, size_t, const double *);
    fmi2Status (*get_int)(fmi2Component, const fmi2ValueReference *, size_t, int *);
    fmi2Status (*do_step)(fmi2Component, double, double, fmi2Boolean);
    fmi2Status (*real_status)(fmi2Component, fmi2StatusKind, double *);
    fmi2Status (*get_state)(fmi2Component, fmi2FMUstate *);
    fmi2Status (*set_state)(fmi2Component, fmi2FMUstate);
    fmi2Status (*free_state)(fmi2Component, fmi2FMUstate *);
    fmi2Status (*state_size)(fmi2Component, fmi2FMUstate, size_t *);
    fmi2Status (*serialize)(fmi2Component, fmi2FMUstate, fmi2Byte *, size_t);
    fmi2Status (*deserialize)(fmi2Component, const fmi2Byte *, size_t, fmi2FMUstate *);
    fmi2Status (*derivative)(fmi2Component, const fmi2ValueReference *, size_t, const fmi2ValueReference *, size_t,
                             const double *, double *);
} fmi;

static int load(void **state)
{
    (void)state;
    void *library = binary();
    import(library, "fmi2Instantiate", &fmi.instantiate);
    import(library, "fmi2FreeInstance", &fmi.free_instance);
    import(library, "fmi2SetupExperiment", &fmi.setup);
    import(library, "fmi2EnterInitializationMode", &fmi.enter_initialization);
    import(library, "fmi2ExitInitializationMode", &fmi.exit_initialization);
    import(library, "fmi2GetReal", &fmi.get);
    import(library, "fmi2SetReal", &fmi.set);
    import(library, "fmi2GetInteger", &fmi.get_int);
    import(library, "fmi2DoStep", &fmi.do_step);
    import(library, "fmi2GetRealStatus", &fmi.real_status);
    import(library, "fmi2GetFMUstate", &fmi.get_state);
    import(library, "fmi2SetFMUstate", &fmi.set_state);
    import(library, "fmi2FreeFMUstate", &fmi.free_state);
    import(library, "fmi2SerializedFMUstateSize", &fmi.state_size);
    import(library, "fmi2SerializeFMUstate", &fmi.serialize);
    import(library, "fmi2DeSerializeFMUstate", &fmi.deserialize);
    import(library, "fmi2GetDirectionalDerivative", &fmi.derivative);
    return 0;
}

static char told[1024];

static void note(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                 fmi2String message, ...)
{
    (void)environment, (void)status, (void)category;
    assert_string_equal(name, "rig");
    va_list arguments;
    va_start(arguments, message);
    snprintf(told, sizeof told, "%s", va_arg(arguments, const char *));
    va_end(arguments);
    /* an importer that does not format it has the text too */
    assert_string_equal(message, strchr(told, '%') != NULL ? "%s" : told);
}

static const fmi2CallbackFunctions callbacks = {note, calloc, free, NULL, NULL};

/* By the URI of its folder, whose name has a blank. */
static fmi2Component instance_of(const rig *r)
{
    char uri[128] = "file://";
    size_t length = strlen(uri);
    for (const char *at = r->folder; *at; ++at) {
        const char *piece = *at == ' ' ? "%20" : (const char[]){*at, 0};
        length += (size_t)snprintf(uri + length, sizeof uri - length, "%s", piece);
    }
    fmi2Component made = fmi.instantiate("rig", fmi2CoSimulation, TOKEN, uri, &callbacks, 0, 1);
    if (!made) fail_msg("%s", told);
    return made;
}

static void set_one(fmi2Component unit, fmi2ValueReference reference, double value)
{
    assert_int_equal(fmi.set(unit, &reference, 1, &value), fmi2OK);
}

static void begin(fmi2Component unit)
{
    assert_int_equal(fmi.setup(unit, 0, 0.0, 0.0, 1, 1.0), fmi2OK);
    assert_int_equal(fmi.enter_initialization(unit), fmi2OK);
    assert_int_equal(fmi.exit_initialization(unit), fmi2OK);
}

static void go(fmi2Component unit, int from, int to, double outputs[OUTPUTS])
{
    const fmi2ValueReference references[OUTPUTS] = {TORQUE, BIT_SPEED};
    for (int i = from; i < to; ++i) {
        set_one(unit, SPEED, speed_at(i * 2e-3));
        assert_int_equal(fmi.do_step(unit, i * 2e-3, 2e-3, 1), fmi2OK);
    }
    assert_int_equal(fmi.get(unit, references, OUTPUTS, outputs), fmi2OK);
}

static void test_bits_of_the_library(void **state)
{
    (void)state;
    rig r;
    open_rig(&r, 0);
    double got[OUTPUTS], want[OUTPUTS];
    fmi2Component unit = instance_of(&r);
    set_one(unit, FRICTION, 2.0);
    begin(unit);
    dmb_sim *sim = sim_of(&r);
    must(dmb_sim_set_input(sim, r.friction, 2.0), dmb_sim_message(sim));
    for (int i = 0; i < 20; ++i) {
        go(unit, i, i + 1, got);
        must(dmb_sim_set_input(sim, r.speed, speed_at(i * 2e-3)), dmb_sim_message(sim));
        for (int k = 0; k < 2; ++k) must(dmb_sim_step(sim, step_length, NULL), dmb_sim_message(sim));
        ask(&r, sim, want);
        assert_memory_equal(got, want, sizeof got);
    }
    assert_int_equal(fmi.real_status(unit, fmi2LastSuccessfulTime, &want[0]), fmi2OK);
    assert_true(fabs(want[0] - 0.04) < 1e-15);
    dmb_sim_destroy(&sim);
    fmi.free_instance(unit);
    close_rig(&r);
}

/* Torque by speed is the controller's gain, which the torque at another speed tells; the bit's speed stays. Nothing
 * changes. */
static void test_directional_derivative(void **state)
{
    (void)state;
    rig r;
    open_rig(&r, 0);
    const fmi2ValueReference outputs[OUTPUTS] = {TORQUE, BIT_SPEED}, speed = SPEED;
    const double seed = 2.0;
    double before[OUTPUTS], after[OUTPUTS], more[OUTPUTS], slope[OUTPUTS];
    fmi2Component unit = instance_of(&r);
    assert_int_equal(fmi.derivative(unit, outputs, OUTPUTS, &speed, 1, &seed, slope), fmi2Error);
    begin(unit);
    go(unit, 0, 6, before);
    assert_int_equal(fmi.derivative(unit, outputs, OUTPUTS, &speed, 1, &seed, slope), fmi2OK);
    assert_int_equal(fmi.get(unit, outputs, OUTPUTS, after), fmi2OK);
    assert_memory_equal(before, after, sizeof before);
    set_one(unit, SPEED, speed_at(5 * 2e-3) + seed);
    assert_int_equal(fmi.get(unit, outputs, OUTPUTS, more), fmi2OK);
    assert_true(more[0] - before[0] > 1.0);
    assert_true(fabs(slope[0] - (more[0] - before[0])) < 1e-9 * fabs(slope[0]));
    assert_true(slope[1] == 0.0);
    assert_int_equal(fmi.derivative(NULL, outputs, OUTPUTS, &speed, 1, &seed, slope), fmi2Error);
    fmi.free_instance(unit);
    close_rig(&r);
}

static void test_states(void **state)
{
    (void)state;
    rig r;
    open_rig(&r, 0);
    double got[OUTPUTS], want[OUTPUTS];
    fmi2Component unit = instance_of(&r), other = instance_of(&r);
    fmi2FMUstate saved = NULL, read = NULL;
    size_t size;
    begin(unit);
    go(unit, 0, 5, got);
    assert_int_equal(fmi.get_state(unit, &saved), fmi2OK);
    go(unit, 5, 12, want);
    assert_int_equal(fmi.state_size(unit, saved, &size), fmi2OK);
    char *bytes = malloc(size);
    assert_int_equal(fmi.serialize(unit, saved, bytes, size), fmi2OK);
    assert_int_equal(fmi.deserialize(other, bytes, size, &read), fmi2OK);
    bytes[size / 2] ^= 1;
    assert_int_equal(fmi.deserialize(other, bytes, size, &read), fmi2Error);
    assert_int_equal(fmi.set_state(unit, saved), fmi2OK);
    assert_int_equal(fmi.set_state(other, read), fmi2OK);
    go(unit, 5, 12, got);
    assert_memory_equal(got, want, sizeof got);
    go(other, 5, 12, got);
    assert_memory_equal(got, want, sizeof got);
    fmi.free_state(unit, &saved);
    fmi.free_state(other, &read);
    free(bytes);
    fmi.free_instance(unit);
    fmi.free_instance(other);
    close_rig(&r);
}

static void refused(fmi2Status status, fmi2Status want, const char *word)
{
    assert_int_equal(status, want);
    if (!strstr(told, word)) fail_msg("\"%s\" has no \"%s\"", told, word);
    told[0] = 0;
}

/* A step counts the events that it passes; it is never ended early. */
static void test_events_and_nonsense(void **state)
{
    (void)state;
    rig r;
    open_rig(&r, 1);
    fmi2Component unit = instance_of(&r);
    const fmi2ValueReference fast = FAST, none = 5, inner = 1;
    double value = 1e-3;
    int count = -1;
    refused(fmi.do_step(unit, 0.0, 0.1, 1), fmi2Error, "mode");
    refused(fmi.setup(unit, 0, 0.0, 2.0, 0, 0.0), fmi2Error, "must be 0");
    refused(fmi.set(unit, &inner, 1, &value), fmi2Discard, "events");
    begin(unit);
    assert_int_equal(fmi.do_step(unit, 0.0, 0.1, 1), fmi2OK);
    assert_int_equal(fmi.get_int(unit, &fast, 1, &count), fmi2OK);
    assert_true(count >= 1);
    refused(fmi.get(unit, &none, 1, &value), fmi2Error, "5 is no");
    refused(fmi.do_step(unit, 0.0, 0.1, 1), fmi2Error, "the unit is at 0.1 s");
    fmi.free_instance(unit);
    assert_null(fmi.instantiate("rig", fmi2ModelExchange, TOKEN, r.folder, &callbacks, 0, 0));
    refused(fmi2OK, fmi2OK, "co-simulation");
    assert_null(fmi.instantiate("rig", fmi2CoSimulation, "{none}", r.folder, &callbacks, 0, 0));
    refused(fmi2OK, fmi2OK, "{none}");
    assert_null(fmi.instantiate("rig", fmi2CoSimulation, TOKEN, NULL, &callbacks, 0, 0));
    close_rig(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_bits_of_the_library),
                                       cmocka_unit_test(test_directional_derivative), cmocka_unit_test(test_states),
                                       cmocka_unit_test(test_events_and_nonsense)};
    return cmocka_run_group_tests(tests, load, NULL);
}
