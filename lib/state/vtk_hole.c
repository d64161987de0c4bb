/* The hole as a tube of quadrilaterals, for ParaView. */
#include <math.h>
#include <stddef.h>

#include "base/handle.h"
#include "drillmbd/query.h"
#include "math/so3.h"
#include "model/model.h"
#include "state/vtk_xml.h"

enum { DMB_AROUND_MIN = 3, DMB_AROUND_MAX = 360, DMB_RINGS_MAX = 1 << 20 };

typedef struct tube {
    const dmb_hole *hole;
    double depth0, depth1;
    uint64_t rings;
    uint32_t around;
    uint32_t reserved;
} tube;

/* The last ring ends at depth1 whatever the spacing. */
static double ring_depth(const tube *t, double spacing, uint64_t ring)
{
    return ring + 1 == t->rings ? t->depth1 : t->depth0 + (double)ring * spacing;
}

/* Carries the direction y to the next ring without turning it about the axis, so that the quads do not twist; where the
 * axis turned too far, the hole's own frame. */
static void carry_direction(const dmb_hole *hole, double depth, const double t[3], double y[3])
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

static void put_ring(dmb_text_file *file, const tube *t, const double x[3], const double y[3], const double z[3])
{
    for (uint32_t k = 0; k < t->around; k++) {
        const double angle = 2.0 * DMB_PI * k / t->around;
        double point[3];
        dmb_vec3_copy(x, point);
        dmb_vec3_axpy(t->hole->radius * cos(angle), y, point);
        dmb_vec3_axpy(t->hole->radius * sin(angle), z, point);
        dmb_vtk_put_tuple(file, point, 3);
    }
}

static void put_points(dmb_text_file *file, const tube *t, double spacing)
{
    double x[3], tangent[3], y[3] = {0.0, 0.0, 0.0}, z[3];
    dmb_vtk_open_tag(file, "Points");
    dmb_vtk_begin_numbers(file, "position", 3);
    for (uint64_t ring = 0; ring < t->rings; ring++) {
        const double depth = ring_depth(t, spacing, ring);
        dmb_hole_frame(t->hole, depth, x, tangent, NULL);
        carry_direction(t->hole, depth, tangent, y);
        dmb_vec3_cross(tangent, y, z);
        put_ring(file, t, x, y, z);
    }
    dmb_vtk_end_array(file);
    dmb_vtk_close_tag(file, "Points");
}

static void put_depths(dmb_text_file *file, const tube *t, double spacing)
{
    dmb_vtk_open_tag(file, "PointData Scalars=\"depth\"");
    dmb_vtk_begin_numbers(file, "depth", 1);
    for (uint64_t ring = 0; ring < t->rings; ring++) {
        const double depth = ring_depth(t, spacing, ring);
        for (uint32_t k = 0; k < t->around; k++) dmb_vtk_put_tuple(file, &depth, 1);
    }
    dmb_vtk_end_array(file);
    dmb_vtk_close_tag(file, "PointData");
}

/* Facet k between a ring and the next. */
static void put_quad(dmb_text_file *file, uint64_t ring, uint32_t k, uint32_t around)
{
    const uint64_t first = ring * around, second = first + around, next = (k + 1) % around;
    const uint64_t corner[4] = {first + k, first + next, second + next, second + k};
    for (int i = 0; i < 4; i++) {
        dmb_text_put_count(file, corner[i]);
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

int32_t dmb_write_vtk_hole(const dmb_model *model, double depth0, double depth1, double spacing, uint32_t around,
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
