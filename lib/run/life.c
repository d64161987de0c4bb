/* Creation and destruction of a sim, its time, and information on a compiled model. */
#include <math.h>

#include "base/build.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/sized_struct.h"
#include "constraint/joint.h"
#include "drillmbd/base.h"
#include "math/bridge.h"
#include "model/model.h"
#include "run/run.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "sim/own_scene.h"
#include "system/assemble/actuators.h"
#include "system/system.h"

DMB_DECLARE_STRUCT(dmb_sim_options)

/* Arguments of a create, checked. There is no sim yet to hold a message: a failure is reported to the log, and to the
 * model for the calling thread. */
typedef struct creation {
    dmb_sim_options options;
    dmb_allocator allocator;
    size_t bytes;
    dmb_message message;
} creation;

static void log_status(const dmb_sim_options *options, int32_t status, const dmb_message *message)
{
    const dmb_log log = {options->log, options->log_context};
    if (status == DMB_OK) return;
    dmb_log_text(&log, status < 0 ? DMB_LOG_ERROR : DMB_LOG_WARNING,
                 message->text[0] != '\0' ? message->text : dmb_status_text(status));
}

/* Ends a failed call with a valid model. */
static int32_t fail(const dmb_model *model, const dmb_sim_options *options, int32_t status, const dmb_message *message)
{
    (void)dmb_model_fail(model, status, "sim", message->text);
    log_status(options, status, message);
    return status;
}

/* Reports to the caller's log even if other options are invalid; not if the struct itself cannot be read. */
static void report_refusal(const dmb_sim_options *given, int32_t status, const dmb_message *message)
{
    dmb_sim_options read;
    if (given == NULL || dmb_sim_options_read(&read, given) < 0) return;
    log_status(&read, status, message);
}

static int32_t check_model(const dmb_model *model, dmb_message *message)
{
    if (model == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return DMB_ERR_HANDLE;
    if (model->scene != NULL) return DMB_OK;
    dmb_message_set(message, "model: not compiled, call dmb_model_compile first");
    return DMB_ERR_ORDER;
}

static int32_t read_allocator(creation *c, const dmb_model *model)
{
    const dmb_allocator *given = c->options.allocator;
    int32_t status;
    if (given == NULL) given = &model->allocator;
    status = dmb_allocator_copy(&c->allocator, given);
    if (status < 0) dmb_message_set(&c->message, "sim options: allocator has a wrong struct_size or lacks a function");
    return status;
}

static int32_t set_size(creation *c, const dmb_model *model)
{
    c->bytes = dmb_sim_bytes(model->scene);
    if (c->bytes != SIZE_MAX) return DMB_OK;
    dmb_message_set(&c->message, "sim: its size overflows");
    return DMB_ERR_TOO_LARGE;
}

static int32_t prepare(creation *c, const dmb_model *model, const dmb_sim_options *options)
{
    int32_t status;
    dmb_message_clear(&c->message);
    status = check_model(model, &c->message);
    if (status == DMB_OK) status = dmb_sim_options_get(&c->options, options, &c->message);
    if (status == DMB_OK) status = read_allocator(c, model);
    if (status == DMB_OK) status = set_size(c, model);
    if (status >= 0) return status;
    if (dmb_handle_is(model, DMB_HANDLE_MODEL)) (void)dmb_model_fail(model, status, "sim", c->message.text);
    report_refusal(options, status, &c->message);
    return status;
}

int32_t dmb_sim_memory_size(const dmb_model *model, const dmb_sim_options *options, size_t *size)
{
    creation c;
    int32_t status;
    if (size == NULL) return dmb_model_failed(model, "sim", DMB_ERR_NULL);
    status = prepare(&c, model, options);
    if (status == DMB_OK) *size = c.bytes;
    return status;
}

/* Releases everything. The stamp is cleared first, because the block may be the caller's and outlive the sim. */
static void give_back(dmb_sim *sim)
{
    const dmb_allocator allocator = sim->allocator;
    const int32_t owns_memory = sim->owns_memory;
    dmb_model *model = sim->model;
    void *block = sim->block;
    const size_t size = sim->block_size;
    sim->magic = DMB_HANDLE_DEAD;
    if (owns_memory)
        dmb_release(&allocator, block, size);
    else
        dmb_arena_open(block, size);
    dmb_model_release(model);
}

/* Drives use their time functions until dmb_sim_set_drive replaces them. */
static void release_drives(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->drive_count; ++i) sim->drive_input[i] = (double)NAN;
}

/* Creates the sim in a block at time 0. The reference to the model, taken before, becomes the sim's. The order:
 *
 *     carve        zeroed block; stamp of the sim in the upper half of `calls`
 *     inputs       drives by time functions, empty delay lines, own scene with initial values
 *     start        joints closed, speeds and accelerations consistent (dmb_system_start)
 *     actuators    delay lines are filled with the first command, as if it had always been given
 *     magic        from here on the sim is a live handle
 *     events       their outputs are asked as by queries, which take live handles only
 *
 * A failure goes to the model and to the log, since no sim is left to ask, and gives the block and the reference back.
 */
static int32_t begin(const creation *c, dmb_model *model, void *block, size_t size, int32_t owns_memory, dmb_sim **out)
{
    dmb_sim *sim = dmb_sim_carve(model->scene, block, size);
    int32_t status;
    if (sim == NULL) { /* not reached: the size was checked */
        dmb_model_release(model);
        return DMB_ERR_TOO_LARGE;
    }
    sim->owns_memory = owns_memory;
    sim->model = model;
    sim->calls = (uint64_t)dmb_new_stamp() << 32;
    sim->options = c->options;
    sim->allocator = c->allocator;
    sim->options.allocator = NULL; /* the caller's struct may be gone; the copy is the one to use */
    release_drives(sim);
    dmb_actuators_clear(sim);
    dmb_own_scene_begin(sim);
    dmb_events_begin(sim);
    status = dmb_system_start(sim);
    if (status >= 0) dmb_actuators_settle(sim);
    if (status < 0) {
        (void)fail(model, &sim->options, status, &sim->message);
        give_back(sim);
        return status;
    }
    dmb_model_failure_forget(model);
    log_status(&sim->options, status, &sim->message);
    sim->magic = DMB_HANDLE_SIM; /* set last: callbacks and log may know the block */
    const int32_t asked = dmb_events_check(sim);
    if (asked < 0) {
        (void)fail(model, &sim->options, asked, &sim->message);
        give_back(sim);
        return asked;
    }
    *out = sim;
    return status;
}

int32_t dmb_sim_create(dmb_model *model, const dmb_sim_options *options, dmb_sim **sim)
{
    creation c;
    void *block;
    int32_t status;
    if (sim == NULL) return dmb_model_failed(model, "sim", DMB_ERR_NULL);
    *sim = NULL;
    status = prepare(&c, model, options);
    if (status < 0) return status;
    dmb_model_hold(model); /* the allocator and the log may destroy the caller's handle */
    block = dmb_allocate(&c.allocator, c.bytes);
    if (block == NULL) {
        dmb_message_set(&c.message, "sim: no memory for %zu bytes", c.bytes);
        status = fail(model, &c.options, DMB_ERR_NO_MEMORY, &c.message);
        dmb_model_release(model);
        return status;
    }
    return begin(&c, model, block, c.bytes, 1, sim);
}

int32_t dmb_sim_create_in(dmb_model *model, const dmb_sim_options *options, void *block, size_t size, dmb_sim **sim)
{
    creation c;
    int32_t status;
    if (sim == NULL) return dmb_model_failed(model, "sim", DMB_ERR_NULL);
    *sim = NULL;
    if (block == NULL) return dmb_model_failed(model, "sim", DMB_ERR_NULL);
    status = prepare(&c, model, options);
    if (status < 0) return status;
    if (size < c.bytes) {
        dmb_message_set(&c.message, "sim: size of the block = %zu, must be >= %zu", size, c.bytes);
        return fail(model, &c.options, DMB_ERR_VALUE, &c.message);
    }
    dmb_model_hold(model);
    return begin(&c, model, block, size, 0, sim);
}

void dmb_sim_destroy(dmb_sim **sim)
{
    if (sim == NULL) return;
    if (dmb_handle_is(*sim, DMB_HANDLE_SIM)) {
        if ((*sim)->busy != DMB_BUSY_NOT) {
            dmb_sim_refuse_re_entry(*sim);
            return;
        }
        give_back(*sim);
    }
    *sim = NULL;
}

const char *dmb_sim_message(const dmb_sim *sim)
{
    if (sim == NULL) return dmb_status_text(DMB_ERR_NULL);
    if (!dmb_handle_is(sim, DMB_HANDLE_SIM)) return dmb_status_text(DMB_ERR_HANDLE);
    const dmb_failed_object of = {sim, sim->calls};
    const char *failed = dmb_failure_text(&of);
    return failed != NULL ? failed : sim->message.text;
}

double dmb_sim_time(const dmb_sim *sim)
{
    return dmb_handle_is(sim, DMB_HANDLE_SIM) ? sim->clock->time : (double)NAN;
}

/* Counts of a compiled model; here because one of them is the size of a sim. */

DMB_DECLARE_STRUCT(dmb_model_info)

static int32_t is_open(const dmb_scene *scene, uint32_t joint)
{
    return scene->joints[joint].state == DMB_JOINT_OPEN;
}

static uint32_t joint_rows(const dmb_scene_joint *joint)
{
    if (joint->state == DMB_JOINT_OPEN) return 0;
    return joint->state == DMB_JOINT_LOCKED ? DMB_CONSTRAINT_ROWS : dmb_joint_row_count(joint->kind);
}

/* Active equations at time 0: without those of open joints and of their coordinates. */
static uint32_t active_rows(const dmb_scene *scene)
{
    uint32_t rows = 0;
    for (uint32_t i = 0; i < scene->joint_count; ++i) rows += joint_rows(&scene->joints[i]);
    for (uint32_t i = 0; i < scene->coupling_count; ++i) {
        const dmb_scene_coupling *coupling = scene->couplings + i;
        uint32_t holds = 1;
        for (uint32_t k = 0; k < coupling->count; ++k) holds = holds && !is_open(scene, coupling->joint[k]);
        rows += holds;
    }
    for (uint32_t i = 0; i < scene->drive_count; ++i) {
        const dmb_scene_drive *drive = &scene->drives[i];
        if (drive->constraint != DMB_NONE && !is_open(scene, drive->joint)) ++rows;
    }
    for (uint32_t i = 0; i < scene->callback_count; ++i) rows += scene->callbacks[i].rows;
    return rows;
}

static void fill_info(const dmb_scene *scene, dmb_model_info *info)
{
    info->strings = scene->string_count;
    info->pipes = scene->pipe_count;
    info->rigid_bodies = scene->rigid_count;
    info->nodes = scene->node_count;
    info->elements = scene->element_count;
    info->contact_points = scene->site_count + scene->axial_torsional_site_count;
    info->degrees_of_freedom = scene->free_count;
    info->prescribed = scene->prescribed_count;
    info->structural_joints = scene->structural_joint_count;
    info->model_bytes = scene->bytes + scene->pattern.block_size;
    if (scene->dense != NULL) info->model_bytes += scene->dense->bytes + scene->dense->pattern.block_size;
    info->sim_bytes = dmb_sim_bytes(scene);
    info->mass = scene->mass;
    info->length = scene->length;
    info->joints = scene->joint_count;
    info->constraint_rows = active_rows(scene);
    info->clusters = scene->cluster_count;
    info->reduced_nodes = scene->reduced_count;
}

int32_t dmb_model_get_info(const dmb_model *model, dmb_model_info *info)
{
    dmb_model_info answer = dmb_model_info_default();
    if (model == NULL || info == NULL) return dmb_model_failed(model, "model", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "model", DMB_ERR_HANDLE);
    if (model->scene == NULL) return dmb_model_failed(model, "model", DMB_ERR_ORDER);
    fill_info(model->scene, &answer);
    return dmb_model_failed(model, "model", dmb_model_info_write(info, &answer));
}

/* The abilities of this build. */

/* ---- The build --------------------------------------------------------------------------------------------------- */

int32_t dmb_has(int32_t what)
{
    switch (what) {
    case DMB_HAS_LAPACK: return dmb_has_lapack();
    case DMB_HAS_FILES: return DMB_WITH_FILES;
    case DMB_HAS_HEAP: return DMB_WITH_HEAP;
    default: return dmb_failed("ability", DMB_ERR_VALUE);
    }
}

#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)

#if DMB_LAZY
#define LOADED ", loaded when needed"
#else
#define LOADED ", linked"
#endif
#if DMB_WITH_LAPACK
#define EIGENPROBLEMS "LAPACKE" LOADED
#else
#define EIGENPROBLEMS "own"
#endif
#if DMB_WITH_FILES
#define FILES "yes"
#else
#define FILES "no"
#endif
#if DMB_WITH_HEAP
#define MEMORY "malloc"
#else
#define MEMORY "the caller's"
#endif

const char *dmb_build_info(void)
{
    return "libdrillmbd " TEXT(DMB_VERSION_MAJOR) "." TEXT(DMB_VERSION_MINOR) "." TEXT(
        DMB_VERSION_PATCH) "; eigenproblems: " EIGENPROBLEMS "; files: " FILES "; memory: " MEMORY;
}
