/* A path of equilibrium while it is followed. The copy `work` of the sim holds the last point in `now` and the one that
 * is sought in `trial`. */
#ifndef DMB_ANALYSIS_BUCKLING_PATH_H
#define DMB_ANALYSIS_BUCKLING_PATH_H

#include "analysis/buckling/load_pattern.h"
#include "analysis/static/static.h"

/* A point: where the factor is, and the unit tangent of the path. */
typedef struct dmb_path_place {
    double factor;     /* [unit of the factor] */
    double rate;       /* [unit of the factor/m] along the tangent */
    double arc;        /* [m] from the start */
    double watched;    /* [m] */
    int32_t negative;  /* eigenvalues of the stiffness, as in dmb_path_point */
    int32_t stiffness; /* DMB_STIFFNESS_... */
    double *tangent;   /* (rows) [m, rad] body-frame displacements a metre of arc */
} dmb_path_place;

typedef struct dmb_path {
    dmb_sim *sim; /* only told messages */
    dmb_sim *work;
    const dmb_path_options *options;
    dmb_static_options statics;
    dmb_static_search search;
    dmb_load_pattern pattern;
    dmb_path_place last, next;
    double *loaded;      /* (rows) what a unit of the factor moves */
    double *move;        /* (rows) */
    double *iterate;     /* (rows) of the inverse iteration for it: */
    double *mode;        /* (rows) softest shape of the stiffness factored last, unit length */
    double side;         /* rate of the last point but at limit points, where it is that beyond */
    double softest;      /* [N/m] eigenvalue of that shape */
    double rounding;     /* [N/m] of eigenvalues of the stiffness judged last */
    double weakest;      /* [-] pivot of the stiffness factored last, against its block */
    uint32_t iterations; /* of the point sought */
    uint32_t turned;     /* element that a step has twisted or bent too far; DMB_NONE: none */
    double turned_at;    /* [unit of the factor] where that step began */
    int32_t begun;       /* 1: from a state in equilibrium, so that the report tells something */
    dmb_path_report report;
    void *block;
    size_t block_size;
} dmb_path;

/* Memory, and the first point, from zeros but for sim, options and pattern. Errors: as dmb_analysis_path;
 * dmb_path_close gives the memory back in any case. */
int32_t dmb_path_open(dmb_path *path);
void dmb_path_close(dmb_path *path);
/* The next point, at an event or at *arc; a step that fails is halved. *event tells. */
int32_t dmb_path_find_next(dmb_path *path, double *arc, int32_t *event);

/* [m2] a . b over the nodes, rotations times the length scale, the mean of the nodes. */
double dmb_path_dot(const dmb_path *path, const double *a, const double *b);
/* Loads of the trial for the next factor. Residual, and with tangent the stiffness blocks. */
int32_t dmb_path_evaluate(dmb_path *path, int32_t tangent);
/* From the last point by `arc` along a unit direction, whose factor goes by `rate`, then Newton in the plane across it.
 * The trial is next's pose, next.factor its factor. */
int32_t dmb_path_correct(dmb_path *path, const double *direction, double rate, double arc);
/* Tangent of the trial into next, oriented along `towards`; K is left factored. DMB_ERR_SINGULAR with search.block. */
int32_t dmb_path_tangent(dmb_path *path, const double *towards);
/* next becomes last, and a state at rest that can be asked. */
void dmb_path_accept(dmb_path *path);

/* Event between last and next, when next has been found at `arc`. */
enum {
    DMB_EVENT_NONE = 0,
    DMB_EVENT_LIMIT = 1,
    DMB_EVENT_BIFURCATION = 2,
    DMB_EVENT_FACTOR = 3,      /* options.factor_end */
    DMB_EVENT_DISPLACEMENT = 4 /* options.displacement_end */
};
int32_t dmb_path_event(const dmb_path *path);
/* Of the two ends one that lies between, but not that one. */
int32_t dmb_path_end(const dmb_path *path, int32_t but);
/* Moves next to the event, by regula falsi on the arc; mode is then the softest shape there. A bifurcation may turn out
 * to be a corner: a limit point, or nothing. */
int32_t dmb_path_locate(dmb_path *path, int32_t *event, double arc);
/* From a bifurcation, which is last, to the first point of the branch along the mode, halving *arc until it is
 * found. */
int32_t dmb_path_leave(dmb_path *path, double *arc);

#endif
