/* Beck's column flutters under the same load whether its load grows alone or with all others, of which there are none,
 * and in a hole that it does not touch, with or without friction. */
#include "rig.h"

#define EI 2e5 /* [N m2] */
#define LENGTH 10.0
#define UNIT (EI / (LENGTH * LENGTH))

/* [EI/L^2]; friction < 0: no hole. */
static double load_of_flutter(int32_t scale, int32_t friction)
{
    rig s;
    dmb_wall_def hole = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(LENGTH, 6, 1e6 * EI, 1e6 * EI, EI / 1.3, EI);
    dmb_load_def load = dmb_load_def_default();
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling_info info = dmb_buckling_info_default();
    dmb_buckling *found = NULL;
    rig_open(&s, 0.0, 0.0, 0.0);
    hole.diameter = 2.0;
    hole.friction_law = friction;
    if (friction >= 0) (void)add_wall(&s, &hole);
    string.follows_hole = friction >= 0;
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 1);
    load.place = dmb_station(pipe.string, 0, 1.0);
    load.frame = DMB_FRAME_BODY;
    load.force[0] = -5.0 * UNIT;
    (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    options.scale = scale;
    options.factor_max = 5.0;
    assert_int_equal(dmb_analysis_buckling(s.sim, &options, &found), DMB_NOTE_FLUTTER);
    assert_int_equal(dmb_buckling_get_info(found, &info), DMB_OK);
    assert_int_equal(info.flutter, DMB_FLUTTER_FOUND);
    dmb_buckling_destroy(&found);
    rig_close(&s);
    return 5.0 * (1.0 + info.flutter_factor);
}

static void told_alike(void **state)
{
    (void)state;
    const double alone = load_of_flutter(DMB_SCALE_LOADS, -1);
    check_relative("Beck's 20.05 EI/L^2", alone, 20.05095, 1e-2);
    check_relative("with all loads", load_of_flutter(DMB_SCALE_ALL, -1), alone, 1e-6);
    check_relative("in a hole without friction", load_of_flutter(DMB_SCALE_LOADS, DMB_FRICTION_NONE), alone, 1e-6);
    check_relative("with friction", load_of_flutter(DMB_SCALE_LOADS, DMB_FRICTION_COULOMB), alone, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(told_alike)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
