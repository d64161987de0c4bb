#include "rig.h"

#include <string.h>

void must_model(const rig *s, int32_t status)
{
    if (status < 0) fail_msg("%s: %s", dmb_status_name(status), dmb_model_message(s->model));
}

void must(const rig *s, int32_t status)
{
    if (status < 0) fail_msg("%s: %s", dmb_status_name(status), dmb_sim_message(s->sim));
}

void rig_open(rig *s, double gx, double gy, double gz)
{
    dmb_environment_def environment = dmb_environment_def_default();
    s->model = NULL;
    s->sim = NULL;
    assert_int_equal(dmb_model_create(NULL, &s->model), DMB_OK);
    environment.gravity[0] = gx;
    environment.gravity[1] = gy;
    environment.gravity[2] = gz;
    must_model(s, dmb_model_set_environment(s->model, &environment));
}

int32_t rig_start_with(rig *s, const dmb_compile_options *compile, const dmb_sim_options *options)
{
    must_model(s, dmb_model_compile(s->model, compile));
    const int32_t status = dmb_sim_create(s->model, options, &s->sim);
    must_model(s, status);
    return status;
}

int32_t rig_start(rig *s, const dmb_sim_options *options)
{
    return rig_start_with(s, NULL, options);
}

void rig_close(rig *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

/* ---- Parts ------------------------------------------------------------------------------------------------------- */

void must_refuse(const char *message, int32_t status, int32_t wanted, const char *words)
{
    if (status != wanted || strstr(message, words) == NULL)
        fail_msg("wanted %s, \"%s\": %s: %s", dmb_status_name(wanted), words, dmb_status_name(status), message);
    print_message("    %s\n", message);
}

dmb_id add_string(rig *s, const dmb_string_def *def)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_string(s->model, def, &id));
    return id;
}

dmb_id add_pipes(rig *s, const dmb_pipe_def *def, uint32_t count)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_pipes(s->model, def, count, &id));
    return id;
}

dmb_id add_body(rig *s, const dmb_body_def *def)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_body(s->model, def, &id));
    return id;
}

dmb_id add_wall(rig *s, const dmb_wall_def *def)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_wall(s->model, def, &id));
    return id;
}

dmb_id add_drive(rig *s, const dmb_drive_def *def)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_drive(s->model, def, &id));
    return id;
}

dmb_id add_load(rig *s, const dmb_load_def *def)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_load(s->model, def, &id));
    return id;
}

dmb_id add_joint(rig *s, const dmb_joint_def *def)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_joint(s->model, def, &id));
    return id;
}

dmb_joint_def joint_between(int32_t kind, dmb_place a, dmb_place b)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = kind;
    joint.place_a = a;
    joint.place_b = b;
    return joint;
}

dmb_id add_joint_between(rig *s, int32_t kind, dmb_place a, dmb_place b)
{
    const dmb_joint_def joint = joint_between(kind, a, b);
    return add_joint(s, &joint);
}

dmb_id add_time_function(rig *s, const dmb_segment *terms, uint32_t count)
{
    dmb_id id = {0, 0};
    must_model(s, dmb_model_add_time_function(s->model, terms, count, &id));
    return id;
}

dmb_id add_constant(rig *s, double value)
{
    dmb_segment term = dmb_segment_default();
    term.h0 = value;
    return add_time_function(s, &term, 1);
}

dmb_id add_callback(rig *s, dmb_time_fn callback, void *context)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_CALLBACK;
    term.provides = DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL;
    term.callback = callback;
    term.callback_context = context;
    return add_time_function(s, &term, 1);
}

dmb_id add_simple_drive(rig *s, int32_t kind, dmb_id part, int32_t component, dmb_id time_function)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = kind;
    drive.part = part;
    drive.component = component;
    drive.time_function = time_function;
    return add_drive(s, &drive);
}

/* ---- Run --------------------------------------------------------------------------------------------------------- */

void take_steps(const rig *s, double h, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        const int32_t status = dmb_sim_step(s->sim, h, NULL);
        if (status != DMB_OK) fail_msg("step %u: %s: %s", i, dmb_status_name(status), dmb_sim_message(s->sim));
    }
}

void take_divided_steps(const rig *s, double h, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        const int32_t status = dmb_sim_step(s->sim, h, NULL);
        if (status < 0) must(s, status);
    }
}

dmb_static_report find_equilibrium(const rig *s, const dmb_static_options *options)
{
    dmb_static_report report = dmb_static_report_default();
    must(s, dmb_analysis_static(s->sim, options, &report));
    return report;
}

/* ---- Ask --------------------------------------------------------------------------------------------------------- */

dmb_pose pose_at(const rig *s, dmb_place place)
{
    dmb_pose pose = dmb_pose_default();
    must(s, dmb_query_pose(s->sim, place, &pose));
    return pose;
}

dmb_motion motion_at(const rig *s, dmb_place place, int32_t frame)
{
    dmb_motion motion = dmb_motion_default();
    motion.frame = frame;
    must(s, dmb_query_motion(s->sim, place, &motion));
    return motion;
}

dmb_energy energy_of(const rig *s)
{
    dmb_energy energy = dmb_energy_default();
    must(s, dmb_query_energy(s->sim, &energy));
    return energy;
}

dmb_momentum momentum_of(const rig *s)
{
    dmb_momentum momentum = dmb_momentum_default();
    must(s, dmb_query_momentum(s->sim, &momentum));
    return momentum;
}

dmb_contact_total contacts_of(const rig *s)
{
    dmb_contact_total sum = dmb_contact_total_default();
    must(s, dmb_query_contact_total(s->sim, &sum));
    return sum;
}

dmb_statistics statistics_of(const rig *s)
{
    dmb_statistics statistics = dmb_statistics_default();
    must(s, dmb_query_statistics(s->sim, &statistics));
    return statistics;
}

double rotation_at(const rig *s, dmb_place place)
{
    double angle = (double)NAN;
    must(s, dmb_query_rotation(s->sim, place, &angle));
    return angle;
}

uint64_t rig_hash(const rig *s)
{
    uint64_t hash = 0;
    must(s, dmb_sim_hash(s->sim, &hash));
    return hash;
}

/* ---- Reference string and beams ---------------------------------------------------------------------------------- */

dmb_pipe_def s1_pipe(void)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.length = 1.5;
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.055;
    pipe.young_modulus = 210e9;
    pipe.poisson_ratio = 0.3;
    pipe.density = 7850.0;
    pipe.shear_factor = 0.5;
    return pipe;
}

s1_section s1_values(void)
{
    const double D = 0.073, d = 0.055, E = 210e9, G = E / 2.6;
    s1_section v;
    v.A = 0.25 * PI * (D * D - d * d);
    v.I = PI / 64.0 * (D * D * D * D - d * d * d * d);
    v.EA = E * v.A;
    v.EI = E * v.I;
    v.GJ = 2.0 * G * v.I;
    v.GA = 0.5 * G * v.A;
    v.mass = 7850.0 * v.A;
    v.weight = 9.81 * v.mass;
    return v;
}

dmb_wall_def s1_hole(void)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.diameter = 0.094;
    return wall;
}

dmb_pipe_def beam_pipe(double length, uint32_t elements, double EA, double GA, double GJ, double EI)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.length = length;
    pipe.elements = elements;
    pipe.outer_diameter = 0.02;
    pipe.inner_diameter = 0.0;
    const double stiffness[6] = {EA, GA, GA, GJ, EI, EI};
    for (int i = 0; i < 6; i++) pipe.section_stiffness[i] = stiffness[i];
    return pipe;
}

dmb_id add_beam(rig *s, const dmb_pipe_def *pipe, int32_t start_free)
{
    dmb_string_def def = dmb_string_def_default();
    def.follows_hole = 0;
    def.start_free = start_free;
    const dmb_id string = add_string(s, &def);
    dmb_pipe_def with = *pipe;
    with.string = string;
    (void)add_pipes(s, &with, 1);
    return string;
}
