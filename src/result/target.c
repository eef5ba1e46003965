/* target.c: recognises the files of shoal, and checks a path before a file there is replaced. */
#define _GNU_SOURCE  // memmem
#include "result/target.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "result/sections.h"

enum { HEAD = 32768 /* bytes that are searched for a mark */, MAX_MARKS = 6 };

/* The first bytes of each kind, and marks, one of which must follow. The marks of a NetCDF file are several attributes
 * near the beginning, so that one damaged byte does not make the file unknown. */
static const struct {
    const char *name, *begin, *mark[MAX_MARKS];
} kinds[] = {
    [TARGET_NETCDF] = {"NetCDF file",
                       "CDF",
                       {"shoal_schema", "shoal_study", "shoal_field", "case_effective", "study_case"}},
    [TARGET_PAGE] = {"page", "<!DOCTYPE html>", {"<!-- A run of shoal to look at."}},
    [TARGET_VTK] = {"file of VTK", "<?xml", {TARGET_VTK_MARK}},
    [TARGET_CHECKPOINT] = {"checkpoint", SECTIONS_MAGIC, {SECTIONS_MAGIC}},
    [TARGET_PICTURE] = {"picture", "\x89PNG", {"shoal plot.py"}},
    [TARGET_SCRIPT] = {"script", "#", {TARGET_SCRIPT_MARK}},
    [TARGET_TABLE] = {"table of errors", TARGET_TABLE_MARK, {TARGET_TABLE_MARK}},
};
enum { N_KINDS = sizeof kinds / sizeof *kinds };

void target_folder(const char *path, char folder[PATH_MAX]) {
    const char *const slash = strrchr(path, '/');
    const int length = slash == path ? 1 : slash ? (int)(slash - path) : 0;
    snprintf(folder, PATH_MAX, "%.*s", length > 0 ? length : 1, length > 0 ? path : ".");
}

// ---- files of shoal

/* Whether the file at path is a regular file of a kind; errno or 0. */
static int target_examine(const char *path, enum target_kind kind, bool *is_ours) {
    struct stat facts;
    char head[HEAD];
    const char *const begin = kinds[kind].begin;
    *is_ours = false;
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return errno;
    int code = fstat(file, &facts) == 0 ? 0 : errno;

    if (code == 0 && S_ISREG(facts.st_mode)) {
        const ssize_t n = pread(file, head, HEAD, 0);
        if (n < 0) code = errno;

        // the first bytes, and one of the marks
        if (n >= (ssize_t)strlen(begin) && memcmp(head, begin, strlen(begin)) == 0) {
            for (int m = 0; m < MAX_MARKS && kinds[kind].mark[m]; m++) {
                const char *const mark = kinds[kind].mark[m];
                if (memmem(head, (size_t)n, mark, strlen(mark))) *is_ours = true;
            }
        }
    }

    close(file);
    return code;
}

bool target_is(const char *path, enum target_kind kind) {
    bool is_ours;
    target_examine(path, kind, &is_ours);
    return is_ours;
}

bool target_may_begin(const unsigned char *bytes, size_t n) {
    size_t n_zeros = 0;
    while (n_zeros < n && bytes[n_zeros] == 0) n_zeros++;
    if (n_zeros == n) return true;
    for (int k = 0; k < N_KINDS; k++) {
        const size_t length = strlen(kinds[k].begin);
        if (memcmp(bytes, kinds[k].begin, n < length ? n : length) == 0) return true;
    }
    return false;
}

// ---- places

enum status target_failed(const char *path, int code, const char *reason) {
    char folder[PATH_MAX];
    target_folder(path, folder);

    switch (code) {
        case ENOENT:
        case ENOTDIR:
            if (access(folder, F_OK) == 0) {
                return status_fail(STATUS_FILE, "%s: the folder %s takes no new files: choose another place with -o",
                                   path, folder);
            }
            return status_fail(STATUS_FILE,
                               "%s: there is no folder %s: create the folder, or choose another name with -o", path,
                               folder);
        case EACCES:
        case EPERM:
        case EROFS:
            return status_fail(STATUS_FILE, "%s: the folder cannot be written to (%s): choose another name with -o",
                               path, reason);
        case ENOMEM: return status_fail(STATUS_MEMORY, "%s: out of memory while writing", path);
        case EEXIST:
            return status_fail(STATUS_FILE, "%s exists: choose another name with -o or replace it with --force", path);
        case EAGAIN:
            return status_fail(
                STATUS_FILE,
                "%s: another process writes this file: wait until it has ended, or choose another name with -o", path);
        case ENOTUNIQ:
            return status_fail(STATUS_FILE,
                               "%s.part exists and is no file of shoal: move it, or choose another name with -o", path);
        default:
            return status_fail(STATUS_FILE, "%s: cannot be written (%s): make room or choose another place with -o",
                               path, reason);
    }
}

enum status target_check(const char *path, enum target_kind kind, bool overwrite) {
    struct stat target;
    if (path[0] == '\0') return status_fail(STATUS_FILE, "the name of the result file is empty: choose one with -o");

    if (lstat(path, &target) != 0) {
        char folder[PATH_MAX];
        target_folder(path, folder);
        return access(folder, W_OK | X_OK) == 0 ? STATUS_OK : target_failed(path, errno, strerror(errno));
    }

    if (S_ISDIR(target.st_mode))
        return status_fail(STATUS_FILE, "%s is a folder: name a file with -o, as in -o %s/run.nc", path, path);
    if (S_ISLNK(target.st_mode))
        return status_fail(STATUS_FILE, "%s is a link: give the file behind the link, or another name, with -o", path);
    if (!S_ISREG(target.st_mode))
        return status_fail(STATUS_FILE, "%s is not an ordinary file: choose another name with -o", path);
    bool is_ours;
    const int code = target_examine(path, kind, &is_ours);

    if (code != 0) {
        return status_fail(STATUS_FILE, "%s exists and cannot be read (%s): choose another name with -o", path,
                           strerror(code));
    }

    if (target.st_size > 0 && !is_ours) {
        return status_fail(STATUS_FILE,
                           "%s exists and is no %s of shoal, so no option replaces the file: remove the file, or "
                           "choose another name with -o",
                           path, kinds[kind].name);
    }

    return overwrite ? STATUS_OK : target_failed(path, EEXIST, "");
}

enum status target_refuse_input(const char *path, const char *input) {
    struct stat target, source;
    if (stat(path, &target) != 0 || stat(input, &source) != 0) return STATUS_OK;
    if (target.st_dev != source.st_dev || target.st_ino != source.st_ino) return STATUS_OK;
    return status_fail(STATUS_FILE, "%s is the file that is read: choose another name with -o", path);
}
