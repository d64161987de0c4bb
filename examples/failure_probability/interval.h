/* The interval of a probability that was counted. */
#ifndef FAILURE_PROBABILITY_INTERVAL_H
#define FAILURE_PROBABILITY_INTERVAL_H

/* Clopper and Pearson (1934): P(X >= failures) = P(X <= failures) = (1 - confidence)/2 at the ends. */
void interval_of(int failures, int samples, double confidence, double ends[2]);

#endif
