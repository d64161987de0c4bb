/* The whole iteration matrix of a string that drills with a bit and a reamer on a ring, by the rate law of the rock,
 * against differences of the residual by the increments of a step. */
#include <stdio.h>

#include "drillmbd/scene.h"
#include "moved_rig.h"
#include "rig.h"

static dmb_bit_def cutting(int32_t law, double outer, double inner)
{
    dmb_bit_def bit = dmb_bit_def_default();
    bit.rock_law = law;
    bit.radius = outer;
    bit.inner_radius = inner;
    bit.intrinsic_energy = 1e7;
    bit.diameter = 0.0;
    return bit;
}

static rig drilling(int32_t law)
{
    rig s;
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_id on;
    rig_open(&s, 0.0, 0.0, 0.0);
    wall.diameter = 0.16;
    wall.normal_law = DMB_NORMAL_NONE;
    (void)add_wall(&s, &wall);
    pipe.string = ring.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 3);
    ring.pipe = 1;
    ring.fraction = 0.7;
    ring.outer_diameter = 0.15;
    must_model(&s, dmb_model_add_stabiliser(s.model, &ring, &on));
    dmb_bit_def bit = cutting(law, 0.0475, 0.0), reamer = cutting(law, 0.075, 0.0475);
    reamer.stabiliser = on;
    must_model(&s, dmb_model_add_bit(s.model, &bit, NULL));
    must_model(&s, dmb_model_add_bit(s.model, &reamer, NULL));
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, DMB_X, add_constant(&s, 2e-3));
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(&s, 10.0));
    (void)rig_start(&s, NULL);
    take_divided_steps(&s, 1e-3, 400);
    return s;
}

static void against_differences(void **state)
{
    static double found[ROWS_MAX][ROWS_MAX], base[ROWS_MAX];
    (void)state;
    rig s = drilling(DMB_ROCK_RATE);
    const uint32_t rows = s.sim->scene->row_count;
    double worst = 0.0, largest = 0.0;
    assert_true(rows <= ROWS_MAX);
    for (uint32_t i = 0; i < 2; i++) assert_true(s.sim->now.bit_advance[i] > s.sim->now.bit_bottom[i]);
    for (uint32_t i = 0; i < s.sim->scene->node_count; i++) { /* on, so that differences do not leave the rock */
        base[s.sim->scene->layout.row[i]] = 2e-3;
        s.sim->now.velocity[s.sim->scene->layout.row[i]] += 2e-2;
    }
    matrix_by_differences(s.sim, 1, base, found);
    make_matrix(s.sim, 1, base);
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t j = 0; j < rows; j++) {
            if (!s.sim->scene->solved_row[i] || !s.sim->scene->solved_row[j]) continue;
            worst = fmax(worst, fabs(found[i][j] - block_entry(s.sim, i, j)));
            largest = fmax(largest, fabs(found[i][j]));
        }
    check_below("iteration matrix with a bit and a reamer", worst / largest, 1e-9);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(against_differences)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
