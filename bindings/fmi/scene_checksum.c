#include "scene_format.h"

/* CRC-32 of ISO 3309, bit by bit: x^32 + x^26 + ... + 1, reflected. */
uint32_t scene_checksum(const void *bytes, uint64_t size)
{
    const unsigned char *at = bytes;
    uint32_t rest = 0xFFFFFFFFu;
    for (uint64_t i = 0; i < size; ++i) {
        rest ^= at[i];
        for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ (0xEDB88320u & (0u - (rest & 1u)));
    }
    return ~rest;
}
