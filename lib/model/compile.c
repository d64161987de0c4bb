/* From what was described to the scene that a step works on. */
#include "base/message.h"
#include "base/value_check.h"
#include "math/bridge.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/mesh.h"
#include "model/scene.h"

static int32_t take_options(dmb_model *model, const dmb_compile_options *given, dmb_compile_options *read)
{
    dmb_check check = dmb_check_of(&model->message, "compile options", DMB_NONE);
    *read = dmb_compile_options_default();
    if (given != NULL) {
        const int32_t status = dmb_compile_options_read(read, given);
        if (status < 0) return status;
    }
    dmb_check_mask(&check, "features", read->features, DMB_FEATURE_ALL);
    dmb_check_choice(&check, "pipe_kind", read->pipe_kind, -1, DMB_PIPE_RIGID);
    return check.status;
}

static int32_t make_scene(dmb_mesh *mesh, dmb_scene **scene)
{
    static int32_t (*const steps[])(dmb_mesh *) = {
        dmb_mesh_hole,   dmb_mesh_count,  dmb_mesh_check,   dmb_mesh_ring_places, dmb_mesh_strings,
        dmb_mesh_bodies, dmb_mesh_rings,  dmb_mesh_poses,   dmb_mesh_types,       dmb_mesh_masses,
        dmb_mesh_sites,  dmb_mesh_joints, dmb_mesh_actions, dmb_mesh_forces,      dmb_mesh_constraints,
        dmb_mesh_inputs, dmb_mesh_flow,
    };
    int32_t status = DMB_OK;
    mesh->features = dmb_mesh_features(mesh);
    for (size_t i = 0; i < sizeof steps / sizeof steps[0] && status >= 0; ++i) status = steps[i](mesh);
    if (status >= 0) status = dmb_mesh_freeze(mesh, scene);
    if (status == DMB_ERR_UNSUPPORTED && !dmb_has_cholmod())
        dmb_message_set(&mesh->model->message,
                        "compile: joints need the order of elimination of CHOLMOD, which could not be "
                        "loaded: install it (Debian: libcholmod3), or build with DMB_WITH_CHOLMOD=OFF");
    return status;
}

/* Each warning to the log, the first into the message too. */
static void warn(dmb_model *model, const dmb_scene *scene)
{
    const dmb_log log = {model->log, model->log_context};
    const dmb_message counts = model->message;
    dmb_message text;
    int first = 1;
    for (uint32_t i = dmb_held_ring(scene, 0, &text); i != DMB_NONE; i = dmb_held_ring(scene, i + 1, &text)) {
        dmb_log_text(&log, DMB_LOG_WARNING, text.text);
        if (first) dmb_message_set(&model->message, "warning: %s; %s", text.text, counts.text);
        first = 0;
    }
}

static void tell(dmb_model *model, const dmb_scene *scene)
{
    const dmb_log log = {model->log, model->log_context};
    dmb_message joints;
    dmb_message_clear(&joints);
    if (scene->cluster_count > 0) {
        dmb_message_set(&joints, "%u joints, %u constraints in %u clusters, ", scene->joint_count,
                        scene->constraint_count, scene->cluster_count);
    }
    dmb_message_set(
        &model->message, "compiled: %u nodes, %u elements, %u contact sites, %s%u degrees_of_freedom, %zu bytes",
        scene->node_count, scene->element_count, scene->site_count, joints.text, scene->free_count, scene->bytes);
    dmb_log_text(&log, DMB_LOG_INFO, model->message.text);
}

int32_t dmb_model_compile(dmb_model *model, const dmb_compile_options *options)
{
    dmb_compile_options read;
    dmb_scene *scene = NULL;
    dmb_mesh mesh;
    int32_t status = dmb_describe_open(model, "compile", model);
    if (status < 0) return status;
    status = dmb_refused_check(&model->refused, &model->message);
    if (status >= 0) status = take_options(model, options, &read);
    if (status >= 0) {
        dmb_mesh_init(&mesh, model, &read);
        status = make_scene(&mesh, &scene);
        dmb_mesh_release(&mesh);
    }
    if (status < 0) return dmb_describe_close(model, "compile", status);
    tell(model, scene);
    warn(model, scene);
    model->scene = scene;
    return dmb_describe_close(model, "compile", DMB_OK);
}
