/* Section forces and strains of a pipe. */
#include "math/se3.h"
#include "query/motion.h"
#include "query/place.h"
#include "sim/access.h"
#include "system/assemble/energy.h"

DMB_DECLARE_STRUCT(dmb_section)

/* From the element's helix to the section itself, which lies off it by exp(c) (query/motion.h): what it carries
 * is the same load in its own axes about its own centre. Under an axial force both tell. */
static void to_the_section(const dmb_scene *scene, const dmb_configuration *configuration,
                           const dmb_material_point *point, double force[6])
{
    dmb_section_shape shape;
    double e[6], c[6], R[9], x[3], moment[3];
    dmb_element_strain(scene, configuration, point->element, e);
    dmb_material_point_shape(scene, point, &shape);
    dmb_section_shape_correct(&shape, e, c);
    dmb_se3_exp(c, NULL, R, x);
    dmb_vec3_cross(x, force, moment);
    dmb_vec3_sub(force + 3, moment, moment);
    dmb_mat3_tvec(R, force, force);
    dmb_mat3_tvec(R, moment, force + 3);
}

/* Between the ends forces go straight, and bending moments by the parabola that belongs to them, dm/dx = -e_x x n;
 * exact under uniform weight. A tool joint hands on the load at its near end, its own mass left out. */
static void section_force(const dmb_scene *scene, const dmb_configuration *configuration,
                          const dmb_material_point *point, double force[6])
{
    const double x = point->fraction,
                 bow = 0.5 * x * (1.0 - x) * scene->types[scene->element_type[point->element]].length;
    double ends[12];
    dmb_element_end_loads(scene, configuration, point->element, ends);
    for (int i = 0; i < 6; i++) force[i] = ends[i] + x * (ends[6 + i] - ends[i]);
    force[4] -= bow * (ends[8] - ends[2]);
    force[5] += bow * (ends[7] - ends[1]);
    to_the_section(scene, configuration, point, force);
    force[4] += point->beyond * force[2];
    force[5] -= point->beyond * force[1];
}

/* Mean strain e/L. Its sideways part is mostly bending of the element, which the corrected stiffness GA* accounts for;
 * shear proper is the share (GA* : GA) of it. */
static void section_strain(const dmb_scene *scene, const dmb_configuration *configuration,
                           const dmb_material_point *point, double strain[6])
{
    const dmb_element_type *type = &scene->types[scene->element_type[point->element]];
    dmb_element_strain(scene, configuration, point->element, strain);
    for (int i = 0; i < 6; i++) strain[i] /= type->length;
    for (int i = 1; i < 3; i++) strain[i] *= type->stiffness[i] * type->length / type->strain_stiffness[i];
}

int32_t dmb_query_section(const dmb_sim *sim, dmb_place place, dmb_section *section)
{
    int32_t status = dmb_ask(sim, section);
    dmb_material_point point;
    dmb_section answer = {0};
    if (status == DMB_OK) status = dmb_material_point_of(sim, place, &point);
    if (status < 0) return status;
    if (point.element == DMB_NONE) return DMB_ERR_UNSUPPORTED;
    section_force(sim->scene, &sim->now, &point, answer.force);
    section_strain(sim->scene, &sim->now, &point, answer.strain);
    return dmb_section_write(section, &answer);
}
