/* Rings that were described to meet the wall and cannot: a guide holds them sideways. */
#ifndef DMB_MODEL_HELD_RING_H
#define DMB_MODEL_HELD_RING_H

#include "base/message.h"
#include "model/scene.h"

/* Index from `from` on of a body or bit (among bodies, bits behind them) whose ring is held, and what to say of it;
 * DMB_NONE: none. */
uint32_t dmb_held_ring(const dmb_scene *scene, uint32_t from, dmb_message *text);

#endif
