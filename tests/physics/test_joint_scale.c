/* A mechanism has no length of its own: the same slider-crank from a tenth of a millimetre to a kilometre, gravity
 * scaled alike, turns through the same angles with the same number of iterations. */
#include "check.h"
#include "drillmbd/drillmbd.h"

typedef struct outcome {
    double angle, speed, slide, violation; /* slide and violation over the size */
    uint64_t iterations;
} outcome;

static void must(int32_t status, const char *message)
{
    if (status < 0) fail_msg("%d: %s", (int)status, message);
}

static dmb_id rod(dmb_model *model, double size, double length, const double middle[3], double angle)
{
    dmb_body_def def = dmb_body_def_default();
    const double across = length * length * size * size / 12.0;
    dmb_id id;
    for (int i = 0; i < 3; i++) def.position[i] = size * middle[i];
    def.rotation[1] = angle;
    def.inertia[0] = 1e-3 * across, def.inertia[1] = def.inertia[2] = across;
    must(dmb_model_add_body(model, &def, &id), dmb_model_message(model));
    return id;
}

/* Axis y of the world in the frames of both parts. */
static dmb_id hinge(dmb_model *model, dmb_place a, double xa, dmb_place b, double xb)
{
    dmb_joint_def def = dmb_joint_def_default();
    dmb_id id;
    def.kind = DMB_JOINT_REVOLUTE;
    def.place_a = a, def.place_b = b;
    def.origin_a[0] = xa, def.origin_b[0] = xb;
    def.axis_a[0] = def.axis_b[0] = 0.0;
    def.axis_a[1] = def.axis_b[1] = 1.0;
    must(dmb_model_add_joint(model, &def, &id), dmb_model_message(model));
    return id;
}

/* Crank of 1 from the origin along x, rod of 3 behind it, slider on the x axis, let go level. */
static outcome run(double size)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    const double crank_at[3] = {0.5, 0.0, 0.0}, rod_at[3] = {2.5, 0.0, 0.0};
    const dmb_place ground = dmb_station((dmb_id){0, 0}, 0, 0.0);
    must(dmb_model_create(NULL, &model), "create");
    dmb_environment_def environment = dmb_environment_def_default();
    environment.gravity[2] = -9.81 * size;
    must(dmb_model_set_environment(model, &environment), dmb_model_message(model));
    const dmb_place crank = dmb_station(rod(model, size, 1.0, crank_at, 0.0), 0, 0.0);
    const dmb_place coupler = dmb_station(rod(model, size, 3.0, rod_at, 0.0), 0, 0.0);
    dmb_joint_def on_line = dmb_joint_def_default();
    dmb_id foot, slide;
    on_line.kind = DMB_JOINT_POINT_ON_LINE;
    on_line.place_b = coupler;
    on_line.origin_b[0] = 1.5 * size;
    foot = hinge(model, ground, 0.0, crank, -0.5 * size);
    (void)hinge(model, crank, 0.5 * size, coupler, -1.5 * size);
    must(dmb_model_add_joint(model, &on_line, &slide), dmb_model_message(model));
    must(dmb_model_compile(model, NULL), dmb_model_message(model));
    dmb_sim_options options = dmb_sim_options_default();
    options.newton_tolerance = 1e-10;
    must(dmb_sim_create(model, &options, &sim), "create");
    for (int k = 0; k < 1500; k++) must(dmb_sim_step(sim, 1e-3, NULL), dmb_sim_message(sim));
    dmb_joint_state turned = dmb_joint_state_default(), slid = dmb_joint_state_default();
    dmb_statistics statistics = dmb_statistics_default();
    must(dmb_query_joint(sim, foot, &turned), "joint");
    must(dmb_query_joint(sim, slide, &slid), "joint");
    must(dmb_query_statistics(sim, &statistics), "statistics");
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    const outcome o = {turned.position[3], turned.speed[3], slid.position[0] / size, statistics.violation / size,
                       statistics.iterations};
    return o;
}

static void size_does_not_matter(void **state)
{
    (void)state;
    const double sizes[] = {1e-4, 1e-3, 1e-2, 10.0, 1e3};
    const outcome one = run(1.0);
    tell("angle of the crank [rad]", one.angle);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        const outcome o = run(sizes[i]);
        tell("size [m]", sizes[i]);
        check_close("    angle [rad]", o.angle, one.angle, 1e-9);
        check_close("    speed [rad/s]", o.speed, one.speed, 1e-8);
        check_close("    slide over size", o.slide, one.slide, 1e-9);
        check_below("    violation over size", o.violation, 1e-12);
        check_close("    iterations", (double)o.iterations, (double)one.iterations, 0.02 * (double)one.iterations);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(size_does_not_matter)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
