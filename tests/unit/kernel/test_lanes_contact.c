/* Contact kernels: every width gives the bits of one lane, whichever rings share a group, and rings that do not touch
 * leave no trace; so do contact points inside elements. Equations: eq:contact.frame, eq:contact.inside. */
#include <string.h>

#include "check.h"
#include "kernel/kernels.h"
#include "math/so3.h"

enum {
    NODES = 9,
    SITES = 21,
    ROWS = 6 * NODES,
    BLOCKS = 36 * NODES,
    STATIONS = 4,
    PIECES = 4,
    ELEMENTS = NODES - 1,
    LINKS = 36 * ELEMENTS,
    TYPES = 3
};

#ifdef DMB_SOME_CASES
enum { SEEDS = 1 };
#else
enum { SEEDS = 6 };
#endif

/* Inputs and outputs of a run (outputs are compared byte by byte). */
typedef struct wall_input {
    dmb_site sites[SITES];
    dmb_hole hole;
    dmb_hole_station station[STATIONS];
    dmb_hole_piece piece[PIECES];
    dmb_normal_law normal_law;
    dmb_friction_law friction_law;
    uint32_t row[NODES], diagonal[NODES];
    double reference[3 * NODES], displacement[3 * NODES], quaternion[4 * NODES], velocity[ROWS];
    double now_quaternion[4 * NODES], now_velocity[ROWS], site_history[SITES];
    double normal[3 * SITES], depth[SITES], penetration[SITES], impact_speed[SITES], slip[2 * SITES],
        bristle[2 * SITES], touch[DMB_TOUCH_SIZE * SITES];
    uint32_t segment[SITES];
    int32_t sticks[SITES];
    uint8_t mode[SITES], coarse[SITES];
    dmb_element_type types[TYPES]; /* of elements with contact points inside, and: */
    uint32_t element_type[ELEMENTS], node_element[NODES], link[ELEMENTS];
    double fraction[2 * SITES], span[3 * ELEMENTS], now_displacement[3 * NODES], increment[ROWS];
} wall_input;

typedef struct wall_output {
    double normal[3 * SITES], depth[SITES], penetration[SITES], impact_speed[SITES], slip[2 * SITES],
        bristle[2 * SITES], touch[DMB_TOUCH_SIZE * SITES];
    double residual[ROWS], scale[ROWS], stiffness[BLOCKS], inertia[BLOCKS], upper[LINKS], lower[LINKS];
    double sums[4];
    uint32_t segment[SITES];
    int32_t sticks[SITES], reserved;
    uint8_t presses[SITES + 3];
} wall_output;

/* One way of asking. */
typedef struct wall_case {
    int32_t normal_law, friction_law, curved, dynamic, tangent;
    int32_t sections; /* 1: a hole of sections, and rings that keep their touch */
    double exponent;
    int32_t bounces; /* 0: rings have no mean forces; 1: they have; 2: in the first evaluation of a step */
    int32_t inside;  /* 1: contact points are inside elements */
} wall_case;

/* ---- Random configurations --------------------------------------------------------------------------------------- */

static void draw_all(uint64_t *seed, double low, double high, size_t n, double *x)
{
    for (size_t i = 0; i < n; i++) x[i] = draw_between(seed, low, high);
}

static void draw_quaternion(uint64_t *seed, double q[4])
{
    double square = 0.0;
    draw_all(seed, -1.0, 1.0, 4, q);
    for (int i = 0; i < 4; i++) square += q[i] * q[i];
    for (int i = 0; i < 4; i++) q[i] /= sqrt(square);
}

/* Near the identity, as pipes in a hole along x are. */
static void draw_pose(uint64_t *seed, double tilt, double q[4])
{
    const double a = draw_between(seed, -3.0, 3.0), b = draw_between(seed, -tilt, tilt);
    const double turned[9] = {cos(b),          -sin(b),         0.0,   cos(a) * sin(b), cos(a) * cos(b), -sin(a),
                              sin(a) * sin(b), sin(a) * cos(b), cos(a)};
    dmb_quat_from_matrix(turned, q);
}

static void draw_nodes(uint64_t *seed, double tilt, wall_input *in)
{
    for (uint32_t i = 0; i < NODES; i++) {
        in->row[i] = 6 * i;
        in->diagonal[i] = 36 * i;
        in->reference[3 * i] = 5.0 * i;
        draw_pose(seed, tilt, in->quaternion + 4 * i);
        draw_quaternion(seed, in->now_quaternion + 4 * i);
    }
    draw_all(seed, -0.02, 0.02, 3 * NODES, in->displacement);
    draw_all(seed, -1.0, 1.0, ROWS, in->velocity);
    draw_all(seed, -1.0, 1.0, ROWS, in->now_velocity);
}

/* Some rings are pinned, some on the axis, some stand off their nodes; nodes 7 and 8 have none that touches. */
static void draw_sites(uint64_t *seed, int arms, wall_input *in)
{
    for (uint32_t s = 0; s < SITES; s++) {
        dmb_site *site = in->sites + s;
        site->node = (5 * s) % NODES;
        site->offset = arms && s % 3 ? draw_between(seed, -0.5, 0.5) : 0.0;
        site->radius = draw_between(seed, 0.03, 0.04);
        site->clearance = s % 5 == 4 ? 0.0 : draw_between(seed, 0.0, 0.03);
        site->length = draw_between(seed, 0.5, 2.0);
        if (site->node >= 7) site->clearance = 3.0;
        in->site_history[s] = s % 4 == 1 ? draw_between(seed, 0.0, 1.0) : 0.0;
        in->sticks[s] = s % 2;
        in->segment[s] = s % STATIONS;
    }
    for (int i = 0; i < 3; i++) in->displacement[3 * 4 + i] = 0.0; /* node 4 on the axis of the straight hole */
    draw_all(seed, -1.0, 1.0, 3 * SITES, in->normal);
    draw_all(seed, -0.01, 0.01, SITES, in->penetration);
    draw_all(seed, 0.0, 1.0, SITES, in->impact_speed);
    draw_all(seed, -0.5, 0.5, 2 * SITES, in->slip);
    draw_all(seed, -1e-4, 1e-4, 2 * SITES, in->bristle);
}

static void setup_laws(const wall_case *c, wall_input *in)
{
    const dmb_friction_law friction = {.kind = c->friction_law,
                                       .mu_static = 0.4,
                                       .mu_dynamic = 0.25,
                                       .stribeck_speed = 0.1,
                                       .smoothing_speed = 0.01,
                                       .full_speed = 0.6,
                                       .bristle_stiffness = 1e4,
                                       .bristle_damping = 0.5};
    in->normal_law = dmb_normal_law_of((dmb_normal_law){.kind = c->normal_law,
                                                        .stiffness = 1e7,
                                                        .exponent = c->exponent,
                                                        .damping = 2e4,
                                                        .impact_depth = 4e-3,
                                                        .impact_floor = 1e-3},
                                       0.6);
    in->friction_law = friction;
}

static void setup_hole(const wall_case *c, wall_input *in)
{
    const double origin[3] = {-1.0, 0.0, 0.0}, along_x[3] = {1.0, 0.0, 0.0}, level = 0.5 * PI;
    const double survey[3 * STATIONS] = {0.0,  level,        0.0,  10.0, level - 2e-3, 1e-3,
                                         25.0, level - 4e-3, 1e-3, 40.0, level,        2e-3};
    memset(&in->hole, 0, sizeof in->hole);
    if (c->curved)
        assert_int_equal(dmb_hole_setup_survey(&in->hole, STATIONS, survey, origin, 0.047, in->station), -1);
    else
        assert_int_equal(dmb_hole_setup_straight(&in->hole, origin, along_x, 0.047), 0);
}

/* Constants that change along the hole, in the second piece friction alone, in the third one as in the hole. */
static void draw_pieces(uint64_t *seed, wall_input *in)
{
    const double usual[DMB_WALL_COUNT] = {0.047, 1e7, 0.6, 2e4, 0.4, 0.25, 0.0};
    for (int i = 0; i < PIECES; i++) {
        dmb_hole_piece *piece = in->piece + i;
        memcpy(piece->value, usual, sizeof usual);
        piece->depth = 11.0 * i;
        piece->factor = in->normal_law.mu;
        for (int k = 0; k < DMB_WALL_COUNT && i != 2; k++) {
            if (i == 1 && k != DMB_WALL_MU_STATIC && k != DMB_WALL_MU_DYNAMIC) continue;
            piece->value[k] *= draw_between(seed, 0.95, 1.05);
            piece->slope[k] = usual[k] * draw_between(seed, -0.01, 0.01);
            piece->bend[k] = usual[k] * draw_between(seed, -5e-4, 5e-4);
        }
    }
    in->piece[3].value[DMB_WALL_STIFFNESS] = 3e8; /* 30 times stiffer */
    in->piece[3].value[DMB_WALL_MU_STATIC] = in->piece[3].value[DMB_WALL_MU_DYNAMIC];
    for (uint32_t k = 0; k < SITES; k++) {
        in->sites[k].clearance = 1.0; /* not read: a section's radius is */
        if (in->sites[k].node >= 7) in->sites[k].radius = -3.0;
    }
    in->hole.piece = in->piece;
    in->hole.pieces = PIECES;
    in->hole.friction = 1.1;
    draw_all(seed, -0.5, 0.5, DMB_TOUCH_SIZE * SITES, in->touch);
}

/* Rings of all modes, some with a mean force in the history of the step; nodes 7 and 8 have none that touches. */
static void draw_bounces(wall_input *in)
{
    for (uint32_t s = 0; s < SITES; s++) {
        in->mode[s] = (uint8_t)(in->sites[s].node < 7 && s % 7 < 3 ? s % 7 : 0);
        in->coarse[s] = (uint8_t)(s / 2 % 3);
        if (s % 8 == 2) in->site_history[s] = -500.0;
    }
}

/* Elements of three types between the nodes, with up to four contact points inside; those of the seventh are open. */
static void draw_elements(uint64_t *seed, wall_input *in)
{
    for (uint32_t i = 0; i < TYPES; i++) {
        const dmb_element_type type = {.length = 4.7 + 0.1 * i,
                                       .strain_stiffness = {3e8, 1e8, 0.9e8, 1e5, 1.3e5, 1.2e5},
                                       .arm = {i > 0 ? 0.1 : 0.0, i > 1 ? 0.2 : 0.0}};
        in->types[i] = type;
    }
    for (uint32_t e = 0; e < ELEMENTS; e++) {
        in->element_type[e] = e / 3;
        in->node_element[e] = e;
        in->link[e] = 36 * e;
        in->span[3 * e] = 5.0;
    }
    for (uint32_t s = 0; s < SITES; s++) {
        dmb_site *site = in->sites + s;
        site->node = s % 7;
        if (site->node == 6) site->clearance = 3.0;
        in->fraction[2 * s] = draw_between(seed, 0.05, 0.95);
    }
    draw_all(seed, -1e-3, 1e-3, ROWS, in->increment);
    for (uint32_t i = 0; i < NODES; i++) draw_pose(seed, 0.004, in->now_quaternion + 4 * i);
}

static void draw_input(uint64_t *seed, const wall_case *c, wall_input *in)
{
    memset(in, 0, sizeof *in);
    setup_laws(c, in);
    setup_hole(c, in);
    draw_nodes(seed, c->inside ? 0.004 : 0.1, in);
    draw_sites(seed, *seed % 2 == 0, in);
    if (c->inside) draw_elements(seed, in);
    if (c->sections) draw_pieces(seed, in);
    if (c->bounces) draw_bounces(in);
    for (uint32_t s = 6; s < SITES && c->inside; s += 7) in->mode[s] = 0;
    for (uint32_t s = 6; s < SITES && c->inside && c->sections; s += 7) in->sites[s].radius = -3.0;
}

/* ---- Runs -------------------------------------------------------------------------------------------------------- */

/* Sites first .. first + count - 1, from and to the places where they stand. */
static dmb_wall_args run_of(const wall_case *c, wall_input *in, wall_output *out, uint32_t first, uint32_t count)
{
    const dmb_wall_args args = {
        .count = count,
        .sites = in->sites + first,
        .bristles = c->friction_law == DMB_FRICTION_BRISTLE,
        .states = 2,
        .touches = c->sections,
        .hole = &in->hole,
        .normal_law = &in->normal_law,
        .friction_law = c->friction_law == DMB_FRICTION_NONE ? NULL : &in->friction_law,
        .row = in->row,
        .diagonal = in->diagonal,
        .reference = in->reference,
        .displacement = in->displacement,
        .quaternion = in->quaternion,
        .velocity = in->velocity,
        .now_quaternion = in->now_quaternion,
        .now_velocity = in->now_velocity,
        .now = {in->normal + 3 * first, in->depth + first, in->penetration + first, in->impact_speed + first,
                in->slip + 2 * first, in->bristle + 2 * first, in->touch + DMB_TOUCH_SIZE * first, in->segment + first,
                in->sticks + first},
        .site_history = in->site_history + first,
        .bounces = c->bounces != 0,
        .mode = in->mode + first,
        .coarse = in->coarse + first,
        .presses = out->presses + first,
        .own_factor = c->dynamic ? 1.96 : 0.0,
        .yield = c->bounces == 2 ? 5e-7 / 20.0 : 0.0,
        .slows = c->bounces == 2 ? 1e-3 / 20.0 : 0.0,
        .trial = {out->normal + 3 * first, out->depth + first, out->penetration + first, out->impact_speed + first,
                  out->slip + 2 * first, out->bristle + 2 * first, out->touch + DMB_TOUCH_SIZE * first,
                  out->segment + first, out->sticks + first},
        .slip = {0.1, 2.0},
        .softer = 1.5,
        .step = 1e-3,
        .velocity_factor = 1700.0,
        .dynamic = c->dynamic,
        .tangent = c->tangent,
        .residual = out->residual,
        .scale = out->scale,
        .stiffness = out->stiffness,
        .inertia = out->inertia,
        .rounding = out->sums[0],
        .potential = out->sums[1],
        .impact = out->sums[2],
        .friction = out->sums[3],
    };
    return args;
}

/* -0 at the nodes whose rings do not touch: adding 0 would show. */
static void clear(wall_output *out)
{
    memset(out, 0, sizeof *out);
    for (int i = 42; i < ROWS; i++) out->residual[i] = out->scale[i] = -0.0;
    for (int i = 252; i < BLOCKS; i++) out->stiffness[i] = out->inertia[i] = -0.0;
}

static void run_part(const dmb_kernels *kernels, const wall_case *c, wall_input *in, wall_output *out, uint32_t first,
                     uint32_t count)
{
    dmb_wall_args args = run_of(c, in, out, first, count);
    const dmb_inside_args inside = {.fraction = in->fraction + 2 * first,
                                    .stride = 2,
                                    .types = in->types,
                                    .element_type = in->element_type,
                                    .node_element = in->node_element,
                                    .span = in->span,
                                    .now_displacement = in->now_displacement,
                                    .increment = in->increment,
                                    .link = in->link,
                                    .upper = out->upper,
                                    .lower = out->lower};
    if (c->inside)
        kernels->walls_inside(&args, &inside);
    else
        kernels->walls(&args);
    out->sums[0] = args.rounding;
    out->sums[1] = args.potential;
    out->sums[2] = args.impact;
    out->sums[3] = args.friction;
}

static void no_trace_of_open_rings(const wall_case *c, const wall_output *out)
{
    wall_output start;
    clear(&start);
    assert_memory_equal(out->residual + 42, start.residual + 42, 12 * sizeof(double));
    assert_memory_equal(out->scale + 42, start.scale + 42, 12 * sizeof(double));
    assert_memory_equal(out->stiffness + 252, start.stiffness + 252, 72 * sizeof(double));
    assert_memory_equal(out->inertia + 252, start.inertia + 252, 72 * sizeof(double));
    if (!c->tangent) assert_memory_equal(out->stiffness, start.stiffness, sizeof out->stiffness);
    if (!c->tangent || !c->dynamic) assert_memory_equal(out->inertia, start.inertia, sizeof out->inertia);
}

static uint32_t touching(const wall_input *in, const wall_output *out)
{
    uint32_t count = 0;
    for (int s = 0; s < SITES; s++) count += out->penetration[s] > 0.0 || in->sites[s].clearance == 0.0;
    return count;
}

/* Returns how many rings touch. */
static uint32_t compare_widths(const wall_case *c, wall_input *in)
{
    wall_output alone, out;
    clear(&alone);
    for (uint32_t s = 0; s < SITES; s++) run_part(dmb_kernels_of(1), c, in, &alone, s, 1);
    no_trace_of_open_rings(c, &alone);
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
        if (!dmb_kernels_of(lanes)) continue;
        clear(&out);
        run_part(dmb_kernels_of(lanes), c, in, &out, 0, SITES);
        assert_memory_equal(&out, &alone, sizeof out);
        clear(&out);
        run_part(dmb_kernels_of(lanes), c, in, &out, 0, 6);
        run_part(dmb_kernels_of(lanes), c, in, &out, 6, SITES - 6);
        assert_memory_equal(&out, &alone, sizeof out);
    }
    return touching(in, &alone);
}

static void all_widths_give_the_same_bits(void **state)
{
    static const double exponents[3] = {1.0, 1.5, 1.3};
    uint64_t seed = 20;
    uint32_t cases = 0, closed = 0, widths = 0;
    wall_input in;
    (void)state;
    for (int32_t i = 0; i < 6 * 5 * 16 * SEEDS; i++) {
        const int32_t k = i / 30;
        const wall_case c = {i % 6,     i / 6 % 5 - 1,          k % 2, k / 2 % 2, k / 4 % 2,
                             k / 8 % 2, exponents[(i + k) % 3], 0,     0};
        draw_input(&seed, &c, &in);
        closed += compare_widths(&c, &in);
        cases++;
    }
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) widths += dmb_kernels_of(lanes) != NULL;
    tell("widths [-]", widths);
    tell("configurations [-]", cases);
    tell("rings that touch, of all [-]", closed / ((double)cases * SITES));
    assert_true(closed > cases * SITES / 5 && closed < cases * SITES * 4 / 5);
}

/* The same of mean forces in the first evaluation of a step and later ones, which are other forces than those of the
 * law. */
static void mean_forces_have_the_same_bits(void **state)
{
    static const double exponents[3] = {1.0, 1.5, 1.3};
    uint64_t seed = 60;
    wall_input in;
    wall_output mean, law;
    (void)state;
    for (int32_t i = 0; i < 6 * 5 * 16 * SEEDS; i++) {
        const int32_t k = i / 30;
        wall_case c = {i % 6, i / 6 % 5 - 1, k % 2, 1, k / 4 % 2, k / 8 % 2, exponents[(i + k) % 3], 1 + k / 2 % 2, 0};
        draw_input(&seed, &c, &in);
        (void)compare_widths(&c, &in);
        clear(&mean);
        clear(&law);
        run_part(dmb_kernels_widest(), &c, &in, &mean, 0, SITES);
        c.bounces = 0;
        run_part(dmb_kernels_widest(), &c, &in, &law, 0, SITES);
        assert_true(memcmp(mean.residual, law.residual, sizeof law.residual) != 0);
        assert_memory_equal(mean.penetration, law.penetration, sizeof law.penetration);
    }
}

/* The same inside elements: uniform and curved holes, sections, friction laws, mean forces, several types of elements.
 */
static void points_inside_elements_have_the_same_bits(void **state)
{
    static const double exponents[3] = {1.0, 1.5, 1.3};
    uint64_t seed = 80;
    uint32_t closed = 0, cases = 0;
    double coupled = 0.0;
    wall_input in;
    wall_output out;
    (void)state;
    for (int32_t i = 0; i < 6 * 5 * 16 * SEEDS; i++) {
        const int32_t k = i / 30;
        wall_case c = {i % 6, i / 6 % 5 - 1, k % 2, k / 2 % 2, k / 4 % 2, k / 8 % 2, exponents[(i + k) % 3], 0, 1};
        if (c.dynamic && i % 2) c.bounces = 1 + i / 2 % 2;
        draw_input(&seed, &c, &in);
        closed += compare_widths(&c, &in);
        cases++;
        clear(&out);
        run_part(dmb_kernels_widest(), &c, &in, &out, 0, SITES);
        if (c.tangent) coupled = fmax(coupled, largest(LINKS, out.upper));
        if (!c.tangent) assert_true(largest(LINKS, out.upper) == 0.0 && largest(LINKS, out.lower) == 0.0);
    }
    tell("contact points that touch, of all [-]", closed / ((double)cases * SITES));
    assert_true(closed > cases * SITES / 5 && closed < cases * SITES * 4 / 5 && coupled > 1.0);
}

/* The residual is the same whether blocks are wanted or not. */
static void forces_do_not_depend_on_the_tangent(void **state)
{
    uint64_t seed = 40;
    wall_input in;
    wall_output with, without;
    (void)state;
    for (int32_t i = 0; i < 60; i++) {
        wall_case c = {i % 6, i % 5 - 1, 0, i / 30, 1, i % 2, 1.0, i / 30 * (i % 3), 0};
        draw_input(&seed, &c, &in);
        clear(&with);
        clear(&without);
        run_part(dmb_kernels_widest(), &c, &in, &with, 0, SITES);
        c.tangent = 0;
        run_part(dmb_kernels_widest(), &c, &in, &without, 0, SITES);
        assert_memory_equal(with.residual, without.residual, sizeof with.residual);
        assert_memory_equal(with.sums, without.sums, sizeof with.sums);
        assert_memory_equal(with.bristle, without.bristle, sizeof with.bristle);
        assert_true(largest(ROWS, with.residual) > 1.0 && largest(BLOCKS, with.stiffness) > 1.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_widths_give_the_same_bits),
        cmocka_unit_test(mean_forces_have_the_same_bits),
        cmocka_unit_test(points_inside_elements_have_the_same_bits),
        cmocka_unit_test(forces_do_not_depend_on_the_tangent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
