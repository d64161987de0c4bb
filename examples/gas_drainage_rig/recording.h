/* The table that is kept while a variant runs: one row a sample, one column a output. */
#ifndef RIG_RECORDING_H
#define RIG_RECORDING_H

#include <stddef.h>

#include "scene.h"

/* Places that are watched: the far ends of the first, the middle and the last pipe, and the bit. */
enum { RIG_FIRST = 0, RIG_MIDDLE = 1, RIG_LAST = 2, RIG_BIT = 3, RIG_PLACES = 4, RIG_PIPES = 3 };

/* Columns: the time, then six of each place (displacement x y z, velocity x y z), then these. */
enum {
    RIG_TIME = 0,
    RIG_DISPLACEMENT_Z = 3, /* of place p: + 6 p */
    RIG_VELOCITY_Z = 6,
    RIG_KINETIC_ENERGY = 25, /* of the last pipe */
    RIG_FEED_FORCE = 26,
    RIG_FEED_SPEED = 27,
    RIG_TORQUE = 28,
    RIG_SPIN = 29,
    RIG_NORMAL_FORCE = 30, /* at the far end of the last pipe, then at the bit */
    RIG_ENERGY_ERROR = 32,
    RIG_COLUMNS = 33
};

typedef struct rig_recording {
    dmb_output outputs[RIG_COLUMNS - 1];
    dmb_recorder recorder;
    uint32_t pipe[RIG_PIPES]; /* which pipes, from 0 */
    double *wall_force;       /* [N] sum over the wall at each row */
} rig_recording;

/* [Hz] Extents and means are taken of so many samples, whatever part of them the tables show. */
double rig_samples_a_second(const rig_options *options);
/* Makes room for all samples of a run. DMB_ERR_NO_MEMORY if there is none. */
int32_t rig_recording_open(rig_recording *recording, const rig_options *options, const rig_scene *scene);
int32_t rig_recording_take(rig_recording *recording, const dmb_sim *sim);
/* Writes the table as CSV with `rate` rows a second. DMB_ERR_NO_MEMORY, DMB_ERR_IO. */
int32_t rig_recording_write(const rig_recording *recording, const rig_options *options, const char *path);
void rig_recording_close(rig_recording *recording);

/* Statistics of one column of the results between two times. Times are included. */
typedef struct rig_extent {
    double low, high, mean;
    double jump; /* largest change from one sample to the next */
} rig_extent;
rig_extent rig_column_extent(const rig_recording *recording, int column, double from, double to);
rig_extent rig_wall_extent(const rig_recording *recording, double from, double to);

#endif
