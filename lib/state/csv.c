/* The recorder's table as comma-separated values: one header line, '.' as decimal mark whatever the locale, and digits
 * enough to read every number back. */
#include <stddef.h>

#include "model/model.h"
#include "state/channel.h"
#include "state/recorder.h"
#include "state/text_file.h"

static void put_numbered(dmb_text_file *file, const char *kind, uint32_t number)
{
    dmb_text_put(file, " ");
    dmb_text_put(file, kind);
    dmb_text_put(file, " ");
    dmb_text_put_count(file, number);
}

/* "string 0 pipe 99 at 1", "body 2": no commas */
static void put_place(dmb_text_file *file, const dmb_place *place)
{
    static const char *const kinds[] = {"part", "programme", "wall", "string", "body", "bit", "drive", "load"};
    const uint32_t kind = place->part.index >> 24, number = place->part.index & 0xFFFFFFu;
    put_numbered(file, kind < sizeof kinds / sizeof kinds[0] ? kinds[kind] : kinds[0], number);
    if (kind != DMB_PART_STRING) return;
    put_numbered(file, "pipe", place->pipe);
    dmb_text_put(file, " at ");
    dmb_text_put_short(file, place->fraction);
}

static void put_header(dmb_text_file *file, const dmb_recorder *r)
{
    dmb_text_put(file, "time [s]");
    for (uint32_t i = 0; i < r->channel_count; ++i) {
        const dmb_channel *channel = &r->channels[i];
        const dmb_channel_name *name = dmb_channel_name_of(channel->quantity);
        dmb_text_put(file, ",");
        dmb_text_put(file, name != NULL ? name->name : "unknown");
        if (channel->quantity != DMB_CHANNEL_ENERGY_ERROR) put_place(file, &channel->place);
        dmb_text_put(file, " [");
        dmb_text_put(file, name != NULL ? name->unit : "-");
        dmb_text_put(file, "]");
    }
    dmb_text_put(file, "\n");
}

static void put_rows(dmb_text_file *file, const dmb_recorder *r)
{
    const double *value = r->table;
    for (uint64_t row = 0; row < r->rows; ++row) {
        for (uint32_t i = 0; i <= r->channel_count; ++i) {
            if (i > 0) dmb_text_put(file, ",");
            dmb_text_put_number(file, *value++);
        }
        dmb_text_put(file, "\n");
    }
}

int32_t dmb_recorder_write_csv(const dmb_recorder *recorder, const char *path)
{
    dmb_recorder r;
    dmb_text_file file;
    int32_t status = dmb_recorder_take_struct(&r, recorder);
    if (status < 0) return status;
    if (path == NULL) return DMB_ERR_NULL;
    status = dmb_text_open(&file, path);
    if (status < 0) return status;
    put_header(&file, &r);
    put_rows(&file, &r);
    return dmb_text_close(&file);
}
