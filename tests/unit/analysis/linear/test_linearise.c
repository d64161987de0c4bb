/* The linear system about a state: its matrices against differences of the residual along random perturbed motions,
 * symmetry and definiteness, what the wall and friction do to it, and its prediction against a run in time. Equations:
 * eq:modes.linear, eq:modes.still-axes. */
#include <string.h>

#include "../../system/stirred_rig.h"
#include "mechanism.h"

#include "analysis/linear/linear.h"
#include "math/se3.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/constrain.h"
#include "system/system.h"

enum { ROWS_MAX = 120 };

static const dmb_linear_options as_it_is = {.contact = DMB_CONTACT_AS_IS};

static dmb_linear *linearise(const dmb_sim *sim, const dmb_linear_options *options)
{
    dmb_linear *linear = NULL;
    uint64_t before, after;
    assert_int_equal(dmb_sim_hash(sim, &before), DMB_OK);
    assert_int_equal(dmb_linear_make(sim, options, &linear), DMB_OK);
    assert_int_equal(dmb_sim_hash(sim, &after), DMB_OK);
    assert_true(before == after);
    assert_true(linear->rows <= ROWS_MAX);
    return linear;
}

/* ---- Differences of the residual --------------------------------------------------------------------------------- */

/* A perturbed motion: d, d' and d'' of the coordinates, by rows. */
typedef struct perturbation {
    double d[ROWS_MAX], rate[ROWS_MAX], second[ROWS_MAX];
} perturbation;

static void draw_rows(const dmb_linear *linear, uint64_t *seed, double *rows)
{
    double z[ROWS_MAX];
    for (uint32_t i = 0; i < linear->coordinates; i++) z[i] = draw_between(seed, -1.0, 1.0);
    dmb_linear_expand(linear, z, rows);
}

/* v^ x of every FULL node added to `to` */
static void add_turning(const dmb_linear *linear, const double *v, const double *x, double factor, double *to)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    for (uint32_t i = 0; i < layout->n; i++) {
        double product[6];
        if (layout->size[i] != DMB_NODE_SIX_DOF) continue;
        dmb_ad_apply(v + layout->row[i], x + layout->row[i], product);
        for (uint32_t k = 0; k < 6; k++) to[layout->row[i] + k] += factor * product[k];
    }
}

static void move_nodes(dmb_sim *work, const double *d, double e)
{
    const dmb_scene *scene = work->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        double h[6];
        const double *x = d + scene->layout.row[i];
        if (scene->layout.size[i] == DMB_NODE_AXIAL_TORSIONAL) {
            work->trial.displacement[3 * i] = work->now.displacement[3 * i] + e * x[0];
            work->trial.turn[i] = work->now.turn[i] + e * x[1];
            continue;
        }
        memcpy(work->trial.displacement + 3 * i, work->now.displacement + 3 * i, 3 * sizeof(double));
        memcpy(work->trial.quaternion + 4 * i, work->now.quaternion + 4 * i, 4 * sizeof(double));
        for (int k = 0; k < 6; k++) h[k] = e * x[k];
        dmb_se3_advance(work->trial.quaternion + 4 * i, work->trial.displacement + 3 * i, h);
    }
}

/* Controllers have integrated the displacement along. */
static void move_integrals(dmb_sim *work, const dmb_sim *sim, const double *d, double e)
{
    for (uint32_t i = 0; i < work->scene->drive_count; i++)
        if (work->scene->drives[i].kind == DMB_DRIVE_CONTROL)
            work->now.drives[i].integral = sim->now.drives[i].integral - e * d[work->scene->drives[i].row];
}

/* R^T residual of the state perturbed by e, forces of constraint kept. */
static void residual_at(dmb_linear *linear, const dmb_sim *sim, const perturbation *p, double e, double *g)
{
    dmb_sim *work = linear->work;
    const uint32_t rows = linear->rows;
    double rate[ROWS_MAX] = {0.0}, second[ROWS_MAX] = {0.0};
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = work;
    evaluation.time = work->clock->time;
    evaluation.load_factor = 1.0;
    evaluation.dynamic = 1;
    memcpy(rate, p->rate, rows * sizeof(double));
    memcpy(second, p->second, rows * sizeof(double));
    add_turning(linear, work->now.velocity, p->d, 1.0, rate);
    add_turning(linear, work->now.velocity, p->rate, 1.0, second);
    add_turning(linear, work->now.acceleration, p->d, 1.0, second);
    move_nodes(work, p->d, e);
    for (uint32_t i = 0; i < rows; i++) {
        const int solved = linear->scene.solved_row[i];
        work->trial.velocity[i] = work->now.velocity[i] + (solved ? e * rate[i] : 0.0);
        work->trial.acceleration[i] = work->now.acceleration[i] + (solved ? e * second[i] : 0.0);
    }
    move_integrals(work, sim, p->d, e);
    for (uint32_t i = 0; i < rows; i++) work->increment[i] = e * p->d[i]; /* turns of bits follow it */
    evaluation.given = 1;
    if (work->scene->cluster_count) assert_int_equal(dmb_clusters_assemble(&evaluation), DMB_OK);
    assert_int_equal(dmb_system_evaluate(&evaluation), DMB_OK);
    for (uint32_t i = 0; i < rows; i++)
        if (!linear->scene.solved_row[i]) work->residual[i] = 0.0;
    dmb_linear_restrict(linear, work->residual, g);
}

static void add_restricted(const dmb_linear *linear, const dmb_linear_matrix *A, const double *x, double *g)
{
    double y[ROWS_MAX] = {0.0}, part[ROWS_MAX];
    dmb_linear_multiply(linear, A, x, y);
    dmb_linear_restrict(linear, y, part);
    for (uint32_t i = 0; i < linear->coordinates; i++) g[i] += part[i];
}

static double violation_of(dmb_linear *linear, const dmb_sim *sim, uint64_t *seed)
{
    perturbation p;
    double f[6][ROWS_MAX], predicted[ROWS_MAX] = {0.0}, violation = 0.0;
    const double h = 2e-5;
    draw_rows(linear, seed, p.d);
    draw_rows(linear, seed, p.rate);
    draw_rows(linear, seed, p.second);
    for (int k = 0; k < 6; k++) residual_at(linear, sim, &p, h * difference6_place[k], f[k]);
    add_restricted(linear, &linear->stiffness, p.d, predicted);
    add_restricted(linear, &linear->damping, p.rate, predicted);
    add_restricted(linear, &linear->mass, p.second, predicted);
    for (uint32_t i = 0; i < linear->coordinates; i++) {
        const double six[6] = {f[0][i], f[1][i], f[2][i], f[3][i], f[4][i], f[5][i]};
        violation = fmax(violation, fabs(difference6(six, h) - predicted[i]));
    }
    return violation / largest(linear->coordinates, predicted);
}

static double largest_violation(dmb_linear *linear, const dmb_sim *sim)
{
    uint64_t seed = 5;
    double worst = 0.0;
    for (int k = 0; k < 5; k++) worst = fmax(worst, violation_of(linear, sim, &seed));
    return worst;
}

static void check_stirred(const char *what, const full_rig_choice *choice)
{
    rig s;
    full_rig_open(&s, choice);
    stir(&s, 11);
    dmb_linear *linear = linearise(s.sim, &as_it_is);
    check_below(what, largest_violation(linear, s.sim), 1e-8);
    dmb_linear_release(&linear);
    rig_close(&s);
}

static void matrices_are_derivatives_of_the_residual(void **state)
{
    (void)state;
    const full_rig_choice stribeck = {DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, 0, 1, 0, 0};
    const full_rig_choice ambrosio = {DMB_FRICTION_AMBROSIO, DMB_NORMAL_IMPACT, DMB_ROCK_NONE, 0, 0, 0, 0};
    const full_rig_choice curved = {DMB_FRICTION_COULOMB, DMB_NORMAL_KELVIN_VOIGT, DMB_ROCK_NONE, 1, 0, 1, 0};
    check_stirred("moving, in contact with friction and on rock", &stribeck);
    check_stirred("moving, other laws, on two rows a node in part", &ambrosio);
    check_stirred("moving, in a curved hole", &curved);
}

/* Three bars: a hinge on the ground, a universal joint, a spring in a free joint and a ball; in motion. */
static void open_mechanism(rig *s)
{
    const bar bars[3] = {{{0, 0}, {1, 0.5}, 2.0}, {{1, 0.5}, {2, 0}, 3.0}, {{2, 0}, {2.5, -1}, 1.0}};
    dmb_id part[3];
    rig_open(s, 0, 0, -9.81);
    for (int i = 0; i < 3; i++) part[i] = add_bar(s, bars + i);
    const double half[3] = {0.5 * hypot(1, 0.5), 0.5 * hypot(1, 0.5), 0.5 * hypot(0.5, 1)};
    dmb_joint_def first = hinge_of("first", DMB_JOINT_REVOLUTE, pin_ground(0, 0), pin_on(part[0], -half[0]));
    dmb_joint_def third = hinge_of("ball", DMB_JOINT_SPHERICAL, pin_on(part[1], half[1]), pin_on(part[2], -half[2]));
    first.initial_mask = DMB_FREE_RX;
    first.initial_speed[DMB_RX] = 2.0;
    first.stiffness[DMB_RX] = 30.0;
    first.damping[DMB_RX] = 2.0;
    third.initial_mask = DMB_FREE_SPHERICAL;
    third.initial_speed[DMB_RY] = 1.5;
    third.initial_speed[DMB_RX] = -1.0;
    third.stiffness[DMB_RX] = third.stiffness[DMB_RZ] = 8.0;
    (void)add_joint(s, &first);
    (void)add_hinge(s, "second", DMB_JOINT_UNIVERSAL, pin_on(part[0], half[0]), pin_on(part[1], -half[1]));
    (void)add_joint(s, &third);
    (void)mechanism_start(s, NULL);
}

static void matrices_are_derivatives_with_joints(void **state)
{
    (void)state;
    rig s;
    open_mechanism(&s);
    take_steps(&s, 0.01, 7);
    dmb_linear *linear = linearise(s.sim, &as_it_is);
    assert_int_equal(linear->coordinates, 1 + 2 + 3);
    check_below("three bars in motion", largest_violation(linear, s.sim), 1e-8);
    dmb_linear_release(&linear);
    rig_close(&s);
}

/* ---- Symmetry, definiteness, factors ----------------------------------------------------------------------------- */

/* Smallest pivot of Cholesky over the diagonal entry it came from; <= 0: not positive definite. */
static double smallest_pivot(uint32_t n, double *A)
{
    double least = 1.0;
    for (uint32_t k = 0; k < n; k++) {
        const double before = A[k * n + k];
        for (uint32_t j = 0; j < k; j++) A[k * n + k] -= A[j * n + k] * A[j * n + k];
        least = fmin(least, A[k * n + k] / before);
        const double root = sqrt(A[k * n + k]);
        for (uint32_t i = k; i < n; i++) {
            for (uint32_t j = 0; j < k && i > k; j++) A[k * n + i] -= A[j * n + i] * A[j * n + k];
            A[k * n + i] = i == k ? root : A[k * n + i] / root;
        }
    }
    return least;
}

static double asymmetry(uint32_t n, const double *A)
{
    double most = 0.0, size = 0.0;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++) {
            most = fmax(most, fabs(A[i * n + j] - A[j * n + i]) / sqrt(fabs(A[i * n + i] * A[j * n + j])));
            size = fmax(size, fabs(A[i * n + j]));
        }
    return size > 0.0 ? most : 0.0;
}

static void mass_is_positive_and_symmetric(void **state)
{
    (void)state;
    const full_rig_choice choice = {DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, 0, 1, 0, 0};
    static double A[ROWS_MAX * ROWS_MAX], work[3 * ROWS_MAX];
    for (int joints = 0; joints < 2; joints++) {
        rig s;
        if (joints)
            open_mechanism(&s);
        else
            full_rig_open(&s, &choice);
        dmb_linear *linear = linearise(s.sim, &as_it_is);
        dmb_linear_dense(linear, &linear->mass, work, A);
        check_below("asymmetry of M", asymmetry(linear->coordinates, A), 1e-14);
        const double pivot = smallest_pivot(linear->coordinates, A);
        tell("smallest pivot of M over its diagonal", pivot);
        assert_true(pivot > 1e-6);
        dmb_linear_release(&linear);
        rig_close(&s);
    }
}

/* Ten pipes in the 94 mm hole, rig end held, weight on the wall. */
static void open_lying_string(rig *s, int32_t friction_law)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    wall.friction_law = friction_law;
    rig_open(s, 0, 0, -9.81);
    add_wall(s, &wall);
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(s, &string);
    (void)add_pipes(s, &pipe, 10);
    rig_start(s, NULL);
}

static void stiffness_at_rest_is_symmetric(void **state)
{
    (void)state;
    static double work[4 * ROWS_MAX];
    rig s;
    open_lying_string(&s, DMB_FRICTION_NONE);
    dmb_linear *linear = linearise(s.sim, &as_it_is);
    tell("residual of the string as described", linear->relative_residual);
    tell("its largest force [N]", linear->largest_force);
    assert_int_equal(linear->balanced, 0);
    dmb_linear_release(&linear);
    (void)find_equilibrium(&s, NULL);
    linear = linearise(s.sim, &as_it_is);
    tell("residual of the string at rest", linear->relative_residual);
    assert_int_equal(linear->balanced, 1);
    check_below("asymmetry of K at rest on the wall", dmb_linear_asymmetry(linear, work), 1e-11);
    dmb_linear_release(&linear);
    rig_close(&s);
}

static double factored_violation(dmb_linear *linear, double k, double c, double m)
{
    uint64_t seed = 3;
    double x[ROWS_MAX], y[ROWS_MAX] = {0.0}, sum[ROWS_MAX] = {0.0}, g[ROWS_MAX], z[ROWS_MAX];
    const dmb_linear_matrix *A[3] = {&linear->stiffness, &linear->damping, &linear->mass};
    const double factor[3] = {k, c, m};
    draw_rows(linear, &seed, x);
    for (int i = 0; i < 3; i++) {
        dmb_linear_multiply(linear, A[i], x, y);
        for (uint32_t r = 0; r < linear->rows; r++) sum[r] += factor[i] * y[r];
    }
    assert_true(dmb_linear_factor(linear, k, c, m, NULL) < 0);
    dmb_linear_solve(linear, sum);
    for (uint32_t i = 0; i < linear->coordinates; i++) g[i] = x[linear->row_of[i]], z[i] = sum[linear->row_of[i]];
    return largest_difference(linear->coordinates, g, z);
}

static void factors_solve(void **state)
{
    (void)state;
    rig s;
    open_lying_string(&s, DMB_FRICTION_NONE);
    (void)find_equilibrium(&s, NULL);
    dmb_linear *linear = linearise(s.sim, &as_it_is);
    check_below("K + 10 C + 100 M of a string", factored_violation(linear, 1.0, 10.0, 100.0), 1e-9);
    dmb_linear_release(&linear);
    rig_close(&s);
    open_mechanism(&s);
    linear = linearise(s.sim, &as_it_is);
    check_below("K + 10 C + 100 M of a mechanism", factored_violation(linear, 1.0, 10.0, 100.0), 1e-12);
    dmb_linear_release(&linear);
    rig_close(&s);
}

/* ---- Wall and friction ------------------------------------------------------------------------------------------- */

/* A body of 2 kg that lies in a wide hole, free to move across it and along: K of the wall across, and along it. */
static void open_lying_body(rig *s, int32_t friction_law)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, 0, 0, -9.81);
    wall.diameter = 4.0;
    wall.friction_law = friction_law;
    wall.bristle_damping = 0.5;
    add_wall(s, &wall);
    body.mass = 2.0;
    body.contact_diameter = 0.2;
    body.position[2] = -1.9;
    body.free_mask = DMB_FREE_TRANSLATIONS;
    (void)add_body(s, &body);
    rig_start(s, NULL);
}

static void sticking_bristles_are_springs(void **state)
{
    (void)state;
    rig s;
    open_lying_body(&s, DMB_FRICTION_BRISTLE);
    (void)find_equilibrium(&s, NULL);
    take_steps(&s, 1e-3, 3); /* from the first step on it sticks */
    dmb_linear *linear = linearise(s.sim, &as_it_is);
    const double N = 2.0 * 9.81;
    check_relative("stiffness along the wall, N sigma0", linear->stiffness.diagonal[0], N * 1e4, 1e-6);
    check_relative("damping along the wall, N sigma1", linear->damping.diagonal[0], N * 0.5, 1e-6);
    check_relative("stiffness across", linear->stiffness.diagonal[14], 1e7, 1e-6);
    dmb_linear_release(&linear);
    const dmb_linear_options frictionless = {.no_friction = 1};
    linear = linearise(s.sim, &frictionless);
    check_below("the same without friction", linear->stiffness.diagonal[0], 0.0);
    dmb_linear_release(&linear);
    rig_close(&s);
}

/* Smooth friction is a damper mu N/v_eps at rest; the pendulum in the hole swings on N/e = m g/distance. */
static void smooth_friction_is_a_damper(void **state)
{
    (void)state;
    rig s;
    open_lying_body(&s, DMB_FRICTION_COULOMB);
    (void)find_equilibrium(&s, NULL);
    dmb_linear *linear = linearise(s.sim, &as_it_is);
    const double N = 2.0 * 9.81, e = 1.9 + N / 1e7;
    check_relative("damping along the wall, mu N/v_eps", linear->damping.diagonal[0], 0.3 * N / 1e-3, 1e-9);
    check_relative("stiffness sideways, N/e", linear->stiffness.diagonal[7], N / e, 1e-9);
    dmb_linear_release(&linear);
    rig_close(&s);
}

static void contacts_are_frozen(void **state)
{
    (void)state;
    rig s;
    const dmb_linear_options open = {.contact = DMB_CONTACT_OPEN};
    const dmb_linear_options closed = {.contact = DMB_CONTACT_CLOSED, .gap = 0.2};
    open_lying_body(&s, DMB_FRICTION_NONE); /* 0.1 mm less than the sink away from the wall: just touching */
    dmb_linear *linear = linearise(s.sim, &closed);
    check_relative("held across from the gap", linear->stiffness.diagonal[14], 1e7, 1e-9);
    dmb_linear_release(&linear);
    (void)find_equilibrium(&s, NULL);
    linear = linearise(s.sim, &open);
    check_below("nothing holds where the wall is left out", largest(36, linear->stiffness.diagonal), 0.0);
    assert_int_equal(linear->balanced, 1); /* the state itself is an equilibrium */
    dmb_linear_release(&linear);
    rig_close(&s);
}

/* ---- A run in time ----------------------------------------------------------------------------------------------- */

enum { MOTION_ROWS = 18 };

/* d after `time` by the linear system, by the classical Runge-Kutta method on M d'' = -C d' - K d. */
static void acceleration_of(dmb_linear *linear, const double *d, const double *rate, double *out)
{
    double y[ROWS_MAX] = {0.0};
    dmb_linear_multiply(linear, &linear->stiffness, d, out);
    dmb_linear_multiply(linear, &linear->damping, rate, y);
    for (uint32_t i = 0; i < linear->rows; i++) out[i] = -out[i] - y[i];
    dmb_linear_solve(linear, out);
}

static void predict(dmb_linear *linear, double h, uint32_t steps, double *d, double *rate)
{
    const uint32_t n = linear->rows;
    assert_true(dmb_linear_factor(linear, 0.0, 0.0, 1.0, NULL) < 0);
    for (uint32_t k = 0; k < steps; k++) {
        const double part[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1 / 6., 1 / 3., 1 / 3., 1 / 6.};
        double x[MOTION_ROWS], v[MOTION_ROWS], a[MOTION_ROWS] = {0.0}, dx[MOTION_ROWS] = {0.0}, dv[MOTION_ROWS] = {0.0};
        double last[MOTION_ROWS] = {0.0};
        for (int j = 0; j < 4; j++) {
            for (uint32_t i = 0; i < n; i++) {
                x[i] = d[i] + part[j] * h * (j == 0 ? 0.0 : last[i]);
                v[i] = rate[i] + part[j] * h * a[i];
            }
            acceleration_of(linear, x, v, a);
            for (uint32_t i = 0; i < n; i++) {
                dx[i] += weight[j] * h * v[i];
                dv[i] += weight[j] * h * a[i];
                last[i] = v[i];
            }
        }
        for (uint32_t i = 0; i < n; i++) d[i] += dx[i], rate[i] += dv[i];
    }
}

/* A free pipe of two soft elements that spins fast, with an eccentric disc at its end, which it turns about askew. */
static void open_spinning_pipe(rig *s, double spin)
{
    dmb_pipe_def pipe = beam_pipe(2.0, 2, 4e4, 2e4, 300.0, 400.0);
    dmb_string_def string = dmb_string_def_default();
    pipe.section_mass = 3.0;
    pipe.section_inertia[0] = 0.02;
    pipe.section_inertia[1] = 0.01;
    pipe.damping_time = 1e-3;
    rig_open(s, 0, 0, 0);
    string.start_free = DMB_FREE_ALL;
    string.velocity[0] = 0.4;
    string.velocity[3] = spin;
    pipe.string = add_string(s, &string);
    (void)add_pipes(s, &pipe, 1);
    const dmb_sim_options options = sharp_options(1.0, 1e-13);
    rig_start(s, &options);
}

static void perturb(dmb_sim *sim, const double *d, const double *rate, double e)
{
    double moved[MOTION_ROWS];
    move_nodes(sim, d, e);
    memcpy(moved, rate, sizeof moved);
    for (uint32_t i = 0; i < 3; i++) {
        double product[6];
        dmb_ad_apply(sim->now.velocity + 6 * i, d + 6 * i, product);
        for (uint32_t k = 0; k < 6; k++) moved[6 * i + k] += product[k];
    }
    memcpy(sim->now.displacement, sim->trial.displacement, 9 * sizeof(double));
    memcpy(sim->now.quaternion, sim->trial.quaternion, 12 * sizeof(double));
    for (uint32_t i = 0; i < MOTION_ROWS; i++) sim->now.velocity[i] += e * moved[i];
    assert_true(dmb_system_restart(sim) >= 0);
}

/* log(H^-1 H1) of the nodes of two sims */
static void difference_of(const dmb_sim *a, const dmb_sim *b, double *d)
{
    for (uint32_t i = 0; i < 3; i++) {
        double R[9], q[4], x[3], u[3];
        dmb_quat_to_matrix(a->now.quaternion + 4 * i, R);
        dmb_vec3_sub(b->now.displacement + 3 * i, a->now.displacement + 3 * i, x);
        dmb_mat3_tvec(R, x, u);
        dmb_quat_between(a->now.quaternion + 4 * i, b->now.quaternion + 4 * i, q);
        dmb_so3_inverse_coefficients k;
        dmb_se3_log_from_quat(q, u, &k, d + 6 * i);
    }
}

/* The difference of two runs, over the size of the perturbation, is the motion of the linear system, but for terms of
 * second order in it, which two signs take out. */
static void a_run_follows_the_linear_system(void **state)
{
    (void)state;
    double d[2][MOTION_ROWS], rate0[MOTION_ROWS], d0[MOTION_ROWS], predicted[MOTION_ROWS], rate[MOTION_ROWS];
    const double e = 1e-5, T = 0.1, h = 5e-5;
    uint64_t seed = 9;
    for (uint32_t i = 0; i < MOTION_ROWS; i++) {
        d0[i] = draw_between(&seed, -0.1, 0.1);
        rate0[i] = draw_between(&seed, -5.0, 5.0);
    }
    for (int sign = 0; sign < 2; sign++) {
        rig s, t;
        open_spinning_pipe(&s, 25.0);
        open_spinning_pipe(&t, 25.0);
        if (sign == 0) {
            dmb_linear *linear = linearise(s.sim, &as_it_is);
            assert_int_equal(linear->balanced, 1);
            memcpy(predicted, d0, sizeof d0);
            memcpy(rate, rate0, sizeof rate0);
            predict(linear, 2e-5, 5000, predicted, rate);
            dmb_linear_release(&linear);
        }
        perturb(t.sim, d0, rate0, sign == 0 ? e : -e);
        take_steps(&s, h, (uint32_t)(T / h + 0.5));
        take_steps(&t, h, (uint32_t)(T / h + 0.5));
        difference_of(s.sim, t.sim, d[sign]);
        rig_close(&s);
        rig_close(&t);
    }
    for (uint32_t i = 0; i < MOTION_ROWS; i++) d[0][i] = (d[0][i] - d[1][i]) / (2.0 * e);
    tell("largest displacement over the perturbation", largest(MOTION_ROWS, d[0]));
    check_below("run of 0.4 turns against the linear system",
                largest_difference(MOTION_ROWS, d[0], predicted) / largest(MOTION_ROWS, predicted), 2e-5);
}

/* ---- Asymmetry --------------------------------------------------------------------------------------------------- */

/* Two strings in a row on a universal joint, with so many elements: a torque through it, whose axis turns with neither,
 * is not symmetric between two coordinates alone. */
static double asymmetry_under(uint32_t first, uint32_t second, double torque)
{
    rig s;
    double work[4 * 400];
    dmb_linear *linear = NULL;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(1.0, first, 2e8, 8e7, 1.5e5, 2e5);
    dmb_load_def load = dmb_load_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_NONE;
    const dmb_id one = pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    string.start_free = DMB_FREE_ALL;
    string.position[0] = 1.0;
    const dmb_id two = pipe.string = add_string(&s, &string);
    pipe.elements = second;
    (void)add_pipes(&s, &pipe, 1);
    joint.kind = DMB_JOINT_UNIVERSAL;
    joint.place_a = dmb_station(one, 0, 1.0);
    joint.place_b = dmb_station(two, 0, 0.0);
    joint.stiffness[DMB_RY] = joint.stiffness[DMB_RZ] = 6e3;
    (void)add_joint(&s, &joint);
    load.place = dmb_station(two, 0, 1.0);
    load.moment[0] = torque;
    (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    must(&s, dmb_analysis_static(s.sim, NULL, NULL));
    assert_int_equal(dmb_linear_make(s.sim, &as_it_is, &linear), DMB_OK);
    assert_true(4 * (size_t)linear->rows <= sizeof work / sizeof work[0]);
    const double asymmetry = dmb_linear_asymmetry(linear, work);
    dmb_linear_release(&linear);
    rig_close(&s);
    return asymmetry;
}

/* However the coordinates lie, it is seen. */
static void asymmetry_of_two_coordinates_is_seen(void **state)
{
    (void)state;
    double least = 1.0, most = 0.0;
    for (uint32_t first = 1; first <= 8; first++)
        for (uint32_t second = 1; second <= 8; second++) {
            least = fmin(least, asymmetry_under(first, second, 1e3));
            most = fmax(most, asymmetry_under(first, second, 0.0));
        }
    check_below("least under 1 kN m, inverse", 1.0 / least, 1e6);
    check_below("most without torque", most, 1e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrices_are_derivatives_of_the_residual),
        cmocka_unit_test(matrices_are_derivatives_with_joints),
        cmocka_unit_test(mass_is_positive_and_symmetric),
        cmocka_unit_test(stiffness_at_rest_is_symmetric),
        cmocka_unit_test(factors_solve),
        cmocka_unit_test(sticking_bristles_are_springs),
        cmocka_unit_test(smooth_friction_is_a_damper),
        cmocka_unit_test(contacts_are_frozen),
        cmocka_unit_test(a_run_follows_the_linear_system),
        cmocka_unit_test(asymmetry_of_two_coordinates_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
