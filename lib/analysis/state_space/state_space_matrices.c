/* M, C and K of a linear system by all rows, and the Jacobian of its constraints, as sparse rows: the system before
 * constrained rows are removed and joints reduced. A linear system stores the forces of a constrained row separately:
 * its column in constrained_columns, its row in constrained_rows, six entries each of the node before, of the node and
 * of the node after, for M, C and K one after the other. */
#include <string.h>

#include "analysis/linear/linear.h"
#include "analysis/state_space/state_space.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "drillmbd/analyse.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "query/query.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/constrain.h"
#include "system/system.h"

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

/* Counts entries in a first pass, and stores them in a second. */
typedef struct builder {
    const dmb_linear *linear;
    dmb_sparse_rows *to;
    uint32_t *mark, *held; /* row + 1 in which a column last occurred; index of a constrained row; shape (rows) */
    uint32_t *at;          /* position of the column in the present row, shape (rows) */
    uint32_t used, row;
    int32_t placing;
} builder;

/* An entry of the present row. Joints reach a column again that the chain has reached before: `mark` contains the row
 * in which a column occurred last, and the entry is added there. */
static void add_entry(builder *b, uint32_t column, const double entry[3])
{
    if (b->mark[column] != b->row + 1) {
        b->mark[column] = b->row + 1;
        b->at[column] = b->used++;
        if (b->placing) b->to->column[b->at[column]] = column;
    }
    if (!b->placing) return;
    for (uint32_t k = 0; k < b->to->kinds && k < 3; k++) b->to->value[k][b->at[column]] += entry[k];
}

/* Constrained columns take precedence: an entry of two constrained rows is in the column of the second, because columns
 * were kept (dmb_linear_keep_constrained) and cleared before rows were. 54 = 3 matrices of 3 blocks of 6 entries. */
static void add_block_entry(builder *b, uint32_t i, uint32_t r, uint32_t j, uint32_t c)
{
    const dmb_linear *l = b->linear;
    const dmb_scene *scene = &l->scene;
    const dmb_block_layout *layout = &scene->layout;
    const dmb_linear_matrix *all[3] = {&l->mass, &l->damping, &l->stiffness};
    const uint32_t row = layout->row[i] + r, column = layout->row[j] + c;
    const size_t at = (size_t)layout->size[j] * r + c;
    double entry[3];
    for (int k = 0; k < 3; k++) {
        if (!scene->solved_row[column])
            entry[k] = l->constrained_columns[54 * (size_t)b->held[column] + 18 * (size_t)k + 6 * (i + 1 - j) + r];
        else if (!scene->solved_row[row])
            entry[k] = l->constrained_rows[54 * (size_t)b->held[row] + 18 * (size_t)k + 6 * (j + 1 - i) + c];
        else if (i == j)
            entry[k] = all[k]->diagonal[layout->diag[i] + at];
        else
            entry[k] = j > i ? all[k]->upper[layout->link[i] + at] : all[k]->lower[layout->link[j] + at];
    }
    add_entry(b, column, entry);
}

static void add_joint_entries(builder *b, const dmb_constraint *c, uint32_t a, uint32_t r)
{
    const dmb_scene *scene = &b->linear->scene;
    const size_t count = scene->tangent_count;
    for (uint32_t n = 0; n < c->node_count; n++)
        for (uint32_t q = 0; q < scene->layout.size[c->node[n]]; q++) {
            const size_t at = c->tangent + (size_t)(c->column[a] + r) * c->columns + c->column[n] + q;
            const double *joints = b->linear->whole_joints + at;
            const double entry[3] = {joints[0], joints[count], joints[2 * count]};
            add_entry(b, scene->layout.row[c->node[n]] + q, entry);
        }
}

/* Entries of a row: neighbours in the chain, then all nodes of the constraints at this node. */
static void add_row(builder *b, uint32_t node, uint32_t r)
{
    const dmb_scene *scene = &b->linear->scene;
    for (uint32_t j = node > 0 ? node - 1 : node; j <= node + 1 && j < scene->node_count; j++) {
        if (scene->node_chain[j] != scene->node_chain[node]) continue;
        for (uint32_t c = 0; c < scene->layout.size[j]; c++) add_block_entry(b, node, r, j, c);
    }
    if (scene->cluster_count == 0 || scene->node_cluster[node] == DMB_NONE) return;
    const dmb_cluster *cluster = scene->clusters + scene->node_cluster[node];
    for (uint32_t i = cluster->constraint; i < cluster->constraint + cluster->constraint_count; i++)
        for (uint32_t a = 0; a < scene->constraints[i].node_count; a++)
            if (scene->constraints[i].node[a] == node) add_joint_entries(b, scene->constraints + i, a, r);
}

static void add_rows(builder *b)
{
    const dmb_scene *scene = &b->linear->scene;
    memset(b->mark, 0, scene->row_count * sizeof *b->mark);
    b->used = 0;
    for (uint32_t node = 0; node < scene->node_count; node++)
        for (uint32_t r = 0; r < scene->layout.size[node]; r++) {
            b->row = scene->layout.row[node] + r;
            if (b->placing) b->to->start[b->row] = b->used;
            add_row(b, node, r);
        }
}

/* Adds the active equations, numbered by the rows of all constraints. Rows that are switched off (open joints,
 * couplings without effect) are omitted, so that the numbers are those of dmb_analysis_array's multipliers. */
static void add_equations(builder *b)
{
    const dmb_scene *scene = &b->linear->scene;
    const dmb_sim *work = b->linear->work;
    memset(b->mark, 0, scene->row_count * sizeof *b->mark);
    b->used = b->row = 0;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const dmb_cluster *cluster = scene->clusters + k;
        const double *B = work->cluster_matrix + cluster->dense;
        for (uint32_t i = 0; i < cluster->rows; i++) {
            if (work->constraint_type[cluster->row + i] == DMB_ROW_IDLE) continue;
            if (b->placing) b->to->start[b->row] = b->used;
            for (uint32_t c = 0; c < cluster->columns; c++) {
                const double entry[3] = {B[(size_t)i * cluster->columns + c], 0.0, 0.0};
                if (entry[0] != 0.0) add_entry(b, scene->cluster_columns[cluster->column + c], entry);
            }
            b->row++;
        }
    }
}

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static void *read_array(const dmb_allocator *allocator, size_t count, size_t size)
{
    return dmb_allocate_array(allocator, count > 0 ? count : 1, size);
}

static int32_t make_room(const dmb_allocator *allocator, uint32_t rows, uint32_t used, dmb_sparse_rows *out)
{
    out->rows = rows;
    out->start = read_array(allocator, (size_t)rows + 1, sizeof *out->start);
    if (out->start == NULL) return DMB_ERR_NO_MEMORY;
    out->start[rows] = used;
    out->column = read_array(allocator, used, sizeof *out->column);
    for (uint32_t k = 0; k < out->kinds && out->column != NULL; k++) {
        out->value[k] = read_array(allocator, used, sizeof(double));
        if (out->value[k] == NULL) return DMB_ERR_NO_MEMORY;
    }
    return out->column != NULL ? DMB_OK : DMB_ERR_NO_MEMORY;
}

static void give_back(const dmb_allocator *allocator, void *array, size_t count, size_t size)
{
    if (array != NULL) dmb_release(allocator, array, (count > 0 ? count : 1) * size);
}

void dmb_sparse_rows_release(const dmb_allocator *allocator, dmb_sparse_rows *sparse)
{
    const size_t used = sparse->start != NULL ? sparse->start[sparse->rows] : 0;
    for (uint32_t k = 0; k < 3; k++) give_back(allocator, sparse->value[k], used, sizeof(double));
    give_back(allocator, sparse->column, used, sizeof *sparse->column);
    give_back(allocator, sparse->start, (size_t)sparse->rows + 1, sizeof *sparse->start);
    memset(sparse, 0, sizeof *sparse);
}

/* Two passes with the same code: the first one counts the entries, the second one stores them. `mark` holds the row in
 * which a column was met last, so that a new row needs no clearing: the cost is that of the entries. The matrices have
 * all rows of the scene, the Jacobian (one kind) as many as add_equations has met. */
static int32_t build(const dmb_linear *linear, void (*add)(builder *), uint32_t kinds, dmb_sparse_rows *out)
{
    const dmb_scene *scene = &linear->scene;
    const size_t rows = scene->row_count, bytes = 3 * rows * sizeof(uint32_t);
    uint32_t *places = dmb_allocate(&linear->allocator, bytes);
    builder b = {.linear = linear, .to = out};
    memset(out, 0, sizeof *out);
    if (places == NULL) return DMB_ERR_NO_MEMORY;
    out->kinds = kinds;
    b.mark = places;
    b.at = places + rows;
    b.held = places + 2 * rows;
    for (uint32_t i = 0; i < scene->constrained_count; i++) b.held[dmb_constrained_row(scene, i)] = i;
    add(&b);
    const uint32_t count = kinds > 1 ? (uint32_t)rows : b.row;
    const int32_t status = make_room(&linear->allocator, count, b.used, out);
    b.placing = 1;
    if (status >= 0) add(&b);
    if (status < 0) dmb_sparse_rows_release(&linear->allocator, out);
    dmb_release(&linear->allocator, places, bytes);
    return status;
}

int32_t dmb_whole_matrices(const dmb_linear *linear, dmb_sparse_rows *out)
{
    return build(linear, add_rows, 3, out);
}

int32_t dmb_whole_jacobian(const dmb_linear *linear, dmb_sparse_rows *out)
{
    return build(linear, add_equations, 1, out);
}

/* ---- Products ---------------------------------------------------------------------------------------------------- */

void dmb_sparse_times(const dmb_sparse_rows *sparse, int kind, const double *x, double *y)
{
    for (uint32_t r = 0; r < sparse->rows; r++) {
        double sum = 0.0;
        for (uint32_t i = sparse->start[r]; i < sparse->start[r + 1]; i++)
            sum += sparse->value[kind][i] * x[sparse->column[i]];
        y[r] = sum;
    }
}

void dmb_sparse_add_transposed(const dmb_sparse_rows *sparse, int kind, const double *x, double *y)
{
    for (uint32_t r = 0; r < sparse->rows; r++) {
        if (x[r] == 0.0) continue;
        for (uint32_t i = sparse->start[r]; i < sparse->start[r + 1]; i++)
            y[sparse->column[i]] += sparse->value[kind][i] * x[r];
    }
}

/* ---- Arrays ------------------------------------------------------------------------------------------------------ */

/* State of a sim as arrays, and places as functions of rows. */

/* Multipliers of the active equations, in the order of the Jacobian: constraints are in the order of their rows. */
static uint64_t put_multipliers(const dmb_sim *sim, double *values)
{
    const dmb_scene *scene = sim->scene;
    uint64_t used = 0;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const uint32_t active = dmb_constraint_active(sim, i);
        for (uint32_t k = 0; k < active && values != NULL; k++)
            values[used + k] = sim->now.multiplier[scene->constraints[i].row + k];
        used += active;
    }
    return used;
}

static void put_positions(const dmb_sim *sim, double *values)
{
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        double R[9], u[3];
        dmb_node_pose(sim->scene, &sim->now, i, R, u);
        dmb_vec3_add(u, sim->scene->reference_position + 3 * (size_t)i, values + 3 * (size_t)i);
    }
}

static void put_quaternions(const dmb_sim *sim, double *values)
{
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        double R[9], u[3];
        dmb_node_pose(sim->scene, &sim->now, i, R, u);
        dmb_quat_from_matrix(R, values + 4 * (size_t)i);
    }
}

/* Residual with prescribed constraint forces of 0: what forces and inertia leave over by all rows, which the
 * multipliers balance through the transposed Jacobian. */
static int32_t put_residual(dmb_sim *sim, double *values)
{
    dmb_sim *copy = dmb_state_copy(sim);
    dmb_evaluation evaluation;
    if (copy == NULL) return DMB_ERR_NO_MEMORY;
    memset(&evaluation, 0, sizeof evaluation);
    dmb_clusters_clear_multipliers(copy);
    evaluation.sim = copy;
    evaluation.time = copy->clock->time;
    evaluation.pseudo_factor = 1.0;
    evaluation.load_factor = 1.0;
    evaluation.dynamic = evaluation.given = 1;
    const int32_t status = dmb_system_evaluate(&evaluation);
    if (status >= 0) memcpy(values, copy->residual, sim->scene->row_count * sizeof(double));
    dmb_state_discard(copy);
    return status;
}

/* Multipliers have no length of the scene: joints that lock or open change the number of active equations. */
static uint64_t length_of(const dmb_sim *sim, int32_t array)
{
    if (array == DMB_ARRAY_POSITION) return 3 * (uint64_t)sim->scene->node_count;
    if (array == DMB_ARRAY_QUATERNION) return 4 * (uint64_t)sim->scene->node_count;
    return array == DMB_ARRAY_MULTIPLIER ? put_multipliers(sim, NULL) : sim->scene->row_count;
}

static int32_t put_array(dmb_sim *sim, int32_t array, double *values)
{
    const size_t bytes = sim->scene->row_count * sizeof(double);
    if (array == DMB_ARRAY_VELOCITY) memcpy(values, sim->now.velocity, bytes);
    if (array == DMB_ARRAY_ACCELERATION) memcpy(values, sim->now.acceleration, bytes);
    if (array == DMB_ARRAY_POSITION) put_positions(sim, values);
    if (array == DMB_ARRAY_QUATERNION) put_quaternions(sim, values);
    if (array == DMB_ARRAY_MULTIPLIER) (void)put_multipliers(sim, values);
    return array == DMB_ARRAY_RESIDUAL ? put_residual(sim, values) : DMB_OK;
}

static int32_t answer_array(dmb_sim *sim, int32_t array, double *values, uint64_t *count)
{
    if (array < DMB_ARRAY_VELOCITY || array > DMB_ARRAY_RESIDUAL) {
        dmb_message_set(&sim->message, "array = %d, must be DMB_ARRAY_VELOCITY .. _RESIDUAL", (int)array);
        return DMB_ERR_VALUE;
    }
    const uint64_t length = length_of(sim, array);
    if (values != NULL && *count < length) {
        dmb_message_set(&sim->message, "array: *count = %llu, must be >= %llu, the length that NULL returns",
                        (unsigned long long)*count, (unsigned long long)length);
        return DMB_ERR_VALUE;
    }
    int32_t status = DMB_OK;
    if (values != NULL && array == DMB_ARRAY_RESIDUAL) status = dmb_state_copy_check(sim, "array");
    if (values != NULL && status >= 0) status = put_array(sim, array, values);
    if (status >= 0) *count = length;
    return status < 0 ? status : DMB_OK;
}

int32_t dmb_analysis_array(dmb_sim *sim, int32_t array, double *values, uint64_t *count)
{
    if (sim == NULL || count == NULL) return dmb_sim_failed(sim, "array", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, answer_array(sim, array, values, count));
}

/* ---- Places ------------------------------------------------------------------------------------------------------ */

static int32_t refuse_place(dmb_sim *sim, dmb_place place, int32_t status)
{
    dmb_message_set(&sim->message, "place, pipe %u at %g: %s; name a place on a string, body or bit", place.pipe,
                    place.fraction, dmb_status_text(status));
    return status;
}

/* Displacement of the place as a linear function of the rows' displacements. */
static int32_t motion_of_place(dmb_sim *sim, dmb_place place, int32_t frame, int32_t component, dmb_functional *f)
{
    if (component < DMB_X || component > DMB_RZ || frame < DMB_FRAME_WORLD || frame > DMB_FRAME_BODY) {
        dmb_message_set(&sim->message, "place: component = %d, must be 0 .. 5, frame = %d, must be 0 .. 1",
                        (int)component, (int)frame);
        return DMB_ERR_VALUE;
    }
    dmb_sim *copy = dmb_state_copy(sim);
    if (copy == NULL) return DMB_ERR_NO_MEMORY;
    copy->magic = DMB_HANDLE_SIM; /* enables queries */
    const int32_t status = dmb_functional_of_motion(copy, place, frame, component, f);
    dmb_state_discard(copy);
    return status < 0 ? refuse_place(sim, place, status) : DMB_OK;
}

int32_t dmb_analysis_place_rows(dmb_sim *sim, dmb_place place, int32_t frame, int32_t component, uint32_t rows[24],
                                double values[24], uint32_t *count)
{
    if (sim == NULL || rows == NULL || values == NULL || count == NULL)
        return dmb_sim_failed(sim, "place rows", DMB_ERR_NULL);
    int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    if (status < 0) return status;
    status = dmb_state_copy_check(sim, "place");
    dmb_functional f;
    if (status >= 0) status = motion_of_place(sim, place, frame, component, &f);
    if (status >= 0) {
        *count = f.count;
        memcpy(rows, f.row, f.count * sizeof *rows);
        memcpy(values, f.pose, f.count * sizeof *values);
    }
    return dmb_sim_leave(sim, status);
}
