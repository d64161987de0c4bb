/* Constraints that the caller's function defines. */
#include "model/defaults.h"
#include "model/describe.h"
#include "model/field_check.h"

enum { ROWS_MAX = DMB_CONSTRAINT_ROWS, PLACES_MAX = DMB_CONSTRAINT_NODES };

static void check_kind(dmb_check *check, const dmb_constraint_def *def)
{
    dmb_check_choice(check, "kind", def->kind, DMB_CONSTRAINT_HOLONOMIC, DMB_CONSTRAINT_NONHOLONOMIC);
    dmb_check_mask(check, "provides", def->provides, DMB_PROVIDES_JACOBIAN);
    if (def->kind == DMB_CONSTRAINT_NONHOLONOMIC && (def->provides & DMB_PROVIDES_JACOBIAN) == 0) {
        dmb_check_fail(check, DMB_ERR_VALUE, "provides", def->provides, "1 for a nonholonomic constraint");
    }
    dmb_check_pointer(check, "callback", def->callback != NULL ? def : NULL);
}

static int32_t check_constraint(dmb_model *model, const dmb_constraint_def *def)
{
    dmb_message part, field;
    dmb_check check = dmb_check_of(
        &model->message, dmb_part_text(&part, "constraint", model->constraints.count, def->name, sizeof def->name),
        DMB_NO_INDEX);
    dmb_check_name(&check, "name", def->name, sizeof def->name);
    dmb_check_count(&check, "rows", def->rows, 1, ROWS_MAX);
    dmb_check_count(&check, "count", def->count, 1, PLACES_MAX);
    for (uint32_t i = 0; i < def->count && check.status >= 0; ++i) {
        dmb_message_set(&field, "place[%u]", i);
        dmb_check_place(&check, model, field.text, &def->place[i]);
    }
    check_kind(&check, def);
    return check.status;
}

int32_t dmb_model_add_constraint(dmb_model *model, const dmb_constraint_def *def, dmb_id *constraint)
{
    dmb_constraint_def read = dmb_constraint_def_default();
    int32_t status = dmb_describe_open(model, "constraint", def);
    if (status < 0) return status;
    status = dmb_constraint_def_read(&read, def);
    if (status >= 0) status = check_constraint(model, &read);
    if (status >= 0) {
        status = dmb_describe_append(model, &model->constraints, &read, sizeof read, DMB_PART_CONSTRAINT, constraint);
    }
    return dmb_describe_end(model, "constraint", &read, sizeof read, status);
}
