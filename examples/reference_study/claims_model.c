#include <stdio.h>

#include "claims.h"

#define STUDY_FREEDOM 2200 /* [-] degrees of freedom of the study's model */

static void counts(tally *t, const dmb_check_report *r)
{
    study_claim(t, "system parameters",
                "2 rigid parts, 100 flexible pipes, a pair of motions, 101 fixed joints, 2 "
                "actuators, nothing over- or under-constrained");
    printf(
        "     here: %u rigid parts, %u flexible pipes, %u cylindrical pair, %u fixed joints, %u drives, %u redundant "
        "equations\n",
        r->rigid_parts, r->flexible_parts, r->joints[DMB_JOINT_CYLINDRICAL], r->joints[DMB_JOINT_FIXED],
        r->motion_drives, r->redundant);
    const int same = r->rigid_parts == 2 && r->flexible_parts == 100 && r->joints[DMB_JOINT_CYLINDRICAL] == 1 &&
                     r->joints[DMB_JOINT_FIXED] == 101 && r->motion_drives == 2 && r->redundant == 0;
    study_verdict(t, same ? CONFIRMED : NOT_CONFIRMED,
                  "with the head as a body and a pipe as a part of its own; a pair of motions is read as one\n"
                  "     cylindrical pair. The scene of all other rows has one string and no head: same motion, fewer "
                  "equations");
}

static void freedom(tally *t, const dmb_check_report *r)
{
    study_claim(t, "system parameters", "2200 degrees of freedom");
    printf("     here: %u with one element a pipe, and as many more for every further element\n",
           r->degrees_of_freedom);
    study_begin_verdict(t, r->degrees_of_freedom == STUDY_FREEDOM ? CONFIRMED : NOT_CONFIRMED);
    printf("%d is no multiple of %u; the study does not say how a pipe is described\n", STUDY_FREEDOM,
           r->degrees_of_freedom);
}

void study_claim_model(tally *t, const study_results *results)
{
    counts(t, &results->counts.report);
    freedom(t, &results->counts.report);
    study_claim(t, "abstract", "a macro program reduces the effort of modelling and its time");
    printf("     here: one call describes the string of 100 pipes; part by part the count above takes 308 calls\n");
    study_verdict(t, UNDECIDED, "the study gives no effort or time to compare with");
    study_claim(t, "introduction", "multibody dynamics is more efficient than the traditional finite element method");
    printf("     here: the string falls on its wall: CalculiX 58 ms a step, 61 us here, same motion "
           "(examples/validation)\n");
    study_verdict(t, CONFIRMED_IF,
                  "a general program with beams as solids stands for the method; no rotation, no friction");
    study_claim(t, "conclusions", "other methods for rigid than for flexible bodies make the analysis more accurate");
    printf("     here: one formulation for both (motion on SE(3)), rigid pipes are the same elements without strain\n");
    study_verdict(t, UNDECIDED, "the study shows no result of another choice of methods");
}
