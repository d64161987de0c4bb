/* The ledger of a run from rest balances within a hundredth of the energy that is supplied, spent or present. Steps too
 * long for the contacts of the scene, which the run counts, are left out. */
#include "relations.h"

static void check_balance(trial *t)
{
    built b;
    dmb_energy energy = dmb_energy_default();
    dmb_statistics counts = dmb_statistics_default();
    int32_t status = scene_open(&t->s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, NULL, NULL);
    if (status < 0) {
        refused(t, status, b.sim ? dmb_sim_message(b.sim) : b.message);
        scene_close(&b);
        return;
    }
    status = run_steps(&b, t->s.step, 300, NULL);
    if (status >= 0) status = dmb_query_energy(b.sim, &energy);
    if (status >= 0) status = dmb_query_statistics(b.sim, &counts);
    if (status < 0)
        refused(t, status, b.message);
    else if (counts.bounces > 0)
        left_out(t, "bounces that the steps do not resolve");
    else
        hold(t, "error of the balance", energy.error, 1e-2);
    scene_close(&b);
}

const relation relation_balance = {"balance",
                                   "the energy ledger of a run from rest against zero",
                                   {FAMILY_LINE | FAMILY_HOLE | FAMILY_BENT, WISH_NO_CONTROL, 4},
                                   40,
                                   0.3,
                                   check_balance,
                                   0.0};
