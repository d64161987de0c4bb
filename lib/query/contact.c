/* Sites are counted FULL ones first (strings, then bodies), then those of PATH nodes. */
#include <math.h>

#include "math/vec3.h"
#include "sim/access.h"
#include "system/assemble/wall_contact.h"

DMB_DECLARE_STRUCT(dmb_contact)
DMB_DECLARE_STRUCT(dmb_contact_total)

static uint64_t site_count(const dmb_scene *scene)
{
    return (uint64_t)scene->site_count + scene->path_site_count;
}

static void force_of(const dmb_sim *sim, uint32_t site, dmb_site_force *force)
{
    const dmb_scene *scene = sim->scene;
    const uint32_t full = scene->site_count;
    if (site < full)
        dmb_site_force_of(scene, &sim->now, site, force);
    else
        dmb_path_site_force_of(scene, &sim->now, site - full, force);
    dmb_friction_law local;
    dmb_assumed_friction(dmb_contact_friction_law(scene, &sim->now, site, &local), &sim->now,
                         site < full ? scene->sites[site].radius : scene->path_sites[site - full].radius, force);
}

static void describe(const dmb_scene *scene, uint32_t site, dmb_contact *contact)
{
    const uint32_t full = scene->site_count;
    contact->site = site;
    contact->part = site < full ? scene->sites[site].part : scene->path_sites[site - full].part;
    contact->pipe = site < full ? scene->sites[site].pipe : scene->path_sites[site - full].pipe;
    contact->length = site < full ? scene->sites[site].length : scene->path_sites[site - full].length;
}

int32_t dmb_query_contact(const dmb_sim *sim, uint32_t site, dmb_contact *contact)
{
    const int32_t status = dmb_ask(sim, contact);
    dmb_site_force force;
    dmb_contact answer = {0};
    if (status < 0) return status;
    if (site >= site_count(sim->scene)) return DMB_ERR_VALUE;
    force_of(sim, site, &force);
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

int32_t dmb_query_contact_total(const dmb_sim *sim, dmb_contact_total *sum)
{
    const int32_t status = dmb_ask(sim, sum);
    dmb_contact_total answer = {0};
    if (status < 0) return status;
    for (uint32_t i = 0; i < site_count(sim->scene); i++) {
        dmb_site_force force;
        force_of(sim, i, &force);
        if (!force.closed) continue;
        answer.closed++;
        answer.normal_force += force.normal_force;
        answer.friction[0] += force.friction[0];
        answer.friction[1] += force.friction[1];
        answer.deepest = fmax(answer.deepest, force.penetration);
    }
    return dmb_contact_total_write(sum, &answer);
}
