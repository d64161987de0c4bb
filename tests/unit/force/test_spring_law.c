/* One-sided springs between points: which side they act on, the damper that never turns the sum round, derivatives and
 * energies, and characteristics that begin nowhere or everywhere. */
#include "drillmbd/scene.h"
#include "force/spring_law.h"
#include "force_test.h"

static dmb_spring_force force_of(const dmb_spring_law *law, double e, double s)
{
    dmb_spring_force f;
    dmb_spring_force_at(law, NULL, e, s, &f);
    return f;
}

/* A rope pulls, a buffer pushes: p + k e + c s on its side of -p/k while that has its sign, else nothing. */
static void one_sided(void **state)
{
    const double k = 200.0, c = 30.0, p = 5.0;
    (void)state;
    for (int32_t acts = DMB_SPRING_BOTH; acts <= DMB_SPRING_COMPRESSION; acts++) {
        dmb_spring_law law = {.stiffness = k, .damping = c, .preload = p, .acts = acts};
        assert_int_equal(dmb_spring_law_prepare(&law, NULL), 1);
        if (acts != DMB_SPRING_BOTH) CHECK_CLOSE(law.slack, -p / k, 1e-15);
        const double sign = acts == DMB_SPRING_COMPRESSION ? -1.0 : 1.0;
        for (double e = -0.31; e < 0.3; e += 0.02)
            for (double s = -4.1; s < 4.0; s += 0.2) {
                const double elastic = p + k * e, sum = elastic + c * s;
                const int slack = acts != DMB_SPRING_BOTH && !(sign * elastic > 0.0);
                const int turned = acts != DMB_SPRING_BOTH && sign * sum < 0.0;
                const dmb_spring_force f = force_of(&law, e, s);
                CHECK_CLOSE(f.elastic, slack ? 0.0 : elastic, 1e-13);
                CHECK_CLOSE(f.elastic + f.damper, slack || turned ? 0.0 : sum, 1e-12);
                CHECK_CLOSE(f.by_elongation, slack || turned ? 0.0 : k, 0.0);
                CHECK_CLOSE(f.by_speed, slack || turned ? 0.0 : c, 0.0);
                const double x = e + p / k, whole = e * (p + 0.5 * k * e);
                CHECK_CLOSE(dmb_spring_energy_at(&law, NULL, e),
                            acts == DMB_SPRING_BOTH ? whole
                            : slack                 ? 0.0
                                                    : 0.5 * k * x * x,
                            1e-13);
            }
    }
}

/* Of one side only: never slack (all push), always slack (all pull), for both sides. */
static void begins_nowhere(void **state)
{
    (void)state;
    for (int32_t acts = DMB_SPRING_TENSION; acts <= DMB_SPRING_COMPRESSION; acts++)
        for (int sign = -1; sign <= 1; sign++) {
            dmb_spring_law law = {.preload = 10.0 * sign, .acts = acts};
            assert_int_equal(dmb_spring_law_prepare(&law, NULL), 0);
        }
    dmb_spring_law both = {.preload = 10.0};
    assert_int_equal(dmb_spring_law_prepare(&both, NULL), 1);
}

/* The cubic: monotone between points that rise and fall, flat at those where they turn, and its energy the integral. */
static void a_table_that_turns(void **state)
{
    static const double x[5] = {-0.2, -0.1, 0.0, 0.2, 0.3}, T[5] = {-40.0, -10.0, -10.0, 30.0, 20.0};
    dmb_spring_point points[5];
    (void)state;
    for (int i = 0; i < 5; i++) points[i] = (dmb_spring_point){.elongation = x[i], .force = T[i]};
    dmb_spring_table_prepare(points, 5, 1);
    const dmb_spring_law law = {.count = 5};
    dmb_spring_force f;
    for (int i = 1; i < 4; i++) {
        dmb_spring_force_at(&law, points, x[i], 0.0, &f);
        CHECK_CLOSE(f.elastic, T[i], 1e-12);
        CHECK_CLOSE(f.by_elongation, 0.0, 1e-12); /* flat before or behind, or a turn */
    }
    for (int i = 0; i + 1 < 5; i++)
        for (double at = 0.05; at < 1.0; at += 0.05) {
            const double here = x[i] + at * (x[i + 1] - x[i]), h = 1e-6;
            dmb_spring_force_at(&law, points, here, 0.0, &f);
            assert_true(f.elastic >= fmin(T[i], T[i + 1]) - 1e-12 && f.elastic <= fmax(T[i], T[i + 1]) + 1e-12);
            const double energy =
                dmb_spring_energy_at(&law, points, here + h) - dmb_spring_energy_at(&law, points, here - h);
            CHECK_CLOSE(energy / (2.0 * h), f.elastic, 1e-5);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(one_sided), cmocka_unit_test(begins_nowhere),
                                       cmocka_unit_test(a_table_that_turns)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
