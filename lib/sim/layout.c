/* Memory of a sim in its block. The same code runs with an arena that counts only (dmb_sim_bytes, addresses are
 * discarded) and with one that places (dmb_sim_carve): the size that a caller was told cannot differ from what is used.
 *
 *     in the block    contents                                     rejected step   backup   snapshot, hash
 *     -------------   ------------------------------------------   -------------   ------   --------------
 *     struct          handles, options, message                    stays           no       no
 *     now             accepted configuration                       stays           yes      yes
 *     memory          what is kept once                            stays           yes      yes
 *     factors         matrix factors that steps may reuse          stays           no       yes
 *     trial           configuration of the step under way          discarded       no       no
 *     work            everything else, the backup itself included  discarded       no       no
 *     own scene       parts of the scene changed by inputs         stays           no       no
 *
 * The own scene follows from values in the memory (dmb_own_scene_update), so whoever restores those updates it. Factors
 * are in a snapshot so that a restored sim iterates as the original one, and not in the backup, because a step that may
 * be reverted does not change them. */
#include "sim/layout.h"

#include <string.h>

#include "base/memory.h"
#include "sim/chunks.h"
#include "sim/own_scene.h"

/* The letters of sim/sim.h. 64 bits: nine times a 32-bit count cannot overflow. */
typedef struct field_counts {
    uint64_t n, r, s, p, sb, pb, pf, st, e, d, k, law, load, history, diagonal, link, backup;
    uint64_t act, delay, cut, ns, u, ur, held, input, event, force, fs, spare, zs, stuck, f, ro, j, c, cluster, column,
        raw, jacobian, tangent, dense, square, full, block, value, pivots, kd, kl, kn;
    uint64_t sparse_values, sparse_rows, sparse_raw, sparse_c, sparse_block, chain, piece;
} field_counts;

/* The letters as names, for the count expressions of the lists; not every list uses all of them. */
#define DMB_COUNT_NAMES(of)                                                                                         \
    const uint64_t n = (of)->n, r = (of)->r, s = (of)->s, p = (of)->p, e = (of)->e, d = (of)->d, k = (of)->k;       \
    const uint64_t load = (of)->load, history = (of)->history, diagonal = (of)->diagonal, link = (of)->link;        \
    const uint64_t backup = (of)->backup, j = (of)->j, c = (of)->c, cluster = (of)->cluster;                        \
    const uint64_t column = (of)->column, raw = (of)->raw, jacobian = (of)->jacobian, tangent = (of)->tangent;      \
    const uint64_t dense = (of)->dense, square = (of)->square, full = (of)->full, block = (of)->block;              \
    const uint64_t value = (of)->value, pivots = (of)->pivots;                                                      \
    const uint64_t ns = (of)->ns, held = (of)->held, input = (of)->input, event = (of)->event, force = (of)->force; \
    const uint64_t stuck = (of)->stuck;                                                                             \
    const uint64_t u = (of)->u, ur = (of)->ur;                                                                      \
    const uint64_t fs = (of)->fs, spare = (of)->spare, zs = (of)->zs;                                               \
    (void)fs, (void)spare, (void)zs;                                                                                \
    (void)u, (void)ur, (void)stuck, (void)ns, (void)held, (void)input, (void)event, (void)force;                    \
    const uint64_t kd = (of)->kd, kl = (of)->kl, kn = (of)->kn, sb = (of)->sb, pb = (of)->pb, st = (of)->st;        \
    const uint64_t sparse_values = (of)->sparse_values, sparse_rows = (of)->sparse_rows;                            \
    const uint64_t sparse_raw = (of)->sparse_raw, sparse_c = (of)->sparse_c;                                        \
    const uint64_t sparse_block = (of)->sparse_block;                                                               \
    (void)sparse_values, (void)sparse_rows, (void)sparse_raw, (void)sparse_c, (void)sparse_block;                   \
    const uint64_t pf = (of)->pf, law = (of)->law;                                                                  \
    (void)pf, (void)law;                                                                                            \
    const uint64_t act = (of)->act, delay = (of)->delay, cut = (of)->cut;                                           \
    (void)act, (void)delay, (void)cut;                                                                              \
    const uint64_t f = (of)->f, ro = (of)->ro, chain = (of)->chain, piece = (of)->piece;                            \
    (void)ro, (void)chain, (void)piece;                                                                             \
    (void)n, (void)r, (void)s, (void)p, (void)e, (void)d, (void)k, (void)load, (void)history, (void)diagonal,       \
        (void)link, (void)backup, (void)j, (void)c, (void)cluster, (void)column, (void)raw, (void)jacobian,         \
        (void)tangent, (void)dense, (void)square, (void)full, (void)block, (void)value, (void)pivots, (void)kd,     \
        (void)kl, (void)kn, (void)sb, (void)pb, (void)st, (void)f

/* [byte] Size of the state in `backup`. A snapshot also contains the reused factors. */
#define DMB_ADD_BYTES(type, name, count, check) +(count) * sizeof(type)
static uint64_t state_bytes(const field_counts *counts)
{
    DMB_COUNT_NAMES(counts);
    return 0 DMB_CONFIGURATION_LIST(DMB_ADD_BYTES) DMB_MEMORY_LIST(DMB_ADD_BYTES);
}

/* All 0 without joints. Factors are kept for later steps without joints only, hence kd, kl, kn; with joints the matrix
 * of the reduced system (eq:joints.reduced-system) takes their place. */
static void count_constraints(const dmb_scene *scene, field_counts *c)
{
    const uint64_t any = scene->cluster_count > 0;
    c->j = scene->joint_count;
    c->c = scene->constraint_row_count;
    c->cluster = scene->cluster_count;
    c->column = scene->cluster_column_count;
    c->raw = any ? scene->row_count : 0;
    c->jacobian = scene->jacobian_count;
    c->tangent = scene->tangent_count;
    c->dense = scene->dense_count;
    c->square = scene->square_count;
    c->full = scene->six_dof_count;
    c->block = scene->block_count;
    c->kd = any ? 0 : c->diagonal;
    c->kl = any ? 0 : c->link;
    c->kn = any || scene->site_count == 0 ? 0 : scene->node_count;
    c->value = any ? scene->pattern.values : 0;
    c->pivots = any ? scene->pattern.rows : 0;
    const uint64_t sparse = scene->sparse_count > 0;
    c->sparse_values = sparse ? scene->pattern.values : 0;
    c->sparse_rows = sparse ? scene->pattern.rows : 0;
    c->sparse_raw = sparse ? scene->row_count : 0;
    c->sparse_c = sparse ? scene->constraint_row_count : 0;
    c->sparse_block = sparse ? scene->block_count : 0;
}

/* Largest number of chunks of a run of elements, nodes or contact points; 0: none is divided. */
static uint64_t pieces_of(const dmb_scene *scene)
{
    const uint32_t most = scene->node_count > scene->site_count ? scene->node_count : scene->site_count;
    const uint32_t pieces = dmb_chunks_of(most);
    return pieces > 1 ? pieces : 0;
}

/* `backup` is last: it is the size of what the other letters count. */
static field_counts counts_of(const dmb_scene *scene)
{
    const uint32_t n = scene->node_count;
    field_counts c;
    c.n = n;
    c.r = scene->row_count;
    c.s = scene->site_count;
    c.u = scene->unilateral_count;
    c.ur = c.u > 0 ? scene->row_count : 0;
    c.ns = c.s > 0 || c.u > 0 ? n : 0;
    c.held = scene->constrained_count;
    c.input = scene->input_count;
    c.event = scene->event_count;
    c.f = scene->free_rigid_count;
    c.ro = scene->rotor_count;
    c.chain = scene->chain_count;
    c.piece = pieces_of(scene);
    c.p = scene->axial_torsional_site_count;
    c.sb = dmb_scene_has_bristles(scene) ? c.s : 0;
    c.pb = dmb_scene_has_bristles(scene) ? c.p : 0;
    c.zs = scene->friction_law.states;
    c.pf = scene->friction_law.kind != DMB_FRICTION_NONE ? c.p : 0;
    c.law = scene->law_count;
    c.st = dmb_scene_has_touch(scene) ? c.s : 0;
    c.e = scene->element_count;
    c.d = scene->drive_count;
    c.act = scene->actuator_count;
    c.delay = scene->delay_count;
    c.cut = scene->hole.cuts;
    c.k = scene->bit_count;
    c.load = scene->load_count;
    c.force = scene->force_count;
    c.fs = scene->force_states;
    c.spare = 0;
    for (uint32_t i = 0; i < scene->force_count; i++)
        if (scene->forces[i].states > c.spare) c.spare = scene->forces[i].states;
    c.stuck = scene->stuck_count;
    c.history = scene->history_count;
    c.diagonal = n > 0 ? scene->layout.diag[n] : 0;
    c.link = n > 0 ? scene->layout.link[n - 1] : 0;
    count_constraints(scene, &c);
    c.backup = 0;
    c.backup = state_bytes(&c);
    return c;
}

static void *take(dmb_arena *arena, uint64_t count, size_t item_size)
{
    if (count > SIZE_MAX) arena->overflow = true;
    return dmb_arena_allocate(arena, (size_t)count, item_size, DMB_ALIGNMENT);
}

#define DMB_TAKE_WORK(type, name, count) to->name = (type *)take(arena, (count), sizeof(type));
#define DMB_TAKE(type, name, count, check) DMB_TAKE_WORK(type, name, count)

static void allocate_configuration(dmb_arena *arena, const field_counts *counts, dmb_configuration *to)
{
    DMB_COUNT_NAMES(counts);
    DMB_CONFIGURATION_LIST(DMB_TAKE)
}

static void allocate_memory(dmb_arena *arena, const field_counts *counts, dmb_sim *to)
{
    DMB_COUNT_NAMES(counts);
    DMB_MEMORY_LIST(DMB_TAKE)
}

static void allocate_factors(dmb_arena *arena, const field_counts *counts, dmb_sim *to)
{
    DMB_COUNT_NAMES(counts);
    DMB_FACTOR_LIST(DMB_TAKE)
}

static void allocate_work(dmb_arena *arena, const field_counts *counts, dmb_sim *to)
{
    DMB_COUNT_NAMES(counts);
    DMB_WORK_LIST(DMB_TAKE_WORK)
}

/* The struct itself comes first, so that the sim's address is the first cache line of the block. While counting there
 * is no sim, and addresses are discarded. */
static dmb_sim *lay_out(dmb_arena *arena, const dmb_scene *scene)
{
    const field_counts counts = counts_of(scene);
    dmb_sim nowhere;
    dmb_sim *sim = take(arena, 1, sizeof *sim);
    dmb_sim *to = sim != NULL ? sim : &nowhere;
    allocate_configuration(arena, &counts, &to->now);
    allocate_memory(arena, &counts, to);
    allocate_factors(arena, &counts, to);
    allocate_configuration(arena, &counts, &to->trial);
    allocate_work(arena, &counts, to);
    if (dmb_needs_own_scene(scene)) to->own = dmb_own_scene_allocate(arena, scene);
    return arena->overflow ? NULL : sim;
}

size_t dmb_sim_bytes(const dmb_scene *scene)
{
    dmb_arena arena;
    dmb_arena_count(&arena);
    (void)lay_out(&arena, scene);
    return dmb_arena_block_size(&arena);
}

dmb_sim *dmb_sim_carve(const dmb_scene *scene, void *block, size_t size)
{
    dmb_arena arena;
    dmb_sim *sim;
    if (block == NULL || size < dmb_sim_bytes(scene)) return NULL;
    dmb_arena_place(&arena, block, size);
    sim = lay_out(&arena, scene);
    if (sim == NULL) return NULL;
    sim->scene = scene;
    sim->progress = &sim->own_progress;
    sim->chunks = &sim->own_chunks;
    sim->block = block;
    sim->block_size = size;
    return sim;
}

/* ---- The table of fields ----------------------------------------------------------------------------------------- */

typedef struct field_table {
    dmb_field *fields;
    size_t count;
    int32_t group;
    int32_t reserved;
} field_table;

static void put_field(field_table *table, const char *name, void *data, uint64_t count, size_t item_size, int32_t check)
{
    dmb_field *field;
    if (table->count == DMB_FIELD_MAX) return;
    field = &table->fields[table->count++];
    field->name = name;
    field->data = data;
    field->bytes = (size_t)count * item_size;
    field->group = table->group;
    field->check = check;
}

#define DMB_PUT(type, name, count, check) put_field(table, #name, from->name, (count), sizeof(type), DMB_CHECK_##check);
#define DMB_PUT_WORK(type, name, count) put_field(table, #name, from->name, (count), sizeof(type), -1);

static void put_configuration(field_table *table, const field_counts *counts, const dmb_configuration *from)
{
    DMB_COUNT_NAMES(counts);
    DMB_CONFIGURATION_LIST(DMB_PUT)
}

static void put_memory(field_table *table, const field_counts *counts, const dmb_sim *from)
{
    DMB_COUNT_NAMES(counts);
    DMB_MEMORY_LIST(DMB_PUT)
}

static void put_factors(field_table *table, const field_counts *counts, const dmb_sim *from)
{
    DMB_COUNT_NAMES(counts);
    DMB_FACTOR_LIST(DMB_PUT)
}

static void put_work(field_table *table, const field_counts *counts, const dmb_sim *from)
{
    DMB_COUNT_NAMES(counts);
    DMB_WORK_LIST(DMB_PUT_WORK)
}

size_t dmb_sim_fields(const dmb_sim *sim, int32_t first_group, int32_t last_group, dmb_field fields[DMB_FIELD_MAX])
{
    const field_counts counts = counts_of(sim->scene);
    field_table table = {fields, 0, 0, 0};
    for (table.group = first_group; table.group <= last_group; ++table.group) {
        if (table.group == DMB_GROUP_NOW) put_configuration(&table, &counts, &sim->now);
        if (table.group == DMB_GROUP_MEMORY) put_memory(&table, &counts, sim);
        if (table.group == DMB_GROUP_FACTORS) put_factors(&table, &counts, sim);
        if (table.group == DMB_GROUP_TRIAL) put_configuration(&table, &counts, &sim->trial);
        if (table.group == DMB_GROUP_WORK) put_work(&table, &counts, sim);
    }
    return table.count;
}

#define DMB_COPY_FIELD(type, name, count, check) memcpy(to->name, from->name, (size_t)(count) * sizeof(type));

void dmb_configuration_copy(const dmb_sim *sim, const dmb_configuration *from, dmb_configuration *to)
{
    const field_counts counts = counts_of(sim->scene);
    DMB_COUNT_NAMES(&counts);
    DMB_CONFIGURATION_LIST(DMB_COPY_FIELD)
}

void dmb_state_back_up(dmb_sim *sim)
{
    dmb_field fields[DMB_FIELD_MAX];
    const size_t count = dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_MEMORY, fields);
    uint8_t *to = sim->backup;
    for (size_t i = 0; i < count; to += fields[i].bytes, i++) memcpy(to, fields[i].data, fields[i].bytes);
}

void dmb_state_restore(dmb_sim *sim)
{
    dmb_field fields[DMB_FIELD_MAX];
    const size_t count = dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_MEMORY, fields);
    const uint8_t *from = sim->backup;
    for (size_t i = 0; i < count; from += fields[i].bytes, i++) memcpy(fields[i].data, from, fields[i].bytes);
}
