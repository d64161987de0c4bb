/* Axes of a frame from two directions. */
#ifndef DMB_MODEL_FRAME_AXES_H
#define DMB_MODEL_FRAME_AXES_H

#include <stdbool.h>

/* M, axes as columns, row-major, orthonormal to rounding: x along axis, y along normal less its part along x. normal =
 * 0 stands for y of the surrounding frame, or z where x is along that. False, with M unchanged, if the axis is zero or
 * the normal is along it within 1e-6 rad. All numbers finite. */
bool dmb_frame_axes(const double axis[3], const double normal[3], double M[9]);

#endif
