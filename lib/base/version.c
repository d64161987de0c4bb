#include "drillmbd/base.h"

uint32_t dmb_version(void)
{
    return 10000u * DMB_VERSION_MAJOR + 100u * DMB_VERSION_MINOR + DMB_VERSION_PATCH;
}
