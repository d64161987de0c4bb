#include "system/assemble/joint_forces.h"

#include <string.h>

#include "math/mat6.h"
#include "math/se3.h"
#include "system/assemble/drives.h"
#include "system/constrain/cluster.h"
#include "system/constrain/constraint_rows.h"

/* Forces on the six coordinates, what they change by, and where they act. */
typedef struct coordinate_forces {
    dmb_relative relative;
    dmb_joint_coordinates c;
    double speed[6];
    double force[6], by_position[6], by_speed[6];
} coordinate_forces;

static int has_forces(const dmb_sim *sim, const dmb_scene_joint *joint, uint32_t j)
{
    return (joint->law != DMB_NONE || joint->drive_count > 0) && sim->joint_state[j] != DMB_JOINT_OPEN;
}

static void begin(const dmb_evaluation *evaluation, uint32_t j, coordinate_forces *f)
{
    memset(f, 0, sizeof *f);
    dmb_joint_motion_of(evaluation->sim->scene, &evaluation->sim->trial, j, &f->relative, NULL);
    dmb_joint_coordinates_in(evaluation, j, &f->relative, &f->c);
    for (int i = 0; i < 6; i++) f->speed[i] = evaluation->dynamic ? dmb_vec6_dot(f->c.J[i], f->relative.V) : 0.0;
}

static double largest_place(const dmb_sim *sim, const dmb_scene_frame *frame)
{
    const double *u = sim->trial.displacement;
    return frame->node == DMB_NONE ? dmb_vec3_norm(frame->x)
                                   : dmb_vec3_norm(frame->x) + dmb_vec3_norm(u + 3 * (size_t)frame->node);
}

/* [N] what the force on coordinate i changes by where the numbers that the coordinate is the difference of do so by
 * their own size; moments as forces at the length scale. */
static double stiffness_times_reach(const dmb_sim *sim, const dmb_scene_joint *joint, int i, double by_position)
{
    if (i >= 3) return by_position / sim->scene->length_scale;
    return by_position * (dmb_vec3_norm(joint->span) + largest_place(sim, &joint->a) + largest_place(sim, &joint->b));
}

/* Before the first correction of a step a residual that a stiff spring's rounding could make may as well be that of a
 * soft part, which would then fly on as if nothing held it; one correction moves it to where it belongs. Without a
 * step, as about a state that is linearised, nothing flies on. */
static int rounding_counts(const dmb_evaluation *evaluation)
{
    return !evaluation->dynamic || evaluation->extrapolated || evaluation->step == 0.0;
}

/* Springs, dampers, stops and friction of each coordinate c: f(c, c'), its two derivatives and the powers f c'. */
static void add_laws(dmb_evaluation *evaluation, const dmb_scene_joint *joint, coordinate_forces *f)
{
    for (int i = 0; i < 6; i++) {
        dmb_joint_force law;
        if (joint->law == DMB_NONE || (joint->law_mask >> i & 1) == 0) continue;
        dmb_joint_force_at(evaluation->sim->scene->laws + joint->law + i, f->c.value[i], f->speed[i], &law);
        f->force[i] += law.force;
        f->by_position[i] += law.by_position;
        f->by_speed[i] += law.by_speed;
        const double k = stiffness_times_reach(evaluation->sim, joint, i, law.by_position);
        if (rounding_counts(evaluation)) evaluation->rounding += k * k;
        evaluation->power[DMB_POWER_POTENTIAL] += (law.spring + law.stop) * f->speed[i];
        evaluation->power[DMB_POWER_DAMPING] += law.damper * f->speed[i];
        evaluation->power[DMB_POWER_FRICTION] += law.friction * f->speed[i];
        evaluation->power[DMB_POWER_IMPACT] += law.stop_damper * f->speed[i];
    }
}

/* Drives in load or speed control push on their coordinate; motion drives are equations (system/constrain). */
static void add_drives(dmb_evaluation *evaluation, uint32_t j, coordinate_forces *f)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_joint *joint = sim->scene->joints + j;
    for (uint32_t i = joint->first_drive; i < joint->first_drive + joint->drive_count; i++) {
        const uint32_t d = sim->scene->joint_drives[i];
        const dmb_scene_drive *drive = sim->scene->drives + d;
        double slope;
        dmb_drive_on_joint(sim, d, f->c.value[drive->component], f->speed[drive->component], 0);
        if (drive->kind == DMB_DRIVE_MOTION) continue;
        const double force = dmb_drive_force(evaluation, d, f->speed[drive->component], &slope);
        f->force[drive->component] += force;
        f->by_speed[drive->component] += evaluation->dynamic ? slope : 0.0;
        evaluation->power[DMB_POWER_DRIVES] += force * f->speed[drive->component];
    }
}

/* Drives of an open joint do nothing, and follow its coordinate. */
static void rest_drives(dmb_evaluation *evaluation, uint32_t j)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene_joint *joint = sim->scene->joints + j;
    coordinate_forces f;
    if (joint->drive_count == 0) return;
    begin(evaluation, j, &f);
    for (uint32_t i = joint->first_drive; i < joint->first_drive + joint->drive_count; i++) {
        const uint32_t d = sim->scene->joint_drives[i];
        const dmb_scene_drive *drive = sim->scene->drives + d;
        dmb_drive_on_joint(sim, d, f.c.value[drive->component], f.speed[drive->component], 1);
    }
}

static void apply(dmb_evaluation *evaluation, const dmb_scene_joint *joint, const coordinate_forces *f)
{
    double w[6] = {0.0}, wa[6], wb[6];
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++) w[k] += f->force[i] * f->c.J[i][k];
    dmb_relative_pull_back(&f->relative, w, wa, wb);
    dmb_apply_wrench(evaluation->sim, joint->b.node, wb);
    if (joint->a.node != DMB_NONE) dmb_apply_wrench(evaluation->sim, joint->a.node, wa);
}

/* -d(J^T f)/dq: W of the gradients and J^T f' J. */
static void add_position_tangent(const dmb_scene *scene, const dmb_constraint *constraint, uint32_t j,
                                 const coordinate_forces *f, double *K)
{
    double w[6] = {0.0}, W[36], minus[6];
    for (int i = 0; i < 6; i++) minus[i] = -f->force[i];
    dmb_joint_coordinates_tangent(f->relative.R, f->relative.p, minus, W);
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 6; k++) w[k] += minus[i] * f->c.J[i][k];
        dmb_mat6_add_outer(-f->by_position[i], f->c.J[i], f->c.J[i], W);
    }
    dmb_add_joint_tangent(scene, constraint, j, &f->relative, w, W, K);
}

static void add_speed_tangent(dmb_evaluation *evaluation, const dmb_constraint *constraint, uint32_t j,
                              const coordinate_forces *f, double *K)
{
    const uint32_t n = constraint->columns;
    for (int i = 0; i < 6; i++) {
        double row[DMB_CONSTRAINT_COLUMNS] = {0.0};
        const double factor = -evaluation->velocity_factor * f->by_speed[i];
        if (factor == 0.0) continue;
        dmb_add_joint_row(evaluation->sim->scene, constraint, j, &f->relative, 1.0, f->c.J[i], row);
        for (uint32_t r = 0; r < n; r++)
            for (uint32_t s = 0; s < n; s++) K[(size_t)r * n + s] += factor * row[r] * row[s];
    }
}

/* K <- K T6 in the columns of FULL nodes, as for the blocks of the nodes. */
static void to_parameters(const dmb_evaluation *evaluation, const dmb_constraint *constraint, double *K)
{
    const dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    if (!evaluation->dynamic) return;
    for (uint32_t i = 0; i < constraint->node_count; i++) {
        const uint32_t node = constraint->node[i];
        dmb_se3_tangent T;
        if (scene->layout.size[node] != DMB_NODE_FULL) continue;
        dmb_se3_tangent_at(sim->increment + scene->layout.row[node], NULL, &T);
        for (uint32_t r = 0; r < constraint->columns; r++) {
            double *row = K + (size_t)r * constraint->columns + constraint->column[i];
            dmb_se3_tangent_apply_transpose(&T, row, row);
        }
    }
}

/* The tangent by speeds is one by parameters already. */
static void add_tangent(dmb_evaluation *evaluation, uint32_t j, const coordinate_forces *f)
{
    const dmb_scene *scene = evaluation->sim->scene;
    const dmb_constraint *constraint = scene->constraints + scene->joints[j].constraint;
    double *K = evaluation->sim->constraint_tangent + constraint->tangent;
    add_position_tangent(scene, constraint, j, f, K);
    to_parameters(evaluation, constraint, K);
    if (evaluation->dynamic) add_speed_tangent(evaluation, constraint, j, f, K);
}

static void gather_forces(dmb_evaluation *evaluation)
{
    const dmb_scene *scene = evaluation->sim->scene;
    for (uint32_t j = 0; j < scene->joint_count; j++) {
        const dmb_scene_joint *joint = scene->joints + j;
        coordinate_forces f;
        if (evaluation->sim->joint_state[j] == DMB_JOINT_OPEN) rest_drives(evaluation, j);
        if (!has_forces(evaluation->sim, joint, j)) continue;
        begin(evaluation, j, &f);
        add_laws(evaluation, joint, &f);
        add_drives(evaluation, j, &f);
        apply(evaluation, joint, &f);
        if (evaluation->tangent) add_tangent(evaluation, j, &f);
    }
}

/* Curvature of the equations, onto the tangents of the forces. */
static int32_t gather_curvatures(dmb_evaluation *evaluation)
{
    dmb_sim *sim = evaluation->sim;
    const dmb_scene *scene = sim->scene;
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < scene->constraint_count && status >= 0; i++) {
        const dmb_constraint *constraint = scene->constraints + i;
        const size_t size = (size_t)constraint->columns * constraint->columns;
        double K[DMB_CONSTRAINT_COLUMNS * DMB_CONSTRAINT_COLUMNS];
        memset(K, 0, size * sizeof(double));
        status = dmb_constraint_curvature(evaluation, i, K);
        to_parameters(evaluation, constraint, K);
        for (size_t k = 0; k < size; k++) sim->constraint_tangent[constraint->tangent + k] += K[k];
    }
    return status;
}

int32_t dmb_gather_joints(dmb_evaluation *evaluation)
{
    gather_forces(evaluation);
    dmb_clusters_balance(evaluation);
    return evaluation->tangent ? gather_curvatures(evaluation) : DMB_OK;
}
