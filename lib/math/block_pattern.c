/* Symbolic elimination. With the blocks numbered by position, row i of the factor has an entry in column k < i exactly
 * if k can be reached from a neighbour of i below i by ascending the elimination tree, in which the parent of k is the
 * first later block coupled with k (Liu, The role of elimination trees in sparse factorization, 1990). Ascending from
 * each neighbour until a marked node is reached costs one step for each entry. Rows are processed in ascending order,
 * so that the entries of each column are sorted. */
#include "math/block_pattern.h"

#include <string.h>

#include "base/memory.h"
#include "math/elimination_order.h"

/* Work memory for the construction of a pattern. */
typedef struct analysis {
    uint32_t n;
    size_t ends;                           /* length of the neighbour lists, repetitions included */
    int32_t *start, *neighbour, *unsorted; /* (n+1) (ends) (ends) the graph by blocks */
    int32_t *next;                         /* (n) current end of the list of a block */
    uint32_t *order, *position;            /* (n) */
    uint32_t *parent, *mark,
        *count; /* (n) by position: the tree, the last row that visited it, number of entries so far */
    void *block;
    size_t block_size;
} analysis;

static void lay_out_analysis(dmb_arena *arena, analysis *s)
{
    s->start = DMB_ARENA_ARRAY(arena, int32_t, (size_t)s->n + 1);
    s->neighbour = DMB_ARENA_ARRAY(arena, int32_t, s->ends);
    s->unsorted = DMB_ARENA_ARRAY(arena, int32_t, s->ends);
    s->next = DMB_ARENA_ARRAY(arena, int32_t, s->n);
    s->order = DMB_ARENA_ARRAY(arena, uint32_t, s->n);
    s->position = DMB_ARENA_ARRAY(arena, uint32_t, s->n);
    s->parent = DMB_ARENA_ARRAY(arena, uint32_t, s->n);
    s->mark = DMB_ARENA_ARRAY(arena, uint32_t, s->n);
    s->count = DMB_ARENA_ARRAY(arena, uint32_t, s->n);
}

static void lay_out_pattern(dmb_arena *arena, dmb_block_pattern *p)
{
    p->order = DMB_ARENA_ARRAY(arena, uint32_t, p->n);
    p->position = DMB_ARENA_ARRAY(arena, uint32_t, p->n);
    p->column = DMB_ARENA_ARRAY(arena, uint32_t, (size_t)p->n + 1);
    p->later = DMB_ARENA_ARRAY(arena, uint32_t, p->entries);
    p->pivot = DMB_ARENA_ARRAY(arena, size_t, p->n);
    p->diagonal = DMB_ARENA_ARRAY(arena, size_t, p->n);
    p->upper = DMB_ARENA_ARRAY(arena, size_t, p->entries);
    p->lower = DMB_ARENA_ARRAY(arena, size_t, p->entries);
}

static int32_t allocate_analysis(const dmb_allocator *allocator, analysis *s)
{
    dmb_arena arena;
    dmb_arena_count(&arena);
    lay_out_analysis(&arena, s);
    s->block_size = dmb_arena_block_size(&arena);
    if (s->block_size == SIZE_MAX) return DMB_ERR_TOO_LARGE;
    s->block = dmb_allocate(allocator, s->block_size);
    if (s->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, s->block, s->block_size);
    lay_out_analysis(&arena, s);
    return DMB_OK;
}

static int32_t allocate_pattern(const dmb_allocator *allocator, dmb_block_pattern *p)
{
    dmb_arena arena;
    dmb_arena_count(&arena);
    lay_out_pattern(&arena, p);
    p->block_size = dmb_arena_block_size(&arena);
    if (p->block_size == SIZE_MAX) return DMB_ERR_TOO_LARGE;
    p->block = dmb_allocate(allocator, p->block_size);
    if (p->block == NULL) return DMB_ERR_NO_MEMORY;
    dmb_arena_place(&arena, p->block, p->block_size);
    lay_out_pattern(&arena, p);
    return DMB_OK;
}

/* start: index of the first neighbour of each block, counted from the edges. */
static void count_neighbours(analysis *s, uint32_t edge_count, const dmb_block_edge *edges)
{
    for (uint32_t e = 0; e < edge_count; e++) {
        if (edges[e].a == edges[e].b) continue;
        s->start[edges[e].a + 1]++;
        s->start[edges[e].b + 1]++;
    }
    for (uint32_t i = 0; i < s->n; i++) s->start[i + 1] += s->start[i];
}

static void list_as_given(analysis *s, uint32_t edge_count, const dmb_block_edge *edges)
{
    for (uint32_t i = 0; i < s->n; i++) s->next[i] = s->start[i];
    for (uint32_t e = 0; e < edge_count; e++) {
        const uint32_t a = edges[e].a, b = edges[e].b;
        if (a == b) continue;
        s->unsorted[s->next[a]++] = (int32_t)b;
        s->unsorted[s->next[b]++] = (int32_t)a;
    }
}

/* Sorts the lists: blocks i are visited in ascending order and i is appended to each of its neighbours. Repetitions are
 * then adjacent and are omitted. The result does not depend on the order of the caller's edges. */
static void list_sorted(analysis *s)
{
    for (uint32_t i = 0; i < s->n; i++) s->next[i] = s->start[i];
    for (uint32_t i = 0; i < s->n; i++)
        for (int32_t e = s->start[i]; e < s->start[i + 1]; e++) {
            const int32_t j = s->unsorted[e];
            if (s->next[j] > s->start[j] && s->neighbour[s->next[j] - 1] == (int32_t)i) continue;
            s->neighbour[s->next[j]++] = (int32_t)i;
        }
}

/* Closes the gaps left by repetitions. */
static void pack(analysis *s)
{
    int32_t end = 0;
    for (uint32_t i = 0; i < s->n; i++) {
        const int32_t begin = s->start[i];
        s->start[i] = end;
        for (int32_t e = begin; e < s->next[i]; e++) s->neighbour[end++] = s->neighbour[e];
    }
    s->start[s->n] = end;
}

/* Row i of the factor: counts its columns and, if later is not NULL, stores them. The way up the tree from a neighbour
 * ends at the first node marked for this row: from there on it has been walked. A root that is reached gets row i as
 * its parent, because i is the first later row coupled with it. */
static void eliminate_row(analysis *s, uint32_t i, const uint32_t *column, uint32_t *later)
{
    const uint32_t block = s->order[i];
    s->mark[i] = i;
    for (int32_t e = s->start[block]; e < s->start[block + 1]; e++) {
        uint32_t k = s->position[s->neighbour[e]];
        if (k > i) continue;
        for (; s->mark[k] != i; k = s->parent[k]) {
            if (s->parent[k] == DMB_NONE) s->parent[k] = i;
            if (later != NULL) later[column[k] + s->count[k]] = i;
            s->count[k]++;
            s->mark[k] = i;
        }
    }
}

static void eliminate(analysis *s, const uint32_t *column, uint32_t *later)
{
    for (uint32_t k = 0; k < s->n; k++) {
        s->mark[k] = DMB_NONE;
        s->count[k] = 0;
    }
    for (uint32_t i = 0; i < s->n; i++) eliminate_row(s, i, column, later);
}

/* Computes the graph, the order and the number of entries in each column. */
static int32_t analyse(const dmb_allocator *allocator, analysis *s, uint32_t edge_count, const dmb_block_edge *edges)
{
    count_neighbours(s, edge_count, edges);
    list_as_given(s, edge_count, edges);
    list_sorted(s);
    pack(s);
    const int32_t status = dmb_elimination_order(allocator, s->n, s->start, s->neighbour, s->order);
    if (status < 0) return status;
    for (uint32_t k = 0; k < s->n; k++) {
        s->position[s->order[k]] = k;
        s->parent[k] = DMB_NONE;
    }
    eliminate(s, NULL, NULL);
    return DMB_OK;
}

static bool count_entries(const analysis *s, dmb_block_pattern *p)
{
    uint64_t entries = 0;
    for (uint32_t k = 0; k < s->n; k++) entries += s->count[k];
    if (entries >= UINT32_MAX) return false;
    p->entries = (uint32_t)entries;
    p->fill = p->entries - (uint32_t)s->start[s->n] / 2;
    return true;
}

static void fill_structure(analysis *s, dmb_block_pattern *p)
{
    memcpy(p->order, s->order, sizeof(uint32_t) * s->n);
    memcpy(p->position, s->position, sizeof(uint32_t) * s->n);
    for (uint32_t k = 0; k < s->n; k++) p->column[k + 1] = p->column[k] + s->count[k];
    eliminate(s, p->column, p->later);
}

/* Reserves rows x columns doubles of the values. */
static size_t place(dmb_block_pattern *p, uint32_t rows, uint32_t columns)
{
    const size_t offset = p->values;
    p->values += (size_t)rows * columns;
    return offset;
}

/* Number of doubles of all blocks, summed as doubles, which do not overflow; the numbers of rows are smaller. */
static double count_values(const uint32_t *capacity, const dmb_block_pattern *p)
{
    double sum = 0.0;
    for (uint32_t k = 0; k < p->n; k++) {
        const double own = capacity[p->order[k]];
        sum += own * own;
        for (uint32_t e = p->column[k]; e < p->column[k + 1]; e++) sum += 2.0 * own * capacity[p->order[p->later[e]]];
    }
    return sum;
}

/* Places the blocks of each position consecutively, so that factorisation accesses memory in order; false if they
 * overflow. Operations of a block of c rows with d rows coupled to it later: 2 c^3/3 for its LU factors, c^2 d for each
 * of the two off-diagonal rows of blocks, 2 c d^2 for the subtraction from later blocks. */
static bool fill_places(const uint32_t *capacity, dmb_block_pattern *p)
{
    if (count_values(capacity, p) > (double)(SIZE_MAX / (2 * sizeof(double)))) return false;
    for (uint32_t k = 0; k < p->n; k++) {
        const uint32_t own = capacity[p->order[k]];
        double c = own, d = 0.0;
        p->pivot[k] = p->rows;
        p->rows += own;
        p->diagonal[k] = place(p, own, own);
        for (uint32_t e = p->column[k]; e < p->column[k + 1]; e++) {
            const uint32_t other = capacity[p->order[p->later[e]]];
            p->upper[e] = place(p, own, other);
            p->lower[e] = place(p, other, own);
            d += other;
        }
        p->flops += 2.0 * c * (c * c / 3.0 + c * d + d * d);
    }
    return true;
}

/* Nothing is returned unless all of it fits: counts are summed in 64 bits or doubles before memory is reserved. */
static int32_t make(const dmb_allocator *allocator, analysis *s, const uint32_t *capacity, uint32_t edge_count,
                    const dmb_block_edge *edges, dmb_block_pattern *p)
{
    int32_t status = analyse(allocator, s, edge_count, edges);
    if (status < 0) return status;
    if (!count_entries(s, p)) return DMB_ERR_TOO_LARGE;
    status = allocate_pattern(allocator, p);
    if (status < 0) return status;
    fill_structure(s, p);
    if (fill_places(capacity, p)) return DMB_OK;
    dmb_block_pattern_release(p, allocator);
    return DMB_ERR_TOO_LARGE;
}

int32_t dmb_block_pattern_make(const dmb_allocator *allocator, uint32_t n, const uint32_t *capacity,
                               uint32_t edge_count, const dmb_block_edge *edges, dmb_block_pattern *pattern)
{
    analysis s = {.n = n, .ends = 2 * (size_t)edge_count};
    dmb_block_pattern made = {.n = n};
    if (n >= INT32_MAX || edge_count > INT32_MAX / 2) return DMB_ERR_TOO_LARGE; /* the graph has indices of 32 bits */
    for (uint32_t i = 0; i < n; i++)
        if (capacity[i] > DMB_BLOCK_CAPACITY_MAX) return DMB_ERR_TOO_LARGE;
    int32_t status = allocate_analysis(allocator, &s);
    if (status < 0) return status;
    status = make(allocator, &s, capacity, edge_count, edges, &made);
    dmb_release(allocator, s.block, s.block_size);
    if (status == DMB_OK) *pattern = made;
    return status;
}

void dmb_block_pattern_release(dmb_block_pattern *pattern, const dmb_allocator *allocator)
{
    dmb_release(allocator, pattern->block, pattern->block_size);
    memset(pattern, 0, sizeof *pattern);
}

/* Later blocks of a column are sorted: bisection. */
uint32_t dmb_block_pattern_entry(const dmb_block_pattern *pattern, uint32_t low, uint32_t high)
{
    uint32_t begin = pattern->column[low], end = pattern->column[low + 1];
    while (begin < end) {
        const uint32_t middle = begin + (end - begin) / 2;
        if (pattern->later[middle] == high) return middle;
        if (pattern->later[middle] < high)
            begin = middle + 1;
        else
            end = middle;
    }
    return DMB_NONE;
}

size_t dmb_block_pattern_offset(const dmb_block_pattern *pattern, uint32_t i, uint32_t j)
{
    const uint32_t p = pattern->position[i], q = pattern->position[j];
    if (p == q) return pattern->diagonal[p];
    const uint32_t e = dmb_block_pattern_entry(pattern, p < q ? p : q, p < q ? q : p);
    if (e == DMB_NONE) return DMB_BLOCK_NO_OFFSET;
    return p < q ? pattern->upper[e] : pattern->lower[e];
}
