/* Structs of the public interface begin with uint32_t struct_size. A caller's struct may be shorter (compiled against
 * an older header) or longer (a newer header) than that of this library. Both work if neither side needs a field that
 * the other does not have. */
#ifndef DMB_BASE_SIZED_STRUCT_H
#define DMB_BASE_SIZED_STRUCT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "drillmbd/base.h"

/* Sizes of structs with pointers depend on the target. The first releases were for 64 bits, where sizes are multiples
 * of 8. On other targets the library and its callers are built together, and the first release is this one. */
#if UINTPTR_MAX > UINT32_MAX
enum { DMB_STRUCT_UNIT = 8 };
#define DMB_FIRST_SIZE(T, bytes) (bytes)
#else
enum { DMB_STRUCT_UNIT = 4 };
#define DMB_FIRST_SIZE(T, bytes) sizeof(T)
#endif

/* A struct_size that exceeds the library's size by more is treated as garbage. */
enum { DMB_STRUCT_MAX_EXTRA = 1024 };

/* Writes size bytes: struct_size, then defaults (known bytes long), then zeros. Errors: DMB_ERR_NULL, _STRUCT_SIZE. */
int32_t dmb_struct_init(void *out, uint32_t size, const void *defaults, size_t known, size_t oldest);

/* Reads a caller's struct into dst, prefilled with defaults and known bytes long. Fields that src does not have keep
 * their default; bytes of src beyond known must be zero. struct_size of dst is unchanged. Errors: DMB_ERR_NULL;
 * DMB_ERR_STRUCT_SIZE, with dst unchanged. */
int32_t dmb_struct_read(void *dst, size_t known, size_t oldest, const void *src);

/* Writes a result of known bytes into a caller's struct: at most its struct_size, which is unchanged, and at most known
 * bytes. Errors: DMB_ERR_NULL; DMB_ERR_STRUCT_SIZE, with dst unchanged. */
int32_t dmb_struct_write(void *dst, size_t known, size_t oldest, const void *src);

/* DMB_ERR_STRUCT_SIZE unless size is a multiple of DMB_STRUCT_UNIT from oldest to known + DMB_STRUCT_MAX_EXTRA. */
int32_t dmb_struct_check_size(uint32_t size, size_t known, size_t oldest);

/* Used once, in a source file, for every struct T of the public headers. Defines
 *     T_init                                 the exported sized initialiser
 *     int32_t T_read(T *out, const void *src)  defaults overlaid with the caller's struct; *out unchanged on error
 *     int32_t T_write(void *dst, const T *src) a result written into the caller's struct
 * oldest_size is sizeof(T) in the first release that had it, with pointers of 64 bits. Example:
 *     DMB_DEFINE_INIT(dmb_segment, 120, {.kind = DMB_SEGMENT_CONSTANT, .x1 = 1.0, .order = 1.0}) */
#define DMB_DEFINE_INIT(T, oldest_size, ...)                                                                         \
    static const T T##_defaults = __VA_ARGS__;                                                                       \
    _Static_assert(offsetof(T, struct_size) == 0, #T " does not begin with struct_size");                            \
    _Static_assert(sizeof(T) % DMB_STRUCT_UNIT == 0 && (oldest_size) % 8 == 0, #T " is not a multiple of its unit"); \
    _Static_assert(DMB_FIRST_SIZE(T, oldest_size) <= sizeof(T), #T " is shorter than in its first release");         \
    DMB_DECLARE_STRUCT(T)                                                                                            \
    int32_t T##_init(T *out, uint32_t size)                                                                          \
    {                                                                                                                \
        return dmb_struct_init(out, size, &T##_defaults, sizeof(T), DMB_FIRST_SIZE(T, oldest_size));                 \
    }                                                                                                                \
    int32_t T##_read(T *out, const void *src)                                                                        \
    {                                                                                                                \
        T filled = T##_defaults;                                                                                     \
        int32_t status = dmb_struct_read(&filled, sizeof(T), DMB_FIRST_SIZE(T, oldest_size), src);                   \
        if (status < 0) return status;                                                                               \
        filled.struct_size = (uint32_t)sizeof(T);                                                                    \
        *out = filled;                                                                                               \
        return DMB_OK;                                                                                               \
    }                                                                                                                \
    int32_t T##_write(void *dst, const T *src)                                                                       \
    {                                                                                                                \
        return dmb_struct_write(dst, sizeof(T), DMB_FIRST_SIZE(T, oldest_size), src);                                \
    }

/* Declares T_read and T_write, for use in a file other than the one with DMB_DEFINE_INIT. */
#define DMB_DECLARE_STRUCT(T)                  \
    int32_t T##_read(T *out, const void *src); \
    int32_t T##_write(void *dst, const T *src);

/* Stamps at the start of every opaque object. An object begins with a uint32_t that holds its stamp until it is
 * destroyed, and DMB_HANDLE_DEAD afterwards, so that a call on the wrong object fails. */

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
#define DMB_HANDLE_STATE_EQUATION UINT32_C(0x4D425351)

/* True if object is not NULL and carries the stamp. */
static inline bool dmb_handle_is(const void *object, uint32_t stamp)
{
    uint32_t found;
    if (object == NULL) return false;
    memcpy(&found, object, sizeof found);
    return found == stamp;
}

#endif
