/* One variant from its description to its results. */
#ifndef RIG_RUN_H
#define RIG_RUN_H

#include "recording.h"

typedef struct rig_result {
    rig_variant variant;
    char name[40]; /* of its files: system-couple */
    dmb_model_info info;
    dmb_static_report start;
    dmb_statistics statistics;
    dmb_energy energy_at_start, energy;
    rig_recording recording;
    double weight;  /* [N] */
    double seconds; /* of the clock, stepping and recording */
} rig_result;

/* Runs a variant and leaves its table and ParaView files in the output folder. Says on standard error what went wrong.
 * The result is to be closed in any case. */
int32_t rig_run(rig_options *options, const rig_variant *variant, rig_result *result);
void rig_result_close(rig_result *result);

#endif
