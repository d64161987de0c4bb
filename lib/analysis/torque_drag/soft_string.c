#include "analysis/torque_drag/soft_string.h"

#include <math.h>

#include "model/section.h"

#define STEP_MAX 2.0     /* [m] of a Runge-Kutta step, whose error goes with its fourth power */
#define TURN_MAX 0.05    /* [rad] by which the hole turns within one */
#define COMPRESSION 0.01 /* [-] of EA, far beyond what any pipe bears */

typedef struct march {
    const dmb_soft_string *soft;
    const dmb_operation *operation;
    const dmb_pipe_def *pipe; /* the present one, and its constants: */
    double EA, GJ, EI;        /* [N, N m2, N m2] the smaller EI */
    double weight;            /* [kg/m] mass per metre with tool joints, buoyancy taken off */
    double radius;            /* [m] of what touches */
    double hole, pull;        /* [m, N/m] of the mud that flows in a hole of that diameter; 0: not known yet */
    dmb_soft_place place;
} march;

static void take_pipe(march *m, const dmb_pipe_def *pipe)
{
    const dmb_soft_string *soft = m->soft;
    dmb_pipe_section section;
    dmb_section_of(pipe, &section);
    m->pipe = m->place.pipe = pipe;
    m->EA = section.stiffness[0];
    m->GJ = section.stiffness[3];
    m->EI = fmin(section.stiffness[4], section.stiffness[5]);
    m->weight = dmb_weighing_mass(pipe, &soft->mud) / pipe->length;
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

/* [-] */
static double friction_at(const march *m, double depth)
{
    const dmb_soft_string *soft = m->soft;
    if (!soft->by_depth) return soft->friction;
    if (soft->hole->pieces == 0) return soft->friction * soft->wall_friction;
    return soft->friction * soft->hole->friction *
           dmb_hole_piece_value(dmb_hole_piece_at(soft->hole, depth), DMB_WALL_MU_DYNAMIC, depth);
}

/* [N/m] Wall force and its derivative by N. */
static double wall_force(const march *m, const dmb_confined_pipe *pipe, double N, double *by_force)
{
    double wall = dmb_confined_wall_force(pipe, N, by_force);
    if (m->soft->post_buckling && N < 0.0 && dmb_helical_share(pipe, N) > 1.0) {
        wall += pipe->clearance * N * N / (4.0 * pipe->EI);
        *by_force += pipe->clearance * N / (2.0 * pipe->EI);
    }
    return wall;
}

/* [N/m] Mean over pipe and tool joint of what the mud that flows pulls towards the rig. */
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

/* Rates towards the rig, per metre. */
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
    rate[DMB_SOFT_STRETCH] = state[DMB_SOFT_FORCE] / m->EA;
    rate[DMB_SOFT_WIND_UP] = state[DMB_SOFT_TORQUE] / m->GJ;
    rate[DMB_SOFT_WALL] = wall;
}

static void add(const double *state, double h, const double *rate, double *out)
{
    for (int i = 0; i < DMB_SOFT_COUNT; i++) out[i] = state[i] + h * rate[i];
}

/* Classical Runge-Kutta over h [m] towards the rig. The hole's curvature jumps at stations, which steps end at: both
 * ends are taken a little inside. */
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

/* ---- The way ----------------------------------------------------------------------------------------------------- */

/* [m] Depth of the last station above `depth` by more than rounding; none: minus infinity. */
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

/* [m] Likewise of the pieces of the wall, whose constants have corners of their second derivative there. */
static double piece_above(const dmb_hole *hole, double depth)
{
    if (hole->pieces == 0) return -(double)INFINITY;
    const dmb_hole_piece *piece = dmb_hole_piece_at(hole, depth);
    if (piece->depth < depth) return piece->depth;
    return piece > hole->piece ? piece[-1].depth : -(double)INFINITY;
}

/* The end of the step that begins at the present place: `end` at the latest, which is exact. */
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

static int tell(march *m, dmb_soft_visit visit, void *context)
{
    const double N = m->place.state[DMB_SOFT_FORCE];
    dmb_confined_pipe pipe;
    double unused;
    if (!(N > -COMPRESSION * m->EA)) return 0;
    confined_at(m, m->place.depth + 0.5e-9 * m->place.step, &pipe);
    m->place.wall = wall_force(m, &pipe, N, &unused);
    m->place.curvature = dmb_vec3_norm(pipe.bend);
    m->place.sinusoidal = dmb_sinusoidal_share(&pipe, N);
    m->place.helical = dmb_helical_share(&pipe, N);
    visit(context, &m->place);
    return 1;
}

/* At the far end: load and torque of the bit, and the weight of what is fixed there. */
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

/* The part of a run of equal pipes that is in the hole, up to depth `end`. */
static int march_run(march *m, double end, double spacing, dmb_soft_visit visit, void *context)
{
    while (m->place.depth > end) {
        const double next = next_depth(m, end, spacing);
        runge_kutta(m, m->place.depth - next);
        m->place.depth = next;
        if (!tell(m, visit, context)) return 0;
    }
    return 1;
}

int dmb_soft_string_march(const dmb_soft_string *soft, const dmb_operation *operation, double depth, double spacing,
                          dmb_soft_visit visit, void *context)
{
    const dmb_pipe_run *runs = soft->model->runs.items;
    march m = {.soft = soft, .operation = operation};
    double top = depth;
    int told = 0;
    for (uint32_t i = soft->model->runs.count; i-- > 0 && top > soft->start;) {
        if (runs[i].string != soft->string) continue;
        take_pipe(&m, &runs[i].def);
        if (!told) {
            begin(&m, depth);
            if (!tell(&m, visit, context)) return 0;
            told = 1;
        }
        top = fmax(soft->start, top - runs[i].count * runs[i].def.length);
        if (top - soft->start < 1e-9 * soft->length) top = soft->start;
        if (!march_run(&m, top, spacing, visit, context)) return 0;
    }
    return 1;
}
