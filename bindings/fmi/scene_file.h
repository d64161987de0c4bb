/* Reads a scene file and makes its model. */
#ifndef DMB_FMI_SCENE_FILE_H
#define DMB_FMI_SCENE_FILE_H

#include "scene_format.h"

typedef struct scene_file {
    dmb_model *model; /* compiled */
    scene_settings settings;
    char token[SCENE_TOKEN];
    char message[1024]; /* why the last call failed */
} scene_file;

/* Reads and checks the file; makes and compiles the model. 0, or -1 with the reason in `message`. scene_close in either
 * case. */
int scene_open(scene_file *scene, const char *path, dmb_log_fn log, void *log_context);
void scene_close(scene_file *scene);

#endif
