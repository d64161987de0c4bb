/* libdrillmbd - analyses of a scene about a state. */
#ifndef DRILLMBD_ANALYSIS_H
#define DRILLMBD_ANALYSIS_H

#include "query.h"

DMB_C_BEGIN

/* Same bits, by level. Same build, same machine and same calls give
 *   1. steps, and all that is read off a state: the same bits, beside other work, in any number of threads;
 *   2. statics, paths, buckling, responses, stepped sine, speeds to avoid: the same bits; they call no BLAS;
 *   3. modes, and `condition` of a model check: LAPACK's digits. They differ by rounding with the host's BLAS and the
 *      number of its threads: eigenvalues by some 1e-12 of themselves, shapes by as much over the distance to the next
 *      frequency; counts, ranks and rigid-body modes do not. One thread of BLAS (OPENBLAS_NUM_THREADS=1) gives the same
 *      bits. */

/* Steady states of a scene whose motion drives (DMB_DRIVE_MOTION) move at the present time, in which a run continues
 * without a transient. Time functions that change count with their speed at that time. */
enum {
    DMB_STEADY_AUTO = 0, /* AT_REST where nothing moves or a slip is assumed, SLIDING where strings are moved along and
                            about their axis, RIGID else, or where masses are eccentric; AT_REST with
                            DMB_NOTE_NOT_STEADY (message says why) where neither is steady */
    DMB_STEADY_AT_REST = 1, /* all is at rest; only components of motion drives have their speed */
    DMB_STEADY_SLIDING = 2, /* axes at rest; strings slide along the hole and turn about their axis as drives say */
    DMB_STEADY_RIGID = 3    /* all turns about one fixed axis like a rigid body, under centrifugal forces */
};
typedef struct dmb_static_options {
    uint32_t struct_size;
    uint32_t max_iterations; /* [-] of one load step, 1 .. 10000; default 60 */
    double tolerance;        /* [-] residual over the norm of the forces that balance in it; default 1e-10 */
    double slip_axial;       /* [m/s] friction acts as if the string slid along the hole at this speed; default 0 */
    double slip_rotation;    /* [rad/s] and turned at this speed; both 0: no friction in the static state. With a slip
                                the state is quasi-static: until the next step its accelerations are 0 and section
                                forces contain neither inertia nor damping */
    uint32_t load_steps;     /* [-] equal steps from no load to full load, at most 10000, before the library chooses
                                them by itself; default 0: the whole load at once */
    int32_t lay_on_wall;     /* 1 (default): start from the string lying on the low side of its hole; 0: from the
                                present pose */
    int32_t steady;          /* DMB_STEADY_..., default DMB_STEADY_AUTO */
    int32_t reserved;
} dmb_static_options;
DMB_SIZED_STRUCT(dmb_static_options)

/* Kinds of stiffness by which the stability of a static state is assessed. */
enum {
    DMB_STIFFNESS_SYMMETRIC = 0,  /* forces have a potential: the state is stable where no eigenvalue is negative */
    DMB_STIFFNESS_UNSYMMETRIC = 1 /* friction that slips, moments with a fixed axis, followers: the state diverges by
                                     each real negative eigenvalue; by complex ones it may flutter, which depends on
                                     mass and damping and is computed by dmb_analysis_modes with DMB_MODES_DAMPED */
};
enum { DMB_STATIC_NEWTON = 0, DMB_STATIC_RELAXATION = 1 };
typedef struct dmb_static_report {
    uint32_t struct_size;
    uint32_t iterations;    /* [-] in all */
    uint32_t load_steps;    /* [-] carried out */
    int32_t method;         /* DMB_STATIC_...: the last resort that was needed */
    double residual;        /* [-] relative, at the end */
    double largest_force;   /* [N, N m over the element length] largest component of the residual at the end */
    double lateral_move;    /* [m] largest displacement from the starting pose */
    uint32_t cuts;          /* [-] load steps that did not converge and were halved */
    uint32_t line_searches; /* [-] corrections that were shortened by a line search */
    int32_t negative;  /* [-] negative eigenvalues of the stiffness, by which the equilibrium is unstable. SYMMETRIC:
                          exact for all eigenvalues that exceed 10 eps times the norm of the stiffness; -1: none is
                          known to be negative and `unresolved` are of rounding size. UNSYMMETRIC: the real negative
                          ones: all up to 400 coordinates, else all within reach of the symmetric part, or if there
                          are any, those among the 108 nearest 0; -1: none was found, and others could not be
                          excluded. Of a state that moves (`steady`): of the stiffness in its moving axes with
                          centrifugal forces; gyroscopic ones may hold it, or damping not (dmb_analysis_modes) */
    int32_t stiffness; /* DMB_STIFFNESS_...: the kind that was assessed */
    int32_t steady;    /* DMB_STEADY_AT_REST, _SLIDING or _RIGID: kind of the state */
    int32_t steady_reserved;
    int32_t free_spins; /* [-] rotations of strings about their own axes that nothing resists, strings that turn
                           together counted once: every angle is an equilibrium, and the starting one is kept */
    int32_t unresolved; /* [-] eigenvalues of rounding size, whose signs the count does not resolve: motions that
                           nothing resists, or a mesh too fine for double precision; SYMMETRIC only */
    double resolution;  /* [N/m] largest eigenvalue, rotations over the square of the mean element length, that may be
                           of rounding size: 4 eps of the largest stiffness */
} dmb_static_report;
DMB_SIZED_STRUCT(dmb_static_report)

/* Static start: puts the sim at rest in the equilibrium of its loads, gravity, wall and drives at its present time, by
 * Newton with the extrapolated element stress (Magisano, Leonetti, Garcea 2017); where that fails and pipes slip on the
 * wall, from the equilibrium without friction in steps of the friction; where that fails in load steps
 * (gravity, loads and bit load from 0, drives as they are) that are halved when they fail and doubled when they do not,
 * with a line search in the shortest; and by pseudo-transient continuation where that fails too. At rest the rock law
 * does not act (at time 0 its bottom is laid ahead of the bit as described); a speed controller acts as at speed 0.
 * Where motion drives move, the state is a steady one (`steady`): speeds of all nodes are those of the sliding or the
 * rigid motion, friction acts by the slip that there is, damping and drag act, controllers act by that speed, and a bit
 * that stands on rock cuts (at time 0: where none is described ahead of it). SLIDING requires that rotating parts are
 * round (no eccentric mass, pre-bent pipe, or load across that turns with it), RIGID that gravity, loads, supports,
 * joints to the ground and a hole agree with the axis; else DMB_ERR_UNSUPPORTED, with the reason. Both take memory, one
 * matrix and some vectors, from the sim's allocator; so do the signs of the stiffness of every static state. The energy
 * ledger restarts. options and report may be NULL. A string whose rotation about its axis nothing resists keeps it
 * (report->free_spins) where the torques about the axis sum to 0; else DMB_ERR_SINGULAR. Unstable equilibria that the
 * search turned far to, or relaxed to, are left where a stable one is found beside. DMB_NOTE_UNSTABLE where the
 * equilibrium at rest is one that the string would leave (report->negative > 0); DMB_NOTE_INCOMPLETE where the
 * stability of an equilibrium at rest is not resolved (report->negative < 0; message states the bound). Errors:
 * DMB_ERR_VALUE, _NO_CONVERGENCE, _SINGULAR (message says which part is free), _ROTATION, _CALLBACK; the state is then
 * that before the call. O(number of elements) an iteration. */
DMB_API int32_t dmb_analysis_static(dmb_sim *sim, const dmb_static_options *options, dmb_static_report *report);

/* ---- Buckling ----------------------------------------------------------------------------------------------------
 * The loads that grow with the factor of a buckling analysis or of a path, on top of the loads of the present time;
 * factor 0 is the present state. */
enum {
    DMB_SCALE_ALL = 0,   /* gravity, all loads, bit loads, forces of load drives: 1 + factor times the present ones */
    DMB_SCALE_LOADS = 1, /* the same without gravity */
    DMB_SCALE_PART = 2   /* one part: `factor` times a load as described; [N, N m] of a load drive; [m, rad] that a
                            motion drive of a string or body moves its component by, which joints, springs or forces
                            at several parts must not hold (DMB_ERR_UNSUPPORTED) */
};
typedef struct dmb_buckling_options {
    uint32_t struct_size;
    uint32_t count;       /* [-] of critical factors wanted, 1 .. 10000; default 1 */
    int32_t scale;        /* DMB_SCALE_..., default DMB_SCALE_LOADS */
    int32_t follow;       /* 1 (default): along the equilibria to the lowest factor; 0: extrapolated from the present
                             state alone */
    dmb_id part;          /* load or drive of DMB_SCALE_PART */
    double factor_max;    /* [unit of the factor] not looked beyond, > 0; default 1e12 */
    double tolerance;     /* [-] relative, of the factors, 1e-15 .. 0.1; default 1e-10 */
    double step;          /* [unit of the factor] difference that the change of the stiffness is taken over; 0
                             (default): moves the string by a millionth of an element */
    double slip_axial;    /* [m/s] friction as in dmb_static_options; the stiffness is unsymmetric then */
    double slip_rotation; /* [rad/s] */
} dmb_buckling_options;
DMB_SIZED_STRUCT(dmb_buckling_options)
/* Reason for the end of the way along the equilibria. */
enum {
    DMB_BUCKLING_EXTRAPOLATED = 0, /* there was none: follow = 0, or nothing buckles about the present state */
    DMB_BUCKLING_BIFURCATION = 1,  /* an eigenvalue of the stiffness passes 0, and the equilibria continue, unstable */
    DMB_BUCKLING_LIMIT = 2,        /* the factor is at a maximum of the path, or a contact that opens turns it back */
    DMB_BUCKLING_STABLE = 3,       /* none: det K keeps its sign up to `reached` */
    DMB_BUCKLING_DIP = 4           /* no eigenvalue of the stiffness passes 0, but the lowest one has a minimum of less
                                      than half its largest value before (`dip`): the equilibria bend off into the
                                      buckled shape, as those of an imperfect string do */
};
/* Flutter: motion that grows about equilibria before det K = 0, which an unsymmetric stiffness allows. Damped modes are
 * found at the points of the way, a twentieth of the lowest factor apart at most. */
enum {
    DMB_FLUTTER_NOT_JUDGED = 0, /* K is symmetric all the way, which allows none; friction is assumed to slip; the way
                                   is not followed and no mode grows in the present state; no modes found (message) */
    DMB_FLUTTER_NONE = 1,       /* none of all modes (up to 60 coordinates), or of the 24 lowest (more), grows */
    DMB_FLUTTER_FOUND = 2       /* one grows from flutter_factor on */
};
typedef struct dmb_buckling_info {
    uint32_t struct_size;
    uint32_t count;     /* [-] factors */
    uint32_t confirmed; /* [-] of them, the lowest: half the step length along the equilibria ends at the same first
                           factor (1e-5 of it, of a dip 1e-3), others are the same or have not changed from one
                           linearisation to the other; the others are extrapolations. The mesh is not halved: compare
                           with one of twice the elements */
    uint32_t linearisations; /* [-] of states on the path, the present one included */
    uint32_t points;         /* [-] equilibria found on the path */
    int32_t stiffness; /* DMB_STIFFNESS_... of the state linearised last. UNSYMMETRIC: factors are those of divergence,
                          det K = 0; flutter comes before (`flutter`) */
    int32_t end;       /* DMB_BUCKLING_... */
    int32_t flutter;   /* DMB_FLUTTER_... */
    double estimate;   /* [unit of the factor] the lowest factor, from the present state alone; infinite: none */
    double linearised_at;   /* [unit of the factor] state that the shapes and further factors were linearised about */
    double reached;         /* [unit of the factor] last equilibrium on the path before the end */
    double flutter_factor;  /* [unit of the factor] of FOUND: a mode grows from there on; 0: in the present state */
    double flutter_root[2]; /* [1/s] its root there, real and imaginary part, 0 without swinging, shape (2) */
    double dip; /* [-] of DMB_BUCKLING_DIP: 1 - lowest eigenvalue over its largest value before; 1: a perfect string;
                   below 0.92 it bends off gradually, and another mesh may give another minimum; 0: another end */
    double sinusoidal_share; /* [-] at the lowest factor that was followed to: largest DMB_PROFILE_SINUSOIDAL_SHARE of
                                all strings, for comparison with the closed form; NaN without a hole or a factor */
} dmb_buckling_info;
DMB_SIZED_STRUCT(dmb_buckling_info)
/* Critical factors and shapes; destroyed by the caller, one thread at a time. */
typedef struct dmb_buckling dmb_buckling;
/* Buckling from the present static state on (dmb_analysis_static first): the lowest factors > 0 at which K + factor dK
 * is singular. K is the tangent stiffness with its contacts as they are, closed ones holding and swinging with F/e
 * around the axis; dK is its change along the response of the state to the pattern of loads, both in the frames of the
 * state; with joints both are those of the independent coordinates. A symmetric K is counted by the signs of the pivots
 * (Sylvester), so that no factor is missed, and factors are found by bisection; of an unsymmetric one they are the real
 * eigenvalues by Krylov subspaces: loads at which it diverges. It may flutter before, by a mode that grows while det K
 * keeps its sign; so damped modes are computed along the path (`flutter`). A complex pair of eigenvalues of K that
 * becomes real and negative is no stability limit: its load depends on the weights of the coordinates. A linearisation
 * is an extrapolation, good where sections turn and contacts shift little. So the equilibria are followed
 * (dmb_analysis_path) to the factor, linearised again, and so on until an eigenvalue of their stiffness passes 0: the
 * lowest factor is where the path loses its stability, at a bifurcation or limit point, and shape and further factors
 * are linearised just before; or where the lowest eigenvalue of a symmetric stiffness has a deep minimum
 * (DMB_BUCKLING_DIP; one factor, shape of that eigenvalue). The path is then followed again in steps of half the
 * length, up to two times, until two runs agree. dmb_buckling_get_info reports it. The sim is not changed.
 * DMB_NOTE_STOPPED where fewer than `count` lie below factor_max or can be found (beyond a limit point none can;
 * message says how far the equilibria stay stable where there is none). DMB_NOTE_EXTRAPOLATED where some of the factors
 * are not confirmed. Before these notes: DMB_NOTE_FLUTTER where a damped mode grows before the lowest factor; also
 * where there is no such factor, up to a factor_max below 1e12 or to where the equilibria could be followed.
 * DMB_NOTE_INCOMPLETE where that could not be assessed though K is unsymmetric. Errors: DMB_ERR_VALUE, _ID, _ORDER (the
 * state is no equilibrium or not stable; message says by how much), _SINGULAR (message says which part is free),
 * _NO_CONVERGENCE (the equilibria could not be followed; message says how far), _UNSUPPORTED (a motion drive of a
 * joint; a state that slides or turns by its drives: take DMB_STEADY_AT_REST, and the slip here, for it), _NO_MEMORY,
 * _CALLBACK, _CANCELLED; *buckling is NULL then. Some 40 counts a factor and 10 to 100 iterations of the path, each
 * O(number of elements); memory: the sim's twice more and 3 matrices, from its allocator.
 */
DMB_API int32_t dmb_analysis_buckling(dmb_sim *sim, const dmb_buckling_options *options, dmb_buckling **buckling);
DMB_API int32_t dmb_buckling_get_info(const dmb_buckling *buckling, dmb_buckling_info *info);
/* Gives the memory back and sets *buckling to NULL. NULL-safe. */
DMB_API void dmb_buckling_destroy(dmb_buckling **buckling);
/* Factors found; 0 for NULL. */
DMB_API uint32_t dmb_buckling_count(const dmb_buckling *buckling);
/* [unit of the factor] The critical factor number `mode`, rising from 0 on. DMB_ERR_NULL, _HANDLE, _VALUE. */
DMB_API int32_t dmb_buckling_factor(const dmb_buckling *buckling, uint32_t mode, double *factor);
/* [m, rad] displacement and rotation of a section in the buckling shape, world frame, the largest displacement of a
 * node being 1 m in its own axes; shape (6). Errors as above and those of dmb_query_motion. */
DMB_API int32_t dmb_buckling_shape(const dmb_buckling *buckling, uint32_t mode, dmb_place place, double shape[6]);

/* ---- Paths of equilibrium ----------------------------------------------------------------------------------------
 * Follows the equilibrium that a growing factor (DMB_SCALE_...) leads along, past limit points and onto branches. */
enum {
    DMB_PATH_REGULAR = 0,
    DMB_PATH_LIMIT = 1,       /* the factor is at a maximum or minimum of the path */
    DMB_PATH_BIFURCATION = 2, /* another path crosses: the stiffness is singular and the factor continues */
    DMB_PATH_BRANCH = 3       /* first point of the path that crossed */
};
typedef struct dmb_path_point {
    uint32_t struct_size;
    uint32_t number;     /* [-] 0: the state the path begins in */
    int32_t kind;        /* DMB_PATH_... */
    int32_t negative;    /* [-] as in dmb_static_report, of the 12 nearest 0 where UNSYMMETRIC; 0: stable */
    uint32_t iterations; /* [-] of this point */
    int32_t stiffness;   /* DMB_STIFFNESS_... */
    double factor;       /* [unit of the factor] */
    double rate;         /* [unit of the factor/m] of the factor along the path, < 0 where it falls */
    double arc;          /* [m] length of the path so far, root of the mean square of the motion of the nodes */
    double displacement; /* [m] of the watched place and component since time 0; 0: none is watched */
} dmb_path_point;
DMB_SIZED_STRUCT(dmb_path_point)
/* Called at each point with a sim that is there at rest: every query works, snapshots may be taken and, after the
 * call, restored into the sim the path began with. Returns 0, or nonzero to stop. */
typedef int32_t (*dmb_path_fn)(void *context, const dmb_sim *at, const dmb_path_point *point);
typedef struct dmb_path_options {
    uint32_t struct_size;
    uint32_t max_points;     /* [-] 1 .. 1000000; default 200 */
    uint32_t max_iterations; /* [-] of one point, 2 .. 1000; default 15 */
    int32_t scale;           /* DMB_SCALE_..., default DMB_SCALE_LOADS */
    dmb_id part;             /* load or drive of DMB_SCALE_PART */
    dmb_place place;         /* place that is watched; part {0, 0} (default): none */
    int32_t component;       /* of its displacement in the world, DMB_X (default) .. DMB_Z */
    int32_t branch;          /* 1 or -1: leaves the path at the first bifurcation, to that side; 0 (default): stays */
    double factor_end;       /* [unit of the factor] ends there; the path begins towards it; not 0; default 1 */
    double displacement_end; /* [m] ends there; default 1e30: nowhere */
    double first_step;       /* [unit of the factor] > 0; 0 (default): a tenth of factor_end */
    double step_max;         /* [m] longest arc from point to point, > 0; default 1e30 */
    double branch_size;      /* [m] arc of the first step on a branch; 0 (default): that of the step before */
    double tolerance;        /* [-] of the residual, as in dmb_static_options; default 1e-10 */
    double slip_axial;       /* [m/s] friction as in dmb_static_options */
    double slip_rotation;    /* [rad/s] */
    dmb_path_fn callback;    /* may be NULL */
    void *callback_context;
} dmb_path_options;
DMB_SIZED_STRUCT(dmb_path_options)
typedef struct dmb_path_report {
    uint32_t struct_size;
    uint32_t points;          /* [-] beyond the start, limit points and bifurcations included */
    uint32_t limits;          /* [-] limit points passed */
    uint32_t bifurcations;    /* [-] passed or left at */
    uint32_t iterations;      /* [-] in all */
    uint32_t cuts;            /* [-] steps that were halved */
    double factor;            /* [unit of the factor] at the end */
    double displacement;      /* [m] at the end */
    double first_limit;       /* [unit of the factor] at the first limit point; NaN: none */
    double first_bifurcation; /* [unit of the factor] at the first bifurcation; NaN: none */
} dmb_path_report;
DMB_SIZED_STRUCT(dmb_path_report)
/* Follows the path from the present static state on by arc length: a step along the tangent, then Newton in the plane
 * across it (Riks 1979) with the factor bordering the stiffness (Crisfield 1981), the step as long as Newton likes it.
 * Limit points, bifurcations and the ends are located to 1e-8 of the step by regula falsi. Where K is unsymmetric, a
 * step is a twentieth of factor_end at most: an eigenvalue that leaves and one that comes back closer together may be
 * passed by. Two that a complex pair becomes change `negative` and are no bifurcation: det K keeps its sign. The sim is
 * not changed. options and report may be NULL; where the path was lost the report states how far it came.
 * DMB_NOTE_STOPPED after max_points or by the callback. Errors: DMB_ERR_VALUE, _ID, _ORDER (the state is no
 * equilibrium), _SINGULAR (message says which part is free, or that the factor moves nothing), _NO_CONVERGENCE (message
 * says where the path was lost), _ROTATION (above 2.5 rad in an element; message says where), _UNSUPPORTED (as of
 * buckling), _NO_MEMORY, _CALLBACK, _CANCELLED. O(number of elements) an iteration; memory: the sim's once more. */
DMB_API int32_t dmb_analysis_path(dmb_sim *sim, const dmb_path_options *options, dmb_path_report *report);

/* ---- Model check -------------------------------------------------------------------------------------------------
 * The parts of a scene, its degrees of freedom, and warnings. */
typedef struct dmb_check_report {
    uint32_t struct_size;
    uint32_t rigid_parts;       /* [-] bodies and bits (fixed to a string or not), rigid pipes, rigid tool joints */
    uint32_t flexible_parts;    /* [-] flexible and axial-torsional pipes */
    uint32_t elements;          /* [-] of those */
    uint32_t structural_joints; /* [-] fixed joints inside strings, which cost no unknowns */
    uint32_t joints[16];        /* [-] described joints that are not open, by DMB_JOINT_ kind, shape (16) */
    uint32_t open_joints;       /* [-] described joints that are open now */
    uint32_t locked_joints;     /* [-] of `joints` those that are locked now */
    uint32_t couplings;         /* [-] */
    uint32_t constraints;       /* [-] the caller's */
    uint32_t motion_drives;     /* [-] DMB_DRIVE_MOTION */
    uint32_t other_drives;      /* [-] DMB_DRIVE_LOAD and _CONTROL */
    uint32_t loads;             /* [-] */
    uint32_t coordinates;       /* [-] velocity components of all nodes: 6 or (axial-torsional) 2 each */
    uint32_t held;              /* [-] of them held by supports: start_free, end_free, free_mask */
    uint32_t prescribed;        /* [-] of them moved by motion drives of strings and bodies */
    uint32_t constraint_rows;   /* [-] equations that act now: of joints, couplings, constraints, joint motion drives */
    uint32_t rank;              /* [-] of their matrix in the coordinates that are neither held nor prescribed */
    uint32_t degrees_of_freedom; /* [-] true degrees of freedom: coordinates - held - prescribed - rank */
    uint32_t redundant;          /* [-] equations that others imply: rows - rank */
    uint32_t tridiagonal_nodes;  /* [-] nodes whose chains the block-tridiagonal solver takes */
    uint32_t sparse_nodes;       /* [-] nodes of chains that equations connect: the sparse solver's */
    uint32_t blocks;             /* [-] of the sparse solver: clusters and the other nodes of those chains */
    uint32_t fill;               /* [-] couplings of blocks that its elimination adds, in CHOLMOD's order */
    uint32_t clusters;           /* [-] groups of nodes that equations connect directly */
    uint32_t largest_cluster;    /* [-] coordinates of the largest */
    uint32_t warnings;           /* [-] lines of warning in the text */
    int64_t gruebler; /* [-] coordinates - held - prescribed - rows; < degrees_of_freedom if equations are redundant */
    double largest_violation; /* [m, -] largest violation of an equation of position */
    double condition;         /* [-] smallest over largest singular value of a cluster's equations, redundant ones
                                 apart, at unit length, rotations at the mean element length; of the worst cluster;
                                 an estimate above 300 equations; 1 without any */
} dmb_check_report;
DMB_SIZED_STRUCT(dmb_check_report)

/* Counts the last accepted state of a sim. The rank is LAPACK's, by QR with column pivoting; it is held against that
 * of the partition the sim steps with (a warning if they differ). Changes nothing; calls the callbacks of constraints.
 * Memory for the time of the call comes from the allocator of the sim's options. Cost: elements, and the cube of the
 * coordinates of each cluster. Errors: DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _NO_MEMORY, _CALLBACK, _NOT_FINITE. */
DMB_API int32_t dmb_analysis_check(const dmb_sim *sim, dmb_check_report *report);
/* The same as a sheet of text, lines ending with '\n', '.' as decimal mark: counts, solvers, redundant equations by
 * name (directions are those of frame a of the joint), warnings. Writes at most `size` bytes, always 0-terminated;
 * *needed (may be NULL) is the size of the whole text, its 0 included. text may be NULL where size is 0. DMB_NOTE_FULL
 * if the text is cut. Errors as dmb_analysis_check, with text and *needed left alone. */
DMB_API int32_t dmb_analysis_check_text(const dmb_sim *sim, char *text, size_t size, size_t *needed);

/* Estimated discretisation error of each pipe of a string that lies on the wall of its hole, for the choice of
 * dmb_pipe_def.elements: bending stress q s^2/12 (r/EI) of an element between two points of contact, which the wall of
 * a real hole supports all along, over the yield strength (yield_strength, else a strain of 0.003). q [N/m]: weight
 * across the axis of the hole and tension by the weight below times the curvature of the hole; s [m]: spacing of the
 * points of contact. The error falls with the square of the element's length. error [-], shape (capacity): by pipe from
 * the rig end; 0 for rigid and axial-torsional pipes and without a wall that is met; values above 0.01 are warned of by
 * dmb_analysis_check. capacity >= pipes of the string. Of a compiled model; changes nothing; any number of threads.
 * Errors: DMB_ERR_NULL, _HANDLE, _ORDER (not compiled), _ID (no string of this model), _VALUE (capacity). O(elements).
 */
DMB_API int32_t dmb_analysis_mesh(const dmb_model *model, dmb_id string, double *error, uint32_t capacity);

/* ---- Linear analyses ---------------------------------------------------------------------------------------------
 * The wall in small motion about a state (modes.h, response.h). */
enum {
    DMB_CONTACT_AS_IS = 0, /* contact rings that touch the wall press on it, others do not */
    DMB_CONTACT_OPEN = 1,  /* there is no wall; its forces in the state stay as dead loads */
    DMB_CONTACT_CLOSED = 2 /* contact rings up to `contact_gap` from the wall are held across it too */
};

DMB_C_END
#endif
