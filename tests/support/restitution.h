/* The restitution of a contact under K d^n (1 + mu d'/v0), for any n and v0: the inverse of what the library solves. */
#ifndef DMB_TESTS_RESTITUTION_H
#define DMB_TESTS_RESTITUTION_H

/* [-] e with ln(1 + mu) - mu = ln(1 - mu e) + mu e: [1 + W0(-(1+mu) exp(-(1+mu)))]/mu. To 1e-15 relative; mu <= 0 gives
 * 1. */
double restitution_of(double mu);

#endif
