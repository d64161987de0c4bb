/* Contact points evaluated in chunks (sim/chunks); points of one node are in the same chunk. */
#include "kernel/kernels.h"
#include "sim/chunks.h"
#include "system/assemble/assemble.h"

typedef struct wall_chunks {
    const dmb_sim *sim;
    const dmb_wall_args *all;
    const dmb_kernels *kernels;
    uint32_t count, pieces;
} wall_chunks;

/* A boundary between chunks moves behind the points of one node: two threads would add to the same rows otherwise. */
static uint32_t begin_of(const wall_chunks *in, uint32_t piece)
{
    const dmb_site *sites = in->all->sites;
    uint32_t begin = dmb_chunk_begin(in->count, in->pieces, piece);
    while (begin > 0 && begin < in->count && sites[begin].node == sites[begin - 1].node) begin++;
    return begin;
}

/* Arguments for the contact points from `first` to before `end`, with sums at 0. */
static dmb_wall_args part_of(const dmb_wall_args *all, uint32_t first, uint32_t end)
{
    dmb_wall_args args = *all;
    args.count = end - first;
    args.sites += first;
    dmb_wall_args_skip(&args, first);
    args.rounding = args.potential = args.impact = args.friction = 0.0;
    return args;
}

static void make_pieces(void *work, uint32_t first, uint32_t end)
{
    const wall_chunks *in = work;
    for (uint32_t i = first; i < end; i++) {
        dmb_wall_args args = part_of(in->all, begin_of(in, i), begin_of(in, i + 1));
        in->kernels->walls(&args);
        const dmb_chunk_sums sums = {
            .rounding = args.rounding, .potential = args.potential, .impact = args.impact, .friction = args.friction};
        in->sim->chunk_sums[i] = sums;
    }
}

static void add_sums(const dmb_chunk_sums *sums, dmb_wall_args *args)
{
    args->rounding += sums->rounding;
    args->potential += sums->potential;
    args->impact += sums->impact;
    args->friction += sums->friction;
}

/* Contact points of strings are ordered by node; those of bodies are last. Sums of chunks are added in their order, so
 * that the result does not depend on the number of threads; the points of bodies, which come last, are computed in one
 * piece. */
void dmb_press_sites(const dmb_sim *sim, dmb_wall_args *args)
{
    const dmb_kernels *kernels = sim->scene->kernels;
    const uint32_t pieces = dmb_chunks_of(sim->scene->sites_in_order);
    if (pieces == 1 || args->called) { /* the caller's function is not called from other threads */
        kernels->walls(args);
        return;
    }
    wall_chunks in = {sim, args, kernels, sim->scene->sites_in_order, pieces};
    dmb_chunks_run(sim, pieces, 1, make_pieces, &in);
    for (uint32_t i = 0; i < pieces; i++) add_sums(sim->chunk_sums + i, args);
    dmb_wall_args rest = part_of(args, in.count, args->count);
    kernels->walls(&rest);
    const dmb_chunk_sums sums = {
        .rounding = rest.rounding, .potential = rest.potential, .impact = rest.impact, .friction = rest.friction};
    add_sums(&sums, args);
}
