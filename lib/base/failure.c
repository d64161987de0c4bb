#include "base/failure.h"

#include <math.h>
#include <string.h>

#include "base/build.h"
#include "base/sized_struct.h"

DMB_DEFINE_INIT(
    dmb_error, 1536,
    {.number = DMB_NONE, .component = DMB_NONE, .value = (double)NAN, .low = (double)NAN, .high = (double)NAN})

typedef struct failure {
    dmb_failed_object of;
    dmb_error error;
    uint64_t noted_text; /* hash of the message that `noted` belongs to; 0: none */
    dmb_refused_number noted;
} failure;

#if DMB_WITH_THREADS
static _Thread_local failure last_failure;
#else
static failure last_failure; /* one thread calls the library */
#endif

/* FNV-1a, never 0. */
static uint64_t hash_of(const char *text)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    for (; *text != '\0'; ++text) hash = (hash ^ (unsigned char)*text) * UINT64_C(1099511628211);
    return hash | 1;
}

void dmb_failure_note(const dmb_message *message, const dmb_refused_number *number)
{
    if (message == NULL) return;
    last_failure.noted_text = hash_of(message->text);
    last_failure.noted = *number;
}

/* ---- Parts of a message ------------------------------------------------------------------------------------------ */

/* Messages that refuse a value read "<part>: <field> = <value>, must be <bound>; <advice>", where a part is
 * "<kind> <number> (<name>)", alone or after that to which it belongs: "string 0 (main), pipe 12 (collars)". */

typedef struct piece {
    const char *begin, *end;
} piece;

static void copy(char *to, size_t size, piece from)
{
    const size_t length = (size_t)(from.end - from.begin), room = size - 1 < length ? size - 1 : length;
    memcpy(to, from.begin, room);
    to[room] = '\0';
}
#define COPY(field, piece) copy(field, sizeof(field), piece)

/* The last place of `what` in a text, or NULL. */
static const char *find_last(piece in, const char *what)
{
    const char *found = NULL;
    for (const char *at = strstr(in.begin, what); at != NULL && at < in.end; at = strstr(at + 1, what)) found = at;
    return found;
}

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Digits at the end of a text; *begin: where they begin. DMB_NONE: there are none, or too many. */
static uint32_t number_at_end(piece in, const char **begin)
{
    uint64_t number = 0, place = 1;
    const char *at = in.end;
    for (; at > in.begin && is_digit(at[-1]) && in.end - at < 9; --at, place *= 10)
        number += place * (uint64_t)(at[-1] - '0');
    *begin = at;
    return at == in.end || (at > in.begin && is_digit(at[-1])) ? DMB_NONE : (uint32_t)number;
}

static void read_part(dmb_error *error, piece part)
{
    const char *digits, *inner = find_last(part, "), ");
    COPY(error->part, part);
    if (inner != NULL) part.begin = inner + 3;
    inner = find_last(part, ", ");
    if (inner != NULL) part.begin = inner + 2;
    const char *open = strstr(part.begin, " (");
    if (open != NULL && open < part.end && part.end[-1] == ')') {
        const piece name = {open + 2, part.end - 1};
        COPY(error->name, name);
        part.end = open;
    }
    error->number = number_at_end(part, &digits);
    if (error->number != DMB_NONE) part.end = digits > part.begin && digits[-1] == ' ' ? digits - 1 : digits;
    COPY(error->kind, part);
}

/* "axis[2]" is component 2 of axis. */
static void read_field(dmb_error *error, piece field)
{
    if (field.end > field.begin && field.end[-1] == ']') {
        const char *digits;
        const piece number = {field.begin, field.end - 1};
        const uint32_t component = number_at_end(number, &digits);
        if (component != DMB_NONE && digits > field.begin && digits[-1] == '[') {
            error->component = component;
            field.end = digits - 1;
        }
    }
    COPY(error->field, field);
}

/* Any other message: "<part>: <what happened>; <advice>". */
static void read_sentence(dmb_error *error)
{
    const char *text = error->message, *end = text + strlen(text), *colon = strstr(text, ": ");
    const piece all = {text, end};
    const char *semicolon = find_last(all, "; ");
    if (colon != NULL) {
        const piece part = {text, colon};
        read_part(error, part);
    }
    if (semicolon == NULL) return;
    const piece advice = {semicolon + 2, end};
    COPY(error->advice, advice);
}

static void read_refusal(dmb_error *error)
{
    const char *text = error->message, *equals = strstr(text, " = "), *must = strstr(text, ", must ");
    if (equals == NULL || must == NULL || equals > must) {
        read_sentence(error);
        return;
    }
    const char *end = text + strlen(text), *semicolon = strstr(must, "; ");
    const piece head = {text, equals}, given = {equals + 3, must};
    const char *colon = find_last(head, ": ");
    const piece field = {colon == NULL ? text : colon + 2, equals};
    const piece bound = {must + 7, semicolon == NULL ? end : semicolon};
    read_field(error, field);
    COPY(error->given, given);
    COPY(error->bound, bound);
    if (semicolon != NULL) {
        const piece advice = {semicolon + 2, end};
        COPY(error->advice, advice);
    }
    if (colon == NULL) return;
    const piece parts = {text, colon};
    const char *before = find_last(parts, ": ");
    const piece part = {before == NULL ? text : before + 2, colon};
    read_part(error, part);
}

/* ---- Calls that fail --------------------------------------------------------------------------------------------- */

static void write_text(dmb_error *error, const char *call, const char *text)
{
    dmb_message message;
    if (text != NULL && text[0] != '\0')
        dmb_message_set(&message, "%s", text);
    else
        dmb_message_set(&message, "%s: %s", call, dmb_status_text(error->status));
    memcpy(error->message, message.text, sizeof message.text);
}

int32_t dmb_failure(const dmb_failed_object *of, const dmb_error_handler *handler, int32_t status, const char *call,
                    const char *text)
{
    failure *last = &last_failure;
    last->of = of == NULL ? (dmb_failed_object){NULL, 0} : *of;
    const dmb_refused_number none = {(double)NAN, (double)NAN, (double)NAN};
    last->error = dmb_error_defaults;
    last->error.struct_size = (uint32_t)sizeof last->error;
    last->error.status = status;
    write_text(&last->error, call, text);
    read_refusal(&last->error);
    const dmb_refused_number *number = last->noted_text == hash_of(last->error.message) ? &last->noted : &none;
    last->error.value = number->value;
    last->error.low = number->low;
    last->error.high = number->high;
    if (handler == NULL || handler->function == NULL) return status;
    const dmb_error seen = last->error; /* the function may make calls that fail */
    handler->function(handler->context, &seen);
    return status;
}

static int is_of(const dmb_failed_object *of)
{
    return last_failure.of.object == of->object && last_failure.of.serial == of->serial;
}

const char *dmb_failure_text(const dmb_failed_object *of)
{
    return is_of(of) ? last_failure.error.message : NULL;
}

void dmb_failure_forget(const dmb_failed_object *of)
{
    if (is_of(of)) last_failure.of.object = NULL;
}

int32_t dmb_last_error(dmb_error *error)
{
    dmb_error answer = last_failure.error;
    if (answer.struct_size == 0 && answer.status == DMB_OK) answer = dmb_error_defaults;
    return dmb_error_write(error, &answer);
}
