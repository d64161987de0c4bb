#include "integrator/corner.h"

#include <math.h>

static double corner_of(const dmb_scene *scene, uint32_t programme, double t)
{
    return programme == UINT32_MAX ? (double)INFINITY : dmb_programme_next_corner(scene->programmes + programme, t);
}

double dmb_next_corner(const dmb_sim *sim, double t)
{
    const dmb_scene *scene = sim->scene;
    double next = (double)INFINITY;
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        if (!isnan(sim->drive_input[i])) continue;
        next = fmin(next, corner_of(scene, scene->drives[i].programme, t));
        next = fmin(next, corner_of(scene, scene->drives[i].excitation, t));
    }
    for (uint32_t i = 0; i < scene->load_count; i++) next = fmin(next, corner_of(scene, scene->loads[i].programme, t));
    for (uint32_t i = 0; i < scene->bit_count; i++) next = fmin(next, corner_of(scene, scene->bits[i].load, t));
    return next;
}
