/* The step's kernels over runs of equal parts. Every build contains them in several widths, the number of elements or
 * nodes processed in lanes. All widths give the same bits (math/real.h); the compile step selects the widest one
 * supported by the processor. */
#ifndef DMB_KERNEL_KERNELS_H
#define DMB_KERNEL_KERNELS_H

#include <stdint.h>

#include "element/element_type.h"
#include "force/contact_law.h"
#include "force/friction_law.h"
#include "force/hole.h"
#include "force/normal_law.h"
#include "math/block_pattern.h"
#include "math/block_tridiagonal.h"

/* Contribution to a node from the last element of a run, if the next element belongs to another run computed
 * concurrently. */
typedef struct dmb_seam {
    double residual[6], scale[6], stiffness[36], inertia[36];
} dmb_seam;

/* A run of beams: element i lies between the nodes i and i + 1 of the run, all of them six-DOF. Pointers are to the
 * run's first element, node, row or block. Rows and blocks of nodes are added to at both ends of the run, and written
 * between them, because elements are the first terms there. */
typedef struct dmb_beam_args {
    uint32_t count;  /* elements */
    uint32_t failed; /* out: the first element that turned too far */
    const dmb_element_type *types;
    const uint32_t *type;                  /* of each element */
    const double *span;                    /* [m] at time 0, shape (count, 3) */
    const double *displacement;            /* [m] shape (count + 1, 3) */
    const double *quaternion;              /* shape (count + 1, 4) */
    const double *velocity, *acceleration; /* shape (count + 1, 6) */
    const double *increment;               /* [m, rad] h Dq, shape (count + 1, 6) */
    double mass_factor, velocity_factor;   /* as in dmb_evaluation, as are: */
    int32_t dynamic, tangent, extrapolated, inertia_only, ledger;
    int32_t apart;            /* 1: the first node has no contributions yet and is written */
    int32_t damped, arms;     /* 1: some element of the scene has a damping time, rigid arms */
    int32_t curved;           /* 1: all elements of the run have the mass of curved elements */
    const double *gravity;    /* [m/s2] times the load factor, shape (3); NULL: none acts. Read if curved. */
    double *residual, *scale; /* shape (count + 1, 6) */
    double *strain;           /* written, shape (count, 6); NULL: it is not wanted */
    double *stress;           /* read if extrapolated, written by `extrapolate`, shape (count, 6) */
    double *stiffness_diagonal, *inertia_diagonal; /* shape (count + 1, 36) */
    double *upper, *lower; /* stiffness, or when dynamic the iteration matrix; written, shape (count, 36) */
    double rounding, potential, damping, inertia; /* added to: [N2], [W] */
    dmb_seam *seam;                               /* added to in place of the last node; NULL: that itself is */
} dmb_beam_args;

/* Of one straight element, for section forces (query/section_load). */
typedef struct dmb_end_loads {
    double strain[6]; /* [m, rad] d, relative pose of its ends */
    double load[12];  /* [N, N m] of the sections at both ends, each in its axes (eq:beam.section-force) */
    double far_rotation[9], far_at[3]; /* of end B in the axes of node A; [m] */
    double growth[3]; /* [N] inertia force of a section at B minus that at A, times the length; node A */
} dmb_end_loads;

/* A run of axial-torsional elements: element i lies between the nodes i and i + 1 of the run, all of them
 * axial-torsional. Pointers are to the run's first bar, node or row. */
typedef struct dmb_axial_torsional_args {
    uint32_t count;  /* bars */
    int32_t dynamic; /* as in dmb_evaluation */
    const dmb_element_type *types;
    const uint32_t *type;                         /* of each bar */
    const double *displacement;                   /* [m] shape (count + 1, 3), of which the first is along the axis */
    const double *turn;                           /* [rad] shape (count + 1) */
    const double *velocity, *acceleration;        /* shape (count + 1, 2) */
    double per_length;                            /* [1/m] makes angles comparable with displacements */
    double *residual, *scale;                     /* added to, shape (count + 1, 2) */
    double rounding, potential, damping, inertia; /* added to: [N2], [W] */
} dmb_axial_torsional_args;

/* Weight, damping and friction on a run of axial-torsional nodes. Pointers are to the run's first node, row, block or
 * contact point. */
typedef struct dmb_axial_torsional_node_args {
    uint32_t count;           /* nodes */
    int32_t dynamic, tangent; /* as in dmb_evaluation, as are: */
    int32_t weighs;           /* 1: their weight acts along the axis */
    double step, velocity_factor, load_factor;
    const double *gravity;                 /* [m/s2] (3) */
    const dmb_hole *hole;                  /* NULL: none */
    const double *depth;                   /* [m] measured, of displacement 0, shape (count) */
    const double *displacement;            /* [m] shape (count, 3), of which the first is along the axis */
    const double *quaternion;              /* at time 0, shape (count, 4) */
    const double *weight_mass;             /* [kg] shape (count) */
    const double *damping;                 /* node_damping of model/scene.h, shape (count, 5); NULL: none acts */
    const double *velocity;                /* shape (count, 2) */
    const dmb_axial_torsional_site *sites; /* one of each node; NULL: none */
    const dmb_friction_law *friction_law;  /* NULL: no friction acts */
    const double *tension;                 /* [N] at each node; read in a curved hole */
    double slip[2];                        /* [m/s, rad/s] in statics */
    const double *now_bristle, *now_slip;  /* of the last accepted instant, shape (count, 2); and: */
    const int32_t *now_sticks;
    int32_t *failed;                         /* raised to 1 where the caller's law fails */
    double *bristle, *trial_slip, *friction; /* of the trial, written, shape (count, 2); and: */
    int32_t *sticks;
    double *residual, *scale; /* added to, shape (count, 2) */
    double *inertia;          /* blocks, added to, shape (count, 4) */
    double *stiffness;        /* likewise; only its column by the depth, in a curved hole */
    double *by_tension;       /* written: dF/dT of both rows, shape (count, 2); NULL: not wanted */
    double potential, damping_power, friction_power; /* added to: [W] */
} dmb_axial_torsional_node_args;

/* A run of six-DOF nodes. */
typedef struct dmb_node_args {
    uint32_t count;
    uint32_t reserved;
    const double *increment; /* [m, rad] body frame, shape (count, 6) */
    const double *start_displacement, *start_quaternion;
    double *displacement, *quaternion; /* start moved by the increment */
    double turned;                     /* [rad2] raised to the square of the largest rotation */
} dmb_node_args;

/* Rigid masses, weight and external damping on a run of six-DOF nodes. Pointers are to the run's first node, row or
 * block. */
typedef struct dmb_node_force_args {
    uint32_t count;                     /* nodes */
    uint32_t first;                     /* index of the first node, for the indices in rigid_masses */
    const dmb_rigid_mass *rigid_masses; /* in the order of their nodes, none before the run; those behind it are left */
    uint32_t rigid_mass_count;          /* 0 in statics */
    int32_t dynamic, tangent;           /* as in dmb_evaluation, as are: */
    int32_t reserved;
    double mass_factor, velocity_factor, load_factor;
    const double *gravity;                     /* [m/s2] (3); NULL: none acts */
    const double *weight_mass, *weight_moment; /* [kg], [kg m] shapes (count), (count, 3) */
    const double *damping;                     /* node_damping of model/scene.h, shape (count, 5); NULL: none acts */
    const double *quaternion;                  /* shape (count, 4) */
    const double *velocity, *acceleration;     /* shape (count, 6) */
    double *residual, *scale;                  /* added to, shape (count, 6) */
    double *stiffness, *inertia;               /* added to, shape (count, 36) */
    double inertia_power, potential, damping_power; /* added to: [W] */
} dmb_node_force_args;

/* Fields of the contact points in a configuration: the fields site_... of sim/sim.h. */
typedef struct dmb_site_fields {
    double *normal, *depth, *penetration, *impact_speed, *slip, *bristle, *touch;
    uint32_t *segment;
    int32_t *sticks;
} dmb_site_fields;

/* Contact points whose touch and release a step does not resolve: COARSE ones bounce; PLASTIC ones, met slower than the
 * step's free fall, stay in contact: the energy stored in the wall is lost when they open. */
enum { DMB_SITE_COARSE = 1, DMB_SITE_PLASTIC = 2 };

/* Contact points at the wall. Pointers are to the scene's first contact point, node, row or block. */
typedef struct dmb_wall_args {
    uint32_t count;   /* sites */
    int32_t bristles; /* 1: the friction law has a memory; otherwise its fields are empty */
    int32_t touches;  /* 1: the damping of the wall jumps at touch; else the fields of touch are empty */
    int32_t bounces; /* 1: contact points have mean forces in the step: those with a mode, and coarse ones that touch */
    uint32_t states; /* numbers of the state of a contact point there */
    int32_t called;  /* 1: it is that of the caller's law */
    int32_t *failed; /* raised to 1 where the caller's law fails */
    const dmb_site *sites;
    const dmb_hole *hole;
    const dmb_normal_law *normal_law;
    const dmb_friction_law *friction_law;               /* NULL: no friction acts */
    const uint32_t *row, *diagonal;                     /* first row of each node, start of its diagonal block */
    const double *reference;                            /* [m] positions of the nodes at displacement 0 */
    const double *displacement, *quaternion, *velocity; /* of the trial */
    const double *now_quaternion, *now_velocity;        /* of the last accepted instant, and: */
    dmb_site_fields now;                                /* read */
    const double
        *site_history; /* of contact points with a changed history of the step; else 0. > 0 [m/s]: it opens in the step
                          and leaves the wall at that speed; < 0: less the mean force [N] in the history */
    const uint8_t *mode, *coarse; /* read if contact points have mean forces */
    dmb_site_fields trial;        /* written */
    uint8_t *presses;             /* written there: 1: with a force > 0 */
    double slip[2];               /* [m/s, rad/s] in statics */
    double softer;                /* [-] stiffness of sections is divided by it */
    /* [m2/N] penetration reduced by a mean force of 1 N/m, in the first evaluation of a step; else 0 */
    double yield;
    double slows;                             /* [m2/(N s)] speed reduced by it there */
    double step, velocity_factor, own_factor; /* as in dmb_evaluation, as are: */
    int32_t dynamic, tangent;
    double *residual, *scale;                     /* added to */
    double *stiffness, *inertia;                  /* diagonal blocks, added to */
    double rounding, potential, impact, friction; /* added to: [N2], [W] */
} dmb_wall_args;

/* Contact points inside elements: the near nodes are those of dmb_wall_args. Pointers are to the scene's first element,
 * node, row or block, or to the first contact point's fraction. */
typedef struct dmb_inside_args {
    const double *fraction; /* [-] of the flexible length, of each contact point, `stride` numbers apart */
    uint32_t stride;
    int32_t inertia_only; /* as in dmb_evaluation */
    const dmb_element_type *types;
    const uint32_t *element_type; /* of each element */
    const uint32_t *node_element; /* element between a node and the next */
    const double *span;           /* [m] at time 0, world frame, shape (elements, 3) */
    const double *now_displacement;
    const double *increment; /* [m, rad] of the step */
    const uint32_t *link;    /* start of the off-diagonal blocks between a node and the next */
    double *upper, *lower;   /* off-diagonal blocks, added to */
} dmb_inside_args;

static inline void dmb_site_fields_skip(const dmb_wall_args *args, uint32_t count, dmb_site_fields *fields)
{
    fields->normal += 3 * (size_t)count;
    fields->depth += count;
    fields->penetration += count;
    fields->impact_speed += count;
    fields->slip += 2 * (size_t)count;
    fields->segment += count;
    if (args->touches) fields->touch += DMB_TOUCH_SIZE * (size_t)count;
    if (!args->bristles) return;
    fields->bristle += args->states * (size_t)count;
    fields->sticks += count;
}
/* Advances the fields of contact points by that many. */
static inline void dmb_wall_args_skip(dmb_wall_args *args, uint32_t count)
{
    args->site_history += count;
    args->mode += count;
    args->coarse += count;
    args->presses += count;
    dmb_site_fields_skip(args, count, &args->now);
    dmb_site_fields_skip(args, count, &args->trial);
}

/* Rotation angles of six-DOF nodes about their own x axes. */
typedef struct dmb_turn_args {
    uint32_t count;
    uint32_t reserved;
    const double *reference, *quaternion; /* orientation at time 0 and now, shape (count, 4) */
    const double *increment;              /* [m, rad] of the step, shape (count, 6) */
    const double *start;                  /* [rad] turn at its start, shape (count) */
    double *turn;                         /* [rad] revolutions counted */
} dmb_turn_args;

/* Vectors of six-DOF nodes, given in one frame of each and wanted in another that is twisted about the node's x axis.
 */
typedef struct dmb_twist_args {
    uint32_t count;
    uint32_t reserved;
    const double *from, *to; /* quaternions of the two frames, shape (count, 4); only their twist counts */
    double *rows;            /* two vectors a node, shape (count, 6) */
} dmb_twist_args;

/* Rows at the start of a step (integrator/step_motion): with a0 = v0' + ratio (a - v0') of the accepted state, a1 =
 * a_from_dv v0' + a_from_a0 a0, v1 = v0 + v_from_a0 a0 + v_from_a1 a1, h Dq = h v0 + z_from_a0 a0 + z_from_a1 a1. */
typedef struct dmb_predict_args {
    uint32_t count;
    uint32_t reserved;
    double step, ratio;                                                      /* [s], [-] */
    double a_from_dv, a_from_a0, v_from_a0, v_from_a1, z_from_a0, z_from_a1; /* [-], [s], [s2] */
    double slope, a_from_change,
        z_from_change; /* [-], [-], [s2] of a change slope (a0 - v0') of v'; slope 0: it stays */
    const double *now_velocity, *now_acceleration, *now_pseudo_acceleration;
    double *velocity, *acceleration, *pseudo_acceleration, *increment; /* written */
    double *change; /* written where it does not stay: what the increment is more by */
} dmb_predict_args;

/* Rows moved by a correction of h Dq. */
typedef struct dmb_correct_args {
    uint32_t count;
    uint32_t reserved;
    double to_velocity, to_acceleration, to_pseudo_acceleration; /* [1/s], [1/s2] */
    const double *correction;
    double *velocity, *acceleration, *pseudo_acceleration, *increment; /* added to */
} dmb_correct_args;

/* Powers over the rows with solved[i] = 1, in DMB_SQUARES sums side by side. */
typedef struct dmb_power_args {
    uint32_t count;
    uint32_t reserved;
    const double *residual, *scale, *velocity;
    const uint8_t *solved;
    double left, exchanged; /* [W] out: sum residual[i] velocity[i], sum |scale[i] velocity[i]| */
} dmb_power_args;

/* Diagonal blocks of the iteration matrix of six-DOF nodes: K T6(z) + C. */
typedef struct dmb_matrix_args {
    uint32_t count;
    uint32_t reserved;
    const double *increment; /* [m, rad] z, shape (count, 6) */
    const double *inertia;   /* C, shape (count, 36) */
    double *stiffness;       /* K in, the block out; shape (count, 36) */
} dmb_matrix_args;

/* Number of frequencies of a response solved together, the same on every processor. */
#define DMB_FREQUENCIES 8

/* Blocks of M, C and K at the same offsets. */
typedef struct dmb_response_blocks {
    const double *mass, *damping, *stiffness;
} dmb_response_blocks;

/* One chain of A(w) x = b, A(w) = (1 + i eta) K + i w C - w^2 M, at the frequencies of a group. */
typedef struct dmb_response_args {
    uint32_t first, count; /* blocks of the chain, count >= 1 */
    uint32_t used;         /* frequencies, at most DMB_FREQUENCIES */
    uint32_t columns;      /* right-hand sides of each frequency, and their capacity: */
    uint32_t stride;
    uint32_t bad; /* out: one bit for each frequency at which a pivot is 0 or of rounding size: no x there */
    const dmb_block_layout *layout;
    dmb_response_blocks diagonal, lower, upper; /* of all chains, as in dmb_block_matrix */
    const uint8_t *solved;                      /* 0: the row is supported, shape (rows) */
    double structural_damping;                  /* [-] eta */
    double omega[DMB_FREQUENCIES];              /* [rad/s] w; numbers behind those that are used are read too */
    double *sides; /* b in, x out: shape (rows, stride, 2, DMB_FREQUENCIES), real parts and imaginary parts */
    double *work;  /* shape (numbers in the chain's `upper`, 2, DMB_FREQUENCIES) */
} dmb_response_args;

/* The jointed chains of A(w) x = b in independent coordinates, R^T A(w) R, at the frequencies of a group. */
typedef struct dmb_jointed_response_args {
    uint32_t used, columns, stride, bad; /* as in dmb_response_args */
    const dmb_block_pattern *pattern;    /* offsets of blocks without gaps */
    const uint32_t *size, *row;          /* of each block: coordinates, and the first of them */
    dmb_response_blocks blocks;          /* R^T M R, R^T C R, R^T K R, shape (values of the pattern) */
    const double *stiffness, *mass;      /* scales of pivots, by coordinates */
    double structural_damping;           /* as in dmb_response_args, as is: */
    double omega[DMB_FREQUENCIES];
    double *sides; /* b in, x out: shape (coordinates, stride, 2, DMB_FREQUENCIES) */
    double *work;  /* shape (values of the pattern + the widest block, 2, DMB_FREQUENCIES) */
} dmb_jointed_response_args;

/* Sums of squares computed in lanes: of four six-DOF nodes, of twelve axial-torsional nodes. */
#define DMB_SQUARES 24

typedef struct dmb_kernels {
    uint32_t lanes;
    uint32_t reserved;
    /* Forces and, if asked for, tangent blocks. Returns 0, or -1 with job->failed. */
    int32_t (*beams)(dmb_beam_args *args);
    /* Loads of straight elements, without the drag of mud: reads the inputs of forces and `gravity`, shape (3). Returns
     * 0, or -1. */
    int32_t (*end_loads)(dmb_beam_args *args, dmb_end_loads *loads);
    /* Forces. */
    void (*axial_torsional_elements)(dmb_axial_torsional_args *args);
    /* Forces and, if asked for, tangent blocks. */
    void (*axial_torsional_nodes)(dmb_axial_torsional_node_args *args);
    /* stress <- K (d - d0) + (K/L) P z over the correction z of the nodes (job->velocity), at job->strain. */
    void (*extrapolate)(const dmb_beam_args *args);
    void (*advance)(dmb_node_args *args);
    void (*turns)(const dmb_turn_args *args);
    void (*twist)(const dmb_twist_args *args);
    void (*predict)(const dmb_predict_args *args);
    void (*correct)(const dmb_correct_args *args);
    void (*matrices)(const dmb_matrix_args *args);
    /* rest[i % 24] = sum residual[i]^2, all[i % 24] = sum scale[i]^2 over the rows with solved[i] = 1 */
    void (*squares)(uint32_t count, const double *residual, const double *scale, const uint8_t *solved,
                    double rest[DMB_SQUARES], double all[DMB_SQUARES]);
    /* sum a[i] b[i], and sum |a[i]|, in DMB_SQUARES sums side by side */
    double (*product)(uint32_t count, const double *a, const double *b);
    double (*magnitude)(uint32_t count, const double *a);
    /* to[i] = -from[i] */
    void (*negate)(uint32_t count, const double *from, double *to);
    void (*powers)(dmb_power_args *args);
    /* as dmb_block_factor and dmb_block_solve, by the inverses of math/block_inverse.h */
    int64_t (*factor)(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first, uint32_t count);
    void (*solve)(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                  double *rhs);
    /* The same in parts: 0 from the first block, 1 from the last, both up to the neighbours of the middle one, then 2
     * the neighbours and the middle; back substitution proceeds from there in parts 0 and 1. */
    int64_t (*factor_part)(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                           int32_t part);
    void (*towards_part)(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                         int32_t part, double *rhs);
    void (*away_part)(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                      int32_t part, double *rhs);
    /* Forces and, if asked for, tangent blocks. */
    void (*node_forces)(dmb_node_force_args *args);
    /* Forces of touching contact points and, if requested, tangent blocks; contact fields of the trial. */
    void (*walls)(dmb_wall_args *args);
    /* The same inside elements whose nodes are six-DOF. */
    void (*walls_inside)(dmb_wall_args *args, const dmb_inside_args *inside);
    void (*responses)(dmb_response_args *args);
    void (*jointed_responses)(dmb_jointed_response_args *args);
} dmb_kernels;

/* The kernels of 1, 2, 4 or 8 lanes; NULL if the build or the processor does not support that width. */
const dmb_kernels *dmb_kernels_of(uint32_t lanes);
/* The widest kernels supported. */
const dmb_kernels *dmb_kernels_widest(void);

#endif
