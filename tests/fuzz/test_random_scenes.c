/* Random scenes through the public interface: whatever is described and asked, nothing crashes, every status is a known
 * one, the answers after an accepted step are finite, and a call that fails leaves the hash.
 *
 * As a test it runs a fixed number of seeded inputs, fewer under a sanitizer; a number as argument runs that one alone,
 * two as many from the first on. As a fuzz target
 * (fuzz/run) it takes its bytes from libFuzzer. */
#include <float.h>

#include "../contract/sanitized.h"
#include "hash.h"
#include "random_actions.h"

#if defined(DMB_FUZZER)
enum { ACTIONS_MAX = 6, STEPS_MAX = 2, STATIC_ITERATIONS = 8, STATIC_EVALUATIONS = 200 };
#else
enum { ACTIONS_MAX = 24, STEPS_MAX = 12, STATIC_ITERATIONS = 60, STATIC_EVALUATIONS = 1000000 };
#endif

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* ---- Judging ----------------------------------------------------------------------------------------------------- */

static struct {
    uint64_t steps, failed, compiled, refused, statics;
} tally;

/* ---- Questions --------------------------------------------------------------------------------------------------- */

static void ask_place(const dmb_sim *sim, dmb_place place)
{
    dmb_pose pose = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    dmb_section section = dmb_section_default();
    double angle = 0.0;
    MUST(dmb_query_pose(sim, place, &pose) == DMB_OK);
    MUST(dmb_query_motion(sim, place, &motion) == DMB_OK);
    MUST(dmb_query_rotation(sim, place, &angle) == DMB_OK);
    must_be_finite(pose.position, 16);
    must_be_finite(motion.velocity, 12);
    must_be_finite(&angle, 1);
    const int32_t status = dmb_query_section(sim, place, &section);
    MUST(status == DMB_OK || status == DMB_ERR_UNSUPPORTED);
    must_be_finite(section.force, 12);
}

static void ask_parts(const dmb_sim *sim, random_scene *scene)
{
    for (uint32_t i = 0; i < scene->strings; i++) {
        for (uint32_t pipe = 0; pipe < scene->pipes_of[i]; pipe++)
            ask_place(sim, dmb_station(scene->string[i], pipe, draw_number(&scene->source, 0.0, 1.0)));
    }
    for (uint32_t i = 0; i < scene->bodies; i++) ask_place(sim, dmb_station(scene->body[i], 0, 0.0));
    for (uint32_t i = 0; i < scene->drives; i++) {
        dmb_drive_state drive = dmb_drive_state_default();
        MUST(dmb_query_drive(sim, scene->drive[i], &drive) == DMB_OK);
        must_be_finite(&drive.target, 6);
    }
    if (scene->bits) {
        dmb_bit_state bit = dmb_bit_state_default();
        ask_place(sim, dmb_station(scene->bit, 0, 0.0));
        MUST(dmb_query_bit(sim, scene->bit, &bit) == DMB_OK);
        must_be_finite(&bit.advance, 6);
    }
}

static void ask_sums(const dmb_sim *sim)
{
    dmb_energy energy = dmb_energy_default();
    dmb_momentum momentum = dmb_momentum_default();
    dmb_contact_total sum = dmb_contact_total_default();
    dmb_statistics statistics = dmb_statistics_default();
    const int32_t status = dmb_query_energy(sim, &energy);
    MUST(status == DMB_OK || status == DMB_ERR_UNSUPPORTED);
    MUST(dmb_query_momentum(sim, &momentum) == DMB_OK);
    MUST(dmb_query_contact_total(sim, &sum) == DMB_OK);
    MUST(dmb_query_statistics(sim, &statistics) == DMB_OK);
    must_be_finite(&energy.kinetic, 15);
    must_be_finite(momentum.linear, 10);
    must_be_finite(&sum.normal_force, 4);
    must_be_finite(&statistics.largest_residual, 3);
    MUST(sum.normal_force >= 0.0 && sum.deepest >= 0.0);
}

static void ask_contacts(const dmb_sim *sim, const dmb_model *model)
{
    dmb_model_info info = dmb_model_info_default();
    MUST(dmb_model_get_info(model, &info) == DMB_OK);
    for (uint32_t i = 0; i < info.contact_points; i++) {
        dmb_contact contact = dmb_contact_default();
        MUST(dmb_query_contact(sim, i, &contact) == DMB_OK);
        must_be_finite(&contact.length, 11);
        MUST(contact.normal_force >= 0.0);
    }
}

static void ask_all(const dmb_sim *sim, random_scene *scene)
{
    const uint64_t before = hash_of(sim);
    ask_parts(sim, scene);
    ask_sums(sim);
    ask_contacts(sim, scene->model);
    MUST(hash_of(sim) == before);
}

/* ---- Actions ----------------------------------------------------------------------------------------------------- */

static void act_step(dmb_sim *sim, random_scene *scene)
{
    const double h = draw_size(&scene->source, 1e-6, 1e-2);
    const uint32_t count = 1 + draw_below(&scene->source, STEPS_MAX);
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t before = hash_of(sim);
        const double time = dmb_sim_time(sim);
        const int32_t status = dmb_sim_step(sim, h, NULL);
        must_be_known(status);
        /* the clock keeps the rounding of its sums, so a sum may end at the double beside time + h */
        MUST(status < 0 ? dmb_sim_time(sim) == time : fabs(dmb_sim_time(sim) - (time + h)) <= DBL_EPSILON * (time + h));
        MUST(status >= 0 || hash_of(sim) == before);
        MUST(status >= 0 || dmb_sim_message(sim)[0] != '\0');
        tally.steps += status >= 0;
        tally.failed += status < 0;
        if (status < 0) return;
    }
}

static void act_advance(dmb_sim *sim, random_scene *scene)
{
    const double time = dmb_sim_time(sim), end = time + draw_size(&scene->source, 1e-6, 5e-4);
    const int32_t status = dmb_sim_advance(sim, end, NULL);
    must_be_known(status);
    MUST(status < 0 || status == DMB_NOTE_STOPPED || dmb_sim_time(sim) == end);
    MUST(dmb_sim_time(sim) >= time && dmb_sim_time(sim) <= end);
    tally.failed += status < 0;
}

static void act_nonsense(dmb_sim *sim, random_scene *scene)
{
    const uint64_t before = hash_of(sim);
    const double nonsense = draw_nonsense(&scene->source);
    int32_t status = DMB_OK;
    if (!(nonsense > 0.0) || isinf(nonsense)) {
        status = dmb_sim_step(sim, nonsense, NULL);
        MUST(status < 0);
        MUST(dmb_sim_advance(sim, nonsense, NULL) < 0);
    }
    MUST(dmb_sim_restore(sim, scene, sizeof *scene) < 0);
    must_be_known(status);
    MUST(hash_of(sim) == before);
}

static void act_snapshot(dmb_sim *sim, random_scene *scene)
{
    size_t size = 0;
    const uint64_t before = hash_of(sim);
    MUST(dmb_sim_snapshot_size(sim, &size) == DMB_OK);
    unsigned char *snapshot = malloc(size);
    if (snapshot == NULL) return;
    MUST(dmb_sim_snapshot(sim, snapshot, size) == DMB_OK);
    act_step(sim, scene);
    MUST(dmb_sim_restore(sim, snapshot, size) == DMB_OK);
    MUST(hash_of(sim) == before);
    free(snapshot);
}

static void act_set_drive(dmb_sim *sim, random_scene *scene)
{
    const uint64_t before = hash_of(sim);
    double value = draw_number(&scene->source, -10.0, 10.0);
    dmb_id id = {draw_byte(&scene->source) << 24, 1};
    if (draw_chance(&scene->source, 20)) value = draw_nonsense(&scene->source);
    if (scene->drives > 0) id = scene->drive[draw_below(&scene->source, scene->drives)];
    const int32_t status = dmb_sim_set_drive(sim, id, value);
    must_be_known(status);
    MUST(status >= 0 || hash_of(sim) == before);
}

/* Counts down to the end of the call. */
static int32_t count_down(void *context, double fraction)
{
    uint32_t *left = context;
    MUST(fraction >= 0.0 && fraction <= 1.0);
    if (*left > 0) --*left;
    return *left == 0;
}

/* All statics of an input share their evaluations: those that find nothing otherwise take 9/10 of all time. */
static void act_static(dmb_sim *sim, random_scene *scene)
{
    dmb_static_options options = dmb_static_options_default();
    const uint64_t before = hash_of(sim);
    options.lay_on_wall = draw_chance(&scene->source, 128);
    options.slip_axial = draw_chance(&scene->source, 60) ? 0.01 : 0.0;
    options.load_steps = 1 + draw_below(&scene->source, 3);
    options.max_iterations = 1 + draw_below(&scene->source, STATIC_ITERATIONS);
    MUST(dmb_sim_set_progress(sim, count_down, &scene->evaluations) == DMB_OK);
    const int32_t status = dmb_analysis_static(sim, &options, NULL);
    MUST(dmb_sim_set_progress(sim, NULL, NULL) == DMB_OK);
    must_be_known(status);
    MUST(status >= 0 || hash_of(sim) == before);
    tally.statics += status >= 0;
}

static void act_callback(dmb_sim *sim, random_scene *scene)
{
    (void)sim;
    scene->callback_status = draw_chance(&scene->source, 60);
}

static const struct {
    const char *name;
    void (*act)(dmb_sim *sim, random_scene *scene);
} actions[] = {
    {"step", act_step},           {"step", act_step},         {"step", act_step},
    {"advance", act_advance},     {"nonsense", act_nonsense}, {"snapshot", act_snapshot},
    {"set_drive", act_set_drive}, {"static", act_static},     {"callback", act_callback},
};

static void run_sim(dmb_sim *sim, random_scene *scene)
{
    const uint32_t count = 2 + draw_below(&scene->source, ACTIONS_MAX);
    scene->evaluations = STATIC_EVALUATIONS;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t k = draw_below(&scene->source, sizeof actions / sizeof actions[0]);
        present_action = actions[k].name;
        actions[k].act(sim, scene);
        must_be_sound(sim);
        present_action = "questions";
        ask_all(sim, scene);
    }
    act_more(sim, scene);
}

/* ---- One input --------------------------------------------------------------------------------------------------- */

static int32_t compile(random_scene *scene)
{
    dmb_compile_options options = dmb_compile_options_default();
    if (draw_chance(&scene->source, 40)) options.features = (int32_t)draw_byte(&scene->source) & DMB_FEATURE_ALL;
    if (draw_chance(&scene->source, 40)) options.pipe_kind = (int32_t)draw_below(&scene->source, 3);
    (void)dmb_model_clear_refused(scene->model); /* some are on purpose */
    const int32_t status = dmb_model_compile(scene->model, &options);
    must_be_known(status);
    MUST(status >= 0 || dmb_model_message(scene->model)[0] != '\0');
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    random_scene *scene = malloc(sizeof *scene);
    dmb_sim *sim = NULL;
    if (scene == NULL) return 0;
    present_action = "description";
    draw_scene(scene, data, size);
    MUST(scene->model != NULL);
    if (has_more(scene)) draw_more_parts(scene);
    present_action = "compile";
    if (compile(scene) >= 0) {
        scene->options = draw_options(scene);
        present_action = "create";
        const int32_t status = dmb_sim_create(scene->model, &scene->options, &sim);
        must_be_known(status);
        MUST((status >= 0) == (sim != NULL));
        tally.compiled += status >= 0;
        if (status >= 0) run_sim(sim, scene);
    } else {
        tally.refused++;
    }
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&scene->model);
    free(scene);
    return 0;
}

/* ---- As a test --------------------------------------------------------------------------------------------------- */

#if !defined(DMB_FUZZER)
#if defined(SANITIZED)
enum { INPUTS = 100 };
#else
enum { INPUTS = 300 };
#endif
enum { BYTES = 1500 };

/* splitmix64 */
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

static void run_seed(unsigned long long seed)
{
    uint8_t data[BYTES];
    uint64_t state = seed;
    present_seed = seed;
    for (size_t i = 0; i < BYTES; i++) data[i] = (uint8_t)(next_random(&state) >> 32);
    (void)LLVMFuzzerTestOneInput(data, BYTES);
}

int main(int argc, char **argv)
{
    if (argc > 1) {
        const unsigned long long first = strtoull(argv[1], NULL, 10);
        const unsigned long long count = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
        for (unsigned long long i = 0; i < count; i++) run_seed(first + i);
    } else {
        for (unsigned long long seed = 1; seed <= INPUTS; seed++) run_seed(seed);
    }
    printf("%llu scenes run, %llu refused; %llu steps accepted, %llu failed; %llu static starts\n",
           (unsigned long long)tally.compiled, (unsigned long long)tally.refused, (unsigned long long)tally.steps,
           (unsigned long long)tally.failed, (unsigned long long)tally.statics);
    return 0;
}
#endif
