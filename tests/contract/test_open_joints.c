/* Open joints. Active equations of a model: those of closed joints, of couplings of closed joints and of motion drives
 * on closed joints, counted by hand for each set of open joints. A joint with dampers, friction and stops that opens in
 * motion keeps no speed of an earlier step: a restored sim continues bit for bit. */
#include <stdlib.h>

#include "rig.h"

static dmb_id hinged(rig *r, double y, int open)
{
    const dmb_id ground = {0, 0};
    dmb_body_def body = dmb_body_def_default();
    body.position[1] = y;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.02;
    dmb_joint_def joint =
        joint_between(DMB_JOINT_REVOLUTE, dmb_station(ground, 0, 0.0), dmb_station(add_body(r, &body), 0, 0.0));
    joint.match = 1;
    joint.state = open ? DMB_JOINT_OPEN : DMB_JOINT_ACTIVE;
    return add_joint(r, &joint);
}

static uint32_t rows_with(int open)
{
    rig r;
    dmb_model_info info = dmb_model_info_default();
    dmb_coupling_def pair = dmb_coupling_def_default();
    rig_open(&r, 0.0, 0.0, 0.0);
    dmb_id joint[3];
    for (int i = 0; i < 3; i++) joint[i] = hinged(&r, i, open >> i & 1);
    pair.joint[0] = joint[0];
    pair.joint[1] = joint[1];
    must_model(&r, dmb_model_add_coupling(r.model, &pair, NULL));
    (void)add_simple_drive(&r, DMB_DRIVE_MOTION, joint[2], DMB_RX, add_constant(&r, 0.1));
    must_model(&r, dmb_model_compile(r.model, NULL));
    must_model(&r, dmb_model_get_info(r.model, &info));
    rig_close(&r);
    return info.constraint_rows;
}

static void only_what_holds(void **state)
{
    (void)state;
    for (int open = 0; open < 8; open++) {
        uint32_t wanted = 0;
        for (int i = 0; i < 3; i++) wanted += open >> i & 1 ? 0 : 5; /* a hinge */
        wanted += (open & 3) == 0;                                   /* the coupling of the first two */
        wanted += (open & 4) == 0;                                   /* the drive of the third */
        assert_int_equal(rows_with(open), wanted);
    }
}

static uint64_t hash_after(rig *r, dmb_sim *sim, int steps)
{
    uint64_t hash = 0;
    for (int i = 0; i < steps; i++) must(r, dmb_sim_step(sim, 1e-3, NULL));
    must(r, dmb_sim_hash(sim, &hash));
    return hash;
}

static dmb_id add_hinge(rig *r, int with_stop)
{
    const dmb_id ground = {0, 0};
    dmb_body_def body = dmb_body_def_default();
    body.position[1] = 0.5;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.02;
    dmb_joint_def joint =
        joint_between(DMB_JOINT_REVOLUTE, dmb_station(ground, 0, 0.0), dmb_station(add_body(r, &body), 0, 0.0));
    joint.damping[3] = 0.1;
    joint.friction[3] = 0.2;
    if (with_stop) joint.stop_low[3] = -0.01, joint.stop_high[3] = 0.01;
    joint.match = 1;
    return add_joint(r, &joint);
}

/* A turning body with a damper, friction and a stop at its hinge, which opens; odd and even numbers of steps after
 * that, since the two configurations of a sim change places in each. */
static void continues_after_opening(int steps, int with_stop)
{
    rig r;
    size_t size = 0;
    dmb_sim *fresh = NULL;
    rig_open(&r, 0.0, 0.0, -9.81);
    const dmb_id hinge = add_hinge(&r, with_stop);
    must(&r, rig_start(&r, NULL));
    must(&r, dmb_sim_create(r.model, NULL, &fresh));
    (void)hash_after(&r, r.sim, 5);
    must(&r, dmb_sim_set_joint(r.sim, hinge, DMB_JOINT_OPEN));
    (void)hash_after(&r, r.sim, steps);
    must(&r, dmb_sim_snapshot_size(r.sim, &size));
    void *block = malloc(size);
    assert_non_null(block);
    must(&r, dmb_sim_snapshot(r.sim, block, size));
    must(&r, dmb_sim_restore(fresh, block, size));
    assert_int_equal(hash_after(&r, r.sim, 3), hash_after(&r, fresh, 3));
    free(block);
    dmb_sim_destroy(&fresh);
    rig_close(&r);
}

static void restored_after_opening(void **state)
{
    (void)state;
    for (int with_stop = 0; with_stop < 2; with_stop++)
        for (int steps = 0; steps < 4; steps++) continues_after_opening(steps, with_stop);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(only_what_holds), cmocka_unit_test(restored_after_opening)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
