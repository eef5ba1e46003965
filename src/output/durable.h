/* durable.h: files that survive a power cut, and files that are there as a whole or not at all. Tested by
 * tests/output/test_durable.c. */
#ifndef DURABLE_H
#define DURABLE_H

#include <limits.h>
#include <stddef.h>

#include "base/status.h"

/* The folder that a file is in. */
void durable_folder_of(const char *path, char folder[PATH_MAX]);

/* Make what has been written to a file, or the names in the folder of a file, survive a power cut; errno or 0. Some
 * file systems cannot keep names, and a folder may be closed to readers: that is no error. */
int durable_sync(int descriptor);
int durable_sync_folder(const char *path);

/* Give a file new bytes: they are written to path.part, which then gets the name. The file that had it is kept as
 * previous, in place of an earlier one. Whatever fails, and whenever the power does, path or previous is a whole file;
 * only what may be replaced has these names. Fails with STATUS_FILE and a message that begins with the path. */
enum status durable_replace(const char *path, const char *previous, const void *bytes, size_t n);

/* Read a whole regular file into memory that the caller frees. Fails with STATUS_FILE, also for what is no regular file
 * (a pipe is not waited for), or with STATUS_MEMORY. */
enum status durable_read(const char *path, unsigned char **bytes, size_t *n);

#endif
