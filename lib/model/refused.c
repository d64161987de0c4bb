/* Refused parts. A caller who overlooks a refusal would compile another scene than the one described, so the model
 * stores each refusal until the part is added or the caller discards it. */
#include "model/model.h"

#include <stdbool.h>
#include <string.h>

#include "drillmbd/scene.h"

/* ---- Fields of definitions --------------------------------------------------------------------------------------- */

/* A field longer than 8 bytes. Others are compared in steps of 8 bytes: a double, an id, or two whole numbers. */
typedef struct wide_field {
    const char *part;
    size_t begin, end;
    int is_name;
} wide_field;

#define FIELDS(part, T, first, last)                                            \
    {                                                                           \
        part, offsetof(T, first), offsetof(T, last) + sizeof(((T *)0)->last), 0 \
    }
#define FIELD(part, T, name) FIELDS(part, T, name, name)
#define NAME(part, T)                                                          \
    {                                                                          \
        part, offsetof(T, name), offsetof(T, name) + sizeof(((T *)0)->name), 1 \
    }

static const wide_field wide_fields[] = {
    FIELDS("time function", dmb_segment, table_time, table_count),
    NAME("string", dmb_string_def),
    FIELD("string", dmb_string_def, offset),
    FIELD("string", dmb_string_def, position),
    FIELD("string", dmb_string_def, rotation),
    FIELD("string", dmb_string_def, velocity),
    NAME("pipes", dmb_pipe_def),
    FIELD("pipes", dmb_pipe_def, joint_inertia),
    FIELD("pipes", dmb_pipe_def, curvature),
    FIELD("pipes", dmb_pipe_def, section_stiffness),
    FIELD("pipes", dmb_pipe_def, section_inertia),
    NAME("body", dmb_body_def),
    FIELD("body", dmb_body_def, centre),
    FIELD("body", dmb_body_def, inertia),
    FIELD("body", dmb_body_def, position),
    FIELD("body", dmb_body_def, rotation),
    FIELD("body", dmb_body_def, velocity),
    NAME("bit", dmb_bit_def),
    FIELD("bit", dmb_bit_def, inertia),
    NAME("joint", dmb_joint_def),
    FIELD("joint", dmb_joint_def, place_a),
    FIELD("joint", dmb_joint_def, place_b),
    FIELD("joint", dmb_joint_def, origin_a),
    FIELD("joint", dmb_joint_def, axis_a),
    FIELD("joint", dmb_joint_def, normal_a),
    FIELD("joint", dmb_joint_def, origin_b),
    FIELD("joint", dmb_joint_def, axis_b),
    FIELD("joint", dmb_joint_def, normal_b),
    FIELD("joint", dmb_joint_def, stiffness),
    FIELD("joint", dmb_joint_def, damping),
    FIELD("joint", dmb_joint_def, rest),
    FIELD("joint", dmb_joint_def, friction),
    FIELD("joint", dmb_joint_def, stop_low),
    FIELD("joint", dmb_joint_def, stop_high),
    FIELD("joint", dmb_joint_def, initial_position),
    FIELD("joint", dmb_joint_def, initial_speed),
    NAME("coupling", dmb_coupling_def),
    FIELD("coupling", dmb_coupling_def, joint),
    NAME("constraint", dmb_constraint_def),
    FIELD("constraint", dmb_constraint_def, place),
    NAME("drive", dmb_drive_def),
    FIELDS("drive", dmb_drive_def, curve_count, curve_force),
    NAME("load", dmb_load_def),
    FIELD("load", dmb_load_def, place),
    FIELD("load", dmb_load_def, force),
    FIELD("load", dmb_load_def, moment),
    NAME("input", dmb_input_def),
    FIELD("load", dmb_load_def, offset),
    NAME("force", dmb_force_def),
    FIELD("force", dmb_force_def, place),
    FIELD("force", dmb_force_def, offset),
    FIELD("force", dmb_force_def, component),
    NAME("stuck", dmb_stuck_def),
    FIELD("stuck", dmb_stuck_def, place),
    FIELD("stuck", dmb_stuck_def, stiffness),
    FIELD("stuck", dmb_stuck_def, damping),
    NAME("spring", dmb_spring_def),
    FIELD("spring", dmb_spring_def, place_a),
    FIELD("spring", dmb_spring_def, place_b),
    FIELD("spring", dmb_spring_def, offset_a),
    FIELD("spring", dmb_spring_def, offset_b),
    FIELDS("spring", dmb_spring_def, table_elongation, table_kind),
    NAME("stabiliser", dmb_stabiliser_def),
    FIELD("stabiliser", dmb_stabiliser_def, inertia),
    NAME("event", dmb_event_def),
    FIELD("event", dmb_event_def, output),
};

/* The largest definition fits; of a larger one only the beginning would be compared. */
typedef char joints_fit[sizeof(dmb_joint_def) <= DMB_REFUSED_BYTES ? 1 : -1];
typedef char constraints_fit[sizeof(dmb_constraint_def) <= DMB_REFUSED_BYTES ? 1 : -1];
typedef char pipes_fit[sizeof(dmb_pipe_def) <= DMB_REFUSED_BYTES ? 1 : -1];

/* The field of a definition that starts at or before `offset` and extends beyond it. */
static wide_field field_at(const char *part, size_t offset)
{
    wide_field field = {part, offset, offset + 8 - offset % 8, 0};
    for (size_t i = 0; i < sizeof wide_fields / sizeof wide_fields[0]; ++i) {
        const wide_field *wide = &wide_fields[i];
        if (strcmp(wide->part, part) == 0 && offset >= wide->begin && offset < wide->end) return *wide;
    }
    return field;
}

/* ---- The same part? ---------------------------------------------------------------------------------------------- */

static bool is_same_kind(const dmb_refusal *refusal, const dmb_described *given)
{
    return strcmp(refusal->part, given->part) == 0;
}

static const wide_field *name_of(const char *part)
{
    for (size_t i = 0; i < sizeof wide_fields / sizeof wide_fields[0]; ++i)
        if (wide_fields[i].is_name && strcmp(wide_fields[i].part, part) == 0) return &wide_fields[i];
    return NULL;
}

/* Compares two definitions of one size: by their names, or field by field if one has none. */
static bool is_same_part(const dmb_refusal *refusal, const dmb_described *given)
{
    const unsigned char *a = refusal->definition, *b = given->definition;
    uint32_t differ = refusal->count != given->count;
    size_t offset = 0;
    const wide_field *name = name_of(given->part);
    if (name != NULL && a[name->begin] != '\0' && b[name->begin] != '\0')
        return memcmp(a + name->begin, b + name->begin, name->end - name->begin) == 0;
    while (offset < given->size) {
        const wide_field field = field_at(given->part, offset);
        const size_t end = field.end < given->size ? field.end : given->size;
        const bool equal = memcmp(a + offset, b + offset, end - offset) == 0;
        differ += !equal;
        offset = end;
    }
    return differ <= 1;
}

/* ---- Remembered and forgotten ------------------------------------------------------------------------------------ */

void dmb_refused_remember(dmb_refusals *refused, const dmb_described *given, int32_t status, const dmb_message *message)
{
    if (refused->kept == DMB_REFUSED_KEPT) {
        refused->further += refused->further < UINT32_MAX;
        return;
    }
    dmb_refusal *refusal = &refused->first[refused->kept++];
    refusal->part = given->part;
    refusal->status = status;
    refusal->count = given->count;
    refusal->message = *message;
    refusal->size = status == DMB_ERR_STRUCT_SIZE || given->size > DMB_REFUSED_BYTES ? 0 : given->size;
    if (refusal->size > 0) memcpy(refusal->definition, given->definition, refusal->size);
}

/* Removes all refusals of a kind that a model has once. */
static void forget_kind(dmb_refusals *refused, const dmb_described *given)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < refused->kept; ++i)
        if (!is_same_kind(&refused->first[i], given)) refused->first[kept++] = refused->first[i];
    refused->kept = kept;
}

void dmb_refused_added(dmb_refusals *refused, const dmb_described *given)
{
    if (given->size == 0) {
        forget_kind(refused, given);
        return;
    }
    for (uint32_t i = 0; i < refused->kept; ++i) {
        const dmb_refusal *refusal = &refused->first[i];
        if (!is_same_kind(refusal, given)) continue;
        if (refusal->size != 0 && !is_same_part(refusal, given)) continue;
        --refused->kept;
        memmove(&refused->first[i], &refused->first[i + 1], (refused->kept - i) * sizeof refused->first[0]);
        return;
    }
}

int32_t dmb_refused_check(const dmb_refusals *refused, dmb_message *message)
{
    const uint32_t count = refused->kept + refused->further;
    if (count == 0) return DMB_OK;
    if (refused->kept == 0) {
        dmb_message_set(message, "%u refused parts missing: add them, or dmb_model_clear_refused to do without", count);
        return DMB_ERR_ORDER;
    }
    dmb_message_set(message, "%u refused part%s missing (add %s, or dmb_model_clear_refused to do without): %s", count,
                    count == 1 ? "" : "s", count == 1 ? "it" : "them", refused->first[0].message.text);
    return refused->first[0].status;
}
