#include "fields/fields.h"

#include <math.h>
#include <string.h>

#include "fields/bounds.h"
#include "force/actuator_law.h"
#include "force/friction_law.h"
#include "force/mud_flow.h"
#include "math/quadrature.h"

/* ---- Defaults ---------------------------------------------------------------------------------------------------- */

#define DMB_FIELD_DEFAULT(T, number, name, unit, bound, ...) .name = __VA_ARGS__,
#define DMB_ARRAY_DEFAULT(T, number, name, counted, width, unit, bound, ...) .name = __VA_ARGS__,
#define DMB_DEFAULTS(number, T, word, kind, oldest, FIELDS) \
    DMB_DEFINE_INIT(T, oldest, {FIELDS(DMB_FIELD_DEFAULT, DMB_ARRAY_DEFAULT, T)})
DMB_DESCRIBED(DMB_DEFAULTS)

/* ---- Tables ------------------------------------------------------------------------------------------------------ */

/* An array is seen by the type of its elements; that of the caller's pointer is const double. */
#define DMB_TYPE_OF(member) \
    (_Generic((member),                  \
        double: DMB_TYPE_REAL,           \
        double *: DMB_TYPE_REAL,         \
        int32_t: DMB_TYPE_INT,           \
        int32_t *: DMB_TYPE_INT,         \
        uint32_t: DMB_TYPE_COUNT,        \
        char *: DMB_TYPE_TEXT,           \
        dmb_id: DMB_TYPE_ID,             \
        dmb_id *: DMB_TYPE_ID,           \
        dmb_place: DMB_TYPE_PLACE,       \
        dmb_place *: DMB_TYPE_PLACE,     \
        dmb_output: DMB_TYPE_OUTPUT,     \
        const double *: DMB_TYPE_REALS,  \
        default: DMB_TYPE_POINTER))
/* Bounds as lists.h names them: dmb_field_bound, low, high. */
#define DMB_MUST_ANY DMB_BOUND_ANY, 0.0, 0.0
#define DMB_MUST_FINITE DMB_BOUND_FINITE, 0.0, 0.0
#define DMB_MUST_WITHIN(low, high) DMB_BOUND_WITHIN, low, high
#define DMB_MUST_BETWEEN(low, high) DMB_BOUND_BETWEEN, low, high
#define DMB_MUST_ZERO_OR(low, high) DMB_BOUND_ZERO_OR, low, high
#define DMB_MUST_MINUS_ONE_OR(low, high) DMB_BOUND_MINUS_ONE_OR, low, high
#define DMB_MUST_BITS(mask) DMB_BOUND_BITS, 0.0, mask
#define DMB_MUST_SET DMB_BOUND_SET, 1.0, DMB_FREE_ALL | DMB_FREE_NONE
#define DMB_MUST_MOTION DMB_BOUND_MOTION, 1.0, DMB_FREE_ALL | DMB_FREE_NONE
#define DMB_MUST_TEXT DMB_BOUND_TEXT, 0.0, 0.0
#define DMB_MUST_PART(kind) DMB_BOUND_PART, kind, kind
#define DMB_MUST_PART_OR_NONE(kind) DMB_BOUND_PART_OR_NONE, kind, kind
#define DMB_MUST_PLACE DMB_BOUND_PLACE, 0.0, 0.0
#define DMB_MUST_GROUND_OR_PLACE DMB_BOUND_GROUND_OR_PLACE, 0.0, 0.0
#define DMB_MUST_POINTER DMB_BOUND_POINTER, 0.0, 0.0

#define DMB_ROW(T, number, name, counted, width, bound) \
    {#name, number, offsetof(T, name), sizeof(((T *)0)->name), counted, width, DMB_TYPE_OF(((T *)0)->name), bound},
#define DMB_FIELD_ROW(T, number, name, unit, bound, ...) DMB_ROW(T, number, name, 0, 1, DMB_MUST_##bound)
#define DMB_ARRAY_ROW(T, number, name, counted, width, unit, bound, ...) \
    DMB_ROW(T, number, name, offsetof(T, counted), width, DMB_MUST_##bound)
#define DMB_TABLE(number, T, word, kind, oldest, FIELDS) \
    static const dmb_def_field T##_fields[] = {FIELDS(DMB_FIELD_ROW, DMB_ARRAY_ROW, T)};
DMB_DESCRIBED(DMB_TABLE) /* NOLINT(bugprone-sizeof-expression): pointers are fields, too */

#define DMB_LIST(number, T, word, kind, oldest, FIELDS)                           \
    {word,   T##_fields, &T##_defaults, sizeof T##_fields / sizeof T##_fields[0], \
     number, kind,       sizeof(T),     DMB_FIRST_SIZE(T, oldest)},
const dmb_field_list dmb_field_lists[DMB_FIELD_LISTS] = {DMB_DESCRIBED(DMB_LIST)};

/* ---- Values ------------------------------------------------------------------------------------------------------ */

size_t dmb_field_element_size(const dmb_def_field *field)
{
    static const size_t sizes[] = {[DMB_TYPE_REAL] = sizeof(double),       [DMB_TYPE_INT] = sizeof(int32_t),
                                   [DMB_TYPE_COUNT] = sizeof(uint32_t),    [DMB_TYPE_TEXT] = 1,
                                   [DMB_TYPE_ID] = sizeof(dmb_id),         [DMB_TYPE_PLACE] = sizeof(dmb_place),
                                   [DMB_TYPE_OUTPUT] = sizeof(dmb_output), [DMB_TYPE_REALS] = sizeof(double),
                                   [DMB_TYPE_POINTER] = sizeof(void *)};
    return sizes[field->type];
}

size_t dmb_field_elements(const dmb_def_field *field, const void *of)
{
    const size_t room = field->size / dmb_field_element_size(field);
    uint32_t count;
    if (field->counted == 0) return room;
    memcpy(&count, (const char *)of + field->counted, sizeof count);
    const size_t used = (size_t)count * field->width;
    return field->type != DMB_TYPE_REALS && used > room ? room : used;
}

const void *dmb_field_at(const dmb_def_field *field, const void *of)
{
    const void *at = (const char *)of + field->offset;
    if (field->type == DMB_TYPE_REALS) memcpy(&at, at, sizeof at);
    return at;
}

double dmb_field_number(const dmb_def_field *field, const void *of, size_t i)
{
    const void *at = dmb_field_at(field, of);
    if (field->type == DMB_TYPE_INT) return ((const int32_t *)at)[i];
    if (field->type == DMB_TYPE_COUNT) return ((const uint32_t *)at)[i];
    return ((const double *)at)[i];
}

const dmb_def_field *dmb_field_name(const dmb_field_list *list)
{
    for (uint32_t i = 0; i < list->count; ++i)
        if (list->fields[i].type == DMB_TYPE_TEXT) return &list->fields[i];
    return NULL;
}
