/* libdrillmbd - analyses of a scene about a state. */
#ifndef DRILLMBD_ANALYSIS_H
#define DRILLMBD_ANALYSIS_H

#include "query.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dmb_static_options {
    uint32_t struct_size;
    uint32_t max_iterations;   /* [-] of one load step, 1 .. 10000; default 60 */
    double tolerance;          /* [-] residual over the norm of the forces that balance in it; default 1e-10 */
    double slip_axial;         /* [m/s] friction acts as if the string slid along the hole at this speed; default 0 */
    double slip_rotation;      /* [rad/s] and turned at this speed; both 0: no friction in the static state */
    uint32_t load_steps;       /* [-] equal steps from no load to full load, 1 .. 10000; default 1 */
    int32_t lay_on_wall;       /* 1 (default): start from the string lying on the low side of its hole; 0: from the
                                  present pose */
} dmb_static_options;
DMB_SIZED_STRUCT(dmb_static_options)

enum { DMB_STATIC_NEWTON = 0, DMB_STATIC_RELAXATION = 1 };
typedef struct dmb_static_report {
    uint32_t struct_size;
    uint32_t iterations;       /* [-] in all */
    uint32_t load_steps;       /* [-] carried out */
    int32_t method;            /* DMB_STATIC_...: the last resort that was needed */
    double residual;           /* [-] relative, at the end */
    double largest_force;      /* [N, N m over the element length] largest component of the residual at the end */
    double lateral_move;       /* [m] largest displacement from the starting pose */
} dmb_static_report;
DMB_SIZED_STRUCT(dmb_static_report)

/* Static start: puts the sim at rest in the equilibrium of its loads, gravity, wall and drives at its present time, by
 * Newton with the extrapolated element stress (Magisano, Leonetti, Garcea 2017), and by pseudo-transient continuation
 * where that fails. The rock law does not act in the static state (at time 0 its bottom is laid ahead of the bit as
 * described); a speed controller acts as at speed 0. Speeds become those of the motion drives, the energy ledger starts anew. options and report may be
 * NULL. Errors: DMB_ERR_VALUE, _NO_CONVERGENCE, _SINGULAR (message says which part is free), _ROTATION, _CALLBACK; the
 * state is then that before the call. */
DMB_API int32_t dmb_analysis_static(dmb_sim *sim, const dmb_static_options *options, dmb_static_report *report);

#ifdef __cplusplus
}
#endif
#endif
