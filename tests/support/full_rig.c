#include "full_rig.h"

/* Slopes of the diameter up to 0.1. */
static void add_full_sections(const rig *s)
{
    dmb_hole_section sections[3] = {dmb_hole_section_default(), dmb_hole_section_default(), dmb_hole_section_default()};
    for (int i = 0; i < 3; i++) {
        sections[i].shape = i < 2 ? DMB_HOLE_LINE : DMB_HOLE_STEP;
        sections[i].depth = -3.0 + 5.5 * i - 1.5 * (i / 2);
        sections[i].transition = i == 0 ? 1.0 : 4.0;
        sections[i].diameter = i == 1 ? 0.62 : 0.42;
        sections[i].stiffness = i == 1 ? 250.0 : 600.0;
        sections[i].restitution = 0.3 + 0.1 * i;
        sections[i].damping = 30.0 + 5.0 * i;
        sections[i].mu_static = 0.9 - 0.1 * i;
        sections[i].mu_dynamic = 0.3 + 0.1 * i;
    }
    must_model(s, dmb_model_add_hole_sections(s->model, sections, 3));
}

static void add_full_hole(rig *s, const full_rig_choice *choice)
{
    static const double survey[9] = {0.0, 0.5 * PI, 0.0, 3.0, 0.5 * PI - 0.15, 0.1, 9.0, 0.5 * PI - 0.5, 0.4};
    dmb_wall_def wall = dmb_wall_def_default();
    wall.diameter = 0.5;
    wall.normal_law = choice->normal_law;
    wall.friction_law = choice->friction_law;
    wall.stiffness = 400.0;
    wall.damping = 30.0;
    wall.mu_static = 0.7;
    wall.mu_dynamic = 0.4;
    wall.stribeck_speed = 0.5;
    wall.smoothing_speed = 0.2;
    wall.full_speed = 2.0;
    wall.bristle_stiffness = 30.0;
    wall.bristle_damping = 0.3;
    wall.approach_speed = 0.3;
    if (choice->curved) {
        wall.survey = survey;
        wall.survey_count = 3;
    }
    (void)add_wall(s, &wall);
    if (choice->sections & 1) add_full_sections(s);
}

static dmb_pipe_def soft_pipe(void)
{
    static const double stiffness[6] = {90.0, 40.0, 50.0, 30.0, 20.0, 25.0};
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.length = 1.0;
    pipe.outer_diameter = 0.3;
    pipe.inner_diameter = 0.28;
    pipe.density = 200.0;
    pipe.damping_time = 0.05;
    pipe.eccentricity = 0.05;
    pipe.eccentricity_angle = 0.7;
    pipe.angle_spread = 1.0;
    for (int i = 0; i < 6; i++) pipe.section_stiffness[i] = stiffness[i];
    return pipe;
}

static dmb_id add_full_string(rig *s, const full_rig_choice *choice)
{
    dmb_string_def def = dmb_string_def_default();
    def.start_depth = 0.4;
    def.start_free = DMB_FREE_CYLINDRICAL;
    const dmb_id string = add_string(s, &def);
    dmb_pipe_def pipe = soft_pipe();
    pipe.contact_points = choice->sections & 2 ? 3 : 0;
    pipe.string = string;
    pipe.elements = 2;
    pipe.joint_length = 0.15;
    pipe.joint_outer_diameter = 0.33;
    (void)add_pipes(s, &pipe, 1);
    pipe = soft_pipe();
    pipe.contact_points = choice->sections & 2 ? 4 : 0;
    pipe.string = string;
    pipe.kind = choice->rings_only ? DMB_PIPE_FLEXIBLE : DMB_PIPE_AXIAL_TORSIONAL;
    (void)add_pipes(s, &pipe, 2);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    (void)add_pipes(s, &pipe, 1);
    pipe.kind = DMB_PIPE_RIGID;
    pipe.length = 0.6;
    (void)add_pipes(s, &pipe, 1);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    pipe.length = 1.0;
    (void)add_pipes(s, &pipe, 1);
    return string;
}

static void add_full_bit(rig *s, dmb_id string, const full_rig_choice *choice)
{
    dmb_bit_def bit = dmb_bit_def_default();
    bit.string = string;
    bit.rock_law = choice->rock_law;
    if (!choice->rings_only) bit.load = add_constant(s, 4.0);
    bit.mass = 1.5;
    bit.diameter = 0.34;
    bit.radius = 0.3;
    bit.intrinsic_energy = 60.0;
    bit.contact_strength = 150.0;
    bit.wear_length = 0.1;
    bit.intrusion_depth = 0.05;
    if (choice->sections & 8) bit.added_mass[0] = 0.4, bit.added_mass[1] = 0.9;
    (void)dmb_model_add_bit(s->model, &bit, NULL);
}

static void add_full_loads(rig *s, dmb_id string, const full_rig_choice *choice)
{
    const int32_t last = choice->rings_only ? DMB_FRAME_BODY : DMB_FRAME_HOLE;
    for (int32_t frame = DMB_FRAME_WORLD; frame <= last; frame++)
        for (uint32_t pipe = 0; pipe < 6; pipe += 2) {
            dmb_load_def load = dmb_load_def_default();
            load.frame = frame;
            load.place = dmb_station(string, pipe, 1.0);
            for (int i = 0; i < 3; i++) {
                load.force[i] = 2.0 + frame - i;
                load.moment[i] = 0.5 * i - 0.3 * frame;
            }
            (void)add_load(s, &load);
        }
}

static void add_full_drives(rig *s, dmb_id string)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = string;
    drive.component = DMB_RX;
    drive.time_function = add_constant(s, 3.0);
    drive.gain = 2.0;
    drive.integral_gain = 40.0;
    (void)add_drive(s, &drive);
    drive.component = DMB_X;
    drive.time_function = add_constant(s, 0.4);
    (void)add_drive(s, &drive);
}

static void add_free_body(rig *s, const full_rig_choice *choice)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 1.2;
    body.position[0] = 0.7;
    body.centre[0] = 0.1;
    body.centre[1] = -0.05;
    body.centre[2] = 0.07;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.2 + 0.05 * i;
    body.inertia[3] = 0.02;
    body.inertia[5] = -0.03;
    body.contact_diameter = 0.3;
    body.contact_length = 0.5;
    if (choice->sections & 8) body.added_mass[0] = 0.7, body.added_mass[1] = 1.3;
    (void)add_body(s, &body);
}

void full_rig_open(rig *s, const full_rig_choice *choice)
{
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig_open(s, 0.3, -0.4, -9.81);
    environment.gravity[0] = 0.3;
    environment.gravity[1] = -0.4;
    environment.fluid_density = 20.0;
    environment.flow_rate = choice->sections & 4 ? 0.05 : 0.0;
    environment.added_mass = choice->sections & 8 ? -1.0 : 0.0;
    environment.consistency = 0.1;
    environment.lateral_damping = 0.5;
    environment.axial_damping = 0.3;
    environment.torsional_damping = 0.2;
    must_model(s, dmb_model_set_environment(s->model, &environment));
    add_full_hole(s, choice);
    const dmb_id string = add_full_string(s, choice);
    dmb_body_def head = dmb_body_def_default();
    head.attach = DMB_ATTACH_START;
    head.string = string;
    head.mass = 2.0;
    head.centre[1] = 0.1;
    for (int i = 0; i < 3; i++) head.inertia[i] = 0.1 + 0.02 * i;
    if (choice->sections & 8) head.centre[0] = -0.2, head.added_mass[0] = 0.6, head.added_mass[1] = 1.1;
    (void)add_body(s, &head);
    add_full_bit(s, string, choice);
    add_full_loads(s, string, choice);
    add_full_drives(s, string);
    add_free_body(s, choice);
    options.energy_ledger = choice->ledger;
    (void)rig_start(s, &options);
}
