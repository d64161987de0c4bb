
/* Rigid masses, weights, displaced volumes, damped lengths and added mass of mud on the nodes. Each part adds to sums
 * of its node, about the node's origin in its axes:
 *
 *     elastic pipe    weight and damping; its mass is consistent in the element; eccentric mass at both ends
 *     tool joint      mass, weight and damping, at the far node
 *     rigid pipe      mass, weight, damping and mud, at the node of its stretch
 *     ring, body      mass, weight and mud at its arm
 *     drive           inertia of its rotor about the x axis
 *
 * Weights contain buoyancy. Where an input changes the mud's density, they are computed again from the volumes. */
#include <math.h>

#include "math/elementary.h"
#include "model/field_check.h"
#include "model/mesh.h"
#include "model/section.h"

/* J_node = J_centre + m (|c|^2 I - c c^T), parallel axes */
void dmb_rigid_mass_add(dmb_rigid_mass *rigid_mass, double mass, const double c[3], const double inertia[6])
{
    rigid_mass->mass += mass;
    for (int i = 0; i < 3; ++i) rigid_mass->moment[i] += mass * c[i];
    rigid_mass->inertia[0] += inertia[0] + mass * (c[1] * c[1] + c[2] * c[2]);
    rigid_mass->inertia[1] += inertia[1] + mass * (c[0] * c[0] + c[2] * c[2]);
    rigid_mass->inertia[2] += inertia[2] + mass * (c[0] * c[0] + c[1] * c[1]);
    rigid_mass->inertia[3] += inertia[3] - mass * c[0] * c[1];
    rigid_mass->inertia[4] += inertia[4] - mass * c[0] * c[2];
    rigid_mass->inertia[5] += inertia[5] - mass * c[1] * c[2];
}

/* The difference of m (|c|^2 I - c c^T) between c = (x, e_y, e_z) and (x, 0, 0): -m e~ e~ and the product with x */
void dmb_rigid_mass_shift(dmb_rigid_mass *rigid_mass, double mass, double x, const double e[2])
{
    rigid_mass->moment[1] += mass * e[0];
    rigid_mass->moment[2] += mass * e[1];
    rigid_mass->inertia[0] += mass * (e[0] * e[0] + e[1] * e[1]);
    rigid_mass->inertia[1] += mass * e[1] * e[1];
    rigid_mass->inertia[2] += mass * e[0] * e[0];
    rigid_mass->inertia[3] -= mass * x * e[0];
    rigid_mass->inertia[4] -= mass * x * e[1];
    rigid_mass->inertia[5] -= mass * e[0] * e[1];
}

bool dmb_pipe_is_eccentric(const dmb_pipe_def *def)
{
    return def->eccentricity > 0.0 || def->eccentricity_spread > 0.0;
}

/* SplitMix64 (Steele, Lea, Flood 2014): a counter through a mixing function, so that draw k does not depend on other
 * draws. */
static uint64_t mix(uint64_t z)
{
    z += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

/* Uniform in -1 .. 1, the 53 upper bits of a draw. */
static double draw(uint32_t seed, uint32_t pipe, uint32_t which)
{
    const uint64_t bits = mix(mix((uint64_t)seed << 32 | pipe) + which);
    return (double)(bits >> 11) * 0x1p-52 - 1.0;
}

void dmb_pipe_offset(const dmb_pipe_def *def, uint32_t pipe, double e[2])
{
    const double distance = fmax(0.0, def->eccentricity + def->eccentricity_spread * draw(def->seed, pipe, 0));
    const double angle = def->eccentricity_angle + def->angle_spread * draw(def->seed, pipe, 1);
    double sine, cosine;
    dmb_sin_cos(angle, &sine, &cosine);
    e[0] = distance * cosine;
    e[1] = distance * sine;
}

/* ---- Sums on a node ---------------------------------------------------------------------------------------------- */

/* The rigid mass of a node, created if needed; NULL without memory. */
static dmb_rigid_mass *rigid_mass_of(dmb_mesh *mesh, uint32_t node)
{
    dmb_mesh_node *n = dmb_mesh_node_at(mesh, node);
    if (n->rigid_mass == DMB_NONE) {
        const dmb_rigid_mass rigid_mass = {.node = node};
        if (dmb_vector_append(&mesh->rigid_masses, &mesh->model->allocator, &rigid_mass, 1) < 0) return NULL;
        n->rigid_mass = (uint32_t)mesh->rigid_masses.count - 1;
    }
    return DMB_VECTOR_AT(dmb_rigid_mass, &mesh->rigid_masses, n->rigid_mass);
}

/* The added mass of mud at a node, created if needed; NULL without memory. */
static dmb_added_mass *added_mass_of(dmb_mesh *mesh, uint32_t node)
{
    dmb_mesh_node *n = dmb_mesh_node_at(mesh, node);
    if (n->added_mass == DMB_NONE) {
        const dmb_added_mass added = {.node = node};
        if (dmb_vector_append(&mesh->added_masses, &mesh->model->allocator, &added, 1) < 0) return NULL;
        n->added_mass = (uint32_t)mesh->added_masses.count - 1;
    }
    return DMB_VECTOR_AT(dmb_added_mass, &mesh->added_masses, n->added_mass);
}

/* Adds added mass; none for parts without displaced mud. */
static int32_t add_mud(dmb_mesh *mesh, uint32_t node, const dmb_added_mass *part)
{
    if (!(part->along > 0.0) && !(part->across[0] > 0.0)) return DMB_OK;
    dmb_added_mass *sum = added_mass_of(mesh, node);
    if (sum == NULL) return DMB_ERR_NO_MEMORY;
    sum->along += part->along;
    dmb_vec3_add(sum->across, part->across, sum->across);
    return DMB_OK;
}

static bool mud_has_inertia(const dmb_mesh *mesh)
{
    const double added = mesh->model->environment.added_mass;
    return added > 0.0 || added < 0.0;
}

/* Gravity on a mass at a place of the node's frame. */
static void add_weight(dmb_mesh_node *node, double mass, const double centre[3])
{
    node->weight_mass += mass;
    for (int i = 0; i < 3; ++i) node->weight_moment[i] += mass * centre[i];
}

/* Adds a displaced volume [m3], for buoyancy. */
static void add_displaced(dmb_mesh_node *node, double volume, double x)
{
    node->displaced[0] += volume;
    node->displaced[1] += volume * x;
}

/* Adds a rigid body with its centre there; `buoyancy`: fraction of its weight after buoyancy. */
static int32_t add_body(dmb_mesh *mesh, uint32_t node, double mass, const double centre[3], const double inertia[6],
                        double buoyancy)
{
    dmb_rigid_mass *rigid_mass = rigid_mass_of(mesh, node);
    if (rigid_mass == NULL) return DMB_ERR_NO_MEMORY;
    dmb_rigid_mass_add(rigid_mass, mass, centre, inertia);
    add_weight(dmb_mesh_node_at(mesh, node), buoyancy * mass, centre);
    dmb_mesh_node_at(mesh, node)->rigid = 1;
    mesh->mass += mass;
    return DMB_OK;
}

/* A solid of revolution on the x axis, its centre at x; displaced volume [m3]. */
static int32_t add_part(dmb_mesh *mesh, uint32_t node, const dmb_rigid_part *part, double x, double buoyancy,
                        double volume)
{
    const double centre[3] = {x, 0.0, 0.0};
    const double inertia[6] = {part->inertia[0], part->inertia[1], part->inertia[1], 0.0, 0.0, 0.0};
    add_displaced(dmb_mesh_node_at(mesh, node), volume, x);
    return add_body(mesh, node, part->mass, centre, inertia, buoyancy);
}

/* Offset of a mass already added on the axis. Buoyancy acts on the axis, so all of the added first moment has weight.
 */
static int32_t add_offset(dmb_mesh *mesh, uint32_t node, double mass, double x, const double e[2])
{
    dmb_mesh_node *n = dmb_mesh_node_at(mesh, node);
    dmb_rigid_mass *rigid_mass = rigid_mass_of(mesh, node);
    if (rigid_mass == NULL) return DMB_ERR_NO_MEMORY;
    dmb_rigid_mass_shift(rigid_mass, mass, x, e);
    n->weight_moment[1] += mass * e[0];
    n->weight_moment[2] += mass * e[1];
    return DMB_OK;
}

/* ---- Pipes ------------------------------------------------------------------------------------------------------- */

/* Common properties of the pipes of a run. */
typedef struct run_mass {
    const dmb_pipe_def *def;
    dmb_pipe_section section;
    dmb_rigid_part joint, pipe;
    double buoyancy, joint_buoyancy;
    double inside, joint_inside; /* [m2] of mud of a density of its own inside the body and the tool joint, else 0 */
} run_mass;

static void run_mass_of(const dmb_mesh *mesh, const dmb_pipe_run *run, run_mass *out)
{
    out->def = &run->def;
    dmb_section_of(&run->def, &out->section);
    dmb_joint_of(&run->def, &out->joint);
    dmb_rigid_pipe_of(&run->def, &out->pipe);
    const dmb_mud mud = {mesh->model->environment.fluid_density, mesh->model->environment.inner_density};
    const bool apart = !(mud.inside < 0.0);
    out->buoyancy = dmb_buoyancy_factor(&run->def, 0, &mud);
    out->joint_buoyancy = out->joint.mass > 0.0 ? dmb_buoyancy_factor(&run->def, 1, &mud) : 1.0;
    out->inside = apart ? dmb_inner_area(&run->def, 0) : 0.0;
    out->joint_inside = apart ? dmb_inner_area(&run->def, 1) : 0.0;
}

/* Uniform load w on the cubic shape: w L/2 and the moments +- w L^2/12 at the ends, m/2 at x +- L/12. */
static void weigh_element(dmb_mesh *mesh, const dmb_mesh_element *element, const run_mass *mass)
{
    const double length = element->length;
    const double half = 0.5 * mass->buoyancy * mass->section.mass * length;
    const double a[3] = {element->arm[0] + length / 6.0, 0.0, 0.0}; /* half times L/6 is m L/12 */
    const double b[3] = {-element->arm[1] - length / 6.0, 0.0, 0.0};
    add_weight(dmb_mesh_node_at(mesh, element->node), half, a);
    add_weight(dmb_mesh_node_at(mesh, element->node + 1), half, b);
    const double volume = 0.5 * (mass->section.mass * length) / mass->def->density + 0.5 * mass->inside * length;
    add_displaced(dmb_mesh_node_at(mesh, element->node), volume, a[0]);
    add_displaced(dmb_mesh_node_at(mesh, element->node + 1), volume, b[0]);
    mesh->mass += mass->section.mass * length;
}

/* Adds the damping of a length of pipe around x = `at` on the node's axis; `spread` is its integral of (x - at)^2. */
static void damp_node(dmb_mesh *mesh, uint32_t node, double length, double at, double spread)
{
    double *damped = dmb_mesh_node_at(mesh, node)->damped;
    damped[0] += length;
    damped[1] += length * at;
    damped[2] += length * at * at + spread;
}

static void damp_element(dmb_mesh *mesh, const dmb_mesh_element *element, double length)
{
    damp_node(mesh, element->node, 0.5 * length, element->arm[0], 0.0);
    damp_node(mesh, element->node + 1, 0.5 * length, -element->arm[1], 0.0);
}

static int32_t shift_element(dmb_mesh *mesh, const dmb_mesh_element *element, const run_mass *mass, const double e[2])
{
    const double half = 0.5 * mass->section.mass * element->length;
    int32_t status = add_offset(mesh, element->node, half, element->arm[0], e);
    if (status >= 0) status = add_offset(mesh, element->node + 1, half, -element->arm[1], e);
    return status;
}

static double joint_volume(const run_mass *mass, double length)
{
    return mass->joint.mass / mass->def->density + mass->joint_inside * length;
}

/* Mass of an elastic pipe. The tool joint ends at the end of the pipe, and its far node may be further away, behind
 * rigid pipes. */
static int32_t add_elastic_pipe(dmb_mesh *mesh, const dmb_pipe_map *pipe, const run_mass *mass, const double *e)
{
    const dmb_mesh_element *element = dmb_mesh_element_at(mesh, pipe->element), *last = element + pipe->elements - 1;
    const double joint_at = 0.5 * pipe->joint - last->arm[1];
    int32_t status = DMB_OK;
    for (; element <= last && status >= 0; ++element) {
        weigh_element(mesh, element, mass);
        damp_element(mesh, element, element->length);
        if (e != NULL) status = shift_element(mesh, element, mass, e);
    }
    if (status < 0 || !(pipe->joint > 0.0)) return status;
    damp_node(mesh, last->node + 1, pipe->joint, joint_at, pipe->joint * pipe->joint * pipe->joint / 12.0);
    status =
        add_part(mesh, last->node + 1, &mass->joint, joint_at, mass->joint_buoyancy, joint_volume(mass, pipe->joint));
    if (status >= 0 && e != NULL) status = add_offset(mesh, last->node + 1, mass->joint.mass, joint_at, e);
    return status;
}

static int32_t add_rigid_mud(dmb_mesh *mesh, uint32_t node, const dmb_pipe_def *def, double x)
{
    const dmb_environment_def *e = &mesh->model->environment;
    dmb_added_mass part = {.along = 0.0};
    if (!mud_has_inertia(mesh)) return DMB_OK;
    const int32_t status = dmb_mesh_check_mud(mesh, def);
    if (status < 0) return status;
    dmb_rigid_pipe_mud(def, e, mesh->model->wall.diameter, x, &part);
    return add_mud(mesh, node, &part);
}

static int32_t add_rigid_pipe(dmb_mesh *mesh, const dmb_pipe_map *pipe, const run_mass *mass, const double *e)
{
    const double body = dmb_pipe_body_length(mass->def);
    const double pipe_at = pipe->start + 0.5 * body, joint_at = pipe->start + body + 0.5 * pipe->joint;
    const double volume = mass->pipe.mass / mass->def->density + mass->inside * body;
    int32_t status = add_rigid_mud(mesh, pipe->node, mass->def, pipe_at);
    if (status >= 0) status = add_part(mesh, pipe->node, &mass->pipe, pipe_at, mass->buoyancy, volume);
    if (status >= 0 && pipe->joint > 0.0)
        status =
            add_part(mesh, pipe->node, &mass->joint, joint_at, mass->joint_buoyancy, joint_volume(mass, pipe->joint));
    if (status >= 0 && e != NULL) status = add_offset(mesh, pipe->node, mass->pipe.mass, pipe_at, e);
    if (status >= 0 && e != NULL) status = add_offset(mesh, pipe->node, mass->joint.mass, joint_at, e);
    damp_node(mesh, pipe->node, pipe->length, pipe->start + 0.5 * pipe->length,
              pipe->length * pipe->length * pipe->length / 12.0);
    return status;
}

/* ---- Rings ------------------------------------------------------------------------------------------------------- */

static int32_t add_ring_mud(dmb_mesh *mesh, uint32_t ring, const dmb_body_map *map, double pipe_diameter)
{
    const dmb_environment_def *e = &mesh->model->environment;
    const dmb_stabiliser_def *def = DMB_LIST_AT(const dmb_stabiliser_def, mesh->model->rings, ring);
    const double hole = mesh->model->wall.diameter;
    dmb_added_mass part = {.along = 0.0};
    dmb_message text;
    if (def->added_mass[1] < 0.0 && e->added_mass < 0.0 && !(hole > def->outer_diameter)) {
        dmb_message_set(&mesh->model->message,
                        "%s: outer_diameter = %g m, must be < %g m, the wall's diameter, with added_mass = -1 of the "
                        "environment; give the stabiliser an added_mass across",
                        dmb_model_part_text(mesh->model, DMB_PART_STABILISER, ring, &text), def->outer_diameter, hole);
        return DMB_ERR_GEOMETRY;
    }
    dmb_ring_mud(def, pipe_diameter, e, hole, map->arm, &part);
    return add_mud(mesh, map->node, &part);
}

/* A ring surrounds the pipe that passes through it: its own volume and mass are those outside the pipe's diameter. */
static int32_t add_rings_of(dmb_mesh *mesh, const dmb_pipe_def *pipe, uint32_t string, uint32_t number)
{
    const dmb_ring_range rings = dmb_mesh_rings_of(mesh, string, number);
    const uint32_t first = mesh->model->bodies.count + mesh->model->bits.count;
    for (uint32_t i = 0; i < rings.count; ++i) {
        const uint32_t ring = rings.first[i].ring;
        const dmb_stabiliser_def *def = DMB_LIST_AT(const dmb_stabiliser_def, mesh->model->rings, ring);
        const dmb_body_map *map = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, first + ring);
        const double buoyancy = 1.0 - mesh->model->environment.fluid_density / def->density;
        dmb_rigid_part part;
        double diameters[2];
        dmb_pipe_diameters(pipe, rings.first[i].along > dmb_pipe_body_length(pipe), diameters);
        dmb_ring_body_of(def, diameters[0], &part);
        int32_t status = add_part(mesh, map->node, &part, map->arm, buoyancy, part.mass / def->density);
        if (status >= 0) status = add_ring_mud(mesh, ring, map, diameters[0]);
        if (status < 0) return status;
    }
    return DMB_OK;
}

/* ---- Strings ----------------------------------------------------------------------------------------------------- */

static int32_t add_string(dmb_mesh *mesh, uint32_t string)
{
    const bool eccentric = (mesh->features & DMB_FEATURE_ECCENTRICITY) != 0;
    dmb_pipe_iterator iterator = dmb_pipe_iterator_of(mesh, string);
    run_mass mass = {0};
    int32_t status = DMB_OK;
    while (status >= 0 && dmb_pipe_iterator_next(&iterator)) {
        const dmb_pipe_map *pipe =
            dmb_mesh_pipe_at(mesh, dmb_mesh_string_at(mesh, string)->first_pipe + iterator.number);
        double offset[2], *e = NULL;
        if (mass.def != &iterator.run->def) run_mass_of(mesh, iterator.run, &mass);
        if (eccentric && dmb_pipe_is_eccentric(&iterator.run->def)) {
            dmb_pipe_offset(&iterator.run->def, iterator.number, offset);
            e = offset;
        }
        status = pipe->elements > 0 ? add_elastic_pipe(mesh, pipe, &mass, e) : add_rigid_pipe(mesh, pipe, &mass, e);
        if (status >= 0 && mesh->ring_order.count > 0) status = add_rings_of(mesh, mass.def, string, iterator.number);
    }
    return status;
}

/* ---- Bodies and bits --------------------------------------------------------------------------------------------- */

/* [-] Fraction of a body's weight after buoyancy; below 0 it rises. */
static double lifted(const dmb_mesh *mesh, double volume, double mass)
{
    return volume > 0.0 ? 1.0 - mesh->model->environment.fluid_density * volume / mass : 1.0;
}

static int32_t add_described_body(dmb_mesh *mesh, uint32_t i)
{
    const dmb_body_def *def = DMB_LIST_AT(const dmb_body_def, mesh->model->bodies, i);
    const dmb_body_map *map = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, i);
    const double centre[3] = {map->arm + def->centre[0], def->centre[1], def->centre[2]};
    dmb_added_mass mud = {.along = 0.0};
    dmb_given_mud(def->added_mass, centre[0], &mud);
    const int32_t status = add_mud(mesh, map->node, &mud);
    if (status < 0) return status;
    add_displaced(dmb_mesh_node_at(mesh, map->node), def->displaced_volume, centre[0]);
    return add_body(mesh, map->node, def->mass, centre, def->inertia, lifted(mesh, def->displaced_volume, def->mass));
}

static int32_t add_bit(dmb_mesh *mesh, uint32_t i)
{
    const dmb_bit_def *def = DMB_LIST_AT(const dmb_bit_def, mesh->model->bits, i);
    const dmb_body_map *map = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, mesh->model->bodies.count + i);
    dmb_rigid_part part;
    dmb_added_mass mud = {.along = 0.0};
    if (!dmb_id_is_none(def->stabiliser)) return DMB_OK;
    dmb_given_mud(def->added_mass, map->arm + 0.5 * def->length, &mud);
    const int32_t status = add_mud(mesh, map->node, &mud);
    if (status < 0) return status;
    dmb_bit_body_of(def, &part);
    return add_part(mesh, map->node, &part, map->arm + 0.5 * def->length,
                    lifted(mesh, def->displaced_volume, def->mass), def->displaced_volume);
}

/* Adds the inertia of rotor and gear of a drive about the x axis of its part. */
static int32_t add_rotor(dmb_mesh *mesh, uint32_t i)
{
    const dmb_drive_def *def = DMB_LIST_AT(const dmb_drive_def, mesh->model->drives, i);
    const uint32_t body = dmb_model_part_index(mesh->model, def->part, DMB_PART_BODY);
    const double centre[3] = {0.0, 0.0, 0.0}, inertia[6] = {def->inertia, 0.0, 0.0, 0.0, 0.0, 0.0};
    if (!(def->inertia > 0.0)) return DMB_OK;
    const uint32_t node = body != DMB_NONE ? DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, body)->node
                                           : dmb_mesh_string_at(mesh, dmb_mesh_string_of(mesh, def->part))->start_node;
    dmb_rigid_mass *rigid_mass = rigid_mass_of(mesh, node);
    if (rigid_mass == NULL) return DMB_ERR_NO_MEMORY;
    dmb_rigid_mass_add(rigid_mass, 0.0, centre, inertia);
    return DMB_OK;
}

int32_t dmb_mesh_masses(dmb_mesh *mesh)
{
    int32_t status = DMB_OK;
    for (uint32_t s = 0; s < mesh->strings.count && status >= 0; ++s) status = add_string(mesh, s);
    for (uint32_t i = 0; i < mesh->model->bodies.count && status >= 0; ++i) status = add_described_body(mesh, i);
    for (uint32_t i = 0; i < mesh->model->bits.count && status >= 0; ++i) status = add_bit(mesh, i);
    for (uint32_t i = 0; i < mesh->model->drives.count && status >= 0; ++i) status = add_rotor(mesh, i);
    return status;
}
