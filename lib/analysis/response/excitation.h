/* Excitation of a scene in a frequency response: the rows of force of a unit of an input, and how they go with
 * frequency. */
#ifndef DMB_ANALYSIS_RESPONSE_EXCITATION_H
#define DMB_ANALYSIS_RESPONSE_EXCITATION_H

#include "drillmbd/response.h"
#include "sim/sim.h"

enum {
    DMB_EXCITE_FORCE = 0,   /* f(w) = rows */
    DMB_EXCITE_INERTIA = 1, /* f(w) = w^2 rows */
    DMB_EXCITE_CONTROL = 2, /* f(w) = (gain + integral_gain/(i w)) rows */
    DMB_EXCITE_MOTION = 3 /* rows are displacements that move the coordinate of a drive by one and hold all equations of
                             joints; its speed is the input: they are rows/(i w) */
};

typedef struct dmb_excitation {
    int32_t law;    /* DMB_EXCITE_... */
    uint32_t drive; /* that is the input; DMB_NONE: none is */
    double gain, integral_gain;
    double *re, *im; /* forces on all rows, those that guides hold included, or displacements, shape (row_count); the
                        caller's memory, zeros to begin with */
} dmb_excitation;

/* Fills the excitation of input number `index`, already checked to be one of its kind. copy: a sim of the state; its
 * trial and work are written. message: why not. Errors: DMB_ERR_ID, _VALUE, _NOT_FINITE, _UNSUPPORTED; those of
 * dmb_system_evaluate. */
int32_t dmb_excitation_of(dmb_sim *copy, const dmb_input *input, uint32_t index, dmb_message *message,
                          dmb_excitation *out);

#endif
