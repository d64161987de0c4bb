/* Check that K does not resist the computed rigid-body motions.
 *
 * Candidates that nearly cancel leave a small motion whose stiffness is below the rounding of their terms: a rotation
 * about the axis less that of all sections is the sag of the string, rotated out of its plane. The computed motions r,
 * r_i^T M r_j = I, are therefore recombined so that r_i^T K r_j is diagonal, and those are kept for which
 *
 *     w^2 = |r^T K r| <= noise = eps sum |r_i| |K_ij| |r_j|,                         (eq:modes.rigid)
 *
 * where an error of r counts by its square only. Forces F of the state resist a rotation across their element by phi
 * with at most sum |F| h phi^2: if that is above 0 and below the noise, it is undecidable whether the motion is
 * rigid. */
#include <math.h>
#include <string.h>

#include "analysis/modes/modes.h"
#include "base/memory.h"
#include "math/bridge.h"
#include "math/dense.h"
#include "math/real.h"
#include "math/so3.h"
#include "sim/node.h"
#include "system/assemble/energy.h"

/* Factor of the state's residual forces, which rotate with a motion. */
#define DMB_RIGID_RESIDUAL 8.0
/* [-] r^T K r below this fraction of its terms is rounding. */
#define DMB_RIGID_QUOTIENT (64.0 * DBL_EPSILON)
/* [-] Resistance by forces of the state below this fraction of the noise counts as 0. */
#define DMB_RIGID_FORCELESS 1e-4

/* ---- Rounding of K d --------------------------------------------------------------------------------------------- */

/* Residual forces of the state do not count as resistance: they rotate with a motion. In rows of supports they are
 * reactions, which balance. */
static void add_unbalanced(const dmb_linear *linear, double tolerance, const double *d, double *terms)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    const uint8_t *solved = linear->scene.solved_row;
    for (uint32_t i = 0; i < layout->n; i++) {
        const uint32_t size = layout->size[i], row = layout->row[i];
        double force = 0.0, motion = 0.0;
        for (uint32_t k = 0; k < size; k++) {
            force += solved[row + k] ? fabs(linear->residual[row + k]) : 0.0;
            motion += fabs(d[row + k]);
        }
        for (uint32_t k = 0; k < size; k++) terms[row + k] += DMB_RIGID_RESIDUAL / tolerance * force * motion;
    }
}

/* Frames distribute a stiffness and its rounding over all rows of a node. */
static void add_rounding(const dmb_linear *linear, double tolerance, double *terms)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    const double arm = linear->scene.length_scale;
    for (uint32_t i = 0; i < layout->n; i++) {
        const uint32_t size = layout->size[i], row = layout->row[i];
        double most = 0.0;
        for (uint32_t k = 0; k < size; k++) most = fmax(most, terms[row + k] / (2 * k < size ? 1.0 : arm));
        most *= DMB_RIGID_AWAY / tolerance;
        for (uint32_t k = 0; k < size; k++) terms[row + k] += most * (2 * k < size ? 1.0 : arm);
    }
}

void dmb_modes_rigid_terms(dmb_linear *linear, double tolerance, const double *d, double *terms)
{
    dmb_linear_terms(linear, &linear->stiffness, d, terms);
    add_rounding(linear, tolerance, terms);
    add_unbalanced(linear, tolerance, d, terms);
}

/* ---- Motions with stiffness -------------------------------------------------------------------------------------- */

typedef struct rigid_check {
    dmb_mode_search *search;
    double tolerance; /* [-] of r^T K r, relative to its terms */
} rigid_check;

/* [1/s2] Rounding level of r^T K r. */
static double noise_of(const rigid_check *c, const double *r)
{
    dmb_linear *linear = c->search->linear;
    double *terms = c->search->work, sum = 0.0;
    dmb_modes_rigid_terms(linear, c->tolerance, r, terms);
    for (uint32_t i = 0; i < linear->rows; i++) sum += c->tolerance * fabs(r[i]) * terms[i];
    return sum;
}

static int is_resisted(const rigid_check *c, const double *r)
{
    const dmb_linear *linear = c->search->linear;
    double *Kr = c->search->work + linear->rows;
    dmb_linear_multiply(linear, &linear->stiffness, r, Kr);
    return !(fabs(dmb_dot(linear->rows, r, Kr)) <= noise_of(c, r));
}

/* Projection of K on the motions, by columns. */
static void project(const rigid_check *c, double *K)
{
    const dmb_mode_search *search = c->search;
    const size_t m = search->rigid_count, rows = search->linear->rows;
    for (size_t j = 0; j < m; j++) {
        dmb_linear_multiply(search->linear, &search->linear->stiffness, search->rigid + rows * j, search->work);
        for (size_t i = 0; i < m; i++) K[m * j + i] = dmb_dot(rows, search->rigid + rows * i, search->work);
    }
}

/* A symmetric matrix with the null space of K: its mean with K^T, or K^T K if K is not symmetric. */
static void make_symmetric(size_t m, int symmetric, const double *K, double *A)
{
    for (size_t j = 0; j < m; j++)
        for (size_t i = 0; i < m; i++)
            A[m * j + i] = symmetric ? 0.5 * (K[m * j + i] + K[m * i + j]) : dmb_dot(m, K + m * i, K + m * j);
}

/* Keeps the combinations of the motions, by the vectors Y, without stiffness; `mixed`: shape (rigid_count, rows). */
static void keep_unresisted(const rigid_check *c, const double *Y, double *mixed)
{
    dmb_mode_search *search = c->search;
    const size_t m = search->rigid_count, rows = search->linear->rows;
    memset(mixed, 0, m * rows * sizeof(double));
    for (size_t i = 0; i < m; i++)
        for (size_t j = 0; j < m; j++)
            for (size_t k = 0; k < rows; k++) mixed[rows * i + k] += Y[m * i + j] * search->rigid[rows * j + k];
    search->rigid_count = 0;
    for (size_t i = 0; i < m; i++) {
        if (is_resisted(c, mixed + rows * i)) continue;
        const size_t at = rows * search->rigid_count++;
        memcpy(search->rigid + at, mixed + rows * i, rows * sizeof(double));
        dmb_linear_multiply(search->linear, &search->linear->mass, search->rigid + at, search->rigid_momentum + at);
    }
}

/* Removes motions with a stiffness above rounding, which are vibrations. */
static int32_t leave_vibrations(const rigid_check *c)
{
    const dmb_mode_search *search = c->search;
    const dmb_allocator *allocator = &search->linear->allocator;
    const size_t m = search->rigid_count, rows = search->linear->rows, work = dmb_eigen_work(m);
    const size_t bytes = (2 * m * m + m + work + m * rows) * sizeof(double);
    uint32_t resisted = 0;
    for (size_t i = 0; i < m; i++) resisted += is_resisted(c, search->rigid + rows * i) != 0;
    if (resisted == 0) return DMB_OK;
    double *K = dmb_allocate(allocator, bytes);
    if (K == NULL) return DMB_ERR_NO_MEMORY;
    double *A = K + m * m, *values = A + m * m, *lapack = values + m;
    project(c, K);
    make_symmetric(m, search->symmetric, K, A);
    const int failed = dmb_eigen_symmetric(m, A, values, lapack) != 0;
    if (!failed) keep_unresisted(c, A, lapack + work);
    dmb_release(allocator, K, bytes);
    if (failed) dmb_message_set(search->message, "modes: the stiffness of the rigid-body motions is not finite");
    return failed ? DMB_ERR_NO_CONVERGENCE : DMB_OK;
}

/* ---- Undecidable motions ----------------------------------------------------------------------------------------- */

/* [N] Force of an element in the state, reduced by the rounding of poses. */
static double force_of(const dmb_linear *linear, uint32_t element)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_element_type *type = scene->types + scene->element_type[element];
    const uint32_t a = scene->element_node[element];
    const double stiffest = fmax(type->stiffness[0], fmax(type->stiffness[1], type->stiffness[2]));
    double force[12], rotation[9], place[3];
    dmb_node_pose(scene, &linear->work->now, a, rotation, place);
    dmb_vec3_add(place, scene->reference_position + 3 * (size_t)a, place);
    dmb_element_section_force(scene, &linear->work->now, element, force);
    return fmax(dmb_vec3_norm(force) - DMB_RIGID_AWAY * stiffest * (dmb_vec3_norm(place) + type->length), 0.0);
}

/* [1/s2] Largest resistance of a motion by forces of the state: sum |F| h phi^2. */
static double held_by_forces(const dmb_linear *linear, const double *r)
{
    const dmb_scene *scene = &linear->scene;
    double sum = 0.0;
    for (uint32_t e = 0; e < scene->element_count; e++) {
        const uint32_t a = scene->element_node[e];
        const double *phi = r + scene->layout.row[a] + 4;
        if (scene->layout.size[a] != DMB_NODE_SIX_DOF) continue;
        sum += force_of(linear, e) * scene->types[scene->element_type[e]].length * dmb_dot(2, phi, phi);
    }
    return sum;
}

/* Refuses an undecidable motion. Bands above the frequency hidden by rounding do not need it. */
static int32_t refuse_hidden(const rigid_check *c)
{
    const dmb_mode_search *search = c->search;
    const dmb_modes_options *options = search->options;
    for (uint32_t i = 0; i < search->rigid_count; i++) {
        const double *r = search->rigid + (size_t)search->linear->rows * i;
        const double noise = noise_of(c, r), forces = held_by_forces(search->linear, r), hidden = sqrt(noise);
        if (!(forces > DMB_RIGID_FORCELESS * noise) || !(forces < noise)) continue;
        if (options->select == DMB_MODES_BAND && DMB_TWO_PI * options->band[0] > hidden) continue;
        dmb_message_set(search->message,
                        "modes: forces of the state turn a motion back with up to %g Hz, and rounding of the stiffness "
                        "hides frequencies below %g Hz, as elements of %g m on average are so short: use longer "
                        "elements, or ask for a band above it",
                        sqrt(forces) / DMB_TWO_PI, hidden / DMB_TWO_PI, search->linear->scene.length_scale);
        return DMB_ERR_NO_CONVERGENCE;
    }
    return DMB_OK;
}

int32_t dmb_modes_check_rigid(dmb_mode_search *search, double away)
{
    const rigid_check c = {search, DMB_RIGID_QUOTIENT + away};
    if (search->rigid_count == 0) return DMB_OK;
    const int32_t status = leave_vibrations(&c);
    return status < 0 ? status : refuse_hidden(&c);
}
