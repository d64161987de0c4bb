/* Creation and destruction of a model, its ids and message. */
#include "model/model.h"

#include "base/build.h"
#include "base/memory.h"
#include "base/sized_struct.h"
#include "drillmbd/scene.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/scene.h"

DMB_DEFINE_INIT(dmb_model_options, 48, {.log = NULL})
DMB_DEFINE_INIT(dmb_model_info, 72, {.strings = 0})

/* Stamps are unique within a process (up to 2^32 models), so that an id of another model is recognised. */
uint32_t dmb_new_stamp(void)
{
    static atomic_uint last;
    uint32_t stamp = 0;
    while (stamp == 0) stamp = (uint32_t)atomic_fetch_add(&last, 1u) + 1u;
    return stamp;
}

int32_t dmb_model_create(const dmb_model_options *options, dmb_model **model)
{
    dmb_model_options read = dmb_model_options_default();
    dmb_allocator allocator;
    dmb_model *created;
    int32_t status = DMB_OK;
    if (model == NULL) return dmb_failed("model", DMB_ERR_NULL);
    *model = NULL;
    if (options != NULL) status = dmb_model_options_read(&read, options);
    if (status >= 0) status = dmb_allocator_copy(&allocator, read.allocator);
    if (status == DMB_ERR_NULL)
        return dmb_failure(NULL, NULL, status, "model",
                           "model: allocator has no function allocate or release, must have both; "
                           "dmb_allocator_default and dmb_pool_allocator fill them");
    if (status < 0) return dmb_failed("model", status);
    created = dmb_allocate(&allocator, sizeof *created);
    if (created == NULL && read.allocator == NULL && !DMB_WITH_HEAP)
        return dmb_failure(NULL, NULL, DMB_ERR_NO_MEMORY, "model",
                           "model: allocator is NULL, must be given: this build has no heap; make one by "
                           "dmb_pool_allocator");
    if (created == NULL) return dmb_failed("model", DMB_ERR_NO_MEMORY);
    created->magic = DMB_HANDLE_MODEL;
    created->stamp = dmb_new_stamp();
    atomic_init(&created->holders, 1u);
    atomic_init(&created->owned, 1u);
    created->allocator = allocator;
    created->log = read.log;
    created->log_context = read.log_context;
    created->on_error = (dmb_error_handler){read.on_error, read.error_context};
    created->sparse_nodes = DMB_SPARSE_NODES;
    created->environment = dmb_environment_def_default();
    *model = created;
    return DMB_OK;
}

static void release_parts(dmb_model *model)
{
    const dmb_allocator *allocator = &model->allocator;
    model->time_functions.count += model->constants;
    dmb_model_drop_time_functions(model, 0);
    dmb_wall_release(&model->wall, allocator);
    dmb_list_release(&model->sections, allocator, sizeof(dmb_hole_section));
    dmb_list_release(&model->time_functions, allocator, sizeof(dmb_time_function));
    dmb_list_release(&model->names, allocator, sizeof(dmb_time_function_name));
    dmb_list_release(&model->strings, allocator, sizeof(dmb_string_plan));
    dmb_list_release(&model->runs, allocator, sizeof(dmb_pipe_run));
    dmb_list_release(&model->bodies, allocator, sizeof(dmb_body_def));
    dmb_list_release(&model->bits, allocator, sizeof(dmb_bit_def));
    dmb_list_release(&model->drives, allocator, sizeof(dmb_drive_def));
    dmb_list_release(&model->loads, allocator, sizeof(dmb_load_def));
    dmb_list_release(&model->joints, allocator, sizeof(dmb_joint_def));
    dmb_list_release(&model->couplings, allocator, sizeof(dmb_coupling_def));
    dmb_list_release(&model->constraints, allocator, sizeof(dmb_constraint_def));
    dmb_list_release(&model->inputs, allocator, sizeof(dmb_input_def));
    for (uint32_t i = 0; i < model->springs.count; ++i) {
        dmb_spring_release(DMB_LIST_AT(dmb_spring_plan, model->springs, i), allocator);
    }
    dmb_list_release(&model->forces, allocator, sizeof(dmb_force_def));
    dmb_list_release(&model->stuck, allocator, sizeof(dmb_stuck_def));
    dmb_list_release(&model->rings, allocator, sizeof(dmb_stabiliser_def));
    dmb_list_release(&model->springs, allocator, sizeof(dmb_spring_plan));
    dmb_list_release(&model->events, allocator, sizeof(dmb_event_def));
    if (model->scene == NULL) return;
    dmb_scene_release_dense(model->scene->dense, allocator);
    dmb_block_pattern_release(&model->scene->pattern, allocator);
    dmb_release(allocator, model->scene, model->scene->bytes);
}

void dmb_model_hold(dmb_model *model)
{
    (void)atomic_fetch_add_explicit(&model->holders, 1u, memory_order_relaxed);
}

void dmb_model_release(dmb_model *model)
{
    const dmb_allocator allocator = model->allocator;
    /* the last holder must see the writes of the others */
    if (atomic_fetch_sub_explicit(&model->holders, 1u, memory_order_acq_rel) != 1u) return;
    release_parts(model);
    dmb_release(&allocator, model, sizeof *model);
}

/* Releases the caller's reference, of which there is one for all copies of the handle. The model is then no handle for
 * callers, though sims may keep it alive. */
static void give_up(dmb_model *model)
{
    if (atomic_exchange(&model->owned, 0u) == 0u) return;
    model->magic = DMB_HANDLE_DEAD;
    dmb_model_release(model);
}

void dmb_model_destroy(dmb_model **model)
{
    if (model == NULL) return;
    if (dmb_handle_is(*model, DMB_HANDLE_MODEL)) {
        if ((*model)->busy) {
            dmb_model_refuse_re_entry(*model);
            return;
        }
        give_up(*model);
    }
    *model = NULL;
}

const char *dmb_model_message(const dmb_model *model)
{
    if (model == NULL) return dmb_status_text(DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_status_text(DMB_ERR_HANDLE);
    const dmb_failed_object of = dmb_failed_model(model);
    const char *failed = dmb_failure_text(&of);
    return failed != NULL ? failed : model->message.text;
}

/* ---- What all descriptions share --------------------------------------------------------------------------------- */

/* Lists of parts, kept by the growable array of base/memory.h. */
