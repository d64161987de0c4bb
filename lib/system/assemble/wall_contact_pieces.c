/* Rings that are pressed on the wall in pieces (sim/parts); no node has rings in two of them. */
#include "kernel/kernels.h"
#include "sim/parts.h"
#include "system/assemble/assemble.h"

typedef struct wall_pieces {
    const dmb_sim *sim;
    const dmb_wall_job *all;
    const dmb_kernels *kernels;
    uint32_t count, pieces;
} wall_pieces;

static uint32_t begin_of(const wall_pieces *in, uint32_t piece)
{
    const dmb_site *sites = in->all->sites;
    uint32_t begin = dmb_piece_begin(in->count, in->pieces, piece);
    while (begin > 0 && begin < in->count && sites[begin].node == sites[begin - 1].node) begin++;
    return begin;
}

/* The same for the sites from `first` to before `end`; nothing is summed yet. */
static dmb_wall_job part_of(const dmb_wall_job *all, uint32_t first, uint32_t end)
{
    dmb_wall_job job = *all;
    job.count = end - first;
    job.sites += first;
    dmb_wall_job_skip(&job, first);
    job.rounding = job.potential = job.impact = job.friction = 0.0;
    return job;
}

static void make_pieces(void *work, uint32_t first, uint32_t end)
{
    const wall_pieces *in = work;
    for (uint32_t i = first; i < end; i++) {
        dmb_wall_job job = part_of(in->all, begin_of(in, i), begin_of(in, i + 1));
        in->kernels->walls(&job);
        const dmb_piece_sums sums = {
            .rounding = job.rounding, .potential = job.potential, .impact = job.impact, .friction = job.friction};
        in->sim->piece_sums[i] = sums;
    }
}

static void add_sums(const dmb_piece_sums *sums, dmb_wall_job *job)
{
    job->rounding += sums->rounding;
    job->potential += sums->potential;
    job->impact += sums->impact;
    job->friction += sums->friction;
}

/* Sites of strings stand in the order of their nodes; those of bodies come behind them, and last. */
void dmb_press_rings(const dmb_sim *sim, dmb_wall_job *job)
{
    const dmb_kernels *kernels = sim->scene->kernels;
    const uint32_t pieces = dmb_pieces_of(sim->scene->sites_in_order);
    if (pieces == 1) {
        kernels->walls(job);
        return;
    }
    wall_pieces in = {sim, job, kernels, sim->scene->sites_in_order, pieces};
    dmb_parts_run(sim, pieces, 1, make_pieces, &in);
    for (uint32_t i = 0; i < pieces; i++) add_sums(sim->piece_sums + i, job);
    dmb_wall_job rest = part_of(job, in.count, job->count);
    kernels->walls(&rest);
    const dmb_piece_sums sums = {
        .rounding = rest.rounding, .potential = rest.potential, .impact = rest.impact, .friction = rest.friction};
    add_sums(&sums, job);
}
