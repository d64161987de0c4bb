/* One result of a peer, or of the library beside it, in the form of row.h. peer_calculix.py writes the same columns. */
#ifndef BENCH_PEER_ROWS_H
#define BENCH_PEER_ROWS_H

#include "row.h"

typedef struct peer_row {
    const char *code, *version, *scene;
    const char *setting; /* words with = and ;, no comma */
    unsigned elements;
    double end;       /* [s] of the timed run */
    double seconds;   /* [s] of processor time */
    double yardstick; /* [s] U */
    double steps;     /* [-] accepted */
    double residuals; /* [-] evaluations of the equations, those for tangents included; NaN: not counted */
    double tangents;  /* [-] of them with tangent */
    double error[2];
    const char *error_kind[2]; /* the second NULL: one error only */
} peer_row;

static void peer_row_report(result_table *t, const peer_row *p)
{
    const double steps = p->steps, rtf = p->end / p->seconds, none = (double)NAN;
    const head h = {p->scene, p->elements, p->end / steps, p->seconds / steps, p->yardstick,
                    rtf,      none,        p->error[0],    p->error_kind[0]};
    result_row r;
    row_begin(&r, &h);
    row_word(&r, "code", p->code);
    row_word(&r, "version", p->version);
    row_word(&r, "setting", p->setting);
    row_number(&r, "end", p->end, 4);
    row_number(&r, "steps", steps, 9);
    row_number(&r, "U_us", 1e6 * p->yardstick, 4);
    row_number(&r, "U_per_simulated_second", p->seconds / p->end / p->yardstick, 5);
    row_number(&r, "residuals", p->residuals, 9);
    row_number(&r, "tangents", p->tangents, 9);
    row_number(&r, "error_2", p->error_kind[1] ? p->error[1] : none, 3);
    row_word(&r, "error_2_kind", p->error_kind[1] ? p->error_kind[1] : "-");
    row_put(&r, t);
}

#endif
