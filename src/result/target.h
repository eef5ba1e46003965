/* target.h: decides whether shoal may write to a path. Every file of shoal can be recognised by its first bytes. A file
 * without them was written by another program or by hand, and no option lets shoal replace it. Tested by
 * tests/result/test_target.c. */
#ifndef TARGET_H
#define TARGET_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum target_kind {
    TARGET_NETCDF,
    TARGET_PAGE,
    TARGET_VTK,
    TARGET_CHECKPOINT,
    TARGET_PICTURE,
    TARGET_SCRIPT,
    TARGET_TABLE
};

/* First line of the files of VTK after the declaration of XML, a line near the beginning of every script, and the first
 * line of an error.csv. */
#define TARGET_VTK_MARK "<!-- Written by shoal export. -->"
#define TARGET_SCRIPT_MARK "# Written by shoal study --slurm."
#define TARGET_TABLE_MARK "fish,quantity,unit,value,key,levels,order,error,percent,verdict"

/* The folder of a file. */
void target_folder(const char *path, char folder[PATH_MAX]);

/* Whether the file at path is a regular file that shoal wrote, of this kind; whole or not. */
bool target_is(const char *path, enum target_kind kind);

/* True if bytes can be the beginning of a file of any kind; also for no bytes, or only zeros, as left by a power cut.
 * */
bool target_may_begin(const unsigned char *bytes, size_t n);

/* Fail with STATUS_FILE if no file of this kind can be made at path: the folder is missing or read-only; path is a
 * folder, a link or a device; a file exists and overwrite is false; or the existing file is neither empty nor of this
 * kind. */
enum status target_check(const char *path, enum target_kind kind, bool overwrite);

/* Fail with STATUS_FILE if path is the file that the command reads. */
enum status target_refuse_input(const char *path, const char *input);

/* Fail with STATUS_FILE, or STATUS_MEMORY, because a file could not be created at path: code is an errno, reason the
 * message of the errno; the message says what to do. */
enum status target_failed(const char *path, int code, const char *reason);

#endif
