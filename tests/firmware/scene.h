/* A drill string of flexible pipes on the wall of its hole, turned by a drive, in a static pool: what firmware would
 * simulate. No heap, no files, bounded work. */
#ifndef SCENE_H
#define SCENE_H

#include "drillmbd.h"

#ifndef PIPES
#define PIPES 20
#endif
#ifndef POOL
#define POOL (640 * 1024)
#endif

static _Alignas(64) unsigned char pool[POOL];
static dmb_allocator allocator;
static dmb_model *model;
static dmb_sim *sim;

static int32_t describe(void)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment term = dmb_segment_default();
    wall.friction_law = DMB_FRICTION_STRIBECK;
    int32_t status = dmb_model_add_wall(model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(model, &pipe, PIPES, NULL);
    if (status >= 0) status = dmb_model_add_bit(model, &bit, NULL);
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = 0.05;
    term.h1 = 10.0;
    if (status >= 0) status = dmb_model_add_time_function(model, &term, 1, &drive.time_function);
    drive.component = DMB_RX;
    if (status >= 0) status = dmb_model_add_drive(model, &drive, NULL);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

/* DMB_OK, with the hash of the state after so many steps of 1 ms. */
static int32_t run(uint32_t steps, uint64_t *hash)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_model_options memory = dmb_model_options_default();
    memory.allocator = &allocator;
    int32_t status = dmb_pool_allocator(pool, sizeof pool, &allocator);
    if (status >= 0) status = dmb_model_create(&memory, &model);
    if (status >= 0) status = describe();
    options.bounded_work = 1;
    options.max_iterations = 4;
    if (status >= 0) status = dmb_sim_create(model, &options, &sim);
    for (uint32_t i = 0; i < steps && status >= 0; i++) status = dmb_sim_step(sim, 1e-3, NULL);
    return status < 0 ? status : dmb_sim_hash(sim, hash);
}

#endif
