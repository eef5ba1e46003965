/* main_options.c: the options of the commands. One table drives parsing, the help texts, and the description from which
 * manual and completion are made. */
#include "app/main_options.h"

#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "study/compare.h"

/* One option: its names, the word for the argument (NULL: none), and the meaning (NULL: struct command has the
 * meaning). */
struct option_help {
    int code;
    const char *name, *argument, *meaning;
};

static const struct option_help all_options[] = {
    {'o', "output", "PATH", NULL},
    {'j', "processes", "N", "number of members that run in parallel (default: available processors / solver.threads)"},
    {OPTION_SLURM, "slurm", NULL, "write the scripts of a Slurm array job into the folder instead of running"},
    {OPTION_BUNDLE, "bundle", "N", "with --slurm: members per task (default: 1; more for over 1000 members)"},
    {OPTION_METHODS, "methods", "LIST", "methods to compare, separated by commas: "},
    {OPTION_RTOL, "rtol", "LIST", "tolerances, separated by commas (default: 1e-3,1e-4,1e-5,1e-6,1e-7)"},
    {OPTION_STEPS, "steps", "LIST",
     "fixed steps in s, separated by commas, for all methods except ida (default: adaptive steps)"},
    {OPTION_REPEATS, "repeats", "N", "runs of each setting; the wall time is their median (default: 3)"},
    {OPTION_REFERENCE, "reference-rtol", "X", "tolerance of the reference solution by ida5 (default: 1e-9)"},
    {OPTION_LIMIT, "limit", "SECONDS", "wall time in seconds after which a run fails (default: none; of compare: 60)"},
    {OPTION_OF, "of", "QUANTITY",
     "estimate the error of this quantity of a result or of a steady state (steady_...); may be repeated"},
    {OPTION_WITHIN, "within", "X", "refine until the relative errors are below X, such as 0.01"},
    {OPTION_AGAINST, "against", "WHAT",
     "also give ratio and difference, with their errors, to another case (alone.yaml), to another fish of the school "
     "(follower=leader), or along --sweep to the `first` or another value"},
    {OPTION_SWEEP, "sweep", "KEY=LIST",
     "estimate the errors at every value of a key: fish[*].body.modulus=1e5,1e6,1e7; may be repeated"},
    {OPTION_PLAN, "plan", NULL,
     "print the members of the error estimate and the time they will take, but do not run them"},
    {OPTION_NO_CONFIRM, "no-confirm", NULL,
     "leave out the finest level of each key, which takes less time but gives wider error bars"},
    {OPTION_MODELS, "models", NULL, "also give the value with other choices of the model, such as force and friction"},
    {OPTION_SENSITIVITY, "sensitivity", "[=KEYS]",
     "give d ln Q/d ln p of each quantity Q instead of errors, for all numbers p of the case or for KEYS, such as "
     "=modulus,wave.frequency"},
    {OPTION_UNCERTAIN, "uncertain", "KEY=PART",
     "add the uncertainty of a number of the case to the error, such as modulus=10%; may be repeated"},
    {OPTION_MEMBERS, "members", "A-B", "run only member A, or members A to B, without gathering"},
    {OPTION_VTK, "vtk", "FOLDER", "write VTK files for ParaView into this folder"},
    {OPTION_FORCE, "force", NULL, "overwrite existing results"},
    {OPTION_END, "end", "SECONDS", "new end of the run; extends a complete run"},
    {OPTION_FROM, "from", "RESULT.nc",
     "start from the speeds and positions of another steady state (default: those of the case)"},
    {OPTION_THRESHOLD, "threshold", "KEY=FROM:TO",
     "find the value of a key, between two values, at which the state becomes unstable: fish[*].motion.heave=0.2:0.1"},
    {OPTION_CONTINUE, "continue", "KEY=FROM:TO",
     "follow the steady states while a key changes, through folds, and label folds and losses of stability"},
    {OPTION_CHECKPOINT_AT, "checkpoint-at", "LIST",
     "additional times of checkpoints in s, separated by commas (see time.checkpoint_interval)"},
    {OPTION_MAX_WALL, "max-wall", "HH:MM:SS",
     "stop after this wall time, as a signal would: a run writes a checkpoint, and the exit code is 75"},
    {OPTION_TRACE, "trace", "FILE",
     "write a line for each step that ida attempts, as comma-separated values (doc/numerics.md, section 7)"},
    {OPTION_STRICT, "strict", NULL, "exit with code 3 if the result has warnings"},
    {OPTION_AT, "at", "T", "time of a row of the result, s (default: the last row with a wake)"},
    {OPTION_GRID, "grid", "NX,NY", "number of points in x and y (default: 400 along the longer side, equal spacing)"},
    {OPTION_BOX, "box", "X0,Y0,X1,Y1",
     "corners of the grid, m (default: all bodies and wakes, with a margin of half a body length)"},
    {OPTION_SET, "set", "KEY=VALUE", "set a key of the case: fish[0].wave.frequency=1.2, fish[*].nodes=13"},
    {OPTION_THREADS, "threads", "N", "threads of a run; same as --set solver.threads=N"},
    {'q', "quiet", NULL, "suppress progress, notes and summary; warnings are still printed"},
    {'v', "verbose", NULL, "print a summary of the result at the end; with info, also the state in a checkpoint"},
    {OPTION_JSON, "json", NULL, "print JSON"},
    {OPTION_OUTPUT, "output", NULL, "list the variables of result files instead of the keys of cases"},
    {OPTION_CASE, "case", NULL, "print only the complete case stored in the file"},
    {'h', "help", NULL, "print this help"},
};

enum { N_OPTIONS = sizeof all_options / sizeof *all_options };

/* Whether an argument, "[=KEYS]", may be missing. */
static bool is_optional(const char *argument) {
    return argument[0] == '[';
}

static const struct option_help *option_of(int code) {
    const struct option_help *option = all_options;
    while (option->code != code) option++;
    return option;
}

static const char *meaning_of(struct arena *arena, const struct command *command, const struct option_help *option) {
    struct text meaning = {.arena = arena};
    text_add(&meaning, "%s", option->meaning ? option->meaning : command->output);
    if (option->code == OPTION_METHODS) compare_words(&meaning);
    return meaning.text;
}

void main_print_help(const struct command *command, FILE *stream) {
    fprintf(stream, "shoal %s: %s\n\nUsage: shoal %s [OPTIONS]%s%s\n\n", command->name, command->summary, command->name,
            command->positional ? " " : "", command->positional ? command->positional : "");

    for (int i = 0; command->options[i]; i++) {
        const struct option_help *option = option_of(command->options[i]);
        char names[64];
        snprintf(names, sizeof names, "%s--%s%s%s", option->code < OPTION_SET ? "-x, " : "    ", option->name,
                 option->argument && !is_optional(option->argument) ? " " : "",
                 option->argument ? option->argument : "");
        if (option->code < OPTION_SET) names[1] = (char)option->code;
        struct arena *const arena = arena_create(NULL, "the meaning of an option");

        // the meaning in lines of at most 100 characters, beside the names or, if these are long, below
        enum { COLUMN = 27, WIDTH = 100 };
        int column = COLUMN;
        fprintf(stream, "  %s", names);
        if (strlen(names) > COLUMN - 3) {
            fprintf(stream, "\n%*s", COLUMN, "");
        } else {
            fprintf(stream, "%*s", COLUMN - 2 - (int)strlen(names), "");
        }
        for (const char *word = meaning_of(arena, command, option); *word; word += word[0] == ' ') {
            const int length = (int)strcspn(word, " ");
            if (column > COLUMN && column + 1 + length > WIDTH) {
                fprintf(stream, "\n%*s", COLUMN, "");
                column = COLUMN;
            } else if (column > COLUMN) {
                fputc(' ', stream);
                column++;
            }
            fprintf(stream, "%.*s", length, word);
            column += length;
            word += length;
        }
        fputc('\n', stream);
        arena_free(arena);
    }
}

void main_describe(const struct command *command, FILE *stream) {
    text_print_member(stream, "{", "name", command->name);
    text_print_member(stream, ", ", "positional", command->positional);
    text_print_member(stream, ", ", "summary", command->summary);
    fputs(", \"options\": [", stream);

    for (int i = 0; command->options[i]; i++) {
        const struct option_help *const option = option_of(command->options[i]);
        const char letter[2] = {option->code < OPTION_SET ? (char)option->code : '\0', '\0'};
        struct arena *const arena = arena_create(NULL, "the meaning of an option");
        text_print_member(stream, i > 0 ? ",\n  {" : "{", "letter", *letter ? letter : NULL);
        text_print_member(stream, ", ", "name", option->name);
        text_print_member(stream, ", ", "argument", option->argument);
        text_print_member(stream, ", ", "meaning", meaning_of(arena, command, option));
        fputs("}", stream);
        arena_free(arena);
    }

    fputs("]}", stream);
}

/* Fail with STATUS_CASE. The message is the problem (a printf format with one %s for the word) and the command that
 * prints help; command may be NULL. */
static enum status main_usage(const struct command *command, const char *format, const char *word) {
    char problem[512];
    snprintf(problem, sizeof problem, format, word);
    return status_fail(STATUS_CASE, "%s; see shoal %s%s--help", problem, command ? command->name : "",
                       command ? " " : "");
}

static void take_option(struct request *request, int code, char *argument) {
    switch (code) {
        case 'o': request->output = argument; break;
        case 'j': request->processes = argument; break;
        case OPTION_MEMBERS: request->members = argument; break;
        case OPTION_SLURM: request->slurm = 1; break;
        case OPTION_BUNDLE: request->bundle = argument; break;
        case OPTION_OF: request->of[request->n_of++] = argument; break;
        case OPTION_WITHIN: request->within = argument; break;
        case OPTION_AGAINST: request->against = argument; break;
        case OPTION_SWEEP: request->sweeps[request->n_sweeps++] = argument; break;
        case OPTION_PLAN: request->plan = 1; break;
        case OPTION_NO_CONFIRM: request->no_confirm = 1; break;
        case OPTION_MODELS: request->models = 1; break;
        case OPTION_SENSITIVITY: request->sensitivity = argument ? argument : ""; break;
        case OPTION_UNCERTAIN: request->uncertain[request->n_uncertain++] = argument; break;
        case OPTION_CONTINUE: request->follow = argument; break;
        case OPTION_FROM: request->from = argument; break;
        case OPTION_THRESHOLD: request->threshold = argument; break;
        case OPTION_AT: request->at = argument; break;
        case OPTION_GRID: request->grid = argument; break;
        case OPTION_BOX: request->box = argument; break;
        case OPTION_METHODS: request->methods = argument; break;
        case OPTION_RTOL: request->rtols = argument; break;
        case OPTION_STEPS: request->steps = argument; break;
        case OPTION_REPEATS: request->repeats = argument; break;
        case OPTION_REFERENCE: request->reference_rtol = argument; break;
        case OPTION_LIMIT: request->limit = argument; break;
        case 'q': request->quiet = 1; break;
        case 'v': request->verbose = 1; break;
        case OPTION_FORCE: request->force = 1; break;
        case OPTION_END:
            snprintf(request->end, sizeof request->end, "time.end=%s", argument);
            request->assignments[request->n_assignments++] = request->end;
            break;
        case OPTION_CHECKPOINT_AT: request->checkpoint_at = argument; break;
        case OPTION_TRACE: request->trace = argument; break;
        case OPTION_MAX_WALL: request->max_wall = argument; break;
        case OPTION_STRICT: request->strict = 1; break;
        case OPTION_JSON: request->json = 1; break;
        case OPTION_OUTPUT: request->of_output = 1; break;
        case OPTION_CASE: request->case_only = 1; break;
        case OPTION_VTK: request->vtk = argument; break;
        case OPTION_SET: request->assignments[request->n_assignments++] = argument; break;
        case OPTION_THREADS:
            snprintf(request->threads, sizeof request->threads, "solver.threads=%.40s", argument);
            request->assignments[request->n_assignments++] = request->threads;
            break;
        default: break;
    }
}

int main_parse(const struct command *command, int argc, char **argv, struct request *request, enum status *status) {
    struct option options[N_OPTIONS + 1] = {0};
    char letters[2 * N_OPTIONS + 2] = ":";

    for (int i = 0; command->options[i]; i++) {
        const struct option_help *from = option_of(command->options[i]);
        const int argument = !from->argument               ? no_argument
                             : is_optional(from->argument) ? optional_argument
                                                           : required_argument;
        options[i] = (struct option){from->name, argument, NULL, from->code};
        if (from->code < OPTION_SET) {
            const size_t end = strlen(letters);
            letters[end] = (char)from->code;
            letters[end + 1] = from->argument ? ':' : '\0';
        }
    }

    // parse; getopt itself prints nothing
    opterr = 0;
    for (int code; (code = getopt_long(argc, argv, letters, options, NULL)) != -1;) {
        if (code == 'h') {
            main_print_help(command, stdout);
            return -1;
        }
        if (code == '?' || code == ':') {
            *status = main_usage(command, code == '?' ? "unknown option '%s'" : "option '%s' needs a value",
                                 argv[optind - 1]);
            return 0;
        }
        take_option(request, code, optarg);
    }

    // check the positional argument
    const int n_left = argc - optind;
    if (command->positional && *command->positional != '[' && n_left == 0)
        *status = main_usage(command, "%s is missing", command->positional);
    if (n_left > (command->positional ? 1 : 0)) {
        *status = main_usage(command, "unexpected argument '%s'", argv[optind + (command->positional ? 1 : 0)]);
    }
    if (command->positional && n_left > 0) request->positional = argv[optind];
    return 0;
}
