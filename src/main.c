/* main.c: the command line. Results go to stdout, progress and messages to stderr; the only place that prints errors. */
#include <getopt.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "compare.h"
#include "fish.h"
#include "progress.h"
#include "settings.h"
#include "simulate.h"
#include "status.h"
#include "store.h"
#include "study.h"
#include "version.h"

/* ---- what the command line says ---- */

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
    OPTION_BUNDLE
};

struct request {
    const char *command_line;
    const char *output;
    int quiet, verbose, force, json, of_output, case_only;
    int n_assignments;
    const char **assignments; /* the texts of --set */
    char threads[64];         /* --threads as an assignment */
    const char *processes, *members;
    const char *methods, *rtols, *steps, *repeats, *reference_rtol, *limit, *bundle;
    int slurm;
    const char *positional;
};

/* One option: its names, the word for its argument (NULL: none), and what it means. */
struct option_help {
    int code;
    const char *name, *argument, *meaning;
};

static const struct option_help all_options[] = {
    {'o', "output", "PATH",
     "where the result goes: a file (default: the case's output.file, or its name with .nc), for a study a folder "
     "(default: its name with -study), for a comparison a file (default: none)"},
    {'j', "processes", "N", "run N members at once (default: one per processor)"},
    {OPTION_SLURM, "slurm", NULL, "run nothing, but write the scripts of a Slurm array job into the folder"},
    {OPTION_BUNDLE, "bundle", "N", "with --slurm: N members a task"},
    {OPTION_METHODS, "methods", "LIST",
     "methods to compare: ida1 to ida5 (implicit, of this order), euler, heun, rk4, dormand_prince"},
    {OPTION_RTOL, "rtol", "LIST", "tolerances to compare (1e-3,1e-4,1e-5,1e-6,1e-7)"},
    {OPTION_STEPS, "steps", "LIST", "fixed steps for the explicit methods instead of tolerances, s"},
    {OPTION_REPEATS, "repeats", "N", "run each that often; the wall time is the median (3)"},
    {OPTION_REFERENCE, "reference-rtol", "X", "tolerance of the reference, which is ida5 (1e-9)"},
    {OPTION_LIMIT, "limit", "SECONDS", "give a run up after this wall time (60)"},
    {OPTION_MEMBERS, "members", "A-B", "run these members only (or one: A), and gather nothing"},
    {OPTION_FORCE, "force", NULL, "replace a result that exists"},
    {OPTION_SET, "set", "PATH=VALUE", "set a key, as in --set fish[0].wave.frequency=1.2 or --set fish[*].nodes=13"},
    {OPTION_THREADS, "threads", "N", "the same as --set solver.threads=N"},
    {'q', "quiet", NULL, "no progress and no summary"},
    {'v', "verbose", NULL, "print the counts of the solver at the end"},
    {OPTION_JSON, "json", NULL, "print as JSON"},
    {OPTION_OUTPUT, "output", NULL, "list the variables of a result file instead of the keys of a case"},
    {OPTION_CASE, "case", NULL, "print the complete case that made the file, and nothing else"},
    {'h', "help", NULL, "this text"},
};

/* One command: its name, what follows it, one sentence, the codes of its options, and the function that does it. */
struct command {
    const char *name, *positional, *summary;
    int options[16]; /* 0 at the end */
    enum status (*run)(const struct request *request);
};

/* ---- run ---- */

static volatile sig_atomic_t stop_signal;

static void on_signal(int number) {
    stop_signal = number;
}

static void catch_signals(void) {
    struct sigaction action = {.sa_handler = on_signal};
    sigemptyset(&action.sa_mask);
    action.sa_flags = (int)SA_RESETHAND; /* a second one ends the program at once */
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    /* a full disk or a file limit is an error to report, not a death */
    signal(SIGXFSZ, SIG_IGN);
}

static char *default_path(const struct settings *settings) {
    const char *const name = settings->output.file ? settings->output.file : settings->name;
    const char *const ending = settings->output.file ? "" : ".nc";
    char *const path = malloc(strlen(name) + strlen(ending) + 1);
    if (path) sprintf(path, "%s%s", name, ending);
    return path;
}

static enum status run_settings(const struct settings *settings, const struct request *request, const char *path) {
    struct progress progress;
    progress_start(&progress);
    const struct simulate_options options = {.path = path,
                                             .overwrite = request->force,
                                             .command = request->command_line,
                                             .progress = request->quiet ? NULL : progress_show,
                                             .data = &progress,
                                             .stop = &stop_signal};
    catch_signals();
    const enum status status = simulate_run(settings, &options);
    progress_end(&progress);
    TRY(status);
    if (request->verbose) TRY(store_info(path, 0, stdout));
    if (!request->quiet && !request->verbose) printf("%s\n", path);
    return STATUS_OK;
}

static enum status command_run(const struct request *request) {
    struct settings settings;
    TRY(settings_read(&settings, request->positional, request->n_assignments, request->assignments));
    enum status status = settings_runnable(&settings);
    if (status == STATUS_OK) {
        char *const path = request->output ? strdup(request->output) : default_path(&settings);
        status = path ? run_settings(&settings, request, path) : status_fail(STATUS_MEMORY, "no room for a file name");
        free(path);
    }
    settings_free(&settings);
    return status;
}

/* ---- check, show, keys, info ---- */

static enum status command_check(const struct request *request) {
    struct settings settings;
    TRY(settings_read(&settings, request->positional, request->n_assignments, request->assignments));
    struct school *school = NULL;
    const enum status status = fish_school_create(&school, &settings);
    if (status == STATUS_OK && !request->quiet) {
        printf("%s: ok: %d fish, %d unknowns, %.6g s in %.0f events\n", request->positional, school->n_fish,
               school->n_unknowns, settings.time.end, settings.time.end / settings.time.shedding_interval);
    }
    fish_school_free(school);
    settings_free(&settings);
    return status;
}

static enum status command_show(const struct request *request) {
    struct settings settings;
    TRY(settings_read(&settings, request->positional, request->n_assignments, request->assignments));
    char *text = NULL;
    const enum status status = settings_show(&settings, &text);
    if (status == STATUS_OK) fputs(text, stdout);
    free(text);
    settings_free(&settings);
    return status;
}

static enum status command_keys(const struct request *request) {
    if (request->of_output) {
        store_variables(stdout, request->json);
    } else {
        settings_keys(stdout, request->json);
    }
    return STATUS_OK;
}

static enum status command_info(const struct request *request) {
    return store_info(request->positional, request->case_only, stdout);
}

/* ---- study, gather ---- */

/* A whole number from 0 on of an option. */
static enum status read_count(const char *option, const char *text, int *count) {
    char *end;
    const long number = strtol(text, &end, 10);
    if (end == text || *end || number < 0 || number > 1000000) {
        return status_fail(STATUS_CASE, "%s %s: expects a whole number", option, text);
    }
    *count = (int)number;
    return STATUS_OK;
}

/* "3", or "3-7". */
static enum status read_range(const char *text, int *first, int *last) {
    int length = 0;
    const int n = sscanf(text, "%9d-%9d%n", first, last, &length);
    if (n == 1 && sscanf(text, "%*d%n", &length) == 0) *last = *first;
    if (n >= 1 && text[length] == '\0' && *first >= 0 && *last >= *first) return STATUS_OK;
    return status_fail(STATUS_CASE, "--members %s: expects the number of a member, or a range as in 0-9", text);
}

static enum status run_study(const struct settings *settings, const struct request *request, const char *folder) {
    struct progress progress;
    progress_start(&progress);
    struct study_options options = {.folder = folder,
                                    .command = request->command_line,
                                    .last = -1,
                                    .force = request->force,
                                    .progress = request->quiet ? NULL : progress_study,
                                    .data = &progress,
                                    .stop = &stop_signal};
    if (request->processes) TRY(read_count("-j", request->processes, &options.n_processes));
    if (request->members) TRY(read_range(request->members, &options.first, &options.last));
    catch_signals();
    const enum status status = study_run(settings, &options, stdout);
    progress_end(&progress);
    return status;
}

static enum status command_study(const struct request *request) {
    struct settings settings;
    TRY(settings_read(&settings, request->positional, request->n_assignments, request->assignments));
    char folder[512];
    snprintf(folder, sizeof folder, "%s-study", settings.name);
    const char *const place = request->output ? request->output : folder;
    int bundle = 0;
    enum status status = request->bundle ? read_count("--bundle", request->bundle, &bundle) : STATUS_OK;
    if (status == STATUS_OK) {
        status = request->slurm ? study_slurm(&settings, place, bundle, stdout) : run_study(&settings, request, place);
    }
    settings_free(&settings);
    return status;
}

static enum status command_gather(const struct request *request) {
    return study_gather(request->positional, request->command_line, stdout);
}

/* ---- compare ---- */

/* A positive number of an option; the default where it is not given. */
static enum status read_number(const char *option, const char *text, double standard, double *number) {
    char *end = NULL;
    *number = text ? strtod(text, &end) : standard;
    if (*number > 0 && (!text || (end != text && *end == '\0'))) return STATUS_OK;
    return status_fail(STATUS_CASE, "%s %s: expects a number above 0", option, text);
}

static enum status command_compare(const struct request *request) {
    struct compare_options options = {.methods = request->methods,
                                      .rtols = request->rtols,
                                      .steps = request->steps,
                                      .repeats = 3,
                                      .path = request->output,
                                      .command = request->command_line,
                                      .quiet = request->quiet,
                                      .stop = &stop_signal};
    if (request->repeats) TRY(read_count("--repeats", request->repeats, &options.repeats));
    TRY(read_number("--reference-rtol", request->reference_rtol, 1e-9, &options.reference_rtol));
    TRY(read_number("--limit", request->limit, 60, &options.limit));
    if (request->output && !request->force && access(request->output, F_OK) == 0) {
        return status_fail(STATUS_FILE, "%s exists: choose another name with -o or allow replacing it with --force",
                           request->output);
    }
    struct settings settings;
    TRY(settings_read(&settings, request->positional, request->n_assignments, request->assignments));
    catch_signals();
    const enum status status = compare_run(&settings, &options, stdout);
    settings_free(&settings);
    return status;
}

/* ---- demo ---- */

// the folder that holds cases and scripts: that of the sources, or share/shoal beside an installed program
static enum status find_share(char share[PATH_MAX]) {
    char program[PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length <= 0) return status_fail(STATUS_FILE, "cannot find the folder of this program");
    program[length] = '\0';
    char *const slash = strrchr(program, '/');
    if (slash) *slash = '\0';
    static const char *const places[] = {"..", "../share/shoal"};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        char file[PATH_MAX];
        if (snprintf(share, PATH_MAX, "%s/%s", program, places[i]) >= PATH_MAX) continue;
        if (snprintf(file, PATH_MAX, "%s/cases/demo.yaml", share) >= PATH_MAX) continue;
        char *const found = access(file, R_OK) == 0 ? realpath(share, NULL) : NULL;
        if (!found) continue;
        snprintf(share, PATH_MAX, "%s", found);
        free(found);
        return STATUS_OK;
    }
    return status_fail(STATUS_FILE, "cases/demo.yaml is neither in %s/.. nor in %s/../share/shoal", program, program);
}

static enum status draw(const char *share, const char *result, const char *picture) {
    char script[PATH_MAX + 32];
    snprintf(script, sizeof script, "%s/scripts/plot.py", share);
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        execl("/usr/bin/python3", "python3", script, result, picture, (char *)NULL);
        _exit(127);
    }
    int outcome = -1;
    if (child < 0 || waitpid(child, &outcome, 0) != child || outcome != 0) {
        return status_fail(STATUS_FILE, "%s was written, but /usr/bin/python3 %s could not draw %s", result, script,
                           picture);
    }
    return STATUS_OK;
}

static enum status command_demo(const struct request *request) {
    char share[PATH_MAX], path[PATH_MAX + 32];
    TRY(find_share(share));
    snprintf(path, sizeof path, "%s/cases/demo.yaml", share);
    struct request demo = *request;
    demo.positional = path;
    demo.output = "demo.nc";
    demo.force = 1; /* the demonstration owns its two files */
    demo.verbose = !request->quiet;
    TRY(command_run(&demo));
    TRY(draw(share, "demo.nc", "demo.png"));
    if (!request->quiet) printf("\nThe picture is demo.png; the case is %s.\n", path);
    return STATUS_OK;
}

/* ---- the commands ---- */

static const struct command commands[] = {
    {"run",
     "CASE",
     "run a case and write its result",
     {'o', OPTION_FORCE, OPTION_SET, OPTION_THREADS, 'q', 'v', 'h'},
     command_run},
    {"study",
     "CASE",
     "run every member of a case's sweep, and gather what they end with",
     {'o', 'j', OPTION_MEMBERS, OPTION_SLURM, OPTION_BUNDLE, OPTION_FORCE, OPTION_SET, OPTION_THREADS, 'q', 'h'},
     command_study},
    {"gather", "FOLDER", "make study.nc and its table from the files of the members", {'h'}, command_gather},
    {"compare",
     "CASE",
     "compare methods of integration: error against cost",
     {'o', OPTION_FORCE, OPTION_METHODS, OPTION_RTOL, OPTION_STEPS, OPTION_REPEATS, OPTION_REFERENCE, OPTION_LIMIT,
      OPTION_SET, OPTION_THREADS, 'q', 'h'},
     command_compare},
    {"check",
     "CASE",
     "check a case and say everything that is wrong with it",
     {OPTION_SET, OPTION_THREADS, 'q', 'h'},
     command_check},
    {"show", "CASE", "print every key of a case with its value", {OPTION_SET, OPTION_THREADS, 'h'}, command_show},
    {"keys",
     NULL,
     "list all keys of a case, or all variables of a result",
     {OPTION_JSON, OPTION_OUTPUT, 'h'},
     command_keys},
    {"info", "RUN.nc", "say what a result file holds", {OPTION_CASE, 'h'}, command_info},
    {"demo", NULL, "let a fish swim: write demo.nc and demo.png here", {'q', 'h'}, command_demo},
};
enum { N_COMMANDS = sizeof commands / sizeof *commands, N_OPTIONS = sizeof all_options / sizeof *all_options };

static const struct option_help *option_of(int code) {
    const struct option_help *option = all_options;
    while (option->code != code) option++;
    return option;
}

static void print_help(FILE *stream) {
    fputs("shoal: flexible swimmers and their schools\n\nUsage: shoal COMMAND [OPTIONS] [FILE]\n\n", stream);
    for (int i = 0; i < N_COMMANDS; i++) {
        fprintf(stream, "  %-8s%-8s%s\n", commands[i].name, commands[i].positional ? commands[i].positional : "",
                commands[i].summary);
    }
    fputs(
        "\n  shoal COMMAND --help    the options of a command\n"
        "  shoal --version         versions of the program and its libraries\n\n"
        "Exit codes: 0 done, 1 the solver gave up, 2 usage or case error, 3 a stated check missed, 4 file error,\n"
        "75 stopped by a signal.\n",
        stream);
}

static void print_command_help(const struct command *command, FILE *stream) {
    fprintf(stream, "shoal %s: %s\n\nUsage: shoal %s [OPTIONS]%s%s\n\n", command->name, command->summary, command->name,
            command->positional ? " " : "", command->positional ? command->positional : "");
    for (int i = 0; command->options[i]; i++) {
        const struct option_help *option = option_of(command->options[i]);
        char names[64];
        snprintf(names, sizeof names, "%s--%s%s%s", option->code < OPTION_SET ? "-x, " : "    ", option->name,
                 option->argument ? " " : "", option->argument ? option->argument : "");
        if (option->code < OPTION_SET) names[1] = (char)option->code;
        fprintf(stream, "  %-22s %s\n", names, option->meaning);
    }
}

static enum status usage(const struct command *command, const char *format, const char *word) {
    char problem[512];
    snprintf(problem, sizeof problem, format, word);
    return status_fail(STATUS_CASE, "%s; see shoal %s%s--help", problem, command ? command->name : "",
                       command ? " " : "");
}

static enum status take_option(struct request *request, int code, char *argument) {
    switch (code) {
        case 'o': request->output = argument; break;
        case 'j': request->processes = argument; break;
        case OPTION_MEMBERS: request->members = argument; break;
        case OPTION_SLURM: request->slurm = 1; break;
        case OPTION_BUNDLE: request->bundle = argument; break;
        case OPTION_METHODS: request->methods = argument; break;
        case OPTION_RTOL: request->rtols = argument; break;
        case OPTION_STEPS: request->steps = argument; break;
        case OPTION_REPEATS: request->repeats = argument; break;
        case OPTION_REFERENCE: request->reference_rtol = argument; break;
        case OPTION_LIMIT: request->limit = argument; break;
        case 'q': request->quiet = 1; break;
        case 'v': request->verbose = 1; break;
        case OPTION_FORCE: request->force = 1; break;
        case OPTION_JSON: request->json = 1; break;
        case OPTION_OUTPUT: request->of_output = 1; break;
        case OPTION_CASE: request->case_only = 1; break;
        case OPTION_SET: request->assignments[request->n_assignments++] = argument; break;
        case OPTION_THREADS:
            snprintf(request->threads, sizeof request->threads, "solver.threads=%.40s", argument);
            request->assignments[request->n_assignments++] = request->threads;
            break;
        default: break;
    }
    return STATUS_OK;
}

// the command's own options for getopt_long; returns -1 once help has been printed
static int parse(const struct command *command, int argc, char **argv, struct request *request, enum status *status) {
    struct option options[N_OPTIONS + 1] = {0};
    char letters[2 * N_OPTIONS + 2] = ":";
    for (int i = 0; command->options[i]; i++) {
        const struct option_help *from = option_of(command->options[i]);
        options[i] = (struct option){from->name, from->argument ? required_argument : no_argument, NULL, from->code};
        if (from->code < OPTION_SET) {
            const size_t end = strlen(letters);
            letters[end] = (char)from->code;
            letters[end + 1] = from->argument ? ':' : '\0';
        }
    }
    opterr = 0;
    for (int code; (code = getopt_long(argc, argv, letters, options, NULL)) != -1;) {
        if (code == 'h') {
            print_command_help(command, stdout);
            return -1;
        }
        if (code == '?' || code == ':') {
            *status =
                usage(command, code == '?' ? "unknown option '%s'" : "option '%s' needs a value", argv[optind - 1]);
            return 0;
        }
        take_option(request, code, optarg);
    }
    const int n_left = argc - optind;
    if (command->positional && n_left == 0) *status = usage(command, "%s is missing", command->positional);
    if (n_left > (command->positional ? 1 : 0)) {
        *status = usage(command, "'%s' is one word too many", argv[optind + (command->positional ? 1 : 0)]);
    }
    if (command->positional && n_left > 0) request->positional = argv[optind];
    return 0;
}

static char *join(int argc, char **argv) {
    size_t length = 1;
    for (int i = 0; i < argc; i++) length += strlen(argv[i]) + 1;
    char *const text = calloc(1, length);
    for (int i = 0; i < argc && text; i++) {
        strcat(text, argv[i]);
        if (i + 1 < argc) strcat(text, " ");
    }
    return text;
}

static enum status dispatch(const struct command *command, int argc, char **argv) {
    char *const command_line = join(argc, argv);
    const char **const assignments = calloc((size_t)argc + 1, sizeof *assignments);
    enum status status = STATUS_OK;
    if (command_line && assignments) {
        struct request request = {.command_line = command_line, .assignments = assignments};
        // getopt starts behind the command's name
        if (parse(command, argc - 1, argv + 1, &request, &status) == 0 && status == STATUS_OK) {
            status = command->run(&request);
        }
    } else {
        status = status_fail(STATUS_MEMORY, "no room for the command line");
    }
    free(command_line);
    free(assignments);
    return status;
}

static enum status print_version(void) {
    char libraries[VERSION_LENGTH];
    version_libraries(libraries);
    printf("%s\n%s\n", version_short(), libraries);
    return STATUS_OK;
}

static enum status choose(int argc, char **argv) {
    if (argc < 2) {
        print_help(stderr);
        return status_fail(STATUS_CASE, "no command");
    }
    if (strcmp(argv[1], "--version") == 0) return print_version();
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        print_help(stdout);
        return STATUS_OK;
    }
    for (int i = 0; i < N_COMMANDS; i++) {
        if (strcmp(argv[1], commands[i].name) == 0) return dispatch(&commands[i], argc, argv);
    }
    return usage(NULL, "unknown command '%s'", argv[1]);
}

// the errors of a case name their places themselves
static void print_message(const char *message) {
    const size_t length = strlen(message);
    fprintf(stderr, "%s%s%s", strstr(message, "error: ") ? "" : "shoal: error: ", message,
            length > 0 && message[length - 1] == '\n' ? "" : "\n");
}

int main(int argc, char **argv) {
    enum status status = choose(argc, argv);
    if (status == STATUS_OK && (fflush(stdout) != 0 || ferror(stdout))) {
        status = status_fail(STATUS_FILE, "cannot write to standard output");
    }
    if (status != STATUS_OK) print_message(status_message());
    return status_exit_code(status);
}
