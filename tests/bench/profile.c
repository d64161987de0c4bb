/* The cost of profiles of scene B: one quantity, and all of them. usage: profile [QUANTITY STATIONS]
 *
 * Thread time in us of the best of twenty repeats, and over that of a step. With a quantity, DMB_PROFILE_..., one query
 * alone, so that its instructions can be counted:
 *     valgrind --tool=callgrind --toggle-collect=dmb_query_profile build/release/tests/bench_profile 9 101 */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <stdlib.h>

#include "scenes.h"

#include "row.h"

enum { STATIONS_MOST = 1001, QUANTITIES = DMB_PROFILE_GAP + 1, STEPS_BEFORE = 300, REPEATS = 20, EACH = 20 };

static double values[STATIONS_MOST * QUANTITIES];

static int32_t ask(const scene *s, const dmb_sim *sim, int32_t quantity, uint32_t stations)
{
    int32_t all[QUANTITIES];
    dmb_profile profile = dmb_profile_default();
    for (int32_t i = 0; i < QUANTITIES; i++) all[i] = i;
    profile.string = s->string;
    profile.station_count = stations;
    profile.quantities = quantity < 0 ? all : &quantity;
    profile.quantity_count = quantity < 0 ? QUANTITIES : 1;
    profile.values = values;
    return dmb_query_profile(sim, &profile);
}

/* [us] of a profile, or of a step where stations is 0 */
static double time_of(const scene *s, dmb_sim *sim, int32_t quantity, uint32_t stations)
{
    double best = 1.0;
    for (int k = 0; k < REPEATS; k++) {
        const double start = processor_time();
        for (int i = 0; i < EACH; i++)
            if ((stations > 0 ? ask(s, sim, quantity, stations) : dmb_sim_step(sim, 1e-3, NULL)) < 0) exit(1);
        best = fmin(best, (processor_time() - start) / EACH);
    }
    return 1e6 * best;
}

static void compare(const scene *s, dmb_sim *sim)
{
    static const int32_t asked[4] = {DMB_PROFILE_EFFECTIVE_FORCE, DMB_PROFILE_BENDING_MOMENT, DMB_PROFILE_VON_MISES,
                                     -1};
    static const char *const names[4] = {"effective force", "bending moment", "von Mises stress", "all"};
    for (int i = 0; i < 4; i++)
        for (uint32_t stations = 101; stations <= 201; stations += 100) {
            const double profile = time_of(s, sim, asked[i], stations), step = time_of(s, sim, 0, 0);
            printf("%s, %u stations: %.1f us, %.2f steps\n", names[i], (unsigned)stations, profile, profile / step);
        }
}

int main(int argc, char **argv)
{
    scene s = {.kind = SCENE_B, .pipes = 100, .per_pipe = 1, .length = 1.0};
    dmb_sim *sim = NULL;
    int32_t status = scene_open(&s);
    if (status >= 0) status = dmb_sim_create(s.model, NULL, &sim);
    for (int k = 0; k < STEPS_BEFORE && status >= 0; k++) status = dmb_sim_step(sim, 1e-3, NULL);
    if (status >= 0 && argc > 2) status = ask(&s, sim, (int32_t)atoi(argv[1]), (uint32_t)atoi(argv[2]));
    if (status >= 0 && argc <= 2) compare(&s, sim);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&s.model);
    return status < 0;
}
