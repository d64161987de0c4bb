/* Result of dmb_analysis_response. */
#ifndef DMB_ANALYSIS_RESPONSE_RESPONSE_H
#define DMB_ANALYSIS_RESPONSE_RESPONSE_H

#include "analysis/linear/linear.h"
#include "base/message.h"
#include "drillmbd/analyse.h"
#include "sim/sim.h"

struct dmb_response {
    uint32_t magic;
    uint32_t points, excitations, outputs;
    int32_t undamped; /* 1: no structural damping, and no motion meets a damping force */
    int32_t reserved;
    dmb_allocator allocator;
    double *amplitude, *phase; /* shape (excitations) */
    dmb_output *output;        /* shape (outputs) */
    double *frequency;         /* [Hz] shape (points) */
    double *value;             /* real and imaginary parts, shape (points, excitations, outputs, 2) */
    void *block;               /* amplitude, phase, output */
    size_t block_size;
    void *table; /* frequency, value */
    size_t table_size;
};

/* Without points; NULL if there is no memory. */
dmb_response *dmb_response_new(const dmb_allocator *allocator, uint32_t excitations, uint32_t outputs);
/* A table of that many points, with uninitialised values, replaces that of the response, which the caller frees with
 * dmb_release. DMB_OK or DMB_ERR_NO_MEMORY, which changes nothing. */
int32_t dmb_response_resize(dmb_response *response, uint32_t points);

/* Output at a point for all excitations with their amplitudes and phases. */
void dmb_response_combined(const dmb_response *response, size_t point, uint32_t output, double value[2]);

/* Real and imaginary parts of the first output of an input at a point; outputs follow. */
static inline double *dmb_response_value(const dmb_response *response, size_t point, size_t input)
{
    return response->value + 2 * response->outputs * (response->excitations * point + input);
}

/* Options of a frequency response, checked. */

enum { DMB_RESPONSE_INPUTS_MAX = 1024 };

/* Defaults overlaid with what is given (may be NULL); on refusal a message naming the field. */
int32_t dmb_response_options_get(const dmb_response_options *given, dmb_message *message, dmb_response_options *out);
/* Struct i of the caller's array, with the item size of the first one; checks the fields that do not depend on the
 * scene. */
int32_t dmb_input_get(const dmb_excitation *excitations, uint32_t i, dmb_message *message, dmb_excitation *out);
/* The same for a stepped sine, at a frequency that is checked too. */
int32_t dmb_stepped_sine_options_get(const dmb_stepped_sine_options *given, double frequency, dmb_message *message,
                                     dmb_stepped_sine_options *out);
/* Frequency number i [Hz] of the grid. */
double dmb_response_grid(const dmb_response_options *options, uint32_t i);

/* More points where transfer functions have peaks. */

/* Puts a point into the middle of every interval beside a peak of the magnitude of a transfer function. *fresh, shape
 * (points), 1 for a new point, of which only the frequency is written; the caller frees it with dmb_release, NULL
 * without new points. DMB_OK or DMB_ERR_NO_MEMORY. */
int32_t dmb_response_split_peaks(dmb_response *response, uint8_t **fresh);

/* Excitation of a scene in a frequency response: force by rows per unit of an input, and its dependence on frequency.
 */

enum {
    DMB_EXCITE_FORCE = 0,   /* f(w) = rows */
    DMB_EXCITE_INERTIA = 1, /* f(w) = w^2 rows */
    DMB_EXCITE_CONTROL = 2, /* f(w) = (gain + integral_gain/(i w)) rows */
    DMB_EXCITE_MOTION = 3 /* rows are displacements that move the coordinate of a drive by one and satisfy all equations
                             of joints; its speed is the input: rows/(i w) */
};

typedef struct dmb_linear_excitation {
    int32_t law;    /* DMB_EXCITE_... */
    uint32_t drive; /* drive whose target is the input; DMB_NONE: none */
    uint32_t bit;   /* bit whose bottom-hole load is the input; DMB_NONE: none */
    double gain, integral_gain;
    double *re, *im; /* forces on all rows, including constrained ones, or displacements, shape (row_count); the
                      *                         caller's memory, zeros to begin with */
} dmb_linear_excitation;

/* Fills the excitation of input number `index`, already checked to be one of its kind. linear->work: its trial and work
 * are written. message: why not. Errors: DMB_ERR_ID, _VALUE, _NOT_FINITE, _UNSUPPORTED; those of
 * dmb_system_evaluate. */
int32_t dmb_excitation_of(const dmb_linear *linear, const dmb_excitation *input, uint32_t index, dmb_message *message,
                          dmb_linear_excitation *out);

/* An output of a frequency response: the result of a query as a linear function of the motion and of its forces. */

typedef struct dmb_linear_output {
    dmb_functional functional;
    int32_t rate;        /* times (i w)^rate */
    int32_t elastic;     /* 1: the part by pose belongs to the stiffness and has its structural damping */
    uint32_t cluster;    /* component whose constraint forces enter; DMB_NONE: none */
    uint32_t multiplier; /* first of them in the rows of the cluster */
    uint32_t multiplier_count;
    uint32_t support_count; /* number of constrained rows whose forces enter */
    double multiplier_weight[6];
    uint32_t support[6]; /* which of constrained_node, constrained_component */
    double support_weight[6];
    uint32_t drive;          /* drive that acts directly if it is the input; DMB_NONE: none */
    double direct, integral; /* what it adds there: direct + integral/(i w) */
    uint32_t bit;            /* bit whose bottom-hole load acts directly if it is the input; DMB_NONE: none */
} dmb_linear_output;

/* Output number `index`, already checked to be one of its kind. options: of the response. message: why not. Errors:
 * those of the queries, DMB_ERR_UNSUPPORTED. */
int32_t dmb_linear_output_of(dmb_linear *linear, const dmb_response_options *options, const dmb_output *output,
                             uint32_t index, dmb_message *message, dmb_linear_output *out);

/* The motion or force that an output of a linear analysis is; and the bit whose load it has in it (DMB_NONE). On
 * refusal `why`. Errors: DMB_ERR_UNSUPPORTED, _ID. */
int32_t dmb_asked_output_of(const dmb_sim *sim, const dmb_output *output, dmb_asked_output *out, uint32_t *bit,
                            const char **why);
/* The vibration of a place that DMB_OUTPUT_VIBRATION .. names; 0 for any other output, *out as DMB_ASKED_OUTPUT. */
int32_t dmb_asked_vibration(const dmb_output *output, dmb_asked_output *out);

/* The output for displacements x caused by forces f of the input (0 for prescribed displacements), shapes (rows). */
dmb_complex_number dmb_linear_output_value(const dmb_dynamic_stiffness *stiffness, const dmb_linear_output *output,
                                           const dmb_linear_excitation *input, dmb_complex_array x,
                                           dmb_complex_array f);

/* Points of a response (response_points.c). */

typedef struct dmb_response_work {
    dmb_sim *sim; /* for its message */
    dmb_response_options options;
    dmb_linear *linear;
    dmb_linear_turned turned;
    dmb_dynamic_stiffness stiffness;
    dmb_dynamic_group group; /* of zeros where points are solved one by one */
    dmb_linear_excitation *excitations;
    dmb_linear_output *outputs;
    uint32_t excitation_count, output_count;
    dmb_complex_array x, f; /* displacements, and the forces that lead to them, shape (rows) */
    int32_t needs_forces;   /* 1: some output is a reaction, which f is a part of; else f stays 0 */
    int32_t reserved;
    void *block;
    size_t block_size;
} dmb_response_work;

/* Points that are solved together, in ascending order. */
typedef struct dmb_response_points {
    uint32_t count;
    uint32_t point[DMB_FREQUENCIES];
} dmb_response_points;

/* Solves at points of `response` whose frequencies are set. */
int32_t dmb_response_solve(dmb_response_work *work, dmb_response *response, const dmb_response_points *points);

/* ---- Speeds to avoid --------------------------------------------------------------------------------------------- */

/* Severity over speed: one curve per order, their sum, and the bands above a threshold. */

/* Of one order; straight between its points. */
typedef struct dmb_speeds_curve {
    double order; /* [-] */
    uint32_t count;
    uint32_t taken;   /* points that have been merged with those of other curves */
    double *speed;    /* [rad/s] ascending, shape (count) */
    double *severity; /* shape (count) */
    uint32_t *output; /* output with the largest severity, shape (count) */
} dmb_speeds_curve;

/* Sum of the curves at a speed; *order: which of them is largest there, *output: its worst output. */
double dmb_speeds_sum(const dmb_speeds_curve *curves, uint32_t count, double speed, uint32_t *order, uint32_t *output);

/* The curves of all orders. */
typedef struct dmb_speeds_curves {
    const dmb_speeds_curve *curve; /* shape (count) */
    uint32_t count, points;
    const double *speed; /* [rad/s] points of all curves, ascending, shape (points) */
} dmb_speeds_curves;

/* The bands above the threshold, widened by the margin and joined where they meet. bands: room of them; returns how
 * many there are, more than room if they do not fit. *truncated: 1 if a band goes on below the first speed, 2 above the
 * last one, 3 both, 0 neither. */
uint32_t dmb_speeds_bands(const dmb_speeds_curves *all, const dmb_speeds_options *options, dmb_speed_band *bands,
                          uint32_t room, int32_t *truncated);

#endif
