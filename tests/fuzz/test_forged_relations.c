/* Fields of a snapshot that are each in their range and contradict each other, with the checksum made to fit. Those
 * that later calls rely on are refused, with the field in the message, and nothing changes. Those that they do not rely
 * on are taken, and then a step ends on the constraints, as if nothing had been forged, or is refused
 * (run/snapshot_relations.c has the list). And states that a run reaches are taken as they are. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "forging.h"
#include "system/constrain/constrain.h"

/* ---- Refused: rotations ------------------------------------------------------------------------------------------ */

static void rotations_are_rotations(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_STRING);
    for (size_t i = 0; i < 4; i++) put(&s, "quaternion", 4 + i, 0.0);
    refused(&s, "quaternion");
    put(&s, "quaternion", 0, 1.001 * got(&s, "quaternion", 0) + 0.001);
    refused(&s, "quaternion");
    for (size_t i = 0; i < 3; i++) put(&s, "site_normal", 3 + i, 0.0);
    refused(&s, "site_normal");
    for (size_t i = 0; i < 9; i++) put(&s, "stuck_anchor", i, 0.0);
    refused(&s, "stuck_anchor");
    for (size_t i = 0; i < 9; i++) put(&s, "stuck_anchor", i, -got(&s, "stuck_anchor", i)); /* a reflection */
    refused(&s, "stuck_anchor");
    close_subject(&s);
    s = open_subject(SAVED_JOINTS);
    put(&s, "joint_lock", 4, got(&s, "joint_lock", 4) + 0.01);
    refused(&s, "joint_lock");
    close_subject(&s);
}

/* ---- Refused: what is held moves --------------------------------------------------------------------------------- */

/* A body that only slides, and one that hangs on it by a joint. */
static subject open_supportd(void)
{
    dmb_body_def slide = dmb_body_def_default();
    subject s = {.sim = NULL};
    dmb_id supportd;
    SAVED_MUST(&s.scene, dmb_model_create(NULL, &s.scene.model));
    slide.free_mask = DMB_FREE_X | DMB_FREE_RX;
    SAVED_MUST(&s.scene, dmb_model_add_body(s.scene.model, &slide, &supportd));
    const dmb_id hanging = saved_body(&s.scene, 0.0, 0.3);
    dmb_joint_def joint = saved_joint(DMB_JOINT_REVOLUTE, supportd, hanging);
    (void)saved_add_joint(&s.scene, &joint);
    SAVED_MUST(&s.scene, dmb_model_compile(s.scene.model, NULL));
    s.sim = saved_sim(&s.scene);
    saved_run(&s.scene, s.sim);
    take(&s);
    return s;
}

static uint32_t held_column(const dmb_scene *scene)
{
    const dmb_cluster *cluster = scene->clusters;
    uint32_t i = 0;
    while (i < cluster->columns && scene->solved_row[scene->cluster_columns[cluster->column + i]]) i++;
    assert_true(i < cluster->columns);
    return i;
}

static void held_rows_stand_still(void **state)
{
    (void)state;
    subject s = open_supportd();
    const uint32_t row = dmb_constrained_row(s.sim->scene, 0);
    put(&s, "velocity", row, 0.1);
    refused(&s, "velocity");
    put(&s, "acceleration", row, -1.0);
    refused(&s, "acceleration");
    put(&s, "pseudo_acceleration", row, 1e-3);
    refused(&s, "pseudo_acceleration");
    const uint32_t column = held_column(s.sim->scene);
    for (uint32_t i = 0; i < s.sim->scene->clusters[0].columns; i++)
        if (got_word(&s, "partition_column", i) == column)
            put_word(&s, "partition_column", i, got_word(&s, "partition_column", 0));
    put_word(&s, "partition_column", 0, column);
    refused(&s, "partition_column");
    close_subject(&s);
}

static void qualities_are_parts(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_SPARSE);
    put(&s, "partition_quality", 0, 2.0);
    refused(&s, "partition_quality");
    put(&s, "partition_quality", 1, -0.5);
    refused(&s, "partition_quality");
    close_subject(&s);
}

/* ---- Refused: times ---------------------------------------------------------------------------------------------- */

static void clocks_are_consistent(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_STRING);
    const double now = s.sim->clock->time;
    put(&s, "clock", 1, 1e-9);
    refused(&s, "clock");
    put(&s, "clock", 2, 2.0 * now);
    refused(&s, "clock");
    put(&s, "clock", 2, -now);
    refused(&s, "clock");
    put(&s, "clock", 3, 2.0 * now);
    refused(&s, "clock");
    put(&s, "clock", 4, 1e-12);
    refused(&s, "clock");
    put(&s, "clock", 4, 1e9);
    refused(&s, "clock");
    close_subject(&s);
}

static void memory_is_of_the_past(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_STRING);
    const double now = s.sim->clock->time;
    const size_t newest = DMB_DELAY_SAMPLES - 1;
    put(&s, "delay_line", newest, now + 1.0);
    refused(&s, "delay_line");
    put(&s, "delay_line", newest - 1, now + 1.0);
    refused(&s, "delay_line");
    put(&s, "delay_line", newest, 0.5 * got(&s, "delay_line", newest - 1));
    refused(&s, "delay_line");
    put(&s, "input_begin", 0, now + 1.0);
    refused(&s, "input_begin");
    put(&s, "input_begin", 3, -1.0);
    refused(&s, "input_begin");
    put(&s, "event_since", 1, now + 1.0);
    refused(&s, "event_since");
    put(&s, "clock", 0, 0.25 * now);
    assert_int_equal(restore(&s), DMB_ERR_VALUE);
    close_subject(&s);
}

/* ---- Refused: settings and marks --------------------------------------------------------------------------------- */

static uint32_t input_of(const dmb_sim *sim, int32_t target)
{
    uint32_t i = 0;
    while (i < sim->scene->input_count && sim->scene->inputs[i].target != target) i++;
    assert_true(i < sim->scene->input_count);
    return i;
}

static void settings_fit(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_STRING);
    put(&s, "drive_input", 0, 1.0);
    refused(&s, "drive_input");
    put(&s, "drive_input", 1, 1.0);
    refused(&s, "drive_input");
    put(&s, "input_value", input_of(s.sim, DMB_TARGET_LIMIT_HIGH), -3001.0);
    refused(&s, "input_value");
    put_word(&s, "stuck_held", 0, 1u - got_word(&s, "stuck_held", 0));
    refused(&s, "stuck_held");
    put(&s, "event_side", 0, 0.5);
    refused(&s, "event_side");
    put_word(&s, "reuse", 2, 32);
    refused(&s, "reuse");
    put_word(&s, "prediction", 2, 32);
    refused(&s, "prediction");
    close_subject(&s);
}

/* The last joint leads a body along the hole. */
static void joints_are_held_where_they_are_locked(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_JOINTS);
    const uint32_t led = s.sim->scene->joint_count - 1;
    put_word(&s, "joint_segment", led, got_word(&s, "joint_segment", led) | DMB_SEGMENT_HELD);
    refused(&s, "joint_segment");
    put_word(&s, "joint_segment", 0, DMB_SEGMENT_HELD);
    refused(&s, "joint_segment");
    put_word(&s, "joint_state", led, DMB_JOINT_LOCKED);
    refused(&s, "joint_segment");
    close_subject(&s);
}

static void histories_increase(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_STRING);
    put_word(&s, "history_head", 0, 5);
    refused(&s, "history_head");
    put_word(&s, "history_head", 1, 6);
    refused(&s, "history_head");
    put_word(&s, "history_head", 0, 1);
    put_word(&s, "history_head", 1, 2);
    put(&s, "history_angle", 1, got(&s, "history_angle", 0));
    refused(&s, "history_angle");
    put_word(&s, "history_head", 0, 1); /* the ring is full: the oldest is sample 2 */
    put_word(&s, "history_head", 1, 64);
    for (size_t i = 0; i < 64; i++) put(&s, "history_angle", i, 0.01 * (double)i);
    refused(&s, "history_angle");
    close_subject(&s);
}

static void cutters_leave_no_more_than_their_size(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_SIDEWAYS);
    put(&s, "hole_widening", 3, -1e-3);
    refused(&s, "hole_widening");
    put(&s, "hole_widening", 0, 0.5);
    refused(&s, "hole_widening");
    close_subject(&s);
}

/* ---- Taken, and harmless ----------------------------------------------------------------------------------------- */

static void contacts_that_are_not_there(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_STRING);
    static const double told[] = {1e-3, -1e-3, 1.0, 0.0};
    for (size_t k = 0; k < sizeof told / sizeof told[0]; k++) {
        for (uint32_t i = 0; i < s.sim->scene->site_count; i++) {
            put(&s, "site_penetration", i, told[k]);
            put(&s, "site_impact_speed", i, -told[k]);
            put(&s, "site_depth", i, 100.0 * told[k]);
            put_word(&s, "site_segment", i, s.sim->scene->hole.stations - 1);
            put_word(&s, "site_sticks", i, (uint32_t)k & 1u);
        }
        assert_true(harmless(&s, "contacts") > 0);
    }
    close_subject(&s);
}

static void parts_that_are_apart(void **state)
{
    (void)state;
    static const double moves[] = {1e-9, 1e-4, 0.1, 10.0};
    for (int which = SAVED_JOINTS; which <= SAVED_SPARSE; which++) {
        subject s = open_subject(which);
        int ended = 0;
        for (uint32_t i = 0; i < 3 * s.sim->scene->node_count; i++)
            for (size_t k = 0; k < sizeof moves / sizeof moves[0]; k++) {
                put(&s, "displacement", i, got(&s, "displacement", i) + moves[k]);
                ended += harmless(&s, "displacement");
                put(&s, "velocity", 2 * i, moves[k]);
                ended += harmless(&s, "velocity");
            }
        for (uint32_t r = 0; r < s.sim->scene->constraint_row_count; r++) {
            put(&s, "constraint_offset", r, 0.1);
            put(&s, "multiplier", r, 1e9);
            ended += harmless(&s, "constraint_offset");
        }
        print_message("    %d steps ended\n", ended);
        assert_true(ended > 0);
        close_subject(&s);
    }
}

/* Each joint active, locked or open whatever the partition says. */
static void joints_in_other_states(void **state)
{
    (void)state;
    for (int which = SAVED_JOINTS; which <= SAVED_SPARSE; which++) {
        subject s = open_subject(which);
        int ended = 0;
        for (uint32_t j = 0; j < s.sim->scene->joint_count; j++)
            for (uint32_t k = 0; k <= DMB_JOINT_OPEN; k++) {
                const uint32_t segment = got_word(&s, "joint_segment", j) & ~DMB_SEGMENT_HELD;
                const int on_hole = s.sim->scene->joints[j].kind == DMB_JOINT_POINT_ON_HOLE;
                put_word(&s, "joint_state", j, k);
                put_word(&s, "joint_segment", j,
                         on_hole && k == DMB_JOINT_LOCKED ? segment | DMB_SEGMENT_HELD : segment);
                ended += harmless(&s, "joint_state");
            }
        print_message("    %d steps ended\n", ended);
        assert_true(ended > 0);
        close_subject(&s);
    }
}

/* Orders turned round, so that other columns depend, and ranks from 0 to all rows. */
static void turn_order(const subject *s, const char *name, uint32_t first, uint32_t count)
{
    for (uint32_t i = 0; i < count / 2; i++) {
        const uint32_t a = got_word(s, name, first + i), b = got_word(s, name, first + count - 1 - i);
        put_word(s, name, first + i, b);
        put_word(s, name, first + count - 1 - i, a);
    }
}

static void partitions_that_are_singular(void **state)
{
    (void)state;
    for (int which = SAVED_JOINTS; which <= SAVED_SPARSE; which++) {
        subject s = open_subject(which);
        int ended = 0;
        for (uint32_t k = 0; k < s.sim->scene->cluster_count; k++) {
            const dmb_cluster *cluster = s.sim->scene->clusters + k;
            const uint32_t most = cluster->rows < cluster->columns ? cluster->rows : cluster->columns;
            for (uint32_t rank = 0; rank <= most; rank++)
                for (int how = 0; how < 4; how++) {
                    put_word(&s, "partition_rank", k, rank);
                    if (how & 1) turn_order(&s, "partition_row", cluster->row, cluster->rows);
                    if (how & 2) turn_order(&s, "partition_column", cluster->column, cluster->columns);
                    ended += harmless(&s, "partition");
                }
        }
        print_message("    %d steps ended\n", ended);
        assert_true(ended > 0);
        close_subject(&s);
    }
}

/* ---- Of a run ---------------------------------------------------------------------------------------------------- */

static void own(subject *s)
{
    assert_int_equal(dmb_sim_snapshot(s->sim, s->forged, s->size), DMB_OK);
    if (dmb_sim_restore(s->sim, s->forged, s->size) < 0) fail_msg("%s", dmb_sim_message(s->sim));
}

static void states_of_a_run_are_taken(void **state)
{
    (void)state;
    subject s = open_subject(SAVED_JOINTS);
    int switched = 0;
    for (uint32_t j = 0; j < s.sim->scene->joint_count; j++)
        for (int32_t k = DMB_JOINT_OPEN; k >= DMB_JOINT_ACTIVE; k--) {
            const dmb_id joint = {(uint32_t)DMB_PART_JOINT << DMB_KIND_SHIFT | j, s.scene.turning.generation};
            if (dmb_sim_set_joint(s.sim, joint, k) < 0) continue;
            own(&s);
            if (dmb_sim_step(s.sim, 1e-4, NULL) >= 0) own(&s);
            switched++;
        }
    assert_true(switched > 10);
    close_subject(&s);
    s = open_supportd();
    for (int i = 0; i < 20; i++) {
        assert_true(dmb_sim_advance(s.sim, dmb_sim_time(s.sim) + 3.3e-3, NULL) >= 0);
        own(&s);
    }
    close_subject(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotations_are_rotations),
        cmocka_unit_test(held_rows_stand_still),
        cmocka_unit_test(qualities_are_parts),
        cmocka_unit_test(clocks_are_consistent),
        cmocka_unit_test(memory_is_of_the_past),
        cmocka_unit_test(settings_fit),
        cmocka_unit_test(joints_are_held_where_they_are_locked),
        cmocka_unit_test(histories_increase),
        cmocka_unit_test(cutters_leave_no_more_than_their_size),
        cmocka_unit_test(contacts_that_are_not_there),
        cmocka_unit_test(parts_that_are_apart),
        cmocka_unit_test(joints_in_other_states),
        cmocka_unit_test(partitions_that_are_singular),
        cmocka_unit_test(states_of_a_run_are_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
