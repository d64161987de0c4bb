/* Macros that make tables and defaults of lists of fields (fields/lists.h, fields/options.h). */
#ifndef DMB_FIELDS_TABLE_H
#define DMB_FIELDS_TABLE_H

#include <math.h>

#include "base/sized_struct.h"
#include "fields/bounds.h"
#include "fields/fields.h"

#define DMB_FIELD_DEFAULT(T, number, name, unit, bound, ...) .name = __VA_ARGS__,
#define DMB_ARRAY_DEFAULT(T, number, name, counted, width, unit, bound, ...) .name = __VA_ARGS__,
#define DMB_DEFAULTS(number, T, word, kind, oldest, FIELDS) \
    DMB_DEFINE_INIT(T, oldest, {FIELDS(DMB_FIELD_DEFAULT, DMB_ARRAY_DEFAULT, T)})

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
#define DMB_MUST_ABOVE(low) DMB_BOUND_ABOVE, low, (double)INFINITY
#define DMB_MUST_BETWEEN(low, high) DMB_BOUND_BETWEEN, low, high
#define DMB_MUST_ZERO_OR(low, high) DMB_BOUND_ZERO_OR, low, high
#define DMB_MUST_NOT_GIVEN_OR(low, high) DMB_BOUND_NOT_GIVEN_OR, low, high
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

#define DMB_LIST_OF(number, T, word, kind, oldest)                                                          \
    {                                                                                                       \
        word, T##_fields, &T##_defaults, sizeof T##_fields / sizeof T##_fields[0], number, kind, sizeof(T), \
            DMB_FIRST_SIZE(T, oldest)                                                                       \
    }
#define DMB_LIST(number, T, word, kind, oldest, FIELDS) DMB_LIST_OF(number, T, word, kind, oldest),

#endif
