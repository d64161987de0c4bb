/* Eight side by side: AVX-512, where the build compiles this file for it. */
#include "base/build.h"

#if DMB_WITH_LANES != 2 && defined(__GNUC__) && defined(__AVX512F__)
#define DMB_LANES 8
#define DMB_KERNELS dmb_kernels_8
#include "kernel/lanes.h"
#else
#include "kernel/kernels.h"

extern const dmb_kernels dmb_kernels_8;
const dmb_kernels dmb_kernels_8 = {.lanes = 0};
#endif
