/* Strings as parts of mechanisms: a closed ring, a slider-crank with a flexible coupler, strings of universal joints,
 * branches, centralisers; and what joints carry at rest. */
#include <string.h>

#include "mechanism.h"

/* Frame a on the ground or on a body at `at`, its x axis along `axis`; frame b where that is at time 0. */
static dmb_id join_at(rig *s, int32_t kind, dmb_place a, const double at[3], const double axis[3], dmb_place b)
{
    dmb_joint_def joint = joint_between(kind, a, b);
    joint.match = 1;
    memcpy(joint.origin_a, at, sizeof joint.origin_a);
    memcpy(joint.axis_a, axis, sizeof joint.axis_a);
    return add_joint(s, &joint);
}

static dmb_place whole(dmb_id part)
{
    return dmb_station(part, 0, 0.0);
}

static dmb_place ground(void)
{
    return dmb_station(ground_id, 0, 0.0);
}

static const double origin[3] = {0.0, 0.0, 0.0}, along_x[3] = {1.0, 0.0, 0.0}, along_y[3] = {0.0, 1.0, 0.0};

static dmb_static_report rest(const rig *s)
{
    dmb_static_options options = dmb_static_options_default();
    options.tolerance = 1e-13;
    options.lay_on_wall = 0;
    return find_equilibrium(s, &options);
}

static double drive_force(const rig *s, dmb_id drive)
{
    dmb_drive_state state = dmb_drive_state_default();
    must(s, dmb_query_drive(s->sim, drive, &state));
    return state.force;
}

/* ---- Ring ----------------------------------------------------------------------------------------------------------
 */

#define RADIUS 0.5   /* [m] */
#define RING_EI 40.0 /* [N m2] */

/* Two halves in the x-z plane, unstressed as a circle: from the lowest point, which is clamped, up on the side of +x to
 * the highest, and down again. */
typedef struct ring {
    rig s;
    dmb_id half[2], clamp, top, bottom, drive;
} ring;

static dmb_pipe_def ring_pipe(uint32_t elements, double length)
{
    dmb_pipe_def pipe = beam_pipe(length, elements, 1e6 * RING_EI, 1e6 * RING_EI, RING_EI, RING_EI);
    pipe.curvature[1] = -1.0 / RADIUS;
    return pipe;
}

static dmb_id add_arc(rig *s, const dmb_string_def *def, const dmb_pipe_def *pipe)
{
    dmb_pipe_def with = *pipe;
    with.string = add_string(s, def);
    return add_pipes(s, &with, 1);
}

/* `push` [N] acts down on the highest point, times the time function. */
static void add_push(rig *s, dmb_place place, double push, dmb_id time_function)
{
    dmb_load_def load = dmb_load_def_default();
    load.place = place;
    load.force[2] = -push;
    load.time_function = time_function;
    (void)add_load(s, &load);
}

static void open_ring(ring *r, uint32_t elements, double push, const dmb_segment *release,
                      const dmb_sim_options *options)
{
    dmb_string_def def = dmb_string_def_default();
    const dmb_pipe_def pipe = ring_pipe(elements, PI * RADIUS);
    dmb_id time_function = {0, 0};
    rig *const s = &r->s;
    rig_open(s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    r->half[0] = add_arc(s, &def, &pipe);
    def.position[2] = 2.0 * RADIUS;
    def.rotation[1] = PI;
    r->half[1] = add_arc(s, &def, &pipe);
    r->clamp = add_joint_between(s, DMB_JOINT_FIXED, ground(), dmb_station(r->half[0], 0, 0.0));
    r->top = add_joint_between(s, DMB_JOINT_FIXED, dmb_station(r->half[0], 0, 1.0), dmb_station(r->half[1], 0, 0.0));
    r->bottom = add_joint_between(s, DMB_JOINT_FIXED, dmb_station(r->half[1], 0, 1.0), dmb_station(r->half[0], 0, 0.0));
    if (release != NULL) time_function = add_time_function(s, release, 1);
    add_push(s, dmb_station(r->half[0], 0, 1.0), push, time_function);
    (void)rig_start(s, options);
}

/* A ring that is bent from nothing closes without force. */
static void ring_closes_unstressed(void **state)
{
    (void)state;
    ring r;
    open_ring(&r, 16, 0.0, NULL, NULL);
    const dmb_joint_state top = joint_at(&r.s, r.top), bottom = joint_at(&r.s, r.bottom);
    check_below("assembly [m]", statistics_of(&r.s).assembly[0], 1e-14);
    check_below("force in the top joint [N]", largest(6, top.reaction), 1e-7);
    check_below("force in the bottom joint [N]", largest(6, bottom.reaction), 1e-7);
    rig_close(&r.s);
}

/* Ring under two opposite forces: shorter by (pi/4 - 2/pi) P R^3/EI, and pi/4 P R (1/EA + 1/GA) (Timoshenko). */
static void ring_under_small_load(void **state)
{
    (void)state;
    const double P = 1e-3, stiff = 1e6 * RING_EI;
    const double want = P * RADIUS * ((0.25 * PI - 2.0 / PI) * RADIUS * RADIUS / RING_EI + 0.5 * PI / stiff);
    double error[3];
    for (uint32_t k = 0; k < 3; k++) {
        ring r;
        open_ring(&r, 4u << k, P, NULL, NULL);
        check_below("iterations", rest(&r.s).iterations, 3.0);
        error[k] = fabs(pose_at(&r.s, dmb_station(r.half[0], 0, 1.0)).displacement[2] / want + 1.0);
        rig_close(&r.s);
    }
    check_order("deflection, 8 and 16 elements", error[0], error[1], 4.0, 0.3);
    check_order("deflection, 16 and 32 elements", error[1], error[2], 4.0, 0.3);
}

/* A quarter of the ring whose side point moves without turning carries half the load: the same elements, and the same
 * answer, also where the ring is pressed far out of shape. */
static void ring_against_its_quarter(void **state)
{
    (void)state;
    const double push[3] = {50.0, 100.0, -800.0};
    for (int k = 0; k < 3; k++) {
        ring r;
        rig q;
        dmb_string_def def = dmb_string_def_default();
        const dmb_pipe_def pipe = ring_pipe(8, 0.5 * PI * RADIUS);
        open_ring(&r, 16, push[k], NULL, NULL);
        rig_open(&q, 0.0, 0.0, 0.0);
        def.follows_hole = 0;
        def.start_free = DMB_FREE_NONE;
        def.end_free = DMB_FREE_TRANSLATIONS;
        const dmb_id quarter = add_arc(&q, &def, &pipe);
        add_push(&q, dmb_station(quarter, 0, 1.0), 0.5 * push[k], ground_id);
        (void)rig_start(&q, NULL);
        const dmb_static_report ring_report = rest(&r.s), quarter_report = rest(&q);
        const dmb_pose side = pose_at(&r.s, dmb_station(r.half[0], 0, 0.5)),
                       want = pose_at(&q, dmb_station(quarter, 0, 1.0));
        const dmb_pose top = pose_at(&r.s, dmb_station(r.half[0], 0, 1.0));
        const dmb_joint_state clamp = joint_at(&r.s, r.clamp), bottom = joint_at(&r.s, r.bottom);
        print_message("    %g N: top moves %.4g m, %u iterations, quarter %u\n", push[k], top.displacement[2],
                      ring_report.iterations, quarter_report.iterations);
        check_below("    side point [m]", largest_difference(3, side.position, want.position), 1e-10);
        check_close("    top [m]", top.displacement[2], 2.0 * want.displacement[2], 1e-10);
        check_relative("    clamp carries the load", clamp.reaction[2], push[k], 1e-10);
        check_below("    and nothing else", fabs(clamp.reaction[0]) + largest(3, clamp.reaction + 3), 1e-7);
        check_relative("    each half carries half", bottom.reaction[2], -0.5 * push[k], 1e-8);
        assert_int_equal(ring_report.negative, 0);
        rig_close(&r.s);
        rig_close(&q);
    }
}

/* At 400 N the symmetric ring is unstable (2 negative eigenvalues): the ring sways and hangs below its clamp, where it
 * is stable. */
static void ring_sways_under_a_large_push(void **state)
{
    (void)state;
    ring r;
    open_ring(&r, 16, 400.0, NULL, NULL);
    const dmb_static_report report = rest(&r.s);
    assert_int_equal(report.negative, 0);
    assert_true(pose_at(&r.s, dmb_station(r.half[0], 0, 1.0)).position[2] < -0.5);
    rig_close(&r.s);
}

/* Let go from there with a load that goes to 0 within 10 ms. The gap in the ledger falls with the square of the step,
 * and none of it comes from the iteration. */
static void ring_let_go(void **state)
{
    (void)state;
    dmb_segment release = dmb_segment_default();
    dmb_sim_options options = sharp_options(1.0, 1e-11);
    double error[3];
    release.kind = DMB_SEGMENT_STEP5;
    release.x1 = 0.01;
    release.h0 = 1.0;
    for (uint32_t k = 0; k < 3; k++) {
        ring r;
        open_ring(&r, 8, 100.0, &release, &options);
        (void)rest(&r.s);
        take_steps(&r.s, 1e-3 / (1u << k), 200u << k);
        const dmb_energy e = energy_of(&r.s);
        error[k] = fabs(e.balance);
        tell("    kinetic energy [J]", e.kinetic);
        tell("    strain energy [J]", e.strain);
        check_below("    open in the energy ledger [J]", e.balance, 2e-3 / (1u << 2 * k));
        check_below("    of it from the iteration [J]", e.unexplained, 1e-8);
        check_below("    violation [m]", statistics_of(&r.s).violation, 1e-14);
        assert_true(e.kinetic > 1.5);
        rig_close(&r.s);
    }
    check_order("energy left open, 1 and 0.5 ms", error[0], error[1], 2.0, 0.1);
    check_order("energy left open, 0.5 and 0.25 ms", error[1], error[2], 2.0, 0.1);
}

/* ---- Slider-crank --------------------------------------------------------------------------------------------------
 */

/* Crank on the world's origin turned by a motor, coupler (a string), slider on the x axis; in the x-z plane. */
#define CRANK 0.2
#define COUPLER 0.6

typedef struct slider_crank {
    rig s;
    dmb_id crank, coupler, slider, motor;
    dmb_id pins[4]; /* ground - crank - coupler - slider - ground */
} slider_crank;

static dmb_id add_motor(rig *s, dmb_id joint, double speed, double rise)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP5;
    term.x1 = rise;
    term.h1 = speed;
    return add_simple_drive(s, DMB_DRIVE_MOTION, joint, DMB_RX, add_time_function(s, &term, 1));
}

static dmb_id add_coupler(rig *s, uint32_t elements, double EI, int32_t kind)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(COUPLER, elements, 2e3 * EI, 1e3 * EI, EI, EI);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    def.position[0] = CRANK;
    pipe.kind = kind;
    pipe.string = add_string(s, &def);
    return add_pipes(s, &pipe, 1);
}

static void open_slider_crank(slider_crank *m, uint32_t elements, double EI, int32_t kind)
{
    rig *const s = &m->s;
    const bar crank = {{0.0, 0.0}, {CRANK, 0.0}, 0.5};
    dmb_body_def slider = dmb_body_def_default();
    const double knee[3] = {0.5 * CRANK, 0.0, 0.0}, wrist[3] = {0.0, 0.0, 0.0};
    const dmb_sim_options options = sharp_options(0.8, 1e-11);
    rig_open(s, 0.0, 0.0, -9.81);
    m->crank = add_bar(s, &crank);
    m->coupler = add_coupler(s, elements, EI, kind);
    slider.mass = 0.4;
    slider.position[0] = CRANK + COUPLER;
    m->slider = add_body(s, &slider);
    m->pins[0] = join_at(s, DMB_JOINT_REVOLUTE, ground(), origin, along_y, whole(m->crank));
    m->pins[1] = join_at(s, DMB_JOINT_REVOLUTE, whole(m->crank), knee, along_y, dmb_station(m->coupler, 0, 0.0));
    m->pins[2] = join_at(s, DMB_JOINT_REVOLUTE, whole(m->slider), wrist, along_y, dmb_station(m->coupler, 0, 1.0));
    m->pins[3] = join_at(s, DMB_JOINT_PRISMATIC, ground(), origin, along_x, whole(m->slider));
    m->motor = add_motor(s, m->pins[0], 20.0, 0.2);
    (void)rig_start(s, &options);
}

static double angle_of_crank(const slider_crank *m)
{
    return joint_at(&m->s, m->pins[0]).position[DMB_RX];
}

/* Largest distance of the slider from where a rigid coupler puts it, and the torques of the motor, over `steps`. */
static double run_slider_crank(const slider_crank *m, double h, uint32_t steps, double *torque)
{
    double most = 0.0;
    for (uint32_t k = 0; k < steps; k++) {
        take_steps(&m->s, h, 1);
        const double angle = angle_of_crank(m), z = CRANK * sin(angle);
        const double want = CRANK * cos(angle) + sqrt(COUPLER * COUPLER - z * z);
        most = fmax(most, fabs(pose_at(&m->s, whole(m->slider)).position[0] - want));
        torque[k] = drive_force(&m->s, m->motor);
    }
    return most;
}

enum { CRANK_STEPS = 1200 };

/* From rest under its weight, one and a half revolutions up to 20 rad/s. The stretch of the coupler takes the slider
 * away from the rigid one in inverse proportion to its stiffness; the motor does the same work. In space the rigid one
 * has 3 equations too many, which the flexible one needs. */
static void stiff_coupler_is_rigid(void **state)
{
    (void)state;
    static double rigid[CRANK_STEPS], torque[CRANK_STEPS];
    const double EI[3] = {1e3, 1e4, 1e5};
    double error[3];
    slider_crank m;
    open_slider_crank(&m, 1, EI[0], DMB_PIPE_RIGID);
    assert_int_equal(statistics_of(&m.s).redundant, 3);
    assert_int_equal(statistics_of(&m.s).dependent, 18);
    (void)rest(&m.s);
    check_below("rigid: slider against closed form [m]", run_slider_crank(&m, 5e-4, CRANK_STEPS, rigid), 1e-13);
    check_close("rigid: angle turned [rad]", angle_of_crank(&m), 10.0, 1e-12);
    tell("rigid: largest torque [N m]", largest(CRANK_STEPS, rigid));
    rig_close(&m.s);
    for (int k = 0; k < 3; k++) {
        open_slider_crank(&m, 4, EI[k], DMB_PIPE_FLEXIBLE);
        assert_int_equal(statistics_of(&m.s).redundant, 0);
        check_below("static iterations", rest(&m.s).iterations, 4.0);
        error[k] = run_slider_crank(&m, 5e-4, CRANK_STEPS, torque);
        tell("    EI [N m2]", EI[k]);
        check_below("    torque from the rigid one [N m]", largest_difference(CRANK_STEPS, torque, rigid),
                    25.0 / EI[k] + 2e-3);
        check_relative("    slider from the rigid one, times EI", error[k] * EI[k], 0.0345, 0.01);
        check_below("    violation [m]", statistics_of(&m.s).violation, 1e-14);
        rig_close(&m.s);
    }
}

/* The slider's place [m] after 0.2 s in `steps` with a coupler so soft that it bends by millimetres; energy left open.
 */
static double soft_slider(uint32_t elements, uint32_t steps, double *balance)
{
    static double torque[2000];
    slider_crank m;
    open_slider_crank(&m, elements, 10.0, DMB_PIPE_FLEXIBLE);
    (void)rest(&m.s);
    (void)run_slider_crank(&m, 0.2 / steps, steps, torque);
    const dmb_energy energy = energy_of(&m.s);
    check_below("energy from the iteration [J]", energy.unexplained, 1e-8);
    *balance = fabs(energy.balance);
    const double place = pose_at(&m.s, whole(m.slider)).displacement[0];
    rig_close(&m.s);
    return place;
}

static void soft_coupler(void **state)
{
    (void)state;
    double place[4], balance[4];
    for (uint32_t k = 0; k < 4; k++) place[k] = soft_slider(8, 200u << k, balance + k);
    check_order("in time", place[0] - place[1], place[1] - place[2], 2.0, 0.1);
    check_order("in time", place[1] - place[2], place[2] - place[3], 2.0, 0.1);
    check_order("energy left open", balance[0], balance[1], 2.0, 0.1);
    check_order("energy left open", balance[2], balance[3], 2.0, 0.1);
    for (uint32_t k = 0; k < 4; k++) place[k] = soft_slider(4u << k, 800, balance + k);
    check_order("in elements, 4 to 16", place[0] - place[1], place[1] - place[2], 2.0, 0.3);
    check_order("in elements, 8 to 32", place[1] - place[2], place[2] - place[3], 2.0, 0.3);
}

/* ---- Universal joints ----------------------------------------------------------------------------------------------
 */

/* Two shafts that meet at the origin at the angle `bend` about y, each in its bearing, the first turned by a motor. */
typedef struct shafts {
    rig s;
    dmb_id in, out, bearing[2], cross, motor;
} shafts;

static void open_shafts(shafts *m, double bend, double load)
{
    rig *const s = &m->s;
    dmb_body_def shaft = dmb_body_def_default();
    dmb_load_def torque = dmb_load_def_default();
    const dmb_sim_options options = sharp_options(0.8, 1e-12);
    const double axis[3] = {cos(bend), 0.0, sin(bend)};
    rig_open(s, 0.0, 0.0, 0.0);
    shaft.mass = 2.0;
    for (int i = 0; i < 3; i++) shaft.inertia[i] = 0.01;
    m->in = add_body(s, &shaft);
    shaft.rotation[1] = -bend;
    m->out = add_body(s, &shaft);
    m->bearing[0] = join_at(s, DMB_JOINT_REVOLUTE, ground(), origin, along_x, whole(m->in));
    m->bearing[1] = join_at(s, DMB_JOINT_CYLINDRICAL, ground(), origin, axis, whole(m->out));
    m->cross = add_joint_between(s, DMB_JOINT_UNIVERSAL, whole(m->in), whole(m->out));
    m->motor = add_motor(s, m->bearing[0], 10.0, 0.1);
    torque.frame = DMB_FRAME_BODY;
    torque.place = whole(m->out);
    torque.moment[0] = -load;
    (void)add_load(s, &torque);
    (void)rig_start(s, &options);
}

/* Crossed axes y of the first and z of the second: tan(out) = cos(bend) tan(in), so that out' = in' cos(bend)/(1 -
 * sin^2(bend) sin^2(in)), and the motor carries the load and the inertia of the second times out'/in'. */
static void universal_joint_of_two_shafts(void **state)
{
    (void)state;
    const double bend = 0.6, load = 5.0;
    shafts m;
    double angle_error = 0.0, speed_error = 0.0, torque_error = 0.0, step = 1e-3;
    open_shafts(&m, bend, load);
    for (int k = 0; k < 1000; k++) {
        take_steps(&m.s, step, 1);
        const dmb_joint_state in = joint_at(&m.s, m.bearing[0]), out = joint_at(&m.s, m.bearing[1]);
        const double c = cos(bend), x = in.position[DMB_RX], turns = floor(x / PI + 0.5) * PI;
        const double ratio = c / (1.0 - pow(sin(bend) * sin(x), 2.0));
        angle_error = fmax(angle_error, fabs(out.position[DMB_RX] - (turns + atan(c * tan(x - turns)))));
        speed_error = fmax(speed_error, fabs(out.speed[DMB_RX] - ratio * in.speed[DMB_RX]));
        const double want = ratio * (load + 0.01 * out.acceleration[DMB_RX]) + 0.01 * in.acceleration[DMB_RX];
        torque_error = fmax(torque_error, fabs(drive_force(&m.s, m.motor) - want));
    }
    check_close("angle turned [rad]", joint_at(&m.s, m.bearing[0]).position[DMB_RX], 9.5, 1e-12);
    check_below("angle of the second shaft [rad]", angle_error, 1e-12);
    check_below("speed of the second shaft [rad/s]", speed_error, 1e-11);
    check_below("torque of the motor [N m]", torque_error, 1e-9);
    tell("redundant equations", statistics_of(&m.s).redundant);
    tell("switches", (double)statistics_of(&m.s).switches);
    rig_close(&m.s);
}

/* Rods of 1 m with a universal joint between each two, in a hole that bends upwards by 6 degrees within 10 m. */
enum { RODS = 30 };
typedef struct rods {
    rig s;
    dmb_id rod[RODS], cross[RODS - 1], drive[2];
} rods;

static void add_bent_hole(rig *s)
{
    static const double up = 6.0 * PI / 180.0;
    static const double survey[] = {0.0,  0.5 * PI,      0.0, 10.0, 0.5 * PI,      0.0,
                                    20.0, 0.5 * PI + up, 0.0, 40.0, 0.5 * PI + up, 0.0};
    dmb_wall_def wall = dmb_wall_def_default();
    wall.survey = survey;
    wall.survey_count = 4;
    wall.friction_law = DMB_FRICTION_NONE;
    (void)add_wall(s, &wall);
}

static dmb_id add_rod(rig *s, uint32_t number)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    def.start_depth = number;
    def.start_free = number == 0 ? DMB_FREE_CYLINDRICAL : DMB_FREE_ALL;
    pipe.string = add_string(s, &def);
    return add_pipes(s, &pipe, 1);
}

static void open_rods(rods *r, double speed)
{
    rig *const s = &r->s;
    dmb_segment rise = dmb_segment_default();
    rig_open(s, 0.0, 0.0, -9.81);
    add_bent_hole(s);
    for (uint32_t i = 0; i < RODS; i++) r->rod[i] = add_rod(s, i);
    for (uint32_t i = 0; i + 1 < RODS; i++)
        r->cross[i] = add_joint_between(s, DMB_JOINT_UNIVERSAL, dmb_station(r->rod[i], 0, 1.0),
                                        dmb_station(r->rod[i + 1], 0, 0.0));
    rise.kind = DMB_SEGMENT_STEP5;
    rise.h1 = speed;
    r->drive[0] = add_simple_drive(s, DMB_DRIVE_MOTION, r->rod[0], DMB_X, add_constant(s, 0.0));
    r->drive[1] = add_simple_drive(s, DMB_DRIVE_MOTION, r->rod[0], DMB_RX, add_time_function(s, &rise, 1));
    (void)rig_start(s, NULL);
}

/* [rad] */
static double bend_of(const rods *r, uint32_t i)
{
    const dmb_joint_state cross = joint_at(&r->s, r->cross[i]);
    return hypot(cross.position[DMB_RY], cross.position[DMB_RZ]);
}

/* The joints take the bend of the hole, 6 degrees over 10 m. */
static double check_bends(const rods *r)
{
    double waver = 0.0;
    for (uint32_t i = 0; i + 1 < RODS; i++) waver += 0.25 * bend_of(r, i) * bend_of(r, i);
    for (uint32_t i = 10; i < 19; i++)
        check_relative("    bend of a joint in the curve", bend_of(r, i), 0.6 * PI / 180.0, 0.01);
    check_below("    bend of a joint beyond it [rad]", bend_of(r, 22), 1e-4);
    return waver;
}

/* Without friction the last rod turns with the first but for what each joint makes of its bend: bend^2/4 sin(2 angle),
 * the crosses standing in line; and for what the torques that this takes twist the rods. */
static void universal_joints_in_a_curved_hole(void **state)
{
    (void)state;
    rods r;
    double off = 0.0, most = 0.0;
    open_rods(&r, 10.0);
    assert_int_equal(statistics_of(&r.s).dependent, 4 * (RODS - 1));
    const dmb_static_report report = find_equilibrium(&r.s, NULL);
    check_below("static iterations", report.iterations, 8.0);
    assert_int_equal(report.method, DMB_STATIC_NEWTON);
    const double waver = check_bends(&r);
    take_steps(&r.s, 1e-3, 1000);
    for (uint32_t k = 0; k < 1000; k++) {
        take_steps(&r.s, 1e-3, 1);
        const double in = rotation_at(&r.s, dmb_station(r.rod[0], 0, 0.0));
        const double out = rotation_at(&r.s, dmb_station(r.rod[RODS - 1], 0, 1.0));
        off = fmax(off, fabs(in - out - waver * sin(2.0 * in)));
        most = fmax(most, fabs(in - out));
    }
    tell("largest lag of the last rod [rad]", most);
    check_below("off the sum of the joints [rad]", off, 0.1 * waver);
    check_below("violation [m]", statistics_of(&r.s).violation, 1e-14);
    rig_close(&r.s);
}

/* ---- Branches and bodies on strings --------------------------------------------------------------------------------
 */

static dmb_id add_free_string(rig *s, double x, double y, uint32_t pipes)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    def.follows_hole = 0;
    def.start_free = DMB_FREE_ALL;
    def.position[0] = x;
    def.position[1] = y;
    pipe.string = add_string(s, &def);
    return add_pipes(s, &pipe, pipes);
}

/* Force and moment about the world's origin that the ground puts on the parts through `count` joints, whose frames b
 * stand at the origins of the places `at` [m, body frames]; less than what gravity and `load` [N, N m] take. */
static double imbalance(const rig *s, const dmb_id *joints, const dmb_place *at, uint32_t count, const double load[6])
{
    const dmb_momentum all = momentum_of(s);
    const double weight = 9.81 * all.mass;
    double sum[6] = {0.0, 0.0, -weight, -weight * all.centre[1], weight * all.centre[0], 0.0};
    for (int i = 0; i < 6; i++) sum[i] += load[i];
    for (uint32_t k = 0; k < count; k++) {
        const dmb_joint_state joint = joint_at(s, joints[k]);
        const dmb_pose pose = pose_at(s, at[k]);
        const double *F = joint.reaction, *r = pose.position;
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, l = (i + 2) % 3;
            sum[i] += F[i];
            sum[3 + i] += F[3 + i] + r[j] * F[l] - r[l] * F[j];
        }
    }
    return largest(6, sum) / weight;
}

static const double no_load[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

/* One clamped string of its own. */
static dmb_pose tip_alone(double y, uint32_t pipes)
{
    rig s;
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(&s, 0.0, 0.0, -9.81);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_NONE;
    def.position[1] = y;
    pipe.string = add_string(&s, &def);
    const dmb_id string = add_pipes(&s, &pipe, pipes);
    (void)rig_start(&s, NULL);
    (void)rest(&s);
    const dmb_pose tip = pose_at(&s, dmb_station(string, pipes - 1, 1.0));
    rig_close(&s);
    return tip;
}

/* Strings of 5 m and 3 m side by side on one head that the ground holds: each sags as if it were alone, its joint
 * carries it, and the ground carries all. */
static void two_strings_on_one_head(void **state)
{
    (void)state;
    rig s;
    dmb_body_def head = dmb_body_def_default();
    const double side[2] = {0.2, -0.3};
    const uint32_t pipes[2] = {5, 3};
    dmb_id string[2], clamp[2];
    rig_open(&s, 0.0, 0.0, -9.81);
    head.mass = 50.0;
    head.centre[2] = 0.1;
    const dmb_id body = add_body(&s, &head);
    const dmb_id base = add_joint_between(&s, DMB_JOINT_FIXED, ground(), whole(body));
    const dmb_place at = whole(body);
    for (int i = 0; i < 2; i++) {
        const double root[3] = {0.0, side[i], 0.0};
        string[i] = add_free_string(&s, 0.0, side[i], pipes[i]);
        clamp[i] = join_at(&s, DMB_JOINT_FIXED, whole(body), root, along_x, dmb_station(string[i], 0, 0.0));
    }
    (void)rig_start(&s, NULL);
    check_below("static iterations", rest(&s).iterations, 5.0);
    const double weight = 9.81 * (momentum_of(&s).mass - 50.0) / 8.0;
    for (int i = 0; i < 2; i++) {
        const dmb_pose tip = pose_at(&s, dmb_station(string[i], pipes[i] - 1, 1.0)),
                       want = tip_alone(side[i], pipes[i]);
        check_below("    tip against the string alone [m]", largest_difference(3, tip.displacement, want.displacement),
                    1e-13);
        check_relative("    its joint carries its weight", joint_at(&s, clamp[i]).reaction[2], weight * pipes[i],
                       1e-10);
    }
    check_below("ground against weight", imbalance(&s, &base, &at, 1, no_load), 1e-10);
    rig_close(&s);
}

/* A body of 30 kg beside a string of 6 m, 0.25 m off its fourth joint: the string bends and twists under it. */
static void body_beside_a_string(void **state)
{
    (void)state;
    rig s;
    dmb_body_def body = dmb_body_def_default();
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const double GJ = 2.1e11 / 2.6 * PI / 32.0 * (pow(pipe.outer_diameter, 4.0) - pow(pipe.inner_diameter, 4.0));
    const double arm[3] = {0.0, 0.25, 0.0};
    rig_open(&s, 0.0, 0.0, -9.81);
    const dmb_id string = add_free_string(&s, 0.0, 0.0, 6);
    const dmb_place root = dmb_station(string, 0, 0.0);
    const dmb_id clamp = add_joint_between(&s, DMB_JOINT_FIXED, ground(), root);
    body.mass = 30.0;
    body.position[0] = 4.0;
    body.position[1] = 0.25;
    const dmb_id side = add_body(&s, &body);
    const dmb_id weld = join_at(&s, DMB_JOINT_FIXED, dmb_station(string, 3, 1.0), arm, along_x, whole(side));
    (void)rig_start(&s, NULL);
    check_below("static iterations", rest(&s).iterations, 5.0);
    const dmb_joint_state w = joint_at(&s, weld);
    check_relative("its joint carries its weight", w.reaction[2], 30.0 * 9.81, 1e-10);
    check_below("and no moment", largest(3, w.reaction + 3), 1e-8);
    check_relative("twist of the string", rotation_at(&s, dmb_station(string, 3, 1.0)), -30.0 * 9.81 * 0.25 * 4.0 / GJ,
                   2e-3);
    check_below("ground against weight", imbalance(&s, &clamp, &root, 1, no_load), 1e-10);
    rig_close(&s);
}

/* ---- Centralisers ---------------------------------------------------------------------------------------------------
 */

enum { LONG = 100, SPACING = 5 };

/* Static iterations. */
static double rest_on_wall(const rig *s)
{
    dmb_static_options options = dmb_static_options_default();
    options.tolerance = 1e-12;
    const dmb_static_report report = find_equilibrium(s, &options);
    assert_int_equal(report.method, DMB_STATIC_NEWTON);
    return report.iterations;
}

static dmb_id open_long(rig *s, int centralised, dmb_id centraliser[LONG / SPACING])
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    wall.friction_law = DMB_FRICTION_NONE;
    (void)add_wall(s, &wall);
    def.start_free = DMB_FREE_NONE;
    pipe.string = add_string(s, &def);
    const dmb_id string = add_pipes(s, &pipe, LONG);
    for (uint32_t i = 0; centralised && i < LONG / SPACING; i++)
        centraliser[i] =
            add_joint_between(s, DMB_JOINT_POINT_ON_HOLE, ground(), dmb_station(string, SPACING * (i + 1) - 1, 1.0));
    (void)rig_start(s, NULL);
    return string;
}

/* Without centralisers the string lies on the low side; with them it hangs between as a beam clamped at both ends of
 * each span of 5 m, where the sag 1 m and 2 m from a centraliser is w x^2 (l - x)^2/(24 EI) + w x (l - x)/(2 GA), and
 * touches nothing. Both times all of the weight is carried. */
static void centralisers_hold_a_string_off_the_wall(void **state)
{
    (void)state;
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const double D = pipe.outer_diameter, d = pipe.inner_diameter, area = 0.25 * PI * (D * D - d * d);
    const double EI = 2.1e11 * PI / 64.0 * (D * D * D * D - d * d * d * d), GA = 0.5 * 2.1e11 / 2.6 * area;
    const double w = 7850.0 * 9.81 * area, weight = w * LONG;
    double reaction[6];
    dmb_id centraliser[LONG / SPACING];
    rig s;
    dmb_id string = open_long(&s, 0, centraliser);
    tell("without: static iterations", rest_on_wall(&s));
    must(&s, dmb_query_reaction(s.sim, string, reaction));
    check_relative("without: wall and support", contacts_of(&s).normal_force + reaction[2], weight, 1e-10);
    assert_int_equal(contacts_of(&s).closed, 95);
    rig_close(&s);
    string = open_long(&s, 1, centraliser);
    tell("with: static iterations", rest_on_wall(&s));
    must(&s, dmb_query_reaction(s.sim, string, reaction));
    double sum = reaction[2];
    for (uint32_t i = 0; i < LONG / SPACING; i++) sum += joint_at(&s, centraliser[i]).reaction[2];
    check_relative("with: centralisers and support", sum, weight, 1e-10);
    assert_int_equal(contacts_of(&s).closed, 0);
    check_relative("a centraliser in the middle", joint_at(&s, centraliser[4]).reaction[2], w * SPACING, 1e-6);
    for (uint32_t x = 1; x < 3; x++) {
        const double a = x * (SPACING - (double)x), want = w * a * a / (24.0 * EI) + 0.5 * w * a / GA;
        check_relative("sag between two", -pose_at(&s, dmb_station(string, 25 + x, 0.0)).displacement[2], want, 1e-5);
    }
    check_below("violation [m]", statistics_of(&s).violation, 1e-14);
    rig_close(&s);
}

/* ---- What is carried, also by more than it takes ----------------------------------------------------------------- */

enum { LEGS = 4 };

/* A plate on four spherical joints, 12 equations for 6 coordinates, with a load off its middle. Of all forces that
 * balance, those of least norm are linear in the place (x, y) of the leg: N (1/4 + x0 x/sum x^2 + y0 y/sum y^2). */
static void plate_on_four_legs(void **state)
{
    (void)state;
    const double leg[LEGS][2] = {{0.5, 0.3}, {0.5, -0.3}, {-0.5, 0.3}, {-0.5, -0.3}}, push = 200.0,
                 place[2] = {0.1, -0.05};
    const double load[6] = {0.0, 0.0, -push, -push * place[1], push * place[0], 0.0};
    rig s;
    dmb_body_def plate = dmb_body_def_default();
    dmb_load_def def = dmb_load_def_default();
    dmb_id joints[LEGS];
    double sum[3] = {0.0, 0.0, 0.0}, most = 0.0;
    rig_open(&s, 0.0, 0.0, -9.81);
    plate.mass = 20.0;
    const dmb_id body = add_body(&s, &plate);
    for (int i = 0; i < LEGS; i++) {
        const double at[3] = {leg[i][0], leg[i][1], 0.0};
        joints[i] = join_at(&s, DMB_JOINT_SPHERICAL, ground(), at, along_x, whole(body));
    }
    def.place = whole(body);
    def.force[2] = -push;
    def.moment[0] = load[3];
    def.moment[1] = load[4];
    (void)add_load(&s, &def);
    (void)rig_start(&s, NULL);
    assert_int_equal(statistics_of(&s).redundant, 6);
    check_below("static iterations", rest(&s).iterations, 2.0);
    const double weight = 20.0 * 9.81;
    for (int i = 0; i < LEGS; i++) {
        const dmb_joint_state joint = joint_at(&s, joints[i]);
        const double want = 0.25 * (weight + push) + push * (place[0] * leg[i][0] + place[1] * leg[i][1] / 0.36);
        most = fmax(most, fabs(joint.reaction[2] - want));
        sum[0] += joint.reaction[2];
        sum[1] += joint.reaction[2] * leg[i][1];
        sum[2] -= joint.reaction[2] * leg[i][0];
        most = fmax(most, fmax(fabs(joint.reaction[0]), fabs(joint.reaction[1])));
    }
    check_relative("sum of the legs", sum[0], weight + push, 1e-10);
    check_close("moment about x", sum[1], push * place[1], 1e-10 * push);
    check_close("moment about y", sum[2], -push * place[0], 1e-10 * push);
    check_below("each leg against least norm [N]", most, 1e-9);
    rig_close(&s);
}

/* A string of 6 m, clamped at one end twice over and at the other on a line and in a sleeve along it, with a load at
 * its middle: all that it carries goes to the ground, and the two clamps, which are alike, share it. */
static void string_held_twice(void **state)
{
    (void)state;
    rig s;
    const double end[3] = {6.0, 0.0, 0.0}, F[2] = {100.0, -500.0};
    dmb_load_def load = dmb_load_def_default();
    dmb_id joints[4];
    dmb_place at[4];
    rig_open(&s, 0.0, 0.0, -9.81);
    const dmb_id string = add_free_string(&s, 0.0, 0.0, 6);
    at[0] = at[1] = dmb_station(string, 0, 0.0);
    at[2] = at[3] = dmb_station(string, 5, 1.0);
    joints[0] = add_joint_between(&s, DMB_JOINT_FIXED, ground(), at[0]);
    joints[1] = add_joint_between(&s, DMB_JOINT_FIXED, ground(), at[1]);
    joints[2] = join_at(&s, DMB_JOINT_POINT_ON_LINE, ground(), end, along_x, at[2]);
    joints[3] = join_at(&s, DMB_JOINT_CYLINDRICAL, ground(), end, along_x, at[3]);
    load.place = dmb_station(string, 2, 1.0);
    load.force[1] = F[0];
    load.force[2] = F[1];
    (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    assert_int_equal(statistics_of(&s).redundant, 6 + 2);
    check_below("static iterations", rest(&s).iterations, 5.0);
    const dmb_pose middle = pose_at(&s, load.place);
    const double *r = middle.position;
    const double acts[6] = {0.0, F[0], F[1], r[1] * F[1] - r[2] * F[0], -r[0] * F[1], r[0] * F[0]};
    check_below("ground against weight and load", imbalance(&s, joints, at, 4, acts), 1e-10);
    const dmb_joint_state a = joint_at(&s, joints[0]), b = joint_at(&s, joints[1]);
    check_below("between the two clamps [N, N m]", largest_difference(6, a.reaction, b.reaction), 1e-9);
    rig_close(&s);
}

/* A pendulum without gravity whose torque jumps: what its hinge carries jumps with it, m c T/(I + m c^2). */
static void reaction_follows_a_load_that_jumps(void **state)
{
    (void)state;
    rig s;
    dmb_body_def body = dmb_body_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    body.mass = 2.0;
    body.centre[1] = 0.5;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.1;
    const dmb_id part = add_body(&s, &body), hinge = add_joint_between(&s, DMB_JOINT_REVOLUTE, ground(), whole(part));
    const dmb_id drive = add_simple_drive(&s, DMB_DRIVE_LOAD, hinge, DMB_RX, add_constant(&s, 0.0));
    (void)rig_start(&s, NULL);
    must(&s, dmb_sim_set_drive(s.sim, drive, 3.0));
    check_close("acceleration [rad/s2]", joint_at(&s, hinge).acceleration[DMB_RX], 3.0 / 0.6, 1e-12);
    check_close("force [N]", joint_at(&s, hinge).reaction[2], 2.0 * 0.5 * 3.0 / 0.6, 1e-12);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ring_closes_unstressed),
        cmocka_unit_test(ring_under_small_load),
        cmocka_unit_test(ring_against_its_quarter),
        cmocka_unit_test(ring_sways_under_a_large_push),
        cmocka_unit_test(ring_let_go),
        cmocka_unit_test(stiff_coupler_is_rigid),
        cmocka_unit_test(soft_coupler),
        cmocka_unit_test(universal_joint_of_two_shafts),
        cmocka_unit_test(universal_joints_in_a_curved_hole),
        cmocka_unit_test(two_strings_on_one_head),
        cmocka_unit_test(body_beside_a_string),
        cmocka_unit_test(centralisers_hold_a_string_off_the_wall),
        cmocka_unit_test(plate_on_four_legs),
        cmocka_unit_test(string_held_twice),
        cmocka_unit_test(reaction_follows_a_load_that_jumps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
