/* What the user described, as it was described; dmb_model_compile turns it into a dmb_scene. */
#ifndef DMB_MODEL_MODEL_H
#define DMB_MODEL_MODEL_H

#include <stdatomic.h>

#include "base/message.h"
#include "drillmbd/model.h"
#include "force/programme.h"
#include "model/refused.h"
#include "model/scene.h"

/* Kinds in the upper 8 bits of dmb_id.index. */
enum {
    DMB_PART_PROGRAMME = 1, DMB_PART_WALL = 2, DMB_PART_STRING = 3, DMB_PART_BODY = 4, DMB_PART_BIT = 5,
    DMB_PART_DRIVE = 6, DMB_PART_LOAD = 7, DMB_PART_JOINT = 8, DMB_PART_COUPLING = 9, DMB_PART_CONSTRAINT = 10
};

/* A string and how far it has been built. */
typedef struct dmb_string_plan {
    dmb_string_def def;
    uint32_t pipes; /* that its runs have so far */
    uint32_t reserved;
} dmb_string_plan;

/* One call of dmb_model_add_pipes. */
typedef struct dmb_pipe_run {
    dmb_pipe_def def;
    uint32_t string; /* index of the string it lengthens */
    uint32_t first;  /* number of its first pipe along that string */
    uint32_t count;
    uint32_t reserved;
} dmb_pipe_run;

/* A list that grows through the model's allocator. */
typedef struct dmb_list {
    void *items;
    uint32_t count, capacity;
} dmb_list;

struct dmb_model {
    uint32_t magic;
    uint32_t stamp;        /* generation of the ids it gives out, never 0 */
    atomic_uint holders;   /* the caller and every live sim */
    atomic_uint owned;     /* 1 until the caller destroys it: a copied handle gives nothing up a second time */
    uint32_t busy;         /* 1 while a call describes or compiles it */
    dmb_allocator allocator;
    dmb_log_fn log;
    void *log_context;
    dmb_message message;
    dmb_environment_def environment;
    dmb_wall_def wall;     /* survey points to the model's own copy */
    uint32_t wall_count;   /* 0 or 1 */
    dmb_list programmes;   /* dmb_programme, terms and tables are the model's own copies */
    dmb_list strings;      /* dmb_string_plan */
    dmb_list runs;         /* dmb_pipe_run, in the order they were added */
    dmb_list bodies;       /* dmb_body_def */
    dmb_list bits;         /* dmb_bit_def */
    dmb_list drives;       /* dmb_drive_def */
    dmb_list loads;        /* dmb_load_def */
    dmb_list joints;       /* dmb_joint_def */
    dmb_list couplings;    /* dmb_coupling_def */
    dmb_list constraints;  /* dmb_constraint_def */
    dmb_refusals refused;  /* parts that were refused and not added since */
    dmb_scene *scene;      /* NULL until compiled, then never changed */
    uint32_t sparse_nodes; /* nodes from which on a cluster is sparse: DMB_SPARSE_NODES, but for tests */
    uint32_t reserved;
};

/* The parts of an id, or UINT32_MAX when it does not name a part of that kind of this model. */
uint32_t dmb_model_part_index(const dmb_model *model, dmb_id id, uint32_t kind);
/* A sim takes hold of a compiled model, and lets go. */
void dmb_model_hold(dmb_model *model);
void dmb_model_release(dmb_model *model);

#endif
