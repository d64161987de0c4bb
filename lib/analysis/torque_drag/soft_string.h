/* The soft string in steady motion, integrated from its far end to the rig, in three dimensions. At measured depth s, t
 * the tangent of the hole's axis, w the buoyant weight per metre, N the effective axial force, v = (v_a, v_c) the speed
 * of the pipe's surface along and around:
 *
 *     c = |w - (w.t) t + N dt/ds|                  wall force per metre (eq:drilling.wall-force)
 *     -dN/ds = w.t - mu c v_a/|v|                  force along (eq:drilling.soft-string)
 *     -dT/ds = mu c R |v_c|/|v|                    torque, R the radius of the contact surface
 *
 * Flowing mud reduces -dN/ds by its pull, and N at the far end by its thrust (force/mud_flow.h). A helix increases the
 * wall force by r N^2/(4 EI) if -N is above its load (eq:drilling.helix-force), r the clearance. */
#ifndef DMB_ANALYSIS_TORQUE_DRAG_SOFT_STRING_H
#define DMB_ANALYSIS_TORQUE_DRAG_SOFT_STRING_H

#include "drillmbd/analyse.h"
#include "model/model.h"
#include "model/scene.h"
#include "query/query.h"

typedef struct dmb_soft_string {
    const dmb_model *model;
    const dmb_hole *hole;
    double gravity[3]; /* [m/s2] */
    dmb_mud mud;
    uint32_t string; /* index */
    int32_t post_buckling;
    double start;     /* [m] measured depth of the rig end */
    double length;    /* [m] of all pipes */
    double friction;  /* [-] coefficient, or factor on that of the wall */
    int32_t by_depth; /* 1: friction is a factor on the wall's mu_dynamic by depth */
    int32_t reserved;
    double wall_friction;     /* [-] mu_dynamic of a wall without sections */
    double end_mass;          /* [kg] of bodies and bits at the far end, less the displaced mud */
    const dmb_mud_flow *flow; /* NULL: mud at rest */
} dmb_soft_string;

/* Components of the integrated state. */
enum {
    DMB_SOFT_FORCE,
    DMB_SOFT_TORQUE,
    DMB_SOFT_GROWTH,
    DMB_SOFT_STRETCH,
    DMB_SOFT_WIND_UP,
    DMB_SOFT_WALL,
    DMB_SOFT_COUNT
};

/* A place visited by the integration. */
typedef struct dmb_soft_place {
    const dmb_pipe_def *pipe;
    double depth;                 /* [m] measured */
    double step;                  /* [m] since the previous place; 0 for the other side of a jump */
    double state[DMB_SOFT_COUNT]; /* [N, N m, -, m, rad, N] force, torque, dN/dN at the far end, integrals */
    double wall;                  /* [N/m] c */
    double curvature;             /* [rad/m] of the hole */
    double sinusoidal, helical;   /* [-] ratios of the compression to the buckling loads */
} dmb_soft_place;

typedef void (*dmb_soft_visit)(void *context, const dmb_soft_place *place);

/* Reason why a string of a described and compiled model is outside the soft-string model, with the remedy; NULL:
 * inside. */
const char *dmb_soft_string_lacks(const dmb_model *model, const dmb_scene *scene, uint32_t string);

/* Integrates from the far end at measured depth `depth`, above start, to the rig end, and visits each place, the far
 * end first. Steps end at pipes of another kind, at stations of the survey, and at multiples of `spacing` [m] from the
 * rig end (0: none). 1: complete; 0: the compression exceeded 1 % of EA, and the integration ended there. */
int dmb_soft_string_march(const dmb_soft_string *soft, const dmb_operation *operation, double depth, double spacing,
                          dmb_soft_visit visit, void *context);

#endif
