/* Forces of single nodes: rigid masses, gravity, external damping. */
#ifndef DMB_SYSTEM_ASSEMBLE_NODES_H
#define DMB_SYSTEM_ASSEMBLE_NODES_H

#include "system/assemble/evaluation.h"

void dmb_gather_nodes(dmb_evaluation *evaluation);
void dmb_gather_loads(dmb_evaluation *evaluation);

#endif
