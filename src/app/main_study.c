/* main_study.c: the commands for many runs of one case: shoal study, error, gather and compare. */
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/main_commands.h"
#include "app/main_signals.h"
#include "app/say.h"
#include "case/case.h"
#include "case/sweep_error.h"
#include "result/target.h"
#include "study/compare.h"
#include "study/error_plan.h"
#include "study/study.h"
#include "study/study_file.h"
#include "study/study_slurm.h"

// ---- study, error, gather

/* Read the value of an option: a positive integer. */
static enum status read_count(const char *option, const char *text, int *count) {
    char *end;
    const long number = strtol(text, &end, 10);
    if (end == text || *end || number < 1 || number > 1000000) {
        return status_fail(STATUS_CASE, "%s %s: expects an integer above 0", option, text);
    }
    *count = (int)number;
    return STATUS_OK;
}

/* Read the value of an option: a positive number; the default if the option is absent. */
static enum status study_read_number(const char *option, const char *text, double standard, double *number) {
    char *end = NULL;
    *number = text ? strtod(text, &end) : standard;
    if (*number > 0 && (!text || (end != text && *end == '\0'))) return STATUS_OK;
    return status_fail(STATUS_CASE, "%s %s: expects a number above 0", option, text);
}

static enum status study_options_from(const struct request *request, const char *folder, struct progress *progress,
                                      struct study_options *options) {
    *options = (struct study_options){.folder = folder,
                                      .command = request->command_line,
                                      .from = request->from,
                                      .force = request->force,
                                      .progress = request->quiet ? NULL : say_progress_study,
                                      .data = progress,
                                      .stop = main_stop_signal()};
    if (request->processes) TRY(read_count("-j", request->processes, &options->n_processes));
    if (request->limit) TRY(study_read_number("--limit", request->limit, 0, &options->limit));
    if (request->max_wall) TRY(main_limit_wall_time(request->max_wall));
    if (!request->members) return STATUS_OK;

    // one member, "3", or a range of members, "3-7"
    options->is_part = true;
    int length = 0, *const first = &options->first, *const last = &options->last;
    const int n = sscanf(request->members, "%9d-%9d%n", first, last, &length);
    if (n == 1 && sscanf(request->members, "%*d%n", &length) == 0) *last = *first;
    if (n >= 1 && request->members[length] == '\0' && *first >= 0 && *last >= *first) return STATUS_OK;
    return status_fail(STATUS_CASE, "--members %s: expects the number of a member, or a range such as 0-9",
                       request->members);
}

/* Tables and warnings of a study. */
struct report {
    struct say_page tables, warnings;
};

static enum status report_begin(struct report *report) {
    TRY(say_begin(&report->tables));
    const enum status status = say_begin(&report->warnings);
    if (status != STATUS_OK) say_end(&report->tables, NULL, status);
    return status;
}

/* Print tables and warnings to standard output. If quiet, print warnings to standard error, and after a failure also
 * the tables, because the message refers to the tables. */
static enum status report_end(struct report *report, bool is_quiet, enum status status) {
    status = say_end(&report->tables, !is_quiet ? stdout : status == STATUS_OK ? NULL : stderr, status);
    return say_end(&report->warnings, is_quiet ? stderr : stdout, status);
}

static enum status run_study(const struct case_values *values, const struct request *request, const char *folder) {
    struct progress progress;
    struct study_options options;
    int n_failed;
    say_progress_start(&progress);
    TRY(study_options_from(request, folder, &progress, &options));
    main_catch_signals();
    const enum status status = study_run(values, &options, &n_failed);
    say_progress_end(&progress);
    TRY(status);

    if (!options.is_part) {
        if (!request->quiet) say_line(stdout, "%s\n", folder);
        struct report report;
        TRY(report_begin(&report));
        return report_end(&report, request->quiet,
                          study_report(values, folder, NULL, request->command_line, request->strict,
                                       report.tables.stream, report.warnings.stream));
    }

    if (n_failed == 0) return STATUS_OK;
    return status_fail(STATUS_SOLVER, "%d of %d members failed: see %s/member-*.failed", n_failed,
                       options.last - options.first + 1, folder);
}

/* Write the scripts of an array job. */
static enum status write_scripts(const struct case_values *values, const struct request *request, const char *folder,
                                 int bundle) {
    struct progress progress;
    struct study_options options;
    struct say_page page;
    say_progress_start(&progress);
    TRY(study_options_from(request, folder, &progress, &options));
    TRY(say_begin(&page));
    const enum status status = study_slurm(request->arena, values, &options, bundle, request->strict, page.stream);
    say_progress_end(&progress);
    return say_end(&page, stdout, status);
}

/* Estimate the errors of a case: run all members, run some members of the first plan, or write the scripts. */
static enum status run_errors(const struct case_values *values, const struct request *request, const char *folder,
                              int bundle) {
    if (!request->slurm && !request->members) {
        struct progress progress;
        struct study_options options;
        say_progress_start(&progress);
        TRY(study_options_from(request, folder, &progress, &options));
        main_catch_signals();
        if (!request->quiet && !request->plan) say_line(stdout, "%s\n", folder);
        if (!request->quiet || request->plan) {
            // the plan appears before the members run
            const enum status status =
                study_errors(values, &options, request->plan ? 2 : 1, request->strict, stdout, stdout);
            say_progress_end(&progress);
            return status;
        }
        struct report report;
        TRY(report_begin(&report));
        return report_end(
            &report, 1,
            study_errors(values, &options, 0, request->strict, report.tables.stream, report.warnings.stream));
    }

    struct error_sweep *sweep;
    TRY(error_plan_create(request->arena, &sweep, values, NULL));
    return request->slurm ? write_scripts(&sweep->study, request, folder, bundle)
                          : run_study(&sweep->study, request, folder);
}

static enum status study_run_in_folder(const struct case_values *values, const struct request *request,
                                       const char *ending) {
    char folder[512];
    const char *const slash = strrchr(request->positional, '/'), *const file = slash ? slash + 1 : request->positional,
                      *const dot = strrchr(file, '.');
    snprintf(folder, sizeof folder, "%.*s%s", (int)(dot && dot > file ? dot - file : (long)strlen(file)), file, ending);
    const char *const place = request->output ? request->output : folder;
    if (!request->quiet && *values->notes) say_line(stderr, "%s\n", values->notes);
    int bundle = 0;
    if ((request->slurm != 0) + (request->members != NULL) + (request->plan != 0) > 1) {
        return status_fail(STATUS_CASE, "--plan, --members and --slurm exclude each other: give one of these options");
    }
    if (request->bundle && !request->slurm) {
        return status_fail(STATUS_CASE, "--bundle %s: members of a task of Slurm: add --slurm", request->bundle);
    }
    if (request->slurm && request->max_wall) {
        return status_fail(STATUS_CASE,
                           "--max-wall %s: a task of Slurm stops a minute before its time limit: give submit.sh --time",
                           request->max_wall);
    }
    if (request->bundle) TRY(read_count("--bundle", request->bundle, &bundle));
    if (values->error) return run_errors(values, request, place, bundle);
    if (request->plan) {
        return status_fail(STATUS_CASE, "--plan: the case has no `error`; `shoal check` estimates a sweep");
    }
    return request->slurm ? write_scripts(values, request, place, bundle) : run_study(values, request, place);
}

enum status main_study(const struct request *request) {
    struct case_values values;
    TRY(main_read_case(request, &values));
    return study_run_in_folder(&values, request, "-study");
}

/* Set the case with which the quantities are compared: a file, or a word that the case itself understands. */
static enum status set_against(const struct request *request, const struct case_values *values,
                               struct sweep_error *error) {
    const char *const against = request->against;
    error->against = (char *)(uintptr_t)against;
    error->against_kind = strchr(against, '=') ? AGAINST_FISH : AGAINST_POINT;
    if (!sweep_error_is_file(against)) {
        if (error->against_kind == AGAINST_FISH || values->n_axes > 0) return STATUS_OK;
        return status_fail(STATUS_CASE,
                           "--against %s: expects the file of a case, FISH=FISH, or with --sweep `first` or a value of "
                           "the swept key",
                           against);
    }

    // read the case by itself, for messages with the place in the file; a name in an assignment is relative to nothing
    char path[PATH_MAX];
    struct case_values other;
    TRY(case_read(&other, against, 0, NULL));
    case_free(&other);
    if (!realpath(against, path)) return status_fail(STATUS_FILE, "%s: cannot be read: %s", against, strerror(errno));
    error->against = arena_text(request->arena, "%s", path);
    return STATUS_OK;
}

/* Add the inputs of the command line to the assignment of `error`, before its last brace; the case reads their names.
 * */
static enum status add_inputs(const struct request *request, struct text *assignment) {
    assignment->text[--assignment->length] = '\0';
    if (request->sensitivity) {
        // each key in quotes: fish[*].length has brackets
        const char *key = request->sensitivity;
        text_add(assignment, *key ? ", sensitivity: [" : ", sensitivity: true");
        for (int length; *key; key += length + (key[length] == ',')) {
            length = (int)strcspn(key, ",");
            text_add(assignment, "%s\"%.*s\"", key == request->sensitivity ? "" : ", ", length, key);
        }
        if (*request->sensitivity) text_add(assignment, "]");
    }
    for (int i = 0; i < request->n_uncertain; i++) {
        const char *const one = request->uncertain[i], *const part = strchr(one, '=');
        double value;
        if (!part || part == one || !sweep_error_part(part + 1, &value)) {
            return status_fail(STATUS_CASE, "--uncertain %s: expects KEY=PART, such as modulus=10%%", one);
        }
        text_add(assignment, "%s", i == 0 ? ", uncertain: {" : ", ");
        text_add(assignment, "\"%.*s\": ", (int)(part - one), one);
        text_add_number(assignment, value);
    }
    text_add(assignment, request->n_uncertain > 0 ? "}}" : "}");
    return STATUS_OK;
}

enum status main_error(const struct request *request) {
    struct case_values values;
    struct request with_errors = *request;

    // the assignment of the key `sweep`: each --sweep KEY=LIST is an axis
    const char *axes = "";
    for (int i = 0; i < request->n_sweeps; i++) {
        const char *const sweep = request->sweeps[i], *const list = strchr(sweep, '=');
        if (!list || list == sweep || !list[1]) {
            return status_fail(STATUS_CASE, "--sweep %s: expects KEY=VALUE,VALUE,...", sweep);
        }

        // LIST may have one pair of brackets around all values
        bool is_list = list[1] == '[';
        int depth = 0;
        for (const char *c = list + 1; *c; c++) {
            depth += (*c == '[') - (*c == ']');
            if (depth == 0 && c[1]) is_list = false;
        }
        axes = arena_text(request->arena, "%s%s{key: \"%.*s\", values: %s%s%s}", axes, i > 0 ? ", " : "",
                          (int)(list - sweep), sweep, is_list ? "" : "[", list + 1, is_list ? "" : "]");
    }
    if (*axes) with_errors.assignments[with_errors.n_assignments++] = arena_text(request->arena, "sweep=[%s]", axes);
    TRY(main_read_case(&with_errors, &values));

    // the assignment of the key `error`: the settings of the case, overridden by the command line
    struct sweep_error error = {.most = SWEEP_ERROR_MOST, .confirm = 1};
    struct text assignment = {.arena = request->arena};
    if (values.error) error = *values.error;
    if (request->n_of > 0) {
        error.n_of = request->n_of;
        error.of = (char **)(uintptr_t)request->of;
    }
    if (error.n_of == 0) {
        return status_fail(STATUS_CASE, "%s has no `error`: give --of QUANTITY, such as --of steady_speed",
                           request->positional);
    }
    if (request->within) TRY(study_read_number("--within", request->within, 0, &error.within));
    if (request->no_confirm) error.confirm = 0;
    if (request->models) error.models = 1;
    if (request->sensitivity || request->n_uncertain > 0) {
        error.sensitivity = false;
        error.n_inputs = 0;
    }
    if (request->against) TRY(set_against(request, &values, &error));
    text_add(&assignment, "error=");
    sweep_error_write(&assignment, &error);
    if (request->sensitivity || request->n_uncertain > 0) TRY(add_inputs(request, &assignment));
    with_errors.assignments[with_errors.n_assignments++] = assignment.text;

    TRY(main_read_case(&with_errors, &values));
    return study_run_in_folder(&values, &with_errors, "-error");
}

enum status main_gather(const struct request *request) {
    struct report report;
    main_leave_no_part();
    TRY(report_begin(&report));
    return report_end(&report, request->quiet,
                      study_gather(request->positional, request->command_line, request->strict, report.tables.stream,
                                   report.warnings.stream));
}

// ---- compare

enum status main_compare(const struct request *request) {
    struct compare_options options = {.methods = request->methods,
                                      .rtols = request->rtols,
                                      .steps = request->steps,
                                      .repeats = 3,
                                      .path = request->output};
    double limit;
    if (request->repeats) TRY(read_count("--repeats", request->repeats, &options.repeats));
    TRY(study_read_number("--reference-rtol", request->reference_rtol, 1e-9, &options.reference_rtol));
    TRY(study_read_number("--limit", request->limit, 60, &limit));
    if (request->output) TRY(target_check(request->output, TARGET_NETCDF, request->force));
    struct case_values values;
    TRY(main_read_case(request, &values));
    struct progress progress;
    const struct study_options run = {.command = request->command_line,
                                      .limit = limit,
                                      .progress = request->quiet ? NULL : say_progress_study,
                                      .data = &progress,
                                      .stop = main_stop_signal()};
    struct say_page page;
    say_progress_start(&progress);
    main_catch_signals();
    TRY(say_begin(&page));
    const enum status status = study_compare(&values, &options, &run, page.stream);
    say_progress_end(&progress);
    return say_end(&page, request->quiet ? NULL : stdout, status);
}
