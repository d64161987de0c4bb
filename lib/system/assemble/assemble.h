/* Terms of the residual and its tangent, one source file each; dmb_system_evaluate (evaluation.c) adds them in a fixed
 * order. Drives and callers' forces have separate headers. */
#ifndef DMB_SYSTEM_ASSEMBLE_ASSEMBLE_H
#define DMB_SYSTEM_ASSEMBLE_ASSEMBLE_H

#include "kernel/kernels.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"
#include "system/assemble/point_motion.h"

/* ---- Elements ---------------------------------------------------------------------------------------------------- */

/* Extrapolates element_stress over a correction of body-frame pose increments (Magisano, Leonetti, Garcea 2017). */
void dmb_system_extrapolate_stress(dmb_sim *sim, const double *correction);
void dmb_assemble_elements(dmb_evaluation *evaluation);

/* force = factor M change, both by rows, with masses lumped at the nodes: transverse mass shared by both ends of an
 * element, rotational inertia across the axis for each end. */
void dmb_inertia_of_change(const dmb_scene *scene, const double *change, double factor, double *force);

/* ---- Springs and joints ------------------------------------------------------------------------------------------ */

/* Residual of a force alone, in a configuration, or along the mean gradient of both ends of the step: tension [N] of a
 * spring; force [N, N m] against coordinate `component` of joint j. */
void dmb_spring_press(dmb_sim *sim, const dmb_configuration *at, uint32_t spring, double tension);
void dmb_joint_press(dmb_evaluation *evaluation, const dmb_configuration *at, uint32_t j, uint32_t component,
                     double force);
void dmb_spring_press_mean(dmb_sim *sim, uint32_t spring, double tension);
void dmb_joint_press_mean(dmb_evaluation *evaluation, uint32_t j, uint32_t component, double force);

/* ---- Nodes and loads --------------------------------------------------------------------------------------------- */

void dmb_assemble_nodes(dmb_evaluation *evaluation);
/* The run of axial-torsional nodes from `first` on: rigid masses from `rigid_mass` on, weight, damping, and friction at
 * the contact points from *site on, which is moved behind them. Returns the number of nodes. */
uint32_t dmb_assemble_axial_torsional_nodes(dmb_evaluation *evaluation, uint32_t first, uint32_t rigid_mass,
                                            uint32_t *site);
void dmb_assemble_added_masses(dmb_evaluation *evaluation);
void dmb_assemble_loads(dmb_evaluation *evaluation);
void dmb_assemble_flow(dmb_evaluation *evaluation);

/* Described loads at a point inside an element, or off the axis of a node. */

/* K += factor by_depth depth_by^T, the turn of a force with the depth: its derivative by the depth, times that of the
 * depth by displacements; in statics the symmetric part (turn_halves). */
void dmb_add_turn(const dmb_evaluation *evaluation, double factor, const double by_depth[6], const double depth_by[6],
                  double K[36]);
/* Wrench of a load at a point, in the axes of the point [N, N m], at the load factor of the configuration. */
void dmb_point_load_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t load, double w[6]);
/* factor times the load; frame (body to world) of its components if it is not a follower load. */
void dmb_assemble_point_load(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor,
                             const double frame[9]);

/* ---- The wall ---------------------------------------------------------------------------------------------------- */

typedef struct dmb_contact_slope {
    double normal_by_depth;     /* [N/m] 0 of an open contact point, and of axial-torsional ones, whose force depends on
                                   their tension */
    double normal_by_rate;      /* [N s/m] */
    double friction_by_slip[4]; /* [N s/m] shape (2, 2) */
    double friction_by_normal[2]; /* [-] shape (2) */
} dmb_contact_slope;

/* site: numbered as in dmb_query_contact. Only of friction without memory: of bristles their value in steady sliding.
 */
void dmb_contact_slope_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site,
                          dmb_contact_slope *out);
/* Contact point of a six-DOF node in the trial just evaluated: normal n and, per unit of normal force, the contribution
 * of friction to the forces that balance the wall, f = -(F_t j_t + F_b j_b) with its moment about the node, both in
 * body axes. 0: open, or not slipping. */
int dmb_contact_friction_by_normal(const dmb_evaluation *evaluation, uint32_t site, double n[3], double f[6]);
/* Friction law at a contact point, numbered as above: that of the scene, or `local` with the coefficients of a section.
 */
const dmb_friction_law *dmb_contact_friction_law(const dmb_scene *scene, const dmb_configuration *configuration,
                                                 uint32_t site, dmb_friction_law *local);
/* Node of a contact point. */
uint32_t dmb_contact_node(const dmb_scene *scene, uint32_t site);

/* Contact points on six-DOF nodes against the wall of the hole: normal and friction force in the contact frame (n
 * outward from the axis, t along the axis, b = t x n). */

typedef struct dmb_site_force {
    double normal[3];    /* [-] world */
    double tangent[3];   /* [-] world, along the axis */
    double penetration;  /* [m] */
    double rate;         /* [m/s] of penetration */
    double normal_force; /* [N] >= 0 */
    double along;        /* [N] on the body along t, if radius or stiffness of the wall change along the hole */
    double rho;          /* [-] its derivative by the normal force */
    double friction[2];  /* [N] on the body along t and b */
    double slip[2];      /* [m/s] along t and b */
    int32_t closed, sticks;
} dmb_site_force;

/* Force of one contact point in a finished configuration, with its bristles unchanged. */
void dmb_site_force_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site,
                       dmb_site_force *out);
/* Its forces as used by the step that ends in the configuration, which near touch differ from those of the law
 * (eq:touch.weights). */
void dmb_site_weighted_force(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t site,
                             dmb_site_force *force);
/* Friction of a contact point with the normal force in `force`, at its slip; bristles off the wall as in steady
 * sliding. */
void dmb_site_rub(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site, dmb_site_force *force);
/* [N] Elastic part of the normal force of a contact point in `force`. */
double dmb_site_elastic_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site,
                              const dmb_site_force *force);
/* [W] Power of the wall's damping under a force of contact point `site` in a configuration, <= 0; and of its friction.
 */
double dmb_site_heat(const dmb_sim *sim, const dmb_configuration *c, uint32_t site, const dmb_site_force *f);
double dmb_site_rubbed(const dmb_site_force *f);
/* Adds factor times the force of a contact point in `force` to generalised forces, shape (row). */
void dmb_site_add_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site, double factor,
                        const dmb_site_force *force, double *rows);
/* The same for an axial-torsional contact point; normal_force by Johancsik. */
void dmb_axial_torsional_site_force(const dmb_scene *scene, const dmb_configuration *configuration,
                                    uint32_t axial_torsional_site, dmb_site_force *out);

/* The caller's law of friction has failed in an evaluation, which fails with DMB_ERR_CALLBACK. */
void dmb_friction_failed(dmb_evaluation *evaluation);
/* Calls the accept function of the caller's law of friction for each contact point. */
void dmb_friction_accept(const dmb_sim *sim);
/* Friction of a finished state with the normal force and slip in `out`: present bristles (NULL if the law has none),
 * smooth laws by speed. */
void dmb_finished_friction(const dmb_friction_law *law, const double *bristle, int32_t sticks, dmb_site_force *out);
/* Bristle law in steady sliding, F = -mu N v/|v|, as a law without memory. */
dmb_friction_law dmb_sliding_law(const dmb_friction_law *law);
/* Friction of a contact point of this radius in a static state with an assumed slip, instead of friction by speeds: by
 * the smooth law with the normal force in `out`, as in its equilibrium. No effect if no slip was assumed. */
void dmb_assumed_friction(const dmb_friction_law *law, const dmb_configuration *configuration, double radius,
                          dmb_site_force *out);

/* Sets the measured depth [m] of contact point s in now, at which its search for the axis starts. */
void dmb_contact_place(dmb_sim *sim, uint32_t s, double depth);
/* Memory of contacts in the configurations:
 *     start             normals and depths of now at the start
 *     follow_assembly   depths after joints have moved nodes
 *     assume_slip       slip at which friction of the trial acts, from the evaluation
 *     take_slip, touch  that of the trial into now
 *     forget            no bristle of the trial is deflected and no contact has begun
 *     slide             bristles of now as in steady sliding at the present slip */
void dmb_contacts_start(dmb_sim *sim);
void dmb_contacts_follow_assembly(dmb_sim *sim);
void dmb_contacts_assume_slip(const dmb_evaluation *evaluation);
void dmb_contacts_copy_slip(dmb_sim *sim);
void dmb_contacts_copy_touch(dmb_sim *sim);
void dmb_contacts_forget(dmb_sim *sim);
int32_t dmb_contacts_slide(dmb_sim *sim);

void dmb_assemble_contacts(dmb_evaluation *evaluation);
/* Contact forces at all points on nodes, in chunks if there are many. */
void dmb_press_sites(const dmb_sim *sim, dmb_wall_args *args);
/* Contact points inside elements whose evaluation was deferred. */
void dmb_contacts_accept(dmb_evaluation *evaluation);

/* Contact points inside elements: contact along the element, at integration points of its own interpolation. They are
 * numbered last. */

/* Section that contact point s is fixed to. */
static inline const dmb_scene_point *dmb_inside_point(const dmb_scene *scene, uint32_t s)
{
    return scene->inside + (s - dmb_node_sites(scene));
}

/* Forces of all of them and their tangents. job: arguments of the points on nodes, whose laws and sums are shared.
 * Within a step, points that cannot touch are deferred until acceptance (waiting 1: these alone) and stay as open as
 * before. */
void dmb_assemble_contacts_inside(dmb_evaluation *evaluation, int waiting, dmb_wall_args *args);

/* Axes of the body of contact point s, body to world; any contact point. */
void dmb_site_axes(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double R[9]);
/* rows += factor times the wrench w at contact point s, in its body axes, on the rows of its nodes; any contact point.
 */
void dmb_site_add_wrench(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double factor,
                         const double w[6], double *rows);

/* ---- Bits -------------------------------------------------------------------------------------------------------- */

typedef struct dmb_bit_rock_result dmb_bit_rock_result;

/* Force by the rock law and bottom-hole load [N] of a bit in the accepted state. */
void dmb_bit_force_of(const dmb_sim *sim, uint32_t bit, dmb_bit_rock_result *out, double *load);
/* [N] Rock force across the bit's axis, world frame, and the speed across it [m/s]; 0 for a bit that does not cut
 * sideways. */
double dmb_bit_side_of(const dmb_sim *sim, uint32_t k, double force[3]);
/* [m/s] Speed of a bit along the axis of the hole in the accepted state, the rate of its advance. */
double dmb_bit_speed_of(const dmb_sim *sim, uint32_t bit);
/* Motion of a bit along and about the axis of the hole, in the body frame of its node, and slopes of weight and torque
 * by advance, angle, speed and spin. */
typedef struct dmb_bit_slope {
    double along[6], about[6];
    double weight[4]; /* [N/m, N/rad, N s/m, N s/rad] */
    double torque[4]; /* [N, N m/rad, N s, N m s/rad] */
} dmb_bit_slope;
void dmb_bit_slope_of(const dmb_sim *sim, uint32_t bit, dmb_bit_slope *out);
/* History of the cut surface of a bit for the rock law. */
dmb_bit_history dmb_bit_history_of(const dmb_sim *sim, uint32_t bit);
/* Flat rock at the described distance, at the start. */
void dmb_bit_start(dmb_sim *sim, uint32_t bit);
/* A bit with the rate law on the rock that nearly stops rotating in the step, and its spin [rad/s]; DMB_NONE. */
uint32_t dmb_bit_near_rest(const dmb_sim *sim, double *spin);
/* 1: the bit is on the rock; at time 0 as described. */
int dmb_bit_on_bottom(const dmb_sim *sim, uint32_t bit);
/* Rock surface of steady drilling at the speed and spin of the accepted state. */
void dmb_bit_start_steady(dmb_sim *sim, uint32_t bit);
/* Stores the surface cut in a finished step. */
void dmb_bit_accept(const dmb_evaluation *evaluation, uint32_t bit);

void dmb_assemble_bits(dmb_evaluation *evaluation);

/* ---- The hole that cutters leave -------------------------------------------------------------------------------- */

/* Widens the hole to the diameter of a cutter from its rear end, or from its earlier bottom [m of advance], to its
 * face. */
void dmb_hole_make_room(dmb_sim *sim, uint32_t bit, double before);
/* After acceptance of a step (before it: trial): widens the hole at the stations reached by cutters. 1: touching
 * contact points lost support, so that accelerations must be recomputed. O(number of bits), and of contact points if a
 * station is widened. */
int dmb_hole_cut(dmb_sim *sim);

/* ---- Springs between points -------------------------------------------------------------------------------------- */

typedef struct dmb_spring_motion {
    dmb_point_motion a, b;
    double n[3];         /* [-] from a to b, world; shorter than 1 only if the points nearly coincide */
    double length, rate; /* [m], [m/s] */
    dmb_spring_force force;
} dmb_spring_motion;

/* rates 0: as in statics */
void dmb_spring_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t spring, int rates,
                          dmb_spring_motion *motion);
/* Tangents must be cleared before; constraints without springs have none. */
void dmb_assemble_springs(dmb_evaluation *evaluation);
/* [J] stored in all springs */
double dmb_springs_energy(const dmb_scene *scene, const dmb_configuration *configuration);

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

/* Terms of joints in the residual and their tangent: springs, dampers, stops, friction and drives along their
 * coordinates, and constraint forces. A generalised force f on a coordinate with gradient J is the wrench J^T f. */

/* Adds to constraint_tangent, which is cleared before. */
int32_t dmb_assemble_joints(dmb_evaluation *evaluation);

/* ---- Stuck places ------------------------------------------------------------------------------------------------ */

enum { DMB_STUCK_COORDINATES = 4 }; /* along, sideways y and z, about the axis */

/* Offset and force of a stuck place, in the axes of its anchor. */
typedef struct dmb_stuck_hold {
    double s[DMB_STUCK_COORDINATES];     /* [m, m, m, rad] */
    double force[DMB_STUCK_COORDINATES]; /* [N, N, N, N m] k s + c s', on the ground */
} dmb_stuck_hold;

/* Residual, tangent and powers of all stuck places. */
void dmb_assemble_stuck(dmb_evaluation *evaluation);
/* [J] stored in their springs. */
double dmb_stuck_energy(const dmb_sim *sim, const dmb_configuration *configuration);
/* Offset and force of a stuck place; without `rates`, dampers do not act. */
void dmb_stuck_hold_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates,
                       dmb_stuck_hold *hold);
/* Wrench on a stuck place, in its axes [N, N m]. */
void dmb_stuck_wrench_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates,
                         double w[6]);
#define DMB_STUCK_REACHED (1.0 - 1e-12) /* [-] fraction of the release force at which it releases */
/* [-] Largest force over its release force; 0 if it is not stuck. */
double dmb_stuck_ratio(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates);
/* [-] The same, largest of all stuck places. */
double dmb_stuck_largest_ratio(const dmb_sim *sim, const dmb_configuration *configuration, int rates);

/* State at time 0, as described or as set by its input. */
void dmb_stuck_start(dmb_sim *sim, uint32_t i);
/* Makes it stuck in the accepted pose, or free. */
void dmb_stuck_set(dmb_sim *sim, uint32_t i, int32_t held);

/* Transfers it from a sim of another model with other initial positions: stuck at the same place in the world. */
void dmb_stuck_transfer(dmb_sim *sim, const dmb_sim *from, uint32_t i);

/* ---- Free rigid bodies ------------------------------------------------------------------------------------------- */

/* The free rigid body on a node, or DMB_NONE. */
uint32_t dmb_free_rigid_on(const dmb_scene *scene, uint32_t node);
/* Prediction of the rows of free rigid bodies; the coefficients are those of the other rows. */
void dmb_free_rigids_predict(dmb_sim *sim, const dmb_predict_args *args);
/* Correction of their rows. */
void dmb_free_rigids_correct(dmb_sim *sim, const dmb_correct_args *args);
/* Pose, speeds and accelerations of the trial from prediction and corrections. */
void dmb_free_rigids_place(dmb_sim *sim);
/* Their blocks of the iteration matrix. */
void dmb_free_rigids_matrix(const dmb_evaluation *evaluation);
/* From the 6-vectors of a body: velocity, acceleration, pseudo-acceleration of now to those of its centre of mass,
 * shape (3, 6) each; and an acceleration added to those, shape (6). */
void dmb_free_rigid_start(const dmb_sim *sim, uint32_t rigid, double start[18]);
void dmb_free_rigid_added(const dmb_scene *scene, uint32_t rigid, double acceleration[6]);
/* Unknowns of the iteration: velocity, acceleration, pseudo-acceleration, shape (3, 6). */
static inline double *dmb_free_rigid_motion(const dmb_sim *sim, uint32_t rigid)
{
    return sim->rigid_motion + 18 * (size_t)rigid;
}

#endif
