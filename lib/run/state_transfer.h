/* Parts of dmb_sim_transfer_state. Strings are numbered from their rig ends, where pipes come and go, so pipes and
 * nodes of two scenes are matched by counting from the far end. */
#ifndef DMB_RUN_STATE_TRANSFER_H
#define DMB_RUN_STATE_TRANSFER_H

#include "sim/sim.h"

/* Pipes and nodes that a string of one scene and the same string of another have in common. */
typedef struct dmb_common_string {
    uint32_t pipes;    /* matched */
    uint32_t nodes;    /* matched */
    uint32_t to, from; /* first matched node in the scene of the sim and in that it comes from */
} dmb_common_string;

/* The scenes must have passed dmb_state_transfer_check, or at least its part on pipes. O(1). */
dmb_common_string dmb_common_string_of(const dmb_scene *scene, const dmb_scene *from, uint32_t string);

/* Is sim the same as from but for pipes at the rig ends? DMB_ERR_VALUE with a message where not.
 * run/state_transfer_check */
int32_t dmb_state_transfer_check(dmb_sim *sim, const dmb_sim *from);

/* Poses, turns and speeds of all nodes of now. DMB_ERR_VALUE with a message where axial-torsional pipes would have to
 * leave their line. run/state_transfer_nodes */
int32_t dmb_state_transfer_nodes(dmb_sim *sim, const dmb_sim *from);
enum { DMB_TRANSFER_ALL = 0, DMB_TRANSFER_BRISTLES = 1 };
/* Memory of the wall contacts; or only of the bristles, once contacts that have no past have been evaluated: where no
 * time passes, a bristle that slips at its limit cannot be told from one that holds there. run/state_transfer_nodes */
void dmb_state_transfer_sites(dmb_sim *sim, const dmb_sim *from, int32_t what);

/* [m] from the node's place in `from` to that in the scene, along body x: rigid pipes that are added or taken off move
 * the node of the body they are part of. Both nodes of string `string`, matched. */
double dmb_state_transfer_arm(const dmb_scene *scene, uint32_t node, const dmb_scene *from, uint32_t old,
                              uint32_t string);

#endif
