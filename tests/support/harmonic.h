/* Inputs, outputs and transfer functions for the tests of responses. */
#ifndef DMB_TESTS_HARMONIC_H
#define DMB_TESTS_HARMONIC_H

#include <complex.h>
#undef I /* a name of second moments of area here */
#define i_ ((double complex)_Complex_I)

#include "rig.h"

dmb_excitation force_at(dmb_place place, int32_t component);
dmb_excitation input_of(int32_t kind, dmb_id part, int32_t component);
/* The component of a quantity that has six, or (0) a quantity. */
dmb_output output_at(int32_t quantity, dmb_place place, int32_t component);

/* One transfer function at the given frequencies [Hz], with options overlaid (may be NULL). */
void transfer(const rig *s, const dmb_response_options *options, const dmb_excitation *input, const dmb_output *output,
              const double *frequencies, uint32_t points, double complex *values);

/* The rotor of Jeffcott, 50 kg on a shaft of 1e6 N/m with a damping ratio of 0.02, its centre of mass 1e-4 m off the
 * axis, turned at `speed` [rad/s]. Opens and starts the rig; the disc. */
dmb_id open_rotor(rig *s, double speed);

#endif
