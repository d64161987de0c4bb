/* Refused parts. A caller who overlooks a refusal would compile another scene than the one described, so the model
 * stores each refusal until the part is added or the caller discards it. */
#include "model/model.h"

#include <stdbool.h>
#include <string.h>

#include "drillmbd/scene.h"

/* ---- The same part? ---------------------------------------------------------------------------------------------- */

static bool is_same_kind(const dmb_refusal *refusal, const dmb_described *given)
{
    return strcmp(refusal->part, given->part) == 0;
}

/* The list of the definition; NULL: there is one such part a model, or the definition could not be read. */
static const dmb_field_list *list_of(const dmb_described *given)
{
    for (size_t i = 0; i < DMB_FIELD_LISTS; ++i)
        if (strcmp(dmb_field_lists[i].word, given->part) == 0) return &dmb_field_lists[i];
    return NULL;
}

static bool differs(const dmb_def_field *field, const unsigned char *a, const unsigned char *b)
{
    return memcmp(a + field->offset, b + field->offset, field->size) != 0;
}

/* Fields with another value. A table and the number of its points are one field, that of the number. */
static uint32_t count_differences(const dmb_field_list *list, const unsigned char *a, const unsigned char *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < list->count; ++i) {
        const dmb_def_field *field = &list->fields[i];
        bool other = field->counted == 0 && differs(field, a, b);
        for (uint32_t k = 0; k < list->count && field->counted == 0; ++k)
            other |= list->fields[k].counted == field->offset && differs(&list->fields[k], a, b);
        count += other;
    }
    return count;
}

/* Two definitions of one kind: by their names, or field by field where one has none. */
static bool is_same_part(const dmb_refusal *refusal, const dmb_described *given)
{
    const unsigned char *a = refusal->definition, *b = given->definition;
    const dmb_field_list *list = list_of(given);
    const dmb_def_field *name = dmb_field_name(list);
    if (name != NULL && a[name->offset] != '\0' && b[name->offset] != '\0') return !differs(name, a, b);
    return count_differences(list, a, b) + (refusal->count != given->count) <= 1;
}

/* ---- Remembered and forgotten ------------------------------------------------------------------------------------ */

void dmb_refused_remember(dmb_refusals *refused, const dmb_described *given, int32_t status, const dmb_message *message)
{
    if (refused->kept == DMB_REFUSED_KEPT) {
        refused->further += refused->further < UINT32_MAX;
        return;
    }
    dmb_refusal *refusal = &refused->first[refused->kept++];
    refusal->part = given->part;
    refusal->status = status;
    refusal->count = given->count;
    refusal->message = *message;
    refusal->size = status == DMB_ERR_STRUCT_SIZE || given->size > DMB_REFUSED_BYTES ? 0 : given->size;
    if (refusal->size > 0) memcpy(refusal->definition, given->definition, refusal->size);
}

/* Removes all refusals of a kind that a model has once. */
static void forget_kind(dmb_refusals *refused, const dmb_described *given)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < refused->kept; ++i)
        if (!is_same_kind(&refused->first[i], given)) refused->first[kept++] = refused->first[i];
    refused->kept = kept;
}

void dmb_refused_added(dmb_refusals *refused, const dmb_described *given)
{
    if (given->size == 0) {
        forget_kind(refused, given);
        return;
    }
    for (uint32_t i = 0; i < refused->kept; ++i) {
        const dmb_refusal *refusal = &refused->first[i];
        if (!is_same_kind(refusal, given)) continue;
        if (refusal->size != 0 && !is_same_part(refusal, given)) continue;
        --refused->kept;
        memmove(&refused->first[i], &refused->first[i + 1], (refused->kept - i) * sizeof refused->first[0]);
        return;
    }
}

int32_t dmb_refused_check(const dmb_refusals *refused, dmb_message *message)
{
    const uint32_t count = refused->kept + refused->further;
    if (count == 0) return DMB_OK;
    if (refused->kept == 0) {
        dmb_message_set(message, "%u refused parts missing: add them, or dmb_model_clear_refused to do without", count);
        return DMB_ERR_ORDER;
    }
    dmb_message_set(message, "%u refused part%s missing (add %s, or dmb_model_clear_refused to do without): %s", count,
                    count == 1 ? "" : "s", count == 1 ? "it" : "them", refused->first[0].message.text);
    return refused->first[0].status;
}
