/* The scene with dense matrices for all clusters. Modes, responses and buckling are made in independent coordinates, of
 * which there is a dense matrix R; steps and statics of large clusters do without it. */
#ifndef DMB_MODEL_SCENE_DENSE_H
#define DMB_MODEL_SCENE_DENSE_H

#include "model/scene.h"

/* Places the storage of clusters one after the other, none for sparse ones, and counts it in the scene. False where a
 * size overflows. */
int32_t dmb_scene_place_storage(uint32_t count, dmb_cluster *clusters, dmb_scene *scene);
/* After dmb_scene_link: scene->dense, NULL without sparse clusters and where one is too large. DMB_OK,
 * DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE. */
int32_t dmb_scene_make_dense(dmb_scene *scene, const dmb_allocator *allocator);
/* NULL is fine. */
void dmb_scene_release_dense(const dmb_scene *dense, const dmb_allocator *allocator);

#endif
