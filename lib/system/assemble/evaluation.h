/* The equations of a scene: residual and tangent of the trial configuration.
 *
 *     residual = M v' - v^^T M v + g_internal - f_external = 0       (each node in its body frame)
 *
 * dmb_system_evaluate assembles all terms in a fixed order, and is the only list of them. */
#ifndef DMB_SYSTEM_ASSEMBLE_EVALUATION_H
#define DMB_SYSTEM_ASSEMBLE_EVALUATION_H

#include <math.h>

#include "sim/sim.h"

enum { DMB_STEADY_BITS = 32 };

typedef struct dmb_evaluation {
    dmb_sim *sim;           /* trial is read; work arrays are written */
    double time;            /* [s] of the trial */
    double step;            /* [s] from now to trial; 0 in statics */
    double breakpoint;      /* [s] breakpoint of a time function at the end of the step; 0: none */
    double inside;          /* [s] breakpoint of a time function inside the step, which is not divided there; 0: none */
    double mass_factor;     /* [1/s2] d v'/d pose parameters (eq:integration.factors) */
    double velocity_factor; /* [1/s] d v/d pose parameters */
    double pseudo_factor;   /* [-] d a/d v' of generalized-alpha, (1 - af)/(1 - am) */
    double own_factor;  /* [-] factor of the mean force of a step at its end: 1/(gamma pseudo_factor); 0: by the laws */
    double load_factor; /* [-] factor on gravity, loads and bit load (static load steps) */
    int32_t dynamic;    /* 0: statics, without inertia, damping and rates */
    int32_t tangent;    /* 1: also computes stiffness_ and inertia_ blocks */
    int32_t
        inertia_only;  /* 1: tangents of inertia and damping only, off-diagonal blocks of elements without stiffness */
    int32_t steady;    /* 1: bristles and rock as in steady sliding and drilling */
    uint32_t drilling; /* steady: bit mask of the drill bits that cut, of the first DMB_STEADY_BITS */
    int32_t extrapolated; /* 1: geometric stiffness with element_stress as it stands, 0: with the true stress */
    int32_t
        predicted; /* 1: the trial does not contain mean forces of contacts yet: their tangents act (eq:contact.mean) */
    int32_t given; /* 1: multipliers of the trial are unknowns and used as they are; 0: they balance the residual */
    int32_t assembling;   /* 1: initial coordinates of joints are also equations, couplings and joint drives are not */
    int32_t slipping;     /* statics: friction acts as at the speed slip[] */
    int32_t turn_halves;  /* statics: the symmetric part alone of the stiffness of forces that turn with the depth
                             (eq:motion.turn) */
    double wall_softness; /* statics: factor by which the wall is softer at contact points; 0: 1 */
    double frictionless;  /* [-] statics: fraction of contact friction that is omitted; 0: none */
    double slip[2];       /* [m/s, rad/s] along the hole, of rotation */
    double rounding; /* [N2] sum of squares of the rounding of forces caused by the rounding of poses (elements, joints,
                        wall) */
    double gravity[3]; /* [m/s2] times load_factor, on bent elements */
    double power[8];   /* [W] of each class of force on the bodies, DMB_POWER_... */
    int32_t status;    /* of this evaluation */
    uint32_t element;  /* the element, if status is DMB_ERR_ROTATION */
} dmb_evaluation;

/* 1: rounding of stiff springs counts. Before the first correction of a step, a residual of the size of a stiff
 * spring's rounding may be that of a soft part, which would then move without its force; one correction places it
 * correctly. Without a step, as in linearisations, rounding always counts. */
static inline int dmb_rounding_counts(const dmb_evaluation *evaluation)
{
    return !evaluation->dynamic || evaluation->extrapolated || evaluation->step == 0.0;
}

/* Residual into sim->residual, sums of magnitudes into sim->scale_row; returns evaluation->status: DMB_OK,
 * DMB_ERR_ROTATION, DMB_ERR_NOT_FINITE. */
int32_t dmb_system_evaluate(dmb_evaluation *evaluation);
/* Pose of the trial: the accepted pose moved by `increment`. */
void dmb_system_move(dmb_sim *sim);
/* The same for nodes `first` to before `end`. */
void dmb_system_move_nodes(dmb_sim *sim, uint32_t first, uint32_t end);
/* Updates the memory fields of contacts, drives and bits in the trial without a full evaluation; of the residual only
 * the constrained rows are valid: they become `held`. Not for axial-torsional nodes and callers' forces. */
void dmb_system_remember(dmb_evaluation *evaluation, const double *held);
/* Iteration matrix K T6(increment) + inertia into the stiffness_ blocks, identity in rows that are not solved. */
void dmb_system_iteration_matrix(const dmb_evaluation *evaluation);
/* The same; constrained rows are copied to constrained_rows (blocks of the node before, of the node and of the node
 * after; shape (constrained, 3, 6)) before they become identity; NULL: not copied. */
void dmb_system_iteration_matrix_constrained(const dmb_evaluation *evaluation, double *constrained_rows);
/* product (constrained) = those rows times z, shape (row). */
void dmb_system_constrained_times(const dmb_sim *sim, const double *rows, const double *z, double *product);
/* Rotation angles of the trial with revolutions, from its pose and the increments. */
void dmb_system_unwrap(dmb_sim *sim);
/* Results of a step at its acceptance, after dmb_system_unwrap: drive positions and forces, bottom and history of bits.
 * Reads the trial, writes trial and memory; called just before trial and now are exchanged. */
void dmb_system_accept(dmb_evaluation *evaluation);

/* Reactions of supports, from the residual and the multipliers of the trial: memory, and forces of motion drives into a
 * configuration. */
void dmb_system_get_reactions(dmb_sim *sim, dmb_configuration *to);

/* Blocks of node i, and off-diagonal blocks of nodes i, i + 1. */
static inline double *dmb_stiffness_of(const dmb_sim *sim, uint32_t node)
{
    return sim->stiffness_diagonal + sim->scene->layout.diag[node];
}
static inline double *dmb_inertia_of(const dmb_sim *sim, uint32_t node)
{
    return sim->inertia_diagonal + sim->scene->layout.diag[node];
}

/* Subtracts a 6-vector of external force from the residual of a node, and counts its magnitude. */
static inline void dmb_apply_wrench(dmb_sim *sim, uint32_t node, const double wrench[6])
{
    const uint32_t row = sim->scene->layout.row[node];
    if (sim->scene->layout.size[node] == DMB_NODE_AXIAL_TORSIONAL) {
        sim->residual[row] -= wrench[0];
        sim->residual[row + 1] -= wrench[3];
        sim->scale_row[row] += fabs(wrench[0]);
        sim->scale_row[row + 1] += fabs(wrench[3]);
        return;
    }
    for (int i = 0; i < 6; i++) {
        sim->residual[row + (uint32_t)i] -= wrench[i];
        sim->scale_row[row + (uint32_t)i] += fabs(wrench[i]);
    }
}

#endif
