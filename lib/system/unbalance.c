#include "system/unbalance.h"

#include "element/lump.h"

/* ad(v)^T M v */
void dmb_unbalance_of_lump(const dmb_scene *scene, uint32_t i, double wrench[6])
{
    const double spin[6] = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0};
    double p[6];
    dmb_lump_mass_times(scene->lumps + i, spin, p);
    dmb_ad_transpose(spin, p, wrench);
}
