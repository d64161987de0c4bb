/* The choices of a build, with what holds where the build system says nothing: C alone, with files and heap. */
#ifndef DMB_BASE_BUILD_H
#define DMB_BASE_BUILD_H

#ifndef DMB_WITH_LAPACK /* dense eigenproblems by LAPACKE */
#define DMB_WITH_LAPACK 0
#endif
#ifndef DMB_WITH_CHOLMOD /* order of elimination by CHOLMOD */
#define DMB_WITH_CHOLMOD 0
#endif
#ifndef DMB_LAZY /* both loaded when they are needed */
#define DMB_LAZY 0
#endif
#ifndef DMB_WITH_LANES /* kernels of 2, 4 and 8 lanes beside those of one; the same bits */
#define DMB_WITH_LANES 1
#endif
#ifndef DMB_WITH_FILES /* recorders and VTK write files by stdio */
#define DMB_WITH_FILES 1
#endif
#ifndef DMB_WITH_HEAP /* malloc and free where the caller gives no allocator */
#define DMB_WITH_HEAP 1
#endif
#ifndef DMB_WITH_THREADS /* each thread has its own reason why a sim could not be created */
#define DMB_WITH_THREADS 1
#endif
#ifndef DMB_RED_ZONES /* [byte] behind each array of an arena, which the address sanitizer lets nobody touch */
#define DMB_RED_ZONES 0
#endif

#if defined(__GNUC__) /* a function whose frame is large and seldom needed: callers do not take it into theirs */
#define DMB_OWN_FRAME __attribute__((noinline))
#else
#define DMB_OWN_FRAME
#endif

#endif
