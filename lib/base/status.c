#include "drillmbd/base.h"

const char *dmb_status_name(int32_t status)
{
    switch (status) {
#define DMB_STATUS_NAME_CASE(name, value, text) \
    case (value): return #name;
        DMB_STATUS_LIST(DMB_STATUS_NAME_CASE)
#undef DMB_STATUS_NAME_CASE
    default: return "DMB_UNKNOWN";
    }
}

const char *dmb_status_text(int32_t status)
{
    switch (status) {
#define DMB_STATUS_TEXT_CASE(name, value, text) \
    case (value): return text;
        DMB_STATUS_LIST(DMB_STATUS_TEXT_CASE)
#undef DMB_STATUS_TEXT_CASE
    default: return "not a status of this library";
    }
}

uint32_t dmb_version(void)
{
    return 10000u * DMB_VERSION_MAJOR + 100u * DMB_VERSION_MINOR + DMB_VERSION_PATCH;
}
