/* Axial-torsional elements (eq:bar.force) side by side: row after row of their nodes, in which stretch and twist take
 * turns. */
#ifndef DMB_KERNEL_LANES_AXIAL_TORSIONAL_H
#define DMB_KERNEL_LANES_AXIAL_TORSIONAL_H

#include "kernel/kernels.h"
#include "kernel/lane_group.h"

/* Sums in eight parts, row i in part i % 8, whatever the width: their order is that of all widths. */
enum { SUM_PARTS = 8 / DMB_REAL_LANES };

typedef struct lane_sum {
    dmb_real part[SUM_PARTS];
} lane_sum;

/* Lanes that repeat the last row count nothing. */
static inline void sum_add(dmb_real x, const lane_group *g, lane_sum *sum)
{
    const size_t part = g->first / DMB_REAL_LANES % SUM_PARTS;
    for (uint32_t l = g->used; l < DMB_REAL_LANES; l++) dmb_real_set_lane(&x, (int)l, 0.0);
    sum->part[part] = sum->part[part] + x;
}

static inline double sum_total(const lane_sum *sum)
{
    double total = 0.0;
    for (int i = 0; i < SUM_PARTS; i++)
        for (int l = 0; l < DMB_REAL_LANES; l++) total += dmb_real_lane(sum->part + i, l);
    return total;
}

/* Constants of the bar and coordinate of each lane; kept from group to group while these are the same. */
typedef struct axial_torsional_constants {
    uint32_t key[DMB_REAL_LANES]; /* 0: none yet */
    dmb_real stiffness, damping;  /* [N/m, N m/rad], times damping_time */
    dmb_real rest;                /* [m, rad] deformation at the start */
    dmb_real per_length;          /* [1, 1/m] */
    dmb_real mass[2];             /* [kg, kg m2] AA = BB, AB */
} axial_torsional_constants;

static inline void load_axial_torsional(const dmb_axial_torsional_args *args, const dmb_element_type *type, int torsion,
                                        int l, axial_torsional_constants *c)
{
    const double stiffness = type->stiffness[torsion ? 3 : 0], *mass = torsion ? type->mass.torsion : type->mass.axial;
    dmb_real_set_lane(&c->stiffness, l, stiffness);
    dmb_real_set_lane(&c->damping, l, type->damping_time * stiffness);
    dmb_real_set_lane(&c->rest, l, torsion ? -type->rest[3] : type->length - type->rest[0]);
    dmb_real_set_lane(&c->per_length, l, torsion ? args->per_length : 1.0);
    dmb_real_set_lane(c->mass, l, mass[0]);
    dmb_real_set_lane(c->mass + 1, l, mass[1]);
}

/* True if the loaded constants are those of the group's elements: all of one type, none cut off at the end. */
static inline int are_same_axial_torsional(const dmb_axial_torsional_args *args, const lane_group *g,
                                           const axial_torsional_constants *c)
{
    uint32_t other = g->used < DMB_REAL_LANES || DMB_REAL_LANES == 1 ? 1 : 0;
    for (uint32_t l = 0; l < DMB_REAL_LANES && other == 0; l += 2)
        other |= c->key[l] ^ (1 + 2 * args->type[(g->first + l) / 2]);
    return other == 0;
}

static inline void load_axial_torsional_group(const dmb_axial_torsional_args *args, const lane_group *g,
                                              axial_torsional_constants *c)
{
    if (are_same_axial_torsional(args, g, c)) return;
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const uint32_t type = args->type[place_at(g, (uint32_t)l) / 2], torsion = place_at(g, (uint32_t)l) & 1,
                       key = 1 + 2 * type + torsion;
        if (c->key[l] == key) continue;
        c->key[l] = key;
        load_axial_torsional(args, args->types + type, (int)torsion, l, c);
    }
}

/* [m, rad] Displacement along and rotation about the axis of the node `after` nodes behind that of each row. */
static inline dmb_real load_place(const dmb_axial_torsional_args *args, const lane_group *g, size_t after)
{
    dmb_real x = dmb_real_of(0.0);
    if (DMB_REAL_LANES > 1 && is_whole(g)) { /* in pairs: groups begin with the first row of a node */
        const double *u = args->displacement + 3 * (g->first / 2 + after), *turn = args->turn + g->first / 2 + after;
        for (int l = 0; l < DMB_REAL_LANES; l++) dmb_real_set_lane(&x, l, l & 1 ? turn[l / 2] : u[3 * (l / 2)]);
        return x;
    }
    for (int l = 0; l < DMB_REAL_LANES; l++) {
        const size_t node = place_at(g, (uint32_t)l) / 2 + after;
        dmb_real_set_lane(&x, l, place_at(g, (uint32_t)l) & 1 ? args->turn[node] : args->displacement[3 * node]);
    }
    return x;
}

/* Forces on the far nodes of the last two groups' elements. They are added together with the forces of the next group
 * on the same nodes, which avoids store-forwarding stalls. */
typedef struct axial_torsional_ends {
    dmb_real residual[2], scale[2];
} axial_torsional_ends;

/* x shifted by two rows: the first two come from the groups before, which x then joins. */
static inline dmb_real two_rows_on(dmb_real x, dmb_real before[2])
{
#if DMB_REAL_LANES == 1
    const dmb_real on = before[0];
#elif !defined(DMB_LANES_TRANSPOSED)
    dmb_real on = x;
    for (int l = 0; l < DMB_REAL_LANES; l++)
        dmb_real_set_lane(&on, l, l < 2 ? dmb_real_lane(before + 1, DMB_REAL_LANES - 2 + l) : dmb_real_lane(&x, l - 2));
#elif DMB_LANES == 4
    const dmb_real on = __builtin_shufflevector(before[1], x, 2, 3, 4, 5);
#else
    const dmb_real on = __builtin_shufflevector(before[1], x, 6, 7, 8, 9, 10, 11, 12, 13);
#endif
    before[0] = before[1];
    before[1] = x;
    return on;
}

/* Adds the forces on the last node; `rows` of all elements. */
static inline void add_last(const dmb_real before[2], uint32_t rows, double *to)
{
    for (uint32_t i = 0; i < 2; i++)
        to[i] += DMB_REAL_LANES == 1 ? dmb_real_lane(before + i, 0)
                                     : dmb_real_lane(before + 1, (int)((rows - 2 + i) % DMB_REAL_LANES));
}

static inline void add_line(dmb_real a, dmb_real b, const lane_group *g, double *to)
{
    store_line((load_line(to, g) + b) + a, g, to);
}

/* Forces of an axial-torsional element on the rows of its nodes a and b, those of b shifted by two rows; their powers.
 */
typedef struct axial_torsional_forces {
    dmb_real elastic, viscous, mass_a, mass_b;
} axial_torsional_forces;

/* The length cancels analytically and is left out of the difference, which avoids cancellation. */
static inline dmb_real elastic_force(const dmb_axial_torsional_args *args, const lane_group *g,
                                     const axial_torsional_constants *c, lane_sum *rounding)
{
    const dmb_real xa = load_place(args, g, 0), xb = load_place(args, g, 1);
    const dmb_real size = c->stiffness * (c->per_length * (dmb_real_abs(xa) + dmb_real_abs(xb)));
    sum_add(size * size, g, rounding);
    return c->stiffness * ((xb - xa) + c->rest);
}

static inline void motion_forces(const dmb_axial_torsional_args *args, const lane_group *g,
                                 const axial_torsional_constants *c, lane_sum powers[3], axial_torsional_forces *f)
{
    const dmb_real va = load_line(args->velocity, g), vb = load_line(args->velocity + 2, g);
    const dmb_real aa = load_line(args->acceleration, g), ab = load_line(args->acceleration + 2, g);
    const dmb_real rate = vb - va;
    f->viscous = c->damping * rate;
    f->mass_a = c->mass[0] * aa + c->mass[1] * ab;
    f->mass_b = c->mass[1] * aa + c->mass[0] * ab;
    sum_add(f->elastic * rate, g, powers);
    sum_add(f->viscous * rate, g, powers + 1);
    sum_add(va * f->mass_a + vb * f->mass_b, g, powers + 2);
}

static inline void add_axial_torsional_forces(const dmb_axial_torsional_args *args, const lane_group *g,
                                              const axial_torsional_forces *f, axial_torsional_ends *ends)
{
    const dmb_real force = f->elastic + f->viscous, size = dmb_real_abs(force);
    add_line(f->mass_a - force, two_rows_on(f->mass_b + force, ends->residual), g, args->residual);
    add_line(size + dmb_real_abs(f->mass_a), two_rows_on(size + dmb_real_abs(f->mass_b), ends->scale), g, args->scale);
}

static void axial_torsional_elements(dmb_axial_torsional_args *args)
{
    const dmb_real zero = dmb_real_of(0.0);
    lane_sum rounding, powers[3];
    axial_torsional_constants constants;
    axial_torsional_ends ends = {{zero, zero}, {zero, zero}};
    memset(&constants, 0, sizeof constants);
    memset(&rounding, 0, sizeof rounding);
    memset(powers, 0, sizeof powers);
    for (uint32_t first = 0; first < 2 * args->count; first += DMB_REAL_LANES) {
        const lane_group g = group_at(first, 2 * args->count);
        axial_torsional_forces f = {zero, zero, zero, zero};
        load_axial_torsional_group(args, &g, &constants);
        f.elastic = elastic_force(args, &g, &constants, &rounding);
        if (args->dynamic) motion_forces(args, &g, &constants, powers, &f);
        add_axial_torsional_forces(args, &g, &f, &ends);
    }
    add_last(ends.residual, 2 * args->count, args->residual + 2 * (size_t)args->count);
    add_last(ends.scale, 2 * args->count, args->scale + 2 * (size_t)args->count);
    args->rounding += sum_total(&rounding);
    args->potential -= sum_total(powers);
    args->damping -= sum_total(powers + 1);
    args->inertia -= sum_total(powers + 2);
}

#endif
