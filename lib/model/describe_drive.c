/* Time functions, drives and loads: checks, and the model's own copies. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "constraint/joint.h"
#include "model/describe.h"
#include "model/field_check.h"
#include "model/model.h"

enum { SEGMENTS_MAX = 64, TABLE_MAX = 1 << 20 };

/* ---- Checks ------------------------------------------------------------------------------------------------------ */

static void check_ramp(dmb_check *check, const dmb_segment *segment)
{
    dmb_check_above_field(check, "x1", segment->x1, "x0", segment->x0);
    if (segment->x1 - segment->x0 < DMB_TIME_MIN)
        dmb_check_fail(check, DMB_ERR_VALUE, "x1", segment->x1, "> x0 by 1e-12 s");
}

/* Times increase, and no line between two points is so steep that its slope overflows. */
static void check_table(dmb_check *check, const dmb_segment *segment)
{
    const double *x = segment->table_time, *y = segment->table_value;
    dmb_check_count(check, "table_count", segment->table_count, 1, TABLE_MAX);
    dmb_check_pointer(check, "table_time", x);
    dmb_check_pointer(check, "table_value", y);
    if (check->status < 0) return;
    dmb_check_each_within(check, "table_time", x, segment->table_count, -DMB_TIME_MAX, DMB_TIME_MAX);
    dmb_check_each_within(check, "table_value", y, segment->table_count, -DMB_FORCE_MAX, DMB_FORCE_MAX);
    dmb_check_increasing(check, "table_time", x, segment->table_count, 1);
    for (uint32_t i = 1; i < segment->table_count && check->status == DMB_OK; ++i) {
        if (x[i] - x[i - 1] >= DMB_TIME_MIN) continue;
        dmb_check_fail(check, DMB_ERR_VALUE, "table_time", x[i], "> the time before by 1e-12 s");
    }
}

#define DMB_PERIOD_MIN 1e-6 /* [s] of a table that repeats: times up to 1e9 s find their place in it */

static void check_periodic(dmb_check *check, const dmb_segment *segment)
{
    const uint32_t last = segment->table_count - 1;
    dmb_check_count(check, "table_count", segment->table_count, 2, TABLE_MAX);
    if (check->status < 0) return;
    if (!(segment->table_time[last] - segment->table_time[0] >= DMB_PERIOD_MIN))
        dmb_check_fail(check, DMB_ERR_VALUE, "table_time", segment->table_time[last],
                       "the first time + the period, at least 1e-6 s");
    if (check->status >= 0 && segment->table_value[last] != segment->table_value[0])
        dmb_check_fail(check, DMB_ERR_VALUE, "table_value", segment->table_value[last],
                       "equal to the first value, with which the next period begins");
}

/* A segment per revolution follows a time function of this model, made of segments that are given by numbers alone:
 * eq:drive.per-revolution needs the angle, their integral, between any two times. */
static void check_per_revolution(dmb_check *check, const dmb_model *model, const dmb_segment *segment)
{
    dmb_check_id(check, model, "of", segment->of, DMB_PART_TIME_FUNCTION, "time function");
    dmb_check_within(check, "order", segment->order, DMB_ORDER_MIN, DMB_ORDER_MAX);
    if (check->status < 0) return;
    const dmb_time_function *of = DMB_LIST_AT(const dmb_time_function, model->time_functions,
                                              dmb_model_part_index(model, segment->of, DMB_PART_TIME_FUNCTION));
    for (uint32_t i = 0; i < of->count && check->status >= 0; ++i) {
        const int32_t kind = of->segments[i].kind;
        if (kind != DMB_SEGMENT_CALLBACK && kind != DMB_SEGMENT_PER_REVOLUTION) continue;
        check->status = DMB_ERR_UNSUPPORTED;
        dmb_message_set(check->message,
                        "%s %u: of: segment %u of that time function is of kind %s, must be CONSTANT, STEP, STEP5, "
                        "HARMONIC, TABLE or PERIODIC",
                        check->part, check->index, i, kind == DMB_SEGMENT_CALLBACK ? "CALLBACK" : "PER_REVOLUTION");
    }
}

static void check_callback(dmb_check *check, const dmb_segment *segment)
{
    dmb_check_mask(check, "provides", segment->provides, DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL);
    if (segment->callback != NULL || check->status < 0) return;
    check->status = DMB_ERR_NULL;
    dmb_message_set(check->message, "%s %u: callback is NULL", check->part, check->index);
}

static int has_table(const dmb_segment *segment)
{
    return segment->kind == DMB_SEGMENT_TABLE || segment->kind == DMB_SEGMENT_PERIODIC;
}

static void check_segment(dmb_check *check, const dmb_model *model, const dmb_segment *segment)
{
    if (segment->kind == DMB_SEGMENT_STEP || segment->kind == DMB_SEGMENT_STEP5) check_ramp(check, segment);
    if (has_table(segment)) check_table(check, segment);
    if (segment->kind == DMB_SEGMENT_PERIODIC && check->status >= 0) check_periodic(check, segment);
    if (segment->kind == DMB_SEGMENT_CALLBACK) check_callback(check, segment);
    if (segment->kind == DMB_SEGMENT_PER_REVOLUTION) check_per_revolution(check, model, segment);
}

/* ---- The caller's array ------------------------------------------------------------------------------------------ */

/* Segment i of the caller's array, whose items are as far apart as the first one says. All say the same. */
static int32_t read_segment(const dmb_segment *segments, uint32_t i, uint32_t stride, dmb_segment *out)
{
    const unsigned char *item = (const unsigned char *)segments + (size_t)i * stride;
    uint32_t size;
    memcpy(&size, item, sizeof size);
    *out = dmb_segment_default();
    return size == stride ? dmb_segment_read(out, item) : DMB_ERR_STRUCT_SIZE;
}

/* [double] Room of a segment behind the segments: both columns of a table, at most 64 x 2^21, or the time function that
 * it follows. */
static size_t numbers_of(const dmb_segment *segment)
{
    if (segment->kind == DMB_SEGMENT_PER_REVOLUTION) return sizeof(dmb_time_function) / sizeof(double);
    return has_table(segment) ? 2 * (size_t)segment->table_count : 0;
}

/* Checks every segment and counts the numbers behind them. */
static int32_t check_segments(dmb_model *model, const dmb_segment *segments, uint32_t count, size_t *numbers)
{
    dmb_message part;
    dmb_message_set(&part, "time function %u, segment", model->time_functions.count);
    *numbers = 0;
    for (uint32_t i = 0; i < count; ++i) {
        dmb_check check = dmb_check_of(&model->message, part.text, i);
        dmb_segment segment;
        int32_t status = read_segment(segments, i, segments->struct_size, &segment);
        if (status < 0) return status;
        dmb_check_fields(&check, model, DMB_FIELDS_OF(dmb_segment), &segment);
        if (check.status >= 0) check_segment(&check, model, &segment);
        if (check.status < 0) return check.status;
        *numbers += numbers_of(&segment);
    }
    return DMB_OK;
}

/* ---- The model's copy -------------------------------------------------------------------------------------------- */

static size_t block_size(uint32_t count, size_t numbers)
{
    return count * sizeof(dmb_segment) + numbers * sizeof(double); /* below 2^31 */
}

static double *copy_numbers(const double *from, uint32_t count, double *to)
{
    memcpy(to, from, count * sizeof *to);
    return to + count;
}

/* Fields that a segment does not use are cleared, so that no pointer of the caller is kept but the callback's context.
 */
static void forget_unused(dmb_segment *segment)
{
    if (!has_table(segment)) {
        segment->table_time = segment->table_value = NULL;
        segment->table_count = 0;
    }
    if (segment->kind != DMB_SEGMENT_CALLBACK) {
        segment->callback = NULL;
        segment->callback_context = NULL;
    }
    if (segment->kind != DMB_SEGMENT_PER_REVOLUTION) segment->of = (dmb_id){0, 0};
}

/* A copy of the time function that the segment follows: its segments stay where they are as long as the model lives.
 * The list of time functions may move when it grows, hence no pointer into it. */
static double *follow(const dmb_model *model, dmb_segment *segment, double *numbers)
{
    dmb_time_function *turning = (dmb_time_function *)(void *)numbers;
    *turning = *DMB_LIST_AT(const dmb_time_function, model->time_functions,
                            dmb_model_part_index(model, segment->of, DMB_PART_TIME_FUNCTION));
    segment->callback_context = turning;
    return numbers + numbers_of(segment);
}

static void copy_segments(const dmb_model *model, const dmb_segment *segments, uint32_t count, dmb_segment *copy)
{
    double *numbers = (double *)(void *)(copy + count);
    for (uint32_t i = 0; i < count; ++i) {
        dmb_segment *segment = copy + i;
        (void)read_segment(segments, i, segments->struct_size, segment);
        forget_unused(segment);
        if (segment->kind == DMB_SEGMENT_PER_REVOLUTION) numbers = follow(model, segment, numbers);
        if (!has_table(segment)) continue;
        double *values = copy_numbers(segment->table_time, segment->table_count, numbers);
        segment->table_time = numbers;
        numbers = copy_numbers(segment->table_value, segment->table_count, values);
        segment->table_value = values;
    }
}

void dmb_time_function_release(dmb_time_function *time_function, const dmb_allocator *allocator)
{
    void *block;
    size_t numbers = 0;
    for (uint32_t i = 0; i < time_function->count; ++i) numbers += numbers_of(&time_function->segments[i]);
    memcpy(&block, &time_function->segments, sizeof block); /* the model owns what others may only read */
    dmb_release(allocator, block, block_size(time_function->count, numbers));
    time_function->segments = NULL;
    time_function->count = 0;
}

static int32_t append_time_function(dmb_model *model, const dmb_segment *segments, uint32_t count, size_t numbers,
                                    dmb_id *id)
{
    dmb_time_function time_function = {NULL, count};
    int32_t status;
    dmb_segment *copy = dmb_allocate(&model->allocator, block_size(count, numbers));
    if (copy == NULL) return DMB_ERR_NO_MEMORY;
    copy_segments(model, segments, count, copy);
    time_function.segments = copy;
    status = dmb_describe_append(model, &model->time_functions, &time_function, sizeof time_function,
                                 DMB_PART_TIME_FUNCTION, id);
    if (status < 0) dmb_time_function_release(&time_function, &model->allocator);
    return status;
}

int32_t dmb_model_add_time_function(dmb_model *model, const dmb_segment *segments, uint32_t segment_count,
                                    dmb_id *time_function)
{
    dmb_segment first = dmb_segment_default();
    const dmb_described given = {"time function", &first, sizeof first, segment_count};
    int32_t status = dmb_describe_open(model, "time function", segments);
    size_t numbers;
    if (status < 0) return status;
    if (segment_count > 0) (void)read_segment(segments, 0, segments->struct_size, &first);
    dmb_check check = dmb_check_of(&model->message, "time function", model->time_functions.count);
    dmb_check_count(&check, "segment_count", segment_count, 1, SEGMENTS_MAX);
    status = check.status;
    if (status >= 0) status = check_segments(model, segments, segment_count, &numbers);
    if (status >= 0) status = append_time_function(model, segments, segment_count, numbers, time_function);
    return dmb_describe_part(model, &given, status);
}

int32_t dmb_model_add_ramp(dmb_model *model, double from, double to, double start, double end, dmb_id *time_function)
{
    dmb_segment ramp = dmb_segment_default();
    ramp.kind = DMB_SEGMENT_STEP5;
    ramp.h0 = from, ramp.h1 = to;
    ramp.x0 = start, ramp.x1 = end;
    return dmb_model_add_time_function(model, &ramp, 1, time_function);
}

/* A drive with a constant value gets a time function like all others, so that steps know one kind of drive
 * (dmb_model_compile). */
int32_t dmb_model_append_constant(dmb_model *model, double value, uint32_t *index)
{
    dmb_segment constant = dmb_segment_default();
    constant.h0 = value;
    const int32_t status = append_time_function(model, &constant, 1, 0, NULL);
    if (status >= 0) *index = model->time_functions.count - 1;
    return status;
}

void dmb_model_drop_time_functions(dmb_model *model, uint32_t count)
{
    while (model->time_functions.count > count) {
        --model->time_functions.count;
        dmb_time_function_release(DMB_LIST_AT(dmb_time_function, model->time_functions, model->time_functions.count),
                                  &model->allocator);
    }
}

/* ---- Drives ------------------------------------------------------------------------------------------------------ */

/* A body that is not fixed to a string. */
static void check_driven_body(dmb_check *check, const dmb_model *model, uint32_t body)
{
    const dmb_body_def *def = DMB_LIST_AT(const dmb_body_def, model->bodies, body);
    dmb_message name;
    if (check->status < 0 || def->attach == DMB_ATTACH_NONE) return;
    check->status = DMB_ERR_UNSUPPORTED;
    dmb_message_set(check->message, "%s: part = %s, must be a body of its own: drive the string it is fixed to",
                    check->part, dmb_part_text(&name, "body", body, def->name, sizeof def->name));
}

/* A coordinate that the joint leaves free, as far as its kind goes. */
static void check_driven_joint(dmb_check *check, const dmb_model *model, uint32_t joint, int32_t component)
{
    const dmb_joint_def *def = DMB_LIST_AT(const dmb_joint_def, model->joints, joint);
    dmb_message name, bound;
    if (check->status < 0 || (dmb_joint_free_mask(def->kind) >> component & 1) != 0) return;
    dmb_message_set(&bound, "free in the joint: %s", dmb_part_text(&name, "joint", joint, def->name, sizeof def->name));
    dmb_check_fail(check, DMB_ERR_VALUE, "component", component, bound.text);
}

static void check_driven_part(dmb_check *check, const dmb_model *model, const dmb_drive_def *def)
{
    const uint32_t body = dmb_model_part_index(model, def->part, DMB_PART_BODY);
    const uint32_t joint = dmb_model_part_index(model, def->part, DMB_PART_JOINT);
    if (body != DMB_NONE) {
        check_driven_body(check, model, body);
    } else if (joint != DMB_NONE) {
        check_driven_joint(check, model, joint, def->component);
    } else {
        dmb_check_id_or_none(check, model, "part", def->part, DMB_PART_STRING, "string, a body or a joint");
    }
}

/* ---- Actuators --------------------------------------------------------------------------------------------------- */

/* Columns of pairs whose first numbers increase by more than rounding. */
static void check_column(dmb_check *check, const char *field, const double *values, uint32_t count)
{
    dmb_check_increasing(check, field, values, count, 1);
    for (uint32_t i = 1; i < count && check->status >= 0; ++i)
        if (values[i] - values[i - 1] < DMB_SPEED_MIN)
            dmb_check_fail(check, DMB_ERR_VALUE, field, values[i], "> the one before, by 1e-12");
}

/* A table takes the place of the gain, and both given would leave open which one acts. */
static void check_gain_table(dmb_check *check, const dmb_drive_def *def)
{
    if (def->gain_count == 0) return;
    check_column(check, "gain_error", def->gain_error, def->gain_count);
    if (check->status >= 0 && def->gain > 0.0)
        dmb_check_fail(check, DMB_ERR_VALUE, "gain", def->gain, "0 with gain_count > 0, the table in its place");
    if (check->status >= 0 && def->kind != DMB_DRIVE_CONTROL)
        dmb_check_fail(check, DMB_ERR_UNSUPPORTED, "kind", def->kind, "DMB_DRIVE_CONTROL with gain_count > 0");
}

static void check_mud_pressure(dmb_check *check, const dmb_model *model, const dmb_drive_def *def)
{
    if (check->status < 0 || !(def->mud_pressure > 0.0)) return;
    if (def->component == DMB_RX && dmb_model_part_index(model, def->part, DMB_PART_JOINT) != DMB_NONE) return;
    dmb_check_fail(check, DMB_ERR_UNSUPPORTED, "mud_pressure", def->mud_pressure,
                   "0 but for component DMB_RX of a joint, the shaft of a motor");
}

/* The inertia turns with the part about its x axis; along and across it, and in joints, bodies have it. */
static void check_rotor(dmb_check *check, const dmb_model *model, const dmb_drive_def *def)
{
    if (check->status < 0 || !(def->inertia > 0.0)) return;
    if (def->component == DMB_RX && dmb_model_part_index(model, def->part, DMB_PART_JOINT) == DMB_NONE) return;
    dmb_check_fail(
        check, DMB_ERR_UNSUPPORTED, "inertia", def->inertia,
        "0 but of the component DMB_RX of a string or a body: give the body that moves its mass and inertia");
}

static void check_actuator(dmb_check *check, const dmb_model *model, const dmb_drive_def *def)
{
    check_column(check, "curve_speed", def->curve_speed, def->curve_count);
    check_rotor(check, model, def);
    if (check->status < 0 || def->kind != DMB_DRIVE_MOTION) return;
    if (!(def->delay > 0.0 || def->force_rate > 0.0 || def->lag > 0.0 || def->drag > 0.0 || def->back_drag > 0.0) &&
        def->curve_count == 0)
        return;
    check->status = DMB_ERR_UNSUPPORTED;
    dmb_message_set(check->message,
                    "%s: kind = %d, must be DMB_DRIVE_LOAD or _CONTROL with delay, force_rate, lag, drag or a curve: a "
                    "motion drive has the force that its motion takes",
                    check->part, (int)def->kind);
}

/* A time function, or a constant in its place. */
static void check_driven_value(dmb_check *check, const dmb_drive_def *def)
{
    if (check->status < 0 || dmb_id_is_none(def->time_function) || !(fabs(def->value) > 0.0)) return;
    dmb_check_fail(check, DMB_ERR_VALUE, "value", def->value, "0 with a time_function, which gives the value");
}

static void relate_drive(dmb_check *check, dmb_model *model, const void *part)
{
    const dmb_drive_def *def = part;
    check_driven_part(check, model, def);
    check_driven_value(check, def);
    dmb_check_above_field(check, "limit_high", def->limit_high, "limit_low", def->limit_low);
    check_gain_table(check, def);
    check_mud_pressure(check, model, def);
    check_actuator(check, model, def);
}

int32_t dmb_model_add_drive(dmb_model *model, const dmb_drive_def *def, dmb_id *drive)
{
    dmb_drive_def read = dmb_drive_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_drive_def), def, &read, relate_drive, drive);
}

int32_t dmb_model_add_load(dmb_model *model, const dmb_load_def *def, dmb_id *load)
{
    dmb_load_def read = dmb_load_def_default();
    return dmb_describe_add(model, DMB_FIELDS_OF(dmb_load_def), def, &read, NULL, load);
}
