/* References of the pendulum of length 1, angles from the direction of gravity (CASES.md). */
#ifndef DMB_TESTS_PENDULUM_H
#define DMB_TESTS_PENDULUM_H

#include <stdint.h>

/* (angle, speed) a time t later, to rounding, under gravity g [m/s2]. */
void pendulum_solve(double g, double t, double state[2]);

/* Released at rest from (-1, 0) under g 9.81: places of the bob, horizontal and upwards. */
typedef struct pendulum_place {
    double time, across, up;
} pendulum_place;
extern const pendulum_place pendulum_from_the_side[3];

/* Under g 1 from 1.5 rad and 0.3 rad/s over 8 s, spectral radius 0.9, in `steps` steps in the ratio 1 : 3 : 0.5 : 2. */
double pendulum_pattern_step(uint32_t steps, uint32_t i);
/* Checks the errors of (angle, speed) with 400 to 3200 steps against those of the scheme itself, and their order;
 * error_of takes the number of steps. */
void check_pendulum_pattern(double (*error_of)(uint32_t steps));

#endif
