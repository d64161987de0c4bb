/* The count of critical factors where a block is singular before its turn. Equations: eq:buckling.pencil. */
#include <string.h>

#include "check.h"

#include "analysis/buckling/buckling.h"
#include "base/memory.h"

/* Two blocks of one row, coupled. */
typedef struct pair {
    dmb_scene scene;
    dmb_sim sim;
    dmb_pencil pencil;
    uint32_t none[2], capacity[2], size[2], pivot[2];
    double K[4], G[4], work[4];
} pair;

static void set(const dmb_block_pattern *pattern, double *values, double diagonal, double coupling)
{
    for (uint32_t i = 0; i < 2; i++) {
        values[dmb_block_pattern_offset(pattern, i, i)] = diagonal;
        values[dmb_block_pattern_offset(pattern, i, 1 - i)] = coupling;
    }
}

static void open_pair(pair *p, const dmb_allocator *allocator, double coupling, double by_factor)
{
    const dmb_block_edge edge = {0, 1};
    memset(p, 0, sizeof *p);
    p->capacity[0] = p->capacity[1] = p->size[0] = p->size[1] = 1;
    assert_int_equal(dmb_block_pattern_make(allocator, 2, p->capacity, 1, &edge, &p->scene.pattern), DMB_OK);
    assert_true(p->scene.pattern.values == 4);
    p->scene.cluster_count = 1;
    p->scene.layout = (dmb_block_layout){.n = 1, .diag = p->none, .link = p->none};
    p->sim.reduced_size = p->size;
    p->pencil.scene = &p->scene;
    p->pencil.sim = &p->sim;
    p->sim.progress = &p->sim.own_progress;
    p->pencil.K.jointed = p->K;
    p->pencil.G.jointed = p->G;
    p->pencil.work.jointed = p->work;
    p->pencil.reduced_pivot = p->pivot;
    set(&p->scene.pattern, p->K, 0.0, coupling);
    set(&p->scene.pattern, p->G, by_factor, 0.0);
}

/* K = (0 1; 1 0) has the eigenvalues 1 and -1, and no pivot to begin with. */
static void steps_aside_at_zero(void **state)
{
    (void)state;
    pair p;
    const dmb_allocator allocator = dmb_allocator_default();
    uint32_t count = 7;
    open_pair(&p, &allocator, 3.0, -2.0);
    assert_int_equal(dmb_pencil_count(&p.pencil, 0.0, &count), 1);
    assert_int_equal(count, 1);
    assert_int_equal(dmb_pencil_count(&p.pencil, 2.0, &count), 1); /* eigenvalues -4 -+ 3 */
    assert_int_equal(count, 2);
    dmb_block_pattern_release(&p.scene.pattern, &allocator);
}

/* Singular at all factors: told, not counted. */
static void tells_what_cannot_be_counted(void **state)
{
    (void)state;
    pair p;
    const dmb_allocator allocator = dmb_allocator_default();
    uint32_t count = 7;
    open_pair(&p, &allocator, 3.0, 0.0);
    assert_int_equal(dmb_pencil_count(&p.pencil, 0.0, &count), 0);
    assert_int_equal(dmb_pencil_count(&p.pencil, 2.0, &count), 0);
    assert_true(isnan(dmb_pencil_factor(&p.pencil, 0, 1.0, 1e3, 1e-9)));
    dmb_block_pattern_release(&p.scene.pattern, &allocator);
}

/* K = G = 0: no shift is regular. A vector that cannot be found leaves the factor as it was given. */
static void singular_everywhere(void **state)
{
    (void)state;
    pair p;
    const dmb_allocator allocator = dmb_allocator_default();
    const dmb_pencil_search search = {.wanted = 1, .most = 1e12, .allocator = &allocator};
    uint32_t count = 7, found = 7;
    double x[2], factor;
    open_pair(&p, &allocator, 0.0, 0.0);
    p.pencil.unknowns = 2;
    p.scene.pattern.rows = 2;
    assert_int_equal(dmb_pencil_count(&p.pencil, 1.0, &count), 0);
    assert_true(isnan(dmb_pencil_factor(&p.pencil, 0, 1.0, 10.0, 1e-10)));
    assert_true(dmb_pencil_vector(&p.pencil, 3.0, NULL, 0, x) == 3.0);
    assert_int_equal(dmb_pencil_general(&p.pencil, &search, &factor, x, &found), DMB_ERR_SINGULAR);
    assert_int_equal(found, 0);
    dmb_block_pattern_release(&p.scene.pattern, &allocator);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_aside_at_zero),
        cmocka_unit_test(singular_everywhere),
        cmocka_unit_test(tells_what_cannot_be_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
