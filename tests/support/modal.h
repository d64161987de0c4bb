/* Modes for the physics tests, refusals turned into failures that tell the library's message. */
#ifndef DMB_TESTS_MODAL_H
#define DMB_TESTS_MODAL_H

#include "rig.h"

/* A straight string of `count` pipes along x without gravity, and nothing else so far: rig_start is the caller's. */
dmb_id lay_string(rig *s, const dmb_pipe_def *pipe, uint32_t count, int32_t start_free, int32_t end_free);

/* Modes of the scene as it stands; options may be NULL. */
dmb_modes *find_modes(const rig *s, const dmb_modes_options *options);
/* The same: the lowest `count`, all of them, or those in a band [Hz]; kind DMB_MODES_... */
dmb_modes *lowest_modes(const rig *s, int32_t kind, uint32_t count);
dmb_modes *all_modes(const rig *s, int32_t kind);
dmb_modes *modes_in_band(const rig *s, int32_t kind, double low, double high);

dmb_modes_info info_of(const dmb_modes *modes);
dmb_mode mode_at(const dmb_modes *modes, uint32_t index);
dmb_mode_shape shape_at(const dmb_modes *modes, uint32_t index, dmb_place place);
double frequency_at(const dmb_modes *modes, uint32_t index);
/* Frequency [Hz] of number `number` (0 first) of the modes in which more than half of the kinetic energy is of that
 * kind, 0 axial, 1 torsional, 2 lateral; rigid-body modes are left out. */
double frequency_of_kind(const dmb_modes *modes, int kind, uint32_t number);

/* Distance of the mode closest to a frequency [1/s] from it, relative, by imaginary parts of eigenvalues. */
double closest_mode(const dmb_modes *modes, double w);

/* A refusal of dmb_analysis_modes, *modes being NULL and the sim untouched; what was said. */
typedef struct modes_refusal {
    int32_t status;
    char text[256];
} modes_refusal;
modes_refusal refused_modes(const rig *s, const dmb_modes_options *options);

#endif
