#include "force/friction_law.h"

void dmb_friction_smooth(const dmb_friction_law *law, double N, const double v[2], double F[2], double dF_dv[4],
                         double dF_dN[2])
{
    dmb_friction_smooth_at(law, N, v, F, dF_dv, dF_dN);
}

void dmb_friction_bristle(const dmb_friction_law *law, double N, const double v[2], const double z_old[2],
                          const double v_old[2], int32_t stuck, double h, double z[2], double F[2], double dF_dv[4],
                          double dF_dN[2], int32_t *sticks)
{
    *sticks = dmb_friction_bristle_at(law, N, v, z_old, v_old, stuck != 0, h, z, F, dF_dv, dF_dN);
}
