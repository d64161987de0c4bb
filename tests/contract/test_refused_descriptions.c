/* Descriptions that are refused, one by one: the status, the part and the bound that the message tells. */
#include <string.h>

#include "rig.h"

typedef struct subject {
    rig r;
    dmb_id string, body, joint, drive, load;
} subject;

/* ---- Parts ------------------------------------------------------------------------------------------------------- */

static void expect(const subject *c, int32_t status, int32_t wanted, const char *words)
{
    must_refuse(dmb_model_message(c->r.model), status, wanted, words);
}

static void begin(subject *c)
{
    memset(c, 0, sizeof *c);
    rig_open(&c->r, 0.0, 0.0, -9.81);
}

static void begin_string(subject *c, int32_t kind)
{
    dmb_pipe_def pipe = s1_pipe();
    begin(c);
    pipe.kind = kind;
    c->string = add_pipes(&c->r, &pipe, 2);
}

static void begin_body(subject *c)
{
    const dmb_body_def body = dmb_body_def_default();
    begin(c);
    c->body = add_body(&c->r, &body);
}

static void end(subject *c)
{
    rig_close(&c->r);
}

/* ---- Inputs ------------------------------------------------------------------------------------------------------ */

static dmb_input_def input_of(const char *name, int32_t target, dmb_id part)
{
    dmb_input_def input = dmb_input_def_default();
    strcpy(input.name, name);
    input.target = target;
    input.part = part;
    return input;
}

static void inputs(void **state)
{
    (void)state;
    subject c;
    dmb_stuck_def stuck = dmb_stuck_def_default();
    dmb_id jam;
    begin_string(&c, DMB_PIPE_FLEXIBLE);
    dmb_input_def input = input_of("friction", DMB_TARGET_FRICTION, c.string);
    expect(&c, dmb_model_add_input(c.r.model, &input, NULL), DMB_ERR_ID, "part must be {0, 0}");
    stuck.place = dmb_station(c.string, 0, 0.5);
    must_model(&c.r, dmb_model_add_stuck(c.r.model, &stuck, &jam));
    input = input_of("jam", DMB_TARGET_STUCK, jam);
    input.initial = 0.5;
    expect(&c, dmb_model_add_input(c.r.model, &input, NULL), DMB_ERR_VALUE, "0 (free) or 1 (stuck)");
    must_model(&c.r, dmb_model_clear_refused(c.r.model));
    input = input_of("wear", DMB_TARGET_FRICTION, (dmb_id){0, 0});
    must_model(&c.r, dmb_model_add_input(c.r.model, &input, NULL));
    expect(&c, dmb_model_compile(c.r.model, NULL), DMB_ERR_UNSUPPORTED, "input (wear): target = DMB_TARGET_FRICTION");
    end(&c);
}

/* The lower limit by its input, the upper one as described. */
static void limits_that_cross(void **state)
{
    (void)state;
    subject c;
    begin_string(&c, DMB_PIPE_FLEXIBLE);
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_CONTROL;
    drive.gain = 1.0;
    drive.limit_high = 10.0;
    drive.time_function = add_constant(&c.r, 0.0);
    c.drive = add_drive(&c.r, &drive);
    dmb_input_def input = input_of("least", DMB_TARGET_LIMIT_LOW, c.drive);
    input.initial = 20.0;
    must_model(&c.r, dmb_model_add_input(c.r.model, &input, NULL));
    expect(&c, dmb_model_compile(c.r.model, NULL), DMB_ERR_VALUE,
           "input (least): initial: limit_low = 20 of its drive at time 0, must be < limit_high = 10");
    end(&c);
}

static void densities(void **state)
{
    static const struct {
        int flows, adds;
        const char *why;
    } rows[] = {{0, 1, "added_mass is 0"}, {1, 0, "flow_rate is 0"}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        subject c;
        dmb_environment_def around = dmb_environment_def_default();
        begin_string(&c, DMB_PIPE_FLEXIBLE);
        const dmb_wall_def hole = s1_hole();
        (void)add_wall(&c.r, &hole);
        around.fluid_density = around.inner_density = 1100.0;
        if (rows[i].adds) around.added_mass = 1.0;
        if (rows[i].flows) around.flow_rate = 0.01, around.consistency = 0.02;
        must_model(&c.r, dmb_model_set_environment(c.r.model, &around));
        const dmb_input_def input = input_of("mud", DMB_TARGET_FLUID_DENSITY, (dmb_id){0, 0});
        must_model(&c.r, dmb_model_add_input(c.r.model, &input, NULL));
        expect(&c, dmb_model_compile(c.r.model, NULL), DMB_ERR_UNSUPPORTED, rows[i].why);
        end(&c);
    }
}

/* ---- Drives and motors ------------------------------------------------------------------------------------------- */

static void tables_of_drives(void **state)
{
    (void)state;
    subject c;
    begin_string(&c, DMB_PIPE_FLEXIBLE);
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_CONTROL;
    drive.time_function = add_constant(&c.r, 0.0);
    drive.gain_count = 2;
    drive.curve_speed[1] = drive.gain_error[1] = 1e-13;
    drive.gain_force[1] = 1.0;
    expect(&c, dmb_model_add_drive(c.r.model, &drive, NULL), DMB_ERR_VALUE, "gain_error = 1e-13, must be > the one");
    drive.gain_count = 0;
    drive.curve_count = 2;
    expect(&c, dmb_model_add_drive(c.r.model, &drive, NULL), DMB_ERR_VALUE, "curve_speed = 1e-13, must be > the one");
    end(&c);
}

/* Torque falls to 0 before its speed is reached, and stays so: the table that brakes begins with a level piece. */
static void motor_that_fades_out(void **state)
{
    (void)state;
    dmb_motor motor = dmb_motor_default();
    dmb_drive_def drive = dmb_drive_def_default();
    double speed = 0.0;
    motor.brakes = 1;
    motor.flow = 0.01;
    motor.table_count = 3;
    motor.table_speed[1] = 5.0, motor.table_speed[2] = 10.0;
    motor.table_torque[0] = 100.0;
    assert_int_equal(dmb_motor_drive(&motor, &drive, &speed), DMB_OK);
    assert_true(speed == 10.0);
    assert_int_equal(drive.gain_count, 4);
    const double error[4] = {-10.0, 0.0, 5.0, 10.0}, force[4] = {0.0, 0.0, 0.0, 100.0};
    for (int i = 0; i < 4; i++) {
        check_close("error of speed [rad/s]", drive.gain_error[i], error[i], 1e-12);
        check_close("torque [N m]", drive.gain_force[i], force[i], 1e-12);
    }
}

/* ---- Springs and forces ------------------------------------------------------------------------------------------ */

static void springs(void **state)
{
    static const double close[2] = {0.0, 1e-13}, apart[2] = {0.0, 1.0}, falling[2] = {1.0, 0.0};
    (void)state;
    subject c;
    begin_body(&c);
    dmb_spring_def spring = dmb_spring_def_default();
    spring.stiffness = 1.0;
    expect(&c, dmb_model_add_spring(c.r.model, &spring, NULL), DMB_ERR_VALUE, "place_b = the ground as place_a");
    spring.place_a = spring.place_b = dmb_station(c.body, 0, 0.0);
    spring.offset_a[1] = spring.offset_b[1] = 0.5;
    expect(&c, dmb_model_add_spring(c.r.model, &spring, NULL), DMB_ERR_VALUE, "the point of place_a");
    spring.offset_a[1] = 1.0;
    spring.stiffness = 0.0;
    spring.table_count = 2;
    spring.table_elongation = close;
    spring.table_force = falling;
    expect(&c, dmb_model_add_spring(c.r.model, &spring, NULL), DMB_ERR_VALUE, "table_elongation = 1e-13");
    spring.table_elongation = apart;
    spring.acts = DMB_SPRING_TENSION;
    expect(&c, dmb_model_add_spring(c.r.model, &spring, NULL), DMB_ERR_VALUE, "table_force = 0, must be >= the one");
    end(&c);
}

/* Points in one place have no direction between them, unless nothing acts there. */
static void spring_without_length(void **state)
{
    (void)state;
    for (int relaxed = 0; relaxed < 2; relaxed++) {
        subject c;
        begin_body(&c);
        dmb_spring_def spring = dmb_spring_def_default();
        spring.place_b = dmb_station(c.body, 0, 0.0);
        spring.stiffness = 10.0;
        spring.free_length = relaxed ? 0.0 : 1.0;
        must_model(&c.r, dmb_model_add_spring(c.r.model, &spring, NULL));
        const int32_t status = dmb_model_compile(c.r.model, NULL);
        if (relaxed)
            assert_int_equal(status, DMB_OK);
        else
            expect(&c, status, DMB_ERR_GEOMETRY, "its points are 0 m apart at time 0");
        end(&c);
    }
}

static int32_t nothing(void *context, double time, uint32_t count, const double (*poses)[12],
                       const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                       const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)count, (void)poses, (void)velocities, (void)forces, (void)tangent, (void)potential;
    return 0;
}

static void force_on_what_a_joint_holds(void **state)
{
    (void)state;
    subject c;
    begin_body(&c);
    const dmb_id ground = {0, 0};
    c.joint = add_joint_between(&c.r, DMB_JOINT_REVOLUTE, dmb_station(ground, 0, 0.0), dmb_station(c.body, 0, 0.0));
    dmb_force_def force = dmb_force_def_default();
    force.place[0] = dmb_station(c.joint, 0, 0.0);
    force.component[0] = DMB_X;
    force.callback = nothing;
    expect(&c, dmb_model_add_force(c.r.model, &force, NULL), DMB_ERR_VALUE,
           "component[0] = 0, must be free in its joint");
    force.component[0] = DMB_RX;
    must_model(&c.r, dmb_model_add_force(c.r.model, &force, NULL));
    end(&c);
}

/* ---- Holes, rings, bits, mud ------------------------------------------------------------------------------------- */

static void stuck_sideways_on_the_axis(void **state)
{
    (void)state;
    subject c;
    const dmb_wall_def hole = s1_hole();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    begin_string(&c, DMB_PIPE_AXIAL_TORSIONAL);
    (void)add_wall(&c.r, &hole);
    stuck.place = dmb_station(c.string, 0, 0.5);
    stuck.holds = DMB_STUCK_AXIAL | DMB_STUCK_LATERAL;
    must_model(&c.r, dmb_model_add_stuck(c.r.model, &stuck, NULL));
    expect(&c, dmb_model_compile(c.r.model, NULL), DMB_ERR_UNSUPPORTED, "without DMB_STUCK_LATERAL");
    end(&c);
}

static void bit_that_cuts_sideways_on_the_axis(void **state)
{
    (void)state;
    subject c;
    const dmb_wall_def hole = s1_hole();
    dmb_bit_def bit = dmb_bit_def_default();
    begin_string(&c, DMB_PIPE_AXIAL_TORSIONAL);
    (void)add_wall(&c.r, &hole);
    bit.rock_law = DMB_ROCK_RATE;
    bit.side_cutting = 0.1;
    bit.diameter = 0.0;
    must_model(&c.r, dmb_model_add_bit(c.r.model, &bit, NULL));
    expect(&c, dmb_model_compile(c.r.model, NULL), DMB_ERR_UNSUPPORTED, "bit 0: side_cutting = 0.1, must be 0 behind");
    end(&c);
}

static void sections_without_a_wall(void **state)
{
    (void)state;
    subject c;
    dmb_hole_section section = dmb_hole_section_default();
    begin_string(&c, DMB_PIPE_FLEXIBLE);
    section.diameter = 0.1;
    must_model(&c.r, dmb_model_add_hole_sections(c.r.model, &section, 1));
    expect(&c, dmb_model_compile(c.r.model, NULL), DMB_ERR_ORDER, "hole sections: there are 1 and no wall");
    end(&c);
}

static void ring_without_pipes(void **state)
{
    (void)state;
    subject c;
    const dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    begin_body(&c);
    must_model(&c.r, dmb_model_add_stabiliser(c.r.model, &ring, NULL));
    expect(&c, dmb_model_compile(c.r.model, NULL), DMB_ERR_ID, "the model's first string, and there is none");
    end(&c);
}

static void mud_without_a_hole(void **state)
{
    (void)state;
    subject c;
    dmb_environment_def around = dmb_environment_def_default();
    begin_string(&c, DMB_PIPE_FLEXIBLE);
    around.fluid_density = around.inner_density = 1100.0;
    around.flow_rate = 0.01;
    around.consistency = 0.02;
    must_model(&c.r, dmb_model_set_environment(c.r.model, &around));
    expect(&c, dmb_model_compile(c.r.model, NULL), DMB_ERR_UNSUPPORTED, "without a string that follows its hole");
    end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inputs),
        cmocka_unit_test(limits_that_cross),
        cmocka_unit_test(densities),
        cmocka_unit_test(tables_of_drives),
        cmocka_unit_test(motor_that_fades_out),
        cmocka_unit_test(springs),
        cmocka_unit_test(spring_without_length),
        cmocka_unit_test(force_on_what_a_joint_holds),
        cmocka_unit_test(stuck_sideways_on_the_axis),
        cmocka_unit_test(bit_that_cuts_sideways_on_the_axis),
        cmocka_unit_test(sections_without_a_wall),
        cmocka_unit_test(ring_without_pipes),
        cmocka_unit_test(mud_without_a_hole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
