#include <math.h>
#include <stdio.h>

#include "claims.h"

enum { DRILLING = 0, PULLING = 1, X = 0, Y = 1, Z = 2 };

static const char *const stage_names[STUDY_DRIVEN] = {"drilling", "pulling out"};

static const study_motion *at(const study_results *results, int run, int stage, int place)
{
    return &results->runs[run].motion[stage][place];
}

/* ---- Figures 4 and 5: the bit ------------------------------------------------------------------------------------ */

static void bit_swings(tally *t, const study_results *results)
{
    int below = 1;
    study_claim(t, "figure 4", "Z of the rigid system's bit: it swings farther below the axis than above");
    printf("     here:");
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage) {
        const study_motion *m = at(results, STUDY_RIGID, stage, RIG_BIT);
        printf("%s %.2f mm above and %.2f mm below its mean, highest at %.2f mm below the hole's axis, %s",
               stage > 0 ? ";\n    " : "", 1e3 * m->above, 1e3 * m->below, -1e3 * m->highest, stage_names[stage]);
        below &= m->below > m->above;
    }
    printf("\n");
    study_verdict(t, below ? CONFIRMED : NOT_CONFIRMED,
                  "a string that rolls up and down the low side of a round hole rises farther than it falls\n"
                  "     about its mean, and never comes up to the hole's axis");
}

static void regular(tally *t, const study_results *results)
{
    const double stiff[] = {at(results, STUDY_RIGID, DRILLING, RIG_BIT)->scatter,
                            at(results, STUDY_RIGID, PULLING, RIG_BIT)->scatter};
    const double soft[] = {at(results, STUDY_FULL, DRILLING, RIG_BIT)->scatter,
                           at(results, STUDY_FULL, PULLING, RIG_BIT)->scatter};
    study_claim(t, "figure 4", "Z of the rigid system's bit shows some regularity");
    printf("     here: standard deviation of successive swings over their mean %.3f drilling, %.3f pulling out\n",
           stiff[0], stiff[1]);
    study_verdict(t, fmax(stiff[0], stiff[1]) < 0.2 ? CONFIRMED : NOT_CONFIRMED, "one swing is like the next");
    study_claim(t, "figure 5", "Z of the flexible system's bit follows no obvious law, with sudden growth and fall");
    printf("     here: %.3f drilling, %.3f pulling out\n", soft[0], soft[1]);
    study_verdict(t, fmin(soft[0], soft[1]) > 3.0 * fmax(stiff[0], stiff[1]) ? CONFIRMED : NOT_CONFIRMED,
                  "swings of the same rig scatter several times as much where its pipes bend and twist");
}

static void far_off(tally *t, const study_results *results)
{
    const double stiff = results->runs[STUDY_RIGID].height[1], soft = results->runs[STUDY_FULL].height[1];
    study_claim(t, "figures 4 and 5", "only the flexible system's bit lies far from the axis, drawn by gravity");
    printf("     here: means over the cycle %.2f mm (rigid) and %.2f mm (flexible) from the hole's axis\n", 1e3 * stiff,
           1e3 * soft);
    study_verdict(
        t, fabs(soft) > 2.0 * fabs(stiff) ? CONFIRMED : NOT_CONFIRMED,
        "both lie on the low side of the hole, 10.5 mm below its axis: the rigid string sinks there as a whole");
}

static void bounce(tally *t, const study_results *results)
{
    const study_run *r = results->runs;
    study_claim(t, "abstract", "the bit bounces more likely in the deep hole");
    printf("     here: the last of 100 pipes leaves the wall %d times in 40 s (rigid %d); dropped from the axis %d "
           "(rigid %d) times\n",
           r[STUDY_FULL].left, r[STUDY_RIGID].left, r[STUDY_FULL_DROPPED].left, r[STUDY_RIGID_DROPPED].left);
    study_verdict(t, UNDECIDED,
                  "at this speed the string rolls on the low side and nothing bounces at any depth; the "
                  "jumps of its\n     speed, which figure 8 shows, have rows of their own");
}

/* ---- Figure 6: kinetic energy of pipe 100 ------------------------------------------------------------------------ */

static void stability(tally *t, const study_run *runs)
{
    int least = 0;
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage)
        for (int k = 0; k < STUDY_WINDOWS; ++k)
            least += runs[STUDY_CONTACT].swing[stage][k] <
                     fmin(runs[STUDY_RUBBING].swing[stage][k], runs[STUDY_FULL].swing[stage][k]);
    study_claim(t, "figure 6",
                "kinetic energy of pipe 100 is steadiest with contact only; friction and vibration add "
                "to its swing");
    printf("     here: contact only swings least in %d of %d stretches of four revolutions\n", least,
           STUDY_DRIVEN * STUDY_WINDOWS);
    study_verdict(t, least == STUDY_DRIVEN * STUDY_WINDOWS ? CONFIRMED : NOT_CONFIRMED,
                  "root mean square about the mean");
}

static void energy_order(tally *t, const study_run *runs)
{
    double shakes[STUDY_DRIVEN];
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage)
        shakes[stage] = study_energy(runs + STUDY_FULL, stage) - study_energy(runs + STUDY_RUBBING, stage);
    study_claim(t, "figure 6",
                "on the whole it is slightly larger with friction and vibration than with friction alone");
    printf("     here: by %.1f mJ drilling and %.1f mJ pulling out, of %.3f J\n", 1e3 * shakes[0], 1e3 * shakes[1],
           study_energy(runs + STUDY_RUBBING, DRILLING));
    study_verdict(t, fmin(shakes[0], shakes[1]) > 0.0 ? CONFIRMED : NOT_CONFIRMED, "means over each stage");
}

static void lowered_swing(tally *t, const study_run *runs)
{
    int half = 0, four = 0;
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage) {
        for (int k = 0; k < STUDY_HALF_TURNS; ++k)
            half += runs[STUDY_FULL].half_turn[stage][k] < runs[STUDY_RUBBING].half_turn[stage][k];
        for (int k = 0; k < STUDY_WINDOWS; ++k)
            four += runs[STUDY_FULL].swing[stage][k] < runs[STUDY_RUBBING].swing[stage][k];
    }
    study_claim(t, "figure 6",
                "in some places it fluctuates more with friction alone: vibration reduces the force, too");
    printf("     here: in %d of %d stretches of half a revolution, in %d of %d of four revolutions\n", half,
           STUDY_DRIVEN * STUDY_HALF_TURNS, four, STUDY_DRIVEN * STUDY_WINDOWS);
    study_verdict(t,
                  four > 0   ? CONFIRMED
                  : half > 0 ? CONFIRMED_IF
                             : NOT_CONFIRMED,
                  "places are as short as half a revolution, 0.15 s");
}

static void largest_drilling(tally *t, const study_run *runs)
{
    const double drilling = study_energy(runs + STUDY_FULL, DRILLING),
                 pulling = study_energy(runs + STUDY_FULL, PULLING);
    study_claim(t, "figure 6", "it is largest while the rig is drilling");
    printf("     here: %.4f J drilling and %.4f J pulling out, 0 at rest between them\n", drilling, pulling);
    study_verdict(t, drilling > pulling ? CONFIRMED : NOT_CONFIRMED,
                  "both stages turn at the same speed; pulled, the string swings farther up the wall");
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
    study_claim(t, "figure 6", "it decays within 10 s and is stable after 15 s");
    printf(
        "     here it swings by %.4f J after the start, %.4f J before 10 s and %.4f J after 15 s, there within %.0f "
        "%%:\n"
        "     %.0f %% of what decays is left at 10 s. With contact only it falls by e in %.2f s; the damping of the\n"
        "     steel does so to the first swinging around in 2/(tau w^2) = %.2f s\n",
        full->swing[0][0], full->swing[0][ten], settled, 100.0 * spread, 100.0 * left, fall_time(runs + STUDY_CONTACT),
        2.0 / (damping * rate * rate));
    study_verdict(
        t, left < 0.25 && spread < 0.1 ? CONFIRMED_IF : NOT_CONFIRMED,
        "the damping of the steel is as assumed: it sets the time in which the torsion of the start dies out");
}

/* ---- Figures 7 to 10: speeds and places -------------------------------------------------------------------------- */

static void time_function(tally *t, const study_run *run)
{
    study_claim(t, "figure 7", "the X speed of pipe 1 follows the time function of six stages");
    printf("     here: off it by %.1e mm/s (root mean square over 40 s) of 10 mm/s\n", 1e3 * run->feed_error);
    study_verdict(t, run->feed_error < 1e-3 * RIG_FEED ? CONFIRMED : NOT_CONFIRMED,
                  "start 0 to 1 s, drill to 19 s, stop to 20 s, rest to 21 s, reverse to 22 s, pull out to 40 s");
}

static void directions(tally *t, const study_results *results)
{
    int z_most = 1, x_least = 1;
    study_claim(t, "figure 7", "of pipe 1, the Z speed fluctuates most");
    printf("     here:");
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage) {
        const double *v = at(results, STUDY_FULL, stage, RIG_FIRST)->speed;
        printf("%s X %.4f, Y %.2f, Z %.2f mm/s %s", stage > 0 ? ";" : "", 1e3 * v[X], 1e3 * v[Y], 1e3 * v[Z],
               stage_names[stage]);
        z_most &= v[Z] > fmax(v[X], v[Y]);
        x_least &= v[X] < fmin(v[Y], v[Z]);
    }
    const double *last = at(results, STUDY_FULL, DRILLING, RIG_LAST)->speed;
    printf(" (root mean square\n     about the mean); of pipe 100 Y %.2f, Z %.2f mm/s drilling\n", 1e3 * last[Y],
           1e3 * last[Z]);
    study_verdict(t, z_most ? CONFIRMED : NOT_CONFIRMED,
                  "Y does, two to three times Z: a pipe on the low side of a round hole moves sideways more than up");
    study_claim(t, "figure 7", "of pipe 1, the X speed fluctuates least");
    printf("     here: the row above\n");
    study_verdict(t, x_least ? CONFIRMED : NOT_CONFIRMED, "the drive prescribes it");
}

static void first_rod(tally *t, const study_results *results)
{
    int least = 1;
    study_claim(t, "figure 8",
                "the Z speed of pipe 1 is affected least by vibration and friction, against pipes 50 and 100");
    printf("     here:");
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage) {
        double v[RIG_PIPES];
        for (int p = 0; p < RIG_PIPES; ++p) v[p] = at(results, STUDY_FULL, stage, p)->speed[Z];
        least &= v[RIG_FIRST] < fmin(v[RIG_MIDDLE], v[RIG_LAST]);
        printf("%s %.2f, %.2f, %.2f mm/s %s", stage > 0 ? ";" : "", 1e3 * v[0], 1e3 * v[1], 1e3 * v[2],
               stage_names[stage]);
    }
    printf("\n");
    study_verdict(t, least ? CONFIRMED : NOT_CONFIRMED, "the head supports it");
}

/* Whether a value rises from pipe 1 to 50 to 100: CONFIRMED in both stages, CONFIRMED_IF over the whole cycle. */
static int rises(const double whole[RIG_PIPES], double stages[STUDY_DRIVEN][RIG_PIPES])
{
    int all = 1, over = 1;
    for (int p = 1; p < RIG_PIPES; ++p) {
        over &= whole[p] > whole[p - 1];
        for (int stage = 0; stage < STUDY_DRIVEN; ++stage) all &= stages[stage][p] > stages[stage][p - 1];
    }
    return all ? CONFIRMED : over ? CONFIRMED_IF : NOT_CONFIRMED;
}

static void growth(tally *t, const study_results *results)
{
    const study_run *run = results->runs + STUDY_FULL;
    double speed[STUDY_DRIVEN][RIG_PIPES], jumps[STUDY_DRIVEN][RIG_PIPES];
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage)
        for (int p = 0; p < RIG_PIPES; ++p) {
            speed[stage][p] = at(results, STUDY_FULL, stage, p)->speed[Z];
            jumps[stage][p] = at(results, STUDY_FULL, stage, p)->jumps;
        }
    study_claim(t, "figure 8, conclusions", "the Z speed grows continuously with the number of the pipe");
    printf("     here: pipes 1, 50, 100: %.2f, %.2f, %.2f mm/s over the cycle\n", 1e3 * run->speed[0],
           1e3 * run->speed[1], 1e3 * run->speed[2]);
    study_verdict(t, rises(run->speed, speed),
                  "the whole cycle is taken; while drilling pipe 100 is a little slower than pipe 50 (row above)");
    study_claim(t, "figure 8, conclusions",
                "sudden jumps of it grow likewise, so that the jump phenomenon is likelier in the deep hole");
    printf("     here: %.2f, %.2f, %.2f jumps a second of more than 1 mm/s in 1 ms over the cycle; %.1f, %.1f, %.1f "
           "drilling;\n     %.1f, %.1f, %.1f pulling out\n",
           run->jumps[0], run->jumps[1], run->jumps[2], jumps[0][0], jumps[0][1], jumps[0][2], jumps[1][0], jumps[1][1],
           jumps[1][2]);
    study_verdict(t, rises(run->jumps, jumps),
                  "the whole cycle is taken; while drilling pipe 100 jumps less than pipe 50");
}

static void places(tally *t, const study_results *results)
{
    const study_motion *m[2][RIG_PIPES];
    for (int stage = 0; stage < STUDY_DRIVEN; ++stage)
        for (int p = 0; p < RIG_PIPES; ++p) m[stage][p] = at(results, STUDY_FULL, stage, p);
    study_claim(t, "figures 9 and 10",
                "mean Y and Z of pipe 1, mean Z of pipes 1, 50 and 100 (values lost in the text)");
    printf("     here: Y of pipe 1 %.2f mm drilling, %.2f mm pulling out; Z of pipes 1, 50, 100 %.2f, %.2f, %.2f mm "
           "drilling,\n     %.2f, %.2f, %.2f mm pulling out\n",
           1e3 * m[0][0]->mean[Y], 1e3 * m[1][0]->mean[Y], 1e3 * m[0][0]->mean[Z], 1e3 * m[0][1]->mean[Z],
           1e3 * m[0][2]->mean[Z], 1e3 * m[1][0]->mean[Z], 1e3 * m[1][1]->mean[Z], 1e3 * m[1][2]->mean[Z]);
    study_verdict(t, UNDECIDED, "the study's values are not in the text that is at hand");
    study_claim(t, "figure 10", "the Z displacement is the more serious one, against Y");
    printf("     here: pipe 1, drilling: mean Z %.2f mm, mean Y %.2f mm from the axis\n", 1e3 * m[0][0]->mean[Z],
           1e3 * m[0][0]->mean[Y]);
    study_verdict(t, fabs(m[0][0]->mean[Z]) > fabs(m[0][0]->mean[Y]) ? CONFIRMED : NOT_CONFIRMED,
                  "the weight acts along Z");
}

/* ---- Abstract ---------------------------------------------------------------------------------------------------- */

static void suppresses(tally *t, const study_results *results)
{
    const double without = at(results, STUDY_RUBBING, PULLING, RIG_LAST)->jumps;
    const double with = at(results, STUDY_FULL, PULLING, RIG_LAST)->jumps;
    study_claim(t, "abstract, conclusions",
                "the coupling of friction and vibration sometimes lowers the amplitude of vibration");
    printf("     here: pulled out, pipe 100 jumps %.0f times a second with friction, %.0f with friction and vibration; "
           "its "
           "Z speed\n     is %.1f and %.1f mm/s\n",
           without, with, 1e3 * at(results, STUDY_RUBBING, PULLING, RIG_LAST)->speed[Z],
           1e3 * at(results, STUDY_FULL, PULLING, RIG_LAST)->speed[Z]);
    study_verdict(t, with < without ? CONFIRMED : NOT_CONFIRMED,
                  "there; in most other places it raises it (rows above)");
}

static void failure(tally *t)
{
    study_claim(t, "abstract, conclusions",
                "the coupling of friction and vibration does not necessarily raise the probability of failure");
    printf("     not computed by this program: examples/failure_probability, 400 samples at 250 rpm and 5 mm/s, finds\n"
           "     0.388 failing with friction and vibration, 0.295 with vibration: 51 more fail and 14 fewer\n");
    study_verdict(t, CONFIRMED_IF,
                  "single holes are meant, of which 14 in 400 are saved by friction; the probability rises");
}

static void simulated(tally *t, const study_run *run)
{
    study_claim(t, "conclusions", "the model can simulate the dynamic responses of the rig in the drilling process");
    printf("     here: %g s of six stages with steps of %g ms, in four variants\n", run->options.end,
           1e3 * run->options.step);
    study_verdict(t, run->status >= 0 ? CONFIRMED : NOT_CONFIRMED, "its rows above, and six pictures");
}

static void all_rows(tally *t, const study_results *results)
{
    bit_swings(t, results);
    regular(t, results);
    far_off(t, results);
    bounce(t, results);
    stability(t, results->runs);
    energy_order(t, results->runs);
    lowered_swing(t, results->runs);
    largest_drilling(t, results->runs);
    decay(t, results);
    time_function(t, results->runs + STUDY_FULL);
    directions(t, results);
    first_rod(t, results);
    growth(t, results);
    places(t, results);
    suppresses(t, results);
    simulated(t, results->runs + STUDY_FULL);
}

void study_claim_time(tally *t, const study_results *results)
{
    static const char *const words[] = {"the bit of the rigid system swings farther below than above",
                                        "it shows some regularity",
                                        "the bit of the flexible system follows no obvious law",
                                        "only the latter lies far from the axis",
                                        "the bit bounces more likely in the deep hole",
                                        "kinetic energy of pipe 100 is steadiest with contact only",
                                        "it is larger with vibration",
                                        "in some places it fluctuates less with vibration",
                                        "it is largest while drilling",
                                        "it decays within 10 s and is stable after 15 s",
                                        "the X speed follows the time function",
                                        "the Z speed fluctuates most",
                                        "the X speed fluctuates least",
                                        "pipe 1 is affected least",
                                        "the Z speed grows with the number of the pipe",
                                        "its jumps, too",
                                        "mean places of pipes 1, 50, 100",
                                        "Z is more serious than Y",
                                        "coupling sometimes lowers the amplitude",
                                        "the model simulates the drilling process"};
    if (results->timed) all_rows(t, results);
    for (size_t i = 0; i < sizeof words / sizeof words[0] && !results->timed; ++i) {
        study_claim(t, "in time", words[i]);
        study_verdict(t, NOT_COMPUTED, "the short form leaves out the drilling cycle in time");
    }
    failure(t);
}
