/* Friction laws at contact points of the wall: of the section of the hole, of sliding alone, at the end of a step. A
 * law without memory follows from the speed. In a finished configuration a law with memory is evaluated at its present
 * state with a step of length 0: the bristle does not move by the question. */
#include "system/assemble/assemble.h"

#include "sim/node.h"

/* `site` counts contact points of six-DOF nodes first, then those of axial-torsional nodes. */
const dmb_friction_law *dmb_contact_friction_law(const dmb_scene *scene, const dmb_configuration *c, uint32_t site,
                                                 dmb_friction_law *local)
{
    if (scene->hole.pieces == 0) return &scene->friction_law;
    const double depth =
        site < scene->site_count
            ? c->site_depth[site]
            : dmb_axial_torsional_depth(scene, c, scene->axial_torsional_sites[site - scene->site_count].node);
    *local = dmb_friction_law_at(&scene->hole, &scene->friction_law, depth);
    return local;
}

/* Without smoothing and without the peak of a bristle law, for steady states and for open points, which have no
 * bristle.
 */
dmb_friction_law dmb_sliding_law(const dmb_friction_law *law)
{
    dmb_friction_law sliding = *law;
    if (law->kind == DMB_FRICTION_CALLBACK) {
        sliding.kind = DMB_FRICTION_CALLBACK_SLIDING;
        return sliding;
    }
    sliding.kind = DMB_FRICTION_STRIBECK;
    sliding.smoothing_speed = sliding.peak_bump = sliding.peak_level = 0.0;
    return sliding;
}

void dmb_friction_failed(dmb_evaluation *evaluation)
{
    evaluation->status = DMB_ERR_CALLBACK;
    evaluation->sim->reduced_mode->force = evaluation->sim->scene->force_count + 1;
}

void dmb_friction_accept(const dmb_sim *sim)
{
    const dmb_friction_law *law = &sim->scene->friction_law;
    if (law->kind != DMB_FRICTION_CALLBACK || law->accept == NULL) return; /* friction may be left out of the mesh */
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        law->accept(law->context, sim->clock->time, s, sim->now.site_bristle + law->states * (size_t)s);
    for (uint32_t p = 0; p < sim->scene->axial_torsional_site_count; p++)
        law->accept(law->context, sim->clock->time, sim->scene->site_count + p,
                    sim->now.axial_torsional_bristle + law->states * (size_t)p);
}

/*     law           force
 *     -----------   ------------------------------------------------------------------
 *     NONE          0
 *     callback      its function with a step of length 0; the new state is discarded
 *     bristle       eq:friction.bristle with a step of length 0
 *     other         eq:friction.smooth of the present slip */
void dmb_finished_friction(const dmb_friction_law *law, const double *bristle, int32_t sticks, dmb_site_force *out)
{
    const double N = out->normal_force, *slip = out->slip;
    double z[2], dv[4], dN[2], state[DMB_FRICTION_STATES];
    out->friction[0] = out->friction[1] = 0.0;
    out->sticks = sticks;
    const dmb_local_friction local = dmb_local_friction_of(law);
    if (law->kind == DMB_FRICTION_NONE) return;
    if (law->kind == DMB_FRICTION_CALLBACK) {
        const dmb_friction_at at = {N, {slip[0], slip[1]}, {slip[0], slip[1]}, law->mu_static, law->mu_dynamic};
        const dmb_law_memory memory = {bristle, state, 0.0};
        dmb_friction_result of;
        (void)dmb_friction_call(law, &at, &memory, &of); /* NaN if it fails */
        out->friction[0] = of.force[0];
        out->friction[1] = of.force[1];
        return;
    }
    if (dmb_friction_has_memory(law))
        (void)dmb_friction_bristle(&local, N, slip, bristle, slip, sticks != 0, 0.0, z, out->friction, dv, dN);
    else
        dmb_friction_smooth(law, N, slip, out->friction, dv, dN);
}
