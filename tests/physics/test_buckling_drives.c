/* Buckling and paths by what else than a load may grow: the way of a motion drive, the force of a load drive, a factor
 * that falls. A column that is pressed by so much way buckles where its force is Euler's. */
#include <string.h>

#include "rig.h"

#define LENGTH 10.0
#define EI 2e5                                   /* [N m2] */
#define EA 2e9                                   /* [N] */
#define EULER (PI * PI * EI / (LENGTH * LENGTH)) /* [N] pinned at both ends; clamped at both: four times as much */

typedef struct subject {
    rig s;
    dmb_id string, drive;
} subject;

static dmb_id add_column(rig *s, int32_t start_free, int32_t end_free)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(0.5 * LENGTH, 8, EA, EA, EI / 1.3, EI);
    def.follows_hole = 0;
    def.start_free = start_free;
    def.end_free = end_free;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 2);
    return pipe.string;
}

/* Behind a bar that has no part in it, so that its rows are not the first. */
static subject open_pressed(int32_t kind)
{
    subject c;
    rig_open(&c.s, 0.0, 0.0, 0.0);
    (void)add_column(&c.s, DMB_FREE_NONE, DMB_FREE_ALL);
    c.string = add_column(&c.s, DMB_FREE_X, DMB_FREE_NONE);
    c.drive = add_simple_drive(&c.s, kind, c.string, DMB_X, add_constant(&c.s, 0.0));
    (void)rig_start(&c.s, NULL);
    (void)find_equilibrium(&c.s, NULL);
    return c;
}

/* Critical factor of the drive; step: 0, or the difference that is taken. */
static double critical(const subject *c, int32_t follow, double step)
{
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling *found = NULL;
    double factor = 0.0;
    options.scale = DMB_SCALE_PART;
    options.part = c->drive;
    options.follow = follow;
    options.step = step;
    must(&c->s, dmb_analysis_buckling(c->s.sim, &options, &found));
    assert_int_equal(dmb_buckling_factor(found, 0, &factor), DMB_OK);
    dmb_buckling_destroy(&found);
    return factor;
}

static void by_the_force_of_a_drive(void **state)
{
    (void)state;
    subject c = open_pressed(DMB_DRIVE_LOAD);
    const double followed = critical(&c, 1, 0.0);
    check_relative("force that buckles it", followed, 4.0 * EULER, 1e-3);
    check_relative("extrapolated", critical(&c, 0, 0.0), followed, 1e-3);
    check_relative("by a difference of 1 N", critical(&c, 0, 1.0), critical(&c, 0, 0.0), 1e-6);
    rig_close(&c.s);
}

static void by_the_way_of_a_drive(void **state)
{
    (void)state;
    subject c = open_pressed(DMB_DRIVE_MOTION);
    const double followed = critical(&c, 1, 0.0);
    check_relative("way that buckles it", followed, 4.0 * EULER * LENGTH / EA, 1e-3);
    check_relative("extrapolated", critical(&c, 0, 0.0), followed, 1e-3);
    dmb_path_options options = dmb_path_options_default();
    dmb_path_report report = dmb_path_report_default();
    options.scale = DMB_SCALE_PART;
    options.part = c.drive;
    options.factor_end = 1.5 * followed;
    must(&c.s, dmb_analysis_path(c.s.sim, &options, &report));
    check_relative("on the path", report.first_bifurcation, followed, 1e-6);
    double aside[2];
    for (int sized = 0; sized < 2; sized++) { /* the same branch by a first step of its own, and by that of the path */
        options.branch = 1;
        options.branch_size = sized ? 0.01 : 0.0;
        options.place = dmb_station(c.string, 0, 1.0);
        options.component = DMB_Y;
        must(&c.s, dmb_analysis_path(c.s.sim, &options, &report));
        check_relative("    end of its branch", report.factor, options.factor_end, 1e-9);
        options.component = DMB_Z;
        aside[sized] = report.displacement * report.displacement;
        must(&c.s, dmb_analysis_path(c.s.sim, &options, &report));
        aside[sized] += report.displacement * report.displacement;
    }
    assert_true(aside[0] > 1e-4);
    check_relative("    how far it goes aside", aside[0], aside[1], 1e-6);
    rig_close(&c.s);
}

/* A sledge presses the column through a spring: what it moves by is refused, since the spring has part in it, and the
 * force on it is not. */
static void through_a_spring(void **state)
{
    (void)state;
    dmb_body_def sledge = dmb_body_def_default();
    dmb_spring_def spring = dmb_spring_def_default();
    for (int32_t kind = DMB_DRIVE_MOTION; kind <= DMB_DRIVE_LOAD; kind++) {
        subject c;
        rig_open(&c.s, 0.0, 0.0, 0.0);
        c.string = add_column(&c.s, DMB_FREE_X, DMB_FREE_NONE);
        sledge.position[0] = -1.0;
        sledge.free_mask = DMB_FREE_X;
        const dmb_id body = add_body(&c.s, &sledge);
        spring.place_a = dmb_station(body, 0, 0.0);
        spring.place_b = dmb_station(c.string, 0, 0.0);
        spring.stiffness = 1e6;
        must_model(&c.s, dmb_model_add_spring(c.s.model, &spring, NULL));
        c.drive = add_simple_drive(&c.s, kind, body, DMB_X, add_constant(&c.s, 0.0));
        (void)rig_start(&c.s, NULL);
        (void)find_equilibrium(&c.s, NULL);
        if (kind == DMB_DRIVE_LOAD) {
            check_relative("force that buckles it", critical(&c, 1, 0.0), 4.0 * EULER, 1e-3);
        } else {
            dmb_path_options options = dmb_path_options_default();
            options.scale = DMB_SCALE_PART;
            options.part = c.drive;
            assert_int_equal(dmb_analysis_path(c.s.sim, &options, NULL), DMB_ERR_UNSUPPORTED);
            assert_non_null(strstr(dmb_sim_message(c.s.sim), "drive 0 moves a place that joints, springs"));
        }
        rig_close(&c.s);
    }
}

/* Loads that fall: along -1 .. the tip of a cantilever comes to rest undeflected and goes to the other side, as by the
 * opposite load. */
static void by_a_factor_that_falls(void **state)
{
    (void)state;
    double tip[2];
    for (int side = 0; side < 2; side++) {
        subject c;
        dmb_load_def load = dmb_load_def_default();
        dmb_path_options options = dmb_path_options_default();
        dmb_path_report report = dmb_path_report_default();
        rig_open(&c.s, 0.0, 0.0, 0.0);
        c.string = add_column(&c.s, DMB_FREE_NONE, DMB_FREE_ALL);
        options.place = load.place = dmb_station(c.string, 1, 1.0);
        load.force[1] = 2.0 * EULER;
        (void)add_load(&c.s, &load);
        (void)rig_start(&c.s, NULL);
        (void)find_equilibrium(&c.s, NULL);
        options.component = DMB_Y;
        options.factor_end = side == 0 ? -3.0 : 1.0;
        must(&c.s, dmb_analysis_path(c.s.sim, &options, &report));
        check_relative("end of the path", report.factor, options.factor_end, 1e-9);
        assert_true(report.limits == 0 && report.bifurcations == 0);
        tip[side] = report.displacement;
        rig_close(&c.s);
    }
    assert_true(tip[1] > 0.3 * LENGTH);
    check_relative("twice the load, backwards", tip[0], -tip[1], 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(by_the_force_of_a_drive),
        cmocka_unit_test(by_the_way_of_a_drive),
        cmocka_unit_test(through_a_spring),
        cmocka_unit_test(by_a_factor_that_falls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
