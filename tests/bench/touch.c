/* Convergence of scene B once it touches the wall. usage: touch [at | laws | moved]
 *
 * One element a pipe, Newton to 1e-10, fixed steps; place of the tip over the clearance, against steps of 3.9 us.
 *   at      B at a few instants: before, at and after the first touch
 *   laws    B at 0.1 s with other laws of the wall: what of it keeps the order down
 *   moved   how far the tip is at 0.1 s by a start that is moved sideways, over that */
#include <stdio.h>

#include "method.h"

#define TOUCH_CLEARANCE 0.0105 /* [m] */
#define TOUCH_FINEST 3.90625e-6

enum { TOUCH_PIPES = 100, TOUCH_STEPS = 8, TOUCH_INSTANTS = 5, TOUCH_LAWS = 6 };

static const double instants[TOUCH_INSTANTS] = {0.020, 0.046, 0.047, 0.055, 0.1};
static int failures;

typedef struct places {
    double tip[TOUCH_INSTANTS][3]; /* [m] */
    dmb_statistics statistics;
} places;

static int32_t walk(const scene *s, dmb_sim *sim, const method *how, places *to)
{
    int32_t status = DMB_OK;
    for (int i = 0; i < TOUCH_INSTANTS && status >= 0; ++i) {
        dmb_pose pose = dmb_pose_default();
        status = go_to(sim, how, instants[i]);
        if (status >= 0) status = dmb_query_pose(sim, dmb_station(s->string, s->pipes - 1, 1.0), &pose);
        memcpy(to->tip[i], pose.position, sizeof to->tip[i]);
    }
    to->statistics = dmb_statistics_default();
    return status < 0 ? status : dmb_query_statistics(sim, &to->statistics);
}

static places run(scene s, double step)
{
    const method how = method_fixed(step, 0.0);
    dmb_sim_options options = options_of(&how);
    dmb_sim *sim = NULL;
    places to;
    memset(&to, 0, sizeof to);
    s.kind = SCENE_B;
    s.pipes = TOUCH_PIPES;
    s.per_pipe = 1;
    s.length = 1.0;
    options.newton_tolerance = 1e-10;
    int32_t status = scene_open(&s);
    if (status >= 0) status = dmb_sim_create(s.model, &options, &sim);
    if (status >= 0) status = walk(&s, sim, &how, &to);
    if (status < 0) fprintf(stderr, "touch: %s\n", sim ? dmb_sim_message(sim) : dmb_status_text(status));
    failures += status < 0;
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&s.model);
    return to;
}

static double step_of(int k)
{
    return 1e-3 * pow(0.5, k);
}

static double apart(const places *a, const places *b, int instant)
{
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += pow(a->tip[instant][i] - b->tip[instant][i], 2.0);
    return sqrt(sum);
}

static void print_head(const char *what)
{
    printf("| %s |", what);
    for (int k = 0; k < TOUCH_STEPS; ++k) printf(" %.4g ms |", 1e3 * step_of(k));
    printf("\n|---|");
    for (int k = 0; k < TOUCH_STEPS; ++k) printf("---|");
    printf("\n");
}

static void print_at(void)
{
    const scene plain = {.kind = SCENE_B};
    const places finest = run(plain, TOUCH_FINEST);
    places all[TOUCH_STEPS];
    for (int k = 0; k < TOUCH_STEPS; ++k) all[k] = run(plain, step_of(k));
    print_head("at ms");
    for (int i = 0; i < TOUCH_INSTANTS; ++i) {
        printf("| %g |", 1e3 * instants[i]);
        for (int k = 0; k < TOUCH_STEPS; ++k) printf(" %.1e |", apart(&all[k], &finest, i) / TOUCH_CLEARANCE);
        printf("\n");
    }
}

static void print_laws(void)
{
    static const scene laws[TOUCH_LAWS] = {
        {.friction = 0.0},
        {.friction = -0.3},
        {.damping = -1e3},
        {.friction = -0.3, .damping = -1e3},
        {.normal_law = DMB_NORMAL_HUNT_CROSSLEY},
        {.normal_law = DMB_NORMAL_EXACT},
    };
    static const char *const names[TOUCH_LAWS] = {"B",       "no friction",        "no damping",
                                                  "neither", "Hunt-Crossley, 0.4", "exact restitution, 0.4"};
    print_head("wall");
    for (int n = 0; n < TOUCH_LAWS; ++n) {
        const places finest = run(laws[n], TOUCH_FINEST);
        printf("| %s |", names[n]);
        for (int k = 0; k < TOUCH_STEPS; ++k) {
            const places at = run(laws[n], step_of(k));
            printf(" %.1e |", apart(&at, &finest, TOUCH_INSTANTS - 1) / TOUCH_CLEARANCE);
        }
        printf("\n");
        fflush(stdout);
    }
}

static void print_moved(void)
{
    const scene plain = {.kind = SCENE_B};
    const places still = run(plain, step_of(2));
    printf("| start moved by m | tip at 0.1 s over that |\n|---|---|\n");
    for (int power = 9; power >= 6; --power) {
        const scene moved = {.offset = pow(10.0, -power)};
        const places to = run(moved, step_of(2));
        printf("| 1e-%d | %.3g |\n", power, apart(&to, &still, TOUCH_INSTANTS - 1) / moved.offset);
    }
}

int main(int count, char **words)
{
    const char *what = count > 1 ? words[1] : "at";
    if (strcmp(what, "at") == 0)
        print_at();
    else if (strcmp(what, "laws") == 0)
        print_laws();
    else if (strcmp(what, "moved") == 0)
        print_moved();
    else
        return fputs("usage: touch [at | laws | moved]\n", stderr), 2;
    return failures > 0;
}
