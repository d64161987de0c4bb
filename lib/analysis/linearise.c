#include "analysis/linearise.h"

#include <string.h>

#include "base/allocator.h"
#include "base/arena.h"
#include "math/block_inertia.h"
#include "math/mat6.h"
#include "system/cluster.h"
#include "system/evaluation.h"
#include "system/solve.h"

/* [s] What is integrated over a step is told from the rest by two steps this short and twice as long: a power of two,
 * over which nothing slips far. */
#define DMB_LINEAR_STEP 0x1p-24

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static void lay_out_matrix(dmb_arena *arena, const dmb_scene *scene, dmb_linear_matrix *A)
{
    const dmb_block_layout *layout = &scene->layout;
    A->diagonal = DMB_ARENA_DOUBLES(arena, layout->diag[layout->n]);
    A->lower = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    A->upper = DMB_ARENA_DOUBLES(arena, layout->link[layout->n - 1]);
    A->joints = DMB_ARENA_DOUBLES(arena, scene->tangent_count);
}

/* Entries of R: one of an independent row, as many as its cluster has columns of a dependent one at most. */
static size_t entries_of(const dmb_scene *scene)
{
    size_t sum = scene->row_count;
    for (uint32_t k = 0; k < scene->cluster_count; k++)
        sum += (size_t)scene->clusters[k].columns * scene->clusters[k].columns;
    return sum;
}

static void lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_linear *to)
{
    const size_t rows = scene->row_count;
    lay_out_matrix(arena, scene, &to->mass);
    lay_out_matrix(arena, scene, &to->damping);
    lay_out_matrix(arena, scene, &to->stiffness);
    to->unbalanced = DMB_ARENA_DOUBLES(arena, rows);
    to->row_of = DMB_ARENA_ARRAY(arena, uint32_t, rows);
    to->start = DMB_ARENA_ARRAY(arena, uint32_t, rows + 1);
    to->column = DMB_ARENA_ARRAY(arena, uint32_t, entries_of(scene));
    to->value = DMB_ARENA_DOUBLES(arena, entries_of(scene));
    to->held_columns = DMB_ARENA_DOUBLES(arena, 54 * (size_t)scene->held_count);
    to->held_rows = DMB_ARENA_DOUBLES(arena, 54 * (size_t)scene->held_count);
    to->whole_joints = DMB_ARENA_DOUBLES(arena, 3 * (size_t)scene->tangent_count);
}

static dmb_linear *allocate(const dmb_sim *sim)
{
    dmb_arena arena;
    dmb_linear nowhere;
    dmb_linear *linear = dmb_allocate(&sim->allocator, sizeof *linear);
    if (linear == NULL) return NULL;
    linear->allocator = sim->allocator;
    linear->scene = *sim->scene;
    linear->rows = sim->scene->row_count;
    dmb_arena_count(&arena);
    lay_out(&arena, sim->scene, &nowhere);
    linear->block_size = dmb_arena_block_size(&arena);
    if (!arena.overflow) linear->block = dmb_allocate(&sim->allocator, linear->block_size);
    if (linear->block != NULL) linear->work = dmb_state_copy(sim);
    if (linear->work == NULL) {
        dmb_linear_release(&linear);
        return NULL;
    }
    dmb_arena_place(&arena, linear->block, linear->block_size);
    lay_out(&arena, sim->scene, linear);
    return linear;
}

void dmb_linear_release(dmb_linear **linear)
{
    if (*linear == NULL) return;
    const dmb_allocator allocator = (*linear)->allocator;
    dmb_state_discard((*linear)->work);
    dmb_release(&allocator, (*linear)->block, (*linear)->block_size);
    dmb_release(&allocator, *linear, sizeof **linear);
    *linear = NULL;
}

/* ---- Balance ----------------------------------------------------------------------------------------------------- */

static dmb_evaluation evaluation_of(dmb_sim *work)
{
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = work;
    evaluation.time = work->clock->time;
    evaluation.pseudo_factor = 1.0;
    evaluation.load_factor = 1.0;
    evaluation.dynamic = 1;
    return evaluation;
}

/* Largest force on a solved row; moments over the length of the chain. */
static void find_largest(dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const uint32_t size = scene->layout.size[i], row = scene->layout.row[i];
        const double arm = 1.0 / scene->chains[scene->node_chain[i]].length;
        for (uint32_t c = 0; c < size; c++) {
            const double force = fabs(linear->unbalanced[row + c]) * (2 * c < size ? 1.0 : arm);
            if (!scene->solved_row[row + c] || !(force > linear->largest_force)) continue;
            linear->largest_force = force;
            linear->largest_node = i;
        }
    }
}

/* In an equilibrium, at rest or turning, body-frame velocities stay as they are: what forces leave then is out of
 * balance. */
static int32_t take_balance(dmb_linear *linear)
{
    dmb_sim *work = linear->work;
    dmb_evaluation evaluation = evaluation_of(work);
    memset(work->trial.acceleration, 0, linear->rows * sizeof(double));
    const int32_t status = dmb_system_evaluate(&evaluation);
    memcpy(work->trial.acceleration, work->now.acceleration, linear->rows * sizeof(double));
    if (status < 0) return status;
    const dmb_residual_norm norm = dmb_residual_norm_of(&evaluation, DMB_LINEAR_BALANCED);
    linear->unbalance = norm.relative;
    linear->balanced = norm.converged != 0;
    memcpy(linear->unbalanced, work->correction, linear->rows * sizeof(double));
    find_largest(linear);
    return DMB_OK;
}

/* The partition of the state, its rows and factors; and the forces of constraint, which the tangents take as given. */
static int32_t settle(dmb_sim *work)
{
    dmb_evaluation evaluation = evaluation_of(work);
    memset(work->increment, 0, work->scene->row_count * sizeof(double));
    work->linked_mode->row = UINT32_MAX;
    return work->scene->cluster_count ? dmb_clusters_settle(&evaluation, 0, 0) : DMB_OK;
}

static int32_t take_multipliers(dmb_sim *work)
{
    dmb_evaluation evaluation = evaluation_of(work);
    return work->scene->cluster_count ? dmb_system_evaluate(&evaluation) : DMB_OK;
}

/* ---- Matrices ---------------------------------------------------------------------------------------------------- */

static void copy_blocks(const dmb_block_layout *layout, const double *diagonal, const double *lower,
                        const double *upper, dmb_linear_matrix *to)
{
    memcpy(to->diagonal, diagonal, layout->diag[layout->n] * sizeof(double));
    memcpy(to->lower, lower, layout->link[layout->n - 1] * sizeof(double));
    memcpy(to->upper, upper, layout->link[layout->n - 1] * sizeof(double));
}

static void add_array(double factor, const double *from, size_t count, double *to)
{
    for (size_t i = 0; i < count; i++) to[i] += factor * from[i];
}

static void add_blocks(const dmb_scene *scene, double factor, const dmb_linear_matrix *from, dmb_linear_matrix *to)
{
    const dmb_block_layout *layout = &scene->layout;
    add_array(factor, from->diagonal, layout->diag[layout->n], to->diagonal);
    add_array(factor, from->lower, layout->link[layout->n - 1], to->lower);
    add_array(factor, from->upper, layout->link[layout->n - 1], to->upper);
    add_array(factor, from->joints, scene->tangent_count, to->joints);
}

static dmb_linear_matrix stiffness_of(const dmb_sim *work)
{
    const dmb_linear_matrix A = {work->stiffness_diagonal, work->stiffness_lower, work->stiffness_upper,
                                 work->constraint_tangent};
    return A;
}

/* At increments of 0 the links hold stiffness plus inertia, or inertia alone. */
static int32_t evaluate_tangent(dmb_linear *linear, double mass_factor, double velocity_factor, double step,
                                int32_t inertia_only)
{
    dmb_evaluation evaluation = evaluation_of(linear->work);
    memset(linear->work->increment, 0, linear->rows * sizeof(double));
    evaluation.tangent = 1;
    evaluation.inertia_only = inertia_only;
    evaluation.mass_factor = mass_factor;
    evaluation.velocity_factor = velocity_factor;
    evaluation.step = step;
    return dmb_system_evaluate(&evaluation);
}

static int32_t take_stiffness_and_mass(dmb_linear *linear)
{
    dmb_sim *work = linear->work;
    int32_t status = evaluate_tangent(linear, 0.0, 0.0, 0.0, 0);
    const dmb_linear_matrix K = stiffness_of(work);
    const dmb_block_layout *layout = &linear->scene.layout;
    if (status < 0) return status;
    copy_blocks(layout, K.diagonal, K.lower, K.upper, &linear->stiffness);
    memcpy(linear->stiffness.joints, K.joints, linear->scene.tangent_count * sizeof(double));
    status = evaluate_tangent(linear, 1.0, 0.0, 0.0, 1);
    if (status < 0) return status;
    copy_blocks(layout, work->inertia_diagonal, K.lower, K.upper, &linear->mass);
    return DMB_OK;
}

/* The tangent by velocity: nodes and elements keep it with the inertia, joints with their stiffness. */
static int32_t add_velocity_tangent(dmb_linear *linear, double factor, double step, dmb_linear_matrix *to)
{
    dmb_sim *work = linear->work;
    const int32_t status = evaluate_tangent(linear, 0.0, 1.0, step, 1);
    dmb_linear_matrix C = stiffness_of(work);
    if (status < 0) return status;
    C.diagonal = work->inertia_diagonal;
    add_blocks(&linear->scene, factor, &C, to);
    return DMB_OK;
}

static int has_integrals(const dmb_scene *scene)
{
    if (scene->friction_law.kind == DMB_FRICTION_BRISTLE) return 1;
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].kind == DMB_DRIVE_CONTROL && scene->drives[i].integral_gain != 0.0) return 1;
    return 0;
}

/* Over a step h the tangent by velocity is C + h/2 S, S being the stiffness of what the trapezoidal rule integrates. */
static int32_t take_damping(dmb_linear *linear)
{
    const double h = DMB_LINEAR_STEP;
    dmb_linear_matrix *C = &linear->damping, *K = &linear->stiffness;
    int32_t status;
    if (!has_integrals(&linear->scene)) {
        status = add_velocity_tangent(linear, 1.0, 0.0, C);
        add_array(-1.0, K->joints, linear->scene.tangent_count, C->joints);
        return status;
    }
    /* C = 2 C(h) - C(2h) - K,   S = (C(2h) - C(h)) 2/h */
    status = add_velocity_tangent(linear, 2.0, h, C);
    if (status >= 0) status = add_velocity_tangent(linear, -1.0, 2.0 * h, C);
    add_array(-1.0, K->joints, linear->scene.tangent_count, C->joints);
    if (status >= 0) status = add_velocity_tangent(linear, 2.0 / h, 2.0 * h, K);
    return status < 0 ? status : add_velocity_tangent(linear, -2.0 / h, h, K);
}

/* ---- The turning frame ------------------------------------------------------------------------------------------- */

/* to += A v^ in rows of six columns: row^T v^ = ad(v)^T row */
static void add_row_products(const double *A, uint32_t rows, size_t stride, const double v[6], double *to)
{
    for (uint32_t r = 0; r < rows; r++) {
        double product[6];
        dmb_ad_transpose(v, A + stride * r, product);
        for (int i = 0; i < 6; i++) to[stride * r + (size_t)i] += product[i];
    }
}

static void add_node_products(const dmb_scene *scene, const dmb_linear_matrix *A, const double *rows, uint32_t node,
                              dmb_linear_matrix *to)
{
    const dmb_block_layout *layout = &scene->layout;
    const double *v = rows + layout->row[node];
    add_row_products(A->diagonal + layout->diag[node], 6, 6, v, to->diagonal + layout->diag[node]);
    if (node > 0)
        add_row_products(A->upper + layout->link[node - 1], layout->size[node - 1], 6, v,
                         to->upper + layout->link[node - 1]);
    if (node + 1 < layout->n)
        add_row_products(A->lower + layout->link[node], layout->size[node + 1], 6, v, to->lower + layout->link[node]);
}

/* to += A blkdiag(v^), v by rows; a PATH node turns about its own axis alone and has none. */
static void add_products(const dmb_scene *scene, const dmb_linear_matrix *A, const double *rows, dmb_linear_matrix *to)
{
    for (uint32_t i = 0; i < scene->node_count; i++)
        if (scene->layout.size[i] == DMB_NODE_FULL) add_node_products(scene, A, rows, i, to);
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->node_count; k++)
            if (scene->layout.size[c->node[k]] == DMB_NODE_FULL)
                add_row_products(A->joints + c->tangent + c->column[k], c->columns, c->columns,
                                 rows + scene->layout.row[c->node[k]], to->joints + c->tangent + c->column[k]);
    }
}

/* ---- Wall -------------------------------------------------------------------------------------------------------- */

static void freeze(dmb_linear *linear, const dmb_linear_options *options)
{
    if (options->contact == DMB_LINEAR_CONTACT_OPEN) linear->scene.site_count = linear->scene.path_site_count = 0;
    if (options->no_friction) linear->scene.friction_law.kind = DMB_FRICTION_NONE;
    linear->work->scene = &linear->scene;
}

/* Forces that the frozen scene lacks stay as dead loads, with what they add to the stiffness by the body turning under
 * them, d(R^T f) = (R^T f)~ dtheta: the state is the same equilibrium. `before`: residual with them. */
static void add_dead_loads(dmb_linear *linear, const double *before)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    for (uint32_t i = 0; i < layout->n; i++) {
        double w[6];
        if (layout->size[i] != DMB_NODE_FULL) continue;
        for (uint32_t k = 0; k < 6; k++)
            w[k] = linear->work->correction[layout->row[i] + k] - before[layout->row[i] + k];
        dmb_mat6_add_skew(-1.0, w, 0, 1, linear->stiffness.diagonal + layout->diag[i]);
        dmb_mat6_add_skew(-1.0, w + 3, 1, 1, linear->stiffness.diagonal + layout->diag[i]);
    }
}

/* [N/m] of the wall under a ring that carries the weight of its node, a newton at least. */
static double wall_stiffness(const dmb_scene *scene, const dmb_site *site)
{
    const double weight = fmax(scene->weight_mass[site->node] * dmb_vec3_norm(scene->gravity), 1.0);
    const double K = site->length * scene->normal_law.stiffness, exponent = scene->normal_law.exponent;
    return K * exponent * pow(weight / K, (exponent - 1.0) / exponent);
}

/* k j j^T, j = (n; offset e_x x n) in body axes: the ring may not move across the wall. */
static void add_wall(dmb_linear *linear, const dmb_site *site, const double normal[3])
{
    const double arm[3] = {site->offset, 0.0, 0.0};
    double j[6];
    dmb_mat3_tvec(linear->work->rotation + 9 * (size_t)site->node, normal, j);
    dmb_vec3_cross(arm, j, j + 3);
    dmb_mat6_add_outer(wall_stiffness(&linear->scene, site), j, j,
                       linear->stiffness.diagonal + linear->scene.layout.diag[site->node]);
}

static void close_contacts(dmb_linear *linear, double gap)
{
    const dmb_configuration *trial = &linear->work->trial;
    for (uint32_t s = 0; s < linear->scene.site_count; s++) {
        const dmb_site *site = linear->scene.sites + s;
        if (trial->site_penetration[s] > 0.0 || site->clearance == 0.0 || trial->site_penetration[s] < -gap) continue;
        add_wall(linear, site, trial->site_normal + 3 * (size_t)s);
    }
}

/* ---- Rows that are held ------------------------------------------------------------------------------------------ */

static void clear_row(double *block, uint32_t columns, uint32_t row)
{
    memset(block + (size_t)columns * row, 0, columns * sizeof(double));
}

static void clear_column(double *block, uint32_t rows, uint32_t columns, uint32_t column)
{
    for (uint32_t r = 0; r < rows; r++) block[(size_t)columns * r + column] = 0.0;
}

static void clear_rows_of(const dmb_block_layout *layout, uint32_t node, uint32_t c, dmb_linear_matrix *A)
{
    clear_row(A->diagonal + layout->diag[node], layout->size[node], c);
    if (node > 0) clear_row(A->lower + layout->link[node - 1], layout->size[node - 1], c);
    if (node + 1 < layout->n) clear_row(A->upper + layout->link[node], layout->size[node + 1], c);
}

static void clear_columns_of(const dmb_block_layout *layout, uint32_t node, uint32_t c, dmb_linear_matrix *A)
{
    const uint32_t size = layout->size[node];
    clear_column(A->diagonal + layout->diag[node], size, size, c);
    if (node > 0) clear_column(A->upper + layout->link[node - 1], layout->size[node - 1], size, c);
    if (node + 1 < layout->n) clear_column(A->lower + layout->link[node], layout->size[node + 1], size, c);
}

static void clear_in_joint(const dmb_scene *scene, const dmb_constraint *c, int columns, double *joint)
{
    for (uint32_t k = 0; k < c->node_count; k++)
        for (uint32_t r = 0; r < scene->layout.size[c->node[k]]; r++) {
            if (scene->solved_row[scene->layout.row[c->node[k]] + r]) continue;
            if (columns)
                clear_column(joint, c->columns, c->columns, c->column[k] + r);
            else
                clear_row(joint, c->columns, c->column[k] + r);
        }
}

static void copy_column(const double *block, uint32_t rows, uint32_t columns, uint32_t c, double *to)
{
    for (uint32_t r = 0; r < rows; r++) to[r] = block[(size_t)columns * r + c];
}

static void copy_row(const double *block, uint32_t columns, uint32_t c, double *to)
{
    memcpy(to, block + (size_t)columns * c, columns * sizeof(double));
}

/* Before the columns are cleared. */
static void keep_column(const dmb_block_layout *layout, uint32_t node, uint32_t c, const dmb_linear_matrix *A,
                        double *to)
{
    const uint32_t size = layout->size[node];
    copy_column(A->diagonal + layout->diag[node], size, size, c, to + 6);
    if (node > 0) copy_column(A->upper + layout->link[node - 1], layout->size[node - 1], size, c, to);
    if (node + 1 < layout->n) copy_column(A->lower + layout->link[node], layout->size[node + 1], size, c, to + 12);
}

/* Likewise. */
static void keep_row(const dmb_block_layout *layout, uint32_t node, uint32_t c, const dmb_linear_matrix *A, double *to)
{
    copy_row(A->diagonal + layout->diag[node], layout->size[node], c, to + 6);
    if (node > 0) copy_row(A->lower + layout->link[node - 1], layout->size[node - 1], c, to);
    if (node + 1 < layout->n) copy_row(A->upper + layout->link[node], layout->size[node + 1], c, to + 12);
}

/* Columns, or rows, of what is held. */
static void keep_held(dmb_linear *linear, int columns)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_linear_matrix *all[3] = {&linear->mass, &linear->damping, &linear->stiffness};
    double *lines = columns ? linear->held_columns : linear->held_rows;
    for (uint32_t i = 0; i < scene->held_count; i++)
        for (size_t m = 0; m < 3; m++)
            (columns ? keep_column : keep_row)(&scene->layout, scene->held_node[i], scene->held_component[i], all[m],
                                               lines + 54 * (size_t)i + 18 * m);
}

static void add_whole_joints(dmb_linear *linear, double factor)
{
    const dmb_linear_matrix *all[3] = {&linear->mass, &linear->damping, &linear->stiffness};
    const size_t count = linear->scene.tangent_count;
    for (size_t m = 0; m < 3; m++) add_array(factor, all[m]->joints, count, linear->whole_joints + m * count);
}

static void hold(dmb_linear *linear, int columns)
{
    const dmb_scene *scene = &linear->scene;
    dmb_linear_matrix *all[3] = {&linear->mass, &linear->damping, &linear->stiffness};
    for (int m = 0; m < 3; m++) {
        for (uint32_t i = 0; i < scene->held_count; i++)
            (columns ? clear_columns_of : clear_rows_of)(&scene->layout, scene->held_node[i], scene->held_component[i],
                                                         all[m]);
        for (uint32_t i = 0; i < scene->constraint_count; i++)
            clear_in_joint(scene, scene->constraints + i, columns, all[m]->joints + scene->constraints[i].tangent);
    }
}

/* ---- Coordinates ------------------------------------------------------------------------------------------------- */

/* Marks in `column` (shape (rows), to begin with) the rows that joints make dependent, and makes G of each cluster. */
static void find_dependent(dmb_linear *linear, uint8_t *dependent)
{
    dmb_sim *work = linear->work;
    for (uint32_t k = 0; k < linear->scene.cluster_count; k++) {
        const dmb_cluster *cluster = linear->scene.clusters + k;
        const dmb_partition partition = dmb_cluster_partition(work, k);
        dmb_partition_null_space(work->cluster_matrix + cluster->dense, cluster->columns, &partition,
                                 work->cluster_lu + cluster->square, work->cluster_pivot + cluster->row,
                                 work->cluster_null + cluster->dense);
        for (uint32_t i = 0; i < partition.rank; i++)
            dependent[linear->scene.cluster_columns[cluster->column + partition.column_order[i]]] = 1;
    }
}

/* The row of G of a dependent row, as entries of R; number_of: coordinate of each row. */
static uint32_t put_dependent(const dmb_linear *linear, uint32_t k, uint32_t place, const uint32_t *number_of,
                              uint32_t at)
{
    const dmb_cluster *cluster = linear->scene.clusters + k;
    const dmb_partition partition = dmb_cluster_partition(linear->work, k);
    const uint32_t width = partition.columns - partition.rank;
    const double *G = linear->work->cluster_null + cluster->dense + (size_t)place * width;
    for (uint32_t m = 0; m < width; m++) {
        const uint32_t row =
            linear->scene.cluster_columns[cluster->column + partition.column_order[partition.rank + m]];
        if (!linear->scene.solved_row[row] || G[m] == 0.0) continue;
        linear->column[at] = number_of[row];
        linear->value[at++] = G[m];
    }
    return at;
}

static uint32_t put_row(const dmb_linear *linear, uint32_t node, uint32_t c, const uint8_t *dependent,
                        const uint32_t *number_of, uint32_t at)
{
    const dmb_scene *scene = &linear->scene;
    const uint32_t row = scene->layout.row[node] + c;
    if (!scene->solved_row[row]) return at;
    if (!dependent[row]) {
        linear->column[at] = number_of[row];
        linear->value[at] = 1.0;
        return at + 1;
    }
    const uint32_t k = scene->node_cluster[node];
    const uint32_t place = linear->work->cluster_place[scene->clusters[k].column + scene->node_place[node] + c];
    return put_dependent(linear, k, place, number_of, at);
}

static int32_t make_coordinates(dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    const size_t rows = linear->rows, bytes = rows * (sizeof(uint32_t) + 1);
    uint32_t *number_of = dmb_allocate(&linear->allocator, bytes), at = 0;
    if (number_of == NULL) return DMB_ERR_NO_MEMORY;
    uint8_t *dependent = (uint8_t *)(number_of + rows);
    find_dependent(linear, dependent);
    for (uint32_t r = 0; r < rows; r++) {
        if (dependent[r] || !scene->solved_row[r]) continue;
        number_of[r] = linear->coordinates;
        linear->row_of[linear->coordinates++] = r;
    }
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++) {
            linear->start[scene->layout.row[i] + c] = at;
            at = put_row(linear, i, c, dependent, number_of, at);
        }
    linear->start[rows] = at;
    dmb_release(&linear->allocator, number_of, bytes);
    return DMB_OK;
}

/* ---- Making ------------------------------------------------------------------------------------------------------ */

static int32_t take_matrices(dmb_linear *linear, const dmb_linear_options *options)
{
    dmb_sim *work = linear->work;
    dmb_evaluation evaluation = evaluation_of(work);
    double *before = work->trial.pseudo_acceleration; /* which no force depends on */
    work->linked_mode->multipliers = 1;               /* they are given */
    int32_t status = dmb_system_evaluate(&evaluation);
    memcpy(before, work->correction, linear->rows * sizeof(double));
    freeze(linear, options);
    if (status >= 0) status = take_stiffness_and_mass(linear);
    if (status >= 0) add_dead_loads(linear, before);
    if (status >= 0 && options->contact == DMB_LINEAR_CONTACT_CLOSED) close_contacts(linear, options->gap);
    return status < 0 ? status : take_damping(linear);
}

/* C += M v^, K += C_v v^ + M a^: a row that is held has no d, nor any v^ d, but what the others do to it counts. */
static void turn_frames(dmb_linear *linear)
{
    dmb_sim *work = linear->work;
    keep_held(linear, 1);
    add_whole_joints(linear, 1.0);
    hold(linear, 1);
    add_whole_joints(linear, -1.0); /* columns that are held are left of it */
    add_products(&linear->scene, &linear->damping, work->now.velocity, &linear->stiffness);
    add_products(&linear->scene, &linear->mass, work->now.acceleration, &linear->stiffness);
    add_products(&linear->scene, &linear->mass, work->now.velocity, &linear->damping);
    hold(linear, 1);
    keep_held(linear, 0);
    add_whole_joints(linear, 1.0);
    hold(linear, 0);
}

static int32_t linearise(dmb_linear *linear, const dmb_linear_options *options)
{
    dmb_sim *work = linear->work;
    int32_t status = settle(work);
    if (status >= 0) status = take_balance(linear);
    if (status >= 0) status = take_multipliers(work);
    if (status >= 0) status = take_matrices(linear, options);
    work->linked_mode->multipliers = 0;
    if (status < 0) return status;
    turn_frames(linear);
    return make_coordinates(linear);
}

int32_t dmb_linear_make(const dmb_sim *sim, const dmb_linear_options *options, dmb_linear **linear)
{
    *linear = allocate(sim);
    if (*linear == NULL) return DMB_ERR_NO_MEMORY;
    const int32_t status = linearise(*linear, options);
    if (status < 0) dmb_linear_release(linear);
    return status;
}

/* ---- Products ---------------------------------------------------------------------------------------------------- */

static void add_joint_products(const dmb_scene *scene, const double *joints, const double *x, double *y)
{
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        const double *A = joints + c->tangent;
        double part[DMB_CONSTRAINT_COLUMNS];
        for (uint32_t k = 0; k < c->node_count; k++)
            memcpy(part + c->column[k], x + scene->layout.row[c->node[k]],
                   scene->layout.size[c->node[k]] * sizeof(double));
        for (uint32_t k = 0; k < c->node_count; k++)
            for (uint32_t r = 0; r < scene->layout.size[c->node[k]]; r++) {
                const double *row = A + (size_t)(c->column[k] + r) * c->columns;
                for (uint32_t s = 0; s < c->columns; s++) y[scene->layout.row[c->node[k]] + r] += row[s] * part[s];
            }
    }
}

void dmb_linear_multiply(const dmb_linear *linear, const dmb_linear_matrix *A, const double *x, double *y)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_block_matrix blocks = {A->diagonal, A->lower, A->upper, NULL};
    for (uint32_t c = 0; c < scene->chain_count; c++)
        dmb_block_multiply(&scene->layout, &blocks, scene->chains[c].first, scene->chains[c].count, x, y);
    add_joint_products(scene, A->joints, x, y);
}

void dmb_linear_expand(const dmb_linear *linear, const double *z, double *d)
{
    for (uint32_t r = 0; r < linear->rows; r++) {
        d[r] = 0.0;
        for (uint32_t i = linear->start[r]; i < linear->start[r + 1]; i++)
            d[r] += linear->value[i] * z[linear->column[i]];
    }
}

void dmb_linear_restrict(const dmb_linear *linear, const double *f, double *g)
{
    memset(g, 0, linear->coordinates * sizeof(double));
    for (uint32_t r = 0; r < linear->rows; r++)
        for (uint32_t i = linear->start[r]; i < linear->start[r + 1]; i++)
            g[linear->column[i]] += linear->value[i] * f[r];
}

void dmb_linear_dense(const dmb_linear *linear, const dmb_linear_matrix *A, double *work, double *out)
{
    const size_t n = linear->coordinates, rows = linear->rows;
    double *x = work, *y = work + rows, *unit = work + 2 * rows;
    memset(unit, 0, n * sizeof(double));
    for (size_t i = 0; i < n; i++) {
        unit[i] = 1.0;
        dmb_linear_expand(linear, unit, x);
        dmb_linear_multiply(linear, A, x, y);
        dmb_linear_restrict(linear, y, out + n * i);
        unit[i] = 0.0;
    }
}

/* +-1 by a linear congruential generator, over the root of the diagonal; 0 where there is none. */
static void draw_signs(const dmb_linear *linear, const dmb_linear_matrix *A, uint64_t *seed, double *x)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    for (uint32_t i = 0; i < layout->n; i++)
        for (uint32_t c = 0; c < layout->size[i]; c++) {
            const double size = fabs(A->diagonal[layout->diag[i] + (layout->size[i] + 1) * c]);
            *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            x[layout->row[i] + c] = size > 0.0 ? ((*seed >> 40 & 1) != 0 ? 1.0 : -1.0) / sqrt(size) : 0.0;
        }
}

/* Signs on the coordinates, carried on to the rows that joints make dependent. */
static void draw(const dmb_linear *linear, const dmb_linear_matrix *A, uint64_t *seed, double *z, double *x)
{
    draw_signs(linear, A, seed, x);
    for (uint32_t i = 0; i < linear->coordinates; i++) z[i] = x[linear->row_of[i]];
    dmb_linear_expand(linear, z, x);
}

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

double dmb_linear_asymmetry(const dmb_linear *linear, const dmb_linear_matrix *A, double *work)
{
    const size_t rows = linear->rows;
    double *x = work, *y = x + rows, *product = y + rows, *z = product + rows, most = 0.0;
    uint64_t seed = 1;
    for (int k = 0; k < 4; k++) {
        draw(linear, A, &seed, z, x);
        draw(linear, A, &seed, z, y);
        dmb_linear_multiply(linear, A, y, product);
        const double one = dot(rows, x, product);
        dmb_linear_multiply(linear, A, x, product);
        most = fmax(most, fabs(one - dot(rows, y, product)));
    }
    return most / sqrt(1.0 + linear->coordinates);
}

/* ---- Factors ----------------------------------------------------------------------------------------------------- */

/* k K + c C + m M in the blocks of `work`, ones where rows are held. */
static dmb_linear_matrix combine(dmb_linear *linear, double k, double c, double m)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_block_layout *layout = &scene->layout;
    dmb_linear_matrix to = stiffness_of(linear->work);
    memset(to.diagonal, 0, layout->diag[layout->n] * sizeof(double));
    memset(to.lower, 0, layout->link[layout->n - 1] * sizeof(double));
    memset(to.upper, 0, layout->link[layout->n - 1] * sizeof(double));
    memset(to.joints, 0, scene->tangent_count * sizeof(double));
    if (k != 0.0) add_blocks(scene, k, &linear->stiffness, &to);
    if (c != 0.0) add_blocks(scene, c, &linear->damping, &to);
    if (m != 0.0) add_blocks(scene, m, &linear->mass, &to);
    for (uint32_t i = 0; i < scene->held_count; i++) {
        const uint32_t node = scene->held_node[i];
        to.diagonal[layout->diag[node] + (layout->size[node] + 1) * scene->held_component[i]] = 1.0;
    }
    return to;
}

int64_t dmb_linear_factor(dmb_linear *linear, double k, double c, double m, dmb_block_weakest *weakest)
{
    dmb_block_weakest unused;
    (void)combine(linear, k, c, m);
    return dmb_factor_stiffness(linear->work, weakest != NULL ? weakest : &unused);
}

uint32_t dmb_linear_count_below(dmb_linear *linear, double square)
{
    const dmb_scene *scene = &linear->scene;
    const dmb_linear_matrix A = combine(linear, 1.0, 0.0, -square);
    uint32_t count = 0;
    for (uint32_t c = 0; c < scene->chain_count; c++)
        count += dmb_block_negative(&scene->layout, A.diagonal, A.lower, A.upper, NULL, scene->chains[c].first,
                                    scene->chains[c].count);
    return count;
}

void dmb_linear_solve(dmb_linear *linear, double *x)
{
    double *correction = linear->work->correction; /* solves for its negative */
    for (uint32_t r = 0; r < linear->rows; r++) correction[r] = -x[r];
    dmb_solve_correction(linear->work);
    memcpy(x, correction, linear->rows * sizeof(double));
}
