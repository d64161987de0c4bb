/* The calls that add parts to a model share: reading and writing of the structs of drillmbd/scene.h, whose T_init stand
 * in fields/fields.c, checks, and the release of what the model has copied. */
#ifndef DMB_MODEL_DESCRIBE_H
#define DMB_MODEL_DESCRIBE_H

#include "base/sized_struct.h"
#include "drillmbd/scene.h"
#include "model/model.h"

DMB_DECLARE_STRUCT(dmb_model_options)
DMB_DECLARE_STRUCT(dmb_model_info)
#define DMB_DECLARE_DESCRIBED(number, T, word, kind, oldest, FIELDS) DMB_DECLARE_STRUCT(T)
DMB_DESCRIBED(DMB_DECLARE_DESCRIBED)
#undef DMB_DECLARE_DESCRIBED

/* Relations between the fields of a definition, each of which is within its own bounds. */
typedef void (*dmb_relations_fn)(dmb_check *check, dmb_model *model, const void *def);
/* A whole call that adds a part of a kind whose definition is all that the model keeps: reads the caller's struct into
 * `read`, which has the defaults, checks its fields, then `relations` (NULL: none), and appends it. */
int32_t dmb_describe_add(dmb_model *model, const dmb_field_list *list, const void *def, void *read,
                         dmb_relations_fn relations, dmb_id *id);
/* The checks of it, for kinds that the model keeps in another form. */
int32_t dmb_describe_check(dmb_model *model, const dmb_field_list *list, const void *def, dmb_relations_fn relations);

/* Frees a time function's copy of segments and tables. */
void dmb_time_function_release(dmb_time_function *time_function, const dmb_allocator *allocator);
/* Adds a time function of a constant value behind all others. */
int32_t dmb_model_append_constant(dmb_model *model, double value, uint32_t *index);
/* Removes time functions until there are `count`. */
void dmb_model_drop_time_functions(dmb_model *model, uint32_t count);

/* Frees a spring's table. */
void dmb_spring_release(dmb_spring_plan *spring, const dmb_allocator *allocator);

/* Frees the wall's copy of the survey. */
void dmb_wall_release(dmb_wall_def *wall, const dmb_allocator *allocator);

/* Inputs as described. */

/* Bounds in force: the narrower of the input's own and those of its target. */
double dmb_input_low(const dmb_input_def *def);
double dmb_input_high(const dmb_input_def *def);
/* Unit of its target. */
const char *dmb_input_unit(const dmb_model *model, const dmb_input_def *def);
/* 1: it stands in the place of a time function, and may be on its way. */
int dmb_input_is_time_function(int32_t target);

#endif
