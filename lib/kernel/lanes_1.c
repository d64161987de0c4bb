/* One at a time, on any compiler. */
#define DMB_KERNELS dmb_kernels_1
#define DMB_KERNELS_NAME "1"
#include "kernel/lanes.h"
