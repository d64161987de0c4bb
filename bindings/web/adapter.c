/* A time function of JavaScript: the library calls a function of C, which calls the imported one with its number. */
#include "drillmbd.h"

__attribute__((import_module("drillmbd"), import_name("time_function"))) int32_t
web_time_function(uint32_t number, double time, double *out);

static int32_t time_function(void *context, double time, double out[3])
{
    return web_time_function((uint32_t)(uintptr_t)context, time, out);
}

/* The address for `callback` of a segment; `callback_context` is the number. */
__attribute__((export_name("web_time_function_address"))) dmb_time_fn web_time_function_address(void)
{
    return time_function;
}
