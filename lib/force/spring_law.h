/* Force of a spring and damper along the line between two points. e = elongation beyond the free length [m], s = its
 * rate [m/s], tension > 0:
 *
 *     elastic p + k e + T(e), p preload, T a table, straight lines or a monotone cubic through its points;
 *     damper  c s
 *
 * TENSION: the elastic force acts where it pulls, from the elongation `slack` on, and the damper there too, as long as
 * the sum pulls; COMPRESSION: likewise where they push. A one-sided characteristic never falls, so there is one slack.
 * Beyond its ends a table goes on along its last slope. The cubic is that of Fritsch and Butland 1984 (harmonic means
 * of the neighbouring slopes, 0 at extrema): monotone data stay monotone, and T' is continuous. */
#ifndef DMB_FORCE_SPRING_LAW_H
#define DMB_FORCE_SPRING_LAW_H

#include <stdint.h>

typedef struct dmb_spring_point {
    double elongation; /* [m] */
    double force;      /* [N] */
    double slope[2];   /* [N/m] of the piece behind it, at its begin and at its end */
    double energy;     /* [J] integral of T from the first point */
} dmb_spring_point;

typedef struct dmb_spring_law {
    double stiffness, damping, preload;
    double slack;          /* [m] elongation at which a one-sided force begins */
    double zero;           /* [J] integral of the table at elongation 0, or at slack */
    uint32_t first, count; /* its points */
    int32_t acts;          /* DMB_SPRING_... */
    int32_t reserved;
} dmb_spring_law;

typedef struct dmb_spring_force {
    double elastic, damper;         /* [N] tension > 0 */
    double by_elongation, by_speed; /* [N/m, N s/m] of their sum */
} dmb_spring_force;

/* Slopes and energies of count >= 2 points with elongations that increase; cubic 0: straight lines. */
void dmb_spring_table_prepare(dmb_spring_point *points, uint32_t count, int cubic);
/* slack and zero of a law; points: its own. 0: a one-sided force that begins nowhere or everywhere. */
int dmb_spring_law_prepare(dmb_spring_law *law, const dmb_spring_point *points);
/* points: its own, may be NULL where count is 0 */
void dmb_spring_force_at(const dmb_spring_law *law, const dmb_spring_point *points, double elongation, double speed,
                         dmb_spring_force *force);
/* [J] integral of the elastic force from elongation 0, of a one-sided one from slack */
double dmb_spring_energy_at(const dmb_spring_law *law, const dmb_spring_point *points, double elongation);

/* Force along one joint coordinate x with speed s, and its exact derivatives:
 *
 *     spring -k (x - rest), damper -c s, friction -f s/sqrt(s^2 + s0^2),
 *     stop at the bounds: -(K d + c_s d'), d = depth beyond the bound, never pulling (max(0, .))
 *
 * A bound of 1e29 or more is none; a stop with K = 0 neither. */

typedef struct dmb_joint_law {
    double stiffness, damping, rest;
    double friction, friction_speed;
    double stop_low, stop_high, stop_stiffness, stop_damping;
} dmb_joint_law;

typedef struct dmb_joint_force {
    double force;                    /* [N, N m] on the coordinate, > 0 towards larger values: sum of the next five */
    double spring, damper, friction; /* [N, N m] shares */
    double stop, stop_damper;        /* [N, N m] elastic share of the stop, and what its damper adds or takes back */
    double by_position, by_speed;    /* derivatives of force */
} dmb_joint_force;

/* 1 if the law can ever give a force. */
int dmb_joint_law_acts(const dmb_joint_law *law);
void dmb_joint_force_at(const dmb_joint_law *law, double position, double speed, dmb_joint_force *force);
/* [m, rad] beyond the stops, with the sign of the side: > 0 above stop_high, < 0 below stop_low, 0 between. */
double dmb_joint_stop_depth(const dmb_joint_law *law, double position);
/* [J] k (x - rest)^2/2 + K d^2/2 */
double dmb_joint_law_energy(const dmb_joint_law *law, double position);

#endif
