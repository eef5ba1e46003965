/* study_folder.c: names the files of members, and reads why they failed and what they found. */
#include "study/study_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/parallel.h"
#include "base/version.h"
#include "case/case.h"
#include "case/sweep.h"
#include "result/durable.h"
#include "result/netcdf.h"
#include "result/target.h"
#include "run/simulate.h"
#include "steady/steady.h"

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

char *study_folder_path(struct arena *arena, const char *folder, const char *name) {
    // NetCDF takes a name without "./" for a URL
    return arena_text(arena, "%s%s/%s", folder[0] == '/' || folder[0] == '.' ? "" : "./", folder, name);
}

char *study_folder_member(struct arena *arena, const char *folder, int member, const char *ending) {
    char name[64];
    snprintf(name, sizeof name, "member-%04d%s", member, ending);
    return study_folder_path(arena, folder, name);
}

enum status study_folder_parse(struct arena *arena, struct case_values **study, const char *text, const char *origin,
                               int n_assignments, const char *const *assignments) {
    struct case_values *one;
    NEW(arena, one, 1);
    TRY(case_parse(one, text, strlen(text), origin, NULL, n_assignments, assignments));
    arena_move(one->arena, arena);
    *study = one;
    return STATUS_OK;
}

enum status study_folder_case(struct arena *arena, struct case_values **values, const struct case_values *study,
                              int member) {
    struct case_values *one;
    NEW(arena, one, 1);
    TRY(case_member(one, study, member));
    arena_move(one->arena, arena);
    *values = one;
    return STATUS_OK;
}

enum status study_refusals_add(struct study_refusals *refusals, const struct case_values *study, int member,
                               enum status status) {
    if (status != STATUS_OK && status != STATUS_CASE) return status;
    refusals->n_checked++;
    if (status == STATUS_OK || (refusals->n++ > 0 && member > refusals->first)) return STATUS_OK;
    refusals->first = member;

    // a case that is not valid names the member in its message
    ARENA(scratch, NULL, "the text of a member");
    const char *const message = status_message();
    const char *const name = arena_text(scratch, "member %d (%s):", member, sweep_member_text(scratch, study, member));
    const bool is_named = strncmp(message, name, strlen(name)) == 0;
    snprintf(refusals->reason, sizeof refusals->reason, "%s%s%s", is_named ? "" : name, is_named ? "" : " ", message);
    return STATUS_OK;
}

enum status study_refusals_status(const struct study_refusals *refusals, const struct case_values *study) {
    if (refusals->n == 0) return STATUS_OK;
    return status_fail(STATUS_CASE, "%s: %d of %d members cannot run; %s", study->name, refusals->n,
                       refusals->n_checked, refusals->reason);
}

void study_folder_set_reason(struct arena *arena, const char *folder, int member, const char *reason) {
    const char *const path = study_folder_member(arena, folder, member, ".failed");
    if (!reason) {
        unlink(path);
        return;
    }

    // ignore a full disk: the result file itself contains the status "running" or "failed"
    const char *const line = arena_text(arena, "%s\n", reason);
    durable_replace(path, NULL, line, strlen(line));
}

enum status study_folder_read_members(struct arena *arena, struct member_file **members,
                                      const struct case_values *study, const char *folder) {
    const int n = sweep_n_members(study);
    NEW(arena, *members, n);
    for (int m = 0; m < n; m++) {
        struct member_file *const member = &(*members)[m];
        const char *const path = study_folder_member(arena, folder, m, ".nc");
        if (access(path, F_OK) != 0) {
            member->status = "missing";
        } else {
            const enum status status = member_file_read(arena, member, path);
            if (status == STATUS_FILE) member->status = arena_text(arena, "failed: %s", status_message());
            if (status != STATUS_FILE) TRY(status);
            const struct sweep_axis *const first = study->n_axes > 0 ? &study->sweep[0] : NULL;
            const bool is_other = first && first->is_against && first->is_against[sweep_member_value(study, m, 0)];
            const int n_fish = study->school.n_fish;
            if (status == STATUS_OK && (strcmp(member->study, study->merged) != 0 || member->number != m ||
                                        (is_other ? member->n_fish > n_fish : member->n_fish != n_fish))) {
                return status_fail(STATUS_FILE, "%s is a result of another study than the first file in the folder",
                                   path);
            }
        }

        // the reason of a failed member replaces the status
        if (member_file_is_complete(member)) continue;
        const int file = open(study_folder_member(arena, folder, m, ".failed"), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
        if (file < 0) continue;
        char reason[2048];
        const ssize_t length = read(file, reason, sizeof reason - 1);
        close(file);
        if (length < 0) continue;
        reason[length] = '\0';
        const size_t line = strcspn(reason, "\n");
        member->status = arena_text(arena, "failed: %.*s", (int)line, reason);
        member->progress = reason[line] == '\n' ? arena_text(arena, "%s", reason + line + 1) : "";
    }
    return STATUS_OK;
}

static void entries_close(void *entries) {
    closedir(entries);
}

enum status study_folder_find_study(struct arena *arena, const char *folder, const char **text) {
    DIR *const entries = opendir(folder);
    if (!entries) return status_fail(STATUS_FILE, "%s: cannot be read: %s", folder, strerror(errno));
    arena_defer(arena, entries_close, entries);
    for (const struct dirent *entry; (entry = readdir(entries));) {
        int number, length = 0;
        if (sscanf(entry->d_name, "member-%d.nc%n", &number, &length) != 1 || entry->d_name[length] || !length)
            continue;
        struct member_file member;
        const enum status status = member_file_read(arena, &member, study_folder_member(arena, folder, number, ".nc"));
        if (status == STATUS_MEMORY) return status;
        if (status != STATUS_OK || member.number < 0) continue;
        *text = member.study;
        return STATUS_OK;
    }

    return status_fail(STATUS_FILE, "%s contains no readable member of a study", folder);
}

// ---- the plan

/* Wall time between two reports of a plan, s. A plan that takes less time has no report. */
static const double between_reports = 1;

enum status study_folder_watch(struct study_watch *watch, int n_checked) {
    const struct study_options *const options = watch->options;
    const double now = clock_seconds(CLOCK_MONOTONIC);
    if (n_checked == 1) watch->started = watch->reported = now;
    if (!options) return STATUS_OK;
    if (options->stop && *options->stop) {
        return status_fail(STATUS_STOPPED, "stopped %s while the members were %s: none of them has run",
                           simulate_stopped_by(options->stop), watch->what);
    }
    // the last report, after which a line on a terminal is cleared, follows any other
    const bool is_last = n_checked == watch->n && watch->reported > watch->started;
    if (!options->progress || (now < watch->reported + between_reports && !is_last)) return STATUS_OK;
    const struct study_progress progress = {.n_members = watch->n,
                                            .checked = watch->what,
                                            .n_checked = n_checked,
                                            .part = (double)n_checked / watch->n,
                                            .wall_time = now - watch->started};
    options->progress(&progress, options->data);
    watch->reported = now;
    return STATUS_OK;
}

static bool is_member_of(const struct member_file *member, const struct case_values *study, int number) {
    return strcmp(member->study, study->merged) == 0 && member->number == number;
}

/* Check the case and an existing result of a member; list the member unless finished. arena: scratch */
static enum status plan_member(struct arena *arena, struct study_plan *plan, struct study_refusals *refusals,
                               const struct case_values *study, const struct study_options *options, int number) {
    struct case_values *values;
    struct member_file member = {.status = ""};
    bool is_finished = false;
    const enum status status = study_folder_case(arena, &values, study, number);
    if (status != STATUS_OK) return study_refusals_add(refusals, study, number, status);
    const char *const path = study_folder_member(arena, options->folder, number, ".nc");
    const bool exists = access(path, F_OK) == 0;
    if (exists) TRY(target_check(path, TARGET_NETCDF, true));
    const enum status read = exists ? member_file_read(arena, &member, path) : STATUS_OK;

    // a result that a crash has truncated runs again
    if (read != STATUS_FILE) TRY(read);
    if (exists && read == STATUS_OK) {
        if (is_member_of(&member, study, number)) {
            const char *const effective = case_show(arena, values);
            is_finished = member_file_is_complete(&member) && strcmp(member.effective, effective) == 0;

            // force also replaces the result of another program
            const size_t length = strlen(version_short());
            const bool is_own = strncmp(member.source, version_short(), length) == 0 && member.source[length] == ',';
            if (options->force && !is_own) is_finished = false;
        } else if (!options->force) {
            return status_fail(STATUS_FILE,
                               "%s is a result of another study, or the case has changed since: choose another folder "
                               "with -o, or replace the results with --force",
                               path);
        }
    }

    plan->n_done += is_finished;
    const bool is_searched = !is_finished && sweep_is_steady(study);
    TRY(study_refusals_add(refusals, study, number, is_searched ? steady_refuse(values) : STATUS_OK));
    if (is_finished) return STATUS_OK;
    if (options->from) TRY(target_refuse_input(path, options->from));
    plan->member[plan->n++] = number;
    if (values->school.threads > plan->max_threads) plan->max_threads = values->school.threads;
    return STATUS_OK;
}

/* Remove the files of members of another study from number n on, or without force refuse them. Members that an error
 * study with refinement has added belong to the study. arena: scratch */
static enum status clear_surplus(struct arena *arena, const struct case_values *study, const char *folder, int n,
                                 bool force) {
    DIR *const entries = opendir(folder);
    if (!entries) return STATUS_OK;
    arena_defer(arena, entries_close, entries);
    for (const struct dirent *entry; (entry = readdir(entries));) {
        int number, length = 0;
        if (sscanf(entry->d_name, "member-%d%n", &number, &length) != 1 || number < n) continue;
        const char *const ending = entry->d_name + length, *const path =
                                                               study_folder_path(arena, folder, entry->d_name);
        const bool is_result = strcmp(ending, ".nc") == 0;
        const bool is_beside = strcmp(ending, ".failed") == 0 ||
                               ((strcmp(ending, ".ckpt") == 0 || strcmp(ending, STUDY_FOLDER_STATE) == 0) &&
                                target_is(path, TARGET_CHECKPOINT));
        struct member_file member;
        if (study->error && (is_beside || is_result)) {
            const char *const result = study_folder_member(arena, folder, number, ".nc");
            const enum status status = member_file_read(arena, &member, result);
            if (status == STATUS_MEMORY) return status;
            if (status == STATUS_OK && strcmp(member.study, study->merged) == 0) continue;
        }
        if (is_beside && force) unlink(path);
        if (!is_result || (force && target_is(path, TARGET_NETCDF) && unlink(path) == 0)) continue;
        return status_fail(STATUS_FILE,
                           "%s is a result of another study: choose another folder with -o, or remove the file%s", path,
                           force ? "" : " with --force");
    }
    return STATUS_OK;
}

enum status study_plan_create(struct arena *arena, struct study_plan *plan, const struct case_values *study,
                              const struct study_options *options) {
    const char *const folder = options->folder;
    const bool is_part = options->is_part, force = options->force;
    const int n = sweep_n_members(study), first = is_part ? options->first : 0, last = is_part ? options->last : n - 1;
    *plan = (struct study_plan){.max_threads = 1};
    if (first < 0 || first > last || last >= n) {
        return status_fail(STATUS_CASE, "--members %d-%d: the study has members 0 to %d", first, last, n - 1);
    }

    plan->n_members = last - first + 1;
    NEW(arena, plan->member, plan->n_members);
    struct study_refusals refusals = {0};
    struct study_watch watch = {.options = options, .what = "checked", .n = plan->n_members};
    for (int number = first; number <= last; number++) {
        struct arena *const scratch = arena_create(arena, "the plan of a study");
        TRY(plan_member(scratch, plan, &refusals, study, options, number));
        arena_free(scratch);
        TRY(study_folder_watch(&watch, number - first + 1));
    }
    TRY(study_refusals_status(&refusals, study));

    // results of another study go before the members run: a member that fails would leave one of them in its place
    for (int i = 0; i < plan->n && force; i++) {
        struct arena *const scratch = arena_create(arena, "the plan of a study");
        struct member_file member;
        const char *const path = study_folder_member(scratch, folder, plan->member[i], ".nc");
        const enum status status = access(path, F_OK) == 0 ? member_file_read(scratch, &member, path) : STATUS_FILE;
        if (status != STATUS_FILE) TRY(status);
        if (status == STATUS_OK && !is_member_of(&member, study, plan->member[i])) unlink(path);
        arena_free(scratch);
    }

    if (is_part) return STATUS_OK;
    struct arena *const scratch = arena_create(arena, "the plan of a study");

    // do not replace a file of another program or, without force, a study.nc of another study; one that cannot be read
    // is replaced
    const char *const table = study_folder_path(scratch, folder, "study.nc");
    const bool exists = access(table, F_OK) == 0;
    if (exists) TRY(target_check(table, TARGET_NETCDF, true));
    if (exists && !force) {
        struct netcdf_reader *reader;
        char *text;
        NEW(scratch, reader, 1);
        enum status status = netcdf_open(scratch, reader, table);
        if (status == STATUS_OK) status = netcdf_attribute(reader, "study_case", &text);
        if (status == STATUS_MEMORY) return status;
        if (status == STATUS_OK && *text && strcmp(text, study->merged) != 0) {
            return status_fail(STATUS_FILE,
                               "%s was gathered from another study, or the case has changed since: choose another "
                               "folder with -o, or replace the results with --force",
                               table);
        }
    }

    TRY(clear_surplus(scratch, study, folder, n, force));
    arena_free(scratch);
    return STATUS_OK;
}
