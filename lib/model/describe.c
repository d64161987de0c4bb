#include "model/describe.h"

#include "model/field_check.h"

int32_t dmb_describe_check(dmb_model *model, const dmb_field_list *list, const void *def, dmb_relations_fn relations)
{
    const dmb_def_field *name = dmb_field_name(list);
    dmb_message part;
    dmb_check check = dmb_check_of(
        &model->message,
        dmb_part_text(&part, list->word, dmb_model_part_count(model, list->kind), dmb_field_at(name, def), name->size),
        DMB_NONE);
    dmb_check_fields(&check, model, list, def);
    if (check.status >= 0 && relations != NULL) relations(&check, model, def);
    return check.status;
}

static dmb_list *list_of(dmb_model *model, uint32_t kind)
{
    return (dmb_list *)(uintptr_t)dmb_model_list(model, kind); /* the model is the caller's to change */
}

int32_t dmb_describe_add(dmb_model *model, const dmb_field_list *list, const void *def, void *read,
                         dmb_relations_fn relations, dmb_id *id)
{
    int32_t status = dmb_describe_open(model, list->word, def);
    if (status < 0) return status;
    status = dmb_struct_read(read, list->size, list->oldest, def);
    if (status >= 0) status = dmb_describe_check(model, list, read, relations);
    if (status >= 0) status = dmb_describe_append(model, list_of(model, list->kind), read, list->size, list->kind, id);
    return dmb_describe_end(model, list->word, read, list->size, status);
}
