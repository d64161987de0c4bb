/* The report of a run: a table on standard output, and the same numbers for programs as JSON. */
#ifndef RIG_REPORT_H
#define RIG_REPORT_H

#include "run.h"

void rig_report_scene(const rig_options *options);
void rig_report_variant(const rig_options *options, const rig_result *result);
/* A few lines that answer for the rig: thrust, pull, torque, sag and the balance of energy of one variant. */
void rig_report_answers(const rig_options *options, const rig_result *result);

/* Writes summary.json into the output folder; plot.py reads it. 0, or -1 when it cannot be written. */
int rig_write_summary(const rig_options *options, const rig_result *results, int count);

/* From when to when means over the drilling stage are taken: the whole run where it ends before that stage. */
typedef struct rig_window {
    double from, to;
} rig_window;
rig_window rig_drilling(const rig_options *options);

#endif
