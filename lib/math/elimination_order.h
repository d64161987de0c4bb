/* Fill-reducing order of elimination of a graph: minimum degree, then a postorder of the elimination tree, which places
 * chains consecutively in memory. The order determines the last digits of scenes with joints; every build uses this
 * one, so that they have the same bits. */
#ifndef DMB_MATH_ELIMINATION_ORDER_H
#define DMB_MATH_ELIMINATION_ORDER_H

#include <stdint.h>

#include "drillmbd/base.h"

/* The neighbours of node i are neighbour[start[i]] .. neighbour[start[i+1] - 1], without i itself and without
 * repetition; every edge is listed at both its ends. order (n) receives the nodes in the order of elimination; of equal
 * degrees the lower index is eliminated first. n < 2^31. Memory: some 12 integers per node, the graph and its fill, all
 * released. DMB_OK; with order undefined DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE. */
int32_t dmb_elimination_order(const dmb_allocator *allocator, uint32_t n, const int32_t *start,
                              const int32_t *neighbour, uint32_t *order);

#endif
