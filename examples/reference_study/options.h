/* Options of the command line. */
#ifndef STUDY_OPTIONS_H
#define STUDY_OPTIONS_H

typedef struct study_options {
    const char *output; /* folder for tables; NULL: none */
    double step;        /* [s] of the drilling cycle in time */
    int threads;
    int brief; /* only the claims, without the runs in time */
} study_options;

/* Reads the command line; on a mistake it says so and ends the program. */
study_options study_options_read(int count, char **words);

#endif
