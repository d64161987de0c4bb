/* Judging of random scenes: a condition that does not hold ends the program, told with the seed and the call. */
#ifndef DMB_TESTS_RANDOM_JUDGE_H
#define DMB_TESTS_RANDOM_JUDGE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drillmbd/drillmbd.h"

static unsigned long long present_seed; /* of the input that is being run */
static const char *present_action = "";

#define MUST(condition)                                                                                     \
    do {                                                                                                    \
        if (!(condition)) {                                                                                 \
            fprintf(stderr, "seed %llu, %s: %s:%d: %s\n", present_seed, present_action, __FILE__, __LINE__, \
                    #condition);                                                                            \
            abort();                                                                                        \
        }                                                                                                   \
    } while (0)

static inline void must_be_known(int32_t status)
{
    MUST(strcmp(dmb_status_name(status), "DMB_UNKNOWN") != 0);
}

static inline void must_be_finite(const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++) MUST(isfinite(values[i]));
}

#endif
