/* Ends of a string that is not the first of its model, of rigid and of bent pipes: by the closed form of a line and an
 * arc, whatever the first string is made of; a bit at the end of the first does not end the second. */
#include <math.h>

#include "rig.h"

static const double tilt[3] = {0.0, 0.0, 0.5}; /* [rad] about z */

static dmb_id second_string(rig *r, double bend)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = dmb_bit_def_default();
    (void)add_string(r, &string);
    pipe.curvature[2] = 0.3; /* of the first string, which must not count */
    (void)add_pipes(r, &pipe, 2);
    must_model(r, dmb_model_add_bit(r->model, &bit, NULL));
    string.position[0] = 1.0, string.position[1] = 2.0, string.position[2] = 3.0;
    for (int i = 0; i < 3; i++) string.rotation[i] = tilt[i];
    const dmb_id id = add_string(r, &string);
    pipe.string = id;
    pipe.kind = DMB_PIPE_RIGID;
    pipe.curvature[2] = 0.0;
    (void)add_pipes(r, &pipe, 2);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    pipe.curvature[2] = bend;
    (void)add_pipes(r, &pipe, 1);
    return id;
}

static void ends_by_the_closed_form(void **state)
{
    (void)state;
    const double length = s1_pipe().length, arc = length - s1_pipe().joint_length, bend = 0.2, beyond = 0.25;
    rig r;
    rig_open(&r, 0.0, 0.0, 0.0);
    const dmb_id id = second_string(&r, bend);
    dmb_body_def body = dmb_body_def_default();
    must_model(&r, dmb_model_place_at_end(r.model, id, beyond, &body, NULL));
    /* along the line, along the arc that turns towards y, along its end */
    const double angle = bend * arc, straight = length - arc + beyond;
    const double x = 2.0 * length + sin(angle) / bend + straight * cos(angle);
    const double y = (1.0 - cos(angle)) / bend + straight * sin(angle);
    const double c = cos(tilt[2]), s = sin(tilt[2]), wanted[3] = {1.0 + c * x - s * y, 2.0 + s * x + c * y, 3.0};
    for (int i = 0; i < 3; i++) assert_true(fabs(body.position[i] - wanted[i]) < 1e-13);
    assert_true(fabs(body.rotation[2] - (tilt[2] + angle)) < 1e-13);
    assert_true(fabs(body.rotation[0]) < 1e-13 && fabs(body.rotation[1]) < 1e-13);
    rig_close(&r);
}

static void goes_on_beside_a_bit(void **state)
{
    (void)state;
    rig r;
    dmb_sub_def def = dmb_sub_def_default();
    dmb_sub made = dmb_sub_default();
    rig_open(&r, 0.0, 0.0, 0.0);
    def.string = second_string(&r, 0.0);
    dmb_body_def body = dmb_body_def_default(), wanted = dmb_body_def_default();
    must_model(&r, dmb_model_place_at_end(r.model, def.string, 0.0, &wanted, NULL));
    body.position[0] = 77.0; /* does not count */
    def.body = &body;
    must_model(&r, dmb_model_add_sub(r.model, &def, &made));
    def.string = (dmb_id){0, 0}; /* the first, which its bit ends */
    dmb_sub none = dmb_sub_default();
    assert_int_equal(dmb_model_add_sub(r.model, &def, &none), DMB_ERR_ORDER);
    must_model(&r, dmb_model_clear_refused(r.model));
    dmb_pipe_def pipe = s1_pipe();
    pipe.string = made.section;
    (void)add_pipes(&r, &pipe, 1);
    (void)rig_start(&r, NULL);
    const dmb_pose pose = pose_at(&r, dmb_station(made.body, 0, 0.0));
    for (int i = 0; i < 3; i++) assert_true(fabs(pose.position[i] - wanted.position[i]) < 1e-12);
    rig_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ends_by_the_closed_form),
        cmocka_unit_test(goes_on_beside_a_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
