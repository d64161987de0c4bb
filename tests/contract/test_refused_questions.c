/* Questions of analyses that are refused, one by one: the status, and the words and bounds of the message; the sim is
 * as it was. */
#include <stdlib.h>
#include <string.h>

#include "rig.h"

typedef struct subject {
    rig r;
    dmb_id string, body, joint, drive;
    dmb_place place;
} subject;

static void expect(const subject *c, int32_t status, int32_t wanted, const char *words)
{
    must_refuse(dmb_sim_message(c->r.sim), status, wanted, words);
}

static void begin(subject *c, double gravity)
{
    memset(c, 0, sizeof *c);
    rig_open(&c->r, 0.0, 0.0, gravity);
}

/* A beam of 2 m that is held at its rig end. */
static void begin_beam(subject *c, double gravity)
{
    const dmb_pipe_def pipe = beam_pipe(2.0, 4, 1e7, 1e7, 1e4, 1e4);
    begin(c, gravity);
    c->string = add_beam(&c->r, &pipe, DMB_FREE_NONE);
    c->place = dmb_station(c->string, 0, 1.0);
}

/* ---- Arrays and rows of a place ---------------------------------------------------------------------------------- */

static void arrays(void **state)
{
    (void)state;
    subject c;
    double values[24];
    uint64_t count = 1;
    uint32_t rows[24], number;
    begin_beam(&c, 0.0);
    (void)rig_start(&c.r, NULL);
    const uint64_t before = rig_hash(&c.r);
    expect(&c, dmb_analysis_array(c.r.sim, -1, values, &count), DMB_ERR_VALUE,
           "array = -1, must be DMB_ARRAY_VELOCITY");
    expect(&c, dmb_analysis_array(c.r.sim, DMB_ARRAY_RESIDUAL + 1, values, &count), DMB_ERR_VALUE,
           "must be DMB_ARRAY_");
    expect(&c, dmb_analysis_array(c.r.sim, DMB_ARRAY_VELOCITY, values, &count), DMB_ERR_VALUE,
           "*count = 1, must be >= 30");
    assert_int_equal(dmb_analysis_array(c.r.sim, DMB_ARRAY_VELOCITY, NULL, &count), DMB_OK);
    assert_int_equal(count, 30);
    expect(&c, dmb_analysis_place_rows(c.r.sim, c.place, DMB_FRAME_WORLD, 6, rows, values, &number), DMB_ERR_VALUE,
           "component = 6, must be 0 .. 5");
    expect(&c, dmb_analysis_place_rows(c.r.sim, c.place, DMB_FRAME_HOLE, 0, rows, values, &number), DMB_ERR_VALUE,
           "frame = 2, must be 0 .. 1");
    expect(&c, dmb_analysis_place_rows(c.r.sim, dmb_station(c.string, 1, 0.0), 0, 0, rows, values, &number),
           DMB_ERR_VALUE, "place, pipe 1 at 0: ");
    assert_true(rig_hash(&c.r) == before);
    rig_close(&c.r);
}

/* ---- State space, stepped sines ---------------------------------------------------------------------------------- */

static void states_out_of_balance(void **state)
{
    (void)state;
    subject c;
    dmb_state_space *space = NULL;
    dmb_state_space_options options = dmb_state_space_options_default();
    begin_beam(&c, -9.81);
    (void)rig_start(&c.r, NULL);
    expect(&c, dmb_analysis_state_space(c.r.sim, NULL, NULL, 0, NULL, 0, &space), DMB_ERR_VALUE,
           "state: not an equilibrium");
    assert_null(space);
    options.form = DMB_STATE_MATRICES;
    must(&c.r, dmb_analysis_state_space(c.r.sim, &options, NULL, 0, NULL, 0, &space));
    dmb_state_space_destroy(&space);
    rig_close(&c.r);
}

static void stepped_sines(void **state)
{
    (void)state;
    subject c;
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    double amplitudes[64];
    begin_beam(&c, 0.0);
    (void)rig_start(&c.r, NULL);
    output.place = c.place;
    options.struct_size = 3;
    expect(&c, dmb_analysis_stepped_sine(c.r.sim, 10.0, &options, &output, 1, amplitudes, NULL), DMB_ERR_STRUCT_SIZE,
           "sine options: struct_size");
    options = dmb_stepped_sine_options_default();
    options.steps_per_period = 16;
    options.harmonics = 3;
    expect(&c, dmb_analysis_stepped_sine(c.r.sim, 10.0, &options, &output, 1, amplitudes, NULL), DMB_ERR_VALUE,
           "harmonics = 3, must be <= steps_per_period/8");
    options.harmonics = 1;
    output.place.pipe = 1;
    expect(&c, dmb_analysis_stepped_sine(c.r.sim, 10.0, &options, &output, 1, amplitudes, NULL), DMB_ERR_VALUE,
           "output 0, vibration_x of string 0 pipe 1 at 1: ");
    rig_close(&c.r);
}

/* ---- Steady states: what may act on parts that move -------------------------------------------------------------- */

static int32_t nothing(void *context, double time, uint32_t count, const double (*poses)[12],
                       const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                       const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)poses, (void)velocities, (void)forces, (void)tangent, (void)potential;
    return 0;
}

typedef enum extra { NOTHING, SPRING_ACROSS, FORCE, STUCK } extra;

static void add_spring(const subject *c, dmb_place a, dmb_place b)
{
    dmb_spring_def spring = dmb_spring_def_default();
    spring.place_a = a;
    spring.place_b = b;
    spring.offset_b[1] = 1.0;
    spring.stiffness = 1.0;
    must_model(&c->r, dmb_model_add_spring(c->r.model, &spring, NULL));
}

static void add_extra(const subject *c, extra what)
{
    const dmb_id ground = {0, 0};
    dmb_force_def force = dmb_force_def_default();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    force.place[0] = stuck.place = c->place;
    force.callback = nothing;
    if (what == SPRING_ACROSS) add_spring(c, dmb_station(ground, 0, 0.0), c->place);
    if (what == FORCE) must_model(&c->r, dmb_model_add_force(c->r.model, &force, NULL));
    if (what == STUCK) must_model(&c->r, dmb_model_add_stuck(c->r.model, &stuck, NULL));
}

/* A string that turns at 3 rad/s in free space. */
static void begin_turning(subject *c, extra what)
{
    const dmb_pipe_def pipe = beam_pipe(2.0, 4, 1e7, 1e7, 1e4, 1e4);
    begin(c, 0.0);
    c->string = add_beam(&c->r, &pipe, DMB_FREE_RX);
    c->place = dmb_station(c->string, 0, 1.0);
    (void)add_simple_drive(&c->r, DMB_DRIVE_MOTION, c->string, DMB_RX, add_constant(&c->r, 3.0));
    add_extra(c, what);
    (void)rig_start(&c->r, NULL);
}

static void steady_states(void **state)
{
    static const struct {
        extra what;
        int32_t status;
        const char *words;
    } rows[] = {{NOTHING, DMB_OK, ""},
                {SPRING_ACROSS, DMB_ERR_UNSUPPORTED, "static: spring 0: its points move at 0 and 3 m/s"},
                {FORCE, DMB_ERR_UNSUPPORTED, "static: force 0: place 0 moves at 3, must stand still"},
                {STUCK, DMB_ERR_UNSUPPORTED, "static: stuck 0 moves at 3, must stand still, since it is held"}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        subject c;
        dmb_static_options options = dmb_static_options_default();
        begin_turning(&c, rows[i].what);
        const uint64_t before = rig_hash(&c.r);
        options.steady = DMB_STEADY_RIGID;
        expect(&c, dmb_analysis_static(c.r.sim, &options, NULL), rows[i].status, rows[i].words);
        if (rows[i].status < 0) assert_true(rig_hash(&c.r) == before);
        rig_close(&c.r);
    }
}

/* ---- Factors of a part ------------------------------------------------------------------------------------------- */

static void factors(void **state)
{
    (void)state;
    subject c;
    dmb_body_def body = dmb_body_def_default();
    dmb_path_options options = dmb_path_options_default();
    const dmb_id ground = {0, 0};
    begin_beam(&c, 0.0);
    body.position[2] = 1.0;
    c.body = add_body(&c.r, &body);
    c.joint = add_joint_between(&c.r, DMB_JOINT_REVOLUTE, dmb_station(ground, 0, 0.0), dmb_station(c.body, 0, 0.0));
    options.part = add_simple_drive(&c.r, DMB_DRIVE_MOTION, c.joint, DMB_RX, add_constant(&c.r, 0.0));
    (void)rig_start(&c.r, NULL);
    options.scale = 3;
    expect(&c, dmb_analysis_path(c.r.sim, &options, NULL), DMB_ERR_VALUE, "path options: scale = 3, must be 0 .. 2");
    options.scale = DMB_SCALE_PART;
    expect(&c, dmb_analysis_path(c.r.sim, &options, NULL), DMB_ERR_UNSUPPORTED, "drive 0 moves a joint");
    options.part = c.body;
    expect(&c, dmb_analysis_path(c.r.sim, &options, NULL), DMB_ERR_ID, "part names no load and no drive");
    rig_close(&c.r);
}

/* A column that its rig end is pushed into: the far end is held by a joint, free to turn. The stiffness passes 0 at the
 * shortening L P/EA of Euler's load P = (1.4303 pi/L)^2 EI; the shear of the beam takes off about EI/(GA L^2). */
static void column_that_a_drive_shortens(void **state)
{
    (void)state;
    subject c;
    const double L = 2.0, EI = 1e3, EA = 1e7;
    const dmb_pipe_def pipe = beam_pipe(L, 16, EA, EA, 1e4, EI);
    const dmb_id ground = {0, 0};
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling *found = NULL;
    double factor = 0.0;
    begin(&c, 0.0);
    c.string = add_beam(&c.r, &pipe, DMB_FREE_X);
    dmb_joint_def pin = joint_between(DMB_JOINT_SPHERICAL, dmb_station(ground, 0, 0.0), dmb_station(c.string, 0, 1.0));
    pin.match = 1;
    (void)add_joint(&c.r, &pin);
    c.drive = add_simple_drive(&c.r, DMB_DRIVE_MOTION, c.string, DMB_X, add_constant(&c.r, 0.0));
    (void)rig_start(&c.r, NULL);
    options.scale = DMB_SCALE_PART;
    options.part = c.drive;
    options.follow = 0;
    const int32_t status = dmb_analysis_buckling(c.r.sim, &options, &found);
    if (status < 0) fail_msg("%s: %s", dmb_status_name(status), dmb_sim_message(c.r.sim));
    must(&c.r, dmb_buckling_factor(found, 0, &factor));
    const double P = 1.4303 * 1.4303 * PI * PI * EI / (L * L);
    check_relative("critical shortening [m]", factor, L * P / EA, 5e-3);
    dmb_buckling_destroy(&found);
    rig_close(&c.r);
}

/* ---- Sensitivities ----------------------------------------------------------------------------------------------- */

typedef struct sides {
    dmb_sim *low, *high;
} sides;

static int32_t create(const subject *c, const sides *beside)
{
    dmb_parameter p = dmb_parameter_default();
    dmb_sensitivity *made = NULL;
    p.low = beside->low;
    p.high = beside->high;
    p.step = 1e-6;
    const int32_t status = dmb_sensitivity_create(c->r.sim, &p, 1, &made);
    assert_true(status >= 0 || made == NULL);
    dmb_sensitivity_destroy(&made);
    return status;
}

static void sensitivities_by_multipliers(void **state)
{
    (void)state;
    subject c;
    sides beside = {NULL, NULL};
    dmb_body_def body = dmb_body_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    const dmb_id ground = {0, 0};
    begin(&c, 0.0);
    c.body = add_body(&c.r, &body);
    (void)add_joint_between(&c.r, DMB_JOINT_REVOLUTE, dmb_station(ground, 0, 0.0), dmb_station(c.body, 0, 0.0));
    options.constraint_method = DMB_METHOD_MULTIPLIERS;
    (void)rig_start(&c.r, &options);
    must_model(&c.r, dmb_sim_create(c.r.model, &options, &beside.low));
    must_model(&c.r, dmb_sim_create(c.r.model, &options, &beside.high));
    expect(&c, create(&c, &beside), DMB_ERR_UNSUPPORTED, "constraint_method = DMB_METHOD_MULTIPLIERS");
    dmb_sim_destroy(&beside.low);
    dmb_sim_destroy(&beside.high);
    rig_close(&c.r);
}

/* An input on its way to what is set, of the sim and of one beside it. */
static void sensitivities_on_the_way(void **state)
{
    (void)state;
    for (int of_side = 0; of_side < 2; of_side++) {
        subject c;
        sides beside = {NULL, NULL};
        dmb_input_def input = dmb_input_def_default();
        dmb_id id;
        begin_beam(&c, 0.0);
        dmb_load_def load = dmb_load_def_default();
        load.place = c.place;
        input.part = add_load(&c.r, &load);
        input.target = DMB_TARGET_LOAD_FACTOR;
        input.rate_limit = 1.0;
        strcpy(input.name, "pull");
        must_model(&c.r, dmb_model_add_input(c.r.model, &input, &id));
        (void)rig_start(&c.r, NULL);
        must_model(&c.r, dmb_sim_create(c.r.model, NULL, &beside.low));
        must_model(&c.r, dmb_sim_create(c.r.model, NULL, &beside.high));
        assert_int_equal(dmb_sim_set_input(of_side ? beside.low : c.r.sim, id, 5.0), DMB_OK);
        expect(&c, create(&c, &beside), DMB_ERR_VALUE,
               of_side ? "(pull) still changing towards its set point"
                       : "input 0 (pull) is still changing towards its set point");
        dmb_sim_destroy(&beside.low);
        dmb_sim_destroy(&beside.high);
        rig_close(&c.r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays),
        cmocka_unit_test(states_out_of_balance),
        cmocka_unit_test(stepped_sines),
        cmocka_unit_test(steady_states),
        cmocka_unit_test(factors),
        cmocka_unit_test(column_that_a_drive_shortens),
        cmocka_unit_test(sensitivities_by_multipliers),
        cmocka_unit_test(sensitivities_on_the_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
