/* A program that uses what the first headers of the series have: built with those and with the present ones, against
 * the present library, it prints the same (tests/abi/run). Structs of both are of different sizes. INTERFACE names the
 * header. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include INTERFACE

static dmb_model *model;
static dmb_sim *sim;

static void must(int line, int32_t status)
{
    if (status >= 0) return;
    printf("line %d: %s: %s %s\n", line, dmb_status_name(status), dmb_model_message(model), dmb_sim_message(sim));
    exit(1);
}

#define MUST(call) must(__LINE__, call)
#define PRINT(value) printf("%s = %a\n", #value, (double)(value))

typedef struct parts {
    dmb_id string, body, bit, drive, head, hinge, spring, stuck, input, event, load;
} parts;

static dmb_id ramp(double h1)
{
    dmb_term term = dmb_term_default();
    dmb_id id;
    term.kind = DMB_TERM_STEP;
    term.x1 = 0.02;
    term.h1 = h1;
    MUST(dmb_model_add_programme(model, &term, 1, &id));
    return id;
}

static void describe_string(parts *p)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    environment.fluid_density = 1000.0;
    MUST(dmb_model_set_environment(model, &environment));
    MUST(dmb_model_add_wall(model, &wall, NULL));
    string.offset[1] = -0.001;
    MUST(dmb_model_add_string(model, &string, &p->string));
    pipe.string = p->string;
    pipe.damping_time = 1e-5;
    pipe.eccentricity = 1e-3;
    MUST(dmb_model_add_pipes(model, &pipe, 4, NULL));
    bit.string = p->string;
    bit.rock_law = DMB_ROCK_REGENERATIVE;
    bit.load = ramp(2000.0);
    MUST(dmb_model_add_bit(model, &bit, &p->bit));
}

static void describe_drives(parts *p)
{
    dmb_drive_def feed = dmb_drive_def_default(), head = dmb_drive_def_default();
    feed.part = head.part = p->string;
    feed.programme = ramp(0.05);
    MUST(dmb_model_add_drive(model, &feed, &p->drive));
    head.kind = DMB_DRIVE_CONTROL;
    head.component = DMB_RX;
    head.gain = 200.0;
    head.programme = ramp(10.0);
    MUST(dmb_model_add_drive(model, &head, &p->head));
}

static void describe_others(parts *p)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def hinge = dmb_joint_def_default();
    dmb_spring_def spring = dmb_spring_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    body.position[1] = 2.0;
    MUST(dmb_model_add_body(model, &body, &p->body));
    hinge.kind = DMB_JOINT_REVOLUTE;
    hinge.place_b = dmb_station(p->body, 0, 0.0);
    hinge.axis_a[0] = 0.0, hinge.axis_a[1] = 1.0;
    hinge.origin_a[1] = 2.0, hinge.origin_a[2] = 0.5;
    hinge.match = 1;
    hinge.stiffness[DMB_RX] = 30.0;
    MUST(dmb_model_add_joint(model, &hinge, &p->hinge));
    spring.place_a = dmb_station(p->body, 0, 0.0);
    spring.offset_b[0] = 1.0, spring.offset_b[1] = 2.0;
    spring.stiffness = 100.0;
    spring.preload = 2.0;
    MUST(dmb_model_add_spring(model, &spring, &p->spring));
    load.place = dmb_station(p->string, 1, 0.5);
    load.force[2] = -10.0;
    MUST(dmb_model_add_load(model, &load, &p->load));
    stuck.place = dmb_station(p->string, 3, 0.5);
    stuck.overpull = 1e4;
    MUST(dmb_model_add_stuck(model, &stuck, &p->stuck));
}

static void describe_control(parts *p)
{
    dmb_input_def input = dmb_input_def_default();
    dmb_event_def event = dmb_event_def_default();
    strcpy(input.name, "rotation");
    input.part = p->head;
    input.rate_limit = 1000.0;
    MUST(dmb_model_add_input(model, &input, &p->input));
    strcpy(event.name, "turns");
    event.output.quantity = DMB_CHANNEL_DRIVE_SPEED;
    event.output.place = dmb_station(p->head, 0, 0.0);
    event.level = 0.5;
    MUST(dmb_model_add_event(model, &event, &p->event));
}

static void ask(const parts *p)
{
    dmb_pose pose = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    dmb_section section = dmb_section_default();
    dmb_contact_total contact = dmb_contact_total_default();
    dmb_energy energy = dmb_energy_default();
    dmb_drive_state drive = dmb_drive_state_default();
    dmb_joint_state joint = dmb_joint_state_default();
    dmb_spring_state spring = dmb_spring_state_default();
    dmb_bit_state bit = dmb_bit_state_default();
    dmb_stuck_state stuck = dmb_stuck_state_default();
    const dmb_place place = dmb_station(p->string, 2, 0.3);
    uint64_t hash;
    MUST(dmb_query_pose(sim, place, &pose));
    MUST(dmb_query_motion(sim, place, &motion));
    MUST(dmb_query_section(sim, place, &section));
    MUST(dmb_query_contact_total(sim, &contact));
    MUST(dmb_query_energy(sim, &energy));
    MUST(dmb_query_drive(sim, p->head, &drive));
    MUST(dmb_query_joint(sim, p->hinge, &joint));
    MUST(dmb_query_spring(sim, p->spring, &spring));
    MUST(dmb_query_bit(sim, p->bit, &bit));
    MUST(dmb_query_stuck(sim, p->stuck, &stuck));
    MUST(dmb_sim_hash(sim, &hash));
    for (int i = 0; i < 3; i++) PRINT(pose.position[i]);
    for (int i = 0; i < 3; i++) PRINT(motion.velocity[i]);
    PRINT(section.force[0]);
    PRINT(contact.normal_force);
    PRINT(energy.kinetic);
    PRINT(energy.error);
    PRINT(drive.force);
    PRINT(joint.position[DMB_RX]);
    PRINT(spring.force);
    PRINT(bit.weight);
    PRINT(stuck.share);
    printf("hash = %llx\n", (unsigned long long)hash);
}

static void run(const parts *p)
{
    dmb_step_report report = dmb_step_report_default();
    dmb_event_report event = dmb_event_report_default();
    dmb_channel channels[2] = {{dmb_station(p->string, 2, 0.3), DMB_CHANNEL_AXIAL_FORCE, 0},
                               {dmb_station(p->head, 0, 0.0), DMB_CHANNEL_DRIVE_SPEED, 0}};
    dmb_recorder recorder = dmb_recorder_default();
    double table[3 * 64];
    recorder.channels = channels;
    recorder.channel_count = 2;
    recorder.table = table;
    recorder.capacity = 64;
    for (int i = 0; i < 20; i++) {
        MUST(dmb_sim_step(sim, 5e-4, &report));
        MUST(dmb_recorder_take(&recorder, sim));
    }
    for (int i = 0; i < 60; i++) PRINT(table[i]);
    MUST(dmb_sim_set_input(sim, p->input, 5.0));
    MUST(dmb_sim_advance_to_event(sim, dmb_sim_time(sim) + 0.01, &event, &report));
    PRINT(event.time);
    PRINT(report.time);
}

static void analyse(void)
{
    dmb_static_options statics = dmb_static_options_default();
    dmb_static_report report = dmb_static_report_default();
    dmb_check_report check = dmb_check_report_default();
    PRINT(dmb_analysis_check(sim, &check));
    PRINT(check.coordinates);
    PRINT(dmb_analysis_static(sim, &statics, &report));
    PRINT(report.residual);
}

int main(void)
{
    dmb_model_options model_options = dmb_model_options_default();
    dmb_compile_options compile_options = dmb_compile_options_default();
    dmb_sim_options sim_options = dmb_sim_options_default();
    dmb_model_info info = dmb_model_info_default();
    parts p;
    memset(&p, 0, sizeof p);
    MUST(dmb_model_create(&model_options, &model));
    describe_string(&p);
    describe_drives(&p);
    describe_others(&p);
    describe_control(&p);
    MUST(dmb_model_compile(model, &compile_options));
    MUST(dmb_model_get_info(model, &info));
    PRINT(info.mass);
    MUST(dmb_sim_create(model, &sim_options, &sim));
    run(&p);
    ask(&p);
    analyse();
    ask(&p);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return 0;
}
