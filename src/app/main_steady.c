/* main_steady.c: the steady state of a case. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/main_commands.h"
#include "app/main_signals.h"
#include "app/main_threads.h"
#include "app/progress.h"
#include "base/parallel.h"
#include "case/case.h"
#include "case/sweep_members.h"
#include "output/steady_info.h"
#include "run/record.h"
#include "run/steady.h"

struct teller {
    struct progress progress;
    int n_warnings;
};

static void tell_progress(const struct steady_progress *now, void *data) {
    struct teller *const teller = data;
    progress_steady(now, &teller->progress);
}

static void tell_warning(const char *line, void *data) {
    struct teller *const teller = data;
    teller->n_warnings++;
    progress_end(&teller->progress);
    fprintf(stderr, "shoal: warning: %s\n", line);
}

static enum status find(const struct case_values *values, const struct request *request, const char *path) {
    struct teller teller = {.n_warnings = 0};
    const struct steady_options options = {.path = path,
                                           .overwrite = request->force,
                                           .command = request->command_line,
                                           .progress = request->quiet ? NULL : tell_progress,
                                           .warn = tell_warning,
                                           .data = &teller,
                                           .stop = main_stop_signal()};
    TRY(parallel_try_threads(values->school.threads));
    main_spread_threads(values->school.threads);
    if (request->max_wall) TRY(main_limit_wall_time(request->max_wall));
    main_catch_signals();
    progress_start(&teller.progress);
    const enum status status = steady_run(values, &options);
    progress_end(&teller.progress);
    TRY(status);
    if (!request->quiet) {
        printf("%s\n", path);
        TRY(steady_info_file(path, stdout));
    }
    if (!request->strict || teller.n_warnings == 0) return STATUS_OK;
    return status_fail(STATUS_MISSED, "%s: with --strict its %d warning%s", path, teller.n_warnings,
                       teller.n_warnings > 1 ? "s are errors" : " is an error");
}

enum status main_steady(const struct request *request) {
    struct case_values values;
    TRY(case_read(&values, request->positional, request->n_assignments, request->assignments));
    enum status status = sweep_refuse(&values);
    main_print_notes(request, &values);
    if (status == STATUS_OK) {
        char *const path = request->output ? strdup(request->output) : record_path(&values);
        status = path ? find(&values, request, path) : status_fail(STATUS_MEMORY, "out of memory: a file name");
        free(path);
    }
    case_free(&values);
    return status;
}
