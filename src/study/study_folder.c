/* study_folder.c: names, reasons and final values of member files. */
#include "study/study_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "case/case.h"
#include "case/sweep.h"
#include "result/durable.h"
#include "result/target.h"
#include "study/study_file.h"

enum { REASON_BYTES = 2048 };

enum status study_folder_create(const char *folder) {
    struct stat facts;
    if (mkdir(folder, 0777) == 0) return STATUS_OK;
    if (errno == EEXIST && stat(folder, &facts) == 0 && S_ISDIR(facts.st_mode)) return STATUS_OK;
    return status_fail(STATUS_FILE, "%s: cannot create this folder (%s): choose another folder with -o", folder,
                       strerror(errno));
}

void study_folder_remove(const char *folder) {
    DIR *const entries = opendir(folder);
    if (!entries) return;
    for (const struct dirent *entry; (entry = readdir(entries));) unlinkat(dirfd(entries), entry->d_name, 0);
    closedir(entries);
    rmdir(folder);
}

char *study_folder_path(const char *folder, const char *name) {
    // NetCDF takes a name without "./" for a URL
    const size_t size = strlen(folder) + strlen(name) + 8;
    char *path;
    if (MEMORY_NEW(path, size, "a file name") != STATUS_OK) return NULL;
    snprintf(path, size, "%s%s/%s", folder[0] == '/' || folder[0] == '.' ? "" : "./", folder, name);
    return path;
}

char *study_folder_member(const char *folder, int member, const char *ending) {
    char name[64];
    snprintf(name, sizeof name, "member-%04d%s", member, ending);
    return study_folder_path(folder, name);
}

void study_folder_free_members(struct member_file *members, int n) {
    for (int m = 0; members && m < n; m++) member_file_free(&members[m]);
    free(members);
}

/* Replace the status of a member. */
static enum status replace_status(struct member_file *member, const char *format, const char *text) {
    char line[REASON_BYTES + 16];
    snprintf(line, sizeof line, format, text);
    free(member->status);
    return memory_copy_string(&member->status, line, "the members of a study");
}

enum status study_folder_set_reason(const char *folder, int member, const char *reason) {
    char *const path = study_folder_member(folder, member, ".failed");
    if (!path) return STATUS_MEMORY;
    struct durable_part part = {.descriptor = -1};
    int code = 0;

    // ignore a full disk: the result file itself contains the status "running" or "failed"
    if (!reason) {
        unlink(path);
    } else {
        code = durable_begin(&part, path, 0666);
        if (code == 0 && durable_write(part.descriptor, reason, strlen(reason)) == 0 &&
            durable_write(part.descriptor, "\n", 1) == 0) {
            durable_publish(&part, true);
        }
    }

    durable_end(&part);
    free(path);
    if (code != ENOMEM) return STATUS_OK;
    return memory_check(NULL, "the failure of a member");
}

/* Read the reason of a failed member; 0: no reason. */
static int read_reason(const char *folder, int number, char reason[REASON_BYTES]) {
    char *const path = study_folder_member(folder, number, ".failed");
    const int file = path ? open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC) : -1;
    free(path);
    if (file < 0) return 0;
    const ssize_t length = read(file, reason, REASON_BYTES - 1);
    close(file);
    if (length < 0) return 0;
    reason[length] = '\0';
    reason[strcspn(reason, "\n")] = '\0';
    return 1;
}

/* Read the final values and the status of one member. */
static enum status folder_read_member(struct member_file *member, const struct case_values *study, const char *folder,
                                      int number) {
    char *const path = study_folder_member(folder, number, ".nc");
    if (!path) return STATUS_MEMORY;
    enum status status = STATUS_OK;
    if (access(path, F_OK) != 0) {
        status = replace_status(member, "%s", "missing");
    } else {
        status = member_file_read(member, path);
        if (status == STATUS_FILE) {
            status = replace_status(member, "failed: %s", status_message());
        } else if (status == STATUS_OK && (strcmp(member->study, study->merged) != 0 || member->number != number ||
                                           member->n_fish != study->school.n_fish)) {
            status =
                status_fail(STATUS_FILE, "%s is a result of another study than the first file in the folder", path);
        }
    }

    free(path);
    TRY(status);
    char reason[REASON_BYTES];
    if (member_file_is_complete(member) || !read_reason(folder, number, reason)) return STATUS_OK;

    return replace_status(member, "failed: %s", reason);
}

enum status study_folder_read_members(struct member_file **members, const struct case_values *study,
                                      const char *folder) {
    const int n = sweep_n_members(study);
    TRY(MEMORY_NEW(*members, n, "the members of a study"));
    for (int m = 0; m < n; m++) {
        const enum status status = folder_read_member(&(*members)[m], study, folder, m);
        if (status == STATUS_OK) continue;
        study_folder_free_members(*members, n);
        *members = NULL;
        return status;
    }

    return STATUS_OK;
}

enum status study_folder_find_study(const char *folder, char **text) {
    DIR *const entries = opendir(folder);
    if (!entries) return status_fail(STATUS_FILE, "%s: cannot be read: %s", folder, strerror(errno));
    *text = NULL;
    enum status status = STATUS_OK;
    for (const struct dirent *entry; !*text && status != STATUS_MEMORY && (entry = readdir(entries));) {
        int number, length = 0;
        if (sscanf(entry->d_name, "member-%d.nc%n", &number, &length) != 1 || entry->d_name[length] || !length)
            continue;
        char *const path = study_folder_member(folder, number, ".nc");
        struct member_file member;
        status = path ? member_file_read(&member, path) : STATUS_MEMORY;
        if (status == STATUS_OK) {
            if (member.number >= 0) status = memory_copy_string(text, member.study, "the case of a study");
            member_file_free(&member);
        }
        free(path);
    }

    closedir(entries);
    if (status == STATUS_MEMORY) return status;
    if (*text) return STATUS_OK;

    return status_fail(STATUS_FILE, "%s contains no readable member of a study", folder);
}

// ---- the plan

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
            status == STATUS_OK && member_file_is_complete(&member) && strcmp(member.effective, effective) == 0;
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

enum status study_plan_create(struct arena *arena, struct study_plan *plan, const struct case_values *study,
                              const char *folder, int first, int last, int force) {
    const struct planning planning = {study, folder, force};
    const int n = sweep_n_members(study), is_part = last >= 0;
    *plan = (struct study_plan){.max_threads = 1};
    if (!is_part) last = n - 1;
    if (first < 0 || first > last || last >= n) {
        return status_fail(STATUS_CASE, "--members %d-%d: the study has members 0 to %d", first, last, n - 1);
    }

    plan->n_members = last - first + 1;
    NEW(arena, plan->member, plan->n_members);
    for (int number = first; number <= last; number++) TRY(plan_member(&planning, plan, number));
    if (is_part) return STATUS_OK;
    TRY(check_study_file(&planning));

    return remove_surplus_members(&planning);
}
