/* State equations y' = f(t, y) (eq:joints.state-equation): creation and destruction, origin of the coordinates, rates.
 * One evaluation, always from the origin, so that f is a function of (t, y) alone:
 *
 *     check_numbers             finite, time not before the inputs were set
 *     dmb_state_find_pose       z of all rows: independent ones from y, prescribed ones, dependent ones by C(z, t) = 0
 *     dmb_state_find_velocity   v of all rows (eq:joints.velocity-partition)
 *     dmb_system_jump           accelerations of that state, as at a breakpoint of a run
 *     write_rates               z' by the chart (eq:joints.chart-rate), v'
 *
 * After an error the copy holds no state: dmb_state_equation_sim returns NULL until an evaluation succeeds. Origin and
 * partition are unchanged. */
#include "analysis/state_equation/state_equation.h"

#include <math.h>
#include <string.h>

#include "base/failure.h"
#include "base/memory.h"
#include "model/model.h"
#include "sim/layout.h"
#include "system/constrain/constrain.h"
#include "system/system.h"

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static dmb_state_equation *lay_out(dmb_arena *arena, const dmb_scene *scene)
{
    dmb_state_equation nothing, *made = dmb_arena_allocate(arena, 1, sizeof nothing, DMB_ALIGNMENT);
    dmb_state_equation *s = made != NULL ? made : &nothing;
    const size_t n = scene->node_count, rows = scene->row_count;
    s->row_of = DMB_ARENA_ARRAY(arena, uint32_t, rows);
    s->kind = DMB_ARENA_ARRAY(arena, uint8_t, rows);
    s->z = DMB_ARENA_DOUBLES(arena, rows);
    s->older = DMB_ARENA_DOUBLES(arena, rows);
    s->displacement = DMB_ARENA_DOUBLES(arena, 3 * n);
    s->quaternion = DMB_ARENA_DOUBLES(arena, 4 * n);
    s->turn = DMB_ARENA_DOUBLES(arena, n);
    s->joint_turn = DMB_ARENA_DOUBLES(arena, 2 * (size_t)scene->joint_count);
    s->drive_position = DMB_ARENA_DOUBLES(arena, scene->drive_count);
    s->velocity = DMB_ARENA_DOUBLES(arena, rows);
    s->kept.rank = DMB_ARENA_ARRAY(arena, uint32_t, scene->cluster_count);
    s->kept.quality = DMB_ARENA_DOUBLES(arena, scene->cluster_count);
    s->kept.row = DMB_ARENA_ARRAY(arena, uint32_t, scene->constraint_row_count);
    s->kept.column = DMB_ARENA_ARRAY(arena, uint32_t, scene->cluster_column_count);
    return made;
}

static dmb_state_equation *allocate(const dmb_sim *sim)
{
    dmb_arena arena;
    dmb_arena_count(&arena);
    (void)lay_out(&arena, sim->scene);
    const size_t bytes = dmb_arena_block_size(&arena);
    void *block = dmb_allocate(&sim->allocator, bytes);
    if (block == NULL) return NULL;
    dmb_arena_place(&arena, block, bytes);
    dmb_state_equation *made = lay_out(&arena, sim->scene);
    made->bytes = bytes;
    made->allocator = sim->allocator;
    return made;
}

/* ---- The origin of the coordinates ------------------------------------------------------------------------------- */

static void keep_partition(const dmb_sim *work, const dmb_kept_partition *to)
{
    const dmb_scene *scene = work->scene;
    memcpy(to->rank, work->partition_rank, scene->cluster_count * sizeof(uint32_t));
    memcpy(to->quality, work->partition_quality, scene->cluster_count * sizeof(double));
    memcpy(to->row, work->partition_row, scene->constraint_row_count * sizeof(uint32_t));
    memcpy(to->column, work->partition_column, scene->cluster_column_count * sizeof(uint32_t));
}

static void restore_partition(dmb_sim *work, const dmb_kept_partition *from)
{
    const dmb_scene *scene = work->scene;
    memcpy(work->partition_rank, from->rank, scene->cluster_count * sizeof(uint32_t));
    memcpy(work->partition_quality, from->quality, scene->cluster_count * sizeof(double));
    memcpy(work->partition_row, from->row, scene->constraint_row_count * sizeof(uint32_t));
    memcpy(work->partition_column, from->column, scene->cluster_column_count * sizeof(uint32_t));
}

/* Chooses the partition at the accepted state of the copy. */
static int32_t choose(const dmb_state_equation *s)
{
    dmb_sim *work = s->work;
    dmb_evaluation evaluation = dmb_state_evaluation(s, work->clock->time);
    dmb_configuration_copy(work, &work->now, &work->trial);
    if (work->scene->cluster_count == 0) return DMB_OK;
    const int32_t status = dmb_clusters_assemble(&evaluation);
    if (status >= 0) dmb_clusters_choose(work);
    return status;
}

/* One kind for each row; later ones overwrite earlier ones: free or supported, moved by a drive, dependent by the
 * partition. */
static void mark_rows(dmb_state_equation *s)
{
    const dmb_scene *scene = s->work->scene;
    for (uint32_t i = 0; i < scene->row_count; i++) s->kind[i] = scene->solved_row[i] ? DMB_STATE_FREE : DMB_STATE_HELD;
    for (uint32_t i = 0; i < scene->drive_count; i++)
        if (scene->drives[i].kind == DMB_DRIVE_MOTION && scene->drives[i].row != DMB_NONE)
            s->kind[scene->drives[i].row] = DMB_STATE_DRIVEN;
    for (uint32_t k = 0; k < scene->cluster_count; k++) {
        const uint32_t *order = s->work->partition_column + scene->clusters[k].column;
        for (uint32_t i = 0; i < s->work->partition_rank[k]; i++)
            s->kind[scene->cluster_columns[scene->clusters[k].column + order[i]]] = DMB_STATE_DEPENDENT;
    }
    s->count = 0;
    for (uint32_t i = 0; i < scene->row_count; i++)
        if (s->kind[i] == DMB_STATE_FREE) s->row_of[s->count++] = i;
}

/* The accepted state of the copy becomes the origin. */
static int32_t begin(dmb_state_equation *s)
{
    dmb_sim *work = s->work;
    const dmb_scene *scene = work->scene;
    const int32_t status = choose(s);
    if (status < 0) return status;
    mark_rows(s);
    s->time = work->clock->time;
    memcpy(s->displacement, work->now.displacement, 3 * (size_t)scene->node_count * sizeof(double));
    memcpy(s->quaternion, work->now.quaternion, 4 * (size_t)scene->node_count * sizeof(double));
    memcpy(s->turn, work->now.turn, scene->node_count * sizeof(double));
    memcpy(s->joint_turn, work->now.joint_turn, 2 * (size_t)scene->joint_count * sizeof(double));
    for (uint32_t i = 0; i < scene->drive_count; i++) s->drive_position[i] = work->now.drives[i].position;
    memcpy(s->velocity, work->now.velocity, scene->row_count * sizeof(double));
    return DMB_OK;
}

static void write_origin(const dmb_state_equation *s, double *y)
{
    memset(y, 0, s->count * sizeof *y);
    for (uint32_t i = 0; i < s->count; i++) y[s->count + i] = s->velocity[s->row_of[i]];
}

/* ---- A state ----------------------------------------------------------------------------------------------------- */

static int32_t check_numbers(const dmb_state_equation *s, double time, const double *y)
{
    dmb_message *message = &s->work->message;
    if (!isfinite(time)) {
        dmb_message_set(message, "state equation: time = %g, must be finite", time);
        return DMB_ERR_NOT_FINITE;
    }
    if (s->work->scene->input_count > 0 && time < s->since) {
        dmb_message_set(message, "state equation: time = %g, must be >= %g, where the inputs were set", time, s->since);
        return DMB_ERR_VALUE;
    }
    for (uint32_t i = 0; i < 2 * s->count; i++) {
        if (fabs(y[i]) <= 1e30) continue;
        dmb_message_set(message, "state equation: y[%u] = %g, must be finite and within +-1e30", i, y[i]);
        return isnan(y[i]) ? DMB_ERR_NOT_FINITE : DMB_ERR_VALUE;
    }
    return DMB_OK;
}

/* Pose and velocities of the trial become those of the accepted state, at `time`. Contact points are found anew. */
static void accept_motion(dmb_state_equation *s, double time)
{
    dmb_sim *work = s->work;
    for (uint32_t i = 0; i < work->scene->drive_count; i++)
        if (work->scene->drives[i].row != DMB_NONE)
            work->trial.drives[i].position = s->drive_position[i] + s->z[work->scene->drives[i].row];
    for (uint32_t i = 0; i < work->scene->site_count; i++) work->trial.site_penetration[i] = 0.0;
    dmb_configuration_copy(work, &work->trial, &work->now);
    work->clock->time = work->clock->breakpoint = time;
    work->clock->rest = 0.0;
}

/* The gimbal singularity is checked before the state is accepted: angles of joints are undefined there. */
static int32_t evaluate(dmb_state_equation *s, double time, const double *y)
{
    dmb_sim *work = s->work;
    int32_t status = check_numbers(s, time, y);
    if (status < 0) return status;
    work->magic = DMB_HANDLE_DEAD; /* no state to ask until this one is complete */
    status = dmb_state_find_pose(s, time, y);
    if (status >= 0) status = dmb_state_find_velocity(s, time, y + s->count);
    if (status >= 0) status = dmb_joints_refuse_gimbal_singularity(work, 0, time);
    if (status < 0) return status;
    accept_motion(s, time);
    status = dmb_system_jump(work);
    if (status < 0) return status;
    dmb_configuration_copy(work, &work->trial, &work->now);
    work->magic = DMB_HANDLE_SIM;
    return DMB_OK;
}

/* s->older, the place before in the search for the pose, is free here and holds z' of all rows. */
static void write_rates(const dmb_state_equation *s, double *rate)
{
    const dmb_scene *scene = s->work->scene;
    double *to = s->older;
    for (uint32_t i = 0; i < scene->node_count; i++)
        dmb_state_chart_rate(s, i, s->work->now.velocity + scene->layout.row[i], to + scene->layout.row[i]);
    for (uint32_t i = 0; i < s->count; i++) {
        rate[i] = to[s->row_of[i]];
        rate[s->count + i] = s->work->now.acceleration[s->row_of[i]];
    }
}

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

static int32_t alive(const dmb_state_equation *s)
{
    if (s == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(s, DMB_HANDLE_STATE_EQUATION)) return DMB_ERR_HANDLE;
    return s->busy ? DMB_ERR_ORDER : DMB_OK;
}

static void enter(dmb_state_equation *s)
{
    s->busy = 1;
    s->work->calls++;
    dmb_message_clear(&s->work->message);
}

static int32_t leave(dmb_state_equation *s, int32_t status)
{
    s->busy = 0;
    if (status >= 0) return status;
    if (status == DMB_ERR_CALLBACK && s->work->message.text[0] == '\0')
        dmb_message_set(&s->work->message,
                        "state equation: the callback of a time function, force or constraint failed or gave a value "
                        "beyond +-1e30");
    return dmb_failure(NULL, &s->work->model->on_error, status, "state equation", s->work->message.text);
}

static void discard(dmb_state_equation *s)
{
    const dmb_allocator allocator = s->allocator;
    s->magic = DMB_HANDLE_DEAD;
    if (s->work != NULL) s->work->magic = DMB_HANDLE_DEAD;
    dmb_state_discard(s->work);
    dmb_release(&allocator, s, s->bytes);
}

static int32_t create(dmb_sim *sim, dmb_state_equation **out)
{
    int32_t status = dmb_state_copy_check(sim, "state equation");
    if (status >= 0) status = dmb_state_check_memory(sim);
    if (status < 0) return status;
    dmb_state_equation *s = allocate(sim);
    if (s != NULL) s->work = dmb_state_copy(sim);
    if (s == NULL || s->work == NULL) {
        if (s != NULL) discard(s);
        dmb_message_set(&sim->message, "state equation: no memory");
        return DMB_ERR_NO_MEMORY;
    }
    s->work->progress = &s->work->own_progress;
    s->work->options.energy_ledger = 0;
    s->since = sim->clock->time;
    status = begin(s);
    if (status < 0) {
        sim->message = s->work->message;
        discard(s);
        return status;
    }
    s->work->magic = DMB_HANDLE_SIM;
    s->model = sim->model;
    dmb_model_hold(s->model);
    s->magic = DMB_HANDLE_STATE_EQUATION;
    *out = s;
    return DMB_OK;
}

int32_t dmb_state_equation_create(dmb_sim *sim, dmb_state_equation **equation)
{
    if (equation == NULL) return dmb_sim_failed(sim, "state equation", DMB_ERR_NULL);
    *equation = NULL;
    if (sim == NULL) return dmb_sim_failed(sim, "state equation", DMB_ERR_NULL);
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, create(sim, equation));
}

void dmb_state_equation_destroy(dmb_state_equation **equation)
{
    if (equation == NULL) return;
    dmb_state_equation *s = *equation;
    if (dmb_handle_is(s, DMB_HANDLE_STATE_EQUATION)) {
        if (s->busy) return;
        dmb_model *model = s->model;
        discard(s);
        dmb_model_release(model);
    }
    *equation = NULL;
}

uint32_t dmb_state_equation_count(const dmb_state_equation *equation)
{
    return dmb_handle_is(equation, DMB_HANDLE_STATE_EQUATION) ? equation->count : 0;
}

int32_t dmb_state_equation_rows(const dmb_state_equation *equation, uint32_t *rows)
{
    const int32_t status = alive(equation);
    if (status < 0) return dmb_failed("state equation", status);
    if (rows == NULL) return dmb_failed("state equation", DMB_ERR_NULL);
    memcpy(rows, equation->row_of, equation->count * sizeof *rows);
    return DMB_OK;
}

int32_t dmb_state_equation_origin(const dmb_state_equation *equation, double *time, double *y)
{
    const int32_t status = alive(equation);
    if (status < 0) return dmb_failed("state equation", status);
    if (y == NULL) return dmb_failed("state equation", DMB_ERR_NULL);
    if (time != NULL) *time = equation->time;
    write_origin(equation, y);
    return DMB_OK;
}

int32_t dmb_state_equation_rate(dmb_state_equation *equation, double time, const double *y, double *rate)
{
    int32_t status = alive(equation);
    if (status < 0) return dmb_failed("state equation", status);
    if (y == NULL || rate == NULL) return dmb_failed("state equation", DMB_ERR_NULL);
    enter(equation);
    status = evaluate(equation, time, y);
    if (status >= 0) write_rates(equation, rate);
    return leave(equation, status);
}

/* A new origin where the chart or the partition of the old one comes to its end. The number of independent coordinates
 * stays, so that y keeps its length; a pose in which it is another one is singular, and the old partition is restored.
 */
static int32_t move_origin(dmb_state_equation *s, double time, const double *y)
{
    const uint32_t count = s->count;
    int32_t status = evaluate(s, time, y);
    if (status < 0) return status;
    keep_partition(s->work, &s->kept);
    uint32_t before = 0, after = 0;
    for (uint32_t k = 0; k < s->work->scene->cluster_count; k++) before += s->kept.rank[k];
    status = choose(s);
    for (uint32_t k = 0; k < s->work->scene->cluster_count; k++) after += s->work->partition_rank[k];
    if (status >= 0 && before == after) return begin(s);
    restore_partition(s->work, &s->kept);
    if (status < 0) return status;
    dmb_message_set(&s->work->message,
                    "state equation: at time %g there are %u independent coordinates instead of %u: joints are in a "
                    "singular position; take a state before or behind it",
                    time, count + before - after, count);
    return DMB_ERR_SINGULAR;
}

int32_t dmb_state_equation_begin(dmb_state_equation *equation, double time, double *y)
{
    int32_t status = alive(equation);
    if (status < 0) return dmb_failed("state equation", status);
    if (y == NULL) return dmb_failed("state equation", DMB_ERR_NULL);
    enter(equation);
    status = move_origin(equation, time, y);
    if (status >= 0) write_origin(equation, y);
    return leave(equation, status);
}

const dmb_sim *dmb_state_equation_sim(const dmb_state_equation *equation)
{
    if (!dmb_handle_is(equation, DMB_HANDLE_STATE_EQUATION)) return NULL;
    return dmb_handle_is(equation->work, DMB_HANDLE_SIM) ? equation->work : NULL;
}
