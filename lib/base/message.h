/* Message of the last failing call: "pipe 3: outer_diameter = nan, must be finite and > inner_diameter". A message is a
 * fixed buffer, so that reporting an error never allocates. Text that does not fit is cut. */
#ifndef DMB_BASE_MESSAGE_H
#define DMB_BASE_MESSAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drillmbd/base.h"

typedef struct dmb_message {
    char text[512];
} dmb_message;

#if defined(__MINGW32__) && !defined(__clang__) /* printf of that system has no %zu; this formatter has */
#define DMB_PRINTF_LIKE __attribute__((format(gnu_printf, 2, 3)))
#elif defined(__GNUC__)
#define DMB_PRINTF_LIKE __attribute__((format(printf, 2, 3)))
#else
#define DMB_PRINTF_LIKE
#endif

/* Formats %s %d %u %zu %llu %g %%, without widths or flags, independent of the locale. %g writes whole numbers below
 * 1e10 in full and others with six digits. If message is NULL, the call does nothing. A NULL string is written as "?".
 */
void dmb_message_set(dmb_message *message, const char *format, ...) DMB_PRINTF_LIKE;

/* Writes "<part> <index>: <field> = <value>, must be <bound>". With index DMB_NONE the number is omitted: "wall:
 * diameter = ...". The same holds for components. */
void dmb_message_field(dmb_message *message, const char *part, uint32_t index, const char *field, double value,
                       const char *bound);

/* A value of the caller and its place. dmb_message_component writes it as dmb_message_field does, for one element of an
 * array: "<part> <index>: <field>[<component>] = <value>, must be <bound>". */
typedef struct dmb_field_value {
    const char *field;
    uint32_t component; /* index in an array; DMB_NONE: the field is no array */
    double value;
} dmb_field_value;

void dmb_message_component(dmb_message *message, const char *part, uint32_t index, const dmb_field_value *is,
                           const char *bound);

/* Name of a part in messages: "joint 3 (crank)", or "joint 3" if it has no name of its own. name: size bytes; bytes
 * that are no text count as no name. Returns text->text. */
const char *dmb_part_text(dmb_message *text, const char *part, uint32_t index, const char *name, size_t size);

/* True if the bytes before the first 0 are UTF-8 (RFC 3629: shortest form, no surrogates) without control characters;
 * false if there is no 0 in `size` bytes. */
bool dmb_is_text(const char *text, size_t size);

/* Empties the message. */
void dmb_message_clear(dmb_message *message);

/* The caller's log. Never used during a step. */

typedef struct dmb_log {
    dmb_log_fn write; /* NULL: silent */
    void *context;
} dmb_log;

static inline void dmb_log_text(const dmb_log *log, int32_t level, const char *text)
{
    if (log->write != NULL) log->write(log->context, level, text);
}

#endif
