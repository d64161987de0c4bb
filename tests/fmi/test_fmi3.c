/* The FMI 3.0 unit of a rig, loaded as an importer does, against the library's own run: equal bits; states saved and
 * restored, several instances, events, and nonsense. */
#include "fmi3_declarations.h"
#include "loader.h"

static struct {
    fmi3Instance (*instantiate)(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean, fmi3Boolean, fmi3Boolean,
                                const fmi3ValueReference *, size_t, fmi3InstanceEnvironment, fmi3LogMessageCallback,
                                fmi3IntermediateUpdateCallback);
    void (*free_instance)(fmi3Instance);
    fmi3Status (*enter_initialization)(fmi3Instance, fmi3Boolean, fmi3Float64, fmi3Float64, fmi3Boolean, fmi3Float64);
    fmi3Status (*exit_initialization)(fmi3Instance);
    fmi3Status (*enter_event)(fmi3Instance);
    fmi3Status (*update)(fmi3Instance, bool *, bool *, bool *, bool *, bool *, double *);
    fmi3Status (*enter_step)(fmi3Instance);
    fmi3Status (*terminate)(fmi3Instance);
    fmi3Status (*reset)(fmi3Instance);
    fmi3Status (*get)(fmi3Instance, const fmi3ValueReference *, size_t, double *, size_t);
    fmi3Status (*set)(fmi3Instance, const fmi3ValueReference *, size_t, const double *, size_t);
    fmi3Status (*get_int)(fmi3Instance, const fmi3ValueReference *, size_t, int32_t *, size_t);
    fmi3Status (*do_step)(fmi3Instance, double, double, bool, bool *, bool *, bool *, double *);
    fmi3Status (*get_state)(fmi3Instance, fmi3FMUState *);
    fmi3Status (*set_state)(fmi3Instance, fmi3FMUState);
    fmi3Status (*free_state)(fmi3Instance, fmi3FMUState *);
    fmi3Status (*state_size)(fmi3Instance, fmi3FMUState, size_t *);
    fmi3Status (*serialize)(fmi3Instance, fmi3FMUState, fmi3Byte *, size_t);
    fmi3Status (*deserialize)(fmi3Instance, const fmi3Byte *, size_t, fmi3FMUState *);
    fmi3Status (*derivative)(fmi3Instance, const fmi3ValueReference *, size_t, const fmi3ValueReference *, size_t,
                             const double *, size_t, double *, size_t);
} fmi;

static int load(void **state)
{
    (void)state;
    void *library = binary();
    import(library, "fmi3InstantiateCoSimulation", &fmi.instantiate);
    import(library, "fmi3FreeInstance", &fmi.free_instance);
    import(library, "fmi3EnterInitializationMode", &fmi.enter_initialization);
    import(library, "fmi3ExitInitializationMode", &fmi.exit_initialization);
    import(library, "fmi3EnterEventMode", &fmi.enter_event);
    import(library, "fmi3UpdateDiscreteStates", &fmi.update);
    import(library, "fmi3EnterStepMode", &fmi.enter_step);
    import(library, "fmi3Terminate", &fmi.terminate);
    import(library, "fmi3Reset", &fmi.reset);
    import(library, "fmi3GetFloat64", &fmi.get);
    import(library, "fmi3SetFloat64", &fmi.set);
    import(library, "fmi3GetInt32", &fmi.get_int);
    import(library, "fmi3DoStep", &fmi.do_step);
    import(library, "fmi3GetFMUState", &fmi.get_state);
    import(library, "fmi3SetFMUState", &fmi.set_state);
    import(library, "fmi3FreeFMUState", &fmi.free_state);
    import(library, "fmi3SerializedFMUStateSize", &fmi.state_size);
    import(library, "fmi3SerializeFMUState", &fmi.serialize);
    import(library, "fmi3DeserializeFMUState", &fmi.deserialize);
    import(library, "fmi3GetDirectionalDerivative", &fmi.derivative);
    return 0;
}

typedef struct told {
    char text[1024];
    int count;
} told;

static void note(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message)
{
    told *log = environment;
    (void)status;
    assert_non_null(category);
    snprintf(log->text, sizeof log->text, "%s", message);
    ++log->count;
}

static fmi3Instance instance_of(const rig *r, told *log, bool event_mode, bool early)
{
    memset(log, 0, sizeof *log);
    fmi3Instance made =
        fmi.instantiate("rig", TOKEN, r->folder, false, true, event_mode, early, NULL, 0, log, note, NULL);
    if (!made) fail_msg("%s", log->text);
    return made;
}

static void set_one(fmi3Instance unit, fmi3ValueReference reference, double value)
{
    assert_int_equal(fmi.set(unit, &reference, 1, &value, 1), fmi3OK);
}

static void begin(fmi3Instance unit)
{
    assert_int_equal(fmi.enter_initialization(unit, false, 0.0, 0.0, false, 0.0), fmi3OK);
    assert_int_equal(fmi.exit_initialization(unit), fmi3OK);
}

static void step(fmi3Instance unit, double time, double length)
{
    bool event, terminate, early;
    double last;
    set_one(unit, SPEED, speed_at(time));
    assert_int_equal(fmi.do_step(unit, time, length, true, &event, &terminate, &early, &last), fmi3OK);
    assert_false(event || terminate || early);
    assert_true(last == time + length);
}

static void read_outputs(fmi3Instance unit, double outputs[OUTPUTS])
{
    const fmi3ValueReference references[OUTPUTS] = {TORQUE, BIT_SPEED};
    assert_int_equal(fmi.get(unit, references, OUTPUTS, outputs, OUTPUTS), fmi3OK);
}

static void assert_same(const double *a, const double *b)
{
    assert_memory_equal(a, b, OUTPUTS * sizeof *a);
}

/* Communication steps of one, several and a part of the inner steps. */
static void test_bits_of_the_library(void **state)
{
    (void)state;
    static const double lengths[] = {1e-3, 4e-3, 0.5e-3};
    static const int whole[] = {1, 4, 0};
    for (int k = 0; k < 3; ++k) {
        rig r;
        told log;
        open_rig(&r, 0);
        fmi3Instance unit = instance_of(&r, &log, false, false);
        set_one(unit, FRICTION, 1.5);
        begin(unit);
        dmb_sim *sim = sim_of(&r);
        must(dmb_sim_set_input(sim, r.friction, 1.5), dmb_sim_message(sim));
        double got[OUTPUTS], want[OUTPUTS], moved = 0.0;
        for (int i = 0; i < 30; ++i) {
            step(unit, i * lengths[k], lengths[k]);
            must(dmb_sim_set_input(sim, r.speed, speed_at(i * lengths[k])), dmb_sim_message(sim));
            for (int j = 0; j < whole[k]; ++j) must(dmb_sim_step(sim, step_length, NULL), dmb_sim_message(sim));
            if (whole[k] == 0) must(dmb_sim_step(sim, lengths[k], NULL), dmb_sim_message(sim));
            read_outputs(unit, got);
            ask(&r, sim, want);
            assert_same(got, want);
            moved = fmax(moved, fabs(got[1]));
        }
        assert_true(moved > 1.0); /* something happened */
        dmb_sim_destroy(&sim);
        assert_int_equal(fmi.terminate(unit), fmi3OK);
        fmi.free_instance(unit);
        close_rig(&r);
    }
}

/* Reset: the same run again, without what was set. Time functions hold while an input is not set. */
static void test_reset_and_start_values(void **state)
{
    (void)state;
    rig r;
    told log;
    open_rig(&r, 0);
    fmi3Instance unit = instance_of(&r, &log, false, false);
    const fmi3ValueReference all[3] = {0, 1, SPEED};
    double values[3], first[OUTPUTS], again[OUTPUTS];
    bool flags[3];
    double last;
    for (int k = 0; k < 2; ++k) {
        begin(unit);
        assert_int_equal(fmi.get(unit, all, 3, values, 3), fmi3OK);
        assert_true(values[0] == 0.0 && values[1] == step_length && values[2] == 0.5);
        for (int i = 0; i < 20; ++i)
            assert_int_equal(fmi.do_step(unit, i * 1e-3, 1e-3, true, &flags[0], &flags[1], &flags[2], &last), fmi3OK);
        read_outputs(unit, k == 0 ? first : again);
        step(unit, 0.02, 0.001);
        assert_int_equal(fmi.reset(unit), fmi3OK);
    }
    assert_same(first, again);
    dmb_sim *sim = sim_of(&r);
    for (int i = 0; i < 20; ++i) must(dmb_sim_step(sim, step_length, NULL), dmb_sim_message(sim));
    ask(&r, sim, again);
    assert_same(first, again);
    dmb_sim_destroy(&sim);
    fmi.free_instance(unit);
    close_rig(&r);
}

static void go(fmi3Instance unit, int from, int to, double outputs[OUTPUTS])
{
    for (int i = from; i < to; ++i) step(unit, i * 1e-3, 1e-3);
    read_outputs(unit, outputs);
}

/* Back to a saved state, and on in another instance from its bytes; two instances do not disturb each other. */
static void test_states_and_instances(void **state)
{
    (void)state;
    rig r;
    told log[2];
    open_rig(&r, 0);
    fmi3Instance unit = instance_of(&r, &log[0], false, false), other = instance_of(&r, &log[1], false, false);
    double want[OUTPUTS], got[OUTPUTS];
    begin(unit);
    go(unit, 0, 10, got);
    fmi3FMUState saved = NULL, read = NULL;
    assert_int_equal(fmi.get_state(unit, &saved), fmi3OK);
    go(unit, 10, 30, want);
    assert_int_equal(fmi.set_state(unit, saved), fmi3OK);
    size_t size;
    assert_int_equal(fmi.state_size(unit, saved, &size), fmi3OK);
    fmi3Byte *bytes = malloc(size);
    assert_int_equal(fmi.serialize(unit, saved, bytes, size), fmi3OK);
    assert_int_equal(fmi.serialize(unit, saved, bytes, size - 1), fmi3Error);
    assert_int_equal(fmi.deserialize(other, bytes, size, &read), fmi3OK);
    assert_int_equal(fmi.set_state(other, read), fmi3OK);
    for (int i = 10; i < 30; ++i) { /* by turns */
        step(unit, i * 1e-3, 1e-3);
        step(other, i * 1e-3, 1e-3);
    }
    read_outputs(unit, got);
    assert_same(got, want);
    read_outputs(other, got);
    assert_same(got, want);
    for (size_t i = 0; i < size; i += 7) { /* damaged and cut */
        fmi3FMUState none = NULL;
        bytes[i] ^= 0x10;
        assert_int_equal(fmi.deserialize(other, bytes, size, &none), fmi3Error);
        bytes[i] ^= 0x10;
        assert_int_equal(fmi.deserialize(other, bytes, i, &none), fmi3Error);
        assert_null(none);
    }
    assert_int_equal(fmi.free_state(unit, &saved), fmi3OK);
    assert_int_equal(fmi.free_state(other, &read), fmi3OK);
    assert_null(saved);
    free(bytes);
    fmi.free_instance(unit);
    fmi.free_instance(other);
    close_rig(&r);
}

/* Early return at an event, at the library's time; the count is told with and without it. */
static void test_events(void **state)
{
    (void)state;
    for (int early_allowed = 0; early_allowed < 2; ++early_allowed) {
        rig r;
        told log;
        open_rig(&r, 1);
        fmi3Instance unit = instance_of(&r, &log, early_allowed, early_allowed);
        begin(unit);
        bool event, terminate, early, flags[5];
        double last, next;
        if (early_allowed) assert_int_equal(fmi.enter_step(unit), fmi3OK);
        assert_int_equal(fmi.do_step(unit, 0.0, 0.1, true, &event, &terminate, &early, &last), fmi3OK);
        assert_int_equal(early, early_allowed);
        assert_int_equal(event, early_allowed);
        const fmi3ValueReference fast = FAST;
        int32_t count = -1;
        assert_int_equal(fmi.get_int(unit, &fast, 1, &count, 1), fmi3OK);
        assert_true(count >= 1);
        if (early_allowed) {
            dmb_sim *sim = sim_of(&r);
            double got[OUTPUTS], want[OUTPUTS];
            must(dmb_sim_advance_to_event(sim, 0.1, NULL, NULL), dmb_sim_message(sim));
            assert_true(last == dmb_sim_time(sim) && last < 0.1);
            ask(&r, sim, want);
            read_outputs(unit, got);
            assert_same(got, want);
            assert_int_equal(fmi.enter_event(unit), fmi3OK);
            assert_int_equal(fmi.update(unit, flags, flags + 1, flags + 2, flags + 3, flags + 4, &next), fmi3OK);
            assert_false(flags[0] || flags[1] || flags[4]);
            assert_int_equal(fmi.enter_step(unit), fmi3OK);
            assert_int_equal(fmi.do_step(unit, last, 1e-3, true, &event, &terminate, &early, &last), fmi3OK);
            dmb_sim_destroy(&sim);
        } else {
            assert_true(last == 0.1);
        }
        fmi.free_instance(unit);
        close_rig(&r);
    }
}

static void refused(fmi3Status status, fmi3Status want, told *log, const char *word)
{
    assert_int_equal(status, want);
    if (!strstr(log->text, word)) fail_msg("\"%s\" has no \"%s\"", log->text, word);
    log->text[0] = 0;
}

/* A start that fails is not made good by later values: an importer that does not read its status gets no results. */
static void test_failed_start_stays_failed(void **state)
{
    (void)state;
    rig r;
    told log;
    open_rig(&r, 0);
    fmi3Instance unit = instance_of(&r, &log, false, false);
    const fmi3ValueReference speed = SPEED, torque = TORQUE;
    double value = 10.0, last;
    bool a, b, c;
    set_one(unit, SPEED, 99.0); /* at most 30 */
    assert_int_equal(fmi.enter_initialization(unit, false, 0.0, 0.0, false, 0.0), fmi3OK);
    refused(fmi.exit_initialization(unit), fmi3Error, &log, "start failed: inputs");
    refused(fmi.set(unit, &speed, 1, &value, 1), fmi3Error, &log, "mode \"failed\"");
    refused(fmi.exit_initialization(unit), fmi3Error, &log, "mode \"failed\"");
    refused(fmi.get(unit, &torque, 1, &value, 1), fmi3Error, &log, "reset it");
    refused(fmi.do_step(unit, 0.0, 1e-3, true, &a, &b, &c, &last), fmi3Error, &log, "mode \"failed\"");
    assert_int_equal(fmi.reset(unit), fmi3OK);
    set_one(unit, SPEED, 10.0);
    begin(unit);
    step(unit, 0.0, 1e-3);
    fmi.free_instance(unit);
    close_rig(&r);
}

static void test_nonsense(void **state)
{
    (void)state;
    rig r;
    told log;
    open_rig(&r, 0);
    fmi3Instance unit = instance_of(&r, &log, false, false);
    const fmi3ValueReference none = 77, speed = SPEED, torque = TORQUE, inner = 1;
    double value = 1.0, high = 99.0, nan = (double)NAN, last;
    int32_t count;
    bool a, b, c;
    refused(fmi.do_step(unit, 0.0, 1e-3, true, &a, &b, &c, &last), fmi3Error, &log, "mode \"instantiated\"");
    refused(fmi.exit_initialization(unit), fmi3Error, &log, "mode");
    refused(fmi.enter_initialization(unit, false, 0.0, 1.0, false, 0.0), fmi3Error, &log, "must be 0");
    refused(fmi.set(unit, &speed, 1, &nan, 1), fmi3Discard, &log, "finite");
    begin(unit);
    refused(fmi.get(unit, &none, 1, &value, 1), fmi3Error, &log, "77 is no");
    refused(fmi.set(unit, &none, 1, &value, 1), fmi3Error, &log, "77 is no");
    refused(fmi.set(unit, &torque, 1, &value, 1), fmi3Error, &log, "is no input");
    refused(fmi.get_int(unit, &speed, 1, &count, 1), fmi3Error, &log, "is no integer");
    refused(fmi.set(unit, &speed, 1, &high, 1), fmi3Discard, &log, "speed");
    refused(fmi.set(unit, &inner, 1, &value, 1), fmi3Error, &log, "fixed");
    refused(fmi.get(unit, &speed, 1, &value, 2), fmi3Error, &log, "as many");
    refused(fmi.derivative(unit, &speed, 1, &speed, 1, &value, 1, &value, 1), fmi3Error, &log, "is no output");
    refused(fmi.derivative(unit, &torque, 1, &torque, 1, &value, 1, &value, 1), fmi3Error, &log, "is no input");
    refused(fmi.derivative(unit, &torque, 1, &speed, 1, &value, 2, &value, 1), fmi3Error, &log, "as many");
    refused(fmi.derivative(unit, &torque, 1, &speed, 1, &nan, 1, &value, 1), fmi3Discard, &log, "must be finite");
    step(unit, 0.0, 1e-3);
    refused(fmi.do_step(unit, 0.0, 1e-3, true, &a, &b, &c, &last), fmi3Error, &log, "the unit is at 0.001 s");
    refused(fmi.do_step(unit, 1e-3, -1e-3, true, &a, &b, &c, &last), fmi3Error, &log, "must be > 0");
    refused(fmi.do_step(unit, (double)NAN, 1e-3, true, &a, &b, &c, &last), fmi3Error, &log, "communication point");
    step(unit, 1e-3, 1e-3); /* it goes on all the same */
    assert_int_equal(fmi.do_step(NULL, 0.0, 1e-3, true, &a, &b, &c, &last), fmi3Error);
    fmi.free_instance(unit);
    fmi.free_instance(NULL);
    close_rig(&r);
}

static unsigned char *read_scene(const rig *r, char path[128], size_t *size)
{
    snprintf(path, 128, "%s/scene.bin", r->folder);
    FILE *file = fopen(path, "rb");
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static fmi3Instance open_bytes(const rig *r, const char *path, const unsigned char *bytes, size_t size, told *log)
{
    FILE *file = fopen(path, "wb");
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    memset(log, 0, sizeof *log);
    return fmi.instantiate("rig", TOKEN, r->folder, false, false, false, false, NULL, 0, log, note, NULL);
}

static void put_u32(unsigned char *at, uint32_t value)
{
    for (int i = 0; i < 4; ++i) at[i] = (unsigned char)(value >> 8 * i);
}

/* That of the scene record, which leaves out its own four bytes at 24, and that of the file. */
static void fit_checksums(unsigned char *bytes, size_t size)
{
    enum { RECORD = SCENE_HEADER + SCENE_TOKEN + 4, AT = 24 };
    uint32_t length = 0;
    for (int i = 0; i < 4; ++i) length |= (uint32_t)bytes[RECORD - 4 + i] << 8 * i;
    if (length > AT + 4 && length <= size - RECORD) {
        unsigned char *counted = malloc(length);
        memcpy(counted, bytes + RECORD, AT);
        memcpy(counted + AT, bytes + RECORD + AT + 4, length - AT - 4);
        put_u32(bytes + RECORD + AT, scene_checksum(counted, length - 4));
        free(counted);
    }
    put_u32(bytes + SCENE_CHECKSUM_AT, scene_checksum(bytes + SCENE_HEADER, size - SCENE_HEADER));
}

/* Damaged: refused. With checksums made to fit: refused, or a unit that can be begun and freed. */
static void test_damaged_resources(void **state)
{
    (void)state;
    rig r;
    told log;
    char path[128];
    size_t size;
    open_rig(&r, 0);
    assert_null(fmi.instantiate("rig", "{other}", r.folder, false, false, false, false, NULL, 0, &log, note, NULL));
    assert_non_null(strstr(log.text, "{other}"));
    assert_null(fmi.instantiate("rig", TOKEN, "/nowhere", false, false, false, false, NULL, 0, &log, note, NULL));
    assert_non_null(strstr(log.text, "/nowhere/scene.bin"));
    unsigned char *bytes = read_scene(&r, path, &size);
    unsigned char *damaged = malloc(size);
    int survived = 0, refusals = 0;
    for (size_t i = 0; i < size; i += 13) {
        memcpy(damaged, bytes, size);
        damaged[i] ^= (unsigned char)(1u << i % 8);
        assert_null(open_bytes(&r, path, damaged, size, &log));
        assert_true(log.count == 1 && strlen(log.text) > 20);
        assert_null(open_bytes(&r, path, damaged, i, &log));
        fit_checksums(damaged, size);
        fmi3Instance unit = open_bytes(&r, path, damaged, size, &log);
        if (unit) {
            if (fmi.enter_initialization(unit, false, 0.0, 0.0, false, 0.0) == fmi3OK)
                (void)fmi.exit_initialization(unit);
            ++survived;
        } else {
            ++refusals;
        }
        fmi.free_instance(unit);
    }
    print_message("%d of %d with a fitting checksum taken\n", survived, survived + refusals);
    assert_true(refusals > 0);
    free(damaged);
    free(bytes);
    close_rig(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bits_of_the_library),       cmocka_unit_test(test_reset_and_start_values),
        cmocka_unit_test(test_states_and_instances),      cmocka_unit_test(test_events),
        cmocka_unit_test(test_failed_start_stays_failed), cmocka_unit_test(test_nonsense),
        cmocka_unit_test(test_damaged_resources),
    };
    return cmocka_run_group_tests(tests, load, NULL);
}
