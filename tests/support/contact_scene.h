/* Small scenes for the tests of contact, friction, bits and energy. A body that is guided in some components and meets
 * the wall of a wide hole serves as ball, slider or rotor. */
#ifndef DMB_TESTS_CONTACT_SCENE_H
#define DMB_TESTS_CONTACT_SCENE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"

#define PI 3.14159265358979323846

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

typedef struct contact_scene {
    dmb_model *model;
    dmb_sim *sim;
} contact_scene;

/* An empty model with gravity (0, 0, -g). */
void scene_open(contact_scene *scene, double g);
/* Compiles and makes the sim; each may be NULL for the defaults. */
void scene_start(contact_scene *scene, const dmb_compile_options *compile, const dmb_sim_options *options);
void scene_close(contact_scene *scene);
/* Fails the test with the message of sim or model unless status is >= 0; gives it back. */
int32_t scene_must(const contact_scene *scene, int32_t status);

void scene_add_wall(contact_scene *scene, const dmb_wall_def *wall);
dmb_id scene_add_body(contact_scene *scene, const dmb_body_def *body);
dmb_id scene_add_pipes(contact_scene *scene, const dmb_pipe_def *pipe, uint32_t count);
dmb_id scene_add_string(contact_scene *scene, const dmb_string_def *string);
dmb_id scene_add_bit(contact_scene *scene, const dmb_bit_def *bit);
dmb_id scene_add_load(contact_scene *scene, const dmb_load_def *load);
dmb_id scene_add_drive(contact_scene *scene, const dmb_drive_def *drive);
dmb_id scene_add_terms(contact_scene *scene, const dmb_term *terms, uint32_t count);
dmb_id scene_add_constant(contact_scene *scene, double value);
/* A term h0 before x0, h1 after x1, cubic between. */
dmb_term scene_step_term(double x0, double h0, double x1, double h1);

/* A straight hole along x of radius 2.05 m: a ring of 0.1 m on the axis is 2 m away from the wall. */
dmb_wall_def scene_wide_wall(int32_t normal_law, double stiffness, double exponent, double restitution);
/* A body of mass m with a ring of 0.1 m that stands for 1 m of wall, `gap` above the floor of the wide hole. */
dmb_body_def scene_ball(double mass, double gap, int32_t free_mask);

/* World-frame place, displacement and velocity of a body. */
double scene_position(const contact_scene *scene, dmb_id body, int axis);
double scene_displacement(const contact_scene *scene, dmb_id body, int axis);
double scene_speed(const contact_scene *scene, dmb_id body, int component);
double scene_rotation(const contact_scene *scene, dmb_id body);
dmb_contact scene_contact(const contact_scene *scene, uint32_t site);
dmb_energy scene_energy(const contact_scene *scene);
dmb_statistics scene_statistics(const contact_scene *scene);
dmb_model_info scene_info(const contact_scene *scene);
dmb_step_report scene_advance(contact_scene *scene, double time);
dmb_step_report scene_step(contact_scene *scene, double duration);
uint64_t scene_hash(const contact_scene *scene);
/* Sum of kinetic and all stored energies [J]. */
double scene_total_energy(const contact_scene *scene);

#endif
