/* libdrillmbd - analyses: statics, buckling, modes, responses, state space, sensitivities, torque and drag, fatigue. */
#ifndef DRILLMBD_ANALYSE_H
#define DRILLMBD_ANALYSE_H
#include "ask.h"
DMB_C_BEGIN
/* Analyses use the accepted state of a sim and leave it unchanged unless stated otherwise; the sim has their message. Results are
 * opaque: _destroy gives their memory back, sets the pointer to NULL and accepts NULL. options and report may be NULL. Memory
 * comes from the sim's allocator, until _destroy or the end of the call. One thread at a time may use a sim or a result. Errors
 * of every function of this header: DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _VALUE, _NOT_FINITE, _ID, _ORDER (within a call on the
 * sim), _NO_MEMORY; of those that take a sim that is not const also _CALLBACK, _CANCELLED, _ROTATION, _GEOMETRY, _SINGULAR,
 * _NO_CONVERGENCE as of a step. Results are NULL then, and arrays and reports as before. Functions list further ones.
 *
 * Same bits: steps and all that is read off a state have the same bits in any number of threads; so have statics, paths,
 * buckling, responses, stepped sine and safe speeds, which call no BLAS. Modes, and `condition` of a model check, have LAPACK's
 * digits (examples/README.md, Reproducibility). */
/* Steady states of a scene whose motion drives (DMB_DRIVE_MOTION) move at the present time, in which a run continues without a
 * transient. Time functions that change count with their speed at that time. */
enum {
    DMB_STEADY_AUTO = 0, /* AT_REST where nothing moves or a slip is assumed, SLIDING where strings are moved along and about
        their axis, RIGID else, or where masses are eccentric; AT_REST with DMB_NOTE_NOT_STEADY where neither is steady */
    DMB_STEADY_AT_REST = 1, /* all is at rest; only components of motion drives have their speed */
    DMB_STEADY_SLIDING = 2, /* axes at rest; strings slide along the hole and turn about their axis as drives say */
    DMB_STEADY_RIGID = 3 /* all turns about one fixed axis like a rigid body, under centrifugal forces */
};
typedef struct dmb_static_options {
    uint32_t struct_size, max_iterations; /* [-] of one load step, 1 .. 10000; default 60 */
    double tolerance; /* [-] residual over the norm of the forces that balance in it; default 1e-10 */
    double slip_axial, slip_rotation; /* [m/s; rad/s] friction acts as if the string slid along the hole and turned at these
        speeds, both 0 (default): no friction in the static state. With a slip the state is quasi-static: until the next step its
        accelerations are 0 and section forces contain neither inertia nor damping */
    uint32_t load_steps; /* [-] equal steps from no load to full load, <= 10000, before the library chooses them itself; 0
        (default): the whole load at once */
    int32_t lay_on_wall; /* 1 (default): start from the string lying on the low side of its hole; 0: from the present pose */
    int32_t steady, reserved; /* DMB_STEADY_..., default DMB_STEADY_AUTO */
} dmb_static_options;
DMB_SIZED_STRUCT(dmb_static_options)
/* Kinds of stiffness by which the stability of a static state is assessed. */
enum {
    DMB_STIFFNESS_SYMMETRIC = 0, /* forces have a potential: the state is stable where no eigenvalue is negative */
    DMB_STIFFNESS_UNSYMMETRIC = 1 /* friction that slips, moments with a fixed axis, followers: the state diverges by each real
        negative eigenvalue; by complex ones it may flutter, which depends on mass and damping and is computed by
        dmb_analysis_modes with DMB_MODES_DAMPED */
};
enum { DMB_STATIC_NEWTON = 0, DMB_STATIC_RELAXATION = 1 };
typedef struct dmb_static_report {
    uint32_t struct_size, iterations; /* [-] in all */
    uint32_t load_steps; /* [-] carried out */
    int32_t method; /* DMB_STATIC_...: the last resort that was needed */
    double residual, largest_force; /* [-; N, N m over the element length] relative; largest component of it; at the end */
    double lateral_move; /* [m] largest displacement from the starting pose */
    uint32_t cuts, line_searches; /* [-] load steps that were halved; corrections that were shortened by a line search */
    int32_t negative; /* [-] negative eigenvalues of the stiffness (eq:signs.bounds), by which the equilibrium is unstable; -1:
        not resolved (none is known to be negative; `unresolved`). UNSYMMETRIC: the real negative ones; above 400 coordinates
        those within reach of the symmetric part, or if there are any, those among the 108 nearest 0. Of a state that moves
        (`steady`): in its moving axes with centrifugal forces; gyroscopic ones may hold it, or damping not */
    int32_t stiffness; /* DMB_STIFFNESS_...: the kind that was assessed */
    int32_t steady, steady_reserved; /* DMB_STEADY_AT_REST, _SLIDING or _RIGID: kind of the state */
    int32_t free_spins; /* [-] rotations of strings about their own axes that nothing resists, strings that turn together counted
        once: every angle is an equilibrium, and the starting one is kept */
    int32_t unresolved; /* [-] eigenvalues of rounding size, whose signs the count does not resolve: motions that nothing resists,
        or a mesh too fine for double precision; SYMMETRIC only */
    double resolution; /* [N/m] largest eigenvalue, rotations over the square of the mean element length, that may be of rounding
        size: 4 eps of the largest stiffness */
} dmb_static_report;
DMB_SIZED_STRUCT(dmb_static_report)
/* Static start: puts the sim at rest in the equilibrium of its loads, gravity, wall and drives at its present time, or, where
 * motion drives move, in a steady motion (`steady`). lib/theory/statics.md has the strategies, from Newton to relaxation, and the
 * forces that act in each state. At rest the rock law does not act and a speed controller acts as at speed 0. The energy ledger
 * restarts. A string whose rotation about its axis nothing resists keeps it (free_spins) where the torques about the axis sum to
 * 0. DMB_NOTE_UNSTABLE: the equilibrium at rest is one that the string would leave (negative > 0); DMB_NOTE_INCOMPLETE: its
 * stability is not resolved (negative < 0; message states the bound), or a string slid along its hole by over a tenth of its
 * length; DMB_NOTE_NOT_STEADY. Errors: DMB_ERR_SINGULAR (message says which part is free), _NO_CONVERGENCE, _ROTATION,
 * _UNSUPPORTED (SLIDING with an eccentric mass, pre-bent pipe or load across that turns with its part, RIGID with gravity, loads,
 * supports, joints or a hole off the axis); the state is then that before the call. O(elements) an iteration. */
DMB_API int32_t dmb_analysis_static(dmb_sim *sim, const dmb_static_options *options, dmb_static_report *report);

/* ---- Buckling ----------------------------------------------------------------------------------------------------- */
/* The loads that grow with the factor of a buckling analysis or of a path, on top of the present ones (factor 0). */
enum {
    DMB_SCALE_ALL = 0, /* gravity, all loads, bit loads, forces of load drives: 1 + factor times the present ones */
    DMB_SCALE_LOADS = 1, /* the same without gravity */
    DMB_SCALE_PART = 2 /* one part: `factor` times a load as described; [N, N m] of a load drive; [m, rad] that a motion drive of
        a string or body moves its component by, not held by joints, springs or forces at several parts (DMB_ERR_UNSUPPORTED) */
};
typedef struct dmb_buckling_options {
    uint32_t struct_size, count; /* [-] of critical factors wanted, 1 .. 10000; default 1 */
    int32_t scale; /* DMB_SCALE_..., default DMB_SCALE_LOADS */
    int32_t follow; /* 1 (default): along the equilibria to the lowest factor; 0: extrapolated from the present state alone */
    dmb_id part; /* load or drive of DMB_SCALE_PART */
    double factor_max, tolerance; /* [unit of the factor; -] largest sought, > 0; relative, 1e-15 .. 0.1; default 1e12, 1e-10 */
    double step; /* [unit of the factor] difference for the change of the stiffness; 0 (default): strings move by 1e-6 elements */
    double slip_axial, slip_rotation; /* [m/s; rad/s] friction as in dmb_static_options, the stiffness is unsymmetric then */
} dmb_buckling_options;
DMB_SIZED_STRUCT(dmb_buckling_options)
/* Reason why path following ended. */
enum {
    DMB_BUCKLING_EXTRAPOLATED = 0, /* no path was followed: follow = 0, or nothing buckles about the present state */
    DMB_BUCKLING_BIFURCATION = 1, /* an eigenvalue of the stiffness passes 0, and the equilibria continue, unstable */
    DMB_BUCKLING_LIMIT = 2, /* the factor is at a maximum of the path, or a contact that opens turns it back */
    DMB_BUCKLING_STABLE = 3, /* none: det K keeps its sign up to `reached` */
    DMB_BUCKLING_DIP = 4 /* no eigenvalue of the stiffness passes 0, but the lowest one has a minimum of less than half its
        largest value before (`dip`): the equilibria bend off into the buckled shape, as those of an imperfect string do */
};
/* Flutter: motion that grows about equilibria before det K = 0, which an unsymmetric stiffness allows. Damped modes are computed
 * at the points of the path, at most a twentieth of the lowest factor apart. */
enum {
    DMB_FLUTTER_NOT_JUDGED = 0, /* K is symmetric on the whole path, which allows none; friction is assumed to slip; no path is
        followed and no mode grows in the present state; no modes found (message) */
    DMB_FLUTTER_NONE = 1, /* none of all modes (up to 60 coordinates), or of the 24 lowest (more), grows */
    DMB_FLUTTER_FOUND = 2 /* one grows from flutter_factor on */
};
typedef struct dmb_buckling_info {
    uint32_t struct_size, count; /* [-] factors */
    uint32_t confirmed; /* [-] of them, the lowest: half the step length along the equilibria ends at the same first factor (1e-5
        of it, of a dip 1e-3), others are the same or have not changed from one linearisation to the other; the others are
        extrapolations. The mesh is not halved: compare with one of twice the elements */
    uint32_t linearisations, points; /* [-] of states on the path, the present one included; equilibria found on the path */
    int32_t stiffness; /* DMB_STIFFNESS_... of the state linearised last. UNSYMMETRIC: divergence, det K = 0; see `flutter` */
    int32_t end, flutter; /* DMB_BUCKLING_..., DMB_FLUTTER_... */
    double estimate; /* [unit of the factor] the lowest factor, from the present state alone; infinite: none */
    double linearised_at, reached; /* [unit of the factor] state that the shapes and further factors were linearised about; last
        equilibrium on the path before the end */
    double flutter_factor; /* [unit of the factor] of FOUND: a mode grows from there on; 0: in the present state */
    double flutter_root[2]; /* [1/s] its root there, real and imaginary part, 0 without swinging */
    double dip; /* [-] of DMB_BUCKLING_DIP: 1 - lowest eigenvalue over its largest value before; 1: a perfect string; below 0.92
        it bends off gradually, and another mesh may give another minimum; 0: another end */
    double sinusoidal_share; /* [-] at the lowest factor that was followed to: largest DMB_PROFILE_SINUSOIDAL_SHARE of all
        strings, for comparison with the closed form; NaN without a hole or a factor */
} dmb_buckling_info;
DMB_SIZED_STRUCT(dmb_buckling_info)
typedef struct dmb_buckling dmb_buckling; /* critical factors and shapes */
/* Buckling from the present static state on (dmb_analysis_static first): the lowest factors > 0 at which K + factor dK is
 * singular, K the tangent stiffness with its contacts as they are, dK its change along the response of the state to the pattern
 * of loads (eq:buckling.pencil); with joints both are those of the independent coordinates. A linearisation is an extrapolation,
 * good where sections turn and contacts shift little, so the equilibria are followed to the factor, linearised again, and so on,
 * until an eigenvalue of their stiffness passes 0 or has a deep minimum (DMB_BUCKLING_DIP: one factor), and again in steps of
 * half the length, up to two times, until two runs agree (lib/theory/statics.md). Notes, the first that applies:
 * DMB_NOTE_FLUTTER: a damped mode grows before the lowest factor, or, without such a factor, up to a factor_max below 1e12 or to
 * where the equilibria could be followed; DMB_NOTE_INCOMPLETE: that could not be assessed though K is unsymmetric;
 * DMB_NOTE_EXTRAPOLATED: some of the factors are not confirmed; DMB_NOTE_STOPPED: fewer than `count` lie below factor_max or can
 * be found (beyond a limit point none can; without a factor the message says how far the equilibria stay stable). Errors:
 * DMB_ERR_ORDER (the state is no equilibrium or not stable; message says by how much), _SINGULAR (message says which part is
 * free), _NO_CONVERGENCE (the equilibria could not be followed; message says how far), _UNSUPPORTED (a motion drive of a joint; a
 * state that slides or turns by its drives: take DMB_STEADY_AT_REST, and the slip here, for it). Some 40 counts a factor and 10
 * to 100 iterations of the path, each O(elements); memory: the sim's twice more and 3 matrices. */
DMB_API int32_t dmb_analysis_buckling(dmb_sim *sim, const dmb_buckling_options *options, dmb_buckling **buckling);
DMB_API int32_t dmb_buckling_get_info(const dmb_buckling *buckling, dmb_buckling_info *info);
DMB_API void dmb_buckling_destroy(dmb_buckling **buckling);
DMB_API uint32_t dmb_buckling_count(const dmb_buckling *buckling); /* [-] factors found; 0 for NULL */
/* [unit of the factor] The critical factor number `mode`, rising from 0 on. */
DMB_API int32_t dmb_buckling_factor(const dmb_buckling *buckling, uint32_t mode, double *factor);
/* [m, rad] displacement and rotation of a section in the buckling shape, world frame, the largest displacement of a node being 1
 * m in its own axes; shape (6). */
DMB_API int32_t dmb_buckling_shape(const dmb_buckling *buckling, uint32_t mode, dmb_place place, double shape[6]);

/* ---- Paths of equilibrium ----------------------------------------------------------------------------------------
 * Follows the equilibrium that a growing factor (DMB_SCALE_...) leads along, past limit points and onto branches. */
enum {
    DMB_PATH_REGULAR = 0,
    DMB_PATH_LIMIT = 1, /* the factor is at a maximum or minimum of the path */
    DMB_PATH_BIFURCATION = 2, /* another path crosses: the stiffness is singular and the factor continues */
    DMB_PATH_BRANCH = 3 /* first point of the path that crossed */
};
typedef struct dmb_path_point {
    uint32_t struct_size, number; /* [-] 0: the state the path begins in */
    int32_t kind; /* DMB_PATH_... */
    int32_t negative; /* [-] as in dmb_static_report, of the 12 nearest 0 where UNSYMMETRIC; 0: stable */
    uint32_t iterations; /* [-] of this point */
    int32_t stiffness; /* DMB_STIFFNESS_... */
    double factor, rate; /* [unit of the factor; unit of the factor/m] its rate along the path, < 0 where it falls */
    double arc; /* [m] length of the path so far, root of the mean square of the motion of the nodes */
    double displacement; /* [m] of the watched place and component since time 0; 0: none is watched */
} dmb_path_point;
DMB_SIZED_STRUCT(dmb_path_point)
/* Called at each point with a sim that is there at rest: every query works, snapshots may be taken and, after the call, restored
 * into the sim the path began with. Returns 0, or nonzero to stop. */
typedef int32_t (*dmb_path_fn)(void *context, const dmb_sim *at, const dmb_path_point *point);
typedef struct dmb_path_options {
    uint32_t struct_size, max_points; /* [-] 1 .. 1000000; default 200 */
    uint32_t max_iterations; /* [-] of one point, 2 .. 1000; default 15 */
    int32_t scale; /* DMB_SCALE_..., default DMB_SCALE_LOADS */
    dmb_id part; /* load or drive of DMB_SCALE_PART */
    dmb_place place; /* place that is watched; part {0, 0} (default): none */
    int32_t component; /* of its displacement in the world, DMB_X (default) .. DMB_Z */
    int32_t branch; /* 1 or -1: leaves the path at the first bifurcation, to that side; 0 (default): stays */
    double factor_end; /* [unit of the factor] where the path ends and towards which it begins, not 0; default 1 */
    double displacement_end; /* [m] ends there; default DMB_UNLIMITED: nowhere */
    double first_step, step_max; /* [unit of the factor; m] > 0, 0: factor_end/10; longest arc, > 0; default 0, DMB_UNLIMITED */
    double branch_size; /* [m] arc of the first step on a branch; 0 (default): that of the step before */
    double tolerance; /* [-] of the residual, as in dmb_static_options; default 1e-10 */
    double slip_axial, slip_rotation; /* [m/s; rad/s] friction as in dmb_static_options */
    dmb_path_fn callback; /* may be NULL */
    void *callback_context;
} dmb_path_options;
DMB_SIZED_STRUCT(dmb_path_options)
typedef struct dmb_path_report {
    uint32_t struct_size, points; /* [-] beyond the start, limit points and bifurcations included */
    uint32_t limits, bifurcations; /* [-] limit points passed; bifurcations passed or left at */
    uint32_t iterations, cuts; /* [-] in all; steps that were halved */
    double factor, displacement; /* [unit of the factor; m] at the end */
    double first_limit, first_bifurcation; /* [unit of the factor] at the first limit point, the first bifurcation, NaN: none */
} dmb_path_report;
DMB_SIZED_STRUCT(dmb_path_report)
/* Follows the path from the present static state on by arc length (eq:buckling.arc). Limit points, bifurcations and the ends are
 * located to 1e-8 of the step. Where K is unsymmetric, a step is a twentieth of factor_end at most: an eigenvalue that leaves and
 * one that comes back closer together may be passed by. Two that a complex pair becomes change `negative` and are no bifurcation.
 * The report of a lost path states its end. DMB_NOTE_STOPPED after max_points or by the callback, _INCOMPLETE where `negative` is
 * -1: two that pass 0 there may be missing. Errors: DMB_ERR_ORDER (the state is no equilibrium), _SINGULAR (message says which
 * part is free, or that the factor moves nothing), _NO_CONVERGENCE (message says where), _ROTATION (2.5 rad in an element;
 * message says where), _UNSUPPORTED (as of buckling). O(elements) an iteration; memory: the sim's once more. */
DMB_API int32_t dmb_analysis_path(dmb_sim *sim, const dmb_path_options *options, dmb_path_report *report);

/* ---- Model check -------------------------------------------------------------------------------------------------
 * The parts of a scene, its degrees of freedom, and warnings. */
typedef struct dmb_check_report {
    uint32_t struct_size, rigid_parts; /* [-] bodies and bits (fixed to a string or not), rigid pipes, rigid tool joints */
    uint32_t flexible_parts, elements; /* [-] flexible and axial-torsional pipes; elements of those */
    uint32_t structural_joints; /* [-] fixed joints inside strings, which cost no unknowns */
    uint32_t joints[32]; /* [-] described joints that are not open, by DMB_JOINT_ kind; 0 beyond the kinds */
    uint32_t open_joints, locked_joints; /* [-] described joints that are open now; of `joints` those that are locked now */
    uint32_t couplings, constraints; /* [-] couplings; constraints of the caller */
    uint32_t motion_drives, other_drives, loads; /* [-] DMB_DRIVE_MOTION; DMB_DRIVE_LOAD and _CONTROL; loads */
    uint32_t coordinates; /* [-] velocity components of all nodes: 6 or (axial-torsional) 2 each */
    uint32_t held, prescribed; /* [-] of them held by supports (start_free, end_free, free_mask); moved by motion drives of
        strings and bodies */
    uint32_t constraint_rows, rank; /* [-] equations that act now: of joints, couplings, constraints, joint motion drives; rank of
        their matrix in the coordinates that are neither held nor prescribed */
    uint32_t degrees_of_freedom, redundant; /* [-] coordinates - held - prescribed - rank; rows - rank, implied by others */
    uint32_t tridiagonal_nodes, sparse_nodes; /* [-] nodes whose chains the block-tridiagonal solver takes; nodes of chains that
        equations connect: the sparse solver's */
    uint32_t blocks, fill; /* [-] of the sparse solver: clusters and the other nodes of those chains; couplings of blocks that its
        elimination adds */
    uint32_t clusters, largest_cluster; /* [-] groups of nodes that equations connect directly; coordinates of the largest */
    uint32_t warnings; /* [-] lines of warning in the text */
    int64_t gruebler; /* [-] coordinates - held - prescribed - rows; < degrees_of_freedom if equations are redundant */
    double largest_violation; /* [m, -] largest violation of an equation of position */
    double condition; /* [-] smallest over largest singular value of a cluster's equations, redundant ones apart, at unit length,
        rotations at the mean element length; of the worst cluster; an estimate above 300 equations; 1 without any */
} dmb_check_report;
DMB_SIZED_STRUCT(dmb_check_report)
/* Counts the last accepted state of a sim. The rank is LAPACK's, by QR with column pivoting; it is held against that of the
 * partition the sim steps with (a warning if they differ). Calls the callbacks of constraints. Cost: elements, and the cube of
 * the coordinates of each cluster. Errors: DMB_ERR_CALLBACK, _SINGULAR. */
DMB_API int32_t dmb_analysis_check(const dmb_sim *sim, dmb_check_report *report);
/* The same (errors too) as a sheet of text, lines ending with '\n', '.' as decimal mark: counts, solvers, redundant equations by
 * name (directions are those of frame a of the joint), warnings. Writes at most `size` bytes, always 0-terminated; *needed (may
 * be NULL) is the size of the whole text, its 0 included. text may be NULL where size is 0. DMB_NOTE_FULL: it is cut. */
DMB_API int32_t dmb_analysis_check_text(const dmb_sim *sim, char *text, size_t size, size_t *needed);
/* Estimated discretisation error of each pipe of a string that lies on the wall of its hole, for the choice of
 * dmb_pipe_def.elements (eq:beam.mesh-error): bending stress of an element between two contact points, by the weight of all below
 * it, over the yield strength (yield_strength, else a strain of 0.003). It falls with the square of the length of the elements.
 * error [-], shape (capacity): by pipe from the rig end; 0 for rigid and axial-torsional pipes and without a wall that is met;
 * dmb_analysis_check warns above 0.01. capacity >= its pipes. Of a compiled model; any number of threads. O(elements). */
DMB_API int32_t dmb_analysis_mesh(const dmb_model *model, dmb_id string, double *error, uint32_t capacity);

/* ---- Linear analyses ---------------------------------------------------------------------------------------------- */
/* The wall in small motion about a state. */
enum {
    DMB_CONTACT_AS_IS = 0, /* contact rings that touch the wall press on it, others do not */
    DMB_CONTACT_OPEN = 1, /* there is no wall; its forces in the state stay as dead loads */
    DMB_CONTACT_CLOSED = 2 /* contact rings up to `contact_gap` from the wall are held across it too */
};

/* ---- Modes ------------------------------------------------------------------------------------------------------ */
/* Free vibration M d'' + C d' + K d = 0, d small body-frame displacements, with everything that acts in the state: preload, wall,
 * friction, joints, drives, and the gyroscopic terms of a steady rotation. */
typedef struct dmb_modes dmb_modes;
enum { DMB_MODES_UNDAMPED = 0, /* M d'' + K d = 0 */ DMB_MODES_DAMPED = 1 /* with C: damping and gyroscopic terms */ };
enum { DMB_MODES_LOWEST = 0, DMB_MODES_ALL = 1, DMB_MODES_BAND = 2 };
/* Axes of small displacements: those of the parts, which turn with them (a standing wave of w is two there, at w + spin and |w -
 * spin|), or axes that do not take part in turning about the part's own x axis: frequencies as they are seen from outside. The
 * latter is for round parts: eccentric ones are out of balance. */
enum { DMB_MODES_AXES_TURNING = 0, DMB_MODES_AXES_AT_REST = 1 };
typedef struct dmb_modes_options {
    uint32_t struct_size;
    int32_t kind, select; /* DMB_MODES_UNDAMPED (default), _DAMPED; DMB_MODES_LOWEST (default), _ALL, _BAND */
    uint32_t count; /* [-] of LOWEST, 1 .. number of coordinates, twice that if DAMPED, where every real root is a mode (fewer
        come back where there are fewer); default 10 */
    double band[2]; /* [Hz] of BAND, 0 <= band[0] < band[1]; default 0 and 100 */
    int32_t contact; /* DMB_CONTACT_..., default DMB_CONTACT_AS_IS */
    int32_t friction; /* 1 (default): the slope of the friction law on the wall acts; 0: friction is a dead load */
    double contact_gap; /* [m] of DMB_CONTACT_CLOSED, >= 0; default 0 */
    double equilibrium_tolerance; /* [-] residual over the forces that balance in it, > 0, of a state; default 1e-6 */
    int32_t axes, reserved; /* DMB_MODES_AXES_TURNING (default), _AT_REST */
    double spin; /* [rad/s] strings turn at this speed in the state, about their own x axis; 0 (default): as they do. A static
        state with slip_rotation of this speed is in balance with friction but for the tilt of the pipes in the hole, some 1e-5 */
} dmb_modes_options;
DMB_SIZED_STRUCT(dmb_modes_options)
typedef struct dmb_modes_info {
    uint32_t struct_size, count; /* [-] modes found, by rising frequency */
    uint32_t rigid; /* [-] of them rigid-body modes: motions of all parts as rigid bodies that neither joints nor supports nor any
        force hold, K d = 0. They are found as such, not as small eigenvalues; each is reported once, with s = 0 */
    uint32_t coordinates; /* [-] independent coordinates of the linear system */
    int32_t dense; /* 1: by LAPACK on all coordinates; 0: by Krylov subspaces on sparse factors */
    uint32_t solves; /* [-] with those factors */
    double residual_of_state, asymmetry; /* [-] relative residual of the state without its body-frame accelerations; asymmetry of
        K, above 1e-9 treated as unsymmetric (friction, follower loads) */
    double residual; /* [-] largest |(s^2 M + s C + K) d| over the norms of the terms that balance in it */
    uint32_t double_roots, reserved; /* [-] roots that were reported as the mean of two or more with one shape (critical damping,
        the edge of flutter, straight motion seen in axes that spin): eq:modes.double */
} dmb_modes_info;
DMB_SIZED_STRUCT(dmb_modes_info)
typedef struct dmb_mode {
    uint32_t struct_size;
    int32_t rigid; /* 1: a rigid-body mode: nothing holds or strains it */
    double frequency, damping; /* [Hz; -] |s|/(2 pi); -Re s/|s|, 1 of an overdamped root, one mode, 0 of a rigid one */
    double eigenvalue[2]; /* [1/s] s, real and imaginary part >= 0. Flutter is two modes, one that grows and one that decays.
        Without damping, divergence (s, -s) is one mode, s > 0 */
    double kinetic, strain; /* [J] |s|^2 d^H M d/2 of the shape with d^H M d = 1 kg m2 (or kg); of elements, elastic part */
    double share[3]; /* [-] of the kinetic energy that is axial, torsional, lateral motion of pipes and bodies in their own axes;
        of a rigid mode at unit |s|; sum 1 */
    double participation[3], effective_mass[3]; /* [kg^0.5; kg] d^T M e for a base that moves along world x, y, z; their squares:
        sum over all modes = mass that is free to move */
    double whirl; /* [-] part of the kinetic energy in circles from y to z (forward, of spin > 0) less that in circles from z to y
        (backward), in `axes`: 1 .. -1; 0 of real shapes */
    double strain_share[3]; /* [-] of the strain energy that is stretch, twist, bending with shear; sum 1 or 0 */
} dmb_mode;
DMB_SIZED_STRUCT(dmb_mode)
typedef struct dmb_mode_shape {
    uint32_t struct_size;
    int32_t frame; /* in: DMB_FRAME_WORLD (default) or DMB_FRAME_BODY, axes of re and im */
    double re[6], im[6]; /* [m, rad] displacement and rotation of a place, d = Re(shape e^(s t)); im 0 if undamped */
} dmb_mode_shape;
DMB_SIZED_STRUCT(dmb_mode_shape)
/* Modes about the accepted state of a sim, which should be an equilibrium, at rest or spinning steadily; the sim need not outlive
 * the result. LOWEST: smallest |s|. Few modes cost O(elements), ALL and many the cube of the coordinates (LAPACK), a BAND, in
 * which every mode is found, in proportion to its modes; of damped ones whose roots do not lie along the imaginary axis at most
 * 256 below band[1] (eq:modes.count, eq:modes.strip). DMB_NOTE_INCOMPLETE: of the LOWEST those before the first that does not
 * converge (lib/theory/modes.md). Errors: DMB_ERR_VALUE (option; more modes than coordinates; a band without modes; a state out
 * of balance: by how much and where), _NO_CONVERGENCE (a mode that does not satisfy its equations to rounding, or cannot be
 * distinguished from a rigid-body motion: residual and bound), _UNSUPPORTED (coefficients that are not constant in `axes` while
 * the state moves on: eq:modes.turned), _TOO_LARGE, _SINGULAR. */
DMB_API int32_t dmb_analysis_modes(dmb_sim *sim, const dmb_modes_options *options, dmb_modes **modes);
DMB_API void dmb_modes_destroy(dmb_modes **modes);
DMB_API int32_t dmb_modes_get_info(const dmb_modes *modes, dmb_modes_info *info);
/* Mode number index. O(elements). */
DMB_API int32_t dmb_modes_get(const dmb_modes *modes, uint32_t index, dmb_mode *mode);
/* Shape at a place, between nodes by the element's own shape functions. O(1). */
DMB_API int32_t dmb_modes_shape(const dmb_modes *modes, uint32_t index, dmb_place place, dmb_mode_shape *shape);
/* [J] kinetic and strain energy of the mode, as in dmb_mode, in a pipe of a string with half of the parts fixed to its two ends,
 * in a whole string (pipe = DMB_NONE), or in a body or bit (pipe 0). O(elements of it). */
DMB_API int32_t dmb_modes_part(const dmb_modes *modes, uint32_t index, dmb_id part, uint32_t pipe, double *kinetic,
                               double *strain);
/* A frame of its animation for ParaView: the strings displaced by scale Re(shape e^(i phase)), as dmb_write_vtk_strings writes
 * them, with fields displacement and rotation. A numbered series of frames plays. Errors: DMB_ERR_IO. */
DMB_API int32_t dmb_write_vtk_mode(const dmb_modes *modes, uint32_t index, double scale, double phase, uint32_t per_element,
                                   const char *path);

/* ---- Excitation --------------------------------------------------------------------------------------------------
 * A quantity q is the real part of (re + i im) e^(i w t), w = 2 pi frequency. */
enum {
    DMB_EXCITATION_DRIVE = 0, /* time function of the drive place.part [its unit]: speed of MOTION, target speed of CONTROL, force
        of LOAD */
    DMB_EXCITATION_LOAD = 1, /* [-] factor of the load place.part */
    DMB_EXCITATION_BIT_LOAD = 2, /* [N] bottom-hole load of the bit place.part */
    DMB_EXCITATION_FORCE = 3, /* [N, N m] `component` of a force or moment at `place`, in `frame` */
    DMB_EXCITATION_UNBALANCE = 4, /* [kg m] mass times its distance from the axis at `place`: force times w^2. component DMB_RX:
        turning from y to z of `frame`; DMB_X .. DMB_Z: to and fro along that axis */
    DMB_EXCITATION_ECCENTRICITY = 5, /* [-] the scene's own eccentric masses (those of axial-torsional pipes, which are held
        across the hole, do nothing: DMB_ERR_UNSUPPORTED where all are), each times this factor, turning with the frequency about
        the axes of their pipes, from y to z, as they lie in the state at t = 0 */
    DMB_EXCITATION_FRICTION = 6, /* [-] coefficient: every contact ring on the wall is rubbed by it times its normal force in the
        state, along the hole (component DMB_X) or around it (DMB_RX) */
    DMB_EXCITATION_SETTING = 7 /* the input place.part of scene.h [its unit]: a set point, load factor or bit load; limits on its
        rate are ignored. Others (gains, limits, friction, mud, stuck) change the scene: DMB_ERR_UNSUPPORTED; one that still
        changes is DMB_ERR_VALUE */
};
typedef struct dmb_excitation {
    uint32_t struct_size;
    int32_t kind; /* DMB_EXCITATION_..., default DMB_EXCITATION_FORCE */
    dmb_place place; /* as the kind says */
    int32_t component, frame; /* DMB_X .. DMB_RZ, default DMB_X; DMB_FRAME_WORLD (default), _BODY: axes of the place */
    double amplitude, phase; /* [unit of the kind; rad] in the combined response; default 1, 0 */
} dmb_excitation;
DMB_SIZED_STRUCT(dmb_excitation)

/* ---- Frequency response ------------------------------------------------------------------------------------------- */
/* Axes of small motions, of the frames of places, and so of frequencies, as DMB_MODES_AXES_...; at rest an unbalance that turns
 * at W acts at W. */
enum { DMB_RESPONSE_AXES_TURNING = 0, DMB_RESPONSE_AXES_AT_REST = 1 };
typedef struct dmb_response_options {
    uint32_t struct_size, points; /* [-] of the grid, 2 .. 1e6; 1 where both ends are one frequency; default 1000 */
    double frequency_low, frequency_high; /* [Hz] >= 0, > 0 of a logarithmic grid, the second >= the first; default 1 and 100 */
    const double *frequencies; /* [Hz] ascending, shape (points): these instead of a grid; NULL (default): the grid */
    int32_t logarithmic; /* 1: equal ratios between frequencies; 0 (default): equal differences */
    uint32_t refinement; /* [-] times the intervals on both sides of each peak of a transfer function are halved, 0 .. 40; default
        0. A peak that falls between two points unseen is not found */
    double structural_damping; /* [-] eta: stiffness (1 + i eta) K, >= 0; default 0 */
    double equilibrium_tolerance; /* [-] residual over the forces that balance in it; default 1e-6 */
    int32_t contact; /* DMB_CONTACT_..., default DMB_CONTACT_AS_IS */
    int32_t friction; /* 1 (default): the slope of the friction law damps or drives; 0: left out */
    double contact_gap; /* [m] of DMB_CONTACT_CLOSED, >= 0; default 0 */
    int32_t axes, reserved; /* DMB_RESPONSE_AXES_TURNING (default), _AT_REST */
    double spin; /* [rad/s] strings turn at this speed in the state, as of dmb_modes_options; 0 (default): as they do */
} dmb_response_options;
DMB_SIZED_STRUCT(dmb_response_options)
typedef struct dmb_response dmb_response; /* transfer functions by frequency */
/* Transfer functions from every excitation to every output about the accepted state of a sim, which must be an equilibrium, at
 * rest or spinning steadily (eq:response.direct). Outputs are small changes about it, of every DMB_OUTPUT_... that is linear in
 * the motion; DMB_OUTPUT_VIBRATION .. are motions of a place in the axes of the analysis. Of a state that spins, frames of
 * `place` are its section's, and turn with it unless `axes` are at rest: then those that it has in the state, and section forces
 * are given in axes that do not spin. Structural damping there is that of parts that do not turn. excitations, outputs: shapes
 * (excitation_count), (output_count), 1 .. 1024 each, every excitation of the size that the first says. DMB_NOTE_INCOMPLETE:
 * coefficients that change while parts turn, as of modes; results hold along and about the axes of straight parts, not across.
 * Errors: DMB_ERR_VALUE (option, component, band; a state out of balance: by how much and where), _SINGULAR (frequency and part
 * that nothing holds there; a motion drive at frequency 0), _UNSUPPORTED (axes at rest with a load across a part that turns with
 * it; an output that is a magnitude, sum over the string, count, energy or work: the message names it). Cost: O(points (elements
 * + joints + excitations)); of joints that share bodies the cube of their coordinates. The sim need not outlive the response;
 * responses of one sim may not be computed at the same time. */
DMB_API int32_t dmb_analysis_response(dmb_sim *sim, const dmb_response_options *options, const dmb_excitation *excitations,
                                      uint32_t excitation_count, const dmb_output *outputs, uint32_t output_count,
                                      dmb_response **response);
DMB_API void dmb_response_destroy(dmb_response **response);
/* Numbers of frequencies (those of refinement included), excitations and outputs, shape (3). */
DMB_API int32_t dmb_response_dimensions(const dmb_response *response, uint32_t dimensions[3]);
/* [Hz] ascending, shape (points). */
DMB_API int32_t dmb_response_frequencies(const dmb_response *response, double *frequencies);
/* Output per unit of the excitation at each frequency, real and imaginary part, shape (points, 2). excitation DMB_COMBINED: the
 * output for all excitations with their amplitudes and phases. */
#define DMB_COMBINED UINT32_MAX
DMB_API int32_t dmb_response_transfer(const dmb_response *response, uint32_t excitation, uint32_t output, double *values);
/* CSV: frequency, then amplitude and phase [rad] of each transfer function and of the combined outputs; a line of heads, with
 * part names of `sim` (NULL: numbers of parts), '.' as decimal mark. Errors: DMB_ERR_IO. */
DMB_API int32_t dmb_response_write_csv(const dmb_response *response, const dmb_sim *sim, const char *path);

/* ---- Stepped sine -------------------------------------------------------------------------------------------------
 * Response in time to the scene's own time functions at one frequency, where the linear one fails: contacts that open, friction
 * that sticks, large motion. One call is one frequency; describe a scene for each (a HARMONIC time function, a drive's speed),
 * and transfer the state by dmb_sim_transfer_state. Different sims may run in parallel, with the same bits. */
typedef struct dmb_stepped_sine_options {
    uint32_t struct_size, steps_per_period; /* [-] 16 .. 1e6; default 100: frequency error about (2 pi/this)^2/12 */
    uint32_t periods, windows; /* [-] of a window, 1 .. 1e4, more than 1 where multiples of the period are awaited; windows at
        most, 3 .. 1e6; default 4, 500 */
    uint32_t harmonics, reserved; /* [-] 1 .. 16, at most an eighth of steps_per_period; default 3 */
    double tolerance; /* [-] settled: the remaining change, extrapolated from the last windows, is below this part of the largest
        harmonic of each output; default 1e-3 */
    double floor; /* [unit of the output] changes of a harmonic below it count as none, > 0; default 1e-12 */
} dmb_stepped_sine_options;
DMB_SIZED_STRUCT(dmb_stepped_sine_options)
typedef struct dmb_stepped_sine_report {
    uint32_t struct_size;
    int32_t settled; /* 1: the amplitudes settled; 0: they did not */
    uint32_t windows, rejected; /* [-] run; steps tried and not accepted */
    uint64_t steps; /* [-] accepted */
    double change, remaining; /* [-] change between the last two windows, worst output; estimated remaining change */
    double time; /* [s] reached */
} dmb_stepped_sine_report;
DMB_SIZED_STRUCT(dmb_stepped_sine_report)
/* Runs the sim on in fixed steps until the Fourier amplitudes of successive windows agree (eq:response.sine). amplitudes, shape
 * (output_count, 1 + harmonics, 2): mean and 0, then for k = 1, 2, ... the k-th harmonic: its part of the output is the real part
 * of (re + i im) e^(2 pi i k frequency t), t the sim's time. DMB_OUTPUT_VIBRATION .. are those of the linear response about the
 * state at the call, with axes at rest if it spins, less the drift over the window; other outputs as those of queries.
 * DMB_NOTE_STOPPED: not settled in `windows`; the amplitudes are those of the last. Errors: DMB_ERR_UNSUPPORTED with nothing
 * changed; those of dmb_sim_step, after which the sim is in its last accepted state. Cost: steps. */
DMB_API int32_t dmb_analysis_stepped_sine(dmb_sim *sim, double frequency, const dmb_stepped_sine_options *options,
                                          const dmb_output *outputs, uint32_t output_count, double *amplitudes,
                                          dmb_stepped_sine_report *report);

/* ---- Safe speeds -------------------------------------------------------------------------------------------------
 * A string that turns at W [rad/s] is shaken at orders of its speed: at W by eccentric masses, at 2 W by misalignment, at 3 W by
 * a tricone bit, at the number of blades times W by the cut. */
typedef struct dmb_order {
    uint32_t struct_size, reserved;
    double order; /* [-] frequency over rotary speed, > 0; default 1 */
    dmb_excitation excitation; /* with its amplitude; default: the scene's eccentric masses, as they are */
} dmb_order;
DMB_SIZED_STRUCT(dmb_order)
typedef struct dmb_speeds_report {
    uint32_t struct_size, bands; /* [-] that were found, those without room included */
    uint32_t silent_orders; /* [-] orders whose excitation moves no output at any speed */
    int32_t undamped; /* 1: nothing damps, so that heights at resonances mean nothing */
    int32_t truncated, reserved; /* 1: a band continues below speed_low, 2: above speed_high, 3: both, 0: none */
} dmb_speeds_report;
DMB_SIZED_STRUCT(dmb_speeds_report)
typedef struct dmb_speeds_options {
    uint32_t struct_size, points; /* [-] of the grid of speeds, 2 .. 1e5; default 200 */
    double speed_low, speed_high; /* [rad/s] > 0, the second above the first; default 1 and 30 */
    double threshold, margin; /* [-] severity above which a speed is to be avoided, > 0; by which bands are wider on both sides,
        part of the speed, 0 .. 0.5; default 1, 0.03 */
    uint32_t refinement; /* [-] as of a response, for each order; default 12 */
    int32_t contact; /* DMB_CONTACT_..., as of a response */
    int32_t friction, reserved; /* 1: as of a response; 0 (default): left out: while a string turns, its slope is close to 0 */
    double contact_gap, structural_damping, equilibrium_tolerance; /* [m; -; -] as of a response, same defaults */
    dmb_speeds_report *report; /* written where the call succeeds; NULL (default): none */
    double spin; /* [rad/s] as of dmb_response_options; default 0. After a static state with slip_rotation of this speed and
        friction 1 the string lies where friction carries it; eccentric masses are out of balance there: equilibrium_tolerance */
} dmb_speeds_options;
DMB_SIZED_STRUCT(dmb_speeds_options)
typedef struct dmb_speed_band {
    uint32_t struct_size;
    uint32_t order, output, reserved; /* [-] number of the order that counts most at the worst speed, and of its worst output */
    double low, high; /* [rad/s] of the band, margin included */
    double speed, severity; /* [rad/s; -] the worst in it, and its severity */
    double frequency; /* [Hz] of that order there */
    int32_t truncated, reserved1; /* 1: continues below speed_low, 2: above speed_high, 3: both, 0: whole */
} dmb_speed_band;
DMB_SIZED_STRUCT(dmb_speed_band)
/* Bands of rotary speed to avoid about the accepted state of a sim, by their severity: the sum over the orders of the largest
 * amplitude of an output over its limit (eq:response.severity), by the linear response in axes at rest about the rotating state;
 * 1 is the limit even where all orders add up. limits: [unit of the output] > 0, shape (output_count). bands: *band_count on
 * entry is the capacity, the struct_size of the first holds for all; on return the number of bands, by rising speed,
 * DMB_NOTE_FULL where more were found. severity, shape (points), may be NULL: largest within half a step of the grid around each
 * speed. DMB_NOTE_INCOMPLETE (dmb_sim_message and the report give the reason): an order excites nothing, nothing damps, a band is
 * truncated at an end of the range, or as of dmb_analysis_response. Call it for a sim of each depth or state. Errors as
 * dmb_analysis_response. Cost: that of order_count responses. */
DMB_API int32_t dmb_analysis_speeds(dmb_sim *sim, const dmb_speeds_options *options, const dmb_order *orders,
                                    uint32_t order_count, const dmb_output *outputs, const double *limits, uint32_t output_count,
                                    dmb_speed_band *bands, uint32_t *band_count, double *severity);

/* ---- State space --------------------------------------------------------------------------------------------------
 * M d'' + C d' + K d = f about a state, as a frequency response has it, in first order: x' = A x + B u, y = C x + D u; C (i w -
 * A)^-1 B + D is the frequency response. x: displacements and speeds of `coordinates`, then the states of inputs, in their order:
 * the integral of the target of a controller with integral gain, the displacement of a motion drive. u: changes of the inputs, y:
 * of the outputs, both from the state. With joints the coordinates are independent ones. All terms of C and K act, unsymmetric
 * ones (gyroscopic, friction, followers) too. */
enum {
    DMB_STATE_FULL = 0, /* all coordinates */
    DMB_STATE_REDUCED = 1, /* amplitudes of the shapes of chosen modes, and of quasi-static ones: one for each force of an input,
        two or three for a motion drive, so that results are exact at frequency `shift`. Galerkin's method on that real basis,
        orthonormal in M, which needs no left vectors; of complex shapes it takes real and imaginary part */
    DMB_STATE_MATRICES = 2 /* none: sparse matrices alone, about any state; no inputs nor outputs */
};
enum {
    DMB_MOTION_SPEED = 0, /* the input of a motion drive is its speed. Outputs that feel accelerations at once (forces beside the
        drive) would depend on its rate: DMB_ERR_UNSUPPORTED */
    DMB_MOTION_ACCELERATION = 1 /* it is the rate of that [m/s2, rad/s2], with displacement and speed as states */
};
typedef struct dmb_state_space_options {
    uint32_t struct_size;
    int32_t form, motion; /* DMB_STATE_..., default DMB_STATE_FULL; DMB_MOTION_..., default DMB_MOTION_SPEED */
    int32_t static_correction; /* 1 (default): quasi-static shapes of the inputs in the basis; 0: modes alone */
    const dmb_modes *modes; /* of DMB_STATE_REDUCED: modes about this state, of any kind, contact as here */
    const int32_t *mode_list; /* [-] numbers of those that are taken, shape (mode_count); NULL (default): all */
    uint32_t mode_count; /* [-] of mode_list; 0 (default) without one */
    int32_t contact, friction, reserved; /* DMB_CONTACT_...; as of a response; default DMB_CONTACT_AS_IS, 1 */
    double contact_gap; /* [m] of DMB_CONTACT_CLOSED, >= 0; default 0 */
    double equilibrium_tolerance; /* [-] residual over the forces that balance in it; default 1e-6 */
    double shift; /* [Hz] >= 0: quasi-static shapes are (K + w^2 M)^-1 f; default 0; > 0 where something is free to move as a
        rigid body, far below the frequencies that count */
} dmb_state_space_options;
DMB_SIZED_STRUCT(dmb_state_space_options)
typedef struct dmb_state_space_info {
    uint32_t struct_size, states; /* [-] 2 coordinates + input_states; 0 of DMB_STATE_MATRICES */
    uint32_t inputs, outputs; /* [-] */
    uint32_t coordinates; /* [-] of A: independent ones, or shapes of the basis */
    uint32_t mode_shapes, input_states; /* [-] of these, of modes, the others being quasi-static; states of inputs */
    uint32_t rows, independent; /* [-] of M, C, K: all rows of the scene, held ones too; columns of DMB_MATRIX_COORDINATES */
    uint32_t constraint_rows; /* [-] of the Jacobian: equations that act */
    double residual_of_state, largest_force; /* [-; N] relative; of it */
} dmb_state_space_info;
DMB_SIZED_STRUCT(dmb_state_space_info)
typedef struct dmb_state_space dmb_state_space; /* matrices of the linear system about one state */
/* About the accepted state of a sim, which must be an equilibrium, at rest or spinning steadily (any state for
 * DMB_STATE_MATRICES). excitations, outputs: as of dmb_analysis_response, 0 .. 1024 each; excitations that go with the square of
 * the frequency (unbalance, eccentricity) are refused. The sim need not outlive the result, nor need the modes. Notes and errors
 * as dmb_analysis_response; DMB_ERR_TOO_LARGE above 4096 states (reduce), _SINGULAR for a mass or a stiffness that is singular
 * (shift). O(coordinates^2) of FULL, O(shapes x elements) of REDUCED, O(elements) of MATRICES. */
DMB_API int32_t dmb_analysis_state_space(dmb_sim *sim, const dmb_state_space_options *options, const dmb_excitation *excitations,
                                         uint32_t excitation_count, const dmb_output *outputs, uint32_t output_count,
                                         dmb_state_space **space);
DMB_API void dmb_state_space_destroy(dmb_state_space **space);
DMB_API int32_t dmb_state_space_get_info(const dmb_state_space *space, dmb_state_space_info *info);
enum {
    DMB_MATRIX_A = 0, /* shape (states, states) */
    DMB_MATRIX_B = 1, /* shape (states, inputs) */
    DMB_MATRIX_C = 2, /* shape (outputs, states) */
    DMB_MATRIX_D = 3, /* shape (outputs, inputs) */
    DMB_MATRIX_MASS = 4,
    DMB_MATRIX_DAMPING = 5, /* with gyroscopic terms */
    DMB_MATRIX_STIFFNESS = 6, /* each by all rows, body-frame displacements; shape (rows, rows) */
    DMB_MATRIX_JACOBIAN = 7, /* of the equations that act; shape (constraint_rows, rows) */
    DMB_MATRIX_COORDINATES = 8 /* R of d = R z, z the independent coordinates; shape (rows, independent) */
};
/* One of A, B, C, D, row by row. */
DMB_API int32_t dmb_state_space_dense(const dmb_state_space *space, int32_t matrix, double *values);
/* One of the sparse matrices as triplets, row by row, none twice. All three arrays NULL: *count is their length. Else *count on
 * entry is the capacity (too little is DMB_ERR_VALUE) and on return the number written. */
DMB_API int32_t dmb_state_space_sparse(const dmb_state_space *space, int32_t matrix, uint32_t *rows, uint32_t *columns,
                                       double *values, uint64_t *count);
/* Shapes of the coordinates of A by rows, shape (coordinates, rows): unit motions of FULL, the basis of REDUCED. */
DMB_API int32_t dmb_state_space_shapes(const dmb_state_space *space, double *shapes);

/* ---- The state as arrays -----------------------------------------------------------------------------------------
 * Rows are the components of the body-frame velocities of the nodes: six (translation; rotation) of a node that moves freely, two
 * (along the hole; about its axis) of one that slides on the hole's axis; nodes along the strings, then bodies. */
enum {
    DMB_ARRAY_VELOCITY = 0, /* [m/s, rad/s] shape (rows) */
    DMB_ARRAY_ACCELERATION = 1, /* [m/s2, rad/s2] rates of those, shape (rows) */
    DMB_ARRAY_POSITION = 2, /* [m] of the nodes, world, shape (nodes, 3) */
    DMB_ARRAY_QUATERNION = 3, /* [-] body to world, scalar first, shape (nodes, 4) */
    DMB_ARRAY_MULTIPLIER = 4, /* [N, ...] of the rows of DMB_MATRIX_JACOBIAN: residual + J^T multiplier = 0 */
    DMB_ARRAY_RESIDUAL = 5 /* [N, N m] of the equations of motion without forces of constraint, at the present pose, speeds and
        accelerations, shape (rows): M v' + ... - f; rows of supports keep theirs */
};
/* values NULL: *count is the length of the array. Else *count on entry is the capacity (too little is DMB_ERR_VALUE) and on
 * return the number written. */
DMB_API int32_t dmb_analysis_array(dmb_sim *sim, int32_t array, double *values, uint64_t *count);
enum { DMB_ROW_FREE = 0, DMB_ROW_HELD = 1, DMB_ROW_DRIVEN = 2 };
typedef struct dmb_row {
    uint32_t struct_size;
    int32_t component; /* DMB_X .. DMB_RZ of the body-frame velocity */
    dmb_id part; /* string or body that the node belongs to */
    uint32_t pipe, node; /* [-] of the string, the one before the node; number of the node */
    int32_t state, reserved; /* DMB_ROW_FREE, held by a support, or driven by a motion drive */
} dmb_row;
DMB_SIZED_STRUCT(dmb_row)
/* The part or node that a row belongs to. */
DMB_API int32_t dmb_query_row(const dmb_sim *sim, uint32_t row, dmb_row *answer);
/* A small motion of a place as a linear function of those of rows: component DMB_X .. DMB_RZ in the axes of `frame`
 * (DMB_FRAME_WORLD, DMB_FRAME_BODY) is sum of values[i] d[rows[i]]; *count <= 24. Forces act by the same numbers. */
DMB_API int32_t dmb_analysis_place_rows(dmb_sim *sim, dmb_place place, int32_t frame, int32_t component, uint32_t rows[24],
                                        double values[24], uint32_t *count);
/* The first row of the Jacobian that is an equation of a joint, coupling, constraint or joint drive, and their count. */
DMB_API int32_t dmb_query_constraint_rows(const dmb_sim *sim, dmb_id part, uint32_t *first, uint32_t *count);

/* ---- Sensitivities ------------------------------------------------------------------------------------------------ */
/* Derivatives of the state and of any output by chosen parameters, along a run (eq:sensitivity.step). A parameter is given by two
 * sims besides the one that runs: the same scene with the parameter a little lower and a little higher, brought to the same time
 * in the same way (created; or settled by dmb_analysis_static). So anything that can be described can be one (a coefficient of
 * friction, a diameter, the energy of the rock, a value of a time function, the survey); of sims of one model, an initial speed
 * or the values of dmb_sim_set_drive, _set_input. */
typedef struct dmb_sensitivity dmb_sensitivity; /* derivatives of one run */
typedef struct dmb_parameter {
    uint32_t struct_size;
    int32_t one_sided; /* 1: steps on the high side only, half the cost, errors of first order in `step`, not second; default 0 */
    double step; /* [unit of the parameter] > 0: `high` has it this much above the sim, `low` this much below. Quantities that
        depend on it should change by 1e-9 .. 1e-6 of their scale: less is lost in rounding, of more the third power is felt */
    const dmb_sim *low; /* only read, and only by dmb_sensitivity_create */
    const dmb_sim *high; /* as `low` */
    char name[24]; /* for messages, ends with 0; default "" */
} dmb_parameter;
DMB_SIZED_STRUCT(dmb_parameter)
/* Begins with the derivatives that low and high have now, (high - low)/(2 step) of every number of the state. parameters: count
 * (1 .. 4096) of them, each with the same struct_size. The sim must outlive the object, which holds its models. Errors:
 * DMB_ERR_VALUE: low or high is a scene of another make, has another time, or other contacts, locks or inputs that are not
 * numbers, or an input is changing towards its set point; _UNSUPPORTED: joints with DMB_METHOD_MULTIPLIERS, actuators with a
 * delay, time functions whose times differ; _TOO_LARGE: clusters that are solved by sparse matrices. O(count * state). */
DMB_API int32_t dmb_sensitivity_create(dmb_sim *sim, const dmb_parameter *parameters, uint32_t count,
                                       dmb_sensitivity **sensitivity);
DMB_API void dmb_sensitivity_destroy(dmb_sensitivity **sensitivity);
/* dmb_sim_step and dmb_sim_advance of the sim, with the same bits, and the derivatives along with it, of each accepted step as it
 * was done, its length, breakpoints and kept accelerations included. Between two of these calls the sim may be changed by
 * dmb_sim_set_drive only; inputs stay as they were set when this was made (DMB_ERR_ORDER). DMB_NOTE_NOT_SMOOTH where a contact, a
 * sticking bristle or a limit differs between both sides of a parameter: the derivative there is the mean of two. Other notes and
 * errors as dmb_sim_step and dmb_sim_advance; DMB_ERR_ORDER: other calls moved the sim; _UNSUPPORTED: a stuck place is released;
 * _SINGULAR: the matrix at the end of a step. Allocates nothing. Costs 2 to 3.5 steps for one parameter, 1.2 to 2.1 for each of
 * four; two sims more, with the parameter lower and higher, cost 2, also on threads of their own: better for one or two. */
DMB_API int32_t dmb_sensitivity_step(dmb_sensitivity *sensitivity, double duration, dmb_step_report *report);
DMB_API int32_t dmb_sensitivity_advance(dmb_sensitivity *sensitivity, double time, dmb_step_report *report);
/* Outputs and their derivatives by each parameter now: values, shape (count), may be NULL; derivatives [unit of the output over
 * that of the parameter], shape (count, parameters). Errors: those of the outputs' queries; DMB_ERR_UNSUPPORTED: works, energies
 * summed over the run, counts, windows; _ORDER: the sim was moved by other calls. */
DMB_API int32_t dmb_sensitivity_outputs(dmb_sensitivity *sensitivity, const dmb_output *outputs, uint32_t count, double *values,
                                        double *derivatives);
/* Derivative of body-frame pose [m, rad] and velocity [m/s, rad/s] in all rows by one parameter, rows being the free and held
 * components of the nodes in the order of the library; shape (rows) each, either may be NULL. *rows: how many there are; with
 * both arrays NULL that is all. Errors: _ORDER as above. */
DMB_API int32_t dmb_sensitivity_rows(dmb_sensitivity *sensitivity, uint32_t parameter, double *pose, double *velocity,
                                     uint32_t *rows);
/* *kinks [-]: accepted steps so far in which the parameter was not smooth. */
DMB_API int32_t dmb_sensitivity_kinks(const dmb_sensitivity *sensitivity, uint32_t parameter, uint64_t *kinks);

/* ---- State equation ----------------------------------------------------------------------------------------------- */
/* y' = f(t, y) of a scene, for integrators, optimisers and model exchange of others. y: n positions, then the n body-frame
 * velocities [m/s, rad/s] of the same independent rows (dmb_query_row). Positions count from an origin, the pose (x0, R0) of each
 * node in the sim when this is made:
 *     x = x0 + R0 (y_X, y_Y, y_Z),   R = R0 exp(0, y_RY, y_RZ) exp(y_RX, 0, 0)
 * [m, rad]; along and about the hole's axis of axial-torsional nodes. RX is unbounded; where RY and RZ come to 2.5 rad together,
 * dmb_state_equation_begin moves the origin. Joints, drives and inputs stay in the states they have in the sim. Jumps of time
 * functions are those of y': an integrator should stop there. */
typedef struct dmb_state_equation dmb_state_equation;
/* Copies the sim, which is left as it is and may be destroyed first; the calls below allocate nothing. Errors:
 * DMB_ERR_UNSUPPORTED: the message names a part whose force is no function of pose, velocity and time (bristles, restitution
 * laws, rock that is cut, integral gains, delay, lag and rate limit of actuators, places that are stuck), or by which positions
 * depend on the path (nonholonomic joints, a motion drive across a part's rotation); _TOO_LARGE (clusters of joints). */
DMB_API int32_t dmb_state_equation_create(dmb_sim *sim, dmb_state_equation **equation);
DMB_API void dmb_state_equation_destroy(dmb_state_equation **equation);
DMB_API uint32_t dmb_state_equation_count(const dmb_state_equation *equation); /* [-] n, half the length of y; 0 of none */
/* Row of each coordinate, ascending, shape (n). */
DMB_API int32_t dmb_state_equation_rows(const dmb_state_equation *equation, uint32_t *rows);
/* y of the origin, shape (2 n), and its *time [s], which may be NULL. */
DMB_API int32_t dmb_state_equation_origin(const dmb_state_equation *equation, double *time, double *y);
/* rate = f(time, y), shape (2 n) both, one array or two; positions that joints make dependent are solved for from the origin on,
 * so that equal y have equal bits. If a constraint of the caller turns parts with time, move the origin at least once each radian
 * of that motion: branch and revolutions are those nearest to the origin. Errors: DMB_ERR_VALUE, _NOT_FINITE, _CALLBACK,
 * _ROTATION; _GEOMETRY: too far from the origin, or a joint where its angles are not defined; _SINGULAR, _NO_CONVERGENCE: joints
 * cannot be closed with these coordinates. O(elements), with joints more the farther the origin. */
DMB_API int32_t dmb_state_equation_rate(dmb_state_equation *equation, double time, const double *y, double *rate);
/* The state y at `time` becomes the origin and y its numbers, maybe of other rows. Errors as above, which change nothing but the
 * sim below; also DMB_ERR_SINGULAR where n would change. */
DMB_API int32_t dmb_state_equation_begin(dmb_state_equation *equation, double time, double *y);
/* A sim in the state of the last call of _rate or _begin, for queries alone (ask.h: accelerations, reactions of joints, outputs);
 * NULL where that call failed. Its sums and counts over a run are those of the sim copied, and there are no energies of the
 * ledger. Lives as long as the equation. */
DMB_API const dmb_sim *dmb_state_equation_sim(const dmb_state_equation *equation);

/* ---- Drilling ----------------------------------------------------------------------------------------------------- */
enum {
    DMB_OPERATION_PICK_UP = 0, /* pulled without turning */
    DMB_OPERATION_SLACK_OFF = 1, /* lowered or pushed without turning */
    DMB_OPERATION_ROTATE = 2, /* turned off bottom */
    DMB_OPERATION_DRILL = 3, /* turned and fed, with load and torque on the bit */
    DMB_OPERATION_SLIDE = 4, /* fed without turning the string, with load and the motor's torque on the bit */
    DMB_OPERATION_BACK_REAM = 5 /* turned and pulled */
};
typedef struct dmb_operation {
    uint32_t struct_size, reserved;
    double axial_speed, rotary_speed; /* [m/s; rad/s] along the hole, > 0 into it; about its axis; friction is along their sum at
        the pipe's surface; default 0 */
    double weight_on_bit, torque_on_bit; /* [N; N m] on the string's end, towards the rig; against rotation, >= 0; default 0, 0 */
} dmb_operation;
DMB_SIZED_STRUCT(dmb_operation)
/* Usual speeds of an operation DMB_OPERATION_...: 0.1 m/s up or down, 1 rev/s, 0.005 m/s while drilling; loads on the bit 0. */
DMB_API int32_t dmb_operation_usual(int32_t operation, dmb_operation *out);
/* "pick-up", "slack-off", ...; NULL for a number that is none: they are numbered from 0 without gaps. */
DMB_API const char *dmb_operation_name(int32_t operation);
typedef struct dmb_torque_drag_options {
    uint32_t struct_size;
    int32_t post_buckling; /* 1 (default): a helix presses r F^2/(4 EI) per metre more on the wall (Mitchell 1986) where the
        compression F is above the load of helical buckling; 0: not */
    dmb_id string; /* {0, 0}: the model's first string */
    double friction; /* [-] coefficient of all the hole, 0 .. 10; DMB_NOT_GIVEN (default): the wall's mu_dynamic at each depth */
    const double *depths; /* [m] measured depths of the string's far end, shape (depth_count), beyond its start_depth by at most
        its length; NULL: one, where it ends as described */
    uint32_t depth_count; /* [-] 1 .. 2^20; default 1 */
    int32_t friction_by_depth; /* of dmb_analysis_friction_factor: 0 (default): it finds one coefficient for all the hole; 1: the
        factor on the wall's mu_dynamic at each depth (scene.h) */
} dmb_torque_drag_options;
DMB_SIZED_STRUCT(dmb_torque_drag_options)
typedef struct dmb_torque_drag_row {
    uint32_t struct_size;
    int32_t locked; /* 1: compression exceeds 1 % of EA below the rig: no push does this; results at the rig are NaN */
    double depth; /* [m] measured depth of the far end */
    double hook_load, torque; /* [N; N m] effective axial force at the rig end, > 0: it pulls, < 0: it pushes; at the rig end,
        against friction and bit */
    double transfer; /* [-] share of a little more push at the rig that arrives at the bit; 1 without friction */
    double lowest_force, lowest_at; /* [N; m] least effective axial force, most compressed where < 0; measured depth where */
    double sinusoidal_share; /* [-] largest share of the sinusoidal buckling load, as of a profile; NaN without wall force */
    double helical_share, buckled_at; /* [-; m] the same of helical buckling; measured depth where that is */
    double helix_length; /* [m] of string above the load of helical buckling */
    double yield_share, yield_at; /* [-; m] largest von Mises stress over yield_strength, bending to the hole's curvature
        between rigid tool joints included; NaN where a pipe has no yield_strength; measured depth where */
    double stretch, wind_up; /* [m; rad] by the effective force, > 0 longer; of the rig end against the bit; tool joints rigid */
    double wall_force; /* [N] sum over the string */
} dmb_torque_drag_row;
DMB_SIZED_STRUCT(dmb_torque_drag_row)
/* One row for each depth and operation, shape (depth_count, operation_count), the struct_size of the first holds for all. The
 * string hangs together with its described pipes counted from the far end: at a depth less than where it is described the first
 * pipes are not there yet. Bodies and bits at the far end weigh as described. Ends and places beyond the survey lie on the
 * straight continuation. Mud that flows pulls and thrusts by the diameters at each depth; pressures are left out of yield_share.
 * Of the sim only the model is used. Errors: DMB_ERR_UNSUPPORTED without a hole, for a string that does not follow it, has
 * stabilisers, or below its rig end a joint that holds something (not DMB_JOINT_FREE), a load, spring or force, or a place
 * described stuck. O(depths x operations x (pipes' runs + stations + length / 2 m)). */
DMB_API int32_t dmb_analysis_torque_drag(dmb_sim *sim, const dmb_torque_drag_options *options, const dmb_operation *operations,
                                         uint32_t operation_count, dmb_torque_drag_row *rows);
/* Along the string in one operation at the first of the depths: at station_count (2 .. 2^20) places spread evenly from the rig
 * end to the far end. Arrays of shape (station_count), each may be NULL: measured depth [m], effective axial force [N], torque [N
 * m], wall force per metre [N/m]. Errors as dmb_analysis_torque_drag; DMB_ERR_NO_CONVERGENCE where the string locks up. */
DMB_API int32_t dmb_analysis_torque_drag_profile(dmb_sim *sim, const dmb_torque_drag_options *options,
                                                 const dmb_operation *operation, uint32_t station_count, double *depth,
                                                 double *axial_force, double *torque, double *wall_force);
enum { DMB_MEASURED_HOOK_LOAD = 0, DMB_MEASURED_TORQUE = 1 };
/* The friction coefficient, 0 .. 10 (or factor, friction_by_depth), that explains a hook load [N] or torque [N m] measured at the
 * rig in one operation at the first of the depths. Errors as dmb_analysis_torque_drag; DMB_ERR_VALUE where none does: the message
 * states the range. About 60 times the work of a row. */
DMB_API int32_t dmb_analysis_friction_factor(dmb_sim *sim, const dmb_torque_drag_options *options, const dmb_operation *operation,
                                             int32_t measured, double value, double *friction);

/* ---- Hydraulics -------------------------------------------------------------------------------------------------- */
typedef struct dmb_hydraulics {
    uint32_t struct_size, reserved;
    double depth, vertical_depth; /* [m] measured depth of the far end; vertical one below the string's start, < 0 above */
    double bore_loss, bit_loss, annulus_loss; /* [Pa] friction in the string; through nozzle_area; friction in the annulus */
    double pump_pressure; /* [Pa] sum of the three and of the difference of the columns; motors are left out */
    double circulating_density; /* [kg/m3] fluid_density + annulus_loss/(g vertical_depth); NaN if that is <= 0 */
    double trip_pressure; /* [Pa] of the closed string at the trip speed, more going in, less coming out */
    double surge_density, swab_density; /* [kg/m3] fluid_density +, - trip_pressure/(g vertical_depth), NaN if that is <= 0 */
    double reynolds; /* [-] largest of bore, annulus and trip */
} dmb_hydraulics;
DMB_SIZED_STRUCT(dmb_hydraulics)
/* Pressures of mud with the string's far end at a measured depth [m], beyond its start_depth by at most its length, in steady
 * flow without gel strength (Burkhardt 1961); trip speed 0 .. 10 m/s. DMB_ERR_UNSUPPORTED: no flow_rate. O(length / 2 m). */
DMB_API int32_t dmb_analysis_hydraulics(dmb_sim *sim, double depth, double trip_speed, dmb_hydraulics *answer);

/* ---- Fatigue -----------------------------------------------------------------------------------------------------
 * Axial stress at points of the outer surface, N_e/A + M r/I by the diameters, which turn with the pipe; counted by the rainflow
 * method in memory that does not grow, and summed to a damage (Palmgren 1924; Miner 1945) by the S-N curve N = curve_cycles
 * (S/curve_stress)^-slope of the stress amplitude S, half a cycle's range. Turning points are distinguished by `classes` levels,
 * which ranges are compared by too; a cycle counts with the stress at its own. */
typedef struct dmb_fatigue dmb_fatigue;
typedef struct dmb_fatigue_options {
    uint32_t struct_size, classes; /* [-] levels of stress, 8 .. 65536; default 1024 */
    uint32_t points, reserved; /* [-] points around a section, 2 .. 360, the first on its y axis; default 8 */
    double stress_range; /* [Pa] levels spread over -stress_range .. stress_range, > 0; default 1e9 */
    double concentration; /* [-] factor on the stress, >= 1; default 1 */
    double curve_stress, curve_cycles; /* [Pa; -] amplitude borne for curve_cycles, > 0; the user's, no default; cycles 1e6 */
    double slope, endurance; /* [-; Pa] 1 .. 50, the user's, no default; amplitudes up to this do no damage, >= 0, default 0 */
    double tensile_strength; /* [Pa] of Goodman's rule, S/(1 - mean/tensile_strength) for a mean > 0; 0 (default): without */
} dmb_fatigue_options;
DMB_SIZED_STRUCT(dmb_fatigue_options)
typedef struct dmb_fatigue_result {
    uint32_t struct_size, point; /* [-] the point of the section with the largest damage, or else the largest range */
    uint64_t samples, clipped; /* [-] taken; of them beyond stress_range, at any point: cycles wholly beyond it are missed */
    double damage; /* [-] 1: the S-N curve is reached; cycles that are not closed count half; INFINITY where the mean stress of a
        cycle reaches tensile_strength: the section breaks at once */
    double cycles, largest_range; /* [-; Pa] at that point, halves included; largest range of them */
    double lowest, highest; /* [Pa] stresses at that point, concentration included */
    double time; /* [s] between the first and the last sample */
    double life; /* [s] time until damage 1 at this rate; INFINITY without damage, 0 with an infinite one */
} dmb_fatigue_result;
DMB_SIZED_STRUCT(dmb_fatigue_result)
/* Places on flexible or axial-torsional pipes, place_count 1 .. 65536; memory from the model's allocator, about 24 bytes a class
 * and point. Errors: DMB_ERR_UNSUPPORTED (rigid pipes; axial-torsional ones in a hole that bends), _TOO_LARGE. */
DMB_API int32_t dmb_fatigue_create(dmb_sim *sim, const dmb_fatigue_options *options, const dmb_place *places,
                                   uint32_t place_count, dmb_fatigue **fatigue);
/* Takes a sample; call it after each step, 20 times a revolution or more: stress peaks between samples are not counted. Another
 * sim of the same model may be given. DMB_ERR_ORDER before the time of the last sample, as after a restore: restore the fatigue
 * too. Allocates nothing. O(places x points). */
DMB_API int32_t dmb_fatigue_take(dmb_fatigue *fatigue, const dmb_sim *sim);
DMB_API int32_t dmb_fatigue_get(const dmb_fatigue *fatigue, uint32_t place, dmb_fatigue_result *result);
/* Cycles by range at the point that the result names: cycles[i] of a range of i 2 stress_range/classes [Pa], shape (classes). */
DMB_API int32_t dmb_fatigue_histogram(const dmb_fatigue *fatigue, uint32_t place, double *cycles);
/* The counts so far as bytes in the caller's memory, with which another dmb_fatigue of the same options and places continues bit
 * for bit, in another process too. Allocate nothing. Errors: DMB_ERR_VALUE (another size; bytes that are no counts of these
 * options). O(places x points x classes). */
DMB_API int32_t dmb_fatigue_snapshot_size(const dmb_fatigue *fatigue, size_t *size);
DMB_API int32_t dmb_fatigue_snapshot(const dmb_fatigue *fatigue, void *block, size_t size);
DMB_API int32_t dmb_fatigue_restore(dmb_fatigue *fatigue, const void *block, size_t size);
DMB_API void dmb_fatigue_destroy(dmb_fatigue **fatigue);
DMB_C_END
#endif
