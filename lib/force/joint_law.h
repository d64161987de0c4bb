/* Force along one joint coordinate x with speed s, and its exact derivatives:
 *
 *     spring -k (x - rest), damper -c s, friction -f s/sqrt(s^2 + s0^2),
 *     stop at the bounds: -(K d + c_s d'), d = depth beyond the bound, never pulling (max(0, .))
 *
 * A bound of 1e29 or more is none; a stop with K = 0 neither. */
#ifndef DMB_FORCE_JOINT_LAW_H
#define DMB_FORCE_JOINT_LAW_H

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
/* [J] k (x - rest)^2/2 + K d^2/2 */
double dmb_joint_law_energy(const dmb_joint_law *law, double position);

#endif
