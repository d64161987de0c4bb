#include "math/bridge.h"

#include "base/build.h"

#if DMB_LAZY
#include <dlfcn.h>
#include <string.h>

_Static_assert(sizeof(void *) == sizeof(dmb_foreign), "POSIX: dlsym tells functions as pointers to void");

/* With RTLD_NODELETE the library remains loaded after dlclose, so that the loader's reference count does not increase
 * with every call. */
int dmb_foreign_load(const char *soname, size_t count, const char *const *names, dmb_foreign *functions)
{
    void *library = dlopen(soname, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    size_t found = 0;
    for (; library != NULL && found < count; found++) {
        void *symbol = dlsym(library, names[found]);
        if (symbol == NULL) break;
        memcpy(functions + found, &symbol, sizeof symbol);
    }
    if (library != NULL) (void)dlclose(library);
    return library != NULL && found == count;
}

#else

int dmb_foreign_load(const char *soname, size_t count, const char *const *names, dmb_foreign *functions)
{
    (void)soname, (void)count, (void)names, (void)functions;
    return 0;
}
#endif
