/* Places, ids and drives that do not exist; numbers that are none. */
#include "sim_test.h"

static const dmb_id nothing = {0, 0};

static int32_t ask_all_places(const dmb_sim *sim, dmb_place place)
{
    dmb_pose pose = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    dmb_section section = dmb_section_default();
    double angle;
    const int32_t status = dmb_query_pose(sim, place, &pose);
    assert_int_equal(dmb_query_motion(sim, place, &motion), status);
    assert_int_equal(dmb_query_rotation(sim, place, &angle), status);
    if (status < 0) assert_int_equal(dmb_query_section(sim, place, &section), status);
    return status;
}

static void places(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig), other = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r);
    const double good[] = {0.0, 1e-300, 0.3, 1.0 - 1e-16, 1.0};
    const double outside[] = {-1e-12, 1.0 + 1e-12, -1e300, 1e300};
    const double never[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (int i = 0; i < 5; i++) assert_int_equal(ask_all_places(sim, dmb_station(r.string, 2, good[i])), DMB_OK);
    for (int i = 0; i < 4; i++)
        assert_int_equal(ask_all_places(sim, dmb_station(r.string, 2, outside[i])), DMB_ERR_VALUE);
    for (int i = 0; i < 3; i++)
        assert_int_equal(ask_all_places(sim, dmb_station(r.string, 2, never[i])), DMB_ERR_NOT_FINITE);
    assert_int_equal(ask_all_places(sim, dmb_station(r.string, 3, 0.0)), DMB_ERR_VALUE);
    assert_int_equal(ask_all_places(sim, dmb_station(r.string, UINT32_MAX, 0.0)), DMB_ERR_VALUE);
    assert_int_equal(ask_all_places(sim, dmb_station(r.head, 0, 0.0)), DMB_OK);
    assert_int_equal(ask_all_places(sim, dmb_station(r.bit, 0, 0.0)), DMB_OK);
    assert_int_equal(ask_all_places(sim, dmb_station(r.head, 1, 0.0)), DMB_ERR_VALUE);
    assert_int_equal(ask_all_places(sim, dmb_station(r.head, 0, 0.5)), DMB_ERR_VALUE);
    assert_int_equal(ask_all_places(sim, dmb_station(r.head, 0, (double)NAN)), DMB_ERR_NOT_FINITE);
    const dmb_id wrong[] = {nothing,         r.feed,       r.wall,
                            r.time_function, other.string, {r.string.index + 1, r.string.generation}};
    for (int i = 0; i < 6; i++) assert_int_equal(ask_all_places(sim, dmb_station(wrong[i], 0, 0.0)), DMB_ERR_ID);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
    dmb_model_destroy(&other.model);
}

static void parts(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig), other = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r);
    dmb_drive_state drive = dmb_drive_state_default();
    dmb_bit_state bit = dmb_bit_state_default();
    double energy = -7.0, reaction[6];
    const dmb_id wrong[] = {nothing, r.wall, other.string, other.feed, other.bit, other.head};
    for (int i = 0; i < 6; i++) {
        assert_int_equal(dmb_query_drive(sim, wrong[i], &drive), DMB_ERR_ID);
        assert_int_equal(dmb_query_bit(sim, wrong[i], &bit), DMB_ERR_ID);
        assert_int_equal(dmb_query_reaction(sim, wrong[i], reaction), DMB_ERR_ID);
        assert_int_equal(dmb_query_kinetic_energy(sim, wrong[i], 0, &energy), DMB_ERR_ID);
        assert_int_equal(dmb_sim_set_drive(sim, wrong[i], 1.0), DMB_ERR_ID);
    }
    assert_int_equal(dmb_query_kinetic_energy(sim, r.string, 3, &energy), DMB_ERR_VALUE);
    assert_int_equal(dmb_query_kinetic_energy(sim, r.head, 1, &energy), DMB_ERR_VALUE);
    assert_true(energy == -7.0);
    assert_int_equal(dmb_query_drive(sim, r.bit, &drive), DMB_ERR_ID);
    assert_int_equal(dmb_query_bit(sim, r.feed, &bit), DMB_ERR_ID);
    must(dmb_query_drive(sim, r.feed, &drive));
    must(dmb_query_bit(sim, r.bit, &bit));
    must(dmb_query_reaction(sim, r.string, reaction));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
    dmb_model_destroy(&other.model);
}

/* Sites: as many as the model says, none beyond. */
static void sites(void **state)
{
    (void)state;
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_RIGID; kind++) {
        rig_options options = plain_rig;
        dmb_model_info info = dmb_model_info_default();
        dmb_contact contact = dmb_contact_default();
        options.pipe_kind = kind;
        rig r = rig_of(&options);
        dmb_sim *sim = rig_sim(&r);
        must(dmb_model_get_info(r.model, &info));
        if (kind != DMB_PIPE_RIGID) assert_true(info.contact_points > 0); /* one guided body cannot reach the wall */
        for (uint32_t i = 0; i < info.contact_points; i++) {
            must(dmb_query_contact(sim, i, &contact));
            assert_int_equal(contact.number, i);
            assert_true(contact.part.index == r.string.index || contact.part.index == r.bit.index);
            assert_true(contact.length > 0.0);
        }
        assert_int_equal(dmb_query_contact(sim, info.contact_points, &contact), DMB_ERR_VALUE);
        assert_int_equal(dmb_query_contact(sim, UINT32_MAX, &contact), DMB_ERR_VALUE);
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&r.model);
    }
}

static void frames(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r);
    dmb_motion motion = dmb_motion_default();
    const int32_t bad[] = {DMB_FRAME_HOLE, -1, 3, INT32_MAX};
    for (int i = 0; i < 4; i++) {
        motion.frame = bad[i];
        assert_int_equal(dmb_query_motion(sim, dmb_station(r.string, 0, 0.5), &motion), DMB_ERR_VALUE);
    }
    motion.frame = DMB_FRAME_BODY;
    must(dmb_query_motion(sim, dmb_station(r.string, 0, 0.5), &motion));
    assert_int_equal(motion.frame, DMB_FRAME_BODY);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

static void set_drive(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r);
    dmb_drive_state drive = dmb_drive_state_default();
    const uint64_t before = hash_of(sim);
    assert_int_equal(dmb_sim_set_drive(sim, r.feed, 1.0), DMB_ERR_UNSUPPORTED);
    assert_int_equal(dmb_sim_set_drive(sim, r.torque, (double)INFINITY), DMB_ERR_NOT_FINITE);
    assert_non_null(strstr(dmb_sim_message(sim), "value"));
    assert_int_equal(hash_of(sim), before);
    must(dmb_sim_set_drive(sim, r.torque, 12.5));
    assert_string_equal(dmb_sim_message(sim), "");
    rig_run(sim, 1);
    must(dmb_query_drive(sim, r.torque, &drive));
    assert_true(drive.target == 12.5 && drive.force == 12.5);
    must(dmb_sim_set_drive(sim, r.torque, (double)NAN));
    rig_run(sim, 1);
    must(dmb_query_drive(sim, r.torque, &drive));
    assert_true(drive.target < 1.0);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

/* Answers that the options or the scene left out are refused, not made up. */
static void left_out(void **state)
{
    (void)state;
    rig_options options = plain_rig;
    dmb_sim_options sim_options = dmb_sim_options_default();
    dmb_section section = dmb_section_default();
    dmb_energy energy = dmb_energy_default();
    dmb_sim *sim = NULL;
    options.pipe_kind = DMB_PIPE_RIGID;
    rig r = rig_of(&options);
    sim_options.energy_ledger = 0;
    assert_true(dmb_sim_create(r.model, &sim_options, &sim) >= 0);
    assert_int_equal(dmb_query_energy(sim, &energy), DMB_ERR_UNSUPPORTED);
    assert_int_equal(dmb_query_section(sim, dmb_station(r.string, 1, 0.5), &section), DMB_ERR_UNSUPPORTED);
    assert_int_equal(dmb_query_section(sim, dmb_station(r.bit, 0, 0.0), &section), DMB_ERR_UNSUPPORTED);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

/* Recorder: one row at each multiple of the interval, a output that fails adds none, a full table says so. */
static void recorder(void **state)
{
    (void)state;
    rig r = rig_of(&plain_rig);
    dmb_sim *sim = rig_sim(&r);
    dmb_recorder recorder = dmb_recorder_default();
    dmb_output outputs[(DMB_OUTPUT_ENERGY_ERROR + 1)];
    double table[4 * (1 + (DMB_OUTPUT_ENERGY_ERROR + 1))], before[4 * (1 + (DMB_OUTPUT_ENERGY_ERROR + 1))];
    memset(table, 0, sizeof table);
    for (int32_t i = 0; i < (DMB_OUTPUT_ENERGY_ERROR + 1); i++) {
        const int is_drive = i == DMB_OUTPUT_DRIVE_FORCE || i == DMB_OUTPUT_DRIVE_SPEED;
        outputs[i].place = dmb_station(is_drive ? r.torque : i == DMB_OUTPUT_BIT_WEIGHT ? r.bit : r.string, 1, 0.25);
        outputs[i].quantity = i;
        outputs[i].reserved = 0;
    }
    recorder.output_count = (DMB_OUTPUT_ENERGY_ERROR + 1);
    recorder.outputs = outputs;
    recorder.table = table;
    recorder.capacity = 4;
    recorder.interval = 2.5e-3;
    for (int i = 0; i < 10; i++) {
        must(dmb_recorder_take(&recorder, sim));
        must(dmb_recorder_take(&recorder, sim));
        rig_run(sim, 1);
    }
    assert_int_equal(recorder.row_count, 4);
    for (int i = 0; i < 4; i++) {
        const double wanted[] = {0.0, 3e-3, 5e-3, 8e-3};
        assert_true(fabs(table[i * (1 + (DMB_OUTPUT_ENERGY_ERROR + 1))] - wanted[i]) < 1e-12);
    }
    assert_int_equal(dmb_recorder_take(&recorder, sim), DMB_NOTE_FULL);
    recorder.row_count = 2;
    outputs[(DMB_OUTPUT_ENERGY_ERROR + 1) - 1].quantity = (DMB_OUTPUT_ENERGY_ERROR + 1);
    assert_int_equal(dmb_recorder_take(&recorder, sim), DMB_ERR_VALUE);
    outputs[3].place.part = r.feed;
    assert_int_equal(dmb_recorder_take(&recorder, sim), DMB_ERR_ID);
    assert_int_equal(recorder.row_count, 2);
    recorder.struct_size = 4;
    memcpy(before, table, sizeof before);
    assert_int_equal(dmb_recorder_take(&recorder, sim), DMB_ERR_STRUCT_SIZE);
    assert_memory_equal(before, table, sizeof before);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&r.model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places),    cmocka_unit_test(parts),    cmocka_unit_test(sites),    cmocka_unit_test(frames),
        cmocka_unit_test(set_drive), cmocka_unit_test(left_out), cmocka_unit_test(recorder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
