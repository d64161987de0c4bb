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

#include "../share_out.h"
#include "folder.h"
#include "report.h"

enum { SHOWN = 4 }; /* variants that the pictures show */

/* Variants that are run side by side: each has options of its own, so that only one shows its progress. */
typedef struct runs {
    rig_options options[SHOWN];
    rig_result results[SHOWN];
    const rig_variant *variants;
    int32_t status[SHOWN];
} runs;

static void run_one(void *context, int number)
{
    runs *all = context;
    all->status[number] = rig_run(&all->options[number], &all->variants[number], &all->results[number]);
}

/* Runs the variants and reports them in their order. Returns how many came to their end before the first that did
 * not. */
static int run_all(runs *all, const rig_options *options, int count)
{
    int done = 0;
    for (int i = 0; i < count; ++i) {
        all->options[i] = *options;
        all->options[i].quiet = options->quiet || (options->threads > 1 && i > 0);
    }
    share_out(run_one, all, count, (int)options->threads);
    while (done < count && all->status[done] >= 0) rig_report_variant(options, &all->results[done++]);
    return done;
}

int main(int count, char **words)
{
    static const rig_variant shown[SHOWN] = {{DMB_PIPE_RIGID, RIG_VIBRATION},
                                             {DMB_PIPE_FLEXIBLE, RIG_CONTACT},
                                             {DMB_PIPE_FLEXIBLE, RIG_FRICTION},
                                             {DMB_PIPE_FLEXIBLE, RIG_VIBRATION}};
    const rig_options options = rig_options_read(count, words);
    const int wanted = options.all ? SHOWN : 1;
    runs all;
    all.variants = options.all ? shown : &options.variant;
    if (rig_make_folder(options.output) != 0) {
        perror(options.output);
        return EXIT_FAILURE;
    }
    rig_report_scene(&options);
    fflush(stdout);
    const int done = run_all(&all, &options, wanted);
    if (done > 0) rig_report_answers(&options, &all.results[done - 1]);
    const int written = rig_write_summary(&options, all.results, done);
    for (int i = 0; i < wanted; ++i) rig_result_close(&all.results[i]);
    return done == wanted && written == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
