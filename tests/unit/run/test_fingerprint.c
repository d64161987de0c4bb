/* The fingerprint of a scene is that of the same description made again, and another one for each parameter of the
 * friction law: a snapshot of a model in which one differs is refused. */
#include "run/run.h"

#include "drillmbd/scene.h"
#include "rig.h"
#include "sim/sim.h"

static uint64_t fingerprint_with(const dmb_wall_def *wall)
{
    rig s;
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    rig_open(&s, 0.0, 0.0, -9.81);
    (void)add_wall(&s, wall);
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 2);
    (void)rig_start(&s, NULL);
    const uint64_t found = dmb_scene_fingerprint(s.model->scene);
    rig_close(&s);
    return found;
}

static void friction_counts(void **state)
{
    static const struct {
        const char *name;
        size_t at;
        double factor;
    } numbers[] = {{"mu_static", offsetof(dmb_wall_def, mu_static), 1.01},
                   {"mu_dynamic", offsetof(dmb_wall_def, mu_dynamic), 0.99},
                   {"stribeck_speed", offsetof(dmb_wall_def, stribeck_speed), 1.01},
                   {"smoothing_speed", offsetof(dmb_wall_def, smoothing_speed), 0.99},
                   {"full_speed", offsetof(dmb_wall_def, full_speed), 1.01},
                   {"bristle_stiffness", offsetof(dmb_wall_def, bristle_stiffness), 1.01},
                   {"bristle_damping", offsetof(dmb_wall_def, bristle_damping), 1.01}};
    (void)state;
    dmb_wall_def wall = s1_hole();
    wall.friction_law = DMB_FRICTION_BRISTLE;
    wall.bristle_damping = 0.5;
    const uint64_t as_described = fingerprint_with(&wall);
    assert_true(fingerprint_with(&wall) == as_described);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        dmb_wall_def other = wall;
        *(double *)(void *)((char *)&other + numbers[i].at) *= numbers[i].factor;
        if (fingerprint_with(&other) == as_described) fail_msg("%s does not count", numbers[i].name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(friction_counts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
