#include "options.h"

#include "../command_line.h"

enum { MOST_THREADS = 64 };

study_options study_options_read(int count, char **words)
{
    static const char about[] =
        "Makes what the reference reports: modes, frequency responses and how they depend on which parameter, and the "
        "drilling cycle in time; and says claim by claim what the reference says, what comes out here, and whether "
        "the two agree.";
    study_options options = {.step = 1e-3, .threads = 2};
    uint32_t threads = 2;
    const command_option table[] = {
        {.name = "output",
         .letter = 'o',
         .value = "FOLDER",
         .help = "folder for tables; plot.py FOLDER makes pictures of them",
         .text = &options.output},
        {.name = "threads",
         .value = "N",
         .help = "scenes at a time (2), which changes no digit",
         .low = 1.0,
         .high = MOST_THREADS,
         .whole = &threads},
        {.name = "step",
         .value = "S",
         .help = "time step of the drilling cycle (1e-3)",
         .low = 1e-5,
         .high = 1e-2,
         .number = &options.step},
        {.name = "short", .help = "only the claims, and without the drilling cycles in time", .given = &options.brief}};
    const int stop = command_line(count, words, about, table, sizeof table / sizeof *table);
    if (stop >= 0) exit(stop);
    options.threads = (int)threads;
    return options;
}
