/* Fields of a snapshot forged by name, its checksum made to fit: refused for that field, or taken and harmless. After
 * cmocka.h. */
#ifndef DMB_TESTS_FORGING_H
#define DMB_TESTS_FORGING_H

#include "forged.h"
#include "run/run.h"
#include "sim/layout.h"
#include "system/constrain/constrain.h"

static inline void take(subject *s)
{
    assert_int_equal(dmb_sim_snapshot_size(s->sim, &s->size), DMB_OK);
    s->sound = malloc(s->size);
    s->forged = malloc(s->size);
    assert_true(s->sound != NULL && s->forged != NULL);
    assert_int_equal(dmb_sim_snapshot(s->sim, s->sound, s->size), DMB_OK);
    memcpy(s->forged, s->sound, s->size);
    s->hash = hash_of(s->sim);
}

/* A cantilever of two pipes that shakes, with no wall: held rows are not turned into other frames there. */
static inline subject open_cantilever(int32_t kind)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    subject s = {.sim = NULL};
    SAVED_MUST(&s.scene, dmb_model_create(NULL, &s.scene.model));
    string.start_free = DMB_FREE_NONE;
    SAVED_MUST(&s.scene, dmb_model_add_string(s.scene.model, &string, &s.scene.string));
    pipe.kind = kind;
    SAVED_MUST(&s.scene, dmb_model_add_pipes(s.scene.model, &pipe, 2, NULL));
    SAVED_MUST(&s.scene, dmb_model_compile(s.scene.model, NULL));
    s.sim = saved_sim(&s.scene);
    for (int i = 0; i < 20; i++) assert_int_equal(dmb_sim_step(s.sim, 2e-4, NULL), DMB_OK);
    take(&s);
    return s;
}

static inline subject open_subject(int which)
{
    subject s = {.scene = saved_scene_open(which)};
    s.sim = saved_sim(&s.scene);
    saved_run(&s.scene, s.sim);
    take(&s);
    return s;
}

static inline void close_subject(subject *s)
{
    free(s->sound);
    free(s->forged);
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->scene.model);
}

/* ---- Forging ----------------------------------------------------------------------------------------------------- */

/* Item i of a field in the forged snapshot. */
static inline unsigned char *at(const subject *s, const char *name, size_t item, size_t size)
{
    dmb_field fields[DMB_FIELD_MAX];
    const size_t count = dmb_sim_fields(s->sim, DMB_GROUP_NOW, DMB_GROUP_FACTORS, fields);
    size_t place = HEADER, i = 0;
    while (i < count && strcmp(fields[i].name, name) != 0) place += fields[i++].bytes;
    assert_true(i < count && fields[i].bytes >= (item + 1) * size);
    return s->forged + place + item * size;
}

static inline void put(const subject *s, const char *name, size_t item, double value)
{
    memcpy(at(s, name, item, sizeof value), &value, sizeof value);
}

static inline double got(const subject *s, const char *name, size_t item)
{
    double value;
    memcpy(&value, at(s, name, item, sizeof value), sizeof value);
    return value;
}

static inline void put_word(const subject *s, const char *name, size_t item, uint32_t value)
{
    memcpy(at(s, name, item, sizeof value), &value, sizeof value);
}

static inline uint32_t got_word(const subject *s, const char *name, size_t item)
{
    uint32_t value;
    memcpy(&value, at(s, name, item, sizeof value), sizeof value);
    return value;
}

static inline int32_t restore(subject *s)
{
    const uint64_t content = dmb_fnv_block(DMB_FNV_START, s->forged + HEADER, s->size - HEADER);
    memcpy(s->forged + CONTENT_AT, &content, sizeof content);
    return dmb_sim_restore(s->sim, s->forged, s->size);
}

/* The forged snapshot is refused for that field, and the next is sound again. */
static inline void refused(subject *s, const char *field)
{
    char wanted[64];
    (void)snprintf(wanted, sizeof wanted, "snapshot: %s, number", field);
    const int32_t status = restore(s);
    const char *message = dmb_sim_message(s->sim);
    if (status != DMB_ERR_VALUE) fail_msg("%s: status %s", field, dmb_status_name(status));
    if (strstr(message, wanted) == NULL || strstr(message, " = ") == NULL || strstr(message, "must be ") == NULL ||
        strstr(message, "take another") == NULL)
        fail_msg("%s: message: %s", field, message);
    assert_int_equal(hash_of(s->sim), s->hash);
    memcpy(s->forged, s->sound, s->size);
}

static inline void finite(const dmb_sim *sim)
{
    for (uint32_t i = 0; i < sim->scene->row_count; i++)
        assert_true(isfinite(sim->now.velocity[i]) && isfinite(sim->now.acceleration[i]));
    for (uint32_t i = 0; i < 3 * sim->scene->node_count; i++) assert_true(isfinite(sim->now.displacement[i]));
}

/* [m, rad] equations of joints left in the accepted state. */
static inline double violation_of(dmb_sim *sim)
{
    double most = 0.0;
    for (uint32_t r = 0; r < sim->scene->constraint_row_count; r++)
        if (sim->constraint_type[r] == DMB_ROW_POSITION) most = fmax(most, fabs(sim->constraint_value[r]));
    return most;
}

/* Taken; steps end on the constraints, or are refused with a message and change nothing. Returns how many ended. */
static inline int harmless(subject *s, const char *what)
{
    int ended = 0;
    const int32_t status = restore(s);
    if (status < 0) fail_msg("%s: %s", what, dmb_sim_message(s->sim));
    for (int i = 0; i < 3; i++) {
        const uint64_t before = hash_of(s->sim);
        const int32_t stepped = dmb_sim_step(s->sim, 2e-4, NULL);
        assert_string_not_equal(dmb_status_name(stepped), "DMB_UNKNOWN");
        if (stepped >= 0 && violation_of(s->sim) > 1e-6) fail_msg("%s: %g is left", what, violation_of(s->sim));
        if (stepped < 0 && hash_of(s->sim) != before) fail_msg("%s: a failing step changed something", what);
        if (stepped < 0 && dmb_sim_message(s->sim)[0] == '\0') fail_msg("%s: no message", what);
        ended += stepped >= 0;
    }
    finite(s->sim);
    memcpy(s->forged, s->sound, s->size);
    assert_int_equal(restore(s), DMB_OK);
    assert_int_equal(hash_of(s->sim), s->hash);
    return ended;
}

#endif
