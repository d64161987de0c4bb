/* Nodes side by side: rigid masses, weight and external damping; and the rows of all nodes: prediction, correction. */
#ifndef DMB_KERNEL_LANES_NODE_H
#define DMB_KERNEL_LANES_NODE_H

#include <stddef.h>
#include <string.h>

#include "element/rigid_mass.h"
#include "force/weight_and_damping.h"
#include "kernel/kernels.h"
#include "kernel/lane_group.h"

/* Nodes of a group, with their contributions to rows and blocks. */
typedef struct node_group {
    lane_group place;
    dmb_real v[6], residual[6], scale[6];
    dmb_real C[36]; /* inertia block */
} node_group;

static inline void node_apply(const dmb_real force[6], node_group *g)
{
    for (int i = 0; i < 6; i++) {
        g->residual[i] = g->residual[i] - force[i];
        g->scale[i] = g->scale[i] + dmb_real_abs(force[i]);
    }
}

/* Rigid masses are stored in the order of their nodes; *next becomes the first that is not before the group. Returns 1
 * if it is on one of the group's nodes. */
static inline int has_rigid_masses(const dmb_node_force_args *args, const lane_group *g, uint32_t *next)
{
    while (*next < args->rigid_mass_count && args->rigid_masses[*next].node < args->first + g->first) (*next)++;
    return *next < args->rigid_mass_count &&
           args->rigid_masses[*next].node <= args->first + place_at(g, DMB_REAL_LANES - 1);
}

/* 1 if each node of the group has one rigid mass. */
static inline int has_mass_each(const dmb_node_force_args *args, const lane_group *g, uint32_t next)
{
    uint32_t other = 0;
    if (!is_whole(g) || args->rigid_mass_count - next < DMB_REAL_LANES) return 0;
    for (uint32_t l = 0; l < DMB_REAL_LANES; l++)
        other |= args->rigid_masses[next + l].node ^ (args->first + g->first + l);
    return other == 0;
}

_Static_assert(offsetof(dmb_rigid_mass, inertia) == 4 * sizeof(double), "mass, moment, inertia");

/* Constants of the rigid_masses on a group of nodes, from `next` on; 0 where there is none. */
static inline void load_rigid_masses(const dmb_node_force_args *args, const lane_group *g, uint32_t next,
                                     dmb_rigid_mass_constants *c)
{
    enum { NUMBERS = sizeof(dmb_rigid_mass) / sizeof(double) };
    static const dmb_rigid_mass none;
    dmb_rigid_mass rigid_masses[DMB_REAL_LANES];
    const dmb_rigid_mass *from = args->rigid_masses + next;
    dmb_real constants[10];
    if (!has_mass_each(args, g, next)) {
        for (uint32_t l = 0; l < DMB_REAL_LANES; l++) {
            const size_t node = args->first + place_at(g, l);
            while (next < args->rigid_mass_count && args->rigid_masses[next].node < node) next++;
            const int has = next < args->rigid_mass_count && args->rigid_masses[next].node == node;
            rigid_masses[l] = has ? args->rigid_masses[next] : none;
        }
        from = rigid_masses;
    }
    load_together((const double *)(const void *)from, NUMBERS, 10, constants);
    c->mass = constants[0];
    for (int i = 0; i < 3; i++) c->moment[i] = constants[1 + i];
    for (int i = 0; i < 6; i++) c->inertia[i] = constants[4 + i];
}

/* f = M v' - v^^T p */
DMB_LANES_INLINE void add_rigid_masses(dmb_node_force_args *args, uint32_t next, int tangent, node_group *g)
{
    dmb_rigid_mass_constants rigid_mass;
    dmb_real a[6], f[6], p[6], gyroscopic[6];
    load_rigid_masses(args, &g->place, next, &rigid_mass);
    load(args->acceleration, 6, 6, &g->place, 0, a);
    dmb_rigid_mass_momentum(&rigid_mass, a, f);
    add_each(-dmb_vec6_dot(g->v, f), &g->place, &args->inertia_power);
    dmb_rigid_mass_momentum(&rigid_mass, g->v, p);
    dmb_ad_transpose(g->v, p, gyroscopic);
    for (int i = 0; i < 6; i++) f[i] = -f[i];
    node_apply(f, g); /* one by one: on a free body these two are all that balances */
    node_apply(gyroscopic, g);
    if (tangent) dmb_rigid_mass_add_tangent(&rigid_mass, g->v, p, args->mass_factor, args->velocity_factor, g->C);
}

static inline void store_weight_tangent(const dmb_node_force_args *args, const lane_group *g, const dmb_real force[6],
                                        const dmb_real by_rotation[9])
{
    const dmb_real zero = dmb_real_of(0.0), *f = force;
    const dmb_real rows[6][4] = {{zero, zero, f[2], -f[1]},
                                 {zero, -f[2], zero, f[0]},
                                 {zero, f[1], -f[0], zero},
                                 {zero, -by_rotation[0], -by_rotation[1], -by_rotation[2]},
                                 {zero, -by_rotation[3], -by_rotation[4], -by_rotation[5]},
                                 {zero, -by_rotation[6], -by_rotation[7], -by_rotation[8]}};
    double *to[DMB_REAL_LANES];
    for (int l = 0; l < DMB_REAL_LANES; l++) to[l] = args->stiffness + 36 * place_at(g, (uint32_t)l) + 2;
    for (uint32_t i = 0; i < 6; i++) add_four(rows[i], lanes_used(g), to, 6 * i);
}

static inline void add_weight(dmb_node_force_args *args, int tangent, node_group *g)
{
    dmb_real q[4], R[9], mass, moment[3], force[6], by_rotation[9];
    load(args->quaternion, 4, 4, &g->place, 0, q);
    dmb_quat_to_matrix(q, R);
    mass = load_line(args->weight_mass, &g->place);
    load(args->weight_moment, 3, 3, &g->place, 0, moment);
    dmb_vec3_scale(dmb_real_of(args->load_factor), moment, moment);
    dmb_weight_at(args->gravity, R, args->load_factor * mass, moment, force, by_rotation);
    node_apply(force, g);
    if (args->dynamic) add_each(dmb_vec6_dot(force, g->v), &g->place, &args->potential);
    if (tangent) store_weight_tangent(args, &g->place, force, by_rotation);
}

static inline void add_damping(dmb_node_force_args *args, int tangent, node_group *g)
{
    dmb_real c[5], force[6];
    load(args->damping, 5, 5, &g->place, 0, c);
    dmb_damping_force(c, g->v, force);
    node_apply(force, g);
    add_each(dmb_vec6_dot(force, g->v), &g->place, &args->damping_power);
    if (tangent) dmb_damping_add_tangent(c, args->velocity_factor, g->C);
}

DMB_LANES_INLINE void node_forces_of(dmb_node_force_args *args, int tangent)
{
    uint32_t next = 0;
    for (uint32_t first = 0; first < args->count; first += DMB_REAL_LANES) {
        node_group g;
        g.place = group_at(first, args->count);
        const int rigid_masses = has_rigid_masses(args, &g.place, &next),
                  inertia = tangent && (rigid_masses || args->damping);
        load(args->residual, 6, 6, &g.place, 0, g.residual);
        load(args->scale, 6, 6, &g.place, 0, g.scale);
        for (int i = 0; i < 6; i++) g.v[i] = dmb_real_of(0.0);
        if (args->dynamic) load(args->velocity, 6, 6, &g.place, 0, g.v);
        if (inertia) load_block(args->inertia, &g.place, g.C);
        if (rigid_masses) add_rigid_masses(args, next, inertia, &g);
        if (args->gravity) add_weight(args, tangent, &g);
        if (args->damping) add_damping(args, inertia, &g);
        store(g.residual, 6, &g.place, args->residual);
        store(g.scale, 6, &g.place, args->scale);
        if (inertia) store_block(g.C, &g.place, args->inertia);
    }
}

/* Specialised for evaluations without tangent, which are most. */
static void node_forces(dmb_node_force_args *args)
{
    if (args->tangent)
        node_forces_of(args, 1);
    else
        node_forces_of(args, 0);
}

/* Loops over rows, vectorised by the compiler. gcc does not vectorise loops with many run-time alias checks and ignores
 * restrict on local pointers. */
#if defined(__GNUC__) && !defined(__clang__)
#define DMB_LANES_APART _Pragma("GCC ivdep")
#else
#define DMB_LANES_APART
#endif

/* Generalized-alpha with constant acceleration (eq:integration.newmark): a0 carried over from the last step, which
 * may have had another length (ratio), a1 from a0 and v', then v1 = v + h ((1 - gamma) a0 + gamma a1) and the increment
 * z = h v + h^2 ((1/2 - beta) a0 + beta a1). Nothing overlaps, so that the loops vectorise. */
static void predict_constant(const dmb_predict_args *args)
{
    const double h = args->step, ratio = args->ratio, a_a0 = args->a_from_a0, a_dv = args->a_from_dv;
    const double v_a0 = args->v_from_a0, v_a1 = args->v_from_a1, z_a0 = args->z_from_a0, z_a1 = args->z_from_a1;
    const double *restrict now_v = args->now_velocity, *restrict now_dv = args->now_acceleration,
                           *restrict now_a = args->now_pseudo_acceleration;
    double *restrict v = args->velocity, *restrict dv = args->acceleration, *restrict a = args->pseudo_acceleration,
                     *restrict z = args->increment;
    DMB_LANES_APART
    for (uint32_t i = 0; i < args->count; i++) {
        const double a0 = now_dv[i] + ratio * (now_a[i] - now_dv[i]), a1 = a_dv * now_dv[i] + a_a0 * a0;
        dv[i] = now_dv[i];
        a[i] = a1;
        v[i] = now_v[i] + v_a0 * a0 + v_a1 * a1;
        z[i] = h * now_v[i] + (z_a0 * a0 + z_a1 * a1);
    }
}

/* The same from an acceleration that changes by slope (a0 - v0') (eq:integration.prediction). */
static void predict_linear(const dmb_predict_args *args)
{
    const double h = args->step, ratio = args->ratio, a_a0 = args->a_from_a0, a_dv = args->a_from_dv;
    const double v_a0 = args->v_from_a0, v_a1 = args->v_from_a1, z_a0 = args->z_from_a0, z_a1 = args->z_from_a1;
    const double slope = args->slope, a_more = args->a_from_change, z_more = args->z_from_change;
    const double *restrict now_v = args->now_velocity, *restrict now_dv = args->now_acceleration,
                           *restrict now_a = args->now_pseudo_acceleration;
    double *restrict v = args->velocity, *restrict dv = args->acceleration, *restrict a = args->pseudo_acceleration,
                     *restrict z = args->increment, *restrict change = args->change;
    DMB_LANES_APART
    for (uint32_t i = 0; i < args->count; i++) {
        const double apart = ratio * (now_a[i] - now_dv[i]), a0 = now_dv[i] + apart, more = slope * apart;
        const double a1 = a_dv * now_dv[i] + a_a0 * a0 + a_more * more;
        dv[i] = now_dv[i] + more;
        a[i] = a1;
        v[i] = now_v[i] + v_a0 * a0 + v_a1 * a1;
        z[i] = h * now_v[i] + (z_a0 * a0 + z_a1 * a1);
        change[i] = z_more * more;
    }
}

static void predict(const dmb_predict_args *args)
{
    if (args->slope != 0.0)
        predict_linear(args);
    else
        predict_constant(args);
}

/* z, v, v' and a follow a correction of the increment by constant factors. */
static void correct(const dmb_correct_args *args)
{
    const double to_v = args->to_velocity, to_dv = args->to_acceleration, to_a = args->to_pseudo_acceleration;
    const double *restrict z = args->correction;
    double *restrict v = args->velocity, *restrict dv = args->acceleration, *restrict a = args->pseudo_acceleration,
                     *restrict increment = args->increment;
    for (uint32_t i = 0; i < args->count; i++) {
        increment[i] += z[i];
        v[i] += to_v * z[i];
        dv[i] += to_dv * z[i];
        a[i] += to_a * z[i];
    }
}

static const uint8_t every_row[DMB_SQUARES] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};

/* Rows i .. i + count - 1 into the sums beside them. */
static inline void add_squares(uint32_t count, const double *restrict residual, const double *restrict scale,
                               const uint8_t *restrict solved, double *restrict rest, double *restrict all)
{
    if (memcmp(solved, every_row, count) == 0) {
        for (uint32_t c = 0; c < count; c++) rest[c] += residual[c] * residual[c];
        for (uint32_t c = 0; c < count; c++) all[c] += scale[c] * scale[c];
        return;
    }
    for (uint32_t c = 0; c < count; c++) {
        rest[c] += solved[c] ? residual[c] * residual[c] : 0.0;
        all[c] += solved[c] ? scale[c] * scale[c] : 0.0;
    }
}

/* Sums of r^2 and of the scales' squares of the solved rows, in DMB_SQUARES sums side by side, whatever the width. */
static void squares(uint32_t count, const double *residual, const double *scale, const uint8_t *solved,
                    double rest[DMB_SQUARES], double all[DMB_SQUARES])
{
    double r[DMB_SQUARES] = {0.0}, s[DMB_SQUARES] = {0.0};
    uint32_t i = 0;
    for (; i + DMB_SQUARES <= count; i += DMB_SQUARES)
        add_squares(DMB_SQUARES, residual + i, scale + i, solved + i, r, s);
    if (i < count) add_squares(count - i, residual + i, scale + i, solved + i, r, s);
    memcpy(rest, r, sizeof r);
    memcpy(all, s, sizeof s);
}

/* ---- Sums of products: DMB_SQUARES sums side by side, in lanes ----------------------------------------------------
 */

enum { SUM_LANES = DMB_SQUARES / DMB_REAL_LANES };

typedef struct lane_sums {
    dmb_real of[SUM_LANES];
} lane_sums;

static inline void begin_sums(lane_sums *sums)
{
    for (int k = 0; k < SUM_LANES; k++) sums->of[k] = dmb_real_of(0.0);
}

static inline double sum_of(const lane_sums *sums)
{
    double sum = 0.0;
    for (int k = 0; k < SUM_LANES; k++)
        for (int l = 0; l < DMB_REAL_LANES; l++) sum += dmb_real_lane(&sums->of[k], l);
    return sum;
}

DMB_LANES_INLINE dmb_real numbers_at(const double *from, int k)
{
    dmb_real x;
    memcpy(&x, from + DMB_REAL_LANES * k, sizeof x);
    return x;
}

/* The numbers behind the last whole DMB_SQUARES, and zeros. */
static inline void rest_of(uint32_t count, const double *from, double rest[DMB_SQUARES])
{
    for (uint32_t c = 0; c < DMB_SQUARES; c++) rest[c] = c < count ? from[c] : 0.0;
}

DMB_LANES_INLINE void add_products(const double *a, const double *b, lane_sums *sums)
{
    for (int k = 0; k < SUM_LANES; k++) sums->of[k] = sums->of[k] + numbers_at(a, k) * numbers_at(b, k);
}

static double product(uint32_t count, const double *a, const double *b)
{
    lane_sums sums;
    double x[DMB_SQUARES], y[DMB_SQUARES];
    uint32_t i = 0;
    begin_sums(&sums);
    for (; i + DMB_SQUARES <= count; i += DMB_SQUARES) add_products(a + i, b + i, &sums);
    rest_of(count - i, a + i, x);
    rest_of(count - i, b + i, y);
    add_products(x, y, &sums);
    return sum_of(&sums);
}

DMB_LANES_INLINE void add_magnitudes(const double *a, lane_sums *sums)
{
    for (int k = 0; k < SUM_LANES; k++) sums->of[k] = sums->of[k] + dmb_real_abs(numbers_at(a, k));
}

static double magnitude(uint32_t count, const double *a)
{
    lane_sums sums;
    double x[DMB_SQUARES];
    uint32_t i = 0;
    begin_sums(&sums);
    for (; i + DMB_SQUARES <= count; i += DMB_SQUARES) add_magnitudes(a + i, &sums);
    rest_of(count - i, a + i, x);
    add_magnitudes(x, &sums);
    return sum_of(&sums);
}

/* In place, too. */
static void negate(uint32_t count, const double *from, double *to)
{
    for (uint32_t i = 0; i < count; i++) to[i] = -from[i];
}

/* [W] of the residual and of the forces without regard to sign, at the speeds given. */
DMB_LANES_INLINE void add_powers_at(const double *residual, const double *scale, const double *velocity,
                                    lane_sums *left, lane_sums *exchanged)
{
    for (int k = 0; k < SUM_LANES; k++) {
        const dmb_real v = numbers_at(velocity, k);
        left->of[k] = left->of[k] + numbers_at(residual, k) * v;
        exchanged->of[k] = exchanged->of[k] + dmb_real_abs(numbers_at(scale, k) * v);
    }
}

static void powers(dmb_power_args *args)
{
    lane_sums left, exchanged;
    begin_sums(&left);
    begin_sums(&exchanged);
    for (uint32_t i = 0; i < args->count; i += DMB_SQUARES) {
        const uint32_t rows = args->count - i < DMB_SQUARES ? args->count - i : DMB_SQUARES;
        const uint8_t *solved = args->solved + i;
        double r[DMB_SQUARES], s[DMB_SQUARES], v[DMB_SQUARES];
        if (rows == DMB_SQUARES && memcmp(solved, every_row, DMB_SQUARES) == 0) {
            add_powers_at(args->residual + i, args->scale + i, args->velocity + i, &left, &exchanged);
            continue;
        }
        rest_of(rows, args->residual + i, r);
        rest_of(rows, args->scale + i, s);
        for (uint32_t c = 0; c < DMB_SQUARES; c++) v[c] = c < rows && solved[c] ? args->velocity[i + c] : 0.0;
        add_powers_at(r, s, v, &left, &exchanged);
    }
    args->left = sum_of(&left);
    args->exchanged = sum_of(&exchanged);
}

#endif
