/* Snapshots changed as the bytes of the input say, their checksum made to fit or not: a restore refuses them and
 * changes nothing, or takes them, and then steps, queries and analyses end with a known status. One that was changed
 * and whose checksum does not fit is never taken.
 *
 * Input: [0] scene in bits 0 and 1, bit 2: the checksum is made to fit, bit 3: the end is cut by the next two bytes.
 * Then changes: three bytes of a place, one of a length less 1 (bits 0 to 2), so many bytes. */
#include <stdlib.h>

#include "../contract/joint_scene.h"
#include "../contract/whole_scene.h"
#include "run/fingerprint.h"

enum { HEADER = 48, CONTENT_AT = 40, SCENES = 3, CHANGES = 64 };

typedef struct scene {
    dmb_sim *victim;
    unsigned char *sound;
    size_t size;
    uint64_t hash;
} scene;

static scene scenes[SCENES];

#define MUST(condition)                                                     \
    do {                                                                    \
        if (!(condition)) {                                                 \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
            abort();                                                        \
        }                                                                   \
    } while (0)

/* ---- Scenes, made once ------------------------------------------------------------------------------------------- */

static dmb_model *model_of(int which)
{
    static joint_scene joints;
    static whole_parts of[2]; /* callbacks look at them */
    size_t before_joints = 0;
    if (which == 2) {
        joint_scene_open(&joints, NULL);
        return joints.s.model;
    }
    while (whole_calls[before_joints] != whole_add_arm) before_joints++;
    dmb_model *model = which == 0 ? whole_model_until(&of[0], before_joints) : whole_model(&of[1]);
    if (which == 0) whole_must(model, dmb_model_compile(model, NULL));
    return model;
}

static scene *scene_of(int which)
{
    scene *s = scenes + which;
    dmb_sim_options options = dmb_sim_options_default();
    if (s->victim != NULL) return s;
    options.max_steps = 10;
    dmb_model *model = model_of(which);
    s->victim = whole_sim(model, &options);
    whole_run(s->victim, 15, 5e-4);
    MUST(dmb_sim_snapshot_size(s->victim, &s->size) == DMB_OK);
    s->sound = malloc(s->size);
    MUST(s->sound != NULL && dmb_sim_snapshot(s->victim, s->sound, s->size) == DMB_OK);
    s->hash = whole_hash(s->victim);
    dmb_model_destroy(&model); /* the sim holds it */
    return s;
}

static void close_scenes(void)
{
    for (int i = 0; i < SCENES; i++) {
        dmb_sim_destroy(&scenes[i].victim);
        free(scenes[i].sound);
        scenes[i].sound = NULL;
    }
}

/* ---- What is done with a sim that took one ----------------------------------------------------------------------- */

static void known(int32_t status)
{
    MUST(strcmp(dmb_status_name(status), "DMB_UNKNOWN") != 0);
}

static void use(dmb_sim *sim)
{
    dmb_check_report report = dmb_check_report_default();
    dmb_static_options statics = dmb_static_options_default();
    dmb_energy energy = dmb_energy_default();
    dmb_contact contact = dmb_contact_default();
    statics.max_iterations = 2;
    for (int i = 0; i < 2; i++) known(dmb_sim_step(sim, 5e-4, NULL));
    known(dmb_query_energy(sim, &energy));
    for (uint32_t i = 0; dmb_query_contact(sim, i, &contact) == DMB_OK; i++) continue;
    known(dmb_sim_advance(sim, dmb_sim_time(sim) + 1e-4, NULL));
    known(dmb_analysis_check(sim, &report));
    known(dmb_analysis_static(sim, &statics, NULL));
}

/* ---- One input --------------------------------------------------------------------------------------------------- */

static size_t change(unsigned char *block, size_t size, const uint8_t *data, size_t left)
{
    for (int i = 0; i < CHANGES && left >= 5 && size > 0; i++) {
        const size_t at = ((size_t)data[0] << 16 | (size_t)data[1] << 8 | data[2]) % size;
        const size_t wanted = (data[3] & 7u) + 1u, length = wanted < left - 4 ? wanted : left - 4;
        for (size_t k = 0; k < length && at + k < size; k++) block[at + k] = data[4 + k];
        data += 4 + length;
        left -= 4 + length;
    }
    return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t left);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t left)
{
    static int registered;
    if (!registered) registered = atexit(close_scenes) == 0;
    if (left < 3) return 0;
    const uint8_t how = data[0];
    scene *s = scene_of((how & 3) % SCENES);
    unsigned char *block = malloc(s->size);
    MUST(block != NULL);
    memcpy(block, s->sound, s->size);
    size_t size = s->size;
    if (how & 8) size -= ((size_t)data[1] << 8 | data[2]) % size;
    (void)change(block, size, data + 3, left - 3);
    if ((how & 4) && size >= HEADER) {
        const uint64_t content = dmb_fnv_block(DMB_FNV_START, block + HEADER, size - HEADER);
        memcpy(block + CONTENT_AT, &content, sizeof content);
    }
    const int same = size == s->size && memcmp(block, s->sound, size) == 0;
    const int32_t status = dmb_sim_restore(s->victim, block, size);
    known(status);
    free(block);
    if (status < 0) {
        MUST(!same && dmb_sim_message(s->victim)[0] != '\0' && whole_hash(s->victim) == s->hash);
        return 0;
    }
    MUST(same || (how & 4));
    use(s->victim);
    MUST(dmb_sim_restore(s->victim, s->sound, s->size) == DMB_OK && whole_hash(s->victim) == s->hash);
    return 0;
}
