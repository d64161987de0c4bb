/* The fields of the structs that describe a scene, as constant tables: where each is, which values it may have. The
 * tables are made from the lists of fields/lists.h. The checks (model/field_check.h), the memory of refused parts
 * (model/refused.c) and the scene record (model/record) work on the tables, for all structs alike. */
#ifndef DMB_FIELDS_FIELDS_H
#define DMB_FIELDS_FIELDS_H

#include <stddef.h>
#include <stdint.h>

#include "base/sized_struct.h"
#include "drillmbd/scene.h"
#include "fields/lists.h"
#include "fields/options.h"

typedef enum dmb_field_type {
    DMB_TYPE_REAL,   /* double, or an array of them */
    DMB_TYPE_INT,    /* int32_t */
    DMB_TYPE_COUNT,  /* uint32_t */
    DMB_TYPE_TEXT,   /* characters that end with 0 */
    DMB_TYPE_ID,     /* dmb_id */
    DMB_TYPE_PLACE,  /* dmb_place */
    DMB_TYPE_OUTPUT, /* dmb_output */
    DMB_TYPE_REALS,  /* pointer to doubles */
    DMB_TYPE_POINTER /* any other pointer: a function of the caller, its context, a struct */
} dmb_field_type;

/* Values that a field may have, as lists.h names them. */
typedef enum dmb_field_bound {
    DMB_BOUND_ANY,     /* not checked by itself: the law or another field decides */
    DMB_BOUND_FINITE,  /* any number but infinity and NaN */
    DMB_BOUND_WITHIN,  /* low <= value <= high */
    DMB_BOUND_BETWEEN, /* low < value < high */
    DMB_BOUND_ABOVE,   /* low < value, finite */
    DMB_BOUND_ZERO_OR, /* 0 for "by default", or low <= value <= high */
    DMB_BOUND_NOT_GIVEN_OR,
    DMB_BOUND_BITS,   /* made of the bits of high */
    DMB_BOUND_SET,    /* set of components, DMB_FREE_... */
    DMB_BOUND_MOTION, /* the same, closed under motion */
    DMB_BOUND_TEXT,   /* UTF-8 that ends with 0, of a part: of its own */
    DMB_BOUND_PART,   /* id of a part of the kind low */
    DMB_BOUND_PART_OR_NONE,
    DMB_BOUND_PLACE, /* on a string, a body, a bit or a stabiliser */
    DMB_BOUND_GROUND_OR_PLACE,
    DMB_BOUND_POINTER /* not NULL */
} dmb_field_bound;

typedef struct dmb_def_field {
    const char *name;
    uint16_t number;       /* stable within its struct, from 1: the number in the scene record */
    uint16_t offset, size; /* [byte] of the member */
    uint16_t counted;      /* offset of the uint32_t that tells how many elements are in use; 0: all of them */
    uint8_t width;         /* numbers for each count */
    uint8_t type, bound;   /* dmb_field_type, dmb_field_bound */
    double low, high;
} dmb_def_field;

typedef struct dmb_field_list {
    const char *word;            /* the part in messages: "body" */
    const dmb_def_field *fields; /* in the order in which they are checked */
    const void *defaults;        /* a struct with them */
    uint32_t count;
    uint32_t number;       /* stable: the number of the struct in the scene record */
    uint32_t kind;         /* DMB_PART_..., 0: no part with an id of its own */
    uint32_t size, oldest; /* [byte] of the struct, and in its first release */
} dmb_field_list;

/* The list of a struct: DMB_FIELDS_OF(dmb_body_def). */
#define DMB_LIST_INDEX(number, T, word, kind, oldest, FIELDS) T##_index,
enum { DMB_DESCRIBED(DMB_LIST_INDEX) DMB_FIELD_LISTS };
#undef DMB_LIST_INDEX
extern const dmb_field_list dmb_field_lists[DMB_FIELD_LISTS];
#define DMB_FIELDS_OF(T) (&dmb_field_lists[T##_index])

/* The same of options: DMB_OPTIONS_OF(dmb_static_options). Each list is an object of its own, so that a program has
 * only those of the calls that it makes. */
#define DMB_OPTIONS_DECLARE(number, T, word, kind, oldest, FIELDS) extern const dmb_field_list T##_list;
DMB_OPTIONS(DMB_OPTIONS_DECLARE)
#undef DMB_OPTIONS_DECLARE
#define DMB_OPTIONS_OF(T) (&T##_list)

/* [byte] of one element of a field. */
size_t dmb_field_element_size(const dmb_def_field *field);
/* Elements of a field that are in use in a struct, at most those that there is room for; behind a pointer as many as
 * the count says. */
size_t dmb_field_elements(const dmb_def_field *field, const void *of);
/* The first of them; NULL where a pointer is NULL. */
const void *dmb_field_at(const dmb_def_field *field, const void *of);
/* Number i of them, of a field of numbers. */
double dmb_field_number(const dmb_def_field *field, const void *of, size_t i);
/* The field that holds the name of the part; NULL: none. */
const dmb_def_field *dmb_field_name(const dmb_field_list *list);

#endif
