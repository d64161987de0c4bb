/* The calls that add parts to a model share: reading and writing of the structs of drillmbd/scene.h, whose T_init stand
 * in describe_defaults.c, and the release of what the model has copied. */
#ifndef DMB_MODEL_DESCRIBE_H
#define DMB_MODEL_DESCRIBE_H

#include "base/sized_struct.h"
#include "drillmbd/scene.h"
#include "model/model.h"

DMB_DECLARE_STRUCT(dmb_model_options)
DMB_DECLARE_STRUCT(dmb_environment_def)
DMB_DECLARE_STRUCT(dmb_segment)
DMB_DECLARE_STRUCT(dmb_wall_def)
DMB_DECLARE_STRUCT(dmb_string_def)
DMB_DECLARE_STRUCT(dmb_pipe_def)
DMB_DECLARE_STRUCT(dmb_body_def)
DMB_DECLARE_STRUCT(dmb_bit_def)
DMB_DECLARE_STRUCT(dmb_joint_def)
DMB_DECLARE_STRUCT(dmb_coupling_def)
DMB_DECLARE_STRUCT(dmb_constraint_def)
DMB_DECLARE_STRUCT(dmb_drive_def)
DMB_DECLARE_STRUCT(dmb_load_def)
DMB_DECLARE_STRUCT(dmb_spring_def)
DMB_DECLARE_STRUCT(dmb_force_def)
DMB_DECLARE_STRUCT(dmb_stuck_def)
DMB_DECLARE_STRUCT(dmb_stabiliser_def)
DMB_DECLARE_STRUCT(dmb_compile_options)
DMB_DECLARE_STRUCT(dmb_model_info)

/* Frees a time function's copy of terms and tables. */
void dmb_time_function_release(dmb_time_function *time_function, const dmb_allocator *allocator);

/* Frees a spring's table. */
void dmb_spring_release(dmb_spring_plan *spring, const dmb_allocator *allocator);

/* Frees the wall's copy of the survey. */
void dmb_wall_release(dmb_wall_def *wall, const dmb_allocator *allocator);

/* Inputs as described. */

/* Bounds in force: the narrower of the input's own and those of its target. */
double dmb_input_low(const dmb_input_def *def);
double dmb_input_high(const dmb_input_def *def);
/* 1: it stands in the place of a time function, and may be on its way. */
int dmb_input_is_time_function(int32_t target);

#endif
