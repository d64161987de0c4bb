/* The equations of joints, couplings, joint drives and callbacks at states off the constraints: Jacobian, rates and
 * convective parts against differences of their values, and the tangent of all joint forces against differences of the
 * residual. Every kind of joint stands twice in the scene: on the ground and in a chain of bodies. Checks
 * eq:motion.constraints, eq:joints.rows and eq:joints.relative-tangent. */
#include <stdio.h>
#include <string.h>

#include "mechanism.h"

#include "math/mat6.h"
#include "math/se3.h"
#include "sim/layout.h"
#include "sim/sim.h"
#include "system/assemble/evaluation.h"
#include "system/constrain/constrain.h"

enum { ROWS_MAX = 400, KINDS = DMB_JOINT_SCHOENFLIES + 1, EQUATIONS_MAX = 300 };

/* ---- The caller's constraints ------------------------------------------------------------------------------------ */

static void row_of(const double pose[12], const double force[3], const double moment[3], double J[6])
{
    dmb_mat3_tvec(pose + 3, force, J);
    dmb_mat3_tvec(pose + 3, moment, J + 3);
}

/* C0 = |x1 - x0|^2/4 + sin(2 t) - c, C1 = R0 e_x . R1 e_y + 0.1 t x1_z */
static int32_t two_rows(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                        double *jacobian)
{
    const double none[3] = {0.0, 0.0, 0.0}, lift[3] = {0.0, 0.0, 0.1 * time};
    double d[3], back[3], ex[3], ey[3], turn[3], minus[3];
    (void)context, (void)count;
    dmb_vec3_sub(poses[1], poses[0], d);
    for (int i = 0; i < 3; i++) {
        ex[i] = poses[0][3 + 3 * i];
        ey[i] = poses[1][3 + 3 * i + 1];
    }
    value[0] = 0.25 * dmb_vec3_dot(d, d) + sin(2.0 * time) - 1.0;
    value[1] = dmb_vec3_dot(ex, ey) + 0.1 * time * poses[1][2];
    if (jacobian == NULL) return 0;
    dmb_vec3_scale(0.5, d, d);
    dmb_vec3_scale(-1.0, d, back);
    dmb_vec3_cross(ex, ey, turn); /* d(ex . ey) = w0 . (ex x ey) + w1 . (ey x ex) */
    dmb_vec3_scale(-1.0, turn, minus);
    row_of(poses[0], back, none, jacobian);
    row_of(poses[1], d, none, jacobian + 6);
    row_of(poses[0], none, turn, jacobian + 12);
    row_of(poses[1], lift, minus, jacobian + 18);
    return 0;
}

/* A v + b with A turning with the pose and b with time. */
static int32_t speeds(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                      double *jacobian)
{
    const double force[3] = {0.3 + poses[0][1], 1.0, 0.2 * time}, moment[3] = {0.5, poses[0][2], poses[0][0]};
    (void)context, (void)count;
    value[0] = 0.3 * sin(time) + 0.2 * poses[0][0];
    row_of(poses[0], force, moment, jacobian);
    return 0;
}

static dmb_id add_user(rig *s, int32_t kind, uint32_t rows, dmb_constraint_fn callback, int32_t provides,
                       const dmb_id *body, uint32_t count)
{
    dmb_constraint_def def = dmb_constraint_def_default();
    dmb_id id = {0, 0};
    def.kind = kind;
    def.row_count = rows;
    def.place_count = count;
    for (uint32_t i = 0; i < count; i++) def.place[i] = dmb_station(body[i], 0, 0.0);
    def.provides = provides;
    def.callback = callback;
    must_model(s, dmb_model_add_constraint(s->model, &def, &id));
    return id;
}

/* ---- The scene --------------------------------------------------------------------------------------------------- */

static void add_hole(rig *s, int32_t curved)
{
    static const double survey[9] = {0.0, 0.5 * PI, 0.0, 3.0, 0.5 * PI - 0.15, -0.1, 9.0, 0.5 * PI - 0.5, -0.4};
    dmb_wall_def wall = dmb_wall_def_default();
    wall.normal_law = DMB_NORMAL_NONE;
    wall.friction_law = DMB_FRICTION_NONE;
    wall.diameter = 0.5;
    if (curved) {
        wall.survey = survey;
        wall.survey_count = 3;
    }
    (void)add_wall(s, &wall);
}

static dmb_id add_rigid_mass(rig *s, uint64_t *seed, double x, double y, double z)
{
    dmb_body_def body = dmb_body_def_default();
    body.position[0] = x;
    body.position[1] = y;
    body.position[2] = z;
    for (int i = 0; i < 3; i++) body.rotation[i] = draw_between(seed, -0.2, 0.2);
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.2 + 0.05 * i;
    body.centre[1] = 0.1;
    return add_body(s, &body);
}

static void draw_frame(uint64_t *seed, double origin[3], double axis[3], double normal[3])
{
    for (int i = 0; i < 3; i++) {
        origin[i] = draw_between(seed, -0.2, 0.2);
        axis[i] = (i == 0 ? 1.0 : 0.0) + draw_between(seed, -0.2, 0.2);
        normal[i] = (i == 1 ? 1.0 : 0.0) + draw_between(seed, -0.2, 0.2);
    }
}

static void add_laws(uint64_t *seed, dmb_joint_def *def)
{
    for (int i = 0; i < 6; i++) {
        def->stiffness[i] = draw_between(seed, 1.0, 5.0);
        def->damping[i] = draw_between(seed, 0.1, 1.0);
        def->rest[i] = draw_between(seed, -0.3, 0.3);
        def->friction[i] = draw_between(seed, 0.5, 1.5);
        def->stop_high[i] = -0.5 + draw_between(seed, 0.0, 0.2); /* most of them are in their stop */
        def->stop_low[i] = -4.0;
    }
    def->friction_speed = 0.4;
    def->stop_stiffness = 3.0;
    def->stop_damping = 0.2;
}

static dmb_id add_kind(rig *s, uint64_t *seed, int32_t kind, dmb_place a, dmb_place b)
{
    dmb_joint_def def = dmb_joint_def_default();
    def.kind = kind;
    def.place_a = a;
    def.place_b = b;
    draw_frame(seed, def.origin_a, def.axis_a, def.normal_a);
    draw_frame(seed, def.origin_b, def.axis_b, def.normal_b);
    def.match = kind != DMB_JOINT_POINT_ON_HOLE && kind != DMB_JOINT_DISTANCE && kind != DMB_JOINT_ROLLING;
    def.length = kind == DMB_JOINT_ROLLING ? 0.4 : 0.9;
    if (kind == DMB_JOINT_ROLLING) { /* an upright rim: its axis lies in the plane y, z of a */
        def.axis_b[0] = 0.1, def.axis_b[1] = 0.0, def.axis_b[2] = 1.0;
        def.normal_b[0] = 1.0, def.normal_b[1] = 0.0, def.normal_b[2] = 0.0;
    }
    if (kind != DMB_JOINT_POINT_ON_HOLE) add_laws(seed, &def);
    return add_joint(s, &def);
}

typedef struct parts {
    dmb_id body[2][KINDS], joint[2][KINDS];
    dmb_id string;
} parts;

static void add_string_on_joints(rig *s, uint64_t *seed, parts *p)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(1.0, 2, 90.0, 40.0, 30.0, 20.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    def.position[1] = -3.0;
    pipe.string = p->string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 2);
    (void)add_kind(s, seed, DMB_JOINT_UNIVERSAL, dmb_station(p->string, 0, 0.5), dmb_station(p->body[1][2], 0, 0.0));
    (void)add_kind(s, seed, DMB_JOINT_SPHERICAL, dmb_station(p->string, 0, 0.0), dmb_station(p->string, 1, 1.0));
}

static void add_bodies(rig *s, uint64_t *seed, parts *p)
{
    for (int32_t line = 0; line < 2; line++)
        for (int32_t kind = 0; kind < KINDS; kind++) {
            const double z = line == 0 && kind == DMB_JOINT_POINT_ON_HOLE ? 0.2 : 1.0 + line;
            p->body[line][kind] = add_rigid_mass(s, seed, 0.45 * kind, 0.0, z);
        }
}

static void add_joints(rig *s, uint64_t *seed, parts *p)
{
    for (int32_t line = 0; line < 2; line++)
        for (int32_t kind = 0; kind < KINDS; kind++) {
            const int ground = line == 0 || kind == 0 || kind == DMB_JOINT_POINT_ON_HOLE;
            const dmb_id before = ground ? ground_id : p->body[line][kind - 1];
            p->joint[line][kind] =
                add_kind(s, seed, kind, dmb_station(before, 0, 0.0), dmb_station(p->body[line][kind], 0, 0.0));
        }
}

static void add_couplings_and_drives(rig *s, parts *p)
{
    dmb_coupling_def gear = dmb_coupling_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    gear.joint[0] = p->joint[1][DMB_JOINT_REVOLUTE];
    gear.joint[1] = p->joint[1][DMB_JOINT_CYLINDRICAL];
    gear.ratio = -2.0;
    must_model(s, dmb_model_add_coupling(s->model, &gear, NULL));
    gear.joint[0] = gear.joint[1] = p->joint[0][DMB_JOINT_CYLINDRICAL];
    gear.component[0] = DMB_X;
    gear.ratio = 0.3;
    must_model(s, dmb_model_add_coupling(s->model, &gear, NULL));
    drive.part = p->joint[1][DMB_JOINT_UNIVERSAL];
    drive.component = DMB_RY;
    drive.time_function = add_constant(s, 0.0);
    (void)add_drive(s, &drive);
    drive.kind = DMB_DRIVE_LOAD;
    drive.part = p->joint[1][DMB_JOINT_PRISMATIC];
    drive.component = DMB_X;
    drive.time_function = add_constant(s, 3.0);
    (void)add_drive(s, &drive);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = p->joint[1][DMB_JOINT_SPHERICAL];
    drive.component = DMB_RZ;
    drive.gain = 2.0;
    drive.integral_gain = 40.0;
    (void)add_drive(s, &drive);
}

static void open_scene(rig *s, uint64_t seed, parts *p)
{
    rig_open(s, 0.0, 0.0, -9.81);
    add_hole(s, 1);
    add_bodies(s, &seed, p);
    add_joints(s, &seed, p);
    add_string_on_joints(s, &seed, p);
    add_couplings_and_drives(s, p);
    const dmb_id pair[2] = {p->body[0][DMB_JOINT_FREE], p->body[1][DMB_JOINT_DISTANCE]};
    const dmb_id other[2] = {p->body[0][DMB_JOINT_KNIFE_EDGE], p->body[1][DMB_JOINT_FREE]};
    (void)add_user(s, DMB_CONSTRAINT_HOLONOMIC, 2, two_rows, DMB_PROVIDES_JACOBIAN, pair, 2);
    (void)add_user(s, DMB_CONSTRAINT_HOLONOMIC, 2, two_rows, 0, other, 2);
    (void)add_user(s, DMB_CONSTRAINT_NONHOLONOMIC, 1, speeds, DMB_PROVIDES_JACOBIAN, other, 1);
    (void)mechanism_start(s, NULL);
}

/* A scene with axial-torsional pipes in a straight hole: nodes of two rows. */
static void open_path_scene(rig *s, uint64_t seed)
{
    rig_open(s, 0.0, 0.0, -9.81);
    add_hole(s, 0);
    dmb_pipe_def pipe = beam_pipe(1.0, 1, 90.0, 40.0, 30.0, 20.0);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    const dmb_id string = add_pipes(s, &pipe, 3), body = add_rigid_mass(s, &seed, 2.0, 0.3, 0.4);
    const dmb_place far = dmb_station(string, 1, 1.0), on = dmb_station(body, 0, 0.0);
    (void)add_kind(s, &seed, DMB_JOINT_REVOLUTE, far, on);
    (void)add_kind(s, &seed, DMB_JOINT_FREE, dmb_station(string, 2, 1.0), on);
    (void)add_kind(s, &seed, DMB_JOINT_FREE, on, dmb_station(string, 0, 1.0));
    (void)mechanism_start(s, NULL);
}

/* ---- States ------------------------------------------------------------------------------------------------------ */

static void stir_nodes(dmb_sim *sim, uint64_t *seed)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        double h[6];
        for (int k = 0; k < 6; k++) h[k] = draw_between(seed, -0.1, 0.1) * (k < 3 ? 1.0 : 2.0);
        if (scene->layout.size[i] == DMB_NODE_AXIAL_TORSIONAL) {
            sim->now.displacement[3 * i] += h[0];
            sim->now.turn[i] += h[3];
        } else {
            dmb_se3_advance(sim->now.quaternion + 4 * i, sim->now.displacement + 3 * i, h);
        }
    }
    for (uint32_t i = 0; i < scene->row_count; i++) {
        sim->now.velocity[i] = draw_between(seed, -1.0, 1.0);
        sim->now.acceleration[i] = draw_between(seed, -2.0, 2.0);
    }
}

/* Points on the hole go onto its axis, and move along it: off it their frame turns about the axis with the depth, which
 * the equations leave out. */
static void put_on_hole(dmb_sim *sim, uint32_t j)
{
    const dmb_scene_joint *joint = sim->scene->joints + j;
    double *v = sim->now.velocity + sim->scene->layout.row[joint->b.node];
    for (int k = 0; k < 12; k++) {
        dmb_relative relative;
        dmb_joint_rows rows;
        double h[6] = {0.0};
        dmb_joint_motion(sim->scene, &sim->now, j, &relative, NULL);
        dmb_joint_rows_now(sim, j, &relative, &rows);
        for (uint32_t r = 0; r < rows.count; r++) {
            double J[6];
            dmb_mat6_row(rows.J[r], 1, relative.to_b, J);
            dmb_vec3_axpy(-rows.value[r], J, h);
            dmb_vec3_axpy(-dmb_vec6_dot(J, v), J, v);
        }
        dmb_se3_advance(sim->now.quaternion + 4 * joint->b.node, sim->now.displacement + 3 * joint->b.node, h);
    }
}

static void lock_all(dmb_sim *sim)
{
    for (uint32_t j = 0; j < sim->scene->joint_count; j++) {
        sim->joint_state[j] = DMB_JOINT_LOCKED;
        dmb_joint_hold(sim, j);
    }
}

/* Off the constraints, moving, with multipliers of any size; some joints locked a little way off. */
static void stir(rig *s, uint64_t seed, int32_t locked)
{
    dmb_sim *sim = s->sim;
    const dmb_scene *scene = sim->scene;
    if (locked) lock_all(sim);
    stir_nodes(sim, &seed);
    for (uint32_t j = 0; j < scene->joint_count; j++)
        if (scene->joints[j].kind == DMB_JOINT_POINT_ON_HOLE && !locked) put_on_hole(sim, j);
    for (uint32_t r = 0; r < scene->constraint_row_count; r++) sim->now.multiplier[r] = draw_between(&seed, -5.0, 5.0);
    for (uint32_t d = 0; d < scene->drive_count; d++) {
        sim->now.drives[d].target = draw_between(&seed, -1.0, 1.0);
        sim->now.drives[d].rate = draw_between(&seed, -1.0, 1.0);
        sim->now.drives[d].position = draw_between(&seed, -1.0, 1.0);
        sim->now.drives[d].integral = draw_between(&seed, -0.1, 0.1);
    }
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    memset(sim->increment, 0, scene->row_count * sizeof(double));
}

static dmb_evaluation evaluation_of(dmb_sim *sim, int32_t dynamic)
{
    dmb_evaluation e;
    memset(&e, 0, sizeof e);
    e.sim = sim;
    e.time = 0.3;
    e.load_factor = 1.0;
    e.dynamic = dynamic;
    e.given = 1;
    return e;
}

/* Trial = now moved by h along row c of a node. */
static void move_row(dmb_sim *sim, int by_velocity, uint32_t node, uint32_t c, double x)
{
    double h[6] = {0.0};
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    if (by_velocity) {
        sim->trial.velocity[sim->scene->layout.row[node] + c] += x;
        return;
    }
    h[c] = x;
    if (sim->scene->layout.size[node] == DMB_NODE_SIX_DOF)
        dmb_se3_advance(sim->trial.quaternion + 4 * node, sim->trial.displacement + 3 * node, h);
    else if (c == 0)
        sim->trial.displacement[3 * node] += x;
    else
        sim->trial.turn[node] += x;
}

/* Trial = now, s further along its motion; drives go on as their rates say. */
static void move_along(dmb_sim *sim, double s)
{
    const dmb_scene *scene = sim->scene;
    dmb_configuration_copy(sim, &sim->now, &sim->trial);
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const double *v = sim->now.velocity + scene->layout.row[i];
        double h[6] = {0.0};
        for (uint32_t c = 0; c < scene->layout.size[i]; c++) h[c] = s * v[c];
        if (scene->layout.size[i] == DMB_NODE_SIX_DOF) {
            dmb_se3_advance(sim->trial.quaternion + 4 * i, sim->trial.displacement + 3 * i, h);
            continue;
        }
        sim->trial.displacement[3 * i] += h[0];
        sim->trial.turn[i] += h[1];
    }
    for (uint32_t d = 0; d < scene->drive_count; d++) {
        const double target = sim->now.drives[d].target, rate = sim->now.drives[d].rate;
        sim->trial.drives[d].target = target + s * rate;
        sim->trial.drives[d].position = sim->now.drives[d].position + s * (target + 0.5 * s * rate);
    }
}

static void make_rows(dmb_sim *sim, double later)
{
    dmb_evaluation e = evaluation_of(sim, 1);
    e.time += later;
    assert_int_equal(dmb_clusters_assemble(&e), DMB_OK);
}

/* ---- Rows -------------------------------------------------------------------------------------------------------- */

/* Entry of row r by row c of a node; 0 where the constraint does not touch it. */
static double jacobian_entry(const dmb_sim *sim, uint32_t r, uint32_t node, uint32_t c)
{
    const dmb_constraint *of = sim->scene->constraints + dmb_constraint_of_row(sim->scene, r);
    for (uint32_t i = 0; i < of->node_count; i++)
        if (of->node[i] == node)
            return sim->constraint_jacobian[of->jacobian + (size_t)(r - of->row) * of->columns + of->column[i] + c];
    return 0.0;
}

/* Largest error over rows of position of dC by one column. */
static double column_error(dmb_sim *sim, uint32_t node, uint32_t c, uint32_t *where)
{
    static double value[6][EQUATIONS_MAX];
    const uint32_t rows = sim->scene->constraint_row_count;
    const double step = 2e-4;
    double worst = 0.0;
    for (int k = 0; k < 6; k++) {
        move_row(sim, 0, node, c, step * difference6_place[k]);
        make_rows(sim, 0.0);
        memcpy(value[k], sim->constraint_value, rows * sizeof(double));
    }
    move_row(sim, 0, node, c, 0.0);
    make_rows(sim, 0.0);
    for (uint32_t r = 0; r < rows; r++) {
        if (sim->constraint_type[r] != DMB_ROW_POSITION) continue;
        const double f[6] = {value[0][r], value[1][r], value[2][r], value[3][r], value[4][r], value[5][r]};
        const double error = fabs(difference6(f, step) - jacobian_entry(sim, r, node, c));
        if (error > worst) *where = r;
        worst = fmax(worst, error);
    }
    return worst;
}

static void name_row(const dmb_sim *sim, uint32_t r)
{
    dmb_message text;
    const uint32_t i = dmb_constraint_of_row(sim->scene, r);
    const dmb_constraint *c = sim->scene->constraints + i;
    dmb_constraint_text(sim->scene, i, &text);
    print_message("      worst: %s, its row %u, kind %d\n", text.text, r - c->row,
                  c->kind == DMB_OF_JOINT ? sim->scene->joints[c->index].kind : -1);
}

static double jacobian_error(rig *s)
{
    const dmb_scene *scene = s->sim->scene;
    double worst = 0.0;
    uint32_t row = 0, at = 0;
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++) {
            const double error = column_error(s->sim, i, c, &at);
            if (error > worst) row = at;
            worst = fmax(worst, error);
        }
    if (worst > 1e-9) name_row(s->sim, row);
    return worst;
}

/* B v + rate of all rows at the trial. */
static void speeds_of_rows(dmb_sim *sim, double *out)
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t k = 0; k < c->rows; k++) {
            const double *B = sim->constraint_jacobian + c->jacobian + (size_t)k * c->columns;
            double sum = sim->constraint_rate[c->row + k];
            for (uint32_t n = 0; n < c->node_count; n++)
                for (uint32_t m = 0; m < scene->layout.size[c->node[n]]; m++)
                    sum += B[c->column[n] + m] * sim->trial.velocity[scene->layout.row[c->node[n]] + m];
            out[c->row + k] = sum;
        }
    }
}

static int of_callback(const dmb_sim *sim, uint32_t r)
{
    return sim->scene->constraints[dmb_constraint_of_row(sim->scene, r)].kind == DMB_OF_CALLBACK;
}

/* Rates of values (rows of position) and of B v + rate (all rows but callbacks', and callbacks') along the motion;
 * largest errors. */
static void check_rates(rig *s, double error[3])
{
    static double value[6][EQUATIONS_MAX], speed[6][EQUATIONS_MAX], now[EQUATIONS_MAX];
    dmb_sim *sim = s->sim;
    const uint32_t rows = sim->scene->constraint_row_count;
    const double step = 5e-4;
    uint32_t where[3] = {0, 0, 0};
    error[0] = error[1] = error[2] = 0.0;
    for (int k = 0; k < 6; k++) {
        move_along(sim, step * difference6_place[k]);
        make_rows(sim, step * difference6_place[k]);
        memcpy(value[k], sim->constraint_value, rows * sizeof(double));
        speeds_of_rows(sim, speed[k]);
    }
    move_along(sim, 0.0);
    make_rows(sim, 0.0);
    speeds_of_rows(sim, now);
    for (uint32_t r = 0; r < rows; r++) {
        const double f[6] = {value[0][r], value[1][r], value[2][r], value[3][r], value[4][r], value[5][r]};
        const double g[6] = {speed[0][r], speed[1][r], speed[2][r], speed[3][r], speed[4][r], speed[5][r]};
        double off[3] = {0.0, 0.0, 0.0};
        if (sim->constraint_type[r] == DMB_ROW_POSITION) off[0] = fabs(difference6(f, step) - now[r]);
        off[of_callback(sim, r) ? 2 : 1] = fabs(difference6(g, step) - sim->constraint_convective[r]);
        for (int k = 0; k < 3; k++) {
            if (off[k] > error[k]) where[k] = r;
            error[k] = fmax(error[k], off[k]);
        }
    }
    for (int k = 0; k < 3; k++)
        if (error[k] > 1e-7) name_row(sim, where[k]);
}

static void check_rows(const char *name, int32_t path, int32_t locked)
{
    double worst[4] = {0.0, 0.0, 0.0, 0.0};
    char what[128];
    for (uint64_t seed = 1; seed <= 3; seed++) {
        rig s;
        parts p;
        double error[3];
        if (path)
            open_path_scene(&s, seed);
        else
            open_scene(&s, seed, &p);
        stir(&s, seed, locked);
        assert_true(s.sim->scene->constraint_row_count <= EQUATIONS_MAX);
        worst[0] = fmax(worst[0], jacobian_error(&s));
        check_rates(&s, error);
        for (int k = 0; k < 3; k++) worst[1 + k] = fmax(worst[1 + k], error[k]);
        rig_close(&s);
    }
    (void)snprintf(what, sizeof what, "%s: Jacobian", name);
    check_below(what, worst[0], 1e-9);
    (void)snprintf(what, sizeof what, "%s: B v + rate", name);
    check_below(what, worst[1], 1e-9);
    (void)snprintf(what, sizeof what, "%s: convective", name);
    check_below(what, worst[2], 1e-9);
    if (path) return;
    (void)snprintf(what, sizeof what, "%s: convective of callbacks, by differences of their own", name);
    check_below(what, worst[3], 1e-8); /* rounding of values of 10 over (2e-3)^2 */
}

static void rows_of_every_kind(void **state)
{
    (void)state;
    check_rows("every kind", 0, 0);
}

static void rows_of_locked_joints(void **state)
{
    (void)state;
    check_rows("every kind locked", 0, 1);
}

static void rows_of_nodes_on_a_straight_axis(void **state)
{
    (void)state;
    check_rows("on axial-torsional pipes", 1, 0);
    check_rows("on axial-torsional pipes, locked", 1, 1);
}

/* ---- Tangent ----------------------------------------------------------------------------------------------------- */

static void evaluate(dmb_sim *sim, dmb_evaluation *e)
{
    assert_int_equal(dmb_clusters_assemble(e), DMB_OK);
    assert_int_equal(dmb_system_evaluate(e), DMB_OK);
    (void)sim;
}

static void column_by_differences(dmb_sim *sim, int by_velocity, uint32_t node, uint32_t c, double out[ROWS_MAX])
{
    static double f[6][ROWS_MAX];
    const double step = by_velocity ? 1e-3 : 3e-4;
    for (int k = 0; k < 6; k++) {
        dmb_evaluation e = evaluation_of(sim, by_velocity);
        move_row(sim, by_velocity, node, c, step * difference6_place[k]);
        evaluate(sim, &e);
        memcpy(f[k], sim->residual, sim->scene->row_count * sizeof(double));
    }
    for (uint32_t i = 0; i < sim->scene->row_count; i++) {
        const double v[6] = {f[0][i], f[1][i], f[2][i], f[3][i], f[4][i], f[5][i]};
        out[i] = difference6(v, step);
    }
}

static void add_blocks(const dmb_sim *sim, double A[][ROWS_MAX])
{
    const dmb_block_layout *l = &sim->scene->layout;
    for (uint32_t i = 0; i < sim->scene->node_count; i++)
        for (uint32_t c = 0; c < l->size[i]; c++) {
            double *column = A[l->row[i] + c];
            for (uint32_t r = 0; r < l->size[i]; r++) {
                const size_t at = l->diag[i] + (size_t)l->size[i] * r + c;
                column[l->row[i] + r] += sim->stiffness_diagonal[at] + sim->inertia_diagonal[at];
            }
            if (sim->scene->node_element[i] != DMB_NONE)
                for (uint32_t r = 0; r < l->size[i + 1]; r++) {
                    const size_t at = l->link[i] + (size_t)l->size[i] * r + c;
                    column[l->row[i + 1] + r] += sim->stiffness_lower[at];
                }
            if (i > 0 && sim->scene->node_element[i - 1] != DMB_NONE)
                for (uint32_t r = 0; r < l->size[i - 1]; r++) {
                    const size_t at = l->link[i - 1] + (size_t)l->size[i] * r + c;
                    column[l->row[i - 1] + r] += sim->stiffness_upper[at];
                }
        }
}

static uint32_t row_of_column(const dmb_scene *scene, const dmb_constraint *c, uint32_t column)
{
    uint32_t i = 0;
    while (i + 1 < c->node_count && c->column[i + 1] <= column) i++;
    return scene->layout.row[c->node[i]] + column - c->column[i];
}

static void add_joint_tangents(const dmb_sim *sim, double A[][ROWS_MAX])
{
    const dmb_scene *scene = sim->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t r = 0; r < c->columns; r++)
            for (uint32_t k = 0; k < c->columns; k++)
                A[row_of_column(scene, c, k)][row_of_column(scene, c, r)] +=
                    sim->constraint_tangent[c->tangent + (size_t)r * c->columns + k];
    }
}

/* A[column][row]; by velocity it is what a velocity factor of 1 adds. */
static void tangent_of(dmb_sim *sim, int by_velocity, double A[][ROWS_MAX])
{
    static double without[ROWS_MAX][ROWS_MAX];
    memset(A, 0, sizeof without);
    for (int pass = 0; pass < 1 + by_velocity; pass++) {
        double(*to)[ROWS_MAX] = pass == 0 ? A : without;
        dmb_evaluation e = evaluation_of(sim, by_velocity);
        e.tangent = 1;
        e.velocity_factor = by_velocity && pass == 0 ? 1.0 : 0.0;
        memset(to, 0, sizeof without);
        move_row(sim, 1, 0, 0, 0.0);
        evaluate(sim, &e);
        add_blocks(sim, to);
        add_joint_tangents(sim, to);
    }
    for (uint32_t i = 0; i < sim->scene->row_count && by_velocity; i++)
        for (uint32_t k = 0; k < sim->scene->row_count; k++) A[i][k] -= without[i][k];
}

static double tangent_error(rig *s, int by_velocity)
{
    static double A[ROWS_MAX][ROWS_MAX], want[ROWS_MAX];
    const dmb_scene *scene = s->sim->scene;
    double worst = 0.0;
    assert_true(scene->row_count <= ROWS_MAX);
    tangent_of(s->sim, by_velocity, A);
    for (uint32_t i = 0; i < scene->node_count; i++)
        for (uint32_t c = 0; c < scene->layout.size[i]; c++) {
            const uint32_t column = scene->layout.row[i] + c;
            column_by_differences(s->sim, by_velocity, i, c, want);
            const double error =
                largest_difference(scene->row_count, A[column], want) / fmax(1.0, largest(scene->row_count, want));
            if (error > 1e-8 && error > worst) print_message("      node %u, component %u\n", i, c);
            worst = fmax(worst, error);
        }
    return worst;
}

/* Callbacks without a Jacobian add no curvature: their multipliers are 0 here. */
static void clear_rough_callbacks(dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->callback_count; i++) {
        const dmb_scene_callback *callback = sim->scene->callbacks + i;
        if (callback->provides & DMB_PROVIDES_JACOBIAN) continue;
        const uint32_t row = sim->scene->constraints[callback->constraint].row;
        for (uint32_t k = 0; k < callback->rows; k++) sim->now.multiplier[row + k] = 0.0;
    }
}

static void check_tangent(const char *name, int32_t path, int32_t locked)
{
    char what[128];
    double worst[2] = {0.0, 0.0};
    for (uint64_t seed = 1; seed <= 3; seed++) {
        rig s;
        parts p;
        if (path)
            open_path_scene(&s, seed);
        else
            open_scene(&s, seed, &p);
        stir(&s, seed, locked);
        clear_rough_callbacks(s.sim);
        for (int k = 0; k < 2; k++) worst[k] = fmax(worst[k], tangent_error(&s, k));
        rig_close(&s);
    }
    (void)snprintf(what, sizeof what, "%s: residual by pose", name);
    check_below(what, worst[0], 1e-9);
    (void)snprintf(what, sizeof what, "%s: residual by velocity", name);
    check_below(what, worst[1], 1e-9);
}

static void tangent_of_every_kind(void **state)
{
    (void)state;
    check_tangent("every kind", 0, 0);
}

static void tangent_of_locked_joints(void **state)
{
    (void)state;
    check_tangent("every kind locked", 0, 1);
}

static void tangent_on_a_straight_axis(void **state)
{
    (void)state;
    check_tangent("on axial-torsional pipes", 1, 0);
    check_tangent("on axial-torsional pipes, locked", 1, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_of_every_kind),
        cmocka_unit_test(rows_of_locked_joints),
        cmocka_unit_test(rows_of_nodes_on_a_straight_axis),
        cmocka_unit_test(tangent_of_every_kind),
        cmocka_unit_test(tangent_of_locked_joints),
        cmocka_unit_test(tangent_on_a_straight_axis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
