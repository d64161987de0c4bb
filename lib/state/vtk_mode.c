/* A frame of a mode's animation: the strings displaced by its shape. */
#include <math.h>

#include "analysis/modes.h"
#include "base/check.h"
#include "base/handle.h"
#include "state/vtk_lines.h"

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

static void put_position(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
{
    const frame *f = context;
    dmb_pose pose = dmb_pose_default();
    double d[6];
    (void)dmb_query_pose(f->modes->state, at->place, &pose);
    displacement_at(f, at, d);
    for (int i = 0; i < 3; i++) d[i] += pose.position[i];
    dmb_vtk_put_tuple(file, d, 3);
}

static void put_displacement(dmb_text_file *file, const void *context, const dmb_vtk_station *at)
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

int32_t dmb_write_vtk_mode(const dmb_modes *modes, uint32_t index, double scale, double phase, uint32_t per_element,
                           const char *path)
{
    static const dmb_vtk_array arrays[] = {{"displacement", 3, put_displacement}, {"rotation", 3, put_rotation}};
    const frame f = {modes, scale * cos(phase), -scale * sin(phase), index, 0};
    const dmb_vtk_picture picture = {
        &f, "PointData Vectors=\"displacement\"", arrays, 2, {"position", 3, put_position}, per_element, 0};
    if (modes == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(modes, DMB_HANDLE_MODES)) return DMB_ERR_HANDLE;
    if (!dmb_is_finite(scale) || !dmb_is_finite(phase)) return DMB_ERR_NOT_FINITE;
    return index < modes->count ? dmb_vtk_write_lines(modes->state, &picture, path) : DMB_ERR_VALUE;
}
