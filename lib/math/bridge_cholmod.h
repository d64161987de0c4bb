/* Fill-reducing order of elimination of a graph, by the symbolic analysis of CHOLMOD: approximate
 * minimum degree (AMD), then a postorder of the elimination tree, which keeps chains together in memory.
 *
 * Meant for the compile step only: CHOLMOD takes its memory from malloc, not from the caller's allocator, and gives all
 * of it back before the call returns. It is told to print nothing and to use AMD alone: its other candidate, METIS,
 * calls srand and catches signals, both of which belong to the host, and draws from rand, which another thread may be
 * using as well. */
#ifndef DMB_MATH_BRIDGE_CHOLMOD_H
#define DMB_MATH_BRIDGE_CHOLMOD_H

#include <stdint.h>

#include "drillmbd/base.h"

/* The neighbours of node i are neighbour[start[i]] .. neighbour[start[i+1] - 1], without i itself and without
 * repetition; every edge is listed at both its ends. order (n) receives the node to be eliminated first, second, and so
 * on. Same graph, same order. n < 2^31. DMB_OK, or DMB_ERR_NO_MEMORY with order undefined. */
int32_t dmb_fill_reducing_order(uint32_t n, const int32_t *start, const int32_t *neighbour, uint32_t *order);

#endif
