#include "options.h"

#include <argp.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Names ------------------------------------------------------------------------------------------------------- */

static const char *const systems[] = {
    [DMB_PIPE_FLEXIBLE] = "flexible", [DMB_PIPE_AXIAL_TORSIONAL] = "axial-torsional", [DMB_PIPE_RIGID] = "rigid"};
static const char *const couples[] = {
    [RIG_NO_COUPLING] = "none", [RIG_CONTACT] = "contact", [RIG_FRICTION] = "friction", [RIG_VIBRATION] = "vibration"};

const char *rig_system_name(const rig_variant *variant)
{
    return systems[variant->pipe_kind];
}

const char *rig_couple_name(const rig_variant *variant)
{
    return couples[variant->couple];
}

/* ---- Words to values --------------------------------------------------------------------------------------------- */

static int32_t one_of(const struct argp_state *state, const char *word, const char *const names[], int32_t count)
{
    for (int32_t i = 0; i < count; ++i) {
        if (strcmp(word, names[i]) == 0) return i;
    }
    argp_error(state, "'%s' is not a choice here, see --help", word);
    return 0;
}

static double number(const struct argp_state *state, const char *word, double low, double high)
{
    char *rest = NULL;
    const double value = strtod(word, &rest);
    if (rest == word || *rest != '\0' || !(value >= low && value <= high))
        argp_error(state, "'%s' is not a number from %g to %g", word, low, high);
    return value;
}

static uint32_t whole_number(const struct argp_state *state, const char *word, double low, double high)
{
    const double value = number(state, word, low, high);
    if (floor(value) < value) argp_error(state, "'%s' is not a whole number", word);
    return (uint32_t)value;
}

/* ---- Options ----------------------------------------------------------------------------------------------------- */

enum {
    KEY_LENGTH = 256,
    KEY_PIPES,
    KEY_BIT,
    KEY_ELEMENTS,
    KEY_STEP,
    KEY_TIME,
    KEY_RATE,
    KEY_SEED,
    KEY_QUICK,
    KEY_ALL,
    KEY_DROP
};

static const struct argp_option table[] = {
    {0, 0, 0, 0, "What is modelled:", 1},
    {"system", 's', "KIND", 0, "pipes are flexible (default), rigid or axial-torsional", 1},
    {"couple", 'c', "KIND", 0,
     "contact: the string meets the wall; friction: and rubs on it; vibration (default): and is excited by eccentric "
     "pipes and the drive; none: no wall, no weight and no load on the bit",
     1},
    {"all", KEY_ALL, 0, 0,
     "run the four variants that the pictures show: rigid, and flexible with contact, friction and vibration; so it is "
     "unless --system or --couple say otherwise",
     1},
    {"pipes", KEY_PIPES, "N", 0, "number of pipes (100)", 1},
    {"length", KEY_LENGTH, "METRES", 0, "length of one pipe (1)", 1},
    {"bit", KEY_BIT, "MM", 0,
     "diameter at which the bit meets the wall; 0 (default): the coal breaks out around it and it does not", 1},
    {"seed", KEY_SEED, "N", 0, "of the random angles of the eccentric masses (1)", 1},
    {0, 0, 0, 0, "How it is computed:", 2},
    {"elements", KEY_ELEMENTS, "N", 0, "elements in one pipe (1)", 2},
    {"step", KEY_STEP, "S", 0, "time step (1e-3)", 2},
    {"time", KEY_TIME, "S", 0, "stop at this time (end of the cycle)", 2},
    {"drop", KEY_DROP, 0, 0, "start straight on the axis of the hole instead of at rest on its low side", 2},
    {"quick", KEY_QUICK, 0, 0, "a cycle of 8 s instead of 40 s: same ramps, 2 s of drilling and of pulling out", 2},
    {0, 0, 0, 0, "What is left behind:", 3},
    {"output", 'o', "FOLDER", 0, "folder for tables and ParaView files (./gas_drainage_rig)", 3},
    {"rate", KEY_RATE, "HZ", 0, "samples a second in the tables (1000)", 3},
    {"quiet", 'q', 0, 0, "no progress bar", 3},
    {0, 0, 0, 0, 0, 0}};

static error_t take_computing(rig_options *options, int key, const char *word, const struct argp_state *state)
{
    switch (key) {
    case KEY_ELEMENTS: options->elements = whole_number(state, word, 1, 1024); return 0;
    case KEY_STEP: options->step = number(state, word, 1e-7, 0.1); return 0;
    case KEY_TIME: options->end = number(state, word, 1e-3, 1e4); return 0;
    case KEY_RATE: options->rate = number(state, word, 1.0, 1e5); return 0;
    case KEY_DROP: options->dropped = 1; return 0;
    case KEY_QUICK: options->cycle = rig_cycle_quick(); return 0;
    case 'o': options->output = word; return 0;
    case 'q': options->quiet = 1; return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static error_t take_option(int key, char *word, struct argp_state *state)
{
    rig_options *options = state->input;
    switch (key) {
    case 's':
        options->variant.pipe_kind = one_of(state, word, systems, 3);
        options->all = 0;
        return 0;
    case 'c':
        options->variant.couple = one_of(state, word, couples, 4);
        options->all = 0;
        return 0;
    case KEY_ALL: options->all = 1; return 0;
    case KEY_PIPES: options->pipes = whole_number(state, word, 1, 1e6); return 0;
    case KEY_LENGTH: options->length = number(state, word, 0.05, 100.0); return 0;
    case KEY_BIT: options->bit = 1e-3 * number(state, word, 0.0, 94.0); return 0;
    case KEY_SEED: options->seed = whole_number(state, word, 0, 4294967295.0); return 0;
    case ARGP_KEY_ARG: argp_error(state, "'%s' is not an option", word); return 0;
    default: return take_computing(options, key, word, state);
    }
}

rig_options rig_options_default(void)
{
    const rig_options options = {.variant = {DMB_PIPE_FLEXIBLE, RIG_VIBRATION},
                                 .all = 1,
                                 .pipes = 100,
                                 .elements = 1,
                                 .seed = 1,
                                 .length = 1.0,
                                 .bit = 0.0,
                                 .step = 1e-3,
                                 .end = 40.0,
                                 .rate = 1000.0,
                                 .cycle = rig_cycle_full()};
    return options;
}

rig_options rig_options_read(int count, char **words)
{
    static const char about[] = "Drills 100 m into a coal seam and pulls the string out again: a rig head, flexible "
                                "pipes, a bit and the wall of "
                                "the hole, over the 40 s cycle start - drill - stop - rest - reverse start - pull out.";
    const struct argp parser = {table, take_option, NULL, about, NULL, NULL, NULL};
    rig_options options = rig_options_default();
    options.end = 0.0;
    options.output = "gas_drainage_rig";
    argp_parse(&parser, count, words, 0, NULL, &options);
    if (!(options.end > 0.0)) options.end = options.cycle.time[RIG_STAGES];
    return options;
}
