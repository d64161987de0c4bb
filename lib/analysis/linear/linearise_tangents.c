/* Mass, damping and stiffness from the tangents that steps solve with. */
#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "math/mat6.h"
#include "math/so3.h"
#include "system/assemble/assemble.h"

/* [s] Terms integrated over a step are separated by two steps, this one and one twice as long. So short that slips
 * remain negligible, and a power of two, so that dividing by it is exact. */
#define DMB_LINEAR_STEP 0x1p-24

static void copy_blocks(const dmb_block_layout *layout, const double *diagonal, const double *lower,
                        const double *upper, dmb_linear_matrix *to)
{
    memcpy(to->diagonal, diagonal, layout->diag[layout->n] * sizeof(double));
    memcpy(to->lower, lower, layout->link[layout->n - 1] * sizeof(double));
    memcpy(to->upper, upper, layout->link[layout->n - 1] * sizeof(double));
}

/* At increments of 0 the off-diagonal blocks are stiffness plus inertia, or inertia alone; constraint forces are
 * prescribed. */
static int32_t evaluate_tangent(dmb_linear *linear, double mass_factor, double velocity_factor, double step,
                                int32_t inertia_only)
{
    dmb_evaluation evaluation = dmb_linear_evaluation(linear);
    memset(linear->work->increment, 0, linear->rows * sizeof(double));
    evaluation.tangent = evaluation.given = 1;
    evaluation.inertia_only = inertia_only;
    evaluation.mass_factor = mass_factor;
    evaluation.velocity_factor = velocity_factor;
    evaluation.step = step;
    return dmb_system_evaluate(&evaluation);
}

int32_t dmb_linear_read_stiffness_and_mass(dmb_linear *linear)
{
    dmb_sim *work = linear->work;
    int32_t status = evaluate_tangent(linear, 0.0, 0.0, 0.0, 0);
    const dmb_linear_matrix K = dmb_linear_stiffness_of(work);
    const dmb_block_layout *layout = &linear->scene.layout;
    if (status < 0) return status;
    copy_blocks(layout, K.diagonal, K.lower, K.upper, &linear->stiffness);
    memcpy(linear->stiffness.joints, K.joints, linear->scene.tangent_count * sizeof(double));
    status = evaluate_tangent(linear, 1.0, 0.0, 0.0, 1);
    if (status < 0) return status;
    copy_blocks(layout, work->inertia_diagonal, K.lower, K.upper, &linear->mass);
    return DMB_OK;
}

/* to += factor times the tangent by velocity, which nodes and elements store with the inertia, joints with their
 * stiffness. */
static int32_t add_velocity_tangent(dmb_linear *linear, double factor, double step, dmb_linear_matrix *to)
{
    dmb_sim *work = linear->work;
    const int32_t status = evaluate_tangent(linear, 0.0, 1.0, step, 1);
    dmb_linear_matrix C = dmb_linear_stiffness_of(work);
    if (status < 0) return status;
    C.diagonal = work->inertia_diagonal;
    dmb_linear_add(&linear->scene, factor, &C, to);
    return DMB_OK;
}

static int has_integrals(const dmb_scene *scene)
{
    if (dmb_scene_has_bristles(scene) || scene->force_states > 0) return 1;
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].kind == DMB_DRIVE_CONTROL && scene->drives[i].integral_gain != 0.0) return 1;
    return 0;
}

/* Over a step h the tangent by velocity is C + h/2 S, with S the stiffness of the terms that the trapezoidal rule
 * integrates: bristles, states of the caller's forces, integral gains. Two steps give both, S is added to K. */
int32_t dmb_linear_read_damping(dmb_linear *linear)
{
    const double h = DMB_LINEAR_STEP;
    dmb_linear_matrix *C = &linear->damping, *K = &linear->stiffness;
    int32_t status;
    if (!has_integrals(&linear->scene)) {
        status = add_velocity_tangent(linear, 1.0, 0.0, C);
        dmb_linear_add_array(-1.0, K->joints, linear->scene.tangent_count, C->joints);
        return status;
    }
    /* C = 2 C(h) - C(2h) - K,   S = (C(2h) - C(h)) 2/h */
    status = add_velocity_tangent(linear, 2.0, h, C);
    if (status >= 0) status = add_velocity_tangent(linear, -1.0, 2.0 * h, C);
    dmb_linear_add_array(-1.0, K->joints, linear->scene.tangent_count, C->joints);
    if (status >= 0) status = add_velocity_tangent(linear, 2.0 / h, 2.0 * h, K);
    return status < 0 ? status : add_velocity_tangent(linear, -2.0 / h, h, K);
}

/* ---- Wall ---- */

void dmb_linear_finalise(dmb_linear *linear, const dmb_linear_options *options)
{
    if (options->contact == DMB_CONTACT_OPEN)
        linear->scene.site_count = linear->scene.inside_count = linear->scene.axial_torsional_site_count = 0;
    if (options->no_friction) linear->scene.friction_law.kind = DMB_FRICTION_NONE;
    linear->work->scene = &linear->scene;
}

/* Forces missing in the finalised scene remain as dead loads, with their stiffness in body axes, d(R^T f) = (R^T f)~
 * dtheta: the state stays an equilibrium. `before`: residual with them. */
void dmb_linear_add_dead_loads(dmb_linear *linear, const double *before)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    for (uint32_t i = 0; i < layout->n; i++) {
        double w[6];
        if (layout->size[i] != DMB_NODE_SIX_DOF) continue;
        for (uint32_t k = 0; k < 6; k++) w[k] = linear->work->residual[layout->row[i] + k] - before[layout->row[i] + k];
        dmb_mat6_add_skew(-1.0, w, 0, 1, linear->stiffness.diagonal + layout->diag[i]);
        dmb_mat6_add_skew(-1.0, w + 3, 1, 1, linear->stiffness.diagonal + layout->diag[i]);
    }
}

/* [N/m] Stiffness dN/dd of the wall at the penetration under the weight of the ring's node (at least 1 N): with N = K
 * d^n it is K n (N/K)^((n - 1)/n). A contact that does not exist has no penetration of its own to take the slope at. */
static double wall_stiffness(const dmb_scene *scene, const dmb_site *site, double depth)
{
    const double weight = fmax(scene->weight_mass[site->node] * dmb_vec3_norm(scene->gravity), 1.0);
    const dmb_normal_law law = dmb_normal_law_at(&scene->hole, &scene->normal_law, depth);
    const double K = site->length * law.stiffness, exponent = scene->normal_law.exponent;
    return K * exponent * pow(weight / K, (exponent - 1.0) / exponent);
}

/* k j j^T, j = (n; offset e_x x n) in body axes: stiffness against motion of the ring across the wall. */
static void add_wall(dmb_linear *linear, const dmb_site *site, double stiffness, const double normal[3])
{
    const double arm[3] = {site->offset, 0.0, 0.0};
    double j[6], R[9];
    dmb_quat_to_matrix(linear->work->trial.quaternion + 4 * (size_t)site->node, R);
    dmb_mat3_tvec(R, normal, j);
    dmb_vec3_cross(arm, j, j + 3);
    dmb_mat6_add_outer(stiffness, j, j, linear->stiffness.diagonal + linear->scene.layout.diag[site->node]);
}

/* The same inside an element: j = A^T (n; 0) on both of its nodes. */
static void add_wall_inside(dmb_linear *linear, uint32_t s, double stiffness, const double normal[3])
{
    const dmb_block_layout *layout = &linear->scene.layout;
    const uint32_t a = linear->scene.sites[s].node;
    double R[9], n[6] = {0.0}, j[12] = {0.0};
    dmb_point_motion motion;
    dmb_point_motion_of(&linear->scene, &linear->work->trial, dmb_inside_point(&linear->scene, s), &motion);
    memcpy(R, motion.R, sizeof R);
    dmb_mat3_tvec(R, normal, n);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 12; k++) j[k] += motion.map[12 * i + k] * n[i];
    dmb_mat6_add_outer(stiffness, j, j, linear->stiffness.diagonal + layout->diag[a]);
    dmb_mat6_add_outer(stiffness, j + 6, j + 6, linear->stiffness.diagonal + layout->diag[a + 1]);
    dmb_mat6_add_outer(stiffness, j, j + 6, linear->stiffness.upper + layout->link[a]);
    dmb_mat6_add_outer(stiffness, j + 6, j, linear->stiffness.lower + layout->link[a]);
}

double dmb_linear_wall_stiffness(const dmb_linear *linear, uint32_t s, double gap)
{
    const dmb_site *site = linear->scene.sites + s;
    const double penetration = linear->work->trial.site_penetration[s];
    if (penetration > 0.0 || site->clearance == 0.0 || penetration < -gap) return 0.0;
    return wall_stiffness(&linear->scene, site, linear->work->trial.site_depth[s]);
}

void dmb_linear_close_contacts(dmb_linear *linear, double gap)
{
    for (uint32_t s = 0; s < linear->scene.site_count; s++) {
        const double stiffness = dmb_linear_wall_stiffness(linear, s, gap);
        if (stiffness > 0.0 && dmb_is_inside(&linear->scene, s))
            add_wall_inside(linear, s, stiffness, linear->work->trial.site_normal + 3 * (size_t)s);
        else if (stiffness > 0.0)
            add_wall(linear, linear->scene.sites + s, stiffness, linear->work->trial.site_normal + 3 * (size_t)s);
    }
}

/* ---- Axes ---- */

/* to += factor A v^ in rows of six columns: row^T v^ = ad(v)^T row */
static void add_row_products(double factor, const double *A, uint32_t rows, size_t stride, const double v[6],
                             double *to)
{
    for (uint32_t r = 0; r < rows; r++) {
        double product[6];
        dmb_ad_transpose(v, A + stride * r, product);
        for (int i = 0; i < 6; i++) to[stride * r + (size_t)i] += factor * product[i];
    }
}

static void add_node_products(const dmb_scene *scene, double factor, const dmb_linear_matrix *A, const double *rows,
                              uint32_t node, dmb_linear_matrix *to)
{
    const dmb_block_layout *layout = &scene->layout;
    const double *v = rows + layout->row[node];
    add_row_products(factor, A->diagonal + layout->diag[node], 6, 6, v, to->diagonal + layout->diag[node]);
    if (node > 0)
        add_row_products(factor, A->upper + layout->link[node - 1], layout->size[node - 1], 6, v,
                         to->upper + layout->link[node - 1]);
    if (node + 1 < layout->n)
        add_row_products(factor, A->lower + layout->link[node], layout->size[node + 1], 6, v,
                         to->lower + layout->link[node]);
}

void dmb_linear_add_products(const dmb_scene *scene, double factor, const dmb_linear_matrix *A, const double *rows,
                             dmb_linear_matrix *to)
{
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->layout.size[i] == DMB_NODE_SIX_DOF) add_node_products(scene, factor, A, rows, i, to);
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->node_count; k++)
            if (scene->layout.size[c->node[k]] == DMB_NODE_SIX_DOF)
                add_row_products(factor, A->joints + c->tangent + c->column[k], c->columns, c->columns,
                                 rows + scene->layout.row[c->node[k]], to->joints + c->tangent + c->column[k]);
    }
}

/* Splits velocities into the spin w omitted by the axes of d and the remainder g, with its rate in these axes, a + w^
 * g. */
static void part_velocities(dmb_linear *linear, int32_t inertial_axes)
{
    const dmb_scene *scene = &linear->scene;
    memcpy(linear->rest, linear->work->now.velocity, linear->rows * sizeof(double));
    memcpy(linear->change, linear->work->now.acceleration, linear->rows * sizeof(double));
    for (uint32_t i = 0; inertial_axes && i < scene->node_count; i++) {
        const uint32_t row = scene->layout.row[i];
        double turned[6];
        if (scene->layout.size[i] != DMB_NODE_SIX_DOF) continue;
        linear->spin[row + 3] = linear->rest[row + 3];
        linear->rest[row + 3] = 0.0;
        dmb_ad_apply(linear->spin + row, linear->rest + row, turned);
        dmb_linear_add_array(1.0, turned, 6, linear->change + row);
    }
}

/* C and K in the axes of d (linearise.c). A constrained row has d = 0 and no v^ d, therefore its columns are cleared
 * before the products. Forces on constrained rows by the others are reactions: rows are copied before they are cleared,
 * too. Terms are added in the order in which each uses the matrices before it: -M w^ to C, then C g^ to K, then M b^ to
 * K and M g^ to C. */
void dmb_linear_turn_frames(dmb_linear *linear, int32_t inertial_axes)
{
    part_velocities(linear, inertial_axes);
    dmb_linear_keep_constrained(linear, 1);
    dmb_linear_add_whole_joints(linear, 1.0);
    dmb_linear_hold(linear, 1);
    dmb_linear_add_whole_joints(linear, -1.0); /* columns that are held are left of it */
    if (inertial_axes) dmb_linear_add_products(&linear->scene, -1.0, &linear->mass, linear->spin, &linear->damping);
    dmb_linear_add_products(&linear->scene, 1.0, &linear->damping, linear->rest, &linear->stiffness);
    dmb_linear_add_products(&linear->scene, 1.0, &linear->mass, linear->change, &linear->stiffness);
    dmb_linear_add_products(&linear->scene, 1.0, &linear->mass, linear->rest, &linear->damping);
    dmb_linear_hold(linear, 1);
    dmb_linear_keep_constrained(linear, 0);
    dmb_linear_add_whole_joints(linear, 1.0);
    dmb_linear_hold(linear, 0);
}
