/* Force of a spring and damper along the line between two points. e = elongation beyond the free length [m], s = its
 * rate [m/s], tension > 0:
 *
 *     elastic p + k e + T(e), p preload, T a table, linear or a monotone cubic through its points;
 *     damper  c s
 *
 * TENSION: the elastic force acts for elongations above `slack`, where it pulls; the damper acts there as long as the
 * total force pulls. COMPRESSION: both act for elongations below `slack`, as long as the total force pushes. A
 * one-sided characteristic never decreases, so that slack is unique. Beyond its ends a table continues with its last
 * slope. The cubic is that of Fritsch and Butland 1984 (harmonic means of the neighbouring slopes, 0 at extrema):
 * monotone data stay monotone, and T' is continuous. */
#ifndef DMB_FORCE_SPRING_LAW_H
#define DMB_FORCE_SPRING_LAW_H

#include <stdint.h>

typedef struct dmb_spring_point {
    double elongation; /* [m] */
    double force;      /* [N] */
    double slope[2];   /* [N/m] of the segment after the point, at its begin and at its end */
    double energy;     /* [J] integral of T from the first point */
} dmb_spring_point;

typedef struct dmb_spring_law {
    double stiffness, damping, preload;
    double slack; /* [m] elongation at which a one-sided force begins */
    double zero;  /* [J] integral of the two-sided elastic force at slack; of a two-sided spring at elongation 0 */
    uint32_t first, count; /* its table points */
    int32_t acts;          /* DMB_SPRING_... */
    int32_t reserved;
} dmb_spring_law;

typedef struct dmb_spring_force {
    double elastic, damper;         /* [N] tension > 0 */
    double by_elongation, by_speed; /* [N/m, N s/m] of their sum */
} dmb_spring_force;

/* Sets slopes and energies of count >= 2 points with increasing elongations; cubic 0: linear. */
void dmb_spring_table_prepare(dmb_spring_point *points, uint32_t count, int cubic);
/* Sets slack and zero of a law; points: its table. Returns 0 if a one-sided force begins nowhere or acts everywhere. */
int dmb_spring_law_prepare(dmb_spring_law *law, const dmb_spring_point *points);
/* points: the table of the law; may be NULL if count is 0 */
void dmb_spring_force_at(const dmb_spring_law *law, const dmb_spring_point *points, double elongation, double speed,
                         dmb_spring_force *force);
/* [J] integral of the elastic force from elongation 0, for a one-sided spring from slack */
double dmb_spring_energy_at(const dmb_spring_law *law, const dmb_spring_point *points, double elongation);

/* Force along one joint coordinate x with speed s, and its exact derivatives:
 *
 *     spring -k (x - rest), damper -c s, friction -f s/sqrt(s^2 + s0^2),
 *     stop at the bounds: -(K d + c_s d'), d = depth beyond the bound, never pulling (max(0, .))
 *
 * A bound of 1e29 or more counts as none, as does a stop with K = 0. */

typedef struct dmb_joint_law {
    double stiffness, damping, rest;
    double friction, friction_speed;
    double stop_low, stop_high, stop_stiffness, stop_damping;
} dmb_joint_law;

typedef struct dmb_joint_force {
    double force;                    /* [N, N m] on the coordinate, > 0 towards larger values: sum of the next five */
    double spring, damper, friction; /* [N, N m] contributions */
    double stop, stop_damper;        /* [N, N m] elastic force of the stop, and the contribution of its damper */
    double by_position, by_speed;    /* derivatives of force */
} dmb_joint_force;

/* 1 if the law can produce a force. */
int dmb_joint_law_acts(const dmb_joint_law *law);
void dmb_joint_force_at(const dmb_joint_law *law, double position, double speed, dmb_joint_force *force);
/* [m, rad] beyond the stops, with the sign of the side: > 0 above stop_high, < 0 below stop_low, 0 between. */
double dmb_joint_stop_depth(const dmb_joint_law *law, double position);
/* [J] k (x - rest)^2/2 + K d^2/2 */
double dmb_joint_law_energy(const dmb_joint_law *law, double position);

#endif
