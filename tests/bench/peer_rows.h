/* One result of a peer, or of the library beside it: a line to read, and a line of a table. */
#ifndef BENCH_PEER_ROWS_H
#define BENCH_PEER_ROWS_H

#include <stdio.h>

typedef struct peer_row {
    const char *code, *version, *scene;
    const char *setting; /* words with = and ;, no comma */
    unsigned elements;
    double end;       /* [s] of the timed run */
    double seconds;   /* [s] of processor time */
    double yardstick; /* [s] U */
    double steps;     /* [-] accepted; 0: not told */
    double residuals; /* [-] evaluations of the equations, those for tangents included; 0: not counted */
    double tangents;  /* [-] of them with tangent */
    double error[2];  /* NaN: not asked */
    const char *error_kind[2];
} peer_row;

static const char *const peer_columns =
    "code,version,scene,elements,setting,end,steps,us_per_step,U_us,U_per_step,us_per_simulated_second,"
    "U_per_simulated_second,rtf,residuals,tangents,error,error_kind,error_2,error_2_kind";

static void peer_row_write(FILE *table, const peer_row *row)
{
    const double us = 1e6 * row->seconds, u = 1e6 * row->yardstick;
    fprintf(table, "%s,%s,%s,%u,%s,%g,%.0f,%.5g,%.4g,%.5g,%.6g,%.6g,%.5g,%.0f,%.0f,", row->code, row->version,
            row->scene, row->elements, row->setting, row->end, row->steps, us / row->steps, u, us / row->steps / u,
            us / row->end, us / row->end / u, row->end / row->seconds, row->residuals, row->tangents);
    fprintf(table, "%.4g,%s,%.4g,%s\n", row->error[0], row->error_kind[0], row->error[1], row->error_kind[1]);
    fflush(table);
}

static void peer_row_print(const peer_row *row)
{
    const double us = 1e6 * row->seconds;
    printf("scene=%s elements=%u code=%s %s us_per_step=%.4g U_per_step=%.3g rtf=%.4g steps=%.0f ", row->scene,
           row->elements, row->code, row->setting, us / row->steps, row->seconds / row->steps / row->yardstick,
           row->end / row->seconds, row->steps);
    printf("U_per_simulated_second=%.4g ", row->seconds / row->end / row->yardstick);
    if (row->residuals > 0.0) printf("residuals=%.0f tangents=%.0f ", row->residuals, row->tangents);
    printf("error=%.2e error_kind=%s", row->error[0], row->error_kind[0]);
    if (*row->error_kind[1]) printf(" error_2=%.2e error_2_kind=%s", row->error[1], row->error_kind[1]);
    printf(" end=%g\n", row->end);
    fflush(stdout);
}

static void peer_row_report(FILE *table, const peer_row *row)
{
    peer_row_print(row);
    peer_row_write(table, row);
}

#endif
