/* The scene of firmware on a Cortex-M7 without a system: the linker's size is what it takes of flash and memory. It
 * runs on the board mps2-an500 of qemu, where its memory begins at 0, and tells there by semihosting the hash, the
 * pool, the stack that lost its paint, and the instructions of a step (qemu -icount shift=0: one each nanosecond). */
#include "scene.h"

#define CPACR (*(volatile uint32_t *)0xE000ED88u)    /* who may use the floating-point unit */
#define TICK ((volatile uint32_t *)0xE000E010u)      /* SysTick: control, reload, value; 25 MHz on this board */
#define STACK_LOW ((volatile uint32_t *)0x00300000u) /* the fourth megabyte of the first memory is the stack */
#define STACK_HIGH ((volatile uint32_t *)0x00400000u)
enum {
    SYS_WRITE0 = 0x04,
    SYS_EXIT = 0x18,
    PAINT = 0x5A5A5A5A,
    STEPS = 100,
    TIMED = 20 /* the tick wraps at 24 bits */
};

static void ask_host(uint32_t what, const void *argument)
{
    register uint32_t r0 __asm__("r0") = what;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

static void tell(const char *before, uint64_t value, uint32_t base, int digits)
{
    char text[24];
    int at = sizeof text - 1;
    text[at] = '\0';
    for (int i = 0; i < digits || value > 0; i++, value /= base) text[--at] = "0123456789abcdef"[value % base];
    ask_host(SYS_WRITE0, before);
    ask_host(SYS_WRITE0, text + at);
}

/* [-] instructions of a step, in the mean; 40 of them in a tick. */
static uint64_t instructions(void)
{
    TICK[1] = 0xFFFFFFu;
    TICK[2] = 0;
    TICK[0] = 5; /* on, by the processor's clock */
    const uint32_t before = TICK[2];
    for (int i = 0; i < TIMED; i++) (void)dmb_sim_step(sim, 1e-3, NULL);
    return (uint64_t)((before - TICK[2]) & 0xFFFFFFu) * 40u / TIMED;
}

__attribute__((noinline)) static void work(void) /* not before the unit is on */
{
    uint64_t hash = 0;
    const int32_t status = run(STEPS, &hash);
    const volatile uint32_t *lost = STACK_LOW;
    while (*lost == PAINT) lost++;
    if (status < 0) {
        ask_host(SYS_WRITE0, dmb_status_name(status));
        return;
    }
    tell("", hash, 16, 16);
    tell(", pool: ", dmb_pool_peak(&allocator), 10, 1);
    tell(" bytes, stack: ", (uint64_t)(STACK_HIGH - lost) * 4, 10, 1);
    tell(" bytes, instructions a step: ", instructions(), 10, 1);
    ask_host(SYS_WRITE0, "\n");
}

void begin(void);
void begin(void)
{
    CPACR |= 0xFu << 20;
    __asm__ volatile("dsb\n isb");
    for (volatile uint32_t *word = STACK_LOW; word < STACK_HIGH - 64; word++) *word = PAINT;
    work();
    ask_host(SYS_EXIT, (const void *)0x20026u);
    for (;;) continue;
}

extern void *const vectors[4];
__attribute__((section(".vectors"))) void *const vectors[4] = {(void *)0x00400000u, (void *)begin, (void *)begin,
                                                               (void *)begin};
