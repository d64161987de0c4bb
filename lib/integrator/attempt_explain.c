/* What a failed attempt says: which part, at what time. */
#include "integrator/attempt.h"
#include "system/cluster.h"
#include "system/constraint_rows.h"
#include "system/owner.h"

void dmb_attempt_explain(dmb_sim *sim, const dmb_attempt *attempt)
{
    dmb_owner owner;
    switch (attempt->status) {
    case DMB_ERR_ROTATION:
        owner = dmb_owner_of_element(sim->scene, attempt->evaluation.element);
        dmb_message_set(&sim->message,
                        "%s %u, pipe %u: relative rotation in one element above 2.5 rad at time %g, step %g",
                        owner.kind, owner.index, owner.pipe, attempt->evaluation.time, attempt->end.step);
        break;
    case DMB_ERR_SINGULAR:
        if (attempt->block == UINT32_MAX) {
            dmb_clusters_explain(sim, "its equations are singular");
            break;
        }
        owner = dmb_owner_of_node(sim->scene, attempt->block);
        dmb_message_set(&sim->message, "%s %u, pipe %u: iteration matrix singular at time %g, step %g", owner.kind,
                        owner.index, owner.pipe, attempt->evaluation.time, attempt->end.step);
        break;
    case DMB_ERR_GEOMETRY: /* said where it was found */ break;
    case DMB_ERR_CALLBACK:
        if (sim->linked_mode->row != UINT32_MAX) {
            dmb_message name;
            dmb_constraint_text(sim->scene, dmb_constraint_of_row(sim->scene, sim->linked_mode->row), &name);
            dmb_message_set(&sim->message, "%s: its callback failed or gave a value beyond +-1e30 at time %g",
                            name.text, attempt->evaluation.time);
            break;
        }
        dmb_message_set(&sim->message,
                        "callback of a programme or constraint: it failed or gave a value beyond +-1e30 at time %g",
                        attempt->evaluation.time);
        break;
    default:
        if (sim->linked_mode->row != UINT32_MAX) {
            dmb_clusters_explain(sim, "its equations cannot be satisfied");
            break;
        }
        dmb_message_set(&sim->message,
                        "step to time %g of length %g: %u iterations, relative residual = %g, must be <= %g",
                        attempt->evaluation.time, attempt->end.step, attempt->iterations, attempt->residual,
                        sim->options.newton_tolerance);
    }
}
