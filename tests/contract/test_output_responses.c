/* Every output as the output of a frequency response at frequency 0, against the difference of what the output reads
 * in two states of equilibrium with a little more and a little less of the force that shakes. Outputs without a linear
 * answer say so. */
#include <string.h>

#include "query/query.h"
#include "rig.h"

typedef struct scene {
    rig r;
    dmb_id string, bit, body, joint, drive, load, stuck;
    double base; /* [N] of the load in the state */
} scene;

#define SHAKEN 0.5 /* [N] to either side */

/* A beam in a hole that lies on its low side, with a bit; a bar on a hinge that turns against a spring and is tied to
 * the beam, with a speed controller that gives nothing at rest. The load bends the beam and pulls it. */
static void add_mechanism(scene *s)
{
    const dmb_id ground = {0, 0};
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_spring_def tie = dmb_spring_def_default();
    body.position[0] = 1.0;
    body.position[1] = 1.0;
    body.mass = 2.0;
    s->body = add_body(&s->r, &body);
    dmb_joint_def joint =
        joint_between(DMB_JOINT_CYLINDRICAL, dmb_station(ground, 0, 0.0), dmb_station(s->body, 0, 0.0));
    joint.match = 1;
    joint.stiffness[DMB_X] = 1e3;
    joint.stiffness[DMB_RX] = 1e3;
    s->joint = add_joint(&s->r, &joint);
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = s->joint;
    drive.component = DMB_RX;
    drive.gain = 3.0;
    drive.time_function = add_constant(&s->r, 0.0);
    s->drive = add_drive(&s->r, &drive);
    tie.place_a = dmb_station(s->string, 0, 0.6);
    tie.place_b = dmb_station(s->body, 0, 0.0);
    tie.offset_b[2] = 0.3;
    tie.stiffness = 1e4;
    must_model(&s->r, dmb_model_add_spring(s->r.model, &tie, NULL));
}

static void open_scene(scene *s, double load)
{
    dmb_wall_def hole = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = beam_pipe(3.0, 6, 1e7, 1e7, 1e4, 1e4);
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_load_def push = dmb_load_def_default();
    memset(s, 0, sizeof *s);
    rig_open(&s->r, 0.0, 0.0, -9.81);
    hole.stiffness = 1e5;
    (void)add_wall(&s->r, &hole);
    string.start_free = DMB_FREE_NONE;
    s->string = add_string(&s->r, &string);
    pipe.string = s->string;
    pipe.outer_diameter = 0.09;
    (void)add_pipes(&s->r, &pipe, 1);
    bit.diameter = 0.0;
    must_model(&s->r, dmb_model_add_bit(s->r.model, &bit, &s->bit));
    push.place = dmb_station(s->string, 0, 0.8);
    push.force[0] = load;
    push.force[1] = 2.0 * load;
    push.force[2] = -3.0 * load;
    push.moment[0] = 0.5 * load;
    s->load = add_load(&s->r, &push);
    add_mechanism(s);
    (void)rig_start(&s->r, NULL);
    dmb_static_options options = dmb_static_options_default();
    options.tolerance = 1e-12;
    (void)find_equilibrium(&s->r, &options);
}

/* The place that a output of that kind is read at; 0: this scene has none. */
static int place_of(const scene *s, int32_t kind, dmb_place *place)
{
    const dmb_id none = {0, 0};
    *place = dmb_station(none, 0, 0.0);
    switch (kind) {
    case DMB_AT_PLACE: *place = dmb_station(s->body, 0, 0.0); return 1;
    case DMB_AT_SECTION:
    case DMB_AT_PIPE: *place = dmb_station(s->string, 0, 0.45); return 1;
    case DMB_AT_PART:
    case DMB_AT_STRING: *place = dmb_station(s->string, 0, 0.0); return 1;
    case DMB_AT_BIT: *place = dmb_station(s->bit, 0, 0.0); return 1;
    case DMB_AT_DRIVE: *place = dmb_station(s->drive, 0, 0.0); return 1;
    case DMB_AT_JOINT:
    case DMB_AT_CONSTRAINT: *place = dmb_station(s->joint, 0, 0.0); return 1;
    case DMB_AT_CONTACT: place->pipe = 4; return 1;
    case DMB_AT_SCENE: return 1;
    default: return 0;
    }
}

/* The answer to all of the load together, which is its force and moment at one place. */
static int32_t transfer(scene *s, int32_t quantity, dmb_place place, double value[2])
{
    static const double shares[4] = {1.0, 2.0, -3.0, 0.5};
    static const int32_t components[4] = {DMB_X, DMB_Y, DMB_Z, DMB_RX};
    dmb_response_options options = dmb_response_options_default();
    dmb_excitation inputs[4];
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    dmb_response *found = NULL;
    for (int i = 0; i < 4; i++) {
        inputs[i] = dmb_excitation_default();
        inputs[i].place = dmb_station(s->string, 0, 0.8);
        inputs[i].component = components[i];
        inputs[i].amplitude = shares[i];
    }
    output.quantity = quantity;
    output.place = place;
    options.points = 1;
    options.frequency_low = options.frequency_high = 0.0;
    const int32_t status = dmb_analysis_response(s->r.sim, &options, inputs, 4, &output, 1, &found);
    if (status >= 0) must(&s->r, dmb_response_transfer(found, DMB_COMBINED, 0, value));
    dmb_response_destroy(&found);
    return status;
}

static int compare(scene at[3], int32_t quantity)
{
    dmb_output reading = {.quantity = quantity};
    double got[2] = {0.0, 0.0}, read[3];
    if (!place_of(&at[1], dmb_output_name_of(quantity)->place, &reading.place)) return 0;
    const int32_t status = transfer(&at[1], quantity, reading.place, got);
    if (status == DMB_ERR_UNSUPPORTED || status == DMB_ERR_VALUE) {
        if (strstr(dmb_sim_message(at[1].r.sim), "output 0, ") == NULL) fail_msg("%s", dmb_sim_message(at[1].r.sim));
        return 0;
    }
    for (int i = 0; i < 3; i++) {
        (void)place_of(&at[i], dmb_output_name_of(quantity)->place, &reading.place);
        const int32_t asked = dmb_query_output(at[i].r.sim, &reading, &read[i]);
        if (asked < 0 || status < 0)
            fail_msg("%s: %s, %s: %s", dmb_output_name(quantity, NULL), dmb_status_name(asked), dmb_status_name(status),
                     dmb_sim_message(at[1].r.sim));
    }
    /* Turns of a bent beam differ by the square of its slope from those about the body's axis. */
    const double wanted = (read[2] - read[0]) / (2.0 * SHAKEN);
    const double curved = fabs(read[2] - 2.0 * read[1] + read[0]) / SHAKEN; /* what a difference cannot tell */
    const double bound = 1e-3 * fabs(wanted) + curved + 1e-9 * (1.0 + fabs(read[1]));
    if (!(fabs(got[0] - wanted) <= bound) || got[1] != 0.0)
        fail_msg("%s: %.9g + %.3gi, difference %.9g, bound %.3g", dmb_output_name(quantity, NULL), got[0], got[1],
                 wanted, bound);
    return wanted != 0.0;
}

static void every_output(void **state)
{
    (void)state;
    scene at[3];
    int compared = 0, moving = 0;
    for (int i = 0; i < 3; i++) open_scene(&at[i], 40.0 + (i - 1) * SHAKEN);
    for (int32_t q = dmb_output_next(-1); q >= 0; q = dmb_output_next(q)) {
        compared++;
        moving += compare(at, q);
    }
    print_message("    %d outputs, %d of them with an answer that is not 0\n", compared, moving);
    assert_true(moving > 40);
    for (int i = 0; i < 3; i++) rig_close(&at[i].r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_output)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
