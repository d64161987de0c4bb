/* Whole runs with kernels of every width that the build and the processor have: the same bits, whatever a string's
 * length leaves over in the last group. */
#include "full_rig.h"
#include "rig.h"

#include "kernel/kernels.h"
#include "sim/sim.h"

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
    for (int i = 0; i < 60; i++) must(&s, dmb_sim_step(s.sim, 2e-4, NULL));
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
    for (int i = 0; i < 60; i++) must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
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
    for (int i = 0; i < 60; i++) must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    return close_with_hash(&s);
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
                                       cmocka_unit_test(the_widest_is_there)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
