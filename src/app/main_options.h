/* main_options.h: the arguments and options of the commands, and their help texts. Tested by
 * tests/app/test_command.sh. */
#ifndef MAIN_OPTIONS_H
#define MAIN_OPTIONS_H

#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"

/* Options without a letter. */
enum option_code {
    OPTION_SET = 256,
    OPTION_THREADS,
    OPTION_FORCE,
    OPTION_JSON,
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
    OPTION_THRESHOLD,
    OPTION_CHECKPOINT_AT,
    OPTION_MAX_WALL,
    OPTION_TRACE,
    OPTION_OF,
    OPTION_WITHIN,
    OPTION_AGAINST,
    OPTION_SWEEP,
    OPTION_PLAN,
    OPTION_NO_CONFIRM,
    OPTION_MODELS,
    OPTION_SENSITIVITY,
    OPTION_UNCERTAIN,
    OPTION_CONTINUE
};

/* The parsed command line. A string is NULL if the option is absent. */
struct request {
    struct arena *arena; /* of the command */
    const char *command_line;
    const char *output;
    int quiet, verbose, force, json, of_output, case_only;
    int n_assignments;
    const char **assignments; /* of --set, "KEY=VALUE" */
    char threads[64];         /* --threads as an assignment */
    char end[64];             /* --end as an assignment */
    const char *checkpoint_at, *max_wall, *trace;
    const char *processes, *members;
    const char *methods, *rtols, *steps, *repeats, *reference_rtol, *limit, *bundle;
    int slurm, strict;
    int n_sweeps;
    const char **sweeps; /* of --sweep, "KEY=LIST" */
    int n_of;
    const char **of; /* of --of, names of quantities */
    const char *within;
    const char *against;
    int plan, no_confirm, models;
    const char *sensitivity; /* "": all */
    int n_uncertain;
    const char **uncertain; /* of --uncertain, "KEY=PART" */
    const char *from;
    const char *threshold, *follow; /* of --threshold and --continue, "KEY=FROM:TO" */
    const char *at, *grid, *box;
    const char *vtk;
    const char *positional;
};

/* One command: name, positional argument (NULL: none; "[WORD]": optional), summary, codes of the options, meaning of
 * --output, and the function that runs the command. */
struct command {
    const char *name, *positional, *summary;
    int options[24]; /* 0 at the end */
    const char *output;
    enum status (*run)(const struct request *request);
};

/* Parse the options of a command into *request; argv[0] is the name of the command, and assignments and of have room
 * for argc strings. Returns -1 after printing the help of the command, else 0; *status is STATUS_CASE for wrong
 * options. */
int main_parse(const struct command *command, int argc, char **argv, struct request *request, enum status *status);

/* Print usage and options of a command. */
void main_print_help(const struct command *command, FILE *stream);

/* Print a command as a JSON object: name, positional, summary, and options with letter, name, argument and meaning. */
void main_describe(const struct command *command, FILE *stream);

#endif
