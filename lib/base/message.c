#include "base/message.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "base/number.h"
#include "drillmbd/base.h"

/* End of the text written so far. Text that does not fit is dropped. */
typedef struct writer {
    char *text;
    size_t used, size;
} writer;

static void put(writer *w, const char *text, size_t length)
{
    size_t room = w->size - 1 - w->used;
    if (length > room) length = room;
    memcpy(w->text + w->used, text, length);
    w->used += length;
    w->text[w->used] = '\0';
}

static void put_string(writer *w, const char *text)
{
    if (text == NULL) text = "?";
    put(w, text, strlen(text));
}

static void put_double(writer *w, double value)
{
    char number[DMB_NUMBER_SIZE];
    int digits = fabs(value) < 1e10 && !(fabs(value - floor(value)) > 0.0) ? 10 : 6;
    put(w, number, dmb_number_from_double(number, value, digits));
}

static void put_signed(writer *w, int value)
{
    char number[DMB_NUMBER_SIZE];
    put(w, number, dmb_number_from_i64(number, value));
}

static void put_unsigned(writer *w, uint64_t value)
{
    char number[DMB_NUMBER_SIZE];
    put(w, number, dmb_number_from_u64(number, value));
}

void dmb_message_set(dmb_message *message, const char *format, ...)
{
    writer w;
    va_list arguments;
    if (message == NULL) return;
    w.text = message->text;
    w.used = 0;
    w.size = sizeof message->text;
    w.text[0] = '\0';
    va_start(arguments, format);
    for (const char *c = format; *c != '\0'; ++c) {
        if (*c != '%') {
            put(&w, c, 1);
            continue;
        }
        ++c;
        if (*c == 's') {
            put_string(&w, va_arg(arguments, const char *));
        } else if (*c == 'd') {
            put_signed(&w, va_arg(arguments, int));
        } else if (*c == 'u') {
            put_unsigned(&w, va_arg(arguments, unsigned));
        } else if (*c == 'z' && c[1] == 'u') {
            ++c;
            put_unsigned(&w, va_arg(arguments, size_t));
        } else if (*c == 'l' && c[1] == 'l' && c[2] == 'u') {
            c += 2;
            put_unsigned(&w, va_arg(arguments, unsigned long long));
        } else if (*c == 'g') {
            put_double(&w, va_arg(arguments, double));
        } else if (*c == '%') {
            put(&w, "%", 1);
        } else {
            put_string(&w, "?"); /* no conversion of this formatter: the remaining arguments cannot be read safely */
            break;
        }
    }
    va_end(arguments);
}

void dmb_message_component(dmb_message *message, const char *part, uint32_t index, const dmb_field_value *is,
                           const char *bound)
{
    dmb_message name, place;
    if (index == DMB_NONE) {
        dmb_message_set(&name, "%s", part);
    } else {
        dmb_message_set(&name, "%s %u", part, index);
    }
    if (is->component == DMB_NONE) {
        dmb_message_set(&place, "%s", is->field);
    } else {
        dmb_message_set(&place, "%s[%u]", is->field, is->component);
    }
    dmb_message_set(message, "%s: %s = %g, must be %s", name.text, place.text, is->value, bound);
}

void dmb_message_field(dmb_message *message, const char *part, uint32_t index, const char *field, double value,
                       const char *bound)
{
    const dmb_field_value is = {field, DMB_NONE, value};
    dmb_message_component(message, part, index, &is, bound);
}

/* [byte] Length of the UTF-8 character at `text`, which has `left` bytes; 0 if the bytes are no character or a control
 * character. */
static size_t character(const unsigned char *text, size_t left)
{
    static const unsigned least[5] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned first = text[0];
    const size_t size = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
    unsigned code = size < 2 ? first : first & (0x7Fu >> size);
    if (size == 0 || size > left) return 0;
    for (size_t i = 1; i < size; ++i) {
        if (text[i] >> 6 != 2) return 0;
        code = code << 6 | (text[i] & 0x3Fu);
    }
    if (code < least[size] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return 0;
    return code < 0x20 || (code >= 0x7F && code <= 0x9F) ? 0 : size;
}

bool dmb_is_text(const char *text, size_t size)
{
    const unsigned char *bytes = (const unsigned char *)text;
    const void *end = memchr(text, '\0', size);
    const size_t length = end == NULL ? 0 : (size_t)((const char *)end - text);
    for (size_t at = 0, step; at < length; at += step) {
        step = character(bytes + at, length - at);
        if (step == 0) return false;
    }
    return end != NULL;
}

const char *dmb_part_text(dmb_message *text, const char *part, uint32_t index, const char *name, size_t size)
{
    if (size == 0 || name[0] == '\0' || !dmb_is_text(name, size)) {
        dmb_message_set(text, "%s %u", part, index);
    } else {
        dmb_message_set(text, "%s %u (%s)", part, index, name);
    }
    return text->text;
}

void dmb_message_clear(dmb_message *message)
{
    if (message != NULL) message->text[0] = '\0';
}

const char *dmb_status_name(int32_t status)
{
    switch (status) {
#define DMB_STATUS_NAME_CASE(name, value, text) \
    case (value): return #name;
        DMB_STATUS_LIST(DMB_STATUS_NAME_CASE)
#undef DMB_STATUS_NAME_CASE
    default: return "DMB_UNKNOWN";
    }
}

const char *dmb_status_text(int32_t status)
{
    switch (status) {
#define DMB_STATUS_TEXT_CASE(name, value, text) \
    case (value): return text;
        DMB_STATUS_LIST(DMB_STATUS_TEXT_CASE)
#undef DMB_STATUS_TEXT_CASE
    default: return "not a status of this library";
    }
}

uint32_t dmb_version(void)
{
    return 10000u * DMB_VERSION_MAJOR + 100u * DMB_VERSION_MINOR + DMB_VERSION_PATCH;
}
