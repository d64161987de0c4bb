/* All that the queries say about a sim, as numbers that two runs can be compared by: vectors in the axes, units and
 * origin of the original scene, parts in its order. */
#ifndef DMB_RELATIONS_ANSWERS_H
#define DMB_RELATIONS_ANSWERS_H

#include "scene_build.h"
#include "scene_transform.h"

typedef enum answer_group {
    ANSWER_POSITION, /* [m] */
    ANSWER_ROTATION, /* [-] matrices, angles of nodes and joints */
    ANSWER_VELOCITY, /* [m/s] */
    ANSWER_SPIN,     /* [rad/s] */
    ANSWER_FORCE,    /* [N] sections, joints, drives, supports, contacts */
    ANSWER_MOMENT,   /* [N m] */
    ANSWER_ENERGY,   /* [J] */
    ANSWER_GROUPS
} answer_group;

enum { ANSWERS_MOST = 6000 };
typedef struct answers {
    uint32_t count;
    int32_t overflow;
    double value[ANSWERS_MOST];
    unsigned char group[ANSWERS_MOST];
} answers;

/* view: how `transformed`, which b was built of, sees `original`; NULL where they are one scene. */
void answers_take(const scene *original, const scene *transformed, const scene_view *view, const built *b,
                  answers *out);
const char *answer_group_name(answer_group group);
/* Largest |a - b| and largest |a| by group. NaN where one is NaN, or the counts differ. */
void answers_difference(const answers *a, const answers *b, double difference[ANSWER_GROUPS]);
void answers_size(const answers *a, double size[ANSWER_GROUPS]);

#endif
