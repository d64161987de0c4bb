/* Buckling analysis (dmb_analysis_buckling): options, memory, linear critical factors, queries. Order of find_factors:
 *
 *   1. refusal of a moving state; K and G about the present state (buckling_state.c)
 *   2. linear factors (dmb_buckling_find): symmetric K by counting and bisection (pencil.c), otherwise by Krylov
 * subspaces
 *   3. if the loads move nothing, K is linear in them: all factors are confirmed, and for non-symmetric K flutter is
 *      searched in the present pose (confirm_all)
 *   4. else, with options.follow and a factor or a bound factor_max for non-symmetric K: path following
 *      (buckling_follow.c)
 *   5. else, for non-symmetric K: flutter in the present state alone (judge_present); the factors are extrapolations
 *
 * All of it works on `work`, a copy of the sim: after an error the sim is as before, and the copy is released. */
#include "analysis/buckling/buckling.h"

#include <string.h>

#include "base/failure.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "model/field_check.h"
#include "query/query.h"
#include "sim/access.h"
#include "system/system.h"

DMB_DECLARE_STRUCT(dmb_buckling_info)

static int32_t read_options(dmb_sim *sim, const dmb_buckling_options *given, dmb_buckling_options *out)
{
    dmb_check check = dmb_check_of(&sim->message, "buckling options", DMB_NONE);
    dmb_options_get(&check, DMB_OPTIONS_OF(dmb_buckling_options), given, out);
    return check.status;
}

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static void lay_out(dmb_arena *arena, const dmb_scene *scene, uint32_t count, dmb_buckling *to)
{
    const size_t rows = scene->row_count;
    to->factor = DMB_ARENA_DOUBLES(arena, count);
    to->first = DMB_ARENA_DOUBLES(arena, count);
    to->vector = DMB_ARENA_DOUBLES(arena, (size_t)count * dmb_pencil_unknowns(scene));
    to->shape = scene->cluster_count ? DMB_ARENA_DOUBLES(arena, count * rows) : to->vector;
    to->response = DMB_ARENA_DOUBLES(arena, rows);
    to->amount = DMB_ARENA_DOUBLES(arena, rows);
    to->pattern.base = DMB_ARENA_DOUBLES(arena, dmb_load_pattern_size(scene));
    dmb_pencil_lay_out(arena, scene, &to->pencil);
    dmb_frames_lay_out(arena, scene, &to->frames);
}

void dmb_buckling_destroy(dmb_buckling **buckling)
{
    if (buckling == NULL || *buckling == NULL) return;
    if (dmb_handle_is(*buckling, DMB_HANDLE_BUCKLING)) {
        const dmb_allocator allocator = (*buckling)->allocator;
        dmb_model *model = (*buckling)->work != NULL ? (*buckling)->work->model : NULL;
        (*buckling)->magic = DMB_HANDLE_DEAD;
        dmb_state_discard((*buckling)->work);
        dmb_release(&allocator, (*buckling)->block, (*buckling)->block_size);
        dmb_release(&allocator, *buckling, sizeof **buckling);
        if (model != NULL) dmb_model_release(model);
    }
    *buckling = NULL;
}

/* The copy of the sim serves queries of shapes like any sim, and keeps the model. */
static dmb_buckling *allocate(const dmb_sim *sim, uint32_t count)
{
    dmb_arena arena;
    dmb_buckling nowhere;
    dmb_buckling *made = dmb_allocate(&sim->allocator, sizeof *made);
    if (made == NULL) return NULL;
    made->magic = DMB_HANDLE_BUCKLING;
    made->allocator = sim->allocator;
    dmb_arena_count(&arena);
    const dmb_scene *scene = dmb_dense_scene(sim->scene);
    lay_out(&arena, scene, count, &nowhere);
    made->block_size = dmb_arena_block_size(&arena);
    made->block = dmb_allocate(&sim->allocator, made->block_size);
    if (made->block != NULL) made->work = dmb_state_copy(sim);
    if (made->work == NULL) {
        dmb_buckling_destroy(&made);
        return NULL;
    }
    made->work->magic = DMB_HANDLE_SIM;
    dmb_model_hold(made->work->model);
    dmb_arena_place(&arena, made->block, made->block_size);
    lay_out(&arena, scene, count, made);
    made->pencil.sim = made->work;
    return made;
}

/* ---- Factors and shapes ------------------------------------------------------------------------------------------ */

/* 1: the loads move the state. If they do not (rigid links in line), the stiffness is linear in them, and path
 * following is unnecessary. */
static int moves(const dmb_buckling *buckling)
{
    for (uint32_t i = 0; i < buckling->work->scene->row_count; i++)
        if (buckling->response[i] != 0.0) return 1;
    return 0;
}

/* Flutter under loads that grow in the present pose, which may differ from the loaded pose, up to a factor; `through`:
 * at that factor too. */
static int32_t judge_pose(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options, double to,
                          int through, int32_t status)
{
    dmb_flutter flutter;
    memset(&flutter, 0, sizeof flutter);
    flutter.pattern = &buckling->pattern;
    flutter.info = &buckling->info;
    flutter.off = options->slip_axial != 0.0 || options->slip_rotation != 0.0;
    const int32_t judged = flutter.off ? DMB_OK : dmb_flutter_of_pose(&flutter, buckling->work, to, through);
    dmb_flutter_conclude(&flutter);
    dmb_flutter_close(&flutter);
    return judged < 0 ? judged : dmb_buckling_report_flutter(buckling, sim, &flutter.message, status);
}

/* Flutter of the present state. Beyond it flutter is not assessed without path following; the result already has a
 * note. */
static int32_t judge_present(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options, int32_t status)
{
    const dmb_message before = sim->message;
    const int32_t judged = judge_pose(buckling, sim, options, 0.0, 0, status);
    if (judged < 0 || buckling->info.flutter == DMB_FLUTTER_FOUND) return judged;
    buckling->info.flutter = DMB_FLUTTER_NOT_JUDGED;
    sim->message = before;
    return status;
}

/* Confirms the linear factors: flutter up to the first factor, at which divergence occurs, or up to the requested
 * bound. */
static int32_t confirm_all(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options)
{
    const int none = buckling->count == 0;
    const int32_t status = buckling->count < options->count ? DMB_NOTE_STOPPED : DMB_OK;
    buckling->info.confirmed = buckling->count;
    buckling->info.end = none ? DMB_BUCKLING_EXTRAPOLATED : DMB_BUCKLING_BIFURCATION;
    if (buckling->info.stiffness != DMB_STIFFNESS_UNSYMMETRIC) return status;
    if (none && options->factor_max >= DMB_FACTOR_MAX) return judge_present(buckling, sim, options, status);
    return judge_pose(buckling, sim, options, none ? options->factor_max : buckling->factor[0], none, status);
}

/* Factors about the present state, then along the equilibria. `first` keeps the factors of the present state: path
 * following confirms further factors by them, and messages compare with them. */
static int32_t find_factors(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options)
{
    int32_t status = dmb_steady_refuse_moving(sim, buckling->work, "buckling");
    if (status >= 0) status = dmb_buckling_linearise(buckling, sim, options);
    if (status >= 0) status = dmb_buckling_find(buckling, options, &sim->message);
    if (status < 0) return status;
    for (uint32_t k = 0; k < options->count; k++)
        buckling->first[k] = k < buckling->count ? buckling->factor[k] : (double)INFINITY;
    buckling->info.estimate = buckling->first[0];
    const int unsymmetric = buckling->info.stiffness == DMB_STIFFNESS_UNSYMMETRIC;
    const int bounded = unsymmetric && options->factor_max < DMB_FACTOR_MAX;
    if (!moves(buckling))
        status = confirm_all(buckling, sim, options);
    else if (options->follow && (buckling->count > 0 || bounded))
        status = dmb_buckling_follow(buckling, sim, options);
    else if (unsymmetric)
        status = judge_present(buckling, sim, options, status);
    buckling->info.count = buckling->count;
    return status == DMB_OK && buckling->info.confirmed < buckling->count ? DMB_NOTE_EXTRAPOLATED : status;
}

static int32_t analyse(dmb_sim *sim, const dmb_buckling_options *options, dmb_buckling **buckling)
{
    dmb_buckling_options taken;
    dmb_load_pattern pattern;
    int32_t status = read_options(sim, options, &taken);
    if (status >= 0) status = dmb_state_copy_check(sim, "buckling");
    if (status >= 0) status = dmb_load_pattern_allocate(sim, "buckling options", taken.scale, taken.part, &pattern);
    if (status < 0) return status;
    dmb_buckling *made = allocate(sim, taken.count);
    if (made == NULL) return DMB_ERR_NO_MEMORY;
    pattern.base = made->pattern.base;
    made->pattern = pattern;
    (void)dmb_buckling_info_init(&made->info, (uint32_t)sizeof made->info);
    made->info.sinusoidal_share = (double)NAN;
    status = dmb_progress_end(sim, find_factors(made, sim, &taken));
    made->work->progress = &made->work->own_progress; /* it may outlive the sim */
    if (status < 0)
        dmb_buckling_destroy(&made);
    else
        *buckling = made;
    return status;
}

int32_t dmb_analysis_buckling(dmb_sim *sim, const dmb_buckling_options *options, dmb_buckling **buckling)
{
    if (sim == NULL || buckling == NULL) return dmb_sim_failed(sim, "buckling", DMB_ERR_NULL);
    *buckling = NULL;
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_READABLE);
    return status < 0 ? status : dmb_sim_leave(sim, analyse(sim, options, buckling));
}

int32_t dmb_buckling_get_info(const dmb_buckling *buckling, dmb_buckling_info *info)
{
    if (buckling == NULL || info == NULL) return dmb_failed("buckling", DMB_ERR_NULL);
    if (!dmb_handle_is(buckling, DMB_HANDLE_BUCKLING)) return dmb_failed("buckling", DMB_ERR_HANDLE);
    return dmb_failed("buckling", dmb_buckling_info_write(info, &buckling->info));
}

uint32_t dmb_buckling_count(const dmb_buckling *buckling)
{
    return dmb_handle_is(buckling, DMB_HANDLE_BUCKLING) ? buckling->count : 0;
}

static int32_t check_mode(const dmb_buckling *buckling, uint32_t mode, const double *answer)
{
    if (buckling == NULL || answer == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(buckling, DMB_HANDLE_BUCKLING)) return DMB_ERR_HANDLE;
    return mode < buckling->count ? DMB_OK : DMB_ERR_VALUE;
}

int32_t dmb_buckling_factor(const dmb_buckling *buckling, uint32_t mode, double *factor)
{
    const int32_t status = check_mode(buckling, mode, factor);
    if (status == DMB_OK) *factor = buckling->factor[mode];
    return dmb_failed("buckling", status);
}

/* A shape is a field of small displacements, interpolated like a field of velocities. */
int32_t dmb_buckling_shape(const dmb_buckling *buckling, uint32_t mode, dmb_place place, double shape[6])
{
    int32_t status = check_mode(buckling, mode, shape);
    dmb_motion motion = dmb_motion_default();
    if (status < 0) return dmb_failed("buckling", status);
    const size_t rows = buckling->work->scene->row_count;
    memcpy(buckling->work->now.velocity, buckling->shape + mode * rows, rows * sizeof(double));
    status = dmb_answer_motion(buckling->work, place, &motion);
    if (status == DMB_OK) memcpy(shape, motion.velocity, sizeof motion.velocity);
    return dmb_failed("buckling", status);
}
