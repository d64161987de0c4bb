/* The part of a dynamic stiffness where joints connect chains: R^T A R in complex blocks, one of each cluster of joints
 * and one of each other node, factored in the order of the scene's pattern. Its cost grows with the number of blocks,
 * and with the cube of the coordinates of one cluster. */
#ifndef DMB_ANALYSIS_LINEAR_DYNAMIC_LINKS_H
#define DMB_ANALYSIS_LINEAR_DYNAMIC_LINKS_H

#include "analysis/linear/dynamic_stiffness.h"
#include "base/memory.h"

/* Sizes to begin with: `count`, the widest block, the most rows of constraint of a cluster. */
typedef struct dmb_links_size {
    uint32_t count, widest, rows;
} dmb_links_size;

dmb_links_size dmb_dynamic_links_size(const dmb_linear *linear);
void dmb_dynamic_links_lay_out(dmb_arena *arena, const dmb_linear *linear, dmb_links_size size, dmb_dynamic_links *out);
/* Numbers the coordinates; `size` as laid out with. */
void dmb_dynamic_links_number(const dmb_linear *linear, dmb_links_size size, dmb_dynamic_links *out);
/* From the blocks of A. A node that nothing holds, or -1. */
int64_t dmb_dynamic_links_factor(dmb_dynamic_stiffness *stiffness);
/* Rows of jointed chains of x: forces in, displacements out. */
void dmb_dynamic_links_solve(dmb_dynamic_stiffness *stiffness, dmb_complex_array x);

#endif
