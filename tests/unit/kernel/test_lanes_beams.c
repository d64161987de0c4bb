/* Kernel of beams: runs of any length give the bits of elements one at a time, write nothing behind their end, and name
 * the first element that turned too far, wherever in a group it stands. */
#include <string.h>

#include "check.h"
#include "kernel/kernels.h"
#include "math/se3.h"
#include "model/section.h"

enum { ELEMENTS = 19, NODES = ELEMENTS + 1, ROWS = 6 * NODES, BLOCKS = 36 * NODES, TYPES = 3 };

/* Elements turn too far from 2.5 rad on. */
static const double much = 2.49, too_far = 2.51;

typedef struct beam_input {
    dmb_element_type types[TYPES], curved[TYPES];
    uint32_t type[ELEMENTS];
    double span[3 * ELEMENTS], displacement[3 * NODES], quaternion[4 * NODES];
    double velocity[ROWS], acceleration[ROWS], increment[ROWS], stress[6 * ELEMENTS];
} beam_input;

typedef struct beam_output {
    double residual[ROWS], scale[ROWS], strain[6 * ELEMENTS], stress[6 * ELEMENTS];
    double stiffness[BLOCKS], inertia[BLOCKS], upper[36 * ELEMENTS], lower[36 * ELEMENTS];
    double sums[4];
} beam_output;

/* One way of asking. */
typedef struct beam_case {
    int32_t dynamic, tangent, extrapolated, inertia_only, damped, curved;
} beam_case;

static const beam_case cases[] = {{0, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0}, {1, 0, 0, 0, 1, 0}, {1, 1, 0, 0, 1, 0},
                                  {1, 1, 1, 0, 0, 0}, {1, 1, 0, 1, 0, 0}, {0, 1, 0, 0, 0, 1}, {1, 0, 0, 0, 1, 1},
                                  {1, 1, 0, 0, 0, 1}, {1, 1, 1, 1, 0, 1}};
static const double gravity[3] = {2.0, 3.0, -9.0};
enum { CASES = sizeof cases / sizeof cases[0] };

/* ---- Chains of elements ------------------------------------------------------------------------------------------ */

static void draw_all(uint64_t *seed, double size, size_t n, double *x)
{
    for (size_t i = 0; i < n; i++) x[i] = draw_between(seed, -size, size);
}

static void set_types(beam_input *in)
{
    static const double arms[TYPES][2] = {{0.0, 0.0}, {0.2, 0.1}, {0.0, 0.3}};
    dmb_pipe_def def = dmb_pipe_def_default();
    for (int t = 0; t < TYPES; t++) {
        def.length = 1.1 + 0.2 * t;
        for (int i = 0; i < 6; i++) def.section_stiffness[i] = 2.0 + i + t;
        def.section_mass = 1.1 + t;
        def.section_inertia[0] = 0.3;
        def.section_inertia[1] = 0.2;
        dmb_element_type_of(&def, arms[t], 0.01 * t, in->types + t);
        in->types[t].weight_mass = def.length;
        def.curvature[1] = 0.2;
        def.curvature[2] = -0.1;
        dmb_element_type_of(&def, arms[t], 0.01 * t, in->curved + t);
        in->curved[t].weight_mass = def.length;
        dmb_element_make_curved(&def, in->curved + t);
        def.curvature[1] = def.curvature[2] = 0.0;
    }
}

/* Node i + 1 from node i: turned by angle[i] about an axis of its own, otherwise anywhere near. */
static void draw_input(uint64_t *seed, const double *angle, beam_input *in)
{
    memset(in, 0, sizeof *in);
    set_types(in);
    in->quaternion[0] = 1.0;
    for (uint32_t i = 0; i < ELEMENTS; i++) {
        double O[3], turn[4];
        draw_all(seed, 1.0, 3, O);
        dmb_vec3_scale(angle[i] / dmb_vec3_norm(O), O, O);
        dmb_quat_exp(O, turn);
        dmb_quat_mul(in->quaternion + 4 * i, turn, in->quaternion + 4 * i + 4);
        in->type[i] = i % 5 < 3 ? i % TYPES : 1;
        in->span[3 * i] = 1.2;
    }
    draw_all(seed, 0.05, 3 * NODES, in->displacement);
    draw_all(seed, 1.0, ROWS, in->velocity);
    draw_all(seed, 1.0, ROWS, in->acceleration);
    draw_all(seed, 1e-2, ROWS, in->increment);
    draw_all(seed, 1.0, 6 * ELEMENTS, in->stress);
}

static void draw_gentle(uint64_t *seed, beam_input *in)
{
    double angle[ELEMENTS];
    for (int i = 0; i < ELEMENTS; i++) angle[i] = draw_between(seed, 0.01, 2.0);
    draw_input(seed, angle, in);
}

/* ---- Runs -------------------------------------------------------------------------------------------------------- */

/* Sums begin at 0, outputs that are written at a number that no element gives. */
static void clear(const beam_input *in, const beam_case *c, beam_output *out)
{
    memset(out, 0, sizeof *out);
    for (int i = 0; i < 36 * ELEMENTS; i++) out->upper[i] = out->lower[i] = -77.0;
    for (int i = 0; i < 6 * ELEMENTS; i++) out->strain[i] = out->stress[i] = -77.0;
    if (c->extrapolated) memcpy(out->stress, in->stress, sizeof out->stress);
}

/* Elements first .. first + count - 1; what the kernel returns, the element that failed in *failed. */
static int32_t run_part(uint32_t lanes, const beam_case *c, const beam_input *in, beam_output *out, uint32_t first,
                        uint32_t count, uint32_t *failed)
{
    dmb_beam_args args = {
        .count = count,
        .failed = DMB_NONE,
        .types = c->curved ? in->curved : in->types,
        .type = in->type + first,
        .span = in->span + 3 * first,
        .displacement = in->displacement + 3 * first,
        .quaternion = in->quaternion + 4 * first,
        .velocity = in->velocity + 6 * first,
        .acceleration = in->acceleration + 6 * first,
        .increment = in->increment + 6 * first,
        .mass_factor = 1e3,
        .velocity_factor = 40.0,
        .dynamic = c->dynamic,
        .tangent = c->tangent,
        .extrapolated = c->extrapolated,
        .inertia_only = c->inertia_only,
        .ledger = 1,
        .damped = c->damped,
        .arms = 1,
        .curved = c->curved,
        .gravity = gravity,
        .residual = out->residual + 6 * first,
        .scale = out->scale + 6 * first,
        .strain = out->strain + 6 * first,
        .stress = out->stress + 6 * first,
        .stiffness_diagonal = out->stiffness + 36 * first,
        .inertia_diagonal = out->inertia + 36 * first,
        .upper = out->upper + 36 * first,
        .lower = out->lower + 36 * first,
        .rounding = out->sums[0],
        .potential = out->sums[1],
        .damping = out->sums[2],
        .inertia = out->sums[3],
    };
    const int32_t status = dmb_kernels_of(lanes)->beams(&args);
    const double sums[4] = {args.rounding, args.potential, args.damping, args.inertia};
    memcpy(out->sums, sums, sizeof sums);
    *failed = args.failed;
    return status;
}

/* ---- Lengths that leave a remainder ------------------------------------------------------------------------------ */

static void run_alone(const beam_case *c, const beam_input *in, uint32_t count, beam_output *out)
{
    uint32_t failed;
    clear(in, c, out);
    for (uint32_t i = 0; i < count; i++) assert_int_equal(run_part(1, c, in, out, i, 1, &failed), 0);
}

static uint32_t compare_lengths(uint32_t lanes, const beam_case *c, const beam_input *in)
{
    static beam_output alone, out;
    uint32_t failed;
    for (uint32_t count = 1; count <= ELEMENTS; count++) {
        run_alone(c, in, count, &alone);
        clear(in, c, &out);
        assert_int_equal(run_part(lanes, c, in, &out, 0, count, &failed), 0);
        assert_int_equal(failed, DMB_NONE);
        assert_memory_equal(&out, &alone, sizeof out);
    }
    return ELEMENTS;
}

static void every_length_gives_the_bits_of_single_elements(void **state)
{
    static beam_input in;
    uint64_t seed = 5;
    uint32_t runs = 0;
    (void)state;
    for (int k = 0; k < 3 * CASES; k++) {
        draw_gentle(&seed, &in);
        for (uint32_t lanes = 1; lanes <= 8; lanes *= 2)
            if (dmb_kernels_of(lanes)) runs += compare_lengths(lanes, &cases[k % CASES], &in);
    }
    tell("runs of 1 to 19 elements compared with single elements", runs);
}

/* ---- Elements that turned too far -------------------------------------------------------------------------------- */

/* All others turned as far as they may. `second` fails too if it is behind `first`. */
static void draw_failing(uint64_t *seed, uint32_t first, uint32_t second, beam_input *in)
{
    double angle[ELEMENTS];
    for (uint32_t i = 0; i < ELEMENTS; i++) angle[i] = i == first || (i > first && i == second) ? too_far : much;
    draw_input(seed, angle, in);
}

static uint32_t expect_failure(uint32_t lanes, const beam_case *c, const beam_input *in, uint32_t first)
{
    static beam_output out;
    uint32_t failed, runs = 0;
    for (uint32_t count = 1; count <= ELEMENTS; count++, runs++) {
        const int within = first < count;
        clear(in, c, &out);
        assert_int_equal(run_part(lanes, c, in, &out, 0, count, &failed), within ? -1 : 0);
        assert_int_equal(failed, within ? first : DMB_NONE);
    }
    return runs;
}

static void the_first_that_turned_too_far_is_named(void **state)
{
    static beam_input in;
    uint64_t seed = 7;
    uint32_t runs = 0;
    (void)state;
    for (uint32_t first = 0; first < ELEMENTS; first++)
        for (uint32_t second = 0; second < ELEMENTS; second += 3) {
            draw_failing(&seed, first, second, &in);
            for (uint32_t lanes = 1; lanes <= 8; lanes *= 2)
                if (dmb_kernels_of(lanes)) runs += expect_failure(lanes, &cases[(first + second) % CASES], &in, first);
        }
    tell("runs with elements that turned too far", runs);
}

/* A node that is no number spoils the element before it and the one behind it: the one before is named. */
static void the_first_that_is_no_number_is_named(void **state)
{
    static beam_input in;
    uint64_t seed = 11;
    uint32_t runs = 0;
    (void)state;
    for (uint32_t node = 0; node < NODES; node++) {
        draw_gentle(&seed, &in);
        in.quaternion[4 * node + 2] = (double)NAN;
        for (uint32_t lanes = 1; lanes <= 8; lanes *= 2)
            if (dmb_kernels_of(lanes))
                runs += expect_failure(lanes, &cases[node % CASES], &in, node > 0 ? node - 1 : 0);
    }
    tell("runs with nodes that are no numbers", runs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_length_gives_the_bits_of_single_elements),
                                       cmocka_unit_test(the_first_that_turned_too_far_is_named),
                                       cmocka_unit_test(the_first_that_is_no_number_is_named)};
    for (uint32_t lanes = 1; lanes <= 8; lanes *= 2)
        print_message("    kernels of %u lanes: %s\n", (unsigned)lanes,
                      dmb_kernels_of(lanes) ? "tested" : "not in this build or processor");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
