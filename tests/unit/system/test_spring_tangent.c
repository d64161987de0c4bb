/* Iteration matrix of springs, of stuck places, of bits that cut sideways, of loads at any place and of the caller's
 * forces (within nodes, inside elements, across parts) against differences of the residual by the increments of a step,
 * which move poses and velocities together; and the force of springs and stuck places against differences of their
 * energy. Checks eq:motion.section-map, eq:motion.spring, eq:motion.caller-force and eq:motion.stuck. */
#include <string.h>

#include "mechanism.h"
#include "moved_rig.h"

#include "drillmbd/scene.h"
#include "system/assemble/assemble.h"

/* ---- Scene ------------------------------------------------------------------------------------------------------- */

typedef struct parts {
    dmb_id beam, bar, body[2];
} parts;

static void add_parts(rig *s, parts *p)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(1.3, 2, 90.0, 40.0, 30.0, 20.0);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_ALL;
    pipe.joint_length = 0.1;
    pipe.damping_time = 0.01;
    pipe.string = p->beam = add_string(s, &string);
    (void)add_pipes(s, &pipe, 2);
    string.position[1] = 1.5;
    string.start_free = DMB_FREE_CYLINDRICAL;
    pipe.joint_length = 0.0;
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.string = p->bar = add_string(s, &string);
    (void)add_pipes(s, &pipe, 2);
    for (int i = 0; i < 2; i++) {
        dmb_body_def body = dmb_body_def_default();
        body.position[0] = 0.7 + i;
        body.position[2] = 1.0;
        body.rotation[1] = 0.4 - i;
        body.centre[1] = 0.1;
        for (int k = 0; k < 3; k++) body.inertia[k] = 0.2 + 0.05 * k;
        p->body[i] = add_body(s, &body);
    }
}

static dmb_place nowhere(void)
{
    return dmb_station(ground_id, 0, 0.0);
}

static const double table_x[4] = {-0.5, 0.1, 0.4, 2.0}, table_f[4] = {-3.0, 1.0, 2.0, 6.0};

static void add_spring(rig *s, int32_t acts, int32_t table, dmb_place a, dmb_place b, uint64_t seed)
{
    dmb_spring_def def = dmb_spring_def_default();
    def.acts = acts;
    def.place_a = a;
    def.place_b = b;
    for (int i = 0; i < 3; i++) {
        def.offset_a[i] = draw_between(&seed, -0.4, 0.4);
        def.offset_b[i] = draw_between(&seed, -0.4, 0.4);
    }
    def.free_length = acts == DMB_SPRING_COMPRESSION ? 4.0 : 0.3;
    def.stiffness = draw_between(&seed, 2.0, 6.0);
    def.damping = draw_between(&seed, 0.2, 0.8);
    if (table) {
        def.table_elongation = table_x;
        def.table_force = table_f;
        def.table_count = 4;
        def.table_kind = DMB_TABLE_CUBIC;
        def.preload = 0.5;
    }
    must_model(s, dmb_model_add_spring(s->model, &def, NULL));
}

/* Pairs that need no coupling of parts, then those that do. */
static void add_springs(rig *s, const parts *p, int across)
{
    const dmb_place inside = dmb_station(p->beam, 0, 0.3), joint = dmb_station(p->beam, 0, 1.0);
    const dmb_place inner = dmb_station(p->beam, 1, 0.15), body = dmb_station(p->body[0], 0, 0.0);
    add_spring(s, DMB_SPRING_BOTH, 0, nowhere(), inside, 3);
    add_spring(s, DMB_SPRING_BOTH, 1, dmb_station(p->beam, 0, 0.1), inside, 4);
    add_spring(s, DMB_SPRING_TENSION, 1, joint, nowhere(), 5);
    add_spring(s, DMB_SPRING_COMPRESSION, 0, nowhere(), body, 6);
    add_spring(s, DMB_SPRING_BOTH, 0, joint, inner, 7);
    add_spring(s, DMB_SPRING_BOTH, 0, nowhere(), dmb_station(p->bar, 0, 0.8), 8);
    add_spring(s, DMB_SPRING_BOTH, 0, nowhere(), dmb_station(p->bar, 1, 1.0), 9);
    if (!across) return;
    add_spring(s, DMB_SPRING_BOTH, 1, dmb_station(p->body[1], 0, 0.0), inside, 10);
    add_spring(s, DMB_SPRING_TENSION, 0, dmb_station(p->bar, 0, 0.6), dmb_station(p->beam, 1, 0.7), 11);
    add_spring(s, DMB_SPRING_BOTH, 0, body, dmb_station(p->body[1], 0, 0.0), 12);
    add_spring(s, DMB_SPRING_BOTH, 1, dmb_station(p->beam, 0, 0.05), dmb_station(p->beam, 1, 0.97), 13);
}

static void add_loads(rig *s, const parts *p)
{
    const dmb_place places[3] = {dmb_station(p->beam, 0, 0.37), dmb_station(p->beam, 1, 1.0),
                                 dmb_station(p->body[1], 0, 0.0)};
    uint64_t seed = 20;
    for (int i = 0; i < 6; i++) {
        dmb_load_def load = dmb_load_def_default();
        load.place = places[i % 3];
        load.frame = i < 3 ? DMB_FRAME_WORLD : DMB_FRAME_BODY;
        for (int k = 0; k < 3; k++) {
            load.force[k] = draw_between(&seed, -3.0, 3.0);
            load.moment[k] = draw_between(&seed, -1.0, 1.0);
            load.offset[k] = draw_between(&seed, -0.3, 0.3);
        }
        must_model(s, dmb_model_add_load(s->model, &load, NULL));
    }
}

/* Some smooth function of all that it is told, different in each component. */
static int32_t any_force(void *context, double time, uint32_t count, const double (*poses)[12],
                         const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                         const dmb_law_memory *memory)
{
    (void)memory;
    const uint32_t joint = *(const uint32_t *)context; /* number of the argument that is one, or more than there are */
    (void)time, (void)tangent, (void)potential;
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 6; k++) {
            double sum = 0.3 * k - 1.0;
            for (uint32_t j = 0; j < count; j++) {
                for (int m = 0; m < (j == joint ? 1 : 12); m++) sum += sin(1.0 + i + j + 2.0 * k + m) * poses[j][m];
                for (int m = 0; m < (j == joint ? 1 : 6); m++)
                    sum += 0.2 * cos(1.0 * i + j + k + 3.0 * m) * velocities[j][m];
            }
            forces[i][k] = sin(sum) + 0.1 * sum * sum;
        }
    return 0;
}

/* In the axes of the world and of the places: within an element alone; across parts, with a joint's coordinate. */
static void add_forces(rig *s, const parts *p, int across)
{
    static uint32_t none = 9, third = 2;
    uint64_t seed = 40;
    for (int32_t frame = DMB_FRAME_WORLD; frame <= DMB_FRAME_BODY; frame++) {
        dmb_force_def def = dmb_force_def_default();
        def.frame = frame;
        def.callback = any_force;
        def.callback_context = &none;
        def.place_count = 2;
        def.pose_step = def.speed_step = 1e-3;
        def.place[0] = dmb_station(p->beam, 0, 0.3);
        def.place[1] = dmb_station(p->beam, 0, 0.1);
        for (int k = 0; k < 12; k++) def.offset[k] = draw_between(&seed, -0.2, 0.2);
        must_model(s, dmb_model_add_force(s->model, &def, NULL));
        if (!across) continue;
        dmb_joint_def joint =
            joint_between(DMB_JOINT_FREE, dmb_station(p->body[0], 0, 0.0), dmb_station(p->body[1], 0, 0.0));
        def.place_count = 4;
        def.place[1] = dmb_station(p->body[1], 0, 0.0);
        def.place[2] = dmb_station(add_joint(s, &joint), 0, 0.0);
        def.component[2] = frame == DMB_FRAME_WORLD ? DMB_Y : DMB_RY;
        def.place[3] = dmb_station(p->bar, 1, 0.4);
        def.callback_context = &third;
        must_model(s, dmb_model_add_force(s->model, &def, NULL));
    }
}

/* Inside elements, on nodes, of beams, bars and a body; what bars cannot hold is left out there. */
static void add_stuck(rig *s, const parts *p)
{
    const dmb_place places[5] = {dmb_station(p->beam, 0, 0.3), dmb_station(p->beam, 1, 1.0),
                                 dmb_station(p->body[0], 0, 0.0), dmb_station(p->bar, 0, 0.8),
                                 dmb_station(p->bar, 1, 1.0)};
    uint64_t seed = 60;
    for (int i = 0; i < 5; i++) {
        dmb_stuck_def def = dmb_stuck_def_default();
        def.place = places[i];
        def.holds = i < 3 ? 7 : DMB_STUCK_AXIAL | DMB_STUCK_ROTATION;
        for (int k = 0; k < 3; k++) {
            def.stiffness[k] = draw_between(&seed, 2.0, 6.0);
            def.damping[k] = draw_between(&seed, 0.2, 0.8);
        }
        must_model(s, dmb_model_add_stuck(s->model, &def, NULL));
    }
}

/* Off the node, with a walk angle; a rock law would be no smooth function of the motion. */
static void add_side_cutting(rig *s, const parts *p)
{
    dmb_bit_def bit = dmb_bit_def_default();
    bit.string = p->beam;
    bit.diameter = 0.0;
    bit.intrinsic_energy = 10.0;
    bit.side_cutting = 0.7;
    bit.walk_angle = 0.4;
    must_model(s, dmb_model_add_bit(s->model, &bit, NULL));
}

static void open_scene(rig *s, int springs, int loads, int across)
{
    parts p;
    rig_open(s, 0.0, 0.0, 0.0);
    add_parts(s, &p);
    if (springs & 1) add_springs(s, &p, across);
    if (springs & 2) add_forces(s, &p, across);
    if (springs & 4) add_stuck(s, &p);
    if (springs & 8) add_side_cutting(s, &p);
    if (loads) add_loads(s, &p);
    (void)mechanism_start(s, NULL);
    assert_true(s->sim->scene->row_count <= ROWS_MAX);
    assert_int_equal(s->sim->scene->cluster_count > 0, across);
}

static void stir_poses(rig *s, uint64_t seed)
{
    dmb_configuration *now = &s->sim->now;
    const dmb_scene *scene = s->sim->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        double h[6];
        for (int k = 0; k < 6; k++) h[k] = draw_between(&seed, -0.2, 0.2);
        if (scene->layout.size[i] == DMB_NODE_SIX_DOF) {
            dmb_se3_advance(now->quaternion + 4 * i, now->displacement + 3 * i, h);
        } else {
            now->displacement[3 * i] += h[0];
            now->turn[i] += h[1];
        }
    }
    for (uint32_t r = 0; r < scene->row_count; r++) now->velocity[r] = draw_between(&seed, -0.5, 0.5);
}

/* ---- Differences ------------------------------------------------------------------------------------------------- */

static void add_constraints(const dmb_sim *sim, double got[ROWS_MAX][ROWS_MAX])
{
    const dmb_block_layout *l = &sim->scene->layout;
    for (uint32_t k = 0; k < sim->scene->constraint_count; k++) {
        const dmb_constraint *c = sim->scene->constraints + k;
        const double *K = sim->constraint_tangent + c->tangent;
        for (uint32_t a = 0; a < c->node_count; a++)
            for (uint32_t b = 0; b < c->node_count; b++)
                for (uint32_t r = 0; r < l->size[c->node[a]]; r++)
                    for (uint32_t s = 0; s < l->size[c->node[b]]; s++)
                        got[l->row[c->node[a]] + r][l->row[c->node[b]] + s] +=
                            K[(c->column[a] + r) * c->columns + c->column[b] + s];
    }
}

static double worst_entry(dmb_sim *sim, const double *base, int32_t dynamic)
{
    static double want[ROWS_MAX][ROWS_MAX], got[ROWS_MAX][ROWS_MAX];
    const uint32_t rows = sim->scene->row_count;
    double worst = 0.0, size = 0.0;
    memset(got, 0, sizeof got);
    matrix_by_differences(sim, dynamic, base, want);
    make_matrix(sim, dynamic, base);
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j < rows; j++) got[i][j] = block_entry(sim, i, j);
    add_constraints(sim, got);
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j < rows; j++) {
            if (!sim->scene->solved_row[i] || !sim->scene->solved_row[j]) continue;
            worst = fmax(worst, fabs(got[i][j] - want[i][j]));
            size = fmax(size, fabs(want[i][j]));
        }
    return worst / size;
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static double worst_of(int springs, int loads, int across, int32_t dynamic)
{
    double base[ROWS_MAX], worst = 0.0;
    for (uint64_t seed = 1; seed <= 2; seed++) {
        uint64_t draw = seed + 50;
        rig s;
        open_scene(&s, springs, loads, across);
        stir_poses(&s, seed);
        for (uint32_t i = 0; i < s.sim->scene->row_count; i++) base[i] = dynamic ? draw_between(&draw, -0.1, 0.1) : 0.0;
        worst = fmax(worst, worst_entry(s.sim, base, dynamic));
        rig_close(&s);
    }
    return worst;
}

static void matrix_is_the_derivative(void **state)
{
    (void)state;
    check_below("scene without springs and loads, step", worst_of(0, 0, 0, 1), 1e-9);
    check_below("loads at points, step", worst_of(0, 1, 0, 1), 1e-9);
    check_below("springs within nodes and elements, step", worst_of(1, 0, 0, 1), 1e-9);
    check_below("springs across parts, step", worst_of(1, 1, 1, 1), 1e-9);
    check_below("stuck places, step", worst_of(4, 0, 0, 1), 1e-9);
    check_below("a bit that cuts sideways, step", worst_of(8, 0, 0, 1), 1e-9);
    check_below("the caller's forces within an element, step", worst_of(2, 0, 0, 1), 1e-8);
}

static void static_matrix_is_the_derivative(void **state)
{
    (void)state;
    check_below("loads at points, statics", worst_of(0, 1, 0, 0), 1e-9);
    check_below("springs within nodes and elements, statics", worst_of(1, 0, 0, 0), 1e-9);
    check_below("springs across parts, statics", worst_of(1, 1, 1, 0), 1e-9);
    check_below("stuck places, statics", worst_of(4, 0, 0, 0), 1e-9);
    check_below("the caller's forces within an element, statics", worst_of(2, 0, 0, 0), 1e-8);
    check_below("the caller's forces across parts, statics", worst_of(2, 0, 1, 0), 1e-8);
}

/* Residual of springs alone by a displacement z of each row: dE/dz. */
static void compare_energy(int springs, int across)
{
    double base[ROWS_MAX] = {0.0}, with[ROWS_MAX], worst = 0.0;
    dmb_evaluation e;
    rig s;
    open_scene(&s, springs, 0, across);
    stir_poses(&s, 7);
    dmb_sim *sim = s.sim;
    const uint32_t rows = sim->scene->row_count;
    move_to(sim, 0, base, 0, 0.0);
    evaluate(sim, 0, 0, &e);
    memcpy(with, sim->residual, rows * sizeof(double));
    dmb_scene bare = *sim->scene;
    const dmb_scene *scene = sim->scene;
    bare.spring_count = bare.stuck_count = 0;
    sim->scene = &bare;
    evaluate(sim, 0, 0, &e);
    sim->scene = scene;
    for (uint32_t i = 0; i < rows; i++) {
        double f[6];
        for (int p = 0; p < 6; p++) {
            move_to(sim, 0, base, i, 2e-4 * difference6_place[p]);
            f[p] = dmb_springs_energy(scene, &sim->trial) + dmb_stuck_energy(sim, &sim->trial);
        }
        worst = fmax(worst, fabs(with[i] - sim->residual[i] - difference6(f, 2e-4)));
    }
    check_below("forces against differences of their energy [N, N m]", worst, 1e-9);
    rig_close(&s);
}

static void forces_come_of_the_energy(void **state)
{
    (void)state;
    compare_energy(1, 1);
    compare_energy(4, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrix_is_the_derivative),
        cmocka_unit_test(static_matrix_is_the_derivative),
        cmocka_unit_test(forces_come_of_the_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
