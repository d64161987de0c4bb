/* The program that tests/abi/targets runs on each target: scenes of every kind of pipe, with joints, in steps, by error
 * control, in statics and from a snapshot; prints their hashes. The library in C alone: without LAPACK. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drillmbd/drillmbd.h"

#include "../firmware/jointed.h"

static void must(const char *what, int32_t status, const char *message)
{
    if (status >= 0) return;
    printf("%s: %s: %s\n", what, dmb_status_name(status), message);
    exit(1);
}

static dmb_id step_time_function(dmb_model *model, double height)
{
    dmb_segment term = dmb_segment_default();
    dmb_id id = {0, 0};
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = 0.05;
    term.h1 = height;
    must("time_function", dmb_model_add_time_function(model, &term, 1, &id), dmb_model_message(model));
    return id;
}

static void add_arm(dmb_model *model)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def hinge = dmb_joint_def_default();
    body.position[0] = 2.0;
    body.position[1] = 3.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.2;
    hinge.kind = DMB_JOINT_REVOLUTE;
    hinge.origin_a[0] = 1.5;
    hinge.origin_a[1] = 3.0;
    hinge.origin_b[0] = -0.5;
    hinge.axis_a[0] = hinge.axis_b[0] = 0.0;
    hinge.axis_a[1] = hinge.axis_b[1] = 1.0;
    must("body", dmb_model_add_body(model, &body, &hinge.place_b.part), dmb_model_message(model));
    must("joint", dmb_model_add_joint(model, &hinge, NULL), dmb_model_message(model));
}

static dmb_model *describe(int32_t kind, int joints)
{
    dmb_model *model = NULL;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    must("model", dmb_model_create(NULL, &model), "");
    wall.friction_law = DMB_FRICTION_STRIBECK;
    must("wall", dmb_model_add_wall(model, &wall, NULL), dmb_model_message(model));
    pipe.kind = kind;
    if (kind != DMB_PIPE_AXIAL_TORSIONAL) pipe.eccentricity = 1e-3;
    must("pipes", dmb_model_add_pipes(model, &pipe, 5, NULL), dmb_model_message(model));
    bit.rock_law = DMB_ROCK_REGENERATIVE;
    bit.bottom = 1e-4;
    must("bit", dmb_model_add_bit(model, &bit, NULL), dmb_model_message(model));
    drive.time_function = step_time_function(model, 0.02);
    must("drive", dmb_model_add_drive(model, &drive, NULL), dmb_model_message(model));
    drive.component = DMB_RX;
    drive.time_function = step_time_function(model, 10.0);
    must("drive", dmb_model_add_drive(model, &drive, NULL), dmb_model_message(model));
    if (joints) add_arm(model);
    must("compile", dmb_model_compile(model, NULL), dmb_model_message(model));
    return model;
}

static unsigned long long hash_of(const dmb_sim *sim)
{
    uint64_t hash = 0;
    (void)dmb_sim_hash(sim, &hash);
    return hash;
}

static void run(int32_t kind, int joints)
{
    dmb_model *model = describe(kind, joints);
    dmb_sim *sim = NULL;
    size_t size = 0;
    must("create", dmb_sim_create(model, NULL, &sim), "");
    if (!joints) must("static", dmb_analysis_static(sim, NULL, NULL), dmb_sim_message(sim));
    printf("pipes %d, joints %d: static %016llx", (int)kind, joints, hash_of(sim));
    for (int i = 0; i < 60; i++) must("step", dmb_sim_step(sim, 1e-3, NULL), dmb_sim_message(sim));
    printf(" steps %016llx", hash_of(sim));
    must("size", dmb_sim_snapshot_size(sim, &size), "");
    void *snapshot = malloc(size);
    must("snapshot", dmb_sim_snapshot(sim, snapshot, size), "");
    must("advance", dmb_sim_advance(sim, 0.07, NULL), dmb_sim_message(sim));
    printf(" control %016llx", hash_of(sim));
    must("restore", dmb_sim_restore(sim, snapshot, size), dmb_sim_message(sim));
    printf(" back %016llx\n", hash_of(sim));
    free(snapshot);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

int main(void)
{
    for (int32_t kind = DMB_PIPE_FLEXIBLE; kind <= DMB_PIPE_RIGID; kind++) run(kind, 0);
    run(DMB_PIPE_FLEXIBLE, 1);
    uint64_t hash = 0;
    must("scene with joints", jointed_run(NULL, &hash), "");
    printf("strings and four-bars, joined: steps %016llx\n", (unsigned long long)hash);
    return 0;
}
