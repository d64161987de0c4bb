/* malloc and its kin counted, in a program that includes this once: in an allocator for model and sim, and in functions
 * of its own put in the place of the C library's. A sanitizer does the same with its own, so there the second count is
 * left out; a checker that replaces malloc at run time is noticed. */
#ifndef DMB_TESTS_COUNTED_MALLOC_H
#define DMB_TESTS_COUNTED_MALLOC_H

#include <stdlib.h>

#include "sanitized.h"

#if defined(__GLIBC__) && !defined(SANITIZED)
#define COUNTS_MALLOC 1
#endif

/* ---- malloc and its kin ------------------------------------------------------------------------------------------ */

static volatile size_t malloc_calls;

#if defined(COUNTS_MALLOC)
/* The names of glibc's own functions. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *block, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void *block);
extern int posix_memalign(void **block, size_t alignment, size_t size);

void *malloc(size_t size)
{
    ++malloc_calls;
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    ++malloc_calls;
    return __libc_calloc(count, size);
}

void *realloc(void *block, size_t size)
{
    ++malloc_calls;
    return __libc_realloc(block, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    ++malloc_calls;
    return __libc_memalign(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size)
{
    ++malloc_calls;
    *block = __libc_memalign(alignment, size);
    return *block == NULL ? 12 : 0;
}

void free(void *block)
{
    if (block != NULL) ++malloc_calls;
    __libc_free(block);
}
#endif

/* True if the functions above are the ones that are called. */
static int malloc_is_counted(void)
{
    void *(*volatile allocate)(size_t) = malloc;
    void (*volatile release)(void *) = free;
    const size_t before = malloc_calls;
    void *block = allocate(10);
    release(block);
    return malloc_calls - before == 2;
}

/* ---- The given allocator ----------------------------------------------------------------------------------------- */

static size_t given_calls;

static void *take(void *context, size_t size, size_t alignment)
{
    (void)context;
    ++given_calls;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void give(void *context, void *block, size_t size, size_t alignment)
{
    (void)context, (void)size, (void)alignment;
    ++given_calls;
    free(block);
}

#endif
