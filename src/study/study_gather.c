/* study_gather.c: read the member files, write study.nc, print the tables. */
#include "study/study_gather.h"

#include <limits.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "case/case.h"
#include "case/sweep.h"
#include "result/target.h"
#include "study/error_report.h"
#include "study/study_comparison.h"
#include "study/study_file.h"
#include "study/study_folder.h"
#include "study/study_orders.h"
#include "study/study_print.h"

static const char owner[] = "the report of a study"; /* of the arenas */

/* Fail if a member is incomplete and the case does not expect the failure. */
static enum status test_completeness(const struct case_values *study, const struct member_file *members,
                                     const char *folder) {
    const int n = sweep_n_members(study);
    int n_failed = 0;
    for (int m = 0; m < n; m++) {
        n_failed += !member_file_is_complete(&members[m]) && !study_expects_failure(study, members, m);
    }
    if (n_failed == 0) return STATUS_OK;
    return status_fail(STATUS_SOLVER,
                       "%d of %d members in %s are not complete; repeat `shoal %s` with the same options", n_failed, n,
                       folder, study->error ? "error" : "study");
}

static enum status print_members(struct arena *arena, const struct case_values *study,
                                 const struct member_file *members, FILE *stream) {
    return study_comparison_is(study) ? study_comparison_print(arena, study, members, stream)
                                      : study_print(study, members, stream);
}

/* Print orders and expectations; the first failure counts. */
static enum status print_expected(const struct case_values *study, const struct member_file *members,
                                  const struct study_orders *orders, FILE *stream) {
    const enum status of_orders = study_orders_print(study, orders, stream);
    if (of_orders != STATUS_OK && of_orders != STATUS_MISSED) return of_orders;
    const enum status of_members = study_expect(study, members, stream);
    return of_orders == STATUS_OK ? of_members : of_orders;
}

/* Print the warnings, except for a comparison of methods: the warnings of short runs concern the case. */
static enum status gather_print_warnings(struct arena *arena, const struct case_values *study,
                                         const struct member_file *members, int strict, FILE *stream) {
    if (study_comparison_is(study)) return STATUS_OK;
    const int n = study_print_warnings(arena, members, sweep_n_members(study), stream);
    if (!strict || n == 0) return STATUS_OK;
    return status_fail(STATUS_MISSED, "%d warning%s about the members, with --strict", n, n > 1 ? "s" : "");
}

/* Print all tables and write study.nc before a missed expectation ends the report. */
static enum status report_study(struct arena *arena, const struct case_values *study, const struct member_file *members,
                                const char *path, const char *command, int strict, FILE *stream, FILE *warnings) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    struct study_orders orders;
    study_orders_create(arena, &orders, study, members);
    TRY(print_members(arena, study, members, stream));
    TRY(study_file_write(arena, path, study, members, &orders, NULL, command));
    const enum status expected = print_expected(study, members, &orders, stream);
    const enum status warned = gather_print_warnings(arena, study, members, strict && expected == STATUS_OK, warnings);
    return expected == STATUS_OK ? warned : expected;
}

/* study_report with the memory of an arena. */
static enum status report_folder(struct arena *arena, const struct case_values *study, const char *folder,
                                 const char *path, const char *command, int strict, FILE *stream, FILE *warnings) {
    struct member_file *members = NULL;
    char *const standard = study_folder_path(folder, "study.nc"), *const csv = study_folder_path(folder, "error.csv");
    enum status status = standard && csv ? STATUS_OK : STATUS_MEMORY;
    if (status == STATUS_OK) status = study_folder_read_members(&members, study, folder);
    if (status == STATUS_OK) {
        study_comparison_fill_errors(study, members);
        status = report_study(arena, study, members, path ? path : standard, command, strict, stream, warnings);

        // the table of an error study that the folder contained before
        if (target_is(csv, TARGET_TABLE)) unlink(csv);
        if (status == STATUS_OK) status = test_completeness(study, members, folder);
        study_folder_free_members(members, sweep_n_members(study));
    }

    free(standard);
    free(csv);
    return status;
}

enum status study_report(const struct case_values *study, const char *folder, const char *path, const char *command,
                         int strict, FILE *stream, FILE *warnings) {
    struct arena *const arena = arena_create(NULL, owner);
    const enum status status = report_folder(arena, study, folder, path, command, strict, stream, warnings);
    arena_free(arena);
    return status;
}

// ---- errors

/* The number of members in a folder before the first missing member. */
static int count_members(const char *folder) {
    for (int m = 0;; m++) {
        char *const path = study_folder_member(folder, m, ".nc");
        const int exists = path && access(path, F_OK) == 0;
        free(path);
        if (!exists) return m;
    }
}

/* Read and judge the members in a folder, add the members required by the error bound, and repeat. Unless options is
 * NULL, run new members first. The caller frees *members. */
static enum status run_and_refine(struct error_study *study, const char *folder, const struct study_options *options,
                                  struct member_file **members) {
    const int most_members = options ? INT_MAX : count_members(folder);
    for (;;) {
        int n_failed, n_new;
        if (options) TRY(study_run(&study->study, options, &n_failed));
        const int n = sweep_n_members(&study->study);
        TRY(study_folder_read_members(members, &study->study, folder));
        error_study_judge(study, *members);
        const enum status status = error_study_refine(study, *members, most_members, &n_new);
        if (status == STATUS_OK && n_new == 0) return STATUS_OK;
        study_folder_free_members(*members, n);
        *members = NULL;
        TRY(status);
    }
}

/* Print the budget and write study.nc and error.csv before a missed bound ends the report. */
static enum status report_errors(struct arena *arena, struct error_study *study, const struct member_file *members,
                                 const char *path, const char *csv, const char *command, int strict, FILE *stream,
                                 FILE *warnings) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    const struct study_orders none = {0};
    TRY(study_file_write(arena, path, &study->study, members, &none, study, command));
    TRY(error_report_write_csv(study, csv));
    const enum status status = error_report_print(study, members, stream);

    // deliberately coarse levels have separate warnings, which are not printed
    const int n = study_print_warnings(arena, &members[study->stated], 1, warnings);
    if (status == STATUS_OK && strict && n > 0) {
        return status_fail(STATUS_MISSED, "%d warning%s about the stated value, with --strict", n, n > 1 ? "s" : "");
    }
    return status;
}

static enum status refine_and_report(struct arena *arena, struct error_study *study, const char *folder,
                                     const struct study_options *options, const char *command, int strict, FILE *stream,
                                     FILE *warnings) {
    struct member_file *members = NULL;
    char *const path = study_folder_path(folder, "study.nc"), *const csv = study_folder_path(folder, "error.csv");
    enum status status = path && csv ? run_and_refine(study, folder, options, &members) : STATUS_MEMORY;
    if (status == STATUS_OK) {
        status = report_errors(arena, study, members, path, csv, command, strict, stream, warnings);
    }
    if (status == STATUS_OK) status = test_completeness(&study->study, members, folder);
    study_folder_free_members(members, sweep_n_members(&study->study));
    free(path);
    free(csv);
    return status;
}

enum status study_errors(const struct case_values *values, const struct study_options *options, int plan, int strict,
                         FILE *stream, FILE *warnings) {
    struct arena *const arena = arena_create(NULL, owner);
    struct error_study study;
    enum status status = error_plan_create(&study, values);
    if (status == STATUS_OK && plan > 0) {
        int n_processes =
            options->n_processes > 0 ? options->n_processes : omp_get_num_procs() / values->school.threads;
        status = error_report_plan(&study, n_processes < 1 ? 1 : n_processes, stream);
    }

    if (status == STATUS_OK && plan < 2) {
        fflush(stream);
        status = refine_and_report(arena, &study, options->folder, options, options->command, strict, stream, warnings);
    }

    error_plan_free(&study);
    arena_free(arena);
    return status;
}

enum status study_gather(const char *folder, const char *command, int strict, FILE *stream, FILE *warnings) {
    struct arena *const arena = arena_create(NULL, owner);
    char *text = NULL;
    struct case_values study = {0};
    enum status status = study_folder_find_study(folder, &text);
    if (status == STATUS_OK) status = case_parse(&study, text, strlen(text), folder, NULL, 0, NULL);
    free(text);

    if (status == STATUS_OK && study.error) {
        struct error_study errors;
        status = error_plan_create(&errors, &study);
        if (status == STATUS_OK) {
            status = refine_and_report(arena, &errors, folder, NULL, command, strict, stream, warnings);
        }
        error_plan_free(&errors);
    } else if (status == STATUS_OK) {
        status = report_folder(arena, &study, folder, NULL, command, strict, stream, warnings);
    }

    case_free(&study);
    arena_free(arena);
    return status;
}

/* Print members, orders, expectations and warnings. */
static enum status print_study(struct arena *arena, const struct case_values *study, const struct member_file *members,
                               FILE *stream) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    struct study_orders orders;
    study_orders_create(arena, &orders, study, members);
    TRY(print_members(arena, study, members, stream));
    const enum status status = print_expected(study, members, &orders, stream);

    // a missed expectation belongs to the contents of the file
    if (status == STATUS_MISSED) fprintf(stream, "missed: %s\n", status_message());
    if (!study_comparison_is(study)) study_print_warnings(arena, members, sweep_n_members(study), stream);
    return status;
}

static enum status print_errors(const struct case_values *values, const struct member_file *members, int n,
                                FILE *stream) {
    struct error_study study;
    enum status status = error_plan_create(&study, values);
    if (status == STATUS_OK && sweep_n_members(&study.study) > n) {
        status =
            status_fail(STATUS_FILE, "the file has %d members, expected %d: write study.nc again with `shoal gather`",
                        n, sweep_n_members(&study.study));
    }

    int n_new = 1;
    while (status == STATUS_OK && n_new > 0) {
        error_study_judge(&study, members);
        status = error_study_refine(&study, members, n, &n_new);
    }

    if (status == STATUS_OK) status = error_report_print(&study, members, stream);
    if (status == STATUS_MISSED) fprintf(stream, "missed: %s\n", status_message());
    error_plan_free(&study);
    return status;
}

enum status study_info(struct arena *parent, const char *path, FILE *stream) {
    struct case_values study;
    struct member_file *members;
    int n;

    struct arena *const arena = arena_create(parent, owner);
    const enum status read = study_file_read(path, &study, &members, &n);
    if (read != STATUS_OK) {
        arena_free(arena);
        return read;
    }

    // the number of members, the number of complete members and the axes
    int n_complete = 0;
    for (int m = 0; m < n; m++) n_complete += member_file_is_complete(&members[m]);
    fprintf(stream, "  %-10s  %d, %d of them complete\n", "members", n, n_complete);
    for (int a = 0; a < study.n_axes; a++) {
        const struct sweep_axis *const axis = &study.sweep[a];
        fprintf(stream, "  axis %-5d  %d values of ", a, axis->n_values);
        for (int k = 0; k < axis->n_keys; k++) fprintf(stream, "%s%s", k > 0 ? ", " : "", axis->key[k].path);
        fprintf(stream, "%s\n", axis->refine ? ", refined" : "");
    }
    fprintf(stream, "\n");

    const enum status status =
        study.error ? print_errors(&study, members, n, stream) : print_study(arena, &study, members, stream);
    arena_free(arena);
    study_folder_free_members(members, n);
    case_free(&study);

    return status == STATUS_MISSED ? STATUS_OK : status;
}
