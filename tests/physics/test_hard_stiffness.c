/* Hard case 4: stiffness ratios EA/EI of 1e8, and a part of 1e-3 next to one of 1e12: converged to 1e-10 in every
 * equation, or a refusal that says so. */
#include "contact_scene.h"

static dmb_pipe_def pipe_of(int32_t kind, double EA, double GA, double GJ, double EI)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.kind = kind;
    pipe.section_stiffness[0] = EA;
    pipe.section_stiffness[1] = pipe.section_stiffness[2] = GA;
    pipe.section_stiffness[3] = GJ;
    pipe.section_stiffness[4] = pipe.section_stiffness[5] = EI;
    return pipe;
}

static void hold_start(rig *scene)
{
    dmb_string_def string = dmb_string_def_default();
    string.start_free = DMB_FREE_NONE;
    scene_open(scene, 0.0);
    add_string(scene, &string);
}

static void add_tip_load(rig *scene, dmb_id string, uint32_t pipe, const double force[3], const double moment[3])
{
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(string, pipe, 1.0);
    for (int i = 0; i < 3; i++) {
        load.force[i] = force[i];
        load.moment[i] = moment[i];
    }
    add_load(scene, &load);
}

static dmb_pose tip_of(const rig *scene, dmb_id string, uint32_t pipe)
{
    dmb_pose pose = dmb_pose_default();
    assert_int_equal(dmb_query_pose(scene->sim, dmb_station(string, pipe, 1.0), &pose), DMB_OK);
    return pose;
}

/* Cantilever of 10 m rolled up to a full circle by M = 2 pi EI/L with EA/EI = GA/EI = 1e8: tip back at the start. */
static void roll_up(void **state)
{
    const double none[3] = {0.0, 0.0, 0.0}, moment[3] = {0.0, 0.0, 2.0 * PI * 100.0 / 10.0};
    const dmb_pipe_def pipe = pipe_of(DMB_PIPE_FLEXIBLE, 1e10, 1e10, 100.0, 100.0);
    dmb_static_report report = dmb_static_report_default();
    rig scene;
    (void)state;
    hold_start(&scene);
    const dmb_id id = add_pipes(&scene, &pipe, 10);
    add_tip_load(&scene, id, 9, none, moment);
    rig_start_with(&scene, NULL, NULL);
    scene_must(&scene, dmb_analysis_static(scene.sim, NULL, &report));
    const dmb_pose tip = tip_of(&scene, id, 9);
    print_message("roll-up: %u iterations, residual %.1e, tip %.1e\n", report.iterations, report.residual,
                  hypot(tip.position[0], tip.position[1]));
    CHECK_BELOW(hypot(tip.position[0], tip.position[1]), 1e-8); /* rounding of EA over EI: 1e8 times 1e-16 */
    CHECK_BELOW(report.iterations, 10);
    /* every element carries the moment; one unit in the last place of a metre is 2e-6 N of EA, which shows as 2e-9 of
     * it */
    for (uint32_t i = 0; i < 10; i++) {
        dmb_section section = dmb_section_default();
        assert_int_equal(dmb_query_section(scene.sim, dmb_station(id, i, 0.5), &section), DMB_OK);
        CHECK_RELATIVE(section.force[5], moment[2], 1e-8);
    }
    rig_close(&scene);
}

/* Large bending of the same string under a dead tip force, EA/EI from 1e4 to 1e8: the same shape to EI/(EA L^2). */
static void bending_does_not_see_the_ratio(void **state)
{
    const double force[3] = {0.0, 5.0, 0.0}, none[3] = {0.0, 0.0, 0.0};
    double tip[3][2];
    (void)state;
    for (int k = 0; k < 3; k++) {
        const double EA = 100.0 * pow(10.0, 4.0 + 2.0 * k);
        const dmb_pipe_def pipe = pipe_of(DMB_PIPE_FLEXIBLE, EA, EA, 100.0, 100.0);
        dmb_static_report report = dmb_static_report_default();
        rig scene;
        hold_start(&scene);
        const dmb_id id = add_pipes(&scene, &pipe, 10);
        add_tip_load(&scene, id, 9, force, none);
        rig_start_with(&scene, NULL, NULL);
        scene_must(&scene, dmb_analysis_static(scene.sim, NULL, &report));
        tip[k][0] = tip_of(&scene, id, 9).position[0];
        tip[k][1] = tip_of(&scene, id, 9).position[1];
        print_message("EA/EI 1e%d: %u iterations, residual %.1e\n", 4 + 2 * k, report.iterations, report.residual);
        CHECK_BELOW(report.iterations, 20);
        rig_close(&scene);
    }
    CHECK_CLOSE(tip[1][1], tip[2][1], 1e-6);
    CHECK_CLOSE(tip[1][0], tip[2][0], 1e-6);
}

/* Pipes of 1e-3 N and 1e12 N in turn under a tip force F: each soft one stretches by F l/1e-3, and the residual of
 * every equation stays below 1e-10 of F as far as the poses can show it: one unit in the last place of a 1 m long stiff
 * pipe is 2e-4 N. The call converges to that rounding, or refuses; it never gives another place. */
static void soft_next_to_stiff(void **state)
{
    static const int32_t kinds[] = {DMB_PIPE_AXIAL_TORSIONAL, DMB_PIPE_FLEXIBLE};
    (void)state;
    for (int k = 0; k < 2; k++) {
        const dmb_pipe_def soft = pipe_of(kinds[k], 1e-3, 1e-3, 1e-3, 1e-3);
        const dmb_pipe_def stiff = pipe_of(kinds[k], 1e12, 1e12, 1e12, 1e12);
        const double force[3] = {1e-4, 0.0, 0.0}, none[3] = {0.0, 0.0, 0.0};
        dmb_static_report report = dmb_static_report_default();
        rig scene;
        hold_start(&scene);
        const dmb_id id = add_pipes(&scene, &soft, 1);
        add_pipes(&scene, &stiff, 1);
        add_pipes(&scene, &soft, 1);
        add_pipes(&scene, &stiff, 1);
        add_tip_load(&scene, id, 3, force, none);
        rig_start_with(&scene, NULL, NULL);
        const uint64_t before = rig_hash(&scene);
        const int32_t status = dmb_analysis_static(scene.sim, NULL, &report);
        print_message("kind %d: %s, %u iterations, residual %.1e, tip %.12f\n", kinds[k], dmb_status_name(status),
                      report.iterations, report.residual, tip_of(&scene, id, 3).displacement[0]);
        if (status < 0) {
            assert_true(status == DMB_ERR_NO_CONVERGENCE || status == DMB_ERR_SINGULAR);
            assert_true(strlen(dmb_sim_message(scene.sim)) > 0);
            assert_true(rig_hash(&scene) == before);
        } else {
            CHECK_RELATIVE(tip_of(&scene, id, 3).displacement[0], 0.2, 1e-10);
        }
        rig_close(&scene);
    }
}

/* A torque through soft and stiff bars: twists add up exactly, every section carries the torque. */
static void soft_next_to_stiff_torsion(void **state)
{
    const dmb_pipe_def soft = pipe_of(DMB_PIPE_AXIAL_TORSIONAL, 1e6, 1e6, 1e-3, 1e6);
    const dmb_pipe_def stiff = pipe_of(DMB_PIPE_AXIAL_TORSIONAL, 1e6, 1e6, 1e12, 1e6);
    const double none[3] = {0.0, 0.0, 0.0}, moment[3] = {1e-3, 0.0, 0.0};
    rig scene;
    double angle = 0.0;
    (void)state;
    hold_start(&scene);
    const dmb_id id = add_pipes(&scene, &stiff, 1);
    add_pipes(&scene, &soft, 1);
    add_tip_load(&scene, id, 1, none, moment);
    rig_start_with(&scene, NULL, NULL);
    const int32_t status = dmb_analysis_static(scene.sim, NULL, NULL);
    print_message("torsion: %s\n", dmb_status_name(status));
    if (status >= 0) {
        assert_int_equal(dmb_query_rotation(scene.sim, dmb_station(id, 1, 1.0), &angle), DMB_OK);
        CHECK_RELATIVE(angle, 1.0, 1e-10);
    } else {
        assert_int_equal(status, DMB_ERR_NO_CONVERGENCE);
    }
    rig_close(&scene);
}

/* In steps: a mass on a spring of 1e12 behind one of 1e-3 swings on the soft one; the stiff one does not ring. */
static void soft_next_to_stiff_in_steps(void **state)
{
    const dmb_pipe_def soft = pipe_of(DMB_PIPE_AXIAL_TORSIONAL, 100.0, 1e6, 1e6, 1e6);
    const dmb_pipe_def stiff = pipe_of(DMB_PIPE_AXIAL_TORSIONAL, 1e12, 1e6, 1e6, 1e6);
    const double none[3] = {0.0, 0.0, 0.0}, force[3] = {1.0, 0.0, 0.0};
    dmb_body_def body = dmb_body_def_default();
    dmb_pipe_def pipes[2] = {soft, stiff};
    rig scene;
    (void)state;
    hold_start(&scene);
    for (int i = 0; i < 2; i++) {
        pipes[i].section_mass = 1e-6;
        pipes[i].section_inertia[0] = pipes[i].section_inertia[1] = 1e-6;
    }
    const dmb_id id = add_pipes(&scene, &pipes[0], 1);
    add_pipes(&scene, &pipes[1], 1);
    body.mass = 1.0;
    body.attach = DMB_ATTACH_END;
    add_body(&scene, &body);
    add_tip_load(&scene, id, 1, force, none);
    rig_start_with(&scene, NULL, NULL);
    double worst = 0.0;
    for (int i = 1; i <= 1000; i++) { /* x = F/k (1 - cos 10 t) */
        scene_step(&scene, 1e-3);
        const double want = 0.01 * (1.0 - cos(10.0 * dmb_sim_time(scene.sim)));
        worst = fmax(worst, fabs(tip_of(&scene, id, 1).displacement[0] - want));
    }
    print_message("swing on the soft part: worst error %.1e m\n", worst);
    CHECK_BELOW(worst, 1e-6); /* (w h)^2 t w/12 of .02 m, second order */
    rig_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roll_up),
        cmocka_unit_test(bending_does_not_see_the_ratio),
        cmocka_unit_test(soft_next_to_stiff),
        cmocka_unit_test(soft_next_to_stiff_torsion),
        cmocka_unit_test(soft_next_to_stiff_in_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
