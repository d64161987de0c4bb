/* A reamer on a ring behind the bit: the steady split of the weight between the two cutting surfaces in closed form, by
 * both rock laws, torque at the rig, force between them, energy; core bits; a restart; what is refused. Equations:
 * eq:bit.forces, eq:bit.no-work. */
#include <stdlib.h>
#include <string.h>

#include "drillmbd/scene.h"
#include "rig.h"
#include "rock.h"

static const double push = 40e3, spin = 10.0, pilot = 0.0475, gauge = 0.075;
enum { BLADES = 5 };

typedef struct drilling {
    rig s;
    dmb_id string, ring, bit, reamer;
} drilling;

static dmb_bit_def cutting(int32_t law, double outer, double inner, double energy)
{
    dmb_bit_def bit = dmb_bit_def_default();
    bit.rock_law = law;
    bit.radius = outer;
    bit.inner_radius = inner;
    bit.intrinsic_energy = energy;
    bit.cutting_ratio = inner > 0.0 ? 0.7 : 0.6;
    bit.contact_strength = 2e7;
    bit.wear_length = inner > 0.0 ? 2e-3 : 1e-3;
    bit.blades = BLADES;
    bit.diameter = 0.0;
    return bit;
}

/* From 0 to height over the first second. */
static dmb_id add_ramp(rig *s, double height)
{
    dmb_segment ramp = dmb_segment_default();
    ramp.kind = DMB_SEGMENT_STEP;
    ramp.h1 = height;
    return add_time_function(s, &ramp, 1);
}

/* feed > 0: a speed that the rig gives; else it pushes. */
static drilling drill(int32_t kind, int32_t law, int with_reamer, double feed)
{
    drilling d;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    rig_open(&d.s, 0.0, 0.0, 0.0);
    wall.diameter = 0.16;
    wall.normal_law = DMB_NORMAL_NONE;
    (void)add_wall(&d.s, &wall);
    pipe.kind = kind;
    pipe.length = 5.0;
    pipe.elements = 2;
    pipe.damping_time = 1e-3;
    d.string = add_pipes(&d.s, &pipe, 3);
    ring.pipe = 1;
    ring.fraction = 0.7;
    ring.outer_diameter = 2.0 * gauge;
    must_model(&d.s, dmb_model_add_stabiliser(d.s.model, &ring, &d.ring));
    dmb_bit_def bit = cutting(law, pilot, 0.0, 2e7), reamer = cutting(law, gauge, pilot, 1e7);
    must_model(&d.s, dmb_model_add_bit(d.s.model, &bit, &d.bit));
    reamer.stabiliser = d.ring;
    if (with_reamer) must_model(&d.s, dmb_model_add_bit(d.s.model, &reamer, &d.reamer));
    (void)add_simple_drive(&d.s, feed > 0.0 ? DMB_DRIVE_MOTION : DMB_DRIVE_LOAD, d.string, DMB_X,
                           add_ramp(&d.s, feed > 0.0 ? feed : push));
    (void)add_simple_drive(&d.s, DMB_DRIVE_MOTION, d.string, DMB_RX, add_ramp(&d.s, spin));
    (void)rig_start(&d.s, NULL);
    return d;
}

static dmb_bit_state state_of(const drilling *d, dmb_id id)
{
    dmb_bit_state bit = dmb_bit_state_default();
    must(&d->s, dmb_query_bit(d->s.sim, id, &bit));
    return bit;
}

static double value_of(const drilling *d, int32_t quantity, dmb_place place)
{
    const dmb_output output = {.place = place, .quantity = quantity};
    double value = 0.0;
    must(&d->s, dmb_query_output(d->s.sim, &output, &value));
    return value;
}

static void check_split(int32_t kind, int32_t law)
{
    drilling d = drill(kind, law, 1, 0.0);
    const dmb_bit_def bit = cutting(law, pilot, 0.0, 2e7), reamer = cutting(law, gauge, pilot, 1e7);
    const double flat = weight_at(&bit, 0.0) + weight_at(&reamer, 0.0);
    const double cut = (push - flat) / (weight_at(&bit, 1.0) + weight_at(&reamer, 1.0) - flat);
    const double torque = torque_at(&bit, cut) + torque_at(&reamer, cut);
    take_divided_steps(&d.s, 2e-3, 3000);
    const dmb_energy before = energy_of(&d.s);
    const double at = dmb_sim_time(d.s.sim);
    take_divided_steps(&d.s, 2e-3, 500);
    const dmb_energy after = energy_of(&d.s);
    const double time = dmb_sim_time(d.s.sim) - at;
    const dmb_bit_state pilot_bit = state_of(&d, d.bit), behind = state_of(&d, d.reamer);
    check_relative("rate of penetration [m/s]",
                   value_of(&d, DMB_OUTPUT_RATE_OF_PENETRATION, dmb_station(d.string, 0, 0.0)), cut * spin / (2.0 * PI),
                   1e-6);
    check_relative("weight on the bit [N]", pilot_bit.weight, weight_at(&bit, cut), 1e-6);
    check_relative("weight on the reamer [N]", behind.weight, weight_at(&reamer, cut), 1e-6);
    check_relative("their sum [N]", pilot_bit.weight + behind.weight, push, 1e-6);
    check_relative("torque on the bit [N m]", pilot_bit.torque, torque_at(&bit, cut), 1e-6);
    check_relative("torque on the reamer [N m]", behind.torque, torque_at(&reamer, cut), 1e-6);
    check_relative("output of the weight on bit, without the reamer [N]",
                   value_of(&d, DMB_OUTPUT_WEIGHT_ON_BIT, dmb_station(d.string, 0, 0.0)), weight_at(&bit, cut), 1e-6);
    check_relative("axial force behind the reamer [N]",
                   value_of(&d, DMB_OUTPUT_AXIAL_FORCE, dmb_station(d.string, 2, 0.5)), -weight_at(&bit, cut), 1e-6);
    check_relative("axial force before it [N]", value_of(&d, DMB_OUTPUT_AXIAL_FORCE, dmb_station(d.string, 0, 0.5)),
                   -push, 1e-6);
    check_relative("energy that the rock takes [J]", after.rock - before.rock,
                   (push * cut / (2.0 * PI) + torque) * spin * time, 1e-6);
    check_relative("energy of the drives [J]", after.drives - before.drives, after.rock - before.rock, 1e-5);
    check_below("energy balance over what went in", fabs(after.balance) / after.input, 1e-3);
    rig_close(&d.s);
}

static void weight_splits_by_width_and_rock(void **state)
{
    (void)state;
    check_split(DMB_PIPE_AXIAL_TORSIONAL, DMB_ROCK_RATE);
    check_split(DMB_PIPE_FLEXIBLE, DMB_ROCK_RATE);
}

/* Each cuts the surface that its own blades left, at a feed that the rig gives a rigid string. */
static void each_has_its_own_surface(void **state)
{
    const double feed = 2e-3, cut = 2.0 * PI * feed / spin;
    const dmb_bit_def bit = cutting(DMB_ROCK_REGENERATIVE, pilot, 0.0, 2e7);
    const dmb_bit_def reamer = cutting(DMB_ROCK_REGENERATIVE, gauge, pilot, 1e7);
    (void)state;
    drilling d = drill(DMB_PIPE_RIGID, DMB_ROCK_REGENERATIVE, 1, feed);
    take_divided_steps(&d.s, 1e-3, 3000);
    const dmb_bit_state pilot_bit = state_of(&d, d.bit), behind = state_of(&d, d.reamer);
    check_relative("weight on the bit [N]", pilot_bit.weight, weight_at(&bit, cut), 1e-6);
    check_relative("weight on the reamer [N]", behind.weight, weight_at(&reamer, cut), 1e-6);
    check_relative("torque on the bit [N m]", pilot_bit.torque, torque_at(&bit, cut), 1e-6);
    check_relative("torque on the reamer [N m]", behind.torque, torque_at(&reamer, cut), 1e-6);
    rig_close(&d.s);
}

/* The ring is there in both; a reamer adds no mass, no contact. */
static void it_adds_nothing_else(void **state)
{
    (void)state;
    drilling with = drill(DMB_PIPE_FLEXIBLE, DMB_ROCK_RATE, 1, 0.0),
             without = drill(DMB_PIPE_FLEXIBLE, DMB_ROCK_RATE, 0, 0.0);
    dmb_model_info a = dmb_model_info_default(), b = dmb_model_info_default();
    must_model(&with.s, dmb_model_get_info(with.s.model, &a));
    must_model(&without.s, dmb_model_get_info(without.s.model, &b));
    assert_true(a.mass == b.mass && a.contact_points == b.contact_points && a.nodes == b.nodes);
    const double place = pose_at(&with.s, dmb_station(with.reamer, 0, 0.0)).position[0];
    check_relative("its place is that of the ring [m]", place,
                   pose_at(&with.s, dmb_station(with.ring, 0, 0.0)).position[0], 1e-15);
    rig_close(&with.s);
    rig_close(&without.s);
}

static void it_goes_on_from_a_snapshot(void **state)
{
    (void)state;
    drilling a = drill(DMB_PIPE_FLEXIBLE, DMB_ROCK_REGENERATIVE, 1, 2e-3);
    drilling b = drill(DMB_PIPE_FLEXIBLE, DMB_ROCK_REGENERATIVE, 1, 2e-3);
    size_t size = 0;
    uint64_t first, second;
    take_divided_steps(&a.s, 1e-3, 300);
    must(&a.s, dmb_sim_snapshot_size(a.s.sim, &size));
    void *block = malloc(size);
    must(&a.s, dmb_sim_snapshot(a.s.sim, block, size));
    must(&b.s, dmb_sim_restore(b.s.sim, block, size));
    free(block);
    take_divided_steps(&a.s, 1e-3, 200);
    take_divided_steps(&b.s, 1e-3, 200);
    must(&a.s, dmb_sim_hash(a.s.sim, &first));
    must(&b.s, dmb_sim_hash(b.s.sim, &second));
    assert_true(first == second);
    rig_close(&a.s);
    rig_close(&b.s);
}

static void what_it_cannot_is_refused(void **state)
{
    rig s;
    dmb_bit_def bit = dmb_bit_def_default();
    (void)state;
    rig_open(&s, 0.0, 0.0, 0.0);
    bit.inner_radius = bit.radius;
    assert_int_equal(dmb_model_add_bit(s.model, &bit, NULL), DMB_ERR_VALUE);
    bit.inner_radius = -0.01;
    assert_int_equal(dmb_model_add_bit(s.model, &bit, NULL), DMB_ERR_VALUE);
    bit.inner_radius = (double)NAN;
    assert_int_equal(dmb_model_add_bit(s.model, &bit, NULL), DMB_ERR_NOT_FINITE);
    bit.inner_radius = 0.0;
    bit.stabiliser.index = 1;
    bit.stabiliser.generation = 77;
    assert_int_equal(dmb_model_add_bit(s.model, &bit, NULL), DMB_ERR_ID);
    assert_non_null(strstr(dmb_model_message(s.model), "stabiliser"));
    rig_close(&s);
}

/* A bit by the regenerative law that is pushed bounces: the rock takes energy all the while and gives none back, and
 * the bit is not thrown out of its hole. (Without the limit it was 50 m away after 4 s.) */
static void bouncing_bit_gets_nothing_from_the_rock(void **state)
{
    (void)state;
    drilling d = drill(DMB_PIPE_AXIAL_TORSIONAL, DMB_ROCK_REGENERATIVE, 0, 0.0);
    double spent = 0.0, deepest = 0.0, given_back = 0.0, behind = 0.0;
    for (int i = 0; i < 1500; i++) {
        take_divided_steps(&d.s, 1e-3, 1);
        const dmb_bit_state bit = state_of(&d, d.bit);
        const double now = energy_of(&d.s).rock;
        given_back = fmax(given_back, spent - now);
        spent = fmax(spent, now);
        deepest = fmax(deepest, bit.advance);
        behind = fmax(behind, deepest - bit.advance);
    }
    print_message("    %.4g J into the rock, %.3g m deep\n", spent, deepest);
    check_below("given back over what was spent", given_back / spent, 3e-3);
    check_below("behind the deepest place [m]", behind, 0.5);
    rig_close(&d.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bouncing_bit_gets_nothing_from_the_rock),
        cmocka_unit_test(weight_splits_by_width_and_rock),
        cmocka_unit_test(each_has_its_own_surface),
        cmocka_unit_test(it_adds_nothing_else),
        cmocka_unit_test(it_goes_on_from_a_snapshot),
        cmocka_unit_test(what_it_cannot_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
