/* Random scenes with joints, couplings and constraints of the caller's, small ones, through every analysis, state
 * transfer and switching of joints: nothing crashes, every status is a known one, an analysis that leaves the sim alone
 * leaves its hash, and a call that fails does too (a stepped sine, which runs on, excepted). Springs, stuck places,
 * flow, inputs and events too.
 *
 * As a test it runs a fixed number of seeded inputs; arguments are the first seed and how many. As a fuzz target
 * (fuzz/run) it takes its bytes from libFuzzer. */
#include "hash.h"
#include "random_actions.h"
#include "random_linear.h"

#if defined(DMB_FUZZER)
enum { JOINTS = 2, ACTIONS_MAX = 2, ITERATIONS = 6, PULSES = 300 };
#else
enum { INPUTS = 60, BYTES = 1200, JOINTS = 4, ACTIONS_MAX = 8, ITERATIONS = 30, PULSES = 0 };
#endif

typedef struct scene {
    random_scene parts; /* first: callbacks of time functions look at it */
    dmb_id joint[JOINTS];
    uint32_t joints, constraints, couplings;
} scene;

static unsigned long long tally[2]; /* analyses done, refused or failed */

static void must_be_told(int32_t status)
{
    must_be_known(status);
    tally[status < 0]++;
}

/* ---- Joints and constraints -------------------------------------------------------------------------------------- */

static void draw_joint(scene *c)
{
    byte_source *s = &c->parts.source;
    dmb_joint_def def = dmb_joint_def_default();
    def.kind = (int32_t)draw_below(s, has_more(&c->parts) ? 16 : 13);
    def.place_b = draw_place(&c->parts);
    if (draw_chance(s, 128)) def.place_a = draw_place(&c->parts);
    def.match = draw_chance(s, 220);
    def.axis_a[draw_below(s, 3)] = draw_number(s, -1.0, 1.0);
    def.length = draw_size(s, 0.1, 10.0);
    def.state = draw_chance(s, 60) ? (int32_t)draw_below(s, 3) : DMB_JOINT_ACTIVE;
    if (draw_chance(s, 128)) {
        const uint32_t k = draw_below(s, 6);
        def.stiffness[k] = draw_size(s, 1.0, 1e7);
        def.damping[k] = draw_size(s, 1e-2, 1e3);
        def.friction[draw_below(s, 6)] = draw_size(s, 1e-2, 10.0);
        def.stop_low[k] = -draw_size(s, 1e-4, 1.0);
        def.stop_high[k] = draw_size(s, 1e-4, 1.0);
    }
    draw_spoil(s, def.stiffness, 18);
    if (has_more(&c->parts)) draw_more_joint(s, &def);
    dmb_id *id = &c->joint[c->joints];
    c->joints += keep_id(&c->parts, dmb_model_add_joint(c->parts.model, &def, id), *id);
}

static void draw_coupling(scene *c)
{
    byte_source *s = &c->parts.source;
    dmb_coupling_def def = dmb_coupling_def_default();
    dmb_id id = {0, 0};
    def.joint[0] = c->joint[0];
    def.joint[1] = c->joint[1];
    def.component[0] = (int32_t)draw_below(s, 6);
    def.component[1] = (int32_t)draw_below(s, 6);
    def.ratio = draw_number(s, -3.0, 3.0);
    if (has_more(&c->parts) && draw_chance(s, 80)) {
        def.third_joint = c->joint[draw_below(s, 2)];
        def.third_component = (int32_t)draw_below(s, 6);
    }
    const int32_t status = dmb_model_add_coupling(c->parts.model, &def, &id);
    c->couplings += keep_id(&c->parts, status, id);
}

static void draw_joint_drive(scene *c)
{
    byte_source *s = &c->parts.source;
    dmb_drive_def drive = dmb_drive_def_default();
    if (c->joints == 0 || c->parts.drives > DRAW_DRIVES) return;
    drive.kind = (int32_t)draw_below(s, 3);
    drive.part = c->joint[0];
    drive.component = (int32_t)draw_below(s, 6);
    drive.time_function = draw_time_function(&c->parts);
    drive.gain = draw_number(s, 0.0, 1e4);
    draw_more_drive(s, &drive);
    dmb_id *id = &c->parts.drive[c->parts.drives];
    c->parts.drives += keep_id(&c->parts, dmb_model_add_drive(c->parts.model, &drive, id), *id);
}

static int32_t level(void *context, double time, uint32_t count, const double (*poses)[12], double *value,
                     double *jacobian)
{
    const scene *c = context;
    (void)time, (void)count, (void)jacobian;
    value[0] = poses[0][2];
    return c->parts.callback_status;
}

static void draw_links(scene *c)
{
    byte_source *s = &c->parts.source;
    dmb_body_def body = dmb_body_def_default();
    for (uint32_t i = 0; i < 2 && c->parts.bodies < DRAW_BODIES; i++) {
        body.position[0] = draw_number(s, 0.0, 10.0);
        body.position[1] = draw_number(s, 1.0, 3.0);
        dmb_id *id = &c->parts.body[c->parts.bodies];
        c->parts.bodies += keep_id(&c->parts, dmb_model_add_body(c->parts.model, &body, id), *id);
    }
    for (uint32_t i = 1 + draw_below(s, JOINTS - 1); i > 0; i--) draw_joint(c);
    if (has_more(&c->parts) && c->joints < JOINTS) draw_joint(c);
    if (c->joints >= 2 && draw_chance(s, 80)) draw_coupling(c);
    if (draw_chance(s, 60)) {
        dmb_constraint_def def = dmb_constraint_def_default();
        def.place[0] = draw_place(&c->parts);
        def.callback = level;
        def.callback_context = c;
        dmb_id id = {0, 0};
        const int32_t status = dmb_model_add_constraint(c->parts.model, &def, &id);
        c->constraints += keep_id(&c->parts, status, id);
    }
    if (has_more(&c->parts) && draw_chance(s, 80)) draw_joint_drive(c);
}

/* ---- Actions ----------------------------------------------------------------------------------------------------- */

static void act_step(dmb_sim *sim, scene *c)
{
    const double h = draw_size(&c->parts.source, 1e-5, 2e-3);
    for (uint32_t i = 1 + draw_below(&c->parts.source, 5); i > 0; i--) {
        const uint64_t before = hash_of(sim);
        const int32_t status = dmb_sim_step(sim, h, NULL);
        must_be_told(status);
        MUST(status >= 0 || hash_of(sim) == before);
    }
}

static void act_static(dmb_sim *sim, scene *c)
{
    dmb_static_options options = dmb_static_options_default();
    const uint64_t before = hash_of(sim);
    options.max_iterations = 5 + draw_below(&c->parts.source, ITERATIONS);
    const int32_t status = dmb_analysis_static(sim, &options, NULL);
    must_be_told(status);
    MUST(status >= 0 || hash_of(sim) == before);
}

static void act_switch(dmb_sim *sim, scene *c)
{
    const uint64_t before = hash_of(sim);
    const uint32_t which = draw_below(&c->parts.source, JOINTS);
    const int32_t state = (int32_t)draw_below(&c->parts.source, 4); /* one too many */
    const int32_t status = dmb_sim_set_joint(sim, c->joint[which], state);
    must_be_told(status);
    MUST(status >= 0 || hash_of(sim) == before);
}

static void act_modes(dmb_sim *sim, scene *c)
{
    byte_source *s = &c->parts.source;
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    const uint64_t before = hash_of(sim);
    options.kind = (int32_t)draw_below(s, 2);
    options.select = (int32_t)draw_below(s, 3);
    options.count = 1 + draw_below(s, 4);
    options.contact = (int32_t)draw_below(s, 3);
    options.equilibrium_tolerance = draw_chance(s, 200) ? 1.0 : 1e-6;
    const int32_t status = dmb_analysis_modes(sim, &options, &modes);
    must_be_told(status);
    MUST((status >= 0) == (modes != NULL));
    for (uint32_t i = 0; i < 3 && modes != NULL; i++) {
        dmb_mode mode = dmb_mode_default();
        dmb_mode_shape shape = dmb_mode_shape_default();
        (void)dmb_modes_get(modes, i, &mode);
        (void)dmb_modes_shape(modes, i, draw_place(&c->parts), &shape);
    }
    dmb_modes_destroy(&modes);
    MUST(hash_of(sim) == before);
}

static dmb_output draw_response_output(scene *c)
{
    dmb_output output = {.quantity = DMB_OUTPUT_VIBRATION};
    const int32_t of_joint = (int32_t)draw_below(&c->parts.source, 2);
    output.quantity = of_joint ? DMB_OUTPUT_JOINT_POSITION : DMB_OUTPUT_VIBRATION;
    output.quantity += 10 * (int32_t)draw_below(&c->parts.source, 6) + (int32_t)draw_below(&c->parts.source, 6);
    output.place = draw_place(&c->parts);
    if (of_joint) output.place.part = c->joint[0];
    return output;
}

static dmb_excitation draw_input(scene *c)
{
    dmb_excitation input = dmb_excitation_default();
    input.kind = (int32_t)draw_below(&c->parts.source, 7);
    input.place = draw_place(&c->parts);
    input.component = (int32_t)draw_below(&c->parts.source, 6);
    if (input.kind == DMB_EXCITATION_DRIVE && c->parts.drives > 0) input.place.part = c->parts.drive[0];
    return input;
}

static void act_response(dmb_sim *sim, scene *c)
{
    dmb_response_options options = dmb_response_options_default();
    const dmb_excitation inputs[2] = {draw_input(c), draw_input(c)};
    const dmb_output outputs[2] = {draw_response_output(c), draw_response_output(c)};
    dmb_response *response = NULL;
    const uint64_t before = hash_of(sim);
    options.points = 3;
    options.refinement = draw_below(&c->parts.source, 3);
    options.contact = (int32_t)draw_below(&c->parts.source, 3);
    options.equilibrium_tolerance = draw_chance(&c->parts.source, 200) ? 1.0 : 1e-6;
    const int32_t status = dmb_analysis_response(sim, &options, inputs, 1 + draw_below(&c->parts.source, 2), outputs,
                                                 1 + draw_below(&c->parts.source, 2), &response);
    must_be_told(status);
    MUST((status >= 0) == (response != NULL));
    if (response != NULL) MUST(dmb_response_write_csv(response, NULL, "/dev/null") == DMB_OK);
    dmb_response_destroy(&response);
    MUST(hash_of(sim) == before);
}

static void act_speeds(dmb_sim *sim, scene *c)
{
    dmb_speeds_options options = dmb_speeds_options_default();
    dmb_order order = dmb_order_default();
    const dmb_output output = draw_response_output(c);
    const double limit = 1e-4;
    dmb_speed_band bands[2] = {dmb_speed_band_default(), dmb_speed_band_default()};
    uint32_t count = 2;
    const uint64_t before = hash_of(sim);
    options.points = 4;
    options.refinement = 1;
    options.equilibrium_tolerance = 1.0;
    if (draw_chance(&c->parts.source, 128)) order.excitation = draw_input(c);
    must_be_told(dmb_analysis_speeds(sim, &options, &order, 1, &output, &limit, 1, bands, &count, NULL));
    MUST(hash_of(sim) == before);
}

static void act_sine(dmb_sim *sim, scene *c)
{
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    const dmb_output output = draw_response_output(c);
    double amplitudes[4];
    options.steps_per_period = 16;
    options.periods = options.harmonics = 1;
    options.windows = 3;
    must_be_told(
        dmb_analysis_stepped_sine(sim, draw_size(&c->parts.source, 10.0, 1e4), &options, &output, 1, amplitudes, NULL));
}

static void act_buckling(dmb_sim *sim, scene *c)
{
    dmb_buckling_options options = dmb_buckling_options_default();
    dmb_buckling *buckling = NULL;
    double factor, shape[6];
    const uint64_t before = hash_of(sim);
    options.scale = (int32_t)draw_below(&c->parts.source, 2);
    const int32_t status = dmb_analysis_buckling(sim, &options, &buckling);
    must_be_told(status);
    if (status >= 0) (void)dmb_buckling_factor(buckling, 0, &factor);
    if (status >= 0) (void)dmb_buckling_shape(buckling, 0, draw_place(&c->parts), shape);
    dmb_buckling_destroy(&buckling);
    MUST(hash_of(sim) == before);
}

static int32_t count_points(void *context, const dmb_sim *at, const dmb_path_point *point)
{
    (void)point;
    MUST(hash_of(at) != 0);
    return ++*(int *)context > 5;
}

static void act_path(dmb_sim *sim, scene *c)
{
    dmb_path_options options = dmb_path_options_default();
    int points = 0;
    const uint64_t before = hash_of(sim);
    options.scale = (int32_t)draw_below(&c->parts.source, 2);
    options.max_points = 3;
    options.max_iterations = 8;
    options.callback = count_points;
    options.callback_context = &points;
    must_be_told(dmb_analysis_path(sim, &options, NULL));
    MUST(hash_of(sim) == before);
}

/* Into a new sim of the same model, which is a model of the same parts. */
static void act_transfer(dmb_sim *sim, scene *c)
{
    dmb_sim *other = NULL;
    const uint64_t before = hash_of(sim);
    if (dmb_sim_create(c->parts.model, NULL, &other) < 0) return;
    const uint64_t fresh = hash_of(other);
    const int32_t status = dmb_sim_transfer_state(other, sim);
    must_be_told(status);
    MUST(status >= 0 || hash_of(other) == fresh);
    if (status >= 0) must_be_told(dmb_sim_step(other, 1e-4, NULL));
    dmb_sim_destroy(&other);
    MUST(hash_of(sim) == before);
}

static void act_check(dmb_sim *sim, scene *c)
{
    dmb_check_report report = dmb_check_report_default();
    char text[256];
    const uint64_t before = hash_of(sim);
    (void)c;
    must_be_told(dmb_analysis_check(sim, &report));
    must_be_told(dmb_analysis_check_text(sim, text, sizeof text, NULL));
    MUST(hash_of(sim) == before);
}

static void act_input(dmb_sim *sim, scene *c)
{
    byte_source *s = &c->parts.source;
    const uint64_t before = hash_of(sim);
    const uint32_t which = draw_below(s, 3);
    const double value = draw_chance(s, 20) ? draw_nonsense(s) : draw_number(s, -2.0, 2.0) * draw_size(s, 1e-2, 1e3);
    const int32_t status = dmb_sim_set_input(sim, c->parts.input[which], value);
    must_be_told(status);
    MUST(status >= 0 || hash_of(sim) == before);
    act_step(sim, c);
}

static void act_wait(dmb_sim *sim, scene *c)
{
    const double end = dmb_sim_time(sim) + draw_size(&c->parts.source, 1e-5, 1e-3);
    must_be_told(dmb_sim_advance_to_event(sim, end, NULL, NULL));
    MUST(dmb_sim_time(sim) <= end);
}

static const struct {
    const char *name;
    void (*act)(dmb_sim *sim, scene *c);
} actions[] = {
    {"step", act_step},         {"static", act_static},     {"set_joint", act_switch}, {"modes", act_modes},
    {"response", act_response}, {"speeds", act_speeds},     {"sine", act_sine},        {"buckling", act_buckling},
    {"path", act_path},         {"transfer", act_transfer}, {"check", act_check},      {"input", act_input},
    {"event", act_wait},
};

/* ---- One input --------------------------------------------------------------------------------------------------- */

/* Counts down to the end of the call, of 0 never: statics that find nothing would take seconds. */
static int32_t count_down(void *context, double fraction)
{
    uint32_t *left = context;
    MUST(fraction >= 0.0 && fraction <= 1.0);
    return *left > 0 && --*left == 0;
}

static void run_sim(dmb_sim *sim, scene *c)
{
    for (uint32_t i = 0; i < ACTIONS_MAX; i++) {
        const uint32_t k = draw_below(&c->parts.source, sizeof actions / sizeof actions[0]);
        uint32_t left = draw_chance(&c->parts.source, 40) ? 1 + draw_below(&c->parts.source, 100) : PULSES;
        present_action = actions[k].name;
        MUST(dmb_sim_set_progress(sim, left > 0 ? count_down : NULL, &left) == DMB_OK);
        actions[k].act(sim, c);
        must_be_sound(sim);
        MUST(dmb_sim_set_progress(sim, NULL, NULL) == DMB_OK);
        c->parts.callback_status = draw_chance(&c->parts.source, 10);
    }
    uint32_t rest = PULSES;
    MUST(dmb_sim_set_progress(sim, rest > 0 ? count_down : NULL, &rest) == DMB_OK);
    analyse_more(sim, &c->parts);
    must_be_sound(sim);
    MUST(dmb_sim_set_progress(sim, NULL, NULL) == DMB_OK);
    act_more(sim, &c->parts);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    scene *c = calloc(1, sizeof *c);
    dmb_sim *sim = NULL;
    if (c == NULL) return 0;
    present_action = "description";
    draw_scene(&c->parts, data, size);
    MUST(c->parts.model != NULL);
    draw_links(c);
    if (has_more(&c->parts))
        draw_more_parts(&c->parts);
    else
        draw_rest(&c->parts);
    present_action = "compile";
    (void)dmb_model_clear_refused(c->parts.model); /* some are on purpose */
    if (dmb_model_compile(c->parts.model, NULL) >= 0) {
        c->parts.options = draw_options(&c->parts);
        present_action = "create";
        must_be_told(dmb_sim_create(c->parts.model, &c->parts.options, &sim));
        if (sim != NULL) run_sim(sim, c);
    }
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&c->parts.model);
    free(c);
    return 0;
}

#if !defined(DMB_FUZZER)
/* splitmix64 */
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

int main(int argc, char **argv)
{
    const unsigned long long first = argc > 1 ? strtoull(argv[1], NULL, 10) : 1;
    const unsigned long long count = argc > 2 ? strtoull(argv[2], NULL, 10) : INPUTS;
    for (unsigned long long i = 0; i < count; i++) {
        uint8_t data[BYTES];
        uint64_t state = present_seed = first + i;
        for (size_t k = 0; k < BYTES; k++) data[k] = (uint8_t)(next_random(&state) >> 32);
        (void)LLVMFuzzerTestOneInput(data, BYTES);
    }
    printf("%llu calls done, %llu refused or failed\n", tally[0], tally[1]);
    return 0;
}
#endif
