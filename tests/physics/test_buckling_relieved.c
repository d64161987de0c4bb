/* Buckling that the present state tells wrongly, followed to where it is: a column that a buffer relieves before its
 * critical load. A column of one element, which turns at its ends only. */
#include <string.h>

#include "rig.h"

#define LENGTH 10.0
#define EI 2e5                                            /* [N m2] */
#define EA 1e9                                            /* [N] */
#define CRITICAL (4.0 * PI * PI * EI / (LENGTH * LENGTH)) /* [N] clamped at both ends */
#define PUSH (0.1 * CRITICAL)
#define STIFFER 10.0 /* buffer against column, along */

static dmb_id add_column(rig *s, int32_t start_free, int32_t end_free, uint32_t elements)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_pipe_def pipe = beam_pipe(LENGTH, elements, EA, 10.0 * EA, EI / 1.3, EI);
    def.follows_hole = 0;
    def.start_free = start_free;
    def.end_free = end_free;
    pipe.string = add_string(s, &def);
    const dmb_id string = add_pipes(s, &pipe, 1);
    load.place = dmb_station(string, 0, 1.0);
    load.force[0] = -PUSH;
    (void)add_load(s, &load);
    return string;
}

/* The buffer touches where the column bears half of its critical load. */
static rig open_relieved(void)
{
    rig s;
    dmb_spring_def buffer = dmb_spring_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id string = add_column(&s, DMB_FREE_NONE, DMB_FREE_X, 16);
    buffer.acts = DMB_SPRING_COMPRESSION;
    buffer.place_b = dmb_station(string, 0, 1.0);
    buffer.offset_a[0] = LENGTH - 1.0;
    buffer.free_length = 1.0 - 0.5 * CRITICAL * LENGTH / EA;
    buffer.stiffness = STIFFER * EA / LENGTH;
    must_model(&s, dmb_model_add_spring(s.model, &buffer, NULL));
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    return s;
}

static dmb_buckling *find(const rig *s, int32_t follow, double factor_max, int32_t *status)
{
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling *found = NULL;
    options.follow = follow;
    options.factor_max = factor_max;
    *status = dmb_analysis_buckling(s->sim, &options, &found);
    must(s, *status);
    return found;
}

static double load_of(const dmb_buckling *found)
{
    double factor = 0.0;
    assert_int_equal(dmb_buckling_factor(found, 0, &factor), DMB_OK);
    return PUSH * (1.0 + factor);
}

/* Then the load is the column's, and what the buffer bears as it is shortened by the other half of it. */
static void relieved_by_a_buffer(void **state)
{
    (void)state;
    int32_t status;
    rig s = open_relieved();
    dmb_buckling *found = find(&s, 0, 1e12, &status);
    check_relative("told by the present state", load_of(found), CRITICAL, 1e-3);
    dmb_buckling_destroy(&found);
    found = find(&s, 1, 1e12, &status);
    check_relative("on the way", load_of(found), (1.0 + 0.5 * STIFFER) * CRITICAL, 1e-3);
    dmb_buckling_destroy(&found);
    rig_close(&s);
}

static void stable_up_to_the_bound(void **state)
{
    (void)state;
    int32_t status;
    rig s = open_relieved();
    dmb_buckling_info info = dmb_buckling_info_default();
    dmb_buckling *found = find(&s, 1, 30.0, &status);
    assert_int_equal(status, DMB_NOTE_STOPPED);
    assert_non_null(strstr(dmb_sim_message(s.sim), "stable up to factor = 30, beyond the critical factor 9"));
    assert_int_equal(dmb_buckling_get_info(found, &info), DMB_OK);
    assert_int_equal(info.end, DMB_BUCKLING_STABLE);
    assert_int_equal(info.count, 0);
    dmb_buckling_destroy(&found);
    rig_close(&s);
}

/* Its ends turn by t against each other: bending 2 EI t^2/L, an arc whose chord is shorter by L t^2/6: 12 EI/L^2. The
 * nodes stay on the axis, so that the shape is told by rotations of 1 rad. */
static void one_element(void **state)
{
    (void)state;
    int32_t status;
    rig s;
    double shape[6];
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id string = add_column(&s, DMB_FREE_RZ, DMB_FREE_ALL, 1);
    (void)add_joint_between(&s, DMB_JOINT_POINT_ON_LINE, dmb_station((dmb_id){0, 0}, 0, 0.0),
                            dmb_station(string, 0, 1.0));
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    dmb_buckling *found = find(&s, 1, 1e12, &status);
    check_relative("one element", load_of(found), 12.0 * EI / (LENGTH * LENGTH), 1e-3);
    for (int end = 0; end < 2; end++) {
        assert_int_equal(dmb_buckling_shape(found, 0, dmb_station(string, 0, end), shape), DMB_OK);
        check_close("rotation", fabs(shape[DMB_RZ]), 1.0, 1e-6);
        for (int k = 0; k < 5; k++) assert_true(fabs(shape[k]) < 1e-6);
    }
    dmb_buckling_destroy(&found);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(relieved_by_a_buffer),
        cmocka_unit_test(stable_up_to_the_bound),
        cmocka_unit_test(one_element),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
