#include "base/build.h"
#if DMB_WITH_FILES && (defined(__unix__) || defined(__APPLE__))
#define _XOPEN_SOURCE 700 /* realpath, stat, fchmod */
#include <sys/stat.h>

#define DMB_POSIX 1
#else
#define DMB_POSIX 0
#endif

#include "output/text_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "drillmbd/base.h"

/* ---- Open and close ---------------------------------------------------------------------------------------------- */

#if DMB_WITH_FILES
#if DMB_POSIX
enum {
    TRIES = 100
}; /* names tried for the temporary file: others may belong to runs that were killed or are in progress */

/* [byte] Part of a file name that the name of the temporary file contains: names are limited to 255. */
enum { NAME_MAX_BESIDE = 200 };

/* Position of the suffix of the temporary file's name. */
static size_t stem_of(const char *path, size_t length)
{
    const char *slash = strrchr(path, '/');
    const size_t folder = slash != NULL ? (size_t)(slash - path) + 1 : 0;
    return length - folder > NAME_MAX_BESIDE ? folder + NAME_MAX_BESIDE : length;
}

/* Opens a temporary file in the folder of the target. An existing file keeps its links and its mode. */
static int32_t open_beside(dmb_text_file *file, const char *path)
{
    char resolved[PATH_MAX];
    struct stat old;
    const int exists = realpath(path, resolved) != NULL && stat(resolved, &old) == 0;
    const char *target = exists ? resolved : path;
    const size_t length = strlen(target);
    file->beside = !exists || S_ISREG(old.st_mode);
    if (!file->beside) file->stream = fopen(path, "wb");
    if (!file->beside) return file->stream != NULL ? DMB_OK : DMB_ERR_IO;
    if (length == 0 || length >= DMB_PATH_MAX) return DMB_ERR_IO;
    memcpy(file->path, target, length + 1);
    const size_t stem = stem_of(target, length);
    memcpy(file->part, target, stem);
    for (uint32_t i = 0; i < TRIES && file->stream == NULL; i++) {
        memcpy(file->part + stem, ".part", 6);
        (void)dmb_number_from_u64(file->part + stem + 5, i);
        file->stream = fopen(file->part, "wbx"); /* never an existing file */
    }
    if (file->stream == NULL) return DMB_ERR_IO;
    if (exists && fchmod(fileno(file->stream), old.st_mode & 0xFFF) != 0) file->failed = 1;
    return DMB_OK;
}
#else
static int32_t open_beside(dmb_text_file *file, const char *path)
{
    file->stream = fopen(path, "wb");
    return file->stream != NULL ? DMB_OK : DMB_ERR_IO;
}
#endif

int32_t dmb_text_open(dmb_text_file *file, const char *path)
{
    memset(file, 0, sizeof *file);
    return open_beside(file, path);
}

int32_t dmb_text_close(dmb_text_file *file)
{
    int failed = file->failed | ferror(file->stream);
    if (fclose(file->stream) != 0) failed = 1; /* buffered data may reach a full disk only now */
    file->stream = NULL;
    if (file->beside && !failed && rename(file->part, file->path) != 0) failed = 1;
    if (file->beside && failed) (void)remove(file->part);
    return failed ? DMB_ERR_IO : DMB_OK;
}

static void put_bytes(dmb_text_file *file, const char *text, size_t length)
{
    if (fwrite(text, 1, length, file->stream) != length) file->failed = 1;
}

#else

int32_t dmb_text_open(dmb_text_file *file, const char *path)
{
    (void)path;
    memset(file, 0, sizeof *file);
    return DMB_ERR_UNSUPPORTED;
}

int32_t dmb_text_close(dmb_text_file *file)
{
    (void)file;
    return DMB_ERR_IO;
}

static void put_bytes(dmb_text_file *file, const char *text, size_t length)
{
    (void)text, (void)length;
    file->failed = 1;
}
#endif

/* ---- Text -------------------------------------------------------------------------------------------------------- */

void dmb_text_put(dmb_text_file *file, const char *text)
{
    put_bytes(file, text, strlen(text));
}

void dmb_text_put_number(dmb_text_file *file, double value)
{
    char text[DMB_NUMBER_SIZE];
    put_bytes(file, text, dmb_number_from_double(text, value, DMB_NUMBER_EXACT));
}

void dmb_text_put_count(dmb_text_file *file, uint64_t value)
{
    char text[DMB_NUMBER_SIZE];
    put_bytes(file, text, dmb_number_from_u64(text, value));
}

/* ---- Base 64 ----------------------------------------------------------------------------------------------------- */

/* Writes `count` of three bytes as four digits, '=' for missing ones */
static void put_group(dmb_text_file *file, uint32_t bytes, uint32_t count)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char text[4];
    for (uint32_t i = 0; i < 4; i++) text[i] = i <= count ? digits[bytes >> (18 - 6 * i) & 63] : '=';
    put_bytes(file, text, sizeof text);
    file->waiting = file->waiting_count = 0;
}

void dmb_text_begin_base64(dmb_text_file *file)
{
    file->waiting = file->waiting_count = 0;
    file->base64 = 1;
}

void dmb_text_put_word(dmb_text_file *file, uint64_t word)
{
    for (int i = 0; i < 8; i++) {
        file->waiting = file->waiting << 8 | (uint32_t)(word >> 8 * i & 0xff);
        if (++file->waiting_count == 3) put_group(file, file->waiting, 3);
    }
}

void dmb_text_end_base64(dmb_text_file *file)
{
    const uint32_t count = file->waiting_count;
    if (count > 0) put_group(file, file->waiting << 8 * (3 - count), count);
    file->base64 = 0;
}

/* ---- Failures ---------------------------------------------------------------------------------------------------- */

const char *dmb_file_message(dmb_message *why, const char *call, const char *path, int32_t status)
{
    enum { SHOWN = 200 }; /* [byte] of the end of a path: a message has room for them */
    if (status != DMB_ERR_IO || path == NULL) return why->text;
    const size_t length = strlen(path), from = length > SHOWN ? length - SHOWN : 0;
    dmb_message_set(why, "%s: file %s%s cannot be written; give a folder that is there, may be written to and has room",
                    call, from > 0 ? "..." : "", path + from);
    return why->text;
}
