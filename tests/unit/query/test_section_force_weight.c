/* Section loads of a cantilever under its own weight, one element a pipe: shear w (L - x) and moment w (L - x)^2/2 at
 * any place, not only the mean of each element. */

#include "rig.h"

static void loads_under_own_weight(void **state)
{
    (void)state;
    rig s;
    dmb_string_def held = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    rig_open(&s, 0.0, 0.0, -9.81e-3); /* so small that the deflection does not matter */
    held.start_free = DMB_FREE_NONE;
    const dmb_id string = add_string(&s, &held);
    add_pipes(&s, &pipe, 3);
    rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    const double w = s1_values().weight * 1e-3, L = 4.5;
    for (uint32_t i = 0; i < 3; i++)
        for (double f = 0.0; f <= 1.0; f += 0.25) {
            dmb_section section = dmb_section_default();
            const double left = L - 1.5 * (i + f);
            must(&s, dmb_query_section(s.sim, dmb_station(string, i, f), &section));
            check_close("shear", section.force[2], -w * left, 1e-6 * w * L);
            check_close("moment", section.force[4], 0.5 * w * left * left, 1e-6 * w * L * L);
        }
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(loads_under_own_weight)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
