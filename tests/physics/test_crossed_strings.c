/* Reamers, mud that flows and subs crossed with analyses: steady drilling against the rock law in closed form, state
 * transfer against the run that went on, derivatives against differences of whole runs, responses against loads typed
 * by hand, events against the closed form, buckling and bounded work of a sub against the scene without or typed by
 * hand; all through snapshots to the same hash. */
#include <stdlib.h>
#include <string.h>

#include "drillmbd/scene.h"
#include "modal.h"
#include "rock.h"

static void go_on_from_a_snapshot(const rig *s, const dmb_sim_options *options, double h, uint32_t steps)
{
    rig other = {s->model, NULL};
    size_t size = 0;
    must(s, dmb_sim_snapshot_size(s->sim, &size));
    void *bytes = malloc(size);
    must(s, dmb_sim_snapshot(s->sim, bytes, size));
    must_model(s, dmb_sim_create(s->model, options, &other.sim));
    must(s, dmb_sim_restore(other.sim, bytes, size));
    take_divided_steps(s, h, steps);
    take_divided_steps(&other, h, steps);
    assert_true(rig_hash(&other) == rig_hash(s));
    free(bytes);
    dmb_sim_destroy(&other.sim);
}

static double output_value(const rig *s, dmb_place place, int32_t quantity)
{
    const dmb_output reading = {.place = place, .quantity = quantity};
    double value = 0.0;
    must(s, dmb_query_output(s->sim, &reading, &value));
    return value;
}

/* ---- A reamer ---------------------------------------------------------------------------------------------------- */

static const double feed = 2e-3, spin = 10.0, pilot = 0.0475, gauge = 0.075;

typedef struct drilling {
    rig s;
    dmb_id string, bit, reamer;
} drilling;

typedef struct drilled {
    double energy; /* [Pa] of the reamer's rock */
    uint32_t pipes;
    int32_t law;
} drilled;

static dmb_bit_def cutting(int32_t law, double outer, double inner, double energy)
{
    dmb_bit_def bit = dmb_bit_def_default();
    bit.rock_law = law;
    bit.radius = outer;
    bit.inner_radius = inner;
    bit.intrinsic_energy = energy;
    bit.cutting_ratio = 0.6;
    bit.contact_strength = 2e7;
    bit.wear_length = 1e-3;
    bit.diameter = 0.0;
    return bit;
}

/* Begins where the far end is at 15 m. */
static drilling drill(const drilled *w)
{
    drilling d;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    rig_open(&d.s, 0.0, 0.0, 0.0);
    wall.diameter = 0.16;
    wall.normal_law = DMB_NORMAL_NONE;
    add_wall(&d.s, &wall);
    string.follows_hole = 0;
    string.position[0] = 15.0 - 5.0 * w->pipes;
    d.string = pipe.string = ring.string = add_string(&d.s, &string);
    pipe.length = 5.0;
    pipe.damping_time = 1e-3;
    add_pipes(&d.s, &pipe, w->pipes);
    ring.pipe = w->pipes - 2;
    ring.fraction = 0.7;
    ring.outer_diameter = 2.0 * gauge;
    dmb_id on_ring;
    must_model(&d.s, dmb_model_add_stabiliser(d.s.model, &ring, &on_ring));
    dmb_bit_def bit = cutting(w->law, pilot, 0.0, 2e7), reamer = cutting(w->law, gauge, pilot, w->energy);
    bit.string = reamer.string = d.string;
    reamer.stabiliser = on_ring;
    must_model(&d.s, dmb_model_add_bit(d.s.model, &bit, &d.bit));
    must_model(&d.s, dmb_model_add_bit(d.s.model, &reamer, &d.reamer));
    add_simple_drive(&d.s, DMB_DRIVE_MOTION, d.string, DMB_X, add_constant(&d.s, feed));
    add_simple_drive(&d.s, DMB_DRIVE_MOTION, d.string, DMB_RX, add_constant(&d.s, spin));
    rig_start(&d.s, NULL);
    return d;
}

static dmb_bit_state bit_of(const drilling *d, dmb_id id)
{
    dmb_bit_state bit = dmb_bit_state_default();
    must(&d->s, dmb_query_bit(d->s.sim, id, &bit));
    return bit;
}

static void drills_steadily(void **state)
{
    (void)state;
    const drilled w = {1e7, 3, DMB_ROCK_RATE};
    const double cut = 2.0 * PI * feed / spin;
    const dmb_bit_def bit = cutting(w.law, pilot, 0.0, 2e7), reamer = cutting(w.law, gauge, pilot, w.energy);
    drilling d = drill(&w);
    dmb_static_options options = dmb_static_options_default();
    options.steady = DMB_STEADY_SLIDING;
    const dmb_static_report report = find_equilibrium(&d.s, &options);
    assert_int_equal(report.steady, DMB_STEADY_SLIDING);
    for (int later = 0; later < 2; later++) { /* the run goes on in that state */
        check_relative("weight on the bit [N]", bit_of(&d, d.bit).weight, weight_at(&bit, cut), 1e-6);
        check_relative("weight on the reamer [N]", bit_of(&d, d.reamer).weight, weight_at(&reamer, cut), 1e-6);
        check_relative("torque on the reamer [N m]", bit_of(&d, d.reamer).torque, torque_at(&reamer, cut), 1e-6);
        if (!later) take_divided_steps(&d.s, 1e-3, 200);
    }
    go_on_from_a_snapshot(&d.s, NULL, 1e-3, 50);
    rig_close(&d.s);
}

/* A pipe more at the rig, at once taken off again: the same numbers as in the run that never stopped. */
static void is_transferred(void **state)
{
    (void)state;
    const int32_t laws[2] = {DMB_ROCK_RATE, DMB_ROCK_REGENERATIVE};
    for (int k = 0; k < 2; k++) {
        const drilled three = {1e7, 3, laws[k]}, four = {1e7, 4, laws[k]};
        drilling run = drill(&three), longer = drill(&four), back = drill(&three);
        take_divided_steps(&run.s, 1e-3, 400);
        const double weight = bit_of(&run, run.reamer).weight, bottom = bit_of(&run, run.reamer).bottom;
        must(&longer.s, dmb_sim_transfer_state(longer.s.sim, run.s.sim));
        check_relative("weight on the reamer, a pipe more [N]", bit_of(&longer, longer.reamer).weight, weight, 1e-9);
        must(&back.s, dmb_sim_transfer_state(back.s.sim, longer.s.sim));
        check_relative("    and less", bit_of(&back, back.reamer).weight, weight, 1e-9);
        check_relative("bottom of the reamer [m]", bit_of(&back, back.reamer).bottom, bottom, 1e-9);
        take_divided_steps(&run.s, 1e-3, 100);
        take_divided_steps(&back.s, 1e-3, 100);
        check_relative("weight on it later [N]", bit_of(&back, back.reamer).weight, bit_of(&run, run.reamer).weight,
                       1e-5);
        go_on_from_a_snapshot(&back.s, NULL, 1e-3, 50);
        rig_close(&run.s);
        rig_close(&longer.s);
        rig_close(&back.s);
    }
}

static double weight_after(double energy, uint32_t steps)
{
    const drilled w = {energy, 3, DMB_ROCK_RATE};
    drilling d = drill(&w);
    take_divided_steps(&d.s, 1e-3, steps);
    const double weight = bit_of(&d, d.reamer).weight;
    rig_close(&d.s);
    return weight;
}

static void has_derivatives(void **state)
{
    (void)state;
    enum { STEPS = 60 };
    const double energy = 1e7, step = 1e3, far = 2e4;
    const drilled w[3] = {
        {energy, 3, DMB_ROCK_RATE}, {energy - step, 3, DMB_ROCK_RATE}, {energy + step, 3, DMB_ROCK_RATE}};
    drilling d[3];
    dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *sensitivity;
    double derivative = 0.0;
    for (int k = 0; k < 3; k++) d[k] = drill(&w[k]);
    parameter.step = step;
    parameter.low = d[1].s.sim;
    parameter.high = d[2].s.sim;
    must(&d[0].s, dmb_sensitivity_create(d[0].s.sim, &parameter, 1, &sensitivity));
    for (int i = 0; i < STEPS; i++) {
        const int32_t status = dmb_sensitivity_step(sensitivity, 1e-3, NULL);
        if (status < 0) must(&d[0].s, status);
    }
    const dmb_output reading = {dmb_station(d[0].reamer, 0, 0.0), DMB_OUTPUT_BIT_ROCK_WEIGHT, 0};
    must(&d[0].s, dmb_sensitivity_outputs(sensitivity, &reading, 1, NULL, &derivative));
    const double want = (8.0 * (weight_after(energy + far, STEPS) - weight_after(energy - far, STEPS)) -
                         (weight_after(energy + 2.0 * far, STEPS) - weight_after(energy - 2.0 * far, STEPS))) /
                        (12.0 * far);
    assert_true(fabs(want) > 1e-6);
    check_relative("weight on the reamer by the energy of its rock", derivative, want, 1e-5);
    dmb_sensitivity_destroy(&sensitivity);
    for (int k = 0; k < 3; k++) rig_close(&d[k].s);
}

/* ---- Mud that flows ---------------------------------------------------------------------------------------------- */

static const double outer = 0.089, inner = 0.07;

typedef struct hanging {
    rig s;
    dmb_id string, drive, event;
} hanging;

/* Hangs along the world's x; its rig end is fed at this speed. */
static hanging hang(double rate, double speed, double level, const dmb_sim_options *options)
{
    hanging h;
    dmb_environment_def e = dmb_environment_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    memset(&h, 0, sizeof h);
    rig_open(&h.s, 0.0, 0.0, 0.0);
    e.gravity[0] = 9.81;
    e.gravity[2] = 0.0;
    e.fluid_density = 1250.0;
    e.inner_density = 1150.0;
    e.flow_rate = rate;
    e.consistency = 0.05;
    e.flow_exponent = 0.8;
    e.nozzle_area = 3e-4;
    must_model(&h.s, dmb_model_set_environment(h.s.model, &e));
    wall.direction[0] = 1.0;
    wall.diameter = 0.12;
    add_wall(&h.s, &wall);
    string.start_free = DMB_FREE_X;
    h.string = pipe.string = add_string(&h.s, &string);
    pipe.outer_diameter = outer;
    pipe.inner_diameter = inner;
    pipe.density = 7850.0;
    pipe.length = 6.0;
    pipe.elements = 2;
    pipe.damping_time = 1e-4;
    add_pipes(&h.s, &pipe, 10);
    h.drive = add_simple_drive(&h.s, DMB_DRIVE_MOTION, h.string, DMB_X, add_constant(&h.s, speed));
    if (level != 0.0) {
        dmb_event_def event = dmb_event_def_default();
        memcpy(event.name, "hook", sizeof "hook");
        event.output = (dmb_output){.place = dmb_station(h.string, 0, 0.0), .quantity = DMB_OUTPUT_HOOK_LOAD};
        event.level = level;
        event.direction = DMB_EVENT_FALLING;
        must_model(&h.s, dmb_model_add_event(h.s.model, &event, &h.event));
    }
    rig_start(&h.s, options);
    return h;
}

/* A steady flow is a dead force: small axial motion of the string is the same with it and without, that of a rod shaken
 * at one end, v(L)/v(0) = 1/cos(w L/c). */
static void flow_is_a_dead_force(void **state)
{
    (void)state;
    const double length = 60.0, c = sqrt(2.1e11 / 7850.0), frequency = 7.0;
    double values[2][2];
    for (int with = 0; with < 2; with++) {
        hanging h = hang(with ? 0.012 : 0.0, 0.0, 0.0, NULL);
        dmb_response *response = NULL;
        dmb_response_options options = dmb_response_options_default();
        dmb_excitation input = dmb_excitation_default();
        dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
        find_equilibrium(&h.s, NULL);
        options.points = 1;
        options.frequency_low = options.frequency_high = frequency;
        input.kind = DMB_EXCITATION_DRIVE;
        input.place = dmb_station(h.drive, 0, 0.0);
        output.quantity = DMB_OUTPUT_VIBRATION_VELOCITY;
        output.place = dmb_station(h.string, 9, 1.0);
        must(&h.s, dmb_analysis_response(h.s.sim, &options, &input, 1, &output, 1, &response));
        must(&h.s, dmb_response_transfer(response, 0, 0, values[with]));
        dmb_response_destroy(&response);
        rig_close(&h.s);
    }
    check_relative("response with a flow or without", values[1][0], values[0][0], 1e-4);
    check_relative("that of a rod in closed form", values[1][0], 1.0 / cos(2.0 * PI * frequency * length / c), 1e-3);
}

/* Pulled up at v, the hook load is higher by v sqrt(E rho) A until the wave is back from the free end, 2 L/c, then
 * lower by as much. Small steps that look at the output say when it falls through its value at rest. */
static void hook_load_is_an_event(void **state)
{
    (void)state;
    const double E = 2.1e11, A = PI / 4.0 * (outer * outer - inner * inner), wave = 0.2 * A * sqrt(E * 7850.0);
    hanging still = hang(0.012, 0.0, 0.0, NULL);
    find_equilibrium(&still.s, NULL);
    const double rest = output_value(&still.s, dmb_station(still.string, 0, 0.0), DMB_OUTPUT_HOOK_LOAD);
    rig_close(&still.s);
    const double level = rest - 0.3 * wave;
    dmb_event_report report = dmb_event_report_default();
    double time[2] = {0.0, 0.0};
    for (int k = 0; k < 2; k++) {
        hanging h = hang(0.012, -0.2, level, NULL);
        dmb_static_options options = dmb_static_options_default();
        options.steady = DMB_STEADY_AT_REST;
        (void)dmb_analysis_static(h.s.sim, &options, NULL);
        if (k == 0) {
            assert_int_equal(dmb_sim_advance_to_event(h.s.sim, 0.2, &report, NULL), DMB_NOTE_EVENT);
            time[0] = report.time;
            check_close("hook load at the event [N]",
                        output_value(&h.s, dmb_station(h.string, 0, 0.0), DMB_OUTPUT_HOOK_LOAD), level, 1e-6 * wave);
            go_on_from_a_snapshot(&h.s, NULL, 1e-4, 20);
        }
        while (k == 1 && dmb_sim_time(h.s.sim) < 0.2) {
            take_divided_steps(&h.s, 2e-5, 1);
            time[1] = dmb_sim_time(h.s.sim);
            const double load = output_value(&h.s, dmb_station(h.string, 0, 0.0), DMB_OUTPUT_HOOK_LOAD);
            if (k == 1 && time[1] > 0.01 && time[1] < 0.01003)
                check_relative("rise of the hook load [N]", load - rest, wave, 0.1);
            if (load < level) break;
        }
        rig_close(&h.s);
    }
    check_close("time of the event, by small steps [s]", time[0], time[1], 1e-3);
    check_relative("    that of the wave, 2 L/c", time[1], 2.0 * 60.0 / sqrt(E / 7850.0), 0.05);
}

/* Work bounded to a few iterations a step, and the state taken over by another sim of the scene: as the run itself. */
static void flow_goes_on(void **state)
{
    (void)state;
    dmb_sim_options few = dmb_sim_options_default();
    few.bounded_work = 1;
    few.max_iterations = 4;
    hanging run = hang(0.012, 0.1, 0.0, NULL), bounded = hang(0.012, 0.1, 0.0, &few),
            other = hang(0.012, 0.1, 0.0, NULL);
    take_divided_steps(&run.s, 1e-3, 100);
    take_divided_steps(&bounded.s, 1e-3, 100);
    const dmb_place end = dmb_station(run.string, 9, 1.0);
    dmb_place there = end;
    there.part = bounded.string;
    check_relative("end with bounded work", pose_at(&bounded.s, there).displacement[0],
                   pose_at(&run.s, end).displacement[0], 1e-8);
    go_on_from_a_snapshot(&bounded.s, &few, 1e-3, 50);
    must(&other.s, dmb_sim_transfer_state(other.s.sim, run.s.sim));
    take_divided_steps(&run.s, 1e-3, 100);
    take_divided_steps(&other.s, 1e-3, 100);
    there.part = other.string;
    check_relative("end after a state transfer", pose_at(&other.s, there).displacement[0],
                   pose_at(&run.s, end).displacement[0], 1e-5); /* begins with new accelerations */
    rig_close(&run.s);
    rig_close(&bounded.s);
    rig_close(&other.s);
}

/* ---- Subs -------------------------------------------------------------------------------------------------------- */

typedef struct column {
    rig s;
    dmb_id first, second, push;
    dmb_place end;
} column;

/* Clamped at its rig end; the body between both halves is light and fixed, so that it might as well not be there. */
static column upright(int with_sub, const dmb_sim_options *options)
{
    column c;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def push = dmb_load_def_default();
    const dmb_segment off = dmb_segment_default();
    rig_open(&c.s, 0.0, 0.0, 0.0);
    string.start_free = DMB_FREE_NONE;
    c.first = c.second = pipe.string = add_string(&c.s, &string);
    pipe.elements = 2;
    add_pipes(&c.s, &pipe, 2);
    if (with_sub) {
        dmb_sub_def def = dmb_sub_def_default();
        dmb_sub made = dmb_sub_default();
        dmb_body_def body = dmb_body_def_default();
        body.mass = 1e-6;
        for (int i = 0; i < 3; i++) body.inertia[i] = 1e-9;
        def.body = &body;
        must_model(&c.s, dmb_model_add_sub(c.s.model, &def, &made));
        c.second = pipe.string = made.section;
    }
    add_pipes(&c.s, &pipe, 2);
    push.place = c.end = dmb_station(c.second, with_sub ? 1 : 3, 1.0);
    push.force[0] = -1.0;
    push.time_function = add_time_function(&c.s, &off, 1);
    c.push = add_load(&c.s, &push);
    dmb_load_def side = dmb_load_def_default();
    side.place = c.end;
    side.force[1] = 300.0;
    if (options != NULL) (void)add_load(&c.s, &side);
    rig_start(&c.s, options);
    return c;
}

/* Euler's clamped column with a free end under a load that keeps its direction, F = (pi/2)^2 EI/L^2 (1 + F/EA..). */
static void a_column_with_a_sub_buckles(void **state)
{
    (void)state;
    double factor[2];
    for (int with = 0; with < 2; with++) {
        column c = upright(with, NULL);
        dmb_buckling *found = NULL;
        dmb_buckling_options options = dmb_buckling_options_default();
        find_equilibrium(&c.s, NULL);
        options.scale = DMB_SCALE_PART;
        options.part = c.push;
        must(&c.s, dmb_analysis_buckling(c.s.sim, &options, &found));
        assert_int_equal(dmb_buckling_factor(found, 0, &factor[with]), DMB_OK);
        dmb_buckling_destroy(&found);
        rig_close(&c.s);
    }
    check_relative("load of a column with a sub or without [N]", factor[1], factor[0], 1e-7);
    check_relative("    Euler's", factor[1], 0.25 * PI * PI * s1_values().EI / 36.0, 2e-3);
}

static void its_response_is_that_without(void **state)
{
    (void)state;
    double values[2][4];
    const double at[2] = {3.0, 17.0};
    for (int with = 0; with < 2; with++) {
        column c = upright(with, NULL);
        dmb_response *response = NULL;
        dmb_response_options options = dmb_response_options_default();
        dmb_excitation input = dmb_excitation_default();
        dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
        options.points = 2;
        options.frequencies = at;
        input.place = output.place = c.end;
        input.component = DMB_Z;
        output.quantity += DMB_Z;
        must(&c.s, dmb_analysis_response(c.s.sim, &options, &input, 1, &output, 1, &response));
        must(&c.s, dmb_response_transfer(response, 0, 0, values[with]));
        dmb_response_destroy(&response);
        rig_close(&c.s);
    }
    for (int i = 0; i < 2; i++)
        check_relative("receptance of a cantilever with a sub or without", values[1][2 * i], values[0][2 * i], 1e-5);
}

static void its_work_is_bounded(void **state)
{
    (void)state;
    dmb_sim_options few = dmb_sim_options_default(), all = dmb_sim_options_default();
    few.bounded_work = 1;
    few.max_iterations = 5;
    column a = upright(1, &few), b = upright(1, &all), whole = upright(0, &few);
    take_divided_steps(&a.s, 1e-3, 80);
    take_divided_steps(&b.s, 1e-3, 80);
    take_divided_steps(&whole.s, 1e-3, 80);
    const double y = pose_at(&a.s, a.end).displacement[1];
    assert_true(fabs(y) > 1e-3);
    check_relative("end with bounded work", y, pose_at(&b.s, b.end).displacement[1], 1e-7);
    check_relative("    without the sub", y, pose_at(&whole.s, whole.end).displacement[1], 1e-5);
    go_on_from_a_snapshot(&a.s, &few, 1e-3, 40);
    rig_close(&a.s);
    rig_close(&b.s);
    rig_close(&whole.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drills_steadily),
        cmocka_unit_test(is_transferred),
        cmocka_unit_test(has_derivatives),
        cmocka_unit_test(flow_is_a_dead_force),
        cmocka_unit_test(hook_load_is_an_event),
        cmocka_unit_test(flow_goes_on),
        cmocka_unit_test(a_column_with_a_sub_buckles),
        cmocka_unit_test(its_response_is_that_without),
        cmocka_unit_test(its_work_is_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
