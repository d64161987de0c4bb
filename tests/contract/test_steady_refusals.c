/* Steady states refuse scenes with a message and change nothing; the default then takes the state at rest. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"
#include "hash.h"

/* A string of four pipes of 1 m; what is asked of a scene. */
typedef struct wish {
    double gravity[3];
    double speed, spin, across; /* of drives in X, RX, RZ */
    double eccentricity, curvature;
    double load; /* [N] at the far end along y, in `frame` */
    int32_t frame, wall;
} wish;

typedef struct scene {
    dmb_model *model;
    dmb_sim *sim;
} scene;

static void ok(const scene *s, int32_t status)
{
    if (status < 0) fail_msg("%s", dmb_model_message(s->model));
}

static void move(const scene *s, dmb_id part, int32_t component, double speed)
{
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment term = dmb_segment_default();
    term.h0 = speed;
    drive.kind = DMB_DRIVE_MOTION;
    drive.part = part;
    drive.component = component;
    ok(s, dmb_model_add_time_function(s->model, &term, 1, &drive.time_function));
    ok(s, dmb_model_add_drive(s->model, &drive, NULL));
}

static int32_t freed(const wish *w)
{
    if (w->across != 0.0) return DMB_FREE_RZ;
    return DMB_FREE_X | DMB_FREE_RX;
}

static scene make(const wish *w)
{
    scene s = {NULL, NULL};
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_id string;
    memcpy(environment.gravity, w->gravity, sizeof environment.gravity);
    def.start_free = freed(w);
    pipe.eccentricity = w->eccentricity;
    pipe.curvature[1] = w->curvature;
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    ok(&s, dmb_model_set_environment(s.model, &environment));
    if (w->wall) ok(&s, dmb_model_add_wall(s.model, &wall, NULL));
    ok(&s, dmb_model_add_string(s.model, &def, &string));
    ok(&s, dmb_model_add_pipes(s.model, &pipe, 4, NULL));
    load.place = dmb_station(string, 3, 1.0);
    load.frame = w->frame;
    load.force[1] = w->load;
    if (w->load != 0.0) ok(&s, dmb_model_add_load(s.model, &load, NULL));
    if (w->across != 0.0) {
        move(&s, string, DMB_RZ, w->across);
    } else {
        move(&s, string, DMB_X, w->speed);
        move(&s, string, DMB_RX, w->spin);
    }
    ok(&s, dmb_model_compile(s.model, NULL));
    ok(&s, dmb_sim_create(s.model, NULL, &s.sim));
    return s;
}

static void end(scene *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

static void refused(const wish *w, int32_t steady, int32_t status, const char *word)
{
    scene s = make(w);
    dmb_static_options options = dmb_static_options_default();
    const uint64_t before = hash_of(s.sim);
    options.steady = steady;
    assert_int_equal(dmb_analysis_static(s.sim, &options, NULL), status);
    print_message("%s\n", dmb_sim_message(s.sim));
    if (strstr(dmb_sim_message(s.sim), word) == NULL) fail_msg("no \"%s\" in: %s", word, dmb_sim_message(s.sim));
    assert_true(hash_of(s.sim) == before);
    end(&s);
}

static void found(const wish *w, int32_t steady, int32_t status, int32_t kind)
{
    scene s = make(w);
    dmb_static_options options = dmb_static_options_default();
    dmb_static_report report = dmb_static_report_default();
    options.steady = steady;
    const int32_t got = dmb_analysis_static(s.sim, &options, &report);
    if (got != status) fail_msg("%s: %s", dmb_status_name(got), dmb_sim_message(s.sim));
    assert_int_equal(report.steady, kind);
    end(&s);
}

static void sliding_asks_for_what_is_round(void **state)
{
    const wish eccentric = {.spin = 3.0, .eccentricity = 1e-3}, bent = {.spin = 3.0, .curvature = 1e-3};
    const wish loaded = {.spin = 3.0, .load = 10.0, .frame = DMB_FRAME_BODY}, swung = {.across = 3.0};
    const wish pushed = {.speed = 0.01, .eccentricity = 1e-3, .curvature = 1e-3, .load = 10.0, .frame = DMB_FRAME_BODY};
    (void)state;
    refused(&eccentric, DMB_STEADY_SLIDING, DMB_ERR_UNSUPPORTED, "eccentricity");
    refused(&bent, DMB_STEADY_SLIDING, DMB_ERR_UNSUPPORTED, "bent");
    refused(&loaded, DMB_STEADY_SLIDING, DMB_ERR_UNSUPPORTED, "load 0");
    refused(&swung, DMB_STEADY_SLIDING, DMB_ERR_UNSUPPORTED, "drive 0");
    found(&pushed, DMB_STEADY_SLIDING, DMB_OK, DMB_STEADY_SLIDING); /* nothing turns */
}

static void rigid_asks_for_one_axis(void **state)
{
    const wish heavy = {.gravity = {0.0, 0.0, -9.81}, .spin = 3.0},
               upright = {.gravity = {-9.81, 0.0, 0.0}, .spin = 3.0};
    const wish dead = {.across = 3.0, .load = 10.0, .frame = DMB_FRAME_WORLD};
    const wish follower = {.across = 3.0, .load = 10.0, .frame = DMB_FRAME_BODY};
    const wish walled = {.across = 3.0, .wall = 1};
    (void)state;
    refused(&heavy, DMB_STEADY_RIGID, DMB_ERR_UNSUPPORTED, "gravity");
    refused(&dead, DMB_STEADY_RIGID, DMB_ERR_UNSUPPORTED, "load 0");
    refused(&walled, DMB_STEADY_RIGID, DMB_ERR_UNSUPPORTED, "wall");
    found(&upright, DMB_STEADY_RIGID, DMB_OK, DMB_STEADY_RIGID);
    found(&follower, DMB_STEADY_RIGID, DMB_OK, DMB_STEADY_RIGID);
}

static void the_default_takes_what_there_is(void **state)
{
    const wish still = {.gravity = {0.0, 0.0, -9.81}}, turning = {.gravity = {0.0, 0.0, -9.81}, .spin = 3.0};
    const wish eccentric = {.spin = 3.0, .eccentricity = 1e-3}, swung = {.across = 3.0};
    const wish neither = {.gravity = {0.0, 0.0, -9.81}, .spin = 3.0, .eccentricity = 1e-3};
    (void)state;
    found(&still, DMB_STEADY_AUTO, DMB_OK, DMB_STEADY_AT_REST);
    found(&still, DMB_STEADY_RIGID, DMB_OK, DMB_STEADY_AT_REST); /* nothing moves */
    found(&turning, DMB_STEADY_AUTO, DMB_OK, DMB_STEADY_SLIDING);
    found(&turning, DMB_STEADY_AT_REST, DMB_OK, DMB_STEADY_AT_REST);
    found(&eccentric, DMB_STEADY_AUTO, DMB_OK, DMB_STEADY_RIGID);
    found(&swung, DMB_STEADY_AUTO, DMB_OK, DMB_STEADY_RIGID);
    found(&neither, DMB_STEADY_AUTO, DMB_NOTE_NOT_STEADY, DMB_STEADY_AT_REST);
}

static void nonsense_is_refused(void **state)
{
    const wish turning = {.spin = 3.0};
    (void)state;
    refused(&turning, 4, DMB_ERR_VALUE, "steady");
    refused(&turning, -1, DMB_ERR_VALUE, "steady");
    scene s = make(&turning);
    dmb_static_options options = dmb_static_options_default();
    options.steady = DMB_STEADY_SLIDING;
    for (int k = 0; k < 2; k++) {
        options.slip_axial = k == 0 ? 0.1 : 0.0;
        options.slip_rotation = k == 0 ? 0.0 : 2.0;
        assert_int_equal(dmb_analysis_static(s.sim, &options, NULL), DMB_ERR_VALUE);
        assert_non_null(strstr(dmb_sim_message(s.sim), "slip_axial"));
    }
    end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sliding_asks_for_what_is_round),
        cmocka_unit_test(rigid_asks_for_one_axis),
        cmocka_unit_test(the_default_takes_what_there_is),
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
