/* Strings at rest in inclined holes with stiff walls. Positions across the hole are small differences of coordinates of
 * tens of metres; what rounding makes of them, times the wall's stiffness, must not keep a search from ending. */
#include "check.h"
#include "drillmbd/drillmbd.h"

static void must(int32_t status, const char *message)
{
    if (status < 0) fail_msg("%d: %s", (int)status, message);
}

/* 60 pipes of 2 m in a hole inclined by `inclination` [rad], held at the rig end. */
static void rest(double inclination, double stiffness)
{
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_static_report report = dmb_static_report_default();
    dmb_contact_total sum = dmb_contact_total_default();
    dmb_model_info info = dmb_model_info_default();
    double reaction[6];
    must(dmb_model_create(NULL, &model), "create");
    wall.direction[0] = cos(inclination);
    wall.direction[2] = sin(inclination);
    wall.stiffness = stiffness;
    must(dmb_model_add_wall(model, &wall, NULL), dmb_model_message(model));
    string.start_free = DMB_FREE_NONE;
    must(dmb_model_add_string(model, &string, &pipe.string), dmb_model_message(model));
    pipe.length = 2.0;
    must(dmb_model_add_pipes(model, &pipe, 60, NULL), dmb_model_message(model));
    must(dmb_model_compile(model, NULL), dmb_model_message(model));
    must(dmb_model_get_info(model, &info), "info");
    must(dmb_sim_create(model, NULL, &sim), "sim");
    must(dmb_analysis_static(sim, NULL, &report), dmb_sim_message(sim));
    must(dmb_query_contact_total(sim, &sum), "sum");
    tell("iterations", report.iterations);
    check_below("relative residual", report.residual, 1e-8);
    must(dmb_query_reaction(sim, pipe.string, reaction), "reaction");
    check_relative("wall and support over the weight across", sum.normal_force + reaction[DMB_Z],
                   info.mass * 9.81 * cos(inclination), 1e-5);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

static void flexible_strings_come_to_rest(void **state)
{
    (void)state;
    for (double stiffness = 1e7; stiffness < 2e9; stiffness *= 10.0)
        for (int angle = -30; angle <= 30; angle += 10) rest(angle * PI / 180.0, stiffness);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(flexible_strings_come_to_rest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
