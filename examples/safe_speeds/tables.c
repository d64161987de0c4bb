#include "tables.h"

FILE *open_table(const char *folder, const char *name, const char *head)
{
    char path[4096];
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (file != NULL) fprintf(file, "%s\n", head);
    return file;
}
