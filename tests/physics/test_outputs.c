/* Every output against the query that it mirrors, in a string that drills on a wall with a jointed body behind it;
 * names and numbers; recorders of windows and profiles; refusals. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"

typedef struct scene {
    rig s;
    dmb_id stuck, string, bit, feed, torque, body, joint, spring, input;
} scene;

/* A spring with a damper from the ground to the jointed body; the torque of the drive as an input with a rate. */
static void add_spring_and_input(scene *r)
{
    dmb_spring_def spring = dmb_spring_def_default();
    dmb_input_def input = dmb_input_def_default();
    spring.place_b = dmb_station(r->body, 0, 0.0);
    spring.offset_a[0] = 2.0;
    spring.offset_a[1] = 5.0;
    spring.offset_b[1] = 0.1;
    spring.free_length = 1.5;
    spring.stiffness = 40.0;
    spring.damping = 3.0;
    must_model(&r->s, dmb_model_add_spring(r->s.model, &spring, &r->spring));
    strcpy(input.name, "torque");
    input.part = r->torque;
    input.rate_limit = 5000.0;
    must_model(&r->s, dmb_model_add_input(r->s.model, &input, &r->input));
}

/* Eight pipes of S1 that drill, and a pendulum with a spring on a joint. */
static scene make(void)
{
    const dmb_segment ramp = {.struct_size = sizeof ramp, .kind = DMB_SEGMENT_STEP, .x1 = 0.02, .h1 = 0.1};
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_body_def body = dmb_body_def_default();
    scene r;
    rig_open(&r.s, 0.0, 0.0, -9.81);
    add_wall(&r.s, &wall);
    string.start_free = DMB_FREE_CYLINDRICAL;
    add_string(&r.s, &string);
    pipe.yield_strength = 7e8;
    r.string = add_pipes(&r.s, &pipe, 8);
    bit.load = add_constant(&r.s, 250.0);
    bit.bottom = 1e-3;
    bit.rock_law = DMB_ROCK_RATE;
    must_model(&r.s, dmb_model_add_bit(r.s.model, &bit, &r.bit));
    r.feed = add_simple_drive(&r.s, DMB_DRIVE_MOTION, r.string, DMB_X, add_time_function(&r.s, &ramp, 1));
    r.torque = add_simple_drive(&r.s, DMB_DRIVE_LOAD, r.string, DMB_RX, add_constant(&r.s, 400.0));
    body.mass = 3.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.1;
    body.position[1] = 5.0;
    r.body = add_body(&r.s, &body);
    dmb_joint_def joint =
        joint_between(DMB_JOINT_CYLINDRICAL, dmb_station((dmb_id){0, 0}, 0, 0.0), dmb_station(r.body, 0, 0.0));
    joint.origin_a[1] = joint.origin_b[1] = 0.0;
    joint.origin_a[1] = 5.0;
    joint.origin_b[2] = 0.4;
    joint.origin_a[2] = 0.4;
    joint.stiffness[DMB_X] = 100.0;
    joint.rest[DMB_X] = 0.1;
    joint.damping[DMB_RX] = 0.2;
    r.joint = add_joint(&r.s, &joint);
    dmb_stuck_def stuck = dmb_stuck_def_default();
    stuck.place = dmb_station(r.body, 0, 0.0);
    stuck.damping[0] = stuck.damping[1] = 1.0;
    must_model(&r.s, dmb_model_add_stuck(r.s.model, &stuck, &r.stuck));
    add_spring_and_input(&r);
    rig_start(&r.s, NULL);
    take_steps(&r.s, 1e-3, 57);
    must(&r.s, dmb_sim_set_input(r.s.sim, r.input, 430.0)); /* still on its way when the scene is asked */
    take_steps(&r.s, 1e-3, 3);
    return r;
}

static void destroy(scene *r)
{
    rig_close(&r->s);
}

/* ---- What each should be ----------------------------------------------------------------------------------------- */

static dmb_place place_for(const scene *r, int32_t q)
{
    const dmb_place along = dmb_station(r->string, 2, 0.25), none = dmb_station((dmb_id){0, 0}, 0, 0.0);
    if (q == DMB_OUTPUT_BIT_WEIGHT || (q >= 120 && q < 127)) return dmb_station(r->bit, 0, 0.0);
    if (q == DMB_OUTPUT_DRIVE_FORCE || q == DMB_OUTPUT_DRIVE_SPEED) return dmb_station(r->feed, 0, 0.0);
    if (q >= 127 && q < 130) return dmb_station(r->stuck, 0, 0.0);
    if (q >= 130 && q < 140) return dmb_station(r->torque, 0, 0.0);
    if (q >= 140 && q < 150) return dmb_station((dmb_id){0, 0}, 5, 0.0);
    if (q >= 220 && q < 230) return dmb_station(r->spring, 0, 0.0);
    if (q >= 230 && q < 240) return dmb_station(r->input, 0, 0.0);
    if (q >= 300 && q < 380) return dmb_station(r->joint, 0, 0.0);
    if (q >= 380 && q < 390) return dmb_station(r->string, 0, 0.0);
    return q >= 100 && q < 300 ? none : along;
}

static double of_place(const scene *r, int32_t q)
{
    const dmb_place place = place_for(r, q);
    const dmb_motion world = motion_at(&r->s, place, DMB_FRAME_WORLD), body = motion_at(&r->s, place, DMB_FRAME_BODY);
    const dmb_pose pose = pose_at(&r->s, place);
    dmb_section section = dmb_section_default();
    double kinetic;
    must(&r->s, dmb_query_section(r->s.sim, place, &section));
    must(&r->s, dmb_query_kinetic_energy(r->s.sim, place.part, place.pipe, &kinetic));
    if (q < 3) return pose.displacement[q];
    if (q < 6) return world.velocity[q - 3];
    if (q < 9) return pose.position[q - 6];
    if (q == DMB_OUTPUT_ROTATION) return rotation_at(&r->s, place);
    if (q == DMB_OUTPUT_SPIN) return body.velocity[3];
    if (q == DMB_OUTPUT_AXIAL_FORCE) return section.force[0];
    if (q == DMB_OUTPUT_TORQUE) return section.force[3];
    if (q == DMB_OUTPUT_BENDING_MOMENT) return hypot(section.force[4], section.force[5]);
    if (q == DMB_OUTPUT_KINETIC_ENERGY) return kinetic;
    if (q >= 450) return body.acceleration[q - 450];
    if (q >= 440) return body.velocity[q - 440];
    if (q >= 430) return world.acceleration[q - 430];
    if (q >= 420) return world.velocity[q - 420];
    return q >= 410 ? section.strain[q - 410] : section.force[q - 400];
}

static double of_contact(const scene *r, int32_t q)
{
    dmb_contact c = dmb_contact_default();
    dmb_contact_total t = contacts_of(&r->s);
    for (uint32_t i = 0; q == DMB_OUTPUT_NORMAL_FORCE; i++) {
        must(&r->s, dmb_query_contact(r->s.sim, i, &c));
        if (c.part.index == r->string.index && c.pipe == 2) return c.normal_force;
    }
    must(&r->s, dmb_query_contact(r->s.sim, 5, &c));
    const double site[9] = {c.gap,     c.normal_force, c.approach, c.friction[0], c.friction[1],
                            c.slip[0], c.slip[1],      c.closed,   c.sticks};
    const double total[5] = {t.closed, t.normal_force, t.friction[0], t.friction[1], t.deepest};
    return q < 150 ? site[q - 140] : total[q - 150];
}

static double of_whole(const scene *r, int32_t q)
{
    const dmb_energy e = energy_of(&r->s);
    const dmb_momentum m = momentum_of(&r->s);
    const dmb_statistics s = statistics_of(&r->s);
    const double energies[14] = {e.kinetic, e.strain,  e.gravity, e.contact, e.drives, e.loads,   e.friction,
                                 e.impact,  e.damping, e.rock,    e.scheme,  e.input,  e.balance, e.unexplained};
    const double momenta[10] = {m.linear[0],  m.linear[1], m.linear[2], m.angular[0], m.angular[1],
                                m.angular[2], m.mass,      m.centre[0], m.centre[1],  m.centre[2]};
    const double statistics[10] = {(double)s.steps,   (double)s.rejected, (double)s.iterations, (double)s.limited_steps,
                                   s.most_iterations, s.largest_residual, (double)s.switches,   s.dependent,
                                   s.redundant,       s.violation};
    if (q == DMB_OUTPUT_ENERGY_ERROR) return e.error;
    if (q < 180) return energies[q - 160];
    return q < 200 ? momenta[q - 180] : statistics[q - 200];
}

static double of_joint(const scene *r, int32_t q)
{
    dmb_joint_state world = dmb_joint_state_default(), body = dmb_joint_state_default();
    double multipliers[6], reaction[6];
    uint32_t count;
    body.frame = DMB_FRAME_BODY;
    must(&r->s, dmb_query_joint(r->s.sim, r->joint, &world));
    must(&r->s, dmb_query_joint(r->s.sim, r->joint, &body));
    must(&r->s, dmb_query_multipliers(r->s.sim, r->joint, multipliers, &count));
    must(&r->s, dmb_query_reaction(r->s.sim, r->string, reaction));
    if (q < 310) return world.position[q - 300];
    if (q < 320) return world.speed[q - 310];
    if (q < 330) return world.acceleration[q - 320];
    if (q < 340) return world.reaction[q - 330];
    if (q < 350) return body.reaction[q - 340];
    if (q < 360) return world.action[q - 350];
    if (q == 360) return world.violation;
    if (q == 361) return world.state;
    if (q == 362) return world.constraint_rows;
    return q < 380 ? multipliers[q - 370] : reaction[q - 380];
}

static double of_part(const scene *r, int32_t q)
{
    dmb_bit_state b = dmb_bit_state_default();
    dmb_drive_state f = dmb_drive_state_default(), t = dmb_drive_state_default();
    must(&r->s, dmb_query_bit(r->s.sim, r->bit, &b));
    must(&r->s, dmb_query_drive(r->s.sim, r->feed, &f));
    must(&r->s, dmb_query_drive(r->s.sim, r->torque, &t));
    const double bit[7] = {b.advance, b.bottom, b.depth_of_cut, b.weight, b.torque, b.load, b.on_bottom};
    const double drive[6] = {t.target, t.position, t.power, t.work, t.command, t.made};
    if (q == DMB_OUTPUT_DRIVE_FORCE) return f.force;
    if (q == DMB_OUTPUT_DRIVE_SPEED) return f.speed;
    if (q == DMB_OUTPUT_BIT_WEIGHT) return b.weight + b.load;
    if (q >= 127 && q < 130) {
        dmb_stuck_state held = dmb_stuck_state_default();
        must(&r->s, dmb_query_stuck(r->s.sim, r->stuck, &held));
        return q == DMB_OUTPUT_STUCK ? held.stuck : held.force[q == DMB_OUTPUT_STUCK_FORCE ? 0 : 3];
    }
    return q < 130 ? bit[q - 120] : drive[q - 130];
}

static double of_spring_or_input(const scene *r, int32_t q)
{
    dmb_spring_state s = dmb_spring_state_default();
    dmb_input_state i = dmb_input_state_default();
    must(&r->s, dmb_query_spring(r->s.sim, r->spring, &s));
    must(&r->s, dmb_sim_get_input(r->s.sim, r->input, &i));
    const double of_spring[7] = {s.length, s.elongation, s.speed, s.force, s.elastic, s.damper, s.energy};
    const double of_input[3] = {i.present, i.rate, i.value};
    return q < 230 ? of_spring[q - 220] : of_input[q - 230];
}

static double of_driller(const scene *r, int32_t q)
{
    const dmb_place rig_end = dmb_station(r->string, 0, 0.0), far_end = dmb_station(r->string, 7, 1.0);
    dmb_section section = dmb_section_default();
    dmb_bit_state b = dmb_bit_state_default();
    dmb_drive_state f = dmb_drive_state_default(), t = dmb_drive_state_default();
    double sum = 0.0;
    must(&r->s, dmb_query_section(r->s.sim, rig_end, &section));
    must(&r->s, dmb_query_bit(r->s.sim, r->bit, &b));
    must(&r->s, dmb_query_drive(r->s.sim, r->feed, &f));
    must(&r->s, dmb_query_drive(r->s.sim, r->torque, &t));
    const double speed = motion_at(&r->s, dmb_station(r->bit, 0, 0.0), DMB_FRAME_WORLD).velocity[0];
    for (uint32_t p = 0; p < 8; p++) { /* one element a pipe: its mean strain times its length */
        dmb_section middle = dmb_section_default();
        must(&r->s, dmb_query_section(r->s.sim, dmb_station(r->string, p, 0.5), &middle));
        sum += 1.5 * (q == DMB_OUTPUT_STRETCH ? middle.strain[0] : -middle.strain[3]);
    }
    switch (q) {
    case DMB_OUTPUT_HOOK_LOAD: return section.force[0];
    case DMB_OUTPUT_ROTATION_TORQUE: return -section.force[3];
    case DMB_OUTPUT_WEIGHT_ON_BIT: return b.weight + b.load;
    case DMB_OUTPUT_TORQUE_ON_BIT: return b.torque;
    case DMB_OUTPUT_RATE_OF_PENETRATION: return b.on_bottom ? speed : 0.0;
    case DMB_OUTPUT_BIT_SPEED: return motion_at(&r->s, far_end, DMB_FRAME_BODY).velocity[3];
    case DMB_OUTPUT_BIT_DEPTH: return pose_at(&r->s, far_end).depth;
    case DMB_OUTPUT_ROTARY_SPEED: return motion_at(&r->s, rig_end, DMB_FRAME_BODY).velocity[3];
    case DMB_OUTPUT_FEED_SPEED: return motion_at(&r->s, rig_end, DMB_FRAME_BODY).velocity[0];
    case DMB_OUTPUT_OFF_BOTTOM: return !b.on_bottom;
    case DMB_OUTPUT_RIG_FORCE: return -f.force;
    case DMB_OUTPUT_RIG_TORQUE: return t.force;
    default: return sum;
    }
}

static double of_profile(const scene *r, int32_t quantity)
{
    const double distance = 2.25 * 1.5;
    double value;
    dmb_profile profile = dmb_profile_default();
    profile.distance = &distance;
    profile.quantities = &quantity;
    profile.quantity_count = 1;
    profile.values = &value;
    must(&r->s, dmb_query_profile(r->s.sim, &profile));
    return value;
}

static double expected(const scene *r, int32_t q)
{
    if (q >= 1000) return of_profile(r, q - 1000);
    if (q >= 400) return of_place(r, q);
    if (q >= 300) return of_joint(r, q);
    if (q >= 220) return of_spring_or_input(r, q);
    if (q >= 160 || q == DMB_OUTPUT_ENERGY_ERROR) return of_whole(r, q);
    if (q >= 140 || q == DMB_OUTPUT_NORMAL_FORCE) return of_contact(r, q);
    if (q >= 120 || (q >= DMB_OUTPUT_DRIVE_FORCE && q <= DMB_OUTPUT_BIT_WEIGHT)) return of_part(r, q);
    return q >= 100 ? of_driller(r, q) : of_place(r, q);
}

static int is_last_row(int32_t q)
{
    return q >= DMB_OUTPUT_MULTIPLIER + 4 && q < DMB_OUTPUT_REACTION; /* a cylindrical joint has four */
}

/* Of analyses. */
static int is_vibration(int32_t q)
{
    return q >= DMB_OUTPUT_VIBRATION && q < DMB_OUTPUT_VIBRATION_ACCELERATION_BODY + 6;
}

static void each_is_its_query(void **state)
{
    (void)state;
    scene r = make();
    int count = 0, nonzero = 0;
    for (int32_t q = dmb_output_next(-1); q >= 0 && q < DMB_OUTPUT_WINDOW_MINIMUM; q = dmb_output_next(q)) {
        const dmb_output output = {place_for(&r, q), q, 0};
        double got = -1e99;
        const int32_t status = dmb_query_output(r.s.sim, &output, &got);
        assert_int_equal(status, is_last_row(q) ? DMB_ERR_VALUE : is_vibration(q) ? DMB_ERR_UNSUPPORTED : DMB_OK);
        if (status < 0) continue;
        const double want = expected(&r, q);
        const int summed = q == DMB_OUTPUT_STRETCH || q == DMB_OUTPUT_WIND_UP || q == DMB_OUTPUT_RATE_OF_PENETRATION;
        if (!(fabs(got - want) <= (summed ? 1e-12 * fabs(want) : 0.0)) && !(isnan(got) && isnan(want)))
            fail_msg("%s: %.17g, wanted %.17g", dmb_output_name(q, NULL), got, want);
        count++;
        nonzero += got != 0.0;
    }
    tell("outputs", count);
    tell("    of them not 0", nonzero);
    assert_int_equal(count, 228);
    assert_true(nonzero > 150);
    destroy(&r);
}

/* ---- Names ------------------------------------------------------------------------------------------------------- */

static void names_are_numbers(void **state)
{
    (void)state;
    const char *unit;
    int32_t last = -1, back;
    for (int32_t q = dmb_output_next(-1); q >= 0; q = dmb_output_next(q)) {
        const char *name = dmb_output_name(q, &unit);
        assert_true(q > last);
        assert_non_null(name);
        assert_true(unit[0] != '\0' && strchr(name, ' ') == NULL);
        assert_int_equal(dmb_output_quantity(name, &back), DMB_OK);
        assert_int_equal(back, q);
        last = q;
    }
    for (int32_t q = 0; q < (DMB_PROFILE_GAP + 1); q++) {
        const char *wanted, *name = dmb_output_name(DMB_OUTPUT_PROFILE + q, &unit);
        char text[64];
        snprintf(text, sizeof text, "profile_%s", dmb_profile_name(q, &wanted));
        assert_string_equal(name, text);
        assert_string_equal(unit, wanted);
    }
    assert_string_equal(dmb_output_name(DMB_OUTPUT_BIT_SPEED, &unit), "bit_speed");
    assert_string_equal(unit, "rad/s");
    assert_string_equal(dmb_output_name(DMB_OUTPUT_JOINT_ACTION + DMB_RY, NULL), "joint_action_ry");
    assert_null(dmb_output_name((DMB_OUTPUT_ENERGY_ERROR + 1), &unit));
    assert_null(unit);
    assert_null(dmb_output_name(INT32_MAX, NULL));
    assert_null(dmb_output_name(INT32_MIN, NULL));
    assert_int_equal(dmb_output_next(INT32_MAX), -1);
    assert_int_equal(dmb_output_quantity("hook", &back), DMB_ERR_VALUE);
    assert_int_equal(dmb_output_quantity(NULL, &back), DMB_ERR_NULL);
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static void refused(scene *r, int32_t status, int32_t quantity, dmb_place place, const char *says)
{
    const dmb_output output = {place, quantity, 0};
    double value = 7.0;
    assert_int_equal(dmb_query_output(r->s.sim, &output, &value), status);
    assert_true(value == 7.0);
    assert_int_equal(dmb_output_check(r->s.sim, &output, 1), status);
    if (strstr(dmb_sim_message(r->s.sim), says) == NULL) fail_msg("says: %s", dmb_sim_message(r->s.sim));
}

static void what_is_not_there(void **state)
{
    (void)state;
    scene r = make();
    const dmb_place body = dmb_station(r.body, 0, 0.0), nothing = dmb_station((dmb_id){0, 0}, 0, 0.0);
    const dmb_output fine = {dmb_station(r.string, 0, 0.0), DMB_OUTPUT_HOOK_LOAD, 0};
    refused(&r, DMB_ERR_VALUE, 99, nothing, "output 0: quantity = 99, must be a DMB_OUTPUT_ number");
    refused(&r, DMB_ERR_VALUE, -1, nothing, "quantity = -1");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_HOOK_LOAD, body, "hook_load");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_BIT_ADVANCE, body, "must be a bit");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_DRIVE_WORK, body, "must be a drive");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_JOINT_ACTION, body, "must be a joint");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_STUCK_TORQUE, body, "must be a stuck place");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_KINETIC_ENERGY, dmb_station(r.joint, 0, 0.0), "a pipe of a string, a body or");
    refused(&r, DMB_ERR_VALUE, DMB_OUTPUT_KINETIC_ENERGY, dmb_station(r.body, 1, 0.0), "a pipe of a string, a body or");
    refused(&r, DMB_ERR_VALUE, DMB_OUTPUT_KINETIC_ENERGY, dmb_station(r.string, 8, 0.0),
            "kinetic_energy of string 0 pipe 8");
    refused(&r, DMB_ERR_VALUE, DMB_OUTPUT_NORMAL_FORCE, dmb_station(r.bit, 1, 0.0), "normal_force of bit 0 pipe 1");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_REACTION, dmb_station(r.joint, 0, 0.0), "a pipe of a string, a body or");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_MULTIPLIER, body, "with that row");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_WORLD_ACCELERATION, dmb_station(r.joint, 0, 0.0), "on a string, body or bit");
    refused(&r, DMB_ERR_NOT_FINITE, DMB_OUTPUT_ROTATION, dmb_station(r.body, 0, (double)NAN), "body or bit");
    refused(&r, DMB_ERR_VALUE, DMB_OUTPUT_POSITION_X, dmb_station(r.body, 0, 0.5), "of body 0 pipe 0 at 0.5");
    refused(&r, DMB_ERR_VALUE, DMB_OUTPUT_SPIN, dmb_station(r.body, 1, 0.0), "spin of body 0 pipe 1");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_SPRING_FORCE, body, "must be a spring");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_INPUT_PRESENT, nothing, "must be an input");
    refused(&r, DMB_ERR_VALUE, DMB_OUTPUT_MULTIPLIER + 5, dmb_station(r.joint, 0, 0.0), "with that row");
    refused(&r, DMB_ERR_UNSUPPORTED, DMB_OUTPUT_SECTION_FORCE, body, "flexible");
    refused(&r, DMB_ERR_ID, DMB_OUTPUT_PROFILE, body, "pipe of a string");
    refused(&r, DMB_ERR_VALUE, DMB_OUTPUT_PROFILE, dmb_station(r.string, 8, 0.0), "pipe 8");
    refused(&r, DMB_ERR_NOT_FINITE, DMB_OUTPUT_PROFILE, dmb_station(r.string, 1, (double)NAN), "pipe of a string");
    refused(&r, DMB_ERR_VALUE, DMB_OUTPUT_PROFILE, dmb_station(r.string, 1, -1.0), "pipe of a string");
    refused(&r, DMB_ERR_VALUE, DMB_OUTPUT_CONTACT_GAP, dmb_station(nothing.part, 1000, 0.0), "contact point");
    refused(&r, DMB_ERR_UNSUPPORTED, DMB_OUTPUT_STICK_SLIP_INDEX, nothing, "number of a window");
    refused(&r, DMB_ERR_UNSUPPORTED, DMB_OUTPUT_VIBRATION + DMB_Z, body, "vibration_z of body 0: ");
    assert_int_equal(dmb_query_output(r.s.sim, NULL, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_output_check(r.s.sim, NULL, 1), DMB_ERR_NULL);
    assert_int_equal(dmb_output_check(r.s.sim, &fine, 1), DMB_OK);
    destroy(&r);
}

/* Without the ledger its numbers are refused, and all else of the scene is told. */
static void without_the_ledger(void **state)
{
    (void)state;
    scene r = make();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_sim_destroy(&r.s.sim);
    options.energy_ledger = 0;
    assert_true(dmb_sim_create(r.s.model, &options, &r.s.sim) >= 0);
    const dmb_place nothing = dmb_station((dmb_id){0, 0}, 0, 0.0);
    for (int32_t q = DMB_OUTPUT_ENERGY_KINETIC; q <= DMB_OUTPUT_ENERGY_UNEXPLAINED; q++)
        refused(&r, DMB_ERR_UNSUPPORTED, q, nothing, "it requires the energy ledger: set energy_ledger = 1");
    refused(&r, DMB_ERR_UNSUPPORTED, DMB_OUTPUT_ENERGY_ERROR, nothing, "energy_error");
    const dmb_output mass = {nothing, DMB_OUTPUT_MASS, 0};
    double value = 0.0;
    must(&r.s, dmb_query_output(r.s.sim, &mass, &value));
    check_relative("mass without the ledger [kg]", value, momentum_of(&r.s).mass, 0.0);
    destroy(&r);
}

/* ---- Windows and profiles in tables ------------------------------------------------------------------------------ */

static char *written(int32_t status, const char *path)
{
    static char text[1 << 15];
    assert_int_equal(status, DMB_OK);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    remove(path);
    return text;
}

static void in_tables(void **state)
{
    (void)state;
    scene r = make();
    const dmb_output watched = {dmb_station((dmb_id){0, 0}, 0, 0.0), DMB_OUTPUT_BIT_SPEED, 0};
    const dmb_output asked[4] = {{watched.place, DMB_OUTPUT_STICK_SLIP_INDEX, 0},
                                 {watched.place, DMB_OUTPUT_BIT_SPEED, 0},
                                 {dmb_station((dmb_id){0, 0}, 3, 0.0), DMB_OUTPUT_CONTACT_GAP, 0},
                                 {dmb_station(r.joint, 0, 0.0), DMB_OUTPUT_JOINT_SPEED + DMB_RX, 0}};
    const int32_t quantities[2] = {DMB_PROFILE_DISTANCE, DMB_PROFILE_TORQUE};
    double table[5][20], profiles[3][1 + 7 * 2];
    dmb_window *window = NULL;
    dmb_window_result result = dmb_window_result_default();
    dmb_recorder recorder = dmb_recorder_default();
    dmb_profile profile = dmb_profile_default();
    dmb_profile_recorder rows = dmb_profile_recorder_default();
    must(&r.s, dmb_window_create(r.s.sim, NULL, &watched, 1, &window));
    recorder.outputs = asked;
    recorder.output_count = 4;
    recorder.table = &table[0][0];
    recorder.capacity = 5;
    assert_int_equal(dmb_recorder_take(&recorder, r.s.sim), DMB_ERR_UNSUPPORTED);
    recorder.window = window;
    profile.station_count = 7;
    profile.quantities = quantities;
    profile.quantity_count = 2;
    rows.profile = &profile;
    rows.table = &profiles[0][0];
    rows.capacity = 3;
    rows.interval = 2e-3;
    for (int i = 0; i < 5; i++) {
        take_steps(&r.s, 1e-3, 1);
        assert_int_equal(dmb_window_take(window, r.s.sim), DMB_OK);
        assert_int_equal(dmb_recorder_take(&recorder, r.s.sim), DMB_OK);
        assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_OK);
    }
    take_steps(&r.s, 1e-3, 1);
    assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_OK); /* not yet due */
    take_steps(&r.s, 1e-3, 1);
    assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_NOTE_FULL);
    assert_int_equal(rows.row_count, 3);
    assert_int_equal(dmb_window_get(window, 0, &result), DMB_OK);
    assert_true(((double *)table)[5 * 4 + 1] == result.index && result.samples == 5);
    check_close("row of a profile 2 ms later", profiles[1][0] - profiles[0][0], 2e-3, 1e-12);
    check_close("distance of the last station", profiles[2][1 + 6 * 2], 12.0, 0.0);
    const char *text = written(dmb_recorder_write_csv(&recorder, NULL, "outputs_out.csv"), "outputs_out.csv");
    assert_non_null(
        strstr(text, "time [s],stick_slip_index of output 0 [-],bit_speed [rad/s],contact_gap of contact point 3 [m],"
                     "joint_speed_rx of joint 0 [rad/s]\n"));
    text = written(dmb_profile_recorder_write_csv(&rows, "profiles_out.csv"), "profiles_out.csv");
    assert_non_null(strstr(text, "time [s],station,distance [m],torque [N m]\n"));
    int lines = 0;
    for (const char *at = text; (at = strchr(at, '\n')) != NULL; at++) lines++;
    assert_int_equal(lines, 1 + 3 * 7);
    profile.station_count = 0;
    assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_ERR_VALUE);
    profile.station_count = 7;
    rows.interval = (double)NAN;
    assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_ERR_NOT_FINITE);
    rows.interval = -1.0;
    assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_ERR_VALUE);
    rows.interval = 0.0;
    rows.capacity = UINT64_MAX;
    assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_ERR_VALUE);
    dmb_window_destroy(&window);
    assert_int_equal(dmb_window_get(window, 0, &result), DMB_ERR_NULL);
    destroy(&r);
}

/* A sim that was put back to an earlier time is refused, with the remedy; rows go on once row_count is put back too. */
static void in_tables_after_a_restore(void **state)
{
    (void)state;
    scene r = make();
    const dmb_output speed = {dmb_station((dmb_id){0, 0}, 0, 0.0), DMB_OUTPUT_BIT_SPEED, 0};
    const int32_t torque = DMB_PROFILE_TORQUE;
    double table[4][2], profiles[4][1 + 3];
    size_t size = 0;
    dmb_recorder recorder = dmb_recorder_default();
    dmb_profile profile = dmb_profile_default();
    dmb_profile_recorder rows = dmb_profile_recorder_default();
    recorder.outputs = &speed;
    recorder.output_count = 1;
    recorder.table = &table[0][0];
    recorder.capacity = rows.capacity = 4;
    profile.station_count = 3;
    profile.quantities = &torque;
    profile.quantity_count = 1;
    rows.profile = &profile;
    rows.table = &profiles[0][0];
    take_steps(&r.s, 1e-3, 1);
    assert_int_equal(dmb_recorder_take(&recorder, r.s.sim), DMB_OK);
    assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_OK);
    must(&r.s, dmb_sim_snapshot_size(r.s.sim, &size));
    void *kept = malloc(size);
    assert_non_null(kept);
    must(&r.s, dmb_sim_snapshot(r.s.sim, kept, size));
    take_steps(&r.s, 1e-3, 1);
    assert_int_equal(dmb_recorder_take(&recorder, r.s.sim), DMB_OK);
    assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_OK);
    must(&r.s, dmb_sim_restore(r.s.sim, kept, size));
    assert_int_equal(dmb_recorder_take(&recorder, r.s.sim), DMB_ERR_ORDER);
    assert_non_null(strstr(dmb_sim_message(r.s.sim), "row_count"));
    assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_ERR_ORDER);
    assert_true(recorder.row_count == 2 && rows.row_count == 2);
    recorder.row_count = rows.row_count = 1;
    take_steps(&r.s, 1e-3, 1);
    assert_int_equal(dmb_recorder_take(&recorder, r.s.sim), DMB_OK);
    assert_int_equal(dmb_profile_recorder_take(&rows, r.s.sim), DMB_OK);
    check_close("time of the row that goes on", table[1][0], dmb_sim_time(r.s.sim), 0.0);
    check_close("time of the profile that goes on", profiles[1][0], dmb_sim_time(r.s.sim), 0.0);
    free(kept);
    destroy(&r);
}

/* The unit of an input is that of its target, of its rate over a second; without a model it is not known. */
static void units_of_inputs(void **state)
{
    (void)state;
    static const struct {
        int32_t target, motion;
        const char *unit, *rate;
    } cases[] = {{DMB_TARGET_SET_POINT, 1, "rad/s", "rad/s2"},
                 {DMB_TARGET_SET_POINT, 0, "N m", "N m/s"},
                 {DMB_TARGET_FRICTION, 0, "-", "1/s"},
                 {DMB_TARGET_FLUID_DENSITY, 0, "kg/m3", "kg/(m3 s)"},
                 {DMB_TARGET_TORSIONAL_DAMPING, 0, "N s", "N"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        rig s;
        char text[128], wanted[128];
        dmb_input_def input = dmb_input_def_default();
        const dmb_wall_def wall = s1_hole();
        const dmb_pipe_def pipe = s1_pipe();
        rig_open(&s, 0.0, 0.0, -9.81);
        (void)add_wall(&s, &wall);
        const dmb_id string = add_pipes(&s, &pipe, 2);
        memcpy(input.name, "set", 4);
        input.target = cases[i].target;
        if (input.target == DMB_TARGET_SET_POINT)
            input.part = add_simple_drive(&s, cases[i].motion ? DMB_DRIVE_MOTION : DMB_DRIVE_LOAD, string, DMB_RX,
                                          add_constant(&s, 1.0));
        if (input.target == DMB_TARGET_SET_POINT) input.rate_limit = 1.0;
        dmb_id id;
        must_model(&s, dmb_model_add_input(s.model, &input, &id));
        (void)rig_start(&s, NULL);
        dmb_output output = {dmb_station(id, 0, 0.0), DMB_OUTPUT_INPUT_PRESENT, 0};
        snprintf(wanted, sizeof wanted, "input_present of input set [%s]", cases[i].unit);
        must(&s, dmb_output_text(s.sim, &output, text, sizeof text));
        assert_string_equal(text, wanted);
        output.quantity = DMB_OUTPUT_INPUT_RATE;
        snprintf(wanted, sizeof wanted, "input_rate of input set [%s]", cases[i].rate);
        must(&s, dmb_output_text(s.sim, &output, text, sizeof text));
        assert_string_equal(text, wanted);
        must(&s, dmb_output_text(NULL, &output, text, sizeof text));
        assert_string_equal(text, "input_rate of input 0 [unit of the input/s]");
        rig_close(&s);
    }
}

/* The text of an output is its name, its part by name, its place and the unit that it has there; a head of a table is
 * in quotes where the name of a part has a comma or a quote. */
static void texts(void **state)
{
    (void)state;
    rig s;
    char text[128] = "as before";
    double table[4] = {0.0};
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    memcpy(string.name, "a, \"b\"", 7);
    memcpy(drive.name, "table", 5);
    drive.component = DMB_RX;
    pipe.string = drive.part = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 2);
    const dmb_id table_drive = add_drive(&s, &drive);
    (void)rig_start(&s, NULL);
    const dmb_output outputs[3] = {{dmb_station(table_drive, 0, 0.0), DMB_OUTPUT_DRIVE_FORCE, 0},
                                   {dmb_station(pipe.string, 1, 0.5), DMB_OUTPUT_AXIAL_FORCE, 0},
                                   {dmb_station(pipe.string, 0, 0.0), DMB_OUTPUT_HOOK_LOAD, 0}};
    must(&s, dmb_output_text(s.sim, &outputs[0], text, sizeof text));
    assert_string_equal(text, "drive_force of drive table [N m]");
    must(&s, dmb_output_text(NULL, &outputs[0], text, sizeof text));
    assert_string_equal(text, "drive_force of drive 0 [N or N m]");
    must(&s, dmb_output_text(s.sim, &outputs[1], text, sizeof text));
    assert_string_equal(text, "axial_force of string a, \"b\" pipe 1 at 0.5 [N]");
    assert_int_equal(dmb_output_text(s.sim, &outputs[2], text, 30), DMB_ERR_TOO_LARGE);
    must(&s, dmb_output_text(s.sim, &outputs[2], text, 31));
    assert_string_equal(text, "hook_load of string a, \"b\" [N]");
    assert_int_equal(dmb_output_text(s.sim, &(dmb_output){.quantity = 99}, text, sizeof text), DMB_ERR_VALUE);
    assert_int_equal(dmb_output_text(s.sim, NULL, text, sizeof text), DMB_ERR_NULL);
    dmb_recorder recorder = dmb_recorder_default();
    recorder.outputs = outputs;
    recorder.output_count = 3;
    recorder.table = table;
    recorder.capacity = 1;
    must(&s, dmb_recorder_take(&recorder, s.sim));
    assert_non_null(
        strstr(written(dmb_recorder_write_csv(&recorder, s.sim, "texts_out.csv"), "texts_out.csv"),
               "time [s],drive_force of drive table [N m],\"axial_force of string a, \"\"b\"\" pipe 1 at 0.5 "
               "[N]\",\"hook_load of string a, \"\"b\"\" [N]\"\n"));
    rig_close(&s);
}

/* So are windows, which go on after a reset, and fatigue, which goes on after a restore of its own. */
static void in_windows_and_fatigue_after_a_restore(void **state)
{
    (void)state;
    scene r = make();
    const dmb_place place = dmb_station(r.string, 0, 0.5);
    const dmb_output speed = {place, DMB_OUTPUT_VELOCITY_X, 0};
    dmb_fatigue_options options = dmb_fatigue_options_default();
    dmb_window_result result = dmb_window_result_default();
    dmb_window *window;
    dmb_fatigue *fatigue;
    size_t size = 0, counted = 0;
    options.curve_stress = 1e8;
    options.slope = 5.0;
    must(&r.s, dmb_window_create(r.s.sim, NULL, &speed, 1, &window));
    must(&r.s, dmb_fatigue_create(r.s.sim, &options, &place, 1, &fatigue));
    must(&r.s, dmb_window_take(window, r.s.sim));
    must(&r.s, dmb_fatigue_take(fatigue, r.s.sim));
    must(&r.s, dmb_sim_snapshot_size(r.s.sim, &size));
    must(&r.s, dmb_fatigue_snapshot_size(fatigue, &counted));
    void *kept = malloc(size), *counts = malloc(counted);
    assert_true(kept != NULL && counts != NULL);
    must(&r.s, dmb_sim_snapshot(r.s.sim, kept, size));
    must(&r.s, dmb_fatigue_snapshot(fatigue, counts, counted));
    take_steps(&r.s, 1e-3, 2);
    must(&r.s, dmb_window_take(window, r.s.sim));
    must(&r.s, dmb_fatigue_take(fatigue, r.s.sim));
    must(&r.s, dmb_sim_restore(r.s.sim, kept, size));
    assert_int_equal(dmb_window_take(window, r.s.sim), DMB_ERR_ORDER);
    assert_non_null(strstr(dmb_sim_message(r.s.sim), "reset the window"));
    must(&r.s, dmb_window_get(window, 0, &result));
    assert_int_equal(result.samples, 2);
    assert_int_equal(dmb_fatigue_take(fatigue, r.s.sim), DMB_ERR_ORDER);
    assert_non_null(strstr(dmb_sim_message(r.s.sim), "restore the fatigue"));
    must(&r.s, dmb_window_reset(window));
    must(&r.s, dmb_window_take(window, r.s.sim));
    must(&r.s, dmb_fatigue_restore(fatigue, counts, counted));
    must(&r.s, dmb_fatigue_take(fatigue, r.s.sim)); /* a second one at that time */
    must(&r.s, dmb_window_get(window, 0, &result));
    assert_int_equal(result.samples, 1);
    free(kept);
    free(counts);
    dmb_window_destroy(&window);
    dmb_fatigue_destroy(&fatigue);
    destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_of_inputs),
        cmocka_unit_test(texts),
        cmocka_unit_test(each_is_its_query),
        cmocka_unit_test(names_are_numbers),
        cmocka_unit_test(what_is_not_there),
        cmocka_unit_test(without_the_ledger),
        cmocka_unit_test(in_tables),
        cmocka_unit_test(in_tables_after_a_restore),
        cmocka_unit_test(in_windows_and_fatigue_after_a_restore),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
