/* Hole widened by cutters (eq:hole.cut): at the end of a step, the stations reached by a face get the diameter of its
 * cutter. Strained rock there is removed with its stored energy. */
#include <math.h>

#include "system/assemble/assemble.h"
#include "system/assemble/energy.h"
#include "system/assemble/ledger.h"

/* [m] Measured depth of a cutter's face at a bottom `bottom`, which it leads by the intrusion depth. */
static double face_at(const dmb_scene *scene, uint32_t k, double bottom)
{
    const dmb_scene_bit *bit = scene->bits + k;
    return scene->reference_depth[bit->node] + bit->arm + bit->face + bottom + bit->law.intrusion_depth;
}

/* First station beyond a depth that may be widened; 0: the depth is above all of them. */
static uint32_t station_beyond(const dmb_hole *hole, double depth)
{
    const double u = floor((depth - hole->cut_start) / hole->cut_spacing) + 1.0;
    if (!(u > 0.0)) return 0;
    return u < (double)(hole->cuts - 2) ? (uint32_t)u : hole->cuts - 2;
}

/* [m] Increase of the radius at a station by a cutter. */
static double more_at(const dmb_sim *sim, uint32_t k, uint32_t j)
{
    const dmb_hole *hole = &sim->scene->hole;
    return sim->scene->bits[k].law.radius - dmb_hole_described_radius(hole, dmb_hole_cut_depth(hole, j)) -
           sim->hole_widening[j];
}

/* Reduces the penetration of touching contact points by that much. 1: there are any. */
static int give_way(dmb_sim *sim, uint32_t j, double more)
{
    int touched = 0;
    for (uint32_t s = 0; s < sim->scene->site_count; s++) {
        const double share = dmb_hole_fraction_of_cut(&sim->scene->hole, j, sim->now.site_depth[s]);
        if (share > 0.0 && sim->now.site_penetration[s] > 0.0) touched = 1;
        sim->now.site_penetration[s] -= share * more;
    }
    return touched;
}

/* Widens the stations after `from` up to `to`. 1: contact points touch the wall there. */
static int widen(dmb_sim *sim, uint32_t k, uint32_t from, uint32_t to)
{
    int touched = 0;
    for (uint32_t j = from + 1; j <= to; j++) {
        const double more = more_at(sim, k, j);
        if (!(more > 0.0)) continue;
        sim->hole_widening[j] += more;
        touched |= give_way(sim, j, more);
    }
    return touched;
}

void dmb_hole_make_room(dmb_sim *sim, uint32_t k, double before)
{
    const dmb_scene *scene = sim->scene;
    if (scene->hole.cuts == 0 || scene->bits[k].law.kind == DMB_ROCK_NONE) return;
    const double rear = face_at(scene, k, fmin(before, sim->now.bit_advance[k] - scene->bits[k].length));
    const uint32_t beyond =
        station_beyond(&scene->hole, rear); /* also the station before it, and all up to the bottom */
    (void)widen(sim, k, beyond > 1 ? beyond - 2 : 0,
                station_beyond(&scene->hole, face_at(scene, k, sim->now.bit_bottom[k])));
}

int dmb_hole_cut(dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    int touched = 0;
    double stored = 0.0;
    for (uint32_t k = 0, any = 0; k < scene->bit_count; k++) {
        if (scene->bits[k].law.kind == DMB_ROCK_NONE) continue;
        const uint32_t from = station_beyond(&scene->hole, face_at(scene, k, sim->trial.bit_bottom[k]));
        const uint32_t to = station_beyond(&scene->hole, face_at(scene, k, sim->now.bit_bottom[k]));
        if (from >= to) continue;
        if (!any && sim->options.energy_ledger) stored = dmb_contact_energy(scene, &sim->now);
        any = 1;
        touched |= widen(sim, k, from, to);
    }
    if (touched && sim->options.energy_ledger) dmb_ledger_add_rock(sim, stored - dmb_contact_energy(scene, &sim->now));
    return touched;
}
