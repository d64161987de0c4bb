/* A dmb_model and a dmb_sim of a scene. */
#ifndef DMB_RELATIONS_SCENE_BUILD_H
#define DMB_RELATIONS_SCENE_BUILD_H

#include "scene_draw.h"

typedef struct built {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string[SCENE_STRINGS], body[SCENE_BODIES], joint[SCENE_JOINTS], drive[SCENE_DRIVES], load[SCENE_LOADS], bit;
    int32_t status; /* of what failed first, or the note of dmb_sim_create */
    char message[256];
} built;

/* Adds parts as they are numbered (reversed: from the last of each kind to the first, surroundings at the end) and
 * compiles. options may be NULL: tight Newton, the scene's spectral radius. Returns b->status. */
int32_t scene_build(const scene *s, int reversed, built *b);
int32_t scene_open(const scene *s, int reversed, const dmb_sim_options *options, built *b);
dmb_sim_options scene_options(const scene *s);
void scene_close(built *b);
dmb_place built_place(const built *b, part_ref r);
/* Remembers what the sim says of a failure. */
int32_t built_fail(built *b, int32_t status);

#endif
