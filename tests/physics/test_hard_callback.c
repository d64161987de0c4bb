/* Hard case 9, in mid-run: a time function's callback that fails, or gives NaN or infinity, has its step refused with
 * DMB_ERR_CALLBACK; the last accepted state is kept to the bit, and the run goes on when the callback recovers. */
#include "contact_scene.h"

enum { ANSWER_GOOD = 0, ANSWER_ERROR = 1, ANSWER_NAN = 2, ANSWER_INFINITE = 3, ANSWER_NAN_RATE = 4 };

typedef struct moody {
    int32_t answer; /* from `after` on */
    double after;   /* [s] */
    uint32_t calls;
} moody;

static int32_t time_function(void *context, double time, double out[3])
{
    moody *m = context;
    m->calls++;
    out[0] = sin(time);
    out[1] = cos(time);
    out[2] = 1.0 - cos(time);
    if (time < m->after) return 0;
    if (m->answer == ANSWER_ERROR) return 7;
    if (m->answer == ANSWER_NAN) out[0] = (double)NAN;
    if (m->answer == ANSWER_INFINITE) out[0] = (double)INFINITY;
    if (m->answer == ANSWER_NAN_RATE) out[1] = (double)NAN;
    return 0;
}

enum {
    ROLE_MOTION = 0,
    ROLE_LOAD_DRIVE = 1,
    ROLE_CONTROL = 2,
    ROLE_LOAD = 3,
    ROLE_BIT = 4,
    ROLE_EXCITATION = 5,
    ROLES = 6
};

static void add_drive_of(rig *scene, int32_t kind, dmb_id time_function_id, dmb_id excitation)
{
    dmb_drive_def drive = dmb_drive_def_default();
    drive.kind = kind;
    drive.time_function = time_function_id;
    drive.excitation = excitation;
    drive.gain = 100.0;
    add_drive(scene, &drive);
}

static void build(rig *scene, moody *m, int32_t role)
{
    const dmb_id none = {0, 0};
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_segment term = dmb_segment_default();
    const dmb_wall_def wall = dmb_wall_def_default();
    term.kind = DMB_SEGMENT_CALLBACK;
    term.callback = time_function;
    term.callback_context = m;
    term.provides = DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL;
    scene_open(scene, 9.81);
    add_wall(scene, &wall);
    const dmb_id id = add_time_function(scene, &term, 1);
    const dmb_id zero = add_constant(scene, 0.0);
    const dmb_id string = add_pipes(scene, &pipe, 3);
    if (role == ROLE_BIT) bit.load = id;
    scene_add_bit(scene, &bit);
    if (role == ROLE_LOAD) {
        load.place = dmb_station(string, 2, 1.0);
        load.force[0] = 100.0;
        load.time_function = id;
        add_load(scene, &load);
    }
    add_drive_of(scene,
                 role == ROLE_LOAD_DRIVE ? DMB_DRIVE_LOAD
                 : role == ROLE_CONTROL  ? DMB_DRIVE_CONTROL
                                         : DMB_DRIVE_MOTION,
                 role <= ROLE_CONTROL ? id : zero, role == ROLE_EXCITATION ? id : none);
    rig_start_with(scene, NULL, NULL);
}

/* Fails at .05 s in the middle of a run of steps. */
static void check_role(int32_t role, int32_t answer, int controlled)
{
    moody m = {answer, 0.05, 0};
    rig scene;
    uint64_t before = 0;
    int32_t status = DMB_OK;
    build(&scene, &m, role);
    for (int i = 0; i < 100 && status >= 0; i++) {
        before = rig_hash(&scene);
        status = controlled ? dmb_sim_advance(scene.sim, dmb_sim_time(scene.sim) + 1e-3, NULL)
                            : dmb_sim_step(scene.sim, 1e-3, NULL);
    }
    assert_int_equal(status, DMB_ERR_CALLBACK);
    assert_non_null(strstr(dmb_sim_message(scene.sim), "callback"));
    const double time = dmb_sim_time(scene.sim);
    assert_true(time > 0.04 && time < 0.05 + 1e-9);
    if (!controlled) assert_true(rig_hash(&scene) == before);
    before = rig_hash(&scene);
    assert_true((controlled ? dmb_sim_advance(scene.sim, 1.0, NULL) : dmb_sim_step(scene.sim, 0.1, NULL)) ==
                DMB_ERR_CALLBACK);
    assert_true(dmb_sim_time(scene.sim) < 0.05 + 1e-9);
    m.answer = ANSWER_GOOD;
    for (int i = 0; i < 50; i++) scene_step(&scene, 1e-3);
    assert_true(dmb_sim_time(scene.sim) > 0.09);
    rig_close(&scene);
}

static void in_every_role(void **state)
{
    (void)state;
    for (int32_t role = 0; role < ROLES; role++)
        for (int32_t answer = ANSWER_ERROR; answer <= ANSWER_INFINITE; answer++)
            for (int controlled = 0; controlled < 2; controlled++) check_role(role, answer, controlled);
}

/* The rate is asked for where a motion is prescribed. */
static void rate_of_a_motion(void **state)
{
    (void)state;
    check_role(ROLE_MOTION, ANSWER_NAN_RATE, 0);
}

/* A run with a failure in it ends in the very state of a run without. */
static void failure_leaves_no_trace(void **state)
{
    uint64_t hash[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        moody m = {ANSWER_NAN, 0.05, 0};
        rig scene;
        if (k == 0) m.answer = ANSWER_GOOD;
        build(&scene, &m, ROLE_MOTION);
        for (int i = 0; i < 100; i++) {
            const int32_t status = dmb_sim_step(scene.sim, 1e-3, NULL);
            if (status < 0) {
                assert_int_equal(status, DMB_ERR_CALLBACK);
                m.answer = ANSWER_GOOD;
                i--;
            }
        }
        hash[k] = rig_hash(&scene);
        rig_close(&scene);
    }
    assert_true(hash[0] == hash[1]);
}

/* A call that takes several steps (here: cut at corners) and fails in the last of them gives all of them back. */
static void failure_after_partial_steps(void **state)
{
    moody m = {ANSWER_ERROR, 0.05, 0};
    rig scene;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment terms[3] = {dmb_segment_default(), scene_step_segment(0.01, 0.0, 0.02, 1e-3),
                            scene_step_segment(0.03, 0.0, 0.04, 1e-3)};
    (void)state;
    terms[0].kind = DMB_SEGMENT_CALLBACK;
    terms[0].callback = time_function;
    terms[0].callback_context = &m;
    terms[0].provides = DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL;
    scene_open(&scene, 0.0);
    add_pipes(&scene, &pipe, 1);
    drive.time_function = add_time_function(&scene, terms, 3);
    add_drive(&scene, &drive);
    rig_start_with(&scene, NULL, NULL);
    scene_step(&scene, 5e-3);
    const uint64_t before = rig_hash(&scene);
    assert_int_equal(dmb_sim_step(scene.sim, 0.06, NULL), DMB_ERR_CALLBACK);
    assert_true(rig_hash(&scene) == before);
    CHECK_CLOSE(dmb_sim_time(scene.sim), 5e-3, 0.0);
    rig_close(&scene);
}

/* At the very start there is no sim. */
static void failure_at_the_start(void **state)
{
    moody m = {ANSWER_NAN, -1.0, 0};
    rig scene;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment term = dmb_segment_default();
    (void)state;
    term.kind = DMB_SEGMENT_CALLBACK;
    term.callback = time_function;
    term.callback_context = &m;
    scene_open(&scene, 0.0);
    add_pipes(&scene, &pipe, 1);
    drive.time_function = add_time_function(&scene, &term, 1);
    add_drive(&scene, &drive);
    scene_must(&scene, dmb_model_compile(scene.model, NULL));
    assert_int_equal(dmb_sim_create(scene.model, NULL, &scene.sim), DMB_ERR_CALLBACK);
    assert_null(scene.sim);
    rig_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(in_every_role),           cmocka_unit_test(rate_of_a_motion),
        cmocka_unit_test(failure_leaves_no_trace), cmocka_unit_test(failure_after_partial_steps),
        cmocka_unit_test(failure_at_the_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
