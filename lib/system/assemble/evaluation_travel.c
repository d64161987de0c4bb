/* Travel of a node's component within the step. */
#include "system/assemble/evaluation.h"

#include "sim/chunks.h"
#include "sim/node.h"
#include "system/assemble/actuators.h"
#include "system/assemble/assemble.h"
#include "system/assemble/caller_force.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"
#include "system/constrain/rotor.h"

double dmb_node_travel(const dmb_evaluation *evaluation, uint32_t node, uint32_t component)
{
    const dmb_sim *sim = evaluation->sim;
    double z[6];
    dmb_vec6_copy(sim->increment + sim->scene->layout.row[node], z);
    if (evaluation->step > 0.0) dmb_rotor_add_travel(sim, node, z);
    return z[component];
}
