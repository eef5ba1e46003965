/* main_options.h: what follows a command on the command line, and the help on it. Tested by
 * tests/app/test_command.sh. */
#ifndef MAIN_OPTIONS_H
#define MAIN_OPTIONS_H

#include <stdio.h>

#include "base/status.h"

/* Options without a letter of their own. */
enum option_code {
    OPTION_SET = 256,
    OPTION_THREADS,
    OPTION_FORCE,
    OPTION_JSON,
    OPTION_SCHEMA,
    OPTION_OUTPUT,
    OPTION_CASE,
    OPTION_MEMBERS,
    OPTION_METHODS,
    OPTION_RTOL,
    OPTION_STEPS,
    OPTION_REPEATS,
    OPTION_REFERENCE,
    OPTION_LIMIT,
    OPTION_SLURM,
    OPTION_BUNDLE,
    OPTION_STRICT,
    OPTION_AT,
    OPTION_GRID,
    OPTION_BOX,
    OPTION_VTK,
    OPTION_END,
    OPTION_FROM,
    OPTION_CHECKPOINT_AT,
    OPTION_MAX_WALL,
    OPTION_OF,
    OPTION_WITHIN,
    OPTION_PLAN,
    OPTION_NO_CONFIRM
};

/* What the command line says. A string is NULL where its option is not given. */
struct request {
    const char *command_line;
    const char *output;
    int quiet, verbose, force, json, schema, of_output, case_only;
    int n_assignments;
    const char **assignments; /* of --set, "KEY=VALUE" */
    char threads[64];         /* --threads as an assignment */
    char end[64];             /* --end as one */
    const char *checkpoint_at, *max_wall;
    const char *processes, *members;
    const char *methods, *rtols, *steps, *repeats, *reference_rtol, *limit, *bundle;
    int slurm, strict;
    int n_of;
    const char **of; /* of --of, names of quantities */
    const char *within;
    int plan, no_confirm;
    const char *from;
    const char *at, *grid, *box;
    const char *vtk;
    const char *positional;
};

/* One command: its name, what follows it, one sentence, the codes of its options, what --output means to it, and the
 * function that does it. */
struct command {
    const char *name, *positional, *summary;
    int options[20]; /* 0 at the end */
    const char *output;
    enum status (*run)(const struct request *request);
};

/* Read the options of a command, argv[0] being its name, into *request, whose assignments and of have room for argc
 * strings. Returns -1 once the help of the command has been printed; else 0, and *status is STATUS_CASE where they are
 * wrong. */
int main_parse(const struct command *command, int argc, char **argv, struct request *request, enum status *status);

/* Print a command as an object of JSON: name, positional, summary, and its options with letter, name, argument and
 * meaning. */
void main_describe(const struct command *command, FILE *stream);

/* Fail with STATUS_CASE: the problem (a printf format with one %s for the word) and where the help is; command may be
 * NULL. */
enum status main_usage(const struct command *command, const char *format, const char *word);

#endif
