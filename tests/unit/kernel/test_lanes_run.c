/* Whole runs with kernels of every width that the build and the processor have: the same bits, whatever a string's
 * length leaves over in the last group. */
#include "full_rig.h"
#include "rig.h"

#include "kernel/kernels.h"
#include "sim/sim.h"

#ifdef DMB_SOME_CASES
enum { STEPS = 15, SHARE = 4 }; /* one of the strings that rub for each hole and law, by turns */
#else
enum { STEPS = 60, SHARE = 1 };
#endif

static void use_lanes(rig *s, uint32_t lanes)
{
    ((dmb_scene *)(uintptr_t)s->sim->scene)->kernels = dmb_kernels_of(lanes);
}

static uint64_t close_with_hash(rig *s)
{
    uint64_t hash = 0;
    assert_int_equal(dmb_sim_hash(s->sim, &hash), DMB_OK);
    rig_close(s);
    return hash;
}

/* Everything on, from a state in the middle of a motion; steps may be divided. */
static uint64_t hash_of_rig(const full_rig_choice *choice, uint32_t lanes)
{
    rig s;
    full_rig_open(&s, choice);
    use_lanes(&s, lanes);
    for (int i = 0; i < STEPS; i++) must(&s, dmb_sim_step(s.sim, 2e-4, NULL));
    return close_with_hash(&s);
}

/* A string held at the rig, with tool joints, falling; lanes wider than it, too. */
static uint64_t hash_of_string(uint32_t pipes, uint32_t elements, uint32_t lanes)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    pipe.elements = elements;
    pipe.joint_length = 0.1;
    add_pipes(&s, &pipe, pipes);
    rig_start(&s, NULL);
    use_lanes(&s, lanes);
    for (int i = 0; i < STEPS; i++) must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    return close_with_hash(&s);
}

/* Axial-torsional pipes of two types hanging from the rig, turned, damped; behind them flexible ones, or none. */
static uint64_t hash_of_bars(uint32_t pipes, uint32_t flexible, uint32_t lanes)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def turn = dmb_drive_def_default();
    dmb_segment term = dmb_segment_default();
    rig s;
    rig_open(&s, 9.81, 0.0, 0.0);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.damping_time = 1e-4;
    add_pipes(&s, &pipe, pipes);
    pipe.length = 0.7;
    add_pipes(&s, &pipe, 2);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    if (flexible) add_pipes(&s, &pipe, flexible);
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = 0.02;
    term.h1 = 10.0;
    turn.component = DMB_RX;
    turn.time_function = add_time_function(&s, &term, 1);
    add_drive(&s, &turn);
    rig_start(&s, NULL);
    use_lanes(&s, lanes);
    for (int i = 0; i < STEPS; i++) must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    return close_with_hash(&s);
}

/* Axial-torsional pipes that rub on the wall of a straight hole, of one that bends there and back, or of one with
 * sections: pushed, turned and damped, behind them flexible ones, or none. */
enum { STRAIGHT, BENT, SECTIONS, HOLES };

static void add_rubbing_wall(rig *s, int hole, int32_t friction_law)
{
    static const double survey[5 * 3] = {0.0, 1.5, 0.1, 2.0, 1.6, 0.1, 3.5, 1.6, 0.1, 6.0, 1.2, 0.3, 40.0, 1.4, 2.0};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_hole_section section = dmb_hole_section_default();
    wall.friction_law = friction_law;
    wall.mu_dynamic = 0.3;
    wall.mu_static = friction_law == DMB_FRICTION_COULOMB ? 0.3 : 0.4;
    if (hole != STRAIGHT) wall.survey = survey, wall.survey_count = 5;
    must(s, dmb_model_add_wall(s->model, &wall, NULL));
    for (int i = 0; i < 3 && hole == SECTIONS; i++) {
        section.depth = 1.5 + i;
        section.mu_dynamic = 0.1 + 0.05 * i;
        must(s, dmb_model_add_hole_sections(s->model, &section, 1));
    }
}

static uint64_t hash_of_rubbing(uint32_t pipes, uint32_t flexible, int hole, int32_t friction_law, uint32_t lanes)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_segment term = dmb_segment_default();
    dmb_environment_def air = dmb_environment_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    air.axial_damping = 5.0;
    air.torsional_damping = 0.2;
    must(&s, dmb_model_set_environment(s.model, &air));
    add_rubbing_wall(&s, hole, friction_law);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.damping_time = 1e-4;
    add_pipes(&s, &pipe, pipes);
    pipe.kind = DMB_PIPE_FLEXIBLE;
    if (flexible) add_pipes(&s, &pipe, flexible);
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = 0.02;
    for (int k = 0; k < 2; k++) {
        dmb_drive_def drive = dmb_drive_def_default();
        term.h1 = k ? 10.0 : 0.01;
        drive.component = k ? DMB_RX : DMB_X;
        drive.time_function = add_time_function(&s, &term, 1);
        add_drive(&s, &drive);
    }
    rig_start(&s, NULL);
    use_lanes(&s, lanes);
    for (int i = 0; i < 25; i++) must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    return close_with_hash(&s);
}

static void rubbing_in_every_width(void **state)
{
    static const int32_t laws[4] = {DMB_FRICTION_COULOMB, DMB_FRICTION_STRIBECK, DMB_FRICTION_BRISTLE,
                                    DMB_FRICTION_AMBROSIO};
    static const uint32_t pipes[4] = {1, 4, 6, 9}, flexible[4] = {0, 0, 2, 0};
    uint64_t before[4] = {0, 0, 0, 0};
    (void)state;
    for (int k = 0; k < 4 * HOLES; k++)
        for (int i = (k + k / 4) % SHARE; i < 4; i += SHARE) {
            const uint64_t one = hash_of_rubbing(pipes[i], flexible[i], k / 4, laws[k % 4], 1);
            assert_true(one != before[i]); /* it depends on hole and law */
            before[i] = one;
            for (uint32_t lanes = 2; lanes <= 8; lanes *= 2)
                if (dmb_kernels_of(lanes))
                    assert_true(hash_of_rubbing(pipes[i], flexible[i], k / 4, laws[k % 4], lanes) == one);
        }
}

static void every_width_gives_the_same_bits(void **state)
{
    static const full_rig_choice choices[] = {
        {DMB_FRICTION_STRIBECK, DMB_NORMAL_HUNT_CROSSLEY, DMB_ROCK_RATE, 0, 1, 0, 0},
        {DMB_FRICTION_BRISTLE, DMB_NORMAL_KELVIN_VOIGT, DMB_ROCK_NONE, 1, 1, 0, 0}};
    (void)state;
    for (uint32_t lanes = 2; lanes <= 8; lanes *= 2) {
        if (!dmb_kernels_of(lanes)) {
            print_message("    kernels of %u lanes: not in this build or processor\n", (unsigned)lanes);
            continue;
        }
        for (int k = 0; k < 2; k++) assert_true(hash_of_rig(&choices[k], lanes) == hash_of_rig(&choices[k], 1));
        for (uint32_t pipes = 1; pipes <= 9; pipes += 2)
            for (uint32_t elements = 1; elements <= 2; elements++)
                assert_true(hash_of_string(pipes, elements, lanes) == hash_of_string(pipes, elements, 1));
        for (uint32_t pipes = 1; pipes <= 9; pipes++)
            for (uint32_t flexible = 0; flexible <= 3; flexible += 3)
                assert_true(hash_of_bars(pipes, flexible, lanes) == hash_of_bars(pipes, flexible, 1));
        print_message("    kernels of %u lanes: same bits as one\n", (unsigned)lanes);
    }
}

static void the_widest_is_there(void **state)
{
    (void)state;
    const dmb_kernels *widest = dmb_kernels_widest();
    assert_non_null(dmb_kernels_of(1));
    assert_int_equal(dmb_kernels_of(1)->lanes, 1);
    assert_true(dmb_kernels_of(widest->lanes) == widest);
    assert_null(dmb_kernels_of(0));
    assert_null(dmb_kernels_of(3));
    assert_null(dmb_kernels_of(16));
    print_message("    widest: %u lanes\n", (unsigned)widest->lanes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_width_gives_the_same_bits),
                                       cmocka_unit_test(rubbing_in_every_width), cmocka_unit_test(the_widest_is_there)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
