/* Couplings of three and four joint coordinates against closed forms: a differential and a planetary gear with constant
 * torques (accelerations, multiplier, energy), statics, open joints, and what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "check.h"
#include "drillmbd/drillmbd.h"

#define must(call) assert_int_equal((call), DMB_OK)

enum { MOST = 4 };

typedef struct gearbox {
    dmb_model *model;
    dmb_sim *sim;
    uint32_t count;
    dmb_id body[MOST], joint[MOST], coupling;
} gearbox;

static const double inertia[MOST] = {0.7, 0.2, 0.35, 1.3};

/* Bodies on revolutes to the ground, each with a torque about its axis. */
static gearbox describe(uint32_t count, const double *torque)
{
    gearbox g = {.count = count};
    must(dmb_model_create(NULL, &g.model));
    for (uint32_t i = 0; i < count; i++) {
        dmb_body_def body = dmb_body_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        dmb_load_def load = dmb_load_def_default();
        for (int k = 0; k < 3; k++) body.inertia[k] = inertia[i];
        body.position[1] = i;
        must(dmb_model_add_body(g.model, &body, &g.body[i]));
        joint.kind = DMB_JOINT_REVOLUTE;
        joint.origin_a[1] = i;
        joint.place_b = dmb_station(g.body[i], 0, 0.0);
        must(dmb_model_add_joint(g.model, &joint, &g.joint[i]));
        load.place = joint.place_b;
        load.moment[0] = torque[i];
        must(dmb_model_add_load(g.model, &load, NULL));
    }
    return g;
}

static dmb_coupling_def differential(const gearbox *g)
{
    dmb_coupling_def def = dmb_coupling_def_default();
    def.joint[0] = g->joint[0];
    def.joint[1] = g->joint[1];
    def.third_joint = g->joint[2];
    def.ratio = def.third_ratio = 0.5;
    return def;
}

static void start(gearbox *g, const dmb_coupling_def *def)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.energy_ledger = 1;
    must(dmb_model_add_coupling(g->model, def, &g->coupling));
    must(dmb_model_compile(g->model, NULL));
    const int32_t status = dmb_sim_create(g->model, &options, &g->sim);
    if (status < 0) fail_msg("%s", dmb_model_message(g->model));
}

static void finish(gearbox *g)
{
    dmb_sim_destroy(&g->sim);
    dmb_model_destroy(&g->model);
}

static dmb_joint_state ask(const gearbox *g, uint32_t i)
{
    dmb_joint_state state = dmb_joint_state_default();
    must(dmb_query_joint(g->sim, g->joint[i], &state));
    return state;
}

/* J_i a_i = T_i - c_i m, sum of c_i a_i = 0: m = sum(c_i T_i/J_i) / sum(c_i^2/J_i). */
static void check_motion(gearbox *g, const double *torque, const double *factor)
{
    double above = 0.0, below = 0.0, sum = 0.0;
    const double end = 0.5;
    for (uint32_t i = 0; i < g->count; i++) {
        above += factor[i] * torque[i] / inertia[i];
        below += factor[i] * factor[i] / inertia[i];
    }
    for (int k = 0; k < 50; k++) must(dmb_sim_step(g->sim, end / 50.0, NULL));
    for (uint32_t i = 0; i < g->count; i++) {
        const double acceleration = (torque[i] - factor[i] * above / below) / inertia[i];
        const dmb_joint_state state = ask(g, i);
        check_close("speed", state.speed[DMB_RX], acceleration * end, 1e-11);
        check_close("angle", state.position[DMB_RX], 0.5 * acceleration * end * end, 1e-11);
        sum += factor[i] * state.position[DMB_RX];
    }
    check_below("what the coupling keeps", fabs(sum), 1e-13);
    dmb_energy energy = dmb_energy_default();
    must(dmb_query_energy(g->sim, &energy));
    check_below("unexplained energy", fabs(energy.unexplained) / energy.input, 1e-10);
}

static void differential_is_the_closed_form(void **state)
{
    static const double torque[] = {9.0, -1.0, 2.5}, factor[] = {1.0, -0.5, -0.5};
    (void)state;
    gearbox g = describe(3, torque);
    const dmb_coupling_def def = differential(&g);
    start(&g, &def);
    check_motion(&g, torque, factor);
    finish(&g);
}

/* Four coordinates, with a factor of each sign. */
static void four_coordinates_are_the_closed_form(void **state)
{
    static const double torque[] = {4.0, 3.0, -2.0, 6.0}, factor[] = {1.0, -2.5, 0.75, -1.2};
    (void)state;
    gearbox g = describe(4, torque);
    dmb_coupling_def def = differential(&g);
    def.ratio = 2.5;
    def.third_ratio = -0.75;
    def.fourth_joint = g.joint[3];
    def.fourth_ratio = 1.2;
    start(&g, &def);
    check_motion(&g, torque, factor);
    finish(&g);
}

/* Cage and one wheel held by springs, a torque on the other: what balances at rest goes by the ratios. */
static void statics_share_the_torque(void **state)
{
    static const double torque[] = {0.0, 0.0, 3.0};
    const double spring[2] = {50.0, 20.0};
    (void)state;
    gearbox g = describe(3, torque);
    for (uint32_t i = 0; i < 2; i++) {
        dmb_joint_def joint = dmb_joint_def_default();
        joint.kind = DMB_JOINT_FREE;
        joint.origin_a[1] = i;
        joint.place_b = dmb_station(g.body[i], 0, 0.0);
        joint.stiffness[DMB_RX] = spring[i];
        must(dmb_model_add_joint(g.model, &joint, NULL));
    }
    const dmb_coupling_def def = differential(&g);
    start(&g, &def);
    must(dmb_analysis_static(g.sim, NULL, NULL));
    /* the multiplier m: 3 + m/2 = 0 on the free wheel; k_c q_c = -m, k_l q_l = m/2 */
    const double m = -6.0, cage = -m / spring[0], left = 0.5 * m / spring[1];
    check_close("cage", ask(&g, 0).position[DMB_RX], cage, 1e-9);
    check_close("left", ask(&g, 1).position[DMB_RX], left, 1e-9);
    check_close("right", ask(&g, 2).position[DMB_RX], 2.0 * cage - left, 1e-9);
    finish(&g);
}

/* With an open joint the coupling holds nothing: each turns by its own torque. */
static void an_open_joint_frees_all(void **state)
{
    static const double torque[] = {9.0, -1.0, 2.5};
    (void)state;
    gearbox g = describe(3, torque);
    const dmb_coupling_def def = differential(&g);
    start(&g, &def);
    const int32_t status = dmb_sim_set_joint(g.sim, g.joint[2], DMB_JOINT_OPEN);
    if (status < 0) fail_msg("%s", dmb_sim_message(g.sim));
    for (int k = 0; k < 10; k++) must(dmb_sim_step(g.sim, 0.01, NULL));
    for (uint32_t i = 0; i < 2; i++)
        check_close("speed", ask(&g, i).speed[DMB_RX], torque[i] / inertia[i] * 0.1, 1e-11);
    finish(&g);
}

static void bad_input_is_refused(void **state)
{
    static const double torque[] = {0.0, 0.0, 0.0};
    (void)state;
    gearbox g = describe(3, torque);
    const dmb_coupling_def good = differential(&g);
    dmb_coupling_def c;
#define TRY(change, status, text)                                                                                   \
    do {                                                                                                            \
        c = good;                                                                                                   \
        change;                                                                                                     \
        assert_int_equal(dmb_model_add_coupling(g.model, &c, NULL), status);                                        \
        if (strstr(dmb_model_message(g.model), text) == NULL) fail_msg("%s: %s", text, dmb_model_message(g.model)); \
    } while (0)
    TRY(c.third_joint = g.body[0], DMB_ERR_ID, "third_joint = {");
    TRY(c.fourth_joint.index = 5, DMB_ERR_ID, "fourth_joint = {");
    TRY(c.third_component = DMB_X, DMB_ERR_VALUE, "third_component = 0, must be free in its joint: joint 2");
    TRY(c.third_joint = g.joint[0], DMB_ERR_VALUE, "third_component = 3, must be another coordinate than component[0]");
    TRY(c.fourth_joint = g.joint[2], DMB_ERR_VALUE, "fourth_component = 3, must be another coordinate");
    TRY(c.third_ratio = 0.0, DMB_ERR_VALUE, "third_ratio = 0, must be of size");
    TRY(c.third_ratio = (double)NAN, DMB_ERR_NOT_FINITE, "third_ratio = nan");
    TRY(c.third_component = 6, DMB_ERR_VALUE, "third_component = 6, must be 0 .. 5");
#undef TRY
    dmb_model_destroy(&g.model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(differential_is_the_closed_form),
        cmocka_unit_test(four_coordinates_are_the_closed_form),
        cmocka_unit_test(statics_share_the_torque),
        cmocka_unit_test(an_open_joint_frees_all),
        cmocka_unit_test(bad_input_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
