/* The strings as poly-lines with point data, for ParaView. */
#include <math.h>
#include <stddef.h>

#include "query/pipe_run.h"
#include "query/site.h"
#include "state/handle.h"
#include "state/vtk_xml.h"

enum { DMB_POINTS_MAX = 64 };

/* A point of the picture. */
typedef struct station {
    uint32_t string;
    dmb_place place;
} station;

typedef void station_fn(dmb_text_file *file, const dmb_sim *sim, const station *at);

/* A rigid pipe counts as one element. */
static uint32_t elements_of(const dmb_pipe_map *pipe)
{
    return pipe->elements > 0 ? pipe->elements : 1;
}

static uint32_t points_of_pipe(const dmb_pipe_map *pipe, uint32_t per_element)
{
    return elements_of(pipe) * per_element;
}

static uint64_t points_of_string(const dmb_scene *scene, uint32_t string, uint32_t per_element)
{
    const dmb_string_map *map = &scene->strings[string];
    uint64_t points = 1;
    for (uint32_t i = 0; i < map->pipe_count; i++) {
        points += points_of_pipe(&scene->pipes[map->first_pipe + i], per_element);
    }
    return points;
}

static dmb_id string_id(const dmb_sim *sim, uint32_t string)
{
    dmb_id id;
    id.index = (uint32_t)DMB_PART_STRING << 24 | string;
    id.generation = sim->model->stamp;
    return id;
}

/* Every point in order: each pipe without its last one, then the string's end. */
static void walk_string(dmb_text_file *file, const dmb_sim *sim, uint32_t string, uint32_t per_element, station_fn *put)
{
    const dmb_string_map *map = &sim->scene->strings[string];
    station at = {string, {string_id(sim, string), 0, 0, 0.0}};
    for (uint32_t i = 0; i < map->pipe_count; i++) {
        const uint32_t count = points_of_pipe(&sim->scene->pipes[map->first_pipe + i], per_element);
        at.place.pipe = i;
        for (uint32_t k = 0; k < count; k++) {
            at.place.fraction = (double)k / count;
            put(file, sim, &at);
        }
    }
    at.place.fraction = 1.0;
    put(file, sim, &at);
}

static void walk(dmb_text_file *file, const dmb_sim *sim, uint32_t per_element, station_fn *put)
{
    for (uint32_t i = 0; i < sim->scene->string_count; i++) walk_string(file, sim, i, per_element, put);
}

/* ---- Values of a point ------------------------------------------------------------------------------------------- */

static void put_position(dmb_text_file *file, const dmb_sim *sim, const station *at)
{
    dmb_pose pose = dmb_pose_default();
    (void)dmb_query_pose(sim, at->place, &pose);
    dmb_vtk_put_tuple(file, pose.position, 3);
}

static void put_displacement(dmb_text_file *file, const dmb_sim *sim, const station *at)
{
    dmb_pose pose = dmb_pose_default();
    (void)dmb_query_pose(sim, at->place, &pose);
    dmb_vtk_put_tuple(file, pose.displacement, 3);
}

static void put_velocity(dmb_text_file *file, const dmb_sim *sim, const station *at)
{
    dmb_motion motion = dmb_motion_default();
    (void)dmb_query_motion(sim, at->place, &motion);
    dmb_vtk_put_tuple(file, motion.velocity, 3);
}

static void put_diameter(dmb_text_file *file, const dmb_sim *sim, const station *at)
{
    const dmb_pipe_run *run = dmb_pipe_run_of(sim->model, at->string, at->place.pipe);
    const double diameter = run != NULL ? run->def.outer_diameter : 0.0;
    dmb_vtk_put_tuple(file, &diameter, 1);
}

/* Rigid pipes have no section loads: 0. */
static dmb_section section_at(const dmb_sim *sim, const station *at)
{
    dmb_section section = dmb_section_default();
    (void)dmb_query_section(sim, at->place, &section);
    return section;
}

static void put_axial_force(dmb_text_file *file, const dmb_sim *sim, const station *at)
{
    const dmb_section section = section_at(sim, at);
    dmb_vtk_put_tuple(file, &section.force[0], 1);
}

static void put_torque(dmb_text_file *file, const dmb_sim *sim, const station *at)
{
    const dmb_section section = section_at(sim, at);
    dmb_vtk_put_tuple(file, &section.force[3], 1);
}

static void put_bending_moment(dmb_text_file *file, const dmb_sim *sim, const station *at)
{
    const dmb_section section = section_at(sim, at);
    const double moment = hypot(section.force[4], section.force[5]);
    dmb_vtk_put_tuple(file, &moment, 1);
}

/* Straight between the sites at the two ends of an element. */
static void put_normal_force(dmb_text_file *file, const dmb_sim *sim, const station *at)
{
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

/* ---- Arrays ------------------------------------------------------------------------------------------------------ */

typedef struct point_array {
    const char *name;
    uint32_t components;
    station_fn *put;
} point_array;

static void put_array(dmb_text_file *file, const dmb_sim *sim, uint32_t per_element, const point_array *array)
{
    dmb_vtk_begin_numbers(file, array->name, array->components);
    walk(file, sim, per_element, array->put);
    dmb_vtk_end_array(file);
}

static void put_points(dmb_text_file *file, const dmb_sim *sim, uint32_t per_element)
{
    static const point_array positions = {"position", 3, put_position};
    static const point_array arrays[] = {
        {"displacement", 3, put_displacement}, {"velocity", 3, put_velocity}, {"diameter", 1, put_diameter},
        {"axial_force", 1, put_axial_force},   {"torque", 1, put_torque},     {"bending_moment", 1, put_bending_moment},
        {"normal_force", 1, put_normal_force},
    };
    dmb_vtk_open_tag(file, "PointData Scalars=\"axial_force\" Vectors=\"displacement\"");
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) put_array(file, sim, per_element, &arrays[i]);
    dmb_vtk_close_tag(file, "PointData");
    dmb_vtk_open_tag(file, "Points");
    put_array(file, sim, per_element, &positions);
    dmb_vtk_close_tag(file, "Points");
}

static void put_index(dmb_text_file *file, uint64_t index)
{
    dmb_text_put_count(file, index);
    dmb_text_put(file, "\n");
}

/* One poly-line a string, through its points in order. */
static void put_lines(dmb_text_file *file, const dmb_sim *sim, uint32_t per_element, uint64_t points)
{
    uint64_t end = 0;
    dmb_vtk_open_tag(file, "Lines");
    dmb_vtk_begin_indices(file, "connectivity");
    for (uint64_t i = 0; i < points; i++) put_index(file, i);
    dmb_vtk_end_array(file);
    dmb_vtk_begin_indices(file, "offsets");
    for (uint32_t i = 0; i < sim->scene->string_count; i++) {
        end += points_of_string(sim->scene, i, per_element);
        put_index(file, end);
    }
    dmb_vtk_end_array(file);
    dmb_vtk_close_tag(file, "Lines");
}

int32_t dmb_write_vtk_strings(const dmb_sim *sim, uint32_t per_element, const char *path)
{
    int32_t status = dmb_sim_check(sim);
    dmb_vtk_counts counts = {0, 0, 0};
    dmb_text_file file;
    if (status < 0) return status;
    if (path == NULL) return DMB_ERR_NULL;
    if (per_element < 1 || per_element > DMB_POINTS_MAX) return DMB_ERR_VALUE;
    counts.lines = sim->scene->string_count;
    for (uint32_t i = 0; i < counts.lines; i++) counts.points += points_of_string(sim->scene, i, per_element);
    status = dmb_text_open(&file, path);
    if (status < 0) return status;
    dmb_vtk_begin(&file, &counts, sim->clock->time);
    put_points(&file, sim, per_element);
    put_lines(&file, sim, per_element, counts.points);
    dmb_vtk_end(&file);
    return dmb_text_close(&file);
}
