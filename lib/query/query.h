/* Internal interface of the queries: places, motion, section, masses, reactions, outputs and profiles of an accepted
 * state, as used by analyses and output. */
#ifndef DMB_QUERY_QUERY_H
#define DMB_QUERY_QUERY_H

#include "drillmbd/analyse.h"
#include "drillmbd/ask.h"
#include "drillmbd/scene.h"
#include "element/beam.h"
#include "kernel/kernels.h"
#include "model/model.h"
#include "sim/sim.h"
#include "system/assemble/assemble.h"

/* ---- Places ------------------------------------------------------------------------------------------------------ */

typedef struct dmb_material_point {
    uint32_t node;    /* node to which it is rigidly connected; otherwise near node of the element */
    uint32_t element; /* element of a flexible or axial-torsional pipe; DMB_NONE on rigid pipes and bodies */
    double arm;       /* [m] along body x from the node, if `fixed` */
    double fraction;  /* [-] along the element's flexible length, 0 .. 1 */
    double beyond;    /* [m] beyond the element's far end, inside the tool joint; 0 elsewhere */
    int32_t fixed;    /* 1: rigidly connected to the node (body, rigid pipe, tool joint, end of an element) */
    int32_t reserved;
} dmb_material_point;

/* Material point of a place. Errors: DMB_ERR_ID, DMB_ERR_NOT_FINITE, DMB_ERR_VALUE (pipe or fraction outside the part).
 * O(1). */
int32_t dmb_material_point_of(const dmb_sim *sim, dmb_place place, dmb_material_point *point);
/* The same of a place that is on a string; it is written where that fails too. */
int32_t dmb_string_point_of(const dmb_sim *sim, dmb_place place, dmb_material_point *point);

/* Pipe of a string, or NULL if there is none: DMB_ERR_ID or DMB_ERR_VALUE in *status. */
const dmb_pipe_map *dmb_pipe_of(const dmb_sim *sim, dmb_id string, uint32_t pipe, int32_t *status);

/* Number of a body or bit in scene->bodies; DMB_NONE if the id names neither. */
uint32_t dmb_body_index(const dmb_sim *sim, dmb_id id);

/* Description of a pipe of a compiled string: the call of dmb_model_add_pipes that added it; NULL if there is none.
 * O(number of such calls). */
const dmb_pipe_run *dmb_pipe_run_of(const dmb_model *model, uint32_t string, uint32_t pipe);

/* Contact point, numbered as in dmb_query_contact, at the far end of a string's pipe, or of a body (pipe 0); DMB_NONE
 * if nothing there can touch the wall. part and pipe must be valid. O(log sites), in rigid sections O(their pipes). */
uint32_t dmb_site_of(const dmb_sim *sim, dmb_id part, uint32_t pipe);

/* Contact point after the first `elements` elements of a pipe; 0: at its near end. A rigid pipe counts as one element.
 */
uint32_t dmb_site_after(const dmb_sim *sim, dmb_id string, uint32_t pipe, uint32_t elements);

/* [N] normal force of a contact point in the accepted state; 0 for DMB_NONE. */
double dmb_site_normal_force(const dmb_sim *sim, uint32_t site);

/* [N] normal force of the contact point of a part; 0 if there is none. Errors: DMB_ERR_ID, DMB_ERR_VALUE (no such
 * pipe). */
int32_t dmb_normal_force_at(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *force);

/* Force of a contact point in the accepted state, with the friction of an assumed slip. */
void dmb_contact_force_of(const dmb_sim *sim, uint32_t site, dmb_site_force *force);

/* ---- Motion inside elements -------------------------------------------------------------------------------------- */

typedef struct dmb_end_pose {
    double rotation[9];     /* [-] body to world, row-major */
    double displacement[3]; /* [m] world, from reference_position */
} dmb_end_pose;

/* Pose of a node in a configuration, and at time 0 as described. */
void dmb_end_pose_now(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t node,
                      dmb_end_pose *pose);
void dmb_end_pose_at_start(const dmb_scene *scene, uint32_t node, dmb_end_pose *pose);

/* d = log(H_A^-1 H_B) of the element's flexible ends from the poses of its nodes, for nodes of any kind. */
void dmb_relative_pose(const dmb_scene *scene, uint32_t element, const dmb_end_pose *a, const dmb_end_pose *b,
                       double d[6]);

/* Shape of the section at a point inside an element. */
void dmb_material_point_shape(const dmb_scene *scene, const dmb_material_point *point, dmb_section_shape *shape);

/* Pose and motion of a point: of its node, displaced by a rigid arm, or of a section between two nodes. */

typedef struct dmb_material_point_pose {
    double rotation[9];     /* [-] body to world, row-major */
    double position[3];     /* [m] world */
    double displacement[3]; /* [m] world, position minus that at time 0 as described */
} dmb_material_point_pose;

void dmb_material_point_pose_of(const dmb_scene *scene, const dmb_configuration *configuration,
                                const dmb_material_point *point, dmb_material_point_pose *pose);

/* Axes of the point at time 0 as described, body to world. */
void dmb_material_point_start_axes(const dmb_scene *scene, const dmb_material_point *point, double R[9]);

/* Velocity [m/s, rad/s] and its rate [m/s2, rad/s2] in the axes of the section: the exact time derivatives of the pose
 * above. */
typedef struct dmb_material_point_motion {
    double velocity[6];
    double acceleration[6];
} dmb_material_point_motion;

void dmb_material_point_motion_of(const dmb_scene *scene, const dmb_configuration *configuration,
                                  const dmb_material_point *point, dmb_material_point_motion *motion);

/* Pose, motion and axes at time 0 of a section between two axial-torsional nodes of a curved hole, which is on its axis
 * (query/motion_axis). */
int dmb_is_on_curved_axis(const dmb_scene *scene, const dmb_material_point *point);
void dmb_axis_pose_of(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_material_point *point,
                      dmb_material_point_pose *pose);
void dmb_axis_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, const dmb_material_point *point,
                        dmb_material_point_motion *motion);
/* R_a: axes of node A at time 0. */
void dmb_axis_start_rotation(const dmb_scene *scene, const dmb_material_point *point, const double R_a[9], double R[9]);

/* [rad] rotation about the pipe's axis since time 0, linear between nodes */
double dmb_material_point_turn(const dmb_configuration *configuration, const dmb_material_point *point);

/* [m] measured depth of the closest point of the hole's axis to x; 0 without a hole. O(log stations). */
double dmb_material_point_depth(const dmb_scene *scene, const dmb_configuration *configuration,
                                const dmb_material_point *point, const double x[3]);

/* ---- Mass -------------------------------------------------------------------------------------------------------- */

/* Contributions to the rigid mass of a node. The rigid_mass of a node is the sum of all parts fixed to it. Each
 * contribution is computed from the description, as the compile step added it. */

/* A pipe of a string with its description. */
typedef struct dmb_described_pipe {
    const dmb_pipe_map *map;
    const dmb_pipe_def *def;
    uint32_t string, number;
    int32_t eccentric;
    int32_t reserved;
    double offset[2]; /* [m] of its centre of mass, if eccentric */
} dmb_described_pipe;

/* string and pipe must be valid. O(number of dmb_model_add_pipes calls). */
void dmb_describe_pipe(const dmb_sim *sim, uint32_t string, uint32_t pipe, dmb_described_pipe *out);

/* A rigid pipe without its tool joint. */
void dmb_rigid_pipe_fraction(const dmb_described_pipe *pipe, dmb_rigid_mass *share);
/* Tool joint of a pipe; mass 0 if there is none. */
void dmb_joint_fraction(const dmb_scene *scene, const dmb_described_pipe *pipe, dmb_rigid_mass *share);
/* The first `length` [m] of the tool joint, as of a uniform body; returns its mass. */
double dmb_joint_part_fraction(const dmb_scene *scene, const dmb_described_pipe *pipe, double length,
                               dmb_rigid_mass *share);
/* Contribution of eccentricity to the near (end 0) or far (end 1) node of an element: a first moment, no mass. */
void dmb_eccentric_fraction(const dmb_scene *scene, const dmb_described_pipe *pipe, uint32_t element, uint32_t end,
                            dmb_rigid_mass *share);
/* A body or bit, by its number in scene->bodies. */
void dmb_body_fraction(const dmb_sim *sim, uint32_t body, dmb_rigid_mass *share);

/* 1 if a body or bit, by its number in scene->bodies, is fixed to this end of a string, DMB_ATTACH_START or _END; an id
 * that names nothing stands for the first string. */
int dmb_body_is_at_end(const dmb_model *model, uint32_t body, uint32_t string, int32_t attach);

/* [J] Kinetic energy of a rigid mass on its node in the accepted state. */
double dmb_fraction_kinetic_energy(const dmb_sim *sim, const dmb_rigid_mass *share);

/* ---- Section forces ---------------------------------------------------------------------------------------------- */

/* Loads of the ends of elements that were computed side by side, kept from station to station. */
enum { DMB_LOADS_KEPT = 32 };
typedef struct dmb_kept_loads {
    uint32_t first, count; /* elements in `loads` */
    uint32_t most;         /* elements to compute at once, where stations go on along the string: 1 .. DMB_LOADS_KEPT */
    uint32_t reserved;
    dmb_end_loads loads[DMB_LOADS_KEPT];
} dmb_kept_loads;

static inline void dmb_kept_loads_begin(uint32_t most, dmb_kept_loads *kept)
{
    kept->first = kept->count = 0;
    kept->most = most;
}

/* Section force at a point of a pipe, in its tool joint too, as dmb_section tells it; point: that of the place, of an
 * element. */
void dmb_section_force_at(const dmb_sim *sim, dmb_place place, const dmb_material_point *point, dmb_kept_loads *kept,
                          double force[6]);
/* Section force at a point of an element of the pipe, not in its tool joint, in the convention of dmb_section. O(log
 * sites + loads + springs + stuck places). */
void dmb_section_load_of(const dmb_sim *sim, const dmb_described_pipe *pipe, const dmb_material_point *point,
                         dmb_kept_loads *kept, double load[6]);
/* 1, and the force and moment of the external damping of pipe by its integrals of 1, x, x^2 about a section, whose
 * velocity is v, in the axes of both; 0: there is none, or the state is quasi-static. */
int dmb_external_damping_at(const dmb_sim *sim, const double damped[3], const double v[6], double f[6]);
/* Changes the load at the near end of the tool joint to that at the point in it, in place. */
void dmb_section_load_in_joint(const dmb_sim *sim, const dmb_described_pipe *pipe, const dmb_material_point *point,
                               double load[6]);

/* ---- Pressures of the mud ---------------------------------------------------------------------------------------- */

typedef struct dmb_mud_pressure {
    double outside, inside; /* [Pa] */
} dmb_mud_pressure;

/* 1 if the pressures inside and outside differ. */
static inline int dmb_mud_is_apart(const dmb_scene *scene)
{
    return scene->flow_count > 0 || !(scene->inner_density < 0.0);
}

/* Mud pressures [Pa] at a distance [m] from the rig end of the string, at the point x [m], world frame. At rest each
 * mud column extends to the start of the hole, or, without a hole, to the rig end as described. With flow, the pressure
 * in the annulus increases by the loss between this point and the rig end; the pressure inside is the pressure outside
 * at the far end plus the loss there plus the loss between this point and the far end. */
dmb_mud_pressure dmb_mud_pressure_at(const dmb_sim *sim, uint32_t string, double distance, const double x[3]);

/* ---- Loads over limits ------------------------------------------------------------------------------------------- */

/* Loads over limits of a pipe in its hole: stress at its surface, and buckling of a long pipe that lies on the wall. */

/* [Pa] Largest von Mises stress at the outer surface of a tube under effective axial force [N], torque and bending
 * moment [N m]: s = |N_e|/A + M r/I, t = T r/J, sqrt(s^2 + 3 t^2). A fluid at rest with the same density inside and
 * outside adds a hydrostatic stress to that of N_e, which does not affect the von Mises stress. */
double dmb_tube_von_mises(double outer_diameter, double inner_diameter, double axial_force, double torque,
                          double bending_moment);

/* [Pa] Largest von Mises stress of both surfaces of a tube if the pressure inside is higher by `pressure` [Pa]. With
 * s = N_e/A + M rho/I at the radius rho the axial stress is s + (p_i A_i - p_o A_o)/A. The radial and hoop stresses of
 * Lame are (p_i A_i - p_o A_o)/A +- h, h = pressure A_i A_o/(A pi rho^2), so that the von Mises stress is
 * sqrt(s^2 + 3 h^2 + 3 t^2) (Sparks 1984). diameters: outer, inner [m]. */
double dmb_tube_pressed_von_mises(const double diameters[2], double axial_force, double torque, double bending_moment,
                                  double pressure);

/* A long pipe in contact with the wall of its hole. */
typedef struct dmb_confined_pipe {
    double EI;         /* [N m2] the smaller one */
    double clearance;  /* [m] of its contact ring, >= 0 */
    double weight[3];  /* [N/m] buoyant, world frame */
    double tangent[3]; /* [-] of the hole's axis */
    double bend[3];    /* [1/m] dt/ds of the hole's axis, world frame */
} dmb_confined_pipe;

/* [N/m] Wall force w_c per metre of the pipe without its bending stiffness, |w_across + N_e dt/ds|; and dw_c/dN_e [1/m]
 * in *by_force (may be NULL). */
double dmb_confined_wall_force(const dmb_confined_pipe *pipe, double axial_force, double *by_force);

/* [-] Compression -N_e over the load of sinusoidal buckling, sqrt(4 EI w_c/r) where w_c = |w_across + N_e dt/ds| is the
 * contact force per metre before buckling (Dawson, Paslay 1984; He, Kyllingstad 1995), but at least 2.55 (EI
 * w_along^2)^(1/3) (Wu, Juvkam-Wold 1995). 0 in tension; NaN if the limit is 0, because nothing presses the pipe to the
 * wall. */
double dmb_sinusoidal_ratio(const dmb_confined_pipe *pipe, double axial_force);
/* [-] the same for helical buckling: compression over sqrt(8 EI w_c/r) (Chen, Lin, Cheatham 1990), at least 5.55 (EI
 * w_along^2)^(1/3). */
double dmb_helical_ratio(const dmb_confined_pipe *pipe, double axial_force);

/* ---- Joints and constraints -------------------------------------------------------------------------------------- */

/* Number of active rows, the first of its rows; and number of those excluded as redundant. */
uint32_t dmb_constraint_active(const dmb_sim *sim, uint32_t constraint);
uint32_t dmb_constraint_redundant(const dmb_sim *sim, uint32_t constraint);
/* Largest violation of an equation of position of joint j. */
double dmb_joint_violation(const dmb_sim *sim, uint32_t j);

/* ---- Outputs ---------------------------------------------------------------------------------------------------- */

/* Outputs: one number queried from a sim, for recorders, windows, responses and events. quantity_name contains their
 * names; dmb_output_value is the only function that computes their values. Kinds of places of outputs: */
enum {
    DMB_AT_PLACE = 0,   /* any place on a string, body or bit */
    DMB_AT_SECTION = 1, /* a place on a flexible or axial-torsional pipe */
    DMB_AT_PIPE = 2,    /* a place on a string */
    DMB_AT_PART = 3,    /* a pipe of a string, a body or a bit */
    DMB_AT_STRING = 4,  /* a string or {0, 0} */
    DMB_AT_BIT = 5,     /* place.part alone, also for the following kinds */
    DMB_AT_DRIVE = 6,
    DMB_AT_JOINT = 7,
    DMB_AT_CONSTRAINT = 8, /* a joint, coupling, constraint or joint drive */
    DMB_AT_CONTACT = 9,    /* place.pipe alone, a contact point */
    DMB_AT_SCENE = 10,     /* ignored */
    DMB_AT_WINDOW = 11,    /* place.pipe alone, a watched output */
    DMB_AT_STUCK = 12,     /* place.part alone */
    DMB_AT_SPRING = 13,
    DMB_AT_INPUT = 14,
    DMB_AT_VIBRATION = 15 /* any place, in linear analyses and a stepped sine */
};

typedef struct dmb_output_entry {
    const char *name;
    const char *unit;
    int32_t quantity;
    int32_t place; /* DMB_AT_... */
} dmb_output_entry;

/* Quantities of a profile are numbered without gaps. */
enum { DMB_PROFILE_QUANTITIES = DMB_PROFILE_GAP + 1 };

/* Returns the entry of a quantity; NULL if it is unknown. */
const dmb_output_entry *dmb_output_name_of(int32_t quantity);

/* "drive_force of drive table", "axial_force of string main pipe 3 at 0.5"; a part without a name has its number, as
 * all have where model is NULL. */
const char *dmb_output_words(const dmb_model *model, const dmb_output *output, dmb_message *text);
/* Its unit: where the table has two, that of the part's component; of inputs, that of the target. */
const char *dmb_output_unit(const dmb_model *model, const dmb_output *output);
/* DMB_ERR_VALUE, with a message about output number i: its quantity is none. */
int32_t dmb_output_known(const dmb_output *output, uint32_t i, dmb_message *message);
/* "output 3, axial_force of string main pipe 3 at 0.5: why" */
void dmb_output_refuse(const dmb_model *model, const dmb_output *output, uint32_t i, const char *why,
                       dmb_message *message);
/* Why output number i has no value. */
void dmb_output_explain(const dmb_model *model, const dmb_output *output, uint32_t i, int32_t status,
                        dmb_message *message);
/* Computes the present value of an output. Errors: those of dmb_query_output. */
int32_t dmb_output_value(const dmb_sim *sim, const dmb_output *output, double *value);

/* Values of the outputs for the driller, DMB_OUTPUT_HOOK_LOAD .. _RIG_TORQUE; an unknown number is DMB_ERR_VALUE. */
int32_t dmb_driller_value(const dmb_sim *sim, const dmb_output *output, double *value);
/* String to which such an output refers: its id and number; for {0, 0} the first string of the model. DMB_ERR_ID. */
int32_t dmb_output_string(const dmb_sim *sim, const dmb_output *output, dmb_id *string, uint32_t *index);

/* ---- Profiles ---------------------------------------------------------------------------------------------------- */

/* Groups of quantities that are computed together, only if one of them is requested. */
enum {
    DMB_TAKES_STATION = 0,
    DMB_TAKES_POSE = 1,
    DMB_TAKES_SECTION = 2,
    DMB_TAKES_CONTACT = 4,
    DMB_TAKES_LIMITS = 8, /* stress; with the pose where pressures inside and outside differ */
    DMB_TAKES_MOTION = 16,
    DMB_TAKES_BENDING = 32, /* with the pose on axial-torsional pipes */
    DMB_TAKES_BUCKLING = 64,
    DMB_TAKES_PRESSURE = 128
};

/* Groups that a quantity DMB_PROFILE_... requires; -1 if there is no such quantity. */
int32_t dmb_profile_groups(int32_t quantity);

/* A quantity DMB_PROFILE_... at a place of a string. Errors: DMB_ERR_VALUE, _ID, _NOT_FINITE. O(runs of pipes). */
int32_t dmb_profile_value(const dmb_sim *sim, dmb_place place, int32_t quantity, double *value);

/* ---- Answers ------------------------------------------------------------------------------------------------------
 */

/* Answers to the questions of the public headers, without a message where they fail: what the library itself asks.
 * query/query gives them to the caller. Errors as of dmb_query_ with the same name. */
int32_t dmb_answer_bit(const dmb_sim *sim, dmb_id bit, dmb_bit_state *state);
int32_t dmb_answer_constraint_rows(const dmb_sim *sim, dmb_id part, uint32_t *first, uint32_t *count);
int32_t dmb_answer_contact(const dmb_sim *sim, uint32_t number, dmb_contact *contact);
int32_t dmb_answer_contact_total(const dmb_sim *sim, dmb_contact_total *sum);
int32_t dmb_answer_drive(const dmb_sim *sim, dmb_id drive, dmb_drive_state *state);
int32_t dmb_answer_energy(const dmb_sim *sim, dmb_energy *energy);
int32_t dmb_answer_flow(const dmb_sim *sim, dmb_flow_state *flow);
int32_t dmb_answer_hole_now(const dmb_sim *sim, double depth, dmb_hole_point *point);
int32_t dmb_answer_joint(const dmb_sim *sim, dmb_id joint, dmb_joint_state *state);
int32_t dmb_answer_kinetic_energy(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *energy);
int32_t dmb_answer_momentum(const dmb_sim *sim, dmb_momentum *momentum);
int32_t dmb_answer_motion(const dmb_sim *sim, dmb_place place, dmb_motion *motion);
int32_t dmb_answer_motion_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_motion *motion);
int32_t dmb_answer_multipliers(const dmb_sim *sim, dmb_id part, double multipliers[6], uint32_t *count);
int32_t dmb_answer_output(const dmb_sim *sim, const dmb_output *output, double *value);
int32_t dmb_answer_pose(const dmb_sim *sim, dmb_place place, dmb_pose *pose);
int32_t dmb_answer_pose_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_pose *pose);
int32_t dmb_answer_profile(const dmb_sim *sim, const dmb_profile *profile);
int32_t dmb_answer_profile_extremes(const dmb_sim *sim, const dmb_profile *profile, double *extremes);
int32_t dmb_answer_reaction(const dmb_sim *sim, dmb_id part, double reaction[6]);
int32_t dmb_answer_rotation(const dmb_sim *sim, dmb_place place, double *angle);
int32_t dmb_answer_row(const dmb_sim *sim, uint32_t row, dmb_row *answer);
int32_t dmb_answer_section(const dmb_sim *sim, dmb_place place, dmb_section *section);
int32_t dmb_answer_spring(const dmb_sim *sim, dmb_id spring, dmb_spring_state *state);
int32_t dmb_answer_statistics(const dmb_sim *sim, dmb_statistics *statistics);
int32_t dmb_answer_stuck(const dmb_sim *sim, dmb_id stuck, dmb_stuck_state *state);

#endif
