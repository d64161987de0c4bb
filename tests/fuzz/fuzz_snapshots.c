/* Snapshots changed as the bytes of the input say, their checksum made to fit or not: a restore refuses them and
 * changes nothing, or takes them, and then a step and queries end with a known status. One that was changed and whose
 * checksum does not fit is never taken. As target `restored` (DMB_ANALYSES) with analyses too, which take fifty times
 * as long as all else. With the number of a scene in the environment as SCENE it is that one always.
 *
 * Input: [0] scene in bits 0 and 1, bit 2: the checksum is made to fit, bit 3: the end is cut by the next two bytes,
 * bits 4 and 5 set: events are waited for, bits 4 to 7 set: analyses where there are any. Then changes: three bytes of
 * a place, one of a length less 1 (bits 0 to 2), so many bytes; or with its bit 3 set one of the words and numbers
 * below, on a multiple of its size. */
#include "must.h"
#include "run/run.h"
#include "saved_scenes.h"

enum { HEADER = 48, CONTENT_AT = 40, CHANGES = 64 };
#ifdef DMB_ANALYSES
enum { ANALYSES = 1 };
#else
enum { ANALYSES = 0 };
#endif

typedef struct subject {
    saved_scene scene;
    dmb_sim *victim;
    unsigned char *sound, *block;
    size_t size;
    uint64_t hash;
} subject;

static subject subjects[SAVED_SCENES];

/* ---- Scenes, made once ------------------------------------------------------------------------------------------- */

/* The snapshot is taken with options by which a step that does not converge soon is given up: a forged state often does
 * not. */
static subject *subject_of(int which)
{
    subject *s = subjects + which;
    if (s->victim != NULL) return s;
    s->scene = saved_scene_open(which);
    s->victim = saved_sim(&s->scene);
    saved_run(&s->scene, s->victim);
    s->victim->options.max_iterations = 2;
    s->victim->options.max_cuts = 0;
    s->victim->options.step_min = 5e-5;
    MUST(dmb_sim_snapshot_size(s->victim, &s->size) == DMB_OK);
    s->sound = malloc(s->size);
    s->block = malloc(s->size);
    MUST(s->sound != NULL && s->block != NULL && dmb_sim_snapshot(s->victim, s->sound, s->size) == DMB_OK);
    s->hash = hash_of(s->victim);
    return s;
}

static void close_subjects(void)
{
    for (int i = 0; i < SAVED_SCENES; i++) {
        dmb_sim_destroy(&subjects[i].victim);
        dmb_model_destroy(&subjects[i].scene.model);
        free(subjects[i].sound);
        free(subjects[i].block);
        subjects[i].sound = subjects[i].block = NULL;
    }
}

/* ---- What is done with a sim that took one ----------------------------------------------------------------------- */

static void known(int32_t status)
{
    MUST(strcmp(dmb_status_name(status), "DMB_UNKNOWN") != 0);
}

static void analyse(dmb_sim *sim)
{
    dmb_check_report report = dmb_check_report_default();
    dmb_static_options statics = dmb_static_options_default();
    statics.max_iterations = 2;
    known(dmb_analysis_check(sim, &report));
    known(dmb_analysis_static(sim, &statics, NULL));
}

static void use(const subject *s, int events, int analyses)
{
    dmb_energy energy = dmb_energy_default();
    dmb_contact contact = dmb_contact_default();
    known(dmb_sim_step(s->victim, 5e-4, NULL));
    known(dmb_query_energy(s->victim, &energy));
    for (uint32_t i = 0; dmb_query_contact(s->victim, i, &contact) == DMB_OK; i++) continue;
    if (events && s->scene.event.generation != 0)
        known(dmb_sim_advance_to_event(s->victim, dmb_sim_time(s->victim) + 1e-4, NULL, NULL));
    if (analyses) analyse(s->victim);
}

/* ---- One input --------------------------------------------------------------------------------------------------- */

static void put_known(unsigned char *block, size_t size, size_t at, uint8_t which)
{
    static const uint32_t words[] = {0, 1, 2, 3, 0x7fffffffu, 0x80000000u, 0x80000001u, 0xffffffffu};
    static const double numbers[] = {0.0, -1.0, 1e9, -1e17, 1e300, -1e300, 4.9e-324, (double)NAN};
    const size_t item = which & 8 ? sizeof numbers[0] : sizeof words[0];
    const size_t from = at < HEADER ? at : HEADER + (at - HEADER) / item * item;
    if (from + item > size) return;
    if (which & 8)
        memcpy(block + from, &numbers[which & 7], item);
    else
        memcpy(block + from, &words[which & 7], item);
}

static void change(unsigned char *block, size_t size, const uint8_t *data, size_t left)
{
    for (int i = 0; i < CHANGES && left >= 5 && size > 0; i++) {
        const size_t at = ((size_t)data[0] << 16 | (size_t)data[1] << 8 | data[2]) % size;
        const size_t wanted = data[3] & 8 ? 1u : (data[3] & 7u) + 1u, length = wanted < left - 4 ? wanted : left - 4;
        if (data[3] & 8) put_known(block, size, at, data[4]);
        for (size_t k = 0; !(data[3] & 8) && k < length && at + k < size; k++) block[at + k] = data[4 + k];
        data += 4 + length;
        left -= 4 + length;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t left);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t left)
{
    static int registered;
    if (!registered) registered = atexit(close_subjects) == 0;
    if (left < 3) return 0;
    const uint8_t how = data[0];
    const char *only = getenv("SCENE");
    const subject *s = subject_of((only != NULL ? atoi(only) : how) & 3);
    size_t size = s->size;
    memcpy(s->block, s->sound, size);
    if (how & 8) size -= ((size_t)data[1] << 8 | data[2]) % size;
    change(s->block, size, data + 3, left - 3);
    if ((how & 4) && size >= HEADER) {
        const uint64_t content = dmb_fnv_block(DMB_FNV_START, s->block + HEADER, size - HEADER);
        memcpy(s->block + CONTENT_AT, &content, sizeof content);
    }
    const int same = size == s->size && memcmp(s->block, s->sound, size) == 0;
    const int32_t status = dmb_sim_restore(s->victim, s->block, size);
    known(status);
    if (status < 0) {
        MUST(!same && dmb_sim_message(s->victim)[0] != '\0' && hash_of(s->victim) == s->hash);
        return 0;
    }
    MUST(same || (how & 4));
    use(s, (how & 0x30) == 0x30, ANALYSES && (how & 0xf0) == 0xf0);
    MUST(dmb_sim_restore(s->victim, s->sound, s->size) == DMB_OK && hash_of(s->victim) == s->hash);
    return 0;
}
