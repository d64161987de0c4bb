/* Four-bars in space: more equations than the motion needs, which may fit or not. */
#include <stdio.h>
#include <string.h>

#include "mechanism.h"

/* Crank 0, coupler 1, rocker 2; joints A at the crank's foot, B, C, D at the rocker's foot. */
typedef struct fourbar {
    rig s;
    dmb_id bars[3], joints[4];
} fourbar;

typedef struct shape {
    double feet, crank, coupler, rocker; /* [m] */
    double angle;                        /* [rad] of the crank */
    double lateral;                      /* [N] out of the plane, on the coupler's middle */
    double off;                          /* [m] of joint C out of the plane, on the rocker */
    int32_t kinds[4];
    int32_t planar; /* bodies that can only move in the plane */
    int32_t reserved;
} shape;

static const shape crank_rocker = {
    .feet = 3.0,
    .crank = 1.0,
    .coupler = 3.2,
    .rocker = 2.5,
    .angle = 1.0,
    .kinds = {DMB_JOINT_REVOLUTE, DMB_JOINT_REVOLUTE, DMB_JOINT_REVOLUTE, DMB_JOINT_REVOLUTE},
};

/* Where coupler and rocker meet, above the line from the crank's tip to the rocker's foot. */
static void close_loop(const shape *f, double b[2], double c[2])
{
    b[0] = f->crank * cos(f->angle), b[1] = f->crank * sin(f->angle);
    const double dx = f->feet - b[0], dz = -b[1], d = hypot(dx, dz);
    const double along = (f->coupler * f->coupler - f->rocker * f->rocker + d * d) / (2.0 * d);
    const double height = sqrt(f->coupler * f->coupler - along * along);
    c[0] = b[0] + (along * dx - height * dz) / d;
    c[1] = b[1] + (along * dz + height * dx) / d;
}

static void add_bars(fourbar *m, const shape *f)
{
    double b[2], c[2];
    close_loop(f, b, c);
    const bar bars[3] = {
        {{0.0, 0.0}, {b[0], b[1]}, 1.0}, {{b[0], b[1]}, {c[0], c[1]}, 2.0}, {{f->feet, 0.0}, {c[0], c[1]}, 1.5}};
    for (int i = 0; i < 3; i++) {
        dmb_body_def body = bar_body(bars + i);
        if (f->planar) body.free_mask = DMB_FREE_X | DMB_FREE_Z | DMB_FREE_RY;
        m->bars[i] = add_body(&m->s, &body);
    }
}

/* Universal joint that turns about the normal of the plane with its RY. */
static void turn_universal(dmb_joint_def *def)
{
    for (int i = 0; i < 3; i++) def->axis_a[i] = def->axis_b[i] = def->normal_a[i] = def->normal_b[i] = 0.0;
    def->axis_a[0] = def->axis_b[0] = 1.0;
    def->normal_a[1] = def->normal_b[1] = -1.0;
}

static void add_joints(fourbar *m, const shape *f, double speed)
{
    static const char *const names[4] = {"A", "B", "C", "D"};
    const pin a[4] = {pin_ground(0.0, 0.0), pin_on(m->bars[0], 0.5 * f->crank), pin_on(m->bars[1], 0.5 * f->coupler),
                      pin_ground(f->feet, 0.0)};
    const pin b[4] = {pin_on(m->bars[0], -0.5 * f->crank), pin_on(m->bars[1], -0.5 * f->coupler),
                      pin_on(m->bars[2], 0.5 * f->rocker), pin_on(m->bars[2], -0.5 * f->rocker)};
    for (int i = 0; i < 4; i++) {
        dmb_joint_def def = hinge_of(names[i], f->kinds[i], a[i], b[i]);
        if (f->kinds[i] == DMB_JOINT_UNIVERSAL) turn_universal(&def);
        if (i == 2) def.origin_b[1] = f->off;
        if (i == 0) {
            def.initial_mask = DMB_FREE_RX;
            def.initial_position[DMB_RX] = f->angle;
            def.initial_speed[DMB_RX] = speed;
        }
        m->joints[i] = add_joint(&m->s, &def);
    }
}

static void describe(fourbar *m, const shape *f, double speed)
{
    rig_open(&m->s, 0.0, 0.0, -9.81);
    add_bars(m, f);
    add_joints(m, f, speed);
    if (f->lateral == 0.0) return;
    dmb_load_def load = dmb_load_def_default();
    load.place = dmb_station(m->bars[1], 0, 0.0);
    load.force[1] = f->lateral;
    (void)add_load(&m->s, &load);
}

static fourbar open_fourbar(const shape *f, double speed, const dmb_sim_options *options)
{
    fourbar m;
    describe(&m, f, speed);
    (void)mechanism_start(&m.s, options);
    return m;
}

static shape with_kinds(int32_t a, int32_t b, int32_t c, int32_t d)
{
    shape f = crank_rocker;
    const int32_t kinds[4] = {a, b, c, d};
    memcpy(f.kinds, kinds, sizeof kinds);
    return f;
}

/* ---- The same motion --------------------------------------------------------------------------------------------- */

static uint32_t redundant_rows(const fourbar *m, int print)
{
    uint32_t sum = 0;
    for (int i = 0; i < 4; i++) {
        const dmb_joint_state joint = joint_at(&m->s, m->joints[i]);
        if (print)
            print_message("    joint %c: %u of %u rows redundant\n", 'A' + i, joint.redundant, joint.constraint_rows);
        sum += joint.redundant;
    }
    return sum;
}

static void compare(const char *what, const shape *with, uint32_t redundant)
{
    const dmb_sim_options options = sharp_options(0.9, 1e-12);
    double most = 0.0;
    fourbar a = open_fourbar(&crank_rocker, 3.0, &options), b = open_fourbar(with, 3.0, &options);
    assert_int_equal(redundant_rows(&b, 0), redundant);
    for (int k = 0; k < 100; k++) {
        take_steps(&a.s, 1e-3, 50);
        take_steps(&b.s, 1e-3, 50);
        most = fmax(most, motion_difference(&a.s, &b.s, a.bars, b.bars, 3));
        assert_int_equal(redundant_rows(&a, 0), 3);
        assert_int_equal(redundant_rows(&b, 0), redundant);
        assert_int_equal(statistics_of(&b.s).redundant, redundant);
    }
    check_below(what, most, 1e-8);
    tell("    angle of the crank at the end", joint_at(&a.s, a.joints[0]).position[DMB_RX]);
    tell("    speed of the crank there", joint_at(&a.s, a.joints[0]).speed[DMB_RX]);
    rig_close(&a.s);
    rig_close(&b.s);
}

static void motion_does_not_feel_redundant_rows(void **state)
{
    (void)state;
    const int32_t R = DMB_JOINT_REVOLUTE, S = DMB_JOINT_SPHERICAL;
    const shape rsur = with_kinds(R, S, DMB_JOINT_UNIVERSAL, R), rscr = with_kinds(R, S, DMB_JOINT_CYLINDRICAL, R);
    shape planar = crank_rocker;
    planar.planar = 1;
    compare("revolutes against revolute, spherical, universal, revolute, 5 s", &rsur, 0);
    compare("revolutes against revolute, spherical, cylindrical, revolute, 5 s", &rscr, 0);
    compare("revolutes against bodies held in the plane, 5 s", &planar, 12);
}

static void three_rows_are_redundant(void **state)
{
    (void)state;
    fourbar m = open_fourbar(&crank_rocker, 0.0, NULL);
    dmb_model_info info = dmb_model_info_default();
    const dmb_statistics statistics = statistics_of(&m.s);
    must_model(&m.s, dmb_model_get_info(m.s.model, &info));
    assert_int_equal(redundant_rows(&m, 1), 3);
    assert_int_equal(statistics.redundant, 3);
    assert_int_equal(statistics.dependent, 17);
    assert_int_equal(info.constraint_rows, 20);
    assert_int_equal(info.clusters, 1);
    rig_close(&m.s);
}

static void both_methods_agree(void **state)
{
    (void)state;
    dmb_sim_options options = sharp_options(0.9, 1e-12);
    double most = 0.0, force = 0.0;
    shape f = crank_rocker;
    f.lateral = 7.0;
    fourbar a = open_fourbar(&f, 3.0, &options);
    options.constraint_method = DMB_METHOD_MULTIPLIERS;
    fourbar b = open_fourbar(&f, 3.0, &options);
    for (int k = 0; k < 100; k++) {
        take_steps(&a.s, 1e-3, 20);
        take_steps(&b.s, 1e-3, 20);
        most = fmax(most, motion_difference(&a.s, &b.s, a.bars, b.bars, 3));
        for (int i = 0; i < 4; i++) {
            const dmb_joint_state ja = joint_at(&a.s, a.joints[i]), jb = joint_at(&b.s, b.joints[i]);
            force = fmax(force, largest_difference(6, ja.reaction, jb.reaction));
        }
    }
    check_below("poses and speeds of the two methods, 2 s", most, 1e-9);
    check_below("their reactions [N, N m]", force, 1e-8);
    rig_close(&a.s);
    rig_close(&b.s);
}

/* ---- Reactions of least norm ------------------------------------------------------------------------------------- */

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++) c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* sum += sign * reaction of joint i, moments about the middle of bar k. */
static void add_reaction(const fourbar *m, int i, int k, double sign, double end, double sum[6])
{
    const dmb_joint_state joint = joint_at(&m->s, m->joints[i]);
    const dmb_pose pose = pose_at(&m->s, dmb_station(m->bars[k], 0, 0.0));
    double arm[3], moment[3];
    for (int c = 0; c < 3; c++) arm[c] = end * pose.rotation[3 * c];
    cross(arm, joint.reaction, moment);
    for (int c = 0; c < 3; c++) {
        sum[c] += sign * joint.reaction[c];
        sum[3 + c] += sign * (joint.reaction[3 + c] + moment[c]);
    }
}

/* Newton and Euler for every bar: what the joints, gravity and the load leave, the bars moving in the plane only. */
static double out_of_balance(const fourbar *m, const shape *f)
{
    const double length[3] = {f->crank, f->coupler, f->rocker}, mass[3] = {1.0, 2.0, 1.5};
    double most = 0.0;
    for (int k = 0; k < 3; k++) {
        const dmb_motion motion = motion_at(&m->s, dmb_station(m->bars[k], 0, 0.0), DMB_FRAME_WORLD);
        double sum[6] = {0.0, k == 1 ? f->lateral : 0.0, -9.81 * mass[k], 0.0, 0.0, 0.0};
        add_reaction(m, k == 2 ? 3 : k, k, 1.0, -0.5 * length[k], sum);
        if (k == 2) add_reaction(m, 2, k, 1.0, 0.5 * length[k], sum);
        if (k < 2) add_reaction(m, k + 1, k, -1.0, 0.5 * length[k], sum);
        for (int c = 0; c < 3; c++) sum[c] -= mass[k] * motion.acceleration[c];
        sum[4] -= mass[k] * length[k] * length[k] / 12.0 * motion.acceleration[4];
        most = fmax(most, largest(6, sum));
    }
    return most;
}

static void reactions_balance(void **state)
{
    (void)state;
    const dmb_sim_options options = sharp_options(0.9, 1e-12);
    shape f = crank_rocker;
    double most = 0.0;
    f.lateral = 7.0;
    fourbar m = open_fourbar(&f, 3.0, &options);
    check_below("Newton and Euler of every bar at the start [N, N m]", out_of_balance(&m, &f), 1e-11);
    for (int k = 0; k < 200; k++) {
        take_steps(&m.s, 1e-3, 10);
        most = fmax(most, out_of_balance(&m, &f));
    }
    check_below("Newton and Euler of every bar over 2 s [N, N m]", most, 1e-9);
    rig_close(&m.s);
}

static void check_shares(const fourbar *m, double tolerance)
{
    const dmb_joint_state a = joint_at(&m->s, m->joints[0]), d = joint_at(&m->s, m->joints[3]);
    check_close("    lateral force at foot A", a.reaction[1], -5.0, tolerance);
    check_close("    lateral force at foot D", d.reaction[1], -5.0, tolerance);
    check_below("    sum of the moments about z", a.reaction[5] + d.reaction[5], tolerance);
    check_close("    moment about x at foot A", a.reaction[3], 5.0, tolerance);
    check_close("    moment about x at foot D", d.reaction[3], 5.0, tolerance);
}

/* Upright parallelogram with a lateral load on the middle: by symmetry, the shortest multipliers share it. */
static void least_norm_is_symmetric(void **state)
{
    (void)state;
    shape f = crank_rocker;
    f.feet = f.coupler = 2.0;
    f.crank = f.rocker = 1.0;
    f.angle = 0.5 * PI;
    f.lateral = 10.0;
    fourbar m = open_fourbar(&f, 0.0, NULL);
    tell("at the start, time", dmb_sim_time(m.s.sim));
    check_shares(&m, 1e-12);
    take_steps(&m.s, 1e-6, 1); /* the parallelogram falls: hardly, in this step */
    tell("after one step, time", dmb_sim_time(m.s.sim));
    check_shares(&m, 1e-9);
    rig_close(&m.s);
}

/* ---- What does not fit ------------------------------------------------------------------------------------------- */

/* The number behind "violation = " in a message. */
static double violation_told(const char *text)
{
    double violation = (double)NAN;
    const char *at = strstr(text, "violation = ");
    assert_non_null(at);
    assert_int_equal(sscanf(at, "violation = %lf", &violation), 1);
    return violation;
}

/* Rows that others nearly hold share the violation, so that it is of the size of 1e-3. */
static void check_refusal(rig *s)
{
    const refusal said = refused_start(s);
    print_message("    %s: %s\n", dmb_status_name(said.status), said.text);
    assert_int_equal(said.status, DMB_ERR_GEOMETRY);
    assert_null(s->sim);
    assert_non_null(strstr(said.text, "joint "));
    assert_non_null(strstr(said.text, "("));
    const double violation = fabs(violation_told(said.text));
    assert_true(violation > 1e-4 && violation < 3e-3);
    rig_close(s);
}

static void revolute_out_of_the_plane_is_refused(void **state)
{
    (void)state;
    fourbar m;
    shape f = crank_rocker;
    f.off = 1e-3;
    describe(&m, &f, 0.0);
    check_refusal(&m.s);
}

/* Parallelogram with a rod from the middle of the ground to that of the coupler. */
static void describe_propped(fourbar *m, double rod, int32_t state, dmb_id *prop)
{
    shape f = crank_rocker;
    f.feet = f.coupler = 2.0;
    f.crank = f.rocker = 1.0;
    f.angle = 1.2;
    describe(m, &f, 0.0);
    dmb_joint_def def = hinge_of("prop", DMB_JOINT_DISTANCE, pin_ground(1.0, 0.0), pin_on(m->bars[1], 0.0));
    def.length = rod;
    def.state = state;
    *prop = add_joint(&m->s, &def);
}

static void rod_too_long_is_refused(void **state)
{
    (void)state;
    fourbar m;
    dmb_id prop;
    describe_propped(&m, 1.001, DMB_JOINT_ACTIVE, &prop);
    check_refusal(&m.s);
    describe_propped(&m, 0.999, DMB_JOINT_ACTIVE, &prop);
    check_refusal(&m.s);
    describe_propped(&m, 1.0, DMB_JOINT_ACTIVE, &prop);
    (void)mechanism_start(&m.s, NULL);
    assert_int_equal(statistics_of(&m.s).redundant, 4);
    take_steps(&m.s, 1e-3, 100);
    check_below("the rod that fits: violation after 0.1 s", joint_at(&m.s, prop).violation, 1e-14);
    rig_close(&m.s);
}

/* Put in later, it is refused too, and nothing has changed. */
static void rod_put_in_later_is_refused(void **state)
{
    (void)state;
    fourbar m;
    dmb_id prop;
    uint64_t before = 0, after = 0;
    describe_propped(&m, 1.001, DMB_JOINT_OPEN, &prop);
    (void)mechanism_start(&m.s, NULL);
    take_steps(&m.s, 1e-3, 100);
    must(&m.s, dmb_sim_hash(m.s.sim, &before));
    assert_int_equal(dmb_sim_set_joint(m.s.sim, prop, DMB_JOINT_ACTIVE), DMB_ERR_GEOMETRY);
    print_message("    %s\n", dmb_sim_message(m.s.sim));
    assert_non_null(strstr(dmb_sim_message(m.s.sim), "prop"));
    check_relative("violation told", fabs(violation_told(dmb_sim_message(m.s.sim))), 1e-3, 1e-3);
    must(&m.s, dmb_sim_hash(m.s.sim, &after));
    assert_true(before == after);
    take_steps(&m.s, 1e-3, 100);
    rig_close(&m.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_rows_are_redundant), cmocka_unit_test(motion_does_not_feel_redundant_rows),
        cmocka_unit_test(both_methods_agree),       cmocka_unit_test(reactions_balance),
        cmocka_unit_test(least_norm_is_symmetric),  cmocka_unit_test(revolute_out_of_the_plane_is_refused),
        cmocka_unit_test(rod_too_long_is_refused),  cmocka_unit_test(rod_put_in_later_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
