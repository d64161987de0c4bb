/* Prints the hashes of the reference rig at rest and after 50 steps, for test_scene.py:
 * examples/scenes/reference_rig.toml is the same scene. */
#include "scene.h"

#include <inttypes.h>
#include <stdio.h>

static int32_t print_hash(const dmb_sim *sim)
{
    uint64_t hash = 0;
    const int32_t status = dmb_sim_hash(sim, &hash);
    printf("%016" PRIx64 "\n", hash);
    return status;
}

int main(void)
{
    const rig_variant variant = {DMB_PIPE_FLEXIBLE, RIG_VIBRATION};
    rig_options options = {.pipes = 100, .elements = 1, .seed = 1, .length = 1.0, .cycle = rig_cycle_full()};
    rig_scene scene;
    dmb_sim *sim = NULL;
    int32_t status = rig_scene_make(&options, &variant, &scene);
    if (status >= 0) status = dmb_sim_create(scene.model, NULL, &sim);
    if (status >= 0) status = dmb_analysis_static(sim, NULL, NULL);
    if (status >= 0) status = print_hash(sim);
    for (int k = 0; k < 50 && status >= 0; ++k) status = dmb_sim_step(sim, 1e-3, NULL);
    if (status >= 0) status = print_hash(sim);
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&scene.model);
    return status < 0;
}
