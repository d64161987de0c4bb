/* Every allocation of the describe and compile steps fails once: the call says DMB_ERR_NO_MEMORY and changes nothing,
 * the same call then works, and nothing is leaked. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <stdlib.h>

#include "model/model.h"

typedef struct meter {
    long until_failure; /* allocations that still work; < 0: all do */
    long blocks, bytes;
    int failed;
} meter;

static void *take(void *context, size_t size, size_t alignment)
{
    meter *m = context;
    if (m->until_failure == 0) {
        m->until_failure = -1;
        m->failed = 1;
        return NULL;
    }
    if (m->until_failure > 0) --m->until_failure;
    ++m->blocks;
    m->bytes += (long)size;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void give(void *context, void *block, size_t size, size_t alignment)
{
    meter *m = context;
    (void)alignment;
    --m->blocks;
    m->bytes -= (long)size;
    free(block);
}

typedef struct scene_plan {
    dmb_model_options options;
    dmb_environment_def environment;
    dmb_wall_def wall;
    dmb_segment terms[2];
    dmb_string_def string;
    dmb_pipe_def pipe[3];
    dmb_body_def head;
    dmb_bit_def bit;
    dmb_drive_def drive;
    dmb_load_def load;
    dmb_joint_def joint, hinge;
    dmb_coupling_def coupling;
    dmb_constraint_def constraint;
    dmb_drive_def screw;
    dmb_model *model;
    dmb_id id;
} scene_plan;

static const double survey[] = {0.0, 1.5, 0.0, 30.0, 1.3, 0.2, 60.0, 1.2, 0.2};
static const double table_time[] = {0.0, 1.0, 2.0}, table_value[] = {0.0, 1.0, 0.5};

static int32_t no_constraint(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                             double *jacobian)
{
    (void)context, (void)time, (void)count, (void)poses, (void)value, (void)jacobian;
    return 0;
}

static scene_plan plan(const dmb_allocator *allocator)
{
    scene_plan p;
    memset(&p, 0, sizeof p);
    p.options = dmb_model_options_default();
    p.options.allocator = allocator;
    p.environment = dmb_environment_def_default();
    p.environment.fluid_density = 1100.0;
    p.wall = dmb_wall_def_default();
    p.wall.survey = survey;
    p.wall.survey_count = 3;
    p.terms[0] = p.terms[1] = dmb_segment_default();
    p.terms[1].kind = DMB_SEGMENT_TABLE;
    p.terms[1].table_time = table_time;
    p.terms[1].table_value = table_value;
    p.terms[1].table_count = 3;
    p.string = dmb_string_def_default();
    p.pipe[0] = p.pipe[1] = p.pipe[2] = dmb_pipe_def_default();
    p.pipe[0].kind = DMB_PIPE_AXIAL_TORSIONAL;
    p.pipe[1].eccentricity = 1e-3;
    p.pipe[1].joint_length = 0.1;
    p.pipe[2].kind = DMB_PIPE_RIGID;
    p.head = dmb_body_def_default();
    p.head.attach = DMB_ATTACH_START;
    p.bit = dmb_bit_def_default();
    p.bit.rock_law = DMB_ROCK_REGENERATIVE;
    p.drive = dmb_drive_def_default();
    p.load = dmb_load_def_default();
    p.joint = p.hinge = dmb_joint_def_default();
    p.joint.kind = DMB_JOINT_CYLINDRICAL;
    p.joint.stiffness[DMB_RX] = 1.0;
    p.hinge.kind = DMB_JOINT_REVOLUTE;
    p.hinge.match = 1;
    p.coupling = dmb_coupling_def_default();
    p.constraint = dmb_constraint_def_default();
    p.constraint.callback = no_constraint;
    p.screw = dmb_drive_def_default();
    return p;
}

/* The steps of the description; each is one call. */
static int32_t step(scene_plan *p, int which)
{
    switch (which) {
    case 0: return dmb_model_create(&p->options, &p->model);
    case 1: return dmb_model_set_environment(p->model, &p->environment);
    case 2: return dmb_model_add_wall(p->model, &p->wall, NULL);
    case 3: return dmb_model_add_time_function(p->model, p->terms, 2, &p->drive.time_function);
    case 4: return dmb_model_add_pipes(p->model, &p->pipe[0], 5, &p->load.place.part); /* makes the string */
    case 5: return dmb_model_add_pipes(p->model, &p->pipe[1], 5, NULL);
    case 6: return dmb_model_add_pipes(p->model, &p->pipe[2], 2, NULL);
    case 7: return dmb_model_add_string(p->model, &p->string, &p->pipe[1].string);
    case 8: return dmb_model_add_pipes(p->model, &p->pipe[1], 3, NULL);
    case 9: return dmb_model_add_body(p->model, &p->head, NULL);
    case 10: return dmb_model_add_bit(p->model, &p->bit, NULL);
    case 11: return dmb_model_add_drive(p->model, &p->drive, NULL);
    case 12: return dmb_model_add_load(p->model, &p->load, NULL);
    case 13: /* from a pipe of the first string, past those on the curved axis, to one of the second */
        p->joint.place_a = dmb_station(p->load.place.part, 6, 1.0);
        p->joint.place_b = dmb_station(p->pipe[1].string, 1, 0.0);
        return dmb_model_add_joint(p->model, &p->joint, &p->coupling.joint[0]);
    case 14:
        p->hinge.place_b = dmb_station(p->pipe[1].string, 2, 1.0);
        return dmb_model_add_joint(p->model, &p->hinge, &p->coupling.joint[1]);
    case 15: return dmb_model_add_coupling(p->model, &p->coupling, NULL);
    case 16:
        p->constraint.place[0] = dmb_station(p->load.place.part, 8, 1.0);
        return dmb_model_add_constraint(p->model, &p->constraint, NULL);
    case 17:
        p->screw.part = p->coupling.joint[0];
        p->screw.time_function = p->drive.time_function;
        return dmb_model_add_drive(p->model, &p->screw, NULL);
    case 18: return dmb_model_add_ramp(p->model, 0.0, 1.0, 0.0, 1.0, NULL);
    default: return dmb_model_compile(p->model, NULL);
    }
}
enum { STEPS = 20 };

/* Counts that must not change when a call fails. */
typedef struct counts {
    uint32_t time_functions, strings, runs, bodies, bits, drives, loads, joints, couplings, constraints, wall;
    int compiled;
    long blocks;
} counts;

static counts counts_of(const dmb_model *model, const meter *m)
{
    counts c;
    memset(&c, 0, sizeof c);
    c.blocks = m->blocks;
    if (model == NULL) return c;
    c.time_functions = model->time_functions.count;
    c.strings = model->strings.count;
    c.runs = model->runs.count;
    c.bodies = model->bodies.count;
    c.bits = model->bits.count;
    c.drives = model->drives.count;
    c.loads = model->loads.count;
    c.joints = model->joints.count;
    c.couplings = model->couplings.count;
    c.constraints = model->constraints.count;
    c.wall = model->wall_count;
    c.compiled = model->scene != NULL;
    return c;
}

/* Blocks may move and lists may keep larger room, so only what the user sees is compared, and blocks may grow by the
 * room of a list. */
static void expect_unchanged(const counts *before, const counts *after, int which)
{
    const long grown = after->blocks - before->blocks;
    assert_int_equal(before->time_functions, after->time_functions);
    assert_int_equal(before->strings, after->strings);
    assert_int_equal(before->runs, after->runs);
    assert_int_equal(before->bodies, after->bodies);
    assert_int_equal(before->bits, after->bits);
    assert_int_equal(before->drives, after->drives);
    assert_int_equal(before->loads, after->loads);
    assert_int_equal(before->joints, after->joints);
    assert_int_equal(before->couplings, after->couplings);
    assert_int_equal(before->constraints, after->constraints);
    assert_int_equal(before->wall, after->wall);
    assert_int_equal(before->compiled, after->compiled);
    assert_true(grown >= 0 && grown <= (which == 4 ? 1 : 0)); /* the room for the string that was to be made */
}

static void run_step(scene_plan *p, const meter *m, int which)
{
    const counts before = counts_of(p->model, m);
    int32_t status = step(p, which);
    if (m->failed && status == DMB_ERR_NO_MEMORY) {
        const counts after = counts_of(p->model, m);
        expect_unchanged(&before, &after, which);
        if (which > 0) assert_non_null(strstr(dmb_model_message(p->model), dmb_status_text(DMB_ERR_NO_MEMORY)));
        if (which == 0) assert_null(p->model);
        status = step(p, which);
    }
    if (status != DMB_OK) print_error("step %d: %s %s\n", which, dmb_status_name(status), dmb_model_message(p->model));
    assert_int_equal(status, DMB_OK);
}

/* Returns whether an allocation was there to fail. */
static int run(long failing, long *compiled_bytes)
{
    meter m = {failing, 0, 0, 0};
    dmb_allocator allocator = dmb_allocator_default();
    allocator.context = &m;
    allocator.allocate = take;
    allocator.release = give;
    scene_plan p = plan(&allocator);
    for (int i = 0; i < STEPS; ++i) run_step(&p, &m, i);
    assert_int_equal(p.model->scene->cluster_count, 2);
    *compiled_bytes = (long)(p.model->scene->bytes + p.model->scene->pattern.block_size);
    dmb_model_destroy(&p.model);
    assert_int_equal(m.blocks, 0);
    assert_int_equal(m.bytes, 0);
    return m.failed;
}

static void every_allocation_fails_once(void **state)
{
    long bytes, first_bytes, k = 0;
    (void)state;
    (void)run(-1, &first_bytes);
    while (run(k, &bytes)) {
        assert_int_equal(bytes, first_bytes); /* the same scene, whatever happened on the way */
        ++k;
    }
    assert_true(k > 30);
}

/* ---- A body in a string, which one call describes as four parts ------------------------------------------------- */

/* Returns whether an allocation was there to fail; *bytes: size of the scene. */
static int run_sub(long failing, size_t *bytes)
{
    meter m = {-1, 0, 0, 0};
    dmb_allocator allocator = dmb_allocator_default();
    dmb_model_options options = dmb_model_options_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_sub_def def = dmb_sub_def_default();
    dmb_sub made = dmb_sub_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_model *model = NULL;
    allocator.context = &m;
    allocator.allocate = take;
    allocator.release = give;
    options.allocator = &allocator;
    def.length = 0.5;
    assert_int_equal(dmb_model_create(&options, &model), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 2, NULL), DMB_OK);
    const counts before = counts_of(model, &m);
    m.until_failure = failing;
    int32_t status = dmb_model_place_at_end(model, (dmb_id){0, 0}, 0.0, &body, NULL);
    if (status >= 0) status = dmb_model_add_sub(model, &def, &made);
    if (m.failed) {
        assert_int_equal(status, DMB_ERR_NO_MEMORY);
        assert_non_null(strstr(dmb_model_message(model), dmb_status_text(DMB_ERR_NO_MEMORY)));
        const counts after = counts_of(model, &m);
        assert_int_equal(before.strings, after.strings);
        assert_int_equal(before.bodies, after.bodies);
        assert_int_equal(before.joints, after.joints);
        assert_int_equal(dmb_model_add_sub(model, &def, &made), DMB_OK);
    }
    m.until_failure = -1;
    pipe.string = made.section;
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 2, NULL), DMB_OK);
    assert_int_equal(dmb_model_compile(model, NULL), DMB_OK);
    *bytes = model->scene->bytes;
    dmb_model_destroy(&model);
    assert_int_equal(m.blocks, 0);
    return m.failed;
}

static void sub_fails_as_a_whole(void **state)
{
    size_t bytes, first;
    long k = 0;
    (void)state;
    (void)run_sub(-1, &first);
    for (; run_sub(k, &bytes); k++) assert_int_equal(bytes, first);
    assert_true(k >= 3);
}

/* ---- A model from its record ------------------------------------------------------------------------------------- */

/* Returns whether an allocation was there to fail. */
static int run_read(long failing, const unsigned char *bytes, size_t size)
{
    meter m = {failing, 0, 0, 0};
    dmb_allocator allocator = dmb_allocator_default();
    dmb_model_options options = dmb_model_options_default();
    dmb_model *model = NULL;
    allocator.context = &m;
    allocator.allocate = take;
    allocator.release = give;
    options.allocator = &allocator;
    const int32_t status = dmb_model_read(bytes, size, &options, &model);
    assert_int_equal(status, m.failed ? DMB_ERR_NO_MEMORY : DMB_OK);
    assert_int_equal(model == NULL, m.failed);
    dmb_model_destroy(&model);
    assert_int_equal(m.blocks, 0);
    return m.failed;
}

static void record_is_read_as_a_whole(void **state)
{
    dmb_model *model = NULL;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_segment table = dmb_segment_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    unsigned char bytes[8192];
    size_t size;
    long k = 0;
    (void)state;
    wall.survey = survey;
    wall.survey_count = 3;
    table.kind = DMB_SEGMENT_TABLE;
    table.table_time = table_time;
    table.table_value = table_value;
    table.table_count = 3;
    assert_int_equal(dmb_model_create(NULL, &model), DMB_OK);
    assert_int_equal(dmb_model_add_wall(model, &wall, NULL), DMB_OK);
    assert_int_equal(dmb_model_add_time_function(model, &table, 1, NULL), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 2, NULL), DMB_OK);
    assert_int_equal(dmb_model_write(model, bytes, sizeof bytes, &size), DMB_OK);
    dmb_model_destroy(&model);
    while (run_read(k, bytes, size)) ++k;
    assert_true(k >= 7); /* model, reader, its numbers, survey, time function, string, pipes */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_allocation_fails_once),
                                       cmocka_unit_test(sub_fails_as_a_whole),
                                       cmocka_unit_test(record_is_read_as_a_whole)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
