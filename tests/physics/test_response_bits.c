/* Responses of bits that drill: the weight of a string that has a reamer, beside another string with a bit of its own,
 * is that of its one bit; and on the axis of the hole it is what it is for pipes that may bend. */
#include <string.h>

#include "drillmbd/scene.h"
#include "harmonic.h"

#define FEED 0.02      /* [m/s] */
#define TURNING 20.943 /* [rad/s] */

typedef struct drilling {
    rig s;
    dmb_id string, bit, feed;
} drilling;

static dmb_id add_drilling_string(rig *s, int32_t kind, double aside, dmb_id *feed)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    def.follows_hole = aside == 0.0;
    def.position[1] = aside;
    def.velocity[0] = FEED;
    def.velocity[3] = TURNING;
    pipe.kind = kind;
    pipe.damping_time = 1e-3;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 2);
    *feed = add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_X, add_constant(s, FEED));
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s, TURNING));
    return pipe.string;
}

static dmb_id add_bit(rig *s, dmb_id string, dmb_id ring)
{
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_id id = {0, 0};
    bit.rock_law = DMB_ROCK_RATE;
    bit.string = string;
    bit.stabiliser = ring;
    if (ring.generation != 0) bit.inner_radius = bit.radius, bit.radius += 0.02;
    must_model(s, dmb_model_add_bit(s->model, &bit, &id));
    return id;
}

/* crowded: with a reamer, beside the other string. */
static drilling drill(int32_t kind, int crowded)
{
    drilling d;
    dmb_wall_def hole = s1_hole();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    dmb_id other_feed, reamed = {0, 0};
    const dmb_id none = {0, 0};
    rig_open(&d.s, 0.0, 0.0, 0.0);
    hole.diameter = 0.16;
    hole.normal_law = DMB_NORMAL_NONE;
    (void)add_wall(&d.s, &hole);
    d.string = add_drilling_string(&d.s, kind, 0.0, &d.feed);
    if (crowded) {
        const dmb_id other = add_drilling_string(&d.s, kind, 5.0, &other_feed);
        ring.string = d.string;
        ring.pipe = 1;
        ring.fraction = 0.5;
        ring.outer_diameter = 0.134;
        must_model(&d.s, dmb_model_add_stabiliser(d.s.model, &ring, &reamed));
        (void)add_bit(&d.s, d.string, reamed);
        (void)add_bit(&d.s, other, none);
    }
    d.bit = add_bit(&d.s, d.string, none);
    (void)rig_start(&d.s, NULL);
    take_divided_steps(&d.s, 1e-3, 400);
    return d;
}

static double complex weight_by(const drilling *d, const dmb_output *output)
{
    const double frequency = 8.0;
    double complex h = 0.0;
    dmb_response_options options = dmb_response_options_default();
    const dmb_excitation input = input_of(DMB_EXCITATION_DRIVE, d->feed, DMB_X);
    options.equilibrium_tolerance = 1.0;
    transfer(&d->s, &options, &input, output, &frequency, 1, &h);
    assert_true(cabs(h) > 0.0);
    return h;
}

static void one_bit_of_a_string(void **state)
{
    (void)state;
    drilling d = drill(DMB_PIPE_FLEXIBLE, 1);
    const dmb_output bit = output_at(DMB_OUTPUT_BIT_ROCK_WEIGHT, dmb_station(d.bit, 0, 0.0), 0);
    const dmb_output reading = output_at(DMB_OUTPUT_WEIGHT_ON_BIT, dmb_station(d.string, 0, 0.0), 0);
    const double complex wanted = weight_by(&d, &bit);
    check_below("weight of the string", cabs(weight_by(&d, &reading) / wanted - 1.0), 1e-12);
    rig_close(&d.s);
}

static void on_the_axis_of_the_hole(void **state)
{
    (void)state;
    double complex weight[2][2];
    for (int path = 0; path < 2; path++) {
        drilling d = drill(path ? DMB_PIPE_AXIAL_TORSIONAL : DMB_PIPE_FLEXIBLE, 0);
        for (int c = 0; c < 2; c++) {
            const dmb_output bit =
                output_at(c == 0 ? DMB_OUTPUT_BIT_ROCK_WEIGHT : DMB_OUTPUT_BIT_TORQUE, dmb_station(d.bit, 0, 0.0), 0);
            weight[path][c] = weight_by(&d, &bit);
        }
        rig_close(&d.s);
    }
    check_below("weight, on the axis", cabs(weight[1][0] / weight[0][0] - 1.0), 1e-3);
    check_below("torque", cabs(weight[1][1] / weight[0][1] - 1.0), 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_bit_of_a_string),
        cmocka_unit_test(on_the_axis_of_the_hole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
