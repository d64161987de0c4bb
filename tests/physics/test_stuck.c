/* Places that are stuck: pull and twist against closed forms, the moment of the release against an independent solution
 * and its order, the wave after it against the d'Alembert solution, energy, snapshots, replay, and what is refused. */
#include <string.h>

#include "drillmbd/analyse.h"
#include "drillmbd/scene.h"
#include "mechanism.h"
#include "modal.h"

enum { PIPES = 10 };
static const double length = 100.0, area = 1e-3, modulus = 2e11, density = 7800.0;

/* A straight string along x without weight, free along and about its axis at the rig; loads there. */
typedef struct stuck_rig {
    rig s;
    dmb_id string, stuck, input, time_function;
} stuck_rig;

static dmb_pipe_def pipe_of(int32_t kind, uint32_t elements)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.kind = kind;
    pipe.elements = elements;
    pipe.length = length / PIPES;
    pipe.young_modulus = modulus;
    pipe.density = density;
    pipe.outer_diameter = 0.073;
    pipe.section_stiffness[0] = modulus * area;
    pipe.section_mass = density * area;
    return pipe;
}

static void add_pull(stuck_rig *r, double force, double torque, double ramp)
{
    dmb_load_def load = dmb_load_def_default();
    dmb_segment term = dmb_segment_default();
    const double times[2] = {0.0, 1.0}, values[2] = {0.0, ramp};
    load.place = dmb_station(r->string, 0, 0.0);
    load.force[0] = -force;
    load.moment[0] = torque;
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = times;
    term.table_value = values;
    term.table_count = 2;
    if (ramp > 0.0) must_model(&r->s, dmb_model_add_time_function(r->s.model, &term, 1, &load.time_function));
    must_model(&r->s, dmb_model_add_load(r->s.model, &load, NULL));
}

static stuck_rig describe(int32_t kind, uint32_t elements, const dmb_stuck_def *def)
{
    stuck_rig r;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = pipe_of(kind, elements);
    dmb_stuck_def stuck = *def;
    dmb_input_def input = dmb_input_def_default();
    memset(&r, 0, sizeof r);
    rig_open(&r.s, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    r.string = pipe.string = add_string(&r.s, &string);
    (void)add_pipes(&r.s, &pipe, PIPES);
    stuck.place = dmb_station(r.string, PIPES - 1, 1.0);
    must_model(&r.s, dmb_model_add_stuck(r.s.model, &stuck, &r.stuck));
    strcpy(input.name, "stuck");
    input.target = DMB_TARGET_STUCK;
    input.part = r.stuck;
    must_model(&r.s, dmb_model_add_input(r.s.model, &input, &r.input));
    return r;
}

static dmb_stuck_state state_of(const stuck_rig *r)
{
    dmb_stuck_state state = dmb_stuck_state_default();
    must(&r->s, dmb_query_stuck(r->s.sim, r->stuck, &state));
    return state;
}

static double output(const stuck_rig *r, int32_t quantity, dmb_place place)
{
    const dmb_output c = {.place = place, .quantity = quantity};
    double value = 0.0;
    must(&r->s, dmb_query_output(r->s.sim, &c, &value));
    return value;
}

static dmb_place top(const stuck_rig *r)
{
    return dmb_station(r->string, 0, 0.0);
}

static dmb_place end(const stuck_rig *r)
{
    return dmb_station(r->string, PIPES - 1, 1.0);
}

static dmb_place middle(const stuck_rig *r)
{
    return dmb_station(r->string, PIPES / 2, 0.0);
}

/* ---- Statics ----------------------------------------------------------------------------------------------------- */

static void pull_and_twist(int32_t kind)
{
    const double force = 1e5, torque = 2e3;
    dmb_stuck_def def = dmb_stuck_def_default();
    def.overpull = 1.0000001e5;
    def.overtorque = 2.0000001e3;
    stuck_rig r = describe(kind, 2, &def);
    const dmb_pipe_def pipe = pipe_of(kind, 2);
    const double d4 = pow(pipe.outer_diameter, 4) - pow(pipe.inner_diameter, 4);
    const double gj = modulus / 2.6 * PI / 32.0 * d4;
    add_pull(&r, force, torque, 0.0);
    (void)mechanism_start(&r.s, NULL);
    must(&r.s, dmb_analysis_static(r.s.sim, NULL, NULL));
    const dmb_stuck_state held = state_of(&r);
    check_relative("stretch of the stuck string, F L/EA + F/k", -output(&r, DMB_OUTPUT_DISPLACEMENT_X, top(&r)),
                   force * length / (modulus * area) + force / def.stiffness[0], 1e-9);
    check_relative("twist, T L/GJ + T/k", output(&r, DMB_OUTPUT_ROTATION, top(&r)),
                   torque * length / gj + torque / def.stiffness[1], 1e-9);
    check_relative("force that holds it", held.force[0], force, 1e-9);
    check_relative("torque that holds it", held.force[3], -torque, 1e-9);
    check_relative("share of what frees it", held.share, fmax(force / def.overpull, torque / def.overtorque), 1e-9);
    assert_true(output(&r, DMB_OUTPUT_STUCK, dmb_station(r.stuck, 0, 0.0)) > 0.5);
    rig_close(&r.s);
}

static void a_stuck_string_is_pulled_and_twisted(void **state)
{
    (void)state;
    pull_and_twist(DMB_PIPE_FLEXIBLE);
    pull_and_twist(DMB_PIPE_AXIAL_TORSIONAL);
}

static void statics_beyond_the_overpull_are_refused(void **state)
{
    dmb_stuck_def def = dmb_stuck_def_default();
    (void)state;
    def.overpull = 9.99e4;
    stuck_rig r = describe(DMB_PIPE_FLEXIBLE, 1, &def);
    add_pull(&r, 1e5, 0.0, 0.0);
    (void)mechanism_start(&r.s, NULL);
    assert_int_equal(dmb_analysis_static(r.s.sim, NULL, NULL), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(r.s.sim), "is released"));
    assert_int_equal(state_of(&r).stuck, 1);
    rig_close(&r.s);
}

/* ---- Release ----------------------------------------------------------------------------------------------------- */

/* A ball of mass 1 on the anchor's spring, pulled by a ramp F = rate t: k s = rate (t - sin(w t)/w) until F0; from
 * there it flies with s'' = rate t. */
typedef struct ball {
    dmb_id body, stuck;
    double release, position; /* [s, m] at 1 s */
    double balance, lost;     /* [J] */
} ball;

static const double rate = 30.0, spring = 400.0, limit = 8.0;

static ball fly(double step, int advance)
{
    dmb_sim_options options = sharp_options(1.0, 1e-12);
    dmb_body_def body = dmb_body_def_default();
    dmb_stuck_def def = dmb_stuck_def_default();
    dmb_event_def event = dmb_event_def_default();
    dmb_event_report report = dmb_event_report_default();
    dmb_segment term = dmb_segment_default();
    dmb_load_def load = dmb_load_def_default();
    const double times[2] = {0.0, 10.0}, values[2] = {0.0, 10.0 * rate};
    ball b;
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    b.body = add_body(&s, &body);
    def.place = load.place = dmb_station(b.body, 0, 0.0);
    def.stiffness[0] = spring;
    def.overpull = limit;
    must_model(&s, dmb_model_add_stuck(s.model, &def, &b.stuck));
    load.force[0] = 1.0;
    term.kind = DMB_SEGMENT_TABLE;
    term.table_time = times;
    term.table_value = values;
    term.table_count = 2;
    must_model(&s, dmb_model_add_time_function(s.model, &term, 1, &load.time_function));
    must_model(&s, dmb_model_add_load(s.model, &load, NULL));
    strcpy(event.name, "free");
    event.direction = DMB_EVENT_FALLING;
    event.level = 0.5;
    event.output.quantity = DMB_OUTPUT_STUCK;
    event.output.place = dmb_station(b.stuck, 0, 0.0);
    must_model(&s, dmb_model_add_event(s.model, &event, NULL));
    options.step_max = step;
    (void)mechanism_start(&s, &options);
    if (advance) {
        assert_int_equal(dmb_sim_advance_to_event(s.sim, 1.0, &report, NULL), DMB_NOTE_EVENT);
        b.release = dmb_sim_time(s.sim);
        must(&s, dmb_sim_advance(s.sim, 1.0, NULL));
    } else {
        b.release = 0.0;
        take_steps(&s, step, (uint32_t)lround(1.0 / step));
    }
    const dmb_energy e = energy_of(&s);
    b.balance = e.balance;
    b.lost = e.impact;
    b.position = pose_at(&s, load.place).displacement[0];
    rig_close(&s);
    return b;
}

static double release_time(double *speed)
{
    const double w = sqrt(spring);
    double t = limit / rate;
    for (int i = 0; i < 50; i++) t -= (rate * (t - sin(w * t) / w) - limit) / (rate * (1.0 - cos(w * t)));
    *speed = rate * (1.0 - cos(w * t)) / spring;
    return t;
}

static void it_lets_go_at_the_overpull(void **state)
{
    double speed;
    const double t = release_time(&speed), left = 1.0 - t;
    const double end_at =
        limit / spring + speed * left + rate * t * left * left / 2.0 + rate * left * left * left / 6.0;
    (void)state;
    const ball coarse = fly(0.0025, 0), fine = fly(0.00125, 0), told = fly(1e-4, 1);
    check_below("position after the release, steps of 1.25 ms [m]", fine.position - end_at, 4e-6);
    check_order("order over the release", fabs(coarse.position - end_at), fabs(fine.position - end_at), 2.0, 0.1);
    check_order("its energy balance", fabs(coarse.balance), fabs(fine.balance), 2.0, 0.2);
    check_relative("energy lost, F^2/(2 k)", fine.lost, limit * limit / (2.0 * spring), 1e-9);
    check_close("time of the release by an event [s]", told.release, t, 1e-7);
}

/* A joint that closes moves the stuck body by its gap, under tension: the energy that the anchor takes up is booked
 * with the impact. */
static void a_joint_closes_beside_it(void **state)
{
    const double pull = 1e5, stiffness = 1e8, gap = 5e-7;
    (void)state;
    for (int side = -1; side <= 1; side += 2) {
        dmb_sim_options options = sharp_options(1.0, 1e-12);
        dmb_body_def body = dmb_body_def_default();
        dmb_stuck_def def = dmb_stuck_def_default();
        dmb_load_def load = dmb_load_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        dmb_id closing;
        rig s;
        rig_open(&s, 0.0, 0.0, 0.0);
        joint.place_b = def.place = load.place = dmb_station(add_body(&s, &body), 0, 0.0);
        def.stiffness[0] = stiffness;
        must_model(&s, dmb_model_add_stuck(s.model, &def, NULL));
        load.force[0] = pull;
        must_model(&s, dmb_model_add_load(s.model, &load, NULL));
        joint.state = DMB_JOINT_OPEN;
        joint.origin_a[0] = pull / stiffness + side * gap;
        closing = add_joint(&s, &joint);
        (void)mechanism_start(&s, &options);
        (void)find_equilibrium(&s, NULL);
        take_steps(&s, 1e-4, 2);
        const dmb_energy before = energy_of(&s);
        must(&s, dmb_sim_set_joint(s.sim, closing, DMB_JOINT_ACTIVE));
        const dmb_energy after = energy_of(&s);
        check_close("energy booked with the move of a stuck body [J]", after.impact - before.impact, -side * pull * gap,
                    1e-3 * pull * gap);
        check_below("energy balance of the move [J]", fabs(after.balance - before.balance), 1e-6 * pull * gap);
        rig_close(&s);
    }
}

/* Held back to the rig by a support, pulled to F at the far end's anchor and set free by the input: until the wave is
 * back, the far end moves at F/(A sqrt(E rho)). */
static void a_wave_runs_up(void **state)
{
    const double c = sqrt(modulus / density), force = 5e4;
    dmb_stuck_def def = dmb_stuck_def_default();
    dmb_energy e;
    (void)state;
    def.stiffness[0] = 1e12;
    stuck_rig r = describe(DMB_PIPE_AXIAL_TORSIONAL, 32, &def);
    add_pull(&r, force, 0.0, 0.0);
    (void)mechanism_start(&r.s, NULL);
    must(&r.s, dmb_analysis_static(r.s.sim, NULL, NULL));
    const double before = output(&r, DMB_OUTPUT_DISPLACEMENT_X, end(&r));
    const double rest = output(&r, DMB_OUTPUT_DISPLACEMENT_X, middle(&r));
    must(&r.s, dmb_sim_set_input(r.s.sim, r.input, 0.0));
    take_steps(&r.s, length / c / 640.0, 640);
    /* The load at the rig goes on pulling: the wave of free ends, v = -F c/(E A) behind it. */
    const double moved = output(&r, DMB_OUTPUT_DISPLACEMENT_X, end(&r)) - before;
    check_relative("far end when the wave is at the rig, -F L/EA", moved, -force * length / (modulus * area), 2e-3);
    check_relative("middle, which it passed half way", output(&r, DMB_OUTPUT_DISPLACEMENT_X, middle(&r)) - rest,
                   -0.5 * force * length / (modulus * area), 2e-3);
    e = energy_of(&r.s);
    check_below("energy balance over that of the wave", e.balance / e.kinetic, 1e-3);
    rig_close(&r.s);
}

/* ---- State ------------------------------------------------------------------------------------------------------- */

static uint64_t hash_of(const stuck_rig *r)
{
    uint64_t hash = 0;
    must(&r->s, dmb_sim_hash(r->s.sim, &hash));
    return hash;
}

static stuck_rig pulled(double overpull, int start)
{
    dmb_stuck_def def = dmb_stuck_def_default();
    def.overpull = overpull;
    def.damping[0] = 1e4;
    stuck_rig r = describe(DMB_PIPE_FLEXIBLE, 1, &def);
    add_pull(&r, 1.0, 0.0, 1e5);
    if (start) (void)mechanism_start(&r.s, NULL);
    return r;
}

static void snapshots_and_logs_replay(void **state)
{
    static uint8_t block[1 << 20];
    dmb_input_record records[8];
    uint32_t next = 0;
    size_t size = 0;
    (void)state;
    stuck_rig r = pulled(3e4, 1), again = pulled(3e4, 1);
    must(&r.s, dmb_sim_record_inputs(r.s.sim, records, 8));
    take_steps(&r.s, 1e-3, 100);
    must(&r.s, dmb_sim_snapshot_size(r.s.sim, &size));
    assert_true(size <= sizeof block);
    must(&r.s, dmb_sim_snapshot(r.s.sim, block, size));
    take_steps(&r.s, 1e-3, 400);
    assert_int_equal(state_of(&r).stuck, 0); /* by itself */
    dmb_input_state input = dmb_input_state_default();
    must(&r.s, dmb_sim_get_input(r.s.sim, r.input, &input));
    assert_true(input.value < 0.5);
    must(&r.s, dmb_sim_set_input(r.s.sim, r.input, 1.0));
    assert_int_equal(state_of(&r).stuck, 1);
    assert_true(fabs(state_of(&r).offset[0]) < 1e-15); /* where it is now */
    take_steps(&r.s, 1e-3, 20);
    const uint64_t hash = hash_of(&r);
    for (int i = 0; i < 520; i++) {
        must(&again.s, dmb_sim_replay_inputs(again.s.sim, records, dmb_sim_recorded_inputs(r.s.sim), &next));
        take_steps(&again.s, 1e-3, 1);
    }
    assert_true(hash_of(&again) == hash);
    must(&r.s, dmb_sim_restore(r.s.sim, block, size));
    assert_int_equal(state_of(&r).stuck, 1);
    take_steps(&r.s, 1e-3, 400);
    must(&r.s, dmb_sim_set_input(r.s.sim, r.input, 1.0));
    take_steps(&r.s, 1e-3, 20);
    assert_true(hash_of(&r) == hash);
    rig_close(&r.s);
    rig_close(&again.s);
}

/* A rod more at the rig: what was free stays free, what was held stays where it got stuck; another point is refused. */
static void a_rod_more_leaves_it_stuck(void **state)
{
    (void)state;
    for (int32_t held = 0; held < 2; held++)
        for (uint32_t shift = 0; shift < 2; shift++) {
            stuck_rig r[2];
            for (int i = 0; i < 2; i++) {
                dmb_string_def string = dmb_string_def_default();
                dmb_stuck_def def = dmb_stuck_def_default();
                dmb_pipe_def pipe = pipe_of(DMB_PIPE_FLEXIBLE, 1);
                memset(&r[i], 0, sizeof r[i]);
                rig_open(&r[i].s, 0.0, 0.0, 0.0);
                string.follows_hole = 0;
                string.position[0] = i == 0 ? 10.0 : 0.0;
                string.start_free = DMB_FREE_X;
                r[i].string = pipe.string = add_string(&r[i].s, &string);
                (void)add_pipes(&r[i].s, &pipe, i == 0 ? 3 : 4);
                def.place = dmb_station(r[i].string, i == 0 || shift ? 2 : 3, 1.0);
                def.stuck = i == 0 ? held : !held;
                must_model(&r[i].s, dmb_model_add_stuck(r[i].s.model, &def, &r[i].stuck));
                add_pull(&r[i], i == 0 ? 5e4 : 0.0, 0.0, 0.0);
                (void)mechanism_start(&r[i].s, NULL);
            }
            if (held) must(&r[0].s, dmb_analysis_static(r[0].s.sim, NULL, NULL));
            const int32_t status = dmb_sim_transfer_state(r[1].s.sim, r[0].s.sim);
            assert_int_equal(status < 0, held && shift);
            if (status >= 0) {
                assert_int_equal(state_of(&r[1]).stuck, held);
                check_close("offset of the anchor after the transfer [m]", state_of(&r[1]).offset[0],
                            state_of(&r[0]).offset[0], 1e-13);
            }
            rig_close(&r[0].s);
            rig_close(&r[1].s);
        }
}

static void inputs_are_0_or_1(void **state)
{
    (void)state;
    stuck_rig r = pulled(3e4, 1);
    const uint64_t hash = hash_of(&r);
    const double nonsense[] = {0.5, -1.0, 2.0, (double)NAN, (double)INFINITY};
    for (size_t i = 0; i < sizeof nonsense / sizeof nonsense[0]; i++)
        assert_true(dmb_sim_set_input(r.s.sim, r.input, nonsense[i]) < 0);
    assert_true(hash_of(&r) == hash);
    rig_close(&r.s);
}

/* One that is not stuck changes nothing at all. */
static void one_that_is_free_is_not_there(void **state)
{
    dmb_stuck_def def = dmb_stuck_def_default();
    double position[2];
    (void)state;
    for (int with = 0; with < 2; with++) {
        def.stuck = 0;
        def.damping[0] = with ? 1e5 : 0.0;
        stuck_rig r = describe(DMB_PIPE_FLEXIBLE, 1, &def);
        add_pull(&r, 1e3, 50.0, 0.0);
        (void)mechanism_start(&r.s, NULL);
        take_steps(&r.s, 1e-3, 20);
        position[with] = output(&r, DMB_OUTPUT_DISPLACEMENT_X, end(&r));
        rig_close(&r.s);
    }
    assert_memory_equal(position, position + 1, sizeof(double));
}

/* ---- Analyses ---------------------------------------------------------------------------------------------------- */

/* A rod free at the rig and held at its far end: axial frequencies (2 n - 1) c/(4 L). */
static void modes_take_the_anchor(void **state)
{
    const double c = sqrt(modulus / density);
    dmb_stuck_def def = dmb_stuck_def_default();
    (void)state;
    def.stiffness[0] = 1e13;
    def.stiffness[1] = 1e13;
    stuck_rig r = describe(DMB_PIPE_AXIAL_TORSIONAL, 8, &def);
    (void)mechanism_start(&r.s, NULL);
    dmb_modes *modes = all_modes(&r.s, 0);
    double nearest = (double)INFINITY;
    const double want = c / (4.0 * length);
    for (uint32_t i = 0; i < info_of(modes).count; i++) {
        const double f = mode_at(modes, i).frequency;
        if (fabs(f - want) < fabs(nearest - want)) nearest = f;
    }
    check_relative("lowest axial frequency of the stuck string, c/(4 L)", nearest, want, 1e-5);
    assert_int_equal(info_of(modes).rigid, 0);
    dmb_modes_destroy(&modes);
    rig_close(&r.s);
}

static void sensitivities_end_at_the_release(void **state)
{
    dmb_stuck_def def = dmb_stuck_def_default();
    dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *made = NULL;
    dmb_output output = {.quantity = DMB_OUTPUT_DISPLACEMENT_X};
    rig s[3];
    (void)state;
    for (int i = 0; i < 3; i++) { /* the sim, low, high: the pull at a body */
        dmb_body_def body = dmb_body_def_default();
        dmb_load_def load = dmb_load_def_default();
        rig_open(&s[i], 0.0, 0.0, 0.0);
        def.place = load.place = dmb_station(add_body(&s[i], &body), 0, 0.0);
        if (i == 0) output.place = def.place;
        def.stiffness[0] = spring;
        def.overpull = limit;
        must_model(&s[i], dmb_model_add_stuck(s[i].model, &def, NULL));
        load.force[0] = 7.0 + 1e-6 * (i == 2) - 1e-6 * (i == 1);
        must_model(&s[i], dmb_model_add_load(s[i].model, &load, NULL));
        (void)mechanism_start(&s[i], NULL);
    }
    parameter.low = s[1].sim;
    parameter.high = s[2].sim;
    parameter.step = 1e-6;
    must(&s[0], dmb_sensitivity_create(s[0].sim, &parameter, 1, &made));
    int32_t status = DMB_OK;
    int steps = 0;
    double position = 0.0, by_pull = 0.0;
    for (; steps < 1000 && status >= 0; steps++) {
        status = dmb_sensitivity_step(made, 1e-3, NULL);
        if (steps == 40) must(&s[0], dmb_sensitivity_outputs(made, &output, 1, &position, &by_pull));
    }
    assert_int_equal(status, DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(s[0].sim), "is released"));
    check_relative("derivative while it holds, x/F", by_pull, position / 7.0, 1e-8);
    dmb_sensitivity_destroy(&made);
    for (int i = 0; i < 3; i++) rig_close(&s[i]);
}

static void sensitivities_need_the_same_places_stuck(void **state)
{
    dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *made = NULL;
    rig s[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        dmb_body_def body = dmb_body_def_default();
        dmb_stuck_def def = dmb_stuck_def_default();
        rig_open(&s[i], 0.0, 0.0, 0.0);
        def.place = dmb_station(add_body(&s[i], &body), 0, 0.0);
        def.stuck = i;
        must_model(&s[i], dmb_model_add_stuck(s[i].model, &def, NULL));
        (void)mechanism_start(&s[i], NULL);
    }
    parameter.low = s[0].sim;
    parameter.high = s[1].sim;
    parameter.step = 1e-6;
    assert_int_equal(dmb_sensitivity_create(s[0].sim, &parameter, 1, &made), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s[0].sim), "stuck"));
    for (int i = 0; i < 2; i++) rig_close(&s[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stuck_string_is_pulled_and_twisted),
        cmocka_unit_test(statics_beyond_the_overpull_are_refused),
        cmocka_unit_test(it_lets_go_at_the_overpull),
        cmocka_unit_test(a_joint_closes_beside_it),
        cmocka_unit_test(a_wave_runs_up),
        cmocka_unit_test(snapshots_and_logs_replay),
        cmocka_unit_test(a_rod_more_leaves_it_stuck),
        cmocka_unit_test(inputs_are_0_or_1),
        cmocka_unit_test(one_that_is_free_is_not_there),
        cmocka_unit_test(modes_take_the_anchor),
        cmocka_unit_test(sensitivities_end_at_the_release),
        cmocka_unit_test(sensitivities_need_the_same_places_stuck),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
