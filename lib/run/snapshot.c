/* Saving and restoring all that changes. A snapshot is a header and the fields of the accepted configuration, the
 * memory and the reused factors one after the other, without gaps. */
#include <string.h>

#include "run/fingerprint.h"
#include "run/snapshot_check.h"
#include "sim/access.h"
#include "sim/layout.h"
#include "sim/own_scene.h"

/* "DMDBSNP1" read as a number: a snapshot of another byte order does not fit. */
#define DMB_SNAPSHOT_MAGIC UINT64_C(0x31504E5342444D44)
enum { DMB_SNAPSHOT_VERSION = 7 };

typedef struct snapshot_header {
    uint64_t magic;
    uint64_t version;
    uint64_t size;  /* [byte] of the whole snapshot */
    uint64_t scene; /* fingerprints of what it fits */
    uint64_t options;
    uint64_t content; /* hash of what follows: a damaged snapshot is refused, a forged one by what it says */
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
    if (status < 0) return status;
    if (size == NULL) return DMB_ERR_NULL;
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
    if (status < 0) return status;
    if (block == NULL) return DMB_ERR_NULL;
    header = header_of(sim);
    if (size < header.size) return DMB_ERR_VALUE;
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
static int32_t refuse(dmb_sim *sim, const char *field, uint64_t found, const char *bound, uint64_t wanted,
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
    if (size < sizeof found) return refuse(sim, "size [byte]", size, ">= ", sizeof found, "hand over all of its bytes");
    memcpy(&found, block, sizeof found);
    if (found.magic != wanted.magic)
        return refuse(sim, "mark", found.magic, "", wanted.magic,
                      "these bytes are no snapshot of this library, or one of another byte order; take one here");
    if (found.version != wanted.version)
        return refuse(sim, "version", found.version, "", wanted.version,
                      "restore it with the library that made it, or take another");
    if (found.scene != wanted.scene)
        return refuse(sim, "mark of the model", found.scene, "", wanted.scene,
                      "it was made of another compiled model; restore it in a sim of that");
    if (found.size != wanted.size)
        return refuse(sim, "its size [byte]", found.size, "", wanted.size,
                      "it was made of another compiled model or is damaged; take another");
    if (found.options != wanted.options)
        return refuse(sim, "mark of the options", found.options, "", wanted.options,
                      "make a sim with the options of the one that was saved");
    if (size < found.size) return refuse(sim, "size [byte]", size, ">= ", found.size, "it is cut short; hand over all");
    const uint64_t content = content_hash(block, (size_t)found.size);
    if (found.content != content)
        return refuse(sim, "checksum", found.content, "", content, "it is damaged; take another");
    return DMB_OK;
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
    for (size_t i = 0; i < count; ++i) {
        memcpy(fields[i].data, from, fields[i].bytes);
        from += fields[i].bytes;
    }
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
    if (status < 0) return status;
    if (hash == NULL) return DMB_ERR_NULL;
    count = saved_fields(sim, fields);
    for (size_t i = 0; i < count; ++i) found = dmb_fnv_bytes(found, fields[i].data, fields[i].bytes);
    *hash = found;
    return DMB_OK;
}
