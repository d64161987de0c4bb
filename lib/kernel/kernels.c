/* Table of the kernels compiled into the build, and the choice of the widest one that the processor runs. All widths
 * return the same bits, so that the choice affects speed only. */
#include <stddef.h>

#include "base/build.h"
#include "kernel/kernels.h"

extern const dmb_kernels dmb_kernels_1;
#if DMB_WITH_LANES == 2
extern const dmb_kernels dmb_kernels_2;
#define KERNELS                        \
    {                                  \
        &dmb_kernels_1, &dmb_kernels_2 \
    }
#elif DMB_WITH_LANES
extern const dmb_kernels dmb_kernels_2, dmb_kernels_4, dmb_kernels_8;
#define KERNELS                                                        \
    {                                                                  \
        &dmb_kernels_1, &dmb_kernels_2, &dmb_kernels_4, &dmb_kernels_8 \
    }
#else
#define KERNELS        \
    {                  \
        &dmb_kernels_1 \
    }
#endif

/* 1 if the processor has what kernels of that width were compiled for. */
static int processor_has(uint32_t lanes)
{
    if (lanes <= 2) return 1;
#if defined(__GNUC__) && defined(__x86_64__)
    return lanes == 4 ? __builtin_cpu_supports("avx2") != 0 : __builtin_cpu_supports("avx512f") != 0;
#else
    return 0;
#endif
}

const dmb_kernels *dmb_kernels_of(uint32_t lanes)
{
    static const dmb_kernels *const all[] = KERNELS;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (all[i]->lanes == lanes && lanes > 0 && processor_has(lanes)) return all[i];
    return NULL;
}

const dmb_kernels *dmb_kernels_widest(void)
{
    for (uint32_t lanes = 8; lanes > 1; lanes /= 2)
        if (dmb_kernels_of(lanes)) return dmb_kernels_of(lanes);
    return dmb_kernels_of(1);
}
