/* Terms of the residual and its tangent: each has a source of its own, and dmb_system_evaluate (evaluation.c) takes
 * them in a fixed order. Drives and forces of the caller have headers of their own. */
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

/* force = factor M change, both by rows, with masses lumped on the nodes: sideways what both ends of an element have
 * together, rotation across the axis by itself. */
void dmb_inertia_of_change(const dmb_scene *scene, const double *change, double factor, double *force);

/* ---- Springs and joints ------------------------------------------------------------------------------------------ */

/* Residual of a force alone, in the trial: tension [N] of a spring; force [N, N m] against coordinate `component` of
 * joint j. */
void dmb_spring_press(dmb_sim *sim, uint32_t spring, double tension);
void dmb_joint_press(dmb_evaluation *evaluation, uint32_t j, uint32_t component, double force);

/* ---- Nodes and loads --------------------------------------------------------------------------------------------- */

void dmb_assemble_nodes(dmb_evaluation *evaluation);
void dmb_assemble_added_masses(dmb_evaluation *evaluation);
void dmb_assemble_loads(dmb_evaluation *evaluation);
void dmb_assemble_flow(dmb_evaluation *evaluation);

/* Described loads that act at a point inside an element, or off the axis of a node. */

/* factor times the load; frame (body to world) of its components unless it follows the body. */
/* Wrench of a load at a point, in the axes of the point [N, N m], at the load factor of the configuration. */
void dmb_point_load_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t load, double w[6]);
void dmb_assemble_point_load(dmb_evaluation *evaluation, const dmb_scene_load *load, double factor,
                             const double frame[9]);

/* ---- The wall ---------------------------------------------------------------------------------------------------- */

typedef struct dmb_contact_slope {
    double normal_by_depth;       /* [N/m] 0 of an open site, and of axial-torsional sites, whose force is that of their
                                     tension */
    double normal_by_rate;        /* [N s/m] */
    double friction_by_slip[4];   /* [N s/m] shape (2, 2) */
    double friction_by_normal[2]; /* [-] shape (2) */
} dmb_contact_slope;

/* site: counted as dmb_query_contact does. Friction without memory only: of bristles what they are once they slide. */
void dmb_contact_slope_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site,
                          dmb_contact_slope *out);
/* Of a ring of a six-DOF node in the trial just evaluated: normal n and, for a unit of normal force, what friction adds
 * to the side of the forces that balance the wall, f = -(F_t j_t + F_b j_b) with its moment about the node, both in
 * body axes. 0: it does not touch or not slip. */
int dmb_contact_friction_by_normal(const dmb_evaluation *evaluation, uint32_t site, double n[3], double f[6]);
/* Law of friction at a site, counted likewise: that of the scene, or `local` with the coefficients of a section. */
const dmb_friction_law *dmb_contact_friction_law(const dmb_scene *scene, const dmb_configuration *configuration,
                                                 uint32_t site, dmb_friction_law *local);
/* Node of a site. */
uint32_t dmb_contact_node(const dmb_scene *scene, uint32_t site);

/* Rings on six-DOF nodes against the wall of the hole: normal and friction force in the contact frame
 * (n outward from the axis, t along the axis, b = t x n). */

typedef struct dmb_site_force {
    double normal[3];    /* [-] world */
    double tangent[3];   /* [-] world, along the axis */
    double penetration;  /* [m] */
    double rate;         /* [m/s] of penetration */
    double normal_force; /* [N] >= 0 */
    double along;        /* [N] on the ring along t, where radius or stiffness of the wall change */
    double rho;          /* [-] part of it that goes with the normal force */
    double friction[2];  /* [N] on the ring along t and b */
    double slip[2];      /* [m/s] along t and b */
    int32_t closed, sticks;
} dmb_site_force;

/* Force of one site in a finished configuration (bristles as they are). */
void dmb_site_force_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site,
                       dmb_site_force *out);
/* Its forces as the step had them that ends in the configuration, which in steps about touch are not those of the law.
 */
void dmb_site_take_weighted(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t site,
                            dmb_site_force *force);
/* Friction of a site under the normal force in `force`, at the slip there; bristles off the wall as in sliding. */
void dmb_site_rub(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site, dmb_site_force *force);
/* [N] that the wall stores of the normal force of a site in `force`. */
double dmb_site_elastic_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site,
                              const dmb_site_force *force);
/* Adds factor times the force of a site in `force` to generalised forces, shape (row). */
void dmb_site_add_force(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t site, double factor,
                        const dmb_site_force *force, double *rows);
/* The same for an axial-torsional site; normal_force by Johancsik. */
void dmb_axial_torsional_site_force(const dmb_scene *scene, const dmb_configuration *configuration,
                                    uint32_t axial_torsional_site, dmb_site_force *out);

/* Friction of a finished state under the normal force and at the slip in `out`: bristles as they are (NULL where the
 * law has none), smooth laws by speed. */
void dmb_finished_friction(const dmb_friction_law *law, const double *bristle, int32_t sticks, dmb_site_force *out);
/* The law of bristles in steady sliding, F = -mu N v/|v|, without a memory. */
dmb_friction_law dmb_sliding_law(const dmb_friction_law *law);
/* Friction of a site of this radius in a static state that assumed a slip, in place of that of the speeds: by the
 * smooth law under the normal force in `out`, as its equilibrium took it. Nothing where none was assumed. */
void dmb_assumed_friction(const dmb_friction_law *law, const dmb_configuration *configuration, double radius,
                          dmb_site_force *out);

/* Contact site s of now is at that measured depth [m]: where its search for the axis starts. */
void dmb_contact_place(dmb_sim *sim, uint32_t s, double depth);
/* Memory of contacts in the configurations: normals and depths of now at the start; the slip that friction of the trial
 * acts as at, by the evaluation, and that of the trial into now; no bristle of the trial is deflected and no contact
 * has begun; bristles of now are where they are while their rings slide on as they do. */
void dmb_contacts_start(dmb_sim *sim);
void dmb_contacts_follow_assembly(dmb_sim *sim);
void dmb_contacts_assume_slip(const dmb_evaluation *evaluation);
void dmb_contacts_take_slip(dmb_sim *sim);
void dmb_contacts_take_touch(dmb_sim *sim);
void dmb_contacts_forget(dmb_sim *sim);
void dmb_contacts_slide(dmb_sim *sim);

void dmb_assemble_contacts(dmb_evaluation *evaluation);
/* All rings on nodes, in pieces where they are many. */
void dmb_press_rings(const dmb_sim *sim, dmb_wall_args *args);
/* The rings inside elements that waited. */
void dmb_contacts_accept(dmb_evaluation *evaluation);
void dmb_assemble_axial_torsional_friction(dmb_evaluation *evaluation);

/* Rings inside elements: contact along the element, at integration points of its own interpolation. They are the last
 * of the sites. */

/* Section that ring s is fixed to. */
static inline const dmb_scene_point *dmb_inside_point(const dmb_scene *scene, uint32_t s)
{
    return scene->inside + (s - dmb_node_sites(scene));
}

/* The force of all of them and its tangent. job: that of the rings on nodes, whose laws and sums serve here too. Within
 * a step rings that cannot touch wait until it is accepted (waiting 1: these alone), and are as open as before. */
void dmb_assemble_contacts_inside(dmb_evaluation *evaluation, int waiting, dmb_wall_args *args);

/* Axes of the body that ring s is on, body to world. Any site. */
void dmb_site_axes(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double R[9]);
/* rows += factor times the wrench w at the centre of ring s, in its body axes, on the rows of its nodes. Any site. */
void dmb_site_add_wrench(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t s, double factor,
                         const double w[6], double *rows);

/* ---- Bits -------------------------------------------------------------------------------------------------------- */

typedef struct dmb_bit_rock_result dmb_bit_rock_result;

/* Rock law's answer and the bottom-hole load [N] of a bit in the accepted state. */
void dmb_bit_force_of(const dmb_sim *sim, uint32_t bit, dmb_bit_rock_result *out, double *load);
/* [N] of the rock across the bit's axis, world frame; the speed across it [m/s]. 0 where it does not cut sideways. */
double dmb_bit_side_of(const dmb_sim *sim, uint32_t k, double force[3]);
/* [m/s] of a bit along the axis of the hole in the accepted state, the rate of its advance. */
double dmb_bit_speed_of(const dmb_sim *sim, uint32_t bit);
/* Motion of a bit along and about the axis of the hole, in the body frame of its node, and slopes of weight and torque
 * by advance, angle, speed and spin. */
typedef struct dmb_bit_slope {
    double along[6], about[6];
    double weight[4]; /* [N/m, N/rad, N s/m, N s/rad] */
    double torque[4]; /* [N, N m/rad, N s, N m s/rad] */
} dmb_bit_slope;
void dmb_bit_slope_of(const dmb_sim *sim, uint32_t bit, dmb_bit_slope *out);
/* The history of a bit as the rock law takes it. */
dmb_bit_history dmb_bit_history_of(const dmb_sim *sim, uint32_t bit);
/* Flat rock at the described distance, at the start. */
void dmb_bit_start(dmb_sim *sim, uint32_t bit);
/* A bit with the rate law, at the rock, that hardly turned before a step or in it, and how fast [rad/s]; DMB_NONE. */
uint32_t dmb_bit_near_rest(const dmb_sim *sim, double *spin);
/* 1: the bit stands on the rock; at time 0 as described. */
int dmb_bit_on_bottom(const dmb_sim *sim, uint32_t bit);
/* Rock as after drilling on for long at the speed and spin of the accepted state. */
void dmb_bit_start_steady(dmb_sim *sim, uint32_t bit);
/* Stores what a finished step cut. */
void dmb_bit_accept(const dmb_evaluation *evaluation, uint32_t bit);

void dmb_assemble_bits(dmb_evaluation *evaluation);

/* ---- The hole that cutters leave -------------------------------------------------------------------------------- */

/* The hole is as wide as a cutter from its rear end, or from where its bottom was [m of advance], to its face. */
void dmb_hole_make_room(dmb_sim *sim, uint32_t bit, double before);
/* After a step was taken, which trial was before: stations that faces came up to in it. 1: rings touch the wall where
 * it gave way, so accelerations are to be made consistent. O(number of bits), of sites too where a station is cut. */
int dmb_hole_cut(dmb_sim *sim);

/* ---- Springs between points -------------------------------------------------------------------------------------- */

typedef struct dmb_spring_motion {
    dmb_point_motion a, b;
    double n[3];         /* [-] from a to b, world; shorter than 1 only where the points nearly meet */
    double length, rate; /* [m], [m/s] */
    dmb_spring_force force;
} dmb_spring_motion;

/* rates 0: as in statics */
void dmb_spring_motion_of(const dmb_scene *scene, const dmb_configuration *configuration, uint32_t spring, int rates,
                          dmb_spring_motion *motion);
/* The tangents are cleared before, where constraints have none. */
void dmb_assemble_springs(dmb_evaluation *evaluation);
/* [J] stored in all springs */
double dmb_springs_energy(const dmb_scene *scene, const dmb_configuration *configuration);

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

/* Terms of joints in the residual: springs, dampers, stops, friction and drives along their coordinates, and the forces
 * of constraint; and the tangent of all that. A generalised force f on a coordinate with gradient J is the wrench J^T
 * f. */

/* Onto constraint_tangent, which is cleared before. */
int32_t dmb_assemble_joints(dmb_evaluation *evaluation);

/* ---- Stuck places ------------------------------------------------------------------------------------------------ */

enum { DMB_STUCK_COORDINATES = 4 }; /* along, sideways y and z, about the axis */

/* Offset and force of a place that is held, in the axes of the anchor. */
typedef struct dmb_stuck_hold {
    double s[DMB_STUCK_COORDINATES];     /* [m, m, m, rad] */
    double force[DMB_STUCK_COORDINATES]; /* [N, N, N, N m] k s + c s', on the ground */
} dmb_stuck_hold;

/* Residual, tangent and powers of all places that are stuck. */
void dmb_assemble_stuck(dmb_evaluation *evaluation);
/* [J] stored in their springs. */
double dmb_stuck_energy(const dmb_sim *sim, const dmb_configuration *configuration);
/* Of a place that is stuck; without rates the dampers do not act. */
void dmb_stuck_hold_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates,
                       dmb_stuck_hold *hold);
/* Wrench on a place that is stuck, in its axes [N, N m]. */
void dmb_stuck_wrench_of(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates,
                         double w[6]);
#define DMB_STUCK_REACHED (1.0 - 1e-12) /* [-] share from which on it lets go */
/* [-] Largest force over that at which it lets go; 0 where it is not stuck. */
double dmb_stuck_share(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t i, int rates);
/* [-] The largest of all places. */
double dmb_stuck_largest_share(const dmb_sim *sim, const dmb_configuration *configuration, int rates);

/* At time 0, as described or as its input says. */
void dmb_stuck_start(dmb_sim *sim, uint32_t i);
/* In the accepted pose it gets stuck, or free. */
void dmb_stuck_set(dmb_sim *sim, uint32_t i, int32_t held);

/* From a sim of another model, whose nodes begin elsewhere: stuck where it was in the world. */
void dmb_stuck_transfer(dmb_sim *sim, const dmb_sim *from, uint32_t i);

/* ---- Free rigid bodies ------------------------------------------------------------------------------------------- */

/* Their rows of the prediction; the coefficients are those of the run. */
void dmb_free_rigids_predict(dmb_sim *sim, const dmb_predict_args *args);
/* Their rows of a correction. */
void dmb_free_rigids_correct(dmb_sim *sim, const dmb_correct_args *args);
/* Pose, speeds and accelerations of the trial from what was predicted and corrected. */
void dmb_free_rigids_place(dmb_sim *sim);
/* Their blocks of the iteration matrix. */
void dmb_free_rigids_matrix(const dmb_evaluation *evaluation);
/* From the 6-vectors of a body: velocity, acceleration, pseudo-acceleration of now to those of its centre of mass,
 * shape (3, 6) each; and an acceleration that is added to those, shape (6). */
void dmb_free_rigid_start(const dmb_sim *sim, uint32_t rigid, double start[18]);
void dmb_free_rigid_added(const dmb_scene *scene, uint32_t rigid, double acceleration[6]);
/* Unknowns of the iteration: velocity, acceleration, pseudo-acceleration, shape (3, 6). */
static inline double *dmb_free_rigid_motion(const dmb_sim *sim, uint32_t rigid)
{
    return sim->rigid_motion + 18 * (size_t)rigid;
}

#endif
