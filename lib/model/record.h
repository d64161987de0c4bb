/* The scene record: the description of a model as bytes that are the same for all machines, without pointers and struct
 * layout. Numbers are little-endian: u32, u64, and f64 by its 64 bits of IEEE 754.
 *
 *     header   "DMBMODEL", u32 version, u32 flags, u64 length of all, u32 checksum (CRC-32 of all but itself), u32 0
 *     entry    u32 number, u32 count, u32 structs, then the structs
 *     struct   u32 fields; each: u32 number, u32 elements, the elements
 *
 * Numbers of entries and fields are those of fields/lists.h; count is that of dmb_model_add_pipes, else 1. An element
 * is f64, u32 (int32_t in two's complement), a byte of a text, an id (u32 kind << 24 | index, 0: none), a place (id,
 * u32 pipe, f64 fraction) or an output (place, u32 quantity). Two entries have no structs: NAME (count: id of a time
 * function) with DMB_NAME_SIZE bytes, and CONTINUES (count: string; structs: the string that continues it after a sub).
 * Parts stand in an order in which each comes after those it refers to, so that the public calls read them again. */
#ifndef DMB_MODEL_RECORD_H
#define DMB_MODEL_RECORD_H

#include <stddef.h>
#include <stdint.h>

enum {
    DMB_RECORD_VERSION = 1,
    DMB_RECORD_HEADER = 32,      /* [byte] */
    DMB_RECORD_CHECKSUM_AT = 24, /* [byte] */
    DMB_RECORD_NAME = 1000,      /* numbers of entries without structs */
    DMB_RECORD_CONTINUES = 1001,
    DMB_RECORD_PLACED_WITHOUT_HOLE = 1 /* flags */
};
extern const char dmb_record_magic[8];

/* CRC-32 of ISO 3309, x^32 + x^26 + ... + 1 reflected, over all but the checksum itself. */
uint32_t dmb_record_checksum(const unsigned char *bytes, size_t size);

#endif
