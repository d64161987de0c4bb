/* Rainflow counting against the example of ASTM E1049 (figure 6), and, on random sequences, against a second way: the
 * recursive definition on the whole sequence, in which the innermost ranges are taken out first. Ranges are compared by
 * levels; what is told are the values that stand farthest out in them. Equations: eq:fatigue.rainflow. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "output/output.h"

enum { LEVELS = 24, LENGTH = 4000 };

/* Cycles by levels; sums over them of their range to the fourth power, as damage goes, and of their turning points and
 * the squares of these. */
typedef struct tally {
    double cycles[LEVELS][LEVELS], fourth, points, squares;
} tally;

static void count(void *context, const dmb_turn *low, const dmb_turn *high, double weight)
{
    tally *to = context;
    assert_true(low->level < high->level && high->level < LEVELS && low->value < high->value);
    assert_true((uint32_t)floor(low->value) == low->level && (uint32_t)floor(high->value) == high->level);
    to->cycles[low->level][high->level] += weight;
    to->fourth += weight * pow(high->value - low->value, 4.0);
    to->points += weight * (low->value + high->value);
    to->squares += weight * (low->value * low->value + high->value * high->value);
}

static void run(const double *sequence, size_t n, tally *found)
{
    dmb_turn turns[LEVELS + 2];
    dmb_rainflow flow = {turns, 0, 0};
    for (size_t i = 0; i < n; i++) {
        dmb_rainflow_add(&flow, (uint32_t)floor(sequence[i]), sequence[i], count, found);
        assert_true(flow.count <= LEVELS + 2);
    }
    dmb_rainflow_rest(&flow, count, found);
}

/* -2, 1, -3, 5, -1, 3, -4, 4, -2 [units], levels from -4 on: ranges 3 .5, 4 1.5, 6 .5, 8 1, 9 .5. */
static void example_of_the_standard(void **state)
{
    static const double sequence[9] = {2.0, 5.0, 1.0, 9.0, 3.0, 7.0, 0.0, 8.0, 2.0};
    static const double wanted[10] = {0.0, 0.0, 0.0, 0.5, 1.5, 0.0, 0.5, 0.0, 1.0, 0.5};
    tally found = {.fourth = 0.0};
    double by_range[LEVELS] = {0.0}, fourth = 0.0;
    (void)state;
    run(sequence, 9, &found);
    for (int i = 0; i < LEVELS; i++)
        for (int j = i; j < LEVELS; j++) by_range[j - i] += found.cycles[i][j];
    for (int i = 0; i < 10; i++) {
        check_close("cycles", by_range[i], wanted[i], 0.0);
        fourth += wanted[i] * pow(i, 4.0);
    }
    check_close("from -1 to 3", found.cycles[3][7], 1.0, 0.0);
    check_relative("ranges to the fourth power", found.fourth, fourth, 1e-14);
}

/* A sine of constant amplitude: the ranges told are its own, wherever levels lie, but for the start's. */
static void ranges_are_those_of_the_values(void **state)
{
    (void)state;
    for (int k = 0; k < 50; k++) {
        static double sequence[LENGTH];
        const double middle = 12.0 + 0.02 * k, amplitude = 3.0 + 0.031 * k;
        tally found = {.fourth = 0.0};
        for (int i = 0; i < LENGTH; i++) sequence[i] = middle + amplitude * cos(2.0 * PI * i / 40.0);
        run(sequence, LENGTH, &found);
        check_relative("range to the fourth power", found.fourth / (LENGTH / 40 - 0.5), pow(2.0 * amplitude, 4.0),
                       1e-2);
    }
}

static size_t turning_points(const double *sequence, size_t n, dmb_turn *turns)
{
    size_t m = 0;
    for (size_t i = 0; i < n; i++) {
        const dmb_turn turn = {sequence[i], (uint32_t)floor(sequence[i]), 0};
        if (m > 0 && turns[m - 1].level == turn.level) {
            if (m == 1) continue; /* the start */
            const int up = turns[m - 1].level > turns[m - 2].level;
            if (up == (turn.value > turns[m - 1].value)) turns[m - 1].value = turn.value;
            continue;
        }
        if (m > 1 && (turns[m - 1].level > turns[m - 2].level) == (turn.level > turns[m - 1].level)) m--;
        turns[m++] = turn;
    }
    return m;
}

static uint32_t gap(const dmb_turn *a)
{
    return a[0].level > a[1].level ? a[0].level - a[1].level : a[1].level - a[0].level;
}

static void count_between(tally *to, const dmb_turn *a, double weight)
{
    const int up = a[0].level < a[1].level;
    count(to, a + !up, a + up, weight);
}

/* Four neighbours whose middle range is within both others: a cycle, taken out wherever it stands, until none is left;
 * the rest, whose ranges grow and then shrink, are half cycles. */
static void by_definition(const double *sequence, size_t n, tally *found)
{
    static dmb_turn t[LENGTH];
    size_t m = turning_points(sequence, n, t), i = 0;
    while (i + 3 < m) {
        if (gap(t + i + 1) > gap(t + i) || gap(t + i + 1) > gap(t + i + 2)) {
            i++;
            continue;
        }
        count_between(found, t + i + 1, 1.0);
        memmove(t + i + 1, t + i + 3, (m - i - 3) * sizeof *t);
        m -= 2;
        i = 0;
    }
    for (i = 1; i < m; i++) count_between(found, t + i - 1, 0.5);
}

/* In whatever pairs, each turning point is told once and each end half. */
static void check_sums(const tally *found, const double *sequence, size_t n)
{
    static dmb_turn t[LENGTH];
    const size_t m = turning_points(sequence, n, t);
    double points = 0.0, squares = 0.0;
    for (size_t i = 0; i < m && m > 1; i++) {
        const double weight = i == 0 || i + 1 == m ? 0.5 : 1.0;
        points += weight * t[i].value;
        squares += weight * t[i].value * t[i].value;
    }
    if (fabs(found->points - points) > 1e-12 * points || fabs(found->squares - squares) > 1e-12 * squares)
        fail_msg("%zu: sums %.17g, %.17g, wanted %.17g, %.17g", n, found->points, found->squares, points, squares);
}

static void random_sequences(void **state)
{
    static double sequence[LENGTH];
    uint64_t seed = 7;
    (void)state;
    for (int round = 0; round < 200; round++) {
        const size_t n = round < 150 ? (size_t)round + 1 : LENGTH;
        tally found = {.fourth = 0.0}, wanted = {.fourth = 0.0};
        for (size_t i = 0; i < n; i++) sequence[i] = draw_between(&seed, 0.0, LEVELS - 1e-9);
        run(sequence, n, &found);
        by_definition(sequence, n, &wanted);
        assert_memory_equal(found.cycles, wanted.cycles, sizeof found.cycles);
        check_sums(&found, sequence, n);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(example_of_the_standard),
        cmocka_unit_test(ranges_are_those_of_the_values),
        cmocka_unit_test(random_sequences),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
