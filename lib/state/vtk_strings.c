/* The strings as poly-lines with point data, for ParaView. */
#include <math.h>
#include <stddef.h>

#include "query/pipe_run.h"
#include "query/site.h"
#include "state/handle.h"
#include "state/vtk_lines.h"

/* ---- Values of a point ------------------------------------------------------------------------------------------- */

static void put_position(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    dmb_pose pose = dmb_pose_default();
    (void)dmb_query_pose(sim, at->place, &pose);
    dmb_vtk_put_tuple(file, pose.position, 3);
}

static void put_displacement(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    dmb_pose pose = dmb_pose_default();
    (void)dmb_query_pose(sim, at->place, &pose);
    dmb_vtk_put_tuple(file, pose.displacement, 3);
}

static void put_velocity(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    dmb_motion motion = dmb_motion_default();
    (void)dmb_query_motion(sim, at->place, &motion);
    dmb_vtk_put_tuple(file, motion.velocity, 3);
}

static void put_diameter(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    const dmb_pipe_run *run = dmb_pipe_run_of(sim->model, at->string, at->place.pipe);
    const double diameter = run != NULL ? run->def.outer_diameter : 0.0;
    dmb_vtk_put_tuple(file, &diameter, 1);
}

/* Rigid pipes have no section loads: 0. */
static dmb_section section_at(const dmb_sim *sim, const dmb_vtk_station *at)
{
    dmb_section section = dmb_section_default();
    (void)dmb_query_section(sim, at->place, &section);
    return section;
}

static void put_axial_force(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    const dmb_section section = section_at(sim, at);
    dmb_vtk_put_tuple(file, &section.force[0], 1);
}

static void put_torque(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    const dmb_section section = section_at(sim, at);
    dmb_vtk_put_tuple(file, &section.force[3], 1);
}

static void put_bending_moment(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    const dmb_section section = section_at(sim, at);
    const double moment = hypot(section.force[4], section.force[5]);
    dmb_vtk_put_tuple(file, &moment, 1);
}

/* A rigid pipe counts as one element. */
static uint32_t elements_of(const dmb_pipe_map *pipe)
{
    return pipe->elements > 0 ? pipe->elements : 1;
}

/* Straight between the sites at the two ends of an element. */
static void put_normal_force(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    const dmb_string_map *map = &sim->scene->strings[at->string];
    const uint32_t elements = elements_of(&sim->scene->pipes[map->first_pipe + at->place.pipe]);
    const double along = at->place.fraction * elements;
    const uint32_t passed = along < elements ? (uint32_t)along : elements - 1;
    const dmb_id string = at->place.part;
    const uint32_t pipe = at->place.pipe;
    const double near_force = dmb_site_normal_force(sim, dmb_site_after(sim, string, pipe, passed));
    const double far_force = dmb_site_normal_force(sim, dmb_site_after(sim, string, pipe, passed + 1));
    const double force = near_force + (along - passed) * (far_force - near_force);
    dmb_vtk_put_tuple(file, &force, 1);
}

int32_t dmb_write_vtk_strings(const dmb_sim *sim, uint32_t per_element, const char *path)
{
    static const dmb_vtk_array arrays[] = {
        {"displacement", 3, put_displacement}, {"velocity", 3, put_velocity}, {"diameter", 1, put_diameter},
        {"axial_force", 1, put_axial_force},   {"torque", 1, put_torque},     {"bending_moment", 1, put_bending_moment},
        {"normal_force", 1, put_normal_force},
    };
    const dmb_vtk_picture picture = {sim,
                                     "PointData Scalars=\"axial_force\" Vectors=\"displacement\"",
                                     arrays,
                                     sizeof arrays / sizeof arrays[0],
                                     {"position", 3, put_position},
                                     per_element,
                                     0};
    const int32_t status = dmb_sim_check(sim);
    return status < 0 ? status : dmb_vtk_write_lines(sim, &picture, path);
}
