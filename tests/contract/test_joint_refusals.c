/* Mechanisms that cannot be: put together wrongly, driven beyond their reach, described by a callback that is wrong or
 * fails. Each is refused with a status and a message that names the part, leaves the last accepted state whole to the
 * bit, and leaves a sim that goes on. */
#include <stdio.h>
#include <string.h>

#include "mechanism.h"

static const double step = 1e-3;

static void expect_text(const char *said, const char *text)
{
    if (strstr(said, text) == NULL) fail_msg("message without \"%s\": %s", text, said);
}

/* The model must be refused by create: status, and what the message names. */
static void expect_no_start(rig *s, int32_t status, const char *part, const char *text)
{
    const refusal said = refused_start(s);
    print_message("    %s: %s\n", dmb_status_name(said.status), said.text);
    assert_int_equal(said.status, status);
    assert_null(s->sim);
    expect_text(said.text, part);
    expect_text(said.text, text);
    rig_close(s);
}

/* Steps until one is refused; the state is then that before the step. Status of that step. */
static int32_t run_into(const rig *s, uint32_t most)
{
    int32_t status = DMB_OK;
    uint64_t before = 0;
    double time = 0.0;
    for (uint32_t i = 0; i < most && status >= 0; i++) {
        before = rig_hash(s);
        time = dmb_sim_time(s->sim);
        status = dmb_sim_step(s->sim, step, NULL);
    }
    print_message("    %s at %g s: %s\n", dmb_status_name(status), dmb_sim_time(s->sim), dmb_sim_message(s->sim));
    assert_true(status < 0);
    assert_true(rig_hash(s) == before);
    assert_true(dmb_sim_time(s->sim) == time);
    assert_int_equal(dmb_sim_step(s->sim, step, NULL), status); /* the same once more */
    assert_true(rig_hash(s) == before);
    return status;
}

static void expect_stuck(const rig *s, int32_t status)
{
    if (status != DMB_ERR_SINGULAR && status != DMB_ERR_NO_CONVERGENCE)
        fail_msg("%s: %s", dmb_status_name(status), dmb_sim_message(s->sim));
}

/* ---- Put together ------------------------------------------------------------------------------------------------ */

static void bars_too_short(void **state)
{
    (void)state;
    rig s;
    const bar left = {{0.0, 0.0}, {0.0, 1.0}, 1.0}, top = {{0.0, 1.0}, {1.0, 1.0}, 1.0},
              right = {{4.0, 0.0}, {4.0, 1.0}, 1.0};
    rig_open(&s, 0.0, 0.0, -9.81);
    const dmb_id a = add_bar(&s, &left), b = add_bar(&s, &top), c = add_bar(&s, &right);
    (void)add_hinge(&s, "left", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(a, -0.5));
    (void)add_hinge(&s, "corner", DMB_JOINT_REVOLUTE, pin_on(a, 0.5), pin_on(b, -0.5));
    (void)add_hinge(&s, "gap", DMB_JOINT_REVOLUTE, pin_on(b, 0.5), pin_on(c, 0.5));
    (void)add_hinge(&s, "right", DMB_JOINT_REVOLUTE, pin_ground(4.0, 0.0), pin_on(c, -0.5));
    expect_no_start(&s, DMB_ERR_GEOMETRY, "joint ", "cannot be brought together");
}

/* One bar on two hinges that are further apart than it is long: both lie, the message names one of them. */
static void bar_between_two_hinges(void **state)
{
    (void)state;
    rig s;
    const bar only = {{0.0, 0.0}, {1.0, 0.0}, 1.0};
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id body = add_bar(&s, &only);
    (void)add_hinge(&s, "near", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(body, -0.5));
    (void)add_hinge(&s, "far", DMB_JOINT_REVOLUTE, pin_ground(1.001, 0.0), pin_on(body, 0.5));
    expect_no_start(&s, DMB_ERR_GEOMETRY, "joint ", "violation");
}

/* A crank whose angle is given beyond what the other bars allow. */
static void initial_angle_out_of_reach(void **state)
{
    (void)state;
    rig s;
    const bar crank = {{0.0, 0.0}, {0.5, 0.0}, 1.0}, rod = {{0.5, 0.0}, {1.5, 0.0}, 1.0};
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id a = add_bar(&s, &crank), b = add_bar(&s, &rod);
    dmb_joint_def first = hinge_of("crank", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(a, -0.25));
    first.initial_mask = DMB_FREE_RX;
    first.initial_position[DMB_RX] = 3.0; /* the far end of the crank is then 1.99 from the pin of the rod */
    (void)add_joint(&s, &first);
    (void)add_hinge(&s, "pin", DMB_JOINT_REVOLUTE, pin_on(a, 0.25), pin_on(b, -0.5));
    (void)add_hinge(&s, "end", DMB_JOINT_REVOLUTE, pin_ground(1.5, 0.0), pin_on(b, 0.5));
    expect_no_start(&s, DMB_ERR_GEOMETRY, "joint ", "violation");
}

/* Two speeds given for coordinates that hang together. */
static void initial_speeds_that_fight(void **state)
{
    (void)state;
    rig s;
    const bar only = {{0.0, 0.0}, {1.0, 0.0}, 1.0};
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id body = add_bar(&s, &only);
    dmb_joint_def first = hinge_of("first", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(body, -0.5));
    first.initial_mask = DMB_FREE_RX;
    first.initial_speed[DMB_RX] = 1.0;
    (void)add_joint(&s, &first);
    dmb_joint_def second = hinge_of("second", DMB_JOINT_FREE, pin_ground(0.0, 0.0), pin_on(body, -0.5));
    second.initial_mask = DMB_FREE_RX;
    second.initial_speed[DMB_RX] = 2.0;
    (void)add_joint(&s, &second);
    expect_no_start(&s, DMB_ERR_GEOMETRY, "joint ", "speed cannot be had");
}

/* A body that is described up to half a turn off: one that is free turns to where its joint holds it, although Newton's
 * iteration would end where its axes point against each other; one that a support keeps from turning is refused there.
 */
static void described_turned_over(void **state)
{
    (void)state;
    static const int32_t kinds[] = {DMB_JOINT_FIXED, DMB_JOINT_PRISMATIC, DMB_JOINT_REVOLUTE, DMB_JOINT_CYLINDRICAL,
                                    DMB_JOINT_PLANAR};
    static const double degrees[] = {60.0, 120.0, 179.0, 180.0};
    for (int k = 0; k < 5; k++)
        for (int axis = k < 2 ? 0 : 1; axis < 3; axis++)
            for (int far = 0; far < 5; far++) {
                const int supportd = far == 4;
                rig s;
                dmb_body_def body = dmb_body_def_default();
                dmb_joint_def def = dmb_joint_def_default();
                rig_open(&s, 0.0, 0.0, 0.0);
                body.rotation[axis] = degrees[supportd ? 3 : far] * PI / 180.0;
                if (supportd) body.free_mask = DMB_FREE_X | DMB_FREE_Y | DMB_FREE_Z;
                (void)snprintf(def.name, sizeof def.name, "plug");
                def.kind = kinds[k];
                def.place_b = dmb_station(add_body(&s, &body), 0, 0.0);
                const dmb_id joint = add_joint(&s, &def);
                if (supportd) {
                    expect_no_start(&s, DMB_ERR_GEOMETRY, "joint 0 (plug): turned over", "3.14159 rad");
                    continue;
                }
                (void)mechanism_start(&s, NULL);
                check_below("angles that are left",
                            largest(k < 2 ? 3 : 2, joint_at(&s, joint).position + (k < 2 ? 3 : 4)), 1e-13);
                rig_close(&s);
            }
}

/* ---- The caller's constraints ------------------------------------------------------------------------------------ */

/* On the sphere of 1 m about the origin. */
typedef struct sphere {
    double wrong;    /* added to one entry of the Jacobian */
    int32_t returns; /* not 0: fails */
    int32_t not_a_number;
    double from; /* [s] when it goes wrong */
} sphere;

static int32_t on_sphere(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                         double *jacobian)
{
    const sphere *with = context;
    const double *x = poses[0], *R = poses[0] + 3;
    (void)count;
    value[0] = 0.5 * (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] - 1.0);
    if (jacobian != NULL) {
        for (int i = 0; i < 3; i++) jacobian[i] = x[0] * R[i] + x[1] * R[3 + i] + x[2] * R[6 + i];
        for (int i = 3; i < 6; i++) jacobian[i] = 0.0;
        jacobian[4] += with->wrong;
    }
    if (time < with->from) return 0;
    if (with->not_a_number) value[0] = (double)NAN;
    return with->returns;
}

static void open_sphere(rig *s, sphere *with, int32_t provides, dmb_id *body)
{
    dmb_constraint_def def = dmb_constraint_def_default();
    dmb_body_def ball = dmb_body_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    ball.position[0] = 1.0;
    *body = add_body(s, &ball);
    (void)snprintf(def.name, sizeof def.name, "shell");
    def.place[0] = dmb_station(*body, 0, 0.0);
    def.provides = provides;
    def.callback = on_sphere;
    def.callback_context = with;
    must_model(s, dmb_model_add_constraint(s->model, &def, NULL));
}

static void wrong_jacobian(void **state)
{
    (void)state;
    sphere with = {.wrong = 0.01};
    rig s;
    dmb_id body;
    open_sphere(&s, &with, DMB_PROVIDES_JACOBIAN, &body);
    expect_no_start(&s, DMB_ERR_CALLBACK, "constraint 0 (shell)", "jacobian[0][4] = 0.01, must be");
}

/* x = 1 and y = 0 in units of their own, and z z, which has no slope; one entry may be wrong. */
typedef struct rows {
    double unit[2];
    double wrong; /* part of an entry of row 1 */
} rows;

static int32_t three_rows(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                          double *jacobian)
{
    const rows *with = context;
    const double *x = poses[0], *R = poses[0] + 3;
    (void)time, (void)count;
    value[0] = with->unit[0] * (x[0] - 1.0);
    value[1] = with->unit[1] * x[1];
    value[2] = x[2] * x[2];
    for (int i = 0; i < 18; i++) jacobian[i] = 0.0;
    for (int i = 0; i < 3; i++) {
        jacobian[i] = with->unit[0] * R[i];
        jacobian[6 + i] = with->unit[1] * R[3 + i] * (i == 1 ? 1.0 + with->wrong : 1.0);
        jacobian[12 + i] = 2.0 * x[2] * R[6 + i];
    }
    return 0;
}

static void open_rows(rig *s, rows *with)
{
    dmb_constraint_def def = dmb_constraint_def_default();
    dmb_body_def ball = dmb_body_def_default();
    rig_open(s, 0.0, 0.0, 0.0);
    ball.position[0] = 1.0;
    for (int i = 0; i < 3; i++) ball.rotation[i] = 0.3 * (i + 1);
    (void)snprintf(def.name, sizeof def.name, "three");
    def.row_count = 3;
    def.place[0] = dmb_station(add_body(s, &ball), 0, 0.0);
    def.provides = DMB_PROVIDES_JACOBIAN;
    def.callback = three_rows;
    def.callback_context = with;
    must_model(s, dmb_model_add_constraint(s->model, &def, NULL));
}

/* Each row is judged by its own entries, however much larger those of another are. */
static void wrong_jacobian_of_a_small_row(void **state)
{
    (void)state;
    for (int power = -9; power <= 9; power += 3) {
        rows with = {.unit = {1.0, pow(10.0, power)}};
        rig s;
        open_rows(&s, &with);
        (void)mechanism_start(&s, NULL);
        rig_close(&s);
        with.wrong = 1e-3;
        open_rows(&s, &with);
        expect_no_start(&s, DMB_ERR_CALLBACK, "constraint 0 (three)", "jacobian[1][1]");
    }
}

/* One that is not announced is not looked at. */
static void jacobian_that_is_not_announced(void **state)
{
    (void)state;
    sphere with = {.wrong = 0.01};
    rig s;
    dmb_id body;
    open_sphere(&s, &with, 0, &body);
    (void)mechanism_start(&s, NULL);
    take_steps(&s, step, 20);
    rig_close(&s);
}

static void callback_fails_at_create(void **state)
{
    (void)state;
    for (int32_t k = 0; k < 4; k++) {
        sphere with = {.returns = k & 1, .not_a_number = !(k & 1)};
        rig s;
        dmb_id body;
        open_sphere(&s, &with, k < 2 ? DMB_PROVIDES_JACOBIAN : 0, &body);
        expect_no_start(&s, DMB_ERR_CALLBACK, "constraint 0 (shell)", "callback");
    }
}

static void callback_fails_in_a_run(void **state)
{
    (void)state;
    for (int32_t k = 0; k < 4; k++) {
        sphere with = {.from = 0.0505};
        rig s;
        dmb_id body;
        open_sphere(&s, &with, k < 2 ? DMB_PROVIDES_JACOBIAN : 0, &body);
        (void)mechanism_start(&s, NULL);
        with.returns = k & 1;
        with.not_a_number = !(k & 1);
        assert_int_equal(run_into(&s, 100), DMB_ERR_CALLBACK);
        expect_text(dmb_sim_message(s.sim), "constraint");
        const uint64_t before = rig_hash(&s);
        assert_int_equal(dmb_sim_advance(s.sim, 1.0, NULL), DMB_ERR_CALLBACK); /* gets up to where it fails */
        assert_true(dmb_sim_time(s.sim) < 0.0505 && rig_hash(&s) != before);
        with.returns = with.not_a_number = 0;
        take_steps(&s, step, 50);
        const dmb_pose pose = pose_at(&s, dmb_station(body, 0, 0.0));
        check_close("on the sphere afterwards [m]",
                    sqrt(pose.position[0] * pose.position[0] + pose.position[2] * pose.position[2]), 1.0, 1e-13);
        rig_close(&s);
    }
}

/* A constraint that does not depend on its places can hold nothing. */
static int32_t impossible(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                          double *jacobian)
{
    (void)context, (void)time, (void)count, (void)poses, (void)jacobian;
    value[0] = 1.0;
    return 0;
}

static void constraint_that_cannot_hold(void **state)
{
    (void)state;
    rig s;
    dmb_constraint_def def = dmb_constraint_def_default();
    const dmb_body_def ball = dmb_body_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    def.place[0] = dmb_station(add_body(&s, &ball), 0, 0.0);
    def.callback = impossible;
    must_model(&s, dmb_model_add_constraint(s.model, &def, NULL));
    expect_no_start(&s, DMB_ERR_GEOMETRY, "constraint 0", "violation = 1");
}

/* ---- Driven out of reach ----------------------------------------------------------------------------------------- */

/* A slider on x that a drive pulls away at `speed`; rod and crank of `reach` in all hold it back. */
typedef struct pull {
    rig s;
    dmb_id slider, rail, pin;
} pull;

static pull pull_of(double speed)
{
    pull p;
    const bar crank = {{0.0, 0.0}, {0.0, 0.5}, 1.0}, rod = {{0.0, 0.5}, {1.2, 0.0}, 1.0};
    const double half = 0.5 * sqrt(1.2 * 1.2 + 0.25);
    dmb_body_def block = dmb_body_def_default();
    rig_open(&p.s, 0.0, 0.0, -9.81);
    const dmb_id a = add_bar(&p.s, &crank), b = add_bar(&p.s, &rod);
    block.position[0] = 1.2;
    p.slider = add_body(&p.s, &block);
    (void)add_hinge(&p.s, "axle", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(a, -0.25));
    (void)add_hinge(&p.s, "knee", DMB_JOINT_REVOLUTE, pin_on(a, 0.25), pin_on(b, -half));
    p.pin = add_hinge(&p.s, "wrist", DMB_JOINT_REVOLUTE, pin_on(b, half), pin_on(p.slider, 0.0));
    dmb_joint_def rail = dmb_joint_def_default();
    (void)snprintf(rail.name, sizeof rail.name, "rail");
    rail.kind = DMB_JOINT_PRISMATIC;
    rail.place_b = dmb_station(p.slider, 0, 0.0);
    rail.match = 1;
    p.rail = add_joint(&p.s, &rail);
    (void)add_simple_drive(&p.s, DMB_DRIVE_MOTION, p.rail, DMB_X, add_constant(&p.s, speed));
    (void)mechanism_start(&p.s, NULL);
    return p;
}

static void linkage_pulled_beyond_its_reach(void **state)
{
    (void)state;
    pull p = pull_of(1.007); /* out of reach after 0.6 m */
    expect_stuck(&p.s, run_into(&p.s, 1000));
    assert_true(strstr(dmb_sim_message(p.s.sim), "joint ") != NULL ||
                strstr(dmb_sim_message(p.s.sim), "drive ") != NULL);
    check_close("stopped at its reach: time [s]", dmb_sim_time(p.s.sim), 0.6 / 1.007, 2e-3);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.pin, DMB_JOINT_OPEN));
    for (int i = 0; i < 200; i++) must(&p.s, dmb_sim_step(p.s.sim, step, NULL));
    check_relative("slider goes on alone [m]", pose_at(&p.s, dmb_station(p.slider, 0, 0.0)).position[0],
                   1.2 + 1.007 * dmb_sim_time(p.s.sim), 1e-12);
    rig_close(&p.s);
}

/* By error control: it ends as near as the smallest step brings it, where the bars turn at 1e4 rad/s. */
static void advance_beyond_its_reach(void **state)
{
    (void)state;
    pull p = pull_of(1.007);
    const int32_t status = dmb_sim_advance(p.s.sim, 1.0, NULL);
    print_message("    %s at %g s: %s\n", dmb_status_name(status), dmb_sim_time(p.s.sim), dmb_sim_message(p.s.sim));
    expect_stuck(&p.s, status);
    const double time = dmb_sim_time(p.s.sim);
    assert_true(dmb_sim_advance(p.s.sim, 1.0, NULL) < 0);
    check_close("once more: not much further [s]", dmb_sim_time(p.s.sim), time, 1e-6);
    check_below("violation", statistics_of(&p.s).violation, 1e-9);
    must(&p.s, dmb_sim_set_joint(p.s.sim, p.pin, DMB_JOINT_OPEN));
    must(&p.s, dmb_sim_advance(p.s.sim, time + 1e-3, NULL));
    rig_close(&p.s);
}

/* Bounded work changes nothing about it: no state off its constraints is accepted. */
static void bounded_work_beyond_its_reach(void **state)
{
    (void)state;
    dmb_sim_options options = dmb_sim_options_default();
    pull p = pull_of(1.007);
    int32_t status = DMB_OK;
    options.bounded_work = 1;
    dmb_sim_destroy(&p.s.sim);
    assert_true(dmb_sim_create(p.s.model, &options, &p.s.sim) >= 0);
    for (int i = 0; i < 1000 && status >= 0; i++) {
        status = dmb_sim_step(p.s.sim, step, NULL);
        const double violation = statistics_of(&p.s).violation;
        if (!(violation <= 1e-7))
            fail_msg("violation %g at %g s, %s", violation, dmb_sim_time(p.s.sim), dmb_status_name(status));
    }
    print_message("    %s at %g s: %s\n", dmb_status_name(status), dmb_sim_time(p.s.sim), dmb_sim_message(p.s.sim));
    expect_stuck(&p.s, status);
    rig_close(&p.s);
}

/* Two bodies on supports of the mesh, driven apart; a rod of fixed length between them. */
static void distance_stretched(void **state)
{
    (void)state;
    rig s;
    dmb_body_def block = dmb_body_def_default();
    dmb_joint_def rod = dmb_joint_def_default();
    dmb_segment term = dmb_segment_default();
    rig_open(&s, 0.0, 0.0, -9.81);
    block.free_mask = DMB_FREE_X;
    const dmb_id a = add_body(&s, &block);
    block.position[0] = 1.0;
    const dmb_id b = add_body(&s, &block);
    rod.kind = DMB_JOINT_DISTANCE;
    (void)snprintf(rod.name, sizeof rod.name, "rod");
    rod.place_a = dmb_station(a, 0, 0.0);
    rod.place_b = dmb_station(b, 0, 0.0);
    const dmb_id joint = add_joint(&s, &rod);
    term.kind = DMB_SEGMENT_STEP;
    term.x0 = 0.1;
    term.x1 = 0.2;
    term.h1 = 1.0;
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, a, DMB_X, add_constant(&s, 0.0));
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, b, DMB_X, add_time_function(&s, &term, 1));
    (void)mechanism_start(&s, NULL);
    expect_stuck(&s, run_into(&s, 300));
    expect_text(dmb_sim_message(s.sim), "joint 0 (rod)");
    must(&s, dmb_sim_set_joint(s.sim, joint, DMB_JOINT_OPEN));
    while (dmb_sim_time(s.sim) < 0.3) must(&s, dmb_sim_step(s.sim, step, NULL));
    rig_close(&s);
}

/* ---- Drives that fight ------------------------------------------------------------------------------------------- */

/* A parallelogram with a drive on either crank. */
typedef struct frame {
    rig s;
    dmb_id hinge[4], drive[2];
} frame;

static frame frame_of(const dmb_segment *first, const dmb_segment *second)
{
    frame f;
    const bar left = {{0.0, 0.0}, {0.0, 1.0}, 1.0}, top = {{0.0, 1.0}, {2.0, 1.0}, 1.0},
              right = {{2.0, 0.0}, {2.0, 1.0}, 1.0};
    rig_open(&f.s, 0.0, 0.0, -9.81);
    const dmb_id a = add_bar(&f.s, &left), b = add_bar(&f.s, &top), c = add_bar(&f.s, &right);
    f.hinge[0] = add_hinge(&f.s, "left", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(a, -0.5));
    f.hinge[1] = add_hinge(&f.s, "", DMB_JOINT_REVOLUTE, pin_on(a, 0.5), pin_on(b, -1.0));
    f.hinge[2] = add_hinge(&f.s, "", DMB_JOINT_REVOLUTE, pin_on(b, 1.0), pin_on(c, 0.5));
    f.hinge[3] = add_hinge(&f.s, "right", DMB_JOINT_REVOLUTE, pin_ground(2.0, 0.0), pin_on(c, -0.5));
    f.drive[0] = add_simple_drive(&f.s, DMB_DRIVE_MOTION, f.hinge[0], DMB_RX, add_time_function(&f.s, first, 1));
    f.drive[1] = add_simple_drive(&f.s, DMB_DRIVE_MOTION, f.hinge[3], DMB_RX, add_time_function(&f.s, second, 1));
    return f;
}

static dmb_segment constant(double value)
{
    dmb_segment term = dmb_segment_default();
    term.h0 = value;
    return term;
}

static dmb_segment ramp(double h1)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP;
    term.x0 = 0.1;
    term.x1 = 0.3;
    term.h1 = h1;
    return term;
}

static void drives_that_fight_from_the_start(void **state)
{
    (void)state;
    const dmb_segment slow = constant(0.5), fast = constant(0.7);
    frame f = frame_of(&slow, &fast);
    expect_no_start(&f.s, DMB_ERR_GEOMETRY, "drive ", "speed cannot be had");
}

/* Two drives that agree are redundant and no trouble, until they do not agree any more. */
static void drives_that_come_to_fight(void **state)
{
    (void)state;
    const dmb_segment slow = ramp(0.5), fast = ramp(0.7);
    frame f = frame_of(&slow, &slow);
    (void)mechanism_start(&f.s, NULL);
    take_steps(&f.s, step, 400);
    check_close("agreeing: angle [rad]", joint_at(&f.s, f.hinge[0]).position[DMB_RX] - 0.5 * PI, 0.5 * 0.2, 1e-12);
    rig_close(&f.s);
    f = frame_of(&slow, &fast);
    (void)mechanism_start(&f.s, NULL);
    expect_stuck(&f.s, run_into(&f.s, 1000));
    expect_text(dmb_sim_message(f.s.sim), "drive ");
    check_close("refused soon after they part: time [s]", dmb_sim_time(f.s.sim), 0.1, 0.01);
    must(&f.s, dmb_sim_set_joint(f.s.sim, f.hinge[2], DMB_JOINT_OPEN));
    while (dmb_sim_time(f.s.sim) < 0.5) must(&f.s, dmb_sim_step(f.s.sim, step, NULL));
    check_close("apart, each has its own: left [rad/s]", joint_at(&f.s, f.hinge[0]).speed[DMB_RX], 0.5, 1e-12);
    check_close("right [rad/s]", joint_at(&f.s, f.hinge[3]).speed[DMB_RX], 0.7, 1e-12);
    rig_close(&f.s);
}

/* ---- Change points ----------------------------------------------------------------------------------------------- */

/* Driven through the flat position of a parallelogram, where its rows are dependent: it goes through or is refused, and
 * is never off its equations. */
static void driven_through_a_change_point(void **state)
{
    (void)state;
    rig s;
    const bar left = {{0.0, 0.0}, {0.0, 1.0}, 1.0}, top = {{0.0, 1.0}, {2.0, 1.0}, 1.0},
              right = {{2.0, 0.0}, {2.0, 1.0}, 1.0};
    rig_open(&s, 0.0, 0.0, -9.81);
    const dmb_id a = add_bar(&s, &left), b = add_bar(&s, &top), c = add_bar(&s, &right);
    const dmb_id axle = add_hinge(&s, "left", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(a, -0.5));
    (void)add_hinge(&s, "", DMB_JOINT_REVOLUTE, pin_on(a, 0.5), pin_on(b, -1.0));
    (void)add_hinge(&s, "", DMB_JOINT_REVOLUTE, pin_on(b, 1.0), pin_on(c, 0.5));
    (void)add_hinge(&s, "right", DMB_JOINT_REVOLUTE, pin_ground(2.0, 0.0), pin_on(c, -0.5));
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, axle, DMB_RX, add_constant(&s, -1.0));
    (void)mechanism_start(&s, NULL);
    int32_t status = DMB_OK;
    double worst = 0.0;
    for (int i = 0; i < 3000 && status >= 0; i++) {
        status = dmb_sim_step(s.sim, step, NULL);
        worst = fmax(worst, statistics_of(&s).violation);
    }
    print_message("    %s at %g s (flat at %g s): %s\n", dmb_status_name(status), dmb_sim_time(s.sim), 0.5 * PI,
                  dmb_sim_message(s.sim));
    check_below("largest violation", worst, 1e-7);
    if (status < 0) expect_stuck(&s, status);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bars_too_short),
        cmocka_unit_test(bar_between_two_hinges),
        cmocka_unit_test(initial_angle_out_of_reach),
        cmocka_unit_test(initial_speeds_that_fight),
        cmocka_unit_test(described_turned_over),
        cmocka_unit_test(wrong_jacobian),
        cmocka_unit_test(wrong_jacobian_of_a_small_row),
        cmocka_unit_test(jacobian_that_is_not_announced),
        cmocka_unit_test(callback_fails_at_create),
        cmocka_unit_test(callback_fails_in_a_run),
        cmocka_unit_test(constraint_that_cannot_hold),
        cmocka_unit_test(linkage_pulled_beyond_its_reach),
        cmocka_unit_test(advance_beyond_its_reach),
        cmocka_unit_test(bounded_work_beyond_its_reach),
        cmocka_unit_test(distance_stretched),
        cmocka_unit_test(drives_that_fight_from_the_start),
        cmocka_unit_test(drives_that_come_to_fight),
        cmocka_unit_test(driven_through_a_change_point),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
