/* Contact, drives, bit, statistics and the recorder's outputs, in a string that lies in its hole and is driven. */
#include <string.h>

#include "close.h"
#include "rig.h"

/* Steps that may be divided. */
static void run(const rig *s, int steps)
{
    for (int i = 0; i < steps; i++) must(s, dmb_sim_step(s->sim, 1e-3, NULL));
}

typedef struct hole_rig {
    rig s;
    dmb_id string, bit, feed, torque;
} hole_rig;

/* Ten pipes of S1; feed by speed, torque by load where the rig end may turn; a bit off bottom under a bit load. */
static hole_rig make(int32_t kind, int32_t start_free)
{
    const dmb_segment ramp = {.struct_size = sizeof ramp, .kind = DMB_SEGMENT_STEP, .x1 = 0.02, .h1 = 0.1};
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_string_def string = dmb_string_def_default();
    hole_rig r = {.torque = {0, 0}};
    rig_open(&r.s, 0.0, 0.0, -9.81);
    add_wall(&r.s, &wall);
    string.start_free = start_free;
    add_string(&r.s, &string);
    pipe.kind = kind;
    r.string = add_pipes(&r.s, &pipe, 10);
    bit.load = add_constant(&r.s, 250.0);
    bit.bottom = 0.5;
    bit.rock_law = DMB_ROCK_RATE;
    must_model(&r.s, dmb_model_add_bit(r.s.model, &bit, &r.bit));
    r.feed = add_simple_drive(&r.s, DMB_DRIVE_MOTION, r.string, DMB_X, add_time_function(&r.s, &ramp, 1));
    if (start_free == DMB_FREE_CYLINDRICAL)
        r.torque = add_simple_drive(&r.s, DMB_DRIVE_LOAD, r.string, DMB_RX, add_constant(&r.s, 40.0));
    rig_start(&r.s, NULL);
    return r;
}

/* At rest the wall carries the weight, downwards; what the sites say adds up to what the sum says. */
static void contact_at_rest(void **state)
{
    (void)state;
    const s1_section v = s1_values();
    hole_rig r = make(DMB_PIPE_FLEXIBLE, DMB_FREE_X);
    dmb_model_info info = dmb_model_info_default();
    find_equilibrium(&r.s, NULL);
    dmb_contact_total sum = contacts_of(&r.s);
    double total = 0.0, deepest = 0.0, length = 0.0, reaction[6];
    uint32_t closed = 0;
    must_model(&r.s, dmb_model_get_info(r.s.model, &info));
    must(&r.s, dmb_query_reaction(r.s.sim, r.string, reaction));
    for (uint32_t i = 0; i < info.contact_points; i++) {
        dmb_contact contact = dmb_contact_default();
        must(&r.s, dmb_query_contact(r.s.sim, i, &contact));
        if (contact.part.index == r.string.index) length += contact.length;
        if (!contact.closed) {
            assert_true(contact.gap >= 0.0);
            CHECK_CLOSE(contact.normal_force, 0.0, 0.0);
            continue;
        }
        closed++;
        total += contact.normal_force;
        deepest = fmax(deepest, -contact.gap);
        assert_true(contact.gap < 0.0);
        CHECK_CLOSE(contact.normal[2], -1.0, 1e-6);
        CHECK_CLOSE(contact.normal_force, 1e7 * contact.length * -contact.gap, 1e-6 * contact.normal_force);
        CHECK_CLOSE(contact.approach, 0.0, 1e-12);
    }
    assert_int_equal(sum.closed, closed);
    assert_true(closed > 2);
    CHECK_CLOSE(sum.normal_force, total, 1e-9);
    CHECK_CLOSE(sum.deepest, deepest, 1e-15);
    CHECK_CLOSE(total, 15.0 * v.weight + 5.0 * 9.81 - reaction[2], 1e-4);
    CHECK_CLOSE(length, 15.0 - 0.75, 1e-12); /* the guided rig end cannot reach the wall */
    rig_close(&r.s);
}

/* Friction and slip of a sliding string: along the hole against the feed, around it against the spin. */
static void friction_of_a_sliding_string(void **state)
{
    (void)state;
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_AXIAL_TORSIONAL; kind++) {
        hole_rig r = make(kind, DMB_FREE_CYLINDRICAL);
        run(&r.s, 60);
        const dmb_contact_total sum = contacts_of(&r.s);
        dmb_model_info info = dmb_model_info_default();
        double around = 0.0, along = 0.0;
        must_model(&r.s, dmb_model_get_info(r.s.model, &info));
        for (uint32_t i = 0; i < info.contact_points; i++) {
            dmb_contact contact = dmb_contact_default();
            must(&r.s, dmb_query_contact(r.s.sim, i, &contact));
            along += contact.friction[0];
            around += contact.friction[1];
            if (contact.closed)
                assert_true(contact.friction[0] * contact.slip[0] + contact.friction[1] * contact.slip[1] <= 0.0);
        }
        CHECK_CLOSE(sum.friction[0], along, 1e-9);
        CHECK_CLOSE(sum.friction[1], around, 1e-9);
        assert_true(along < -1.0);
        assert_true(hypot(along, around) < 0.36 * sum.normal_force);
        rig_close(&r.s);
    }
}

static void drives(void **state)
{
    (void)state;
    hole_rig r = make(DMB_PIPE_FLEXIBLE, DMB_FREE_CYLINDRICAL);
    dmb_drive_state feed = dmb_drive_state_default(), torque = dmb_drive_state_default();
    double reaction[6], spin;
    run(&r.s, 50);
    must(&r.s, dmb_query_drive(r.s.sim, r.feed, &feed));
    must(&r.s, dmb_query_drive(r.s.sim, r.torque, &torque));
    must(&r.s, dmb_query_reaction(r.s.sim, r.string, reaction));
    const dmb_energy energy = energy_of(&r.s);
    const dmb_motion motion = motion_at(&r.s, dmb_station(r.string, 0, 0.0), DMB_FRAME_BODY);
    spin = motion.velocity[3];
    CHECK_CLOSE(feed.target, 0.1, 1e-15);
    CHECK_CLOSE(feed.speed, 0.1, 1e-15);
    CHECK_CLOSE(feed.position, 0.1 * 0.04, 1e-14); /* ramp of 0.02 s covers half of its length */
    CHECK_CLOSE(feed.force, reaction[0], 1e-9);
    CHECK_CLOSE(feed.power, feed.force * 0.1, 1e-9);
    CHECK_CLOSE(torque.target, 40.0, 1e-14);
    CHECK_CLOSE(torque.force, 40.0, 1e-14);
    CHECK_CLOSE(torque.speed, spin, 1e-14);
    CHECK_CLOSE(torque.position, rotation_at(&r.s, dmb_station(r.string, 0, 0.0)), 1e-9);
    CHECK_CLOSE(reaction[3], 0.0, 0.0); /* free to turn */
    CHECK_CLOSE(feed.work + torque.work, energy.drives, 1e-9 * energy.input);
    rig_close(&r.s);
}

static void bit_and_statistics(void **state)
{
    (void)state;
    hole_rig r = make(DMB_PIPE_FLEXIBLE, DMB_FREE_CYLINDRICAL);
    dmb_bit_state bit = dmb_bit_state_default();
    const dmb_statistics before = statistics_of(&r.s);
    dmb_model_info info = dmb_model_info_default();
    run(&r.s, 30);
    must(&r.s, dmb_query_bit(r.s.sim, r.bit, &bit));
    const dmb_statistics after = statistics_of(&r.s);
    must_model(&r.s, dmb_model_get_info(r.s.model, &info));
    assert_int_equal(bit.on_bottom, 0);
    CHECK_CLOSE(bit.load, 250.0, 0.0);
    CHECK_CLOSE(bit.weight, 0.0, 0.0);
    CHECK_CLOSE(bit.bottom, 0.5, 1e-3);
    const dmb_pose pose = pose_at(&r.s, dmb_station(r.bit, 0, 0.0));
    CHECK_CLOSE(bit.advance, pose.displacement[0], 1e-9);
    assert_true(after.steps - before.steps >= 30); /* divided steps count as what they are */
    assert_true(after.iterations > before.iterations && after.most_iterations > 0);
    assert_int_equal(after.bytes, info.sim_bytes);
    rig_close(&r.s);
}

/* Every output is the number its query gives. */
static void outputs(void **state)
{
    (void)state;
    hole_rig r = make(DMB_PIPE_FLEXIBLE, DMB_FREE_CYLINDRICAL);
    dmb_output asked[(DMB_OUTPUT_ENERGY_ERROR + 1)];
    dmb_recorder recorder = dmb_recorder_default();
    dmb_section section = dmb_section_default();
    dmb_drive_state drive = dmb_drive_state_default();
    dmb_bit_state bit = dmb_bit_state_default();
    double row[1 + (DMB_OUTPUT_ENERGY_ERROR + 1)], kinetic, normal = (double)NAN;
    const dmb_place place = dmb_station(r.string, 2, 0.3);
    run(&r.s, 30);
    for (int32_t i = 0; i < (DMB_OUTPUT_ENERGY_ERROR + 1); i++) {
        asked[i].place = place;
        if (i == DMB_OUTPUT_DRIVE_FORCE || i == DMB_OUTPUT_DRIVE_SPEED) asked[i].place.part = r.feed;
        if (i == DMB_OUTPUT_BIT_WEIGHT) asked[i].place.part = r.bit;
        asked[i].quantity = i;
        asked[i].reserved = 0;
    }
    recorder.output_count = (DMB_OUTPUT_ENERGY_ERROR + 1);
    recorder.outputs = asked;
    recorder.table = row;
    recorder.capacity = 1;
    assert_int_equal(dmb_recorder_take(&recorder, r.s.sim), DMB_OK);
    const dmb_pose pose = pose_at(&r.s, place);
    const dmb_motion world = motion_at(&r.s, place, DMB_FRAME_WORLD), body = motion_at(&r.s, place, DMB_FRAME_BODY);
    must(&r.s, dmb_query_section(r.s.sim, place, &section));
    must(&r.s, dmb_query_drive(r.s.sim, r.feed, &drive));
    must(&r.s, dmb_query_bit(r.s.sim, r.bit, &bit));
    must(&r.s, dmb_query_kinetic_energy(r.s.sim, r.string, 2, &kinetic));
    for (uint32_t i = 0;; i++) {
        dmb_contact contact = dmb_contact_default();
        must(&r.s, dmb_query_contact(r.s.sim, i, &contact));
        if (contact.part.index != r.string.index || contact.pipe != 2) continue;
        normal = contact.normal_force;
        break;
    }
    const double want[1 + (DMB_OUTPUT_ENERGY_ERROR + 1)] = {dmb_sim_time(r.s.sim),
                                                            pose.displacement[0],
                                                            pose.displacement[1],
                                                            pose.displacement[2],
                                                            world.velocity[0],
                                                            world.velocity[1],
                                                            world.velocity[2],
                                                            pose.position[0],
                                                            pose.position[1],
                                                            pose.position[2],
                                                            rotation_at(&r.s, place),
                                                            body.velocity[3],
                                                            section.force[0],
                                                            section.force[3],
                                                            hypot(section.force[4], section.force[5]),
                                                            kinetic,
                                                            normal,
                                                            drive.force,
                                                            drive.speed,
                                                            bit.weight + bit.load,
                                                            energy_of(&r.s).error};
    for (int i = 0; i <= (DMB_OUTPUT_ENERGY_ERROR + 1); i++) CHECK_CLOSE(row[i], want[i], 0.0);
    rig_close(&r.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contact_at_rest), cmocka_unit_test(friction_of_a_sliding_string),
        cmocka_unit_test(drives),          cmocka_unit_test(bit_and_statistics),
        cmocka_unit_test(outputs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
