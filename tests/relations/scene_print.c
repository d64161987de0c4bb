/* A scene in a line. */
#include <math.h>
#include <stdio.h>

#include "scene_draw.h"

const char *scene_family_name(uint32_t family)
{
    switch (family) {
    case FAMILY_HOLE: return "hole";
    case FAMILY_BENT: return "bent";
    case FAMILY_LINE: return "line";
    case FAMILY_FREE: return "free";
    case FAMILY_STABILISER: return "stabiliser";
    default: return "bodies";
    }
}

static void print_strings(const scene *s)
{
    static const char *const kinds[] = {"flexible", "axial_torsional", "rigid"};
    const dmb_pipe_def *const p = &s->string[0].pipe[0];
    if (s->strings == 0) return;
    printf(" pipes=");
    for (uint32_t k = 0; k < s->strings; ++k) printf("%s%u", k > 0 ? "+" : "", (unsigned)s->string[k].pipes);
    printf(" kind=%s elements=%u length=%.4g od_mm=%.4g id_mm=%.4g tool_joint=%.3g damping_time=%g start_free=%d",
           kinds[p->kind], (unsigned)p->elements, p->length, 1e3 * p->outer_diameter, 1e3 * p->inner_diameter,
           p->joint_length, p->damping_time, (int)s->string[0].def.start_free);
}

static void print_wall(const scene *s)
{
    static const char *const normal[] = {"kelvin_voigt", "hunt_crossley", "lankarani", "flores", "exact", "impact"};
    static const char *const friction[] = {"none", "coulomb", "ambrosio", "stribeck", "bristle"};
    if (!s->has_wall) return;
    printf(" hole_mm=%.4g stiffness=%.3g normal=%s friction=%s mu=%.3g inclination_deg=%.4g", 1e3 * s->wall.diameter,
           s->wall.stiffness, normal[s->wall.normal_law], friction[s->wall.friction_law + 1], s->wall.mu_static,
           180.0 / PI * asin(s->wall.direction[2]));
    if (s->has_bit) printf(" bit=%d", (int)s->bit.rock_law);
}

void scene_print(const scene *s)
{
    printf("  seed %llu scene %u: %s dt=%.4g radius=%.3g drag=%.3g mud=%.4g", (unsigned long long)s->seed,
           (unsigned)s->number, scene_family_name(s->family), s->step, s->radius, s->environment.lateral_damping,
           s->environment.fluid_density);
    print_strings(s);
    print_wall(s);
    printf(" bodies=%u joints=", (unsigned)s->bodies);
    for (uint32_t i = 0; i < s->joints; ++i) printf("%s%d", i > 0 ? "," : "", (int)s->joint[i].def.kind);
    printf(" drives=");
    for (uint32_t i = 0; i < s->drives; ++i)
        printf("%s%d:%d:%.4g", i > 0 ? "," : "", (int)s->drive[i].def.component, (int)s->drive[i].def.kind,
               s->drive[i].time_function.term[0].h1);
    for (uint32_t i = 0; i < s->loads; ++i) {
        const dmb_load_def *const l = &s->load[i].def;
        printf(" load=%d:%.4g,%.4g,%.4g;%.4g,%.4g,%.4g", (int)l->frame, l->force[0], l->force[1], l->force[2],
               l->moment[0], l->moment[1], l->moment[2]);
    }
    printf("\n");
}
