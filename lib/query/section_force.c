/* Section forces and strains of a pipe, pressures of the mud at it, and its loads over limits. */
#include "query/query.h"

#include <math.h>

#include "base/sized_struct.h"
#include "force/hole.h"
#include "math/vec3.h"
#include "model/section.h"
#include "sim/access.h"
#include "sim/node.h"
#include "system/assemble/energy.h"

DMB_DECLARE_STRUCT(dmb_section)

void dmb_section_force_at(const dmb_sim *sim, dmb_place place, const dmb_material_point *point, dmb_kept_loads *kept,
                          double force[6])
{
    dmb_described_pipe pipe;
    dmb_describe_pipe(sim, dmb_model_part_index(sim->model, place.part, DMB_PART_STRING), place.pipe, &pipe);
    dmb_section_load_of(sim, &pipe, point, kept, force);
    if (point->beyond > 0.0) dmb_section_load_in_joint(sim, &pipe, point, force);
}

/* Mean strain e/L. Its lateral part is mostly bending of the element, which the corrected stiffness GA* includes; the
 * actual shear is the fraction (GA* : GA) of it. */
static void section_strain(const dmb_scene *scene, const dmb_configuration *configuration,
                           const dmb_material_point *point, double strain[6])
{
    const dmb_element_type *type = &scene->types[scene->element_type[point->element]];
    dmb_element_strain(scene, configuration, point->element, strain);
    for (int i = 0; i < 6; i++) strain[i] /= type->length;
    for (int i = 1; i < 3; i++) strain[i] *= type->stiffness[i] * type->length / type->strain_stiffness[i];
}

int32_t dmb_answer_section(const dmb_sim *sim, dmb_place place, dmb_section *section)
{
    int32_t status = dmb_ask(sim, section);
    dmb_material_point point;
    dmb_section answer = {0};
    dmb_kept_loads kept;
    if (status == DMB_OK) status = dmb_material_point_of(sim, place, &point);
    if (status < 0) return status;
    if (point.element == DMB_NONE) return DMB_ERR_UNSUPPORTED;
    dmb_kept_loads_begin(1, &kept);
    dmb_section_force_at(sim, place, &point, &kept, answer.force);
    section_strain(sim->scene, &sim->now, &point, answer.strain);
    return dmb_section_write(section, &answer);
}

/* ---- Pressures of the mud ---------------------------------------------------------------------------------------- */

DMB_DEFINE_INIT(dmb_flow_state, 96, {.rate = 0.0})

/* ---- At rest ----------------------------------------------------------------------------------------------------- */

/* [Pa] Hydrostatic pressure of a mud column from the start of the hole, or from the rig end without a hole; 0 above
 * it. */
static double at_rest(const dmb_scene *scene, uint32_t string, double density, const double x[3])
{
    double top[3], below[3];
    if (scene->has_hole)
        dmb_hole_frame(&scene->hole, dmb_hole_is_straight(&scene->hole) ? 0.0 : scene->hole.station[0].depth, top, NULL,
                       NULL);
    else
        dmb_vec3_copy(scene->reference_position + 3 * (size_t)scene->strings[string].start_node, top);
    dmb_vec3_sub(x, top, below);
    return fmax(0.0, density * dmb_vec3_dot(scene->gravity, below));
}

/* ---- Flow -------------------------------------------------------------------------------------------------------- */

/* Position of the end of the string on its node's axis, world frame. */
static void end_position(const dmb_sim *sim, uint32_t node, double arm, double x[3])
{
    double R[9], u[3];
    dmb_node_pose(sim->scene, &sim->now, node, R, u);
    dmb_vec3_add(sim->scene->reference_position + 3 * (size_t)node, u, x);
    for (int k = 0; k < 3; k++) x[k] += arm * R[3 * k];
}

/* [Pa] pressure loss between the rig end and a distance: in the bore, in the annulus. */
static void losses_to(const dmb_scene *scene, double distance, double loss[2])
{
    uint32_t low = 0, high = scene->flow_count - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low + 1) / 2;
        if (scene->flow_pieces[middle].from <= distance)
            low = middle;
        else
            high = middle - 1;
    }
    const dmb_flow_piece *piece = scene->flow_pieces + low;
    const double along = fmin(distance - piece->from, piece->length);
    loss[0] = piece->before[0] + along * piece->bore.gradient;
    loss[1] = piece->before[1] + along * piece->annulus.gradient;
}

/* [Pa] pressure loss of the motors between the far end of the string and the nozzles, at their present speeds; none
 * without flow. */
static double motor_loss(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    double sum = 0.0;
    for (uint32_t i = 0; i < scene->drive_count && scene->flow.rate > 0.0; i++) {
        const dmb_scene_drive *drive = scene->drives + i;
        if (drive->mud_pressure > 0.0) sum += drive->mud_pressure * sim->now.drives[i].force;
    }
    return sum;
}

/* The annulus loses pressure upwards, from the bottom to the surface (eq:mud.balance): the outside pressure is that of
 * the column plus the losses above the section. The inside one is found from the bottom: outside pressure there,
 * nozzles, motors, losses of the bore below, less the weight of the mud between. */
static dmb_mud_pressure in_flow(const dmb_sim *sim, double distance, const double x[3])
{
    const dmb_scene *scene = sim->scene;
    const dmb_string_map *string = scene->strings;
    double here[2], end[2], bottom[3], below[3];
    losses_to(scene, distance, here);
    losses_to(scene, string->length, end);
    end_position(sim, string->end_node, string->end_arm, bottom);
    dmb_vec3_sub(bottom, x, below);
    const dmb_mud_pressure p = {.outside = at_rest(scene, 0, scene->flow.outside, x) + here[1],
                                .inside = at_rest(scene, 0, scene->flow.outside, bottom) + end[1] +
                                          dmb_nozzle_loss(&scene->flow) + motor_loss(sim) + end[0] - here[0] -
                                          scene->flow.inside * dmb_vec3_dot(scene->gravity, below)};
    return p;
}

dmb_mud_pressure dmb_mud_pressure_at(const dmb_sim *sim, uint32_t string, double distance, const double x[3])
{
    const dmb_scene *scene = sim->scene;
    const dmb_mud mud = dmb_mud_of(scene);
    if (scene->flow_count > 0) return in_flow(sim, distance, x);
    dmb_mud_pressure p = {.outside = at_rest(scene, string, mud.outside, x)};
    p.inside = mud.inside < 0.0 ? p.outside : at_rest(scene, string, mud.inside, x);
    return p;
}

/* ---- The call ---------------------------------------------------------------------------------------------------- */

/* eq:mud.stretch: [m] (1 - 2 nu)(p_i A_i - p_o A_o)/(E A) L from Lame's stresses, and rho Q V/(E A) L, at the near end
 * of the piece. Both are linear between its ends, apart from the curvature of the string. */
static double stretch_of(const dmb_sim *sim, const dmb_flow_piece *piece)
{
    const dmb_scene *scene = sim->scene;
    const double Ao = dmb_ring_area(piece->diameter[0], 0.0), Ai = dmb_ring_area(piece->diameter[1], 0.0);
    double x[3], sum = 0.0;
    if (piece->element == DMB_NONE || !(piece->steel > 0.0)) return 0.0;
    for (uint32_t end = 0; end < 2; end++) {
        const double at = piece->from + (end ? piece->length : 0.0);
        end_position(sim, scene->element_node[piece->element] + end, 0.0, x);
        const dmb_mud_pressure p = in_flow(sim, at, x);
        sum += 0.5 * (1.0 - 2.0 * piece->poisson) * (p.inside * Ai - p.outside * Ao);
    }
    sum += scene->flow.inside * scene->flow.rate * scene->flow.rate / Ai;
    return sum * piece->length / piece->steel;
}

/* [m] stretch of an element in mud at rest, whose pressures are linear between its ends: (1 - 2 nu)(p_i A_i - p_o
 * A_o)/(E A) L, as above. */
static double stretch_at_rest(const dmb_sim *sim, uint32_t string, const dmb_pipe_def *def, uint32_t element)
{
    const dmb_scene *scene = sim->scene;
    double diameters[2], x[3], sum = 0.0;
    dmb_pipe_section section;
    dmb_pipe_diameters(def, 0, diameters);
    dmb_section_of(def, &section);
    if (!(section.stiffness[0] > 0.0)) return 0.0;
    for (uint32_t end = 0; end < 2; end++) {
        end_position(sim, scene->element_node[element] + end, 0.0, x);
        const dmb_mud_pressure p = dmb_mud_pressure_at(sim, string, 0.0, x);
        sum += 0.5 * (p.inside * dmb_ring_area(diameters[1], 0.0) - p.outside * dmb_ring_area(diameters[0], 0.0));
    }
    return (1.0 - 2.0 * def->poisson_ratio) * sum * scene->types[scene->element_type[element]].length /
           section.stiffness[0];
}

/* [m] stretch of all strings in mud at rest, by the calls that described their pipes. */
static double resting_stretch(const dmb_sim *sim)
{
    const dmb_scene *scene = sim->scene;
    double sum = 0.0;
    const dmb_pipe_run *runs = sim->model->runs.items;
    for (uint32_t r = 0; r < sim->model->runs.count; r++) {
        const dmb_pipe_run *run = runs + r;
        const dmb_pipe_map *pipe = scene->pipes + scene->strings[run->string].first_pipe + run->first;
        for (uint32_t i = 0; i < run->count; i++, pipe++)
            for (uint32_t e = 0; e < pipe->elements; e++)
                sum += stretch_at_rest(sim, run->string, &run->def, pipe->element + e);
    }
    return sum;
}

static void sum_chunks(const dmb_sim *sim, dmb_flow_state *answer)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->flow_count; i++) {
        const dmb_flow_piece *piece = scene->flow_pieces + i;
        answer->bore_loss += piece->bore.gradient * piece->length;
        answer->annulus_loss += piece->annulus.gradient * piece->length;
        answer->drag += piece->annulus.pull * piece->length;
        answer->bore_reynolds = fmax(answer->bore_reynolds, piece->bore.reynolds);
        answer->annulus_reynolds = fmax(answer->annulus_reynolds, piece->annulus.reynolds);
        answer->pressure_stretch += stretch_of(sim, piece);
    }
}

int32_t dmb_answer_flow(const dmb_sim *sim, dmb_flow_state *flow)
{
    const int32_t status = dmb_ask(sim, flow);
    dmb_flow_state answer = {0};
    double top[3], bottom[3], along[3];
    if (status < 0) return status;
    const dmb_scene *scene = sim->scene;
    if (scene->flow_count == 0) {
        answer.pressure_stretch = resting_stretch(sim);
        return dmb_flow_state_write(flow, &answer);
    }
    end_position(sim, scene->strings[0].start_node, scene->strings[0].start_arm, top);
    end_position(sim, scene->strings[0].end_node, scene->strings[0].end_arm, bottom);
    dmb_vec3_sub(bottom, top, along);
    sum_chunks(sim, &answer);
    answer.rate = scene->flow.rate;
    answer.bit_loss = dmb_nozzle_loss(&scene->flow);
    answer.thrust = dmb_nozzle_thrust(&scene->flow);
    answer.column = (scene->flow.outside - scene->flow.inside) * dmb_vec3_dot(scene->gravity, along);
    answer.motor_loss = motor_loss(sim);
    answer.pump_pressure = answer.bore_loss + answer.motor_loss + answer.bit_loss + answer.annulus_loss + answer.column;
    return dmb_flow_state_write(flow, &answer);
}

/* ---- Loads over limits ------------------------------------------------------------------------------------------- */

double dmb_tube_von_mises(double outer_diameter, double inner_diameter, double axial_force, double torque,
                          double bending_moment)
{
    const double A = dmb_ring_area(outer_diameter, inner_diameter);
    const double I = dmb_ring_second_moment(outer_diameter, inner_diameter);
    const double r = 0.5 * outer_diameter;
    const double normal = fabs(axial_force) / A + fabs(bending_moment) * r / I;
    const double shear = torque * r / (2.0 * I);
    return sqrt(normal * normal + 3.0 * shear * shear);
}

/* eq:drilling.von-mises */
double dmb_tube_pressed_von_mises(const double diameters[2], double axial_force, double torque, double bending_moment,
                                  double pressure)
{
    const double A = dmb_ring_area(diameters[0], diameters[1]);
    const double I = dmb_ring_second_moment(diameters[0], diameters[1]);
    double largest = 0.0;
    for (int surface = 0; surface < 2; surface++) {
        const double r = 0.5 * diameters[surface];
        const double normal = fabs(axial_force) / A + fabs(bending_moment) * r / I, shear = torque * r / (2.0 * I);
        const double hoop = pressure * dmb_ring_area(diameters[1 - surface], 0.0) / A;
        largest = fmax(largest, sqrt(normal * normal + 3.0 * (hoop * hoop + shear * shear)));
    }
    return largest;
}

double dmb_confined_wall_force(const dmb_confined_pipe *pipe, double axial_force, double *by_force)
{
    double across[3], force;
    dmb_vec3_copy(pipe->weight, across);
    dmb_vec3_axpy(-dmb_vec3_dot(pipe->weight, pipe->tangent), pipe->tangent, across);
    dmb_vec3_axpy(axial_force, pipe->bend, across);
    force = dmb_vec3_norm(across);
    if (by_force != NULL)
        *by_force = force > 0.0 ? dmb_vec3_dot(across, pipe->bend) / force : dmb_vec3_norm(pipe->bend);
    return force;
}

/* Compression over the buckling load [-]; NaN if nothing presses the pipe to the wall: `on_wall` of EI w_c/r under the
 * root, `upright` times the length scale of a heavy vertical column (eq:drilling.sinusoidal, eq:drilling.helical,
 * eq:drilling.vertical). */
static double share(const dmb_confined_pipe *pipe, double axial_force, double on_wall, double upright)
{
    const double along = dmb_vec3_dot(pipe->weight, pipe->tangent);
    const double held = sqrt(on_wall * pipe->EI * dmb_confined_wall_force(pipe, axial_force, NULL) / pipe->clearance);
    const double limit = fmax(held, upright * cbrt(pipe->EI * along * along));
    if (!(axial_force < 0.0)) return 0.0;
    return limit > 0.0 ? -axial_force / limit : (double)NAN;
}

double dmb_sinusoidal_ratio(const dmb_confined_pipe *pipe, double axial_force)
{
    return share(pipe, axial_force, 4.0, 2.55);
}

double dmb_helical_ratio(const dmb_confined_pipe *pipe, double axial_force)
{
    return share(pipe, axial_force, 8.0, 5.55);
}
