/* Rows of the table of the study's sentences: what it says, what comes out here, verdict. */
#ifndef REFERENCE_STUDY_CLAIMS_H
#define REFERENCE_STUDY_CLAIMS_H

#include "study.h"

enum {
    NOT_CONFIRMED = 0,
    CONFIRMED = 1,
    CONFIRMED_IF = 2, /* under the condition that the text behind the verdict states */
    UNDECIDED = 3,
    NOT_COMPUTED = 4, /* by the short form */
    VERDICTS = 5
};
typedef struct tally {
    int count[VERDICTS];
} tally;

/* Begins a row: number, part of the study, its sentence in short words. */
void study_claim(const tally *t, const char *where, const char *words);
/* Ends a row. The text gives the reason or the condition; begin_verdict leaves it to the caller. */
void study_begin_verdict(tally *t, int which);
void study_verdict(tally *t, int which, const char *why);

/* Rows by subject; those in time are NOT_COMPUTED by the short form. */
void study_claim_model(tally *t, const study_results *results);    /* claims_model.c */
void study_claim_modes(tally *t, const study_results *results);    /* claims_modes.c */
void study_claim_lengths(tally *t, const study_results *results);  /* claims_modes.c */
void study_claim_response(tally *t, const study_results *results); /* claims_response.c */
void study_claim_time(tally *t, const study_results *results);     /* claims_time.c */

#endif
