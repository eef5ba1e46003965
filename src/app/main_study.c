/* main_study.c: many runs from one case. */
#include <stdlib.h>

#include "app/main_commands.h"
#include "app/main_signals.h"
#include "app/progress.h"
#include "case/case.h"
#include "output/target.h"
#include "study/study.h"
#include "study/study_compare.h"
#include "study/study_gather.h"
#include "study/study_slurm.h"

// ---- study, gather

/* The value of an option: an integer that is not negative. */
static enum status read_count(const char *option, const char *text, int *count) {
    char *end;
    const long number = strtol(text, &end, 10);
    if (end == text || *end || number < 0 || number > 1000000) {
        return status_fail(STATUS_CASE, "%s %s: expects an integer", option, text);
    }
    *count = (int)number;
    return STATUS_OK;
}

/* The value of an option: a positive number; the default where the option is not given. */
static enum status read_number(const char *option, const char *text, double standard, double *number) {
    char *end = NULL;
    *number = text ? strtod(text, &end) : standard;
    if (*number > 0 && (!text || (end != text && *end == '\0'))) return STATUS_OK;
    return status_fail(STATUS_CASE, "%s %s: expects a number above 0", option, text);
}

/* "3", or "3-7". */
static enum status read_range(const char *text, int *first, int *last) {
    int length = 0;
    const int n = sscanf(text, "%9d-%9d%n", first, last, &length);
    if (n == 1 && sscanf(text, "%*d%n", &length) == 0) *last = *first;
    if (n >= 1 && text[length] == '\0' && *first >= 0 && *last >= *first) return STATUS_OK;
    return status_fail(STATUS_CASE, "--members %s: expects the number of a member, or a range as in 0-9", text);
}

static enum status run_study(const struct case_values *values, const struct request *request, const char *folder) {
    struct progress progress;
    progress_start(&progress);
    struct study_options options = {.folder = folder,
                                    .command = request->command_line,
                                    .last = -1,
                                    .force = request->force,
                                    .progress = request->quiet ? NULL : progress_study,
                                    .data = &progress,
                                    .stop = main_stop_signal()};
    if (request->processes) TRY(read_count("-j", request->processes, &options.n_processes));
    if (request->limit) TRY(read_number("--limit", request->limit, 0, &options.limit));
    if (request->members) TRY(read_range(request->members, &options.first, &options.last));
    if (request->max_wall) TRY(main_limit_wall_time(request->max_wall));
    main_catch_signals();
    int n_failed;
    const enum status status = study_run(values, &options, &n_failed);
    progress_end(&progress);
    TRY(status);
    if (options.last < 0) return study_report(values, folder, NULL, request->command_line, request->strict, stdout);
    if (n_failed == 0) return STATUS_OK;
    return status_fail(STATUS_SOLVER, "%d of %d members failed; %s/member-*.failed say why", n_failed,
                       options.last - options.first + 1, folder);
}

enum status main_study(const struct request *request) {
    struct case_values values;
    TRY(case_read(&values, request->positional, request->n_assignments, request->assignments));
    char folder[512];
    snprintf(folder, sizeof folder, "%s-study", values.name);
    const char *const place = request->output ? request->output : folder;
    main_print_notes(request, &values);
    int bundle = 0;
    enum status status = request->bundle ? read_count("--bundle", request->bundle, &bundle) : STATUS_OK;
    if (status == STATUS_OK) {
        status = request->slurm ? study_slurm(&values, place, bundle, stdout) : run_study(&values, request, place);
    }
    case_free(&values);
    return status;
}

enum status main_gather(const struct request *request) {
    return study_gather(request->positional, request->command_line, request->strict, stdout);
}

// ---- compare

static enum status run_comparison(const struct case_values *values, const struct request *request,
                                  const struct study_compare_options *options, double limit) {
    struct progress progress;
    progress_start(&progress);
    const struct study_options run = {.command = request->command_line,
                                      .limit = limit,
                                      .progress = request->quiet ? NULL : progress_study,
                                      .data = &progress,
                                      .stop = main_stop_signal()};
    main_catch_signals();
    const enum status status = study_compare(values, options, &run, stdout);
    progress_end(&progress);
    return status;
}

enum status main_compare(const struct request *request) {
    struct study_compare_options options = {.methods = request->methods,
                                            .rtols = request->rtols,
                                            .steps = request->steps,
                                            .repeats = 3,
                                            .path = request->output};
    double limit;
    if (request->repeats) TRY(read_count("--repeats", request->repeats, &options.repeats));
    TRY(read_number("--reference-rtol", request->reference_rtol, 1e-9, &options.reference_rtol));
    TRY(read_number("--limit", request->limit, 60, &limit));
    if (request->output) TRY(target_check(request->output, TARGET_NETCDF, request->force));
    struct case_values values;
    TRY(case_read(&values, request->positional, request->n_assignments, request->assignments));
    const enum status status = run_comparison(&values, request, &options, limit);
    case_free(&values);
    return status;
}
