#include "options.h"

#include <argp.h>
#include <stdlib.h>

enum { MOST_THREADS = 64, KEY_THREADS = 256, KEY_SHORT, KEY_STEP };

static const struct argp_option table[] = {
    {"output", 'o', "FOLDER", 0, "folder for tables; plot.py FOLDER makes pictures of them", 0},
    {"threads", KEY_THREADS, "N", 0, "scenes at a time (2), which changes no digit", 0},
    {"step", KEY_STEP, "S", 0, "time step of the drilling cycle (1e-3)", 0},
    {"short", KEY_SHORT, 0, 0, "only the claims, and without the drilling cycles in time", 0},
    {0, 0, 0, 0, 0, 0}};

static int whole_number(const struct argp_state *state, const char *word, long low, long high)
{
    char *rest = NULL;
    const long value = strtol(word, &rest, 10);
    if (rest == word || *rest != '\0' || value < low || value > high)
        argp_error(state, "'%s' is not a whole number from %ld to %ld", word, low, high);
    return (int)value;
}

static double number(const struct argp_state *state, const char *word, double low, double high)
{
    char *rest = NULL;
    const double value = strtod(word, &rest);
    if (rest == word || *rest != '\0' || !(value >= low && value <= high))
        argp_error(state, "'%s' is not a number from %g to %g", word, low, high);
    return value;
}

static error_t take_option(int key, char *word, struct argp_state *state)
{
    study_options *options = state->input;
    switch (key) {
    case 'o': options->output = word; return 0;
    case KEY_THREADS: options->threads = whole_number(state, word, 1, MOST_THREADS); return 0;
    case KEY_STEP: options->step = number(state, word, 1e-5, 1e-2); return 0;
    case KEY_SHORT: options->brief = 1; return 0;
    case ARGP_KEY_ARG: argp_error(state, "'%s' is not an option", word); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

study_options study_options_read(int count, char **words)
{
    static const char about[] =
        "Makes what the reference reports: modes, frequency responses and how they depend on which parameter, and the "
        "drilling cycle in time; and says claim by claim what the reference says, what comes out here, and whether "
        "the two agree.";
    const struct argp parser = {table, take_option, NULL, about, NULL, NULL, NULL};
    study_options options = {.step = 1e-3, .threads = 2};
    argp_parse(&parser, count, words, 0, NULL, &options);
    return options;
}
