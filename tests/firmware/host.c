/* The scene of firmware with a console: prints the hash after 100 steps, and the memory that it took; and whether the
 * scene with joints has another hash than it must have. */
#include "scene.h"

#include "jointed.h"

#include <stdio.h>
#ifdef TIMES
#include <time.h>

/* [us] of a step, in the mean of 300. */
static double step_time(void)
{
    const clock_t before = clock();
    for (int i = 0; i < 300; i++) (void)dmb_sim_step(sim, 1e-3, NULL);
    return (double)(clock() - before) / CLOCKS_PER_SEC / 300.0 * 1e6;
}
#endif

/* In a pool of its own. */
static int jointed_as_stored(void)
{
    static _Alignas(64) unsigned char own[640 * 1024];
    dmb_allocator of = dmb_allocator_default();
    dmb_model_options options = dmb_model_options_default();
    uint64_t hash = 0;
    options.allocator = &of;
    return dmb_pool_allocator(own, sizeof own, &of) >= 0 && jointed_run(&options, &hash) >= 0 && hash == JOINTED_HASH;
}

int main(void)
{
    uint64_t hash = 0;
    const int32_t status = run(100, &hash);
    if (status < 0) return printf("%s: %s\n", dmb_status_name(status), dmb_model_message(model)), 1;
    printf("%08lx%08lx%s\n", (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffffu),
           jointed_as_stored() ? "" : " and another hash of the scene with joints");
    fprintf(stderr, "pool: %lu bytes\n", (unsigned long)dmb_pool_peak(&allocator));
#ifdef TIMES
    const double time = step_time();
    printf("pool %lu bytes, %.0f us a step of 1 ms\n", (unsigned long)dmb_pool_peak(&allocator), time);
#endif
    return 0;
}
