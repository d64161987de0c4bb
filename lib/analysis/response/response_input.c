/* Rows of force of each kind of input, and the law by which their size depends on the frequency:
 *
 *     drive of a force, load, bit load      force      derivative of the residual by target or factor
 *     drive with a controller               control    force per unit of its output; the law has its gains
 *     drive of a motion                     motion     displacements that move its coordinate by 1
 *     input of control.h                    as its drive, load or bit
 *     force at a place                      force      transposed motion of the place
 *     unbalance, eccentric masses           inertia    force over w^2; component RX: turning across the axis
 *     friction of the whole string          force      normal force times a unit coefficient
 *
 * A force at a place is the transpose of the motion there (virtual work), so that receptances are reciprocal to
 * rounding; forces of the scene are the difference of the residual with their factor, in which it is linear. */
#include "analysis/response/response.h"

#include <math.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "force/reference.h"
#include "math/vec3.h"
#include "sim/node.h"
#include "sim/own_scene.h"
#include "system/assemble/assemble.h"
#include "system/assemble/drives.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/constrain.h"

/* Differences of the residual with a factor this large lose nothing to the forces of the state. */
#define DMB_EXCITATION_FACTOR 1e6

typedef struct request {
    const dmb_linear *linear;
    dmb_sim *copy;
    const dmb_excitation *input;
    uint32_t index;
    dmb_message *message;
    dmb_linear_excitation *out;
} request;

static int32_t refuse(const request *r, int32_t status, const char *why)
{
    dmb_message_set(r->message, "excitation %u: %s", r->index, why);
    return status;
}

/* ---- Described actions ------------------------------------------------------------------------------------------- */

/* Dynamic residual at the state; `given`: with the constraint forces of the state. */
static int32_t residual(dmb_sim *copy, double step)
{
    dmb_evaluation evaluation;
    memset(&evaluation, 0, sizeof evaluation);
    evaluation.sim = copy;
    evaluation.time = copy->clock->time;
    evaluation.step = step;
    evaluation.pseudo_factor = 1.0;
    evaluation.load_factor = 1.0;
    evaluation.dynamic = evaluation.given = 1;
    return dmb_system_evaluate(&evaluation);
}

/* rows = -(change of the residual)/scale when *factor changes by `change`, at constant constraint forces. */
static int32_t difference(const request *r, double *factor, double change, double scale, double step)
{
    dmb_sim *copy = r->copy;
    const double kept = *factor;
    *factor = kept + change;
    int32_t status = residual(copy, step);
    for (uint32_t i = 0; i < copy->scene->row_count; i++) r->out->re[i] = -copy->residual[i];
    *factor = kept;
    if (status >= 0) status = residual(copy, step);
    for (uint32_t i = 0; i < copy->scene->row_count; i++) r->out->re[i] = (r->out->re[i] + copy->residual[i]) / scale;
    return status;
}

static int32_t derivative(const request *r, double *factor)
{
    return difference(r, factor, DMB_EXCITATION_FACTOR, DMB_EXCITATION_FACTOR, 0.0);
}

/* Over a step of 2 s the force of a controller grows by kp + ki for a unit of its target, within its limits and on the
 * present segment of its table: the target changes downwards, where that segment is. */
static int32_t controlled_joint(const request *r, uint32_t i, const dmb_scene_drive *drive)
{
    const double gain = r->out->gain + drive->integral_gain, now = r->copy->now.drives[i].force;
    const double room = 0.25 * fmin(drive->limit_high - now, now - drive->limit_low);
    double piece;
    if (gain == 0.0) return refuse(r, DMB_ERR_VALUE, "the drive has no gain and answers to nothing");
    double change = fmin(DMB_EXCITATION_FACTOR, room) / gain;
    (void)dmb_drive_gain(r->copy->scene, &r->copy->now, i, &piece);
    if (drive->table != DMB_NONE) change = -fmin(fabs(change), 0.25 * piece);
    return difference(r, &r->copy->trial.drives[i].target, change, change * gain, 2.0);
}

/* x: required change of the pivot rows of a component, in their order; then displacements of its dependent rows. */
static void move_dependent(const request *r, uint32_t cluster_index, double *x)
{
    const dmb_sim *copy = r->copy;
    const dmb_cluster *cluster = copy->scene->clusters + cluster_index;
    const dmb_partition partition = dmb_cluster_partition(copy, cluster_index);
    dmb_partition_solve(&partition, copy->cluster_lu + cluster->square, copy->cluster_pivot + cluster->row, x);
    for (uint32_t k = 0; k < partition.rank; k++) {
        r->out->re[copy->scene->cluster_columns[cluster->column + partition.column_order[k]]] = x[k];
        x[k] = 0.0;
    }
}

/* Displacements of dependent rows that move the coordinate by one and satisfy every other equation: C_d x = unit. */
static int32_t moved_joint(const request *r, const dmb_scene_drive *drive)
{
    const dmb_constraint *constraint = r->copy->scene->constraints + drive->constraint;
    const dmb_cluster *cluster = r->copy->scene->clusters + constraint->cluster;
    const dmb_partition partition = dmb_cluster_partition(r->copy, constraint->cluster);
    double *x = r->out->im; /* im is free here, and has at least as many numbers as the rank */
    uint32_t place = DMB_NONE;
    for (uint32_t k = 0; k < partition.rank; k++) {
        x[k] = 0.0;
        if (partition.row_order[k] == constraint->row - cluster->row) place = k;
    }
    if (place == DMB_NONE) return refuse(r, DMB_ERR_VALUE, "other equations hold the joint that the drive moves");
    x[place] = 1.0;
    move_dependent(r, constraint->cluster, x);
    return DMB_OK;
}

/* 1 if the displacements satisfy every equation of the component, also redundant ones, which constrained rows may
 * contradict. */
static int32_t holds(const request *r, uint32_t k)
{
    const dmb_cluster *cluster = r->copy->scene->clusters + k;
    const uint32_t *row_of = r->copy->scene->cluster_columns + cluster->column;
    for (uint32_t i = 0; i < cluster->rows; i++) {
        const double *B = r->copy->cluster_matrix + cluster->dense + (size_t)i * cluster->columns;
        double sum = 0.0, largest = 0.0;
        for (uint32_t c = 0; c < cluster->columns; c++) {
            sum += B[c] * r->out->re[row_of[c]];
            largest = fmax(largest, fabs(B[c] * r->out->re[row_of[c]]));
        }
        if (fabs(sum) > 1e-6 * largest) return 0;
    }
    return 1;
}

/* The row moves by one, with the dependent rows of the joints' nodes: C_d x = -(column of the row). */
static int32_t moved_node(const request *r, const dmb_scene_drive *drive)
{
    const dmb_scene *scene = r->copy->scene;
    r->out->re[drive->row] = 1.0;
    if (scene->cluster_count == 0 || scene->node_cluster[drive->node] == DMB_NONE) return DMB_OK;
    const uint32_t k = scene->node_cluster[drive->node];
    const dmb_cluster *cluster = scene->clusters + k;
    const dmb_partition partition = dmb_cluster_partition(r->copy, k);
    const uint32_t column = scene->node_place[drive->node] + drive->row - scene->layout.row[drive->node];
    const double *B = r->copy->cluster_matrix + cluster->dense;
    double *x = r->out->im;
    for (uint32_t i = 0; i < partition.rank; i++) x[i] = -B[(size_t)partition.row_order[i] * cluster->columns + column];
    move_dependent(r, k, x);
    if (!holds(r, k)) return refuse(r, DMB_ERR_VALUE, "joints hold the part that the drive moves");
    return DMB_OK;
}

static int32_t moved(const request *r, const dmb_scene_drive *drive)
{
    r->out->law = DMB_EXCITE_MOTION;
    return drive->joint == DMB_NONE ? moved_node(r, drive) : moved_joint(r, drive);
}

/* A force on a row grows by kp + ki/(i w) for a unit of the target. */
static int32_t controlled(const request *r, uint32_t i, const dmb_scene_drive *drive)
{
    double room;
    r->out->law = DMB_EXCITE_CONTROL;
    r->out->gain = dmb_drive_gain(r->copy->scene, &r->copy->now, i, &room);
    r->out->integral_gain = drive->integral_gain;
    if (drive->joint != DMB_NONE) return controlled_joint(r, i, drive);
    r->out->re[drive->row] = 1.0;
    return DMB_OK;
}

/* 1 if the node rotates and the axes of d do not: transverse forces in its own frame rotate in those axes. */
static int turns(const request *r, uint32_t node)
{
    const dmb_block_layout *layout = &r->copy->scene->layout;
    return layout->size[node] == DMB_NODE_SIX_DOF && r->linear->spin[layout->row[node] + 3] != 0.0;
}

/* 1 if it acts on a row of its node that is not along or about the axis. */
static int acts_across(const request *r, const dmb_scene_drive *drive)
{
    if (drive->joint != DMB_NONE) return 0;
    return (drive->row - r->copy->scene->layout.row[drive->node]) % 3 != 0 && turns(r, drive->node);
}

/* Kinds of drives: a force is linear in its target; a motion prescribes displacements; a controller has a force by its
 * gains. At its limit a controller has no answer, in an open joint no drive acts. */
static int32_t of_drive(const request *r, uint32_t i)
{
    const dmb_scene_drive *drive = r->copy->scene->drives + i;
    const double force = r->copy->now.drives[i].force;
    r->out->drive = i;
    if (acts_across(r, drive))
        return refuse(r, DMB_ERR_UNSUPPORTED, "the drive turns with its part, across axes at rest");
    if (drive->joint != DMB_NONE && r->copy->joint_state[drive->joint] == DMB_JOINT_OPEN)
        return refuse(r, DMB_ERR_VALUE, "the joint of the drive is open");
    if (drive->kind == DMB_DRIVE_CONTROL && (force <= drive->limit_low || force >= drive->limit_high))
        return refuse(r, DMB_ERR_VALUE, "the drive is at its limit and answers to nothing");
    if (drive->kind == DMB_DRIVE_LOAD) return derivative(r, &r->copy->trial.drives[i].target);
    return drive->kind == DMB_DRIVE_MOTION ? moved(r, drive) : controlled(r, i, drive);
}

static int32_t of_load(const request *r, uint32_t i)
{
    const dmb_scene_load *load = r->copy->scene->loads + i;
    const int across =
        load->force[1] != 0.0 || load->force[2] != 0.0 || load->moment[1] != 0.0 || load->moment[2] != 0.0;
    if (load->frame == DMB_FRAME_BODY && across && turns(r, load->node))
        return refuse(r, DMB_ERR_UNSUPPORTED, "the load turns with its part, across axes at rest; give a force there");
    return derivative(r, r->copy->trial.load_factor + i);
}

static int32_t of_bit(const request *r, uint32_t i)
{
    r->out->bit = i;
    return derivative(r, r->copy->trial.bit_load + i);
}

static uint32_t index_of(const request *r, uint32_t kind)
{
    return dmb_model_part_index(r->copy->model, r->input->place.part, kind);
}

static int32_t drive(const request *r)
{
    const uint32_t i = index_of(r, DMB_PART_DRIVE);
    if (i >= r->copy->scene->drive_count) return refuse(r, DMB_ERR_ID, "place.part names no drive of this model");
    return of_drive(r, i);
}

static int32_t load(const request *r)
{
    const uint32_t i = index_of(r, DMB_PART_LOAD);
    if (i >= r->copy->scene->load_count) return refuse(r, DMB_ERR_ID, "place.part names no load of this model");
    return of_load(r, i);
}

static int32_t bit_load(const request *r)
{
    const uint32_t i = index_of(r, DMB_PART_BIT);
    if (i >= r->copy->scene->bit_count) return refuse(r, DMB_ERR_ID, "place.part names no bit of this model");
    return of_bit(r, i);
}

/* ---- Inputs of control.h ----------------------------------------------------------------------------------------- */

static int32_t refuse_setting(const request *r, const dmb_scene_input *setting)
{
    dmb_message_set(
        r->message,
        "excitation %u: input \"%s\" has target %d, which changes the scene itself; must be a set point (%d), load "
        "factor (%d) or bit load (%d); run sims with two of its values for others",
        r->index, setting->name, (int)setting->target, (int)DMB_TARGET_SET_POINT, (int)DMB_TARGET_LOAD_FACTOR,
        (int)DMB_TARGET_BIT_LOAD);
    return DMB_ERR_UNSUPPORTED;
}

/* Input with limits: a small change acts at once, after the time change/rate_limit or 2 sqrt(change/slope_limit), which
 * vanishes with the change. */
static int32_t setting(const request *r)
{
    const dmb_sim *copy = r->copy;
    const uint32_t i = index_of(r, DMB_PART_INPUT);
    if (i >= copy->scene->input_count)
        return refuse(r, DMB_ERR_ID, "place.part names no input of control.h of this model");
    const dmb_scene_input *setting = copy->scene->inputs + i;
    const int32_t target = setting->target;
    if (target != DMB_TARGET_SET_POINT && target != DMB_TARGET_LOAD_FACTOR && target != DMB_TARGET_BIT_LOAD)
        return refuse_setting(r, setting);
    if (!isnan(copy->input_value[i]) && dmb_reference_arrival(&copy->own->references[i]) > copy->clock->time)
        return refuse(r, DMB_ERR_VALUE, "the input is on its way to what is set; run until it arrives");
    if (target == DMB_TARGET_SET_POINT) return of_drive(r, setting->index);
    return target == DMB_TARGET_LOAD_FACTOR ? of_load(r, setting->index) : of_bit(r, setting->index);
}

/* ---- Forces at places -------------------------------------------------------------------------------------------- */

/* to += factor times the rows of a unit force */
static int32_t add_force(const request *r, int32_t component, double factor, double *to)
{
    dmb_functional f;
    const int32_t status = dmb_functional_of_motion(r->copy, r->input->place, r->input->frame, component, &f);
    if (status < 0) {
        dmb_message_set(r->message, "excitation %u: place, pipe %u at %g: %s", r->index, r->input->place.pipe,
                        r->input->place.fraction, dmb_status_text(status));
        return status;
    }
    for (uint32_t i = 0; i < f.count; i++) to[f.row[i]] += factor * f.pose[i];
    return DMB_OK;
}

static int32_t force(const request *r)
{
    return add_force(r, r->input->component, 1.0, r->out->re);
}

/* U w^2 along y, and the same along z a quarter of a turn later: cos wt, cos(wt - pi/2) = Re(e^iwt), Re(-i e^iwt). */
static int32_t unbalance(const request *r)
{
    r->out->law = DMB_EXCITE_INERTIA;
    if (r->input->component != DMB_RX) return force(r);
    const int32_t status = add_force(r, DMB_Y, 1.0, r->out->re);
    return status < 0 ? status : add_force(r, DMB_Z, -1.0, r->out->im);
}

/* ---- The scene's own excitations --------------------------------------------------------------------------------- */

/* The centrifugal wrench g turns with the frequency: g_y + i g_z along y and g_z - i g_y along z. */
static void add_rigid_mass(const dmb_sim *copy, uint32_t i, const double g[6], dmb_linear_excitation *out)
{
    const uint32_t row = copy->scene->layout.row[copy->scene->rigid_masses[i].node];
    for (uint32_t c = 0; c < 6; c += 3) {
        out->re[row + c + 1] += g[c + 1];
        out->im[row + c + 1] += g[c + 2];
        out->re[row + c + 2] += g[c + 2];
        out->im[row + c + 2] -= g[c + 1];
    }
}

/* Axial-torsional nodes are constrained across the hole, also in steps: transverse forces move nothing. */
static int32_t eccentricity(const request *r)
{
    const dmb_scene *scene = r->copy->scene;
    uint32_t felt = 0, unfelt = 0;
    r->out->law = DMB_EXCITE_INERTIA;
    for (uint32_t i = 0; i < scene->rigid_mass_count; i++) {
        double g[6];
        dmb_unbalance_of(scene, i, g);
        const int eccentric = g[1] != 0.0 || g[2] != 0.0 || g[4] != 0.0 || g[5] != 0.0;
        const int full = scene->layout.size[scene->rigid_masses[i].node] == DMB_NODE_SIX_DOF;
        felt += eccentric && full;
        unfelt += eccentric && !full;
        if (full) add_rigid_mass(r->copy, i, g, r->out);
    }
    if (unfelt > 0 && felt == 0)
        return refuse(r, DMB_ERR_UNSUPPORTED, "axial-torsional pipes do not feel their eccentric masses");
    return DMB_OK;
}

/* Normal force times a unit coefficient along the hole, (t; -r b), or around it, (b; r t) with b = t x n, as in
 * system/assemble/wall_contact. */
static void add_stabiliser(const dmb_sim *copy, uint32_t s, int32_t around, double *rows)
{
    const dmb_site *site = copy->scene->sites + s;
    double R[9], n[3], t[3], b[3], w[6];
    dmb_site_force f;
    dmb_site_force_of(copy->scene, &copy->now, s, &f);
    if (!f.closed) return;
    dmb_site_axes(copy->scene, &copy->now, s, R);
    dmb_mat3_tvec(R, f.normal, n);
    dmb_mat3_tvec(R, f.tangent, t);
    dmb_vec3_cross(t, n, b);
    dmb_vec3_scale(f.normal_force, around ? b : t, w);
    dmb_vec3_scale(f.normal_force * (around ? site->radius : -site->radius), around ? t : b, w + 3);
    dmb_site_add_wrench(copy->scene, &copy->now, s, 1.0, w, rows);
}

static void add_path(const dmb_sim *copy, uint32_t s, int32_t around, double *rows)
{
    const dmb_axial_torsional_site *site = copy->scene->axial_torsional_sites + s;
    const uint32_t row = copy->scene->layout.row[site->node];
    dmb_site_force f;
    dmb_axial_torsional_site_force(copy->scene, &copy->now, s, &f);
    rows[around ? row + 1 : row] += f.normal_force * (around ? site->radius : 1.0);
}

static int32_t friction(const request *r)
{
    const int32_t around = r->input->component == DMB_RX;
    if (!around && r->input->component != DMB_X)
        return refuse(r, DMB_ERR_VALUE, "component must be DMB_X (friction along the hole) or DMB_RX (around it)");
    for (uint32_t s = 0; s < r->copy->scene->site_count; s++) add_stabiliser(r->copy, s, around, r->out->re);
    for (uint32_t s = 0; s < r->copy->scene->axial_torsional_site_count; s++) add_path(r->copy, s, around, r->out->re);
    return DMB_OK;
}

static int32_t make(const request *r)
{
    switch (r->input->kind) {
    case DMB_EXCITATION_DRIVE: return drive(r);
    case DMB_EXCITATION_LOAD: return load(r);
    case DMB_EXCITATION_BIT_LOAD: return bit_load(r);
    case DMB_EXCITATION_SETTING: return setting(r);
    case DMB_EXCITATION_FORCE: return force(r);
    case DMB_EXCITATION_UNBALANCE: return unbalance(r);
    case DMB_EXCITATION_ECCENTRICITY: return eccentricity(r);
    default: return friction(r);
    }
}

int32_t dmb_excitation_of(const dmb_linear *linear, const dmb_excitation *input, uint32_t index, dmb_message *message,
                          dmb_linear_excitation *out)
{
    const request r = {linear, linear->work, input, index, message, out};
    out->drive = out->bit = DMB_NONE;
    return make(&r);
}
