/* The map of a sim: every array of the state and of the work memory, the file that writes it, its shape and unit. The
 * X-macro lists below define the memory layout, snapshot, restore and hash, and the test of the layout; there is no
 * other list of these arrays (struct dmb_sim adds options, messages and handles, which are not state). Each saved field
 * names the check that its bytes in a snapshot must pass (run/snapshot.c): a snapshot may be forged, and no step may
 * read or write out of bounds by what it says. n = scene->node_count, r = row_count, s = site_count (contact points),
 * p = axial_torsional_site_count, e = element_count, d = drive_count, sb, pb = s, p with a law of friction that has a
 * memory of zs numbers, else 0; pf = p with friction, else 0; law = law_count; st = s with damping that jumps at touch,
 * else 0; u = unilateral_count, ur = r where there are any, else 0; ns = n where there are contact points or any of
 * those, else 0; kd, kl, kn: see the factors; piece = most chunks of one loop (sim/chunks); k = bit_count, act =
 * actuator_count, delay = delay_count, load = load_count, force = force_count, fs, spare = force_states and the most of
 * one force, stuck = stuck_count, cut = stations at which cutters widen the hole, held = constrained_count, input =
 * input_count, event = event_count, history = history_count, chain = chain_count, f = free_rigid_count, ro =
 * rotor_count, diagonal and link = lengths of block storage; j = joint_count, c = constraint_row_count, cluster =
 * cluster_count (constraint components), column = cluster_column_count, jacobian, tangent = lengths of their storage,
 * and for a scene with joints only: raw = row_count, dense, square, full = storage of the components, block, value,
 * pivots = of the reduced system, sparse_... = of sparse components. */
#ifndef DMB_SIM_SIM_H
#define DMB_SIM_SIM_H

#include "base/message.h"
#include "drillmbd/analyse.h"
#include "kernel/kernels.h"
#include "model/model.h"

enum { DMB_PAST_GAP = 0, DMB_PAST_TIME = 1, DMB_PAST_END = 2, DMB_PAST_END_TIME = 3, DMB_PAST_SIZE = 4 };

/* Accepted or trial state of a drive, doubles alone (system/assemble/drives). Speed and rate are those of a driven
 * joint coordinate, 0 of other drives. */
typedef struct dmb_drive_variables {
    double position; /* [m, rad] of the driven component since time 0 */
    double integral; /* [m, rad] integral of the speed error of a CONTROL drive */
    double target;   /* [unit of the time function] commanded value */
    double force;    /* [N, N m] on the part */
    double speed;    /* [m/s, rad/s] */
    double rate;     /* [m/s2, rad/s2] prescribed acceleration */
} dmb_drive_variables;

/* ---- Configuration: kept twice, as `now` (accepted) and `trial`; a step writes trial and swaps on acceptance.
 * X(type, name, count, check) */
/* clang-format off */
#define DMB_CONFIGURATION_LIST(X)                                                                                     \
    /* poses by system/assemble/evaluation, speeds by integrator/step_motion and integrator/trial_step, both from     \
       the increments; of free rigid bodies system/assemble/free_rigid; prescribed by system/assemble/drives; on      \
       joints by system/constrain/cluster_projection, system/constrain/cluster_assembly, in axes that do not spin     \
       with them by system/constrain/rotor; at the start and at jumps by system/constrain/cluster_placement,          \
       system/start, system/jump, system/bounce_end: */                                                               \
    X(double, displacement, 3 * n, NUMBERS)     /* [m] six-DOF nodes: world, from reference_position;                 \
                                                   axial-torsional nodes: [0] along the axis */                       \
    X(double, quaternion, 4 * n, NUMBERS)       /* [-] six-DOF nodes: body to world, scalar first, unit;              \
                                                   axial-torsional nodes: as at time 0 */                             \
    X(double, turn, n, NUMBERS)                 /* [rad] about the node's own x axis since time 0, revolutions        \
                                                   counted */                                                         \
    X(double, velocity, r, NUMBERS)             /* [m/s, rad/s] body frame; axial-torsional: along and about the      \
                                                   axis */                                                            \
    X(double, acceleration, r, NUMBERS)         /* [m/s2, rad/s2] time derivative of velocity */                      \
    X(double, pseudo_acceleration, r, NUMBERS)  /* [m/s2, rad/s2] the a of generalized-alpha; in load steps of        \
                                                   statics the increments of the one reached */                       \
    /* system/assemble/wall_contact, from pose and velocity: */                                                       \
    X(double, site_normal, 3 * s, NUMBERS)      /* [-] world, last normal that was defined */                         \
    X(double, site_depth, s, NUMBERS)           /* [m] measured depth of the closest axis point */                    \
    X(uint32_t, site_segment, s, SEGMENTS)      /* [-] segment of the hole's axis it was found in */                  \
    X(double, site_penetration, s, NUMBERS)     /* [m] < 0: gap; system/assemble/wall_contact, where a hole is        \
                                                   widened system/assemble/hole_cut, of a state that is set           \
                                                   analysis/state_equation/state_equation */                          \
    X(double, site_impact_speed, s, NUMBERS)    /* [m/s] normal speed at the start of the present contact */          \
    X(double, site_slip, 2 * s, NUMBERS)        /* [m/s] along the axis and around it */                              \
    X(double, site_bristle, zs * sb, NUMBERS)   /* [m] bristle deflection, same directions; state of the caller's     \
                                                   law */                                                             \
    X(int32_t, site_sticks, sb, FLAGS)          /* [-] 1 while the bristle law holds it */                            \
    X(double, site_touch, DMB_TOUCH_SIZE * st, NUMBERS) /* [-, s, -, N/m] of force/normal_law: touch within a step */ \
    X(double, friction_slip, 2, NUMBERS)        /* [m/s, rad/s] assumed sliding speeds, axial and rotational, for     \
                                                   wall friction in a static state; 0: velocities of the nodes */     \
    X(double, axial_torsional_slip, 2 * p, NUMBERS) /* [m/s] likewise of axial-torsional nodes */                     \
    X(double, axial_torsional_friction, 2 * pf, NUMBERS) /* [N] assemble/nodes_axial_torsional; at jumps              \
                                                            system/assemble/ledger_work */                            \
    X(double, axial_torsional_bristle, zs * pb, NUMBERS) /* [m] */                                                    \
    X(int32_t, axial_torsional_sticks, pb, FLAGS) /* [-] */                                                           \
    /* system/assemble/drives, from time functions and velocity: */                                                   \
    X(dmb_drive_variables, drives, d, NUMBERS)  /* state of each drive: system/assemble/drives, of a state that is    \
                                                   set analysis/state_equation/state_equation */                      \
    X(double, actuator, 4 * act, NUMBERS)       /* [N, N m] dmb_actuator_flow of drives with one:                     \
                                                   system/assemble/actuators */                                       \
    X(double, load_factor, load, NUMBERS)       /* [-] time function of each load */                                  \
    X(double, bit_load, k, NUMBERS)             /* [N] bottom-hole load of each bit */                                \
    /* system/assemble/bit: */                                                                                        \
    X(double, bit_bottom, k, NUMBERS)           /* [m] advance at which rock begins */                                \
    X(double, bit_advance, k, NUMBERS)          /* [m] along the hole since time 0 */                                 \
    X(uint32_t, bit_segment, k, SEGMENTS)       /* [-] */                                                             \
    X(double, bit_force, 4 * k, NUMBERS)        /* [N, N m] of the rock, along the axis, about it, across it:         \
                                                   system/assemble/bit; at jumps system/assemble/ledger_work */       \
    X(double, bit_speed, 4 * k, NUMBERS)        /* [m/s, rad/s] the same directions: system/assemble/bit; at jumps    \
                                                   system/assemble/ledger_work */                                     \
    /* system/assemble/bounces, of stops and springs that may open: */                                                \
    X(double, bounce_place, u, NUMBERS)         /* [m, rad] coordinate of the joint, elongation of the spring */      \
    X(double, bounce_force, u, NUMBERS)         /* [N, N m] force of the law there, against growing coordinates */    \
    X(double, bounce_speed, u, NUMBERS)         /* [m/s, rad/s] of the coordinate: system/assemble/bounces,           \
                                                   system/bounce_end */                                               \
    X(double, law_speed, law, NUMBERS)          /* [m/s, rad/s] of coordinates with a law:                            \
                                                   system/assemble/joint_forces; at jumps                             \
                                                   system/assemble/ledger_work */                                     \
    X(double, force_potential, force, NUMBERS)  /* [J] of the callers' forces: system/assemble/caller_force */        \
    X(double, force_state, fs, NUMBERS)         /* of their laws: system/assemble/caller_force */                     \
    /* system/constrain/joint_motion, from pose: */                                                                   \
    X(double, joint_turn, 2 * j, NUMBERS)       /* [rad] RX and RY, revolutions counted:                              \
                                                   system/constrain/joint_state, of a state that is set               \
                                                   analysis/state_equation/state_equation_pose */                     \
    X(double, joint_depth, j, NUMBERS)          /* [m] measured depth of the point of a joint on the hole's axis */   \
    X(uint32_t, joint_segment, j, JOINT_SEGMENTS) /* [-] segment of the axis it was found in */                       \
    /* system/constrain/cluster, of sparse ones system/constrain/sparse_cluster, from the residual; put back by        \
       analysis/static/softest: */                                                                                    \
    X(double, multiplier, c, NUMBERS)           /* [N, N m] residual + B^T multiplier = 0 */
/* clang-format on */

/* ---- Memory: kept once, written on acceptance only. Saved, restored and hashed like `now`. */
/* clang-format off */
#define DMB_MEMORY_LIST(X)                                                                                            \
    X(dmb_clock, clock, 1, CLOCK)               /* times, step lengths: system/bounce_end, integrator/trial_step,     \
                                                   integrator/step, system/start,                                     \
                                                   analysis/state_equation/state_equation; powers:                    \
                                                   system/assemble/ledger */                                          \
    X(dmb_ledger, ledger, 1, LEDGER)            /* [J] accumulated, system/assemble/ledger */                         \
    X(dmb_counters, counters, 1, COUNTERS)      /* [-] system/bounce_end, integrator/trial_step, integrator/step,     \
                                                   system/start, system/constrain/cluster_projection,                 \
                                                   system/constrain/cluster_assembly, system/constrain/cluster */     \
    X(dmb_prediction, prediction, 1, PREDICTION) /* integrator/prediction */                                          \
    X(double, bounce_age, u, NUMBERS)           /* [-] steps since touch, 0: open, < 0: integrated by itself:         \
                                                   system/bounce_end, system/assemble/bounces */                      \
    X(uint8_t, site_age, s, AGES)               /* [-] steps since touch, DMB_SITE_OWN more: integrated by itself:    \
                                                   system/bounce_end, system/assemble/bounces */                      \
    X(double, support_reaction, held, NUMBERS)  /* [N, N m] residual of the accepted state in constrained rows:       \
                                                   system/assemble/evaluation */                                      \
    X(double, drive_work, d, NUMBERS)           /* [J] system/assemble/ledger */                                      \
    X(double, drive_input, d, INPUTS)           /* [unit of the time function] value set by the caller; NaN: the      \
                                                   time function: run/inputs, run/life */                             \
    X(double, delay_line, 2 * DMB_DELAY_SAMPLES * delay, NUMBERS) /* [s] and [N, N m] samples of the commands of      \
                                                                     each drive with a delay:                         \
                                                                     system/assemble/actuators */                     \
    X(double, input_value, input, SET_INPUTS)   /* [unit of the target] set by the caller; NaN: the time function:    \
                                                   run/inputs, sim/own_scene; when a stuck place is released          \
                                                   system/jump */                                                     \
    X(double, input_begin, 3 * input, NUMBERS)  /* [s, unit, unit/s] start of the transition to the value: time,      \
                                                   value, rate: run/inputs, sim/own_scene */                          \
    X(double, event_since, event, EVENT_TIMES)  /* [s] time of the crossing, from which the hold time counts; NaN:    \
                                                   not beyond the level; infinite: already reported, or beyond the    \
                                                   level when the call began: run/events */                           \
    X(double, event_side, event, NUMBERS)       /* [-] > 0: above its level last, < 0: below; 0: neither yet:         \
                                                   run/events */                                                      \
    X(double, event_past, DMB_PAST_SIZE * event, NUMBERS) /* of events in equal steps: the output less its level, and     \
                                                   time [s], at the start of the last step and at its end:            \
                                                   run/events */                                                      \
    X(double, history_angle, history, NUMBERS)  /* [rad] samples of the cut surface, system/assemble/bit */           \
    X(double, history_surface, history, NUMBERS) /* [m] system/assemble/bit */                                        \
    X(dmb_history_head, history_head, k, HISTORY_HEADS) /* system/assemble/bit */                                     \
    X(double, hole_widening, cut, NUMBERS)      /* [m] of the hole's radius at stations, system/assemble/hole_cut,    \
                                                   run/state_transfer */                                              \
    X(int32_t, joint_state, j, JOINT_STATES)    /* DMB_JOINT_..., system/constrain/joint_state */                     \
    X(int32_t, stuck_held, stuck, FLAGS)        /* [-] 1 while the place is stuck: system/assemble/stuck */           \
    X(double, stuck_anchor, 12 * stuck, NUMBERS) /* [-, m] R and x of the place where it got stuck:                   \
                                                    system/assemble/stuck */                                          \
    X(double, joint_lock, 12 * j, NUMBERS)      /* [-, m] R and p of frame b in frame a where the joint was           \
                                                   locked: system/constrain/joint_motion */                           \
    X(double, constraint_offset, c, NUMBERS)    /* [m, rad] what a coupling keeps:                                    \
                                                   system/constrain/cluster_assembly */                               \
    X(double, drive_offset, d, NUMBERS)         /* [m, rad] coordinate of a driven joint at time 0:                   \
                                                   system/constrain/cluster_assembly */                               \
    /* system/constrain/cluster, of sparse ones system/constrain/sparse_cluster; put back after another was tried     \
       analysis/state_equation/state_equation: */                                                                     \
    X(uint32_t, partition_rank, cluster, RANKS) /* [-] dependent columns */                                           \
    X(uint32_t, partition_row, c, ROW_ORDER)    /* [-] rows of a cluster, pivot rows first */                         \
    X(uint32_t, partition_column, column, COLUMN_ORDER) /* [-] columns of a cluster, dependent ones first */          \
    X(double, partition_quality, cluster, NUMBERS) /* [-] of the choice when it was made */
/* clang-format on */

/* ---- Kept: factors of an iteration matrix that later steps may reuse (integrator/newton). Written on acceptance only;
 * saved, restored and hashed, so that a restored sim iterates identically. Not part of `backup`: a step that may be
 * reverted does not change them. Empty in a scene with joints: kd, kl = diagonal, link, else 0; kn = n where there are
 * contact points too, else 0. */
/* clang-format off */
#define DMB_FACTOR_LIST(X)                                                                                            \
    /* system/solve/solve: */                                                                                         \
    X(double, reused_diagonal, kd, NUMBERS)                                                                           \
    X(double, reused_lower, kl, NUMBERS)                                                                              \
    X(double, reused_upper, kl, NUMBERS)                                                                              \
    X(double, reused_quaternion, 4 * kn, FRAMES) /* of the nodes where they were made */                              \
    X(dmb_factor_reuse, reuse, 1, REUSE)        /* integrator/newton; cleared by system/solve/solve */
/* clang-format on */

/* ---- Work: rewritten in every step, never saved. X(type, name, count) */
/* clang-format off */
#define DMB_WORK_LIST(X)                                                                                              \
    X(double, increment, r)                     /* [m, rad] h Dq of the step: integrator/step_motion; onto joints     \
                                                   system/constrain/cluster_projection, at the start                  \
                                                   system/constrain/cluster_assembly,                                 \
                                                   system/constrain/cluster_placement, prescribed                     \
                                                   system/assemble/drives; of statics analysis/static/static_move */  \
    X(double, turned_squared, n / DMB_GRAIN + 1) /* [rad2] largest squared rotation in the step of the nodes of       \
                                                    each chunk: system/assemble/evaluation */                         \
    X(double, rigid_motion, 18 * f)             /* of free rigid bodies at their centres of mass,                     \
                                                   system/assemble/free_rigid */                                      \
    X(dmb_rotor_step, rotor_step, ro)           /* of bodies on joints that may spin: system/constrain/rotor */       \
    /* residual, matrix by the files of system/assemble/, system/bounce_end, forces of constraint                     \
       system/constrain/cluster, system/constrain/sparse_cluster, of rotors system/constrain/rotor; torques of        \
       free rotations taken out by analysis/static/static_spin; shifted by analysis/static/softest; factors in        \
       their place by system/solve/solve: */                                                                          \
    X(double, residual, r)                      /* [N, N m] of the trial */                                           \
    X(double, correction, r)                    /* [m, rad] solution of the linear system: of Newton, or with the     \
                                                   mass matrix [m/s2, rad/s2] of accelerations:                       \
                                                   system/solve/solve; to increments given:                           \
                                                   integrator/step_motion; shortened by                               \
                                                   analysis/static/static_newton; without free rotations:             \
                                                   analysis/static/static_spin; halved: integrator/newton; pulls      \
                                                   and stretches: analysis/static/static_guess */                     \
    X(double, chain_start, chain)               /* [N2] square of the residual a step begins with:                    \
                                                   system/solve/solve; would begin with:                              \
                                                   system/assemble/inertia_of_change */                               \
    X(double, scale_row, r)                     /* [N, N m] sum of magnitudes of the terms of each row */             \
    X(double, element_strain, 6 * e)            /* [m, rad] d of the trial */                                         \
    X(double, element_stress, 6 * e)            /* [N, N m] stress for the geometric stiffness of the next            \
                                                   iteration */                                                       \
    X(double, site_history, s)                  /* > 0 [m/s]: separation speed of a contact that opens in the         \
                                                   step; < 0 [N]: minus the mean force in the history of the step;    \
                                                   else 0: system/jump, system/assemble/bounces */                    \
    X(int32_t, sites_bounce, 1)                 /* 1: some contact point does not resolve touch or has a mean         \
                                                   force: system/assemble/bounces, integrator/companion */            \
    X(int32_t, laws_bounce, 1)                  /* 1: a stop or spring has had a mean force in the step:              \
                                                   system/assemble/bounces, integrator/companion */                   \
    X(uint8_t, site_coarse, s)                  /* DMB_SITE_..., 0: the step resolves touch:                          \
                                                   system/assemble/bounces, integrator/companion */                   \
    X(uint8_t, site_mode, s)                    /* DMB_BOUNCE_..., DMB_SITE_STAYS: system/assemble/bounces,           \
                                                   system/bounce_end, integrator/companion */                         \
    X(uint8_t, site_presses, s)                 /* 1: normal force > 0 in the trial: system/assemble/wall_contact */  \
    X(uint8_t, bounce_mode, u)                  /* DMB_BOUNCE_...: system/assemble/bounces, integrator/companion */   \
    X(uint8_t, bounce_turns, u)                 /* 1: the step does not resolve the law, whose gradient turns:        \
                                                   system/assemble/bounces_holding, integrator/companion */           \
    X(double, bounce_own, u)                    /* [N, N m] mean force of the step: system/assemble/bounces */        \
    X(double, bounce_warmth, u)                 /* [W] dissipated by its damper: system/assemble/bounces */           \
    X(uint8_t, bounce_stays, u)                 /* 1: the next step has a mean force, too: system/bounce_end */       \
    X(double, bounce_bias, u)                   /* [m/s, rad/s] rate of the place at the ends of steps with a mean    \
                                                   force, less the speed: system/bounce_end */                        \
    X(double, bounce_kick, ur)                  /* [m/s, rad/s] change of the velocity by laws that take over:        \
                                                   system/bounce_end */                                               \
    X(double, bounce_taken, ur)                 /* [m/s2, rad/s2] acceleration by the mean forces:                    \
                                                   system/bounce_end */                                               \
    X(double, bounce_given, ur)                 /* [m/s2, rad/s2] acceleration by the forces of the laws:             \
                                                   system/bounce_end */                                               \
    X(double, bounce_rows, ur)                  /* [N, N m] residual: system/bounce_end, system/assemble/bounces */   \
    X(double, released_power, 1)                /* [W] friction of contacts that open, times the fraction of the      \
                                                   step after the opening: system/jump */                             \
    X(double, released_part, ns)                /* [-] fraction of the step after the opening, of the node:           \
                                                   system/jump */                                                     \
    X(double, stiffness_diagonal, diagonal)     /* by body-frame pose increments; then the iteration matrix */        \
    X(double, stiffness_lower, link)            /* in statics the same; in a step it already is the iteration         \
                                                   matrix */                                                          \
    X(double, stiffness_upper, link)                                                                                  \
    X(double, inertia_diagonal, diagonal)       /* mass, gyroscopic and damping parts, scaled to pose parameters */   \
    X(dmb_seam, seam, piece)                    /* of elements computed in chunks: system/assemble/elements */        \
    X(dmb_chunk_sums, chunk_sums, piece)        /* system/assemble/elements, system/assemble/nodes,                   \
                                                   system/assemble/wall_contact */                                    \
    X(dmb_chunk_squares, chunk_squares, piece)  /* system/solve/solve */                                              \
    X(int64_t, end_singular, 2 * chain)         /* first singular block of both ends of chains factored in            \
                                                   parallel, or -1: system/solve/solve */                             \
    X(uint8_t, pivot, r)                        /* LU factors only */                                                 \
    X(int32_t, factors, 1)                      /* DMB_FACTORS_...: present factors: system/solve/solve,              \
                                                   integrator/newton, integrator/trial_step */                        \
    /* integrator/step_motion, system/constrain/cluster_projection: */                                                \
    X(double, raw_velocity, raw)                /* of the trial before it is projected onto the constraints */        \
    X(double, raw_acceleration, raw)                                                                                  \
    X(double, raw_pseudo_acceleration, raw)                                                                           \
    X(double, switch_change, raw)               /* [m/s, rad/s] of speeds where a joint switches, system/jump */      \
    X(double, switch_momentum, raw)             /* [N s, N m s] -M times the change, system/jump */                   \
    /* constraints, by system/constrain/constraint_rows and system/constrain/constraint_rows_callback: */             \
    X(uint8_t, constraint_type, c)              /* DMB_ROW_... */                                                     \
    X(double, constraint_value, c)              /* [m, -] violation; 0 of a row of speeds */                          \
    X(double, constraint_rate, c)               /* [m/s, ...] B v + rate = 0 */                                       \
    X(double, constraint_convective, c)         /* [m/s2, ...] B v' + convective = 0 */                               \
    X(double, constraint_jacobian, jacobian)                                                                          \
    X(double, constraint_tangent, tangent)      /* of joint forces, of springs and of B^T multiplier, by pose         \
                                                   parameters: system/assemble/joint_forces,                          \
                                                   system/assemble/point_motion; cleared by                           \
                                                   system/assemble/evaluation; without stiffness:                     \
                                                   system/solve/solve */                                              \
    /* clusters, by system/constrain/cluster and system/constrain/sparse_cluster; of a state that is set              \
       analysis/state_equation/state_equation_pose: */                                                                \
    X(double, cluster_weight, column)           /* [-, 1/m] unit of each column; 0: constrained */                    \
    X(double, cluster_metric, column)           /* [-, 1/m] unit of each column in projections */                     \
    X(uint32_t, cluster_place, column)          /* [-] place of each column in partition_column */                    \
    X(double, cluster_matrix, dense)            /* B of each cluster */                                               \
    X(double, cluster_lu, square)                                                                                     \
    X(double, cluster_gram, square)                                                                                   \
    X(uint32_t, cluster_pivot, c)                                                                                     \
    X(double, cluster_null, dense)              /* G of the factored matrix: system/solve/reduced_system */           \
    X(double, cluster_quality, cluster)                                                                               \
    X(double, cluster_scratch, dense + c + column)                                                                    \
    X(double, cluster_rows, c)                                                                                        \
    X(double, cluster_move, column)             /* a projection, a vector in the columns of a cluster */              \
    X(double, cluster_full, full)               /* iteration matrix before its reduction:                             \
                                                   system/solve/reduced_system */                                     \
    X(double, cluster_half, full)               /* system/solve/reduced_system */                                     \
    /* reduced system, by system/solve/reduced_system and system/solve/reduced_system_sparse: */                      \
    X(double, reduced_value, value)                                                                                   \
    X(uint32_t, reduced_pivot, pivots)                                                                                \
    X(uint32_t, reduced_size, block)                                                                                  \
    X(uint32_t, reduced_row, block)                                                                                   \
    X(double, reduced_solution, pivots)                                                                               \
    X(double, reduced_half, 6 * (column + c))   /* product of an off-diagonal block with the null space of a block */ \
    /* sparse clusters, by system/constrain/sparse_cluster: */                                                        \
    X(double, sparse_value, sparse_values)                                                                            \
    X(double, sparse_length, sparse_rows)       /* squared length of a row of B; after factorisation the pivot        \
                                                   over it */                                                         \
    X(double, sparse_vector, sparse_rows)                                                                             \
    X(double, raw_residual, sparse_raw)         /* residual with the forces of the present multipliers */             \
    X(double, sparse_gradient, sparse_raw)      /* residual of the least-norm multipliers, by nodes:                  \
                                                   system/constrain/sparse_cluster_least_norm */                      \
    X(double, sparse_scale, sparse_c)           /* [N/m, ...] factor of each row:                                     \
                                                   system/solve/reduced_system_sparse */                              \
    X(uint32_t, sparse_slot, sparse_c)          /* place of each row in its block; DMB_NONE: not chosen */            \
    X(uint32_t, sparse_size, sparse_block)      /* number of rows of each block: nodes and multipliers */             \
    X(uint32_t, sparse_plus, sparse_block)      /* of them, rows of the node */                                       \
    X(uint32_t, sparse_row, sparse_block)                                                                             \
    X(dmb_reduced_mode, reduced_mode, 1)        /* written by whoever detects a violation: system/, integrator/,      \
                                                   analysis/, run/ */                                                 \
    X(double, force_spare, spare)               /* state of a call at an argument nearby:                             \
                                                   system/assemble/caller_force */                                    \
    X(double, input_before, 4 * input)          /* value and start of transition, while a call sets some:             \
                                                   run/inputs */                                                      \
    X(uint8_t, backup, backup)                  /* the state before a call of more than one step: sim/layout */
/* clang-format on */

/* Factors with which corrections are solved: none, inverses of this step, inverses of an earlier step (both
 * math/block_inverse), LU factors (math/block_tridiagonal: statics). */
enum { DMB_FACTORS_NONE = 0, DMB_FACTORS_FRESH = 1, DMB_FACTORS_REUSED = 2, DMB_FACTORS_LU = 3 };

/* Kinds of constraint rows. */
enum { DMB_ROW_IDLE = 0, DMB_ROW_POSITION = 1, DMB_ROW_SPEED = 2 };

/* State of the equations of joints and of the reduced system at present. */
typedef struct dmb_reduced_mode {
    int32_t bordered; /* 1: the last reduced system has all coordinates and multipliers as unknowns (KKT) */
    uint32_t row;     /* constraint row that could not be satisfied, for messages; DMB_NONE: none */
    uint32_t force; /* 1 + number of the caller's force that failed last, or of forces: friction of the wall; 0: none */
    int32_t metric; /* 1: sparse_value has factors of the present rows, for projections */
    int32_t near_redundant; /* 1: some rows are near-redundant */
    double violation;       /* its violation */
    double length;          /* [m] length scale of displacements: the longest jointed chain */
    double size;            /* [m] largest magnitude of positions at the start, for bounds of rounding */
} dmb_reduced_mode;

typedef struct dmb_clock {
    double time;       /* [s] */
    double rest;       /* [s] compensation of the sum of steps, time + rest (Kahan 1965) */
    double breakpoint; /* [s] breakpoints of time functions up to here are passed, including one that is an ulp after
                          `time` */
    double step;       /* [s] length of the last accepted step; 0 before the first */
    double next_step;  /* [s] proposal of the step control; 0: none yet */
    double power[8];   /* [W] of the accepted state, DMB_POWER_... */
} dmb_clock;

/* Terms of power: ledger and clock.power share the numbering. The first three are rates of energies. */
enum {
    DMB_POWER_INERTIA = 0,
    DMB_POWER_POTENTIAL = 1, /* strain, gravity, wall stiffness */
    DMB_POWER_LOADS = 2,
    DMB_POWER_DRIVES = 3,
    DMB_POWER_FRICTION = 4,
    DMB_POWER_IMPACT = 5,
    DMB_POWER_DAMPING = 6,
    DMB_POWER_ROCK = 7,
    DMB_POWER_COUNT = 8
};

/* The energy balance is stored at times spaced by this fraction of the elapsed time, so that the last but one is older
 * than a tenth of the run. Each evaluation costs O(nodes). */
#define DMB_LEDGER_SPACING 0.25
enum { DMB_LEDGER_MARKS = 2 };

typedef struct dmb_ledger {
    double work[8];                    /* [J] integral of each power, trapezoidal */
    double input;                      /* [J] integral of |drives| + |loads| */
    double start;                      /* [J] kinetic + potential energy at the start */
    double since;                      /* [s] time of the start */
    double mark[2 * DMB_LEDGER_MARKS]; /* [s], [J] balance at earlier times, the last one first */
} dmb_ledger;

typedef struct dmb_counters {
    uint64_t steps, rejected, iterations, limited;
    uint64_t most_iterations;
    double largest_residual;
    double projection[2];
    double assembly[2];
    uint64_t switches;
    uint64_t bounces; /* touch and release within fewer than ten steps */
    uint64_t carried; /* 1: a state transfer has placed supports elsewhere than described */
} dmb_counters;

enum { DMB_PAUSE_MAX = 31 }; /* [steps] longest back-off of reused factors, of linear predictions */
typedef struct dmb_factor_reuse {
    double step;          /* [s] length of the step for which they were computed; 0: no factors */
    uint32_t pause;       /* remaining steps of the back-off, which do not try them */
    uint32_t back_off;    /* length of the next back-off */
    uint32_t corrections; /* fewest corrections of a step with them; 0: none yet */
    uint32_t excess;      /* sum of corrections beyond that */
} dmb_factor_reuse;

/* Choice of the initial guess of a step (integrator/prediction). */
typedef struct dmb_prediction {
    uint32_t constant; /* iterations of the last step with constant prediction; 0: none yet */
    uint32_t pause;    /* remaining steps with constant prediction */
    uint32_t back_off; /* length of the next pause, after a linear prediction that saves no iteration */
    uint32_t reserved;
} dmb_prediction;

typedef struct dmb_history_head {
    uint32_t head, count;
    double offset; /* [rad] */
} dmb_history_head;

/* A body on joints in a step, in axes that rotate with its spin at the start (system/constrain/rotor.h). */
typedef struct dmb_rotor_step {
    double spin[6];         /* [m/s, rad/s] its spin at the start, as a velocity of the node, body frame */
    double length;          /* [s] of the step */
    double R[9], x[3];      /* [-], [m] those axes seen from the node at the start */
    double start[18];       /* speed but for the spin, acceleration, pseudo-acceleration of the start, shape (3, 6) */
    double displacement[3]; /* [m] of the trial, but for the increment */
    double quaternion[4];   /* [-] likewise */
} dmb_rotor_step;

#define DMB_WORK_FIELD(type, name, count) type *name;
#define DMB_FIELD(type, name, count, check) type *name;
typedef struct dmb_configuration {
    DMB_CONFIGURATION_LIST(DMB_FIELD)
} dmb_configuration;

/* The caller's progress function and the progress of the running call; neither saved nor hashed. sim/access */
typedef struct dmb_progress {
    dmb_progress_fn function; /* NULL: no callback */
    void *context;
    double done;       /* [-] fraction of the outer call */
    double from, to;   /* [-] range of the running call within the outer call */
    int32_t cancelled; /* 1: it ends */
    int32_t nested;    /* [-] nesting depth */
} dmb_progress;

/* The log of inputs that were set; neither saved nor hashed. run/inputs */
typedef struct dmb_input_log {
    dmb_input_record *records; /* the caller's; NULL: none */
    uint32_t capacity, count;
    uint32_t calls; /* [-] number of calls that have set an input */
    uint32_t reserved;
} dmb_input_log;

/* Sums over a chunk (sim/chunks), and the element that failed; DMB_NONE: none. */
typedef struct dmb_chunk_sums {
    double rounding;                                      /* [N2] */
    double potential, damping, inertia, impact, friction; /* [W] */
    uint32_t failed, reserved;
} dmb_chunk_sums;

/* Sums of squares of the residual and of its terms, side by side (kernels->squares). */
typedef struct dmb_chunk_squares {
    double rest[DMB_SQUARES], all[DMB_SQUARES];
} dmb_chunk_squares;

/* Processes the items first .. end - 1. */
typedef void (*dmb_range_fn)(void *work, uint32_t first, uint32_t end);

enum { DMB_CHUNK_DUE = 0, DMB_CHUNK_BEGUN = 1, DMB_CHUNK_DONE = 2 };

/* Work that runs in chunks on threads of the caller; neither saved nor hashed. sim/chunks */
typedef struct dmb_chunks {
    int32_t open;   /* 1: the running step may use the caller's threads */
    int32_t failed; /* 1: the caller's function did not run all chunks, or reported failure */
    int32_t status; /* its return value then; done of asked: how many chunks it ran */
    uint32_t done, asked;
    uint32_t parts;        /* [-] number of chunks of the running loop; 0: none */
    uint32_t count, grain; /* number of items, and grain: chunks are multiples of it */
    dmb_range_fn make;
    void *work;
    uint8_t mark[DMB_PARALLEL_MAX]; /* DMB_CHUNK_... */
} dmb_chunks;

struct dmb_trial_step;

/* Observer that is called before each step is accepted; a negative status rejects the step (analysis/sensitivity).
 * Neither saved nor hashed. */
typedef struct dmb_follower {
    int32_t (*follow)(void *context, const struct dmb_trial_step *trial_step);
    void (*open)(void *context); /* contacts open in the trial step, which is repeated; reads sim->increment */
    void *context;
} dmb_follower;

struct dmb_sim {
    uint32_t magic;
    int32_t owns_memory; /* 1: block came from `allocator` */
    int32_t busy;        /* DMB_BUSY_...: a call is running; neither saved nor hashed */
    int32_t reserved;
    uint64_t calls; /* counts calls that change the sim, to identify the call of a failure */
    dmb_model *model;
    const dmb_scene *scene;
    dmb_sim_options options;
    dmb_allocator allocator;
    void *block;
    size_t block_size;
    dmb_message message;
    dmb_progress *progress; /* own_progress; in a copy for an analysis, that of the original sim */
    dmb_progress own_progress;
    struct dmb_own_scene *own; /* sim/own_scene: the scene of a sim with inputs; NULL: the model's scene */
    dmb_input_log input_log;
    const dmb_follower *follower; /* NULL: none */
    dmb_step_fn on_step;          /* the caller's, after accepted steps; NULL: none; neither saved nor hashed */
    void *on_step_context;
    dmb_chunks *chunks; /* own_chunks: progress of the threads; may be written through a const sim */
    dmb_chunks own_chunks;
    dmb_configuration now, trial;
    DMB_MEMORY_LIST(DMB_FIELD)
    DMB_FACTOR_LIST(DMB_FIELD)
    DMB_WORK_LIST(DMB_WORK_FIELD)
};
#undef DMB_FIELD
#undef DMB_WORK_FIELD

/* A call that runs callbacks (time functions, constraints, allocator, path) marks its sim busy, which prevents changes
 * by these callbacks. READABLE: the accepted state is complete and queries are allowed; CHANGING: queries fail. */
enum { DMB_BUSY_NOT = 0, DMB_BUSY_READABLE = 1, DMB_BUSY_CHANGING = 2 };

/* 1: not retried: cancelled, failed callback, or out of memory. */
static inline int dmb_is_final(int32_t status)
{
    return status == DMB_ERR_CALLBACK || status == DMB_ERR_CANCELLED || status == DMB_ERR_NO_MEMORY;
}

#endif
