/* Constants of a flexible element: stiffness and mass. */
#ifndef DMB_MODEL_BEAM_ELEMENT_H
#define DMB_MODEL_BEAM_ELEMENT_H

#include "element/element_type.h"
#include "model/section.h"

/* 12 EI/(GA L^2): shear over bending flexibility of an element. */
double dmb_shear_ratio(double EI, double GA, double length);

/* GA* of 1/GA* = 1/GA + L^2/(12 EI), which makes the element's linear statics exact at its nodes. */
double dmb_corrected_shear(double EI, double GA, double length);

/* Sideways: consistent mass with the cubic shapes of a Timoshenko beam (THEORY 3), rotary inertia included. Along and
 * around: half way from the consistent mass of straight shapes to a lumped one at share 1; share [-]: of the pipe alone
 * in the mass and in the inertia about the axis that move with it, tool joints included, shape (2). */
void dmb_beam_mass_of(const dmb_pipe_section *section, double length, const double share[2], dmb_beam_mass *mass);

/* The type of an element of a pipe between rigid arms [m]. damping_time [s] is that of the pipe, or 0. */
void dmb_element_type_of(const dmb_pipe_def *def, const double arm[2], double damping_time, dmb_element_type *type);

#endif
