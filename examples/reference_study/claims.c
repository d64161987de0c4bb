#include "claims.h"

#include <math.h>
#include <stdio.h>

static const char *const verdicts[VERDICTS] = {"NOT CONFIRMED", "CONFIRMED", "CONFIRMED IF", "CANNOT BE DECIDED",
                                               "NOT COMPUTED"};

void study_claim(const tally *t, const char *where, const char *words)
{
    int number = 1;
    for (int i = 0; i < VERDICTS; ++i) number += t->count[i];
    printf("%3d  %s: %s\n", number, where, words);
}

void study_begin_verdict(tally *t, int which)
{
    printf("     %s%s ", verdicts[which], which == CONFIRMED_IF ? "" : ":");
    t->count[which]++;
}

void study_verdict(tally *t, int which, const char *why)
{
    study_begin_verdict(t, which);
    printf("%s\n", why);
}

/* The assumptions of the scene that the text of the study does not give. */
static void print_assumptions(void)
{
    printf(
        "Assumptions of this project, which the study does not give\n"
        "  - the units of its drive functions: 10 is read as 10 mm/s of feed, 2.96 (its pressure at the bottom of the\n"
        "    hole) as a force of 2.96 kN; the rotation, lost in the text, as %.0f rpm\n"
        "  - pipes of 73 x 6 mm, 1 m, steel; a hole of 94 mm; a bit of 5 kg; friction 0.30 sliding, 0.35 at rest; "
        "masses\n"
        "    1 mm off the axis in directions of their own; 2 %% of shake in the drives; damping of the steel\n"
        "  - the tube of the experiment: 50/40 mm, 210 GPa, 7850 kg/m3, clamped; chosen so that its figures come out\n"
        "  - no rock acts on the bit but that force; the head is a pair of drives, no body (but in the count of row "
        "1)\n"
        "  - the rigid string may move at its head, as its pipes cannot bend; the flexible one is held there in the "
        "middle\n"
        "  - a coefficient of restitution is not given; the default law of contact is taken\n"
        "  Not in the study, though a table of this project once said so: that eccentricity takes over because its "
        "force\n"
        "  grows with the square of the frequency; that the rigid string's bit bounces; 6 + 22 coordinates a pipe\n",
        RIG_ROTATION_RPM);
}

void study_claims_print(const study_results *results)
{
    tally t = {{0}};
    printf("The study, one row a sentence that can be tested: what it says, what comes out here, verdict\n"
           "(each in the study's own quantity and axis: X along the hole, Y across it, Z up)\n");
    study_claim_model(&t, results);
    study_claim_time(&t, results);
    study_claim_response(&t, results);
    study_claim_modes(&t, results);
    study_claim_lengths(&t, results);
    print_assumptions();
    printf("%d confirmed, %d confirmed if, %d not confirmed, %d cannot be decided", t.count[CONFIRMED],
           t.count[CONFIRMED_IF], t.count[NOT_CONFIRMED], t.count[UNDECIDED]);
    if (t.count[NOT_COMPUTED] > 0) printf(", %d not computed", t.count[NOT_COMPUTED]);
    printf("\n");
}
