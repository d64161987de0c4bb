/* Inputs: each against a scene that is described with the same value; refusals change nothing; snapshots, the state
 * transfer and a log take them along, bit for bit; the scene that sims share does not change. */
#include "sim/sim.h"
#include "sim_test.h"

typedef struct controlled {
    rig rig;
    dmb_id feed, torque, speed, gain, integral, low, high, load, bit_load, friction, density, damping[3];
} controlled;

static dmb_id add(dmb_model *model, const char *name, int32_t target, dmb_id part, double initial)
{
    dmb_input_def def = dmb_input_def_default();
    dmb_id id;
    snprintf(def.name, sizeof def.name, "%s", name);
    def.target = target;
    def.part = part;
    def.initial = initial;
    must(dmb_model_add_input(model, &def, &id));
    return id;
}

static const dmb_id nothing = {0, 0};

/* The rig with a controlled drive at a body of its own, a load, gravity, mud, and all inputs there are. */
static void describe(controlled *c, double speed, double factor)
{
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_body_def body = dmb_body_def_default();
    dmb_environment_def e = dmb_environment_def_default();
    dmb_id part, id;
    rig_describe(&c->rig, &plain_rig);
    e.fluid_density = 1000.0;
    must(dmb_model_set_environment(c->rig.model, &e));
    body.free_mask = DMB_FREE_RX;
    must(dmb_model_add_body(c->rig.model, &body, &part));
    drive.kind = DMB_DRIVE_CONTROL;
    drive.part = part;
    drive.component = DMB_RX;
    drive.gain = 2.0;
    drive.integral_gain = 3.0;
    drive.time_function = rig_step(c->rig.model, speed);
    must(dmb_model_add_drive(c->rig.model, &drive, &id));
    c->speed = add(c->rig.model, "speed", DMB_TARGET_SET_POINT, id, (double)NAN);
    c->gain = add(c->rig.model, "gain", DMB_TARGET_GAIN, id, (double)NAN);
    c->integral = add(c->rig.model, "integral", DMB_TARGET_INTEGRAL_GAIN, id, (double)NAN);
    c->low = add(c->rig.model, "low", DMB_TARGET_LIMIT_LOW, id, (double)NAN);
    c->high = add(c->rig.model, "high", DMB_TARGET_LIMIT_HIGH, id, (double)NAN);
    load.place = dmb_station(c->rig.string, 2, 1.0);
    load.force[0] = 20.0 * factor;
    must(dmb_model_add_load(c->rig.model, &load, &id));
    c->load = add(c->rig.model, "load", DMB_TARGET_LOAD_FACTOR, id, (double)NAN);
    c->torque = add(c->rig.model, "torque", DMB_TARGET_SET_POINT, c->rig.torque, (double)NAN);
    c->bit_load = add(c->rig.model, "bit load", DMB_TARGET_BIT_LOAD, c->rig.bit, (double)NAN);
    c->friction = add(c->rig.model, "friction", DMB_TARGET_FRICTION, nothing, (double)NAN);
    c->density = add(c->rig.model, "density", DMB_TARGET_FLUID_DENSITY, nothing, (double)NAN);
    c->damping[0] = add(c->rig.model, "lateral", DMB_TARGET_LATERAL_DAMPING, nothing, (double)NAN);
    c->damping[1] = add(c->rig.model, "axial", DMB_TARGET_AXIAL_DAMPING, nothing, (double)NAN);
    c->damping[2] = add(c->rig.model, "torsional", DMB_TARGET_TORSIONAL_DAMPING, nothing, (double)NAN);
    dmb_input_def feed = dmb_input_def_default();
    snprintf(feed.name, sizeof feed.name, "feed");
    feed.part = c->rig.feed;
    feed.rate_limit = 2.0;
    feed.slope_limit = 100.0;
    feed.low = -0.5;
    feed.high = 0.5;
    feed.outside = DMB_OUTSIDE_CLAMPED;
    must(dmb_model_add_input(c->rig.model, &feed, &c->feed));
}

static controlled whole(void)
{
    controlled c;
    describe(&c, 5.0, 1.0);
    must(dmb_model_compile(c.rig.model, NULL));
    return c;
}

static void run(dmb_sim *sim, int steps)
{
    rig_run(sim, steps);
}

static void close_both(controlled *c, dmb_sim **sim)
{
    dmb_sim_destroy(sim);
    dmb_model_destroy(&c->rig.model);
}

static void names_and_units(void **state)
{
    (void)state;
    controlled c = whole();
    dmb_input_info info = dmb_input_info_default();
    dmb_id found;
    assert_int_equal(dmb_model_input_count(c.rig.model), 14);
    must(dmb_model_find_input(c.rig.model, "gain", &found));
    assert_int_equal(found.index, c.gain.index);
    assert_int_equal(dmb_model_find_input(c.rig.model, "no such", &found), DMB_ERR_ID);
    must(dmb_model_get_input(c.rig.model, 0, &info));
    assert_string_equal(info.name, "speed");
    assert_string_equal(info.unit, "rad/s");
    must(dmb_model_get_input(c.rig.model, 1, &info));
    assert_string_equal(info.unit, "N m s");
    assert_true(info.low == 0.0 && info.high == 1e30);
    must(dmb_model_get_input(c.rig.model, 6, &info));
    assert_string_equal(info.unit, "N m"); /* a LOAD drive about x */
    must(dmb_model_get_input(c.rig.model, 9, &info));
    assert_string_equal(info.unit, "kg/m3");
    must(dmb_model_get_input(c.rig.model, 13, &info));
    assert_string_equal(info.unit, "m/s");
    assert_true(info.rate_limit == 2.0 && info.slope_limit == 100.0);
    assert_int_equal(dmb_model_get_input(c.rig.model, 14, &info), DMB_ERR_ID);
    assert_int_equal(dmb_model_input_count(NULL), 0);
    dmb_model_destroy(&c.rig.model);
}

static double place_of_bit(const dmb_sim *sim, const rig *r)
{
    dmb_pose pose = dmb_pose_default();
    must(dmb_query_pose(sim, dmb_station(r->bit, 0, 0.0), &pose));
    return pose.displacement[0] + pose.displacement[1] + pose.displacement[2] + pose.rotation[5];
}

/* Set before the first step, against described so. Factor: what the description of the second scene multiplies. */
static void as_described(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        controlled c = whole(), d;
        dmb_sim *sim = rig_sim(&c.rig), *other;
        describe(&d, 5.0, k == 0 ? 3.0 : 1.0);
        if (k == 0) must(dmb_sim_set_input(sim, c.load, 3.0));
        if (k == 1) {
            dmb_environment_def e = dmb_environment_def_default();
            e.fluid_density = 1800.0;
            must(dmb_model_set_environment(d.rig.model, &e));
            must(dmb_sim_set_input(sim, c.density, 1800.0));
        }
        if (k == 2) {
            dmb_environment_def e = dmb_environment_def_default();
            e.fluid_density = 1000.0;
            e.lateral_damping = 30.0;
            e.axial_damping = 20.0;
            e.torsional_damping = 0.5;
            must(dmb_model_set_environment(d.rig.model, &e));
            must(dmb_sim_set_inputs(sim, c.damping, (double[]){30.0, 20.0, 0.5}, 3));
        }
        if (k == 3) must(dmb_sim_set_input(sim, c.friction, 1.0)); /* as it is */
        must(dmb_model_compile(d.rig.model, NULL));
        other = rig_sim(&d.rig);
        dmb_sim *plain = rig_sim(&c.rig);
        run(sim, 100);
        run(other, 100);
        run(plain, 100);
        const double here = place_of_bit(sim, &c.rig), there = place_of_bit(other, &d.rig);
        assert_true(fabs(here - there) <= 1e-12);
        if (k < 3) assert_true(fabs(here - place_of_bit(plain, &c.rig)) > 1e-7);
        dmb_sim_destroy(&plain);
        close_both(&c, &sim);
        close_both(&d, &other);
    }
}

/* Half the friction, against a wall described with half of both coefficients. */
static void friction_as_described(void **state)
{
    (void)state;
    dmb_sim *sims[2];
    rig rigs[2];
    for (int k = 0; k < 2; k++) {
        rig *r = &rigs[k];
        dmb_wall_def wall = dmb_wall_def_default();
        dmb_pipe_def pipe = dmb_pipe_def_default();
        dmb_string_def string = dmb_string_def_default();
        dmb_id input;
        memset(r, 0, sizeof *r);
        must(dmb_model_create(NULL, &r->model));
        wall.mu_static *= k == 0 ? 1.0 : 0.5;
        wall.mu_dynamic *= k == 0 ? 1.0 : 0.5;
        must(dmb_model_add_wall(r->model, &wall, NULL));
        string.velocity[3] = 10.0;
        string.velocity[0] = 0.3;
        string.offset[1] = -0.0105;
        string.start_free = DMB_FREE_ALL;
        must(dmb_model_add_string(r->model, &string, &r->string));
        must(dmb_model_add_pipes(r->model, &pipe, 2, NULL));
        input = add(r->model, "friction", DMB_TARGET_FRICTION, nothing, (double)NAN);
        must(dmb_model_compile(r->model, NULL));
        sims[k] = rig_sim(r);
        if (k == 0) must(dmb_sim_set_input(sims[k], input, 0.5));
        run(sims[k], 50);
    }
    dmb_motion motion[2] = {dmb_motion_default(), dmb_motion_default()};
    for (int k = 0; k < 2; k++) must(dmb_query_motion(sims[k], dmb_station(rigs[k].string, 0, 0.0), &motion[k]));
    assert_true(motion[0].velocity[0] < 0.29); /* friction acts */
    for (int i = 0; i < 6; i++) assert_true(fabs(motion[0].velocity[i] - motion[1].velocity[i]) < 1e-12);
    for (int k = 0; k < 2; k++) {
        dmb_sim_destroy(&sims[k]);
        dmb_model_destroy(&rigs[k].model);
    }
}

/* Gains and limits of the controlled drive: its force right after the change. */
static double force_of(const dmb_sim *sim, const controlled *c)
{
    dmb_drive_state drive = dmb_drive_state_default();
    dmb_input_info info = dmb_input_info_default();
    must(dmb_model_get_input(c->rig.model, 0, &info));
    must(dmb_query_drive(sim, info.part, &drive));
    return drive.force;
}

static void gains_and_limits(void **state)
{
    (void)state;
    controlled c = whole();
    dmb_sim *sim = rig_sim(&c.rig);
    dmb_motion motion = dmb_motion_default();
    dmb_drive_state drive = dmb_drive_state_default();
    dmb_input_info info = dmb_input_info_default();
    run(sim, 100); /* its time function is at 5 rad/s since 0.05 s */
    must(dmb_model_get_input(c.rig.model, 0, &info));
    must(dmb_query_drive(sim, info.part, &drive));
    const double error = 5.0 - drive.speed, rest = drive.force - 2.0 * error;
    must(dmb_sim_set_input(sim, c.gain, 7.0));
    assert_true(fabs(force_of(sim, &c) - (7.0 * error + rest)) < 1e-9);
    must(dmb_sim_set_input(sim, c.integral, 6.0));
    assert_true(fabs(force_of(sim, &c) - (7.0 * error + 2.0 * rest)) < 1e-9);
    must(dmb_sim_set_input(sim, c.speed, 5000.0));
    must(dmb_sim_set_input(sim, c.high, 11.0));
    assert_true(force_of(sim, &c) == 11.0);
    motion.frame = DMB_FRAME_BODY; /* accelerations fit at once: 11 N m on 1e-3 kg m2 */
    must(dmb_query_motion(sim, dmb_station((dmb_id){c.rig.head.index + 1, c.rig.head.generation}, 0, 0.0), &motion));
    assert_true(fabs(motion.acceleration[3] - 11.0 / 1e-3) < 1e-6);
    const uint64_t before = hash_of(sim);
    assert_int_equal(dmb_sim_set_input(sim, c.low, 11.0), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(sim), "limit_low = 11"));
    assert_int_equal(hash_of(sim), before);
    must(dmb_sim_set_inputs(sim, (dmb_id[]){c.low, c.high}, (double[]){12.0, 13.0}, 2));
    assert_true(force_of(sim, &c) == 13.0);
    close_both(&c, &sim);
}

/* Values out of bounds are refused and change nothing, or are clamped with a note where the input says so. */
static void out_of_bounds(void **state)
{
    (void)state;
    controlled c = whole();
    dmb_sim *sim = rig_sim(&c.rig);
    dmb_input_state input = dmb_input_state_default();
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    run(sim, 20);
    const uint64_t before = hash_of(sim);
    for (int k = 0; k < 3; k++) assert_int_equal(dmb_sim_set_input(sim, c.gain, bad[k]), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_sim_set_input(sim, c.gain, -1.0), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(sim), "input 1 (gain): value = -1, must be from 0 to"));
    assert_int_equal(dmb_sim_set_input(sim, c.friction, -0.1), DMB_ERR_VALUE);
    assert_int_equal(dmb_sim_set_input(sim, c.rig.feed, 1.0), DMB_ERR_ID);
    assert_int_equal(dmb_sim_set_input(sim, (dmb_id){0, 0}, 1.0), DMB_ERR_ID);
    assert_int_equal(dmb_sim_set_input(NULL, c.gain, 1.0), DMB_ERR_NULL);
    assert_int_equal(dmb_sim_set_inputs(sim, NULL, NULL, 1), DMB_ERR_NULL);
    /* all or none */
    assert_int_equal(dmb_sim_set_inputs(sim, (dmb_id[]){c.load, c.gain}, (double[]){2.0, -1.0}, 2), DMB_ERR_VALUE);
    assert_int_equal(dmb_sim_set_drive(sim, c.rig.torque, 5.0), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_sim_message(sim), "(torque)"));
    assert_int_equal(hash_of(sim), before);
    assert_int_equal(dmb_sim_set_input(sim, c.feed, 3.0), DMB_NOTE_CLAMPED);
    must(dmb_sim_get_input(sim, c.feed, &input));
    assert_true(input.is_set == 1 && input.value == 0.5 && input.present < 0.5);
    const uint64_t after = hash_of(sim);
    assert_true(after != before);
    assert_int_equal(dmb_sim_set_input(sim, c.feed, 9.0), DMB_NOTE_CLAMPED); /* is there already */
    must(dmb_sim_set_input(sim, c.feed, 0.5));
    assert_int_equal(hash_of(sim), after);
    close_both(&c, &sim);
}

static int32_t refused(dmb_model *model, const dmb_input_def *def)
{
    const int32_t status = dmb_model_add_input(model, def, NULL);
    if (status < 0) assert_true(dmb_model_message(model)[0] != '\0');
    return status;
}

static void bad_definitions(void **state)
{
    (void)state;
    rig r;
    rig_describe(&r, &plain_rig);
    dmb_input_def good = dmb_input_def_default();
    snprintf(good.name, sizeof good.name, "push");
    good.part = r.torque;
    const double bad[] = {(double)NAN, (double)INFINITY, -1.0, 1e300};
    dmb_input_def def = good;
    for (int k = 0; k < 4; k++) {
        def = good, def.rate_limit = bad[k];
        assert_true(refused(r.model, &def) < 0);
        def = good, def.slope_limit = bad[k];
        assert_true(refused(r.model, &def) < 0);
        if (k != 2) {
            def = good, def.low = bad[k];
            assert_true(refused(r.model, &def) < 0);
            def = good, def.high = bad[k];
            assert_true(refused(r.model, &def) < 0);
        }
        def = good, def.low = 0.0, def.initial = bad[k];
        if (k != 0) assert_true(refused(r.model, &def) < 0);
    }
    must(dmb_model_add_input(r.model, &good, NULL));
    def = good, def.name[0] = '\0';
    assert_int_equal(refused(r.model, &def), DMB_ERR_VALUE);
    memset(def.name, 'x', sizeof def.name);
    assert_int_equal(refused(r.model, &def), DMB_ERR_VALUE);
    snprintf(def.name, sizeof def.name, "again");
    assert_int_equal(refused(r.model, &def), DMB_ERR_VALUE); /* the target has an input */
    assert_non_null(strstr(dmb_model_message(r.model), "target"));
    def.part = r.feed;
    assert_int_equal(refused(r.model, &def), DMB_ERR_VALUE); /* a motion without a largest acceleration */
    assert_non_null(strstr(dmb_model_message(r.model), "rate_limit"));
    def.target = DMB_TARGET_GAIN;
    assert_int_equal(refused(r.model, &def), DMB_ERR_UNSUPPORTED);
    def.target = DMB_TARGET_BIT_LOAD;
    assert_int_equal(refused(r.model, &def), DMB_ERR_ID);
    def.part = r.bit, def.low = 3.0, def.high = 2.0;
    assert_int_equal(refused(r.model, &def), DMB_ERR_VALUE);
    def = good, def.part = nothing, def.target = DMB_TARGET_FLUID_DENSITY;
    snprintf(def.name, sizeof def.name, "mud");
    def.high = -1.0, def.low = -2.0;
    assert_int_equal(refused(r.model, &def), DMB_ERR_VALUE);
    def.low = -1e30, def.high = 1e30, def.rate_limit = 1.0;
    assert_int_equal(refused(r.model, &def), DMB_ERR_UNSUPPORTED);
    def.rate_limit = 0.0, def.target = DMB_TARGET_FLOW_RATE + 1;
    assert_int_equal(refused(r.model, &def), DMB_ERR_VALUE);
    must(dmb_model_clear_refused(r.model));
    must(dmb_model_compile(r.model, NULL));
    dmb_model_destroy(&r.model);

    dmb_model *bare = NULL;
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    must(dmb_model_create(NULL, &bare));
    must(dmb_model_add_pipes(bare, &pipe, 1, NULL));
    (void)add(bare, "friction", DMB_TARGET_FRICTION, nothing, (double)NAN);
    assert_int_equal(dmb_model_compile(bare, NULL), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_model_message(bare), "friction"));
    dmb_model_destroy(&bare);
}

/* The speed of a motion drive and the way it has gone, at every step, against the reference by itself: rest to 0.3 m/s
 * from the 0.1 m/s of its time function, in the least time. */
static void motion_follows(void **state)
{
    (void)state;
    controlled c = whole();
    dmb_sim *sim = rig_sim(&c.rig);
    dmb_drive_state drive = dmb_drive_state_default();
    dmb_input_state input = dmb_input_state_default();
    run(sim, 100);
    must(dmb_query_drive(sim, c.rig.feed, &drive));
    const double begin = dmb_sim_time(sim), gone = drive.position;
    must(dmb_sim_set_input(sim, c.feed, 0.3));
    must(dmb_sim_get_input(sim, c.feed, &input));
    /* 0.2 m/s by 2 m/s2 and 100 m/s3: 0.2/2 + 2/100 */
    assert_true(fabs(input.arrives - begin - 0.12) < 1e-12);
    for (int k = 1; k <= 150; k++) {
        run(sim, 1);
        const double t = dmb_sim_time(sim) - begin, up = fmin(t, 0.02), on = fmin(fmax(t - 0.02, 0.0), 0.08),
                     down = fmin(fmax(t - 0.1, 0.0), 0.02);
        const double speed = 0.1 + 50.0 * up * up + 2.0 * on + 2.0 * down - 50.0 * down * down;
        must(dmb_query_drive(sim, c.rig.feed, &drive));
        assert_true(fabs(drive.speed - speed) < 1e-13);
        assert_true(fabs(drive.target - speed) < 1e-13);
    }
    /* 0.1 T + the cubics of the three phases, then at rest on 0.3 */
    const double way = 0.1 * 0.12 + 100.0 * 8e-6 / 6.0 + 0.02 * 0.08 + 0.5 * 2.0 * 0.0064 + 0.18 * 0.02 +
                       0.5 * 2.0 * 4e-4 - 100.0 * 8e-6 / 6.0;
    must(dmb_query_drive(sim, c.rig.feed, &drive));
    assert_true(fabs(drive.position - gone - way - 0.3 * 0.03) < 1e-12);
    close_both(&c, &sim);
}

/* A new value on the way: speed and acceleration go on from where they are. */
static void motion_is_turned_round(void **state)
{
    (void)state;
    controlled c = whole();
    dmb_sim *sim = rig_sim(&c.rig);
    double speed = 0.1, last_rate = 0.0;
    dmb_input_state input = dmb_input_state_default();
    run(sim, 100);
    for (int k = 0; k < 300; k++) {
        if (k % 37 == 0) must(dmb_sim_set_input(sim, c.feed, k % 2 ? -0.4 : 0.4));
        run(sim, 1);
        must(dmb_sim_get_input(sim, c.feed, &input));
        assert_true(fabs(input.rate) <= 2.0 + 1e-12);
        assert_true(fabs(input.rate - last_rate) <= 0.1 + 1e-9);
        assert_true(fabs(input.present - speed - 5e-4 * (input.rate + last_rate)) < 1e-4);
        speed = input.present;
        last_rate = input.rate;
    }
    close_both(&c, &sim);
}

static void *saved(const dmb_sim *sim, size_t *size)
{
    must(dmb_sim_snapshot_size(sim, size));
    void *block = malloc(*size);
    assert_non_null(block);
    must(dmb_sim_snapshot(sim, block, *size));
    return block;
}

enum { LOG = 64 };

/* The inputs that an operator sets at step k. */
static void operate(dmb_sim *sim, const controlled *c, int k)
{
    if (k == 10) must(dmb_sim_set_input(sim, c->feed, 0.3));
    if (k == 17) must(dmb_sim_set_inputs(sim, (dmb_id[]){c->gain, c->speed}, (double[]){4.0, -3.0}, 2));
    if (k == 23) assert_int_equal(dmb_sim_set_input(sim, c->feed, -1.0), DMB_NOTE_CLAMPED);
    if (k == 31) must(dmb_sim_set_input(sim, c->density, 1500.0));
    if (k == 31) must(dmb_sim_set_input(sim, c->density, 1300.0));
    if (k == 40) must(dmb_sim_set_input(sim, c->friction, 0.2));
    if (k == 44) must(dmb_sim_set_input(sim, c->load, -2.0));
    if (k == 52) must(dmb_sim_set_input(sim, c->bit_load, 333.0));
    if (k == 60) must(dmb_sim_set_input(sim, c->damping[1], 12.0));
}

/* The log gives the same hash at every step, from the start and from a snapshot on; so does a restored sim, and the
 * scene they share is as it was. */
static void log_and_snapshot(void **state)
{
    (void)state;
    controlled c = whole();
    dmb_sim *sim = rig_sim(&c.rig), *other = rig_sim(&c.rig), *fresh = rig_sim(&c.rig), *late = rig_sim(&c.rig);
    dmb_input_record log[LOG];
    uint64_t hashes[90];
    size_t size = 0;
    void *block = NULL;
    run(fresh, 90);
    const uint64_t untouched = hash_of(fresh);
    dmb_sim_destroy(&fresh);
    must(dmb_sim_record_inputs(sim, log, LOG));
    for (int k = 0; k < 90; k++) {
        if (k == 35) block = saved(sim, &size);
        operate(sim, &c, k);
        run(sim, 1);
        hashes[k] = hash_of(sim);
    }
    const uint32_t count = dmb_sim_recorded_inputs(sim);
    assert_int_equal(count, 10);
    uint32_t next = 0;
    for (int k = 0; k < 90; k++) {
        const int32_t status = dmb_sim_replay_inputs(other, log, count, &next);
        assert_true(status >= 0);
        run(other, 1);
        assert_int_equal(hash_of(other), hashes[k]);
    }
    assert_int_equal(next, count);
    must(dmb_sim_restore(late, block, size));
    for (int k = 35; k < 90; k++) {
        operate(late, &c, k);
        run(late, 1);
        assert_int_equal(hash_of(late), hashes[k]);
    }
    fresh = rig_sim(&c.rig);
    run(fresh, 90);
    assert_int_equal(hash_of(fresh), untouched);
    must(dmb_sim_restore(fresh, block, size)); /* over a state of other inputs */
    for (int k = 35; k < 90; k++) {
        operate(fresh, &c, k);
        run(fresh, 1);
        assert_int_equal(hash_of(fresh), hashes[k]);
    }
    log[3].time = 0.0;
    next = 0;
    assert_int_equal(dmb_sim_replay_inputs(fresh, log, count, &next), DMB_ERR_VALUE);
    assert_int_equal(next, 3);
    log[1].input = 99, log[3].time = log[2].time, next = 0;
    assert_int_equal(dmb_sim_replay_inputs(fresh, log, count, &next), DMB_ERR_ID);
    assert_int_equal(next, 1);
    must(dmb_sim_record_inputs(fresh, log, 1));
    assert_int_equal(dmb_sim_set_inputs(fresh, (dmb_id[]){c.load, c.friction}, (double[]){7.0, 0.7}, 2), DMB_NOTE_FULL);
    assert_int_equal(dmb_sim_recorded_inputs(fresh), 1);
    assert_int_equal(dmb_sim_record_inputs(fresh, NULL, 1), DMB_ERR_NULL);
    must(dmb_sim_record_inputs(fresh, NULL, 0));
    free(block);
    dmb_sim_destroy(&other);
    dmb_sim_destroy(&late);
    dmb_sim_destroy(&fresh);
    close_both(&c, &sim);
}

/* Another model of the same scene goes on with what was set; one with other bounds is refused. */
static void transferred(void **state)
{
    (void)state;
    controlled c = whole(), d = whole();
    dmb_sim *sim = rig_sim(&c.rig), *to = rig_sim(&d.rig);
    dmb_input_state input = dmb_input_state_default();
    run(sim, 60);
    must(dmb_sim_set_input(sim, c.density, 1700.0));
    must(dmb_sim_set_input(sim, c.feed, 0.2));
    run(sim, 5);
    assert_true(dmb_sim_transfer_state(to, sim) >= 0);
    must(dmb_sim_get_input(to, d.density, &input));
    assert_true(input.value == 1700.0);
    assert_true(fabs(place_of_bit(sim, &c.rig) - place_of_bit(to, &d.rig)) < 1e-14);
    dmb_energy e = dmb_energy_default(), f = dmb_energy_default();
    must(dmb_query_energy(sim, &e));
    must(dmb_query_energy(to, &f));
    assert_true(fabs(e.gravity - f.gravity) < 1e-13 && fabs(e.balance - f.balance) < 1e-9);
    run(sim, 150);
    run(to, 150);
    dmb_drive_state a = dmb_drive_state_default(), b = dmb_drive_state_default();
    must(dmb_query_drive(sim, c.rig.feed, &a));
    must(dmb_query_drive(to, d.rig.feed, &b));
    assert_true(fabs(a.speed - 0.2) < 1e-14 && fabs(a.position - b.position) < 1e-13);
    close_both(&c, &sim);
    close_both(&d, &to);
}

/* Modes keep what was set when they were found, though other values are set and the sim is gone: against a scene that
 * is described so. A mode of the axis of a string in a slack hole goes with the square root of its weight. */
static void modes_outlive_the_sim(void **state)
{
    (void)state;
    double frequencies[2], shapes[2];
    for (int k = 0; k < 2; k++) {
        dmb_model *model = NULL;
        dmb_sim *sim = NULL;
        dmb_modes *modes = NULL;
        dmb_string_def string = dmb_string_def_default();
        dmb_environment_def e = dmb_environment_def_default();
        dmb_mode mode = dmb_mode_default();
        dmb_mode_shape shape = dmb_mode_shape_default();
        const dmb_pipe_def pipe = dmb_pipe_def_default();
        dmb_id id;
        must(dmb_model_create(NULL, &model));
        e.gravity[2] = 0.0;
        e.gravity[0] = 9.81; /* hangs from its rig end */
        if (k == 1) e.fluid_density = 5000.0;
        must(dmb_model_set_environment(model, &e));
        string.start_free = DMB_FREE_NONE;
        must(dmb_model_add_string(model, &string, &id));
        must(dmb_model_add_pipes(model, &pipe, 6, NULL));
        const dmb_id density = add(model, "density", DMB_TARGET_FLUID_DENSITY, nothing, (double)NAN);
        must(dmb_model_compile(model, NULL));
        must(dmb_sim_create(model, NULL, &sim));
        if (k == 0) must(dmb_sim_set_input(sim, density, 5000.0));
        must(dmb_analysis_static(sim, NULL, NULL));
        must(dmb_analysis_modes(sim, NULL, &modes));
        if (k == 0) must(dmb_sim_set_input(sim, density, 0.0));
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&model);
        must(dmb_modes_get(modes, 0, &mode));
        must(dmb_modes_shape(modes, 0, dmb_station(id, 5, 1.0), &shape));
        frequencies[k] = mode.frequency;
        shapes[k] = fabs(shape.re[1]) + fabs(shape.re[2]) + mode.share[0];
        dmb_modes_destroy(&modes);
    }
    assert_true(fabs(frequencies[0] / frequencies[1] - 1.0) < 1e-9);
    assert_true(isfinite(shapes[0]) && isfinite(shapes[1]));
}

/* Bytes with a checksum that fits: no value beyond the bounds, none that is no number where there is no time function.
 */
static void forged(void **state)
{
    (void)state;
    controlled c = whole();
    dmb_sim *sim = rig_sim(&c.rig), *other = rig_sim(&c.rig);
    const struct {
        uint32_t input;
        double value;
        int32_t status;
    } cases[] = {{1, -1.0, DMB_ERR_VALUE}, {1, (double)NAN, DMB_ERR_VALUE}, {1, (double)INFINITY, DMB_ERR_VALUE},
                 {8, -0.1, DMB_ERR_VALUE}, {13, 0.6, DMB_ERR_VALUE},        {0, (double)NAN, DMB_OK},
                 {1, 5.0, DMB_OK},         {9, -1.0, DMB_ERR_VALUE}};
    size_t size;
    run(other, 5);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        const double was = sim->input_value[cases[k].input];
        const uint64_t before = hash_of(other);
        sim->input_value[cases[k].input] = cases[k].value;
        void *block = saved(sim, &size);
        assert_int_equal(dmb_sim_restore(other, block, size), cases[k].status);
        if (cases[k].status < 0) assert_int_equal(hash_of(other), before);
        sim->input_value[cases[k].input] = was;
        free(block);
        run(other, 3);
    }
    sim->input_begin[1] = (double)NAN;
    void *block = saved(sim, &size);
    assert_int_equal(dmb_sim_restore(other, block, size), DMB_ERR_VALUE);
    free(block);
    dmb_sim_destroy(&other);
    close_both(&c, &sim);
}

/* Density up while the string hangs in a hole: the energy of weight changes, and the balance holds. */
static void ledger_holds(void **state)
{
    (void)state;
    controlled c = whole();
    dmb_sim *sim = rig_sim(&c.rig);
    dmb_energy before = dmb_energy_default(), after = dmb_energy_default();
    run(sim, 80);
    must(dmb_query_energy(sim, &before));
    must(dmb_sim_set_input(sim, c.density, 2500.0));
    must(dmb_query_energy(sim, &after));
    assert_true(fabs(after.gravity - before.gravity) > 1e-6);
    assert_true(fabs(after.loads - before.loads - (after.gravity - before.gravity)) < 1e-12);
    assert_true(fabs(after.balance - before.balance) < 1e-12);
    assert_true(fabs(after.scheme - before.scheme) < 1e-12);
    close_both(&c, &sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_and_units),       cmocka_unit_test(as_described),
        cmocka_unit_test(gains_and_limits),      cmocka_unit_test(friction_as_described),
        cmocka_unit_test(out_of_bounds),         cmocka_unit_test(bad_definitions),
        cmocka_unit_test(motion_follows),        cmocka_unit_test(motion_is_turned_round),
        cmocka_unit_test(log_and_snapshot),      cmocka_unit_test(transferred),
        cmocka_unit_test(ledger_holds),          cmocka_unit_test(forged),
        cmocka_unit_test(modes_outlive_the_sim),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
