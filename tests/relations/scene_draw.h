/* A random scene as plain data: the public structs with numbers in place of ids, so that it can be transformed, printed
 * and built again. Wider than the scenes of tests/bench/stability_draw.h: strings without a hole, free ones, loads,
 * closed rings, mechanisms of bodies. The same seed, number and wish give the same scene on every machine with the same
 * C library; a topic (hole, pipes, joints ...) has numbers of its own, so that a wish for less changes nothing else. */
#ifndef DMB_RELATIONS_SCENE_DRAW_H
#define DMB_RELATIONS_SCENE_DRAW_H

#include <stdint.h>

#include <drillmbd/drillmbd.h>

#define PI 3.14159265358979323846

enum {
    SCENE_STRINGS = 3,
    SCENE_PIPES = 20, /* of one string */
    SCENE_BODIES = 6,
    SCENE_JOINTS = 12,
    SCENE_DRIVES = 3,
    SCENE_LOADS = 3,
    SCENE_SURVEY = 6,
    SCENE_SEGMENTS = 2
};

typedef enum part_kind { PART_NONE, PART_STRING, PART_BODY, PART_JOINT, PART_BIT } part_kind;

/* A part by its number among those of its kind, and a place on it. PART_NONE: the ground. */
typedef struct part_ref {
    part_kind kind;
    uint32_t index, pipe;
    double fraction;
} part_ref;

typedef struct time_function_data {
    uint32_t terms; /* 0: none */
    dmb_segment term[SCENE_SEGMENTS];
} time_function_data;

typedef struct string_data {
    dmb_string_def def;
    uint32_t pipes;
    dmb_pipe_def pipe[SCENE_PIPES]; /* each added by itself: nothing is left to the library's random numbers */
} string_data;

typedef struct body_data {
    dmb_body_def def;
    uint32_t string; /* of an attached one */
} body_data;

typedef struct joint_data {
    dmb_joint_def def;
    part_ref a, b;
} joint_data;

typedef struct drive_data {
    dmb_drive_def def;
    part_ref part;
    time_function_data time_function;
} drive_data;

typedef struct load_data {
    dmb_load_def def;
    part_ref place;
    time_function_data time_function;
} load_data;

typedef struct scene {
    uint64_t seed;
    uint32_t number;
    uint32_t family;     /* one FAMILY_ bit */
    double span;         /* [m] length of all strings, or reach of the bodies */
    double step, radius; /* [s, -] of generalized-alpha */
    dmb_environment_def environment;
    int32_t has_wall, has_bit;
    dmb_wall_def wall; /* its survey is the one below */
    uint32_t survey_count;
    double survey[SCENE_SURVEY][3];
    uint32_t strings, bodies, joints, drives, loads;
    string_data string[SCENE_STRINGS];
    body_data body[SCENE_BODIES];
    joint_data joint[SCENE_JOINTS];
    drive_data drive[SCENE_DRIVES];
    load_data load[SCENE_LOADS];
    dmb_bit_def bit; /* at the end of bit_string */
    uint32_t bit_string;
    time_function_data bit_load;
} scene;

enum {
    FAMILY_HOLE = 1,        /* a string in a straight hole, guided and driven at the rig */
    FAMILY_BENT = 2,        /* the same in a hole that bends */
    FAMILY_LINE = 4,        /* strings without a hole, held at the rig end, loaded at the far end */
    FAMILY_FREE = 8,        /* strings that nothing holds */
    FAMILY_STABILISER = 16, /* pipes of constant curvature that close upon themselves */
    FAMILY_BODIES = 32,     /* chains and loops of rigid bodies */
    FAMILY_ALL = 63
};

enum {
    WISH_STILL = 1,    /* drives hold, nothing moves at time 0, loads are constant */
    WISH_DAMPED = 2,   /* every part loses energy when it moves */
    WISH_FLEXIBLE = 4, /* flexible pipes only */
    WISH_NO_FRICTION = 8,
    WISH_NO_BIT = 16,
    WISH_NO_JOINTS = 32,
    WISH_JOINTS = 64,        /* at least one */
    WISH_CONSERVATIVE = 128, /* symmetric stiffness: no follower loads, no moments with a fixed axis, no friction */
    WISH_ROUND = 256,        /* no eccentric mass */
    WISH_ELASTIC = 512,      /* what joints leave free is held by springs, so that a state of rest is one point */
    WISH_NO_LOADS = 1024,
    WISH_NO_CONTROL = 2048,
    WISH_HARD = 4096 /* walls keep their damping, but none of chattering laws: Kelvin-Voigt only */
};

typedef struct scene_wish {
    uint32_t families;   /* FAMILY_ bits to choose from */
    uint32_t flags;      /* WISH_ bits */
    uint32_t most_pipes; /* of one string; 0: 6 */
} scene_wish;

void scene_draw(uint64_t seed, uint32_t number, const scene_wish *wish, scene *out);
/* One line: all that is needed to tell what kind of scene it is. */
void scene_print(const scene *s);
const char *scene_family_name(uint32_t family);

/* Rigid strings in a hole tilt at their rig end. A drive along an axis that tilts holds a speed and no place (it is not
 * holonomic): where it comes to rest depends on the way, and its force turns with the string, so that K is unsymmetric.
 */
int scene_drives_tilt(const scene *s);

/* Numbers of a topic of a scene. */
typedef struct stream {
    uint64_t state;
} stream;
stream stream_of(uint64_t seed, uint32_t number, uint32_t topic);
double draw_number(stream *t, double low, double high);
double draw_size(stream *t, double low, double high);        /* evenly over the orders of magnitude */
uint32_t draw_count(stream *t, uint32_t low, uint32_t high); /* low .. high */
int draw_chance(stream *t, double probability);
/* c, and from `begin` on within `time` smoothly c + more (fifth-order step). */
time_function_data time_function_step(double c, double more, double begin, double time);
void draw_direction(stream *t, double unit[3]);
enum { TOPIC_OF_RELATION = 100 }; /* topics from here on are free for relations */

#endif
