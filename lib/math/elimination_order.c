/* The remaining graph is stored as a quotient graph: an eliminated node becomes an element, a list of the nodes that it
 * couples; elements adjacent to it are absorbed (George, Liu, The evolution of the minimum degree ordering algorithm,
 * 1989). The list of a node loses at least one entry for each element that it gains, so that lists of nodes are updated
 * in place. Degrees are exact; nodes are in a heap by degree and index. The absorbing pivot is the parent in the
 * elimination tree. Hubs, nodes with very many neighbours, are eliminated last: their lists would be read again for
 * each neighbour that is eliminated (Amestoy, Davis, Duff, An approximate minimum degree ordering algorithm, 1996). */
#include "math/elimination_order.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

typedef struct quotient {
    uint32_t n;
    const int32_t *start;
    int32_t *list;     /* (ends) of node i from start[i]: nodes j >= 0, elements as -1 - e */
    uint32_t *length;  /* (n) of that list */
    uint32_t *degree;  /* (n) */
    uint32_t *mark;    /* (n) the last round that visited a node */
    uint32_t *heap;    /* (n) nodes, the smallest (degree, index) first */
    uint32_t *place;   /* (n) of a node in the heap; DMB_NONE once eliminated, and of hubs */
    size_t *element;   /* (n) first node of element e in `nodes` */
    uint32_t *members; /* (n) their number; 0 once absorbed */
    uint32_t *parent;  /* (n) pivot that absorbed element e; DMB_NONE of roots and hubs */
    uint32_t left, round;
    dmb_vector nodes; /* uint32_t */
} quotient;

/* ---- Heap -------------------------------------------------------------------------------------------------------- */

static int before(const quotient *q, uint32_t a, uint32_t b)
{
    return q->degree[a] != q->degree[b] ? q->degree[a] < q->degree[b] : a < b;
}

static void put(quotient *q, uint32_t at, uint32_t node)
{
    q->heap[at] = node;
    q->place[node] = at;
}

static void rise(quotient *q, uint32_t at, uint32_t node)
{
    for (; at > 0 && before(q, node, q->heap[(at - 1) / 2]); at = (at - 1) / 2) put(q, at, q->heap[(at - 1) / 2]);
    put(q, at, node);
}

static void sink(quotient *q, uint32_t at, uint32_t node)
{
    for (;;) {
        uint32_t child = 2 * at + 1;
        if (child >= q->left) break;
        if (child + 1 < q->left && before(q, q->heap[child + 1], q->heap[child])) child++;
        if (!before(q, q->heap[child], node)) break;
        put(q, at, q->heap[child]);
        at = child;
    }
    put(q, at, node);
}

static uint32_t remove_least(quotient *q)
{
    const uint32_t least = q->heap[0];
    q->left--;
    if (q->left > 0) sink(q, 0, q->heap[q->left]);
    q->place[least] = DMB_NONE;
    return least;
}

/* A degree may rise or fall; one of the two moves does nothing. */
static void set_degree(quotient *q, uint32_t node, uint32_t degree)
{
    q->degree[node] = degree;
    rise(q, q->place[node], node);
    sink(q, q->place[node], node);
}

/* ---- Elimination ------------------------------------------------------------------------------------------------- */

static int is_new(quotient *q, uint32_t node)
{
    if (q->place[node] == DMB_NONE || q->mark[node] == q->round) return 0;
    q->mark[node] = q->round;
    return 1;
}

static const uint32_t *members_of(const quotient *q, uint32_t e)
{
    return (const uint32_t *)q->nodes.items + q->element[e];
}

/* Appends the nodes of element e that are new. */
static int32_t append_members(quotient *q, const dmb_allocator *allocator, uint32_t e)
{
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < q->members[e] && status >= 0; k++) {
        const uint32_t node = members_of(q, e)[k];
        if (is_new(q, node)) status = dmb_vector_append(&q->nodes, allocator, &node, 1);
    }
    return status;
}

/* Pivot p becomes an element of all nodes coupled with it, and absorbs its elements. */
static int32_t make_element(quotient *q, const dmb_allocator *allocator, uint32_t p)
{
    const int32_t *list = q->list + q->start[p];
    int32_t status = DMB_OK;
    q->element[p] = q->nodes.count;
    q->round++;
    for (uint32_t k = 0; k < q->length[p] && status >= 0; k++) {
        if (list[k] < 0) {
            const uint32_t e = (uint32_t)(-1 - list[k]);
            status = append_members(q, allocator, e);
            q->members[e] = 0;
            q->parent[e] = p;
        } else {
            const uint32_t node = (uint32_t)list[k];
            if (is_new(q, node)) status = dmb_vector_append(&q->nodes, allocator, &node, 1);
        }
    }
    q->members[p] = (uint32_t)(q->nodes.count - q->element[p]);
    return status;
}

/* Removes from the list of node i, which belongs to the new element p, the entries that the element represents. The
 * nodes of the element have the mark of this round. */
static void shorten(quotient *q, uint32_t i, uint32_t p)
{
    int32_t *list = q->list + q->start[i];
    uint32_t kept = 0;
    for (uint32_t k = 0; k < q->length[i]; k++) {
        const int32_t entry = list[k];
        const int stays =
            entry < 0 ? q->members[-1 - entry] > 0 : q->place[entry] != DMB_NONE && q->mark[entry] != q->round;
        if (stays) list[kept++] = entry;
    }
    list[kept++] = -1 - (int32_t)p;
    q->length[i] = kept;
}

static uint32_t count_degree(quotient *q, uint32_t i)
{
    const int32_t *list = q->list + q->start[i];
    uint32_t degree = 0;
    q->round++;
    q->mark[i] = q->round;
    for (uint32_t k = 0; k < q->length[i]; k++) {
        if (list[k] >= 0) {
            degree += (uint32_t)is_new(q, (uint32_t)list[k]);
            continue;
        }
        const uint32_t e = (uint32_t)(-1 - list[k]);
        for (uint32_t m = 0; m < q->members[e]; m++) degree += (uint32_t)is_new(q, members_of(q, e)[m]);
    }
    return degree;
}

static int32_t eliminate(quotient *q, const dmb_allocator *allocator, uint32_t p)
{
    const int32_t status = make_element(q, allocator, p);
    if (status < 0) return status;
    for (uint32_t k = 0; k < q->members[p]; k++) shorten(q, members_of(q, p)[k], p);
    for (uint32_t k = 0; k < q->members[p]; k++) {
        const uint32_t i = members_of(q, p)[k];
        set_degree(q, i, count_degree(q, i));
    }
    return DMB_OK;
}

static int32_t eliminate_all(quotient *q, const dmb_allocator *allocator, uint32_t *order)
{
    int32_t status = DMB_OK;
    for (uint32_t k = 0; q->left > 0 && status >= 0; k++) {
        order[k] = remove_least(q);
        status = eliminate(q, allocator, order[k]);
    }
    return status;
}

/* ---- Postorder --------------------------------------------------------------------------------------------------- */

/* Appends the subtree of root to order, each node after its children; their lists are used up. */
static uint32_t append_subtree(const quotient *q, uint32_t root, uint32_t *child, const uint32_t *sibling, uint32_t k,
                               uint32_t *order)
{
    uint32_t node = root;
    for (;;) {
        while (child[node] != DMB_NONE) {
            const uint32_t next = child[node];
            child[node] = sibling[next];
            node = next;
        }
        order[k++] = node;
        if (node == root) return k;
        node = q->parent[node];
    }
}

/* Postorder changes neither fill nor operations, but puts each block next to those that it updates. Children and roots
 * keep their order of elimination. */
static void postorder(const quotient *q, uint32_t count, uint32_t *order)
{
    uint32_t *child = q->mark, *sibling = q->place, *roots = q->heap;
    uint32_t root_count = 0, k = 0;
    for (uint32_t i = 0; i < q->n; i++) child[i] = DMB_NONE;
    for (uint32_t i = count; i-- > 0;) {
        const uint32_t node = order[i], parent = q->parent[node];
        if (parent == DMB_NONE) continue;
        sibling[node] = child[parent];
        child[parent] = node;
    }
    for (uint32_t i = 0; i < count; i++)
        if (q->parent[order[i]] == DMB_NONE) roots[root_count++] = order[i];
    for (uint32_t r = 0; r < root_count; r++) k = append_subtree(q, roots[r], child, sibling, k, order);
}

/* ---- The order --------------------------------------------------------------------------------------------------- */

static void lay_out(dmb_arena *arena, quotient *q)
{
    q->list = DMB_ARENA_ARRAY(arena, int32_t, (size_t)q->start[q->n]);
    q->length = DMB_ARENA_ARRAY(arena, uint32_t, q->n);
    q->degree = DMB_ARENA_ARRAY(arena, uint32_t, q->n);
    q->mark = DMB_ARENA_ARRAY(arena, uint32_t, q->n);
    q->heap = DMB_ARENA_ARRAY(arena, uint32_t, q->n);
    q->place = DMB_ARENA_ARRAY(arena, uint32_t, q->n);
    q->element = DMB_ARENA_ARRAY(arena, size_t, q->n);
    q->members = DMB_ARENA_ARRAY(arena, uint32_t, q->n);
    q->parent = DMB_ARENA_ARRAY(arena, uint32_t, q->n);
}

/* Hubs are written to the end of order: nodes with more than ten times the root of n neighbours, as of a body on which
 * hundreds of others stand. They are few (their number times that of their neighbours is at most twice the couplings).
 */
static void set_hubs_aside(quotient *q, uint32_t *order)
{
    const double bound = fmax(16.0, 10.0 * sqrt(q->n));
    uint32_t hubs = 0;
    for (uint32_t i = q->n; i-- > 0;) {
        q->length[i] = (uint32_t)(q->start[i + 1] - q->start[i]);
        q->place[i] = q->length[i] > bound ? DMB_NONE : 0;
        if (q->place[i] == DMB_NONE) order[q->n - ++hubs] = i;
    }
}

/* Returns the number of nodes other than hubs; degrees are without hubs. */
static uint32_t begin(quotient *q, const int32_t *neighbour, uint32_t *order)
{
    set_hubs_aside(q, order);
    memcpy(q->list, neighbour, (size_t)q->start[q->n] * sizeof(int32_t));
    for (uint32_t i = 0; i < q->n; i++) {
        q->parent[i] = DMB_NONE;
        if (q->place[i] == DMB_NONE) continue;
        q->degree[i] = 0;
        for (int32_t k = q->start[i]; k < q->start[i + 1]; k++) q->degree[i] += q->place[neighbour[k]] != DMB_NONE;
        rise(q, q->left++, i);
    }
    return q->left;
}

int32_t dmb_elimination_order(const dmb_allocator *allocator, uint32_t n, const int32_t *start,
                              const int32_t *neighbour, uint32_t *order)
{
    quotient q = {.n = n, .start = start, .nodes = dmb_vector_of(sizeof(uint32_t))};
    dmb_arena arena;
    dmb_arena_count(&arena);
    lay_out(&arena, &q);
    const size_t size = dmb_arena_block_size(&arena);
    if (size == SIZE_MAX) return DMB_ERR_TOO_LARGE;
    void *block = dmb_allocate(allocator, size);
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, block, size);
    lay_out(&arena, &q);
    const uint32_t count = begin(&q, neighbour, order);
    const int32_t status = eliminate_all(&q, allocator, order);
    if (status >= 0) postorder(&q, count, order);
    dmb_vector_release(&q.nodes, allocator);
    dmb_release(allocator, block, size);
    return status;
}
