/* Buckling: an analysis while it runs, its eigenproblem, and paths of equilibrium. */
#ifndef DMB_ANALYSIS_BUCKLING_BUCKLING_H
#define DMB_ANALYSIS_BUCKLING_BUCKLING_H

#include "analysis/static/static.h"
#include "base/memory.h"
#include "drillmbd/analysis.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* ---- Paths: loads that grow (path_loads.c) ----------------------------------------------------------------------- */

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

/* ---- Paths: a path while it is followed (path.c, path_step.c) ---------------------------------------------------- */

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
    double *amounts;     /* (rows) rounding of the rows of the stiffness judged last (eq:signs.amount) */
    double rounding;     /* [N/m] rounding of `softest` */
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
/* next becomes last, and a state at rest that can be asked. DMB_ERR_CALLBACK where the caller's function fails now. */
int32_t dmb_path_accept(dmb_path *path);

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
 * (eq:static.characteristic). The eigenvalues of K alone do not tell: at which load a complex pair of them becomes real
 * and negative depends on the weights that they are measured by, and nothing happens to the motion there. So the damped
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
/* A pose that the loads do not move, from the factor 0 to `to`: in equal parts; `through`: at the last one too. */
int32_t dmb_flutter_of_pose(dmb_flutter *flutter, dmb_sim *at, double to, int through);
/* At the end of the way: nothing found where some state was passed by is not judged. */
void dmb_flutter_conclude(dmb_flutter *flutter);
void dmb_flutter_close(dmb_flutter *flutter);

/* ---- The eigenproblem -------------------------------------------------------------------------------------------- */

typedef struct dmb_pencil_matrix {
    double *diagonal, *lower, *upper; /* storage of the scene's layout */
    double *jointed; /* values of the scene's pattern, as in system/solve/solve.h; none without joints */
} dmb_pencil_matrix;

typedef struct dmb_pencil {
    const dmb_scene *scene;
    const dmb_sim
        *sim; /* its reduced_size, reduced_row and progress; the caller's to set, NULL without joints and progress */
    dmb_pencil_matrix K, G, work;
    uint32_t unknowns; /* length of a vector */
    uint32_t reserved;
    uint8_t *pivot;          /* (rows) */
    uint32_t *reduced_pivot; /* (rows of the pattern) */
    double *room;            /* (square of the largest cluster) */
    double *image;           /* (unknowns) G x */
} dmb_pencil;

uint32_t dmb_pencil_unknowns(const dmb_scene *scene);
void dmb_pencil_lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_pencil *pencil);
/* Factors in 0 .. factor: 1. 0 if a block stays singular at all factors next to it, and nothing can be counted. */
int dmb_pencil_count(dmb_pencil *pencil, double factor, uint32_t *count);
/* The factor number k = 0, 1 .. counted from 0 upwards to a relative `tolerance`, the search beginning at `guess` > 0;
 * infinite if it is beyond `most`, NaN if it cannot be counted. */
double dmb_pencil_factor(dmb_pencil *pencil, uint32_t k, double guess, double most, double tolerance);
/* Vector of a critical factor into x (unknowns), apart from `others` earlier ones of the same factor, (others,
 * unknowns). Returns the factor once more, as Rayleigh's quotient of the vector. */
double dmb_pencil_vector(dmb_pencil *pencil, double factor, const double *other, uint32_t others, double *x);

/* K or G is not symmetric: */

/* The same factors, as many as `wanted`, and their vectors, shape (wanted, unknowns): the real positive eigenvalues
 * 1/factor of -K^-1 G that are largest, by Krylov subspaces. *found: how many there are below `most`.
 * DMB_ERR_NO_MEMORY, _SINGULAR, _NO_CONVERGENCE. */
typedef struct dmb_pencil_search {
    uint32_t wanted;
    double most;
    const dmb_allocator *allocator;
} dmb_pencil_search;

int32_t dmb_pencil_general(dmb_pencil *pencil, const dmb_pencil_search *search, double *factors, double *vectors,
                           uint32_t *found);

/* Operations on these. y = A x; factors of K + factor G into `work`, 0 where they are singular; x <- (K + factor G)^-1
 * x; any vector, the same for the same seed > 0. */
void dmb_pencil_multiply(const dmb_pencil *pencil, const dmb_pencil_matrix *A, const double *x, double *y);
int dmb_pencil_shift_and_factor(dmb_pencil *pencil, double factor);
void dmb_pencil_solve(const dmb_pencil *pencil, double *x);
void dmb_pencil_draw(const dmb_pencil *pencil, uint64_t seed, double *x);

/* ---- The analysis (buckling.c, buckling_state.c, buckling_follow.c) ---------------------------------------------- */

/* Stiffness of a state nearby in the frames of the present one. Body frames turn with the response of the state to its
 * loads: two matrices may only be subtracted in frames that do not, or the difference holds q' (W K - K W), W the
 * turning, which is as large as the stiffest entries: 12 EI/L^3 of short elements twisted by torque.
 *
 *     d_now = T d_trial,  T = blkdiag(Q, Q),  Q = R_now^T R_trial,      K_now = T K_trial T^T    (eq:buckling.frames)
 *
 * Rows that supports hold are held in body axes; T leaves them alone and turns those that are free among themselves.
 * With joints the reduced coordinates are rows: d = R z, z_now = W z_trial, W the independent rows of T R, and A_now =
 * W^-T A_trial W^-1. */

typedef struct dmb_frames {
    double *turn;    /* (values of the pattern) W^-1 of each block, where its diagonal is in the pattern */
    double *room;    /* (2, square of the largest block) */
    uint32_t *pivot; /* (rows of the largest block) */
} dmb_frames;

void dmb_frames_lay_out(dmb_arena *arena, const dmb_scene *scene, dmb_frames *frames);
/* The iteration matrix of the trial, not factored, in the chains that no joint connects. */
void dmb_frames_turn_chains(dmb_sim *sim);
/* The reduced system of the trial, just assembled. 0 where coordinates are no longer independent. */
int dmb_frames_turn_reduced(dmb_sim *sim, const dmb_frames *frames);

/* options.factor_max as it is by default: far beyond all loads. */
#define DMB_FACTOR_MAX 1e12

struct dmb_buckling {
    uint32_t magic;
    uint32_t count; /* factors found */
    dmb_allocator allocator;
    dmb_sim *work; /* a copy of the sim in the state that is linearised, for shapes as its velocities */
    double at;     /* [unit of the factor] where on the path of equilibria that state is */
    dmb_buckling_info info;
    void *block;
    size_t block_size;
    double *factor;   /* (count) */
    double *first;    /* (count) the factors that the present state alone told; infinite: not told */
    double *vector;   /* (count, unknowns of the pencil) */
    double *shape;    /* (count, rows) body-frame displacements of the nodes; without joints it is the vector */
    double *response; /* (rows) of the state to the pattern */
    double *amount;   /* (rows) rounding of the rows of K (eq:signs.amount) */
    dmb_load_pattern pattern;
    dmb_pencil pencil;
    dmb_frames frames;
};

/* Body-frame displacements of the nodes, shape (rows), that a vector of the pencil stands for. */
void dmb_buckling_expand(dmb_buckling *buckling, const double *vector, double *shape);
/* K and G of the state in `work`, at the factor `at`. Errors, with a message in sim: DMB_ERR_ORDER (no stable
 * equilibrium), _SINGULAR. */
int32_t dmb_buckling_linearise(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options);
/* Factors and shapes of K and G, rising; DMB_NOTE_STOPPED where there are fewer than asked for. */
int32_t dmb_buckling_find(dmb_buckling *buckling, const dmb_buckling_options *options, dmb_message *message);
/* Status of the whole, with a message in sim, where a mode grows on the way (DMB_NOTE_FLUTTER) or that was not judged
 * (DMB_NOTE_INCOMPLETE); else `status`. `why`: of modes that could not be found. */
int32_t dmb_buckling_tell_flutter(const dmb_buckling *buckling, dmb_sim *sim, const dmb_message *why, int32_t status);
/* Largest displacement 1 m, or rotation 1 rad where nothing else moves; its largest component positive. */
void dmb_buckling_normalise(const dmb_scene *scene, double *x);

/* Lowest eigenvalue of the stiffness along a path (buckling_dip.c, eq:buckling.softest). */
typedef struct dmb_dip_point {
    double arc;    /* [m] of the path */
    double value;  /* [N/m] lowest eigenvalue of K x = mu E x (dmb_stability_softest) */
    double factor; /* [unit of the factor] */
} dmb_dip_point;

typedef struct dmb_dip {
    dmb_dip_point before, last; /* the last two points of the path */
    dmb_dip_point least;        /* minimum that was found */
    double most;                /* [N/m] largest value so far */
    double depth;               /* [-] of the minimum */
    double *shape;              /* (rows) of the value found last */
    double *least_shape;        /* (rows) of the minimum */
    dmb_sim *state;             /* of the minimum; NULL before the first one */
    uint32_t points;            /* that were looked at in a row */
    int32_t guessed;            /* 1: shape is that of a state nearby */
    int32_t found;              /* 1: there is a minimum, and the value has not risen by much since */
    int32_t reserved;
} dmb_dip;

/* The present point of a path that begins, from zeros; dmb_dip_close gives the memory back in any case. */
int32_t dmb_dip_begin(dmb_dip *dip, dmb_path *path);
void dmb_dip_close(dmb_dip *dip, const dmb_sim *sim);
/* Looks at the next point of the path, at `arc` from the last one, with its stiffness factored: 1 if a deep minimum has
 * been passed, with its state, shape and depth in dip. 0: none so far; next is as it was. `spare`: a copy of the sim
 * that may be overwritten. Errors of dmb_path_correct, DMB_ERR_NO_MEMORY. */
int32_t dmb_dip_look(dmb_dip *dip, dmb_path *path, double arc, dmb_sim *spare);
/* Largest share of the load of sinusoidal buckling of all strings of the state, as of a profile; NaN: none. */
double dmb_dip_sinusoidal_share(dmb_sim *at);

/* Along the equilibria from the present state to the first factor at which they lose their stability, and the factors
 * once more from there. Status as of dmb_analysis_buckling. */
int32_t dmb_buckling_follow(dmb_buckling *buckling, dmb_sim *sim, const dmb_buckling_options *options);

#endif
