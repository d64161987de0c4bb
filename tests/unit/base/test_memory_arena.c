/* Arenas: the size that is counted against the places that are given out, at any alignment; sizes that overflow. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <stdlib.h>

#include "base/memory.h"

typedef struct layout {
    double *positions, *forces;
    uint32_t *segments;
    unsigned char *flags;
    double *nothing;
} layout;

static void lay_out(dmb_arena *arena, layout *l)
{
    l->flags = DMB_ARENA_ARRAY(arena, unsigned char, 3);
    l->positions = DMB_ARENA_DOUBLES(arena, 21);
    l->segments = DMB_ARENA_ARRAY(arena, uint32_t, 5);
    l->nothing = DMB_ARENA_DOUBLES(arena, 0);
    l->forces = DMB_ARENA_DOUBLES(arena, 6);
}

static void two_passes_at_any_alignment(void **state)
{
    dmb_arena arena;
    layout l;
    size_t size;
    unsigned char *room;
    (void)state;
    dmb_arena_count(&arena);
    lay_out(&arena, &l);
    assert_false(arena.overflow);
    assert_null(l.positions);
    size = dmb_arena_block_size(&arena);
    assert_true(size >= 3 + 21 * 8 + 5 * 4 + 6 * 8);
    room = malloc(size + 64);
    for (size_t shift = 0; shift < 64; ++shift) {
        ptrdiff_t distance;
        memset(room, 0xA5, size + 64);
        dmb_arena_place(&arena, room + shift, size);
        lay_out(&arena, &l);
        assert_false(arena.overflow);
        assert_true((uintptr_t)l.positions % 64 == 0 && (uintptr_t)l.forces % 64 == 0);
        assert_true((uintptr_t)l.segments % sizeof(uint32_t) == 0);
        assert_non_null(l.nothing);
        assert_true((unsigned char *)(l.forces + 6) <= room + shift + size);
        for (int i = 0; i < 21; ++i) assert_true(memcmp(&l.positions[i], "\0\0\0\0\0\0\0", 8) == 0);
        distance = (unsigned char *)l.forces - l.flags;
        assert_int_equal(distance, 256); /* flags 0, positions 64, segments 232, nothing and forces 256 */
        for (size_t i = 0; i < shift; ++i) assert_int_equal(room[i], 0xA5);
        for (size_t i = shift + size; i < size + 64; ++i) assert_int_equal(room[i], 0xA5);
    }
    free(room);
}

static void too_small_a_block(void **state)
{
    unsigned char room[512];
    dmb_arena arena;
    layout l;
    size_t need;
    (void)state;
    dmb_arena_count(&arena);
    lay_out(&arena, &l);
    need = arena.used;
    for (size_t size = 0; size < need; ++size) {
        dmb_arena_place(&arena, room, size);
        lay_out(&arena, &l);
        assert_true(arena.overflow);
        assert_null(l.forces);
        assert_true(dmb_arena_block_size(&arena) == SIZE_MAX);
        assert_null(dmb_arena_allocate(&arena, 0, 1, 1));
    }
    dmb_arena_place(&arena, NULL, 4096);
    assert_null(dmb_arena_allocate(&arena, 1, 8, 8));
    assert_true(arena.overflow);
}

static void sizes_that_overflow(void **state)
{
    dmb_arena arena;
    (void)state;
    dmb_arena_count(&arena);
    dmb_arena_allocate(&arena, SIZE_MAX / 4, 8, 64);
    assert_true(arena.overflow);
    dmb_arena_allocate(&arena, 1, 8, 64); /* stays */
    assert_true(dmb_arena_block_size(&arena) == SIZE_MAX);

    dmb_arena_count(&arena);
    dmb_arena_allocate(&arena, SIZE_MAX - 100, 1, 1);
    assert_false(arena.overflow);
    dmb_arena_allocate(&arena, 101, 1, 1);
    assert_true(arena.overflow);

    dmb_arena_count(&arena);
    dmb_arena_allocate(&arena, SIZE_MAX - 10, 1, 1);
    assert_true(dmb_arena_block_size(&arena) == SIZE_MAX);
    assert_false(arena.overflow);
    assert_null(dmb_arena_allocate(&arena, 0, 1, 64)); /* no multiple of 64 is left */
    assert_true(arena.overflow);
}

static void alignments_that_are_none(void **state)
{
    const size_t bad[] = {0, 3, 48, 128};
    dmb_arena arena;
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        dmb_arena_count(&arena);
        dmb_arena_allocate(&arena, 1, 8, bad[i]);
        assert_true(arena.overflow);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_passes_at_any_alignment),
        cmocka_unit_test(too_small_a_block),
        cmocka_unit_test(sizes_that_overflow),
        cmocka_unit_test(alignments_that_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
