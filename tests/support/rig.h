/* The subject of a physics test: a model and its sim, with refusals turned into failures that tell the library's
 * message. */
#ifndef DMB_TESTS_RIG_H
#define DMB_TESTS_RIG_H

#include <drillmbd/drillmbd.h>

#include "check.h"

typedef struct rig {
    dmb_model *model;
    dmb_sim *sim;
} rig;

/* An empty model, gravity [m/s2] in world axes. */
void rig_open(rig *s, double gx, double gy, double gz);
/* Compiles and makes the sim; options may be NULL. Returns the status of dmb_sim_create, >= 0. */
int32_t rig_start(rig *s, const dmb_sim_options *options);
int32_t rig_start_with(rig *s, const dmb_compile_options *compile, const dmb_sim_options *options);
void rig_close(rig *s);

/* Fails with the message of the model or the sim when status < 0. */
void must_model(const rig *s, int32_t status);
void must(const rig *s, int32_t status);
/* Fails unless the status is the wanted one and the message has these words in it; prints the message. */
void must_refuse(const char *message, int32_t status, int32_t wanted, const char *words);

/* Parts, added with a check. */
dmb_id add_string(rig *s, const dmb_string_def *def);
dmb_id add_pipes(rig *s, const dmb_pipe_def *def, uint32_t count);
dmb_id add_body(rig *s, const dmb_body_def *def);
dmb_id add_wall(rig *s, const dmb_wall_def *def);
dmb_id add_drive(rig *s, const dmb_drive_def *def);
dmb_id add_load(rig *s, const dmb_load_def *def);
dmb_id add_joint(rig *s, const dmb_joint_def *def);
/* A joint of that kind between two places with all else by default; and the same, added. */
dmb_joint_def joint_between(int32_t kind, dmb_place a, dmb_place b);
dmb_id add_joint_between(rig *s, int32_t kind, dmb_place a, dmb_place b);
dmb_id add_time_function(rig *s, const dmb_segment *terms, uint32_t count);
dmb_id add_constant(rig *s, double value);
/* A callback that provides value, rate and integral. */
dmb_id add_callback(rig *s, dmb_time_fn callback, void *context);
/* A drive of that kind with all else by default. */
dmb_id add_simple_drive(rig *s, int32_t kind, dmb_id part, int32_t component, dmb_id time_function);

/* n equal steps of length h, each of which must succeed without being divided. */
void take_steps(const rig *s, double h, uint32_t n);
/* The same where steps may be divided, as on touching the rock. */
void take_divided_steps(const rig *s, double h, uint32_t n);
/* Statics that must converge; options may be NULL. */
dmb_static_report find_equilibrium(const rig *s, const dmb_static_options *options);

dmb_pose pose_at(const rig *s, dmb_place place);
dmb_motion motion_at(const rig *s, dmb_place place, int32_t frame);
dmb_energy energy_of(const rig *s);
dmb_momentum momentum_of(const rig *s);
dmb_contact_total contacts_of(const rig *s);
dmb_statistics statistics_of(const rig *s);
double rotation_at(const rig *s, dmb_place place);
uint64_t rig_hash(const rig *s);

/* Pipe of the reference string S1: OD 73, ID 55 mm, 1.5 m, E 210e9, nu 0.3, rho 7850, kappa 0.5. */
dmb_pipe_def s1_pipe(void);
/* Its section: A, I, EA, EI, GJ, GA, weight per metre at g 9.81 and mass per metre. */
typedef struct s1_section {
    double A, I, EA, EI, GJ, GA, mass, weight;
} s1_section;
s1_section s1_values(void);
/* Hole of 94 mm along +x. */
dmb_wall_def s1_hole(void);

/* A beam by its stiffnesses, solid, with the mass of a light rod. */
dmb_pipe_def beam_pipe(double length, uint32_t elements, double EA, double GA, double GJ, double EI);
/* A string of one beam from the world's origin along x, its rig end free in `start_free`. */
dmb_id add_beam(rig *s, const dmb_pipe_def *pipe, int32_t start_free);

#endif
