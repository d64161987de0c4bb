/* Build options and their defaults if the build system sets none: the C library alone, with files and heap. */
#ifndef DMB_BASE_BUILD_H
#define DMB_BASE_BUILD_H

#ifndef DMB_WITH_LAPACK /* dense eigenproblems by LAPACKE */
#define DMB_WITH_LAPACK 0
#endif
#ifndef DMB_LAZY /* LAPACKE is loaded at run time when it is first needed */
#define DMB_LAZY 0
#endif
#ifndef DMB_WITH_LANES /* kernels with 2, 4 and 8 lanes in addition to the scalar kernels; results are bitwise equal. \
                          2: with 2 lanes alone, the width of a vector of WebAssembly */
#define DMB_WITH_LANES 1
#endif
#ifndef DMB_WITH_FILES /* recorders and VTK write files by stdio */
#define DMB_WITH_FILES 1
#endif
#ifndef DMB_WITH_HEAP /* malloc and free are the default allocator */
#define DMB_WITH_HEAP 1
#endif
#ifndef DMB_WITH_THREADS /* the reason why a simulation could not be created is stored for each thread */
#define DMB_WITH_THREADS 1
#endif
#ifndef DMB_RED_ZONES /* [byte] poisoned gap behind each array of an arena: the address sanitizer reports any access \
                         to it */
#define DMB_RED_ZONES 0
#endif

#if defined(__GNUC__) /* a function with a large, seldom used frame: it must not be inlined, because callers would \
                         inherit the frame */
#define DMB_OWN_FRAME __attribute__((noinline))
#else
#define DMB_OWN_FRAME
#endif

#endif
