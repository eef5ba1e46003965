/* main.c: finds the command and calls it. No other file prints errors. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/main_commands.h"
#include "app/main_options.h"
#include "app/main_signals.h"
#include "app/say.h"
#include "base/arena.h"
#include "base/text.h"
#include "base/version.h"
#include "result/durable.h"

// Let waiting threads spin for microseconds and then sleep, unless the environment sets a policy. The default of OpenMP
// is to spin for milliseconds; if threads share a core with other programs, each of the thousands of short loops of a
// run then takes milliseconds. OpenMP reads the environment in a constructor without a priority and is linked into the
// program (Makefile: static_gomp), so this constructor runs first. A shared OpenMP library keeps the default.
__attribute__((constructor(101))) static void limit_spinning(void) {
    if (!getenv("OMP_WAIT_POLICY")) setenv("GOMP_SPINCOUNT", "4000", 0);
}

// ---- the commands

static enum status main_help(const struct request *request);

static const struct command commands[] = {
    {"run",
     "CASE",
     "run a case and write its result",
     {'o', OPTION_FORCE, OPTION_STRICT, OPTION_SET, OPTION_THREADS, OPTION_MAX_WALL, OPTION_TRACE, OPTION_CHECKPOINT_AT,
      'q', 'v', 'h'},
     "file of the result (default: output.file of the case, or the name of the case with .nc)",
     main_run},
    {"resume",
     "RUN.nc",
     "continue a run that was stopped or killed, or extend a complete one; takes a checkpoint too",
     {OPTION_END, OPTION_STRICT, OPTION_THREADS, OPTION_MAX_WALL, OPTION_CHECKPOINT_AT, 'q', 'v', 'h'},
     NULL,
     main_resume},
    {"steady",
     "CASE",
     "find the steady swimming state and its stability",
     {'o', OPTION_FROM, OPTION_THRESHOLD, OPTION_CONTINUE, OPTION_FORCE, OPTION_STRICT, OPTION_SET, OPTION_THREADS,
      OPTION_MAX_WALL, OPTION_TRACE, OPTION_JSON, 'q', 'h'},
     "file of the result, with the last beats (default: output.file of the case, or the name of the case with .nc); "
     "with --threshold or --continue a folder (default: the name of the case with -threshold or -branch)",
     main_steady},
    {"study",
     "CASE",
     "run all members of a sweep and gather the results",
     {'o', 'j', OPTION_LIMIT, OPTION_MEMBERS, OPTION_PLAN, OPTION_SLURM, OPTION_BUNDLE, OPTION_FORCE, OPTION_STRICT,
      OPTION_SET, OPTION_THREADS, OPTION_MAX_WALL, 'q', 'h'},
     "folder of the study (default: the name of the case file with -study)",
     main_study},
    {"error",
     "CASE",
     "give results an error bar: vary each numerical key of a case and see what changes",
     {'o',
      'j',
      OPTION_OF,
      OPTION_WITHIN,
      OPTION_AGAINST,
      OPTION_SWEEP,
      OPTION_NO_CONFIRM,
      OPTION_MODELS,
      OPTION_SENSITIVITY,
      OPTION_UNCERTAIN,
      OPTION_FROM,
      OPTION_PLAN,
      OPTION_LIMIT,
      OPTION_FORCE,
      OPTION_STRICT,
      OPTION_SET,
      OPTION_THREADS,
      OPTION_MAX_WALL,
      'q',
      'h'},
     "folder of the members (default: the name of the case file with -error)",
     main_error},
    {"gather",
     "FOLDER",
     "write study.nc and its table again from the files of the members",
     {OPTION_STRICT, 'q', 'h'},
     NULL,
     main_gather},
    {"compare",
     "CASE",
     "compare integration methods by error and cost",
     {'o', OPTION_FORCE, OPTION_METHODS, OPTION_RTOL, OPTION_STEPS, OPTION_REPEATS, OPTION_REFERENCE, OPTION_LIMIT,
      OPTION_SET, OPTION_THREADS, 'q', 'h'},
     "NetCDF file in the format of study.nc (default: none)",
     main_compare},
    {"check",
     "CASE",
     "check a case, list all errors, and estimate time and memory of the run",
     {OPTION_SET, OPTION_THREADS, 'q', 'h'},
     NULL,
     main_check},
    {"show", "CASE", "print a case with the values of all keys", {OPTION_SET, OPTION_THREADS, 'h'}, NULL, main_show},
    {"new", "CASE", "write a commented case to start from; never overwrites a file", {'q', 'h'}, NULL, main_new},
    {"keys",
     "[WORD]",
     "list the keys of cases, or the variables of results: all, or those whose description has a word",
     {OPTION_JSON, OPTION_OUTPUT, 'h'},
     NULL,
     main_keys},
    {"field",
     "RUN.nc",
     "write velocity and vorticity of the fluid on a grid, at the time of one row of a result",
     {'o', OPTION_AT, OPTION_GRID, OPTION_BOX, OPTION_FORCE, OPTION_THREADS, 'q', 'h'},
     "file of the field (default: the name of the result with -field.nc)",
     main_field},
    {"info",
     "FILE",
     "summarise a file: of a run, a study or a field, or a checkpoint",
     {OPTION_CASE, OPTION_JSON, 'v', 'h'},
     NULL,
     main_info},
    {"view",
     "RUN.nc",
     "write a run as one html page for a browser",
     {'o', OPTION_FORCE, 'q', 'h'},
     "file of the page (default: the name of the run with .html, in the current folder)",
     main_view},
    {"export",
     "RUN.nc",
     "convert a run to the format of another program",
     {OPTION_VTK, OPTION_FORCE, 'q', 'h'},
     NULL,
     main_export},
    {"demo",
     NULL,
     "simulate one fish: write demo.nc, demo.png and demo.html in the current folder",
     {OPTION_FORCE, 'q', 'h'},
     NULL,
     main_demo},
    {"help", "[COMMAND]", "list the commands, or the options of one", {'h'}, NULL, main_help},
};
enum { N_COMMANDS = sizeof commands / sizeof *commands };

static const char summary[] = "schools of flexible swimmers";
static const char exit_codes[] =
    "0 success, 1 the integration failed, 2 wrong usage or a wrong case, 3 an expectation is not met\n"
    "or bodies met with contact.action: stop, 4 file or memory error, 75 stopped by a signal or by\n"
    "--max-wall: continue a run with shoal resume; a search for a steady state starts again.";

static void print_help(FILE *stream) {
    fprintf(stream, "shoal: %s\n\nUsage: shoal COMMAND [OPTIONS] [FILE]\n\n", summary);
    for (int i = 0; i < N_COMMANDS; i++) {
        fprintf(stream, "  %-8s%-12s%s\n", commands[i].name, commands[i].positional ? commands[i].positional : "",
                commands[i].summary);
    }

    fputs(
        "\n  shoal help COMMAND      the options of a command; also shoal COMMAND --help\n"
        "  shoal --version         versions of the program and its libraries\n"
        "  shoal --describe        commands and options as JSON, the source of manual and completion\n\n",
        stream);
    fprintf(stream, "Exit codes: %s\n", exit_codes);
}

static enum status refuse_command(const char *name) {
    // a slip of one or two letters: the nearest command
    const struct command *nearest = NULL;
    int least = 3;
    for (int i = 0; i < N_COMMANDS; i++) {
        const int distance = text_distance(name, strlen(name), commands[i].name, strlen(commands[i].name));
        if (distance >= least || distance >= (int)strlen(name)) continue;
        least = distance;
        nearest = &commands[i];
    }

    return status_fail(STATUS_CASE, "unknown command '%.60s'%s%s%s; see shoal --help", name,
                       nearest ? "; did you mean '" : "", nearest ? nearest->name : "", nearest ? "'?" : "");
}

static enum status main_help(const struct request *request) {
    if (!request->positional) {
        print_help(stdout);
        return STATUS_OK;
    }

    for (int i = 0; i < N_COMMANDS; i++) {
        if (strcmp(request->positional, commands[i].name) != 0) continue;
        main_print_help(&commands[i], stdout);
        return STATUS_OK;
    }
    return refuse_command(request->positional);
}

/* Parse the command line and run the command. This is the boundary of the program (arena.h). */
static enum status main_choose(int argc, char **argv, struct arena **arena) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    *arena = arena_create(NULL, "the command");
    const char *const word = argc < 2 ? "" : argv[1];
    if (argc < 2) {
        print_help(stderr);
        return status_fail(STATUS_CASE, "no command");
    }

    if (strcmp(word, "--version") == 0) {
        char libraries[VERSION_LENGTH];
        version_libraries(libraries);
        printf("%s\n%s\n", version_short(), libraries);
        return STATUS_OK;
    }

    // all commands with their options as JSON
    if (strcmp(word, "--describe") == 0) {
        printf("{\"summary\": \"%s\",\n\"exit_codes\": \"", summary);
        for (const char *c = exit_codes; *c; c++) putchar(*c == '\n' ? ' ' : *c);
        printf("\",\n\"commands\": [");
        for (int i = 0; i < N_COMMANDS; i++) {
            if (i > 0) printf(",\n ");
            main_describe(&commands[i], stdout);
        }
        printf("]}\n");
        return STATUS_OK;
    }

    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        print_help(stdout);
        return STATUS_OK;
    }

    int found = 0;
    while (found < N_COMMANDS && strcmp(word, commands[found].name) != 0) found++;
    if (found == N_COMMANDS) return refuse_command(word);

    // the command line, to be repeated in a shell
    struct text line = {.arena = *arena};
    for (int i = 0; i < argc; i++) {
        if (i > 0) text_add(&line, " ");
        text_add_word(&line, argv[i]);
    }

    // allocate one element more than the command line can fill: main_error adds an assignment
    struct request request = {.arena = *arena, .command_line = line.text};
    NEW(*arena, request.assignments, argc + 1);
    NEW(*arena, request.of, argc + 1);
    NEW(*arena, request.sweeps, argc + 1);
    NEW(*arena, request.uncertain, argc + 1);

    // getopt starts after the name of the command
    enum status status = STATUS_OK;
    const bool is_done = main_parse(&commands[found], argc - 1, argv + 1, &request, &status);
    return is_done || status != STATUS_OK ? status : commands[found].run(&request);
}

int main(int argc, char **argv) {
    main_prepare();
    struct arena *arena = NULL;
    enum status status = main_choose(argc, argv, &arena);
    arena_free(arena);
    durable_remove_parts();
    if (status == STATUS_OK && (fflush(stdout) != 0 || ferror(stdout))) {
        main_end_by_pipe();
        status = status_fail(STATUS_FILE, "cannot write to standard output");
    }

    // errors of a case begin with file, line and column, so only other messages get the prefix
    if (status != STATUS_OK) {
        const char *const message = status_message();
        const size_t length = strlen(message);
        const bool is_of_case = strncmp(message, "error: ", 7) == 0 || strstr(message, ": error: ");
        say_line(stderr, "%s%s%s", is_of_case ? "" : "shoal: error: ", message,
                 length > 0 && message[length - 1] == '\n' ? "" : "\n");
    }
    return main_exit(status_exit_code(status));
}
