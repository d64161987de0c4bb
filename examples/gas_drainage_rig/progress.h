/* A line on the terminal that tells how far a run has come. Silent where standard error is no terminal. */
#ifndef RIG_PROGRESS_H
#define RIG_PROGRESS_H

typedef struct rig_progress {
    const char *name;
    double end;     /* [s] of simulated time */
    double started; /* [s] of the clock */
    double shown;   /* [s] when the line was last written */
    int visible;
} rig_progress;

rig_progress rig_progress_begin(const char *name, double end, int quiet);
void rig_progress_show(rig_progress *progress, double time);
void rig_progress_end(rig_progress *progress);

/* [s] of a clock that only goes forward */
double rig_clock(void);

#endif
