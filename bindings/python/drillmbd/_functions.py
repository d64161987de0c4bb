"""The functions of the C interface. Made from the headers by generate.py: do not edit, run that instead."""
from __future__ import annotations

import ctypes
from ctypes import POINTER, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p  # noqa: F401
from typing import Any

from ._structs import *  # noqa: F403

# name: (result, arguments...)
PROTOTYPES: dict[str, tuple[Any, ...]] = {
    "dmb_allocator_init": (c_int32, POINTER(Allocator), c_uint32,),
    "dmb_analysis_array": (c_int32, c_void_p, c_int32, POINTER(c_double), POINTER(c_uint64),),
    "dmb_analysis_buckling": (c_int32, c_void_p, POINTER(BucklingOptions), POINTER(c_void_p),),
    "dmb_analysis_check": (c_int32, c_void_p, POINTER(CheckReport),),
    "dmb_analysis_check_text": (c_int32, c_void_p, c_char_p, c_size_t, POINTER(c_size_t),),
    "dmb_analysis_friction_factor": (c_int32, c_void_p, POINTER(TorqueDragOptions), POINTER(Operation), c_int32, c_double, POINTER(c_double),),
    "dmb_analysis_hydraulics": (c_int32, c_void_p, c_double, c_double, POINTER(Hydraulics),),
    "dmb_analysis_mesh": (c_int32, c_void_p, Id, POINTER(c_double), c_uint32,),
    "dmb_analysis_modes": (c_int32, c_void_p, POINTER(ModesOptions), POINTER(c_void_p),),
    "dmb_analysis_path": (c_int32, c_void_p, POINTER(PathOptions), POINTER(PathReport),),
    "dmb_analysis_place_rows": (c_int32, c_void_p, Place, c_int32, c_int32, POINTER(c_uint32), POINTER(c_double), POINTER(c_uint32),),
    "dmb_analysis_response": (c_int32, c_void_p, POINTER(ResponseOptions), POINTER(Excitation), c_uint32, POINTER(Output), c_uint32, POINTER(c_void_p),),
    "dmb_analysis_speeds": (c_int32, c_void_p, POINTER(SpeedsOptions), POINTER(Order), c_uint32, POINTER(Output), POINTER(c_double), c_uint32, POINTER(SpeedBand), POINTER(c_uint32), POINTER(c_double),),
    "dmb_analysis_state_space": (c_int32, c_void_p, POINTER(StateSpaceOptions), POINTER(Excitation), c_uint32, POINTER(Output), c_uint32, POINTER(c_void_p),),
    "dmb_analysis_static": (c_int32, c_void_p, POINTER(StaticOptions), POINTER(StaticReport),),
    "dmb_analysis_stepped_sine": (c_int32, c_void_p, c_double, POINTER(SteppedSineOptions), POINTER(Output), c_uint32, POINTER(c_double), POINTER(SteppedSineReport),),
    "dmb_analysis_torque_drag": (c_int32, c_void_p, POINTER(TorqueDragOptions), POINTER(Operation), c_uint32, POINTER(TorqueDragRow),),
    "dmb_analysis_torque_drag_profile": (c_int32, c_void_p, POINTER(TorqueDragOptions), POINTER(Operation), c_uint32, POINTER(c_double), POINTER(c_double), POINTER(c_double), POINTER(c_double),),
    "dmb_bit_def_init": (c_int32, POINTER(BitDef), c_uint32,),
    "dmb_bit_state_init": (c_int32, POINTER(BitState), c_uint32,),
    "dmb_body_def_init": (c_int32, POINTER(BodyDef), c_uint32,),
    "dmb_buckling_count": (c_uint32, c_void_p,),
    "dmb_buckling_destroy": (None, POINTER(c_void_p),),
    "dmb_buckling_factor": (c_int32, c_void_p, c_uint32, POINTER(c_double),),
    "dmb_buckling_get_info": (c_int32, c_void_p, POINTER(BucklingInfo),),
    "dmb_buckling_info_init": (c_int32, POINTER(BucklingInfo), c_uint32,),
    "dmb_buckling_options_init": (c_int32, POINTER(BucklingOptions), c_uint32,),
    "dmb_buckling_shape": (c_int32, c_void_p, c_uint32, Place, POINTER(c_double),),
    "dmb_build_info": (c_char_p,),
    "dmb_check_report_init": (c_int32, POINTER(CheckReport), c_uint32,),
    "dmb_compile_options_init": (c_int32, POINTER(CompileOptions), c_uint32,),
    "dmb_constraint_def_init": (c_int32, POINTER(ConstraintDef), c_uint32,),
    "dmb_contact_init": (c_int32, POINTER(Contact), c_uint32,),
    "dmb_contact_total_init": (c_int32, POINTER(ContactTotal), c_uint32,),
    "dmb_coupling_def_init": (c_int32, POINTER(CouplingDef), c_uint32,),
    "dmb_drive_def_init": (c_int32, POINTER(DriveDef), c_uint32,),
    "dmb_drive_state_init": (c_int32, POINTER(DriveState), c_uint32,),
    "dmb_energy_init": (c_int32, POINTER(Energy), c_uint32,),
    "dmb_environment_def_init": (c_int32, POINTER(EnvironmentDef), c_uint32,),
    "dmb_error_init": (c_int32, POINTER(ErrorStruct), c_uint32,),
    "dmb_event_def_init": (c_int32, POINTER(EventDef), c_uint32,),
    "dmb_event_report_init": (c_int32, POINTER(EventReport), c_uint32,),
    "dmb_excitation_init": (c_int32, POINTER(Excitation), c_uint32,),
    "dmb_fatigue_create": (c_int32, c_void_p, POINTER(FatigueOptions), POINTER(Place), c_uint32, POINTER(c_void_p),),
    "dmb_fatigue_destroy": (None, POINTER(c_void_p),),
    "dmb_fatigue_get": (c_int32, c_void_p, c_uint32, POINTER(FatigueResult),),
    "dmb_fatigue_histogram": (c_int32, c_void_p, c_uint32, POINTER(c_double),),
    "dmb_fatigue_options_init": (c_int32, POINTER(FatigueOptions), c_uint32,),
    "dmb_fatigue_restore": (c_int32, c_void_p, c_void_p, c_size_t,),
    "dmb_fatigue_result_init": (c_int32, POINTER(FatigueResult), c_uint32,),
    "dmb_fatigue_snapshot": (c_int32, c_void_p, c_void_p, c_size_t,),
    "dmb_fatigue_snapshot_size": (c_int32, c_void_p, POINTER(c_size_t),),
    "dmb_fatigue_take": (c_int32, c_void_p, c_void_p,),
    "dmb_flow_state_init": (c_int32, POINTER(FlowState), c_uint32,),
    "dmb_force_def_init": (c_int32, POINTER(ForceDef), c_uint32,),
    "dmb_has": (c_int32, c_int32,),
    "dmb_hole_point_init": (c_int32, POINTER(HolePoint), c_uint32,),
    "dmb_hole_section_init": (c_int32, POINTER(HoleSection), c_uint32,),
    "dmb_hydraulics_init": (c_int32, POINTER(Hydraulics), c_uint32,),
    "dmb_input_def_init": (c_int32, POINTER(InputDef), c_uint32,),
    "dmb_input_info_init": (c_int32, POINTER(InputInfo), c_uint32,),
    "dmb_input_state_init": (c_int32, POINTER(InputState), c_uint32,),
    "dmb_joint_def_init": (c_int32, POINTER(JointDef), c_uint32,),
    "dmb_joint_state_init": (c_int32, POINTER(JointState), c_uint32,),
    "dmb_last_error": (c_int32, POINTER(ErrorStruct),),
    "dmb_load_def_init": (c_int32, POINTER(LoadDef), c_uint32,),
    "dmb_mode_init": (c_int32, POINTER(Mode), c_uint32,),
    "dmb_mode_shape_init": (c_int32, POINTER(ModeShape), c_uint32,),
    "dmb_model_add_bit": (c_int32, c_void_p, POINTER(BitDef), POINTER(Id),),
    "dmb_model_add_body": (c_int32, c_void_p, POINTER(BodyDef), POINTER(Id),),
    "dmb_model_add_constraint": (c_int32, c_void_p, POINTER(ConstraintDef), POINTER(Id),),
    "dmb_model_add_coupling": (c_int32, c_void_p, POINTER(CouplingDef), POINTER(Id),),
    "dmb_model_add_drive": (c_int32, c_void_p, POINTER(DriveDef), POINTER(Id),),
    "dmb_model_add_event": (c_int32, c_void_p, POINTER(EventDef), POINTER(Id),),
    "dmb_model_add_force": (c_int32, c_void_p, POINTER(ForceDef), POINTER(Id),),
    "dmb_model_add_hole_sections": (c_int32, c_void_p, POINTER(HoleSection), c_uint32,),
    "dmb_model_add_input": (c_int32, c_void_p, POINTER(InputDef), POINTER(Id),),
    "dmb_model_add_joint": (c_int32, c_void_p, POINTER(JointDef), POINTER(Id),),
    "dmb_model_add_load": (c_int32, c_void_p, POINTER(LoadDef), POINTER(Id),),
    "dmb_model_add_pipes": (c_int32, c_void_p, POINTER(PipeDef), c_uint32, POINTER(Id),),
    "dmb_model_add_ramp": (c_int32, c_void_p, c_double, c_double, c_double, c_double, POINTER(Id),),
    "dmb_model_add_spring": (c_int32, c_void_p, POINTER(SpringDef), POINTER(Id),),
    "dmb_model_add_stabiliser": (c_int32, c_void_p, POINTER(StabiliserDef), POINTER(Id),),
    "dmb_model_add_string": (c_int32, c_void_p, POINTER(StringDef), POINTER(Id),),
    "dmb_model_add_stuck": (c_int32, c_void_p, POINTER(StuckDef), POINTER(Id),),
    "dmb_model_add_sub": (c_int32, c_void_p, POINTER(SubDef), POINTER(Sub),),
    "dmb_model_add_time_function": (c_int32, c_void_p, POINTER(Segment), c_uint32, POINTER(Id),),
    "dmb_model_add_wall": (c_int32, c_void_p, POINTER(WallDef), POINTER(Id),),
    "dmb_model_clear_refused": (c_int32, c_void_p,),
    "dmb_model_compile": (c_int32, c_void_p, POINTER(CompileOptions),),
    "dmb_model_create": (c_int32, POINTER(ModelOptions), POINTER(c_void_p),),
    "dmb_model_destroy": (None, POINTER(c_void_p),),
    "dmb_model_event_count": (c_uint32, c_void_p,),
    "dmb_model_find": (c_int32, c_void_p, c_int32, c_char_p, POINTER(Id),),
    "dmb_model_find_event": (c_int32, c_void_p, c_char_p, POINTER(Id),),
    "dmb_model_find_input": (c_int32, c_void_p, c_char_p, POINTER(Id),),
    "dmb_model_find_pipes": (c_int32, c_void_p, c_char_p, POINTER(Id), POINTER(c_uint32), POINTER(c_uint32),),
    "dmb_model_get_event": (c_int32, c_void_p, c_uint32, POINTER(EventDef),),
    "dmb_model_get_info": (c_int32, c_void_p, POINTER(ModelInfo),),
    "dmb_model_get_input": (c_int32, c_void_p, c_uint32, POINTER(InputInfo),),
    "dmb_model_get_name": (c_int32, c_void_p, Id, c_char_p, c_uint32,),
    "dmb_model_info_init": (c_int32, POINTER(ModelInfo), c_uint32,),
    "dmb_model_input_count": (c_uint32, c_void_p,),
    "dmb_model_message": (c_char_p, c_void_p,),
    "dmb_model_options_init": (c_int32, POINTER(ModelOptions), c_uint32,),
    "dmb_model_part": (c_int32, c_void_p, c_uint32, POINTER(Id),),
    "dmb_model_place_at_end": (c_int32, c_void_p, Id, c_double, POINTER(BodyDef), POINTER(StringDef),),
    "dmb_model_read": (c_int32, c_void_p, c_size_t, POINTER(ModelOptions), POINTER(c_void_p),),
    "dmb_model_set_environment": (c_int32, c_void_p, POINTER(EnvironmentDef),),
    "dmb_model_set_name": (c_int32, c_void_p, Id, c_char_p,),
    "dmb_model_write": (c_int32, c_void_p, c_void_p, c_size_t, POINTER(c_size_t),),
    "dmb_modes_destroy": (None, POINTER(c_void_p),),
    "dmb_modes_get": (c_int32, c_void_p, c_uint32, POINTER(Mode),),
    "dmb_modes_get_info": (c_int32, c_void_p, POINTER(ModesInfo),),
    "dmb_modes_info_init": (c_int32, POINTER(ModesInfo), c_uint32,),
    "dmb_modes_options_init": (c_int32, POINTER(ModesOptions), c_uint32,),
    "dmb_modes_part": (c_int32, c_void_p, c_uint32, Id, c_uint32, POINTER(c_double), POINTER(c_double),),
    "dmb_modes_shape": (c_int32, c_void_p, c_uint32, Place, POINTER(ModeShape),),
    "dmb_momentum_init": (c_int32, POINTER(Momentum), c_uint32,),
    "dmb_motion_init": (c_int32, POINTER(Motion), c_uint32,),
    "dmb_motor_drive": (c_int32, POINTER(Motor), POINTER(DriveDef), POINTER(c_double),),
    "dmb_motor_init": (c_int32, POINTER(Motor), c_uint32,),
    "dmb_operation_init": (c_int32, POINTER(Operation), c_uint32,),
    "dmb_operation_name": (c_char_p, c_int32,),
    "dmb_operation_usual": (c_int32, c_int32, POINTER(Operation),),
    "dmb_order_init": (c_int32, POINTER(Order), c_uint32,),
    "dmb_output_check": (c_int32, c_void_p, POINTER(Output), c_uint32,),
    "dmb_output_name": (c_char_p, c_int32, POINTER(c_char_p),),
    "dmb_output_next": (c_int32, c_int32,),
    "dmb_output_quantity": (c_int32, c_char_p, POINTER(c_int32),),
    "dmb_output_text": (c_int32, c_void_p, POINTER(Output), c_char_p, c_uint32,),
    "dmb_parameter_init": (c_int32, POINTER(Parameter), c_uint32,),
    "dmb_path_options_init": (c_int32, POINTER(PathOptions), c_uint32,),
    "dmb_path_point_init": (c_int32, POINTER(PathPoint), c_uint32,),
    "dmb_path_report_init": (c_int32, POINTER(PathReport), c_uint32,),
    "dmb_pipe_def_init": (c_int32, POINTER(PipeDef), c_uint32,),
    "dmb_pool_allocator": (c_int32, c_void_p, c_size_t, POINTER(Allocator),),
    "dmb_pool_peak": (c_size_t, POINTER(Allocator),),
    "dmb_pose_init": (c_int32, POINTER(Pose), c_uint32,),
    "dmb_profile_init": (c_int32, POINTER(ProfileStruct), c_uint32,),
    "dmb_profile_name": (c_char_p, c_int32, POINTER(c_char_p),),
    "dmb_profile_recorder_init": (c_int32, POINTER(ProfileRecorderStruct), c_uint32,),
    "dmb_profile_recorder_take": (c_int32, POINTER(ProfileRecorderStruct), c_void_p,),
    "dmb_profile_recorder_write_csv": (c_int32, POINTER(ProfileRecorderStruct), c_char_p,),
    "dmb_query_bit": (c_int32, c_void_p, Id, POINTER(BitState),),
    "dmb_query_constraint_rows": (c_int32, c_void_p, Id, POINTER(c_uint32), POINTER(c_uint32),),
    "dmb_query_contact": (c_int32, c_void_p, c_uint32, POINTER(Contact),),
    "dmb_query_contact_total": (c_int32, c_void_p, POINTER(ContactTotal),),
    "dmb_query_drive": (c_int32, c_void_p, Id, POINTER(DriveState),),
    "dmb_query_energy": (c_int32, c_void_p, POINTER(Energy),),
    "dmb_query_flow": (c_int32, c_void_p, POINTER(FlowState),),
    "dmb_query_hole": (c_int32, c_void_p, c_double, POINTER(HolePoint),),
    "dmb_query_hole_now": (c_int32, c_void_p, c_double, POINTER(HolePoint),),
    "dmb_query_joint": (c_int32, c_void_p, Id, POINTER(JointState),),
    "dmb_query_kinetic_energy": (c_int32, c_void_p, Id, c_uint32, POINTER(c_double),),
    "dmb_query_momentum": (c_int32, c_void_p, POINTER(Momentum),),
    "dmb_query_motion": (c_int32, c_void_p, Place, POINTER(Motion),),
    "dmb_query_motion_at": (c_int32, c_void_p, Place, POINTER(c_double), POINTER(Motion),),
    "dmb_query_multipliers": (c_int32, c_void_p, Id, POINTER(c_double), POINTER(c_uint32),),
    "dmb_query_output": (c_int32, c_void_p, POINTER(Output), POINTER(c_double),),
    "dmb_query_pose": (c_int32, c_void_p, Place, POINTER(Pose),),
    "dmb_query_pose_at": (c_int32, c_void_p, Place, POINTER(c_double), POINTER(Pose),),
    "dmb_query_profile": (c_int32, c_void_p, POINTER(ProfileStruct),),
    "dmb_query_profile_extremes": (c_int32, c_void_p, POINTER(ProfileStruct), POINTER(c_double),),
    "dmb_query_reaction": (c_int32, c_void_p, Id, POINTER(c_double),),
    "dmb_query_rotation": (c_int32, c_void_p, Place, POINTER(c_double),),
    "dmb_query_row": (c_int32, c_void_p, c_uint32, POINTER(Row),),
    "dmb_query_section": (c_int32, c_void_p, Place, POINTER(Section),),
    "dmb_query_spring": (c_int32, c_void_p, Id, POINTER(SpringState),),
    "dmb_query_statistics": (c_int32, c_void_p, POINTER(Statistics),),
    "dmb_query_stuck": (c_int32, c_void_p, Id, POINTER(StuckState),),
    "dmb_recorder_init": (c_int32, POINTER(RecorderStruct), c_uint32,),
    "dmb_recorder_take": (c_int32, POINTER(RecorderStruct), c_void_p,),
    "dmb_recorder_write_csv": (c_int32, POINTER(RecorderStruct), c_void_p, c_char_p,),
    "dmb_response_destroy": (None, POINTER(c_void_p),),
    "dmb_response_dimensions": (c_int32, c_void_p, POINTER(c_uint32),),
    "dmb_response_frequencies": (c_int32, c_void_p, POINTER(c_double),),
    "dmb_response_options_init": (c_int32, POINTER(ResponseOptions), c_uint32,),
    "dmb_response_transfer": (c_int32, c_void_p, c_uint32, c_uint32, POINTER(c_double),),
    "dmb_response_write_csv": (c_int32, c_void_p, c_void_p, c_char_p,),
    "dmb_row_init": (c_int32, POINTER(Row), c_uint32,),
    "dmb_section_init": (c_int32, POINTER(Section), c_uint32,),
    "dmb_segment_init": (c_int32, POINTER(Segment), c_uint32,),
    "dmb_sensitivity_advance": (c_int32, c_void_p, c_double, POINTER(StepReport),),
    "dmb_sensitivity_create": (c_int32, c_void_p, POINTER(Parameter), c_uint32, POINTER(c_void_p),),
    "dmb_sensitivity_destroy": (None, POINTER(c_void_p),),
    "dmb_sensitivity_kinks": (c_int32, c_void_p, c_uint32, POINTER(c_uint64),),
    "dmb_sensitivity_outputs": (c_int32, c_void_p, POINTER(Output), c_uint32, POINTER(c_double), POINTER(c_double),),
    "dmb_sensitivity_rows": (c_int32, c_void_p, c_uint32, POINTER(c_double), POINTER(c_double), POINTER(c_uint32),),
    "dmb_sensitivity_step": (c_int32, c_void_p, c_double, POINTER(StepReport),),
    "dmb_sim_advance": (c_int32, c_void_p, c_double, POINTER(StepReport),),
    "dmb_sim_advance_to_event": (c_int32, c_void_p, c_double, POINTER(EventReport), POINTER(StepReport),),
    "dmb_sim_create": (c_int32, c_void_p, POINTER(SimOptions), POINTER(c_void_p),),
    "dmb_sim_create_in": (c_int32, c_void_p, POINTER(SimOptions), c_void_p, c_size_t, POINTER(c_void_p),),
    "dmb_sim_destroy": (None, POINTER(c_void_p),),
    "dmb_sim_get_input": (c_int32, c_void_p, Id, POINTER(InputState),),
    "dmb_sim_hash": (c_int32, c_void_p, POINTER(c_uint64),),
    "dmb_sim_memory_size": (c_int32, c_void_p, POINTER(SimOptions), POINTER(c_size_t),),
    "dmb_sim_message": (c_char_p, c_void_p,),
    "dmb_sim_options_init": (c_int32, POINTER(SimOptions), c_uint32,),
    "dmb_sim_record_inputs": (c_int32, c_void_p, POINTER(InputRecord), c_uint32,),
    "dmb_sim_recorded_inputs": (c_uint32, c_void_p,),
    "dmb_sim_replay_inputs": (c_int32, c_void_p, POINTER(InputRecord), c_uint32, POINTER(c_uint32),),
    "dmb_sim_restore": (c_int32, c_void_p, c_void_p, c_size_t,),
    "dmb_sim_set_drive": (c_int32, c_void_p, Id, c_double,),
    "dmb_sim_set_input": (c_int32, c_void_p, Id, c_double,),
    "dmb_sim_set_inputs": (c_int32, c_void_p, POINTER(Id), POINTER(c_double), c_uint32,),
    "dmb_sim_set_joint": (c_int32, c_void_p, Id, c_int32,),
    "dmb_sim_set_on_step": (c_int32, c_void_p, STEP_FN, c_void_p,),
    "dmb_sim_set_progress": (c_int32, c_void_p, PROGRESS_FN, c_void_p,),
    "dmb_sim_snapshot": (c_int32, c_void_p, c_void_p, c_size_t,),
    "dmb_sim_snapshot_size": (c_int32, c_void_p, POINTER(c_size_t),),
    "dmb_sim_step": (c_int32, c_void_p, c_double, POINTER(StepReport),),
    "dmb_sim_steps": (c_int32, c_void_p, c_double, c_uint32, POINTER(c_uint32), POINTER(StepReport),),
    "dmb_sim_steps_to_event": (c_int32, c_void_p, c_double, c_uint32, POINTER(c_uint32), POINTER(EventReport), POINTER(StepReport),),
    "dmb_sim_time": (c_double, c_void_p,),
    "dmb_sim_transfer_state": (c_int32, c_void_p, c_void_p,),
    "dmb_sim_value": (c_double, c_void_p, c_int32, Place,),
    "dmb_speed_band_init": (c_int32, POINTER(SpeedBand), c_uint32,),
    "dmb_speeds_options_init": (c_int32, POINTER(SpeedsOptions), c_uint32,),
    "dmb_speeds_report_init": (c_int32, POINTER(SpeedsReport), c_uint32,),
    "dmb_spring_def_init": (c_int32, POINTER(SpringDef), c_uint32,),
    "dmb_spring_state_init": (c_int32, POINTER(SpringState), c_uint32,),
    "dmb_stabiliser_def_init": (c_int32, POINTER(StabiliserDef), c_uint32,),
    "dmb_state_equation_begin": (c_int32, c_void_p, c_double, POINTER(c_double),),
    "dmb_state_equation_count": (c_uint32, c_void_p,),
    "dmb_state_equation_create": (c_int32, c_void_p, POINTER(c_void_p),),
    "dmb_state_equation_destroy": (None, POINTER(c_void_p),),
    "dmb_state_equation_origin": (c_int32, c_void_p, POINTER(c_double), POINTER(c_double),),
    "dmb_state_equation_rate": (c_int32, c_void_p, c_double, POINTER(c_double), POINTER(c_double),),
    "dmb_state_equation_rows": (c_int32, c_void_p, POINTER(c_uint32),),
    "dmb_state_equation_sim": (c_void_p, c_void_p,),
    "dmb_state_space_dense": (c_int32, c_void_p, c_int32, POINTER(c_double),),
    "dmb_state_space_destroy": (None, POINTER(c_void_p),),
    "dmb_state_space_get_info": (c_int32, c_void_p, POINTER(StateSpaceInfo),),
    "dmb_state_space_info_init": (c_int32, POINTER(StateSpaceInfo), c_uint32,),
    "dmb_state_space_options_init": (c_int32, POINTER(StateSpaceOptions), c_uint32,),
    "dmb_state_space_shapes": (c_int32, c_void_p, POINTER(c_double),),
    "dmb_state_space_sparse": (c_int32, c_void_p, c_int32, POINTER(c_uint32), POINTER(c_uint32), POINTER(c_double), POINTER(c_uint64),),
    "dmb_static_options_init": (c_int32, POINTER(StaticOptions), c_uint32,),
    "dmb_static_report_init": (c_int32, POINTER(StaticReport), c_uint32,),
    "dmb_statistics_init": (c_int32, POINTER(Statistics), c_uint32,),
    "dmb_status_name": (c_char_p, c_int32,),
    "dmb_status_text": (c_char_p, c_int32,),
    "dmb_step_report_init": (c_int32, POINTER(StepReport), c_uint32,),
    "dmb_stepped_sine_options_init": (c_int32, POINTER(SteppedSineOptions), c_uint32,),
    "dmb_stepped_sine_report_init": (c_int32, POINTER(SteppedSineReport), c_uint32,),
    "dmb_string_def_init": (c_int32, POINTER(StringDef), c_uint32,),
    "dmb_stuck_def_init": (c_int32, POINTER(StuckDef), c_uint32,),
    "dmb_stuck_state_init": (c_int32, POINTER(StuckState), c_uint32,),
    "dmb_sub_def_init": (c_int32, POINTER(SubDef), c_uint32,),
    "dmb_sub_init": (c_int32, POINTER(Sub), c_uint32,),
    "dmb_torque_drag_options_init": (c_int32, POINTER(TorqueDragOptions), c_uint32,),
    "dmb_torque_drag_row_init": (c_int32, POINTER(TorqueDragRow), c_uint32,),
    "dmb_version": (c_uint32,),
    "dmb_wall_def_init": (c_int32, POINTER(WallDef), c_uint32,),
    "dmb_window_create": (c_int32, c_void_p, POINTER(WindowOptions), POINTER(Output), c_uint32, POINTER(c_void_p),),
    "dmb_window_destroy": (None, POINTER(c_void_p),),
    "dmb_window_get": (c_int32, c_void_p, c_uint32, POINTER(WindowResult),),
    "dmb_window_options_init": (c_int32, POINTER(WindowOptions), c_uint32,),
    "dmb_window_reset": (c_int32, c_void_p,),
    "dmb_window_result_init": (c_int32, POINTER(WindowResult), c_uint32,),
    "dmb_window_take": (c_int32, c_void_p, c_void_p,),
    "dmb_write_vtk_hole": (c_int32, c_void_p, c_double, c_double, c_double, c_uint32, c_char_p,),
    "dmb_write_vtk_mode": (c_int32, c_void_p, c_uint32, c_double, c_double, c_uint32, c_char_p,),
    "dmb_write_vtk_strings": (c_int32, c_void_p, c_uint32, c_char_p,),
}

FUNCTION_DOCS = {
    "dmb_analysis_array":
        "values NULL: *count is the length of the array. Else *count on entry is the capacity (too little is ERR_VALUE) and on return the number written.",
    "dmb_analysis_buckling":
        "Buckling from the present static state on (dmb_analysis_static first): the lowest factors > 0 at which K + factor dK is singular, K the tangent stiffness with its contacts as they are, dK its change along the response of the state to the pattern of loads (eq:buckling.pencil); with joints both are those of the independent coordinates. A linearisation is an extrapolation, good where sections turn and contacts shift little, so the equilibria are followed to the factor, linearised again, and so on, until an eigenvalue of their stiffness passes 0 or has a deep minimum (BUCKLING_DIP: one factor), and again in steps of half the length, up to two times, until two runs agree (lib/theory/statics.md). Notes, the first that applies: NOTE_FLUTTER: a damped mode grows before the lowest factor, or, without such a factor, up to a factor_max below 1e12 or to where the equilibria could be followed; NOTE_INCOMPLETE: that could not be assessed though K is unsymmetric; NOTE_EXTRAPOLATED: some of the factors are not confirmed; NOTE_STOPPED: fewer than `count` lie below factor_max or can be found (beyond a limit point none can; without a factor the message says how far the equilibria stay stable). Errors: ERR_ORDER (the state is no equilibrium or not stable; message says by how much), _SINGULAR (message says which part is free), _NO_CONVERGENCE (the equilibria could not be followed; message says how far), _UNSUPPORTED (a motion drive of a joint; a state that slides or turns by its drives: take STEADY_AT_REST, and the slip here, for it). Some 40 counts a factor and 10 to 100 iterations of the path, each O(elements); memory: the sim's twice more and 3 matrices.",
    "dmb_analysis_check":
        "Counts the last accepted state of a sim. The rank is LAPACK's, by QR with column pivoting; it is held against that of the partition the sim steps with (a warning if they differ). Calls the callbacks of constraints. Cost: elements, and the cube of the coordinates of each cluster. Errors: ERR_CALLBACK, _SINGULAR.",
    "dmb_analysis_check_text":
        "The same (errors too) as a sheet of text, lines ending with '/n', '.' as decimal mark: counts, solvers, redundant equations by name (directions are those of frame a of the joint), warnings. Writes at most `size` bytes, always 0-terminated; *needed (may be NULL) is the size of the whole text, its 0 included. text may be NULL where size is 0. NOTE_FULL: it is cut.",
    "dmb_analysis_friction_factor":
        "The friction coefficient, 0 .. 10 (or factor, friction_by_depth), that explains a hook load [N] or torque [N m] measured at the rig in one operation at the first of the depths. Errors as dmb_analysis_torque_drag; ERR_VALUE where none does: the message states the range. About 60 times the work of a row.",
    "dmb_analysis_hydraulics":
        "Pressures of mud with the string's far end at a measured depth [m], beyond its start_depth by at most its length, in steady flow without gel strength (Burkhardt 1961); trip speed 0 .. 10 m/s. ERR_UNSUPPORTED: no flow_rate. O(length / 2 m).",
    "dmb_analysis_mesh":
        "Estimated discretisation error of each pipe of a string that lies on the wall of its hole, for the choice of dmb_pipe_def.elements (eq:beam.mesh-error): bending stress of an element between two contact points, by the weight of all below it, over the yield strength (yield_strength, else a strain of 0.003). It falls with the square of the length of the elements. error [-], shape (capacity): by pipe from the rig end; 0 for rigid and axial-torsional pipes and without a wall that is met; dmb_analysis_check warns above 0.01. capacity >= its pipes. Of a compiled model; any number of threads. O(elements).",
    "dmb_analysis_modes":
        "Modes about the accepted state of a sim, which should be an equilibrium, at rest or spinning steadily; the sim need not outlive the result. LOWEST: smallest |s|. Few modes cost O(elements), ALL and many the cube of the coordinates (LAPACK), a BAND, in which every mode is found, in proportion to its modes; of damped ones whose roots do not lie along the imaginary axis at most 256 below band[1] (eq:modes.count, eq:modes.strip). NOTE_INCOMPLETE: of the LOWEST those before the first that does not converge (lib/theory/modes.md). Errors: ERR_VALUE (option; more modes than coordinates; a band without modes; a state out of balance: by how much and where), _NO_CONVERGENCE (a mode that does not satisfy its equations to rounding, or cannot be distinguished from a rigid-body motion: residual and bound), _UNSUPPORTED (coefficients that are not constant in `axes` while the state moves on: eq:modes.turned), _TOO_LARGE, _SINGULAR.",
    "dmb_analysis_path":
        "Follows the path from the present static state on by arc length (eq:buckling.arc). Limit points, bifurcations and the ends are located to 1e-8 of the step. Where K is unsymmetric, a step is a twentieth of factor_end at most: an eigenvalue that leaves and one that comes back closer together may be passed by. Two that a complex pair becomes change `negative` and are no bifurcation. The report of a lost path states its end. NOTE_STOPPED after max_points or by the callback, _INCOMPLETE where `negative` is -1: two that pass 0 there may be missing. Errors: ERR_ORDER (the state is no equilibrium), _SINGULAR (message says which part is free, or that the factor moves nothing), _NO_CONVERGENCE (message says where), _ROTATION (2.5 rad in an element; message says where), _UNSUPPORTED (as of buckling). O(elements) an iteration; memory: the sim's once more.",
    "dmb_analysis_place_rows":
        "A small motion of a place as a linear function of those of rows: component X .. RZ in the axes of `frame` (FRAME_WORLD, FRAME_BODY) is sum of values[i] d[rows[i]]; *count <= 24. Forces act by the same numbers.",
    "dmb_analysis_response":
        "Transfer functions from every excitation to every output about the accepted state of a sim, which must be an equilibrium, at rest or spinning steadily (eq:response.direct). Outputs are small changes about it, of every OUTPUT_... that is linear in the motion; OUTPUT_VIBRATION .. are motions of a place in the axes of the analysis. Of a state that spins, frames of `place` are its section's, and turn with it unless `axes` are at rest: then those that it has in the state, and section forces are given in axes that do not spin. Structural damping there is that of parts that do not turn. excitations, outputs: shapes (excitation_count), (output_count), 1 .. 1024 each, every excitation of the size that the first says. NOTE_INCOMPLETE: coefficients that change while parts turn, as of modes; results hold along and about the axes of straight parts, not across. Errors: ERR_VALUE (option, component, band; a state out of balance: by how much and where), _SINGULAR (frequency and part that nothing holds there; a motion drive at frequency 0), _UNSUPPORTED (axes at rest with a load across a part that turns with it; an output that is a magnitude, sum over the string, count, energy or work: the message names it). Cost: O(points (elements + joints + excitations)); of joints that share bodies the cube of their coordinates. The sim need not outlive the response; responses of one sim may not be computed at the same time.",
    "dmb_analysis_speeds":
        "Bands of rotary speed to avoid about the accepted state of a sim, by their severity: the sum over the orders of the largest amplitude of an output over its limit (eq:response.severity), by the linear response in axes at rest about the rotating state; 1 is the limit even where all orders add up. limits: [unit of the output] > 0, shape (output_count). bands: *band_count on entry is the capacity, the struct_size of the first holds for all; on return the number of bands, by rising speed, NOTE_FULL where more were found. severity, shape (points), may be NULL: largest within half a step of the grid around each speed. NOTE_INCOMPLETE (dmb_sim_message and the report give the reason): an order excites nothing, nothing damps, a band is truncated at an end of the range, or as of dmb_analysis_response. Call it for a sim of each depth or state. Errors as dmb_analysis_response. Cost: that of order_count responses.",
    "dmb_analysis_state_space":
        "About the accepted state of a sim, which must be an equilibrium, at rest or spinning steadily (any state for STATE_MATRICES). excitations, outputs: as of dmb_analysis_response, 0 .. 1024 each; excitations that go with the square of the frequency (unbalance, eccentricity) are refused. The sim need not outlive the result, nor need the modes. Notes and errors as dmb_analysis_response; ERR_TOO_LARGE above 4096 states (reduce), _SINGULAR for a mass or a stiffness that is singular (shift). O(coordinates^2) of FULL, O(shapes x elements) of REDUCED, O(elements) of MATRICES.",
    "dmb_analysis_static":
        "Static start: puts the sim at rest in the equilibrium of its loads, gravity, wall and drives at its present time, or, where motion drives move, in a steady motion (`steady`). lib/theory/statics.md has the strategies, from Newton to relaxation, and the forces that act in each state. At rest the rock law does not act and a speed controller acts as at speed 0. The energy ledger restarts. A string whose rotation about its axis nothing resists keeps it (free_spins) where the torques about the axis sum to 0. NOTE_UNSTABLE: the equilibrium at rest is one that the string would leave (negative > 0); NOTE_INCOMPLETE: its stability is not resolved (negative < 0; message states the bound), or a string slid along its hole by over a tenth of its length; NOTE_NOT_STEADY. Errors: ERR_SINGULAR (message says which part is free), _NO_CONVERGENCE, _ROTATION, _UNSUPPORTED (SLIDING with an eccentric mass, pre-bent pipe or load across that turns with its part, RIGID with gravity, loads, supports, joints or a hole off the axis); the state is then that before the call. O(elements) an iteration.",
    "dmb_analysis_stepped_sine":
        "Runs the sim on in fixed steps until the Fourier amplitudes of successive windows agree (eq:response.sine). amplitudes, shape (output_count, 1 + harmonics, 2): mean and 0, then for k = 1, 2, ... the k-th harmonic: its part of the output is the real part of (re + i im) e^(2 pi i k frequency t), t the sim's time. OUTPUT_VIBRATION .. are those of the linear response about the state at the call, with axes at rest if it spins, less the drift over the window; other outputs as those of queries. NOTE_STOPPED: not settled in `windows`; the amplitudes are those of the last. Errors: ERR_UNSUPPORTED with nothing changed; those of dmb_sim_step, after which the sim is in its last accepted state. Cost: steps.",
    "dmb_analysis_torque_drag":
        "One row for each depth and operation, shape (depth_count, operation_count), the struct_size of the first holds for all. The string hangs together with its described pipes counted from the far end: at a depth less than where it is described the first pipes are not there yet. Bodies and bits at the far end weigh as described. Ends and places beyond the survey lie on the straight continuation. Mud that flows pulls and thrusts by the diameters at each depth; pressures are left out of yield_share. Of the sim only the model is used. Errors: ERR_UNSUPPORTED without a hole, for a string that does not follow it, has stabilisers, or below its rig end a joint that holds something (not JOINT_FREE), a load, spring or force, or a place described stuck. O(depths x operations x (pipes' runs + stations + length / 2 m)).",
    "dmb_analysis_torque_drag_profile":
        "Along the string in one operation at the first of the depths: at station_count (2 .. 2^20) places spread evenly from the rig end to the far end. Arrays of shape (station_count), each may be NULL: measured depth [m], effective axial force [N], torque [N m], wall force per metre [N/m]. Errors as dmb_analysis_torque_drag; ERR_NO_CONVERGENCE where the string locks up.",
    "dmb_buckling_factor":
        "[unit of the factor] The critical factor number `mode`, rising from 0 on.",
    "dmb_buckling_shape":
        "[m, rad] displacement and rotation of a section in the buckling shape, world frame, the largest displacement of a node being 1 m in its own axes; shape (6).",
    "dmb_build_info":
        "One line: version, and where eigenproblems, files and memory come from. Never NULL.",
    "dmb_fatigue_create":
        "Places on flexible or axial-torsional pipes, place_count 1 .. 65536; memory from the model's allocator, about 24 bytes a class and point. Errors: ERR_UNSUPPORTED (rigid pipes; axial-torsional ones in a hole that bends), _TOO_LARGE.",
    "dmb_fatigue_histogram":
        "Cycles by range at the point that the result names: cycles[i] of a range of i 2 stress_range/classes [Pa], shape (classes).",
    "dmb_fatigue_snapshot_size":
        "The counts so far as bytes in the caller's memory, with which another dmb_fatigue of the same options and places continues bit for bit, in another process too. Allocate nothing. Errors: ERR_VALUE (another size; bytes that are no counts of these options). O(places x points x classes).",
    "dmb_fatigue_take":
        "Takes a sample; call it after each step, 20 times a revolution or more: stress peaks between samples are not counted. Another sim of the same model may be given. ERR_ORDER before the time of the last sample, as after a restore: restore the fatigue too. Allocates nothing. O(places x points).",
    "dmb_has":
        "1: yes, 0: no; a library that is loaded when needed is loaded by this call. ERR_VALUE: none of the above. Thread-safe.",
    "dmb_last_error":
        "The last failing call of this thread. Errors: ERR_NULL, ERR_STRUCT_SIZE.",
    "dmb_model_add_force":
        "Errors as of a spring. It does not act on an open joint. Steady states refuse it on moving parts.",
    "dmb_model_add_hole_sections":
        "Adds sections below those that the model has, sections with the same struct_size, 1 .. 2^18 of them in all; the wall may be added before or after. dmb_model_compile refuses overlapping transitions, a line without an end, radii that change too fast, and parts wider than the hole (ERR_GEOMETRY). dmb_query_hole costs O(log sections) then.",
    "dmb_model_add_input":
        "ERR_VALUE too for a target that has an input already; ERR_UNSUPPORTED: the part has no such target.",
    "dmb_model_add_joint":
        "ERR_VALUE for a part joined to itself, an axis of zero length, two grounds.",
    "dmb_model_add_pipes":
        "Appends count (1 .. 2^20) equal pipes at the far end of a string; *string (may be NULL) names the string. Pipes are numbered along the whole string, 0 at the rig end.",
    "dmb_model_add_ramp":
        "Adds a time function that is `from` up to `start` [s], `to` from `end` > start on, smooth between: SEGMENT_STEP5.",
    "dmb_model_add_spring":
        "dmb_model_compile refuses with ERR_VALUE (no such pipe, points that move as one), _GEOMETRY (points that coincide at time 0 with a force between them), _UNSUPPORTED (axial-torsional pipes in a curved hole). Within one body or element and the ground it costs no coupling of parts; else it connects parts as a joint does.",
    "dmb_model_add_stabiliser":
        "Pipes may be added before or after. dmb_model_compile refuses pipes that are not there (ERR_VALUE), stabilisers that overlap, are thinner than their pipe or too wide for the hole (ERR_GEOMETRY).",
    "dmb_model_add_string":
        "Adds a string without pipes. The first dmb_model_add_pipes without a string makes one by default.",
    "dmb_model_add_stuck":
        "dmb_model_compile refuses with ERR_VALUE (no such pipe), _UNSUPPORTED (axial-torsional).",
    "dmb_model_add_sub":
        "Adds all parts or none. The string then ends there: dmb_model_add_pipes and _add_bit to it are ERR_ORDER, and so is dmb_model_add_wall after a sub of a string that would follow the hole. Errors: ERR_ORDER (no pipes yet, a bit at the end, continued already), _GEOMETRY (survey).",
    "dmb_model_add_time_function":
        "Adds a time function of segment_count segments (1 .. 64), each with the same struct_size.",
    "dmb_model_add_wall":
        "Adds the hole. One hole a model; wall may be NULL.",
    "dmb_model_clear_refused":
        "dmb_model_compile fails with the first refusal of a part, unless a later part of its kind was added with the same name, or, without names, with at most one other field; a wall or environment clears all refusals of its kind before it. This clears all refusals, as the wrappers of C++ and Python do where they throw: an exception is never overlooked.",
    "dmb_model_compile":
        "Checks the scene as a whole, meshes and numbers it, chooses kernels, and freezes the model: no more parts can be added, any number of threads may make sims of it. options may be NULL. A failed compile leaves the model as it was. Warns (log, dmb_model_message, dmb_analysis_check) of contact rings of bodies and bits that a support keeps off the wall. Errors: that of a part that was refused (dmb_model_clear_refused); ERR_ID (the first string is meant and there is none), _VALUE, _GEOMETRY, _UNSUPPORTED, _TOO_LARGE, _NO_MEMORY. O(elements).",
    "dmb_model_create":
        "Creates an empty model. options may be NULL. Errors: ERR_NO_MEMORY; *model is NULL then.",
    "dmb_model_destroy":
        "Releases the caller's reference and sets *model to NULL; sims made from the model keep it alive. There is one reference: while they do, copies of the handle are refused (ERR_HANDLE) and destroying them does nothing. Within a call that describes or compiles the model (from its allocator or log) it does nothing either, and other calls give ERR_ORDER. NULL-safe.",
    "dmb_model_find":
        "The part of that name, of a kind or (PART_ANY) of all. Errors, which leave *part as it was: ERR_ID: there is none; _VALUE: parts of several kinds have it, give the kind.",
    "dmb_model_find_pipes":
        "The pipes that one call of dmb_model_add_pipes added under that name (`name` of dmb_pipe_def): *count pipes of *string from *first on. Each may be NULL. ERR_ID: none.",
    "dmb_model_get_event":
        "as of inputs; get: as described",
    "dmb_model_get_info":
        "Counts of a compiled model. Errors: ERR_ORDER before compile.",
    "dmb_model_get_name":
        "The name of a part into the caller's text, size [byte] >= NAME_SIZE; \"\" if it has none. ERR_ID, _VALUE.",
    "dmb_model_input_count":
        "[-] inputs described so far, 0 for an invalid handle; the input at `index` in that order, or of a name (ERR_ID: none).",
    "dmb_model_message":
        "Message of the last failing or noteworthy call on this model. Never NULL; lives until the next call on the model. Of a compiled model, and of questions, each thread reads the failure of its own calls.",
    "dmb_model_part":
        "The part whose id has that index (of dmb_id), as another model of the same description has it. ERR_ID: none.",
    "dmb_model_place_at_end":
        "Fills poses and velocities of a body, and of a section follows_hole, start_depth, offset and start_free too, as dmb_model_add_sub has them, `length` beyond the end of the string as it is described so far; for parts that other joints hold there. Either may be NULL. Errors as dmb_model_add_sub.",
    "dmb_model_read":
        "Makes the model of a record, open for changes before dmb_model_compile. Its scene is the same to the bit, its ids have the same indices. Errors: ERR_NULL, _VALUE (damaged: length, checksum or content), _UNSUPPORTED (of a newer version), _TOO_LARGE, _NO_MEMORY, those of the calls that add parts; *model is NULL then, dmb_last_error has the reason.",
    "dmb_model_set_name":
        "Gives a part another name, or none by \"\"; an input or an event needs one. Before dmb_model_compile.",
    "dmb_model_write":
        "The description of a model as bytes that are the same for all machines and for later versions: for files, firmware and other programs. Writes at most `room` bytes; *size is the length of the record, also with bytes NULL and room 0. Of a compiled model too; compile options are not part of it. Errors, which write nothing: ERR_TOO_LARGE (room), _UNSUPPORTED (functions of the caller, which no record holds), that of a refused part.",
    "dmb_modes_get":
        "Mode number index. O(elements).",
    "dmb_modes_part":
        "[J] kinetic and strain energy of the mode, as in dmb_mode, in a pipe of a string with half of the parts fixed to its two ends, in a whole string (pipe = NONE), or in a body or bit (pipe 0). O(elements of it).",
    "dmb_modes_shape":
        "Shape at a place, between nodes by the element's own shape functions. O(1).",
    "dmb_motor_drive":
        "Fills the fields of the drive for this motor (kind CONTROL, component RX, gain or its table, limits, mud_pressure; part, time function and name stay) and returns w0 [rad/s], the constant value of its time function (eq:drive.motor). Another flow while it runs: an input of the set point w0, in proportion to it. Errors: ERR_NULL, _STRUCT_SIZE, _VALUE, _NOT_FINITE.",
    "dmb_operation_name":
        "\"pick-up\", \"slack-off\", ...; NULL for a number that is none: they are numbered from 0 without gaps.",
    "dmb_operation_usual":
        "Usual speeds of an operation OPERATION_...: 0.1 m/s up or down, 1 rev/s, 0.005 m/s while drilling; loads on the bit 0.",
    "dmb_output_check":
        "Checks this sim for each output; dmb_sim_message: the first missing one and a valid place. Errors as dmb_query_output.",
    "dmb_output_name":
        "\"bit_speed\", and its unit in *unit (may be NULL); NULL for a number that is none. Names do not change.",
    "dmb_output_next":
        "All numbers that have a name, ascending: the one after `quantity`, -1 before the first; -1 after the last.",
    "dmb_output_quantity":
        "The number of a name; ERR_VALUE where it is none.",
    "dmb_output_text":
        "\"drive_force of drive table [N m]\", \"axial_force of string main pipe 3 at 0.5 [N]\": into the caller's text of `size` [byte], ends with 0; 128 suffice. sim may be NULL: parts by their numbers. Errors: ERR_TOO_LARGE (room).",
    "dmb_pool_allocator":
        "An allocator that uses only the caller's memory: for firmware without a heap. memory: the pool itself takes 64 bytes of it; it must remain valid while a model or sim uses it. One thread at a time. First fit, neighbouring gaps join, blocks begin on 64 bytes. *allocator may be uninitialised. Calling it again on the same memory forgets all that was given out. In a full pool, calls that need memory give ERR_NO_MEMORY and change nothing. Errors, which leave *allocator unchanged: ERR_NULL, _VALUE (size < 256, or beyond the end of the addresses).",
    "dmb_pool_peak":
        "[byte] from the start of such a pool to the end of its highest block so far: a pool of that size suffices for the same calls. 0 for any other allocator. Cannot fail.",
    "dmb_profile_name":
        "Name of a quantity (\"axial_force\") and its unit in *unit (may be NULL); NULL for another number; from 0 without gaps.",
    "dmb_profile_recorder_take":
        "As dmb_recorder_take, with the errors of dmb_query_profile.",
    "dmb_profile_recorder_write_csv":
        "CSV, a line for each row and station: time [s], station, then the quantities with their units. ERR_IO.",
    "dmb_query_constraint_rows":
        "The first row of the Jacobian that is an equation of a joint, coupling, constraint or joint drive, and their count.",
    "dmb_query_contact":
        "Contact of contact point `number`, counted along the strings (stabilisers before the pipe at their nodes), then the bodies, then points along elements (contact_points), then axial-torsional pipes.",
    "dmb_query_contact_total":
        "O(contact points).",
    "dmb_query_energy":
        "Energy ledger since the start; ERR_UNSUPPORTED where the options left it out. O(nodes).",
    "dmb_query_flow":
        "Pressures and forces of the mud that flows, at the present position of the string; all 0 without a flow_rate but for pressure_stretch of mud at rest. Kinetic heads, steps between diameters, bodies, bits and stabilisers in the annulus and the motion of the string are neglected. The annulus has the flow_eccentricity wherever the string lies. O(elements).",
    "dmb_query_hole":
        "The axis at a measured depth [m], by minimum curvature (Taylor, Mason 1972) between stations. A compiled model; ERR_ORDER before, ERR_UNSUPPORTED without a hole, _NOT_FINITE. O(log stations).",
    "dmb_query_hole_now":
        "The same with the diameter that the cutters have left up to now (cut_spacing of dmb_wall_def).",
    "dmb_query_kinetic_energy":
        "[J] kinetic energy of one pipe of a string with half of the parts fixed to its two ends, or of a body.",
    "dmb_query_momentum":
        "O(nodes).",
    "dmb_query_multipliers":
        "Multipliers of a joint, coupling, constraint or joint drive: count of its rows (at most 6), in the units of a force per unit of its value. *count on return is the number of rows.",
    "dmb_query_output":
        "[unit of the output] The present value. Errors: those of the query behind it, ERR_VALUE for an unknown quantity or a multiplier that is not there, ERR_UNSUPPORTED for a string without the part it needs (a bit, a rock law, a flexible first pipe) and for outputs of a window.",
    "dmb_query_pose":
        "Pose of a place; the axes of a body or bit are its own.",
    "dmb_query_pose_at":
        "Pose and motion of a point off a place: offset [m] in the axes of the place. Errors too: ERR_NOT_FINITE.",
    "dmb_query_profile":
        "Fills profile->values. Section forces, stresses and shares are NaN on rigid pipes. Buckling loads are those of a long pipe that lies on the wall without friction, with the contact force per metre that the unbuckled pipe would have (Dawson, Paslay 1984; He, Kyllingstad 1995; Chen, Lin, Cheatham 1990; in a vertical hole Wu, Juvkam-Wold 1995: eq:drilling.sinusoidal, eq:drilling.helical). Errors: ERR_VALUE too for strides that overlap, _NOT_FINITE. O(station_count).",
    "dmb_query_profile_extremes":
        "extremes, shape (quantity_count, 4): least value, its distance [m], largest, its distance; NaN: no value. Ignores `values`.",
    "dmb_query_reaction":
        "[N, N m] force and moment of the support and the motion drives on the rig end of a string or on a supported body, body frame, shape (6); 0 in components that are free.",
    "dmb_query_rotation":
        "[rad] rotation about the pipe's own axis since time 0, revolutions counted.",
    "dmb_query_row":
        "The part or node that a row belongs to.",
    "dmb_query_section":
        "Section loads of a flexible or axial-torsional pipe; ERR_UNSUPPORTED on rigid ones.",
    "dmb_query_statistics":
        "O(number of joints, couplings and constraints).",
    "dmb_recorder_take":
        "Call it after every step: writes a row if its time has come. NOTE_FULL when the table has no room; ERR_ORDER before the time of the last row, as after a restore: set row_count to the number of rows to keep. Other errors: ERR_NULL, _HANDLE, _STRUCT_SIZE, _VALUE, _NOT_FINITE, those of dmb_query_output. O(outputs).",
    "dmb_recorder_write_csv":
        "Writes the table as CSV: comma, '.', a line of heads as of dmb_output_text with part names of `sim` (NULL: numbers of parts), 17 digits, nan. Errors: ERR_NULL, _HANDLE, _STRUCT_SIZE, _VALUE, _NOT_FINITE; _IO: this and all that write files write beside path (path.part0) and rename, so that the old file stays, unless path is a device.",
    "dmb_response_dimensions":
        "Numbers of frequencies (those of refinement included), excitations and outputs, shape (3).",
    "dmb_response_frequencies":
        "[Hz] ascending, shape (points).",
    "dmb_response_write_csv":
        "CSV: frequency, then amplitude and phase [rad] of each transfer function and of the combined outputs; a line of heads, with part names of `sim` (NULL: numbers of parts), '.' as decimal mark. Errors: ERR_IO.",
    "dmb_sensitivity_create":
        "Begins with the derivatives that low and high have now, (high - low)/(2 step) of every number of the state. parameters: count (1 .. 4096) of them, each with the same struct_size. The sim must outlive the object, which holds its models. Errors: ERR_VALUE: low or high is a scene of another make, has another time, or other contacts, locks or inputs that are not numbers, or an input is changing towards its set point; _UNSUPPORTED: joints with METHOD_MULTIPLIERS, actuators with a delay, time functions whose times differ; _TOO_LARGE: clusters that are solved by sparse matrices. O(count * state).",
    "dmb_sensitivity_kinks":
        "*kinks [-]: accepted steps so far in which the parameter was not smooth.",
    "dmb_sensitivity_outputs":
        "Outputs and their derivatives by each parameter now: values, shape (count), may be NULL; derivatives [unit of the output over that of the parameter], shape (count, parameters). Errors: those of the outputs' queries; ERR_UNSUPPORTED: works, energies summed over the run, counts, windows; _ORDER: the sim was moved by other calls.",
    "dmb_sensitivity_rows":
        "Derivative of body-frame pose [m, rad] and velocity [m/s, rad/s] in all rows by one parameter, rows being the free and held components of the nodes in the order of the library; shape (rows) each, either may be NULL. *rows: how many there are; with both arrays NULL that is all. Errors: _ORDER as above.",
    "dmb_sensitivity_step":
        "dmb_sim_step and dmb_sim_advance of the sim, with the same bits, and the derivatives along with it, of each accepted step as it was done, its length, breakpoints and kept accelerations included. Between two of these calls the sim may be changed by dmb_sim_set_drive only; inputs stay as they were set when this was made (ERR_ORDER). NOTE_NOT_SMOOTH where a contact, a sticking bristle or a limit differs between both sides of a parameter: the derivative there is the mean of two. Other notes and errors as dmb_sim_step and dmb_sim_advance; ERR_ORDER: other calls moved the sim; _UNSUPPORTED: a stuck place is released; _SINGULAR: the matrix at the end of a step. Allocates nothing. Costs 2 to 3.5 steps for one parameter, 1.2 to 2.1 for each of four; two sims more, with the parameter lower and higher, cost 2, also on threads of their own: better for one or two.",
    "dmb_sim_advance":
        "Advances to `time` [s] with steps chosen to hold the tolerances of the local error of each step, bounded_work or not. Errors of steps add up over a run, to some thousand times the tolerances in 10 s: repeat it with a tenth of the tolerances to estimate the error at its end. NOTE_TOLERANCE where a step of step_min was too long for them; before that NOTE_STOPPED after max_steps, NOTE_CANCELLED. Errors as dmb_sim_step; the state is then the last accepted one.",
    "dmb_sim_advance_to_event":
        "As dmb_sim_advance, but ends at the first event: NOTE_EVENT, dmb_sim_message names those reported. One that is beyond its level at the start is reported when it has come back and crosses again; a `hold` continues from call to call. Costs a copy of the state a step, some six steps a crossing. Notes and errors as dmb_sim_advance; ERR_VALUE: no events.",
    "dmb_sim_create":
        "Makes a sim at time 0 in the described pose and speed, which holds the model until it is destroyed. options may be NULL. To close joints, rigid bodies are moved over any distance and rotation, then strings as rigid bodies as far as their supports leave them free, and only then pipes are strained (assembly_energy). NOTE_PROJECTED: initial velocities did not fit the allowed motion, or joints were closed; dmb_sim_message states by how much. Errors, in dmb_model_message: ERR_ORDER (model not compiled), _NO_MEMORY, _TOO_LARGE, _CALLBACK, _ROTATION, _SINGULAR, _NO_CONVERGENCE, _UNSUPPORTED, _GEOMETRY (joints that cannot be closed, or only by more than assembly_energy); *sim is NULL then. O(elements).",
    "dmb_sim_create_in":
        "The same in the caller's block of at least dmb_sim_memory_size bytes, any alignment; the allocator is not used. Errors as dmb_sim_create; ERR_TOO_LARGE.",
    "dmb_sim_destroy":
        "Gives the memory back and sets *sim to NULL; does nothing within a call on this sim. NULL-safe.",
    "dmb_sim_hash":
        "FNV-1a hash of all that changes; equal states give equal hashes on one build.",
    "dmb_sim_memory_size":
        "Bytes of the block that dmb_sim_create_in needs. O(1). Errors: ERR_ORDER (model not compiled), _TOO_LARGE.",
    "dmb_sim_message":
        "Message of the last call on this sim that failed or has a note; of queries, of this thread. Never NULL; until the next call.",
    "dmb_sim_record_inputs":
        "From now on set points go into `records`, shape (capacity), which the caller keeps alive; NULL with 0: no more. A call beyond the capacity still sets its value: NOTE_FULL. The log is neither saved in snapshots nor hashed.",
    "dmb_sim_replay_inputs":
        "Sets the values of the log from record *next on up to the present time, call by call, and moves *next beyond them. Called before each step of a run that steps as the recorded one did, it gives the same states, bit for bit. Notes and errors as dmb_sim_set_inputs, with *next at the call that was refused; ERR_VALUE too for times that decrease.",
    "dmb_sim_set_drive":
        "From now on the drive's time function is the constant `value` [unit of its time function]; NaN: its time function again. For DRIVE_LOAD and DRIVE_CONTROL; accelerations are made to fit the jump. ERR_UNSUPPORTED for DRIVE_MOTION, whose speed may not jump, and where an input moves the set point (scene.h).",
    "dmb_sim_set_input":
        "From now on the inputs, shape (count), have these values, or approach them within their rate limits; all are set or none. Accelerations are adapted to jumps. The energy of weight that a change of density adds is work of loads. Setting a value again does nothing. NOTE_CLAMPED where a bound was taken instead, _FULL (log). Errors: ERR_VALUE (bounds; limits of a drive), _CALLBACK, _SINGULAR, _UNSUPPORTED. O(elements).",
    "dmb_sim_set_joint":
        "From now on the joint is JOINT_ACTIVE, _LOCKED (where it is) or _OPEN. Speeds that no longer fit change by the impulse of least kinetic energy (NOTE_PROJECTED, the message gives the change), which goes to `impact` (examples/programming, Joints and strings that change). A joint that a motion drive moves cannot be locked. Errors: ERR_GEOMETRY (parts or couplings do not fit within 1e-6 m and rad; a drive's speed cannot be reached), _SINGULAR, _NO_CONVERGENCE, _CALLBACK.",
    "dmb_sim_set_on_step":
        "From now on `function` is called in the thread of the call after each dmb_sim_step, each step of dmb_sim_steps and each of dmb_sim_advance and _advance_to_event that is accepted for good: not parts of a divided step, nor steps that are repeated to locate an event. Nonzero before the end of the call: NOTE_STOPPED. dmb_analysis_stepped_sine calls it too, and is not ended by it. NULL (default): none. Not in snapshots and hashes.",
    "dmb_sim_set_progress":
        "From now on dmb_sim_step, _steps, _advance and all analyses of this sim call `function` at bounded intervals (examples/programming, Runs) in the thread of the call (an eigenproblem of LAPACK is one interval). Nonzero ends the call with ERR_CANCELLED and nothing changed (dmb_sim_steps and dmb_analysis_stepped_sine: in the last accepted state; dmb_sim_advance there with NOTE_CANCELLED). NULL (default): none. Not in snapshots and hashes.",
    "dmb_sim_snapshot_size":
        "Snapshot of all that changes: bytes, save into and restore from the caller's memory. It fits every sim of the same compiled model with the same options, which continues bit for bit. Bytes that are no state of it, forged ones too, are refused (ERR_VALUE, the message states field, value and bound); accepted bytes cannot lead a step out of bounds. About 0.9 kB an element are factors kept from step to step (none with joints).",
    "dmb_sim_step":
        "Advances by `duration` [s], > 0 and <= 1e18, in one step of generalized-alpha (lib/theory/integration.md), divided at breakpoints of time functions, and halved where Newton does not converge (NOTE_STEP_CUT). Notes too: NOTE_WORK_LIMITED. Errors: ERR_NO_CONVERGENCE, _SINGULAR, _ROTATION, _GEOMETRY (a joint where its angles are not defined), _CALLBACK, _NOT_FINITE, _CANCELLED; the state is then that before the call. O(elements) an iteration.",
    "dmb_sim_steps":
        "`count` calls of dmb_sim_step with the same duration in one, with the same bits. *done (may be NULL): [-] accepted calls. The report has the sums and maxima of them all. The status is the largest note of a step, with its message, NOTE_STOPPED, or the error that ended the calls, as dmb_sim_step; the state is then that after *done of them.",
    "dmb_sim_steps_to_event":
        "As dmb_sim_steps, with the same bits, but ends after the step in which the first event is: NOTE_EVENT. No step is changed: `events` has all of that step, and `crossing` is where the parabola through the output at three ends of steps meets the level (lib/theory/integration.md), with an error of order 3 where the output is smooth, else up to the step. dmb_sim_advance_to_event takes shorter steps where tolerances ask. Notes, errors as dmb_sim_steps; ERR_VALUE: no events.",
    "dmb_sim_transfer_state":
        "Continues from the state of `from` in a sim of another model that has pipes more or fewer at the rig end of its strings; the start of its strings and its time functions may differ, all else must be of the same kind and number (ERR_VALUE names the difference). examples/programming, Joints and strings that change, has the rules. Do it at rest: speeds that the supports of the new rig end do not allow are projected (NOTE_PROJECTED). Errors: ERR_GEOMETRY (a joint does not fit), _SINGULAR, _NO_CONVERGENCE, _ROTATION, _CALLBACK. O(elements).",
    "dmb_sim_value":
        "The same as a number, of one OUTPUT_...; NaN where it fails, dmb_sim_message and dmb_last_error say why. Example: dmb_sim_value(sim, OUTPUT_DRIVE_FORCE, (dmb_place){.part = drive}).",
    "dmb_state_equation_begin":
        "The state y at `time` becomes the origin and y its numbers, maybe of other rows. Errors as above, which change nothing but the sim below; also ERR_SINGULAR where n would change.",
    "dmb_state_equation_create":
        "Copies the sim, which is left as it is and may be destroyed first; the calls below allocate nothing. Errors: ERR_UNSUPPORTED: the message names a part whose force is no function of pose, velocity and time (bristles, restitution laws, rock that is cut, integral gains, delay, lag and rate limit of actuators, places that are stuck), or by which positions depend on the path (nonholonomic joints, a motion drive across a part's rotation); _TOO_LARGE (clusters of joints).",
    "dmb_state_equation_origin":
        "y of the origin, shape (2 n), and its *time [s], which may be NULL.",
    "dmb_state_equation_rate":
        "rate = f(time, y), shape (2 n) both, one array or two; positions that joints make dependent are solved for from the origin on, so that equal y have equal bits. If a constraint of the caller turns parts with time, move the origin at least once each radian of that motion: branch and revolutions are those nearest to the origin. Errors: ERR_VALUE, _NOT_FINITE, _CALLBACK, _ROTATION; _GEOMETRY: too far from the origin, or a joint where its angles are not defined; _SINGULAR, _NO_CONVERGENCE: joints cannot be closed with these coordinates. O(elements), with joints more the farther the origin.",
    "dmb_state_equation_rows":
        "Row of each coordinate, ascending, shape (n).",
    "dmb_state_equation_sim":
        "A sim in the state of the last call of _rate or _begin, for queries alone (ask.h: accelerations, reactions of joints, outputs); NULL where that call failed. Its sums and counts over a run are those of the sim copied, and there are no energies of the ledger. Lives as long as the equation.",
    "dmb_state_space_dense":
        "One of A, B, C, D, row by row.",
    "dmb_state_space_shapes":
        "Shapes of the coordinates of A by rows, shape (coordinates, rows): unit motions of FULL, the basis of REDUCED.",
    "dmb_state_space_sparse":
        "One of the sparse matrices as triplets, row by row, none twice. All three arrays NULL: *count is their length. Else *count on entry is the capacity (too little is ERR_VALUE) and on return the number written.",
    "dmb_status_name":
        "Name (\"ERR_VALUE\") and text of a status, of an unknown one \"UNKNOWN\". Never NULL. Thread-safe.",
    "dmb_version":
        "Version of the linked library, 10000 major + 100 minor + patch. Cannot fail.",
    "dmb_window_create":
        "outputs, shape (output_count), 1 .. 4096, are copied. Memory from the model's allocator: 48 bytes per output and slot. options may be NULL. Errors: those of dmb_output_check, ERR_VALUE, _NOT_FINITE, _NO_MEMORY; *window is NULL then.",
    "dmb_window_destroy":
        "Sets *window to NULL. NULL-safe.",
    "dmb_window_get":
        "O(slots). ERR_NULL, _HANDLE, _STRUCT_SIZE, _VALUE (no such output).",
    "dmb_window_reset":
        "Forgets all samples.",
    "dmb_window_take":
        "Takes a sample; call it after each step. A second one at the same time is ignored; ERR_ORDER for an earlier time: dmb_window_reset; _NOT_FINITE (an output). The sim may be another one of the same model. Allocates nothing. O(outputs).",
    "dmb_write_vtk_hole":
        "The hole as a tube of `around` facets (3 .. 360), circles each `spacing` [m]; errors as dmb_query_hole, ERR_TOO_LARGE.",
    "dmb_write_vtk_mode":
        "A frame of its animation for ParaView: the strings displaced by scale Re(shape e^(i phase)), as dmb_write_vtk_strings writes them, with fields displacement and rotation. A numbered series of frames plays. Errors: ERR_IO.",
    "dmb_write_vtk_strings":
        "VTK XML poly-data for ParaView: the strings as lines with fields (displacement, velocity, diameter, axial force, torque, bending moment, normal force), `per_element` points an element (1 .. 64). ERR_IO on failure.",
}


def declare(library: ctypes.CDLL) -> None:
    """Tells ctypes the types of all functions."""
    for name, (result, *arguments) in PROTOTYPES.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
