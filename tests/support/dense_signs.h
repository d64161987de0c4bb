/* Signs of the eigenvalues of the stiffness of a state, by dense matrices: independent of the library's factors. */
#ifndef DMB_TESTS_DENSE_SIGNS_H
#define DMB_TESTS_DENSE_SIGNS_H

#include "rig.h"

typedef struct dense_signs {
    int32_t negative; /* below -bound */
    int32_t between;  /* within +-bound: motions that nothing resists, and redundant equations of joints */
    double bound;     /* [N/m, N m] part of the norm */
} dense_signs;

/* Of K on the motions that supports, drives and joints leave free: with K in the free rows and J the Jacobian of the
 * joints there, scaled to the size of K, [K J^T; J 0] has the eigenvalues' signs of K on the null space of J, and as
 * many negative ones more as J has independent rows. bound = part times the largest eigenvalue. The state must be an
 * equilibrium. */
dense_signs dense_signs_of(const rig *s, double part);

#endif
