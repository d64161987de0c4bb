/* libdrillmbd - the linearised scene as matrices: state space for control design, sparse M, C, K and the Jacobian of
 * constraints; and for researchers the state of a sim as arrays, with the map from places to rows. */
#ifndef DRILLMBD_STATE_SPACE_H
#define DRILLMBD_STATE_SPACE_H

#include "modes.h"
#include "response.h"

DMB_C_BEGIN

/* ---- State space -------------------------------------------------------------------------------------------------
 * M d'' + C d' + K d = f about a state, as a frequency response has it, in first order:
 *
 *     x' = A x + B u,     y = C x + D u;     C (i w - A)^-1 B + D is the frequency response.
 *
 * x: displacements and speeds of `coordinates`, then the states of inputs, in their order: the integral of the target
 * of a controller with integral gain, the displacement of a motion drive. u: changes of the inputs, y: of the outputs,
 * both from the state. With joints the coordinates are independent ones. All terms of C and K act, unsymmetric ones
 * (gyroscopic, friction, followers) too. */
enum {
    DMB_STATE_FULL = 0,    /* all coordinates */
    DMB_STATE_REDUCED = 1, /* amplitudes of the shapes of chosen modes, and of quasi-static ones: one for each force of
                              an input, two or three for a motion drive, so that results are exact at frequency `shift`.
                              Galerkin's method on that real basis, orthonormal in M, which needs no left vectors; of
                              complex shapes it takes real and imaginary part */
    DMB_STATE_MATRICES = 2 /* none: sparse matrices alone, about any state; no inputs nor outputs */
};
enum {
    DMB_MOTION_SPEED = 0,       /* the input of a motion drive is its speed. Outputs that feel accelerations at once
                                   (forces beside the drive) would depend on its rate: DMB_ERR_UNSUPPORTED */
    DMB_MOTION_ACCELERATION = 1 /* it is the rate of that [m/s2, rad/s2], with displacement and speed as states */
};
typedef struct dmb_state_space_options {
    uint32_t struct_size;
    int32_t form;              /* DMB_STATE_..., default DMB_STATE_FULL */
    int32_t motion;            /* DMB_MOTION_..., default DMB_MOTION_SPEED */
    int32_t static_correction; /* 1 (default): quasi-static shapes of the inputs in the basis; 0: modes alone */
    const dmb_modes *modes;    /* of DMB_STATE_REDUCED: modes about this state, of any kind, contact as here */
    const int32_t *mode_list;  /* [-] numbers of those that are taken, shape (mode_count); NULL (default): all */
    uint32_t mode_count;       /* [-] of mode_list; 0 (default) without one */
    int32_t contact;           /* DMB_CONTACT_..., default DMB_CONTACT_AS_IS */
    int32_t friction;          /* as of a response, default 1 */
    int32_t reserved;
    double contact_gap;           /* [m] of DMB_CONTACT_CLOSED, >= 0; default 0 */
    double equilibrium_tolerance; /* [-] residual over the forces that balance in it; default 1e-6 */
    double shift; /* [Hz] >= 0: quasi-static shapes are (K + w^2 M)^-1 f; default 0; > 0 where something is free to move
                     as a rigid body, far below the frequencies that count */
} dmb_state_space_options;
DMB_SIZED_STRUCT(dmb_state_space_options)

typedef struct dmb_state_space_info {
    uint32_t struct_size;
    uint32_t states;          /* [-] 2 coordinates + input_states; 0 of DMB_STATE_MATRICES */
    uint32_t inputs, outputs; /* [-] */
    uint32_t coordinates;     /* [-] of A: independent ones, or shapes of the basis */
    uint32_t mode_shapes;     /* [-] of these, of modes; the others are quasi-static */
    uint32_t input_states;    /* [-] */
    uint32_t rows;            /* [-] of M, C, K: all rows of the scene, held ones too */
    uint32_t independent;     /* [-] columns of DMB_MATRIX_COORDINATES */
    uint32_t constraint_rows; /* [-] of the Jacobian: equations that act */
    double residual_of_state; /* [-] relative */
    double largest_force;     /* [N] of it */
} dmb_state_space_info;
DMB_SIZED_STRUCT(dmb_state_space_info)

typedef struct dmb_state_space dmb_state_space; /* matrices of the linear system about one state */
/* About the accepted state of a sim, which must be an equilibrium, at rest or spinning steadily (any state for
 * DMB_STATE_MATRICES). excitations, outputs: as of dmb_analysis_response, 0 .. 1024 each, those of control.h by
 * DMB_EXCITATION_SETTING; excitations that go with the square of the frequency (unbalance, eccentricity) are refused.
 * options may be NULL. The state is not changed; sim takes the message
 * and need not outlive the result, nor need the modes. Memory: the sim's allocator. *space is NULL on error: those of
 * dmb_analysis_response, and so is DMB_NOTE_INCOMPLETE; DMB_ERR_TOO_LARGE above 4096 states (reduce), DMB_ERR_SINGULAR
 * for a mass or a stiffness that is singular (shift). O(coordinates^2) of DMB_STATE_FULL, O(shapes x elements) of
 * DMB_STATE_REDUCED, O(elements) of DMB_STATE_MATRICES. */
DMB_API int32_t dmb_analysis_state_space(dmb_sim *sim, const dmb_state_space_options *options,
                                         const dmb_excitation *excitations, uint32_t excitation_count,
                                         const dmb_response_output *outputs, uint32_t output_count,
                                         dmb_state_space **space);
/* Sets *space to NULL. NULL-safe. */
DMB_API void dmb_state_space_destroy(dmb_state_space **space);
/* Errors of this and the following functions: DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _VALUE. */
DMB_API int32_t dmb_state_space_get_info(const dmb_state_space *space, dmb_state_space_info *info);

enum {
    DMB_MATRIX_A = 0, /* shape (states, states) */
    DMB_MATRIX_B = 1, /* shape (states, inputs) */
    DMB_MATRIX_C = 2, /* shape (outputs, states) */
    DMB_MATRIX_D = 3, /* shape (outputs, inputs) */
    DMB_MATRIX_MASS = 4,
    DMB_MATRIX_DAMPING = 5,    /* with gyroscopic terms */
    DMB_MATRIX_STIFFNESS = 6,  /* each by all rows, body-frame displacements; shape (rows, rows) */
    DMB_MATRIX_JACOBIAN = 7,   /* of the equations of joints, couplings, constraints and joint drives that act; shape
                                  (constraint_rows, rows) */
    DMB_MATRIX_COORDINATES = 8 /* R of d = R z, z the independent coordinates; shape (rows, independent) */
};
/* One of A, B, C, D, row by row. */
DMB_API int32_t dmb_state_space_dense(const dmb_state_space *space, int32_t matrix, double *values);
/* One of the sparse matrices as triplets, row by row, none twice. All three arrays NULL: *count is their length. Else
 * *count on entry is the capacity and on return the number written; too little is DMB_ERR_VALUE. */
DMB_API int32_t dmb_state_space_sparse(const dmb_state_space *space, int32_t matrix, uint32_t *rows, uint32_t *columns,
                                       double *values, uint64_t *count);
/* Shapes of the coordinates of A by rows, shape (coordinates, rows): unit motions of DMB_STATE_FULL, the basis of
 * DMB_STATE_REDUCED. */
DMB_API int32_t dmb_state_space_shapes(const dmb_state_space *space, double *shapes);

/* ---- The state as arrays -----------------------------------------------------------------------------------------
 * Rows are the components of the body-frame velocities of the nodes: six (translation; rotation) of a node that moves
 * freely, two (along the hole; about its axis) of one that slides on the hole's axis; nodes along the strings, then
 * bodies. */
enum {
    DMB_ARRAY_VELOCITY = 0,     /* [m/s, rad/s] shape (rows) */
    DMB_ARRAY_ACCELERATION = 1, /* [m/s2, rad/s2] rates of those, shape (rows) */
    DMB_ARRAY_POSITION = 2,     /* [m] of the nodes, world, shape (nodes, 3) */
    DMB_ARRAY_QUATERNION = 3,   /* [-] body to world, scalar first, shape (nodes, 4) */
    DMB_ARRAY_MULTIPLIER = 4,   /* [N, ...] of the rows of DMB_MATRIX_JACOBIAN: residual + J^T multiplier = 0 */
    DMB_ARRAY_RESIDUAL = 5 /* [N, N m] of the equations of motion without forces of constraint, at the present pose,
                              speeds and accelerations, shape (rows): M v' + ... - f; rows of supports keep their
                              their rows */
};
/* values NULL: *count is the length of the array. Else *count on entry is the capacity (too little is DMB_ERR_VALUE)
 * and on return the number written. The sim takes a message for a failing residual (those of dmb_sim_step). */
DMB_API int32_t dmb_analysis_array(dmb_sim *sim, int32_t array, double *values, uint64_t *count);

enum { DMB_ROW_FREE = 0, DMB_ROW_HELD = 1, DMB_ROW_DRIVEN = 2 };
typedef struct dmb_row {
    uint32_t struct_size;
    int32_t component; /* DMB_X .. DMB_RZ of the body-frame velocity */
    dmb_id part;       /* string or body that the node belongs to */
    uint32_t pipe;     /* [-] of the string; the one before the node */
    uint32_t node;     /* [-] */
    int32_t state;     /* DMB_ROW_FREE, held by a support, or driven by a motion drive */
    int32_t reserved;
} dmb_row;
DMB_SIZED_STRUCT(dmb_row)
/* The part or node that a row belongs to. DMB_ERR_VALUE where there is no such row. */
DMB_API int32_t dmb_query_row(const dmb_sim *sim, uint32_t row, dmb_row *answer);
/* A small motion of a place as a linear function of those of rows: component DMB_X .. DMB_RZ in the axes of `frame`
 * (DMB_FRAME_WORLD, DMB_FRAME_BODY) is sum of values[i] d[rows[i]]; *count <= 24. A force there acts on the rows by the
 * same numbers. The sim takes the message. */
DMB_API int32_t dmb_analysis_place_rows(dmb_sim *sim, dmb_place place, int32_t frame, int32_t component,
                                        uint32_t rows[24], double values[24], uint32_t *count);
/* The first row of the Jacobian that is an equation of a joint, coupling, constraint or joint drive, and their count.
 */
DMB_API int32_t dmb_query_constraint_rows(const dmb_sim *sim, dmb_id part, uint32_t *first, uint32_t *count);

DMB_C_END
#endif
