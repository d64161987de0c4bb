/* The rig as the library sees it. */
#ifndef RIG_SCENE_H
#define RIG_SCENE_H

#include "options.h"

/* The parts of the rig, before options choose lengths, meshes and couplings. reference_study varies the same rig. */
dmb_wall_def rig_wall(void); /* a hole of 94 mm in coal */
dmb_pipe_def rig_pipe(void); /* 73 x 6 mm steel, 1 m */
dmb_bit_def rig_bit(void);   /* 5 kg, away from the wall */

/* Parts for queries. Pipes are counted from 0 at the rig here, from 1 in tables and pictures. */
typedef struct rig_scene {
    dmb_model *model; /* compiled; give it back with dmb_model_destroy */
    dmb_id string, bit, feed, rotation;
} rig_scene;

/* Describes and compiles one variant. On failure the model is there to be asked for its message, or NULL. The options
 * must live as long as the model. */
int32_t rig_scene_make(rig_options *options, const rig_variant *variant, rig_scene *scene);

#endif
