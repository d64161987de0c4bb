/* Bodies that spin, in axes that do not: their iteration matrix against differences of the residual by the increments
 * of a step; the motion at the end of a step against the formulas of system/constrain/rotor.h; and the axes that
 * compile chooses. Checks eq:motion.rotor, eq:motion.rotor-step and eq:motion.rotor-tangent. */
#include <string.h>

#include "mechanism.h"

#include "integrator/step_motion.h"
#include "integrator/trial_step.h"
#include "math/mat6.h"
#include "math/se3.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/rotor.h"

enum { ROWS = 6 };
#define STEP 0.01  /* [s] */
#define SPIN 120.0 /* [rad/s] 1.2 rad a step */

/* A body of revolution about an axis that is none of its own, that tumbles and spins; mud goes along with it. */
static const double e[3] = {0.48, 0.6, 0.64};

static dmb_body_def spinning_body(void)
{
    dmb_body_def body = dmb_body_def_default();
    const double across = 0.02, about = 0.03;
    body.mass = 3.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = across + (about - across) * e[i] * e[i];
    body.inertia[3] = (about - across) * e[0] * e[1];
    body.inertia[4] = (about - across) * e[0] * e[2];
    body.inertia[5] = (about - across) * e[1] * e[2];
    for (int i = 0; i < 3; i++) {
        body.centre[i] = 0.1 * (i - 1);
        body.velocity[i] = 0.3 - 0.4 * i;
        body.velocity[3 + i] = SPIN * e[i] + 1.0 - i;
    }
    body.added_mass[0] = 0.4;
    body.added_mass[1] = 0.7;
    return body;
}

/* On a joint that holds nothing, so that all its rows are unknowns; gravity. */
static rig open_spinning(int supportd)
{
    rig s;
    dmb_body_def body = spinning_body();
    rig_open(&s, 1.0, -3.0, -9.81);
    if (supportd) {
        body.free_mask = DMB_FREE_SPHERICAL;
        memset(body.velocity, 0, 3 * sizeof(double));
        for (int i = 0; i < 3; i++) body.centre[i] = 0.25 * e[i];
    }
    const dmb_id id = add_body(&s, &body);
    if (!supportd) (void)add_joint_between(&s, DMB_JOINT_FREE, dmb_station(ground_id, 0, 0.0), dmb_station(id, 0, 0.0));
    assert_true(rig_start(&s, NULL) >= 0);
    return s;
}

/* The trial of a step with its increments at z beyond the prediction; its residual. */
static void evaluate_at(dmb_sim *sim, const double z[ROWS], int32_t tangent, dmb_trial_step *trial_step)
{
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(sim->options.spectral_radius);
    trial_step->end = dmb_step_end_after(sim, STEP);
    dmb_trial_step_set_up(sim, &trial_step->end, &trial_step->evaluation);
    dmb_step_motion_predict(sim, &c, STEP, 0.0);
    dmb_step_motion_place(sim);
    for (int i = 0; i < ROWS; i++) sim->correction[i] = sim->scene->solved_row[i] ? z[i] : 0.0;
    dmb_step_motion_correct(sim, &c, STEP);
    const dmb_step_motion to = dmb_step_motion_of(sim);
    memcpy(sim->trial.velocity, to.velocity, ROWS * sizeof(double));
    memcpy(sim->trial.acceleration, to.acceleration, ROWS * sizeof(double));
    trial_step->evaluation.tangent = tangent;
    assert_int_equal(dmb_system_evaluate(&trial_step->evaluation), DMB_OK);
}

static void matrix_by_differences(dmb_sim *sim, const double z[ROWS], double out[ROWS][ROWS])
{
    const double step = 1e-4;
    dmb_trial_step trial_step;
    memset(&trial_step, 0, sizeof trial_step);
    for (int column = 0; column < ROWS; column++) {
        double f[6][ROWS];
        for (int p = 0; p < 6; p++) {
            double moved[ROWS];
            memcpy(moved, z, sizeof moved);
            moved[column] += step * difference6_place[p];
            evaluate_at(sim, moved, 0, &trial_step);
            memcpy(f[p], sim->residual, sizeof f[p]);
        }
        for (int i = 0; i < ROWS; i++) {
            const double v[6] = {f[0][i], f[1][i], f[2][i], f[3][i], f[4][i], f[5][i]};
            out[i][column] = difference6(v, step);
        }
    }
}

static void matrix_is_the_derivative_by_the_increments(void **state)
{
    (void)state;
    for (int supportd = 0; supportd < 2; supportd++) {
        rig s = open_spinning(supportd);
        const double z[ROWS] = {0.02, -0.03, 0.01, 0.2, -0.1, 0.15};
        double want[ROWS][ROWS], worst = 0.0;
        dmb_trial_step trial_step;
        assert_int_equal(s.sim->scene->rotor_count, 1);
        assert_int_equal(s.sim->scene->cluster_count, !supportd);
        matrix_by_differences(s.sim, z, want);
        memset(&trial_step, 0, sizeof trial_step);
        evaluate_at(s.sim, z, 1, &trial_step);
        dmb_system_iteration_matrix(&trial_step.evaluation);
        for (int i = 0; i < ROWS; i++)
            for (int j = 0; j < ROWS; j++) {
                const int held = !s.sim->scene->solved_row[i] || !s.sim->scene->solved_row[j];
                const double right = held ? (i == j ? 1.0 : 0.0) : want[i][j];
                worst = fmax(worst, fabs(s.sim->stiffness_diagonal[ROWS * i + j] - right));
            }
        check_below(supportd ? "iteration matrix, on a fixed point" : "iteration matrix, free to move",
                    worst / largest((size_t)ROWS * ROWS, want[0]), 1e-9);
        rig_close(&s);
    }
}

/* V = Ad(P) v - O and V' = Ad(P) (v' + ad(O) v) by their definitions, P = exp(h O). */
static void to_still_axes(const double O[6], double h, const double v[6], const double a[6], double V[6], double A[6])
{
    double travel[6], R[9], x[3], turning[6], sum[6];
    for (int i = 0; i < 6; i++) travel[i] = h * O[i];
    dmb_se3_exp(travel, NULL, R, x);
    dmb_adjoint_apply(R, x, v, V);
    for (int i = 0; i < 6; i++) V[i] -= O[i];
    dmb_ad_apply(O, v, turning);
    for (int i = 0; i < 6; i++) sum[i] = a[i] + turning[i];
    dmb_adjoint_apply(R, x, sum, A);
}

/* One step really taken: Newmark's formulas hold in the axes that do not spin, and the pose is H0 exp(h Dq) P. */
static void a_step_is_generalized_alpha_in_axes_that_do_not_spin(void **state)
{
    (void)state;
    rig s = open_spinning(0);
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(s.sim->options.spectral_radius);
    double O[6], V0[6], V1[6], D0[6], D1[6], A0[6], A1[6], z[6], unused[6], worst[3] = {0.0, 0.0, 0.0}, q[4], x[3];
    take_steps(&s, STEP, 3);
    dmb_sim *const sim = s.sim;
    const double *twist = sim->scene->rotors[0].twist, spin = dmb_vec3_dot(twist + 3, sim->now.velocity + 3);
    for (int i = 0; i < 6; i++) O[i] = spin * twist[i];
    to_still_axes(O, 0.0, sim->now.velocity, sim->now.acceleration, V0, D0);
    to_still_axes(O, 0.0, sim->now.velocity, sim->now.pseudo_acceleration, unused, A0);
    memcpy(q, sim->now.quaternion, sizeof q);
    memcpy(x, sim->now.displacement, sizeof x);
    take_steps(&s, STEP, 1);
    to_still_axes(O, STEP, sim->now.velocity, sim->now.acceleration, V1, D1);
    to_still_axes(O, STEP, sim->now.velocity, sim->now.pseudo_acceleration, unused, A1);
    for (int i = 0; i < 6; i++) {
        z[i] = STEP * V0[i] + STEP * STEP * ((0.5 - c.beta) * A0[i] + c.beta * A1[i]);
        const double v = V0[i] + STEP * ((1.0 - c.gamma) * A0[i] + c.gamma * A1[i]);
        const double recursion = (1.0 - c.am) * A1[i] + c.am * A0[i] - (1.0 - c.af) * D1[i] - c.af * D0[i];
        worst[0] = fmax(worst[0], fabs(v - V1[i]));
        worst[1] = fmax(worst[1], fabs(recursion));
        O[i] *= STEP;
    }
    dmb_se3_advance(q, x, z);
    dmb_se3_advance(q, x, O);
    worst[2] = fmax(largest_difference(4, q, sim->now.quaternion), largest_difference(3, x, sim->now.displacement));
    check_below("speed by Newmark's formula [rad/s]", worst[0], 1e-11);
    check_below("recursion of the accelerations [rad/s2]", worst[1], 1e-8);
    check_below("pose", worst[2], 1e-13);
    rig_close(&s);
}

/* ---- Axes -------------------------------------------------------------------------------------------------------- */

typedef struct choice {
    const char *what;
    double inertia[3];
    double axis[3]; /* of the bearing in the body */
    double want[6]; /* twist; 0: none */
    int32_t kind, fixed_to_string, second_kind;
    double second_axis[3];
} choice;

static dmb_joint_def on_ground(int32_t kind, dmb_id body, const double axis[3])
{
    dmb_joint_def def = joint_between(kind, dmb_station(ground_id, 0, 0.0), dmb_station(body, 0, 0.0));
    const double normal[3] = {axis[1], axis[2], axis[0]};
    memcpy(def.axis_a, axis, sizeof def.axis_a);
    memcpy(def.axis_b, axis, sizeof def.axis_b);
    memcpy(def.normal_a, normal, sizeof normal);
    memcpy(def.normal_b, normal, sizeof normal);
    def.origin_a[0] = def.origin_b[0] = 0.3;
    def.origin_a[1] = def.origin_b[1] = 0.2;
    return def;
}

static void add_string_on(rig *s, dmb_id body)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(1.0, 1, 9e5, 4e5, 3e3, 2e3);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 1);
    (void)add_joint_between(s, DMB_JOINT_FIXED, dmb_station(pipe.string, 0, 0.0), dmb_station(body, 0, 0.0));
}

static void check_choice(const choice *of)
{
    rig s;
    dmb_body_def body = dmb_body_def_default();
    rig_open(&s, 0.0, 0.0, -9.81);
    memcpy(body.inertia, of->inertia, sizeof of->inertia);
    body.centre[1] = 0.2;
    const dmb_id id = add_body(&s, &body);
    const dmb_joint_def first = on_ground(of->kind, id, of->axis),
                        second = on_ground(of->second_kind, id, of->second_axis);
    (void)add_joint(&s, &first);
    if (of->second_kind != DMB_JOINT_FREE) (void)add_joint(&s, &second);
    if (of->fixed_to_string) add_string_on(&s, id);
    must_model(&s, dmb_model_compile(s.model, NULL));
    const dmb_scene *scene = s.model->scene;
    print_message("    %s\n", of->what);
    assert_int_equal(scene->rotor_count, largest(6, of->want) > 0.0);
    if (scene->rotor_count > 0)
        check_below("        twist", largest_difference(6, scene->rotors[0].twist, of->want), 1e-14);
    rig_close(&s);
}

static void axes_are_those_of_bearings_and_of_revolution(void **state)
{
    (void)state;
    static const choice all[] = {
        {"disc on a hinge at its axis",
         {2, 1, 1},
         {1, 0, 0},
         {0, 0, -0.2, 1, 0, 0},
         DMB_JOINT_REVOLUTE,
         0,
         DMB_JOINT_FREE,
         {1, 0, 0}},
        {"bar on a hinge across it", {0.1, 1, 1}, {0, 0, 1}, {0}, DMB_JOINT_REVOLUTE, 0, DMB_JOINT_FREE, {1, 0, 0}},
        {"blade on a hinge along it", {3, 2, 1.1}, {1, 0, 0}, {0}, DMB_JOINT_REVOLUTE, 0, DMB_JOINT_FREE, {1, 0, 0}},
        {"round in single precision",
         {2, 1, 1 + 1e-7},
         {1, 0, 0},
         {0, 0, -0.2, 1, 0, 0},
         DMB_JOINT_CYLINDRICAL,
         0,
         DMB_JOINT_FREE,
         {1, 0, 0}},
        {"hardly round", {2, 1, 1.001}, {1, 0, 0}, {0}, DMB_JOINT_CYLINDRICAL, 0, DMB_JOINT_FREE, {1, 0, 0}},
        {"disc that also slides on a line",
         {2, 1, 1},
         {1, 0, 0},
         {0, 0, -0.2, 1, 0, 0},
         DMB_JOINT_REVOLUTE,
         0,
         DMB_JOINT_POINT_ON_LINE,
         {0, 1, 0}},
        {"disc with a shaft behind it",
         {2, 1, 1},
         {1, 0, 0},
         {0, 0, -0.2, 1, 0, 0},
         DMB_JOINT_REVOLUTE,
         0,
         DMB_JOINT_UNIVERSAL,
         {1, 0, 0}},
        {"ball on a hinge aslant of another",
         {1, 1, 1},
         {1, 0, 0},
         {0},
         DMB_JOINT_REVOLUTE,
         0,
         DMB_JOINT_REVOLUTE,
         {0.6, 0.8, 0}},
        {"disc that carries a hinge across it",
         {2, 1, 1},
         {1, 0, 0},
         {0},
         DMB_JOINT_REVOLUTE,
         0,
         DMB_JOINT_REVOLUTE,
         {0, 0, 1}},
        {"top on a pivot",
         {2, 1, 1},
         {1, 0, 0},
         {0, 0, 0.2, -1, 0, 0},
         DMB_JOINT_SPHERICAL,
         0,
         DMB_JOINT_FREE,
         {1, 0, 0}},
        {"top on a pivot beside its axis",
         {1, 2, 1},
         {1, 0, 0},
         {0},
         DMB_JOINT_SPHERICAL,
         0,
         DMB_JOINT_FREE,
         {1, 0, 0}},
        {"ball on a pivot",
         {1, 1, 1},
         {1, 0, 0},
         {0, 0, 0.2, -1, 0, 0},
         DMB_JOINT_SPHERICAL,
         0,
         DMB_JOINT_FREE,
         {1, 0, 0}},
        {"stone on a pivot", {1.5, 1, 0.8}, {1, 0, 0}, {0}, DMB_JOINT_SPHERICAL, 0, DMB_JOINT_FREE, {1, 0, 0}},
        {"knife edge", {2, 1, 1}, {1, 0, 0}, {0}, DMB_JOINT_REVOLUTE, 0, DMB_JOINT_KNIFE_EDGE, {1, 0, 0}},
        {"disc fixed to a string", {2, 1, 1}, {1, 0, 0}, {0}, DMB_JOINT_CYLINDRICAL, 1, DMB_JOINT_FREE, {1, 0, 0}},
        {"round, without a bearing",
         {1, 1, 2},
         {1, 0, 0},
         {0.2, 0, 0, 0, 0, 1},
         DMB_JOINT_FREE,
         0,
         DMB_JOINT_FREE,
         {1, 0, 0}},
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) check_choice(&all[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrix_is_the_derivative_by_the_increments),
        cmocka_unit_test(a_step_is_generalized_alpha_in_axes_that_do_not_spin),
        cmocka_unit_test(axes_are_those_of_bearings_and_of_revolution),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
