/* The scene during compilation. Each step of dmb_model_compile fills part of it from the model and from the results of
 * earlier steps; mesh_finalise.c then copies it into one block. Growable arrays, whose sizes need not be known in
 * advance; all are released at the end of compilation.
 *
 *   step            reads                      fills
 *   hole            wall, survey, sections     hole, stations, pieces
 *   count           runs                       run_order, room in nodes and elements
 *   check           references of parts        -
 *   ring_places     rings, runs                ring_order
 *   divisions       ring_order, forces, ...    divisions
 *   strings         runs, masks, divisions     nodes (at, size, free), elements (node, arms, length), pipes, strings
 *   bodies          bodies, bits               nodes of free bodies, bodies
 *   rings           ring_order, elements       bodies, rings
 *   poses           hole, nodes, elements      nodes (pose), elements (span)
 *   depths          hole, poses, joints        nodes (depth) of parts that do not follow the hole
 *   types           runs, elements             types, elements (type, kernel), batches
 *   masses          runs, bodies, bits         rigid_masses, added_masses, nodes (weight, damped)
 *   sites           pipes, bodies              sites, axial_torsional_sites, inside
 *   joints          joints, couplings, ...     joints, couplings, callbacks, laws
 *   actions         drives, loads, bits        drives, loads, load_points, bits, nodes (prescribed), driven
 *   forces          springs, forces, stuck     springs, spring_points, forces, stuck
 *   constraints     joints ... forces          constraints, clusters, cluster_nodes; back-references
 *                                              in joints, couplings, drives, callbacks, springs, forces
 *   inputs          inputs, events             inputs, events
 *   flow            pipes, hole, environment   flow_pieces
 *   rotors          joints, nodes, ...         rotors
 *
 * Fields that depend on row numbers are filled by mesh_finalise: rows of drives, columns of constraint components,
 * blocks of jointed chains. */
#ifndef DMB_MODEL_MESH_H
#define DMB_MODEL_MESH_H

#include <stdbool.h>

#include "base/memory.h"
#include "base/value_check.h"
#include "drillmbd/scene.h"
#include "element/element_type.h"
#include "model/model.h"

typedef struct dmb_mesh_node {
    double at;               /* [m] from the rig end along the string; 0 of a free body */
    double position[3];      /* [m] world */
    double quaternion[4];    /* [-] */
    double depth;            /* [m] measured depth, 0 without a hole */
    double weight_mass;      /* [kg] */
    double weight_moment[3]; /* [kg m] */
    double displaced[2]; /* [m3, m4] reduction of weight_mass and of the x of weight_moment by a fluid of density 1 */
    double damped[3];    /* [m, m2, m3] integrals of 1, x, x^2 over the pipe whose external damping is lumped here */
    uint32_t string;     /* DMB_NONE: free body `body` */
    uint32_t body;
    uint32_t rigid_mass; /* index in rigid_masses; DMB_NONE: none */
    uint32_t added_mass; /* index in added_masses; DMB_NONE: none */
    uint8_t size;        /* DMB_NODE_SIX_DOF or DMB_NODE_AXIAL_TORSIONAL */
    uint8_t free;        /* mask of free components; of an axial-torsional node X and RX only */
    uint8_t prescribed;  /* mask of components moved by MOTION drives */
    uint8_t rigid;       /* 1: carries a rigid body */
} dmb_mesh_node;

typedef struct dmb_mesh_element {
    double span[3]; /* [m] from node a to node b, world */
    double arm[2];  /* [m] */
    double length;  /* [m] flexible, between the arms */
    uint32_t node;  /* a; b is the next one */
    uint32_t run;   /* in the model's runs */
    uint32_t type;
    int32_t kernel;
    int32_t curved; /* 1: has the mass of bent elements */
    int32_t reserved;
} dmb_mesh_element;

/* A contact point of a stabiliser, or the point of a force, by its position on a string. */
typedef struct dmb_mesh_ring {
    double along;    /* [m] of its middle from the near end of the pipe */
    uint32_t string; /* index */
    uint32_t pipe;
    uint32_t ring; /* index in the model's stabilisers; DMB_NONE: the point of a force */
    uint32_t reserved;
} dmb_mesh_ring;

/* A body that may spin; its masses are those of its node. */
typedef struct dmb_mesh_rotor {
    dmb_scene_rotor rotor;
    int32_t from;     /* origin of its axis, in mesh_rotor */
    int32_t bearings; /* 1: it has a joint that permits its spin */
} dmb_mesh_rotor;

typedef struct dmb_mesh {
    dmb_model *model; /* written to: its message, and time functions of constant drives */
    dmb_compile_options options;
    int32_t features;
    int32_t has_hole;
    dmb_hole hole;                    /* its stations are in `stations` */
    dmb_vector stations;              /* dmb_hole_station */
    dmb_vector pieces;                /* dmb_hole_piece, referenced by the hole */
    dmb_vector run_order;             /* uint32_t: runs sorted by string, in each by pipe */
    dmb_vector run_start;             /* uint32_t: where in run_order each string begins, one more at the end */
    dmb_vector nodes;                 /* dmb_mesh_node */
    dmb_vector elements;              /* dmb_mesh_element */
    dmb_vector types;                 /* dmb_element_type */
    dmb_vector batches;               /* dmb_batch */
    dmb_vector rigid_masses;          /* dmb_rigid_mass */
    dmb_vector added_masses;          /* dmb_added_mass */
    dmb_vector sites;                 /* dmb_site */
    dmb_vector inside;                /* dmb_scene_point: of the last of them */
    dmb_vector axial_torsional_sites; /* dmb_axial_torsional_site */
    dmb_vector drives;                /* dmb_scene_drive; its row is filled by mesh_finalise */
    dmb_vector actuators;             /* dmb_actuator_law */
    dmb_vector gain_tables;           /* dmb_gain_table */
    dmb_vector loads;                 /* dmb_scene_load */
    dmb_vector bits;                  /* dmb_scene_bit */
    dmb_vector inputs;                /* dmb_scene_input */
    dmb_vector load_points;           /* dmb_scene_point */
    dmb_vector springs;               /* dmb_scene_spring */
    dmb_vector spring_points;         /* dmb_spring_point */
    dmb_vector events;                /* dmb_scene_event */
    dmb_vector forces;                /* dmb_scene_force */
    uint32_t force_states;            /* numbers of their states */
    dmb_vector stuck;                 /* dmb_scene_stuck */
    dmb_vector flow_pieces;           /* dmb_flow_piece */
    dmb_vector joints;                /* dmb_scene_joint */
    dmb_vector rotors;                /* dmb_mesh_rotor, by node */
    dmb_vector couplings;             /* dmb_scene_coupling */
    dmb_vector callbacks;             /* dmb_scene_callback */
    dmb_vector laws;                  /* dmb_joint_law */
    dmb_vector driven;                /* uint8_t: mask of the coordinates of each joint prescribed by MOTION drives */
    dmb_vector constraints;           /* dmb_constraint, sorted by cluster */
    dmb_vector clusters;              /* dmb_cluster */
    dmb_vector cluster_nodes;         /* uint32_t */
    dmb_vector strings;               /* dmb_string_map */
    dmb_vector pipes;                 /* dmb_pipe_map */
    dmb_vector bodies;                /* dmb_body_map: bodies, then bits, then rings */
    dmb_vector ring_order;            /* dmb_mesh_ring: by string, pipe and place */
    dmb_vector divisions;             /* dmb_mesh_ring: the same with the points of forces inside pipes */
    dmb_vector rings;                 /* dmb_ring_map, in the order of ring_order */
    uint32_t tool_joints;             /* pipes that have one */
    uint32_t history_count;
    uint32_t delays;   /* drives with a delay line */
    dmb_mud_flow flow; /* with flow_pieces */
    double mass;       /* [kg] */
} dmb_mesh;

static inline dmb_mesh_node *dmb_mesh_node_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_mesh_node, &mesh->nodes, i);
}
static inline dmb_mesh_element *dmb_mesh_element_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_mesh_element, &mesh->elements, i);
}
static inline dmb_string_map *dmb_mesh_string_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_string_map, &mesh->strings, i);
}
static inline dmb_pipe_map *dmb_mesh_pipe_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_VECTOR_AT(dmb_pipe_map, &mesh->pipes, i);
}
static inline const dmb_pipe_run *dmb_mesh_run_at(const dmb_mesh *mesh, uint32_t i)
{
    return DMB_LIST_AT(const dmb_pipe_run, mesh->model->runs, i);
}
static inline const dmb_string_def *dmb_mesh_string_def(const dmb_mesh *mesh, uint32_t i)
{
    return &DMB_LIST_AT(const dmb_string_plan, mesh->model->strings, i)->def;
}

/* True if all count numbers are equal. */
bool dmb_same_numbers(const double *a, const double *b, size_t count);
/* Kind of a run's pipes after the compile options. */
int32_t dmb_mesh_kind(const dmb_mesh *mesh, const dmb_pipe_run *run);
/* True if the string starts on the hole's axis. */
bool dmb_mesh_follows_hole(const dmb_mesh *mesh, uint32_t string);
/* Index of the string of an id; the empty id is the first string. */
uint32_t dmb_mesh_string_of(const dmb_mesh *mesh, dmb_id id);

/* Rings of a pipe, in their order along it. */
typedef struct dmb_ring_range {
    const dmb_mesh_ring *first;
    uint32_t count;
} dmb_ring_range;
dmb_ring_range dmb_mesh_rings_of(const dmb_mesh *mesh, uint32_t string, uint32_t pipe);
/* The same of stabilisers and points of forces, which divide its elements. */
dmb_ring_range dmb_mesh_divisions_of(const dmb_mesh *mesh, uint32_t string, uint32_t pipe);
/* By string, pipe and distance along it. */
void dmb_mesh_sort_places(dmb_mesh_ring *items, size_t count);
/* Run that contains a pipe of a string; NULL: there is no such pipe. */
const dmb_pipe_run *dmb_mesh_run_with(const dmb_mesh *mesh, uint32_t string, uint32_t pipe);
/* [m] Largest distance from a node, a quarter of the pipe's diameter, at which a stabiliser is carried by that node on
 * a rigid arm: beam theory does not resolve deformation over such lengths. Farther away it has its own node, which
 * divides an element. */
double dmb_ring_reach(const dmb_pipe_def *def);

/* Element of a pipe and fraction of its flexible length at a distance from the pipe's near end [m]. */
uint32_t dmb_mesh_element_along(const dmb_mesh *mesh, const dmb_pipe_map *pipe, double along, double *fraction);

/* The pipes of a string one after the other.
 *     dmb_pipe_iterator walk = dmb_pipe_iterator_of(mesh, string);
 *     while (dmb_pipe_iterator_next(&walk)) ... walk.run, walk.number ... */
typedef struct dmb_pipe_iterator {
    const dmb_mesh *mesh;
    const dmb_pipe_run *run;
    uint32_t place, end; /* in run_order */
    uint32_t within;     /* number of pipes of the run already visited */
    uint32_t number;     /* number of the pipe along the string */
    uint32_t string;
} dmb_pipe_iterator;
dmb_pipe_iterator dmb_pipe_iterator_of(const dmb_mesh *mesh, uint32_t string);
bool dmb_pipe_iterator_next(dmb_pipe_iterator *iterator);

void dmb_mesh_init(dmb_mesh *mesh, dmb_model *model, const dmb_compile_options *options);
void dmb_mesh_release(dmb_mesh *mesh);

/* The steps of the compilation, in order. Each returns DMB_OK or an error, with a message if a part caused it. */
int32_t dmb_mesh_check(dmb_mesh *mesh);
int32_t dmb_mesh_hole(dmb_mesh *mesh);
/* Pieces of the wall from the sections of the hole. DMB_ERR_GEOMETRY, _VALUE, _NO_MEMORY. */
int32_t dmb_mesh_sections(dmb_mesh *mesh);
/* Stations at which cutters widen it; mesh->hole.cuts stays 0 without any. DMB_ERR_GEOMETRY. */
int32_t dmb_mesh_cuts(dmb_mesh *mesh);
/* [m] Diameter to which a bit, or the reamers of a stabiliser, widen the hole; 0: they do not. */
double dmb_mesh_bit_cuts(const dmb_mesh *mesh, uint32_t bit);
double dmb_mesh_ring_cuts(const dmb_mesh *mesh, uint32_t ring);
/* Checks that no part with wall contact is wider than the hole at its described position; a clearance of 0 constrains a
 * pipe to the axis. DMB_ERR_GEOMETRY. */
int32_t dmb_mesh_fits(dmb_mesh *mesh);
int32_t dmb_mesh_count(dmb_mesh *mesh);
int32_t dmb_mesh_ring_places(dmb_mesh *mesh);
int32_t dmb_mesh_divisions(dmb_mesh *mesh);
int32_t dmb_mesh_strings(dmb_mesh *mesh);
int32_t dmb_mesh_bodies(dmb_mesh *mesh);
int32_t dmb_mesh_rings(dmb_mesh *mesh);
int32_t dmb_mesh_poses(dmb_mesh *mesh);
int32_t dmb_mesh_depths(dmb_mesh *mesh);
/* True for an element with the mass matrix of curved elements: its unstressed shape is curved, its described shape is
 * bent by more than DMB_CURVED_BEND, or its sections are thick. */
bool dmb_mesh_is_curved(const dmb_mesh *mesh, const dmb_mesh_element *element);
int32_t dmb_mesh_types(dmb_mesh *mesh);
int32_t dmb_mesh_masses(dmb_mesh *mesh);
int32_t dmb_mesh_sites(dmb_mesh *mesh);
int32_t dmb_mesh_joints(dmb_mesh *mesh);
int32_t dmb_mesh_actions(dmb_mesh *mesh);
/* Lengths of pipe with mud flow. DMB_ERR_UNSUPPORTED, _GEOMETRY, _VALUE, _NO_MEMORY. */
int32_t dmb_mesh_flow(dmb_mesh *mesh);
int32_t dmb_mesh_forces(dmb_mesh *mesh);
int32_t dmb_mesh_constraints(dmb_mesh *mesh);
/* Bodies on joints that a step integrates in axes that do not spin with them. */
int32_t dmb_mesh_rotors(dmb_mesh *mesh);
int32_t dmb_mesh_inputs(dmb_mesh *mesh);
/* First input from number `from` on that replaces a time function which a segment per revolution in use follows as
 * described, with a warning; DMB_NONE: none. */
uint32_t dmb_followed_input(const dmb_scene *scene, uint32_t from, dmb_message *text);

/* DMB_FEATURE_... that are requested and present. */
int32_t dmb_mesh_features(const dmb_mesh *mesh);
/* Copies everything into one block of the model's allocator. Errors: DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE. */
int32_t dmb_mesh_finalise(const dmb_mesh *mesh, dmb_scene **scene);

/* Places that move rigidly with a node. */

typedef struct dmb_mesh_place {
    uint32_t node;
    double arm; /* [m] along body x from the node */
} dmb_mesh_place;

/* Node and arm of a place: on a body, a bit, anywhere on a rigid pipe, and on an elastic pipe at its ends, its tool
 * joint and the ends of its elements (within 1e-9 of the pipe). False elsewhere. The pipe must exist. */
bool dmb_mesh_place_of(const dmb_mesh *mesh, const dmb_place *place, dmb_mesh_place *found);
/* From node a (or the world's origin, DMB_NONE) to node b [m]. Along one string it is summed from elements, because a
 * difference of large coordinates loses digits. */
void dmb_mesh_span(const dmb_mesh *mesh, uint32_t a, uint32_t b, double span[3]);
/* Fails the check if the pipe of a place does not exist, or if its node is axial-torsional in a curved hole, where it
 * rotates with the axis. */
void dmb_mesh_check_pipe(dmb_check *check, const dmb_mesh *mesh, const char *field, const dmb_place *place);
void dmb_mesh_check_node(dmb_check *check, const dmb_mesh *mesh, const char *field, const dmb_place *place,
                         uint32_t node);
/* The point at any place displaced by an offset in its axes; of the ground for a place on no part. Fails the check as
 * the two above. */
dmb_scene_point dmb_mesh_point(dmb_check *check, const dmb_mesh *mesh, const char *field, const dmb_place *place,
                               const double offset[3]);

/* added_mass = -1 of the environment needs a wall around the pipes. */
int32_t dmb_mesh_check_mud(const dmb_mesh *mesh, const dmb_pipe_def *def);
/* Rigid masses of nodes: bodies added to a spatial inertia, and pipes whose centre of mass is off their axis. */

/* Adds a body of that mass [kg], centre [m] from the node and inertia [kg m2] xx, yy, zz, xy, xz, yz at its centre. */
void dmb_rigid_mass_add(dmb_rigid_mass *rigid_mass, double mass, const double centre[3], const double inertia[6]);

/* Moves a mass [kg] already added at (x, 0, 0) [m] to (x, e_y, e_z): the node gains a first moment and inertia, but no
 * mass. */
void dmb_rigid_mass_shift(dmb_rigid_mass *rigid_mass, double mass, double x, const double e[2]);

/* Eccentric pipes: offset of the centre of mass of each pipe of a run. */

bool dmb_pipe_is_eccentric(const dmb_pipe_def *def);

/* Offset (e_y, e_z) [m] of the centre of mass of a pipe from its axis, section frame. `pipe` is its number along the
 * string: the random parts depend on it and on the seed only, not on the order of description. */
void dmb_pipe_offset(const dmb_pipe_def *def, uint32_t pipe, double e[2]);

/* Filling the arrays of a scene from a finished mesh. */

/* The layout's arrays and the hole's stations, read-only in the scene. */
typedef struct dmb_scene_storage {
    uint8_t *size;
    uint32_t *row, *diag, *link;
    dmb_hole_station *stations;
    dmb_hole_piece *pieces;
} dmb_scene_storage;

/* Free rows, and rows prescribed by MOTION drives, as bits of the node's own rows. */
static inline uint8_t dmb_free_rows(const dmb_mesh_node *node)
{
    if (node->size == DMB_NODE_SIX_DOF) return node->free;
    return (uint8_t)((node->free >> DMB_X & 1) | (node->free >> DMB_RX & 1) << 1);
}

static inline uint8_t dmb_prescribed_rows(const dmb_mesh_node *node)
{
    if (node->size == DMB_NODE_SIX_DOF) return node->prescribed;
    return (uint8_t)((node->prescribed >> DMB_X & 1) | (node->prescribed >> DMB_RX & 1) << 1);
}

/* Fills all arrays of a scene whose counts and storage are set. DMB_ERR_TOO_LARGE if the blocks cannot be counted in 32
 * bits. */
int32_t dmb_scene_fill(const dmb_mesh *mesh, dmb_scene *scene, dmb_scene_storage *storage);

#endif
