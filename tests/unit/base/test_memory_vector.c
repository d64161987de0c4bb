/* Growing arrays against their items one by one; failed allocations leave them whole. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include <stdlib.h>

#include "base/memory.h"

typedef struct item {
    uint32_t number, square;
} item;

static int allocations_left;

static void *rationed(void *context, size_t size, size_t alignment)
{
    (void)context;
    if (allocations_left == 0) return NULL;
    --allocations_left;
    return aligned_alloc(alignment, (size / alignment + 1) * alignment);
}

static void give_back(void *context, void *block, size_t size, size_t alignment)
{
    (void)context;
    (void)size;
    (void)alignment;
    free(block);
}

static dmb_allocator ration(int count)
{
    dmb_allocator allocator = dmb_allocator_default();
    allocator.allocate = rationed;
    allocator.release = give_back;
    allocations_left = count;
    return allocator;
}

static void expect_items(const dmb_vector *vector, uint32_t count)
{
    assert_int_equal(vector->count, count);
    for (uint32_t i = 0; i < count; ++i) {
        assert_int_equal(DMB_VECTOR_AT(item, vector, i)->number, i);
        assert_int_equal(DMB_VECTOR_AT(item, vector, i)->square, i * i);
    }
}

static void grows(void **state)
{
    dmb_allocator allocator = ration(100);
    dmb_vector vector = dmb_vector_of(sizeof(item));
    (void)state;
    for (uint32_t i = 0; i < 10000; ++i) {
        item next = {i, i * i};
        assert_int_equal(dmb_vector_append(&vector, &allocator, &next, 1), DMB_OK);
    }
    expect_items(&vector, 10000);
    assert_true(allocations_left > 70); /* grows by halves, not one by one */
    dmb_vector_release(&vector, &allocator);
    assert_null(vector.items);
    assert_int_equal(vector.count, 0);
    assert_int_equal(vector.item_size, sizeof(item));
}

static void zeroed_items(void **state)
{
    dmb_allocator allocator = ration(10);
    dmb_vector vector = dmb_vector_of(sizeof(double));
    const double ones[3] = {1.0, 1.0, 1.0};
    (void)state;
    assert_int_equal(dmb_vector_append(&vector, &allocator, NULL, 0), DMB_OK);
    assert_null(vector.items);
    assert_int_equal(dmb_vector_append(&vector, &allocator, ones, 3), DMB_OK);
    vector.count = 0;
    assert_int_equal(dmb_vector_append(&vector, &allocator, NULL, 3), DMB_OK); /* over what was there */
    for (size_t i = 0; i < 3; ++i) assert_true(*DMB_VECTOR_AT(double, &vector, i) == 0.0);
    dmb_vector_release(&vector, &allocator);
}

static void failures_leave_it_whole(void **state)
{
    dmb_allocator allocator = ration(1);
    dmb_vector vector = dmb_vector_of(sizeof(item));
    const item first[2] = {{0, 0}, {1, 1}};
    void *items;
    (void)state;
    assert_int_equal(dmb_vector_append(&vector, &allocator, first, 2), DMB_OK);
    items = vector.items;
    assert_int_equal(dmb_vector_append(&vector, &allocator, first, 2), DMB_ERR_NO_MEMORY);
    assert_int_equal(dmb_vector_reserve(&vector, &allocator, SIZE_MAX / 4), DMB_ERR_TOO_LARGE);
    assert_int_equal(dmb_vector_append(&vector, &allocator, first, SIZE_MAX), DMB_ERR_TOO_LARGE);
    assert_int_equal(dmb_vector_append(&vector, &allocator, first, SIZE_MAX / 4), DMB_ERR_TOO_LARGE);
    assert_int_equal(dmb_vector_reserve(&vector, &allocator, 2), DMB_OK);
    assert_ptr_equal(vector.items, items);
    expect_items(&vector, 2);
    dmb_vector_release(&vector, &allocator);
}

static void reserve_then_append_does_not_allocate(void **state)
{
    dmb_allocator allocator = ration(1);
    dmb_vector vector = dmb_vector_of(sizeof(item));
    (void)state;
    assert_int_equal(dmb_vector_reserve(&vector, &allocator, 50), DMB_OK);
    for (uint32_t i = 0; i < 50; ++i) {
        item next = {i, i * i};
        assert_int_equal(dmb_vector_append(&vector, &allocator, &next, 1), DMB_OK);
    }
    expect_items(&vector, 50);
    dmb_vector_release(&vector, &allocator);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grows),
        cmocka_unit_test(zeroed_items),
        cmocka_unit_test(failures_leave_it_whole),
        cmocka_unit_test(reserve_then_append_does_not_allocate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
