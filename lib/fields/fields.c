#include "fields/fields.h"

#include <math.h>
#include <string.h>

#include "drillmbd/analyse.h"
#include "drillmbd/run.h"
#include "fields/table.h"
#include "force/actuator_law.h"
#include "force/friction_law.h"
#include "force/mud_flow.h"
#include "math/quadrature.h"

/* ---- Tables ------------------------------------------------------------------------------------------------------ */

DMB_DESCRIBED(DMB_DEFAULTS)
DMB_DESCRIBED(DMB_TABLE) /* NOLINT(bugprone-sizeof-expression): pointers are fields, too */
const dmb_field_list dmb_field_lists[DMB_FIELD_LISTS] = {DMB_DESCRIBED(DMB_LIST)};

#define DMB_OPTIONS_LIST(number, T, word, kind, oldest, FIELDS) \
    const dmb_field_list T##_list = DMB_LIST_OF(number, T, word, kind, oldest);
DMB_OPTIONS(DMB_DEFAULTS)
DMB_OPTIONS(DMB_TABLE) /* NOLINT(bugprone-sizeof-expression): pointers are fields, too */
DMB_OPTIONS(DMB_OPTIONS_LIST)

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
