/* Contact points, stops of joints and springs: treatment of their touch and release in steps (eq:unilateral.mean,
 * eq:contact.mean), and of springs whose gradient turns (eq:unilateral.holding). Stops and springs have the common
 * index u: stops of joints first, then springs between points, then springs of joints. */
#ifndef DMB_SYSTEM_ASSEMBLE_BOUNCES_H
#define DMB_SYSTEM_ASSEMBLE_BOUNCES_H

#include "force/normal_law.h"
#include "force/unilateral.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* Treatment of a contact in a step, and its transitions (bounce_end.c decides those at the end of a step):
 *     LAW     force of the law at the end of the step
 *     OWN     mean force over the step, from the step after touch on, until resolved or lasting
 *     OPENS   mean force, in the step in which a contact treated by its law opens
 *
 *     LAW --touches, stiff for the step--> OWN --opens, resolved or lasting--> LAW
 *     LAW --opens within the step--> OPENS --> LAW, open
 * A contact that touches in the step has its mean force already there. */
enum { DMB_BOUNCE_LAW = 0, DMB_BOUNCE_OWN = 1, DMB_BOUNCE_OPENS = 2 };
/* Marks of contact points: with the mode, the next step has a mean force too; with the mode, the history of the step
 * contains the mean force; mask of the mode; with the age, as the first. */
enum { DMB_SITE_STAYS = 4, DMB_SITE_CARRIED = 8, DMB_SITE_MODE = 3, DMB_SITE_OWN = 16 };

/* [-] number of steps after which a contact counts as lasting */
#define DMB_BOUNCE_STEPS 10.0

/* 1: the law may open. */
int dmb_bounce_can_open(const dmb_scene *scene, uint32_t u);
/* 1: the law is a spring that acts on both sides and is never open. */
int dmb_bounce_holds(const dmb_scene *scene, uint32_t u);
/* 1: one of both. */
int dmb_bounce_acts(const dmb_scene *scene, uint32_t u);
/* Index of the spring of a law of a joint. */
uint32_t dmb_bounce_of_law(const dmb_scene *scene, uint32_t law);
/* Law of a joint whose stop or spring u is, and its joint; DMB_NONE: u is a spring between points. */
uint32_t dmb_bounce_law_of(const dmb_scene *scene, uint32_t u);
uint32_t dmb_bounce_joint_of(const dmb_scene *scene, uint32_t law);
/* State of law u at one end of a step, with displacement `place`. */
void dmb_bounce_end_at(const dmb_scene *scene, uint32_t u, double place, dmb_unilateral_end *end);
/* [N s/m, N m s/rad] Damping while the law acts. */
double dmb_bounce_damping(const dmb_scene *scene, uint32_t u);
/* State of law u at both ends of the step. */
void dmb_bounce_ends(const dmb_sim *sim, uint32_t u, dmb_unilateral_end *a, dmb_unilateral_end *b);
/* Residual of a force [N, N m] against the coordinate of u, added at the nodes of a configuration; of a mean force,
 * along the mean gradient of both ends of the step (eq:unilateral.turning). */
void dmb_bounce_press(dmb_evaluation *evaluation, const dmb_configuration *at, uint32_t u, double force);
void dmb_bounce_press_mean(dmb_evaluation *evaluation, uint32_t u, double force);
/* 1: the rotation of the node is integrated in axes that turn with it, in which mean forces have the mean gradient. */
int dmb_bounce_turns(const dmb_sim *sim, uint32_t node);
/* Carries a wrench on a node at the start of the step to its end: of a free rigid body, the force keeps its direction
 * and the couple about the centre of mass turns with the body (eq:unilateral.free-rigid); others turn as a whole.
 * tangent, shape (6, 3), or NULL: its derivative by the rotation of the node at the end. */
void dmb_bounce_carry(const dmb_sim *sim, uint32_t node, double w[6], double *tangent);
/* Increments of a node in the step, with the spin of a rotor; 0 of the ground. */
void dmb_bounce_travel(const dmb_sim *sim, uint32_t node, double z[6]);
/* Adds couples about the rotation of the step to the mean gradients of both parts, so that their change of the
 * coordinate by the increment of the step is the one that there is. */
void dmb_bounce_close_gap(const dmb_sim *sim, uint32_t u, uint32_t a, double Ja[6], uint32_t b, double Jb[6]);
/* Adds `factor` times the force by which gyroscopic forces have no power in a step with mean forces
 * (eq:unilateral.gyroscopic), and its tangent. */
void dmb_bounces_add_gyroscopic(dmb_evaluation *evaluation, double factor);
/* Adds it once if a mean force has acted in the step. It stays if mean forces vanish again in a later iteration, until
 * the stage ends: without it such steps of bodies that turn by 1 rad have other solutions, whose energy grows without
 * bound (physics_spinning_stops). */
void dmb_bounces_turn(dmb_evaluation *evaluation);
/* Marks the laws that a step of length h [s] does not resolve and whose gradient turns in it (bounce_turns), by the
 * speeds at its start, or as reached in the trial. They have mean forces (eq:unilateral.holding). */
void dmb_bounces_mark_turning(dmb_sim *sim, double h, int reached);
/* 1: the force of the law, or of another one of its joint, changes in the trial by another amount than by the rates of
 * its place at both ends, which are the speeds and the bias of mean forces (eq:unilateral.bias). */
int dmb_bounce_is_unresolved(const dmb_sim *sim, uint32_t u, double h);
/* Node that a step with mean forces has turned much further than the speed at its start would: another solution of its
 * equations, about a turn away. DMB_NONE: none. */
uint32_t dmb_bounces_overturn(const dmb_sim *sim, double h);
uint32_t dmb_bounce_of_spring(const dmb_scene *scene, uint32_t spring);
/* Coordinate of a law in the trial, its speed, and its force against growing coordinates. */
typedef struct dmb_bounce {
    double place, speed; /* [m, rad], [m/s, rad/s] */
    double force;        /* [N, N m] */
} dmb_bounce;

/* Force at the end of a step equivalent to the mean force over it. */
typedef struct dmb_bounce_force {
    double force;    /* [N, N m] */
    double by_place; /* [N/m, N m/rad] */
    double heat;     /* [W] power into the damper, <= 0, that makes the trapezoidal rule right over the step */
} dmb_bounce_force;

/* Stores the law in the trial. 1: the step uses `own` instead of it. */
int dmb_bounce_at(dmb_evaluation *evaluation, uint32_t u, const dmb_bounce *law, dmb_bounce_force *own);
/* [W] Power of the damper of a law in a configuration, <= 0. */
double dmb_bounce_heat(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t u);

/* DMB_POWER_... of the damper of a law. */
int dmb_bounce_power(const dmb_sim *sim, uint32_t u);

/* Stores a stop as open: the coordinate is between its bounds in the trial. */
void dmb_bounce_rest(dmb_sim *sim, uint32_t u);

/* 1: a contact point touches in the step, or changes to another side of the wall. */
int dmb_site_touches(const dmb_sim *sim, uint32_t site);
/* 1: it has a mean force in the step, because the step does not resolve its touch and release (site_coarse). */
int dmb_site_has_mean(const dmb_sim *sim, uint32_t site);
/* 1: some contact point has a mean force. */
int dmb_sites_have_mean(const dmb_sim *sim);
/* Start of a step: `step` [s] decides which contacts it resolves. */
void dmb_bounces_begin(dmb_sim *sim, double step);
/* 1: laws and contact points that were treated by their law open in the step of length [s], or begin to have mean
 * forces because they turn; they are DMB_BOUNCE_OPENS from then on. */
int32_t dmb_bounces_open(dmb_sim *sim, double step);
/* Mean force of a contact point in the step, per metre. */
void dmb_site_mean_of(const dmb_sim *sim, uint32_t site, double step, dmb_normal_mean *mean);
/* [-] Energy gained by the step because other forces exceed the mean forces of contact points, over the energy
 * exchanged with the wall (eq:contact.gain). */
double dmb_bounces_gain(const dmb_evaluation *evaluation);
/* Puts these mean forces into the history of the step: their contact points become DMB_SITE_CARRIED. */
void dmb_bounces_carry(dmb_sim *sim);
/* Adds the mean forces of DMB_SITE_CARRIED contact points to the rows, as in the history, and fills site_history. */
void dmb_bounces_add_carried(const dmb_evaluation *evaluation, double *rows);
/* 1: some law touches or opens between now and trial. */
int32_t dmb_bounces_change(const dmb_sim *sim);
/* Adds the forces at the start of the step of opening laws to rows (row); part (node) becomes 1 at their nodes. */
void dmb_bounces_release(dmb_evaluation *evaluation, double *rows, double *part);
/* After consistent accelerations were computed for now: all contacts are treated by their laws. */
void dmb_bounces_jump(dmb_sim *sim);
/* Marks contacts of now as lasting. */
void dmb_bounces_start(dmb_sim *sim);

#endif
