/* A step made in parts by threads of the caller's: the same bits as alone for any number of parts, in strings that are
 * divided into pieces, with contact, branches, joints, bodies, pipes on the hole's axis, error control and snapshots.
 * Under the thread sanitizer without races. Parts one after the other: test_parallel_parts.c. */
#include <pthread.h>

#include "../../examples/two_cores/pool.h"
#include "parallel_scene.h"

static pool threads;

#ifdef DMB_SOME_CASES
static const uint32_t parts[] = {3, 8};
enum { SCENES_APART = 2 }; /* scenes by turns in 3 and in 8 parts */
#else
static const uint32_t parts[] = {1, 2, 3, 8};
enum { SCENES_APART = 1 };
#endif
enum { CHOICES = sizeof parts / sizeof parts[0] };

static void test_same_bits(void **state)
{
    (void)state;
    for (int kind = 0; kind < SCENES; kind++) {
        rig s = {NULL, NULL};
        describe(&s, kind);
        const uint64_t alone = walk(&s, NULL, NULL);
        for (int i = kind % SCENES_APART; i < CHOICES; i += SCENES_APART) {
            const dmb_sim_options options = in_parts(pool_run, &threads, parts[i]);
            const uint64_t hash = walk(&s, &options, i % 2 ? &options : NULL);
            if (hash != alone) fail_msg("%s in %u parts: other bits", names[kind], (unsigned)parts[i]);
        }
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_bits)};
    (void)pool_start(&threads, 3);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    pool_stop(&threads);
    return failed;
}
