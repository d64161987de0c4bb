/* How is a friction law of one's own with a memory added to the wall? A ring of 10 kg lies on the floor of a hole and
 * is pulled by 35 N sin(40 t). The library's bristles, written again here in one direction, give the same motion; a
 * LuGre law, integrated by the trapezoidal rule, is of second order in the step.
 *
 * A law computes its new state, the friction and the derivatives by slip and normal force from the accepted state, the
 * motion and the step alone; the derivatives take the state along. The sim keeps, saves and transfers the state. */
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "command_line.h"

#define STIFFNESS 1e4 /* [1/m] of the bristles over the normal force */

/* Elastic up to mu N, then sliding: z = z0 + h (v0 + v)/2 within mu/STIFFNESS, F = -N STIFFNESS z. */
static int32_t bristles(void *context, const dmb_friction_at *at, double force[2], double by_slip[4],
                        double by_normal[2], const dmb_law_memory *memory)
{
    const double half = 0.5 * memory->step, most = at->mu_dynamic / STIFFNESS;
    const double z = memory->accepted[0] + half * (at->slip_before[0] + at->slip[0]);
    (void)context;
    memory->trial[0] = fmin(fmax(z, -most), most);
    by_normal[0] = -STIFFNESS * memory->trial[0];
    by_slip[0] = fabs(z) < most ? -at->normal_force * STIFFNESS * half : 0.0;
    force[0] = at->normal_force * by_normal[0];
    return 0;
}

static double limit_of(double v)
{
    return 0.2 + 0.1 * exp(-v * v / 1e-2);
}

static double rate_of(double v, double z)
{
    return v - STIFFNESS * fabs(v) * z / limit_of(v);
}

/* LuGre (Canudas de Wit and others 1995): z' = v - STIFFNESS |v| z/g(v), F = -N STIFFNESS z. */
static int32_t lugre(void *context, const dmb_friction_at *at, double force[2], double by_slip[4], double by_normal[2],
                     const dmb_law_memory *memory)
{
    const double v = at->slip[0], half = 0.5 * memory->step, z0 = memory->accepted[0], g = limit_of(v);
    const double r = STIFFNESS * fabs(v) / g, g_v = -200.0 * v * (g - 0.2);
    const double r_v = STIFFNESS * ((v > 0.0) - (v < 0.0)) / g - r * g_v / g;
    const double z = (z0 + half * (rate_of(at->slip_before[0], z0) + v)) / (1.0 + half * r);
    (void)context;
    memory->trial[0] = z;
    by_normal[0] = -STIFFNESS * z;
    by_slip[0] = -at->normal_force * STIFFNESS * half * (1.0 - r_v * z) / (1.0 + half * r); /* with dz/dv */
    force[0] = at->normal_force * by_normal[0];
    return 0;
}

/* The place [m] of the ring after 0.05 s in `steps` steps. law NULL: the library's bristles. */
static int32_t run(dmb_friction_fn law, uint32_t steps, double *place)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_segment pull = dmb_segment_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_sim_options sharp = dmb_sim_options_default();
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    wall.normal_law = DMB_NORMAL_KELVIN_VOIGT;
    wall.friction_law = law != NULL ? DMB_FRICTION_CALLBACK : DMB_FRICTION_BRISTLE;
    wall.friction_callback = law;
    wall.friction_state_count = law != NULL ? 1 : 0;
    wall.mu_static = wall.mu_dynamic = 0.3;
    wall.bristle_stiffness = STIFFNESS;
    body.mass = 10.0;
    body.contact_diameter = 0.074;
    body.free_mask = DMB_FREE_X | DMB_FREE_Z;
    body.position[2] = -0.01 - 98.1 / wall.stiffness; /* at rest on the floor */
    pull.kind = DMB_SEGMENT_HARMONIC;
    pull.h1 = 35.0;
    pull.omega = 40.0;
    drive.kind = DMB_DRIVE_LOAD;
    sharp.newton_tolerance = 1e-12;
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = dmb_model_add_wall(model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_body(model, &body, &drive.part);
    if (status >= 0) status = dmb_model_add_time_function(model, &pull, 1, &drive.time_function);
    if (status >= 0) status = dmb_model_add_drive(model, &drive, NULL);
    if (status >= 0) status = dmb_model_compile(model, NULL);
    if (status >= 0) status = dmb_sim_create(model, &sharp, &sim);
    if (status >= 0) status = dmb_sim_steps(sim, 0.05 / steps, steps, NULL, NULL);
    *place = dmb_sim_value(sim, DMB_OUTPUT_DISPLACEMENT_X, dmb_station(drive.part, 0, 0.0));
    if (status < 0) fprintf(stderr, "%s%s\n", dmb_model_message(model), dmb_sim_message(sim));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status;
}

int main(int count, char **words)
{
    double built, again, place[4] = {0.0};
    if (count > 1)
        return command_line(count, words, "How is a friction law of one's own with a memory added to the wall?", NULL,
                            0);
    int32_t status = run(NULL, 200, &built);
    if (status >= 0) status = run(bristles, 200, &again);
    for (uint32_t i = 0; i < 4 && status >= 0; i++) status = run(lugre, 100u << i, place + i);
    if (status < 0) return 1;
    printf("bristles of the library: %.6f mm, written again: %.6f mm, difference below 1e-12 m: %s\n", 1e3 * built,
           1e3 * again, fabs(again - built) < 1e-12 ? "yes" : "no");
    for (int i = 0; i < 2; i++)
        printf("LuGre in %d, %d, %d steps: %.6f mm at last, order %.1f\n", 100 << i, 200 << i, 400 << i,
               1e3 * place[i + 2], log2(fabs((place[i] - place[i + 1]) / (place[i + 1] - place[i + 2]))));
    return 0;
}
