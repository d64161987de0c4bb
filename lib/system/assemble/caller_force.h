/* Forces computed by the caller's functions from poses, speeds and time (dmb_model_add_force; eq:motion.caller-force).
 *
 * With V the twists of the places in their axes and the speeds of the joint coordinates, V = L v by the velocities v
 * of the nodes, and w the wrenches there:
 *
 *     residual -L^T w,   K = -L^T (A L + B dV/dq) - d(L^T) w,   C = -L^T B L,   A = dw/dz, B = dw/dV
 *
 * z the displacements in the same axes. Derivatives given in world axes, f = R w by dx = R z, v = R V, are rotated: A
 * = R^T A_w R + R^T B_w R (z_r x V) + w x z_r, B = R^T B_w R.
 *
 * A law with a state s has w(z, V, s) and s = S(s_0, z, V, h) of the accepted state s_0: A and B are total derivatives.
 */
#ifndef DMB_SYSTEM_ASSEMBLE_CALLER_FORCE_H
#define DMB_SYSTEM_ASSEMBLE_CALLER_FORCE_H

#include "system/assemble/point_motion.h"

/* DMB_OK, DMB_ERR_CALLBACK: the force from dmb_failed_force. */
int32_t dmb_assemble_caller_forces(dmb_evaluation *evaluation);
/* Compares the caller's tangent with differences in the present state. DMB_OK, DMB_ERR_CALLBACK with the message. */
int32_t dmb_caller_force_check(dmb_sim *sim, uint32_t force);
/* "force 2 (magnet)", the force whose callback failed in the last evaluation; clears the record. 0: none failed. */
int dmb_failed_force(dmb_sim *sim, dmb_message *text);
/* Calls the accept functions of the callers' laws with the accepted state. */
void dmb_caller_laws_accept(const dmb_sim *sim);
/* [J] Sum of the potentials given by the callbacks. */
double dmb_caller_forces_energy(const dmb_scene *scene, const dmb_configuration *configuration);

/* ---- caller_force_call.c: one function of a caller --------------------------------------------------------------- */

enum { DMB_CALLER_WIDE = 6 * DMB_CONSTRAINT_PLACES };
typedef double dmb_caller_matrix[DMB_CALLER_WIDE][DMB_CALLER_WIDE];

/* Arguments of a callback: poses in the world, velocities in the axes it requests; of a joint its coordinate in x[0]
 * and v[0]. */
typedef struct dmb_caller_question {
    const dmb_scene_force *force;
    double time;
    double R[DMB_CONSTRAINT_PLACES][9], x[DMB_CONSTRAINT_PLACES][3], v[DMB_CONSTRAINT_PLACES][6];
    const double *accepted; /* state of the law at the last accepted time */
    double *trial, *spare;  /* its state now is written there; of calls at arguments nearby here */
    double step;            /* [s] between the two times */
} dmb_caller_question;

typedef struct dmb_caller_values {
    double f[DMB_CONSTRAINT_PLACES][6]; /* [N, N m] in the same axes */
    double potential;                   /* [J] 0 where none is given */
} dmb_caller_values;

typedef struct dmb_caller_answer {
    dmb_caller_values at;
    union {
        struct {
            dmb_caller_matrix A, B; /* by displacements and velocities in those axes */
        };
        double given[2 * DMB_CALLER_WIDE *
                     DMB_CALLER_WIDE]; /* the same as given by a callback, row by row, of the requested length */
    };
} dmb_caller_answer;

/* 1: argument i is a place, 0: a joint's coordinate. */
static inline int dmb_caller_is_place(const dmb_scene_force *force, uint32_t i)
{
    return force->joint[i] == DMB_NONE;
}

/* Values, and with `tangent` their derivatives, as given or by differences. DMB_OK, DMB_ERR_CALLBACK. */
int32_t dmb_caller_ask(const dmb_caller_question *ask, int tangent, dmb_caller_answer *to);
/* [W] dU/dt along the motion, time included. DMB_OK, DMB_ERR_CALLBACK. */
int32_t dmb_caller_potential_rate(const dmb_caller_question *ask, double *rate);
/* Compares the tangent given by the function with differences. DMB_OK, DMB_ERR_CALLBACK with the message. */
int32_t dmb_caller_compare(const dmb_caller_question *ask, const char *owner, dmb_message *message);

#endif
