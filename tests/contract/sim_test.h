/* A small rig for the tests of sims: head, three pipes of each kind asked for, bit, wall, feed and torque. */
#ifndef DMB_TESTS_SIM_TEST_H
#define DMB_TESTS_SIM_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drillmbd/drillmbd.h"
#include "hash.h"

typedef struct rig {
    dmb_model *model;
    dmb_id wall, string, head, bit, load_time_function, feed, torque, time_function;
} rig;

typedef struct rig_options {
    int32_t pipe_kind;
    int32_t friction_law;
    double mu_dynamic;
    uint32_t elements;
    double joint_length;
    const dmb_allocator *allocator;
} rig_options;

static const rig_options plain_rig = {DMB_PIPE_FLEXIBLE, DMB_FRICTION_STRIBECK, 0.30, 1, 0.0, NULL};

#define must(call) assert_int_equal((call), DMB_OK)

static inline dmb_id rig_step(dmb_model *model, double height)
{
    dmb_segment term = dmb_segment_default();
    dmb_id time_function;
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = 0.05;
    term.h1 = height;
    must(dmb_model_add_time_function(model, &term, 1, &time_function));
    return time_function;
}

static inline void rig_describe(rig *r, const rig_options *options)
{
    dmb_model_options model_options = dmb_model_options_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_body_def head = dmb_body_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    memset(r, 0, sizeof *r);
    model_options.allocator = options->allocator;
    must(dmb_model_create(&model_options, &r->model));
    wall.friction_law = options->friction_law;
    wall.mu_dynamic = options->mu_dynamic;
    must(dmb_model_add_wall(r->model, &wall, &r->wall));
    pipe.kind = options->pipe_kind;
    pipe.elements = options->elements;
    pipe.joint_length = options->joint_length;
    must(dmb_model_add_pipes(r->model, &pipe, 3, &r->string));
    head.attach = DMB_ATTACH_START;
    head.mass = 12.0;
    must(dmb_model_add_body(r->model, &head, &r->head));
    r->load_time_function = rig_step(r->model, 100.0);
    bit.load = r->load_time_function;
    bit.rock_law = DMB_ROCK_REGENERATIVE;
    bit.bottom = 1e-3;
    must(dmb_model_add_bit(r->model, &bit, &r->bit));
    drive.time_function = r->time_function = rig_step(r->model, 0.1);
    must(dmb_model_add_drive(r->model, &drive, &r->feed));
    drive.kind = DMB_DRIVE_LOAD;
    drive.component = DMB_RX;
    drive.time_function = rig_step(r->model, 50.0);
    must(dmb_model_add_drive(r->model, &drive, &r->torque));
}

static inline rig rig_of(const rig_options *options)
{
    rig r;
    rig_describe(&r, options);
    must(dmb_model_compile(r.model, NULL));
    return r;
}

static inline dmb_sim *rig_sim(const rig *r)
{
    dmb_sim *sim = NULL;
    assert_true(dmb_sim_create(r->model, NULL, &sim) >= 0);
    assert_non_null(sim);
    return sim;
}

static inline void rig_run(dmb_sim *sim, int steps)
{
    for (int i = 0; i < steps; i++) {
        const int32_t status = dmb_sim_step(sim, 1e-3, NULL);
        if (status < 0) fail_msg("step %d: %d %s", i, (int)status, dmb_sim_message(sim));
    }
}

/* Collects what a log is told. */
typedef struct log_text {
    char text[4096];
    int lines;
} log_text;

static inline void log_line(void *context, int32_t level, const char *text)
{
    log_text *log = context;
    (void)level;
    snprintf(log->text, sizeof log->text, "%s", text);
    log->lines++;
}

#endif
