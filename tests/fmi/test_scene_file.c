/* The scene file of a unit: each setting comes back as it was written; a file of the wrong contents is refused by name.
 */
#include "loader.h"
#include "scene_file.h"

/* Another value for each option: whole numbers count up from `first`. */
static void change_options(scene_settings *settings, uint32_t first)
{
    for (int i = 0; i < SCENE_LISTS; ++i)
        for (uint32_t k = 0; k < scene_option_lists[i].count; ++k) {
            const scene_option *option = &scene_option_lists[i].options[k];
            char *at = (char *)settings + scene_option_lists[i].offset + option->offset;
            const double real = 1.0 / (double)(first + k);
            const uint32_t count = first + k;
            if (option->type == SCENE_REAL)
                memcpy(at, &real, sizeof real);
            else
                memcpy(at, &count, sizeof count);
        }
    settings->compile = dmb_compile_options_default(); /* its masks must be valid */
    settings->compile.pipe_kind = DMB_PIPE_AXIAL_TORSIONAL;
    settings->compile.features = DMB_FEATURE_GRAVITY | DMB_FEATURE_CONTACT;
}

static void test_settings_come_back(void **state)
{
    (void)state;
    rig r;
    scene_file scene;
    char path[128];
    scene_settings settings = scene_settings_default();
    open_rig(&r, 0);
    snprintf(path, sizeof path, "%s/scene.bin", r.folder);
    change_options(&settings, 3);
    settings.outputs = r.outputs;
    settings.output_count = OUTPUTS;
    settings.has_static = 1;
    settings.step = 1.0 / 3.0;
    assert_int_equal(scene_write(path, TOKEN, r.model, &settings), 0);
    if (scene_open(&scene, path, NULL, NULL) != 0) fail_msg("%s", scene.message);
    assert_memory_equal(&scene.settings.compile, &settings.compile, sizeof settings.compile);
    assert_memory_equal(&scene.settings.sim, &settings.sim, sizeof settings.sim);
    assert_memory_equal(&scene.settings.statics, &settings.statics, sizeof settings.statics);
    assert_int_equal(scene.settings.has_static, 1);
    assert_true(scene.settings.step == settings.step);
    assert_string_equal(scene.token, TOKEN);
    for (int i = 0; i < OUTPUTS; ++i) {
        const dmb_output *now = &scene.settings.outputs[i];
        assert_int_equal(now->place.part.index, r.outputs[i].place.part.index);
        assert_int_equal(now->quantity, r.outputs[i].quantity);
    }
    scene_close(&scene);
    close_rig(&r);
}

static void refused(const rig *r, const scene_settings *settings, const char *word)
{
    scene_file scene;
    char path[128];
    snprintf(path, sizeof path, "%s/scene.bin", r->folder);
    assert_int_equal(scene_write(path, TOKEN, r->model, settings), 0);
    assert_int_equal(scene_open(&scene, path, NULL, NULL), -1);
    if (!strstr(scene.message, word)) fail_msg("\"%s\" is not in: %s", word, scene.message);
    scene_close(&scene);
}

static void test_wrong_contents(void **state)
{
    (void)state;
    rig r;
    open_rig(&r, 0);
    scene_settings settings = scene_settings_default();
    dmb_output output = r.outputs[0];
    output.place.part.index += 7;
    settings.outputs = &output;
    settings.output_count = 1;
    refused(&r, &settings, "which its scene does not have");
    settings.output_count = 0;
    settings.step = -1.0;
    refused(&r, &settings, "step = -1 s");
    settings.step = 0.0;
    settings.compile.pipe_kind = 77;
    refused(&r, &settings, "pipe_kind");
    settings = scene_settings_default();
    assert_int_equal(scene_write("/nowhere/scene.bin", TOKEN, r.model, &settings), -1);
    close_rig(&r);
}

/* ---- Damage ------------------------------------------------------------------------------------------------------ */
static void write_bytes(const char *path, const unsigned char *bytes, size_t size)
{
    remove(path); /* a file that is written over is flushed to the disk */
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static int opens(const char *path, const unsigned char *bytes, size_t size)
{
    scene_file scene;
    write_bytes(path, bytes, size);
    const int status = scene_open(&scene, path, NULL, NULL);
    if (status != 0) assert_true(scene.message[0] != 0);
    scene_close(&scene);
    return status == 0;
}

/* The header agrees with what follows it: only the contents are wrong. */
static void sign(unsigned char *bytes, size_t size)
{
    const uint32_t sum = scene_checksum(bytes + SCENE_HEADER, size - SCENE_HEADER);
    for (int i = 0; i < 8; ++i) bytes[16 + i] = (unsigned char)((uint64_t)size >> 8 * i);
    for (int i = 0; i < 4; ++i) bytes[SCENE_CHECKSUM_AT + i] = (unsigned char)(sum >> 8 * i);
}

/* A file that ends anywhere or has one wrong byte is refused; so is one that ends anywhere or has another word
 * anywhere, with the checksum of that: it is refused, or read as the other scene that it describes. */
static void test_damage_at_every_byte(void **state)
{
    (void)state;
    enum { ROOM = 1 << 16 };
    static unsigned char bytes[ROOM], damaged[ROOM];
    rig r;
    char path[128], other[140];
    scene_settings settings = scene_settings_default();
    open_rig(&r, 0);
    settings.outputs = r.outputs;
    settings.output_count = OUTPUTS;
    snprintf(path, sizeof path, "%s/scene.bin", r.folder);
    snprintf(other, sizeof other, "%s.damaged", path);
    assert_int_equal(scene_write(path, TOKEN, r.model, &settings), 0);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t size = fread(bytes, 1, ROOM, file);
    fclose(file);
    assert_true(size < ROOM && opens(other, bytes, size));
    for (size_t at = 0; at < size; ++at) {
        memcpy(damaged, bytes, size);
        assert_false(opens(other, damaged, at));
        if (at > SCENE_HEADER) sign(damaged, at);
        assert_false(opens(other, damaged, at));
        memcpy(damaged, bytes, size);
        damaged[at] ^= 0x40;
        assert_false(opens(other, damaged, size));
        if (at < SCENE_HEADER + SCENE_TOKEN || at + 4 > size) continue;
        memset(damaged + at, 0xff, 4); /* a count of 4294967295 */
        sign(damaged, size);
        (void)opens(other, damaged, size);
    }
    remove(other);
    close_rig(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_settings_come_back), cmocka_unit_test(test_wrong_contents),
                                       cmocka_unit_test(test_damage_at_every_byte)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
