/* Memory of a fatigue counter: sections, points and cycles in one block. */
#ifndef DMB_OUTPUT_FATIGUE_H
#define DMB_OUTPUT_FATIGUE_H

#include "base/memory.h"
#include "drillmbd/analyse.h"
#include "output/output.h"

/* A point of a section. */
typedef struct dmb_fatigue_counter {
    dmb_rainflow flow;
    double *cycles; /* by range, shape (classes) */
    double damage, count;
    double lowest, highest; /* [Pa] */
    double range;           /* [Pa] the largest */
    uint32_t largest;       /* [-] the largest range in levels, used to compare points of equal damage */
    uint32_t reserved;
} dmb_fatigue_counter;

typedef struct dmb_fatigue_section {
    dmb_place place;
    double area;    /* [m2] */
    double modulus; /* [m3] I/r */
    uint64_t clipped;
} dmb_fatigue_section;

struct dmb_fatigue {
    uint32_t magic;
    uint32_t place_count;
    size_t bytes; /* of this block, which includes all arrays */
    dmb_allocator allocator;
    dmb_fatigue_options options;
    dmb_fatigue_section *sections; /* shape (place_count) */
    dmb_fatigue_counter *counters; /* shape (place_count, points) */
    double *cosine, *sine;         /* of the points, shape (points) */
    uint64_t samples;
    double first, last; /* [s] */
};

#endif
