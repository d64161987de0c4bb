/* Rings of bodies and bits that a support keeps off the wall against what compile and the model check say; rings that
 * can move sideways, and scenes without a wall, bring no warning. */
#include "sim_test.h"

enum {
    SUPPORTD_HEAD,
    FREE_HEAD,
    HEAD_WITHOUT_RING,
    SUPPORTD_BIT,
    BIT_WITHOUT_GAUGE,
    SUPPORTD_BODY,
    LOOSE_BODY,
    BODY_IN_RING,
    BODY_BESIDE_RING,
    OPEN_RING,
    NO_WALL,
    CASES
};

static void add_support(dmb_model *model, dmb_id body, double at, int32_t state)
{
    dmb_joint_def joint = dmb_joint_def_default();
    strcpy(joint.name, "ring support");
    joint.kind = DMB_JOINT_POINT_ON_HOLE;
    joint.place_b = dmb_station(body, 0, 0.0);
    joint.origin_b[0] = at;
    joint.state = state;
    must(dmb_model_add_joint(model, &joint, NULL));
}

static void describe(dmb_model *model, int what)
{
    const dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_id id;
    if (what != NO_WALL) must(dmb_model_add_wall(model, &wall, NULL));
    if (what == FREE_HEAD) string.start_free = DMB_FREE_ALL;
    if (what == SUPPORTD_BIT || what == BIT_WITHOUT_GAUGE) string.end_free = DMB_FREE_CYLINDRICAL;
    must(dmb_model_add_string(model, &string, &pipe.string));
    must(dmb_model_add_pipes(model, &pipe, 3, NULL));
    body.contact_diameter = what == HEAD_WITHOUT_RING ? 0.0 : 0.09;
    if (what <= HEAD_WITHOUT_RING || what == NO_WALL) body.attach = DMB_ATTACH_START;
    if (what == SUPPORTD_BODY) body.free_mask = DMB_FREE_CYLINDRICAL;
    body.position[0] = 1.0;
    if (what == BIT_WITHOUT_GAUGE) bit.diameter = 0.0;
    if (what == SUPPORTD_BIT || what == BIT_WITHOUT_GAUGE) {
        must(dmb_model_add_bit(model, &bit, NULL));
        return;
    }
    must(dmb_model_add_body(model, &body, &id));
    if (what >= BODY_IN_RING && what <= OPEN_RING)
        add_support(model, id, what == BODY_BESIDE_RING ? 0.5 : 0.0,
                    what == OPEN_RING ? DMB_JOINT_OPEN : DMB_JOINT_ACTIVE);
}

static int warnings;

static void count_warnings(void *context, int32_t level, const char *text)
{
    (void)context;
    if (level == DMB_LOG_WARNING && strstr(text, "never touches the wall") != NULL) warnings++;
}

static void told_by_compile_and_check(void **state)
{
    static const char *const told[CASES] = {
        "body 0: its contact ring never touches the wall, the support",
        NULL,
        NULL,
        "bit 0: its contact ring never touches the wall, the support",
        NULL,
        "body 0: its contact ring never touches the wall, the support",
        NULL,
        "body 0: its contact ring never touches the wall, joint 0 (ring support) holds"};
    (void)state;
    for (int what = 0; what < CASES; what++) {
        dmb_model_options options = dmb_model_options_default();
        dmb_check_report report = dmb_check_report_default();
        dmb_model *model;
        dmb_sim *sim;
        char text[8192];
        options.log = count_warnings;
        warnings = 0;
        must(dmb_model_create(&options, &model));
        describe(model, what);
        must(dmb_model_compile(model, NULL));
        const char *message = dmb_model_message(model);
        assert_non_null(strstr(message, "compiled: "));
        assert_int_equal(warnings, told[what] != NULL);
        if ((strncmp(message, "warning: ", 9) == 0) != (told[what] != NULL)) fail_msg("case %d: %s", what, message);
        if (told[what] != NULL && strstr(message, told[what]) == NULL) fail_msg("case %d: %s", what, message);
        assert_true(dmb_sim_create(model, NULL, &sim) >= 0);
        must(dmb_analysis_check(sim, &report));
        must(dmb_analysis_check_text(sim, text, sizeof text, NULL));
        if ((strstr(text, "never touches the wall") != NULL) != (told[what] != NULL))
            fail_msg("case %d: %s", what, text);
        assert_true(report.warnings >= (uint32_t)(told[what] != NULL));
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(told_by_compile_and_check)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
