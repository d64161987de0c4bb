/* Forward sensitivities along a run (eq:sensitivity.step).
 *
 * A step is y1 = f(y0, p): the equations R(y1; y0, p) = 0 of generalized-alpha, then the memory of contacts, drives and
 * bits. With rates S = dy/dp, S1 = f_y S0 + f_p is the difference of the two steps from y0 +- step S0 at p +- step over
 * 2 step, each a companion step of the accepted one (integrator/companion); one-sided: of the steps from y0 + step S0
 * and y0. The scenes at p +- step are those of the caller's models; one worker computes all these steps. Internal
 * numerical differentiation: Bock 1981. */
#ifndef DMB_ANALYSIS_SENSITIVITY_SENSITIVITY_H
#define DMB_ANALYSIS_SENSITIVITY_SENSITIVITY_H

#include "drillmbd/analyse.h"
#include "integrator/companion.h"
#include "sim/access.h"
#include "sim/layout.h"

enum { DMB_SIDE_LOW = 0, DMB_SIDE_HIGH = 1 };

typedef struct dmb_rated_parameter {
    double step;
    int32_t one_sided;
    int32_t reserved;
    dmb_model *model[2];      /* DMB_SIDE_LOW, DMB_SIDE_HIGH; references kept */
    double *rates, *accepted; /* of every number of the state: at present, and at the start of the present call; in an
                                 advance before the present step */
    uint64_t kinks, accepted_kinks;
    char name[24];
} dmb_rated_parameter;

struct dmb_sensitivity {
    uint32_t magic;
    uint32_t count;
    dmb_allocator allocator;
    size_t bytes; /* size of this block */
    dmb_sim *sim;
    dmb_sim *worker;
    dmb_rated_parameter *parameters; /* shape (count) */
    size_t numbers;                  /* length of the state */
    double *high, *low;              /* states on both sides, shape (numbers) */
    double *middle;                  /* the same of the sim, by a companion step, if a parameter is one-sided */
    double *seen;     /* displacement, velocity and acceleration of the rates, dmb_sensitivity_read_sight */
    double *settings; /* of the inputs at creation, which must not change, shape (input) */
    dmb_companion_workspace workspace;
    dmb_follower follower;
    double followed_from; /* [s] start time of the last companion step */
    int32_t busy;
    int32_t advances; /* 1: the present call keeps its completed steps */
    int32_t followed; /* 1: a companion step was completed */
    int32_t reserved;
};

/* Fields of a configuration (DMB_GROUP_NOW or _TRIAL), then those of the memory. */
typedef struct dmb_state_fields {
    dmb_field field[DMB_FIELD_MAX];
    size_t count;
} dmb_state_fields;

void dmb_state_fields_of(const dmb_sim *sim, int32_t group, dmb_state_fields *of);
/* 1: a field of doubles that the step computes or the caller sets. */
static inline int dmb_field_has_numbers(const dmb_field *field)
{
    return field->check == DMB_CHECK_NUMBERS || field->check == DMB_CHECK_INPUTS ||
           field->check == DMB_CHECK_SET_INPUTS;
}
/* Number of values in a state, and these values. */
size_t dmb_state_count(const dmb_sim *sim);
void dmb_state_read(const dmb_sim *sim, int32_t group, double *to);
/* Rates of one field of the state, identified by its data pointer in the sim. */
const double *dmb_rates_of(const dmb_sensitivity *s, const dmb_rated_parameter *p, const void *data);
/* Sets the worker to the state and partition of the sim. */
void dmb_sensitivity_stand(dmb_sensitivity *s);
/* Sets the worker to one side of the sim, in the scene of that side. */
void dmb_sensitivity_aside(dmb_sensitivity *s, const dmb_rated_parameter *p, int side);
/* DMB_OK, DMB_ERR_NULL, _HANDLE; _ORDER within one of its calls. */
int32_t dmb_sensitivity_alive(const dmb_sensitivity *s);
/* Records the displacements, velocities and accelerations to which the rates belong. */
void dmb_sensitivity_read_sight(dmb_sensitivity *s, const dmb_configuration *of);
/* DMB_ERR_ORDER with a message if the sim is not in the state of the rates. */
int32_t dmb_sensitivity_stands(const dmb_sensitivity *s);
/* Restores the rates before the call (back), or stores the present ones for the next call. */
void dmb_sensitivity_settle(dmb_sensitivity *s, int back);
/* Updates the rates after accelerations were recomputed at a breakpoint or by the caller. Errors as dmb_system_jump,
 * with a message; the rates are then unchanged. */
int32_t dmb_sensitivity_catch_up(dmb_sensitivity *s);
/* Callback of the sim: rates along a step. */
int32_t dmb_sensitivity_companions(void *context, const dmb_trial_step *trial_step);
/* Records the increments at which contacts open. */
void dmb_sensitivity_note_opening(void *context);

#endif
