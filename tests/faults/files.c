/* files.c: lets calls of the system about files fail on demand, and logs all changes of files. tests/soak/faults.py and
 * tests/soak/power.py preload it (LD_PRELOAD).
 *
 *     FAULT_PATH   the calls about files whose path contains this are counted and logged, all others pass
 *     FAULT_CALL   name of the call that fails: open, read, write, pwrite, lseek, fsync, ftruncate, rename, close
 *     FAULT_AT     which of these calls, from 1; 0: none
 *     FAULT_HOW    ENOSPC, EIO, EDQUOT, EINTR: it fails with this; short: it writes a half; before, after: SIGKILL
 *     FAULT_EVER   1: all later ones fail too
 *     FAULT_COUNT  a file to append "call n" to at the end, for each call
 *     FAULT_LOG    a file to append the changes to: for each a struct entry, followed by the bytes of a write */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

enum call { OPEN, READ, WRITE, PWRITE, LSEEK, FSYNC, FTRUNCATE, RENAME, CLOSE, N_CALLS };
static const char *const names[N_CALLS] = {"open",  "read",      "write",  "pwrite", "lseek",
                                           "fsync", "ftruncate", "rename", "close"};
static long count[N_CALLS];

enum { MAX_FILES = 1024, NAME = 128, OURS = 1, FOLDER = 2 };
static char kind_of[MAX_FILES];  // of a descriptor: its file is one of FAULT_PATH, or a folder

static const char *setting(const char *name) {
    const char *const value = getenv(name);
    return value ? value : "";
}

static int matches(const char *path) {
    const char *const part = setting("FAULT_PATH");
    return *part && strstr(path, part) != NULL;
}

static int is(int file, int kind) {
    return file >= 0 && file < MAX_FILES && (kind_of[file] & kind);
}

// ---- faults

enum fate { PASS, FAIL, HALF, DIE_AFTER };

// what becomes of the next call; FAIL sets errno
static enum fate fate_of(enum call call) {
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

// make a call; of a call that is cut in two, the third argument is the size
static long make(enum call call, bool is_ours, long system, long a, long b, long c, long d) {
    const enum fate fate = is_ours ? fate_of(call) : PASS;
    if (fate == FAIL) return -1;
    const long value = syscall(system, a, b, fate == HALF ? (c + 1) / 2 : c, d, 0);
    if (fate == DIE_AFTER) raise(SIGKILL);
    return value;
}

// ---- the log

enum change { CREATED, WRITTEN, TRUNCATED, SYNCED, FOLDER_SYNCED, RENAMED, UNLINKED };
struct entry {
    uint64_t change, inode, offset, length;
    char name[NAME], other[NAME]; /* of the file in its folder; of what it is renamed to */
};

static void put_name(char to[NAME], const char *path) {
    const char *const slash = strrchr(path, '/');
    snprintf(to, NAME, "%s", slash ? slash + 1 : path);
}

static void put(struct entry entry, int file, const char *name, const char *other, const void *bytes) {
    if (!*setting("FAULT_LOG")) return;
    struct stat facts;
    if (file >= 0 && fstat(file, &facts) == 0) entry.inode = facts.st_ino;
    put_name(entry.name, name);
    put_name(entry.other, other);
    const int log = (int)syscall(SYS_openat, AT_FDCWD, setting("FAULT_LOG"), O_WRONLY | O_CREAT | O_APPEND, 0666);
    if (syscall(SYS_write, log, &entry, sizeof entry) != (long)sizeof entry) abort();
    if (bytes && syscall(SYS_write, log, bytes, entry.length) != (long)entry.length) abort();
    syscall(SYS_close, log);
}

static ssize_t written(int file, off_t at, const void *from, ssize_t n) {
    if (n > 0 && is(file, OURS)) {
        put((struct entry){.change = WRITTEN, .offset = (uint64_t)at, .length = (uint64_t)n}, file, "", "", from);
    }
    return n;
}

// ---- the calls in place of those of the C library

static int open_any(const char *path, int flags, mode_t mode) {
    struct stat facts;
    const int ours = matches(path), is_new = ours && lstat(path, &facts) != 0;
    const int file = (int)make(OPEN, ours, SYS_openat, AT_FDCWD, (long)path, flags, mode);
    if (file < 0 || file >= MAX_FILES) return file;
    const bool is_folder = fstat(file, &facts) == 0 && S_ISDIR(facts.st_mode);
    kind_of[file] = (char)((ours ? OURS : 0) | (is_folder ? FOLDER : 0));
    if (ours && is_new) put((struct entry){.change = CREATED}, file, path, "", NULL);
    if (ours && !is_new && (flags & O_TRUNC)) put((struct entry){.change = TRUNCATED}, file, path, "", NULL);
    return file;
}

#define OPEN_LIKE(name)                           \
    int name(const char *path, int flags, ...) {  \
        va_list list;                             \
        va_start(list, flags);                    \
        const mode_t mode = va_arg(list, mode_t); \
        va_end(list);                             \
        return open_any(path, flags, mode);       \
    }
OPEN_LIKE(open)
OPEN_LIKE(open64)

ssize_t read(int file, void *to, size_t n) {
    return make(READ, is(file, OURS), SYS_read, file, (long)to, (long)n, 0);
}

ssize_t write(int file, const void *from, size_t n) {
    const off_t at = is(file, OURS) ? (off_t)syscall(SYS_lseek, file, 0, SEEK_CUR) : 0;
    return written(file, at, from, make(WRITE, is(file, OURS), SYS_write, file, (long)from, (long)n, 0));
}

#define PWRITE_LIKE(name, type)                                                                                    \
    ssize_t name(int file, const void *from, size_t n, type at) {                                                  \
        return written(file, at, from, make(PWRITE, is(file, OURS), SYS_pwrite64, file, (long)from, (long)n, at)); \
    }                                                                                                              \
    _Static_assert(sizeof(type) == sizeof(long), "an offset is an argument of a call")
PWRITE_LIKE(pwrite, off_t);
PWRITE_LIKE(pwrite64, off64_t);

off_t lseek(int file, off_t to, int whence) {
    return make(LSEEK, is(file, OURS), SYS_lseek, file, to, whence, 0);
}

off64_t lseek64(int file, off64_t to, int whence) {
    return lseek(file, to, whence);
}

int ftruncate(int file, off_t size) {
    const int code = (int)make(FTRUNCATE, is(file, OURS), SYS_ftruncate, file, size, 0, 0);
    if (code == 0 && is(file, OURS)) {
        put((struct entry){.change = TRUNCATED, .offset = (uint64_t)size}, file, "", "", NULL);
    }
    return code;
}

int ftruncate64(int file, off64_t size) {
    return ftruncate(file, size);
}

int fsync(int file) {
    const int code = (int)make(FSYNC, is(file, OURS), SYS_fsync, file, 0, 0, 0);
    if (code == 0 && is(file, OURS | FOLDER)) {
        put((struct entry){.change = is(file, FOLDER) ? FOLDER_SYNCED : SYNCED}, file, "", "", NULL);
    }
    return code;
}

int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags) {
    const enum fate fate = matches(to) ? fate_of(RENAME) : PASS;
    if (fate == FAIL) return -1;
    const int code = (int)syscall(SYS_renameat2, from_folder, from, to_folder, to, flags);
    if (fate == DIE_AFTER) raise(SIGKILL);
    if (code == 0 && matches(to)) put((struct entry){.change = RENAMED}, -1, from, to, NULL);
    return code;
}

int rename(const char *from, const char *to) {
    return renameat2(AT_FDCWD, from, AT_FDCWD, to, 0);
}

int unlink(const char *path) {
    const int code = (int)syscall(SYS_unlinkat, AT_FDCWD, path, 0);
    if (code == 0 && matches(path)) put((struct entry){.change = UNLINKED}, -1, path, "", NULL);
    return code;
}

int close(int file) {
    const enum fate fate = is(file, OURS) ? fate_of(CLOSE) : PASS;
    // Linux closes a file also where close fails
    const int closed = (int)syscall(SYS_close, file);
    if (fate == DIE_AFTER) raise(SIGKILL);
    if (file >= 0 && file < MAX_FILES) kind_of[file] = 0;
    return fate == FAIL ? -1 : closed;
}
