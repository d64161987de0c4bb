/* Torque and drag of the soft string against closed forms (inclined, building, capstan, torque, lock-up), against the
 * axial-torsional statics of the library in a hole that turns in three dimensions, and against the stiff string.
 * Equations: eq:drilling.soft-string, eq:drilling.wall-force, eq:drilling.lock-up, eq:drilling.transmission. Equations:
 * eq:drilling.helix-force. */
#include <string.h>

#include "drill_string.h"

static scene describe(uint32_t pipes, const double *survey, uint32_t stations)
{
    scene s = string_of(pipes);
    s.wall.survey = survey;
    s.wall.survey_count = stations;
    s.wall.friction_law = DMB_FRICTION_COULOMB;
    s.wall.smoothing_speed = 1e-9;
    s.wall.mu_dynamic = 0.3;
    return s;
}

static void compile(scene *s)
{
    add_string(s, 1);
    finish_scene(s);
}

static dmb_operation usual(int32_t kind)
{
    dmb_operation operation = dmb_operation_default();
    must(dmb_operation_usual(kind, &operation), dmb_operation_name(kind));
    return operation;
}

static dmb_torque_drag_row row_with(const scene *s, const dmb_torque_drag_options *options,
                                    const dmb_operation *operation)
{
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    must(dmb_analysis_torque_drag(s->sim, options, operation, 1, &row), dmb_sim_message(s->sim));
    return row;
}

static dmb_torque_drag_row row_of(const scene *s, int32_t kind)
{
    const dmb_operation operation = usual(kind);
    return row_with(s, NULL, &operation);
}

static double EI(const scene *s)
{
    return s->pipe.young_modulus * second_moment(s);
}

/* A straight hole inclined by i: hook load w L (cos i +- mu sin i), torque mu w L sin i R. */
static void inclined(void **state)
{
    const double i = 1.1, L = 300.0;
    scene s = describe(300, NULL, 0);
    (void)state;
    s.wall.direction[0] = sin(i);
    s.wall.direction[2] = -cos(i);
    s.environment.fluid_density = 1100.0;
    compile(&s);
    const double W = weight(&s) * L;
    check_relative("pick-up", row_of(&s, DMB_OPERATION_PICK_UP).hook_load, W * (cos(i) + 0.3 * sin(i)), 1e-12);
    check_relative("slack-off", row_of(&s, DMB_OPERATION_SLACK_OFF).hook_load, W * (cos(i) - 0.3 * sin(i)), 1e-12);
    check_relative("rotate", row_of(&s, DMB_OPERATION_ROTATE).hook_load, W * cos(i), 1e-12);
    check_relative("torque", row_of(&s, DMB_OPERATION_ROTATE).torque, 0.3 * W * sin(i) * 0.0365, 1e-12);
    check_relative("wall", row_of(&s, DMB_OPERATION_ROTATE).wall_force, W * sin(i), 1e-12);
    const dmb_operation ream = usual(DMB_OPERATION_BACK_REAM);
    const double v_c = ream.rotary_speed * 0.0365, v = hypot(v_c, 0.1);
    check_relative("back-ream", row_of(&s, DMB_OPERATION_BACK_REAM).hook_load, W * (cos(i) + 0.3 * sin(i) * 0.1 / v),
                   1e-12);
    check_relative("its torque", row_of(&s, DMB_OPERATION_BACK_REAM).torque, 0.3 * W * sin(i) * 0.0365 * v_c / v,
                   1e-12);
    check_relative("stretch", row_of(&s, DMB_OPERATION_ROTATE).stretch,
                   W * cos(i) * L / 2.0 / (2.1e11 * PI / 4.0 * (0.073 * 0.073 - 0.061 * 0.061)), 1e-12);
    destroy(&s);
}

/* Tool joints are rigid, also in the soft string: a string that hangs stretches as in the statics, whose elements are
 * the pipes without them, and torque at the bit winds up the same lengths (eq:drilling.stretch). The soft string
 * spreads their weight over the pipe: 0.16 / pipes. */
static void tool_joints_are_rigid(void **state)
{
    const dmb_output stretch = {.quantity = DMB_OUTPUT_STRETCH};
    (void)state;
    for (int i = 0; i < 2; i++) {
        scene s = describe(100, NULL, 0);
        dmb_operation turn = usual(DMB_OPERATION_ROTATE);
        double found = 0.0;
        s.pipe.kind = i == 0 ? DMB_PIPE_FLEXIBLE : DMB_PIPE_AXIAL_TORSIONAL;
        s.pipe.length = 3.0;
        s.pipe.joint_length = 0.3;
        s.pipe.joint_outer_diameter = 0.08;
        s.wall.direction[0] = 0.0;
        s.wall.direction[2] = -1.0;
        compile(&s);
        turn.torque_on_bit = 2e3;
        must(dmb_analysis_static(s.sim, NULL, NULL), dmb_sim_message(s.sim));
        must(dmb_query_output(s.sim, &stretch, &found), dmb_sim_message(s.sim));
        const dmb_torque_drag_row row = row_with(&s, NULL, &turn);
        check_relative("stretch", row.stretch, found, 2e-3);
        check_relative("wind-up", row.wind_up, 2e3 * 0.9 * 300.0 / (2.1e11 / 2.6 * 2.0 * second_moment(&s)), 1e-9);
        destroy(&s);
    }
}

/* Tool joints touch the wall, on axial-torsional nodes of every mesh: the torque of a string that turns in a horizontal
 * hole is mu W R_p with their radius, as of the soft string; thinner ones leave it to the pipe. */
static void tool_joints_rub(void **state)
{
    const dmb_output torque = {.quantity = DMB_OUTPUT_RIG_TORQUE};
    dmb_static_options turning = dmb_static_options_default();
    (void)state;
    turning.slip_rotation = 1.0;
    for (uint32_t elements = 1; elements <= 4; elements += 3)
        for (int thin = 0; thin < 2; thin++) {
            scene s = describe(20, NULL, 0);
            double found = 0.0;
            s.pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
            s.pipe.elements = elements;
            s.pipe.length = 3.0;
            s.pipe.joint_length = 0.3;
            s.pipe.joint_outer_diameter = thin ? 0.07 : 0.09;
            s.pipe.joint_mass = 12.0;
            s.wall.direction[0] = 1.0;
            s.wall.direction[2] = 0.0;
            compile(&s);
            const double W = weight(&s) * 54.0 + 20.0 * 12.0 * 9.81;
            must(dmb_analysis_static(s.sim, &turning, NULL), dmb_sim_message(s.sim));
            must(dmb_query_output(s.sim, &torque, &found), dmb_sim_message(s.sim));
            check_relative("torque", found, 0.3 * W * (thin ? 0.0365 : 0.045), 1e-6);
            check_relative("soft string", row_of(&s, DMB_OPERATION_ROTATE).torque, found, 1e-6);
            destroy(&s);
        }
}

/* Pulled through a hole that builds on an arc of radius R, N/R > w sin i all along:
 *     dN/di = -mu N - w R cos i + mu w R sin i,   N = A exp(-mu i) + a sin i + b cos i,
 * a = w R (mu^2 - 1)/(1 + mu^2), b = -2 mu w R/(1 + mu^2); `load` hangs at the far end. */
static void pulled_through_an_arc(void **state)
{
    static const double survey[6] = {0.0, 0.2, 0.3, 200.0, 1.5, 0.3};
    const double mu = 0.3, R = 200.0 / 1.3, load = 60000.0;
    scene s = describe(200, survey, 2);
    dmb_operation up = usual(DMB_OPERATION_PICK_UP);
    (void)state;
    compile(&s);
    up.weight_on_bit = -load;
    const double a = weight(&s) * R * (mu * mu - 1.0) / (1.0 + mu * mu),
                 b = -2.0 * mu * weight(&s) * R / (1.0 + mu * mu);
    const double A = (load - a * sin(1.5) - b * cos(1.5)) * exp(mu * 1.5);
    const dmb_torque_drag_row row = row_with(&s, NULL, &up);
    check_relative("hook load", row.hook_load, A * exp(-mu * 0.2) + a * sin(0.2) + b * cos(0.2), 1e-9);
    check_relative("transfer", row.transfer, exp(-mu * 1.3), 1e-9);
    destroy(&s);
}

/* Without weight: exp(mu angle) along a hole that turns in space, and torque mu R N angle while turning. */
static void capstan(void **state)
{
    static const double survey[15] = {0.0, 0.3, 0.0, 50.0, 0.8, 0.6, 90.0, 1.2, 0.1, 140.0, 1.0, 1.0, 150.0, 1.4, 1.0};
    scene s = describe(150, survey, 5);
    dmb_operation up = usual(DMB_OPERATION_PICK_UP), turn = usual(DMB_OPERATION_ROTATE);
    double angle = 0.0;
    (void)state;
    s.environment.gravity[2] = 0.0;
    compile(&s);
    for (int k = 0; k < 4; k++) {
        const double *p = survey + 3 * k, *q = p + 3;
        angle += acos(cos(p[1]) * cos(q[1]) + sin(p[1]) * sin(q[1]) * cos(q[2] - p[2]));
    }
    up.weight_on_bit = turn.weight_on_bit = -5000.0;
    check_relative("pull", row_with(&s, NULL, &up).hook_load, 5000.0 * exp(0.3 * angle), 1e-9);
    check_relative("torque", row_with(&s, NULL, &turn).torque, 0.3 * 0.0365 * 5000.0 * angle, 1e-9);
    destroy(&s);
}

/* The bend alone, on pipes with rigid tool joints: the pipe between them turns by the angle of the whole
 * (eq:drilling.bending). */
static void yield_share_between_tool_joints(void **state)
{
    static const double survey[6] = {0.0, 0.0, 0.0, 30.0, 0.3, 0.0};
    scene s = describe(10, survey, 2);
    (void)state;
    s.pipe.length = 3.0;
    s.pipe.joint_length = 0.3;
    s.pipe.yield_strength = 724e6;
    s.environment.gravity[2] = 0.0;
    compile(&s);
    check_relative("yield share", row_of(&s, DMB_OPERATION_ROTATE).yield_share, 2.1e11 * 0.0365 / 100.0 / 0.9 / 724e6,
                   1e-9);
    destroy(&s);
}

/* The largest stress is at the ends of pieces of equal curvature and pipe, on either side of a jump: without weight and
 * friction N is constant, a vertical piece has N/A, the bend N/A and E r/R. With weight, pushed from above, compression
 * is largest where the bend begins that ends at a straight piece below. */
static void yield_share_at_jumps(void **state)
{
    static const double survey[12] = {0.0, 0.0, 0.0, 31.0, 0.0, 0.0, 61.0, 0.3, 0.0, 150.0, 0.3, 0.0};
    const double yield = 724e6, load = 60000.0;
    scene s = describe(150, survey, 4);
    dmb_operation slide = usual(DMB_OPERATION_SLIDE);
    (void)state;
    s.pipe.yield_strength = yield;
    s.wall.mu_dynamic = s.wall.mu_static = 0.0;
    compile(&s);
    slide.weight_on_bit = load;
    const dmb_torque_drag_row row = row_with(&s, NULL, &slide);
    const double w = weight(&s), A = PI / 4.0 * (0.073 * 0.073 - 0.061 * 0.061), R = 100.0;
    const double N = load - w * 89.0 * cos(0.3); /* compression where the bend ends at 61 m: the largest in the bend */
    check_relative("yield share", row.yield_share, (N / A + s.pipe.young_modulus * 0.0365 / R) / yield, 1e-6);
    check_close("where", row.yield_at, 61.0, 1e-6);
    destroy(&s);
}

/* Against the library's own axial-torsional statics with the same slip, in a hole that builds and turns: the soft
 * string in another discretisation, of second order in the length of its elements. */
static void against_statics(void **state)
{
    static const double survey[12] = {0.0, 0.9, 0.0, 80.0, 1.2, 0.5, 160.0, 1.5, 0.4, 240.0, 1.7, 1.2};
    (void)state;
    for (int kind = 0; kind < (DMB_OPERATION_BACK_REAM + 1); kind++) {
        const dmb_operation operation = usual(kind);
        const dmb_operation *op = &operation;
        double reaction[6];
        dmb_static_options options = dmb_static_options_default();
        scene s = describe(240, survey, 4);
        s.pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
        compile(&s);
        options.slip_axial = op->axial_speed;
        options.slip_rotation = op->rotary_speed;
        must(dmb_analysis_static(s.sim, &options, NULL), dmb_sim_message(s.sim));
        must(dmb_query_reaction(s.sim, s.pipe.string, reaction), "reaction");
        const dmb_torque_drag_row row = row_with(&s, NULL, op);
        tell(dmb_operation_name(kind), row.hook_load);
        check_close("hook load", row.hook_load, -reaction[DMB_X], 2e-4 * weight(&s) * 240.0);
        check_close("torque", row.torque, fabs(reaction[DMB_RX]), 2e-4 * 0.0365 * 0.3 * weight(&s) * 240.0);
        destroy(&s);
    }
}

/* Stiff string of the same scene: bending hardly matters in the wide arc, and does in the narrow
 * one, where the support at the rig end and stiff ends carry a part of what the soft string lays on the wall. */
static double stiff_over_soft(double turn)
{
    const double survey[6] = {0.0, 1.2, 0.0, 100.0, 1.2 + turn, 0.0};
    const dmb_operation up = usual(DMB_OPERATION_PICK_UP);
    dmb_static_options options = dmb_static_options_default();
    scene s = describe(100, survey, 2);
    double reaction[6];
    s.string.offset[1] = -0.0105;
    s.pipe.elements = 2;
    compile(&s);
    options.slip_axial = up.axial_speed;
    must(dmb_analysis_static(s.sim, &options, NULL), dmb_sim_message(s.sim));
    must(dmb_query_reaction(s.sim, s.pipe.string, reaction), "reaction");
    const double ratio = -reaction[DMB_X] / row_with(&s, NULL, &up).hook_load;
    destroy(&s);
    return ratio;
}

static void against_the_stiff_string(void **state)
{
    (void)state;
    const double wide = stiff_over_soft(0.1), narrow = stiff_over_soft(1.2);
    tell("stiff over soft, 1 mrad/m", wide);
    tell("stiff over soft, 12 mrad/m", narrow);
    check_below("wide: no difference", fabs(wide - 1.0), 0.01);
    assert_true(fabs(narrow - 1.0) > 5.0 * fabs(wide - 1.0));
}

/* A horizontal string pushed beyond its helical load: dF/dx = mu (w + F^2/k), k = 4 EI/r, so that
 * F = c tan(atan(F0/c) + mu x c/k), c = sqrt(w k); it locks up where the tangent has its pole. */
static void lock_up(void **state)
{
    const double F0 = 200000.0, mu = 0.3;
    scene s = describe(1000, NULL, 0);
    dmb_operation push = usual(DMB_OPERATION_SLIDE);
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    (void)state;
    compile(&s);
    push.weight_on_bit = F0;
    const double k = 4.0 * EI(&s) / 0.0105, c = sqrt(weight(&s) * k);
    const double pole = (0.5 * PI - atan(F0 / c)) * k / (mu * c);
    tell("lock-up length [m]", pole);
    for (int i = 1; i < 10; i++) {
        const double x = 0.1 * i * pole;
        options.depths = &x;
        const dmb_torque_drag_row row = row_with(&s, &options, &push);
        const double F = c * tan(atan(F0 / c) + mu * x * c / k), grow = (1.0 + F * F / c / c) / (1.0 + F0 * F0 / c / c);
        if (F > 0.009 * 2.1e11 * PI / 4.0 * (0.073 * 0.073 - 0.061 * 0.061)) break;
        check_relative("thrust", -row.hook_load, F, 1e-5);
        check_relative("transfer", row.transfer, 1.0 / grow, 1e-5);
        check_relative("helix", row.helix_length, x, 1e-12);
        assert_int_equal(row.locked, 0);
    }
    options.depths = NULL;
    assert_true(pole < 1000.0);
    {
        const dmb_torque_drag_row row = row_with(&s, &options, &push);
        double force[2];
        assert_int_equal(row.locked, 1);
        assert_true(isnan(row.hook_load) && isnan(row.wall_force) && row.transfer == 0.0);
        assert_int_equal(dmb_analysis_torque_drag_profile(s.sim, NULL, &push, 2, NULL, force, NULL, NULL),
                         DMB_ERR_NO_CONVERGENCE);
    }
    options.post_buckling = 0;
    check_relative("without a helix", -row_with(&s, &options, &push).hook_load, F0 + mu * weight(&s) * 1000.0, 1e-12);
    destroy(&s);
}

static const double well[15] = {0.0, 0.1, 0.0, 100.0, 0.1, 0.0, 250.0, 1.3, 0.3, 300.0, 1.5, 0.3, 400.0, 1.5, 0.2};

/* transfer against a difference of two runs; the profile ends where the row says; weights at the end count. */
static void consistent(void **state)
{
    scene s = describe(400, well, 5);
    double force[41], torque[41], depth[41], wall[41];
    (void)state;
    compile(&s);
    for (int kind = 0; kind < (DMB_OPERATION_BACK_REAM + 1); kind++) {
        dmb_operation operation = usual(kind), more;
        operation.weight_on_bit = 3000.0;
        operation.torque_on_bit = 200.0;
        more = operation;
        more.weight_on_bit += 1.0;
        const dmb_torque_drag_row row = row_with(&s, NULL, &operation), next = row_with(&s, NULL, &more);
        check_close("transfer", row.transfer, 1.0 / (row.hook_load - next.hook_load), 1e-4);
        must(dmb_analysis_torque_drag_profile(s.sim, NULL, &operation, 41, depth, force, torque, wall), "profile");
        for (int i = 0; i < 41; i++) {
            check_close("stations", depth[i], 10.0 * i, 1e-9);
            assert_true(row.lowest_force <= force[i] + 1e-4 * weight(&s) * 400.0);
        }
        check_close("rig end", force[0], row.hook_load, 1e-5 * fabs(row.hook_load));
        check_close("bit", force[40], -3000.0, 1e-9);
        check_close("torque at the bit", torque[40], 200.0, 1e-9);
        check_close("torque", torque[0], row.torque, 1e-5 * row.torque);
        tell("wall at the rig", wall[0]);
    }
    destroy(&s);
}

static void friction_is_found_again(void **state)
{
    scene s = describe(400, well, 5);
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    (void)state;
    compile(&s);
    for (int kind = 0; kind < (DMB_OPERATION_BACK_REAM + 1); kind++) {
        const dmb_operation operation = usual(kind);
        const int pushed = operation.axial_speed > 0.0 && operation.rotary_speed == 0.0;
        double found = -1.0;
        options.friction = 0.237;
        const dmb_torque_drag_row row = row_with(&s, &options, &operation);
        if (operation.axial_speed != 0.0) {
            must(dmb_analysis_friction_factor(s.sim, NULL, &operation, DMB_MEASURED_HOOK_LOAD, row.hook_load, &found),
                 dmb_sim_message(s.sim));
            check_close("by the hook load", found, 0.237, 1e-9);
        }
        if (operation.rotary_speed > 0.0) {
            must(dmb_analysis_friction_factor(s.sim, NULL, &operation, DMB_MEASURED_TORQUE, row.torque, &found),
                 dmb_sim_message(s.sim));
            check_close("by the torque", found, 0.237, 1e-9);
        }
        found = 7.0;
        assert_int_equal(dmb_analysis_friction_factor(s.sim, NULL, &operation, DMB_MEASURED_HOOK_LOAD, -1e9, &found),
                         pushed ? DMB_OK : DMB_ERR_VALUE);
        if (!pushed) assert_true(found == 7.0);
    }
    destroy(&s);
}

/* Shallower than described: the pipes at the rig end are not there yet, those at the far end are. */
static void shallow(void **state)
{
    scene s = describe(100, NULL, 0);
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    const dmb_operation still = dmb_operation_default();
    dmb_pipe_def collar;
    const double depths[3] = {5.0, 40.0, 120.0};
    dmb_torque_drag_row rows[3] = {dmb_torque_drag_row_default()};
    (void)state;
    s.wall.direction[0] = 0.0;
    s.wall.direction[2] = -1.0;
    must(dmb_model_create(NULL, &s.model), "create");
    must(dmb_model_add_wall(s.model, &s.wall, NULL), "wall");
    must(dmb_model_add_pipes(s.model, &s.pipe, s.pipes, NULL), "pipes");
    collar = s.pipe;
    collar.outer_diameter = 0.09;
    must(dmb_model_add_pipes(s.model, &collar, 20, NULL), "collars");
    dmb_bit_def bit = dmb_bit_def_default();
    must(dmb_model_add_bit(s.model, &bit, NULL), "bit");
    must(dmb_model_compile(s.model, NULL), dmb_model_message(s.model));
    must(dmb_sim_create(s.model, NULL, &s.sim), "sim");
    options.depths = depths;
    options.depth_count = 3;
    must(dmb_analysis_torque_drag(s.sim, &options, &still, 1, rows), dmb_sim_message(s.sim));
    const double w = weight(&s), wc = 9.81 * 7850.0 * PI / 4.0 * (0.09 * 0.09 - 0.061 * 0.061), bit_weight = 5.0 * 9.81;
    check_relative("collars alone", rows[0].hook_load, 5.0 * wc + bit_weight, 1e-12);
    check_relative("and pipes", rows[1].hook_load, 20.0 * wc + 20.0 * w + bit_weight, 1e-12);
    check_relative("all", rows[2].hook_load, 20.0 * wc + 100.0 * w + bit_weight, 1e-12);
    assert_int_equal(rows[2].struct_size, sizeof rows[0]);
    destroy(&s);
}

/* A body of 50 kg hung on a string by a joint: refused, since its weight would be left out; not at the rig end, where
 * it weighs on the rig, and not by a joint that holds nothing. */
static void joints_below_the_rig_end_are_refused(void **state)
{
    static const struct {
        uint32_t pipe;
        double fraction;
        int32_t kind, status;
    } cases[] = {{9, 1.0, DMB_JOINT_SPHERICAL, DMB_ERR_UNSUPPORTED},
                 {4, 1.0, DMB_JOINT_FIXED, DMB_ERR_UNSUPPORTED},
                 {0, 1.0, DMB_JOINT_REVOLUTE, DMB_ERR_UNSUPPORTED},
                 {0, 0.0, DMB_JOINT_SPHERICAL, DMB_OK},
                 {9, 1.0, DMB_JOINT_FREE, DMB_OK}};
    const dmb_operation up = usual(DMB_OPERATION_PICK_UP);
    (void)state;
    for (uint32_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        scene s = describe(10, NULL, 0);
        dmb_body_def body = dmb_body_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        dmb_torque_drag_row row = dmb_torque_drag_row_default();
        dmb_id hung;
        row.hook_load = -7.0;
        add_string(&s, 1);
        body.mass = 50.0;
        body.position[0] = cases[i].pipe + cases[i].fraction;
        must(dmb_model_add_body(s.model, &body, &hung), dmb_model_message(s.model));
        joint.kind = cases[i].kind;
        joint.match = 1;
        joint.place_a = dmb_station(s.pipe.string, cases[i].pipe, cases[i].fraction);
        joint.place_b = dmb_station(hung, 0, 0.0);
        must(dmb_model_add_joint(s.model, &joint, NULL), dmb_model_message(s.model));
        finish_scene(&s);
        assert_int_equal(dmb_analysis_torque_drag(s.sim, NULL, &up, 1, &row), cases[i].status);
        assert_true((row.hook_load == -7.0) == (cases[i].status < 0));
        if (cases[i].status < 0) assert_non_null(strstr(dmb_sim_message(s.sim), "joint"));
        destroy(&s);
    }
}

/* A load, a spring, a stuck place: refused on the string, not at its rig end, nor one that is described free. */
static void forces_below_the_rig_end_are_refused(void **state)
{
    enum { LOAD, SPRING, STUCK };
    static const struct {
        uint32_t pipe;
        double fraction;
        int32_t kind, stuck, status;
    } cases[] = {{4, 0.5, LOAD, 0, DMB_ERR_UNSUPPORTED},
                 {9, 1.0, LOAD, 0, DMB_ERR_UNSUPPORTED},
                 {0, 0.0, LOAD, 0, DMB_OK},
                 {4, 0.5, SPRING, 0, DMB_ERR_UNSUPPORTED},
                 {0, 0.0, SPRING, 0, DMB_OK},
                 {9, 1.0, STUCK, 1, DMB_ERR_UNSUPPORTED},
                 {4, 1.0, STUCK, 1, DMB_ERR_UNSUPPORTED},
                 {9, 1.0, STUCK, 0, DMB_OK}};
    const dmb_operation up = usual(DMB_OPERATION_PICK_UP);
    (void)state;
    for (uint32_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        scene s = describe(10, NULL, 0);
        dmb_torque_drag_row row = dmb_torque_drag_row_default();
        dmb_load_def load = dmb_load_def_default();
        dmb_spring_def spring = dmb_spring_def_default();
        dmb_stuck_def stuck = dmb_stuck_def_default();
        row.hook_load = -7.0;
        add_string(&s, 1);
        load.place = spring.place_b = stuck.place = dmb_station(s.pipe.string, cases[i].pipe, cases[i].fraction);
        load.force[2] = -500.0;
        spring.stiffness = 1e3;
        spring.offset_a[1] = 5.0; /* of the ground */
        stuck.stuck = cases[i].stuck;
        if (cases[i].kind == LOAD) must(dmb_model_add_load(s.model, &load, NULL), dmb_model_message(s.model));
        if (cases[i].kind == SPRING) must(dmb_model_add_spring(s.model, &spring, NULL), dmb_model_message(s.model));
        if (cases[i].kind == STUCK) must(dmb_model_add_stuck(s.model, &stuck, NULL), dmb_model_message(s.model));
        finish_scene(&s);
        assert_int_equal(dmb_analysis_torque_drag(s.sim, NULL, &up, 1, &row), cases[i].status);
        assert_true((row.hook_load == -7.0) == (cases[i].status < 0));
        if (cases[i].status < 0) assert_non_null(strstr(dmb_sim_message(s.sim), "below its rig end"));
        destroy(&s);
    }
}

static void refused(void **state)
{
    scene s = describe(10, NULL, 0);
    dmb_operation good = usual(DMB_OPERATION_PICK_UP), bad;
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    dmb_torque_drag_row row = dmb_torque_drag_row_default();
    double depth, found = 7.0;
    (void)state;
    compile(&s);
    row.hook_load = -7.0;
    options.depths = &depth;
    for (int k = 0; k < 5; k++) {
        depth = (const double[5]){0.0, -1.0, 10.1, (double)NAN, (double)INFINITY}[k];
        assert_int_equal(dmb_analysis_torque_drag(s.sim, &options, &good, 1, &row),
                         k < 3 ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE);
        assert_non_null(strstr(dmb_sim_message(s.sim), "depth"));
    }
    depth = 5.0;
#define REFUSED(target, field, value, status)                                               \
    do {                                                                                    \
        dmb_torque_drag_options kept = options;                                             \
        bad = good;                                                                         \
        target.field = value;                                                               \
        assert_int_equal(dmb_analysis_torque_drag(s.sim, &options, &bad, 1, &row), status); \
        assert_true(dmb_sim_message(s.sim)[0] != 0 && row.hook_load == -7.0);               \
        options = kept;                                                                     \
    } while (0)
    REFUSED(options, friction, -0.5, DMB_ERR_VALUE);
    REFUSED(options, friction, 11.0, DMB_ERR_VALUE);
    REFUSED(options, friction, (double)NAN, DMB_ERR_NOT_FINITE);
    REFUSED(options, post_buckling, 2, DMB_ERR_VALUE);
    REFUSED(options, depth_count, 0, DMB_ERR_VALUE);
    REFUSED(options, string.generation, 99, DMB_ERR_ID);
    REFUSED(bad, axial_speed, (double)NAN, DMB_ERR_NOT_FINITE);
    REFUSED(bad, rotary_speed, (double)INFINITY, DMB_ERR_NOT_FINITE);
    REFUSED(bad, weight_on_bit, (double)NAN, DMB_ERR_NOT_FINITE);
    REFUSED(bad, torque_on_bit, -1.0, DMB_ERR_VALUE);
    REFUSED(bad, struct_size, 7, DMB_ERR_STRUCT_SIZE);
    row.struct_size = 8;
    REFUSED(bad, reserved, 0, DMB_ERR_STRUCT_SIZE);
    row.struct_size = sizeof row;
    assert_int_equal(dmb_analysis_torque_drag(s.sim, NULL, &good, 0, &row), DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_torque_drag(s.sim, NULL, NULL, 1, &row), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_torque_drag(NULL, NULL, &good, 1, &row), DMB_ERR_NULL);
    assert_int_equal(dmb_analysis_torque_drag_profile(s.sim, NULL, &good, 1, NULL, NULL, NULL, NULL), DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_friction_factor(s.sim, NULL, &good, 2, 0.0, &found), DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_friction_factor(s.sim, NULL, &good, 0, (double)NAN, &found), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_operation_usual((DMB_OPERATION_BACK_REAM + 1), &good), DMB_ERR_VALUE);
    assert_int_equal(dmb_operation_usual(0, NULL), DMB_ERR_NULL);
    assert_null(dmb_operation_name(-1));
    assert_true(found == 7.0);
    destroy(&s);
}

/* A tool of 100 kg at the far end of a string that hangs in mud: the hook holds its weight less that of the mud which
 * it displaces, E A growing with neither; of a bit too. Rings and pipes of another string count for nothing. */
static void tools_at_the_far_end(void **state)
{
    static const double down[2][3] = {{0.0, 0.0, 0.0}, {300.0, 0.0, 0.0}};
    const double density = 1200.0, mass[2] = {100.0, 40.0}, volume[2] = {0.01, 0.004};
    double hook[3];
    (void)state;
    for (int k = 0; k < 3; k++) { /* bare, with a tool, with tool, bit and another string */
        scene s = describe(10, down[0], 2);
        dmb_body_def tool = dmb_body_def_default();
        dmb_bit_def bit = dmb_bit_def_default();
        dmb_stabiliser_def ring = dmb_stabiliser_def_default();
        dmb_string_def other = dmb_string_def_default();
        dmb_pipe_def pipe = dmb_pipe_def_default();
        s.environment.fluid_density = density;
        add_string(&s, 1);
        tool.attach = DMB_ATTACH_END;
        bit.string = tool.string = s.pipe.string;
        tool.mass = mass[0];
        tool.displaced_volume = volume[0];
        bit.mass = mass[1];
        bit.displaced_volume = volume[1];
        bit.diameter = 0.0;
        other.start_depth = 50.0;
        if (k > 0) must(dmb_model_add_body(s.model, &tool, NULL), dmb_model_message(s.model));
        if (k > 1) {
            must(dmb_model_add_bit(s.model, &bit, NULL), dmb_model_message(s.model));
            must(dmb_model_add_string(s.model, &other, &pipe.string), dmb_model_message(s.model));
            must(dmb_model_add_pipes(s.model, &pipe, 3, NULL), dmb_model_message(s.model));
            ring.string = pipe.string;
            must(dmb_model_add_stabiliser(s.model, &ring, NULL), dmb_model_message(s.model));
        }
        finish_scene(&s);
        hook[k] = row_of(&s, DMB_OPERATION_PICK_UP).hook_load;
        destroy(&s);
    }
    for (int k = 0; k < 2; k++)
        check_relative("weight of a tool in mud", hook[k + 1] - hook[k], 9.81 * (mass[k] - density * volume[k]), 1e-10);
}

static int32_t no_force(void *context, double time, uint32_t count, const double (*poses)[12],
                        const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                        const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)poses, (void)velocities, (void)forces, (void)tangent, (void)potential;
    return 0;
}

/* The string may be either side of a joint or spring, and any place of a force. */
static void from_either_side(void **state)
{
    const dmb_operation up = usual(DMB_OPERATION_PICK_UP);
    (void)state;
    for (int k = 0; k < 6; k++) {
        scene s = describe(10, NULL, 0);
        dmb_body_def body = dmb_body_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        dmb_spring_def spring = dmb_spring_def_default();
        dmb_force_def force = dmb_force_def_default();
        dmb_torque_drag_row row = dmb_torque_drag_row_default();
        dmb_id beside;
        add_string(&s, 1);
        must(dmb_model_add_body(s.model, &body, &beside), dmb_model_message(s.model));
        const dmb_place there = dmb_station(beside, 0, 0.0), below = dmb_station(s.pipe.string, 5, 1.0);
        const dmb_place rig_end = dmb_station(s.pipe.string, 0, 0.0);
        joint.kind = DMB_JOINT_SPHERICAL;
        joint.match = 1;
        joint.place_a = there;
        joint.place_b = k == 0 ? below : rig_end;
        if (k < 2) must(dmb_model_add_joint(s.model, &joint, NULL), dmb_model_message(s.model));
        spring.place_a = k == 2 ? below : rig_end;
        spring.place_b = there;
        spring.stiffness = 10.0;
        spring.offset_b[1] = 0.5;
        if (k == 2 || k == 3) must(dmb_model_add_spring(s.model, &spring, NULL), dmb_model_message(s.model));
        force.place_count = 2;
        force.place[0] = there;
        force.place[1] = k == 4 ? below : rig_end;
        force.callback = no_force;
        if (k >= 4) must(dmb_model_add_force(s.model, &force, NULL), dmb_model_message(s.model));
        finish_scene(&s);
        assert_int_equal(dmb_analysis_torque_drag(s.sim, NULL, &up, 1, &row), k % 2 ? DMB_OK : DMB_ERR_UNSUPPORTED);
        if (k % 2 == 0) assert_non_null(strstr(dmb_sim_message(s.sim), "below its rig end"));
        destroy(&s);
    }
}

/* Each of the three calls takes its options, operations and handle alike. */
static void refused_alike(void **state)
{
    scene s = describe(10, NULL, 0);
    dmb_operation operations[2] = {usual(DMB_OPERATION_PICK_UP), usual(DMB_OPERATION_PICK_UP)};
    dmb_torque_drag_options options = dmb_torque_drag_options_default();
    dmb_torque_drag_row rows[2] = {dmb_torque_drag_row_default(), dmb_torque_drag_row_default()};
    double found = 7.0, depth[2] = {7.0, 7.0};
    (void)state;
    compile(&s);
    dmb_sim *none = (dmb_sim *)(void *)s.model;
    assert_int_equal(dmb_analysis_torque_drag(none, NULL, operations, 1, rows), DMB_ERR_HANDLE);
    assert_int_equal(dmb_analysis_torque_drag_profile(none, NULL, operations, 2, depth, NULL, NULL, NULL),
                     DMB_ERR_HANDLE);
    assert_int_equal(dmb_analysis_friction_factor(none, NULL, operations, 0, 1e3, &found), DMB_ERR_HANDLE);
    options.friction = 11.0;
    assert_int_equal(dmb_analysis_torque_drag_profile(s.sim, &options, operations, 2, depth, NULL, NULL, NULL),
                     DMB_ERR_VALUE);
    assert_int_equal(dmb_analysis_friction_factor(s.sim, &options, operations, 0, 1e3, &found), DMB_ERR_VALUE);
    operations[1].struct_size -= 8;
    assert_int_equal(dmb_analysis_torque_drag(s.sim, NULL, operations, 2, rows), DMB_ERR_STRUCT_SIZE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "not that of the first"));
    operations[0].weight_on_bit = (double)NAN;
    assert_int_equal(dmb_analysis_torque_drag_profile(s.sim, NULL, operations, 2, depth, NULL, NULL, NULL),
                     DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_analysis_friction_factor(s.sim, NULL, operations, 0, 1e3, &found), DMB_ERR_NOT_FINITE);
    assert_true(found == 7.0 && depth[0] == 7.0 && depth[1] == 7.0);
    destroy(&s);
    s = describe(10, NULL, 0);
    add_string(&s, 0);
    finish_scene(&s);
    operations[0] = usual(DMB_OPERATION_PICK_UP);
    assert_int_equal(dmb_analysis_torque_drag(s.sim, NULL, operations, 1, rows), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(s.sim), "the model has no hole; add a wall"));
    destroy(&s);
    s = describe(10, NULL, 0);
    s.string.follows_hole = 0;
    compile(&s);
    assert_int_equal(dmb_analysis_torque_drag(s.sim, NULL, operations, 1, rows), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(s.sim), "the string does not follow the hole"));
    destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inclined),
        cmocka_unit_test(tool_joints_are_rigid),
        cmocka_unit_test(tool_joints_rub),
        cmocka_unit_test(pulled_through_an_arc),
        cmocka_unit_test(capstan),
        cmocka_unit_test(yield_share_between_tool_joints),
        cmocka_unit_test(yield_share_at_jumps),
        cmocka_unit_test(against_statics),
        cmocka_unit_test(lock_up),
        cmocka_unit_test(against_the_stiff_string),
        cmocka_unit_test(consistent),
        cmocka_unit_test(friction_is_found_again),
        cmocka_unit_test(shallow),
        cmocka_unit_test(tools_at_the_far_end),
        cmocka_unit_test(from_either_side),
        cmocka_unit_test(refused_alike),
        cmocka_unit_test(refused),
        cmocka_unit_test(joints_below_the_rig_end_are_refused),
        cmocka_unit_test(forces_below_the_rig_end_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
