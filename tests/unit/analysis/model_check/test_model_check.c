/* The model check as a call: it changes nothing, not even work fields; every failed allocation is told; text buffers of
 * any size; NULL and dead handles; callbacks that fail; names of joints and rows. */
#include <stdlib.h>
#include <string.h>

#include "constraint/joint.h"
#include "rig.h"
#include "sim/sim.h"
#include "system/constrain/constrain.h"

/* ---- Allocator that counts and fails ----------------------------------------------------------------------------- */

typedef struct meter {
    int64_t live, calls, fail_at; /* the call that fails, from 0; < 0: none */
} meter;

static void *take(void *context, size_t size, size_t alignment)
{
    meter *m = context;
    if (m->calls++ == m->fail_at) return NULL;
    void *block = aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (block != NULL) m->live += (int64_t)size;
    return block;
}

static void give(void *context, void *block, size_t size, size_t alignment)
{
    meter *m = context;
    (void)alignment;
    m->live -= (int64_t)size;
    free(block);
}

/* ---- A scene with every kind of constraint ----------------------------------------------------------------------- */

static int32_t callback_status;

static int32_t on_plane(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                        double *jacobian)
{
    (void)context;
    (void)time;
    (void)count;
    value[0] = poses[0][2] - 2.0;
    value[1] = 2.0 * (poses[0][2] - 2.0);
    (void)jacobian;
    return callback_status;
}

static dmb_place at(dmb_id part)
{
    return dmb_station(part, 0, 0.0);
}

static dmb_joint_def joint_of(int32_t kind, dmb_place a, dmb_place b, const char *name)
{
    dmb_joint_def joint = joint_between(kind, a, b);
    joint.match = 1;
    strncpy(joint.name, name, sizeof joint.name - 1);
    return joint;
}

static void add_callback_of_two(rig *s, dmb_id body)
{
    dmb_constraint_def constraint = dmb_constraint_def_default();
    constraint.row_count = 2;
    constraint.place[0] = at(body);
    constraint.callback = on_plane;
    strncpy(constraint.name, "plane", sizeof constraint.name - 1);
    must_model(s, dmb_model_add_constraint(s->model, &constraint, NULL));
}

/* A string in a curved hole, a body on it by a joint on the hole, a body held twice, one on a plane, gears and drives.
 */
static void open_scene(rig *s, const dmb_sim_options *options)
{
    static const double survey[9] = {0.0, 0.5 * PI, 0.0, 3.0, 0.5 * PI - 0.05, 0.0, 30.0, 0.5 * PI - 0.3, 0.0};
    const dmb_place ground = {{0, 0}, 0, 0, 0.0};
    dmb_wall_def wall = s1_hole();
    dmb_body_def body = dmb_body_def_default();
    dmb_coupling_def coupling = dmb_coupling_def_default();
    const dmb_pipe_def pipe = s1_pipe();
    callback_status = 0;
    rig_open(s, 0.0, 0.0, -9.81);
    wall.survey = survey;
    wall.survey_count = 3;
    (void)add_wall(s, &wall);
    const dmb_id string = add_pipes(s, &pipe, 5);
    body.free_mask = DMB_FREE_ALL;
    body.position[2] = 1.0;
    const dmb_id a = add_body(s, &body);
    body.position[2] = 2.0;
    const dmb_id b = add_body(s, &body);
    dmb_joint_def joint = joint_of(DMB_JOINT_POINT_ON_HOLE, ground, dmb_station(string, 2, 1.0), "centraliser");
    joint.match = 0;
    (void)add_joint(s, &joint);
    joint = joint_of(DMB_JOINT_REVOLUTE, ground, at(a), "hinge");
    const dmb_id hinge = add_joint(s, &joint);
    joint = joint_of(DMB_JOINT_CYLINDRICAL, ground, at(a), "again");
    (void)add_joint(s, &joint);
    joint = joint_of(DMB_JOINT_PLANAR, ground, at(b), "sheet");
    const dmb_id sheet = add_joint(s, &joint);
    coupling.joint[0] = hinge;
    coupling.joint[1] = sheet;
    must_model(s, dmb_model_add_coupling(s->model, &coupling, NULL));
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, hinge, DMB_RX, add_constant(s, 0.5));
    add_callback_of_two(s, b);
    (void)rig_start(s, options);
    for (int k = 0; k < 3; k++) must(s, dmb_sim_step(s->sim, 1e-3, NULL));
}

/* ---- Const ------------------------------------------------------------------------------------------------------- */

static void nothing_is_written(void **state)
{
    rig s;
    uint64_t before = 0, after = 0;
    dmb_check_report report = dmb_check_report_default();
    char text[4096];
    (void)state;
    open_scene(&s, NULL);
    must(&s, dmb_sim_hash(s.sim, &before));
    const size_t size = s.sim->block_size;
    unsigned char *copy = malloc(size);
    assert_non_null(copy);
    memcpy(copy, s.sim->block, size);
    must(&s, dmb_analysis_check(s.sim, &report));
    must(&s, dmb_analysis_check_text(s.sim, text, sizeof text, NULL));
    print_message("%s", text);
    ((dmb_sim *)(void *)copy)->calls = s.sim->calls; /* every call counts */
    assert_memory_equal(copy, s.sim->block, size);   /* state, trial, work fields and message */
    must(&s, dmb_sim_hash(s.sim, &after));
    assert_true(before == after);
    free(copy);
    rig_close(&s);
}

/* 5 rows of the hinge twice held by 4 of "again", 2 on the hole, 3 of the sheet, a gear, a drive, 2 of the callback. */
static void counts(void **state)
{
    rig s;
    dmb_check_report r = dmb_check_report_default();
    char text[4096];
    (void)state;
    open_scene(&s, NULL);
    must(&s, dmb_analysis_check(s.sim, &r));
    assert_int_equal(r.constraint_rows, 2 + 5 + 4 + 3 + 1 + 1 + 2);
    assert_int_equal(r.redundant, 4 + 1);
    assert_int_equal(r.constraints, 1);
    assert_int_equal(r.couplings, 1);
    assert_int_equal(r.motion_drives, 1);
    assert_int_equal(r.degrees_of_freedom, 6 * 6 - 4 - 2 + 12 - 11);
    assert_int_equal((int64_t)r.degrees_of_freedom, r.gruebler + r.redundant);
    must(&s, dmb_analysis_check_text(s.sim, text, sizeof text, NULL));
    assert_non_null(strstr(text, "    constraint 0 (plane): row "));
    rig_close(&s);
}

static void as_the_partition_has_it(void **state)
{
    rig s;
    dmb_cluster_rank rank;
    uint32_t marked = 0, dropped = 0;
    (void)state;
    open_scene(&s, NULL);
    assert_int_equal(dmb_cluster_rank_make(s.sim, &rank), DMB_OK);
    assert_int_equal(rank.differing, 0);
    for (uint32_t k = 0; k < s.sim->scene->cluster_count; k++) {
        const dmb_cluster *cluster = s.sim->scene->clusters + k;
        for (uint32_t i = s.sim->partition_rank[k]; i < cluster->rows; i++)
            dropped += rank.redundant[cluster->row + s.sim->partition_row[cluster->row + i]];
    }
    for (uint32_t r = 0; r < s.sim->scene->constraint_row_count; r++) marked += rank.redundant[r];
    assert_int_equal(marked, rank.rows - rank.rank);
    assert_int_equal(dropped, marked);
    dmb_cluster_rank_release(s.sim, &rank);
    dmb_cluster_rank_release(s.sim, &rank);
    rig_close(&s);
}

/* A partition that is wrong is told, and the rows are then LAPACK's. */
static void disagreement_is_a_warning(void **state)
{
    rig s;
    dmb_check_report r = dmb_check_report_default();
    char text[4096];
    (void)state;
    open_scene(&s, NULL);
    must(&s, dmb_analysis_check(s.sim, &r));
    const uint32_t warnings = r.warnings, redundant = r.redundant;
    s.sim->partition_rank[s.sim->scene->cluster_count - 1]--;
    must(&s, dmb_analysis_check(s.sim, &r));
    assert_int_equal(r.warnings, warnings + 1);
    assert_int_equal(r.redundant, redundant);
    must(&s, dmb_analysis_check_text(s.sim, text, sizeof text, NULL));
    assert_non_null(strstr(text, "LAPACK and the partition differ in 1 cluster"));
    s.sim->partition_rank[s.sim->scene->cluster_count - 1]++;
    rig_close(&s);
}

/* ---- Failures ---------------------------------------------------------------------------------------------------- */

static void every_allocation_fails_once(void **state)
{
    meter m = {0, 0, -1};
    dmb_allocator allocator = dmb_allocator_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_check_report r = dmb_check_report_default();
    rig s;
    char text[16] = "as before";
    size_t needed = 77;
    (void)state;
    allocator.context = &m;
    allocator.allocate = take;
    allocator.release = give;
    options.allocator = &allocator;
    open_scene(&s, &options);
    const int64_t live = m.live;
    m.calls = 0;
    must(&s, dmb_analysis_check(s.sim, &r));
    const int64_t calls = m.calls;
    assert_true(calls >= 2);
    assert_int_equal(m.live, live);
    const dmb_check_report right = r;
    for (int64_t k = 0; k < calls; k++) {
        m.calls = 0;
        m.fail_at = k;
        assert_int_equal(dmb_analysis_check(s.sim, &r), DMB_ERR_NO_MEMORY);
        m.calls = 0;
        assert_int_equal(dmb_analysis_check_text(s.sim, text, sizeof text, &needed), DMB_ERR_NO_MEMORY);
        assert_int_equal(m.live, live);
        assert_memory_equal(&r, &right, sizeof r);
        assert_string_equal(text, "as before");
        assert_int_equal(needed, 77);
    }
    m.fail_at = -1;
    must(&s, dmb_analysis_check(s.sim, &r));
    rig_close(&s);
    assert_int_equal(m.live, 0);
}

static void failing_callback(void **state)
{
    dmb_check_report r = dmb_check_report_default();
    rig s;
    (void)state;
    open_scene(&s, NULL);
    callback_status = 1;
    assert_int_equal(dmb_analysis_check(s.sim, &r), DMB_ERR_CALLBACK);
    assert_int_equal(r.coordinates, 0);
    rig_close(&s);
}

static void handles_and_nulls(void **state)
{
    dmb_check_report r = dmb_check_report_default();
    uint64_t no_sim[64] = {0};
    char text[8];
    rig s;
    (void)state;
    open_scene(&s, NULL);
    assert_int_equal(dmb_analysis_check(NULL, &r), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_check(s.sim, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_check((const dmb_sim *)(const void *)no_sim, &r), DMB_ERR_HANDLE);
    assert_int_equal(dmb_analysis_check((const dmb_sim *)(const void *)s.model, &r), DMB_ERR_HANDLE);
    assert_int_equal(dmb_analysis_check_text(NULL, text, sizeof text, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_check_text(s.sim, NULL, 1, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_check_text(s.sim, NULL, 0, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_check_text((const dmb_sim *)(const void *)no_sim, text, 8, NULL), DMB_ERR_HANDLE);
    r.struct_size = 12;
    assert_int_equal(dmb_analysis_check(s.sim, &r), DMB_ERR_STRUCT_SIZE);
    assert_int_equal(r.coordinates, 0);
    rig_close(&s);
}

/* ---- Text -------------------------------------------------------------------------------------------------------- */

static void text_of_any_size(void **state)
{
    rig s;
    char whole[4096], cut[4096];
    size_t needed = 0, again = 0;
    (void)state;
    open_scene(&s, NULL);
    assert_int_equal(dmb_analysis_check_text(s.sim, NULL, 0, &needed), DMB_NOTE_FULL);
    assert_in_range(needed, 100, sizeof whole);
    must(&s, dmb_analysis_check_text(s.sim, whole, sizeof whole, NULL));
    assert_int_equal(strlen(whole) + 1, needed);
    const size_t sizes[] = {1, 2, 17, 100, needed - 1, needed, needed + 1};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        memset(cut, 'x', sizeof cut);
        const int32_t status = dmb_analysis_check_text(s.sim, cut, sizes[k], &again);
        assert_int_equal(status, sizes[k] < needed ? DMB_NOTE_FULL : DMB_OK);
        assert_int_equal(again, needed);
        const size_t length = sizes[k] < needed ? sizes[k] - 1 : needed - 1;
        assert_int_equal(strlen(cut), length);
        assert_memory_equal(cut, whole, length);
        assert_int_equal(cut[sizes[k]], 'x');
    }
    rig_close(&s);
}

static void every_row_has_a_name(void **state)
{
    (void)state;
    for (int32_t kind = 0; kind < DMB_JOINT_KINDS; kind++) {
        assert_string_not_equal(dmb_joint_kind_name(kind), "joint");
        for (uint32_t row = 0; row < 8; row++) {
            const int named = strcmp(dmb_joint_row_name(kind, row), "row") != 0;
            assert_int_equal(named, row < dmb_joint_row_count(kind));
        }
    }
    assert_string_equal(dmb_joint_kind_name(-1), "joint");
    assert_string_equal(dmb_joint_kind_name(DMB_JOINT_KINDS), "joint");
    assert_string_equal(dmb_joint_row_name(-1, 0), "row");
}

/* A turn of b about an axis of a changes the row that has its name, and leaves the other rotations. */
static void rotations_are_named_by_their_axis(void **state)
{
    static const char *const name[3] = {"rotation about x", "rotation about y", "rotation about z"};
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        const double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, p[3] = {0.0, 0.0, 0.0}, V[6] = {0.0};
        dmb_joint_rows rows;
        dmb_joint_rows_at(DMB_JOINT_FIXED, 1.0, R, p, V, &rows);
        for (uint32_t k = 3; k < 6; k++) {
            const int ours = strcmp(dmb_joint_row_name(DMB_JOINT_FIXED, k), name[axis]) == 0;
            assert_true((fabs(rows.J[k][3 + axis]) > 0.5) == ours);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_written),          cmocka_unit_test(counts),
        cmocka_unit_test(as_the_partition_has_it),     cmocka_unit_test(disagreement_is_a_warning),
        cmocka_unit_test(every_allocation_fails_once), cmocka_unit_test(failing_callback),
        cmocka_unit_test(handles_and_nulls),           cmocka_unit_test(text_of_any_size),
        cmocka_unit_test(every_row_has_a_name),        cmocka_unit_test(rotations_are_named_by_their_axis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
