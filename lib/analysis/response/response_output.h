/* An output of a frequency response: what a query would answer, as a linear function of the motion and of the forces it
 * takes. */
#ifndef DMB_ANALYSIS_RESPONSE_RESPONSE_OUTPUT_H
#define DMB_ANALYSIS_RESPONSE_RESPONSE_OUTPUT_H

#include "analysis/linear/dynamic_stiffness.h"
#include "analysis/linear/functional.h"
#include "analysis/response/excitation.h"

typedef struct dmb_response_output {
    dmb_functional functional;
    int32_t rate;        /* times (i w)^rate */
    int32_t elastic;     /* 1: the part by pose is of the stiffness and has its structural damping */
    uint32_t cluster;    /* whose forces of constraint count; DMB_NONE: none do */
    uint32_t multiplier; /* first of them in the rows of the cluster */
    uint32_t multiplier_count;
    uint32_t guide_count; /* rows that are held and whose forces count */
    double multiplier_weight[6];
    uint32_t guide[6]; /* which of held_node, held_component */
    double guide_weight[6];
    uint32_t drive;          /* that acts by itself where it is the input; DMB_NONE: none */
    double direct, integral; /* what it adds there: direct + integral/(i w) */
} dmb_response_output;

/* Output number `index`, already checked to be one of its kind. options: of the response. message: why not. Errors:
 * those of the queries, DMB_ERR_UNSUPPORTED. */
int32_t dmb_response_output_of(dmb_linear *linear, const dmb_response_options *options, const dmb_output *output,
                               uint32_t index, dmb_message *message, dmb_response_output *out);

/* The output for displacements x that forces f of the input (0 where displacements are told) lead to, shapes (rows). */
dmb_complex_number dmb_response_output_value(const dmb_dynamic_stiffness *stiffness, const dmb_response_output *output,
                                             const dmb_excitation *input, dmb_complex_array x, dmb_complex_array f);

#endif
