/* What does the reference report in the frequency domain, and what does this library make of it?
 *
 * usage: reference_study [--output FOLDER] [--threads N], then plot.py FOLDER for the pictures
 *
 * 100 pipes of 1 m, 73 x 6 mm steel, in a hole of 94 mm, as gas_drainage_rig runs them in time. Prints
 *     the modes of the string: the first ten, the range, shapes, and those of a steel tube
 *     the response of pipe 100 to its drives, to friction, to eccentric masses and to all three, and the crossover
 *     how frequencies, forces and crossover depend on lengths, mesh, friction, clearance and stiffness
 *     what the reference says, claim by claim, and whether it is so here
 * and with a folder writes tables into it. Scenes are shared out to threads, which changes no digit. */
#include <stdlib.h>
#include <string.h>

#include "study.h"

static int failed(int32_t status, const char *what, const char *message)
{
    if (status >= 0) return 0;
    fprintf(stderr, "%s: %s: %s\n", what, dmb_status_name(status), message);
    return 1;
}

static int any_failed(const study_modal *modal, const study_shaken *shaken, const study_set sets[STUDY_SETS])
{
    int bad = failed(modal->status, "modes", modal->message) | failed(shaken->status, "response", shaken->message);
    for (int i = 0; i < STUDY_SETS; ++i)
        for (int k = 0; k < sets[i].count; ++k)
            bad |= failed(sets[i].point[k].status, "parameter study", sets[i].point[k].message);
    return bad;
}

int main(int count, char **words)
{
    static study_modal modal;
    static study_shaken shaken;
    static study_set sets[STUDY_SETS];
    study_job jobs[2 + STUDY_SETS * STUDY_VALUES];
    const char *folder = NULL;
    int threads = 2, asked = 0;
    for (int i = 1; i < count; i += 2) {
        const char *value = i + 1 < count ? words[i + 1] : NULL;
        if (value != NULL && strcmp(words[i], "--output") == 0)
            folder = value;
        else if (value != NULL && strcmp(words[i], "--threads") == 0 && atoi(value) > 0)
            threads = atoi(value);
        else
            return fprintf(stderr, "usage: reference_study [--output FOLDER] [--threads N]\n"), 2;
    }
    study_sets_describe(sets);
    jobs[asked++] = (study_job){study_modal_work, &modal};
    jobs[asked++] = (study_job){study_shaken_work, &shaken};
    for (int i = 0; i < STUDY_SETS; ++i)
        for (int k = 0; k < sets[i].count; ++k) jobs[asked++] = (study_job){study_point_work, sets[i].point + k};
    study_share_out(jobs, asked, threads);

    int bad = any_failed(&modal, &shaken, sets);
    if (!bad) {
        study_modal_print(&modal);
        study_shaken_print(&shaken);
        study_sets_print(sets);
        study_claims_print(&modal, &shaken, sets);
        if (folder != NULL)
            bad = study_modal_write(folder, &modal) | study_shaken_write(folder, &shaken) |
                  study_sets_write(folder, sets);
    }
    study_response_free(&shaken.response);
    return bad;
}
