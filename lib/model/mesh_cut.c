/* Stations at which bits and reamers widen the hole as they drill it (cut_spacing of dmb_wall_def), and the fit of
 * parts in the widened hole. */
#include <math.h>

#include "force/hole.h"
#include "model/field_check.h"
#include "model/mesh.h"
#include "model/model.h"

/* A bit or reamer cuts only with a law of rock that acts in this scene; others must fit through the hole as it is. */
static bool cuts(const dmb_mesh *mesh, const dmb_bit_def *bit)
{
    return mesh->model->wall.cut_spacing > 0.0 && (mesh->features & DMB_FEATURE_ROCK) != 0 &&
           bit->rock_law != DMB_ROCK_NONE;
}

double dmb_mesh_bit_cuts(const dmb_mesh *mesh, uint32_t bit)
{
    const dmb_bit_def *def = DMB_LIST_AT(const dmb_bit_def, mesh->model->bits, bit);
    return cuts(mesh, def) ? 2.0 * def->radius : 0.0;
}

double dmb_mesh_ring_cuts(const dmb_mesh *mesh, uint32_t ring)
{
    double widest = 0.0;
    for (uint32_t i = 0; i < mesh->model->bits.count; i++) {
        const dmb_bit_def *def = DMB_LIST_AT(const dmb_bit_def, mesh->model->bits, i);
        if (dmb_id_is_none(def->stabiliser) ||
            dmb_model_part_index(mesh->model, def->stabiliser, DMB_PART_STABILISER) != ring)
            continue;
        widest = fmax(widest, dmb_mesh_bit_cuts(mesh, i));
    }
    return widest;
}

/* Two parabolas over a spacing have slopes up to 2 widening/spacing. */
static int32_t check_slope(const dmb_mesh *mesh, uint32_t bit, double least)
{
    const dmb_wall_def *wall = &mesh->model->wall;
    const double need = (dmb_mesh_bit_cuts(mesh, bit) - 2.0 * least) / DMB_HOLE_SLOPE_MAX;
    dmb_message part;
    if (wall->cut_spacing >= need) return DMB_OK;
    dmb_message_set(&mesh->model->message,
                    "wall: cut_spacing = %g m, must be >= %g m, as %s widens the hole from %g to %g m of diameter, by "
                    "no more than 1 m/m of its radius; give a larger spacing",
                    wall->cut_spacing, need, dmb_model_part_text(mesh->model, DMB_PART_BIT, bit, &part), 2.0 * least,
                    dmb_mesh_bit_cuts(mesh, bit));
    return DMB_ERR_GEOMETRY;
}

/* Stations from cut_start to cut_end at the spacing, one more than spacings; none if nothing cuts. */
int32_t dmb_mesh_cuts(dmb_mesh *mesh)
{
    const dmb_wall_def *wall = &mesh->model->wall;
    bool any = false;
    double where;
    if (!mesh->has_hole || !(wall->cut_spacing > 0.0)) return DMB_OK;
    const double least = dmb_hole_least_radius(&mesh->hole, wall->cut_start, wall->cut_end, &where);
    for (uint32_t i = 0; i < mesh->model->bits.count; i++) {
        const int32_t status = check_slope(mesh, i, least);
        if (status < 0) return status;
        any = any || dmb_mesh_bit_cuts(mesh, i) > 0.0;
    }
    if (!any) return DMB_OK;
    mesh->hole.cuts = (uint32_t)ceil((wall->cut_end - wall->cut_start) / wall->cut_spacing * (1.0 - 1e-12)) + 1;
    mesh->hole.cut_start = wall->cut_start;
    mesh->hole.cut_spacing = wall->cut_spacing;
    return DMB_OK;
}
