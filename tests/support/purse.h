/* An allocator that runs dry: it gives as many blocks as are left in a purse, and counts those that are out. */
#ifndef DMB_TESTS_PURSE_H
#define DMB_TESTS_PURSE_H

#include <drillmbd/drillmbd.h>

typedef struct purse {
    int left, held;
} purse;

dmb_allocator purse_allocator(purse *p);

#endif
