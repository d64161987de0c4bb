/* Lowest damped modes of short damped strings. Motions of undamped frequency w > 2/tau are overdamped, with roots
 *
 *     s = (-tau w^2 +- sqrt(tau^2 w^4 - 4 w^2))/2  ->  -1/tau, -tau w^2,
 *
 * so that a root of each of them crowds at -1/tau, just beyond |s| = 1/tau, the highest motion next to it. */
#include <stdio.h>
#include <string.h>

#include "mechanism.h"
#include "modal.h"

/* Ten metres of drill collars with two stabilisers, that lie in their hole. */
static void open_collars(rig *s, uint32_t pipes)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    wall.diameter = 0.2;
    wall.friction_law = DMB_FRICTION_NONE;
    add_wall(s, &wall);
    string.start_free = DMB_FREE_NONE;
    ring.string = pipe.string = add_string(s, &string);
    pipe.length = 10.0 / pipes;
    pipe.outer_diameter = 0.171;
    pipe.inner_diameter = 0.07;
    pipe.damping_time = 1e-3;
    (void)add_pipes(s, &pipe, pipes);
    ring.fraction = 0.5;
    ring.outer_diameter = 0.199;
    for (uint32_t k = 1; k <= 2; k++) {
        ring.pipe = k * pipes / 3;
        must_model(s, dmb_model_add_stabiliser(s->model, &ring, NULL));
    }
    (void)rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
}

static dmb_modes *lowest_damped(const rig *s, uint32_t count, int32_t wanted)
{
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    options.kind = DMB_MODES_DAMPED;
    options.count = count;
    assert_int_equal(dmb_analysis_modes(s->sim, &options, &modes), wanted);
    return modes;
}

/* Of few coordinates all those asked for, up to those in the crowd. */
static void few_coordinates(void **state)
{
    (void)state;
    rig s;
    open_collars(&s, 30);
    dmb_modes *few = lowest_damped(&s, 10, DMB_OK), *many = lowest_damped(&s, 20, DMB_OK);
    assert_int_equal(info_of(many).count, 20);
    for (uint32_t i = 0; i < 10; i++)
        check_relative("the same by both ways", frequency_at(few, i), frequency_at(many, i), 1e-10);
    check_relative("the last ones are those of the crowd", frequency_at(many, 19), 1e3 / (2.0 * PI), 1e-3);
    assert_true(mode_at(many, 19).damping > 0.999);
    dmb_modes_destroy(&few);
    dmb_modes_destroy(&many);
    rig_close(&s);
}

/* Of many those below the crowd, with a note that says where it is. */
static void many_coordinates(void **state)
{
    (void)state;
    rig s;
    open_collars(&s, 80);
    dmb_modes *few = lowest_damped(&s, 10, DMB_OK), *many = lowest_damped(&s, 20, DMB_NOTE_INCOMPLETE);
    print_message("%s\n", dmb_sim_message(s.sim));
    assert_non_null(strstr(dmb_sim_message(s.sim), "crowd near 159."));
    assert_true(info_of(many).count > 10 && info_of(many).count < 20);
    for (uint32_t i = 0; i < 10; i++)
        check_relative("the same by both ways", frequency_at(few, i), frequency_at(many, i), 1e-10);
    assert_true(frequency_at(many, info_of(many).count - 1) < 1e3 / (2.0 * PI));
    dmb_modes_destroy(&few);
    dmb_modes_destroy(&many);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(few_coordinates), cmocka_unit_test(many_coordinates)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
