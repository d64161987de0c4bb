#include "scene_format.h"

#include <string.h>

#define TYPE(T, name) _Generic(((T *)0)->name, double : SCENE_REAL, uint32_t : SCENE_COUNT, int32_t : SCENE_WHOLE)
#define OPTION(T, name) {#name, offsetof(T, name), TYPE(T, name)},
static const scene_option compile_options[] = {SCENE_COMPILE_OPTIONS(OPTION)};
static const scene_option sim_options[] = {SCENE_SIM_OPTIONS(OPTION)};
static const scene_option static_options[] = {SCENE_STATIC_OPTIONS(OPTION)};

#define LIST(name, options, member)                                                                      \
    {                                                                                                    \
        name, options, (uint32_t)(sizeof(options) / sizeof *(options)), offsetof(scene_settings, member) \
    }
const scene_options scene_option_lists[SCENE_LISTS] = {
    LIST("compile", compile_options, compile), LIST("sim", sim_options, sim), LIST("static", static_options, statics)};

scene_settings scene_settings_default(void)
{
    scene_settings settings;
    memset(&settings, 0, sizeof settings);
    settings.compile = dmb_compile_options_default();
    settings.sim = dmb_sim_options_default();
    settings.statics = dmb_static_options_default();
    return settings;
}

/* CRC-32 of ISO 3309, bit by bit: x^32 + x^26 + ... + 1, reflected. */
uint32_t scene_checksum(const void *bytes, uint64_t size)
{
    const unsigned char *at = bytes;
    uint32_t rest = 0xFFFFFFFFu;
    for (uint64_t i = 0; i < size; ++i) {
        rest ^= at[i];
        for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ (0xEDB88320u & (0u - (rest & 1u)));
    }
    return ~rest;
}
