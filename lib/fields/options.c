#include "drillmbd/analyse.h"
#include "drillmbd/run.h"
#include "fields/table.h"

#define DMB_OPTIONS_LIST(number, T, word, kind, oldest, FIELDS) \
    const dmb_field_list T##_list = DMB_LIST_OF(number, T, word, kind, oldest);

DMB_OPTIONS(DMB_DEFAULTS)
DMB_OPTIONS(DMB_TABLE) /* NOLINT(bugprone-sizeof-expression): pointers are fields, too */
DMB_OPTIONS(DMB_OPTIONS_LIST)
