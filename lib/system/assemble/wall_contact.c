/* Contact points at the wall of the hole: their forces in the residual (eq:contact.wrench), the laws that an evaluation
 * uses, and questions about a finished configuration.
 *
 *     evaluation                      normal force                          friction
 *     -----------------------------   -----------------------------------   ------------------------------------------
 *     step                            law of the scene, weighted after      law of the scene
 *                                     touch (eq:touch.weights)
 *     step, contact unresolved        mean force (eq:contact.mean)          law under the mean force
 *     statics                         elastic part                          none, or at the assumed slip (`slipping`)
 *       wall_softness s               stiffness over s
 *     steady sliding or drilling      as above                              limit of bristles in sliding
 *       frictionless f                                                      coefficients times 1 - f
 *
 * Numbers of contact points: on six-DOF nodes, then inside elements, then on axial-torsional nodes. */
#include "system/assemble/assemble.h"

#include <string.h>

#include "element/beam_math.h"
#include "force/contact_law.h"
#include "kernel/kernels.h"
#include "math/so3.h"
#include "math/vec3.h"
#include "system/assemble/evaluation.h"

/* Slopes of the laws of a finished configuration, for linear analyses. An open point has none. */
void dmb_contact_slope_of(const dmb_scene *scene, const dmb_configuration *c, uint32_t site, dmb_contact_slope *out)
{
    const int full = site < scene->site_count;
    double friction[2];
    dmb_site_force f;
    memset(out, 0, sizeof *out);
    if (full)
        dmb_site_force_of(scene, c, site, &f);
    else
        dmb_axial_torsional_site_force(scene, c, site - scene->site_count, &f);
    if (!f.closed) return;
    if (full) {
        const double length = scene->sites[site].length;
        const dmb_normal_law law = dmb_normal_law_at(&scene->hole, &scene->normal_law, c->site_depth[site]);
        double force;
        dmb_normal_force(&law, fmax(f.penetration, DMB_CONTACT_PENETRATION), f.rate, c->site_impact_speed[site], &force,
                         &out->normal_by_depth, &out->normal_by_rate);
        out->normal_by_depth *= length;
        out->normal_by_rate *= length;
    }
    if (scene->friction_law.kind == DMB_FRICTION_NONE) return;
    dmb_friction_law local;
    dmb_friction_smooth(dmb_contact_friction_law(scene, c, site, &local), f.normal_force, f.slip, friction,
                        out->friction_by_slip, out->friction_by_normal);
}

uint32_t dmb_contact_node(const dmb_scene *scene, uint32_t site)
{
    return site < scene->site_count ? scene->sites[site].node
                                    : scene->axial_torsional_sites[site - scene->site_count].node;
}

/* ---- Friction of a ring that slips ------------------------------------------------------------------------------- */

/* Closest point of the hole's axis to a contact point, and the contact frame there. Depth and segment of the trial are
 * copies: a question does not move the search of the next evaluation. */
static void frame_of(const dmb_evaluation *evaluation, uint32_t s, dmb_contact_frame *f)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    const dmb_site *site = scene->sites + s;
    double R[9], x[3], at[3], tangent[3], depth = sim->trial.site_depth[s];
    uint32_t segment = sim->trial.site_segment[s];
    dmb_quat_to_matrix(sim->trial.quaternion + 4 * (size_t)site->node, R);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)site->node, sim->trial.displacement + 3 * (size_t)site->node,
                 x);
    for (int i = 0; i < 3; i++) x[i] += R[3 * i] * site->offset;
    dmb_hole_project(&scene->hole, x, &depth, &segment, at, tangent);
    f->radius = site->radius;
    dmb_contact_frame_at(R, sim->trial.site_normal + 3 * (size_t)s, tangent, f);
}

/* [N] Normal force at which the caller's law is asked: it need not be proportional to it, laws of the library are. */
static double called_normal_force(const dmb_scene *scene, const dmb_configuration *c, uint32_t site)
{
    dmb_site_force force;
    if (scene->friction_law.kind != DMB_FRICTION_CALLBACK) return 1.0;
    if (site < scene->site_count)
        dmb_site_force_of(scene, c, site, &force);
    else
        dmb_axial_torsional_site_force(scene, c, site - scene->site_count, &force);
    return force.normal_force;
}

/* Friction along and around per unit of normal force; 0: no slip. In statics the slip is the assumed one, of the whole
 * string; the surface moves with the radius of the point. */
static int friction_by_normal(const dmb_evaluation *evaluation, uint32_t s, double radius, double by_normal[2])
{
    const dmb_sim *sim = evaluation->sim;
    dmb_friction_law local, law = *dmb_contact_friction_law(sim->scene, &sim->trial, s, &local);
    double v[2] = {evaluation->slip[0], radius * evaluation->slip[1]}, force[2], by_speed[4];
    if (evaluation->dynamic) memcpy(v, sim->trial.site_slip + 2 * (size_t)s, sizeof v);
    if (law.kind == DMB_FRICTION_NONE || (v[0] == 0.0 && v[1] == 0.0)) return 0;
    if (evaluation->steady && dmb_scene_has_bristles(sim->scene)) law = dmb_sliding_law(&law);
    dmb_friction_smooth(&law, called_normal_force(sim->scene, &sim->trial, s), v, force, by_speed, by_normal);
    return 1;
}

int dmb_contact_friction_by_normal(const dmb_evaluation *evaluation, uint32_t site, double n[3], double f[6])
{
    const dmb_site *ring = evaluation->sim->scene->sites + site;
    double by_normal[2];
    dmb_contact_frame frame;
    if (!(evaluation->sim->trial.site_penetration[site] > 0.0) || dmb_is_inside(evaluation->sim->scene, site)) return 0;
    if (!friction_by_normal(evaluation, site, ring->radius, by_normal)) return 0;
    frame_of(evaluation, site, &frame);
    for (int i = 0; i < 3; i++) {
        n[i] = frame.n[i];
        f[i] = -(by_normal[0] * frame.t[i] + by_normal[1] * frame.b[i]);
        f[3 + i] = -(by_normal[0] * frame.turn_t[i] + by_normal[1] * frame.turn_b[i]);
    }
    f[4] -= ring->offset * f[2]; /* its moment about the node */
    f[5] += ring->offset * f[1];
    return 1;
}

/* Contact points of six-DOF nodes: force/contact_law by the kernels, and the contact fields of the trial. */

static dmb_site_fields fields_of(const dmb_configuration *configuration)
{
    const dmb_site_fields fields = {
        .normal = configuration->site_normal,
        .depth = configuration->site_depth,
        .penetration = configuration->site_penetration,
        .impact_speed = configuration->site_impact_speed,
        .slip = configuration->site_slip,
        .bristle = configuration->site_bristle,
        .touch = configuration->site_touch,
        .segment = configuration->site_segment,
        .sticks = configuration->site_sticks,
    };
    return fields;
}

/* Inputs and outputs of the kernels for the contact points. */
static dmb_wall_args args_of(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const dmb_wall_args args = {
        .count = dmb_node_sites(scene),
        .sites = scene->sites,
        .hole = &scene->hole,
        .normal_law = &scene->normal_law,
        .bristles = dmb_scene_has_bristles(scene),
        .states = scene->friction_law.states,
        .called = scene->friction_law.kind == DMB_FRICTION_CALLBACK,
        .touches = dmb_scene_has_touch(scene),
        .row = scene->layout.row,
        .diagonal = scene->layout.diag,
        .reference = scene->reference_position,
        .displacement = sim->trial.displacement,
        .quaternion = sim->trial.quaternion,
        .velocity = sim->trial.velocity,
        .now_quaternion = sim->now.quaternion,
        .now_velocity = sim->now.velocity,
        .now = fields_of(&sim->now),
        .site_history = sim->site_history,
        .mode = sim->site_mode,
        .coarse = sim->site_coarse,
        .trial = fields_of(&sim->trial),
        .presses = sim->site_presses,
        .residual = sim->residual,
        .scale = sim->scale_row,
        .stiffness = sim->stiffness_diagonal,
        .inertia = sim->inertia_diagonal,
    };
    return args;
}

/* Laws of a static analysis that differ from those of the scene. */
typedef struct own_laws {
    dmb_normal_law soft;
    dmb_friction_law sliding, partial;
    dmb_hole hole;
    int32_t failed; /* 1: the caller's law of friction has failed */
} own_laws;

/* Reduces the friction of contact points by the fraction `frictionless`: the coefficients of the law, and those of
 * sections of the hole. */
static void leave_friction_out(const dmb_evaluation *evaluation, own_laws *laws, dmb_wall_args *args)
{
    const double share = 1.0 - evaluation->frictionless;
    laws->partial = *args->friction_law;
    laws->partial.mu_static *= share;
    laws->partial.mu_dynamic *= share;
    laws->hole = *args->hole;
    laws->hole.friction *= share;
    args->friction_law = &laws->partial;
    args->hole = &laws->hole;
}

/* `yield` and `slows` are beta/gamma h^2/m and h/m of the first evaluation of a step, which has not yet moved by the
 * mean forces: the kernels take the tangent of such a contact at the depth that it would come to (theory/contact.md,
 * "Start of the iteration"). */
static dmb_wall_args args_for(const dmb_evaluation *evaluation, own_laws *laws)
{
    const dmb_scene *scene = evaluation->sim->scene;
    dmb_wall_args args = args_of(evaluation->sim);
    if (scene->friction_law.kind != DMB_FRICTION_NONE && (evaluation->dynamic || evaluation->slipping))
        args.friction_law = &scene->friction_law;
    if (evaluation->wall_softness > 0.0) {
        laws->soft = scene->normal_law;
        laws->soft.stiffness /= evaluation->wall_softness;
        args.normal_law = &laws->soft;
    }
    args.softer = evaluation->wall_softness > 0.0 ? evaluation->wall_softness : 1.0;
    args.failed = &laws->failed;
    if (evaluation->steady && args.friction_law != NULL && args.bristles) {
        laws->sliding = dmb_sliding_law(args.friction_law);
        args.friction_law = &laws->sliding;
        args.bristles = 0;
    }
    if (evaluation->frictionless > 0.0 && args.friction_law != NULL) leave_friction_out(evaluation, laws, &args);
    args.slip[0] = evaluation->slip[0];
    args.slip[1] = evaluation->slip[1];
    args.step = evaluation->step;
    args.own_factor = evaluation->dynamic && evaluation->step > 0.0 ? evaluation->own_factor : 0.0;
    if (evaluation->predicted && args.own_factor > 0.0) { /* beta/gamma h^2 and h of the acceleration */
        args.yield = evaluation->step / evaluation->velocity_factor * scene->site_mobility;
        args.slows = evaluation->step * scene->site_mobility;
    }
    args.bounces = args.own_factor > 0.0 && *evaluation->sim->sites_bounce;
    args.velocity_factor = evaluation->velocity_factor;
    args.dynamic = evaluation->dynamic;
    args.tangent = evaluation->tangent;
    return args;
}

/* Sums of powers and rounding continue those of the evaluation, whose order of addition is part of the result's bits.
 */
void dmb_assemble_contacts(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    own_laws laws;
    laws.failed = 0;
    dmb_wall_args args = args_for(evaluation, &laws);
    args.rounding = evaluation->rounding;
    args.potential = evaluation->power[DMB_POWER_POTENTIAL];
    args.impact = evaluation->power[DMB_POWER_IMPACT];
    args.friction = evaluation->power[DMB_POWER_FRICTION];
    dmb_press_sites(evaluation->sim, &args);
    if (scene->inside_count > 0) dmb_assemble_contacts_inside(evaluation, 0, &args);
    evaluation->rounding = args.rounding;
    evaluation->power[DMB_POWER_POTENTIAL] = args.potential;
    evaluation->power[DMB_POWER_IMPACT] = args.impact;
    evaluation->power[DMB_POWER_FRICTION] = args.friction;
    if (laws.failed) dmb_friction_failed(evaluation);
}

/* Normal force of the step from its weighted value in memory (DMB_TOUCH_FORCE); friction and the force along a sloped
 * wall are in proportion to it. */
void dmb_site_weighted_force(const dmb_sim *sim, const dmb_configuration *c, uint32_t s, dmb_site_force *f)
{
    if (!dmb_scene_has_touch(sim->scene)) return;
    const double whole = c->site_touch[DMB_TOUCH_SIZE * (size_t)s + DMB_TOUCH_FORCE];
    const double normal = sim->scene->sites[s].length * fmax(whole, 0.0);
    const double ratio = f->normal_force > 0.0 ? normal / f->normal_force : 0.0;
    f->normal_force = normal;
    f->friction[0] *= ratio;
    f->friction[1] *= ratio;
    f->along *= ratio;
}

void dmb_contacts_accept(dmb_evaluation *evaluation)
{
    own_laws laws;
    dmb_wall_args args = args_for(evaluation, &laws);
    args.tangent = 0;
    dmb_assemble_contacts_inside(evaluation, 1, &args);
}

/* ---- Questions about a finished configuration -------------------------------------------------------------------- */

void dmb_assumed_friction(const dmb_friction_law *law, const dmb_configuration *configuration, double radius,
                          dmb_site_force *out)
{
    const double v[2] = {configuration->friction_slip[0], radius * configuration->friction_slip[1]};
    double dv[4], dN[2];
    if ((v[0] == 0.0 && v[1] == 0.0) || !out->closed) return;
    dmb_friction_smooth(law, out->normal_force, v, out->friction, dv, dN);
    out->sticks = 0;
}

/* Axes, centre [m] (world) and velocity of a contact point. */
static void motion_of(const dmb_scene *scene, const dmb_configuration *c, uint32_t s, double R[9], double x[3],
                      double V[6])
{
    const dmb_site *site = scene->sites + s;
    if (dmb_is_inside(scene, s)) {
        dmb_point_motion motion;
        dmb_point_motion_of(scene, c, dmb_inside_point(scene, s), &motion);
        memcpy(R, motion.R, sizeof motion.R);
        dmb_vec3_add(scene->reference_position + 3 * (size_t)site->node, motion.x, x);
        dmb_vec6_copy(motion.V, V);
        return;
    }
    dmb_quat_to_matrix(c->quaternion + 4 * (size_t)site->node, R);
    dmb_vec3_add(scene->reference_position + 3 * (size_t)site->node, c->displacement + 3 * (size_t)site->node, x);
    for (int i = 0; i < 3; i++) x[i] += R[3 * i] * site->offset;
    dmb_vec6_copy(c->velocity + scene->layout.row[site->node], V);
    dmb_arm_velocity(site->offset, V);
}

/* Closest point of the axis, its depth, the direction from it, and the speeds at the contact point. Reads the
 * configuration only: depth and segment are copies. */
static double site_frame_of(const dmb_scene *scene, const dmb_configuration *c, uint32_t s, dmb_site_force *out,
                            dmb_contact_frame *f)
{
    const dmb_site *site = scene->sites + s;
    double R[9], x[3], point[3], depth = c->site_depth[s];
    uint32_t segment = c->site_segment[s];
    motion_of(scene, c, s, R, x, f->V);
    dmb_hole_project(&scene->hole, x, &depth, &segment, point, out->tangent);
    dmb_radial(x, point, out->tangent, c->site_normal + 3 * s, &f->distance, out->normal);
    f->radius = site->radius;
    dmb_contact_frame_at(R, out->normal, out->tangent, f);
    dmb_contact_speeds(f);
    return depth;
}

/* Constants of the wall at that depth, penetration and its rate (force/hole.h), and the friction law there. */
static void local_force(const dmb_scene *scene, const dmb_site *site, double depth, const dmb_contact_frame *f,
                        double impact_speed, double still, dmb_friction_law *friction, dmb_site_force *out)
{
    dmb_local_wall wall;
    double point[3], k[3], by_depth, by_rate;
    dmb_local_wall_at(&scene->hole, &scene->normal_law, &scene->friction_law, depth, 1.0, &wall);
    dmb_hole_frame(&scene->hole, depth, point, NULL, k);
    const double advance = dmb_hole_advance(f->distance, out->normal, k), rho = wall.radius_slope * advance;
    out->rho = rho;
    out->penetration = f->distance - (wall.radius - site->radius);
    out->rate = f->speed[0] - rho * dmb_vec3_dot(f->t, f->V);
    *friction = wall.friction;
    if (!(out->penetration > 0.0)) return;
    dmb_normal_force(&wall.normal, out->penetration, still * out->rate, impact_speed, &out->normal_force, &by_depth,
                     &by_rate);
    out->normal_force *= site->length;
    out->along = rho * out->normal_force -
                 advance * site->length * wall.stiffness_slope * dmb_wall_unit_energy(&wall.normal, out->penetration);
    out->closed = 1;
}

/* In a hole without sections a contact point without clearance is always closed, at a penetration of at least
 * DMB_CONTACT_PENETRATION. In statics with an assumed slip dampers do not act. */
void dmb_site_force_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, dmb_site_force *out)
{
    const dmb_site *site = scene->sites + s;
    const dmb_friction_law *law = &scene->friction_law;
    dmb_friction_law local;
    dmb_contact_frame f;
    double depth, dot;
    memset(out, 0, sizeof *out);
    const double place = site_frame_of(scene, configuration, s, out, &f);
    out->penetration = f.distance - site->clearance;
    out->rate = f.speed[0];
    out->slip[0] = f.speed[1];
    out->slip[1] = f.speed[2];
    const double *assumed = configuration->friction_slip;
    const double still = assumed[0] != 0.0 || assumed[1] != 0.0 ? 0.0 : 1.0; /* statics have no speed */
    if (scene->hole.pieces > 0) {
        local_force(scene, site, place, &f, configuration->site_impact_speed[s], still, &local, out);
        law = &local;
    } else if (out->penetration > 0.0 || site->clearance == 0.0) {
        dmb_normal_force(&scene->normal_law, fmax(out->penetration, DMB_CONTACT_PENETRATION), still * out->rate,
                         configuration->site_impact_speed[s], &out->normal_force, &depth, &dot);
        out->normal_force *= site->length;
        out->closed = 1;
    }
    if (!out->closed) return;
    const int32_t bristles = dmb_scene_has_bristles(scene);
    dmb_finished_friction(law, bristles ? configuration->site_bristle + scene->friction_law.states * (size_t)s : NULL,
                          bristles ? configuration->site_sticks[s] : 0, out);
}

/* An open point has no present bristle: its friction is the limit of the law in steady sliding. */
void dmb_site_rub(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, dmb_site_force *f)
{
    dmb_friction_law local;
    const dmb_friction_law *law = dmb_contact_friction_law(scene, configuration, s, &local);
    const int bristles = dmb_friction_has_memory(law);
    const dmb_friction_law sliding = dmb_sliding_law(law);
    if (bristles && !f->closed)
        dmb_finished_friction(&sliding, NULL, 0, f);
    else
        dmb_finished_friction(law,
                              bristles ? configuration->site_bristle + scene->friction_law.states * (size_t)s : NULL,
                              bristles ? configuration->site_sticks[s] : 0, f);
}

double dmb_site_elastic_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s,
                              const dmb_site_force *f)
{
    const dmb_normal_law law = dmb_normal_law_at(&scene->hole, &scene->normal_law, configuration->site_depth[s]);
    double force, by_depth, by_rate;
    dmb_normal_force(&law, f->penetration, 0.0, 1.0, &force, &by_depth, &by_rate);
    return scene->sites[s].length * force;
}

/* Force of the damper times the rate of penetration: what the normal force does beyond its elastic part. */
double dmb_site_heat(const dmb_sim *sim, const dmb_configuration *c, uint32_t s, const dmb_site_force *f)
{
    return -(f->normal_force - dmb_site_elastic_force(sim->scene, c, s, f)) * f->rate;
}

double dmb_site_rubbed(const dmb_site_force *f)
{
    return f->friction[0] * f->slip[0] + f->friction[1] * f->slip[1];
}

/* Wrench -N n + F_t t + F_b b, b = t x n, at r n from the centre, in body axes at the contact point. */
void dmb_site_add_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double factor,
                        const dmb_site_force *f, double *rows)
{
    double R[9], b[3], arm[3], force[3], moment[3], wrench[6];
    dmb_vec3_cross(f->tangent, f->normal, b);
    dmb_vec3_scale(-f->normal_force, f->normal, force);
    dmb_vec3_axpy(f->friction[0], f->tangent, force);
    dmb_vec3_axpy(f->friction[1], b, force);
    dmb_vec3_scale(scene->sites[s].radius, f->normal, arm);
    dmb_vec3_cross(arm, force, moment);
    dmb_vec3_axpy(f->along, f->tangent, force);
    dmb_site_axes(scene, configuration, s, R);
    dmb_mat3_tvec(R, force, wrench);
    dmb_mat3_tvec(R, moment, wrench + 3);
    dmb_site_add_wrench(scene, configuration, s, factor, wrench, rows);
}

/* ---- What a configuration remembers of its contacts -------------------------------------------------------------- */

void dmb_contact_place(dmb_sim *sim, uint32_t s, double depth)
{
    const dmb_hole *hole = &sim->scene->hole;
    sim->now.site_depth[s] = depth;
    sim->now.site_segment[s] = dmb_hole_is_straight(hole) ? 0 : dmb_hole_segment_at(hole, depth);
}

/* Only nodes moved by the assembly change before time 0, and may reach another section of the hole. */
void dmb_contacts_follow_assembly(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    if (dmb_hole_is_straight(&scene->hole)) return;
    for (uint32_t s = 0; s < scene->site_count; s++) {
        const double moved = dmb_vec3_norm(sim->now.displacement + 3 * (size_t)scene->sites[s].node);
        double R[9], x[3], V[6], depth;
        if (!(moved > 0.0)) continue;
        motion_of(scene, &sim->now, s, R, x, V);
        (void)dmb_hole_search(&scene->hole, x, sim->now.site_depth[s], 2.0 * moved, NULL, &depth);
        dmb_contact_place(sim, s, depth);
    }
}

void dmb_contacts_start(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t s = 0; s < scene->site_count; s++) {
        const double down[3] = {0.0, 0.0, -1.0}; /* until a normal is defined */
        dmb_vec3_copy(down, sim->now.site_normal + 3 * s);
        dmb_contact_place(sim, s, scene->reference_depth[scene->sites[s].node] + scene->sites[s].offset);
    }
}

/* Stored with the trial, because questions about it later need the slip under which its friction acts; 0 without one.
 */
void dmb_contacts_assume_slip(const dmb_evaluation *evaluation)
{
    for (int i = 0; i < 2; i++)
        evaluation->sim->trial.friction_slip[i] = evaluation->slipping ? evaluation->slip[i] : 0.0;
}

void dmb_contacts_copy_slip(dmb_sim *sim)
{
    memcpy(sim->now.friction_slip, sim->trial.friction_slip, 2 * sizeof(double));
}

void dmb_contacts_copy_touch(dmb_sim *sim)
{
    if (!dmb_scene_has_touch(sim->scene)) return;
    memcpy(sim->now.site_touch, sim->trial.site_touch, DMB_TOUCH_SIZE * sim->scene->site_count * sizeof(double));
}

void dmb_contacts_forget(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    if (dmb_scene_has_bristles(scene)) {
        memset(sim->trial.site_bristle, 0, scene->friction_law.states * scene->site_count * sizeof(double));
        memset(sim->trial.axial_torsional_bristle, 0,
               scene->friction_law.states * (size_t)scene->axial_torsional_site_count * sizeof(double));
    }
    memset(sim->trial.site_impact_speed, 0, scene->site_count * sizeof(double));
    if (dmb_scene_has_touch(scene))
        memset(sim->trial.site_touch, 0, DMB_TOUCH_SIZE * scene->site_count * sizeof(double));
}

/* [-] Deflection over the sticking limit, so that rounding does not make a sliding bristle stick. */
#define DMB_SLIDING_BEYOND (1.0 + 1e-9)

/* z = mu(|v|)/sigma0 v/|v|: bristle deflection in steady sliding; or the state of the caller's law. Its own slip is the
 * argument; with an infinite step the caller's law reaches its steady state. */
static int32_t deflect(const dmb_sim *sim, uint32_t site, const double v[2], double *z, int32_t *sticks)
{
    static const double none[DMB_FRICTION_STATES] = {0.0};
    dmb_friction_law local;
    const dmb_friction_law *law = dmb_contact_friction_law(sim->scene, &sim->now, site, &local);
    const double N = called_normal_force(sim->scene, &sim->now, site);
    const dmb_friction_at at = {N, {v[0], v[1]}, {v[0], v[1]}, law->mu_static, law->mu_dynamic};
    const dmb_friction_law sliding = dmb_sliding_law(law);
    const dmb_law_memory memory = {none, z, (double)INFINITY};
    dmb_friction_result of;
    double F[2], dv[4], dN[2];
    *sticks = 0;
    if (law->kind == DMB_FRICTION_CALLBACK) return dmb_friction_call(law, &at, &memory, &of);
    dmb_friction_smooth(&sliding, N, v, F, dv, dN);
    for (int i = 0; i < 2; i++) z[i] = -DMB_SLIDING_BEYOND * F[i] / law->bristle_stiffness;
    return DMB_OK;
}

int32_t dmb_contacts_slide(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    const size_t states = scene->friction_law.states;
    int32_t status = DMB_OK;
    if (!dmb_scene_has_bristles(scene)) return DMB_OK;
    for (uint32_t s = 0; s < scene->site_count && status >= 0; s++)
        if (sim->now.site_penetration[s] > 0.0 || scene->sites[s].clearance == 0.0)
            status = deflect(sim, s, sim->now.site_slip + 2 * (size_t)s, sim->now.site_bristle + states * s,
                             sim->now.site_sticks + s);
    for (uint32_t p = 0; p < scene->axial_torsional_site_count && status >= 0; p++)
        status = deflect(sim, scene->site_count + p, sim->now.axial_torsional_slip + 2 * (size_t)p,
                         sim->now.axial_torsional_bristle + states * p, sim->now.axial_torsional_sticks + p);
    if (status < 0) sim->reduced_mode->force = scene->force_count + 1;
    return status;
}
