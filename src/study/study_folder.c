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

#include "case/sweep.h"
#include "result/durable.h"

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
    char *const path = malloc(size);
    if (path) {
        snprintf(path, size, "%s%s/%s", folder[0] == '/' || folder[0] == '.' ? "" : "./", folder, name);
    } else {
        status_fail(STATUS_MEMORY, "out of memory: a file name");
    }
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
    member->status = strdup(line);
    return member->status ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: the members of a study");
}

enum status study_folder_set_reason(const char *folder, int member, const char *reason) {
    char *const path = study_folder_member(folder, member, ".failed");
    if (!path) return STATUS_MEMORY;
    struct durable_part part = {.descriptor = -1};

    // ignore a full disk: the result file itself contains the status "running" or "failed"
    if (!reason) {
        unlink(path);
    } else if (durable_begin(&part, path, 0666) == 0 && durable_write(part.descriptor, reason, strlen(reason)) == 0 &&
               durable_write(part.descriptor, "\n", 1) == 0) {
        durable_publish(&part, true);
    }

    durable_end(&part);
    free(path);
    return STATUS_OK;
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
static enum status read_member(struct member_file *member, const struct case_values *study, const char *folder,
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
    if (strcmp(member->status, "complete") == 0 || !read_reason(folder, number, reason)) return STATUS_OK;

    return replace_status(member, "failed: %s", reason);
}

enum status study_folder_read_members(struct member_file **members, const struct case_values *study,
                                      const char *folder) {
    const int n = sweep_n_members(study);
    *members = calloc((size_t)n, sizeof **members);
    if (!*members) return status_fail(STATUS_MEMORY, "out of memory: %d members", n);
    for (int m = 0; m < n; m++) {
        const enum status status = read_member(&(*members)[m], study, folder, m);
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
            if (member.number >= 0) *text = strdup(member.study);
            if (member.number >= 0 && !*text) status = status_fail(STATUS_MEMORY, "out of memory: the case of a study");
            member_file_free(&member);
        }
        free(path);
    }

    closedir(entries);
    if (status == STATUS_MEMORY) return status;
    if (*text) return STATUS_OK;

    return status_fail(STATUS_FILE, "%s contains no readable member of a study", folder);
}
