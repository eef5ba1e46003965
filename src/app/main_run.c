/* main_run.c: the commands that make one result: shoal run, resume, demo and steady. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/main_commands.h"
#include "app/main_signals.h"
#include "app/say.h"
#include "base/parallel.h"
#include "base/version.h"
#include "case/case.h"
#include "case/sweep.h"
#include "result/result_info.h"
#include "result/target.h"
#include "run/record.h"
#include "run/simulate_run.h"
#include "solver/trace.h"
#include "steady/steady.h"
#include "view/page.h"

struct teller {
    struct progress progress; /* first, as say_progress_run expects */
    int n_warnings;
    struct arena *arena;
    const char *path; /* of the result */
};

/* Print and count a warning; clear the progress line first. data: struct teller. */
static void tell_warning(const char *line, void *data) {
    struct teller *const teller = data;
    teller->n_warnings++;
    say_progress_end(&teller->progress);
    say_line(stderr, "shoal: warning: %s\n", line);
}

/* Fail with STATUS_MISSED if the result has warnings and --strict turns warnings into errors. */
static enum status refuse_warnings(const struct request *request, const struct teller *teller, const char *path) {
    if (!request->strict || teller->n_warnings == 0) return STATUS_OK;
    return status_fail(STATUS_MISSED, "%s: with --strict its %d warning%s", path, teller->n_warnings,
                       teller->n_warnings > 1 ? "s are errors" : " is an error");
}

/* Read the case of a request, print the notes, and refuse a sweep. *path: the output of the request or, by default, of
 * the case. */
static enum status read_one_case(const struct request *request, struct case_values *values, const char **path) {
    TRY(main_read_case(request, values));
    if (!request->quiet && *values->notes) say_line(stderr, "%s\n", values->notes);
    *path = request->output ? request->output : record_path(request->arena, values);
    return sweep_refuse(values);
}

// ---- run

static enum status tell_begin(const struct case_values *values, const char *path, void *data) {
    struct teller *const teller = data;
    TRY(parallel_start_threads(values->school.threads));
    teller->path = arena_text(teller->arena, "%s", path);
    return STATUS_OK;
}

static void tell_note(const char *line, void *data) {
    (void)data;
    say_line(stderr, "shoal: note: %s\n", line);
}

/* Create the file of --trace, if it was given, for a case; *trace: NULL without it. */
static enum status open_trace(const struct request *request, const struct case_values *values, struct trace **trace) {
    *trace = NULL;
    if (!request->trace) return STATUS_OK;
    if (values->solver.method != METHOD_IDA) {
        return status_fail(STATUS_CASE, "--trace: only ida is traced, and solver.method is %s",
                           methods_table[values->solver.method].word);
    }
    return trace_create(request->arena, trace, request->trace, request->force);
}

/* Run a case, or resume if values is NULL, and report progress, notes and warnings. */
static enum status run_case(const struct case_values *values, const struct request *request, const char *path) {
    struct teller teller = {.arena = request->arena, .path = ""};
    struct trace *trace = NULL;
    if (values) TRY(open_trace(request, values, &trace));
    const struct simulate_options options = {.path = path,
                                             .overwrite = request->force,
                                             .command = request->command_line,
                                             .checkpoint_at = request->checkpoint_at,
                                             .begin = tell_begin,
                                             .progress = request->quiet ? NULL : say_progress_run,
                                             .warn = tell_warning,
                                             .note = request->quiet ? NULL : tell_note,
                                             .data = &teller,
                                             .trace = trace,
                                             .stop = main_stop_signal()};
    const struct simulate_changes changes = {request->n_assignments, request->assignments, *request->end != '\0'};
    if (request->max_wall) TRY(main_limit_wall_time(request->max_wall));
    main_catch_signals();
    say_progress_start(&teller.progress);
    const enum status status =
        values ? simulate_run(values, &options) : simulate_resume(request->positional, &changes, &options);
    say_progress_end(&teller.progress);
    TRY(status);
    if (trace) TRY(trace_close(trace));

    if (request->verbose) {
        TRY(main_print_info(request->arena, teller.path, MAIN_INFO_SUMMARY));
    } else if (!request->quiet) {
        say_line(stdout, "%s\n", teller.path);
    }
    return refuse_warnings(request, &teller, teller.path);
}

enum status main_run(const struct request *request) {
    struct case_values values;
    const char *path;
    TRY(read_one_case(request, &values, &path));
    return run_case(&values, request, path);
}

enum status main_resume(const struct request *request) {
    return run_case(NULL, request, NULL);
}

// ---- demo

enum status main_demo(const struct request *request) {
    static const struct {
        const char *path;
        enum target_kind kind;
    } targets[] = {{"demo.nc", TARGET_NETCDF}, {"demo.png", TARGET_PICTURE}, {"demo.html", TARGET_PAGE}};
    char share[PATH_MAX], path[PATH_MAX + 32], script[PATH_MAX + 32];
    if (!version_share(share)) {
        return status_fail(STATUS_FILE,
                           "cases/demo.yaml is neither in the source tree nor in share/shoal of the program");
    }
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        if (!request->force && access(targets[i].path, F_OK) == 0) {
            return status_fail(STATUS_FILE, "%s exists: replace it with --force, or change to another folder",
                               targets[i].path);
        }
        TRY(target_check(targets[i].path, targets[i].kind, true));
    }
    snprintf(path, sizeof path, "%s/cases/demo.yaml", share);
    struct request demo = *request;
    demo.positional = path;
    demo.output = "demo.nc";
    demo.verbose = !request->quiet;
    TRY(main_run(&demo));

    // draw the picture, in a wheel by the Python that it was installed for
    const char *const wanted = getenv("SHOAL_PYTHON"), *const python = wanted ? wanted : "/usr/bin/python3";
    snprintf(script, sizeof script, "%s/scripts/plot.py", share);
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        // the script prints the name of the picture
        if (request->quiet && !freopen("/dev/null", "w", stdout)) _exit(127);
        // Python looks for its library beside its name
        execl(python, python, script, demo.output, "demo.png", (char *)NULL);
        _exit(127);
    }
    int outcome = -1;
    if (child < 0 || waitpid(child, &outcome, 0) != child || outcome != 0) {
        return status_fail(STATUS_FILE, "%s was written, but %s %s could not draw demo.png", demo.output, python,
                           script);
    }

    TRY(page_write(request->arena, "demo.nc", "demo.html", request->force));
    if (!request->quiet)
        say_line(stdout, "\nPicture: demo.png. Movie: demo.html (open in a browser). Case: %s.\n", path);
    return STATUS_OK;
}

// ---- steady

enum status main_steady(const struct request *request) {
    if (request->threshold || request->follow) return main_branch(request);
    struct case_values values;
    const char *path;
    TRY(read_one_case(request, &values, &path));
    struct teller teller = {.arena = request->arena};
    struct trace *trace;
    TRY(open_trace(request, &values, &trace));
    const struct steady_options options = {.path = path,
                                           .from = request->from,
                                           .overwrite = request->force,
                                           .command = request->command_line,
                                           .progress = request->quiet ? NULL : say_progress_steady,
                                           .warn = tell_warning,
                                           .data = &teller,
                                           .trace = trace,
                                           .stop = main_stop_signal()};
    TRY(parallel_start_threads(values.school.threads));
    if (request->max_wall) TRY(main_limit_wall_time(request->max_wall));
    main_catch_signals();
    say_progress_start(&teller.progress);
    const enum status status = steady_run(&values, &options);
    say_progress_end(&teller.progress);
    TRY(status);
    if (trace) TRY(trace_close(trace));
    if (request->json) {
        TRY(netcdf_print(request->arena, path, result_json_steady, stdout));
    } else if (!request->quiet) {
        struct say_page page;
        say_line(stdout, "%s\n", path);
        TRY(say_begin(&page));
        TRY(say_end(&page, stdout, netcdf_print(request->arena, path, result_info_steady, page.stream)));
    }

    return refuse_warnings(request, &teller, path);
}
