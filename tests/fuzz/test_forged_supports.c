/* Poses of what supports hold, forged in a snapshot: refused for each component that is not free, taken for each that
 * is, for every set of free components; and states in which supports have moved, after a state transfer, are taken. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "forging.h"
#include "math/so3.h"

/* ---- Bodies ------------------------------------------------------------------------------------------------------ */

static const int32_t sets[] = {DMB_FREE_NONE,
                               DMB_FREE_X,
                               DMB_FREE_Y,
                               DMB_FREE_Z,
                               DMB_FREE_RX,
                               DMB_FREE_RY,
                               DMB_FREE_RZ,
                               DMB_FREE_XY,
                               DMB_FREE_XZ,
                               DMB_FREE_YZ,
                               DMB_FREE_CYLINDRICAL,
                               DMB_FREE_CYLINDRICAL_Y,
                               DMB_FREE_CYLINDRICAL_Z,
                               DMB_FREE_PLANAR,
                               DMB_FREE_PLANAR_Y,
                               DMB_FREE_PLANAR_Z,
                               DMB_FREE_TRANSLATIONS,
                               DMB_FREE_SPHERICAL,
                               DMB_FREE_SCHOENFLIES,
                               DMB_FREE_SCHOENFLIES_Y,
                               DMB_FREE_SCHOENFLIES_Z,
                               DMB_FREE_ALL};

/* A tilted body, pushed and turned about every axis, and steps large enough to leave the first order. */
static subject open_body(int32_t mask, double at)
{
    dmb_body_def body = dmb_body_def_default();
    dmb_load_def load = dmb_load_def_default();
    subject s = {.sim = NULL};
    dmb_id id;
    SAVED_MUST(&s.scene, dmb_model_create(NULL, &s.scene.model));
    body.free_mask = mask;
    body.rotation[0] = 0.6, body.rotation[1] = -0.3, body.rotation[2] = 0.8;
    body.position[1] = at;
    for (int i = 0; i < 3; i++) body.inertia[i] = 0.02 + 0.01 * i;
    SAVED_MUST(&s.scene, dmb_model_add_body(s.scene.model, &body, &id));
    load.place = dmb_station(id, 0, 0.0);
    for (int i = 0; i < 3; i++) load.force[i] = 3.0 - 4.0 * i, load.moment[i] = 0.4 - 0.3 * i;
    SAVED_MUST(&s.scene, dmb_model_add_load(s.scene.model, &load, NULL));
    SAVED_MUST(&s.scene, dmb_model_compile(s.scene.model, NULL));
    s.sim = saved_sim(&s.scene);
    for (int i = 0; i < 40; i++) assert_int_equal(dmb_sim_step(s.sim, 5e-3, NULL), DMB_OK);
    take(&s);
    return s;
}

/* Moves the forged body along, or turns it about, its own axis c. */
static void shift(const subject *s, int c, double by)
{
    double vector[3] = {0.0, 0.0, 0.0}, q[4], turn[4], moved[4], way[3];
    vector[c % 3] = by;
    for (size_t i = 0; i < 4; i++) q[i] = got(s, "quaternion", i);
    if (c < 3) {
        dmb_quat_rotate(q, vector, way);
        for (size_t i = 0; i < 3; i++) put(s, "displacement", i, got(s, "displacement", i) + way[i]);
        return;
    }
    turn[0] = cos(0.5 * by);
    for (int i = 0; i < 3; i++) turn[1 + i] = sin(0.5 * by) * (i == c % 3);
    dmb_quat_mul(q, turn, moved);
    for (size_t i = 0; i < 4; i++) put(s, "quaternion", i, moved[i]);
}

static void bodies_stay_on_their_supports(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof sets / sizeof sets[0]; k++) {
        subject s = open_body(sets[k], 0.0);
        assert_int_equal(restore(&s), DMB_OK); /* as it came from the run, far from where it began */
        for (int c = 0; c < 6; c++) {
            shift(&s, c, c < 3 ? 1e-3 : 0.3);
            if (sets[k] & DMB_FREE_X << c) {
                if (restore(&s) < 0) fail_msg("mask %d, component %d: %s", sets[k], c, dmb_sim_message(s.sim));
                memcpy(s.forged, s.sound, s.size);
                assert_int_equal(restore(&s), DMB_OK);
            } else {
                refused(&s, c < 3 ? "displacement" : "quaternion");
            }
        }
        close_subject(&s);
    }
}

/* ---- Strings ----------------------------------------------------------------------------------------------------- */

static void strings_stay_where_they_are_held(void **state)
{
    (void)state;
    subject s = open_cantilever(DMB_PIPE_FLEXIBLE);
    put(&s, "displacement", 1, 1e-4);
    refused(&s, "displacement");
    put(&s, "displacement", 0, -3.0);
    refused(&s, "displacement");
    put(&s, "displacement", 5, 1e-4); /* of the node after it, which is free */
    assert_int_equal(restore(&s), DMB_OK);
    close_subject(&s);
    s = open_cantilever(DMB_PIPE_AXIAL_TORSIONAL);
    assert_int_equal(s.sim->scene->layout.size[0], DMB_NODE_AXIAL_TORSIONAL);
    put(&s, "displacement", 0, 1e-4);
    refused(&s, "displacement");
    put(&s, "turn", 0, 0.1);
    refused(&s, "turn");
    put(&s, "turn", 1, 0.1);
    assert_int_equal(restore(&s), DMB_OK);
    close_subject(&s);
}

/* ---- Supports that have moved --------------------------------------------------------------------------------------
 */

/* A transfer leaves a body where it is in the world, and its support grips it there. */
static void carried_supports_are_taken(void **state)
{
    (void)state;
    subject from = open_body(DMB_FREE_X, 0.0), s = open_body(DMB_FREE_X, 0.25);
    assert_true(s.sim->counters->carried == 0);
    assert_true(dmb_sim_transfer_state(s.sim, from.sim) >= 0);
    assert_true(s.sim->counters->carried == 1);
    free(s.sound);
    free(s.forged);
    take(&s);
    dmb_sim *fresh = saved_sim(&s.scene);
    assert_int_equal(dmb_sim_restore(fresh, s.sound, s.size), DMB_OK);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(dmb_sim_step(fresh, 5e-3, NULL), DMB_OK);
        assert_int_equal(dmb_sim_step(s.sim, 5e-3, NULL), DMB_OK);
    }
    assert_int_equal(hash_of(fresh), hash_of(s.sim));
    for (int i = 0; i < 5; i++) assert_int_equal(dmb_sim_step(from.sim, 5e-3, NULL), DMB_OK);
    for (int i = 0; i < 3; i++) /* the world place is that of a body that was never carried */
        assert_true(fabs(fresh->now.displacement[i] - (from.sim->now.displacement[i] - 0.25 * (i == 1))) < 1e-12);
    dmb_sim_destroy(&fresh);
    s.hash = hash_of(s.sim);
    const size_t mark = offsetof(dmb_counters, carried) / sizeof(uint64_t);
    *(uint64_t *)(void *)at(&s, "counters", mark, sizeof(uint64_t)) = 2;
    refused(&s, "counters");
    *(uint64_t *)(void *)at(&s, "counters", mark, sizeof(uint64_t)) = 0;
    refused(&s, "displacement");
    close_subject(&s);
    close_subject(&from);
}

/* A sim without a ledger goes on from one that has one: its own stays empty, the motion is the same. */
static void carried_without_a_ledger(void **state)
{
    (void)state;
    dmb_sim_options options = dmb_sim_options_default();
    subject from = open_body(DMB_FREE_CYLINDRICAL, 0.0), s = open_body(DMB_FREE_CYLINDRICAL, 0.0);
    dmb_sim *without = NULL;
    options.energy_ledger = 0;
    SAVED_MUST(&s.scene, dmb_sim_create(s.scene.model, &options, &without));
    assert_true(dmb_sim_transfer_state(without, from.sim) >= 0);
    assert_true(without->ledger->start == 0.0 && without->ledger->input == 0.0);
    for (int i = 0; i < 3; i++) assert_true(without->now.displacement[i] == from.sim->now.displacement[i]);
    for (int i = 0; i < 6; i++) assert_true(without->now.velocity[i] == from.sim->now.velocity[i]);
    dmb_sim_destroy(&without);
    close_subject(&from);
    close_subject(&s);
}

/* The mark tells of the last transfer: one to where it is described takes it back. */
static void carried_back(void **state)
{
    (void)state;
    subject home = open_body(DMB_FREE_CYLINDRICAL, 0.0), away = open_body(DMB_FREE_CYLINDRICAL, 0.5);
    assert_true(dmb_sim_transfer_state(away.sim, home.sim) >= 0 && away.sim->counters->carried == 1);
    assert_true(dmb_sim_transfer_state(home.sim, away.sim) >= 0 && home.sim->counters->carried == 0);
    close_subject(&home);
    close_subject(&away);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_stay_on_their_supports), cmocka_unit_test(strings_stay_where_they_are_held),
        cmocka_unit_test(carried_supports_are_taken),    cmocka_unit_test(carried_back),
        cmocka_unit_test(carried_without_a_ledger),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
