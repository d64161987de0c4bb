/* Structs that are none: every function that takes one refuses a struct_size that no header ever had, before it reads
 * or writes anything else, and takes those of newer headers where nothing is asked that it does not know. */
#include <stdlib.h>

#include "whole_scene.h"

enum { EXTRA = 64 }; /* [byte] that a newer header may have at the end of a struct */

static struct {
    whole_parts parts;
    dmb_model *model;
    dmb_sim *sim;
    dmb_model *plain_model; /* one pipe in a hole, whose statics are found at once */
    dmb_sim *plain;
    dmb_model *mud_model; /* the same with mud that flows */
    dmb_sim *mud;
    dmb_output output;
    double table[8];
} scene;

/* ---- One entry for each function and struct ---------------------------------------------------------------------- */

typedef union any_struct {
    uint32_t struct_size;
    uint64_t bytes[128];
} any_struct;

typedef struct entry {
    const char *name;
    size_t size;   /* [byte] in this header */
    size_t oldest; /* [byte] in the first header that had it */
    int32_t (*init)(any_struct *out, uint32_t size);
    int32_t (*call)(void *given); /* all else in order */
    int output;                   /* the struct is an answer and nothing else */
} entry;

#define INIT(T)                                              \
    static int32_t init_##T(any_struct *out, uint32_t size)  \
    {                                                        \
        return dmb_##T##_init((dmb_##T *)(void *)out, size); \
    }
#define CALL(name, expression)          \
    static int32_t call_##name(void *p) \
    {                                   \
        return expression;              \
    }

/* clang-format off */
INIT(model_options) INIT(environment_def) INIT(segment) INIT(wall_def) INIT(string_def) INIT(pipe_def) INIT(body_def)
INIT(bit_def) INIT(drive_def) INIT(load_def) INIT(compile_options) INIT(model_info) INIT(sim_options)
INIT(event_def) INIT(event_report)
INIT(step_report) INIT(static_options) INIT(static_report) INIT(buckling_options) INIT(path_options) INIT(path_report)
INIT(pose) INIT(motion) INIT(section) INIT(contact)
INIT(contact_total) INIT(energy) INIT(momentum) INIT(drive_state) INIT(bit_state) INIT(statistics) INIT(recorder)
INIT(allocator) INIT(joint_state) INIT(joint_def) INIT(coupling_def) INIT(constraint_def)
INIT(hole_section)
INIT(hole_point) INIT(profile) INIT(operation) INIT(torque_drag_options) INIT(torque_drag_row) INIT(hydraulics)
INIT(fatigue_options) INIT(fatigue_result) INIT(window_options) INIT(window_result) INIT(profile_recorder)
INIT(parameter) INIT(input_def) INIT(input_info) INIT(input_state) INIT(spring_def) INIT(force_def) INIT(spring_state)
INIT(stuck_def) INIT(stuck_state) INIT(flow_state) INIT(motor) INIT(stabiliser_def) INIT(sub_def) INIT(sub)
INIT(state_space_options) INIT(state_space_info) INIT(row)
    /* clang-format on */

    static int32_t call_model_options(void *p)
{
    dmb_model *model = scene.model;
    const int32_t status = dmb_model_create(p, &model);
    if (status < 0) assert_null(model);
    dmb_model_destroy(&model);
    return status;
}

static int32_t call_allocator(void *p)
{
    dmb_model_options options = dmb_model_options_default();
    options.allocator = p;
    return call_model_options(&options);
}

static int32_t call_sim_options(void *p)
{
    dmb_sim *sim = scene.sim;
    const int32_t status = dmb_sim_create(scene.model, p, &sim);
    size_t size;
    if (status < 0) assert_null(sim);
    if (status < 0) assert_int_equal(dmb_sim_memory_size(scene.model, p, &size), status);
    dmb_sim_destroy(&sim);
    return status;
}

/* Each in a model of its own, which may be described; what the definition lacks otherwise is added first. */
static int32_t with_model(int32_t (*add)(dmb_model *model, void *p), void *p)
{
    dmb_model *model = NULL;
    int32_t status;
    assert_int_equal(dmb_model_create(NULL, &model), DMB_OK);
    status = add(model, p);
    if (status < 0) assert_true(dmb_model_message(model)[0] != '\0');
    dmb_model_destroy(&model);
    return status;
}

static int32_t add_drive(dmb_model *model, void *p)
{
    dmb_drive_def *drive = p;
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const dmb_segment segment = dmb_segment_default();
    dmb_id time_function;
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_OK);
    assert_int_equal(dmb_model_add_time_function(model, &segment, 1, &time_function), DMB_OK);
    if (drive->struct_size >= 72) /* has it */
        drive->time_function = time_function;
    return dmb_model_add_drive(model, drive, NULL);
}

static int32_t add_load(dmb_model *model, void *p)
{
    dmb_load_def *load = p;
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_id string;
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, &string), DMB_OK);
    if (load->struct_size >= 88) /* has it */
        load->place = dmb_station(string, 0, 1.0);
    return dmb_model_add_load(model, load, NULL);
}

static int32_t no_force(void *context, double time, uint32_t count, const double (*poses)[12],
                        const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                        const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)poses, (void)velocities, (void)forces, (void)tangent, (void)potential;
    return 0;
}

static int32_t add_force(dmb_model *model, void *p)
{
    dmb_force_def *force = p;
    const dmb_body_def body = dmb_body_def_default();
    dmb_id id;
    assert_int_equal(dmb_model_add_body(model, &body, &id), DMB_OK);
    if (force->struct_size >= sizeof *force) {
        force->place[0] = dmb_station(id, 0, 0.0);
        force->callback = no_force;
    }
    return dmb_model_add_force(model, force, NULL);
}

static void add_section(dmb_model *model)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_OK);
}

static int32_t add_sub(dmb_model *model, void *p)
{
    dmb_sub made = dmb_sub_default();
    add_section(model);
    return dmb_model_add_sub(model, p, &made);
}

static int32_t get_sub(dmb_model *model, void *p)
{
    const dmb_sub_def def = dmb_sub_def_default();
    add_section(model);
    return dmb_model_add_sub(model, &def, p);
}

static int32_t add_stuck(dmb_model *model, void *p)
{
    dmb_stuck_def *stuck = p;
    const dmb_body_def body = dmb_body_def_default();
    dmb_id id;
    assert_int_equal(dmb_model_add_body(model, &body, &id), DMB_OK);
    if (stuck->struct_size >= sizeof *stuck) stuck->place = dmb_station(id, 0, 0.0);
    return dmb_model_add_stuck(model, stuck, NULL);
}

static int32_t add_stabiliser(dmb_model *model, void *p)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_OK);
    return dmb_model_add_stabiliser(model, p, NULL);
}

static int32_t add_spring(dmb_model *model, void *p)
{
    dmb_spring_def *spring = p;
    const dmb_body_def body = dmb_body_def_default();
    dmb_id id;
    assert_int_equal(dmb_model_add_body(model, &body, &id), DMB_OK);
    if (spring->struct_size >= sizeof *spring) {
        spring->place_b = dmb_station(id, 0, 0.0);
        spring->offset_b[0] = spring->stiffness = 1.0;
    }
    return dmb_model_add_spring(model, spring, NULL);
}

static int32_t add_joint(dmb_model *model, void *p)
{
    dmb_joint_def *joint = p;
    const dmb_body_def body = dmb_body_def_default();
    dmb_id id;
    assert_int_equal(dmb_model_add_body(model, &body, &id), DMB_OK);
    if (joint->struct_size >= sizeof *joint) joint->place_b = dmb_station(id, 0, 0.0);
    return dmb_model_add_joint(model, joint, NULL);
}

static int32_t add_coupling(dmb_model *model, void *p)
{
    dmb_coupling_def *coupling = p;
    const dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_id id;
    assert_int_equal(dmb_model_add_body(model, &body, &joint.place_b.part), DMB_OK);
    joint.kind = DMB_JOINT_CYLINDRICAL;
    assert_int_equal(dmb_model_add_joint(model, &joint, &id), DMB_OK);
    if (coupling->struct_size >= 64) { /* has them */
        coupling->joint[0] = coupling->joint[1] = id;
        coupling->component[0] = DMB_X;
    }
    return dmb_model_add_coupling(model, coupling, NULL);
}

static int32_t no_constraint(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                             double *jacobian)
{
    (void)context, (void)time, (void)count, (void)poses, (void)value, (void)jacobian;
    return 0;
}

static int32_t add_constraint(dmb_model *model, void *p)
{
    dmb_constraint_def *constraint = p;
    const dmb_body_def body = dmb_body_def_default();
    dmb_id id;
    assert_int_equal(dmb_model_add_body(model, &body, &id), DMB_OK);
    if (constraint->struct_size >= sizeof *constraint) {
        constraint->place[0] = dmb_station(id, 0, 0.0);
        constraint->callback = no_constraint;
    }
    return dmb_model_add_constraint(model, constraint, NULL);
}

static dmb_input_def an_input(void)
{
    dmb_input_def input = dmb_input_def_default();
    input.target = DMB_TARGET_FLUID_DENSITY;
    input.name[0] = 'm';
    return input;
}

static int32_t add_input(dmb_model *model, void *p)
{
    dmb_input_def *input = p;
    const dmb_input_def good = an_input();
    if (input->struct_size >= sizeof *input) {
        input->target = good.target;
        input->name[0] = 'm';
    }
    return dmb_model_add_input(model, input, NULL);
}

static dmb_event_def an_event(void)
{
    dmb_event_def event = dmb_event_def_default();
    event.output.quantity = DMB_OUTPUT_ENERGY_ERROR;
    event.name[0] = 'e';
    event.level = 1e20;
    return event;
}

static int32_t add_event(dmb_model *model, void *p)
{
    dmb_event_def *event = p;
    if (event->struct_size >= sizeof *event) event->name[0] = 'e';
    return dmb_model_add_event(model, event, NULL);
}

static int32_t get_event(dmb_model *model, void *p)
{
    const dmb_event_def event = an_event();
    assert_int_equal(dmb_model_add_event(model, &event, NULL), DMB_OK);
    const int32_t status = dmb_model_get_event(model, 0, p);
    if (status < 0) assert_int_equal(dmb_model_add_pipes(model, NULL, 1, NULL), DMB_ERR_NULL); /* leaves a message */
    return status;
}

static int32_t report_event(dmb_model *model, void *p)
{
    const dmb_event_def event = an_event();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_sim *sim = NULL;
    assert_int_equal(dmb_model_add_event(model, &event, NULL), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_OK);
    assert_int_equal(dmb_model_compile(model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(model, NULL, &sim), DMB_OK);
    const int32_t status = dmb_sim_advance_to_event(sim, 1e-6, p, NULL);
    dmb_sim_destroy(&sim);
    return status;
}

static int32_t get_info(dmb_model *model, void *p)
{
    const dmb_input_def input = an_input();
    assert_int_equal(dmb_model_add_input(model, &input, NULL), DMB_OK);
    const int32_t status = dmb_model_get_input(model, 0, p);
    if (status < 0) assert_int_equal(dmb_model_add_pipes(model, NULL, 1, NULL), DMB_ERR_NULL); /* leaves a message */
    return status;
}

static int32_t get_state(dmb_model *model, void *p)
{
    const dmb_input_def input = an_input();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_sim *sim = NULL;
    dmb_id id;
    assert_int_equal(dmb_model_add_input(model, &input, &id), DMB_OK);
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_OK);
    assert_int_equal(dmb_model_compile(model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(model, NULL, &sim), DMB_OK);
    const int32_t status = dmb_sim_get_input(sim, id, p);
    dmb_sim_destroy(&sim);
    return status;
}

static int32_t add_environment(dmb_model *model, void *p)
{
    return dmb_model_set_environment(model, p);
}
static int32_t add_segment(dmb_model *model, void *p)
{
    return dmb_model_add_time_function(model, p, 1, NULL);
}
static int32_t add_wall(dmb_model *model, void *p)
{
    return dmb_model_add_wall(model, p, NULL);
}
static int32_t add_hole_sections(dmb_model *model, void *p)
{
    return dmb_model_add_hole_sections(model, p, 1);
}
static int32_t add_string(dmb_model *model, void *p)
{
    return dmb_model_add_string(model, p, NULL);
}
static int32_t add_pipes(dmb_model *model, void *p)
{
    return dmb_model_add_pipes(model, p, 1, NULL);
}
static int32_t add_body(dmb_model *model, void *p)
{
    return dmb_model_add_body(model, p, NULL);
}
static int32_t add_bit(dmb_model *model, void *p)
{
    return dmb_model_add_bit(model, p, NULL);
}
static int32_t compile_with(dmb_model *model, void *p)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    assert_int_equal(dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_OK);
    return dmb_model_compile(model, p);
}

static dmb_place middle(void)
{
    return dmb_station(scene.parts.string, 3, 0.5);
}

CALL(environment_def, with_model(add_environment, p))
CALL(segment, with_model(add_segment, p))
CALL(wall_def, with_model(add_wall, p))
CALL(hole_section, with_model(add_hole_sections, p))
CALL(string_def, with_model(add_string, p))
CALL(pipe_def, with_model(add_pipes, p))
CALL(body_def, with_model(add_body, p))
CALL(bit_def, with_model(add_bit, p))
CALL(drive_def, with_model(add_drive, p))
CALL(load_def, with_model(add_load, p))
CALL(input_def, with_model(add_input, p))
CALL(event_def, with_model(add_event, p))
CALL(event_got, with_model(get_event, p))
CALL(event_report, with_model(report_event, p))
CALL(input_info, with_model(get_info, p))
CALL(input_state, with_model(get_state, p))
CALL(spring_def, with_model(add_spring, p))
CALL(stuck_def, with_model(add_stuck, p))
CALL(sub_def, with_model(add_sub, p))
CALL(sub, with_model(get_sub, p))
static int32_t call_motor(void *p)
{
    dmb_motor *motor = p;
    dmb_drive_def drive = dmb_drive_def_default();
    double speed;
    if (motor->struct_size >= 32) motor->stall_torque = motor->displacement = motor->flow = 1.0;
    return dmb_motor_drive(motor, &drive, &speed);
}

CALL(force_def, with_model(add_force, p))
CALL(stabiliser_def, with_model(add_stabiliser, p))
CALL(joint_def, with_model(add_joint, p))
CALL(coupling_def, with_model(add_coupling, p))
CALL(constraint_def, with_model(add_constraint, p))
CALL(compile_options, with_model(compile_with, p))
CALL(model_info, dmb_model_get_info(scene.model, p))
CALL(step_report, dmb_sim_step(scene.sim, 1e-6, p))
CALL(advance_report, dmb_sim_advance(scene.sim, dmb_sim_time(scene.sim) + 1e-6, p))
CALL(pose, dmb_query_pose(scene.sim, middle(), p))
CALL(motion, dmb_query_motion(scene.sim, middle(), p))
CALL(section, dmb_query_section(scene.sim, middle(), p))
CALL(hole_point, dmb_query_hole(scene.model, 1.0, p))
CALL(contact, dmb_query_contact(scene.sim, 0, p))
CALL(contact_total, dmb_query_contact_total(scene.sim, p))
CALL(energy, dmb_query_energy(scene.sim, p))
CALL(momentum, dmb_query_momentum(scene.sim, p))
CALL(drive_state, dmb_query_drive(scene.sim, scene.parts.turning, p))
CALL(spring_state, dmb_query_spring(scene.sim, scene.parts.rope, p))
CALL(stuck_state, dmb_query_stuck(scene.sim, scene.parts.jam, p))
CALL(flow_state, dmb_query_flow(scene.sim, p))
CALL(joint_state, dmb_query_joint(scene.sim, scene.parts.hinge, p))
CALL(bit_state, dmb_query_bit(scene.sim, scene.parts.bit, p))
CALL(statistics, dmb_query_statistics(scene.sim, p))

/* The whole scene has no static state, so that a struct that is accepted ends in this. */
CALL(static_options, dmb_analysis_static(scene.plain, p, NULL))
/* The whole scene is in no equilibrium. */
static int32_t order_is_fine(int32_t status)
{
    return status == DMB_ERR_ORDER || status == DMB_ERR_SINGULAR ? DMB_OK : status;
}
static dmb_buckling *no_buckling;
CALL(buckling_options, order_is_fine(dmb_analysis_buckling(scene.sim, p, &no_buckling)))
CALL(path_options, order_is_fine(dmb_analysis_path(scene.sim, p, NULL)))
CALL(path_report, order_is_fine(dmb_analysis_path(scene.sim, NULL, p)))
CALL(static_report, dmb_analysis_static(scene.plain, NULL, p))

static int32_t call_profile(void *p)
{
    static const int32_t depth = DMB_PROFILE_DEPTH;
    dmb_profile *profile = p;
    double values[2];
    if (profile->struct_size >= sizeof *profile) {
        profile->quantities = &depth;
        profile->quantity_count = 1;
        profile->station_count = 2;
        profile->values = values;
    }
    return dmb_query_profile(scene.sim, profile);
}

static int32_t call_operation(void *p)
{
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    return dmb_analysis_torque_drag(scene.plain, NULL, p, 1, &row);
}

static int32_t call_torque_drag_options(void *p)
{
    const dmb_operation still = dmb_operation_default();
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    return dmb_analysis_torque_drag(scene.plain, p, &still, 1, &row);
}

static int32_t call_torque_drag_row(void *p)
{
    const dmb_operation still = dmb_operation_default();
    return dmb_analysis_torque_drag(scene.plain, NULL, &still, 1, p);
}

static int32_t call_hydraulics(void *p)
{
    return dmb_analysis_hydraulics(scene.mud, 1.0, 0.1, p);
}

static int32_t fatigue_of(const dmb_fatigue_options *options, dmb_fatigue **fatigue)
{
    const dmb_place place = middle();
    return dmb_fatigue_create(scene.sim, options, &place, 1, fatigue);
}

static int32_t call_fatigue_options(void *p)
{
    dmb_fatigue_options *options = p;
    dmb_fatigue *fatigue = NULL;
    if (options->struct_size >= sizeof *options) {
        options->curve_stress = 1e8;
        options->slope = 3.0;
    }
    const int32_t status = fatigue_of(options, &fatigue);
    dmb_fatigue_destroy(&fatigue);
    return status;
}

/* Of a scene of its own: the large one has joints that no sensitivity takes. */
static int32_t call_parameter(void *p)
{
    dmb_parameter *parameter = p;
    dmb_sensitivity *sensitivity = NULL;
    dmb_model *model;
    dmb_sim *sim;
    const dmb_body_def body = dmb_body_def_default();
    assert_int_equal(dmb_model_create(NULL, &model), DMB_OK);
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_OK);
    assert_int_equal(dmb_model_compile(model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(model, NULL, &sim), DMB_OK);
    if (parameter->struct_size >= sizeof *parameter) {
        parameter->step = 1e-6;
        parameter->low = parameter->high = sim;
    }
    const int32_t status = dmb_sensitivity_create(sim, parameter, 1, &sensitivity);
    dmb_sensitivity_destroy(&sensitivity);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return status;
}

static int32_t call_fatigue_result(void *p)
{
    dmb_fatigue_options options = dmb_fatigue_options_default();
    dmb_fatigue *fatigue = NULL;
    options.curve_stress = 1e8;
    options.slope = 3.0;
    assert_int_equal(fatigue_of(&options, &fatigue), DMB_OK);
    const int32_t status = dmb_fatigue_get(fatigue, 0, p);
    dmb_fatigue_destroy(&fatigue);
    return status;
}

static int32_t call_window_options(void *p)
{
    dmb_window *window = NULL;
    const int32_t status = dmb_window_create(scene.sim, p, &scene.output, 1, &window);
    dmb_window_destroy(&window);
    return status;
}

static int32_t call_window_result(void *p)
{
    dmb_window *window = NULL;
    assert_int_equal(dmb_window_create(scene.sim, NULL, &scene.output, 1, &window), DMB_OK);
    const int32_t status = dmb_window_get(window, 0, p);
    dmb_window_destroy(&window);
    return status;
}

static int32_t call_profile_recorder(void *p)
{
    static const int32_t quantity = DMB_PROFILE_X;
    static dmb_profile profile;
    dmb_profile_recorder *recorder = p;
    profile = dmb_profile_default();
    profile.quantities = &quantity;
    profile.quantity_count = 1;
    if (recorder->struct_size >= sizeof *recorder) {
        recorder->profile = &profile;
        recorder->table = scene.table;
        recorder->capacity = 4;
        recorder->row_count = 0;
    }
    const int32_t status = dmb_profile_recorder_write_csv(recorder, "/dev/null");
    assert_int_equal(dmb_profile_recorder_take(recorder, scene.sim), status);
    return status;
}

static int32_t call_state_space_options(void *p)
{
    dmb_state_space_options *options = p;
    dmb_state_space *space = NULL;
    if (options->struct_size >= sizeof *options) options->form = DMB_STATE_MATRICES;
    const int32_t status = dmb_analysis_state_space(scene.sim, p, NULL, 0, NULL, 0, &space);
    dmb_state_space_destroy(&space);
    return status;
}

static int32_t call_state_space_info(void *p)
{
    dmb_state_space_options options = dmb_state_space_options_default();
    dmb_state_space *space = NULL;
    options.form = DMB_STATE_MATRICES;
    assert_int_equal(dmb_analysis_state_space(scene.sim, &options, NULL, 0, NULL, 0, &space), DMB_OK);
    const int32_t status = dmb_state_space_get_info(space, p);
    dmb_state_space_destroy(&space);
    return status;
}

static int32_t call_row(void *p)
{
    return dmb_query_row(scene.sim, 0, p);
}

static int32_t call_recorder(void *p)
{
    dmb_recorder *recorder = p;
    if (recorder->struct_size >= offsetof(dmb_recorder, window)) {
        recorder->outputs = &scene.output;
        recorder->output_count = 1;
        recorder->table = scene.table;
        recorder->capacity = 4;
        recorder->row_count = 0;
    }
    const int32_t status = dmb_recorder_write_csv(recorder, NULL, "/dev/null");
    assert_int_equal(dmb_recorder_take(recorder, scene.sim), status);
    return status;
}

#define ENTRY(T, output)                                                 \
    {                                                                    \
#T, sizeof(dmb_##T), sizeof(dmb_##T), init_##T, call_##T, output \
    }
#define GROWN(T, oldest, output)                                \
    {                                                           \
#T, sizeof(dmb_##T), oldest, init_##T, call_##T, output \
    }

static const entry entries[] = {
    ENTRY(allocator, 0),
    ENTRY(model_options, 0),
    GROWN(environment_def, 64, 0),
    ENTRY(segment, 0),
    GROWN(wall_def, 184, 0),
    ENTRY(hole_section, 0),
    GROWN(string_def, 136, 0),
    GROWN(pipe_def, 264, 0),
    GROWN(body_def, 216, 0),
    GROWN(bit_def, 136, 0),
    GROWN(drive_def, 80, 0),
    GROWN(load_def, 88, 0),
    ENTRY(compile_options, 0),
    GROWN(sim_options, 96, 0),
    GROWN(static_options, 40, 0),
    GROWN(model_info, 72, 1),
    ENTRY(step_report, 1),
    GROWN(static_report, 40, 1),
    ENTRY(buckling_options, 0),
    ENTRY(path_options, 0),
    ENTRY(path_report, 1),
    ENTRY(pose, 1),
    ENTRY(motion, 1),
    ENTRY(section, 1),
    GROWN(hole_point, 120, 1),
    ENTRY(profile, 0),
    ENTRY(operation, 0),
    ENTRY(torque_drag_options, 0),
    ENTRY(torque_drag_row, 1),
    ENTRY(hydraulics, 1),
    ENTRY(fatigue_options, 0),
    ENTRY(fatigue_result, 1),
    ENTRY(parameter, 0),
    GROWN(contact, 120, 1),
    ENTRY(contact_total, 1),
    GROWN(energy, 128, 1),
    ENTRY(momentum, 1),
    GROWN(drive_state, 56, 1),
    GROWN(bit_state, 56, 1),
    GROWN(statistics, 72, 1),
    GROWN(recorder, 48, 0),
    ENTRY(window_options, 0),
    ENTRY(window_result, 1),
    ENTRY(profile_recorder, 0),
    ENTRY(state_space_options, 0),
    ENTRY(state_space_info, 1),
    ENTRY(row, 1),
    ENTRY(joint_state, 1),
    ENTRY(joint_def, 0),
    GROWN(coupling_def, 64, 0),
    ENTRY(constraint_def, 0),
    ENTRY(input_def, 0),
    ENTRY(input_info, 1),
    ENTRY(input_state, 1),
    ENTRY(spring_def, 0),
    ENTRY(force_def, 0),
    GROWN(stabiliser_def, 96, 0),
    ENTRY(spring_state, 1),
    ENTRY(stuck_def, 0),
    GROWN(motor, 32, 0),
    ENTRY(stuck_state, 1),
    ENTRY(sub_def, 0),
    ENTRY(sub, 1),
    GROWN(flow_state, 96, 1),
    ENTRY(event_def, 0),
    {"event as described", sizeof(dmb_event_def), sizeof(dmb_event_def), init_event_def, call_event_got, 1},
    ENTRY(event_report, 1),
    {"advance's report", sizeof(dmb_step_report), sizeof(dmb_step_report), init_step_report, call_advance_report, 1},
};
enum { ENTRIES = sizeof entries / sizeof entries[0] };

/* ---- Fixture ----------------------------------------------------------------------------------------------------- */

static void make_pipe(const dmb_environment_def *environment, dmb_model **model, dmb_sim **sim)
{
    const dmb_wall_def wall = dmb_wall_def_default();
    assert_int_equal(dmb_model_create(NULL, model), DMB_OK);
    if (environment != NULL) assert_int_equal(dmb_model_set_environment(*model, environment), DMB_OK);
    assert_int_equal(dmb_model_add_wall(*model, &wall, NULL), DMB_OK);
    add_section(*model);
    assert_int_equal(dmb_model_compile(*model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(*model, NULL, sim), DMB_OK);
}

static int set_up(void **state)
{
    dmb_environment_def mud = dmb_environment_def_default();
    mud.fluid_density = 1000.0;
    mud.flow_rate = 1e-3;
    mud.consistency = 0.05;
    (void)state;
    memset(&scene, 0, sizeof scene);
    scene.model = whole_model(&scene.parts);
    scene.sim = whole_sim(scene.model, NULL);
    make_pipe(NULL, &scene.plain_model, &scene.plain);
    make_pipe(&mud, &scene.mud_model, &scene.mud);
    scene.output.quantity = DMB_OUTPUT_ENERGY_ERROR;
    whole_run(scene.sim, 3, 1e-3);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    dmb_sim_destroy(&scene.plain);
    dmb_model_destroy(&scene.plain_model);
    dmb_sim_destroy(&scene.mud);
    dmb_model_destroy(&scene.mud_model);
    dmb_sim_destroy(&scene.sim);
    dmb_model_destroy(&scene.model);
    return 0;
}

/* The call with the struct in memory of just `room` bytes, so that a checker sees what is touched beyond. */
static int32_t call_with(const entry *e, const void *bytes, size_t room)
{
    void *exact = malloc(room);
    memcpy(exact, bytes, room);
    const int32_t status = e->call(exact);
    if (status < 0 && e->output && memcmp(exact, bytes, room) != 0) fail_msg("%s: the struct was written", e->name);
    free(exact);
    return status;
}

static void refuses(const entry *e, const any_struct *given, size_t room)
{
    const uint64_t before = whole_hash(scene.sim);
    const int32_t status = call_with(e, given, room);
    if (status != DMB_ERR_STRUCT_SIZE)
        fail_msg("%s with struct_size %u: %s", e->name, given->struct_size, dmb_status_name(status));
    assert_true(whole_hash(scene.sim) == before);
}

static any_struct filled(const entry *e)
{
    any_struct s;
    memset(&s, 0, sizeof s);
    assert_true(e->size + EXTRA <= sizeof s);
    assert_int_equal(e->init(&s, (uint32_t)e->size), DMB_OK);
    return s;
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void size_as_in_this_header_is_taken(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        const any_struct s = filled(&entries[i]);
        assert_int_equal(s.struct_size, entries[i].size);
        const int32_t status = call_with(&entries[i], &s, entries[i].size);
        if (status < 0) fail_msg("%s: %s", entries[i].name, dmb_status_name(status));
    }
}

static void wrong_size_is_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        const uint32_t known = (uint32_t)entries[i].size;
        const uint32_t oldest = (uint32_t)entries[i].oldest;
        const uint32_t wrong[] = {
            0,           1,           4,         8, oldest - 8, known - 1, known + 1, known + 4, known + 1032,
            0x7FFFFFF8u, 0xFFFFFFF8u, UINT32_MAX};
        for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
            any_struct s = filled(&entries[i]);
            if (wrong[k] == known) continue;
            s.struct_size = wrong[k];
            refuses(&entries[i], &s, entries[i].size);
        }
    }
}

/* All zero, as a caller leaves it who did not read the documentation. */
static void zeros_are_refused(void **state)
{
    any_struct zeros;
    (void)state;
    memset(&zeros, 0, sizeof zeros);
    for (size_t i = 0; i < ENTRIES; i++) refuses(&entries[i], &zeros, entries[i].size);
}

static void memory_of_ones_is_refused(void **state)
{
    any_struct ones;
    (void)state;
    memset(&ones, 0xFF, sizeof ones);
    for (size_t i = 0; i < ENTRIES; i++) refuses(&entries[i], &ones, entries[i].size);
}

/* A newer header: what it has more is zero, so nothing is asked for that this library lacks. */
static void longer_struct_is_taken(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        any_struct s = filled(&entries[i]);
        assert_int_equal(entries[i].init(&s, (uint32_t)entries[i].size + EXTRA), DMB_OK);
        const int32_t status = call_with(&entries[i], &s, entries[i].size + EXTRA);
        if (status < 0) fail_msg("%s: %s", entries[i].name, dmb_status_name(status));
    }
}

/* Something is asked for that this library lacks. */
static void longer_struct_with_content_is_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        any_struct s = filled(&entries[i]);
        unsigned char *bytes = (unsigned char *)&s;
        if (entries[i].output) continue;
        s.struct_size = (uint32_t)entries[i].size + EXTRA;
        bytes[entries[i].size + EXTRA - 1] = 1;
        refuses(&entries[i], &s, entries[i].size + EXTRA);
    }
}

static void init_refuses_wrong_sizes(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        const uint32_t known = (uint32_t)entries[i].size;
        const uint32_t oldest = (uint32_t)entries[i].oldest;
        const uint32_t wrong[] = {0, 1, oldest - 8, known - 4, known + 4, known + 1032, UINT32_MAX - 7, UINT32_MAX};
        any_struct s, before;
        assert_int_equal(entries[i].init(NULL, known), DMB_ERR_NULL);
        for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
            memset(&s, 0x5A, sizeof s);
            before = s;
            assert_int_equal(entries[i].init(&s, wrong[k]), DMB_ERR_STRUCT_SIZE);
            assert_memory_equal(&s, &before, sizeof s);
        }
    }
}

/* A caller of an older header: what it does not have is left alone, or by default. */
static void older_struct_is_taken(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        any_struct s;
        memset(&s, 0x5A, sizeof s);
        assert_int_equal(entries[i].init(&s, (uint32_t)entries[i].oldest), DMB_OK);
        const int32_t status = call_with(&entries[i], &s, entries[i].oldest);
        if (status < 0) fail_msg("%s: %s", entries[i].name, dmb_status_name(status));
    }
}

/* No more is written than was told. */
static void init_stays_within_its_size(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENTRIES; i++) {
        any_struct s;
        const unsigned char *bytes = (const unsigned char *)&s;
        memset(&s, 0x5A, sizeof s);
        assert_int_equal(entries[i].init(&s, (uint32_t)entries[i].size), DMB_OK);
        for (size_t k = entries[i].size; k < sizeof s; k++) assert_int_equal(bytes[k], 0x5A);
    }
}

/* Terms stand side by side: all of them have to be of one size. */
static void terms_of_different_size_are_refused(void **state)
{
    dmb_segment terms[3] = {dmb_segment_default(), dmb_segment_default(), dmb_segment_default()};
    dmb_model *model = NULL;
    (void)state;
    assert_int_equal(dmb_model_create(NULL, &model), DMB_OK);
    for (size_t i = 1; i < 3; i++) {
        terms[i].struct_size = (uint32_t)sizeof(dmb_segment) + 8;
        assert_int_equal(dmb_model_add_time_function(model, terms, 3, NULL), DMB_ERR_STRUCT_SIZE);
        terms[i].struct_size = 0;
        assert_int_equal(dmb_model_add_time_function(model, terms, 3, NULL), DMB_ERR_STRUCT_SIZE);
        terms[i].struct_size = (uint32_t)sizeof(dmb_segment);
    }
    assert_int_equal(dmb_model_add_time_function(model, terms, 3, NULL), DMB_OK);
    dmb_model_destroy(&model);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(size_as_in_this_header_is_taken),
        TEST(wrong_size_is_refused),
        TEST(zeros_are_refused),
        TEST(memory_of_ones_is_refused),
        TEST(longer_struct_is_taken),
        TEST(older_struct_is_taken),
        TEST(longer_struct_with_content_is_refused),
        TEST(init_refuses_wrong_sizes),
        TEST(init_stays_within_its_size),
        TEST(terms_of_different_size_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
