/* Work of a step in chunks run in parallel by the caller's threads (dmb_sim_options.parallel). The library has no
 * threads, locks or atomics of its own: every chunk writes memory that no other chunk reads or writes, and the
 * caller's function returns when all are done.
 *
 * Sums over the whole scene are computed in chunks of fixed size and added in order, so that results have the same
 * bits for any number of threads, one included. */
#ifndef DMB_SIM_CHUNKS_H
#define DMB_SIM_CHUNKS_H

#include "sim/sim.h"

/* Runs of at least DMB_CHUNKS_FROM elements, nodes or contact points are computed in 4, 8, 12, ... chunks of about
 * DMB_CHUNK_SIZE, an equal number for each of two threads. Work on nodes without sums is divided at multiples of
 * DMB_GRAIN. */
enum { DMB_CHUNK_SIZE = 128, DMB_CHUNKS_FROM = 512, DMB_GRAIN = 32 };

static inline uint32_t dmb_chunks_of(uint32_t count)
{
    return count < DMB_CHUNKS_FROM ? 1 : (count + 2 * DMB_CHUNK_SIZE) / (4 * DMB_CHUNK_SIZE) * 4;
}

/* First item of chunk `piece`, or `count` for piece = pieces; otherwise a multiple of the widest lanes. */
static inline uint32_t dmb_chunk_begin(uint32_t count, uint32_t pieces, uint32_t piece)
{
    return piece == pieces ? count : (uint32_t)((uint64_t)count * piece / pieces) & ~UINT32_C(7);
}

/* Start of a step; dmb_chunks_close: its end, with DMB_OK, or DMB_ERR_CALLBACK if the caller's function failed. Between
 * the two, dmb_chunks_run uses the caller's threads. */
void dmb_chunks_open(dmb_sim *sim);
int32_t dmb_chunks_close(dmb_sim *sim);
/* 1, with the message of the sim, if the caller's function failed in the last step. */
int32_t dmb_chunks_explain(dmb_sim *sim);
/* 1: a step is in progress with the caller's threads. */
static inline int32_t dmb_chunks_are_open(const dmb_sim *sim)
{
    return sim->chunks->open;
}
/* Computes items 0 .. count - 1 by calls of `make` for ranges that start at multiples of `grain`; in one call without
 * threads. `work` is the same for all. */
void dmb_chunks_run(const dmb_sim *sim, uint32_t count, uint32_t grain, dmb_range_fn make, void *work);

#endif
