/* Small scenes for the tests of contact, friction, bits and energy. A body that is guided in some components and meets
 * the wall of a wide hole serves as ball, slider or rotor. */
#ifndef DMB_TESTS_CONTACT_SCENE_H
#define DMB_TESTS_CONTACT_SCENE_H

#include <string.h>

#include "rig.h"

#define CHECK_CLOSE(got, want, tolerance)                                                                             \
    do {                                                                                                              \
        const double got_ = (got), want_ = (want), allowed_ = (tolerance);                                            \
        if (!(fabs(got_ - want_) <= allowed_))                                                                        \
            fail_msg("%s: %.17g, wanted %.17g, off by %.3g > %.3g", #got, got_, want_, fabs(got_ - want_), allowed_); \
    } while (0)
#define CHECK_RELATIVE(got, want, tolerance) CHECK_CLOSE(got, want, (tolerance)*fabs((double)(want)))
#define CHECK_BELOW(got, bound)                                                             \
    do {                                                                                    \
        const double got_ = (got), bound_ = (bound);                                        \
        if (!(got_ <= bound_)) fail_msg("%s: %.17g, must be <= %.17g", #got, got_, bound_); \
    } while (0)

/* An empty model with gravity (0, 0, -g). */
void scene_open(rig *scene, double g);
/* Fails the test with the message of sim or model unless status is >= 0; gives it back. */
int32_t scene_must(const rig *scene, int32_t status);

dmb_id scene_add_bit(rig *scene, const dmb_bit_def *bit);
/* A term h0 before x0, h1 after x1, cubic between. */
dmb_segment scene_step_segment(double x0, double h0, double x1, double h1);

/* A straight hole along x of radius 2.05 m: a ring of 0.1 m on the axis is 2 m away from the wall. */
dmb_wall_def scene_wide_wall(int32_t normal_law, double stiffness, double exponent, double restitution);
/* A body of mass m with a ring of 0.1 m that stands for 1 m of wall, `gap` above the floor of the wide hole. */
dmb_body_def scene_ball(double mass, double gap, int32_t free_mask);

/* World-frame place, displacement and velocity of a body. */
double scene_position(const rig *scene, dmb_id body, int axis);
double scene_displacement(const rig *scene, dmb_id body, int axis);
double scene_speed(const rig *scene, dmb_id body, int component);
double scene_rotation(const rig *scene, dmb_id body);
dmb_contact scene_contact(const rig *scene, uint32_t site);
dmb_model_info scene_info(const rig *scene);
dmb_step_report scene_advance(rig *scene, double time);
dmb_step_report scene_step(rig *scene, double duration);
/* Sum of kinetic and all stored energies [J]. */
double scene_total_energy(const rig *scene);

#endif
