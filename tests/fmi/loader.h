/* A rig as a co-simulation unit, written to a folder of its own, the same rig by the library, and the unit's functions
 * by dlopen, as an importer has them. */
#ifndef DMB_TESTS_FMI_LOADER_H
#define DMB_TESTS_FMI_LOADER_H

#include <dlfcn.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene_format.h"

#define TOKEN "{rig}"
enum { SPEED = 100000, FRICTION = 100001, TORQUE = 200000, BIT_SPEED = 200001, FAST = 300000, OUTPUTS = 2 };
static const double step_length = 1e-3;

typedef struct rig {
    char folder[64];
    dmb_model *model;
    dmb_id speed, friction;
    dmb_output outputs[OUTPUTS];
} rig;

static inline void must(int32_t status, const char *message)
{
    if (status < 0) fail_msg("%d: %s", (int)status, message);
}

#define DESCRIBE(r, name, def, id) must(dmb_model_##name((r)->model, &(def), (id)), dmb_model_message((r)->model))

static inline void describe_inputs(rig *r, dmb_id head, int has_event)
{
    dmb_input_def input = dmb_input_def_default();
    strcpy(input.name, "speed");
    input.part = head;
    input.low = 0.0;
    input.high = 30.0;
    DESCRIBE(r, add_input, input, &r->speed);
    input = dmb_input_def_default();
    strcpy(input.name, "friction");
    input.target = DMB_TARGET_FRICTION;
    DESCRIBE(r, add_input, input, &r->friction);
    if (!has_event) return;
    dmb_event_def event = dmb_event_def_default();
    dmb_id made;
    strcpy(event.name, "fast");
    event.output = r->outputs[1];
    event.level = 5.0;
    DESCRIBE(r, add_event, event, &made);
}

static inline dmb_id describe_rig(rig *r)
{
    static const double depths[] = {0.0, 1.5, 0.3, 4.0, 1.4, 0.3, 20.0, 1.3, 0.4}, times[] = {0.0, 0.02, 0.1},
                        speeds[] = {0.0, 4.0, 8.0};
    dmb_wall_def wall = dmb_wall_def_default();
    wall.survey_count = 3;
    wall.survey = depths;
    dmb_id hole, string, time_function, head;
    DESCRIBE(r, add_wall, wall, &hole);
    dmb_hole_section section = dmb_hole_section_default();
    section.depth = 3.0;
    section.mu_static = section.mu_dynamic = 0.5;
    must(dmb_model_add_hole_sections(r->model, &section, 1), dmb_model_message(r->model));
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.eccentricity = 1e-3;
    must(dmb_model_add_pipes(r->model, &pipe, 5, &string), dmb_model_message(r->model));
    dmb_segment terms[2] = {dmb_segment_default(), dmb_segment_default()};
    terms[0].h0 = 0.5;
    terms[1].kind = DMB_SEGMENT_TABLE;
    terms[1].table_count = 3;
    terms[1].table_time = times;
    terms[1].table_value = speeds;
    must(dmb_model_add_time_function(r->model, terms, 2, &time_function), dmb_model_message(r->model));
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = string;
    drive.component = DMB_RX;
    drive.kind = DMB_DRIVE_CONTROL;
    drive.gain = 300.0;
    drive.time_function = time_function;
    DESCRIBE(r, add_drive, drive, &head);
    r->outputs[0] = (dmb_output){{head, 0, 0, 0.0}, DMB_OUTPUT_DRIVE_FORCE, 0};
    r->outputs[1] = (dmb_output){{string, 0, 0, 0.0}, DMB_OUTPUT_BIT_SPEED, 0};
    return head;
}

/* A curved hole in two sections, five pipes, a speed controller that follows a table until its input is set. */
static inline void open_rig(rig *r, int has_event)
{
    memset(r, 0, sizeof *r);
    const char *temporary = getenv("TMPDIR");
    snprintf(r->folder, sizeof r->folder, "%s/drillmbd fmu XXXXXX", temporary && *temporary ? temporary : "/tmp");
    if (!mkdtemp(r->folder)) fail_msg("no folder");
    must(dmb_model_create(NULL, &r->model), "create");
    const dmb_id head = describe_rig(r);
    describe_inputs(r, head, has_event);
    const dmb_compile_options compile = dmb_compile_options_default();
    must(dmb_model_compile(r->model, &compile), dmb_model_message(r->model));
    scene_settings settings = scene_settings_default();
    settings.outputs = r->outputs;
    settings.output_count = OUTPUTS;
    settings.step = has_event ? 0.0 : step_length;
    char path[128];
    snprintf(path, sizeof path, "%s/scene.bin", r->folder);
    assert_int_equal(scene_write(path, TOKEN, r->model, &settings), 0);
}

static inline void close_rig(rig *r)
{
    char path[128];
    snprintf(path, sizeof path, "%s/scene.bin", r->folder);
    remove(path);
    rmdir(r->folder);
    dmb_model_destroy(&r->model);
}

static inline dmb_sim *sim_of(const rig *r)
{
    dmb_sim *sim = NULL;
    must(dmb_sim_create(r->model, NULL, &sim), dmb_model_message(r->model));
    return sim;
}

static inline void ask(const rig *r, const dmb_sim *sim, double outputs[OUTPUTS])
{
    for (int i = 0; i < OUTPUTS; ++i) must(dmb_query_output(sim, &r->outputs[i], &outputs[i]), "output");
}

/* The speed that a controller might ask for. */
static inline double speed_at(double time)
{
    return 10.0 + 6.0 * cos(90.0 * time);
}

static inline void *binary(void)
{
    void *library = dlopen(DRILLMBD_FMU_BINARY, RTLD_NOW | RTLD_LOCAL);
    if (!library) fail_msg("%s", dlerror());
    return library;
}

/* A function of the binary into the pointer at `function`. */
static inline void import(void *library, const char *name, void *function)
{
    void *found = dlsym(library, name);
    if (!found) fail_msg("%s is not there", name);
    memcpy(function, &found, sizeof found);
}

#endif
