#include "contact_scene.h"

int32_t scene_must(const rig *scene, int32_t status)
{
    if (status < 0)
        fail_msg("%s: %s", dmb_status_name(status),
                 scene->sim != NULL ? dmb_sim_message(scene->sim) : dmb_model_message(scene->model));
    return status;
}

void scene_open(rig *scene, double g)
{
    rig_open(scene, 0.0, 0.0, -g);
}

/* ---- Description ------------------------------------------------------------------------------------------------- */

dmb_id scene_add_bit(rig *scene, const dmb_bit_def *bit)
{
    dmb_id id = {0, 0};
    scene_must(scene, dmb_model_add_bit(scene->model, bit, &id));
    return id;
}

dmb_segment scene_step_segment(double x0, double h0, double x1, double h1)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP;
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

double scene_position(const rig *scene, dmb_id body, int axis)
{
    return pose_at(scene, dmb_station(body, 0, 0.0)).position[axis];
}

double scene_displacement(const rig *scene, dmb_id body, int axis)
{
    return pose_at(scene, dmb_station(body, 0, 0.0)).displacement[axis];
}

double scene_speed(const rig *scene, dmb_id body, int component)
{
    return motion_at(scene, dmb_station(body, 0, 0.0), DMB_FRAME_WORLD).velocity[component];
}

double scene_rotation(const rig *scene, dmb_id body)
{
    return rotation_at(scene, dmb_station(body, 0, 0.0));
}

dmb_contact scene_contact(const rig *scene, uint32_t site)
{
    dmb_contact contact = dmb_contact_default();
    assert_int_equal(dmb_query_contact(scene->sim, site, &contact), DMB_OK);
    return contact;
}

double scene_total_energy(const rig *scene)
{
    const dmb_energy energy = energy_of(scene);
    return energy.kinetic + energy.strain + energy.gravity + energy.contact;
}

dmb_model_info scene_info(const rig *scene)
{
    dmb_model_info info = dmb_model_info_default();
    assert_int_equal(dmb_model_get_info(scene->model, &info), DMB_OK);
    return info;
}

dmb_step_report scene_advance(rig *scene, double time)
{
    dmb_step_report report = dmb_step_report_default();
    scene_must(scene, dmb_sim_advance(scene->sim, time, &report));
    return report;
}

dmb_step_report scene_step(rig *scene, double duration)
{
    dmb_step_report report = dmb_step_report_default();
    scene_must(scene, dmb_sim_step(scene->sim, duration, &report));
    return report;
}
