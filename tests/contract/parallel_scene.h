/* Scenes of a thousand elements and more, steps of which are made in parts: a tube, a string in its hole, branches, one
 * with joints, and pipes on the hole's axis between others. */
#ifndef DMB_TESTS_PARALLEL_SCENE_H
#define DMB_TESTS_PARALLEL_SCENE_H

#include <stdlib.h>
#include <string.h>

#include "mechanism.h"

enum { TUBE, HOLE, BRANCHES, JOINTED, MIXED, SCENES };
#ifdef DMB_SOME_CASES
enum { STEPS = 2 };
#else
enum { STEPS = 6 };
#endif
static const char *const names[SCENES] = {"tube", "hole", "branches", "jointed", "mixed"};
static int32_t laws[2] = {DMB_NORMAL_KELVIN_VOIGT, DMB_FRICTION_BRISTLE}; /* of the hole, normal and friction */

static inline dmb_id ramp(rig *s, double to)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = 0.05;
    term.h1 = to;
    return add_time_function(s, &term, 1);
}

static inline dmb_id long_string(rig *s, uint32_t pipes, double y, int32_t free)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    string.start_free = free;
    string.position[1] = y; /* where there is no hole */
    string.offset[1] = y;
    pipe.string = add_string(s, &string);
    pipe.damping_time = 1e-5;
    (void)add_pipes(s, &pipe, pipes);
    return pipe.string;
}

static inline void describe_tube(rig *s)
{
    const dmb_id string = long_string(s, 2000, 0.0, DMB_FREE_RX);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, string, DMB_RX, ramp(s, 6.0));
}

/* Rigid masses, a bit and a head; bristles; pipes that begin on the wall. */
static inline void describe_hole(rig *s)
{
    dmb_wall_def wall = s1_hole();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_body_def head = dmb_body_def_default();
    wall.normal_law = laws[0];
    wall.friction_law = laws[1];
    (void)add_wall(s, &wall);
    const dmb_id string = long_string(s, 2000, -0.0104, DMB_FREE_X | DMB_FREE_RX);
    bit.string = string;
    must_model(s, dmb_model_add_bit(s->model, &bit, NULL));
    head.attach = DMB_ATTACH_START;
    head.string = string;
    (void)add_body(s, &head);
    (void)add_simple_drive(s, DMB_DRIVE_LOAD, string, DMB_X, ramp(s, 2e4));
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, string, DMB_RX, ramp(s, 6.0));
}

/* Strings of a thousand pipes, of so few that they are not divided, and bodies beside them, which hit the wall. */
static inline void describe_branches(rig *s)
{
    static const double survey[9] = {0.0, 0.5 * PI, 0.0, 500.0, 0.5 * PI, 0.0, 3000.0, 0.5 * PI + 0.5, 0.3};
    dmb_wall_def wall = s1_hole();
    dmb_body_def body = dmb_body_def_default();
    wall.survey = survey;
    wall.survey_count = 3;
    wall.diameter = 0.2;
    (void)add_wall(s, &wall);
    (void)long_string(s, 1000, -0.05, DMB_FREE_NONE);
    (void)long_string(s, 700, 0.02, DMB_FREE_ALL);
    (void)long_string(s, 90, 0.05, DMB_FREE_ALL);
    body.mass = 2.0;
    body.contact_diameter = 0.1;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.02 + 0.01 * i;
    body.velocity[2] = -1.0;
    for (int i = 0; i < 3; i++) {
        body.position[0] = 10.0 * i;
        (void)add_body(s, &body);
    }
}

/* A string on a body that a revolute joint holds, one beside it that turns, and a pendulum. */
static inline void describe_jointed(rig *s)
{
    dmb_body_def body = dmb_body_def_default();
    const dmb_id string = long_string(s, 1100, 0.0, DMB_FREE_ALL), other = long_string(s, 1100, 1.0, DMB_FREE_RX);
    body.mass = 5.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.1;
    const dmb_id head = add_body(s, &body);
    dmb_joint_def joint = joint_between(DMB_JOINT_REVOLUTE, dmb_station(ground_id, 0, 0.0), dmb_station(head, 0, 0.0));
    (void)add_joint(s, &joint);
    joint = joint_between(DMB_JOINT_FIXED, dmb_station(head, 0, 0.0), dmb_station(string, 0, 0.0));
    (void)add_joint(s, &joint);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, other, DMB_RX, ramp(s, 6.0));
}

/* Pipes that bend, pipes that stay on the axis of the hole, and pipes that bend again. */
static inline void describe_mixed(rig *s)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    (void)add_wall(s, &wall);
    pipe.string = long_string(s, 700, 0.0, DMB_FREE_X | DMB_FREE_RX);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    (void)add_pipes(s, &pipe, 300);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    (void)add_pipes(s, &pipe, 600);
    (void)add_simple_drive(s, DMB_DRIVE_LOAD, pipe.string, DMB_X, ramp(s, 2e4));
    (void)add_simple_drive(s, DMB_DRIVE_LOAD, pipe.string, DMB_RX, ramp(s, 2e3));
}

static inline void describe(rig *s, int kind)
{
    static void (*const how[SCENES])(rig *) = {describe_tube, describe_hole, describe_branches, describe_jointed,
                                               describe_mixed};
    rig_open(s, 0.0, 0.0, -9.81);
    how[kind](s);
    must_model(s, dmb_model_compile(s->model, NULL));
}

/* ---- Sims of them ------------------------------------------------------------------------------------------------ */

static inline dmb_sim_options in_parts(dmb_parallel_fn parallel, void *context, uint32_t parts)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.parallel = parallel;
    options.parallel_context = context;
    options.parallel_parts = parts;
    return options;
}

static inline void begin(rig *s, const dmb_sim_options *options)
{
    must_model(s, dmb_sim_create(s->model, options, &s->sim));
}

/* Steps, some of them chosen by their error, with a snapshot on the way that another sim goes on from. */
static inline uint64_t walk(rig *s, const dmb_sim_options *options, const dmb_sim_options *further)
{
    size_t size = 0;
    begin(s, options);
    take_divided_steps(s, 1e-3, STEPS);
    must(s, dmb_sim_advance(s->sim, 1e-3 * (STEPS + 1), NULL));
    must(s, dmb_sim_snapshot_size(s->sim, &size));
    void *bytes = malloc(size);
    assert_non_null(bytes);
    must(s, dmb_sim_snapshot(s->sim, bytes, size));
    dmb_sim_destroy(&s->sim);
    begin(s, further);
    must(s, dmb_sim_restore(s->sim, bytes, size));
    free(bytes);
    take_divided_steps(s, 2e-3, 2);
    const uint64_t hash = rig_hash(s);
    dmb_sim_destroy(&s->sim);
    return hash;
}

#endif
