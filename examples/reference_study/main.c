/* What does the reference report, and what does this library make of it?
 *
 * The string of gas_drainage_rig, 100 pipes of 1 m, 73 x 6 mm steel, in a hole of 94 mm. Prints
 *     the modes of the string: the first ten, the range, shapes, and those of a steel tube     modes.c
 *     the response of pipe 100 to its drives, to friction, to eccentric masses and to all
 *     three, and the crossover                                                                response.c
 *     how frequencies, forces and responses depend on lengths, mesh, friction, clearance
 *     and stiffness                                                                         parameters.c
 *     what the drilling cycle of 40 s does in time, with rigid and with flexible pipes            cycles.c
 *     the study's sentences that can be tested, one row each with a verdict              claims.c, claims_*.c
 * and with a folder writes tables into it. Scenes are shared out to threads, which changes no digit. */
#include <stdlib.h>

#include "../gas_drainage_rig/folder.h"
#include "options.h"
#include "study.h"

enum { MOST_JOBS = STUDY_RUNS + 3 + STUDY_SETS * STUDY_VALUES };

static int failed(int32_t status, const char *what, const char *message)
{
    if (status >= 0) return 0;
    fprintf(stderr, "%s: %s: %s\n", what, dmb_status_name(status), message);
    return 1;
}

static int any_failed(const study_results *r)
{
    int bad = failed(r->counts.status, "count of parts", r->counts.message) |
              failed(r->modal.status, "modes", r->modal.message) |
              failed(r->shaken.status, "response", r->shaken.message);
    for (int i = 0; i < STUDY_SETS; ++i)
        for (int k = 0; k < r->sets[i].count; ++k)
            bad |= failed(r->sets[i].point[k].status, "parameter study", r->sets[i].point[k].message);
    for (int i = 0; i < STUDY_RUNS; ++i) bad |= r->runs[i].status < 0; /* it has said so itself */
    return bad;
}

/* Long ones first, so that no thread is left with one at the end. */
static void work(study_results *r, int threads)
{
    study_job jobs[MOST_JOBS];
    int count = 0;
    for (int i = STUDY_RUNS - 1; i >= 0 && r->timed; --i) jobs[count++] = (study_job){study_run_work, r->runs + i};
    jobs[count++] = (study_job){study_counts_work, &r->counts};
    jobs[count++] = (study_job){study_modal_work, &r->modal};
    jobs[count++] = (study_job){study_shaken_work, &r->shaken};
    for (int i = 0; i < STUDY_SETS; ++i)
        for (int k = 0; k < r->sets[i].count; ++k) jobs[count++] = (study_job){study_point_work, r->sets[i].point + k};
    study_share_out(jobs, count, threads);
}

static void print(const study_results *r)
{
    study_modal_print(&r->modal);
    study_shaken_print(&r->shaken);
    study_sets_print(r->sets);
    study_runs_print(r->runs);
}

static int write_tables(const char *folder, const study_results *r)
{
    return study_modal_write(folder, &r->modal) | study_shaken_write(folder, &r->shaken) |
           study_sets_write(folder, r->sets) | (r->timed && study_runs_write(folder, r->runs));
}

int main(int count, char **words)
{
    static study_results results;
    const study_options options = study_options_read(count, words);
    if (options.output != NULL && rig_make_folder(options.output) != 0) return perror(options.output), EXIT_FAILURE;
    results.timed = !options.brief;
    study_sets_describe(results.sets);
    study_runs_describe(results.runs, options.step);
    work(&results, options.threads);

    int bad = any_failed(&results);
    if (!bad) {
        if (!options.brief) print(&results);
        study_claims_print(&results);
        if (options.output != NULL) bad = write_tables(options.output, &results);
    }
    study_response_free(&results.shaken.response);
    study_response_free(&results.shaken.aligned);
    return bad ? EXIT_FAILURE : EXIT_SUCCESS;
}
