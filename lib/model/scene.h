/* The compiled scene: what a step needs and nothing else. Written once by dmb_model_compile (all of it in one arena),
 * then read by any number of threads.
 *
 * Nodes are numbered along the strings, rig end first, then the free bodies, so that every string and every free body
 * is a chain of neighbouring blocks. A six-DOF node has a pose in SE(3) and 6 rows (body-frame velocity); an
 * axial-torsional node slides and turns on the axis of the hole and has 2 rows (along the axis, about it). Element e
 * joins nodes a and a+1. */
#ifndef DMB_MODEL_SCENE_H
#define DMB_MODEL_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "base/message.h"
#include "drillmbd/ask.h"
#include "drillmbd/scene.h"
#include "element/element_type.h"
#include "force/actuator_law.h"
#include "force/bit_rock.h"
#include "force/contact_law.h"
#include "force/friction_law.h"
#include "force/hole.h"
#include "force/mud_flow.h"
#include "force/normal_law.h"
#include "force/spring_law.h"
#include "force/time_function.h"
#include "math/block_sparse.h"
#include "math/block_tridiagonal.h"
#include "model/scene_constraint.h"
#include "model/section.h"

enum { DMB_NODE_AXIAL_TORSIONAL = 2, DMB_NODE_SIX_DOF = 6 };
/* Kernels of an element. */
enum {
    DMB_KERNEL_BEAM = 0,            /* two six-DOF nodes */
    DMB_KERNEL_AXIAL_TORSIONAL = 1, /* two axial-torsional nodes: stretch and torsion only */
    DMB_KERNEL_MIXED = 2            /* a beam with one six-DOF and one axial-torsional node */
};

typedef struct dmb_scene_drive {
    double gain, integral_gain, limit_low, limit_high;
    double mud_pressure; /* [Pa/(N m)] */
    uint32_t node;       /* DMB_NONE: it drives a joint */
    uint32_t row;        /* global row of the component; DMB_NONE: none */
    int32_t kind;        /* DMB_DRIVE_... */
    int32_t component;   /* body-frame component 0 .. 5 */
    uint32_t time_function;
    uint32_t excitation; /* DMB_NONE: none, or left out */
    uint32_t joint;      /* whose coordinate `component` it drives; DMB_NONE: none */
    uint32_t constraint; /* of a MOTION drive on a joint; DMB_NONE: none */
    uint32_t actuator;   /* in actuators; DMB_NONE: its force is its command */
    uint32_t table;      /* in gain_tables, in the place of the gain; DMB_NONE: none */
    char name[24];
} dmb_scene_drive;

typedef struct dmb_scene_load {
    double force[3], moment[3];
    double arm; /* [m] along body x from the node */
    uint32_t node;
    int32_t frame;
    uint32_t time_function; /* DMB_NONE: factor 1 */
    uint32_t point;         /* in load_points, where it acts; DMB_NONE: at the arm from the node */
    char name[24];
} dmb_scene_load;

typedef struct dmb_scene_bit {
    dmb_bit_rock_law law; /* kind DMB_ROCK_NONE when left out */
    double bottom;        /* [m] stand-off at time 0 */
    uint32_t node;
    uint32_t load;             /* time function of the bottom-hole load; DMB_NONE: none */
    uint32_t history_first;    /* start of its samples in the history arrays */
    uint32_t history_capacity; /* 0 unless regenerative */
    double arm; /* [m] along body x from the node to the bit (not 0 if rigid pipes lie between node and bit) */
    dmb_side_law side;
    double face, length; /* [m] from the reference point to the cutting face; gauge length behind it */
    int32_t reamer;      /* 1: on a stabiliser */
    int32_t reserved;
} dmb_scene_bit;

/* A quantity that the caller moves in each sim by itself (sim/own_scene). */
typedef struct dmb_scene_input {
    double initial; /* at time 0; NaN: as described */
    double low, high, rate_limit, slope_limit;
    int32_t target;  /* DMB_TARGET_... */
    int32_t outside; /* DMB_OUTSIDE_... */
    uint32_t index;  /* of the drive, load or bit; DMB_NONE: wall, environment */
    uint32_t reserved;
    char name[24];
} dmb_scene_input;

/* An output that crosses a level (run/events). */
typedef struct dmb_scene_event {
    dmb_output output;
    double level, hold, tolerance;
    int32_t direction; /* DMB_EVENT_... */
    uint32_t reserved;
    char name[24];
} dmb_scene_event;

/* The place of a described pipe in the mesh. */
typedef struct dmb_pipe_map {
    double start;      /* [m] rigid pipe: its near end along body x from `node`; else 0 */
    double length;     /* [m] */
    double joint;      /* [m] rigid tool joint at its far end (already inside length) */
    uint32_t node;     /* rigid: the node of its body; else node of its near end */
    uint32_t element;  /* first element; DMB_NONE: rigid */
    uint32_t elements; /* 0: rigid */
    int32_t kind;      /* DMB_PIPE_... after compile options */
    int32_t divided;   /* 1: nodes of rings or forces divide it, so that its elements differ in length */
    int32_t reserved;
} dmb_pipe_map;

typedef struct dmb_string_map {
    uint32_t first_pipe, pipe_count; /* in pipes[] */
    uint32_t first_node, node_count; /* its chain */
    uint32_t start_node, end_node;   /* nodes that carry its two ends (equal for one rigid string) */
    double start_arm, end_arm;       /* [m] along body x from those nodes to the ends */
    double length;                   /* [m] */
} dmb_string_map;

typedef struct dmb_body_map {
    uint32_t node;
    uint32_t site;           /* its contact point; DMB_NONE: none */
    double arm;              /* [m] along body x from the node to its reference point */
    uint32_t supported_site; /* 1: it would have a contact point if its node moved sideways */
    uint32_t reserved;
    char name[24];
} dmb_body_map;

/* A ring on a string. */
typedef struct dmb_ring_map {
    double at;          /* [m] of its middle from the rig end */
    double half_length; /* [m] */
    uint32_t string;
    uint32_t body; /* in bodies */
} dmb_ring_map;

typedef struct dmb_chain {
    double length;         /* [m] makes its moments comparable with forces: mean element; of a body alone its radius of
                              inertia or its longest arm to a joint */
    uint32_t first, count; /* nodes */
    int32_t jointed;       /* 1: joints connect it, so it is solved with the blocks of the pattern */
    int32_t reserved;
} dmb_chain;

/* A free rigid body, integrated at its centre of mass. */
typedef struct dmb_free_rigid {
    double centre[3]; /* [m] of mass, from the node, body frame */
    uint32_t node, rigid_mass;
    uint32_t added_mass; /* DMB_NONE: none */
    uint32_t reserved;
} dmb_free_rigid;

/* A body on joints that is integrated in axes rotating with its spin (system/constrain/rotor.h). */
typedef struct dmb_scene_rotor {
    double twist[6]; /* [m, -] velocity of the node at a spin of 1 rad/s about the axis, body frame */
    uint32_t node, rigid_mass;
    uint32_t added_mass; /* DMB_NONE: none */
    uint32_t reserved;
} dmb_scene_rotor;

/* A spring between two points. The tangent of a force on one node, or on both nodes of one element, is stored in the
 * chain's blocks; other springs get a constraint with 0 equations that couples their nodes. */
typedef struct dmb_scene_spring {
    dmb_scene_point a, b;
    double span[3];      /* [m] origin of b's node less origin of a's (or of the world), at time 0, world, exact */
    double free_length;  /* [m] */
    dmb_spring_law law;  /* `first` counts in spring_points */
    uint32_t constraint; /* DMB_NONE: within a node or an element */
    uint32_t reserved;
    char name[24];
} dmb_scene_spring;

/* A place that can be stuck: it acts on one node, or the two of an element. */
typedef struct dmb_scene_stuck {
    dmb_scene_point point;
    double stiffness[3], damping[3]; /* along, about, sideways; 0 for free components */
    double release[2];               /* [N, N m] force and torque of release; infinite: never released */
    int32_t initially;
    uint32_t input; /* that sets it; DMB_NONE: none */
    char name[24];
} dmb_scene_stuck;

/* Nodes that constraints connect directly, and those constraints: one partition, one block of the reduced system. */
typedef struct dmb_cluster {
    uint32_t constraint, constraint_count; /* range of constraints */
    uint32_t node, node_count;             /* range of cluster_nodes */
    uint32_t row, rows;                    /* range of constraint rows, unused ones included */
    uint32_t column, columns;              /* range of cluster_columns */
    uint32_t block;                        /* in the pattern; none of a sparse cluster */
    int32_t sparse; /* 1: each of its nodes has a block, with multipliers; there is no dense storage */
    size_t dense;   /* start in work of (rows x columns) */
    size_t square;  /* start in work of (rows x rows) */
    size_t full;    /* start in work of (columns x columns) */
} dmb_cluster;

/* Flow segment: a length of pipe, or a tool joint, with its annulus. */
typedef struct dmb_flow_piece {
    double from, length;     /* [m] along the string */
    double diameter[2];      /* [m] outer, inner */
    double hole;             /* [m] its diameter in the middle */
    dmb_annulus_shape shape; /* of the annulus */
    double lever[2]; /* [m] from `node`, or from both nodes of `element`, to where its pull, or half of it, acts */
    double steel;    /* [N] E A, by which it stretches; 0: rigid */
    double poisson;  /* [-] */
    dmb_flow_loss bore, annulus;
    double before[2]; /* [Pa] lost in the bore, in the annulus, between the rig end and `from` */
    uint32_t element; /* half of its pull on each node; DMB_NONE: on `node` */
    uint32_t node;
} dmb_flow_piece;

/* Neighbouring elements with one kernel. */
typedef struct dmb_batch {
    uint32_t first, count; /* elements */
    int32_t kernel;        /* DMB_KERNEL_... */
    int32_t curved;        /* 1: elements with the mass of bent ones (element/curved_mass.h) */
} dmb_batch;

typedef struct dmb_scene {
    const struct dmb_model *model; /* the model that owns the scene; gives names for messages */
    size_t bytes;                  /* of the arena, this struct included */
    int32_t features;              /* DMB_FEATURE_... that are both requested and described */
    int32_t damped, arms;          /* 1: some element has a damping time; has rigid arms to its nodes */
    int32_t beams_only;            /* 1: every element has two six-DOF nodes */
    int32_t curved;                /* 1: some element has the mass matrix of curved elements */
    uint32_t added_mass_count;
    const struct dmb_kernels *kernels; /* loops of a step, for the vector width of the processor */
    uint32_t node_count, row_count, element_count, type_count, batch_count, chain_count, rigid_mass_count;
    uint32_t inside_count;   /* contact points inside elements, the last ones of `sites` */
    uint32_t sites_in_order; /* leading contact points in the order of their nodes */
    uint32_t site_count, axial_torsional_site_count, drive_count, load_count, bit_count, time_function_count;
    uint32_t string_count, pipe_count, body_count, ring_count;
    uint32_t history_count; /* bit samples in all */
    uint32_t free_count, prescribed_count, constrained_count;
    uint32_t velocity_count; /* row_count, or 0 if all initial velocities are 0 */
    uint32_t rigid_count, structural_joint_count;
    uint32_t free_rigid_count, rotor_count;
    uint32_t spring_count, spring_point_count, load_point_count, force_count, stuck_count;
    uint32_t force_states;     /* [-] numbers of the states of all forces */
    uint32_t unilateral_count; /* stops of laws of joints, then springs, then springs of laws; 0 where none may have a
                                  mean force */
    uint32_t joint_count, coupling_count, callback_count, constraint_count, cluster_count, law_count;
    uint32_t constraint_row_count;                   /* rows of all constraints, unused ones included */
    uint32_t constraint_node_count;                  /* length of cluster_nodes */
    uint32_t cluster_column_count;                   /* length of cluster_columns */
    uint32_t reduced_count;                          /* nodes of jointed chains */
    uint32_t sparse_count;                           /* sparse clusters */
    uint32_t block_count;                            /* blocks of the pattern */
    uint32_t jacobian_count, tangent_count;          /* lengths of constraint_jacobian and constraint_tangent */
    size_t dense_count, square_count, six_dof_count; /* lengths of the clusters' dense storage */
    double gravity[3];                               /* [m/s2]; 0 when left out */
    double mass, length;                             /* [kg], [m] in all */
    double length_scale;       /* [m] mean element length, or 1: makes moments comparable with forces */
    double fluid_density;      /* [kg/m3] outside of the pipes */
    double inner_density;      /* [kg/m3] inside; < 0: the same */
    dmb_mud_flow flow;         /* of the first string; valid with pieces */
    uint32_t flow_count;       /* 0: mud rests */
    uint32_t gain_table_count; /* drives with one */
    uint32_t input_count, event_count;
    uint32_t actuator_count, delay_count;         /* drives with an actuator, with a delay */
    int32_t has_density_input, has_damping_input; /* 1: some input moves it */
    int32_t has_flow_input, has_callback;         /* 1: a time function, force or constraint is the caller's function */

    /* nodes */
    dmb_block_layout layout;      /* block sizes 6 or 2, rows, storage of blocks and links */
    double *reference_position;   /* [m] world, where displacement is 0, shape (node, 3); of an axial-torsional node on
                                     the axis */
    double *reference_quaternion; /* [-] at time 0, scalar first, shape (node, 4) */
    double *reference_depth;      /* [m] measured depth at time 0, shape (node); 0 without a hole */
    double *initial_velocity;     /* [m/s, rad/s] as described, shape (velocity_count) */
    uint8_t *free_row;            /* 1 where a row is free to move (drives included), shape (row) */
    uint8_t *solved_row;          /* 1 where a row is an unknown: free and not moved by a MOTION drive, shape (row) */
    uint32_t *constrained_node;   /* rows with solved_row 0: node and row within its block, shape (constrained_count) */
    uint32_t *constrained_component;
    double *weight_mass;   /* [kg] gravitational mass less buoyancy, shape (node) */
    double *weight_moment; /* [kg m] b of the weight, body frame: torque b x R^T g, shape (node, 3), with rigid_masses
                              and the +- rho A L^2/12 of the cubic shape (sum of both sides) */
    double *node_damping;  /* [N s/m, N m s; N s/m, N s, N m s] external damping: axial, torsional; lateral times the
                              integrals of 1, x, x^2 over the pipe length of the node, shape (node, 5) */

    double *displaced; /* [m3, kg m per kg/m3 = m4] reduction of weight_mass and of the x of weight_moment by a fluid of
                          density 1, shape (node, 2); none without has_density_input */
    double *damped_length; /* [m, m2, m3] integrals of 1, x, x^2 over the pipe whose damping a node carries, shape
                              (node, 3); none without has_damping_input */

    /* elements */
    dmb_element_type *types; /* shape (type_count) */
    uint32_t *element_type;  /* shape (element) */
    uint32_t *element_node;  /* node a; b is a + 1, shape (element) */
    uint32_t *node_element;  /* element from node i to i + 1; DMB_NONE at the end of a chain, shape (node) */
    double *element_span;    /* [m] from node a to node b at time 0, world frame, exact, shape (element, 3) */
    dmb_batch *batches;
    dmb_chain *chains;
    uint32_t *node_chain;         /* chain of each node, shape (node) */
    dmb_rigid_mass *rigid_masses; /* at most one a node, by node */
    dmb_added_mass *added_masses; /* likewise */
    dmb_free_rigid *free_rigids;  /* by node, none in scenes with joints; shape (free_rigid_count) */
    dmb_scene_rotor *rotors;      /* by node, in scenes with joints; shape (rotor_count) */

    /* wall */
    dmb_hole hole; /* valid if has_hole */
    int32_t has_hole;
    int32_t reserved;
    dmb_normal_law normal_law;
    dmb_friction_law friction_law; /* kind DMB_FRICTION_NONE when left out */
    dmb_site *sites;
    double site_mobility; /* [m/kg] largest length times mobility of a site */
    dmb_axial_torsional_site *axial_torsional_sites;
    uint32_t
        *near_contact; /* contact point on the node, or the nearest along its chain and across joints, whose measured
                          depth is the initial guess of the node's; DMB_NONE: none; shape (node), of a curved hole */
    dmb_scene_point
        *inside; /* cross-sections of the contact points inside elements, element by element, shape (inside_count) */

    /* actions */
    dmb_scene_drive *drives;
    dmb_actuator_law *actuators; /* by drive */
    dmb_gain_table *gain_tables; /* by drive */
    dmb_scene_load *loads;
    dmb_scene_bit *bits;
    dmb_time_function *time_functions; /* the model's; in a sim with inputs followed by those of the inputs */
    dmb_scene_input *inputs;
    dmb_scene_point *load_points;
    dmb_scene_spring *springs;
    dmb_spring_point *spring_points; /* tables, spring by spring */
    dmb_scene_event *events;
    dmb_scene_force *forces;
    dmb_scene_stuck *stuck;
    dmb_flow_piece *flow_pieces; /* from the rig end on, shape (flow_count) */
    double *flow_element;        /* [N] pull of the mud on elements, towards the rig, shape (element); only with flow */
    double *flow_node; /* [N, N m] on nodes: the force, and the force times its position x in the node's frame, for
                          elements and rigid parts; shape (node, 2) */

    /* joints and constraints; all empty without joints */
    dmb_scene_joint *joints;
    uint32_t *joint_drives; /* drives on joints, by joint */
    dmb_scene_coupling *couplings;
    dmb_scene_callback *callbacks;
    dmb_joint_law *laws;         /* shape (law_count): six for each joint that has any */
    dmb_constraint *constraints; /* sorted by cluster */
    dmb_cluster *clusters;
    uint32_t *cluster_nodes;     /* nodes, cluster by cluster, ascending in each */
    uint32_t *cluster_columns;   /* global row of each column of each cluster, node by node */
    uint32_t *node_block;        /* block of the pattern that holds the node; DMB_NONE: its chain is not jointed;
                                    shape (node) if there are clusters */
    uint32_t *node_place;        /* first column of the node in its cluster; 0 of a node without one, shape (node) */
    uint32_t *node_cluster;      /* DMB_NONE: none, shape (node) */
    size_t *off_diagonal_offset; /* storage in the pattern of link i, i+1 (upper, lower); SIZE_MAX where none or inside
                            one block, shape (node, 2) */
    dmb_block_pattern pattern;   /* blocks: dense clusters, then the other nodes of jointed chains */
    const struct dmb_scene *dense; /* the same with dense clusters only, for analyses that need independent coordinates;
                                      NULL where no cluster is sparse, and where one is too large */

    /* maps from parts to the mesh */
    dmb_string_map *strings;
    dmb_pipe_map *pipes;
    dmb_body_map *bodies; /* described bodies, then bits, then rings */
    dmb_ring_map *rings;  /* by string and place */
} dmb_scene;

static inline dmb_mud dmb_mud_of(const dmb_scene *scene)
{
    const dmb_mud mud = {scene->fluid_density, scene->inner_density};
    return mud;
}

/* The scene in which copies for analyses are made (system/copy). */
static inline const dmb_scene *dmb_dense_scene(const dmb_scene *scene)
{
    return scene->dense != NULL ? scene->dense : scene;
}

/* External damping of a node by the lengths it carries: scene->node_damping. */
static inline void dmb_node_damping_of(const double damped[3], double axial, double torsional, double lateral,
                                       double damping[5])
{
    damping[0] = axial * damped[0];
    damping[1] = torsional * damped[0];
    for (int k = 0; k < 3; k++) damping[2 + k] = lateral * damped[k];
}

/* Global row of constrained row i. */
static inline uint32_t dmb_constrained_row(const dmb_scene *scene, uint32_t i)
{
    return scene->layout.row[scene->constrained_node[i]] + scene->constrained_component[i];
}

/* True if contact points have bristle deflections as state. */
static inline int32_t dmb_scene_has_bristles(const dmb_scene *scene)
{
    return dmb_friction_has_memory(&scene->friction_law);
}

/* True if the damping of the wall jumps when a contact closes. */
static inline int32_t dmb_scene_has_touch(const dmb_scene *scene)
{
    return scene->normal_law.kind == DMB_NORMAL_KELVIN_VOIGT;
}

/* [1/kg] Bound of J M^-1 J^T of a force at the point x [m] of a node, in its axes, from the adjacent mass; x NULL:
 * [1/(kg m2)] of a couple. Model/scene. */
double dmb_node_mobility(const dmb_scene *scene, uint32_t node, const double *x);
/* [1/kg] J M^-1 J^T of the normal force of a contact point, from the adjacent mass: model/scene. */
double dmb_site_mobility(const dmb_scene *scene, uint32_t site);

/* Number of contact points on nodes; those inside elements follow. */
static inline uint32_t dmb_node_sites(const dmb_scene *scene)
{
    return scene->site_count - scene->inside_count;
}

/* 1: the contact point is inside an element. Its node is the near one, its offset [m] the distance from it along the
 * straight pipe. */
static inline int dmb_is_inside(const dmb_scene *scene, uint32_t site)
{
    return site >= dmb_node_sites(scene) && site < scene->site_count;
}

/* [m] Radial clearance of a contact point at a depth; negative if a section of the hole is narrower than the part. */
static inline double dmb_site_clearance(const dmb_scene *scene, const dmb_site *site, double depth)
{
    return scene->hole.pieces == 0 ? site->clearance : dmb_hole_radius(&scene->hole, depth) - site->radius;
}

/* Sets the flow rate, the pressure losses of the flow segments, and the resulting axial forces on elements and nodes,
 * in this scene only. O(segments). */
void dmb_scene_set_flow(dmb_scene *scene, double rate);
/* Computes the axial forces on elements and nodes from the losses of the flow segments. */
void dmb_scene_fill_pulls(dmb_scene *scene);

/* The scene with dense matrices for all constraint components. Modes, responses and buckling use independent
 * coordinates with a dense matrix R; steps and statics of large components do not. */

/* Assigns consecutive storage to the constraint components, none to sparse ones, and counts it in the scene. False if a
 * size overflows. */
int32_t dmb_scene_place_storage(uint32_t count, dmb_cluster *clusters, dmb_scene *scene);
/* After dmb_scene_number_blocks: scene->dense, NULL without sparse components or if one is too large. DMB_OK,
 * DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE. */
int32_t dmb_scene_make_dense(dmb_scene *scene, const dmb_allocator *allocator);
/* NULL is fine. */
void dmb_scene_release_dense(const dmb_scene *dense, const dmb_allocator *allocator);

/* Blocks of the chains that joints connect. */

/* After all other parts of the scene are filled: columns and positions of the components' nodes, jointed chains,
 * blocks, pattern and off-diagonal blocks. Does nothing without components. Errors: DMB_ERR_NO_MEMORY,
 * DMB_ERR_TOO_LARGE, with no pattern left. */
int32_t dmb_scene_number_blocks(dmb_scene *scene, const dmb_allocator *allocator);

/* Joints that are bridges: if one of them is removed, the parts beyond it are connected to the ground by no other path.
 */

/* beyond (shape (constraint_count)): for a bridge, its node on the side away from the ground, else DMB_NONE. The
 * equations of couplings and callbacks connect all their nodes and the ground; those of joint drives count with their
 * joint. Tarjan, A note on finding the bridges of a graph, 1974. Linear. DMB_OK, DMB_ERR_NO_MEMORY. */
int32_t dmb_scene_bridges(const dmb_scene *scene, const dmb_allocator *allocator, uint32_t *beyond);

/* Contact points that cannot reach the wall, because a support constrains them laterally. */

/* First index >= `from` of a body or bit (bodies first, then bits) whose contact point is constrained laterally, and
 * the text of the warning; DMB_NONE: none. */
uint32_t dmb_supported_site(const dmb_scene *scene, uint32_t from, dmb_message *text);

#endif
