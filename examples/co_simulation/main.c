/* Two units of FMI 3.0 run together: a rig with its drill string, and a speed controller that turns it. The importer
 * below passes torque and speed between them each 2 ms. The same loop by the library's own calls gives equal numbers.
 */
#define _POSIX_C_SOURCE 200809L
#include <dlfcn.h>
#include <drillmbd/drillmbd.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../command_line.h"
#include "fmi3_declarations.h"
#include "scene_format.h"

enum { TARGET = 1, MEASURED = 2, COMMAND = 3, RIG_TORQUE = 100000, RIG_SPEED = 200000, BIT_SPEED = 200001 };
static const double length = 2e-3;

/* ---- A unit, as an importer sees it -------------------------------------------------------------------------------
 */
typedef fmi3Status (*get_fn)(fmi3Instance, const fmi3ValueReference *, size_t, double *, size_t);
typedef fmi3Status (*set_fn)(fmi3Instance, const fmi3ValueReference *, size_t, const double *, size_t);
typedef fmi3Status (*begin_fn)(fmi3Instance, bool, double, double, bool, double);
typedef fmi3Status (*step_fn)(fmi3Instance, double, double, bool, bool *, bool *, bool *, double *);
typedef fmi3Instance (*instantiate_fn)(const char *, const char *, const char *, bool, bool, bool, bool,
                                       const fmi3ValueReference *, size_t, void *, fmi3LogMessageCallback,
                                       fmi3IntermediateUpdateCallback);
typedef struct unit {
    void *library;
    fmi3Instance instance;
    get_fn get;
    set_fn set;
    step_fn step;
} unit;

static void say(void *environment, fmi3Status status, const char *category, const char *text)
{
    (void)environment, (void)status;
    (void)fprintf(stderr, "%s: %s\n", category, text);
}

/* A function of the binary into the pointer at `function`; 0 where it is there. */
static int import(void *library, const char *name, void *function)
{
    void *found = dlsym(library, name);
    memcpy(function, &found, sizeof found);
    return found == NULL;
}

static int open_unit(unit *u, const char *binary, const char *token, const char *resources)
{
    instantiate_fn instantiate;
    begin_fn begin;
    fmi3Status (*end)(fmi3Instance);
    u->library = dlopen(binary, RTLD_NOW | RTLD_LOCAL);
    if (u->library == NULL) return (void)fprintf(stderr, "%s\n", dlerror()), 1;
    if (import(u->library, "fmi3InstantiateCoSimulation", &instantiate) ||
        import(u->library, "fmi3GetFloat64", &u->get) || import(u->library, "fmi3SetFloat64", &u->set) ||
        import(u->library, "fmi3DoStep", &u->step) || import(u->library, "fmi3EnterInitializationMode", &begin) ||
        import(u->library, "fmi3ExitInitializationMode", &end))
        return (void)fprintf(stderr, "%s lacks functions of FMI 3.0\n", binary), 1;
    u->instance = instantiate(binary, token, resources, false, true, false, false, NULL, 0, NULL, say, NULL);
    if (u->instance == NULL) return 1;
    return begin(u->instance, false, 0.0, 0.0, false, 0.0) != fmi3OK || end(u->instance) != fmi3OK;
}

static void close_unit(unit *u)
{
    void (*release)(fmi3Instance);
    if (u->library == NULL) return;
    if (u->instance != NULL && !import(u->library, "fmi3FreeInstance", &release)) release(u->instance);
    (void)dlclose(u->library);
}

static int step(const unit *u, double time)
{
    bool needs_event, terminate, early;
    double last;
    return u->step(u->instance, time, length, true, &needs_event, &terminate, &early, &last) != fmi3OK;
}

/* One value from a unit, or into it. */
static double get(const unit *u, fmi3ValueReference reference)
{
    double value = (double)NAN;
    (void)u->get(u->instance, &reference, 1, &value, 1);
    return value;
}

static int set(const unit *u, fmi3ValueReference reference, double value)
{
    return u->set(u->instance, &reference, 1, &value, 1) != fmi3OK;
}

/* ---- The rig: described by the library, and written for its unit
 * ------------------------------------------------------
 */
typedef struct rig {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id torque;
    dmb_output outputs[2]; /* speed of the rig, of the bit */
} rig;

static int32_t describe(rig *r)
{
    const dmb_wall_def wall = dmb_wall_def_default();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_segment none = dmb_segment_default();
    const dmb_compile_options compile = dmb_compile_options_default();
    dmb_body_def head = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_input_def input = dmb_input_def_default();
    dmb_id string = {0, 0};
    (void)dmb_model_add_wall(r->model, &wall, NULL);
    (void)dmb_model_add_pipes(r->model, &pipe, 40, &string);
    head.attach = DMB_ATTACH_START; /* the rig's rotation unit */
    head.string = string;
    head.mass = 300.0;
    head.inertia[0] = head.inertia[1] = head.inertia[2] = 6.0;
    (void)dmb_model_add_body(r->model, &head, NULL);
    (void)dmb_model_add_time_function(r->model, &none, 1, &drive.time_function);
    drive.kind = DMB_DRIVE_LOAD;
    drive.component = DMB_RX;
    drive.part = string;
    (void)dmb_model_add_drive(r->model, &drive, &input.part);
    memcpy(input.name, "torque", sizeof "torque");
    (void)dmb_model_add_input(r->model, &input, &r->torque);
    for (int i = 0; i < 2; ++i) {
        r->outputs[i].place.part = string;
        r->outputs[i].quantity = i == 0 ? DMB_OUTPUT_ROTARY_SPEED : DMB_OUTPUT_BIT_SPEED;
    }
    return dmb_model_compile(r->model, &compile);
}

static int open_rig(rig *r)
{
    int32_t status = dmb_model_create(NULL, &r->model);
    if (status >= 0) status = describe(r);
    if (status >= 0) status = dmb_sim_create(r->model, NULL, &r->sim);
    scene_settings settings = scene_settings_default(); /* of the unit */
    settings.outputs = r->outputs;
    settings.output_count = 2;
    settings.step = 1e-3;
    if (status >= 0 && scene_write("scene.bin", "{rig-1}", r->model, &settings) != 0)
        return (void)fprintf(stderr, "scene.bin cannot be written\n"), 1;
    if (status < 0) (void)fprintf(stderr, "%s\n", dmb_model_message(r->model));
    return status < 0;
}

/* ---- The two loops --------------------------------------------------------------------------------------------------
 */
static int together(const unit *controller, const unit *rig_unit, double time, double speeds[2])
{
    const int failed = set(controller, MEASURED, get(rig_unit, RIG_SPEED)) || step(controller, time) ||
                       set(rig_unit, RIG_TORQUE, get(controller, COMMAND)) || step(rig_unit, time);
    speeds[0] = get(rig_unit, RIG_SPEED);
    speeds[1] = get(rig_unit, BIT_SPEED);
    return failed;
}

static int32_t direct(const rig *r, double target, double *integral, double speeds[2])
{
    double speed = 0.0;
    (void)dmb_query_output(r->sim, &r->outputs[0], &speed);
    const double error = target - speed, asked = 40.0 * error + *integral, torque = fmin(fmax(asked, -3000.0), 3000.0);
    if (torque == asked) *integral += 25.0 * error * length;
    int32_t status = dmb_sim_set_input(r->sim, r->torque, torque);
    for (int i = 0; i < 2 && status >= 0; ++i) status = dmb_sim_step(r->sim, 1e-3, NULL);
    for (int i = 0; i < 2 && status >= 0; ++i) status = dmb_query_output(r->sim, &r->outputs[i], &speeds[i]);
    return status;
}

static int run(const unit *controller, const unit *rig_unit, const rig *r)
{
    double integral = 0.0, difference = 0.0;
    if (set(controller, TARGET, 12.0)) return 1;
    for (int i = 0; i < 1000; ++i) {
        double speeds[2], same[2];
        if (together(controller, rig_unit, i * length, speeds) || direct(r, 12.0, &integral, same) < 0)
            return (void)fprintf(stderr, "%s\n", dmb_sim_message(r->sim)), 1;
        for (int k = 0; k < 2; ++k) difference = fmax(difference, fabs(speeds[k] - same[k]));
        if (i % 200 == 199)
            (void)printf("%.1f s: rig %7.4f rad/s, bit %7.4f rad/s, torque %8.3f N m\n", (i + 1) * length, speeds[0],
                         speeds[1], get(controller, COMMAND));
    }
    (void)printf("units against direct calls: %s\n", difference == 0.0 ? "equal numbers" : "DIFFERENT");
    return difference != 0.0;
}

int main(int count, char **words)
{
    if (count > 1)
        return command_line(count, words, "Two units of FMI 3.0 run together: a rig and a speed controller.", NULL, 0);
    rig r = {.model = NULL};
    unit controller = {.library = NULL}, rig_unit = {.library = NULL};
    const int failed = open_rig(&r) || open_unit(&controller, CONTROLLER_UNIT, "{speed-controller-1}", ".") ||
                       open_unit(&rig_unit, RIG_UNIT, "{rig-1}", ".") || run(&controller, &rig_unit, &r);
    (void)remove("scene.bin");
    close_unit(&controller);
    close_unit(&rig_unit);
    dmb_sim_destroy(&r.sim);
    dmb_model_destroy(&r.model);
    return failed;
}
