/* libdrillmbd - response to harmonic excitation: linear about a state, and in time where that does not hold. */
#ifndef DRILLMBD_RESPONSE_H
#define DRILLMBD_RESPONSE_H

#include "analysis.h"

DMB_C_BEGIN

/* ---- Excitation --------------------------------------------------------------------------------------------------
 * A quantity q is the real part of (re + i im) e^(i w t), w = 2 pi frequency. */
enum {
    DMB_EXCITATION_DRIVE = 0,     /* time function of the drive place.part [its unit]: speed of MOTION, force of LOAD,
                                target speed of CONTROL */
    DMB_EXCITATION_LOAD = 1,      /* [-] factor of the load place.part */
    DMB_EXCITATION_BIT_LOAD = 2,  /* [N] bottom-hole load of the bit place.part */
    DMB_EXCITATION_FORCE = 3,     /* [N, N m] `component` of a force or moment at `place`, in `frame` */
    DMB_EXCITATION_UNBALANCE = 4, /* [kg m] mass times its distance from the axis at `place`: force times w^2. component
                                DMB_RX: turning from y to z of `frame`; DMB_X .. DMB_Z: to and fro along that axis */
    DMB_EXCITATION_ECCENTRICITY = 5, /* [-] the scene's own eccentric masses (those of axial-torsional pipes, which are
                                held across the hole, do nothing: DMB_ERR_UNSUPPORTED where all are), each times this
                                factor, turning with the frequency about the axes of their pipes, from y to z, as they
                                lie in the state at t = 0 */
    DMB_EXCITATION_FRICTION = 6,     /* [-] coefficient: every contact ring on the wall is rubbed by it times its normal
                                   force in the state, along the hole (component DMB_X) or around it (DMB_RX) */
    DMB_EXCITATION_SETTING = 7 /* the input place.part of control.h [its unit]: a set point, load factor or bit load;
                             limits on its rate are ignored. Others (gains, limits, friction, mud, stuck) change the
                             scene: DMB_ERR_UNSUPPORTED; one that still changes is DMB_ERR_VALUE */
};
typedef struct dmb_excitation {
    uint32_t struct_size;
    int32_t kind;      /* DMB_EXCITATION_..., default DMB_EXCITATION_FORCE */
    dmb_place place;   /* as the kind says */
    int32_t component; /* DMB_X .. DMB_RZ, default DMB_X */
    int32_t frame;     /* DMB_FRAME_WORLD (default) or DMB_FRAME_BODY: axes of the place in the state */
    double amplitude;  /* [unit of the kind] in the combined response; default 1 */
    double phase;      /* [rad] in the combined response; default 0 */
} dmb_excitation;
DMB_SIZED_STRUCT(dmb_excitation)

/* ---- Response --------------------------------------------------------------------------------------------------- */
enum {
    DMB_RESPONSE_DISPLACEMENT = 0,   /* [m, rad] of `place`, components along the axes of `frame` */
    DMB_RESPONSE_VELOCITY = 1,       /* [m/s, rad/s] its rate */
    DMB_RESPONSE_ACCELERATION = 2,   /* [m/s2, rad/s2] the rate of that */
    DMB_RESPONSE_SECTION_FORCE = 3,  /* [N, N m] as dmb_query_section, section frame */
    DMB_RESPONSE_SECTION_STRAIN = 4, /* [-, rad/m] as dmb_query_section, section frame */
    DMB_RESPONSE_CONTACT = 5,  /* [N] at contact point number place.pipe: DMB_X, DMB_Y friction, 0 and 1 of dmb_contact
                                (bristles in a response: DMB_ERR_UNSUPPORTED); DMB_Z normal force */
    DMB_RESPONSE_DRIVE = 6,    /* [N, N m] force of the drive place.part, as dmb_query_drive; no component */
    DMB_RESPONSE_REACTION = 7, /* [N, N m] on the part place.part, as dmb_query_reaction */
    DMB_RESPONSE_JOINT_POSITION = 8,
    DMB_RESPONSE_JOINT_SPEED = 9,         /* coordinates of the joint place.part and */
    DMB_RESPONSE_JOINT_ACCELERATION = 10, /* its forces: as dmb_query_joint */
    DMB_RESPONSE_JOINT_REACTION = 11,
    DMB_RESPONSE_JOINT_ACTION = 12,
    DMB_RESPONSE_MULTIPLIER = 13, /* number `component` of place.part, as dmb_query_multipliers */
    DMB_RESPONSE_BIT = 14,        /* [N, N m] DMB_X weight, DMB_RX torque on the bit place.part by the rock law */
    DMB_RESPONSE_OUTPUT = 15      /* the output DMB_OUTPUT_... that `component` says, at `place`. In a stepped sine all
                                    but those of a window; in a linear analysis those that are linear in the motion: no
                                    magnitudes, sums over the string, energies, works (DMB_ERR_UNSUPPORTED) */
};
typedef struct dmb_response_output {
    uint32_t struct_size;
    int32_t kind;      /* DMB_RESPONSE_..., default DMB_RESPONSE_DISPLACEMENT */
    dmb_place place;   /* required for some kinds */
    int32_t component; /* DMB_X .. DMB_RZ, default DMB_X */
    int32_t frame;     /* DMB_FRAME_WORLD (default) or DMB_FRAME_BODY */
} dmb_response_output;
DMB_SIZED_STRUCT(dmb_response_output)

/* ---- Frequency response ------------------------------------------------------------------------------------------ */
/* Axes of small motions, of the frames of places, and so of frequencies: those of the parts, which turn with them, or
 * axes that do not take part in turning about the part's own x axis, as for modes (modes.h): frequencies as they are
 * seen from outside. The latter is for round parts; there an unbalance of a string that turns at W acts at W. */
enum { DMB_RESPONSE_AXES_TURNING = 0, DMB_RESPONSE_AXES_AT_REST = 1 };
typedef struct dmb_response_options {
    uint32_t struct_size;
    uint32_t points;           /* [-] of the grid, 2 .. 1e6; 1 where both ends are one frequency; default 1000 */
    double frequency_low;      /* [Hz] >= 0; > 0 of a logarithmic grid; default 1 */
    double frequency_high;     /* [Hz] >= frequency_low; default 100 */
    const double *frequencies; /* [Hz] ascending, shape (points): these instead of a grid; NULL (default): the grid */
    int32_t logarithmic;       /* 1: equal ratios between frequencies; 0 (default): equal differences */
    uint32_t refinement;       /* [-] times the intervals on both sides of each peak of a transfer function are halved,
                                  0 .. 40; default 0. A peak that falls between two points unseen is not found */
    double structural_damping; /* [-] eta: stiffness (1 + i eta) K, >= 0; default 0 */
    double equilibrium_tolerance; /* [-] residual over the forces that balance in it; default 1e-6 */
    int32_t contact;              /* DMB_CONTACT_..., default DMB_CONTACT_AS_IS */
    int32_t friction;             /* 1 (default): the slope of the friction law damps or drives; 0: left out */
    double contact_gap;           /* [m] of DMB_CONTACT_CLOSED, >= 0; default 0 */
    int32_t axes;                 /* DMB_RESPONSE_AXES_TURNING (default), _AT_REST */
    int32_t reserved;
    double spin; /* [rad/s] strings turn at this speed in the state, as of dmb_modes_options; 0 (default): as they do */
} dmb_response_options;
DMB_SIZED_STRUCT(dmb_response_options)

typedef struct dmb_response dmb_response; /* transfer functions by frequency */
/* Transfer functions from every excitation to every output about the accepted state of a sim, which must be an
 * equilibrium, at rest or spinning steadily: (K (1 + i eta) + i w C - w^2 M) d = f at each frequency. Of a state that
 * spins, frames of `place` are its section's, and turn with it unless `axes` are at rest: then those that it has in the
 * state, and section forces are given in axes that do not spin. Structural damping there is that of parts that do not
 * turn. DMB_NOTE_INCOMPLETE: joints whose equations change in these axes, since their parts turn against each other, or
 * a string that turns on the wall, which goes round in axes that turn; results hold along and about the axes of
 * straight parts, not across. Or coefficients that change while parts turn, as of modes. excitations, outputs: shapes
 * (excitation_count), (output_count), 1 .. 1024 each, every struct of the size that the first says. options may be
 * NULL. The state is not changed; sim takes the message. *response is NULL on error: DMB_ERR_VALUE (option, component,
 * band; a state out of balance: by how much and where), _ID, _NOT_FINITE, _STRUCT_SIZE, _SINGULAR (frequency and part
 * that nothing holds there: at 0 a part that is free), _UNSUPPORTED (axes at rest: a load across a part that turns with
 * it), _NO_MEMORY, _CALLBACK, _ROTATION. A motion drive at frequency 0 has no displacement: _SINGULAR too. Memory: the
 * sim's allocator, until dmb_response_destroy; the sim need not outlive the response. Cost: O(points (elements + joints
 * + excitations)); of joints that share bodies the cube of their coordinates. One thread; several responses of one sim
 * may not be computed at a time. */
DMB_API int32_t dmb_analysis_response(dmb_sim *sim, const dmb_response_options *options,
                                      const dmb_excitation *excitations, uint32_t excitation_count,
                                      const dmb_response_output *outputs, uint32_t output_count,
                                      dmb_response **response);
/* Gives the memory back and sets *response to NULL. NULL-safe. */
DMB_API void dmb_response_destroy(dmb_response **response);
/* Numbers of frequencies (those of refinement included), excitations and outputs, shape (3). DMB_ERR_NULL, _HANDLE. */
DMB_API int32_t dmb_response_dimensions(const dmb_response *response, uint32_t dimensions[3]);
/* [Hz] ascending, shape (points). DMB_ERR_NULL, _HANDLE. */
DMB_API int32_t dmb_response_frequencies(const dmb_response *response, double *frequencies);
/* Output per unit of the excitation at each frequency, real and imaginary part, shape (points, 2). excitation
 * DMB_COMBINED: the output for all excitations with their amplitudes and phases. DMB_ERR_NULL, _HANDLE, _VALUE. */
#define DMB_COMBINED UINT32_MAX
DMB_API int32_t dmb_response_transfer(const dmb_response *response, uint32_t excitation, uint32_t output,
                                      double *values);
/* CSV: frequency, then amplitude and phase [rad] of each transfer function and of the combined outputs; header line,
 * '.' as decimal mark. DMB_ERR_IO on failure. */
DMB_API int32_t dmb_response_write_csv(const dmb_response *response, const char *path);

/* ---- Stepped sine ------------------------------------------------------------------------------------------------
 * Response in time to the scene's own time functions at one frequency, where the linear one does not hold:
 * contacts that open, friction that sticks, large motion. One call is one frequency; describe a scene for each (a
 * HARMONIC time function, a drive's speed), and transfer the state (dmb_sim_transfer_state) from one to the next.
 * Calls on different sims share nothing and may run in parallel with the same bits. */
typedef struct dmb_stepped_sine_options {
    uint32_t struct_size;
    uint32_t steps_per_period; /* [-] 16 .. 1e6; default 100. The scheme's frequency error is (2 pi/this)^2/12 or so */
    uint32_t periods;          /* [-] of a window, 1 .. 1e4; more than 1 where multiples of the period are awaited;
                                  default 4 */
    uint32_t windows;          /* [-] at most, 3 .. 1e6; default 500 */
    uint32_t harmonics;        /* [-] 1 .. 16, at most an eighth of steps_per_period; default 3 */
    uint32_t reserved;
    double tolerance; /* [-] settled: the remaining change, extrapolated from the last windows, is below this part
                         of the largest harmonic of each output; default 1e-3 */
    double floor;     /* [unit of the output] changes of a harmonic below it count as none, > 0; default 1e-12 */
} dmb_stepped_sine_options;
DMB_SIZED_STRUCT(dmb_stepped_sine_options)

typedef struct dmb_stepped_sine_report {
    uint32_t struct_size;
    int32_t settled;   /* 1 if it was */
    uint32_t windows;  /* [-] run */
    uint32_t rejected; /* [-] steps tried and not accepted */
    uint64_t steps;    /* [-] accepted */
    double change;     /* [-] between the last two windows, of the largest harmonic, worst output */
    double remaining;  /* [-] estimated still to come */
    double time;       /* [s] reached */
} dmb_stepped_sine_report;
DMB_SIZED_STRUCT(dmb_stepped_sine_report)

/* Runs the sim on in fixed steps until the Fourier amplitudes of successive windows agree. amplitudes, shape
 * (output_count, 1 + harmonics, 2): mean and 0, then for k = 1, 2, ... the k-th harmonic: its part of the output is the
 * real part of (re + i im) e^(2 pi i k frequency t), t the sim's time. Displacements are those since time 0 in the axes
 * of the world or (DMB_FRAME_BODY) those the place has at the call, less their drift over the window; component DMB_RX
 * is the rotation of dmb_query_rotation, DMB_RY and DMB_RZ are of the rotation vector from the pose at the call, below
 * pi. Other outputs: as those of queries. options and report may be NULL. DMB_NOTE_STOPPED: not settled in `windows`;
 * the amplitudes are those of the last. Errors: DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _VALUE, _NOT_FINITE, _ID,
 * _UNSUPPORTED, _NO_MEMORY with nothing changed; those of dmb_sim_step, after which the sim is in its last accepted
 * state. amplitudes and report are left alone on error. Cost: steps. */
DMB_API int32_t dmb_analysis_stepped_sine(dmb_sim *sim, double frequency, const dmb_stepped_sine_options *options,
                                          const dmb_response_output *outputs, uint32_t output_count, double *amplitudes,
                                          dmb_stepped_sine_report *report);

/* ---- Safe speeds -------------------------------------------------------------------------------------------------
 * A string that turns at W [rad/s] is shaken at orders of its speed: at W by eccentric masses, at 2 W by misalignment,
 * at 3 W by a tricone bit, at the number of blades times W by the cut. */
typedef struct dmb_order {
    uint32_t struct_size;
    uint32_t reserved;
    double order;              /* [-] frequency over rotary speed, > 0; default 1 */
    dmb_excitation excitation; /* with its amplitude; default: the scene's eccentric masses, as they are */
} dmb_order;
DMB_SIZED_STRUCT(dmb_order)

typedef struct dmb_speeds_report {
    uint32_t struct_size;
    uint32_t bands;         /* [-] that were found, those without room included */
    uint32_t silent_orders; /* [-] orders whose excitation moves no output at any speed */
    int32_t undamped;       /* 1: nothing damps, so that heights at resonances mean nothing */
    int32_t truncated;      /* 1: a band continues below speed_low, 2: above speed_high, 3: both, 0: none */
    int32_t reserved;
} dmb_speeds_report;
DMB_SIZED_STRUCT(dmb_speeds_report)

typedef struct dmb_speeds_options {
    uint32_t struct_size;
    uint32_t points;     /* [-] of the grid of speeds, 2 .. 1e5; default 200 */
    double speed_low;    /* [rad/s] > 0; default 1 */
    double speed_high;   /* [rad/s] > speed_low; default 30 */
    double threshold;    /* [-] severity above which a speed is to be avoided, > 0; default 1 */
    double margin;       /* [-] by which bands are wider on both sides, part of the speed, 0 .. 0.5; default
                            0.03 */
    uint32_t refinement; /* [-] as of a response, for each order; default 12 */
    int32_t contact;     /* these as of a response, but for friction, default 0: a string that turns slides, */
    int32_t friction;    /* and sliding has next to no slope */
    int32_t reserved;
    double contact_gap, structural_damping, equilibrium_tolerance; /* [m, -, -] as of a response, same defaults */
    dmb_speeds_report *report; /* written where the call succeeds; NULL (default): none */
    const void *unused;        /* NULL */
    double spin; /* [rad/s] strings turn at this speed in the state, as of dmb_response_options; 0 (default): as they
                    do. After a static state with slip_rotation of this speed and friction 1, the string lies where
                    friction carries it; eccentric masses are out of balance there (equilibrium_tolerance) */
} dmb_speeds_options;
DMB_SIZED_STRUCT(dmb_speeds_options)

typedef struct dmb_speed_band {
    uint32_t struct_size;
    uint32_t order;  /* [-] number of the order that counts most at the worst speed */
    uint32_t output; /* [-] number of its output that is worst */
    uint32_t reserved;
    double low, high;  /* [rad/s] of the band, margin included */
    double speed;      /* [rad/s] the worst in it */
    double severity;   /* [-] there */
    double frequency;  /* [Hz] of that order there */
    int32_t truncated; /* 1: continues below speed_low, 2: above speed_high, 3: both: look at a wider range; 0: whole */
    int32_t reserved1; /* 0 */
} dmb_speed_band;
DMB_SIZED_STRUCT(dmb_speed_band)

/* Bands of rotary speed to avoid about the accepted state of a sim. Severity of a speed: the sum over the orders of the
 * largest amplitude of an output over its limit, by the linear response at order times speed in axes at rest, where
 * orders are counted, about the rotating state; 1 is the limit even where all orders add up. limits:
 * [unit of the output] > 0, shape (output_count). bands: *band_count on entry is the capacity, the struct_size of the
 * first holds for all; on return the number of bands, by rising speed, DMB_NOTE_FULL where more were found. severity,
 * shape (points), may be NULL: largest within half a step of the grid around each speed. DMB_NOTE_INCOMPLETE
 * (dmb_sim_message and the report give the reason): an order excites nothing, nothing damps, a band is truncated at an
 * end of the range, or as of dmb_analysis_response. Call it for a sim of each depth or state. Errors: as
 * dmb_analysis_response, with nothing written. Cost: that of order_count responses. */
DMB_API int32_t dmb_analysis_speeds(dmb_sim *sim, const dmb_speeds_options *options, const dmb_order *orders,
                                    uint32_t order_count, const dmb_response_output *outputs, const double *limits,
                                    uint32_t output_count, dmb_speed_band *bands, uint32_t *band_count,
                                    double *severity);

DMB_C_END
#endif
