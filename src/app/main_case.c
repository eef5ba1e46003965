/* main_case.c: the commands that show something without computing it: show, new, keys and info. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/main_commands.h"
#include "app/say.h"
#include "case/case.h"
#include "result/checkpoint.h"
#include "result/result_info.h"
#include "result/result_kind.h"
#include "result/result_table.h"
#include "result/target.h"
#include "school/warnings.h"
#include "study/study_file.h"
#include "view/field_file.h"

/* Row i of the list of warnings about a result. */
static int list_warning(int i, struct result_listed *listed) {
    if (i >= N_WARNINGS) return 0;
    *listed = (struct result_listed){warnings_table[i].subject, "", "", warnings_table[i].cause, "", NULL};
    return 1;
}

/* The kinds of result files; the last row is the list of warnings, which is no file. */
static const struct result_kind kinds[] = {
    {"run", "shoal_schema", RESULT_SCHEMA, "case_effective", result_info, result_table_listed},
    {"study", "shoal_study", STUDY_FILE_SCHEMA, "study_case", study_info, study_file_listed},
    {"field", "shoal_field", FIELD_FILE_SCHEMA, "case_effective", field_file_info, field_file_listed},
    {.name = "warning", .listed = list_warning},
};
enum { N_LISTS = sizeof kinds / sizeof *kinds, N_KINDS = N_LISTS - 1 };

enum status main_read_case(const struct request *request, struct case_values *values) {
    TRY(case_read(values, request->positional, request->n_assignments, request->assignments));
    arena_move(values->arena, request->arena);
    return STATUS_OK;
}

enum status main_show(const struct request *request) {
    struct case_values values;
    TRY(main_read_case(request, &values));
    fputs(case_show(request->arena, &values), stdout);
    return STATUS_OK;
}

enum status main_keys(const struct request *request) {
    const char *const word = request->positional;
    const int n = request->of_output ? result_kind_variables(N_LISTS, kinds, request->json, word, stdout)
                                     : case_keys(request->arena, stdout, request->json, word);
    if (n > 0 || request->json) return STATUS_OK;
    return status_fail(STATUS_CASE, "no %s has '%.60s' in name or meaning%s", request->of_output ? "variable" : "key",
                       word, request->of_output ? "" : "; see shoal keys, or shoal keys --output for results");
}

enum status main_new(const struct request *request) {
    const char *const path = request->positional;
    // a file that appears in the meantime is not overwritten either
    FILE *const file = fopen(path, "wx");
    if (!file) {
        return status_fail(STATUS_FILE, errno == EEXIST ? "%s exists: choose another name" : "%s: %s", path,
                           strerror(errno));
    }

    const bool failed = fputs(case_template, file) == EOF;
    if (fclose(file) != 0 || failed) {
        const int code = errno;
        remove(path);
        return status_fail(STATUS_FILE, "%s: cannot be written: %s", path, strerror(code));
    }
    if (!request->quiet) say_line(stdout, "%s\n", path);
    return STATUS_OK;
}

enum status main_info(const struct request *request) {
    const char *const path = request->positional;
    const enum main_info part = request->case_only ? MAIN_INFO_CASE
                                : request->verbose ? MAIN_INFO_ALL
                                                   : MAIN_INFO_SUMMARY;
    if (!request->json) return main_print_info(request->arena, path, part);
    if (request->case_only) return status_fail(STATUS_CASE, "info: --case prints a case file, which is not JSON");
    if (target_is(path, TARGET_CHECKPOINT)) {
        return status_fail(STATUS_CASE, "info: %s is a checkpoint; --json needs the file of a run, a study or a field",
                           path);
    }

    return result_kind_info(request->arena, N_KINDS, kinds, path, RESULT_INFO_JSON, stdout);
}

enum status main_print_info(struct arena *arena, const char *path, enum main_info part) {
    static const enum checkpoint_part of_checkpoint[] = {[MAIN_INFO_SUMMARY] = CHECKPOINT_SUMMARY,
                                                         [MAIN_INFO_ALL] = CHECKPOINT_STATE,
                                                         [MAIN_INFO_CASE] = CHECKPOINT_CASE};
    const enum result_info_form form = part == MAIN_INFO_CASE ? RESULT_INFO_CASE : RESULT_INFO_TEXT;
    struct say_page page;
    TRY(say_begin(&page));
    return say_end(&page, stdout,
                   target_is(path, TARGET_CHECKPOINT)
                       ? checkpoint_info(arena, path, of_checkpoint[part], page.stream)
                       : result_kind_info(arena, N_KINDS, kinds, path, form, page.stream));
}
