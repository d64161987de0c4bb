/* Reading and writing of the structs of model.h; their T_init stand in definition_defaults.c. */
#ifndef DMB_MODEL_DEFINITION_DEFAULTS_H
#define DMB_MODEL_DEFINITION_DEFAULTS_H

#include "base/sized_struct.h"
#include "drillmbd/model.h"

DMB_DECLARE_STRUCT(dmb_model_options)
DMB_DECLARE_STRUCT(dmb_environment_def)
DMB_DECLARE_STRUCT(dmb_term)
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
DMB_DECLARE_STRUCT(dmb_compile_options)
DMB_DECLARE_STRUCT(dmb_model_info)

#endif
