/* Order of elimination against AMD of CHOLMOD on the graphs of mechanisms and on meshes; subtrees are consecutive, hubs
 * cost no square of their neighbours; allocations that fail. */
#include "math/elimination_order.h"

#include <cholmod.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "check.h"

enum { NODES = 300000, EDGES = 2 * NODES };

static int32_t end_a[EDGES], end_b[EDGES], start[NODES + 1], neighbour[2 * EDGES], row[NODES];
static uint32_t edges, own[NODES], amd[NODES], position[NODES], parent[NODES], mark[NODES], size[NODES];

/* ---- Graphs ------------------------------------------------------------------------------------------------------ */

static void couple(uint32_t a, uint32_t b)
{
    end_a[edges] = (int32_t)a;
    end_b[edges++] = (int32_t)b;
}

static int ascending(const void *a, const void *b)
{
    return *(const int32_t *)a - *(const int32_t *)b;
}

static void make_graph(uint32_t n)
{
    memset(start, 0, sizeof start);
    for (uint32_t e = 0; e < edges; e++) {
        start[end_a[e] + 1]++;
        start[end_b[e] + 1]++;
    }
    for (uint32_t i = 0; i < n; i++) start[i + 1] += start[i];
    memcpy(row, start, n * sizeof *row);
    for (uint32_t e = 0; e < edges; e++) {
        neighbour[row[end_a[e]]++] = end_b[e];
        neighbour[row[end_b[e]]++] = end_a[e];
    }
    for (uint32_t i = 0; i < n; i++)
        qsort(neighbour + start[i], (size_t)(start[i + 1] - start[i]), sizeof *neighbour, ascending);
    edges = 0;
}

static uint32_t chain(uint32_t n)
{
    for (uint32_t i = 1; i < n; i++) couple(i - 1, i);
    return n;
}

/* Each bar carries two. */
static uint32_t tree(uint32_t n)
{
    for (uint32_t i = 1; i < n; i++) couple((i - 1) / 2, i);
    return n;
}

/* Two strings, one in the other, that joints connect at each node. */
static uint32_t ladder(uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        if (i > 0) couple(i - 1, i);
        if (i > 0) couple(n + i - 1, n + i);
        couple(i, n + i);
    }
    return 2 * n;
}

/* `strings` in each other, with a joint at every fifth node. */
static uint32_t nested(uint32_t strings, uint32_t nodes)
{
    for (uint32_t i = 0; i < strings * nodes; i++) {
        if (i % nodes > 0) couple(i - 1, i);
        if (i >= nodes && i % nodes % 5 == 0) couple(i - nodes, i);
    }
    return strings * nodes;
}

/* Side by side: cranks first, then couplers, as tests/bench/clusters.c. */
static uint32_t four_bars(uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        couple(i, n + 1 + i);
        couple(n + 1 + i, i + 1);
    }
    return 2 * n + 1;
}

/* On one body. */
static uint32_t four_bars_on_hub(uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t k = 0; k < 4; k++) couple(k == 0 ? 0 : 3 * i + k, k == 3 ? 0 : 3 * i + k + 1);
    return 3 * n + 1;
}

static uint32_t grid(uint32_t wide, uint32_t high)
{
    for (uint32_t i = 0; i < wide * high; i++) {
        if (i % wide > 0) couple(i - 1, i);
        if (i >= wide) couple(i - wide, i);
    }
    return wide * high;
}

/* ---- Judged by the factor ---------------------------------------------------------------------------------------- */

/* Entries of the factor, and its elimination tree by position. */
static double entries_of(uint32_t n, const uint32_t *order)
{
    double entries = 0.0;
    for (uint32_t k = 0; k < n; k++) mark[k] = UINT32_MAX;
    for (uint32_t k = 0; k < n; k++) {
        assert_true(order[k] < n && mark[order[k]] == UINT32_MAX);
        mark[order[k]] = 0;
        position[order[k]] = k;
        parent[k] = UINT32_MAX;
    }
    for (uint32_t k = 0; k < n; k++) mark[k] = UINT32_MAX;
    for (uint32_t i = 0; i < n; i++) {
        mark[i] = i;
        for (int32_t e = start[order[i]]; e < start[order[i] + 1]; e++) {
            if (position[neighbour[e]] > i) continue;
            for (uint32_t k = position[neighbour[e]]; mark[k] != i; k = parent[k]) {
                if (parent[k] == UINT32_MAX) parent[k] = i;
                mark[k] = i;
                entries += 1.0;
            }
        }
    }
    return entries;
}

/* The subtree of each position is the positions before it. */
static void check_postorder(uint32_t n)
{
    for (uint32_t k = 0; k < n; k++) size[k] = 1;
    for (uint32_t k = 0; k < n; k++)
        if (parent[k] != UINT32_MAX) size[parent[k]] += size[k];
    for (uint32_t k = 0; k < n; k++)
        if (parent[k] != UINT32_MAX) assert_true(k >= parent[k] - (size[parent[k]] - 1));
}

static void order_by_amd(uint32_t n)
{
    cholmod_common common;
    cholmod_sparse A = {0};
    cholmod_start(&common);
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_AMD;
    common.supernodal = CHOLMOD_SIMPLICIAL;
    A.nrow = A.ncol = n;
    A.nzmax = (size_t)start[n];
    A.p = start;
    A.i = neighbour;
    A.stype = 1;
    A.itype = CHOLMOD_INT;
    A.xtype = CHOLMOD_PATTERN;
    A.dtype = CHOLMOD_DOUBLE;
    A.packed = 1;
    cholmod_factor *L = cholmod_analyze(&A, &common);
    assert_non_null(L);
    for (uint32_t k = 0; k < n; k++) amd[k] = (uint32_t)((const int32_t *)L->Perm)[k];
    cholmod_free_factor(&L, &common);
    cholmod_finish(&common);
}

/* more: [-] entries of the factor above those of AMD. */
static void compare(const char *name, uint32_t n, double more)
{
    const dmb_allocator allocator = dmb_allocator_default();
    make_graph(n);
    assert_int_equal(dmb_elimination_order(&allocator, n, start, neighbour, own), DMB_OK);
    order_by_amd(n);
    const double theirs = entries_of(n, amd), ours = entries_of(n, own);
    if (ours > theirs * (1.0 + more)) fail_msg("%s: %g entries, AMD %g", name, ours, theirs);
    check_postorder(n);
}

static void mechanisms_as_amd(void **state)
{
    (void)state;
    compare("chain", chain(10000), 0.0);
    compare("tree", tree(10000), 0.0);
    compare("ladder", ladder(1000), 0.0);
    compare("strings in strings", nested(3, 200), 0.0);
    compare("four strings", nested(4, 200), 0.0);
    compare("six strings", nested(6, 200), 0.02);
    compare("1000 four-bars", four_bars(1000), 0.0);
    compare("200 four-bars on a body", four_bars_on_hub(200), 0.0);
    compare("1000 four-bars on a body", four_bars_on_hub(1000), 0.0);
}

static void meshes_as_amd(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {2, 1}, {7, 5}, {20, 4}, {30, 30}, {100, 10}};
    for (size_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) compare("grid", grid(sizes[s][0], sizes[s][1]), 0.15);
}

/* Without fill, of a body that carries very many: minutes if each of them were counted again for each other. */
static void hubs_are_last(void **state)
{
    (void)state;
    const dmb_allocator allocator = dmb_allocator_default();
    const uint32_t n = NODES;
    for (uint32_t i = 1; i < n; i++) couple(0, i);
    make_graph(n);
    assert_int_equal(dmb_elimination_order(&allocator, n, start, neighbour, own), DMB_OK);
    assert_true(entries_of(n, own) == n - 1.0);
    assert_int_equal(own[n - 1], 0);
}

static void chains_keep_their_order(void **state)
{
    (void)state;
    const dmb_allocator allocator = dmb_allocator_default();
    make_graph(chain(50));
    assert_int_equal(dmb_elimination_order(&allocator, 50, start, neighbour, own), DMB_OK);
    for (uint32_t k = 0; k < 50; k++) assert_int_equal(own[k], k);
    assert_int_equal(dmb_elimination_order(&allocator, 0, start, neighbour, own), DMB_OK);
}

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

static long until_failure, blocks;

static void *take(void *context, size_t bytes, size_t alignment)
{
    const dmb_allocator allocator = dmb_allocator_default();
    (void)context;
    if (until_failure-- == 0) return NULL;
    blocks++;
    return allocator.allocate(allocator.context, bytes, alignment);
}

static void give(void *context, void *block, size_t bytes, size_t alignment)
{
    const dmb_allocator allocator = dmb_allocator_default();
    (void)context;
    blocks -= block != NULL;
    allocator.release(allocator.context, block, bytes, alignment);
}

static void without_memory(void **state)
{
    (void)state;
    dmb_allocator allocator = dmb_allocator_default();
    int32_t status = DMB_ERR_NO_MEMORY;
    long failures = 0;
    allocator.allocate = take;
    allocator.release = give;
    make_graph(grid(10, 10));
    for (; status == DMB_ERR_NO_MEMORY && failures < 100; failures++) {
        until_failure = failures;
        status = dmb_elimination_order(&allocator, 100, start, neighbour, own);
        assert_int_equal(blocks, 0);
    }
    assert_int_equal(status, DMB_OK);
    assert_true(failures > 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(mechanisms_as_amd), cmocka_unit_test(meshes_as_amd),
                                       cmocka_unit_test(hubs_are_last), cmocka_unit_test(chains_keep_their_order),
                                       cmocka_unit_test(without_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
