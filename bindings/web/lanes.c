/* Number of elements that the library computes at once: 2 by the instructions of 128 bits, else 1. */
#include "kernel/kernels.h"

__attribute__((export_name("web_lanes"))) uint32_t web_lanes(void)
{
    return dmb_kernels_widest()->lanes;
}
