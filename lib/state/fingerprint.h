/* What a snapshot must fit: the numbers of the compiled scene and of the options, without addresses and stamps, so that
 * the same description compiled in another process has the same fingerprint. */
#ifndef DMB_STATE_FINGERPRINT_H
#define DMB_STATE_FINGERPRINT_H

#include "state.h"

/* O(number of nodes and elements). Callbacks of programmes count as equal. */
uint64_t dmb_scene_fingerprint(const dmb_scene *scene);
uint64_t dmb_options_fingerprint(const dmb_sim_options *options);

#endif
