/* CASES: a string drawn around a bend of 90 degrees at mu .3 needs exp(mu 90 deg) = 1.60197765 of the force at its far
 * end; 1e-4. An axial-torsional string in a horizontal hole without gravity: straight, a quarter of a circle, straight.
 *
 * Each node takes the mean tension of its two neighbours over its length, which is the trapezoidal rule for T' = mu
 * kappa T: with n elements in the bend the error is (mu 90 deg)^3/(12 n^2). */
#include "contact_scene.h"

static const double far_force = 1000.0, mu = 0.3, radius = 20.0, lead = 5.0;

typedef struct capstan {
    rig scene;
    dmb_id string, drive;
} capstan;

/* n elements in the bend and n on either side; the bend begins and ends in the middle of an element. */
static void build(capstan *c, uint32_t n, int32_t friction_law, double speed)
{
    const double length = 0.5 * PI * radius / n, bend = lead + (n + 0.5) * length;
    const double survey[12] = {0.0,      0.5 * PI, 0.0,    bend,     0.5 * PI, 0.0, bend + 0.5 * PI * radius,
                               0.5 * PI, 0.5 * PI, 1000.0, 0.5 * PI, 0.5 * PI};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    wall.survey_count = 4;
    wall.survey = survey;
    wall.friction_law = friction_law;
    wall.mu_static = wall.mu_dynamic = mu;
    wall.smoothing_speed = 1e-6;
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.length = length;
    pipe.damping_time = 5e-3; /* quiets the waves of the start when it moves */
    string.start_depth = lead;
    string.start_free = DMB_FREE_X;
    string.velocity[0] = speed;
    scene_open(&c->scene, 0.0);
    add_wall(&c->scene, &wall);
    c->string = add_string(&c->scene, &string);
    add_pipes(&c->scene, &pipe, 3 * n + 1);
    load.frame = DMB_FRAME_HOLE;
    load.place = dmb_station(c->string, 3 * n, 1.0);
    load.force[0] = far_force;
    add_load(&c->scene, &load);
    drive.time_function = add_constant(&c->scene, speed);
    c->drive = add_drive(&c->scene, &drive);
}

static double rig_force(const capstan *c)
{
    dmb_drive_state state = dmb_drive_state_default();
    assert_int_equal(dmb_query_drive(c->scene.sim, c->drive, &state), DMB_OK);
    return state.force;
}

/* Ratio of the pull at the rig to that at the far end, sliding towards the rig or away from it. */
static double static_ratio(uint32_t n, double slip)
{
    dmb_static_options options = dmb_static_options_default();
    dmb_static_report report = dmb_static_report_default();
    capstan c;
    build(&c, n, DMB_FRICTION_COULOMB, 0.0);
    rig_start_with(&c.scene, NULL, NULL);
    options.slip_axial = slip;
    scene_must(&c.scene, dmb_analysis_static(c.scene.sim, &options, &report));
    const double ratio = -rig_force(&c) / far_force;
    CHECK_BELOW(report.iterations, 12);
    rig_close(&c.scene);
    return ratio;
}

static void drawn_out(void **state)
{
    const double want = exp(0.5 * PI * mu);
    (void)state;
    print_message("100 elements: %.9f, error %.2e\n", static_ratio(100, -1.0), static_ratio(100, -1.0) / want - 1.0);
    CHECK_RELATIVE(want, 1.60197765, 1e-8);
    CHECK_RELATIVE(static_ratio(10, -1.0), want, 1e-4);
    CHECK_RELATIVE(static_ratio(100, -1.0), want, 1e-6);
    /* second order in the element */
    CHECK_RELATIVE(log2((static_ratio(20, -1.0) - want) / (static_ratio(40, -1.0) - want)), 2.0, 0.01);
}

/* Lowered against the pull of the far end, the rig holds less. */
static void let_in(void **state)
{
    (void)state;
    CHECK_RELATIVE(static_ratio(100, 1.0), exp(-0.5 * PI * mu), 1e-6);
}

/* Turning fast while it is drawn slowly, friction acts around the pipe and leaves the pull as it is. */
static void rotation_frees(void **state)
{
    dmb_static_options options = dmb_static_options_default();
    capstan c;
    (void)state;
    build(&c, 50, DMB_FRICTION_COULOMB, 0.0);
    rig_start_with(&c.scene, NULL, NULL);
    options.slip_axial = -0.05;
    options.slip_rotation = 200.0 * 2.0 * PI / 60.0;
    scene_must(&c.scene, dmb_analysis_static(c.scene.sim, &options, NULL));
    /* axial share of friction .05/|(.05, omega R)|, R = 36.5 mm: .06526669 (CASES) */
    CHECK_RELATIVE(-rig_force(&c) / far_force, exp(0.5 * PI * mu * 0.06526669), 1e-6);
    rig_close(&c.scene);
}

/* Moving: the drive pulls at 1 cm/s from the static state on; the bend takes the same share with every law. The ends of
 * the bend are in the middle of elements, so a draw of a tenth of an element changes nothing. */
static void while_moving(void **state)
{
    static const int32_t laws[] = {DMB_FRICTION_COULOMB, DMB_FRICTION_BRISTLE};
    (void)state;
    for (int i = 0; i < 2; i++) {
        dmb_static_options options = dmb_static_options_default();
        dmb_sim_options fine = dmb_sim_options_default();
        double sum = 0.0;
        capstan c;
        build(&c, 40, laws[i], -0.01);
        fine.spectral_radius = 0.5;
        rig_start_with(&c.scene, NULL, &fine);
        options.slip_axial = -0.01;
        scene_must(&c.scene, dmb_analysis_static(c.scene.sim, &options, NULL));
        for (int k = 0; k < 4000; k++) {
            scene_step(&c.scene, 1e-3);
            if (k >= 3000) sum += -rig_force(&c) / far_force / 1000.0;
        }
        print_message("law %d: moving ratio %.9f\n", laws[i], sum);
        CHECK_RELATIVE(sum, exp(0.5 * PI * mu), 1e-4);
        rig_close(&c.scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drawn_out),
        cmocka_unit_test(let_in),
        cmocka_unit_test(rotation_frees),
        cmocka_unit_test(while_moving),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
