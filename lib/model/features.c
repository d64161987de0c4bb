/* What a scene has, out of what was asked for: a feature that was not described is left out too. */
#include <math.h>

#include "model/eccentricity.h"
#include "model/field_check.h"
#include "model/mesh.h"

static bool has_gravity(const dmb_model *model)
{
    const double *g = model->environment.gravity;
    return fabs(g[0]) > 0.0 || fabs(g[1]) > 0.0 || fabs(g[2]) > 0.0;
}

static bool has_contact(const dmb_model *model)
{
    return model->wall_count > 0 && model->wall.normal_law != DMB_NORMAL_NONE;
}

static bool has_eccentricity(const dmb_model *model)
{
    for (uint32_t i = 0; i < model->runs.count; ++i) {
        if (dmb_pipe_is_eccentric(&DMB_LIST_AT(const dmb_pipe_run, model->runs, i)->def)) return true;
    }
    return false;
}

static bool has_excitation(const dmb_model *model)
{
    for (uint32_t i = 0; i < model->drives.count; ++i) {
        if (!dmb_id_is_none(DMB_LIST_AT(const dmb_drive_def, model->drives, i)->excitation)) return true;
    }
    return false;
}

static bool has_rock(const dmb_model *model)
{
    for (uint32_t i = 0; i < model->bits.count; ++i) {
        if (DMB_LIST_AT(const dmb_bit_def, model->bits, i)->rock_law != DMB_ROCK_NONE) return true;
    }
    return false;
}

static bool has_damping(const dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    const dmb_environment_def *e = &model->environment;
    if (e->axial_damping > 0.0 || e->lateral_damping > 0.0 || e->torsional_damping > 0.0) return true;
    for (uint32_t i = 0; i < model->runs.count; ++i) {
        const dmb_pipe_run *run = dmb_mesh_run_at(mesh, i);
        if (run->def.damping_time > 0.0 && dmb_mesh_kind(mesh, run) != DMB_PIPE_RIGID) return true;
    }
    return false;
}

int32_t dmb_mesh_features(const dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    const bool contact = has_contact(model) && (mesh->options.features & DMB_FEATURE_CONTACT) != 0;
    int32_t described = contact ? DMB_FEATURE_CONTACT : 0;
    if (has_gravity(model)) described |= DMB_FEATURE_GRAVITY;
    if (contact && model->wall.friction_law != DMB_FRICTION_NONE) described |= DMB_FEATURE_FRICTION;
    if (has_eccentricity(model)) described |= DMB_FEATURE_ECCENTRICITY;
    if (has_excitation(model)) described |= DMB_FEATURE_EXCITATION;
    if (has_rock(model)) described |= DMB_FEATURE_ROCK;
    if (has_damping(mesh)) described |= DMB_FEATURE_DAMPING;
    return described & mesh->options.features;
}
