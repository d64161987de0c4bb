/* Sized structs between releases: what is written, read and left alone against the bytes of a longer or shorter one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/sized_struct.h"

/* Three releases of one struct: the first, the present one, and one to come. */
typedef struct first {
    uint32_t struct_size;
    int32_t kind;
    double length;
} first;

typedef struct present {
    uint32_t struct_size;
    int32_t kind;
    double length, diameter;
} present;

typedef struct coming {
    uint32_t struct_size;
    int32_t kind;
    double length, diameter, colour;
} coming;

int32_t present_init(present *out, uint32_t size);
DMB_DEFINE_INIT(present, sizeof(first), {.kind = 2, .length = 1.5, .diameter = 0.1})

static void init_of_every_release(void **state)
{
    first old[2];
    present now;
    coming new;
    (void)state;
    memset(old, 0x5A, sizeof old);
    assert_int_equal(present_init((present *)(void *)&old[0], sizeof old[0]), DMB_OK);
    assert_int_equal(old[0].struct_size, sizeof(first));
    assert_int_equal(old[0].kind, 2);
    assert_true(old[0].length == 1.5);
    assert_int_equal(old[1].struct_size, 0x5A5A5A5A); /* nothing written beyond */

    assert_int_equal(present_init(&now, sizeof now), DMB_OK);
    assert_int_equal(now.struct_size, sizeof now);
    assert_true(now.diameter == 0.1);

    memset(&new, 0x5A, sizeof new);
    assert_int_equal(present_init((present *)(void *)&new, sizeof new), DMB_OK);
    assert_int_equal(new.struct_size, sizeof new);
    assert_true(new.diameter == 0.1 && new.colour == 0.0);
}

static void init_refuses(void **state)
{
    present now, before;
    const uint32_t sizes[] = {0,
                              4,
                              8,
                              sizeof(first) - 8,
                              sizeof(present) - 4,
                              sizeof(present) + 1,
                              UINT32_MAX,
                              UINT32_MAX - 7,
                              sizeof(present) + DMB_STRUCT_MAX_EXTRA + 8};
    (void)state;
    memset(&now, 0x5A, sizeof now);
    before = now;
    assert_int_equal(present_init(NULL, sizeof now), DMB_ERR_NULL);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        assert_int_equal(present_init(&now, sizes[i]), DMB_ERR_STRUCT_SIZE);
        assert_memory_equal(&now, &before, sizeof now);
    }
}

static void read_of_every_release(void **state)
{
    const first old = {sizeof old, 7, 3.0};
    const present now = {sizeof now, 8, 4.0, 0.2};
    coming new = {sizeof new, 9, 5.0, 0.3, 0.0};
    present out;
    (void)state;
    assert_int_equal(present_read(&out, &old), DMB_OK);
    assert_int_equal(out.struct_size, sizeof out);
    assert_int_equal(out.kind, 7);
    assert_true(out.length == 3.0 && out.diameter == 0.1);

    assert_int_equal(present_read(&out, &now), DMB_OK);
    assert_memory_equal(&out, &now, sizeof out);

    assert_int_equal(present_read(&out, &new), DMB_OK);
    assert_int_equal(out.struct_size, sizeof out);
    assert_true(out.length == 5.0 && out.diameter == 0.3);

    new.colour = 1.0; /* something this release does not have */
    new.length = 6.0;
    assert_int_equal(present_read(&out, &new), DMB_ERR_STRUCT_SIZE);
    assert_true(out.length == 5.0);
}

static void read_refuses(void **state)
{
    present given = {0, 8, 4.0, 0.2}, out, before;
    const uint32_t sizes[] = {0, 8, 20, sizeof(present) + 4, UINT32_MAX, UINT32_MAX - 7};
    (void)state;
    assert_int_equal(present_init(&out, sizeof out), DMB_OK);
    before = out;
    assert_int_equal(present_read(&out, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_struct_read(NULL, sizeof out, sizeof(first), &given), DMB_ERR_NULL);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        given.struct_size = sizes[i];
        assert_int_equal(present_read(&out, &given), DMB_ERR_STRUCT_SIZE);
        assert_memory_equal(&out, &before, sizeof out);
    }
}

static void write_of_every_release(void **state)
{
    const present answer = {sizeof answer, 3, 9.0, 0.7};
    first old[2];
    present now = {sizeof now, 0, 0.0, 0.0};
    coming new = {sizeof new, 0, 0.0, 0.0, 42.0};
    (void)state;
    memset(old, 0x5A, sizeof old);
    old[0].struct_size = sizeof(first);
    assert_int_equal(present_write(&old[0], &answer), DMB_OK);
    assert_int_equal(old[0].struct_size, sizeof(first));
    assert_true(old[0].length == 9.0);
    assert_int_equal(old[1].struct_size, 0x5A5A5A5A);

    assert_int_equal(present_write(&now, &answer), DMB_OK);
    assert_memory_equal(&now, &answer, sizeof now);

    assert_int_equal(present_write(&new, &answer), DMB_OK);
    assert_int_equal(new.struct_size, sizeof new);
    assert_true(new.diameter == 0.7 && new.colour == 42.0);
}

static void write_refuses(void **state)
{
    const present answer = {sizeof answer, 3, 9.0, 0.7};
    present now = {8, 1, 2.0, 0.3};
    (void)state;
    assert_int_equal(present_write(NULL, &answer), DMB_ERR_NULL);
    assert_int_equal(present_write(&now, &answer), DMB_ERR_STRUCT_SIZE);
    now.struct_size = UINT32_MAX;
    assert_int_equal(present_write(&now, &answer), DMB_ERR_STRUCT_SIZE);
    assert_true(now.kind == 1 && now.length == 2.0 && now.diameter == 0.3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(init_of_every_release),  cmocka_unit_test(init_refuses),
        cmocka_unit_test(read_of_every_release),  cmocka_unit_test(read_refuses),
        cmocka_unit_test(write_of_every_release), cmocka_unit_test(write_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
