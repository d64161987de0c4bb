#include <math.h>
#include <stdio.h>

#include "study.h"

#define LOWEST 6.9e-3 /* [Hz] what the reference says */
#define HIGHEST 2.1e4 /* [Hz] */

enum { RIGID_MODES = 4 };

typedef struct tally {
    int agree, differ, elsewhere;
} tally;

static void claim(const tally *t, const char *words)
{
    printf("%3d  %s\n", t->agree + t->differ + t->elsewhere + 1, words);
}

static void verdict(tally *t, int agrees, const char *why)
{
    printf("     %s: %s\n", agrees ? "AGREES" : "DOES NOT AGREE", why);
    t->agree += agrees;
    t->differ += !agrees;
}

/* ---- Modes ------------------------------------------------------------------------------------------------------- */

static void lowest(tally *t, const study_modal *m)
{
    claim(t, "the lowest natural frequency is 6.9e-3 Hz");
    printf("     here %.3e Hz; %.3e Hz with the bit of 5 kg\n", m->without_bit, m->shape_frequency[0]);
    verdict(t, fabs(m->without_bit - LOWEST) <= 0.05e-3,
            "to the digits given, for the string held at its head and nowhere else: a bit lowers it, and\n"
            "     a wall that carries the string raises it (see drilled length)");
}

static void highest(tally *t, const study_modal *m)
{
    const double *mesh = m->highest;
    int fits = 0;
    claim(t, "the highest natural frequency is 2.1e4 Hz");
    printf("     here %.3e Hz with one element a pipe", m->all[m->all_count - 1]);
    for (int i = 0; i + 1 < STUDY_MESHES; ++i)
        if (mesh[i] < HIGHEST && mesh[i + 1] >= HIGHEST) {
            printf(", %.3e Hz with %d and %.3e Hz with %d", mesh[i], i + 1, mesh[i + 1], i + 2);
            fits = 1;
        }
    printf("\n");
    verdict(t, fabs(m->all[m->all_count - 1] - HIGHEST) <= 0.05e4,
            fits ? "it is a figure of the mesh and not of the string: it grows with every element, and passes\n"
                   "     the reference's between those two meshes"
                 : "it is a figure of the mesh and not of the string, and no mesh tried comes to it");
}

static void rigid(tally *t, const study_modal *m)
{
    claim(t, "the first four modes are rigid, with damping 1");
    printf("     here %d rigid and %d overdamped ones come before the first that swings\n", m->rigid, m->overdamped);
    verdict(t, m->rigid + m->overdamped == RIGID_MODES,
            "the string may move along and around, two roots each: 0, and one that any drag makes\n"
            "     overdamped (the less the lower). The library calls the zeros rigid and gives them no damping. "
            "Drives\n"
            "     that hold the head leave none of the four");
}

static void tubes(tally *t, const study_modal *m)
{
    double worst = 0.0;
    claim(t, "a steel tube of 7, 8.5, 10 m has 0.94547, 0.64124, 0.46330 Hz");
    printf("     here");
    for (int i = 0; i < STUDY_TUBES; ++i) {
        printf(" %.5f", m->tube[i]);
        worst = fmax(worst, fabs(m->tube[i] - study_tube_reference[i]));
    }
    printf(" Hz\n");
    verdict(t, worst <= 0.5e-5 + 1e-9, "to the digits given, clamped at one end");
}

/* ---- Lengths ----------------------------------------------------------------------------------------------------- */

static void drilled_length(tally *t, const study_set *set)
{
    const study_point *first = set->point, *last = first + set->count - 1;
    int rises = 0;
    for (int k = 1; k < set->count; ++k) {
        const study_point *p = first + k, *before = p - 1;
        for (int i = 0; i < STUDY_MODES; ++i) rises += p->bending[i] >= before->bending[i];
        rises += (p->torsional >= before->torsional) + (p->axial >= before->axial);
    }
    claim(t, "natural frequencies fall with the drilled length");
    printf("     here from %g to %g m: bending %.3e to %.3e Hz, around %.2f to %.2f Hz, along %.2f to %.2f Hz;\n"
           "     on the wall %.3f to %.3f Hz\n",
           first->value, last->value, first->bending[0], last->bending[0], first->torsional, last->torsional,
           first->axial, last->axial, first->on_wall[0], last->on_wall[0]);
    verdict(t, rises == 0,
            "every one of them at every step of the way, without a wall. On the wall the lowest stays\n"
            "     that of pipes swinging in the hole, which does not know how long the string is");
}

static double largest_change(const study_set *set, double (*of)(const study_point *))
{
    double low = (double)INFINITY, high = 0.0;
    for (int k = 0; k < set->count; ++k) {
        low = fmin(low, of(set->point + k));
        high = fmax(high, of(set->point + k));
    }
    return (high - low) / low;
}

static double first_bending(const study_point *p)
{
    return p->bending[0];
}

static double fifth_bending(const study_point *p)
{
    return p->bending[STUDY_MODES - 1];
}

static double along(const study_point *p)
{
    return p->axial;
}

static double around(const study_point *p)
{
    return p->torsional;
}

static double on_wall(const study_point *p)
{
    return p->on_wall[0];
}

static void pipe_length(tally *t, const study_set *set)
{
    const double change[] = {largest_change(set, first_bending), largest_change(set, fifth_bending),
                             largest_change(set, around), largest_change(set, along)};
    double worst = 0.0;
    for (int i = 0; i < 4; ++i) worst = fmax(worst, change[i]);
    claim(t, "natural frequencies hardly depend on the length of each pipe");
    printf("     here pipes of %g to %g m change the first bending by %.1e, the fifth by %.1e, around by %.1e,\n"
           "     along by %.1e; on the wall by %.1e\n",
           set->point[0].value, set->point[set->count - 1].value, change[0], change[1], change[2], change[3],
           largest_change(set, on_wall));
    verdict(t, worst < 0.01,
            "joints are rigid and share a node, so that a pipe's length is only the mesh's. On the wall\n"
            "     long pipes touch it at their ends alone");
}

static void orders(tally *t, const study_set *set)
{
    const study_point *first = set->point, *last = first + set->count - 1;
    const double shallow = first->bending[STUDY_MODES - 1] - first->bending[0];
    const double deep = last->bending[STUDY_MODES - 1] - last->bending[0];
    claim(t, "the order of a mode matters in the shallow hole and hardly in the deep one");
    printf(
        "     here the fifth bending lies %.3f Hz above the first at %g m, %.3f Hz at %g m (as ratios %.1f and %.1f);\n"
        "     on the wall the tenth mode lies %.3f and %.3f Hz above the first, %.3f Hz\n",
        shallow, first->value, deep, last->value, first->bending[STUDY_MODES - 1] / first->bending[0],
        last->bending[STUDY_MODES - 1] / last->bending[0], first->on_wall[STUDY_MODES - 1] - first->on_wall[0],
        last->on_wall[STUDY_MODES - 1] - last->on_wall[0], last->on_wall[0]);
    verdict(t, deep < 0.1 * shallow,
            "in hertz, with and without a wall; as ratios without a wall the orders lie as far apart as before");
}

/* ---- Response ---------------------------------------------------------------------------------------------------- */

static void dominance(tally *t, const study_shaken *shaken)
{
    const study_response *r = &shaken->response;
    const double top = r->frequency[r->points - 1];
    double found[2];
    study_crossover(r, 1.0, 1.0, found);
    const double share = study_eccentric_share(r, found[0], top);
    const double end = study_eccentric_share(r, found[1], top);
    claim(t, "at pipe 100 friction dominates below a frequency and eccentricity above it");
    printf("     here friction below %.2f Hz everywhere, eccentricity above %.2f Hz (to 100 Hz), in between in turns:\n"
           "     eccentricity in %.0f %% of the octaves above the first crossing\n",
           found[0], found[1], 100.0 * share);
    verdict(t, share > 0.5 && end > 0.999,
            "below all resonances and above them; among those of pipes swinging in the hole the two\n"
            "     shake different shapes and take turns, because eccentric masses lie in directions of their own");
}

static void crossover(tally *t, const study_shaken *shaken)
{
    const double whole = study_ratio_at(&shaken->response, STUDY_REFERENCE_CROSSOVER);
    const double swing = study_case_friction[STUDY_CASES - 1] / study_base().friction;
    double low = (double)INFINITY, high = 0.0;
    for (int i = 0; i < STUDY_CASES; ++i) {
        low = fmin(low, shaken->crossover[i][0]);
        high = fmax(high, shaken->crossover[i][0]);
    }
    claim(t, "that frequency is 1.58 Hz");
    printf(
        "     here %.2f to %.2f Hz for eccentricities of 0.5 to 2 mm and the whole friction or its step of 0.05; at\n"
        "     1.58 Hz an eccentricity of %.1f mm would be as strong as the whole friction, one of %.1f mm as the "
        "step\n",
        low, high, 1e3 * STUDY_ECCENTRICITY * whole, 1e3 * STUDY_ECCENTRICITY * whole * swing);
    verdict(t, low <= STUDY_REFERENCE_CROSSOVER && STUDY_REFERENCE_CROSSOVER <= high,
            "it follows from the ratio of friction to eccentricity, which the reference does not give;\n"
            "     those that are usual put it higher");
}

static void growth(tally *t, const study_shaken *shaken)
{
    const double from = 0.1, to = 1.0; /* [Hz] below all resonances of the string on the wall */
    const double power =
        log(study_ratio_at(&shaken->response, from) / study_ratio_at(&shaken->response, to)) / log(to / from);
    claim(t, "the reason: eccentric force grows with the square of frequency, friction does not grow");
    printf("     here the response to eccentricity over that to friction grows with the power %.3f from 0.1 to 1 Hz\n",
           power);
    verdict(t, fabs(power - 2.0) < 0.1, "as long as both bend the string alike, below its resonances");
}

/* ---- In time ----------------------------------------------------------------------------------------------------- */

static void in_time(tally *t)
{
    static const struct {
        const char *words, *picture;
    } claims[] = {
        {"the bit of the flexible system sags, that of the rigid one bounces",
         "a_bit_z_displacement_rigid_and_flexible.png"},
        {"speed in Z grows and jumps more often towards the deep end", "d_z_speed_of_pipes_1_50_100.png"},
        {"kinetic energy of pipe 100: contact < with friction < with vibration too, which lowers it in places",
         "b_kinetic_energy_of_pipe_100.png"},
        {"kinetic energy of pipe 100 decays within 10 s and settles after 15 s", "b_kinetic_energy_of_pipe_100.png"},
    };
    for (size_t i = 0; i < sizeof claims / sizeof claims[0]; ++i) {
        claim(t, claims[i].words);
        printf("     NOT LOOKED AT HERE: ./examples/run computes it, %s\n", claims[i].picture);
        t->elsewhere++;
    }
}

void study_claims_print(const study_modal *modal, const study_shaken *shaken, const study_set sets[STUDY_SETS])
{
    tally t = {0, 0, 0};
    printf("What the reference says, and what is so here\n");
    lowest(&t, modal);
    highest(&t, modal);
    rigid(&t, modal);
    tubes(&t, modal);
    drilled_length(&t, sets + STUDY_LENGTHS);
    pipe_length(&t, sets + STUDY_PIPE_LENGTHS);
    orders(&t, sets + STUDY_LENGTHS);
    dominance(&t, shaken);
    crossover(&t, shaken);
    growth(&t, shaken);
    in_time(&t);
    printf("%d agree, %d do not, %d are not looked at here\n", t.agree, t.differ, t.elsewhere);
}
