/* Equations that a model tells as active: those of joints that hold, of couplings whose joints all hold and of motion
 * drives on joints that hold, counted by hand for each set of open joints. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(only_what_holds)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
