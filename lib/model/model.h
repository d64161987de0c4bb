/* The user's description as given; dmb_model_compile turns it into a dmb_scene. */
#ifndef DMB_MODEL_MODEL_H
#define DMB_MODEL_MODEL_H

#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>

#include "base/failure.h"
#include "base/message.h"
#include "base/value_check.h"
#include "drillmbd/scene.h"
#include "fields/fields.h"
#include "force/time_function.h"
#include "model/scene.h"

/* ---- Parts that were refused ------------------------------------------------------------------------------------- */

/* The first refused parts are stored; of further ones only the number. */
enum { DMB_REFUSED_KEPT = 8, DMB_REFUSED_BYTES = 768 };

typedef struct dmb_refusal {
    const char *part; /* the kind: "body", "pipes", ... */
    int32_t status;
    uint32_t count; /* of pipes or segments, 1 of other parts */
    size_t size;    /* [byte] of the definition; 0: it could not be read, or there is one such part a model */
    dmb_message message;
    unsigned char definition[DMB_REFUSED_BYTES]; /* as it was read */
} dmb_refusal;

typedef struct dmb_refusals {
    uint32_t kept;    /* in first, oldest first */
    uint32_t further; /* beyond those */
    dmb_refusal first[DMB_REFUSED_KEPT];
} dmb_refusals;

/* One call that adds a part: kind, definition, result. */
typedef struct dmb_described {
    const char *part;
    const void *definition; /* NULL with size 0: one such part a model */
    size_t size;
    uint32_t count;
} dmb_described;

void dmb_refused_remember(dmb_refusals *refused, const dmb_described *given, int32_t status,
                          const dmb_message *message);
/* A part was added: removes the oldest refusal of the same part. It is the same part if both definitions have the same
 * name; without names, if they differ in no more than one field. For parts that a model has once (wall, environment)
 * all refusals are removed. */
void dmb_refused_added(dmb_refusals *refused, const dmb_described *given);
/* DMB_OK, or the status and the message of the oldest refusal. */
int32_t dmb_refused_check(const dmb_refusals *refused, dmb_message *message);

/* ---- The description --------------------------------------------------------------------------------------------- */

/* A string and its description so far. */
typedef struct dmb_string_plan {
    dmb_string_def def;
    uint32_t pipes;     /* number of pipes of its runs so far */
    uint32_t continued; /* 1 + number of the string that continues it after a sub; 0: none */
} dmb_string_plan;

/* DMB_OK if no string continues this one, DMB_ERR_ORDER with a message about `part` if a sub does. */
int32_t dmb_string_is_open(dmb_model *model, const char *part, uint32_t string);

/* One call of dmb_model_add_pipes. */
typedef struct dmb_pipe_run {
    dmb_pipe_def def;
    uint32_t string; /* index of the string it lengthens */
    uint32_t first;  /* number of its first pipe along that string */
    uint32_t count;
    uint32_t reserved;
} dmb_pipe_run;

/* Coordinate k, 0 .. 3, of a coupling; none: joint {0, 0}. */
typedef struct dmb_coupled_coordinate {
    dmb_id joint;
    int32_t component;
    double ratio;            /* 1 of the first */
    const char *joint_field; /* for messages */
    const char *component_field;
    const char *ratio_field;
} dmb_coupled_coordinate;
dmb_coupled_coordinate dmb_coupled_coordinate_of(const dmb_coupling_def *def, uint32_t k);

/* A spring and its law; the table is the model's own copy. */
typedef struct dmb_spring_plan {
    dmb_spring_def def; /* its pointers are not used */
    dmb_spring_law law;
    dmb_spring_point *points; /* shape (law.count); NULL without a table */
} dmb_spring_plan;

/* A list that grows through the model's allocator. */
typedef struct dmb_list {
    void *items;
    uint32_t count, capacity;
} dmb_list;

struct dmb_model {
    uint32_t magic;
    uint32_t stamp;      /* generation of its ids, never 0 */
    atomic_uint holders; /* the caller and every live sim */
    atomic_uint owned;   /* 1 until the caller destroys it: later calls with a copied handle have no effect */
    uint32_t busy;       /* 1 during a call that describes or compiles it */
    dmb_allocator allocator;
    dmb_log_fn log;
    void *log_context;
    dmb_error_handler on_error;
    dmb_message message;
    dmb_environment_def environment;
    dmb_wall_def wall;       /* survey points to the model's own copy */
    uint32_t wall_count;     /* 0 or 1 */
    uint32_t constants;      /* [-] time functions of a compiled model that are not described */
    dmb_list sections;       /* dmb_hole_section, in the order of their depths */
    dmb_list time_functions; /* dmb_time_function, segments and tables are the model's own copies; of a compiled model
                                `constants` more behind those of the description, of drives without one */
    dmb_list names;          /* dmb_time_function_name, of named time functions */
    dmb_list strings;        /* dmb_string_plan */
    dmb_list runs;           /* dmb_pipe_run, in the order they were added */
    dmb_list bodies;         /* dmb_body_def */
    dmb_list bits;           /* dmb_bit_def */
    dmb_list drives;         /* dmb_drive_def */
    dmb_list loads;          /* dmb_load_def */
    dmb_list joints;         /* dmb_joint_def */
    dmb_list couplings;      /* dmb_coupling_def */
    dmb_list constraints;    /* dmb_constraint_def */
    dmb_list inputs;         /* dmb_input_def */
    dmb_list springs;        /* dmb_spring_plan */
    dmb_list events;         /* dmb_event_def */
    dmb_list forces;         /* dmb_force_def */
    dmb_list stuck;          /* dmb_stuck_def */
    dmb_list rings;          /* dmb_stabiliser_def */
    dmb_refusals refused;    /* refused parts that were not added later */
    dmb_scene *scene;        /* NULL until compiled, then never changed */
    uint32_t sparse_nodes;   /* smallest number of nodes of a sparse component: DMB_SPARSE_NODES, except in tests */
    uint32_t placed_without_hole; /* 1: parts behind a string that follows the hole were placed without a hole */
};

/* In the index of an id: first bit of the kind. */
enum { DMB_KIND_SHIFT = 24 };
/* Number of parts of a kind described so far. */
uint32_t dmb_model_part_count(const dmb_model *model, uint32_t kind);
/* The parts of an id, or DMB_NONE if it is not a part of that kind of this model. */
uint32_t dmb_model_part_index(const dmb_model *model, dmb_id id, uint32_t kind);
/* A sim adds, and releases, a reference to a compiled model. */
void dmb_model_hold(dmb_model *model);
void dmb_model_release(dmb_model *model);
/* Message of a call made by a callback of another call on the same model. */
void dmb_model_refuse_re_entry(dmb_model *model);

/* Common steps of all dmb_model_add_ functions: check the objects, read the caller's struct, append, create an id,
 * report to the log. */

/* DMB_OK for a model that may still be described and a definition that is there; the model is busy then until
 * dmb_describe_close. Errors: DMB_ERR_NULL, _HANDLE; _ORDER for a busy model, and for a compiled one, whose message
 * stays because other threads may be reading it. */
int32_t dmb_describe_open(dmb_model *model, const char *part, const void *def);
/* Ends a call: a failure without a message gets one, `part` before the text of the status, and is reported to the log.
 */
int32_t dmb_describe_close(dmb_model *model, const char *part, int32_t status);
/* Ends a call that adds a part: the same, and a refusal is stored, or removed if the part was added. */
int32_t dmb_describe_part(dmb_model *model, const dmb_described *part, int32_t status);
/* Of a kind with one definition a part; the size is that of the whole struct. */
static inline int32_t dmb_describe_end(dmb_model *model, const char *part, const void *definition, size_t size,
                                       int32_t status)
{
    const dmb_described given = {part, definition, size, 1};
    return dmb_describe_part(model, &given, status);
}

/* Appends an item. Errors: DMB_ERR_NO_MEMORY, DMB_ERR_TOO_LARGE; the list is as it was then. */
int32_t dmb_list_append(dmb_list *list, const dmb_allocator *allocator, const void *item, size_t item_size);
void dmb_list_release(dmb_list *list, const dmb_allocator *allocator, size_t item_size);
#define DMB_LIST_AT(T, list, i) ((T *)(list).items + (i))

/* The list of the parts of a kind; NULL: the wall, or no kind. */
const dmb_list *dmb_model_list(const dmb_model *model, uint32_t kind);
/* The id of a part; and an append that writes it to *id unless that is NULL. */
dmb_id dmb_model_id(const dmb_model *model, uint32_t kind, uint32_t index);
int32_t dmb_describe_append(dmb_model *model, dmb_list *list, const void *item, size_t item_size, uint32_t kind,
                            dmb_id *id);

/* Failing public calls that do not change the model: threads share a compiled model, which never changes, so each has
 * the failure of its own last call. */

/* A unique number: of a model for its ids, of a sim for its calls. Never 0. */
uint32_t dmb_new_stamp(void);
dmb_failed_object dmb_failed_model(const dmb_model *model);
/* Failure of a call with that text, or NULL for that of the status; the model may be NULL. Returns status. */
int32_t dmb_model_fail(const dmb_model *model, int32_t status, const char *call, const char *text);
/* The same for a query; a status that is no failure is returned unchanged. */
static inline int32_t dmb_model_failed(const dmb_model *model, const char *call, int32_t status)
{
    return status >= 0 ? status : dmb_model_fail(model, status, call, NULL);
}
/* From now on dmb_model_message is again that of the model. */
void dmb_model_failure_forget(const dmb_model *model);

/* ---- Names of parts ---------------------------------------------------------------------------------------------- */

/* A time function is an array of segments, which has no room for one. */
typedef struct dmb_time_function_name {
    uint32_t time_function;
    uint32_t reserved;
    char name[DMB_NAME_SIZE];
} dmb_time_function_name;

/* The word of a kind of parts in messages, "time function"; NULL for a number that is none. */
const char *dmb_part_word(uint32_t kind);

/* Fails the check where `name`, the field of that length, is no text or another part of the kind has it (0: no kind).
 */
void dmb_check_part_name(dmb_check *check, const dmb_model *model, uint32_t kind, const char *name);
/* Fails where other pipes have it; that it is text was checked. */
void dmb_check_pipes_name(dmb_check *check, const dmb_model *model, const char *name);

/* DMB_ERR_ID: no part has the name. */
int32_t dmb_model_refuse_name(const dmb_model *model, const char *word, const char *name);

/* The name of a part that is there; "". */
const char *dmb_part_name(const dmb_model *model, uint32_t kind, uint32_t index);
/* "string 0 (main)", "bit 0"; into text. */
const char *dmb_model_part_text(const dmb_model *model, uint32_t kind, uint32_t index, dmb_message *text);
/* The same by the word for its kind. */
const char *dmb_model_word_text(const dmb_model *model, const char *word, uint32_t index, dmb_message *text);
/* "string 0 (main), pipe 12 (collars)" */
const char *dmb_model_pipe_text(const dmb_model *model, uint32_t string, uint32_t pipe, dmb_message *text);
/* "pipes of string 0 (collars)": those added together. */
const char *dmb_pipes_text(dmb_message *text, uint32_t string, const dmb_pipe_def *def);

#endif
