/* Forward sensitivities along a run (eq:sensitivity.step).
 *
 * A step is y1 = f(y0, p): the equations R(y1; y0, p) = 0 of generalized-alpha, then what contacts, drives and bits
 * keep. With rates S = dy/dp, S1 = f_y S0 + f_p is the difference of the two steps from y0 +- step S0 at p +- step over
 * 2 step, each taken beside the accepted one (integrator/follow); of a one-sided one from y0 + step S0 and y0. The
 * scenes at p +- step are those of the caller's models; one worker takes all these steps. Internal numerical
 * differentiation: Bock 1981. */
#ifndef DMB_ANALYSIS_SENSITIVITY_SENSITIVITY_H
#define DMB_ANALYSIS_SENSITIVITY_SENSITIVITY_H

#include "drillmbd/sensitivity.h"
#include "integrator/follow.h"
#include "sim/access.h"
#include "sim/layout.h"

enum { DMB_SIDE_LOW = 0, DMB_SIDE_HIGH = 1 };

typedef struct dmb_rated_parameter {
    double step;
    int32_t one_sided;
    int32_t reserved;
    dmb_model *model[2];      /* DMB_SIDE_LOW, DMB_SIDE_HIGH; held */
    double *rates, *accepted; /* of every number of the state: now, and at the start of the call under way; of an
                                 advance before the step under way */
    uint64_t kinks, accepted_kinks;
    char name[24];
} dmb_rated_parameter;

struct dmb_sensitivity {
    uint32_t magic;
    uint32_t count;
    dmb_allocator allocator;
    size_t bytes; /* of this block */
    dmb_sim *sim;
    dmb_sim *worker;
    dmb_rated_parameter *parameters; /* shape (count) */
    size_t numbers;                  /* [-] of the state */
    double *high, *low;              /* numbers of the state on both sides, shape (numbers) */
    double *middle;   /* the same of the sim, taken beside as the others, where a parameter is one-sided */
    double *seen;     /* displacement, velocity and acceleration at which the rates are, dmb_sensitivity_take_sight */
    double *settings; /* of the inputs when this was made, which stay, shape (input) */
    dmb_follow_room room;
    dmb_follower follower;
    double followed_from; /* [s] time before the step that was followed last */
    int32_t busy;
    int32_t advances; /* 1: the call under way keeps the steps that it has taken */
    int32_t followed; /* 1: a step was followed to its end */
    int32_t reserved;
};

/* Fields of a configuration (DMB_GROUP_NOW or _TRIAL), then those of the memory. */
typedef struct dmb_state_fields {
    dmb_field field[DMB_FIELD_MAX];
    size_t count;
} dmb_state_fields;

void dmb_state_fields_of(const dmb_sim *sim, int32_t group, dmb_state_fields *of);
/* 1: of doubles that the step computes or the caller sets. */
static inline int dmb_field_has_numbers(const dmb_field *field)
{
    return field->check == DMB_CHECK_NUMBERS || field->check == DMB_CHECK_INPUTS ||
           field->check == DMB_CHECK_SET_INPUTS;
}
/* The number of values in a state, and these values. */
size_t dmb_state_count(const dmb_sim *sim);
void dmb_state_read(const dmb_sim *sim, int32_t group, double *to);
/* Rates of one field of the state, by where its data are in the sim. */
const double *dmb_rates_of(const dmb_sensitivity *s, const dmb_rated_parameter *p, const void *data);
/* The worker stands where the sim stands, its partition too. */
void dmb_sensitivity_stand(dmb_sensitivity *s);
/* The worker stands on one side of the sim, in the scene there. */
void dmb_sensitivity_aside(dmb_sensitivity *s, const dmb_rated_parameter *p, int side);
/* DMB_OK, DMB_ERR_NULL, _HANDLE; _ORDER within one of its calls. */
int32_t dmb_sensitivity_alive(const dmb_sensitivity *s);
/* The rates belong to these displacements, velocities and accelerations. */
void dmb_sensitivity_take_sight(dmb_sensitivity *s, const dmb_configuration *of);
/* DMB_ERR_ORDER with a message: the sim is not where the rates are. */
int32_t dmb_sensitivity_stands(const dmb_sensitivity *s);
/* Rates as before the call (back), or those reached for the next one to begin with. */
void dmb_sensitivity_settle(dmb_sensitivity *s, int back);
/* After accelerations were made anew, by a breakpoint or by the caller: rates that fit them. Errors as dmb_system_jump,
 * with a message; the rates are as before then. */
int32_t dmb_sensitivity_catch_up(dmb_sensitivity *s);
/* The sim's follower: rates along a step. */
int32_t dmb_sensitivity_follow(void *context, const dmb_attempt *attempt);
/* It notes the increments at which contacts open. */
void dmb_sensitivity_note_opening(void *context);

#endif
