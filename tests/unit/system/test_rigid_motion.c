/* Rigid motion of a deformed string: random shapes, 1, 2 and 4 elements a pipe, straight and bent pipes. In translation
 * momentum is mass times speed and the kinetic energy m v^2/2, whatever the shape; a rotation and a shift of the whole
 * state change neither energies nor the forces in the pipes. Bent pipes have the mass of their shape; described
 * straight, that of straight ones, off by less than 2e-5 up to bends of 0.01 rad in an element
 * (eq:curved.kinetic-energy). */
#include "math/so3.h"
#include "math/vec3.h"
#include "rig.h"
#include "sim/sim.h"
#include "system/assemble/energy.h"

enum { PIPES = 3, SEEDS = 40 };

static uint64_t bits = 1;

/* splitmix64, -1 .. 1 */
static double drawn(void)
{
    uint64_t z = bits += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return 2.0 * (double)((z ^ z >> 31) >> 11) * 0x1p-53 - 1.0;
}

static void open_string(rig *s, uint32_t elements, int bent)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    pipe.length = 3.0 + drawn();
    pipe.elements = elements;
    if (bent) pipe.curvature[1] = 0.1 + 0.05 * drawn();
    rig_open(s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = string.end_free = DMB_FREE_ALL;
    pipe.string = add_string(s, &string);
    add_pipes(s, &pipe, PIPES);
    (void)rig_start(s, NULL);
}

/* exp(turn) of a node on the right of its orientation, or on the left. */
static void turn_node(const dmb_sim *sim, uint32_t node, const double turn[3], int left)
{
    double step[4], *q = sim->now.quaternion + 4 * (size_t)node, before[4];
    dmb_quat_copy(q, before);
    dmb_quat_exp(turn, step);
    if (left)
        dmb_quat_mul(step, before, q);
    else
        dmb_quat_mul(before, step, q);
    dmb_quat_normalize(q);
}

/* Every node moves by `size` times 0.3 m and turns by `size` times 1 rad at most. */
static void deform(const dmb_sim *sim, double size)
{
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        const double turn[3] = {size * drawn(), 0.5 * size * drawn(), 0.5 * size * drawn()};
        for (uint32_t k = 0; k < 3; k++) sim->now.displacement[3 * i + k] += 0.3 * size * drawn();
        turn_node(sim, i, turn, 0);
    }
}

/* x -> R x + shift, R = exp(turn); velocities in body axes are the same. */
static void move_all(const dmb_sim *sim, const double turn[3], const double shift[3])
{
    double q[4], R[9];
    dmb_quat_exp(turn, q);
    dmb_quat_to_matrix(q, R);
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        const double *at = sim->scene->reference_position + 3 * (size_t)i;
        double *u = sim->now.displacement + 3 * (size_t)i, x[3], moved[3];
        dmb_vec3_add(at, u, x);
        dmb_mat3_vec(R, x, moved);
        for (int k = 0; k < 3; k++) u[k] = moved[k] + shift[k] - at[k];
        turn_node(sim, i, turn, 1);
    }
}

static void translate(const dmb_sim *sim, const double v[3])
{
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        double R[9], *row = sim->now.velocity + sim->scene->layout.row[i];
        dmb_quat_to_matrix(sim->now.quaternion + 4 * (size_t)i, R);
        dmb_mat3_tvec(R, v, row);
        row[3] = row[4] = row[5] = 0.0;
    }
}

typedef struct figures {
    double momentum, kinetic, energies, forces; /* [-] largest deviations */
} figures;

static void check_translation(const rig *s, figures *worst)
{
    const double v[3] = {drawn(), drawn(), drawn()}, speed = dmb_vec3_norm(v);
    translate(s->sim, v);
    const dmb_momentum p = momentum_of(s);
    const double kinetic = dmb_kinetic_energy(s->sim->scene, &s->sim->now);
    for (int k = 0; k < 3; k++)
        worst->momentum = fmax(worst->momentum, fabs(p.linear[k] - p.mass * v[k]) / (p.mass * speed));
    worst->kinetic = fmax(worst->kinetic, fabs(kinetic / (0.5 * p.mass * speed * speed) - 1.0));
}

static void check_moved(const rig *s, figures *worst)
{
    const dmb_scene *scene = s->sim->scene;
    const dmb_configuration *now = &s->sim->now;
    const double turn[3] = {2.0 * drawn(), drawn(), drawn()};
    const double shift[3] = {50.0 * drawn(), 50.0 * drawn(), 50.0 * drawn()};
    double before[12], after[12], size = 0.0, apart = 0.0;
    for (uint32_t i = 0; i < scene->row_count; i++) now->velocity[i] = drawn();
    const double kinetic = dmb_kinetic_energy(scene, now), strain = dmb_strain_energy(scene, now);
    dmb_element_section_force(scene, now, 1, before);
    move_all(s->sim, turn, shift);
    dmb_element_section_force(scene, now, 1, after);
    worst->energies = fmax(worst->energies, fabs(dmb_strain_energy(scene, now) / strain - 1.0));
    worst->energies = fmax(worst->energies, fabs(dmb_kinetic_energy(scene, now) / kinetic - 1.0));
    for (int i = 0; i < 12; i++) {
        size = fmax(size, fabs(before[i]));
        apart = fmax(apart, fabs(after[i] - before[i]));
    }
    worst->forces = fmax(worst->forces, apart / size);
}

static figures rigid_motion(int bent, double size)
{
    figures worst = {0.0, 0.0, 0.0, 0.0};
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        rig s;
        bits = seed;
        open_string(&s, 1U << seed % 3, bent);
        deform(s.sim, size);
        check_translation(&s, &worst);
        check_moved(&s, &worst);
        rig_close(&s);
    }
    print_message("%d shapes, %s: momentum %.1e, kinetic energy %.1e, energies moved %.1e, forces %.1e\n", SEEDS,
                  bent ? "bent" : "straight", worst.momentum, worst.kinetic, worst.energies, worst.forces);
    check_below("energies of a state that is moved", worst.energies, 1e-9);
    check_below("forces of a state that is moved", worst.forces, 1e-9);
    return worst;
}

static void bent_pipes(void **state)
{
    (void)state;
    const figures worst = rigid_motion(1, 0.05);
    check_below("momentum of translation", worst.momentum, 1e-12);
    check_below("kinetic energy of translation", worst.kinetic, 1e-12);
}

static void straight_pipes(void **state)
{
    (void)state;
    const figures worst = rigid_motion(0, 0.004);
    check_below("momentum of translation", worst.momentum, 2e-5);
    check_below("kinetic energy of translation", worst.kinetic, 2e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bent_pipes), cmocka_unit_test(straight_pipes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
