#include <stdlib.h>
#include <string.h>

#include "unit.h"

#define STATE_MAGIC "DMBSTATE"
enum { STATE_FORMAT = 1 };

typedef struct unit_state {
    uint64_t size; /* [byte] of data */
    unsigned char data[];
} unit_state;

/* The first bytes of the data. Then values, shape (inputs), is_set, shape (inputs), and the sim's snapshot, on
 * multiples of 8 bytes. */
typedef struct state_header {
    char magic[8];
    uint32_t format, mode; /* STATE_FORMAT, unit_mode */
    char token[SCENE_TOKEN];
    uint32_t inputs;   /* [-] */
    uint32_t checksum; /* of all, taken with 0 here */
    uint64_t snapshot; /* [byte] 0: no sim yet */
    double step;       /* [s] */
    uint32_t told[DMB_EVENTS_MAX];
} state_header;

static uint64_t sets_bytes(uint32_t inputs)
{
    return ((uint64_t)inputs * sizeof(uint32_t) + 7u) / 8u * 8u;
}

static uint64_t state_bytes(uint32_t inputs, uint64_t snapshot)
{
    return sizeof(state_header) + (uint64_t)inputs * sizeof(double) + sets_bytes(inputs) + snapshot;
}

static uint32_t checksum_of(const unsigned char *data, uint64_t size)
{
    state_header header;
    memcpy(&header, data, sizeof header);
    header.checksum = 0;
    return scene_checksum(&header, sizeof header) ^ scene_checksum(data + sizeof header, size - sizeof header);
}

static void fill_state(const unit *u, unit_state *state, size_t snapshot)
{
    state_header header;
    unsigned char *at = state->data + sizeof header;
    memset(&header, 0, sizeof header);
    memcpy(header.magic, STATE_MAGIC, sizeof header.magic);
    header.format = STATE_FORMAT;
    header.mode = (uint32_t)u->mode;
    memcpy(header.token, u->scene.token, strlen(u->scene.token));
    header.inputs = u->input_count;
    header.snapshot = snapshot;
    header.step = u->step;
    memcpy(header.told, u->told, sizeof header.told);
    memcpy(at, u->values, u->input_count * sizeof *u->values);
    memcpy(at + u->input_count * sizeof *u->values, u->is_set, u->input_count * sizeof *u->is_set);
    memcpy(state->data, &header, sizeof header);
}

unit_status unit_state_get(unit *u, void **state)
{
    if (!u || !state) return UNIT_ERROR;
    size_t snapshot = 0;
    if (u->sim && dmb_sim_snapshot_size(u->sim, &snapshot) < 0)
        return unit_tell(u, UNIT_ERROR, "state cannot be saved: %s", dmb_sim_message(u->sim));
    const uint64_t size = state_bytes(u->input_count, snapshot);
    unit_state *made = calloc(1, sizeof *made + (size_t)size);
    if (!made)
        return unit_tell(u, UNIT_ERROR, "state cannot be saved: no memory for %llu bytes", (unsigned long long)size);
    made->size = size;
    fill_state(u, made, snapshot);
    if (u->sim && dmb_sim_snapshot(u->sim, made->data + (size - snapshot), snapshot) < 0) {
        free(made);
        return unit_tell(u, UNIT_ERROR, "state cannot be saved: %s", dmb_sim_message(u->sim));
    }
    const uint32_t checksum = checksum_of(made->data, size);
    memcpy(made->data + offsetof(state_header, checksum), &checksum, sizeof checksum);
    free(*state);
    *state = made;
    return UNIT_OK;
}

static unit_status check(const unit *u, const void *data, uint64_t size)
{
    state_header header;
    if (size < sizeof header || memcmp(data, STATE_MAGIC, sizeof header.magic) != 0)
        return unit_tell(u, UNIT_ERROR,
                         "state refused: %llu bytes that do not begin with " STATE_MAGIC "; give what this unit "
                         "saved",
                         (unsigned long long)size);
    memcpy(&header, data, sizeof header);
    const int fits = header.format == STATE_FORMAT && header.mode < UNIT_MODES && header.inputs == u->input_count &&
                     header.snapshot <= size && state_bytes(header.inputs, header.snapshot) == size &&
                     header.step >= 0.0 && header.step <= 1e18;
    if (!fits || memcmp(header.token, u->scene.token, strlen(u->scene.token) + 1u) != 0)
        return unit_tell(u, UNIT_ERROR,
                         "state refused: it is that of another unit or version; give what this unit saved");
    if (checksum_of(data, size) != header.checksum)
        return unit_tell(u, UNIT_ERROR, "state refused: it is damaged, checksum %08x, must be %08x",
                         checksum_of(data, size), header.checksum);
    return UNIT_OK;
}

/* The snapshot goes into the sim, or the sim goes where there is none. */
static unit_status load_sim(unit *u, const unsigned char *snapshot, uint64_t size)
{
    if (size == 0) {
        dmb_sim_destroy(&u->sim);
        return UNIT_OK;
    }
    const int had_sim = u->sim != NULL;
    if (!had_sim && dmb_sim_create(u->scene.model, &u->scene.settings.sim, &u->sim) < 0)
        return unit_tell(u, UNIT_ERROR, "state refused: %s", dmb_model_message(u->scene.model));
    if (dmb_sim_restore(u->sim, snapshot, (size_t)size) >= 0) return UNIT_OK;
    unit_tell(u, UNIT_ERROR, "state refused: %s", dmb_sim_message(u->sim));
    if (!had_sim) dmb_sim_destroy(&u->sim);
    return UNIT_ERROR;
}

unit_status unit_state_set(unit *u, const void *from)
{
    const unit_state *state = from;
    state_header header;
    if (!u || !state || check(u, state->data, state->size) != UNIT_OK) return UNIT_ERROR;
    memcpy(&header, state->data, sizeof header);
    if (load_sim(u, state->data + (state->size - header.snapshot), header.snapshot) != UNIT_OK) return UNIT_ERROR;
    const unsigned char *at = state->data + sizeof header;
    memcpy(u->values, at, u->input_count * sizeof *u->values);
    memcpy(u->is_set, at + u->input_count * sizeof *u->values, u->input_count * sizeof *u->is_set);
    memcpy(u->told, header.told, sizeof u->told);
    u->step = header.step;
    u->mode = (unit_mode)header.mode;
    return UNIT_OK;
}

unit_status unit_state_free(const unit *u, void **state)
{
    if (!u) return UNIT_ERROR;
    if (state) {
        free(*state);
        *state = NULL;
    }
    return UNIT_OK;
}

unit_status unit_state_size(const unit *u, const void *state, size_t *size)
{
    if (!u || !state || !size) return UNIT_ERROR;
    *size = (size_t)((const unit_state *)state)->size;
    return UNIT_OK;
}

unit_status unit_state_write(const unit *u, const void *state, void *bytes, size_t size)
{
    const unit_state *from = state;
    if (!u || !from || !bytes) return UNIT_ERROR;
    if (size < from->size)
        return unit_tell(u, UNIT_ERROR, "state cannot be written: %zu bytes, must be >= %llu", size,
                         (unsigned long long)from->size);
    memcpy(bytes, from->data, (size_t)from->size);
    return UNIT_OK;
}

unit_status unit_state_read(const unit *u, const void *bytes, size_t size, void **state)
{
    if (!u || !bytes || !state || check(u, bytes, size) != UNIT_OK) return UNIT_ERROR;
    unit_state *made = malloc(sizeof *made + size);
    if (!made) return UNIT_ERROR;
    made->size = size;
    memcpy(made->data, bytes, size);
    *state = made;
    return UNIT_OK;
}
