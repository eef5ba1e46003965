/* plain_file.h: a file of text that has its name only once it is whole. Tested by tests/output/test_page.c. */
#ifndef PLAIN_FILE_H
#define PLAIN_FILE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/status.h"

struct plain_file {
    FILE *stream;    /* write here */
    char *temporary; /* owned */
    const char *path;
    bool overwrite;
};

/* Open a file for writing. The path must live until it is closed. Fails with STATUS_FILE (no folder, not to be
 * overwritten) or STATUS_MEMORY; nothing is then left. */
enum status plain_file_open(struct plain_file *file, const char *path, bool overwrite);

/* Close the file and give it its name, unless status says that what should be in it has failed, or writing has; it is
 * then removed. Returns that status, or STATUS_FILE. */
enum status plain_file_close(struct plain_file *file, enum status status);

#endif
