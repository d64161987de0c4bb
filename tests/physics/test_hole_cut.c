/* The hole that bits and reamers leave (cut_spacing of dmb_wall_def): where its end is, a stabiliser in it against a
 * hole described like that, the energy of a wall that is cut away under a ring, runs by several ways, another model
 * that goes on in it, and what is refused. */
#include <stdlib.h>
#include <string.h>

#include "contact_scene.h"
#include "drillmbd/ring.h"

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
    int32_t ahead; /* 1: with a ring ahead of the reamer, on the floor of the pilot hole */
} reaming;

static reaming usual(void)
{
    return (reaming){.narrow = 4.875, .spacing = spacing, .wings = wide};
}

static void add_ring(reaming *d, uint32_t pipe, double fraction, double diameter, dmb_id *id)
{
    dmb_ring_def ring = dmb_ring_def_default();
    ring.pipe = pipe;
    ring.fraction = fraction;
    ring.outer_diameter = diameter;
    must_model(&d->s, dmb_model_add_ring(d->s.model, &ring, id));
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
    dmb_term terms[2] = {scene_step_term(0.0, 0.0, ramp, speed), scene_step_term(stop, 0.0, stop + ramp, -speed)};
    return add_programme(s, terms, 2);
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
}

static void begin(reaming *d)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_bit_def wings = cutter(d->wings), bit = cutter(narrow);
    dmb_term turn = dmb_term_default();
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
    add_ring(d, 1, 1.0 / 3.0, 0.11, NULL);
    add_ring(d, 1, 0.5, d->wings, &wings.ring);
    if (d->ahead) add_ring(d, 1, 0.5 + 0.4 / 3.0, 0.099, NULL);
    wings.inner_radius = 0.02;
    must_model(&d->s, dmb_model_add_bit(d->s.model, &bit, NULL));
    must_model(&d->s, dmb_model_add_bit(d->s.model, &wings, NULL));
    (void)add_simple_drive(&d->s, DMB_DRIVE_MOTION, d->string, DMB_X, add_feed(&d->s, d->speed));
    (void)add_simple_drive(&d->s, DMB_DRIVE_MOTION, d->string, DMB_RX, add_programme(&d->s, &turn, 1));
    (void)rig_start(&d->s, NULL);
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
    const uint32_t count = scene_info(s).contact_sites;
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
    const double full = spacing * (floor((face + 1e-4) / spacing) + 1.0);
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
    for (int i = 0; i < 2; i++) {
        reaming d = usual();
        d.speed = 0.5;
        d.ahead = 1;
        begin(&d);
        take_divided_steps(&d.s, 1e-3 / (1 << i), 4700 << i);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stabiliser_rests_as_in_a_hole_described_so),
        cmocka_unit_test(end_of_the_wide_hole_is_at_the_face),
        cmocka_unit_test(energy_is_accounted_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
