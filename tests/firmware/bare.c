/* The scene of firmware without a system: the linker's size is what it takes of flash and memory. */
#include "scene.h"

volatile uint64_t found;

int main(void)
{
    uint64_t hash = 0;
    if (run(100, &hash) >= 0) found = hash;
    for (;;) continue;
}
