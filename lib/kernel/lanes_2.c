/* Two side by side: what every x86-64 (SSE2) and aarch64 (NEON) processor has. */
#if defined(__GNUC__)
#define DMB_LANES 2
#define DMB_KERNELS dmb_kernels_2
#include "kernel/lanes.h"
#else
#include "kernel/kernels.h"

extern const dmb_kernels dmb_kernels_2;
const dmb_kernels dmb_kernels_2 = {.lanes = 0};
#endif
