/* Paths of equilibrium: loads that grow, a path while it is followed, motion that grows on the way. */
#ifndef DMB_ANALYSIS_BUCKLING_PATH_H
#define DMB_ANALYSIS_BUCKLING_PATH_H

#include "analysis/static/static.h"
#include "drillmbd/analysis.h"
#include "system/assemble/evaluation.h"

/* ---- path_loads.c ------------------------------------------------------------------------------------------------ */

/* Loads that grow with the factor of a path or a buckling analysis, on top of the present loads. */

typedef struct dmb_load_pattern {
    int32_t scale;  /* DMB_SCALE_... */
    uint32_t load;  /* the one load; DMB_NONE: none */
    uint32_t drive; /* the one drive; DMB_NONE: none */
    uint32_t row;   /* global row that a motion drive moves; DMB_NONE: none */
    double *base;   /* present factors of loads, bit loads and targets of drives, shape (dmb_load_pattern_size) */
} dmb_load_pattern;

/* Numbers that `base` holds. */
size_t dmb_load_pattern_size(const dmb_scene *scene);
/* Finds what `part` is. Errors, with a message that begins with `who`: DMB_ERR_ID, DMB_ERR_VALUE, DMB_ERR_UNSUPPORTED
 * (motion drives of joints). base is the caller's to set. */
int32_t dmb_load_pattern_take(dmb_sim *sim, const char *who, int32_t scale, dmb_id part, dmb_load_pattern *pattern);
/* Present loads from the trial, as dmb_system_prescribe has left it. */
void dmb_load_pattern_begin(const dmb_load_pattern *pattern, const dmb_sim *sim);
/* Loads of the trial for a factor; what a motion drive moves is a matter of the pose. */
void dmb_load_pattern_set(const dmb_load_pattern *pattern, dmb_evaluation *evaluation, double factor);
/* d residual/d factor into `derivative` (rows), after an evaluation with tangent and before the iteration matrix is
 * made of it. `residual` is the same before and after. Errors as dmb_system_evaluate. */
int32_t dmb_load_pattern_derivative(const dmb_load_pattern *pattern, dmb_evaluation *evaluation, double factor,
                                    double *derivative);

/* ---- path.c, path_step.c ----------------------------------------------------------------------------------------- */

/* A path of equilibrium while it is followed. The copy `work` of the sim holds the last point in `now` and the one that
 * is sought in `trial`. */

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

/* Growth of damped modes on the way along the equilibria. Where K is unsymmetric, a state loses its stability before
 * det K passes 0 when a complex pair of roots of  det(s^2 M + s C + K) = 0  crosses the imaginary axis: flutter
 * (Ziegler 1952). The eigenvalues of K alone do not tell: at which load a complex pair of them becomes real and
 * negative depends on the weights that they are measured by, and nothing happens to the motion there. So the damped
 * modes are found at the points of the path, and where one grows the factor is closed in between the last point at
 * which none did and this one. */

typedef struct dmb_flutter {
    const dmb_load_pattern *pattern;
    dmb_buckling_info *info; /* flutter, growth, ... are told here */
    dmb_sim *state;          /* the state that is judged; NULL before the first one */
    dmb_message message;     /* of modes that could not be found */
    double growth;           /* [1/s] of the state judged last */
    int32_t off;             /* 1: not to be looked for */
    int32_t failed;          /* 1: modes of some state could not be found */
} dmb_flutter;

/* 1 where growth is looked for: nothing has grown so far. */
int dmb_flutter_goes_on(const dmb_flutter *flutter);
/* The state that the path begins in. An error is a matter of memory, or cancelled; a state whose
 * modes cannot be found is passed by, and message tells why. Here and in the following. */
int32_t dmb_flutter_begin(dmb_flutter *flutter, const dmb_path *path);
/* The way from the last point to the one `arc` beyond, which is judged; the next point of the path is gone then. Errors
 * of dmb_path_correct too. */
int32_t dmb_flutter_look(dmb_flutter *flutter, dmb_path *path, double arc);
/* A pose that the loads do not move, from the factor 0 to `to`: in equal parts. */
int32_t dmb_flutter_of_pose(dmb_flutter *flutter, dmb_sim *at, double to);
/* At the end of the way: nothing found where some state was passed by is not judged. */
void dmb_flutter_conclude(dmb_flutter *flutter);
void dmb_flutter_close(dmb_flutter *flutter);

#endif
