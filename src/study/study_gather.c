/* study_gather.c: from the files of the members to study.nc and the table. Declared in study.h. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "case/sweep_members.h"
#include "study/study.h"

enum { REASON_BYTES = 2048 };

char *study_path(const char *folder, const char *name) {
    // "./" keeps NetCDF from taking the name for an address
    const size_t size = strlen(folder) + strlen(name) + 8;
    char *const path = malloc(size);
    if (path) {
        snprintf(path, size, "%s%s/%s", folder[0] == '/' || folder[0] == '.' ? "" : "./", folder, name);
    } else {
        status_fail(STATUS_MEMORY, "out of memory: a file name");
    }
    return path;
}

char *study_member_path(const char *folder, int member, const char *ending) {
    char name[64];
    snprintf(name, sizeof name, "member-%04d%s", member, ending);
    return study_path(folder, name);
}

void study_members_free(struct member_file *members, int n) {
    for (int m = 0; members && m < n; m++) member_file_free(&members[m]);
    free(members);
}

/* Replace the status of a member. */
static enum status note(struct member_file *member, const char *format, const char *text) {
    char line[REASON_BYTES + 16];
    snprintf(line, sizeof line, format, text);
    free(member->status);
    member->status = strdup(line);
    return member->status ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: the members of a study");
}

/* The reason that was kept when a member failed; 0 if there is none. */
static int read_reason(const char *folder, int number, char reason[REASON_BYTES]) {
    char *const path = study_member_path(folder, number, ".failed");
    FILE *const file = path ? fopen(path, "r") : NULL;
    free(path);
    if (!file) return 0;
    const size_t length = fread(reason, 1, REASON_BYTES - 1, file);
    fclose(file);
    reason[length] = '\0';
    reason[strcspn(reason, "\n")] = '\0';
    return 1;
}

/* Read one member and how it ended. */
static enum status read_member(struct member_file *member, const struct case_values *study, const char *folder,
                               int number) {
    char *const path = study_member_path(folder, number, ".nc");
    if (!path) return STATUS_MEMORY;
    enum status status = STATUS_OK;
    if (access(path, F_OK) != 0) {
        status = note(member, "%s", "missing");
    } else {
        status = member_file_read(member, path);
        if (status == STATUS_FILE) {
            status = note(member, "failed: %s", status_message());
        } else if (status == STATUS_OK && (strcmp(member->study, study->merged) != 0 || member->number != number ||
                                           member->n_fish != study->school.n_fish)) {
            status = status_fail(STATUS_FILE, "%s is a result of another study than the first file there", path);
        }
    }
    free(path);
    TRY(status);
    char reason[REASON_BYTES];
    if (strcmp(member->status, "complete") == 0 || !read_reason(folder, number, reason)) return STATUS_OK;
    return note(member, "failed: %s", reason);
}

enum status study_members_read(struct member_file **members, const struct case_values *study, const char *folder) {
    const int n = sweep_n_members(study);
    *members = calloc((size_t)n, sizeof **members);
    if (!*members) return status_fail(STATUS_MEMORY, "out of memory: %d members", n);
    for (int m = 0; m < n; m++) {
        const enum status status = read_member(&(*members)[m], study, folder, m);
        if (status == STATUS_OK) continue;
        study_members_free(*members, n);
        *members = NULL;
        return status;
    }
    return STATUS_OK;
}

/* Say how many members are not complete, but for those that are not to be. */
static enum status say_what_failed(const struct case_values *study, const struct member_file *members,
                                   const char *folder) {
    const int n = sweep_n_members(study);
    int n_failed = 0;
    for (int m = 0; m < n; m++) {
        n_failed += strcmp(members[m].status, "complete") != 0 && !study_expects_failure(study, members, m);
    }
    if (n_failed == 0) return STATUS_OK;
    return status_fail(STATUS_SOLVER, "%d of %d members in %s are not complete; `shoal study` on it runs them again",
                       n_failed, n, folder);
}

static enum status write_study(const struct case_values *study, const struct member_file *members,
                               const struct study_file_orders *orders, const char *folder, const char *command) {
    char *const path = study_path(folder, "study.nc");
    if (!path) return STATUS_MEMORY;
    const enum status status = study_file_write(path, study, members, orders, command);
    free(path);
    return status;
}

/* Print orders and statements; the first that is missed counts. */
static enum status print_expected(const struct case_values *study, const struct member_file *members,
                                  const struct study_file_orders *orders, FILE *stream) {
    const enum status of_orders = study_orders_print(study, orders, stream);
    if (of_orders != STATUS_OK && of_orders != STATUS_MISSED) return of_orders;
    const enum status of_members = study_expect(study, members, stream);
    return of_orders == STATUS_OK ? of_members : of_orders;
}

/* Print all, write study.nc, then judge. */
static enum status report(const struct case_values *study, const struct member_file *members,
                          const struct study_file_orders *orders, const char *folder, const char *command,
                          FILE *stream) {
    TRY(study_print(study, members, stream));
    TRY(write_study(study, members, orders, folder, command));
    const enum status expected = print_expected(study, members, orders, stream);
    if (expected == STATUS_OK) TRY(say_what_failed(study, members, folder));
    return expected;
}

enum status study_report(const struct case_values *study, const char *folder, const char *command, FILE *stream) {
    struct member_file *members;
    TRY(study_members_read(&members, study, folder));
    struct study_file_orders orders;
    enum status status = study_orders_create(&orders, study, members);
    if (status == STATUS_OK) status = report(study, members, &orders, folder, command, stream);
    study_file_orders_free(&orders);
    study_members_free(members, sweep_n_members(study));
    return status;
}

/* The merged text of the study that the first readable member of a folder belongs to. The caller frees *text. */
static enum status find_study(const char *folder, char **text) {
    DIR *const entries = opendir(folder);
    if (!entries) return status_fail(STATUS_FILE, "%s: cannot be read: %s", folder, strerror(errno));
    *text = NULL;
    for (const struct dirent *entry; !*text && (entry = readdir(entries));) {
        int number, length = 0;
        if (sscanf(entry->d_name, "member-%d.nc%n", &number, &length) != 1 || entry->d_name[length] || !length)
            continue;
        char *const path = study_member_path(folder, number, ".nc");
        struct member_file member;
        if (path && member_file_read(&member, path) == STATUS_OK) {
            if (member.number >= 0) *text = strdup(member.study);
            member_file_free(&member);
        }
        free(path);
    }
    closedir(entries);
    if (*text) return STATUS_OK;
    return status_fail(STATUS_FILE, "%s: holds no member of a study that can be read", folder);
}

enum status study_gather(const char *folder, const char *command, FILE *stream) {
    char *text;
    TRY(find_study(folder, &text));
    struct case_values study;
    enum status status = case_parse(&study, text, strlen(text), folder, NULL, 0, NULL);
    free(text);
    TRY(status);
    status = study_report(&study, folder, command, stream);
    case_free(&study);
    return status;
}

/* How many members ended how, and the axes. */
static void print_head(const struct case_values *study, const struct member_file *members, FILE *stream) {
    const int n = sweep_n_members(study);
    int n_complete = 0;
    for (int m = 0; m < n; m++) n_complete += strcmp(members[m].status, "complete") == 0;
    fprintf(stream, "  %-10s  %d, %d of them complete\n", "members", n, n_complete);
    for (int a = 0; a < study->n_axes; a++) {
        const struct sweep_axis *const axis = &study->sweep[a];
        fprintf(stream, "  axis %-5d  %d values of ", a, axis->n_values);
        for (int k = 0; k < axis->n_keys; k++) fprintf(stream, "%s%s", k > 0 ? ", " : "", axis->key[k].path);
        fprintf(stream, "%s\n", axis->refine ? ", refined" : "");
    }
    fprintf(stream, "\n");
}

enum status study_info(const char *path, FILE *stream) {
    struct case_values study;
    struct member_file *members;
    TRY(study_file_read(path, &study, &members));
    print_head(&study, members, stream);
    struct study_file_orders orders;
    enum status status = study_print(&study, members, stream);
    if (status == STATUS_OK) {
        status = study_orders_create(&orders, &study, members);
        if (status == STATUS_OK) status = print_expected(&study, members, &orders, stream);
        study_file_orders_free(&orders);
    }
    // what is missed has been said before; here it is a part of what the file holds
    if (status == STATUS_MISSED) fprintf(stream, "missed: %s\n", status_message());
    study_members_free(members, sweep_n_members(&study));
    case_free(&study);
    return status == STATUS_MISSED ? STATUS_OK : status;
}
