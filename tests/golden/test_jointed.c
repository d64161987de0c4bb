/* The same bits in every build: the hash of a scene with joints, which the builds without LAPACKE, the two files on
 * other machines and the library in a browser are compared with too. A change of results that is meant is written into
 * jointed.h, with its reason under Numerics in CHANGELOG.md. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"

#include "../firmware/jointed.h"

static void hash_is_as_stored(void **state)
{
    uint64_t hash = 0;
    (void)state;
    assert_int_equal(jointed_run(NULL, &hash), DMB_OK);
    if (hash != JOINTED_HASH)
        fail_msg("the end state has the hash %016llx, stored is %016llx", (unsigned long long)hash,
                 (unsigned long long)JOINTED_HASH);
}

/* The scene needs an order of elimination: constraints that share no node, and one cluster of many. */
static void scene_needs_an_order(void **state)
{
    dmb_model *model = NULL;
    dmb_model_info info = dmb_model_info_default();
    (void)state;
    assert_int_equal(dmb_model_create(NULL, &model), DMB_OK);
    assert_int_equal(jointed_describe(model), DMB_OK);
    assert_int_equal(dmb_model_get_info(model, &info), DMB_OK);
    assert_int_equal(info.clusters, 7);
    assert_int_equal(info.joints, 25);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(hash_is_as_stored), cmocka_unit_test(scene_needs_an_order)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
