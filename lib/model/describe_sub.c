/* Subs, bodies in the middle of a string, and the sections that continue the string after them: poses from the pipes
 * described so far (eq:kinematics.far-end). */
#include "base/memory.h"
#include "drillmbd/scene.h"
#include "force/hole.h"
#include "math/se3.h"
#include "model/describe.h"
#include "model/field_check.h"

typedef struct pose {
    double q[4], x[3];
} pose;

typedef struct string_end {
    pose start, end; /* of the string's rig end, and `length` beyond its far end */
    double distance; /* [m] along the string from one to the other */
    const dmb_string_def *def;
    uint32_t string; /* its number */
    uint32_t pipes;
    int32_t in_hole;
} string_end;

/* ---- Poses ------------------------------------------------------------------------------------------------------- */

/* p exp(d0), d0 the unstressed shape over a length. */
static void move_along(pose *p, double length, const double curvature[3])
{
    double d[6], q[4], x[3];
    dmb_vec3_set(length, 0.0, 0.0, d);
    dmb_vec3_scale(length, curvature, d + 3);
    dmb_se3_exp_to_quat(d, q, x);
    dmb_quat_rotate(p->q, x, x);
    dmb_vec3_add(p->x, x, p->x);
    dmb_quat_mul(p->q, q, p->q);
    dmb_quat_normalize(p->q);
}

/* Flexible lengths have their unstressed shape; tool joints, rigid and axial-torsional pipes without curvature are
 * straight. */
static void move_along_run(pose *p, const dmb_pipe_run *run)
{
    static const double straight[3] = {0.0, 0.0, 0.0};
    const dmb_pipe_def *def = &run->def;
    if (def->kind == DMB_PIPE_RIGID || !(dmb_vec3_norm(def->curvature) > 0.0)) {
        move_along(p, run->count * def->length, straight);
        return;
    }
    for (uint32_t i = 0; i < run->count; i++) {
        move_along(p, def->length - def->joint_length, def->curvature);
        move_along(p, def->joint_length, straight);
    }
}

/* Without a hole: eq:kinematics.far-end, pipe by pipe, then straight on by the length of the sub. The order matters,
 * because unstressed curvatures do not commute. */
static void on_its_own(const dmb_model *model, double length, string_end *b)
{
    static const double straight[3] = {0.0, 0.0, 0.0};
    dmb_quat_exp(b->def->rotation, b->start.q);
    dmb_quat_normalize(b->start.q);
    dmb_vec3_copy(b->def->position, b->start.x);
    b->end = b->start;
    for (uint32_t i = 0; i < model->runs.count; i++) {
        const dmb_pipe_run *run = DMB_LIST_AT(const dmb_pipe_run, model->runs, i);
        if (run->string == b->string) move_along_run(&b->end, run);
    }
    move_along(&b->end, length, straight);
}

static void hole_pose(const dmb_hole *hole, const dmb_string_def *def, double depth, pose *p)
{
    double R[9], shift[3] = {0.0, def->offset[0], def->offset[1]};
    dmb_hole_frame(hole, depth, p->x, NULL, NULL);
    dmb_hole_frame_rotation(hole, depth, R);
    dmb_quat_from_matrix(R, p->q);
    dmb_quat_normalize(p->q);
    dmb_quat_rotate(p->q, shift, shift);
    dmb_vec3_add(p->x, shift, p->x);
}

static int32_t refuse_survey(dmb_model *model)
{
    dmb_message_set(&model->message,
                    "sub: the survey of the hole turns too much between two stations, must be one that "
                    "dmb_model_compile takes; mend it");
    return DMB_ERR_GEOMETRY;
}

/* In the frames of the hole; those of the nodes do not turn with them about the axis, which joints that match take up.
 */
static int32_t in_hole(dmb_model *model, string_end *b)
{
    const dmb_wall_def *wall = &model->wall;
    const size_t size = wall->survey_count * sizeof(dmb_hole_station);
    dmb_hole hole = {0};
    dmb_hole_station *stations = NULL;
    int32_t status = DMB_OK;
    if (wall->survey_count == 0) {
        status = dmb_hole_setup_straight(&hole, wall->origin, wall->direction, 0.5 * wall->diameter);
    } else {
        stations = dmb_allocate(&model->allocator, size);
        if (stations == NULL) return DMB_ERR_NO_MEMORY;
        if (dmb_hole_setup_survey(&hole, wall->survey_count, wall->survey, wall->origin, 0.5 * wall->diameter,
                                  stations) >= 0)
            status = refuse_survey(model);
    }
    if (status >= 0) {
        hole_pose(&hole, b->def, b->def->start_depth, &b->start);
        hole_pose(&hole, b->def, b->def->start_depth + b->distance, &b->end);
    }
    if (stations != NULL) dmb_release(&model->allocator, stations, size);
    return status;
}

/* The string moves as one rigid body: v + w x r, in the axes of the end. */
static void velocity_at(const string_end *b, double velocity[6])
{
    const double *v = b->def->velocity;
    double r[3], turned[3];
    dmb_vec3_sub(b->end.x, b->start.x, r);
    dmb_quat_rotate_inverse(b->start.q, r, r);
    dmb_vec3_cross(v + 3, r, turned);
    dmb_vec3_add(v, turned, turned);
    dmb_quat_rotate(b->start.q, turned, velocity);
    dmb_quat_rotate(b->start.q, v + 3, velocity + 3);
    dmb_quat_rotate_inverse(b->end.q, velocity, velocity);
    dmb_quat_rotate_inverse(b->end.q, velocity + 3, velocity + 3);
}

/* ---- The end of the pipes so far --------------------------------------------------------------------------------- */

static int32_t check_string(dmb_model *model, dmb_id string, double length, string_end *b)
{
    dmb_check check = dmb_check_of(&model->message, "sub", DMB_NONE);
    dmb_check_id_or_none(&check, model, "string", string, DMB_PART_STRING, "string");
    dmb_check_within(&check, "length", length, 0.0, DMB_LENGTH_MAX);
    if (check.status < 0) return check.status;
    b->string = dmb_id_is_none(string) ? 0 : dmb_model_part_index(model, string, DMB_PART_STRING);
    if (b->string >= model->strings.count) {
        dmb_message_set(&model->message, "sub: the model has 0 strings, must have 1 or more; add the string first");
        return DMB_ERR_ORDER;
    }
    const dmb_string_plan *plan = DMB_LIST_AT(const dmb_string_plan, model->strings, b->string);
    b->def = &plan->def;
    b->pipes = plan->pipes;
    if (plan->pipes > 0) return DMB_OK;
    dmb_message_set(&model->message, "sub: string %u has 0 pipes so far, must have 1 or more; add its pipes first",
                    b->string);
    return DMB_ERR_ORDER;
}

static int32_t find(dmb_model *model, dmb_id string, double length, string_end *b)
{
    const int32_t status = check_string(model, string, length, b);
    if (status < 0) return status;
    b->distance = length;
    for (uint32_t i = 0; i < model->runs.count; i++) {
        const dmb_pipe_run *run = DMB_LIST_AT(const dmb_pipe_run, model->runs, i);
        if (run->string == b->string) b->distance += run->count * run->def.length;
    }
    b->in_hole = b->def->follows_hole && model->wall_count > 0;
    if (b->in_hole) return in_hole(model, b);
    on_its_own(model, length, b);
    if (b->def->follows_hole) model->placed_without_hole = 1;
    return DMB_OK;
}

static void rotation_of(const string_end *b, double rotation[3])
{
    dmb_quat_log(b->end.q, rotation);
}

/* The section begins free in all components (the joints hold it), at the measured depth at which the first string and
 * the sub end, so that both have the same wall and the same depths. */
static void place_section(const string_end *b, dmb_string_def *section)
{
    section->follows_hole = b->in_hole;
    section->start_free = DMB_FREE_ALL;
    section->start_depth = b->in_hole ? b->def->start_depth + b->distance : 0.0;
    for (int k = 0; k < 2; k++) section->offset[k] = b->in_hole ? b->def->offset[k] : 0.0;
    dmb_vec3_copy(b->end.x, section->position);
    rotation_of(b, section->rotation);
    velocity_at(b, section->velocity);
}

static void place_body(const string_end *b, dmb_body_def *body)
{
    body->attach = DMB_ATTACH_NONE;
    dmb_vec3_copy(b->end.x, body->position);
    rotation_of(b, body->rotation);
    velocity_at(b, body->velocity);
}

static int32_t fill(const string_end *b, dmb_body_def *body, dmb_string_def *section)
{
    dmb_body_def placed = dmb_body_def_default();
    dmb_string_def begun = dmb_string_def_default();
    int32_t status = DMB_OK;
    if (body != NULL) status = dmb_body_def_read(&placed, body);
    if (status >= 0 && section != NULL) status = dmb_string_def_read(&begun, section);
    if (status < 0) return status;
    place_body(b, &placed);
    place_section(b, &begun);
    if (body != NULL) status = dmb_body_def_write(body, &placed);
    if (status >= 0 && section != NULL) status = dmb_string_def_write(section, &begun);
    return status;
}

int32_t dmb_model_place_at_end(dmb_model *model, dmb_id string, double length, dmb_body_def *body,
                               dmb_string_def *section)
{
    string_end b = {.string = 0};
    int32_t status = dmb_describe_open(model, "sub", body != NULL ? (const void *)body : (const void *)section);
    if (status < 0) return status;
    status = find(model, string, length, &b);
    if (status >= 0) status = fill(&b, body, section);
    return dmb_describe_close(model, "sub", status);
}

/* ---- All of it --------------------------------------------------------------------------------------------------- */

static int32_t refuse_bit(dmb_model *model, uint32_t string, uint32_t bit)
{
    dmb_message_set(&model->message,
                    "sub: string %u ends with bit %u, must end with a pipe; give the bit to the last section", string,
                    bit);
    return DMB_ERR_ORDER;
}

/* A string is continued by one sub at most, and has its bit at the end of the last part. */
static int32_t check_end(dmb_model *model, uint32_t string)
{
    const int32_t status = dmb_string_is_open(model, "sub", string);
    if (status < 0) return status;
    for (uint32_t i = 0; i < model->bits.count; i++) {
        const dmb_id of = DMB_LIST_AT(const dmb_bit_def, model->bits, i)->string;
        if ((dmb_id_is_none(of) ? 0 : dmb_model_part_index(model, of, DMB_PART_STRING)) == string)
            return refuse_bit(model, string, i);
    }
    return DMB_OK;
}

/* The end of the string so far as a place, where nothing holds it yet. */
static int32_t far_end(dmb_model *model, dmb_id string, dmb_place *place)
{
    string_end b = {.string = 0};
    int32_t status = dmb_describe_open(model, "sub", place);
    if (status < 0) return status;
    status = check_string(model, string, 0.0, &b);
    if (status >= 0) status = check_end(model, b.string);
    if (status >= 0 && dmb_free_set(b.def->end_free) != DMB_SET_ALL) {
        dmb_message_set(&model->message,
                        "sub: end_free of string %u holds the end that the sub continues, must be DMB_FREE_ALL; give "
                        "it to the section",
                        b.string);
        status = DMB_ERR_VALUE;
    }
    if (status >= 0) *place = dmb_station(dmb_model_id(model, DMB_PART_STRING, b.string), b.pipes - 1, 1.0);
    return dmb_describe_close(model, "sub", status);
}

/* A joint whose frame b is where frame a is; fixed where none is given. Frame a counts from `along` on the x axis. */
static int32_t join(dmb_model *model, const dmb_joint_def *given, dmb_place a, double along, dmb_place b, dmb_id *joint)
{
    dmb_joint_def def = dmb_joint_def_default();
    if (given != NULL) {
        const int32_t status = dmb_joint_def_read(&def, given);
        if (status < 0) return status;
    }
    def.place_a = a;
    def.place_b = b;
    def.origin_a[0] += along;
    def.match = 1;
    return dmb_model_add_joint(model, &def, joint);
}

/* Poses of body and section are computed before either is added: both count from the end of the pipes described so far.
 * The body is joined at its reference point on both sides, the second joint a length further on its x axis. */
static int32_t add_all(dmb_model *model, const dmb_sub_def *def, dmb_sub *made)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_string_def section = dmb_string_def_default();
    dmb_place end = dmb_station((dmb_id){0, 0}, 0, 0.0);
    int32_t status = DMB_OK;
    if (def->body != NULL) status = dmb_body_def_read(&body, def->body);
    if (status >= 0 && def->section != NULL) status = dmb_string_def_read(&section, def->section);
    if (status >= 0) status = far_end(model, def->string, &end);
    made->end = end;
    if (status >= 0) status = dmb_model_place_at_end(model, end.part, 0.0, &body, NULL);
    if (status >= 0) status = dmb_model_place_at_end(model, end.part, def->length, NULL, &section);
    if (status >= 0) status = dmb_model_add_body(model, &body, &made->body);
    if (status >= 0) status = dmb_model_add_string(model, &section, &made->section);
    if (status < 0) return status;
    const dmb_place at_body = dmb_station(made->body, 0, 0.0), at_section = dmb_station(made->section, 0, 0.0);
    status = join(model, def->before, end, 0.0, at_body, &made->before);
    return status < 0 ? status : join(model, def->after, at_body, def->length, at_section, &made->after);
}

DMB_DECLARE_STRUCT(dmb_sub)
DMB_DEFINE_INIT(dmb_sub, 64, {.reserved = 0})

/* Parts of a model that a call may have added when it fails. */
typedef struct extent {
    uint32_t bodies, strings, joints, refused, further;
} extent;

static extent extent_of(const dmb_model *model)
{
    return (extent){model->bodies.count, model->strings.count, model->joints.count, model->refused.kept,
                    model->refused.further};
}

/* A sub is four parts of the description, and a call that fails has added none. Lists grow at their ends only and own
 * nothing beyond their items here, so that their numbers alone undo it. */
static void take_back(dmb_model *model, const extent *before)
{
    model->bodies.count = before->bodies;
    model->strings.count = before->strings;
    model->joints.count = before->joints;
    model->refused.kept = before->refused;
    model->refused.further = before->further;
}

/* One refusal is remembered, that of the sub, with the message of what was wrong with it. */
static int32_t end_sub(dmb_model *model, const dmb_sub_def *def, const extent *before, int32_t status)
{
    const dmb_described given = {"sub", def, sizeof *def, 1};
    if (status >= 0) {
        dmb_refused_added(&model->refused, &given);
        return status;
    }
    take_back(model, before);
    dmb_refused_remember(&model->refused, &given, status, &model->message);
    return status;
}

int32_t dmb_model_add_sub(dmb_model *model, const dmb_sub_def *def, dmb_sub *sub)
{
    dmb_sub_def read = dmb_sub_def_default();
    dmb_sub made = dmb_sub_default();
    if (model == NULL || sub == NULL) return DMB_ERR_NULL;
    int32_t status = dmb_describe_open(model, "sub", def);
    if (status < 0) return status;
    const extent before = extent_of(model);
    status = dmb_sub_def_read(&read, def);
    if (status >= 0) status = dmb_sub_read(&made, sub);
    status = dmb_describe_close(model, "sub", status);
    if (status >= 0) status = add_all(model, &read, &made);
    status = end_sub(model, &read, &before, status);
    if (status < 0) return status;
    const uint32_t from = dmb_model_part_index(model, made.end.part, DMB_PART_STRING);
    DMB_LIST_AT(dmb_string_plan, model->strings, from)->continued =
        1 + dmb_model_part_index(model, made.section, DMB_PART_STRING);
    return dmb_sub_write(sub, &made);
}
