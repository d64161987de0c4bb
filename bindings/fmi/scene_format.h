/* The file resources/scene.bin of a co-simulation unit: the scene record of its model and the settings of its run. It
 * has no pointers and no struct layout; numbers are little-endian: u32, u64, and f64 by its 64 bits of IEEE 754.
 *
 *     header    "DMBSCENE", u32 format, u32 flags, u64 length of all, u32 checksum (CRC-32 of all that follows), u32 0
 *     token     of the unit, SCENE_TOKEN bytes, ends with 0
 *     record    u32 length, the bytes of dmb_model_write
 *     options   of compile, sim and static state, each: u32 count, f64 values in the order of SCENE_..._OPTIONS
 *     step      f64 [s] of the steps within a communication step; 0: chosen by the library
 *     outputs   u32 count, each: u32 index of the part's id, u32 pipe, f64 fraction, u32 quantity
 *
 * A newer version adds options at the end of their list: an older file leaves them at their defaults, a newer file is
 * refused. drillmbd/fmu.py and scene_write.c write it. */
#ifndef DMB_FMI_SCENE_FORMAT_H
#define DMB_FMI_SCENE_FORMAT_H

#include <stddef.h>
#include <stdint.h>

#include <drillmbd/drillmbd.h>

#define SCENE_MAGIC "DMBSCENE"
enum { SCENE_FORMAT = 3, SCENE_HEADER = 32, SCENE_CHECKSUM_AT = 24, SCENE_TOKEN = 48, SCENE_HAS_STATIC = 1 };

/* All fields that are numbers, in the order of their structs: that of drillmbd/fmu.py. */
#define SCENE_COMPILE_OPTIONS(X)     \
    X(dmb_compile_options, features) \
    X(dmb_compile_options, pipe_kind)
#define SCENE_SIM_OPTIONS(X)                  \
    X(dmb_sim_options, max_iterations)        \
    X(dmb_sim_options, spectral_radius)       \
    X(dmb_sim_options, newton_tolerance)      \
    X(dmb_sim_options, tolerance_translation) \
    X(dmb_sim_options, tolerance_rotation)    \
    X(dmb_sim_options, step_min)              \
    X(dmb_sim_options, step_max)              \
    X(dmb_sim_options, max_cuts)              \
    X(dmb_sim_options, bounded_work)          \
    X(dmb_sim_options, energy_ledger)         \
    X(dmb_sim_options, max_steps)             \
    X(dmb_sim_options, constraint_method)     \
    X(dmb_sim_options, parallel_parts)        \
    X(dmb_sim_options, parallel_least)        \
    X(dmb_sim_options, assembly_energy)
#define SCENE_STATIC_OPTIONS(X)           \
    X(dmb_static_options, max_iterations) \
    X(dmb_static_options, tolerance)      \
    X(dmb_static_options, slip_axial)     \
    X(dmb_static_options, slip_rotation)  \
    X(dmb_static_options, load_steps)     \
    X(dmb_static_options, lay_on_wall)    \
    X(dmb_static_options, steady)

/* Settings of the run. */
typedef struct scene_settings {
    dmb_compile_options compile;
    dmb_sim_options sim;
    dmb_static_options statics;
    int has_static;        /* 1: the run begins in the static state */
    double step;           /* [s] as in the file */
    dmb_output *outputs;   /* shape (output_count) */
    uint32_t output_count; /* [-] */
} scene_settings;

scene_settings scene_settings_default(void);

typedef enum scene_type { SCENE_REAL, SCENE_COUNT, SCENE_WHOLE } scene_type; /* double, uint32_t, int32_t */
typedef struct scene_option {
    const char *name;
    size_t offset;
    scene_type type;
} scene_option;
typedef struct scene_options {
    const char *name;
    const scene_option *options;
    uint32_t count;
    size_t offset; /* of the struct in scene_settings */
} scene_options;
enum { SCENE_LISTS = 3 };
extern const scene_options scene_option_lists[SCENE_LISTS];

uint32_t scene_checksum(const void *bytes, uint64_t size);

/* Writes the file of a model; compiled or not. 0, or -1 where the model cannot be a record (dmb_last_error), the token
 * is too long, or memory or the file could not be had. Not in the unit itself. */
int scene_write(const char *path, const char *token, const dmb_model *model, const scene_settings *settings);

#endif
