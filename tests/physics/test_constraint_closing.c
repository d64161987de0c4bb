/* A joint closes in a run where its own parts fit and are not turned over; others do not matter. */
#include <string.h>

#include "mechanism.h"

static const double g = 9.81, step = 1e-3;

static void expect_message(const rig *s, const char *text)
{
    if (strstr(dmb_sim_message(s->sim), text) == NULL)
        fail_msg("message without \"%s\": %s", text, dmb_sim_message(s->sim));
}

/* ---- Turned over ------------------------------------------------------------------------------------------------- */

/* A body at the origin, turned by `turn`, on the ground by a joint described open. */
static rig turned_body(int32_t kind, const double turn[3], dmb_id *joint)
{
    rig s;
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def def = dmb_joint_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    memcpy(body.rotation, turn, sizeof body.rotation);
    (void)memcpy(def.name, "plug", 5);
    def.kind = kind;
    def.state = DMB_JOINT_OPEN;
    def.place_b = dmb_station(add_body(&s, &body), 0, 0.0);
    *joint = add_joint(&s, &def);
    (void)mechanism_start(&s, NULL);
    return s;
}

static void close_turned(int32_t kind, const double turn[3], int32_t wanted)
{
    dmb_id joint;
    rig s = turned_body(kind, turn, &joint);
    const uint64_t before = rig_hash(&s);
    const int32_t status = dmb_sim_set_joint(s.sim, joint, DMB_JOINT_ACTIVE);
    print_message("    kind %d, turned by %g %g %g: %s: %s\n", (int)kind, turn[0], turn[1], turn[2],
                  dmb_status_name(status), dmb_sim_message(s.sim));
    assert_int_equal(status, wanted);
    if (status < 0) {
        expect_message(&s, "joint 0 (plug): turned over");
        expect_message(&s, "3.14159 rad");
        assert_true(rig_hash(&s) == before);
        must(&s, dmb_sim_set_joint(s.sim, joint, DMB_JOINT_LOCKED)); /* where it is */
    }
    take_steps(&s, step, 10);
    check_below("violation", joint_at(&s, joint).violation, 1e-14);
    rig_close(&s);
}

static void turned_over_cannot_close(void **state)
{
    (void)state;
    static const int32_t kinds[] = {DMB_JOINT_FIXED, DMB_JOINT_PRISMATIC, DMB_JOINT_REVOLUTE, DMB_JOINT_CYLINDRICAL,
                                    DMB_JOINT_PLANAR};
    const double none[3] = {0.0, 0.0, 0.0}, x[3] = {PI, 0.0, 0.0}, y[3] = {0.0, PI, 0.0}, z[3] = {0.0, 0.0, PI};
    for (int i = 0; i < 5; i++) {
        close_turned(kinds[i], none, DMB_OK);
        close_turned(kinds[i], x, i < 2 ? DMB_ERR_GEOMETRY : DMB_OK); /* RX is free in the others */
        close_turned(kinds[i], y, DMB_ERR_GEOMETRY);
        close_turned(kinds[i], z, DMB_ERR_GEOMETRY);
    }
    close_turned(DMB_JOINT_UNIVERSAL, y, DMB_OK);
    close_turned(DMB_JOINT_SPHERICAL, z, DMB_OK);
}

/* ---- Others do not matter ---------------------------------------------------------------------------------------- */

/* The origin of a body on the unit sphere, in picometres: rounding of the place is more than 1e-6 of that unit. */
static int32_t on_sphere(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                         double *jacobian)
{
    const double unit = *(const double *)context, *x = poses[0], *R = poses[0] + 3;
    (void)time, (void)count;
    value[0] = 0.5 * unit * (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 1.0);
    for (int i = 0; i < 3; i++) jacobian[i] = unit * (x[0] * R[i] + x[1] * R[3 + i] + x[2] * R[6 + i]);
    for (int i = 3; i < 6; i++) jacobian[i] = 0.0;
    return 0;
}

/* Only what the switch makes hold is asked to fit. */
static void violation_of_others_does_not_count(void **state)
{
    (void)state;
    double unit = 1e12, worst = 0.0;
    dmb_body_def ball = dmb_body_def_default();
    dmb_constraint_def def = dmb_constraint_def_default();
    dmb_joint_def plug = dmb_joint_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -g);
    ball.position[0] = 0.6;
    ball.position[1] = 0.8;
    def.place[0] = dmb_station(add_body(&s, &ball), 0, 0.0);
    def.callback = on_sphere;
    def.callback_context = &unit;
    def.provides = DMB_PROVIDES_JACOBIAN;
    must_model(&s, dmb_model_add_constraint(s.model, &def, NULL));
    ball.position[0] = 5.0;
    plug.place_b = dmb_station(add_body(&s, &ball), 0, 0.0);
    plug.match = 1;
    const dmb_id joint = add_joint(&s, &plug);
    (void)mechanism_start(&s, NULL);
    for (int i = 0; i < 50; i++) {
        take_steps(&s, step, 10);
        const dmb_pose pose = pose_at(&s, def.place[0]);
        const double *x = pose.position;
        worst = fmax(worst, 0.5 * unit * fabs(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 1.0));
        must(&s, dmb_sim_set_joint(s.sim, joint, DMB_JOINT_OPEN));
        must(&s, dmb_sim_set_joint(s.sim, joint, DMB_JOINT_ACTIVE));
    }
    tell("largest violation of the sphere [pm]", worst);
    assert_true(worst > 1e-6);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turned_over_cannot_close),
        cmocka_unit_test(violation_of_others_does_not_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
