/* One at a time, on any compiler. */
#define DMB_KERNELS dmb_kernels_1
#include "kernel/lanes.h"
