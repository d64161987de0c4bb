/* Rainflow counting against the example of ASTM E1049 (figure 6), and, on random sequences, against a second way: the
 * recursive definition on the whole sequence, in which the innermost ranges are taken out first. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "output/output.h"

enum { LEVELS = 24, LENGTH = 4000 };

static void count(void *context, uint32_t low, uint32_t high, double weight)
{
    assert_true(low < high && high < LEVELS);
    ((double(*)[LEVELS])context)[low][high] += weight;
}

static void run(const uint32_t *sequence, size_t n, double table[LEVELS][LEVELS])
{
    uint32_t turns[LEVELS + 2];
    dmb_rainflow flow = {turns, 0, 0};
    for (size_t i = 0; i < n; i++) {
        dmb_rainflow_add(&flow, sequence[i], count, table);
        assert_true(flow.count <= LEVELS + 2);
    }
    dmb_rainflow_rest(&flow, count, table);
}

/* -2, 1, -3, 5, -1, 3, -4, 4, -2 [units], levels from -4 on: ranges 3 .5, 4 1.5, 6 .5, 8 1, 9 .5. */
static void example_of_the_standard(void **state)
{
    static const uint32_t sequence[9] = {2, 5, 1, 9, 3, 7, 0, 8, 2};
    static const double wanted[10] = {0.0, 0.0, 0.0, 0.5, 1.5, 0.0, 0.5, 0.0, 1.0, 0.5};
    double table[LEVELS][LEVELS] = {{0.0}}, by_range[LEVELS] = {0.0};
    (void)state;
    run(sequence, 9, table);
    for (int i = 0; i < LEVELS; i++)
        for (int j = i; j < LEVELS; j++) by_range[j - i] += table[i][j];
    for (int i = 0; i < 10; i++) check_close("cycles", by_range[i], wanted[i], 0.0);
    check_close("from -1 to 3", table[3][7], 1.0, 0.0);
}

static size_t turning_points(const uint32_t *sequence, size_t n, uint32_t *turns)
{
    size_t m = 0;
    for (size_t i = 0; i < n; i++) {
        if (m > 0 && turns[m - 1] == sequence[i]) continue;
        if (m > 1 && (turns[m - 1] > turns[m - 2]) == (sequence[i] > turns[m - 1])) m--;
        turns[m++] = sequence[i];
    }
    return m;
}

static uint32_t gap(uint32_t a, uint32_t b)
{
    return a > b ? a - b : b - a;
}

/* Four neighbours whose middle range is within both others: a cycle, taken out wherever it stands, until none is left;
 * the rest, whose ranges grow and then shrink, are half cycles. */
static void by_definition(const uint32_t *sequence, size_t n, double table[LEVELS][LEVELS])
{
    static uint32_t t[LENGTH];
    size_t m = turning_points(sequence, n, t), i = 0;
    while (i + 3 < m) {
        const uint32_t before = gap(t[i], t[i + 1]), middle = gap(t[i + 1], t[i + 2]), after = gap(t[i + 2], t[i + 3]);
        if (middle > before || middle > after) {
            i++;
            continue;
        }
        count(table, t[i + 1] < t[i + 2] ? t[i + 1] : t[i + 2], t[i + 1] < t[i + 2] ? t[i + 2] : t[i + 1], 1.0);
        memmove(t + i + 1, t + i + 3, (m - i - 3) * sizeof *t);
        m -= 2;
        i = 0;
    }
    for (i = 1; i < m; i++) count(table, t[i - 1] < t[i] ? t[i - 1] : t[i], t[i - 1] < t[i] ? t[i] : t[i - 1], 0.5);
}

static void random_sequences(void **state)
{
    static uint32_t sequence[LENGTH];
    uint64_t seed = 7;
    (void)state;
    for (int round = 0; round < 200; round++) {
        const size_t n = round < 150 ? (size_t)round + 1 : LENGTH;
        double found[LEVELS][LEVELS] = {{0.0}}, wanted[LEVELS][LEVELS] = {{0.0}};
        for (size_t i = 0; i < n; i++) sequence[i] = (uint32_t)draw_between(&seed, 0.0, LEVELS - 1e-9);
        run(sequence, n, found);
        by_definition(sequence, n, wanted);
        assert_memory_equal(found, wanted, sizeof found);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(example_of_the_standard), cmocka_unit_test(random_sequences)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
