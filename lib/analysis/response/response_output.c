/* Outputs as linear functions of the motion (section after eq:response.direct), by kind:
 *
 *     motion               row of the place, differentiated `rate` times
 *     section force        differences of the query, which is smooth in the motion around the section
 *     contact              chain rule: dN = N_d dd + N_r dr, dF = F_v dv + F_N dN   (depth d, its rate r, slip v)
 *     law of a joint       chain rule: dF = F_x dx + F_v dx'
 *     support              constrained rows of A x - f
 *     multiplier, joint    multipliers, which balance the dependent rows
 *     drive                its law by the motion, and its direct part if it is the excitation
 *
 * Contacts and laws of joints are not smooth over the step of a difference, hence the chain rule. */
#include "analysis/response/response.h"

#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "drillmbd/ask.h"
#include "query/query.h"
#include "sim/node.h"
#include "system/assemble/assemble.h"
#include "system/assemble/drives.h"
#include "system/constrain/constrain.h"

typedef struct request {
    dmb_linear *linear;
    dmb_sim *copy;
    const dmb_response_options *options;
    const dmb_output *given;
    const dmb_asked_output *output;
    dmb_linear_output *out;
    uint32_t index;
    dmb_message *message;
} request;

static int32_t refuse(const request *r, int32_t status, const char *why)
{
    dmb_output_refuse(r->copy->model, r->given, r->index, why, r->message);
    return status;
}

static int32_t refuse_place(const request *r, int32_t status)
{
    dmb_output_explain(r->copy->model, r->given, r->index, status, r->message);
    return status;
}

/* ---- Motion, section --------------------------------------------------------------------------------------------- */

static double answer(const dmb_sim *copy, const void *what)
{
    int32_t status;
    return dmb_answer_of(copy, what, &status);
}

static int32_t of_motion(const request *r)
{
    const dmb_asked_output *o = r->output;
    const int32_t status = dmb_functional_of_motion(r->copy, o->place, o->frame, o->component, &r->out->functional);
    r->out->rate = o->kind;
    return status < 0 ? refuse_place(r, status) : DMB_OK;
}

/* The query is tried once before its differences: it refuses places that have no section. */
static int32_t of_section(const request *r)
{
    int32_t status;
    (void)dmb_answer_of(r->copy, r->output, &status);
    if (status >= 0) status = dmb_functional_around(r->copy, r->output->place, &r->out->functional);
    if (status < 0) return refuse_place(r, status);
    r->out->elastic = r->output->kind != DMB_ASKED_SECTION_STRAIN;
    dmb_functional_of_answer(r->linear, answer, r->output, &r->out->functional);
    return DMB_OK;
}

/* ---- Contact ----------------------------------------------------------------------------------------------------- */

/* Requested quantity of a contact. */
enum { ASK_APPROACH = 1, ASK_SLIP = 2, ASK_NORMAL = 4 };
typedef struct contact_question {
    uint32_t site;
    int32_t what;
} contact_question;

static double contact_answer(const dmb_sim *copy, const void *what)
{
    const contact_question *q = what;
    dmb_contact contact = dmb_contact_default();
    (void)dmb_answer_contact(copy, q->site, &contact);
    if (q->what == ASK_APPROACH) return contact.approach;
    return q->what == ASK_NORMAL ? contact.normal_force : contact.slip[q->what - ASK_SLIP];
}

static void ask_contact(const request *r, int32_t what, dmb_functional *out)
{
    const contact_question q = {r->output->place.pipe, what};
    *out = r->out->functional;
    dmb_functional_of_answer(r->linear, contact_answer, &q, out);
}

/* A gap changes by -n dp. With differences, n would be the normal of a chord, and motion along a stiff wall would press
 * on it by its small component across the true n. */
static void gap_of(const request *r, dmb_functional *out)
{
    const dmb_sim *copy = r->copy;
    const uint32_t site = r->output->place.pipe;
    double R[9], w[6] = {0.0}, *rows = copy->residual; /* free by now */
    dmb_site_axes(copy->scene, &copy->now, site, R);
    dmb_mat3_tvec(R, copy->trial.site_normal + 3 * (size_t)site, w);
    memset(rows, 0, copy->scene->row_count * sizeof *rows);
    dmb_site_add_wrench(copy->scene, &copy->now, site, -1.0, w, rows);
    *out = r->out->functional;
    for (uint32_t i = 0; i < out->count; i++) out->pose[i] = rows[out->row[i]];
}

/* Rows without numbers. */
static void add_site(const request *r, uint32_t site)
{
    const dmb_scene *scene = r->copy->scene;
    const uint32_t node = dmb_contact_node(scene, site);
    dmb_functional_add_node(scene, node, &r->out->functional);
    if (dmb_is_inside(scene, site)) dmb_functional_add_node(scene, node + 1, &r->out->functional);
    if (site < scene->site_count) return;
    if (node > 0) dmb_functional_add_node(scene, node - 1, &r->out->functional);
    if (node + 1 < scene->node_count) dmb_functional_add_node(scene, node + 1, &r->out->functional);
}

static void normal_force(const request *r, const dmb_contact_slope *slope, dmb_functional *out)
{
    const dmb_scene *scene = r->copy->scene;
    const uint32_t site = r->output->place.pipe;
    dmb_functional part;
    if (site >= scene->site_count) {
        ask_contact(r, ASK_NORMAL, out);
        return;
    }
    *out = r->out->functional;
    gap_of(r, &part);
    dmb_functional_add(-slope->normal_by_depth, &part, out);
    if (r->options->contact == DMB_CONTACT_CLOSED)
        dmb_functional_add(-dmb_linear_wall_stiffness(r->linear, site, r->options->contact_gap), &part, out);
    ask_contact(r, ASK_APPROACH, &part);
    dmb_functional_add(slope->normal_by_rate, &part, out);
}

/* Slips of axial-torsional nodes are their own speeds. */
static void slip(const request *r, int32_t direction, dmb_functional *out)
{
    const dmb_scene *scene = r->copy->scene;
    const uint32_t site = r->output->place.pipe;
    if (site < scene->site_count) {
        ask_contact(r, ASK_SLIP + direction, out);
        return;
    }
    *out = r->out->functional;
    out->speed[direction] = direction == 0 ? 1.0 : scene->axial_torsional_sites[site - scene->site_count].radius;
}

static void friction(const request *r, int32_t direction, const dmb_contact_slope *slope, const dmb_functional *normal,
                     dmb_functional *out)
{
    dmb_functional part;
    *out = r->out->functional;
    dmb_functional_add(slope->friction_by_normal[direction], normal, out);
    for (int32_t k = 0; k < 2; k++) {
        slip(r, k, &part);
        dmb_functional_add(slope->friction_by_slip[2 * direction + k], &part, out);
    }
}

static int32_t of_contact(const request *r)
{
    const dmb_scene *scene = r->copy->scene;
    const int32_t c = r->output->component;
    dmb_contact_slope slope;
    dmb_functional normal, along;
    if (r->options->contact == DMB_CONTACT_OPEN)
        return refuse(r, DMB_ERR_UNSUPPORTED, "contact is left out, its forces do not change");
    if (r->output->place.pipe >= (uint64_t)scene->site_count + scene->axial_torsional_site_count)
        return refuse(r, DMB_ERR_VALUE, "place.pipe is no number of a contact point");
    if (c != DMB_Z && dmb_scene_has_bristles(scene))
        return refuse(r, DMB_ERR_UNSUPPORTED, "friction of bristles is not an output");
    dmb_contact_slope_of(scene, &r->copy->now, r->output->place.pipe, &slope);
    add_site(r, r->output->place.pipe);
    r->out->elastic = 1;
    normal_force(r, &slope, &normal);
    if (c != DMB_Z) friction(r, c, &slope, &normal, &along);
    r->out->functional = c == DMB_Z ? normal : along;
    return DMB_OK;
}

/* ---- Forces of supports and constraints ----------------------------------------------------------------------------
 */

static void set_cluster_of_node(const request *r, uint32_t node)
{
    const dmb_scene *scene = r->copy->scene;
    if (scene->cluster_count > 0) r->out->cluster = scene->node_cluster[node];
}

/* The cluster of the node is noted: reactions of joints act in the same row. */
static void set_support(const request *r, uint32_t held, double weight)
{
    r->out->support[r->out->support_count] = held;
    r->out->support_weight[r->out->support_count++] = weight;
    set_cluster_of_node(r, r->copy->scene->constrained_node[held]);
}

/* The query is linear in the residual of constrained rows. */
static int32_t of_support(const request *r)
{
    const dmb_scene *scene = r->copy->scene;
    int32_t status;
    const double base = dmb_answer_of(r->copy, r->output, &status);
    if (status < 0) return refuse(r, status, "place.part names no string or body of this model");
    for (uint32_t i = 0; i < scene->constrained_count && r->out->support_count < 6; i++) {
        double *left = r->copy->support_reaction + i, kept = *left;
        const double scale = fmax(fabs(base), 1.0);
        *left += scale;
        const double weight = (dmb_answer_of(r->copy, r->output, &status) - base) / scale;
        *left = kept;
        if (weight != 0.0) set_support(r, i, weight);
    }
    return DMB_OK;
}

static void set_multiplier(const request *r, uint32_t constraint, uint32_t k, double weight)
{
    const dmb_scene *scene = r->copy->scene;
    const dmb_constraint *c = scene->constraints + constraint;
    r->out->cluster = c->cluster;
    r->out->multiplier = c->row - scene->clusters[c->cluster].row;
    r->out->multiplier_weight[k] = weight;
    r->out->multiplier_count = k + 1;
}

static int32_t of_multiplier(const request *r)
{
    int32_t status;
    (void)dmb_answer_of(r->copy, r->output, &status);
    if (status < 0)
        return refuse(r, status, "place.part must be a joint, coupling, constraint or joint drive with that row");
    set_multiplier(r, dmb_constraint_of_part(r->copy, r->output->place.part), (uint32_t)r->output->component, 1.0);
    return DMB_OK;
}

/* ---- Joints ------------------------------------------------------------------------------------------------------ */

static uint32_t joint_of(const request *r)
{
    return dmb_model_part_index(r->copy->model, r->output->place.part, DMB_PART_JOINT);
}

static const dmb_constraint *add_joint_nodes(const request *r, uint32_t j, dmb_functional *out)
{
    const dmb_scene *scene = r->copy->scene;
    const dmb_constraint *c = scene->constraints + scene->joints[j].constraint;
    for (uint32_t i = 0; i < c->node_count; i++) dmb_functional_add_node(scene, c->node[i], out);
    return c;
}

/* Rate of a coordinate J V, V the velocity of frame b relative to frame a. */
static void coordinate(const request *r, uint32_t j, int32_t component, dmb_functional *out)
{
    const dmb_sim *copy = r->copy;
    const dmb_constraint *c = add_joint_nodes(r, j, out);
    double row[DMB_CONSTRAINT_COLUMNS] = {0.0};
    dmb_relative relative;
    dmb_joint_coordinates at;
    dmb_joint_motion_of(copy->scene, &copy->now, j, &relative, NULL);
    dmb_joint_coordinates_at(relative.R, relative.p, relative.V, copy->now.joint_turn + 2 * (size_t)j, &at);
    dmb_add_joint_row(copy->scene, c, j, &relative, 1.0, at.J[component], row);
    memcpy(out->pose, row, out->count * sizeof(double));
}

/* by position and by speed, dF = F_x dx + F_v dx' */
static void law_of_joint(const request *r, uint32_t j)
{
    const dmb_scene_joint *joint = r->copy->scene->joints + j;
    const int32_t c = r->output->component;
    const dmb_functional *none = &r->out->functional;
    dmb_joint_state state = dmb_joint_state_default();
    dmb_functional position = *none;
    dmb_joint_force force;
    coordinate(r, j, c, &position);
    (void)add_joint_nodes(r, j, &r->out->functional);
    if (joint->law == DMB_NONE || (joint->law_mask >> c & 1) == 0 || r->copy->joint_state[j] == DMB_JOINT_OPEN) return;
    (void)dmb_answer_joint(r->copy, r->output->place.part, &state);
    dmb_joint_force_at(r->copy->scene->laws + joint->law + c, state.position[c], state.speed[c], &force);
    dmb_functional_add(force.by_position, &position, &r->out->functional);
    dmb_functional_add_rate(force.by_speed, &position, &r->out->functional);
}

/* Linear in the multipliers, and rotating with the bodies. */
static void reaction_of_joint(const request *r, uint32_t j)
{
    const dmb_constraint *c = add_joint_nodes(r, j, &r->out->functional);
    int32_t status;
    const double base = dmb_answer_of(r->copy, r->output, &status), step = fmax(fabs(base), 1.0);
    dmb_functional_of_answer(r->linear, answer, r->output, &r->out->functional);
    for (uint32_t k = 0; k < c->rows; k++) {
        double *f = r->copy->now.multiplier + c->row + k;
        const double kept = *f;
        *f = kept + step;
        set_multiplier(r, r->copy->scene->joints[j].constraint, k,
                       (dmb_answer_of(r->copy, r->output, &status) - base) / step);
        *f = kept;
    }
}

static int32_t of_joint(const request *r)
{
    int32_t status;
    (void)dmb_answer_of(r->copy, r->output, &status);
    if (status < 0) return refuse(r, status, "place.part names no joint of this model");
    r->out->elastic = r->output->kind > DMB_ASKED_JOINT_ACCELERATION;
    if (r->output->kind == DMB_ASKED_JOINT_REACTION)
        reaction_of_joint(r, joint_of(r));
    else if (r->output->kind == DMB_ASKED_JOINT_ACTION)
        law_of_joint(r, joint_of(r));
    else
        coordinate(r, joint_of(r), r->output->component, &r->out->functional);
    if (!r->out->elastic) r->out->rate = r->output->kind - DMB_ASKED_JOINT_POSITION;
    return DMB_OK;
}

/* ---- Drives, bits ------------------------------------------------------------------------------------------------ */

/* A drive of an open joint. */
static int without_effect(const request *r, const dmb_scene_drive *drive)
{
    return drive->joint != DMB_NONE && r->copy->joint_state[drive->joint] == DMB_JOINT_OPEN;
}

/* kp (v* - v) + ki integral(v* - v); no change at its limits. */
static void control(const request *r, uint32_t i, const dmb_scene_drive *drive)
{
    const double force = r->copy->now.drives[i].force;
    double room;
    const double gain = dmb_drive_gain(r->copy->scene, &r->copy->now, i, &room);
    dmb_functional position;
    memset(&position, 0, sizeof position);
    if (force <= drive->limit_low || force >= drive->limit_high) return;
    if (without_effect(r, drive)) return;
    if (drive->joint != DMB_NONE) {
        coordinate(r, drive->joint, drive->component, &position);
    } else {
        dmb_functional_add_node(r->copy->scene, drive->node, &position);
        position.pose[drive->row - r->copy->scene->layout.row[drive->node]] = 1.0;
    }
    r->out->functional = position;
    memset(r->out->functional.pose, 0, sizeof position.pose);
    dmb_functional_add(-drive->integral_gain, &position, &r->out->functional);
    dmb_functional_add_rate(-gain, &position, &r->out->functional);
    r->out->direct = gain;
    r->out->integral = drive->integral_gain;
}

static int32_t of_drive(const request *r)
{
    const dmb_scene *scene = r->copy->scene;
    const uint32_t i = dmb_model_part_index(r->copy->model, r->output->place.part, DMB_PART_DRIVE);
    if (i >= scene->drive_count) return refuse(r, DMB_ERR_ID, "place.part names no drive of this model");
    const dmb_scene_drive *drive = scene->drives + i;
    r->out->drive = i;
    r->out->direct = drive->kind == DMB_DRIVE_LOAD && !without_effect(r, drive);
    if (drive->kind == DMB_DRIVE_CONTROL) control(r, i, drive);
    if (drive->kind != DMB_DRIVE_MOTION) return DMB_OK;
    if (drive->joint != DMB_NONE) {
        set_multiplier(r, drive->constraint, 0, -1.0);
        return DMB_OK;
    }
    for (uint32_t h = 0; h < scene->constrained_count; h++)
        if (dmb_constrained_row(scene, h) == drive->row) set_support(r, h, 1.0);
    return DMB_OK;
}

static int32_t of_bit(const request *r)
{
    const dmb_scene *scene = r->copy->scene;
    const uint32_t k = dmb_model_part_index(r->copy->model, r->output->place.part, DMB_PART_BIT);
    dmb_functional *out = &r->out->functional;
    dmb_bit_slope slope;
    if (k >= scene->bit_count) return refuse(r, DMB_ERR_ID, "place.part names no bit of this model");
    dmb_bit_slope_of(r->copy, k, &slope);
    const double *by = r->output->component == DMB_X ? slope.weight : slope.torque;
    const size_t stride = scene->layout.size[scene->bits[k].node] == DMB_NODE_SIX_DOF ? 1 : 3;
    dmb_functional_add_node(scene, scene->bits[k].node, out);
    for (uint32_t c = 0; c < out->count; c++) {
        out->pose[c] = by[0] * slope.along[stride * c] + by[1] * slope.about[stride * c];
        out->speed[c] = by[2] * slope.along[stride * c] + by[3] * slope.about[stride * c];
    }
    dmb_functional_turn_frames(r->linear, out);
    r->out->elastic = 1;
    return DMB_OK;
}

/* ---- All of them ------------------------------------------------------------------------------------------------- */

static int32_t make(const request *r)
{
    switch (r->output->kind) {
    case DMB_ASKED_DISPLACEMENT:
    case DMB_ASKED_VELOCITY:
    case DMB_ASKED_ACCELERATION: return of_motion(r);
    case DMB_ASKED_SECTION_FORCE:
    case DMB_ASKED_SECTION_STRAIN:
    case DMB_ASKED_OUTPUT: return of_section(r); /* loads of the section at the rig end */
    case DMB_ASKED_CONTACT: return of_contact(r);
    case DMB_ASKED_DRIVE: return of_drive(r);
    case DMB_ASKED_REACTION: return of_support(r);
    case DMB_ASKED_MULTIPLIER: return of_multiplier(r);
    case DMB_ASKED_BIT: return of_bit(r);
    default: return of_joint(r);
    }
}

int32_t dmb_linear_output_of(dmb_linear *linear, const dmb_response_options *options, const dmb_output *output,
                             uint32_t index, dmb_message *message, dmb_linear_output *out)
{
    const char *why = "";
    dmb_asked_output asked;
    const request r = {linear, linear->work, options, output, &asked, out, index, message};
    memset(out, 0, sizeof *out);
    out->cluster = out->drive = out->bit = DMB_NONE;
    int32_t status = dmb_output_known(output, index, message);
    if (status >= 0) status = dmb_asked_output_of(linear->work, output, &asked, &out->bit, &why);
    if (status < 0 && why[0] != '\0') dmb_output_refuse(linear->work->model, output, index, why, message);
    return status < 0 ? status : make(&r);
}
