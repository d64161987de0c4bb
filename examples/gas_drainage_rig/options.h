/* Options of the command line. */
#ifndef RIG_OPTIONS_H
#define RIG_OPTIONS_H

#include <stdint.h>

#include "cycle.h"

enum { RIG_NO_COUPLING = 0, RIG_CONTACT = 1, RIG_FRICTION = 2, RIG_VIBRATION = 3 };

/* One way of modelling the rig. */
typedef struct rig_variant {
    int32_t pipe_kind; /* DMB_PIPE_... */
    int32_t couple;    /* RIG_..., each includes the ones before it */
} rig_variant;

typedef struct rig_options {
    rig_variant variant; /* the one to run, unless `all` */
    int all;             /* the four variants that the pictures need */
    int quiet;           /* no progress bar */
    int dropped;         /* starts straight on the axis of the hole, not at rest on its low side */
    uint32_t threads;    /* that run variants side by side */
    uint32_t pipes;
    uint32_t elements;  /* in each pipe */
    uint32_t seed;      /* of the eccentric masses */
    double length;      /* [m] of a pipe */
    double bit;         /* [m] diameter at which the bit meets the wall; 0: it does not */
    double step;        /* [s] */
    double end;         /* [s] */
    double rate;        /* [Hz] of the tables */
    const char *output; /* NULL: no files */
    rig_cycle cycle;
} rig_options;

/* 40 s of 100 pipes, all variants, no files. */
rig_options rig_options_default(void);
/* Reads the command line; on a mistake it says so and ends the program. */
rig_options rig_options_read(int count, char **words);

const char *rig_system_name(const rig_variant *variant);
const char *rig_couple_name(const rig_variant *variant);

#endif
