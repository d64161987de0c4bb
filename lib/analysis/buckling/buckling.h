/* Buckling: workspace of an analysis, its eigenproblem, and equilibrium paths. */
#ifndef DMB_ANALYSIS_BUCKLING_BUCKLING_H
#define DMB_ANALYSIS_BUCKLING_BUCKLING_H

#include "analysis/static/static.h"
#include "base/memory.h"
#include "drillmbd/analyse.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* ---- Paths: load patterns (path_loads.c) ------------------------------------------------------------------------- */

/* Loads that are scaled by the factor of a path or a buckling analysis, in addition to the present loads. */

typedef struct dmb_load_pattern {
    int32_t scale;  /* DMB_SCALE_... */
    uint32_t load;  /* the single load; DMB_NONE: none */
    uint32_t drive; /* the single drive; DMB_NONE: none */
    uint32_t row;   /* global row moved by a motion drive; DMB_NONE: none */
    double *base;   /* present factors of loads, bit loads and targets of drives, shape (dmb_load_pattern_size) */
} dmb_load_pattern;

/* Length of `base`. */
size_t dmb_load_pattern_size(const dmb_scene *scene);
/* Identifies `part`. Errors, with a message that begins with `who`: DMB_ERR_ID, DMB_ERR_VALUE, DMB_ERR_UNSUPPORTED
 * (motion drives of joints). The caller sets base. */
int32_t dmb_load_pattern_allocate(dmb_sim *sim, const char *who, int32_t scale, dmb_id part, dmb_load_pattern *pattern);
/* Stores the present loads of the trial, after dmb_system_prescribe. */
void dmb_load_pattern_begin(const dmb_load_pattern *pattern, const dmb_sim *sim);
/* Sets the loads of the trial for a factor; displacements by a motion drive are part of the pose. */
void dmb_load_pattern_set(const dmb_load_pattern *pattern, dmb_evaluation *evaluation, double factor);
/* d residual/d factor in `derivative` (rows), after an evaluation with tangent and before the iteration matrix is
 * formed from it. `residual` is unchanged. Errors as dmb_system_evaluate. */
int32_t dmb_load_pattern_derivative(const dmb_load_pattern *pattern, dmb_evaluation *evaluation, double factor,
                                    double *derivative);

/* ---- Paths: path following (path.c, path_step.c) ----------------------------------------------------------------- */

/* Workspace of path following. The copy `work` of the sim holds the last point in `now` and the next point in
 * `trial`. */

/* A point: its factor, and the unit tangent of the path. */
typedef struct dmb_path_place {
    double factor;     /* [unit of the factor] */
    double rate;       /* [unit of the factor/m] along the tangent */
    double arc;        /* [m] from the start */
    double watched;    /* [m] */
    int32_t negative;  /* eigenvalues of the stiffness, as in dmb_path_point; -1: not resolved */
    int32_t odd;       /* 1: det K < 0, also where the count is not resolved */
    int32_t stiffness; /* DMB_STIFFNESS_... */
    int32_t reserved;
    double *tangent; /* (rows) [m, rad] body-frame displacements per metre of arc */
} dmb_path_place;

typedef struct dmb_path {
    dmb_sim *sim; /* receives messages only */
    dmb_sim *work;
    const dmb_path_options *options;
    dmb_static_options statics;
    dmb_static_search search;
    dmb_load_pattern pattern;
    dmb_path_place last, next;
    double *loaded;      /* (rows) displacements per unit of the factor */
    double *move;        /* (rows) */
    double *iterate;     /* (rows) of the inverse iteration for `mode` */
    double *mode;        /* (rows) softest shape of the stiffness factored last, unit length */
    double side;         /* rate of the last point; at limit points the rate beyond */
    double softest;      /* [N/m] eigenvalue of that shape */
    double *amounts;     /* (rows) rounding level of the rows of the last assessed stiffness (eq:signs.amount) */
    double rounding;     /* [N/m] rounding level of `softest` */
    double weakest;      /* [-] smallest pivot of the last factorisation, relative to its block */
    uint32_t iterations; /* of the next point */
    uint32_t turned;     /* element that a step has rotated too far; DMB_NONE: none */
    double turned_at;    /* [unit of the factor] start of that step */
    int32_t begun;       /* 1: started from an equilibrium, so that the report is valid */
    int32_t unresolved;  /* 1: the count of a computed point is not resolved */
    int32_t reserved;
    dmb_path_report report;
    void *block;
    size_t block_size;
} dmb_path;

/* Allocates memory and computes the first point, from zeros except sim, options and pattern. Errors: as
 * dmb_analysis_path; dmb_path_close frees the memory in any case. */
int32_t dmb_path_open(dmb_path *path);
void dmb_path_close(dmb_path *path);
/* Computes the next point, at an event or at *arc; a failed step is halved. *event is the result. */
int32_t dmb_path_find_next(dmb_path *path, double *arc, int32_t *event);

/* [m2] a . b over the nodes, rotations times the length scale, mean over the nodes. */
double dmb_path_dot(const dmb_path *path, const double *a, const double *b);
/* Evaluates the trial with the loads of the next factor: residual, and with tangent the stiffness blocks. */
int32_t dmb_path_evaluate(dmb_path *path, int32_t tangent);
/* From the last point by `arc` along a unit direction with the factor's `rate`, then Newton in the plane normal to it.
 * The trial is the pose of next, next.factor its factor. */
int32_t dmb_path_correct(dmb_path *path, const double *direction, double rate, double arc);
/* Tangent of the trial in next, oriented along `towards`; K remains factored. DMB_ERR_SINGULAR with search.block. */
int32_t dmb_path_tangent(dmb_path *path, const double *towards);
/* Accepts next as last, as a state at rest for queries. DMB_ERR_CALLBACK if the caller's function fails. */
int32_t dmb_path_accept(dmb_path *path);

/* Event between last and next, after next has been computed at `arc`. */
enum {
    DMB_EVENT_NONE = 0,
    DMB_EVENT_LIMIT = 1,
    DMB_EVENT_BIFURCATION = 2,
    DMB_EVENT_FACTOR = 3,      /* options.factor_end */
    DMB_EVENT_DISPLACEMENT = 4 /* options.displacement_end */
};
int32_t dmb_path_event(const dmb_path *path);
/* 1: eigenvalues of the stiffness have changed sign between last and next, as far as is known: without a resolved count
 * of both an odd number of them, which changes the sign of det K. */
int dmb_path_count_changes(const dmb_path *path);
/* An end of the path that lies between them, except `but`. */
int32_t dmb_path_end(const dmb_path *path, int32_t but);
/* Moves next to the event, by regula falsi on the arc; mode is then the softest shape there. A bifurcation may prove to
 * be a corner: a limit point, or no event. */
int32_t dmb_path_locate(dmb_path *path, int32_t *event, double arc);
/* From a bifurcation, which is last, to the first point of the branch along the mode; *arc is halved until the point
 * converges. */
int32_t dmb_path_leave(dmb_path *path, double *arc);

/* Growth of damped modes along the equilibria. If K is non-symmetric, a state loses its stability before det K passes 0
 * when a complex pair of roots of  det(s^2 M + s C + K) = 0  crosses the imaginary axis: flutter
 * (eq:static.characteristic). The eigenvalues of K alone are not sufficient: the load at which a complex pair of them
 * becomes real and negative depends on their weights, and is no event of the motion. Therefore the damped modes are
 * computed at the points of the path, and after growth the factor is bracketed between the last point without growth
 * and this one. */

typedef struct dmb_flutter {
    const dmb_load_pattern *pattern;
    dmb_buckling_info *info; /* receives flutter, flutter_factor and flutter_root */
    dmb_sim *state;          /* the assessed state; NULL before the first one */
    dmb_message message;     /* reason if modes could not be computed */
    double growth;           /* [1/s] of the last assessed state */
    int32_t off;             /* 1: flutter is not assessed */
    int32_t failed;          /* 1: modes of some state could not be computed */
} dmb_flutter;

/* 1: flutter is assessed and none was found so far. */
int dmb_flutter_goes_on(const dmb_flutter *flutter);
/* Assesses the first state of the path. Errors: memory, or cancelled; a state whose modes cannot be computed is
 * skipped, with the reason in message. This also holds for the following functions. */
int32_t dmb_flutter_begin(dmb_flutter *flutter, const dmb_path *path);
/* Assesses the point at `arc` beyond the last one, and brackets the factor after growth; the next point of the path is
 * overwritten. Errors of dmb_path_correct too. */
int32_t dmb_flutter_look(dmb_flutter *flutter, dmb_path *path, double arc);
/* Assesses a pose that the loads do not move, from the factor 0 to `to` in equal parts; `through`: at the last one
 * too. */
int32_t dmb_flutter_of_pose(dmb_flutter *flutter, dmb_sim *at, double to, int through);
/* At the end of the path: the result is NOT_JUDGED if nothing was found and some state was skipped. */
void dmb_flutter_conclude(dmb_flutter *flutter);
void dmb_flutter_close(dmb_flutter *flutter);

/* ---- The eigenproblem -------------------------------------------------------------------------------------------- */

typedef struct dmb_pencil_matrix {
    double *diagonal, *lower, *upper; /* storage of the scene's layout */
    double *jointed; /* values of the scene's pattern, as in system/solve/solve.h; none without joints */
} dmb_pencil_matrix;

typedef struct dmb_pencil {
    const dmb_scene *scene;
    const dmb_sim *sim; /* of reduced_size, reduced_row, progress; by the caller, NULL without joints and progress */
    dmb_pencil_matrix K, G, work;
    uint32_t unknowns; /* length of a vector */
    uint32_t reserved;
    uint8_t *pivot;          /* (rows) */
    uint32_t *reduced_pivot; /* (rows of the pattern) */
    double *workspace;       /* workspace (square of the largest cluster) */
    double *image;           /* (unknowns) G x */
    double *iterate;         /* (unknowns) of an inverse iteration */
} dmb_pencil;

uint32_t dmb_pencil_unknowns(const dmb_scene *scene);
void dmb_pencil_lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_pencil *pencil);
/* Number of factors in 0 .. factor; result 1. Result 0: a block stays singular at all nearby factors, and counting is
 * impossible. */
int dmb_pencil_count(dmb_pencil *pencil, double factor, uint32_t *count);
/* Factor number k = 0, 1 .. counted from 0 upwards, to a relative `tolerance`; bracketing starts at `guess` > 0.
 * Infinite if it is beyond `most`, NaN if it cannot be counted. */
double dmb_pencil_factor(dmb_pencil *pencil, uint32_t k, double guess, double most, double tolerance);
/* Vector of a critical factor in x (unknowns), orthogonal to `others` earlier ones of the same factor, (others,
 * unknowns). Result: the factor as Rayleigh quotient of the vector. */
double dmb_pencil_vector(dmb_pencil *pencil, double factor, const double *other, uint32_t others, double *x);

/* Non-symmetric K or G: */

/* The same factors, up to `wanted`, and their vectors, shape (wanted, unknowns): the largest real positive eigenvalues
 * 1/factor of -K^-1 G, by Krylov subspaces. *found: their number below `most`. DMB_ERR_NO_MEMORY, _SINGULAR,
 * _NO_CONVERGENCE. */
typedef struct dmb_pencil_search {
    uint32_t wanted;
    double most;
    const dmb_allocator *allocator;
} dmb_pencil_search;

int32_t dmb_pencil_general(dmb_pencil *pencil, const dmb_pencil_search *search, double *factors, double *vectors,
                           uint32_t *found);

/* Operations: y = A x; factors of K + factor G in `work`, result 0 if singular; x <- (K + factor G)^-1 x; a random
 * vector, reproducible for each seed > 0. */
void dmb_pencil_multiply(const dmb_pencil *pencil, const dmb_pencil_matrix *A, const double *x, double *y);
int dmb_pencil_shift_and_factor(dmb_pencil *pencil, double factor);
void dmb_pencil_solve(const dmb_pencil *pencil, double *x);
void dmb_pencil_draw(const dmb_pencil *pencil, uint64_t seed, double *x);

/* ---- The analysis (buckling.c, buckling_state.c, buckling_follow.c) ---------------------------------------------- */

/* Stiffness of a nearby state in the frames of the present one. Body frames rotate with the response of the state to
 * its loads: two matrices may only be subtracted in fixed frames, otherwise the difference contains q' (W K - K W), W
 * the rotation, which is as large as the stiffest entries: 12 EI/L^3 of short elements twisted by torque.
 *
 *     d_now = T d_trial,  T = blkdiag(Q, Q),  Q = R_now^T R_trial,      K_now = T K_trial T^T    (eq:buckling.frames)
 *
 * Rows of supports are constrained in body axes; T leaves them unchanged and rotates the free rows among themselves.
 * With joints the reduced coordinates are rows: d = R z, z_now = W z_trial, W the independent rows of T R, and A_now =
 * W^-T A_trial W^-1. */

typedef struct dmb_frames {
    double *turn;      /* (values of the pattern) W^-1 of each block, at the position of its diagonal in the pattern */
    double *workspace; /* workspace (2, square of the largest block) */
    uint32_t *pivot;   /* (rows of the largest block) */
} dmb_frames;

void dmb_frames_lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_frames *frames);
/* Transforms the unfactored iteration matrix of the trial, in chains without joints. */
void dmb_frames_turn_chains(dmb_sim *sim);
/* Transforms the reduced system of the trial, just assembled. 0 if coordinates are no longer independent. */
int dmb_frames_turn_reduced(dmb_sim *sim, const dmb_frames *frames);

struct dmb_buckling {
    uint32_t magic;
    uint32_t count; /* number of factors found */
    dmb_allocator allocator;
    dmb_sim *work; /* copy of the sim in the linearised state; its velocities hold a shape for queries */
    double at;     /* [unit of the factor] position of that state on the path */
    dmb_buckling_info info;
    void *block;
    size_t block_size;
    double *factor;   /* (count) */
    double *first;    /* (count) factors of the first linearisation; infinite: none */
    double *vector;   /* (count, unknowns of the pencil) */
    double *shape;    /* (count, rows) body-frame displacements of the nodes; without joints the same array as vector */
    double *response; /* (rows) of the state to the pattern */
    double *amount;   /* (rows) rounding level of the rows of K (eq:signs.amount) */
    dmb_load_pattern pattern;
    dmb_pencil pencil;
    dmb_frames frames;
};

/* Body-frame displacements of the nodes, shape (rows), of a vector of the pencil. */
void dmb_buckling_expand(dmb_buckling *buckling, const double *vector, double *shape);
/* K and G of the state in `work`, at the factor `at`. Errors, with a message in sim: DMB_ERR_ORDER (no stable
 * equilibrium), _SINGULAR. */
int32_t dmb_buckling_linearise(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options);
/* Factors and shapes of K and G, in ascending order; DMB_NOTE_STOPPED if there are fewer than requested. */
int32_t dmb_buckling_find(dmb_buckling *buckling, const dmb_buckling_options *options, dmb_message *message);
/* Final status, with a message in sim: DMB_NOTE_FLUTTER if a mode grows along the path, DMB_NOTE_INCOMPLETE if growth
 * was not assessed; else `status`. `why`: reason if modes could not be computed. */
int32_t dmb_buckling_report_flutter(const dmb_buckling *buckling, dmb_sim *sim, const dmb_message *why, int32_t status);
/* Scales a shape to a largest displacement of 1 m, or rotation of 1 rad if nothing else moves; its largest component is
 * positive. */
void dmb_buckling_normalise(const dmb_scene *scene, double *x);

/* Lowest eigenvalue of the stiffness along a path (buckling_dip.c, eq:buckling.softest). */
typedef struct dmb_dip_point {
    double arc;    /* [m] of the path */
    double value;  /* [N/m] lowest eigenvalue of K x = mu E x (dmb_softest_find) */
    double factor; /* [unit of the factor] */
} dmb_dip_point;

typedef struct dmb_dip {
    dmb_dip_point before, last; /* the last two points of the path */
    dmb_dip_point least;        /* the minimum found */
    double most;                /* [N/m] largest value so far */
    double depth;               /* [-] of the minimum */
    double value;               /* [N/m] last value computed */
    double *shape;              /* (rows) of that value */
    double *least_shape;        /* (rows) of the minimum */
    dmb_softest softest;
    dmb_sim *state;  /* of the minimum; NULL before the first one */
    uint32_t points; /* number of consecutive points examined */
    int32_t guessed; /* 1: shape is that of a nearby state */
    int32_t found;   /* 1: a minimum was found, and the value has not risen by much since */
    int32_t reserved;
} dmb_dip;

/* First point of a path, from zeros; dmb_dip_close frees the memory in any case. */
int32_t dmb_dip_begin(dmb_dip *dip, dmb_path *path);
void dmb_dip_close(dmb_dip *dip, const dmb_sim *sim);
/* Examines the next point of the path, at `arc` from the last one, whose stiffness is overwritten: 1 if a deep minimum
 * has been passed, with its state, shape and depth in dip. 0: none so far; next is unchanged. `spare`: a copy of the
 * sim that is overwritten. Errors of dmb_path_correct, DMB_ERR_NO_MEMORY. */
int32_t dmb_dip_look(dmb_dip *dip, dmb_path *path, double arc, dmb_sim *spare);
/* [-] Largest ratio of load to sinusoidal buckling load over all strings of the state, as in a profile; NaN: none. */
double dmb_dip_sinusoidal_ratio(dmb_sim *at);

/* Follows the equilibria from the present state to the first factor at which they lose their stability, and computes
 * the factors again from there. Status as of dmb_analysis_buckling. */
int32_t dmb_buckling_follow(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options);

#endif
