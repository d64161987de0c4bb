/* Names of bodies, drives and loads, as joints have them, against the messages that tell of those parts: where they are
 * described, compiled, run and analysed; without names the parts are told by number as before. */
#include "sim_test.h"

static void expect(const char *message, const char *text)
{
    if (strstr(message, text) == NULL) fail_msg("\"%s\" without \"%s\"", message, text);
}

static void told_where_described(void **state)
{
    dmb_model *model;
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_id id;
    (void)state;
    must(dmb_model_create(NULL, &model));
    body.mass = -1.0;
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 0: mass = -1");
    strcpy(body.name, "turbine");
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 0 (turbine): mass = -1");
    body.mass = 1.0;
    body.inertia[0] = 0.3;
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 0 (turbine): inertia gives the principal");
    body.inertia[0] = 1e-3;
    body.inertia[3] = 1.0;
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 0 (turbine): inertia = (0.001");
    body.inertia[3] = 0.0;
    must(dmb_model_add_body(model, &body, &id));
    memset(body.name, 'x', sizeof body.name);
    assert_int_equal(dmb_model_add_body(model, &body, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "body 1: name = 24, must be characters, at most 23");
    strcpy(drive.name, "pump");
    drive.part = id;
    assert_int_equal(dmb_model_add_drive(model, &drive, NULL), DMB_ERR_ID);
    expect(dmb_model_message(model), "drive 0 (pump): programme");
    memset(drive.name, 'x', sizeof drive.name);
    assert_int_equal(dmb_model_add_drive(model, &drive, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "drive 0: name");
    strcpy(load.name, "hook");
    load.place = dmb_station(id, 0, 0.0);
    load.force[2] = (double)INFINITY;
    assert_int_equal(dmb_model_add_load(model, &load, NULL), DMB_ERR_NOT_FINITE);
    expect(dmb_model_message(model), "load 0 (hook): force[2] = inf");
    memset(load.name, 'x', sizeof load.name);
    assert_int_equal(dmb_model_add_load(model, &load, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "load 0: name");
    dmb_model_destroy(&model);
}

static dmb_id constant(dmb_model *model, double value)
{
    dmb_term term = dmb_term_default();
    dmb_id id;
    term.h0 = value;
    must(dmb_model_add_programme(model, &term, 1, &id));
    return id;
}

static void told_by_compile(void **state)
{
    dmb_model *model;
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_load_def load = dmb_load_def_default();
    (void)state;
    must(dmb_model_create(NULL, &model));
    body.free_mask = DMB_FREE_RX;
    must(dmb_model_add_body(model, &body, &drive.part));
    strcpy(drive.name, "pump");
    drive.programme = constant(model, 1.0);
    drive.component = DMB_X;
    must(dmb_model_add_drive(model, &drive, NULL));
    assert_int_equal(dmb_model_compile(model, NULL), DMB_ERR_VALUE);
    expect(dmb_model_message(model), "drive 0 (pump): component = 0, must be free where the drive acts");
    dmb_model_destroy(&model);
    must(dmb_model_create(NULL, &model));
    must(dmb_model_add_body(model, &body, &load.place.part));
    strcpy(load.name, "hook");
    load.frame = DMB_FRAME_HOLE;
    must(dmb_model_add_load(model, &load, NULL));
    assert_int_equal(dmb_model_compile(model, NULL), DMB_ERR_GEOMETRY);
    expect(dmb_model_message(model), "load 0 (hook): frame = 2");
    dmb_model_destroy(&model);
}

static void told_by_runs_and_analyses(void **state)
{
    dmb_model *model;
    dmb_sim *sim;
    dmb_id id;
    dmb_body_def body = dmb_body_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    char text[8192];
    (void)state;
    must(dmb_model_create(NULL, &model));
    strcpy(body.name, "weight");
    must(dmb_model_add_body(model, &body, &drive.part));
    strcpy(body.name, "stone");
    must(dmb_model_add_body(model, &body, NULL));
    strcpy(drive.name, "pump");
    drive.component = DMB_RX;
    drive.programme = constant(model, 1.0);
    must(dmb_model_add_drive(model, &drive, &id));
    must(dmb_model_compile(model, NULL));
    assert_true(dmb_sim_create(model, NULL, &sim) >= 0);
    assert_int_equal(dmb_sim_set_drive(sim, id, 1.0), DMB_ERR_UNSUPPORTED);
    expect(dmb_sim_message(sim), "drive 0 (pump): its kind is DMB_DRIVE_MOTION");
    assert_true(dmb_analysis_static(sim, NULL, NULL) < 0);
    expect(dmb_sim_message(sim), "): nothing holds it");
    must(dmb_analysis_check_text(sim, text, sizeof text, NULL));
    expect(text, "body 1 (stone): no guide");
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(told_where_described),
        cmocka_unit_test(told_by_compile),
        cmocka_unit_test(told_by_runs_and_analyses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
