#define _POSIX_C_SOURCE 200809L
#include "folder.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#if defined(_WIN32) /* it has no permissions to give, and no executing of folders */
#include <direct.h>
#define make_folder(path) _mkdir(path)
#define MAY_WRITE_IN W_OK
#else
#define make_folder(path) mkdir(path, 0777)
#define MAY_WRITE_IN (W_OK | X_OK)
#endif

int rig_make_folder(const char *path)
{
    char part[4096];
    const size_t length = strlen(path);
    errno = length == 0 ? ENOENT : ENAMETOOLONG;
    if (length == 0 || length >= sizeof part) return -1;
    for (size_t i = 1; i <= length; ++i) {
        if (path[i] != '/' && path[i] != '\0') continue;
        memcpy(part, path, i);
        part[i] = '\0';
        if (make_folder(part) != 0 && errno != EEXIST) return -1;
    }
    struct stat found;
    if (stat(path, &found) != 0) return -1;
    if (!S_ISDIR(found.st_mode)) {
        errno = ENOTDIR;
        return -1;
    }
    return access(path, MAY_WRITE_IN);
}
