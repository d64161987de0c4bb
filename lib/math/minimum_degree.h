/* Fill-reducing order of elimination by minimum degree, in C alone, for builds without CHOLMOD. */
#ifndef DMB_MATH_MINIMUM_DEGREE_H
#define DMB_MATH_MINIMUM_DEGREE_H

#include <stdint.h>

#include "drillmbd/base.h"

/* As dmb_fill_reducing_order (math/bridge.h), of the same graphs; ties go to the lower index. Memory: some 12 integers
 * a node, the graph and its fill, all given back. DMB_OK, DMB_ERR_NO_MEMORY or DMB_ERR_TOO_LARGE. */
int32_t dmb_minimum_degree(const dmb_allocator *allocator, uint32_t n, const int32_t *start, const int32_t *neighbour,
                           uint32_t *order);

#endif
