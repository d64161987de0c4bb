/* The kernels in one width. A file that defines DMB_KERNELS, the name of its table, and (but for one lane) DMB_LANES
 * includes this once. */
#include "element/beam_element.h"
#include "kernel/kernels.h"
#include "kernel/lane_group.h"
#include "kernel/lanes_axial_torsional.h"
#include "kernel/lanes_axial_torsional_node.h"
#include "kernel/lanes_node.h"
#include "kernel/lanes_response.h"
#include "kernel/lanes_response_jointed.h"
#include "kernel/lanes_wall.h"
#include "kernel/lanes_wall_inside.h"
#include "math/block_inverse.h"

/* ---- Beams ------------------------------------------------------------------------------------------------------- */

/* Constants of the types of a group; kept from group to group while the types are the same. */
typedef struct lane_types {
    uint32_t type[DMB_REAL_LANES];
    dmb_beam_constants constants;
    dmb_curved_constants curved; /* where they are bent */
} lane_types;

static void load_types(const dmb_beam_args *args, const lane_group *g, int first, lane_types *types)
{
    if (!first && is_whole(g) && memcmp(types->type, args->type + g->first, sizeof types->type) == 0) return;
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const uint32_t type = args->type[place_at(g, (uint32_t)l)];
        if (!first && types->type[l] == type) continue;
        types->type[l] = type;
        dmb_beam_load_constants(args->types + type, l, &types->constants);
        if (args->curved) dmb_curved_load(args->types + type, l, &types->curved);
    }
}

/* Vector from node A to node B, and the largest magnitude that enters it. */
static inline void load_span(const dmb_beam_args *args, const lane_group *g, const lane_group *nodes,
                             dmb_beam_input *in)
{
    dmb_real ua[3], ub[3];
    load_ends(args->displacement, 3, nodes, args->count, ua, ub);
    load(args->span, 3, 3, g, 0, in->span);
    in->reach = dmb_real_of(0.0);
    for (int i = 0; i < 3; i++) {
        in->span[i] = in->span[i] + (ub[i] - ua[i]);
        in->reach = dmb_real_max(in->reach, dmb_real_abs(ua[i]) + dmb_real_abs(ub[i]) + dmb_real_abs(in->span[i]));
    }
}

DMB_LANES_INLINE void load_input(const dmb_beam_args *args, const dmb_beam_task *task, const lane_group *g,
                                 dmb_beam_input *in)
{
    const lane_group nodes = group_at(g->first, args->count + 1);
    load_ends(args->quaternion, 4, &nodes, args->count, in->qa, in->qb);
    dmb_quat_to_matrix(in->qa, in->Ra);
    load_span(args, g, &nodes, in);
    if (!task->dynamic) return;
    load_ends(args->velocity, 6, &nodes, args->count, in->va, in->vb);
    load_ends(args->acceleration, 6, &nodes, args->count, in->aa, in->ab);
    if (!task->tangent) return;
    load_ends(args->increment, 6, &nodes, args->count, in->za, in->zb);
}

/* Parts of the nodes of the next group that come from the far ends of elements. */
typedef struct beam_ends {
    dmb_real residual[6], scale[6], stiffness[36], inertia[36];
} beam_ends;

static inline void begin_ends(const dmb_beam_args *args, const dmb_beam_task *task, beam_ends *ends)
{
    if (args->apart) {
        const dmb_real zero = dmb_real_of(0.0);
        for (int i = 0; i < 6; i++) ends->residual[i] = ends->scale[i] = zero;
        for (int i = 0; i < 36; i++) ends->stiffness[i] = ends->inertia[i] = zero;
        return;
    }
    chain_begin(args->residual, 6, ends->residual);
    chain_begin(args->scale, 6, ends->scale);
    if (!task->tangent) return;
    if (!task->inertia_only) chain_begin(args->stiffness_diagonal, 36, ends->stiffness);
    if (task->dynamic) chain_begin(args->inertia_diagonal, 36, ends->inertia);
}

static inline void add_ends(const dmb_beam_args *args, const dmb_beam_task *task, const beam_ends *ends)
{
    const size_t last = args->count;
    const uint32_t used = (args->count - 1) % DMB_REAL_LANES + 1;
    dmb_seam *seam = args->seam;
    chain_end(ends->residual, 6, used, seam ? seam->residual : args->residual + 6 * last);
    chain_end(ends->scale, 6, used, seam ? seam->scale : args->scale + 6 * last);
    if (!task->tangent) return;
    if (!task->inertia_only)
        chain_end(ends->stiffness, 36, used, seam ? seam->stiffness : args->stiffness_diagonal + 36 * last);
    if (task->dynamic) chain_end(ends->inertia, 36, used, seam ? seam->inertia : args->inertia_diagonal + 36 * last);
}

static inline void add_powers(dmb_beam_args *args, const lane_group *g, const dmb_beam_output *out)
{
    add_each(out->rounding, g, &args->rounding);
    add_each(-out->potential, g, &args->potential);
    add_each(-out->damping, g, &args->damping);
    add_each(-out->inertia, g, &args->inertia);
}

DMB_LANES_INLINE void store_forces(dmb_beam_args *args, const lane_group *g, const dmb_beam_output *out,
                                   beam_ends *ends)
{
    chain_store(out->fa, out->fb, 6, g, ends->residual, args->residual);
    chain_store(out->scale_a, out->scale_b, 6, g, ends->scale, args->scale);
    add_powers(args, g, out);
    if (args->strain) store(out->strain, 6, g, args->strain);
}

DMB_LANES_INLINE void store_tangent(const dmb_beam_args *args, const dmb_beam_task *task, const lane_group *g,
                                    const dmb_beam_output *out, beam_ends *ends)
{
    const dmb_beam_blocks *K = &out->K, *C = &out->C;
    if (!task->inertia_only) chain_store(K->aa, K->bb, 36, g, ends->stiffness, args->stiffness_diagonal);
    if (task->dynamic) chain_store(C->aa, C->bb, 36, g, ends->inertia, args->inertia_diagonal);
    store_block(K->ab, g, args->upper);
    store_block(K->ba, g, args->lower);
}

/* The first lane that turned too far, found one by one. */
DMB_LANES_CALL uint32_t failed_of(const dmb_beam_args *args, const lane_group *g, const dmb_beam_constants *c,
                                  const dmb_beam_input *in)
{
    dmb_beam_shape shape;
    dmb_beam_shape_at(c, args->arms, in->qa, in->Ra, in->qb, in->span, &shape);
    const dmb_real angle2 = dmb_vec3_norm_squared(shape.d + 3);
    for (uint32_t l = 0; l + 1 < g->used; l++)
        if (!(dmb_real_lane(&angle2, (int)l) < DMB_BEAM_ROTATION_MAX * DMB_BEAM_ROTATION_MAX)) return g->first + l;
    return g->first + g->used - 1;
}

DMB_LANES_INLINE int32_t beams_of(dmb_beam_args *args, const dmb_beam_task *task)
{
    lane_types types;
    beam_ends ends;
    begin_ends(args, task, &ends);
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        const lane_group g = group_at(first, args->count);
        dmb_beam_input in;
        dmb_beam_output out;
        load_types(args, &g, first == 0, &types);
        load_input(args, task, &g, &in);
        if (task->tangent && task->extrapolated) load(args->stress, 6, 6, &g, 0, out.stress);
        if (dmb_beam_element(task, &types.constants, &types.curved, &in, &out) < 0) {
            args->failed = failed_of(args, &g, &types.constants, &in);
            return -1;
        }
        store_forces(args, &g, &out, &ends);
        if (task->tangent) store_tangent(args, task, &g, &out, &ends);
    }
    add_ends(args, task, &ends);
    return 0;
}

/* Specialised for the most frequent case, dynamic forces without tangent, with fewer register spills. Not inlined, so
 * that stack frames do not add up. */
DMB_LANES_CALL int32_t beams_in_motion(dmb_beam_args *args, int32_t rates)
{
    const dmb_beam_task task = {0.0, 0.0, 1, 0, 1, rates, 0, 0, 0, 0, NULL};
    return beams_of(args, &task);
}

DMB_LANES_CALL int32_t beams_damped(dmb_beam_args *args)
{
    const dmb_beam_task task = {0.0, 0.0, 1, 0, 1, 1, 1, 0, args->arms, 0, NULL};
    return beams_of(args, &task);
}

DMB_LANES_CALL int32_t beams_as_asked(dmb_beam_args *args)
{
    const dmb_beam_task task = {args->mass_factor,
                                args->velocity_factor,
                                args->dynamic,
                                args->tangent,
                                args->extrapolated,
                                args->dynamic && (args->ledger || args->damped),
                                args->damped,
                                args->inertia_only,
                                args->arms,
                                0,
                                NULL};
    return beams_of(args, &task);
}

#if DMB_REAL_LANES == 8
extern const dmb_kernels dmb_kernels_4;

/* In halves: at the full width blocks of curved elements would take more stack than the library states. Same bits. */
static int32_t beams_curved(dmb_beam_args *args)
{
    return dmb_kernels_4.beams(args);
}
#else
DMB_LANES_CALL int32_t beams_curved(dmb_beam_args *args)
{
    const dmb_beam_task task = {args->mass_factor,  args->velocity_factor,
                                args->dynamic,      args->tangent,
                                args->extrapolated, args->dynamic && (args->ledger || args->damped),
                                args->damped,       args->inertia_only,
                                args->arms,         1,
                                args->gravity};
    return beams_of(args, &task);
}
#endif

static int32_t beams(dmb_beam_args *args)
{
    if (args->curved) return beams_curved(args);
    if (!args->dynamic || args->tangent || (args->arms && !args->damped)) return beams_as_asked(args);
    return args->damped ? beams_damped(args) : beams_in_motion(args, args->ledger);
}

/* The stress after the correction z, linearised (eq:beam.extrapolation). */
static void extrapolate(const dmb_beam_args *args)
{
    lane_types types;
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        const lane_group g = group_at(first, args->count);
        const lane_group nodes = group_at(first, args->count + 1);
        dmb_beam_shape shape;
        dmb_real za[6], zb[6], dd[6], stress[6];
        load_types(args, &g, first == 0, &types);
        load(args->strain, 6, 6, &g, 0, shape.d);
        load_ends(args->velocity, 6, &nodes, args->count, za, zb);
        dmb_so3_inverse_coefficients_at(dmb_vec3_norm_squared(shape.d + 3), &shape.k);
        dmb_beam_operators_at(&types.constants, &shape);
        if (args->arms) {
            dmb_arm_velocity(types.constants.arm[0], za);
            dmb_arm_velocity(-types.constants.arm[1], zb);
        }
        dmb_beam_strain_rate(&shape, za, zb, dd);
        dmb_beam_elastic_stress(&types.constants, &shape, stress);
        for (int i = 0; i < 6; i++) stress[i] = stress[i] + types.constants.stiffness[i] * dd[i];
        if (args->curved) {
            dmb_curved_add_cross_stress(&types.curved, &types.constants, &shape, stress);
            dmb_curved_add_cross(types.curved.cross, dd, stress);
        }
        store(stress, 6, &g, args->stress);
    }
}

/* ---- Loads at the ends of elements ------------------------------------------------------------------------------- */

/* Numbers of dmb_end_loads, in its order. */
enum { LOADS_NUMBERS = sizeof(dmb_end_loads) / sizeof(double), LOADS_LOAD = 6, LOADS_FAR = 18, LOADS_GROWTH = 30 };

/* load += half the weight and the moment +- w L^2/12 of one end, g: gravity in its axes */
static inline void add_end_weight(dmb_real half, dmb_real arm, const dmb_real g[3], dmb_real load[6])
{
    const dmb_real f[6] = {half * g[0],      half * g[1],        half * g[2],
                           dmb_real_of(0.0), -arm * half * g[2], arm * half * g[1]};
    for (int i = 0; i < 6; i++) load[i] = load[i] + f[i];
}

/* Half the mass that weighs [kg], a sixth of the length [m], and the masses [kg] of steel and of mud of an element. */
typedef struct load_masses {
    dmb_real half, arm, mass, mud;
} load_masses;

/* Loads of both ends from the forces on the nodes and the weight. */
DMB_LANES_INLINE void loads_of(const dmb_beam_args *args, const dmb_beam_constants *c, const dmb_beam_input *in,
                               const load_masses *m, dmb_beam_output *out, dmb_real *x)
{
    dmb_real world[3], g[3];
    for (int i = 0; i < 3; i++) world[i] = dmb_real_of(args->gravity[i]);
    if (args->arms) dmb_arm_wrench(-c->arm[0], out->fa);
    if (args->arms) dmb_arm_wrench(c->arm[1], out->fb);
    for (int i = 0; i < 6; i++) {
        x[i] = out->strain[i];
        x[LOADS_LOAD + i] = -out->fa[i];
        x[LOADS_LOAD + 6 + i] = out->fb[i];
    }
    dmb_mat3_tvec(in->Ra, world, g);
    add_end_weight(m->half, m->arm, g, x + LOADS_LOAD);
    dmb_mat3_tvec(x + LOADS_FAR, g, g);
    add_end_weight(-m->half, -m->arm, g, x + LOADS_LOAD + 6);
}

/* F1 of eq:beam.section-force; velocities and accelerations are those of the ends. Mud moves across the axis only. */
DMB_LANES_INLINE void growth_of(const dmb_beam_input *in, const load_masses *m, dmb_real *x)
{
    dmb_real near[3], far[3], near_across[3], far_across[3];
    dmb_vec3_cross(in->va + 3, in->va, near);
    dmb_vec3_add(near, in->aa, near);
    dmb_vec3_cross(in->vb + 3, in->vb, far);
    dmb_vec3_add(far, in->ab, far);
    dmb_vec3_set(dmb_real_of(0.0), near[1], near[2], near_across);
    dmb_vec3_set(dmb_real_of(0.0), far[1], far[2], far_across);
    dmb_mat3_vec(x + LOADS_FAR, far, far);
    dmb_mat3_vec(x + LOADS_FAR, far_across, far_across);
    for (int i = 0; i < 3; i++)
        x[LOADS_GROWTH + i] = m->mass * (near[i] - far[i]) + m->mud * (near_across[i] - far_across[i]);
}

DMB_LANES_INLINE void far_end_of(const dmb_beam_constants *c, const dmb_real d[6], dmb_real *x)
{
    dmb_se3_exp(d, NULL, x + LOADS_FAR, x + LOADS_FAR + 9);
    x[LOADS_FAR + 9] = x[LOADS_FAR + 9] + c->arm[0];
}

DMB_LANES_CALL int32_t end_loads(dmb_beam_args *args, dmb_end_loads *loads)
{
    const dmb_beam_task task = {0.0,          0.0, args->dynamic, 0, 0,   args->dynamic && args->damped,
                                args->damped, 0,   args->arms,    0, NULL};
    lane_types types;
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        const lane_group g = group_at(first, args->count);
        dmb_beam_input in;
        dmb_beam_output out;
        dmb_real x[LOADS_NUMBERS];
        load_masses m = {dmb_real_of(0.0), dmb_real_of(0.0), dmb_real_of(0.0), dmb_real_of(0.0)};
        load_types(args, &g, first == 0, &types);
        for (int i = 0; i < 6; i++) in.va[i] = in.vb[i] = in.aa[i] = in.ab[i] = dmb_real_of(0.0);
        load_input(args, &task, &g, &in);
        if (dmb_beam_element(&task, &types.constants, &types.curved, &in, &out) < 0) return -1;
        for (int l = 0; l < DMB_REAL_LANES; l++) {
            const dmb_element_type *type = args->types + types.type[l];
            dmb_real_set_lane(&m.half, l, 0.5 * type->weight_mass);
            dmb_real_set_lane(&m.arm, l, type->length / 6.0);
            dmb_real_set_lane(&m.mass, l, type->mass_per_metre * type->length);
            dmb_real_set_lane(&m.mud, l, type->mud_per_metre * type->length);
        }
        far_end_of(&types.constants, out.strain, x);
        loads_of(args, &types.constants, &in, &m, &out, x);
        growth_of(&in, &m, x);
        for (uint32_t l = 0; l < g.used; l++) {
            double numbers[LOADS_NUMBERS];
            for (int i = 0; i < LOADS_NUMBERS; i++) numbers[i] = dmb_real_lane(x + i, (int)l);
            memcpy(loads + first + l, numbers, sizeof numbers);
        }
    }
    return 0;
}

/* ---- Nodes ------------------------------------------------------------------------------------------------------- */

/* H1 = H0 exp(z) */
static void advance(dmb_node_args *args)
{
    dmb_real turned = dmb_real_of(args->turned);
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        const lane_group g = group_at(first, args->count);
        dmb_real q[4], u[3], z[6];
        load(args->start_quaternion, 4, 4, &g, 0, q);
        load(args->start_displacement, 3, 3, &g, 0, u);
        load(args->increment, 6, 6, &g, 0, z);
        dmb_se3_advance(q, u, z);
        turned = dmb_real_max(dmb_vec3_norm_squared(z + 3), turned);
        store(q, 4, &g, args->quaternion);
        store(u, 3, &g, args->displacement);
    }
    for (int l = 0; l < DMB_REAL_LANES; l++) args->turned = fmax(args->turned, dmb_real_lane(&turned, l));
}

/* Unwraps the rotation angle to the revolution predicted by the increment of the step. */
static void turns(const dmb_turn_args *args)
{
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        const lane_group g = group_at(first, args->count);
        dmb_real from[4], to[4], q[4], start, z[6];
        load(args->reference, 4, 4, &g, 0, from);
        load(args->quaternion, 4, 4, &g, 0, to);
        load(args->increment, 6, 6, &g, 0, z);
        load(args->start, 1, 1, &g, 0, &start);
        dmb_quat_between(from, to, q);
        const dmb_real turn = dmb_quat_twist(q, start + z[3]);
        store(&turn, 1, &g, args->turn);
    }
}

/* Rotates both vectors of a node about x by the relative angle of the two frames. */
static void twist(const dmb_twist_args *args)
{
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        const lane_group g = group_at(first, args->count);
        dmb_real from[4], to[4], q[4], x[6];
        load(args->from, 4, 4, &g, 0, from);
        load(args->to, 4, 4, &g, 0, to);
        load(args->rows, 6, 6, &g, 0, x);
        dmb_quat_between(to, from, q);
        dmb_quat_twist_pair(q, x);
        store(x, 6, &g, args->rows);
    }
}

/* K <- K T6(z) + C (eq:integration.iteration-matrix) */
static void matrices(const dmb_matrix_args *args)
{
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        const lane_group g = group_at(first, args->count);
        dmb_real z[6], K[36], C[36];
        dmb_se3_tangent T;
        load(args->increment, 6, 6, &g, 0, z);
        load_block(args->stiffness, &g, K);
        dmb_se3_tangent_at(z, NULL, &T);
        dmb_se3_times_tangent(K, 6, &T);
        load_block(args->inertia, &g, C);
        dmb_mat6_add(K, C, K);
        store_block(K, &g, args->stiffness);
    }
}

/* ---- Blocks: as wide as the compiler makes them for this processor ----------------------------------------------- */

static int64_t factor(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first, uint32_t count)
{
    return factor_blocks(layout, matrix, first, count);
}

static void solve(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                  double *rhs)
{
    solve_blocks(layout, matrix, first, count, rhs);
}

static int64_t factor_end(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                          int32_t part)
{
    return factor_part(layout, matrix, first, count, part);
}

static void solve_towards_middle(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first,
                                 uint32_t count, int32_t part, double *rhs)
{
    towards_part(layout, matrix, first, count, part, rhs);
}

static void solve_from_middle(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first,
                              uint32_t count, int32_t part, double *rhs)
{
    away_part(layout, matrix, first, count, part, rhs);
}

extern const dmb_kernels DMB_KERNELS;
const dmb_kernels DMB_KERNELS = {.lanes = DMB_REAL_LANES,
                                 .beams = beams,
                                 .end_loads = end_loads,
                                 .axial_torsional_elements = axial_torsional_elements,
                                 .axial_torsional_nodes = axial_torsional_nodes,
                                 .extrapolate = extrapolate,
                                 .node_forces = node_forces,
                                 .walls = walls,
                                 .walls_inside = walls_inside,
                                 .advance = advance,
                                 .turns = turns,
                                 .twist = twist,
                                 .predict = predict,
                                 .correct = correct,
                                 .matrices = matrices,
                                 .squares = squares,
                                 .product = product,
                                 .magnitude = magnitude,
                                 .negate = negate,
                                 .powers = powers,
                                 .factor = factor,
                                 .solve = solve,
                                 .factor_part = factor_end,
                                 .towards_part = solve_towards_middle,
                                 .away_part = solve_from_middle,
                                 .responses = responses,
                                 .jointed_responses = jointed_responses};
