/* One long string on several cores: a step in parts by the program's own threads has the same bits as alone. */
#include <stdio.h>
#include <stdlib.h>

#include "../command_line.h"
#include "pool.h"

enum { PIPES = 2000, STEPS = 20 };

/* A string in its hole, turned at the rig. */
static int32_t describe(dmb_model *model)
{
    dmb_segment rise = dmb_segment_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    rise.kind = DMB_SEGMENT_STEP;
    rise.h1 = 6.0; /* rad/s */
    drive.component = DMB_RX;
    int32_t status = dmb_model_add_wall(model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(model, &pipe, PIPES, NULL);
    if (status >= 0) status = dmb_model_add_time_function(model, &rise, 1, &drive.time_function);
    if (status >= 0) status = dmb_model_add_drive(model, &drive, NULL);
    return status < 0 ? status : dmb_model_compile(model, NULL);
}

/* The hash of the state after some steps of 1 ms. */
static int32_t run(dmb_model *model, const dmb_sim_options *options, uint64_t *hash)
{
    dmb_sim *sim = NULL;
    int32_t status = dmb_sim_create(model, options, &sim);
    for (int i = 0; i < STEPS && status >= 0; i++) status = dmb_sim_step(sim, 1e-3, NULL);
    if (status >= 0) status = dmb_sim_hash(sim, hash);
    if (status < 0) fprintf(stderr, "%s: %s\n", dmb_status_text(status), sim ? dmb_sim_message(sim) : "");
    dmb_sim_destroy(&sim);
    return status;
}

int main(int count, char **words)
{
    static pool threads;
    uint32_t most = 2;
    uint64_t alone = 0, together = 0;
    const command_option options[] = {{.name = "threads",
                                       .value = "NUMBER",
                                       .help = "threads, that of the program among them; default 2",
                                       .low = 1,
                                       .high = POOL_MOST,
                                       .whole = &most}};
    const int stop = command_line(
        count, words,
        "One long string on several cores: a step in parts by the program's own threads has the same bits.", options,
        sizeof options / sizeof options[0]);
    if (stop >= 0) return stop;
    dmb_model *model = NULL;
    dmb_sim_options in_parts = dmb_sim_options_default();
    in_parts.parallel = pool_run;
    in_parts.parallel_context = &threads;
    in_parts.parallel_parts = pool_start(&threads, most);
    int32_t status = dmb_model_create(NULL, &model);
    if (status >= 0) status = describe(model);
    if (status >= 0) status = run(model, NULL, &alone);
    if (status >= 0) status = run(model, &in_parts, &together);
    pool_stop(&threads);
    dmb_model_destroy(&model);
    printf("%d pipes, %d steps: %s\n", PIPES, STEPS, alone == together ? "same bits" : "other bits");
    return status < 0 || alone != together;
}
