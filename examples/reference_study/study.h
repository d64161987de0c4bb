/* The results of the reference, and their dependence on parameters. */
#ifndef REFERENCE_STUDY_H
#define REFERENCE_STUDY_H

#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "../gas_drainage_rig/run.h"

#define STUDY_TURN (2.0 * 3.14159265358979323846)             /* [rad] */
#define STUDY_ROTATION (RIG_ROTATION_RPM * STUDY_TURN / 60.0) /* [rad/s] */
#define STUDY_LOSS 0.03                                       /* [-] structural damping of responses */
#define STUDY_REFERENCE_CROSSOVER 1.58                        /* [Hz] */

enum { STUDY_MODES = 10, STUDY_TEXT = 320 };

/* One string: that of gas_drainage_rig, and what a parameter study changes of it. */
typedef struct study_scene {
    dmb_wall_def wall;
    dmb_pipe_def pipe;
    dmb_bit_def bit; /* mass 0: none */
    uint32_t pipes;
    int32_t kind;   /* DMB_PIPE_... */
    int32_t alone;  /* 1: neither wall nor weight */
    int32_t unheld; /* 1: the drives let go, the string moves along and around freely */
    double drag; /* [N s/m2, N] resistance per metre and m/s along the hole, per metre and m/s of the skin around it */
} study_scene;

/* A described string, compiled, in a sim. */
typedef struct study_string {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, drive[2], push; /* feed and rotation; a load of 1 N on the far end, not acting before an analysis */
} study_string;

/* 100 pipes of the rig. */
study_scene study_base(void);
/* [m] between pipe and wall all around, from the middle of the hole */
double study_clearance(const study_scene *scene);
/* The scene at rest: on the low side of the hole, pushed by the load on the bit, or where it is described if alone. */
int32_t study_make(const study_scene *scene, study_string *string);
void study_free(study_string *string);
/* The library's message about the last failure. */
const char *study_message(const study_string *string);
/* [Hz] the `count` lowest frequencies. */
int32_t study_lowest(study_string *string, int32_t contact, uint32_t count, double *frequencies);
/* A table in the output folder, with its first line unless that is NULL; NULL (with a message) if it cannot be written.
 */
FILE *study_table(const char *folder, const char *name, const char *head);

/* ---- Jobs shared out to threads ----------------------------------------------------------------------------------
 * Each writes to memory of its own and none reads another's, so the answers do not depend on the number of threads. */
typedef struct study_job {
    void (*work)(void *context);
    void *context;
} study_job;
void study_share_out(const study_job *jobs, int count, int threads);

/* ---- Parts as the study counts them (counts.c) ------------------------------------------------------------------- */
typedef struct study_counts {
    int32_t status;
    char message[STUDY_TEXT];
    dmb_check_report report;
} study_counts;
void study_counts_work(void *counts);

/* ---- Modes (modes.c) --------------------------------------------------------------------------------------------- */
enum { STUDY_TUBES = 3, STUDY_MESHES = 10, STUDY_NORMALS = 3, STUDY_SHAPES = 5, STUDY_PLACES = 101, STUDY_ALL = 640 };
typedef struct study_modal {
    int32_t status;
    char message[STUDY_TEXT];
    dmb_mode first[STUDY_MODES]; /* drives let go, a little drag */
    int overdamped, rigid;       /* of them, before the first that swings */
    double all[STUDY_ALL];       /* [Hz] every mode of the string without drag, rising */
    uint32_t all_count, all_rigid;
    double highest[STUDY_MESHES];   /* [Hz] with 1, 2, ... elements in each pipe */
    double by_modes[STUDY_NORMALS]; /* [Hz] highest with pipes described by 12 end and 16, 22, 28 normal modes */
    double without_bit;             /* [Hz] lowest of the string held by its drives */
    double shape[STUDY_SHAPES][STUDY_PLACES]; /* [-] of modes 2, 4, ... 10, held; 1 at the far end */
    double shape_frequency[STUDY_SHAPES];     /* [Hz] */
    int shape_nodes[STUDY_SHAPES];            /* [-] places between the ends that stand still */
    double pair_angle[STUDY_SHAPES];          /* [rad] between the planes in which modes 1 and 2, 3 and 4, ... bend */
    double tube[STUDY_TUBES];                 /* [Hz] lowest of steel tubes */
} study_modal;
extern const int study_normal_modes[STUDY_NORMALS];
extern const double study_tube_length[STUDY_TUBES], study_tube_reference[STUDY_TUBES];
int32_t study_find_by_modes(study_modal *modal, study_string *string); /* pipe_modes.c */
void study_modal_work(void *modal);
void study_modal_print(const study_modal *modal);
int study_modal_write(const char *folder, const study_modal *modal);

/* ---- Response of the last pipe (response.c) ---------------------------------------------------------------------- */
/* Friction acts around the string (STUDY_FRICTION) as it turns; ALONG is the same coefficient along the hole, as of a
 * string that only slides, and is no part of TOGETHER. */
enum {
    STUDY_DRIVE = 0,
    STUDY_FRICTION = 1,
    STUDY_ECCENTRIC = 2,
    STUDY_TOGETHER = 3,
    STUDY_ALONG = 4,
    STUDY_CAUSES = 5,
    STUDY_AXES = 3,
    STUDY_ALL_AXES = 3
};
typedef struct study_response {
    uint32_t points;
    int32_t friction;  /* the cause that is compared with eccentricity: STUDY_FRICTION or _ALONG */
    double *frequency; /* [Hz] shape (points) */
    /* [m] of the middle of the last pipe, shape (points, STUDY_CAUSES); root of the sum of the squares of X, Y and Z */
    double *amplitude;
    double *axis[STUDY_AXES]; /* [m] along X, Y, Z alone, of the same shape */
} study_response;
/* Amplitudes from `low` to `high` [Hz]: `points` at equal ratios, and more at peaks. */
int32_t study_respond(study_string *string, const study_scene *scene, double low, double high, uint32_t points,
                      uint32_t refinement, study_response *response);
void study_response_free(study_response *response);
/* The same response along one axis (or STUDY_ALL_AXES), with one of the two frictions compared. Borrows the arrays. */
study_response study_response_view(const study_response *response, int axis, int32_t friction);
/* [Hz] first and last frequency at which eccentricity (times `eccentric`) becomes as strong as friction (times
 * `friction`); NaN where that never is. */
void study_crossover(const study_response *response, double friction, double eccentric, double found[2]);
/* Number of the point with the largest amplitude. */
uint32_t study_peak(const study_response *response, int cause);
/* [m] at a frequency, between points by equal powers of it. */
double study_amplitude_at(const study_response *response, int cause, double frequency);
/* [-] friction over eccentricity at a frequency. */
double study_ratio_at(const study_response *response, double frequency);
/* [-] part of the grid's octaves between two frequencies in which eccentricity is stronger. */
double study_eccentric_share(const study_response *response, double low, double high);

enum { STUDY_CASES = 6 };
typedef struct study_shaken {
    int32_t status;
    char message[STUDY_TEXT];
    study_response response;
    double crossover[STUDY_CASES][2]; /* [Hz] first and last, of the frictions and eccentricities below */
    study_response aligned;           /* with the eccentric masses all to one side, at low frequencies */
} study_shaken;
extern const double study_case_friction[STUDY_CASES], study_case_eccentricity[STUDY_CASES];
void study_shaken_work(void *shaken);
void study_shaken_print(const study_shaken *shaken);
int study_shaken_write(const char *folder, const study_shaken *shaken);

/* ---- Parameter studies (parameters.c) ---------------------------------------------------------------------------- */
enum {
    STUDY_LENGTHS = 0,
    STUDY_PIPE_LENGTHS = 1,
    STUDY_ELEMENTS = 2,
    STUDY_FRICTIONS = 3,
    STUDY_HOLES = 4,
    STUDY_MODULI = 5,
    STUDY_WALLS = 6,
    STUDY_SETS = 7,
    STUDY_VALUES = 10
};
typedef struct study_point {
    int32_t status;
    char message[STUDY_TEXT];
    double value; /* of the parameter that this set varies */
    study_scene scene;
    double bending[STUDY_MODES]; /* [Hz] without a wall; every order twice, in two planes */
    double on_wall[STUDY_MODES]; /* [Hz] swinging on the wall */
    double axial, torsional;     /* [Hz] lowest */
    double sag, touch;      /* [m] of the deepest place below the hole's axis; to where it lies down, from the head */
    double thrust, torque;  /* [N, N m] of the head, sliding into the hole and turning, load on the bit included */
    double push;            /* [N] of the head, sliding without turning */
    double buckling;        /* [N] at the bit, on top of its load, at which the string at rest buckles */
    double peak, amplitude; /* [Hz, m] the largest of the last pipe to all causes together */
    double crossover;       /* [Hz] first */
} study_point;
typedef struct study_set {
    int count;
    study_point point[STUDY_VALUES];
} study_set;
void study_sets_describe(study_set sets[STUDY_SETS]);
void study_point_work(void *point);
void study_sets_print(const study_set sets[STUDY_SETS]);
int study_sets_write(const char *folder, const study_set sets[STUDY_SETS]);

/* ---- The drilling cycle in time (cycles.c) ----------------------------------------------------------------------- */
#define STUDY_BIT 0.090 /* [m] diameter of that bit */
#define STUDY_JUMP 1.0  /* [m/s2] above this a change of speed between samples is a jump: a tenth of gravity */
enum {
    STUDY_RIGID = 0, /* with friction and vibration, as FULL */
    STUDY_CONTACT = 1,
    STUDY_RUBBING = 2, /* contact and friction */
    STUDY_FULL = 3,    /* and vibration */
    STUDY_RIGID_DROPPED = 4,
    STUDY_FULL_DROPPED = 5,
    STUDY_RIGID_BIT = 6, /* with a bit that meets the wall itself */
    STUDY_FULL_BIT = 7,
    STUDY_RUNS = 8,
    STUDY_DRIVEN = 2, /* stages: drill, pull out */
    STUDY_WINDOWS = 15,
    STUDY_HALF_TURNS = 120 /* in a driven stage */
};
/* Motion of one place in one driven stage: X along the hole, Y across it, Z up. */
typedef struct study_motion {
    double mean[STUDY_AXES];  /* [m] displacement */
    double speed[STUDY_AXES]; /* [m/s] root mean square of the speed about its mean */
    double above, below;      /* [m] farthest Z above and below its mean */
    double highest;           /* [m] Z from the axis of the hole */
    double scatter;           /* [-] standard deviation of successive swings of Z over their mean */
    double jumps;             /* [1/s] of the Z speed */
} study_motion;
typedef struct study_run {
    int32_t status;
    rig_options options;
    rig_variant variant;
    int whole;        /* 1: over the whole cycle */
    int left;         /* [-] times that the end of the last pipe leaves the wall */
    double last_left; /* [s] NaN: never */
    double bit_speed; /* [m/s] root mean square Z speed of the bit while drilling, of runs that are not dropped */
    /* Of runs over the whole cycle: */
    double height[2];                           /* [m] mean Z displacement of the end of the first pipe, of the bit */
    double speed[RIG_PIPES];                    /* [m/s] root mean square Z speed of the ends of three pipes */
    double jumps[RIG_PIPES];                    /* [1/s] of that speed */
    double energy[STUDY_DRIVEN][STUDY_WINDOWS]; /* [J] kinetic, of the last pipe: means over four revolutions */
    double swing[STUDY_DRIVEN][STUDY_WINDOWS];  /* [J] root mean square about them */
    double half_turn[STUDY_DRIVEN][STUDY_HALF_TURNS]; /* [J] the same over half a revolution each */
    study_motion motion[STUDY_DRIVEN][RIG_PLACES];
    double feed_error; /* [m/s] root mean square of the X speed of the first pipe off the time function, whole cycle */
    double wall_swing; /* [-] root mean square of the wall force at the last pipe while drilling about its mean, over
                          that */
} study_run;
void study_runs_describe(study_run runs[STUDY_RUNS], double step);
void study_run_work(void *run);
/* [s] of one window */
double study_window_begin(const study_run *run, int stage, int window);
double study_window_end(const study_run *run, int stage, int window);
/* [J] mean over one driven stage */
double study_energy(const study_run *run, int stage);
void study_runs_print(const study_run runs[STUDY_RUNS]);
int study_runs_write(const char *folder, const study_run runs[STUDY_RUNS]);

/* ---- The study's sentences (claims.c) -------------------------------------------------------------------------- */
typedef struct study_results {
    study_counts counts;
    study_modal modal;
    study_shaken shaken;
    study_set sets[STUDY_SETS];
    study_run runs[STUDY_RUNS];
    int timed; /* 1: the runs in time were made */
} study_results;
void study_claims_print(const study_results *results);

#endif
