/* main_case.c: inspect cases and results. */
#include <stdlib.h>

#include "app/main_commands.h"
#include "case/case.h"
#include "case/case_keys.h"
#include "case/case_member.h"
#include "case/case_show.h"
#include "case/sweep_members.h"
#include "model/fish.h"
#include "output/field_file.h"
#include "output/result_info.h"
#include "output/result_kind.h"
#include "output/result_table.h"
#include "study/study_file.h"
#include "study/study_gather.h"

/* The kinds of files. */
static const struct result_kind kinds[] = {
    {"run", "shoal_schema", RESULT_SCHEMA, "case_effective", result_info, result_table_listed},
    {"study", "shoal_study", STUDY_FILE_SCHEMA, "study_case", study_info, study_file_listed},
    {"field", "shoal_field", FIELD_FILE_SCHEMA, "case_effective", field_file_info, field_file_listed},
};
enum { N_KINDS = sizeof kinds / sizeof *kinds };

/* Check the case of each member of a study, as `shoal study` will. */
static enum status check_members(const struct case_values *study) {
    for (int m = 0; study->n_axes > 0 && m < sweep_n_members(study); m++) {
        struct case_values member;
        TRY(case_member(&member, study, m));
        case_free(&member);
    }
    return STATUS_OK;
}

enum status main_check(const struct request *request) {
    struct case_values values;
    TRY(case_read(&values, request->positional, request->n_assignments, request->assignments));
    struct school *school = NULL;
    enum status status = fish_school_create(&school, &values.school);
    if (status == STATUS_OK) status = check_members(&values);
    if (status == STATUS_OK && !request->quiet) {
        printf("%s: ok: %d fish, %d unknowns, %.6g s in %.0f events", request->positional, school->n_fish,
               school->n_unknowns, values.time.end, values.time.end / values.school.shedding_interval);
        if (values.n_axes > 0) printf("; %d members", sweep_n_members(&values));
        printf("\n");
    }
    fish_school_free(school);
    case_free(&values);
    return status;
}

enum status main_show(const struct request *request) {
    struct case_values values;
    TRY(case_read(&values, request->positional, request->n_assignments, request->assignments));
    char *text = NULL;
    const enum status status = case_show(&values, &text);
    if (status == STATUS_OK) fputs(text, stdout);
    free(text);
    case_free(&values);
    return status;
}

enum status main_keys(const struct request *request) {
    if (request->of_output) {
        result_kind_variables(N_KINDS, kinds, request->json, stdout);
    } else {
        case_keys(stdout, request->json);
    }
    return STATUS_OK;
}

enum status main_info(const struct request *request) {
    return main_print_info(request->positional, request->case_only);
}

enum status main_print_info(const char *path, int case_only) {
    return result_kind_info(N_KINDS, kinds, path, case_only, stdout);
}
