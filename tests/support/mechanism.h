/* Mechanisms of bars in the plane of world x and z, gravity along -z. Angles count from x towards z, about -y; the axis
 * of a hinge is -y, so its RX is the angle of b's bar less that of a's. */
#ifndef DMB_TESTS_MECHANISM_H
#define DMB_TESTS_MECHANISM_H

#include "rig.h"

extern const dmb_id ground_id;

/* A uniform bar, reference point and body frame at its middle, x along it. */
typedef struct bar {
    double from[2], to[2]; /* [m] world x and z of its ends */
    double mass;           /* [kg] */
} bar;
dmb_body_def bar_body(const bar *def);
dmb_id add_bar(rig *s, const bar *def);

/* One end of a joint: a part, and where on it: along the bar's x from its middle; of the ground: world x and z. */
typedef struct pin {
    dmb_id part;
    double x, z;
} pin;
pin pin_ground(double x, double z);
pin pin_on(dmb_id part, double x);
/* A joint of that kind with both frames' x along -y and y along the bars (of the ground: world x). */
dmb_joint_def hinge_of(const char *name, int32_t kind, pin a, pin b);
dmb_id add_hinge(rig *s, const char *name, int32_t kind, pin a, pin b);

dmb_joint_state joint_at(const rig *s, dmb_id joint);
/* Multipliers of a joint, coupling, constraint or drive; how many there are. */
uint32_t multipliers_of(const rig *s, dmb_id part, double multipliers[6]);
/* Moving poses of two sims: largest difference of position, rotation and velocity over bodies of the same order. */
double motion_difference(const rig *a, const rig *b, const dmb_id *parts_a, const dmb_id *parts_b, uint32_t count);

/* [J] Kinetic energy and strain; the largest in steps of length h over that before them, which may be divided. */
double energy_now(const rig *s);
double largest_energy(const rig *s, double h, uint32_t steps);

/* Options with that spectral radius, Newton to `tolerance`. */
dmb_sim_options sharp_options(double spectral_radius, double tolerance);

/* Compiles and makes the sim, telling on failure what the log said. Status of dmb_sim_create, >= 0. */
int32_t mechanism_start(rig *s, const dmb_sim_options *options);

/* A model that dmb_sim_create must refuse with `status`; what the sim's log said last. */
typedef struct refusal {
    int32_t status;
    char text[512];
} refusal;
refusal refused_start(rig *s);

#endif
