/* Processor time, and the yardstick U: one factorisation and solution of a banded positive definite system by LAPACKE
 * (dpbtrf and dpbtrs, n = 606, half band 11) on one thread. Costs in U compare between machines.
 *
 * LAPACKE is taken in at run time: so it can be told first to use one thread, and without it all but U is still there.
 * Processor time of the thread, not time of the wall clock: what else the machine does then counts for less. */
#ifndef BENCH_YARDSTICK_H
#define BENCH_YARDSTICK_H

#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    YARDSTICK_N = 606,
    YARDSTICK_BAND = 11,
    YARDSTICK_ROWS = YARDSTICK_BAND + 1,
    YARDSTICK_REPEATS = 31,
    YARDSTICK_MEASURES = 4096
};

typedef int (*factorise_fn)(int layout, char triangle, int n, int band, double *matrix, int rows);
typedef int (*solve_fn)(int layout, char triangle, int n, int band, int count, const double *matrix, int rows,
                        double *x, int x_rows);

typedef struct yardstick {
    factorise_fn factorise;
    solve_fn solve;
    double matrix[YARDSTICK_N * YARDSTICK_ROWS]; /* lower band, column by column */
    double work[YARDSTICK_N * YARDSTICK_ROWS];
    double x[YARDSTICK_N];
    double measured[YARDSTICK_MEASURES]; /* [s] over the whole process, sorted */
    int measures;
} yardstick;

/* [s] */
static double processor_time(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts the values. */
static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    return 0.5 * (values[(count - 1) / 2] + values[count / 2]);
}

/* A data pointer of dlsym, made a function pointer as POSIX has it. */
static void take_function(void *library, const char *name, void *function)
{
    void *const symbol = library ? dlsym(library, name) : NULL;
    memcpy(function, &symbol, sizeof symbol);
}

static void yardstick_open(yardstick *y)
{
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    setenv("OMP_NUM_THREADS", "1", 1);
    void *const library = dlopen("liblapacke.so.3", RTLD_NOW | RTLD_LOCAL);
    take_function(library, "LAPACKE_dpbtrf", &y->factorise);
    take_function(library, "LAPACKE_dpbtrs", &y->solve);
    for (int column = 0; column < YARDSTICK_N; ++column) {
        for (int k = 0; k < YARDSTICK_ROWS; ++k)
            y->matrix[column * YARDSTICK_ROWS + k] = k == 0 ? 30.0 : sin(1.0 + column + 7.0 * k);
    }
}

static int factorise_and_solve(yardstick *y)
{
    enum { COLUMN_MAJOR = 102 };
    const int info = y->factorise(COLUMN_MAJOR, 'L', YARDSTICK_N, YARDSTICK_BAND, y->work, YARDSTICK_ROWS);
    if (info != 0) return info;
    return y->solve(COLUMN_MAJOR, 'L', YARDSTICK_N, YARDSTICK_BAND, 1, y->work, YARDSTICK_ROWS, y->x, YARDSTICK_N);
}

/* Takes one more measure, itself a median. */
static void yardstick_measure(yardstick *y)
{
    double taken[YARDSTICK_REPEATS];
    if (!y->factorise || !y->solve || y->measures == YARDSTICK_MEASURES) return;
    for (int i = 0; i < YARDSTICK_REPEATS; ++i) {
        memcpy(y->work, y->matrix, sizeof y->work);
        for (int k = 0; k < YARDSTICK_N; ++k) y->x[k] = 1.0;
        const double begin = processor_time();
        if (factorise_and_solve(y) != 0) return;
        taken[i] = processor_time() - begin;
    }
    y->measured[y->measures++] = median(taken, YARDSTICK_REPEATS);
}

/* Forgets earlier measures: the machine's clock may change within the process, and U is to be that of now. */
static inline void yardstick_anew(yardstick *y)
{
    y->measures = 0;
    for (int i = 0; i < 5; ++i) yardstick_measure(y);
}

/* [s] median of the measures: single ones jump with what else the machine does. NaN without LAPACKE. */
static double yardstick_value(yardstick *y)
{
    return y->measures > 0 ? median(y->measured, y->measures) : (double)NAN;
}

#endif
