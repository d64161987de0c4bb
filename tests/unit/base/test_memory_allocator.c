/* Allocators, the default one and a caller's: sizes and alignments against those asked for; failures against the
 * status. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <stdlib.h>

#include "base/memory.h"

/* Counts, remembers the last request, and can be told to fail or to ignore the alignment. */
typedef struct ledger {
    size_t live, bytes, last_size, last_alignment;
    int fail, shift;
} ledger;

static void *ledger_allocate(void *context, size_t size, size_t alignment)
{
    ledger *l = context;
    unsigned char *block;
    if (l->fail) return NULL;
    l->live += 1;
    l->bytes += size;
    l->last_size = size;
    l->last_alignment = alignment;
    block = aligned_alloc(alignment, (size / alignment + 2) * alignment);
    memset(block, 0xA5, size + alignment);
    return block + l->shift;
}

static void ledger_release(void *context, void *block, size_t size, size_t alignment)
{
    ledger *l = context;
    assert_int_equal(alignment, l->last_alignment);
    l->live -= 1;
    l->bytes -= size;
    free((unsigned char *)block - l->shift);
}

static dmb_allocator of(ledger *l)
{
    dmb_allocator allocator = dmb_allocator_default();
    memset(l, 0, sizeof *l);
    allocator.context = l;
    allocator.allocate = ledger_allocate;
    allocator.release = ledger_release;
    return allocator;
}

static void expect_zeroed(const unsigned char *block, size_t size)
{
    assert_non_null(block);
    assert_true((uintptr_t)block % DMB_ALIGNMENT == 0);
    for (size_t i = 0; i < size; ++i) assert_int_equal(block[i], 0);
}

static void default_allocator(void **state)
{
    const size_t sizes[] = {0, 1, 63, 64, 65, 4096, 100001};
    dmb_allocator allocator = dmb_allocator_default();
    (void)state;
    assert_int_equal(allocator.struct_size, sizeof allocator);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        void *block = dmb_allocate(&allocator, sizes[i]);
        expect_zeroed(block, sizes[i]);
        dmb_release(&allocator, block, sizes[i]);
    }
    assert_null(dmb_allocate(&allocator, SIZE_MAX));
    assert_null(dmb_allocate(&allocator, SIZE_MAX / 2));
    dmb_release(&allocator, NULL, 10);
}

static void own_allocator_sees_the_same_sizes(void **state)
{
    ledger l;
    dmb_allocator allocator = of(&l);
    void *empty, *block;
    (void)state;
    empty = dmb_allocate(&allocator, 0);
    assert_int_equal(l.last_size, 1);
    block = dmb_allocate(&allocator, 1000);
    expect_zeroed(block, 1000);
    assert_int_equal(l.last_size, 1000);
    assert_int_equal(l.last_alignment, DMB_ALIGNMENT);
    dmb_release(&allocator, empty, 0);
    dmb_release(&allocator, block, 1000);
    assert_int_equal(l.live, 0);
    assert_int_equal(l.bytes, 0);
}

static void failures(void **state)
{
    ledger l;
    dmb_allocator allocator = of(&l);
    (void)state;
    l.fail = 1;
    assert_null(dmb_allocate(&allocator, 8));
    l.fail = 0;
    l.shift = 8; /* a block that is not aligned is given back and counts as no memory */
    assert_null(dmb_allocate(&allocator, 8));
    assert_int_equal(l.live, 0);
    assert_int_equal(l.bytes, 0);
    assert_null(dmb_allocate_array(&allocator, SIZE_MAX / 4, 8));
    assert_int_equal(l.live, 0);
}

/* More than any object can have, as an arena says after an overflow, is not asked for. */
static void more_than_any_object(void **state)
{
    (void)state;
    ledger l;
    const dmb_allocator own = of(&l);
    dmb_arena arena;
    dmb_arena_count(&arena);
    (void)dmb_arena_allocate(&arena, SIZE_MAX / 2, 4, 8);
    assert_null(dmb_allocate(&own, dmb_arena_block_size(&arena)));
    assert_null(dmb_allocate(&own, (size_t)PTRDIFF_MAX + 1));
    assert_int_equal(l.last_size, 0);
    assert_int_equal(l.live, 0);
}

static void arrays(void **state)
{
    ledger l;
    dmb_allocator allocator = of(&l);
    void *block = dmb_allocate_array(&allocator, 10, 24);
    (void)state;
    expect_zeroed(block, 240);
    assert_int_equal(l.bytes, 240);
    dmb_release(&allocator, block, 240);
}

static void copies(void **state)
{
    ledger l;
    dmb_allocator given = of(&l), out;
    (void)state;
    memset(&out, 0, sizeof out);
    assert_int_equal(dmb_allocator_copy(&out, NULL), DMB_OK);
    assert_non_null(out.allocate);
    assert_int_equal(dmb_allocator_copy(&out, &given), DMB_OK);
    assert_ptr_equal(out.context, &l);
    given.release = NULL;
    given.context = NULL;
    assert_int_equal(dmb_allocator_copy(&out, &given), DMB_ERR_NULL);
    given.struct_size = 4;
    assert_int_equal(dmb_allocator_copy(&out, &given), DMB_ERR_STRUCT_SIZE);
    assert_ptr_equal(out.context, &l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(default_allocator),
        cmocka_unit_test(own_allocator_sees_the_same_sizes),
        cmocka_unit_test(failures),
        cmocka_unit_test(more_than_any_object),
        cmocka_unit_test(arrays),
        cmocka_unit_test(copies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
