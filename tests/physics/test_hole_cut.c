/* The hole that bits and reamers leave (cut_spacing of dmb_wall_def): where its end is, a stabiliser in it against a
 * hole described like that, the energy of a wall that is cut away under a ring, runs by several ways, another model
 * that goes on in it, and what is refused. Equations: eq:hole.cut. */
#include <stdlib.h>
#include <string.h>

#include "contact_scene.h"
#include "drillmbd/scene.h"

static const double g = 9.81, narrow = 0.10, wide = 0.12, spacing = 0.25, reamer_at = 4.5, way = 2.0, ramp = 0.5;

/* ---- A reamer, with a stabiliser behind that is too wide for the pilot hole ---------------------------------------
 */

typedef struct reaming {
    rig s;
    dmb_id string;
    double start;  /* [m] measured depth of the rig end */
    double narrow; /* [m] measured depth at which the described hole becomes narrow; the middle of a spacing */
    double spacing, wings;
    double speed;
    double event;  /* [m] displacement at which the run is to stop; 0: none */
    double again;  /* [m] measured depth at which the described hole becomes wide again; 0: nowhere */
    int32_t ahead; /* 1: with a ring ahead of the reamer, on the floor of the pilot hole */
} reaming;

static reaming usual(void)
{
    return (reaming){.narrow = 4.875, .spacing = spacing, .wings = wide};
}

static void add_stabiliser(reaming *d, uint32_t pipe, double fraction, double diameter, dmb_id *id)
{
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    ring.pipe = pipe;
    ring.fraction = fraction;
    ring.outer_diameter = diameter;
    must_model(&d->s, dmb_model_add_stabiliser(d->s.model, &ring, id));
}

/* Soft rock: the forces of the bits are small beside the weights. */
static dmb_bit_def cutter(double diameter)
{
    dmb_bit_def bit = dmb_bit_def_default();
    bit.rock_law = DMB_ROCK_RATE;
    bit.radius = 0.5 * diameter;
    bit.diameter = 0.0;
    bit.intrinsic_energy = 1e4;
    bit.contact_strength = 0.0;
    return bit;
}

/* From 0 up to the speed within `ramp`, and back to 0 when `way` is done; for good where there is no way. */
static dmb_id add_feed(rig *s, double speed)
{
    const double stop = way / fmax(speed, 1e-9);
    dmb_segment terms[2] = {scene_step_segment(0.0, 0.0, ramp, speed),
                            scene_step_segment(stop, 0.0, stop + ramp, -speed)};
    return add_time_function(s, terms, 2);
}

static void add_hole(const reaming *d)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_hole_section pilot = dmb_hole_section_default();
    wall.diameter = wide;
    wall.stiffness = 1e6;
    wall.friction_law = DMB_FRICTION_NONE;
    wall.cut_spacing = d->spacing;
    wall.cut_end = 12.0;
    pilot.depth = d->narrow;
    pilot.transition = spacing;
    pilot.diameter = narrow;
    (void)add_wall((rig *)&d->s, &wall);
    must_model(&d->s, dmb_model_add_hole_sections(d->s.model, &pilot, 1));
    pilot.depth = d->again;
    pilot.transition = 2.0 * d->spacing;
    pilot.diameter = wide;
    if (d->again > 0.0) must_model(&d->s, dmb_model_add_hole_sections(d->s.model, &pilot, 1));
}

static void add_event(const reaming *d)
{
    dmb_event_def event = dmb_event_def_default();
    event.output = (dmb_output){dmb_station(d->string, 1, 0.5), DMB_OUTPUT_DISPLACEMENT_X, 0};
    event.level = d->event;
    (void)strcpy(event.name, "there");
    must_model(&d->s, dmb_model_add_event(d->s.model, &event, NULL));
}

static void begin_with(reaming *d, const dmb_sim_options *options)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_bit_def wings = cutter(d->wings), bit = cutter(narrow);
    dmb_segment turn = dmb_segment_default();
    rig_open(&d->s, 0.0, 0.0, -g);
    add_hole(d);
    string.start_depth = d->start;
    string.start_free = DMB_FREE_CYLINDRICAL;
    string.velocity[3] = turn.h0 = 10.0;
    d->string = add_string(&d->s, &string);
    pipe.length = 3.0;
    pipe.elements = 3;
    pipe.damping_time = 1e-3;
    (void)add_pipes(&d->s, &pipe, 3);
    add_stabiliser(d, 1, 1.0 / 3.0, 0.11, NULL);
    add_stabiliser(d, 1, 0.5, d->wings, &wings.stabiliser);
    if (d->ahead) add_stabiliser(d, 1, 0.5 + 0.4 / 3.0, 0.099, NULL);
    wings.inner_radius = 0.02;
    must_model(&d->s, dmb_model_add_bit(d->s.model, &bit, NULL));
    must_model(&d->s, dmb_model_add_bit(d->s.model, &wings, NULL));
    (void)add_simple_drive(&d->s, DMB_DRIVE_MOTION, d->string, DMB_X, add_feed(&d->s, d->speed));
    (void)add_simple_drive(&d->s, DMB_DRIVE_MOTION, d->string, DMB_RX, add_time_function(&d->s, &turn, 1));
    if (d->event > 0.0) add_event(d);
    (void)rig_start(&d->s, options);
}

static void begin(reaming *d)
{
    begin_with(d, NULL);
}

static double diameter_at(const rig *s, double depth)
{
    dmb_hole_point point = dmb_hole_point_default();
    must(s, dmb_query_hole_now(s->sim, depth, &point));
    return point.diameter;
}

/* [N] of every site, by sites of the scene. */
static uint32_t forces_of(const rig *s, double forces[64])
{
    const uint32_t count = scene_info(s).contact_points;
    assert_true(count <= 64);
    for (uint32_t i = 0; i < count; i++) forces[i] = scene_contact(s, i).normal_force;
    return count;
}

/* At rest as the sim is now, and as a hole described up to `end` has it with the string starting at `start`. */
static void check_against_described(reaming *d, double start, double end, double most_at_rest)
{
    reaming as_described = usual();
    double have[64], want[64], largest = 0.0, apart = 0.0;
    as_described.spacing = 0.0;
    as_described.start = start;
    as_described.narrow = end;
    begin(&as_described);
    (void)find_equilibrium(&d->s, NULL);
    (void)find_equilibrium(&as_described.s, NULL);
    const uint32_t count = forces_of(&d->s, have);
    assert_int_equal(forces_of(&as_described.s, want), count);
    for (uint32_t i = 0; i < count; i++) {
        largest = fmax(largest, want[i]);
        apart = fmax(apart, fabs(have[i] - want[i]));
    }
    print_message("    largest force on the wall %.6g N\n", largest);
    check_below("contact forces apart, over the largest", apart / largest, most_at_rest);
    rig_close(&as_described.s);
}

static void stabiliser_rests_as_in_a_hole_described_so(void **state)
{
    (void)state;
    reaming d = usual();
    begin(&d);
    check_against_described(&d, 0.0, 4.875, 1e-12);
    rig_close(&d.s);
    d = usual();
    d.speed = 0.5;
    begin(&d);
    take_divided_steps(&d.s, 1e-3, 4700);
    check_relative("way [m]", pose_at(&d.s, dmb_station(d.string, 0, 0.0)).displacement[0], way, 1e-9);
    check_against_described(&d, way, 6.875, 1e-7);
    rig_close(&d.s);
}

/* As wide as the cutter up to the first station beyond its face, as described from the next one on. */
static void check_end(const reaming *d, double time)
{
    const double face = reamer_at + d->speed * (time - 0.5 * ramp);
    const double full = spacing * (floor(face / spacing) + 1.0);
    check_close("diameter behind the reamer [m]", diameter_at(&d->s, face), wide, 1e-15);
    check_close("diameter at the last station that is cut [m]", diameter_at(&d->s, full), wide, 1e-15);
    check_close("half a spacing beyond [m]", diameter_at(&d->s, full + 0.5 * spacing), 0.5 * (wide + narrow), 1e-12);
    check_close("a spacing beyond [m]", diameter_at(&d->s, full + spacing), narrow, 1e-15);
}

static void end_of_the_wide_hole_is_at_the_face(void **state)
{
    dmb_hole_point described = dmb_hole_point_default();
    (void)state;
    reaming d = usual();
    d.speed = 0.37;
    begin(&d);
    for (int i = 1; i <= 8; i++) {
        take_divided_steps(&d.s, 2e-3, 250);
        if (dmb_sim_time(d.s.sim) < way / d.speed) check_end(&d, dmb_sim_time(d.s.sim));
    }
    must_model(&d.s, dmb_query_hole(d.s.model, 5.5, &described));
    check_close("the model keeps its description [m]", described.diameter, narrow, 1e-15);
    rig_close(&d.s);
}

/* The balance closes with the step, though the wall is cut away under a ring eight times on the way. */
static void energy_is_accounted_for(void **state)
{
    double open[2];
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        reaming d = usual();
        d.speed = 0.5;
        d.ahead = 1;
        begin(&d);
        take_divided_steps(&d.s, i == 0 ? 1e-3 : 5e-4, i == 0 ? 4700 : 9400);
        const dmb_energy energy = energy_of(&d.s);
        print_message("    rock %.6g J, drives %.6g J, impact %.4g J, balance %.3g J, unexplained %.3g J\n",
                      energy.rock, energy.drives, energy.impact, energy.balance, energy.unexplained);
        open[i] = fabs(energy.balance) / energy.input;
        check_below("unexplained over what went in", fabs(energy.unexplained) / energy.input, 1e-7);
        rig_close(&d.s);
    }
    check_below("balance over what went in", open[0], 1e-2);
    check_below("the same with half the step, over that", open[1] / open[0], 0.5);
}

/* It counts, and changes nothing. */
static void the_ledger_moves_nothing(void **state)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_energy energy = dmb_energy_default();
    dmb_pose pose[2];
    double diameter[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        reaming d = usual();
        d.speed = 0.5;
        d.ahead = 1;
        options.energy_ledger = i;
        begin_with(&d, &options);
        take_divided_steps(&d.s, 1e-3, 1500);
        assert_int_equal(dmb_query_energy(d.s.sim, &energy), i ? DMB_OK : DMB_ERR_UNSUPPORTED);
        pose[i] = pose_at(&d.s, dmb_station(d.string, 2, 1.0));
        diameter[i] = diameter_at(&d.s, 5.0);
        rig_close(&d.s);
    }
    for (int k = 0; k < 3; k++)
        check_close("pose without the ledger [m]", pose[0].position[k], pose[1].position[k], 0.0);
    check_close("the hole [m]", diameter[0], diameter[1], 0.0);
    check_close("it was cut [m]", diameter[1], wide, 1e-15);
}

/* ---- The wall under a ring ----------------------------------------------------------------------------------------
 */

static const double ball_mass = 10.0, floor_stiffness = 1e6;

/* A bit that widens a hole of 0.2 m to 0.22 m, and ahead of it, at a station, a ball at rest on the floor. */
static dmb_id drill_under_a_ball(rig *s, int32_t with_ball)
{
    dmb_wall_def wall = scene_wide_wall(DMB_NORMAL_HUNT_CROSSLEY, floor_stiffness, 1.0, 1.0);
    dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = cutter(0.22);
    dmb_body_def ball = scene_ball(ball_mass, 0.0, DMB_FREE_Y | DMB_FREE_Z);
    dmb_segment turn = dmb_segment_default();
    dmb_id id = {0, 0};
    rig_open(s, 0.0, 0.0, -g);
    wall.diameter = 0.2;
    wall.cut_spacing = spacing;
    wall.cut_end = 10.0;
    (void)add_wall(s, &wall);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    const dmb_id string = add_pipes(s, &pipe, 2);
    must_model(s, dmb_model_add_bit(s->model, &bit, NULL));
    turn.h0 = 10.0;
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, string, DMB_X, add_feed(s, 0.5));
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, string, DMB_RX, add_time_function(s, &turn, 1));
    ball.position[0] = 4.0;
    ball.position[2] = -0.05 - ball_mass * g / floor_stiffness;
    if (with_ball) id = add_body(s, &ball);
    (void)rig_start(s, NULL);
    return id;
}

/* A ball on the floor: K d^2/2 goes with the rock at once, and the ball falls freely from there. */
static void wall_gives_what_it_stored_to_the_rock(void **state)
{
    const double stored = 0.5 * ball_mass * g * ball_mass * g / floor_stiffness;
    double before = 0.0;
    rig with, without;
    (void)state;
    const dmb_id ball = drill_under_a_ball(&with, 1);
    (void)drill_under_a_ball(&without, 0);
    check_relative("stored at the start [J]", energy_of(&with).contact, stored, 1e-9);
    for (int i = 0; i < 5000 && diameter_at(&with, 4.0) < 0.21; i++) {
        before = energy_of(&with).rock - energy_of(&without).rock;
        take_divided_steps(&with, 1e-3, 1);
        take_divided_steps(&without, 1e-3, 1);
    }
    const dmb_energy cut = energy_of(&with);
    const double apart = cut.rock - energy_of(&without).rock;
    check_close("rock before, over that", before / stored, 0.0, 1e-7);
    check_close("contact after, over that", cut.contact / stored, 0.0, 1e-12);
    check_relative("rock by the ball's wall [J]", apart, stored, 1e-7);
    check_close("acceleration of the ball [m/s2]",
                motion_at(&with, dmb_station(ball, 0, 0.0), DMB_FRAME_WORLD).acceleration[2], -g, 1e-12);
    check_below("energy left open, but for the drilling, over that",
                fabs(cut.unexplained - energy_of(&without).unexplained) / stored, 1e-7);
    rig_close(&with);
    rig_close(&without);
}

/* ---- Ways of running ----------------------------------------------------------------------------------------------
 */

/* A step that is tried and taken back cuts nothing: the event lies a micrometre before the station that its steps go
 * beyond. */
static void events_take_the_cut_back(void **state)
{
    dmb_event_report report = dmb_event_report_default();
    (void)state;
    reaming d = usual();
    d.speed = 0.5;
    d.event = 0.5 - 1e-6;
    begin(&d);
    must(&d.s, dmb_sim_advance_to_event(d.s.sim, 3.0, &report, NULL));
    assert_int_equal(report.count, 1);
    check_close("place of the event [m]", pose_at(&d.s, dmb_station(d.string, 1, 0.5)).displacement[0], d.event, 1e-9);
    check_close("diameter a station ahead [m]", diameter_at(&d.s, 5.25), narrow, 1e-15);
    check_close("diameter at the station [m]", diameter_at(&d.s, 5.0), wide, 1e-15);
    take_divided_steps(&d.s, 1e-5, 1);
    check_close("diameter a station ahead when it has passed [m]", diameter_at(&d.s, 5.25), wide, 1e-15);
    rig_close(&d.s);
}

static void error_control_cuts_where_it_comes(void **state)
{
    dmb_step_report report = dmb_step_report_default();
    (void)state;
    reaming d = usual();
    d.speed = 0.37;
    d.ahead = 1;
    begin(&d);
    must(&d.s, dmb_sim_advance(d.s.sim, 2.0, &report));
    print_message("    %u steps, %u rejected\n", report.steps, report.rejected);
    assert_true(report.rejected > 0);
    check_end(&d, 2.0);
    rig_close(&d.s);
}

static void it_goes_on_from_a_snapshot(void **state)
{
    size_t size = 0;
    (void)state;
    reaming a = usual(), b = usual();
    a.speed = b.speed = 0.5;
    a.ahead = b.ahead = 1;
    begin(&a);
    begin(&b);
    take_divided_steps(&a.s, 1e-3, 1500);
    must(&a.s, dmb_sim_snapshot_size(a.s.sim, &size));
    void *block = malloc(size);
    must(&a.s, dmb_sim_snapshot(a.s.sim, block, size));
    must(&b.s, dmb_sim_restore(b.s.sim, block, size));
    free(block);
    assert_true(diameter_at(&b.s, 5.1) == diameter_at(&a.s, 5.1) && diameter_at(&b.s, 5.1) > 0.119);
    take_divided_steps(&a.s, 1e-3, 1500);
    take_divided_steps(&b.s, 1e-3, 1500);
    assert_true(rig_hash(&a.s) == rig_hash(&b.s));
    rig_close(&a.s);
    rig_close(&b.s);
}

/* Reamers no wider than their hole leave the run as it is, bit for bit; a bit without a rock law too. */
static void narrow_cutters_change_nothing(void **state)
{
    (void)state;
    reaming a = usual(), b = usual();
    a.speed = b.speed = 0.5;
    a.narrow = b.narrow = 11.0;
    a.wings = b.wings = 0.115;
    b.spacing = 0.0;
    begin(&a);
    begin(&b);
    take_divided_steps(&a.s, 1e-3, 1500);
    take_divided_steps(&b.s, 1e-3, 1500);
    const dmb_energy with = energy_of(&a.s), without = energy_of(&b.s);
    assert_memory_equal(&with, &without, sizeof with);
    for (uint32_t i = 0; i < scene_info(&a.s).contact_points; i++) {
        const dmb_contact x = scene_contact(&a.s, i), y = scene_contact(&b.s, i);
        assert_true(x.gap == y.gap && x.normal_force == y.normal_force && x.approach == y.approach);
    }
    rig_close(&a.s);
    rig_close(&b.s);
}

/* ---- Another model ------------------------------------------------------------------------------------------------
 */

static void another_model_goes_on_in_the_hole(void **state)
{
    static const double spacings[2] = {0.25, 0.125};
    (void)state;
    reaming from = usual();
    from.speed = 0.5;
    begin(&from);
    take_divided_steps(&from.s, 1e-3, 1500);
    for (int i = 0; i < 2; i++) {
        reaming to = usual();
        double apart = 0.0;
        to.speed = 0.5;
        to.spacing = spacings[i];
        begin(&to);
        must(&to.s, dmb_sim_transfer_state(to.s.sim, from.s.sim));
        for (int k = 8; k < 88; k++) /* at stations of both */
            apart = fmax(apart, fabs(diameter_at(&to.s, 0.125 * k) - diameter_at(&from.s, 0.125 * k)));
        check_below("diameters apart [m]", apart, i == 0 ? 0.0 : 1e-15);
        take_divided_steps(&to.s, 1e-3, 1000);
        check_close("diameter where it has reamed on [m]", diameter_at(&to.s, 5.6), wide, 1e-15);
        rig_close(&to.s);
    }
    reaming closed = usual();
    closed.speed = 0.5;
    closed.spacing = 0.0;
    begin(&closed);
    const uint64_t before = rig_hash(&closed.s);
    assert_int_equal(dmb_sim_transfer_state(closed.s.sim, from.s.sim), DMB_ERR_GEOMETRY);
    assert_non_null(strstr(dmb_sim_message(closed.s.sim), "cut_spacing"));
    assert_true(rig_hash(&closed.s) == before);
    rig_close(&closed.s);
    rig_close(&from.s);
}

/* Where the cut ends the other model's hole is described wide again: what is left to widen would end twice as steeply
 * as the cut did, between two of its closer stations. */
static void a_hole_that_would_be_too_steep(void **state)
{
    (void)state;
    reaming from = usual();
    const double close = 0.02; /* [m] the least for these wings */
    from.speed = 0.5;
    from.spacing = close;
    begin(&from);
    take_divided_steps(&from.s, 1e-3, 1500);
    double last = 5.0;
    while (diameter_at(&from.s, last + close) > wide - 1e-9) last += close;
    assert_true(last < 6.0);
    reaming to = usual();
    to.speed = 0.5;
    to.wings = 0.11;
    to.spacing = 0.5 * close;
    to.again = last + 0.5 * close;
    begin(&to);
    const uint64_t before = rig_hash(&to.s);
    assert_int_equal(dmb_sim_transfer_state(to.s.sim, from.s.sim), DMB_ERR_GEOMETRY);
    print_message("    %s\n", dmb_sim_message(to.s.sim));
    assert_non_null(strstr(dmb_sim_message(to.s.sim), "state transfer: wall: the radius would change by "));
    assert_true(rig_hash(&to.s) == before);
    rig_close(&to.s);
    rig_close(&from.s);
}

/* ---- Refusals -----------------------------------------------------------------------------------------------------
 */

static void check_wall_refused(double apart, double start, double end, int32_t status, const char *text)
{
    dmb_wall_def wall = dmb_wall_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    wall.cut_spacing = apart;
    wall.cut_start = start;
    wall.cut_end = end;
    assert_int_equal(dmb_model_add_wall(s.model, &wall, NULL), status);
    assert_non_null(strstr(dmb_model_message(s.model), text));
    rig_close(&s);
}

static int32_t compile_with(double apart, const dmb_bit_def *bit, double flow, char message[512])
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    wall.diameter = narrow;
    wall.cut_spacing = apart;
    wall.cut_end = 10.0;
    mud.flow_rate = flow;
    mud.consistency = 0.02;
    mud.fluid_density = 1100.0;
    must_model(&s, dmb_model_set_environment(s.model, &mud));
    (void)add_wall(&s, &wall);
    (void)add_pipes(&s, &pipe, 3);
    must_model(&s, dmb_model_add_bit(s.model, bit, NULL));
    const int32_t status = dmb_model_compile(s.model, NULL);
    (void)strncpy(message, dmb_model_message(s.model), 511);
    message[511] = '\0';
    rig_close(&s);
    return status;
}

static void check_compile_refused(double apart, const dmb_bit_def *bit, double flow, int32_t status, const char *text)
{
    char message[512];
    assert_int_equal(compile_with(apart, bit, flow, message), status);
    print_message("    %s\n", message);
    assert_non_null(strstr(message, text));
}

static void sensitivities_are_refused(void)
{
    dmb_parameter parameter = dmb_parameter_default();
    dmb_sensitivity *sensitivity = NULL;
    reaming d[3] = {usual(), usual(), usual()};
    for (int i = 0; i < 3; i++) begin(d + i);
    parameter.step = 1e-3;
    parameter.low = d[0].s.sim;
    parameter.high = d[1].s.sim;
    assert_int_equal(dmb_sensitivity_create(d[2].s.sim, &parameter, 1, &sensitivity), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(d[2].s.sim), "cut_spacing"));
    for (int i = 0; i < 3; i++) rig_close(&d[i].s);
}

static void what_it_cannot_is_refused(void **state)
{
    char message[512];
    dmb_bit_def bit = cutter(0.12);
    (void)state;
    check_wall_refused((double)NAN, 0.0, 1.0, DMB_ERR_NOT_FINITE, "cut_spacing");
    check_wall_refused(-1.0, 0.0, 1.0, DMB_ERR_VALUE, "cut_spacing");
    check_wall_refused((double)INFINITY, 0.0, 1.0, DMB_ERR_NOT_FINITE, "cut_spacing");
    check_wall_refused(0.1, (double)NAN, 1.0, DMB_ERR_NOT_FINITE, "cut_start");
    check_wall_refused(0.1, 0.0, -(double)INFINITY, DMB_ERR_NOT_FINITE, "cut_end");
    check_wall_refused(0.1, 0.0, 0.29, DMB_ERR_VALUE, "cut_end");
    check_wall_refused(0.1, 1.0, 0.0, DMB_ERR_VALUE, "cut_end");
    check_wall_refused(1e-3, 0.0, 1e3, DMB_ERR_TOO_LARGE, "larger spacing");
    bit.diameter = 0.12;
    assert_int_equal(compile_with(0.25, &bit, 0.0, message), DMB_OK);
    check_compile_refused(0.019, &bit, 0.0, DMB_ERR_GEOMETRY, "cut_spacing");
    check_compile_refused(0.25, &bit, 0.01, DMB_ERR_UNSUPPORTED, "cut_spacing");
    check_compile_refused(0.0, &bit, 0.0, DMB_ERR_GEOMETRY, "diameter");
    bit.diameter = 0.125;
    check_compile_refused(0.25, &bit, 0.0, DMB_ERR_GEOMETRY, "0.12 m");
    bit.diameter = 0.12;
    bit.rock_law = DMB_ROCK_NONE;
    check_compile_refused(0.25, &bit, 0.0, DMB_ERR_GEOMETRY, "diameter");
    sensitivities_are_refused();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stabiliser_rests_as_in_a_hole_described_so),
        cmocka_unit_test(end_of_the_wide_hole_is_at_the_face),
        cmocka_unit_test(energy_is_accounted_for),
        cmocka_unit_test(the_ledger_moves_nothing),
        cmocka_unit_test(wall_gives_what_it_stored_to_the_rock),
        cmocka_unit_test(events_take_the_cut_back),
        cmocka_unit_test(error_control_cuts_where_it_comes),
        cmocka_unit_test(it_goes_on_from_a_snapshot),
        cmocka_unit_test(narrow_cutters_change_nothing),
        cmocka_unit_test(another_model_goes_on_in_the_hole),
        cmocka_unit_test(a_hole_that_would_be_too_steep),
        cmocka_unit_test(what_it_cannot_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
