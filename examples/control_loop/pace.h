/* The clock of the control unit: cycles of 1 ms, and how long each step took. */
#ifndef CONTROL_LOOP_PACE_H
#define CONTROL_LOOP_PACE_H

#include <stdint.h>

enum { PACE_BINS = 7 };

typedef struct pace {
    int waits;                /* 1: cycles in real time; 0: one after the other */
    int64_t start, next;      /* [ns] of the present step, of the next cycle */
    uint64_t bins[PACE_BINS]; /* [-] steps by time */
    uint64_t late;            /* [-] cycles that began after their time */
    int64_t worst;            /* [ns] */
} pace;

/* Waits for the next cycle, and the step begins. */
void pace_begin(pace *p);
void pace_end(pace *p);
void pace_print(const pace *p);

#endif
