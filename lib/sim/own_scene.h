/* Scene of a sim with inputs, or whose hole is widened by cutters: the compiled scene, shared by all sims, except for
 * the parts changed by these. Changed parts are stored in the sim's block, so that a step reads them as in any scene.
 * They depend on input_value and input_begin only; the hole refers to hole_widening. */
#ifndef DMB_SIM_OWN_SCENE_H
#define DMB_SIM_OWN_SCENE_H

#include "base/memory.h"
#include "force/reference.h"
#include "sim/sim.h"

typedef struct dmb_own_scene {
    dmb_scene scene, dense; /* dense: where the compiled one has it */
    dmb_scene_drive *drives;
    dmb_scene_load *loads;
    dmb_scene_bit *bits;
    dmb_time_function *time_functions; /* those of the model, then one per input */
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

/* 1: inputs change parts of it, or cutters the wall. */
static inline int dmb_needs_own_scene(const dmb_scene *scene)
{
    return scene->input_count > 0 || scene->hole.cuts > 0;
}
/* Its storage in the block; NULL while counting. */
dmb_own_scene *dmb_own_scene_allocate(dmb_arena *arena, const dmb_scene *scene);
/* Start of a new sim: inputs as described, and the scene for them. No effect without an own scene, as below. */
void dmb_own_scene_begin(dmb_sim *sim);
/* Scene of a copy for an analysis, which may outlive its sim: an own scene replaces the one of the layout, which is
 * dense if the model's is sparse. Before its state is copied. */
void dmb_own_scene_copy(dmb_sim *copy, const dmb_sim *sim);
/* Moves a copy into another scene of the same structure, with its present input_value and input_begin. O(number of
 * drives, loads, bits, inputs; of nodes with inputs of density, damping or flow). */
void dmb_own_scene_enter(dmb_sim *copy, const dmb_model *model);
/* Updates the scene after changes of input_value or input_begin. O(number of nodes) with inputs of density, damping or
 * flow, otherwise O(number of drives, loads, bits and inputs). */
void dmb_own_scene_update(dmb_sim *sim);
/* External damping of pipe as it is now, by inputs or as described: lateral and axial [N s/m2], torsional [N s]. */
void dmb_external_damping(const dmb_sim *sim, double coefficients[3]);
/* Described value of the quantity of an input; NaN for a time function. */
double dmb_described_setting(const dmb_sim *sim, uint32_t input);
/* Time function replaced by an input in a compiled scene; DMB_NONE: none. */
uint32_t dmb_described_time_function(const dmb_scene *scene, uint32_t input);

/* Inputs of an accepted state. */

/* Value and rate of input i that are in effect now: of the function that replaces its time function, otherwise the set
 * value. Errors: those of the time function's callback. */
int32_t dmb_input_present(const dmb_sim *sim, uint32_t i, double *value, double *rate);

#endif
