/* Four side by side: AVX2, where the build compiles this file for it. */
#include "base/build.h"

#if DMB_WITH_LANES != 2 && defined(__GNUC__) && defined(__AVX2__)
#define DMB_LANES 4
#define DMB_KERNELS dmb_kernels_4
#include "kernel/lanes.h"
#else
#include "kernel/kernels.h"

extern const dmb_kernels dmb_kernels_4;
const dmb_kernels dmb_kernels_4 = {.lanes = 0};
#endif
