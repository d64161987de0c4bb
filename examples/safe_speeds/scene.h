/* A string of 73 x 6 mm pipes of 1 m that lies in its hole of 94 mm, held and turned at its head. */
#ifndef SAFE_SPEEDS_SCENE_H
#define SAFE_SPEEDS_SCENE_H

#include <drillmbd/drillmbd.h>

#define TURN (2.0 * 3.14159265358979323846)
#define RPM (60.0 / TURN) /* [1/min] of 1 rad/s */

#define LOW_RPM 30.0
#define HIGH_RPM 300.0

typedef struct speeds_scene {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, bit;
} speeds_scene;

/* Describes it [m of eccentricity of the pipes] and puts it at rest, rubbed as if it turned at `speed` [rad/s], 0: not
 * at all. */
int32_t speeds_scene_make(uint32_t pipes, double eccentricity, double speed, speeds_scene *scene);
const char *speeds_scene_message(const speeds_scene *scene);
void speeds_scene_free(speeds_scene *scene);

#endif
