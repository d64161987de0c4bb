/* Scenes out of bytes: mostly sensible, sometimes nonsense in a field. The same bytes give the same scene. */
#ifndef DMB_TESTS_RANDOM_SCENE_H
#define DMB_TESTS_RANDOM_SCENE_H

#include <string.h>

#include "drillmbd/drillmbd.h"
#include "random_bytes.h"
#include "random_fields.h"

/* ---- The scene --------------------------------------------------------------------------------------------------- */

#if defined(DMB_FUZZER)
enum {
    DRAW_PIPES = 2,
    DRAW_ELEMENTS = 2,
    DRAW_ITERATIONS = 8,
    DRAW_CUTS = 3,
    DRAW_STEPS = 8
}; /* tiny: many are tried */
#else
enum { DRAW_PIPES = 24, DRAW_ELEMENTS = 3, DRAW_ITERATIONS = 30, DRAW_CUTS = 8, DRAW_STEPS = 1000 };
#endif
enum { DRAW_TIME_FUNCTIONS = 4, DRAW_STRINGS = 2, DRAW_BODIES = 2, DRAW_DRIVES = 4, DRAW_INPUTS = 4, DRAW_ANY = 40 };
/* Bits of `more`. */
enum { MORE_PARTS = 1, MORE_ACTIONS = 6 };

typedef struct random_scene {
    byte_source source, other; /* the other one from the end on: for further parts and calls */
    uint32_t
        more; /* last byte of the input: what there is beyond what inputs without it have, which stay what they are */
    dmb_model *model;
    dmb_id time_function[DRAW_TIME_FUNCTIONS], string[DRAW_STRINGS + 1], body[DRAW_BODIES], bit, drive[DRAW_DRIVES + 1];
    dmb_id input[DRAW_INPUTS], event, any[DRAW_ANY]; /* any: of all kinds, to ask about */
    uint32_t time_functions, strings, bodies, bits, drives, pipes, inputs, events, anys;
    uint32_t pipes_of[DRAW_STRINGS + 1];
    int32_t free_of[DRAW_STRINGS + 1]; /* bit k: component k is free at the rig end */
    int32_t has_wall;
    int32_t callback_status;
    uint32_t evaluations; /* left for the statics of this input */
    double callback_scale;
    dmb_sim_options options; /* of the sim that is run */
} random_scene;

static inline int has_more(const random_scene *scene)
{
    return (scene->more & MORE_PARTS) != 0;
}

static inline void swap_sources(random_scene *scene)
{
    const byte_source source = scene->source;
    scene->source = scene->other;
    scene->other = source;
}

/* To be asked about. Returns 1, or 0 of what was refused. */
static inline uint32_t keep_id(random_scene *scene, int32_t status, dmb_id id)
{
    if (status >= 0 && scene->anys < DRAW_ANY) scene->any[scene->anys++] = id;
    return status >= 0;
}

static inline int32_t draw_callback(void *context, double time, double out[3])
{
    const random_scene *scene = context;
    out[0] = scene->callback_scale * sin(20.0 * time);
    return scene->callback_status;
}

static inline void draw_environment(random_scene *scene)
{
    byte_source *s = &scene->source;
    dmb_environment_def def = dmb_environment_def_default();
    if (draw_chance(s, 128) && !has_more(scene)) return;
    def.gravity[draw_below(s, 3)] = draw_number(s, -20.0, 20.0);
    def.fluid_density = draw_number(s, 0.0, 2000.0);
    def.lateral_damping = draw_number(s, 0.0, 100.0);
    def.axial_damping = draw_number(s, 0.0, 100.0);
    def.torsional_damping = draw_number(s, 0.0, 1.0);
    draw_spoil(s, def.gravity, 7);
    if (has_more(scene)) draw_more_environment(s, &def);
    (void)dmb_model_set_environment(scene->model, &def);
}

static inline dmb_segment draw_segment(random_scene *scene, double scale)
{
    static const double time[3] = {0.0, 0.003, 0.02};
    static const double value[3] = {0.0, 1.0, -0.5};
    byte_source *s = &scene->source;
    dmb_segment term = dmb_segment_default();
    term.kind = (int32_t)draw_below(s, 6);
    term.x0 = draw_number(s, -0.01, 0.02);
    term.x1 = term.x0 + draw_size(s, 1e-6, 0.1);
    term.h0 = scale * draw_number(s, -0.1, 0.1);
    term.h1 = scale * draw_number(s, -1.0, 1.0);
    term.omega = draw_number(s, 0.0, 500.0);
    term.phase = draw_number(s, -4.0, 4.0);
    draw_spoil(s, &term.x0, 6);
    if (term.kind == DMB_SEGMENT_TABLE) {
        term.table_time = time;
        term.table_value = value;
        term.table_count = 1 + draw_below(s, 3);
    }
    if (term.kind == DMB_SEGMENT_CALLBACK) {
        term.callback = draw_callback;
        term.callback_context = scene;
        scene->callback_scale = scale;
    }
    return term;
}

static inline void draw_time_functions(random_scene *scene)
{
    byte_source *s = &scene->source;
    const uint32_t count = 1 + draw_below(s, DRAW_TIME_FUNCTIONS);
    for (uint32_t i = 0; i < count; i++) {
        const double scale = draw_size(s, 1e-3, 1e3);
        dmb_segment terms[3];
        const uint32_t n = 1 + draw_below(s, 3);
        for (uint32_t k = 0; k < n; k++) terms[k] = draw_segment(scene, scale);
        if (dmb_model_add_time_function(scene->model, terms, n, &scene->time_function[scene->time_functions]) >= 0)
            scene->time_functions++;
    }
}

/* One of the time functions, or none. */
static inline dmb_id draw_time_function(random_scene *scene)
{
    const uint32_t i = draw_below(&scene->source, DRAW_TIME_FUNCTIONS + 1);
    const dmb_id none = {0, 0};
    return i < scene->time_functions ? scene->time_function[i] : none;
}

static inline void draw_wall(random_scene *scene)
{
    static const double survey[4][3] = {
        {0.0, 1.5707963267948966, 0.0}, {5.0, 1.6, 0.0}, {15.0, 1.5, 0.1}, {60.0, 1.4, 0.1}};
    byte_source *s = &scene->source;
    dmb_wall_def wall = dmb_wall_def_default();
    if (draw_chance(s, 50)) return;
    if (draw_chance(s, 128)) {
        wall.survey = survey[0];
        wall.survey_count = 2 + draw_below(s, 3);
    }
    wall.diameter = draw_number(s, 0.08, 0.12);
    wall.normal_law = (int32_t)draw_below(s, 7) - 1;
    wall.friction_law = (int32_t)draw_below(s, 5) - 1;
    wall.stiffness = draw_size(s, 1e5, 1e10);
    wall.exponent = draw_chance(s, 64) ? 1.5 : 1.0;
    wall.restitution = draw_number(s, 0.01, 1.0);
    wall.damping = draw_number(s, 0.0, 1e4);
    wall.mu_static = draw_number(s, 0.3, 0.9);
    wall.stribeck_speed = draw_size(s, 1e-4, 0.1);
    wall.smoothing_speed = draw_size(s, 1e-5, 9e-3);
    draw_spoil(s, &wall.stiffness, 12);
    if (draw_chance(s, 3)) wall.diameter = draw_nonsense(s);
    if (has_more(scene)) draw_more_wall(s, &wall);
    dmb_id id = {0, 0};
    const int32_t status = dmb_model_add_wall(scene->model, &wall, &id);
    scene->has_wall = (int32_t)keep_id(scene, status, id);
}

static inline void draw_pipes(random_scene *scene, uint32_t string)
{
    byte_source *s = &scene->source;
    const uint32_t runs = 1 + draw_below(s, 3);
    for (uint32_t i = 0; i < runs; i++) {
        dmb_pipe_def pipe = dmb_pipe_def_default();
        const uint32_t drawn = 1 + draw_below(s, 4), room = DRAW_PIPES - scene->pipes_of[string];
        const uint32_t count = drawn < room ? drawn : room;
        pipe.string = scene->string[string];
        pipe.kind = draw_chance(s, 100) ? (int32_t)draw_below(s, 3) : DMB_PIPE_FLEXIBLE;
        pipe.elements = 1 + draw_below(s, DRAW_ELEMENTS);
        pipe.length = draw_size(s, 0.05, 5.0);
        pipe.inner_diameter = draw_number(s, 0.0, 0.06);
        pipe.young_modulus = draw_size(s, 1e8, 1e12);
        pipe.damping_time = draw_chance(s, 128) ? draw_size(s, 1e-7, 1e-3) : 0.0;
        if (draw_chance(s, 100)) pipe.joint_length = 0.3 * pipe.length;
        if (draw_chance(s, 100)) pipe.eccentricity = draw_number(s, 0.0, 3e-3);
        if (draw_chance(s, 40)) pipe.eccentricity_spread = pipe.angle_spread = 1e-3;
        if (draw_chance(s, 30) && pipe.kind == DMB_PIPE_FLEXIBLE)
            pipe.curvature[draw_below(s, 3)] = draw_number(s, -0.3, 0.3);
        draw_spoil(s, &pipe.length, 30);
        if (has_more(scene)) draw_more_pipe(s, &pipe);
        if (count == 0 || dmb_model_add_pipes(scene->model, &pipe, count, NULL) < 0) continue;
        scene->pipes += count;
        scene->pipes_of[string] += count;
    }
    if (!has_more(scene) || scene->pipes_of[string] > 0) return;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.string = scene->string[string];
    scene->pipes_of[string] = dmb_model_add_pipes(scene->model, &pipe, 1, NULL) >= 0;
}

/* The joint of a mud motor, or what is fixed, between a sub and the section that continues the string. */
static inline void draw_motor(random_scene *scene, dmb_id joint)
{
    byte_source *s = &scene->source;
    dmb_motor motor = dmb_motor_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment term = dmb_segment_default();
    motor.brakes = (int32_t)draw_below(s, 2);
    motor.stall_torque = draw_size(s, 1.0, 1e4);
    motor.displacement = draw_size(s, 1e-4, 1e-1);
    motor.flow = draw_size(s, 1e-4, 1e-1);
    draw_spoil(s, &motor.stall_torque, 7);
    drive.part = joint;
    if (dmb_motor_drive(&motor, &drive, &term.h0) < 0) return;
    if (dmb_model_add_time_function(scene->model, &term, 1, &drive.time_function) < 0) return;
    dmb_id *id = &scene->drive[scene->drives];
    scene->drives += keep_id(scene, dmb_model_add_drive(scene->model, &drive, id), *id);
}

static inline void draw_sub(random_scene *scene)
{
    byte_source *s = &scene->source;
    dmb_sub_def def = dmb_sub_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_sub sub = dmb_sub_default();
    body.mass = draw_size(s, 0.1, 100.0);
    joint.kind = draw_chance(s, 128) ? DMB_JOINT_REVOLUTE : (int32_t)draw_below(s, 6);
    def.string = scene->string[draw_below(s, scene->strings)];
    def.length = draw_number(s, 0.0, 1.0);
    def.body = draw_chance(s, 128) ? &body : NULL;
    def.after = draw_chance(s, 160) ? &joint : NULL;
    if (dmb_model_add_sub(scene->model, &def, &sub) < 0) return;
    (void)keep_id(scene, 0, sub.body);
    (void)keep_id(scene, 0, sub.before);
    (void)keep_id(scene, 0, sub.after);
    (void)keep_id(scene, 0, sub.section);
    scene->free_of[scene->strings] = DMB_FREE_ALL / DMB_FREE_X;
    scene->string[scene->strings] = sub.section;
    draw_pipes(scene, scene->strings++);
    if (def.after != NULL && joint.kind == DMB_JOINT_REVOLUTE) draw_motor(scene, sub.after);
}

static inline void draw_strings(random_scene *scene)
{
    static const int32_t masks[] = {DMB_FREE_CYLINDRICAL, DMB_FREE_ALL,       DMB_FREE_NONE, DMB_FREE_X,
                                    DMB_FREE_RX,          DMB_FREE_SPHERICAL, DMB_FREE_RZ,   DMB_FREE_TRANSLATIONS,
                                    DMB_FREE_PLANAR_Z,    DMB_FREE_XY};
    byte_source *s = &scene->source;
    const uint32_t count = draw_chance(s, 250) ? 1 + draw_below(s, DRAW_STRINGS) : 0;
    for (uint32_t i = 0; i < count; i++) {
        dmb_string_def def = dmb_string_def_default();
        def.follows_hole = !draw_chance(s, 30);
        def.start_depth = draw_number(s, 0.0, 10.0);
        def.start_free = masks[draw_chance(s, 128) ? draw_below(s, 2) : draw_below(s, 10)];
        if (draw_chance(s, 30)) def.end_free = masks[draw_below(s, 10)];
        if (draw_chance(s, 30)) def.offset[draw_below(s, 2)] = draw_number(s, -0.01, 0.01);
        if (draw_chance(s, 60)) def.velocity[draw_below(s, 6)] = draw_number(s, -1.0, 1.0);
        draw_spoil(s, &def.start_depth, 15);
        if (has_more(scene)) draw_name(s, def.name);
        scene->free_of[scene->strings] = (def.start_free & DMB_FREE_ALL) / DMB_FREE_X;
        if (dmb_model_add_string(scene->model, &def, &scene->string[scene->strings]) < 0) continue;
        (void)keep_id(scene, 0, scene->string[scene->strings]);
        draw_pipes(scene, scene->strings++);
    }
    if (has_more(scene) && scene->strings > 0 && draw_chance(s, 80)) draw_sub(scene);
}

static inline void draw_bodies(random_scene *scene)
{
    byte_source *s = &scene->source;
    const uint32_t count = draw_below(s, DRAW_BODIES + 1);
    for (uint32_t i = 0; i < count; i++) {
        dmb_body_def body = dmb_body_def_default();
        body.attach = (int32_t)draw_below(s, 3);
        if (scene->strings > 0) body.string = scene->string[draw_below(s, scene->strings)];
        body.mass = draw_size(s, 0.01, 100.0);
        body.position[0] = draw_number(s, 0.0, 20.0);
        body.position[2] = draw_number(s, -0.01, 0.01);
        body.velocity[draw_below(s, 6)] = draw_number(s, -2.0, 2.0);
        if (draw_chance(s, 128)) body.contact_diameter = draw_number(s, 0.01, 0.09);
        draw_spoil(s, &body.mass, 22);
        if (has_more(scene)) draw_more_body(s, &body);
        dmb_id *id = &scene->body[scene->bodies];
        scene->bodies += keep_id(scene, dmb_model_add_body(scene->model, &body, id), *id);
    }
}

static inline void draw_bit(random_scene *scene)
{
    byte_source *s = &scene->source;
    dmb_bit_def bit = dmb_bit_def_default();
    if (draw_chance(s, 100)) return;
    bit.rock_law = (int32_t)draw_below(s, 3);
    if (scene->strings > 0) bit.string = scene->string[draw_below(s, scene->strings)];
    bit.load = draw_time_function(scene);
    bit.diameter = draw_chance(s, 200) ? draw_number(s, 0.05, 0.09) : 0.0;
    bit.intrinsic_energy = draw_size(s, 1e5, 1e9);
    bit.bottom = draw_chance(s, 60) ? draw_size(s, 1e-7, 1e-2) : 0.0;
    bit.blades = 1 + draw_below(s, 8);
    bit.history = 64 + draw_below(s, 100);
    draw_spoil(s, &bit.mass, 12);
    if (has_more(scene)) draw_more_bit(s, &bit);
    const int32_t status = dmb_model_add_bit(scene->model, &bit, &scene->bit);
    scene->bits = keep_id(scene, status, scene->bit);
}

static inline dmb_id draw_part(random_scene *scene)
{
    byte_source *s = &scene->source;
    const dmb_id none = {0, 0};
    if (scene->bodies > 0 && draw_chance(s, 80)) return scene->body[draw_below(s, scene->bodies)];
    if (scene->strings > 0 && draw_chance(s, 240)) return scene->string[draw_below(s, scene->strings)];
    return scene->bits ? scene->bit : none;
}

/* The number of a pipe as drawn, nearly always one that the string has; 0 of other parts. */
static inline uint32_t fitting_pipe(random_scene *scene, dmb_id part, uint32_t drawn)
{
    if (draw_chance(&scene->source, 4)) return drawn;
    for (uint32_t i = 0; i < scene->strings; i++)
        if (scene->string[i].index == part.index && scene->pipes_of[i] > 0) return drawn % scene->pipes_of[i];
    return 0;
}

/* Nearly always one that is free. */
static inline int32_t draw_component(random_scene *scene, dmb_id part)
{
    byte_source *s = &scene->source;
    int32_t component = draw_chance(s, 200) ? (draw_chance(s, 128) ? DMB_X : DMB_RX) : (int32_t)draw_below(s, 6);
    if (draw_chance(s, 5)) return component;
    for (uint32_t i = 0; i < scene->strings; i++) {
        if (scene->string[i].index != part.index || scene->free_of[i] == 0) continue;
        while ((scene->free_of[i] >> component & 1) == 0) component = (component + 1) % 6;
    }
    return component;
}

static inline void draw_drives(random_scene *scene)
{
    byte_source *s = &scene->source;
    const uint32_t count = draw_below(s, DRAW_DRIVES + 1);
    for (uint32_t i = 0; i < count; i++) {
        dmb_drive_def drive = dmb_drive_def_default();
        drive.kind = (int32_t)draw_below(s, 3);
        drive.part = draw_part(scene);
        drive.component = draw_component(scene, drive.part);
        drive.time_function = draw_time_function(scene);
        drive.excitation = draw_time_function(scene);
        drive.gain = draw_number(s, 0.0, 1e4);
        drive.integral_gain = draw_number(s, 0.0, 1e4);
        draw_spoil(s, &drive.gain, 4);
        if (has_more(scene)) draw_more_drive(s, &drive);
        dmb_id *id = &scene->drive[scene->drives];
        scene->drives += keep_id(scene, dmb_model_add_drive(scene->model, &drive, id), *id);
    }
}

static inline void draw_loads(random_scene *scene)
{
    byte_source *s = &scene->source;
    const uint32_t count = draw_below(s, 3);
    for (uint32_t i = 0; i < count; i++) {
        dmb_load_def load = dmb_load_def_default();
        load.frame = (int32_t)draw_below(s, scene->has_wall ? 3 : 2);
        load.place = dmb_station(draw_part(scene), draw_below(s, 3), draw_below(s, 2));
        load.force[draw_below(s, 3)] = draw_number(s, -1.0, 1.0) * draw_size(s, 1.0, 1e4);
        load.moment[draw_below(s, 3)] = draw_number(s, -1.0, 1.0) * draw_size(s, 1.0, 1e3);
        load.time_function = draw_time_function(scene);
        draw_spoil(s, load.force, 6);
        if (has_more(scene)) {
            load.place.pipe = fitting_pipe(scene, load.place.part, load.place.pipe);
            draw_more_load(s, &load);
        }
        dmb_id id = {0, 0};
        const int32_t status = dmb_model_add_load(scene->model, &load, &id);
        (void)keep_id(scene, status, id);
    }
}

/* Describes; the caller compiles. Parts that are refused are left out. */
static inline void draw_scene(random_scene *scene, const uint8_t *data, size_t size)
{
    memset(scene, 0, sizeof *scene);
    scene->source.data = data;
    scene->source.size = size > 0 ? size - 1 : 0;
    scene->more = size > 0 ? data[size - 1] : 0;
    scene->other = scene->source;
    scene->other.backward = 1;
    if (dmb_model_create(NULL, &scene->model) < 0) return;
    draw_environment(scene);
    draw_time_functions(scene);
    draw_wall(scene);
    draw_strings(scene);
    draw_bodies(scene);
    draw_bit(scene);
    draw_drives(scene);
    draw_loads(scene);
}

/* Error control with a floor and a bound on steps, so that no run takes for ever. */
static inline dmb_sim_options draw_options(random_scene *scene)
{
    byte_source *s = &scene->source;
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = draw_number(s, 0.0, 1.0);
    options.max_iterations = 1 + draw_below(s, DRAW_ITERATIONS);
    options.max_cuts = draw_below(s, DRAW_CUTS);
    options.step_min = 1e-6;
    options.max_steps = DRAW_STEPS;
    options.newton_tolerance = draw_size(s, 1e-11, 1e-3);
    options.bounded_work = draw_chance(s, 60);
    options.energy_ledger = !draw_chance(s, 40);
    return options;
}

#endif
