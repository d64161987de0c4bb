#include "sim/chunks.h"

#include <string.h>

/* First item of chunk `part` of a run. The run has `units` of `grain` items; chunk `part` gets units part / parts ..
 * (part + 1) / parts of them, so chunks start at multiples of the grain and differ by one unit at most. */
static uint32_t begin_of(const dmb_chunks *parts, uint32_t part)
{
    const uint32_t units = (parts->count - 1) / parts->grain + 1;
    const uint64_t begin = (uint64_t)units * part / parts->parts * parts->grain;
    return begin < parts->count ? (uint32_t)begin : parts->count;
}

/* Entry point of the caller's threads, for chunk `part`:
 *
 *     DUE -> BEGUN -> DONE
 *
 * By the marks no chunk is computed twice (the second call returns at once), and one that was left out is found (fewer
 * DONE than chunks, dmb_chunks_run). Each is written by the thread of its chunk alone. Between runs `parts` is 0: a
 * thread that calls late finds no chunk. */
static void run_part(void *work, uint32_t part)
{
    dmb_chunks *parts = work;
    if (part >= parts->parts || parts->mark[part] != DMB_CHUNK_DUE) return;
    parts->mark[part] = DMB_CHUNK_BEGUN;
    const uint32_t first = begin_of(parts, part), end = begin_of(parts, part + 1);
    if (first < end) parts->make(parts->work, first, end);
    parts->mark[part] = DMB_CHUNK_DONE;
}

void dmb_chunks_open(dmb_sim *sim)
{
    const dmb_sim_options *o = &sim->options;
    sim->chunks->failed = 0;
    sim->chunks->parts = 0;
    sim->chunks->open = o->parallel != NULL && o->parallel_parts > 1 && sim->scene->element_count >= o->parallel_least;
}

int32_t dmb_chunks_close(dmb_sim *sim)
{
    sim->chunks->open = 0;
    return sim->chunks->failed ? DMB_ERR_CALLBACK : DMB_OK;
}

/* After a failure all chunks of later runs are computed here, in one piece. The step that is under way is rejected at
 * its end (dmb_chunks_close), so the chunks that are missing do no harm; until then, its loops must still return. */
static void fail(dmb_chunks *parts, int32_t status, uint32_t done)
{
    parts->failed = 1;
    parts->open = 0;
    parts->status = status;
    parts->done = done;
    parts->asked = parts->parts;
}

void dmb_chunks_run(const dmb_sim *sim, uint32_t count, uint32_t grain, dmb_range_fn make, void *work)
{
    dmb_chunks *parts = sim->chunks;
    if (count == 0) return;
    if (!parts->open || count <= grain) {
        make(work, 0, count);
        return;
    }
    const uint32_t units = (count - 1) / grain + 1, most = sim->options.parallel_parts;
    parts->make = make;
    parts->work = work;
    parts->count = count;
    parts->grain = grain;
    memset(parts->mark, DMB_CHUNK_DUE, sizeof parts->mark);
    parts->parts = units < most ? units : most;
    const int32_t status = sim->options.parallel(sim->options.parallel_context, parts->parts, run_part, parts);
    uint32_t done = 0;
    for (uint32_t i = 0; i < parts->parts; i++) done += parts->mark[i] == DMB_CHUNK_DONE;
    if (status != 0 || done < parts->parts) fail(parts, status, done);
    parts->parts = 0;
}

int32_t dmb_chunks_explain(dmb_sim *sim)
{
    const dmb_chunks *parts = sim->chunks;
    if (!parts->failed) return 0;
    if (parts->status != 0)
        dmb_message_set(
            &sim->message,
            "sim options: parallel returned %d in the step after time %g, must return 0 when all parts have "
            "run",
            parts->status, sim->clock->time);
    else
        dmb_message_set(&sim->message,
                        "sim options: parallel ran %u of %u parts in the step after time %g, must run each once and "
                        "return when all have returned",
                        parts->done, parts->asked, sim->clock->time);
    return 1;
}
