/* libdrillmbd - natural frequencies and modes of a scene about a state. */
#ifndef DRILLMBD_MODES_H
#define DRILLMBD_MODES_H

#include "analysis.h"

DMB_C_BEGIN

/* Free vibration M d'' + C d' + K d = 0, d small body-frame displacements, with everything that acts in the state:
 * preload, wall, friction, joints, drives, and the gyroscopic terms of a steady rotation. */
typedef struct dmb_modes dmb_modes;

enum { DMB_MODES_UNDAMPED = 0, /* M d'' + K d = 0 */ DMB_MODES_DAMPED = 1 /* with C: damping and gyroscopic terms */ };
enum { DMB_MODES_LOWEST = 0, DMB_MODES_ALL = 1, DMB_MODES_BAND = 2 };
/* Axes of small displacements: those of the parts, which turn with them (a standing wave of w is two there, at w + spin
 * and |w - spin|), or axes that do not take part in turning about the part's own x axis: frequencies as they are seen
 * from outside. The latter is for round parts: eccentric ones are out of balance. */
enum { DMB_MODES_AXES_TURNING = 0, DMB_MODES_AXES_AT_REST = 1 };
typedef struct dmb_modes_options {
    uint32_t struct_size;
    int32_t kind;       /* DMB_MODES_UNDAMPED (default), _DAMPED */
    int32_t select;     /* DMB_MODES_LOWEST (default), _ALL, _BAND */
    uint32_t count;     /* [-] of LOWEST, 1 .. number of coordinates, twice that if DAMPED, where every real root is a
                           mode (fewer come back where there are fewer); default 10 */
    double band[2];     /* [Hz] of BAND, 0 <= band[0] < band[1]; default 0 and 100, shape (2) */
    int32_t contact;    /* DMB_CONTACT_..., default DMB_CONTACT_AS_IS */
    int32_t friction;   /* 1 (default): the slope of the friction law on the wall acts; 0: friction is a dead load */
    double contact_gap; /* [m] of DMB_CONTACT_CLOSED, >= 0; default 0 */
    double equilibrium_tolerance; /* [-] residual over the forces that balance in it, > 0; above it the state is
                                  refused; default 1e-6 */
    int32_t axes;                 /* DMB_MODES_AXES_TURNING (default), _AT_REST */
    int32_t reserved;
    double spin; /* [rad/s] strings turn at this speed in the state, about their own x axis; 0 (default): as
                    they do. A static state with slip_rotation of this speed is in balance with friction
                    but for the tilt of the pipes in the hole, some 1e-5 */
} dmb_modes_options;
DMB_SIZED_STRUCT(dmb_modes_options)

typedef struct dmb_modes_info {
    uint32_t struct_size;
    uint32_t count;       /* [-] modes found, by rising frequency */
    uint32_t rigid;       /* [-] of them rigid-body modes: motions of all parts as rigid bodies that neither joints nor
                             supports nor any force hold, K d = 0. They are found as such, not as small eigenvalues;
                             each is reported once, with s = 0 */
    uint32_t coordinates; /* [-] independent coordinates of the linear system */
    int32_t dense;        /* 1: by LAPACK on all coordinates; 0: by Krylov subspaces on sparse factors */
    uint32_t solves;      /* [-] with those factors */
    double residual_of_state; /* [-] relative residual of the state without its body-frame accelerations */
    double asymmetry;         /* [-] of K; above 1e-9 it is treated as unsymmetric (friction, follower loads) */
    double residual;          /* [-] largest |(s^2 M + s C + K) d| over the norms of the terms that balance in it */
    uint32_t double_roots; /* [-] roots that were reported as the mean of two or more with one shape (critical damping,
                              the edge of flutter, straight motion seen in axes that spin): rounding parts those by
                              its root, and a residual does not show it */
    uint32_t reserved;
} dmb_modes_info;
DMB_SIZED_STRUCT(dmb_modes_info)

typedef struct dmb_mode {
    uint32_t struct_size;
    int32_t rigid;        /* 1: a rigid-body mode: nothing holds or strains it */
    double frequency;     /* [Hz] |s|/(2 pi) */
    double damping;       /* [-] -Re s/|s|; 1 of an overdamped root, which counts as one mode; 0 of a rigid one */
    double eigenvalue[2]; /* [1/s] s, real and imaginary part >= 0, shape (2). Flutter is two modes, one that grows and
                             one that decays. Without damping, divergence (s, -s) is one mode, s > 0 */
    double kinetic;       /* [J] |s|^2 d^H M d/2 of the shape as normalised: d^H M d = 1 kg m2 (or kg) */
    double strain;        /* [J] of elements, elastic part */
    double share[3];      /* [-] of the kinetic energy that is axial, torsional, lateral motion of pipes and bodies in
                             their own axes; of a rigid mode at unit |s|; sum 1, shape (3) */
    double participation[3];  /* [kg^0.5] d^T M e for a base that moves along world x, y, z, shape (3) */
    double effective_mass[3]; /* [kg] their squares: sum over all modes = mass that is free to move, shape (3) */
    double whirl;           /* [-] part of the kinetic energy in circles from y to z (forward, of spin > 0) less that in
                               circles from z to y (backward), in `axes`: 1 .. -1; 0 of real shapes */
    double strain_share[3]; /* [-] of the strain energy that is stretch, twist, bending with shear; sum 1, or 0 where
                               nothing is strained, shape (3) */
} dmb_mode;
DMB_SIZED_STRUCT(dmb_mode)

typedef struct dmb_mode_shape {
    uint32_t struct_size;
    int32_t frame; /* in: DMB_FRAME_WORLD (default) or DMB_FRAME_BODY, axes of re and im */
    double re[6];  /* [m, rad] displacement and rotation of the place, d = Re(shape e^(s t)), shape (6) */
    double im[6];  /* [m, rad] 0 of undamped modes, shape (6) */
} dmb_mode_shape;
DMB_SIZED_STRUCT(dmb_mode_shape)

/* Modes about the accepted state of a sim, which should be an equilibrium, at rest or spinning steadily. The state is
 * not changed; sim takes the message, and need not outlive the result. options may be NULL. Memory: the sim's
 * allocator, until dmb_modes_destroy. LOWEST: smallest |s|. Few modes: block Lanczos (full reorthogonalisation in the
 * M-inner product), damped or unsymmetric ones block Arnoldi, both on the inverse of K (rigid-body motions apart, or
 * shifted), linear in the number of elements; ALL, and many: LAPACK (dsygvd, dgeev), cubic. A BAND of many modes is
 * divided: undamped by the counts of eigenvalues below its pieces, which must all be found, in time that grows with the
 * modes; damped ones in the same way where their roots lie along the imaginary axis (K symmetric, no joints, less than
 * a quarter of the critical damping at band[1]); elsewhere up to 256 modes below band[1] are found at once, more are
 * refused (_TOO_LARGE). A mode that does not satisfy its equations to rounding, after some inverse iteration, or cannot
 * be distinguished from a rigid-body motion, is refused with its residual and the bound (_NO_CONVERGENCE). Of the
 * LOWEST modes those before the first such one are returned, and those before a crowd of roots that do not converge
 * (damped motions of more than 400 coordinates, near 1/(2 pi damping_time)): DMB_NOTE_INCOMPLETE. Joints whose
 * equations change in `axes` while the state moves on (a rotor on a carrier in axes that turn; rolling), and strings
 * that turn on the wall in axes that turn with them, are refused (_UNSUPPORTED): coefficients are not constant. So are
 * modes whose coefficients change by more than 1e-4 while parts turn, tested with the state rotated by a radian: in
 * rotating axes anisotropic supports (springs, the sag of a shaft held along), in axes at rest parts that are not
 * round. *modes is NULL on error: DMB_ERR_VALUE (option; more modes than
 * coordinates; a band without modes; a state out of balance: by how much and where), _NO_CONVERGENCE, _SINGULAR,
 * _CALLBACK, _NOT_FINITE, _ROTATION, _NO_MEMORY, _TOO_LARGE, _UNSUPPORTED. */
DMB_API int32_t dmb_analysis_modes(dmb_sim *sim, const dmb_modes_options *options, dmb_modes **modes);
/* Gives the memory back and sets *modes to NULL. NULL-safe. */
DMB_API void dmb_modes_destroy(dmb_modes **modes);
DMB_API int32_t dmb_modes_get_info(const dmb_modes *modes, dmb_modes_info *info);
/* Mode number index. O(number of elements). Errors of this and the following functions: DMB_ERR_NULL, _HANDLE,
 * _STRUCT_SIZE, _ID, _VALUE (index, place, frame), _NOT_FINITE. */
DMB_API int32_t dmb_modes_get(const dmb_modes *modes, uint32_t index, dmb_mode *mode);
/* Shape at a place, between nodes by the element's own shape functions. O(1). */
DMB_API int32_t dmb_modes_shape(const dmb_modes *modes, uint32_t index, dmb_place place, dmb_mode_shape *shape);
/* [J] kinetic and strain energy of the mode, as in dmb_mode, in a pipe of a string with half of the parts fixed to its
 * two ends, in a whole string (pipe = DMB_NONE), or in a body or bit (pipe 0). O(elements of it). */
DMB_API int32_t dmb_modes_part(const dmb_modes *modes, uint32_t index, dmb_id part, uint32_t pipe, double *kinetic,
                               double *strain);
/* A frame of its animation for ParaView: the strings displaced by scale Re(shape e^(i phase)), as dmb_write_vtk_strings
 * writes them, with fields displacement and rotation. A numbered series of frames plays. DMB_ERR_IO on failure. */
DMB_API int32_t dmb_write_vtk_mode(const dmb_modes *modes, uint32_t index, double scale, double phase,
                                   uint32_t per_element, const char *path);

DMB_C_END
#endif
