/* The command line of the examples: --help, options with their bounds, and what is refused. */
#ifndef EXAMPLE_COMMAND_LINE_H
#define EXAMPLE_COMMAND_LINE_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One option; the pointer that is not NULL takes the value. */
typedef struct command_option {
    const char *name;  /* without --; NULL: `help` is a heading */
    char letter;       /* 0: none */
    const char *value; /* the name of the value and its unit; NULL: a flag */
    const char *help;
    double low, high; /* bounds of a number */
    double *number;
    uint32_t *whole;
    const char **text;
    int32_t *choice; /* the place of the word in `choices`, which ends with NULL */
    const char *const *choices;
    int *given; /* 1 where it was there */
} command_option;

static inline const char *command_name(char **words)
{
    const char *slash = strrchr(words[0], '/');
    return slash == NULL ? words[0] : slash + 1;
}

static inline int command_is_help(const char *word)
{
    return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0 || strcmp(word, "-?") == 0;
}

static inline void command_help_option(const command_option *option)
{
    if (option->name == NULL) {
        printf("\n%s\n", option->help);
        return;
    }
    if (option->letter)
        printf("  -%c, --%s", option->letter, option->name);
    else
        printf("      --%s", option->name);
    printf("%s%s\n          %s", option->value == NULL ? "" : " ", option->value == NULL ? "" : option->value,
           option->help);
    if (option->number != NULL || option->whole != NULL) printf("; from %.10g to %.10g", option->low, option->high);
    for (uint32_t i = 0; option->choice != NULL && option->choices[i] != NULL; i++)
        printf("%s%s", i ? ", " : "; one of ", option->choices[i]);
    printf("\n");
}

static inline int command_help(char **words, const char *about, const command_option *options, uint32_t option_count)
{
    printf("Usage: %s%s\n%s\n", command_name(words), option_count ? " [OPTION...]" : "", about);
    for (uint32_t i = 0; i < option_count; i++) command_help_option(options + i);
    return fflush(stdout) == 0 ? 0 : 1;
}

static inline int command_refused(char **words, const char *what, const char *word, const char *why)
{
    (void)fprintf(stderr, "%s: %s'%s' %s; see --help\n", command_name(words), what, word, why);
    return 0;
}

/* 0: refused, and told why. */
static inline int command_take(char **words, const command_option *option, const char *word)
{
    char *rest = NULL, what[80], why[120];
    const double value = strtod(word, &rest);
    (void)snprintf(what, sizeof what, "--%s ", option->name);
    if (option->text != NULL) return *option->text = word, 1;
    for (int32_t i = 0; option->choice != NULL && option->choices[i] != NULL; i++)
        if (strcmp(word, option->choices[i]) == 0) return *option->choice = i, 1;
    if (option->choice != NULL) return command_refused(words, what, word, "is none of its words");
    (void)snprintf(why, sizeof why, "is not a %snumber from %.10g to %.10g (%s)", option->whole != NULL ? "whole " : "",
                   option->low, option->high, option->value);
    if (rest == word || *rest != '\0' || !(value >= option->low && value <= option->high) ||
        (option->whole != NULL && floor(value) < value))
        return command_refused(words, what, word, why);
    if (option->whole != NULL)
        *option->whole = (uint32_t)value;
    else
        *option->number = value;
    return 1;
}

/* The option that a word names as --name, --name=value or -letter; *value: what follows the =, or NULL. */
static inline const command_option *command_find(const char *word, const command_option *options, uint32_t option_count,
                                                 const char **value)
{
    const size_t length = strcspn(word, "=");
    *value = word[length] == '=' ? word + length + 1 : NULL;
    for (uint32_t i = 0; i < option_count; i++) {
        const command_option *o = options + i;
        if (o->name == NULL) continue;
        if (o->letter && word[0] == '-' && word[1] == o->letter && word[2] == '\0') return o;
        if (strncmp(word, "--", 2) == 0 && strlen(o->name) == length - 2 && strncmp(word + 2, o->name, length - 2) == 0)
            return o;
    }
    return NULL;
}

/* -1: all is read; else the program ends with this status: 0 after --help, 2 where something is refused. */
static inline int command_line(int count, char **words, const char *about, const command_option *options,
                               uint32_t option_count)
{
    for (int i = 1; i < count; i++)
        if (command_is_help(words[i])) return command_help(words, about, options, option_count);
    for (int i = 1; i < count; i++) {
        const char *value;
        const command_option *option = command_find(words[i], options, option_count, &value);
        if (option == NULL)
            return command_refused(words, "", words[i],
                                   option_count ? "is no option" : "is not wanted: it takes no options"),
                   2;
        if (option->given != NULL) *option->given = 1;
        if (option->value == NULL && value == NULL) continue;
        if (option->value == NULL) return command_refused(words, "", words[i], "takes no value"), 2;
        if (value == NULL && ++i == count) return command_refused(words, "", words[i - 1], "needs a value"), 2;
        if (!command_take(words, option, value != NULL ? value : words[i])) return 2;
    }
    return -1;
}

#endif
