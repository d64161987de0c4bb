/* Stamps at the start of every opaque object. An object begins with a uint32_t that holds its stamp while it lives and
 * DMB_HANDLE_DEAD from its destruction on, so that a call on the wrong object is refused. */
#ifndef DMB_BASE_HANDLE_H
#define DMB_BASE_HANDLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define DMB_HANDLE_DEAD UINT32_C(0x0DEAD0BD)
#define DMB_HANDLE_MODEL UINT32_C(0x4D424D31)
#define DMB_HANDLE_SIM UINT32_C(0x4D425331)
#define DMB_HANDLE_RESPONSE UINT32_C(0x4D425231)
#define DMB_HANDLE_BUCKLING UINT32_C(0x4D424B31)
#define DMB_HANDLE_MODES UINT32_C(0x4D424D4F)
#define DMB_HANDLE_FATIGUE UINT32_C(0x4D424631)
#define DMB_HANDLE_WINDOW UINT32_C(0x4D425731)
#define DMB_HANDLE_SENSITIVITY UINT32_C(0x4D425345)
#define DMB_HANDLE_STATE_SPACE UINT32_C(0x4D425353)

/* True if object is not NULL and carries the stamp. */
static inline bool dmb_handle_is(const void *object, uint32_t stamp)
{
    uint32_t found;
    if (object == NULL) return false;
    memcpy(&found, object, sizeof found);
    return found == stamp;
}

#endif
