/* study_plan.c: check the existing files of the folder. */
#include "study/study_plan.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "case/case.h"
#include "case/sweep.h"
#include "result/target.h"
#include "study/study_file.h"
#include "study/study_folder.h"

/* Arguments of the checks. */
struct planning {
    const struct case_values *study;
    const char *folder;
    int force;
};

/* Check whether a member is finished; refuse the result of another study. values: case of the member. */
static enum status check_member_file(const struct planning *planning, const struct case_values *values,
                                     const char *path, int *is_finished) {
    struct member_file member;
    *is_finished = 0;
    if (access(path, F_OK) != 0) return STATUS_OK;
    TRY(target_check(path, TARGET_NETCDF, true));
    const enum status read = member_file_read(&member, path);
    if (read == STATUS_FILE) return STATUS_OK;  // truncated by a crash: run the member again
    TRY(read);
    enum status status = STATUS_OK;
    char *effective = NULL;
    if (strcmp(member.study, planning->study->merged) == 0 && member.number == values->member) {
        status = case_show(values, &effective);
        *is_finished =
            status == STATUS_OK && strcmp(member.status, "complete") == 0 && strcmp(member.effective, effective) == 0;
    } else if (!planning->force) {
        status = status_fail(STATUS_FILE,
                             "%s is a result of another study, or the case has changed since: choose another folder "
                             "with -o, or replace the results with --force",
                             path);
    }

    free(effective);
    member_file_free(&member);
    return status;
}

/* Check the case of a member; list the member unless finished. */
static enum status plan_member(const struct planning *planning, struct study_plan *plan, int number) {
    struct case_values values;
    TRY(case_member(&values, planning->study, number));
    enum status status = STATUS_OK;
    char *const path = study_folder_member(planning->folder, number, ".nc");
    int is_finished = 0;
    if (!path) status = STATUS_MEMORY;
    if (status == STATUS_OK) status = check_member_file(planning, &values, path, &is_finished);
    if (status == STATUS_OK && !is_finished) {
        plan->member[plan->n++] = number;
        if (values.school.threads > plan->max_threads) plan->max_threads = values.school.threads;
    }

    if (is_finished) plan->n_done++;
    free(path);
    case_free(&values);

    return status;
}

/* Whether a file is a member of this study: an error study with refinement adds members to the initial ones. */
static int is_member_of_study(const struct planning *planning, const char *path) {
    struct member_file member;
    if (!planning->study->error || member_file_read(&member, path) != STATUS_OK) return 0;
    const int is_same = strcmp(member.study, planning->study->merged) == 0;
    member_file_free(&member);
    return is_same;
}

/* Remove results of other studies beyond the last member of this study. */
static enum status remove_surplus_members(const struct planning *planning) {
    for (int number = sweep_n_members(planning->study);; number++) {
        char *const path = study_folder_member(planning->folder, number, ".nc");
        if (!path) return STATUS_MEMORY;
        const int exists = access(path, F_OK) == 0, is_other = exists && !is_member_of_study(planning, path);
        const int is_removed = is_other && planning->force && target_is(path, TARGET_NETCDF) && unlink(path) == 0;
        if (is_other && !is_removed) {
            status_fail(STATUS_FILE,
                        "%s is a result of another study: choose another folder with -o, or remove the file%s", path,
                        planning->force ? "" : " with --force");
        }
        free(path);
        if (!exists) return STATUS_OK;
        if (is_other && !is_removed) return STATUS_FILE;
    }
}

/* Refuse to replace a file of another program or, without force, a study.nc of another study; ignore an unreadable
 * study.nc. */
static enum status check_study_file(const struct planning *planning) {
    char *const path = study_folder_path(planning->folder, "study.nc");
    if (!path) return STATUS_MEMORY;
    struct case_values values;
    struct member_file *members;
    int n_members;
    const int exists = access(path, F_OK) == 0;
    enum status status = exists ? target_check(path, TARGET_NETCDF, true) : STATUS_OK;
    if (!exists || planning->force || status != STATUS_OK) {
        free(path);
        return status;
    }

    status = study_file_read(path, &values, &members, &n_members);
    if (status == STATUS_OK) {
        if (strcmp(values.merged, planning->study->merged) != 0) {
            status = status_fail(STATUS_FILE,
                                 "%s was gathered from another study, or the case has changed since: choose another "
                                 "folder with -o, or replace the results with --force",
                                 path);
        }
        study_folder_free_members(members, n_members);
        case_free(&values);
    } else if (status != STATUS_MEMORY) {
        status = STATUS_OK;
    }

    free(path);
    return status;
}

enum status study_plan_create(struct study_plan *plan, const struct case_values *study, const char *folder, int first,
                              int last, int force) {
    const struct planning planning = {study, folder, force};
    const int n = sweep_n_members(study), is_part = last >= 0;
    *plan = (struct study_plan){.max_threads = 1};
    if (!is_part) last = n - 1;
    if (first < 0 || first > last || last >= n) {
        return status_fail(STATUS_CASE, "--members %d-%d: the study has members 0 to %d", first, last, n - 1);
    }

    plan->n_members = last - first + 1;
    plan->member = calloc((size_t)plan->n_members, sizeof *plan->member);
    if (!plan->member) return status_fail(STATUS_MEMORY, "out of memory for a study of %d members", plan->n_members);
    for (int number = first; number <= last; number++) TRY(plan_member(&planning, plan, number));
    if (is_part) return STATUS_OK;
    TRY(check_study_file(&planning));

    return remove_surplus_members(&planning);
}

void study_plan_free(struct study_plan *plan) {
    free(plan->member);
    *plan = (struct study_plan){0};
}
