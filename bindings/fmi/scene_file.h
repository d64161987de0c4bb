/* Reads a scene file and makes its model. */
#ifndef DMB_FMI_SCENE_FILE_H
#define DMB_FMI_SCENE_FILE_H

#include "scene_format.h"

typedef struct scene_file {
    uint64_t *bytes; /* the whole file; structs are used where they stand */
    uint64_t size;   /* [byte] */
    dmb_model *model;
    uint32_t generation; /* stamp of the model's ids, 0 before the first */
    dmb_sim_options sim;
    dmb_static_options statics;
    int has_static;
    double step;           /* [s] scene_run */
    dmb_output *outputs;   /* shape (output_count) */
    uint32_t output_count; /* [-] */
    char message[512];     /* why the last call failed */
} scene_file;

/* Reads and checks the file; makes and compiles the model. 0, or -1 with the reason in `message`. scene_close in either
 * case. */
int scene_open(scene_file *scene, const char *path, dmb_log_fn log, void *log_context);
const char *scene_token(const scene_file *scene);
void scene_close(scene_file *scene);

#endif
