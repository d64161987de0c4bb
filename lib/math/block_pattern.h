/* The pattern of a block-sparse system: which blocks of unknowns are coupled, the order in which they are
 * eliminated, and the place of each block of the matrix in memory. It is computed once; afterwards it is read-only and
 * may be shared by threads.
 *
 * The caller numbers the blocks 0 .. n-1 in any order; the order of elimination is internal. A coupling of i and j
 * reserves storage for both A_ij and A_ji. Elimination couples further pairs: the fill, for which storage is reserved
 * too.
 *
 * Places depend on the capacity of each block, its largest possible size, not on its size at run time: an offset
 * remains valid. Chains, and chains with a bounded number of branches and arcs, cost time and memory linear in the
 * number of blocks. */
#ifndef DMB_MATH_BLOCK_PATTERN_H
#define DMB_MATH_BLOCK_PATTERN_H

#include <stddef.h>
#include <stdint.h>

#include "drillmbd/base.h"

#define DMB_BLOCK_CAPACITY_MAX 65536u

/* Value returned for two blocks without a place in the matrix. */
#define DMB_BLOCK_NO_OFFSET SIZE_MAX

/* Two coupled blocks. */
typedef struct dmb_block_edge {
    uint32_t a, b;
} dmb_block_edge;

/* The k-th block that is eliminated has position k. Its entries are its pairs with blocks of later positions. */
typedef struct dmb_block_pattern {
    uint32_t n;       /* number of blocks */
    uint32_t entries; /* coupled pairs, fill included */
    uint32_t fill;    /* pairs coupled by elimination only */
    size_t values;    /* doubles of storage for the matrix, fill included */
    size_t rows;      /* sum of the capacities: length of the pivots, and of a right-hand side at most */
    double flops;     /* additions and multiplications of one factorisation if every block is at its capacity */

    uint32_t *order;    /* (n) block at position k */
    uint32_t *position; /* (n) position of block i */
    uint32_t *column;   /* (n+1) first entry of position k; the last is the number of entries */
    uint32_t *later;    /* (entries) position of the other block, ascending for each k */
    size_t *pivot;      /* (n) first pivot of position k */
    size_t *diagonal;   /* (n) offset of the diagonal block of position k */
    size_t *upper;      /* (entries) offset of the block in row k, column later */
    size_t *lower;      /* (entries) offset of the block in row later, column k */

    void *block; /* the memory of the arrays above */
    size_t block_size;
} dmb_block_pattern;

/* Computes the pattern of n blocks (n may be 0) with the given capacities, 0 .. DMB_BLOCK_CAPACITY_MAX, coupled by
 * edge_count edges: in any order and direction; repetitions and edges from a block to itself are permitted; ends must
 * be below n.
 * Allocates one block of memory that is kept; all other memory is released. Errors, with *pattern unchanged:
 * DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE. */
int32_t dmb_block_pattern_make(const dmb_allocator *allocator, uint32_t n, const uint32_t *capacity,
                               uint32_t edge_count, const dmb_block_edge *edges, dmb_block_pattern *pattern);

/* Releases the memory and empties the pattern. A pattern of zero bytes may be released too. */
void dmb_block_pattern_release(dmb_block_pattern *pattern, const dmb_allocator *allocator);

/* Offset of A_ij in the values of a matrix of this pattern; i may be j. DMB_BLOCK_NO_OFFSET for a pair that is neither
 * coupled nor fill. Time: the logarithm of the number of entries of i or j. */
size_t dmb_block_pattern_offset(const dmb_block_pattern *pattern, uint32_t i, uint32_t j);

/* Entry of two positions, low < high; DMB_NONE if they are not coupled. Logarithmic time. */
uint32_t dmb_block_pattern_entry(const dmb_block_pattern *pattern, uint32_t low, uint32_t high);

#endif
