/* Friction of the caller on the wall (DMB_FRICTION_CALLBACK): the library's bristles written again give the same run at
 * nodes, along elements, on axial-torsional pipes, in sections of the hole, through transfers and in statics; a LuGre
 * law is of second order; a loop dissipates as its closed form; the state in snapshots and failing steps; refusals. */
#include <stdlib.h>
#include <string.h>

#include "mechanism.h"
#include "ode.h"

#define STIFFNESS 1e4
#define DAMPING 2e-3

typedef struct law {
    uint32_t asked, fail_at; /* calls, and the one that fails; 0: none */
    uint32_t told;
    double stretch; /* [m] largest that accept was called with */
} law;

static void hear(void *context, double time, uint32_t number, const double *state)
{
    law *o = context;
    (void)time, (void)number;
    o->told++;
    o->stretch = fmax(o->stretch, fabs(state[0]));
}

/* Brings x onto the circle with its derivative d by slip; 1: it was outside. */
static int onto_circle(double x[2], double d[4], double limit)
{
    const double length = sqrt(x[0] * x[0] + x[1] * x[1]);
    if (!(length > limit)) return 0;
    const double e[2] = {x[0] / length, x[1] / length}, ratio = limit / length;
    for (int j = 0; j < 2; j++) {
        const double along = e[0] * d[j] + e[1] * d[2 + j];
        for (int i = 0; i < 2; i++) d[2 * i + j] = ratio * (d[2 * i + j] - e[i] * along);
    }
    for (int i = 0; i < 2; i++) x[i] = limit * e[i];
    return 1;
}

/* Bristles of eq:friction.bristle with mu_static = mu_dynamic, of which sliding on and on is Coulomb friction. */
static int32_t bristles(void *context, const dmb_friction_at *at, double force[2], double by_slip[4],
                        double by_normal[2], const dmb_law_memory *memory)
{
    law *o = context;
    const double N = at->normal_force, mu = at->mu_dynamic, *v = at->slip, h = memory->step;
    double q[2], d[4] = {0.5 * h, 0.0, 0.0, 0.5 * h}, *z = memory->trial;
    o->asked++;
    if (isinf(h)) {
        const double speed = sqrt(v[0] * v[0] + v[1] * v[1]);
        for (int i = 0; i < 2; i++) z[i] = speed > 0.0 ? (1.0 + 1e-9) * mu / STIFFNESS * v[i] / speed : 0.0;
        for (int i = 0; i < 2; i++) by_normal[i] = speed > 0.0 ? -mu * v[i] / speed : 0.0;
        for (int i = 0; i < 2; i++) force[i] = N * by_normal[i];
        for (int i = 0; i < 4 && speed > 0.0; i++)
            by_slip[i] = -N * mu / speed * ((i % 3 == 0) - v[i / 2] * v[i % 2] / (speed * speed));
        return 0;
    }
    for (int i = 0; i < 2; i++) z[i] = memory->accepted[i] + 0.5 * h * (at->slip_before[i] + v[i]);
    (void)onto_circle(z, d, mu / STIFFNESS);
    for (int i = 0; i < 2; i++) q[i] = STIFFNESS * z[i];
    for (int i = 0; i < 4; i++) d[i] *= STIFFNESS;
    for (int i = 0; i < 2; i++) q[i] += DAMPING * v[i];
    d[0] += DAMPING;
    d[3] += DAMPING;
    (void)onto_circle(q, d, mu);
    for (int i = 0; i < 2; i++) by_normal[i] = -q[i], force[i] = -N * q[i];
    for (int i = 0; i < 4; i++) by_slip[i] = -N * d[i];
    return o->asked == o->fail_at;
}

/* ---- The bristles of the library --------------------------------------------------------------------------------- */

enum { AT_NODES, ALONG_ELEMENTS, AXIAL_TORSIONAL, IN_SECTIONS, IN_A_CURVE, SCENES };

static dmb_place middle;
static double steady_pull;      /* [m/s] of the rig end; 0: to and fro */
static dmb_friction_fn own_law; /* NULL: bristles */
static int32_t features = DMB_FEATURE_ALL;

/* Pipes on the wall that are pulled to and fro and turned by their rig end. law NULL: the library's. */
static rig string_in_hole(int scene, law *o, uint32_t pipes)
{
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    dmb_wall_def wall = s1_hole();
    wall.friction_law = o != NULL ? DMB_FRICTION_CALLBACK : DMB_FRICTION_BRISTLE;
    wall.mu_static = wall.mu_dynamic = 0.3;
    wall.bristle_stiffness = STIFFNESS;
    wall.bristle_damping = DAMPING;
    wall.friction_callback = o == NULL ? NULL : own_law != NULL ? own_law : bristles;
    wall.friction_context = o;
    wall.friction_state_count = o != NULL ? 2 : 0;
    wall.friction_accept = o != NULL ? hear : NULL;
    const double bend = scene == IN_A_CURVE ? 0.012 : 0.3; /* straight pipes have room in the curve */
    const double survey[6] = {0.0, 0.5 * PI, 0.0, 60.0, 0.5 * PI - bend, 0.0};
    if (scene == AXIAL_TORSIONAL || scene == IN_A_CURVE) wall.survey_count = 2, wall.survey = survey;
    (void)add_wall(&s, &wall);
    dmb_hole_section section = dmb_hole_section_default();
    section.depth = 2.0;
    section.mu_static = section.mu_dynamic = 0.2;
    if (scene == IN_SECTIONS) must_model(&s, dmb_model_add_hole_sections(s.model, &section, 1));
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    string.start_free = DMB_FREE_CYLINDRICAL;
    if (scene != AXIAL_TORSIONAL) string.offset[1] = -0.0105;
    string.name[0] = 's';
    pipe.string = add_string(&s, &string);
    pipe.damping_time = 1e-4;
    if (scene == AXIAL_TORSIONAL) pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    if (scene == ALONG_ELEMENTS || scene == IN_A_CURVE) pipe.contact_points = 3;
    (void)add_pipes(&s, &pipe, pipes);
    dmb_segment pull = dmb_segment_default(), turn = pull;
    pull.kind = turn.kind = DMB_SEGMENT_HARMONIC;
    pull.h0 = steady_pull;
    pull.h1 = steady_pull != 0.0 ? 0.0 : 0.05;
    turn.h1 = steady_pull != 0.0 ? 0.0 : 1.0;
    pull.omega = 15.0;
    turn.omega = 11.0;
    dmb_drive_def drive = dmb_drive_def_default();
    drive.part = pipe.string;
    drive.time_function = add_time_function(&s, &pull, 1);
    (void)add_drive(&s, &drive);
    drive.component = DMB_RX;
    drive.time_function = add_time_function(&s, &turn, 1);
    (void)add_drive(&s, &drive);
    dmb_compile_options compile = dmb_compile_options_default();
    compile.features = features;
    (void)rig_start_with(&s, &compile, NULL);
    middle = dmb_station(pipe.string, pipes - 1, 0.5);
    return s;
}

static double far_from(const rig *a, dmb_place at, const rig *b, dmb_place to)
{
    const dmb_motion x = motion_at(a, at, DMB_FRAME_BODY), y = motion_at(b, to, DMB_FRAME_BODY);
    const dmb_energy e = energy_of(a), f = energy_of(b);
    return largest_difference(6, x.velocity, y.velocity) + fabs(e.friction - f.friction) / (1.0 + fabs(f.friction));
}

static void the_bristles_written_again(void **state)
{
    static const char *const what[SCENES] = {"at nodes", "along elements", "axial-torsional", "in sections",
                                             "in a curve"};
    (void)state;
    for (int scene = 0; scene < SCENES; scene++) {
        law o = {0};
        double worst = 0.0;
        rig built = string_in_hole(scene, NULL, 4);
        const dmb_place at = middle;
        rig again = string_in_hole(scene, &o, 4);
        for (int i = 0; i < 300; i++) {
            take_divided_steps(&built, 1e-3, 1);
            take_divided_steps(&again, 1e-3, 1);
            worst = fmax(worst, far_from(&built, at, &again, middle));
        }
        check_below(what[scene], worst, 1e-12);
        assert_true(energy_of(&again).friction > 1e-3 && o.stretch > 0.5 * 0.2 / STIFFNESS);
        rig_close(&built);
        rig_close(&again);
    }
}

/* A pipe more at the rig end: both continue alike. */
static void it_is_transferred(void **state)
{
    (void)state;
    law o = {0}, p = {0};
    rig built = string_in_hole(AT_NODES, NULL, 3), again = string_in_hole(AT_NODES, &o, 3);
    rig longer = string_in_hole(AT_NODES, NULL, 4);
    const dmb_place at = middle;
    rig other = string_in_hole(AT_NODES, &p, 4);
    take_divided_steps(&built, 1e-3, 60);
    take_divided_steps(&again, 1e-3, 60);
    assert_true(dmb_sim_transfer_state(longer.sim, built.sim) >= 0);
    assert_true(dmb_sim_transfer_state(other.sim, again.sim) >= 0);
    take_divided_steps(&longer, 1e-3, 60);
    take_divided_steps(&other, 1e-3, 60);
    check_below("after a transfer", far_from(&longer, at, &other, middle), 1e-11);
    assert_true(dmb_sim_transfer_state(other.sim, built.sim) < 0); /* another law */
    rig_close(&built);
    rig_close(&again);
    rig_close(&longer);
    rig_close(&other);
}

/* Statics that slip ask for sliding on and on. */
static void statics_slide(void **state)
{
    (void)state;
    for (int scene = 0; scene < SCENES; scene++) {
        law o = {0};
        rig built = string_in_hole(scene, NULL, 4);
        const dmb_place at = middle;
        rig again = string_in_hole(scene, &o, 4);
        dmb_static_options options = dmb_static_options_default();
        options.slip_axial = 0.1;
        options.slip_rotation = 1.0;
        (void)find_equilibrium(&built, &options);
        (void)find_equilibrium(&again, &options);
        const dmb_pose x = pose_at(&built, at), y = pose_at(&again, middle);
        check_below("static pose with slip [m]", largest_difference(3, x.position, y.position), 1e-7);
        rig_close(&built);
        rig_close(&again);
    }
}

/* A law whose state is its force [N] at once, with the rate of bristles: in sliding mu N. */
static int32_t force_as_state(void *context, const dmb_friction_at *at, double force[2], double by_slip[4],
                              double by_normal[2], const dmb_law_memory *memory)
{
    const double N = at->normal_force, mu = 0.3, *v = at->slip, h = memory->step;
    const double speed = sqrt(v[0] * v[0] + v[1] * v[1]);
    (void)context;
    for (int i = 0; i < 2; i++) {
        double *s = memory->trial + i;
        if (isinf(h)) {
            *s = speed > 0.0 ? mu * N * v[i] / speed : 0.0;
            by_normal[i] = speed > 0.0 ? -mu * v[i] / speed : 0.0;
        } else if (h > 0.0 && N > 0.0) { /* backward Euler of N sigma0 v - sigma0 |v|/mu s; by_slip is left at 0 */
            *s = (memory->accepted[i] + h * N * STIFFNESS * v[i]) / (1.0 + h * STIFFNESS * speed / mu);
        }
        force[i] = -*s;
        (void)by_slip;
    }
    return 0;
}

/* After a steady state the state of the law is that of sliding at the normal force of each point. */
static void sliding_has_its_normal_force(void **state)
{
    (void)state;
    own_law = force_as_state;
    steady_pull = 0.05;
    for (int scene = 0; scene < SCENES; scene++) {
        law o = {0};
        uint32_t closed = 0;
        rig s = string_in_hole(scene, &o, 4);
        const dmb_static_options options = dmb_static_options_default();
        const dmb_static_report report = find_equilibrium(&s, &options);
        assert_int_equal(report.steady, DMB_STEADY_SLIDING);
        dmb_contact contact = dmb_contact_default();
        for (uint32_t i = 0; dmb_query_contact(s.sim, i, &contact) >= 0; i++) {
            if (!(contact.normal_force > 1.0)) continue;
            check_relative("friction in steady sliding [N]", contact.friction[0], -0.3 * contact.normal_force, 1e-6);
            closed++;
        }
        assert_true(closed > 2);
        rig_close(&s);
    }
    own_law = NULL;
    steady_pull = 0.0;
}

/* [-] Calls of a law at a normal force of 1 N, which no contact point has. */
static uint32_t asked_at_one;

static int32_t at_its_normal_force(void *context, const dmb_friction_at *at, double force[2], double by_slip[4],
                                   double by_normal[2], const dmb_law_memory *memory)
{
    asked_at_one += at->normal_force == 1.0;
    return bristles(context, at, force, by_slip, by_normal, memory);
}

/* The stability of a static state with slip is that of friction at the normal force of each point: a law of the caller
 * need not be proportional to it. */
static void stability_has_its_normal_force(void **state)
{
    (void)state;
    own_law = at_its_normal_force;
    for (int scene = 0; scene < SCENES; scene++) {
        law o = {0};
        rig s = string_in_hole(scene, &o, 4);
        dmb_static_options options = dmb_static_options_default();
        options.slip_axial = 0.1;
        options.slip_rotation = 1.0;
        asked_at_one = 0;
        (void)find_equilibrium(&s, &options);
        assert_int_equal(asked_at_one, 0);
        rig_close(&s);
    }
    own_law = NULL;
}

/* A law that fails in a query fails the query. */
static void queries_fail_with_the_law(void **state)
{
    (void)state;
    for (int scene = 0; scene < SCENES; scene++) {
        law o = {0};
        dmb_contact contact = dmb_contact_default();
        dmb_contact_total total = dmb_contact_total_default();
        rig s = string_in_hole(scene, &o, 3);
        take_divided_steps(&s, 1e-3, 20);
        const uint64_t then = rig_hash(&s);
        for (uint32_t i = 0; i < 1000 && !contact.closed; i++) must(&s, dmb_query_contact(s.sim, i, &contact));
        assert_true(contact.closed && isfinite(contact.friction[0]));
        o.fail_at = o.asked + 1;
        assert_int_equal(dmb_query_contact(s.sim, contact.number, &contact), DMB_ERR_CALLBACK);
        o.fail_at = o.asked + 1;
        assert_int_equal(dmb_query_contact_total(s.sim, &total), DMB_ERR_CALLBACK);
        assert_true(total.closed == 0 && rig_hash(&s) == then);
        must(&s, dmb_query_contact_total(s.sim, &total));
        rig_close(&s);
    }
}

/* Without friction in the mesh neither function of the law is called. */
static void a_mesh_without_friction_calls_nothing(void **state)
{
    (void)state;
    law o = {0};
    features = DMB_FEATURE_ALL & ~DMB_FEATURE_FRICTION;
    rig s = string_in_hole(AT_NODES, &o, 3);
    take_divided_steps(&s, 1e-3, 5);
    assert_true(o.asked == 0 && o.told == 0);
    rig_close(&s);
    features = DMB_FEATURE_ALL;
}

static void the_state_is_saved(void **state)
{
    (void)state;
    for (int scene = 0; scene < SCENES; scene++) {
        law o = {0};
        size_t size = 0;
        rig s = string_in_hole(scene, &o, 3);
        take_divided_steps(&s, 1e-3, 40);
        must(&s, dmb_sim_snapshot_size(s.sim, &size));
        void *saved = malloc(size);
        must(&s, dmb_sim_snapshot(s.sim, saved, size));
        const uint64_t then = rig_hash(&s);
        for (uint32_t k = 0; k < 3; k++) { /* a step that fails changes nothing, and the message names the law */
            const uint32_t told = o.told;
            o.fail_at = o.asked + 1 + 3 * k;
            assert_int_equal(dmb_sim_step(s.sim, 1e-3, NULL), DMB_ERR_CALLBACK);
            assert_non_null(strstr(dmb_sim_message(s.sim), "friction_callback"));
            assert_true(rig_hash(&s) == then && o.told == told);
        }
        o.fail_at = 0;
        take_divided_steps(&s, 1e-3, 40);
        const uint64_t end = rig_hash(&s);
        must(&s, dmb_sim_restore(s.sim, saved, size));
        take_divided_steps(&s, 1e-3, 40);
        assert_true(rig_hash(&s) == end);
        free(saved);
        rig_close(&s);
    }
}

/* ---- A ring on the floor of a hole: normal force m g ------------------------------------------------------------- */

#define MASS 10.0
#define WEIGHT (MASS * 9.81)

static dmb_id ring;

static rig ring_on_floor(const dmb_wall_def *friction, int32_t kind, const dmb_segment *along)
{
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    dmb_wall_def wall = s1_hole();
    dmb_body_def body = dmb_body_def_default();
    wall.normal_law = DMB_NORMAL_KELVIN_VOIGT;
    wall.friction_law = friction->friction_law;
    wall.mu_static = wall.mu_dynamic = friction->mu_dynamic;
    wall.bristle_stiffness = friction->bristle_stiffness;
    wall.friction_callback = friction->friction_callback;
    wall.friction_context = friction->friction_context;
    wall.friction_state_count = friction->friction_state_count;
    (void)add_wall(&s, &wall);
    body.mass = MASS;
    body.contact_diameter = 0.074;
    body.position[0] = 1.0;
    body.position[2] = -0.01 - WEIGHT / wall.stiffness;
    body.free_mask = DMB_FREE_X | DMB_FREE_Z;
    ring = add_body(&s, &body);
    (void)add_simple_drive(&s, kind, ring, DMB_X, add_time_function(&s, along, 1));
    const dmb_sim_options options = sharp_options(0.9, 1e-12);
    (void)rig_start(&s, &options);
    return s;
}

/* Moved to and fro by a, bristles without damping take 4 mu N (a - mu/sigma0) a cycle. */
static void a_loop_dissipates(void **state)
{
    (void)state;
    law o = {0};
    const double a = 1e-3, mu = 0.3;
    dmb_segment speed = dmb_segment_default();
    speed.kind = DMB_SEGMENT_HARMONIC;
    speed.omega = 2.0 * PI;
    speed.h1 = a * speed.omega;
    speed.phase = 0.5 * PI;
    const dmb_wall_def wall = {.friction_law = DMB_FRICTION_CALLBACK,
                               .mu_dynamic = mu,
                               .bristle_stiffness = STIFFNESS,
                               .friction_callback = bristles,
                               .friction_context = &o,
                               .friction_state_count = 2};
    rig s = ring_on_floor(&wall, DMB_DRIVE_MOTION, &speed);
    take_steps(&s, 1e-3, 1000);
    const double before = energy_of(&s).friction;
    take_steps(&s, 1e-3, 1000);
    const double taken = 4.0 * mu * WEIGHT * (a - mu / STIFFNESS);
    check_relative("work of a loop [J], DAMPING included in sticking", energy_of(&s).friction - before, taken, 2e-3);
    rig_close(&s);
}

static double limit_of(double v)
{
    return 0.2 + 0.1 * exp(-v * v / 1e-2);
}

static double bristle_rate(double v, double z)
{
    return v - STIFFNESS * fabs(v) * z / limit_of(v);
}

/* LuGre along the hole by the trapezoidal rule, over the normal force. */
static int32_t lugre(void *context, const dmb_friction_at *at, double force[2], double by_slip[4], double by_normal[2],
                     const dmb_law_memory *memory)
{
    const double v = at->slip[0], g = limit_of(v), h = memory->step, z0 = memory->accepted[0];
    const double r = STIFFNESS * fabs(v) / g, over = 1.0 + 0.5 * h * r;
    const double slope = -v / 1e-2 * 2.0 * (g - 0.2), r_v = STIFFNESS * ((v > 0.0) - (v < 0.0)) / g - r * slope / g;
    (void)context;
    const double z = (z0 + 0.5 * h * (bristle_rate(at->slip_before[0], z0) + v)) / over;
    memory->trial[0] = z;
    by_normal[0] = -(STIFFNESS * z + 30.0 / WEIGHT * bristle_rate(v, z));
    force[0] = at->normal_force * by_normal[0];
    const double z_v = 0.5 * h * (1.0 - r_v * z) / over;
    by_slip[0] = -at->normal_force * ((STIFFNESS - 30.0 / WEIGHT * r) * z_v + 30.0 / WEIGHT * (1.0 - r_v * z));
    return 0;
}

static void ring_rate(void *context, double t, const double *y, double *rate)
{
    (void)context;
    const double z_rate = bristle_rate(y[1], y[2]);
    rate[0] = y[1];
    rate[1] = (35.0 * sin(40.0 * t) - WEIGHT * STIFFNESS * y[2] - 30.0 * z_rate) / MASS;
    rate[2] = z_rate;
}

static void lugre_is_of_second_order(void **state)
{
    double error[3], y[3] = {0.0, 0.0, 0.0};
    (void)state;
    dmb_segment load = dmb_segment_default();
    load.kind = DMB_SEGMENT_HARMONIC;
    load.h1 = 35.0;
    load.omega = 40.0;
    ode_solve(ring_rate, NULL, 0.0, 0.05, 6000, 3, y); /* before the speed changes its sign, where |v| has a kink */
    assert_true(y[1] > 1e-3);
    for (int n = 0; n < 3; n++) {
        const dmb_wall_def wall = {.friction_law = DMB_FRICTION_CALLBACK,
                                   .bristle_stiffness = STIFFNESS,
                                   .friction_callback = lugre,
                                   .friction_state_count = 1};
        rig s = ring_on_floor(&wall, DMB_DRIVE_LOAD, &load);
        const uint32_t steps = 200u << n;
        take_steps(&s, 0.05 / steps, steps);
        error[n] = fabs(dmb_sim_value(s.sim, DMB_OUTPUT_DISPLACEMENT_X, dmb_station(ring, 0, 0.0)) - y[0]);
        rig_close(&s);
    }
    check_order("LuGre of one's own on the wall", error[1], error[2], 2.0, 0.3);
}

static void what_is_refused(void **state)
{
    (void)state;
    law o = {0};
    size_t size = 0;
    dmb_state_equation *equation = NULL;
    rig s = string_in_hole(AT_NODES, &o, 2);
    assert_int_equal(dmb_state_equation_create(s.sim, &equation), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(s.sim), "DMB_FRICTION_CALLBACK"));
    assert_int_equal(dmb_model_write(s.model, NULL, 0, &size), DMB_ERR_UNSUPPORTED);
    rig_close(&s);
    rig_open(&s, 0.0, 0.0, 0.0);
    dmb_wall_def wall = dmb_wall_def_default();
    wall.friction_law = DMB_FRICTION_CALLBACK;
    assert_int_equal(dmb_model_add_wall(s.model, &wall, NULL), DMB_ERR_NULL);
    wall.friction_callback = bristles;
    wall.friction_state_count = 17;
    assert_int_equal(dmb_model_add_wall(s.model, &wall, NULL), DMB_ERR_VALUE);
    wall.friction_state_count = 1;
    wall.friction_law = DMB_FRICTION_STRIBECK;
    assert_int_equal(dmb_model_add_wall(s.model, &wall, NULL), DMB_ERR_NULL);
    wall.friction_callback = NULL;
    wall.friction_state_count = 0;
    wall.friction_accept = hear;
    assert_int_equal(dmb_model_add_wall(s.model, &wall, NULL), DMB_ERR_UNSUPPORTED);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bristles_written_again),
        cmocka_unit_test(it_is_transferred),
        cmocka_unit_test(statics_slide),
        cmocka_unit_test(the_state_is_saved),
        cmocka_unit_test(sliding_has_its_normal_force),
        cmocka_unit_test(stability_has_its_normal_force),
        cmocka_unit_test(queries_fail_with_the_law),
        cmocka_unit_test(a_mesh_without_friction_calls_nothing),
        cmocka_unit_test(a_loop_dissipates),
        cmocka_unit_test(lugre_is_of_second_order),
        cmocka_unit_test(what_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
