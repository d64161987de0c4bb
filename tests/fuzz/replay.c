/* The stored inputs of a fuzz target, all files of the folders that are named: none crashes, and the target's own
 * checks hold. */
#define _GNU_SOURCE
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int replay(const char *path)
{
    static uint8_t data[1 << 16];
    FILE *file = fopen(path, "rb");
    if (file == NULL) return 0;
    const size_t size = fread(data, 1, sizeof data, file);
    (void)fclose(file);
    fprintf(stderr, "%s\n", path); /* the last one told is the one that failed */
    (void)LLVMFuzzerTestOneInput(data, size);
    return 1;
}

static int replay_folder(const char *folder)
{
    struct dirent **entries;
    const int count = scandir(folder, &entries, NULL, alphasort);
    int done = 0;
    for (int i = 0; i < count; i++) {
        char path[4096];
        if (entries[i]->d_name[0] != '.' && snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name) > 0)
            done += replay(path);
        free(entries[i]);
    }
    if (count >= 0) free(entries);
    return done;
}

int main(int argc, char **argv)
{
    int done = 0;
    for (int i = 1; i < argc; i++) done += replay_folder(argv[i]);
    printf("%d inputs\n", done);
    return done > 0 ? 0 : 1;
}
