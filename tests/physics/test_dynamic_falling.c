/* Strings falling in a viscous fluid, and light bodies beside heavy strings. */
#include <stdio.h>

#include "rig.h"

/* v' = -g - (c/m) v from rest: z = -(g/k) (t - (1 - exp(-k t))/k), k = c/m per metre */
static double fall(double k, double t)
{
    return -(9.81 / k) * (t - (1.0 - exp(-k * t)) / k);
}

/* Ten metres of pipe, free, with a lateral drag of 20 N s/m2: it falls without turning, whatever its pipes are. */
static void falls_level(int32_t kind, double joint)
{
    rig s;
    dmb_environment_def fluid = dmb_environment_def_default();
    dmb_string_def free_string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(&s, 0.0, 0.0, -9.81);
    fluid.lateral_damping = 20.0;
    must_model(&s, dmb_model_set_environment(s.model, &fluid));
    free_string.start_free = DMB_FREE_ALL;
    const dmb_id string = add_string(&s, &free_string);
    pipe.kind = kind;
    pipe.joint_length = joint;
    add_pipes(&s, &pipe, 10);
    rig_start(&s, NULL);
    take_steps(&s, 1e-3, 500);
    dmb_model_info info = dmb_model_info_default();
    must_model(&s, dmb_model_get_info(s.model, &info));
    const double want = fall(20.0 * info.length / info.mass, 0.5);
    check_close("rig end falls as a whole", pose_at(&s, dmb_station(string, 0, 0.0)).position[2], want, 2e-3);
    check_close("far end", pose_at(&s, dmb_station(string, 9, 1.0)).position[2], want, 2e-3);
    const double tilt = pose_at(&s, dmb_station(string, 9, 1.0)).rotation[6];
    check_below("tilt", tilt, kind == DMB_PIPE_RIGID ? 1e-12 : 2e-3);
    rig_close(&s);
}

static void flexible_string_falls_level(void **state)
{
    (void)state;
    falls_level(DMB_PIPE_FLEXIBLE, 0.0);
}

static void rigid_string_falls_level(void **state)
{
    (void)state;
    falls_level(DMB_PIPE_RIGID, 0.0);
}

static void string_with_joints_falls_level(void **state)
{
    (void)state;
    falls_level(DMB_PIPE_FLEXIBLE, 0.2);
}

/* A body of 10 g pushed with 0.02 N beside a string that carries 1e6 N: its travel is judged by its own forces. */
static void light_body_beside_a_loaded_string(void **state)
{
    (void)state;
    rig s;
    dmb_string_def held = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_load_def pull = dmb_load_def_default(), push = dmb_load_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    held.start_free = DMB_FREE_NONE;
    const dmb_id string = add_string(&s, &held);
    add_pipes(&s, &pipe, 100);
    body.mass = 0.01;
    const dmb_id light = add_body(&s, &body);
    pull.place = dmb_station(string, 99, 1.0);
    pull.force[0] = 1e6;
    add_load(&s, &pull);
    push.place = dmb_station(light, 0, 0.0);
    push.force[1] = 0.02;
    add_load(&s, &push);
    rig_start(&s, NULL);
    take_steps(&s, 1e-3, 200);
    check_relative("travel of the body", pose_at(&s, dmb_station(light, 0, 0.0)).position[1], 0.5 * 2.0 * 0.2 * 0.2,
                   1e-9);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flexible_string_falls_level),
        cmocka_unit_test(rigid_string_falls_level),
        cmocka_unit_test(string_with_joints_falls_level),
        cmocka_unit_test(light_body_beside_a_loaded_string),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
