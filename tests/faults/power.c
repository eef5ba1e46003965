/* power.c: every change of files that a program makes, written to a log, to be preloaded (LD_PRELOAD):
 * tests/faults/power.py makes from the log what a power cut can leave.
 *
 *     POWER_LOG    the log, which is appended to
 *     POWER_PATH   the files whose path contains this
 *
 * An entry is a struct entry, followed by the bytes of a write. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { MAX_FILES = 1024, NAME = 128 };
enum kind { CREATE, WRITE, TRUNCATE, SYNC, SYNC_FOLDER, RENAME, UNLINK };

struct entry {
    uint64_t kind, inode, offset, length;
    char name[NAME], other[NAME]; /* of the file in its folder; of what it is renamed or linked to */
};

static char is_ours[MAX_FILES];  // of a descriptor

static int matches(const char *path) {
    const char *const part = getenv("POWER_PATH");
    return part && *part && strstr(path, part) != NULL;
}

static int counts(int file) {
    return file >= 0 && file < MAX_FILES && is_ours[file];
}

static void put_name(char to[NAME], const char *path) {
    const char *const slash = strrchr(path, '/');
    snprintf(to, NAME, "%s", slash ? slash + 1 : path);
}

static void put_all(int log, const void *bytes, size_t n) {
    if (syscall(SYS_write, log, bytes, n) != (long)n) abort();
}

static void put(struct entry entry, const char *name, const char *other, const void *bytes) {
    const char *const path = getenv("POWER_LOG");
    if (!path) return;
    const int log = (int)syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND, 0666);
    if (log < 0) abort();
    put_name(entry.name, name);
    put_name(entry.other, other);
    put_all(log, &entry, sizeof entry);
    if (entry.kind == WRITE) put_all(log, bytes, entry.length);
    syscall(SYS_close, log);
}

static uint64_t inode_of(int file) {
    struct stat facts;
    return fstat(file, &facts) == 0 ? facts.st_ino : 0;
}

static int open_any(const char *path, int flags, mode_t mode) {
    struct stat before;
    const int ours = matches(path), is_new = ours && lstat(path, &before) != 0;
    const int file = (int)syscall(SYS_openat, AT_FDCWD, path, flags, mode);
    if (file < 0 || file >= MAX_FILES) return file;
    struct stat facts;
    const int is_folder = fstat(file, &facts) == 0 && S_ISDIR(facts.st_mode);
    is_ours[file] = (char)(ours || is_folder);
    if (ours && is_new) put((struct entry){.kind = CREATE, .inode = facts.st_ino}, path, "", NULL);
    if (ours && !is_new && (flags & O_TRUNC)) {
        put((struct entry){.kind = TRUNCATE, .inode = facts.st_ino}, path, "", NULL);
    }
    return file;
}

#include "open_like.h"

static ssize_t written(int file, off_t at, const void *from, ssize_t n) {
    if (n > 0 && counts(file)) {
        put((struct entry){.kind = WRITE, .inode = inode_of(file), .offset = (uint64_t)at, .length = (uint64_t)n}, "",
            "", from);
    }
    return n;
}

ssize_t write(int file, const void *from, size_t n) {
    const off_t at = counts(file) ? (off_t)syscall(SYS_lseek, file, 0, SEEK_CUR) : 0;
    return written(file, at, from, syscall(SYS_write, file, from, n));
}

ssize_t pwrite(int file, const void *from, size_t n, off_t at) {
    return written(file, at, from, syscall(SYS_pwrite64, file, from, n, at));
}

ssize_t pwrite64(int file, const void *from, size_t n, off64_t at) {
    return written(file, at, from, syscall(SYS_pwrite64, file, from, n, at));
}

int ftruncate(int file, off_t size) {
    const int code = (int)syscall(SYS_ftruncate, file, size);
    if (code == 0 && counts(file)) {
        put((struct entry){.kind = TRUNCATE, .inode = inode_of(file), .offset = (uint64_t)size}, "", "", NULL);
    }
    return code;
}

int ftruncate64(int file, off64_t size) {
    return ftruncate(file, size);
}

int fsync(int file) {
    const int code = (int)syscall(SYS_fsync, file);
    struct stat facts;
    if (code == 0 && counts(file) && fstat(file, &facts) == 0) {
        put((struct entry){.kind = S_ISDIR(facts.st_mode) ? SYNC_FOLDER : SYNC, .inode = facts.st_ino}, "", "", NULL);
    }
    return code;
}

int rename(const char *from, const char *to) {
    const int code = (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
    if (code == 0 && matches(to)) put((struct entry){.kind = RENAME}, from, to, NULL);
    return code;
}

int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags) {
    const int code = (int)syscall(SYS_renameat2, from_folder, from, to_folder, to, flags);
    if (code == 0 && matches(to)) put((struct entry){.kind = RENAME}, from, to, NULL);
    return code;
}

int unlink(const char *path) {
    const int code = (int)syscall(SYS_unlinkat, AT_FDCWD, path, 0);
    if (code == 0 && matches(path)) put((struct entry){.kind = UNLINK}, path, "", NULL);
    return code;
}

int close(int file) {
    if (file >= 0 && file < MAX_FILES) is_ours[file] = 0;
    return (int)syscall(SYS_close, file);
}
