/* A pool in the caller's memory, held against a map of who owns which byte, and against the same runs on the heap. */
#include "sim_test.h"

enum { LINE = 64, ROOM = 256 * 1024, FENCE = 256 };

static _Alignas(64) unsigned char memory[FENCE + ROOM + FENCE];

static dmb_allocator pool_at(size_t offset, size_t size)
{
    dmb_allocator pool;
    memset(memory, 0xA5, sizeof memory);
    assert_int_equal(dmb_pool_allocator(memory + FENCE + offset, size, &pool), DMB_OK);
    return pool;
}

static void fences_stand(size_t offset, size_t size)
{
    for (size_t i = 0; i < FENCE + offset; i++) assert_int_equal(memory[i], 0xA5);
    for (size_t i = FENCE + offset + size; i < sizeof memory; i++) assert_int_equal(memory[i], 0xA5);
}

static void *take(const dmb_allocator *pool, size_t size)
{
    return pool->allocate(pool->context, size, LINE);
}

static void give(const dmb_allocator *pool, void *block, size_t size)
{
    pool->release(pool->context, block, size, LINE);
}

/* All of it is one gap: it can be taken at once, and not a byte more. */
static void is_whole(const dmb_allocator *pool, size_t lines)
{
    void *all = take(pool, lines * LINE);
    assert_non_null(all);
    assert_null(take(pool, 1));
    give(pool, all, lines * LINE);
}

static void nonsense_is_refused(void **state)
{
    (void)state;
    dmb_allocator pool, before;
    memset(&pool, 0x5A, sizeof pool);
    before = pool;
    assert_int_equal(dmb_pool_allocator(NULL, 4096, &pool), DMB_ERR_NULL);
    assert_int_equal(dmb_pool_allocator(memory, 4096, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_pool_allocator(memory, 0, &pool), DMB_ERR_VALUE);
    assert_int_equal(dmb_pool_allocator(memory, 255, &pool), DMB_ERR_VALUE);
    assert_int_equal(dmb_pool_allocator(memory, SIZE_MAX, &pool), DMB_ERR_VALUE);
    assert_int_equal(dmb_pool_allocator(memory, SIZE_MAX - 4096, &pool), DMB_ERR_VALUE);
    assert_memory_equal(&pool, &before, sizeof pool);
    assert_int_equal(dmb_pool_peak(NULL), 0);
    before = dmb_allocator_default();
    assert_int_equal(dmb_pool_peak(&before), 0);
}

/* A caller compiled against the first release has 32 bytes for an allocator. */
static void the_struct_is_that_of_the_first_release(void **state)
{
    (void)state;
    const dmb_allocator pool = pool_at(0, ROOM);
    dmb_model_options options = dmb_model_options_default();
    dmb_model *model = NULL;
    assert_int_equal(pool.struct_size, sizeof(void *) == 8 ? 32 : 20);
    options.allocator = &pool;
    assert_int_equal(dmb_model_create(&options, &model), DMB_OK);
    dmb_model_destroy(&model);
}

static void any_address_will_do(void **state)
{
    (void)state;
    for (size_t offset = 0; offset <= LINE; offset++) {
        const size_t size = 256 + 7 * offset, before = (LINE - offset % LINE) % LINE;
        const dmb_allocator pool = pool_at(offset, size);
        const size_t lines = (size - before) / LINE - 1;
        unsigned char *block = take(&pool, 1);
        assert_non_null(block);
        assert_int_equal((uintptr_t)block % LINE, 0);
        give(&pool, block, 1);
        is_whole(&pool, lines);
        block = take(&pool, lines * LINE);
        memset(block, 0, lines * LINE);
        give(&pool, block, lines * LINE);
        fences_stand(offset, size);
    }
}

static void requests_that_no_pool_can_meet(void **state)
{
    (void)state;
    const dmb_allocator pool = pool_at(0, 1024);
    assert_null(take(&pool, 0));
    assert_null(take(&pool, SIZE_MAX));
    assert_null(take(&pool, SIZE_MAX - LINE + 2));
    assert_null(take(&pool, 1024));
    assert_null(pool.allocate(pool.context, 64, 128));
    is_whole(&pool, 15);
}

/* The lowest gap that is large enough, from its beginning. */
static void first_fit(void **state)
{
    (void)state;
    const dmb_allocator pool = pool_at(0, 4096);
    unsigned char *a = take(&pool, 128), *b = take(&pool, 64), *c = take(&pool, 256), *d = take(&pool, 64);
    assert_ptr_equal(b, a + 128);
    assert_ptr_equal(c, b + 64);
    assert_ptr_equal(d, c + 256);
    give(&pool, a, 128);
    give(&pool, c, 256);
    assert_ptr_equal(take(&pool, 192), c);
    assert_ptr_equal(take(&pool, 65), a);
    assert_ptr_equal(take(&pool, 1), c + 192);
    assert_ptr_equal(take(&pool, 64), d + 64);
}

/* Four blocks side by side, given back in each of their 24 orders. */
static void neighbours_join(void **state)
{
    (void)state;
    const size_t sizes[4] = {64, 130, 200, 1};
    for (int order = 0; order < 256; order++) {
        const int at[4] = {order & 3, order >> 2 & 3, order >> 4 & 3, order >> 6};
        void *block[4];
        if ((1 << at[0] | 1 << at[1] | 1 << at[2] | 1 << at[3]) != 15) continue;
        const dmb_allocator pool = pool_at(0, LINE * (2 + 1 + 3 + 4 + 1));
        for (int i = 0; i < 4; i++) block[i] = take(&pool, sizes[i]);
        for (int i = 0; i < 4; i++) give(&pool, block[at[i]], sizes[at[i]]);
        is_whole(&pool, 10);
    }
}

/* A block given back twice, or one of other memory, would be handed out to two owners. */
static void what_is_not_out_cannot_come_back(void **state)
{
    (void)state;
    static _Alignas(64) unsigned char other[128];
    const dmb_allocator pool = pool_at(0, 1024);
    unsigned char *a = take(&pool, 128), *b = take(&pool, 128);
    give(&pool, a, 128);
    give(&pool, a, 128);
    give(&pool, a + 64, 64);
    give(&pool, other, 128);
    give(&pool, b + 1, 64);
    give(&pool, b, 4096);
    give(&pool, b, 0);
    give(&pool, b, 192); /* beyond it is a gap */
    give(&pool, b + 1024, 64);
    give(&pool, b + 128, 64);
    give(&pool, NULL, 64);
    assert_ptr_equal(take(&pool, 128), a);
    assert_ptr_equal(take(&pool, 64), b + 128);
    give(&pool, b + 128, 64);
    give(&pool, a, 128);
    give(&pool, b, 128);
    is_whole(&pool, 15);
}

static void the_peak_is_kept(void **state)
{
    (void)state;
    const dmb_allocator pool = pool_at(0, 4096);
    dmb_allocator nowhere = pool;
    nowhere.context = NULL;
    assert_int_equal(dmb_pool_peak(&nowhere), 0);
    assert_int_equal(dmb_pool_peak(&pool), LINE);
    void *a = take(&pool, 100), *b = take(&pool, 64);
    assert_int_equal(dmb_pool_peak(&pool), LINE + 128 + 64);
    give(&pool, a, 100);
    assert_int_equal(dmb_pool_peak(&pool), LINE + 128 + 64);
    a = take(&pool, 64);
    assert_int_equal(dmb_pool_peak(&pool), LINE + 128 + 64);
    assert_null(take(&pool, 8192));
    assert_int_equal(dmb_pool_peak(&pool), LINE + 128 + 64);
    give(&pool, a, 64);
    give(&pool, b, 64);
}

/* ---- Random calls against a map of the lines --------------------------------------------------------------------- */

enum { MAP = 1000, OUT = 40 };

typedef struct block {
    unsigned char *at;
    size_t size;
} block;

/* The lines of a block, from what they were to what they are. */
static void mark(unsigned char owner[MAP], const block *b, unsigned char from, unsigned char to)
{
    const size_t first = (size_t)(b->at - memory - FENCE) / LINE;
    for (size_t i = 0; i < (b->size + LINE - 1) / LINE; i++) {
        assert_true(first + i < MAP);
        assert_int_equal(owner[first + i], from);
        owner[first + i] = to;
    }
}

/* A request fails only where no run of free lines is long enough. */
static void none_is_long_enough(const unsigned char owner[MAP], size_t size)
{
    size_t run = 0;
    for (size_t i = 1; i < MAP; i++) {
        run = owner[i] ? 0 : run + 1;
        assert_true(run < (size + LINE - 1) / LINE);
    }
}

static void no_line_has_two_owners(void **state)
{
    (void)state;
    static unsigned char owner[MAP];
    block out[OUT] = {{0}};
    uint64_t random = 1;
    unsigned refused = 0;
    const dmb_allocator pool = pool_at(0, MAP * LINE);
    for (int i = 0; i < 40000; i++) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        block *b = out + (random >> 33) % OUT;
        if (b->at != NULL) {
            mark(owner, b, 1, 0);
            give(&pool, b->at, b->size);
            b->at = NULL;
            continue;
        }
        b->size = 1 + (random >> 40) % 7000;
        b->at = take(&pool, b->size);
        if (b->at != NULL) {
            mark(owner, b, 0, 1);
        } else {
            none_is_long_enough(owner, b->size);
            refused++;
        }
    }
    assert_true(refused > 1000);
    for (int i = 0; i < OUT; i++)
        if (out[i].at != NULL) give(&pool, out[i].at, out[i].size);
    is_whole(&pool, MAP - 1);
    fences_stand(0, MAP * LINE);
}

/* ---- Models and sims on a pool ----------------------------------------------------------------------------------- */

typedef struct twin {
    dmb_model *model;
    dmb_sim *sim;
} twin;

static void destroy(twin *t)
{
    dmb_sim_destroy(&t->sim);
    dmb_model_destroy(&t->model);
}

static int32_t create(const dmb_allocator *allocator, twin *t)
{
    dmb_model_options options = dmb_model_options_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    options.allocator = allocator;
    memset(t, 0, sizeof *t);
    int32_t status = dmb_model_create(&options, &t->model);
    if (status >= 0) status = dmb_model_add_wall(t->model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(t->model, &pipe, 5, NULL);
    if (status >= 0) status = dmb_model_add_bit(t->model, &bit, NULL);
    if (status >= 0) status = dmb_model_compile(t->model, NULL);
    if (status >= 0) status = dmb_sim_create(t->model, NULL, &t->sim);
    if (status < 0) assert_null(t->sim);
    return status;
}

static uint64_t hash_after(twin *t, int steps)
{
    uint64_t hash = 0;
    for (int i = 0; i < steps; i++) assert_true(dmb_sim_step(t->sim, 1e-3, NULL) >= 0);
    assert_int_equal(dmb_sim_hash(t->sim, &hash), DMB_OK);
    return hash;
}

/* Two models and their sims, stepped in turns, and the same on the heap. */
static void two_models_share_a_pool(void **state)
{
    (void)state;
    const dmb_allocator pool = pool_at(0, ROOM);
    twin first = {0}, second = {0}, heap = {0};
    assert_true(create(&pool, &first) >= 0 && create(&pool, &second) >= 0 && create(NULL, &heap) >= 0);
    const uint64_t wanted = hash_after(&heap, 20);
    (void)hash_after(&first, 10);
    assert_true(hash_after(&second, 20) == wanted);
    destroy(&second);
    assert_true(hash_after(&first, 10) == wanted);
    destroy(&first);
    destroy(&heap);
    is_whole(&pool, ROOM / LINE - 1);
    fences_stand(0, ROOM);
}

/* Pools that are too small for one step of the way after the other: each fails as no memory, and all of it comes back.
 */
static void a_small_pool_refuses_and_loses_nothing(void **state)
{
    (void)state;
    size_t size = 256, failed = 0;
    int32_t status = DMB_ERR_NO_MEMORY;
    for (; status == DMB_ERR_NO_MEMORY && size <= ROOM; size += 512, failed++) {
        twin t;
        const dmb_allocator pool = pool_at(0, size);
        status = create(&pool, &t);
        assert_true(dmb_pool_peak(&pool) <= size);
        destroy(&t);
        is_whole(&pool, size / LINE - 1);
        fences_stand(0, size);
    }
    assert_int_equal(status < 0 ? status : DMB_OK, DMB_OK);
    assert_true(failed > 20);
}

/* A second sim for which there is no room: the first goes on as on the heap, and so does the model. */
static void nothing_changes_where_there_is_no_room(void **state)
{
    (void)state;
    twin t = {0}, heap = {0};
    dmb_sim *more[64] = {NULL};
    int count = 0;
    const dmb_allocator pool = pool_at(0, ROOM);
    assert_true(create(&pool, &t) >= 0 && create(NULL, &heap) >= 0);
    const uint64_t wanted = hash_after(&heap, 10), at_start = hash_after(&t, 0);
    while (count < 64 && dmb_sim_create(t.model, NULL, more + count) >= 0) count++;
    assert_in_range(count, 1, 63);
    assert_int_equal(dmb_sim_create(t.model, NULL, more + count), DMB_ERR_NO_MEMORY);
    assert_null(more[count]);
    assert_true(hash_after(&t, 0) == at_start);
    assert_true(hash_after(&t, 10) == wanted);
    dmb_sim_destroy(more);
    assert_true(dmb_sim_create(t.model, NULL, more) >= 0);
    while (count > 0) dmb_sim_destroy(more + --count);
    destroy(&t);
    destroy(&heap);
    is_whole(&pool, ROOM / LINE - 1);
}

/* Blocks in an order that leaves gaps: the same calls succeed in a pool of the peak, and not in one of a line less. */
static void the_peak_suffices(void **state)
{
    (void)state;
    size_t peak = 4096;
    for (int round = 0; round < 3; round++) {
        const dmb_allocator pool = pool_at(0, round < 2 ? peak : peak - LINE);
        void *a = take(&pool, 128), *b = take(&pool, 64);
        give(&pool, a, 128);
        void *c = take(&pool, 192);
        if (round == 2) {
            assert_null(c);
            break;
        }
        assert_non_null(c);
        peak = dmb_pool_peak(&pool);
        assert_int_equal(peak, LINE + 128 + 64 + 192);
        give(&pool, b, 64);
        give(&pool, c, 192);
    }
}

/* Of a model and a sim, too. */
static void the_peak_suffices_for_a_sim(void **state)
{
    (void)state;
    twin t;
    dmb_allocator pool = pool_at(0, ROOM);
    assert_true(create(&pool, &t) >= 0);
    const size_t peak = dmb_pool_peak(&pool);
    destroy(&t);
    pool = pool_at(0, peak);
    assert_true(create(&pool, &t) >= 0);
    assert_int_equal(dmb_pool_peak(&pool), peak);
    destroy(&t);
}

static void a_thousand_lives_take_no_more_than_one(void **state)
{
    (void)state;
    twin t;
    const dmb_allocator pool = pool_at(0, ROOM);
    assert_true(create(&pool, &t) >= 0);
    const size_t peak = dmb_pool_peak(&pool);
    destroy(&t);
    for (int i = 0; i < 1000; i++) {
        assert_true(create(&pool, &t) >= 0);
        destroy(&t);
    }
    assert_int_equal(dmb_pool_peak(&pool), peak);
    is_whole(&pool, ROOM / LINE - 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nonsense_is_refused),
        cmocka_unit_test(the_struct_is_that_of_the_first_release),
        cmocka_unit_test(any_address_will_do),
        cmocka_unit_test(requests_that_no_pool_can_meet),
        cmocka_unit_test(first_fit),
        cmocka_unit_test(neighbours_join),
        cmocka_unit_test(what_is_not_out_cannot_come_back),
        cmocka_unit_test(the_peak_is_kept),
        cmocka_unit_test(the_peak_suffices),
        cmocka_unit_test(the_peak_suffices_for_a_sim),
        cmocka_unit_test(no_line_has_two_owners),
        cmocka_unit_test(two_models_share_a_pool),
        cmocka_unit_test(a_small_pool_refuses_and_loses_nothing),
        cmocka_unit_test(nothing_changes_where_there_is_no_room),
        cmocka_unit_test(a_thousand_lives_take_no_more_than_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
