/* Checks of fields, beyond those of base/check.h: numbers and arrays between two bounds, zero standing for "by
 * default", names, ids and places. */
#ifndef DMB_MODEL_FIELD_CHECK_H
#define DMB_MODEL_FIELD_CHECK_H

#include "base/check.h"
#include "model/model.h"

/* Zero, or low <= value <= high. */
void dmb_check_zero_or_within(dmb_check *check, const char *field, double value, double low, double high);
/* low <= value <= high for each of count values; the message names the component. */
void dmb_check_each_within(dmb_check *check, const char *field, const double *values, size_t count, double low,
                           double high);
/* Zero, or low <= value <= high, likewise. */
void dmb_check_each_zero_or_within(dmb_check *check, const char *field, const double *values, size_t count, double low,
                                   double high);

/* The 0 at the end of a name in size bytes. */
void dmb_check_name(dmb_check *check, const char *field, const char *name, size_t size);

static inline bool dmb_id_is_none(dmb_id id)
{
    return id.index == 0 && id.generation == 0;
}
/* An id of that kind of this model: DMB_ERR_ID otherwise. `what` is the kind in words. */
void dmb_check_id(dmb_check *check, const dmb_model *model, const char *field, dmb_id id, uint32_t kind,
                  const char *what);
/* The same, or the id that names nothing. */
void dmb_check_id_or_none(dmb_check *check, const dmb_model *model, const char *field, dmb_id id, uint32_t kind,
                          const char *what);

/* A place on a string, a body or a bit: its fraction 0 .. 1, and 0 with pipe 0 on a body or bit. That the string has
 * such a pipe is for the compile step to find out. */
void dmb_check_place(dmb_check *check, const dmb_model *model, const char *field, const dmb_place *place);

#endif
