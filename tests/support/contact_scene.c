#include "contact_scene.h"

static const dmb_id nothing = {0, 0};

int32_t scene_must(const contact_scene *scene, int32_t status)
{
    if (status < 0)
        fail_msg("%s: %s", dmb_status_name(status),
                 scene->sim != NULL ? dmb_sim_message(scene->sim) : dmb_model_message(scene->model));
    return status;
}

void scene_open(contact_scene *scene, double g)
{
    dmb_environment_def environment = dmb_environment_def_default();
    scene->model = NULL;
    scene->sim = NULL;
    assert_int_equal(dmb_model_create(NULL, &scene->model), DMB_OK);
    environment.gravity[2] = -g;
    scene_must(scene, dmb_model_set_environment(scene->model, &environment));
}

void scene_start(contact_scene *scene, const dmb_compile_options *compile, const dmb_sim_options *options)
{
    scene_must(scene, dmb_model_compile(scene->model, compile));
    const int32_t status = dmb_sim_create(scene->model, options, &scene->sim);
    if (status < 0) fail_msg("no sim: %s", dmb_status_name(status));
}

void scene_close(contact_scene *scene)
{
    dmb_sim_destroy(&scene->sim);
    dmb_model_destroy(&scene->model);
}

/* ---- Description ------------------------------------------------------------------------------------------------- */

void scene_add_wall(contact_scene *scene, const dmb_wall_def *wall)
{
    scene_must(scene, dmb_model_add_wall(scene->model, wall, NULL));
}

dmb_id scene_add_body(contact_scene *scene, const dmb_body_def *body)
{
    dmb_id id = nothing;
    scene_must(scene, dmb_model_add_body(scene->model, body, &id));
    return id;
}

dmb_id scene_add_pipes(contact_scene *scene, const dmb_pipe_def *pipe, uint32_t count)
{
    dmb_id id = nothing;
    scene_must(scene, dmb_model_add_pipes(scene->model, pipe, count, &id));
    return id;
}

dmb_id scene_add_string(contact_scene *scene, const dmb_string_def *string)
{
    dmb_id id = nothing;
    scene_must(scene, dmb_model_add_string(scene->model, string, &id));
    return id;
}

dmb_id scene_add_bit(contact_scene *scene, const dmb_bit_def *bit)
{
    dmb_id id = nothing;
    scene_must(scene, dmb_model_add_bit(scene->model, bit, &id));
    return id;
}

dmb_id scene_add_load(contact_scene *scene, const dmb_load_def *load)
{
    dmb_id id = nothing;
    scene_must(scene, dmb_model_add_load(scene->model, load, &id));
    return id;
}

dmb_id scene_add_drive(contact_scene *scene, const dmb_drive_def *drive)
{
    dmb_id id = nothing;
    scene_must(scene, dmb_model_add_drive(scene->model, drive, &id));
    return id;
}

dmb_id scene_add_terms(contact_scene *scene, const dmb_term *terms, uint32_t count)
{
    dmb_id id = nothing;
    scene_must(scene, dmb_model_add_programme(scene->model, terms, count, &id));
    return id;
}

dmb_id scene_add_constant(contact_scene *scene, double value)
{
    dmb_term term = dmb_term_default();
    term.h0 = value;
    return scene_add_terms(scene, &term, 1);
}

dmb_term scene_step_term(double x0, double h0, double x1, double h1)
{
    dmb_term term = dmb_term_default();
    term.kind = DMB_TERM_STEP;
    term.x0 = x0;
    term.h0 = h0;
    term.x1 = x1;
    term.h1 = h1;
    return term;
}

dmb_wall_def scene_wide_wall(int32_t normal_law, double stiffness, double exponent, double restitution)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.diameter = 4.1;
    wall.normal_law = normal_law;
    wall.friction_law = DMB_FRICTION_NONE;
    wall.stiffness = stiffness;
    wall.exponent = exponent;
    wall.restitution = restitution;
    return wall;
}

dmb_body_def scene_ball(double mass, double gap, int32_t free_mask)
{
    dmb_body_def ball = dmb_body_def_default();
    ball.mass = mass;
    ball.free_mask = free_mask;
    ball.contact_diameter = 0.1;
    ball.contact_length = 1.0;
    ball.position[2] = gap - 2.0;
    return ball;
}

/* ---- Questions --------------------------------------------------------------------------------------------------- */

static dmb_pose pose_of(const contact_scene *scene, dmb_id body)
{
    dmb_pose pose = dmb_pose_default();
    assert_int_equal(dmb_query_pose(scene->sim, dmb_station(body, 0, 0.0), &pose), DMB_OK);
    return pose;
}

double scene_position(const contact_scene *scene, dmb_id body, int axis)
{
    return pose_of(scene, body).position[axis];
}

double scene_displacement(const contact_scene *scene, dmb_id body, int axis)
{
    return pose_of(scene, body).displacement[axis];
}

double scene_speed(const contact_scene *scene, dmb_id body, int component)
{
    dmb_motion motion = dmb_motion_default();
    assert_int_equal(dmb_query_motion(scene->sim, dmb_station(body, 0, 0.0), &motion), DMB_OK);
    return motion.velocity[component];
}

double scene_rotation(const contact_scene *scene, dmb_id body)
{
    double angle = 0.0;
    assert_int_equal(dmb_query_rotation(scene->sim, dmb_station(body, 0, 0.0), &angle), DMB_OK);
    return angle;
}

dmb_contact scene_contact(const contact_scene *scene, uint32_t site)
{
    dmb_contact contact = dmb_contact_default();
    assert_int_equal(dmb_query_contact(scene->sim, site, &contact), DMB_OK);
    return contact;
}

dmb_energy scene_energy(const contact_scene *scene)
{
    dmb_energy energy = dmb_energy_default();
    assert_int_equal(dmb_query_energy(scene->sim, &energy), DMB_OK);
    return energy;
}

double scene_total_energy(const contact_scene *scene)
{
    const dmb_energy energy = scene_energy(scene);
    return energy.kinetic + energy.strain + energy.gravity + energy.contact;
}

dmb_statistics scene_statistics(const contact_scene *scene)
{
    dmb_statistics statistics = dmb_statistics_default();
    assert_int_equal(dmb_query_statistics(scene->sim, &statistics), DMB_OK);
    return statistics;
}

dmb_model_info scene_info(const contact_scene *scene)
{
    dmb_model_info info = dmb_model_info_default();
    assert_int_equal(dmb_model_get_info(scene->model, &info), DMB_OK);
    return info;
}

dmb_step_report scene_advance(contact_scene *scene, double time)
{
    dmb_step_report report = dmb_step_report_default();
    scene_must(scene, dmb_sim_advance(scene->sim, time, &report));
    return report;
}

dmb_step_report scene_step(contact_scene *scene, double duration)
{
    dmb_step_report report = dmb_step_report_default();
    scene_must(scene, dmb_sim_step(scene->sim, duration, &report));
    return report;
}

uint64_t scene_hash(const contact_scene *scene)
{
    uint64_t hash = 0;
    assert_int_equal(dmb_sim_hash(scene->sim, &hash), DMB_OK);
    return hash;
}
