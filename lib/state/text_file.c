#include "state/text_file.h"

#include <string.h>

#include "base/number.h"
#include "drillmbd/base.h"

int32_t dmb_text_open(dmb_text_file *file, const char *path)
{
    file->failed = 0;
    file->stream = fopen(path, "wb");
    return file->stream != NULL ? DMB_OK : DMB_ERR_IO;
}

static void put_bytes(dmb_text_file *file, const char *text, size_t length)
{
    if (fwrite(text, 1, length, file->stream) != length) file->failed = 1;
}

void dmb_text_put(dmb_text_file *file, const char *text)
{
    put_bytes(file, text, strlen(text));
}

static void put_digits(dmb_text_file *file, double value, int digits)
{
    char text[DMB_NUMBER_SIZE];
    put_bytes(file, text, dmb_number_from_double(text, value, digits));
}

void dmb_text_put_number(dmb_text_file *file, double value)
{
    put_digits(file, value, DMB_NUMBER_EXACT);
}

void dmb_text_put_short(dmb_text_file *file, double value)
{
    put_digits(file, value, 6);
}

void dmb_text_put_count(dmb_text_file *file, uint64_t value)
{
    char text[DMB_NUMBER_SIZE];
    put_bytes(file, text, dmb_number_from_u64(text, value));
}

int32_t dmb_text_close(dmb_text_file *file)
{
    int failed = file->failed | ferror(file->stream);
    if (fclose(file->stream) != 0) failed = 1; /* what was buffered may only now meet a full disk */
    file->stream = NULL;
    return failed ? DMB_ERR_IO : DMB_OK;
}
