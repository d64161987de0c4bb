/* Contact sites, stops of joints and springs that may open: how steps treat their touch and release
 * (eq:unilateral.mean, eq:contact.mean). Stops and springs are numbered by u: the laws of joints first, then the
 * springs.
 */
#ifndef DMB_SYSTEM_ASSEMBLE_BOUNCES_H
#define DMB_SYSTEM_ASSEMBLE_BOUNCES_H

#include "force/normal_law.h"
#include "force/unilateral.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"

/* Treatment in a step: by its law at the end of the step; by its mean force, as since it touched; the same from this
 * step on, in which it opens. A law that touches in the step has its mean force, too. */
enum { DMB_BOUNCE_LAW = 0, DMB_BOUNCE_OWN = 1, DMB_BOUNCE_OPENS = 2 };
/* Marks of contact sites: beside the mode, the next step has a mean force, too; the history of the step has the mean
 * force; the first beside the age. */
enum { DMB_SITE_STAYS = 4, DMB_SITE_CARRIED = 8, DMB_SITE_MODE = 3, DMB_SITE_OWN = 16 };

/* [-] steps from which on a contact is lasting */
#define DMB_BOUNCE_STEPS 10.0

/* 1: the law may open. */
int dmb_bounce_can_open(const dmb_scene *scene, uint32_t u);
/* [N s/m, N m s/rad] of the damper that acts where the law does. */
/* End of the spring or stop u at a displacement `place`. */
void dmb_bounce_end_at(const dmb_scene *scene, uint32_t u, double place, dmb_unilateral_end *end);
double dmb_bounce_damping(const dmb_scene *scene, uint32_t u);
/* The law at both ends of the step. */
void dmb_bounce_ends(const dmb_sim *sim, uint32_t u, dmb_unilateral_end *a, dmb_unilateral_end *b);
/* Residual of a force [N, N m] against the coordinate of u, added at the nodes of the trial. */
void dmb_bounce_press(dmb_evaluation *evaluation, uint32_t u, double force);
uint32_t dmb_bounce_of_spring(const dmb_scene *scene, uint32_t spring);
/* Coordinate of a law in the trial, its speed, and its force against growing coordinates. */
typedef struct dmb_bounce {
    double place, speed; /* [m, rad], [m/s, rad/s] */
    double force;        /* [N, N m] */
} dmb_bounce;

/* Force at the end of a step that stands for the mean one. */
typedef struct dmb_bounce_force {
    double force;    /* [N, N m] */
    double by_place; /* [N/m, N m/rad] */
    double heat;     /* [W] power into the damper, <= 0, that makes the trapezoidal rule right over the step */
} dmb_bounce_force;

/* Notes the law in the trial. 1: the step takes `own` instead of it. */
int dmb_bounce_at(dmb_evaluation *evaluation, uint32_t u, const dmb_bounce *law, dmb_bounce_force *own);
/* [W] that the damper of a law takes in a configuration, <= 0. */
double dmb_bounce_heat(const dmb_sim *sim, const dmb_configuration *configuration, uint32_t u);

/* The stop of a joint that is open: between its bounds in the trial. */
void dmb_bounce_rest(dmb_sim *sim, uint32_t u);

/* 1: a contact site closes in the step, or another side of the wall. */
int dmb_site_touches(const dmb_sim *sim, uint32_t site);
/* 1: it has a mean force in the step: where the step does not resolve its touch and release (site_coarse). */
int dmb_site_has_mean(const dmb_sim *sim, uint32_t site);
/* 1: some site has. */
int dmb_sites_have_mean(const dmb_sim *sim);
/* A step begins; a step has been tried. */
void dmb_bounces_begin(dmb_sim *sim, double step);
/* 1: laws and sites that were followed open in the step; from then on they are DMB_BOUNCE_OPENS. */
int32_t dmb_bounces_open(dmb_sim *sim);
/* Mean force of a site in the step, per metre. */
void dmb_site_mean_of(const dmb_sim *sim, uint32_t site, double step, dmb_normal_mean *mean);
/* [-] Energy that the step gains because other forces win against the mean forces of contact sites, over the energy
 * that it exchanges with the wall (eq:contact.gain). */
double dmb_bounces_gain(const dmb_evaluation *evaluation);
/* These mean forces are to be in the history of the step: their sites are DMB_SITE_CARRIED from then on. */
void dmb_bounces_carry(dmb_sim *sim);
/* Adds to the rows the mean force of the sites that are DMB_SITE_CARRIED, as the history is to have it, and fills
 * site_history. */
void dmb_bounces_add_carried(const dmb_evaluation *evaluation, double *rows);
/* 1: some law touches or opens between now and trial. */
int32_t dmb_bounces_change(const dmb_sim *sim);
/* Adds to rows (row) what laws that open pressed with at the start of the step; part (node) becomes 1 at their nodes.
 */
void dmb_bounces_release(dmb_evaluation *evaluation, double *rows, double *part);
/* Accelerations of now were made consistent: all laws are followed. */
void dmb_bounces_jump(dmb_sim *sim);
/* Contacts of now count as lasting. */
void dmb_bounces_start(dmb_sim *sim);

#endif
