/* Large clusters, solved over nodes and multipliers in sparse blocks, against the same scenes with dense partitions:
 * motion, reactions, redundant equations, statics, modes; and what each of them must keep by itself. Checks
 * eq:joints.quasi-definite, eq:joints.saddle and eq:joints.proximal. */
#include <string.h>

#include "mechanism.h"

#include "model/field_check.h"
#include "sim/own_scene.h"
#include "sim/sim.h"
#include "system/system.h"

enum { MOST = 64, DENSE = 1 << 20, SPARSE = 2 };
#ifdef DMB_SOME_CASES
enum { STEPS = 15 };
#else
enum { STEPS = 60 };
#endif

typedef struct machine {
    rig s;
    dmb_id bars[MOST], joints[2 * MOST];
    uint32_t bar_count, joint_count;
} machine;

static uint32_t add_machine_bar(machine *m, double x0, double z0, double x1, double z1)
{
    const bar def = {{x0, z0}, {x1, z1}, 1.0 + 0.1 * m->bar_count};
    m->bars[m->bar_count] = add_bar(&m->s, &def);
    return m->bar_count++;
}

static void connect(machine *m, int32_t kind, pin a, pin b)
{
    dmb_joint_def def = hinge_of("", kind, a, b);
    def.damping[DMB_RX] = 0.05;
    m->joints[m->joint_count++] = add_joint(&m->s, &def);
}

static pin on(const machine *m, uint32_t i, double x)
{
    return pin_on(m->bars[i], x);
}

/* ---- Scenes ------------------------------------------------------------------------------------------------------ */

static void chain(machine *m, int32_t kind)
{
    for (uint32_t i = 0; i < 16; i++) {
        const uint32_t b = add_machine_bar(m, i, 0.1 * (i & 1), i + 1.0, 0.1 * (1 - (i & 1)));
        connect(m, kind, i ? on(m, b - 1, 0.5 * hypot(1.0, 0.1)) : pin_ground(0.0, 0.0),
                on(m, b, -0.5 * hypot(1.0, 0.1)));
    }
}

static void chain_of_hinges(machine *m)
{
    chain(m, DMB_JOINT_REVOLUTE);
}

static void chain_of_balls(machine *m)
{
    chain(m, DMB_JOINT_SPHERICAL);
}

static void tree(machine *m)
{
    double x[MOST], z[MOST];
    for (uint32_t i = 0; i < 21; i++) {
        const uint32_t from = (i - 1) / 2;
        const double angle = -0.4 + (i & 1 ? 0.5 : -0.3), x0 = i ? x[from] : 0.0, z0 = i ? z[from] : 0.0;
        x[i] = x0 + cos(angle);
        z[i] = z0 + sin(angle);
        (void)add_machine_bar(m, x0, z0, x[i], z[i]);
        connect(m, DMB_JOINT_REVOLUTE, i ? on(m, from, 0.5) : pin_ground(0.0, 0.0), on(m, i, -0.5));
    }
}

/* All bars at one that hangs from the ground. */
static void star(machine *m)
{
    (void)add_machine_bar(m, -0.5, 0.0, 0.5, 0.0);
    connect(m, DMB_JOINT_REVOLUTE, pin_ground(-0.5, 0.0), on(m, 0, -0.5));
    for (uint32_t i = 1; i < 14; i++) {
        (void)add_machine_bar(m, 0.5, 0.0, 0.5 + cos(0.3 * i), sin(0.3 * i));
        connect(m, DMB_JOINT_REVOLUTE, on(m, 0, 0.5), on(m, i, -0.5));
    }
}

static void ring(machine *m, int32_t closing)
{
    enum { N = 15 };
    const double r = 0.5 / sin(PI / N);
    for (uint32_t i = 0; i < N; i++) {
        const double a = 2.0 * PI * i / N + 0.5 * PI, b = 2.0 * PI * (i + 1) / N + 0.5 * PI;
        (void)add_machine_bar(m, r * cos(a), r * sin(a), r * cos(b), r * sin(b));
        connect(m, DMB_JOINT_REVOLUTE, i ? on(m, i - 1, 0.5) : pin_ground(0.0, r), on(m, i, -0.5));
    }
    connect(m, closing, on(m, N - 1, 0.5), on(m, 0, -0.5));
}

static void ring_of_hinges(machine *m)
{
    ring(m, DMB_JOINT_REVOLUTE);
}

static void ring_without_redundance(machine *m)
{
    ring(m, DMB_JOINT_POINT_ON_LINE);
}

/* Cranks on the ground, couplers between neighbours, thrown over. */
static void four_bars(machine *m)
{
    uint32_t crank = add_machine_bar(m, 0.0, 0.0, 0.0, 1.0);
    dmb_joint_def foot = hinge_of("foot", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), on(m, crank, -0.5));
    foot.initial_mask = DMB_FREE_RX;
    foot.initial_position[DMB_RX] = 0.5 * PI;
    foot.initial_speed[DMB_RX] = -3.0;
    m->joints[m->joint_count++] = add_joint(&m->s, &foot);
    for (uint32_t i = 0; i < 8; i++) {
        const uint32_t coupler = add_machine_bar(m, i, 1.0, i + 1.0, 1.0);
        const uint32_t next = add_machine_bar(m, i + 1.0, 0.0, i + 1.0, 1.0);
        connect(m, DMB_JOINT_REVOLUTE, on(m, crank, 0.5), on(m, coupler, -0.5));
        connect(m, DMB_JOINT_REVOLUTE, on(m, coupler, 0.5), on(m, next, 0.5));
        connect(m, DMB_JOINT_REVOLUTE, pin_ground(i + 1.0, 0.0), on(m, next, -0.5));
        crank = next;
    }
}

/* Two rails and rungs between them, from one corner. */
static void ladder(machine *m)
{
    uint32_t low = add_machine_bar(m, 0.0, 0.0, 1.0, 0.0), high = add_machine_bar(m, 0.0, 1.0, 1.0, 1.0);
    const uint32_t first = add_machine_bar(m, 0.0, 0.0, 0.0, 1.0);
    connect(m, DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), on(m, low, -0.5));
    connect(m, DMB_JOINT_REVOLUTE, on(m, low, -0.5), on(m, first, -0.5));
    connect(m, DMB_JOINT_REVOLUTE, on(m, first, 0.5), on(m, high, -0.5));
    for (uint32_t i = 1; i < 5; i++) {
        const uint32_t rung = add_machine_bar(m, i, 0.0, i, 1.0);
        connect(m, DMB_JOINT_REVOLUTE, on(m, low, 0.5), on(m, rung, -0.5));
        connect(m, DMB_JOINT_REVOLUTE, on(m, high, 0.5), on(m, rung, 0.5));
        const uint32_t a = add_machine_bar(m, i, 0.0, i + 1.0, 0.0), b = add_machine_bar(m, i, 1.0, i + 1.0, 1.0);
        connect(m, DMB_JOINT_REVOLUTE, on(m, low, 0.5), on(m, a, -0.5));
        connect(m, DMB_JOINT_REVOLUTE, on(m, high, 0.5), on(m, b, -0.5));
        low = a;
        high = b;
    }
}

/* A chain with a gear between two hinges, a driven hinge, a slider, and an end that only turns and slides in the
 * plane. */
static void mixture(machine *m)
{
    dmb_coupling_def gear = dmb_coupling_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment rise = dmb_segment_default();
    chain(m, DMB_JOINT_REVOLUTE);
    gear.joint[0] = m->joints[3];
    gear.joint[1] = m->joints[5];
    gear.ratio = -0.5;
    must_model(&m->s, dmb_model_add_coupling(m->s.model, &gear, NULL));
    rise.kind = DMB_SEGMENT_STEP;
    rise.h1 = 2.0;
    must_model(&m->s, dmb_model_add_time_function(m->s.model, &rise, 1, &drive.time_function));
    drive.part = m->joints[8];
    drive.component = DMB_RX;
    must_model(&m->s, dmb_model_add_drive(m->s.model, &drive, NULL));
    const bar slider = {{14.0, 2.0}, {15.0, 2.0}, 3.0};
    dmb_body_def body = bar_body(&slider);
    body.free_mask = DMB_FREE_X | DMB_FREE_Z | DMB_FREE_RY;
    m->bars[m->bar_count++] = add_body(&m->s, &body);
    connect(m, DMB_JOINT_DISTANCE, on(m, 14, 0.0), on(m, m->bar_count - 1, 0.0));
}

/* Bars on both ends of a pipe that bends. */
static void bars_and_pipe(machine *m)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_id id;
    string.position[0] = 16.0;
    string.start_free = DMB_FREE_ALL;
    pipe.length = 4.0;
    pipe.elements = 4;
    pipe.string = add_string(&m->s, &string);
    id = add_pipes(&m->s, &pipe, 1);
    chain(m, DMB_JOINT_REVOLUTE);
    dmb_joint_def def = hinge_of("", DMB_JOINT_REVOLUTE, on(m, 15, 0.5 * hypot(1.0, 0.1)), pin_ground(0.0, 0.0));
    def.place_b = dmb_station(pipe.string, 0, 0.0);
    def.origin_b[0] = 0.0;
    (void)id;
    m->joints[m->joint_count++] = add_joint(&m->s, &def);
}

/* ---- Both ways --------------------------------------------------------------------------------------------------- */

typedef void scene_fn(machine *m);

static machine open_machine(scene_fn *describe, uint32_t sparse_nodes, int32_t method)
{
    dmb_sim_options options = sharp_options(0.9, 1e-12);
    machine m;
    memset(&m, 0, sizeof m);
    rig_open(&m.s, 0.0, 0.0, -9.81);
    m.s.model->sparse_nodes = sparse_nodes;
    describe(&m);
    options.constraint_method = method;
    (void)mechanism_start(&m.s, &options);
    assert_int_equal(m.s.sim->scene->sparse_count > 0, sparse_nodes == SPARSE);
    return m;
}

/* Of reactions, over the largest of them. */
static double reaction_difference(const machine *a, const machine *b)
{
    double most = 0.0, largest = 0.0;
    for (uint32_t i = 0; i < a->joint_count; i++) {
        const dmb_joint_state one = joint_at(&a->s, a->joints[i]), other = joint_at(&b->s, b->joints[i]);
        for (int k = 0; k < 6; k++) {
            most = fmax(most, fabs(one.reaction[k] - other.reaction[k]));
            largest = fmax(largest, fabs(one.reaction[k]));
        }
    }
    return most / largest;
}

/* tolerance: within it the two methods of the dense way differ too, by more next to elements that are stiff. */
static void compare(const char *name, scene_fn *describe, double tolerance)
{
    machine dense = open_machine(describe, DENSE, DMB_METHOD_INDEPENDENT);
    machine other_way = open_machine(describe, DENSE, DMB_METHOD_MULTIPLIERS);
    machine sparse = open_machine(describe, SPARSE, DMB_METHOD_INDEPENDENT);
    machine given = open_machine(describe, SPARSE, DMB_METHOD_MULTIPLIERS);
    print_message("%s: %u bodies\n", name, dense.bar_count);
    for (int k = 0; k < STEPS; k++) {
        must(&dense.s, dmb_sim_step(dense.s.sim, 2e-3, NULL));
        must(&sparse.s, dmb_sim_step(sparse.s.sim, 2e-3, NULL));
        must(&other_way.s, dmb_sim_step(other_way.s.sim, 2e-3, NULL));
        must(&given.s, dmb_sim_step(given.s.sim, 2e-3, NULL));
    }
    const dmb_statistics one = statistics_of(&dense.s), other = statistics_of(&sparse.s);
    const double apart = motion_difference(&dense.s, &other_way.s, dense.bars, other_way.bars, dense.bar_count);
    check_below("    dense, by multipliers", apart, tolerance);
    check_below("    motion", motion_difference(&dense.s, &sparse.s, dense.bars, sparse.bars, dense.bar_count),
                tolerance);
    check_below("    by multipliers", motion_difference(&dense.s, &given.s, dense.bars, given.bars, dense.bar_count),
                tolerance);
    check_below("    reactions", reaction_difference(&dense, &sparse), 100.0 * tolerance);
    check_below("    violation", other.violation, 1e-12);
    assert_int_equal(one.dependent, other.dependent);
    assert_int_equal(one.redundant, other.redundant);
    assert_true(other.iterations <= one.iterations + STEPS / 4);
    rig_close(&dense.s);
    rig_close(&other_way.s);
    rig_close(&sparse.s);
    rig_close(&given.s);
}

static void the_same_motion_and_reactions(void **state)
{
    (void)state;
    compare("chain of hinges", chain_of_hinges, 1e-10);
    compare("chain of balls", chain_of_balls, 1e-10);
    compare("tree", tree, 1e-10);
    compare("star", star, 1e-10);
    compare("ring of hinges", ring_of_hinges, 1e-10);
    compare("ring without redundance", ring_without_redundance, 1e-10);
    compare("four-bars", four_bars, 1e-10);
    compare("ladder", ladder, 1e-10);
    compare("gear, drive, held body", mixture, 1e-10);
    compare("pipe at the end", bars_and_pipe, 1e-9);
}

/* ---- At rest ----------------------------------------------------------------------------------------------------- */

static void hanging(machine *m)
{
    for (uint32_t i = 0; i < 14; i++) {
        const double a = -1.3;
        (void)add_machine_bar(m, i * cos(a), i * sin(a), (i + 1) * cos(a), (i + 1) * sin(a));
        connect(m, DMB_JOINT_REVOLUTE, i ? on(m, i - 1, 0.5) : pin_ground(0.0, 0.0), on(m, i, -0.5));
    }
}

/* Upside down, on springs that are too weak for as many negative eigenvalues as the dense way counts. */
static void standing(machine *m)
{
    for (uint32_t i = 0; i < 13; i++) {
        (void)add_machine_bar(m, 0.0, i, 0.0, i + 1.0);
        dmb_joint_def def =
            hinge_of("", DMB_JOINT_REVOLUTE, i ? on(m, i - 1, 0.5) : pin_ground(0.0, 0.0), on(m, i, -0.5));
        def.rest[DMB_RX] = i ? 0.0 : 0.5 * PI;
        def.stiffness[DMB_RX] = 400.0;
        m->joints[m->joint_count++] = add_joint(&m->s, &def);
    }
}

static void compare_at_rest(const char *name, scene_fn *describe)
{
    machine both[2] = {open_machine(describe, DENSE, 0), open_machine(describe, SPARSE, 0)};
    dmb_static_report report[2];
    double frequency[2] = {0.0, 0.0};
    print_message("%s\n", name);
    for (int i = 0; i < 2; i++) {
        dmb_modes_options options = dmb_modes_options_default();
        dmb_modes *modes = NULL;
        dmb_mode mode = dmb_mode_default();
        report[i] = dmb_static_report_default();
        must(&both[i].s, dmb_analysis_static(both[i].s.sim, NULL, &report[i]));
        options.count = 3;
        if (report[i].negative > 0) continue;
        must(&both[i].s, dmb_analysis_modes(both[i].s.sim, &options, &modes));
        must(&both[i].s, dmb_modes_get(modes, 1, &mode));
        frequency[i] = mode.frequency;
        dmb_modes_destroy(&modes);
    }
    check_below("    pose", motion_difference(&both[0].s, &both[1].s, both[0].bars, both[1].bars, both[0].bar_count),
                1e-8);
    check_below("    reactions", reaction_difference(&both[0], &both[1]), 1e-9);
    check_below("    second frequency", fabs(frequency[1] - frequency[0]), 1e-8);
    print_message("    negative eigenvalues %d\n", (int)report[0].negative);
    assert_int_equal(report[0].negative, report[1].negative);
    rig_close(&both[0].s);
    rig_close(&both[1].s);
}

static void the_same_at_rest(void **state)
{
    (void)state;
    compare_at_rest("hanging chain", hanging);
    compare_at_rest("standing chain", standing);
}

/* ---- Copies ------------------------------------------------------------------------------------------------------ */

/* With an input a sim has parts of its scene for itself, and so has each copy. */
static void hanging_with_an_input(machine *m)
{
    dmb_load_def push = dmb_load_def_default();
    dmb_input_def input = dmb_input_def_default();
    hanging(m);
    push.place = dmb_station(m->bars[13], 0, 0.0);
    push.force[1] = 3.0;
    strcpy(input.name, "push");
    input.target = DMB_TARGET_LOAD_FACTOR;
    input.part = add_load(&m->s, &push);
    must_model(&m->s, dmb_model_add_input(m->s.model, &input, NULL));
}

/* Analyses work on dense copies, and some on copies of these, which are as dense. */
static void copies_of_copies_are_dense(void **state)
{
    machine m = open_machine(hanging_with_an_input, SPARSE, 0);
    (void)state;
    dmb_sim *copy = dmb_state_copy(m.s.sim), *second = dmb_state_copy(copy);
    assert_non_null(copy);
    assert_non_null(second);
    assert_true(copy->scene == &copy->own->dense && second->scene == &second->own->dense);
    assert_int_equal(second->scene->sparse_count, 0);
    assert_memory_equal(second->now.displacement, m.s.sim->now.displacement, 3 * sizeof(double) * m.bar_count);
    assert_memory_equal(second->partition_row, copy->partition_row,
                        copy->scene->constraint_row_count * sizeof(uint32_t));
    dmb_state_discard(copy);
    dmb_state_discard(second);
    rig_close(&m.s);
}

/* ---- Restart and refusals ---------------------------------------------------------------------------------------- */

static void a_snapshot_goes_on_with_the_same_bits(void **state)
{
    static unsigned char snapshot[1 << 20];
    machine m = open_machine(ladder, SPARSE, 0);
    uint64_t through, again;
    size_t size = 0;
    (void)state;
    for (int k = 0; k < 20; k++) must(&m.s, dmb_sim_step(m.s.sim, 2e-3, NULL));
    must(&m.s, dmb_sim_snapshot_size(m.s.sim, &size));
    assert_true(size <= sizeof snapshot);
    must(&m.s, dmb_sim_snapshot(m.s.sim, snapshot, size));
    for (int k = 0; k < 20; k++) must(&m.s, dmb_sim_step(m.s.sim, 2e-3, NULL));
    must(&m.s, dmb_sim_hash(m.s.sim, &through));
    must(&m.s, dmb_sim_restore(m.s.sim, snapshot, size));
    for (int k = 0; k < 20; k++) must(&m.s, dmb_sim_step(m.s.sim, 2e-3, NULL));
    must(&m.s, dmb_sim_hash(m.s.sim, &again));
    assert_true(through == again);
    rig_close(&m.s);
}

/* A ring that cannot close. */
static void what_does_not_fit_is_refused(void **state)
{
    machine m;
    (void)state;
    memset(&m, 0, sizeof m);
    rig_open(&m.s, 0.0, 0.0, -9.81);
    chain(&m, DMB_JOINT_REVOLUTE);
    connect(&m, DMB_JOINT_REVOLUTE, pin_ground(40.0, 0.0), on(&m, 15, 0.5));
    const refusal r = refused_start(&m.s);
    print_message("    %s\n", r.text);
    assert_int_equal(r.status, DMB_ERR_GEOMETRY);
    rig_close(&m.s);
}

/* The model check of a cluster beyond dense matrices goes by the choice of rows that the steps are taken with. */
static void check_of_a_long_ring(const rig *s, uint32_t bars)
{
    static char text[1 << 16];
    dmb_check_report report = dmb_check_report_default();
    const uint64_t before = rig_hash(s);
    must(s, dmb_analysis_check(s->sim, &report));
    assert_int_equal(report.clusters, 1);
    assert_int_equal(report.largest_cluster, 6 * bars);
    assert_int_equal(report.constraint_rows, 5 * (bars + 1));
    assert_int_equal(report.rank, 5 * (bars + 1) - 3);
    assert_int_equal(report.redundant, 3);
    assert_int_equal(report.degrees_of_freedom, bars - 2);
    assert_true(report.condition > 0.0 && report.condition < 1.0);
    must(s, dmb_analysis_check_text(s->sim, text, sizeof text, NULL));
    assert_non_null(strstr(text, "redundant equations:\n    joint ")); /* three of a plane's, whichever they are */
    assert_non_null(strstr(text, ": position x\n"));
    assert_non_null(strstr(text, ": rotation about z\n"));
    assert_non_null(strstr(text, ": rotation about y\n"));
    assert_true(rig_hash(s) == before);
}

/* Three equations of a plane ring are redundant, however long it is. */
static void redundant_in_a_long_ring(void **state)
{
    enum { N = 400 };
    const double r = 0.5 / sin(PI / N);
    dmb_id first = ground_id, last = ground_id;
    rig s;
    (void)state;
    rig_open(&s, 0.0, 0.0, -9.81);
    for (int i = 0; i < N; i++) {
        const double a = 2.0 * PI * i / N, b = 2.0 * PI * (i + 1) / N;
        const bar def = {{r * cos(a), r * sin(a)}, {r * cos(b), r * sin(b)}, 1.0};
        const dmb_id here = add_bar(&s, &def);
        (void)add_hinge(&s, "", DMB_JOINT_REVOLUTE, i ? pin_on(last, 0.5) : pin_ground(r, 0.0), pin_on(here, -0.5));
        if (i == 0) first = here;
        last = here;
    }
    (void)add_hinge(&s, "", DMB_JOINT_REVOLUTE, pin_on(last, 0.5), pin_on(first, -0.5));
    (void)mechanism_start(&s, NULL);
    for (int k = 0; k < 5; k++) must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    const dmb_statistics statistics = statistics_of(&s);
    assert_int_equal(statistics.dependent, 5 * (N + 1) - 3);
    assert_int_equal(statistics.redundant, 3);
    check_below("    violation of a ring of 400", statistics.violation, 1e-12);
    check_of_a_long_ring(&s, N);
    rig_close(&s);
}

/* Steps are not bounded; analyses that need dense matrices are. */
static void longer_than_dense_matrices(void **state)
{
    rig s;
    dmb_id last = ground_id;
    dmb_modes *modes = NULL;
    (void)state;
    rig_open(&s, 0.0, 0.0, -9.81);
    const bar beside = {{0.0, 5.0}, {1.0, 5.0}, 1.0}; /* a cluster of its own, the first one */
    (void)add_hinge(&s, "beside", DMB_JOINT_REVOLUTE, pin_ground(0.0, 5.0), pin_on(add_bar(&s, &beside), -0.5));
    for (int i = 0; i < 260; i++) {
        const bar def = {{i, 0.0}, {i + 1.0, 0.0}, 1.0};
        const dmb_id here = add_bar(&s, &def);
        (void)add_hinge(&s, i == 0 ? "link" : "", DMB_JOINT_REVOLUTE, i ? pin_on(last, 0.5) : pin_ground(0.0, 0.0),
                        pin_on(here, -0.5));
        last = here;
    }
    (void)mechanism_start(&s, NULL);
    for (int k = 0; k < 5; k++) must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    const dmb_statistics statistics = statistics_of(&s);
    assert_int_equal(statistics.dependent, 5 * 261);
    check_below("    violation of 260 links", statistics.violation, 1e-12);
    assert_int_equal(dmb_analysis_modes(s.sim, NULL, &modes), DMB_ERR_TOO_LARGE);
    print_message("    %s\n", dmb_sim_message(s.sim));
    assert_non_null(
        strstr(dmb_sim_message(s.sim), "modes: cluster of joint 1 (link): coordinates = 1560, must be <= 1200"));
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_motion_and_reactions), cmocka_unit_test(the_same_at_rest),
        cmocka_unit_test(copies_of_copies_are_dense),    cmocka_unit_test(a_snapshot_goes_on_with_the_same_bits),
        cmocka_unit_test(what_does_not_fit_is_refused),  cmocka_unit_test(redundant_in_a_long_ring),
        cmocka_unit_test(longer_than_dense_matrices),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
