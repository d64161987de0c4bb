/* Inertias against the bound that every distribution of mass keeps: bodies of point masses pass however they are
 * turned, thin rods and discs on the bound too; beyond it bodies, bits, tool joints and rigid pipes are refused. */
#include "sim_test.h"

static int32_t add_body(dmb_model *model, const double inertia[6])
{
    dmb_body_def body = dmb_body_def_default();
    memcpy(body.inertia, inertia, sizeof body.inertia);
    return dmb_model_add_body(model, &body, NULL);
}

/* J = R diag(moment) R^T with the rotation vector r. */
static void turned(const double moment[3], double angle, const double axis[3], double J[6])
{
    double R[3][3];
    const double n = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]), c = cos(angle), s = sin(angle);
    const double u[3] = {axis[0] / n, axis[1] / n, axis[2] / n};
    const double cross[3][3] = {{0.0, -u[2], u[1]}, {u[2], 0.0, -u[0]}, {-u[1], u[0], 0.0}};
    static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) R[i][k] = (i == k ? c : 0.0) + (1.0 - c) * u[i] * u[k] + s * cross[i][k];
    for (int e = 0; e < 6; e++) {
        J[e] = 0.0;
        for (int k = 0; k < 3; k++) J[e] += R[row[e]][k] * moment[k] * R[column[e]][k];
    }
}

static void turned_tensors(void **state)
{
    static const struct {
        double moment[3];
        int32_t status;
    } cases[] = {{{1.0, 1.0, 1.0}, DMB_OK},
                 {{1.0, 1.0, 1e-12}, DMB_OK}, /* thin rod */
                 {{2.0, 1.0, 1.0}, DMB_OK},
                 {{3.0, 2.0, 1.0}, DMB_OK}, /* disc, plate */
                 {{1e-9, 2e-9, 1e-9}, DMB_OK},
                 {{3e9, 1e9, 2e9}, DMB_OK},
                 {{3.0, 1.999, 1.0}, DMB_ERR_VALUE},
                 {{2.0001, 1.0, 1.0}, DMB_ERR_VALUE},
                 {{1.0, 0.9, 0.09}, DMB_ERR_VALUE},
                 {{0.3, 0.001, 0.001}, DMB_ERR_VALUE},
                 {{1e-9, 2.1e-9, 1e-9}, DMB_ERR_VALUE}};
    dmb_model *model;
    (void)state;
    must(dmb_model_create(NULL, &model));
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (int turn = 0; turn < 60; turn++) {
            const double axis[3] = {1.0 + turn % 3, -2.0 + turn % 5, 0.5 * (turn % 7) - 1.6};
            double J[6];
            turned(cases[i].moment, 0.37 * turn, axis, J);
            if (add_body(model, J) == cases[i].status) continue;
            fail_msg("case %zu, turn %d: %s", i, turn, dmb_model_message(model));
        }
    dmb_model_destroy(&model);
}

/* J = sum m (r^2 I - r r^T): whatever the masses, they pass. */
static void bodies_of_point_masses(void **state)
{
    uint32_t random = 12345;
    dmb_model *model;
    (void)state;
    must(dmb_model_create(NULL, &model));
    for (int body = 0; body < 2000; body++) {
        double J[6] = {0}, flat = body % 3 == 0 ? 1e-7 : 1.0;
        for (int point = 0; point < 5; point++) {
            double r[3], m = 1.0 + point;
            for (int i = 0; i < 3; i++) {
                random = random * 1664525u + 1013904223u;
                r[i] = (double)(random >> 8) / 16777216.0 - 0.5;
            }
            r[body % 3] *= flat;
            J[0] += m * (r[1] * r[1] + r[2] * r[2]);
            J[1] += m * (r[0] * r[0] + r[2] * r[2]);
            J[2] += m * (r[0] * r[0] + r[1] * r[1]);
            J[3] -= m * r[0] * r[1];
            J[4] -= m * r[0] * r[2];
            J[5] -= m * r[1] * r[2];
        }
        for (int i = 0; i < 6; i++) J[i] = (double)(float)J[i]; /* in single precision too */
        if (add_body(model, J) != DMB_OK) fail_msg("body %d: %s", body, dmb_model_message(model));
    }
    dmb_model_destroy(&model);
}

static void the_message_has_the_moments(void **state)
{
    const double moment[3] = {1.0, 5.0, 2.0}, axis[3] = {1.0, 2.0, 3.0};
    double J[6];
    dmb_model *model;
    (void)state;
    must(dmb_model_create(NULL, &model));
    turned(moment, 1.1, axis, J);
    assert_int_equal(add_body(model, J), DMB_ERR_VALUE);
    if (strstr(dmb_model_message(model), "body 0: inertia gives the principal moments 5, 2, 1 kg m2") == NULL)
        fail_msg("%s", dmb_model_message(model));
    dmb_model_destroy(&model);
}

static void solids_of_revolution(void **state)
{
    static const struct {
        double inertia[2];
        int32_t bit, joint;
    } cases[] = {{{0.0, 0.0}, DMB_OK, DMB_OK},
                 {{0.2, 0.1}, DMB_OK, DMB_OK},
                 {{0.1, 5.0}, DMB_OK, DMB_OK},
                 {{0.2001, 0.1}, DMB_ERR_VALUE, DMB_ERR_VALUE},
                 {{0.0, 1e-6}, DMB_ERR_VALUE, DMB_ERR_VALUE}, /* about the axis that of a cylinder, 0.0053 and 0.005 */
                 {{1.0, 0.0}, DMB_ERR_VALUE, DMB_ERR_VALUE}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        dmb_model *model;
        dmb_bit_def bit = dmb_bit_def_default();
        dmb_pipe_def pipe = dmb_pipe_def_default();
        must(dmb_model_create(NULL, &model));
        pipe.joint_length = 0.1;
        memcpy(pipe.joint_inertia, cases[i].inertia, sizeof pipe.joint_inertia);
        assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), cases[i].joint);
        if (cases[i].joint < 0) assert_non_null(strstr(dmb_model_message(model), "joint_inertia gives the principal"));
        memcpy(bit.inertia, cases[i].inertia, sizeof bit.inertia);
        assert_int_equal(dmb_model_add_bit(model, &bit, NULL), cases[i].bit);
        if (cases[i].bit < 0) assert_non_null(strstr(dmb_model_message(model), "bit 0: inertia gives the principal"));
        dmb_model_destroy(&model);
    }
}

/* A rigid pipe is a body, whether it is described or compiled so; a flexible section is not one. */
static void rigid_pipes(void **state)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_compile_options options = dmb_compile_options_default();
    dmb_model *model;
    (void)state;
    must(dmb_model_create(NULL, &model));
    pipe.section_inertia[0] = 5.0; /* across m L^2/12 = 0.83 kg m2 */
    pipe.kind = DMB_PIPE_RIGID;
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_model_message(model), "section_inertia of a rigid pipe"));
    dmb_model_destroy(&model);
    must(dmb_model_create(NULL, &model));
    pipe.kind = DMB_PIPE_FLEXIBLE;
    must(dmb_model_add_pipes(model, &pipe, 1, NULL));
    options.pipe_kind = DMB_PIPE_RIGID;
    assert_int_equal(dmb_model_compile(model, &options), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_model_message(model), "section_inertia of a rigid pipe"));
    must(dmb_model_compile(model, NULL));
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turned_tensors),
        cmocka_unit_test(bodies_of_point_masses),
        cmocka_unit_test(the_message_has_the_moments),
        cmocka_unit_test(solids_of_revolution),
        cmocka_unit_test(rigid_pipes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
