#include <math.h>
#include <stdio.h>

#include "claims.h"

#define LOWEST 6.9e-3 /* [Hz] of the study */
#define HIGHEST 2.1e4 /* [Hz] */
#define STUDY_ALL_MODES 2022

enum { RIGID_MODES = 4 };

/* ---- Modes ------------------------------------------------------------------------------------------------------- */

static void number(tally *t, const study_modal *m)
{
    study_claim(t, "figure 12", "the system has 2022 modes");
    printf("     here: %u with one element a pipe (600 an element, and 2 of the head)\n", m->all_count);
    study_begin_verdict(t, m->all_count == STUDY_ALL_MODES ? CONFIRMED : NOT_CONFIRMED);
    printf("no number of elements a pipe gives %d; nor is it the study's own %d degrees of freedom\n", STUDY_ALL_MODES,
           2200);
}

static void rigid(tally *t, const study_modal *m)
{
    study_claim(t, "figure 12", "the first four modes are rigid: damping ratio 1, imaginary part 0");
    printf("     here: %d rigid and %d overdamped ones come before the first that oscillates\n", m->rigid,
           m->overdamped);
    study_verdict(
        t, m->rigid + m->overdamped == RIGID_MODES ? CONFIRMED_IF : NOT_CONFIRMED,
        "the drives let go and a little drag acts (0.1 N s/m2, assumed): two motions, along and\n"
        "     around, have two roots each, 0 and one that drag makes overdamped. The drives hold the head: none");
}

/* on_wall: [Hz] the lowest of the same string on the wall. */
static void lowest(tally *t, const study_modal *m, double on_wall)
{
    study_claim(t, "figure 12, abstract", "the lowest natural frequency is 6.9e-3 Hz");
    printf("     here: %.3e Hz with the bit of 5 kg, %.3e Hz without it; on the wall of its hole %.3f Hz\n",
           m->shape_frequency[0], m->without_bit, on_wall);
    const int with = fabs(m->shape_frequency[0] - LOWEST) <= 0.05e-3,
              without = fabs(m->without_bit - LOWEST) <= 0.05e-3;
    study_verdict(t,
                  with      ? CONFIRMED
                  : without ? CONFIRMED_IF
                            : NOT_CONFIRMED,
                  "the bit is taken off and no wall carries the string; the study's string has its bit");
}

/* 1: every element and every normal mode raises the highest frequency. */
static int grows(const study_modal *m)
{
    int rises = 1;
    for (int i = 1; i < STUDY_MESHES; ++i) rises &= m->highest[i] > m->highest[i - 1];
    for (int i = 1; i < STUDY_NORMALS; ++i) rises &= m->by_modes[i] > m->by_modes[i - 1];
    return rises;
}

static void highest(tally *t, const study_modal *m)
{
    const double mesh = m->all[m->all_count - 1];
    int which = fabs(mesh - HIGHEST) <= 0.05e4 ? CONFIRMED : NOT_CONFIRMED, fits = -1;
    study_claim(t, "figure 12, abstract", "the highest natural frequency is 2.1e4 Hz");
    printf("     here: %.3e Hz with one element a pipe", mesh);
    for (int i = 0; i + 1 < STUDY_MESHES; ++i)
        if (m->highest[i] < HIGHEST && m->highest[i + 1] >= HIGHEST)
            printf(", %.3e Hz with %d and %.3e Hz with %d", m->highest[i], i + 1, m->highest[i + 1], i + 2);
    printf(";\n     with pipes described by 12 shapes of their ends and normal modes, as flexible bodies often are:\n  "
           "   ");
    for (int i = 0; i < STUDY_NORMALS; ++i) {
        printf("%s%.3e Hz with %d", i > 0 ? ", " : "", m->by_modes[i], study_normal_modes[i]);
        if (fabs(m->by_modes[i] - HIGHEST) <= 0.05e4) fits = i;
    }
    if (which == NOT_CONFIRMED && fits >= 0) which = CONFIRMED_IF;
    printf("\n");
    study_begin_verdict(t, which);
    if (fits >= 0) printf("a pipe has %d normal modes", study_normal_modes[fits]);
    if (grows(m))
        printf("%sthe figure grows with every element and mode, so that it is one of how a\n     pipe is described "
               "and not of the string",
               fits >= 0 ? ": " : "");
    printf("\n");
}

static void shapes(tally *t, const study_modal *m)
{
    int different = 1;
    double worst = 0.0;
    for (int i = 0; i < STUDY_SHAPES; ++i) {
        different &= m->shape_nodes[i] == i;
        worst = fmax(worst, fabs(m->pair_angle[i] - 0.25 * STUDY_TURN));
    }
    study_claim(t, "figure 13", "modes 2, 4, 6, 8, 10 have different shapes");
    printf("     here: %d, %d, %d, %d, %d places between the ends stand still\n", m->shape_nodes[0], m->shape_nodes[1],
           m->shape_nodes[2], m->shape_nodes[3], m->shape_nodes[4]);
    study_verdict(t, different ? CONFIRMED_IF : NOT_CONFIRMED,
                  "modes are counted of the string that its drives hold. In the list with four rigid modes 2 and 4\n"
                  "     are rigid, 6, 8, 10 are the first three bendings, different too");
    study_claim(t, "figure 13", "they differ because modes differ by a fixed position angle");
    printf("     here: modes come in pairs, whose planes stand at 90 degrees to within %.1e degrees\n",
           worst * 360.0 / STUDY_TURN);
    study_verdict(t, worst < 1e-6 ? CONFIRMED_IF : NOT_CONFIRMED,
                  "the two modes of one pair are meant (1 and 2, 3 and 4); shapes of different orders\n"
                  "     differ by their number of nodes, not by an angle");
}

void study_claim_modes(tally *t, const study_results *results)
{
    const study_modal *modal = &results->modal;
    const study_set *lengths = results->sets + STUDY_LENGTHS;
    number(t, modal);
    rigid(t, modal);
    lowest(t, modal, lengths->point[lengths->count - 1].on_wall[0]);
    highest(t, modal);
    shapes(t, modal);
}

/* ---- Lengths ----------------------------------------------------------------------------------------------------- */

static double largest_change(const study_set *set, double (*of)(const study_point *))
{
    double low = (double)INFINITY, high = 0.0;
    for (int k = 0; k < set->count; ++k) {
        low = fmin(low, of(set->point + k));
        high = fmax(high, of(set->point + k));
    }
    return (high - low) / low;
}

static double on_wall(const study_point *p)
{
    return p->on_wall[0];
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

static void by_order(tally *t, const study_set *set)
{
    int falls = 0, checked = 0;
    for (int k = 0; k < set->count; ++k)
        for (int i = 3; i < STUDY_MODES; i += 2, ++checked)
            falls += set->point[k].bending[i] <= set->point[k].bending[i - 2];
    study_claim(t, "figure 14", "at a given length the natural frequency rises with the order");
    printf("     here: orders 2, 4, 6, 8, 10 rise in %d of %d comparisons, at %d lengths\n", checked - falls, checked,
           set->count);
    study_verdict(t, falls == 0 ? CONFIRMED : NOT_CONFIRMED,
                  "by the definition of the order; figure 14 orders so, too");
}

static void drilled_length(tally *t, const study_set *set)
{
    const study_point *first = set->point, *last = first + set->count - 1;
    int rises = 0;
    for (int k = 1; k < set->count; ++k) {
        const study_point *p = first + k, *before = p - 1;
        for (int i = 0; i < STUDY_MODES; ++i) rises += p->bending[i] >= before->bending[i];
        rises += (p->torsional >= before->torsional) + (p->axial >= before->axial);
    }
    study_claim(t, "figure 14", "natural frequencies fall with the drilled length");
    printf("     here: from %g to %g m: bending %.3e to %.3e Hz, around %.2f to %.2f Hz, along %.2f to %.2f Hz;\n"
           "     on the wall %.3f to %.3f Hz\n",
           first->value, last->value, first->bending[0], last->bending[0], first->torsional, last->torsional,
           first->axial, last->axial, first->on_wall[0], last->on_wall[0]);
    study_begin_verdict(t, rises == 0 ? CONFIRMED : NOT_CONFIRMED);
    if (rises == 0)
        printf("every one of them at every step of the way, without a wall.");
    else
        printf("without a wall one of them stays or rises %d times from one length to the next.", rises);
    if (largest_change(set, on_wall) < 0.1)
        printf(" On the wall the lowest stays\n"
               "     that of pipes swinging in the hole, which does not depend on the length of the string");
    printf("\n");
}

/* Steps from one length to the next become smaller and smaller. */
static void converges(tally *t, const study_set *set)
{
    int grown = 0;
    for (int k = 2; k < set->count; ++k)
        for (int i = 1; i < STUDY_MODES; i += 2) {
            const double *two = set->point[k - 2].bending, *one = set->point[k - 1].bending,
                         *now = set->point[k].bending;
            grown += fabs(now[i] - one[i]) >= fabs(one[i] - two[i]);
        }
    const study_point *p = set->point, *end = p + set->count - 1;
    study_claim(t, "figure 14",
                "frequency is largest and falls fastest in the shallow hole, and tends to a value in the deep one");
    printf("     here: order 10 falls by %.2f Hz from %g to %g m and by %.3f Hz from %g to %g m; steps that grow: %d\n",
           fifth_bending(p) - fifth_bending(p + 1), p->value, p[1].value, fifth_bending(end - 1) - fifth_bending(end),
           end[-1].value, end->value, grown);
    study_verdict(t, grown == 0 ? CONFIRMED : NOT_CONFIRMED,
                  "for all five orders, without a wall; the value they tend to is 0, as 1/L^2");
}

static void orders(tally *t, const study_set *set)
{
    const study_point *first = set->point, *last = first + set->count - 1;
    const double shallow = first->bending[STUDY_MODES - 1] - first->bending[0];
    const double deep = last->bending[STUDY_MODES - 1] - last->bending[0];
    study_claim(t, "figure 14, abstract", "the order of a mode matters in the shallow hole and hardly in the deep one");
    printf("     here: the fifth bending lies %.3f Hz above the first at %g m, %.3f Hz at %g m (as ratios %.1f and "
           "%.1f);\n"
           "     on the wall the tenth mode lies %.3f and %.3f Hz above the first, %.3f Hz\n",
           shallow, first->value, deep, last->value, first->bending[STUDY_MODES - 1] / first->bending[0],
           last->bending[STUDY_MODES - 1] / last->bending[0], first->on_wall[STUDY_MODES - 1] - first->on_wall[0],
           last->on_wall[STUDY_MODES - 1] - last->on_wall[0], last->on_wall[0]);
    study_verdict(t, deep < 0.1 * shallow ? CONFIRMED : NOT_CONFIRMED,
                  "in hertz, as figure 14 shows them; as ratios without a wall the orders lie as far apart as before");
}

static void pipe_length(tally *t, const study_set *set)
{
    const double change[] = {largest_change(set, first_bending), largest_change(set, fifth_bending),
                             largest_change(set, around), largest_change(set, along)};
    double worst = 0.0;
    for (int i = 0; i < 4; ++i) worst = fmax(worst, change[i]);
    study_claim(t, "figure 15, abstract",
                "natural frequencies hardly depend on the length of each pipe, compared with the depth");
    printf("     here: pipes of %g to %g m change the first bending by %.1e, the fifth by %.1e, around by %.1e,\n"
           "     along by %.1e; on the wall by %.1e\n",
           set->point[0].value, set->point[set->count - 1].value, change[0], change[1], change[2], change[3],
           largest_change(set, on_wall));
    study_verdict(t, worst < 0.01 ? CONFIRMED : NOT_CONFIRMED,
                  "joints are rigid, so that a pipe's length is only where the eccentric masses change direction");
}

static void tubes(tally *t, const study_modal *m)
{
    double worst = 0.0, spread = 0.0;
    study_claim(t, "verification", "measured on a steel tube of 7, 8.5, 10 m: 0.94547, 0.64124, 0.46330 Hz");
    printf("     here:");
    for (int i = 0; i < STUDY_TUBES; ++i) {
        printf(" %.5f", m->tube[i]);
        worst = fmax(worst, fabs(m->tube[i] - study_tube_reference[i]));
        const double scaled = study_tube_reference[i] * pow(study_tube_length[i] / study_tube_length[0], 2.0);
        spread = fmax(spread, fabs(scaled / study_tube_reference[0] - 1.0));
    }
    printf(" Hz. The study's three figures are as 1/L^2 to within %.1e, closer than a measurement\n"
           "     of a tube with its clamp and air comes\n",
           spread);
    study_verdict(
        t, worst <= 0.5e-5 + 1e-9 ? CONFIRMED_IF : NOT_CONFIRMED,
        "the tube is of 50/40 mm, 210 GPa, 7850 kg/m3, clamped at one end: chosen to fit, so that one of the\n"
        "     three figures is fitted and two follow");
    study_claim(t, "verification", "the trend is the experiment's: the shorter, the higher and the faster the fall");
    printf("     here: %.5f Hz from 7 to 8.5 m, %.5f Hz from 8.5 to 10 m\n", m->tube[0] - m->tube[1],
           m->tube[1] - m->tube[2]);
    study_verdict(
        t, m->tube[0] - m->tube[1] > m->tube[1] - m->tube[2] && m->tube[1] > m->tube[2] ? CONFIRMED : NOT_CONFIRMED,
        "of a clamped tube, as of the string without a wall");
}

void study_claim_lengths(tally *t, const study_results *results)
{
    const study_set *lengths = results->sets + STUDY_LENGTHS;
    by_order(t, lengths);
    drilled_length(t, lengths);
    converges(t, lengths);
    orders(t, lengths);
    pipe_length(t, results->sets + STUDY_PIPE_LENGTHS);
    tubes(t, &results->modal);
}
