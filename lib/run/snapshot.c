/* Snapshots: bytes of the state behind a header, without gaps.
 *
 *     header | now | memory | factors
 *
 * A snapshot is untrusted input, and its checksum can be forged. It is restored in this order, so that no index is used
 * before it is checked, and a refusal leaves the sim as it was:
 *
 *     header       mark, version, model, size, options, length of the bytes, checksum
 *     fields       every index, count and choice by the scene, every number finite, before anything is written
 *     back up      now and memory of the sim
 *     read         now and memory
 *     relations    between fields (run/snapshot_relations); a refusal restores the backup
 *     factors      read last, since the backup has none
 *     own scene    updated by the values of inputs */
#include "run/run.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "model/describe.h"
#include "model/field_check.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "sim/own_scene.h"
#include "system/assemble/bounces.h"
#include "system/constrain/constrain.h"

/* ---- Is this a state of the scene? ------------------------------------------------------------------------------- */

/* A snapshot is untrusted input, and its checksum can be forged: before anything is restored, every index, count and
 * enumeration in it is checked against the scene, and every number must be finite; then relations between fields are
 * checked (run/snapshot_relations). */

/* Fields of integers and structs require a check: a line of sim/sim.h without one does not compile. */
#define DMB_DOUBLES(type) _Generic(*(type *)0, double : 1, dmb_drive_variables : 1, default : 0)
#define DMB_NAMES_BOUND(type, name, count, check)                                                                  \
    _Static_assert(DMB_DOUBLES(type) ==                                                                            \
                       (DMB_CHECK_##check == DMB_CHECK_NUMBERS || DMB_CHECK_##check == DMB_CHECK_INPUTS ||         \
                        DMB_CHECK_##check == DMB_CHECK_SET_INPUTS || DMB_CHECK_##check == DMB_CHECK_EVENT_TIMES || \
                        DMB_CHECK_##check == DMB_CHECK_FRAMES),                                                    \
                   #name ": its check does not fit its type");
DMB_CONFIGURATION_LIST(DMB_NAMES_BOUND)
DMB_MEMORY_LIST(DMB_NAMES_BOUND)
DMB_FACTOR_LIST(DMB_NAMES_BOUND)

/* One field in a snapshot, at any alignment. */
typedef struct probe {
    dmb_sim *sim;
    const dmb_field *field;
    const unsigned char *from;
} probe;

static int32_t refuse(const probe *p, size_t item, double value, const char *bound)
{
    dmb_message_set(
        &p->sim->message,
        "snapshot: %s, number %zu = %g, must be %s; these are no state of this model, take another snapshot",
        p->field->name, item, value, bound);
    return DMB_ERR_VALUE;
}

static double number_at(const probe *p, size_t i)
{
    double value;
    memcpy(&value, p->from + i * sizeof value, sizeof value);
    return value;
}

static uint32_t word_at(const probe *p, size_t i)
{
    uint32_t value;
    memcpy(&value, p->from + i * sizeof value, sizeof value);
    return value;
}

static int32_t check_numbers(const probe *p, size_t first, size_t end)
{
    for (size_t i = first; i < end; i++) {
        const double value = number_at(p, i);
        if (!isfinite(value)) return refuse(p, i, value, "finite");
    }
    return DMB_OK;
}

static int32_t check_inputs(const probe *p)
{
    for (size_t i = 0; i < p->field->bytes / sizeof(double); i++) {
        const double value = number_at(p, i);
        if (!isnan(value) && !(fabs(value) <= DMB_FORCE_MAX)) return refuse(p, i, value, "from -1e30 to 1e30, or NaN");
    }
    return DMB_OK;
}

static int32_t check_set_inputs(const probe *p)
{
    for (uint32_t i = 0; i < p->sim->scene->input_count; i++) {
        const dmb_scene_input *input = p->sim->scene->inputs + i;
        const double value = number_at(p, i);
        const int described = isnan(input->initial) != 0;
        if (input->target == DMB_TARGET_STUCK && value > 0.0 && value < 1.0) return refuse(p, i, value, "0 or 1");
        if (isnan(value) && described && dmb_input_is_time_function(input->target)) continue;
        /* described values may be outside the bounds of set values */
        if (value >= input->low && value <= input->high) continue;
        if (described && value == dmb_described_setting(p->sim, i)) continue;
        return refuse(p, i, value, "within the bounds of its input");
    }
    return DMB_OK;
}

static int32_t check_event_times(const probe *p)
{
    for (size_t i = 0; i < p->field->bytes / sizeof(double); i++) {
        const double value = number_at(p, i);
        if (isinf(value) && value < 0.0) return refuse(p, i, value, "a time, NaN or above all times");
    }
    return DMB_OK;
}

/* Words without the bits of `mark` below `end`. */
static int32_t check_words(const probe *p, uint32_t end, uint32_t mark)
{
    for (size_t i = 0; i < p->field->bytes / sizeof(uint32_t); i++) {
        const uint32_t value = word_at(p, i);
        if ((value & ~mark) >= end) return refuse(p, i, value, "an index or choice that the scene has");
    }
    return DMB_OK;
}

static int32_t check_ranks(const probe *p)
{
    for (uint32_t k = 0; k < p->sim->scene->cluster_count; k++) {
        const dmb_cluster *cluster = p->sim->scene->clusters + k;
        const uint32_t value = word_at(p, k);
        if (value > cluster->rows || value > cluster->columns)
            return refuse(p, k, value, "at most the rows and the columns of its cluster");
    }
    return DMB_OK;
}

/* A permutation of 0 .. count - 1, starting at `first`; values seen are marked in cluster_scratch, which has more than
 * a byte for each. */
static int32_t check_order(const probe *p, uint32_t first, uint32_t count)
{
    uint8_t *seen = (uint8_t *)(void *)p->sim->cluster_scratch;
    memset(seen, 0, count);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t value = word_at(p, (size_t)first + i);
        if (value >= count || seen[value]) return refuse(p, (size_t)first + i, value, "one of its cluster, each once");
        seen[value] = 1;
    }
    return DMB_OK;
}

static int32_t check_orders(const probe *p, int32_t of_columns)
{
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < p->sim->scene->cluster_count && status >= 0; k++) {
        const dmb_cluster *cluster = p->sim->scene->clusters + k;
        status = of_columns ? check_order(p, cluster->column, cluster->columns)
                            : check_order(p, cluster->row, cluster->rows);
    }
    return status;
}

/* The newest of count samples is at head, in a circular buffer of the bit's capacity; without one both are 0. */
static int32_t check_heads(const probe *p)
{
    for (uint32_t k = 0; k < p->sim->scene->bit_count; k++) {
        const uint32_t capacity = p->sim->scene->bits[k].history_capacity;
        dmb_history_head head;
        memcpy(&head, p->from + k * sizeof head, sizeof head);
        if (head.head >= capacity && head.head != 0)
            return refuse(p, k, head.head, "below the capacity of the bit's history");
        if (head.count > capacity || (head.count == 0) != (capacity == 0))
            return refuse(p, k, head.count, "from 1 to the capacity of the bit's history");
        if (!isfinite(head.offset)) return refuse(p, k, head.offset, "finite");
    }
    return DMB_OK;
}

static int32_t check_clock(const probe *p)
{
    const int32_t status = check_numbers(p, 0, sizeof(dmb_clock) / sizeof(double)); /* all members are */
    dmb_clock clock;
    memcpy(&clock, p->from, sizeof clock);
    if (status < 0) return status;
    if (!(clock.time >= 0.0)) return refuse(p, 0, clock.time, ">= 0");
    if (!(clock.step >= 0.0)) return refuse(p, offsetof(dmb_clock, step) / sizeof(double), clock.step, ">= 0");
    if (!(clock.next_step >= 0.0))
        return refuse(p, offsetof(dmb_clock, next_step) / sizeof(double), clock.next_step, ">= 0");
    return DMB_OK;
}

static int32_t check_counters(const probe *p)
{
    dmb_counters counters;
    memcpy(&counters, p->from, sizeof counters);
    const double numbers[] = {counters.largest_residual, counters.projection[0], counters.projection[1],
                              counters.assembly[0], counters.assembly[1]};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (!isfinite(numbers[i])) return refuse(p, i, numbers[i], "finite");
    return DMB_OK;
}

/* The factors themselves may belong to another matrix: corrections by them must reduce the residual
 * (integrator/newton). */
static int32_t check_factors(const probe *p)
{
    dmb_factor_reuse kept;
    memcpy(&kept, p->from, sizeof kept);
    if (!(kept.step >= 0.0 && isfinite(kept.step))) return refuse(p, 0, kept.step, "finite and >= 0");
    if (kept.pause > DMB_PAUSE_MAX) return refuse(p, 1, kept.pause, "at most 31");
    if (kept.back_off > DMB_PAUSE_MAX) return refuse(p, 2, kept.back_off, "at most 31");
    return DMB_OK;
}

static int32_t check_prediction(const probe *p)
{
    dmb_prediction kept;
    memcpy(&kept, p->from, sizeof kept);
    if (kept.pause > DMB_PAUSE_MAX) return refuse(p, 1, kept.pause, "at most 31");
    if (kept.back_off > DMB_PAUSE_MAX) return refuse(p, 2, kept.back_off, "at most 31");
    if (kept.reserved != 0) return refuse(p, 3, kept.reserved, "0");
    return DMB_OK;
}

/* Frames of the nodes in which the factors were made; zeros without factors. */
static int32_t check_frames(const probe *p)
{
    const int32_t status = check_numbers(p, 0, p->field->bytes / sizeof(double));
    for (size_t i = 0; i < p->field->bytes / sizeof(double) && status >= 0; i += 4) {
        double square = 0.0;
        for (size_t k = i; k < i + 4; k++) square += number_at(p, k) * number_at(p, k);
        if (square != 0.0 && !(fabs(sqrt(square) - 1.0) <= DMB_ROTATION_ROUNDING))
            return refuse(p, i, number_at(p, i), "with the three after it of length 1, or 0 with them");
    }
    return status;
}

static int32_t check_ages(const probe *p)
{
    for (size_t i = 0; i < p->field->bytes; i++)
        if (p->from[i] >= 2 * DMB_SITE_OWN) return refuse(p, i, p->from[i], "below 32");
    return DMB_OK;
}

static int32_t check_field(const probe *p)
{
    const dmb_hole *hole = &p->sim->scene->hole;
    const uint32_t segments = p->sim->scene->has_hole && !dmb_hole_is_straight(hole) ? hole->stations : 1;
    switch (p->field->check) {
    case DMB_CHECK_NUMBERS: return check_numbers(p, 0, p->field->bytes / sizeof(double));
    case DMB_CHECK_INPUTS: return check_inputs(p);
    case DMB_CHECK_SET_INPUTS: return check_set_inputs(p);
    case DMB_CHECK_EVENT_TIMES: return check_event_times(p);
    case DMB_CHECK_FLAGS: return check_words(p, 2, 0);
    case DMB_CHECK_SEGMENTS: return check_words(p, segments, 0);
    case DMB_CHECK_JOINT_SEGMENTS: return check_words(p, segments, DMB_SEGMENT_HELD);
    case DMB_CHECK_JOINT_STATES: return check_words(p, DMB_JOINT_OPEN + 1, 0);
    case DMB_CHECK_RANKS: return check_ranks(p);
    case DMB_CHECK_ROW_ORDER: return check_orders(p, 0);
    case DMB_CHECK_COLUMN_ORDER: return check_orders(p, 1);
    case DMB_CHECK_HISTORY_HEADS: return check_heads(p);
    case DMB_CHECK_CLOCK: return check_clock(p);
    case DMB_CHECK_LEDGER: return check_numbers(p, 0, sizeof(dmb_ledger) / sizeof(double)); /* all members are */
    case DMB_CHECK_COUNTERS: return check_counters(p);
    case DMB_CHECK_REUSE: return check_factors(p);
    case DMB_CHECK_PREDICTION: return check_prediction(p);
    case DMB_CHECK_FRAMES: return check_frames(p);
    case DMB_CHECK_AGES: return check_ages(p);
    default: return refuse(p, 0, p->field->check, "a field with a check"); /* not reached */
    }
}

int32_t dmb_snapshot_check(dmb_sim *sim, const dmb_field *fields, size_t count, const unsigned char *from)
{
    int32_t status = DMB_OK;
    for (size_t i = 0; i < count && status >= 0; i++) {
        const probe p = {sim, fields + i, from};
        if (fields[i].bytes > 0) status = check_field(&p);
        from += fields[i].bytes;
    }
    return status;
}

/* ---- Saving and restoring ---------------------------------------------------------------------------------------- */

/* Saving and restoring the state. A snapshot is a header and the fields of the accepted configuration, the memory and
 * the reused factors, without gaps. */

/* "DMDBSNP1" read as a number: a snapshot of another byte order does not fit. */
#define DMB_SNAPSHOT_MAGIC UINT64_C(0x31504E5342444D44)
enum { DMB_SNAPSHOT_VERSION = 9 };

typedef struct snapshot_header {
    uint64_t magic;
    uint64_t version;
    uint64_t size;  /* [byte] of the whole snapshot */
    uint64_t scene; /* fingerprints of the required scene and options */
    uint64_t options;
    uint64_t content; /* hash of the contents: detects damage; forgery is detected by the checks of fields */
} snapshot_header;

static size_t saved_fields(const dmb_sim *sim, dmb_field fields[DMB_FIELD_MAX])
{
    return dmb_sim_fields(sim, DMB_GROUP_NOW, DMB_GROUP_FACTORS, fields);
}

static size_t snapshot_bytes(const dmb_sim *sim)
{
    dmb_field fields[DMB_FIELD_MAX];
    const size_t count = saved_fields(sim, fields);
    size_t bytes = sizeof(snapshot_header);
    for (size_t i = 0; i < count; ++i) bytes += fields[i].bytes; /* below the size of the sim, which was checked */
    return bytes;
}

static snapshot_header header_of(const dmb_sim *sim)
{
    snapshot_header header;
    header.magic = DMB_SNAPSHOT_MAGIC;
    header.version = DMB_SNAPSHOT_VERSION;
    header.size = snapshot_bytes(sim);
    header.scene = dmb_scene_fingerprint(sim->model->scene);
    header.options = dmb_options_fingerprint(&sim->options);
    header.content = 0;
    return header;
}

static uint64_t content_hash(const unsigned char *block, size_t size)
{
    return dmb_fnv_block(DMB_FNV_START, block + sizeof(snapshot_header), size - sizeof(snapshot_header));
}

int32_t dmb_sim_snapshot_size(const dmb_sim *sim, size_t *size)
{
    const int32_t status = dmb_sim_check(sim);
    if (status < 0) return dmb_sim_failed(sim, "snapshot", status);
    if (size == NULL) return dmb_sim_failed(sim, "snapshot", DMB_ERR_NULL);
    *size = snapshot_bytes(sim);
    return DMB_OK;
}

int32_t dmb_sim_snapshot(const dmb_sim *sim, void *block, size_t size)
{
    const int32_t status = dmb_sim_check(sim);
    dmb_field fields[DMB_FIELD_MAX];
    unsigned char *to = block;
    snapshot_header header;
    size_t count;
    if (status < 0) return dmb_sim_failed(sim, "snapshot", status);
    if (block == NULL) return dmb_sim_failed(sim, "snapshot", DMB_ERR_NULL);
    header = header_of(sim);
    if (size < header.size) return dmb_sim_failed(sim, "snapshot", DMB_ERR_VALUE);
    count = saved_fields(sim, fields);
    to += sizeof header;
    for (size_t i = 0; i < count; ++i) {
        memcpy(to, fields[i].data, fields[i].bytes);
        to += fields[i].bytes;
    }
    header.content = content_hash(block, (size_t)header.size);
    memcpy(block, &header, sizeof header);
    return DMB_OK;
}

/* The four parts: the snapshot, its field, value and bound, and a way out. */
static int32_t refuse_header(dmb_sim *sim, const char *field, uint64_t found, const char *bound, uint64_t wanted,
                             const char *advice)
{
    dmb_message_set(&sim->message, "snapshot: %s = %zu, must be %s%zu; %s", field, (size_t)found, bound, (size_t)wanted,
                    advice);
    return DMB_ERR_VALUE;
}

static int32_t check_snapshot(dmb_sim *sim, const void *block, size_t size)
{
    const snapshot_header wanted = header_of(sim);
    snapshot_header found;
    if (size < sizeof found)
        return refuse_header(sim, "size [byte]", size, ">= ", sizeof found, "hand over all of its bytes");
    memcpy(&found, block, sizeof found);
    if (found.magic != wanted.magic)
        return refuse_header(
            sim, "mark", found.magic, "", wanted.magic,
            "these bytes are no snapshot of this library, or one of another byte order; take one here");
    if (found.version != wanted.version)
        return refuse_header(sim, "version", found.version, "", wanted.version,
                             "restore it with the library that made it, or take another");
    if (found.scene != wanted.scene)
        return refuse_header(sim, "mark of the model", found.scene, "", wanted.scene,
                             "it was made of another compiled model; restore it in a sim of that");
    if (found.size != wanted.size)
        return refuse_header(sim, "its size [byte]", found.size, "", wanted.size,
                             "it was made of another compiled model or is damaged; take another");
    if (found.options != wanted.options)
        return refuse_header(sim, "mark of the options", found.options, "", wanted.options,
                             "make a sim with the options of the one that was saved");
    if (size < found.size)
        return refuse_header(sim, "size [byte]", size, ">= ", found.size, "it is cut short; hand over all");
    const uint64_t content = content_hash(block, (size_t)found.size);
    if (found.content != content)
        return refuse_header(sim, "checksum", found.content, "", content, "it is damaged; take another");
    return DMB_OK;
}

/* The fields of these groups, from `from` on; returns where they end. */
static const unsigned char *read_fields(const dmb_field *fields, size_t count, int32_t first, int32_t last,
                                        const unsigned char *from)
{
    for (size_t i = 0; i < count; ++i) {
        if (fields[i].group < first || fields[i].group > last) continue;
        memcpy(fields[i].data, from, fields[i].bytes);
        from += fields[i].bytes;
    }
    return from;
}

static int32_t restore(dmb_sim *sim, const unsigned char *block, size_t size)
{
    dmb_field fields[DMB_FIELD_MAX];
    const unsigned char *from = block;
    size_t count;
    int32_t status;
    if (block == NULL) return DMB_ERR_NULL;
    status = check_snapshot(sim, block, size);
    if (status < 0) return status;
    count = saved_fields(sim, fields);
    from += sizeof(snapshot_header);
    status = dmb_snapshot_check(sim, fields, count, from);
    if (status < 0) return status;
    dmb_state_back_up(sim);
    from = read_fields(fields, count, DMB_GROUP_NOW, DMB_GROUP_MEMORY, from);
    status = dmb_snapshot_relations(sim);
    if (status < 0) {
        dmb_state_restore(sim);
        return status;
    }
    (void)read_fields(fields, count, DMB_GROUP_FACTORS, DMB_GROUP_FACTORS, from);
    dmb_own_scene_update(sim);
    return DMB_OK;
}

int32_t dmb_sim_restore(dmb_sim *sim, const void *block, size_t size)
{
    const int32_t status = dmb_sim_enter(sim, DMB_BUSY_CHANGING);
    return status < 0 ? status : dmb_sim_leave(sim, restore(sim, block, size));
}

int32_t dmb_sim_hash(const dmb_sim *sim, uint64_t *hash)
{
    const int32_t status = dmb_sim_check(sim);
    dmb_field fields[DMB_FIELD_MAX];
    size_t count;
    uint64_t found = DMB_FNV_START;
    if (status < 0) return dmb_sim_failed(sim, "hash", status);
    if (hash == NULL) return dmb_sim_failed(sim, "hash", DMB_ERR_NULL);
    count = saved_fields(sim, fields);
    for (size_t i = 0; i < count; ++i) found = dmb_fnv_bytes(found, fields[i].data, fields[i].bytes);
    *hash = found;
    return DMB_OK;
}
