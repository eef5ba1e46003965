/* durable.h: files that survive a power cut, and files that are there as a whole or not at all. Tested by
 * tests/result/test_durable.c.
 *
 *     durable_begin      the empty file TARGET.part, locked
 *     write              to part.descriptor, or to a file opened by part.name
 *     durable_publish    fsync, rename to TARGET, fsync of the folder
 *     durable_end        removes a part that has not been published
 *
 * A part without a lock was left by a process that died, and is used again. A lock belongs to the inode, under every
 * name of the file. */
#ifndef DURABLE_H
#define DURABLE_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/types.h>

#include "base/arena.h"
#include "base/status.h"
#include "result/target.h"

/* A file in the making. */
struct durable_part {
    char target[PATH_MAX];
    char name[PATH_MAX]; /* "": published, or never created */
    int descriptor;      /* -1: none */
};

/* Flush a file, or the names in the folder of a file, to disk, so that the data survive a power cut; errno or 0. A file
 * system that cannot flush names and an unreadable folder are no errors. */
int durable_sync(int descriptor);
int durable_sync_folder(const char *path);

/* Write all bytes; errno or 0. */
int durable_write(int descriptor, const void *bytes, size_t n);

/* Lock n bytes of a file from first on, 0: all, until this descriptor is closed, here and in forks of the process.
 * Another descriptor is another owner, in the same process too. 0, EAGAIN: another owner has a lock there, or ENOLCK:
 * the system or the file system has no such locks. */
int durable_lock(int descriptor, uint64_t first, uint64_t n);

/* Whether the file of a descriptor is the one at this path. */
bool durable_has_name(int descriptor, const char *path);

/* Create a part of the file at target with these permissions, or empty the part of a process that died; errno or 0.
 * EAGAIN: another process makes this file; ENOTUNIQ: a file of another program, or a link, has the name of the part.
 * target is not part->target. Call durable_end also after a failure. */
int durable_begin(struct durable_part *part, const char *target, unsigned permissions);

/* Flush the part to disk and rename the part to the target; the descriptor stays open. overwrite: replace an existing
 * file, else EEXIST. Errno or 0. */
int durable_publish(struct durable_part *part, bool overwrite);

/* Close the part; remove an unpublished part. */
void durable_end(struct durable_part *part);

/* Remove all unpublished parts of this process, those of its claims too, not those of its parent: the last act of a
 * process, which a lack of memory or a signal may have interrupted anywhere. Safe in a handler of signals. */
void durable_remove_parts(void);

/* Remove the part that a process left when it died. */
void durable_discard(const char *target);

/* The right to write a result: locks on the part, which becomes the result, and on an existing result. */
struct durable_claim {
    char part[PATH_MAX]; /* "": there is no claim */
    int descriptor[2];   /* part, result; -1: none */
    pid_t process;       /* a fork does not release the claim */
};

/* Claim the result at a path, new or existing. Fails at once with STATUS_FILE if another run has the claim, in this
 * process or another one. On a file system without locks the claim excludes nobody. */
enum status durable_claim_take(struct durable_claim *claim, const char *path);

/* Release the claim, if there is one, and remove a part that was not published. In a fork of the process: only clear
 * *claim. */
void durable_claim_release(struct durable_claim *claim);

/* Replace the contents of a file; the old file is renamed to previous, or discarded if previous is NULL. After any
 * failure or power cut, path or previous is a complete file. Fails with STATUS_FILE and a message that begins with the
 * path. */
enum status durable_replace(const char *path, const char *previous, const void *bytes, size_t n);

/* Read a whole regular file. Fails with STATUS_FILE, also for anything but a regular file (without waiting for a
 * pipe). */
enum status durable_read(struct arena *arena, const char *path, unsigned char **bytes, size_t *n);

/* A text file that gets the final name only when complete. */

struct plain_file {
    FILE *stream; /* write here */
    struct durable_part part;
    const char *path;
    enum target_kind kind;
    bool overwrite;
};

/* Open a file for writing, with these permissions (0777 of a script). The path must live until plain_file_close. Fails
 * with STATUS_FILE (target_check); no file is then left. */
enum status plain_file_open(struct plain_file *file, const char *path, enum target_kind kind, bool overwrite,
                            unsigned permissions);

/* Close the file and rename the file to the path; after a failure of the caller (status) or of writing, remove the
 * file. Returns status, or STATUS_FILE. */
enum status plain_file_close(struct plain_file *file, enum status status);

#endif
