/* One result, the only place that prints one: a line
 *     scene=B elements=100 dt=1e-3 us_per_step=.. U_per_step=.. rtf=.. iterations=.. error=.. error_kind=.. name=value
 *     ...
 * and the same as a row of a table of comma-separated values. Every line begins with these nine; what a program has to
 * say beyond them follows. "-" and an empty cell: not there. */
#ifndef BENCH_ROW_H
#define BENCH_ROW_H

#include <stdint.h>
#include <stdio.h>

#include "yardstick.h"

enum { ROW_MOST = 64, ROW_HEAD = 9 };

typedef struct field {
    const char *name, *text; /* text NULL: the value */
    double value;            /* NaN: not there */
    int digits;
} field;

typedef struct result_row {
    field fields[ROW_MOST];
    int count;
} result_row;

/* Columns that every result has. */
typedef struct head {
    const char *scene;
    double elements;
    double step;    /* [s]; error-controlled: the mean one */
    double seconds; /* [s] of processor time a step */
    double unit;    /* [s] U */
    double rtf;     /* [-] simulated time over computing time */
    double iterations;
    double error;
    const char *error_kind;
} head;

/* Rows of one file have the same fields in the same order. */
typedef struct result_table {
    FILE *file;
    int rows;
    result_row first;
} result_table;

static inline void row_number(result_row *r, const char *name, double value, int digits)
{
    const field f = {name, NULL, value, digits};
    r->fields[r->count++] = f;
}

static inline void row_word(result_row *r, const char *name, const char *text)
{
    const field f = {name, text, 0.0, 0};
    r->fields[r->count++] = f;
}

static inline void row_begin(result_row *r, const head *h)
{
    r->count = 0;
    row_word(r, "scene", h->scene);
    row_number(r, "elements", h->elements, 9);
    row_number(r, "dt", h->step, 4);
    row_number(r, "us_per_step", 1e6 * h->seconds, 5);
    row_number(r, "U_per_step", h->seconds / h->unit, 4);
    row_number(r, "rtf", h->rtf, 4);
    row_number(r, "iterations", h->iterations, 4);
    row_number(r, "error", h->error, 3);
    row_word(r, "error_kind", h->error_kind);
}

static inline void print_field(const field *f, int position, FILE *file)
{
    if (f->text) {
        printf("%s=%s ", f->name, f->text);
        fputs(f->text, file);
    } else if (!isnan(f->value)) {
        printf("%s=%.*g ", f->name, f->digits, f->value);
        fprintf(file, "%.*g", f->digits, f->value);
    } else if (position < ROW_HEAD)
        printf("%s=- ", f->name);
}

static inline void row_put(const result_row *r, result_table *t)
{
    if (t->rows++ == 0) {
        t->first = *r;
        for (int i = 0; i < r->count; ++i) fprintf(t->file, "%s%c", r->fields[i].name, i + 1 < r->count ? ',' : '\n');
    }
    for (int i = 0; i < r->count; ++i) {
        if (r->count != t->first.count || strcmp(r->fields[i].name, t->first.fields[i].name) != 0) {
            fprintf(stderr, "bench: column %s where %s was\n", r->fields[i].name, t->first.fields[i].name);
            exit(2);
        }
        print_field(&r->fields[i], i, t->file);
        fputc(i + 1 < r->count ? ',' : '\n', t->file);
    }
    putchar('\n');
    fflush(stdout);
    fflush(t->file);
}

/* A line for a result that is not there. */
static inline void row_failed(const char *which, double elements, const char *what, const char *status,
                              const char *message)
{
    printf("scene=%s elements=%.9g %s failed=%s\n", which, elements, what, status);
    fflush(stdout);
    fprintf(stderr, "bench: scene %s: %s\n", which, message);
}

/* Begins a program: its table and U. Returns 0, or 2 after saying why not. */
static inline int table_open(result_table *t, yardstick *unit, const char *path)
{
    t->rows = 0;
    t->file = fopen(path, "w");
    if (!t->file) return perror(path), 2;
    yardstick_open(unit);
    yardstick_anew(unit);
    printf("U=%.4g us: dpbtrf + dpbtrs, n = %d, half band %d, one thread\n", 1e6 * yardstick_value(unit), YARDSTICK_N,
           YARDSTICK_BAND);
    return 0;
}

static inline int table_close(result_table *t, const char *path)
{
    return fclose(t->file) == 0 ? 0 : (perror(path), 2);
}

#endif
