/* Rings of FULL nodes against the wall: force/contact_math by the kernels, and what the trial keeps of the sites. */
#include "system/wall_contact.h"

#include <string.h>

#include "element/beam.h"
#include "force/contact_math.h"
#include "kernel/kernels.h"
#include "system/evaluation.h"

static dmb_site_fields fields_of(const dmb_configuration *configuration)
{
    const dmb_site_fields fields = {
        .normal = configuration->site_normal,
        .depth = configuration->site_depth,
        .penetration = configuration->site_penetration,
        .approach = configuration->site_approach,
        .slip = configuration->site_slip,
        .bristle = configuration->site_bristle,
        .segment = configuration->site_segment,
        .sticks = configuration->site_sticks,
    };
    return fields;
}

/* Where the kernels find and leave what belongs to the sites. */
static dmb_wall_run run_of(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_wall_run run = {
        .count = scene->site_count,
        .sites = scene->sites,
        .hole = &scene->hole,
        .normal_law = &scene->normal_law,
        .bristles = dmb_scene_has_bristles(scene),
        .row = scene->layout.row,
        .diagonal = scene->layout.diag,
        .reference = scene->reference_position,
        .displacement = sim->trial.displacement,
        .quaternion = sim->trial.quaternion,
        .velocity = sim->trial.velocity,
        .now_quaternion = sim->now.quaternion,
        .now_velocity = sim->now.velocity,
        .now = fields_of(&sim->now),
        .site_return = sim->site_return,
        .trial = fields_of(&sim->trial),
        .residual = sim->correction,
        .scale = sim->scale_row,
        .stiffness = sim->stiffness_diagonal,
        .inertia = sim->inertia_diagonal,
    };
    return run;
}

dmb_friction_law dmb_sliding_law(const dmb_friction_law *law)
{
    dmb_friction_law sliding = *law;
    sliding.kind = DMB_FRICTION_STRIBECK;
    sliding.smoothing_speed = 0.0;
    return sliding;
}

void dmb_gather_contacts(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    dmb_wall_run run = run_of(evaluation->sim);
    if (scene->friction_law.kind != DMB_FRICTION_NONE && (evaluation->dynamic || evaluation->slipping))
        run.friction_law = &scene->friction_law;
    dmb_friction_law sliding;
    if (evaluation->steady && run.friction_law != NULL && run.bristles) {
        sliding = dmb_sliding_law(run.friction_law);
        run.friction_law = &sliding;
        run.bristles = 0;
    }
    run.slip[0] = evaluation->slip[0];
    run.slip[1] = evaluation->slip[1];
    run.step = evaluation->step;
    run.velocity_factor = evaluation->velocity_factor;
    run.dynamic = evaluation->dynamic;
    run.tangent = evaluation->tangent;
    run.rounding = evaluation->rounding;
    run.potential = evaluation->power[DMB_POWER_POTENTIAL];
    run.impact = evaluation->power[DMB_POWER_IMPACT];
    run.friction = evaluation->power[DMB_POWER_FRICTION];
    scene->kernels->walls(&run);
    evaluation->rounding = run.rounding;
    evaluation->power[DMB_POWER_POTENTIAL] = run.potential;
    evaluation->power[DMB_POWER_IMPACT] = run.impact;
    evaluation->power[DMB_POWER_FRICTION] = run.friction;
}

/* ---- Questions about a finished configuration -------------------------------------------------------------------- */

void dmb_finished_friction(const dmb_friction_law *law, const double *bristle, int32_t sticks, dmb_site_force *out)
{
    const double N = out->normal_force, *slip = out->slip;
    double z[2], dv[4], dN[2];
    int32_t unused;
    out->friction[0] = out->friction[1] = 0.0;
    out->sticks = sticks;
    if (law->kind == DMB_FRICTION_NONE) return;
    if (law->kind == DMB_FRICTION_BRISTLE)
        dmb_friction_bristle(law, N, slip, bristle, slip, sticks, 0.0, z, out->friction, dv, dN, &unused);
    else
        dmb_friction_smooth(law, N, slip, out->friction, dv, dN);
}

void dmb_assumed_friction(const dmb_friction_law *law, const dmb_configuration *configuration, double radius,
                          dmb_site_force *out)
{
    const double v[2] = {configuration->friction_slip[0], radius * configuration->friction_slip[1]};
    double dv[4], dN[2];
    if ((v[0] == 0.0 && v[1] == 0.0) || !out->closed) return;
    dmb_friction_smooth(law, out->normal_force, v, out->friction, dv, dN);
    out->sticks = 0;
}

/* Closest point of the axis, the direction from it and the speeds there. */
static void frame_of(const dmb_scene *scene, const dmb_configuration *c, uint32_t s, dmb_site_force *out,
                     dmb_contact_frame *f)
{
    const dmb_site *site = scene->sites + s;
    double R[9], x[3], point[3], depth = c->site_depth[s];
    uint32_t segment = c->site_segment[s];
    dmb_quat_to_matrix(c->quaternion + 4 * site->node, R);
    dmb_vec3_add(scene->reference_position + 3 * site->node, c->displacement + 3 * site->node, x);
    for (int i = 0; i < 3; i++) x[i] += R[3 * i] * site->offset;
    dmb_hole_project(&scene->hole, x, &depth, &segment, point, out->tangent);
    dmb_radial(x, point, out->tangent, c->site_normal + 3 * s, &f->distance, out->normal);
    f->radius = site->radius;
    dmb_vec6_copy(c->velocity + scene->layout.row[site->node], f->V);
    dmb_arm_velocity(site->offset, f->V);
    dmb_contact_frame_at(R, out->normal, out->tangent, f);
    dmb_contact_speeds(f);
}

void dmb_site_force_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, dmb_site_force *out)
{
    const dmb_site *site = scene->sites + s;
    dmb_contact_frame f;
    double depth, dot;
    memset(out, 0, sizeof *out);
    frame_of(scene, configuration, s, out, &f);
    out->penetration = f.distance - site->clearance;
    out->rate = f.speed[0];
    out->slip[0] = f.speed[1];
    out->slip[1] = f.speed[2];
    if (!(out->penetration > 0.0 || site->clearance == 0.0)) return;
    const double *assumed = configuration->friction_slip;
    const double rate = assumed[0] != 0.0 || assumed[1] != 0.0 ? 0.0 : out->rate; /* statics know none */
    dmb_normal_force(&scene->normal_law, fmax(out->penetration, DMB_CONTACT_PENETRATION), rate,
                     configuration->site_approach[s], &out->normal_force, &depth, &dot);
    out->normal_force *= site->length;
    out->closed = 1;
    const int32_t bristles = dmb_scene_has_bristles(scene);
    dmb_finished_friction(&scene->friction_law, bristles ? configuration->site_bristle + 2 * s : NULL,
                          bristles ? configuration->site_sticks[s] : 0, out);
}
