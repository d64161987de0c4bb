#include "system/release.h"

#include <string.h>

#include "element/beam.h"
#include "math/so3.h"
#include "system/assemble/wall_contact.h"
#include "system/assemble/wall_contact_inside.h"
#include "system/solve/solve.h"

static int opens(const dmb_sim *sim, uint32_t s)
{
    return sim->scene->sites[s].clearance > 0.0 && sim->now.site_penetration[s] > 0.0 &&
           !(sim->trial.site_penetration[s] > 0.0);
}

int32_t dmb_contact_changes(const dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++) {
        const int closed = sim->trial.site_penetration[s] > 0.0;
        if ((sim->now.site_penetration[s] > 0.0) != closed) return 1;
        if (closed && dmb_vec3_dot(sim->now.site_normal + 3 * s, sim->trial.site_normal + 3 * s) < 0.9) return 1;
    }
    return 0;
}

int32_t dmb_contact_opens(const dmb_sim *sim)
{
    for (uint32_t s = 0; s < sim->scene->site_count; s++)
        if (opens(sim, s)) return 1;
    return 0;
}

void dmb_release_end(dmb_sim *sim)
{
    memset(sim->site_return, 0, sim->scene->site_count * sizeof(double));
}

/* Part of the step after the opening, the penetration going straight from that of now to that of trial. */
static double open_part(const dmb_sim *sim, uint32_t s)
{
    const double d0 = sim->now.site_penetration[s], d1 = sim->trial.site_penetration[s];
    return d1 / (d1 - d0);
}

/* -N n + F_t t + F_b b, b = t x n, at r n from the ring's centre; as a body-frame wrench at the node. */
static void subtract_force(dmb_sim *sim, uint32_t s, double part, double *rows)
{
    const dmb_site *site = sim->scene->sites + s;
    double R[9], b[3], arm[3], force[3], moment[3], wrench[6];
    dmb_site_force f;
    dmb_site_force_of(sim->scene, &sim->now, s, &f);
    sim->site_return[s] = fmax(-f.rate, 0.0);
    dmb_vec3_cross(f.tangent, f.normal, b);
    dmb_vec3_scale(-f.normal_force, f.normal, force);
    dmb_vec3_axpy(f.friction[0], f.tangent, force);
    dmb_vec3_axpy(f.friction[1], b, force);
    dmb_vec3_scale(site->radius, f.normal, arm);
    dmb_vec3_cross(arm, force, moment);
    dmb_vec3_axpy(f.along, f.tangent, force);
    dmb_site_axes(sim->scene, &sim->now, s, R);
    dmb_mat3_tvec(R, force, wrench);
    dmb_mat3_tvec(R, moment, wrench + 3);
    dmb_site_add_wrench(sim->scene, &sim->now, s, -part, wrench, rows);
}

/* M^-1 of the forces that open, with the mass matrix factored. */
static void release(dmb_sim *sim, double *acceleration, double *part)
{
    memset(acceleration, 0, sim->scene->row_count * sizeof(double));
    memset(part, 0, sim->scene->node_count * sizeof(double));
    for (uint32_t s = 0; s < sim->scene->site_count; s++) {
        double *of_node = part + sim->scene->sites[s].node;
        if (!opens(sim, s)) continue;
        const double open = open_part(sim, s);
        *of_node = fmax(*of_node, open);
        if (dmb_is_inside(sim->scene, s)) of_node[1] = fmax(of_node[1], open);
        subtract_force(sim, s, open, acceleration);
    }
    dmb_solve_for(sim, acceleration, acceleration);
}

/* a = M^-1 sum of part times the force of each ring that opens in the step: what the history of generalized-alpha would
 * carry on as if the contact still pressed (THEORY 4). */
int32_t dmb_released_acceleration(const dmb_evaluation *evaluation, double *acceleration, double *part)
{
    dmb_sim *sim = evaluation->sim;
    dmb_evaluation mass = *evaluation;
    mass.mass_factor = 1.0;
    mass.velocity_factor = 0.0;
    mass.tangent = 1;
    mass.given = 0;
    const int32_t status = dmb_factor_mass(&mass);
    if (status >= 0) release(sim, acceleration, part);
    return status < 0 ? status : DMB_OK;
}
