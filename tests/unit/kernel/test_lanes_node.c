/* Kernels of rigid masses, weight and external damping: every width gives the bits of nodes one at a time, and these
 * follow Newton and Euler about the centre of mass. */
#include <string.h>

#include "check.h"
#include "kernel/kernels.h"
#include "math/so3.h"

enum { NODES = 21, FIRST = 3, ROWS = 6 * NODES, BLOCKS = 36 * NODES };

typedef struct node_input {
    dmb_rigid_mass rigid_masses[NODES];
    uint32_t rigid_mass_count;
    double gravity[3], weight_mass[NODES], weight_moment[3 * NODES], damping[5 * NODES];
    double quaternion[4 * NODES], velocity[ROWS], acceleration[ROWS];
} node_input;

typedef struct node_output {
    double residual[ROWS], scale[ROWS], stiffness[BLOCKS], inertia[BLOCKS], power[3];
} node_output;

/* One way of asking. Of every `spacing` nodes one has a rigid_mass; 0: none. */
typedef struct node_case {
    int32_t gravity, damping, dynamic, tangent;
    uint32_t spacing;
} node_case;

static void draw_all(uint64_t *seed, size_t n, double *x)
{
    for (size_t i = 0; i < n; i++) x[i] = draw_between(seed, -1.0, 1.0);
}

static void draw_input(uint64_t *seed, uint32_t spacing, node_input *in)
{
    memset(in, 0, sizeof *in);
    for (uint32_t i = 0; i < NODES; i++) {
        double O[3], R[9];
        draw_all(seed, 3, O);
        dmb_so3_exp(O, NULL, R);
        dmb_quat_from_matrix(R, in->quaternion + 4 * i);
        if (spacing == 0 || i % spacing) continue;
        dmb_rigid_mass *rigid_mass = in->rigid_masses + in->rigid_mass_count++;
        rigid_mass->node = FIRST + i;
        rigid_mass->mass = draw_between(seed, 1.0, 2.0);
        draw_all(seed, 3, rigid_mass->moment);
        draw_all(seed, 6, rigid_mass->inertia);
    }
    draw_all(seed, 3, in->gravity);
    draw_all(seed, NODES, in->weight_mass);
    draw_all(seed, 3 * NODES, in->weight_moment);
    draw_all(seed, 5 * NODES, in->damping);
    draw_all(seed, ROWS, in->velocity);
    draw_all(seed, ROWS, in->acceleration);
}

/* Nodes first .. first + count - 1, from and to the places where they stand. */
static dmb_node_force_args run_of(const node_case *c, const node_input *in, node_output *out, uint32_t first,
                                  uint32_t count)
{
    const dmb_node_force_args args = {
        .count = count,
        .first = FIRST + first,
        .rigid_masses = in->rigid_masses,
        .rigid_mass_count = c->dynamic ? in->rigid_mass_count : 0,
        .dynamic = c->dynamic,
        .tangent = c->tangent,
        .mass_factor = 3.0e5,
        .velocity_factor = 1700.0,
        .load_factor = 0.75,
        .gravity = c->gravity ? in->gravity : NULL,
        .weight_mass = in->weight_mass + first,
        .weight_moment = in->weight_moment + 3 * first,
        .damping = c->damping && c->dynamic ? in->damping + 5 * first : NULL,
        .quaternion = in->quaternion + 4 * first,
        .velocity = in->velocity + 6 * first,
        .acceleration = in->acceleration + 6 * first,
        .residual = out->residual + 6 * first,
        .scale = out->scale + 6 * first,
        .stiffness = out->stiffness + 36 * first,
        .inertia = out->inertia + 36 * first,
        .inertia_power = out->power[0],
        .potential = out->power[1],
        .damping_power = out->power[2],
    };
    return args;
}

static void run_part(const dmb_kernels *kernels, const node_case *c, const node_input *in, node_output *out,
                     uint32_t first, uint32_t count)
{
    dmb_node_force_args args = run_of(c, in, out, first, count);
    while (args.rigid_mass_count > 0 && args.rigid_masses->node < args.first)
        args.rigid_masses++, args.rigid_mass_count--;
    kernels->node_forces(&args);
    out->power[0] = args.inertia_power;
    out->power[1] = args.potential;
    out->power[2] = args.damping_power;
}

static void compare_widths(const node_case *c, const node_input *in)
{
    node_output alone, out;
    memset(&alone, 0, sizeof alone);
    for (uint32_t i = 0; i < NODES; i++) run_part(dmb_kernels_of(1), c, in, &alone, i, 1);
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
        if (!dmb_kernels_of(lanes)) continue;
        memset(&out, 0, sizeof out);
        run_part(dmb_kernels_of(lanes), c, in, &out, 0, NODES);
        assert_memory_equal(&out, &alone, sizeof out);
        memset(&out, 0, sizeof out);
        run_part(dmb_kernels_of(lanes), c, in, &out, 0, 7);
        run_part(dmb_kernels_of(lanes), c, in, &out, 7, NODES - 7);
        assert_memory_equal(&out, &alone, sizeof out);
    }
    if (c->spacing == 1 && c->dynamic) assert_true(largest(ROWS, alone.residual) > 1.0);
    if (!c->tangent) assert_true(largest(BLOCKS, alone.stiffness) == 0.0 && largest(BLOCKS, alone.inertia) == 0.0);
}

static void all_widths_give_the_same_bits(void **state)
{
    uint64_t seed = 11;
    uint32_t cases = 0;
    node_input in;
    (void)state;
    for (uint32_t i = 0; i < 16 * 4 * 4; i++) {
        const node_case c = {i % 2, i / 2 % 2, i / 4 % 2, i / 8 % 2, i / 16 % 4};
        draw_input(&seed, c.spacing, &in);
        compare_widths(&c, &in);
        cases++;
    }
    tell("configurations [-]", cases);
}

/* A point mass m at x: force m (a + w' x x + w x v_x - R^T g), v_x = u + w x x, at x; a - u' in the turning frame. */
static void point_mass(const node_input *in, uint32_t node, double m, const double x[3], double out[6])
{
    const double *v = in->velocity + 6 * node, *a = in->acceleration + 6 * node;
    double at[3], speed[3], turn[3], weight[3], R[9];
    dmb_vec3_cross(v + 3, x, speed);
    dmb_vec3_add(speed, v, speed);
    dmb_vec3_cross(a + 3, x, at);
    dmb_vec3_add(at, a, at);
    dmb_vec3_cross(v + 3, speed, turn);
    dmb_vec3_add(at, turn, at);
    dmb_quat_to_matrix(in->quaternion + 4 * node, R);
    dmb_mat3_tvec(R, in->gravity, weight);
    dmb_vec3_axpy(-0.75, weight, at);
    dmb_vec3_scale(m, at, out);
    dmb_vec3_cross(x, out, out + 3);
}

static void forces_are_those_of_point_masses(void **state)
{
    const node_case c = {1, 0, 1, 1, 1};
    uint64_t seed = 5;
    node_input in;
    node_output out;
    double expected[ROWS];
    (void)state;
    memset(&out, 0, sizeof out);
    draw_input(&seed, 1, &in);
    for (uint32_t i = 0; i < NODES; i++) {
        const double m = in.rigid_masses[i].mass;
        double x[3];
        draw_all(&seed, 3, x);
        const double square = dmb_vec3_norm_squared(x);
        for (int k = 0; k < 3; k++) {
            in.rigid_masses[i].moment[k] = in.weight_moment[3 * i + (uint32_t)k] = m * x[k];
            in.rigid_masses[i].inertia[k] = m * (square - x[k] * x[k]);
        }
        in.rigid_masses[i].inertia[3] = -m * x[0] * x[1];
        in.rigid_masses[i].inertia[4] = -m * x[0] * x[2];
        in.rigid_masses[i].inertia[5] = -m * x[1] * x[2];
        in.weight_mass[i] = m;
        point_mass(&in, i, m, x, expected + 6 * i);
    }
    run_part(dmb_kernels_widest(), &c, &in, &out, 0, NODES);
    check_below("residual of point masses, relative",
                largest_difference(ROWS, out.residual, expected) / largest(ROWS, expected), 2e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_widths_give_the_same_bits),
        cmocka_unit_test(forces_are_those_of_point_masses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
