/* libdrillmbd - names of parts. The definition of a part has a field `name`, or dmb_model_set_name gives it one;
 * messages state it beside the part's number, dmb_model_find looks it up. A name is text in UTF-8 without control
 * characters, at most 23 bytes and a 0, unique among the parts of its kind. "" is no name; any number of parts may
 * have none. */
#ifndef DRILLMBD_NAMES_H
#define DRILLMBD_NAMES_H

#include "model.h"

DMB_C_BEGIN

enum { DMB_NAME_SIZE = 24 }; /* [byte] of a name and its 0 */
/* clang-format off */
enum { /* kinds of parts, as in the upper 8 bits of an id's index */
    DMB_PART_ANY = 0, DMB_PART_TIME_FUNCTION = 1, DMB_PART_WALL = 2, DMB_PART_STRING = 3, DMB_PART_BODY = 4,
    DMB_PART_BIT = 5, DMB_PART_DRIVE = 6, DMB_PART_LOAD = 7, DMB_PART_JOINT = 8, DMB_PART_COUPLING = 9,
    DMB_PART_CONSTRAINT = 10, DMB_PART_SPRING = 11, DMB_PART_FORCE = 12, DMB_PART_STABILISER = 13, DMB_PART_STUCK = 14,
    DMB_PART_INPUT = 20, DMB_PART_EVENT = 21
};
/* clang-format on */
/* Gives a part another name, or none by ""; an input or an event needs one. Before dmb_model_compile. Errors:
 * DMB_ERR_ID, DMB_ERR_VALUE (too long, no UTF-8, another part of the kind has it), DMB_ERR_ORDER. */
DMB_API int32_t dmb_model_set_name(dmb_model *model, dmb_id part, const char *name);
/* The name of a part into the caller's text, size [byte] of it >= DMB_NAME_SIZE; "" if it has none. DMB_ERR_ID,
 * DMB_ERR_VALUE. */
DMB_API int32_t dmb_model_get_name(const dmb_model *model, dmb_id part, char *name, uint32_t size);
/* The part of that name, of a kind or (DMB_PART_ANY) of all. DMB_ERR_ID: there is none; DMB_ERR_VALUE: parts of several
 * kinds have it, give the kind. *part is left as it was then. */
DMB_API int32_t dmb_model_find(const dmb_model *model, int32_t kind, const char *name, dmb_id *part);
/* The pipes that one call of dmb_model_add_pipes added under that name (`name` of dmb_pipe_def): *count pipes of
 * *string from *first on. Each may be NULL. DMB_ERR_ID. */
DMB_API int32_t dmb_model_find_pipes(const dmb_model *model, const char *name, dmb_id *string, uint32_t *first,
                                     uint32_t *count);

DMB_C_END
#endif
