/* Memory that runs out. Every allocation of the description, the compile step and the making of a sim fails once: the
 * call says DMB_ERR_NO_MEMORY, the same call works afterwards, and the run that follows is the same, bit for bit. Then
 * memory runs out for good at each of them: everything that was taken is given back. */
#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"
#include "whole_scene.h"

enum { BLOCKS_MAX = 1024, STEPS = 3 };

typedef struct block {
    void *at;
    size_t size, alignment;
} block;

/* Counts, refuses allocations number `first` .. `last`, and checks what is given back. */
typedef struct budget {
    size_t calls, first, last;
    size_t live, wrong;
    block blocks[BLOCKS_MAX];
} budget;

static void *take(void *context, size_t size, size_t alignment)
{
    budget *b = context;
    size_t rounded = 0;
    void *at;
    ++b->calls;
    if (b->calls >= b->first && b->calls <= b->last) return NULL;
    assert_true(b->live < BLOCKS_MAX);
    assert_true(dmb_checked_round_up(size, alignment, &rounded));
    at = aligned_alloc(alignment, rounded);
    assert_non_null(at);
    memset(at, 0xA5, rounded); /* what is not set to zero shows */
    b->blocks[b->live++] = (block){at, size, alignment};
    return at;
}

static void give(void *context, void *at, size_t size, size_t alignment)
{
    budget *b = context;
    for (size_t i = 0; i < b->live; i++) {
        if (b->blocks[i].at != at) continue;
        if (b->blocks[i].size != size || b->blocks[i].alignment != alignment) ++b->wrong;
        b->blocks[i] = b->blocks[--b->live];
        free(at);
        return;
    }
    ++b->wrong;
}

/* ---- One run ----------------------------------------------------------------------------------------------------- */

typedef struct run {
    budget budget;
    whole_parts parts;
    dmb_allocator allocator;
    dmb_model *model;
    dmb_sim *sim;
    uint64_t hash;
    size_t refused; /* calls that said DMB_ERR_NO_MEMORY */
    int insists;    /* calls again after a refusal */
} run;

static void begin(run *r, size_t first, size_t last)
{
    memset(r, 0, sizeof *r);
    r->budget.first = first;
    r->budget.last = last;
    r->allocator = dmb_allocator_default();
    r->allocator.context = &r->budget;
    r->allocator.allocate = take;
    r->allocator.release = give;
}

static int32_t create_model(run *r)
{
    dmb_model_options options = dmb_model_options_default();
    options.allocator = &r->allocator;
    return dmb_model_create(&options, &r->model);
}

static int32_t create_sim(run *r)
{
    return dmb_sim_create(r->model, NULL, &r->sim);
}

static int32_t describe(run *r, size_t i)
{
    return whole_calls[i](r->model, &r->parts);
}

/* Call 0 makes the model, the last one makes the sim, and in between it is described. */
static int32_t call(run *r, size_t i)
{
    if (i == 0) return create_model(r);
    return i <= WHOLE_CALLS ? describe(r, i - 1) : create_sim(r);
}

/* The call, once more where memory was refused. Returns 0 when there was none in the end. */
static int one_call(run *r, size_t i)
{
    const size_t before = r->budget.calls;
    int32_t status = call(r, i);
    const int short_of_memory =
        r->budget.calls >= r->budget.first && before < r->budget.last && r->budget.calls > before;
    if (status != DMB_ERR_NO_MEMORY) {
        assert_true(status >= 0);
        assert_false(short_of_memory);
        return 1;
    }
    assert_true(short_of_memory);
    ++r->refused;
    if (i == 0) assert_null(r->model);
    if (i > WHOLE_CALLS) assert_null(r->sim);
    if (i > 0 && i <= WHOLE_CALLS) assert_true(dmb_model_message(r->model)[0] != '\0');
    if (!r->insists) return 0;
    status = call(r, i);
    if (status < 0) fail_msg("call %zu again: %s", i, dmb_status_name(status));
    return 1;
}

static void finish(run *r)
{
    if (r->sim != NULL) {
        whole_run(r->sim, STEPS, 1e-3);
        r->hash = whole_hash(r->sim);
    }
    dmb_sim_destroy(&r->sim);
    dmb_model_destroy(&r->model);
    assert_int_equal(r->budget.live, 0);
    assert_int_equal(r->budget.wrong, 0);
}

static void all_calls(run *r)
{
    size_t i = 0;
    while (i <= WHOLE_CALLS + 1 && one_call(r, i)) i++;
    finish(r);
}

static run undisturbed(void)
{
    run r;
    begin(&r, SIZE_MAX, SIZE_MAX);
    all_calls(&r);
    assert_true(r.budget.calls > 20);
    return r;
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void each_allocation_fails_once(void **state)
{
    (void)state;
    const run whole = undisturbed();
    for (size_t k = 1; k <= whole.budget.calls; k++) {
        run r;
        begin(&r, k, k);
        r.insists = 1;
        all_calls(&r);
        if (r.refused != 1) fail_msg("allocation %zu: %zu calls refused", k, r.refused);
        if (r.hash != whole.hash) fail_msg("allocation %zu: the run differs afterwards", k);
    }
    print_message("    %zu allocations\n", whole.budget.calls);
}

static void memory_runs_out_for_good(void **state)
{
    (void)state;
    const run whole = undisturbed();
    for (size_t k = 1; k <= whole.budget.calls; k++) {
        run r;
        begin(&r, k, SIZE_MAX);
        all_calls(&r);
        if (r.refused != 1) fail_msg("allocation %zu: %zu calls refused", k, r.refused);
    }
}

/* A compile step that fails for lack of memory leaves a model that can still be described. */
static void model_stays_open_after_a_failed_compile(void **state)
{
    (void)state;
    dmb_model_info info = dmb_model_info_default();
    run r;
    begin(&r, SIZE_MAX, SIZE_MAX);
    for (size_t i = 0; i < WHOLE_CALLS; i++) assert_true(call(&r, i) >= 0);
    r.budget.first = r.budget.calls + 1;
    r.budget.last = r.budget.first;
    assert_int_equal(dmb_model_compile(r.model, NULL), DMB_ERR_NO_MEMORY);
    assert_int_equal(dmb_model_get_info(r.model, &info), DMB_ERR_ORDER);
    assert_int_equal(create_sim(&r), DMB_ERR_ORDER);
    assert_int_equal(whole_add_dead_load(r.model, &r.parts), DMB_OK);
    assert_int_equal(dmb_model_compile(r.model, NULL), DMB_OK);
    assert_true(create_sim(&r) >= 0);
    finish(&r);
}

/* The caller's block is all that a sim needs. */
static void sim_in_a_block_takes_no_memory(void **state)
{
    (void)state;
    size_t size = 0;
    run r;
    begin(&r, SIZE_MAX, SIZE_MAX);
    for (size_t i = 0; i <= WHOLE_CALLS; i++) assert_true(call(&r, i) >= 0);
    assert_int_equal(dmb_sim_memory_size(r.model, NULL, &size), DMB_OK);
    const size_t calls = r.budget.calls;
    void *memory = malloc(size);
    assert_non_null(memory);
    assert_true(dmb_sim_create_in(r.model, NULL, memory, size, &r.sim) >= 0);
    assert_int_equal(r.budget.calls, calls);
    finish(&r);
    free(memory);
}

/* The sim's own allocator, where one is given. */
static void sim_uses_its_own_allocator(void **state)
{
    (void)state;
    static budget own;
    dmb_sim_options options = dmb_sim_options_default();
    dmb_allocator allocator;
    run r;
    begin(&r, SIZE_MAX, SIZE_MAX);
    allocator = r.allocator;
    memset(&own, 0, sizeof own);
    own.first = own.last = 1;
    allocator.context = &own;
    options.allocator = &allocator;
    for (size_t i = 0; i <= WHOLE_CALLS; i++) assert_true(call(&r, i) >= 0);
    const size_t calls = r.budget.calls;
    assert_int_equal(dmb_sim_create(r.model, &options, &r.sim), DMB_ERR_NO_MEMORY);
    assert_null(r.sim);
    assert_true(dmb_sim_create(r.model, &options, &r.sim) >= 0);
    assert_int_equal(r.budget.calls, calls);
    assert_int_equal(own.live, 1);
    memset(&allocator, 0, sizeof allocator); /* it was copied */
    finish(&r);
    assert_int_equal(own.live, 0);
    assert_int_equal(own.wrong, 0);
}

/* A block of the wrong alignment counts as none. */
static void *take_unaligned(void *context, size_t size, size_t alignment)
{
    unsigned char *at = take(context, size + 8, alignment);
    return at == NULL ? NULL : at + 8;
}

static void give_unaligned(void *context, void *at, size_t size, size_t alignment)
{
    give(context, (unsigned char *)at - 8, size + 8, alignment);
}

static void unaligned_memory_is_refused(void **state)
{
    (void)state;
    run r;
    begin(&r, SIZE_MAX, SIZE_MAX);
    r.allocator.allocate = take_unaligned;
    r.allocator.release = give_unaligned;
    assert_int_equal(create_model(&r), DMB_ERR_NO_MEMORY);
    assert_null(r.model);
    assert_int_equal(r.budget.live, 0);
    assert_int_equal(r.budget.wrong, 0);
}

/* ---- Many of each part ------------------------------------------------------------------------------------------- */

/* More parts of a kind than fit where the first ones did, so that what grows fails between two of them. */
enum { CROWD = 14 };

static dmb_id crowd_time_function(dmb_model *model, int32_t *status)
{
    dmb_id id = {0, 0};
    const dmb_segment term = dmb_segment_default();
    if (*status >= 0) *status = dmb_model_add_time_function(model, &term, 1, &id);
    return id;
}

/* A string of two pipes with a ring, a bit, a drive and a load of its own. */
static int32_t crowd_string(dmb_model *model, dmb_id *string)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    int32_t status = dmb_model_add_string(model, &def, string);
    pipe.string = bit.string = ring.string = drive.part = *string;
    pipe.elements = 3;
    pipe.contact_points = 3;
    pipe.joint_length = 0.1;
    pipe.joint_outer_diameter = 0.08;
    pipe.joint_inner_diameter = 0.05;
    bit.rock_law = DMB_ROCK_RATE;
    load.place = dmb_station(*string, 0, 0.4);
    if (status >= 0) status = dmb_model_add_pipes(model, &pipe, 2, NULL);
    if (status >= 0) status = dmb_model_add_bit(model, &bit, NULL);
    if (status >= 0) status = dmb_model_add_stabiliser(model, &ring, NULL);
    ring.pipe = 1;
    if (status >= 0) status = dmb_model_add_stabiliser(model, &ring, NULL);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.lag = 0.1;
    drive.time_function = crowd_time_function(model, &status);
    if (status >= 0) status = dmb_model_add_drive(model, &drive, NULL);
    if (status >= 0) status = dmb_model_add_load(model, &load, NULL);
    return status;
}

/* A body that meets the wall, hung on a spring and hinged to the one before, and held where it stands. */
static int32_t crowd_body(dmb_model *model, int i, dmb_id *last)
{
    const dmb_id ground = {0, 0};
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_spring_def spring = dmb_spring_def_default();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    dmb_event_def event = dmb_event_def_default();
    dmb_id id = {0, 0};
    body.position[0] = 0.3 * i;
    body.contact_diameter = 0.05;
    int32_t status = dmb_model_add_body(model, &body, &id);
    joint.kind = DMB_JOINT_SPHERICAL;
    joint.place_a = dmb_station(*last, 0, 0.0);
    joint.place_b = spring.place_a = stuck.place = event.output.place = dmb_station(id, 0, 0.0);
    joint.match = 1;
    joint.stiffness[DMB_RX] = 1.0;
    spring.place_b = dmb_station(ground, 0, 0.0);
    spring.offset_b[2] = 1.0;
    spring.stiffness = 10.0;
    stuck.stuck = 0;
    event.output.quantity = DMB_OUTPUT_VELOCITY_X;
    event.level = 1.0;
    (void)snprintf(event.name, sizeof event.name, "event %d", i);
    if (status >= 0 && i % 2 == 1) status = dmb_model_add_joint(model, &joint, NULL);
    if (status >= 0) status = dmb_model_add_spring(model, &spring, NULL);
    if (status >= 0) status = dmb_model_add_stuck(model, &stuck, NULL);
    if (status >= 0) status = dmb_model_add_event(model, &event, NULL);
    *last = id;
    return status;
}

static int32_t crowd_model(run *r)
{
    dmb_hole_section sections[2] = {dmb_hole_section_default(), dmb_hole_section_default()};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_id string = {0, 0}, body = {0, 0};
    sections[1].depth = 2.0;
    sections[1].diameter = 0.11;
    int32_t status = create_model(r);
    if (status >= 0) status = dmb_model_add_wall(r->model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_hole_sections(r->model, sections, 2);
    for (int i = 0; i < CROWD && status >= 0; i++) status = crowd_string(r->model, &string);
    for (int i = 0; i < CROWD && status >= 0; i++) status = crowd_body(r->model, i, &body);
    if (status >= 0) status = dmb_model_compile(r->model, NULL);
    return status < 0 ? status : create_sim(r);
}

/* The first call that memory fails in says so, and nothing stays behind; the same model compiles afterwards. */
static void many_of_each_part(void **state)
{
    (void)state;
    run r;
    begin(&r, SIZE_MAX, SIZE_MAX);
    if (crowd_model(&r) < 0) fail_msg("%s", dmb_model_message(r.model));
    const size_t calls = r.budget.calls;
    finish(&r);
    print_message("    %zu allocations\n", calls);
    for (size_t k = 1; k <= calls; k++) {
        begin(&r, k, k);
        const int32_t status = crowd_model(&r);
        if (status != DMB_ERR_NO_MEMORY) fail_msg("allocation %zu: %s", k, dmb_status_name(status));
        assert_null(r.sim);
        finish(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_allocation_fails_once),
        cmocka_unit_test(memory_runs_out_for_good),
        cmocka_unit_test(model_stays_open_after_a_failed_compile),
        cmocka_unit_test(sim_in_a_block_takes_no_memory),
        cmocka_unit_test(sim_uses_its_own_allocator),
        cmocka_unit_test(unaligned_memory_is_refused),
        cmocka_unit_test(many_of_each_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
