/* Corners of programmes: no step goes over one. */
#ifndef DMB_INTEGRATOR_CORNER_H
#define DMB_INTEGRATOR_CORNER_H

#include "state.h"

/* [s] smallest corner later than t of any programme in use; INFINITY if none. */
double dmb_next_corner(const dmb_sim *sim, double t);

#endif
