#include "base/sized_struct.h"

#include <string.h>

#include "drillmbd/drillmbd.h"

/* Structs without struct_size: their layout is fixed, because programs built with older headers use it. */
_Static_assert(sizeof(dmb_id) == 8 && offsetof(dmb_id, generation) == 4, "dmb_id is frozen");
_Static_assert(sizeof(dmb_place) == 24 && offsetof(dmb_place, pipe) == 8 && offsetof(dmb_place, fraction) == 16,
               "dmb_place is frozen");
_Static_assert(sizeof(dmb_output) == 32 && offsetof(dmb_output, quantity) == 24, "dmb_output is frozen");
_Static_assert(sizeof(dmb_input_record) == 24 && offsetof(dmb_input_record, value) == 8 &&
                   offsetof(dmb_input_record, input) == 16 && offsetof(dmb_input_record, call) == 20,
               "dmb_input_record is frozen");

static const size_t header = sizeof(uint32_t); /* struct_size itself */

int32_t dmb_struct_check_size(uint32_t size, size_t known, size_t oldest)
{
    if (size < oldest || size % DMB_STRUCT_UNIT != 0 || size > known + DMB_STRUCT_MAX_EXTRA) return DMB_ERR_STRUCT_SIZE;
    return DMB_OK;
}

static uint32_t stored_size(const void *object)
{
    uint32_t size;
    memcpy(&size, object, sizeof size);
    return size;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

int32_t dmb_struct_init(void *out, uint32_t size, const void *defaults, size_t known, size_t oldest)
{
    size_t copied = smaller(size, known);
    unsigned char *bytes = out;
    if (out == NULL) return DMB_ERR_NULL;
    if (dmb_struct_check_size(size, known, oldest) < 0) return DMB_ERR_STRUCT_SIZE;
    memcpy(bytes, &size, header);
    memcpy(bytes + header, (const unsigned char *)defaults + header, copied - header);
    memset(bytes + copied, 0, size - copied);
    return DMB_OK;
}

int32_t dmb_struct_read(void *dst, size_t known, size_t oldest, const void *src)
{
    const unsigned char *bytes = src;
    uint32_t size;
    if (dst == NULL || src == NULL) return DMB_ERR_NULL;
    size = stored_size(src);
    if (dmb_struct_check_size(size, known, oldest) < 0) return DMB_ERR_STRUCT_SIZE;
    for (size_t i = known; i < size; ++i) {
        if (bytes[i] != 0) return DMB_ERR_STRUCT_SIZE; /* the caller uses a field that this library does not have */
    }
    memcpy((unsigned char *)dst + header, bytes + header, smaller(size, known) - header);
    return DMB_OK;
}

int32_t dmb_struct_write(void *dst, size_t known, size_t oldest, const void *src)
{
    uint32_t size;
    if (dst == NULL || src == NULL) return DMB_ERR_NULL;
    size = stored_size(dst);
    if (dmb_struct_check_size(size, known, oldest) < 0) return DMB_ERR_STRUCT_SIZE;
    memcpy((unsigned char *)dst + header, (const unsigned char *)src + header, smaller(size, known) - header);
    return DMB_OK;
}
