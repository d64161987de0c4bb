/* Without DMB_FEATURE_DAMPING the dampers of joints, stops, springs and stuck places and the external damping that is
 * an input are not there: a run is, to the bit, that of a scene whose dampers are 0. */
#include "contact_scene.h"
#include "drillmbd/scene.h"

typedef struct dampers {
    rig r;
    dmb_id body, string;
} dampers;

/* Falls onto a stop, on a spring of the joint and one to the ground. */
static void add_body_on_joint(dampers *d, double damping)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_spring_def spring = dmb_spring_def_default();
    body.position[2] = 1.0;
    d->body = add_body(&d->r, &body);
    joint.kind = DMB_JOINT_PRISMATIC;
    joint.place_b = spring.place_b = dmb_station(d->body, 0, 0.0);
    joint.match = 1;
    joint.axis_a[0] = 0.0, joint.axis_a[2] = 1.0;
    joint.stiffness[DMB_X] = 100.0;
    joint.damping[DMB_X] = 2.0 * damping;
    joint.stop_low[DMB_X] = -0.03;
    joint.stop_stiffness = 1e4;
    joint.stop_damping = 10.0 * damping;
    (void)add_joint(&d->r, &joint);
    spring.offset_a[0] = 1.0;
    spring.stiffness = 30.0;
    spring.damping = damping;
    must_model(&d->r, dmb_model_add_spring(d->r.model, &spring, NULL));
}

/* Held at its far end, pulled inside. */
static void add_stuck_string(dampers *d, double damping)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    dmb_load_def load = dmb_load_def_default();
    string.follows_hole = 0;
    d->string = pipe.string = add_string(&d->r, &string);
    (void)add_pipes(&d->r, &pipe, 2);
    stuck.place = dmb_station(d->string, 1, 1.0);
    stuck.damping[0] = stuck.damping[1] = 1e4 * damping;
    must_model(&d->r, dmb_model_add_stuck(d->r.model, &stuck, NULL));
    load.place = dmb_station(d->string, 0, 0.5);
    load.force[0] = 1e4;
    (void)add_load(&d->r, &load);
}

typedef struct outcome {
    double body, tip, kinetic, lost; /* [m, m, J, J] */
} outcome;

static outcome run(double damping, int32_t features)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_compile_options compile = dmb_compile_options_default();
    dmb_input_def input = dmb_input_def_default();
    dampers d;
    rig_open(&d.r, 0.0, 0.0, -9.81);
    environment.axial_damping = 20.0 * damping;
    must_model(&d.r, dmb_model_set_environment(d.r.model, &environment));
    memcpy(input.name, "axial", 6);
    input.target = DMB_TARGET_AXIAL_DAMPING;
    must_model(&d.r, dmb_model_add_input(d.r.model, &input, NULL));
    add_body_on_joint(&d, damping);
    add_stuck_string(&d, damping);
    compile.features = features;
    (void)rig_start_with(&d.r, &compile, NULL);
    for (int i = 0; i < 200; i++) must(&d.r, dmb_sim_step(d.r.sim, 1e-3, NULL));
    const dmb_energy energy = energy_of(&d.r);
    const outcome out = {pose_at(&d.r, dmb_station(d.body, 0, 0.0)).position[2],
                         pose_at(&d.r, dmb_station(d.string, 1, 1.0)).position[0], energy.kinetic,
                         energy.damping + energy.impact};
    rig_close(&d.r);
    return out;
}

static void they_are_not_there(void **state)
{
    (void)state;
    const outcome left_out = run(1.0, DMB_FEATURE_ALL & ~DMB_FEATURE_DAMPING), without = run(0.0, DMB_FEATURE_ALL);
    const outcome with = run(1.0, DMB_FEATURE_ALL);
    CHECK_CLOSE(left_out.body, without.body, 0.0);
    CHECK_CLOSE(left_out.tip, without.tip, 0.0);
    CHECK_CLOSE(left_out.kinetic, without.kinetic, 0.0);
    CHECK_CLOSE(left_out.lost, 0.0, 1e-12);
    assert_true(with.lost > 0.1 && fabs(with.body - without.body) > 1e-4 && with.tip != without.tip);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(they_are_not_there)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
