/* The scene of a sim with inputs, or whose hole is widened by cutters: the compiled one, which all sims share, but for
 * what these move. Such parts are the sim's own, in its block, so that a step reads them as it reads any scene. They
 * follow from input_value and input_begin alone; the hole points to hole_widening. */
#ifndef DMB_SIM_OWN_SCENE_H
#define DMB_SIM_OWN_SCENE_H

#include "base/memory.h"
#include "sim/sim.h"

typedef struct dmb_own_scene {
    dmb_scene scene, dense; /* dense: where the compiled one has it */
    dmb_scene_drive *drives;
    dmb_scene_load *loads;
    dmb_scene_bit *bits;
    dmb_time_function *time_functions; /* those of the model, then one for each input */
    dmb_segment *segments;             /* of each input, shape (input) */
    dmb_reference *references;         /* shape (input) */
    dmb_element_type *types;           /* with an input of density only, as are the next two */
    double *weight_mass;
    double *weight_moment;
    double *node_damping;        /* with one of damping only */
    dmb_flow_piece *flow_pieces; /* with one of the rate of flow only, as are the next two */
    double *flow_element;
    double *flow_node;
} dmb_own_scene;

/* 1: inputs move parts of it, or cutters the wall. */
static inline int dmb_needs_own_scene(const dmb_scene *scene)
{
    return scene->input_count > 0 || scene->hole.cuts > 0;
}
/* Its place in the block; NULL while counting. */
dmb_own_scene *dmb_own_scene_take(dmb_arena *arena, const dmb_scene *scene);
/* A new sim: its inputs as described, and the scene made of them its scene. Nothing without an own one, as below. */
void dmb_own_scene_begin(dmb_sim *sim);
/* A copy for an analysis, which may outlive its sim: a scene of its own too, in the place of the one it was carved for,
 * which is dense where the model's is sparse. Before its state is taken. */
void dmb_own_scene_copy(dmb_sim *copy, const dmb_sim *sim);
/* A copy goes into another scene of the same make, at its own input_value and input_begin. O(number of drives, loads,
 * bits, inputs; of nodes with inputs of density, damping or flow). */
void dmb_own_scene_enter(dmb_sim *copy, const dmb_model *model);
/* After input_value or input_begin were written. O(number of nodes) with inputs of density, damping or flow, else
 * O(number of drives, loads, bits and inputs). */
void dmb_own_scene_update(dmb_sim *sim);
/* Value of an input by the description of what it moves; NaN of a time function. */
double dmb_described_setting(const dmb_sim *sim, uint32_t input);
/* Time function that an input takes the place of, in a compiled scene; DMB_NONE: none. */
uint32_t dmb_described_time_function(const dmb_scene *scene, uint32_t input);

/* Inputs of an accepted state. */

/* Value and rate of input i that are in force now: what stands in the place of its time function, else what is set.
 * Errors: those of the time function's callback. */
int32_t dmb_input_present(const dmb_sim *sim, uint32_t i, double *value, double *rate);

#endif
