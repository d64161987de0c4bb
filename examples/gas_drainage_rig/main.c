/* A gas drainage rig over one drilling cycle: how far do the pipes jump, what do friction and vibration add, what
 * torque and feed force does the head need, and what does it cost to know?
 *
 *     options.c    the command line                     run.c        static start, steps, files
 *     cycle.c      six stages: rotation, feed, load      recording.c  the samples that are kept
 *     scene.c      the rig as the library sees it        report.c, summary.c   what the reader gets
 *
 * Begin with scene.c and run.c: they are all that touches the library. */
#include <stdio.h>
#include <stdlib.h>

#include "folder.h"
#include "report.h"

/* Runs and reports the variants in turn. Returns how many came to their end. */
static int run_all(rig_options *options, const rig_variant *variants, int count, rig_result *results)
{
    for (int i = 0; i < count; ++i) {
        if (rig_run(options, &variants[i], &results[i]) < 0) {
            rig_result_close(&results[i]);
            return i;
        }
        rig_report_variant(options, &results[i]);
        fflush(stdout);
    }
    return count;
}

int main(int count, char **words)
{
    static const rig_variant shown[] = {{DMB_PIPE_RIGID, RIG_VIBRATION},
                                        {DMB_PIPE_FLEXIBLE, RIG_CONTACT},
                                        {DMB_PIPE_FLEXIBLE, RIG_FRICTION},
                                        {DMB_PIPE_FLEXIBLE, RIG_VIBRATION}};
    enum { SHOWN = sizeof shown / sizeof shown[0] };
    rig_result results[SHOWN];
    rig_options options = rig_options_read(count, words);
    const rig_variant *variants = options.all ? shown : &options.variant;
    const int wanted = options.all ? SHOWN : 1;
    if (rig_make_folder(options.output) != 0) {
        perror(options.output);
        return EXIT_FAILURE;
    }
    rig_report_scene(&options);
    const int done = run_all(&options, variants, wanted, results);
    const int written = rig_write_summary(&options, results, done);
    for (int i = 0; i < done; ++i) rig_result_close(&results[i]);
    return done == wanted && written == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
