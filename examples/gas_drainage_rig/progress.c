#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

enum { BAR = 30 };

double rig_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

rig_progress rig_progress_begin(const char *name, double end, int quiet)
{
    const double now = rig_clock();
    const rig_progress progress = {name, end, now, now, !quiet && isatty(STDERR_FILENO)};
    return progress;
}

/* Ten times a second is enough for the eye and costs nothing. */
void rig_progress_show(rig_progress *progress, double time)
{
    static const char full[] = "##############################", none[] = "..............................";
    if (!progress->visible) return;
    const double now = rig_clock();
    if (now - progress->shown < 0.1 && time < progress->end) return;
    progress->shown = now;
    const int done = (int)(BAR * time / progress->end + 0.5);
    fprintf(stderr, "\r%-21s [%.*s%.*s] %6.2f of %g s, %.2f x real time ", progress->name, done, full, BAR - done, none,
            time, progress->end, time / (now - progress->started + 1e-9));
    fflush(stderr);
}

void rig_progress_end(rig_progress *progress)
{
    if (progress->visible) fprintf(stderr, "\r%90s\r", "");
}
