/* The wall at the accepted state: contact, the hole at a depth, places that can be stuck. Contact points are numbered
 * with those of six-DOF nodes first (strings, then bodies), then those of axial-torsional nodes. */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/sized_struct.h"
#include "drillmbd/ask.h"
#include "drillmbd/scene.h"
#include "force/hole.h"
#include "math/real.h"
#include "math/vec3.h"
#include "model/field_check.h"
#include "model/model.h"
#include "model/scene.h"
#include "query/query.h"
#include "sim/access.h"
#include "system/assemble/assemble.h"

/* ---- Contact ----------------------------------------------------------------------------------------------------- */

DMB_DECLARE_STRUCT(dmb_contact)
DMB_DECLARE_STRUCT(dmb_contact_total)

static uint64_t site_count(const dmb_scene *scene)
{
    return (uint64_t)scene->site_count + scene->axial_torsional_site_count;
}

void dmb_contact_force_of(const dmb_sim *sim, uint32_t site, dmb_site_force *force)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t full = scene->site_count;
    if (site < full)
        dmb_site_force_of(scene, &sim->now, site, force);
    else
        dmb_axial_torsional_site_force(scene, &sim->now, site - full, force);
    dmb_friction_law local;
    dmb_assumed_friction(dmb_contact_friction_law(scene, &sim->now, site, &local), &sim->now,
                         site < full ? scene->sites[site].radius : scene->axial_torsional_sites[site - full].radius,
                         force);
}

/* True if the caller's law of friction has failed in this query: it then leaves NaN as friction. */
static bool has_failed(const dmb_site_force *force)
{
    return isnan(force->friction[0]);
}

static void describe(const dmb_scene *scene, uint32_t site, dmb_contact *contact)
{
    const uint32_t full = scene->site_count;
    contact->number = site;
    contact->part = site < full ? scene->sites[site].part : scene->axial_torsional_sites[site - full].part;
    contact->pipe = site < full ? scene->sites[site].pipe : scene->axial_torsional_sites[site - full].pipe;
    contact->length = site < full ? scene->sites[site].length : scene->axial_torsional_sites[site - full].length;
}

int32_t dmb_answer_contact(const dmb_sim *sim, uint32_t site, dmb_contact *contact)
{
    const int32_t status = dmb_ask(sim, contact);
    dmb_site_force force;
    dmb_contact answer = {0};
    if (status < 0) return status;
    if (site >= site_count(sim->scene)) return DMB_ERR_VALUE;
    dmb_contact_force_of(sim, site, &force);
    if (has_failed(&force)) return DMB_ERR_CALLBACK;
    describe(sim->scene, site, &answer);
    answer.closed = force.closed;
    answer.sticks = force.sticks;
    answer.gap = -force.penetration;
    dmb_vec3_copy(force.normal, answer.normal);
    answer.normal_force = force.normal_force;
    answer.along = force.along;
    answer.approach = force.rate;
    for (int i = 0; i < 2; i++) {
        answer.friction[i] = force.friction[i];
        answer.slip[i] = force.slip[i];
    }
    return dmb_contact_write(contact, &answer);
}

/* Sums of amounts over all closed contacts: normal forces as magnitudes, frictions with their signs along and around
 * the hole. */
int32_t dmb_answer_contact_total(const dmb_sim *sim, dmb_contact_total *sum)
{
    const int32_t status = dmb_ask(sim, sum);
    dmb_contact_total answer = {0};
    if (status < 0) return status;
    for (uint32_t i = 0; i < site_count(sim->scene); i++) {
        dmb_site_force force;
        dmb_contact_force_of(sim, i, &force);
        if (has_failed(&force)) return DMB_ERR_CALLBACK;
        if (!force.closed) continue;
        answer.closed++;
        answer.normal_force += force.normal_force;
        answer.friction[0] += force.friction[0];
        answer.friction[1] += force.friction[1];
        answer.deepest = fmax(answer.deepest, force.penetration);
    }
    return dmb_contact_total_write(sum, &answer);
}

/* ---- The hole ---------------------------------------------------------------------------------------------------- */

DMB_DEFINE_INIT(dmb_hole_point, 120, {.beyond = DMB_HOLE_SURVEYED, .section = DMB_NONE})

#define VERTICAL 1e-9 /* [-] closer to the vertical the azimuth is undefined */

static int32_t hole_of(const dmb_model *model, const dmb_hole **hole)
{
    if (model == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return DMB_ERR_HANDLE;
    if (model->scene == NULL) return DMB_ERR_ORDER;
    if (!model->scene->has_hole) return DMB_ERR_UNSUPPORTED;
    *hole = &model->scene->hole;
    return DMB_OK;
}

/* Range of the description: a survey without a bend is stored as a straight hole. */
static int32_t beyond(const dmb_wall_def *wall, double depth)
{
    if (wall->survey_count == 0) return DMB_HOLE_SURVEYED;
    if (depth < wall->survey[0]) return DMB_HOLE_ABOVE;
    return depth > wall->survey[3 * (size_t)(wall->survey_count - 1)] ? DMB_HOLE_BELOW : DMB_HOLE_SURVEYED;
}

/* World axes z up, x north, y west: inclination from the downward vertical, azimuth clockwise from north; 0 in a
 * vertical hole. */
static void direction(dmb_hole_point *point)
{
    const double *t = point->tangent;
    const double across = hypot(t[0], t[1]);
    point->inclination = atan2(across, -t[2]);
    point->azimuth = across > VERTICAL ? atan2(0.0 - t[1], t[0]) : 0.0;
}

/* Last section that begins at or above the depth; DMB_NONE if there is none. */
static uint32_t section_at(const dmb_model *model, double depth)
{
    uint32_t low = 0, high = model->sections.count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (DMB_LIST_AT(const dmb_hole_section, model->sections, middle)->depth <= depth)
            low = middle + 1;
        else
            high = middle;
    }
    return low > 0 ? low - 1 : DMB_NONE;
}

static void read_wall(const dmb_model *model, const dmb_hole *hole, double depth, dmb_hole_point *point)
{
    const dmb_wall_def *wall = &model->wall;
    const uint32_t section = section_at(model, depth);
    double v[DMB_WALL_COUNT] = {0.0, /* the radius is set below, from the present state of the hole */
                                wall->stiffness,
                                wall->restitution,
                                wall->damping,
                                wall->mu_static,
                                wall->mu_dynamic,
                                0.0};
    if (hole->pieces > 0)
        for (int k = 0; k < DMB_WALL_COUNT; k++) v[k] = dmb_hole_piece_value(dmb_hole_piece_at(hole, depth), k, depth);
    point->diameter = 2.0 * dmb_hole_radius(hole, depth);
    point->stiffness = v[DMB_WALL_STIFFNESS];
    point->restitution = v[DMB_WALL_RESTITUTION];
    point->damping = v[DMB_WALL_DAMPING];
    point->mu_static = v[DMB_WALL_MU_STATIC];
    point->mu_dynamic = v[DMB_WALL_MU_DYNAMIC];
    point->strength = v[DMB_WALL_STRENGTH];
    point->section = section;
    if (section == DMB_NONE) return;
    memcpy(point->section_name, DMB_LIST_AT(const dmb_hole_section, model->sections, section)->name,
           sizeof point->section_name);
}

static int32_t report_hole(const dmb_model *model, const dmb_hole *hole, double depth, dmb_hole_point *point)
{
    dmb_hole_point answer = {0};
    double bend[3];
    if (!isfinite(depth)) return DMB_ERR_NOT_FINITE;
    if (fabs(depth) > DMB_POSITION_MAX) return DMB_ERR_VALUE;
    dmb_hole_frame(hole, depth, answer.position, answer.tangent, bend);
    answer.beyond = beyond(&model->wall, depth);
    answer.curvature = dmb_vec3_norm(bend);
    for (int i = 0; i < 3; i++) answer.normal[i] = answer.curvature > 0.0 ? bend[i] / answer.curvature : 0.0;
    answer.dogleg_severity = answer.curvature * 30.0 * 180.0 / DMB_PI;
    direction(&answer);
    read_wall(model, hole, depth, &answer);
    return dmb_hole_point_write(point, &answer);
}

int32_t dmb_query_hole(const dmb_model *model, double depth, dmb_hole_point *point)
{
    const dmb_hole *hole;
    const int32_t status = hole_of(model, &hole);
    if (status < 0) return dmb_model_failed(model, "hole", status);
    return dmb_model_failed(model, "hole", point == NULL ? DMB_ERR_NULL : report_hole(model, hole, depth, point));
}

int32_t dmb_answer_hole_now(const dmb_sim *sim, double depth, dmb_hole_point *point)
{
    const int32_t status = dmb_ask(sim, point);
    if (status < 0) return status;
    return sim->scene->has_hole ? report_hole(sim->model, &sim->scene->hole, depth, point) : DMB_ERR_UNSUPPORTED;
}

/* ---- Places that can be stuck ------------------------------------------------------------------------------------ */

DMB_DEFINE_INIT(dmb_stuck_state, 88, {.stuck = 0})

int32_t dmb_answer_stuck(const dmb_sim *sim, dmb_id stuck, dmb_stuck_state *state)
{
    const int32_t status = dmb_ask(sim, state);
    dmb_stuck_state answer = {0};
    if (status < 0) return status;
    const uint32_t i = dmb_model_part_index(sim->model, stuck, DMB_PART_STUCK);
    if (i >= sim->scene->stuck_count) return DMB_ERR_ID;
    const dmb_scene_stuck *of = sim->scene->stuck + i;
    if (sim->stuck_held[i]) {
        const double stiffness[4] = {of->stiffness[0], of->stiffness[2], of->stiffness[2], of->stiffness[1]};
        dmb_stuck_hold hold;
        dmb_stuck_hold_of(sim, &sim->now, i, 1, &hold);
        answer.stuck = 1;
        memcpy(answer.offset, hold.s, sizeof answer.offset);
        for (int k = 0; k < DMB_STUCK_COORDINATES; k++) {
            answer.force[k] = -hold.force[k];
            answer.energy += 0.5 * stiffness[k] * hold.s[k] * hold.s[k];
        }
        answer.share = dmb_stuck_ratio(sim, &sim->now, i, 1);
    }
    return dmb_stuck_state_write(state, &answer);
}
