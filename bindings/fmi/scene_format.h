/* A scene as a file: the calls that describe it, with their structs as they lie in memory. The co-simulation unit
 * carries it as resources/scene.bin and makes its model by the same calls; drillmbd/fmu.py and scene_record.h write it.
 *
 * header, then records. A record names a call and is followed by `structs` structs of struct_size bytes, by `ids` pairs
 * of uint32 (number of the struct, offset in it) that tell where ids stand, and by `doubles` numbers: the arrays that
 * the structs point to, one after the other in the order of SCENE_ARRAYS. All lengths are multiples of 8. Structs must
 * have the size that the reader knows, so a file fits the library of its version and machines with the same layout:
 * little-endian, pointers of 8 bytes. */
#ifndef DMB_FMI_SCENE_FORMAT_H
#define DMB_FMI_SCENE_FORMAT_H

#include <stdint.h>

#include <drillmbd/drillmbd.h>

#define SCENE_MAGIC "DMBSCENE"
enum { SCENE_FORMAT = 2, SCENE_LAYOUT = 8, SCENE_TOKEN = 48, SCENE_CALL = 24 };

typedef struct scene_header {
    char magic[8];
    uint32_t format;         /* SCENE_FORMAT */
    uint32_t layout;         /* SCENE_LAYOUT: bytes of a pointer, in little-endian order */
    uint64_t length;         /* [byte] of the whole file */
    uint32_t checksum;       /* CRC-32 of all that follows `reserved` */
    uint32_t reserved;       /* 0 */
    char token[SCENE_TOKEN]; /* of the unit, ends with 0 */
} scene_header;

typedef struct scene_record {
    char call[SCENE_CALL]; /* "add_body", ends with 0 */
    uint32_t count;        /* [-] of pipes of add_pipes, else 1 */
    uint32_t structs, struct_size, ids, doubles;
    uint32_t reserved; /* 0 */
} scene_record;

/* An output of the unit, and what the run begins with. */
typedef struct scene_output {
    uint32_t struct_size, reserved;
    dmb_output noted;
} scene_output;
typedef struct scene_name { /* of the call set_name */
    uint32_t struct_size, reserved;
    dmb_id part;
    char name[DMB_NAME_SIZE];
} scene_name;
typedef struct scene_run {
    uint32_t struct_size, reserved;
    double step; /* [s] of the steps within a communication step; 0: chosen by the library */
} scene_run;

/* Calls with one struct that give an id. */
#define SCENE_DEFINITIONS(X)              \
    X(add_wall, dmb_wall_def)             \
    X(add_string, dmb_string_def)         \
    X(add_body, dmb_body_def)             \
    X(add_bit, dmb_bit_def)               \
    X(add_stabiliser, dmb_stabiliser_def) \
    X(add_joint, dmb_joint_def)           \
    X(add_coupling, dmb_coupling_def)     \
    X(add_drive, dmb_drive_def)           \
    X(add_load, dmb_load_def)             \
    X(add_spring, dmb_spring_def)         \
    X(add_stuck, dmb_stuck_def)           \
    X(add_input, dmb_input_def)           \
    X(add_event, dmb_event_def)

/* Pointers in structs to arrays: call, struct, pointer, count, numbers for each count. */
#define SCENE_ARRAYS(X)                                             \
    X(add_time_function, dmb_segment, table_time, table_count, 1)   \
    X(add_time_function, dmb_segment, table_value, table_count, 1)  \
    X(add_wall, dmb_wall_def, survey, survey_count, 3)              \
    X(add_spring, dmb_spring_def, table_elongation, table_count, 1) \
    X(add_spring, dmb_spring_def, table_force, table_count, 1)

/* Pointers that a file cannot say: they are NULL. */
#define SCENE_NULLS(X)                                  \
    X(add_time_function, dmb_segment, callback)         \
    X(add_time_function, dmb_segment, callback_context) \
    X(sim, dmb_sim_options, allocator)                  \
    X(sim, dmb_sim_options, log)                        \
    X(sim, dmb_sim_options, log_context)

uint32_t scene_checksum(const void *bytes, uint64_t size);

#endif
