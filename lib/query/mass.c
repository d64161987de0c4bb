/* Contributions to the rigid mass of a node. The rigid_mass of a node is the sum of all parts fixed to it. Each
 * contribution is computed from the description, as the compile step added it. */
#include "query/query.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "element/added_mass.h"
#include "element/beam.h"
#include "element/rigid_mass.h"
#include "model/field_check.h"
#include "model/mesh.h"
#include "model/section.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"
#include "system/assemble/caller_force.h"
#include "system/assemble/energy.h"
#include "system/assemble/ledger.h"
#include "system/constrain/constrain.h"

void dmb_describe_pipe(const dmb_sim *sim, uint32_t string, uint32_t pipe, dmb_described_pipe *out)
{
    const dmb_scene *scene = sim->scene;
    memset(out, 0, sizeof *out);
    out->map = &scene->pipes[scene->strings[string].first_pipe + pipe];
    out->def = &dmb_pipe_run_of(sim->model, string, pipe)->def;
    out->string = string;
    out->number = pipe;
    out->eccentric = (scene->features & DMB_FEATURE_ECCENTRICITY) && dmb_pipe_is_eccentric(out->def);
    if (out->eccentric) dmb_pipe_offset(out->def, pipe, out->offset);
}

static void begin(dmb_rigid_mass *share, uint32_t node)
{
    memset(share, 0, sizeof *share);
    share->node = node;
}

/* Adds a solid of revolution with its centre at x [m] along the node's axis, displaced laterally by the pipe's offset.
 */
static void add_part(dmb_rigid_mass *share, const dmb_rigid_part *part, double x, const dmb_described_pipe *pipe)
{
    const double centre[3] = {x, 0.0, 0.0};
    const double inertia[6] = {part->inertia[0], part->inertia[1], part->inertia[1], 0.0, 0.0, 0.0};
    dmb_rigid_mass_add(share, part->mass, centre, inertia);
    if (pipe != NULL && pipe->eccentric) dmb_rigid_mass_shift(share, part->mass, x, pipe->offset);
}

void dmb_rigid_pipe_fraction(const dmb_described_pipe *pipe, dmb_rigid_mass *share)
{
    dmb_rigid_part part;
    begin(share, pipe->map->node);
    dmb_rigid_pipe_of(pipe->def, &part);
    add_part(share, &part, pipe->map->start + 0.5 * dmb_pipe_body_length(pipe->def), pipe);
}

/* The tool joint ends at the end of the pipe. After a flexible pipe the node may be further along, within rigid pipes.
 */
void dmb_joint_fraction(const dmb_scene *scene, const dmb_described_pipe *pipe, dmb_rigid_mass *share)
{
    const dmb_pipe_map *map = pipe->map;
    double x = map->start + map->length - 0.5 * map->joint;
    uint32_t node = map->node;
    dmb_rigid_part part;
    if (map->elements > 0) {
        const uint32_t last = map->element + map->elements - 1;
        node = scene->element_node[last] + 1;
        x = 0.5 * map->joint - scene->types[scene->element_type[last]].arm[1];
    }
    begin(share, node);
    dmb_joint_of(pipe->def, &part);
    add_part(share, &part, x, pipe);
}

/* A slice of the tool joint: mass and polar inertia in proportion to its length; across, the inertia of the slices
 * about their own centres in proportion, and that of their distances by m l^2/12. */
double dmb_joint_part_fraction(const dmb_scene *scene, const dmb_described_pipe *pipe, double length,
                               dmb_rigid_mass *share)
{
    const uint32_t last = pipe->map->element + pipe->map->elements - 1;
    const double joint = pipe->map->joint, fraction = length / joint;
    dmb_rigid_part part;
    begin(share, scene->element_node[last] + 1);
    dmb_joint_of(pipe->def, &part);
    part.inertia[1] -= part.mass * joint * joint / 12.0; /* inertia of the slices about their own centres */
    part.mass *= fraction;
    part.inertia[0] *= fraction;
    part.inertia[1] = part.inertia[1] * fraction + part.mass * length * length / 12.0;
    add_part(share, &part, 0.5 * length - scene->types[scene->element_type[last]].arm[1], pipe);
    return part.mass;
}

void dmb_eccentric_fraction(const dmb_scene *scene, const dmb_described_pipe *pipe, uint32_t element, uint32_t end,
                            dmb_rigid_mass *share)
{
    const dmb_element_type *type = &scene->types[scene->element_type[element]];
    begin(share, scene->element_node[element] + end);
    dmb_rigid_mass_shift(share, 0.5 * type->mass_per_metre * type->length, end ? -type->arm[1] : type->arm[0],
                         pipe->offset);
}

/* The reference point of a bit is the end of the string; its centre is half its length beyond. */
static void bit_fraction(const dmb_bit_def *def, double arm, dmb_rigid_mass *share)
{
    dmb_rigid_part part;
    if (!dmb_id_is_none(def->stabiliser)) return; /* the mass is that of the stabiliser */
    dmb_bit_body_of(def, &part);
    add_part(share, &part, arm + 0.5 * def->length, NULL);
}

/* [m] outer diameter of the pipe or tool joint that carries a ring. */
static double diameter_under(const dmb_model *model, const dmb_stabiliser_def *def)
{
    const uint32_t named = dmb_model_part_index(model, def->string, DMB_PART_STRING);
    const dmb_pipe_def *pipe = &dmb_pipe_run_of(model, named == DMB_NONE ? 0 : named, def->pipe)->def;
    double diameters[2];
    dmb_pipe_diameters(pipe, def->fraction * pipe->length > dmb_pipe_body_length(pipe), diameters);
    return diameters[0];
}

static void stabiliser_fraction(const dmb_model *model, uint32_t ring, double arm, dmb_rigid_mass *share)
{
    const dmb_stabiliser_def *def = (const dmb_stabiliser_def *)model->rings.items + ring;
    dmb_rigid_part part;
    dmb_ring_body_of(def, diameter_under(model, def), &part);
    add_part(share, &part, arm, NULL);
}

void dmb_body_fraction(const dmb_sim *sim, uint32_t body, dmb_rigid_mass *share)
{
    const dmb_body_map *map = &sim->scene->bodies[body];
    const uint32_t bodies = sim->model->bodies.count, rings = bodies + sim->model->bits.count;
    const dmb_body_def *def;
    double centre[3];
    begin(share, map->node);
    if (body >= rings) {
        stabiliser_fraction(sim->model, body - rings, map->arm, share);
        return;
    }
    if (body >= bodies) {
        bit_fraction((const dmb_bit_def *)sim->model->bits.items + (body - bodies), map->arm, share);
        return;
    }
    def = (const dmb_body_def *)sim->model->bodies.items + body;
    dmb_vec3_copy(def->centre, centre);
    centre[0] += map->arm;
    dmb_rigid_mass_add(share, def->mass, centre, def->inertia);
}

/* Added mass of mud on rings, bodies and bits, and on rigid pipes, from their descriptions. */
static double body_mud_energy(const dmb_sim *sim, uint32_t body)
{
    const dmb_model *model = sim->model;
    const dmb_body_map *map = &sim->scene->bodies[body];
    const uint32_t bodies = model->bodies.count, rings = bodies + model->bits.count;
    dmb_added_mass part = {.node = map->node};
    if (sim->scene->added_mass_count == 0) return 0.0;
    if (body < bodies) {
        const dmb_body_def *def = (const dmb_body_def *)model->bodies.items + body;
        dmb_given_mud(def->added_mass, map->arm + def->centre[0], &part);
    } else if (body < rings) {
        const dmb_bit_def *def = (const dmb_bit_def *)model->bits.items + (body - bodies);
        dmb_given_mud(def->added_mass, map->arm + 0.5 * def->length, &part);
    } else {
        const dmb_stabiliser_def *def = (const dmb_stabiliser_def *)model->rings.items + (body - rings);
        dmb_ring_mud(def, diameter_under(model, def), &model->environment, model->wall.diameter, map->arm, &part);
    }
    return dmb_added_mass_kinetic_energy(sim->scene, &sim->now, &part);
}

static double rigid_pipe_mud_energy(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    const dmb_environment_def *e = &sim->model->environment;
    dmb_added_mass part = {.node = pipe->map->node};
    if (!(e->added_mass > 0.0 || e->added_mass < 0.0)) return 0.0;
    dmb_rigid_pipe_mud(pipe->def, e, sim->model->wall.diameter,
                       pipe->map->start + 0.5 * dmb_pipe_body_length(pipe->def), &part);
    return dmb_added_mass_kinetic_energy(sim->scene, &sim->now, &part);
}

/* On an axial-torsional node only the mass and the inertia about the hole's axis contribute. */
double dmb_fraction_kinetic_energy(const dmb_sim *sim, const dmb_rigid_mass *share)
{
    const double *v = sim->now.velocity + sim->scene->layout.row[share->node];
    double p[6];
    if (sim->scene->layout.size[share->node] == DMB_NODE_AXIAL_TORSIONAL)
        return 0.5 * (share->mass * v[0] * v[0] + share->inertia[0] * v[1] * v[1]);
    dmb_rigid_mass_times(share, v, p);
    return 0.5 * dmb_vec6_dot(v, p);
}

int dmb_body_is_at_end(const dmb_model *model, uint32_t body, uint32_t string, int32_t attach)
{
    const dmb_body_def *bodies = model->bodies.items;
    const dmb_bit_def *bits = model->bits.items;
    const int is_bit = body >= model->bodies.count;
    if (body >= model->bodies.count + model->bits.count) return 0; /* a contact ring */
    if (is_bit && !dmb_id_is_none(bits[body - model->bodies.count].stabiliser)) return 0;
    const dmb_id id = is_bit ? bits[body - model->bodies.count].string : bodies[body].string;
    const uint32_t named = dmb_model_part_index(model, id, DMB_PART_STRING);
    return (is_bit ? DMB_ATTACH_END : bodies[body].attach) == attach && (named == DMB_NONE ? 0 : named) == string;
}

/* The energy ledger. Its powers are those of the forces on the bodies. The powers of inertia forces and potential
 * forces are minus the rates of the energies, exactly in continuous time. The difference in discrete time is numerical
 * dissipation of the time integration (scheme). */

/* ---- Energies ---------------------------------------------------------------------------------------------------- */

DMB_DECLARE_STRUCT(dmb_energy)

static void energies_now(const dmb_sim *sim, dmb_energy *e)
{
    e->kinetic = dmb_kinetic_energy(sim->scene, &sim->now);
    e->strain = dmb_strain_energy(sim->scene, &sim->now) + dmb_joint_energy(sim, &sim->now) +
                dmb_springs_energy(sim->scene, &sim->now) + dmb_caller_forces_energy(sim->scene, &sim->now) +
                dmb_stuck_energy(sim, &sim->now);
    e->gravity = dmb_gravity_energy(sim->scene, &sim->now);
    e->contact = dmb_contact_energy(sim->scene, &sim->now);
}

/* [J] reference of the relative error: the largest of the energies supplied, dissipated, exchanged with gravity, and
 * present at the start and now. */
static double scale_of(const dmb_ledger *ledger, const dmb_energy *e)
{
    const double spent = fabs(e->friction) + fabs(e->impact) + fabs(e->damping) + fabs(e->rock);
    const double present = fmax(fabs(ledger->start), e->kinetic + e->strain + e->contact);
    return fmax(fmax(e->input, spent), fmax(fabs(e->gravity), present));
}

/* [-] bounded by DBL_MAX, because a very small scale must not give infinity */
static double fraction_of(double part, double scale)
{
    return scale > 0.0 ? fmin(fabs(part) / scale, DBL_MAX) : 0.0;
}

/* Works are integrals of the powers of forces on the bodies (eq:motion.work, ledger_work.c); dissipation is minus the
 * work of its forces.
 *   balance = energy supplied - energy dissipated - energy stored; 0 in continuous time
 *   scheme = -(work of inertia + work of potential) - (E - E_start)
 *   unexplained = balance - scheme = sum of all works: the work of the residual, from iterations that stopped early */
static void balance(const dmb_ledger *ledger, dmb_energy *e)
{
    const double *work = ledger->work;
    const double gained = e->kinetic + e->strain + e->gravity + e->contact - ledger->start;
    e->drives = work[DMB_POWER_DRIVES];
    e->loads = work[DMB_POWER_LOADS];
    e->friction = -work[DMB_POWER_FRICTION];
    e->impact = -work[DMB_POWER_IMPACT];
    e->damping = -work[DMB_POWER_DAMPING];
    e->rock = -work[DMB_POWER_ROCK];
    e->input = ledger->input;
    e->scheme = -(work[DMB_POWER_INERTIA] + work[DMB_POWER_POTENTIAL]) - gained;
    e->balance = e->drives + e->loads - e->friction - e->impact - e->damping - e->rock - gained;
    e->unexplained = e->balance - e->scheme;
    e->scale = scale_of(ledger, e);
    e->error = fraction_of(e->balance, e->scale);
}

int32_t dmb_answer_energy(const dmb_sim *sim, dmb_energy *energy)
{
    const int32_t status = dmb_ask(sim, energy);
    dmb_energy answer = {0};
    if (status < 0) return status;
    if (!sim->options.energy_ledger) return DMB_ERR_UNSUPPORTED;
    energies_now(sim, &answer);
    balance(sim->ledger, &answer);
    const double since = sim->ledger->since, tenth = since + 0.9 * (sim->clock->time - since);
    answer.growth = fraction_of(answer.balance - dmb_ledger_balance_before(sim->ledger, tenth), answer.scale);
    return dmb_energy_write(energy, &answer);
}

/* Kinetic energy by part: that of the pipe itself, eccentricity included, and half of that of parts fixed to its two
 * ends: its tool joint, the tool joint of the previous pipe, and the bodies and bits at the ends of the string. */

static double elastic_body(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    double sum = 0.0;
    dmb_rigid_mass share;
    for (uint32_t i = 0; i < pipe->map->elements; i++) {
        const uint32_t element = pipe->map->element + i;
        sum += dmb_element_kinetic_energy(sim->scene, &sim->now, element);
        for (uint32_t end = 0; pipe->eccentric && end < 2; end++) {
            dmb_eccentric_fraction(sim->scene, pipe, element, end, &share);
            sum += dmb_fraction_kinetic_energy(sim, &share);
        }
    }
    return sum;
}

static double rigid_body(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    dmb_rigid_mass share;
    dmb_rigid_pipe_fraction(pipe, &share);
    return dmb_fraction_kinetic_energy(sim, &share) + rigid_pipe_mud_energy(sim, pipe);
}

static double joint_energy(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    dmb_rigid_mass share;
    if (!(pipe->map->joint > 0.0)) return 0.0;
    dmb_joint_fraction(sim->scene, pipe, &share);
    return dmb_fraction_kinetic_energy(sim, &share);
}

static double body_energy(const dmb_sim *sim, uint32_t body)
{
    dmb_rigid_mass share;
    dmb_body_fraction(sim, body, &share);
    return dmb_fraction_kinetic_energy(sim, &share) + body_mud_energy(sim, body);
}

/* Kinetic energy of bodies and bits fixed to one end of a string; an id that names nothing stands for the first string.
 */
static double end_bodies(const dmb_sim *sim, uint32_t string, int32_t attach)
{
    const dmb_model *model = sim->model;
    double sum = 0.0;
    for (uint32_t i = 0; i < sim->scene->body_count; i++)
        if (dmb_body_is_at_end(model, i, string, attach)) sum += body_energy(sim, i);
    return sum;
}

static double end_energy(const dmb_sim *sim, const dmb_described_pipe *pipe)
{
    double sum = joint_energy(sim, pipe);
    if (pipe->number > 0) {
        dmb_described_pipe before;
        dmb_describe_pipe(sim, pipe->string, pipe->number - 1, &before);
        sum += joint_energy(sim, &before);
    } else {
        sum += end_bodies(sim, pipe->string, DMB_ATTACH_START);
    }
    if (pipe->number + 1 == sim->scene->strings[pipe->string].pipe_count)
        sum += end_bodies(sim, pipe->string, DMB_ATTACH_END);
    return sum;
}

static int32_t pipe_energy(const dmb_sim *sim, dmb_id part, uint32_t number, double *energy)
{
    dmb_described_pipe pipe;
    int32_t status;
    if (dmb_pipe_of(sim, part, number, &status) == NULL) return status;
    dmb_describe_pipe(sim, dmb_model_part_index(sim->model, part, DMB_PART_STRING), number, &pipe);
    *energy = pipe.map->elements > 0 ? elastic_body(sim, &pipe) : rigid_body(sim, &pipe);
    *energy += 0.5 * end_energy(sim, &pipe);
    return DMB_OK;
}

int32_t dmb_answer_kinetic_energy(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *energy)
{
    const int32_t status = dmb_ask(sim, energy);
    uint32_t body;
    if (status < 0) return status;
    body = dmb_body_index(sim, part);
    if (body == DMB_NONE) return pipe_energy(sim, part, pipe, energy);
    if (pipe != 0) return DMB_ERR_VALUE;
    *energy = body_energy(sim, body);
    return DMB_OK;
}

DMB_DECLARE_STRUCT(dmb_statistics)

static void count_constraints(const dmb_sim *sim, dmb_statistics *answer)
{
    for (uint32_t k = 0; k < sim->scene->cluster_count; k++) answer->dependent += sim->partition_rank[k];
    for (uint32_t i = 0; i < sim->scene->constraint_count; i++) answer->redundant += dmb_constraint_active(sim, i);
    answer->redundant -= answer->dependent;
    for (uint32_t j = 0; j < sim->scene->joint_count; j++)
        answer->violation = fmax(answer->violation, dmb_joint_violation(sim, j));
}

int32_t dmb_answer_statistics(const dmb_sim *sim, dmb_statistics *statistics)
{
    const int32_t status = dmb_ask(sim, statistics);
    dmb_statistics answer = {0};
    const dmb_counters *counters;
    if (status < 0) return status;
    counters = sim->counters;
    answer.most_iterations = (uint32_t)counters->most_iterations;
    answer.steps = counters->steps;
    answer.rejected = counters->rejected;
    answer.iterations = counters->iterations;
    answer.limited_steps = counters->limited;
    answer.bytes = dmb_sim_bytes(sim->scene);
    answer.largest_residual = counters->largest_residual;
    answer.projection[0] = counters->projection[0];
    answer.projection[1] = counters->projection[1];
    answer.assembly[0] = counters->assembly[0];
    answer.assembly[1] = counters->assembly[1];
    answer.switches = counters->switches;
    answer.bounces = counters->bounces;
    count_constraints(sim, &answer);
    return dmb_statistics_write(statistics, &answer);
}
