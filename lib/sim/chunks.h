/* Work of a step in parts that threads of the caller's run at once (dmb_sim_options.parallel). The library has no
 * threads, locks or atomics of its own: every part writes places that no other part reads or writes, and the caller's
 * function returns when all are done.
 *
 * Sums over the whole scene are made in pieces of the same size whoever makes them, and these in their order,
 * so that results have the same bits in any number of parts, one included. */
#ifndef DMB_SIM_CHUNKS_H
#define DMB_SIM_CHUNKS_H

#include "sim/sim.h"

/* Runs of elements, nodes or sites from DMB_CHUNKS_FROM on are made in 4, 8, 12, ... pieces of about DMB_CHUNK_SIZE: as
 * many for each of two threads. Nodes whose order is no matter are made in multiples of DMB_GRAIN. */
enum { DMB_CHUNK_SIZE = 128, DMB_CHUNKS_FROM = 512, DMB_GRAIN = 32 };

static inline uint32_t dmb_chunks_of(uint32_t count)
{
    return count < DMB_CHUNKS_FROM ? 1 : (count + 2 * DMB_CHUNK_SIZE) / (4 * DMB_CHUNK_SIZE) * 4;
}

/* The first of piece number `piece`, of `count` for piece = pieces; multiples of the widest lanes but for that. */
static inline uint32_t dmb_chunk_begin(uint32_t count, uint32_t pieces, uint32_t piece)
{
    return piece == pieces ? count : (uint32_t)((uint64_t)count * piece / pieces) & ~UINT32_C(7);
}

/* A step begins; dmb_chunks_close: it ends, with DMB_OK, or DMB_ERR_CALLBACK where the caller's function did not do its
 * work meanwhile. Between the two dmb_chunks_run goes to the caller's threads. */
void dmb_chunks_open(dmb_sim *sim);
int32_t dmb_chunks_close(dmb_sim *sim);
/* 1, with the message of the sim: it did not in the last step. */
int32_t dmb_chunks_explain(dmb_sim *sim);
/* 1: between these two, with threads of the caller's. */
static inline int32_t dmb_chunks_are_open(const dmb_sim *sim)
{
    return sim->chunks->open;
}
/* Makes 0 .. count - 1 by calls of `make` for ranges that begin at multiples of `grain`; in one call where there are no
 * threads. `work` is the same for all. */
void dmb_chunks_run(const dmb_sim *sim, uint32_t count, uint32_t grain, dmb_range_fn make, void *work);

#endif
