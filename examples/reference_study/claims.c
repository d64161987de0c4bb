#include <math.h>
#include <stdio.h>

#include "study.h"

#define LOWEST 6.9e-3 /* [Hz] what the reference says */
#define HIGHEST 2.1e4 /* [Hz] */

enum { RIGID_MODES = 4 };

enum { DIFFERS = 0, AGREES = 1, IN_ONE_READING = 2, NOT_LOOKED_AT = 3, VERDICTS = 4 };
static const char *const verdicts[VERDICTS] = {"DOES NOT AGREE", "AGREES", "AGREES IN ONE READING", "NOT LOOKED AT"};

typedef struct tally {
    int count[VERDICTS];
} tally;

static void claim(const tally *t, const char *words)
{
    int number = 1;
    for (int i = 0; i < VERDICTS; ++i) number += t->count[i];
    printf("%3d  %s\n", number, words);
}

/* The text behind it gives the reason. */
static void begin_verdict(tally *t, int which)
{
    printf("     %s: ", verdicts[which]);
    t->count[which]++;
}

static void verdict(tally *t, int which, const char *why)
{
    begin_verdict(t, which);
    printf("%s\n", why);
}

/* ---- Modes ------------------------------------------------------------------------------------------------------- */

/* on_wall: [Hz] the lowest of the same string on the wall. */
static void lowest(tally *t, const study_modal *m, double on_wall)
{
    claim(t, "the lowest natural frequency is 6.9e-3 Hz");
    printf("     here %.3e Hz; %.3e Hz with the bit of 5 kg\n", m->without_bit, m->shape_frequency[0]);
    const int same = fabs(m->without_bit - LOWEST) <= 0.05e-3;
    begin_verdict(t, same ? AGREES : DIFFERS);
    printf("%sfor the string held at its head and nowhere else", same ? "to the digits given, " : "");
    if (m->shape_frequency[0] < m->without_bit && on_wall > m->without_bit)
        printf(": a bit lowers it, and\n     a wall that carries the string raises it (see drilled length)");
    printf("\n");
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
    int which = fabs(mesh - HIGHEST) <= 0.05e4 ? AGREES : DIFFERS, fits = -1;
    claim(t, "the highest natural frequency is 2.1e4 Hz");
    printf("     here %.3e Hz with one element a pipe", mesh);
    for (int i = 0; i + 1 < STUDY_MESHES; ++i)
        if (m->highest[i] < HIGHEST && m->highest[i + 1] >= HIGHEST)
            printf(", %.3e Hz with %d and %.3e Hz with %d", m->highest[i], i + 1, m->highest[i + 1], i + 2);
    printf(";\n     with pipes described by 12 shapes of their ends and normal modes, as flexible bodies often are:\n  "
           "   ");
    for (int i = 0; i < STUDY_NORMALS; ++i) {
        printf("%s%.3e Hz with %d", i > 0 ? ", " : "", m->by_modes[i], study_normal_modes[i]);
        if (fabs(m->by_modes[i] - HIGHEST) <= 0.05e4) fits = i;
    }
    if (which == DIFFERS && fits >= 0) which = IN_ONE_READING;
    printf("\n");
    begin_verdict(t, which);
    if (grows(m))
        printf("it is a figure of how a pipe is described and not of the string: it grows with every\n"
               "     element and mode. ");
    printf("The reference's 6 + 22 coordinates a pipe would be 12 shapes and 16 normal modes");
    if (fits >= 0) printf("; it is\n     %d normal modes that come to its figure", study_normal_modes[fits]);
    printf("\n");
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
    const int same = worst <= 0.5e-5 + 1e-9;
    begin_verdict(t, same ? AGREES : DIFFERS);
    printf("%sclamped at one end\n", same ? "to the digits given, " : "");
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
    begin_verdict(t, rises == 0 ? AGREES : DIFFERS);
    if (rises == 0)
        printf("every one of them at every step of the way, without a wall.");
    else
        printf("without a wall one of them stays or rises %d times from one length to the next.", rises);
    if (largest_change(set, on_wall) < 0.1)
        printf(" On the wall the lowest stays\n"
               "     that of pipes swinging in the hole, which does not know how long the string is");
    printf("\n");
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
            "joints are rigid, so that a pipe's length is only where the eccentric masses change direction");
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

/* Another reading: what shakes is not the whole friction but what the wall force swings by in the run in time, and the
 * eccentric masses lie all to one side. [m] The eccentricity that crosses where the reference does; the range of the
 * usual ones. */
static double shaking_reading(const study_results *results, double range[2])
{
    const study_scene scene = study_base();
    const double part = sqrt(2.0) * results->runs[STUDY_RUBBING].wall_swing;
    range[0] = (double)INFINITY;
    range[1] = 0.0;
    for (int i = 0; i < STUDY_CASES; ++i) {
        double found[2];
        study_crossover(&results->shaken.aligned, part, study_case_eccentricity[i] / scene.pipe.eccentricity, found);
        range[0] = fmin(range[0], found[0]);
        range[1] = fmax(range[1], found[0]);
    }
    return part * scene.pipe.eccentricity * study_ratio_at(&results->shaken.aligned, STUDY_REFERENCE_CROSSOVER);
}

static int within(const double range[2], double value)
{
    return range[0] <= value && value <= range[1];
}

static void crossover(tally *t, const study_results *results)
{
    const study_scene scene = study_base();
    const study_shaken *shaken = &results->shaken;
    const double whole = study_ratio_at(&shaken->response, STUDY_REFERENCE_CROSSOVER);
    const double step = study_case_friction[STUDY_CASES - 1] / scene.wall.mu_dynamic;
    double range[2] = {(double)INFINITY, 0.0};
    for (int i = 0; i < STUDY_CASES; ++i) {
        range[0] = fmin(range[0], shaken->crossover[i][0]);
        range[1] = fmax(range[1], shaken->crossover[i][0]);
    }
    int which = within(range, STUDY_REFERENCE_CROSSOVER) ? AGREES : DIFFERS;
    claim(t, "that frequency is 1.58 Hz");
    printf(
        "     here %.2f to %.2f Hz for eccentricities of 0.5 to 2 mm and the whole friction or its step of 0.05; at\n"
        "     1.58 Hz %.1f mm would be as strong as the whole friction, %.1f mm as the step\n",
        range[0], range[1], 1e3 * scene.pipe.eccentricity * whole, 1e3 * scene.pipe.eccentricity * whole * step);
    if (results->timed) {
        double other[2];
        const double fits = shaking_reading(results, other);
        printf("     If only that part of the friction shakes which the wall force swings by in the run of 40 s, %.1f "
               "%%,\n"
               "     and the masses lie all to one side: %.2f to %.2f Hz, and 1.58 Hz for %.2f mm\n",
               100.0 * results->runs[STUDY_RUBBING].wall_swing, other[0], other[1], 1e3 * fits);
        if (which == DIFFERS && within(other, STUDY_REFERENCE_CROSSOVER)) which = IN_ONE_READING;
    } else
        printf("     The reading that takes the friction that shakes from the run in time is not tried in the short "
               "form\n");
    verdict(t, which,
            "it follows from the ratio of friction that shakes to eccentricity, which the\n"
            "     reference does not give");
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

static void sag(tally *t, const study_run *runs)
{
    const study_run *stiff = runs + STUDY_RIGID, *full = runs + STUDY_FULL;
    const double sags = full->height[0] - full->height[1], lies = stiff->height[0] - stiff->height[1];
    const dmb_environment_def surroundings = dmb_environment_def_default();
    const double weight = fabs(surroundings.gravity[2]);
    claim(t, "the bit of the flexible system sags, that of the rigid one bounces");
    printf(
        "     here the flexible one's bit hangs %.2f mm below the end of pipe 1, the rigid one's %.2f mm; in 40 s it\n"
        "     leaves the wall %d times, the rigid one's %d times\n",
        1e3 * sags, 1e3 * lies, full->left, stiff->left);
    printf(
        "     Dropped from the axis both bounce: the rigid one %d times until %.2f s, the flexible one %d times until\n"
        "     %.2f s. A mass off its axis lifts a string off the wall if e w^2 > g: %.1f mm at %g rpm\n",
        runs[STUDY_RIGID_DROPPED].left, runs[STUDY_RIGID_DROPPED].last_left, runs[STUDY_FULL_DROPPED].left,
        runs[STUDY_FULL_DROPPED].last_left, 1e3 * weight / pow(STUDY_ROTATION, 2.0), RIG_ROTATION_RPM);
    printf("     With a bit of %g mm, which meets the wall itself, the rigid one's goes up and down at %.2f mm/s, the "
           "flexible\n"
           "     one's at %.2f mm/s\n",
           1e3 * STUDY_BIT, 1e3 * runs[STUDY_RIGID_BIT].bit_speed, 1e3 * runs[STUDY_FULL_BIT].bit_speed);
    int which = sags > 10.0 * fabs(lies) && stiff->left > full->left ? AGREES : DIFFERS;
    const int bounces = runs[STUDY_RIGID_BIT].bit_speed > 5.0 * runs[STUDY_FULL_BIT].bit_speed;
    if (which == DIFFERS && bounces) which = IN_ONE_READING;
    begin_verdict(t, which);
    if (sags > 10.0 * fabs(lies)) printf("the flexible one sags. ");
    if (stiff->left + full->left == 0)
        printf("Pipes roll up and down the low side and leave it not once");
    else
        printf("Pipes leave the low side %d times", stiff->left + full->left);
    if (bounces)
        printf("; a rigid\n"
               "     string takes its bit along, a flexible one leaves a bit that meets the wall lying there");
    printf("\n");
}

static void speed_up(tally *t, const study_run *run)
{
    int rises = 1;
    for (int p = 1; p < RIG_PIPES; ++p) rises &= run->speed[p] > run->speed[p - 1] && run->jumps[p] > run->jumps[p - 1];
    claim(t, "speed in Z grows and jumps more often towards the deep end");
    printf("     here %.2f, %.2f, %.2f mm/s at pipes 1, 50, 100; %.2f, %.2f, %.2f jumps a second, of more than 1 mm/s "
           "in 1 ms\n",
           1e3 * run->speed[0], 1e3 * run->speed[1], 1e3 * run->speed[2], run->jumps[0], run->jumps[1], run->jumps[2]);
    verdict(t, rises,
            "over the whole cycle, with friction and vibration: the head guides the first pipes, and the\n"
            "     far end swings up the wall more than the middle when the string is pulled");
}

static void energies(tally *t, const study_run *runs)
{
    const study_run *contact = runs + STUDY_CONTACT, *rubbing = runs + STUDY_RUBBING, *full = runs + STUDY_FULL;
    double by_friction = 0.0, by_vibration = 0.0, fallen = 0.0, risen = 0.0; /* the last two: pulling out */
    int lowered = 0;
    claim(t, "kinetic energy of pipe 100: contact < with friction < with vibration too, which lowers it in places");
    printf("     here %.4f J drilling;", study_energy(contact, 0));
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage) {
        const double rubs = study_energy(rubbing, stage) - study_energy(contact, stage);
        const double shakes = study_energy(full, stage) - study_energy(rubbing, stage);
        printf(" friction adds %.1f mJ and vibration %.1f mJ %s", 1e3 * rubs, 1e3 * shakes,
               stage == 0 ? "drilling,\n    " : "pulling out;");
        by_friction += rubs;
        by_vibration += shakes;
        for (int k = 0; k < STUDY_WINDOWS; ++k) lowered += full->energy[stage][k] < rubbing->energy[stage][k];
    }
    printf(" it lowers it in %d of %d stretches\n     of four revolutions\n", lowered, STUDY_DRIVEN * STUDY_WINDOWS);
    for (int k = 0; k < STUDY_WINDOWS; ++k) {
        const double shakes = full->energy[STUDY_DRIVEN - 1][k] - rubbing->energy[STUDY_DRIVEN - 1][k];
        fallen -= fmin(shakes, 0.0) / STUDY_WINDOWS;
        risen += fmax(shakes, 0.0) / STUDY_WINDOWS;
    }
    begin_verdict(t, by_friction > 0.0 && by_vibration > 0.0 && lowered > 0 ? AGREES : DIFFERS);
    printf("on the mean of both; of its mean pulling out, stretches in which vibration lowers it take\n"
           "     %.1f mJ, those in which it raises it give %.1f mJ\n",
           1e3 * fallen, 1e3 * risen);
}

/* [s] in which the swing while drilling falls by e. */
static double fall_time(const study_run *run)
{
    const int last = STUDY_WINDOWS - 1;
    const double time = study_window_begin(run, 0, last) - study_window_begin(run, 0, 0);
    return time / log(run->swing[0][0] / run->swing[0][last]);
}

/* The swing above the settled one, in the last window that ends by 10 s over that in the first. */
static void decay(tally *t, const study_results *results)
{
    const study_run *runs = results->runs, *full = runs + STUDY_FULL;
    const study_set *lengths = results->sets + STUDY_LENGTHS;
    const double rate = STUDY_TURN * lengths->point[lengths->count - 1].torsional;
    const double damping = study_base().pipe.damping_time;
    double settled = 0.0, most = 0.0, least = (double)INFINITY;
    int ten = 0, late = 0;
    for (int k = 0; k < STUDY_WINDOWS; ++k) {
        if (study_window_end(full, 0, k) <= 10.0) ten = k;
        if (study_window_begin(full, 0, k) < 15.0) continue;
        settled += full->swing[0][k];
        most = fmax(most, full->swing[0][k]);
        least = fmin(least, full->swing[0][k]);
        late++;
    }
    settled /= late;
    const double left = (full->swing[0][ten] - settled) / (full->swing[0][0] - settled);
    const double spread = (most - least) / settled;
    claim(t, "kinetic energy of pipe 100 decays within 10 s and settles after 15 s");
    printf("     here it swings by %.4f J after the start, %.4f J before 10 s and %.4f J after 15 s, there within %.0f "
           "%%:\n"
           "     %.0f %% of what goes away is left at 10 s. Without vibration %.4f, %.4f, %.4f J\n",
           full->swing[0][0], full->swing[0][ten], settled, 100.0 * spread, 100.0 * left,
           runs[STUDY_RUBBING].swing[0][0], runs[STUDY_RUBBING].swing[0][ten],
           runs[STUDY_RUBBING].swing[0][STUDY_WINDOWS - 1]);
    printf(
        "     With contact only it falls by e in %.2f s; the damping of steel does so to the first swinging around in\n"
        "     2/(tau w^2) = %.2f s\n",
        fall_time(runs + STUDY_CONTACT), 2.0 / (damping * rate * rate));
    verdict(t, left < 0.25 && spread < 0.1,
            "what decays is what the start left swinging around, and the damping of the steel, which is\n"
            "     assumed, says how fast; what stays is what drive and eccentric masses shake");
}

static void in_time(tally *t, const study_results *results)
{
    static const char *const words[] = {"the bit of the flexible system sags, that of the rigid one bounces",
                                        "speed in Z grows and jumps more often towards the deep end",
                                        "kinetic energy of pipe 100 with contact, friction and vibration",
                                        "kinetic energy of pipe 100 decays within 10 s and settles after 15 s"};
    if (results->timed) {
        sag(t, results->runs);
        speed_up(t, results->runs + STUDY_FULL);
        energies(t, results->runs);
        decay(t, results);
        return;
    }
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        claim(t, words[i]);
        verdict(t, NOT_LOOKED_AT, "the short form leaves out the drilling cycle in time");
    }
}

void study_claims_print(const study_results *results)
{
    tally t = {{0}};
    const study_modal *modal = &results->modal;
    const study_set *lengths = results->sets + STUDY_LENGTHS;
    printf("What the reference says, and what is so here\n");
    lowest(&t, modal, lengths->point[lengths->count - 1].on_wall[0]);
    highest(&t, modal);
    rigid(&t, modal);
    tubes(&t, modal);
    drilled_length(&t, lengths);
    pipe_length(&t, results->sets + STUDY_PIPE_LENGTHS);
    orders(&t, lengths);
    dominance(&t, &results->shaken);
    crossover(&t, results);
    growth(&t, &results->shaken);
    in_time(&t, results);
    printf("%d agree, %d agree in one reading, %d do not", t.count[AGREES], t.count[IN_ONE_READING], t.count[DIFFERS]);
    if (t.count[NOT_LOOKED_AT] > 0) printf(", %d are not looked at", t.count[NOT_LOOKED_AT]);
    printf("\n");
}
