/* shim.c: calls of the system that fail on demand, to be preloaded (LD_PRELOAD): tests/faults/faults.py.
 *
 *     FAULT_PATH   the calls about files whose path contains this are counted, all others pass
 *     FAULT_CALL   name of the call that fails: open, read, write, pwrite, lseek, fsync, ftruncate, rename, close
 *     FAULT_AT     which of these calls, from 1; 0: none
 *     FAULT_HOW    ENOSPC, EIO, EDQUOT, EINTR: it fails with this; short: it writes a half; before, after: SIGKILL
 *     FAULT_EVER   1: all later ones fail too
 *     FAULT_COUNT  a file to append "call n" to at the end, for each call */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { OPEN, READ, WRITE, PWRITE, LSEEK, FSYNC, FTRUNCATE, RENAME, CLOSE, N_CALLS, MAX_FILES = 1024 };
static const char *const names[N_CALLS] = {"open",  "read",      "write",  "pwrite", "lseek",
                                           "fsync", "ftruncate", "rename", "close"};
static long count[N_CALLS];
static char is_ours[MAX_FILES];  // of a descriptor: its file is one of FAULT_PATH

enum fate { PASS, FAIL, HALF, DIE_AFTER };

static const char *setting(const char *name) {
    const char *const value = getenv(name);
    return value ? value : "";
}

static int matches(const char *path) {
    const char *const part = setting("FAULT_PATH");
    return *part && strstr(path, part) != NULL;
}

static int counts(int file) {
    return file >= 0 && file < MAX_FILES && is_ours[file];
}

// what becomes of the next call; FAIL sets errno
static enum fate fate_of(int call) {
    static const struct {
        const char *name;
        int code;
    } codes[] = {{"ENOSPC", ENOSPC}, {"EIO", EIO}, {"EDQUOT", EDQUOT}, {"EINTR", EINTR}};
    const long n = ++count[call], at = atol(setting("FAULT_AT"));
    if (strcmp(setting("FAULT_CALL"), names[call]) != 0 || at == 0) return PASS;
    if (n < at || (n > at && strcmp(setting("FAULT_EVER"), "1") != 0)) return PASS;
    const char *const how = setting("FAULT_HOW");
    if (strcmp(how, "before") == 0) raise(SIGKILL);
    if (strcmp(how, "after") == 0) return DIE_AFTER;
    if (strcmp(how, "short") == 0) return HALF;
    for (int i = 0; i < 4; i++) {
        if (strcmp(how, codes[i].name) == 0) errno = codes[i].code;
    }
    return FAIL;
}

__attribute__((destructor)) static void report(void) {
    if (!*setting("FAULT_COUNT")) return;
    FILE *const file = fopen(setting("FAULT_COUNT"), "a");
    for (int call = 0; file && call < N_CALLS; call++) fprintf(file, "%s %ld\n", names[call], count[call]);
    if (file) fclose(file);
}

// the value of a call that has been made; after: what kills the program then
static long done(enum fate fate, long value) {
    if (fate == DIE_AFTER) raise(SIGKILL);
    return value;
}

static int open_any(const char *path, int flags, mode_t mode) {
    const int ours = matches(path);
    const enum fate fate = ours ? fate_of(OPEN) : PASS;
    if (fate == FAIL) return -1;
    const int file = (int)done(fate, syscall(SYS_openat, AT_FDCWD, path, flags, mode));
    if (file >= 0 && file < MAX_FILES) is_ours[file] = (char)ours;
    return file;
}

#include "open_like.h"

ssize_t read(int file, void *to, size_t n) {
    const enum fate fate = counts(file) ? fate_of(READ) : PASS;
    if (fate == FAIL) return -1;
    return done(fate, syscall(SYS_read, file, to, fate == HALF ? (n + 1) / 2 : n));
}

ssize_t write(int file, const void *from, size_t n) {
    const enum fate fate = counts(file) ? fate_of(WRITE) : PASS;
    if (fate == FAIL) return -1;
    return done(fate, syscall(SYS_write, file, from, fate == HALF ? (n + 1) / 2 : n));
}

#define PWRITE_LIKE(name)                                                                         \
    ssize_t name(int file, const void *from, size_t n, off_t at) {                                \
        const enum fate fate = counts(file) ? fate_of(PWRITE) : PASS;                             \
        if (fate == FAIL) return -1;                                                              \
        return done(fate, syscall(SYS_pwrite64, file, from, fate == HALF ? (n + 1) / 2 : n, at)); \
    }
PWRITE_LIKE(pwrite)
PWRITE_LIKE(pwrite64)

// the calls of which nothing is to be said but whether they fail
#define PLAIN(type, name, call, ours, system, list, ...)                           \
    type name list {                                                               \
        const enum fate fate = (ours) ? fate_of(call) : PASS;                      \
        return fate == FAIL ? -1 : (type)done(fate, syscall(system, __VA_ARGS__)); \
    }
PLAIN(off_t, lseek, LSEEK, counts(file), SYS_lseek, (int file, off_t to, int whence), file, to, whence)
PLAIN(off64_t, lseek64, LSEEK, counts(file), SYS_lseek, (int file, off64_t to, int whence), file, to, whence)
PLAIN(int, fsync, FSYNC, counts(file), SYS_fsync, (int file), file)
PLAIN(int, ftruncate, FTRUNCATE, counts(file), SYS_ftruncate, (int file, off_t size), file, size)
PLAIN(int, ftruncate64, FTRUNCATE, counts(file), SYS_ftruncate, (int file, off64_t size), file, size)
PLAIN(int, rename, RENAME, matches(to), SYS_renameat2, (const char *from, const char *to), AT_FDCWD, from, AT_FDCWD, to,
      0)
PLAIN(int, renameat2, RENAME, matches(to), SYS_renameat2,
      (int from_folder, const char *from, int to_folder, const char *to, unsigned flags), from_folder, from, to_folder,
      to, flags)

int close(int file) {
    const enum fate fate = counts(file) ? fate_of(CLOSE) : PASS;
    // Linux closes a file also where close fails
    const long closed = syscall(SYS_close, file);
    if (file >= 0 && file < MAX_FILES) is_ours[file] = 0;
    return fate == FAIL ? -1 : (int)done(fate, closed);
}
