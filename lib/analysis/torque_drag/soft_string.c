/* Soft string of torque and drag (eq:drilling.soft-string): conditions for the model, and integration from the far end
 * to the rig. Depths are measured depths of the hole, forces effective ones, tension positive.
 *
 * Pipes are those of the description, counted from its lower end, which is at the requested depth. The march returns 0
 * if the compression exceeds COMPRESSION: the string locks up (eq:drilling.lock-up), for which the equations have a
 * pole. */
#include "analysis/torque_drag/soft_string.h"

#include <math.h>

#include "model/section.h"

/* ---- Strings outside the soft-string model ----------------------------------------------------------------------- */

/* 1: the place is on the string, below its rig end. */
static int is_below(const dmb_model *model, uint32_t string, const dmb_place *place)
{
    if (place->part.generation == 0 || dmb_model_part_index(model, place->part, DMB_PART_STRING) != string) return 0;
    return place->pipe > 0 || place->fraction > 0.0;
}

/* 1: a joint below the rig end constrains the string, or a part attached to it; a joint without constraints acts by its
 * springs only. */
static int is_constrained(const dmb_model *model, uint32_t string)
{
    for (uint32_t i = 0; i < model->joints.count; i++) {
        const dmb_joint_def *joint = DMB_LIST_AT(const dmb_joint_def, model->joints, i);
        if (joint->kind == DMB_JOINT_FREE) continue;
        if (is_below(model, string, &joint->place_a) || is_below(model, string, &joint->place_b)) return 1;
    }
    return 0;
}

/* 1: a load, spring or force of the model acts below the rig end. */
static int is_acted_on(const dmb_model *model, uint32_t string)
{
    const dmb_load_def *loads = model->loads.items;
    const dmb_spring_plan *springs = model->springs.items;
    const dmb_force_def *forces = model->forces.items;
    for (uint32_t i = 0; i < model->loads.count; i++)
        if (is_below(model, string, &loads[i].place)) return 1;
    for (uint32_t i = 0; i < model->springs.count; i++)
        if (is_below(model, string, &springs[i].def.place_a) || is_below(model, string, &springs[i].def.place_b))
            return 1;
    for (uint32_t i = 0; i < model->forces.count; i++)
        for (uint32_t k = 0; k < forces[i].place_count; k++)
            if (is_below(model, string, &forces[i].place[k])) return 1;
    return 0;
}

/* 1: the string is stuck below the rig end; a stuck point does not follow the speeds of an operation. */
static int is_stuck(const dmb_model *model, uint32_t string)
{
    const dmb_stuck_def *stuck = model->stuck.items;
    for (uint32_t i = 0; i < model->stuck.count; i++)
        if (stuck[i].stuck != 0 && is_below(model, string, &stuck[i].place)) return 1;
    return 0;
}

static int has_stabilisers(const dmb_scene *scene, uint32_t string)
{
    for (uint32_t i = 0; i < scene->ring_count; i++)
        if (scene->rings[i].string == string) return 1;
    return 0;
}

const char *dmb_soft_string_lacks(const dmb_model *model, const dmb_scene *scene, uint32_t string)
{
    const dmb_string_plan *plan = (const dmb_string_plan *)model->strings.items + string;
    if (plan->def.follows_hole == 0) return "the string does not follow the hole; set follows_hole of its definition";
    if (has_stabilisers(scene, string))
        return "the string has rings, whose weight and diameter the soft string leaves out; leave them out, or ask for "
               "steady states (dmb_analysis_static)";
    if (plan->continued != 0)
        return "a sub continues the string, whose weight and section the soft string leaves out; describe it as one "
               "string, or ask for steady states (dmb_analysis_static)";
    if (scene->flow_count > 0 && scene->flow.eccentricity > 0.0 && scene->hole.pieces > 0)
        return "the environment has a flow_eccentricity and the hole has sections, at other depths of which its law "
               "may not hold; leave the eccentricity out";
    if (is_constrained(model, string))
        return "a joint holds something at the string below its rig end, whose weight and forces the soft string "
               "leaves out; leave it out, or ask for steady states (dmb_analysis_static)";
    if (is_acted_on(model, string))
        return "a load, spring or force of the model acts on the string below its rig end, which the soft string "
               "leaves out; leave it out of the model, or ask for steady states (dmb_analysis_static)";
    if (is_stuck(model, string)) return "the string is described stuck below its rig end; describe it free (stuck = 0)";
    return NULL;
}

/* ---- Integration from the far end -------------------------------------------------------------------------------- */

#define STEP_MAX 2.0     /* [m] of a Runge-Kutta step, whose error is of fourth order */
#define TURN_MAX 0.05    /* [rad] rotation of the hole tangent per step */
#define COMPRESSION 0.01 /* [-] of EA, far beyond the strength of any pipe */

typedef struct march {
    const dmb_soft_string *soft;
    const dmb_operation *operation;
    const dmb_pipe_def *pipe; /* the present pipe, with its constants: */
    double EA, GJ, EI;        /* [N, N m2, N m2] the smaller EI */
    double weight;            /* [kg/m] buoyant mass per metre with tool joints */
    double elastic;           /* [-] share of the length that is elastic: tool joints are rigid */
    double radius;            /* [m] of the contact surface */
    double hole, pull;        /* [m, N/m] hole diameter, and pull of flowing mud in it; 0: not yet computed */
    int32_t new_pipe, reserved;
    dmb_soft_place place;
} march;

static void read_pipe(march *m, const dmb_pipe_def *pipe)
{
    const dmb_soft_string *soft = m->soft;
    dmb_pipe_section section;
    dmb_section_of(pipe, &section);
    m->pipe = m->place.pipe = pipe;
    m->new_pipe = 1;
    m->EA = section.stiffness[0];
    m->GJ = section.stiffness[3];
    m->EI = fmin(section.stiffness[4], section.stiffness[5]);
    m->weight = dmb_weighing_mass(pipe, &soft->mud) / pipe->length;
    m->elastic = 1.0 - pipe->joint_length / pipe->length;
    m->hole = 0.0;
    m->radius = 0.5 * fmax(pipe->outer_diameter, dmb_joint_diameter(pipe));
}

/* ---- The equations ----------------------------------------------------------------------------------------------- */

static void confined_at(const march *m, double depth, dmb_confined_pipe *pipe)
{
    double x[3];
    dmb_hole_frame(m->soft->hole, depth, x, pipe->tangent, pipe->bend);
    dmb_vec3_scale(m->weight, m->soft->gravity, pipe->weight);
    pipe->EI = m->EI;
    pipe->clearance = fmax(0.0, dmb_hole_radius(m->soft->hole, depth) - m->radius);
}

/* [-] Friction coefficient at a depth. The wall's coefficient by depth times the factor `friction`, or that number
 * alone. */
static double friction_at(const march *m, double depth)
{
    const dmb_soft_string *soft = m->soft;
    if (!soft->by_depth) return soft->friction;
    if (soft->hole->pieces == 0) return soft->friction * soft->wall_friction;
    return soft->friction * soft->hole->friction *
           dmb_hole_piece_value(dmb_hole_piece_at(soft->hole, depth), DMB_WALL_MU_DYNAMIC, depth);
}

/* [N/m] Wall force and its derivative by N. Beyond the helical load of eq:drilling.helical the wall carries the
 * helix, too (eq:drilling.helix-force). A ratio that is NaN counts as beyond. */
static double wall_force(const march *m, const dmb_confined_pipe *pipe, double N, double *by_force)
{
    double wall = dmb_confined_wall_force(pipe, N, by_force);
    if (m->soft->post_buckling && N < 0.0 && !(dmb_helical_ratio(pipe, N) <= 1.0)) {
        wall += pipe->clearance * N * N / (4.0 * pipe->EI);
        *by_force += pipe->clearance * N / (2.0 * pipe->EI);
    }
    return wall;
}

/* [N/m] Pull of the flowing mud towards the rig, mean over pipe and tool joint. */
static double pull_of_flow(march *m, double depth)
{
    const dmb_pipe_def *pipe = m->pipe;
    const double hole = 2.0 * dmb_hole_radius(m->soft->hole, depth), share = pipe->joint_length / pipe->length;
    double d[2];
    if (m->soft->flow == NULL) return 0.0;
    if (m->hole == hole) return m->pull;
    dmb_pipe_diameters(pipe, 0, d);
    m->hole = hole;
    m->pull = (1.0 - share) * dmb_annulus_loss(m->soft->flow, d[0], hole).pull;
    dmb_pipe_diameters(pipe, 1, d);
    if (share > 0.0) m->pull += share * dmb_annulus_loss(m->soft->flow, d[0], hole).pull;
    return m->pull;
}

/* Rates per metre towards the rig (eq:drilling.soft-string, eq:drilling.transmission, eq:drilling.stretch). */
static void rates(march *m, double depth, const double state[DMB_SOFT_COUNT], double rate[DMB_SOFT_COUNT])
{
    const double v_a = m->operation->axial_speed, v_c = m->operation->rotary_speed * m->radius;
    const double v = hypot(v_a, v_c);
    const double friction = friction_at(m, depth);
    const double along = v > 0.0 ? friction * v_a / v : 0.0;
    const double around = v > 0.0 ? friction * fabs(v_c) / v : 0.0;
    dmb_confined_pipe pipe;
    double by_force;
    confined_at(m, depth, &pipe);
    const double wall = wall_force(m, &pipe, state[DMB_SOFT_FORCE], &by_force);
    rate[DMB_SOFT_FORCE] = dmb_vec3_dot(pipe.weight, pipe.tangent) - along * wall - pull_of_flow(m, depth);
    rate[DMB_SOFT_TORQUE] = around * wall * m->radius;
    rate[DMB_SOFT_GROWTH] = -along * by_force * state[DMB_SOFT_GROWTH];
    rate[DMB_SOFT_STRETCH] = m->elastic * state[DMB_SOFT_FORCE] / m->EA;
    rate[DMB_SOFT_WIND_UP] = m->elastic * state[DMB_SOFT_TORQUE] / m->GJ;
    rate[DMB_SOFT_WALL] = wall;
}

static void add(const double *state, double h, const double *rate, double *out)
{
    for (int i = 0; i < DMB_SOFT_COUNT; i++) out[i] = state[i] + h * rate[i];
}

/* Classical Runge-Kutta over h [m] towards the rig. The hole's curvature jumps at stations, where steps end: both ends
 * are evaluated slightly inside the step. */
static void runge_kutta(march *m, double h)
{
    const double from = m->place.depth - 1e-9 * h, middle = m->place.depth - 0.5 * h,
                 to = m->place.depth - h + 1e-9 * h;
    double *y = m->place.state, k[4][DMB_SOFT_COUNT], at[DMB_SOFT_COUNT];
    rates(m, from, y, k[0]);
    add(y, 0.5 * h, k[0], at);
    rates(m, middle, at, k[1]);
    add(y, 0.5 * h, k[1], at);
    rates(m, middle, at, k[2]);
    add(y, h, k[2], at);
    rates(m, to, at, k[3]);
    for (int i = 0; i < DMB_SOFT_COUNT; i++) y[i] += h / 6.0 * (k[0][i] + 2.0 * (k[1][i] + k[2][i]) + k[3][i]);
    m->place.depth -= h;
    m->place.step = h;
}

/* ---- Stepping ---------------------------------------------------------------------------------------------------- */

/* [m] Depth of the last station above `depth` by more than rounding; minus infinity if there is none. */
static double station_above(const dmb_hole *hole, double depth)
{
    uint32_t low = 0, high = hole->stations;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (hole->station[middle].depth < depth)
            low = middle + 1;
        else
            high = middle;
    }
    return low > 0 ? hole->station[low - 1].depth : -(double)INFINITY;
}

/* [m] The same for the sections of the wall, where the second derivative of the constants jumps. */
static double piece_above(const dmb_hole *hole, double depth)
{
    if (hole->pieces == 0) return -(double)INFINITY;
    const dmb_hole_piece *piece = dmb_hole_piece_at(hole, depth);
    if (piece->depth < depth) return piece->depth;
    return piece > hole->piece ? piece[-1].depth : -(double)INFINITY;
}

/* [m] Depth of the end of the step from the present place; not beyond `end`, which is exact. Steps end where the
 * equations jump: at the end of a run of pipes, survey stations, sections of the wall and requested stations. In
 * between they are equal, at most STEP_MAX and TURN_MAX long. At survey stations and ends a step ends on the exact
 * number, so that it cannot step over one by rounding. */
static double next_depth(const march *m, double end, double spacing)
{
    const double depth = m->place.depth, start = m->soft->start;
    dmb_confined_pipe pipe;
    double next = fmax(end, fmax(station_above(m->soft->hole, depth), piece_above(m->soft->hole, depth)));
    if (spacing > 0.0) next = fmax(next, start + spacing * (ceil((depth - start) / spacing - 1e-9) - 1.0));
    confined_at(m, depth - 1e-9, &pipe);
    const double bend = dmb_vec3_norm(pipe.bend);
    const double most = bend * STEP_MAX > TURN_MAX ? TURN_MAX / bend : STEP_MAX;
    const double parts = ceil((depth - next) / most - 1e-9);
    return parts > 1.0 ? depth - (depth - next) / parts : next;
}

/* Visits the place with pipe and curvature of one side: `into` [m] deeper. 0 if the compression is excessive. */
static int visit_side(march *m, double into, dmb_soft_visit visit, void *context)
{
    const double N = m->place.state[DMB_SOFT_FORCE];
    dmb_confined_pipe pipe;
    double unused;
    if (!(N > -COMPRESSION * m->EA)) return 0;
    confined_at(m, m->place.depth + into, &pipe);
    m->place.wall = wall_force(m, &pipe, N, &unused);
    m->place.curvature = dmb_vec3_norm(pipe.bend);
    m->place.sinusoidal = dmb_sinusoidal_ratio(&pipe, N);
    m->place.helical = dmb_helical_ratio(&pipe, N);
    visit(context, &m->place);
    return 1;
}

/* Curvature and pipe may jump between the step that ended here and the next one of h [m]: then the place is visited for
 * the next one too. */
static int visit_jump(march *m, double h, dmb_soft_visit visit, void *context)
{
    const double before = m->place.curvature;
    dmb_confined_pipe pipe;
    confined_at(m, m->place.depth - 0.5e-9 * h, &pipe);
    if (!m->new_pipe && fabs(dmb_vec3_norm(pipe.bend) - before) <= 1e-9 * before) return 1;
    m->new_pipe = 0;
    m->place.step = 0.0;
    return visit_side(m, -0.5e-9 * h, visit, context);
}

/* State at the far end: load and torque of the bit, and the weight of attached parts. */
static void begin(march *m, double depth)
{
    double x[3], t[3];
    dmb_hole_frame(m->soft->hole, depth, x, t, NULL);
    m->place.depth = depth;
    m->place.state[DMB_SOFT_FORCE] =
        m->soft->end_mass * dmb_vec3_dot(m->soft->gravity, t) - m->operation->weight_on_bit;
    if (m->soft->flow != NULL) m->place.state[DMB_SOFT_FORCE] -= dmb_nozzle_thrust(m->soft->flow);
    m->place.state[DMB_SOFT_TORQUE] = m->operation->torque_on_bit;
    m->place.state[DMB_SOFT_GROWTH] = 1.0;
}

/* Integrates over a run of equal pipes in the hole, up to depth `end`. */
static int march_run(march *m, double end, double spacing, dmb_soft_visit visit, void *context)
{
    while (m->place.depth > end) {
        const double next = next_depth(m, end, spacing);
        if (!visit_jump(m, m->place.depth - next, visit, context)) return 0;
        runge_kutta(m, m->place.depth - next);
        m->place.depth = next;
        if (!visit_side(m, 0.5e-9 * m->place.step, visit, context)) return 0;
    }
    return 1;
}

/* Runs of pipes from the last one upwards. A top within rounding of the rig end is set to it: no step of rounding
 * length. */
int dmb_soft_string_march(const dmb_soft_string *soft, const dmb_operation *operation, double depth, double spacing,
                          dmb_soft_visit visit, void *context)
{
    const dmb_pipe_run *runs = soft->model->runs.items;
    march m = {.soft = soft, .operation = operation};
    double top = depth;
    int told = 0;
    for (uint32_t i = soft->model->runs.count; i-- > 0 && top > soft->start;) {
        if (runs[i].string != soft->string) continue;
        read_pipe(&m, &runs[i].def);
        if (!told) {
            begin(&m, depth);
            if (!visit_side(&m, 0.0, visit, context)) return 0;
            told = 1;
        }
        top = fmax(soft->start, top - runs[i].count * runs[i].def.length);
        if (top - soft->start < 1e-9 * soft->length) top = soft->start;
        if (!march_run(&m, top, spacing, visit, context)) return 0;
    }
    return 1;
}
