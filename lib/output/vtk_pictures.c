/* Pictures for ParaView: strings as poly-lines with point data, the wall of the hole, frames of a mode. */
#include <math.h>
#include <stddef.h>

#include "analysis/modes/modes.h"
#include "base/sized_struct.h"
#include "base/value_check.h"
#include "drillmbd/ask.h"
#include "math/so3.h"
#include "model/model.h"
#include "output/output.h"
#include "query/query.h"
#include "sim/access.h"

/* ---- Values of a point ------------------------------------------------------------------------------------------- */

static void put_position(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    dmb_pose pose = dmb_pose_default();
    (void)dmb_answer_pose(sim, at->place, &pose);
    dmb_vtk_put_tuple(file, pose.position, 3);
}

static void put_displacement(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    dmb_pose pose = dmb_pose_default();
    (void)dmb_answer_pose(sim, at->place, &pose);
    dmb_vtk_put_tuple(file, pose.displacement, 3);
}

static void put_velocity(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    dmb_motion motion = dmb_motion_default();
    (void)dmb_answer_motion(sim, at->place, &motion);
    dmb_vtk_put_tuple(file, motion.velocity, 3);
}

static void put_diameter(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    const dmb_pipe_run *run = dmb_pipe_run_of(sim->model, at->string, at->place.pipe);
    dmb_vtk_put_tuple(file, &run->def.outer_diameter, 1);
}

/* Rigid pipes have no section loads: 0. */
static dmb_section section_at(const dmb_sim *sim, const dmb_vtk_station *at)
{
    dmb_section section = dmb_section_default();
    (void)dmb_answer_section(sim, at->place, &section);
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

/* Whole elements of the pipe before the station plus the fraction of the next one, as its mesh has them: tool joints
 * belong to the node they are fixed to, rings divide a pipe unequally. A rigid pipe counts as one element. */
static double elements_before(const dmb_sim *sim, const dmb_vtk_station *at, const dmb_pipe_map *pipe)
{
    dmb_material_point point;
    if (pipe->elements == 0) return at->place.fraction;
    (void)dmb_material_point_of(sim, at->place, &point);
    if (point.fixed) return point.node - sim->scene->element_node[pipe->element];
    return point.element - pipe->element + point.fraction;
}

/* Normal force, linear between the contact points at the two ends of an element. */
static void put_normal_force(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const dmb_sim *sim = context;
    const dmb_string_map *map = &sim->scene->strings[at->string];
    const dmb_pipe_map *pipe_map = &sim->scene->pipes[map->first_pipe + at->place.pipe];
    const uint32_t elements = pipe_map->elements > 0 ? pipe_map->elements : 1;
    const double along = elements_before(sim, at, pipe_map);
    const uint32_t passed = along < elements ? (uint32_t)along : elements - 1;
    const dmb_id string = at->place.part;
    const uint32_t pipe = at->place.pipe;
    const double near_force = dmb_site_normal_force(sim, dmb_site_after(sim, string, pipe, passed));
    const double far_force = dmb_site_normal_force(sim, dmb_site_after(sim, string, pipe, passed + 1));
    const double force = near_force + (along - passed) * (far_force - near_force);
    dmb_vtk_put_tuple(file, &force, 1);
}

static int32_t write_strings(const dmb_sim *sim, uint32_t per_element, const char *path)
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

int32_t dmb_write_vtk_strings(const dmb_sim *sim, uint32_t per_element, const char *path)
{
    return dmb_file_failed(sim, "picture of strings", path, write_strings(sim, per_element, path), NULL);
}

/* The hole as a tube of quadrilaterals, for ParaView. */

enum { DMB_AROUND_MIN = 3, DMB_AROUND_MAX = 360, DMB_RINGS_MAX = 1 << 20 };

typedef struct tube {
    const dmb_hole *hole;
    double depth0, depth1;
    uint64_t rings;
    uint32_t around;
    uint32_t reserved;
} tube;

/* The last ring is at depth1 for any spacing. */
static double circle_depth(const tube *t, double spacing, uint64_t ring)
{
    return ring + 1 == t->rings ? t->depth1 : t->depth0 + (double)ring * spacing;
}

/* Transports the direction y to the next ring without rotation about the axis, so that the quads do not twist. If the
 * axis has turned too far, y of the hole's own frame is used. */
static void transfer_direction(const dmb_hole *hole, double depth, const double t[3], double y[3])
{
    double R[9], length;
    dmb_vec3_axpy(-dmb_vec3_dot(y, t), t, y);
    length = dmb_vec3_norm(y);
    if (length > 0.1) {
        dmb_vec3_scale(1.0 / length, y, y);
        return;
    }
    dmb_hole_frame_rotation(hole, depth, R);
    dmb_vec3_set(R[1], R[4], R[7], y);
}

static void put_circle(dmb_text_file *file, const tube *t, double radius, const double x[3], const double y[3],
                       const double z[3])
{
    for (uint32_t k = 0; k < t->around; k++) {
        const double angle = DMB_TWO_PI * k / t->around;
        double point[3];
        dmb_vec3_copy(x, point);
        dmb_vec3_axpy(radius * cos(angle), y, point);
        dmb_vec3_axpy(radius * sin(angle), z, point);
        dmb_vtk_put_tuple(file, point, 3);
    }
}

static void put_points(dmb_text_file *file, const tube *t, double spacing)
{
    double x[3], tangent[3], y[3] = {0.0, 0.0, 0.0}, z[3];
    dmb_vtk_open_tag(file, "Points");
    dmb_vtk_begin_numbers(file, "position", 3);
    for (uint64_t ring = 0; ring < t->rings; ring++) {
        const double depth = circle_depth(t, spacing, ring);
        dmb_hole_frame(t->hole, depth, x, tangent, NULL);
        transfer_direction(t->hole, depth, tangent, y);
        dmb_vec3_cross(tangent, y, z);
        put_circle(file, t, dmb_hole_radius(t->hole, depth), x, y, z);
    }
    dmb_vtk_end_array(file);
    dmb_vtk_close_tag(file, "Points");
}

static void put_depths(dmb_text_file *file, const tube *t, double spacing)
{
    dmb_vtk_open_tag(file, "PointData Scalars=\"depth\"");
    dmb_vtk_begin_numbers(file, "depth", 1);
    for (uint64_t ring = 0; ring < t->rings; ring++) {
        const double depth = circle_depth(t, spacing, ring);
        for (uint32_t k = 0; k < t->around; k++) dmb_vtk_put_tuple(file, &depth, 1);
    }
    dmb_vtk_end_array(file);
    dmb_vtk_close_tag(file, "PointData");
}

/* Facet k between a ring and the next. */
static void put_quad(dmb_text_file *file, uint64_t ring, uint32_t k, uint32_t around)
{
    const uint64_t first = ring * around, second = first + around, next = (k + 1) % around;
    const uint64_t breakpoint[4] = {first + k, first + next, second + next, second + k};
    for (int i = 0; i < 4; i++) {
        dmb_text_put_count(file, breakpoint[i]);
        dmb_text_put(file, i < 3 ? " " : "\n");
    }
}

static void put_polygons(dmb_text_file *file, const tube *t)
{
    const uint64_t quads = (t->rings - 1) * t->around;
    dmb_vtk_open_tag(file, "Polys");
    dmb_vtk_begin_indices(file, "connectivity");
    for (uint64_t ring = 0; ring + 1 < t->rings; ring++) {
        for (uint32_t k = 0; k < t->around; k++) put_quad(file, ring, k, t->around);
    }
    dmb_vtk_end_array(file);
    dmb_vtk_begin_indices(file, "offsets");
    for (uint64_t i = 1; i <= quads; i++) {
        dmb_text_put_count(file, 4 * i);
        dmb_text_put(file, "\n");
    }
    dmb_vtk_end_array(file);
    dmb_vtk_close_tag(file, "Polys");
}

static int32_t check_model(const dmb_model *model)
{
    if (model == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return DMB_ERR_HANDLE;
    if (model->scene == NULL) return DMB_ERR_ORDER;
    return model->scene->has_hole ? DMB_OK : DMB_ERR_UNSUPPORTED;
}

/* Number of rings. A spacing that divides the length but for rounding (1e-12) gives no thin last ring. */
static int32_t tube_of(tube *t, double spacing)
{
    double rings;
    if (!isfinite(t->depth0) || !isfinite(t->depth1) || !isfinite(spacing)) return DMB_ERR_NOT_FINITE;
    if (!(t->depth1 > t->depth0) || !(spacing > 0.0)) return DMB_ERR_VALUE;
    if (t->around < DMB_AROUND_MIN || t->around > DMB_AROUND_MAX) return DMB_ERR_VALUE;
    rings = ceil((t->depth1 - t->depth0) / spacing * (1.0 - 1e-12)) + 1.0;
    if (!(rings <= DMB_RINGS_MAX)) return DMB_ERR_TOO_LARGE;
    t->rings = (uint64_t)fmax(rings, 2.0);
    return DMB_OK;
}

static int32_t write_hole(const dmb_model *model, double depth0, double depth1, double spacing, uint32_t around,
                          const char *path)
{
    int32_t status = check_model(model);
    tube t = {NULL, depth0, depth1, 0, around, 0};
    dmb_vtk_counts counts = {0, 0, 0};
    dmb_text_file file;
    if (status < 0) return status;
    if (path == NULL) return DMB_ERR_NULL;
    status = tube_of(&t, spacing);
    if (status < 0) return status;
    t.hole = &model->scene->hole;
    counts.points = t.rings * around;
    counts.polygons = (t.rings - 1) * around;
    status = dmb_text_open(&file, path);
    if (status < 0) return status;
    dmb_vtk_begin(&file, &counts, (double)NAN);
    put_depths(&file, &t, spacing);
    put_points(&file, &t, spacing);
    put_polygons(&file, &t);
    dmb_vtk_end(&file);
    return dmb_text_close(&file);
}

int32_t dmb_write_vtk_hole(const dmb_model *model, double depth0, double depth1, double spacing, uint32_t around,
                           const char *path)
{
    static const char call[] = "picture of hole";
    dmb_message why;
    const int32_t status = write_hole(model, depth0, depth1, spacing, around, path);
    if (status >= 0) return status;
    dmb_message_clear(&why);
    if (status == DMB_ERR_UNSUPPORTED)
        dmb_message_set(&why, "%s: the model has no wall; add one before it is compiled", call);
    if (status == DMB_ERR_ORDER) dmb_message_set(&why, "%s: the model is not compiled; compile it first", call);
    return dmb_model_fail(model, status, call, dmb_file_message(&why, call, path, status));
}

/* A frame of a mode's animation: the strings displaced by its shape. */

typedef struct frame {
    const dmb_modes *modes;
    double re, im; /* scale times cosine and -sine of the phase */
    uint32_t index;
    uint32_t reserved;
} frame;

/* scale Re((re + i im) e^(i phase)) */
static void displacement_at(const frame *f, const dmb_vtk_station *at, double d[6])
{
    dmb_mode_shape shape = dmb_mode_shape_default();
    (void)dmb_modes_shape(f->modes, f->index, at->place, &shape);
    for (int i = 0; i < 6; i++) d[i] = f->re * shape.re[i] + f->im * shape.im[i];
}

static void put_mode_position(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const frame *f = context;
    dmb_pose pose = dmb_pose_default();
    double d[6];
    (void)dmb_answer_pose(f->modes->state, at->place, &pose);
    displacement_at(f, at, d);
    for (int i = 0; i < 3; i++) d[i] += pose.position[i];
    dmb_vtk_put_tuple(file, d, 3);
}

static void put_mode_displacement(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    double d[6];
    displacement_at(context, at, d);
    dmb_vtk_put_tuple(file, d, 3);
}

static void put_rotation(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    double d[6];
    displacement_at(context, at, d);
    dmb_vtk_put_tuple(file, d + 3, 3);
}

static int32_t write_mode(const dmb_modes *modes, uint32_t index, double scale, double phase, uint32_t per_element,
                          const char *path)
{
    static const dmb_vtk_array arrays[] = {{"displacement", 3, put_mode_displacement}, {"rotation", 3, put_rotation}};
    const frame f = {modes, scale * cos(phase), -scale * sin(phase), index, 0};
    const dmb_vtk_picture picture = {
        &f, "PointData Vectors=\"displacement\"", arrays, 2, {"position", 3, put_mode_position}, per_element, 0};
    if (modes == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(modes, DMB_HANDLE_MODES)) return DMB_ERR_HANDLE;
    if (!dmb_is_finite(scale) || !dmb_is_finite(phase)) return DMB_ERR_NOT_FINITE;
    return index < modes->count ? dmb_vtk_write_lines(modes->state, &picture, path) : DMB_ERR_VALUE;
}

int32_t dmb_write_vtk_mode(const dmb_modes *modes, uint32_t index, double scale, double phase, uint32_t per_element,
                           const char *path)
{
    return dmb_file_failed(NULL, "picture of mode", path, write_mode(modes, index, scale, phase, per_element, path),
                           NULL);
}
