/* The abilities of this build. */
#include "base/build.h"
#include "drillmbd/base.h"
#include "math/bridge.h"

int32_t dmb_has(int32_t what)
{
    switch (what) {
    case DMB_HAS_LAPACK: return dmb_has_lapack();
    case DMB_HAS_CHOLMOD: return dmb_has_cholmod();
    case DMB_HAS_FILES: return DMB_WITH_FILES;
    case DMB_HAS_HEAP: return DMB_WITH_HEAP;
    default: return DMB_ERR_VALUE;
    }
}

#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)

#if DMB_LAZY
#define LOADED ", loaded when needed"
#else
#define LOADED ", linked"
#endif
#if DMB_WITH_LAPACK
#define EIGENPROBLEMS "LAPACKE" LOADED
#else
#define EIGENPROBLEMS "own"
#endif
#if DMB_WITH_CHOLMOD
#define ORDER "CHOLMOD" LOADED
#else
#define ORDER "own"
#endif
#if DMB_WITH_FILES
#define FILES "yes"
#else
#define FILES "no"
#endif
#if DMB_WITH_HEAP
#define MEMORY "malloc"
#else
#define MEMORY "the caller's"
#endif

const char *dmb_build_info(void)
{
    return "libdrillmbd " TEXT(DMB_VERSION_MAJOR) "." TEXT(DMB_VERSION_MINOR) "." TEXT(
        DMB_VERSION_PATCH) "; eigenproblems: " EIGENPROBLEMS "; order of elimination: " ORDER "; files: " FILES
                           "; memory: " MEMORY;
}
