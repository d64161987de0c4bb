/* The block of a sim: every field on a cache line of its own, none overlapping, whatever the counts and wherever the
 * caller's block begins. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "sim/layout.h"

enum { NODES = 7 };

/* A scene that consists of counts only. */
typedef struct counts_scene {
    dmb_scene scene;
    uint32_t diag[NODES + 1], link[NODES];
} counts_scene;

static void fill(counts_scene *c, uint32_t scale)
{
    memset(c, 0, sizeof *c);
    c->scene.node_count = NODES;
    c->scene.row_count = 5 * scale + 2;
    c->scene.site_count = 3 * scale + 1;
    c->scene.axial_torsional_site_count = scale;
    c->scene.element_count = 6;
    c->scene.drive_count = 2 * scale;
    c->scene.bit_count = scale % 3;
    c->scene.load_count = scale % 5;
    c->scene.history_count = 64 * (scale % 3);
    c->diag[NODES] = 36 * scale;
    c->link[NODES - 1] = 30 * scale;
    c->scene.layout.n = NODES;
    c->scene.layout.diag = c->diag;
    c->scene.layout.link = c->link;
}

static int by_address(const void *a, const void *b)
{
    const dmb_field *x = a, *y = b;
    const uintptr_t p = (uintptr_t)x->data, q = (uintptr_t)y->data;
    return p < q ? -1 : p > q;
}

static void check_block(const counts_scene *c, unsigned char *block, size_t size)
{
    dmb_sim *sim = dmb_sim_carve(&c->scene, block, size);
    dmb_field fields[DMB_FIELD_MAX];
    unsigned char *end;
    assert_non_null(sim);
    assert_int_equal((uintptr_t)sim % DMB_ALIGNMENT, 0);
    assert_true((unsigned char *)sim >= block);
    assert_ptr_equal(sim->scene, &c->scene);
    assert_int_equal(dmb_sim_fields(sim, 0, DMB_GROUP_COUNT - 1, fields), DMB_FIELD_MAX);
    qsort(fields, DMB_FIELD_MAX, sizeof fields[0], by_address);
    end = (unsigned char *)(sim + 1);
    for (size_t i = 0; i < DMB_FIELD_MAX; i++) {
        unsigned char *data = fields[i].data;
        assert_non_null(data);
        if ((uintptr_t)data % DMB_ALIGNMENT != 0 || data < end)
            fail_msg("%s overlaps or is misaligned", fields[i].name);
        for (size_t k = 0; k < fields[i].bytes; k++) assert_int_equal(data[k], 0);
        memset(data, 0xA5, fields[i].bytes);
        end = data + fields[i].bytes;
    }
    assert_true(end <= block + size);
}

static void fields_do_not_overlap(void **state)
{
    (void)state;
    for (uint32_t scale = 0; scale < 6; scale++) {
        counts_scene c;
        fill(&c, scale);
        const size_t size = dmb_sim_bytes(&c.scene);
        unsigned char *memory = malloc(size + 2 * DMB_ALIGNMENT);
        assert_non_null(memory);
        for (size_t shift = 0; shift <= DMB_ALIGNMENT; shift++) {
            memset(memory, 0x5A, size + 2 * DMB_ALIGNMENT);
            check_block(&c, memory + shift, size);
            for (size_t i = 0; i < shift; i++) assert_int_equal(memory[i], 0x5A);
            for (size_t i = shift + size; i < size + 2 * DMB_ALIGNMENT; i++) assert_int_equal(memory[i], 0x5A);
        }
        free(memory);
    }
}

static void too_small_a_block_is_refused(void **state)
{
    (void)state;
    counts_scene c;
    fill(&c, 3);
    const size_t size = dmb_sim_bytes(&c.scene);
    unsigned char *memory = malloc(size);
    assert_non_null(memory);
    assert_null(dmb_sim_carve(&c.scene, memory, size - 1));
    assert_null(dmb_sim_carve(&c.scene, memory, 0));
    assert_null(dmb_sim_carve(&c.scene, NULL, size));
    free(memory);
}

/* The largest counts a scene can hold: the size is either right or refused, never wrapped around. */
static void huge_counts_do_not_wrap(void **state)
{
    (void)state;
    counts_scene c;
    fill(&c, 3);
    const size_t small = dmb_sim_bytes(&c.scene);
    c.scene.row_count = c.scene.site_count = c.scene.element_count = c.scene.history_count = UINT32_MAX;
    c.diag[NODES] = c.link[NODES - 1] = UINT32_MAX;
    const size_t large = dmb_sim_bytes(&c.scene);
    assert_true(large == SIZE_MAX || large / 8 > UINT32_MAX);
    assert_true(large > small);
}

/* The backup has `now` and the memory, a snapshot the reused factors too: no field is in two groups, and `trial` has
 * its own place. */
static void groups_follow_the_lists(void **state)
{
    (void)state;
    counts_scene c;
    fill(&c, 2);
    const size_t size = dmb_sim_bytes(&c.scene);
    unsigned char *memory = malloc(size);
    assert_non_null(memory);
    dmb_sim *sim = dmb_sim_carve(&c.scene, memory, size);
    dmb_field now[DMB_FIELD_MAX], trial[DMB_FIELD_MAX];
    const size_t count = dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_NOW, now);
    assert_int_equal(count, dmb_sim_fields(sim, DMB_GROUP_TRIAL, DMB_GROUP_TRIAL, trial));
    for (size_t i = 0; i < count; i++) {
        assert_string_equal(now[i].name, trial[i].name);
        assert_int_equal(now[i].bytes, trial[i].bytes);
        assert_ptr_not_equal(now[i].data, trial[i].data);
    }
    assert_ptr_equal(now[0].data, sim->now.displacement);
    assert_int_equal(now[0].bytes, 3 * NODES * sizeof(double));
    free(memory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_do_not_overlap),
        cmocka_unit_test(too_small_a_block_is_refused),
        cmocka_unit_test(huge_counts_do_not_wrap),
        cmocka_unit_test(groups_follow_the_lists),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
