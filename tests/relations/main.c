/* Random scenes held against themselves: relations between two runs or analyses, which need no reference.
 * usage: relations [--only RELATION] [--scenes N] [--seed S] [--scene K] [--verbose] [--list]
 * Draws scenes until N have exercised each relation (by default as many as the suite has). A scene that breaks one is
 * printed with all that replays it: --only RELATION --seed S --scene K. */
#include <stdlib.h>

#include "relations.h"

static const relation *const all[] = {
#define RELATION(name) &relation_##name,
#include "relations.def"
#undef RELATION
};
enum { ALL = sizeof all / sizeof all[0], REASONS = 12 };

typedef struct arguments {
    const char *only;
    uint32_t scenes, scene;
    uint64_t seed;
    int one, verbose;
} arguments;

/* Why scenes were refused or left out, and how often. */
typedef struct reason {
    char what[200];
    uint32_t count;
} reason;

typedef struct tally {
    uint32_t drawn, telling, count[VERDICTS], reasons;
    double ratio;
    reason reason[REASONS];
} tally;

static trial present;

static void count_reason(tally *c, const char *what)
{
    for (uint32_t i = 0; i < c->reasons; ++i) {
        if (strncmp(c->reason[i].what, what, 40) != 0) continue;
        ++c->reason[i].count;
        return;
    }
    if (c->reasons == REASONS) return;
    (void)snprintf(c->reason[c->reasons].what, sizeof c->reason[0].what, "%s", what);
    c->reason[c->reasons++].count = 1;
}

static void run_scene(const relation *r, uint64_t seed, uint32_t number, int verbose, tally *c)
{
    present.verdict = VERDICT_HELD;
    present.telling = 0;
    present.ratio = 0.0;
    present.what[0] = present.broken[0] = '\0';
    scene_draw(seed, number, &r->wish, &present.s);
    r->check(&present);
    ++c->drawn;
    ++c->count[present.verdict];
    c->telling += present.telling && present.verdict <= VERDICT_BROKEN;
    if (present.verdict == VERDICT_REFUSED || present.verdict == VERDICT_LEFT_OUT) count_reason(c, present.what);
    if (!(present.ratio <= c->ratio) && present.verdict != VERDICT_REFUSED) c->ratio = present.ratio;
    if (present.verdict == VERDICT_BROKEN) {
        printf("BROKEN %s\n  %s\n", r->name, present.broken);
        printf("  replay: --only %s --seed %llu --scene %u\n", r->name, (unsigned long long)seed, (unsigned)number);
    }
    if (present.verdict == VERDICT_BROKEN || verbose) scene_print(&present.s);
    if (verbose) printf("  verdict %d ratio %.3g: %s\n", (int)present.verdict, present.ratio, present.what);
}

/* Returns 1 if the relation holds and enough scenes exercised it. */
static int run_relation(const relation *r, const arguments *a)
{
    const uint32_t wanted = a->one ? 1 : a->scenes > 0 ? a->scenes : r->in_suite;
    const uint32_t most = a->one ? 1 : 20 + (uint32_t)(wanted / r->least);
    tally c;
    memset(&c, 0, sizeof c);
    for (uint32_t i = 0; i < most && c.count[VERDICT_HELD] + c.count[VERDICT_BROKEN] < wanted; ++i)
        run_scene(r, a->seed, a->one ? a->scene : i, a->verbose || a->one, &c);
    const uint32_t exercised = c.count[VERDICT_HELD] + c.count[VERDICT_BROKEN];
    printf("%-14s %5u exercised of %5u drawn (%u refused, %u left out), %u broken; worst %.2g of its tolerance\n",
           r->name, (unsigned)exercised, (unsigned)c.drawn, (unsigned)c.count[VERDICT_REFUSED],
           (unsigned)c.count[VERDICT_LEFT_OUT], (unsigned)c.count[VERDICT_BROKEN], c.ratio);
    for (uint32_t i = 0; i < c.reasons; ++i) printf("  %5u: %s\n", (unsigned)c.reason[i].count, c.reason[i].what);
    if (exercised < wanted) printf("  TOO FEW: %u wanted\n", (unsigned)wanted);
    const int told = a->one || c.telling >= r->telling * exercised;
    if (r->telling > 0.0) printf("  %5u of them telling\n", (unsigned)c.telling);
    if (!told) printf("  TOO FEW of them telling: %g wanted\n", r->telling * exercised);
    (void)fflush(stdout);
    return c.count[VERDICT_BROKEN] == 0 && exercised >= wanted && told;
}

static int list(void)
{
    for (int i = 0; i < ALL; ++i) printf("%-14s %s\n", all[i]->name, all[i]->holds);
    return EXIT_SUCCESS;
}

static int usage(void)
{
    (void)fprintf(stderr, "usage: [--only RELATION] [--scenes N] [--seed S] [--scene K] [--verbose] [--list]\n");
    return 2;
}

/* Returns 0 where an option is unknown or has no value. */
static int read_option(int argc, char **argv, int *i, arguments *a)
{
    const char *const name = argv[*i], *const value = *i + 1 < argc ? argv[*i + 1] : NULL;
    if (strcmp(name, "--verbose") == 0) return a->verbose = 1;
    if (value == NULL) return 0;
    ++*i;
    if (strcmp(name, "--only") == 0)
        a->only = value;
    else if (strcmp(name, "--scenes") == 0)
        a->scenes = (uint32_t)strtoul(value, NULL, 10);
    else if (strcmp(name, "--seed") == 0)
        a->seed = strtoull(value, NULL, 10);
    else if (strcmp(name, "--scene") == 0)
        a->scene = (uint32_t)strtoul(value, NULL, 10), a->one = 1;
    else
        return 0;
    return 1;
}

int main(int argc, char **argv)
{
    arguments a = {NULL, 0, 0, 1, 0, 0};
    int good = 1, found = 0;
    for (int i = 1; i < argc; ++i) {
        if (strcmp(argv[i], "--list") == 0) return list();
        if (!read_option(argc, argv, &i, &a)) return usage();
    }
    for (int i = 0; i < ALL; ++i) {
        if (a.only && strcmp(a.only, all[i]->name) != 0) continue;
        good &= run_relation(all[i], &a);
        found = 1;
    }
    if (!found) (void)fprintf(stderr, "there is no relation %s\n", a.only);
    return good && found ? EXIT_SUCCESS : EXIT_FAILURE;
}
