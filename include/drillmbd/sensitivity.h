/* libdrillmbd - sensitivities: how the state and any output change with chosen parameters, along a run.
 *
 * A parameter is given by two sims besides the one that runs: the same scene with the parameter a little lower and a
 * little higher, brought to the same time in the same way (created; or settled by dmb_analysis_static). So anything
 * that can be described can be one: a coefficient of friction, a diameter, the energy of the rock, a value of a
 * time function, the survey; of sims of one model, an initial speed or the values of dmb_sim_set_drive, _set_input. */
#ifndef DRILLMBD_SENSITIVITY_H
#define DRILLMBD_SENSITIVITY_H

#include "output.h"

DMB_C_BEGIN

typedef struct dmb_sensitivity dmb_sensitivity; /* derivatives of one run */

typedef struct dmb_parameter {
    uint32_t struct_size;
    int32_t one_sided;   /* 1: steps are taken on the high side only, at half the cost; errors are then of first order
                            in `step`, not of second; default 0 */
    double step;         /* [unit of the parameter] > 0: `high` has it this much above the sim, `low` this much below.
                            Quantities that depend on it should change by 1e-9 .. 1e-6 of their scale: less is lost in
                            rounding, of more the third power is felt */
    const dmb_sim *low;  /* only read, and only by dmb_sensitivity_create */
    const dmb_sim *high; /* as `low` */
    char name[24];       /* for messages, ends with 0; default "" */
} dmb_parameter;
DMB_SIZED_STRUCT(dmb_parameter)

/* Begins with the derivatives that low and high have now, (high - low)/(2 step) of every number of the state.
 * parameters: count (1 .. 4096) of them, each with the same struct_size. The sim must outlive the object, which holds
 * its models; memory comes from the sim's allocator. Errors (dmb_sim_message says why): DMB_ERR_NULL, _HANDLE,
 * _STRUCT_SIZE; _VALUE: low or high is a scene of another make, has another time, or other contacts, locks or inputs
 * that are not numbers, or an input (control.h) is changing towards its set point; _UNSUPPORTED: joints with
 * DMB_METHOD_MULTIPLIERS, actuators with a delay, time functions whose times differ; _TOO_LARGE: clusters that are
 * solved by sparse matrices; _NO_MEMORY. O(count * size of the state). */
DMB_API int32_t dmb_sensitivity_create(dmb_sim *sim, const dmb_parameter *parameters, uint32_t count,
                                       dmb_sensitivity **sensitivity);
/* Sets *sensitivity to NULL; does nothing within one of its calls. NULL-safe. */
DMB_API void dmb_sensitivity_destroy(dmb_sensitivity **sensitivity);

/* dmb_sim_step and dmb_sim_advance of the sim, which gets the same bits as by these, and the derivatives along with it:
 * of each accepted step as it was done, its length, its breakpoints and its kept accelerations included. Between two of
 * these calls the sim may be changed by dmb_sim_set_drive only; inputs of control.h stay as they were set when this was
 * made (DMB_ERR_ORDER). DMB_NOTE_NOT_SMOOTH where a contact, a sticking bristle
 * or a limit differs between both sides of a parameter: the derivative there is the mean of two. Other notes and errors
 * as dmb_sim_step and dmb_sim_advance; DMB_ERR_ORDER: the sim was moved by other calls; DMB_ERR_SINGULAR: the iteration
 * matrix at the end of a step; state and derivatives are then as these calls leave the state. Allocates nothing. Costs
 * an evaluation with tangent and a factorisation a step, and an evaluation, two solutions and the contacts for each
 * side of a parameter; more where contacts change, with joints, bits, actuators, stuck places and callers' forces: in a
 * string in contact some 0.8 steps for each of four parameters, one-sided 0.55. */
DMB_API int32_t dmb_sensitivity_step(dmb_sensitivity *sensitivity, double duration, dmb_step_report *report);
DMB_API int32_t dmb_sensitivity_advance(dmb_sensitivity *sensitivity, double time, dmb_step_report *report);

/* Outputs and their derivatives by each parameter now: values, shape (count), may be NULL; derivatives [unit of the
 * output over that of the parameter], shape (count, parameters). Errors: those of the outputs' queries, with a
 * message of the sim; DMB_ERR_UNSUPPORTED: works, energies summed over the run, counts, windows; _ORDER: the sim was
 * moved by other calls; nothing is written then. */
DMB_API int32_t dmb_sensitivity_outputs(dmb_sensitivity *sensitivity, const dmb_output *outputs, uint32_t count,
                                        double *values, double *derivatives);
/* Derivative of body-frame pose [m, rad] and velocity [m/s, rad/s] in all rows by one parameter, rows being the free
 * and held components of the nodes in the order of the library; shape (rows) each, either may be NULL. *rows: how many
 * there are; with both arrays NULL that is all. Errors: _ORDER as above. */
DMB_API int32_t dmb_sensitivity_rows(dmb_sensitivity *sensitivity, uint32_t parameter, double *pose, double *velocity,
                                     uint32_t *rows);
/* *kinks [-]: accepted steps so far in which the parameter was not smooth. Errors: DMB_ERR_VALUE for a number that is
 * none. */
DMB_API int32_t dmb_sensitivity_kinks(const dmb_sensitivity *sensitivity, uint32_t parameter, uint64_t *kinks);

DMB_C_END
#endif
