/* A relation holds between two runs, or between two analyses, of one random scene. */
#ifndef DMB_RELATIONS_RELATIONS_H
#define DMB_RELATIONS_RELATIONS_H

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "answers.h"

typedef enum verdict {
    VERDICT_HELD,     /* exercised, and nothing was found */
    VERDICT_BROKEN,   /* exercised, and the relation does not hold */
    VERDICT_REFUSED,  /* the library refused the scene, in all runs alike */
    VERDICT_LEFT_OUT, /* the scene does not exercise the relation, or lies in a region that is left out by name */
    VERDICTS
} verdict;

typedef struct trial {
    scene s;
    verdict verdict;
    int32_t telling;  /* 1 where the scene shows both sides of the relation; set by those that ask for it */
    double ratio;     /* [-] worst figure over its tolerance */
    char what[200];   /* of it; reason of a refusal or of leaving out */
    char broken[400]; /* what did not hold */
} trial;

typedef struct relation {
    const char *name, *holds;
    scene_wish wish;
    uint32_t in_suite; /* [-] scenes exercised in the ordinary suite */
    double least;      /* [-] part of the scenes drawn that must exercise it */
    void (*check)(trial *t);
    double telling; /* [-] part of those that exercise it that must be telling */
} relation;

/* figure <= tolerance, or the relation is broken. */
void hold(trial *t, const char *what, double figure, double tolerance);
/* Broken whatever the figures: statuses that differ, counts. */
void broken(trial *t, const char *what, double a, double b);
void left_out(trial *t, const char *reason);
void refused(trial *t, int32_t status, const char *message);

/* ---- Two runs that differ by rounding --------------------------------------------------------------------------- */

/* Rounding of poses, and all that follows from it in one step: [units of the groups] for coordinates as large as
 * `reach`. A coordinate X is known to eps X; a stiff element makes a force of that, a step h a speed eps X/h. */
void rounding_of(const scene *s, double reach, double step, double floor[ANSWER_GROUPS]);
/* The scene with every load, speed and dimension that can vary by itself changed by the part p. */
void scene_perturb(const scene *s, double p, scene *out);
/* The condition of the scene is measured: how far a run goes that begins 1e-9 aside. */
#define PERTURBATION 1e-9
#define NEWTON_TOLERANCE 1e-12 /* of scene_options */
/* The condition of a scene: how far apart two of its runs end of which one begins PERTURBATION aside, by group. */
typedef struct condition {
    double apart[ANSWER_GROUPS], growth;
} condition;
/* Takes the larger one of what c has and of what a perturbed run says; begin with zeros. */
void condition_add(condition *c, const answers *a, const answers *perturbed, double perturbation);
/* Holds |a - b| of each group against  1000 (floor + e |a|) growth + 1000 (e/p) apart,  e the rounding of a double.
 * alike: the runs took the same decisions; otherwise they differ by what Newton leaves over: e is its tolerance then,
 * and the floor as much higher. Returns 1 if all hold; silent: says nothing where they do not. */
int hold_rounding(trial *t, const answers *a, const answers *b, const condition *c, int alike,
                  const double floor[ANSWER_GROUPS], int silent);

/* The decisions of a run: how its steps were divided, and how many iterations each took, as numbers to compare. */
typedef struct decisions {
    uint64_t divided, iterations;
    uint32_t rejected;
} decisions;
/* `steps` steps; returns the first failure, whose text is in b->message. d may be NULL. */
int32_t run_steps(built *b, double step, uint32_t steps, decisions *d);

/* A push of `force` for the first `time` seconds, where the first load acts: a load more, 0 at time 0. */
void scene_kick(scene *s, const double force[3], double time);

/* A run and all that is asked of it. */
typedef struct run_record {
    int32_t status;
    char message[256];
    decisions decisions;
    answers answers;
} run_record;
/* The trial's scene against `seen`, which a view has made of it. Both are run, and the scene a hair aside, and held
 * together by hold_rounding. */
typedef struct comparison {
    const scene *seen;
    const scene_view *view;
    int reversed; /* parts of `seen` are added in the other order */
    uint32_t steps;
    const dmb_sim_options *options; /* of the run of `seen`; NULL: scene_options */
    int loose;                      /* other equations with the same solution: what Newton leaves over differs */
} comparison;
void hold_runs(trial *t, const comparison *c);

#define RELATION(name) extern const relation relation_##name;
#include "relations.def"
#undef RELATION

#endif
