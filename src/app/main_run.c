/* main_run.c: shoal run, resume and demo. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/main_commands.h"
#include "app/main_signals.h"
#include "app/main_teller.h"
#include "app/progress.h"
#include "app/say.h"
#include "base/parallel.h"
#include "base/version.h"
#include "result/target.h"
#include "run/simulate_run.h"
#include "view/page.h"

// ---- run

static enum status tell_begin(const struct case_values *values, const char *path, void *data) {
    struct teller *const teller = data;
    TRY(parallel_try_threads(values->school.threads));
    parallel_choice_spread(values->school.threads);
    teller->path = strdup(path);
    return teller->path ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: a file name");
}

static void tell_note(const char *line, void *data) {
    (void)data;
    say_line(stderr, "shoal: note: %s\n", line);
}

static void tell_progress(const struct simulate_progress *now, void *data) {
    struct teller *const teller = data;
    progress_show(now, &teller->progress);
}

/* Run a case, or resume if values is NULL, and report progress, notes and warnings. */
static enum status run_with_reports(const struct case_values *values, const struct request *request, const char *path,
                                    struct teller *teller) {
    const struct simulate_options options = {.path = path,
                                             .overwrite = request->force,
                                             .command = request->command_line,
                                             .checkpoint_at = request->checkpoint_at,
                                             .begin = tell_begin,
                                             .progress = request->quiet ? NULL : tell_progress,
                                             .warn = main_tell_warning,
                                             .note = request->quiet ? NULL : tell_note,
                                             .data = teller,
                                             .stop = main_stop_signal()};
    const struct simulate_changes changes = {request->n_assignments, request->assignments, *request->end != '\0'};
    if (request->max_wall) TRY(main_limit_wall_time(request->max_wall));
    main_catch_signals();
    progress_start(&teller->progress);
    const enum status status =
        values ? simulate_run(values, &options) : simulate_resume(request->positional, &changes, &options);
    progress_end(&teller->progress);
    return status;
}

static enum status run_case(const struct case_values *values, const struct request *request, const char *path) {
    struct teller teller = {0};
    enum status status = run_with_reports(values, request, path, &teller);
    const char *const result = teller.path ? teller.path : "";
    if (status == STATUS_OK && request->verbose) status = main_print_info(result, 0);
    if (status == STATUS_OK && !request->quiet && !request->verbose) say_line(stdout, "%s\n", result);
    if (status == STATUS_OK) status = main_refuse_warnings(request, &teller, result);
    free(teller.path);
    return status;
}

enum status main_run(const struct request *request) {
    return main_with_case(request, run_case);
}

enum status main_resume(const struct request *request) {
    return run_case(NULL, request, NULL);
}

// ---- demo

static enum status draw_demo(const char *share, const char *result, const char *picture) {
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

static enum status check_demo_target(const char *path, enum target_kind kind, int force) {
    if (!force && access(path, F_OK) == 0) {
        return status_fail(STATUS_FILE, "%s exists: replace it with --force, or change to another folder", path);
    }
    return target_check(path, kind, true);
}

enum status main_demo(const struct request *request) {
    char share[PATH_MAX], path[PATH_MAX + 32];
    if (!version_share(share)) {
        return status_fail(STATUS_FILE,
                           "cases/demo.yaml is neither in the source tree nor in share/shoal of the program");
    }
    TRY(check_demo_target("demo.nc", TARGET_NETCDF, request->force));
    TRY(check_demo_target("demo.png", TARGET_PICTURE, request->force));
    TRY(check_demo_target("demo.html", TARGET_PAGE, request->force));
    snprintf(path, sizeof path, "%s/cases/demo.yaml", share);
    struct request demo = *request;
    demo.positional = path;
    demo.output = "demo.nc";
    demo.verbose = !request->quiet;
    TRY(main_run(&demo));
    TRY(draw_demo(share, "demo.nc", "demo.png"));
    TRY(page_write("demo.nc", "demo.html", request->force));
    if (!request->quiet)
        say_line(stdout, "\nPicture: demo.png. Movie: demo.html (open in a browser). Case: %s.\n", path);
    return STATUS_OK;
}
